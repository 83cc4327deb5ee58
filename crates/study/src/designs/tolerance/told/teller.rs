//! All that was found of pieces.

use kempe_model::ToleranceStudy;

use crate::designs::tolerance::ready::Ready;
use crate::designs::tolerance::sampled::{Pieces, Question};
use crate::designs::tolerance::worst::Worsts;

/// Who says what was found of pieces.
pub(in crate::designs::tolerance) struct Teller<'t, 'm> {
    pub ready: &'t Ready<'m>,
    pub study: &'t ToleranceStudy,
    pub question: &'t Question<'t, 'm>,
    /// Of the mechanism, m.
    pub size: f64,
    pub pieces: &'t Pieces,
    pub worst: &'t Worsts,
    /// By number: by how much lanes miss it.
    pub missed: &'t [Option<f64>],
}

impl Teller<'_, '_> {
    /// How many pieces there are where it was stopped before there were all.
    pub(super) fn stopped_at(&self) -> Option<String> {
        let (count, all) = (self.pieces.count, self.question.samples);
        (count < all).then(|| format!("{count} of {all} pieces"))
    }

    pub(super) fn resting_count(&self) -> usize {
        self.pieces.moves.iter().filter(|moves| !**moves).count()
    }
}
