//! The vocabulary of measures: one table for the reader, `kempe measures`, the docs and the hints on misspelt names.

use serde::Serialize;

/// A function that measures something.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct MeasureEntry {
    /// Its name.
    pub name: &'static str,
    /// How it is called.
    pub signatures: &'static [&'static str],
    /// What it measures: a dimension, or how it follows from the arguments'.
    pub dimension: &'static str,
    /// What it is, in one line.
    pub doc: &'static str,
    /// An example of its use.
    pub example: &'static str,
}

/// The registry of measures.
#[derive(Clone, Copy, Debug)]
pub struct Registry;

impl Registry {
    /// All measures, in the order of the reference.
    pub fn all() -> &'static [MeasureEntry] {
        MEASURES
    }

    /// The measure of a name.
    pub fn find(name: &str) -> Option<&'static MeasureEntry> {
        MEASURES.iter().find(|m| m.name == name)
    }
}

const fn row(
    name: &'static str,
    signatures: &'static [&'static str],
    dimension: &'static str,
    doc: &'static str,
    example: &'static str,
) -> MeasureEntry {
    MeasureEntry {
        name,
        signatures,
        dimension,
        doc,
        example,
    }
}

#[rustfmt::skip]
const MEASURES: &[MeasureEntry] = &[
    row("x", &["x(P)", "x(P, link)"], "length",
        "x of a point in the frame, or seen from a link in the link's own coordinates", "x(P)"),
    row("y", &["y(P)", "y(P, link)"], "length",
        "y of a point in the frame, or seen from a link in the link's own coordinates", "y(P, coupler)"),
    row("angle", &["angle(link)", "angle(link, other)", "angle(A -> B)", "angle(A, B, C)"], "angle",
        "from the frame's x axis (or another link's) to the link's, counter-clockwise and unwrapped; of a directed line; or at B between A and C, 0 to 180 deg", "angle(rocker)"),
    row("distance", &["distance(A, B)", "distance(P, A -> B)"], "length",
        "of two points; or of a point from a line of a link, positive on its left", "distance(B, D)"),
    row("travel", &["travel(slider)", "travel(joint)"], "length",
        "of a slider or a pin along its guide, from the guide's first point", "travel(piston)"),
    row("length", &["length(drive)"], "length",
        "of a cylinder", "length(lift)"),
    row("transmission_angle", &["transmission_angle(P)", "transmission_angle(P, A, B)"], "angle",
        "between the two links pinned at P, 0 to 90 deg; each link's direction goes to its pin on the frame, or else to its first other pin; or name the two ends", "transmission_angle(C)"),
    row("speed", &["speed(P)"], "length/time",
        "of a point in the frame, its size", "speed(C)"),
    row("acceleration", &["acceleration(P)"], "length/time^2",
        "of a point in the frame, its size", "acceleration(C)"),
    row("angular_speed", &["angular_speed(link)"], "angle/time",
        "of a link, positive counter-clockwise", "angular_speed(rocker)"),
    row("angular_acceleration", &["angular_acceleration(link)"], "angle/time^2",
        "of a link, positive counter-clockwise", "angular_acceleration(rocker)"),
    row("instant_center_x", &["instant_center_x(link)", "instant_center_x(link, other)"], "length",
        "x of the instant centre of a link against the frame or another link; infinite when they translate", "instant_center_x(coupler)"),
    row("instant_center_y", &["instant_center_y(link)", "instant_center_y(link, other)"], "length",
        "y of the instant centre of a link against the frame or another link; infinite when they translate", "instant_center_y(coupler)"),
    row("curvature", &["curvature(P)"], "1/length",
        "of the point's path, positive where it turns left along the motion", "curvature(P)"),
    row("curvature_center_x", &["curvature_center_x(P)"], "length",
        "x of the centre of curvature of the point's path", "curvature_center_x(P)"),
    row("curvature_center_y", &["curvature_center_y(P)"], "length",
        "y of the centre of curvature of the point's path", "curvature_center_y(P)"),
    row("path_length", &["path_length(P)"], "length",
        "length of path swept since the start of the motion", "path_length(P)"),
    row("mechanical_advantage", &["mechanical_advantage(measure, drive)"], "drive/measure",
        "the drive's speed over that of the measure: force out over force in without friction", "mechanical_advantage(y(P), motor)"),
    row("torque", &["torque(drive)"], "torque",
        "that a turning drive must give, positive along its angle", "torque(motor)"),
    row("force", &["force(drive)"], "force",
        "that a cylinder or a sliding drive must give, positive along its coordinate: a cylinder that pushes", "force(lift)"),
    row("power", &["power(drive)"], "power",
        "that a drive gives", "power(motor)"),
    row("reaction", &["reaction(P)", "reaction(P, link)", "reaction(joint)", "reaction(joint, link)"], "force",
        "size of the force that a pin or a joint carries", "reaction(B)"),
    row("reaction_x", &["reaction_x(P)", "reaction_x(P, link)", "reaction_x(joint)", "reaction_x(joint, link)"], "force",
        "its component along the frame's x axis, on the link named; else on the later-named link of a pin, the slider or the first link of a joint", "reaction_x(B, crank)"),
    row("reaction_y", &["reaction_y(P)", "reaction_y(P, link)", "reaction_y(joint)", "reaction_y(joint, link)"], "force",
        "its component along the frame's y axis, on the link named; else on the later-named link of a pin, the slider or the first link of a joint", "reaction_y(B, crank)"),
    row("reaction_angle", &["reaction_angle(P)", "reaction_angle(P, link)", "reaction_angle(joint)", "reaction_angle(joint, link)"], "angle",
        "its direction, from the frame's x axis, between -180 deg and 180 deg, on the link named; else as reaction_x", "reaction_angle(B, crank)"),
    row("reaction_along", &["reaction_along(P, link)", "reaction_along(joint, link)"], "force",
        "the component on a link along the link's own x axis", "reaction_along(B, coupler)"),
    row("reaction_across", &["reaction_across(P, link)", "reaction_across(joint, link)"], "force",
        "the component on a link along the link's own y axis", "reaction_across(B, coupler)"),
    row("reaction_moment", &["reaction_moment(joint)", "reaction_moment(joint, link)"], "torque",
        "the moment that a slider, a weld or a belt carries", "reaction_moment(bore)"),
    row("spring_force", &["spring_force(spring)"], "force; torque of a torsion spring",
        "the tension of a spring", "spring_force(return)"),
    row("damper_force", &["damper_force(damper)"], "force; torque of a torsion damper",
        "the tension of a damper: it resists parting", "damper_force(oil)"),
    row("load", &["load(load)"], "force; torque",
        "a load: the size of a force, a torque with its sign", "load(hook)"),
    row("load_x", &["load_x(load)"], "force",
        "the component of a force load along the frame's x axis", "load_x(hook)"),
    row("load_y", &["load_y(load)"], "force",
        "the component of a force load along the frame's y axis", "load_y(hook)"),
    row("pressure", &["pressure(drive)"], "pressure",
        "in the chamber of a hydraulic cylinder that drives", "pressure(lift)"),
    row("capacity", &["capacity(drive)"], "force; torque of a motor",
        "the most that a hydraulic cylinder can give along its coordinate at its supply or relief pressure, or a motor at its speed", "capacity(lift)"),
    row("reduced_mass", &["reduced_mass(drive)"], "mass; moment of inertia of a turning drive",
        "of all links, as the drive feels them: twice the kinetic energy over the drive's speed squared", "reduced_mass(lift)"),
    row("reduced_load", &["reduced_load(drive)"], "force; torque of a turning drive",
        "of all loads, gravity and springs, as the drive feels them", "reduced_load(lift)"),
    row("kinetic_energy", &["kinetic_energy"], "energy",
        "of all links", "kinetic_energy"),
    row("potential_energy", &["potential_energy"], "energy",
        "of gravity and springs", "potential_energy"),
    row("shaking_force", &["shaking_force"], "force",
        "size of the force of the moving links on the frame", "shaking_force"),
    row("shaking_force_x", &["shaking_force_x"], "force",
        "its component along the frame's x axis", "shaking_force_x"),
    row("shaking_force_y", &["shaking_force_y"], "force",
        "its component along the frame's y axis", "shaking_force_y"),
    row("shaking_moment", &["shaking_moment"], "torque",
        "moment of the moving links on the frame, about its origin", "shaking_moment"),
    row("rate", &["rate(measure)", "rate(measure, n)"], "measure/time^n",
        "n-th time derivative (first unless said otherwise)", "rate(y(C), 2)"),
    row("d", &["d(measure, drive)", "d(measure, drive, n)"], "measure/drive^n",
        "n-th derivative to a drive's coordinate, the other drives at rest: a transfer function", "d(angle(rocker), motor)"),
    row("min", &["min(measure)"], "that of the measure",
        "smallest over the motion (with two or more arguments: the smallest of them)", "min(transmission_angle(C))"),
    row("max", &["max(measure)"], "that of the measure",
        "largest over the motion (with two or more arguments: the largest of them)", "max(speed(C))"),
    row("mean", &["mean(measure)"], "that of the measure",
        "mean over the time of the motion", "mean(rate(x(C)))"),
    row("range", &["range(measure)"], "that of the measure",
        "largest less smallest over the motion", "range(angle(rocker))"),
    row("stroke", &["stroke(measure)", "stroke(slider)", "stroke(drive)"], "that of the measure; length of a slider",
        "range of a measure, of the travel of a slider or of the length of a cylinder", "stroke(piston)"),
    row("at", &["at(measure, drive, value)", "at(measure, time, value)"], "that of the measure",
        "value where a drive or the time has a value", "at(y(P), motor, 30 deg)"),
    row("time_ratio", &["time_ratio(measure)"], "number",
        "duration of the slower stroke of a measure over that of the faster, in one cycle", "time_ratio(angle(rocker))"),
];
