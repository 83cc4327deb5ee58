//! Which rows and unknowns belong to which block of the linear systems.

use crate::Mechanism;
use crate::blocks::{Row, Unknown};
use crate::layout::{Columns, Rows};

/// One block of the layout.
#[derive(Clone, Debug)]
pub(super) struct Block {
    /// First row (and column, where the system is square) in the whole system.
    pub first: usize,
    /// How many columns.
    pub size: usize,
    /// How many rows; more than columns in an overconstrained block.
    pub rows: usize,
    /// Which rows.
    pub equations: Rows,
    /// Idle angles held here: (column, row).
    pub held: Option<(usize, usize)>,
}

/// Which rows and unknowns belong to which block.
#[derive(Clone, Debug)]
pub struct BlockLayout {
    pub(super) blocks: Vec<Block>,
    /// The unknowns of all blocks, one after the other.
    pub(super) unknowns: Columns,
    /// Block of every column, and column in it.
    pub(super) home: Vec<(u32, u32)>,
    /// Column of every block's unknowns among the scaled unknowns of a trace, block after block.
    pub(super) columns_in_z: Vec<Vec<usize>>,
    pub(super) rows: usize,
}

impl BlockLayout {
    /// The blocks of a plan. An overconstrained mechanism is one block: what is redundant in one place keeps another
    /// regular.
    pub fn new(mechanism: &Mechanism) -> Self {
        let plan = &mechanism.plan;
        let mut blocks: Vec<(Vec<Unknown>, Vec<Row>)> = plan
            .blocks
            .iter()
            .map(|b| (b.unknowns.clone(), b.rows.clone()))
            .collect();
        if !plan.decomposition.surplus.is_empty() {
            let unknowns = blocks.iter().flat_map(|(u, _)| u.iter().copied()).collect();
            let mut rows: Vec<Row> = blocks.iter().flat_map(|(_, r)| r.iter().copied()).collect();
            rows.extend(&plan.decomposition.surplus);
            blocks = vec![(unknowns, rows)];
        }
        let mut it = Self {
            blocks: Vec::with_capacity(blocks.len()),
            unknowns: Columns::default(),
            home: Vec::new(),
            columns_in_z: Vec::with_capacity(blocks.len()),
            rows: 0,
        };
        it.unknowns = Columns::new(blocks.iter().flat_map(|(u, _)| u.iter().copied()));
        for (index, (unknowns, rows)) in blocks.into_iter().enumerate() {
            let mut columns = Vec::new();
            let mut idle = None;
            for unknown in &unknowns {
                let size = columns.len();
                let z = 3 * (unknown.body().index() - 1);
                match unknown {
                    Unknown::Angle(body) => {
                        columns.push(z + 2);
                        if plan.decomposition.idle.contains(body) {
                            idle = Some(size);
                        }
                    }
                    Unknown::Place(_) => columns.extend([z, z + 1]),
                }
            }
            let size = columns.len();
            (it.home).extend((0..size).map(|column| (index as u32, column as u32)));
            let height = rows.len() + usize::from(idle.is_some());
            let held = idle.map(|column| (column, rows.len()));
            it.blocks.push(Block {
                first: it.rows,
                size,
                rows: height.max(size),
                equations: Rows::new(rows),
                held,
            });
            it.rows += height.max(size);
            it.columns_in_z.push(columns);
        }
        it
    }
}
