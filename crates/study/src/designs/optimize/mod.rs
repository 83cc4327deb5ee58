//! To come.

use kempe_model::{Diagnostic, Model, OptimizeStudy};
use kempe_motion::Progress;

use crate::result::StudyResult;

pub(crate) fn findings_of_optimization(_: &Model, _: &OptimizeStudy) -> Vec<Diagnostic> {
    Vec::new()
}

pub(crate) fn optimization(
    _: &Model,
    name: &str,
    _: &OptimizeStudy,
    _: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    Err(vec![Diagnostic::error("unknown-study", name)])
}
