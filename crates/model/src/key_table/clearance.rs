//! The keys of `[clearance]` and of its studies.

use kempe_units::Dimension as D;

use super::of_studies::{IN_TIME, OF_STUDIES, SHOWN};
use super::row::{LINK, kind, may, must, not_negative, positive, words};
use crate::clearance::{ClearanceModel, ClearanceRates};
use crate::contact::{ContactLaw, Dissipation};
use crate::keys::{Key, Kind, Takes as T};

/// The models of contact.
pub(crate) const MODELS: [(&str, ClearanceModel); 3] = [
    ("continuous", ClearanceModel::Continuous),
    ("two-state", ClearanceModel::TwoState),
    ("three-state", ClearanceModel::ThreeState),
];

/// The laws of contact.
pub(crate) const LAWS: [(&str, ContactLaw); 11] = [
    ("exact", ContactLaw::Dissipating(Dissipation::Exact)),
    ("hunt-crossley", ContactLaw::Dissipating(Dissipation::HuntCrossley)),
    ("herbert-mcwhannell", ContactLaw::Dissipating(Dissipation::HerbertMcWhannell)),
    ("lee-wang", ContactLaw::Dissipating(Dissipation::LeeWang)),
    ("lankarani-nikravesh", ContactLaw::Dissipating(Dissipation::LankaraniNikravesh)),
    ("gonthier", ContactLaw::Dissipating(Dissipation::Gonthier)),
    ("zhiying-qishao", ContactLaw::Dissipating(Dissipation::ZhiyingQishao)),
    ("flores", ContactLaw::Dissipating(Dissipation::Flores)),
    ("hu-guo", ContactLaw::Dissipating(Dissipation::HuGuo)),
    ("hertz", ContactLaw::Hertz),
    ("rigid", ContactLaw::Rigid),
];

/// How the links in the clearances may turn.
pub(crate) const RATES: [(&str, ClearanceRates); 2] = [
    ("frozen", ClearanceRates::Frozen),
    ("turning", ClearanceRates::Turning),
];

const MODEL_WORDS: T = T::Words(&words(&MODELS));
const RATE_WORDS: T = T::Words(&words(&RATES));

const LAW_WORDS: T = T::Words(&words(&LAWS));

const EXAMPLE: &str = "B = { radial = \"10 um\" }";

static RADIAL_OF_PIN: [Key; 1] = [must("radial", not_negative(D::LENGTH), "\"10 um\"", "How far the centres of the pin and its bore may part.")];
static ACROSS: [Key; 1] = [must("radial", not_negative(D::LENGTH), "\"10 um\"", "How far it may leave its line to either side.")];
static RADIAL: [Key; 1] = [must("radial", not_negative(D::LENGTH), "\"10 um\"", "How far pin and bore, or a slider and its line, may part.")];

static PIN: [Key; 1] = [
    may("radius", positive(D::LENGTH), "\"9.5 mm\"", "Radius of the pin, where contact may be lost."),
];
static BLOCK: [Key; 2] = [
    may("length", not_negative(D::LENGTH), "\"40 mm\"", "Length of the slider along its guide, where contact may be lost: its corners touch."),
    may("height", not_negative(D::LENGTH), "\"20 mm\"", "Height of the slider across its guide; 0 unless said otherwise."),
];
static TOUCHING: [Key; 10] = [
    may("law", LAW_WORDS, "\"exact\"", "How bodies resist where contact may be lost: rigid at once, the others by Hertz's law with what dissipates; exact unless said otherwise, of sliders rigid."),
    may("restitution", not_negative(D::NONE), "0.9", "The part of the speed that an impact gives back."),
    may("stiffness", positive(D::NONE), "6.6e10", "Stiffness of Hertz's law, in N/m^1.5; from the radii and the material unless said otherwise."),
    may("modulus", positive(D::PRESSURE), "\"207 GPa\"", "Modulus of elasticity of both bodies; that of steel unless said otherwise."),
    may("poisson", not_negative(D::NONE), "0.3", "Poisson's ratio of both bodies; that of steel unless said otherwise."),
    may("spring", positive(D::STIFFNESS), "\"5e7 N/m\"", "Stiffness of the contact of two states."),
    may("damping", not_negative(D::DAMPING), "\"200 N s/m\"", "Damping of the contact of two states; 0 unless said otherwise."),
    may("friction", not_negative(D::NONE), "0.03", "Coefficient of friction of the contact, rigid or not; 0 unless said otherwise."),
    may("stiction", T::Flag, "true", "Whether friction holds what rests (Coulomb), and does not set in between two speeds, so that it creeps. At a rigid contact it always does."),
    may("friction_speeds", T::Two(&not_negative(D::SPEED)), "[\"1 mm/s\", \"10 mm/s\"]", "Sliding speeds from which on friction begins to act, and acts in full: 1 and 10 mm/s unless said otherwise."),
];

/// Which link a pin sits fast in.
pub(crate) static HOLDER: [Key; 1] = [may("holder", LINK, "\"rod\"", "Where several links share the pin, the one that it sits fast in, on which the others turn; the first of the file unless said otherwise, and the frame before all.")];

pub(crate) static OF_PIN: Kind = kind("clearance of", "pin",
    EXAMPLE,
    "Play at the pin of a point.",
    &[&RADIAL_OF_PIN, &[
        may("on", T::AnyOf(&[LINK, T::List(&LINK, 1)]), "\"coupler\"", "Where several links share the pin, those that have play on it; all but its `holder` unless said otherwise."),
    ], &HOLDER, &PIN, &TOUCHING]);

pub(crate) static OF_JOINT: Kind = kind("clearance of", "joint",
    EXAMPLE,
    "Play across the line of a slider or of a pin in a slot.",
    &[&ACROSS, &BLOCK, &TOUCHING]);

pub(crate) static OF_ALL: Kind = kind("clearance of", "all",
    "all = { radial = \"10 um\" }",
    "Play at every pin, slider and slot without an entry of its own; what entries leave out about contact is as here.",
    &[&RADIAL, &PIN, &BLOCK, &TOUCHING]);

/// Studies of what play does.
pub(crate) static STUDY: Kind = kind("study", "clearance",
    "kind = \"clearance\"",
    "What play at the joints does to the motion and its forces.",
    &[&OF_STUDIES, &SHOWN, &[
        may("model", MODEL_WORDS, "\"three-state\"", "What is assumed of the contact: continuous, unless said otherwise, means that it is never lost."),
        may("rates", RATE_WORDS, "\"turning\"", "Where contact is never lost: whether the directions of the clearances turn with the reactions, for speeds and accelerations, or are frozen, unless said otherwise."),
        may("until", positive(D::TIME), "\"24 ms\"", "Where contact may be lost: how long."),
    ], &IN_TIME]);
