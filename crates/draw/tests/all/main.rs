//! The tests of `kempe-draw`, one program: each file is a room of its own.

mod dimensions;
mod formats;
mod hostile;
mod loads;

#[path = "../../examples/showcase/forces.rs"]
mod forces;
#[path = "../../examples/showcase/mechanisms.rs"]
mod mechanisms;
#[path = "../../examples/showcase/reports.rs"]
mod reports;
