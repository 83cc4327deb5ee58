//! All assemblies of a block without closed form, by a complete method: see [`kempe_homotopy`].
//!
//! For the Assur group of class III with revolute joints the paths are 6, its exact number of assemblies. Large blocks are
//! loops that share few links, so that most equations feel few of the unknowns.

use std::ops::ControlFlow;

use kempe_homotopy::{Outcome, PathReport, all_solutions};
use kempe_mechanism::blocks::Unknown;
use kempe_mechanism::plan::NewtonBlock;
use kempe_mechanism::{Mechanism, Pose, Situation};

use super::equations::{Builder, equations};

/// Imaginary part below which an end point counts as real.
const REAL: f64 = 1e-7;

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

/// All real solutions of a block. `earlier` is what the paths did for much the same dimensions, if that is known; `work` is what is
/// left of [`WORK_LIMIT`](kempe_homotopy::WORK_LIMIT); `told` hears the finished part of the paths and may stop the work.
pub fn all_real_solutions(
    block: &NewtonBlock,
    mechanism: &Mechanism,
    known: &Situation<'_, f64>,
    scale: f64,
    earlier: Option<&PathReport>,
    work: &mut f64,
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
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
    let variables = builder.variables;
    let outcome = all_solutions(&linear, &bilinear, variables, earlier, work, progress);
    let (found, report) = match outcome {
        Outcome::Found(found, report) => (found, report),
        Outcome::TooLarge => return Solutions::NotAlgebraic,
        Outcome::Stopped => return Solutions::Stopped,
    };
    let mut poses = Vec::new();
    for solution in found.iter().filter(|s| s.unreal <= REAL) {
        let mut pose = known.poses.to_vec();
        for (unknown, z) in block.unknowns.iter().zip(&solution.plain) {
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
