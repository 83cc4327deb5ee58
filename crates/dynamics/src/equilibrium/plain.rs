//! The plain side of the equilibrium: the factored matrix, and the multipliers with friction fed back, of one lane.

use kempe_linear::Qr;
use kempe_mechanism::BodyId;

use super::contact::resistance;
use super::system::{Equations, Layout};
use crate::number::ForceNumber;

/// Smallest over largest pivot below which a pose counts as singular: joint loads are not defined there.
pub const SINGULAR: f64 = 1e-12;
/// A joint's part in a direction of undetermined loads above which its load is not unique.
pub const UNIQUE: f64 = 1e-9;
/// Newton steps of the friction loop before it is given up.
pub const FRICTION_STEPS: usize = 60;
/// A step of the friction loop below this part of the largest multiplier ends it.
pub const FRICTION_STEP: f64 = 1e-13;

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

/// The equilibrium of one lane in plain numbers; of intervals, that of their midpoints.
#[derive(Clone, Debug)]
pub struct PlainEquilibrium {
    lane: usize,
    /// The mechanism's size, m.
    pub(super) size: f64,
    /// The fastest that any body moves or usually does, 1/s.
    pub(super) fastest: f64,
    /// Scale of every row.
    pub(super) unit: Vec<f64>,
    pub(super) qr: Qr,
    right: Vec<f64>,
    wide: Vec<f64>,
    pub(super) lambda: Vec<f64>,
    /// Where equilibrium does not determine all multipliers and friction acts: the factored matrix without it, the directions in which multipliers are not
    /// determined, one after the other in its order of rows, ...
    pub(super) free: Option<Qr>,
    directions: Vec<f64>,
    /// ... and of which combination of the matrix's columns the multipliers are.
    pub(super) combined: Vec<f64>,
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

impl PlainEquilibrium {
    pub(super) fn new(layout: &Layout, lane: usize, size: f64, rubs: bool) -> Self {
        let (rows, columns) = (layout.rows, layout.columns);
        let undetermined = rubs && rows > columns;
        let wide = if undetermined { rows } else { columns };
        Self {
            lane,
            size,
            fastest: 0.0,
            unit: (layout.units.iter())
                .map(|unit| unit.factor(size))
                .collect(),
            qr: Qr::with_capacity(rows, wide),
            right: vec![0.0; columns],
            wide: vec![0.0; rows.max(columns)],
            lambda: vec![0.0; rows],
            free: undetermined.then(|| Qr::with_capacity(rows, wide)),
            directions: vec![0.0; rows * (wide - columns)],
            combined: vec![0.0; columns],
            frictionless: vec![0.0; rows],
            friction: FrictionOutcome::None,
            singular: false,
            residual: 0.0,
            largest: 0.0,
        }
    }

    /// Largest over smallest singular value of the scaled equations, at least (Frobenius norm for the largest).
    pub fn condition(&self) -> f64 {
        self.qr.norm() / self.qr.smallest_singular_value()
    }

    /// Constraints whose loads equilibrium does not determine.
    pub(super) fn not_unique(&self, layout: &Layout) -> Vec<usize> {
        let mut list = Vec::new();
        let mut vector = vec![0.0; layout.rows];
        for k in layout.columns..layout.rows {
            vector.fill(0.0);
            vector[k] = 1.0;
            self.qr.rotate(&mut vector);
            for (constraint, row) in layout.first_row.iter().enumerate() {
                let end = layout.first_row.get(constraint + 1).copied();
                let end = end.unwrap_or(layout.rows - layout.idle.len());
                let own = &layout.order.rows[*row..end];
                if own.iter().any(|place| vector[*place].abs() > UNIQUE) {
                    list.push(constraint);
                }
            }
        }
        list
    }

    /// Which lane it is.
    pub(super) fn index(&self) -> usize {
        self.lane
    }

    /// Whether multipliers were found: the pose is regular, and loads and friction are consistent.
    pub(super) fn is_settled(&self) -> bool {
        let consistent = matches!(
            self.friction,
            FrictionOutcome::None | FrictionOutcome::Consistent { .. }
        );
        consistent && !self.singular
    }

    /// Factors the matrix, and finds the plain multipliers where friction acts; without it they are left to be refined from
    /// zero.
    pub(super) fn settle<T: ForceNumber>(&mut self, equations: &Equations<'_, T>) {
        self.factor(equations, None);
        self.singular = !(self.qr.smallest_pivot_ratio() > SINGULAR);
        self.friction = FrictionOutcome::None;
        if self.singular {
            self.frictionless.fill(f64::NAN);
            self.residual = f64::NAN;
            return;
        }
        self.lambda.fill(0.0);
        if !equations.frictions.is_empty() {
            self.step(equations, 0.0);
            self.frictionless.copy_from_slice(&self.lambda);
            self.keep_free(equations.layout);
            self.friction = self.iterate(equations);
            self.find_combination(equations.layout);
        }
    }

    /// Keeps the matrix without friction, and the directions in which it does not determine the multipliers.
    fn keep_free(&mut self, layout: &Layout) {
        let Some(free) = &mut self.free else { return };
        std::mem::swap(free, &mut self.qr);
        self.directions.fill(0.0);
        let each = self.directions.chunks_exact_mut(layout.rows).enumerate();
        for (k, direction) in each {
            direction[layout.columns + k] = 1.0;
            free.rotate(direction);
        }
    }

    /// Of which columns of the matrix without friction the multipliers are the combination.
    fn find_combination(&mut self, layout: &Layout) {
        let Some(free) = &self.free else { return };
        let places = layout.order.rows.iter().zip(&self.unit);
        for (lambda, (place, unit)) in self.lambda.iter().zip(places) {
            self.wide[*place] = lambda / unit;
        }
        free.solve(&mut self.wide);
        let columns = layout.order.columns.iter().zip(&mut self.combined);
        for (k, (place, sum)) in columns.enumerate() {
            let scale = if k % 3 < 2 { self.size } else { 1.0 };
            *sum = self.wide[*place] * scale;
        }
    }

    /// Factors the scaled matrix; with multipliers, friction's derivatives at them and its share are added, and behind its columns the directions in which it does
    /// not determine the multipliers: none of a step is along these.
    pub(super) fn factor<T: ForceNumber>(
        &mut self,
        equations: &Equations<'_, T>,
        friction_at: Option<(&[f64], f64)>,
    ) {
        let Self {
            qr,
            unit,
            size,
            lane,
            directions,
            ..
        } = self;
        let Layout {
            order,
            rows,
            columns,
            ..
        } = equations.layout;
        let column_scale = [*size, *size, 1.0];
        match friction_at {
            Some(_) => qr.reset(*rows, columns + directions.len() / rows),
            None => qr.reset(*rows, *columns),
        }
        for entry in equations
            .entries
            .iter()
            .filter(|e| e.body != BodyId::GROUND)
        {
            let column = 3 * (entry.body.index() - 1);
            for k in 0..3 {
                let value = entry.to[k].value_in(*lane) * unit[entry.row] * column_scale[k];
                qr.add(order.rows[entry.row], order.columns[column + k], value);
            }
        }
        if let Some((lambda, share)) = friction_at {
            for (k, direction) in directions.chunks_exact(*rows).enumerate() {
                for (row, value) in direction.iter().enumerate() {
                    qr.add(row, columns + k, *value);
                }
            }
            // What resists whatever the load has no slope.
            let by_load = equations.contacts.iter().filter(|c| c.resists.is_none());
            for contact in by_load {
                let friction = &equations.frictions[contact.friction];
                let slope =
                    friction.slope(contact.speed, contact.direction, *lane) * friction.share(share);
                let load = load_of(&lambda[contact.row..][..friction.rows()]);
                for k in 0..friction.rows() {
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
                            let value = unit_wrench[j].value_in(*lane) * slope * part;
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

    /// One Newton step on the plain multipliers with this share of the friction; returns its relative size.
    pub(super) fn step<T: ForceNumber>(&mut self, equations: &Equations<'_, T>, share: f64) -> f64 {
        let (lane, right) = (self.lane, &mut self.right);
        right.fill(0.0);
        for (body, w) in equations.needed.iter().enumerate().skip(1) {
            for k in 0..3 {
                right[3 * (body - 1) + k] = w[k].value_in(lane);
            }
        }
        for entry in equations
            .entries
            .iter()
            .filter(|e| e.body != BodyId::GROUND)
        {
            for k in 0..3 {
                right[3 * (entry.body.index() - 1) + k] -=
                    entry.to[k].value_in(lane) * self.lambda[entry.row];
            }
        }
        for contact in equations.contacts {
            let friction = &equations.frictions[contact.friction];
            let resistance = match contact.resists {
                Some(resistance) => resistance.value_in(lane),
                None => {
                    let load = load_of(&self.lambda[contact.row..][..friction.rows()]);
                    let apart = friction.apart_from_load(contact.speed, contact.direction);
                    let slope = friction.slope(contact.speed, contact.direction, lane);
                    slope * load + apart.value_in(lane)
                }
            };
            let resistance = resistance * friction.share(share);
            for (body, unit) in contact.unit.iter().filter(|u| u.0 != BodyId::GROUND) {
                for k in 0..3 {
                    right[3 * (body.index() - 1) + k] -= unit[k].value_in(lane) * resistance;
                }
            }
        }
        let (order, wide) = (&equations.layout.order, &mut self.wide);
        for (k, value) in right.iter().enumerate() {
            let scale = if k % 3 < 2 { self.size } else { 1.0 };
            wide[order.columns[k]] = value * scale;
        }
        wide[equations.layout.columns..].fill(0.0);
        self.qr.solve_transposed(wide);
        let (mut largest, mut step) = (0.0_f64, 0.0_f64);
        let places = order.rows.iter().zip(&self.unit);
        for (lambda, (place, unit)) in self.lambda.iter_mut().zip(places) {
            let delta = wide[*place];
            *lambda += delta * unit;
            largest = largest.max((*lambda / unit).abs());
            step = step.max(delta.abs());
        }
        if largest > 0.0 { step / largest } else { step }
    }

    /// Newton's method with friction fed back, from the frictionless multipliers.
    fn iterate<T: ForceNumber>(&mut self, equations: &Equations<'_, T>) -> FrictionOutcome {
        if self.free.is_some() {
            self.refactor(equations, 0.0);
        }
        let free = self.qr.determinant();
        let (mut last, mut steps) = (f64::INFINITY, 0);
        while steps < FRICTION_STEPS {
            self.refactor(equations, 1.0);
            if !(self.qr.smallest_pivot_ratio() > SINGULAR) {
                break;
            }
            last = self.step(equations, 1.0);
            steps += 1;
            if last <= FRICTION_STEP {
                break;
            }
        }
        self.refactor(equations, 1.0);
        let turned = !(self.qr.determinant() * free.signum() > 0.0);
        if turned || !(last <= FRICTION_STEP.sqrt()) {
            return match self.find_jam(equations, free) {
                Some(part) => FrictionOutcome::Jammed { part },
                None => FrictionOutcome::NotConverged { step: last },
            };
        }
        FrictionOutcome::Consistent { steps }
    }

    /// Factors the matrix with friction's derivatives at the plain multipliers and this share of the friction.
    pub(super) fn refactor<T: ForceNumber>(&mut self, equations: &Equations<'_, T>, share: f64) {
        let lambda = std::mem::take(&mut self.lambda);
        self.factor(equations, Some((&lambda, share)));
        self.lambda = lambda;
    }

    /// The part of the friction with which the loads go to infinity: followed from none in steps that shrink on it.
    fn find_jam<T: ForceNumber>(&mut self, equations: &Equations<'_, T>, free: f64) -> Option<f64> {
        let (mut done, mut advance) = (0.0, 0.125);
        let mut good = self.frictionless.clone();
        while done < 1.0 && advance > 1e-6 {
            let share = f64::min(done + advance, 1.0);
            self.lambda.copy_from_slice(&good);
            let (mut settled, mut last) = (false, f64::INFINITY);
            for _ in 0..FRICTION_STEPS {
                self.refactor(equations, share);
                if !(self.qr.determinant() * free.signum() > 0.0) {
                    break;
                }
                let step = self.step(equations, share);
                // Where loads go to infinity rounding is more than a step may be.
                let is_rounding = step <= FRICTION_STEP.sqrt() && step > 0.5 * last;
                last = step;
                if step <= FRICTION_STEP || is_rounding {
                    settled = true;
                    break;
                }
            }
            if settled {
                done = share;
                good.copy_from_slice(&self.lambda);
            } else {
                advance *= 0.5;
            }
        }
        (done < 1.0).then_some(done)
    }

    /// Measures what is left of the equilibrium at these multipliers.
    pub(super) fn measure_residual<T: ForceNumber>(
        &mut self,
        equations: &Equations<'_, T>,
        lambda: &[T],
    ) {
        let (lane, size) = (self.lane, self.size);
        let scale = |k: usize| if k < 2 { size } else { 1.0 };
        let mut largest = 0.0_f64;
        let left = &mut self.right;
        for (left, w) in left.chunks_exact_mut(3).zip(&equations.needed[1..]) {
            for k in 0..3 {
                left[k] = w[k].value_in(lane);
                largest = largest.max((left[k] * scale(k)).abs());
            }
        }
        let mut take = |body: BodyId, k: usize, term: f64| {
            if body != BodyId::GROUND {
                left[3 * (body.index() - 1) + k] -= term;
            }
        };
        for entry in equations.entries {
            let lambda = lambda[entry.row].value_in(lane);
            for k in 0..3 {
                let term = entry.to[k].value_in(lane) * lambda;
                largest = largest.max((term * scale(k)).abs());
                take(entry.body, k, term);
            }
        }
        for contact in equations.contacts {
            let resistance = resistance(equations.frictions, contact, lambda).value_in(lane);
            for (body, unit) in &contact.unit {
                for k in 0..3 {
                    take(*body, k, unit[k].value_in(lane) * resistance);
                }
            }
        }
        let left = (left.iter().enumerate())
            .map(|(k, r)| (r * scale(k % 3)).abs())
            .fold(0.0, |a: f64, b| if b.is_nan() { b } else { a.max(b) });
        self.largest = largest;
        self.residual = if largest > 0.0 { left / largest } else { left };
    }
}

/// Size of a joint's load at its plain multipliers, of a pin or along a line.
fn load_of(lambda: &[f64]) -> f64 {
    match *lambda {
        [x, y] => kempe_number::math::hypot(x, y),
        _ => lambda.first().map_or(0.0, |x| x.abs()),
    }
}
