//! Dead points of what is let go: the mechanism goes on, as it does where another drive that never has one is let go.
#![allow(clippy::unwrap_used)]

use crate::common;
use std::sync::Arc;

use crate::common::Free;
use kempe_dynamics::ForceSampler;
use kempe_model::{Measure, Model};
use kempe_motion::{Motion, Silent};
use kempe_simulate::{Ending, Happened, Resistance, Simulated, Stop};
use proptest::prelude::*;

/// A crank-rocker in this unit, one of its drives let go; what moves is measured by name.
fn crank_rocker(unit: &str, drive: &str, more: &str) -> String {
    format!(
        r#"units = {{ length = "{unit}" }}
[links]
frame   = {{ A = [0, 0], D = [100, 0] }}
crank   = {{ A-B = 30, mass = "0.5 kg", center = [15, 0], inertia = "200 kg*{unit}^2" }}
coupler = {{ B-C = 90, mass = "0.8 kg", center = [45, 5], inertia = "700 kg*{unit}^2" }}
rocker  = {{ D-C = 70, mass = "0.6 kg", center = [30, 0], inertia = "400 kg*{unit}^2" }}
[drives]
{drive}
[assembly]
B = "left of A -> C"
C = "left of B -> D"
[measures]
crank_angle = "angle(crank)"
rocker_angle = "angle(rocker)"
crank_rate = "rate(angle(crank))"
rocker_rate = "rate(angle(rocker))"
coupler_rate = "rate(angle(coupler))"
crank_acceleration = "rate(angle(crank), 2)"
of_a = "reaction(A)"
of_b = "reaction(B)"
of_c = "reaction(C)"
of_d = "reaction(D)"
x = "x(C)"
y = "y(C)"
kinetic = "kinetic_energy"
potential = "potential_energy"
fastest = "max(speed(C))"
hardest = "max(reaction(B))"
gone = "path_length(C)"
average = "mean(reaction(D))"
{more}
"#
    )
}

/// Measures by their names at times of a motion.
fn values(model: &Model, motion: &Arc<Motion>, names: &[&str], times: &[f64]) -> Vec<Vec<f64>> {
    let named = |name: &str| model.measures.iter().find(|m| m.name == name).unwrap();
    let measures: Vec<&Measure> = names.iter().map(|name| &named(name).measure).collect();
    let mut sampler = ForceSampler::new(motion, &measures).unwrap();
    times.iter().map(|t| sampler.values_at_time(*t)).collect()
}

/// What was found of a mechanism let go from a start.
fn run(text: &str, start: [f64; 2], until: f64) -> (Free, Simulated) {
    let mut free = Free::new(text, until);
    free.question.start[0] = start;
    let found = free.run();
    (free, found)
}

fn motion(found: &Simulated) -> Arc<Motion> {
    found.motion(&mut Silent).unwrap()
}

/// Largest difference of two tables, column by column in parts of what is largest there.
fn difference(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    let columns = 0..a[0].len();
    let worst = columns.map(|c| {
        let size = a.iter().map(|row| row[c].abs()).fold(0.0, f64::max);
        let off = a.iter().zip(b).map(|(a, b)| (a[c] - b[c]).abs());
        off.fold(0.0, |m: f64, x| if x <= m { m } else { x }) / size
    });
    worst.fold(0.0, |m: f64, x| if x <= m { m } else { x })
}

const ALL: [&str; 12] = [
    "x",
    "y",
    "crank_angle",
    "rocker_angle",
    "crank_rate",
    "rocker_rate",
    "coupler_rate",
    "crank_acceleration",
    "of_a",
    "of_b",
    "of_c",
    "of_d",
];

/// The rocker let go and the crank let go, of one mechanism from one start, with the same measures and `change` made to the question:
/// what was found of both, and how far their motions are apart.
fn both(
    more: &str,
    start: [f64; 2],
    until: f64,
    change: impl Fn(&mut Free),
) -> ([Simulated; 2], f64) {
    let swing = format!(r#"swing = {{ turns = "rocker", at = "{} rad" }}"#, start[0]);
    let mut rocker = Free::new(&crank_rocker("mm", &swing, more), until);
    rocker.question.start[0] = start;
    change(&mut rocker);
    let by_rocker = rocker.run();
    assert!(by_rocker.told_by().len() > 1, "no dead point");
    let of_rocker = motion(&by_rocker);
    let names = ["crank_angle", "crank_rate"];
    let start = &values(&rocker.model, &of_rocker, &names, &[0.0])[0];
    let at = format!(r#"motor = {{ turns = "crank", at = "{} rad" }}"#, start[0]);
    let more = more.replace("swing =", "motor =");
    let mut crank = Free::new(&crank_rocker("mm", &at, &more), until);
    crank.question.start[0] = [start[0], start[1]];
    change(&mut crank);
    let by_crank = crank.run();
    let of_crank = motion(&by_crank);
    let end = by_crank.end.min(by_rocker.end);
    // At times at which nothing happens.
    let times: Vec<f64> = (0..200)
        .map(|k| end * (0.5 + f64::from(k)) / 200.0)
        .collect();
    let a = values(&rocker.model, &of_rocker, &ALL, &times);
    let b = values(&crank.model, &of_crank, &ALL, &times);
    let off = difference(&b, &a);
    ([by_rocker, by_crank], off)
}

/// What happened to both, as it should, at the same times.
fn same_happenings([a, b]: &[Simulated; 2]) -> f64 {
    assert_eq!(
        a.happenings.len(),
        b.happenings.len(),
        "{:?}\n{:?}",
        a.happenings,
        b.happenings
    );
    assert!(!a.happenings.is_empty());
    let pairs = a.happenings.iter().zip(&b.happenings);
    pairs.fold(0.0, |worst: f64, (a, b)| {
        let kind = |what: &Happened| std::mem::discriminant(what);
        assert_eq!(kind(&a.what), kind(&b.what));
        worst.max((a.time - b.time).abs())
    })
}

#[test]
fn the_rocker_of_a_benchmark_let_go_keeps_to_its_reference() {
    // The benchmark lets the crank go, from 90 degrees at 30 rad/s; its solution was found by another integrator.
    let file = include_str!("../../../../examples/benchmarks/crank-rocker.toml");
    let measures = "[measures]\ncrank_angle = \"angle(crank)\"\ncrank_rate = \"rate(angle(crank))\"\nrocker_angle = \"angle(rocker)\"\nrocker_rate = \"rate(angle(rocker))\"\n";
    let names = ["crank_angle", "crank_rate", "rocker_angle", "rocker_rate"];
    let start = [std::f64::consts::FRAC_PI_2, 30.0];
    let (crank, by_crank) = run(&format!("{file}\n{measures}"), start, 0.01);
    let start = &values(&crank.model, &motion(&by_crank), &names, &[0.0])[0];
    let swing = format!(r#"motor = {{ turns = "rocker", at = "{} rad" }}"#, start[2]);
    let file = file
        .replace(r#"motor = { turns = "crank", at = "90 deg" }"#, &swing)
        .replace("[assembly]", "[assembly]\nB = { near = [0, 0.1] }");
    let (rocker, by_rocker) = run(&format!("{file}\n{measures}"), [start[2], start[3]], 1.0);
    assert!(by_rocker.told_by().len() > 1);
    let found = values(&rocker.model, &motion(&by_rocker), &names, &[0.1, 0.5, 1.0]);
    for (row, [angle, rate]) in found.iter().zip([
        [5.552026524037504, 29.04393968614691],
        [20.25304488137455, 31.07100123095598],
        [38.92717954011124, 33.02780516330781],
    ]) {
        assert!((row[0] / angle - 1.0).abs() < 1e-10, "{} {angle}", row[0]);
        assert!((row[1] / rate - 1.0).abs() < 1e-10, "{} {rate}", row[1]);
    }
}

#[test]
fn friction_takes_its_part_across_dead_points() {
    let friction = "[friction]\nB = { coefficient = 0.35, radius = \"8 mm\" }\nD = { coefficient = 0.35, radius = \"8 mm\" }";
    let (found, off) = both(friction, [2.1, 6.0], 2.0, |_| ());
    assert!(off < 1e-7, "{off:e}");
    let when = same_happenings(&found);
    assert!(when < 1e-8, "{when:e}");
    assert!(matches!(
        found[0].happenings.last().unwrap().what,
        Happened::Sticks
    ));
}

#[test]
fn stops_hold_across_dead_points() {
    // On what the drive itself tells, seen from both; and on a distance that the crank comes to beyond a dead point.
    for gap in [
        r#"gap = "angle(rocker) - 93 deg""#,
        r#"gap = "distance(B, D) - 76 mm""#,
    ] {
        let (found, off) = both(gap, [2.1, 3.0], 1.5, |free| free.stop("gap", 0.8));
        assert!(off < 1e-8, "{gap}: {off:e}");
        let when = same_happenings(&found);
        assert!(when < 1e-9, "{gap}: {when:e}");
    }
    // The drive's own coordinate, which a link tells by then.
    let gap = |name: &str| format!(r#"gap = "{name} - 93 deg""#);
    let swing = crank_rocker(
        "mm",
        r#"swing = { turns = "rocker", at = "2.1 rad" }"#,
        &gap("swing"),
    );
    let mut free = Free::new(&swing, 1.5);
    free.question.start[0] = [2.1, 3.0];
    free.stop("gap", 0.8);
    let found = free.run();
    let (other, _) = both(&gap("angle(rocker)"), [2.1, 3.0], 1.5, |free| {
        free.stop("gap", 0.8)
    });
    assert_eq!(found.happenings.len(), other[0].happenings.len());
    for (a, b) in found.happenings.iter().zip(&other[0].happenings) {
        assert!((a.time - b.time).abs() < 1e-11);
    }
}

#[test]
fn the_push_of_a_stop_shows_in_the_drive_while_that_tells_the_place() {
    // A soft stop throws the rocker back; beyond it comes to a dead point.
    let more = "gap = \"124 deg - swing\"\neffort = \"torque(swing)\"";
    let swing = crank_rocker(
        "mm",
        r#"swing = { turns = "rocker", at = "2.1 rad" }"#,
        more,
    );
    let mut free = Free::new(&swing, 1.0);
    free.question.start[0] = [2.1, 9.0];
    let gap = free.measure("gap");
    free.question.stops.push(Stop {
        gap,
        resistance: Resistance::Soft {
            stiffness: 20.0,
            damping: 0.0,
        },
    });
    let long = free.run();
    assert!(long.told_by().len() > 1);
    let since = long.told_by()[1].0;
    free.question.until = 0.99 * since;
    let short = free.run();
    assert!(short.told_by().is_empty());
    let times: Vec<f64> = (0..=50)
        .map(|k| 0.98 * since * f64::from(k) / 50.0)
        .collect();
    let names = ["effort", "of_a", "of_d"];
    let a = values(&free.model, &motion(&short), &names, &times);
    let b = values(&free.model, &motion(&long), &names, &times);
    assert!(a.iter().any(|row| row[0].abs() > 0.1));
    let off = difference(&a, &b);
    assert!(off < 1e-8, "{off:e}");
}

#[test]
fn it_ends_where_it_is_asked_to_beyond_dead_points() {
    let above = r#"above = "angle(crank) - 385 deg""#;
    let (found, off) = both(above, [2.1, 3.0], 3.0, |free| {
        let above = free.measure("above");
        free.question.end_when.push(above);
    });
    assert!(off < 1e-9, "{off:e}");
    for it in &found {
        assert_eq!(it.ending, Ending::Condition(0));
    }
    let when = same_happenings(&found);
    assert!(when < 1e-11, "{when:e}");
}

#[test]
fn a_motor_turns_its_drive_through_dead_points() {
    // Against a load by the same law: 0.05 N m at rest, none at 40 rad/s.
    let motor = "[motors]\nswing = { curve = [[\"-4000 rad/s\", \"5.05 N m\"], [\"40 rad/s\", \"0 N m\"]] }";
    let load = "[loads]\nturn = { torque = \"0.05 N m * (40 rad/s - angular_speed(rocker)) / (40 rad/s)\", on = \"rocker\" }";
    let [mut a, mut b] = [motor, load].map(|more| {
        let swing = crank_rocker(
            "mm",
            r#"swing = { turns = "rocker", at = "2.1 rad" }"#,
            more,
        );
        let mut free = Free::new(&swing, 1.0);
        free.question.start[0] = [2.1, 3.0];
        free
    });
    let found = [&mut a, &mut b].map(|free| free.run());
    assert!(
        found
            .iter()
            .all(|f| f.told_by().len() > 1 && f.ending == Ending::Until)
    );
    let times: Vec<f64> = (0..200).map(|k| (0.5 + f64::from(k)) / 200.0).collect();
    let motions = [motion(&found[0]), motion(&found[1])];
    let [x, y] = [(&a, &motions[0]), (&b, &motions[1])]
        .map(|(free, motion)| values(&free.model, motion, &ALL, &times));
    let off = difference(&y, &x);
    assert!(off < 1e-9, "{off:e}");
    // Work of all but weights: what the energy gained.
    for (free, found, motion) in [(&a, &found[0], &motions[0]), (&b, &found[1], &motions[1])] {
        let e = values(
            &free.model,
            motion,
            &["kinetic", "potential"],
            &[0.0, 0.25, 0.5, 1.0],
        );
        for (row, t) in e.iter().zip([0.0, 0.25, 0.5, 1.0]) {
            let gained = row[0] + row[1] - e[0][0] - e[0][1];
            assert!((gained - found.work.at(t, &[])).abs() < 1e-11 * e[0][0].max(gained.abs()));
        }
    }
}

#[test]
fn what_asks_for_the_drive_is_answered() {
    // Its coordinate and rate, derivatives to it, and the mass reduced to it, as of the crank let go.
    let by = |drive: &str, per: &str| {
        format!(
            "own = \"{drive}\"\nrate_of = \"rate({drive})\"\nper = \"{per}\"\nmass = \"{}\"\nload = \"{}\"",
            if drive == "swing" {
                "reduced_mass(swing)"
            } else {
                "reduced_mass(motor) / d(angle(rocker), motor)^2"
            },
            if drive == "swing" {
                "reduced_load(swing)"
            } else {
                "reduced_load(motor) / d(angle(rocker), motor)"
            },
        )
    };
    let swing = crank_rocker(
        "mm",
        r#"swing = { turns = "rocker", at = "2.1 rad" }"#,
        &by("swing", "d(angle(crank), swing)"),
    );
    let (rocker, by_rocker) = run(&swing, [2.1, 3.0], 1.0);
    let of_rocker = motion(&by_rocker);
    let names = ["crank_angle", "crank_rate"];
    let start = &values(&rocker.model, &of_rocker, &names, &[0.0])[0];
    let turn = crank_rocker(
        "mm",
        &format!(r#"motor = {{ turns = "crank", at = "{} rad" }}"#, start[0]),
        &by("angle(rocker)", "1 / d(angle(rocker), motor)")
            .replace("d(angle(rocker)^2", "d(angle(rocker)"),
    );
    let (crank, by_crank) = run(&turn, [start[0], start[1]], 1.0);
    let of_crank = motion(&by_crank);
    let times: Vec<f64> = (0..50).map(|k| (0.5 + f64::from(k)) / 50.0).collect();
    let names = [
        "own", "rate_of", "per", "mass", "load", "fastest", "hardest", "gone", "average",
    ];
    let a = values(&rocker.model, &of_rocker, &names, &times);
    let b = values(&crank.model, &of_crank, &names, &times);
    let off = difference(&b, &a);
    assert!(off < 1e-7, "{off:e}");
}

/// A four-bar of these lengths, mm, one of its links let go where it points so, and where its pins are drawn.
fn four_bar([a, b, c]: [f64; 3], link: &str, angle: f64, [at_b, at_c]: [[f64; 2]; 2]) -> String {
    format!(
        r#"units = {{ length = "mm" }}
[links]
frame   = {{ A = [0, 0], D = [100, 0] }}
left    = {{ A-B = {a}, mass = "0.5 kg", center = [{}, 3], inertia = "200 kg*mm^2" }}
middle  = {{ B-C = {b}, mass = "0.8 kg", center = [{}, 5], inertia = "700 kg*mm^2" }}
right   = {{ D-C = {c}, mass = "0.6 kg", center = [{}, 0], inertia = "400 kg*mm^2" }}
[drives]
swing = {{ turns = "{link}", at = "{angle} rad" }}
[assembly]
B = {{ near = [{}, {}] }}
C = {{ near = [{}, {}] }}
[measures]
xb = "x(B)"
yb = "y(B)"
xc = "x(C)"
yc = "y(C)"
left_angle = "angle(left)"
middle_angle = "angle(middle)"
right_angle = "angle(right)"
left_rate = "rate(angle(left))"
middle_rate = "rate(angle(middle))"
right_rate = "rate(angle(right))"
of_a = "reaction(A)"
of_c = "reaction(C)"
kinetic = "kinetic_energy"
potential = "potential_energy"
"#,
        a / 2.0,
        b / 2.0,
        c / 3.0,
        at_b[0],
        at_b[1],
        at_c[0],
        at_c[1]
    )
}

/// The largest part by which the energy of a motion without any work changes, of the most that moves.
fn energy_drift(free: &Free, found: &Simulated, until: f64) -> f64 {
    let times: Vec<f64> = (0..=200).map(|k| until * f64::from(k) / 200.0).collect();
    let e = values(
        &free.model,
        &motion(found),
        &["kinetic", "potential"],
        &times,
    );
    let most = e
        .iter()
        .map(|row| row[0].max((row[1] - e[0][1]).abs()))
        .fold(0.0, f64::max);
    let off = e
        .iter()
        .map(|row| (row[0] + row[1] - e[0][0] - e[0][1]).abs());
    off.fold(0.0, |m: f64, x| if x <= m { m } else { x }) / most
}

/// Pins and angles where a motion ends, and how fast the links turn there.
const ENDS: [&str; 10] = [
    "xb",
    "yb",
    "xc",
    "yc",
    "left_angle",
    "middle_angle",
    "right_angle",
    "left_rate",
    "middle_rate",
    "right_rate",
];

#[test]
fn a_triple_rocker_swings_through_many_dead_points() {
    // No link of it turns round, and each has dead points.
    let until = 2.0;
    let there = four_bar(
        [80.0, 60.0, 70.0],
        "left",
        1.2,
        [[30.0, 75.0], [85.0, 65.0]],
    );
    let (free, found) = run(&there, [1.2, 12.0], until);
    assert_eq!(found.ending, Ending::Until);
    let links = found.told_by();
    assert!(links.len() > 6, "{}", links.len());
    let drift = energy_drift(&free, &found, until);
    assert!(drift < 1e-10, "{drift:e}");
    // Back from where it ends, by the link that turns fastest there.
    let end = &values(&free.model, &motion(&found), &ENDS, &[until])[0];
    let fastest = (7..10).fold(7, |best, k| {
        if end[k].abs() > end[best].abs() {
            k
        } else {
            best
        }
    });
    let link = ["left", "middle", "right"][fastest - 7];
    let back = four_bar(
        [80.0, 60.0, 70.0],
        link,
        end[fastest - 3],
        [[1e3 * end[0], 1e3 * end[1]], [1e3 * end[2], 1e3 * end[3]]],
    );
    let (free_back, found_back) = run(&back, [end[fastest - 3], -end[fastest]], until);
    assert_eq!(found_back.ending, Ending::Until);
    let start = &values(&free.model, &motion(&found), &ENDS, &[0.0])[0];
    let again = &values(&free_back.model, &motion(&found_back), &ENDS, &[until])[0];
    for k in [0, 1, 2, 3] {
        assert!(
            (start[k] - again[k]).abs() < 1e-9,
            "{}: {} {}",
            ENDS[k],
            start[k],
            again[k]
        );
    }
    for k in [7, 8, 9] {
        assert!(
            (start[k] + again[k]).abs() < 1e-6 * start[7].abs(),
            "{}: {} {}",
            ENDS[k],
            start[k],
            again[k]
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Whichever link of a four-bar is let go, it moves alike.
    #[test]
    fn any_four_bar_goes_on(
        lengths in [40.0..120.0_f64, 40.0..120.0_f64, 40.0..120.0_f64],
        place in 0.3..2.8_f64,
        speed in -15.0..15.0_f64,
    ) {
        // Where the left link can stand, the pin C is on one side.
        let (s, c) = kempe_number::math::sin_cos(place);
        let at_b = [lengths[0] * c, lengths[0] * s];
        let span = kempe_number::math::hypot(100.0 - at_b[0], at_b[1]);
        let room = (lengths[1] + lengths[2] - span).min(span - (lengths[1] - lengths[2]).abs());
        // Where change points are near, branches are hard to tell for anybody.
        let mut all = [lengths[0], lengths[1], lengths[2], 100.0];
        all.sort_by(f64::total_cmp);
        let folds = [all[0] + all[3] - all[1] - all[2], all[0] + all[1] + all[2] - all[3], all[0] + all[2] - all[1] - all[3]];
        prop_assume!(room > 8.0 && folds.iter().all(|x| x.abs() > 4.0));
        let along = (lengths[1] * lengths[1] - lengths[2] * lengths[2] + span * span) / (2.0 * span);
        let up = (lengths[1] * lengths[1] - along * along).sqrt();
        let way = [(100.0 - at_b[0]) / span, -at_b[1] / span];
        let at_c = [at_b[0] + along * way[0] - up * way[1], at_b[1] + along * way[1] + up * way[0]];
        let until = 1.0;
        let (free, found) = run(&four_bar(lengths, "left", place, [at_b, at_c]), [place, speed], until);
        prop_assert_eq!(found.ending, Ending::Until);
        let drift = energy_drift(&free, &found, until);
        prop_assert!(drift < 1e-9, "energy {:e}", drift);
        let of_left = motion(&found);
        let start = &values(&free.model, &of_left, &ENDS, &[0.0])[0];
        let (other, found_other) = run(&four_bar(lengths, "right", start[6], [at_b, at_c]), [start[6], start[9]], until);
        prop_assert_eq!(found_other.ending, Ending::Until);
        let times: Vec<f64> = (0..=50).map(|k| until * f64::from(k) / 50.0).collect();
        let names = ["xb", "yb", "xc", "yc", "left_rate", "middle_rate", "right_rate", "of_a", "of_c"];
        let a = values(&free.model, &of_left, &names, &times);
        let b = values(&other.model, &motion(&found_other), &names, &times);
        let off = difference(&a, &b);
        prop_assert!(off < 1e-6, "{:e}", off);
    }
}

/// An engine: gas pushes the piston while it goes down; its crank or its piston is let go.
fn engine(drive: &str) -> String {
    format!(
        r#"units = {{ length = "mm" }}
[links]
frame  = {{ O = [0, 0], X = [200, 0] }}
crank  = {{ O-B = 40, mass = "2 kg", inertia = "9000 kg*mm^2" }}
rod    = {{ B-C = 140, mass = "0.5 kg", center = [45, 0], inertia = "1200 kg*mm^2" }}
piston = {{ C = [0, 0], mass = "0.4 kg", inertia = "100 kg*mm^2" }}
[joints]
bore = {{ slider = "piston", at = "C", on = "O -> X" }}
[drives]
{drive}
[assembly]
B = "left of O -> C"
[loads]
gas = {{ force = ["-1 kN * (1 - atan(rate(x(C)) / (0.1 m/s)) / 90 deg) / 2", "0 N"], at = "C", on = "piston" }}
brake = {{ torque = "-0.2 N m s * angular_speed(crank)", on = "crank" }}
[measures]
stroke = "x(C)"
angle = "angle(crank)"
speed = "rate(x(C))"
rate = "rate(angle(crank))"
acceleration = "rate(x(C), 2)"
of_o = "reaction(O)"
of_c = "reaction(C)"
of_bore = "reaction(bore)"
"#
    )
}

#[test]
fn an_engine_fired_on_its_piston_turns_on() {
    let until = 1.0;
    let (piston, by_piston) = run(
        &engine(r#"travel = { slides = "bore", at = "150 mm" }"#),
        [0.15, -1.0],
        until,
    );
    assert_eq!(by_piston.ending, Ending::Until);
    // Once it has come to its crank it stays there, round and round.
    assert_eq!(by_piston.told_by().len(), 2);
    let of_piston = motion(&by_piston);
    let names = [
        "stroke",
        "angle",
        "speed",
        "rate",
        "acceleration",
        "of_o",
        "of_c",
        "of_bore",
    ];
    let start = &values(&piston.model, &of_piston, &names, &[0.0])[0];
    let turn = engine(&format!(
        r#"motor = {{ turns = "crank", at = "{} rad" }}"#,
        start[1]
    ));
    let (crank, by_crank) = run(&turn, [start[1], start[3]], until);
    let times: Vec<f64> = (0..=200).map(|k| until * f64::from(k) / 200.0).collect();
    let a = values(&piston.model, &of_piston, &names, &times);
    let b = values(&crank.model, &motion(&by_crank), &names, &times);
    assert!((b[200][1] - b[0][1]).abs() > 30.0, "{}", b[200][1]);
    let off = difference(&b, &a);
    assert!(off < 1e-9, "{off:e}");
}

/// A five-bar whose two freedoms are let go by the links named.
fn five_bar(drives: &str) -> String {
    format!(
        r#"units = {{ length = "mm" }}
[links]
frame = {{ A = [0, 0], E = [60, 0] }}
one   = {{ A-B = 80, mass = "0.4 kg", center = [40, 0], inertia = "250 kg*mm^2" }}
two   = {{ B-C = 70, mass = "0.3 kg", center = [35, 2], inertia = "150 kg*mm^2" }}
three = {{ E-D = 75, mass = "0.5 kg", center = [35, 0], inertia = "270 kg*mm^2" }}
four  = {{ D-C = 65, mass = "0.2 kg", center = [30, 0], inertia = "120 kg*mm^2" }}
[drives]
{drives}
[assembly]
B = {{ near = [-40, 70] }}
C = {{ near = [25, 90] }}
D = {{ near = [80, 70] }}
[measures]
xb = "x(B)"
yb = "y(B)"
xc = "x(C)"
yc = "y(C)"
angle_1 = "angle(one)"
angle_2 = "angle(two)"
angle_3 = "angle(three)"
angle_4 = "angle(four)"
rate_1 = "rate(angle(one))"
rate_2 = "rate(angle(two))"
rate_3 = "rate(angle(three))"
rate_4 = "rate(angle(four))"
of_a = "reaction(A)"
of_c = "reaction(C)"
of_e = "reaction(E)"
per_1 = "d(x(C), q1)"
mass_1 = "reduced_mass(q1)"
mass_2 = "reduced_mass(q2)"
load_2 = "reduced_load(q2)"
kinetic = "kinetic_energy"
potential = "potential_energy"
"#
    )
}

#[test]
fn a_five_bar_passes_its_stretched_pose() {
    // Later on, what differs by rounding differs by more and more: it is chaotic.
    let until = 0.6;
    let names = [
        "xb", "yb", "xc", "yc", "rate_1", "rate_2", "rate_3", "rate_4", "of_a", "of_c", "of_e",
        "angle_1", "angle_2", "angle_3", "angle_4",
    ];
    // The cranks drive each other apart until their couplers are stretched.
    let cranks = five_bar(
        "q1 = { turns = \"one\", at = \"110 deg\" }\nq2 = { turns = \"three\", at = \"75 deg\" }",
    );
    let mut free = Free::new(&cranks, until);
    free.question.start = vec![[110_f64.to_radians(), 4.0], [75_f64.to_radians(), -3.0]];
    let found = free.run();
    assert_eq!(found.ending, Ending::Until);
    assert!(found.told_by().len() > 1, "no dead point");
    let drift = energy_drift(&free, &found, until);
    assert!(drift < 1e-10, "{drift:e}");
    let of_cranks = motion(&found);
    let times: Vec<f64> = (0..=100).map(|k| until * f64::from(k) / 100.0).collect();
    let a = values(&free.model, &of_cranks, &names, &times);
    // What is asked along the cranks is as before a link told in their stead: there the same motion goes by the cranks themselves.
    let per = ["per_1", "mass_1", "mass_2", "load_2"];
    let early: Vec<f64> = (0..=8).map(|k| 0.005 * f64::from(k)).collect();
    free.question.until = 0.0401;
    let short = free.run();
    assert!(short.told_by().is_empty());
    let by_cranks = values(&free.model, &motion(&short), &per, &early);
    let by_links = values(&free.model, &of_cranks, &per, &early);
    let off = difference(&by_cranks, &by_links);
    assert!(off < 1e-9, "{off:e}");
    let start = &a[0];
    let side = five_bar(&format!(
        "q1 = {{ turns = \"one\", at = \"{} rad\" }}\nq2 = {{ turns = \"two\", at = \"{} rad\" }}",
        start[11], start[12]
    ));
    let mut other = Free::new(&side, until);
    other.question.start = vec![[start[11], start[4]], [start[12], start[5]]];
    let by_side = other.run();
    assert_eq!(by_side.ending, Ending::Until);
    let b = values(&other.model, &motion(&by_side), &names, &times);
    let off = difference(&b, &a);
    assert!(off < 1e-8, "{off:e}");
}

#[test]
fn one_that_is_let_go_passes_beside_one_that_is_driven() {
    // The right crank turns evenly, the left one is let go: the couplers are stretched on the way, and work is done.
    let drives = "q1 = { turns = \"one\", at = \"110 deg\" }\nq2 = { turns = \"three\", from = \"75 deg\", to = \"45 deg\", speed = \"50 deg/s\" }";
    let until = 0.6;
    let mut free = Free::new(&five_bar(drives), until);
    free.question.free.truncate(1);
    free.question.start = vec![[110_f64.to_radians(), 6.0]];
    let found = free.run();
    assert_eq!(found.ending, Ending::Until);
    assert!(found.told_by().len() > 1, "no dead point");
    let times: Vec<f64> = (0..=100).map(|k| until * f64::from(k) / 100.0).collect();
    let names = ["kinetic", "potential"];
    let e = values(&free.model, &motion(&found), &names, &times);
    let most = e.iter().map(|row| row[0]).fold(0.0, f64::max);
    for (row, time) in e.iter().zip(&times) {
        let gained = row[0] + row[1] - e[0][0] - e[0][1];
        let off = (gained - found.work.at(*time, &[])).abs() / most;
        assert!(off < 1e-10, "{time}: {off:e}");
    }
    assert!(found.work.at(until, &[]).abs() > 1e-3 * most);
}

#[test]
fn it_ends_where_no_link_turns_on() {
    // A plate with a wave in it slides under a pin that goes up and down: at the crest the pin stands, and nothing turns.
    let text = r#"units = { length = "mm" }
[links]
frame = { O = [0, 0], X = [100, 0], Y = [0, 100] }
plate = { P = [0, 0], S = [-60, 40], T = [-30, 60], U = [0, 70], V = [30, 60], W = [60, 40], mass = "1 kg", inertia = "1 kg mm^2" }
pusher = { Q = [0, 0], mass = "0.2 kg", inertia = "1 kg mm^2" }
[joints]
bed  = { slider = "plate", at = "P", on = "O -> X" }
way  = { slider = "pusher", at = "Q", on = "O -> Y" }
wave = { pin = "Q", through = ["S", "T", "U", "V", "W"] }
[drives]
lift = { slides = "way", at = "60 mm" }
[assembly]
P = { near = [30, 0] }
"#;
    let (_, found) = run(text, [0.06, 0.5], 1.0);
    assert!(
        matches!(found.ending, Ending::Limit(_) | Ending::NoWay(_)),
        "{:?}",
        found.ending
    );
    assert!(found.told_by().is_empty());
    // It comes to the crest, 70 mm up.
    let [lift, _] = common::at(&found, 0, found.end);
    assert!((lift - 0.07).abs() < 1e-6, "{lift}");
}

#[test]
fn a_cylinder_let_go_passes_where_it_is_shortest() {
    // It stands on the frame and holds a crank that turns round: two dead points each turn.
    let text = |drive: &str| {
        format!(
            r#"units = {{ length = "mm" }}
[links]
frame = {{ A = [0, 0], F = [150, 20] }}
crank = {{ A-B = 40, mass = "1 kg", center = [25, 4], inertia = "900 kg*mm^2" }}
[drives]
{drive}
[assembly]
B = {{ near = [0, 40] }}
[measures]
angle = "angle(crank)"
rate = "rate(angle(crank))"
length = "distance(F, B)"
of_a = "reaction(A)"
"#
        )
    };
    let names = ["angle", "rate", "length", "of_a"];
    let length = 22_900.0_f64.sqrt() / 1e3;
    let (ram, by_ram) = run(
        &text(&format!(
            r#"ram = {{ cylinder = "F-B", at = "{length} m" }}"#
        )),
        [length, 1.0],
        1.0,
    );
    assert_eq!(by_ram.ending, Ending::Until);
    assert_eq!(by_ram.told_by().len(), 2);
    let of_ram = motion(&by_ram);
    let start = &values(&ram.model, &of_ram, &names, &[0.0])[0];
    let (crank, by_crank) = run(
        &text(&format!(
            r#"motor = {{ turns = "crank", at = "{} rad" }}"#,
            start[0]
        )),
        [start[0], start[1]],
        1.0,
    );
    let times: Vec<f64> = (0..=100).map(|k| f64::from(k) / 100.0).collect();
    let a = values(&ram.model, &of_ram, &names, &times);
    let b = values(&crank.model, &motion(&by_crank), &names, &times);
    let off = difference(&b, &a);
    assert!(off < 1e-9, "{off:e}");
}

#[test]
fn a_rocker_let_go_moves_as_the_crank_let_go_does() {
    for unit in ["mm", "m", "um"] {
        let swing = crank_rocker(unit, r#"swing = { turns = "rocker", at = "120 deg" }"#, "");
        // Large ones swing slowly.
        let until = match unit {
            "mm" => 3.0,
            "m" => 60.0,
            _ => 0.06,
        };
        let (rocker, by_rocker) = run(&swing, [120_f64.to_radians(), 6.0 / until], until);
        assert_eq!(by_rocker.ending, Ending::Until, "{unit}");
        assert!(by_rocker.told_by().len() > 1, "{unit}: no dead point");
        let of_rocker = motion(&by_rocker);
        let start = &values(
            &rocker.model,
            &of_rocker,
            &["crank_angle", "crank_rate"],
            &[0.0],
        )[0];
        let at = format!(r#"motor = {{ turns = "crank", at = "{} rad" }}"#, start[0]);
        let turn = crank_rocker(unit, &at, "");
        let (crank, by_crank) = run(&turn, [start[0], start[1]], until);
        assert!(by_crank.told_by().is_empty());
        let of_crank = motion(&by_crank);
        let times: Vec<f64> = (0..=300).map(|k| until * f64::from(k) / 300.0).collect();
        let a = values(&rocker.model, &of_rocker, &ALL, &times);
        let b = values(&crank.model, &of_crank, &ALL, &times);
        let off = difference(&b, &a);
        assert!(off < 1e-9, "{unit}: {off:e}");
    }
}
