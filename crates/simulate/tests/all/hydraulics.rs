//! Cylinders moved by their oil, and switches, against what is known apart from the equations.
#![allow(clippy::unwrap_used)]

use crate::common::{Free, at};
use kempe_model::Law;
use kempe_number::Jet;
use kempe_simulate::{Happened, Method, Simulated};

/// A block of 100 kg that a cylinder of 20 and 12 cm^2 pushes along its guide, level.
fn block(oil: &str, rest: &str) -> String {
    format!(
        r#"
gravity = 0
[links]
frame = {{ O = [0, 0], X = [1, 0], F = [-1, 0] }}
block = {{ B = [0, 0], mass = 100, inertia = 1 }}
[joints]
guide = {{ slider = "block", at = "B", on = "O -> X" }}
[drives]
push = {{ cylinder = "F-B", at = 1.2 }}
[assembly]
B = {{ near = [0.2, 0] }}
[cylinders.push]
bore   = "sqrt(4 * 0.002 m^2 / pi)"
rod    = "sqrt(4 * 0.0008 m^2 / pi)"
supply = "100 bar"
{oil}
{rest}
"#
    )
}

fn of(law: &Law, time: f64) -> [f64; 2] {
    let x: Jet<f64, 2> = law.at(Jet::variable(time), &[]);
    [x.derivative(0), x.derivative(1)]
}

/// Pressures at a time.
fn pressures(found: &Simulated, time: f64) -> [f64; 2] {
    [0, 1].map(|side| of(found.inner[side].as_ref().unwrap(), time)[0])
}

const SHUT: &str = r#"
[cylinders.push.oil]
bulk_modulus = "1 GPa"
volume = ["1 L", "0.5 L"]
valve  = 0
flow   = "10 L/min"
drop   = "35 bar"
"#;

#[test]
fn shut_in_oil_is_a_spring_on_both_sides() {
    // Constant volumes: stiffness K (A0^2/V0 + A1^2/V1) = 4000 + 2880 kN/m on 100 kg.
    let text = block(SHUT, "");
    let mut free = Free::new(&text, 0.1);
    free.question.start[0][1] = 0.05;
    let found = free.run();
    let omega = f64::sqrt((4.0e6 + 2.88e6) / 100.0);
    for time in [0.01, 0.037, 0.1] {
        let s = kempe_number::math::sin_cos(omega * time).0 * 0.05 / omega;
        let [q, _] = at(&found, 0, time);
        assert!((q - 1.2 - s).abs() < 1e-12, "{time}: {q}");
        let [bore, ring] = pressures(&found, time);
        assert!((bore + 1e9 / 1e-3 * 0.002 * s).abs() < 1e-2, "{bore}");
        assert!((ring - 1e9 / 5e-4 * 0.0012 * s).abs() < 1e-2, "{ring}");
    }
    // What the oil gave is what the block has less.
    let [_, v] = at(&found, 0, 0.037);
    let work: f64 = found.work.at(0.037, &[]);
    let gained = 50.0 * (v * v - 0.0025);
    assert!((work - gained).abs() < 1e-10, "{work}, not {gained}");
}

#[test]
fn volumes_that_go_with_the_rod_compress_by_the_logarithm() {
    // dp = -K dV/V, or with walls that yield -dV / (V/K + (V - V0)/K_wall + V0/K_hose), whose integral is a logarithm too.
    let walls = "closed = 1\nstroke = 0.5\nhose_modulus = \"0.4 GPa\"\nwall_modulus = \"5 GPa\"";
    let text = block(&format!("{SHUT}{walls}"), "");
    let mut free = Free::new(&text, 0.05);
    free.question.start[0][1] = 1.0;
    let found = free.run();
    for time in [0.005, 0.02, 0.05] {
        let [q, _] = at(&found, 0, time);
        let pressure = |rest: f64, area: f64, from: f64, to: f64| {
            let slope = 1.0 / 1e9 + 1.0 / 5e9;
            let constant = rest * (1.0 / 0.4e9 - 1.0 / 5e9);
            let yields = |free: f64| slope * (rest + area * free) + constant;
            -kempe_number::math::ln(yields(to) / yields(from)) / slope
        };
        let [bore, ring] = pressures(&found, time);
        let exact = pressure(1e-3, 0.002, 0.2, q - 1.0);
        assert!(
            (bore / exact - 1.0).abs() < 1e-9,
            "{time}: {bore}, not {exact}"
        );
        let exact = pressure(5e-4, 0.0012, 0.3, 1.5 - q);
        assert!(
            (ring / exact - 1.0).abs() < 1e-9,
            "{time}: {ring}, not {exact}"
        );
    }
}

#[test]
fn seals_hold_until_the_oil_breaks_them_loose() {
    // The block rests while sqrt(supply - p) falls evenly: p' = K/V Qn sqrt(ps - p), up to p = friction / area.
    let oil = SHUT.replace("valve  = 0", "valve  = [1, 0]");
    let text = block(&format!("friction = \"6 kN\"\n{oil}start = [0, 0]"), "");
    let found = Free::new(&text, 0.05).run();
    let slips = found.happenings.iter().find(|h| h.what == Happened::Slips);
    let qn = 10e-3 / 60.0 / f64::sqrt(35e5);
    let exact = 2.0 * (f64::sqrt(1e7) - f64::sqrt(1e7 - 3e6)) / (1e9 / 1e-3 * qn);
    let time = slips.unwrap().time;
    assert!((time / exact - 1.0).abs() < 1e-11, "{time}, not {exact}");
    assert_eq!(at(&found, 0, 0.9 * time), [1.2, 0.0]);
    assert!((pressures(&found, time)[0] / 3e6 - 1.0).abs() < 1e-10);
    assert!(at(&found, 0, 0.05)[1] > 0.0);
}

/// Pressures that are not told hold what acts on the block by themselves: seals and guides may let go at any time.
#[test]
fn pressures_at_the_start_count_no_friction() {
    let load = "[loads]\npush_back = { at = \"B\", force = [-4000, 0] }\n";
    let guide = "[friction]\nguide = { coefficient = 0.2, drag = \"1 kN\" }\n";
    let at_start = |seals: &str, rest: &str| {
        let found = Free::new(&block(&format!("{seals}{SHUT}"), rest), 0.01).run();
        pressures(&found, 0.0)
    };
    let smooth = at_start("", load);
    assert!((smooth[0] * 0.002 - smooth[1] * 0.0012 - 4000.0).abs() < 1e-6);
    let rough = at_start("friction = \"6 kN\"\n", &format!("{load}{guide}"));
    for (a, b) in smooth.iter().zip(rough) {
        assert!((a - b).abs() < 1e-3, "{smooth:?} {rough:?}");
    }
}

#[test]
fn a_valve_that_opens_sinks_to_the_tank_however_stiff() {
    // Drained against nothing it goes to zero, by the root and below 0.1 bar smoothly; both methods tell the same.
    let oil = SHUT.replace("valve  = 0", "valve  = [-1, 0]");
    let text = block(
        &format!("{oil}start = [\"50 bar\", \"83.3 bar\"]\ndamping = \"400 kN s/m\""),
        "",
    );
    let mut free = Free::new(&text, 0.5);
    free.question.tolerance = 1e-10;
    let runs = [Method::Explicit, Method::Implicit].map(|method| {
        free.question.method = method;
        free.run()
    });
    for time in [0.002, 0.05, 0.5] {
        let [a, b] = [0, 1].map(|k| pressures(&runs[k], time));
        for side in [0, 1] {
            assert!(
                (a[side] - b[side]).abs() < 20.0,
                "{time} {side}: {a:?} {b:?}"
            );
        }
    }
    let bore = pressures(&runs[0], 0.5)[0];
    assert!(bore.abs() < 5e3, "{bore}");
}

#[test]
fn two_cylinders_are_one_of_twice_the_size() {
    let two = format!(
        "friction = \"50 N\"\ncount = 2\n{SHUT}damping = \"1 kN s/m\"\nleakage = \"1 L/min/bar\"\nstart = [0, \"9 bar\"]"
    );
    let one = two
        .replace("count = 2", "")
        .replace("50 N", "100 N")
        .replace("1 kN s/m", "2 kN s/m")
        .replace("1 L/min/bar", "2 L/min/bar")
        .replace("\"1 L\", \"0.5 L\"", "\"2 L\", \"1 L\"");
    let [two, one] = [two, one].map(|oil| {
        let text = block(&oil, "");
        let areas = match oil.contains("count") {
            true => text,
            false => text
                .replace("0.002 m^2", "0.004 m^2")
                .replace("0.0008", "0.0016"),
        };
        let mut free = Free::new(&areas, 0.2);
        free.question.start[0][1] = 0.3;
        free.run()
    });
    for time in [0.01, 0.1, 0.2] {
        let [a, b] = [&two, &one].map(|found| at(found, 0, time)[0]);
        assert!((a - b).abs() < 1e-12, "{time}: {a} {b}");
        assert!((pressures(&two, time)[0] - pressures(&one, time)[0]).abs() < 0.1);
    }
}

#[test]
fn oil_that_holds_a_load_leaves_it_where_it_is() {
    // Two arms on two cylinders, one of which pulls, in whatever pose: nothing moves while both valves are shut.
    let text = r#"
[links]
frame = { O = [0, 0], F = [0.1, -0.5], G = [-0.2, 0.8] }
arm   = { O-P = 1, B = [0.6, 0.1], C = [0.7, 0.1], mass = "50 kg", inertia = "6 kg m^2" }
jib   = { P-Q = 0.8, D = [0.4, 0], mass = "20 kg", inertia = "2 kg m^2" }
[drives]
lift = { cylinder = "F-B", at = 0.9 }
tip  = { cylinder = "G-D", at = 1.6 }
[assembly]
P = "left of O -> B"
arm = { near = "20 deg" }
jib = { near = "-30 deg" }
[loads]
hook = { force = [100, -900], at = "Q" }
[cylinders.lift]
bore = 0.06
rod = 0.04
supply = "200 bar"
back = "3 bar"
oil = { bulk_modulus = "1 GPa", volume = ["0.3 L", "0.3 L"], valve = 0, flow = "10 L/min", drop = "35 bar" }
[cylinders.tip]
bore = 0.05
rod = 0.03
supply = "200 bar"
oil = { bulk_modulus = "1 GPa", volume = ["0.3 L", "0.3 L"], valve = 0, flow = "10 L/min", drop = "35 bar" }
"#;
    let text = text.replace("P = \"left of O -> B\"\n", "");
    let found = Free::new(&text, 0.3).run();
    for (drive, start) in [(0, 0.9), (1, 1.6)] {
        let [q, v] = at(&found, drive, 0.3);
        assert!(
            (q - start).abs() < 1e-12 && v.abs() < 1e-11,
            "{drive}: {q} {v}"
        );
    }
    let all: Vec<f64> = (0..4)
        .map(|k| of(found.inner[k].as_ref().unwrap(), 0.3)[0])
        .collect();
    // One side of each is that of the tank, and no side pulls.
    assert!(
        (all[0] - 3e5).abs().min((all[1] - 3e5).abs()) < 1.0,
        "{all:?}"
    );
    assert!(all[2].abs().min(all[3].abs()) < 1.0, "{all:?}");
    assert!(all.iter().all(|p| *p > -1.0), "{all:?}");
}

#[test]
fn a_pressure_below_vacuum_is_told_where_it_is() {
    let text = block(SHUT, "");
    let mut free = Free::new(&text, 0.05);
    free.question.start[0][1] = 0.5;
    let found = free.run();
    // p = -V' K/V first falls by 1.01325 bar where s = 101325 V/(K A).
    let omega = f64::sqrt(6.88e6 / 100.0);
    let s = 101_325.0 * 1e-3 / (1e9 * 0.002);
    let first = kempe_number::math::asin(s * omega / 0.5) / omega;
    let told = found
        .happenings
        .iter()
        .find(|h| matches!(h.what, Happened::Cavitates { .. }));
    let time = told.unwrap().time;
    assert!((time / first - 1.0).abs() < 1e-9, "{time}, not {first}");
}

/// A block that a force drives to and fro between switches.
const SHUTTLE: &str = r#"
gravity = 0
[links]
frame = { O = [0, 0], X = [1, 0] }
block = { B = [0, 0], mass = 2, inertia = 1 }
[joints]
guide = { slider = "block", at = "B", on = "O -> X" }
[drives]
way = { slides = "block", at = 0 }
[switches]
ahead = { on = "x(B) <= 1 m", off = "x(B) >= 3 m", starts = "on" }
late  = { on = "time >= 2.5 s" }
both  = { on = "switch(ahead) + switch(late) >= 1.5" }
[loads]
push = { force = ["4 N * (2 * switch(ahead) - 1) + 20 N * switch(both)", 0], at = "B" }
"#;

#[test]
fn switches_turn_at_the_instant_and_go_by_each_other() {
    let mut free = Free::new(SHUTTLE, 8.0);
    free.question.tolerance = 1e-12;
    let found = free.run();
    let told: Vec<(f64, usize, bool)> = (found.happenings.iter())
        .filter_map(|h| match h.what {
            Happened::Switches { switch, on } => Some((h.time, switch, on)),
            _ => None,
        })
        .collect();
    // 2 m/s^2 up to 3 m at sqrt(3) s with 2 sqrt(3) m/s; then -2 m/s^2.
    let root = f64::sqrt(3.0);
    // Back at 1 m where 3 + 2 sqrt(3) t - t^2 = 1.
    let back = root + root + f64::sqrt(5.0);
    let expected = [
        (root, 0, false),
        (2.5, 1, true),
        (back, 0, true),
        (back, 2, true),
    ];
    for (found, expected) in told.iter().zip(expected) {
        assert!((found.0 - expected.0).abs() < 1e-11, "{told:?}");
        assert_eq!((found.1, found.2), (expected.1, expected.2), "{told:?}");
    }
    // From there 12 m/s^2: it passes 3 m and turns all off that hang on it.
    assert!(told.len() >= 6, "{told:?}");
    let speed = -2.0 * (root + f64::sqrt(5.0)) + 2.0 * root;
    let again = back + (-speed + f64::sqrt(speed * speed + 4.0 * 6.0 * 2.0)) / 12.0;
    assert!((told[4].0 - again).abs() < 1e-11 && told[4].1 == 0 && !told[4].2);
    assert!((told[5].0 - again).abs() < 1e-11 && told[5].1 == 2 && !told[5].2);
    let law = found.inner[0].as_ref().unwrap();
    for (time, on) in [
        (0.1, 1.0),
        (root + 1e-9, 0.0),
        (back - 1e-9, 0.0),
        (back + 1e-9, 1.0),
    ] {
        assert_eq!(of(law, time), [on, 0.0], "{time}");
    }
}

#[test]
fn a_motor_gives_the_part_that_its_throttle_says() {
    let text = r#"
gravity = 0
[links]
frame = { A = [0, 0] }
wheel = { A-B = 1, mass = 1, inertia = 0.5, center = [0, 0] }
[drives]
motor = { turns = "wheel", at = 0 }
[motors]
motor = { curve = [[0, "3 N m"], ["300 rad/s", "3 N m"]], throttle = "switch(runs) * (1 - motor / 20 rad)" }
[switches]
runs = { on = "angular_speed(wheel) <= 2 rad/s", off = "angular_speed(wheel) >= 4 rad/s" }
"#;
    let found = Free::new(text, 3.0).run();
    // q" = 6 - 0.3 q until 4 rad/s: q = 20 (1 - cos(w t)), w^2 = 0.3; then it runs on.
    let w = f64::sqrt(0.3);
    let off = kempe_number::math::asin(4.0 / (20.0 * w)) / w;
    assert_eq!(found.happenings.len(), 1, "{:?}", found.happenings);
    assert!((found.happenings[0].time - off).abs() < 1e-12);
    let [q, v] = at(&found, 0, 3.0);
    let cos = kempe_number::math::sin_cos(w * off).1;
    assert!((v - 4.0).abs() < 1e-12 && (q - 20.0 * (1.0 - cos) - 4.0 * (3.0 - off)).abs() < 1e-11);
    assert_eq!(found.gives(0, [0.0, 0.0], 1.0), 3.0);
}

/// A wheel with a pawl behind every radian, thrown forward against a spring.
#[test]
fn a_switch_that_counts_makes_a_ratchet() {
    let text = r#"
gravity = 0
[links]
frame = { A = [0, 0] }
wheel = { A-B = 1, mass = 1, inertia = 2, center = [0, 0] }
[springs]
back = { links = ["frame", "wheel"], stiffness = "8 N m/rad", free = 0 }
[drives]
turn = { turns = "wheel", at = "1.5 rad" }
[switches]
teeth = { on = "turn >= 1 rad", every = "1 rad" }
[measures]
play = "turn - switch(teeth) * 1 rad"
"#;
    let mut free = Free::new(text, 3.0);
    free.question.start[0][1] = 4.0;
    free.stop("play", 0.0);
    let found = free.run();
    // It begins past the first tooth, swings out to sqrt(1.5^2 + 2^2) = 2.5 rad past the second, and falls back on that.
    let counted: Vec<(f64, f64)> = (found.happenings.iter())
        .filter_map(|h| match h.what {
            Happened::Counts { to, .. } => Some((h.time, to)),
            _ => None,
        })
        .collect();
    let angle = |x: f64| kempe_number::math::asin(x / 2.5);
    let second = 0.5 * (angle(2.0) - angle(1.5));
    assert_eq!(counted.len(), 1, "{counted:?}");
    assert!((counted[0].0 - second).abs() < 1e-12 && counted[0].1 == 2.0);
    let struck = found.happenings.iter().find_map(|h| match h.what {
        Happened::Strikes { before, .. } => Some((h.time, before)),
        _ => None,
    });
    let (time, before) = struck.unwrap();
    let back = 0.5 * (std::f64::consts::PI - angle(2.0) - angle(1.5));
    assert!((time - back).abs() < 1e-12, "{time}, not {back}");
    assert!((before + 3.0).abs() < 1e-11, "{before}");
    assert_eq!(at(&found, 0, 3.0), [2.0, 0.0]);
}
