//! Where the bodies of joints with play touch, and what became of every touch.

use kempe_dynamics::joint_contact::{JointContact, Resists};
use kempe_model::{DriveId, Law, Touching};
use kempe_number::Jet;

/// A place of a joint with play.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Which of the contacts that were asked about.
    pub contact: usize,
    /// The corner of a block, or 0.
    pub place: usize,
}

/// What became of a touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touched {
    /// Where.
    pub at: Place,
    /// Since when and until when, and how fast they came together.
    pub touching: Touching,
    /// How fast they parted, m/s; none where they still touch at the end.
    pub parting: Option<f64>,
    /// The deepest indentation, m, and when, s.
    pub depth: [f64; 2],
    /// The largest force that presses, N, and when, s.
    pub force: [f64; 2],
}

impl Touched {
    /// Whether it lasts at a time, s: to the end, where it has not ended then.
    pub fn lasts_at(&self, time: f64) -> bool {
        self.touching.from <= time && (time < self.touching.to || self.parting.is_none())
    }

    /// The time that forces go by: what still touches at the end does so there, too.
    pub(crate) fn acting(&self) -> Touching {
        let to = match self.parting {
            Some(_) => self.touching.to,
            None => f64::INFINITY,
        };
        Touching {
            to,
            ..self.touching
        }
    }
}

/// Parts of every step that are looked at before the largest force is located between two of them.
const LOOKS: usize = 4;
/// Steps of the golden section: to rounding of what is flat there.
const STEPS: usize = 50;

/// What became of every touch, by the laws of the drives that were found; in order of time.
pub(crate) fn touched(contacts: &[JointContact], laws: &[Law], end: f64) -> Vec<Touched> {
    let mut all: Vec<Touched> = Vec::new();
    for (index, contact) in contacts.iter().enumerate() {
        let Resists::ByLaw { normal, .. } = &contact.resists else {
            continue;
        };
        let knots = contact.along.iter().filter_map(|row| laws.get(row.index()));
        let mut knots: Vec<f64> = knots.flat_map(|law| law.knots(&[])).collect();
        knots.sort_by(f64::total_cmp);
        knots.dedup();
        let at = |place: usize, time: f64| -> [f64; 2] {
            let row = |drive: DriveId| match laws.get(drive.index()) {
                Some(law) => law.at(Jet::<f64, 2>::variable(time), &[]),
                None => Jet::constant(f64::NAN),
            };
            *contact.gap(place, contact.along.map(row)).coefficients()
        };
        for touching in contact.touches.iter().flatten() {
            let place = touching.place;
            let touching = Touching {
                to: touching.to.min(end),
                ..*touching
            };
            let depth = |[gap, _]: [f64; 2]| -gap;
            let force = |[gap, rate]: [f64; 2]| normal.force(-gap, -rate, touching.counts_as);
            let at = |time: f64| at(place, time);
            let times = looked_at(&touching, &knots);
            let seen: Vec<[f64; 2]> = times.iter().map(|time| at(*time)).collect();
            all.push(Touched {
                at: Place {
                    contact: index,
                    place,
                },
                parting: (touching.to < end).then(|| at(touching.to)[1]),
                depth: largest(at, depth, &times, &seen),
                force: largest(at, force, &times, &seen),
                touching,
            });
        }
    }
    all.sort_by(|a, b| a.touching.from.total_cmp(&b.touching.from));
    all
}

/// Times during a touch that are looked at, both ends included: `knots` are the ends of the steps in which the motion was found.
fn looked_at(during: &Touching, knots: &[f64]) -> Vec<f64> {
    let first = knots.partition_point(|t| *t <= during.from);
    let inside = knots.iter().skip(first).take_while(|t| **t < during.to);
    let ends: Vec<f64> = std::iter::once(during.from)
        .chain(inside.copied())
        .chain([during.to])
        .collect();
    let parts = ends.windows(2).flat_map(|pair| {
        let [from, to] = [pair[0], pair[1]];
        (0..LOOKS).map(move |k| from + (to - from) * k as f64 / LOOKS as f64)
    });
    parts.chain([during.to]).collect()
}

/// The largest value of what is seen, and when: at these times this was `seen`.
fn largest(
    at: impl Fn(f64) -> [f64; 2],
    of: impl Fn([f64; 2]) -> f64,
    times: &[f64],
    seen: &[[f64; 2]],
) -> [f64; 2] {
    let value = |time: f64| of(at(time));
    let values: Vec<f64> = seen.iter().map(|seen| of(*seen)).collect();
    let best = (1..times.len()).fold(0, |best, k| if values[k] > values[best] { k } else { best });
    let (mut low, mut high) = (
        times[best.saturating_sub(1)],
        times[(best + 1).min(times.len() - 1)],
    );
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let inner = |low: f64, high: f64| {
        let part = golden * (high - low);
        [high - part, low + part]
    };
    let [mut a, mut b] = inner(low, high);
    let [mut at_a, mut at_b] = [value(a), value(b)];
    for _ in 0..STEPS {
        // One of the two places inside stays, and what is known there.
        if at_a < at_b {
            low = a;
            (a, at_a) = (b, at_b);
            b = inner(low, high)[1];
            at_b = value(b);
        } else {
            high = b;
            (b, at_b) = (a, at_a);
            a = inner(low, high)[0];
            at_a = value(a);
        }
    }
    let found = 0.5 * (low + high);
    let at_found = value(found);
    match at_found >= values[best] {
        true => [at_found, found],
        false => [values[best], times[best]],
    }
}
