//! Vibrations about a motion: what turns with the drives that are held has centrifugal and gyroscopic terms, against closed forms, and against what a
//! simulation swings with.
#![allow(
    clippy::disallowed_methods,
    reason = "numbers found by hand beside ours, not reproducible ones"
)]

use std::f64::consts::TAU;

use kempe_model::{Diagnostic, Model};
use kempe_study::{Silent, StudyResult, run};

fn found(text: &str, study: usize) -> StudyResult {
    let read = Model::from_toml(text, "test", &mut |_| Err("no files".into()));
    let model = read.expect("a model").model;
    match run(&model, &model.studies[study], &mut Silent) {
        Ok(result) => result,
        Err(told) => panic!("{told:?}"),
    }
}

fn column<'r>(result: &'r StudyResult, name: &str) -> &'r [f64] {
    let found = result.table.column(name);
    &found.unwrap_or_else(|| panic!("no {name}")).values
}

fn close(found: f64, exact: f64, part: f64) {
    assert!(
        (found - exact).abs() <= part * exact.abs(),
        "{found}, not {exact}"
    );
}

fn codes(found: &[Diagnostic]) -> Vec<&'static str> {
    found.iter().map(|d| d.code).collect()
}

/// A point mass that hangs by a rod on the rim of a disc.
fn flail(more: &str, study: &str) -> String {
    format!(
        "units = {{ length = \"mm\", angle = \"deg\" }}\ngravity = [0, 0]\n[links]\nframe = {{ O = [0, 0] }}\ndisc = {{ O-B = 100 }}\n\
         flail = {{ B-P = 250, mass = \"2 kg\", inertia = \"0 kg m^2\", center = \"P\" }}\n\
         [drives]\nmotor = {{ turns = \"disc\", from = 0, to = 3600, {more} }}\n\
         swing = {{ turns = \"flail\", relative_to = \"disc\", at = 20 }}\n\
         [studies.modes]\nkind = \"vibrations\"\nrelease = [\"swing\"]\nrows = 5\n{study}\n"
    )
}

/// Thrown outwards it swings about the spoke, with the speed of the disc times the root of R / l.
#[test]
fn a_flail_is_stretched_by_what_turns_it() {
    let result = found(&flail("speed = \"10 rad/s\"", "moving = true"), 0);
    assert_eq!(codes(&result.diagnostics), Vec::<&str>::new());
    let speed = 10.0;
    for row in 0..5 {
        close(
            column(&result, "frequency_1")[row],
            speed * (100.0_f64 / 250.0).sqrt() / TAU,
            1e-9,
        );
        assert!(column(&result, "swing")[row].abs() < 1e-7);
        assert!(column(&result, "growth_1")[row].abs() < 1e-9);
    }
    // Held still, nothing brings it back.
    let result = found(&flail("speed = \"10 rad/s\"", ""), 0);
    assert_eq!(column(&result, "frequency_1"), [0.0; 5]);
}

/// Where the disc speeds up, the spoke about which it swings lags: `tan` of the whole direction by the two parts of what the rim accelerates with.
#[test]
fn what_speeds_up_lags() {
    let result = found(&flail("acceleration = \"8 rad/s^2\"", "moving = true"), 0);
    let bend = 8.0;
    let times = column(&result, "time");
    for (row, time) in times.iter().enumerate().skip(1) {
        let speed = bend * time;
        // About B: R (w^2 sin q + a cos q) + l a = 0.
        let swing = column(&result, "swing")[row].to_radians();
        let left = 0.1 * (speed * speed * swing.sin() + bend * swing.cos()) + 0.25 * bend;
        assert!(left.abs() < 1e-7 * speed * speed, "{time}: {left}");
        let back = 0.1 * (speed * speed * swing.cos() - bend * swing.sin()) / 0.25;
        close(column(&result, "frequency_1")[row], back.sqrt() / TAU, 1e-7);
    }
}

/// A mass on two springs at right angles that turn with a disc: its frequencies part by the speed, `|w0 +- W|`, and from `W = w0` on nothing but
/// gyroscopic terms holds it.
#[test]
fn a_mass_on_springs_that_turn_swings_faster_and_slower() {
    let table = |speed: f64| {
        format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\ngravity = [0, 0]\n[links]\nframe = {{ O = [0, 0] }}\n\
             disc = {{ O = [0, 0], X = [100, 0], Z = [-100, 0], inertia = \"1 kg m^2\" }}\n\
             carriage = {{ C = [0, 0], Y = [0, 100], W = [0, -100] }}\nblock = {{ P = [0, 0], mass = \"0.5 kg\", inertia = \"0 kg m^2\", center = \"P\" }}\n\
             [joints]\nfirst = {{ slider = \"carriage\", at = \"C\", on = \"O -> X\" }}\nsecond = {{ slider = \"block\", at = \"P\", on = \"C -> Y\" }}\n\
             [springs]\nalong = {{ between = \"Z-C\", stiffness = \"200 N/m\", free = \"100 mm\" }}\nacross = {{ between = \"W-P\", stiffness = \"200 N/m\", free = \"100 mm\" }}\n\
             [drives]\nmotor = {{ turns = \"disc\", from = 0, to = 3600, speed = \"{speed} rad/s\" }}\n\
             u = {{ slides = \"carriage\", at = 0 }}\nv = {{ slides = \"block\", at = 0 }}\n\
             [studies.modes]\nkind = \"vibrations\"\nrelease = [\"u\", \"v\"]\nrows = 4\nmoving = true\n"
        )
    };
    for speed in [7.0, 33.0] {
        let result = found(&table(speed), 0);
        let own = 20.0_f64;
        for row in 0..4 {
            close(
                column(&result, "frequency_1")[row],
                (own - speed).abs() / TAU,
                1e-9,
            );
            close(
                column(&result, "frequency_2")[row],
                (own + speed) / TAU,
                1e-9,
            );
            assert!(column(&result, "growth_1")[row].abs() < 1e-7);
        }
        assert!(!codes(&result.diagnostics).contains(&"unstable-pose"));
    }
}

/// A rod that a crank swings to and fro in gravity, let go near its place: what a simulation does in one short time is what the mode about that moment
/// says, a damper and gravity included.
#[test]
fn a_simulation_swings_as_the_mode_says() {
    let text = flail("speed = \"40 rad/s\"", "moving = true").replace("gravity = [0, 0]\n", "gravity = [0, 0]\n[dampers]\noil = { links = [\"disc\", \"flail\"], damping = \"0.3 N m s\" }\n")
        + "[studies.swings]\nkind = \"simulate\"\nrelease = [\"swing\"]\nstart = { swing = \"0.01 deg\" }\nuntil = \"1 s\"\nrows = 2001\ncolumns = [\"swing\"]\n";
    let modes = found(&text, 0);
    let swings = found(&text, 1);
    let (times, values) = (column(&swings, "time"), column(&swings, "swing"));
    let crossings: Vec<f64> = (1..times.len())
        .filter(|k| values[k - 1] > 0.0 && values[*k] <= 0.0)
        .map(|k| {
            times[k - 1] + (times[k] - times[k - 1]) * values[k - 1] / (values[k - 1] - values[k])
        })
        .collect();
    let periods = crossings.len() - 1;
    let period = (crossings[periods] - crossings[0]) / periods as f64;
    close(column(&modes, "frequency_1")[0], 1.0 / period, 1e-5);
    let growth = column(&modes, "growth_1")[0];
    assert!(growth < -0.1, "{growth}");
    // c / (2 m l^2) of a hinge that turns with the disc.
    close(growth, -0.3 / (2.0 * 2.0 * 0.0625), 1e-9);
}

#[test]
fn about_one_pose_nothing_moves() {
    let text = flail("speed = \"10 rad/s\"", "moving = true").replace("rows = 5\n", "");
    let read = Model::from_toml(&text, "test", &mut |_| Err("no files".into()));
    assert_eq!(codes(&read.expect("a model").warnings), ["idle-key"]);
}
