//! Motion generation with the turns of the guiding links given.
//!
//! Fixed pivot g, link w at the zero of its angle, moving pivot z on the body: g + w e_j = p_j + T_j z at every pose, linear. In the standard
//! form of G. N. Sandor and A. G. Erdman (1984) the difference of two of these.

use kempe_linear::{C, solve_complex};

use crate::dyad::{Dyad, DyadSolution, gathered};
use crate::error::{SynthesisError, all_finite, balanced};
use crate::motion::DyadCondition;
use crate::pose::Pose;

/// Unknowns, as plane vectors.
const UNKNOWNS: usize = 3;
/// A pivot of this part of its row, or less, is what rounding left of zero.
const SINGULAR: f64 = 1e-12;

/// The link with two pins that guides a body through poses as it is at given angles (rad, from any zero): three poses, or two and a given
/// pivot.
///
/// # Errors
/// Data that are not finite, too few or too many (a pose or a given pivot makes one equation of three), lists of different lengths, lines as
/// conditions ([`SynthesisError::TooFew`]: they are half an equation), or link and body turning alike so that data depend.
pub fn timed_dyad(
    poses: &[Pose],
    angles: &[f64],
    conditions: &[DyadCondition],
) -> Result<DyadSolution, SynthesisError> {
    if poses.len() != angles.len() {
        return Err(SynthesisError::Lengths {
            first: poses.len(),
            second: angles.len(),
        });
    }
    let finite = (poses.iter().zip(angles)).map(|(p, a)| p.is_finite() && a.is_finite());
    all_finite(finite)?;
    // About the first pose's origin.
    let Some(first) = poses.first() else {
        return balanced(0, UNKNOWNS).and(Err(SynthesisError::None));
    };
    let centre = first.origin;
    let (zero, one) = (C::zero(), C::one());
    let mut rows: Vec<([C; UNKNOWNS], C)> = (poses.iter().zip(angles))
        .map(|(pose, angle)| {
            let link = C::from_polar(1.0, *angle);
            ([one, link, -pose.turn()], pose.origin - centre)
        })
        .collect();
    for condition in conditions {
        match condition {
            DyadCondition::FixedAt(place) => rows.push(([one, zero, zero], *place - centre)),
            DyadCondition::MovingAt(point) => rows.push(([zero, zero, one], *point)),
            DyadCondition::FixedOn(_) | DyadCondition::MovingOn(_) => {}
        }
    }
    balanced(rows.len(), UNKNOWNS)?;
    let determinant = {
        let [a, b, c] = [rows[0].0, rows[1].0, rows[2].0];
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    let mut matrix: Vec<C> = rows.iter().flat_map(|(row, _)| *row).collect();
    let mut right: Vec<[C; 1]> = rows.iter().map(|(_, known)| [*known]).collect();
    if !(determinant.norm() > SINGULAR) || !solve_complex(&mut matrix, &mut right, UNKNOWNS) {
        return Err(SynthesisError::Dependent {
            datum: UNKNOWNS - 1,
        });
    }
    let (fixed, moving) = (centre + right[0][0], right[2][0]);
    let found = gathered([Dyad::rr(fixed, moving, first)], poses, 0.0);
    found.into_iter().next().ok_or(SynthesisError::None)
}
