//! What is on or off on the way, and what turns it: switches of the model, and pressures below that of a vacuum.

use kempe_dynamics::oil::VACUUM;
use kempe_model::{Chamber, InnerState, Leaf, Measure, Model};
use kempe_units::Expr;

use crate::plant::Plant;

/// What is on or off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Toggled {
    /// A switch of the model.
    Switch(usize),
    /// Whether the pressure of a chamber is below that of a vacuum: the place of its drive among those that are let go.
    Vacuum(usize, Chamber),
}

/// Something that is on or off.
#[derive(Clone, Debug)]
pub(crate) struct Toggle {
    pub what: Toggled,
    pub is_on: bool,
    /// It goes on when this comes to be no longer negative, ...
    on: Measure,
    /// ... and off when this does.
    off: Measure,
}

impl Toggle {
    /// What is on or off in a plant, at a state at its start.
    pub fn all(plant: &mut Plant, y: &[f64]) -> Vec<Self> {
        let model = plant.forces.design.mechanism.model.clone();
        let mut list = switches(&model, plant, y);
        for moved in plant.inner.moved.clone() {
            let drive = plant.forces.acting.oils[moved.oil].drive;
            for (side, pressure) in Chamber::BOTH.into_iter().zip(plant.inner.of(&moved)) {
                let vacuum = Box::new(Expr::Const(VACUUM));
                let now = Expr::Leaf(Leaf::Inner(InnerState::Pressure(drive, side)));
                let below = Expr::Sub(vacuum, Box::new(now));
                list.push(Self {
                    what: Toggled::Vacuum(moved.free, side),
                    is_on: pressure < VACUUM,
                    off: Expr::Neg(Box::new(below.clone())),
                    on: below,
                });
            }
        }
        list
    }

    /// What turns it next when it comes to be no longer negative.
    pub fn awaits(&self) -> &Measure {
        if self.is_on { &self.off } else { &self.on }
    }
}

/// The switches as they stand at the start, of which each may go by those before it.
fn switches(model: &Model, plant: &mut Plant, y: &[f64]) -> Vec<Toggle> {
    let all = model.actions.switches.iter().enumerate();
    all.map(|(index, switch)| {
        let on = switch.on.above.clone();
        let off = match &switch.off {
            Some(off) => off.above.clone(),
            None => Expr::Neg(Box::new(on.clone())),
        };
        let mut holds = |what: &Measure| plant.value(what, 0.0, y).is_some_and(|x| x >= 0.0);
        let is_on = match (switch.starts, &switch.off) {
            (Some(is_on), _) => is_on,
            (None, Some(_)) => holds(&on) && !holds(&off),
            (None, None) => holds(&on),
        };
        plant.inner.turn(index, is_on);
        Toggle {
            what: Toggled::Switch(index),
            is_on,
            on,
            off,
        }
    })
    .collect()
}
