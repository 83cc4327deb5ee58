//! Nothing that a model file can hold breaks a picture or gets out of its place in the page.

use crate::mechanisms;
use crate::reports;
use kempe_draw::plot::{Axis, Curve, Hodograph, Limit, PlotSpec};
use kempe_draw::report::{
    Block, Check, Column, FrontDesign, FrontReport, MOST_ROWS, Note, PointVectors, Report,
    VectorKind,
};
use kempe_draw::*;
use proptest::prelude::*;

const EVIL: &str = "</script><script>alert(1)</script><img src=x onerror=alert(2)>\"' {{data}} ]]> \u{2028}\u{0}&amp;";

fn evil_report() -> Report {
    let mut report = reports::report(&[mechanisms::crank_rocker(), mechanisms::slider_crank()]);
    let text = || EVIL.to_string();
    (report.title, report.file_name, report.generator) = (text(), text(), text());
    (report.source, report.date) = (text(), text());
    for motion in &mut report.motions {
        (motion.name, motion.summary, motion.view.title) = (text(), text(), text());
        motion.view.points.iter_mut().for_each(|p| *p = text());
        motion.view.links.iter_mut().for_each(|l| l.name = text());
        motion
            .columns
            .iter_mut()
            .for_each(|c| (c.name, c.unit) = (text(), text()));
        (motion.mark, motion.notes) = (
            text(),
            vec![Note {
                first: 0,
                last: 9,
                text: text(),
            }],
        );
        motion.view.length_unit.name = text();
        motion
            .events
            .iter_mut()
            .for_each(|e| (e.label, e.place) = (text(), text()));
        motion.evidence.facts.push((text(), text()));
        motion.evidence.checks = vec![Check::new(text(), text(), text(), text())];
        for frame in &mut motion.frames {
            let push = LoadView::force(LoadRole::Friction, text(), [0.0; 2], [1.0, 2.0]);
            frame.loads = vec![push];
        }
        for plot in &mut motion.plots {
            (plot.title, plot.x.label, plot.y.unit) = (text(), text(), text());
            plot.curves.iter_mut().for_each(|c| c.label = text());
            plot.markers.iter_mut().for_each(|m| m.label = text());
        }
    }
    let column = || Column::new(text(), text(), vec![1.0, 2.0]);
    report.fronts = vec![FrontReport {
        name: text(),
        about: text(),
        columns: vec![column(), column()],
        goals: vec![0, 1],
        own: Some(vec![1.5; 2]),
        plot: PlotSpec {
            title: text(),
            ..report.motions[0].plots[0].clone()
        },
        designs: vec![
            FrontDesign {
                name: text(),
                file: text(),
                note: text(),
                moving: Some((
                    report.motions[0].view.clone(),
                    report.motions[0].frames.clone(),
                )),
                motion: text(),
            };
            2
        ],
    }];
    for section in report.first.iter_mut().chain(&mut report.sections) {
        section.title = text();
        section.blocks = vec![Block::Paragraph(text()), Block::List(vec![text()])];
    }
    report
}

#[test]
fn no_text_gets_out_of_its_place() {
    let html = evil_report().to_html();
    // the page's own three script elements, and no other element from a text
    assert_eq!(html.matches("<script").count(), 3);
    assert_eq!(html.matches("</script").count(), 3);
    assert_eq!(html.matches("<img").count(), 0);
    assert!(!html.contains("\u{2028}\u{0}"));
    for (id, count) in [("data", 2), ("fronts", 1)] {
        let head = format!("id=\"{id}\">");
        let start = html.find(&head).unwrap() + head.len();
        let json = &html[start..start + html[start..].find("</script>").unwrap()];
        let data: serde_json::Value = serde_json::from_str(json).unwrap();
        assert_eq!(data.as_array().map(Vec::len), Some(count));
        assert_eq!(data[0]["name"], EVIL);
    }
    let case = mechanisms::crank_rocker();
    let mut view = case.view.clone();
    view.title = EVIL.into();
    let picture = svg::document(
        &Stage::new(&view, &case.frames, DrawOptions::default()).scene(0),
        Theme::Light,
    );
    assert!(!picture.contains("<script") && !picture.contains("<img"));
}

#[test]
fn long_motions_are_thinned_and_the_ends_kept() {
    let mut case = mechanisms::slider_crank();
    let n = 25_001;
    case.frames = (0..n).map(|k| case.frames[k % 121].clone()).collect();
    case.drive = (0..n).map(|k| k as f64 * 1e-3).collect();
    let html = reports::report(&[case]).to_html();
    let start = html.find("\"row\":[").unwrap() + 7;
    let rows: Vec<&str> = html[start..start + html[start..].find(']').unwrap()]
        .split(',')
        .collect();
    assert!(
        rows.len() <= MOST_ROWS + 1 && rows.first() == Some(&"0") && rows.last() == Some(&"25000")
    );
    assert!(html.len() < 1_500_000, "{}", html.len());
}

#[test]
fn a_peak_between_the_rows_of_the_page_is_drawn() {
    let mut case = mechanisms::slider_crank();
    let n = 25_001;
    case.frames = (0..n).map(|k| case.frames[k % 121].clone()).collect();
    case.drive = (0..n).map(|k| k as f64 * 1e-3).collect();
    let mut report = reports::report(&[case]);
    report.motions[0].plots[0].curves[0].y[12_345] = 7777.0;
    let html = report.to_html();
    let start = html.find("id=\"data\">").unwrap() + 10;
    let json = &html[start..start + html[start..].find("</script>").unwrap()];
    let data: serde_json::Value = serde_json::from_str(json).unwrap();
    let curve = &data[0]["plots"][0]["curves"][0];
    let row = data[0]["row"].as_array().unwrap();
    assert!(!row.contains(&12_345.into()), "the page has not that row");
    assert!(curve["fine"][1].as_array().unwrap().contains(&7777.into()));
}

/// Any number, with the awkward ones often.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -1.0..1.0_f64,
        1 => prop::sample::select(vec![f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0, 1e308, -1e308, 5e-324, 1e6, 1e-6]),
    ]
}

fn guide() -> impl Strategy<Value = Guide> {
    (0..6_usize, 0..6_usize, 0..6_usize).prop_map(|(link, from, to)| Guide { link, from, to })
}

fn wheel() -> impl Strategy<Value = Wheel> {
    (
        0..6_usize,
        0..6_usize,
        number(),
        prop::sample::select(vec![0, 1, 4, 5, 20, 399, u32::MAX]),
    )
        .prop_map(|(link, center, radius, teeth)| Wheel {
            link,
            center,
            radius,
            teeth,
        })
}

fn joint() -> impl Strategy<Value = JointView> {
    let i = 0..6_usize;
    prop_oneof![
        (i.clone(), i.clone(), guide()).prop_map(|(block, at, guide)| JointView::Slider {
            block,
            at,
            guide
        }),
        (i.clone(), guide()).prop_map(|(pin, guide)| JointView::Slot { pin, guide }),
        (i.clone(), i.clone(), i.clone())
            .prop_map(|(at, a, b)| JointView::Weld { at, links: [a, b] }),
        (wheel(), wheel(), any::<bool>()).prop_map(|(a, b, internal)| JointView::Gears {
            a,
            b,
            internal
        }),
        (wheel(), wheel(), any::<bool>(), any::<bool>()).prop_map(|(a, b, crossed, chain)| {
            JointView::Belt {
                a,
                b,
                crossed,
                chain,
            }
        }),
        (i.clone(), guide(), number(), number(), any::<bool>()).prop_map(
            |(pin, guide, radius, side, closed)| JointView::ArcSlot {
                pin,
                arc: ArcGuide {
                    link: guide.link,
                    from: guide.from,
                    to: guide.to,
                    radius,
                    side,
                    closed,
                },
            }
        ),
        (
            i.clone(),
            i.clone(),
            proptest::collection::vec(i.clone(), 0..4),
            proptest::collection::vec((number(), number(), number()), 0..6),
            any::<bool>()
        )
            .prop_map(|(pin, link, through, along, closed)| JointView::CurveSlot {
                pin,
                curve: CurveGuide {
                    link,
                    through,
                    along: along.into_iter().map(|(x, y, a)| ([x, y], a)).collect(),
                    closed,
                },
            }),
        (i.clone(), wheel(), number()).prop_map(|(link, pinion, side)| JointView::Rack {
            link,
            pinion,
            side
        }),
        (i.clone(), i.clone()).prop_map(|(a, b)| JointView::Cylinder { a, b }),
        (i.clone(), i.clone()).prop_map(|(a, b)| JointView::Spring { a, b }),
        (i.clone(), i).prop_map(|(a, b)| JointView::Damper { a, b }),
    ]
}

fn drive() -> impl Strategy<Value = DriveView> {
    let i = 0..6_usize;
    let kind = prop_oneof![
        (i.clone(), i.clone()).prop_map(|(link, about)| DriveKind::Turn { link, about }),
        (i.clone(), guide()).prop_map(|(at, guide)| DriveKind::Slide { at, guide }),
        (i.clone(), i).prop_map(|(a, b)| DriveKind::Extend { a, b }),
    ];
    (kind, any::<bool>()).prop_map(|(kind, forward)| DriveView {
        name: "m".into(),
        kind,
        forward,
    })
}

fn load() -> impl Strategy<Value = LoadView> {
    let role = prop::sample::select(LoadRole::ALL.to_vec());
    let label = prop::sample::select(vec![String::new(), "a".into(), EVIL.into()]);
    let plane = || [number(), number()];
    (plane(), plane(), number(), role, label).prop_map(|(at, vector, moment, role, label)| {
        LoadView {
            at,
            vector,
            moment,
            role,
            label,
        }
    })
}

prop_compose! {
    fn mechanism()(
        links in prop::collection::vec(prop::collection::vec(0..6_usize, 0..5), 0..5),
        joints in prop::collection::vec(joint(), 0..4),
        drives in prop::collection::vec(drive(), 0..3),
        points in 0..6_usize,
        frames in prop::collection::vec(
            (prop::collection::vec([number(), number()], 0..7), prop::collection::vec([number(), number(), number()], 0..6),
             prop::collection::vec(load(), 0..4)), 0..5),
        size in prop::sample::select(vec![1e-6, 1.0, 1e6]),
        factor in number(),
    ) -> (MechanismView, Vec<Frame>) {
        let view = MechanismView {
            title: "any".into(),
            length_unit: LengthUnit::new("u", factor),
            load_units: LoadUnits::default(),
            points: (0..points).map(|k| format!("P{k}")).collect(),
            links: links.into_iter().map(|points| LinkView { name: "l".into(), points }).collect(),
            joints,
            traces: vec![TraceView { label: "t".into(), point: 2 }],
            drives,
            dimensions: vec![],
        };
        let frames = frames.into_iter().map(|(points, links, loads)| Frame {
            points: points.into_iter().map(|p| p.map(|v| v * size)).collect(), links, label: "f".into(), loads }).collect();
        (view, frames)
    }
}

fn all_numbers_are_numbers(text: &str) {
    for bad in ["NaN", "inf", "null"] {
        assert!(!text.contains(bad), "{bad} in {text}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn any_mechanism_gives_a_picture((view, frames) in mechanism(), index in 0..6_usize) {
        let options = DrawOptions { ghosts: vec![0, 9], ..DrawOptions::default() };
        let stage = Stage::new(&view, &frames, options);
        all_numbers_are_numbers(&svg::document(&stage.scene(index), Theme::Page));
        let file = dxf::document(&stage, index);
        prop_assert!(::dxf::Drawing::load(&mut file.as_bytes()).is_ok());
        #[cfg(feature = "raster")]
        raster::Canvas::draw(&stage.scene(index), Theme::Light, 1.0).unwrap();
    }

    #[test]
    fn any_report_is_a_page_with_json((view, frames) in mechanism(), values in prop::collection::vec(number(), 0..6)) {
        let mut report = reports::report(&[mechanisms::crank_rocker()]);
        let motion = &mut report.motions[0];
        (motion.view, motion.frames) = (view, frames);
        let points = motion.view.points.len();
        motion.vectors = [VectorKind::Velocity, VectorKind::Acceleration].map(|kind| PointVectors {
            kind, per: "in time".into(), unit: LoadUnit::new("mm/s", 1e-3),
            rows: values.iter().map(|v| vec![[*v, -v]; points]).collect(),
        }).to_vec();
        for k in 0..2 { motion.columns[k].values.clone_from(&values); }
        let html = report.to_html();
        let start = html.find("id=\"data\">").unwrap() + 10;
        let json = &html[start..start + html[start..].find("</script>").unwrap()];
        prop_assert!(serde_json::from_str::<serde_json::Value>(json).is_ok(), "{}", json);
    }

    #[test]
    fn any_plot_is_drawn(
        x in prop::collection::vec(number(), 0..20), y in prop::collection::vec(number(), 0..20),
        logs in any::<[bool; 2]>(), equal_aspect in any::<bool>(), hodograph in any::<bool>(), limit in number(), limits in prop::option::of([number(), number()]),
    ) {
        let axis = |log| Axis { log, limits, ..Axis::new("a", "deg") };
        let curve = Curve { label: "c".into(), x, y, dashed: true, ..Curve::default() };
        let along = Limit::along("l", curve.y.clone(), curve.x.clone());
        let hodograph = hodograph.then(|| Hodograph { drive: curve.y.clone(), unit: "deg".into() });
        let plot = PlotSpec {
            limits: vec![Limit::above("a", limit), Limit::below("b", -limit), along], hodograph,
            x: axis(logs[0]), y: axis(logs[1]), curves: vec![curve.clone(), curve], equal_aspect, ..PlotSpec::default()
        };
        all_numbers_are_numbers(&svg::document(&plot.draw(100.0, 60.0).scene, Theme::Dark));
    }
}

#[test]
fn a_hundred_thousand_links_are_drawn() {
    let n = 100_000;
    let view = MechanismView {
        title: "chain".into(),
        length_unit: LengthUnit::new("m", 1.0),
        load_units: LoadUnits::default(),
        points: (0..=n).map(|k| format!("P{k}")).collect(),
        links: (0..n)
            .map(|k| LinkView {
                name: format!("l{k}"),
                points: vec![k, k + 1],
            })
            .collect(),
        joints: (0..n)
            .map(|k| JointView::Spring { a: k, b: k + 1 })
            .collect(),
        traces: vec![],
        drives: vec![],
        dimensions: vec![],
    };
    let points = (0..=n).map(|k| [k as f64, (k % 7) as f64]).collect();
    let frames = [Frame {
        points,
        links: vec![[0.0; 3]; n],
        ..Frame::default()
    }];
    let stage = Stage::new(&view, &frames, DrawOptions::default());
    assert!(svg::document(&stage.scene(0), Theme::Light).len() > n);
}

/// A crank that turns a thousand times: what is drawn of its path does not grow with the rows.
#[test]
fn a_path_of_very_many_rows_is_drawn_in_bounded_size() {
    let link = |name: &str, points: &[usize]| LinkView {
        name: name.into(),
        points: points.to_vec(),
    };
    let view = MechanismView {
        title: "crank".into(),
        length_unit: LengthUnit::new("m", 1.0),
        load_units: LoadUnits::default(),
        points: vec!["A".into(), "B".into()],
        links: vec![link("frame", &[0]), link("crank", &[0, 1])],
        joints: vec![],
        traces: vec![TraceView {
            label: "path of B".into(),
            point: 1,
        }],
        drives: vec![],
        dimensions: vec![],
    };
    let frame = |row: usize| {
        let angle = row as f64 / 100.0;
        let (s, c) = kempe_number::math::sin_cos(angle);
        Frame {
            points: vec![[0.0, 0.0], [c, s]],
            links: vec![[0.0; 3], [0.0, 0.0, angle]],
            ..Frame::default()
        }
    };
    let size = |rows: usize| {
        let frames: Vec<Frame> = (0..rows).map(frame).collect();
        let stage = Stage::new(&view, &frames, DrawOptions::default());
        [
            svg::document(&stage.scene(rows - 1), Theme::Light).len(),
            dxf::document(&stage, rows - 1).len(),
        ]
    };
    let (some, many) = (size(150_000), size(600_000));
    assert!(some[0] > 1_000_000, "the path is drawn: {some:?}");
    for (some, many) in some.iter().zip(many) {
        assert!(many < some + some / 10, "{some} {many}");
    }
}
