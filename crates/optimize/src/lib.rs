//! Optimisation as plain maths: no word of mechanisms.
//!
//! | file | for |
//! | --- | --- |
//! | `problem.rs` | what is minimised: a box, objectives and constraints that are the largest of their pieces |
//! | `progress.rs` | how long work tells how far it has come, and why it ended |
//! | `space.rs` | the box |
//! | `quadratic.rs` | convex quadratic programmes |
//! | `least_squares.rs` | sums of squares, from far away to near an optimum |
//! | `sqp.rs` | local optima with their multipliers |
//! | `rank.rs` | which of two designs is the better one |
//! | `sequence.rs` | points that fill a box evenly |
//! | `multi_start.rs` | local optima from many starts |
//! | `population.rs` | what methods share that ask for whole generations |
//! | `evolution.rs` | differential evolution |
//! | `cma_es.rs` | a normal distribution that adapts |
//! | `front.rs` | Pareto fronts, and their points made optimal to first order |
//! | `hypervolume.rs` | how much a front dominates |

mod cma_es;
mod evolution;
mod front;
mod hypervolume;
mod least_squares;
mod multi_start;
mod population;
mod problem;
mod progress;
mod quadratic;
mod rank;
mod sequence;
mod space;
mod sqp;

pub use cma_es::cma_es;
pub use evolution::differential_evolution;
pub use front::{Front, FrontPoint, dominates, nsga2, refine};
pub use hypervolume::hypervolume;
pub use least_squares::{Descent, Linear, Squares, least_squares};
pub use multi_start::{MultiStartOptions, Optima, multi_start};
pub use population::{Found, Member, PopulationOptions};
pub use problem::{Evaluation, Piece, Problem, Scales, Slopes};
pub use progress::{Ended, Hears, Progress, silent};
pub use quadratic::{Minimum, NoMinimum, Quadratic, Row, minimise};
pub use rank::compare;
pub use sequence::Even;
pub use sqp::{Multipliers, Optimum, SqpOptions, sqp};
