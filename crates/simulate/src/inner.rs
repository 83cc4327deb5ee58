//! Inner states on their way: the pressures of cylinders that are let go, which go with the coordinates, and switches, which
//! events turn on and off.

use kempe_dynamics::oil::Oil;
use kempe_measure::Series;
use kempe_measure::state::ORDER;
use kempe_model::{Chamber, DriveId, InnerState, Model};

/// A cylinder that its oil moves.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moved {
    /// Its place among the oils that act.
    pub oil: usize,
    /// That of its drive among those that are let go.
    pub free: usize,
    /// That of its first pressure among the model's inner states.
    pub place: usize,
    /// Those of its openings among the plant's amounts; the second is the opposite of the first where it has none.
    pub openings: [Option<usize>; 2],
}

/// The inner states of a plant.
#[derive(Clone, Debug, Default)]
pub(crate) struct Inner {
    /// Cylinders that their oil moves.
    pub moved: Vec<Moved>,
    /// Inner states of the model, as last taken: what nothing follows is not known.
    pub values: Vec<f64>,
    /// The place of the first switch among them.
    first_switch: usize,
}

impl Inner {
    /// Those of a model in which these drives are let go; `openings` makes places of the openings of an oil.
    pub fn new(
        model: &Model,
        oils: &[Oil<f64>],
        free: &[DriveId],
        mut openings: impl FnMut(&Oil<f64>) -> [Option<usize>; 2],
    ) -> Self {
        let moved = oils.iter().enumerate().filter_map(|(index, oil)| {
            Some(Moved {
                oil: index,
                free: free.iter().position(|drive| *drive == oil.drive)?,
                place: model.inner_place(InnerState::Pressure(oil.drive, Chamber::Bore))?,
                openings: openings(oil),
            })
        });
        let moved = moved.collect();
        let states = model.inner_states().len();
        let first_switch = states - model.actions.switches.len();
        let mut values = vec![f64::NAN; states];
        values[first_switch..].fill(0.0);
        Self {
            moved,
            values,
            first_switch,
        }
    }

    /// How many pressures go with the coordinates.
    pub fn pressures(&self) -> usize {
        2 * self.moved.len()
    }

    /// Takes the pressures of a state, Pa.
    pub fn take(&mut self, pressures: &[f64]) {
        for (moved, both) in self.moved.iter().zip(pressures.chunks_exact(2)) {
            self.values[moved.place..moved.place + 2].copy_from_slice(both);
        }
    }

    /// The pressures last taken of a cylinder.
    pub fn of(&self, moved: &Moved) -> [f64; 2] {
        [self.values[moved.place], self.values[moved.place + 1]]
    }

    /// The switches: 1 where they are on, 0 where they are off, or how far they have counted.
    pub fn switches(&self) -> &[f64] {
        &self.values[self.first_switch..]
    }

    /// Sets a switch.
    pub fn set(&mut self, switch: usize, value: f64) {
        self.values[self.first_switch + switch] = value;
    }

    /// The states as series in time at the instant: how a pressure changes is not known of it.
    pub fn series(&self) -> Vec<Series<f64>> {
        let all = self.values.iter().enumerate();
        let series = all.map(|(place, value)| {
            let rate = if place < self.first_switch {
                f64::NAN
            } else {
                0.0
            };
            let mut coefficients = [rate; ORDER];
            coefficients[0] = *value;
            Series::from_coefficients(coefficients)
        });
        series.collect()
    }
}
