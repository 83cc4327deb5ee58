//! Forces in planar mechanisms: what drives them and what their joints carry, by two routes that must agree.
//!
//! # Signs, written once
//! * A **joint force** is the force on the later-named body: of a pin on the later of its links, of a joint of the file
//!   on its first-named link (the slider, the pin's link) where the file's language says so, or on the link asked for.
//!   The other body feels the opposite.
//! * A **drive's torque or force** is what the drive must give, positive along its coordinate: a turning drive's torque
//!   acts counter-clockwise on the link it turns and clockwise on the one it turns against; a cylinder's force pushes
//!   its ends apart; a slide's force pushes the slider along its guide.
//! * **Springs and dampers**: tension is positive. A torsion spring's torque is positive when it resists growth of the
//!   angle of its second link against its first.
//! * **Reduced load** of a drive is what gravity, loads, springs and dampers give along its coordinate: positive where
//!   they help it on. Eksergian's equation: `I q" + I' q'^2 / 2 = reduced load + friction + drive`.
//! * **Shaking force and moment** are those of the inertia of the moving masses alone, on the frame, the moment about
//!   the frame's origin: `-sum m a` and `-sum (r x m a + J alpha)`. Weights and loads are left out.
//! * **Power** of a drive is positive where it gives energy to the mechanism.
//!
//! # Two routes
//! *Virtual power* ([`virtual_power`]) projects inertia, loads, springs, dampers and friction on the motion that each
//! drive alone gives (its kinematic coefficients); it knows nothing of joints. *Newton and Euler* ([`equilibrium`])
//! solve every body's equilibrium for the multipliers of all joints and drives, from the one definition of each joint
//! in `kempe-mechanism`; it knows nothing of kinematic coefficients. Where they differ, one of them is wrong, so their
//! difference stands in every row. What a drive gives is taken from virtual power (it stays finite at a singular pose),
//! what a joint carries from the multipliers.
//!
//! # Numbers
//! The core is generic over the number it runs on ([`ForceNumber`]): plain numbers for one value, Taylor series in time for
//! rates, dual numbers for derivatives to parameters, lanes for many designs or instants, intervals for bounds. What has to
//! branch is decided in every lane by itself: a lane has the bits that its numbers give alone, and is NaN alone where friction
//! jams or the pose is singular. Bounds of multipliers are proved; they are the whole line where they cannot be, as near a
//! singular pose or a jam, and where equilibrium does not determine the loads. What intervals do not tell counts as not known:
//! a joint that always rests rubs in any sense where the speeds of its bodies are told as intervals with width.

pub mod acting;
pub mod amount;
pub mod answer;
pub mod arrow;
pub mod balance;
pub mod clearance;
pub mod cylinder;
pub mod damper;
pub mod ends;
pub mod energy;
pub mod equations_of_motion;
pub mod equilibrium;
pub mod forces;
pub mod friction;
pub mod inertia;
pub mod instant;
pub mod joint_contact;
pub mod let_go;
pub mod linearised;
pub mod load;
pub mod modes;
pub mod motor;
pub mod note;
mod number;
pub mod oil;
pub mod pressed;
pub mod problem;
pub mod reaction;
pub mod reduced;
mod sampler;
pub mod sensitivity;
pub mod shaking;
mod sliding_sense;
mod source;
pub mod spring;
pub mod spring_choice;
pub mod static_equilibrium;
pub mod table;
pub mod teeth;
pub mod turning;
mod vector;
pub mod virtual_power;
pub mod weld;
pub mod wrench;

pub use acting::Acting;
pub use arrow::{ForceArrow, Origin};
pub use equations_of_motion::EquationsOfMotion;
pub use forces::{Forces, FrictionOutcome};
pub use instant::{Instant, Rates};
pub use let_go::{LetGo, NotLetGo};
pub use linearised::{LeftOut, Linearised, Lineariser};
pub use modes::{Mode, NoModes, modes};
pub use note::ForceNote;
pub use number::{ForceNumber, PlainNumber};
pub use problem::Problem;
pub use reaction::{Carrier, JointLoad, Reaction};
pub use sampler::{ForceError, ForceEvidence, ForceSample, ForceSampler};
pub use sensitivity::{sensitivities, sensitivities_at};
pub use source::{Source, only_simulated};
pub use static_equilibrium::{Unsettled, settle};
