//! Poses proved by interval arithmetic: Krawczyk's operator on the constraint rows.
//!
//! For a system F(x) = 0, a plain approximate inverse Y of its Jacobian at x0 and a box U of corrections about x0,
//!
//! K(U) = -Y F(x0) + (I - Y J(x0 + U)) U.
//!
//! If K(U) lies in the interior of U, then F has exactly one zero in x0 + U, it lies in x0 + K(U), and every matrix of
//! J(x0 + U) is regular (R. Krawczyk, Computing 4 (1969) 187; R. E. Moore, SIAM J. Numer. Anal. 14 (1977) 611; S. M.
//! Rump, Acta Numerica 19 (2010) 287, theorem 13.2). All of it holds for every value of a parameter at once when F and J
//! are evaluated for an interval of that parameter: existence and uniqueness all along a stretch of the motion
//! (A. Neumaier, *Interval Methods for Systems of Equations*, 1990, section 5.1).
//!
//! The unknowns are x, y (m) and the angle (rad) of the bodies, an angle entering the rows by enclosures of its sine and
//! cosine: a direction can not leave the unit circle. A box is looked for by epsilon inflation (S. M. Rump, 1983): the
//! image, a little widened, is tried as the next box.
//!
//! `System` is the rows and unknowns, `Given` what they are evaluated with; `polish` finds the middle on plain numbers, `contract`
//! looks for the box, `enclose` proves a pose with both, `tube` a stretch of a motion, and `block` lets a plan run on intervals.

mod block;
mod contract;
mod enclose;
mod given;
mod polish;
mod system;
mod tube;

pub(crate) use self::block::enclose_block;
pub(crate) use self::given::Given;
pub(crate) use self::system::{Middle, System, middle_of};
pub(crate) use self::tube::{Curve, Tube};
