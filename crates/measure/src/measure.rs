//! Measures evaluated: what the names of the model language mean at a pose, as series.
//!
//! Every measure is evaluated as a Taylor series: along the path of the drives, along time, or along one drive with
//! the others at rest. Rates and kinematic coefficients are then coefficients of the series, and no measure needs a
//! formula for its derivative.

mod following;
mod geometric;
mod in_time;
mod named;
pub(crate) mod needs;

pub(crate) use self::following::{alone_following, is_following, pilots};
use self::named::NamedSeries;
pub(crate) use self::needs::needs_time;
pub use self::needs::{NoMeasure, asks_unknown_state, order_of, visit_leaves, visit_parts};

use kempe_mechanism::pose::Pose;
use kempe_model::{DriveId, ForceMeasure, InnerState, Leaf, Measure, PoseMeasure, Statistic};
use kempe_number::Number;

use crate::direction::whole_turns;
pub use crate::history::History;
use crate::state::State;
pub use crate::state::{Along, ORDER, Series};

/// Answers questions to the forces.
pub type Forces<'a, B> = &'a dyn Fn(&ForceMeasure) -> Series<B>;

/// A number over a whole motion, and its value, SI.
pub(crate) type KnownStatistic<B> = (Statistic, Measure, B);

/// A state with all that is needed to measure it.
pub(crate) struct Moment<'a, B> {
    /// Where the mechanism is and how it moves.
    pub state: &'a State<B>,
    /// What happened before.
    pub history: &'a History<B>,
    /// Answers questions to the forces, where forces are computed.
    pub forces: Option<Forces<'a, B>>,
    /// Values of the statistics that occur.
    pub statistics: &'a [KnownStatistic<B>],
    /// Named measures that were evaluated here already.
    named: NamedSeries<B>,
}

/// A measure of a state as a series, SI: where the history says nothing, directions are principal values and lengths of
/// path have no value; forces are asked of `forces`.
pub fn measure<B: Number>(
    state: &State<B>,
    history: &History<B>,
    forces: Option<Forces<'_, B>>,
    measure: &Measure,
    along: Along,
) -> Series<B> {
    Moment::new(state, history, &[], forces).series(measure, along)
}

impl<'a, B: Number> Moment<'a, B> {
    /// A state to be measured.
    pub fn new(
        state: &'a State<B>,
        history: &'a History<B>,
        statistics: &'a [KnownStatistic<B>],
        forces: Option<Forces<'a, B>>,
    ) -> Self {
        Self {
            state,
            history,
            forces,
            statistics,
            named: NamedSeries::default(),
        }
    }
}

impl<B: Number> Moment<'_, B> {
    /// The value of a measure, SI.
    pub fn value(&self, measure: &Measure) -> B {
        self.series(measure, Along::Time).coefficient(0)
    }

    /// A measure as a series.
    pub fn series(&self, measure: &Measure, along: Along) -> Series<B> {
        measure.eval(&mut |leaf| self.leaf(leaf, along))
    }

    fn leaf(&self, leaf: &Leaf, along: Along) -> Series<B> {
        match leaf {
            Leaf::Parameter(id) => (self.state.design.parameters)
                .get(id.index())
                .copied()
                .unwrap_or_else(undefined),
            Leaf::Named(index) => match self.state.mechanism().model.measures.get(*index) {
                Some(named) => {
                    (self.named).or_evaluate(*index, along, || self.series(&named.measure, along))
                }
                None => undefined(),
            },
            Leaf::Drive(drive) => match along {
                _ if self.followed(*drive).is_some() => self.following(*drive, along),
                Along::Drive(d) if d == *drive => {
                    Series::variable(self.state.coordinates[d.index()].coefficient(0))
                }
                Along::Drive(_) => {
                    Series::constant(self.state.coordinates[drive.index()].coefficient(0))
                }
                _ => self.along_time(self.state.coordinates[drive.index()], along),
            },
            Leaf::Time => match along {
                Along::Time => Series::variable(self.state.time),
                _ => Series::constant(self.state.time),
            },
            Leaf::Inner(inner) => self.inner(*inner, along),
            // Forces are known to the crate that computes them; here they have no value.
            Leaf::Force(measure) => {
                (self.forces).map_or(undefined(), |forces| self.counted(measure, forces(measure)))
            }
            Leaf::Rate(measure, order) => (0..*order)
                .fold(self.series(measure, Along::Time), |series, _| {
                    series.differentiate()
                }),
            Leaf::Coefficient(measure, drive, order) => {
                self.coefficient(measure, *drive, *order, along)
            }
            Leaf::Over(statistic, measure) => {
                let known = self
                    .statistics
                    .iter()
                    .find(|(s, m, _)| s == statistic && m == &**measure);
                Series::constant(known.map_or(B::from_f64(f64::NAN), |(_, _, value)| *value))
            }
            Leaf::Pose(measure) => self.pose_measure(measure, along),
        }
    }

    /// A measure of forces, by the whole turns that its history tells of it.
    fn counted(&self, measure: &ForceMeasure, found: Series<B>) -> Series<B> {
        let mut known = self.history.forces.iter();
        match known.find(|(of, _)| of == measure) {
            Some((_, near)) => found - whole_turns(found.value() - near),
            None => found,
        }
    }

    /// A state besides the drives: known in time alone.
    fn inner(&self, which: InnerState, along: Along) -> Series<B> {
        let place = self.state.mechanism().model.inner_place(which);
        let series = place.and_then(|place| self.state.inner.get(place).copied());
        let series = series.unwrap_or_else(undefined);
        match (along, self.state.abscissa.drive) {
            (Along::Time, _) | (Along::Path, None) => series,
            // A switch stands still between the instants at which it is turned.
            _ if matches!(which, InnerState::Switch(_)) => Series::constant(series.coefficient(0)),
            _ => only_value(series.coefficient(0)),
        }
    }

    /// The n-th derivative of a measure to a drive's coordinate. As a series in time it needs the drive to be the only
    /// one that moves; otherwise only its value is known and its derivatives are NaN.
    fn coefficient(
        &self,
        measure: &Measure,
        drive: DriveId,
        order: u32,
        along: Along,
    ) -> Series<B> {
        let series = (0..order).fold(self.series(measure, Along::Drive(drive)), |s, _| {
            s.differentiate()
        });
        match along {
            Along::Drive(d) if d == drive => series,
            _ if self.state.abscissa.drive == Some(drive) => self.along_time(series, along),
            _ => only_value(series.coefficient(0)),
        }
    }

    /// A series along the path, along what is asked for.
    fn along_time(&self, series: Series<B>, along: Along) -> Series<B> {
        match along {
            // Without time (on a circuit) only the value is known.
            Along::Time if !self.state.abscissa.clock.coefficient(1).value().is_finite() => {
                only_value(series.coefficient(0))
            }
            Along::Time => series.compose(&self.state.abscissa.clock),
            Along::Path | Along::Drive(_) => series,
        }
    }

    fn poses(&self, along: Along) -> &[Pose<Series<B>>] {
        let alone = match along {
            Along::Drive(drive) => self.state.along(drive),
            _ => None,
        };
        alone.unwrap_or(&self.state.poses)
    }

    /// What is geometry is measured along the path and carried over to time; what is motion is measured in time.
    fn pose_measure(&self, measure: &PoseMeasure, along: Along) -> Series<B> {
        if is_motion(measure) {
            return self.motion_measure(measure);
        }
        let poses = self.poses(along);
        let geometric = self.geometric(measure, poses, along);
        self.along_time(geometric, along)
    }
}

/// Measures that only make sense in time.
fn is_motion(measure: &PoseMeasure) -> bool {
    matches!(
        measure,
        PoseMeasure::Speed(_)
            | PoseMeasure::Acceleration(_)
            | PoseMeasure::AngularSpeed(_)
            | PoseMeasure::AngularAcceleration(_)
            | PoseMeasure::PathLength(_)
    )
}

/// A series of which nothing is known.
fn undefined<B: Number>() -> Series<B> {
    only_value(B::from_f64(f64::NAN))
}

/// A series of which only the value is known.
pub(crate) fn only_value<B: Number>(value: B) -> Series<B> {
    let mut coefficients = [B::from_f64(f64::NAN); ORDER];
    coefficients[0] = value;
    Series::from_coefficients(coefficients)
}
