//! Parameters that change none of the numbers.

use kempe_model::{Diagnostic, ParameterId, Span};

use super::bench::Bench;

/// Numbers that differ by less than this part of them are the same.
const SAME: f64 = 1e-12;
/// What a derivative says of either of two values is nothing below this part of a number: extremes are located, which leaves rounding.
const FLAT: f64 = 1e-9;

/// What is told of varied parameters that have no effect at all: no derivative (`slopes`, by number), and nothing changes
/// at either of two values, with the others as in the file or at an end.
pub(crate) fn idle(
    bench: &Bench<'_>,
    slopes: &[&[f64]],
    ends: &[[f64; 2]],
    spans: impl Iterator<Item = Span>,
) -> Vec<Diagnostic> {
    // Of what cannot be asked what it lacks is compared.
    let told = |values: &[f64]| bench.numbers(values).map_err(|refused| refused.lack);
    let own = bench.own_values();
    let at_own = told(&own);
    let Ok(numbers) = &at_own else {
        return Vec::new();
    };
    // What has no effect at the file's own design alone may have one where the others are not as there.
    let elsewhere = [0, 1].map(|end| {
        let there: Vec<f64> = ends.iter().map(|ends| ends[end]).collect();
        let known = told(&there);
        (there, known)
    });
    let near = |(a, b): (&f64, &f64)| (a - b).abs() <= SAME * a.abs();
    let same = |at: &[f64], known: &Result<Vec<f64>, f64>, k: usize| {
        ends[k].iter().all(|end| {
            let mut values = at.to_vec();
            values[k] = *end;
            match (known, told(&values)) {
                (Ok(known), Ok(found)) => known.iter().zip(&found).all(near),
                (Err(known), Err(found)) => *known == found || near((known, &found)),
                _ => false,
            }
        })
    };
    let is_idle = |k: usize| {
        let farthest = ends[k].map(|end| (end - own[k]).abs());
        let farthest = farthest[0].max(farthest[1]);
        // What has one value, that of the file, cannot show whether it has one.
        if farthest == 0.0 || ends[k][0] == ends[k][1] {
            return false;
        }
        // What else has a slope has none at all.
        let all_numbers = || numbers.iter().copied().chain(std::iter::repeat(0.0));
        let flat =
            |(slope, number): (&&[f64], f64)| (slope[k] * farthest).abs() <= FLAT * number.abs();
        slopes.iter().zip(all_numbers()).all(flat)
            && same(&own, &at_own, k)
            && elsewhere.iter().all(|(at, known)| same(at, known, k))
    };
    let all = bench.varied.iter().zip(spans).enumerate();
    all.filter(|(k, _)| is_idle(*k))
        .map(|(_, (id, span))| {
            let name = &bench.model.parameters[id.index()].name;
            Diagnostic::warning(
                "idle-parameter",
                format!("`{name}` changes none of the numbers"),
            )
            .at(span, "")
            .help(match is_play(bench, *id) {
                true => "play counts in studies of clearance, and in tolerances with `clearance = true`: ask for that, or leave it out",
                false => "leave it out, or ask for a number that depends on it",
            })
        })
        .collect()
}

/// Whether some joint's play follows a parameter.
fn is_play(bench: &Bench<'_>, id: ParameterId) -> bool {
    let mut clearances = bench.model.clearances.iter();
    clearances.any(|clearance| clearance.radial.leaves().any(|leaf| *leaf == id))
}

/// The same where derivatives are still to be taken; nothing of simulations, which have none.
pub(super) fn idle_at_own(
    bench: &Bench<'_>,
    ends: &[[f64; 2]],
    spans: impl Iterator<Item = Span>,
) -> Vec<Diagnostic> {
    if let kempe_model::StudyKind::Simulate(_) = bench.over.kind {
        return Vec::new();
    }
    let Ok(sloped) = bench.slopes(&bench.own_values()) else {
        return Vec::new();
    };
    let slopes: Vec<&[f64]> = sloped.iter().map(|it| it.slope.as_slice()).collect();
    idle(bench, &slopes, ends, spans)
}
