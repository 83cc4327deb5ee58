//! Hand-made mechanisms with their motion, for looking at and for tests: plain arithmetic, no solver.
#![allow(dead_code, clippy::unwrap_used)]

use std::f64::consts::PI;

use kempe_draw::*;
use kempe_number::math::{atan2, hypot, sin_cos};

pub type P = [f64; 2];

/// A mechanism with its poses, and the drive's angle at each.
#[derive(Clone)]
pub struct Case {
    pub file: &'static str,
    pub view: MechanismView,
    pub frames: Vec<Frame>,
    pub drive: Vec<f64>,
}

fn polar(o: P, r: f64, angle: f64) -> P {
    let (s, c) = sin_cos(angle);
    [o[0] + r * c, o[1] + r * s]
}

fn angle(a: P, b: P) -> f64 {
    atan2(b[1] - a[1], b[0] - a[0])
}

/// The point at the distances from two points, on the left of the line from the first to the second.
fn dyad(a: P, ra: f64, b: P, rb: f64) -> P {
    let d = hypot(b[0] - a[0], b[1] - a[1]);
    let x = (ra * ra - rb * rb + d * d) / (2.0 * d);
    let y = (ra * ra - x * x).sqrt();
    let (ux, uy) = ((b[0] - a[0]) / d, (b[1] - a[1]) / d);
    [a[0] + x * ux - y * uy, a[1] + x * uy + y * ux]
}

/// A point by its place in the axes of a link.
fn on(o: P, turn: f64, x: f64, y: f64) -> P {
    let (s, c) = sin_cos(turn);
    [o[0] + c * x - s * y, o[1] + s * x + c * y]
}

fn view(title: &str, points: &[&str], links: &[(&str, &str)]) -> MechanismView {
    let index = |name: &str| points.iter().position(|p| *p == name).unwrap();
    MechanismView {
        title: title.into(),
        length_unit: LengthUnit::new("mm", 1e-3),
        load_units: LoadUnits::default(),
        points: points.iter().map(|p| p.to_string()).collect(),
        links: links
            .iter()
            .map(|(name, on)| LinkView {
                name: (*name).into(),
                points: on.split_whitespace().map(index).collect(),
            })
            .collect(),
        joints: vec![],
        traces: vec![],
        drives: vec![],
        dimensions: vec![],
    }
}

/// A pose in mm and rad: points, and for every moving link its origin and angle.
fn frame(label: String, points: &[P], links: &[(P, f64)]) -> Frame {
    let mm = |p: &P| [p[0] * 1e-3, p[1] * 1e-3];
    let mut poses = vec![[0.0; 3]];
    poses.extend(links.iter().map(|(o, a)| [o[0] * 1e-3, o[1] * 1e-3, *a]));
    Frame {
        points: points.iter().map(mm).collect(),
        links: poses,
        label,
        ..Frame::default()
    }
}

fn turn(steps: usize) -> Vec<f64> {
    (0..=steps)
        .map(|k| 2.0 * PI * k as f64 / steps as f64)
        .collect()
}

fn case(
    file: &'static str,
    view: MechanismView,
    drive: Vec<f64>,
    pose: impl Fn(f64, String) -> Frame,
) -> Case {
    let label = |t: f64| {
        format!(
            "{} = {:.1} deg",
            view.drives.first().map_or("drive", |d| &d.name),
            t.to_degrees()
        )
    };
    let frames = drive.iter().map(|&t| pose(t, label(t))).collect();
    Case {
        file,
        view,
        frames,
        drive,
    }
}

fn motor(link: usize, about: usize) -> DriveView {
    DriveView {
        name: "motor".into(),
        kind: DriveKind::Turn { link, about },
        forward: true,
    }
}

pub fn crank_rocker() -> Case {
    let mut v = view(
        "Crank-rocker with coupler point",
        &["A", "D", "B", "C", "P"],
        &[
            ("frame", "A D"),
            ("crank", "A B"),
            ("coupler", "B C P"),
            ("rocker", "D C"),
        ],
    );
    v.traces = vec![
        TraceView {
            label: "path of P".into(),
            point: 4,
        },
        TraceView {
            label: "path of C".into(),
            point: 3,
        },
    ];
    v.drives = vec![motor(1, 0)];
    case("crank-rocker", v, turn(120), |t, label| {
        let (a, d) = ([0.0, 0.0], [60.0, 0.0]);
        let b = polar(a, 20.0, t);
        let c = dyad(b, 50.0, d, 40.0);
        let coupler = angle(b, c);
        let p = on(b, coupler, 25.0, 22.0);
        frame(
            label,
            &[a, d, b, c, p],
            &[(a, t), (b, coupler), (d, angle(d, c))],
        )
    })
}

pub fn slider_crank() -> Case {
    let mut v = view(
        "Engine slider-crank, offset 13 mm",
        &["A", "E", "F", "B", "C"],
        &[
            ("frame", "A E F"),
            ("crank", "A B"),
            ("rod", "B C"),
            ("piston", "C"),
        ],
    );
    v.joints = vec![JointView::Slider {
        block: 3,
        at: 4,
        guide: Guide {
            link: 0,
            from: 1,
            to: 2,
        },
    }];
    v.drives = vec![motor(1, 0)];
    case("slider-crank", v, turn(120), |t, label| {
        let b = polar([0.0, 0.0], 57.5, t);
        let c = [
            13.0,
            b[1] + (210.0 * 210.0 - (13.0 - b[0]) * (13.0 - b[0])).sqrt(),
        ];
        frame(
            label,
            &[[0.0, 0.0], [13.0, 0.0], [13.0, 300.0], b, c],
            &[([0.0; 2], t), (b, angle(b, c)), (c, 0.0)],
        )
    })
}

pub fn six_bar() -> Case {
    let mut v = view(
        "Stephenson six-bar with ternary links",
        &["A", "D", "G", "B", "C", "E", "F", "M"],
        &[
            ("frame", "A D G"),
            ("crank", "A B"),
            ("plate", "B C E M"),
            ("rocker", "D C"),
            ("bar", "E F"),
            ("output", "G F"),
        ],
    );
    v.traces = vec![TraceView {
        label: "path of E".into(),
        point: 5,
    }];
    v.drives = vec![motor(1, 0)];
    case("six-bar", v, turn(180), |t, label| {
        let (a, d, g) = ([0.0, 0.0], [60.0, -8.0], [-22.0, 62.0]);
        let b = polar(a, 18.0, t);
        let c = dyad(b, 48.0, d, 42.0);
        let plate = angle(b, c);
        let (e, m) = (on(b, plate, 22.0, 34.0), on(b, plate, 22.0, 12.0));
        let f = dyad(g, 34.0, e, 38.0);
        let links = [
            (a, t),
            (b, plate),
            (d, angle(d, c)),
            (e, angle(e, f)),
            (g, angle(g, f)),
        ];
        frame(label, &[a, d, g, b, c, e, f, m], &links)
    })
}

pub fn excavator() -> Case {
    let mut v = view(
        "Excavator arm with three cylinders",
        &["O", "S", "T", "U", "Q", "V", "W", "R", "K", "X", "Y", "Z"],
        &[
            ("frame", "O S"),
            ("boom", "O T U Q"),
            ("stick", "V Q W R K"),
            ("bucket", "R X Z"),
            ("lever", "K Y"),
            ("link", "Y X"),
        ],
    );
    v.length_unit = LengthUnit::new("m", 1.0);
    v.joints = vec![
        JointView::Cylinder { a: 1, b: 2 },
        JointView::Cylinder { a: 3, b: 5 },
        JointView::Cylinder { a: 6, b: 10 },
    ];
    v.traces = vec![TraceView {
        label: "tooth".into(),
        point: 11,
    }];
    v.drives = vec![
        DriveView {
            name: "boom lift".into(),
            kind: DriveKind::Extend { a: 1, b: 2 },
            forward: true,
        },
        DriveView {
            name: "stick".into(),
            kind: DriveKind::Extend { a: 3, b: 5 },
            forward: true,
        },
    ];
    let drive: Vec<f64> = (0..=100).map(|k| f64::from(k) / 100.0).collect();
    let mut case = case("excavator", v, drive, |s, _| {
        let label = format!("stroke = {:.0} %", 100.0 * s);
        let wave = |phase: f64| 0.5 - 0.5 * sin_cos(2.0 * PI * s + phase).1;
        let (o, foot) = ([0.0, 0.0], [500.0, -450.0]);
        let boom = 0.35 + 0.5 * wave(0.0);
        let (t, u) = (on(o, boom, 2300.0, 250.0), on(o, boom, 2500.0, 750.0));
        let q = on(o, boom, 5200.0, 0.0);
        let stick = -1.9 + 0.9 * wave(1.2);
        let (v1, w) = (on(q, stick, -700.0, 250.0), on(q, stick, 300.0, 450.0));
        let (r, k) = (on(q, stick, 2800.0, 0.0), on(q, stick, 2350.0, 60.0));
        let lever = stick + 0.55 + 0.9 * wave(2.0);
        let y = polar(k, 550.0, lever);
        let x = dyad(y, 500.0, r, 400.0);
        let bucket = angle(r, x);
        let z = on(r, bucket, -250.0, -1150.0);
        let links = [
            (o, boom),
            (q, stick),
            (r, bucket),
            (k, lever),
            (y, angle(y, x)),
        ];
        frame(label, &[o, foot, t, u, q, v1, w, r, k, x, y, z], &links)
    });
    case.view.length_unit = LengthUnit::new("m", 1.0);
    case
}

pub fn geared_five_bar() -> Case {
    let mut v = view(
        "Geared five-bar",
        &["A", "D", "B", "E", "C"],
        &[
            ("frame", "A D"),
            ("gear a", "A B"),
            ("gear b", "D E"),
            ("left bar", "B C"),
            ("right bar", "E C"),
        ],
    );
    v.joints = vec![JointView::Gears {
        a: Wheel {
            link: 1,
            center: 0,
            radius: 40e-3 * 2.0 / 3.0,
            teeth: 36,
        },
        b: Wheel {
            link: 2,
            center: 1,
            radius: 20e-3 * 2.0 / 3.0,
            teeth: 18,
        },
        internal: false,
    }];
    v.traces = vec![TraceView {
        label: "path of C".into(),
        point: 4,
    }];
    v.drives = vec![motor(1, 0)];
    case("geared-five-bar", v, turn(180), |t, label| {
        let (a, d) = ([0.0, 0.0], [40.0, 0.0]);
        let second = 0.4 - 2.0 * t;
        let (b, e) = (polar(a, 14.0, t), polar(d, 8.0, second));
        let c = dyad(e, 45.0, b, 45.0);
        let c = if c[1] < 0.0 {
            dyad(b, 45.0, e, 45.0)
        } else {
            c
        };
        frame(
            label,
            &[a, d, b, e, c],
            &[(a, t), (d, second), (b, angle(b, c)), (e, angle(e, c))],
        )
    })
}

pub fn quick_return() -> Case {
    let mut v = view(
        "Quick return: slotted lever and ram",
        &["A", "O", "B", "C", "D", "H", "E"],
        &[
            ("frame", "A O H E"),
            ("crank", "A B"),
            ("lever", "O C"),
            ("bar", "C D"),
            ("ram", "D"),
        ],
    );
    v.joints = vec![
        JointView::Slot {
            pin: 2,
            guide: Guide {
                link: 2,
                from: 1,
                to: 3,
            },
        },
        JointView::Slider {
            block: 4,
            at: 4,
            guide: Guide {
                link: 0,
                from: 6,
                to: 5,
            },
        },
    ];
    v.drives = vec![DriveView {
        forward: false,
        ..motor(1, 0)
    }];
    case(
        "quick-return",
        v,
        turn(120).into_iter().map(|t| -t).collect(),
        |t, label| {
            let (a, o) = ([0.0, 40.0], [0.0, 0.0]);
            let b = polar(a, 16.0, t);
            let lever = angle(o, b);
            let c = polar(o, 78.0, lever);
            let d = [
                c[0] + (30.0 * 30.0 - (84.0 - c[1]) * (84.0 - c[1])).sqrt(),
                84.0,
            ];
            let points = [a, o, b, c, d, [80.0, 84.0], [0.0, 84.0]];
            frame(
                label,
                &points,
                &[(a, t), (o, lever), (c, angle(c, d)), (d, 0.0)],
            )
        },
    )
}

pub fn rack() -> Case {
    let mut v = view(
        "Rack and pinion with spring, damper and weld",
        &["W", "R", "S", "E", "F", "N", "G", "M"],
        &[
            ("frame", "W E F N M"),
            ("pinion", "W"),
            ("rack", "R S"),
            ("post", "S G"),
        ],
    );
    v.joints = vec![
        JointView::Rack {
            link: 2,
            pinion: Wheel {
                link: 1,
                center: 0,
                radius: 15e-3,
                teeth: 18,
            },
            side: 1.0,
        },
        JointView::Slider {
            block: 2,
            at: 1,
            guide: Guide {
                link: 0,
                from: 3,
                to: 4,
            },
        },
        JointView::Weld {
            at: 2,
            links: [2, 3],
        },
        JointView::Spring { a: 5, b: 6 },
        JointView::Damper { a: 7, b: 6 },
    ];
    v.drives = vec![motor(1, 0)];
    case(
        "rack",
        v,
        turn(60).into_iter().map(|t| t / 3.0).collect(),
        |t, label| {
            let x = -10.0 + 15.0 * t;
            let (r, s) = ([x, -23.0], [x + 36.0, -23.0]);
            let points = [
                [0.0, 0.0],
                r,
                s,
                [-80.0, -23.0],
                [0.0, -23.0],
                [85.0, 4.0],
                [x + 36.0, 0.0],
                [85.0, -10.0],
            ];
            frame(label, &points, &[([0.0; 2], t), (r, 0.0), (s, PI / 2.0)])
        },
    )
}

pub fn ring_gear() -> Case {
    let mut v = view(
        "Cardan gear: a point of the planet runs straight",
        &["O", "Q", "P"],
        &[
            ("frame", "O"),
            ("ring", "O"),
            ("arm", "O Q"),
            ("planet", "Q P"),
        ],
    );
    v.links[1].points = vec![0];
    v.joints = vec![JointView::Gears {
        a: Wheel {
            link: 1,
            center: 0,
            radius: 40e-3,
            teeth: 40,
        },
        b: Wheel {
            link: 3,
            center: 1,
            radius: 20e-3,
            teeth: 20,
        },
        internal: true,
    }];
    v.traces = vec![TraceView {
        label: "path of P".into(),
        point: 2,
    }];
    v.drives = vec![motor(2, 0)];
    case("ring-gear", v, turn(120), |t, label| {
        let q = polar([0.0; 2], 20.0, t);
        let p = polar(q, 20.0, -t);
        frame(
            label,
            &[[0.0; 2], q, p],
            &[([0.0; 2], 0.0), ([0.0; 2], t), (q, -t)],
        )
    })
}

pub fn peaucellier() -> Case {
    let mut v = view(
        "Peaucellier inversor: an exact straight line",
        &["O", "Q", "C", "D", "E", "P"],
        &[
            ("frame", "O Q"),
            ("crank", "Q C"),
            ("arm d", "O D"),
            ("arm e", "O E"),
            ("side cd", "C D"),
            ("side ce", "C E"),
            ("side pd", "P D"),
            ("side pe", "P E"),
        ],
    );
    v.traces = vec![TraceView {
        label: "straight line".into(),
        point: 5,
    }];
    v.drives = vec![motor(1, 1)];
    let swing = (0..=100)
        .map(|k| -0.8 + 1.6 * f64::from(k) / 100.0)
        .collect();
    case("peaucellier", v, swing, |t, label| {
        let (o, q) = ([0.0; 2], [20.0, 0.0]);
        let c = polar(q, 20.0, t);
        let (d, e) = (dyad(o, 60.0, c, 25.0), dyad(c, 25.0, o, 60.0));
        let p = [d[0] + e[0] - c[0], d[1] + e[1] - c[1]];
        let bars = [(o, d), (o, e), (c, d), (c, e), (p, d), (p, e)];
        let mut links = vec![(q, t)];
        links.extend(bars.map(|(a, b)| (a, angle(a, b))));
        frame(label, &[o, q, c, d, e, p], &links)
    })
}

pub fn all() -> Vec<Case> {
    vec![
        crank_rocker(),
        slider_crank(),
        six_bar(),
        excavator(),
        geared_five_bar(),
        quick_return(),
        rack(),
        ring_gear(),
        peaucellier(),
    ]
}
