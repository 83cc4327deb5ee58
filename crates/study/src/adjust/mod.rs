//! Studies that adjust: values of unknown parameters from what was measured on the mechanism.
//!
//! What was measured (`data.rs`) is held against what the mechanism does when it is led through all rows (`bench.rs`); the sum of squares of what is
//! missed is made smallest from many starts and with every way to put the mechanism together (`fit.rs`), its derivatives exact. What the data
//! tell of each parameter is in `certainty.rs`, what is said of it all in `told.rs`.

mod bench;
mod certainty;
mod data;
mod fit;
mod told;

use kempe_model::{AdjustStudy, Diagnostic, Matched, Model};
use kempe_motion::progress::{Progress, Stage};

use crate::along::not_answered;
use crate::columns::Asked;
use crate::explain::stopped;
use crate::quantity::Quantity;
use crate::result::StudyResult;
use crate::unit::Units;
use bench::Bench;
use certainty::certainty;
use fit::{Solution, minimum, scales, solutions};

/// What a study asks for, in words, for `check`.
pub(crate) fn in_words(model: &Model, study: &AdjustStudy) -> String {
    let names = study.unknown.iter().map(|id| {
        let parameter = model.parameters.get(id.index());
        parameter.map_or_else(String::new, |p| p.name.clone())
    });
    let names: Vec<String> = names.collect();
    let rows = match study.rows.len() {
        1 => "1 row".to_owned(),
        rows => format!("{rows} rows"),
    };
    format!("{} from {rows} of what was measured", names.join(", "))
}

/// What is to be told of a study before anything is looked for; `check` and `run` say the same.
pub(crate) fn findings_of_adjustment(model: &Model, study: &AdjustStudy) -> Vec<Diagnostic> {
    refused(&Bench::new(model, study))
}

fn refused(bench: &Bench<'_>) -> Vec<Diagnostic> {
    let quantities = bench.study.measures.iter().map(|column| Quantity {
        name: column.name.clone(),
        measure: column.measure.clone(),
        dimension: column.dimension,
    });
    let asked = Asked {
        columns: quantities.collect(),
        ..Asked::default()
    };
    let unanswered = not_answered(&bench.design(&bench.start()).mechanism, &asked);
    match unanswered.is_empty() {
        true => bench.data.refused(bench.study, &Units::of(bench.model)),
        false => unanswered,
    }
}

/// A study that adjusts.
pub(crate) fn adjustment(
    model: &Model,
    name: &str,
    study: &AdjustStudy,
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    let bench = Bench::new(model, study);
    let wrong = refused(&bench);
    if !wrong.is_empty() {
        return Err(wrong);
    }
    let found = solutions(&bench, progress);
    let found = found.ok_or_else(|| vec![stopped(Stage::Trying)])?;
    let teller = told::Teller::new(&bench, name);
    // The file means one way to put it together; what it cannot say is no answer.
    let mut meant = found.iter().filter(|it| it.meant);
    let Some(best) = meant.find(|it| teller.is_sound(it)) else {
        return Err(vec![teller.nothing(&found)]);
    };
    let weighed = weighed(&bench, best);
    let (best, slopes, scales) = match &weighed {
        Some((solution, scales)) => (solution, &solution.measured.slopes, scales.clone()),
        None => (best, &best.measured.slopes, fit::scales(&bench)),
    };
    let scaled = |(slopes, scale): (&Vec<f64>, &f64)| slopes.iter().map(|d| d / scale).collect();
    let scaled: Vec<Vec<f64>> = slopes.iter().zip(&scales).map(scaled).collect();
    let misses = (best.misses.iter().zip(&bench.data.values).zip(&scales))
        .map(|((miss, datum), scale)| miss * datum.scale / scale);
    let square = misses.map(|miss| miss * miss).sum();
    let known = certainty(
        &scaled,
        &bench.sizes(&best.unknown),
        square,
        bench.data.weighted,
    );
    let mut known = known.map_err(|untold| vec![teller.untold(&untold)])?;
    if !teller.on_bounds(best).is_empty() {
        // Errors go as derivatives say only where nothing holds the values.
        known.deviations = None;
    }
    teller.result(&found, best, &known, (&scales, square))
}

/// Turns of weighing anew at most, and the change of values, in parts of their sizes, that ends them.
const WEIGHINGS: usize = 30;
const SETTLED: f64 = 1e-10;

/// The minimum where drives were measured with errors, too, and the standard deviations with which what was measured then
/// differs: that of a measure, and what those of the drives do to it (J. Orear, Am. J. Phys. 50:912, 1982).
fn weighed(bench: &Bench<'_>, solution: &Solution) -> Option<(Solution, Vec<f64>)> {
    if bench.data.of_drives.is_empty() {
        return None;
    }
    let own = |value: usize| {
        let measure = bench.data.values[value].measure;
        let given = bench.study.deviation(Matched::Measure(measure)).is_some();
        match given {
            true => bench.data.values[value].scale,
            false => 0.0,
        }
    };
    let mut scales = scales(bench);
    let mut last: Option<Solution> = None;
    for _ in 0..WEIGHINGS {
        let at = last.as_ref().unwrap_or(solution);
        let slopes = bench.by_drives(&at.moved);
        for (value, scale) in scales.iter_mut().enumerate() {
            let datum = &bench.data.values[value];
            let given = &bench.data.rows[datum.row].given;
            let mut square = own(value) * own(value);
            for (drive, slope) in given.iter().zip(&slopes[value]) {
                let deviation = bench.data.of_drives.iter().find(|(of, _)| of == drive);
                let by = slope * deviation.map_or(0.0, |(_, deviation)| *deviation);
                square += if by.is_finite() { by * by } else { 0.0 };
            }
            if square > 0.0 {
                *scale = square.sqrt();
            }
        }
        let next = minimum(bench, &at.unknown, &at.assembled, &scales)?;
        let sizes = bench.sizes(&at.unknown);
        let moved = next.unknown.iter().zip(&at.unknown).zip(&sizes);
        let settled = { moved }.all(|((a, b), size)| (a - b).abs() <= SETTLED * size);
        last = Some(next);
        if settled {
            break;
        }
    }
    last.map(|last| (last, scales))
}
