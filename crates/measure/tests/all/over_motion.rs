//! Numbers over a motion, and places where a measure has a kink, a jump or no value, against closed forms.
#![allow(clippy::unwrap_used, clippy::disallowed_methods)]

use std::f64::consts::{PI, TAU};

use crate::support::{Case, Rng};
use kempe_measure::{Held, RowNote, Sample, Sampler, sensitivities};
use kempe_model::{Measure, ParameterId};

/// Rows of a file's measures (in SI) at some parts of its duration.
fn rows(text: &str, parts: &[f64]) -> Vec<Sample> {
    let case = Case::read(text, "over.toml");
    let motion = case.must_move();
    let measures: Vec<&Measure> = case.model.measures.iter().map(|m| &m.measure).collect();
    let mut sampler = Sampler::new(&motion, &measures).unwrap();
    let duration = sampler.duration();
    parts
        .iter()
        .map(|p| sampler.at_time(duration * p))
        .collect()
}

fn near(found: f64, wanted: f64, part: f64, what: &str) {
    let size = wanted.abs().max(1e-3);
    assert!(
        (found - wanted).abs() <= part * size,
        "{what}: {found} is not {wanted}"
    );
}

/// An in-line slider-crank 20, 50 (mm); `mirror` is -1 for its mirror image.
fn slider_crank(drive: &str, mirror: f64, measures: &str) -> String {
    format!(
        "units = {{ length = \"mm\", angle = \"deg\" }}
[links]
frame = {{ A = [0, 0], F = [{}, 0] }}
crank = {{ A-B = 20 }}
rod = {{ B-C = 50 }}
block = {{ C = [0, 0] }}
[joints]
way = {{ slider = \"block\", at = \"C\", on = \"A -> F\" }}
[drives]
motor = {{ turns = \"crank\", {drive} }}
[assembly]
C = {{ near = [{}, 0] }}
[measures]
{measures}
",
        100.0 * mirror,
        70.0 * mirror
    )
}

/// Travel of its slider, m.
fn travel(angle: f64) -> f64 {
    0.02 * angle.cos() + (0.0025 - 0.0004 * angle.sin().powi(2)).sqrt()
}

/// Its slider turns back at every half turn.
fn way(from: f64, to: f64) -> f64 {
    let (low, high) = (from.min(to), from.max(to));
    let mut stops = vec![low];
    stops.extend(
        (-20..20)
            .map(|k| f64::from(k) * PI)
            .filter(|s| low < *s && *s < high),
    );
    stops.push(high);
    stops
        .windows(2)
        .map(|w| (travel(w[1]) - travel(w[0])).abs())
        .sum()
}

#[test]
fn a_path_is_as_long_as_its_strokes() {
    let mut rng = Rng(3);
    let mut ends = vec![
        (0.0, 360.0),
        (0.0, 270.0),
        (0.0, 181.0),
        (0.0, 1080.0),
        (0.0, 180.0),
    ];
    ends.extend((0..20).map(|_| (rng.range(-400.0, 400.0), rng.range(-400.0, 400.0))));
    for (from, to) in ends {
        let truth = way(from.to_radians(), to.to_radians());
        for (from, to, mirror) in [
            (from, to, 1.0),
            (to, from, 1.0),
            (180.0 - from, 180.0 - to, -1.0),
        ] {
            let drive = format!("from = {from:e}, to = {to:e}, speed = \"60 rpm\"");
            let text = slider_crank(
                &drive,
                mirror,
                "way1 = \"path_length(C)\"\nspeed1 = \"mean(speed(C))\"",
            );
            let last = &rows(&text, &[1.0])[0];
            near(last.values[0], truth, 1e-13, &drive);
            near(last.values[1] * last.time, truth, 1e-13, &drive);
        }
    }
}

/// A drive that goes there and back: the way is that of all strokes.
#[test]
fn a_path_counts_the_way_back() {
    let drive = "from = 10, law = [{ to = 200, in = 1 }, { dwell = 0.5 }, { fall = 170, in = \"1 ms\" }, { to = 50, speed = \"60 rpm\" }]";
    let text = slider_crank(drive, 1.0, "way1 = \"path_length(C)\"");
    let stops = [10.0_f64, 200.0, 30.0, 50.0].map(f64::to_radians);
    let truth: f64 = stops.windows(2).map(|w| way(w[0], w[1])).sum();
    near(rows(&text, &[1.0])[0].values[0], truth, 1e-13, drive);
}

#[test]
fn a_mean_over_a_kink_is_as_good_as_any() {
    let text = slider_crank(
        "from = 0, to = 360, speed = \"60 rpm\"",
        1.0,
        "a = \"mean(abs(x(C) - 45 mm))\"\nb = \"mean(max(x(C), 45 mm))\"\nc = \"mean(abs(rate(x(C))))\"\nd = \"mean(abs(y(B)))\"",
    );
    let values = &rows(&text, &[0.0])[0].values;
    // Mean of |x - k| by the angles at which x = k, and Simpson's rule between these.
    let cross = {
        // x = k: k^2 - 2 k a cos + a^2 = b^2.
        let (k, a, b) = (0.045, 0.02, 0.05);
        f64::acos((k * k + a * a - b * b) / (2.0 * k * a))
    };
    let simpson = |from: f64, to: f64| {
        let n = 20_000;
        let h = (to - from) / f64::from(n);
        let f = |i: i32| travel(from + h * f64::from(i)) - 0.045;
        let inner: f64 = (1..n)
            .map(|i| f(i) * if i % 2 == 1 { 4.0 } else { 2.0 })
            .sum();
        (f(0) + f(n) + inner) * h / 3.0
    };
    let (over, under) = (2.0 * simpson(0.0, cross), 2.0 * simpson(cross, PI));
    near(values[0], (over - under) / TAU, 1e-12, "abs");
    near(values[1], over / TAU + 0.045, 1e-12, "max");
    near(values[2], 0.08, 1e-12, "rate");
    near(values[3], 0.02 * 2.0 / PI, 1e-12, "sine");
}

fn crank(drive: &str, measures: &str) -> String {
    format!(
        "units = {{ length = \"mm\", angle = \"deg\" }}
[links]
frame = {{ A = [0, 0] }}
crank = {{ A-B = 20 }}
[drives]
motor = {{ turns = \"crank\", {drive} }}
[measures]
{measures}
"
    )
}

/// At constant speed the speed is that at both ends too, however the ends are rounded.
#[test]
fn a_motion_does_not_stop_before_its_end() {
    let mut rng = Rng(17);
    for _ in 0..300 {
        let from = 5.0 * rng.range(-20.0, 20.0).round();
        let to =
            from + 5.0 * rng.range(1.0, 40.0).round() * if rng.chance(0.5) { 1.0 } else { -1.0 };
        let rpm = rng.range(1.0, 300.0).round();
        let drive = format!("from = {from}, to = {to}, speed = \"{rpm} rpm\"");
        let text = crank(
            &drive,
            "low = \"min(abs(angular_speed(crank)))\"\nnow = \"abs(angular_speed(crank))\"\nat = \"angle(crank)\"",
        );
        let last = &rows(&text, &[1.0])[0];
        near(last.values[0], rpm * TAU / 60.0, 1e-14, &drive);
        near(last.values[1], rpm * TAU / 60.0, 1e-14, &drive);
        near(last.values[2], to.to_radians(), 1e-15, &drive);
    }
}

/// Drives that end together by the file, though not to the last bit.
#[test]
fn rates_at_the_end_are_those_of_the_motion() {
    let mut rng = Rng(23);
    for _ in 0..50 {
        let (from, v) = (rng.range(0.1, 2.0), rng.range(0.01, 0.5));
        let to = from + 2.0 * v;
        let text = format!(
            "units = {{ length = \"m\", angle = \"deg\" }}
[links]
frame = {{ A = [0, 0], G = [0, 1] }}
arm = {{ A-P = 0.4 }}
slide = {{ S = [0, 0] }}
[joints]
way = {{ slider = \"slide\", at = \"S\", on = \"A -> G\" }}
[drives]
turn = {{ turns = \"arm\", from = 0, to = 70, speed = \"35 deg/s\" }}
push = {{ slides = \"slide\", from = {from:e}, to = {to:e}, speed = {v:e} }}
[measures]
v = \"rate(y(S))\"
w = \"angular_speed(arm)\"
y = \"y(S)\"
low = \"min(v)\"
"
        );
        let last = &rows(&text, &[1.0])[0];
        near(last.values[0], v, 1e-13, &text);
        near(last.values[1], 35.0_f64.to_radians(), 1e-13, &text);
        near(last.values[2], to, 1e-15, &text);
        near(last.values[3], v, 1e-13, &text);
    }
}

/// The peaks of a cycloidal rise by its formulas, however short it is beside what comes before and after.
#[test]
fn extremes_of_short_pieces_are_found() {
    let mut rng = Rng(29);
    for _ in 0..40 {
        let (short, rise) = (rng.range(1e-4, 0.05), rng.range(5.0, 400.0));
        let (before, after) = (rng.range(0.0, 3.0), rng.range(0.0, 9.0));
        let drive = format!(
            "from = 0, law = [{{ dwell = {before:e} }}, {{ rise = {rise:e}, in = {short:e} }}, {{ dwell = {after:e} }}]"
        );
        let text = crank(
            &drive,
            "a = \"max(angular_speed(crank))\"\nb = \"max(angular_acceleration(crank))\"\nc = \"min(angular_acceleration(crank))\"\nd = \"mean(angular_speed(crank))\"",
        );
        let values = &rows(&text, &[0.0])[0].values;
        let travel = rise.to_radians();
        near(values[0], 2.0 * travel / short, 1e-12, &drive);
        near(values[1], TAU * travel / (short * short), 1e-12, &drive);
        near(values[2], -TAU * travel / (short * short), 1e-12, &drive);
        near(values[3], travel / (before + short + after), 1e-11, &drive);
    }
}

/// Where a law jumps both sides count: constant acceleration, then rest.
#[test]
fn both_sides_of_a_jump_are_searched() {
    let text = crank(
        "from = 0, law = [{ to = 90, acceleration = \"2 rad/s^2\" }, { dwell = 1 }, { to = 0, acceleration = \"3 rad/s^2\" }]",
        "a = \"max(angular_speed(crank))\"\nb = \"min(angular_speed(crank))\"\nc = \"max(angular_acceleration(crank))\"\nd = \"min(angular_acceleration(crank))\"",
    );
    let values = &rows(&text, &[0.0])[0].values;
    let quarter = PI / 2.0;
    near(values[0], (2.0 * 2.0 * quarter).sqrt(), 1e-12, "speed");
    near(
        values[1],
        -(2.0 * 3.0 * quarter).sqrt(),
        1e-12,
        "speed back",
    );
    near(values[2], 2.0, 1e-12, "acceleration");
    near(values[3], -3.0, 1e-12, "acceleration back");
}

/// A circle run clockwise turns right, from the first row to the last.
#[test]
fn curvature_has_its_sign_at_rest_too() {
    for (law, sign) in [
        ("from = 60, to = 0, law = \"harmonic\", in = 1", -1.0),
        ("from = 0, to = 60, law = \"cycloidal\", in = 1", 1.0),
        (
            "from = 0, law = [{ dwell = 1 }, { fall = 40, in = 1 }, { dwell = 1 }]",
            -1.0,
        ),
    ] {
        let text = crank(law, "k = \"curvature(B)\"");
        for row in rows(&text, &[0.0, 0.2, 0.5, 0.9, 1.0]) {
            near(row.values[0], sign / 0.02, 1e-12, law);
        }
    }
}

#[test]
fn a_point_that_turns_back_has_no_curvature() {
    let text = slider_crank(
        "from = 360, to = 0, speed = \"60 rpm\"",
        1.0,
        "k = \"curvature(C)\"\ncx = \"curvature_center_x(C)\"\ncircle = \"curvature(B)\"\nix = \"instant_center_x(block)\"\niy = \"instant_center_y(block)\"",
    );
    let motion = Case::read(&text, "over.toml").must_move();
    for row in rows(&text, &[0.0, 0.5, 1.0]) {
        assert!(row.values[0].is_nan() && row.values[1].is_nan(), "{row:?}");
        let note = row.note.unwrap();
        assert!(matches!(&note, RowNote::Still(points) if points.len() == 1));
        assert_eq!(
            note.text(motion.mechanism()),
            "C stands still: no curvature of path here"
        );
        near(row.values[2], -50.0, 1e-12, "circle");
        assert_eq!(row.values[3..], [f64::INFINITY; 2]);
    }
    for row in rows(&text, &[0.1, 0.25, 0.7]) {
        assert!(row.values[0].abs() < 1e-9 && row.note.is_none(), "{row:?}");
        assert_eq!(row.values[1], f64::INFINITY);
        assert_eq!(row.values[3..], [f64::INFINITY; 2]);
    }
}

/// A rocker's end goes on its circle to and fro: what is told of its curvature right beside where it turns back is no rounding.
#[test]
fn beside_where_a_point_turns_back_curvature_is_right_or_none() {
    let text = |from: f64| {
        format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\n[links]\nframe = {{ A = [0, 0], D = [60, 0] }}\n\
             crank = {{ A-B = 20 }}\ncoupler = {{ B-C = 50 }}\nrocker = {{ D-C = 40 }}\n[drives]\n\
             motor = {{ turns = \"crank\", from = {from}, to = 360, speed = \"60 rpm\" }}\n[assembly]\nC = \"left of B -> D\"\n\
             [measures]\nk = \"curvature(C)\"\nx = \"curvature_center_x(C)\"\n"
        )
    };
    // Crank and coupler in line, folded upon each other: the triangle of 30, 60 and 40.
    let dead = 180.0 + f64::acos((900.0 + 3600.0 - 1600.0) / 3600.0).to_degrees();
    let (mut told, mut none) = (0, 0);
    for exponent in 0..40 {
        let off = 10.0_f64.powf(-0.2 * f64::from(exponent));
        for side in [-1.0, 1.0] {
            let row = &rows(&text(dead + side * off), &[0.0])[0];
            if row.values[0].is_nan() {
                none += 1;
                assert!(off < 0.1 && row.values[1].is_nan(), "{off}: {row:?}");
            } else {
                told += 1;
                near(row.values[0].abs(), 25.0, 1e-6, "curvature");
                near(row.values[1], 0.06, 1e-6, "centre");
            }
        }
    }
    assert!(told > 10 && none > 10, "{told} {none}");
}

/// Towards a limit of its drive a point is fast, and its path bends as it does everywhere.
#[test]
fn a_path_has_its_curvature_close_to_a_limit() {
    for (to, part) in [("139.999", 1e-9), ("139.9999", 1e-8), ("139.99999", 1e-6)] {
        let text = format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}
[links]
frame = {{ A = [0, 0], F = [200, 0] }}
crank = {{ A-B = 40 }}
rod = {{ B-C = 100 }}
block = {{ C = [0, 0] }}
[joints]
way = {{ slider = \"block\", at = \"C\", on = \"A -> F\" }}
[drives]
push = {{ slides = \"block\", from = 139.9, to = {to}, speed = 0.01 }}
[assembly]
B = \"left of A -> C\"
[measures]
k = \"curvature(B)\"
still = \"curvature(F)\"
rate = \"rate(curvature(F))\"
"
        );
        for row in rows(&text, &[0.0, 0.5, 0.99, 1.0]) {
            near(row.values[0], -25.0, part, to);
            // Of what has no value the rate has none either.
            assert!(row.values[1].is_nan() && row.values[2].is_nan(), "{row:?}");
        }
    }
}

/// A coupler that goes round in a circle without turning has its instant centre at infinity everywhere.
#[test]
fn the_instant_centre_of_a_translating_link_is_infinite() {
    let text = "units = { length = \"mm\", angle = \"deg\" }
[links]
frame = { A = [0, 0], D = [60, 0] }
crank = { A-B = 20 }
coupler = { B-C = 60 }
rocker = { D-C = 20 }
[drives]
motor = { turns = \"crank\", from = 10, to = 170, speed = \"60 rpm\" }
[assembly]
C = \"right of D -> B\"
[measures]
x = \"instant_center_x(coupler)\"
y = \"instant_center_y(coupler)\"
";
    let parts: Vec<f64> = (0..=100).map(|k| f64::from(k) / 100.0).collect();
    for row in rows(text, &parts) {
        assert_eq!(row.values, [f64::INFINITY; 2], "{}", row.time);
    }
}

#[test]
fn a_time_ratio_asks_for_a_cycle() {
    let ratio = |drive: &str| {
        rows(
            &slider_crank(drive, 1.0, "r = \"time_ratio(x(C))\""),
            &[0.0],
        )[0]
        .values[0]
    };
    assert!(ratio("from = 0, to = 270, speed = \"60 rpm\"").is_nan());
    near(
        ratio("from = 0, to = 720, speed = \"60 rpm\""),
        1.0,
        1e-9,
        "two turns",
    );
    let back = "from = 10, law = [{ to = 170, in = 2 }, { to = 10, in = 1 }]";
    near(ratio(back), 2.0, 1e-9, back);
}

/// Behind gears a turn of the drive is a part of a cycle, or several: an offset slider-crank whose crank is a wheel goes to and fro once a turn of that. By its
/// dead centres.
#[test]
fn a_cycle_is_that_of_what_is_measured() {
    let ratio = |teeth: [u32; 2], to: u32, measure: &str| {
        let text = format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}
[links]
frame = {{ A = [0, 0], B = [60, 0], E = [0, 5], F = [100, 5] }}
sun = {{ A = [0, 0] }}
wheel = {{ B-C = 15 }}
rod = {{ C-P = 70 }}
piston = {{ P = [0, 0] }}
[joints]
mesh = {{ gears = [\"sun\", \"wheel\"], teeth = [{}, {}] }}
bore = {{ slider = \"piston\", at = \"P\", on = \"E -> F\" }}
[drives]
motor = {{ turns = \"sun\", from = 10, to = {}, speed = \"60 rpm\" }}
[assembly]
P = {{ near = [140, 5] }}
[measures]
r = \"time_ratio({measure})\"
",
            teeth[0],
            teeth[1],
            10 + to
        );
        rows(&text, &[0.0])[0].values[0]
    };
    let between = (5.0_f64 / 55.0).asin() - (5.0_f64 / 85.0).asin();
    let wanted = (PI + between) / (PI - between);
    let travel = "travel(bore)";
    let all = [
        ([20, 40], 2),
        ([20, 40], 4),
        ([40, 20], 1),
        ([20, 30], 3),
        ([60, 2], 1),
        ([93, 3], 2),
    ];
    for (teeth, turns) in all {
        let found = ratio(teeth, 360 * turns, travel);
        near(found, wanted, 1e-9, &format!("{teeth:?}, {turns} turns"));
    }
    // Half a cycle, and one and a half; the sun alone comes back.
    for (teeth, turns) in [([20, 40], 1), ([20, 40], 3), ([20, 41], 1)] {
        assert!(ratio(teeth, 360 * turns, travel).is_nan(), "{teeth:?}");
        let sun = ratio(teeth, 360 * turns, "cos(angle(sun))");
        near(sun, 1.0, 1e-9, "the sun");
    }
}

/// Both strokes of a crank-rocker change where crank and coupler are in line: the crank's angles there follow from the law
/// of cosines. Measured from near an extreme, too, where the angle itself is all rounding.
#[test]
fn time_ratios_of_crank_rockers_are_those_of_their_dead_centres() {
    let mut rng = Rng(9);
    for _ in 0..60 {
        let (a, g) = (rng.range(0.1, 0.5), rng.range(0.8, 1.5));
        let (b, c) = (rng.range(0.7, 1.6), rng.range(0.7, 1.6));
        let (longest, all) = (g.max(b).max(c), a + g + b + c);
        if 2.0 * (a + longest) > 0.98 * all {
            continue;
        }
        let corner = |side: f64, opposite: f64| {
            ((g * g + side * side - opposite * opposite) / (2.0 * g * side)).acos()
        };
        let between = (corner(b - a, c) + PI - corner(b + a, c)).abs();
        let stroke = between.min(TAU - between);
        let wanted = (TAU - stroke) / stroke;
        // The rocker's angle with the crank and the coupler stretched: an exterior angle of that triangle.
        let end = PI - ((g * g + c * c - (a + b) * (a + b)) / (2.0 * g * c)).acos();
        let from = rng.range(-3.0, 3.0);
        let text = format!(
            "units = {{ length = \"m\", angle = \"rad\" }}
[links]
frame = {{ A = [0, 0], D = [{g:e}, 0] }}
crank = {{ A-B = {a:e} }}
coupler = {{ B-C = {b:e} }}
rocker = {{ D-C = {c:e} }}
[drives]
motor = {{ turns = \"crank\", from = {from:e}, to = {:e}, speed = \"60 rpm\" }}
[assembly]
C = \"left of B -> D\"
[measures]
swing = \"time_ratio(angle(rocker))\"
beside = \"time_ratio(angle(rocker) - {end:e} rad)\"
",
            from + TAU,
        );
        for ratio in &rows(&text, &[0.0])[0].values {
            near(*ratio, wanted, 1e-12, &text);
        }
    }
}

/// Of a point that cannot move all sensitivities are zero, and a length of path has those of its strokes.
#[test]
fn sensitivities_of_fixed_points_and_of_paths() {
    let text = slider_crank(
        "from = 0, to = 360, speed = \"60 rpm\"",
        1.0,
        "rest = \"speed(A)\"\nlong = \"max(path_length(C))\"\nfixed = \"path_length(F)\"",
    )
    .replace("A-B = 20", "A-B = \"a\"")
    .replace("[drives]", "[parameters]\na = \"20 mm\"\n[drives]");
    let case = Case::read(&text, "over.toml");
    let motion = case.must_move();
    let measures: Vec<&Measure> = case.model.measures.iter().map(|m| &m.measure).collect();
    let found = sensitivities(&motion, Held::Path(1.0), &measures, &[ParameterId(0)]).unwrap();
    assert_eq!((found.values[0], found.derivatives[0][0]), (0.0, 0.0));
    assert_eq!((found.values[2], found.derivatives[2][0]), (0.0, 0.0));
    // Four cranks long, whatever the rod.
    near(found.values[1], 0.08, 1e-12, "length");
    near(found.derivatives[1][0], 4.0, 1e-9, "per crank");
}

#[test]
fn at_a_time_beyond_the_motion_nothing_has_a_value() {
    // Half a turn in 0.5 s.
    let measures = "a = \"at(x(C), time, 0.25 s)\"\nb = \"at(x(C), time, 0.5 s)\"\nc = \"at(x(C), time, 0.5001 s)\"\n\
                    d = \"at(speed(B), time, -3 s)\"\ne = \"at(motor, time, 5 s)\"";
    let text = slider_crank("from = 0, to = 180, speed = \"60 rpm\"", 1.0, measures);
    let values = &rows(&text, &[0.3])[0].values;
    near(values[0], travel(PI / 2.0), 1e-12, "in it");
    near(values[1], travel(PI), 1e-12, "at its end");
    assert!(values[2..].iter().all(|v| v.is_nan()), "{values:?}");
}
