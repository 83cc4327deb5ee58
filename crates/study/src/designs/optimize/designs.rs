//! Designs of a study: parameters in a box, numbers on the bench, and what these are worth.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use kempe_model::{Among, OptimizeStudy, StudyKind};
use kempe_number::math;
use kempe_optimize::Evaluation;

use super::choices::{choices, ranges};
use super::fit::{Fitted, Pairing};
use super::journal::{Journal, lock};
use super::least::least;
use super::pieces::Wanted;
use super::several::Several;
use super::worth::Aims;
use crate::designs::asked::kept;
use crate::designs::bench::{Bench, Refused};

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
    /// What is wanted of them.
    pub(super) aims: Aims,
    /// What is fitted; its sum of squares stands in the place of the one goal.
    pub(super) fit: Option<Fitted<'b, 'm>>,
    /// What the largest of the goals cannot be below.
    pub(super) least: f64,
    /// What each of the limits cannot be below.
    pub(super) leasts: Vec<f64>,
    pub(super) bounds: Vec<[f64; 2]>,
    /// The least and the greatest value of every parameter, SI.
    ranges: Vec<[f64; 2]>,
    /// Whether a variable is the logarithm of its parameter.
    logs: Vec<bool>,
    /// The values of parameters that have some alone; none of the others.
    choices: Vec<Vec<f64>>,
    /// Whether designs that stand alone are refused.
    pub(super) no_alone: bool,
    /// Whether derivatives are differences.
    pub differences: bool,
    /// What tells many designs at once, where it can.
    pub(super) several: Option<Several>,
    /// What was asked before, and what was asked since.
    pub(super) journal: Journal,
    /// The nearest of the designs that cannot be asked.
    nearest: Mutex<Option<Nearest>>,
    /// The least size of each goal at any design that has one.
    pub(super) least_sizes: Mutex<Vec<f64>>,
    pub(super) asked: AtomicUsize,
    pub(super) sloped: AtomicUsize,
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
            aims: Aims { wanted, goals },
            fit: None,
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
        let mut numbers = match self.aims.wanted.len() {
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
            Ok((numbers, crosses)) => (self.aims.worth(&numbers), crosses),
            Err(Refused { lack, why }) => ((Evaluation::lacking(lack), Some(why)), false),
        }
    }

    /// Remembers why a design cannot be asked, if none was nearer.
    pub(super) fn refuse(&self, values: &[f64], lack: f64, why: &str) {
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

    /// Takes up what goals are at a design, so that it is known how much larger they are at others.
    pub fn take_up(&self, goals: &[f64]) {
        for (least, goal) in lock(&self.least_sizes).iter_mut().zip(goals) {
            *least = least.min(goal.abs());
        }
    }
}
