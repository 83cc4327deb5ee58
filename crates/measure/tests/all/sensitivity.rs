//! Derivatives of measures to dimensions and laws: against high-order differences of models built anew.
#![allow(clippy::unwrap_used)]

use crate::support::{Case, Rng};
use kempe_measure::{Held, Sampler, StatisticNote, sensitivities};
use kempe_model::{LawPiece, Measure, Model, Parameter, ParameterId, Place, Scalar};
use kempe_units::{Dimension, Expr};

/// Agreement asked for, relative to the derivative (or to value per size, where that is more).
const EXACT: f64 = 1e-8;

/// Every number that is a dimension or belongs to a law made a parameter of its own.
fn parametrised(mut model: Model) -> Model {
    let mut added: Vec<Parameter> = Vec::new();
    let first = model.parameters.len();
    let mut free = |scalar: &mut Scalar, dimension: Dimension| {
        if let Expr::Const(value) = *scalar
            && value != 0.0
        {
            *scalar = Expr::Leaf(ParameterId((first + added.len()) as u32));
            added.push(Parameter {
                name: format!("free_{}", added.len()),
                value: Expr::Const(value),
                dimension,
                span: 0..0,
            });
        }
    };
    for point in model.links.iter_mut().flat_map(|l| &mut l.points) {
        match &mut point.place {
            Place::Cartesian { x, y } => {
                free(x, Dimension::LENGTH);
                free(y, Dimension::LENGTH);
            }
            Place::Polar { radius, angle } => {
                free(radius, Dimension::LENGTH);
                free(angle, Dimension::ANGLE);
            }
            Place::Triangle {
                from_distance,
                to_distance,
                ..
            } => {
                free(from_distance, Dimension::LENGTH);
                free(to_distance, Dimension::LENGTH);
            }
        }
    }
    for drive in &mut model.drives {
        free(&mut drive.law.from, drive.dimension);
        for piece in &mut drive.law.pieces {
            match piece {
                LawPiece::ConstantSpeed { to, speed: more }
                | LawPiece::ConstantAcceleration {
                    to,
                    acceleration: more,
                }
                | LawPiece::Rise {
                    to, duration: more, ..
                } => {
                    free(to, drive.dimension);
                    free(more, Dimension::NONE);
                }
                LawPiece::Dwell { duration } => free(duration, Dimension::NONE),
                LawPiece::Table { .. } | LawPiece::Polynomials(_) => {}
            }
        }
    }
    model.parameters.extend(added);
    model
}

fn example(path: &str) -> Model {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/");
    let text = std::fs::read_to_string(format!("{root}{path}.toml")).unwrap();
    let folder = path.split('/').next().unwrap();
    let mut files = |file: &str| {
        std::fs::read_to_string(format!("{root}{folder}/{file}")).map_err(|e| e.to_string())
    };
    Model::from_toml(&text, path, &mut files).unwrap().model
}

fn values(model: &Model, held: Held, measures: &[&Measure]) -> Option<Vec<f64>> {
    let case = Case::from_model(model.clone());
    let motion = case.motion().ok()?;
    let mut sampler = Sampler::new(&motion, measures).unwrap();
    let sample = match held {
        Held::Path(p) => sampler.at_parameter(p),
        Held::Time(t) | Held::Break(t) | Held::Extreme { time: t, .. } => sampler.at_time(t),
    };
    sample.note.is_none().then_some(sample.values)
}

/// Central differences of eighth order.
fn difference(
    model: &Model,
    held: Held,
    measures: &[&Measure],
    parameter: ParameterId,
    h: f64,
) -> Option<Vec<f64>> {
    const WEIGHTS: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
    let base = model.parameter_values::<f64>()[parameter.index()];
    let mut sum = vec![0.0; measures.len()];
    for (k, weight) in WEIGHTS.iter().enumerate() {
        for side in [1.0, -1.0] {
            let mut moved = model.clone();
            let step = side * (k as f64 + 1.0) * h;
            moved.parameters[parameter.index()].value = Expr::Const(base + step);
            let list = values(&moved, held, measures)?;
            for (sum, value) in sum.iter_mut().zip(list) {
                *sum += side * weight * value / h;
            }
        }
    }
    Some(sum)
}

/// Compares all named measures at some places with some parameters; returns the worst miss and how many were compared.
fn compare(path: &str, places: &[f64], count: usize, rng: &mut Rng) -> (f64, usize) {
    compare_model(path, example(path), places, count, rng)
}

fn compare_model(
    path: &str,
    model: Model,
    places: &[f64],
    count: usize,
    rng: &mut Rng,
) -> (f64, usize) {
    let model = parametrised(model);
    let case = Case::from_model(model.clone());
    let motion = case.motion().unwrap();
    // Forces are another sampler's.
    let known: Vec<_> = (model.measures.iter())
        .filter(|m| !m.needs_forces)
        .collect();
    let named: Vec<&Measure> = known.iter().map(|m| &m.measure).collect();
    let (low, high) = motion.reached();
    let sampler = Sampler::new(&motion, &[]).unwrap();
    let duration = sampler.duration();
    let (mut worst, mut compared) = (0.0_f64, 0);
    for part in places {
        for held in [
            Held::Path(low + part * (high - low)),
            Held::Time(part * duration),
        ] {
            let chosen: Vec<ParameterId> = (0..count)
                .map(|_| ParameterId(rng.below(model.parameters.len()) as u32))
                .collect();
            let exact = sensitivities(&motion, held, &named, &chosen).unwrap();
            let plain = values(&model, held, &named).unwrap();
            for (column, &parameter) in chosen.iter().enumerate() {
                let kind = model.parameters[parameter.index()].dimension;
                let base = model.parameter_values::<f64>()[parameter.index()];
                let unit = if kind == Dimension::LENGTH {
                    motion.size()
                } else {
                    base.abs()
                };
                let rough = |h: f64| difference(&model, held, &named, parameter, h * unit);
                let Some(far) = rough(2e-4) else { continue };
                let mut near = None;
                for (index, measure) in known.iter().enumerate() {
                    let (value, slope) = (plain[index], exact.derivatives[index][column]);
                    assert!(
                        (exact.values[index] - value).abs() <= 1e-9 * value.abs().max(1e-3),
                        "{path} {} {held:?}: {} but {value}",
                        measure.name,
                        exact.values[index]
                    );
                    // Beyond whole turns there is no time ratio to compare with.
                    if measure.name == "ratio" && far[index].is_nan() {
                        continue;
                    }
                    let scale = slope.abs().max(value.abs() / unit).max(1e-3);
                    let mut miss = (slope - far[index]).abs() / scale;
                    if !(miss <= EXACT) {
                        // Which of two extremes is the larger may change within the longer step.
                        let list = near.get_or_insert_with(|| rough(2e-5).unwrap());
                        miss = (slope - list[index]).abs() / scale;
                    }
                    assert!(
                        miss <= EXACT,
                        "{path} {held:?} d({})/d({} = {base}): {slope} but {} ({miss:e})",
                        measure.name,
                        model.parameters[parameter.index()].name,
                        far[index]
                    );
                    compared += 1;
                    worst = worst.max(miss);
                }
            }
        }
    }
    (worst, compared)
}

#[test]
fn derivatives_agree_with_differences_of_rebuilt_models() {
    let mut rng = Rng(7);
    let mut all = 0;
    for (path, places) in [
        ("seeds/crank-rocker", &[0.137, 0.61][..]),
        ("seeds/slider-crank", &[0.31]),
        ("seeds/door-lock", &[0.21, 0.83]),
        ("seeds/tractor-hitch", &[0.4]),
        ("seeds/luffing-crane", &[0.4]),
        ("gallery/class-iii", &[0.17, 0.77]),
        ("gallery/stephenson-ii", &[0.35]),
        ("gallery/geared-five-bar", &[0.72]),
        ("gallery/excavator", &[0.55]),
        ("gallery/shaper", &[0.23]),
        ("gallery/groove-cam", &[0.31, 0.87]),
        ("gallery/overhead-door", &[0.43]),
    ] {
        let (worst, compared) = compare(path, places, 2, &mut rng);
        println!("{path}: {compared} derivatives, worst miss {worst:.1e}");
        all += compared;
    }
    assert!(all > 200, "{all}");
}

#[test]
fn what_goes_over_a_motion_is_differentiated() {
    let text = r#"
[links]
frame   = { A = [0, 0], D = [6, 0] }
crank   = { A-B = 2 }
coupler = { B-C = 5, P = [2.5, 1] }
rocker  = { D-C = 4 }
[drives]
motor = { turns = "crank", from = "0.3 rad", to = "4.9 rad", acceleration = "0.7 rad/s^2" }
[assembly]
C = "left of B -> D"
[measures]
p3    = "angle(rocker)"
turn  = "angle(B -> D)"
way   = "path_length(P)"
whole = "max(way)"
bend  = "curvature(P)"
low   = "min(y(P))"
high  = "max(y(P))"
mean  = "mean(x(P))"
gain  = "mechanical_advantage(p3, motor)"
third = "d(x(P), motor, 3)"
pole  = "instant_center_x(coupler, frame)"
jerk  = "rate(x(P), 3)"
"#;
    let model = Model::from_toml(text, "over", &mut |_| Err(String::new()))
        .unwrap()
        .model;
    let (_, compared) = compare_model("over", model, &[0.43], 3, &mut Rng(11));
    assert!(compared > 60, "{compared}");
}

#[test]
fn a_parameter_carries_what_is_built_on_it() {
    let text = "[parameters]\na = \"2 m\"\nb = \"a * a / 1 m\"\n[links]\nframe = { A = [0, 0] }\nbar = { A-B = \"b\" }\n\
        [drives]\nmotor = { turns = \"bar\", from = 0, to = \"2 rad\", speed = \"1 rad/s\" }\n[measures]\nx = \"x(B)\"\n";
    let case = Case::read(text, "built");
    let motion = case.must_move();
    let measure = &case.model.measures[0].measure;
    let both = [ParameterId(0), ParameterId(1)];
    let found = sensitivities(&motion, Held::Path(1.2), &[measure], &both).unwrap();
    let cosine = kempe_number::math::cos(1.2);
    assert!((found.values[0] - 4.0 * cosine).abs() < 1e-15);
    assert!((found.derivatives[0][0] - 4.0 * cosine).abs() < 1e-15);
    assert!((found.derivatives[0][1] - cosine).abs() < 1e-15);
    // Beyond the motion nothing is said; without parameters only values.
    let beyond = sensitivities(&motion, Held::Path(70.0), &[measure], &both).unwrap();
    assert!(beyond.values[0].is_nan() && beyond.derivatives[0].iter().all(|d| d.is_nan()));
    let plain = sensitivities(&motion, Held::Time(1.2), &[measure], &[]).unwrap();
    assert!(plain.derivatives[0].is_empty() && plain.values == found.values);
}

/// A crank-rocker of 20, 50, 40 and 60 mm, or a slider-crank; its measure is `ratio`.
fn of_a_turn(text: &str, drive: &str) -> Case {
    let text = format!(
        "units = {{ length = \"mm\", angle = \"deg\" }}\n{text}[drives]\nmotor = {{ turns = \"crank\", {drive} }}\n"
    );
    Case::read(&text, "turn")
}

const ROCKER: &str = r#"
[parameters]
a = "20 mm"
b = "50 mm"
c = "40 mm"
w = "1 s"
[links]
frame   = { A = [0, 0], D = [60, 0] }
crank   = { A-B = "a" }
coupler = { B-C = "b" }
rocker  = { D-C = "c" }
[assembly]
C = "left of B -> D"
[measures]
ratio = "time_ratio(angle(rocker))"
"#;

/// Derivatives of the first measure to all parameters.
fn slopes(case: &Case) -> Vec<f64> {
    let motion = case.must_move();
    let all: Vec<ParameterId> = (0..case.model.parameters.len() as u32)
        .map(ParameterId)
        .collect();
    let measure = &case.model.measures[0].measure;
    let found = sensitivities(&motion, Held::Path(motion.start), &[measure], &all).unwrap();
    found.derivatives[0].clone()
}

/// Where a turn begins does not change how long its strokes take, nor how they change.
#[test]
fn a_time_ratio_has_its_derivatives_where_a_turn_begins_at_a_dead_centre() {
    let dead = "acos((70^2+60^2-40^2)/(2*70*60))";
    let inner = "180 deg + acos((30^2+60^2-40^2)/(2*30*60))";
    for speed in ["60 rpm", "360 deg / w"] {
        let turn = |from: &str, turns: u32| {
            let to = 360 * turns;
            let drive =
                format!("from = \"{from}\", to = \"{from} + {to} deg\", speed = \"{speed}\"");
            slopes(&of_a_turn(ROCKER, &drive))
        };
        let plain = turn("0 deg", 1);
        for (found, known) in plain.iter().zip([-5.534, 16.738, 13.478]) {
            assert!((found - known).abs() < 5e-4, "{plain:?}");
        }
        for (from, turns) in [(dead, 1), (inner, 1), (dead, 2), (inner, 3)] {
            let found = turn(from, turns);
            for (found, known) in found.iter().zip(&plain) {
                let miss = (found - known).abs();
                assert!(miss < 1e-8, "{from} {turns}: {found} {known}");
            }
        }
    }
}

/// A drive that comes to rest at a dead centre passes it as the cube root of a change: there is no derivative. One that rests elsewhere goes with its law.
#[test]
fn a_time_ratio_goes_with_a_law_that_rests() {
    let dead = "acos((70^2+60^2-40^2)/(2*70*60))";
    let law = "law = [{ rise = 180, in = \"w\" }, { rise = 180, in = \"2 * w\" }]";
    let found = slopes(&of_a_turn(ROCKER, &format!("from = \"{dead}\", {law}")));
    assert!(found[..3].iter().all(|d| !d.is_finite()), "{found:?}");
    let there_and_back =
        "from = 60, law = [{ rise = 60, in = \"w\" }, { fall = 60, in = \"2 s\" }]";
    let found = slopes(&of_a_turn(ROCKER, there_and_back));
    // 2 s over w.
    assert!(found[..3].iter().all(|d| *d == 0.0), "{found:?}");
    assert!((found[3] + 2.0).abs() < 1e-9, "{found:?}");
}

/// A drive that rests at a dead centre has its slider turn back a cube root of the way beside it: however near, that is found.
#[test]
fn time_ratios_turn_back_right_beside_where_a_drive_rests() {
    use kempe_number::math::{acos, sin};
    use std::f64::consts::{PI, TAU};
    let text = |a: f64| {
        let law = "law = [{ rise = 180, in = 1 }, { rise = 180, in = 2 }]";
        let drive = format!("from = \"acos((70^2+60^2-40^2)/(2*70*60))\", {law}");
        (ROCKER.replace("\"20 mm\"", &format!("\"{a} mm\"")), drive)
    };
    // How long the law takes to go so far, by bisection.
    let passes = |turned: f64| {
        let turned = turned.rem_euclid(TAU);
        let (rise, from, duration) = match turned <= PI {
            true => (turned / PI, 0.0, 1.0),
            false => (turned / PI - 1.0, 1.0, 2.0),
        };
        let mut ends = [0.0_f64, 1.0];
        for _ in 0..100 {
            let u = 0.5 * (ends[0] + ends[1]);
            ends[usize::from(u - sin(TAU * u) / TAU > rise)] = u;
        }
        from + duration * ends[0]
    };
    let corner = |side: f64| acos((side * side + 2000.0) / (120.0 * side));
    for a in [19.9, 19.99, 19.999, 20.001, 20.01, 20.1] {
        let (outer, inner) = (corner(50.0 + a), PI + corner(50.0 - a));
        let start = corner(70.0);
        let between = (passes(outer - start) - passes(inner - start)).abs();
        let known = (3.0 - between).max(between) / (3.0 - between).min(between);
        let (text, drive) = text(a);
        let case = of_a_turn(&text, &drive);
        let motion = case.must_move();
        let measure = &case.model.measures[0].measure;
        let found = Sampler::new(&motion, &[measure])
            .unwrap()
            .at_time(0.0)
            .values[0];
        assert!((found - known).abs() < 1e-6, "{a}: {found} {known}");
    }
}

/// What rests has no direction, but its way has its derivatives: whatever else is asked.
#[test]
fn ways_have_their_derivatives_where_a_drive_rests() {
    let text = ROCKER.replace("{ B-C = \"b\" }", "{ B-C = \"b\", P = [25, 10] }");
    let asked = |measures: &str| text.replace("ratio = \"time_ratio(angle(rocker))\"\n", measures);
    let (way, pace) = (
        "way = \"max(path_length(P))\"\n",
        "pace = \"mean(speed(P))\"\n",
    );
    for (drive, duration) in [
        ("from = 0, to = 180, law = \"cycloidal\", in = \"1 s\"", 1.0),
        (
            "from = 40, law = [{ dwell = 0.1 }, { rise = 160, in = 0.3, by = \"harmonic\" }, { dwell = 0.2 }, { to = 40, speed = 8 }]",
            20.6,
        ),
    ] {
        let alone = slopes(&of_a_turn(&asked(way), drive));
        let beside = slopes(&of_a_turn(&asked(&format!("{way}{pace}")), drive));
        let pace = slopes(&of_a_turn(&asked(pace), drive));
        let by_differences = |which: usize| {
            let model = of_a_turn(&asked(way), drive).model.clone();
            let measure = model.measures[0].measure.clone();
            let id = ParameterId(which as u32);
            difference(&model, Held::Time(0.0), &[&measure], id, 1e-5).unwrap()[0]
        };
        for which in 0..3 {
            let known = by_differences(which);
            for found in [alone[which], beside[which], pace[which] * duration] {
                assert!(
                    (found - known).abs() < 1e-7,
                    "{drive} {which}: {found} {known}"
                );
            }
        }
    }
}

/// Right at a corner there is no derivative to what leads away from it, and beside it there is.
#[test]
fn a_corner_has_no_derivative() {
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\nr = \"30 mm\"\nl = \"100 mm\"\ne = \"0 mm\"\n[links]\n\
        frame = { A = [0, 0], E = [0, \"e\"], F = [200, \"e\"] }\ncrank = { A-B = \"r\" }\nrod = { B-C = \"l\" }\npiston = { C = [0, 0] }\n\
        [joints]\nbore = { slider = \"piston\", at = \"C\", on = \"E -> F\" }\n[drives]\n\
        motor = { turns = \"crank\", from = 0, to = 360, speed = \"60 rpm\" }\n[assembly]\nC = { near = [130, 0] }\n[measures]\n\
        size = \"abs(y(C))\"\nspeed = \"speed(C)\"\nless = \"min(y(C), y(E) + y(C) / 2, 3 mm)\"\nway = \"hypot(y(C), y(B))\"\n\
        root = \"sqrt(abs(y(C)) * 1 mm)\"\nthere = \"at(abs(y(C)), motor, 180)\"\nnamed = \"2 * size + x(C)\"\nratio = \"time_ratio(x(C))\"\nplain = \"x(C)\"\n";
    let at = |text: &str, degrees: f64| {
        let case = Case::read(text, "corner");
        let motion = case.must_move();
        let measures: Vec<&Measure> = case.model.measures.iter().map(|m| &m.measure).collect();
        let ids = [0, 1, 2].map(ParameterId);
        let held = Held::Path(degrees.to_radians());
        sensitivities(&motion, held, &measures, &ids).unwrap()
    };
    let corner = at(text, 180.0);
    for (index, slopes) in corner.derivatives.iter().enumerate() {
        assert!(corner.values[index].is_finite());
        // The offset alone leads away; the last is smooth.
        assert_eq!(slopes[2].is_finite(), index == 8, "{index}: {slopes:?}");
        let smooth = slopes[..2].iter().all(|d| d.is_finite());
        assert!(smooth || index == 4, "{index}: {slopes:?}");
    }
    // A root of what lies at its corner, and the speed at the dead centre, beside them.
    let beside = at(&text.replace("e = \"0 mm\"", "e = \"0.001 mm\""), 170.0);
    assert!(
        beside.derivatives.iter().flatten().all(|d| d.is_finite()),
        "{beside:?}"
    );
}

/// Of two extremes that are equally large and change otherwise there is no derivative; of a motion that goes through the same twice there is.
#[test]
fn a_number_over_a_motion_has_none_where_extremes_are_equally_large() {
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\nr = \"30 mm\"\nl = \"100 mm\"\ne = \"0 mm\"\n[links]\n\
        frame = { A = [0, 0], E = [0, \"e\"], F = [200, \"e\"] }\ncrank = { A-B = \"r\" }\nrod = { B-C = \"l\" }\npiston = { C = [0, 0] }\n\
        [joints]\nbore = { slider = \"piston\", at = \"C\", on = \"E -> F\" }\n[drives]\n\
        motor = { turns = \"crank\", from = 20, to = 740, speed = \"60 rpm\" }\n[assembly]\nC = { near = [130, 0] }\n[measures]\n\
        lean = \"max(abs(angle(rod)))\"\nless = \"2 * named + 1 rad * e / l\"\nnamed = \"range(abs(angle(rod)))\"\nsize = \"max(abs(y(C)))\"\nmean = \"mean(abs(y(C)))\"\n\
        swing = \"max(angle(rod))\"\nnothing = \"min(abs(y(B)))\"\nrest = \"min(speed(C))\"\nreach = \"range(x(C))\"\n";
    let at = |text: &str| {
        let case = Case::read(text, "equal");
        let motion = case.must_move();
        let measures: Vec<&Measure> = case.model.measures.iter().map(|m| &m.measure).collect();
        let ids = [0, 1, 2].map(ParameterId);
        sensitivities(&motion, Held::Time(0.0), &measures, &ids).unwrap()
    };
    let found = at(text);
    for (index, slopes) in found.derivatives.iter().enumerate() {
        // By the lengths both go alike.
        assert!(
            slopes[..2].iter().all(|d| d.is_finite()),
            "{index}: {slopes:?}"
        );
        assert_eq!(slopes[2].is_finite(), index >= 5, "{index}: {slopes:?}");
    }
    // The first of them: of asin((r - e) / l) or of asin((r + e) / l).
    let slope = 1.0 / (0.1 * (1.0 - 0.09_f64).sqrt());
    let side = |measure: usize| {
        let mut sides = found.one_sided.iter();
        sides
            .find(|it| it.measure == measure && it.parameter == 2)
            .unwrap()
    };
    assert!(side(0).over_motion && (side(0).slope.abs() - slope).abs() < 1e-9);
    assert!((found.derivatives[0][0] - slope).abs() < 1e-9);
    assert!((found.derivatives[5][2].abs() - slope).abs() < 1e-9);
    assert!(found.derivatives[6].iter().all(|d| d.abs() < 1e-9));
    assert!(found.derivatives[7].iter().all(|d| d.abs() < 1e-6));
    // Beside it one of them is the largest.
    let beside = at(&text.replace("e = \"0 mm\"", "e = \"0.01 mm\""));
    assert!(
        beside.derivatives.iter().flatten().all(|d| d.is_finite()),
        "{beside:?}"
    );
}

/// Where a block turns back its speed does, too, at once: what is taken from its place by that is the place at the dead centre, as far out as in closed form,
/// over the motion and as a peak that is given by its time.
#[test]
fn a_peak_where_a_speed_vanishes_goes_with_it() {
    let (r, l, e): (f64, f64, f64) = (0.025, 0.08, 0.006);
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\nr = \"25 mm\"\nl = \"80 mm\"\ne = \"6 mm\"\nstart = \"10 deg\"\n[links]\n\
        frame = { A = [0, 0], E = [0, \"e\"], F = [200, \"e\"] }\ncrank = { A-B = \"r\" }\nrod = { B-C = \"l\" }\npiston = { C = [0, 0] }\n\
        [joints]\nbore = { slider = \"piston\", at = \"C\", on = \"E -> F\" }\n[drives]\n\
        motor = { turns = \"crank\", from = \"start\", to = \"start + 360 deg\", speed = \"300 rpm\" }\n[assembly]\nC = { near = [100, 0] }\n[measures]\n\
        speed = \"max(x(C) - 0.01 s * speed(C))\"\nroot = \"max(x(C) - 0.01 s * sqrt(rate(x(C))^2))\"\n\
        hypot = \"max(x(C) - 0.01 s * hypot(rate(x(C)), rate(y(C))))\"\nabs = \"max(x(C) - 0.01 s * abs(rate(x(C))))\"\n\
        less = \"-min(0.01 s * speed(C) - named)\"\nnamed = \"x(C)\"\npeak = \"x(C) - 0.01 s * speed(C)\"\n";
    let case = Case::read(text, "dead centre");
    let motion = case.must_move();
    let measures: Vec<&Measure> = case.model.measures.iter().map(|m| &m.measure).collect();
    let ids = [0, 1, 2, 3].map(ParameterId);
    let foot = ((r + l) * (r + l) - e * e).sqrt();
    let wanted = [(r + l) / foot, (r + l) / foot, -e / foot, 0.0];
    let close = |found: &[f64]| {
        let both = found.iter().zip(wanted);
        assert!(
            both.into_iter()
                .all(|(d, wanted)| (d - wanted).abs() < 1e-8),
            "{found:?} {wanted:?}"
        );
    };
    let over = sensitivities(&motion, Held::Time(0.0), &measures, &ids).unwrap();
    over.derivatives[..5].iter().for_each(|found| close(found));
    // Crank and rod are in line as they go out: at asin(e / (r + l)), a turn and the start later.
    let turn = 0.2;
    let angle = kempe_number::math::atan2(e, foot) - 10.0_f64.to_radians();
    let time = turn * (1.0 + angle / std::f64::consts::TAU);
    for beside in [-1e-11, 0.0, 1e-11] {
        let held = Held::Extreme {
            of: 6,
            time: time + beside,
        };
        let at = sensitivities(&motion, held, &measures, &ids).unwrap();
        close(&at.derivatives[6]);
        assert!(at.derivatives[5].iter().all(|d| d.is_nan()));
    }
}

/// A lever that its rod meets in line within its swing: the block is as far left twice in a turn, and the ratio counts from the first of these, whatever
/// rounding finds larger. The other counts where the turn begins between both.
#[test]
fn a_time_ratio_counts_from_the_first_of_two_equal_extremes() {
    let overtravels = |a: f64, from: f64| {
        let text = format!(
            "[parameters]\na = \"{a} mm\"\nb = \"50 mm\"\nhigh = \"60 mm\"\n[links]\n\
             frame = {{ A = [0, 0], D = [60, 0], E = [0, \"high\"], F = [100, \"high\"] }}\ncrank = {{ A-B = \"a\" }}\n\
             coupler = {{ B-C = \"b\" }}\nrocker = {{ D = [0, 0], C = [40, 0], T = [50, 0] }}\nrod = {{ T-G = 40 }}\nram = {{ G = [0, 0] }}\n\
             [joints]\nway = {{ slider = \"ram\", at = \"G\", on = \"E -> F\" }}\n[assembly]\nC = \"left of B -> D\"\n\
             G = {{ near = [10, 60] }}\n[measures]\nratio = \"time_ratio(x(G))\"\n"
        );
        let drive = format!("from = {from}, to = {}, speed = \"60 rpm\"", from + 360.0);
        of_a_turn(&text, &drive)
    };
    let ratio = |a: f64, from: f64| {
        let case = overtravels(a, from);
        let measure = &case.model.measures[0].measure;
        let mut sampler = Sampler::new(&case.must_move(), &[measure]).unwrap();
        (sampler.values_at_time(0.0)[0], sampler.notes_of(measure))
    };
    for (from, then) in [(0.0, 180.0), (180.0, 0.0), (100.0, 200.0)] {
        let (own, notes) = ratio(20.0, from);
        let (other, _) = ratio(20.0, then);
        let [
            StatisticNote::ExtremeAgain {
                largest: false,
                first,
                again,
                other: told,
            },
        ] = notes[..]
        else {
            panic!("{notes:?}");
        };
        assert!(
            first < again && (told - other).abs() < 1e-6,
            "{told} {other}"
        );
        assert!((own - other).abs() > 0.1);
        // As it changes with the crank's length.
        let slope = slopes(&overtravels(20.0, from))[0];
        let [more, less] = [20.01, 19.99].map(|a| ratio(a, from).0);
        let wanted = (more - less) / 2e-5;
        assert!(
            (slope - wanted).abs() < 1e-4 * wanted.abs(),
            "{slope} {wanted}"
        );
    }
    // Of two turns both extremes come again; the one that comes twice in a turn is told.
    let case = overtravels(20.0, 0.0);
    let text = case.text.replace("to = 360", "to = 720");
    let case = Case::read(&text, "turn");
    let measure = &case.model.measures[0].measure;
    let sampler = Sampler::new(&case.must_move(), &[measure]).unwrap();
    let notes = sampler.notes_of(measure);
    let [
        StatisticNote::ExtremeAgain {
            largest: false,
            first,
            again,
            ..
        },
    ] = notes[..]
    else {
        panic!("{notes:?}");
    };
    assert!(first < again && again - first < 1.0, "{notes:?}");
    // A crank-rocker has each extreme once, and again where a turn ends as it began.
    let dead = "acos((70^2+60^2-40^2)/(2*70*60))";
    let case = of_a_turn(
        ROCKER,
        &format!("from = \"{dead}\", to = \"{dead} + 720 deg\", speed = \"60 rpm\""),
    );
    let measure = &case.model.measures[0].measure;
    let sampler = Sampler::new(&case.must_move(), &[measure]).unwrap();
    assert_eq!(sampler.notes_of(measure), []);
}
