//! Newton and Euler: the equilibrium of every body, solved for the multipliers of all joints and drives at once.
//!
//! `m a - applied = J^T lambda + friction(lambda)`, with J the gradients of the joints' and drives' residuals
//! (d'Alembert, Lagrange). By the scaling of those residuals the multipliers are: of a pin the force on the later body,
//! of a point on a line the normal force along the line's left normal on the point, of a direction the torque on its
//! first body, of a cylinder's length the push on its eye, of a travel the push along the guide, of a rack and of gears
//! with known pins the tooth force.
//!
//! With more rows than unknowns the loads of some joints are not determined by equilibrium; the shortest solution is
//! given (moments counted over the mechanism's size) and those joints are named.

mod friction;
mod order;

use kempe_linear::Qr;
use kempe_mechanism::constraint::{Gradient, Joint, Situation};
use kempe_mechanism::{BodyId, Geometry, Mechanism};

pub use self::friction::{FRICTION_STEP, FRICTION_STEPS, FrictionOutcome, Pace, STILL, UNMOVED};
use self::friction::{FrictionContact, load_of, resistance};
use self::order::Order;
use crate::friction::Friction;
use crate::instant::Instant;
use crate::number::ForceNumber;
use crate::wrench::Wrench;

/// Smallest over largest pivot below which a pose counts as singular: joint loads are not defined there.
pub const SINGULAR: f64 = 1e-12;
/// A joint's part in a direction of undetermined loads above which its load is not unique.
pub const UNIQUE: f64 = 1e-9;
/// One entry of J: derivatives of a row to a body's x, y and angle.
#[derive(Clone, Copy, Debug)]
struct Entry<T> {
    row: usize,
    body: BodyId,
    to: [T; 3],
}

/// The equilibrium of a mechanism, with storage that is reused from instant to instant.
#[derive(Clone, Debug)]
pub struct Equilibrium<T> {
    /// First row of every constraint.
    first_row: Vec<usize>,
    /// Where rows and columns stand in the factored matrix.
    order: Order,
    idle: Vec<BodyId>,
    rows: usize,
    columns: usize,
    size: f64,
    /// What counts as moving.
    pub pace: Pace,
    /// Scale of every row.
    unit: Vec<f64>,
    entries: Vec<Entry<T>>,
    contacts: Vec<FrictionContact<T>>,
    qr: Qr,
    right: Vec<f64>,
    wide_plain: Vec<f64>,
    wide: Vec<T>,
    rest: Vec<T>,
    plain: Vec<f64>,
    /// Multipliers: joints and drives in the mechanism's order, then the torques that hold idle bodies.
    pub lambda: Vec<T>,
    /// Multipliers as they would be without friction.
    pub frictionless: Vec<f64>,
    /// How friction ended.
    pub friction: FrictionOutcome,
    /// Whether the pose is singular.
    pub singular: bool,
    /// What is left of the equilibrium of the worst body, over the largest term in it.
    pub residual: f64,
    /// The largest term in the equilibrium of any body, forces counted over the mechanism's size, N m.
    pub largest: f64,
}

impl<T: ForceNumber> Equilibrium<T> {
    /// Storage for a mechanism of this size (m).
    pub fn new(mechanism: &Mechanism, size: f64, frictions: usize) -> Self {
        let plan = &mechanism.plan;
        let mut first_row = Vec::with_capacity(mechanism.constraints.len());
        let mut unit = Vec::new();
        for (constraint, _) in &mechanism.constraints {
            first_row.push(unit.len());
            let scale = constraint.load_unit().factor(size);
            unit.resize(unit.len() + constraint.rows(), scale);
        }
        let idle = plan.decomposition.idle.clone();
        unit.resize(unit.len() + idle.len(), 1.0);
        let (rows, columns) = (unit.len(), 3 * (mechanism.bodies - 1));
        let longest = rows.max(columns);
        Self {
            order: Order::new(mechanism, &first_row, rows),
            first_row,
            idle,
            rows,
            columns,
            size,
            pace: Pace::default(),
            unit,
            entries: Vec::with_capacity(4 * rows),
            contacts: Vec::with_capacity(frictions),
            qr: Qr::with_capacity(rows, columns),
            right: vec![0.0; columns],
            wide_plain: vec![0.0; longest],
            wide: vec![T::zero(); longest],
            rest: vec![T::zero(); columns],
            plain: vec![0.0; rows],
            lambda: vec![T::zero(); rows],
            frictionless: vec![0.0; rows],
            friction: FrictionOutcome::None,
            singular: false,
            residual: 0.0,
            largest: 0.0,
        }
    }

    /// First row of a constraint.
    pub fn row(&self, constraint: usize) -> usize {
        self.first_row[constraint]
    }

    /// The largest load anywhere, in the unit of a constraint's multiplier.
    pub fn largest_at(&self, constraint: usize) -> f64 {
        self.largest * self.unit[self.first_row[constraint]]
    }

    /// Rows beyond the number of unknown motions: loads that equilibrium does not determine.
    pub fn redundant_rows(&self) -> usize {
        self.rows.saturating_sub(self.columns)
    }

    /// Torques that hold bodies whose angle nothing determines; a true motion needs none.
    pub fn holding_torques(&self) -> &[T] {
        &self.lambda[self.rows - self.idle.len()..]
    }

    /// Bodies whose angle nothing determines.
    pub fn idle_bodies(&self) -> &[BodyId] {
        &self.idle
    }

    /// Largest over smallest singular value of the scaled equations, at least (Frobenius norm for the largest).
    pub fn condition(&self) -> f64 {
        self.qr.norm() / self.qr.smallest_singular_value()
    }

    /// Constraints whose loads equilibrium does not determine.
    pub fn not_unique(&self) -> Vec<usize> {
        let mut list = Vec::new();
        let mut vector = vec![0.0; self.rows];
        for k in self.columns..self.rows {
            vector.fill(0.0);
            vector[k] = 1.0;
            self.qr.rotate(&mut vector);
            for (constraint, row) in self.first_row.iter().enumerate() {
                let end = self.first_row.get(constraint + 1).copied();
                let end = end.unwrap_or(self.rows - self.idle.len());
                let own = &self.order.rows[*row..end];
                if own.iter().any(|place| vector[*place].abs() > UNIQUE) {
                    list.push(constraint);
                }
            }
        }
        list.sort_unstable();
        list.dedup();
        list
    }

    /// Solves an instant: `needed` is `m a - applied` of every body, about its origin.
    pub(crate) fn solve(
        &mut self,
        mechanism: &Mechanism,
        geometry: &Geometry<T>,
        frictions: &[Friction<T>],
        at: &Instant<T>,
        needed: &[Wrench<T>],
    ) {
        self.assemble(mechanism, geometry, at);
        self.find_contacts(mechanism, geometry, frictions, at);
        self.factor(frictions, None);
        self.lambda.fill(T::zero());
        self.singular = !(self.qr.smallest_pivot_ratio() > SINGULAR);
        self.friction = FrictionOutcome::None;
        if self.singular {
            self.lambda.fill(T::from_f64(f64::NAN));
            self.frictionless.fill(f64::NAN);
            self.residual = f64::NAN;
            return;
        }
        if frictions.is_empty() {
            self.refine(frictions, needed);
            for (plain, lambda) in self.frictionless.iter_mut().zip(&self.lambda) {
                *plain = lambda.value();
            }
        } else {
            self.plain.fill(0.0);
            self.step(frictions, needed, 0.0);
            self.frictionless.copy_from_slice(&self.plain);
            self.friction = self.iterate(frictions, needed);
            match self.friction {
                FrictionOutcome::Consistent { .. } => {
                    for (lambda, plain) in self.lambda.iter_mut().zip(&self.plain) {
                        *lambda = T::from_f64(*plain);
                    }
                    self.refine(frictions, needed);
                }
                _ => self.lambda.fill(T::from_f64(f64::NAN)),
            }
        }
        self.measure_residual(frictions, needed);
    }

    fn assemble(&mut self, mechanism: &Mechanism, geometry: &Geometry<T>, at: &Instant<T>) {
        let situation = Situation {
            geometry,
            inputs: &at.inputs,
            poses: &at.poses,
            near: &at.near,
        };
        self.entries.clear();
        for (index, (constraint, _)) in mechanism.constraints.iter().enumerate() {
            let row = self.first_row[index];
            let entries = &mut self.entries;
            let take: &mut dyn FnMut(Gradient<T>) = &mut |g| {
                entries.push(Entry {
                    row: row + g.row,
                    body: g.body,
                    to: g.to,
                });
            };
            // Called: no joint is compiled once more for these entries.
            constraint.load_gradients(&situation, take);
        }
        for (k, body) in self.idle.iter().enumerate() {
            self.entries.push(Entry {
                row: self.rows - self.idle.len() + k,
                body: *body,
                to: [T::zero(), T::zero(), T::one()],
            });
        }
    }

    /// Factors the scaled matrix; with multipliers, friction's derivatives at them and its share are added.
    fn factor(&mut self, frictions: &[Friction<T>], friction_at: Option<(&[f64], f64)>) {
        let Self {
            qr,
            entries,
            unit,
            size,
            contacts,
            order,
            ..
        } = self;
        let column_scale = [*size, *size, 1.0];
        qr.reset(self.rows, self.columns);
        for entry in entries.iter().filter(|e| e.body != BodyId::GROUND) {
            let column = 3 * (entry.body.index() - 1);
            for k in 0..3 {
                let value = entry.to[k].value() * unit[entry.row] * column_scale[k];
                qr.add(order.rows[entry.row], order.columns[column + k], value);
            }
        }
        if let Some((lambda, share)) = friction_at {
            for contact in contacts.iter() {
                let friction = &frictions[contact.friction];
                let slope = friction.slope(contact.speed.value(), contact.direction) * share;
                let (count, load) = load_of(friction, &lambda[contact.row..]);
                for k in 0..count {
                    let part = if load > 0.0 {
                        lambda[contact.row + k] / load
                    } else {
                        0.0
                    };
                    for (body, unit_wrench) in &contact.unit {
                        if *body == BodyId::GROUND {
                            continue;
                        }
                        let column = 3 * (body.index() - 1);
                        for j in 0..3 {
                            let value = unit_wrench[j].value() * slope * part;
                            qr.add(
                                order.rows[contact.row + k],
                                order.columns[column + j],
                                value * unit[contact.row + k] * column_scale[j],
                            );
                        }
                    }
                }
            }
        }
        qr.factor();
    }

    /// Carries the multipliers over to every part of the number, with the matrix last factored.
    fn refine(&mut self, frictions: &[Friction<T>], needed: &[Wrench<T>]) {
        for pass in 0..T::PASSES {
            // Without friction there are no multipliers yet.
            let loaded = pass > 0 || !frictions.is_empty();
            self.fill_rest(frictions, needed, loaded);
            for (k, (place, rest)) in self.order.columns.iter().zip(&self.rest).enumerate() {
                self.wide[*place] = if k % 3 < 2 { *rest * self.size } else { *rest };
            }
            self.qr.solve_transposed(&mut self.wide);
            let places = self.order.rows.iter().zip(&self.unit);
            for (lambda, (place, unit)) in self.lambda.iter_mut().zip(places) {
                *lambda += self.wide[*place] * *unit;
            }
        }
    }

    /// What is left of every body's equilibrium at the multipliers, which are all zero where it is not `loaded`.
    fn fill_rest(&mut self, frictions: &[Friction<T>], needed: &[Wrench<T>], loaded: bool) {
        for (rest, w) in self.rest.chunks_exact_mut(3).zip(&needed[1..]) {
            rest.copy_from_slice(w);
        }
        if !loaded {
            return;
        }
        for entry in self.entries.iter().filter(|e| e.body != BodyId::GROUND) {
            let rest = &mut self.rest[3 * (entry.body.index() - 1)..][..3];
            for (rest, to) in rest.iter_mut().zip(entry.to) {
                *rest -= to * self.lambda[entry.row];
            }
        }
        for contact in &self.contacts {
            let resistance = resistance(frictions, contact, &self.lambda);
            for (body, unit) in contact.unit.iter().filter(|u| u.0 != BodyId::GROUND) {
                let rest = &mut self.rest[3 * (body.index() - 1)..][..3];
                for (rest, unit) in rest.iter_mut().zip(unit) {
                    *rest -= *unit * resistance;
                }
            }
        }
    }

    fn measure_residual(&mut self, frictions: &[Friction<T>], needed: &[Wrench<T>]) {
        let size = self.size;
        let scale = |k: usize| if k < 2 { size } else { 1.0 };
        let mut largest = 0.0_f64;
        let left = &mut self.right;
        for (left, w) in left.chunks_exact_mut(3).zip(&needed[1..]) {
            for k in 0..3 {
                left[k] = w[k].value();
                largest = largest.max((left[k] * scale(k)).abs());
            }
        }
        let mut take = |body: BodyId, k: usize, term: f64| {
            if body != BodyId::GROUND {
                left[3 * (body.index() - 1) + k] -= term;
            }
        };
        for entry in &self.entries {
            let lambda = self.lambda[entry.row].value();
            for k in 0..3 {
                let term = entry.to[k].value() * lambda;
                largest = largest.max((term * scale(k)).abs());
                take(entry.body, k, term);
            }
        }
        for contact in &self.contacts {
            let resistance = resistance(frictions, contact, &self.lambda).value();
            for (body, unit) in &contact.unit {
                for k in 0..3 {
                    take(*body, k, unit[k].value() * resistance);
                }
            }
        }
        let left = (left.iter().enumerate())
            .map(|(k, r)| (r * scale(k % 3)).abs())
            .fold(0.0, |a: f64, b| if b.is_nan() { b } else { a.max(b) });
        self.largest = largest;
        self.residual = if largest > 0.0 { left / largest } else { left };
    }

    /// Hands out what every constraint does to each of its bodies: constraint, body, wrench about the body's origin.
    pub(crate) fn each_reaction(&self, mut take: impl FnMut(usize, BodyId, Wrench<T>)) {
        let mut constraint = 0;
        let held = self.rows - self.idle.len();
        for entry in self.entries.iter().filter(|e| e.row < held) {
            while self
                .first_row
                .get(constraint + 1)
                .is_some_and(|next| *next <= entry.row)
            {
                constraint += 1;
            }
            let lambda = self.lambda[entry.row];
            take(constraint, entry.body, entry.to.map(|to| to * lambda));
        }
    }
}
