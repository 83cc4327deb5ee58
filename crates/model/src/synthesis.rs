//! Studies that ask for linkages: from what one is to do to all that do it.

use kempe_units::Expr;

use crate::ids::{DriveId, ParameterId, PointId, Scalar, Span};
use crate::motion_study::MotionStudy;

/// Which linkages do something.
#[derive(Clone, Debug, PartialEq)]
pub struct SynthesizeStudy {
    /// Rows of what every linkage found is drawn and measured by; no columns or plots.
    pub along: MotionStudy,
    /// What is to be done.
    pub task: SynthesisTask,
    /// Conditions that a linkage must keep, over the motion through what is asked: `min(transmission_angle) >= 35 deg`.
    pub accept: Vec<Asked>,
    /// The measure by which linkages are ordered, the smallest first.
    pub rank: Option<Asked>,
    /// Measures to tabulate besides.
    pub columns: Vec<Asked>,
    /// So many linkages are kept at most.
    pub keep: usize,
    /// Where the study's name stands in the file.
    pub span: Span,
}

/// A measure or condition in the names of the linkages that are found; their files read it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Asked {
    /// As written.
    pub text: String,
    /// Where it stands in the file.
    pub span: Span,
}

/// The kinds of linkage that can be asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LinkageKind {
    /// Four links, four pins.
    FourBar,
    /// A crank, a coupler and a slider on the frame.
    SliderCrank,
    /// A crank whose end slides along a link that turns.
    InvertedSliderCrank,
}

/// What a linkage is to do.
#[derive(Clone, Debug, PartialEq)]
pub enum SynthesisTask {
    /// Its output goes as its input asks.
    Function(FunctionTask),
    /// Its links have given rates at one pose.
    Rates(RatesTask),
    /// Its output goes so far, and takes so much longer there than back.
    DeadCentres(DeadCentresTask),
    /// Its coupler passes poses.
    Motion(Box<GuidanceTask>),
    /// A point of its coupler passes points.
    Path(Box<PathTask>),
    /// An output beside the file's own mechanism rests while this moves on.
    Dwell(Box<DwellTask>),
    /// The coupler curve of the file's own four-bar is traced by others, or by a body that does not turn.
    Cognates(CognatesTask),
}

/// An output as an input asks.
#[derive(Clone, Debug, PartialEq)]
pub struct FunctionTask {
    /// Of which kind.
    pub linkage: LinkageKind,
    /// What goes with what.
    pub wanted: WantedFunction,
    /// Angles of the links, rad from the line of the fixed pivots (a slider's place, m from the crank's pivot along its guide) where input and
    /// output are zero; `None` where the synthesis finds them.
    pub zeros: [Option<Scalar>; 2],
    /// Distance of the fixed pivots, m; of a slider-crank none.
    pub ground: Option<Scalar>,
}

/// What goes with what.
#[derive(Clone, Debug, PartialEq)]
pub enum WantedFunction {
    /// Pairs.
    Pairs(Vec<WantedPair>),
    /// A curve, met where its error stays smallest.
    Curve(Box<WantedCurve>),
}

/// An input with its output.
#[derive(Clone, Debug, PartialEq)]
pub struct WantedPair {
    /// The input's angle, rad.
    pub input: Scalar,
    /// The output's angle, rad, or place, m.
    pub output: Scalar,
    /// The output's change for the input's.
    pub ratio: Option<Scalar>,
    /// The change of that, for the input's.
    pub ratio_rate: Option<Scalar>,
    /// Where it stands in the file.
    pub span: Span,
}

/// y of x, shown on two dials.
#[derive(Clone, Debug, PartialEq)]
pub struct WantedCurve {
    /// y as written.
    pub text: String,
    /// y, over parameters and x, which is `None`.
    pub y: Expr<Option<ParameterId>>,
    /// x at both ends.
    pub x: [Scalar; 2],
    /// The input's angles there, rad.
    pub input: [Scalar; 2],
    /// The output's there: rad, or m of a slider.
    pub output: [Scalar; 2],
    /// In so many places it is met.
    pub points: usize,
    /// Where it stands in the file.
    pub span: Span,
}

/// Links with given rates at one pose.
#[derive(Clone, Debug, PartialEq)]
pub struct RatesTask {
    /// Angular speeds of crank, coupler and rocker, rad/s.
    pub speeds: [Scalar; 3],
    /// Their angular accelerations, rad/s^2.
    pub accelerations: [Scalar; 3],
    /// Distance of the fixed pivots, m.
    pub ground: Scalar,
    /// Where the speeds of the links stand in the file.
    pub spans: [Span; 3],
}

/// An output that goes to and fro as a crank turns.
#[derive(Clone, Debug, PartialEq)]
pub struct DeadCentresTask {
    /// How far it goes, and what is chosen.
    pub stroke: Stroke,
    /// The time of the slower way over that of the quicker.
    pub time_ratio: Scalar,
    /// Where how far it goes, the time ratio, and what is chosen besides stand in the file; nowhere what is not given.
    pub spans: [Span; 3],
}

/// How far an output goes.
#[derive(Clone, Debug, PartialEq)]
pub enum Stroke {
    /// A rocker.
    Swing {
        /// By which angle, rad.
        swing: Scalar,
        /// Its length, m.
        rocker: Scalar,
        /// The coupler's length, m; the one of the best transmission where it is not given.
        coupler: Option<Scalar>,
    },
    /// A slider.
    Travel {
        /// How far, m.
        travel: Scalar,
        /// The coupler's length, m.
        coupler: Option<Scalar>,
        /// How far the guide passes beside the crank's pivot, m. Of both none where the one of the best transmission is wanted.
        offset: Option<Scalar>,
    },
}

/// A body that is guided through poses.
#[derive(Clone, Debug, PartialEq)]
pub struct GuidanceTask {
    /// The poses, in the order in which they are passed; at least two.
    pub poses: Vec<WantedPose>,
    /// Of which kind; any where it is not said.
    pub linkage: Option<LinkageKind>,
    /// What is given of the dyad that is driven, and of the other.
    pub dyads: [DyadGiven; 2],
    /// Two corners of a box in which the fixed pivots must lie, m.
    pub pivots_in: Option<[[Scalar; 2]; 2]>,
    /// Two corners of a box in the body's own axes in which the moving pivots must lie, m.
    pub pins_in: Option<[[Scalar; 2]; 2]>,
    /// Where the poses as a whole stand in the file.
    pub span: Span,
}

/// A point that a coupler carries through points.
#[derive(Clone, Debug, PartialEq)]
pub struct PathTask {
    /// The points, in the order in which they are passed; at least three.
    pub points: Vec<WantedPoint>,
    /// The crank's angles at the points from any zero, rad, where they are asked for.
    pub angles: Option<Vec<Scalar>>,
    /// Whether the other two four-bars of each coupler curve are looked at, too.
    pub cognates: bool,
    /// What is given of the dyad that is driven, and of the other. The coupler's axes lie in the first point, and are not turned there.
    pub dyads: [DyadGiven; 2],
    /// Two corners of a box in which the fixed pivots must lie, m.
    pub pivots_in: Option<[[Scalar; 2]; 2]>,
    /// Where the points as a whole stand in the file.
    pub span: Span,
}

/// A point of a path.
#[derive(Clone, Debug, PartialEq)]
pub struct WantedPoint {
    /// Where it is, m.
    pub place: [Scalar; 2],
    /// The coupler's angle there, rad, where it is asked for.
    pub angle: Option<Scalar>,
    /// Where it stands in the file.
    pub span: Span,
}

/// An output that a point of the file's own mechanism moves, and that rests for a while.
#[derive(Clone, Debug, PartialEq)]
pub struct DwellTask {
    /// The point that moves it.
    pub point: PointId,
    /// The drive by which the rest is measured.
    pub drive: DriveId,
    /// How far the drive goes meanwhile, rad or m.
    pub dwell: Scalar,
    /// What rests.
    pub output: DwellOutput,
    /// By how much the output is to move in all, rad (of a slider m); that of the best transmission where it is not given.
    pub stroke: Option<Scalar>,
    /// Two corners of a box in which a lever's fixed pivot must lie, m.
    pub pivots_in: Option<[[Scalar; 2]; 2]>,
    /// Where the point, the dwell and the stroke stand in the file; nowhere what is not given.
    pub spans: [Span; 3],
}

/// A coupler curve of the file's own four-bar, traced otherwise.
#[derive(Clone, Debug, PartialEq)]
pub struct CognatesTask {
    /// The coupler point.
    pub point: PointId,
    /// The drive that leads it along its curve.
    pub drive: DriveId,
    /// Whether a body is wanted that goes along the curve without turning, instead of the other four-bars.
    pub parallel: bool,
    /// Where the point stands in the file.
    pub span: Span,
}

/// What rests while a point goes along an arc.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DwellOutput {
    /// A lever that the point turns by a rod: the point stays on a circle about the rod's other end.
    Lever,
    /// A slider that the point pushes by a rod.
    Slider,
    /// A lever with a slot for the point: it stays on a line through the lever's pivot.
    Slot,
}

/// A pose of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct WantedPose {
    /// The place of the body's origin, m.
    pub origin: [Scalar; 2],
    /// Its angle, rad.
    pub angle: Scalar,
    /// Where it stands in the file.
    pub span: Span,
}

/// What is given of a dyad, a link or a slider between the frame and a body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DyadGiven {
    /// The place of its fixed pivot, m.
    pub fixed: Option<[Scalar; 2]>,
    /// Two points of a line on which its fixed pivot lies, m.
    pub fixed_on: Option<[[Scalar; 2]; 2]>,
    /// Its moving pivot as a point of the body, m.
    pub moving: Option<[Scalar; 2]>,
    /// Two points of a line of the body on which its moving pivot lies, m.
    pub moving_on: Option<[[Scalar; 2]; 2]>,
    /// The direction of a slider's guide, rad: on the frame, or of an inverted slider-crank on the body.
    pub along: Option<Scalar>,
    /// Where it stands in the file; nowhere where nothing is given.
    pub span: Span,
}

impl DyadGiven {
    fn visit_scalars(&mut self, f: &mut dyn FnMut(&mut Scalar)) {
        let points = self.fixed.iter_mut().chain(&mut self.moving);
        let lines = self.fixed_on.iter_mut().chain(&mut self.moving_on);
        let places = points.chain(lines.flatten());
        places.flatten().chain(&mut self.along).for_each(f);
    }
}

impl SynthesizeStudy {
    /// Where its parts stand in the file.
    pub(crate) fn visit_places(&mut self, f: &mut dyn FnMut(&mut Span)) {
        let asked = (self.accept.iter_mut())
            .chain(&mut self.rank)
            .chain(&mut self.columns);
        asked.for_each(|asked| f(&mut asked.span));
        f(&mut self.span);
        match &mut self.task {
            SynthesisTask::Function(task) => match &mut task.wanted {
                WantedFunction::Pairs(pairs) => pairs.iter_mut().for_each(|p| f(&mut p.span)),
                WantedFunction::Curve(curve) => f(&mut curve.span),
            },
            SynthesisTask::Rates(task) => task.spans.iter_mut().for_each(f),
            SynthesisTask::DeadCentres(task) => task.spans.iter_mut().for_each(f),
            SynthesisTask::Motion(task) => {
                let poses = task.poses.iter_mut().map(|pose| &mut pose.span);
                let dyads = task.dyads.iter_mut().map(|dyad| &mut dyad.span);
                poses.chain(dyads).chain([&mut task.span]).for_each(f);
            }
            SynthesisTask::Path(task) => {
                let points = task.points.iter_mut().map(|point| &mut point.span);
                let dyads = task.dyads.iter_mut().map(|dyad| &mut dyad.span);
                points.chain(dyads).chain([&mut task.span]).for_each(f);
            }
            SynthesisTask::Dwell(task) => task.spans.iter_mut().for_each(f),
            SynthesisTask::Cognates(task) => f(&mut task.span),
        }
    }

    /// Every expression over parameters.
    pub(crate) fn visit_scalars(&mut self, f: &mut dyn FnMut(&mut Scalar)) {
        match &mut self.task {
            SynthesisTask::Function(task) => {
                task.zeros.iter_mut().flatten().for_each(&mut *f);
                task.ground.iter_mut().for_each(&mut *f);
                match &mut task.wanted {
                    WantedFunction::Pairs(pairs) => {
                        for pair in pairs {
                            f(&mut pair.input);
                            f(&mut pair.output);
                            let more = pair.ratio.iter_mut().chain(&mut pair.ratio_rate);
                            more.for_each(&mut *f);
                        }
                    }
                    WantedFunction::Curve(curve) => {
                        let ends = [&mut curve.x, &mut curve.input, &mut curve.output];
                        ends.into_iter().flatten().for_each(f);
                    }
                }
            }
            SynthesisTask::Rates(task) => {
                let all = task.speeds.iter_mut().chain(&mut task.accelerations);
                all.chain([&mut task.ground]).for_each(f);
            }
            SynthesisTask::Motion(task) => {
                for pose in &mut task.poses {
                    let all = pose.origin.iter_mut().chain([&mut pose.angle]);
                    all.for_each(&mut *f);
                }
                task.dyads.iter_mut().for_each(|dyad| dyad.visit_scalars(f));
                let boxes = task.pivots_in.iter_mut().chain(&mut task.pins_in);
                boxes.flatten().flatten().for_each(f);
            }
            SynthesisTask::Path(task) => {
                for point in &mut task.points {
                    let all = point.place.iter_mut().chain(&mut point.angle);
                    all.for_each(&mut *f);
                }
                let angles = task.angles.iter_mut().flatten();
                angles
                    .chain(task.pivots_in.iter_mut().flatten().flatten())
                    .for_each(&mut *f);
                task.dyads.iter_mut().for_each(|dyad| dyad.visit_scalars(f));
            }
            SynthesisTask::Dwell(task) => {
                f(&mut task.dwell);
                task.stroke.iter_mut().for_each(&mut *f);
                task.pivots_in.iter_mut().flatten().flatten().for_each(f);
            }
            SynthesisTask::Cognates(_) => {}
            SynthesisTask::DeadCentres(task) => {
                f(&mut task.time_ratio);
                match &mut task.stroke {
                    Stroke::Swing {
                        swing,
                        rocker,
                        coupler,
                    } => {
                        [swing, rocker].into_iter().chain(coupler).for_each(f);
                    }
                    Stroke::Travel {
                        travel,
                        coupler,
                        offset,
                    } => {
                        [travel]
                            .into_iter()
                            .chain(coupler)
                            .chain(offset)
                            .for_each(f);
                    }
                }
            }
        }
    }
}
