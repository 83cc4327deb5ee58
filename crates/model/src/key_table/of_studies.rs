//! The keys that several kinds of studies share.

use kempe_units::Dimension as D;

use super::row::{DAMPING, DRIVE, END, MEASURES, kind, may, must, not_negative, positive, stiffness, words};
use crate::keys::{Key, Kind, Sign, Takes as T};
use crate::simulate_study::StepMethod;

/// Rows a table may have.
pub(crate) const MAX_ROWS: usize = 10_000_000;

/// How a simulation makes its steps.
pub(crate) const METHODS: [(&str, StepMethod); 2] = [
    ("explicit", StepMethod::Explicit),
    ("implicit", StepMethod::Implicit),
];
const METHOD_WORDS: T = T::Words(&words(&METHODS));

pub(super) const STUDY_KINDS: T = T::Words(&["motion", "forces", "balance", "spring", "simulate", "clearance", "vibrations", "adjust", "sweep", "tolerance", "optimize", "synthesize"]);

pub(super) static OF_STUDIES: [Key; 3] = [
    must("kind", STUDY_KINDS, "\"motion\"", "What kind of study it is."),
    may("step", T::AnyValue, "\"5 ms\"", "Step of the drive, or of time; a degree, or the 180th part of a travel, unless said otherwise."),
    may("rows", T::Count(MAX_ROWS), "361", "How many rows, evenly in time, instead of a step."),
];

pub(super) static SHOWN: [Key; 2] = [
    may("columns", MEASURES, "[\"swing\", \"rate(swing)\"]", "Measures to tabulate; all named ones unless said otherwise."),
    may("plot", T::AnyOf(&[T::Measure, T::List(&MEASURES, 0)]), "[\"swing\", \"path(P)\"]",
        "Measures, path(P), of forces also hodograph(B, link); in brackets measures that share a picture."),
];

/// Of studies that find how things move in time.
pub(super) static IN_TIME: [Key; 6] = [
    may("release", T::AnyOf(&[DRIVE, T::List(&DRIVE, 1)]), "[\"motor\"]", "Drives that are let go and give nothing but what their motors can; all unless said otherwise, the others keep their laws."),
    may("start", T::Values(&T::AnyOf(&[T::AnyValue, T::Two(&T::AnyValue)])), "{ motor = \"30 deg\", motor_rate = \"2 rad/s\" }", "Where drives that are let go start, and with `_rate` how fast; where their laws start, and at rest, unless said otherwise. Where contact may be lost, also joints with play: B = [\"3 um\", \"-2 um\"]."),
    may("stops", T::Values(&T::AnyOf(&[T::Two(&END), T::Table(&STOP)])), "{ rocker = [\"-10 deg\", \"95 deg\"] }", "Least and largest angle of a link, coordinate of a drive or value of a measure, where it is stopped."),
    may("end_when", T::AnyOf(&[T::Measure, T::List(&T::Measure, 1)]), "\"angle(rocker) <= 0 deg\"", "It ends when this comes to hold."),
    may("tolerance", positive(D::NONE), "1e-10", "Error of a step, in parts of what moves, at most 0.01; 1e-13 unless said otherwise."),
    may("method", METHOD_WORDS, "\"implicit\"", "How steps are made; as suits unless said otherwise."),
];

pub(crate) static STOP: Kind = kind("stop", "stop",
    "rocker = { between = [\"-10 deg\", \"95 deg\"], restitution = 0.4 }",
    "What an angle or a length cannot pass.",
    &[&[
        must("between", T::Two(&END), "[\"-10 deg\", \"none\"]", "Least and largest."),
        may("restitution", not_negative(D::NONE), "0.4", "Speed after an impact over that before; 0 unless said otherwise."),
        may("stiffness", stiffness(Sign::Positive), "\"5 N m/deg\"", "Of a stop that gives."),
        may("damping", DAMPING, "\"0.1 N m s\"", "Of a stop that gives; 0 unless said otherwise."),
    ]]);
