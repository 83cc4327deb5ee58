//! Optimisation as plain maths: no word of mechanisms.
//!
//! | file | for |
//! | --- | --- |
//! | `problem.rs` | what is minimised: a box, objectives and constraints that are the largest of their pieces |
//! | `workers.rs` | who does pieces of work that do not depend on each other |
//! | `progress.rs` | how long work tells how far it has come, and why it ended |
//! | `space.rs`, `halton.rs` | the box, and points that fill it evenly |
//! | `quadratic.rs` | convex quadratic programmes |
//! | `least_squares.rs` | sums of squares, from far away to near an optimum |
//! | `sqp.rs` | local optima with their multipliers, or what conflicts |
//! | `multi_start.rs`, `rounds.rs`, `reached.rs` | all local optima that many starts lead to; these in rounds; what they led to, and what may be left to find |
//! | `standing.rs` | which of two designs is better |
//! | `generations.rs` | what methods of populations share |
//! | `differential_evolution.rs`, `cma_es.rs` | the global optimum of one objective, as far as evaluations go |
//! | `nsga2.rs`, `dominance.rs`, `variation.rs` | fronts of several objectives, which designs others leave behind, children of designs |
//! | `front.rs`, `refine.rs`, `widen.rs`, `ends.rs`, `valleys.rs`, `gaps.rs` | ways down to first-order optimal designs of a front; its designs moved along them; the front led on and its gaps filled; its ends; ways from elsewhere; where gaps are |
//! | `topography.rs` | designs that are less than all their neighbours |
//! | `one_of.rs` | one objective alone |
//! | `within.rs` | objectives that may not be too large, as beside a pole |
//! | `hypervolume.rs` | how much a front dominates |

mod cma_es;
mod differential_evolution;
mod dominance;
mod ends;
mod front;
mod gaps;
mod generations;
mod halton;
mod hypervolume;
mod least_squares;
mod multi_start;
mod nsga2;
mod one_of;
mod problem;
mod progress;
mod quadratic;
mod reached;
mod refine;
mod rounds;
mod space;
mod sqp;
mod standing;
mod topography;
mod valleys;
mod variation;
mod widen;
mod within;
mod workers;

pub use cma_es::{CmaEs, CmaEsOptions, cma_es};
pub use differential_evolution::{
    DifferentialEvolution, DifferentialEvolutionOptions, Trial, differential_evolution,
};
pub use dominance::dominates;
pub use front::{EndsFrom, FIRST_ORDER, Refined, RefinedFront, undominated};
pub use generations::{FEASIBLE, Found, Generated, Generations, generations};
pub use halton::halton;
pub use hypervolume::hypervolume;
pub use least_squares::{Descent, Linear, Squares, least_squares};
pub use multi_start::{Optima, multi_start};
pub use nsga2::{Front, Member, Nsga2, Nsga2Options, nsga2};
pub use problem::{Candidate, Evaluation, Piece, Problem, Scales, Slopes, evaluate_all};
pub use progress::{Ended, Hears, Progress, silent};
pub use quadratic::{Minimum, NoMinimum, Quadratic, Row, minimise};
pub use reached::Reached;
pub use refine::{evenly, refine, refine_some};
pub use rounds::{Further, MultiStartOptions};
pub use sqp::{Multipliers, Optimum, SqpOptions, descents, sqp};
pub use standing::{Standing, worst_first};
pub use widen::{Widening, joined, widen};
pub use within::Within;
pub use workers::{Alone, Task, Workers, each, each_heard};
