//! How a design meets the given places, and the derivatives of its misses.

use std::f64::consts::PI;
use std::sync::Arc;

use kempe_measure::Held;
use kempe_model::{DriveId, Fit, Leaf, Measure, PoseMeasure, StudyKind, Timing, Traced, value};
use kempe_motion::Motion;
use kempe_motion::drive_path::is_cycle;
use kempe_optimize::Piece;
use kempe_units::Expr;

use super::met::{Given, Met, Moving, square};
use super::nearest::{self, Nodes};
use super::pace::{self, By};
use super::way::{Asked, Way};
use crate::designs::bench::{Bench, Refused, crosses};

/// Segments of a way that are looked at: so many at least and at most, and for each given place.
const SEGMENTS: [usize; 2] = [120, 960];
const SEGMENTS_EACH: usize = 4;
/// A way that is to close may be open by this part of the size of what is given and passed.
const CLOSED: f64 = 1e-7;

/// A fit on a bench.
pub(in super::super) struct Fitted<'b, 'm> {
    pub bench: &'b Bench<'m>,
    pub given: Given,
    pub(super) asked: Asked,
    timing: Timing,
    /// Times or coordinates at which places are met.
    pub(super) values: Vec<f64>,
    closed: bool,
    pub(super) circuit: bool,
    segments: usize,
}

/// How given places are paired with places of the way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) enum Pairing {
    /// As the file asks.
    Asked,
    /// Where places are free: the parts of the given curve's length with those of the motion. It tells nothing of how a design fits, and leads to
    /// fits from far away, where nearest places say little.
    Leading,
}

/// How a design meets the given places.
pub(in super::super) struct Seen {
    pub(super) way: Way,
    pub met: Met,
}

/// The coordinate of a drive, or the rate of a measure.
fn of_drive(drive: DriveId) -> Measure {
    Expr::Leaf(Leaf::Drive(drive))
}

fn rate(measure: &Measure) -> Measure {
    Expr::Leaf(Leaf::Rate(Box::new(measure.clone()), 1))
}

fn unmeasured() -> Refused {
    Refused {
        lack: 2.0,
        why: "what is traced cannot be measured along the whole way".to_owned(),
    }
}

impl Seen {
    /// The motion, of a circuit the first.
    pub fn motion(&self) -> &Arc<Motion> {
        self.way.motion(0)
    }

    /// Whether branches cross on the way.
    pub fn crosses(&self) -> bool {
        (0..self.way.strokes()).any(|stroke| crosses(self.way.motion(stroke)))
    }
}

impl<'b, 'm> Fitted<'b, 'm> {
    pub fn new(bench: &'b Bench<'m>, fit: &Fit) -> Self {
        let parameters = bench.model.parameter_values::<f64>();
        let number = |x| value::<f64>(x, &parameters);
        let pose = |it: PoseMeasure| Expr::Leaf(Leaf::Pose(it));
        let point = fit.point();
        let mut places = vec![pose(PoseMeasure::X(point)), pose(PoseMeasure::Y(point))];
        places.extend(fit.link().map(|link| pose(PoseMeasure::Angle(link))));
        let radius = match &fit.traced {
            Traced::Point(_) => 0.0,
            Traced::Link { radius, .. } => number(radius),
        };
        let given = fit.to.iter().map(|it| {
            let [x, y] = [&it.place[0], &it.place[1]].map(number);
            [x, y, it.angle.as_ref().map_or(0.0, |a| radius * number(a))]
        });
        let length =
            (fit.timing == Timing::ArcLength).then(|| pose(PoseMeasure::PathLength(point)));
        let values = match &fit.timing {
            Timing::At(_, values) => values.iter().map(number).collect(),
            _ => Vec::new(),
        };
        let circuit = matches!(&bench.over.kind, StudyKind::Motion(along) if along.circuit);
        Self {
            bench,
            given: Given {
                places: given.collect(),
                turn: 2.0 * PI * radius,
            },
            asked: Asked {
                rates: places.iter().map(rate).collect(),
                places,
                length,
                radius,
            },
            timing: fit.timing.clone(),
            values,
            closed: fit.closed,
            circuit,
            segments: (SEGMENTS_EACH * fit.to.len()).clamp(SEGMENTS[0], SEGMENTS[1]),
        }
    }

    /// How the design with these values meets the given places.
    ///
    /// # Errors
    ///
    /// Why it does not.
    pub fn seen(&self, values: &[f64]) -> Result<Seen, Refused> {
        self.seen_as(values, Pairing::Asked)
    }

    /// The same with places paired as said.
    ///
    /// # Errors
    ///
    /// As [`Self::seen`].
    pub fn seen_as(&self, values: &[f64], pairing: Pairing) -> Result<Seen, Refused> {
        if self.circuit {
            let circuit = self.bench.circuit(values)?;
            let way = Way::of_circuit(&circuit, &self.asked, self.closed || circuit.closed);
            return self.met(way.ok_or_else(unmeasured)?, pairing);
        }
        let motion = self.bench.motion(values, &mut self.bench.watch())?;
        self.along(&motion, pairing)
    }

    /// The misses of the design with these values in the order of [`Self::residuals`]; none where it has not all of them.
    pub fn misses(&self, values: &[f64], pairing: Pairing) -> Option<Vec<f64>> {
        let seen = self.seen_as(values, pairing).ok()?;
        let size = self.asked.places.len();
        let all = seen.met.misses.iter();
        Some(
            all.flat_map(|miss| miss.iter().copied().take(size))
                .collect(),
        )
    }

    fn along(&self, motion: &Arc<Motion>, pairing: Pairing) -> Result<Seen, Refused> {
        let model = &motion.mechanism().model;
        if self.closed && !is_cycle(model, &motion.design.parameters) {
            return Err(self.open());
        }
        let way = Way::of_motion(motion, &self.asked, self.closed);
        self.met(way.ok_or_else(unmeasured)?, pairing)
    }

    fn open(&self) -> Refused {
        Refused {
            lack: 2.0,
            why: "the way does not come back to its start".to_owned(),
        }
    }

    fn met(&self, mut way: Way, pairing: Pairing) -> Result<Seen, Refused> {
        if let Timing::At(drive, _) = &self.timing {
            let times = self.times(&way, *drive)?;
            let met = pace::at_times(&mut way, &self.given, &times);
            return Self::sound(way, met);
        }
        if way.closed && !self.circuit {
            let [first, last] = [way.here(0.0).at, way.last()];
            let sizes = self.given.places.iter().chain([&first]);
            let size = sizes.map(|p| square(p).sqrt()).fold(0.0, f64::max);
            let apart = [first[0] - last[0], first[1] - last[1]];
            let arc = self.given.turned(first[2] - last[2]);
            if !(square(&[apart[0], apart[1], arc]).sqrt() <= CLOSED * size) {
                return Err(self.open());
            }
        }
        let segments = self.segments * way.strokes();
        let nodes = Nodes::new(&mut way, segments).ok_or_else(unmeasured)?;
        if pairing == Pairing::Leading {
            let parts = pace::parts(&self.given, By::Length, way.closed);
            let met = pace::paced(&mut way, &nodes, &self.given, By::Time, &parts);
            return Self::sound(way, met.ok_or_else(unmeasured)?);
        }
        let met = match &self.timing {
            Timing::Nearest => nearest::each(&mut way, &nodes, &self.given),
            Timing::Even => self.paced(&mut way, &nodes, By::Time)?,
            Timing::ArcLength => self.paced(&mut way, &nodes, By::Length)?,
            _ => nearest::ordered(&mut way, &nodes, &self.given),
        };
        Self::sound(way, met)
    }

    fn paced(&self, way: &mut Way, nodes: &Nodes, by: By) -> Result<Met, Refused> {
        let parts = pace::parts(&self.given, by, way.closed);
        pace::paced(way, nodes, &self.given, by, &parts).ok_or_else(unmeasured)
    }

    fn sound(way: Way, met: Met) -> Result<Seen, Refused> {
        match met.square().is_finite() {
            true => Ok(Seen { way, met }),
            false => Err(unmeasured()),
        }
    }

    /// When the drive, or the time, has its values.
    fn times(&self, way: &Way, drive: Option<DriveId>) -> Result<Vec<f64>, Refused> {
        let motion = way.motion(0);
        let parameters = &motion.design.parameters;
        let times = self.values.iter().map(|value| match drive {
            Some(drive) => pace::passed(&motion.mechanism().model, drive, *value, parameters),
            None => (*value >= 0.0 && *value <= way.duration()).then_some(*value),
        });
        let times: Option<Vec<f64>> = times.collect();
        times.ok_or_else(|| Refused {
            lack: 2.0,
            why: "the motion does not pass all the values at which places are to be met".to_owned(),
        })
    }

    /// Whether places are free to be met anywhere, and time runs along, so that another pairing may lead.
    pub(super) fn is_led(&self) -> bool {
        let free = matches!(self.timing, Timing::Ordered | Timing::Nearest);
        free && !self.circuit
    }

    /// The misses with their derivatives to the varied parameters; what is free of where places are met is eliminated.
    ///
    /// # Errors
    ///
    /// Why there are none.
    pub fn residuals(&self, seen: &mut Seen) -> Result<Vec<Piece>, Refused> {
        let (way, met) = (&mut seen.way, &seen.met);
        let (n, count) = (met.at.len(), self.bench.varied.len());
        let size = self.asked.places.len();
        let more: Vec<Measure> = match (&self.timing, &self.asked.length) {
            (Timing::At(Some(drive), _), _) => vec![of_drive(*drive), rate(&of_drive(*drive))],
            (_, Some(length)) => vec![length.clone()],
            _ if met.moving.iter().any(|m| matches!(m, Moving::Paced(_))) => {
                vec![Expr::Leaf(Leaf::Time)]
            }
            _ => Vec::new(),
        };
        let measures: Vec<&Measure> = self.asked.places.iter().chain(&more).collect();
        let mut rows = vec![vec![vec![0.0; count]; 3]; n];
        for stroke in 0..way.strokes() {
            let ends = |k: usize| met.moving[k] == Moving::End;
            let all: Vec<(usize, (usize, Held))> =
                (0..n).map(|k| (k, way.held(met.at[k], ends(k)))).collect();
            let own: Vec<usize> = (all.iter().filter(|(_, (s, _))| *s == stroke))
                .map(|(k, _)| *k)
                .collect();
            let mut held: Vec<Held> = own.iter().map(|k| all[*k].1.1).collect();
            if own.is_empty() {
                continue;
            }
            let paced = met.moving.iter().any(|m| matches!(m, Moving::Paced(_)));
            if paced {
                held.push(Held::Break(way.duration()));
            }
            let motion = way.motion(stroke).clone();
            let found = self.bench.sensitivities(&motion, &held, &measures)?;
            let whole = found.last().filter(|_| paced);
            for (place, slopes) in own.iter().zip(&found) {
                let row = &mut rows[*place];
                for i in 0..size {
                    let by = if i == 2 { self.asked.radius } else { 1.0 };
                    for (entry, slope) in row[i].iter_mut().zip(&slopes.derivatives[i]) {
                        *entry = by * slope;
                    }
                }
                let u = met.at[*place];
                let here = way.here(u);
                // How the place's own time changes with each parameter.
                let per_time = here.rate.map(|x| x / way.time_rate(u));
                let times: Vec<f64> = match (met.moving[*place], whole) {
                    (Moving::Timed(_), _) if !more.is_empty() => {
                        let speed = slopes.values[size + 1];
                        let own = slopes.derivatives[size].iter();
                        own.map(|d| if *d == 0.0 { 0.0 } else { -d / speed })
                            .collect()
                    }
                    (Moving::Paced(part), Some(whole)) => {
                        let both = slopes.derivatives[size].iter();
                        let both = both.zip(&whole.derivatives[size]);
                        match self.asked.length {
                            Some(_) => {
                                let [x, y, _] = per_time;
                                let speed = (x * x + y * y).sqrt();
                                both.map(|(own, all)| (part * all - own) / speed).collect()
                            }
                            None => both.map(|(_, all)| part * all).collect(),
                        }
                    }
                    _ => Vec::new(),
                };
                for (entries, rate) in row.iter_mut().zip(per_time) {
                    for (entry, time) in entries.iter_mut().zip(&times) {
                        if *time != 0.0 {
                            *entry += rate * time;
                        }
                    }
                }
            }
        }
        for direction in &met.free {
            let mut along = vec![0.0; count];
            for (place, unit) in direction {
                for (entries, share) in rows[*place].iter().zip(unit) {
                    along
                        .iter_mut()
                        .zip(entries)
                        .for_each(|(a, e)| *a += share * e);
                }
            }
            for (place, unit) in direction {
                for (entries, share) in rows[*place].iter_mut().zip(unit) {
                    entries
                        .iter_mut()
                        .zip(&along)
                        .for_each(|(e, a)| *e -= share * a);
                }
            }
        }
        let pieces = rows.into_iter().zip(&met.misses).flat_map(|(row, miss)| {
            let all = row.into_iter().zip(*miss).take(size);
            all.map(|(slope, value)| Piece { value, slope })
        });
        let pieces: Vec<Piece> = pieces.collect();
        let sound = |piece: &Piece| piece.slope.iter().all(|d| d.is_finite());
        match pieces.iter().all(sound) {
            true => Ok(pieces),
            false => Err(unmeasured()),
        }
    }
}

/// The sum of squares with its slope.
pub(in super::super) fn sum(residuals: &[Piece]) -> Piece {
    let mut sum = Piece {
        value: 0.0,
        slope: vec![0.0; residuals.first().map_or(0, |r| r.slope.len())],
    };
    for residual in residuals {
        sum.value += residual.value * residual.value;
        for (all, own) in sum.slope.iter_mut().zip(&residual.slope) {
            *all += 2.0 * residual.value * own;
        }
    }
    sum
}
