//! Where the rows of a table stand.

use kempe_model::{Model, MotionStudy, Rows, Scalar, value};
use kempe_motion::Motion;
use kempe_motion::drive_path::DrivePath;
use kempe_units::{Dimension, Unit};

use crate::unit::{Units, rounded};

/// The place of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RowPlace {
    /// At a coordinate of the drive, SI.
    Drive(f64),
    /// At a time, s.
    Time(f64),
}

/// How far beyond the last step the end may lie and still be that step.
const SAME_PLACE: f64 = 1e-9;

/// The drive that a step of the drive means.
pub(crate) fn path_drive(motion: &Motion) -> usize {
    match motion.path {
        DrivePath::Coordinate { drive, .. } => drive,
        DrivePath::Time { .. } => 0,
    }
}

/// The places of all rows of a study along a motion.
pub(crate) fn places_along(
    motion: &Motion,
    study: &MotionStudy,
    parameters: &[f64],
) -> Vec<RowPlace> {
    let model = &motion.mechanism().model;
    places(model, &study.rows, parameters, path_drive(motion))
}

/// How many rows a study asks for at most, without their places: of the drives, the one with the most steps counts.
pub(crate) fn most(model: &Model, rows: &Rows, parameters: &[f64]) -> f64 {
    let duration = kempe_motion::drive_path::duration(model, parameters);
    count(model, rows, parameters, duration)
}

/// As [`most`], of a motion that takes so long, s.
pub(crate) fn count(model: &Model, rows: &Rows, parameters: &[f64], duration: f64) -> f64 {
    let parts = |travel: f64, step: &Scalar| (travel / value(step, parameters)).abs();
    let count = match rows {
        Rows::DriveStep(step) => {
            let drives = model.drives.iter();
            let travels =
                drives.map(|d| d.law.at(duration, parameters) - d.law.at(0.0, parameters));
            travels.map(|t| parts(t, step)).fold(0.0, f64::max)
        }
        Rows::TimeStep(step) => parts(duration, step),
        Rows::Count(count) => return *count as f64,
    };
    // Without a finite number there is one row, as below; both ends count.
    if count.is_finite() { count + 2.0 } else { 1.0 }
}

/// The places of all rows. `drive` is the drive that a step of the drive means.
pub(crate) fn places(
    model: &Model,
    rows: &Rows,
    parameters: &[f64],
    drive: usize,
) -> Vec<RowPlace> {
    let duration = kempe_motion::drive_path::duration(model, parameters);
    match rows {
        Rows::DriveStep(step) => {
            let Some(drive) = model.drives.get(drive) else {
                return vec![RowPlace::Time(0.0)];
            };
            let from = drive.law.at(0.0, parameters);
            let to = drive.law.at(duration, parameters);
            let unit = Units::of(model).unit(drive.dimension);
            steps(from, to, value(step, parameters), &unit)
                .into_iter()
                .map(RowPlace::Drive)
                .collect()
        }
        Rows::TimeStep(step) => {
            let unit = Units::of(model).unit(Dimension::TIME);
            steps(0.0, duration, value(step, parameters), &unit)
                .into_iter()
                .map(RowPlace::Time)
                .collect()
        }
        Rows::Count(count) => {
            let last = count.saturating_sub(1).max(1) as f64;
            (0..(*count).max(1))
                .map(|k| RowPlace::Time(duration * (k as f64 / last)))
                .collect()
        }
    }
}

/// `from`, `from + step`, … `to`: each place is a multiple of the step, not a sum of steps, and round in `unit`. The end
/// is there even if it is no multiple.
fn steps(from: f64, to: f64, step: f64, unit: &Unit) -> Vec<f64> {
    let step = step.abs();
    let count = (to - from).abs() / step;
    if step.is_nan() || step <= 0.0 || !count.is_finite() {
        return vec![from];
    }
    let whole = (count + SAME_PLACE).floor();
    let (start, signed) = (
        unit.from_si(from),
        unit.from_si(step) * if to < from { -1.0 } else { 1.0 },
    );
    let mut places: Vec<f64> = (0..=whole as usize)
        .map(|k| unit.to_si(rounded(start + k as f64 * signed)))
        .collect();
    if let Some(first) = places.first_mut() {
        *first = from;
    }
    if count - whole > SAME_PLACE {
        places.push(to);
    } else if let (Some(last), true) = (places.last_mut(), whole > 0.0) {
        *last = to;
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use kempe_units::Unit;
    use proptest::prelude::*;

    #[test]
    fn steps_are_multiples_and_the_end_is_there() {
        let deg = Unit::parse("deg").unwrap();
        let places = steps(deg.to_si(37.86), deg.to_si(68.75), deg.to_si(0.1), &deg);
        assert_eq!(places.len(), 310);
        for (k, place) in places.iter().enumerate().take(309) {
            assert_eq!(*place, deg.to_si(rounded(37.86 + 0.1 * k as f64)), "{k}");
        }
        assert_eq!(places.last(), Some(&deg.to_si(68.75)));
        let back = steps(deg.to_si(10.0), deg.to_si(-10.0), deg.to_si(5.0), &deg);
        let shown: Vec<f64> = back.iter().map(|p| crate::unit::shown(*p, &deg)).collect();
        assert_eq!(shown, [10.0, 5.0, 0.0, -5.0, -10.0]);
        assert_eq!(steps(0.0, 0.0, 1.0, &deg), [0.0]);
        assert_eq!(steps(0.0, 1.0, 0.0, &deg), [0.0]);
        assert_eq!(steps(0.0, 1.0, f64::NAN, &deg), [0.0]);
        assert_eq!(steps(0.0, 1.0, 7.0, &deg), [0.0, 1.0]);
    }

    proptest! {
        #[test]
        fn steps_run_from_end_to_end_without_a_gap(from in -400.0..400.0f64, to in -400.0..400.0f64, step in 0.3..50.0f64) {
            let deg = Unit::parse("deg").unwrap();
            let (a, b, h) = (deg.to_si(from), deg.to_si(to), deg.to_si(step));
            let places = steps(a, b, h, &deg);
            prop_assert_eq!(places.first(), Some(&a));
            prop_assert_eq!(places.last(), Some(&b));
            for pair in places.windows(2) {
                let gap = (pair[1] - pair[0]) * (b - a).signum();
                prop_assert!(gap > 0.0 && gap <= h * (1.0 + 1e-6));
            }
        }
    }
}
