//! What is said of a fit before any design is tried.

use kempe_model::{Diagnostic, Fit, OptimizeStudy, Timing, Traced};
use kempe_motion::drive_path::{duration, is_cycle};
use kempe_units::Dimension;

use super::fitted::Fitted;
use super::pace::passed;
use crate::designs::bench::Bench;
use crate::unit::Units;

/// Squares that differ by less than this part of them are the same.
const SAME: f64 = 1e-12;
/// Times that differ by more than this part of the whole are two, and so are places of a drive, SI.
const APART: f64 = 1e-9;

/// What is to be told before any design is tried: requests that no design can answer are errors.
pub(in super::super) fn before(
    fitted: &Fitted<'_, '_>,
    fit: &Fit,
    study: &OptimizeStudy,
    bounds: &[[f64; 2]],
) -> Vec<Diagnostic> {
    let mut told: Vec<Diagnostic> = never_open(fitted, fit, bounds)
        .into_iter()
        .chain(never_passed(fitted, fit, bounds))
        .chain(not_timed(fitted, fit))
        .collect();
    if told.is_empty() {
        told.extend(idle(fitted, fit, study, bounds));
        told.extend(passed_again(fitted, fit));
    }
    told
}

/// Some designs: the file's own, and those at the ends of all bounds.
fn some(bench: &Bench<'_>, bounds: &[[f64; 2]]) -> Vec<Vec<f64>> {
    let ends = [0, 1].map(|end| bounds.iter().map(|b| b[end]).collect());
    let all: Vec<Vec<f64>> = [bench.own_values()].into_iter().chain(ends).collect();
    all.iter().map(|values| bench.parameters(values)).collect()
}

/// A way that is to close where the drives never come round.
fn never_open(fitted: &Fitted<'_, '_>, fit: &Fit, bounds: &[[f64; 2]]) -> Option<Diagnostic> {
    let bench = fitted.bench;
    let closes = |parameters: &Vec<f64>| is_cycle(bench.model, parameters);
    if !fit.closed || fitted.circuit || some(bench, bounds).iter().any(closes) {
        return None;
    }
    let message = format!(
        "the drives of `{}` do not come back to their start",
        bench.over.name
    );
    Some(
        Diagnostic::error("not-closed", message)
            .at(fit.span.clone(), "the way of this is to be closed")
            .help("let the drive go a whole turn, or there and back; or leave out `closed`"),
    )
}

/// Values that the drive, or the time, never has.
fn never_passed(fitted: &Fitted<'_, '_>, fit: &Fit, bounds: &[[f64; 2]]) -> Option<Diagnostic> {
    let Timing::At(drive, _) = &fit.timing else {
        return None;
    };
    let (bench, model) = (fitted.bench, fitted.bench.model);
    let designs = some(bench, bounds);
    let is_passed = |value: &f64, parameters: &Vec<f64>| match drive {
        Some(drive) => passed(model, *drive, *value, parameters).is_some(),
        None => *value >= 0.0 && *value <= duration(model, parameters),
    };
    let never = |value: &f64| !designs.iter().any(|p| is_passed(value, p));
    let place = fitted.values.iter().position(never)?;
    let what = match drive {
        Some(drive) => model.drives.get(drive.index()).map_or("", |d| &d.name),
        None => "time",
    };
    let message = format!(
        "`{what}` does not have the value at which place {} is to be met",
        place + 1
    );
    let span = fit
        .to
        .get(place)
        .map_or(fit.span.clone(), |it| it.span.clone());
    Some(
        Diagnostic::error("not-on-the-motion", message)
            .at(span, format!("in study `{}`", bench.over.name))
            .help("give values that it has, or let it go farther"),
    )
}

/// Values that a drive comes to more than once, while others stand elsewhere.
fn passed_again(fitted: &Fitted<'_, '_>, fit: &Fit) -> Option<Diagnostic> {
    let Timing::At(Some(drive), _) = &fit.timing else {
        return None;
    };
    let model = fitted.bench.model;
    let parameters = fitted.bench.parameters(&fitted.bench.own_values());
    let drives = &model.drives;
    let name = &drives.get(drive.index())?.name;
    let end = duration(model, &parameters);
    let differs = |first: f64, again: f64| {
        drives.iter().any(|other| {
            let [a, b] = [first, again].map(|time| other.law.at(time, &parameters));
            (a - b).abs() > APART * a.abs().max(b.abs()).max(1.0)
        })
    };
    let (place, [first, again]) = fitted
        .values
        .iter()
        .enumerate()
        .find_map(|(place, value)| {
            let first = passed(model, *drive, *value, &parameters)?;
            let mut times = drives[drive.index()].law.times(*value, &parameters);
            let again = times.find(|time| *time > first + APART * end && differs(first, *time))?;
            Some((place, [first, again]))
        })?;
    let units = Units::of(model);
    let [first, again] = [first, again].map(|time| units.text(time, Dimension::TIME));
    let message = format!(
        "place {} is met where `{name}` has its value first, at {first}: it has it again at {again}, where other drives stand elsewhere",
        place + 1
    );
    let span = fit
        .to
        .get(place)
        .map_or(fit.span.clone(), |it| it.span.clone());
    Some(
        Diagnostic::warning("passed-again", message)
            .at(span, format!("in study `{}`", fitted.bench.over.name))
            .help("say when places are met by their times: timing = { time = [...] }"),
    )
}

/// Timings that a circuit has not.
fn not_timed(fitted: &Fitted<'_, '_>, fit: &Fit) -> Option<Diagnostic> {
    let timed = !matches!(fit.timing, Timing::Ordered | Timing::Nearest);
    if !fitted.circuit || !timed {
        return None;
    }
    let message = format!(
        "`{}` is a whole circuit, and time does not run along it",
        fitted.bench.over.name
    );
    Some(
        Diagnostic::error("bad-choice", message)
            .at(fit.span.clone(), "the timing of this means nothing there")
            .help("leave out `timing`, or write \"nearest\""),
    )
}

/// Parameters that move nothing, and where none does, that.
fn idle(
    fitted: &Fitted<'_, '_>,
    fit: &Fit,
    study: &OptimizeStudy,
    bounds: &[[f64; 2]],
) -> Vec<Diagnostic> {
    let bench = fitted.bench;
    let own = bench.own_values();
    let Ok(mut seen) = fitted.seen(&own) else {
        return Vec::new();
    };
    let Ok(residuals) = fitted.residuals(&mut seen) else {
        return Vec::new();
    };
    let square = seen.met.square();
    let is_idle = |k: usize| {
        residuals.iter().all(|r| r.slope[k] == 0.0)
            && bounds[k].iter().all(|end| {
                let mut values = own.clone();
                values[k] = *end;
                let there = fitted.seen(&values);
                there.is_ok_and(|seen| (seen.met.square() - square).abs() <= SAME * square)
            })
    };
    let name = |k: usize| &bench.model.parameters[study.vary[k].parameter.index()].name;
    let all: Vec<usize> = (0..own.len()).filter(|k| is_idle(*k)).collect();
    // What counts under limits is no idle parameter, though the fit does not go by it.
    if all.len() == own.len() {
        let what = match &fit.traced {
            Traced::Point(point) => &bench.model.points[point.index()].name,
            Traced::Link { link, .. } => &bench.model.links[link.index()].name,
        };
        let message = format!("nothing that varies moves `{what}`");
        return vec![
            Diagnostic::error("idle-parameter", message)
                .at(fit.span.clone(), "no design fits better than another")
                .help("vary a dimension that its way depends on"),
        ];
    }
    if !study.subject_to.is_empty() {
        return Vec::new();
    }
    let told = all.into_iter().map(|k| {
        let message = format!("`{}` changes nothing of the fit", name(k));
        Diagnostic::warning("idle-parameter", message)
            .at(study.vary[k].span.clone(), "")
            .help("leave it out, or vary a dimension that the way depends on")
    });
    told.collect()
}
