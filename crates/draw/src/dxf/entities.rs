//! Entities of a DXF file: exact bars, then the symbols as they are on paper.

use std::fmt::Write as _;

use kempe_number::math::atan2;

use super::{Writer, plain};
use crate::context::point;
use crate::scene::{Align, Group, Item, Layer, Path, Point, Text};

impl Writer<'_> {
    pub(super) fn entity(&mut self, kind: &str, class: &str) {
        self.handle += 1;
        let (handle, layer) = (self.handle, self.layer.clone());
        let _ = write!(
            self.out,
            "  0\n{kind}\n  5\n{handle:X}\n330\n1F\n100\nAcDbEntity\n  8\n{layer}\n100\n{class}\n"
        );
    }

    /// Exact lines between the points of each link, straight from the pose.
    pub(super) fn skeleton(&mut self, index: usize) {
        let Some(frame) = self.stage.context.frames.get(index) else {
            return;
        };
        let unit = self.unit();
        for (number, link) in self.stage.context.view.links.iter().enumerate().skip(1) {
            let points: Vec<Point> = link
                .points
                .iter()
                .filter_map(|&p| point(frame, p))
                .collect();
            let count = if points.len() > 2 {
                points.len()
            } else {
                points.len().saturating_sub(1)
            };
            self.layer = self.link_layer(number);
            for k in 0..count {
                let (a, b) = (points[k], points[(k + 1) % points.len()]);
                self.entity("LINE", "AcDbLine");
                self.numbers(&[
                    (10, a[0] / unit),
                    (20, a[1] / unit),
                    (30, 0.0),
                    (11, b[0] / unit),
                    (21, b[1] / unit),
                    (31, 0.0),
                ]);
            }
        }
    }

    pub(super) fn numbers(&mut self, pairs: &[(u32, f64)]) {
        for &(code, value) in pairs {
            self.number(code, value);
        }
    }

    pub(super) fn group(&mut self, group: &Group) {
        self.layer = match group.layer {
            Layer::Furniture | Layer::Caption | Layer::TracePast => return,
            Layer::Curve(_) | Layer::Limit | Layer::Vector => return,
            Layer::OtherTrace | Layer::Other => return,
            Layer::Ghost => "0".into(),
            Layer::TraceRest => "TRACES".into(),
            Layer::Ground => "GROUND".into(),
            Layer::Joint | Layer::Body | Layer::Gear => "JOINTS".into(),
            Layer::Drive => "DRIVES".into(),
            Layer::Dimension => super::DIMENSION_LAYER.into(),
            Layer::Label => "LABELS".into(),
            Layer::Load(role) | Layer::LoadLabel(role) => super::load_layer(role),
            Layer::LoadLegend => super::LEGEND_LAYER.into(),
            Layer::Link(link) => self.link_layer(link),
        };
        for item in &group.items {
            match item {
                Item::Shape { paths, .. } => {
                    for path in paths {
                        self.path(path, group);
                    }
                }
                Item::Circle { center, radius, .. } => {
                    let c = self.at(group.place.apply(*center));
                    self.entity("CIRCLE", "AcDbCircle");
                    let radius = self.length(*radius);
                    self.numbers(&[(10, c[0]), (20, c[1]), (30, 0.0), (40, radius)]);
                }
                Item::Text(text) => self.text(text, group),
            }
        }
    }

    pub(super) fn path(&mut self, path: &Path, group: &Group) {
        let points: Vec<Point> = path
            .vertices
            .iter()
            .map(|v| self.at(group.place.apply(v.at)))
            .collect();
        match (
            path.closed,
            &points[..],
            path.vertices.first().map_or(0.0, |v| v.bulge),
        ) {
            (_, [] | [_], _) => {}
            (false, [a, b], 0.0) => {
                let pairs = [
                    (10, a[0]),
                    (20, a[1]),
                    (30, 0.0),
                    (11, b[0]),
                    (21, b[1]),
                    (31, 0.0),
                ];
                self.entity("LINE", "AcDbLine");
                self.numbers(&pairs);
            }
            (false, [a, b], bulge) => self.arc(*a, *b, bulge),
            _ => {
                self.entity("LWPOLYLINE", "AcDbPolyline");
                self.pair(90, &points.len().to_string());
                self.pair(70, if path.closed { "1" } else { "0" });
                for (p, vertex) in points.iter().zip(&path.vertices) {
                    self.numbers(&[(10, p[0]), (20, p[1])]);
                    if vertex.bulge != 0.0 {
                        self.number(42, vertex.bulge);
                    }
                }
            }
        }
    }

    pub(super) fn arc(&mut self, a: Point, b: Point, bulge: f64) {
        let side = (1.0 - bulge * bulge) / (4.0 * bulge);
        let center = [
            (a[0] + b[0]) / 2.0 - side * (b[1] - a[1]),
            (a[1] + b[1]) / 2.0 + side * (b[0] - a[0]),
        ];
        let radius = crate::scene::distance(center, a);
        let angle =
            |p: Point| (atan2(p[1] - center[1], p[0] - center[0]).to_degrees() + 360.0) % 360.0;
        let (start, end) = if bulge > 0.0 {
            (angle(a), angle(b))
        } else {
            (angle(b), angle(a))
        };
        self.entity("ARC", "AcDbCircle");
        self.numbers(&[(10, center[0]), (20, center[1]), (30, 0.0), (40, radius)]);
        self.pair(100, "AcDbArc");
        self.numbers(&[(50, start), (51, end)]);
    }

    pub(super) fn text(&mut self, text: &Text, group: &Group) {
        let content = plain(&text.content);
        if content.trim().is_empty() {
            return;
        }
        let p = self.at(group.place.apply(text.at));
        let height = self.length(text.size);
        let align = match text.align {
            Align::Start => 0,
            Align::Middle => 1,
            Align::End => 2,
        };
        self.entity("TEXT", "AcDbText");
        self.numbers(&[(10, p[0]), (20, p[1]), (30, 0.0), (40, height)]);
        self.pair(1, &content);
        self.number(50, text.turn + group.place.angle.to_degrees());
        self.pair(72, &align.to_string());
        // aligned text is held by its second point
        if align > 0 {
            self.numbers(&[(11, p[0]), (21, p[1]), (31, 0.0)]);
        }
        self.pair(100, "AcDbText");
    }
}
