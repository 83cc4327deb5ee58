//! The plan: how the pose is found, block by block, for given drive coordinates.
//!
//! A plan is made once for a topology. Its steps hold indices only; dimensions live in [`Design`](crate::Design), the
//! choice between assemblies in [`Branch`](crate::Branch), so one plan serves every design on every kind of number.

pub use crate::step::{Carrier, Condition, Dyad, DyadBody, Reach, Sliding, Step, Swing, SwingLine};

use crate::blocks::{Block, Decomposition, Row, Unknown, decompose};
use crate::layout::{Columns, Rows};
use crate::recognise::recognise;
use crate::spanning_tree::{ON_STACK, SpanningTree};
use crate::structure::Structure;

/// A block left to Newton's method.
#[derive(Clone, Debug)]
pub struct NewtonBlock {
    /// Its unknowns.
    pub unknowns: Vec<Unknown>,
    /// How many numbers are sought.
    pub size: usize,
    /// Constraints with the rows used; the first `size` rows belong to the square system.
    pub rows: Vec<Row>,
    /// Where its unknowns stand in its Jacobian ...
    pub columns: Columns,
    /// ... and its rows.
    pub equations: Rows,
    /// The spanning tree of pins in whose coordinates it is solved; without one, in the poses of all its bodies.
    pub tree: Option<SpanningTree>,
}

/// How the pose is found.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// Steps in order.
    pub steps: Vec<Step>,
    /// For each step, the block of the decomposition it solves.
    pub blocks: Vec<Block>,
    /// Blocks left to Newton's method.
    pub newton_blocks: Vec<NewtonBlock>,
    /// How many dyads a design prepares constants for.
    pub dyads: usize,
    /// The decomposition it was made from.
    pub decomposition: Decomposition,
}

impl NewtonBlock {
    /// Its tree, if all lanes of a number can be solved at once in the coordinates of that.
    pub fn tree_in_lanes(&self) -> Option<&SpanningTree> {
        (self.tree.as_ref()).filter(|tree| tree.size() <= ON_STACK)
    }
}

impl Plan {
    /// Makes the plan of a mechanism with its drives. Freedoms without a drive are left where they are (see
    /// [`Decomposition::undetermined`]): the caller decides whether that is an error.
    pub(crate) fn new(structure: &Structure) -> Self {
        let decomposition = decompose(structure, true);
        let mut plan = Self {
            steps: Vec::new(),
            blocks: Vec::new(),
            newton_blocks: Vec::new(),
            dyads: 0,
            decomposition: decomposition.clone(),
        };
        for &body in &decomposition.idle {
            plan.steps.push(Step::Hold { body });
            plan.blocks.push(Block {
                unknowns: vec![Unknown::Angle(body)],
                rows: vec![],
                surplus: vec![],
            });
        }
        for block in &decomposition.blocks {
            if block.rows.is_empty() {
                continue;
            }
            let step = match recognise(structure, block, plan.dyads) {
                Some(step) => step,
                None => {
                    plan.newton_blocks.push(newton_block(structure, block));
                    Step::Newton {
                        block: plan.newton_blocks.len() - 1,
                    }
                }
            };
            if let Step::Dyad(_) = step.closed() {
                plan.dyads += 1;
            }
            plan.steps.push(step);
            plan.blocks.push(block.clone());
        }
        plan
    }
}

fn newton_block(structure: &Structure, block: &Block) -> NewtonBlock {
    let columns = Columns::new(block.unknowns.iter().copied());
    let rows: Vec<Row> = block.rows.iter().chain(&block.surplus).copied().collect();
    NewtonBlock {
        unknowns: block.unknowns.clone(),
        size: columns.count,
        equations: Rows::new(rows.iter().copied()),
        tree: SpanningTree::new(structure, block, &columns),
        columns,
        rows,
    }
}
