//! The stiffness of two bodies that touch.

use kempe_number::Number;

use crate::Unfit;

/// An elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material<T> {
    /// Young's modulus, Pa.
    pub modulus: T,
    /// Poisson's ratio.
    pub poisson: T,
}

/// How two round bodies lie at each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fit {
    /// The second lies in the first, a journal in its bearing.
    Inside,
    /// Side by side.
    Outside,
}

/// K of Hertz's law `F = K d^(3/2)` (N/m^1.5): `4 / (3 (s1 + s2)) sqrt(R1 R2 / (R1 - R2))`, with a plus outside and
/// `s = (1 - nu^2) / E` (H. M. Lankarani and P. E. Nikravesh, 1990).
///
/// # Errors
///
/// Where radii or moduli are not positive, a Poisson's ratio is none, or the second body does not fit into the first with room
/// left.
pub fn stiffness<T: Number>(
    materials: [Material<T>; 2],
    radii: [T; 2],
    fit: Fit,
) -> Result<T, Unfit> {
    for material in materials {
        positive("modulus of elasticity", material.modulus)?;
        let ratio = material.poisson.value();
        if !(ratio > -1.0 && ratio <= 0.5) {
            return Err(Unfit::Poisson(ratio));
        }
    }
    let [first, second] = radii;
    positive("radius", first)?;
    positive("radius", second)?;
    let sum = match fit {
        Fit::Outside => first + second,
        Fit::Inside => {
            room(first, second)?;
            if first.value() == second.value() {
                return Err(Unfit::NoClearance(first.value()));
            }
            first - second
        }
    };
    let [one, other] = materials.map(|it| (-it.poisson.square() + 1.0) / it.modulus);
    Ok(T::from_f64(4.0) / ((one + other) * 3.0) * (first * second / sum).sqrt())
}

fn positive<T: Number>(what: &'static str, value: T) -> Result<f64, Unfit> {
    crate::unfit::positive(what, value.value())
}

/// Whether something fits into something else.
pub(crate) fn room<T: Number>(around: T, inside: T) -> Result<(), Unfit> {
    let (around, inside) = (around.value(), inside.value());
    match around >= inside {
        true => Ok(()),
        false => Err(Unfit::NoRoom { around, inside }),
    }
}
