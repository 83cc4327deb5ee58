//! The structure of a mechanism: a model compiled to bodies and constraints, its dimensions still free.

mod compile;
mod parts;
mod sources;
mod weld;

pub use self::parts::{ArcRef, BodyId, LineRef, Marker, Spot};
pub use self::sources::{AngleSource, ArcSource, GearSource, LineSource, LinkSeat};
pub use crate::constraint::{Constraint, Source};

use kempe_model::{DriveId, JointId, LinkId, LinkPointRef, Model, Place, PointId};

use self::sources::ZERO;
use self::weld::seats;

/// A model compiled to bodies, markers and constraints.
#[derive(Clone, Debug)]
pub struct Structure {
    /// The model.
    pub model: Model,
    /// How many bodies, the frame included.
    pub bodies: usize,
    /// Seat of every link.
    pub seats: Vec<LinkSeat>,
    /// Every point of every link, in link order.
    pub markers: Vec<LinkPointRef>,
    /// Index of a link's first marker.
    first_marker: Vec<u32>,
    /// Lines used by constraints.
    pub lines: Vec<LineSource>,
    /// Arcs used by constraints.
    pub arcs: Vec<ArcSource>,
    /// Angle constants used by constraints.
    pub angles: Vec<AngleSource>,
    /// Gear constants used by constraints.
    pub gears: Vec<GearSource>,
    /// Joints' constraints first, then the drives'.
    pub constraints: Vec<(Constraint, Source)>,
    /// How many constraints come from joints.
    pub joint_constraints: usize,
}

impl Structure {
    /// Compiles a model.
    pub fn new(model: &Model) -> Self {
        let mut it = Self {
            bodies: 0,
            seats: seats(model),
            markers: Vec::new(),
            first_marker: Vec::new(),
            lines: Vec::new(),
            arcs: Vec::new(),
            angles: Vec::new(),
            gears: Vec::new(),
            constraints: Vec::new(),
            joint_constraints: 0,
            model: model.clone(),
        };
        it.bodies = it
            .seats
            .iter()
            .map(|seat| seat.body.index() + 1)
            .max()
            .unwrap_or(1);
        for (index, link) in model.links.iter().enumerate() {
            it.first_marker.push(it.markers.len() as u32);
            for point in &link.points {
                it.markers.push(LinkPointRef {
                    link: LinkId(index as u32),
                    point: point.point,
                });
            }
        }
        it.add_pins();
        for index in 0..model.joints.len() {
            it.add_joint(JointId(index as u32));
        }
        it.joint_constraints = it.constraints.len();
        for index in 0..model.drives.len() {
            it.add_drive(DriveId(index as u32));
        }
        it
    }

    /// The body a link belongs to.
    pub fn body_of(&self, link: LinkId) -> BodyId {
        self.seats[link.index()].body
    }

    /// Markers of a link: one for each of its points, in order.
    pub(crate) fn markers_of(&self, link: usize) -> std::ops::Range<usize> {
        let first = self.first_marker[link] as usize;
        first..first + self.model.links[link].points.len()
    }

    /// The marker of a point on a link.
    pub fn marker(&self, at: LinkPointRef) -> Option<Marker> {
        let link = self.model.links.get(at.link.index())?;
        let place = link.points.iter().position(|p| p.point == at.point)?;
        let body = self.body_of(at.link);
        let spot = match &link.points[place].place {
            _ if body == BodyId::GROUND => Spot::Frame,
            _ if self.seats[at.link.index()].weld.is_some() => Spot::Anywhere,
            Place::Cartesian { x, y } if *x == ZERO && *y == ZERO => Spot::Origin,
            Place::Cartesian { y, .. } if *y == ZERO => Spot::Axis,
            _ => Spot::Anywhere,
        };
        Some(Marker {
            body,
            index: self.first_marker[at.link.index()] + place as u32,
            spot,
        })
    }

    /// A marker of a point: on the first link that carries it.
    pub fn any_marker(&self, point: PointId) -> Option<Marker> {
        let link = *self.model.points.get(point.index())?.links.first()?;
        self.marker(LinkPointRef { link, point })
    }

    /// The link that carries a marker.
    pub fn link_of(&self, marker: Marker) -> LinkId {
        self.markers[marker.index as usize].link
    }

    /// The link that carries a line.
    pub fn link_of_line(&self, line: LineRef) -> LinkId {
        match self.lines[line.index as usize] {
            LineSource::Points(from, _) => self.link_of(from),
            LineSource::AxisOf(link) => link,
        }
    }

    /// Whether a point is one of the frame.
    pub fn is_fixed(&self, point: PointId) -> bool {
        let links = self.model.points.get(point.index()).map(|p| &p.links);
        let mut links = links.into_iter().flatten();
        links.any(|link| self.body_of(*link) == BodyId::GROUND)
    }

    /// Whether the marker lies at its body's origin whatever the dimensions, so that turning the body cannot move it.
    pub fn at_origin(&self, marker: Marker) -> bool {
        let at = self.markers[marker.index as usize];
        let link = &self.model.links[at.link.index()];
        self.seats[at.link.index()].weld.is_none()
            && link.points.iter().any(|p| {
                p.point == at.point
                    && matches!(&p.place, Place::Cartesian { x, y } if *x == ZERO && *y == ZERO)
            })
    }

    /// The name of a body: its links' names joined.
    pub fn body_name(&self, body: BodyId) -> String {
        let names: Vec<&str> = (self.seats.iter().zip(&self.model.links))
            .filter(|(seat, _)| seat.body == body)
            .map(|(_, link)| link.name.as_str())
            .collect();
        names.join("+")
    }
}
