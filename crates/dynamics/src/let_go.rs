//! Drives that are let go: how they accelerate, what jumps of their speeds carry, what is given from outside meanwhile.
//!
//! A drive that is let go gives nothing but what acts along it. Its acceleration is the one with which inverse dynamics, friction included,
//! asks of it just that.

use kempe_linear::{Anderson, solve_positive};
use kempe_model::DriveId;

use crate::acting::Acting;
use crate::energy;
use crate::equations_of_motion::factorize;
use crate::equilibrium::Rubbing;
use crate::forces::Forces;
use crate::inertia::Moved;
use crate::instant::Instant;
use crate::virtual_power;
use crate::wrench::{self, Wrench};

/// Coordinates that are let go at an instant: their mass matrix, factorized, and what accelerates them. Storage is reused.
#[derive(Clone, Debug, Default)]
pub struct LetGo {
    factors: Vec<f64>,
    /// Accelerations of the coordinates let go, in their order.
    pub accelerations: Vec<f64>,
    change: Vec<f64>,
    moved: Vec<Moved<f64>>,
    /// Where ties hold the coordinates: the directions in which they go all the same, and how these move the bodies. The mass matrix is
    /// that of these directions.
    ways: Option<Ways>,
    /// Whether all forces were found as it accelerates: [`Forces::left_by_friction`].
    solved: bool,
    /// What the terms of those forces would give along each coordinate, all in one sense: rounding of accelerations is to be counted in this.
    by_terms: Vec<f64>,
}

/// Directions in which coordinates go that ties hold.
#[derive(Clone, Debug, Default)]
struct Ways {
    /// The accelerations that the ties ask for.
    asked: Vec<f64>,
    /// By direction: how fast every coordinate goes.
    directions: Vec<Vec<f64>>,
    /// By direction: how every body moves.
    coefficients: Vec<Vec<[f64; 3]>>,
}

impl Ways {
    fn new(asked: &[f64], directions: &[Vec<f64>], at: &Instant<f64>, free: &[DriveId]) -> Self {
        let bodies = at.poses.len();
        let moved = |direction: &Vec<f64>| {
            let mut sum = vec![[0.0; 3]; bodies];
            for (drive, part) in free.iter().zip(direction) {
                for (sum, k) in sum.iter_mut().zip(&at.coefficients[drive.index()]) {
                    *sum = std::array::from_fn(|i| sum[i] + part * k[i]);
                }
            }
            sum
        };
        Self {
            asked: asked.to_vec(),
            directions: directions.to_vec(),
            coefficients: directions.iter().map(moved).collect(),
        }
    }

    /// What forces along the coordinates come to along the directions.
    fn along(&self, forces: &[f64]) -> Vec<f64> {
        let dot = |way: &Vec<f64>| way.iter().zip(forces).map(|(x, y)| x * y).sum();
        self.directions.iter().map(dot).collect()
    }

    /// How the coordinates go where the directions do so, into `out`.
    fn together(&self, parts: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        for (direction, part) in self.directions.iter().zip(parts) {
            for (out, x) in out.iter_mut().zip(direction) {
                *out += part * x;
            }
        }
    }
}

impl LetGo {
    /// The accelerations that generalised forces (N or N m) along the coordinates alone would give, in place.
    pub fn respond(&self, forces: &mut [f64]) {
        let Some(ways) = &self.ways else {
            return solve_positive(forces.len(), &self.factors, forces);
        };
        let mut parts = ways.along(forces);
        solve_positive(parts.len(), &self.factors, &mut parts);
        ways.together(&parts, forces);
    }

    /// Changes rows of derivatives to the coordinates, so that the product of two is what masses yield along one to a unit of force along
    /// the other.
    pub fn halve(&self, row: &mut [f64]) {
        if let Some(ways) = &self.ways {
            let parts = ways.along(row);
            row.fill(0.0);
            row[..parts.len()].copy_from_slice(&parts);
            return self.halve_all(&mut row[..parts.len()]);
        }
        self.halve_all(row);
    }

    fn halve_all(&self, row: &mut [f64]) {
        let n = row.len();
        for i in 0..n {
            for k in 0..i {
                row[i] -= self.factors[i * n + k] * row[k];
            }
        }
        for (i, x) in row.iter_mut().enumerate() {
            *x /= self.factors[i * n + i].sqrt();
        }
    }

    /// The root of what masses make of the squares of the accelerations, as rows are seen that are halved.
    pub fn acceleration(&self) -> f64 {
        let n = self.accelerations.len();
        let part = |i: usize| -> f64 {
            let rows = self.accelerations.iter().enumerate().skip(i);
            rows.map(|(k, a)| self.factors[k * n + i] * a).sum()
        };
        (0..n).map(|i| part(i) * part(i)).sum::<f64>().sqrt()
    }

    /// What is left of forces given along the coordinates, N or N m, where they accelerate so far: [`Forces::left_by_friction`].
    pub fn left(&self) -> &[f64] {
        &self.change
    }

    /// How the terms of what was left last would accelerate the coordinates, all in one sense: where they hold the balance, rounding of
    /// accelerations is to be counted in this.
    pub fn by_terms(&self) -> &[f64] {
        &self.by_terms
    }

    /// Lets the coordinates accelerate by so much more.
    pub fn accelerate(&mut self, at: &mut Instant<f64>, free: &[DriveId], more: &[f64]) {
        let all = free.iter().zip(&mut self.accelerations).zip(more);
        for ((drive, acceleration), more) in all {
            at.accelerate(*drive, *more);
            *acceleration += more;
        }
    }

    /// Fills the factors of the mass matrix of coordinates by which bodies move like this.
    fn factorize<'c>(
        &mut self,
        acting: &Acting<f64>,
        at: &Instant<f64>,
        ways: impl ExactSizeIterator<Item = &'c Vec<[f64; 3]>> + Clone,
    ) -> Result<(), NotLetGo> {
        let n = ways.len();
        self.factors.clear();
        self.factors.resize(n * n, 0.0);
        for mass in &acting.masses {
            let arm = mass.arm(at);
            self.moved.clear();
            let by = |coefficients: &'c Vec<[f64; 3]>| mass.moved(arm, coefficients);
            self.moved.extend(ways.clone().map(by));
            for (row, one) in self.moved.iter().enumerate() {
                for (column, other) in self.moved.iter().enumerate().take(row + 1) {
                    self.factors[row * n + column] += mass.coupling(one, other);
                }
            }
        }
        if !self.factors.iter().all(|m| m.is_finite()) {
            return Err(NotLetGo::Singular);
        }
        match factorize(n, &mut self.factors) {
            true => Ok(()),
            false => Err(NotLetGo::NoMass),
        }
    }
}

/// Why nothing is known of how coordinates that are let go accelerate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotLetGo {
    /// It stands at a dead point of one of them, along which links move without bound.
    Singular,
    /// They move no mass.
    NoMass,
    /// Friction jams them, or has no one answer.
    Friction,
    /// A force is infinite, or no number.
    NotFinite,
}

/// Corrections of accelerations for friction, at most: each is a small part of the one before, as a rule.
const CORRECTIONS: usize = 200;
/// After so many corrections they come nearer too slowly by themselves.
pub const SLOW: usize = 12;
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
    /// once warm.
    ///
    /// # Errors
    /// Why they are not known.
    pub fn let_go(
        &mut self,
        at: &mut Instant<f64>,
        free: &[DriveId],
        given: &[f64],
        found: &mut LetGo,
    ) -> Result<(), NotLetGo> {
        self.let_go_smoothly(at, free, given, found)?;
        if self.acting.friction.is_empty() {
            return Ok(());
        }
        let mut first = size_of(&found.accelerations).max(SLIGHT);
        let mut before = f64::INFINITY;
        let mut mixing = Anderson::default();
        for correction in 0..CORRECTIONS {
            self.left_by_friction(at, free, given, found);
            first = first.max(size_of(&found.by_terms));
            solve_positive(free.len(), &found.factors, &mut found.change);
            let mut more = std::mem::take(&mut found.change);
            if correction >= SLOW {
                more = mixing.step(&found.accelerations, &more);
            }
            found.accelerate(at, free, &more);
            found.change = more;
            let change = size_of(&found.change);
            // Where terms cancel, rounding is more than a small part of what is left: then nothing gets smaller any more.
            let rounds = change <= NEARLY * first && change > 0.5 * before;
            let settled = rounds || change <= SETTLED * size_of(&found.accelerations);
            before = change;
            if !found.accelerations.iter().all(|a| a.is_finite()) {
                break;
            }
            if settled {
                return Ok(());
            }
        }
        Err(NotLetGo::Friction)
    }

    /// The same with friction left out, from which its own is found.
    ///
    /// # Errors
    /// Where they move no mass, or what acts is not finite.
    pub fn let_go_smoothly(
        &mut self,
        at: &mut Instant<f64>,
        free: &[DriveId],
        given: &[f64],
        found: &mut LetGo,
    ) -> Result<(), NotLetGo> {
        self.take_up(at);
        found.solved = false;
        found.ways = None;
        let ways = free.iter().map(|drive| &at.coefficients[drive.index()]);
        found.factorize(&self.acting, at, ways)?;
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
        match found.accelerations.iter().all(|a| a.is_finite()) {
            true => Ok(()),
            false => Err(NotLetGo::NotFinite),
        }
    }

    /// How coordinates accelerate that ties hold, too: as the ties ask for, and beyond that in those `directions` alone that they leave, of
    /// which each is how fast every coordinate goes. Friction is left out.
    ///
    /// # Errors
    /// Where they move no mass, or what acts is not finite.
    pub fn let_go_tied(
        &mut self,
        at: &mut Instant<f64>,
        free: &[DriveId],
        given: &[f64],
        (asked, directions): (&[f64], &[Vec<f64>]),
        found: &mut LetGo,
    ) -> Result<(), NotLetGo> {
        found.accelerations.clear();
        found.accelerations.resize(free.len(), 0.0);
        found.accelerate(at, free, asked);
        self.take_up(at);
        found.solved = false;
        let ways = Ways::new(asked, directions, at, free);
        found.factorize(&self.acting, at, ways.coefficients.iter())?;
        let needed =
            |coefficients: &Vec<[f64; 3]>| virtual_power::project(&self.needed, coefficients).value;
        let given = ways.along(given);
        let forces = given.iter().zip(&ways.coefficients);
        let mut parts: Vec<f64> = forces.map(|(given, k)| given - needed(k)).collect();
        solve_positive(parts.len(), &found.factors, &mut parts);
        let mut more = vec![0.0; free.len()];
        ways.together(&parts, &mut more);
        found.ways = Some(ways);
        found.accelerate(at, free, &more);
        match found.accelerations.iter().all(|a| a.is_finite()) {
            true => Ok(()),
            false => Err(NotLetGo::NotFinite),
        }
    }

    /// Finds all forces where it accelerates as it was found to, and what of those given is left: see [`LetGo::left`].
    pub fn left_by_friction(
        &mut self,
        at: &Instant<f64>,
        free: &[DriveId],
        given: &[f64],
        found: &mut LetGo,
    ) {
        self.solve(at);
        found.solved = true;
        found.change.clear();
        let forces = free.iter().zip(given);
        (found.change)
            .extend(forces.map(|(drive, given)| given - self.drives[drive.index()].value));
        found.by_terms.clear();
        let forces = free.iter().zip(given);
        (found.by_terms).extend(
            forces.map(|(drive, given)| given.abs() + self.drives[drive.index()].by_power.scale),
        );
        solve_positive(free.len(), &found.factors, &mut found.by_terms);
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
            let moved = |drive: &DriveId| mass.moved(arm, &at.coefficients[drive.index()]);
            for (drive, jump) in by.iter().zip(jumps) {
                let one = moved(drive);
                for (sum, drive) in sums.iter_mut().zip(of) {
                    *sum += jump * mass.coupling(&one, &moved(drive));
                }
            }
        }
        sums
    }

    /// What a drive that keeps its law gives at an instant after [`Forces::let_go`] of the coordinates `free`, N or N m.
    pub fn given_by(
        &self,
        at: &Instant<f64>,
        drive: DriveId,
        free: &[DriveId],
        found: &LetGo,
    ) -> f64 {
        if found.solved {
            return self.drives[drive.index()].value;
        }
        // What the bodies needed while nothing that is let go accelerated, and what that carries.
        let needed = virtual_power::project(&self.needed, &at.coefficients[drive.index()]).value;
        let beyond: Vec<f64>;
        let accelerations = match &found.ways {
            None => &found.accelerations,
            // They needed it while all accelerated as ties ask for.
            Some(ways) => {
                let all = found.accelerations.iter().zip(&ways.asked);
                beyond = all.map(|(a, asked)| a - asked).collect();
                &beyond
            }
        };
        (self.acting.masses.iter()).fold(needed, |sum, mass| {
            let arm = mass.arm(at);
            let moved = |drive: &DriveId| mass.moved(arm, &at.coefficients[drive.index()]);
            let own = moved(&drive);
            let by = free.iter().zip(accelerations);
            by.fold(sum, |sum, (other, a)| {
                sum + a * mass.coupling(&own, &moved(other))
            })
        })
    }

    /// How the joints that rub slide at an instant; loads are those last found.
    pub fn sliding(&mut self, at: &Instant<f64>) -> Vec<Rubbing<f64>> {
        let design = &self.design;
        (self.equilibrium).find_contacts(
            &design.mechanism,
            &design.geometry,
            &self.acting.friction,
            at,
        );
        self.equilibrium.rubbing(&self.acting.friction).collect()
    }

    /// The power, W, that loads, motors of drives that hold nothing, dampers, contacts and, after [`Forces::let_go`], friction give to the mechanism. `storage` has a place
    /// for every link.
    pub fn power_from_outside(&self, at: &Instant<f64>, storage: &mut [Wrench<f64>]) -> f64 {
        let rubs = match self.acting.friction.is_empty() {
            true => 0.0,
            false => self.equilibrium.friction_power(&self.acting.friction),
        };
        let contacts = self.by_contacts.iter().zip(&at.velocities);
        let by_contacts: f64 = contacts.map(|(w, v)| wrench::power(*w, *v)).sum();
        let by_loads = match self.acting.loads.is_empty() {
            true => 0.0,
            false => energy::of_loads(&self.acting, &self.design, at, storage),
        };
        rubs + by_loads + energy::of_motors(&self.acting, at) + by_contacts
            - energy::dissipation(&self.acting, &self.design.geometry, at)
    }
}
