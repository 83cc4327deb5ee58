//! What simulations say of friction, impacts, switches and motors, as a user runs them.
#![allow(clippy::unwrap_used)]

use crate::told::column;
use kempe_draw::report::HappeningKind;
use kempe_model::Model;
use kempe_motion::events::EventKind;
use kempe_study::{Silent, StudyResult, run};

fn model(text: &str) -> Model {
    let read = Model::from_toml(text, "simulated", &mut |_| Err("no files".into()));
    read.unwrap().model
}

fn result(text: &str) -> StudyResult {
    let model = model(text);
    run(&model, &model.studies[0], &mut Silent).unwrap()
}

fn worst_energy(result: &StudyResult) -> f64 {
    let balance = result.table.balance.as_ref().unwrap();
    balance.energy.iter().fold(0.0, |most, x| most.max(x.abs()))
}

fn codes(result: &StudyResult) -> Vec<&'static str> {
    result.diagnostics.iter().map(|d| d.code).collect()
}

/// A block on a line.
const BLOCK: &str = r#"
units = { length = "m", angle = "rad" }
[links]
frame = { O = [0, 0], X = [1, 0] }
block = { A = [0, 0], mass = 2, inertia = 0, center = "A" }
[joints]
way = { slider = "block", at = "A", on = "O -> X" }
[drives]
d = { slides = "block", at = 0 }
"#;

/// What coasts against friction is held by nothing: the effort of a drive that is let go is rounding, whatever its sign.
#[test]
fn nothing_locks_that_coasts() {
    let found = result(&format!(
        "{BLOCK}[friction]\nway = {{ coefficient = 0.1 }}\n[loads]\npull = {{ force = [\"0.5 N\", 0], at = \"A\", on = \"block\" }}\n\
         [studies.go]\nkind = \"simulate\"\nstart = {{ d_rate = \"1 m/s\" }}\nuntil = \"3 s\"\nstep = \"10 ms\"\n\
         columns = [\"d\", \"rate(d)\"]\n"
    ));
    assert_eq!(codes(&found), [""; 0]);
    // 0.981 m/s^2 less 0.25 m/s^2 brake it.
    let way = *column(&found, "d").last().unwrap();
    assert!((way - 0.5 / (0.981 - 0.25)).abs() < 1e-9, "{way} m");
}

/// What strikes a stop at once has lost its energy before the first row.
#[test]
fn an_impact_at_the_start_is_in_no_row() {
    let found = result(
        r#"
units = { length = "m", angle = "deg" }
gravity = 0
[links]
frame = { O = [0, 0] }
rod   = { O-P = 1, mass = 2, inertia = 0.15 }
[drives]
p = { turns = "rod", at = 30 }
[studies.a]
kind    = "simulate"
start   = { p_rate = "2 rad/s" }
stops   = { p = { between = ["none", 30], restitution = 0.5 } }
until   = "0.1 s"
rows    = 3
columns = ["kinetic_energy"]
"#,
    );
    assert_eq!(codes(&found), [""; 0]);
    assert!(worst_energy(&found) < 1e-13);
    // Thin, as long as 1 m and with its centre in the middle: it goes back at 1 rad/s.
    let energy = column(&found, "kinetic_energy");
    assert!(
        energy
            .iter()
            .all(|e| (e / (0.5 * (0.15 + 0.5)) - 1.0).abs() < 1e-12),
        "{energy:?}"
    );
}

/// A governor with one threshold goes on where it is off and off where it is on: that is no motion, and it is told; with two it keeps the
/// speed between them.
#[test]
fn a_switch_that_goes_to_and_fro_is_told() {
    let governed = |switch: &str| {
        format!(
            "{BLOCK}[switches]\ns = {{ {switch} }}\n\
             [loads]\nl = {{ force = [\"6 N * switch(s) - 2 N\", 0], at = \"A\", on = \"block\" }}\n\
             [studies.a]\nkind = \"simulate\"\nuntil = \"2 s\"\nrows = 41\ncolumns = [\"rate(d)\", \"switch(s)\"]\n"
        )
        .replace("[links]", "gravity = 0\n[links]")
    };
    for on in ["rate(d) <= 1 m/s", "rate(d) < 1.1 m/s", "1 m/s >= rate(d)"] {
        let found = result(&governed(&format!("on = \"{on}\"")));
        assert_eq!(codes(&found), ["simulation-ended"], "{on}");
        let told = &found.diagnostics[0];
        assert!(
            told.help.iter().any(|it| it.contains("`off` of its own")),
            "{told:?}"
        );
    }
    let found = result(&governed(
        "on = \"rate(d) <= 0.9 m/s\", off = \"rate(d) >= 1 m/s\", starts = \"on\"",
    ));
    assert_eq!(codes(&found), [""; 0]);
    let speed = column(&found, "rate(d)");
    assert!(
        speed[11..]
            .iter()
            .all(|v| (0.9 - 1e-9..1.0 + 1e-9).contains(v)),
        "{speed:?}"
    );
}

/// At rest a motor has left what it gives forwards, though rounding starts it backwards.
#[test]
fn a_motor_at_rest_has_its_first_torque() {
    let found = result(
        r#"
units = { length = "m", angle = "rad" }
gravity = 0
[links]
frame = { O = [0, 0] }
rod   = { O-P = 1, mass = 2, inertia = 0.15, center = [0.5, 0] }
[drives]
pivot = { turns = "rod", from = 0, to = 100, speed = "1 rad/s" }
[motors]
pivot = { curve = [["0 rpm", "12 N m"], ["3000 rpm", "0 N m"]] }
[loads]
l = { torque = "-0.02 N m s * rate(pivot)", on = "rod" }
[studies.go]
kind    = "simulate"
until   = "2 s"
step    = "10 ms"
columns = ["torque(pivot)", "capacity(pivot)"]
"#,
    );
    for name in ["torque(pivot)", "capacity(pivot)"] {
        let first = column(&found, name)[0];
        assert!((first - 12.0).abs() < 1e-9, "{name} {first}");
    }
}

/// Held by its seals a cylinder breaks away with no acceleration at all, while large forces are in balance: it goes on, whatever the numbers.
#[test]
fn a_cylinder_breaks_away_from_its_seals() {
    let lifted = |valve: &str, friction: &str| {
        format!(
            r#"
units = {{ length = "m", angle = "rad", pressure = "bar" }}
[links]
frame = {{ O = [0, 0], F = [0, -0.25] }}
arm   = {{ O-P = 1, B = [0.25, 0], mass = "120 kg", inertia = "10 kg m^2", center = [0.5, 0] }}
[drives]
lift = {{ cylinder = "F-B", at = "0.25 m * sqrt(2)" }}
[assembly]
arm = {{ near = 0 }}
[cylinders.lift]
bore     = "100 mm"
rod      = "60 mm"
supply   = "200 bar"
back     = "3 bar"
friction = "{friction}"
[cylinders.lift.oil]
bulk_modulus = "1.5 GPa"
volume  = ["1 L", "1 L"]
valve   = {valve}
flow    = "0.2 L/s"
drop    = "1 MPa"
damping = "20 kN s/m"
closed  = "0.3 m"
stroke  = "0.15 m"
leakage = "1e-12 m^3/s/Pa"
[studies.lift]
kind    = "simulate"
until   = "20 ms"
step    = "10 ms"
columns = ["angle(arm)"]
"#
        )
    };
    for valve in ["0.05", "0.3", "0.5", "1", "-0.3", "-1"] {
        for friction in ["1 N", "300 N", "1000 N"] {
            let found = result(&lifted(valve, friction));
            assert_eq!(codes(&found), [""; 0], "{valve} {friction}");
        }
    }
    // An integrator of its own (Radau, friction by its sign) found this at 10 ms.
    let angle = column(&result(&lifted("0.5", "300 N")), "angle(arm)")[1];
    assert!((angle - 0.0017791).abs() < 1e-6, "{angle} rad");
}

/// A bob on a pin with play comes to rest on its stop, leaves it as it gives and grazes it again: that is no rattling without end.
#[test]
fn what_grazes_a_stop_rests_on_it() {
    for tolerance in ["1e-8", "1e-9", "1e-10", "1e-11"] {
        let found = result(&format!(
            r#"
units = {{ length = "mm", angle = "deg" }}
[links]
frame = {{ O = [0, 0] }}
rod   = {{ O-P = 100, mass = "1 kg", inertia = "1000 kg mm^2" }}
[clearance]
O = {{ radial = "1 mm", radius = "5 mm", law = "hertz", stiffness = 1e9 }}
[drives]
pivot = {{ turns = "rod", at = -90 }}
[studies.stopin]
kind      = "clearance"
model     = "three-state"
release   = "pivot"
until     = "0.1 s"
rows      = 21
start     = {{ O = ["1 mm", "-90 deg"], pivot_rate = "5 rad/s" }}
stops     = {{ pivot = {{ between = [-100, -80], restitution = 0.5 }} }}
tolerance = {tolerance}
"#
        ));
        assert_eq!(codes(&found), [""; 0], "{tolerance}");
        assert_eq!(found.table.rows(), 21);
        assert!(worst_energy(&found) < 1e-7);
    }
}

/// An arm bounces while the other lies on a stop: what is pressed on it by every impact stays, so that each bounce is slower by the arm's own
/// restitution, and in the end both rest.
#[test]
fn what_it_lies_on_takes_part_in_an_impact() {
    let found = result(
        r#"
units = { length = "mm", angle = "deg" }
[links]
frame = { A = [0, 0] }
a = { A-B = 100, mass = "1 kg", inertia = "0.001 kg m^2" }
b = { B-C = 100, mass = "1 kg", inertia = "0.001 kg m^2" }
[drives]
x = { turns = "a", at = 60 }
y = { turns = "b", relative_to = "a", at = -120 }
[measures]
hgt = "y(C)"
[studies.g]
kind = "simulate"
until = "3 s"
rows = 31
stops = { a = { between = [-20, "none"], restitution = 0.8 }, hgt = [-60, "none"] }
columns = ["angle(a)", "y(C)"]
"#,
    );
    assert_eq!(codes(&found), [""; 0]);
    let happened = found.listings.iter().find(|l| l.title == "What happened");
    let happened = &happened.expect("a list").rows;
    let text = |row: &Vec<String>| row.join(" ");
    assert!(
        !happened.iter().any(|row| text(row).contains("leaves the")),
        "{happened:?}"
    );
    let strikes: Vec<f64> = (happened.iter().map(text))
        .filter_map(|it| Some(it.split_once("lower stop of a at ")?.1.to_owned()))
        .filter_map(|it| it.split(' ').next()?.parse().ok())
        .collect();
    assert!(strikes.len() > 20, "{strikes:?}");
    for two in strikes.windows(2) {
        assert!((two[1] / two[0] - 0.8).abs() < 1e-4, "{two:?}");
    }
    let last = |name| *column(&found, name).last().expect("a row");
    assert!((last("angle(a)") + 20.0).abs() < 1e-9);
    assert!((last("y(C)") + 60.0).abs() < 1e-9);
}

/// A bar with play in its pin bounces on a stop and comes to rest on both: on the stop only once the pin presses it there.
#[test]
fn what_rests_on_one_stop_may_be_pressed_on_another() {
    let found = result(
        r#"
units = { length = "mm", angle = "deg" }
[links]
frame = { A = [0, 0] }
a = { A-B = 100, mass = "1 kg", inertia = "0.001 kg m^2", center = [60, 0] }
[drives]
x = { turns = "a", at = -30 }
[clearance]
A = { radial = "2 mm", law = "rigid", restitution = 0, friction = 0, radius = "5 mm" }
[studies.h]
kind = "clearance"
model = "three-state"
release = "x"
until = "2 s"
rows = 21
start = { A = ["2 mm", "-90 deg"] }
stops = { x = { between = ["-80 deg", "none"], restitution = 0.8 } }
"#,
    );
    assert_eq!(codes(&found), [""; 0]);
    assert_eq!(found.table.rows(), 21);
    assert!(worst_energy(&found) < 1e-7);
}

/// A parallelogram that hangs on a pendulum: with two freedoms it passes its change point as with one, which is told.
#[test]
fn several_freedoms_pass_a_change_point_that_is_named() {
    let text = r#"
units = { length = "mm", angle = "deg" }
[links]
frame = { O = [0, 0] }
pen = { A = [0, 0], D = [200, 0], O = [100, 50], mass = "3 kg", inertia = "0.03 kg m^2" }
crank = { A-B = 80, mass = "1 kg", inertia = "0.001 kg m^2" }
coupler = { B-C = 200, mass = "1 kg", inertia = "0.004 kg m^2" }
rocker = { D-C = 80, mass = "1.4 kg", inertia = "0.001 kg m^2" }
[drives]
o = { turns = "pen", at = 10 }
m = { turns = "crank", relative_to = "pen", at = 1 }
[assembly]
C = "left of B -> D"
[studies.s]
kind = "simulate"
start = { m_rate = "-15 rad/s" }
until = "10 ms"
rows = 11
tolerance = 1e-7
columns = ["angle(crank)"]
"#;
    let alone = text.replace(
        "kind = \"simulate\"",
        "kind = \"simulate\"\nrelease = [\"m\"]",
    );
    for text in [text, &alone] {
        let found = result(text);
        assert_eq!(codes(&found), [""; 0]);
        assert!(*column(&found, "angle(crank)").last().expect("a row") < 5.0);
        let passed = found
            .events
            .iter()
            .any(|e| e.kind == EventKind::ChangePoint);
        assert!(passed, "{:?}", found.events);
    }
}

/// A throttle below 0 drives a motor backwards by the same curve: up to the speed at which it gives nothing, and no motor is told to be too weak that did it.
#[test]
fn a_motor_runs_backwards_by_its_curve() {
    let wheel = |throttle: &str, starts: &str| {
        result(&format!(
            "[links]\nframe = {{ A = [0, 0] }}\nwheel = {{ A-P = 0.1, mass = \"1 kg\", inertia = \"0.02 kg m^2\", center = [0, 0] }}\n\
             [drives]\nm = {{ turns = \"wheel\", at = 0 }}\n\
             [motors]\nm = {{ curve = [[\"0 rpm\", \"4 N m\"], [\"100 rpm\", \"3 N m\"], [\"200 rpm\", \"0 N m\"]], throttle = \"{throttle}\" }}\n\
             [studies.g]\nkind = \"simulate\"\nstart = {{ m_rate = \"{starts}\" }}\nuntil = \"0.5 s\"\nrows = 11\n\
             columns = [\"angular_speed(wheel)\", \"torque(m)\", \"capacity(m)\"]"
        ))
    };
    for (throttle, starts) in [("1", "0 rad/s"), ("0.4", "-5 rad/s")] {
        let forwards = wheel(throttle, starts);
        let back = wheel(&format!("-{throttle}"), &format!("-1 * ({starts})"));
        assert_eq!((codes(&forwards), codes(&back)), (vec![], vec![]));
        for name in ["angular_speed(wheel)", "torque(m)"] {
            let both = column(&forwards, name).into_iter().zip(column(&back, name));
            for (a, b) in both {
                assert!((a + b).abs() <= 1e-12 * (1.0 + a.abs()), "{name}: {a} {b}");
            }
        }
        let speed = *column(&back, "angular_speed(wheel)").last().expect("a row");
        let most = -200.0 * std::f64::consts::PI / 30.0;
        assert!(speed > most && speed < 0.2 * most, "{speed}");
    }
}

/// From a change point it may come to either branch: that is refused, and what starts beside it goes through.
#[test]
fn a_start_at_a_change_point_is_refused() {
    let parallelogram = |start: &str| {
        model(&format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\n[links]\nframe = {{ A = [0, 0], D = [200, 0] }}\n\
             crank = {{ A-B = 80, mass = \"1 kg\", inertia = \"0.001 kg m^2\" }}\ncoupler = {{ B-C = 200, mass = \"1 kg\", inertia = \"0.004 kg m^2\" }}\n\
             rocker = {{ D-C = 80, mass = \"1 kg\", inertia = \"0.001 kg m^2\" }}\n[drives]\nm = {{ turns = \"crank\", at = 0 }}\n\
             [assembly]\nC = \"left of B -> D\"\n[studies.s]\nkind = \"simulate\"\nstart = {{ {start} }}\nuntil = \"0.3 s\"\nrows = 7\n\
             columns = [\"angle(crank)\", \"angle(rocker)\"]"
        ))
    };
    for start in ["m = 0", "m_rate = \"2 rad/s\""] {
        let model = parallelogram(start);
        let refused = run(&model, &model.studies[0], &mut Silent).expect_err("a change point");
        assert!(
            format!("{refused:?}").contains("change point"),
            "{refused:?}"
        );
    }
    for start in ["m = 0.01", "m = 0.01, m_rate = \"2 rad/s\""] {
        let model = parallelogram(start);
        let found = run(&model, &model.studies[0], &mut Silent).expect("a simulation");
        let angles = column(&found, "angle(crank)").into_iter();
        for (crank, rocker) in angles.zip(column(&found, "angle(rocker)")) {
            assert!((crank - rocker).abs() < 1e-6, "{crank} {rocker}");
        }
        assert!(worst_energy(&found) < 1e-7);
    }
}

/// A load that ramps in within little time: the row at its corner has the acceleration that is there, and nothing is warned of.
#[test]
fn a_row_at_a_corner_of_a_load_is_like_any_other() {
    for [ramp, per] in [["50 ms", "20"], ["1 ms", "1000"], ["1 us", "1000000"]] {
        let found = result(&format!(
            r#"
units = {{ length = "mm", angle = "deg" }}
[links]
frame = {{ A = [0, 0] }}
wheel = {{ A-P = 50, mass = "2 kg", inertia = "0.02 kg m^2", center = [0, 0] }}
[drives]
m = {{ turns = "wheel", at = 0 }}
[motors]
m = {{ curve = [["0 rpm", "3 N m"], ["1000 rpm", "2.5 N m"], ["1500 rpm", "0 N m"]] }}
[loads]
late = {{ torque = "-1 N m * min(1, max(0, (time - 1 s) * {per} / 1 s))", on = "wheel" }}
[studies.go]
kind = "simulate"
until = "2.9 s"
step = "{step}"
columns = ["torque(m)", "capacity(m)"]
"#,
            step = if ramp == "50 ms" { "10 ms" } else { "100 ms" },
        ));
        assert_eq!(codes(&found), [""; 0], "{ramp}");
        let torques = column(&found, "torque(m)").into_iter();
        for (row, (torque, most)) in torques.zip(column(&found, "capacity(m)")).enumerate() {
            assert!(
                (torque - most).abs() < 1e-6,
                "{ramp} {row}: {torque} {most}"
            );
        }
    }
}

/// What falls freely asks for few steps; what a drive that keeps its law works beside it is told right all the same, in a stroke and over many turns.
#[test]
fn the_work_of_drives_that_keep_their_laws_is_exact() {
    let lift = result(
        r#"
units = { length = "mm", angle = "deg" }
[links]
frame = { O = [0, 0], Y = [0, 500] }
plate = { P = [0, 0], mass = "3 kg", inertia = 0 }
ball  = { B = [0, 0], mass = "0.5 kg", inertia = 0 }
[joints]
g1 = { slider = "plate", at = "P", on = "O -> Y" }
g2 = { slider = "ball", at = "B", on = "O -> Y" }
[drives]
lift = { slides = "plate", from = 0, to = 80, law = "cycloidal", in = "0.3 s" }
fall = { slides = "ball", at = 400 }
[studies.s]
kind    = "simulate"
release = "fall"
until   = "0.3 s"
step    = "10 ms"
columns = ["y(B)", "force(lift)"]
"#,
    );
    let crank = result(
        r#"
units = { length = "mm", angle = "deg" }
[links]
frame   = { A = [0, 0], D = [60, 0], Y = [0, -500] }
crank   = { A-B = 20, mass = "1 kg" }
coupler = { B-C = 50, mass = "2 kg" }
rocker  = { D-C = 40, mass = "2 kg" }
ball    = { E = [0, 0], mass = "0.5 kg", inertia = 0 }
[joints]
guide = { slider = "ball", at = "E", on = "A -> Y" }
[drives]
motor = { turns = "crank", from = 0, to = "3600 deg", speed = "60 rpm" }
fall  = { slides = "ball", at = 0 }
[assembly]
C = "left of B -> D"
[studies.s]
kind    = "simulate"
release = "fall"
until   = "10 s"
step    = "100 ms"
columns = ["y(E)", "torque(motor)"]
"#,
    );
    for found in [lift, crank] {
        assert_eq!(codes(&found), [""; 0]);
        let worst = worst_energy(&found);
        assert!(worst < 1e-8, "{worst}");
    }
}

/// What a belt carries by friction slides on when the belt stops at once, though nothing works on it in that instant.
#[test]
fn a_box_slides_on_a_belt_that_stops() {
    for until in ["1.5 s", "2 s", "4 s"] {
        let found = result(&format!(
            r#"
units = {{ length = "mm" }}
[links]
frame = {{ O = [0, 0], X = [4000, 0] }}
belt  = {{ A = [0, 0], Q = [4000, 0] }}
box   = {{ C = [0, 0], mass = "2 kg", inertia = "1 kg mm^2" }}
[joints]
rollers = {{ slider = "belt", at = "A", on = "O -> X" }}
contact = {{ slider = "box", at = "C", on = "A -> Q" }}
[friction]
contact = {{ coefficient = 0.3 }}
[drives]
feed = {{ slides = "rollers", from = 0, law = [{{ rise = 300, speed = "300 mm/s" }}, {{ dwell = "4 s" }}] }}
slip = {{ slides = "contact", at = 0 }}
[studies.go]
kind    = "simulate"
release = "slip"
until   = "{until}"
step    = "100 ms"
columns = ["slip", "rate(slip)"]
"#
        ));
        let slip = *column(&found, "slip").last().unwrap();
        let wanted = 300.0 * 300.0 / (2.0 * 0.3 * 9810.0);
        assert!((slip - wanted).abs() < 1e-5, "{slip} {wanted}");
        assert!(column(&found, "rate(slip)").last().unwrap().abs() < 1e-9);
        let rows = found.listings.iter().flat_map(|listing| &listing.rows);
        let mut rows = rows.map(|row| row.join(" "));
        assert!(rows.any(|row| row == "1 s feed jumps from 300 mm/s to 0 mm/s"));
    }
}

/// What was to end a simulation and did not is told, where it ended otherwise; what can end nothing is warned of.
#[test]
fn a_condition_that_never_came_to_hold_is_told() {
    let of = |end_when: &str| {
        result(&format!(
            "{BLOCK}[studies.a]\nkind = \"simulate\"\nstart = {{ d_rate = \"1 m/s\" }}\nuntil = \"0.1 s\"\nrows = 3\n\
             columns = [\"d\"]\nend_when = {end_when}\n"
        ))
    };
    let happened = |result: &StudyResult| {
        let listing = result.listings.iter().find(|l| l.title == "What happened");
        listing.map_or_else(Vec::new, |l| l.rows.iter().map(|r| r.join(" ")).collect())
    };
    let late = of("\"time >= 1 s\"");
    assert_eq!(codes(&late), [""; 0]);
    assert_eq!(
        happened(&late),
        ["0.1 s it ends: `time >= 1 s` never came to hold, and this is `until`"]
    );
    let two = of("[\"time >= 1 s\", \"d >= 1 m\"]");
    assert_eq!(
        happened(&two),
        ["0.1 s it ends: no condition of `end_when` came to hold, and this is `until`"]
    );
    let met = of("\"d >= 50 mm\"");
    assert_eq!(happened(&met), ["0.05 s it ends: d >= 50 mm"]);
    let held = of("\"d <= 1 m\"");
    assert_eq!(
        happened(&held),
        [
            "0.1 s it ends: `d <= 1 m` held from the start, and counts from where it does not, and this is `until`"
        ]
    );
    let both = of("[\"d <= 1 m\", \"time >= 1 s\"]");
    assert_eq!(
        happened(&both),
        [
            "0.1 s it ends: `d <= 1 m` held from the start, and counts from where it does not; `time >= 1 s` never came to hold, and this is `until`"
        ]
    );
    let never = of("\"1 mm >= 2 mm\"");
    assert_eq!(codes(&never), ["condition-idle"]);
    assert!(never.diagnostics[0].message.contains("`1 mm >= 2 mm`"));
}

/// What happens has its times, and its place where it has one.
#[test]
fn what_happened_is_marked_in_time() {
    let found = result(
        r#"
units = { length = "m", angle = "deg" }
gravity = [0, "-9.81 m/s^2"]
[links]
frame = { O = [0, 0] }
rod   = { O-P = 1, mass = 1, inertia = "0.1 kg m^2" }
[drives]
p = { turns = "rod", at = 0 }
[studies.a]
kind    = "simulate"
stops   = { p = { between = [-60, "none"], restitution = 0.4 } }
until   = "4 s"
rows    = 41
columns = ["p"]
"#,
    );
    let of = |kind: HappeningKind| {
        let all = found.happenings.iter().filter(move |it| it.kind == kind);
        all.collect::<Vec<_>>()
    };
    let [impacts] = of(HappeningKind::Impact)[..] else {
        panic!("{:?}", found.happenings);
    };
    let [rest] = of(HappeningKind::Contact)[..] else {
        panic!("{:?}", found.happenings);
    };
    assert_eq!(impacts.label, "strikes the lower stop of p");
    assert_eq!(impacts.point, Some(0));
    assert!(impacts.times.len() > 2);
    assert!(impacts.times.is_sorted_by(|a, b| a[0] < b[0]));
    assert_eq!(rest.label, "lies on the lower stop of p");
    assert_eq!(rest.times.len(), 1);
    assert!(rest.times[0][0] >= impacts.times.last().unwrap()[0] && rest.times[0][1] == 4.0);
}

/// A slider-crank of a tenth of a micrometre, told by its slider and, near the dead points of that, by its links: tables look along all of its motion, as of one of
/// metres.
#[test]
fn what_is_tiny_is_followed_past_dead_points() {
    let text = r#"
units = { length = "um", angle = "rad" }
gravity = 0
[links]
frame = { A = [0, 0], E = [0, 0], F = [1, 0] }
crank = { A-B = 0.1, mass = "1 g", inertia = "1e-17 kg m^2", center = [0.05, 0] }
rod   = { B-C = 0.3, mass = "1 g", inertia = "1e-17 kg m^2", center = [0.15, 0] }
block = { C = [0, 0], mass = "1 g" }
[joints]
guide = { slider = "block", at = "C", on = "E -> F" }
[drives]
d = { slides = "block", at = 0.33 }
[assembly]
B = "left of A -> C"
[studies.turn]
kind    = "simulate"
until   = "20 ms"
rows    = 201
start   = { d_rate = "0.1 mm/s" }
columns = ["d", "angle(crank)", "kinetic_energy"]
"#;
    let read = Model::from_toml(text, "tiny", &mut |_| Err("no files".into()));
    let model = read.unwrap().model;
    let found = run(&model, &model.studies[0], &mut Silent).unwrap();
    assert_eq!(found.table.unreached(), 0, "{:?}", found.diagnostics);
    let values = |name: &str| &found.table.column(name).unwrap().values;
    let energy = values("kinetic_energy");
    let off = energy.iter().map(|e| (e / energy[0] - 1.0).abs());
    assert!(off.fold(0.0, f64::max) < 1e-9);
    // It turns on and on.
    let angle = values("angle(crank)");
    assert!((angle[200] - angle[0]).abs() > 10.0, "{}", angle[200]);
}

/// The way swept by what turns back at impacts and between them: all of it, in the order in which it is gone.
#[test]
fn a_ball_sweeps_its_ways_down_and_up() {
    let g = 9.81_f64;
    // With less it would come to rest.
    for e in [0.4, 0.5, 0.6, 0.7, 0.9] {
        let text = format!(
            "units = {{ length = \"m\" }}\ngravity = [0, \"-9.81 m/s^2\"]\n[links]\nframe = {{ A = [0, 0], B = [0, 2] }}\n\
             ball = {{ P = [0, 0], mass = \"1 kg\", inertia = \"1e-3 kg m^2\" }}\n[joints]\n\
             guide = {{ slider = \"ball\", at = \"P\", on = \"A -> B\" }}\n[drives]\nfall = {{ slides = \"ball\", at = 1 }}\n\
             [studies.s]\nkind = \"simulate\"\nuntil = \"0.8 s\"\nrows = 81\n\
             stops = {{ fall = {{ between = [0, \"none\"], restitution = {e} }} }}\ncolumns = [\"path_length(P)\"]\n"
        );
        let result = result(&text);
        let (times, swept) = (&result.table.columns[0], column(&result, "path_length(P)"));
        // Free flights, one after the other: down and up again.
        let (mut start, mut speed, mut before) = (0.0, 0.0, 0.0);
        let mut end = (2.0 / g).sqrt();
        for (t, swept) in times.values.iter().zip(swept) {
            while *t > end {
                before += flown(speed, end - start, g);
                speed = e * (g * (end - start) - speed);
                (start, end) = (end, end + 2.0 * speed / g);
            }
            let wanted = before + flown(speed, t - start, g);
            assert!((swept - wanted).abs() < 1e-9, "{e}, {t}: {swept}, {wanted}");
        }
    }
}

/// The way of what is thrown up, in a time.
fn flown(speed: f64, time: f64, g: f64) -> f64 {
    let top = (speed / g).min(time);
    let fallen = time - top;
    speed * top - 0.5 * g * top * top + 0.5 * g * fallen * fallen
}
