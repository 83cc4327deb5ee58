//! Measures of the states along a motion, on any number: what rows, numbers over the motion and derivatives all ask.

use std::sync::Arc;

use kempe_mechanism::PlanNumber;
use kempe_model::{DriveId, Leaf, Measure};
use kempe_motion::motion::Motion;

use crate::base::Base;
use crate::direction::Directions;
use crate::force_source::ForceSource;
use crate::history::History;
use crate::measure::needs::Needs;
use crate::measure::{KnownStatistic, Moment, visit_leaves};
use crate::state::{Along, Series, State};
use crate::states_along::{PathPlace, StatesAlong};

/// Measures the states along a motion.
pub(crate) struct Measurer<B, F> {
    /// Finds the states.
    pub states: StatesAlong<B>,
    /// Answers questions to forces.
    pub forces: F,
    /// Directions that are asked for.
    pub directions: Directions,
    /// Numbers over the motion that are known.
    pub statistics: Vec<KnownStatistic<B>>,
}

impl<B: Base, F: ForceSource<B>> Measurer<B, F>
where
    Series<B>: PlanNumber,
{
    /// Prepares to measure a motion for these parameter values.
    pub fn new(motion: &Arc<Motion>, parameters: &[B], forces: F) -> Self {
        Self {
            states: StatesAlong::new(motion, parameters),
            forces,
            directions: Directions::default(),
            statistics: Vec::new(),
        }
    }

    /// Takes up what measures need of states and directions.
    pub fn take_up(&mut self, needs: &Needs) {
        let motion = self.states.motion().clone();
        for drive in &needs.drives {
            self.states.ask_alone(*drive);
        }
        if self.forces.needs_drives() {
            let drives = motion.mechanism().model.drives.len() as u32;
            (0..drives).for_each(|drive| self.states.ask_alone(DriveId(drive)));
        }
        self.directions = Directions::between(&motion, &needs.directions);
    }

    /// Hands the state last found, at a path parameter, to `ask`, with its forces where they are wanted. Directions between points are added to
    /// its history.
    pub fn with_moment<R>(
        &mut self,
        p: f64,
        history: History<B>,
        with_forces: bool,
        ask: impl FnOnce(&Moment<'_, B>) -> R,
    ) -> R {
        let motion = self.states.motion();
        let history = History {
            directions: self.directions.history::<B>(motion, p).directions,
            ..history
        };
        let (state, statistics) = (self.states.state(), self.statistics.as_slice());
        if !with_forces {
            return ask(&Moment::new(state, &history, statistics, None));
        }
        let without_forces = Moment::new(state, &history, statistics, None);
        let amounts: Vec<Series<B>> = (self.forces.measures().iter())
            .map(|measure| without_forces.series(measure, Along::Time))
            .collect();
        self.forces.solve(state, &amounts);
        let answer = |measure: &_| self.forces.answer(measure);
        ask(&Moment::new(state, &history, statistics, Some(&answer)))
    }

    /// The state last found.
    pub fn state(&self) -> &State<B> {
        self.states.state()
    }

    /// Finds the state at a place; false where there is none.
    pub fn find(&mut self, place: PathPlace<B>) -> bool {
        self.states.find(place)
    }
}

/// Whether a measure asks for forces.
pub(crate) fn asks_forces(motion: &Motion, measure: &Measure) -> bool {
    let mut found = false;
    visit_leaves(motion.mechanism(), measure, &mut |leaf| {
        found |= matches!(leaf, Leaf::Force(_));
    });
    found
}
