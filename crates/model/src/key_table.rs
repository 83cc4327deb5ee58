//! The keys of the model file, all of them: the one table that the reader, the schema, help and the docs go by.

pub(crate) mod clearance;
pub(crate) mod adjust;
pub(crate) mod designs;
mod of_studies;
mod row;
pub(crate) mod synthesis;

use kempe_units::Dimension as D;

use crate::keys::{Key, Kind, Named, Sign, Takes};
use crate::load::Acts;
use crate::drive::RiseLaw;
use crate::link::Side;
use crate::simulate_study::CoordinateKind;
use crate::study::BalanceGoal;
use Takes as T;

pub(crate) use of_studies::{MAX_ROWS, METHODS, STOP};
pub(crate) use row::word_of;

use of_studies::{IN_TIME, OF_STUDIES, SHOWN, STUDY_KINDS};
use row::{
    ACCELERATION, ANGLE, COLUMN, COORDINATE, DAMPING, DRIVE, END, LINK, NONE, PLACE, POINT, SPEED, TENSION,
    any, kind, may, must, not_negative, one_of, positive, stiffness, value, words,
};

/// In which sense a spring may act.
pub(crate) const ACTS: [(&str, Acts); 3] = [
    ("both", Acts::Both),
    ("tension", Acts::Tension),
    ("compression", Acts::Compression),
];

/// What counterweights may be for.
pub(crate) const GOALS: [(&str, BalanceGoal); 2] = [
    ("shaking force", BalanceGoal::ShakingForce),
    ("statics", BalanceGoal::Statics),
];

/// Where a drive is held that is held as drawn.
pub(crate) const DRAWN: &str = "drawn";

/// The sides of a rack.
pub(crate) const SIDES: [(&str, Side); 4] = [
    ("left", Side::Left),
    ("right", Side::Right),
    ("left of", Side::Left),
    ("right of", Side::Right),
];

/// The standard motion laws.
pub(crate) const LAWS: [(&str, RiseLaw); 4] = [
    (RiseLaw::ALL[0].name(), RiseLaw::ALL[0]),
    (RiseLaw::ALL[1].name(), RiseLaw::ALL[1]),
    (RiseLaw::ALL[2].name(), RiseLaw::ALL[2]),
    (RiseLaw::ALL[3].name(), RiseLaw::ALL[3]),
];

/// Which coordinates tell the place in a simulation.
pub(crate) const COORDINATES: [(&str, CoordinateKind); 2] = [
    ("minimal", CoordinateKind::Minimal),
    ("spanning-tree", CoordinateKind::SpanningTree),
];
const COORDINATES_WORDS: T = T::Words(&words(&COORDINATES));

const ACT_WORDS: T = T::Words(&words(&ACTS));
const GOAL_WORDS: T = T::Words(&words(&GOALS));
const SIDE_WORDS: T = T::Words(&words(&SIDES));
const LAW_WORDS: T = T::Words(&words(&LAWS));

/// The file itself: its keys are the sections.
pub static FILE: Kind = kind("file", "file",
    "[links]",
    "A planar linkage: its links, joints, drives, measures and studies.",
    &[&[
        may("title", T::Text, "\"Crank-rocker\"", "Title of the report."),
        may("units", T::Table(&UNITS), "{ length = \"mm\", angle = \"deg\" }", "Units of bare numbers and of results; m and deg unless said otherwise."),
        may("gravity", T::AnyOf(&[not_negative(D::ACCELERATION), T::Pair(D::ACCELERATION)]), "[0, \"-9.81 m/s^2\"]",
            "Acceleration of gravity: [x, y], or its size along -y; 9.81 m/s^2 along -y unless said otherwise."),
        may("parameters", T::Values(&T::AnyValue), "a = \"20 mm\"", "Named dimensions of the design."),
        may("places", T::Values(&PLACE), "A = [0, 0]", "The mechanism as it is drawn: where its points lie in one of its positions, from which lengths, assembly and starts of drives follow."),
        must("links", T::Entries(&[&LINKS]), "crank = { A-B = \"20 mm\" }", "Rigid bodies as sets of points; `frame` stands still."),
        may("joints", T::Entries(&JOINTS), SLIDER.example, "Joints that a shared point name does not say."),
        may("drives", T::Entries(&DRIVES), TURNS.example, "What is moved from outside, and how."),
        may("assembly", T::Values(&T::AnyOf(&[T::Side, T::Table(&HINT)])), "C = \"left of B -> D\"", "Which assembly is meant, at the start of the drives."),
        may("loads", T::Entries(&[&FORCE, &TORQUE]), FORCE.example, "Forces and torques from outside."),
        may("masses", T::Entries(&[&MASS]), MASS.example, "Point masses on links: counterweights."),
        may("springs", T::Entries(&[&SPRING]), SPRING.example, "Springs."),
        may("dampers", T::Entries(&[&DAMPER]), DAMPER.example, "Dampers."),
        may("friction", T::Entries(&[&FRICTION_OF_PIN, &FRICTION_OF_JOINT, &FRICTION_OF_ALL]), FRICTION_OF_PIN.example,
            "Friction, by the point of a pin, by the name of a joint, or for `all`."),
        may("cylinders", T::Entries(&[&CYLINDER]), CYLINDER.example, "Hydraulic cylinders, by the name of their drive."),
        may("motors", T::Entries(&[&MOTOR]), MOTOR.example, "Motors, by the name of their drive."),
        may("switches", T::Entries(&[&SWITCH]), SWITCH.example, "Limit switches of simulations, which loads, valves and motors may go by."),
        may("clearance", T::Entries(&[&clearance::OF_PIN, &clearance::OF_JOINT, &clearance::OF_ALL]), clearance::OF_PIN.example,
            "Play at joints, by the point of a pin, by the name of a slider, or for `all`."),
        may("measures", T::Values(&T::Measure), "swing = \"angle(rocker)\"", "Named measures: expressions over what may be asked of the mechanism."),
        may("studies", T::Entries(&STUDIES), "kind = \"motion\"", "What is asked of the model."),
    ]]);

pub(crate) static UNITS: Kind = kind("units", "units",
    "units = { length = \"mm\", angle = \"deg\" }",
    "Units of bare numbers and of results.",
    &[&[
        may("length", T::Unit(D::LENGTH), "\"mm\"", "The unit of lengths, and within speeds, areas and all that is made of lengths."),
        may("angle", T::Unit(D::ANGLE), "\"deg\"", "The unit of angles, and within angular speeds."),
        may("force", T::Unit(D::FORCE), "\"kN\"", "The unit of forces."),
        may("torque", T::Unit(D::TORQUE), "\"kN m\"", "The unit of torques."),
        may("pressure", T::Unit(D::PRESSURE), "\"bar\"", "The unit of pressures."),
        may("power", T::Unit(D::POWER), "\"kW\"", "The unit of power."),
        may("mass", T::Unit(D::MASS), "\"t\"", "The unit of masses."),
    ]]);

pub(crate) static LINKS: Kind = Kind {
    what: "link", name: "link",
    example: "crank = { A-B = 20 }",
    about: "Points by coordinates (P = [x, y]), by distances (A-B = 20) and sides, or by the names of points that [places] draws ([\"A\", \"B\"]), and mass properties.",
    alone: Some("points"),
    points: &[
        may("P", T::AnyOf(&[PLACE, T::Side]), "[0, 20]", "A point by its place on the link, or by its side of a line between two others to which it has distances."),
        may("A-B", positive(D::LENGTH), "20", "The distance of two points; of two that are drawn it counts instead of the drawn one."),
    ],
    groups: &[&[
        may("points", T::List(&POINT, 1), "[\"A\", \"B\"]", "Points of the link that [places] draws: the link's origin lies in the first, its x axis points to the second."),
        may("mass", not_negative(D::MASS), "\"2 kg\"", "Mass of the link; 0 unless given."),
        may("inertia", not_negative(D::INERTIA), "\"0.02 kg m^2\"", "Moment of inertia about the centre of mass."),
        may("center", T::AnyOf(&[T::Words(&["centroid"]), POINT, PLACE]), "\"centroid\"", "Centre of mass: \"centroid\", a point of the link, or a place on it."),
        may("bar", T::Table(&BAR), "{ width = \"20 mm\", thickness = \"5 mm\", density = \"7850 kg/m^3\" }", "Mass, inertia and centre of a bar along the link's first distance."),
        may("linear_density", positive(D::LINEAR_DENSITY), "\"0.5 kg/m\"", "Mass, inertia and centre of a thin rod along the link's first distance."),
    ]],
};

pub(crate) static BAR: Kind = kind("bar", "bar",
    "bar = { width = \"20 mm\", thickness = \"5 mm\", density = \"7850 kg/m^3\" }",
    "A bar with square ends.",
    &[&[
        must("width", positive(D::LENGTH), "\"20 mm\"", "Its width, in the plane."),
        must("thickness", positive(D::LENGTH), "\"5 mm\"", "Its thickness, across the plane."),
        must("density", positive(D::DENSITY), "\"7850 kg/m^3\"", "Mass per volume."),
    ]]);

/// The kinds of joints.
pub(crate) static JOINTS: [&Kind; 6] = [&SLIDER, &SLOT, &WELD, &GEARS, &BELT, &RACK];

static SLIDER: Kind = kind("joint", "slider",
    "bore = { slider = \"piston\", at = \"C\", on = \"E -> F\" }",
    "A point of a link stays on a line of another, and the link keeps its angle to it.",
    &[&[
        must("slider", LINK, "\"piston\"", "The link that slides."),
        must("at", POINT, "\"C\"", "Its point that stays on the line."),
        must("on", T::Line, "\"E -> F\"", "The line, through two points of another link."),
        may("angle", ANGLE, "\"30 deg\"", "From the line to the slider's x axis; 0 unless said otherwise."),
    ]]);

static SLOT: Kind = kind("joint", "pin",
    "slot = { pin = \"B\", on = \"O -> P\" }",
    "A pin in a slot: a point stays on a line, an arc or a smooth curve of another link and may turn.",
    &[&[
        must("pin", POINT, "\"B\"", "The point in the slot."),
        one_of("on", T::Line, "\"O -> P\"", "A straight slot, through two points of another link."),
        one_of("arc", T::Line, "\"O -> P\"", "A curved slot, from one point of another link to another of it."),
        one_of("through", T::List(&POINT, 3), "[\"O\", \"P\", \"E\"]", "A curved slot along the smooth curve through at least three points of another link."),
        may("radius", positive(D::LENGTH), "40", "The arc's radius, at least half the distance of its ends; `arc` needs it."),
        may("side", SIDE_WORDS, "\"right\"", "On which side of the way along the arc's ends its centre lies; left unless said otherwise."),
        may("closed", T::Flag, "true", "Whether the slot goes all the way round: the whole circle, or a curve back to its first point."),
    ]]);

static WELD: Kind = kind("joint", "weld",
    "rigid = { weld = [\"leg\", \"foot\"], angle = \"30 deg\" }",
    "Two links that share a point become one body.",
    &[&[
        must("weld", T::Two(&LINK), "[\"leg\", \"foot\"]", "The two links."),
        may("at", POINT, "\"C\"", "The point that they share, where they share several."),
        may("angle", ANGLE, "\"30 deg\"", "From the first link's x axis to the second's; 0 unless said otherwise."),
    ]]);

static GEARS: Kind = kind("joint", "gears",
    "mesh = { gears = [\"sun\", \"planet\"], arm = \"carrier\", teeth = [20, 40] }",
    "Two gears in mesh whose axes sit on an arm.",
    &[&[
        must("gears", T::Two(&LINK), "[\"sun\", \"planet\"]", "The two gears."),
        may("arm", LINK, "\"carrier\"", "The link that carries both axes; the frame unless said otherwise."),
        must("teeth", T::Two(&T::AnyValue), "[20, 40]", "Their numbers of teeth, or their radii."),
        may("internal", T::Flag, "true", "Whether one of them is a ring."),
        may("phase", ANGLE, "\"5 deg\"", "The first gear's angle on the arm where the second's is 0; 0 unless said otherwise."),
    ], &TEETH]);

/// What is told of teeth, for the forces at them.
static TEETH: [Key; 2] = [
    may("pressure_angle", positive(D::ANGLE), "\"20 deg\"", "Between the tooth force and the common tangent of the pitch circles, for the force that parts the axes and for friction; without it the tooth force is along that tangent."),
    may("module", positive(D::LENGTH), "\"2 mm\"", "The pitch diameter over the number of teeth, needed for friction where a wheel is told by its radius."),
];

static BELT: Kind = kind("joint", "belt",
    "belt = { belt = [\"pulley\", \"wheel\"], radii = [20, 60] }",
    "A belt or chain over two wheels whose axes sit on an arm.",
    &[&[
        must("belt", T::Two(&LINK), "[\"pulley\", \"wheel\"]", "The two wheels."),
        may("arm", LINK, "\"leg\"", "The link that carries both axes; the frame unless said otherwise."),
        one_of("radii", T::Two(&T::AnyValue), "[20, 60]", "The radii of the wheels of a belt."),
        one_of("teeth", T::Two(&T::AnyValue), "[18, 44]", "The numbers of teeth of the wheels of a chain or a toothed belt."),
        may("pitch", positive(D::LENGTH), "12.7", "The length from tooth to tooth; `teeth` need it."),
        may("crossed", T::Flag, "true", "Whether the runs cross, so that the wheels turn against each other."),
        may("phase", ANGLE, "\"5 deg\"", "The first wheel's angle on the arm where the second's is 0; 0 unless said otherwise."),
    ]]);

static RACK: Kind = kind("joint", "rack",
    "rack = { rack = \"bar\", pinion = \"wheel\", radius = \"20 mm\" }",
    "A pinion rolls along a rack's x axis; other joints hold its centre.",
    &[&[
        must("rack", LINK, "\"bar\"", "The link whose x axis is toothed."),
        must("pinion", LINK, "\"wheel\"", "The link that rolls."),
        may("center", POINT, "\"C\"", "The pinion's centre; its first point unless said otherwise."),
        must("radius", positive(D::LENGTH), "\"20 mm\"", "The pinion's radius."),
        may("side", SIDE_WORDS, "\"right\"", "On which side of the rack's x axis the pinion lies; left unless said otherwise."),
        may("offset", any(D::LENGTH), "\"5 mm\"", "The centre's place along the rack where both links have one angle; 0 unless said otherwise."),
    ], &TEETH]);

/// The kinds of drives.
pub(crate) static DRIVES: [&Kind; 3] = [&TURNS, &DRIVE_CYLINDER, &SLIDES];

const HOW: T = T::AnyOf(&[LAW_WORDS, T::List(&T::Table(&PIECE), 1), T::Table(&LAW_TABLE)]);

/// How a drive moves, with examples of its coordinate at both ends, its speed and its acceleration.
const fn law([from, to, speed, acceleration]: [&'static str; 4]) -> [Key; 7] {
    [
        may("from", COORDINATE, from, "Where it starts; as drawn where [places] draws it, else 0, and needed for a cylinder."),
        may("to", COORDINATE, to, "Where it ends, such as \"drawn\" or \"drawn + 30 deg\"; one turn further unless said otherwise, and needed for what does not turn."),
        may("speed", SPEED, speed, "Constant speed, without a sign."),
        may("acceleration", ACCELERATION, acceleration, "Constant acceleration from rest, without a sign."),
        may("law", HOW, "\"cycloidal\"",
            "A standard law from rest to rest, pieces one after the other, or measured points."),
        may("in", positive(D::TIME), "\"0.2 s\"", "The time in which it moves by the law."),
        may("at", T::AnyOf(&[COORDINATE, T::Words(&[DRAWN])]), from, "Where it is held; \"drawn\" is where [places] draws it."),
    ]
}
static LAW_OF_TURNING: [Key; 7] = law(["30", "390", "\"60 rpm\"", "\"1 rad/s^2\""]);
static LAW_OF_TRAVEL: [Key; 7] = law(["\"380 mm\"", "\"520 mm\"", "\"20 mm/s\"", "\"1 m/s^2\""]);

static TURNS: Kind = kind("drive", "turns",
    "motor = { turns = \"crank\", from = 0, to = 360, speed = \"1 rad/s\" }",
    "Turns a link: its coordinate is the link's angle.",
    &[&[
        must("turns", LINK, "\"crank\"", "The link that turns."),
        may("relative_to", LINK, "\"plate\"", "The link against which its angle is taken; the frame unless said otherwise."),
    ], &LAW_OF_TURNING]);

static DRIVE_CYLINDER: Kind = kind("drive", "cylinder",
    "lift = { cylinder = \"A-B\", from = \"380 mm\", to = \"520 mm\", speed = \"20 mm/s\" }",
    "Its coordinate is the distance of two points: the whole length, not the stroke.",
    &[&[must("cylinder", T::PointPair, "\"A-B\"", "Its two points, on different links."), ON], &LAW_OF_TRAVEL]);

static SLIDES: Kind = kind("drive", "slides",
    "feed = { slides = \"piston\", from = \"0 mm\", to = \"40 mm\", law = \"cycloidal\", in = \"0.2 s\" }",
    "Its coordinate is the travel of a slider or of a pin in its slot, from the line's first point.",
    &[&[must("slides", T::Name(Named::Slider), "\"piston\"", "The link or the joint that slides.")], &LAW_OF_TRAVEL]);

pub(crate) static PIECE: Kind = kind("piece", "piece",
    "{ rise = \"30 deg\", in = \"0.3 s\" }",
    "A piece of a sequence: a dwell, or a rise, fall or end point with a time and a law or with a speed.",
    &[&[
        one_of("dwell", positive(D::TIME), "\"0.1 s\"", "For how long it stands still."),
        one_of("rise", COORDINATE, "60", "By how much the coordinate grows."),
        one_of("fall", COORDINATE, "60", "By how much the coordinate falls."),
        one_of("to", COORDINATE, "30", "To which place it goes."),
        may("in", positive(D::TIME), "\"0.3 s\"", "The time in which it moves."),
        may("by", LAW_WORDS, "\"4-5-6-7\"", "The law by which it moves; cycloidal unless said otherwise."),
        may("speed", SPEED, "\"90 deg/s\"", "Constant speed, instead of a time."),
        may("acceleration", ACCELERATION, "\"90 deg/s^2\"", "Constant acceleration from rest, instead of a time."),
    ]]);

pub(crate) static LAW_TABLE: Kind = kind("law table", "law table",
    "{ table = \"measured.csv\", time = \"t\", value = \"angle\" }",
    "Measured points from a file beside the model.",
    &[&[
        must("table", T::Name(Named::File), "\"measured.csv\"", "The file."),
        may("time", COLUMN, "\"t\"", "Its column of times; `t` unless said otherwise."),
        may("value", COLUMN, "\"angle\"", "Its column of the coordinate; `value` unless said otherwise."),
    ]]);

pub(crate) static HINT: Kind = kind("hint", "hint",
    "{ near = [173, 151] }",
    "Where a point or a link is, roughly.",
    &[&[must("near", T::AnyOf(&[ANGLE, PLACE]), "[173, 151]", "The place of a point in the frame, or the angle of a link: of those that are left, the nearest.")]]);

pub(crate) static FORCE: Kind = kind("load", "force",
    "hook = { force = [0, \"-100 N\"], at = \"E\" }",
    "A force at a point of a link.",
    &[&[
        must("force", T::Two(&T::Amount(&CARD)), "[0, \"-100 N\"]", "[x, y], or [size, direction] when the second is an angle."),
        must("at", POINT, "\"E\"", "The point at which it acts."),
        may("on", LINK, "\"jib\"", "The link on which it acts; the first of the file that moves and has the point unless said otherwise."),
        may("axes", LINK, "\"ram\"", "The link with whose axes its components turn; the frame unless said otherwise."),
    ]]);

pub(crate) static TORQUE: Kind = kind("load", "torque",
    "brake = { torque = \"-20 N m\", on = \"drum\" }",
    "A torque on a link.",
    &[&[
        must("torque", T::Amount(&CARD), "\"-20 N m\"", "Its size, counter-clockwise positive."),
        must("on", LINK, "\"drum\"", "The link on which it acts."),
        may("against", LINK, "\"arm\"", "The link that takes its reaction; the frame unless said otherwise."),
    ]]);

pub(crate) static CARD: Kind = kind("load table", "load table",
    "{ table = \"card.csv\", over = \"angle(crank)\", factor = \"-area\" }",
    "A curve from a file beside the model.",
    &[&[
        must("table", T::Name(Named::File), "\"card.csv\"", "The file."),
        must("over", T::Measure, "\"angle(crank)\"", "The measure by which the table goes."),
        may("argument", COLUMN, "\"phi\"", "The column of that measure; the first unless said otherwise."),
        may("value", COLUMN, "\"p\"", "The column of the values; the second unless said otherwise."),
        may("factor", T::AnyValue, "\"-area\"", "What makes forces or torques of the values; 1 unless said otherwise."),
        may("period", T::AnyValue, "\"720 deg\"", "After which the table repeats; without it the end values hold outside."),
    ]]);

pub(crate) static MASS: Kind = kind("mass", "mass",
    "weight = { on = \"crank\", at = [-20, 0], mass = \"2 kg\" }",
    "A point mass on a link, such as a counterweight.",
    &[&[
        may("on", LINK, "\"crank\"", "The link that carries it; for a place it is needed, for a point it is the first that moves."),
        must("at", T::AnyOf(&[PLACE, POINT]), "[-20, 0]", "A place on the link, or one of its points."),
        must("mass", not_negative(D::MASS), "\"2 kg\"", "Its mass."),
    ]]);

/// The links at the ends of what acts between two points.
const ON: Key = may("on", T::AnyOf(&[LINK, T::List(&LINK, 1)]), "\"strut\"", "The link on which it acts at a point of several, or both in brackets; the frame or the first that moves unless said otherwise.");

static BETWEEN: [Key; 3] = [
    one_of("between", T::PointPair, "\"A-B\"", "Two points of different links, between which it acts."),
    one_of("links", T::Two(&LINK), "[\"frame\", \"lever\"]", "Two links, between which it turns."),
    ON,
];

pub(crate) static SPRING: Kind = kind("spring", "spring",
    "return = { between = \"A-B\", stiffness = \"2 N/mm\", free = \"80 mm\" }",
    "Pulls with preload + stiffness * (length - free).",
    &[&BETWEEN, &[
        must("stiffness", stiffness(Sign::NotNegative), "\"2 N/mm\"", "Force per length, or torque per angle; 0, with a preload, for a constant force."),
        may("free", COORDINATE, "\"80 mm\"", "Its length or angle where stiffness gives nothing; needed unless the stiffness is 0."),
        may("preload", TENSION, "\"5 N\"", "Its tension at the free length; negative pushes, 0 unless said otherwise."),
        may("acts", ACT_WORDS, "\"tension\"", "In which sense it acts; both unless said otherwise."),
        may("stops", T::Two(&END), "[\"60 mm\", \"none\"]", "The lengths or angles below and above which the stop stiffness acts too."),
        may("stop_stiffness", stiffness(Sign::Positive), "\"500 N/mm\"", "The stiffness of the stops."),
    ]]);

pub(crate) static DAMPER: Kind = kind("damper", "damper",
    "closer = { between = \"A-B\", damping = \"50 N s/m\" }",
    "Resists the speed at which its points part, or its angle grows.",
    &[&BETWEEN, &[
        must("damping", DAMPING, "\"50 N s/m\"", "Force per speed, or torque per angular speed."),
        may("closing", DAMPING, "\"200 N s/m\"", "The same the other way, where it is another."),
    ]]);

static DRY: [Key; 3] = [
    may("coefficient", not_negative(D::NONE), "0.1", "Coulomb's coefficient, at speed; needed unless there is viscous friction alone."),
    may("static", not_negative(D::NONE), "0.15", "The coefficient at rest, with `stribeck`."),
    may("stribeck", positive(D::SPEED), "\"1 mm/s\"", "The speed over which the coefficient falls from that at rest."),
];
const fn apart_from_load(viscous: &'static str, drag: &'static str) -> [Key; 2] {
    [
        may("viscous", DAMPING, viscous, "Torque per angular speed at a pin, force per sliding speed at a slider or at teeth."),
        may("drag", value(D::FORCE, D::TORQUE, Sign::NotNegative), drag, "Torque at a pin, force at a slider, whatever the load and speed: a seal."),
    ]
}
static VISCOUS_TURNING: [Key; 2] = apart_from_load("\"0.001 N m s\"", "\"0.05 N m\"");
static VISCOUS_SLIDING: [Key; 2] = apart_from_load("\"50 N s/m\"", "\"3 N\"");
static PIN_RADIUS: [Key; 1] = [may("radius", positive(D::LENGTH), "\"10 mm\"", "The radius of the pin, needed for dry friction there.")];
const FRICTION: &str = "B = { coefficient = 0.1, radius = \"10 mm\" }";

pub(crate) static FRICTION_OF_PIN: Kind = kind("friction of", "pin",
    FRICTION,
    "Friction at the pin of a point.",
    &[&DRY, &VISCOUS_TURNING, &PIN_RADIUS, &clearance::HOLDER]);

pub(crate) static FRICTION_OF_JOINT: Kind = kind("friction of", "joint",
    FRICTION,
    "Friction of a slider, of a pin in a slot, or of the teeth of gears or a rack.",
    &[&DRY, &VISCOUS_SLIDING]);

pub(crate) static FRICTION_OF_ALL: Kind = kind("friction of", "all",
    FRICTION,
    "Friction of every pin and slider without an entry of its own.",
    &[&DRY, &PIN_RADIUS]);

pub(crate) static CYLINDER: Kind = kind("cylinder", "cylinder",
    "lift = { bore = \"80 mm\", rod = \"40 mm\", supply = \"180 bar\" }",
    "The hydraulic cylinder behind a drive.",
    &[&[
        must("bore", positive(D::LENGTH), "\"80 mm\"", "Diameter of the piston."),
        must("rod", not_negative(D::LENGTH), "\"40 mm\"", "Diameter of the rod; 0 for a plunger."),
        may("supply", positive(D::PRESSURE), "\"180 bar\"", "Pressure that the pump gives."),
        may("relief", positive(D::PRESSURE), "\"210 bar\"", "Pressure at which the relief valve opens."),
        may("back", not_negative(D::PRESSURE), "\"5 bar\"", "Pressure on the side that drains; 0 unless said otherwise."),
        may("flow", positive(D::FLOW), "\"20 L/min\"", "Flow that the pump gives."),
        may("friction", not_negative(D::FORCE), "\"200 N\"", "Friction of the seals; 0 unless said otherwise."),
        may("count", positive(D::NONE), "2", "How many act side by side; 1 unless said otherwise."),
        may("oil", T::Table(&OIL), OIL.example, "Its oil and its valve, by which it moves where a simulation lets its drive go."),
    ]]);

pub(crate) static OIL: Kind = kind("oil of", "oil",
    "{ bulk_modulus = \"14000 bar\", volume = [\"1 L\", \"1 L\"], valve = 0.5, flow = \"40 L/min\", drop = \"35 bar\" }",
    "The oil of a cylinder and its valve; of two values the first is that of the bore's side.",
    &[&[
        must("bulk_modulus", positive(D::PRESSURE), "\"14000 bar\"", "Of the oil."),
        must("volume", T::Two(&positive(D::VOLUME)), "[\"1 L\", \"1 L\"]", "Oil on both sides, hoses included; with `stroke` what is left of it at the end of the stroke. Of one cylinder."),
        must("valve", T::AnyOf(&[OPENING, T::Two(&OPENING)]), "[0.5, -0.5]", "How far it is open to both sides, as parts of the whole: from the supply, or to the tank where negative; one value alone opens the ring's side the other way."),
        must("flow", positive(D::FLOW), "\"40 L/min\"", "Flow through the whole opening ..."),
        must("drop", positive(D::PRESSURE), "\"35 bar\"", "... at this drop of pressure; it goes with the root of the drop."),
        may("closed", positive(D::LENGTH), "\"450 mm\"", "Length of the drive with the rod in; needs `stroke`."),
        may("stroke", positive(D::LENGTH), "\"500 mm\"", "How far the rod comes out; needs `closed`. Volumes go with the rod then, and its ends are stops."),
        may("hose_modulus", positive(D::PRESSURE), "\"4000 bar\"", "Bulk modulus of the walls around `volume`; stiff unless said otherwise."),
        may("wall_modulus", positive(D::PRESSURE), "\"60000 bar\"", "Bulk modulus of the cylinder's walls, with `stroke`; stiff unless said otherwise."),
        may("damping", not_negative(D::DAMPING), "\"2 kN s/m\"", "Resistance over speed; 0 unless said otherwise."),
        may("leakage", not_negative(LEAKAGE), "\"0.01 L/min/bar\"", "What leaks past the piston over the difference of pressures; 0 unless said otherwise."),
        may("start", T::Two(&any(D::PRESSURE)), "[\"50 bar\", \"20 bar\"]", "Pressures at the start; those that hold the load, `back` on the other side, unless said otherwise."),
    ]]);
const OPENING: T = T::Amount(&CARD);
/// Flow over pressure.
pub(crate) const LEAKAGE: D = D::new(4, -1, 1, 0);

pub(crate) static MOTOR: Kind = kind("motor", "motor",
    "motor = { curve = [[\"0 rpm\", \"12 N m\"], [\"3000 rpm\", \"0 N m\"]] }",
    "The motor behind a drive.",
    &[&[
        must("curve", T::List(&T::Two(&T::AnyOf(&[any(D::ANGULAR_SPEED), any(D::TORQUE)])), 2), "[[\"0 rpm\", \"12 N m\"], [\"3000 rpm\", \"0 N m\"]]",
            "Pairs of speed and torque at the drive, straight between them."),
        may("throttle", T::Amount(&CARD), "\"switch(top)\"", "The part of its curve that it gives in a simulation; the whole unless said otherwise."),
    ]]);

/// Whether a switch is on.
pub(crate) const ON_OFF: [(&str, bool); 2] = [("on", true), ("off", false)];

pub(crate) static SWITCH: Kind = kind("switch", "switch",
    "top = { on = \"y(P) <= 100 mm\", off = \"y(P) >= 400 mm\" }",
    "A limit switch of simulations: `switch(top)` is 1 where it is on and 0 where it is off.",
    &[&[
        must("on", T::Measure, "\"y(P) <= 100 mm\"", "It goes on where this comes to hold."),
        may("off", T::Measure, "\"y(P) >= 400 mm\"", "It goes off where this comes to hold; where `on` holds no more unless said otherwise."),
        may("every", T::AnyValue, "\"50 mm\"", "It counts instead: one further each time that what `on` compares has grown by this, and never back."),
        may("starts", T::Words(&words(&ON_OFF)), "\"on\"", "Whether it is on at the start; as `on` and `off` hold there unless said otherwise, else off."),
    ]]);

/// The kinds of studies.
pub(crate) static STUDIES: [&Kind; 11 + synthesis::TASKS.len()] = [
    &MOTION, &FORCES, &BALANCE, &SPRING_STUDY, &SIMULATE, &clearance::STUDY, &VIBRATIONS, &adjust::STUDY,
    &designs::SWEEP, &designs::TOLERANCE, &designs::OPTIMIZE,
    synthesis::TASKS[0], synthesis::TASKS[1], synthesis::TASKS[2], synthesis::TASKS[3], synthesis::TASKS[4], synthesis::TASKS[5], synthesis::TASKS[6],
];

static MOTION: Kind = kind("study", "motion",
    "[studies.turn] with the line kind = \"motion\"",
    "The motion along the drives' laws.",
    &[&OF_STUDIES, &SHOWN, &[may("circuit", T::Flag, "true", "Whether to follow the mechanism past its dead points through everything that it can reach.")]]);

static FORCES: Kind = kind("study", "forces",
    "kind = \"forces\"",
    "What drives the motion and what the joints carry along it.",
    &[&OF_STUDIES, &SHOWN]);

static BALANCE: Kind = kind("study", "balance",
    "kind = \"balance\", on = [\"crank\"], radius = \"60 mm\"",
    "The counterweights that make it run quietly or hang in balance.",
    &[&OF_STUDIES, &[
        may("goal", GOAL_WORDS, "\"statics\"", "What is to be small: the shaking force unless said otherwise, or what gravity asks of the drives."),
        must("on", T::List(&LINK, 1), "[\"crank\"]", "Links pinned to the frame that may carry a counterweight."),
        must("radius", positive(D::LENGTH), "\"60 mm\"", "Of the counterweights, from those pins."),
    ]]);

static SPRING_STUDY: Kind = kind("study", "spring",
    "kind = \"spring\", spring = \"back\", drive = \"motor\"",
    "The spring that leaves a wanted effort to a drive.",
    &[&OF_STUDIES, &[
        must("spring", T::Name(Named::Spring), "\"back\"", "The spring whose stiffness and preload are chosen."),
        may("drive", T::Name(Named::Drive), "\"motor\"", "The drive that it helps; may be left out where there is one only."),
        may("wanted", T::AnyOf(&[TENSION, T::Measure]), "\"0 N m\"", "What the drive is to give; nothing unless said otherwise."),
        may("stiffness", T::Two(&T::AnyOf(&[stiffness(Sign::Any), T::Words(NONE)])), "[\"0.1 N/mm\", \"none\"]", "Bounds of the stiffness; from 0 up unless said otherwise."),
        may("preload", T::Two(&T::AnyOf(&[TENSION, T::Words(NONE)])), "[0, \"none\"]", "Bounds of the preload; none unless said otherwise."),
    ]]);

static SIMULATE: Kind = kind("study", "simulate",
    "kind = \"simulate\", until = \"2 s\"",
    "How it moves in time under what acts on it, its drives let go.",
    &[&OF_STUDIES, &SHOWN, &[
        must("until", positive(D::TIME), "\"2 s\"", "How long."),
        may("coordinates", COORDINATES_WORDS, "\"spanning-tree\"", "Which coordinates tell the place on the way: minimal ones, by which loops are closed exactly, unless said otherwise, or those of a spanning tree, whose cut loops forces keep closed."),
    ], &IN_TIME]);

static VIBRATIONS: Kind = kind("study", "vibrations",
    "kind = \"vibrations\", release = [\"swing\"]",
    "The natural frequencies, mode shapes and damping about a pose, or about the poses of a motion.",
    &[&[
        must("kind", STUDY_KINDS, "\"vibrations\"", "What kind of study it is."),
        may("release", T::AnyOf(&[DRIVE, T::List(&DRIVE, 1)]), "[\"motor\"]", "The drives that are let go; all unless said otherwise. The others are held."),
        may("at", T::Values(&T::AnyValue), "{ motor = \"30 deg\" }", "Where drives stand, by their names; at their start unless said otherwise."),
        may("equilibrium", T::Flag, "false", "Whether the drives that are let go sink to static equilibrium first; they do unless said otherwise."),
        may("moving", T::Flag, "true", "Whether the drives that are held move by their laws in every row, masses with them; they stand still unless said otherwise."),
        may("step", T::AnyValue, "\"5 ms\"", "Of one held drive, or of time: the frequencies along the motion of the drives that are held; about one pose without it."),
        may("rows", T::Count(MAX_ROWS), "61", "How many rows along that motion, evenly in time, instead of a step."),
    ]]);
