//! Optimisation as plain maths: no word of mechanisms.
//!
//! | file | for |
//! | --- | --- |
//! | `problem.rs` | what is minimised: a box, objectives and constraints that are the largest of their pieces |
//! | `progress.rs` | how long work tells how far it has come, and why it ended |
//! | `space.rs` | the box |
//! | `quadratic.rs` | convex quadratic programmes |
//! | `sqp.rs` | local optima with their multipliers |

mod problem;
mod progress;
mod quadratic;
mod space;
mod sqp;

pub use problem::{Evaluation, Piece, Problem, Scales, Slopes};
pub use progress::{Ended, Hears, Progress, silent};
pub use quadratic::{Minimum, NoMinimum, Quadratic, Row, minimise};
pub use sqp::{Multipliers, Optimum, SqpOptions, sqp};
