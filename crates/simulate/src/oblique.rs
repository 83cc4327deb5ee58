//! Impacts of rigid contacts that rub: all at once by Newton's law, with friction in Coulomb's cone, which gives nothing back.
//!
//! What slides on after the impact has rubbed with all its friction, what sticks with what that took, after the law of J. J. Moreau. Where
//! bodies strike askew Newton's law may give energy to them: they keep then what they had, by the greatest part of their restitutions
//! that does not. Without any the impact takes energy in every case.

use crate::barrier::Gap;
use crate::cone::{Cones, Limit};
use crate::contact::Impact;
use crate::plant::Plant;
use crate::question::Resistance;
use crate::site::Acts;
use crate::vector::dot;

/// Halvings towards the part of the restitutions that gives no energy.
const HALVINGS: usize = 60;
/// Work of an impact that is this part of what its impulses do is none.
const NONE: f64 = 1e-13;

impl Plant {
    /// Strikes rigid stops with these gaps at the state last looked at, where some of them rub: see [`Plant::strike`].
    pub(crate) fn strike_rubbing(
        &mut self,
        stops: &[usize],
        gaps: &[Gap],
        y: &mut [f64],
    ) -> Option<Impact> {
        let (mut all, mut limits) = (gaps.to_vec(), Vec::new());
        for site in &self.rubbing.sites {
            let Acts::Rigid(at, stop) = site.what else {
                continue;
            };
            let Some(push) = stops.iter().position(|own| *own == stop) else {
                continue;
            };
            let contact = &self.forces.acting.contacts[at.contact];
            let by = |drives| contact.slides(at.place, &self.instant, drives);
            let (own, driven) = (by(&self.free)?, by(&self.driven)?);
            limits.push(Limit::OfPush(push, own.limit));
            all.push(Gap {
                open: 0.0,
                rate: own.speed,
                bend: 0.0,
                gradient: own.gradient,
                by_driven: driven.gradient,
            });
        }
        let rows: Vec<Vec<f64>> = (all.iter())
            .map(|gap| {
                let mut row = gap.gradient.clone();
                self.let_go.halve(&mut row);
                row
            })
            .collect();
        let cones = Cones {
            rows: &rows,
            by: &rows,
            limits: &limits,
        };
        let back: Vec<f64> = (stops.iter())
            .map(|stop| match self.stops.get(*stop).map(|s| s.resistance) {
                Some(Resistance::Rigid { restitution }) => restitution,
                _ => 0.0,
            })
            .collect();
        let impulses = |part: f64| {
            let rates = all.iter().enumerate();
            let rates = rates.map(|(k, gap)| {
                let restitution = back.get(k).copied().unwrap_or(0.0);
                (1.0 + part * restitution) * gap.rate
            });
            cones.forces(&rates.collect::<Vec<f64>>())
        };
        let gives = |impulses: &[f64]| gives_energy(&all, &rows, impulses);
        let mut found = impulses(1.0);
        if found.as_deref().is_some_and(gives) {
            let (mut low, mut high) = (0.0, 1.0);
            found = impulses(low);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                match impulses(middle).filter(|it| !gives(it)) {
                    Some(it) => (low, found) = (middle, Some(it)),
                    None => high = middle,
                }
            }
        }
        let Some(found) = found else {
            self.lack = Some(self.wedged(stops));
            return None;
        };
        let matrix = self.yielding(&all);
        let mut impact = self.take_impulses(&all, &matrix, &found, y)?;
        impact.rates.truncate(gaps.len());
        Some(impact)
    }
}

/// Whether impulses along gaps that yield by these rows give energy to what they strike.
fn gives_energy(gaps: &[Gap], rows: &[Vec<f64>], impulses: &[f64]) -> bool {
    let (mut work, mut size) = (0.0, 0.0);
    for (gap, (row, impulse)) in gaps.iter().zip(rows.iter().zip(impulses)) {
        let others = rows.iter().zip(impulses);
        let gained: f64 = others.map(|(other, p)| dot(row, other) * p).sum();
        let own = impulse * (gap.rate + 0.5 * gained);
        work += own;
        size += own.abs();
    }
    work > NONE * size
}
