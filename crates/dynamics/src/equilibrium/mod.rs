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

mod order;

use kempe_kinematics::constraint::Situation;
use kempe_kinematics::mechanism::Constraint;
use kempe_kinematics::{BodyId, Geometry, Mechanism, Plan, Qr};
use kempe_number::Number;

use self::order::Order;
use crate::friction::{Friction, Place, direction};
use crate::gear_mesh::GearMesh;
use crate::instant::Instant;
use crate::number::ForceNumber;
use crate::vector::{cross, dot, length, sub};
use crate::wrench::Wrench;

/// Smallest over largest pivot below which a pose counts as singular: joint loads are not defined there.
pub const SINGULAR: f64 = 1e-12;
/// A joint's part in a direction of undetermined loads above which its load is not unique.
pub const UNIQUE: f64 = 1e-9;
/// Speeds below this part of the fastest count as rest where friction is concerned.
pub const STILL: f64 = 1e-12;
/// Accelerations below this part of those that the fastest speed would have over the whole motion count as none.
pub const UNMOVED: f64 = 1e-9;
/// Newton steps of the friction loop before it is given up.
pub const FRICTION_STEPS: usize = 60;
/// A step of the friction loop below this part of the largest multiplier ends it.
pub const FRICTION_STEP: f64 = 1e-13;

/// One entry of J: derivatives of a row to a body's x, y and angle.
#[derive(Clone, Copy, Debug)]
struct Entry<T> {
    row: usize,
    body: BodyId,
    to: [T; 3],
}

/// How fast a motion usually is, so that rest can be told from a slow moment.
#[derive(Clone, Debug, Default)]
pub struct Pace {
    /// Mean speed of every drive, rad/s or m/s.
    pub speeds: Vec<f64>,
    /// How often the motion would fit into a second, 1/s.
    pub frequency: f64,
}

/// Friction at one joint at an instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rubbing<T> {
    /// Which friction.
    pub friction: usize,
    /// First row of the joint.
    pub row: usize,
    /// Relative speed, rad/s or m/s.
    pub speed: T,
    /// Sense of sliding.
    pub direction: f64,
    /// What a unit of resistance does: to the body that slides and to the other.
    pub unit: [(BodyId, Wrench<T>); 2],
}

/// How the friction loop ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FrictionOutcome {
    /// No friction acts.
    None,
    /// Loads and friction are consistent.
    Consistent {
        /// Newton steps made.
        steps: usize,
    },
    /// No finite force moves the mechanism: it jams already with this part of the friction.
    Jammed {
        /// Part of the friction at which the loads go to infinity.
        part: f64,
    },
    /// The loop did not settle.
    NotConverged {
        /// Last step over the largest multiplier.
        step: f64,
    },
}

/// The equilibrium of a mechanism, with storage that is reused from instant to instant.
#[derive(Clone, Debug)]
pub struct Equilibrium<T> {
    /// First row of every constraint.
    first_row: Vec<usize>,
    /// Where rows and columns stand in the factored matrix.
    order: Order,
    meshes: Vec<Option<GearMesh>>,
    idle: Vec<BodyId>,
    rows: usize,
    columns: usize,
    size: f64,
    /// What counts as moving.
    pub pace: Pace,
    /// Scale of every row.
    unit: Vec<f64>,
    entries: Vec<Entry<T>>,
    rubbing: Vec<Rubbing<T>>,
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
    pub fn new(mechanism: &Mechanism, plan: &Plan, size: f64, frictions: usize) -> Self {
        let mut first_row = Vec::with_capacity(mechanism.constraints.len());
        let mut unit = Vec::new();
        let mut meshes = Vec::with_capacity(mechanism.constraints.len());
        for (constraint, _) in &mechanism.constraints {
            first_row.push(unit.len());
            let mesh = GearMesh::new(mechanism, constraint);
            let is_angle = matches!(constraint, Constraint::Direction { .. })
                || matches!(constraint, Constraint::Gears { .. }) && mesh.is_none();
            let scale = if is_angle { 1.0 } else { 1.0 / size };
            unit.resize(unit.len() + constraint.rows(), scale);
            meshes.push(mesh);
        }
        let idle = plan.decomposition.idle.clone();
        unit.resize(unit.len() + idle.len(), 1.0);
        let (rows, columns) = (unit.len(), 3 * (mechanism.bodies - 1));
        let longest = rows.max(columns);
        Self {
            order: Order::new(mechanism, plan, &first_row, rows),
            first_row,
            meshes,
            idle,
            rows,
            columns,
            size,
            pace: Pace::default(),
            unit,
            entries: Vec::with_capacity(4 * rows),
            rubbing: Vec::with_capacity(frictions),
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
        self.find_rubbing(mechanism, geometry, frictions, at);
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
            let mut push = |g: kempe_kinematics::constraint::Gradient<T>| {
                entries.push(Entry {
                    row: row + g.row,
                    body: g.body,
                    to: g.to,
                });
            };
            if let Some(mesh) = &self.meshes[index]
                && mesh.gradients(&situation, &mut push)
            {
                continue;
            }
            situation.gradients(constraint, push);
        }
        for (k, body) in self.idle.iter().enumerate() {
            self.entries.push(Entry {
                row: self.rows - self.idle.len() + k,
                body: *body,
                to: [T::zero(), T::zero(), T::one()],
            });
        }
    }

    fn find_rubbing(
        &mut self,
        mechanism: &Mechanism,
        geometry: &Geometry<T>,
        frictions: &[Friction<T>],
        at: &Instant<T>,
    ) {
        self.rubbing.clear();
        if frictions.is_empty() {
            return;
        }
        let fastest = self.fastest(at);
        let still = [STILL * fastest, UNMOVED * fastest * self.pace.frequency];
        let still_sliding = still.map(|s| s * self.size);
        for (index, friction) in frictions.iter().enumerate() {
            let row = self.first_row[friction.constraint];
            let one = T::one();
            let zero = T::zero();
            match (friction.place, mechanism.constraints[friction.constraint].0) {
                (Place::Pin, Constraint::Coincide { a, b }) => {
                    let (v, w) = (&at.velocities, &at.accelerations);
                    let speed = v[b.body.index()][2] - v[a.body.index()][2];
                    let gain = w[b.body.index()][2] - w[a.body.index()][2];
                    self.rubbing.push(Rubbing {
                        friction: index,
                        row,
                        speed,
                        direction: direction(speed.value(), gain.value(), still),
                        unit: [(b.body, [zero, zero, -one]), (a.body, [zero, zero, one])],
                    });
                }
                (Place::Line, Constraint::OnLine { point, line }) => {
                    let along = at.poses[line.body.index()].turn(geometry.line(line).direction);
                    let arm = at.arm(point.body, geometry.marker(point));
                    let guide = &at.poses[line.body.index()];
                    let arm_guide = sub(at.place(point.body, arm), [guide.x, guide.y]);
                    let parting = sub(
                        at.velocity(point.body, arm),
                        at.velocity(line.body, arm_guide),
                    );
                    let gain = sub(
                        at.acceleration(point.body, arm),
                        at.acceleration(line.body, arm_guide),
                    );
                    let speed = dot(along, parting);
                    let gain = dot(along, gain).value();
                    let own = [-along[0], -along[1], -cross(arm, along)];
                    let other = [along[0], along[1], cross(arm_guide, along)];
                    self.rubbing.push(Rubbing {
                        friction: index,
                        row,
                        speed,
                        direction: direction(speed.value(), gain, still_sliding),
                        unit: [(point.body, own), (line.body, other)],
                    });
                }
                _ => {}
            }
        }
    }

    /// The fastest that any body moves now, or would move at the usual speeds of the drives, 1/s.
    fn fastest(&self, at: &Instant<T>) -> f64 {
        let in_sizes = |v: [f64; 3]| v[2].max(v[0] / self.size).max(v[1] / self.size);
        let now = (at.velocities.iter()).map(|v| in_sizes(v.map(|x| x.value().abs())));
        let usual = (at.coefficients.iter().zip(&self.pace.speeds))
            .flat_map(|(bodies, speed)| bodies.iter().map(move |c| (c, *speed)))
            .map(|(c, speed)| in_sizes(c.map(|x| (x.value() * speed).abs())));
        now.chain(usual).fold(0.0, f64::max)
    }

    /// Factors the scaled matrix; with multipliers, friction's derivatives at them and its share are added.
    fn factor(&mut self, frictions: &[Friction<T>], friction_at: Option<(&[f64], f64)>) {
        let Self {
            qr,
            entries,
            unit,
            size,
            rubbing,
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
            for rub in rubbing.iter() {
                let friction = &frictions[rub.friction];
                let slope = friction.slope(rub.speed.value(), rub.direction) * share;
                let (count, load) = load_of(friction.place, &lambda[rub.row..]);
                for k in 0..count {
                    let part = if load > 0.0 {
                        lambda[rub.row + k] / load
                    } else {
                        0.0
                    };
                    for (body, unit_wrench) in &rub.unit {
                        if *body == BodyId::GROUND {
                            continue;
                        }
                        let column = 3 * (body.index() - 1);
                        for j in 0..3 {
                            let value = unit_wrench[j].value() * slope * part;
                            qr.add(
                                order.rows[rub.row + k],
                                order.columns[column + j],
                                value * unit[rub.row + k] * column_scale[j],
                            );
                        }
                    }
                }
            }
        }
        qr.factor();
    }

    /// One Newton step on the plain multipliers with this share of the friction; returns its relative size.
    fn step(&mut self, frictions: &[Friction<T>], needed: &[Wrench<T>], share: f64) -> f64 {
        let right = &mut self.right;
        right.fill(0.0);
        for (body, w) in needed.iter().enumerate().skip(1) {
            for k in 0..3 {
                right[3 * (body - 1) + k] = w[k].value();
            }
        }
        for entry in self.entries.iter().filter(|e| e.body != BodyId::GROUND) {
            for k in 0..3 {
                right[3 * (entry.body.index() - 1) + k] -=
                    entry.to[k].value() * self.plain[entry.row];
            }
        }
        for rub in &self.rubbing {
            let friction = &frictions[rub.friction];
            let (_, load) = load_of(friction.place, &self.plain[rub.row..]);
            let viscous = (friction.law.viscous * rub.speed).value();
            let slope = friction.slope(rub.speed.value(), rub.direction);
            let resistance = (slope * load + viscous) * share;
            for (body, unit) in rub.unit.iter().filter(|u| u.0 != BodyId::GROUND) {
                for k in 0..3 {
                    right[3 * (body.index() - 1) + k] -= unit[k].value() * resistance;
                }
            }
        }
        let wide = &mut self.wide_plain;
        for (k, value) in right[..self.columns].iter().enumerate() {
            let scale = if k % 3 < 2 { self.size } else { 1.0 };
            wide[self.order.columns[k]] = value * scale;
        }
        self.qr.solve_transposed(wide);
        let (mut largest, mut step) = (0.0_f64, 0.0_f64);
        let places = self.order.rows.iter().zip(&self.unit);
        for (lambda, (place, unit)) in self.plain.iter_mut().zip(places) {
            let delta = wide[*place];
            *lambda += delta * unit;
            largest = largest.max((*lambda / unit).abs());
            step = step.max(delta.abs());
        }
        if largest > 0.0 { step / largest } else { step }
    }

    /// Newton's method with friction fed back, from the frictionless multipliers.
    fn iterate(&mut self, frictions: &[Friction<T>], needed: &[Wrench<T>]) -> FrictionOutcome {
        let free = self.qr.determinant();
        let square = self.rows == self.columns;
        let (mut last, mut steps) = (f64::INFINITY, 0);
        while steps < FRICTION_STEPS {
            self.refactor(frictions, 1.0);
            if !(self.qr.smallest_pivot_ratio() > SINGULAR) {
                break;
            }
            last = self.step(frictions, needed, 1.0);
            steps += 1;
            if last <= FRICTION_STEP {
                break;
            }
        }
        self.refactor(frictions, 1.0);
        let turned = square && !(self.qr.determinant() * free.signum() > 0.0);
        if turned || !(last <= FRICTION_STEP.sqrt()) {
            let jam = if square {
                self.find_jam(frictions, needed, free)
            } else {
                None
            };
            return match jam {
                Some(part) => FrictionOutcome::Jammed { part },
                None => FrictionOutcome::NotConverged { step: last },
            };
        }
        FrictionOutcome::Consistent { steps }
    }

    fn refactor(&mut self, frictions: &[Friction<T>], share: f64) {
        let plain = std::mem::take(&mut self.plain);
        self.factor(frictions, Some((&plain, share)));
        self.plain = plain;
    }

    /// The part of the friction with which the loads go to infinity: followed from none in steps that shrink on it.
    fn find_jam(
        &mut self,
        frictions: &[Friction<T>],
        needed: &[Wrench<T>],
        free: f64,
    ) -> Option<f64> {
        let (mut done, mut advance) = (0.0, 0.125);
        let mut good = self.frictionless.clone();
        while done < 1.0 && advance > 1e-6 {
            let share = f64::min(done + advance, 1.0);
            self.plain.copy_from_slice(&good);
            let mut settled = false;
            for _ in 0..FRICTION_STEPS {
                self.refactor(frictions, share);
                if !(self.qr.determinant() * free.signum() > 0.0) {
                    break;
                }
                if self.step(frictions, needed, share) <= FRICTION_STEP {
                    settled = true;
                    break;
                }
            }
            if settled {
                done = share;
                good.copy_from_slice(&self.plain);
            } else {
                advance *= 0.5;
            }
        }
        (done < 1.0).then_some(done)
    }

    /// Carries the multipliers over to every part of the number, with the matrix last factored.
    fn refine(&mut self, frictions: &[Friction<T>], needed: &[Wrench<T>]) {
        for _ in 0..T::PASSES {
            self.fill_rest(frictions, needed);
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

    /// What is left of every body's equilibrium at the multipliers.
    fn fill_rest(&mut self, frictions: &[Friction<T>], needed: &[Wrench<T>]) {
        for (rest, w) in self.rest.chunks_exact_mut(3).zip(&needed[1..]) {
            rest.copy_from_slice(w);
        }
        for entry in self.entries.iter().filter(|e| e.body != BodyId::GROUND) {
            let rest = &mut self.rest[3 * (entry.body.index() - 1)..][..3];
            for (rest, to) in rest.iter_mut().zip(entry.to) {
                *rest -= to * self.lambda[entry.row];
            }
        }
        for rub in &self.rubbing {
            let resistance = resistance(frictions, rub, &self.lambda);
            for (body, unit) in rub.unit.iter().filter(|u| u.0 != BodyId::GROUND) {
                let rest = &mut self.rest[3 * (body.index() - 1)..][..3];
                for (rest, unit) in rest.iter_mut().zip(unit) {
                    *rest -= *unit * resistance;
                }
            }
        }
    }

    fn measure_residual(&mut self, frictions: &[Friction<T>], needed: &[Wrench<T>]) {
        self.fill_rest(frictions, needed);
        let scale = |k: usize| if k % 3 < 2 { self.size } else { 1.0 };
        let mut largest = 0.0_f64;
        for entry in &self.entries {
            for k in 0..3 {
                let term = (entry.to[k] * self.lambda[entry.row]).value() * scale(k);
                largest = largest.max(term.abs());
            }
        }
        for w in &needed[1..] {
            for k in 0..3 {
                largest = largest.max((w[k].value() * scale(k)).abs());
            }
        }
        let left = (self.rest.iter().enumerate())
            .map(|(k, r)| (r.value() * scale(k)).abs())
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

    /// Hands out what friction does: constraint, body, wrench about the body's origin; the sliding body comes first.
    pub(crate) fn each_friction(
        &self,
        frictions: &[Friction<T>],
        mut take: impl FnMut(usize, BodyId, Wrench<T>),
    ) {
        for rub in &self.rubbing {
            let resistance = resistance(frictions, rub, &self.lambda);
            for (body, unit) in &rub.unit {
                let constraint = frictions[rub.friction].constraint;
                take(constraint, *body, unit.map(|u| u * resistance));
            }
        }
    }

    /// Power that friction takes, W: never positive.
    pub fn friction_power(&self, frictions: &[Friction<T>]) -> T {
        let mut sum = T::zero();
        for rub in &self.rubbing {
            sum -= resistance(frictions, rub, &self.lambda) * rub.speed;
        }
        sum
    }

    /// Whether friction acts at a joint that does not move and is not about to: its size is not determined there.
    pub fn rests(&self, frictions: &[Friction<T>]) -> bool {
        self.rubbing
            .iter()
            .any(|rub| rub.direction == 0.0 && frictions[rub.friction].law.kinetic.value() > 0.0)
    }
}

/// Rows and size of a joint's load at plain multipliers.
fn load_of(place: Place, lambda: &[f64]) -> (usize, f64) {
    match place {
        Place::Pin => (2, kempe_number::math::hypot(lambda[0], lambda[1])),
        Place::Line => (1, lambda[0].abs()),
    }
}

fn resistance<T: Number>(frictions: &[Friction<T>], rub: &Rubbing<T>, lambda: &[T]) -> T {
    let friction = &frictions[rub.friction];
    let load = match friction.place {
        Place::Pin => length([lambda[rub.row], lambda[rub.row + 1]]),
        Place::Line => lambda[rub.row].abs(),
    };
    friction.resistance(rub.speed, rub.direction, load)
}
