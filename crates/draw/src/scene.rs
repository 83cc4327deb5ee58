//! A picture as data: shapes and text in millimetres on paper, y up, in groups that can be moved as a whole.
//!
//! Every writer (SVG, PNG, GIF, DXF) reads this and nothing else, so what is shown is what is exported.

use kempe_number::math::{hypot, sin_cos};

use crate::tokens::Token;

/// A point on paper, mm, y up.
pub type Point = [f64; 2];

/// A colour with its opacity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paint {
    /// Colour.
    pub token: Token,
    /// Opacity, 0 to 1.
    pub alpha: f64,
}

impl From<Token> for Paint {
    fn from(token: Token) -> Self {
        Paint { token, alpha: 1.0 }
    }
}

/// How a shape is drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Style {
    /// Inside.
    pub fill: Option<Paint>,
    /// Outline.
    pub stroke: Option<Paint>,
    /// Width of the outline, mm.
    pub width: f64,
    /// Dashes and gaps by turns, mm; empty for a solid line.
    pub dash: Vec<f64>,
}

impl Style {
    /// Filled, without outline.
    pub fn fill(token: Token) -> Style {
        Style {
            fill: Some(token.into()),
            ..Style::default()
        }
    }

    /// Outline of the given width in mm, not filled.
    pub fn stroke(token: Token, width: f64) -> Style {
        Style {
            stroke: Some(token.into()),
            width,
            ..Style::default()
        }
    }

    /// The same with an opaque or translucent fill.
    pub fn filled(mut self, token: Token, alpha: f64) -> Style {
        self.fill = Some(Paint { token, alpha });
        self
    }

    /// The same with dashes, mm.
    pub fn dashed(mut self, dash: &[f64]) -> Style {
        self.dash = dash.to_vec();
        self
    }

    /// The same with everything fainter by a factor.
    pub fn faded(mut self, factor: f64) -> Style {
        for paint in [&mut self.fill, &mut self.stroke].into_iter().flatten() {
            paint.alpha *= factor;
        }
        self
    }
}

/// A corner of a path, and how the path goes on to the next one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Where.
    pub at: Point,
    /// Tangent of a quarter of the angle of the arc to the next vertex, positive counter-clockwise; 0 for a straight line.
    pub bulge: f64,
}

/// Straight lines and circular arcs, end to end.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Path {
    /// Corners in order.
    pub vertices: Vec<Vertex>,
    /// The last corner is joined to the first.
    pub closed: bool,
}

impl Path {
    /// Straight lines through the points.
    pub fn polyline(points: &[Point]) -> Path {
        Path {
            vertices: points.iter().map(|&at| Vertex { at, bulge: 0.0 }).collect(),
            closed: false,
        }
    }

    /// Straight lines around the points.
    pub fn polygon(points: &[Point]) -> Path {
        Path {
            closed: true,
            ..Path::polyline(points)
        }
    }

    /// A rectangle between two opposite corners, its own corners rounded.
    pub fn rectangle(low: Point, high: Point, radius: f64) -> Path {
        let ([x0, y0], [x1, y1]) = (low, high);
        if radius <= 0.0 {
            return Path::polygon(&[[x0, y0], [x1, y0], [x1, y1], [x0, y1]]);
        }
        let r = radius.min((x1 - x0) / 2.0).min((y1 - y0) / 2.0);
        let corner = 0.41421356237309503;
        let vertex = |x, y, bulge| Vertex { at: [x, y], bulge };
        let vertices = vec![
            vertex(x0 + r, y0, 0.0),
            vertex(x1 - r, y0, corner),
            vertex(x1, y0 + r, 0.0),
            vertex(x1, y1 - r, corner),
            vertex(x1 - r, y1, 0.0),
            vertex(x0 + r, y1, corner),
            vertex(x0, y1 - r, 0.0),
            vertex(x0, y0 + r, corner),
        ];
        Path {
            vertices,
            closed: true,
        }
    }

    /// An arc of a circle from the angle `start` over `sweep` rad, counter-clockwise when positive, short of a full turn.
    pub fn arc(center: Point, radius: f64, start: f64, sweep: f64) -> Path {
        let on = |angle: f64| {
            let (s, c) = sin_cos(angle);
            [center[0] + radius * c, center[1] + radius * s]
        };
        let (s, c) = sin_cos(sweep / 4.0);
        let vertices = vec![
            Vertex {
                at: on(start),
                bulge: s / c,
            },
            Vertex {
                at: on(start + sweep),
                bulge: 0.0,
            },
        ];
        Path {
            vertices,
            closed: false,
        }
    }

    /// The pieces of the path: start, end, bulge.
    pub fn segments(&self) -> impl Iterator<Item = (Point, Point, f64)> + '_ {
        let n = self.vertices.len();
        let count = if self.closed { n } else { n.saturating_sub(1) };
        (0..count).map(move |i| {
            (
                self.vertices[i].at,
                self.vertices[(i + 1) % n].at,
                self.vertices[i].bulge,
            )
        })
    }
}

/// Where text stands from its point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Align {
    /// Starts there.
    #[default]
    Start,
    /// Centred there.
    Middle,
    /// Ends there.
    End,
}

/// A line of text.
#[derive(Clone, Debug, PartialEq)]
pub struct Text {
    /// Where its base line is held.
    pub at: Point,
    /// Font size, mm.
    pub size: f64,
    /// What it says.
    pub content: String,
    /// Which part of it is at the point.
    pub align: Align,
    /// Turned counter-clockwise by so many degrees.
    pub turn: f64,
    /// Colour.
    pub paint: Paint,
    /// Heavier.
    pub bold: bool,
    /// A rim in the colour of the paper, to stay readable over lines.
    pub halo: bool,
}

impl Text {
    /// Plain text in ink.
    pub fn new(at: Point, size: f64, content: impl Into<String>) -> Text {
        Text {
            at,
            size,
            content: content.into(),
            align: Align::Start,
            turn: 0.0,
            paint: Token::Ink.into(),
            bold: false,
            halo: false,
        }
    }

    /// The same, aligned otherwise.
    pub fn aligned(mut self, align: Align) -> Text {
        self.align = align;
        self
    }

    /// The same, in another colour.
    pub fn colored(mut self, token: Token) -> Text {
        self.paint = token.into();
        self
    }
}

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
    /// The travelled path of a point.
    TracePast,
    /// Pins and welds.
    Joint,
    /// Arrows of the drives.
    Drive,
    /// Names of points.
    Label,
    /// Curves of a plot.
    Curve(usize),
    /// Title and caption.
    Caption,
}

impl Layer {
    /// A stable name for classes and CAD layers.
    pub fn name(self) -> String {
        match self {
            Layer::Furniture => "furniture".into(),
            Layer::Ghost => "ghost".into(),
            Layer::TraceRest => "trace-rest".into(),
            Layer::Ground => "ground".into(),
            Layer::Gear => "gear".into(),
            Layer::Link(index) => format!("link-{index}"),
            Layer::Body => "body".into(),
            Layer::TracePast => "trace-past".into(),
            Layer::Joint => "joint".into(),
            Layer::Drive => "drive".into(),
            Layer::Label => "label".into(),
            Layer::Curve(index) => format!("curve-{index}"),
            Layer::Caption => "caption".into(),
        }
    }
}

/// Where a group lies: its own coordinates are stretched along x, turned, then moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Origin, mm.
    pub at: Point,
    /// Direction of the group's x axis, rad.
    pub angle: f64,
    /// Stretch along the group's x axis.
    pub stretch: f64,
}

impl Place {
    /// On the paper as it is.
    pub const PAPER: Place = Place {
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
    pub place: Place,
    /// What it holds.
    pub items: Vec<Item>,
}

impl Group {
    /// Items on the paper.
    pub fn new(layer: Layer, items: Vec<Item>) -> Group {
        Group {
            layer,
            key: None,
            place: Place::PAPER,
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

/// Distance of two points.
pub(crate) fn distance(a: Point, b: Point) -> f64 {
    hypot(b[0] - a[0], b[1] - a[1])
}
