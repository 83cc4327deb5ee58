//! Storage for many designs, which a batch keeps from call to call: to make it can take longer than to solve a few designs.

use kempe_mechanism::{Configuration, Design};
use kempe_number::{Lanes, Number};

use crate::batch::Batch;

/// What designs are solved in, `W` at a time; with `ALL`, also by steps that need guesses.
pub(super) struct Workspace<const W: usize, const ALL: bool> {
    /// Places of a motion that are solved together; what is the same for every design and place is solved in all of them.
    pub states: Vec<Configuration<Lanes<W>>>,
    /// The motion's own design.
    pub design: Design<Lanes<W>>,
    /// Groups of designs.
    pub prepared: Vec<Design<Lanes<W>>>,
    /// Parameters of one group.
    pub parameters: Vec<Lanes<W>>,
}

impl<const W: usize, const ALL: bool> Workspace<W, ALL> {
    /// One with room for so many states and groups of designs: a kept one if there is one.
    #[inline(never)]
    pub(super) fn of(batch: &Batch, states: usize, groups: usize) -> Box<Self> {
        let mut it = batch.kept.take().unwrap_or_else(|| Self::new(batch));
        if it.states.len() < states {
            let state = it.states[0].clone();
            it.states.resize(states, state);
        }
        if it.prepared.len() < groups {
            let design = it.design.clone();
            it.prepared.resize(groups, design);
        }
        it
    }

    fn new(batch: &Batch) -> Box<Self> {
        let mechanism = batch.motion.mechanism();
        let mut state = Configuration::new(mechanism);
        if batch.determinants.is_empty() {
            state = state.without_determinants();
        }
        let mut design = batch.motion.design.lift(Lanes::from_f64);
        if !ALL {
            state.determinants.clear();
            design.plain.clear();
        }
        let mut states = vec![state];
        let order = &batch.order;
        order.solve_once(&order.fixed, &design, &mut states);
        Box::new(Self {
            states,
            design,
            prepared: Vec::new(),
            parameters: vec![Lanes::zero(); mechanism.model.parameters.len()],
        })
    }
}
