//! Why a request has no answer, by the data of the file.

use kempe_model::{Diagnostic, Span};
use kempe_synthesis::{OnCurve, SynthesisError};
use kempe_units::Dimension;

use crate::unit::Units;

/// A datum of a request as the file has it.
pub(super) struct Datum {
    /// `pair 2`.
    pub name: String,
    /// Where it stands.
    pub span: Span,
    /// What it measures.
    pub dimension: Dimension,
}

/// Data of a request, in the order in which the synthesis counts them.
pub(super) struct Data<'a> {
    pub data: Vec<Datum>,
    /// Where what is asked stands as a whole.
    pub whole: Span,
    /// What may be done where data are too few or too many.
    pub remedy: String,
    pub units: &'a Units,
}

impl Data<'_> {
    /// What is wrong with the request.
    pub fn refused(&self, error: &SynthesisError) -> Box<Diagnostic> {
        let at = |datum: usize| {
            self.data
                .get(datum)
                .map_or(&self.whole, |d| &d.span)
                .clone()
        };
        let name = |datum: usize| {
            let known = self.data.get(datum);
            known.map_or_else(|| format!("datum {}", datum + 1), |d| d.name.clone())
        };
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
                format!("{} says what {} says", name(second), name(first)),
            )
            .at(at(second), "again")
            .see(at(first), "the first time")
            .help("leave one of them out, or give another in its place"),
            SynthesisError::Contradictory { first, second } => Diagnostic::error(
                "data-contradictory",
                format!("{} contradicts {}", name(second), name(first)),
            )
            .at(at(second), "no linkage does both")
            .see(at(first), "")
            .help("one input has one output: leave one of them out"),
            SynthesisError::Dependent { datum } => Diagnostic::error(
                "data-dependent",
                format!("{} says nothing that the others do not say: infinitely many linkages keep them", name(datum)),
            )
            .at(at(datum), "follows from the others")
            .help("give another in its place"),
            SynthesisError::Translations => Diagnostic::error(
                "data-dependent",
                "the body does not turn from pose to pose: infinitely many links lead it, as sides of parallelograms",
            )
            .at(self.whole.clone(), "no turn from one to another")
            .help("give a moving pivot of each link, or let the body turn"),
            SynthesisError::OnePole { pole } => {
                let [x, y] = [pole.re, pole.im].map(|x| self.units.text(x, Dimension::LENGTH));
                Diagnostic::error("data-dependent", format!("all poses are turns about one point ({x}, {y})"))
                    .at(self.whole.clone(), "infinitely many links lead it")
                    .help("a pin at this point does it; or move a pose away from these turns")
            }
            SynthesisError::OutOfRange { datum, value, least, most } => {
                let dimension = self.data.get(datum).map_or(Dimension::NONE, |d| d.dimension);
                let [value, least, most] = [value, least, most].map(|x| self.units.text(x, dimension));
                Diagnostic::error("data-out-of-range", format!("{} is {value}", name(datum)))
                    .at(at(datum), format!("it must lie between {least} and {most}"))
                    .help("give a value within these bounds")
            }
            SynthesisError::OneCurve { curve, count, datum } => {
                let besides = match curve {
                    OnCurve::Line => "",
                    OnCurve::Circle => " unless the curve is this circle: a crank's end and a parallelogram's coupler go in circles",
                };
                Diagnostic::error("data-contradictory", format!("{count} points lie on one {curve}"))
                    .at(at(datum), "this one and others")
                    .note(format!("a coupler curve is of sixth order and meets a {curve} in at most six points{besides}"))
                    .help("move one away by what may be missed, or ask for fewer points and give pivots")
            }
            SynthesisError::NotFinite { datum } => {
                Diagnostic::error("not-finite", format!("{} is not a number", name(datum))).at(at(datum), "")
            }
            ref other => Diagnostic::error("no-answer", other.to_string())
                .at(self.whole.clone(), "")
                .help(&*self.remedy),
        })
    }
}
