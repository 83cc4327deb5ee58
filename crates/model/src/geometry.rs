//! Dimensions and links in numbers: the values of a design, on any [`Number`].

use kempe_number::Number;

use crate::ids::{ParameterId, Scalar};
use crate::link::{Center, Link, Place};

/// The value of a dimension, given the parameters' values in order.
///
/// Shape: one number in SI. A parameter the slice does not hold counts as NaN.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn value<T: Number>(scalar: &Scalar, parameters: &[T]) -> T {
    match T::IN_PLACE {
        true => value_in_place(scalar, parameters),
        false => value_called(scalar, parameters),
    }
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn value_in_place<T: Number>(scalar: &Scalar, parameters: &[T]) -> T {
    let mut it = T::from_f64(f64::NAN);
    put(scalar, parameters, &mut it);
    it
}

/// Puts a value where it belongs, without carrying lanes there and back on the way.
#[cfg_attr(not(debug_assertions), inline(always))]
fn put<T: Number>(scalar: &Scalar, parameters: &[T], to: &mut T) {
    match scalar {
        Scalar::Const(value) => *to = T::from_f64(*value),
        Scalar::Leaf(id) => match parameters.get(id.index()) {
            Some(value) => *to = *value,
            None => *to = T::from_f64(f64::NAN),
        },
        _ => *to = computed(scalar, parameters),
    }
}

#[inline(never)]
fn value_called<T: Number>(scalar: &Scalar, parameters: &[T]) -> T {
    value_in_place(scalar, parameters)
}

/// [`value`] of an expression that is more than a number or a parameter.
fn computed<T: Number>(scalar: &Scalar, parameters: &[T]) -> T {
    scalar.eval(&mut |id: &ParameterId| {
        parameters
            .get(id.index())
            .copied()
            .unwrap_or(T::from_f64(f64::NAN))
    })
}

impl Link {
    /// The points' coordinates in the link's own frame, m, in the order of [`Link::points`].
    ///
    /// Coordinates of a triangle that cannot close lie on the line of its other two points.
    pub fn evaluate<T: Number>(&self, parameters: &[T]) -> Vec<[T; 2]> {
        let mut placed = vec![[T::zero(); 2]; self.points.len()];
        self.evaluate_into(parameters, &mut placed);
        placed
    }

    /// A place on the link, in the link's own frame, m.
    pub fn locate<T: Number>(&self, at: &Place, parameters: &[T]) -> [T; 2] {
        place(at, &self.evaluate(parameters), parameters)
    }

    /// [`Link::evaluate`] into storage with room for every point.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn evaluate_into<T: Number>(&self, parameters: &[T], out: &mut [[T; 2]]) {
        for (index, point) in self.points.iter().enumerate().take(out.len()) {
            match &point.place {
                Place::Cartesian { x, y } => {
                    let [to_x, to_y] = &mut out[index];
                    put(x, parameters, to_x);
                    put(y, parameters, to_y);
                }
                other => out[index] = place(other, &out[..index], parameters),
            }
        }
    }

    /// The centre of mass in the link's own frame, m; `None` when the link has no mass properties.
    pub fn center_of_mass<T: Number>(&self, parameters: &[T]) -> Option<[T; 2]> {
        let inertia = self.inertia.as_ref()?;
        let points = self.evaluate(parameters);
        match &inertia.center {
            Center::Centroid => {
                let zero = [T::zero(), T::zero()];
                let sum = points.iter().fold(zero, |s, p| [s[0] + p[0], s[1] + p[1]]);
                let count = points.len().max(1) as f64;
                Some([sum[0] / count, sum[1] / count])
            }
            Center::Point(id) => {
                let i = self.points.iter().position(|p| p.point == *id)?;
                points.get(i).copied()
            }
            Center::Place(at) => Some(place(at, &points, parameters)),
        }
    }
}

/// Coordinates of a place, given those of the link's earlier points.
#[inline(never)]
pub(crate) fn place<T: Number>(at: &Place, placed: &[[T; 2]], parameters: &[T]) -> [T; 2] {
    let nowhere = [T::from_f64(f64::NAN); 2];
    match at {
        Place::Cartesian { x, y } => [value(x, parameters), value(y, parameters)],
        Place::Polar { radius, angle } => {
            let (sin, cos) = value(angle, parameters).sin_cos();
            let radius = value(radius, parameters);
            [radius * cos, radius * sin]
        }
        Place::Triangle {
            from,
            to,
            from_distance,
            to_distance,
            side,
        } => {
            let from = placed.get(*from).copied().unwrap_or(nowhere);
            let to = placed.get(*to).copied().unwrap_or(nowhere);
            let distances = (
                value(from_distance, parameters),
                value(to_distance, parameters),
            );
            triangle(from, to, distances, side.sign())
        }
    }
}

/// The third corner of a triangle over the line `from -> to`, at the distances `(a, b)` from its ends.
///
/// Along the line `x = (a^2 + d^2 - b^2) / (2 d)`; across it, positive on the left, `y = side h`, with the height by
/// Heron's formula in its factored form: `4 d^2 h^2 = (a+b+d)(a+b-d)(d+a-b)(d-a+b)`, which keeps its digits where
/// the triangle is nearly flat (W. Kahan, "Miscalculating area and angles of a needle-like triangle", 2014).
fn triangle<T: Number>(from: [T; 2], to: [T; 2], (a, b): (T, T), side: f64) -> [T; 2] {
    let along = [to[0] - from[0], to[1] - from[1]];
    let d2 = along[0].square() + along[1].square();
    let d = d2.sqrt();
    let (difference, sum) = (a - b, a + b);
    let x = (d + difference * sum / d) / 2.0;
    let product = (sum + d) * (sum - d) * (d + difference) * (d - difference);
    let y = product.max(T::zero()).sqrt() * (side / 2.0) / d;
    let unit = [along[0] / d, along[1] / d];
    [
        from[0] + unit[0] * x - unit[1] * y,
        from[1] + unit[1] * x + unit[0] * y,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use kempe_number::math;

    #[test]
    fn triangle_corner_is_at_its_distances_and_on_its_side() {
        for (side, turn) in [(1.0, 0.3), (-1.0, 2.9), (1.0, -1.2)] {
            let (sin, cos) = math::sin_cos(turn);
            let (from, to) = ([1.0, -2.0], [1.0 + 4.0 * cos, -2.0 + 4.0 * sin]);
            let p = triangle(from, to, (3.0, 2.5), side);
            let distance = |q: [f64; 2]| math::hypot(p[0] - q[0], p[1] - q[1]);
            assert!((distance(from) - 3.0).abs() < 1e-15 * 4.0);
            assert!((distance(to) - 2.5).abs() < 1e-15 * 4.0);
            let cross = (to[0] - from[0]) * (p[1] - from[1]) - (to[1] - from[1]) * (p[0] - from[0]);
            assert_eq!(cross.signum(), side);
        }
    }

    #[test]
    fn a_flat_triangle_has_no_height() {
        assert_eq!(
            triangle([0.0, 0.0], [3.0, 0.0], (1.0, 2.0), 1.0),
            [1.0, 0.0]
        );
        assert_eq!(
            triangle([0.0, 0.0], [1.0, 0.0], (3.0, 2.0), -1.0),
            [3.0, 0.0]
        );
        let p = triangle([0.0, 0.0], [0.3, 0.0], (0.1, 0.2), 1.0);
        assert!(p[1].abs() < 1e-8 && (p[0] - 0.1).abs() < 1e-16, "{p:?}");
    }
}
