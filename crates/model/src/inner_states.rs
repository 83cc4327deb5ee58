//! All inner states of a model, and how they go in time.

use crate::drive::Law;
use crate::inner::{Chamber, InnerState};
use crate::model::Model;

impl Model {
    /// All inner states of the model: the pressures of its cylinders with oil, friction that is followed, then its switches.
    pub fn inner_states(&self) -> Vec<InnerState> {
        let oils = self.actions.cylinders.iter().filter(|c| c.oil.is_some());
        let pressures =
            oils.flat_map(|c| Chamber::BOTH.map(|side| InnerState::Pressure(c.drive, side)));
        let friction = (0..self.actions.followed_friction).map(InnerState::Friction);
        let switches = (0..self.actions.switches.len()).map(InnerState::Switch);
        pressures.chain(friction).chain(switches).collect()
    }

    /// The place of an inner state among [all](Self::inner_states).
    pub fn inner_place(&self, of: InnerState) -> Option<usize> {
        let mut oils = self.actions.cylinders.iter().filter(|c| c.oil.is_some());
        match of {
            InnerState::Pressure(drive, side) => {
                let place = oils.position(|c| c.drive == drive)?;
                Some(2 * place + usize::from(side == Chamber::Ring))
            }
            InnerState::Friction(index) => {
                (index < self.actions.followed_friction).then(|| 2 * oils.count() + index)
            }
            InnerState::Switch(index) => (index < self.actions.switches.len())
                .then(|| 2 * oils.count() + self.actions.followed_friction + index),
        }
    }

    /// How an inner state goes in time, where a simulation has found that.
    pub fn inner_law(&self, of: InnerState) -> Option<&Law> {
        self.inner_laws.get(self.inner_place(of)?)?.as_ref()
    }
}
