//! The way of what is traced, through one motion or the strokes of a circuit.
//!
//! A way is told by a number from 0 on that grows by one over each stroke. Over a motion it goes evenly with time; over a stroke of a circuit so that it
//! slows down at the dead points at its ends, where the drive's coordinate tells nothing: places are smooth in it.

use std::f64::consts::PI;
use std::sync::Arc;

use kempe_measure::{Held, Sampler};
use kempe_model::Measure;
use kempe_motion::Motion;
use kempe_motion::circuit::Circuit;
use kempe_number::math;

/// Nearer to an end of a stroke of a circuit than this part of it nothing is asked: a dead point has no rates.
const BESIDE: f64 = 1e-6;

/// A place with its rate, both in lengths: of a point the third of them is none, of a link the arc of its angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Here {
    pub at: [f64; 3],
    /// For each unit of the way.
    pub rate: [f64; 3],
    /// The length of path so far, where it was asked for.
    pub length: f64,
}

/// A motion of a way.
struct Stroke {
    motion: Arc<Motion>,
    sampler: Sampler,
    duration: f64,
}

/// What is asked of every way.
pub(super) struct Asked {
    /// x, y and, of a link, its angle.
    pub places: Vec<Measure>,
    /// Their rates.
    pub rates: Vec<Measure>,
    /// The length of path.
    pub length: Option<Measure>,
    /// What an angle counts as.
    pub radius: f64,
}

/// The way of what is traced.
pub(super) struct Way {
    strokes: Vec<Stroke>,
    of_circuit: bool,
    radius: f64,
    places: usize,
    /// Whether it comes back to its start.
    pub closed: bool,
}

impl Way {
    /// Through a motion; `None` where it cannot be measured.
    pub fn of_motion(motion: &Arc<Motion>, asked: &Asked, closed: bool) -> Option<Self> {
        let stroke = Stroke::new(motion, asked)?;
        Some(Self {
            strokes: vec![stroke],
            of_circuit: false,
            radius: asked.radius,
            places: asked.places.len(),
            closed,
        })
    }

    /// Through a whole circuit.
    pub fn of_circuit(circuit: &Circuit, asked: &Asked, closed: bool) -> Option<Self> {
        let strokes = circuit.stretches.iter();
        let strokes = strokes.map(|stroke| Stroke::new(&stroke.motion, asked));
        let strokes = strokes.collect::<Option<Vec<_>>>()?;
        (!strokes.is_empty()).then_some(Self {
            strokes,
            of_circuit: true,
            radius: asked.radius,
            places: asked.places.len(),
            closed: closed && circuit.closed,
        })
    }

    /// Where it ends.
    pub fn end(&self) -> f64 {
        self.strokes.len() as f64
    }

    /// The number within the way.
    pub fn within(&self, u: f64) -> f64 {
        match self.closed {
            true => u.rem_euclid(self.end()),
            false => u.clamp(0.0, self.end()),
        }
    }

    /// How long the motion takes, s.
    pub fn duration(&self) -> f64 {
        self.strokes.iter().map(|s| s.duration).sum()
    }

    /// Which stroke a place lies on, the time there and its change over the way.
    fn timed(&self, u: f64) -> (usize, f64, f64) {
        let u = self.within(u);
        let index = (u.floor() as usize).min(self.strokes.len() - 1);
        let part = u - index as f64;
        let duration = self.strokes[index].duration;
        match self.of_circuit {
            false => (index, part * duration, duration),
            true => {
                let part = part.clamp(BESIDE, 1.0 - BESIDE);
                let time = duration * (1.0 - math::cos(PI * part)) / 2.0;
                (index, time, duration * PI * math::sin(PI * part) / 2.0)
            }
        }
    }

    /// What is there, and how it goes on.
    pub fn here(&mut self, u: f64) -> Here {
        let (index, time, change) = self.timed(u);
        let (n, radius) = (self.places, self.radius);
        let values = self.strokes[index].sampler.values_at_time(time);
        let three = |from: usize, by: f64| {
            let arc = if n > 2 {
                radius * values[from + 2]
            } else {
                0.0
            };
            [values[from] * by, values[from + 1] * by, arc * by]
        };
        Here {
            at: three(0, 1.0),
            rate: three(n, change),
            length: values.get(2 * n).copied().unwrap_or(f64::NAN),
        }
    }

    /// What is passed at the very end, of a motion.
    pub fn last(&mut self) -> [f64; 3] {
        let n = self.places;
        let Some(stroke) = self.strokes.last_mut() else {
            return [f64::NAN; 3];
        };
        let values = stroke.sampler.values_at_time(stroke.duration);
        let arc = if n > 2 { self.radius * values[2] } else { 0.0 };
        [values[0], values[1], arc]
    }

    /// The length of the whole path, where it was asked for.
    pub fn whole_length(&mut self) -> f64 {
        let n = 2 * self.places;
        let length = |stroke: &mut Stroke| {
            let values = stroke.sampler.values_at_time(stroke.duration);
            values.get(n).copied().unwrap_or(f64::NAN)
        };
        self.strokes.iter_mut().map(length).sum()
    }

    /// The motion that a place is of, and what of it is held there: its time, or an end of it.
    pub fn held(&self, u: f64, at_end: bool) -> (usize, Held) {
        let (index, time, _) = self.timed(u);
        match at_end {
            true => (index, Held::Break(time)),
            false => (index, Held::Time(time)),
        }
    }

    /// How much time a unit of the way takes at a place, s.
    pub fn time_rate(&self, u: f64) -> f64 {
        self.timed(u).2
    }

    /// A stroke's motion.
    pub fn motion(&self, stroke: usize) -> &Arc<Motion> {
        &self.strokes[stroke].motion
    }

    /// How many motions there are.
    pub fn strokes(&self) -> usize {
        self.strokes.len()
    }

    /// The drive's coordinate, or the time where several drives move, at a place.
    pub fn coordinate(&mut self, u: f64) -> f64 {
        let (index, time, _) = self.timed(u);
        self.strokes[index].sampler.at_time(time).parameter
    }
}

impl Stroke {
    fn new(motion: &Arc<Motion>, asked: &Asked) -> Option<Self> {
        let all = asked.places.iter().chain(&asked.rates).chain(&asked.length);
        let measures: Vec<&Measure> = all.collect();
        let model = &motion.mechanism().model;
        let duration = kempe_motion::drive_path::duration(model, &motion.design.parameters);
        Some(Self {
            motion: motion.clone(),
            sampler: Sampler::new(motion, &measures).ok()?,
            duration,
        })
    }
}
