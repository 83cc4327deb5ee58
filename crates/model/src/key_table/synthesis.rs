//! The keys of studies that ask for linkages: of each task its own.

use kempe_units::Dimension as D;

use super::of_studies::STUDY_KINDS;
use super::row::{ANGLE, DRIVE, MEASURES, PLACE, POINT, any, kind, may, must, one_of, positive, value, words};
use crate::keys::{Key, Kind, Named, Sign, Takes};
use crate::synthesis::{DwellOutput, LinkageKind};
use Takes as T;

/// How many linkages may be kept.
pub(crate) const MAX_KEPT: usize = 1000;

/// What stands for an angle that the synthesis finds.
pub(crate) const FREE: &str = "free";
const FREE_WORDS: T = T::Words(&[FREE]);

/// The kinds of linkage.
pub(crate) const LINKAGES: [(&str, LinkageKind); 3] = [
    ("four-bar", LinkageKind::FourBar),
    ("slider-crank", LinkageKind::SliderCrank),
    ("inverted slider-crank", LinkageKind::InvertedSliderCrank),
];
const LINKAGE_WORDS: T = T::Words(&words(&LINKAGES));

/// What may rest.
pub(crate) const OUTPUTS: [(&str, DwellOutput); 3] = [
    ("lever", DwellOutput::Lever),
    ("slider", DwellOutput::Slider),
    ("slot", DwellOutput::Slot),
];

pub(super) const EITHER: T = T::AnyOf(&[any(D::ANGLE), any(D::LENGTH)]);

static HEAD: [Key; 1] = [must("kind", STUDY_KINDS, "\"synthesize\"", "What kind of study it is.")];

static WANTED: [Key; 4] = [
    may("accept", MEASURES, "[\"min(transmission_angle) >= 35 deg\", \"max(link_ratio) <= 5\"]", "What a linkage must keep over its motion through what is asked; those that do not are told with the reason."),
    may("rank", T::Measure, "\"max(link_ratio)\"", "The linkages come in the order of this, the smallest first; the link ratio unless said otherwise."),
    may("columns", MEASURES, "[\"min(transmission_angle)\"]", "Measures to tabulate besides."),
    may("keep", T::Count(MAX_KEPT), "12", "So many linkages are kept at most; 20 unless said otherwise."),
];

/// The tasks, each with the keys of its own.
pub(crate) static TASKS: [&Kind; 7] = [&FUNCTION, &RATES, &DEAD_CENTRES, &GUIDANCE, &PATH, &DWELL, &COGNATES];
/// Those that ask what belongs to the file's own mechanism.
pub(crate) static OF_THE_FILE: [&Kind; 2] = [&DWELL, &COGNATES];

static FUNCTION: Kind = kind("study", "synthesize function",
    "kind = \"synthesize\", task = \"function\", pairs = [[45, 52], [90, 82], [135, 112]], ground = \"50 mm\"",
    "The linkages whose output goes as the input asks, through all pairs where they are as many as can be kept, near to them where they are more.",
    &[&HEAD, &[
        must("task", T::Words(&["function"]), "\"function\"", "The task: an output that goes as an input asks."),
        may("linkage", LINKAGE_WORDS, "\"slider-crank\"", "Its kind; a four-bar unless said otherwise."),
        one_of("pairs", T::List(&T::List(&EITHER, 2), 1), "[[45, 52], [90, 82], [135, 112]]", "Angles of input and output that go together (of a slider-crank the slider's places); a third and fourth value are the output's change for the input's, and the change of that."),
        one_of("function", T::Table(&CURVE), "{ y = \"ln(x) / ln(10)\", x = [1, 2], input = [\"45 deg\", \"105 deg\"], output = [\"135 deg\", \"225 deg\"], points = 3 }", "A curve that two dials show, met where Chebyshev's spacing says."),
        may("zeros", T::Two(&T::AnyOf(&[EITHER, FREE_WORDS])), "[\"20 deg\", \"free\"]", "Where input and output stand, counted from the line of the fixed pivots, as the pairs say 0; at 0 unless said otherwise. Each that is free takes one pair more."),
        may("ground", positive(D::LENGTH), "\"50 mm\"", "Distance of the fixed pivots; 1 in the file's unit unless said otherwise."),
    ], &WANTED]);

pub(crate) static CURVE: Kind = kind("function", "function",
    "function = { y = \"ln(x) / ln(10)\", x = [1, 2], input = [\"45 deg\", \"105 deg\"], output = [\"135 deg\", \"225 deg\"], points = 3 }",
    "A curve that two dials show evenly.",
    &[&[
        must("y", T::Text, "\"ln(x) / ln(10)\"", "A number as a formula of the number x."),
        must("x", T::Two(&any(D::NONE)), "[1, 2]", "Both ends of x."),
        must("input", T::Two(&ANGLE), "[\"45 deg\", \"105 deg\"]", "The input's angles at both ends of x."),
        must("output", T::Two(&EITHER), "[\"135 deg\", \"225 deg\"]", "The output's angles (of a slider-crank its places) at both ends of x."),
        may("points", T::Count(100), "3", "In so many places it is met, or approached; as many as the free zeros allow unless said otherwise."),
    ]]);

static RATES: Kind = kind("study", "synthesize rates",
    "kind = \"synthesize\", task = \"rates\", speeds = [\"20 rad/s\", \"8.5 rad/s\", \"13 rad/s\"], accelerations = [\"0 rad/s^2\", \"-10 rad/s^2\", \"-160 rad/s^2\"], ground = \"100 mm\"",
    "The four-bar whose crank, coupler and rocker have given angular speeds and accelerations at one pose.",
    &[&HEAD, &[
        must("task", T::Words(&["rates"]), "\"rates\"", "The task: rates at one pose."),
        must("speeds", T::List(&any(D::ANGULAR_SPEED), 3), "[\"20 rad/s\", \"8.5 rad/s\", \"13 rad/s\"]", "Angular speeds of crank, coupler and rocker."),
        must("accelerations", T::List(&any(D::ANGULAR_ACCELERATION), 3), "[\"0 rad/s^2\", \"-10 rad/s^2\", \"-160 rad/s^2\"]", "Their angular accelerations."),
        may("ground", positive(D::LENGTH), "\"100 mm\"", "Distance of the fixed pivots; 1 in the file's unit unless said otherwise."),
    ], &WANTED]);

static DEAD_CENTRES: Kind = kind("study", "synthesize dead-centres",
    "kind = \"synthesize\", task = \"dead-centres\", swing = \"60 deg\", time_ratio = 1.2, rocker = \"40 mm\"",
    "The crank-rocker or slider-crank that goes so far, and takes so much longer there than back as its crank turns evenly.",
    &[&HEAD, &[
        must("task", T::Words(&["dead-centres"]), "\"dead-centres\"", "The task: how far an output goes to and fro, and how fast."),
        one_of("swing", positive(D::ANGLE), "\"60 deg\"", "By which angle a rocker swings."),
        one_of("stroke", positive(D::LENGTH), "\"80 mm\"", "How far a slider goes."),
        may("time_ratio", positive(D::NONE), "1.2", "The time of the slower way over that of the quicker; 1 unless said otherwise."),
        may("rocker", positive(D::LENGTH), "\"40 mm\"", "The rocker's length; 1 in the file's unit unless said otherwise."),
        may("coupler", positive(D::LENGTH), "\"90 mm\"", "The coupler's length; where it is not given, that of the best transmission angle."),
        may("offset", super::not_negative(D::LENGTH), "\"12 mm\"", "How far a slider's guide passes beside the crank's pivot, instead of the coupler."),
    ], &WANTED]);

const POSES: &str = "[[0, 0, \"0 deg\"], [12, 6, \"20 deg\"], [20, 18, \"55 deg\"]]";

static GUIDANCE: Kind = kind("study", "synthesize motion",
    "kind = \"synthesize\", task = \"motion\", poses = [[0, 0, \"0 deg\"], [12, 6, \"20 deg\"], [20, 18, \"55 deg\"]], crank = { moving = [-10, 5] }, rocker = { moving = [8, 5] }",
    "The linkages whose coupler passes through poses: two to five, or near to more.",
    &[&HEAD, &[
        must("task", T::Words(&["motion"]), "\"motion\"", "The task: a body that is guided through poses."),
        must("poses", T::List(&T::List(&EITHER, 3), 2), POSES, "The poses in their order: the place of the body's origin, and the body's angle."),
        may("linkage", LINKAGE_WORDS, "\"four-bar\"", "Its kind; all kinds unless said otherwise."),
        may("crank", T::Table(&DYAD), "{ moving = [-10, 5] }", "What is given of the dyad that is driven."),
        may("rocker", T::Table(&DYAD), "{ moving = [8, 5] }", "What is given of the other dyad: the rocker, the slider, or the slot."),
        may("pivots_in", T::Two(&PLACE), "[[-50, -50], [50, 50]]", "Two corners of a box in which the fixed pivots must lie, and are looked for."),
        may("pins_in", T::Two(&PLACE), "[[-20, -20], [20, 20]]", "Two corners of a box in the body's own axes in which the moving pivots must lie."),
    ], &WANTED]);

const POINTS: &str = "[[0, 0], [10, 8], [25, 12], [40, 10], [52, 2]]";

static PATH: Kind = kind("study", "synthesize path",
    "kind = \"synthesize\", task = \"path\", points = [[0, 0], [10, 8], [25, 12], [40, 10], [52, 2]], crank = { fixed = [0, -20] }, rocker = { fixed = [40, -25] }",
    "The four-bars of which a point of the coupler passes points: nine; or fewer where the crank's angles, pivots or angles of the coupler are given.",
    &[&HEAD, &[
        must("task", T::Words(&["path"]), "\"path\"", "The task: a point that is carried through points."),
        must("points", T::AnyOf(&[T::List(&T::List(&EITHER, 2), 3), T::Table(&POINT_TABLE)]), POINTS, "The points in their order; a third value is the coupler's angle there."),
        may("angles", T::List(&ANGLE, 3), "[0, 30, 60, 90, 120]", "The crank's angles at the points, from any zero."),
        may("crank", T::Table(&DYAD), "{ fixed = [0, -20] }", "What is given of the link that is driven; its moving pivot as seen from the first point, the coupler not being turned there."),
        may("rocker", T::Table(&DYAD), "{ fixed = [40, -25] }", "What is given of the other link."),
        may("cognates", T::Flag, "true", "Whether the other two four-bars that trace the same coupler curve are looked at, too, wherever their pivots are; of nine points they always are."),
        may("pivots_in", T::Two(&PLACE), "[[-50, -50], [50, 50]]", "Two corners of a box in which the fixed pivots must lie."),
    ], &WANTED]);

static DWELL: Kind = kind("study", "synthesize dwell",
    "kind = \"synthesize\", task = \"dwell\", point = \"P\", dwell = \"120 deg\"",
    "The outputs beside the file's mechanism that rest while its drive goes on: a point of a coupler moves them, and goes along an arc or a line meanwhile.",
    &[&HEAD, &[
        must("task", T::Words(&["dwell"]), "\"dwell\"", "The task: an output that rests."),
        must("point", POINT, "\"C\"", "The point that moves the output."),
        must("dwell", value(D::LENGTH, D::ANGLE, Sign::Positive), "\"120 deg\"", "How far the drive goes while the output rests."),
        may("drive", DRIVE, "\"motor\"", "The drive by which the rest is measured; may be left out where there is one only."),
        may("output", T::Words(&words(&OUTPUTS)), "\"slot\"", "What rests: a lever or a slider that the point moves by a rod, or a lever with a slot for the point; a lever unless said otherwise."),
        may("swing", positive(D::ANGLE), "\"30 deg\"", "By how much the lever is to swing in all; of a slot it must be given, else as transmits best unless said otherwise."),
        may("stroke", positive(D::LENGTH), "\"40 mm\"", "How far the slider is to go in all; as transmits best unless said otherwise."),
        may("pivots_in", T::Two(&PLACE), "[[-50, -50], [50, 50]]", "Two corners of a box in which the lever's fixed pivot must lie; half the mechanism's size around it unless said otherwise."),
    ], &WANTED]);

static COGNATES: Kind = kind("study", "synthesize cognates",
    "kind = \"synthesize\", task = \"cognates\", point = \"P\"",
    "The other four-bars that lead a point along the coupler curve of the file's own, or six-bars in which a body goes along it without turning.",
    &[&HEAD, &[
        must("task", T::Words(&["cognates"]), "\"cognates\"", "The task: a coupler curve traced otherwise."),
        must("point", POINT, "\"C\"", "The coupler point."),
        may("drive", DRIVE, "\"motor\"", "The drive that leads it along its curve; may be left out where there is one only."),
        may("parallel", T::Flag, "true", "Whether a body is wanted that goes along the curve without turning, joined to the file's mechanism, instead of the other four-bars."),
    ], &WANTED]);

pub(crate) static POINT_TABLE: Kind = kind("point table", "points",
    "points = { table = \"nine.csv\", x = \"x\", y = \"y\" }",
    "Points from a table beside the file.",
    &[&[
        must("table", T::Name(Named::File), "\"nine.csv\"", "The file, in the model's folder."),
        may("x", T::Name(Named::Column), "\"x\"", "Its column of x; `x` unless said otherwise."),
        may("y", T::Name(Named::Column), "\"y\"", "Its column of y; `y` unless said otherwise."),
    ]]);

pub(crate) static DYAD: Kind = kind("dyad", "dyad",
    "{ moving = [-10, 5] }",
    "What is given of one of the two links or sliders that guide a body. A point counts as two poses, a line or a direction as one.",
    &[&[
        may("fixed", PLACE, "[30, -5]", "The place of its fixed pivot."),
        may("fixed_on", T::Two(&PLACE), "[[0, -20], [1, -20]]", "Two points of a line on which its fixed pivot lies."),
        may("moving", PLACE, "[-10, 5]", "Its moving pivot as a point of the body."),
        may("moving_on", T::Two(&PLACE), "[[0, 5], [1, 5]]", "Two points of a line of the body on which its moving pivot lies."),
        may("along", ANGLE, "\"90 deg\"", "The direction of its guide where it is a slider: on the frame, or of an inverted slider-crank on the body."),
    ]]);
