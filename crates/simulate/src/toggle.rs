//! What is on or off on the way, and what turns it: switches of the model, and pressures below that of a vacuum.

use kempe_dynamics::oil::VACUUM;
use kempe_model::{Chamber, InnerState, Leaf, Measure, Model, value};
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

/// Something that is on or off, or counts.
#[derive(Clone, Debug)]
pub(crate) struct Toggle {
    pub what: Toggled,
    /// 1 where it is on and 0 where it is off, or how far it has counted.
    pub value: f64,
    /// What turns it next, when it comes to be no longer negative.
    pub awaits: Measure,
    turned: Turned,
}

/// What turns it.
#[derive(Clone, Debug)]
enum Turned {
    /// On and off, when these come to be no longer negative.
    By([Measure; 2]),
    /// One further each time that the measure has grown by so much.
    Every(Measure, f64),
}

impl Toggle {
    fn new(what: Toggled, value: f64, turned: Turned) -> Self {
        let mut it = Self {
            what,
            value,
            awaits: Expr::Const(f64::NAN),
            turned,
        };
        it.await_next();
        it
    }

    fn await_next(&mut self) {
        self.awaits = match &self.turned {
            Turned::By([on, off]) => if self.value == 0.0 { on } else { off }.clone(),
            Turned::Every(grows, every) => {
                let passed = Box::new(Expr::Const(self.value * every));
                Expr::Sub(Box::new(grows.clone()), passed)
            }
        };
    }

    /// Turns it, on or off or one further.
    pub fn turn(&mut self) {
        self.value = match self.turned {
            Turned::By(_) => 1.0 - self.value,
            Turned::Every(..) => self.value + 1.0,
        };
        self.await_next();
    }

    /// What turns it.
    pub fn measures(&self) -> &[Measure] {
        match &self.turned {
            Turned::By(both) => both,
            Turned::Every(grows, _) => std::slice::from_ref(grows),
        }
    }

    /// Whether it goes back as soon as what turned it holds no more: there is no way between.
    pub fn has_one_threshold(&self) -> bool {
        match &self.turned {
            Turned::By([on, off]) => {
                let not = |what: &Measure| Expr::Neg(Box::new(what.clone()));
                *off == not(on)
            }
            Turned::Every(..) => false,
        }
    }

    /// Whether it counts.
    pub fn counts(&self) -> bool {
        matches!(self.turned, Turned::Every(..))
    }
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
                let off = Expr::Neg(Box::new(below.clone()));
                let is_on = f64::from(u8::from(pressure < VACUUM));
                let what = Toggled::Vacuum(moved.free, side);
                list.push(Self::new(what, is_on, Turned::By([below, off])));
            }
        }
        list
    }
}

/// The switches as they stand at the start, of which each may go by those before it.
fn switches(model: &Model, plant: &mut Plant, y: &[f64]) -> Vec<Toggle> {
    let all = model.actions.switches.iter().enumerate();
    all.map(|(index, switch)| {
        let on = switch.on.above.clone();
        let parameters = &plant.forces.design.parameters;
        let every = switch.every.as_ref().map(|every| value(every, parameters));
        let mut measured = |what: &Measure| plant.value(what, 0.0, y).unwrap_or(f64::NAN);
        let (begins, turned) = match every {
            Some(every) => {
                // What is just reached has passed.
                let passed = (measured(&on) / every).floor() + 1.0;
                (passed.max(0.0), Turned::Every(on, every))
            }
            None => {
                let off = match &switch.off {
                    Some(off) => off.above.clone(),
                    None => Expr::Neg(Box::new(on.clone())),
                };
                let mut holds = |what: &Measure| measured(what) >= 0.0;
                let is_on = match (switch.starts, &switch.off) {
                    (Some(is_on), _) => is_on,
                    (None, Some(_)) => holds(&on) && !holds(&off),
                    (None, None) => holds(&on),
                };
                (f64::from(u8::from(is_on)), Turned::By([on, off]))
            }
        };
        plant.inner.set(index, begins);
        Toggle::new(Toggled::Switch(index), begins, turned)
    })
    .collect()
}
