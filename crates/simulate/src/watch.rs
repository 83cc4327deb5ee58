//! What is looked for between steps.

use std::cell::Cell;

use kempe_integrate::{Integrator, crossing};
use kempe_model::Measure;

use crate::joints::Place;
use crate::plant::Plant;
use crate::question::Resistance;
use crate::rubbing::Rub;

/// Places within a step that are looked at.
const PARTS: usize = 8;
/// A gap that begins closed is not passed above this (in path scales).
const GRAZES: f64 = 1e-13;
/// Halvings towards the beginning of a step before what began at zero counts as never having been open.
const HALVINGS: usize = 40;

/// A cylinder whose points are this near each other (in mechanism sizes) has no length.
const NO_LENGTH: f64 = 1e-9;

/// Something that happens when its value becomes negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Watch {
    /// A rigid stop is struck.
    Strikes(usize),
    /// A soft stop is touched.
    Touches(usize),
    /// A soft stop is left.
    Parts(usize),
    /// A stop on which it rests is left; its place among those.
    Leaves(usize),
    /// The bodies of a joint with play come together.
    Meets(Place),
    /// They part.
    Separates(Place),
    /// A place that rubs comes to rest.
    Turned(usize),
    /// A place that rubs begins to slide, that nothing moved.
    Stirs(usize),
    /// Friction lets something go that it holds.
    Slips,
    /// The two points of a cylinder meet, by the place of its drive among the coordinates.
    Shrinks(usize),
    /// A condition holds; whether it did not, yet.
    Ends(usize, bool),
}

/// What is to be watched in the plant's mode.
pub(crate) fn watches(plant: &Plant, conditions: &[bool]) -> Vec<Watch> {
    let mode = &plant.mode;
    let mut list = Vec::new();
    if plant.holds_somewhere() {
        list.push(Watch::Slips);
    }
    list.extend((0..mode.resting.len()).map(Watch::Leaves));
    if !mode.stuck {
        for (place, rub) in mode.rubs.iter().enumerate() {
            match rub {
                Rub::Slides(_) => list.push(Watch::Turned(place)),
                Rub::Idle => list.push(Watch::Stirs(place)),
                Rub::Held | Rub::Apart => {}
            }
        }
        for (index, stop) in plant.stops.iter().enumerate() {
            match stop.resistance {
                Resistance::Rigid { .. } => {
                    if !mode.resting.contains(&index) && !mode.beside.contains(&index) {
                        list.push(Watch::Strikes(index));
                    }
                }
                Resistance::Soft { .. } if mode.touched.contains(&index) => {
                    list.push(Watch::Parts(index));
                }
                Resistance::Soft { .. } => list.push(Watch::Touches(index)),
            }
        }
        list.extend(
            plant
                .contact_places()
                .into_iter()
                .map(|at| match plant.is_touching(at) {
                    true => Watch::Separates(at),
                    false => Watch::Meets(at),
                }),
        );
    }
    list.extend(plant.cylinders.iter().map(|k| Watch::Shrinks(*k)));
    list.extend((conditions.iter().enumerate()).map(|(k, armed)| Watch::Ends(k, *armed)));
    list
}

/// Something that happened in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Event {
    /// When, s.
    pub time: f64,
    /// What.
    pub watch: Watch,
    /// Whether it did: otherwise what it goes by has no value from there on.
    pub has_value: bool,
}

impl Watch {
    fn value(self, plant: &mut Plant, ends: &[Measure], time: f64, y: &[f64]) -> Option<f64> {
        match self {
            Self::Strikes(k) | Self::Touches(k) => plant.open(k, time, y),
            Self::Parts(k) => plant.open(k, time, y).map(|open| -open),
            Self::Leaves(k) => plant.pushed(k, time, y),
            Self::Meets(at) => Some(plant.opening(at, y)[0]),
            Self::Separates(at) => Some(-plant.opening(at, y)[0]),
            Self::Turned(place) | Self::Stirs(place) => plant.slides(place, time, y),
            Self::Slips => plant.firmness(time, y).map(|(firm, _)| firm),
            Self::Shrinks(k) => Some(y.get(k)? - NO_LENGTH * plant.scales.get(k)?),
            Self::Ends(k, _) => plant.value(ends.get(k)?, time, y).map(|above| -above),
        }
    }
}

impl Watch {
    /// By how much its value may be below zero where it begins there: by the rounding of a gap.
    fn slack(self, plant: &mut Plant, time: f64, y: &[f64]) -> f64 {
        let scale = match self {
            Self::Strikes(k) | Self::Touches(k) | Self::Parts(k) => {
                let gap = plant.gap(k, time, y);
                gap.map_or(0.0, |gap| gap.scale(&plant.scales))
            }
            Self::Meets(_) | Self::Separates(_) => 0.0,
            // What friction just lets go may begin to slide the wrong way, by rounding.
            Self::Turned(place) => return plant.hardly(place),
            _ => return 0.0,
        };
        // A stop on what stands still has none of its own.
        let any = plant.scales.iter().copied().fold(0.0, f64::max);
        GRAZES * if scale > 0.0 { scale } else { any }
    }
}

/// What happens first in the last step, and when. Conditions that come to be false on the way are armed from then on.
pub(crate) fn first(
    it: &mut Integrator,
    plant: &mut Plant,
    ends: &[Measure],
    conditions: &mut [bool],
    y: &mut [f64],
) -> Option<Event> {
    let (from, to) = (it.before(), it.time());
    let place = |k: usize| match k {
        PARTS => to,
        k => from + (to - from) * (k as f64 / PARTS as f64),
    };
    let mut earliest: Option<Event> = None;
    for watch in watches(plant, conditions) {
        // Whether there was a pose but no value where it was asked for last.
        let valueless = Cell::new(false);
        let mut at = |time: f64, plant: &mut Plant, y: &mut [f64]| -> f64 {
            let there = it.between(plant, time, y);
            let value = there.then(|| watch.value(plant, ends, time, y)).flatten();
            valueless.set(value.is_some_and(|x| !x.is_finite()));
            value.unwrap_or(f64::NAN)
        };
        let mut armed = !matches!(watch, Watch::Ends(_, false));
        let mut low = from;
        let mut open = at(from, plant, y) > 0.0;
        // What begins closed may be off by rounding.
        let slack = if open {
            0.0
        } else {
            watch.slack(plant, from, y)
        };
        // The last place at which it had a value, and whether it had none at the last.
        let (mut known, mut lost) = (from, valueless.get());
        for k in 1..=PARTS {
            let high = place(k);
            // What comes behind the first event does not come.
            if earliest.is_some_and(|first| first.time < high) && !armed {
                break;
            }
            let value = at(high, plant, y);
            // At an instant alone it may have none, as the curvature of a path where its point turns back.
            if valueless.get() && lost {
                let mut none = high;
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (known + none);
                    at(middle, plant, y);
                    *(if valueless.get() {
                        &mut none
                    } else {
                        &mut known
                    }) = middle;
                }
                if earliest.is_none_or(|first| known < first.time) {
                    earliest = Some(Event {
                        time: known,
                        watch,
                        has_value: false,
                    });
                }
                break;
            }
            lost = valueless.get();
            if !lost {
                known = high;
            }
            if value > 0.0 || (value == 0.0 && open) {
                (low, open, armed) = (high, true, true);
                continue;
            }
            if !armed || value.is_nan() || (!open && value >= -slack) {
                continue;
            }
            let found = if open {
                crossing(|t| at(t, plant, y), low, high)
            } else {
                // It begins at zero: open a little later, or never.
                let mut part = high - low;
                let opens = (0..HALVINGS).find_map(|_| {
                    part *= 0.5;
                    (at(low + part, plant, y) > 0.0).then_some(low + part)
                });
                match opens {
                    Some(opens) => crossing(|t| at(t, plant, y), opens, high),
                    None => Some(low),
                }
            };
            if let Some(time) = found
                && earliest.is_none_or(|first| time < first.time)
            {
                earliest = Some(Event {
                    time,
                    watch,
                    has_value: true,
                });
            }
            break;
        }
        if let Watch::Ends(k, _) = watch
            && let Some(known) = conditions.get_mut(k)
        {
            *known |= armed;
        }
    }
    earliest
}
