//! Shared by the integration tests: mechanisms as plain data that can be written as model files, moved, mirrored and
//! scaled, and a check of every joint that shares nothing with the product.
#![allow(
    dead_code,
    clippy::disallowed_methods,
    reason = "each test uses a part of it; std's sine is good enough to choose a pose"
)]

pub mod generate;
mod smooth_curve;

use std::fmt::Write as _;
use std::sync::Arc;

use kempe_measure::Sample;
use kempe_mechanism::{Configuration, Design, Mechanism, Pose};
use kempe_model::Model;
use kempe_motion::{Motion, MotionError};
use kempe_number::Random;

pub use smooth_curve::SmoothCurve;

/// Draws of many kinds, the same everywhere.
#[derive(Clone, Debug)]
pub struct Rng(pub u64);

impl Rng {
    pub fn bits(&mut self) -> u64 {
        let mut random = Random(self.0);
        let bits = random.bits();
        self.0 = random.0;
        bits
    }

    /// In [low, high).
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.bits() >> 11) as f64 / (1_u64 << 53) as f64)
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    pub fn chance(&mut self, p: f64) -> bool {
        self.range(0.0, 1.0) < p
    }

    pub fn angle(&mut self) -> f64 {
        self.range(-3.1, 3.1)
    }
}

pub type V = [f64; 2];

pub fn add(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1]]
}

pub fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1]]
}

pub fn times(a: V, k: f64) -> V {
    [a[0] * k, a[1] * k]
}

pub fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub fn cross(a: V, b: V) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

pub fn norm(a: V) -> f64 {
    a[0].hypot(a[1])
}

pub fn polar(r: f64, angle: f64) -> V {
    [r * angle.cos(), r * angle.sin()]
}

pub fn turn(a: V, angle: f64) -> V {
    let (s, c) = angle.sin_cos();
    [c * a[0] - s * a[1], s * a[0] + c * a[1]]
}

pub fn wrapped(angle: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    angle - turn * (angle / turn).round()
}

/// A link: its points in its own frame and where it is meant to be at the start (x, y, angle).
#[derive(Clone, Debug)]
pub struct SLink {
    pub name: String,
    pub points: Vec<(String, V)>,
    pub pose: [f64; 3],
}

impl SLink {
    pub fn world(&self, local: V) -> V {
        add([self.pose[0], self.pose[1]], turn(local, self.pose[2]))
    }

    pub fn local(&self, world: V) -> V {
        turn(sub(world, [self.pose[0], self.pose[1]]), -self.pose[2])
    }

    pub fn point(&self, name: &str) -> Option<V> {
        self.points.iter().find(|p| p.0 == name).map(|p| p.1)
    }
}

#[derive(Clone, Debug)]
pub enum SJoint {
    /// `link`'s point `at` on the line of the link `on`.
    Slider {
        link: usize,
        at: String,
        on: usize,
        line: [String; 2],
        angle: f64,
    },
    Slot {
        link: usize,
        pin: String,
        on: usize,
        line: [String; 2],
    },
    /// `link`'s point `pin` on an arc of the link `on`.
    Arc {
        link: usize,
        pin: String,
        on: usize,
        ends: [String; 2],
        radius: f64,
        left: bool,
    },
    /// `link`'s point `pin` on a smooth curve of the link `on`.
    Curve {
        link: usize,
        pin: String,
        on: usize,
        through: Vec<String>,
        closed: bool,
    },
    Belt {
        a: usize,
        b: usize,
        arm: usize,
        radii: [f64; 2],
        crossed: bool,
        phase: f64,
    },
    Weld {
        a: usize,
        b: usize,
        at: String,
        angle: f64,
    },
    Gears {
        a: usize,
        b: usize,
        arm: usize,
        teeth: [f64; 2],
        internal: bool,
        phase: f64,
    },
    Rack {
        rack: usize,
        pinion: usize,
        center: String,
        radius: f64,
        left: bool,
        offset: f64,
    },
}

#[derive(Clone, Debug)]
pub enum SKind {
    Turn {
        link: usize,
        relative_to: usize,
    },
    Cylinder {
        a: (usize, String),
        b: (usize, String),
    },
    /// Travel of a slider or slot, by its index in the joints.
    Slide {
        joint: usize,
    },
}

#[derive(Clone, Debug)]
pub struct SDrive {
    pub kind: SKind,
    pub from: f64,
    /// The same as `from` when it is held.
    pub to: f64,
    /// Duration of the stroke, s.
    pub time: f64,
    /// A law's name, or constant speed.
    pub law: Option<&'static str>,
}

/// A mechanism as data: links with their pose at the start, joints, drives.
#[derive(Clone, Debug, Default)]
pub struct Spec {
    /// The first is the frame.
    pub links: Vec<SLink>,
    pub joints: Vec<SJoint>,
    pub drives: Vec<SDrive>,
    /// Whether the file tells where everything is at the start.
    pub hints: bool,
    /// Further measures, name and text.
    pub measures: Vec<(String, String)>,
}

impl Spec {
    /// The model file. Metres and radians, so that every number is kept to the bit.
    pub fn toml(&self) -> String {
        let mut text = String::from("units = { length = \"m\", angle = \"rad\" }\n[links]\n");
        for link in &self.links {
            let bar = link.points.len() >= 2
                && link.points[0].1 == [0.0, 0.0]
                && link.points[1].1[1] == 0.0
                && link.points[1].1[0] > 0.0;
            let _ = write!(text, "{} = {{ ", link.name);
            let mut rest = &link.points[..];
            let mut parts = Vec::new();
            if bar {
                parts.push(format!("{}-{} = {:e}", rest[0].0, rest[1].0, rest[1].1[0]));
                rest = &rest[2..];
            }
            for (name, p) in rest {
                parts.push(format!("{name} = [{:e}, {:e}]", p[0], p[1]));
            }
            let _ = writeln!(text, "{} }}", parts.join(", "));
        }
        text.push_str("[joints]\n");
        for (index, joint) in self.joints.iter().enumerate() {
            let name = |l: usize| &self.links[l].name;
            let body = match joint {
                SJoint::Slider {
                    link,
                    at,
                    line,
                    angle,
                    ..
                } => format!(
                    "slider = \"{}\", at = \"{at}\", on = \"{} -> {}\", angle = {angle:e}",
                    name(*link),
                    line[0],
                    line[1]
                ),
                SJoint::Slot { pin, line, .. } => {
                    format!("pin = \"{pin}\", on = \"{} -> {}\"", line[0], line[1])
                }
                SJoint::Arc {
                    pin,
                    ends,
                    radius,
                    left,
                    ..
                } => format!(
                    "pin = \"{pin}\", arc = \"{} -> {}\", radius = {radius:e}, side = \"{}\"",
                    ends[0],
                    ends[1],
                    if *left { "left" } else { "right" }
                ),
                SJoint::Curve {
                    pin,
                    through,
                    closed,
                    ..
                } => format!("pin = \"{pin}\", through = {through:?}, closed = {closed}"),
                SJoint::Belt {
                    a,
                    b,
                    arm,
                    radii,
                    crossed,
                    phase,
                } => format!(
                    "belt = [\"{}\", \"{}\"], arm = \"{}\", radii = [{:e}, {:e}], crossed = {crossed}, phase = {phase:e}",
                    name(*a),
                    name(*b),
                    name(*arm),
                    radii[0],
                    radii[1]
                ),
                SJoint::Weld { a, b, at, angle } => format!(
                    "weld = [\"{}\", \"{}\"], at = \"{at}\", angle = {angle:e}",
                    name(*a),
                    name(*b)
                ),
                SJoint::Gears {
                    a,
                    b,
                    arm,
                    teeth,
                    internal,
                    phase,
                } => format!(
                    "gears = [\"{}\", \"{}\"], arm = \"{}\", teeth = [{}, {}], internal = {internal}, phase = {phase:e}",
                    name(*a),
                    name(*b),
                    name(*arm),
                    teeth[0],
                    teeth[1]
                ),
                SJoint::Rack {
                    rack,
                    pinion,
                    center,
                    radius,
                    left,
                    offset,
                } => format!(
                    "rack = \"{}\", pinion = \"{}\", center = \"{center}\", radius = {radius:e}, side = \"{}\", offset = {offset:e}",
                    name(*rack),
                    name(*pinion),
                    if *left { "left" } else { "right" }
                ),
            };
            let _ = writeln!(text, "j{index} = {{ {body} }}");
        }
        text.push_str("[drives]\n");
        for (index, drive) in self.drives.iter().enumerate() {
            let what = match &drive.kind {
                SKind::Turn { link, relative_to } => format!(
                    "turns = \"{}\", relative_to = \"{}\"",
                    self.links[*link].name, self.links[*relative_to].name
                ),
                SKind::Cylinder { a, b } => format!("cylinder = \"{}-{}\"", a.1, b.1),
                SKind::Slide { joint } => format!("slides = \"j{joint}\""),
            };
            let law = if drive.from == drive.to {
                format!("at = {:e}", drive.from)
            } else if let Some(law) = drive.law {
                format!(
                    "from = {:e}, to = {:e}, law = \"{law}\", in = \"{:e} s\"",
                    drive.from, drive.to, drive.time
                )
            } else {
                let unit = match drive.kind {
                    SKind::Turn { .. } => "rad/s",
                    _ => "m/s",
                };
                format!(
                    "from = {:e}, to = {:e}, speed = \"{:e} {unit}\"",
                    drive.from,
                    drive.to,
                    (drive.to - drive.from).abs() / drive.time
                )
            };
            let _ = writeln!(text, "d{index} = {{ {what}, {law} }}");
        }
        if self.hints {
            text.push_str("[assembly]\n");
            for link in &self.links[1..] {
                let _ = writeln!(text, "{} = {{ near = {:e} }}", link.name, link.pose[2]);
                if let Some((name, p)) = link.points.first() {
                    let on_frame = self.links[0].point(name).is_some();
                    let label = text.contains(&format!("\n{name} = {{ near"));
                    if !on_frame && !label {
                        let w = link.world(*p);
                        let _ = writeln!(text, "{name} = {{ near = [{:e}, {:e}] }}", w[0], w[1]);
                    }
                }
            }
        }
        if !self.measures.is_empty() {
            text.push_str("[measures]\n");
            for (name, body) in &self.measures {
                let _ = writeln!(text, "{name} = \"{body}\"");
            }
        }
        text
    }

    /// Reflected in the x axis: the same mechanism seen from behind.
    pub fn mirrored(&self) -> Self {
        let mut it = self.clone();
        for link in &mut it.links {
            link.pose = [link.pose[0], -link.pose[1], -link.pose[2]];
            for (_, p) in &mut link.points {
                p[1] = -p[1];
            }
        }
        for joint in &mut it.joints {
            match joint {
                SJoint::Slider { angle, .. } | SJoint::Weld { angle, .. } => *angle = -*angle,
                SJoint::Gears { phase, .. } | SJoint::Belt { phase, .. } => *phase = -*phase,
                SJoint::Rack { left, .. } | SJoint::Arc { left, .. } => *left = !*left,
                SJoint::Slot { .. } | SJoint::Curve { .. } => {}
            }
        }
        for drive in &mut it.drives {
            if matches!(drive.kind, SKind::Turn { .. }) {
                drive.from = -drive.from;
                drive.to = -drive.to;
            }
        }
        it
    }

    /// All lengths times `k`.
    pub fn scaled(&self, k: f64) -> Self {
        let mut it = self.clone();
        for link in &mut it.links {
            link.pose[0] *= k;
            link.pose[1] *= k;
            for (_, p) in &mut link.points {
                *p = times(*p, k);
            }
        }
        for joint in &mut it.joints {
            match joint {
                SJoint::Rack { radius, offset, .. } => {
                    *radius *= k;
                    *offset *= k;
                }
                SJoint::Arc { radius, .. } => *radius *= k,
                SJoint::Belt { radii, .. } => *radii = radii.map(|r| r * k),
                _ => {}
            }
        }
        for drive in &mut it.drives {
            if !matches!(drive.kind, SKind::Turn { .. }) {
                drive.from *= k;
                drive.to *= k;
            }
        }
        it
    }

    /// The frame's points turned about the origin and moved; everything follows.
    pub fn moved(&self, by: V, angle: f64) -> Self {
        let mut it = self.clone();
        let place = |p: V| add(turn(p, angle), by);
        for (index, link) in it.links.iter_mut().enumerate() {
            if index == 0 {
                for (_, p) in &mut link.points {
                    *p = place(*p);
                }
            } else {
                let p = place([link.pose[0], link.pose[1]]);
                link.pose = [p[0], p[1], link.pose[2] + angle];
            }
        }
        for joint in &mut it.joints {
            // Angles against the frame's own axis, which stays.
            if let SJoint::Weld {
                a, b, angle: fixed, ..
            } = joint
            {
                *fixed += match (*a, *b) {
                    (0, _) => angle,
                    (_, 0) => -angle,
                    _ => 0.0,
                };
            }
            if let SJoint::Belt {
                a,
                b,
                arm,
                radii,
                crossed,
                phase,
            } = joint
            {
                let second = if *crossed { radii[1] } else { -radii[1] };
                let by = |l: usize| if l == 0 { 0.0 } else { angle };
                *phase +=
                    (radii[0] * (by(*a) - by(*arm)) + second * (by(*b) - by(*arm))) / radii[0];
            }
            if let SJoint::Gears {
                a,
                b,
                arm,
                teeth,
                internal,
                phase,
            } = joint
            {
                let second = if *internal { -teeth[1] } else { teeth[1] };
                let by = |l: usize| if l == 0 { 0.0 } else { angle };
                *phase +=
                    (teeth[0] * (by(*a) - by(*arm)) + second * (by(*b) - by(*arm))) / teeth[0];
            }
        }
        for drive in &mut it.drives {
            if let SKind::Turn { link, relative_to } = drive.kind {
                let shift = if relative_to == 0 {
                    angle
                } else if link == 0 {
                    -angle
                } else {
                    0.0
                };
                drive.from += shift;
                drive.to += shift;
            }
        }
        it
    }

    /// The drives the other way round in time: each goes from its end to its start.
    pub fn reversed(&self) -> Self {
        let mut it = self.clone();
        for drive in &mut it.drives {
            std::mem::swap(&mut drive.from, &mut drive.to);
        }
        it
    }

    /// Largest extent of a link: what the product counts residuals in.
    pub fn size(&self) -> f64 {
        let mut size = 0.0_f64;
        for link in &self.links {
            for (_, a) in &link.points {
                for (_, b) in &link.points {
                    size = size.max(norm(sub(*a, *b)));
                }
            }
        }
        if size > 0.0 { size } else { 1.0 }
    }

    /// Largest error of any joint or drive when the links are at `poses` (x, y, unwrapped angle): lengths in sizes of
    /// the mechanism, directions in rad. Written from the model language's page, not from the product.
    pub fn gap(&self, poses: &[[f64; 3]], coordinates: &[f64]) -> f64 {
        self.errors(poses, coordinates).into_iter().fold(0.0, worse)
    }

    /// Whether a pin is beyond the ends of its smooth curve.
    pub fn is_off_curves(&self, poses: &[[f64; 3]]) -> bool {
        let point = |l: usize, name: &str| {
            let (p, q) = (self.links[l].point(name), poses[l]);
            add([q[0], q[1]], turn(p.expect("a point of the link"), q[2]))
        };
        self.joints.iter().any(|joint| match joint {
            SJoint::Curve {
                link,
                pin,
                on,
                through,
                closed,
            } => {
                let points: Vec<V> = through.iter().map(|p| point(*on, p)).collect();
                SmoothCurve::through(&points, *closed).is_left(point(*link, pin))
            }
            _ => false,
        })
    }

    /// The errors of all joints and drives, each smooth in the poses.
    pub fn errors(&self, poses: &[[f64; 3]], coordinates: &[f64]) -> Vec<f64> {
        let size = self.size();
        let world = |l: usize, p: V| {
            let q = poses[l];
            add([q[0], q[1]], turn(p, q[2]))
        };
        let point = |l: usize, name: &str| {
            world(l, self.links[l].point(name).expect("a point of the link"))
        };
        let mut all = Vec::new();
        let mut see = |x: f64| all.push(x);
        for (l, link) in self.links.iter().enumerate() {
            for (name, p) in &link.points {
                for (m, other) in self.links.iter().enumerate().skip(l + 1) {
                    if let Some(q) = other.point(name) {
                        let apart = sub(world(l, *p), world(m, q));
                        see(apart[0] / size);
                        see(apart[1] / size);
                    }
                }
            }
        }
        let line = |on: usize, names: &[String; 2]| {
            let (a, b) = (point(on, &names[0]), point(on, &names[1]));
            let v = sub(b, a);
            (a, times(v, 1.0 / norm(v)))
        };
        for joint in &self.joints {
            match joint {
                SJoint::Slider {
                    link,
                    at,
                    on,
                    line: names,
                    angle,
                } => {
                    let (a, t) = line(*on, names);
                    see(cross(t, sub(point(*link, at), a)) / size);
                    see(wrapped(poses[*link][2] - t[1].atan2(t[0]) - angle));
                }
                SJoint::Slot {
                    link,
                    pin,
                    on,
                    line: names,
                } => {
                    let (a, t) = line(*on, names);
                    see(cross(t, sub(point(*link, pin), a)) / size);
                }
                SJoint::Arc {
                    link,
                    pin,
                    on,
                    ends,
                    radius,
                    left,
                } => {
                    let (a, b) = (point(*on, &ends[0]), point(*on, &ends[1]));
                    let (half, middle) = (times(sub(b, a), 0.5), times(add(a, b), 0.5));
                    let rise = (radius * radius - dot(half, half)).sqrt() / norm(half);
                    let up = times([-half[1], half[0]], if *left { rise } else { -rise });
                    see((norm(sub(point(*link, pin), add(middle, up))) - radius) / size);
                }
                SJoint::Curve {
                    link,
                    pin,
                    on,
                    through,
                    closed,
                } => {
                    let points: Vec<V> = through.iter().map(|p| point(*on, p)).collect();
                    let curve = SmoothCurve::through(&points, *closed);
                    see(curve.distance(point(*link, pin)) / size);
                }
                SJoint::Belt {
                    a,
                    b,
                    arm,
                    radii,
                    crossed,
                    phase,
                } => {
                    let second = if *crossed { radii[1] } else { -radii[1] };
                    let arm = poses[*arm][2];
                    let sum = radii[0] * (poses[*a][2] - arm) + second * (poses[*b][2] - arm)
                        - radii[0] * phase;
                    see(sum / (radii[0] + radii[1]));
                }
                SJoint::Weld { a, b, angle, .. } => {
                    see(wrapped(poses[*b][2] - poses[*a][2] - angle));
                }
                SJoint::Gears {
                    a,
                    b,
                    arm,
                    teeth,
                    internal,
                    phase,
                } => {
                    let second = if *internal { -teeth[1] } else { teeth[1] };
                    let arm = poses[*arm][2];
                    let sum = teeth[0] * (poses[*a][2] - arm) + second * (poses[*b][2] - arm)
                        - teeth[0] * phase;
                    see(sum / (teeth[0] + teeth[1]));
                }
                SJoint::Rack {
                    rack,
                    pinion,
                    center,
                    radius,
                    left,
                    offset,
                } => {
                    let q = poses[*rack];
                    let s = turn(sub(point(*pinion, center), [q[0], q[1]]), -q[2])[0];
                    let side = if *left { 1.0 } else { -1.0 };
                    see((s + side * radius * (poses[*pinion][2] - q[2]) - offset) / size);
                }
            }
        }
        for (drive, q) in self.drives.iter().zip(coordinates) {
            match &drive.kind {
                SKind::Turn { link, relative_to } => {
                    see(wrapped(poses[*link][2] - poses[*relative_to][2] - q));
                }
                SKind::Cylinder { a, b } => {
                    see((norm(sub(point(a.0, &a.1), point(b.0, &b.1))) - q) / size);
                }
                SKind::Slide { joint } => {
                    let (link, at, on, names) = match &self.joints[*joint] {
                        SJoint::Slider {
                            link, at, on, line, ..
                        } => (link, at, on, line),
                        SJoint::Slot {
                            link,
                            pin,
                            on,
                            line,
                            ..
                        } => (link, pin, on, line),
                        _ => continue,
                    };
                    let (a, t) = line(*on, names);
                    see((dot(t, sub(point(*link, at), a)) - q) / size);
                }
            }
        }
        all
    }

    /// Poses of the links at the start.
    pub fn poses(&self) -> Vec<[f64; 3]> {
        self.links.iter().map(|l| l.pose).collect()
    }

    pub fn coordinates(&self) -> Vec<f64> {
        self.drives.iter().map(|d| d.from).collect()
    }
}

/// A model compiled as far as it goes without a motion.
pub struct Case {
    pub text: String,
    pub model: Model,
    pub mechanism: Arc<Mechanism>,
    pub design: Design<f64>,
    pub parameters: Vec<f64>,
}

impl Case {
    /// Reads a model file. Panics with its diagnostics where it is wrong.
    pub fn read(text: &str, name: &str) -> Self {
        Self::read_with(text, name, &mut |file| Err(format!("no file {file}")))
    }

    /// An example by its path, such as `seeds/door-lock`, with the tables beside it.
    pub fn example(path: &str) -> Self {
        let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/");
        let file = std::path::PathBuf::from(format!("{root}{path}.toml"));
        let text = std::fs::read_to_string(&file).expect("an example");
        Self::read_with(&text, path, &mut |table| {
            std::fs::read_to_string(file.with_file_name(table)).map_err(|e| e.to_string())
        })
    }

    pub fn read_with(
        text: &str,
        name: &str,
        files: &mut dyn FnMut(&str) -> Result<String, String>,
    ) -> Self {
        let model = match Model::from_toml(text, name, files) {
            Ok(checked) => checked.model,
            Err(list) => {
                let all: Vec<String> = list.iter().map(|d| d.render_plain(name, text)).collect();
                panic!("{}\n{text}", all.join("\n"));
            }
        };
        Self {
            text: text.to_owned(),
            ..Self::from_model(model)
        }
    }

    /// Compiles a model that was not read from one text.
    pub fn from_model(model: Model) -> Self {
        let mechanism = Mechanism::new(&model);
        let parameters: Vec<f64> = model.parameter_values();
        let design = Design::new(&mechanism, &parameters);
        Self {
            text: String::new(),
            model,
            mechanism,
            design,
            parameters,
        }
    }

    pub fn of(spec: &Spec) -> Self {
        Self::read(&spec.toml(), "case.toml")
    }

    pub fn motion(&self) -> Result<Arc<Motion>, MotionError> {
        Motion::new(&self.design)
    }

    /// The motion, or a panic that shows the file.
    pub fn must_move(&self) -> Arc<Motion> {
        match self.motion() {
            Ok(motion) => motion,
            Err(error) => panic!("{error:?}\n{}", self.text),
        }
    }

    /// Smallest singular value of the scaled constraint Jacobian at given link poses.
    pub fn sigma(&self, poses: &[[f64; 3]], coordinates: &[f64]) -> f64 {
        let mut state: Configuration<f64> = Configuration::new(&self.mechanism);
        let mut branch = kempe_mechanism::Branch::neutral(&self.mechanism);
        state.set_inputs(&self.mechanism, coordinates);
        for (index, pose) in poses.iter().enumerate().skip(1) {
            let seat = &self.mechanism.seats[index];
            if seat.weld.is_none() {
                state.poses[seat.body.index()] = Pose::from_angle(pose[0], pose[1], pose[2]);
                branch.near[seat.body.index()] = pose[2];
            }
        }
        let size = self.design.geometry.size(&self.mechanism);
        let mut system = kempe_mechanism::bordered::Bordered::new(&self.mechanism);
        kempe_mechanism::evidence::evidence(&self.design, &branch, &state, size, &mut system)
            .smallest_singular_value
    }

    /// Poses of the links from poses of the bodies.
    pub fn link_poses(&self, bodies: &[Pose<f64>]) -> Vec<[f64; 3]> {
        (0..self.model.links.len())
            .map(|index| {
                let (body, seat) = (
                    &bodies[self.mechanism.seats[index].body.index()],
                    &self.design.geometry.seats[index],
                );
                let [x, y] = body.place([seat.x, seat.y]);
                let [c, s] = body.turn([seat.c, seat.s]);
                [x, y, s.atan2(c)]
            })
            .collect()
    }
}

/// The larger in size; NaN wins.
pub fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else {
        a.max(b.abs())
    }
}

/// Largest difference of two sets of link poses: lengths in `size`, angles wrapped. Links listed in `idle` may turn.
pub fn difference(a: &[[f64; 3]], b: &[[f64; 3]], size: f64, idle: &[usize]) -> f64 {
    let mut worst = 0.0_f64;
    for (index, (p, q)) in a.iter().zip(b).enumerate() {
        let mut see = |x: f64| worst = worse(worst, x);
        see((p[0] - q[0]) / size);
        see((p[1] - q[1]) / size);
        if !idle.contains(&index) {
            see(wrapped(p[2] - q[2]));
        }
    }
    worst
}

/// `n` path parameters from one end of what was reached to the other.
pub fn spread(motion: &Motion, n: usize) -> Vec<f64> {
    let (low, high) = motion.reached();
    (0..n)
        .map(|i| {
            if i + 1 == n {
                high
            } else {
                low + (high - low) * i as f64 / (n - 1) as f64
            }
        })
        .collect()
}

/// All numbers of a row, bit for bit.
pub fn bits(sample: &Sample) -> Vec<u64> {
    let mut all = vec![
        sample.parameter.to_bits(),
        sample.closure.to_bits(),
        sample.smallest_singular_value.to_bits(),
    ];
    all.extend(sample.values.iter().map(|x| x.to_bits()));
    all.extend(sample.links.iter().flatten().map(|x| x.to_bits()));
    all.extend(sample.points.iter().flatten().map(|x| x.to_bits()));
    all
}
