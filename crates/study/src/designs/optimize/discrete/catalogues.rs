//! Values of catalogues: their combinations, those next to a design, and the problem with some of them held.

use kempe_model::{Model, OptimizeStudy, StudyKind};
use kempe_optimize::{Evaluation, Problem, Slopes, Workers};

use super::super::choices::choices;
use super::super::designs::Designs;
use crate::designs::over::study_of;

/// So many combinations are tried one by one; of simulations, which take longer, so many.
const MOST_TRIED: usize = 50_000;
const MOST_SIMULATED: usize = 2000;
/// So many combinations of neighbours are tried about one design.
const MOST_NEIGHBOURS: usize = 64;
/// So few combinations are all searched from all over the box, whatever their neighbours are.
pub(super) const EACH: usize = 8;
/// Where no neighbour keeps all limits, so many combinations at most are searched from all over the box.
pub(super) const ANEW: usize = 16;

/// Values of catalogues.
pub(in super::super) struct Catalogues {
    /// By parameter; of those that may have any value none.
    pub(super) values: Vec<Vec<f64>>,
}

/// A combination of values of the catalogues: the problem with them held, and designs with them from which others are found.
pub(in super::super) type Combination<'p, 'b, 'm> = (Held<'p, 'b, 'm>, Vec<Vec<f64>>);

impl Catalogues {
    /// Of a study; `None` where no parameter is discrete.
    pub fn of(problem: &Designs<'_, '_>, study: &OptimizeStudy) -> Option<Self> {
        let values = values_of(problem.bench.model, study);
        (!values.iter().all(Vec::is_empty)).then_some(Self { values })
    }

    /// The file's own design, between the bounds and with the nearest values.
    pub(super) fn own(&self, problem: &Designs<'_, '_>) -> Vec<f64> {
        let own = problem.variables(&problem.bench.own_values());
        let own = own.iter().zip(problem.bounds());
        let own: Vec<f64> = own.map(|(x, [low, high])| x.clamp(*low, *high)).collect();
        self.rounded(&own)
    }

    /// A design with the nearest values.
    pub fn rounded(&self, design: &[f64]) -> Vec<f64> {
        let nearest = |x: f64, all: &[f64]| {
            let near = neighbours(x, all).into_iter();
            near.min_by(|a, b| (a - x).abs().total_cmp(&(b - x).abs()))
        };
        let both = design.iter().zip(&self.values);
        both.map(|(x, all)| nearest(*x, all).unwrap_or(*x))
            .collect()
    }

    /// The combinations of values next to those of a design, with the design at each.
    pub(super) fn near<'p, 'b, 'm>(
        &self,
        problem: &'p Designs<'b, 'm>,
        design: &[f64],
    ) -> Vec<(Held<'p, 'b, 'm>, Vec<f64>)> {
        let near = design.iter().zip(&self.values);
        let near: Vec<Vec<f64>> = near.map(|(x, all)| neighbours(*x, all)).collect();
        let counts = near.iter().map(|n| n.len().max(1));
        let count = counts.product::<usize>().min(MOST_NEIGHBOURS);
        let one = |combination: usize| {
            let mut left = combination;
            let mut start = design.to_vec();
            for (k, near) in near.iter().enumerate().filter(|(_, near)| !near.is_empty()) {
                start[k] = near[left % near.len()];
                left /= near.len();
            }
            (self.held(problem, &start), start)
        };
        (0..count).map(one).collect()
    }

    /// Whether some parameters may have any value.
    pub fn leave_some_free(&self) -> bool {
        self.values.iter().any(Vec::is_empty)
    }

    /// All combinations, where there are so few that each is searched by itself; with each those of some designs that have its values.
    pub fn each<'p, 'b, 'm>(
        &self,
        problem: &'p Designs<'b, 'm>,
        designs: &[Vec<f64>],
    ) -> Option<Vec<Combination<'p, 'b, 'm>>> {
        if combinations(&self.values) > EACH {
            return None;
        }
        let all = self.all_held(problem).into_iter().map(|held| {
            let is_of = |other: &&Vec<f64>| self.held(problem, other).bounds == held.bounds;
            let own = designs.iter().filter(is_of).cloned().collect();
            (held, own)
        });
        Some(all.collect())
    }

    /// The problem with every combination of values held.
    pub(super) fn all_held<'p, 'b, 'm>(
        &self,
        problem: &'p Designs<'b, 'm>,
    ) -> Vec<Held<'p, 'b, 'm>> {
        let lows: Vec<f64> = problem.bounds().iter().map(|[low, _]| *low).collect();
        let all = self.everywhere(&lows);
        all.iter().map(|it| self.held(problem, it)).collect()
    }

    /// A design with every combination of values in its place.
    pub(super) fn everywhere(&self, design: &[f64]) -> Vec<Vec<f64>> {
        let one = |mut left: usize| {
            let mut design = design.to_vec();
            for (x, values) in design.iter_mut().zip(&self.values) {
                if !values.is_empty() {
                    *x = values[left % values.len()];
                    left /= values.len();
                }
            }
            design
        };
        (0..combinations(&self.values)).map(one).collect()
    }

    /// The combinations of designs that have values of the catalogues, in the order of the designs, and then those that differ from one of
    /// these by one step in one value.
    pub fn about<'p, 'b, 'm>(
        &self,
        problem: &'p Designs<'b, 'm>,
        designs: &[Vec<f64>],
    ) -> Vec<Combination<'p, 'b, 'm>> {
        let mut all: Vec<Combination> = Vec::new();
        let mut put = |start: Vec<f64>| {
            let held = self.held(problem, &start);
            match all
                .iter()
                .position(|(known, _)| known.bounds == held.bounds)
            {
                Some(place) => all[place].1.push(start),
                None if all.len() < MOST_NEIGHBOURS => all.push((held, vec![start])),
                None => {}
            }
        };
        designs.iter().cloned().for_each(&mut put);
        for design in designs {
            for (k, values) in self.values.iter().enumerate() {
                let Some(own) = values.iter().position(|value| *value == design[k]) else {
                    continue;
                };
                let steps = [own.checked_sub(1), Some(own + 1)].into_iter().flatten();
                for value in steps.filter_map(|k| values.get(k)) {
                    let mut start = design.clone();
                    start[k] = *value;
                    put(start);
                }
            }
        }
        all
    }

    /// The problem with a design's values of the catalogues held.
    pub(super) fn held<'p, 'b, 'm>(
        &self,
        problem: &'p Designs<'b, 'm>,
        design: &[f64],
    ) -> Held<'p, 'b, 'm> {
        let bounds = problem.bounds().iter().zip(design).zip(&self.values);
        let bounds = bounds.map(|((bounds, x), values)| match values.is_empty() {
            true => *bounds,
            false => [*x, *x],
        });
        Held {
            inner: problem,
            bounds: bounds.collect(),
        }
    }
}

/// A problem some of whose variables stand still.
pub(in super::super) struct Held<'p, 'b, 'm> {
    inner: &'p Designs<'b, 'm>,
    pub bounds: Vec<[f64; 2]>,
}

impl Problem for Held<'_, '_, '_> {
    fn bounds(&self) -> &[[f64; 2]] {
        &self.bounds
    }

    fn objectives(&self) -> usize {
        self.inner.objectives()
    }

    fn constraints(&self) -> usize {
        self.inner.constraints()
    }

    fn least(&self) -> f64 {
        self.inner.least()
    }

    fn least_of(&self, constraint: usize) -> f64 {
        self.inner.least_of(constraint)
    }

    fn evaluate(&self, design: &[f64]) -> Evaluation {
        self.inner.evaluate(design)
    }

    fn slopes(&self, design: &[f64]) -> Option<Slopes> {
        self.inner.slopes(design)
    }
}

/// A problem whose designs all have the nearest values of the catalogues.
pub(in super::super) struct Rounded<'p, 'b, 'm> {
    pub inner: &'p Designs<'b, 'm>,
    pub to: &'p Catalogues,
}

impl Problem for Rounded<'_, '_, '_> {
    fn bounds(&self) -> &[[f64; 2]] {
        self.inner.bounds()
    }

    fn objectives(&self) -> usize {
        self.inner.objectives()
    }

    fn constraints(&self) -> usize {
        self.inner.constraints()
    }

    fn least(&self) -> f64 {
        self.inner.least()
    }

    fn least_of(&self, constraint: usize) -> f64 {
        self.inner.least_of(constraint)
    }

    fn evaluate(&self, design: &[f64]) -> Evaluation {
        self.inner.evaluate(&self.to.rounded(design))
    }

    fn exactly(&self, design: &[f64]) -> Option<Evaluation> {
        self.inner.exactly(&self.to.rounded(design))
    }

    fn nearly(&self, designs: &[Vec<f64>], workers: &dyn Workers) -> Vec<Evaluation> {
        let rounded: Vec<Vec<f64>> = designs.iter().map(|it| self.to.rounded(it)).collect();
        self.inner.nearly(&rounded, workers)
    }

    fn slopes(&self, design: &[f64]) -> Option<Slopes> {
        self.inner.slopes(&self.to.rounded(design))
    }
}

/// How many combinations there are, where every parameter is discrete and there are few.
pub(super) fn few(values: &[Vec<f64>], model: &Model, study: &OptimizeStudy) -> Option<usize> {
    let mut lengths = values.iter().map(Vec::len);
    let count = lengths.try_fold(1_usize, usize::checked_mul)?;
    let over = study_of(model, &study.over).ok();
    let most = match over.map(|over| &over.kind) {
        Some(StudyKind::Simulate(_)) => MOST_SIMULATED,
        _ => MOST_TRIED,
    };
    let most = most.min(study.designs.unwrap_or(usize::MAX));
    (count > 0 && count <= most).then_some(count)
}

/// Whether values of a catalogue are found by rounding and are too many for all of their combinations to be tried where none of those keeps all limits.
pub(in super::super) fn is_rounded(model: &Model, study: &OptimizeStudy) -> bool {
    let values = values_of(model, study);
    are_some_chosen(model, study) && combinations(&values) > ANEW
}

/// Whether there are catalogues, and not all of their combinations are tried one by one.
pub(in super::super) fn are_some_chosen(model: &Model, study: &OptimizeStudy) -> bool {
    let values = values_of(model, study);
    values.iter().any(|list| !list.is_empty()) && few(&values, model, study).is_none()
}

/// The values of every parameter that is discrete; of the others none.
pub(super) fn values_of(model: &Model, study: &OptimizeStudy) -> Vec<Vec<f64>> {
    let all = study.vary.iter();
    all.map(|chosen| choices(model, &chosen.among)).collect()
}

/// How many combinations of values there are.
pub(super) fn combinations(values: &[Vec<f64>]) -> usize {
    let lengths = values.iter().map(|values| values.len().max(1));
    lengths.fold(1, usize::saturating_mul)
}

/// The values next below and above; none where any may be taken.
fn neighbours(x: f64, all: &[f64]) -> Vec<f64> {
    let above = all.partition_point(|value| *value < x);
    let mut near: Vec<f64> = [above.checked_sub(1), Some(above)]
        .into_iter()
        .flatten()
        .filter_map(|k| all.get(k).copied())
        .collect();
    near.dedup();
    near
}
