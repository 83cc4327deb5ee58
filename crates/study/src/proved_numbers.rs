//! Numbers over the motion, proved: the largest and the smallest value of what is measured of poses, between bounds.

use std::sync::Arc;

use kempe_measure::measure::{Along, History, measure};
use kempe_measure::{Abscissa, Sampler, Series, State};
use kempe_mechanism::{Branch, Design};
use kempe_model::{Leaf, Measure, Statistic};
use kempe_motion::Motion;
use kempe_motion::progress::{Done, Progress, Stage};
use kempe_number::{Interval, Number};
use kempe_proof::{Cell, CertifiedMotion, Certifier};
use serde::Serialize;

use crate::columns::numbers;
use crate::quantity::Quantity;
use crate::unit::Units;

/// Bounds are wanted as near to each other as this part of what they bound.
const NARROW: f64 = 1e-6;

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
    /// With its unit, as it is told to people.
    pub told: String,
}

/// Proves what can be proved of a model's numbers over a proved motion: those of poses. Of speeds and forces nothing is.
pub(crate) fn prove_numbers(
    motion: &Arc<Motion>,
    proved: &CertifiedMotion,
    progress: &mut dyn Progress,
) -> Vec<ProvedNumber> {
    let model = &motion.mechanism().model;
    let asked = numbers(model);
    let mut prover = Prover::new(motion, proved);
    let units = Units::of(model);
    let mut list = Vec::new();
    for quantity in asked {
        // Those of forces need their source, and have no bounds here.
        let Ok(mut sampler) = Sampler::new(motion, &[&quantity.measure]) else {
            continue;
        };
        let value = sampler.values_at_parameter(motion.start)[0];
        let bounds = prover.bounds(&quantity.measure, progress);
        // A measure that counts turns may be whole turns off what is proved of its principal value.
        let holds = |b: &Interval| {
            let slack = NARROW * b.lo().abs().max(b.hi().abs());
            b.lo() - slack <= value && value <= b.hi() + slack
        };
        let bounds = Some(bounds).filter(|b| !b.is_empty() && b.width().is_finite() && holds(b));
        let told = told(&units, &quantity, value, bounds);
        list.push(ProvedNumber {
            told: match bounds {
                Some(_) => told,
                None => format!("{told}: {}", why_not(proved, value)),
            },
            name: quantity.name,
            value,
            bounds: bounds.map(|b| (b.lo(), b.hi())),
        });
    }
    list
}

fn told(units: &Units, quantity: &Quantity, value: f64, bounds: Option<Interval>) -> String {
    let unit = quantity.unit(units);
    let text = |x: f64| kempe_units::format_digits(x + 0.0, &unit, 9);
    match bounds {
        None if value.is_nan() => "not proved".to_owned(),
        Some(b) => format!(
            "{}, proved between {} and {}",
            text(value),
            text(b.lo()),
            text(b.hi())
        ),
        None => format!("{}, not proved", text(value)),
    }
}

/// Why a number has no proved bounds.
fn why_not(proved: &CertifiedMotion, value: f64) -> &'static str {
    if !proved.is_whole() {
        "the motion is not proved as one run"
    } else if value.is_nan() {
        "it has no value from poses alone"
    } else {
        "it is no largest or smallest value or range of what poses tell, or its bounds stayed wide"
    }
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
            Leaf::Over(statistic, inner) => self.over(*statistic, inner, progress),
            _ => Interval::EMPTY,
        })
    }

    fn over(
        &mut self,
        statistic: Statistic,
        inner: &Measure,
        progress: &mut dyn Progress,
    ) -> Interval {
        let mut known = self.known.iter();
        if let Some((.., found)) = known.find(|(s, m, _)| *s == statistic && m == inner) {
            return *found;
        }
        let found = match statistic {
            Statistic::Max => self.largest(inner, false, progress),
            Statistic::Min => -self.largest(inner, true, progress),
            Statistic::Range => {
                self.over(Statistic::Max, inner, progress)
                    - self.over(Statistic::Min, inner, progress)
            }
            _ => Interval::EMPTY,
        };
        self.known.push((statistic, inner.clone(), found));
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
    };
    measure(&state, &History::default(), None, inner, Along::Time).coefficient(0)
}
