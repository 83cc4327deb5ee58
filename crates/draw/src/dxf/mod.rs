//! A pose as DXF (AC1015, "R2000") for CAD: true scale in the mechanism's length unit, one layer per link, and one
//! per role of forces where there are some, with their legend.
//!
//! Entities: LINE between a link's points (exact), CIRCLE, ARC, LWPOLYLINE with bulges for outlines and symbols, TEXT.
//! Symbols have the size that they have on paper.

mod entities;
mod tables;

use std::fmt::Write as _;

use crate::loads::LoadRole;
use crate::scene::Point;
use crate::stage::Stage;
use crate::tokens::Token;

/// Longest layer name.
const LONGEST_NAME: usize = 60;

/// The layer of what the arrows of forces mean.
const LEGEND_LAYER: &str = "FORCES_LEGEND";

/// The layer of dimensions.
const DIMENSION_LAYER: &str = "DIMENSIONS";

/// The layer of the forces of a role.
fn load_layer(role: LoadRole) -> String {
    format!("FORCES_{}", role.name().to_uppercase())
}

/// The DXF file of a pose, as text. Poses that cannot be drawn give a file without entities.
pub fn document(stage: &Stage, index: usize) -> String {
    let mut writer = Writer {
        stage,
        out: String::new(),
        handle: 0x100,
        layer: String::new(),
    };
    let view = stage.context.view;
    let mut layers: Vec<(String, u32)> = vec![("0".into(), Token::Ink.rgb(false))];
    for layer in ["GROUND", "JOINTS", "DRIVES", "TRACES", "LABELS"] {
        layers.push((layer.into(), Token::Ground.rgb(false)));
    }
    if !view.dimensions.is_empty() {
        layers.push((DIMENSION_LAYER.into(), Token::Muted.rgb(false)));
    }
    for link in 0..view.links.len() {
        layers.push((
            writer.link_layer(link),
            crate::symbols::link_token(link).rgb(false),
        ));
    }
    if let Some(loads) = &stage.loads {
        layers.push((LEGEND_LAYER.into(), Token::Ink.rgb(false)));
        let layer = |role: &LoadRole| (load_layer(*role), Token::Load(*role).rgb(false));
        layers.extend(loads.roles.iter().map(layer));
    }
    writer.header();
    writer.tables(&layers);
    writer.out.push_str("  0\nSECTION\n  2\nBLOCKS\n");
    for (name, handles) in [
        ("*Model_Space", ["1F", "20", "21"]),
        ("*Paper_Space", ["1B", "1C", "1D"]),
    ] {
        let [record, begin, end] = handles;
        let _ = write!(
            writer.out,
            "  0\nBLOCK\n  5\n{begin}\n330\n{record}\n100\nAcDbEntity\n  8\n0\n100\nAcDbBlockBegin\n  2\n{name}\n 70\n0\n \
             10\n0.0\n 20\n0.0\n 30\n0.0\n  3\n{name}\n  1\n\n  0\nENDBLK\n  5\n{end}\n330\n{record}\n100\nAcDbEntity\n  \
             8\n0\n100\nAcDbBlockEnd\n"
        );
    }
    writer
        .out
        .push_str("  0\nENDSEC\n  0\nSECTION\n  2\nENTITIES\n");
    writer.skeleton(index);
    for group in &stage.scene(index).groups {
        writer.group(group);
    }
    writer
        .out
        .push_str("  0\nENDSEC\n  0\nSECTION\n  2\nOBJECTS\n");
    writer.out.push_str(
        "  0\nDICTIONARY\n  5\nC\n330\n0\n100\nAcDbDictionary\n281\n1\n  3\nACAD_GROUP\n350\nD\n",
    );
    writer.out.push_str(
        "  0\nDICTIONARY\n  5\nD\n330\nC\n100\nAcDbDictionary\n281\n1\n  0\nENDSEC\n  0\nEOF\n",
    );
    writer.out
}

struct Writer<'a> {
    stage: &'a Stage<'a>,
    out: String,
    handle: u32,
    layer: String,
}

impl Writer<'_> {
    pub(super) fn unit(&self) -> f64 {
        self.stage.context.view.length_unit.size()
    }

    /// From paper to the drawing's unit.
    pub(super) fn at(&self, p: Point) -> Point {
        let p = self.stage.context.fit.model(p);
        [p[0] / self.unit(), p[1] / self.unit()]
    }

    /// A length on paper (mm) in the drawing's unit.
    pub(super) fn length(&self, mm: f64) -> f64 {
        mm / self.stage.scale() / self.unit()
    }

    pub(super) fn link_layer(&self, link: usize) -> String {
        let name = self
            .stage
            .context
            .view
            .links
            .get(link)
            .map_or("", |l| l.name.as_str());
        format!(
            "LINK_{link}_{}",
            plain(name).replace(' ', "_").trim_end_matches('_')
        )
    }

    pub(super) fn pair(&mut self, code: u32, value: &str) {
        let _ = writeln!(self.out, "{code:>3}\n{value}");
    }

    pub(super) fn number(&mut self, code: u32, value: f64) {
        let value = if value.is_finite() { value } else { 0.0 };
        let text = if value == 0.0 {
            "0.0".into()
        } else {
            format!("{value:?}")
        };
        self.pair(code, &text);
    }
}

/// Text that any DXF reader takes: letters, digits and a few signs; everything else becomes `_`.
fn plain(text: &str) -> String {
    let safe = |c: char| {
        if c.is_ascii_alphanumeric() || " _-.,()=+".contains(c) {
            c
        } else {
            '_'
        }
    };
    text.chars().take(LONGEST_NAME).map(safe).collect()
}
