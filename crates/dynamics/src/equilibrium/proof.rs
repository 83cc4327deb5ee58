//! Bounds of the multipliers, proved, where poses, motion and what acts lie in intervals.
//!
//! With `G(lambda)` what is left of the equilibrium at multipliers, `l` those of the midpoints and `R` about the inverse of
//! the derivative of `G` there, `lambda - l = R G(l) + (I - R A)(lambda - l)` for every solution, where `A` holds all
//! derivatives between `l` and the solution, friction's included. A box around `l` whose image under the right side lies in
//! its interior holds exactly one solution for every value in the intervals (R. Krawczyk, 1969; S. M. Rump, "Verification
//! methods", 2010). Higher coefficients of series follow from the same matrix, one after the other.
//!
//! Where friction allows for several solutions, that is the one into which the midpoints' goes over.

use kempe_mechanism::BodyId;
use kempe_number::{Interval, Number};

use super::system::Equations;
use super::{Equilibrium, equations};
use crate::friction::Friction;
use crate::number::{ForceNumber, PlainNumber};
use crate::vector::length;
use crate::wrench::Wrench;

/// Boxes that are tried before there is no proof.
const BOXES: usize = 12;
/// Images under the right side that are taken of a proved box to narrow it.
const NARROWING: usize = 2;
/// Part of its width by which a box is widened on both sides before its image is taken.
const WIDENING: f64 = 0.1;
/// Part of the largest multiplier by which every bound of a box is widened: it has to hold rounding, too.
const ROUNDING: f64 = 1e-15;

impl<T: ForceNumber> Equilibrium<T> {
    /// Proves bounds of the multipliers; the whole line where there is no proof, and where equilibrium does not determine
    /// them: no bounds are told of the shortest of many solutions.
    pub(crate) fn prove(&mut self, frictions: &[Friction<T>], needed: &[Wrench<T>]) {
        let bounds = self.bounds(frictions, needed);
        if bounds.is_none() {
            let unknown = (0..T::ORDER).fold(T::zero(), |x, k| {
                x.plus(k, T::Plain::of_bounds(Interval::WHOLE))
            });
            self.lambda.fill(unknown);
        }
    }

    /// Enters the bounds that can be proved; `None` where there are none of the values.
    fn bounds(&mut self, frictions: &[Friction<T>], needed: &[Wrench<T>]) -> Option<()> {
        if self.redundant_rows() > 0 || !self.lanes[0].is_settled() {
            return None;
        }
        let equations = equations!(self, frictions, needed);
        let plain = &mut self.lanes[0];
        plain.factor(&equations, None);
        if frictions.is_empty() {
            plain.step(&equations, 0.0);
            plain.frictionless.copy_from_slice(&plain.lambda);
        } else {
            // A pose between that is singular without friction has no load, whatever friction may hold there.
            let inverse = self.inverse();
            let free = self.defect(&inverse, None, frictions);
            let ones = vec![Interval::from_f64(1.0); free.len()];
            enclose(&ones, 1.0, |_| free.clone())?;
            let equations = equations!(self, frictions, needed);
            self.lanes[0].refactor(&equations, 1.0);
        }
        let inverse = self.inverse();
        let values = self.values(&inverse, frictions, needed)?;
        let defect = self.defect(&inverse, Some(&values), frictions);
        for (to, value) in self.lambda.iter_mut().zip(values) {
            *to = T::zero().plus(0, T::Plain::of_bounds(value));
        }
        for order in 1..T::ORDER {
            let left = self.left(order, &inverse, frictions, needed);
            let found = enclose(&left, 0.0, |_| defect.clone());
            let unknown = match left.iter().any(|x| x.is_empty()) {
                true => Interval::EMPTY,
                false => Interval::WHOLE,
            };
            for k in 0..left.len() {
                let more = found.as_ref().map_or(unknown, |x| self.scaled(k, x[k]));
                self.lambda[k] = self.lambda[k].plus(order, T::Plain::of_bounds(more));
            }
        }
        Some(())
    }

    /// Bounds of the values of the multipliers.
    fn values(
        &mut self,
        inverse: &[Vec<f64>],
        frictions: &[Friction<T>],
        needed: &[Wrench<T>],
    ) -> Option<Vec<Interval>> {
        let plain = &self.lanes[0];
        let start: Vec<Interval> = plain
            .lambda
            .iter()
            .map(|x| Interval::from_f64(*x))
            .collect();
        let size = (plain.lambda.iter().zip(&plain.unit)).fold(0.0, |size: f64, (lambda, unit)| {
            size.max((lambda / unit).abs())
        });
        for (lambda, start) in self.lambda.iter_mut().zip(&start) {
            *lambda = T::zero().plus(0, T::Plain::of_bounds(*start));
        }
        let left = self.left(0, inverse, frictions, needed);
        let moved = |beside: &[Interval]| -> Vec<Interval> {
            let list = start.iter().zip(beside).enumerate();
            list.map(|(k, (start, beside))| *start + self.scaled(k, *beside))
                .collect()
        };
        // Friction's derivatives depend on the box: on all between it and the start.
        let beside = enclose(&left, size, |beside| {
            let between: Vec<Interval> = (moved(beside).iter().zip(&start))
                .map(|(lambda, start)| lambda.hull(*start))
                .collect();
            self.defect(inverse, Some(&between), frictions)
        })?;
        Some(moved(&beside))
    }

    /// A multiplier in its own unit.
    fn scaled(&self, row: usize, value: Interval) -> Interval {
        value * self.lanes[0].unit[row]
    }

    /// The inverse of the scaled matrix that was last factored, about: by rows, multipliers over unknowns.
    fn inverse(&self) -> Vec<Vec<f64>> {
        let (n, order, plain) = (self.layout.rows, &self.layout.order, &self.lanes[0]);
        let mut inverse = vec![vec![0.0; n]; n];
        let mut wide = vec![0.0; n];
        for column in 0..n {
            wide.fill(0.0);
            wide[order.columns[column]] = 1.0;
            plain.qr.solve_transposed(&mut wide);
            for (row, place) in inverse.iter_mut().zip(&order.rows) {
                row[column] = wide[*place];
            }
        }
        inverse
    }

    /// Scale of a column of the matrix.
    fn column_scale(&self, k: usize) -> f64 {
        if k % 3 < 2 { self.lanes[0].size } else { 1.0 }
    }

    /// `R G`: the inverse times a coefficient of what is left of the equilibrium at the multipliers.
    fn left(
        &mut self,
        order: usize,
        inverse: &[Vec<f64>],
        frictions: &[Friction<T>],
        needed: &[Wrench<T>],
    ) -> Vec<Interval> {
        self.fill_rest(frictions, needed, true);
        let rest: Vec<Interval> = (self.rest.iter().enumerate())
            .map(|(k, rest)| rest.coefficient_of(order).bounds() * self.column_scale(k))
            .collect();
        inverse.iter().map(|row| dot(row, &rest)).collect()
    }

    /// `I - R A` by rows, with all derivatives `A` at multipliers in a box; without friction's where there is none.
    fn defect(
        &self,
        inverse: &[Vec<f64>],
        lambda: Option<&[Interval]>,
        frictions: &[Friction<T>],
    ) -> Vec<Vec<Interval>> {
        let n = self.layout.rows;
        let mut matrix = vec![vec![Interval::from_f64(0.0); n]; n];
        let mut add = |row: usize, body: BodyId, to: [Interval; 3]| {
            if body == BodyId::GROUND {
                return;
            }
            for (k, to) in to.into_iter().enumerate() {
                let column = 3 * (body.index() - 1) + k;
                matrix[row][column] += self.scaled(row, to) * self.column_scale(column);
            }
        };
        for entry in &self.entries {
            add(entry.row, entry.body, entry.to.map(bounds));
        }
        if let Some(lambda) = lambda {
            self.each_derivative(lambda, frictions, &mut add);
        }
        let mut defect = vec![vec![Interval::from_f64(0.0); n]; n];
        for (i, (defect, inverse)) in defect.iter_mut().zip(inverse).enumerate() {
            for (j, (defect, column)) in defect.iter_mut().zip(&matrix).enumerate() {
                let kronecker = Interval::from_f64(f64::from(u8::from(i == j)));
                *defect = kronecker - dot(inverse, column);
            }
        }
        defect
    }

    /// Hands out the derivatives of what friction does, at multipliers in a box.
    fn each_derivative(
        &self,
        lambda: &[Interval],
        frictions: &[Friction<T>],
        add: &mut impl FnMut(usize, BodyId, [Interval; 3]),
    ) {
        let any_sense = Interval::new(-1.0, 1.0);
        for contact in &self.contacts {
            let friction = &frictions[contact.friction];
            let slope = bounds(friction.per_load(contact.speed)) * bounds(contact.direction);
            let rows = contact.row..contact.row + friction.rows();
            let load = match &lambda[rows.clone()] {
                [x, y] => length([*x, *y]),
                one => one[0].abs(),
            };
            for row in rows {
                let part = match load.contains_zero() {
                    true => any_sense,
                    false => (lambda[row] / load).intersect(any_sense),
                };
                for (body, unit) in &contact.unit {
                    add(row, *body, unit.map(|u| bounds(u) * slope * part));
                }
            }
        }
    }
}

/// A box that holds exactly one solution of `x = left + defect x` for every value in the intervals, where `defect` is that of
/// a box; `size` is that of the numbers beside which the solution is counted. `None` where there is no proof.
fn enclose(
    left: &[Interval],
    size: f64,
    defect: impl Fn(&[Interval]) -> Vec<Vec<Interval>>,
) -> Option<Vec<Interval>> {
    let image = |x: &[Interval]| -> Vec<Interval> {
        let rows = left.iter().zip(defect(x));
        rows.map(|(left, row)| *left + dot(&row, x)).collect()
    };
    let mut found = left.to_vec();
    for _ in 0..BOXES {
        if !found.iter().all(|x| x.is_finite()) {
            return None;
        }
        let largest = found.iter().fold(size, |m, x| m.max(x.mag()));
        let wider: Vec<Interval> = (found.iter())
            .map(|x| {
                let more = WIDENING * x.width() + ROUNDING * largest + f64::MIN_POSITIVE;
                Interval::new(x.lo() - more, x.hi() + more)
            })
            .collect();
        found = image(&wider);
        if (found.iter().zip(&wider)).all(|(x, w)| x.is_inside_interior(*w)) {
            for _ in 0..NARROWING {
                let again = image(&found);
                found = (found.iter().zip(&again))
                    .map(|(x, y)| x.intersect(*y))
                    .collect();
            }
            return Some(found);
        }
    }
    None
}

/// The bounds of a number without its derivatives.
fn bounds<T: ForceNumber>(number: T) -> Interval {
    number.plain().bounds()
}

/// A row times a column.
fn dot<A: Copy>(row: &[A], column: &[Interval]) -> Interval
where
    Interval: std::ops::Mul<A, Output = Interval>,
{
    let terms = row.iter().zip(column);
    terms.fold(Interval::from_f64(0.0), |sum, (a, x)| sum + *x * *a)
}
