//! The keys of `[clearance]` and of its studies.

use kempe_units::Dimension as D;

use super::{LINK, OF_STUDIES, SHOWN, kind, may, must, not_negative, words};
use crate::clearance::{ClearanceModel, ClearanceRates};
use crate::keys::{Key, Kind, Takes as T};

/// The models of contact.
pub(crate) const MODELS: [(&str, ClearanceModel); 1] = [("continuous", ClearanceModel::Continuous)];

/// Models of contact that this version has not got.
pub(crate) const LATER_MODELS: [&str; 2] = ["two-state", "three-state"];

/// How the links in the clearances may turn.
pub(crate) const RATES: [(&str, ClearanceRates); 2] = [
    ("frozen", ClearanceRates::Frozen),
    ("turning", ClearanceRates::Turning),
];

const MODEL_WORDS: T = T::Words(&words(&MODELS));
const RATE_WORDS: T = T::Words(&words(&RATES));

const EXAMPLE: &str = "B = { radial = \"10 um\" }";

static RADIAL_OF_PIN: [Key; 1] = [must("radial", not_negative(D::LENGTH), "\"10 um\"", "How far the centres of the pin and its bore may part.")];
static ACROSS: [Key; 1] = [must("radial", not_negative(D::LENGTH), "\"10 um\"", "How far it may leave its line to either side.")];
static RADIAL: [Key; 1] = [must("radial", not_negative(D::LENGTH), "\"10 um\"", "How far pin and bore, or a slider and its line, may part.")];

pub(crate) static OF_PIN: Kind = kind("clearance of", "pin",
    EXAMPLE,
    "Play at the pin of a point.",
    &[&RADIAL_OF_PIN, &[
        may("on", T::AnyOf(&[LINK, T::List(&LINK, 1)]), "\"coupler\"", "Where several links share the pin, those that have play on it; all but the first of the file unless said otherwise."),
    ]]);

pub(crate) static OF_JOINT: Kind = kind("clearance of", "joint",
    EXAMPLE,
    "Play across the line of a slider or of a pin in a slot.",
    &[&ACROSS]);

pub(crate) static OF_ALL: Kind = kind("clearance of", "all",
    "all = { radial = \"10 um\" }",
    "Play at every pin, slider and slot without an entry of its own.",
    &[&RADIAL]);

/// Studies of what play does.
pub(crate) static STUDY: Kind = kind("study", "clearance",
    "kind = \"clearance\"",
    "What play at the joints does to the motion and its forces.",
    &[&OF_STUDIES, &SHOWN, &[
        may("model", MODEL_WORDS, "\"continuous\"", "What is assumed of the contact: continuous, unless said otherwise, means that it is never lost."),
        may("rates", RATE_WORDS, "\"turning\"", "Whether the directions of the clearances turn with the reactions, for speeds and accelerations, or are frozen, unless said otherwise."),
    ]]);
