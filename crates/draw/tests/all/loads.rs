//! Forces on drawings: on the sheet in every pose, on one scale, in a layer for each role.

use crate::forces;
use crate::mechanisms;
use kempe_draw::scene::{Item, Layer, Scene};
use kempe_draw::{DrawOptions, Frame, LoadRole, LoadView, Stage, dxf};

/// The points of the shapes of the loads of a picture.
fn drawn(scene: &Scene) -> Vec<[f64; 2]> {
    let loads = scene
        .groups
        .iter()
        .filter(|g| matches!(g.layer, Layer::Load(_)));
    let points = |item: &Item| match item {
        Item::Shape { paths, .. } => paths
            .iter()
            .flat_map(|p| &p.vertices)
            .map(|v| v.at)
            .collect(),
        _ => Vec::new(),
    };
    loads.flat_map(|g| &g.items).flat_map(points).collect()
}

fn legend(scene: &Scene) -> String {
    let groups = scene.groups.iter().filter(|g| g.layer == Layer::LoadLegend);
    let text = |item: &Item| match item {
        Item::Text(text) => Some(text.content.clone()),
        _ => None,
    };
    let texts: Vec<String> = groups.flat_map(|g| &g.items).filter_map(text).collect();
    texts.join("; ")
}

#[test]
fn arrows_lie_on_the_sheet_in_every_pose() {
    for case in forces::all() {
        let stage = Stage::new(&case.view, &case.frames, DrawOptions::default());
        let [width, height] = stage.size();
        for row in 0..case.frames.len() {
            for [x, y] in drawn(&stage.scene(row)) {
                let inside = x > 0.0 && y > 0.0 && x < width && y < height;
                assert!(inside, "{} row {row}: {x} {y}", case.file);
            }
        }
    }
}

#[test]
fn what_is_not_drawn_as_it_is_stands_in_the_legend() {
    let case = forces::singular();
    let stage = Stage::new(&case.view, &case.frames, DrawOptions::default());
    let text = legend(&stage.scene(0));
    for part in ["broken: over", "up to 1.21 MN", "not finite, not drawn: 2"] {
        assert!(text.contains(part), "{part} in {text}");
    }
    let whole = forces::rocker();
    let stage = Stage::new(&whole.view, &whole.frames, DrawOptions::default());
    let text = legend(&stage.scene(0));
    assert!(text.starts_with("1 kN; 10 N m; "), "{text}");
    assert!(text.contains("not drawn: below 2.2 N m"), "{text}");
    assert!(
        !text.contains("broken") && !text.contains("finite"),
        "{text}"
    );
}

#[test]
fn moments_that_are_rounding_beside_the_forces_are_not_drawn() {
    let text = |moments: f64| {
        let mut case = forces::rocker();
        for load in case.frames.iter_mut().flat_map(|f| &mut f.loads) {
            load.moment *= moments;
        }
        let stage = Stage::new(&case.view, &case.frames, DrawOptions::default());
        legend(&stage.scene(0))
    };
    assert!(text(1e-3).contains("N m"), "{}", text(1e-3));
    assert!(!text(1e-10).contains("N m"), "{}", text(1e-10));
}

#[test]
fn a_force_at_a_single_point_has_a_picture() {
    let case = mechanisms::crank_rocker();
    let mut view = case.view.clone();
    view.points.truncate(1);
    view.links
        .iter_mut()
        .for_each(|l| l.points.retain(|p| *p == 0));
    view.traces.clear();
    let push = LoadView::force(LoadRole::Load, "", [0.0; 2], [1e-300, 0.0]);
    let frame = Frame {
        points: vec![[0.0; 2]],
        links: vec![[0.0; 3]; 4],
        ..Frame::default()
    };
    let frames = [frame.with_loads(vec![push])];
    let stage = Stage::new(&view, &frames, DrawOptions::default());
    assert!(
        drawn(&stage.scene(0))
            .iter()
            .flatten()
            .all(|v| v.is_finite() && *v > 0.0)
    );
}

#[test]
fn each_role_has_its_layer_in_dxf() {
    let case = forces::rocker();
    let stage = Stage::new(&case.view, &case.frames, DrawOptions::default());
    let text = dxf::document(&stage, 10);
    let drawing = ::dxf::Drawing::load(&mut text.as_bytes()).unwrap();
    for role in LoadRole::ALL {
        let layer = format!("FORCES_{}", role.name().to_uppercase());
        assert!(drawing.layers().any(|l| l.name == layer), "{layer}");
        assert!(
            drawing.entities().any(|e| e.common.layer == layer),
            "{layer}"
        );
    }
    assert!(
        drawing
            .entities()
            .any(|e| e.common.layer == "FORCES_LEGEND")
    );
}
