//! Wheels, belts and racks of a drawing: put together they stand as they are drawn, at whatever angles that is.
#![allow(clippy::unwrap_used)]

use std::fmt::Write as _;

use kempe_measure::Sampler;
use kempe_model::Measure;
use kempe_number::math;

use crate::support::{Case, Rng, V, add, norm, polar, sub};

/// A mechanism as it is drawn. Every link lists its points; of all links the angles are known when it is drawn.
struct Drawing {
    rng: Rng,
    places: Vec<V>,
    /// Points of the links, the frame first.
    links: Vec<Vec<usize>>,
    joints: String,
    drives: String,
    driven: usize,
}

const FRAME: usize = 0;

impl Drawing {
    fn new(seed: u64) -> Self {
        let mut it = Self {
            rng: Rng(seed),
            places: Vec::new(),
            links: vec![Vec::new()],
            joints: String::new(),
            drives: String::new(),
            driven: 0,
        };
        for _ in 0..2 {
            it.point(FRAME);
        }
        it
    }

    /// A new point of a link, anywhere.
    fn point(&mut self, link: usize) -> usize {
        let place = [self.rng.range(-90.0, 90.0), self.rng.range(-90.0, 90.0)];
        self.places.push(place);
        self.links[link].push(self.places.len() - 1);
        self.places.len() - 1
    }

    /// A new link pinned to another at a new point, in any direction, and that point.
    fn pinned(&mut self, to: usize) -> (usize, usize) {
        let axis = self.point(to);
        (self.link_at(axis), axis)
    }

    /// A new link at a point, in any direction.
    fn link_at(&mut self, axis: usize) -> usize {
        let (far, angle) = (self.rng.range(20.0, 60.0), self.rng.angle());
        self.places.push(add(self.places[axis], polar(far, angle)));
        self.links.push(vec![axis, self.places.len() - 1]);
        self.links.len() - 1
    }

    fn name(link: usize) -> String {
        match link {
            FRAME => "frame".into(),
            link => format!("l{link}"),
        }
    }

    fn joint(&mut self, what: &str) {
        let count = self.joints.lines().count();
        writeln!(self.joints, "j{count} = {{ {what} }}").unwrap();
    }

    /// Drives a link, against the frame or another link that stands.
    fn drive(&mut self, link: usize) {
        let against = self.rng.below(link);
        let how = match self.driven {
            0 => "to = \"drawn + 1 deg\", speed = \"1 deg/s\"",
            _ => "at = \"drawn\"",
        };
        let (a, b) = match against != FRAME && self.rng.chance(0.3) {
            true => (against, link),
            false => (link, against),
        };
        let (a, b) = (Self::name(a), Self::name(b));
        let to = match b.as_str() {
            "frame" => String::new(),
            b => format!(", relative_to = \"{b}\""),
        };
        let count = self.driven;
        writeln!(self.drives, "m{count} = {{ turns = \"{a}\"{to}, {how} }}").unwrap();
        self.driven += 1;
    }

    /// A wheel on a carrier that another wheel of this carrier turns, in mesh or by a belt.
    fn meshed(&mut self, first: usize, carrier: usize) {
        let (second, axis) = self.pinned(carrier);
        let (a, b, arm) = (Self::name(first), Self::name(second), Self::name(carrier));
        let [z, w] = [0; 2].map(|_| 17 + self.rng.below(40));
        let from = self.links[first][0];
        let apart = norm(sub(self.places[axis], self.places[from]));
        let belt = self.rng.chance(0.4);
        let what = match (belt, self.rng.chance(0.5)) {
            (true, crossed) => {
                let [r, s] = [0; 2].map(|_| apart * self.rng.range(0.1, 0.45));
                format!(
                    "belt = [\"{a}\", \"{b}\"], radii = [{r}, {s}], arm = \"{arm}\", crossed = {crossed}"
                )
            }
            (false, ring) => {
                let w = if w == z { w + 1 } else { w };
                format!(
                    "gears = [\"{a}\", \"{b}\"], teeth = [{z}, {w}], arm = \"{arm}\", internal = {ring}"
                )
            }
        };
        self.joint(&what);
    }

    /// A wheel on a carrier that rolls along a link.
    fn rolling(&mut self, rack: usize, carrier: usize) {
        let (pinion, _) = self.pinned(carrier);
        let (rack, pinion) = (Self::name(rack), Self::name(pinion));
        let side = ["left", "right"][self.rng.below(2)];
        let radius = self.rng.range(5.0, 40.0);
        self.joint(&format!(
            "rack = \"{rack}\", pinion = \"{pinion}\", radius = {radius}, side = \"{side}\""
        ));
    }

    /// A link fast on another, with a direction of its own.
    fn welded(&mut self, to: usize) -> usize {
        let (link, _) = self.pinned(to);
        let (a, b) = (Self::name(to), Self::name(link));
        let pair = match self.rng.chance(0.5) {
            true => format!("\"{a}\", \"{b}\""),
            false => format!("\"{b}\", \"{a}\""),
        };
        self.joint(&format!("weld = [{pair}]"));
        link
    }

    /// Two links between two others: placed by their lengths.
    fn dyad(&mut self, a: usize, b: usize) -> [usize; 2] {
        let (first, _) = self.pinned(a);
        let end = self.links[first][1];
        let foot = self.point(b);
        self.links.push(vec![foot, end]);
        [first, self.links.len() - 1]
    }

    fn text(&self) -> String {
        let mut text =
            "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\n[places]\n".to_owned();
        for (i, [x, y]) in self.places.iter().enumerate() {
            writeln!(text, "P{i} = [{x:?}, {y:?}]").unwrap();
        }
        writeln!(text, "[links]").unwrap();
        for (i, points) in self.links.iter().enumerate() {
            let points: Vec<String> = points.iter().map(|p| format!("\"P{p}\"")).collect();
            writeln!(text, "{} = [{}]", Self::name(i), points.join(", ")).unwrap();
        }
        writeln!(
            text,
            "[joints]\n{}[drives]\n{}[measures]",
            self.joints, self.drives
        )
        .unwrap();
        for i in 1..self.links.len() {
            writeln!(text, "a{i} = \"angle(l{i})\"").unwrap();
        }
        text
    }

    /// Angles of the links as drawn, deg, without the frame's.
    fn angles(&self) -> Vec<f64> {
        let angle = |points: &Vec<usize>| {
            let [x, y] = sub(self.places[points[1]], self.places[points[0]]);
            math::atan2(y, x).to_degrees()
        };
        self.links.iter().skip(1).map(angle).collect()
    }
}

fn random(seed: u64) -> Drawing {
    let mut it = Drawing::new(seed);
    // links that something holds, and those of them that turn about their first point on another
    let mut standing = vec![FRAME];
    let mut wheels: Vec<(usize, usize)> = Vec::new();
    for step in 0..3 + it.rng.below(5) {
        let [on, other] = [0; 2].map(|_| standing[it.rng.below(standing.len())]);
        let before = it.links.len();
        match if step == 0 { 0 } else { it.rng.below(6) } {
            0 | 1 => {
                let (link, _) = it.pinned(on);
                it.drive(link);
                wheels.push((link, on));
            }
            2 if !wheels.is_empty() => {
                let (first, carrier) = wheels[it.rng.below(wheels.len())];
                it.meshed(first, carrier);
                wheels.push((before, carrier));
            }
            3 => {
                it.rolling(on, other);
                wheels.push((before, other));
            }
            4 => {
                it.welded(on);
            }
            _ if on != other => {
                it.dyad(on, other);
            }
            _ => continue,
        }
        standing.extend(before..it.links.len());
    }
    it
}

#[test]
fn what_is_drawn_is_put_together_as_it_is_drawn() {
    let mut meshes = 0;
    for seed in 0..400 {
        let drawing = random(seed);
        let wheeled = |l: &&str| {
            ["gears", "belt", "rack"]
                .iter()
                .any(|word| l.contains(word))
        };
        let count = drawing.joints.lines().filter(wheeled).count();
        if count == 0 {
            continue;
        }
        let text = drawing.text();
        let case = Case::read(&text, "drawn.toml");
        let motion = case.must_move();
        let measures: Vec<&Measure> = case.model.measures.iter().map(|m| &m.measure).collect();
        let values = Sampler::new(&motion, &measures)
            .unwrap()
            .at_time(0.0)
            .values;
        for (i, (found, drawn)) in values.iter().zip(drawing.angles()).enumerate() {
            let off = found.to_degrees() - drawn;
            assert!(
                off.abs() < 1e-7,
                "seed {seed}, l{}: {off} deg off\n{text}",
                i + 1
            );
        }
        meshes += count;
    }
    assert!(meshes > 400, "{meshes}");
}
