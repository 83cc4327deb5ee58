//! The distance of a pose from a singular one.

use kempe_linear::smallest_singular_value;

use super::Bordered;

impl Bordered {
    /// The smallest singular value of the Jacobian without its parameter column.
    pub fn smallest_singular_value(&mut self) -> f64 {
        self.factor_rest();
        let layout = &self.layout;
        if self
            .diagonal
            .iter()
            .any(|qr| qr.smallest_pivot_ratio() == 0.0)
        {
            return 0.0;
        }
        let at: Vec<usize> = layout
            .blocks
            .iter()
            .scan(0, |sum, b| {
                let first = *sum;
                *sum += b.size;
                Some(first)
            })
            .collect();
        let mut y = vec![0.0; layout.rows];
        smallest_singular_value(layout.unknowns.count, |x| {
            // y = J^-T x, last block first.
            y.fill(0.0);
            for (index, block) in layout.blocks.iter().enumerate().rev() {
                let own = &mut y[block.first..block.first + block.rows];
                own[..block.size].copy_from_slice(&x[at[index]..at[index] + block.size]);
                self.diagonal[index].solve_transposed(own);
                for c in &self.couplings[index] {
                    x[at[c.block as usize] + c.column as usize] -=
                        c.value * y[block.first + c.row as usize];
                }
            }
            // x = J^-1 y, first block first.
            for (index, block) in layout.blocks.iter().enumerate() {
                self.rhs.clear();
                self.rhs
                    .extend_from_slice(&y[block.first..block.first + block.rows]);
                for c in &self.couplings[index] {
                    self.rhs[c.row as usize] -=
                        c.value * x[at[c.block as usize] + c.column as usize];
                }
                self.diagonal[index].solve(&mut self.rhs);
                x[at[index]..at[index] + block.size].copy_from_slice(&self.rhs[..block.size]);
            }
            y.iter().map(|v| v * v).sum::<f64>().sqrt()
        })
    }
}
