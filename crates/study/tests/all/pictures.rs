//! Pictures of every example, in several poses, with and without forces: their labels stand apart from each other and on
//! the sheet, measured by the letters of a real font.

use crate::support::examples;
use kempe_draw::scene::{Align, Item, Layer, Scene, Text};
use kempe_draw::{DrawOptions, JointView, MechanismView, Stage};
use kempe_model::{Model, StudyKind};
use kempe_study::{Silent, dimensions, drawing_frames, drawn, mechanism_view, pose_at, run};

/// The widest of the fonts that pictures ask for.
fn font() -> ttf_parser::Face<'static> {
    ttf_parser::Face::parse(dejavu::sans::regular(), 0).expect("a font")
}

/// The corners of a line of text in order around it: as wide as its letters advance, as high as their ink.
fn corners(face: &ttf_parser::Face, text: &Text) -> [[f64; 2]; 4] {
    let em = f64::from(face.units_per_em()) / text.size;
    let (mut wide, mut low, mut high) = (0.0, 0.0_f64, 0.0_f64);
    for c in text.content.chars() {
        let glyph = face.glyph_index(c).expect("a letter");
        wide += f64::from(face.glyph_hor_advance(glyph).expect("an advance")) / em;
        if let Some(ink) = face.glyph_bounding_box(glyph) {
            low = low.min(f64::from(ink.y_min) / em);
            high = high.max(f64::from(ink.y_max) / em);
        }
    }
    let left = match text.align {
        Align::Start => 0.0,
        Align::Middle => -wide / 2.0,
        Align::End => -wide,
    };
    let (s, c) = kempe_number::math::sin_cos(text.turn.to_radians());
    let at = |x: f64, y: f64| [text.at[0] + c * x - s * y, text.at[1] + s * x + c * y];
    [
        at(left, low),
        at(left + wide, low),
        at(left + wide, high),
        at(left, high),
    ]
}

/// Whether two convex outlines share more than an edge: no side of either has the other wholly beyond it.
fn touch(a: &[[f64; 2]; 4], b: &[[f64; 2]; 4]) -> bool {
    let parts = |outline: &[[f64; 2]; 4], other: &[[f64; 2]; 4]| {
        (0..4).any(|k| {
            let (p, q) = (outline[k], outline[(k + 1) % 4]);
            let beyond =
                |r: &[f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]) <= 0.0;
            other.iter().all(beyond)
        })
    };
    !parts(a, b) && !parts(b, a)
}

/// All texts of a picture: those that label something, and the others.
fn texts(scene: &Scene) -> (Vec<Text>, Vec<Text>) {
    let (mut labels, mut others) = (Vec::new(), Vec::new());
    for group in &scene.groups {
        let label = matches!(
            group.layer,
            Layer::Label | Layer::LoadLabel(_) | Layer::Dimension
        );
        for item in &group.items {
            if let Item::Text(text) = item {
                match label {
                    true => labels.push(text.clone()),
                    false => others.push(text.clone()),
                }
            }
        }
    }
    (labels, others)
}

/// What is wrong with the labels of a picture.
fn faults(face: &ttf_parser::Face, scene: &Scene) -> Vec<String> {
    let mut wrong = Vec::new();
    let (labels, others) = texts(scene);
    let outlines: Vec<_> = labels.iter().map(|t| corners(face, t)).collect();
    for (k, (label, outline)) in labels.iter().zip(&outlines).enumerate() {
        let inside =
            |[x, y]: &[f64; 2]| *x > 0.0 && *y > 0.0 && *x < scene.width && *y < scene.height;
        if !outline.iter().all(inside) {
            wrong.push(format!("`{}` leaves the sheet", label.content));
        }
        let before = labels[..k].iter().zip(outlines[..k].iter().copied());
        let others = others.iter().map(|other| (other, corners(face, other)));
        for (other, theirs) in before.chain(others) {
            if touch(outline, &theirs) {
                wrong.push(format!("`{}` on `{}`", label.content, other.content));
            }
        }
    }
    wrong
}

#[test]
fn no_two_labels_of_an_example_touch() {
    let face = font();
    let (mut seen, mut wrong) = (0, Vec::new());
    for (name, model) in examples() {
        for study in &model.studies {
            if !matches!(study.kind, StudyKind::Forces(_) | StudyKind::Motion(_)) {
                continue;
            }
            let result = run(&model, study, &mut Silent).expect("a result");
            let view = mechanism_view(&model, Some(study.kind.along()));
            let frames = drawing_frames(&model, &result);
            let stage = Stage::new(&view, &frames, DrawOptions::default());
            for part in 0..8 {
                let row = part * (frames.len() - 1) / 7;
                let scene = stage.scene(row);
                seen += texts(&scene).0.len();
                let found = faults(&face, &scene);
                wrong.extend(found.iter().map(|f| format!("{name} row {row}: {f}")));
            }
        }
    }
    assert!(seen > 2000, "{seen}");
    assert!(wrong.is_empty(), "{}:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn no_two_dimensions_of_an_example_touch() {
    let face = font();
    let (mut seen, mut wrong) = (0, Vec::new());
    for (name, model) in examples() {
        let Ok(pose) = pose_at(&model, &[]) else {
            continue;
        };
        let mut view = mechanism_view(&model, None);
        view.dimensions = dimensions(&model, &view);
        let frames = [drawn(&model, &pose.frame, String::new())];
        let scene = Stage::new(&view, &frames, DrawOptions::default()).scene(0);
        seen += view.dimensions.len();
        let found = faults(&face, &scene);
        wrong.extend(found.iter().map(|f| format!("{name}: {f}")));
    }
    assert!(seen > 300, "{seen}");
    assert!(wrong.is_empty(), "{}:\n{}", wrong.len(), wrong.join("\n"));
}

fn view(text: &str) -> MechanismView {
    let mut none = |_: &str| Err(String::new());
    let checked = Model::from_toml(text, "test", &mut none).expect("a model");
    mechanism_view(&checked.model, None)
}

#[test]
fn teeth_are_drawn_where_the_module_tells_them() {
    let teeth = |more: &str| {
        let text = format!(
            r#"
[links]
frame = {{ O = [0, "30 mm"], G = [0, 0], K = ["100 mm", 0] }}
pinion = {{ O = [0, 0], N = ["20 mm", 0] }}
rack = {{ R = [0, 0] }}
[joints]
housing = {{ slider = "rack", at = "R", on = "G -> K" }}
mesh = {{ rack = "rack", pinion = "pinion", radius = "30 mm"{more} }}
"#
        );
        let joints = view(&text).joints;
        joints.iter().find_map(|joint| match joint {
            JointView::Rack { pinion, .. } => Some(pinion.teeth),
            _ => None,
        })
    };
    assert_eq!(
        teeth(r#", pressure_angle = "20 deg", module = "3 mm""#),
        Some(20)
    );
    assert_eq!(teeth(""), Some(0));
    // no wheel has a part of a tooth
    assert_eq!(
        teeth(r#", pressure_angle = "20 deg", module = "3.7 mm""#),
        Some(0)
    );
}

#[test]
fn a_held_cylinder_is_a_cylinder_without_an_arrow() {
    let text = r#"
[places]
A = [0, 0]
P = [0.5, -0.6]
Q = [1.2, 0.6]
B = [3, 1]
R = [1.6, 1.4]
S = [2.7, 1.5]
[links]
frame = ["A", "P"]
boom = ["A", "Q", "B", "R"]
stick = ["B", "S"]
[drives]
lift = { cylinder = "P-Q", to = 2, speed = "0.1 m/s" }
stay = { cylinder = "R-S", at = "drawn" }
"#;
    let view = view(text);
    let drawn = |joint: &&JointView| matches!(joint, JointView::Cylinder { .. });
    assert_eq!(view.joints.iter().filter(drawn).count(), 2);
    let moved: Vec<&str> = view.drives.iter().map(|d| d.name.as_str()).collect();
    assert_eq!(moved, ["lift"]);
}
