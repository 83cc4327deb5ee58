//! Linear systems, each kind in its file: what mechanisms, motions, forces and homotopies solve with.
//!
//! | file | for |
//! | --- | --- |
//! | `qr.rs` | dense systems and least squares on plain numbers, solved for any number |
//! | `elimination.rs` | small systems on the stack, one matrix per lane |
//! | `lu.rs` | square systems, real or complex, whose factors are kept |
//! | `positive.rs` | symmetric systems that are positive, as those of masses are, and which row says that they are not |
//! | `complex.rs`, `affine.rs` | complex systems, and linear equations that leave variables free |
//! | `tridiagonal.rs` | splines |
//! | `complementarity.rs` | pairs of unknowns of which one is zero, as contacts have them |
//! | `rank.rs` | the rank of large sparse matrices |
//! | `singular.rs` | how near to losing rank a matrix is |
//! | `dependent.rs` | least squares with columns that may explain each other |
//! | `span.rs` | rows that may repeat each other: the shortest vectors along them, and what is across |
//! | `marquardt.rs` | nonlinear least squares |
//! | `fixed_point.rs` | fixed points that a repeated map comes near to slowly |
//! | `symmetric.rs`, `eigenvalues.rs` | eigenvalues: of symmetric matrices with their vectors, of any real matrix |

mod affine;
mod complementarity;
mod complex;
mod dependent;
mod eigenvalues;
mod elimination;
mod fixed_point;
mod lu;
mod marquardt;
mod positive;
mod qr;
mod rank;
mod singular;
mod span;
mod symmetric;
mod tridiagonal;

pub use affine::{Affine, eliminate};
pub use complementarity::complementary;
pub use complex::{C, solve_complex};
pub use dependent::independent_least_squares;
pub use eigenvalues::eigenvalues;
pub use elimination::{Elimination, Matrix, Plain};
pub use fixed_point::Anderson;
pub use lu::{Entry, Lu};
pub use marquardt::{Residuals, smallest_squares};
pub use positive::{cholesky, factor_positive, is_pivot, solve_positive};
pub use qr::Qr;
pub use rank::{RANK_TOLERANCE, SparseRow, rank};
pub use singular::smallest_singular_value;
pub use span::Span;
pub use symmetric::{EigenPair, generalised_eigen, symmetric_eigen};
pub use tridiagonal::{Tridiagonal, solve_tridiagonal};
