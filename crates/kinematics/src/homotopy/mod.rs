//! All assemblies of a block without closed form, by a complete method.
//!
//! In isotropic coordinates (a planar vector as a complex number z and its conjugate as an independent one) every
//! joint of Kempe is linear or *bilinear*: linear in the plain coordinates and linear in the conjugate ones (Wampler,
//! "Solving the kinematics of planar mechanisms", J. Mech. Design 1999). After the linear equations are eliminated a
//! block has d plain and d conjugate unknowns and 2 d bilinear equations, hence at most C(2d, d) isolated solutions:
//! the two-homogeneous Bezout number; for the Assur group of class III with revolute joints that is 6, its exact number
//! of assemblies. Large blocks are loops that share few links, so that most equations feel few of the unknowns. All
//! isolated solutions are reached from a start system of products of linear functions in just these unknowns (Verschelde
//! and Haegemans, "The GBQ-algorithm for constructing start systems of homotopies for polynomial systems", SIAM J.
//! Numer. Anal. 1993), which has a start point, and a path, for every choice of factors that the unknowns can be matched
//! to.

mod equations;
mod random;
mod system;
mod tracker;

use std::ops::ControlFlow;

use self::equations::{Builder, equations};
pub(crate) use self::random::Random;
use self::system::sparsest;
use crate::blocks::Unknown;
use crate::complex_linear::eliminate;
use crate::constraint::Situation;
use crate::mechanism::Mechanism;
use crate::plan::NewtonBlock;
use crate::pose::Pose;

/// Largest number of paths followed; a block that needs more is searched from many starts instead.
pub const PATH_LIMIT: usize = 3432;
/// Most plain unknowns of a block for which paths are counted.
const LARGEST: usize = 8;
/// Complex products that the paths of one search for assemblies may cost in all, some ten seconds of them: the bound
/// is not a time, so that the result is the same everywhere. Paths left over then count as lost.
pub const WORK_LIMIT: f64 = 3e9;
/// Imaginary part below which an end point counts as real.
const REAL: f64 = 1e-7;

/// What the paths found.
#[derive(Clone, Debug, Default)]
pub struct PathReport {
    /// How many paths were followed.
    pub paths: usize,
    /// How many ended at a regular finite solution, real or not.
    pub finite: usize,
    /// How many went to infinity.
    pub infinite: usize,
    /// How many could not be followed to the end.
    pub lost: usize,
    /// Whether some of these were not followed because [`WORK_LIMIT`] was reached.
    pub exhausted: bool,
}

/// What the complete method came to.
#[derive(Clone, Debug)]
pub enum Solutions {
    /// Poses of the block's bodies for every real solution, not yet polished; bodies outside the block keep theirs.
    Found(Vec<Vec<Pose<f64>>>, PathReport),
    /// It does not apply: a gear or rack inside the block, or too many paths.
    NotAlgebraic,
    /// It was stopped on the way.
    Stopped,
}

/// All real solutions of a block. `work` is what is left of [`WORK_LIMIT`]; `told` hears the finished part of the paths and may stop the work.
pub fn all_real_solutions(
    block: &NewtonBlock,
    mechanism: &Mechanism,
    known: &Situation<'_, f64>,
    scale: f64,
    work: &mut f64,
    told: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Solutions {
    let builder = Builder {
        block,
        mechanism,
        known,
        scale,
        variables: block.unknowns.len(),
    };
    let Some((linear, bilinear)) = equations(&builder) else {
        return Solutions::NotAlgebraic;
    };
    let Some(solved) = eliminate(&linear, builder.variables) else {
        return Solutions::Found(Vec::new(), PathReport::default());
    };
    let d = solved.first().map_or(0, |f| f.0.len() - 1);
    if bilinear.len() != 2 * d || d > LARGEST {
        return Solutions::NotAlgebraic;
    }
    let (solved, system, count) = sparsest(solved, &bilinear, d);
    if count > PATH_LIMIT {
        return Solutions::NotAlgebraic;
    }

    let Some((found, report)) = system.follow_all(work, told) else {
        return Solutions::Stopped;
    };

    let mut poses = Vec::new();
    for x in &found {
        let (y, hat) = x.split_at(d);
        let real = y
            .iter()
            .zip(hat)
            .all(|(a, b)| (*b - a.conj()).norm() <= REAL * (1.0 + a.norm()));
        if !real {
            continue;
        }
        let mut pose = known.poses.to_vec();
        for (unknown, f) in block.unknowns.iter().zip(&solved) {
            let z = f.value(y);
            let at = &mut pose[unknown.body().index()];
            match unknown {
                Unknown::Angle(_) => {
                    let size = z.norm();
                    (at.c, at.s) = (z.re / size, z.im / size);
                }
                Unknown::Place(_) => (at.x, at.y) = (z.re * scale, z.im * scale),
            }
        }
        poses.push(pose);
    }
    Solutions::Found(poses, report)
}
