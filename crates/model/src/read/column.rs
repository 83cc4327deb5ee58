//! A column of a study: a measure by its text.

use crate::diagnostic::Diagnostic;
use crate::motion_study::Column;
use crate::node::Node;
use crate::read::context::Context;
use crate::read::measures::measure_text;
use crate::read::nature::nature;

pub(crate) fn column(cx: &mut Context<'_>, node: &Node, forces: bool) -> Option<Column> {
    let text = cx.text(node, "a column", "\"angle(rocker)\"")?;
    let name = text.content.trim().to_owned();
    let (measure, dimension) = measure_text(cx, text)?;
    if !forces && nature(&measure, &cx.natures).forces {
        cx.push(
            Diagnostic::error("needs-forces-study", format!("a motion study does not know `{name}`"))
                .at(node.span.clone(), "asks for a force")
                .help("forces belong to a study of their own: kind = \"forces\"; or leave it out of this one"),
        );
        return None;
    }
    Some(Column {
        name,
        measure,
        dimension,
    })
}
