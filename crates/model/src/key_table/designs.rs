//! The keys of studies of many designs: sweeps, tolerances, optima.

use kempe_units::Dimension as D;

use super::of_studies::STUDY_KINDS;
use super::row::{LINK, MEASURES, POINT, kind, may, must, positive, words};
use crate::designs::{Combine, OptimizeMethod};
use crate::keys::{Key, Kind, Named, Takes as T};
use super::synthesis::EITHER;

/// So many parameters may vary.
pub(crate) const MAX_VARIED: usize = 64;
/// So many values may be given of one parameter.
pub(crate) const MAX_VALUES: usize = 1_000_000;
/// So many designs a study may have.
pub(crate) const MAX_DESIGNS: usize = 100_000_000;
/// Seeds go so far.
const MAX_SEED: usize = 1_000_000_000;

/// How values of several parameters go together.
pub(crate) const COMBINE: [(&str, Combine); 3] = [
    ("grid", Combine::Grid),
    ("one at a time", Combine::OneAtATime),
    ("together", Combine::Together),
];

/// How an optimum is looked for.
pub(crate) const OPTIMIZE_METHODS: [(&str, OptimizeMethod); 4] = [
    ("local", OptimizeMethod::Local),
    ("multi-start", OptimizeMethod::MultiStart),
    ("differential evolution", OptimizeMethod::DifferentialEvolution),
    ("cma-es", OptimizeMethod::CmaEs),
];

/// How values between two are spaced: whether evenly in the logarithm.
pub(crate) const SPACING: [(&str, bool); 2] = [("even", false), ("log", true)];

const OVER: Key = may("over", T::Name(Named::Study), "\"turn\"",
    "The study that is run for every design, of motion or forces or a simulation; may be left out where the file has one of motion or forces alone.");

const NUMBERS: Key = may("columns", MEASURES, "[\"max(x(C))\", \"range(angle(rocker))\"]",
    "Numbers over the motion that are told of every design; all named ones unless said otherwise, or without such the least and the largest of each measure.");

const SEED: Key = may("seed", T::Count(MAX_SEED), "7", "Which random numbers are used; 1 unless said otherwise.");

const CONDITIONS: T = T::AnyOf(&[T::Measure, T::List(&T::Measure, 1)]);

pub(crate) static SWEEP: Kind = kind("study", "sweep",
    "kind = \"sweep\", over = \"turn\", vary = { a = { from = \"15 mm\", to = \"25 mm\", count = 5 } }",
    "A study run for given values of parameters.",
    &[&[
        must("kind", STUDY_KINDS, "\"sweep\"", "What kind of study it is."),
        OVER,
        must("vary", T::Values(&T::AnyOf(&[T::List(&T::AnyValue, 1), T::Table(&SWEPT)])), "{ a = [\"1 mm\", \"2 mm\"] }",
            "Parameters with their values: in brackets, or evenly from one to another."),
        may("combine", T::Words(&words(&COMBINE)), "\"one at a time\"",
            "How the values of several parameters go together: each with each unless said otherwise, one parameter after the other, or all first values, all second ones and so on."),
        NUMBERS,
        may("plot", T::AnyOf(&[T::Measure, T::List(&T::Measure, 0)]), "[\"angle(rocker)\"]",
            "Measures that are plotted for all designs in one picture; those that the study that is run plots unless said otherwise."),
    ]]);

pub(crate) static SWEPT: Kind = kind("swept values", "values",
    "a = { from = \"15 mm\", to = \"25 mm\", count = 5 }",
    "Values of a parameter.",
    &[&[
        may("from", T::AnyValue, "\"1 mm\"", "The first of values that lie evenly."),
        may("to", T::AnyValue, "\"3 mm\"", "The last of them."),
        may("count", T::Count(MAX_VALUES), "7", "How many."),
        may("by", T::AnyValue, "\"1 %\"", "The file's own value, and that less and more by this, a part of it or an amount of its own dimension."),
    ]]);

pub(crate) static TOLERANCE: Kind = kind("study", "tolerance",
    "kind = \"tolerance\", over = \"turn\", vary = { a = \"0.1 mm\" }, limits = [\"range(angle(rocker)) >= 59 deg\"]",
    "What tolerances of parameters do to the numbers of a study.",
    &[&[
        must("kind", STUDY_KINDS, "\"tolerance\"", "What kind of study it is."),
        OVER,
        may("vary", T::Values(&T::AnyOf(&[T::AnyValue, T::Table(&SPREAD)])), "{ a = \"0.1 mm\" }",
            "Parameters with their tolerances: by how much they may differ from their values to either side, an amount or a part. Needed where no `clearance` is counted."),
        may("clearance", T::Flag, "true", "Whether joints have the play that [clearance] gives them, pressed to one side that differs from piece to piece."),
        may("limits", CONDITIONS, "[\"range(angle(rocker)) >= 59 deg\"]", "What a piece must keep to be good; what has a value at every instant must keep it all along."),
        may("samples", T::Count(MAX_DESIGNS), "100000", "How many pieces are drawn; 10000 unless said otherwise."),
        SEED,
        NUMBERS,
        may("plot", T::AnyOf(&[T::Measure, T::List(&T::Measure, 0)]), "[\"angle(rocker)\"]",
            "Measures that are plotted with the band in which the pieces lie; those that the study that is run plots unless said otherwise."),
    ]]);

pub(crate) static SPREAD: Kind = kind("spread", "spread",
    "a = { normal = \"0.05 mm\" }",
    "How a parameter differs from its value in the file.",
    &[&[
        may("uniform", T::AnyValue, "\"0.1 mm\"", "Evenly, by as much to either side, an amount or a part."),
        may("between", T::Two(&T::AnyValue), "[\"-0.1 mm\", \"0 mm\"]", "Evenly, between two deviations."),
        may("normal", T::AnyValue, "\"5 %\"", "Normally, with this standard deviation; the worst case takes three of them."),
    ]]);

pub(crate) static OPTIMIZE: Kind = kind("study", "optimize",
    "kind = \"optimize\", over = \"turn\", vary = { a = [\"15 mm\", \"25 mm\"] }, minimize = \"max(abs(rate(angle(rocker))))\", subject_to = [\"range(angle(rocker)) >= 60 deg\"]",
    "The design that does something best.",
    &[&[
        must("kind", STUDY_KINDS, "\"optimize\"", "What kind of study it is."),
        OVER,
        must("vary", T::Values(&T::AnyOf(&[T::Two(&T::AnyValue), T::Table(&AMONG)])), "{ a = [\"1 mm\", \"2 mm\"] }",
            "The parameters that are chosen, each between its least and its greatest value."),
        may("minimize", MEASURES, "\"max(x(C))\"", "What is to be small: a number over the motion; several make a front of designs of which none is better in all."),
        may("maximize", MEASURES, "\"min(x(C))\"", "What is to be large."),
        may("fit", T::Table(&FIT), "{ point = \"C\", to = [[20, 30], [25, 32], [30, 32]] }", "What is to be fitted in least squares, instead: the path of a point or the motion of a link, to places that are given."),
        may("subject_to", CONDITIONS, "[\"range(angle(rocker)) >= 59 deg\"]", "What must be kept; what has a value at every instant must keep it all along."),
        may("method", T::Words(&words(&OPTIMIZE_METHODS)), "\"multi-start\"",
            "How it is looked for: from many starts unless said otherwise."),
        SEED,
        may("designs", T::Count(MAX_DESIGNS), "20000", "How many designs are tried at most."),
        NUMBERS,
    ]]);

/// How places are met along the motion.
pub(crate) const TIMINGS: [(&str, usize); 4] = [("ordered", 0), ("nearest", 1), ("even", 2), ("arc-length", 3)];

pub(crate) static FIT: Kind = kind("fit", "fit",
    "fit = { point = \"C\", to = [[20, 30], [25, 32], [30, 32]] }",
    "Places that a point or a link is to come near to.",
    &[&[
        may("point", POINT, "\"C\"", "The point whose path is fitted."),
        may("link", LINK, "\"rocker\"", "The link whose motion is fitted, instead."),
        may("at", POINT, "\"C\"", "Of a link the point whose places are given."),
        may("radius", positive(D::LENGTH), "\"50 mm\"", "Of a link how much an angle counts: as the arc that lies so far from the point."),
        must("to", T::AnyOf(&[T::List(&T::List(&EITHER, 2), 2), T::Table(&FIT_TABLE)]), "[[20, 30], [25, 32], [30, 32]]",
            "The places: [x, y], of a link [x, y, angle]; or a table of them."),
        may("timing", T::AnyOf(&[T::Words(&words(&TIMINGS)), T::Values(&T::AnyOf(&[T::List(&T::AnyValue, 2), T::Name(Named::Column)]))]), "\"arc-length\"",
            "Where along the motion they are met: wherever is nearest in their order unless said otherwise, or each by itself; at even times; where the path is passed to the same part of its length; or where a drive or the time has given values, as in { motor = [30, 45, 60] }."),
        may("closed", T::Flag, "true", "Whether the way closes, and may be begun anywhere and gone either way."),
    ]]);

pub(crate) static FIT_TABLE: Kind = kind("place table", "to",
    "to = { table = \"curve.csv\", x = \"x\", y = \"y\" }",
    "Places from a table beside the file.",
    &[&[
        must("table", T::Name(Named::File), "\"curve.csv\"", "The file, in the model's folder."),
        may("x", T::Name(Named::Column), "\"x\"", "Its column of x; `x` unless said otherwise."),
        may("y", T::Name(Named::Column), "\"y\"", "Its column of y; `y` unless said otherwise."),
        may("angle", T::Name(Named::Column), "\"angle\"", "Its column of angles, of a link; `angle` unless said otherwise."),
    ]]);

pub(crate) static AMONG: Kind = kind("choice", "choice",
    "z = { between = [17, 40], step = 1 }",
    "The values among which a parameter is chosen.",
    &[&[
        may("between", T::Two(&T::AnyValue), "[\"1 mm\", \"2 mm\"]", "Its least and its greatest value."),
        may("spacing", T::Words(&words(&SPACING)), "\"log\"",
            "How a search that looks all over goes between them: evenly unless said otherwise, or evenly in the logarithm, for values over several decades."),
        may("step", T::AnyValue, "\"0.5 mm\"", "It is a whole multiple of this."),
        may("only", T::List(&T::AnyValue, 1), "[\"1 mm\", \"2 mm\"]", "It is one of these, as of a catalogue."),
    ]]);
