//! What can be read of a text that may have errors.

use crate::diagnostic::Diagnostic;
use crate::ids::Span;
use crate::model::Model;
use crate::part::{Part, parts};

/// What could be read of a text.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Partial {
    /// The parts that the text declares, in its order, each with the place of its name.
    pub parts: Vec<(Part, Span)>,
    /// The model, where the text has no errors.
    pub model: Option<Model>,
    /// All that is to be said about the text, in its order.
    pub diagnostics: Vec<Diagnostic>,
}

impl Model {
    /// What can be read of a text while somebody is typing it: its parts, also of lines that are not TOML, with all
    /// diagnostics. `name` and `files` are as for [`from_toml`](Self::from_toml).
    ///
    /// # Example
    ///
    /// ```
    /// use kempe_model::{Model, PartKind};
    /// let text = "[links]\nframe = { A = [0, 0] }\ncrank = { A-B = \n";
    /// let partial = Model::partial(text, "", &mut |_| Err(String::new()));
    /// assert!(partial.model.is_none());
    /// assert_eq!(partial.diagnostics[0].code, "toml-syntax");
    /// assert!(partial.parts.iter().any(|(part, _)| part.kind == PartKind::Point && part.name == "B"));
    /// ```
    pub fn partial(
        text: &str,
        name: &str,
        files: &mut dyn FnMut(&str) -> Result<String, String>,
    ) -> Partial {
        let (model, diagnostics) = match Self::from_toml(text, name, files) {
            Ok(checked) => (Some(checked.model), checked.warnings),
            Err(found) => (None, found),
        };
        // what is too large to be read is not walked either
        let readable = text.len() <= crate::read::MAX_FILE_BYTES;
        Partial {
            parts: if readable { parts(text) } else { Vec::new() },
            model,
            diagnostics,
        }
    }
}
