//! Sizes written into drawings, against the solved poses they are drawn on.

use crate::support::examples;
use kempe_draw::{DimensionKind, Frame, Guide};
use kempe_model::Model;
use kempe_number::math::{atan2, hypot};
use kempe_study::{dimensions, drawn, mechanism_view, pose_at};

/// Poses are solved to this part of their sizes.
const SOLVED: f64 = 1e-9;
/// Texts have six digits.
const WRITTEN: f64 = 1e-5;

/// What a dimension measures, in a pose.
fn measured(kind: &DimensionKind, frame: &Frame) -> Option<f64> {
    let at = |point: usize| frame.points[point];
    let way = |a: usize, b: usize| [at(b)[0] - at(a)[0], at(b)[1] - at(a)[1]];
    let line = |guide: Guide| way(guide.from, guide.to);
    Some(match *kind {
        DimensionKind::Length { a, b } => hypot(way(a, b)[0], way(a, b)[1]),
        DimensionKind::Across { a, b } => way(a, b)[0].abs(),
        DimensionKind::Up { a, b } => way(a, b)[1].abs(),
        DimensionKind::Offset { point, guide } => {
            let ([x, y], [px, py]) = (line(guide), way(guide.from, point));
            (x * py - y * px).abs() / hypot(x, y)
        }
        DimensionKind::Angle { guide } => {
            let [x, y] = line(guide);
            atan2(y / x, 1.0)
        }
        DimensionKind::Wheel(_) | DimensionKind::Arc(_) => return None,
    })
}

#[test]
fn sizes_are_those_of_the_poses() {
    let mut seen = 0;
    for (name, model) in examples() {
        let Ok(pose) = pose_at(&model, &[]) else {
            continue;
        };
        let view = mechanism_view(&model, None);
        let frame = drawn(&model, &pose.frame, String::new());
        for dimension in dimensions(&model, &view) {
            let Some(there) = measured(&dimension.kind, &frame) else {
                continue;
            };
            seen += 1;
            let off = (there - dimension.value).abs();
            assert!(
                off <= SOLVED * (1.0 + there.abs()),
                "{name}: {dimension:?} is {there}"
            );
            let text = dimension.text.rsplit("= ").next().expect("a text");
            let number: f64 = text
                .split(' ')
                .next()
                .expect("a number")
                .parse()
                .expect(text);
            let factor = match dimension.kind {
                DimensionKind::Angle { .. } => model.units.angle.factor,
                _ => model.units.length.factor,
            };
            let off = (number * factor - there.abs()).abs();
            assert!(off <= WRITTEN * there.abs(), "{name}: {text} for {there}");
        }
    }
    assert!(seen > 300, "{seen}");
}

#[test]
fn gears_in_mesh_fill_the_distance_of_their_axes() {
    let mut seen = 0;
    for (name, model) in examples() {
        let view = mechanism_view(&model, None);
        let Ok(pose) = pose_at(&model, &[]) else {
            continue;
        };
        let found = dimensions(&model, &view);
        let radius = |wheel: &kempe_draw::Wheel| {
            let own = |d: &&kempe_draw::DimensionView| d.kind == DimensionKind::Wheel(*wheel);
            found.iter().find(own).expect("a radius").value
        };
        for joint in &view.joints {
            if let kempe_draw::JointView::Gears { a, b, internal } = joint {
                let (p, q) = (pose.frame.points[a.center], pose.frame.points[b.center]);
                let apart = hypot(q[0] - p[0], q[1] - p[1]);
                let (ra, rb) = (radius(a), radius(b));
                let filled = if *internal { (ra - rb).abs() } else { ra + rb };
                assert!((filled - apart).abs() < 1e-9, "{name}: {filled} {apart}");
                seen += 1;
            }
        }
    }
    assert!(seen > 3, "{seen}");
}

fn texts(file: &str) -> Vec<String> {
    let mut none = |_: &str| Err(String::new());
    let model = Model::from_toml(file, "test", &mut none)
        .expect("a model")
        .model;
    let view = mechanism_view(&model, None);
    dimensions(&model, &view)
        .into_iter()
        .map(|d| d.text)
        .collect()
}

#[test]
fn a_length_that_is_a_parameter_is_told_by_its_name() {
    let found = texts(
        r#"
units = { length = "cm", angle = "deg" }
[parameters]
a = "25 mm"
double = "2 * a"
[links]
frame = { A = [0, 0], D = ["60 mm", "-15 mm"], G = [0, "30 mm"], H = ["40 mm", "70 mm"] }
crank = { A-B = "a" }
coupler = { B-C = "3 * a" }
rocker = { C-D = "double" }
block = { C = [0, 0] }
[joints]
line = { slider = "block", at = "C", on = "G -> H" }
[drives]
motor = { turns = "crank", from = 0, to = 360, speed = "60 rpm" }
"#,
    );
    // three times a parameter is none
    let all = [
        "6 cm",
        "1.5 cm",
        "a = 2.5 cm",
        "7.5 cm",
        "double = 5 cm",
        "45 deg",
        "2.12132 cm",
    ];
    assert_eq!(found, all);
}
