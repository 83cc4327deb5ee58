//! The equations of motion in the coordinates of the drives: `M(q) q" + h(q, q', t) = Q`.
//!
//! Both sides come from the same definitions as inverse dynamics. The mass matrix is that of the kinetic energy,
//! `T = q' M q' / 2`: `M_ij = sum of m dr/dq_i . dr/dq_j + J dtheta/dq_i dtheta/dq_j`. The bias forces `h` are what the
//! drives would have to give if none of them accelerated: centrifugal terms, weights, loads, springs and dampers. `Q` is what
//! the drives give; a drive that is let go gives nothing. (Lagrange; e.g. M. Eksergian, "Dynamical analysis of machines",
//! 1930-31, for one coordinate.) Friction hangs on what joints carry, and that on the accelerations: it is left out of the
//! bias, and [`Forces::let_go`] finds the accelerations with which inverse dynamics, friction included, asks of every drive
//! let go just what it gives.

use kempe_linear::{factor_positive, is_pivot, solve_positive};
use kempe_model::DriveId;
use kempe_number::Number;

use crate::acting::Acting;
use crate::forces::Forces;
use crate::inertia::Moved;
use crate::instant::Instant;
use crate::number::{ForceNumber, PlainNumber};
use crate::virtual_power;

/// The equations of motion of a state.
#[derive(Clone, Debug)]
pub struct EquationsOfMotion<T> {
    /// How many coordinates: one for each drive.
    pub size: usize,
    /// The mass matrix by rows, kg, kg m or kg m^2 as the coordinates of row and column ask.
    pub mass: Vec<T>,
    /// Bias forces, N or N m, along the drives' coordinates.
    pub bias: Vec<T>,
}

impl<T: ForceNumber> EquationsOfMotion<T> {
    /// The mass matrix at a row and a column.
    pub fn mass_at(&self, row: usize, column: usize) -> T {
        self.mass[row * self.size + column]
    }

    /// What the drives must give for these accelerations of their coordinates.
    pub fn needed(&self, accelerations: &[T]) -> Vec<T> {
        let rows = self.mass.chunks_exact(self.size.max(1)).zip(&self.bias);
        rows.map(|(row, bias)| {
            let terms = row.iter().zip(accelerations);
            terms.fold(*bias, |sum, (m, a)| sum + *m * *a)
        })
        .collect()
    }
}

impl<T: ForceNumber> EquationsOfMotion<T> {
    /// The accelerations of all coordinates where those in `free` move as forces make them (N or N m along every
    /// coordinate; only those of free ones count) and all others accelerate as `given`. `None` where the mass of the free
    /// ones is not positive: a coordinate that moves no mass, or a mechanism at a dead point. NaN in lanes where only there it
    /// is not.
    pub fn accelerations(&self, free: &[DriveId], given: &[T], forces: &[T]) -> Option<Vec<T>> {
        let mut accelerations = given.to_vec();
        for drive in free {
            accelerations[drive.index()] = T::zero();
        }
        let held = self.needed(&accelerations);
        let mut right: Vec<T> = (free.iter().map(|d| d.index()))
            .map(|d| forces[d] - held[d])
            .collect();
        let n = free.len();
        let mut l: Vec<T> = (0..n * n)
            .map(|at| self.mass_at(free[at / n].index(), free[at % n].index()))
            .collect();
        if !factorize(n, &mut l) {
            return None;
        }
        solve_positive(n, &l, &mut right);
        for (drive, acceleration) in free.iter().zip(right) {
            accelerations[drive.index()] = acceleration;
        }
        Some(accelerations)
    }
}

/// The factors of the mass matrix of `n` coordinates, in its place. False where one moves no mass that those before it do not move. NaN
/// in lanes where only there it is not.
pub(crate) fn factorize<T: ForceNumber>(n: usize, l: &mut [T]) -> bool {
    let pivot = |mut rest: T, entry: T| {
        let mut moves = false;
        for lane in 0..T::Plain::LANES {
            if is_pivot(rest.value_in(lane), entry.value_in(lane)) {
                moves = true;
            } else {
                rest = rest.with_lane(lane, T::InLane::from_f64(f64::NAN));
            }
        }
        moves.then_some(rest)
    };
    factor_positive(n, l, pivot).is_ok()
}

/// The mass matrix of a state by rows.
pub fn mass_matrix<T: ForceNumber>(acting: &Acting<T>, at: &Instant<T>) -> Vec<T> {
    let size = at.coefficients.len();
    let mut matrix = vec![T::zero(); size * size];
    let mut moved: Vec<Moved<T>> = Vec::with_capacity(size);
    for mass in &acting.masses {
        let arm = mass.arm(at);
        moved.clear();
        moved.extend((at.coefficients.iter()).map(|drive| mass.moved(arm, drive)));
        for (row, one) in moved.iter().enumerate() {
            for (column, other) in moved.iter().enumerate() {
                matrix[row * size + column] += mass.coupling(one, other);
            }
        }
    }
    matrix
}

impl<T: ForceNumber> Forces<T> {
    /// The equations of motion of the state last solved.
    pub fn equations_of_motion(&self, at: &Instant<T>) -> EquationsOfMotion<T> {
        let mass = mass_matrix(&self.acting, at);
        let size = at.coefficients.len();
        let needed = self.needed_without_friction();
        let bias = (at.coefficients.iter().enumerate())
            .map(|(row, drive)| {
                let inertia = mass[row * size..][..size].iter();
                inertia.zip(&at.drive_accelerations).fold(
                    virtual_power::project(&needed, drive).value,
                    |sum, (m, a)| sum - *m * *a,
                )
            })
            .collect();
        EquationsOfMotion { size, mass, bias }
    }
}
