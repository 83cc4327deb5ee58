//! To come.

use kempe_model::{Diagnostic, Model, SweepStudy};
use kempe_motion::Progress;

use crate::result::StudyResult;

pub(crate) fn findings_of_sweep(_: &Model, _: &SweepStudy) -> Vec<Diagnostic> {
    Vec::new()
}

pub(crate) fn sweep(
    _: &Model,
    name: &str,
    _: &SweepStudy,
    _: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    Err(vec![Diagnostic::error("unknown-study", name)])
}
