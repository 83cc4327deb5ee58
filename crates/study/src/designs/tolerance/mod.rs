//! To come.

use kempe_model::{Diagnostic, Model, ToleranceStudy};
use kempe_motion::Progress;

use crate::result::StudyResult;

pub(crate) fn findings_of_tolerance(_: &Model, _: &ToleranceStudy) -> Vec<Diagnostic> {
    Vec::new()
}

pub(crate) fn tolerance(
    _: &Model,
    name: &str,
    _: &ToleranceStudy,
    _: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    Err(vec![Diagnostic::error("unknown-study", name)])
}
