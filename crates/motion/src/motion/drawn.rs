//! From where a mechanism is drawn to where its drives start.
//!
//! A drawing tells the assembly at the drawn coordinates of the drives. Where the path of the motion or its continuation passes
//! them, the branch is taken there and followed to the start as any motion is. Drives that the path holds, or all drives where
//! several move in time, are first moved together along a straight line from where they are drawn to where the path has them.

use std::f64::consts::TAU;

use kempe_mechanism::Design;
use kempe_model::{HintKind, Law, LawPiece, Model, StartsElsewhere};
use kempe_units::Expr;

use super::{Demand, EndReason, LeftDrawing, Motion, MotionError, Placed};
use crate::assemble::{Earlier, Found, found_near};
use crate::progress::Progress;
use crate::trace::Path;

/// The drives that start elsewhere than drawn.
pub(super) fn elsewhere(design: &Design<f64>) -> Vec<StartsElsewhere> {
    let model = &design.mechanism.model;
    model.starting_elsewhere(&design.parameters)
}

/// What following the drawn assembly to the start comes to.
enum Followed {
    Reached(Box<Motion>),
    /// How far these drives came, and why no farther.
    Ended(Option<(Vec<f64>, EndReason)>),
}

impl Motion {
    /// The branch through the drawn assembly, where the file draws one and the start is reached from there; else through the
    /// one that the file's hints mean at the start.
    pub(super) fn as_drawn(
        design: &Design<f64>,
        demand: Demand,
        earlier: Earlier<'_>,
        progress: &mut dyn Progress,
    ) -> Result<Self, MotionError> {
        let from = demand.start;
        let elsewhere = elsewhere(design);
        if elsewhere.is_empty() {
            return Self::through(design, demand, from, earlier, progress);
        }
        let mut ends = None;
        let turns = !design.mechanism.model.counts_turns();
        for place in drawn_places(&demand, &elsewhere, turns) {
            let demand = demand.clone();
            match Self::from_drawing(design, demand, &elsewhere, place, earlier, progress)? {
                Followed::Reached(motion) => return Ok(*motion),
                Followed::Ended(end) => ends = ends.or(end),
            }
        }
        let bare = design.with_model(without_drawn_hints);
        let mut motion = Self::through(&bare, demand, from, earlier, progress)?;
        motion.left_drawing = Some(LeftDrawing { elsewhere, ends });
        Ok(motion)
    }

    /// As drawn, with the path's own drive at `place`.
    fn from_drawing(
        design: &Design<f64>,
        demand: Demand,
        elsewhere: &[StartsElsewhere],
        place: f64,
        earlier: Earlier<'_>,
        progress: &mut dyn Progress,
    ) -> Result<Followed, MotionError> {
        let own = demand.path.drive();
        let mut there = vec![0.0; design.mechanism.model.drives.len()];
        demand.path.coordinates(place, &mut there);
        let mut drawn = there.clone();
        for e in elsewhere {
            if own != Some(e.drive.index()) {
                drawn[e.drive.index()] = e.drawn;
            }
        }
        let mut start = design.clone();
        if drawn != there {
            let lead = start.with_model(|model| lead(model, &drawn, &there));
            let lead_demand = Self::demand(&lead);
            let (begin, (low, high)) = (lead_demand.start, lead_demand.range);
            let end = if begin == low { high } else { low };
            let found = Self::through(&lead, lead_demand, begin, Earlier::default(), progress);
            let Some(motion) = unless_stopped(found)? else {
                return Ok(Followed::Ended(None));
            };
            let Some(placed) = motion.placed(end, &mut motion.solver()) else {
                return Ok(motion.ended(end, elsewhere));
            };
            start = carried(&motion.design, &start, &placed, own);
        }
        let target = demand.start;
        let found = Self::through(&start, demand, place, earlier, progress);
        let Some(motion) = unless_stopped(found)? else {
            return Ok(Followed::Ended(None));
        };
        Ok(match motion.reaches(target) {
            true => Followed::Reached(Box::new(motion)),
            false => motion.ended(target, elsewhere),
        })
    }

    /// Where the motion ends on the way to a place beyond, and why.
    fn ended(&self, beyond: f64, elsewhere: &[StartsElsewhere]) -> Followed {
        let nodes = self.node_parameters();
        let (end, why) = match beyond < self.anchor {
            true => (nodes.first(), self.ends.0),
            false => (nodes.last(), self.ends.1),
        };
        let mut coordinates = vec![0.0; self.mechanism().model.drives.len()];
        let end = end.copied().unwrap_or(self.anchor);
        self.path.coordinates(end, &mut coordinates);
        let at = elsewhere.iter().map(|e| coordinates[e.drive.index()]);
        Followed::Ended(Some((at.collect(), why)))
    }
}

/// `None` where there is no motion; only being stopped is passed on.
fn unless_stopped(found: Result<Motion, MotionError>) -> Result<Option<Motion>, MotionError> {
    match found {
        Err(stopped @ MotionError::Stopped { .. }) => Err(stopped),
        found => Ok(found.ok()),
    }
}

/// The places of the path, or of its continuation, at which its own drive is as drawn: an angle that is drawn within the range
/// is taken there, any other the shorter way round to it, and then the other way. The start, where that drive starts as drawn
/// or the path has none.
/// `turns`: whether a whole turn leads to the same drawing.
fn drawn_places(demand: &Demand, elsewhere: &[StartsElsewhere], turns: bool) -> Vec<f64> {
    let own = demand.path.drive();
    let Some(own) = elsewhere.iter().find(|e| own == Some(e.drive.index())) else {
        return vec![demand.start];
    };
    if !(turns && demand.path.coordinates_are_angles()) {
        return vec![own.drawn];
    }
    let (low, high) = demand.range;
    let outside = |p: f64| (low - p).max(p - high).max(0.0);
    let mut places = [-TAU, 0.0, TAU].map(|turn| own.drawn + turn);
    let key = |p: f64| (outside(p), (p - demand.start).abs());
    places.sort_by(|a, b| {
        let (a, b) = (key(*a), key(*b));
        a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    places[..2].to_vec()
}

/// Moves all drives together from some coordinates to others, in one second.
fn lead(model: &mut Model, from: &[f64], to: &[f64]) {
    for (drive, (from, to)) in model.drives.iter_mut().zip(from.iter().zip(to)) {
        let duration = Expr::Const(1.0);
        let piece = match from == to {
            true => LawPiece::Dwell { duration },
            false => LawPiece::ConstantSpeed {
                to: Expr::Const(*to),
                speed: Expr::Const((to - from).abs()),
            },
        };
        drive.law = Law {
            from: Expr::Const(*from),
            pieces: vec![piece],
        };
    }
}

/// The design with the hints of its drawing about other poses: those to which its drawn assembly was followed, where the path's
/// own drive alone is still as drawn.
fn carried(
    followed: &Design<f64>,
    design: &Design<f64>,
    placed: &Placed,
    own: Option<usize>,
) -> Design<f64> {
    let found = found_near(followed, &placed.poses);
    design.with_model(|model| {
        let coordinates = &mut model.drawing.coordinates;
        coordinates.retain(|(drive, _)| own == Some(drive.index()));
        let first = model.assembly.len() - model.drawing.hints.min(model.assembly.len());
        for (hint, found) in model.assembly.iter_mut().zip(found).skip(first) {
            match (&mut hint.kind, found) {
                (HintKind::NearPlace { x, y, .. }, Some(Found::Place { at, .. })) => {
                    (*x, *y) = (Expr::Const(at[0]), Expr::Const(at[1]));
                }
                (HintKind::NearAngle { link, angle }, _) => {
                    // with the turns that it made on the way
                    let body = followed.mechanism.body_of(*link);
                    let seat = followed.geometry.seat_angles[link.index()];
                    *angle = Expr::Const(placed.near[body.index()] + seat);
                }
                _ => {}
            }
        }
    })
}

/// Takes out what a drawing says of an assembly that was not reached.
fn without_drawn_hints(model: &mut Model) {
    let own = model.assembly.len() - model.drawing.hints.min(model.assembly.len());
    model.assembly.truncate(own);
    model.drawing.hints = 0;
    model.drawing.coordinates.clear();
}
