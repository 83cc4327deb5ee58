//! Joints with play: where journal and bearing, or block and guide, touch, which forces arise there, and what an impact delivers.
//!
//! | file | for |
//! | --- | --- |
//! | `touch.rs` | what two bodies do where they touch or nearly do, and what forces there do to them |
//! | `pin.rs`, `guide.rs` | the places where a pin in its hole and a block in its guide touch |
//! | `normal.rs` | forces that press: elastic, and dissipating |
//! | `restitution.rs` | how much a law must dissipate for a wanted restitution, and which one it delivers |
//! | `impact.rs` | the deepest indentation, the largest force and the duration of an impact |
//! | `stiffness.rs` | the stiffness of two bodies from their materials and radii |
//! | `friction.rs` | forces that resist sliding |
//! | `unfit.rs` | what is no such joint |
//!
//! This is a library of its own: simulations take of it what files have words for (Hertz's law with every factor, springs with dampers, friction
//! that sets in between two speeds), and a Rust program also the rest of the literature's laws: every onset of friction, the restitution
//! that a factor delivers, what an impact comes to in closed form, contact outside each other ([`Fit`]). Each is held against numbers found
//! apart from it (`tests/`).
//!
//! Laws and geometry run on any [`Number`](kempe_number::Number); what must be solved for is solved once, on plain numbers.

mod friction;
mod guide;
mod impact;
mod normal;
mod pin;
mod restitution;
mod stiffness;
mod touch;
mod unfit;

pub use friction::{Friction, Onset, falling_coefficient};
pub use guide::BlockInGuide;
pub use impact::Impact;
pub use kempe_model::Dissipation;
pub use normal::{Damping, Normal};
pub use pin::PinWithPlay;
pub use restitution::{delivered, delivered_by_factor, factor};
pub use stiffness::{Fit, Material, stiffness};
pub use touch::{Body, Touch, Wrench};
pub use unfit::Unfit;
