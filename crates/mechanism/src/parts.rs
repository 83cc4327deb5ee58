//! What a mechanism is made of, its constraints aside: bodies with the points, lines, arcs and constants of a model.

mod weld;

use kempe_model::{
    CircularArc, JointId, Line, LinkId, LinkPointRef, Model, Place, PointId, SmoothCurve,
};

use self::weld::seats;
use crate::ids::{ArcRef, BodyId, CurveRef, LineRef, Marker, Spot};
use crate::sources::{AngleSource, ArcSource, CurveSource, GearSource, LineSource, LinkSeat, ZERO};

/// Bodies and what they carry, dimensions still free.
#[derive(Clone, Debug)]
pub struct Parts {
    /// The model.
    pub model: Model,
    /// How many bodies, the frame included.
    pub bodies: usize,
    /// Seat of every link.
    pub seats: Vec<LinkSeat>,
    /// Every point of every link, in link order; then the origin of every shoe, named as its pin.
    pub markers: Vec<LinkPointRef>,
    /// Index of a link's first marker.
    first_marker: Vec<u32>,
    /// Lines used by constraints.
    pub lines: Vec<LineSource>,
    /// Arcs used by constraints.
    pub arcs: Vec<ArcSource>,
    /// Smooth curves used by constraints.
    pub curves: Vec<CurveSource>,
    /// Angle constants used by constraints.
    pub angles: Vec<AngleSource>,
    /// Gear constants used by constraints.
    pub gears: Vec<GearSource>,
}

impl Parts {
    /// Bodies and markers of a model; lines, arcs and constants come with the constraints that use them.
    pub(crate) fn new(model: &Model) -> Self {
        let seats = seats(model);
        let bodies = seats.iter().map(|seat| seat.body.index() + 1).max();
        let mut it = Self {
            bodies: bodies.unwrap_or(1),
            seats,
            markers: Vec::new(),
            first_marker: Vec::new(),
            lines: Vec::new(),
            arcs: Vec::new(),
            curves: Vec::new(),
            angles: Vec::new(),
            gears: Vec::new(),
            model: model.clone(),
        };
        for (index, link) in model.links.iter().enumerate() {
            it.first_marker.push(it.markers.len() as u32);
            for point in &link.points {
                it.markers.push(LinkPointRef {
                    link: LinkId(index as u32),
                    point: point.point,
                });
            }
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
        marker.spot == Spot::Origin || self.is_origin(self.markers[marker.index as usize])
    }

    /// The point at a body's origin.
    pub fn origin(&self, body: BodyId) -> Option<PointId> {
        let mut markers = self.markers.iter();
        let at = markers.find(|at| self.body_of(at.link) == body && self.is_origin(**at))?;
        Some(at.point)
    }

    /// Every body's [origin](Self::origin).
    pub fn origins(&self) -> Vec<Option<PointId>> {
        let mut origins = vec![None; self.bodies];
        for at in self.markers.iter().filter(|at| self.is_origin(**at)) {
            origins[self.body_of(at.link).index()].get_or_insert(at.point);
        }
        origins
    }

    fn is_origin(&self, at: LinkPointRef) -> bool {
        let link = &self.model.links[at.link.index()];
        self.seats[at.link.index()].weld.is_none()
            && link.points.iter().any(|p| {
                p.point == at.point
                    && matches!(&p.place, Place::Cartesian { x, y } if *x == ZERO && *y == ZERO)
            })
    }

    /// Whether a body is no link: the shoe that goes with a pin along a smooth curve.
    pub fn is_shoe(&self, body: BodyId) -> bool {
        self.curves.iter().any(|curve| curve.shoe == body)
    }

    /// Whether a pin moves in a slot along a smooth curve that has ends: it starts between them, which closing alone does not tell.
    pub fn has_open_curves(&self) -> bool {
        self.curves.iter().any(|curve| !curve.closed)
    }

    /// The name of a body: its links' names joined, that of the joint for a shoe.
    pub fn body_name(&self, body: BodyId) -> String {
        if let Some(curve) = self.curves.iter().find(|curve| curve.shoe == body) {
            return format!("shoe of {}", self.model.joints[curve.joint.index()].name);
        }
        let names: Vec<&str> = (self.seats.iter().zip(&self.model.links))
            .filter(|(seat, _)| seat.body == body)
            .map(|(_, link)| link.name.as_str())
            .collect();
        names.join("+")
    }

    /// Whether an angle constant is zero whatever the dimensions.
    pub fn is_zero(&self, angle: &AngleSource) -> bool {
        let is_free = |link: LinkId| self.seats[link.index()].weld.is_none();
        angle.value == ZERO && angle.along.is_none() && is_free(angle.a) && is_free(angle.b)
    }

    pub(crate) fn line(&mut self, line: Line) -> Option<LineRef> {
        let from = self.marker(LinkPointRef {
            link: line.link,
            point: line.from,
        })?;
        let to = self.marker(LinkPointRef {
            link: line.link,
            point: line.to,
        })?;
        let index = self.lines.len() as u32;
        self.lines.push(LineSource::Points(from, to));
        Some(LineRef {
            body: from.body,
            index,
        })
    }

    /// The marker on `body` of a point that pins it to `other`.
    pub(crate) fn pin(&self, body: BodyId, other: BodyId) -> Option<Marker> {
        self.markers.iter().find_map(|at| {
            if self.body_of(at.link) != body {
                return None;
            }
            let shared = self.model.points.get(at.point.index())?;
            (shared.links.iter())
                .any(|link| self.body_of(*link) == other)
                .then(|| self.marker(*at))?
        })
    }

    pub(crate) fn arc(&mut self, arc: CircularArc) -> Option<ArcRef> {
        let point = |point| {
            self.marker(LinkPointRef {
                link: arc.link,
                point,
            })
        };
        let (from, to) = (point(arc.from)?, point(arc.to)?);
        self.arcs.push(ArcSource {
            from,
            to,
            radius: arc.radius,
            side: arc.side.sign(),
        });
        Some(ArcRef {
            body: from.body,
            index: self.arcs.len() as u32 - 1,
        })
    }

    /// The curve of a joint, with the marker at the origin of the new shoe that goes with its pin; `None` for a curve that
    /// the reader would have refused.
    pub(crate) fn curve(
        &mut self,
        joint: JointId,
        pin: LinkPointRef,
        on: &SmoothCurve,
    ) -> Option<(CurveRef, Marker)> {
        let link = on.link;
        let points = on.through.iter();
        let through: Option<Vec<Marker>> = points
            .map(|&point| self.marker(LinkPointRef { link, point }))
            .collect();
        let through = through.filter(|markers| markers.len() >= 3)?;
        let own = self.marker(pin)?;
        let shoe = BodyId(self.bodies as u32);
        self.bodies += 1;
        let origin = Marker {
            body: shoe,
            index: self.markers.len() as u32,
            spot: Spot::Origin,
        };
        self.markers.push(pin);
        self.curves.push(CurveSource {
            through,
            closed: on.closed,
            pin: own,
            shoe,
            joint,
        });
        let curve = CurveRef {
            body: self.body_of(link),
            index: self.curves.len() as u32 - 1,
        };
        Some((curve, origin))
    }

    pub(crate) fn angle(&mut self, angle: AngleSource) -> u32 {
        self.angles.push(angle);
        self.angles.len() as u32 - 1
    }

    pub(crate) fn gear(&mut self, gear: GearSource) -> u32 {
        self.gears.push(gear);
        self.gears.len() as u32 - 1
    }
}
