//! Ways down to first-order optimal designs of a front.
//!
//! The largest of some objectives' changes from a target, each by the front's range, is minimised (A. Pascoletti and P. Serafini, 1984; of pieces, it is
//! one objective of [`sqp`](crate::sqp())). Objectives whose multipliers are zero there might fall further while the others stay: these are minimised next, with
//! the others kept, so that no merely weak optimum is left. At an end of a front the objective that is least there often has its least value along a way, or at one
//! place: to keep it then holds everything, as far as conditions of first order say. There the others are lessened beside it instead, with a little weight.

use crate::dominance::dominates;
use crate::problem::{self, Candidate, Evaluation, Piece, Problem, Scales, Slopes, sound_scale};
use crate::progress::{Ended, Hears, Progress};
use crate::sqp::{Going, Optimum, SqpOptions, side_by_side};
use crate::workers::Workers;

/// A share of the multipliers that is nothing: conditions are met to a tenth of that.
const NOTHING: f64 = 1e-7;
/// A fall of an objective by more than this, of the front's range, is worth a design of which less is known.
const SOMETHING: f64 = 1e-6;
/// In a valley of an objective that is kept, another falls by up to this part of its range for the tolerance to which that is kept alone.
const BY_TOLERANCE: f64 = 1e-4;
/// Values of an objective are the same where they differ by less than this part of them and of the front's range, by this part of them, or by this part of
/// the range.
const SAME: [f64; 3] = [1e-7, 1e-10, 1e-12];
/// What one objective gains is nothing where it is less than this part of what another loses, both by the front's range (A. M. Geoffrion's proper optima, 1968).
const PROPER: f64 = 1e-7;
/// The weight of the others where they are lessened beside the objective of an end, and by how much one of them must fall for the end to be there.
const TILT: f64 = 1e-4;
const WORTH: f64 = 1e-3;

/// Conditions of first order that are missed by no more hold.
pub const FIRST_ORDER: f64 = 1e-5;

/// A design of a refined front.
#[derive(Clone, Debug, PartialEq)]
pub struct Refined {
    /// The design and what it is worth.
    pub candidate: Candidate,
    /// How far the first-order conditions are missed, in the front's ranges over the box's width; infinite where steps could not begin.
    pub residual: f64,
    /// The multipliers of the objectives, each by its range, summing to one. Divided by the ranges their ratios are what one objective costs
    /// in units of another.
    pub shares: Vec<f64>,
    /// Why the steps ended.
    pub ended: Ended,
}

/// A refined front.
#[derive(Clone, Debug, PartialEq)]
pub struct RefinedFront {
    /// The designs, by their first objective; none dominates another.
    pub members: Vec<Refined>,
    /// Designs evaluated.
    pub evaluations: usize,
    /// The largest residual of those whose steps began.
    pub residual: f64,
    /// [`Ended::Converged`] where all were refined.
    pub ended: Ended,
    /// From where its ends were sought.
    pub ends_from: EndsFrom,
}

/// From where the ends of a front were sought.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum EndsFrom {
    /// From its own designs alone.
    Own,
    /// From some that were known, too.
    Known,
    /// From the best of samples all over the box, too, but further ones are expected to lead elsewhere.
    SomeSamples,
    /// From the best of samples all over the box, too, until hardly any was expected to lead elsewhere.
    Samples,
}

impl RefinedFront {
    /// What is left of some designs where none dominates or repeats another.
    pub(crate) fn of(members: Vec<Refined>, evaluations: usize, ended: Ended) -> Self {
        let members = undominated(members);
        let residuals = members.iter().map(|m| m.residual);
        Self {
            residual: residuals.filter(|r| r.is_finite()).fold(0.0, f64::max),
            members,
            evaluations,
            ended,
            ends_from: EndsFrom::Own,
        }
    }
}

/// From the least to the largest value of every objective; one where that is nothing.
pub(crate) fn ranges<'a>(
    all: impl Iterator<Item = &'a Candidate> + Clone,
    objectives: usize,
) -> Vec<f64> {
    let range = |k: usize| {
        let values = all.clone().filter_map(|c| c.evaluation.objectives.get(k));
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
            (l.min(*v), h.max(*v))
        });
        sound_scale(high - low)
    };
    (0..objectives).map(range).collect()
}

/// What becomes of an objective on a way down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// It is among those of which the largest change is minimised.
    Lessened,
    /// It may not rise over its target.
    Kept,
    /// It may be anything, and is lessened when those that are lessened now can fall no more.
    Free,
    /// The largest change of these is lessened beside what is lessened, with a little weight.
    Beside,
}

/// A way down.
pub(crate) struct Way {
    start: Vec<f64>,
    target: Vec<f64>,
    roles: Vec<Role>,
    to_end: bool,
    /// Where it led to, or what it refines.
    pub member: Option<Refined>,
    /// Whether the other objectives were not led to their least where that of an end is kept.
    pub is_open: bool,
    goes_on: bool,
    /// Whether it is over where what is lessened first is least.
    once: bool,
    /// Where it ends objectives may fall again that were kept on the way, when others had not fallen yet: all are lessened one by one at last. Those that are
    /// still to be.
    last: Option<Vec<usize>>,
}

impl Way {
    /// From a design to one that is no worse in any objective.
    pub fn of(candidate: &Candidate) -> Self {
        let target = candidate.evaluation.objectives.clone();
        let objectives = target.len();
        Self {
            member: Some(Refined {
                candidate: candidate.clone(),
                residual: f64::INFINITY,
                shares: vec![0.0; objectives],
                ended: Ended::Stopped,
            }),
            ..Self::towards(candidate.design.clone(), target)
        }
    }

    /// From a design to one that is as much better or worse in every objective than a target, by the front's ranges.
    pub fn towards(start: Vec<f64>, target: Vec<f64>) -> Self {
        Self {
            roles: vec![Role::Lessened; target.len()],
            start,
            target,
            to_end: false,
            member: None,
            is_open: false,
            goes_on: true,
            once: false,
            last: None,
        }
    }

    /// From a design to the least of one objective, and there to the least of the others.
    pub fn to_end(candidate: &Candidate, objective: usize) -> Self {
        let mut way = Self::towards(
            candidate.design.clone(),
            candidate.evaluation.objectives.clone(),
        );
        way.to_end = true;
        way.roles = vec![Role::Free; way.target.len()];
        way.roles[objective] = Role::Lessened;
        way
    }

    /// From where one objective alone is least, as steps ended there, to the least of the others.
    pub fn on_from(least: Refined, objective: usize) -> Self {
        let mut way = Self::to_end(&least.candidate, objective);
        for role in &mut way.roles {
            *role = match role {
                Role::Free => Role::Lessened,
                _ => Role::Kept,
            };
        }
        way.member = Some(least);
        way
    }

    /// From a design to the least of one objective alone.
    pub fn to_least(candidate: &Candidate, objective: usize) -> Self {
        Self {
            once: true,
            ..Self::to_end(candidate, objective)
        }
    }

    /// From the least of one objective to where the others are less and it is hardly more.
    pub fn beside(candidate: &Candidate, objective: usize) -> Self {
        let mut way = Self::to_end(candidate, objective);
        for role in &mut way.roles {
            if *role == Role::Free {
                *role = Role::Beside;
            }
        }
        way
    }

    /// Takes over where steps led to, and says which objectives are lessened next.
    fn take(
        &mut self,
        problem: &dyn Problem,
        ranges: &[f64],
        found: Optimum,
        options: &SqpOptions,
    ) {
        self.goes_on = false;
        // The problem's own values there, and whose pieces the multipliers are.
        let evaluation = problem::evaluate(problem, &found.design);
        let slopes = problem::slopes(problem, &found.design);
        let first = self.roles.iter().all(|role| *role != Role::Kept);
        let usable = found.violation <= options.feasibility && evaluation.is_defined();
        let both = self.target.iter().zip(&evaluation.objectives).zip(ranges);
        let falls: Vec<f64> = both
            .map(|((before, now), range)| (before - now) / range)
            .collect();
        let most = falls.iter().copied().fold(0.0, f64::max);
        if self.roles.contains(&Role::Beside) {
            let least = falls.iter().copied().fold(f64::INFINITY, f64::min);
            if usable && least >= -SAME[0] && most > WORTH {
                let shares = self.roles.iter().map(|role| match role {
                    Role::Lessened => 1.0,
                    _ => 0.0,
                });
                self.member = Some(Refined {
                    shares: shares.collect(),
                    candidate: Candidate {
                        design: found.design,
                        evaluation,
                    },
                    residual: found.residual,
                    ended: found.ended,
                });
            }
            return;
        }
        // What is kept may have its least value along a way or at one place: conditions of first order then say nothing of the others.
        self.is_open = self.to_end && !first && !found.ended.is_optimal();
        let (true, Some(slopes)) = (usable, slopes) else {
            match &mut self.member {
                // Where steps end is worth a place though nothing of first order is known there, as at a change point.
                member if usable && worth(member.as_ref(), &evaluation) => {
                    *member = Some(Refined {
                        candidate: Candidate {
                            design: found.design,
                            evaluation,
                        },
                        residual: f64::INFINITY,
                        shares: vec![0.0; self.roles.len()],
                        ended: found.ended,
                    });
                }
                Some(member) if first => member.ended = found.ended,
                _ => {}
            }
            return;
        };
        let rises = falls.iter().map(|fall| -fall).fold(0.0, f64::max);
        let by_tolerance = most <= BY_TOLERANCE && rises > PROPER * most;
        // Of two objectives the end is where the one is least.
        let is_there = self.to_end && !first && self.roles.len() == 2 && by_tolerance;
        if self.is_open && most <= SOMETHING || is_there {
            return;
        }
        if self.last.is_some() && most <= SOMETHING {
            self.lessen_last();
            return;
        }
        let mut pieces = found.multipliers.objectives.iter().flatten();
        let mut shares = vec![0.0; self.roles.len()];
        for (k, own) in slopes.objectives.iter().enumerate() {
            if self.roles[k] == Role::Lessened {
                shares[k] = pieces.by_ref().take(own.len()).sum();
            }
        }
        let before = self.member.take().filter(|_| !first);
        self.target.clone_from(&evaluation.objectives);
        self.start.clone_from(&found.design);
        self.member = Some(Refined {
            shares: before.map_or(shares.clone(), |before| before.shares),
            candidate: Candidate {
                design: found.design,
                evaluation,
            },
            residual: found.residual,
            ended: found.ended,
        });
        let held = self.roles.iter().zip(&shares);
        let mut held = held.filter(|(role, share)| **role == Role::Lessened && **share > NOTHING);
        let moves = held.next().is_some();
        for (role, share) in self.roles.iter_mut().zip(&shares) {
            *role = match role {
                Role::Lessened if *share <= NOTHING => Role::Lessened,
                Role::Free => Role::Lessened,
                Role::Lessened | Role::Kept => Role::Kept,
                Role::Beside => Role::Beside,
            };
        }
        let left = self.roles.contains(&Role::Lessened);
        self.goes_on = left && moves && !self.once && found.ended != Ended::Stopped;
        if !left && found.ended != Ended::Stopped {
            // Of two objectives the one was lessened after the other.
            if self.last.is_none() && !first && self.roles.len() > 2 {
                self.last = Some((0..self.roles.len()).collect());
            }
            self.lessen_last();
        }
    }

    /// Goes on with the next of those that are lessened at last, all others kept.
    fn lessen_last(&mut self) {
        if let Some(next) = self.last.as_mut().and_then(Vec::pop) {
            self.roles.fill(Role::Kept);
            self.roles[next] = Role::Lessened;
            self.goes_on = true;
        }
    }
}

/// Whether a design is worth the place of what a way has: where there is nothing, or it is better.
fn worth(member: Option<&Refined>, evaluation: &Evaluation) -> bool {
    let better =
        |m: &Refined| dominates(&evaluation.objectives, &m.candidate.evaluation.objectives);
    member.is_none_or(better)
}

/// Goes all ways to their ends, side by side; options hold for every descent of every way, and all together evaluate so many designs at most. How many
/// were evaluated before is told besides. The answer is how many these are now, and why it ended.
pub(crate) fn go(
    problem: &dyn Problem,
    ways: &mut [Way],
    ranges: &[f64],
    (options, budget, before): (&SqpOptions, usize, usize),
    workers: &dyn Workers,
    hears: Hears,
) -> (usize, Ended) {
    let (mut evaluations, mut ended) = (before, Ended::Converged);
    let options = &SqpOptions {
        // Changes are parts of the front's ranges, and begin at nothing: scales stay as they are.
        typical: Some(Scales::default()),
        ..options.clone()
    };
    let all = budget.min(before + ways.len() * options.evaluations);
    let mut was_cut = false;
    loop {
        let mut asked: Vec<usize> = (0..ways.len()).filter(|k| ways[*k].goes_on).collect();
        if asked.is_empty() || ended == Ended::Stopped {
            break;
        }
        // One at least is evaluated where each begins, and one where it ends.
        let most = budget.saturating_sub(evaluations) / 2;
        if most == 0 {
            ended = Ended::Budget;
            break;
        }
        for k in asked.split_off(most.min(asked.len())) {
            ways[k].goes_on = false;
            was_cut = true;
        }
        let scalarised = asked.iter().map(|k| Scalarised {
            target: ways[*k].target.clone(),
            ranges: ranges.to_vec(),
            roles: ways[*k].roles.clone(),
            problem,
        });
        let scalarised: Vec<Scalarised> = scalarised.collect();
        let starts = asked.iter().zip(&scalarised).map(|(k, own)| {
            let own: &dyn Problem = own;
            (own, ways[*k].start.clone())
        });
        let left = budget.saturating_sub(evaluations + asked.len());
        let found = side_by_side(starts.collect(), (options, left), workers, &mut |going| {
            let told = hears(&Progress {
                evaluations: evaluations + going.iter().map(Going::evaluations).sum::<usize>(),
                budget: all,
                best: None,
                violation: 0.0,
            });
            if told.is_break() {
                ended = Ended::Stopped;
            }
            told
        });
        for (k, optimum) in asked.into_iter().zip(found) {
            evaluations += optimum.evaluations + 1;
            was_cut |= optimum.ended == Ended::Budget && optimum.evaluations < options.evaluations;
            ways[k].take(problem, ranges, optimum, options);
        }
    }
    match ended {
        Ended::Converged if was_cut => (evaluations, Ended::Budget),
        ended => (evaluations, ended),
    }
}

/// Objectives by their ranges from a target: the largest of some is minimised, others may not rise.
struct Scalarised<'a> {
    problem: &'a dyn Problem,
    target: Vec<f64>,
    ranges: Vec<f64>,
    roles: Vec<Role>,
}

impl Scalarised<'_> {
    fn kept(&self) -> usize {
        self.roles.iter().filter(|r| **r == Role::Kept).count()
    }
}

impl Problem for Scalarised<'_> {
    fn bounds(&self) -> &[[f64; 2]] {
        self.problem.bounds()
    }

    fn constraints(&self) -> usize {
        self.problem.constraints() + self.kept()
    }

    fn scales(&self) -> Option<Scales> {
        let mut scales = self.problem.scales()?;
        scales.objectives = vec![1.0];
        scales.constraints.extend(vec![1.0; self.kept()]);
        Some(scales)
    }

    fn least_of(&self, constraint: usize) -> f64 {
        match constraint < self.problem.constraints() {
            true => self.problem.least_of(constraint),
            false => f64::NEG_INFINITY,
        }
    }

    fn evaluate(&self, design: &[f64]) -> Evaluation {
        let mut evaluation = problem::evaluate(self.problem, design);
        if !evaluation.is_defined() {
            return evaluation;
        }
        let (mut largest, mut beside) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
        for (k, value) in evaluation.objectives.iter().enumerate() {
            let change = (value - self.target[k]) / self.ranges[k];
            match self.roles[k] {
                Role::Lessened => largest = largest.max(change),
                Role::Kept => evaluation.constraints.push(change),
                Role::Beside => beside = beside.max(change),
                Role::Free => {}
            }
        }
        if beside > f64::NEG_INFINITY {
            largest += TILT * beside;
        }
        evaluation.objectives = vec![largest];
        evaluation
    }

    fn slopes(&self, design: &[f64]) -> Option<Slopes> {
        let mut slopes = self.problem.slopes(design)?;
        let (mut pieces, mut beside) = (Vec::new(), Vec::new());
        for (k, own) in slopes.objectives.drain(..).enumerate() {
            let (target, range) = (self.target[k], self.ranges[k]);
            let changed = own.into_iter().map(|p| Piece {
                value: (p.value - target) / range,
                slope: p.slope.into_iter().map(|g| g / range).collect(),
            });
            match self.roles[k] {
                Role::Lessened => pieces.extend(changed),
                Role::Kept => slopes.constraints.push(changed.collect()),
                Role::Beside => beside.extend(changed),
                Role::Free => {}
            }
        }
        if !beside.is_empty() {
            let both = |a: &Piece| {
                let a = a.clone();
                beside.iter().map(move |b| Piece {
                    value: a.value + TILT * b.value,
                    slope: (a.slope.iter().zip(&b.slope))
                        .map(|(x, y)| x + TILT * y)
                        .collect(),
                })
            };
            pieces = pieces.iter().flat_map(both).collect();
        }
        slopes.objectives = vec![pieces];
        Some(slopes)
    }
}

/// How far values of such a size may be apart, of a front with such a range, and be the same.
fn same(range: f64, size: f64) -> f64 {
    let [of_both, of_size, of_range] = SAME;
    (of_both * range.min(size))
        .max(of_size * size)
        .max(of_range * range)
}

/// Those that no other betters or repeats, by their first objective. Of designs that differ by nothing that counts the first stays, and one of which
/// something of first order is known rather than another.
pub fn undominated(mut members: Vec<Refined>) -> Vec<Refined> {
    let count = (members.iter())
        .map(|m| m.candidate.evaluation.objectives.len())
        .min();
    let ranges = ranges(members.iter().map(|m| &m.candidate), count.unwrap_or(0));
    // Whether the one betters the other, or repeats an earlier one.
    let replaces = |one: &Refined, other: &Refined, earlier: bool| {
        // By how much the one is worse at most.
        let worse = |a: &Refined, b: &Refined| {
            let [a, b] = [a, b].map(|m| &m.candidate.evaluation.objectives);
            let all = a.iter().zip(b).zip(&ranges);
            let lost = all.map(|((a, b), range)| {
                let lost = a - b;
                let counts = lost > same(*range, a.abs().max(b.abs()));
                if counts { lost / range } else { 0.0 }
            });
            lost.fold(0.0, f64::max)
        };
        let [own, others] = [worse(one, other), worse(other, one)];
        match (own > PROPER * others, others > 0.0) {
            (true, _) => false,
            (false, true) => true,
            (false, false) => {
                let known = [one, other].map(|m| m.residual.is_finite());
                known[0] && !known[1] || known[0] == known[1] && earlier
            }
        }
    };
    let mut stays = vec![true; members.len()];
    for k in 0..members.len() {
        stays[k] = !(0..members.len())
            .any(|j| j != k && stays[j] && replaces(&members[j], &members[k], j < k));
    }
    let mut each = stays.into_iter();
    members.retain(|_| each.next().unwrap_or(true));
    members.sort_by(|a, b| {
        let [a, b] = [a, b].map(|m| &m.candidate.evaluation.objectives);
        let orders = a.iter().zip(b).map(|(x, y)| x.total_cmp(y));
        orders.fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
    });
    members
}
