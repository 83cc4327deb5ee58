//! What is said of a study before it begins.

use kempe_model::{Diagnostic, OptimizeStudy};

use crate::designs::optimize::designs::Designs;
use crate::unit::Units;

/// The file's own values that lie outside of what may be chosen.
pub(in crate::designs::optimize) fn outside(
    problem: &Designs<'_, '_>,
    study: &OptimizeStudy,
    units: &Units,
) -> Vec<Diagnostic> {
    let own = problem.bench.own_values();
    let places = own.iter().zip(problem.ranges()).zip(&study.vary);
    let odd = places.filter(|((x, [low, high]), _)| *x < low || *x > high);
    odd.map(|((x, [low, high]), chosen)| {
        let parameter = &problem.bench.model.parameters[chosen.parameter.index()];
        let text = |x: f64| units.text(x, parameter.dimension);
        let message = format!(
            "`{}` is {} in the file, and is looked for from {} to {}",
            parameter.name,
            text(*x),
            text(*low),
            text(*high)
        );
        Diagnostic::warning("outside-bounds", message)
            .at(chosen.span.clone(), "the search begins on the nearer end")
            .help("widen the bounds, or change the value in the file")
    })
    .collect()
}

/// A method that is named where several goals have one of their own.
pub(in crate::designs::optimize) fn idle_method(study: &OptimizeStudy) -> Option<Diagnostic> {
    let idle = study.goals.len() > 1 && study.method.is_some();
    idle.then(|| {
        Diagnostic::warning(
            "idle-key",
            "`method` means nothing where several goals make a front",
        )
        .at(study.over.span.clone(), "")
        .help("leave it out")
    })
}
