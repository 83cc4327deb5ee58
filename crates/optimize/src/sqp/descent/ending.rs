//! What a descent found, where it ends.

use super::inside::Inside;
use crate::progress::Ended;
use crate::quadratic::{Minimum, minimise};

use super::super::curvature::Curvature;
use super::super::easing::lessen;
use super::super::local::scaled;
use super::super::optimum::{Multipliers, Optimum};
use super::{Descent, HOLDS};

/// An objective this little above the least that can be is there, in its size.
const LEAST: f64 = 1e-9;
/// A place that an edge holds keeps the conditions so far, and by this part of what it is held by: its normal is known by differences.
const EDGE_MET: f64 = 1e-4;
const EDGE_TURNED: f64 = 1e-6;

impl Descent<'_> {
    /// Goes back to the best place of rest that it left, unless it found a better one since; why it ends then.
    pub(super) fn back(&mut self, ended: Ended) -> Ended {
        let kept = self.place.violation <= self.options.feasibility;
        let value = self.place.evaluation.largest();
        match self.left.take() {
            Some(left) if !(kept && value < left.place.evaluation.largest()) => {
                (self.place, self.curvature) = (left.place, left.curvature);
                self.conflicts.truncate(left.conflicts);
                match ended {
                    Ended::Stopped | Ended::Budget => ended,
                    _ => left.ended,
                }
            }
            _ => ended,
        }
    }

    /// What was found, where it ends so.
    pub fn end(self, ended: Ended) -> Optimum {
        let least = self.search.view.least();
        let (size, feasibility) = (self.search.sizes.objective, self.options.feasibility);
        let (view, sizes, missed) = (
            self.search.view.clone(),
            self.search.sizes.clone(),
            self.missed,
        );
        let mut found = self.without_least(ended);
        if !found.conflicts.is_empty() {
            found.evaluation = view.not_eased(found.evaluation);
            found.violation = scaled(&found.evaluation, &sizes).1.max(0.0);
            if found.ended != Ended::Stopped {
                (found.ended, found.residual) = (Ended::Infeasible, missed);
            }
            return found;
        }
        let reached = found.violation <= feasibility
            && found.evaluation.is_defined()
            && found.objective() - least <= LEAST * size;
        if reached && !found.ended.is_optimal() && found.ended != Ended::Stopped {
            found.ended = Ended::Least;
            // At a corner of all pieces they do not tell the conditions.
            found.residual = f64::INFINITY;
            found.multipliers = Multipliers::default();
            found.eased = Multipliers::default();
        }
        found
    }

    /// What was found, by values and derivatives alone.
    fn without_least(mut self, ended: Ended) -> Optimum {
        if self.restoring.is_some() {
            self.restored(Ended::Stopped);
        }
        let ended = self.back(ended);
        let mut best = self.conditions();
        let by_edge = |it: &Self, best: &Option<(f64, Minimum)>| {
            (best.as_ref()).map_or(0.0, |(_, minimum)| {
                it.place.held_by_edge(&minimum.multipliers)
            })
        };
        if by_edge(&self, &best) > HOLDS
            && let Some(close) = self.search.close_to_edge(&self.place)
            && close.penalty(self.weight) <= self.place.penalty(self.weight)
        {
            self.place = close;
            best = self.conditions();
        }
        let by_edge = by_edge(&self, &best);
        let mut residual = best
            .as_ref()
            .map_or(f64::INFINITY, |(residual, _)| *residual);
        let kept = self.place.violation <= self.options.feasibility;
        let ended = match ended {
            Ended::Stuck | Ended::Budget if kept && residual <= self.options.optimality => {
                Ended::Converged
            }
            Ended::Stuck | Ended::Budget if kept && residual <= self.options.settled => {
                Ended::Settled
            }
            ended => ended,
        };
        let (mut ended, mut beyond, mut on_edge) = (ended, None, None);
        if by_edge > HOLDS {
            let known = EDGE_MET + EDGE_TURNED * by_edge;
            let is_over = matches!(
                ended,
                Ended::Stuck | Ended::Budget | Ended::Converged | Ended::Settled
            );
            if kept && is_over && residual <= known {
                ended = Ended::Edge;
            }
            beyond = self.search.beyond(&self.place);
            on_edge = self.search.onto_edge(&self.place, self.weight);
        }
        let own = &self.place.evaluation;
        let here = on_edge.as_ref().map_or(own, |(_, it)| it);
        if let Some((design, evaluation)) = self.search.bare_below(here) {
            let told = (evaluation, self.scales);
            return Optimum {
                iterations: self.iterations,
                slopes: self.search.slopes,
                conflicts: self.conflicts,
                ended: match ended {
                    Ended::Stopped | Ended::Budget => ended,
                    _ => Ended::Stuck,
                },
                ..Optimum::undefined(design, told, self.search.evaluations)
            };
        }
        let before = self.place.design.clone();
        let inside = match ended {
            Ended::Stopped | Ended::Edge => Inside::Unknown,
            _ if kept => self.inside(),
            _ => Inside::Unknown,
        };
        if self.place.design != before {
            (beyond, on_edge) = (None, None);
        }
        let shares = best.map(|(_, minimum)| minimum.multipliers);
        let (sizes, space) = (&self.search.sizes, &self.search.space);
        let (multipliers, eased) = match inside {
            Inside::Held(inside) => {
                (ended, residual) = (inside.ended, inside.residual);
                (inside.multipliers, inside.eased)
            }
            Inside::Elsewhere(apart) => {
                residual = apart;
                if ended != Ended::Budget {
                    ended = Ended::Stuck;
                }
                let none = || (self.place).multipliers(None, sizes, space);
                (none(), none())
            }
            Inside::Unknown => {
                let told = (self.place).multipliers(shares.as_deref(), sizes, space);
                let mut eased = shares;
                if let Some(shares) = eased.as_mut().filter(|_| ended.is_optimal()) {
                    lessen(&self.place, self.weight, space, shares);
                }
                let eased = (self.place).multipliers(eased.as_deref(), sizes, space);
                (told, eased)
            }
        };
        let (design, evaluation) = on_edge.unwrap_or((self.place.design, self.place.evaluation));
        Optimum {
            violation: scaled(&evaluation, &self.search.sizes).1.max(0.0),
            design,
            evaluation,
            multipliers,
            eased,
            residual,
            conflicts: self.conflicts,
            beyond,
            scales: self.scales,
            iterations: self.iterations,
            evaluations: self.search.evaluations,
            slopes: self.search.slopes,
            ended,
        }
    }

    /// The multipliers that miss the conditions by less, once with the curvature, once without, and by how much they do.
    fn conditions(&self) -> Option<(f64, Minimum)> {
        let unit = Curvature::unit(self.place.design.len());
        let (space, free) = (&self.search.space, f64::INFINITY);
        let both = [&self.curvature, &unit]
            .into_iter()
            .filter_map(|curvature| {
                let programme =
                    (self.place).programme(curvature.matrix(), self.weight, space, free);
                let minimum = minimise(&programme).ok()?;
                let bent = curvature.times(&minimum.step);
                Some((self.place.residual(&minimum, &bent, space, free), minimum))
            });
        both.min_by(|a, b| a.0.total_cmp(&b.0))
    }
}
