//! Values that vary along a motion, at a state of the plant: what loads, valves and motors go by.

use kempe_dynamics::amount::Amount;
use kempe_measure::State;
use kempe_measure::measure::{Along, History, measure, visit_leaves};
use kempe_mechanism::Mechanism;
use kempe_model::{DriveId, DriveKind, Leaf, Measure, Model, StandIn};

/// How the value of a measure is found.
#[derive(Clone, Copy, Debug)]
enum By {
    /// It is the same everywhere.
    Constant(f64),
    /// By time, coordinates of drives and inner states: no pose is needed.
    Coordinates,
    /// By where links are and how they move.
    Pose,
}

/// What is known of a state without its pose.
pub(crate) struct Known<'a> {
    /// Time, s.
    pub time: f64,
    /// Parameters, SI.
    pub parameters: &'a [f64],
    /// Coordinates of the drives, SI.
    pub coordinates: &'a dyn Fn(usize) -> f64,
    /// Inner states, in the order of the model's.
    pub inner: &'a [f64],
}

/// Values that vary.
pub(crate) struct Amounts {
    list: Vec<(Amount<f64>, By)>,
    /// Their values at the state last asked for.
    pub values: Vec<f64>,
}

impl Amounts {
    pub fn new(mechanism: &Mechanism, parameters: &[f64], list: Vec<Amount<f64>>) -> Self {
        let by = |amount: &Amount<f64>| way(mechanism, &amount.measure, parameters);
        let list: Vec<(Amount<f64>, By)> = list
            .into_iter()
            .map(|amount| {
                let by = by(&amount);
                (amount, by)
            })
            .collect();
        Self {
            values: vec![f64::NAN; list.len()],
            list,
        }
    }

    /// What they go by.
    pub fn measures(&self) -> impl Iterator<Item = &Measure> {
        self.list.iter().map(|(amount, _)| &amount.measure)
    }

    /// All of them.
    pub fn all(&self) -> impl Iterator<Item = &Amount<f64>> {
        self.list.iter().map(|(amount, _)| amount)
    }

    /// Whether any of them asks for the pose.
    pub fn ask_pose(&self) -> bool {
        self.list.iter().any(|(_, by)| matches!(by, By::Pose))
    }

    /// Finds the values; `state` is there where any of them asks for the pose.
    pub fn find(&mut self, model: &Model, known: &Known<'_>, state: Option<&State<f64>>) {
        let history = History::default();
        for ((amount, by), value) in self.list.iter().zip(&mut self.values) {
            let measured = match (by, state) {
                (By::Constant(value), _) => *value,
                (By::Coordinates, _) => plain(model, &amount.measure, known),
                (By::Pose, Some(state)) => {
                    measure(state, &history, None, &amount.measure, Along::Time).coefficient(0)
                }
                (By::Pose, None) => f64::NAN,
            };
            *value = amount.of(measured);
        }
    }
}

fn way(mechanism: &Mechanism, measure: &Measure, parameters: &[f64]) -> By {
    let (mut constant, mut coordinates) = (true, true);
    visit_leaves(mechanism, measure, &mut |leaf| {
        constant &= matches!(leaf, Leaf::Parameter(_) | Leaf::Named(_));
        coordinates &= match leaf {
            // The coordinate of a drive that follows is what the pose makes of it.
            Leaf::Drive(drive) => !follows(mechanism, *drive),
            Leaf::Parameter(_) | Leaf::Named(_) | Leaf::Time | Leaf::Inner(_) => true,
            _ => false,
        };
    });
    match (constant, coordinates) {
        (true, _) => By::Constant(plain(
            &mechanism.model,
            measure,
            &Known {
                time: f64::NAN,
                parameters,
                coordinates: &|_| f64::NAN,
                inner: &[],
            },
        )),
        (_, true) => By::Coordinates,
        _ => By::Pose,
    }
}

fn follows(mechanism: &Mechanism, drive: DriveId) -> bool {
    let drive = mechanism.model.drives.get(drive.index());
    drive.is_some_and(|d| matches!(d.kind, DriveKind::StandIn(StandIn::Follows { .. })))
}

/// The value of a measure that asks for no pose.
fn plain(model: &Model, measure: &Measure, known: &Known<'_>) -> f64 {
    measure.eval(&mut |leaf| {
        let found = match leaf {
            Leaf::Parameter(id) => known.parameters.get(id.index()).copied(),
            Leaf::Named(index) => {
                (model.measures.get(*index)).map(|named| plain(model, &named.measure, known))
            }
            Leaf::Drive(drive) => Some((known.coordinates)(drive.index())),
            Leaf::Time => Some(known.time),
            Leaf::Inner(inner) => {
                let place = model.inner_place(*inner);
                place.and_then(|place| known.inner.get(place).copied())
            }
            _ => None,
        };
        found.unwrap_or(f64::NAN)
    })
}
