//! Goals without bound: beside a pole, or falling on and on.

use kempe_measure::measure::visit_parts;
use kempe_model::{Measure, Model};
use kempe_units::{Builtin, Expr};

use super::designs::Designs;
use super::journal::lock;

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

impl Designs<'_, '_> {
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
        let wanted = self.aims.wanted.get(which);
        if which >= self.aims.goals
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
}

/// Whether there is a logarithm in a measure, or in those that it names.
fn asks_logarithm(model: &Model, measure: &Measure) -> bool {
    let mut asks = false;
    visit_parts(model, measure, &mut |part| {
        asks |= matches!(part, Expr::Call(Builtin::Ln, _));
    });
    asks
}
