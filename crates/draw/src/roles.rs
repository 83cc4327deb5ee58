//! What each point and link takes part in, gathered once so that large mechanisms stay cheap to draw.

use crate::view::{Guide, JointView, MechanismView};

/// What a point takes part in.
#[derive(Clone, Debug, Default)]
pub struct PointRole {
    /// The links that carry it, each once, in order.
    pub carriers: Vec<usize>,
    /// How many welds are at it.
    pub welds: usize,
    /// It is a pin by another joint: in a slot, at an end of a cylinder, at the centre of a gear.
    pub pinned: bool,
    /// It is the point of a slider that stays on the guide.
    pub slides: bool,
    /// It gives a guide its place or direction.
    pub guides: bool,
}

impl PointRole {
    /// It belongs to the frame.
    pub fn grounded(&self) -> bool {
        self.carriers.first() == Some(&0)
    }

    /// It belongs to the frame alone and does nothing but give a guide its direction: no symbol shows it.
    pub fn only_guides(&self) -> bool {
        self.carriers == [0] && self.only_shapes()
    }

    /// It does nothing but give a guide its direction, or a curve its shape.
    pub fn only_shapes(&self) -> bool {
        self.guides && !self.pinned && !self.slides && self.welds == 0
    }
}

/// What points and links take part in.
pub struct Roles {
    points: Vec<PointRole>,
    bodies: Vec<bool>,
    none: PointRole,
}

impl Roles {
    /// Gathers the roles of a mechanism; indices out of range are left out.
    pub fn new(view: &MechanismView) -> Roles {
        let mut points = vec![PointRole::default(); view.points.len()];
        for (number, link) in view.links.iter().enumerate() {
            for &index in &link.points {
                if let Some(role) = points.get_mut(index)
                    && role.carriers.last() != Some(&number)
                {
                    role.carriers.push(number);
                }
            }
        }
        let mut roles = Roles {
            points,
            bodies: vec![false; view.links.len()],
            none: PointRole::default(),
        };
        view.joints.iter().for_each(|joint| roles.add(joint));
        roles
    }

    fn add(&mut self, joint: &JointView) {
        match *joint {
            JointView::Slider { block, at, guide } => {
                self.with(at, |role| role.slides = true);
                self.guide(guide);
                self.body(block);
            }
            JointView::Slot { pin, guide } => {
                self.with(pin, |role| role.pinned = true);
                self.guide(guide);
            }
            JointView::Weld { at, .. } => self.with(at, |role| role.welds += 1),
            JointView::ArcSlot { pin, arc } => {
                self.with(pin, |role| role.pinned = true);
                self.with(arc.from, |role| role.guides = true);
                self.with(arc.to, |role| role.guides = true);
            }
            JointView::CurveSlot { pin, ref curve } => {
                self.with(pin, |role| role.pinned = true);
                for &point in &curve.through {
                    self.with(point, |role| role.guides = true);
                }
            }
            JointView::Gears { a, b, .. } | JointView::Belt { a, b, .. } => {
                for wheel in [a, b] {
                    self.with(wheel.center, |role| role.pinned = true);
                    self.body(wheel.link);
                }
            }
            JointView::Rack { link, pinion, .. } => {
                self.with(pinion.center, |role| role.pinned = true);
                self.body(link);
                self.body(pinion.link);
            }
            JointView::Cylinder { a, b }
            | JointView::Spring { a, b }
            | JointView::Damper { a, b } => {
                self.with(a, |role| role.pinned = true);
                self.with(b, |role| role.pinned = true);
            }
        }
    }

    fn with(&mut self, index: usize, change: impl Fn(&mut PointRole)) {
        self.points.get_mut(index).into_iter().for_each(change);
    }

    fn guide(&mut self, guide: Guide) {
        self.with(guide.from, |role| role.guides = true);
        self.with(guide.to, |role| role.guides = true);
    }

    fn body(&mut self, link: usize) {
        self.bodies
            .get_mut(link)
            .into_iter()
            .for_each(|body| *body = true);
    }

    /// The roles of a point.
    pub fn point(&self, index: usize) -> &PointRole {
        self.points.get(index).unwrap_or(&self.none)
    }

    /// Whether a link is a slider's block, a gear or a rack, so that it has a body even on one spot.
    pub fn has_body(&self, link: usize) -> bool {
        self.bodies.get(link).copied().unwrap_or(false)
    }
}
