//! The first link and the coupler of a four-bar whose frame and second link are given, by pairs of angles.

use kempe_linear::{C, independent_least_squares};

use super::{PrecisionPoint, SAME_ANGLE, distinct};
use crate::error::{SynthesisError, all_finite};
use crate::pose::dot;

/// What [`two_lengths`] found.
#[derive(Clone, Debug, PartialEq)]
pub struct TwoLengths {
    /// The first link; negative where the data describe it turned about by half a turn.
    pub input: f64,
    /// The coupler.
    pub coupler: f64,
    /// By how much a coupler that closed each pair would be longer.
    pub residuals: Vec<f64>,
}

/// First link a and coupler b from pairs of angles, with the frame d and the second link c given; exact for two pairs, least squares beyond.
///
/// Angles are those of the links from the direction of the frame, first to second pivot, rad. With Q = d + c e^(i output), the second link's
/// end: |Q|^2 = 2 a Re(Q e^(-i input)) + b^2 - a^2, linear in a and b^2 - a^2, so that nothing quadratic is left to solve.
///
/// # Errors
/// Fewer than two pairs, or such as are not finite, repeated, contradictory or tell nothing about a ([`SynthesisError::Dependent`]); data that
/// only a coupler of imaginary length keeps ([`SynthesisError::None`]).
pub fn two_lengths(
    frame: f64,
    output_link: f64,
    points: &[PrecisionPoint],
) -> Result<TwoLengths, SynthesisError> {
    all_finite(
        points
            .iter()
            .map(PrecisionPoint::is_finite)
            .chain([frame.is_finite(), output_link.is_finite()]),
    )?;
    if points.len() < 2 {
        return Err(SynthesisError::TooFew {
            equations: points.len(),
            unknowns: 2,
        });
    }
    let pairs: Vec<[f64; 2]> = points.iter().map(|p| [p.input, p.output]).collect();
    if points.len() == 2 {
        distinct(&pairs, |_| SAME_ANGLE, true)?;
    }
    let ends: Vec<C> = (points.iter())
        .map(|p| C::from(frame) + C::from_polar(output_link, p.output))
        .collect();
    let along: Vec<f64> = (ends.iter().zip(points))
        .map(|(q, p)| 2.0 * dot(*q, C::from_polar(1.0, p.input)))
        .collect();
    let squares: Vec<f64> = ends.iter().map(|q| q.norm_sqr()).collect();
    // Less their means: what tells a. The constant tells b.
    let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
    let (along_mean, square_mean) = (mean(&along), mean(&squares));
    let less = |x: &[f64], m: f64| x.iter().map(|x| x - m).collect::<Vec<f64>>();
    let (slope, rest) = (less(&along, along_mean), less(&squares, square_mean));
    let size = along.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    if slope.iter().all(|x| x.abs() <= FLAT * size) {
        return Err(SynthesisError::Dependent { datum: 1 });
    }
    let a = independent_least_squares(&[&slope], &rest)[0];
    let square = square_mean - along_mean * a + a * a;
    if !(square > 0.0) {
        return Err(SynthesisError::None);
    }
    let coupler = square.sqrt();
    let residuals = (ends.iter().zip(points))
        .map(|(q, p)| (*q - C::from_polar(a, p.input)).norm() - coupler)
        .collect();
    Ok(TwoLengths {
        input: a,
        coupler,
        residuals,
    })
}

/// Projections that differ by less than this part of themselves tell nothing about the first link.
const FLAT: f64 = 1e-11;
