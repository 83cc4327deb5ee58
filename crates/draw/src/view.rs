//! What to draw: a mechanism and its poses as plain data. SI units: lengths m, angles rad counter-clockwise from +x.

use crate::loads::LoadView;
use kempe_number::text::{significant, with_prefix};

/// A unit in which lengths are shown.
#[derive(Clone, Debug, PartialEq)]
pub struct LengthUnit {
    /// As shown, such as `mm`.
    pub name: String,
    /// One of it, in m.
    pub factor: f64,
}

impl LengthUnit {
    /// A unit by name and size in m.
    pub fn new(name: impl Into<String>, factor: f64) -> LengthUnit {
        LengthUnit {
            name: name.into(),
            factor,
        }
    }

    /// The size in m, or 1 when it is not a positive number.
    pub(crate) fn size(&self) -> f64 {
        if self.factor.is_finite() && self.factor > 0.0 {
            self.factor
        } else {
            1.0
        }
    }
}

/// A unit in which forces or moments are told.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadUnit {
    /// As shown, such as `lbf`.
    pub name: String,
    /// One of it in SI: in N or N m.
    pub factor: f64,
}

impl LoadUnit {
    /// A unit by name and size in N or N m.
    pub fn new(name: impl Into<String>, factor: f64) -> LoadUnit {
        LoadUnit {
            name: name.into(),
            factor,
        }
    }

    /// The size in N or N m, or 1 when it is not a positive number.
    pub(crate) fn size(&self) -> f64 {
        if self.factor.is_finite() && self.factor > 0.0 {
            self.factor
        } else {
            1.0
        }
    }

    /// A value in SI as text. Units of SI itself take a prefix: `2.5 kN`; others are as they were chosen.
    pub(crate) fn text(&self, si: f64, digits: usize) -> String {
        if self.name.starts_with('N') && self.factor == 1.0 {
            return with_prefix(si, &self.name, digits);
        }
        let value = si / self.size();
        let rounded = format!("{value:.*e}", digits.saturating_sub(1));
        let rounded = rounded.parse().unwrap_or(value);
        format!("{} {}", significant(rounded, digits), self.name)
    }
}

/// Units in which a drawing tells the sizes of its arrows.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadUnits {
    /// Of forces.
    pub force: LoadUnit,
    /// Of moments.
    pub moment: LoadUnit,
}

impl Default for LoadUnits {
    /// N and N m.
    fn default() -> LoadUnits {
        LoadUnits {
            force: LoadUnit::new("N", 1.0),
            moment: LoadUnit::new("N m", 1.0),
        }
    }
}

/// A mechanism, independent of its pose.
#[derive(Clone, Debug, PartialEq)]
pub struct MechanismView {
    /// Title.
    pub title: String,
    /// Unit of the scale bar and of DXF files.
    pub length_unit: LengthUnit,
    /// Units in which the sizes of forces and moments are told.
    pub load_units: LoadUnits,
    /// Names of the points, in the order of [`Frame::points`].
    pub points: Vec<String>,
    /// Links in the order of [`Frame::links`]; the first is the frame. A point that several links carry is drawn as a
    /// pin (a ground pivot when the frame is one of them, rings when they are three or more), unless a weld says otherwise.
    pub links: Vec<LinkView>,
    /// Joints other than pins.
    pub joints: Vec<JointView>,
    /// Paths of points to draw.
    pub traces: Vec<TraceView>,
    /// What is moved from outside.
    pub drives: Vec<DriveView>,
    /// Sizes to write into pictures of one pose; none when empty. An animation shows none.
    pub dimensions: Vec<DimensionView>,
}

/// A rigid body.
#[derive(Clone, Debug, PartialEq)]
pub struct LinkView {
    /// Name.
    pub name: String,
    /// Its points, as indices into [`MechanismView::points`].
    pub points: Vec<usize>,
}

/// A straight line of a link through two of its points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Guide {
    /// The link that carries it.
    pub link: usize,
    /// The point it starts from.
    pub from: usize,
    /// A point that gives its direction.
    pub to: usize,
}

/// A circular arc of a link through two of its points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArcGuide {
    /// The link that carries it.
    pub link: usize,
    /// The point it starts from.
    pub from: usize,
    /// The point it ends at.
    pub to: usize,
    /// Radius, m.
    pub radius: f64,
    /// +1 with the centre on the left of the way from start to end, -1 on the right.
    pub side: f64,
    /// It is the whole circle, not only the shorter part between start and end.
    pub closed: bool,
}

/// A smooth curve through points of a link.
#[derive(Clone, Debug, PartialEq)]
pub struct CurveGuide {
    /// The link that carries it.
    pub link: usize,
    /// The points it goes through, its first one first.
    pub through: Vec<usize>,
    /// Places along it in the link's axes, seen from its first point, m, each with the direction of the curve there, rad.
    pub along: Vec<([f64; 2], f64)>,
    /// It comes back to its first point.
    pub closed: bool,
}

/// A gear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wheel {
    /// The link that is the gear.
    pub link: usize,
    /// The point at its centre.
    pub center: usize,
    /// Pitch radius, m.
    pub radius: f64,
    /// Number of teeth; 0 draws the pitch circle only.
    pub teeth: u32,
}

/// A joint other than a pin.
#[derive(Clone, Debug, PartialEq)]
pub enum JointView {
    /// A block that slides along a guide without turning against it.
    Slider {
        /// The sliding link.
        block: usize,
        /// The point of it that stays on the guide.
        at: usize,
        /// The guide.
        guide: Guide,
    },
    /// A pin in a straight slot.
    Slot {
        /// The pin.
        pin: usize,
        /// The slot.
        guide: Guide,
    },
    /// A pin in a curved slot.
    ArcSlot {
        /// The pin.
        pin: usize,
        /// The slot.
        arc: ArcGuide,
    },
    /// A pin in a slot along a smooth curve.
    CurveSlot {
        /// The pin.
        pin: usize,
        /// The slot.
        curve: CurveGuide,
    },
    /// Two links made one.
    Weld {
        /// The point they share.
        at: usize,
        /// The links.
        links: [usize; 2],
    },
    /// Two gears in mesh.
    Gears {
        /// First gear.
        a: Wheel,
        /// Second gear.
        b: Wheel,
        /// The larger of them is a ring with its teeth inside.
        internal: bool,
    },
    /// A belt or chain over two wheels whose centres keep their distance.
    Belt {
        /// First wheel.
        a: Wheel,
        /// Second wheel.
        b: Wheel,
        /// Its straight runs cross.
        crossed: bool,
        /// It is a chain.
        chain: bool,
    },
    /// A pinion on a rack. The pitch line is parallel to the x axis of the rack's link and touches the pinion.
    Rack {
        /// The link that carries the rack.
        link: usize,
        /// The pinion.
        pinion: Wheel,
        /// +1 when the pinion lies on the left of the rack's x axis, -1 on the right.
        side: f64,
    },
    /// A hydraulic cylinder.
    Cylinder {
        /// Foot of the barrel.
        a: usize,
        /// Eye of the rod.
        b: usize,
    },
    /// A spring between two points.
    Spring {
        /// One end.
        a: usize,
        /// The other end.
        b: usize,
    },
    /// A damper between two points.
    Damper {
        /// One end.
        a: usize,
        /// The other end.
        b: usize,
    },
}

/// A path to draw.
#[derive(Clone, Debug, PartialEq)]
pub struct TraceView {
    /// What it is called.
    pub label: String,
    /// The point that draws it.
    pub point: usize,
}

/// Something that is moved from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveView {
    /// Name.
    pub name: String,
    /// What it moves.
    pub kind: DriveKind,
    /// The drive's coordinate grows along the motion; the arrow shows that sense.
    pub forward: bool,
}

/// What a drive moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DriveKind {
    /// A link turns.
    Turn {
        /// The link.
        link: usize,
        /// The point around which the arrow is drawn.
        about: usize,
    },
    /// A point slides along a guide.
    Slide {
        /// The point.
        at: usize,
        /// The guide.
        guide: Guide,
    },
    /// Two points move apart.
    Extend {
        /// One point.
        a: usize,
        /// The other point.
        b: usize,
    },
}

/// A size to be written into the drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct DimensionView {
    /// What is measured.
    pub kind: DimensionKind,
    /// Its value, m or rad.
    pub value: f64,
    /// What is written, with its unit: `25 mm`, `a = 25 mm`.
    pub text: String,
}

/// What a dimension measures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DimensionKind {
    /// The distance of two points.
    Length {
        /// One point.
        a: usize,
        /// The other point.
        b: usize,
    },
    /// How far two points are apart along the fixed x axis.
    Across {
        /// One point.
        a: usize,
        /// The other point.
        b: usize,
    },
    /// How far two points are apart along the fixed y axis.
    Up {
        /// One point.
        a: usize,
        /// The other point.
        b: usize,
    },
    /// The distance of a point from the line of a guide.
    Offset {
        /// The point.
        point: usize,
        /// The guide.
        guide: Guide,
    },
    /// The angle between the fixed x axis and the line of a guide, at its first point: from -90 to 90 degrees.
    Angle {
        /// The guide.
        guide: Guide,
    },
    /// The pitch radius of a wheel.
    Wheel(Wheel),
    /// The radius of a circular slot.
    Arc(ArcGuide),
}

/// A pose. A pose that was not reached has NaN coordinates; it is not drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Points in the fixed frame, m.
    pub points: Vec<[f64; 2]>,
    /// Links: x and y of the origin of each link's own frame (m) and the direction of its x axis (rad).
    pub links: Vec<[f64; 3]>,
    /// What distinguishes the pose, such as `motor = 30 deg`.
    pub label: String,
    /// Forces and moments to draw, each with the same role and label from pose to pose; none when empty.
    pub loads: Vec<LoadView>,
}

impl Frame {
    /// The same pose with forces and moments.
    pub fn with_loads(mut self, loads: Vec<LoadView>) -> Frame {
        self.loads = loads;
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_of_loads_are_told_in_the_chosen_unit() {
        let lbf = LoadUnit::new("lbf", 4.448_221_615_260_5);
        assert_eq!(lbf.text(2239.0 * 4.448_221_615_260_5, 2), "2200 lbf");
        assert_eq!(LoadUnit::new("kN", 1e3).text(50e3, 3), "50 kN");
        assert_eq!(LoadUnits::default().force.text(50e3, 3), "50 kN");
        assert_eq!(LoadUnits::default().moment.text(0.02, 3), "20 mN m");
    }
}
