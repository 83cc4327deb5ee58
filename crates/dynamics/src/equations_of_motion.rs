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
use crate::energy;
use crate::forces::Forces;
use crate::instant::Instant;
use crate::joint_contact;
use crate::number::{ForceNumber, PlainNumber};
use crate::vector::{add, dot, left, times};
use crate::virtual_power;
use crate::wrench::Wrench;

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
fn factorize<T: ForceNumber>(n: usize, l: &mut [T]) -> bool {
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

/// Coordinates that are let go at an instant: their mass matrix, factorized, and what accelerates them. Storage is reused.
#[derive(Clone, Debug, Default)]
pub struct LetGo {
    factors: Vec<f64>,
    /// Accelerations of the coordinates let go, in their order.
    pub accelerations: Vec<f64>,
    change: Vec<f64>,
    moved: Vec<([f64; 2], f64)>,
}

impl LetGo {
    /// The accelerations that generalised forces (N or N m) along the coordinates alone would give, in place.
    pub fn respond(&self, forces: &mut [f64]) {
        solve_positive(forces.len(), &self.factors, forces);
    }

    /// Fills the factors of the mass matrix of these coordinates.
    fn factorize(&mut self, acting: &Acting<f64>, at: &Instant<f64>, free: &[DriveId]) -> bool {
        let n = free.len();
        self.factors.clear();
        self.factors.resize(n * n, 0.0);
        for mass in &acting.masses {
            let arm = mass.arm(at);
            self.moved.clear();
            self.moved.extend(free.iter().map(|drive| {
                let k = at.coefficients[drive.index()][mass.body.index()];
                (add([k[0], k[1]], times(left(arm), k[2])), k[2])
            }));
            for (row, (v, w)) in self.moved.iter().enumerate() {
                for (column, (u, z)) in self.moved.iter().enumerate().take(row + 1) {
                    self.factors[row * n + column] += dot(*v, *u) * mass.mass + w * z * mass.moment;
                }
            }
        }
        factorize(n, &mut self.factors)
    }
}

/// Corrections of accelerations for friction, at most: each is a small part of the one before.
const CORRECTIONS: usize = 200;
/// A correction below this part of the acceleration is rounding.
const SETTLED: f64 = 4.0 * f64::EPSILON;
/// Corrections below this part of the acceleration without friction are settled where they get no smaller.
const NEARLY: f64 = 1e-10;
/// Where nothing would accelerate without friction, 1/s^2 or m/s^2.
const SLIGHT: f64 = 1e-9;

/// The largest of some numbers, without its sign; NaN where one is.
fn size_of(numbers: &[f64]) -> f64 {
    let larger = |most: f64, x: &f64| if x.abs() <= most { most } else { x.abs() };
    numbers.iter().fold(0.0, larger)
}

impl Forces<f64> {
    /// How coordinates that are let go accelerate where these forces (N or N m) act along them, friction included. `at` holds
    /// the state, with the coordinates let go not accelerating; it accelerates with them when this is done. Allocates nothing
    /// once warm. False where they move no mass, where friction jams, or where it has no one answer.
    pub fn let_go(
        &mut self,
        at: &mut Instant<f64>,
        free: &[DriveId],
        given: &[f64],
        found: &mut LetGo,
    ) -> bool {
        self.take_up(at);
        if !found.factorize(&self.acting, at, free) {
            return false;
        }
        let needed = |it: &Self, drive: &DriveId| {
            virtual_power::project(&it.needed, &at.coefficients[drive.index()]).value
        };
        found.accelerations.clear();
        let forces = free.iter().zip(given);
        (found.accelerations).extend(forces.map(|(drive, given)| given - needed(self, drive)));
        solve_positive(free.len(), &found.factors, &mut found.accelerations);
        for (drive, acceleration) in free.iter().zip(&found.accelerations) {
            at.accelerate(*drive, *acceleration);
        }
        if self.acting.friction.is_empty() {
            return found.accelerations.iter().all(|a| a.is_finite());
        }
        let first = size_of(&found.accelerations).max(SLIGHT);
        let mut before = f64::INFINITY;
        for _ in 0..CORRECTIONS {
            self.solve(at);
            found.change.clear();
            let forces = free.iter().zip(given);
            (found.change)
                .extend(forces.map(|(drive, given)| given - self.drives[drive.index()].value));
            solve_positive(free.len(), &found.factors, &mut found.change);
            for (k, drive) in free.iter().enumerate() {
                at.accelerate(*drive, found.change[k]);
                found.accelerations[k] += found.change[k];
            }
            let change = size_of(&found.change);
            // Where terms cancel, rounding is more than a small part of what is left: then nothing gets smaller any more.
            let rounds = change <= NEARLY * first && change > 0.5 * before;
            let settled = rounds || change <= SETTLED * size_of(&found.accelerations);
            before = change;
            if !found.accelerations.iter().all(|a| a.is_finite()) {
                return false;
            }
            if settled {
                return true;
            }
        }
        false
    }
}

impl Forces<f64> {
    /// The momentum along the coordinates `of` that jumps in the speeds of the drives `by` carry, N s or N m s.
    pub fn carried(
        &self,
        at: &Instant<f64>,
        of: &[DriveId],
        by: &[DriveId],
        jumps: &[f64],
    ) -> Vec<f64> {
        let mut sums = vec![0.0; of.len()];
        for mass in &self.acting.masses {
            let arm = mass.arm(at);
            let moved = |drive: &DriveId| {
                let k = at.coefficients[drive.index()][mass.body.index()];
                (add([k[0], k[1]], times(left(arm), k[2])), k[2])
            };
            for (drive, jump) in by.iter().zip(jumps) {
                let (v, w) = moved(drive);
                for (sum, drive) in sums.iter_mut().zip(of) {
                    let (u, z) = moved(drive);
                    *sum += jump * (dot(v, u) * mass.mass + w * z * mass.moment);
                }
            }
        }
        sums
    }

    /// What a drive that keeps its law gives at an instant after [`Forces::let_go`], N or N m.
    pub fn given_by(&mut self, at: &Instant<f64>, drive: DriveId) -> f64 {
        if self.acting.friction.is_empty() {
            self.take_up(at);
            return virtual_power::project(&self.needed, &at.coefficients[drive.index()]).value;
        }
        self.drives[drive.index()].value
    }

    /// The power, W, that loads, motors of drives that hold nothing, dampers, contacts and, after [`Forces::let_go`], friction give to the mechanism. `storage` has a place
    /// for every link.
    pub fn power_from_outside(&self, at: &Instant<f64>, storage: &mut [Wrench<f64>]) -> f64 {
        let rubs = match self.acting.friction.is_empty() {
            true => 0.0,
            false => self.equilibrium.friction_power(&self.acting.friction),
        };
        rubs + energy::of_loads(&self.acting, &self.design, at, storage)
            + energy::of_motors(&self.acting, at)
            + joint_contact::power(&self.acting.contacts, at)
            - energy::dissipation(&self.acting, &self.design.geometry, at)
    }
}

/// The mass matrix of a state by rows.
pub fn mass_matrix<T: ForceNumber>(acting: &Acting<T>, at: &Instant<T>) -> Vec<T> {
    let size = at.coefficients.len();
    let mut matrix = vec![T::zero(); size * size];
    let mut moved: Vec<([T; 2], T)> = Vec::with_capacity(size);
    for mass in &acting.masses {
        let arm = mass.arm(at);
        moved.clear();
        moved.extend(at.coefficients.iter().map(|drive| {
            let k = drive[mass.body.index()];
            (add([k[0], k[1]], times(left(arm), k[2])), k[2])
        }));
        for (row, (v, w)) in moved.iter().enumerate() {
            for (column, (u, z)) in moved.iter().enumerate() {
                matrix[row * size + column] += dot(*v, *u) * mass.mass + *w * *z * mass.moment;
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
