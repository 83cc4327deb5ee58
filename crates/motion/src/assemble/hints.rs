//! What a file says about the assembly that is meant: on which side points lie, and near what they are.

use kempe_mechanism::Design;
use kempe_mechanism::Mechanism;
use kempe_mechanism::geometry::Geometry;
use kempe_mechanism::pose::{Pose, cross, sub};
use kempe_mechanism::structure::{BodyId, Marker};
use kempe_model::{HintKind, LinkPointRef, PointId, Scalar};
use kempe_number::math;

use super::earlier::Like;

/// Side hints are not held against a point closer to the line than this, in sizes of the mechanism.
const ON_THE_LINE: f64 = 1e-9;

/// How an assembly stands to a side that a file asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// The point lies on that side.
    Holds,
    /// It lies on the other.
    Fails,
    /// It lies on the line, or the line has no direction: neither side is meant.
    OnTheLine,
}

/// How each of several poses stands to every hint of the file, in their order; `None` for hints that ask for no side.
pub fn standings<'a>(
    design: &Design<f64>,
    all: impl Iterator<Item = &'a [Pose<f64>]>,
) -> Vec<Vec<Option<Standing>>> {
    let (mechanism, size) = (&*design.mechanism, design.size());
    let hints = mechanism.model.assembly.iter();
    let sides: Vec<Option<AskedSide>> = hints
        .map(|hint| AskedSide::of(mechanism, &hint.kind))
        .collect();
    let of = |poses: &[Pose<f64>]| {
        let stand = |side: &AskedSide| side.standing(&design.geometry, poses, size);
        sides.iter().map(|side| side.as_ref().map(stand)).collect()
    };
    all.map(of).collect()
}

/// A side that a file asks for: its line's two points and the point itself.
struct AskedSide {
    points: [Marker; 3],
    sign: f64,
}

impl AskedSide {
    /// `None` for other hints.
    fn of(mechanism: &Mechanism, hint: &HintKind) -> Option<Self> {
        let &HintKind::Side {
            point,
            side,
            from,
            to,
        } = hint
        else {
            return None;
        };
        let marker = |p| mechanism.any_marker(p);
        Some(Self {
            points: [marker(from)?, marker(to)?, marker(point)?],
            sign: side.sign(),
        })
    }

    /// How poses stand to it, in a mechanism of this size, m.
    fn standing(&self, geometry: &Geometry<f64>, poses: &[Pose<f64>], size: f64) -> Standing {
        let [from, to, p] = (self.points).map(|m| poses[m.body.index()].place(geometry.marker(m)));
        let line = sub(to, from);
        let side = cross(line, sub(p, from)) * self.sign;
        let least = ON_THE_LINE * size * math::hypot(line[0], line[1]);
        if side > least {
            Standing::Holds
        } else if side < -least {
            Standing::Fails
        } else {
            Standing::OnTheLine
        }
    }
}

/// A file's hints, evaluated.
pub(super) struct Hints<'a> {
    mechanism: &'a Mechanism,
    geometry: &'a Geometry<f64>,
    /// Size of the mechanism, m.
    size: f64,
    sides: Vec<SideHint>,
    near: Vec<Near>,
    /// The step after which each of these can be looked at.
    near_after: Vec<usize>,
    /// Angles of the bodies by the file's hints, zero without: angles count within half a turn of these.
    pub meant: Vec<f64>,
}

/// A side that can be checked once its points are placed.
struct SideHint {
    asked: AskedSide,
    after_step: usize,
}

/// Where a point or how a link should lie, nearly.
enum Near {
    Place {
        point: PointId,
        world: [f64; 2],
    },
    Angle {
        body: BodyId,
        /// Angle of the link, rad.
        wanted: f64,
        /// Angle of the link in its body, rad.
        seat: f64,
    },
}

/// Where poses have what a `near` hint asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Found {
    /// A point.
    Place {
        /// Where it is, m.
        at: [f64; 2],
        /// The way there from where it was asked for, m.
        off: [f64; 2],
    },
    /// The angle of a link.
    Angle {
        /// What it is, rad.
        at: f64,
        /// By how much it is more than was asked for, rad.
        off: f64,
    },
}

/// Where poses have what the `near` hints of the file ask for: one entry for every hint, `None` for sides.
pub fn found_near(design: &Design<f64>, poses: &[Pose<f64>]) -> Vec<Option<Found>> {
    let (mechanism, geometry) = (&*design.mechanism, &design.geometry);
    let hints = mechanism.model.assembly.iter();
    let near = hints.map(|hint| Near::of(design, &hint.kind));
    near.map(|near| near?.found(mechanism, geometry, poses))
        .collect()
}

impl Near {
    /// `None` for sides.
    fn of(design: &Design<f64>, hint: &HintKind) -> Option<Self> {
        let value = |scalar: &Scalar| kempe_model::value(scalar, &design.parameters);
        match hint {
            HintKind::NearPlace { point, x, y } => Some(Self::Place {
                point: *point,
                world: [value(x), value(y)],
            }),
            HintKind::NearAngle { link, angle } => Some(Self::Angle {
                body: design.mechanism.body_of(*link),
                wanted: value(angle),
                seat: design.geometry.seat_angles[link.index()],
            }),
            HintKind::Side { .. } => None,
        }
    }

    /// All angles and places of an assembly.
    fn all_of(mechanism: &Mechanism, like: Like<'_>) -> Vec<Self> {
        let geometry = &like.design.geometry;
        let poses = &like.assembly.poses;
        let bodies = (0..mechanism.bodies as u32).map(BodyId);
        let moving = bodies.filter(|body| *body != BodyId::GROUND);
        let angles = moving.map(|body| Self::Angle {
            body,
            wanted: like.body_angle(body.index()),
            seat: 0.0,
        });
        let points = (0..mechanism.model.points.len() as u32).map(PointId);
        let places = points.filter_map(|point| {
            let marker = mechanism.any_marker(point)?;
            let world = poses[marker.body.index()].place(geometry.marker(marker));
            Some(Self::Place { point, world })
        });
        angles.chain(places).collect()
    }

    /// Where poses have it; `None` for a point on no link.
    fn found(
        &self,
        mechanism: &Mechanism,
        geometry: &Geometry<f64>,
        poses: &[Pose<f64>],
    ) -> Option<Found> {
        match self {
            Self::Place { point, world } => {
                let marker = mechanism.any_marker(*point)?;
                let at = poses[marker.body.index()].place(geometry.marker(marker));
                let off = sub(at, *world);
                Some(Found::Place { at, off })
            }
            Self::Angle { body, wanted, seat } => {
                let at = poses[body.index()].angle_near(wanted - seat) + seat;
                Some(Found::Angle {
                    at,
                    off: at - wanted,
                })
            }
        }
    }
}

impl<'a> Hints<'a> {
    /// Evaluates the hints of a mechanism's file; or what another assembly like which it is put together says in their stead.
    pub fn new(design: &'a Design<f64>, size: f64, like: Option<Like<'_>>) -> Self {
        let (mechanism, geometry) = (&*design.mechanism, &design.geometry);
        let hints = || mechanism.model.assembly.iter().map(|hint| &hint.kind);
        let near: Vec<Near> = match like.filter(|like| like.nearest) {
            Some(like) => Near::all_of(mechanism, like),
            None => hints().filter_map(|hint| Near::of(design, hint)).collect(),
        };
        let mut meant = match like {
            Some(like) => (0..mechanism.bodies).map(|k| like.body_angle(k)).collect(),
            None => vec![0.0; mechanism.bodies],
        };
        for hint in &near {
            if let (None, Near::Angle { body, wanted, seat }) = (like, hint) {
                meant[body.index()] = wanted - seat;
            }
        }
        let placed = placed_after(mechanism);
        let after = |near: &Near| match near {
            Near::Place { point, .. } => mechanism
                .any_marker(*point)
                .map_or(0, |m| placed[m.body.index()]),
            Near::Angle { body, .. } => placed[body.index()],
        };
        Self {
            near_after: near.iter().map(after).collect(),
            sides: hints()
                .filter_map(|hint| SideHint::new(hint, mechanism, &placed))
                .collect(),
            mechanism,
            geometry,
            size,
            near,
            meant,
        }
    }

    /// Whether the sides hold that can be checked after a step.
    pub fn sides_hold(&self, step: usize, poses: &[Pose<f64>]) -> bool {
        let mut ready = self.sides.iter().filter(|side| side.after_step == step);
        ready.all(|check| check.asked.standing(self.geometry, poses, self.size) != Standing::Fails)
    }

    /// The pose that the `near` hints tell; what they leave open stays. Shoes go with their pins.
    pub fn start(&self, poses: &[Pose<f64>]) -> Vec<Pose<f64>> {
        let mut poses = poses.to_vec();
        for hint in &self.near {
            if let Near::Angle { body, .. } = hint {
                let pose = &mut poses[body.index()];
                *pose = Pose::from_angle(pose.x, pose.y, self.meant[body.index()]);
            }
        }
        for hint in &self.near {
            let &Near::Place { point, world } = hint else {
                continue;
            };
            for &link in &self.mechanism.model.points[point.index()].links {
                if let Some(marker) = self.mechanism.marker(LinkPointRef { link, point }) {
                    let pose = &mut poses[marker.body.index()];
                    *pose = Pose::pinned(pose.c, pose.s, self.geometry.marker(marker), world);
                }
            }
        }
        self.geometry.place_shoes(self.mechanism, &mut poses);
        poses
    }

    /// Whether there are any `near` hints.
    pub fn has_near(&self) -> bool {
        !self.near.is_empty()
    }

    /// How far poses are from the `near` hints: root mean square, m.
    pub fn distance(&self, poses: &[Pose<f64>]) -> f64 {
        self.distance_of(poses, |_| true)
    }

    /// The same from those that can be looked at after a step and not before.
    pub fn distance_after(&self, step: usize, poses: &[Pose<f64>]) -> f64 {
        self.distance_of(poses, |after| after == step)
    }

    fn distance_of(&self, poses: &[Pose<f64>], counts: impl Fn(usize) -> bool) -> f64 {
        let (mut sum, mut count) = (0.0, 0);
        let all = self.near.iter().zip(&self.near_after);
        for (hint, _) in all.filter(|(_, after)| counts(**after)) {
            match hint.found(self.mechanism, self.geometry, poses) {
                Some(Found::Place { off, .. }) => sum += off[0] * off[0] + off[1] * off[1],
                Some(Found::Angle { off, .. }) => {
                    sum += (off * self.size) * (off * self.size);
                }
                None => continue,
            }
            count += 1;
        }
        if count == 0 {
            0.0
        } else {
            (sum / count as f64).sqrt()
        }
    }
}

impl SideHint {
    /// `None` for other hints. `placed` tells after which step each body is placed.
    fn new(hint: &HintKind, mechanism: &Mechanism, placed: &[usize]) -> Option<Self> {
        let asked = AskedSide::of(mechanism, hint)?;
        let after = asked.points.iter().map(|m| placed[m.body.index()]);
        Some(Self {
            after_step: after.max().unwrap_or(0),
            asked,
        })
    }
}

/// The step after which each body is placed: the last that seeks anything of it.
fn placed_after(mechanism: &Mechanism) -> Vec<usize> {
    let plan = &mechanism.plan;
    let mut placed = vec![0; mechanism.bodies];
    for (step, block) in plan.blocks.iter().enumerate() {
        for unknown in &block.unknowns {
            placed[unknown.body().index()] = step;
        }
    }
    placed
}
