//! All paths of a bilinear system, from their start points to their ends.

use std::ops::ControlFlow;

use crate::hidden::guess_all;
use crate::sparsest::sparsest;
use crate::system::{Bilinear, LARGEST, Start, System, subsets};
use crate::tracker::{CARES, Care, End, Tracker};
use kempe_linear::{Affine, C, eliminate};
use kempe_number::Random;

/// Largest number of paths followed.
pub const PATH_LIMIT: usize = 3432;
/// Complex products that the paths of one search for assemblies may cost in all, some ten seconds of them: the bound
/// is not a time, so that the result is the same everywhere. Paths left over then count as lost.
pub const WORK_LIMIT: f64 = 3e9;

/// What the paths found.
#[derive(Clone, Debug, Default)]
pub struct PathReport {
    /// How many paths there are, followed or not.
    pub paths: usize,
    /// How many ended at a regular finite solution, real or not.
    pub finite: usize,
    /// How many went to infinity.
    pub infinite: usize,
    /// How many could not be followed to the end.
    pub lost: usize,
    /// Whether some of these were not followed because [`WORK_LIMIT`] was reached.
    pub exhausted: bool,
    /// The unknowns at the finite ends, plain ones and then conjugate ones: where those of a system that differs a little may be
    /// looked for.
    pub ends: Vec<Vec<C>>,
}

/// A solution of a system: `d` plain unknowns, then as many conjugate ones.
#[derive(Clone, Debug)]
pub struct Solution {
    /// The plain variables asked for.
    pub plain: Vec<C>,
    /// How far the conjugate free unknowns are from being conjugate to the plain ones, over the size of each, the largest:
    /// zero for a real solution.
    pub unreal: f64,
}

/// What the complete method came to.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// All isolated solutions, with what the paths did.
    Found(Vec<Solution>, PathReport),
    /// The system is not square, too large, or needs more than [`PATH_LIMIT`] paths.
    TooLarge,
    /// It was stopped on the way.
    Stopped,
}

/// All isolated solutions of linear and bilinear equations in `variables` plain unknowns and their conjugates; the
/// conjugate of every linear equation is taken along. Where the paths of a system much like it all ended apart, as `earlier`
/// tells, the solutions are looked for from there, and those of two plain unknowns by linear algebra: as many of them as there are
/// paths are all that there can be. `work` is what is left of [`WORK_LIMIT`]; `told` hears the finished part of the paths, where any
/// are followed, and may stop the work.
pub fn all_solutions(
    linear: &[Affine],
    bilinear: &[Bilinear],
    variables: usize,
    earlier: Option<&PathReport>,
    work: &mut f64,
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Outcome {
    let Some(solved) = eliminate(linear, variables) else {
        return Outcome::Found(Vec::new(), PathReport::default());
    };
    let d = solved.first().map_or(0, |f| f.0.len() - 1);
    if bilinear.len() != 2 * d || d > LARGEST {
        return Outcome::TooLarge;
    }
    let (solved, system, count) = sparsest(solved, bilinear, d);
    if count > PATH_LIMIT {
        return Outcome::TooLarge;
    }
    let earlier = earlier.filter(|report| report.paths == count && report.ends.len() == count);
    let known = earlier
        .and_then(|report| correct_all(&system, &report.ends, count))
        .or_else(|| correct_all(&system, &guess_all(&system)?, count));
    let report = match known {
        Some(ends) => PathReport {
            paths: count,
            finite: count,
            ends,
            ..PathReport::default()
        },
        None => match follow_all(&system, work, progress) {
            Some(report) => report,
            None => return Outcome::Stopped,
        },
    };
    let solutions = report.ends.iter().map(|x| {
        let (y, hat) = x.split_at(d);
        let unreal = y.iter().zip(hat);
        let unreal = unreal.map(|(a, b)| (*b - a.conj()).norm() / (1.0 + a.norm()));
        Solution {
            plain: solved.iter().map(|f| f.value(y)).collect(),
            unreal: unreal.fold(0.0, f64::max),
        }
    });
    Outcome::Found(solutions.collect(), report)
}

/// Corrects points nearby to the solutions of a system; `None` unless as many as it can have come out.
pub(crate) fn correct_all(system: &System, near: &[Vec<C>], count: usize) -> Option<Vec<Vec<C>>> {
    let start = start_system(system);
    let mut tracker = Tracker::new(system, &start);
    let mut found: Vec<Vec<C>> = Vec::with_capacity(near.len());
    for (place, point) in near.iter().enumerate() {
        let mut x = point.clone();
        let ended = x.len() == 2 * system.d && tracker.correct_end(&mut x);
        if ended && found.iter().all(|y| !is_same(&x, y)) {
            found.push(x);
        }
        if found.len() + near.len() - place <= count {
            return None;
        }
    }
    (found.len() == count).then_some(found)
}

/// The product system from which the paths start: its factors are random, and always the same.
fn start_system(system: &System) -> Start {
    let d = system.d;
    let mut random = Random(0xd134_2543_de82_ef95);
    let mut factor = |support: u32| {
        let mut f = Affine((0..=d).map(|_| random.complex()).collect());
        for (j, c) in f.0[..d].iter_mut().enumerate() {
            if support >> j & 1 == 0 {
                *c = C::zero();
            }
        }
        f
    };
    Start {
        plain: system.supports.iter().map(|s| factor(s[0])).collect(),
        conjugate: system.supports.iter().map(|s| factor(s[1])).collect(),
        gamma: random.complex(),
    }
}

/// Follows every path and returns what the paths did, with the distinct regular end points; `None` when stopped.
pub(crate) fn follow_all(
    system: &System,
    work: &mut f64,
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Option<PathReport> {
    let d = system.d;
    let n = 2 * d;
    let start = start_system(system);
    let subsets: Vec<Vec<bool>> = subsets(n, d)
        .into_iter()
        .filter(|s| system.is_start(s))
        .collect();
    let mut tracker = Tracker::new(system, &start);
    let mut ends: Vec<End> = Vec::with_capacity(subsets.len());
    let follow = |tracker: &mut Tracker, subset: &[bool], care: Care, work: &mut f64| {
        match system.start_point(&start, subset) {
            Some(x) if *work > 0.0 => {
                let before = tracker.solves;
                let end = tracker.follow(x, care);
                // A solve costs about n^3 / 3 products.
                *work -= (tracker.solves - before) as f64 * (n * n * n) as f64 / 3.0;
                end
            }
            _ => End::Lost,
        }
    };
    for (done, subset) in subsets.iter().enumerate() {
        progress(done as f64 / subsets.len() as f64).continue_value()?;
        ends.push(follow(&mut tracker, subset, CARES[0], work));
    }
    // Paths that were lost, and all that ended at one point, are followed again with more care.
    let again: Vec<usize> = (0..ends.len())
        .filter(|&i| match &ends[i] {
            End::Lost => true,
            End::Infinite => false,
            End::Finite(x) => (0..ends.len())
                .any(|j| j != i && matches!(&ends[j], End::Finite(y) if is_same(x, y))),
        })
        .collect();
    for i in again {
        progress(1.0).continue_value()?;
        ends[i] = follow(&mut tracker, &subsets[i], CARES[1], work);
    }
    let mut report = PathReport {
        paths: subsets.len(),
        exhausted: *work <= 0.0,
        ..PathReport::default()
    };
    let mut found: Vec<Vec<C>> = Vec::new();
    for end in ends {
        match end {
            End::Infinite => report.infinite += 1,
            End::Lost => report.lost += 1,
            // Two paths at one point: a multiple solution, or a path that jumped.
            End::Finite(x) if found.iter().any(|y| is_same(&x, y)) => report.lost += 1,
            End::Finite(x) => found.push(x),
        }
    }
    report.finite = found.len();
    report.ends = found;
    Some(report)
}

fn is_same(x: &[C], y: &[C]) -> bool {
    (x.iter().zip(y)).all(|(a, b)| (*a - *b).norm() < 1e-6 * (1.0 + a.norm()))
}
