//! States besides the drives: what only a simulation follows.

use crate::drive::Law;
use crate::ids::DriveId;
use crate::model::Model;

/// A side of a hydraulic cylinder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Chamber {
    /// That of the whole bore, whose oil pushes the rod out.
    Bore,
    /// That of the ring round the rod.
    Ring,
}

impl Chamber {
    /// Both, in the order in which values of both stand.
    pub const BOTH: [Self; 2] = [Self::Bore, Self::Ring];
}

/// A state of its own that a mechanism has besides the coordinates of its drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InnerState {
    /// The pressure in a chamber of a drive's cylinder, Pa.
    Pressure(DriveId, Chamber),
    /// Which part of the greatest friction acts in a place where something rubs, positive where it resists sliding forwards: -1 to 1.
    Friction(usize),
    /// Whether a switch is on: 1 or 0.
    Switch(usize),
}

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
