//! Derivatives of forces to parameters against differences of whole new designs.
#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::sync::Arc;

use kempe_dynamics::{ForceSampler, sensitivities};
use kempe_measure::Held;
use kempe_measure::measure::visit_leaves;
use kempe_mechanism::{Design, Mechanism};
use kempe_model::{DriveId, ForceMeasure, JointRef, Leaf, Measure, Model, ParameterId, PointId};
use kempe_motion::Motion;
use kempe_units::Expr;

/// Differences of eighth order keep about so many parts of the largest derivative asked for.
const TOLERANCE: f64 = 1e-6;

fn ask(measure: ForceMeasure) -> Measure {
    Expr::Leaf(Leaf::Force(measure))
}

fn read(text: &str) -> Model {
    let read = Model::from_toml(text, "test", &mut |_| Err("no files".into()));
    read.unwrap_or_else(|found| panic!("{found:#?}")).model
}

/// A model with the motion of its own design.
fn moved(text: &str) -> (Model, Arc<Motion>) {
    let model = read(text);
    let mechanism = Mechanism::new(&model);
    let motion = Motion::new(&Design::new(&mechanism, &model.parameter_values())).unwrap();
    (model, motion)
}

/// Parameter values with one of them changed; those built on it follow.
fn changed(model: &Model, which: usize, by: f64) -> Vec<f64> {
    let mut values: Vec<f64> = Vec::new();
    for (index, parameter) in model.parameters.iter().enumerate() {
        let value = kempe_model::value(&parameter.value, &values);
        values.push(if index == which { value + by } else { value });
    }
    values
}

fn values(
    mechanism: &Arc<Mechanism>,
    parameters: &[f64],
    measures: &[&Measure],
    time: f64,
) -> Option<Vec<f64>> {
    let motion = Motion::new(&Design::new(mechanism, parameters)).ok()?;
    let mut sampler = ForceSampler::new(&motion, measures).ok()?;
    Some(sampler.at_time(time).sample.values)
}

/// Largest difference, in parts of the largest derivative, over the measures of a model of which both ways know all.
fn compare(model: &Model, part: f64, over_motion: bool) -> Option<(usize, f64)> {
    let mechanism = Mechanism::new(model);
    let plain: Vec<f64> = model.parameter_values();
    let motion = Motion::new(&Design::new(&mechanism, &plain)).ok()?;
    // Numbers over the motion take long; one example stands for them.
    let goes_over = |measure: &Measure| {
        let mut found = false;
        visit_leaves(&mechanism, measure, &mut |leaf| {
            found |= matches!(leaf, Leaf::Over(..))
        });
        found
    };
    let mut measures: Vec<Measure> = (model.measures.iter())
        .map(|m| m.measure.clone())
        .filter(|m| over_motion || !goes_over(m))
        .collect();
    for drive in 0..model.drives.len() as u32 {
        measures.push(ask(ForceMeasure::Drive(DriveId(drive))));
        measures.push(ask(ForceMeasure::Power(DriveId(drive))));
    }
    for (point, at) in model.points.iter().enumerate() {
        if at.links.len() > 1 {
            let joint = JointRef::Pin(PointId(point as u32), None);
            measures.push(ask(ForceMeasure::Reaction(joint)));
            measures.push(ask(ForceMeasure::ReactionX(joint)));
        }
    }
    measures.push(ask(ForceMeasure::ShakingForceX));
    let measures: Vec<&Measure> = measures.iter().collect();
    let duration = ForceSampler::new(&motion, &measures).ok()?.duration();
    let time = part * duration;
    let ids: Vec<ParameterId> = (0..plain.len() as u32).map(ParameterId).collect();
    let found = sensitivities(&motion, Held::Time(time), &measures, &ids).unwrap();
    let largest = found
        .values
        .iter()
        .filter(|v| v.is_finite())
        .fold(0.0_f64, |a, v| a.max(v.abs()));
    let (mut compared, mut worst) = (0, 0.0_f64);
    for (which, value) in plain.iter().enumerate() {
        let h = 2e-5 * if *value == 0.0 { 1e-2 } else { value.abs() };
        let at = |k: f64| values(&mechanism, &changed(model, which, k * h), &measures, time);
        let Some(sides) = [1.0, 2.0, 3.0, 4.0, -1.0, -2.0, -3.0, -4.0]
            .map(at)
            .into_iter()
            .collect::<Option<Vec<_>>>()
        else {
            continue;
        };
        for (index, row) in found.derivatives.iter().enumerate() {
            let weights = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
            let sum: f64 = (0..4)
                .map(|k| weights[k] * (sides[k][index] - sides[k + 4][index]))
                .sum();
            let expected = sum / h;
            // What is left of differences of forces that cancel is counted in the largest.
            let own = found.values[index].abs().max(1e-3 * largest);
            let scale = expected.abs().max(own / value.abs().max(1e-3));
            if expected.is_finite() && found.values[index].is_finite() && scale > 1e-9 {
                assert!(
                    row[which].is_finite(),
                    "{index} to {}",
                    model.parameters[which].name
                );
                let off = (row[which] - expected).abs() / scale;
                compared += 1;
                worst = worst.max(off);
                assert!(
                    off < TOLERANCE,
                    "measure {index} to {}: {} is not {expected}",
                    model.parameters[which].name,
                    row[which]
                );
            }
        }
    }
    Some((compared, worst))
}

#[test]
fn derivatives_of_forces_are_those_of_new_designs() {
    let mut all = 0;
    for folder in ["seeds", "gallery"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../../examples")
            .join(folder);
        let mut files: Vec<_> = std::fs::read_dir(&folder)
            .unwrap()
            .map(|e| e.unwrap().path())
            .collect();
        files.sort();
        for file in files
            .iter()
            .filter(|f| f.extension().is_some_and(|e| e == "toml"))
        {
            let text = std::fs::read_to_string(file).unwrap();
            let name = file.file_stem().unwrap().to_string_lossy().into_owned();
            let mut tables = |table: &str| {
                std::fs::read_to_string(folder.join(table)).map_err(|e| e.to_string())
            };
            let model = Model::from_toml(&text, &name, &mut tables).unwrap().model;
            let acts =
                !model.actions.loads.is_empty() || model.links.iter().any(|l| l.inertia.is_some());
            if model.parameters.is_empty() || !acts {
                continue;
            }
            if let Some((compared, worst)) = compare(&model, 0.3719, name == "luffing-crane") {
                println!("{name}: {compared} compared, {worst:e}");
                all += compared;
            }
        }
    }
    assert!(all > 300, "only {all} derivatives were compared");
}

/// Where a joint turns back its friction changes its side: means over that, and extremes beside it, move with the time at which it does.
#[test]
fn derivatives_over_the_jumps_of_friction_are_those_of_new_designs() {
    // The rocker turns back at 34.77 deg: within the motion, or right beside one of its ends.
    let ways = [
        [0.0, 360.0],
        [34.7, 394.7],
        [-300.0, 34.85],
        [34.85, -200.0],
    ];
    for [from, to] in ways {
        derivatives_over_jumps(from, to);
    }
}

fn derivatives_over_jumps(from: f64, to: f64) {
    let text = "units = { length = \"mm\", angle = \"deg\" }\ngravity = 0\n[parameters]\na = \"20 mm\"\nb = \"50 mm\"\nmu = 0.3\n\
        [links]\nframe = { A = [0, 0], D = [60, 0] }\ncrank = { A-B = \"a\" }\ncoupler = { B-C = \"b\" }\nrocker = { D-C = 40 }\n\
        [drives]\nmotor = { turns = \"crank\", speed = \"60 rpm\" }\n[assembly]\nC = \"left of B -> D\"\n\
        [loads]\ntool = { torque = \"-10 N m\", on = \"rocker\" }\n[friction]\nD = { coefficient = \"mu\", radius = \"15 mm\" }\n\
        C = { coefficient = 0.1, radius = \"5 mm\" }\n\
        [measures]\nm1 = \"mean(reaction(C))\"\nm2 = \"mean(torque(motor))\"\nm3 = \"mean(abs(torque(motor)))\"\nm4 = \"max(reaction(D))\"\n";
    let text = text.replace("speed =", &format!("from = {from}, to = {to}, speed ="));
    let model = Model::from_toml(&text, "four-bar", &mut |_| Err(String::new()))
        .unwrap()
        .model;
    let mechanism = Mechanism::new(&model);
    let plain: Vec<f64> = model.parameter_values();
    let motion = Motion::new(&Design::new(&mechanism, &plain)).unwrap();
    let measures: Vec<&Measure> = model.measures.iter().map(|m| &m.measure).collect();
    let ids: Vec<ParameterId> = (0..plain.len() as u32).map(ParameterId).collect();
    let found = sensitivities(&motion, Held::Time(0.3), &measures, &ids).unwrap();
    for which in 0..plain.len() {
        let h = 1e-4 * plain[which];
        let at =
            |k: f64| values(&mechanism, &changed(&model, which, k * h), &measures, 0.3).unwrap();
        let [a, b, c, d] = [1.0, -1.0, 2.0, -2.0].map(at);
        for (index, row) in found.derivatives.iter().enumerate() {
            let expected = (8.0 * (a[index] - b[index]) - (c[index] - d[index])) / (12.0 * h);
            let scale = expected.abs().max(found.values[index].abs() / plain[which]);
            assert!(
                (row[which] - expected).abs() < 1e-5 * scale,
                "from {from} to {to}: measure {index} to {}: {} is not {expected}",
                model.parameters[which].name,
                row[which]
            );
        }
    }
}

/// A slider-crank whose guide rubs, and turns back right where the motion begins and ends: at the dead centres of an offset of nothing.
fn slider_crank_at_its_dead_centre(law: &str) -> (Model, Arc<Motion>) {
    moved(&format!(
        "units = {{ length = 'mm', angle = 'deg' }}\n[parameters]\ne = '0 mm'\nr = '30 mm'\nstart = '0 deg'\n[links]\n\
         frame = {{ A = [0, 0], G = [0, 'e'], H = [200, 'e'] }}\ncrank = {{ A-B = 'r' }}\nrod = {{ B-C = 100 }}\n\
         [joints]\nslide = {{ pin = 'C', on = 'G -> H' }}\n[assembly]\nC = {{ near = [130, 0] }}\n\
         [drives]\nmotor = {{ turns = 'crank', {law} }}\n[loads]\nf = {{ force = ['-100 N', '-40 N'], at = 'C' }}\n\
         [friction]\nslide = {{ coefficient = 0.2 }}\nA = {{ coefficient = 0.1, radius = '5 mm' }}\n\
         [measures]\npower = 'mean(power(motor))'\nload = 'mean(reaction(A))'\n"
    ))
}

/// With a parameter the turn moves out of the motion at its one end and into it at the other: the mean of what jumps there changes by that, too.
#[test]
fn means_change_by_turns_at_the_ends_of_a_motion() {
    let closed = "from = 'start', to = 'start + 360 deg', speed = '60 rpm'";
    let half = "from = 'start', to = 'start + 180 deg', speed = '60 rpm'";
    let slower = "law = [{ rise = 180, speed = '360 deg/s' }, { rise = 180, speed = '180 deg/s' }]";
    let sliver = "law = [{ rise = 180, speed = '360 deg/s' }, { rise = 1e-6, speed = '360 deg/s' }, { rise = 179.999999, speed = '360 deg/s' }]";
    for (law, two_sided) in [
        (closed, true),
        (half, false),
        (slower, false),
        (sliver, true),
    ] {
        let (model, motion) = slider_crank_at_its_dead_centre(law);
        let mechanism = motion.mechanism();
        let measures: Vec<&Measure> = model.measures.iter().map(|m| &m.measure).collect();
        let ids = [0, 1, 2].map(ParameterId);
        let found = sensitivities(&motion, Held::Time(0.1), &measures, &ids).unwrap();
        for (which, h) in [1e-4, 1e-4, 1e-2].into_iter().enumerate() {
            let at = |k: f64| values(mechanism, &changed(&model, which, k * h), &measures, 0.1);
            let [a, b, c, d, e] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| at(k).unwrap());
            for index in 0..2 {
                let [a, b, c, d, e] = [&a, &b, &c, &d, &e].map(|x| x[index]);
                let up = (4.0 * d - 3.0 * c - e) / (2.0 * h);
                let down = (a + 3.0 * c - 4.0 * b) / (2.0 * h);
                let scale = (c / [0.03, 0.03, 1.0][which]).abs();
                let near = |x: f64, y: f64| (x - y).abs() < 2e-5 * scale;
                let own = found.derivatives[index][which];
                let mut sides = found.one_sided.iter();
                let side = sides.find(|side| side.measure == index && side.parameter == which);
                let told = || format!("{law}: {index} to {which}: {own} {side:?}, {up} {down}");
                match side {
                    None => assert!(near(own, up) && near(own, down), "{}", told()),
                    Some(side) => {
                        assert!(own.is_nan() && side.over_motion && !two_sided, "{}", told());
                        assert!(near(side.slope, up) && near(side.other, down), "{}", told());
                        assert!(!near(up, down), "{}", told());
                    }
                }
            }
        }
        let one_sided = !found.one_sided.is_empty();
        assert_eq!(one_sided, !two_sided, "{law}: {:?}", found.one_sided);
    }
}

/// Derivatives of abs, min and max jump wherever these turn, friction or not; means close in on that.
#[test]
fn derivatives_of_means_of_kinked_forces_are_those_of_new_designs() {
    let heavy = "units = { length = \"mm\", angle = \"deg\" }\ngravity = [0, \"-9.81 m/s^2\"]\n[parameters]\noff = \"-4 mm\"\n\
        load = \"500 N\"\n[links]\nframe = { A = [0, 0], D = [60, \"off\"] }\ncrank = { A-B = 20, mass = 0.2, inertia = 1e-5 }\n\
        coupler = { B-C = 50, P = [25, \"10 deg\"], mass = 0.2, inertia = 1e-5 }\nrocker = { D-C = 40, mass = 0.2, inertia = 1e-5 }\n\
        [drives]\nmotor = { turns = \"crank\", from = 0, to = 360, speed = \"60 rpm\" }\n[assembly]\nC = \"left of B -> D\"\n\
        [loads]\nhook = { force = [0, \"-load\"], at = \"P\" }\n[measures]\nm1 = \"mean(abs(torque(motor)))\"\n";
    let rubbing = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\nb = \"50 mm\"\nmu = 0.1\n[links]\n\
        frame = { A = [0, 0], D = [60, 0] }\ncrank = { A-B = 20, mass = 0.2, inertia = 1e-5 }\n\
        coupler = { B-C = \"b\", P = [25, 10], mass = 0.5, inertia = 1e-5 }\nrocker = { D-C = 40, mass = 0.2, inertia = 1e-5 }\n\
        [drives]\nmotor = { turns = \"crank\", from = 0, to = 360, speed = \"300 rpm\" }\n[assembly]\nC = \"left of B -> D\"\n\
        [friction]\nall = { coefficient = \"mu\", radius = \"4 mm\" }\n\
        [measures]\nm1 = \"mean(min(reaction(B), 5 N))\"\nm2 = \"mean(abs(reaction(B) - 5 N))\"\nm3 = \"mean(abs(rate(torque(motor))))\"\n";
    for text in [heavy, rubbing] {
        let model = Model::from_toml(text, "four-bar", &mut |_| Err(String::new()))
            .unwrap()
            .model;
        let mechanism = Mechanism::new(&model);
        let plain: Vec<f64> = model.parameter_values();
        let motion = Motion::new(&Design::new(&mechanism, &plain)).unwrap();
        let measures: Vec<&Measure> = model.measures.iter().map(|m| &m.measure).collect();
        let ids: Vec<ParameterId> = (0..plain.len() as u32).map(ParameterId).collect();
        for which in 0..plain.len() {
            // Alone, and with the others.
            let found = sensitivities(&motion, Held::Time(0.1), &measures, &[ids[which]]).unwrap();
            let all = sensitivities(&motion, Held::Time(0.1), &measures, &ids).unwrap();
            let h = 3e-4 * plain[which];
            let at = |k: f64| {
                values(&mechanism, &changed(&model, which, k * h), &measures, 0.1).unwrap()
            };
            let [a, b, c, d] = [1.0, -1.0, 2.0, -2.0].map(at);
            for index in 0..measures.len() {
                let expected = (8.0 * (a[index] - b[index]) - (c[index] - d[index])) / (12.0 * h);
                let scale = expected.abs();
                for found in [found.derivatives[index][0], all.derivatives[index][which]] {
                    assert!(
                        (found - expected).abs() < 1e-6 * scale,
                        "measure {index} to {}: {found} is not {expected}",
                        model.parameters[which].name
                    );
                }
            }
        }
    }
}

/// A parameter that changes nothing but rounding does not change what is told of another: jumps of derivatives are closed in on beside it, too.
#[test]
fn a_derivative_does_not_hang_on_what_else_is_asked() {
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\nwa = \"25 deg\"\nb = \"83 mm\"\noff = \"5 mm\"\n\
        [places]\nA = [3, -4]\nB = [21, 17]\nC = [80, 52]\nD = [95, -10]\nP = [50, 60]\n[links]\nframe = [\"A\", \"D\"]\n\
        crank = { points = [\"A\", \"B\"], A-B = 31 }\ncoupler = { points = [\"B\", \"C\", \"P\"], B-C = \"b\", linear_density = \"0.6 kg/m\" }\n\
        rocker = { points = [\"D\", \"C\"], mass = \"0.3 kg\", inertia = \"1e-4 kg m^2\" }\n\
        gear = { D-Q = 18, mass = \"0.5 kg\", inertia = \"2e-4 kg m^2\" }\nbar = { R = [0, 0], V = [60, -30], mass = \"1.1 kg\", inertia = 0 }\n\
        [joints]\nwl = { weld = [\"rocker\", \"gear\"], angle = \"wa\" }\n\
        m = { rack = \"bar\", pinion = \"gear\", radius = 18, side = \"right\", offset = \"off\", pressure_angle = \"21 deg\", module = 1.1, center = \"D\" }\n\
        g = { slider = \"bar\", at = \"R\", on = \"D -> A\" }\n[friction]\nm = { coefficient = 0.09 }\n\
        A = { coefficient = 0.09, radius = \"4 mm\", static = 0.14, stribeck = \"3 mm/s\" }\n\
        C = { coefficient = 0.09, radius = \"5 mm\", viscous = \"0.002 N m s\" }\n[drives]\n\
        motor = { turns = \"crank\", law = [{ dwell = \"0.15 s\" }, { rise = 70, in = \"0.4 s\", by = \"4-5-6-7\" }, { fall = 30, speed = \"150 deg/s\" }, { rise = 10, acceleration = \"600 deg/s^2\" }] }\n\
        [loads]\nf = { force = [\"-2 N s/m * rate(x(V))\", \"-7 N - 20 N/m * (y(V) - 10 mm)\"], at = \"V\", axes = \"bar\" }\n\
        [measures]\nm1 = \"mean(abs(power(motor)))\"\n";
    let model = Model::from_toml(text, "rack", &mut |_| Err(String::new()))
        .unwrap()
        .model;
    let mechanism = Mechanism::new(&model);
    let motion = Motion::new(&Design::new(&mechanism, &model.parameter_values::<f64>())).unwrap();
    let measures: Vec<&Measure> = model.measures.iter().map(|m| &m.measure).collect();
    let ids = [0, 1, 2].map(ParameterId);
    let of = |ids: &[ParameterId]| {
        let found = sensitivities(&motion, Held::Time(0.1), &measures, ids).unwrap();
        found.derivatives[0].clone()
    };
    let all = of(&ids);
    for (which, own) in all.iter().enumerate().take(2) {
        let alone = of(&ids[which..=which])[0];
        assert!((own - alone).abs() < 1e-7 * alone.abs(), "{own} {alone}");
    }
    assert!(all[2].abs() < 1e-12, "{all:?}");
}

/// A slider-crank with friction whose rod stands still where the crank is square to the guide, which is tilted by `tilt`: what its pin resists turns over
/// there, and the load is the largest right beside it.
fn where_friction_turns_over(tilt: &str) -> Model {
    let text = format!(
        "units = {{ length = 'mm', angle = 'deg' }}
[parameters]
tilt = '{tilt}'
long = '160 mm'
[links]
frame = {{ A = [0, 0], E = [0, 10], F = ['400 mm * cos(tilt)', '10 mm + 400 mm * sin(tilt)'] }}
crank = {{ A-B = 50, mass = '1 kg', inertia = '3e-4 kg m^2', center = [10, 0] }}
rod = {{ B-C = 'long', mass = '0.8 kg', inertia = '1e-3 kg m^2', center = [50, 0] }}
ram = {{ C = [0, 0], mass = '2 kg', inertia = '1e-3 kg m^2' }}
[joints]
bore = {{ slider = 'ram', at = 'C', on = 'E -> F' }}
[friction]
all = {{ coefficient = 0.3, radius = '20 mm' }}
[drives]
motor = {{ turns = 'crank', from = 0, to = 360, speed = '120 rpm' }}
[assembly]
C = {{ near = [200, 0] }}
[loads]
cut = {{ force = ['2000 N * exp(-((angle(crank) - 92 deg) / 8 deg)^2)', 0], at = 'C', on = 'ram' }}
[measures]
load = 'reaction(bore)'
most = 'max(load)'
mean = 'mean(load)'
"
    );
    read(&text)
}

/// A number over the motion sees both sides of where friction turns over, whether a sample lies there or not, and follows it where it moves.
#[test]
fn numbers_look_at_both_sides_of_where_friction_turns_over() {
    for tilt in [0.0, 0.013, 0.5, -1.7] {
        let model = where_friction_turns_over(&format!("{tilt} deg"));
        let mechanism = Mechanism::new(&model);
        let motion = Motion::new(&Design::new(&mechanism, &model.parameter_values())).unwrap();
        let measures: Vec<&Measure> = model.measures.iter().map(|m| &m.measure).collect();
        let mut sampler = ForceSampler::new(&motion, &measures).unwrap();
        let most = sampler.at_time(0.0).sample.values[1];
        let turns = 0.5 * (90.0 + tilt) / 360.0;
        let before = sampler.at_time(turns - 1e-8).sample.values[0];
        let behind = sampler.at_time(turns + 1e-8).sample.values[0];
        assert!(before > 1.05 * behind, "{before} {behind}");
        assert!(
            (most / before - 1.0).abs() < 1e-5,
            "{tilt}: {most} {before}"
        );
        assert!(most >= before * (1.0 - 1e-12), "{tilt}: {most} {before}");
    }
    for tilt in ["0 deg", "0.5 deg", "-1.7 deg"] {
        let (compared, worst) = compare(&where_friction_turns_over(tilt), 0.3, true).unwrap();
        assert!(compared > 10 && worst < TOLERANCE, "{compared} {worst:e}");
    }
}

/// The largest force of a whole turn goes with what turns back where it begins and ends, as if it began elsewhere; of a half one it leaps there.
#[test]
fn the_largest_force_goes_with_what_turns_back_where_a_turn_begins() {
    let at_start = |law: &str| {
        let (model, motion) = slider_crank_at_its_dead_centre(law);
        let text = "max(reaction(slide))";
        let measure = model.measure(text).unwrap().measure;
        (model, motion, measure)
    };
    let (model, motion, most) =
        at_start("from = 'start', to = 'start + 360 deg', speed = '60 rpm'");
    let ids = [0, 1, 2].map(ParameterId);
    let found = sensitivities(&motion, Held::Time(0.1), &[&most], &ids).unwrap();
    for (which, h) in [1e-4, 1e-4, 1e-2].into_iter().enumerate() {
        let at = |k: f64| {
            let parameters = changed(&model, which, k * h);
            values(motion.mechanism(), &parameters, &[&most], 0.1).unwrap()[0]
        };
        let expected = (at(1.0) - at(-1.0)) / (2.0 * h);
        let own = found.derivatives[0][which];
        let scale = (at(0.0) / [0.03, 0.03, 1.0][which]).abs();
        assert!(
            (own - expected).abs() < 1e-4 * scale,
            "{which}: {own} for {expected}"
        );
    }
    // Right at the dead centre a force leaps as the offset grows, and of two strokes that take equally long either may become the longer.
    for text in ["at(reaction(A), motor, 180 deg)", "time_ratio(x(C))"] {
        let measure = model.measure(text).unwrap().measure;
        let found = sensitivities(&motion, Held::Time(0.1), &[&measure], &ids).unwrap();
        let own = &found.derivatives[0];
        assert!(own[0].is_nan() && own[1].is_finite(), "{text}: {own:?}");
    }
    // Up to the dead centre, where it would be otherwise behind, and from rest to rest.
    for law in [
        "from = 'start', to = 'start + 180 deg', speed = '60 rpm'",
        "from = 'start', to = 'start + 180 deg', law = '3-4-5', in = '0.5 s'",
    ] {
        let (model, motion, most) = at_start(law);
        let load = model.measure("reaction(slide)").unwrap().measure;
        let mut sampler = ForceSampler::new(&motion, &[&most, &load]).unwrap();
        let told = sampler.at_time(0.0).sample.values[0];
        let inside = (0..=2000).map(|k| 0.5 * f64::from(k) / 2000.0);
        let beside = (2..14).map(|k| 0.5 - 0.5 * kempe_number::powi(0.1, k));
        let early = (2..14).map(|k| 0.5 * kempe_number::powi(0.1, k));
        let all = inside.chain(beside).chain(early);
        let all = all.map(|time| sampler.at_time(time).sample.values[1]);
        let largest = all.fold(0.0, f64::max);
        assert!(
            (told / largest - 1.0).abs() < 1e-4,
            "{law}: {told} for {largest}"
        );
        // What turns back where a drive rests does so at once: nothing is told that rounding would make.
        let mean = &model.measures[0].measure;
        let found = sensitivities(&motion, Held::Time(0.1), &[mean], &ids).unwrap();
        let value = found.values[0].abs() / 0.03;
        let sane = |d: &f64| d.is_nan() || d.abs() < 1e3 * value;
        assert!(found.derivatives[0].iter().all(sane), "{law}: {found:?}");
    }
}

/// As its offset changes to one side, half a turn between dead centres has a piece more, behind one of them: where a force is larger there, or smaller, the
/// extreme leaps, and has no derivative; elsewhere it has that of differences.
#[test]
fn extremes_that_leap_at_an_end_of_a_motion_have_no_derivative() {
    let law = "from = 'start', to = 'start + 180 deg', speed = '60 rpm'";
    let (model, motion) = slider_crank_at_its_dead_centre(law);
    let of = [
        "reaction(A)",
        "reaction(B)",
        "reaction(slide)",
        "torque(motor)",
    ];
    let (mut leaping, mut smooth) = (0, 0);
    for text in of
        .iter()
        .flat_map(|of| [format!("max({of})"), format!("min({of})")])
    {
        let measure = model.measure(&text).unwrap().measure;
        let found = sensitivities(&motion, Held::Time(0.1), &[&measure], &[ParameterId(0)]);
        let own = found.unwrap().derivatives[0][0];
        let at = |e: f64| values(motion.mechanism(), &[e, 0.03, 0.0], &[&measure], 0.1).unwrap()[0];
        let h = 1e-7;
        let [low, here, high] = [-h, 0.0, h].map(at);
        let leaps = (high - here).abs().max((here - low).abs()) > 1e-3 * here.abs();
        let expected = (high - low) / (2.0 * h);
        match leaps {
            true => assert!(own.is_nan(), "{text}: {own}, {low} {here} {high}"),
            false => assert!(
                own.is_nan() || (own - expected).abs() < 1e-3 * (here / 0.03).abs(),
                "{text}: {own}, {low} {here} {high}"
            ),
        }
        leaping += usize::from(leaps);
        smooth += usize::from(own.is_finite());
    }
    assert!(leaping > 0 && smooth > 0, "{leaping} {smooth}");
}

/// What turns back a hair behind the first sample, or before the last one, has both its sides: a mean moves on evenly with that.
#[test]
fn means_know_what_turns_back_right_beside_the_ends_of_a_motion() {
    let (model, motion) = moved(
        "units = { length = 'mm', angle = 'deg' }\n[parameters]\nup = 0\n[links]\n\
         frame = { A = ['-0.1 mm', '1 m * up'], D = ['70.1 mm', '-1 m * up'] }\ncrank = { A-B = 20 }\n\
         lever = { D = [0, 0], S = [-110, 10], T = [-30, 10] }\n[joints]\n\
         slot = { pin = 'B', arc = 'S -> T', radius = '90.1 mm', side = 'left' }\n[assembly]\nlever = { near = '0 deg' }\n\
         [drives]\nmotor = { turns = 'crank', from = 0, to = 360, speed = '60 rpm' }\n[loads]\nhook = { torque = '2 N m', on = 'lever' }\n\
         [friction]\nslot = { coefficient = 0.07 }\nA = { coefficient = 0.07, radius = '5 mm' }\nD = { coefficient = 0.07, radius = '6 mm' }\n\
         [measures]\npower = 'mean(power(motor))'\n",
    );
    let measures = [&model.measures[0].measure];
    let at = |up: f64| values(motion.mechanism(), &[up], &measures, 0.1).unwrap()[0];
    let usual = at(0.0);
    for k in 0..24 {
        let up = 1e-12 * kempe_number::powi(1.25, k);
        for up in [up, -up] {
            let found = at(up);
            assert!(
                (found - usual).abs() < 3e-10 * usual,
                "{up:e}: {found} {usual}"
            );
        }
    }
}

/// Right before something comes to rest its friction is all there; at rest it is not known. The largest force is that right before, and moves with the end of
/// the law.
#[test]
fn numbers_look_right_before_what_rubs_comes_to_rest() {
    for law in ["3-4-5", "4-5-6-7", "cycloidal"] {
        let text = format!(
            "units = {{ length = 'mm', angle = 'deg' }}
[parameters]
k = '1 N/mm'
mu = 0.2
lasts = '0.3 s'
far = '100 mm'
[links]
frame = {{ A = [0, 0], B = [100, 0], Z = [-100, 0] }}
block = {{ C = [0, 0], mass = '2 kg' }}
[joints]
guide = {{ slider = 'block', at = 'C', on = 'A -> B' }}
[friction]
guide = {{ coefficient = 'mu' }}
[springs]
s = {{ between = 'Z-C', stiffness = 'k', free = '50 mm' }}
[drives]
push = {{ slides = 'block', from = 0, law = '{law}', in = 'lasts', to = 'far' }}
[measures]
top = 'max(force(push))'
"
        );
        let (model, motion) = moved(&text);
        let top: Vec<&Measure> = model.measures.iter().map(|m| &m.measure).collect();
        let rubs = 2.0 * 9.81;
        let wanted = 150.0 + 0.2 * rubs;
        let ids: Vec<ParameterId> = (0..4).map(ParameterId).collect();
        let found = sensitivities(&motion, Held::Time(0.0), &top, &ids).unwrap();
        assert!(
            (found.values[0] / wanted - 1.0).abs() < 3e-6,
            "{law}: {found:?}"
        );
        // Lengths in m: to the stiffness, the coefficient, the time, which it does not hang on, and the way.
        for (found, wanted) in found.derivatives[0].iter().zip([0.15, rubs, 0.0, 1000.0]) {
            assert!(
                (found - wanted).abs() < 1e-2 * wanted.max(1.0),
                "{law}: {found} {wanted}"
            );
        }
    }
}

/// Where a motion ends with its drive at rest, friction has the sense of the way there, whatever the law still slows it down by.
#[test]
fn friction_at_the_end_is_that_of_the_way_there() {
    let text = "units = { length = 'mm', angle = 'deg' }
[links]
frame = { E = [0, 0], F = [500, 0] }
block = { C = [0, 0], mass = '10 kg' }
[joints]
way = { slider = 'block', at = 'C', on = 'E -> F' }
[drives]
feed = { slides = 'block', from = 0, to = 100, law = 'harmonic', in = '1 s' }
[friction]
way = { coefficient = 0.2 }
[measures]
push = 'force(feed)'
least = 'min(push)'
most = 'max(push)'
";
    let (model, motion) = moved(text);
    let measures: Vec<&Measure> = model.measures.iter().map(|m| &m.measure).collect();
    let mut sampler = ForceSampler::new(&motion, &measures).unwrap();
    let rubs = 0.2 * 10.0 * 9.81;
    let slows = 10.0 * 0.05 * std::f64::consts::PI * std::f64::consts::PI;
    let end = sampler.at_time(1.0).sample.values;
    let start = sampler.at_time(0.0).sample.values;
    assert!((end[0] - (rubs - slows)).abs() < 1e-9, "{end:?}");
    assert!((start[0] - (rubs + slows)).abs() < 1e-9, "{start:?}");
    assert!(
        (end[1] - end[0]).abs() < 1e-9 && (end[2] - start[0]).abs() < 1e-9,
        "{end:?}"
    );
}

/// Of loads that equilibrium does not determine the least are told, with friction the least that are consistent with it: they have the rates and the derivatives
/// of the least, not the least of these.
#[test]
fn what_is_not_determined_has_the_rates_of_what_is_told() {
    let smooth = "units = { length = 'mm', angle = 'deg' }
[parameters]
l = '40 mm'
m = '2 kg'
cx = '60 mm'
pace = '60 deg/s'
[links]
frame = { A = [0, 0], D = [120, 0], G = [60, 50] }
crank_1 = { A-B = 'l' }
crank_2 = { D-C = 'l' }
crank_3 = { G-E = 'l' }
coupler = { B = [0, 0], C = [120, 0], E = [60, 50], mass = 'm', inertia = '0.004 kg m^2', center = ['cx', 10] }
[drives]
motor = { turns = 'crank_1', from = 30, to = 390, speed = 'pace' }
[measures]
load = 'reaction_x(G)'
rate = 'rate(load)'
bend = 'rate(rate(load))'
own = 'reaction(A)'
most = 'max(own)'
usual = 'mean(own)'
far = 'max(x(E))'
";
    let rubs = "[friction]\nall = { coefficient = 0.3, radius = '9 mm' }\n";
    loads_have_their_rates(smooth);
    loads_have_their_rates(&format!("{smooth}{rubs}"));
    // One slider too many: its normal force and torque are shared.
    loads_have_their_rates(&format!(
        "{}{rubs}",
        "units = { length = 'mm', angle = 'deg' }
[parameters]
l = '40 mm'
m = '2 kg'
h = '30 mm'
pace = '60 deg/s'
[links]
frame = { A = [0, 0], U = [20, 'h'], V = [220, 'h'], X = [20, -10], Y = [220, -10] }
crank = { A-B = 'l' }
rod = { B-C = 110 }
ram = { C = [0, 0], P = [0, 'h'], Q = [0, -10], mass = 'm', inertia = '0.004 kg m^2', center = [12, 10] }
[joints]
upper = { slider = 'ram', at = 'P', on = 'U -> V' }
lower = { slider = 'ram', at = 'Q', on = 'X -> Y' }
[drives]
motor = { turns = 'crank', from = 30, to = 130, speed = 'pace' }
[loads]
work = { force = [-40, 9], at = 'Q', on = 'ram' }
[measures]
load = 'reaction_y(upper)'
rate = 'rate(load)'
bend = 'rate(rate(load))'
own = 'reaction(A)'
most = 'max(own)'
"
    ));
}

fn loads_have_their_rates(text: &str) {
    let (model, motion) = moved(text);
    let measures: Vec<&Measure> = model.measures.iter().map(|m| &m.measure).collect();
    let mut sampler = ForceSampler::new(&motion, &measures).unwrap();
    let mut at = |time: f64| sampler.at_time(time).sample.values;
    let h = 1e-4;
    let end = kempe_motion::drive_path::duration(&model, &model.parameter_values());
    for part in [0.07, 0.18, 0.35, 0.62, 0.87] {
        let time = part * end;
        let [a, b, c, d] = [1.0, -1.0, 2.0, -2.0].map(|k| at(time + k * h));
        let here = at(time);
        for k in 0..2 {
            let wanted = (8.0 * (a[k] - b[k]) - (c[k] - d[k])) / (12.0 * h);
            let size = wanted.abs().max(1.0);
            assert!(
                (here[k + 1] - wanted).abs() < 1e-6 * size,
                "{time}: {here:?} {wanted}"
            );
        }
    }
    let most = at(0.0)[4];
    let rows = (0..=4000).map(|k| at(f64::from(k) * end / 4000.0)[3]);
    let found = rows.fold(0.0, f64::max);
    assert!(
        found <= most * (1.0 + 1e-12) && found > most * (1.0 - 1e-5),
        "{found} {most}"
    );
    let (compared, worst) = compare(&model, 0.3, true).unwrap();
    assert!(compared > 10 && worst < TOLERANCE, "{compared} {worst:e}");
}
