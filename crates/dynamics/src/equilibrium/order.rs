//! The order in which the equations of equilibrium are solved: block by block, the last group of links first.

use kempe_mechanism::Mechanism;
use kempe_mechanism::blocks::Unknown;

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
    /// The order for constraints whose rows start at `first_row`, with `rows` rows in all.
    pub fn new(mechanism: &Mechanism, first_row: &[usize], rows: usize) -> Self {
        let plan = &mechanism.plan;
        let parts = &plan.decomposition;
        let (mut row_list, mut column_list) = (Vec::new(), Vec::new());
        for block in parts.blocks.iter().rev() {
            let own = block.rows.iter().chain(&block.surplus);
            row_list.extend(own.map(|r| first_row[r.constraint] + r.row));
            for unknown in &block.unknowns {
                let first = 3 * (unknown.body().index() - 1);
                match unknown {
                    Unknown::Place(_) => column_list.extend([first, first + 1]),
                    Unknown::Angle(_) => column_list.push(first + 2),
                }
            }
        }
        Self {
            rows: places(row_list, rows),
            columns: places(column_list, 3 * (mechanism.bodies - 1)),
        }
    }
}

/// Places by index, from indices in their order; what the list leaves out comes last.
fn places(list: Vec<usize>, count: usize) -> Vec<usize> {
    let mut places = vec![usize::MAX; count];
    let mut next = 0;
    for index in list.into_iter().chain(0..count) {
        if let Some(place) = places.get_mut(index)
            && *place == usize::MAX
        {
            *place = next;
            next += 1;
        }
    }
    places
}
