//! What is looked for between steps.

use kempe_model::Measure;

use crate::plant::Plant;
use crate::question::Resistance;
use crate::site::Rub;
use crate::touched::Place;

/// A gap that begins closed is not passed above this (in path scales).
const GRAZES: f64 = 1e-13;
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
    pub fn value(self, plant: &mut Plant, ends: &[Measure], time: f64, y: &[f64]) -> Option<f64> {
        match self {
            Self::Strikes(k) | Self::Touches(k) => plant.open(k, time, y),
            Self::Parts(k) => plant.open(k, time, y).map(|open| -open),
            Self::Leaves(k) => plant.pushed(k, time, y),
            Self::Meets(at) => Some(plant.opening(at, y)[0]),
            Self::Separates(at) => Some(-plant.opening(at, y)[0]),
            Self::Turned(place) | Self::Stirs(place) => plant.slides(place, time, y),
            Self::Slips => plant.firmness(time, y).map(|(firm, _)| firm),
            Self::Shrinks(k) => {
                let [length, size] = plant.length_of(k, time, y)?;
                Some(length - NO_LENGTH * size)
            }
            Self::Ends(k, _) => plant.value(ends.get(k)?, time, y).map(|above| -above),
        }
    }
}

impl Watch {
    /// By how much its value may be below zero where it begins there: by the rounding of a gap.
    pub fn slack(self, plant: &mut Plant, ends: &[Measure], time: f64, y: &[f64]) -> f64 {
        let scale = match self {
            Self::Strikes(k) | Self::Touches(k) | Self::Parts(k) => {
                let gap = plant.gap(k, time, y);
                gap.map_or(0.0, |gap| gap.scale(&plant.scales))
            }
            Self::Meets(_) | Self::Separates(_) => 0.0,
            Self::Ends(k, _) => return by_rounding(plant, ends.get(k), time, y),
            // What friction just lets go may begin to slide the wrong way, by rounding.
            Self::Turned(place) => return plant.hardly(place),
            _ => return 0.0,
        };
        // A stop on what stands still has none of its own.
        let any = plant.scales.iter().copied().fold(0.0, f64::max);
        GRAZES * if scale > 0.0 { scale } else { any }
    }
}

/// By how much a condition changes where every coordinate does by the rounding of a gap.
fn by_rounding(plant: &mut Plant, end: Option<&Measure>, time: f64, y: &[f64]) -> f64 {
    let Some(end) = end else { return 0.0 };
    let (scales, mut moved) = (plant.scales.clone(), y.to_vec());
    let here = plant.value(end, time, y);
    let changes = scales.iter().enumerate().map(|(k, scale)| {
        moved[k] = y[k] + GRAZES * scale;
        let there = plant.value(end, time, &moved);
        moved[k] = y[k];
        let change = here.zip(there).map(|(here, there)| (there - here).abs());
        change.filter(|x| x.is_finite()).unwrap_or(0.0)
    });
    changes.sum()
}
