//! Pictures of every example, in several poses, with and without forces: their labels stand apart from each other and on
//! the sheet, measured by the letters of a real font.

#[path = "support/examples.rs"]
mod support;

use kempe_draw::scene::{Align, Item, Layer, Scene, Text};
use kempe_draw::{DrawOptions, Stage};
use kempe_model::StudyKind;
use kempe_study::{Silent, drawing_frames, mechanism_view, run};
use support::examples;

/// The widest of the fonts that pictures ask for.
fn font() -> ttf_parser::Face<'static> {
    ttf_parser::Face::parse(dejavu::sans::regular(), 0).expect("a font")
}

/// Lower left and upper right corner of an upright line of text: as wide as its letters advance, as high as their ink.
fn corners(face: &ttf_parser::Face, text: &Text) -> [[f64; 2]; 2] {
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
        Align::Middle => wide / 2.0,
        Align::End => wide,
    };
    let [x, y] = text.at;
    [[x - left, y + low], [x - left + wide, y + high]]
}

/// All texts of a picture: those that label something, and the others.
fn texts(scene: &Scene) -> (Vec<Text>, Vec<Text>) {
    let (mut labels, mut others) = (Vec::new(), Vec::new());
    for group in &scene.groups {
        let label = matches!(group.layer, Layer::Label | Layer::LoadLabel(_));
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

#[test]
fn no_two_labels_of_an_example_touch() {
    let face = font();
    let (mut seen, mut wrong) = (0, Vec::new());
    for (name, model) in examples() {
        for study in &model.studies {
            let forces = matches!(study.kind, StudyKind::Forces(_));
            let motion = matches!(study.kind, StudyKind::Motion(_));
            if !forces && !motion {
                continue;
            }
            let result = run(&model, study, &mut Silent).expect("a result");
            let view = mechanism_view(&model, Some(study.kind.along()));
            let frames = drawing_frames(&model, &result);
            let stage = Stage::new(&view, &frames, DrawOptions::default());
            for part in 0..8 {
                let row = part * (frames.len() - 1) / 7;
                let scene = stage.scene(row);
                let (labels, others) = texts(&scene);
                for (k, label) in labels.iter().enumerate() {
                    seen += 1;
                    let [low, high] = corners(&face, label);
                    let inside = low[0] > 0.0
                        && low[1] > 0.0
                        && high[0] < scene.width
                        && high[1] < scene.height;
                    if !inside {
                        wrong.push(format!("{name} row {row}: `{}` leaves", label.content));
                    }
                    for other in labels[..k].iter().chain(&others) {
                        let [other_low, other_high] = corners(&face, other);
                        let touch =
                            (0..2).all(|i| low[i] < other_high[i] && other_low[i] < high[i]);
                        if touch {
                            let (a, b) = (&label.content, &other.content);
                            wrong.push(format!("{name} row {row}: `{a}` on `{b}`"));
                        }
                    }
                }
            }
        }
    }
    assert!(seen > 2000, "{seen}");
    assert!(wrong.is_empty(), "{}:\n{}", wrong.len(), wrong.join("\n"));
}
