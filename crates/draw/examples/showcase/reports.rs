//! A report over the hand-made mechanisms, with measures from differences of their poses.
#![allow(dead_code)]

use kempe_draw::LoadRole;
use kempe_draw::plot::{Axis, Curve, Limit, Marker, MarkerKind, PlotSpec};
use kempe_draw::report::*;
use kempe_number::math::hypot;

use crate::mechanisms::Case;

fn differences(time: &[f64], values: &[f64]) -> Vec<f64> {
    let last = time.len().saturating_sub(1);
    let slope = |k: usize| {
        let (a, b) = (k.saturating_sub(1), (k + 1).min(last));
        (values[b] - values[a]) / (time[b] - time[a])
    };
    (0..time.len()).map(slope).collect()
}

/// A motion with the angles and speeds of its last link and the path of its last point.
pub fn motion(case: &Case) -> MotionReport {
    let rows = case.frames.len();
    let (point, link) = (case.view.points.len() - 1, case.view.links.len() - 1);
    let time: Vec<f64> = case.drive.iter().map(|d| d.abs()).collect();
    let degrees: Vec<f64> = case.drive.iter().map(|d| d.to_degrees()).collect();
    let coordinate = |k: usize| -> Vec<f64> {
        case.frames
            .iter()
            .map(|f| f.points[point][k] * 1e3)
            .collect()
    };
    let (x, y) = (coordinate(0), coordinate(1));
    let angle: Vec<f64> = case
        .frames
        .iter()
        .map(|f| f.links[link][2].to_degrees())
        .collect();
    let (vx, vy) = (differences(&time, &x), differences(&time, &y));
    let speed: Vec<f64> = vx.iter().zip(&vy).map(|(a, b)| hypot(*a, *b)).collect();
    let (name, last) = (&case.view.points[point], &case.view.links[link].name);
    let drive_axis = Axis::new("motor", "deg");
    let curve = |label: &str, y: &[f64]| Curve {
        label: label.into(),
        x: degrees.clone(),
        y: y.to_vec(),
        ..Curve::default()
    };
    let markers = vec![
        Marker {
            at: degrees[rows / 5],
            label: "dead point".into(),
            kind: MarkerKind::DeadPoint,
        },
        Marker {
            at: degrees[rows / 2],
            label: "change point".into(),
            kind: MarkerKind::ChangePoint,
        },
    ];
    let mut plots = vec![
        PlotSpec {
            title: format!("Angle of {last}"),
            x: drive_axis.clone(),
            y: Axis::new("angle", "deg"),
            curves: vec![curve("", &angle)],
            markers: markers.clone(),
            ..PlotSpec::default()
        },
        PlotSpec {
            title: format!("Velocity of {name}"),
            x: drive_axis.clone(),
            y: Axis::new("velocity", "mm/s"),
            curves: vec![
                curve("speed", &speed),
                curve("along x", &vx),
                curve("along y", &vy),
            ],
            ..PlotSpec::default()
        },
        PlotSpec {
            title: format!("Path of {name}"),
            x: Axis::new("x", "mm"),
            y: Axis::new("y", "mm"),
            curves: vec![Curve {
                label: String::new(),
                x: x.clone(),
                y: y.clone(),
                ..Curve::default()
            }],
            equal_aspect: true,
            ..PlotSpec::default()
        },
        PlotSpec {
            title: "Closure residual".into(),
            x: drive_axis,
            y: Axis {
                log: true,
                ..Axis::new("residual", "")
            },
            curves: vec![curve(
                "",
                &(0..rows)
                    .map(|k| 1e-16 * (1.0 + (k % 17) as f64 * 9.0))
                    .collect::<Vec<_>>(),
            )],
            ..PlotSpec::default()
        },
    ];
    if case.frames.iter().any(|f| !f.loads.is_empty()) {
        plots.splice(0..0, force_plots(case, &degrees));
    }
    MotionReport {
        name: case.file.into(),
        summary: format!("{} over one turn of its motor.", case.view.title),
        view: case.view.clone(),
        frames: case.frames.clone(),
        drive: 1,
        columns: vec![
            Column::new("time", "s", time),
            Column::new("motor", "deg", degrees),
            Column::new(format!("x({name})"), "mm", x),
            Column::new(format!("y({name})"), "mm", y),
            Column::new(format!("angle({last})"), "deg", angle),
            Column::new(format!("speed({name})"), "mm/s", speed),
        ],
        more: vec![],
        tests: vec![Column::new("closure", "", vec![3.1e-16; rows])],
        notes: vec![],
        mark: String::new(),
        against: None,
        plots,
        vectors: vec![],
        happenings: Vec::new(),
        events: vec![
            Event {
                row: rows / 5,
                place: "motor = 72.0000 deg".into(),
                label: "Dead point of the rocker".into(),
                kind: MarkerKind::DeadPoint,
            },
            Event {
                row: rows / 2,
                place: "motor = 180.00 deg".into(),
                label: "Change point".into(),
                kind: MarkerKind::ChangePoint,
            },
        ],
        evidence: Evidence {
            residual: Some((3.1e-16, 1e-12)),
            singular_value: Some(0.08231),
            scaling: "lengths by the mechanism's size, angles in rad".into(),
            not_reached: vec![],
            checks: vec![Check::new(
                "Two routes to the reactions",
                "3.1e-13 ≤ 1e-9",
                "motor = 117.5 deg",
                "Newton-Euler and virtual work agree, relative to the largest force",
            )],
            facts: vec![("Mobility".into(), "1 by count, 1 by rank".into())],
        },
    }
}

/// The first reaction as a vector, and its size against a capacity.
fn force_plots(case: &Case, degrees: &[f64]) -> Vec<PlotSpec> {
    let reaction = |f: &kempe_draw::Frame| {
        let load = f.loads.iter().find(|l| l.role == LoadRole::Reaction);
        load.map_or([f64::NAN; 2], |l| l.vector)
    };
    let forces: Vec<[f64; 2]> = case.frames.iter().map(reaction).collect();
    let along = |k: usize| -> Vec<f64> { forces.iter().map(|f| f[k]).collect() };
    let size: Vec<f64> = forces.iter().map(|f| hypot(f[0], f[1])).collect();
    let curve = |x: Vec<f64>, y: Vec<f64>| Curve {
        x,
        y,
        ..Curve::default()
    };
    let vector = PlotSpec {
        title: "Force on the coupler at B".into(),
        x: Axis::new("along x", "N"),
        y: Axis::new("along y", "N"),
        curves: vec![curve(along(0), along(1))],
        ..PlotSpec::default()
    };
    let capacity: Vec<f64> = degrees.iter().map(|d| 900.0 + 1.5 * d).collect();
    let size = PlotSpec {
        title: "Force at B against its capacity".into(),
        x: Axis::new("motor", "deg"),
        y: Axis::new("force", "N"),
        curves: vec![curve(degrees.to_vec(), size)],
        ..PlotSpec::default()
    };
    vec![
        vector.as_hodograph(degrees.to_vec(), "deg"),
        size.clone().with_limit(Limit::above("rated", 1100.0)),
        size.with_limit(Limit::along("when warm", degrees.to_vec(), capacity))
            .with_limit(Limit::below("least for contact", 500.0)),
    ]
}

/// A report over some mechanisms; the second has a gap.
pub fn report(cases: &[Case]) -> Report {
    let mut motions: Vec<MotionReport> = cases.iter().map(motion).collect();
    if let Some(second) = motions.get_mut(1) {
        for row in 30..40 {
            second.frames[row]
                .points
                .iter_mut()
                .for_each(|p| *p = [f64::NAN; 2]);
            second.frames[row]
                .links
                .iter_mut()
                .for_each(|l| *l = [f64::NAN; 3]);
            second
                .columns
                .iter_mut()
                .skip(2)
                .for_each(|c| c.values[row] = f64::NAN);
            for plot in &mut second.plots {
                plot.curves.iter_mut().for_each(|c| c.y[row] = f64::NAN);
            }
        }
        second.evidence.not_reached = vec![NotReached {
            first: 30,
            last: 39,
            reason: "the loop A-B-C does not close: gap 1.3 mm".into(),
        }];
    }
    let text = String::from;
    Report {
        title: "Crank-rocker".into(),
        file_name: "examples/seeds/crank-rocker.toml".into(),
        fronts: Vec::new(),
        motions,
        other_source: None,
        first: vec![Section {
            title: "Warnings".into(),
            blocks: vec![
                Block::Finding {
                    level: Level::Warning,
                    code: text("kin/low-transmission-angle"),
                    message: text(
                        "The transmission angle at C falls to 22.3 deg at motor = 0 deg.",
                    ),
                    help: text("Longer rocker or shorter crank: above 40 deg is usual."),
                },
                Block::Finding {
                    level: Level::Note,
                    code: String::new(),
                    message: text("Two assemblies exist; the first was chosen."),
                    help: String::new(),
                },
            ],
        }],
        sections: vec![
            Section {
                title: "Mobility".into(),
                blocks: vec![
                    Block::Facts(vec![
                        (text("By count (Chebyshev–Grübler)"), text("1")),
                        (text("By rank of the Jacobian"), text("1")),
                        (text("Grashof type"), text("crank-rocker")),
                    ]),
                    Block::Paragraph(text(
                        "Both counts agree: the mechanism is neither overconstrained nor does it idle.",
                    )),
                ],
            },
            Section {
                title: "Assur groups".into(),
                blocks: vec![Block::Table {
                    head: ["Group", "Class", "Links", "Solved by"].map(text).to_vec(),
                    rows: vec![
                        ["C", "RRR dyad", "coupler, rocker", "closed form"]
                            .map(text)
                            .to_vec(),
                    ],
                }],
            },
            Section {
                title: "Assemblies".into(),
                blocks: vec![Block::List(vec![
                    text("C left of B -> D (chosen)"),
                    text("C right of B -> D"),
                ])],
            },
        ],
        source: "[links]\nframe = { A = [0, 0] }\n".into(),
        generator: "kempe 0.1.0".into(),
        date: String::new(),
    }
}
