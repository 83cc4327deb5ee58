//! The path through drive space along which a motion is followed.

use std::f64::consts::TAU;

use kempe_model::{Law, Model, SAME_END};
use kempe_number::Number;
use kempe_units::Dimension;

use crate::trace::Path;

/// A sum of a few quotients is this near to what it means, as a part of itself.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// How long a motion takes, s: as long as its longest law. Of what differs from that by rounding alone, a number of few
/// digits is meant.
pub fn duration(model: &Model, parameters: &[f64]) -> f64 {
    let laws = model.drives.iter();
    let longest = (laws.map(|d| d.law.duration(parameters))).fold(0.0, f64::max);
    let short: f64 = format!("{longest:.14e}").parse().unwrap_or(longest);
    if (short - longest).abs() <= ROUNDING * longest {
        short
    } else {
        longest
    }
}

/// How near to its start, in turns or parts of its range, a drive ends that has gone through a cycle.
pub const WHOLE: f64 = 1e-9;

/// Whether a motion is a cycle: every drive ends where it started, or whole turns from there.
pub fn is_cycle(model: &Model, parameters: &[f64]) -> bool {
    model.drives.iter().all(|drive| {
        let law = &drive.law;
        let way = law.way(parameters);
        let (low, high) = law.extent(parameters);
        if drive.dimension == Dimension::ANGLE {
            let turns = way / TAU;
            (turns - turns.round()).abs() <= WHOLE
        } else {
            way.abs() <= WHOLE * (high - low)
        }
    })
}

/// A motion of less than this, in rad and mechanism sizes of all drives, is looked at as finely in time as one of so much.
const LITTLE: f64 = 1.0;

/// Times between which all laws are smooth, rising, both ends of the motion included: first and last of those that are
/// one but for rounding. `pieces` leaves out the knots of tables.
pub fn law_knots(model: &Model, parameters: &[f64], pieces: bool) -> Vec<[f64; 2]> {
    let end = duration(model, parameters);
    let mut times = vec![0.0];
    for drive in &model.drives {
        times.extend(match pieces {
            true => drive.law.breaks(parameters),
            false => drive.law.knots(parameters),
        });
    }
    let near_end = SAME_END * end;
    times.retain(|t| *t < end - near_end);
    times.sort_by(f64::total_cmp);
    let mut knots: Vec<[f64; 2]> = Vec::with_capacity(times.len() + 1);
    for t in times {
        match knots.last_mut() {
            Some([_, last]) if t - *last <= near_end => *last = t,
            _ => knots.push([t, t]),
        }
    }
    if end > 0.0 {
        knots.push([end, end]);
    }
    knots
}

/// Where the drives are along a motion.
#[derive(Clone, Debug)]
pub enum DrivePath {
    /// One drive moves and its coordinate is the path parameter; the others are held.
    Coordinate {
        /// Index of the moving drive.
        drive: usize,
        /// Coordinates of all drives (that of the moving one does not count).
        held: Vec<f64>,
        /// Whether it is an angle; otherwise it is a length.
        is_angle: bool,
        /// Size of a typical change: 1 rad, or the mechanism's size.
        scale: f64,
    },
    /// Several drives move by their laws; the path parameter is time.
    Time {
        /// The laws.
        laws: Vec<Law>,
        /// The model's parameters.
        parameters: Vec<f64>,
        /// When the motion ends, s.
        end: f64,
        /// Typical time, s.
        scale: f64,
    },
}

impl DrivePath {
    /// The path of a model's drives: along the coordinate of its only moving drive, or along time when several move.
    pub fn new(model: &Model, parameters: &[f64], size: f64) -> Self {
        let moving: Vec<usize> = (0..model.drives.len())
            .filter(|&i| {
                let (low, high) = model.drives[i].law.extent(parameters);
                low < high
            })
            .collect();
        match moving.as_slice() {
            [] | [_] => {
                let drive = moving.first().copied().unwrap_or(0);
                let held = model
                    .drives
                    .iter()
                    .map(|d| d.law.at(0.0, parameters))
                    .collect();
                Self::of_drive(model, size, drive, held)
            }
            _ => Self::in_time(model, parameters, size),
        }
    }

    /// The path of all drives along time, however many move.
    pub fn in_time(model: &Model, parameters: &[f64], size: f64) -> Self {
        let laws: Vec<Law> = model.drives.iter().map(|d| d.law.clone()).collect();
        let total = duration(model, parameters);
        // A radian, or a mechanism size, of the drives' whole travel counts as one.
        let travel: f64 = model
            .drives
            .iter()
            .map(|d| {
                let (low, high) = d.law.extent(parameters);
                match d.dimension {
                    Dimension::ANGLE => high - low,
                    // What tells which coordinate counts goes nowhere.
                    Dimension::NONE => 0.0,
                    _ => (high - low) / size,
                }
            })
            .sum();
        // What hardly moves has its time all the same: links that ring by micrometres turn in it often.
        let scale = if travel > 0.0 && total > 0.0 {
            total / travel.max(LITTLE)
        } else {
            1.0
        };
        Self::Time {
            laws,
            parameters: parameters.to_vec(),
            end: total,
            scale,
        }
    }

    /// The path of one drive of a mechanism of this size, m, the others held at these coordinates.
    pub fn of_drive(model: &Model, size: f64, drive: usize, held: Vec<f64>) -> Self {
        let moving = model.drives.get(drive);
        let is_angle = moving.is_none_or(|d| d.dimension == Dimension::ANGLE);
        Self::Coordinate {
            drive,
            held,
            is_angle,
            scale: if is_angle { 1.0 } else { size },
        }
    }

    /// The range of the path parameter: the moving drive's extent, or the whole time.
    pub fn range(&self, model: &Model, parameters: &[f64]) -> (f64, f64) {
        match self {
            Self::Coordinate { drive, .. } => model
                .drives
                .get(*drive)
                .map_or((0.0, 0.0), |d| d.law.extent(parameters)),
            Self::Time { .. } => (0.0, duration(model, parameters)),
        }
    }

    /// Where the motion starts.
    pub fn start(&self, model: &Model, parameters: &[f64]) -> f64 {
        match self {
            Self::Coordinate { drive, .. } => model
                .drives
                .get(*drive)
                .map_or(0.0, |d| d.law.at(0.0, parameters)),
            Self::Time { .. } => 0.0,
        }
    }

    /// Whether the path parameter is an angle (then its scale is 1).
    pub fn coordinates_are_angles(&self) -> bool {
        matches!(self, Self::Coordinate { is_angle: true, .. })
    }

    /// Drive coordinates at the path parameter, on any number, for the parameters that the path was made with. Beyond the times of
    /// the motion its laws [go on](Law::going_on).
    pub fn coordinates<T: Number>(&self, p: T, out: &mut [T]) {
        match self {
            Self::Coordinate { .. } => self.coordinates_for(p, &[], out),
            Self::Time { parameters, .. } => {
                let parameters: Vec<T> = parameters.iter().map(|x| T::from_f64(*x)).collect();
                self.coordinates_for(p, &parameters, out);
            }
        }
    }

    /// Drive coordinates at the path parameter for these parameters of the model, which the laws of a path along time
    /// follow. Allocates nothing.
    pub fn coordinates_for<T: Number>(&self, p: T, parameters: &[T], out: &mut [T]) {
        match self {
            Self::Coordinate { drive, held, .. } => {
                for (index, (out, held)) in out.iter_mut().zip(held).enumerate() {
                    *out = if index == *drive {
                        p
                    } else {
                        T::from_f64(*held)
                    };
                }
            }
            Self::Time { laws, end, .. } => {
                for (out, law) in out.iter_mut().zip(laws) {
                    *out = law.going_on(p, parameters, *end);
                }
            }
        }
    }

    /// The path parameter at a time, as a series when `t` is one. Along a coordinate this is the drive's law.
    pub fn parameter_at<T: Number>(&self, model: &Model, t: T, parameters: &[T]) -> T {
        match self {
            Self::Coordinate { drive, .. } => model
                .drives
                .get(*drive)
                .map_or(T::zero(), |d| d.law.at(t, parameters)),
            Self::Time { .. } => t,
        }
    }

    /// Path parameters at which the drives' coordinates are not smooth, in no order.
    pub fn knots(&self) -> Vec<f64> {
        let Self::Time {
            laws, parameters, ..
        } = self
        else {
            return Vec::new();
        };
        let mut list = Vec::new();
        for law in laws {
            list.extend(law.knots(parameters));
        }
        list
    }
}

impl Path for DrivePath {
    fn drive(&self) -> Option<usize> {
        match self {
            Self::Coordinate { drive, .. } => Some(*drive),
            Self::Time { .. } => None,
        }
    }

    fn at(&self, p: f64, coordinates: &mut [f64], rates: &mut [f64]) {
        match self {
            Self::Coordinate { drive, .. } => {
                self.coordinates(p, coordinates);
                rates.fill(0.0);
                if let Some(rate) = rates.get_mut(*drive) {
                    *rate = 1.0;
                }
            }
            Self::Time {
                laws,
                parameters,
                end,
                ..
            } => {
                type Series = kempe_number::Jet<f64, 2>;
                let rich: Vec<Series> = parameters.iter().map(|x| Series::constant(*x)).collect();
                for (law, (q, rate)) in laws.iter().zip(coordinates.iter_mut().zip(rates)) {
                    let series = law.going_on(Series::variable(p), &rich, *end);
                    (*q, *rate) = (series.derivative(0), series.derivative(1));
                }
            }
        }
    }

    fn breaks(&self) -> Vec<f64> {
        match self {
            Self::Coordinate { .. } => Vec::new(),
            Self::Time {
                laws,
                parameters,
                end,
                ..
            } => {
                let mut breaks: Vec<f64> =
                    laws.iter().flat_map(|law| law.breaks(parameters)).collect();
                let near_end = SAME_END * end;
                breaks.retain(|t| *t > near_end && *t < end - near_end);
                breaks.sort_by(f64::total_cmp);
                breaks.dedup();
                breaks
            }
        }
    }

    fn scale(&self) -> f64 {
        match self {
            Self::Coordinate { scale, .. } | Self::Time { scale, .. } => *scale,
        }
    }
}
