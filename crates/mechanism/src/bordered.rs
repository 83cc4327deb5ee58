//! The linear systems of the continuation, solved block by block.
//!
//! With the plan's blocks in order the constraint Jacobian is block lower triangular, so a system costs time in
//! proportion to the mechanism. One block may be singular without harm, the one where a limit or a crossing of
//! branches lies: its unknowns and the path parameter are kept together and solved last, with the border row.

mod block_layout;
mod singular;

use kempe_linear::Qr;

use self::block_layout::BlockLayout;

use crate::Mechanism;
use crate::constraint::{Joint, Situation};
use crate::layout::To;

/// Most entries outside its block that a row of a joint between two bodies has.
const COUPLINGS: usize = 6;

/// An entry of the Jacobian outside the diagonal blocks.
#[derive(Clone, Copy, Debug)]
struct Coupling {
    row: u32,
    /// Block and column of the unknown.
    block: u32,
    column: u32,
    value: f64,
}

/// A bordered system ready to be solved.
#[derive(Clone, Debug)]
pub struct Bordered {
    layout: BlockLayout,
    diagonal: Vec<Qr>,
    /// Entries of the singular candidate's own block, kept unfactored: row-major.
    plain: Vec<Vec<f64>>,
    couplings: Vec<Vec<Coupling>>,
    to_parameter: Vec<f64>,
    residual: Vec<f64>,
    worst: usize,
    /// Whether that block is not factored yet.
    waits: bool,
    last: Qr,
    rest: f64,
    rhs: Vec<f64>,
    /// Every block's unknowns as a constant and a matrix on the kept ones: column 0, then one for each.
    affine: Vec<Vec<f64>>,
    known: Vec<f64>,
    last_rhs: Vec<f64>,
    border: Vec<f64>,
}

impl Bordered {
    /// Storage for a mechanism's systems.
    pub fn new(mechanism: &Mechanism) -> Self {
        let layout = BlockLayout::new(mechanism);
        let count = layout.blocks.len();
        Self {
            diagonal: vec![Qr::default(); count],
            plain: vec![Vec::new(); count],
            couplings: (layout
                .blocks
                .iter()
                .map(|b| Vec::with_capacity(COUPLINGS * b.rows)))
            .collect(),
            to_parameter: vec![0.0; layout.rows],
            residual: vec![0.0; layout.rows],
            worst: 0,
            waits: false,
            last: Qr::default(),
            rest: 0.0,
            rhs: Vec::new(),
            affine: vec![Vec::new(); count],
            known: Vec::new(),
            last_rhs: Vec::new(),
            border: Vec::new(),
            layout,
        }
    }

    /// Fills the scaled Jacobian and residuals at a situation. `rates` are the drives' rates along the scaled path
    /// parameter.
    pub fn fill(
        &mut self,
        mechanism: &Mechanism,
        situation: &Situation<'_, f64>,
        size: f64,
        rates: &[f64],
    ) {
        let layout = &self.layout;
        for (index, block) in layout.blocks.iter().enumerate() {
            let couplings = &mut self.couplings[index];
            let plain = &mut self.plain[index];
            couplings.clear();
            plain.clear();
            plain.resize(block.rows * block.size, 0.0);
            self.to_parameter[block.first..block.first + block.rows].fill(0.0);
            self.residual[block.first..block.first + block.rows].fill(0.0);
            // Lengths count in mechanism sizes, directions and gear angles as they are.
            let unit = |constraint: usize| mechanism.constraints[constraint].0.unit().factor(size);
            let (residual, to_parameter) = (&mut self.residual, &mut self.to_parameter);
            let rows = &block.equations;
            rows.residuals(mechanism, situation, |row, constraint, value| {
                residual[block.first + row] = value * unit(constraint);
            });
            let unknowns = &layout.unknowns;
            rows.scaled_jacobian(unknowns, mechanism, situation, size, |row, to, value| {
                let column = match to {
                    To::Length(column) | To::Angle(column) => column,
                    To::Drive(drive) => {
                        to_parameter[block.first + row] = value * rates[drive.index()];
                        return;
                    }
                };
                let (home, column) = layout.home[column];
                if home as usize == index {
                    plain[row * block.size + column as usize] += value;
                } else if value != 0.0 {
                    // A row that does not feel an unknown says so with a zero.
                    couplings.push(Coupling {
                        row: row as u32,
                        block: home,
                        column,
                        value,
                    });
                }
            });
            if let Some((column, row)) = block.held {
                plain[row * block.size + column] = 1.0;
            }
        }
        self.factor();
    }

    /// Factors the blocks and tells which is nearest to losing rank. Beside blocks that are as regular as can be that is the largest
    /// one: it is factored with the border alone.
    fn factor(&mut self) {
        let sizes = self.layout.blocks.iter().map(|block| block.size);
        // The first of them.
        let largest = sizes.enumerate().rev().max_by_key(|(_, size)| *size);
        let Some((largest, _)) = largest else { return };
        let mut worst = (f64::INFINITY, 0);
        for index in (0..self.layout.blocks.len()).filter(|index| *index != largest) {
            let ratio = self.factor_block(index);
            if ratio < worst.0 {
                worst = (ratio, index);
            }
        }
        self.waits = worst.0 >= 1.0;
        self.worst = largest;
        if !self.waits {
            let ratio = self.factor_block(largest);
            // Of blocks alike the first.
            if ratio > worst.0 || (ratio == worst.0 && worst.1 < largest) {
                self.worst = worst.1;
            }
        }
    }

    /// Factors a block; returns its smallest pivot ratio.
    fn factor_block(&mut self, index: usize) -> f64 {
        let (block, qr) = (&self.layout.blocks[index], &mut self.diagonal[index]);
        qr.reset(block.rows, block.size);
        for row in 0..block.rows {
            for column in 0..block.size {
                qr.add(row, column, self.plain[index][row * block.size + column]);
            }
        }
        qr.factor();
        qr.smallest_pivot_ratio()
    }

    /// Factors the block that [`Bordered::factor`] left.
    fn factor_rest(&mut self) {
        if std::mem::take(&mut self.waits) {
            self.factor_block(self.worst);
        }
    }

    /// The largest scaled residual at the situation last filled.
    pub fn largest_residual(&self) -> f64 {
        let sizes = self.residual.iter().map(|r| r.abs());
        sizes.fold(0.0, |a: f64, b| if b.is_nan() { b } else { a.max(b) })
    }

    /// Solves `[J J_p; border] d = [rhs; border_rhs]`, where `rhs` is the residual or zero, into `d` (in the order of
    /// `z`, the path parameter last).
    pub fn solve(
        &mut self,
        with_residual: bool,
        border: &[f64],
        border_rhs: f64,
        d: &mut Vec<f64>,
    ) {
        let Self {
            layout,
            diagonal,
            plain,
            couplings,
            last,
            rhs,
            affine,
            known,
            last_rhs,
            border: row,
            ..
        } = self;
        let kept = layout.blocks.get(self.worst).map_or(0, |b| b.size);
        let width = kept + 1;
        let kept_rows = layout.blocks.get(self.worst).map_or(0, |b| b.rows);
        last.reset(kept_rows + 1, width);
        refill(last_rhs, kept_rows + 1);
        for (index, block) in layout.blocks.iter().enumerate() {
            refill(known, block.rows * (width + 1));
            for row in 0..block.rows {
                if with_residual {
                    known[row] = self.residual[block.first + row];
                }
                known[width * block.rows + row] = -self.to_parameter[block.first + row];
            }
            for c in &couplings[index] {
                let (home, column) = (c.block as usize, c.column as usize);
                let size = layout.blocks[home].size;
                for k in 0..=width {
                    known[k * block.rows + c.row as usize] -=
                        c.value * affine[home][k * size + column];
                }
            }
            if index == self.worst {
                for row in 0..block.rows {
                    last_rhs[row] = known[row];
                    for column in 0..block.size {
                        last.add(row, column, plain[index][row * block.size + column]);
                    }
                    last.add(row, kept, -known[width * block.rows + row]);
                }
                let own = &mut affine[index];
                refill(own, block.size * (width + 1));
                for column in 0..block.size {
                    own[(column + 1) * block.size + column] = 1.0;
                }
                continue;
            }
            let own = &mut affine[index];
            own.clear();
            for k in 0..=width {
                rhs.clear();
                rhs.extend_from_slice(&known[k * block.rows..(k + 1) * block.rows]);
                if rhs.iter().any(|v| *v != 0.0) {
                    diagonal[index].solve(rhs);
                }
                own.extend_from_slice(&rhs[..block.size]);
            }
        }
        let mut constant = 0.0;
        let p = border.len() - 1;
        refill(row, width);
        for (index, block) in layout.blocks.iter().enumerate() {
            for (column, &z) in layout.columns_in_z[index].iter().enumerate() {
                constant += border[z] * affine[index][column];
                for (k, value) in row.iter_mut().enumerate() {
                    *value += border[z] * affine[index][(k + 1) * block.size + column];
                }
            }
        }
        row[kept] += border[p];
        for (k, value) in row.iter().enumerate() {
            last.add(kept_rows, k, *value);
        }
        last_rhs[kept_rows] = border_rhs - constant;
        last.factor();
        last.solve(last_rhs);
        self.rest = last_rhs[width..].iter().map(|v| v * v).sum::<f64>().sqrt();
        d.clear();
        d.resize(border.len(), 0.0);
        for (index, block) in layout.blocks.iter().enumerate() {
            for (column, &z) in layout.columns_in_z[index].iter().enumerate() {
                let linear: f64 = (0..width)
                    .map(|k| affine[index][(k + 1) * block.size + column] * last_rhs[k])
                    .sum();
                d[z] = affine[index][column] + linear;
            }
        }
        d[p] = last_rhs[kept];
    }

    /// What redundant rows left over of the system last solved in the least-squares sense.
    pub fn rest(&self) -> f64 {
        self.rest
    }

    /// Smallest pivot ratio of the systems last solved: how well the tangent is determined.
    pub fn conditioning(&self) -> f64 {
        let others = self
            .diagonal
            .iter()
            .enumerate()
            .filter(|(index, _)| *index != self.worst);
        others
            .map(|(_, qr)| qr.smallest_pivot_ratio())
            .fold(self.last.smallest_pivot_ratio(), f64::min)
    }
}

/// So many zeros in the same storage.
fn refill(list: &mut Vec<f64>, count: usize) {
    list.clear();
    list.resize(count, 0.0);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::branch::Branch;
    use crate::configuration::Configuration;
    use crate::design::Design;

    /// Two parallelograms on one crank: at zero all their links lie in one line.
    const TWINS: &str = r#"
units = { length = "m", angle = "rad" }
[links]
frame = { A = [0, 0], D = [60, 0], E = [50, 0] }
crank = { A-B = 30, F = [20, 0] }
c1 = { B-C = 60 }
r1 = { D-C = 30 }
c2 = { F-G = 50 }
r2 = { E-G = 20 }
[drives]
motor = { turns = "crank", from = 0.3, to = 1, speed = "1 rad/s" }
"#;

    /// Where two blocks are nearly singular at once, one border cannot keep the system regular: digits are lost to its
    /// condition, and going block by block loses no more.
    #[test]
    fn with_two_nearly_singular_blocks_no_more_is_lost_than_the_condition_takes() {
        let model = kempe_model::Model::from_toml(TWINS, "twins", &mut |_| Err(String::new()));
        let mechanism = Mechanism::new(&model.unwrap().model);
        let design = Design::new(&mechanism, &[]);
        let size = design.geometry.size(&mechanism);
        for back in [1e-2, 1e-4, 1e-6, 1e-8, 1e-10] {
            let mut state: Configuration<f64> = Configuration::new(&mechanism);
            state.set_inputs(&mechanism, &[back]);
            let mut branch = Branch::neutral(&mechanism);
            for sign in &mut branch.signs {
                *sign = -1.0;
            }
            design.solve(&branch, &mut state);
            for link in 1..mechanism.bodies {
                // Cranks and rockers stand like the crank, couplers like the frame.
                let angle = if link == 2 || link == 4 { 0.0 } else { back };
                let pose = &mut state.poses[link];
                *pose = crate::pose::Pose::from_angle(pose.x, pose.y, angle);
            }
            let mut system = Bordered::new(&mechanism);
            system.fill(&mechanism, &state.situation(&design, &branch), size, &[1.0]);
            let unknowns = 3 * (mechanism.bodies - 1) + 1;
            // A border that leaves the tangent well determined: the first dyad's travel.
            let border: Vec<f64> = (0..unknowns).map(|k| 1.0 + 0.1 * k as f64).collect();
            let mut d = Vec::new();
            system.solve(false, &border, 1.0, &mut d);
            // The same system without blocks.
            let mut whole = Qr::default();
            whole.reset(unknowns, unknowns);
            for (index, block) in system.layout.blocks.iter().enumerate() {
                for row in 0..block.rows {
                    let at = block.first + row;
                    for column in 0..block.size {
                        let value = system.plain[index][row * block.size + column];
                        whole.add(at, system.layout.columns_in_z[index][column], value);
                    }
                    for c in system.couplings[index]
                        .iter()
                        .filter(|c| c.row as usize == row)
                    {
                        let column =
                            system.layout.columns_in_z[c.block as usize][c.column as usize];
                        whole.add(at, column, c.value);
                    }
                    whole.add(at, unknowns - 1, system.to_parameter[at]);
                }
            }
            for (column, value) in border.iter().enumerate() {
                whole.add(unknowns - 1, column, *value);
            }
            whole.factor();
            let mut e = vec![0.0; unknowns];
            e[unknowns - 1] = 1.0;
            whole.solve(&mut e);
            let length = e.iter().map(|x| x * x).sum::<f64>().sqrt();
            let gap = e
                .iter()
                .zip(&d)
                .map(|(a, b)| (a - b) * (a - b))
                .sum::<f64>()
                .sqrt();
            let inherent = f64::EPSILON / system.conditioning();
            assert!(
                gap <= 20.0 * inherent * length,
                "{back:e}: {:e}",
                gap / length
            );
        }
    }
}
