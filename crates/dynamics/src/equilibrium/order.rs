//! The order in which the equations of equilibrium are solved: block by block, the last group of links first.

use kempe_mechanism::layout::{Columns, Rows, rows_of, unknowns_of};
use kempe_mechanism::{BodyId, Mechanism};

/// Where every row and every column of J stands in the matrix that is factored.
///
/// Multipliers follow from the last block of the motion's plan to the first: nothing hangs on the last. In that order the
/// matrix is block triangular, and its factors keep its zeros.
#[derive(Clone, Debug)]
pub(crate) struct Order {
    /// Place of every row.
    pub rows: Vec<usize>,
    /// Place of every column: x, y and angle of the bodies but the frame.
    pub columns: Vec<usize>,
}

impl Order {
    /// The order for constraints whose rows start at `first_row`, with `rows` rows in all: those after the constraints' hold
    /// idle bodies and come last.
    pub fn new(mechanism: &Mechanism, first_row: &[usize], rows: usize) -> Self {
        let blocks = || mechanism.plan.decomposition.blocks.iter().rev();
        let in_blocks = blocks().flat_map(|block| block.rows.iter().chain(&block.surplus));
        let all = rows_of(mechanism, mechanism.constraints.len());
        let order = Rows::new(in_blocks.copied().chain(all));
        let mut places: Vec<usize> = (0..rows).collect();
        for (constraint, at) in &order.by_constraint {
            for (part, place) in at.iter().enumerate() {
                if let Some(place) = place {
                    places[first_row[*constraint] + part] = *place;
                }
            }
        }
        let in_blocks = blocks().flat_map(|block| block.unknowns.iter().copied());
        let order = Columns::new(in_blocks.chain(unknowns_of(mechanism)));
        let bodies = (1..mechanism.bodies).map(|index| BodyId(index as u32));
        Self {
            rows: places,
            columns: bodies.flat_map(|body| order.of(body)).flatten().collect(),
        }
    }
}
