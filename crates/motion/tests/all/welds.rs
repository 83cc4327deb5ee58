//! Angles of welded links: each link counts from its own drive or hint, whatever the order of the file.
#![allow(clippy::unwrap_used)]

use crate::support::{Case, Rng};
use kempe_measure::Sampler;
use kempe_model::Measure;

/// Values of a file's measures (in its angle unit) at the start and at the end of its motion.
fn ends(text: &str) -> [Vec<f64>; 2] {
    let case = Case::read(text, "welds.toml");
    let motion = case.must_move();
    let measures: Vec<&Measure> = case.model.measures.iter().map(|m| &m.measure).collect();
    let mut sampler = Sampler::new(&motion, &measures).unwrap();
    let duration = sampler.duration();
    [0.0, duration].map(|t| {
        let values = sampler.at_time(t).values;
        values.iter().map(|v| v.to_degrees()).collect()
    })
}

fn same(found: &[f64], wanted: &[f64], what: &str) {
    for (f, w) in found.iter().zip(wanted) {
        assert!((f - w).abs() < 1e-9, "{what}: {found:?} {wanted:?}");
    }
}

/// Half a turn is above its hint, not below it.
fn within_half_a_turn(angle: f64) -> f64 {
    angle - 360.0 * ((angle - 180.0 - 1e-7) / 360.0).ceil()
}

/// A crank with a gear welded to it, in both orders of the links, its weld told in every way; the gear of the weld's
/// partner or of the crank itself drives a wheel of 53 teeth.
#[test]
fn a_driven_angle_is_what_its_drive_says_and_welded_links_count_for_themselves() {
    let mut rng = Rng(5);
    for _ in 0..60 {
        let weld = 10.0 * (rng.range(-34.0, 34.0)).round();
        let (from, way) = (rng.range(-700.0, 700.0).round(), rng.range(-400.0, 400.0));
        let links = ["gear1 = { A = [0, 0], G = [5, 0] }", "crank = { A-B = 20 }"];
        let welds = [
            format!("weld = [\"gear1\", \"crank\"], angle = {weld}"),
            format!("weld = [\"crank\", \"gear1\"], angle = {}", -weld),
            format!("weld = [\"gear1\", \"crank\"], angle = {}", weld - 360.0),
        ];
        for geared in ["crank", "gear1"] {
            for (order, weld_line) in [0, 1]
                .into_iter()
                .flat_map(|o| welds.iter().map(move |w| (o, w)))
            {
                let text = format!(
                    "units = {{ length = \"mm\", angle = \"deg\" }}
[links]
frame = {{ A = [0, 0], D = [60, 0] }}
{}
{}
gear2 = {{ D-C = 10 }}
[joints]
fast = {{ {weld_line} }}
mesh = {{ gears = [\"{geared}\", \"gear2\"], teeth = [17, 53], phase = 10 }}
[drives]
motor = {{ turns = \"crank\", from = {from}, to = {}, speed = \"60 rpm\" }}
[measures]
crank = \"angle(crank)\"
gear = \"angle(gear1)\"
wheel = \"angle(gear2)\"
",
                    links[order],
                    links[1 - order],
                    from + way
                );
                let text = text.replace("crank = \"angle", "c = \"angle");
                let gear = within_half_a_turn(from - weld);
                let first = if geared == "crank" { from } else { gear };
                let wheel = -17.0 / 53.0 * (first - 10.0);
                let [start, end] = ends(&text);
                let turn = -17.0 / 53.0 * way;
                same(&start, &[from, gear, wheel], &text);
                same(&end, &[from + way, gear + way, wheel + turn], &text);
            }
        }
    }
}

/// A tool driven against a head that is welded to a driven arm.
#[test]
fn an_angle_driven_against_a_welded_link_is_the_drives() {
    let [start, end] = ends(
        "units = { length = \"m\", angle = \"deg\" }
[links]
frame = { A = [0, 0], D = [3, 0] }
arm   = { A-B = 1 }
head  = { B-C = 1 }
tool  = { C-E = 1, G = [2, 0] }
wheel = { G-H = 0.5 }
[joints]
fast = { weld = [\"arm\", \"head\"], angle = 220 }
mesh = { gears = [\"head\", \"wheel\"], arm = \"tool\", teeth = [17, 53], phase = 10 }
[drives]
turn = { turns = \"arm\", from = -130, to = -100, speed = \"10 deg/s\" }
swing = { turns = \"tool\", relative_to = \"head\", from = -80, to = -140, speed = \"20 deg/s\" }
[assembly]
head = { near = 90 }
tool = { near = 10 }
[measures]
arm1 = \"angle(arm)\"
head1 = \"angle(head)\"
tool1 = \"angle(tool)\"
against = \"angle(tool, head)\"
mesh1 = \"17 * (angle(head, tool) - 10 deg) + 53 * angle(wheel, tool)\"
",
    );
    same(&start, &[-130.0, 90.0, 10.0, -80.0, 0.0], "start");
    same(&end, &[-100.0, 120.0, -20.0, -140.0, 0.0], "end");
}

/// A link welded to the frame, and a driven body of which no link is the driven one's first.
#[test]
fn a_link_welded_to_the_frame_counts_within_half_a_turn() {
    let [start, _] = ends(
        "units = { length = \"m\", angle = \"deg\" }
[links]
frame = { A = [0, 0] }
stand = { A-S = 1 }
crank = { A-B = 1 }
[joints]
fast = { weld = [\"frame\", \"stand\"], angle = 260 }
[drives]
turn = { turns = \"crank\", relative_to = \"stand\", from = 300, to = 330, speed = \"10 deg/s\" }
[measures]
stand1 = \"angle(stand)\"
crank1 = \"angle(crank)\"
",
    );
    same(&start, &[-100.0, 200.0], "start");
}
