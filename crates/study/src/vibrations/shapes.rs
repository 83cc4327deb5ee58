//! Mode shapes as poses: as large as is good to look at, and each pose one that the mechanism really takes.

use std::f64::consts::TAU;

use kempe_dynamics::modes::Mode;
use kempe_number::math;
use kempe_number::text::significant;
use kempe_units::{Dimension, Unit};

use super::bench::Bench;
use crate::result::{Frame, ModeShape};
use crate::table::Column;
use crate::unit::shown;

/// Poses over one period.
const PERIOD: usize = 32;
/// Periods in one picture.
const PERIODS: usize = 3;
/// Poses of a mode in all.
pub(crate) const SHAPE_POSES: usize = PERIOD * PERIODS + 1;
/// How far a point goes to each side in the picture, as a part of its width or height.
const FAR: f64 = 0.12;
/// How far a body turns to each side at most, rad.
const TURNED: f64 = 0.35;
/// A coordinate that goes by less than this part of the farthest one, in rad and mechanism sizes, does not go.
const STILL: f64 = 1e-12;
/// A way that a limit cuts is shown with a smaller amplitude, halved so often at most.
const HALVED: usize = 8;

/// How a mode is told: its shape counted by the coordinate that goes farthest.
pub(super) struct Counted {
    /// The place of that coordinate among those that are let go.
    pub by: usize,
    /// What each coordinate does when that one goes by 1 in its unit, each in its own.
    pub shape: Vec<f64>,
    /// How far each point of the model goes then, m; NaN of points that are nowhere.
    pub points: Vec<f64>,
    /// How far that coordinate goes in the picture, SI.
    pub amplitude: f64,
}

impl Counted {
    /// Counts a mode about the pose that was last made linear.
    pub fn of(bench: &Bench<'_>, mode: &Mode) -> Self {
        let free = bench.free();
        let mut all = vec![0.0; bench.model.drives.len()];
        for (drive, x) in free.iter().zip(&mode.shape) {
            all[drive.index()] = *x;
        }
        let sizes = bench.stance.in_sizes(&all);
        let sizes: Vec<f64> = free.iter().map(|d| sizes[d.index()].abs()).collect();
        let most = sizes.iter().copied().fold(0.0, f64::max);
        // Coordinates that symmetry makes equal differ by rounding.
        let by = sizes
            .iter()
            .position(|x| *x >= most * (1.0 - 1e-9))
            .unwrap_or(0);
        // What rounding leaves of no way is none.
        let own: Vec<f64> = (mode.shape.iter().zip(&sizes))
            .map(|(x, size)| if *size < STILL * most { 0.0 } else { *x })
            .collect();
        let unit = own[by];
        let in_unit = |k: usize, si: f64| bench.unit(free[k]).from_si(si);
        let shape = (0..free.len()).map(|k| in_unit(k, own[k] / unit) / in_unit(by, 1.0));
        let one = bench.unit(free[by]).to_si(1.0) / unit;
        let speeds: Vec<f64> = own.iter().map(|x| x * one).collect();
        let moving = bench.lineariser.velocities(free, &speeds);
        let (mechanism, geometry) = (bench.motion.mechanism(), &bench.motion.design.geometry);
        let points = (0..bench.model.points.len() as u32).map(|point| {
            let Some(marker) = mechanism.any_marker(kempe_model::PointId(point)) else {
                return f64::NAN;
            };
            let body = marker.body.index();
            let arm = bench.stance.poses()[body].turn(geometry.marker(marker));
            let [x, y, turning] = moving[body];
            math::hypot(x - turning * arm[1], y + turning * arm[0])
        });
        let points: Vec<f64> = points.collect();
        let size = extent(&bench.stance.places().1);
        let finite = points.iter().filter(|x| x.is_finite());
        let farthest = finite.fold(0.0_f64, |m, x| m.max(*x));
        let turned = moving.iter().fold(0.0_f64, |m, [.., w]| m.max(w.abs()));
        let far = if size > 0.0 {
            farthest / size / FAR
        } else {
            0.0
        };
        let worst = far.max(turned / TURNED);
        let one = bench.unit(free[by]).to_si(1.0);
        Self {
            by,
            shape: shape.collect(),
            points,
            amplitude: if worst > 0.0 { one / worst } else { one },
        }
    }
}

/// Width or height of what points take up, the larger one, m.
fn extent(points: &[[f64; 2]]) -> f64 {
    let along = |axis: usize| {
        let places = points.iter().map(|p| p[axis]).filter(|x| x.is_finite());
        let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        high - low
    };
    along(0).max(along(1))
}

/// The poses of a mode about the pose at which the bench stands.
pub(super) fn shape(bench: &Bench<'_>, number: usize, mode: &Mode, counted: &Counted) -> ModeShape {
    let free = bench.free();
    let by = free[counted.by];
    let mut amplitude = counted.amplitude;
    let mut turn = None;
    for _ in 0..HALVED {
        turn = one_turn(bench, mode, counted, amplitude);
        if turn.is_some() {
            break;
        }
        amplitude /= 2.0;
    }
    let turn = turn.unwrap_or_else(|| {
        amplitude = 0.0;
        let stance = &bench.stance;
        let still = (
            Bench::frame(stance),
            stance.coordinates().to_vec(),
            stance.evidence().closure,
        );
        vec![still; PERIOD]
    });
    let frequency = mode
        .angular_frequency()
        .filter(|w| *w > 0.0)
        .map(|w| w / TAU);
    let (first, step) = match frequency {
        Some(frequency) => {
            let time = Column::new("time", bench.units.unit(Dimension::TIME));
            (time, 1.0 / frequency / PERIOD as f64)
        }
        None => {
            let phase = Unit::parse("deg").unwrap_or_else(|_| Unit::one());
            (Column::new("phase", phase), TAU / PERIOD as f64)
        }
    };
    let mut columns = vec![first];
    for drive in &bench.model.drives {
        columns.push(Column::new(
            drive.name.clone(),
            bench.units.unit(drive.dimension),
        ));
    }
    let (mut frames, mut closure) = (Vec::new(), Vec::new());
    for row in 0..SHAPE_POSES {
        let (frame, coordinates, gap): &(Frame, Vec<f64>, f64) = &turn[row % PERIOD];
        let unit = columns[0].unit.clone();
        columns[0].values.push(unit.from_si(row as f64 * step));
        for (column, q) in columns.iter_mut().skip(1).zip(coordinates) {
            column.values.push(shown(*q, &column.unit));
        }
        frames.push(frame.clone());
        closure.push(*gap);
    }
    let unit = bench.unit(by);
    let size = format!(
        "{} {}",
        significant(unit.from_si(amplitude), 3),
        unit.text()
    );
    let about = format!(
        "Mode {number} of {}: {}. Drawn {} to each side of {}, larger than it would still be linear.",
        free.len(),
        in_words(mode),
        size,
        bench.model.drives[by.index()].name
    );
    let title = match (frequency, mode.angular_frequency()) {
        (Some(frequency), _) => format!("mode {number}: {} Hz", significant(frequency, 4)),
        (None, Some(_)) => format!("mode {number}: free"),
        (None, None) => format!("mode {number}: unstable"),
    };
    ModeShape {
        name: format!("mode-{number}"),
        title,
        about,
        columns,
        frames,
        closure,
        extremes: [PERIOD / 4, 3 * PERIOD / 4],
    }
}

/// The poses of one period, evenly in time, with the coordinates and closures; `None` where one cannot be reached.
fn one_turn(
    bench: &Bench<'_>,
    mode: &Mode,
    counted: &Counted,
    amplitude: f64,
) -> Option<Vec<(Frame, Vec<f64>, f64)>> {
    let unit = amplitude / mode.shape[counted.by];
    let mut stance = bench.stance.clone();
    let middle = stance.coordinates().to_vec();
    let mut turn = Vec::with_capacity(PERIOD);
    for k in 0..PERIOD {
        // Exact at the ends of the way and in the middle.
        let away = match (4 * k) % PERIOD {
            0 => [0.0, 1.0, 0.0, -1.0][4 * k / PERIOD],
            _ => math::sin(TAU * k as f64 / PERIOD as f64),
        };
        let mut to = middle.clone();
        for (drive, x) in bench.free().iter().zip(&mode.shape) {
            to[drive.index()] += away * unit * x;
        }
        if !stance.go(&to) {
            return None;
        }
        turn.push((Bench::frame(&stance), to, stance.evidence().closure));
    }
    Some(turn)
}

/// What a mode does, in words.
pub(super) fn in_words(mode: &Mode) -> String {
    let number = |x: f64| significant(x, 4);
    let grows = (mode.growth() > 0.0).then(|| {
        format!(
            "unstable, it grows by e in {} s",
            number(1.0 / mode.growth())
        )
    });
    let frequency = match (mode.angular_frequency(), &grows) {
        (Some(frequency), _) if frequency > 0.0 => frequency,
        (_, Some(grows)) => return grows.clone(),
        (Some(_), None) => return "free, nothing brings it back".to_owned(),
        (None, None) => return "held by damping alone".to_owned(),
    };
    let damped = match (mode.damping_ratio(), mode.growth()) {
        _ if grows.is_some() => grows.unwrap_or_default(),
        (Some(ratio), _) if ratio >= 1.0 => {
            format!(
                "creeps back without swinging, damping ratio {}",
                number(ratio)
            )
        }
        (Some(ratio), growth) if growth < 0.0 => {
            format!(
                "damping ratio {}, it dies away by e in {} s",
                number(ratio),
                number(-1.0 / growth)
            )
        }
        _ => "undamped".to_owned(),
    };
    format!("{} Hz, {damped}", number(frequency / TAU))
}
