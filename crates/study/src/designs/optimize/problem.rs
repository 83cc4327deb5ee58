//! What is optimised, as the methods see it: parameters in a box, numbers of designs on the bench.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use kempe_measure::measure::visit_parts;
use kempe_model::{Among, Measure, Model, OptimizeStudy, StudyKind};
use kempe_number::math;
use kempe_optimize::{Evaluation, Piece, Problem, Slopes, Workers, each};
use kempe_units::{Builtin, Expr};

use super::alone::{ALONE, NEXT_TO};
use super::choices::{choices, ranges};
use super::fit::{Fitted, Pairing, sum};
use super::journal::{Journal, SUMS, lock};
use super::least::least;
use super::pieces::{Wanted, pieces};
use super::several::Several;
use crate::designs::asked::kept;
use crate::designs::bench::{Bench, Refused};
use crate::quantity::Quantity;

/// A goal that is so many times as much as at the first of these parts of the bounds beside its design, and there as at the next, has no bound.
const AWAY: [f64; 3] = [1e-6, 1e-4, 1e-2];
/// ... and of a design that is beside the edge of what can be asked.
const AWAY_FROM_EDGE: [f64; 3] = [2e-5, 1e-3, 2e-2];
const GROWS: f64 = 3.0;
/// Parts of the bounds at which a goal is looked at that may fall without end, the least part of itself by which it falls from the first to the second, and
/// by what part of that from there to the third.
const BESIDES: [f64; 3] = [1e-3, 1e-6, 1e-9];
const FALLS: f64 = 1e-6;
const GOES_ON: f64 = 0.9;
/// Only where the goal is so many times that of the design where it is nearest to nothing, a pole is looked for.
const LARGE: f64 = 1e6;

/// A design that cannot be asked, and why.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Nearest {
    /// How far it is from one that can.
    lack: f64,
    /// The values of its parameters, SI.
    pub values: Vec<f64>,
    /// Why.
    pub why: String,
}

/// Designs of a study as a problem. Its variables are the parameters, SI, or their logarithms.
pub(in crate::designs) struct Designs<'b, 'm> {
    pub bench: &'b Bench<'m>,
    /// What is to be small or large, then what must be kept.
    pub wanted: Vec<Wanted>,
    /// What is fitted; its sum of squares stands in the place of the one goal.
    pub(super) fit: Option<Fitted<'b, 'm>>,
    goals: usize,
    /// What the largest of the goals cannot be below.
    least: f64,
    /// What each of the limits cannot be below.
    leasts: Vec<f64>,
    bounds: Vec<[f64; 2]>,
    /// The least and the greatest value of every parameter, SI.
    ranges: Vec<[f64; 2]>,
    /// Whether a variable is the logarithm of its parameter.
    logs: Vec<bool>,
    /// The values of parameters that have some alone; none of the others.
    choices: Vec<Vec<f64>>,
    /// Whether designs that stand alone are refused.
    no_alone: bool,
    /// Whether derivatives are differences.
    pub differences: bool,
    /// What tells many designs at once, where it can.
    pub(super) several: Option<Several>,
    /// What was asked before, and what was asked since.
    pub(super) journal: Journal,
    /// The nearest of the designs that cannot be asked.
    nearest: Mutex<Option<Nearest>>,
    /// The least size of each goal at any design that has one.
    least_sizes: Mutex<Vec<f64>>,
    asked: AtomicUsize,
    sloped: AtomicUsize,
}

impl<'b, 'm> Designs<'b, 'm> {
    /// The problem of a study; the numbers of its bench are the goals and then what is kept.
    pub fn new(bench: &'b Bench<'m>, study: &OptimizeStudy) -> Self {
        let (model, mechanism) = (bench.model, bench.mechanism());
        let goals = study.goals.iter().zip(&bench.numbers);
        let goals = goals.map(|(goal, number)| {
            let sign = if goal.maximize { -1.0 } else { 1.0 };
            Wanted::new(mechanism, number.clone(), sign)
        });
        let limits = study.subject_to.iter();
        let limits = limits.map(|limit| Wanted::new(mechanism, kept(model, limit), -1.0));
        let wanted = goals.chain(limits).collect();
        let ranges = ranges(model, study);
        let logs: Vec<bool> = (study.vary.iter())
            .map(|chosen| matches!(chosen.among, Among::Factors(_)))
            .collect();
        let bounds = ranges.iter().zip(&logs);
        let bounds = bounds.map(|(range, log)| range.map(|x| if *log { math::ln(x) } else { x }));
        Self {
            bounds: bounds.collect(),
            choices: (study.vary.iter())
                .map(|chosen| choices(model, &chosen.among))
                .collect(),
            logs,
            no_alone: true,
            fit: study.fit.as_ref().map(|fit| Fitted::new(bench, fit)),
            ..Self::within(bench, wanted, study.goals.len(), ranges)
        }
    }

    /// Designs within ranges of the bench's parameters, SI; the first ones of what is wanted are goals, the rest must be kept.
    pub fn within(
        bench: &'b Bench<'m>,
        wanted: Vec<Wanted>,
        goals: usize,
        ranges: Vec<[f64; 2]>,
    ) -> Self {
        let least = |it: &Wanted| least(bench.mechanism(), &it.number.measure, it.sign);
        let leasts = wanted.iter().skip(goals).map(least).collect();
        let least = (wanted.iter().take(goals).map(least)).fold(f64::NEG_INFINITY, f64::max);
        Self {
            bench,
            wanted,
            fit: None,
            goals,
            least,
            leasts,
            bounds: ranges.clone(),
            logs: vec![false; ranges.len()],
            choices: vec![Vec::new(); ranges.len()],
            ranges,
            no_alone: false,
            differences: matches!(bench.over.kind, StudyKind::Simulate(_)),
            several: None,
            journal: Journal::default(),
            nearest: Mutex::new(None),
            least_sizes: Mutex::new(vec![f64::INFINITY; goals]),
            asked: AtomicUsize::new(0),
            sloped: AtomicUsize::new(0),
        }
    }

    /// The least and the greatest value of every parameter, SI.
    pub fn ranges(&self) -> &[[f64; 2]] {
        &self.ranges
    }

    /// Designs that were asked for their numbers, for derivatives by differences besides.
    pub fn asked(&self) -> usize {
        self.asked.load(Ordering::Relaxed)
    }

    /// Designs that were asked for derivatives.
    pub fn sloped(&self) -> usize {
        self.sloped.load(Ordering::Relaxed)
    }

    /// Counts designs that were asked for their numbers, and for derivatives.
    pub fn count(&self, asked: usize, sloped: usize) {
        self.asked.fetch_add(asked, Ordering::Relaxed);
        self.sloped.fetch_add(sloped, Ordering::Relaxed);
    }

    /// The nearest of the designs that cannot be asked; where two are as near, the one of the least values.
    pub(super) fn nearest(&self) -> Option<Nearest> {
        lock(&self.nearest).clone()
    }

    /// Whether each variable may be anything between its bounds.
    pub fn are_free(&self) -> impl Iterator<Item = bool> {
        let all = self.bounds.iter().zip(&self.choices);
        all.map(|([low, high], choices)| low < high && choices.is_empty())
    }

    /// The parameters of a design, SI.
    pub fn values(&self, design: &[f64]) -> Vec<f64> {
        let all = design.iter().zip(&self.logs).zip(&self.ranges);
        all.map(|((x, log), [low, high])| match log {
            true => math::exp(*x).clamp(*low, *high),
            false => *x,
        })
        .collect()
    }

    /// The design of these parameters.
    pub fn variables(&self, values: &[f64]) -> Vec<f64> {
        let all = values.iter().zip(&self.logs).zip(&self.ranges);
        all.map(|((x, log), [low, high])| match log {
            true => math::ln(x.clamp(*low, *high)),
            false => *x,
        })
        .collect()
    }

    /// By how much each parameter grows with its variable.
    pub fn growth(&self, values: &[f64]) -> Vec<f64> {
        let all = values.iter().zip(&self.logs);
        all.map(|(x, log)| if *log { *x } else { 1.0 }).collect()
    }

    /// The numbers of parameters, SI, that of the fit in its place, and whether branches cross on the way.
    fn numbers(&self, values: &[f64], pairing: Pairing) -> Result<(Vec<f64>, bool), Refused> {
        let Some(fit) = &self.fit else {
            let answer = self.bench.answer(values)?;
            return Ok((answer.numbers, answer.crosses));
        };
        let seen = fit.seen_as(values, pairing)?;
        let mut numbers = match self.wanted.len() {
            1 => vec![f64::NAN],
            _ => self.bench.answer_of(seen.motion())?.numbers,
        };
        numbers[0] = seen.met.square();
        Ok((numbers, seen.crosses()))
    }

    /// What parameters are worth, SI, or why nothing; and whether branches cross on the way.
    pub fn told(&self, values: &[f64]) -> ((Evaluation, Option<String>), bool) {
        self.told_as(values, Pairing::Asked)
    }

    /// The same where places of a fit are paired as said.
    pub(super) fn told_as(
        &self,
        values: &[f64],
        pairing: Pairing,
    ) -> ((Evaluation, Option<String>), bool) {
        match self.numbers(values, pairing) {
            Ok((numbers, crosses)) => (self.worth(&numbers), crosses),
            Err(Refused { lack, why }) => ((Evaluation::lacking(lack), Some(why)), false),
        }
    }

    /// What parameters are worth, SI, to choose among designs: those that stand alone are refused.
    pub fn look(&self, values: &[f64]) -> (Evaluation, Option<String>) {
        let (told, crosses) = self.told(values);
        let may_be = crosses && self.no_alone && told.1.is_none();
        match may_be && self.stands_alone(values, &told.0) {
            true => (Evaluation::lacking(NEXT_TO), Some(ALONE.to_owned())),
            false => told,
        }
    }

    /// What numbers are worth.
    pub fn worth(&self, numbers: &[f64]) -> (Evaluation, Option<String>) {
        if let Some(k) = numbers.iter().position(|x| !x.is_finite()) {
            let why = format!("`{}` has no finite value", self.wanted[k].number.name);
            return (Evaluation::lacking(1.0), Some(why));
        }
        let signed = numbers.iter().zip(&self.wanted).map(|(x, w)| w.sign * x);
        let mut objectives: Vec<f64> = signed.collect();
        let constraints = objectives.split_off(self.goals);
        let evaluation = Evaluation {
            objectives,
            constraints,
            lack: 0.0,
        };
        (evaluation, None)
    }

    /// Whether a goal, found here, is so good only for a pole: towards it, it grows and grows. Where a limit keeps it from going on that is
    /// told only of what is large beyond measure.
    pub fn is_pole(
        &self,
        design: &[f64],
        (which, goal): (usize, f64),
        (limited, at_edge): (bool, bool),
    ) -> bool {
        let times = if limited { LARGE } else { GROWS };
        let least = lock(&self.least_sizes).get(which).copied();
        if !least.is_some_and(|least| goal < 0.0 && -goal > times * least) {
            return false;
        }
        let beside = |(k, [low, high]): (usize, &[f64; 2])| {
            [-1.0, 1.0].into_iter().any(|side| {
                let mut nearer = -goal;
                let away = if at_edge { AWAY_FROM_EDGE } else { AWAY };
                away.iter().all(|part| {
                    let by = side * part * (high - low);
                    let there = self.goal_beside(design, which, (k, by));
                    let grows = GROWS * there.abs() < nearer;
                    nearer = there.abs();
                    grows
                })
            })
        };
        self.bounds.iter().enumerate().any(beside)
    }

    /// A goal of a design that differs by so much in a variable, within its bounds.
    fn goal_beside(&self, design: &[f64], which: usize, (variable, by): (usize, f64)) -> f64 {
        let mut moved = design.to_vec();
        let [low, high] = self.bounds[variable];
        moved[variable] = (design[variable] + by).clamp(low, high);
        let (evaluation, _) = self.look(&self.values(&moved));
        let goal = evaluation.objectives.get(which);
        goal.copied().unwrap_or(f64::NAN)
    }

    /// Whether a goal goes on falling towards a design, found here, by as much from a thousandth to a millionth of the bounds beside it as from there to
    /// a billionth: as a logarithm falls at zero, which is never large.
    pub fn falls_on(&self, design: &[f64], (which, goal): (usize, f64)) -> bool {
        let wanted = self.wanted.get(which);
        if which >= self.goals
            || !wanted.is_some_and(|it| asks_logarithm(self.bench.model, &it.number.measure))
        {
            return false;
        }
        let beside = |(k, [low, high]): (usize, &[f64; 2])| {
            [-1.0, 1.0].into_iter().any(|side| {
                let goals = BESIDES
                    .map(|part| self.goal_beside(design, which, (k, side * part * (high - low))));
                let [first, second] = [goals[0] - goals[1], goals[1] - goals[2]];
                first > FALLS * goal.abs() && second > GOES_ON * first
            })
        };
        self.bounds.iter().enumerate().any(beside)
    }

    /// Remembers why a design cannot be asked, if none was nearer.
    fn refuse(&self, values: &[f64], lack: f64, why: &str) {
        // What lies between values of a catalogue is on the way to them alone.
        let chosen = |(x, all): (&f64, &Vec<f64>)| all.is_empty() || all.contains(x);
        if !values.iter().zip(&self.choices).all(chosen) {
            return;
        }
        let mut nearest = lock(&self.nearest);
        let order = |a: &[f64], b: &[f64]| {
            let orders = a.iter().zip(b).map(|(x, y)| x.total_cmp(y));
            orders.fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
        };
        let nearer = nearest.as_ref().is_none_or(|other| {
            let by_lack = lack.total_cmp(&other.lack);
            by_lack.then_with(|| order(values, &other.values)).is_lt()
        });
        if nearer {
            *nearest = Some(Nearest {
                lack,
                values: values.to_vec(),
                why: why.to_owned(),
            });
        }
    }

    /// What parameters are worth, SI, as far as it was not asked before.
    fn evaluate_values(&self, values: &[f64]) -> Evaluation {
        let told = (self.journal).evaluation(SUMS, values, || self.look(values));
        self.heard(values, told)
    }

    /// Takes up what parameters are worth.
    fn heard(&self, values: &[f64], (evaluation, why): (Evaluation, Option<String>)) -> Evaluation {
        if self.bench.watch().stops() {
            return Evaluation::lacking(f64::INFINITY);
        }
        match (why, evaluation.objectives.as_slice()) {
            (Some(why), _) => self.refuse(values, evaluation.lack, &why),
            (None, goals) => self.take_up(goals),
        }
        evaluation
    }

    /// Takes up what goals are at a design, so that it is known how much larger they are at others.
    pub fn take_up(&self, goals: &[f64]) {
        for (least, goal) in lock(&self.least_sizes).iter_mut().zip(goals) {
            *least = least.min(goal.abs());
        }
    }

    /// Pieces of some of what is wanted at a design, with derivatives to the parameters: exact where there are such.
    fn pieces(&self, wanted: &[Wanted], values: &[f64]) -> Option<Vec<Vec<Piece>>> {
        let differences = |quantities: &[&Quantity]| self.differences(values, quantities);
        pieces(self.bench, wanted, values, &differences).ok()
    }

    /// Pieces of what must be kept beside a fit, with derivatives to the parameters.
    pub fn limits(&self, values: &[f64]) -> Option<Vec<Vec<Piece>>> {
        match self.wanted.get(self.goals..) {
            Some(limits) if !limits.is_empty() => self.pieces(limits, values),
            _ => Some(Vec::new()),
        }
    }

    /// Pieces with derivatives to the variables, exact where there are such.
    fn exact(&self, values: &[f64]) -> Option<Vec<Vec<Piece>>> {
        let mut all = match &self.fit {
            None => self.pieces(&self.wanted, values)?,
            Some(_) => {
                let residuals = self.residuals(values, Pairing::Asked)?;
                [vec![vec![sum(&residuals)]], self.limits(values)?].concat()
            }
        };
        let growth = self.growth(values);
        for piece in all.iter_mut().flatten() {
            let slope = piece.slope.iter_mut().zip(&growth);
            slope.for_each(|(d, growth)| *d *= growth);
        }
        Some(all)
    }
}

impl Problem for Designs<'_, '_> {
    fn bounds(&self) -> &[[f64; 2]] {
        &self.bounds
    }

    fn objectives(&self) -> usize {
        self.goals
    }

    fn constraints(&self) -> usize {
        self.wanted.len() - self.goals
    }

    fn least(&self) -> f64 {
        self.least
    }

    fn least_of(&self, constraint: usize) -> f64 {
        self.leasts[constraint]
    }

    fn evaluate(&self, design: &[f64]) -> Evaluation {
        self.asked.fetch_add(1, Ordering::Relaxed);
        self.evaluate_values(&self.values(design))
    }

    fn exactly(&self, design: &[f64]) -> Option<Evaluation> {
        let several = self.several.is_some();
        several.then(|| self.evaluate_values(&self.values(design)))
    }

    fn nearly(&self, designs: &[Vec<f64>], workers: &dyn Workers) -> Vec<Evaluation> {
        self.asked.fetch_add(designs.len(), Ordering::Relaxed);
        let values: Vec<Vec<f64>> = designs.iter().map(|design| self.values(design)).collect();
        let told = match &self.several {
            Some(several) => several.numbers(self, &values, workers),
            None => vec![None; values.len()],
        };
        let all = values.iter().zip(&told).collect();
        each(
            workers,
            all,
            |(values, told): (&Vec<f64>, &Option<_>)| match told {
                Some(numbers) => self.heard(values, self.worth(numbers)),
                None => self.evaluate_values(values),
            },
        )
    }

    fn slopes(&self, design: &[f64]) -> Option<Slopes> {
        self.sloped.fetch_add(1, Ordering::Relaxed);
        let values = self.values(design);
        if self.differences {
            let moved = self.bounds.iter().filter(|[low, high]| high > low);
            self.asked.fetch_add(2 * moved.count(), Ordering::Relaxed);
        }
        self.journal.slopes(SUMS, &values, || {
            let mut objectives = match self.differences {
                true => self.by_differences(design)?,
                false => self.exact(&values)?,
            };
            let constraints = objectives.split_off(self.goals);
            Some(Slopes {
                objectives,
                constraints,
            })
        })
    }
}

/// Whether there is a logarithm in a measure, or in those that it names.
fn asks_logarithm(model: &Model, measure: &Measure) -> bool {
    let mut asks = false;
    visit_parts(model, measure, &mut |part| {
        asks |= matches!(part, Expr::Call(Builtin::Ln, _));
    });
    asks
}
