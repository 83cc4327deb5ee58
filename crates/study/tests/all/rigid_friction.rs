//! Rigid contacts that rub, as a user runs them: energy, reactions, and the slider of P. Flores, R. Leine and C. Glocker.
#![allow(clippy::unwrap_used)]

use crate::told::column;
use kempe_model::Model;
use kempe_number::Random;
use kempe_number::math::hypot;
use kempe_study::{Silent, StudyResult, run};

const SLIDER: &str = include_str!("../../../../examples/benchmarks/clearance-slider.toml");

fn result(text: &str) -> StudyResult {
    let read = Model::from_toml(text, "rigid", &mut |_| Err("no files".into()));
    let model = read.unwrap().model;
    run(&model, &model.studies[0], &mut Silent).unwrap()
}

fn worst(column: &[f64]) -> f64 {
    let known = column.iter().filter(|x| x.is_finite());
    known.fold(0.0, |most, x| most.max(x.abs()))
}

/// That energy and power balance, and that whatever joints and contacts do has gone one way.
fn is_sound(result: &StudyResult, what: &str) {
    assert!(!result.interrupted(), "{what}");
    let balance = result.table.balance.as_ref().unwrap();
    let (energy, power) = (worst(&balance.energy), worst(&balance.power));
    assert!(energy < 1e-8, "{what}: energy {energy:e}");
    assert!(power < 1e-4, "{what}: power {power:e}");
    let kinetic = column(result, "kinetic_energy");
    let potential = column(result, "potential_energy");
    let whole: Vec<f64> = kinetic.iter().zip(&potential).map(|(a, b)| a + b).collect();
    for (row, pair) in whole.windows(2).enumerate() {
        let grown = pair[1] - pair[0];
        assert!(
            grown < 1e-9 * whole[0].abs(),
            "{what}: row {row} gains {grown:e}"
        );
    }
    assert!(whole.last() < whole.first(), "{what}");
}

/// Slider-cranks thrown somehow, and blocks of all shapes: what rubs takes energy, and no more than balances.
#[test]
fn whatever_is_thrown_only_loses_energy() {
    let mut rng = Random(5);
    let mut between = |low: f64, high: f64| low + (high - low) * rng.uniform();
    for case in 0..8 {
        let restitution = if case % 4 == 0 {
            0.0
        } else {
            between(0.0, 0.8)
        };
        let text = SLIDER
            .replace("restitution = 0.4", &format!("restitution = {restitution}"))
            .replace("mu     = 0 ", &format!("mu     = {} ", between(0.01, 0.9)))
            .replace(
                "\"0 rad/s\" ",
                &format!("\"{} rad/s\" ", between(-30.0, 30.0)),
            )
            .replace("\"0.1 s\"", "\"0.03 s\"")
            .replace(
                "\"reaction(guide)\"]",
                "\"reaction(guide)\", \"kinetic_energy\", \"potential_energy\"]",
            );
        is_sound(&result(&text), &format!("slider-crank {case}"));
    }
    for case in 0..8 {
        let (length, height) = (between(20.0, 120.0), between(10.0, 120.0));
        let text = format!(
            "units = {{ length = \"mm\" }}\n[links]\nframe = {{ O = [0, 0], X = [1000, 0] }}\n\
             block = {{ C = [0, 0], mass = 1, inertia = \"{} kg mm^2\", center = [{}, {}] }}\n[joints]\n\
             way = {{ slider = \"block\", at = \"C\", on = \"O -> X\" }}\n[drives]\ntravel = {{ slides = \"way\", at = 100 }}\n\
             [clearance]\nway = {{ radial = {}, length = {length}, height = {height}, restitution = {}, friction = {} }}\n\
             [studies.s]\nkind = \"clearance\"\nmodel = \"three-state\"\nrelease = \"travel\"\nuntil = \"0.1 s\"\nrows = 51\n\
             start = {{ travel_rate = \"{} m/s\", way_rate = [\"{} m/s\", \"{} rad/s\"] }}\n\
             columns = [\"kinetic_energy\", \"potential_energy\"]\n",
            between(100.0, 2000.0),
            between(-5.0, 5.0),
            between(-5.0, 5.0),
            between(0.1, 3.0),
            between(0.0, 0.9),
            between(0.05, 0.6),
            between(-2.0, 2.0),
            between(-0.5, 0.5),
            between(-5.0, 5.0),
        );
        is_sound(&result(&text), &format!("block {case}"));
    }
}

/// Two pins with play in a four-bar whose crank keeps its law: what rubs is carried to the crank.
#[test]
fn pins_rub_in_their_bores() {
    let text = |friction: f64| {
        format!(
            r#"
units = {{ length = "mm" }}
[links]
frame   = {{ A = [0, 0], D = [60, 0] }}
crank   = {{ A-B = 20, mass = 1, inertia = "100 kg mm^2" }}
coupler = {{ B-C = 50, mass = 1, inertia = "100 kg mm^2" }}
rocker  = {{ D-C = 40, mass = 1, inertia = "100 kg mm^2" }}
[clearance]
all = {{ radial = 0, law = "rigid", radius = "5 mm", restitution = 0.3, friction = {friction} }}
B = {{ radial = "50 um" }}
C = {{ radial = "50 um" }}
[drives]
motor = {{ turns = "crank", from = 0, to = 180, speed = "300 rpm" }}
[assembly]
C = {{ near = [50, 40] }}
[studies.rattle]
kind    = "clearance"
model   = "three-state"
until   = "40 ms"
rows    = 41
columns = ["reaction_x(B)", "reaction_y(B)", "reaction_x(C)", "reaction_y(C)"]
"#
        )
    };
    let found = result(&text(0.2));
    let balance = found.table.balance.as_ref().unwrap();
    assert!(
        worst(&balance.energy) < 1e-8,
        "{:e}",
        worst(&balance.energy)
    );
    assert!(worst(&balance.power) < 1e-6, "{:e}", worst(&balance.power));
    // The force lies in the cone about the line of both centres, on its edge where the pin slides; without friction along that line.
    let smooth = result(&text(0.0));
    for (found, friction) in [(&found, 0.2), (&smooth, 0.0)] {
        let mut on_edge = 0;
        for pin in ["B", "C"] {
            let [play_x, play_y] =
                ["x", "y"].map(|axis| column(found, &format!("{pin} play {axis}")));
            let [x, y] = ["x", "y"].map(|axis| column(found, &format!("reaction_{axis}({pin})")));
            let largest = worst(&x).max(worst(&y));
            for row in 0..x.len() {
                let (size, play) = (hypot(x[row], y[row]), hypot(play_x[row], play_y[row]));
                if size < 0.1 {
                    continue;
                }
                assert!((play / 0.05 - 1.0).abs() < 1e-9, "{pin}, {row}: {play} mm");
                let along = (x[row] * play_x[row] + y[row] * play_y[row]) / play;
                let across = (x[row] * play_y[row] - y[row] * play_x[row]) / play;
                // In parts of the largest force: rounding is of its size.
                let off = (across.abs() - friction * along.abs()) / largest;
                assert!(off < 1e-9, "{pin}, {row}: {off:e}");
                on_edge += usize::from(off > -1e-9);
            }
        }
        assert!(on_edge > 20, "{friction}: {on_edge}");
    }
}

/// What is borne in a guide is pressed and rubs: the size of its force counts both.
#[test]
fn reactions_count_friction() {
    let text = "units = { length = \"mm\" }\n[links]\nframe = { O = [0, 0], X = [1000, 0] }\n\
         block = { C = [0, 0], mass = 1, inertia = \"500 kg mm^2\" }\n[joints]\n\
         way = { slider = \"block\", at = \"C\", on = \"O -> X\" }\n[drives]\ntravel = { slides = \"way\", at = 100 }\n\
         [clearance]\nway = { radial = 0.1, length = 40, height = 20, friction = 0.3 }\n\
         [studies.s]\nkind = \"clearance\"\nmodel = \"three-state\"\nrelease = \"travel\"\nuntil = \"0.2 s\"\nrows = 5\n\
         start = { travel_rate = \"0.4 m/s\", way = [\"-0.1 mm\", 0] }\n\
         columns = [\"reaction_x(way, block)\", \"reaction_y(way, block)\", \"reaction(way)\"]\n";
    let found = result(text);
    // It slides for 0.4 / (0.3 g) = 136 ms.
    for (row, rubs) in [0.3, 0.3, 0.3, 0.0, 0.0].into_iter().enumerate() {
        let weight = 9.81_f64;
        let wanted = [-rubs * weight, weight, weight * (1.0 + rubs * rubs).sqrt()];
        let names = [
            "reaction_x(way, block)",
            "reaction_y(way, block)",
            "reaction(way)",
        ];
        for (name, wanted) in names.into_iter().zip(wanted) {
            let is = column(&found, name)[row];
            assert!((is - wanted).abs() < 1e-10, "{name}, {row}: {is} {wanted}");
        }
    }
    assert_eq!(column(&found, "way touching"), [2.0; 5]);
}

/// Their slider with a coefficient of 0.01, by a time-stepping program of its own (J. J. Moreau's midpoint rule, 1 us), whose error
/// falls with its step: four times as large at 4 us.
#[test]
fn the_slider_moves_as_by_time_stepping() {
    let text = SLIDER
        .replace("mu     = 0 ", "mu     = 0.01 ")
        .replace("t_end  = \"0.1 s\"", "t_end  = \"0.2 s\"")
        .replace("step    = \"0.2 ms\"", "step    = \"10 ms\"");
    let found = result(&text);
    let columns = ["motor", "angle(rod)", "rate(motor)", "rate(angle(rod))"];
    let turn = std::f64::consts::TAU;
    for (row, [turns, rod, motor, rate], by) in [
        (
            1,
            [0.15087269957, -0.4146241510, 67.4731901227, -21.4994264833],
            3e-4,
        ),
        (
            5,
            [0.76291988834, 0.5254720319, 68.4722907183, -3.2071989551],
            1e-3,
        ),
        (
            10,
            [1.43251197167, -0.2105429333, 135.8800777820, 63.3189982098],
            3e-4,
        ),
        (
            20,
            [2.87814952132, 0.3524152910, 70.9101561286, -28.7089695229],
            5e-4,
        ),
    ] {
        let known = [turns * turn, rod, motor, rate];
        for (name, known) in columns.into_iter().zip(known) {
            let is = column(&found, name)[row];
            assert!((is / known - 1.0).abs() < by, "{name}, {row}: {is} {known}");
        }
    }
}

#[test]
fn speeds_at_which_friction_sets_in_are_refused() {
    let text = SLIDER.replace(
        "friction = \"mu\"",
        "friction = 0.1, friction_speeds = [\"1 mm/s\", \"2 mm/s\"]",
    );
    let model = Model::from_toml(&text, "rigid", &mut |_| Err("no files".into()))
        .unwrap()
        .model;
    let refused = run(&model, &model.studies[0], &mut Silent).unwrap_err();
    assert_eq!(refused[0].code, "no-contact-law");
}

/// A block of which each impact lifts the other corner comes to rest all the same, after ever shorter times; beside a stop that takes part in it.
#[test]
fn what_rocks_comes_to_rest() {
    let text = "units = { length = \"mm\" }\n[links]\nframe = { O = [0, 0], X = [1000, 0] }\n\
         block = { C = [0, 0], mass = 1, inertia = \"MOMENT kg mm^2\" }\n[joints]\n\
         way = { slider = \"block\", at = \"C\", on = \"O -> X\" }\n[drives]\ntravel = { slides = \"way\", at = 100 }\n\
         [clearance]\nway = { radial = 1, length = 70, height = 60, restitution = 0, friction = 0.4 }\n\
         [studies.s]\nkind = \"clearance\"\nmodel = \"three-state\"\nrelease = \"travel\"\nuntil = \"0.3 s\"\nrows = 31\n\
         start = { travel_rate = \"1 m/s\", way_rate = [\"-0.5 m/s\", \"4 rad/s\"] }\n\
         stops = { travel = { between = [\"none\", \"110 mm\"], restitution = 0.5 } }\n\
         columns = [\"kinetic_energy\", \"potential_energy\"]\n";
    for moment in ["300", "1500", "2900"] {
        let found = result(&text.replace("MOMENT", moment));
        is_sound(&found, moment);
        assert!(*column(&found, "kinetic_energy").last().unwrap() < 1e-20);
        assert_eq!(*column(&found, "way touching").last().unwrap(), 2.0);
    }
}
