//! What the writers produce is read back by others, and stays as it was seen.

use crate::mechanisms;
use crate::reports;
use kempe_draw::plot::{Axis, Curve, Marker, MarkerKind, PlotSpec};
use kempe_draw::{DrawOptions, Stage, Theme, dxf, svg};

#[test]
fn poses_look_as_they_did() {
    for case in mechanisms::all() {
        let stage = Stage::new(
            &case.view,
            &case.frames[..1],
            DrawOptions {
                width: 100.0,
                ..DrawOptions::default()
            },
        );
        insta::assert_snapshot!(
            format!("pose-{}", case.file),
            svg::document(&stage.scene(0), Theme::Light)
        );
    }
}

#[test]
fn a_plot_looks_as_it_did() {
    let x: Vec<f64> = (0..=36).map(|k| f64::from(k) * 10.0).collect();
    let y = |scale: f64| {
        x.iter()
            .map(|v| {
                if *v == 120.0 {
                    f64::NAN
                } else {
                    scale * v * (360.0 - v)
                }
            })
            .collect()
    };
    let plot = PlotSpec {
        title: "Parabolas <with> a gap".into(),
        x: Axis::new("crank", "deg"),
        y: Axis::new("force", "N"),
        curves: vec![
            Curve {
                label: "one".into(),
                x: x.clone(),
                y: y(1.0),
                ..Curve::default()
            },
            Curve {
                label: "two".into(),
                x: x.clone(),
                y: y(-2.5),
                dashed: true,
                ..Curve::default()
            },
        ],
        markers: vec![Marker {
            at: 180.0,
            label: "dead point".into(),
            kind: MarkerKind::DeadPoint,
        }],
        ..PlotSpec::default()
    };
    insta::assert_snapshot!(
        "plot",
        svg::document(&plot.draw(120.0, 80.0).scene, Theme::Light)
    );
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let cases = mechanisms::all();
    let report = reports::report(&cases);
    assert_eq!(report.to_html(), report.clone().to_html());
}

#[test]
fn dxf_is_read_back_at_true_scale_with_a_layer_for_each_link() {
    for case in mechanisms::all() {
        let stage = Stage::new(&case.view, &case.frames, DrawOptions::default());
        let text = dxf::document(&stage, 3);
        let drawing = ::dxf::Drawing::load(&mut text.as_bytes()).unwrap();
        for (number, link) in case.view.links.iter().enumerate().skip(1) {
            let layer = format!("LINK_{number}_{}", link.name.replace(' ', "_"));
            assert!(drawing.layers().any(|l| l.name == layer), "{layer}");
        }
        // the first line is the first bar, in the mechanism's own unit
        let bar = case
            .view
            .links
            .iter()
            .skip(1)
            .find(|l| l.points.len() > 1)
            .unwrap();
        let [a, b] = [0, 1].map(|k| case.frames[3].points[bar.points[k]]);
        let unit = case.view.length_unit.factor;
        let line = drawing.entities().find_map(|e| match &e.specific {
            ::dxf::entities::EntityType::Line(line) => Some(line.clone()),
            _ => None,
        });
        let line = line.unwrap();
        for (ours, theirs) in [
            (a[0], line.p1.x),
            (a[1], line.p1.y),
            (b[0], line.p2.x),
            (b[1], line.p2.y),
        ] {
            assert!(
                (ours / unit - theirs).abs() < 1e-12 * (1.0 + theirs.abs()),
                "{ours} {theirs}"
            );
        }
        let circles = drawing
            .entities()
            .filter(|e| matches!(e.specific, ::dxf::entities::EntityType::Circle(_)));
        assert!(circles.count() >= 2);
    }
}

#[cfg(feature = "raster")]
#[test]
fn pictures_decode_to_the_size_asked_for() {
    use kempe_draw::raster::{self, animation};
    let case = mechanisms::crank_rocker();
    let stage = Stage::new(&case.view, &case.frames, DrawOptions::default());
    let bytes = raster::png(&stage.scene(0), Theme::Dark, 50.8).unwrap();
    let reader = png::Decoder::new(std::io::Cursor::new(&bytes))
        .read_info()
        .unwrap();
    assert_eq!(reader.info().width, 320);
    let options = animation::AnimationOptions {
        width: 200,
        pictures: 9,
        ping_pong: true,
        ..Default::default()
    };
    let bytes = animation::gif(&stage, &options).unwrap();
    let mut decoder = gif::DecodeOptions::new()
        .read_info(bytes.as_slice())
        .unwrap();
    let mut count = 0;
    while decoder.read_next_frame().unwrap().is_some() {
        count += 1;
    }
    assert_eq!((decoder.width(), count), (200, 8));
    let bytes = animation::apng(&stage, &options).unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes))
        .read_info()
        .unwrap();
    assert_eq!(
        reader.info().animation_control().map(|a| a.num_frames),
        Some(8)
    );
    let mut buffer = vec![0; reader.output_buffer_size().unwrap()];
    for _ in 0..8 {
        reader.next_frame(&mut buffer).unwrap();
    }
    let none = Stage::new(&case.view, &[], DrawOptions::default());
    assert_eq!(
        animation::gif(&none, &options),
        Err(raster::RasterError::NoFrames)
    );
    let huge = raster::png(&stage.scene(0), Theme::Light, 1e6);
    assert!(matches!(huge, Err(raster::RasterError::TooLarge { .. })));
}

#[test]
fn size_and_place_change_nothing_on_paper() {
    for case in mechanisms::all() {
        let options = DrawOptions {
            width: 100.0,
            ..DrawOptions::default()
        };
        let plain = svg::document(
            &Stage::new(&case.view, &case.frames, options.clone()).scene(7),
            Theme::Light,
        );
        for factor in [1e-6, 1e6] {
            let (mut view, mut frames) = (case.view.clone(), case.frames.clone());
            view.length_unit.factor *= factor;
            for frame in &mut frames {
                frame.points.iter_mut().flatten().for_each(|v| *v *= factor);
                frame
                    .links
                    .iter_mut()
                    .for_each(|l| (l[0], l[1]) = (l[0] * factor, l[1] * factor));
            }
            for joint in &mut view.joints {
                match joint {
                    kempe_draw::JointView::Gears { a, b, .. } => {
                        (a.radius, b.radius) = (a.radius * factor, b.radius * factor);
                    }
                    kempe_draw::JointView::Rack { pinion, .. } => pinion.radius *= factor,
                    _ => {}
                }
            }
            let scaled = svg::document(
                &Stage::new(&view, &frames, options.clone()).scene(7),
                Theme::Light,
            );
            // rounding may move the third decimal of a coordinate: compare what is drawn, and the layout
            let shape = |text: &str| {
                text.chars()
                    .filter(|c| c.is_alphabetic())
                    .collect::<String>()
            };
            assert_eq!(shape(&plain), shape(&scaled), "{} x {factor}", case.file);
            let first = |text: &str| text.split("</g>").nth(1).map(|g| g.len()).unwrap_or(0);
            assert!(first(&plain).abs_diff(first(&scaled)) <= 8);
        }
    }
}
