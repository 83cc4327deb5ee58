//! How long work tells how far it has come, how it is stopped, and why it ended.

use std::ops::ControlFlow;

/// How far the work has come.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a> {
    /// Designs evaluated.
    pub evaluations: usize,
    /// Of so many at most.
    pub budget: usize,
    /// The best design so far and its largest objective; for Pareto fronts one of them.
    pub best: Option<(&'a [f64], f64)>,
    /// The largest violation of its constraints by their scales; infinite where it cannot be evaluated.
    pub violation: f64,
}

/// Hears how far the work has come, and says whether it may go on. Its answer changes nothing else.
pub type Hears<'a> = &'a mut dyn FnMut(&Progress) -> ControlFlow<()>;

/// Hears nothing and never stops.
pub fn silent(_: &Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Why work ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Ended {
    /// What it looks for is found, within its tolerances.
    Converged,
    /// No step is better any more than rounding shows, and the conditions of an optimum are kept loosely.
    Settled,
    /// The objective is as small as it can be at all, whatever the derivatives say.
    Least,
    /// Along the edge of what can be evaluated no step is better, and beyond it there is nothing.
    Edge,
    /// The largest violation of the constraints has a minimum here that is none of zero.
    Infeasible,
    /// No step is better, though the first-order conditions are not met: a kink that is none of the pieces, derivatives that are not those of the values, or a
    /// place from which all ways lead to designs that cannot be evaluated.
    Stuck,
    /// It leads to where the objective falls without bound, as far as numbers tell.
    Unbounded,
    /// All evaluations or iterations that were allowed are used.
    Budget,
    /// The start cannot be evaluated, or does not fit the bounds.
    Undefined,
    /// The start has no derivatives.
    Slopeless,
    /// Whoever listened stopped it.
    Stopped,
}

impl Ended {
    /// Whether the answer is an optimum: keeps its first-order conditions, or is the least that can be.
    pub fn is_optimal(self) -> bool {
        matches!(
            self,
            Self::Converged | Self::Settled | Self::Least | Self::Edge
        )
    }

    /// For people.
    pub fn text(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::Settled => "converged as far as rounding allows",
            Self::Least => "as good as it can be at all",
            Self::Edge => {
                "at the edge of the designs that can be asked, along which no step is better"
            }
            Self::Infeasible => "the constraints cannot all be kept",
            Self::Stuck => {
                "no step is better, and the first-order conditions are not met, as at a kink"
            }
            Self::Unbounded => "the goal has no bound there: it is at a pole",
            Self::Budget => "all allowed evaluations are used",
            Self::Undefined => "the start cannot be evaluated",
            Self::Slopeless => "how it changes with what is varied is not known there",
            Self::Stopped => "stopped",
        }
    }
}
