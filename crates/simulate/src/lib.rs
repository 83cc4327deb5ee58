//! Mechanisms let go: how they move in time under what acts on them.
//!
//! A drive that is let go gives nothing but what its motor can; its coordinate `q` moves as `M(q) q" = Q - h(q, q', t)` says,
//! the same definitions as inverse dynamics ([`kempe_dynamics::equations_of_motion`]). So coordinates are minimal: no constraint
//! drifts, and a pose is closed as exactly as in any other study. Whoever asks gets those of a spanning tree instead, whose ties are closed in
//! every state.
//!
//! | file | for |
//! | --- | --- |
//! | `question.rs` | what is asked: what is let go, from where, how long, against which stops |
//! | `start.rs` | the pose that the motion starts from |
//! | `places.rs` | poses from coordinates: `curve.rs` along the followed motion of one coordinate, `several.rs` by the plan |
//! | `cut.rs`, `ties.rs`, `tree.rs` | coordinates of a spanning tree: the plant whose loops are cut, what keeps them closed, what drives are to it |
//! | `leap.rs` | across a change point where several coordinates move |
//! | `tellers.rs` | which coordinates tell the place: others where one comes to its own dead point |
//! | `plant.rs` | accelerations of a state, with motors, stops and friction |
//! | `site.rs`, `rubbing.rs`, `sticking.rs` | friction where several coordinates move: the places that rub, what slides in which sense, and what holds what is at rest |
//! | `amounts.rs` | values that loads, valves and motors go by |
//! | `inner.rs`, `pressures.rs`, `toggle.rs` | inner states: how pressures of cylinders go, and what is switched on and off |
//! | `watch.rs` | what is looked for between steps |
//! | `step.rs`, `first.rs` | a step that was made; what of what is looked for happens first in it |
//! | `step_limits.rs`, `corners.rs`, `sharp.rs` | how far a step may go, whatever its errors are: by time, and by what acts in some places alone |
//! | `barrier.rs`, `contact.rs` | stops: how far they are open; impacts, and what holds a rest |
//! | `rigid.rs`, `oblique.rs`, `cone.rs` | friction of rigid contacts: what rubs by what presses, impacts, and forces in Coulomb's cone |
//! | `joints.rs`, `touched.rs` | joints with play, whose bodies touch and part; what became of every touch |
//! | `run.rs` | from step to step and from event to event; `run/begin.rs` what keeps it from beginning, `run/events.rs` what events do, `run/rests.rs` where it comes to rest |
//! | `lack.rs`, `unsimulated.rs` | why a state has no accelerations, and what has no value; why there is no simulation |
//! | `vector.rs` | products and sums of rows along the coordinates |
//! | `record.rs` | what was found, as laws of the drives |

mod amounts;
mod barrier;
mod cone;
mod contact;
mod corners;
mod curve;
mod cut;
mod first;
mod happening;
mod inner;
mod joints;
mod lack;
mod leap;
mod oblique;
mod places;
mod plant;
mod pressures;
mod question;
mod record;
mod rigid;
mod rubbing;
mod run;
mod several;
mod sharp;
mod site;
mod start;
mod step;
mod step_limits;
mod sticking;
mod tellers;
mod ties;
mod toggle;
mod touched;
mod tree;
mod unsimulated;
mod vector;
mod watch;

pub use kempe_integrate::{Method, Used};

pub use happening::{Happened, Happening, Held};
pub use joints::with_play;
pub use lack::{Lack, Sought};
pub use leap::Across;
pub use plant::Tied;
pub use question::{Coordinates, Question, Resistance, Stop};
pub use record::{Ending, Simulated, Tree};
pub use run::{Ready, ready, simulate};
pub use site::Rubs;
pub use start::NoStart;
pub use touched::{Place, Touched};
pub use unsimulated::{NoTree, Unsimulated};
