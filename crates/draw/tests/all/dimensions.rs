//! Dimensions in pictures: the lines are as long as what they measure, and have a layer of their own in CAD.

use crate::mechanisms;
use kempe_draw::scene::{Item, Layer};
use kempe_draw::{DimensionKind, DimensionView, DrawOptions, Stage, Theme, dxf, svg};

/// The four-bar with its lengths, its base and a radius.
fn sized() -> (kempe_draw::MechanismView, Vec<kempe_draw::Frame>) {
    let case = mechanisms::crank_rocker();
    let mut view = case.view.clone();
    let frame = &case.frames[0];
    let length = |a: usize, b: usize| {
        let (p, q) = (frame.points[a], frame.points[b]);
        let value = kempe_number::math::hypot(q[0] - p[0], q[1] - p[1]);
        DimensionView {
            kind: DimensionKind::Length { a, b },
            value,
            text: format!("{:.3} mm", value * 1e3),
        }
    };
    view.dimensions = view
        .links
        .iter()
        .filter(|link| link.points.len() > 1)
        .map(|link| length(link.points[0], link.points[1]))
        .collect();
    (view, case.frames[..1].to_vec())
}

#[test]
fn a_dimension_line_is_as_long_as_what_it_measures() {
    let (view, frames) = sized();
    let stage = Stage::new(&view, &frames, DrawOptions::default());
    let scene = stage.scene(0);
    let groups = scene.groups.iter().filter(|g| g.layer == Layer::Dimension);
    let drawn: Vec<f64> = groups
        .filter_map(|group| match group.items.first() {
            Some(Item::Shape { paths, .. }) => {
                let [a, b] = [0, 1].map(|k: usize| paths[0].vertices[k].at);
                Some(kempe_number::math::hypot(b[0] - a[0], b[1] - a[1]))
            }
            _ => None,
        })
        .collect();
    assert_eq!(drawn.len(), view.dimensions.len());
    for (drawn, size) in drawn.iter().zip(&view.dimensions) {
        let there = drawn / stage.scale();
        assert!((there - size.value).abs() < 1e-9, "{there} {size:?}");
    }
    insta::assert_snapshot!("dimensions", svg::document(&scene, Theme::Light));
}

#[test]
fn dimensions_have_a_layer_in_dxf_and_none_without_them() {
    let (view, frames) = sized();
    let layers = |view| {
        let stage = Stage::new(view, &frames, DrawOptions::default());
        let text = dxf::document(&stage, 0);
        let drawing = ::dxf::Drawing::load(&mut text.as_bytes()).unwrap();
        let on = |e: &&::dxf::entities::Entity| e.common.layer == "DIMENSIONS";
        let named = drawing.layers().any(|l| l.name == "DIMENSIONS");
        (named, drawing.entities().filter(on).count())
    };
    let (named, count) = layers(&view);
    assert!(named && count >= 5 * view.dimensions.len(), "{count}");
    let mut plain = view.clone();
    plain.dimensions.clear();
    assert_eq!(layers(&plain), (false, 0));
}

#[test]
fn an_animation_keeps_its_room_for_the_mechanism() {
    let (view, frames) = sized();
    let steady = DrawOptions {
        steady: true,
        ..DrawOptions::default()
    };
    let scene = Stage::new(&view, &frames, steady).scene(0);
    assert!(scene.groups.iter().all(|g| g.layer != Layer::Dimension));
}
