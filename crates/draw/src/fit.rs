//! From the model's metres to millimetres on paper: one scale, y up, chosen so that everything fits.

use crate::scene::Point;

/// Coordinates beyond this (m) are not drawn: they would swallow everything else.
pub const LARGEST: f64 = 1e12;

/// Whether a point can be drawn.
#[inline]
pub fn drawable(p: Point) -> bool {
    p[0].abs() < LARGEST && p[1].abs() < LARGEST
}

/// A box that grows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lower left corner.
    pub low: Point,
    /// Upper right corner.
    pub high: Point,
}

impl Bounds {
    /// A box that holds nothing.
    pub const EMPTY: Bounds = Bounds {
        low: [f64::INFINITY; 2],
        high: [f64::NEG_INFINITY; 2],
    };

    /// Takes in a disc of the given radius; what cannot be drawn is left out.
    pub fn add(&mut self, p: Point, radius: f64) {
        if drawable(p) && drawable([radius, 0.0]) {
            for (k, v) in p.into_iter().enumerate() {
                self.low[k] = self.low[k].min(v - radius);
                self.high[k] = self.high[k].max(v + radius);
            }
        }
    }

    /// Whether it holds anything.
    pub fn is_empty(&self) -> bool {
        self.low[0] > self.high[0]
    }
}

/// The paper and its scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// Millimetres on paper per metre of the model.
    pub scale: f64,
    /// Width of the paper, mm.
    pub width: f64,
    /// Height of the paper, mm.
    pub height: f64,
    middle: Point,
    paper_middle: Point,
}

/// Room around the drawing, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margins {
    /// At the left, the right, the top and the bottom.
    pub sides: [f64; 4],
}

impl Fit {
    /// The largest scale at which the box fits into a paper of the given width and at most the given height.
    /// A box without extent is drawn at `10 mm` per `unit` (m).
    pub fn new(bounds: Bounds, width: f64, heights: [f64; 2], margins: Margins, unit: f64) -> Fit {
        let [left, right, top, bottom] = margins.sides;
        let bounds = if bounds.is_empty() {
            Bounds {
                low: [0.0; 2],
                high: [0.0; 2],
            }
        } else {
            bounds
        };
        let extent = [
            bounds.high[0] - bounds.low[0],
            bounds.high[1] - bounds.low[1],
        ];
        let size = bounds
            .low
            .iter()
            .chain(&bounds.high)
            .fold(0.0_f64, |m, v| m.max(v.abs()));
        let room = [
            (width - left - right).max(1.0),
            (heights[1] - top - bottom).max(1.0),
        ];
        let scale = if extent[0].max(extent[1]) <= 1e-9 * size || extent[0].max(extent[1]) < 1e-12 {
            10.0 / unit
        } else {
            (room[0] / extent[0]).min(room[1] / extent[1])
        };
        let height =
            (extent[1] * scale + top + bottom).clamp(heights[0].min(heights[1]), heights[1]);
        Fit {
            scale,
            width,
            height,
            middle: [
                (bounds.low[0] + bounds.high[0]) / 2.0,
                (bounds.low[1] + bounds.high[1]) / 2.0,
            ],
            paper_middle: [left + room[0] / 2.0, bottom + (height - top - bottom) / 2.0],
        }
    }

    /// From the model (m) to paper (mm); `None` for a point that cannot be drawn.
    #[inline]
    pub fn paper(&self, p: Point) -> Option<Point> {
        let at = |k: usize| (p[k] - self.middle[k]) * self.scale + self.paper_middle[k];
        drawable(p).then(|| [at(0), at(1)])
    }

    /// From paper (mm) back to the model (m).
    pub fn model(&self, p: Point) -> Point {
        let at = |k: usize| (p[k] - self.paper_middle[k]) / self.scale + self.middle[k];
        [at(0), at(1)]
    }
}
