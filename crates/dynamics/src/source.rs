//! Forces of states, for the sampler of `kempe-measure`.

use std::sync::Arc;

use kempe_measure::measure::asks_unknown_state;
use kempe_measure::{Curve, ForceSource, Series, State};
use kempe_mechanism::Design;
use kempe_mechanism::{Branch, Mechanism};
use kempe_model::{Amount, Drive, ForceMeasure, Measure, Pressed};
use kempe_motion::Motion;

use crate::equilibrium::Pace;
use crate::forces::Forces;
use crate::instant::{Instant, Rates, cut};
use crate::number::ForceNumber;
use crate::pressed::press;
use crate::problem::Problem;

/// The forces of the state last solved, as series in time.
pub struct Source<B: ForceNumber> {
    /// The forces.
    pub forces: Forces<Rates<B>>,
    /// What they were solved for.
    pub instant: Instant<Rates<B>>,
    measures: Vec<Measure>,
    pressed: Vec<Pressed>,
}

impl<B: ForceNumber> Source<B> {
    /// Prepares the forces of a motion for these parameter values.
    ///
    /// # Errors
    /// All problems of what acts on the mechanism.
    pub fn new(motion: &Arc<Motion>, parameters: &[B]) -> Result<Self, Vec<Problem>> {
        let design = motion.design_of(parameters).lift(Rates::constant);
        let mut start = Branch::neutral(motion.mechanism());
        motion.branch_at(motion.start, &mut start);
        let mut it = Self::of(design, &start.near)?;
        it.forces.equilibrium.pace = pace(&motion.design);
        Ok(it)
    }

    /// Prepares the forces of a design whose states come from anywhere; `near` are the bodies' angles to within half a turn
    /// where springs about pins begin to count turns, rad.
    ///
    /// # Errors
    /// All problems of what acts on the mechanism.
    pub fn of(design: Design<Rates<B>>, near: &[f64]) -> Result<Self, Vec<Problem>> {
        let mut forces = Forces::new(design)?;
        only_simulated(&forces.design.mechanism)?;
        for spring in &mut forces.acting.springs {
            spring.align(&forces.design.geometry, near);
        }
        let measures: Vec<Measure> = (forces.acting.amounts.iter())
            .map(|a| a.measure.clone())
            .collect();
        Ok(Self {
            instant: Instant::new(&forces.design.mechanism, measures.len()),
            pressed: forces.design.mechanism.model.actions.pressed.clone(),
            measures,
            forces,
        })
    }
}

impl<B: ForceNumber> ForceSource<B> for Source<B> {
    fn measures(&self) -> &[Measure] {
        &self.measures
    }

    fn curves(&self) -> Vec<Curve> {
        let amounts = self.forces.acting.amounts.iter();
        let curves = amounts.filter_map(|amount| {
            let (table, _) = amount.curve.as_ref()?;
            Some(Curve {
                over: amount.measure.clone(),
                at: table.knots().to_vec(),
                period: table.period(),
            })
        });
        curves.collect()
    }

    fn of_motion(motion: &Arc<Motion>) -> Option<Self> {
        let parameters = motion.design.parameters.iter().copied();
        let parameters: Vec<B> = parameters.map(B::from_f64).collect();
        Self::new(motion, &parameters).ok()
    }

    fn solve(&mut self, state: &State<B>, amounts: &[Series<B>]) {
        self.instant.set(state);
        let acting = self.forces.acting.amounts.iter();
        for ((value, measured), amount) in self.instant.amounts.iter_mut().zip(amounts).zip(acting)
        {
            *value = amount.of(cut(*measured));
        }
        press(&self.pressed, state, &mut self.instant.pressed);
        self.forces.solve(&self.instant);
    }

    fn answer(&self, measure: &ForceMeasure) -> Series<B> {
        known(self.forces.answer(&self.instant, measure))
    }

    fn sliding(&self) -> Vec<Series<B>> {
        let speeds = self
            .forces
            .equilibrium
            .sliding(&self.forces.acting.friction);
        speeds.map(known).collect()
    }

    fn slide_as(&mut self, senses: &[Option<f64>]) {
        let own = &mut self.forces.equilibrium.senses;
        own.clear();
        own.extend(senses);
    }
}

/// As a series of which no more is known.
fn known<B: ForceNumber>(rates: Rates<B>) -> Series<B> {
    Series::from_coefficients(std::array::from_fn(|k| {
        if k < 3 {
            rates.coefficient(k)
        } else {
            B::from_f64(f64::NAN)
        }
    }))
}

/// Refuses loads that go by what only a simulation follows, where none has.
///
/// # Errors
/// A problem for each of them.
pub fn only_simulated(mechanism: &Mechanism) -> Result<(), Vec<Problem>> {
    let mut problems = Vec::new();
    for load in &mechanism.model.actions.loads {
        let measures = load.kind.amounts().map(|amount| match amount {
            Amount::Measure(measure) => measure,
            Amount::Table { over, .. } => over,
        });
        if measures
            .into_iter()
            .any(|m| asks_unknown_state(&mechanism.model, m))
        {
            let message = format!(
                "the load `{}` goes by a pressure or a switch, which only a simulation follows",
                load.name
            );
            let problem = Problem::new("needs-simulation", &load.span, message);
            problems.push(problem.remedy(
                "ask for it in a study of kind = \"simulate\", or let the load go by where things are and how fast they move",
            ));
        }
    }
    match problems.is_empty() {
        true => Ok(()),
        false => Err(problems),
    }
}

/// Mean speeds of the drives over their laws.
pub(crate) fn pace(design: &Design<f64>) -> Pace {
    let (model, parameters) = (&design.mechanism.model, &design.parameters);
    let durations = model.drives.iter().map(|d| d.law.duration(parameters));
    let longest = durations.fold(0.0, f64::max);
    if !(longest > 0.0) {
        return Pace::default();
    }
    let speed = |drive: &Drive| {
        let (low, high) = drive.law.extent(parameters);
        (high - low) / longest
    };
    Pace {
        speeds: model.drives.iter().map(speed).collect(),
        frequency: 1.0 / longest,
    }
}
