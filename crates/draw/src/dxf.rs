//! A pose as DXF (AC1015, "R2000") for CAD: true scale in the mechanism's length unit, one layer per link.
//!
//! Entities: LINE between a link's points (exact), CIRCLE, ARC, LWPOLYLINE with bulges for outlines and symbols, TEXT.
//! Symbols have the size that they have on paper.

use std::fmt::Write as _;

use kempe_number::math::atan2;

use crate::context::point;
use crate::scene::{Align, Group, Item, Layer, Path, Point, Text};
use crate::stage::Stage;
use crate::tokens::Token;

/// Longest layer name.
const LONGEST_NAME: usize = 60;

/// The DXF file of a pose, as text. Poses that cannot be drawn give a file without entities.
pub fn document(stage: &Stage, index: usize) -> String {
    let mut writer = Writer {
        stage,
        out: String::new(),
        handle: 0x100,
        layer: String::new(),
    };
    let view = stage.context.view;
    let mut layers: Vec<(String, u32)> = vec![("0".into(), Token::Ink.rgb(false))];
    for layer in ["GROUND", "JOINTS", "DRIVES", "TRACES", "LABELS"] {
        layers.push((layer.into(), Token::Ground.rgb(false)));
    }
    for link in 0..view.links.len() {
        layers.push((
            writer.link_layer(link),
            crate::symbols::link_token(link).rgb(false),
        ));
    }
    writer.header();
    writer.tables(&layers);
    writer.out.push_str("  0\nSECTION\n  2\nBLOCKS\n");
    for (name, handles) in [
        ("*Model_Space", ["1F", "20", "21"]),
        ("*Paper_Space", ["1B", "1C", "1D"]),
    ] {
        let [record, begin, end] = handles;
        let _ = write!(
            writer.out,
            "  0\nBLOCK\n  5\n{begin}\n330\n{record}\n100\nAcDbEntity\n  8\n0\n100\nAcDbBlockBegin\n  2\n{name}\n 70\n0\n \
             10\n0.0\n 20\n0.0\n 30\n0.0\n  3\n{name}\n  1\n\n  0\nENDBLK\n  5\n{end}\n330\n{record}\n100\nAcDbEntity\n  \
             8\n0\n100\nAcDbBlockEnd\n"
        );
    }
    writer
        .out
        .push_str("  0\nENDSEC\n  0\nSECTION\n  2\nENTITIES\n");
    writer.skeleton(index);
    for group in &stage.scene(index).groups {
        writer.group(group);
    }
    writer
        .out
        .push_str("  0\nENDSEC\n  0\nSECTION\n  2\nOBJECTS\n");
    writer.out.push_str(
        "  0\nDICTIONARY\n  5\nC\n330\n0\n100\nAcDbDictionary\n281\n1\n  3\nACAD_GROUP\n350\nD\n",
    );
    writer.out.push_str(
        "  0\nDICTIONARY\n  5\nD\n330\nC\n100\nAcDbDictionary\n281\n1\n  0\nENDSEC\n  0\nEOF\n",
    );
    writer.out
}

struct Writer<'a> {
    stage: &'a Stage<'a>,
    out: String,
    handle: u32,
    layer: String,
}

impl Writer<'_> {
    fn unit(&self) -> f64 {
        self.stage.context.view.length_unit.size()
    }

    /// From paper to the drawing's unit.
    fn at(&self, p: Point) -> Point {
        let p = self.stage.context.fit.model(p);
        [p[0] / self.unit(), p[1] / self.unit()]
    }

    /// A length on paper (mm) in the drawing's unit.
    fn length(&self, mm: f64) -> f64 {
        mm / self.stage.scale() / self.unit()
    }

    fn link_layer(&self, link: usize) -> String {
        let name = self
            .stage
            .context
            .view
            .links
            .get(link)
            .map_or("", |l| l.name.as_str());
        format!(
            "LINK_{link}_{}",
            plain(name).replace(' ', "_").trim_end_matches('_')
        )
    }

    fn pair(&mut self, code: u32, value: &str) {
        let _ = writeln!(self.out, "{code:>3}\n{value}");
    }

    fn number(&mut self, code: u32, value: f64) {
        let value = if value.is_finite() { value } else { 0.0 };
        let text = if value == 0.0 {
            "0.0".into()
        } else {
            format!("{value:?}")
        };
        self.pair(code, &text);
    }

    fn header(&mut self) {
        // $INSUNITS: the drawing's unit, 0 when CAD has no number for it
        let units = [
            (1e-3, 4),
            (1e-2, 5),
            (1.0, 6),
            (1e3, 7),
            (0.0254, 1),
            (0.3048, 2),
            (1e-6, 13),
            (0.9144, 10),
        ];
        let unit = self.unit();
        let code = units
            .iter()
            .find(|(size, _)| (size / unit - 1.0).abs() < 1e-9)
            .map_or(0, |(_, code)| *code);
        let imperial = matches!(code, 1 | 2 | 10);
        self.out.push_str(
            "  0\nSECTION\n  2\nHEADER\n  9\n$ACADVER\n  1\nAC1015\n  9\n$HANDSEED\n  5\nFFFFFF\n",
        );
        let _ = write!(
            self.out,
            "  9\n$INSUNITS\n 70\n{code}\n  9\n$MEASUREMENT\n 70\n{}\n",
            u8::from(!imperial)
        );
        self.out.push_str("  0\nENDSEC\n");
    }

    fn tables(&mut self, layers: &[(String, u32)]) {
        let table = |out: &mut String, name: &str, handle: &str, count: usize| {
            let _ = write!(
                out,
                "  0\nTABLE\n  2\n{name}\n  5\n{handle}\n330\n0\n100\nAcDbSymbolTable\n 70\n{count}\n"
            );
        };
        self.out.push_str("  0\nSECTION\n  2\nTABLES\n");
        table(&mut self.out, "VPORT", "8", 0);
        self.out.push_str("  0\nENDTAB\n");
        table(&mut self.out, "LTYPE", "5", 3);
        for (handle, name) in [("14", "ByBlock"), ("15", "ByLayer"), ("16", "Continuous")] {
            let _ = write!(
                self.out,
                "  0\nLTYPE\n  5\n{handle}\n330\n5\n100\nAcDbSymbolTableRecord\n100\nAcDbLinetypeTableRecord\n  2\n{name}\n \
                 70\n0\n  3\n\n 72\n65\n 73\n0\n 40\n0.0\n"
            );
        }
        self.out.push_str("  0\nENDTAB\n");
        table(&mut self.out, "LAYER", "2", layers.len());
        for (name, rgb) in layers {
            self.handle += 1;
            let _ = write!(
                self.out,
                "  0\nLAYER\n  5\n{:X}\n330\n2\n100\nAcDbSymbolTableRecord\n100\nAcDbLayerTableRecord\n  2\n{name}\n 70\n0\n \
                 62\n{}\n  6\nContinuous\n370\n-3\n390\nF\n",
                self.handle,
                nearest_index(*rgb)
            );
        }
        self.out.push_str("  0\nENDTAB\n");
        table(&mut self.out, "STYLE", "3", 1);
        self.out.push_str(
            "  0\nSTYLE\n  5\n11\n330\n3\n100\nAcDbSymbolTableRecord\n100\nAcDbTextStyleTableRecord\n  2\nStandard\n 70\n0\n \
             40\n0.0\n 41\n1.0\n 50\n0.0\n 71\n0\n 42\n2.5\n  3\ntxt\n  4\n\n  0\nENDTAB\n",
        );
        table(&mut self.out, "VIEW", "6", 0);
        self.out.push_str("  0\nENDTAB\n");
        table(&mut self.out, "UCS", "7", 0);
        self.out.push_str("  0\nENDTAB\n");
        table(&mut self.out, "APPID", "9", 1);
        self.out.push_str(
            "  0\nAPPID\n  5\n12\n330\n9\n100\nAcDbSymbolTableRecord\n100\nAcDbRegAppTableRecord\n  2\nACAD\n 70\n0\n  \
             0\nENDTAB\n",
        );
        self.out.push_str("  0\nTABLE\n  2\nDIMSTYLE\n  5\nA\n330\n0\n100\nAcDbSymbolTable\n 70\n0\n100\nAcDbDimStyleTable\n  0\nENDTAB\n");
        table(&mut self.out, "BLOCK_RECORD", "1", 2);
        for (handle, name) in [("1F", "*Model_Space"), ("1B", "*Paper_Space")] {
            let _ = write!(
                self.out,
                "  0\nBLOCK_RECORD\n  5\n{handle}\n330\n1\n100\nAcDbSymbolTableRecord\n100\nAcDbBlockTableRecord\n  \
                 2\n{name}\n340\n0\n"
            );
        }
        self.out.push_str("  0\nENDTAB\n  0\nENDSEC\n");
    }

    fn entity(&mut self, kind: &str, class: &str) {
        self.handle += 1;
        let (handle, layer) = (self.handle, self.layer.clone());
        let _ = write!(
            self.out,
            "  0\n{kind}\n  5\n{handle:X}\n330\n1F\n100\nAcDbEntity\n  8\n{layer}\n100\n{class}\n"
        );
    }

    /// Exact lines between the points of each link, straight from the pose.
    fn skeleton(&mut self, index: usize) {
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

    fn numbers(&mut self, pairs: &[(u32, f64)]) {
        for &(code, value) in pairs {
            self.number(code, value);
        }
    }

    fn group(&mut self, group: &Group) {
        self.layer = match group.layer {
            Layer::Furniture | Layer::Caption | Layer::Curve(_) | Layer::TracePast => return,
            Layer::Ghost => "0".into(),
            Layer::TraceRest => "TRACES".into(),
            Layer::Ground => "GROUND".into(),
            Layer::Joint | Layer::Body | Layer::Gear => "JOINTS".into(),
            Layer::Drive => "DRIVES".into(),
            Layer::Label => "LABELS".into(),
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

    fn path(&mut self, path: &Path, group: &Group) {
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

    fn arc(&mut self, a: Point, b: Point, bulge: f64) {
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

    fn text(&mut self, text: &Text, group: &Group) {
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

/// Text that any DXF reader takes: letters, digits and a few signs; everything else becomes `_`.
fn plain(text: &str) -> String {
    let safe = |c: char| {
        if c.is_ascii_alphanumeric() || " _-.,()=+".contains(c) {
            c
        } else {
            '_'
        }
    };
    text.chars().take(LONGEST_NAME).map(safe).collect()
}

/// The basic AutoCAD colour (1 to 9) nearest to a colour.
fn nearest_index(rgb: u32) -> u8 {
    let basic = [
        0xFF0000,
        0xFFFF00,
        0x00FF00,
        0x00FFFF,
        0x0000FF,
        0xFF00FF,
        0x000000,
        0x808080,
        0xC0C0C0_u32,
    ];
    let channel = |v: u32, shift: u32| i64::from((v >> shift) & 255);
    let far = |a: u32| {
        [0, 8, 16]
            .map(|s| (channel(a, s) - channel(rgb, s)).pow(2))
            .iter()
            .sum::<i64>()
    };
    let nearest = (0..basic.len()).min_by_key(|&k| far(basic[k])).unwrap_or(6);
    nearest as u8 + 1
}
