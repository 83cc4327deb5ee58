//! Friction where bodies of joints with play touch and do not give: what presses there is what a stop pushes, so that friction is a part
//! of the push while the bodies slide.

use crate::barrier::{Gap, Opens};
use crate::cone::{Limit, left_by_friction};
use crate::lack::Lack;
use crate::plant::Plant;
use crate::question::Resistance;
use crate::site::{Acts, Rub, Site};
use crate::touched::Place;
use crate::vector::dot;

/// Where friction leaves so small a part of what pushes do they run away: it wedges itself.
const WEDGED: f64 = 1e-4;

/// How the bodies slide at a stop.
struct Slip {
    /// The friction of a push of 1 N, along the slip: negative where it slides forwards.
    part: f64,
    /// Derivatives of the speed to those of the coordinates that are let go.
    gradient: Vec<f64>,
}

impl Plant {
    /// The stop for which a place of a joint with play stands, if its bodies do not give.
    pub(crate) fn stop_of(&self, at: Place) -> Option<usize> {
        let mut stops = self.stops.iter();
        stops.position(|stop| match stop.opens {
            Opens::Joint(own) => own == at && matches!(stop.resistance, Resistance::Rigid { .. }),
            Opens::Measure(_) => false,
        })
    }

    /// The place that rubs at a stop, if one does.
    fn site_of(&self, stop: usize) -> Option<(&Site, Rub)> {
        let sites = self.rubbing.sites.iter().zip(&self.mode.rubs);
        let mut own = sites.filter(|(site, _)| matches!(site.what, Acts::Rigid(_, k) if k == stop));
        own.next().map(|(site, rub)| (site, *rub))
    }

    /// Whether anything rubs at a stop.
    pub(crate) fn rubs_at(&self, stop: usize) -> bool {
        self.site_of(stop).is_some()
    }

    /// Whether anything rubs at stops on which it rests.
    pub(crate) fn rubs_rigidly(&self) -> bool {
        self.mode.resting.iter().any(|stop| self.rubs_at(*stop))
    }

    /// Whether friction may act at any stop.
    pub(crate) fn has_rigid_friction(&self) -> bool {
        let mut sites = self.rubbing.sites.iter();
        sites.any(|site| matches!(site.what, Acts::Rigid(..)))
    }

    /// Hands what friction does at stops to what acts.
    pub(crate) fn take_rigid(&mut self) {
        for k in 0..self.rubbing.sites.len() {
            let site = self.rubbing.sites[k];
            let Acts::Rigid(at, stop) = site.what else {
                continue;
            };
            let contact = &self.forces.acting.contacts[at.contact];
            let resists = match self.mode.rubs[k] {
                _ if !self.mode.resting.contains(&stop) => 0.0,
                Rub::Slides(sense) => sense * contact.friction_at_once() * self.push_of(stop),
                Rub::Held => site.resists,
                Rub::Idle | Rub::Apart => 0.0,
            };
            if let Some(part) = contact.parts.get(at.place) {
                self.instant.amounts[*part] = resists;
            }
            self.inner.values[site.inner] = resists;
        }
    }

    /// What a stop pushes as last found, N; negative where it would pull.
    pub(crate) fn push_of(&self, stop: usize) -> f64 {
        let place = self.mode.resting.iter().position(|k| *k == stop);
        let push = place.and_then(|place| self.pushes.get(place));
        push.copied().unwrap_or(0.0)
    }

    /// How bodies slide at a stop on which it rests, at the state last looked at, where they do.
    fn slip(&self, stop: usize) -> Option<Slip> {
        let (site, Rub::Slides(sense)) = self.site_of(stop)? else {
            return None;
        };
        let Acts::Rigid(at, _) = site.what else {
            return None;
        };
        let contact = self.forces.acting.contacts.get(at.contact)?;
        let slides = contact.slides(at.place, &self.instant, &self.free)?;
        Some(Slip {
            part: -sense * slides.limit,
            gradient: slides.gradient,
        })
    }

    /// What unit pushes of the stops on which it rests come to along the coordinates that are let go, with the friction of those at which
    /// bodies slide.
    pub(crate) fn with_friction(&self, gaps: &[Gap]) -> Vec<Vec<f64>> {
        let stops = self.mode.resting.iter().zip(gaps);
        let all = stops.map(|(stop, gap)| {
            let mut all = gap.gradient.clone();
            if let Some(slip) = self.slip(*stop) {
                for (x, along) in all.iter_mut().zip(&slip.gradient) {
                    *x += slip.part * along;
                }
            }
            all
        });
        all.collect()
    }

    /// The same, and all rows along which forces act, where these are the rows of the gaps and of places.
    pub(crate) fn pushing(
        &self,
        gaps: &[Gap],
        rows: &[Vec<f64>],
    ) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
        let pushing = self.with_friction(gaps);
        let mut by = rows.to_vec();
        for (row, along) in by.iter_mut().zip(&pushing) {
            row.clone_from(along);
            self.let_go.halve(row);
        }
        (pushing, by)
    }

    /// The rates of the gaps (rows) by unit pushes of the stops on which it rests, with friction where bodies slide there. That it wedges
    /// itself, if it does.
    pub(crate) fn yielding_with_friction(&self, gaps: &[Gap]) -> Result<Vec<Vec<f64>>, Lack> {
        let mut pushing = self.with_friction(gaps);
        for response in &mut pushing {
            self.let_go.respond(response);
        }
        let row = |gap: &Gap| pushing.iter().map(|by| dot(&gap.gradient, by)).collect();
        let yields: Vec<Vec<f64>> = gaps.iter().map(row).collect();
        match left_by_friction(&self.yielding(gaps), &yields) <= WEDGED {
            true => Err(self.wedged(&self.mode.resting)),
            false => Ok(yields),
        }
    }

    /// That what slides wedges itself, at the first of some stops that rubs.
    pub(crate) fn wedged(&self, stops: &[usize]) -> Lack {
        let rubs = stops.iter().find(|stop| self.rubs_at(**stop));
        let stop = rubs.and_then(|stop| self.stops.get(*stop));
        match stop.map(|stop| &stop.opens) {
            Some(Opens::Joint(at)) => Lack::Wedged(*at),
            Some(Opens::Measure(_)) | None => Lack::Friction,
        }
    }

    /// How far friction goes in some places, where that hangs on pushes of stops on which it rests: nothing at all where it does so nowhere.
    pub(crate) fn limits_by_pushes(&self, places: &[usize]) -> Option<Vec<Option<Limit>>> {
        if !self.rubs_rigidly() {
            return None;
        }
        let limit = |k: &usize| {
            let Acts::Rigid(at, stop) = self.rubbing.sites[*k].what else {
                return None;
            };
            let place = self.mode.resting.iter().position(|own| *own == stop)?;
            let contact = &self.forces.acting.contacts[at.contact];
            Some(Limit::OfPush(place, contact.friction_at_once()))
        };
        Some(places.iter().map(limit).collect())
    }

    /// Leaves stops on which it rested, by their places among those.
    pub(crate) fn leave(&mut self, leaves: &[bool]) {
        let kept = |stop: &usize, place: usize| (!leaves[place]).then_some(*stop);
        let resting: Vec<usize> = std::mem::take(&mut self.mode.resting);
        let pushes = std::mem::take(&mut self.pushes);
        let all = resting.iter().zip(pushes).enumerate();
        (self.mode.resting, self.pushes) = all
            .filter_map(|(place, (stop, push))| Some((kept(stop, place)?, push)))
            .unzip();
        if leaves.contains(&true) {
            self.mode.beside.clear();
        }
        self.rub_where_it_rests();
    }

    /// Nothing rubs at stops on which it does not rest.
    pub(crate) fn rub_where_it_rests(&mut self) {
        for (site, rub) in self.rubbing.sites.iter().zip(&mut self.mode.rubs) {
            if let Acts::Rigid(_, stop) = site.what
                && !self.mode.resting.contains(&stop)
            {
                *rub = Rub::Apart;
            }
        }
    }
}
