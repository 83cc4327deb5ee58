//! Measures evaluated: what the names of the model language mean at a pose, as series.
//!
//! Every measure is evaluated as a Taylor series: along the path of the drives, along time, or along one drive with
//! the others at rest. Rates and kinematic coefficients are then coefficients of the series, and no measure needs a
//! formula for its derivative.

mod geometric;
mod in_time;
mod named;
mod needs;

pub use self::named::NamedSeries;
pub use self::needs::{order_of, visit_leaves};

use kempe_mechanism::Mechanism;
use kempe_mechanism::pose::Pose;
use kempe_mechanism::state::Design;
use kempe_model::{DriveId, ForceMeasure, Leaf, Measure, PointId, PoseMeasure, Statistic};
use kempe_number::{Jet, Number};

use self::in_time::is_motion;

/// Coefficients carried by a series: position and four derivatives.
pub const ORDER: usize = 5;

/// A series in the path parameter, in time or in one drive.
pub type Series<B> = Jet<B, ORDER>;

/// What a series runs along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// The path parameter: the coordinate of the only moving drive, or time when several move.
    Path,
    /// Time.
    Time,
    /// One drive, the others at rest.
    Drive(DriveId),
}

/// Answers questions to the forces.
pub type Forces<'a, B> = &'a dyn Fn(&ForceMeasure) -> Series<B>;

/// A pose with its series along one variable, and all that is needed to measure it.
pub struct Moment<'a, B> {
    /// The mechanism.
    pub mechanism: &'a Mechanism,
    /// The design, as constants of the series.
    pub design: &'a Design<Series<B>>,
    /// Parameter values.
    pub parameters: &'a [B],
    /// Time, s.
    pub time: B,
    /// Poses along the path parameter.
    pub path: &'a [Pose<Series<B>>],
    /// The path parameter as a series in time.
    pub clock: Series<B>,
    /// Which way the motion runs along the path: 1 or -1.
    pub heading: f64,
    /// A typical change of the path parameter.
    pub unit: f64,
    /// Poses along each drive, where they were asked for.
    pub drives: &'a [Option<Vec<Pose<Series<B>>>>],
    /// The drive that is the path parameter itself.
    pub path_drive: Option<DriveId>,
    /// Drive coordinates along the path.
    pub coordinates: &'a [Series<B>],
    /// Angles of the bodies to within half a turn, rad.
    pub near: &'a [f64],
    /// Unwrapped values for directions between points of different bodies.
    pub directions: Vec<((PointId, PointId), f64)>,
    /// Lengths of path swept so far and since the start.
    pub swept: Vec<(PointId, B)>,
    /// Answers questions to the forces, where forces are computed.
    pub forces: Option<Forces<'a, B>>,
    /// Values of the statistics that occur, in SI.
    pub statistics: &'a [(Statistic, Measure, B)],
    /// Named measures that were evaluated here already.
    pub named: NamedSeries<B>,
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
            Leaf::Parameter(id) => self
                .parameters
                .get(id.index())
                .map_or(undefined(), |value| Series::constant(*value)),
            Leaf::Named(index) => match self.mechanism.model.measures.get(*index) {
                Some(named) => {
                    (self.named).or_evaluate(*index, along, || self.series(&named.measure, along))
                }
                None => undefined(),
            },
            Leaf::Drive(drive) => match along {
                Along::Drive(d) if d == *drive => {
                    Series::variable(self.coordinates[d.index()].coefficient(0))
                }
                Along::Drive(_) => Series::constant(self.coordinates[drive.index()].coefficient(0)),
                _ => self.along_time(self.coordinates[drive.index()], along),
            },
            Leaf::Time => match along {
                Along::Time => Series::variable(self.time),
                _ => Series::constant(self.time),
            },
            // Forces are known to the crate that computes them; here they have no value.
            Leaf::Force(measure) => self.forces.map_or(undefined(), |forces| forces(measure)),
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
            _ if self.path_drive == Some(drive) => self.along_time(series, along),
            _ => only_value(series.coefficient(0)),
        }
    }

    /// A series along the path, along what is asked for.
    fn along_time(&self, series: Series<B>, along: Along) -> Series<B> {
        match along {
            // Without time (on a circuit) only the value is known.
            Along::Time if !self.clock.coefficient(1).value().is_finite() => {
                only_value(series.coefficient(0))
            }
            Along::Time => series.compose(&self.clock),
            Along::Path | Along::Drive(_) => series,
        }
    }

    fn poses(&self, along: Along) -> &[Pose<Series<B>>] {
        match along {
            Along::Drive(drive) if self.path_drive != Some(drive) => self
                .drives
                .get(drive.index())
                .and_then(Option::as_deref)
                .unwrap_or(self.path),
            _ => self.path,
        }
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
