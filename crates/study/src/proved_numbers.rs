//! Numbers over the motion, proved: the largest and the smallest value of what is measured of poses, between bounds.

use std::sync::Arc;

use kempe_measure::measure::{Along, History, measure, visit_leaves};
use kempe_measure::{Abscissa, NoForces, Sampler, Series, State, unmeasurable};
use kempe_mechanism::{Branch, Design};
use kempe_model::{Leaf, Measure, PoseMeasure, Statistic};
use kempe_motion::Motion;
use kempe_motion::progress::{Done, Progress, Stage};
use kempe_number::text::rounded;
use kempe_number::{Interval, Number};
use kempe_proof::{Cell, CertifiedMotion, Certifier};
use kempe_units::{Dimension, Unit, format_digits};
use serde::Serialize;

use crate::columns::numbers;
use crate::quantity::Quantity;
use crate::unit::Units;

/// Bounds are wanted as near to each other as this part of what they bound.
const NARROW: f64 = 1e-6;
/// A number may miss its bounds by this part of them: it was found in plain numbers.
const ROUNDING: f64 = 1e-9;
/// Digits that are told of bounds, and what the last of them stands for at most, as a part.
const DIGITS: usize = 9;
const LAST: f64 = 1e-8;

/// A number over the motion, and what is proved of it.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct ProvedNumber {
    /// The measure's name.
    pub name: String,
    /// What `run` tells, SI; NaN of forces.
    pub value: f64,
    /// Bounds that hold it, SI: proved.
    pub bounds: Option<(f64, f64)>,
    /// Whether the value lies outside of bounds that were proved: one of both is wrong.
    pub contradicted: bool,
    /// With its unit, as it is told to people.
    pub told: String,
}

/// Proves what can be proved of a model's numbers over a proved motion: those of poses. Of speeds and forces nothing is. None
/// where it is stopped.
pub(crate) fn prove_numbers(
    motion: &Arc<Motion>,
    proved: &CertifiedMotion,
    progress: &mut dyn Progress,
) -> Vec<ProvedNumber> {
    let model = &motion.mechanism().model;
    let mut asked = numbers(model);
    asked.retain(|q| unmeasurable(motion.mechanism(), &[&q.measure]).is_empty());
    let measures: Vec<&Measure> = asked.iter().map(|q| &q.measure).collect();
    // Those of forces need their source, and have no value here.
    let Ok(mut sampler) = Sampler::with_progress(motion, &measures, NoForces, progress) else {
        return Vec::new();
    };
    let values = sampler.values_at_parameter(motion.start);
    let mut prover = Prover::new(motion, proved);
    let units = Units::of(model);
    let mut list = Vec::new();
    for (quantity, value) in asked.iter().zip(values) {
        let bounds = prover.bounds(&quantity.measure, progress);
        let finding = if !proved.is_whole() {
            Finding::NotProved("the motion is not proved as one run")
        } else if value.is_nan() {
            Finding::NotProved("it has no value from poses alone")
        } else if bounds.is_empty() || !bounds.width().is_finite() {
            Finding::NotProved(
                "it is no largest or smallest value or range of what poses tell, or its bounds stayed wide",
            )
        } else if holds(bounds, value) {
            Finding::Proved(bounds)
        } else if counts_turns(motion, &quantity.measure) {
            Finding::NotProved(
                "bounds are those of directions without the turns that they have made",
            )
        } else if gap(bounds, value) <= ROUNDING * scale(quantity.dimension, motion.size()) {
            Finding::NotProved("it lies beside its bounds by rounding")
        } else {
            Finding::Contradicted(bounds)
        };
        list.push(ProvedNumber {
            name: quantity.name.clone(),
            value,
            bounds: match finding {
                Finding::Proved(b) => Some((b.lo(), b.hi())),
                _ => None,
            },
            contradicted: matches!(finding, Finding::Contradicted(_)),
            told: told(&units, quantity, value, &finding),
        });
        if progress.reached(Stage::Proving, Done::Unknown).is_break() {
            return Vec::new();
        }
    }
    list
}

/// What became of the proof of a number.
enum Finding {
    Proved(Interval),
    NotProved(&'static str),
    /// It lies outside of its bounds: one of both is wrong.
    Contradicted(Interval),
}

/// Whether bounds hold a number, but for its rounding.
fn holds(bounds: Interval, value: f64) -> bool {
    gap(bounds, value) <= ROUNDING * bounds.lo().abs().max(bounds.hi().abs())
}

/// How far a number lies outside of bounds.
fn gap(bounds: Interval, value: f64) -> f64 {
    (bounds.lo() - value).max(value - bounds.hi()).max(0.0)
}

/// A typical size of a quantity: what differences of such are rounded to. Of most it is not known.
fn scale(dimension: Dimension, size: f64) -> f64 {
    match dimension {
        Dimension::LENGTH => size,
        Dimension::ANGLE | Dimension::NONE => 1.0,
        _ => f64::INFINITY,
    }
}

/// Whether a measure asks for directions, which the motion unwraps and a proof does not.
fn counts_turns(motion: &Motion, measure: &Measure) -> bool {
    let mut counts = false;
    visit_leaves(motion.mechanism(), measure, &mut |leaf| {
        counts |= matches!(leaf, Leaf::Pose(PoseMeasure::Direction(..)));
    });
    counts
}

fn told(units: &Units, quantity: &Quantity, value: f64, finding: &Finding) -> String {
    let unit = quantity.unit(units);
    let text = |x: f64| format_digits(x + 0.0, &unit, DIGITS);
    let between = |b: &Interval| {
        let [low, high] =
            [(b.lo(), -1.0), (b.hi(), 1.0)].map(|(x, out)| text(outward(x, out, &unit)));
        format!("between {low} and {high}")
    };
    match finding {
        Finding::Proved(b) => format!("{}, proved {}", text(value), between(b)),
        Finding::NotProved(why) if value.is_nan() => format!("not proved: {why}"),
        Finding::NotProved(why) => format!("{}, not proved: {why}", text(value)),
        Finding::Contradicted(b) => format!(
            "{}, but proved {}: one of both is wrong, please report it with this file",
            text(value),
            between(b)
        ),
    }
}

/// A bound, SI, as it is told: rounded away from what it holds, down for `out` -1 and up for 1.
fn outward(bound: f64, out: f64, unit: &Unit) -> f64 {
    let exact = unit.from_si(bound);
    let told = rounded(exact, DIGITS);
    let is_inside = (told - exact) * out < 0.0;
    let step = if is_inside {
        out * LAST * exact.abs()
    } else {
        0.0
    };
    unit.to_si(rounded(told + step, DIGITS))
}

/// Bounds measures over proved stretches.
struct Prover<'a> {
    motion: &'a Arc<Motion>,
    proved: &'a CertifiedMotion,
    certifier: Certifier,
    design: Arc<Design<Series<Interval>>>,
    branch: Branch,
    /// What was found of statistics.
    known: Vec<(Statistic, Measure, Interval)>,
}

impl<'a> Prover<'a> {
    fn new(motion: &'a Arc<Motion>, proved: &'a CertifiedMotion) -> Self {
        let given = motion.design.parameters.iter();
        let parameters: Vec<Interval> = given.map(|x| Interval::from_f64(*x)).collect();
        let plain = motion.design_of(&parameters);
        // Not computed as series: a triangle whose points lie in line would divide by an interval that holds zero.
        let geometry = plain.geometry.map(Series::constant);
        let parameters: Vec<_> = parameters.into_iter().map(Series::constant).collect();
        let mechanism = motion.mechanism();
        let design = Design::from_geometry(mechanism, &parameters, geometry, plain.plain);
        Self {
            motion,
            proved,
            certifier: Certifier::new(motion),
            design: Arc::new(design),
            branch: Branch::neutral(mechanism),
            known: Vec::new(),
        }
    }

    /// Bounds of a number over the motion; empty where there are none.
    fn bounds(&mut self, number: &Measure, progress: &mut dyn Progress) -> Interval {
        number.eval(&mut |leaf| match leaf {
            Leaf::Parameter(id) => {
                let value = self.motion.design.parameters.get(id.index());
                value.map_or(Interval::EMPTY, |x| Interval::from_f64(*x))
            }
            Leaf::Named(index) => {
                let named = self.motion.mechanism().model.measures.get(*index);
                let named = named.map(|named| named.measure.clone());
                named.map_or(Interval::EMPTY, |measure| self.bounds(&measure, progress))
            }
            Leaf::Over(statistic, inner) => self.over(statistic, inner, progress),
            _ => Interval::EMPTY,
        })
    }

    fn over(
        &mut self,
        statistic: &Statistic,
        inner: &Measure,
        progress: &mut dyn Progress,
    ) -> Interval {
        let mut known = self.known.iter();
        if let Some((.., found)) = known.find(|(s, m, _)| s == statistic && m == inner) {
            return *found;
        }
        let found = match statistic {
            Statistic::Max => self.largest(inner, false, progress),
            Statistic::Min => -self.largest(inner, true, progress),
            Statistic::Range => {
                self.over(&Statistic::Max, inner, progress)
                    - self.over(&Statistic::Min, inner, progress)
            }
            _ => Interval::EMPTY,
        };
        self.known.push((statistic.clone(), inner.clone(), found));
        found
    }

    /// Bounds of the largest value of a measure, or of its negative.
    fn largest(
        &mut self,
        inner: &Measure,
        negative: bool,
        progress: &mut dyn Progress,
    ) -> Interval {
        let (motion, design, branch) = (self.motion, &self.design, &mut self.branch);
        let mut bound = |cell: &Cell| {
            let value = over_cell(motion, design, branch, cell, inner);
            if negative { -value } else { value }
        };
        let mut heard = || progress.reached(Stage::Proving, Done::Unknown);
        let found = self
            .certifier
            .largest(self.proved, NARROW, &mut bound, &mut heard);
        found.unwrap_or(Interval::EMPTY)
    }
}

/// All values of a measure over a proved stretch. Of poses alone: what moves has no value, and no bounds.
fn over_cell(
    motion: &Motion,
    design: &Arc<Design<Series<Interval>>>,
    branch: &mut Branch,
    cell: &Cell,
    inner: &Measure,
) -> Interval {
    let over = Interval::new(cell.from, cell.to);
    let still = |x: Interval| {
        Series::from_coefficients(std::array::from_fn(|k| {
            if k == 0 { x } else { Interval::EMPTY }
        }))
    };
    motion.branch_at(over.midpoint(), branch);
    let mut coordinates = vec![Interval::EMPTY; motion.mechanism().model.drives.len()];
    motion.path.coordinates(over, &mut coordinates);
    let state = State {
        design: design.clone(),
        time: Interval::EMPTY,
        abscissa: Abscissa {
            drive: None,
            clock: still(Interval::EMPTY),
            heading: 1.0,
            unit: 1.0,
        },
        poses: (cell.poses.iter()).map(|pose| pose.map(still)).collect(),
        alone: vec![None; coordinates.len()],
        coordinates: coordinates.into_iter().map(still).collect(),
        near: branch.near.clone(),
        inner: Vec::new(),
    };
    measure(&state, &History::default(), None, inner, Along::Time).coefficient(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_held_by_its_bounds_but_for_its_rounding() {
        let bounds = Interval::new(2.0, 3.0);
        assert!(
            [2.0, 2.5, 3.0, 3.0 + 1e-10]
                .iter()
                .all(|x| holds(bounds, *x))
        );
        assert!(
            [1.9, 3.0 + 1e-6, f64::INFINITY]
                .iter()
                .all(|x| !holds(bounds, *x))
        );
        assert_eq!([1.5, 2.5, 4.0].map(|x| gap(bounds, x)), [0.5, 0.0, 1.0]);
    }
}
