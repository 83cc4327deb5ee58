//! Why a request has no answer, by the data of the file.

use kempe_model::{Diagnostic, Span};
use kempe_synthesis::SynthesisError;

/// Data of a request as the file has them: what one of them is called, and where each stands.
pub(super) struct Data<'a> {
    /// `pair`.
    pub what: &'a str,
    /// Where each stands, in the order in which the synthesis counts them.
    pub spans: Vec<Span>,
    /// What is asked, where it stands as a whole.
    pub whole: Span,
    /// What may be done where data are too few or too many.
    pub remedy: String,
}

impl Data<'_> {
    /// What is wrong with the request.
    pub fn refused(&self, error: &SynthesisError) -> Box<Diagnostic> {
        let at = |datum: usize| self.spans.get(datum).unwrap_or(&self.whole).clone();
        let what = self.what;
        Box::new(match *error {
            SynthesisError::TooFew { equations, unknowns } => Diagnostic::error(
                "data-too-few",
                format!("{equations} conditions for {unknowns} unknowns: infinitely many linkages keep them"),
            )
            .at(self.whole.clone(), "")
            .help(&*self.remedy),
            SynthesisError::TooMany { equations, unknowns } => Diagnostic::error(
                "data-too-many",
                format!("{equations} conditions for {unknowns} unknowns: no linkage of this kind can keep them all"),
            )
            .at(self.whole.clone(), "")
            .help(&*self.remedy),
            SynthesisError::Repeated { first, second } => Diagnostic::error(
                "data-repeated",
                format!("{what} {} says what {what} {} says", second + 1, first + 1),
            )
            .at(at(second), "again")
            .see(at(first), "the first time")
            .help("leave one of them out, or give another in its place"),
            SynthesisError::Contradictory { first, second } => Diagnostic::error(
                "data-contradictory",
                format!("{what} {} contradicts {what} {}", second + 1, first + 1),
            )
            .at(at(second), "no linkage does both")
            .see(at(first), "")
            .help("one input has one output: leave one of them out"),
            SynthesisError::Dependent { datum } => Diagnostic::error(
                "data-dependent",
                format!("{what} {} says nothing that the others do not say: infinitely many linkages keep them", datum + 1),
            )
            .at(at(datum), "follows from the others")
            .help("give another in its place"),
            SynthesisError::OutOfRange { datum, .. } => Diagnostic::error("data-out-of-range", format!("{what} {}: {error}", datum + 1))
                .at(at(datum), "")
                .help("give a value within these bounds"),
            SynthesisError::NotFinite { datum } => {
                Diagnostic::error("not-finite", format!("{what} {} is not a number", datum + 1)).at(at(datum), "")
            }
            ref other => Diagnostic::error("no-answer", other.to_string())
                .at(self.whole.clone(), "")
                .help(&*self.remedy),
        })
    }
}
