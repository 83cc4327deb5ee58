//! A mechanism whose place is told by other coordinates than those of its drives.
//!
//! A drive that is let go tells where the mechanism is, except at its own dead point. There the angle of some link tells it as well
//! as ever: the mechanism is the same, by another coordinate. Bodies, parameters and markers stay what they are, so that a pose
//! of the one is a pose of the other.

use std::sync::Arc;

use kempe_model::{Drive, DriveId, DriveKind, FRAME, Law, LinkId, Model, StandIn};
use kempe_units::Dimension;

use crate::Mechanism;

impl Mechanism {
    /// The mechanism in which drives follow while the angle of a link against the frame tells the place for each: drives behind
    /// the model's own, in this order. Of each it is told in which sense its motor turns it, 1 or -1.
    pub fn turned_by(&self, links: &[(DriveId, LinkId, f64)]) -> Arc<Self> {
        let mut model = self.model.clone();
        for (drive, link, sense) in links {
            follow(&mut model, *drive, *sense);
            let kind = DriveKind::Turn {
                link: *link,
                relative_to: FRAME,
            };
            let name = model.links.get(link.index()).map(|l| &l.name);
            let name = format!("angle({})", name.map_or("", |name| name));
            model.drives.push(standing(name, kind, Dimension::ANGLE));
        }
        Self::new(&model)
    }

    /// The mechanism in which drives follow while a pilot of each tells the place: its own coordinate, or the angle of one of
    /// `links`. Behind the model's own drives come the pilots in this order, and then for each the choice that it goes by: 0 for
    /// the own coordinate, from 1 on the links.
    pub fn piloted(&self, drives: &[(DriveId, f64)], links: &[LinkId]) -> Arc<Self> {
        let mut model = self.model.clone();
        let first = model.drives.len() + drives.len();
        let own = drives.iter().enumerate();
        let own: Vec<(usize, DriveId, Drive)> = own
            .filter_map(|(k, (drive, _))| {
                Some((k, *drive, self.model.drives.get(drive.index())?.clone()))
            })
            .collect();
        for (k, of, drive) in &own {
            let kind = DriveKind::StandIn(StandIn::Pilot {
                of: *of,
                own: Box::new(drive.kind.clone()),
                links: links.to_vec(),
                chosen: DriveId((first + k) as u32),
            });
            // An angle has its sine and cosine at hand; a length goes without.
            let pilot = standing(drive.name.clone(), kind, Dimension::ANGLE);
            model.drives.push(pilot);
        }
        for (_, _, drive) in &own {
            let choice = standing(
                drive.name.clone(),
                DriveKind::StandIn(StandIn::Choice),
                Dimension::NONE,
            );
            model.drives.push(choice);
        }
        for (drive, sense) in drives {
            follow(&mut model, *drive, *sense);
        }
        Self::new(&model)
    }
}

/// Lets a drive go with the mechanism.
pub(crate) fn follow(model: &mut Model, drive: DriveId, sense: f64) {
    if let Some(drive) = model.drives.get_mut(drive.index()) {
        let of = Box::new(drive.kind.clone());
        drive.kind = DriveKind::StandIn(StandIn::Follows { of, sense });
    }
}

/// A drive that stands at zero until somebody says otherwise.
pub(crate) fn standing(name: String, kind: DriveKind, dimension: Dimension) -> Drive {
    Drive {
        name,
        kind,
        law: Law::standing(0.0),
        dimension,
        span: 0..0,
    }
}
