//! Systems of polynomials in isotropic coordinates, and all of their isolated solutions by path tracking.
//!
//! In isotropic coordinates (a planar vector as a complex number z and its conjugate as an independent one) the joints of
//! planar linkages are linear or *bilinear*: linear in the plain coordinates and linear in the conjugate ones (Wampler,
//! "Solving the kinematics of planar mechanisms", J. Mech. Design 1999). After the linear equations are eliminated there
//! are d plain and d conjugate unknowns and 2 d bilinear equations, hence at most C(2d, d) isolated solutions: the
//! two-homogeneous Bezout number. All of them are reached from a start system of products of linear functions in just the
//! unknowns that every equation feels (Verschelde and Haegemans, "The GBQ-algorithm for constructing start systems of
//! homotopies for polynomial systems", SIAM J. Numer. Anal. 1993), which has a start point, and a path, for every choice
//! of factors that the unknowns can be matched to. As many regular solutions as there are paths are all, whatever led to them: those
//! known of a system much like it, or, with two plain unknowns, an eigenvalue problem. Only where these are too few are paths
//! followed.

mod hidden;
mod paths;
mod sparsest;
mod system;
mod tracker;

pub use kempe_linear::{Affine, C};
pub use paths::{Outcome, PATH_LIMIT, PathReport, Solution, WORK_LIMIT, all_solutions};
pub use system::Bilinear;
