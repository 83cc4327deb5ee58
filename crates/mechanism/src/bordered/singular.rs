//! The distance of a pose from a singular one.

use super::Bordered;

impl Bordered {
    /// The smallest singular value of the Jacobian without its parameter column, by inverse iteration.
    pub fn smallest_singular_value(&mut self) -> f64 {
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
        // Uneven entries, so that no singular vector is missed by symmetry.
        let mut x: Vec<f64> = (0..layout.columns)
            .map(|i| 1.0 + 0.37 * ((i * 7) % 11) as f64)
            .collect();
        let mut value = f64::INFINITY;
        for _ in 0..60 {
            let length = x.iter().map(|v| v * v).sum::<f64>().sqrt();
            x.iter_mut().for_each(|v| *v /= length);
            // y = J^-T x, last block first.
            let mut y: Vec<f64> = vec![0.0; layout.rows];
            for (index, block) in layout.blocks.iter().enumerate().rev() {
                let own = &mut y[block.first..block.first + block.rows];
                own[..block.size].copy_from_slice(&x[at[index]..at[index] + block.size]);
                self.diagonal[index].solve_transposed(own);
                for c in &self.couplings[index] {
                    x[at[c.block as usize] + c.column as usize] -=
                        c.value * y[block.first + c.row as usize];
                }
            }
            let next = 1.0 / y.iter().map(|v| v * v).sum::<f64>().sqrt();
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
            let settled = (next - value).abs() <= 1e-9 * next;
            value = next;
            if settled || !value.is_finite() {
                break;
            }
        }
        value
    }
}
