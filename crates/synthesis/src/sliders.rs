//! Dyads with a slider that guide a body through poses.
//!
//! A pin z of the body on a fixed straight guide with the normal n: Re(conj(n) (s + (T - 1) z)) = 0 for every displacement, linear
//! and homogeneous in n and q = conj(n) z. Four poses leave one such pin. A guide on the body is one fixed in the inverted motion.

use kempe_linear::C;

use crate::displacements::Displacements;
use crate::dyad::{Dyad, DyadSolution, gathered};
use crate::error::{SynthesisError, all_finite, balanced};
use crate::kernel::kernel;
use crate::motion::equations;
use crate::polynomial::directions;
use crate::pose::{Line, Pose, cross, dot};

/// What a slider is to keep besides its poses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SliderCondition {
    /// The guide's direction, rad: counts as one pose.
    Along(f64),
    /// The pin's place, in its own plane: counts as two poses.
    PinAt(C),
    /// A line, in the pin's own plane, that it lies on: counts as one pose.
    PinOn(Line),
}

impl SliderCondition {
    fn equations(&self) -> usize {
        match self {
            Self::Along(_) | Self::PinOn(_) => 1,
            Self::PinAt(_) => 2,
        }
    }

    fn is_finite(&self) -> bool {
        match self {
            Self::Along(angle) => angle.is_finite(),
            Self::PinAt(point) => point.is_finite(),
            Self::PinOn(line) => line.is_finite(),
        }
    }
}

/// Unknowns: a pin and the direction of its guide.
const UNKNOWNS: usize = 3;
/// A pin further away than this, in units of the problem, lies at infinity: the body moves parallel to itself along a line there.
const FAR: f64 = 1e9;

/// All dyads with a slider on a fixed guide and a pin on the body. Poses after the first and conditions must make three equations: four
/// poses, three and a direction or a line for the pin, two and a pin, one with pin and direction.
///
/// # Errors
/// As of [`dyads`](crate::dyads).
pub fn fixed_guides(
    poses: &[Pose],
    conditions: &[SliderCondition],
) -> Result<Vec<DyadSolution>, SynthesisError> {
    let finite = poses.iter().map(Pose::is_finite);
    all_finite(finite.chain(conditions.iter().map(SliderCondition::is_finite)))?;
    let asked: usize = conditions.iter().map(SliderCondition::equations).sum();
    balanced(equations(poses.len(), asked), UNKNOWNS)?;
    let given = conditions.iter().find_map(|condition| match condition {
        SliderCondition::PinAt(pin) => Some(*pin),
        _ => None,
    });
    if let Some(pin) = given {
        return through_pin(poses, pin, conditions)
            .map(|guide| gathered([Dyad::Pr { guide, moving: pin }], poses, 0.0));
    }
    let displacements = Displacements::new(poses)?;
    displacements.must_turn()?;
    let mut rows: Vec<[f64; 4]> = (displacements.all.iter())
        .map(|d| {
            let t = d.turn_less_one;
            [d.shift.re, d.shift.im, t.re, -t.im]
        })
        .collect();
    let mut lines = Vec::new();
    for condition in conditions {
        match condition {
            SliderCondition::Along(angle) => {
                let along = C::from_polar(1.0, *angle);
                rows.push([along.re, along.im, 0.0, 0.0]);
            }
            SliderCondition::PinOn(line) => lines.push(*line),
            SliderCondition::PinAt(_) => {}
        }
    }
    let dependent =
        |row: crate::kernel::DependentRow| SynthesisError::Dependent { datum: row.0 + 1 };
    let points: Vec<[f64; 4]> = match lines.as_slice() {
        [] => kernel::<4, 1>(&rows).map_err(dependent)?.to_vec(),
        [line] => {
            let [a, b] = kernel::<4, 2>(&rows).map_err(dependent)?;
            // With m the line's normal and a its place: Re(conj(m) (q / conj(n))) = a.m, times |n|^2.
            let m = C::i() * displacements.direction_of_body(line.direction);
            let at = dot(m, displacements.seen_of_body(line.point));
            let form = |p: &[f64; 4], r: &[f64; 4]| {
                let (n, n2) = (C::new(p[0], p[1]), C::new(r[0], r[1]));
                let q = C::new(r[2], r[3]);
                dot(m, q * n) - at * dot(n, n2)
            };
            let mixed = form(&a, &b) + form(&b, &a);
            (directions(&[form(&a, &a), mixed, form(&b, &b)]).into_iter())
                .map(|[x, y]| std::array::from_fn(|k| a[k] * x + b[k] * y))
                .collect()
        }
        _ => {
            // Two lines for one pin: their meeting point.
            let (p, q) = (lines[0], lines[1]);
            let turn = cross(p.direction, q.direction);
            let along = cross(q.point - p.point, q.direction) / turn;
            let pin = p.point + p.direction.scale(along);
            if !pin.is_finite() {
                return Err(SynthesisError::Dependent {
                    datum: poses.len() + 1,
                });
            }
            return fixed_guides(poses, &[SliderCondition::PinAt(pin)]);
        }
    };
    let found = points.iter().filter_map(|p| {
        let (n, q) = (C::new(p[0], p[1]), C::new(p[2], p[3]));
        let size = n.norm();
        if FAR * size <= q.norm() {
            return None;
        }
        let pin = q * n.conj().recip();
        Some(Dyad::Pr {
            guide: Line {
                point: displacements.place(pin),
                direction: C::i() * n.scale(1.0 / size),
            },
            moving: displacements.body_point(pin),
        })
    });
    Ok(gathered(found, poses, displacements.scale))
}

/// The guide of a given pin: through its places in two poses, or through the one along a direction.
fn through_pin(
    poses: &[Pose],
    pin: C,
    conditions: &[SliderCondition],
) -> Result<Line, SynthesisError> {
    let along = conditions.iter().find_map(|condition| match condition {
        SliderCondition::Along(angle) => Some(*angle),
        _ => None,
    });
    let dependent = SynthesisError::Dependent { datum: poses.len() };
    match (poses, along) {
        ([pose], Some(angle)) => Ok(Line::at_angle(pose.place(pin), angle)),
        ([one, other], None) => Line::through(one.place(pin), other.place(pin)).ok_or(dependent),
        _ => Err(dependent),
    }
}

/// All dyads with a fixed pin in a straight guide of the body, by the inverted motion: directions and lines of conditions are those of
/// the body's guide and of the fixed plane.
///
/// # Errors
/// As of [`fixed_guides`].
pub fn moving_guides(
    poses: &[Pose],
    conditions: &[SliderCondition],
) -> Result<Vec<DyadSolution>, SynthesisError> {
    let inverse: Vec<Pose> = poses.iter().map(Pose::inverse).collect();
    let found = fixed_guides(&inverse, conditions)?;
    Ok(gathered(found.iter().map(|d| d.dyad.inverse()), poses, 0.0))
}
