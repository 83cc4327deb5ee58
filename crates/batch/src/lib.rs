//! Many poses at once: one design over a sweep of its motion, or many designs at the same places of a motion.
//!
//! Several poses run side by side in [`Lanes`](kempe_number::Lanes), on the best vector instructions that the processor
//! has. Every row has the bits that the plan gives on plain `f64`, whatever the instructions, the executor or the row's
//! neighbours.
//!
//! Output is by columns, as tables are: all `x` of the first point, all its `y`, all `x` of the second point, and so on;
//! m, in the frame.

mod batch;
mod columns;
mod designs;
mod error;
mod executor;
mod kept;
mod mask;
mod order;
mod stretch;
mod sweep;
mod wide;
mod workspace;

pub use self::batch::Batch;
pub use self::designs::{Designs, Layout};
pub use self::error::BatchError;
#[cfg(not(target_family = "wasm"))]
pub use self::executor::Threads;
pub use self::executor::{Executor, Serial, Task};
pub use self::sweep::sweep_states;
