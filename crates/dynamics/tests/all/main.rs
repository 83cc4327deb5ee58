//! The tests of `kempe-dynamics`, one program: each file is a room of its own.

mod any_number;
mod belts_and_curved_slots;
mod clearance;
mod equations_of_motion;
mod free_motion;
mod joints;
mod modes;
mod prop_forces;
mod releasing;
mod seeds;
mod sensitivity;
mod smooth_slots;
mod teeth;
mod vibrations;

#[path = "../support/acted.rs"]
mod acted;
#[path = "../../../integrate/tests/support/known.rs"]
mod known;
#[path = "../../../motion/tests/support/mod.rs"]
mod mechanisms;
#[path = "../support/mod.rs"]
mod support;
#[path = "../support/toothed.rs"]
mod toothed;
