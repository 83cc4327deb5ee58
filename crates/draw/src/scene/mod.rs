//! A picture as data: shapes and text in millimetres on paper, y up, in groups that can be moved as a whole.
//!
//! Every writer (SVG, PNG, GIF, DXF) reads this and nothing else, so what is shown is what is exported.

mod path;
mod style;
mod text;

pub use path::{Path, Point, Vertex};
pub use style::{Paint, Style};
pub use text::{Align, Text};

pub(crate) use path::{arc_points, distance};

use kempe_number::math::sin_cos;

use crate::loads::LoadRole;

/// A thing to draw.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// Paths drawn as one shape.
    Shape {
        /// The paths.
        paths: Vec<Path>,
        /// How.
        style: Style,
    },
    /// A full circle.
    Circle {
        /// Centre.
        center: Point,
        /// Radius, mm.
        radius: f64,
        /// How.
        style: Style,
    },
    /// A line of text.
    Text(Text),
}

impl Item {
    /// One path.
    pub fn path(path: Path, style: Style) -> Item {
        Item::Shape {
            paths: vec![path],
            style,
        }
    }

    /// A circle.
    pub fn circle(center: Point, radius: f64, style: Style) -> Item {
        Item::Circle {
            center,
            radius,
            style,
        }
    }
}

/// What a group belongs to; also the order in which groups are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Layer {
    /// Axes, grids, scale bar.
    Furniture,
    /// Other poses of the mechanism, faint.
    Ghost,
    /// The whole path of a point.
    TraceRest,
    /// Hatched guides and ground symbols.
    Ground,
    /// Gears and racks.
    Gear,
    /// Body of the link with this number.
    Link(usize),
    /// Slider blocks, cylinders and the like on top of the links.
    Body,
    /// Paths of the points of another design.
    OtherTrace,
    /// Another design, outlined.
    Other,
    /// The travelled path of a point.
    TracePast,
    /// Arrows of the loads of a role.
    Load(LoadRole),
    /// Pins and welds.
    Joint,
    /// Arrows of the drives.
    Drive,
    /// Dimension lines with their values.
    Dimension,
    /// Names of points.
    Label,
    /// Names at the arrows of the loads of a role.
    LoadLabel(LoadRole),
    /// What the arrows of loads mean.
    LoadLegend,
    /// Curves of a plot.
    Curve(usize),
    /// Lines that curves should not cross.
    Limit,
    /// A vector of a hodograph.
    Vector,
    /// Title and caption.
    Caption,
}

impl Layer {
    /// A stable name for classes.
    pub fn name(self) -> String {
        match self {
            Layer::Furniture => "furniture".into(),
            Layer::Ghost => "ghost".into(),
            Layer::TraceRest => "trace-rest".into(),
            Layer::Ground => "ground".into(),
            Layer::Gear => "gear".into(),
            Layer::Link(index) => format!("link-{index}"),
            Layer::Body => "body".into(),
            Layer::OtherTrace => "other trace-rest".into(),
            Layer::Other => "other".into(),
            Layer::TracePast => "trace-past".into(),
            Layer::Joint => "joint".into(),
            Layer::Drive => "drive".into(),
            Layer::Dimension => "dimension".into(),
            Layer::Label => "label".into(),
            Layer::Load(role) => format!("load load-{}", role.name()),
            Layer::LoadLabel(role) => format!("load label load-{}", role.name()),
            Layer::LoadLegend => "load-legend".into(),
            Layer::Curve(index) => format!("curve-{index}"),
            Layer::Limit => "limit".into(),
            Layer::Vector => "vector".into(),
            Layer::Caption => "caption".into(),
        }
    }
}

/// Where a group lies: its own coordinates are stretched along x, turned, then moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Origin, mm.
    pub at: Point,
    /// Direction of the group's x axis, rad.
    pub angle: f64,
    /// Stretch along the group's x axis.
    pub stretch: f64,
}

impl Placement {
    /// On the paper as it is.
    pub const PAPER: Placement = Placement {
        at: [0.0, 0.0],
        angle: 0.0,
        stretch: 1.0,
    };

    /// From the group's coordinates to the paper's.
    pub fn apply(&self, p: Point) -> Point {
        let (s, c) = sin_cos(self.angle);
        let x = p[0] * self.stretch;
        [self.at[0] + c * x - s * p[1], self.at[1] + s * x + c * p[1]]
    }
}

/// Items that lie and move together.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// What it belongs to.
    pub layer: Layer,
    /// Who it is, when a script must find it again.
    pub key: Option<String>,
    /// Where it lies.
    pub place: Placement,
    /// What it holds.
    pub items: Vec<Item>,
}

impl Group {
    /// Items on the paper.
    pub fn new(layer: Layer, items: Vec<Item>) -> Group {
        Group {
            layer,
            key: None,
            place: Placement::PAPER,
            items,
        }
    }
}

/// A picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Width, mm.
    pub width: f64,
    /// Height, mm.
    pub height: f64,
    /// What it shows, for readers who cannot see it.
    pub title: String,
    /// Groups, the first at the bottom.
    pub groups: Vec<Group>,
}
