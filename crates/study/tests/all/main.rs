//! The tests of `kempe-study`, one program: each file is a room of its own.

mod adjust;
mod between_steps;
mod choice;
mod clearance;
mod closer;
mod comparison;
mod contact;
mod dimensions;
mod drawn;
mod drawn_elsewhere;
mod examples;
mod fit;
mod fit_beside;
mod forces;
mod motion;
mod mutants;
mod optimize;
mod optimize_alone;
mod optimize_catalogue;
mod optimize_fronts;
mod optimize_ridges;
mod optimize_slopes;
mod optimize_starts;
mod pictures;
mod point_rates;
mod proof;
mod rests;
mod rigid_friction;
mod round_trips;
mod scale;
mod simulated;
mod slots;
mod stiction;
mod stops_carry;
mod sweep;
mod synthesis;
mod synthesis_cognates;
mod synthesis_dwell;
mod synthesis_motion;
mod synthesis_path;
mod told;
mod tolerance;
mod tolerance_effects;
mod tolerance_play;
mod tolerance_worst;
mod verify;
mod vibrations;
mod vibrations_moving;

#[path = "../support/beside.rs"]
mod beside;
#[path = "../support/bounded.rs"]
mod bounded;
#[path = "../support/impatient.rs"]
mod impatient;
#[path = "../../../model/tests/support/mutants.rs"]
mod mutation;
#[path = "../../../model/tests/support/read.rs"]
mod read;
#[path = "../support/examples.rs"]
mod support;
