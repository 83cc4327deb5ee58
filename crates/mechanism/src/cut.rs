//! A mechanism whose loops are cut: every pose follows from coordinates of a spanning tree, and what was cut is left to say which of
//! these poses are its own.
//!
//! With the angle of every link known, a pin places its link from another one, and so does a slide whose coordinate is known. So angles and
//! places have a spanning forest each, over bodies: one of what sets angles between bodies (sliders on their guides, drives that turn), one of
//! pins and slides. Coordinates are those of drives, an angle for each tree of angles that does not hang on the frame, and the travel of
//! each slide without a drive that no pin could take the place of. All joints beside the trees are cut: two angles or places that loops
//! would have to close.

use std::sync::Arc;

use kempe_model::{DriveId, DriveKind, FRAME, LinkId};
use kempe_units::Dimension;

use crate::Mechanism;
use crate::constraint::{Constraint, Joint, Source};
use crate::ids::BodyId;
use crate::pilots::{follow, standing};
use crate::releasing::NotReleased;

/// A mechanism whose loops are cut.
#[derive(Clone, Debug)]
pub struct CutOpen {
    /// The mechanism with its loops open: bodies, parameters and markers are those of the closed one, and its drives the first ones.
    pub mechanism: Arc<Mechanism>,
    /// Drives behind the model's own that tell the place.
    pub coordinates: Vec<DriveId>,
    /// Drives that hold nothing in it: some of those that are let go, those that keep laws where they close a loop, and rows of joints.
    pub follow: Vec<DriveId>,
    /// What was cut: constraints of the closed mechanism, whose rows vanish where the loops close.
    pub ties: Vec<Constraint>,
}

/// Why loops cannot be cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum NotCut {
    /// A pin runs on a smooth curve: the place on the curve is no coordinate of a drive.
    OnCurve(Source),
    /// No pin and no straight slide leads to this link.
    Unreached(LinkId),
    /// This drive turns or shifts what other drives turn or shift already.
    Closes(DriveId),
    /// A joint that would have to be cut cannot be let go.
    NotReleased(NotReleased),
}

/// Bodies that are put together one after the other.
struct Forest(Vec<usize>);

impl Forest {
    fn new(bodies: usize) -> Self {
        Self((0..bodies).collect())
    }

    fn root(&self, body: BodyId) -> usize {
        let mut at = body.index();
        while self.0[at] != at {
            at = self.0[at];
        }
        at
    }

    fn is_joined(&self, [a, b]: [BodyId; 2]) -> bool {
        self.root(a) == self.root(b)
    }

    /// Joins the trees of two bodies; false where they are one.
    fn join(&mut self, [a, b]: [BodyId; 2]) -> bool {
        let (a, b) = (self.root(a), self.root(b));
        let (low, high) = (a.min(b), a.max(b));
        self.0[high] = low;
        low != high
    }
}

/// What places one body from another.
#[derive(Clone, Copy)]
struct Edge {
    /// The constraint.
    at: usize,
    bodies: [BodyId; 2],
    /// Whether it is a slide, and its drive.
    slide: Option<Option<DriveId>>,
    /// Whether wheels need it, or a drive moves it.
    first: bool,
}

/// Which constraints are in the trees.
struct Trees {
    kept: Vec<bool>,
    /// Slides without a drive that are.
    slides: Vec<usize>,
    /// Drives that are not: those that are let go.
    closing: Vec<DriveId>,
    angles: Forest,
    /// In which round a body was reached.
    reached: Vec<Option<usize>>,
}

impl Mechanism {
    /// Cuts the loops, for these drives that are let go, of each of which it is told in which sense its motor turns it, 1 or -1.
    ///
    /// # Errors
    /// What no tree of pins, slides and drives leads to.
    pub fn cut_open(&self, free: &[(DriveId, f64)]) -> Result<CutOpen, NotCut> {
        let on_curve = |it: &&(Constraint, Source)| matches!(it.0, Constraint::OnCurve(_));
        if let Some((_, source)) = self.constraints.iter().find(on_curve) {
            return Err(NotCut::OnCurve(*source));
        }
        let trees = self.trees(free)?;
        let own = self.model.drives.len();
        let mut cut: Vec<Source> = Vec::new();
        let (mut ties, mut follow_drives) = (Vec::new(), trees.closing.clone());
        for (index, (constraint, source)) in self.constraints.iter().enumerate() {
            match source {
                _ if trees.kept[index] => {}
                Source::Drive(drive) => {
                    // A cylinder that keeps its law, or stands: a tie in time.
                    if !free.iter().any(|(it, _)| it == drive) {
                        follow_drives.push(*drive);
                        ties.push(*constraint);
                    } else if !follow_drives.contains(drive) {
                        follow_drives.push(*drive);
                    }
                }
                joint => {
                    ties.push(*constraint);
                    if !cut.contains(joint) {
                        cut.push(*joint);
                    }
                }
            }
        }
        let open = self.releasing(&cut).map_err(NotCut::NotReleased)?;
        let mut model = open.model.clone();
        // Rows of what was let go and is in a tree all the same stand at zero.
        for index in own..model.drives.len() {
            let DriveKind::Release { of, row } = model.drives[index].kind else {
                continue;
            };
            let rows = self.constraints.iter().enumerate();
            let rows = rows.filter(|(_, (_, source))| *source == of.into());
            let mut rows = rows.flat_map(|(at, (constraint, _))| vec![at; constraint.rows()]);
            if rows.nth(usize::from(row)).is_some_and(|at| !trees.kept[at]) {
                follow_drives.push(DriveId(index as u32));
            }
        }
        for drive in &follow_drives {
            let sense = free
                .iter()
                .find(|(it, _)| it == drive)
                .map_or(1.0, |it| it.1);
            follow(&mut model, *drive, sense);
        }
        let first = model.drives.len();
        for link in self.turning(&trees) {
            let kind = DriveKind::Turn {
                link,
                relative_to: FRAME,
            };
            let name = format!("angle({})", self.model.links[link.index()].name);
            model.drives.push(standing(name, kind, Dimension::ANGLE));
        }
        for at in &trees.slides {
            if let Source::Joint(joint) = self.constraints[*at].1 {
                let kind = DriveKind::Slide { joint };
                let name = self.model.joints[joint.index()].name.clone();
                model.drives.push(standing(name, kind, Dimension::LENGTH));
            }
        }
        let coordinates = first..model.drives.len();
        Ok(CutOpen {
            coordinates: coordinates.map(|k| DriveId(k as u32)).collect(),
            mechanism: Self::new(&model),
            follow: follow_drives,
            ties,
        })
    }

    /// What sets angles and places from body to body.
    fn trees(&self, free: &[(DriveId, f64)]) -> Result<Trees, NotCut> {
        let mut trees = Trees {
            kept: vec![false; self.constraints.len()],
            slides: Vec::new(),
            closing: Vec::new(),
            angles: Forest::new(self.bodies),
            reached: vec![None; self.bodies],
        };
        let is_free = |drive: DriveId| free.iter().any(|(it, _)| *it == drive);
        // Angles by drives come first: these are given, or coordinates anyway.
        for by_drive in [true, false] {
            for (index, (constraint, _)) in self.constraints.iter().enumerate() {
                let Constraint::Direction(it) = constraint else {
                    continue;
                };
                if it.input.is_some() != by_drive {
                    continue;
                }
                match (trees.angles.join([it.a, it.b]), it.input) {
                    (true, _) => trees.kept[index] = true,
                    (false, Some(drive)) if is_free(drive) => trees.closing.push(drive),
                    (false, Some(drive)) => return Err(NotCut::Closes(drive)),
                    (false, None) => {}
                }
            }
        }
        self.place(&mut trees)?;
        Ok(trees)
    }

    /// What places bodies, from the frame on.
    fn place(&self, trees: &mut Trees) -> Result<(), NotCut> {
        let edges = self.edges();
        let mut places = Forest::new(self.bodies);
        let keep = |edge: &Edge, trees: &mut Trees| {
            trees.kept[edge.at] = true;
            match edge.slide {
                Some(None) => trees.slides.push(edge.at),
                Some(Some(drive)) => {
                    let own = (self.constraints.iter())
                        .position(|(_, source)| *source == Source::Drive(drive));
                    own.into_iter().for_each(|at| trees.kept[at] = true);
                }
                None => {}
            }
        };
        for edge in edges.iter().filter(|edge| edge.first) {
            match (places.join(edge.bodies), edge.slide) {
                (true, _) => keep(edge, trees),
                (false, Some(Some(drive))) => return Err(NotCut::Closes(drive)),
                (false, _) => {}
            }
        }
        // Round by round from the frame on: short trees.
        for round in 0.. {
            let frame = places.root(BodyId::GROUND);
            for (body, reached) in trees.reached.iter_mut().enumerate() {
                if reached.is_none() && places.root(BodyId(body as u32)) == frame {
                    *reached = Some(round);
                }
            }
            let leads_on = |edge: &&Edge| {
                let [a, b] = edge
                    .bodies
                    .map(|body| trees.reached[body.index()].is_some());
                a != b
            };
            let on: Vec<Edge> = edges.iter().filter(leads_on).copied().collect();
            let pins = on.iter().filter(|edge| edge.slide.is_none());
            let mut next: Vec<&Edge> = pins.collect();
            if next.is_empty() {
                next.extend(on.first());
            }
            if next.is_empty() {
                break;
            }
            for edge in next {
                if !places.is_joined(edge.bodies) {
                    places.join(edge.bodies);
                    keep(edge, trees);
                }
            }
        }
        let links = 0..self.model.links.len() as u32;
        let mut links = links.map(LinkId);
        let unreached = |link: &LinkId| trees.reached[self.body_of(*link).index()].is_none();
        match links.find(unreached) {
            Some(link) => Err(NotCut::Unreached(link)),
            None => Ok(()),
        }
    }

    /// Everything that places one body from another where angles are known.
    fn edges(&self) -> Vec<Edge> {
        let needed: Vec<_> = (self.constraints.iter())
            .filter_map(|(constraint, _)| constraint.needs_pins())
            .flatten()
            .map(|pin| self.markers[pin.index as usize].point)
            .collect();
        let driven = |joint| {
            let drives = self.model.drives.iter();
            let mut drives = drives.map(|drive| &drive.kind);
            let own = drives.position(|kind| *kind == DriveKind::Slide { joint });
            own.map(|own| DriveId(own as u32))
        };
        let edge =
            |(at, (constraint, source)): (usize, &(Constraint, Source))| match (constraint, source)
            {
                (Constraint::Coincide(pin), Source::Pin { point, .. }) => Some(Edge {
                    at,
                    bodies: [pin.a.body, pin.b.body],
                    slide: None,
                    first: needed.contains(point),
                }),
                (Constraint::OnLine(it), Source::Joint(joint)) => Some(Edge {
                    at,
                    bodies: [it.point.body, it.line.body],
                    slide: Some(driven(*joint)),
                    first: driven(*joint).is_some(),
                }),
                _ => None,
            };
        self.constraints
            .iter()
            .enumerate()
            .filter_map(edge)
            .collect()
    }

    /// The links whose angles are coordinates: one for each tree of angles that does not hang on the frame, as near to that as any.
    fn turning(&self, trees: &Trees) -> Vec<LinkId> {
        let frame = trees.angles.root(BodyId::GROUND);
        let mut first: Vec<Option<(usize, LinkId)>> = vec![None; self.bodies];
        for link in (0..self.model.links.len() as u32).map(LinkId) {
            let body = self.body_of(link);
            let (tree, round) = (trees.angles.root(body), trees.reached[body.index()]);
            let round = round.unwrap_or(usize::MAX);
            // Nothing feels an idle angle, which is held.
            if self.plan.decomposition.idle.contains(&body) {
                continue;
            }
            if tree != frame && first[tree].is_none_or(|(known, _)| round < known) {
                first[tree] = Some((round, link));
            }
        }
        let mut all: Vec<(usize, LinkId)> = first.into_iter().flatten().collect();
        all.sort_by_key(|(round, link)| (*round, link.index()));
        all.into_iter().map(|(_, link)| link).collect()
    }
}
