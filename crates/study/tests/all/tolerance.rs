//! Studies of tolerances: closed forms where they are linear, dense references where they are not, yields, pieces that do not move, lanes
//! against motions, threads, and studies that are stopped.
#![allow(
    clippy::disallowed_methods,
    reason = "numbers found by hand beside ours, not reproducible ones"
)]

use std::ops::ControlFlow;

use crate::impatient::Impatient;
use crate::told::scalar;
use kempe_batch::{Serial, Threads};
use kempe_model::{Diagnostic, Model};
use kempe_study::{Done, Silent, Stage, StudyResult, check, run, run_with};

/// A slider-crank without offset: crank a, rod b, from 0 as far as asked.
fn slider(a: f64, b: f64, to: f64, study: &str) -> String {
    format!(
        "units = {{ length = \"mm\", angle = \"deg\" }}\n[parameters]\na = \"{a} mm\"\nb = \"{b} mm\"\n\
         [links]\nframe = {{ A = [0, 0], E = [0, 0], F = [100, 0] }}\ncrank = {{ A-B = \"a\" }}\nrod = {{ B-C = \"b\" }}\nblock = {{ C = [0, 0] }}\n\
         [joints]\nguide = {{ slider = \"block\", at = \"C\", on = \"E -> F\" }}\n\
         [drives]\nmotor = {{ turns = \"crank\", from = 0, to = {to}, speed = \"1 rad/s\" }}\n[assembly]\nC = {{ near = [{}, 0] }}\n\
         [studies.turn]\nkind = \"motion\"\nstep = 2\ncolumns = [\"x(C)\"]\n\
         [studies.pieces]\nkind = \"tolerance\"\nover = \"turn\"\n{study}\n",
        a + b
    )
}

/// A four-bar with a coupler point.
fn four_bar(study: &str) -> String {
    format!(
        "units = {{ length = \"mm\", angle = \"deg\" }}\n[parameters]\na = \"20 mm\"\nb = \"50 mm\"\nc = \"40 mm\"\nd = \"60 mm\"\nidle = \"1 mm\"\n\
         [links]\nframe = {{ A = [0, 0], D = [\"d\", 0] }}\ncrank = {{ A-B = \"a\" }}\ncoupler = {{ B-C = \"b\", P = [25, 10] }}\nrocker = {{ D-C = \"c\" }}\n\
         [drives]\nmotor = {{ turns = \"crank\", from = 0, to = 360, speed = \"1 rad/s\" }}\n[assembly]\nC = \"left of B -> D\"\n\
         [studies.turn]\nkind = \"motion\"\nstep = 5\ncolumns = [\"angle(rocker)\", \"y(P)\"]\n\
         [studies.pieces]\nkind = \"tolerance\"\nover = \"turn\"\n{study}\n"
    )
}

const LENGTHS: &str = "vary = { a = \"0.1 mm\", b = \"0.2 %\", c = { normal = \"0.05 mm\" }, d = { between = [\"0 mm\", \"0.2 mm\"] } }\n";

fn model(text: &str) -> Model {
    match Model::from_toml(text, "test", &mut |_| Err("no files".into())) {
        Ok(checked) => checked.model,
        Err(found) => panic!("{}", rendered(&found, text)),
    }
}

fn rendered(found: &[Diagnostic], text: &str) -> String {
    let lines = found.iter().map(|d| d.render_plain("test.toml", text));
    lines.collect()
}

fn found(text: &str) -> StudyResult {
    let model = model(text);
    match run(&model, &model.studies[1], &mut Silent) {
        Ok(result) => result,
        Err(found) => panic!("{}", rendered(&found, text)),
    }
}

fn codes(text: &str) -> Vec<&'static str> {
    let model = model(text);
    let told = match run(&model, &model.studies[1], &mut Silent) {
        Ok(result) => result.diagnostics,
        Err(found) => found,
    };
    // `check` says the same, but for what only pieces tell.
    let checked = check(&model).diagnostics;
    let of_pieces = ["pieces-not-moving", "pieces-warned", "no-value", "stopped"];
    for d in told.iter().filter(|d| !of_pieces.contains(&d.code)) {
        assert!(checked.contains(d), "{} is not checked", d.message);
    }
    told.iter().map(|d| d.code).collect()
}

fn near(found: f64, wanted: f64, within: f64) {
    assert!(
        (found - wanted).abs() <= within,
        "{found} for {wanted} +- {within}"
    );
}

/// The part of a normal distribution below a value, by a fine sum.
fn normal_below(x: f64) -> f64 {
    let n = 20_000;
    let step = (x + 10.0) / f64::from(n);
    let density = |t: f64| (-0.5 * t * t).exp() / std::f64::consts::TAU.sqrt();
    let middle = (0..n).map(|k| density(-10.0 + step * (f64::from(k) + 0.5)));
    middle.sum::<f64>() * step
}

fn lines(result: &StudyResult) -> String {
    let all = result.listings.iter();
    let rows = all.map(|l| {
        let rows: Vec<String> = l.rows.iter().map(|r| r.join(" | ")).collect();
        format!("{}\n{}\n{}\n", l.title, l.head.join(" | "), rows.join("\n"))
    });
    rows.collect()
}

/// What is listed of a number's pieces, in its own unit.
fn sampled(result: &StudyResult, name: &str, what: &str) -> f64 {
    let mut all = result.listings.iter();
    let of_pieces = all.find(|l| l.title.starts_with("sampled, "));
    let of_pieces = of_pieces.expect("numbers of all pieces");
    let column = of_pieces.head.iter().position(|head| head == what);
    let row = of_pieces.rows.iter().find(|row| row[0] == name);
    let told = &row.expect("a number")[column.expect("a column")];
    let value = told.split(' ').next().and_then(|it| it.parse().ok());
    value.expect("a value")
}

#[test]
fn a_stroke_of_two_cranks_meets_its_closed_form() {
    let result = found(&slider(
        20.0,
        60.0,
        360.0,
        "vary = { a = \"0.1 mm\" }\ncolumns = [\"range(x(C))\"]\nlimits = [\"range(x(C)) >= 39.9 mm\", \"x(C) <= 80.05 mm\"]\n",
    ));
    let name = "range(x(C))";
    near(scalar(&result, name), 40.0, 1e-9);
    let deviation = 0.2 / 3.0_f64.sqrt();
    near(
        scalar(&result, &format!("{name}, linear deviation")),
        deviation,
        1e-9,
    );
    near(
        scalar(&result, &format!("{name}, deviation")),
        deviation,
        2e-4 * deviation,
    );
    near(scalar(&result, &format!("{name}, mean")), 40.0, 1e-5);
    near(
        scalar(&result, &format!("{name}, worst case least")),
        39.8,
        1e-9,
    );
    near(
        scalar(&result, &format!("{name}, worst case greatest")),
        40.2,
        1e-9,
    );
    // Even from -0.1 to 0.1: good where a differs by -0.05 at least, and by 0.05 at most.
    near(
        scalar(&result, "yield of range(x(C)) >= 39.9 mm"),
        75.0,
        0.05,
    );
    near(scalar(&result, "yield of x(C) <= 80.05 mm"), 75.0, 0.05);
    near(scalar(&result, "yield"), 50.0, 0.05);
    assert!(scalar(&result, "yield at least") < 50.0 && scalar(&result, "yield at most") > 50.0);
    // The extremes of all pieces are near those of the tolerance, and never beyond.
    let least = scalar(&result, &format!("{name}, least"));
    assert!((39.8 - 1e-9..39.801).contains(&least), "{least}");
    assert!(result.diagnostics.is_empty(), "{:?}", result.diagnostics);
    let text = lines(&result);
    assert!(!text.contains("linear and sampled part"), "{text}");
}

#[test]
fn a_sum_of_even_and_normal_lengths_meets_its_closed_form() {
    let result = found(&slider(
        20.0,
        60.0,
        360.0,
        "vary = { a = { uniform = \"0.1 mm\" }, b = { normal = \"0.05 mm\" } }\ncolumns = [\"max(x(C))\"]\nlimits = [\"max(x(C)) <= 80.1 mm\"]\nsamples = 65536\n",
    ));
    let name = "max(x(C))";
    let deviation = (0.01_f64 / 3.0 + 0.0025).sqrt();
    near(
        scalar(&result, &format!("{name}, linear deviation")),
        deviation,
        1e-9,
    );
    near(
        scalar(&result, &format!("{name}, deviation")),
        deviation,
        1e-4 * deviation,
    );
    // Three deviations of what is normal.
    near(
        scalar(&result, &format!("{name}, worst case greatest")),
        80.25,
        1e-9,
    );
    let n = 400;
    let parts = (0..n)
        .map(|k| normal_below((0.1 - (-0.1 + 0.2 * (f64::from(k) + 0.5) / f64::from(n))) / 0.05));
    let wanted = 100.0 * parts.sum::<f64>() / f64::from(n);
    near(scalar(&result, "yield"), wanted, 0.03);
    let text = lines(&result);
    let place = text
        .find("contributions to max(x(C))")
        .expect("contributions");
    // 0.01 / 3 of 0.01 / 3 + 0.0025.
    assert!(
        text[place..].contains("a | ± 0.1 mm | 1 mm/mm | 0.057735 mm | 57.14 %"),
        "{text}"
    );
    assert!(
        text[place..].contains("b | normal 0.05 mm | 1 mm/mm | 0.05 mm | 42.86 %"),
        "{text}"
    );
}

#[test]
fn deviations_to_one_side_shift_the_mean() {
    let result = found(&slider(
        20.0,
        60.0,
        360.0,
        "vary = { a = { between = [\"0 mm\", \"0.3 mm\"] } }\ncolumns = [\"range(x(C))\"]\n",
    ));
    near(scalar(&result, "range(x(C)), linear mean"), 40.3, 1e-9);
    near(scalar(&result, "range(x(C)), mean"), 40.3, 1e-4);
    near(scalar(&result, "range(x(C)), worst case least"), 40.0, 1e-9);
    near(
        scalar(&result, "range(x(C)), worst case greatest"),
        40.6,
        1e-9,
    );
    near(
        scalar(&result, "range(x(C)), linear deviation"),
        0.3 / 3.0_f64.sqrt(),
        1e-9,
    );
}

#[test]
fn near_a_dead_point_the_sampled_answer_meets_a_dense_one_and_parts_from_the_linear() {
    let result = found(&slider(
        50.0,
        51.0,
        90.0,
        "vary = { a = \"0.3 mm\", b = \"0.3 mm\" }\ncolumns = [\"at(x(C), motor, 90)\"]\nlimits = [\"at(x(C), motor, 90) >= 8 mm\"]\nsamples = 16384\n",
    ));
    let name = "at(x(C), motor, 90)";
    let height = |a: f64, b: f64| (b * b - a * a).sqrt();
    let n = 1000;
    let at = |k: i32| 0.6 * (f64::from(k) + 0.5) / f64::from(n) - 0.3;
    let all = (0..n).flat_map(|i| (0..n).map(move |j| [50.0 + at(i), 51.0 + at(j)]));
    let mut all: Vec<f64> = all.map(|[a, b]| height(a, b)).collect();
    all.sort_unstable_by(f64::total_cmp);
    let count = all.len() as f64;
    let mean = all.iter().sum::<f64>() / count;
    let square = all.iter().map(|h| h * h).sum::<f64>() / count;
    let deviation = (square - mean * mean).sqrt();
    near(
        scalar(&result, &format!("{name}, mean")),
        mean,
        1e-4 * deviation,
    );
    near(
        scalar(&result, &format!("{name}, deviation")),
        deviation,
        2e-4 * deviation,
    );
    let good = all.iter().filter(|h| **h >= 8.0).count() as f64;
    assert!(good < count);
    near(scalar(&result, "yield"), 100.0 * good / count, 0.03);
    for (part, below) in [("5 %", 0.05), ("50 %", 0.5), ("95 %", 0.95)] {
        let wanted = all[(below * count) as usize];
        near(sampled(&result, name, part), wanted, 2e-3 * deviation);
    }
    let slope = [50.0, 51.0].map(|x| 0.3 / 3.0_f64.sqrt() * x / height(50.0, 51.0));
    let linear = (slope[0] * slope[0] + slope[1] * slope[1]).sqrt();
    near(
        scalar(&result, &format!("{name}, linear deviation")),
        linear,
        1e-9,
    );
    assert!(
        lines(&result).contains("where linear and sampled part"),
        "{}",
        lines(&result)
    );
    assert!(mean < height(50.0, 51.0));
}

#[test]
fn pieces_that_cannot_be_assembled_are_bad_and_told() {
    let text = slider(
        50.0,
        51.0,
        90.0,
        "vary = { a = \"1.5 mm\" }\ncolumns = [\"at(x(C), motor, 90)\"]\nlimits = [\"max(x(C)) >= 100 mm\"]\n",
    );
    let result = found(&text);
    // A crank longer than the rod does not get there: a third of a millimetre and a half of three.
    near(
        scalar(&result, "pieces that do not move") / 10_000.0,
        1.0 / 6.0,
        1e-3,
    );
    // a + b >= 100 is kept by a >= 49, from 48.5 on.
    near(scalar(&result, "yield"), 100.0 * (1.0 - 2.0 / 6.0), 0.1);
    assert_eq!(codes(&text), ["pieces-not-moving"]);
    let told = &result.diagnostics[0];
    assert!(
        told.notes.iter().any(|note| note.contains("motor")),
        "{told:?}"
    );
}

/// A number that some pieces have not is told with how many these are: its mean is that of the others.
#[test]
fn pieces_without_a_value_are_counted() {
    // The stroke of a slider-crank is twice its crank: half of the pieces have more than 40 mm.
    let root = "sqrt(40 - range(x(C))/(1 mm))";
    let study = format!("vary = {{ a = \"1 mm\" }}\nsamples = 400\ncolumns = [\"{root}\"]");
    let text = slider(20.0, 50.0, 360.0, &study);
    assert_eq!(codes(&text), ["no-value"]);
    let result = found(&text);
    let missing = scalar(&result, &format!("{root}, pieces without a value"));
    near(missing, 200.0, 4.0);
    // Of the others the root is that of twice what the crank lacks, even from 0 to 1 mm.
    near(
        scalar(&result, &format!("{root}, mean")),
        2.0_f64.sqrt() * 2.0 / 3.0,
        0.01,
    );
}

/// A limit may be written from either side, and is shown and counted alike.
#[test]
fn limits_may_begin_with_a_number() {
    let of = |limit: &str| {
        let study = format!("vary = {{ a = \"1 mm\" }}\nsamples = 400\nlimits = [\"{limit}\"]");
        let result = found(&slider(20.0, 50.0, 360.0, &study));
        let good = scalar(&result, &format!("yield of {limit}"));
        let marks: Vec<String> = result.figures.iter().map(|f| format!("{f:?}")).collect();
        let numbers: Vec<String> = result.scalars.iter().map(|s| s.name.clone()).collect();
        let of_number = numbers.into_iter().filter(|name| name.contains("mean"));
        (
            good,
            of_number.collect::<Vec<_>>(),
            marks.join("").replace(limit, "LIMIT"),
        )
    };
    let plain = of("range(x(C)) <= 40.5 mm");
    assert_eq!(plain, of("40.5 mm >= range(x(C))"));
    let of_limit: Vec<&String> = plain
        .1
        .iter()
        .filter(|name| name.contains("range"))
        .collect();
    assert_eq!(of_limit, ["range(x(C)), mean", "range(x(C)), linear mean"]);
    near(plain.0, 62.5, 1.0);
}

#[test]
fn lanes_tell_what_motions_tell() {
    let numbers = "columns = [\"range(angle(rocker))\", \"min(transmission_angle(C))\", \"max(y(P))\", \"mean(angle(rocker))\", \"at(distance(A, P), motor, 77)\", \
                   \"max(angle(rocker, coupler)) + 2 rad * min(distance(P, A -> D)) / d\", \"max(d(angle(rocker), motor))\"]\n";
    let text = four_bar(&format!("{LENGTHS}samples = 200\n{numbers}"));
    let result = found(&text);
    assert!(
        scalar(&result, "lanes differ by") < 0.01,
        "{}",
        lines(&result)
    );
    assert!(
        !lines(&result).contains("each piece moved by itself"),
        "{}",
        lines(&result)
    );
    // The same numbers, as ones that no lanes tell.
    let followed = text.replace(
        "columns = [\"range(angle(rocker))\"",
        "columns = [\"range(angle(rocker)) * time_ratio(angle(rocker))^0\"",
    );
    let followed = found(&followed);
    let name = "range(angle(rocker))";
    let other = format!("{name} * time_ratio(angle(rocker))^0");
    for what in ["mean", "deviation", "least", "greatest"] {
        let [lanes, moved] = [(&result, name), (&followed, other.as_str())]
            .map(|(result, name)| scalar(result, &format!("{name}, {what}")));
        near(lanes, moved, 1e-6);
    }
    assert!(lines(&followed).contains("each piece moved by itself"));
    // And nearly linear ones.
    for number in [
        "min(transmission_angle(C))",
        "max(y(P))",
        "mean(angle(rocker))",
    ] {
        let of = |what: &str| scalar(&result, &format!("{number}, {what}"));
        near(
            of("deviation"),
            of("linear deviation"),
            0.05 * of("deviation"),
        );
        near(of("mean"), of("linear mean"), 0.05 * of("deviation"));
    }
}

#[test]
fn bands_lie_about_the_files_own_design() {
    let result = found(&four_bar(&format!(
        "{LENGTHS}samples = 500\nplot = [\"angle(rocker)\"]\n"
    )));
    let table = &result.table;
    assert_eq!((table.rows(), result.frames.len()), (73, 73));
    let column = |what: &str| {
        &table
            .column(&format!("angle(rocker), {what}"))
            .expect("a column")
            .values
    };
    let own = &table.column("angle(rocker)").expect("a column").values;
    for row in 0..table.rows() {
        let bands = ["least", "5 %", "95 %", "greatest"].map(|what| column(what)[row]);
        assert!(
            bands.is_sorted() && bands[0] < own[row] && own[row] < bands[3],
            "{row}: {bands:?} {}",
            own[row]
        );
    }
    assert!(result.figures.len() >= 2);
}

/// Places and parts of Gauss's quadratures with five places: of what is even from -1 to 1, and of what is normal with a deviation of 1. (M. Abramowitz and
/// I. A. Stegun, 1964, tables 25.4 and 25.10.) They are exact for polynomials of degree 9.
const EVEN: [[f64; 2]; 5] = [
    [-0.906_179_845_938_664, 0.118_463_442_528_095],
    [-0.538_469_310_105_683, 0.239_314_335_249_683],
    [0.0, 0.284_444_444_444_444],
    [0.538_469_310_105_683, 0.239_314_335_249_683],
    [0.906_179_845_938_664, 0.118_463_442_528_095],
];
const NORMAL: [[f64; 2]; 5] = [
    [-2.856_970_013_872_806, 0.011_257_411_327_721],
    [-1.355_626_179_974_266, 0.222_075_922_005_613],
    [0.0, 0.533_333_333_333_333],
    [1.355_626_179_974_266, 0.222_075_922_005_613],
    [2.856_970_013_872_806, 0.011_257_411_327_721],
];

/// A length and a coefficient of friction that differ, against what the study of forces alone tells of designs set by hand: five values of each, weighed by
/// Gauss, and differences.
#[test]
fn forces_and_friction_are_followed_piece_by_piece() {
    let most = "max(torque(motor))";
    let text = four_bar(&format!("vary = {{ a = \"0.5 mm\", mu = {{ normal = \"0.05\" }} }}\nsamples = 500\ncolumns = [\"{most}\"]\n"))
        .replace("idle = \"1 mm\"\n", "mu = \"0.3\"\n")
        .replace("rocker = { D-C = \"c\" }", "rocker = { D-C = \"c\", mass = 1, inertia = \"1e-3 kg m^2\" }")
        .replace("kind = \"motion\"\nstep = 5\ncolumns = [\"angle(rocker)\", \"y(P)\"]", "kind = \"forces\"\nstep = 20\ncolumns = [\"torque(motor)\"]")
        + &format!("[friction]\nD = {{ coefficient = \"mu\", radius = \"20 mm\" }}\n[measures]\nmost = \"{most}\"\n");
    let result = found(&text);
    let of = |what: &str| scalar(&result, &format!("{most}, {what}"));
    let alone = |a: f64, mu: f64| {
        let set = [("a", format!("{a} mm")), ("mu", format!("{mu}"))];
        let set = set.map(|(name, value)| (name.to_owned(), value));
        let read = Model::from_toml_with(&text, "test", &mut |_| Err(String::new()), &set);
        let model = read.expect("a model").model;
        let told = run(&model, &model.studies[0], &mut Silent).expect("a result");
        scalar(&told, "most")
    };
    let slopes = [
        (alone(20.001, 0.3) - alone(19.999, 0.3)) / 0.002 * 0.5 / 3.0_f64.sqrt(),
        (alone(20.0, 0.3001) - alone(20.0, 0.2999)) / 0.0002 * 0.05,
    ];
    let linear = slopes.iter().map(|s| s * s).sum::<f64>().sqrt();
    // Both count.
    assert!(slopes.iter().all(|s| s.abs() > 0.2 * linear), "{slopes:?}");
    near(of("linear deviation"), linear, 1e-6 * linear);
    near(of("linear mean"), alone(20.0, 0.3), 1e-9);
    let (mut mean, mut square) = (0.0, 0.0);
    for [u, part] in EVEN {
        for [v, of_normal] in NORMAL {
            let value = alone(20.0 + 0.5 * u, 0.3 + 0.05 * v);
            mean += part * of_normal * value;
            square += part * of_normal * value * value;
        }
    }
    let deviation = (square - mean * mean).sqrt();
    near(of("mean"), mean, 5e-3 * deviation);
    near(of("deviation"), deviation, 1e-2 * deviation);
    assert!(lines(&result).contains("each piece moved by itself: max(torque(motor))"));
}

/// Along the motion the least of a measure is that of a number at the same place, and it is told where pieces were not all followed for it.
#[test]
fn bands_are_those_of_all_pieces() {
    let forces = |number: &str| {
        let text = four_bar(&format!(
            "{LENGTHS}samples = 500\ncolumns = [\"{number}\"]\n"
        ));
        let text = text.replace("[\"angle(rocker)\", \"y(P)\"]", "[\"torque(motor)\"]");
        let text = text.replace(
            "kind = \"motion\"\nstep = 5",
            "kind = \"forces\"\nstep = 20",
        );
        found(&(text + "[loads]\ntool = { torque = \"-10 N m\", on = \"rocker\" }\n"))
    };
    let number = "at(torque(motor), motor, 40 deg)";
    let result = forces(number);
    for what in ["least", "greatest"] {
        let band = result.table.column(&format!("torque(motor), {what}"));
        let along = band.expect("a band").values[2];
        let alone = scalar(&result, &format!("{number}, {what}"));
        near(along, alone, 1e-9 * alone.abs());
    }
    assert!(!lines(&result).contains("along the motion"));
    let told = "the band of torque(motor) along the motion is that of the first 256 pieces";
    assert!(lines(&forces("range(angle(rocker))")).contains(told));
}

/// What a number of the file's own design is warned of elsewhere, it is here.
#[test]
fn numbers_are_warned_of() {
    let there = "columns = [\"at(angular_speed(rocker), motor, 90 deg)\"]\nvary = { a = \"0.1 mm\" }\nsamples = 20";
    let text = four_bar(there);
    let goes_back = "law = [{ rise = 120, in = \"1 s\" }, { fall = 60, in = \"2 s\" }]";
    let text = text.replace("to = 360, speed = \"1 rad/s\"", goes_back);
    let text = text.replace("step = 5", "rows = 37");
    assert_eq!(codes(&text), ["passed-again", "few-pieces"]);
}

#[test]
fn threads_change_no_bit_and_another_seed_does() {
    let text = four_bar(&format!("{LENGTHS}samples = 3000\ncolumns = [\"range(angle(rocker))\", \"time_ratio(angle(rocker))\"]\n"))
        .replace("samples = 3000", "samples = 700");
    let model = model(&text);
    let told = |result: StudyResult| {
        format!(
            "{:?}",
            (
                result.scalars,
                result.table,
                result.figures,
                result.listings
            )
        )
    };
    let one = told(run_with(&model, &model.studies[1], &Serial, &mut Silent).expect("a result"));
    for threads in [1, 2, 3] {
        let other = run_with(&model, &model.studies[1], &Threads(threads), &mut Silent);
        assert!(one == told(other.expect("a result")), "{threads} threads");
    }
    assert!(
        one != told(found(
            &text.replace("over = \"turn\"", "over = \"turn\"\nseed = 2")
        ))
    );
}

/// What is 0 but for rounding has no parameter that it comes from, and the file's own value is the one that its study tells.
#[test]
fn what_is_rounding_is_ranked_by_nothing() {
    let text = four_bar(&format!(
        "{LENGTHS}samples = 8\ncolumns = [\"max(distance(A, B) - a)\", \"min(abs(x(P) - 30 mm))\", \"max(y(P))\"]\n"
    ));
    let result = found(&text);
    let of = |name: &str| {
        let title = format!("contributions to {name}");
        let mut all = result.listings.iter();
        all.find(|l| l.title == title).map(|l| l.rows.clone())
    };
    for name in ["max(distance(A, B) - a)", "min(abs(x(P) - 30 mm))"] {
        let told = of(name);
        let rounding =
            told.is_none_or(|rows| rows == [["none: to first order it differs by rounding alone"]]);
        assert!(rounding, "{name}: {}", lines(&result));
    }
    assert!(of("max(y(P))").unwrap().len() > 1);
    // Nor has its worst case values with which it is.
    let mut listings = result.listings.iter();
    let worst = listings
        .find(|l| l.title.starts_with("worst case"))
        .unwrap();
    for (row, named) in worst.rows.iter().zip([false, false, true]) {
        let with = [&row[3], &row[6]];
        assert!(with.iter().all(|it| it.is_empty() != named), "{row:?}");
    }
    assert!(scalar(&result, "min(abs(x(P) - 30 mm))") >= 0.0);
}

#[test]
fn a_study_that_is_stopped_keeps_its_pieces() {
    let text = four_bar(&format!(
        "{LENGTHS}samples = 100000\ncolumns = [\"max(y(P))\"]\n"
    ));
    let model = model(&text);
    let mut stop = |stage: Stage, done: Done| match (stage, done) {
        (Stage::Rows, Done::Of(_, 100_000)) => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    };
    let result = run(&model, &model.studies[1], &mut stop).expect("a result");
    let pieces = scalar(&result, "pieces");
    assert!(result.interrupted() && (1.0..100_000.0).contains(&pieces));
    assert!(lines(&result).contains(&format!("stopped at {pieces} of 100000 pieces")));
    assert_eq!(result.how_far(), Some(format!("{pieces} of 100000 pieces")));
    assert_eq!(result.demanded_rows, result.table.rows());
    // The first of all.
    let whole = found(&text.replace("100000", &format!("{pieces}")));
    assert_eq!(
        scalar(&result, "max(y(P)), mean"),
        scalar(&whole, "max(y(P)), mean")
    );
    // In the middle of a piece that is moved by itself, it is those before it.
    let text = text.replace("[\"max(y(P))\"]", "[\"max(y(P))\", \"mean(speed(P))\"]");
    let model = self::model(&text);
    let mut until = Impatient::after(20_000);
    let result = run(&model, &model.studies[1], &mut until).expect("a result");
    let pieces = scalar(&result, "pieces");
    assert!(result.interrupted() && (1.0..100_000.0).contains(&pieces));
    let whole = found(&text.replace("100000", &format!("{pieces}")));
    for name in ["max(y(P)), mean", "mean(speed(P)), mean"] {
        assert_eq!(scalar(&result, name), scalar(&whole, name));
    }
    // Before there is any, there is nothing.
    let mut at_once = |_: Stage, _: Done| ControlFlow::Break(());
    let refused = run(&model, &model.studies[1], &mut at_once).expect_err("nothing yet");
    assert_eq!(refused[0].code, "stopped");
}

/// A crank-rocker that turns only while its crank is no longer than 600 mm.
fn near_its_change_point(a: f64, by: f64, study: &str) -> String {
    format!(
        "units = {{ length = \"mm\", angle = \"deg\" }}\n[parameters]\na = \"{a} mm\"\n\
         [links]\nframe = {{ A = [0, 0], D = [1200, 0] }}\ncrank = {{ A-B = \"a\" }}\ncoupler = {{ B-C = 1000 }}\nrocker = {{ D-C = 800 }}\n\
         [drives]\nmotor = {{ turns = \"crank\", from = 1, to = 361, speed = \"1 rad/s\" }}\n[assembly]\nC = \"left of B -> D\"\n\
         [studies.turn]\nkind = \"motion\"\nstep = 2\ncolumns = [\"angle(rocker)\"]\n\
         [studies.pieces]\nkind = \"tolerance\"\nover = \"turn\"\nvary = {{ a = \"{by} mm\" }}\n{study}\n"
    )
}

#[test]
fn pieces_that_lock_between_the_rows_do_not_move() {
    for (a, by, study) in [
        (
            599.98,
            0.04,
            "columns = [\"min(angle(rocker))\"]\nplot = [\"angle(rocker)\"]",
        ),
        (
            599.98,
            0.04,
            "columns = [\"at(angle(rocker), motor, 90 deg)\"]",
        ),
        (599.0, 2.0, "columns = [\"max(angle(rocker))\"]"),
    ] {
        let result = found(&near_its_change_point(
            a,
            by,
            &format!("samples = 400\n{study}"),
        ));
        let bad = scalar(&result, "pieces that do not move");
        assert!((bad - 100.0).abs() <= 1.0, "{bad} of 400 pieces at {a} mm");
    }
    let limit = "limits = [\"max(angle(rocker)) <= 180 deg\"]\nsamples = 400";
    let result = found(&near_its_change_point(599.0, 2.0, limit));
    near(scalar(&result, "yield"), 75.0, 1.0);
}

/// What a study warns of in a piece is told: a pin that leaves its slot.
#[test]
fn pieces_are_warned_of_what_their_study_warns_of() {
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\na = \"20 mm\"\n\
        [links]\nframe = { A = [0, 0], E = [63.486229709906326, 39.84778792366982], F = [24.04823814803332, 17.534845871563093] }\n\
        crank = { A-B = \"a\" }\ncoupler = { B-C = 50 }\n[joints]\nslot = { pin = \"C\", arc = \"E -> F\", radius = 40 }\n\
        [drives]\nmotor = { turns = \"crank\", from = 0, to = 360, speed = \"1 rad/s\" }\n[assembly]\nC = \"left of B -> E\"\n\
        [studies.turn]\nkind = \"motion\"\nstep = 5\ncolumns = [\"x(C)\"]\n\
        [studies.pieces]\nkind = \"tolerance\"\nover = \"turn\"\nvary = { a = \"1 mm\" }\nsamples = 200\n";
    let told = found(text).diagnostics;
    let told = told
        .iter()
        .find(|d| d.code == "pieces-warned")
        .expect("a warning");
    // Those longer than 20.24 mm: 38 %.
    let count = told
        .message
        .split("`: ")
        .nth(1)
        .and_then(|it| it.split(' ').next());
    let count: f64 = count.and_then(|it| it.parse().ok()).unwrap_or(f64::NAN);
    near(count / 32.0, 0.38, 0.06);
    assert!(told.message.contains("leaves-slot"), "{}", told.message);
}

/// The size of what passes nothing has a corner there, in some pieces alone.
#[test]
fn pieces_with_a_corner_of_their_own_are_followed() {
    let study = "vary = { a = \"0.1 mm\" }\nsamples = 1000\n\
        columns = [\"min(abs(angle(rocker) - 153.716 deg))\"]\nlimits = [\"abs(angle(rocker) - 153.716 deg) >= 0.001 deg\"]";
    let result = found(&four_bar(study));
    // The greatest angle of the rocker, by the law of cosines where crank and coupler lie in line.
    let top = |a: f64| {
        let reach: f64 = 50.0 - a;
        180.0
            - ((40.0_f64.powi(2) + 60.0_f64.powi(2) - reach * reach) / 4800.0)
                .acos()
                .to_degrees()
    };
    let pieces = 100_000;
    let good = (0..pieces).filter(|k| {
        let a = 19.9 + 0.2 * (f64::from(*k) + 0.5) / f64::from(pieces);
        top(a) <= 153.715
    });
    let wanted = good.count() as f64 / f64::from(pieces);
    near(scalar(&result, "yield"), 100.0 * wanted, 0.3);
    let least = "min(abs(angle(rocker) - 153.716 deg)), least";
    assert!(scalar(&result, least) >= 0.0);
}

/// Pieces whose links start on both sides of half a turn are counted alike.
#[test]
fn angles_that_start_about_half_a_turn_do_not_jump_from_piece_to_piece() {
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\ne = \"0 mm\"\n\
        [links]\nframe = { A = [0, 0], E = [0, \"e\"], F = [-200, \"e\"] }\ncrank = { A-B = 30 }\nrod = { B-C = 100 }\npiston = { C = [0, 0] }\n\
        [joints]\nbore = { slider = \"piston\", at = \"C\", on = \"E -> F\" }\n\
        [drives]\nmotor = { turns = \"crank\", from = 180, to = 540, speed = \"1 rad/s\" }\n[assembly]\nC = { near = [-130, 0] }\n\
        [studies.turn]\nkind = \"motion\"\nstep = 5\ncolumns = [\"angle(rod)\"]\n\
        [studies.pieces]\nkind = \"tolerance\"\nover = \"turn\"\nvary = { e = \"0.1 mm\" }\nsamples = 300\n\
        columns = [\"max(angle(rod))\", \"max(speed(C))\"]\nplot = [\"angle(rod)\"]";
    let result = found(text);
    // asin((r + e) / l) beyond half a turn.
    let swing = (30.0_f64 / 100.0).asin().to_degrees();
    let mean = scalar(&result, "max(angle(rod)), mean");
    near(mean.abs(), 180.0 + swing * mean.signum(), 1e-3);
    let deviation = (0.1_f64 / 100.0 / (1.0 - 0.09_f64).sqrt()).to_degrees() / 3.0_f64.sqrt();
    near(
        scalar(&result, "max(angle(rod)), deviation"),
        deviation,
        1e-2 * deviation,
    );
}

#[test]
fn what_makes_no_sense_is_told() {
    let few = four_bar(
        "vary = { a = \"0.1 mm\", idle = \"0.1 mm\" }\nsamples = 20\ncolumns = [\"max(y(P))\"]\nlimits = [\"max(y(P)) >= 100 mm\"]\n",
    );
    assert_eq!(
        codes(&few),
        ["limit-not-kept", "idle-parameter", "few-pieces"]
    );
    let beyond = four_bar("vary = { a = \"0.1 mm\" }\n").replace("a = \"20 mm\"", "a = \"45 mm\"");
    assert!(!codes(&beyond).is_empty());
    // Too many pieces to be held.
    let many = model(&four_bar(
        "vary = { a = \"0.1 mm\" }\nsamples = 100000000\n",
    ));
    let refused = run(&many, &many.studies[1], &mut Silent).expect_err("no room");
    assert_eq!(refused[0].code, "too-large");
}

/// A parallelogram lift does not tilt: whatever changes of its lengths tilts it, and where most hangs on which way they change.
const LIFT: &str = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\nuy = \"250 mm\"\n\
    [links]\nframe = { A = [0, 0], D = [0, \"uy\"] }\nlower = { A-B = 350 }\nupper = { D-C = 350 }\nplatform = { B-C = 250 }\n\
    [drives]\nlift = { turns = \"lower\", from = -12, to = 12, speed = \"10 deg/s\" }\n\
    [assembly]\nC = \"left of D -> B\"\nplatform = { near = 90 }\n\
    [measures]\ntilt = \"range(angle(platform))\"\nlong = \"max(distance(B, C))\"\n[studies.go]\nkind = \"motion\"\nstep = 1\n";

#[test]
fn what_is_level_all_along_has_no_derivative_of_its_range() {
    let result = found(&format!(
        "{LIFT}[studies.t]\nkind = \"tolerance\"\nover = \"go\"\nvary = {{ uy = \"0.5 mm\" }}\ncolumns = [\"tilt\", \"long\"]\nsamples = 500\n"
    ));
    let told = lines(&result);
    assert!(told.contains("has no derivatives here"), "{told}");
    // By a grid of closed forms, 0.097429 deg/mm either way: evenly drawn pieces deviate by 0.014063 deg.
    near(scalar(&result, "tilt, deviation"), 0.01406, 2e-4);
    // A length that stays what it is has one: none.
    near(scalar(&result, "long, linear deviation"), 0.0, 1e-12);
}

/// What lies on a stop keeps a limit there, whatever rounding makes of it.
#[test]
fn limits_at_a_stop_are_kept() {
    let result = found(
        "units = { length = \"mm\" }\n[parameters]\nh = \"100 mm\"\n\
        [links]\nframe = { O = [0, 0], X = [0, 500] }\nram = { A = [0, 0], mass = \"2 kg\", inertia = 0 }\n\
        [joints]\nguide = { slider = \"ram\", at = \"A\", on = \"O -> X\" }\n\
        [drives]\nfall = { slides = \"ram\", at = \"h\" }\n\
        [studies.go]\nkind = \"simulate\"\nuntil = \"0.3 s\"\nrows = 31\nstops = { fall = { between = [0, \"none\"], restitution = 0.5 } }\n\
        [studies.t]\nkind = \"tolerance\"\nover = \"go\"\nvary = { h = \"5 mm\" }\nsamples = 40\nlimits = [\"fall >= 0 mm\"]\n",
    );
    assert!(result.diagnostics.is_empty(), "{:?}", result.diagnostics);
    near(scalar(&result, "yield"), 100.0, 1e-12);
}

/// The stroke of a slider-crank whose guide is off by up to 2 mm, its crank's turn begun at the dead point of the aligned one: the peak of a piece lies
/// beside one end of the turn or beside the other, which are the same pose.
#[test]
fn peaks_on_both_sides_of_a_closed_turn_are_seen() {
    let (a, b) = (37.0, 92.0_f64);
    let text = slider(
        a,
        b,
        360.0,
        "vary = { e = \"2 mm\" }\ncolumns = [\"max(x(C))\", \"range(x(C))\"]\nsamples = 8192\n",
    )
    .replace("[links]", "e = \"0 mm\"\n[links]")
    .replace(
        "E = [0, 0], F = [100, 0]",
        "E = [0, \"e\"], F = [100, \"e\"]",
    );
    let result = found(&text);
    let ends = |e: f64| {
        let at = |r: f64| (r * r - e * e).sqrt();
        (at(a + b), at(a + b) - at(b - a))
    };
    let count = 100_000;
    let all: Vec<(f64, f64)> = (0..count)
        .map(|k| ends(-2.0 + 4.0 * (f64::from(k) + 0.5) / f64::from(count)))
        .collect();
    let of = |which: fn(&(f64, f64)) -> f64| {
        let mean = all.iter().map(which).sum::<f64>() / f64::from(count);
        let square = |x: f64| (x - mean) * (x - mean);
        let variance = all.iter().map(|x| square(which(x))).sum::<f64>() / f64::from(count);
        (mean, variance.sqrt())
    };
    for (name, (mean, deviation)) in [("max(x(C))", of(|x| x.0)), ("range(x(C))", of(|x| x.1))] {
        let told = |what: &str| scalar(&result, &format!("{name}, {what}"));
        near(told("mean") - mean, 0.0, 2e-3 * deviation);
        near(told("deviation") / deviation, 1.0, 2e-3);
    }
}

/// A rocker that starts just short of half a turn, at 20 teeth on a wheel of 30. Some pieces start beyond it: their wheels mesh all the same as
/// that of the file's own, in tolerances and in families.
#[test]
fn pieces_mesh_like_the_file_s_own() {
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\nb = \"34.6 mm\"\n\
        [links]\nframe = { A = [0, 0], D = [60, 0], V = [60, -50] }\ncrank = { A-B = 40 }\ncoupler = { B-C = \"b\" }\n\
        rocker = { D-C = 40 }\nwheel = { V-T = 20 }\n[joints]\nmesh = { gears = [\"rocker\", \"wheel\"], teeth = [20, 30] }\n\
        [drives]\nmotor = { turns = \"crank\", from = 60, to = 70, speed = \"60 rpm\" }\n[assembly]\nC = \"right of B -> D\"\n\
        [studies.turn]\nkind = \"motion\"\n\
        [studies.pieces]\nkind = \"tolerance\"\nover = \"turn\"\nvary = { b = \"0.2 mm\" }\nsamples = 200\n\
        columns = [\"min(angle(rocker))\", \"max(y(T))\"]\nlimits = [\"max(y(T)) <= -60 mm\"]\n\
        [studies.family]\nkind = \"sweep\"\nover = \"turn\"\nvary = { b = [\"34.6 mm\", \"34.8 mm\"] }\ncolumns = \"min(angle(rocker))\"\n\
        [studies.best]\nkind = \"optimize\"\nover = \"turn\"\nvary = { b = [\"34.6 mm\", \"34.8 mm\"] }\nmaximize = \"min(angle(rocker))\"\nmethod = \"local\"\n";
    let result = found(text);
    assert_eq!(scalar(&result, "yield"), 100.0);
    // By a four-bar and its wheel on paper: all pieces lie within 0.04 mm of the file's own.
    let ends = ["least", "greatest"].map(|end| scalar(&result, &format!("max(y(T)), {end}")));
    assert!(
        -67.361 < ends[0] && ends[0] < -67.35 && ends[1] > -67.305 && ends[1] < -67.293,
        "{ends:?}"
    );
    let model = model(text);
    let family = run(&model, &model.studies[2], &mut Silent).expect("a result");
    let angles = family.table.column("min(angle(rocker))").expect("a column");
    let values = &angles.values;
    assert!((values[0] - 174.836).abs() < 1e-3 && (values[1] - 175.134).abs() < 1e-3);
    // By itself the second would be counted from -184.866, and its wheel stand elsewhere: it is told, and what to write.
    let told = &family.diagnostics[0];
    assert_eq!(told.code, "designs-warned");
    assert!(
        told.message
            .contains("1 design is warned of `other-assembly`, first number 2")
    );
    assert!(
        told.message.contains("rocker = { near = … }"),
        "{}",
        told.message
    );
    // So it is of the best design, whose file would be.
    let best = run(&model, &model.studies[3], &mut Silent).expect("a result");
    assert!((scalar(&best, "min(angle(rocker))") - 175.134).abs() < 1e-3);
    assert!(
        best.diagnostics
            .iter()
            .any(|d| d.code == "other-assembly" && d.message.contains("rocker = { near = … }"))
    );
}

/// Pieces are put together like the file's own design where `near` hints say little: the start lies 6 mm above the line on which both assemblies
/// meet, and the hint 0.3 mm.
#[test]
fn pieces_are_put_together_like_the_file_s_own() {
    let of = |hint: &str| {
        found(&format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\n[parameters]\nh = \"0 mm\"\n\
             [links]\nframe = {{ A = [0, 0], D = [60, \"h\"] }}\ncrank = {{ A-B = 20 }}\ncoupler = {{ B-C = 41 }}\nrocker = {{ D-C = 40 }}\n\
             [drives]\nmotor = {{ turns = \"crank\", from = 180, to = 270, speed = \"60 rpm\" }}\n[assembly]\nC = {hint}\n\
             [studies.turn]\nkind = \"motion\"\nstep = 3\n\
             [studies.pieces]\nkind = \"tolerance\"\nover = \"turn\"\nvary = {{ h = \"1 mm\" }}\nsamples = 200\n\
             columns = [\"range(angle(rocker))\"]\nlimits = [\"y(C) >= 0 mm\"]\n"
        ))
    };
    let (near, side) = (of("{ near = [20, 0.3] }"), of("\"left of B -> D\""));
    assert_eq!(scalar(&near, "yield"), 100.0);
    for name in [
        "mean",
        "deviation",
        "least",
        "greatest",
        "worst case least",
        "worst case greatest",
    ] {
        let name = format!("range(angle(rocker)), {name}");
        let [a, b] = [&near, &side].map(|it| scalar(it, &name));
        assert!((a - b).abs() < 1e-6, "{name}: {a} {b}");
    }
}

/// The direction of a line that lies at half a turn is counted from there in all pieces: for the pin Q 60 mm to the left, give or take 2 mm.
#[test]
fn directions_are_counted_like_the_file_s_own() {
    let text = four_bar("vary = { idle = \"2 mm\" }\nsamples = 2000\ncolumns = [\"max(angle(A -> Q))\"]\nlimits = [\"abs(angle(A -> Q) - 180 deg) <= 1 deg\"]")
        .replace("D = [\"d\", 0] }", "D = [\"d\", 0], Q = [-60, \"idle\"] }")
        .replace("idle = \"1 mm\"", "idle = \"0 mm\"");
    let result = found(&text);
    assert!((scalar(&result, "max(angle(A -> Q))") - 180.0).abs() < 1e-9);
    let deviation = scalar(&result, "max(angle(A -> Q)), deviation");
    let wanted = (2.0_f64 / 60.0 / 3.0_f64.sqrt()).to_degrees();
    assert!(
        (deviation - wanted).abs() < 1e-3 * wanted,
        "{deviation} {wanted}"
    );
    // Within a degree of half a turn is within 60 tan 1 deg of 2 mm.
    let good = scalar(&result, "yield");
    let wanted = 100.0 * 60.0 * 1.0_f64.to_radians().tan() / 2.0;
    assert!((good - wanted).abs() < 0.3, "{good} {wanted}");
}

/// A bar without weight that is pulled at its tip: the pin's force is against the pull, whose direction differs by 0.1 deg about -0.05 deg.
const PULLED: &str = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\naim = \"-0.05 deg\"\n\
    [links]\nframe = { A = [0, 0] }\ncrank = { A-B = 20 }\n\
    [drives]\nmotor = { turns = \"crank\", from = 0, to = 90, speed = \"1 rad/s\" }\n\
    [loads]\npull = { force = [\"10 N\", \"aim\"], at = \"B\", on = \"crank\" }\n\
    [measures]\nway = \"reaction_angle(A, crank)\"\nmost = \"max(way)\"\nleast = \"min(way)\"\nthere = \"at(way, motor, 30)\"\ntwice = \"2 * there - 100 deg\"\n\
    [studies.turn]\nkind = \"forces\"\nstep = 10\ncolumns = [\"way\"]\n\
    [studies.pieces]\nkind = \"tolerance\"\nover = \"turn\"\nvary = { aim = \"0.1 deg\" }\nsamples = 400\ncolumns = [\"most\", \"least\", \"there\", \"twice\"]\n\
    [studies.family]\nkind = \"sweep\"\nover = \"turn\"\nvary = { aim = [\"-0.15 deg\", \"-0.05 deg\", \"0.05 deg\", \"0.1 deg\"] }\ncolumns = [\"most\", \"there\"]\n";

/// The direction of a force goes on beyond half a turn where the file's own lies just below it: in numbers over the motion, at a place, in formulas,
/// the worst case, the band and families.
#[test]
fn directions_of_forces_are_counted_like_the_file_s_own() {
    let result = found(PULLED);
    for (name, times, less) in [
        ("most", 1.0, 0.0),
        ("least", 1.0, 0.0),
        ("there", 1.0, 0.0),
        ("twice", 2.0, 100.0),
    ] {
        let of = |what: &str| scalar(&result, &format!("{name}, {what}"));
        let at = |angle: f64| times * angle - less;
        near(of("mean"), at(179.95), 1e-3);
        near(of("deviation"), times * 0.1 / 3.0_f64.sqrt(), 1e-3);
        near(of("worst case least"), at(179.85), 1e-9);
        near(of("worst case greatest"), at(180.05), 1e-9);
    }
    for (column, end) in [("way, least", 179.85), ("way, greatest", 180.05)] {
        let column = result.table.column(column).expect("a band");
        assert!(column.values.iter().all(|x| (x - end).abs() < 1e-3));
    }
    let model = model(PULLED);
    let family = run(&model, &model.studies[2], &mut Silent).expect("a result");
    for name in ["most", "there"] {
        let column = family.table.column(name).expect("a column");
        let pairs = column.values.iter().zip([179.85, 179.95, 180.05, 180.1]);
        pairs.for_each(|(x, wanted)| near(*x, wanted, 1e-9));
    }
}

/// A pull that goes round with the bar: the pin's force goes through half a turn on the way, in all pieces at the place where it does in the file's own.
#[test]
fn directions_of_forces_that_go_round_are_those_of_the_same_place() {
    let text = PULLED
        .replace("to = 90", "to = 360")
        .replace("on = \"crank\" }", "axes = \"crank\" }")
        .replace("motor, 30", "motor, 359.98");
    let result = found(&text);
    // 359.98 - 0.05 and half a turn more, without two turns.
    near(scalar(&result, "there"), 179.93, 1e-9);
    near(
        scalar(&result, "there, deviation"),
        0.1 / 3.0_f64.sqrt(),
        1e-3,
    );
    for name in ["most", "least"] {
        let deviation = scalar(&result, &format!("{name}, deviation"));
        assert!(deviation < 0.1, "{name}: {deviation}");
    }
}

/// Numbers right at a corner in the file's own design: their linear answer is none, and what leads along the corner keeps its derivative.
#[test]
fn numbers_at_a_corner_have_no_linear_answer() {
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\ne = \"0 mm\"\nr = \"20 mm\"\n\
        [links]\nframe = { A = [0, 0], E = [0, \"e\"], F = [100, \"e\"] }\ncrank = { A-B = \"r\" }\nrod = { B-C = 60 }\nblock = { C = [0, 0] }\n\
        [joints]\nguide = { slider = \"block\", at = \"C\", on = \"E -> F\" }\n\
        [drives]\nmotor = { turns = \"crank\", from = 0, to = 360, speed = \"1 rad/s\" }\n[assembly]\nC = { near = [80, 0] }\n\
        [measures]\nlean = \"max(abs(angle(rod)))\"\nspan = \"range(abs(angle(rod)))\"\nhigh = \"max(abs(y(C)))\"\naside = \"at(abs(y(C)), motor, 40)\"\n\
        both = \"max(at(y(C), motor, 40), at(x(C) - 80 mm, motor, 0))\"\nsum = \"mean(abs(y(C)))\"\nfine = \"max(abs(y(B)))\"\nswing = \"range(angle(rod))\"\n\
        [studies.turn]\nkind = \"motion\"\nstep = 5\ncolumns = [\"x(C)\"]\n\
        [studies.pieces]\nkind = \"tolerance\"\nover = \"turn\"\nvary = { e = \"2 mm\", r = \"0.1 mm\" }\nsamples = 2000\n\
        columns = [\"lean\", \"span\", \"high\", \"aside\", \"both\", \"sum\", \"fine\", \"swing\"]\n\
        [studies.family]\nkind = \"sweep\"\nover = \"turn\"\ncombine = \"one at a time\"\nvary = { e = { by = \"1 mm\" }, r = { by = \"0.1 mm\" } }\n\
        columns = [\"lean\", \"fine\", \"swing\"]\n";
    let result = found(text);
    let told = |name: &str| {
        let mut all = result.scalars.iter();
        all.any(|s| s.name == format!("{name}, linear deviation"))
    };
    for name in ["lean", "span", "high", "aside", "both", "sum"] {
        assert!(!told(name), "{name}");
    }
    assert!(told("fine") && told("swing"));
    let lines = lines(&result);
    assert_eq!(
        lines.matches("has no derivatives here").count(),
        6,
        "{lines}"
    );
    // By the size of the offset: asin((r + |e|) / l).
    let most = (22.1_f64 / 60.0).asin().to_degrees();
    near(scalar(&result, "lean, worst case greatest"), most, 1e-9);
    // Both peaks of the size are no corner of r, which moves them alike; nor is a range that has one of either kind.
    let model = model(text);
    let family = run(&model, &model.studies[2], &mut Silent).expect("a result");
    let slope = |number: &str, parameter: &str| {
        let mut rows = family.listings.iter().flat_map(|l| &l.rows);
        let row = rows.find(|row| row.len() == 6 && row[0] == number && row[1] == parameter);
        row.expect("a derivative")[2].clone()
    };
    assert_eq!(slope("lean", "e"), "none");
    let by_r = (1.0 / (60.0 * (1.0 - 1.0 / 9.0_f64).sqrt())).to_degrees();
    let value = |text: String| text.parse::<f64>().expect("a number");
    near(value(slope("lean", "r")), by_r, 1e-4);
    near(value(slope("swing", "e")), 0.0, 1e-4);
    near(value(slope("fine", "r")), 1.0, 1e-9);
}

/// A number that shifts in all pieces by much more than it differs from one to the other: what lanes miss of it is held against how it differs.
#[test]
fn what_lanes_miss_is_held_against_the_deviation() {
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\nw = \"2 mm\"\nc = \"5 mm\"\n\
        [links]\nframe = { A = [0, 0] }\ncrank = { A-B = 20 }\n\
        [drives]\nmotor = { turns = \"crank\", from = 0, to = 360, speed = \"1 rad/s\" }\n\
        [measures]\npeak = \"max(20 mm^3 / ((y(B) - c)^2 + w^2))\"\n\
        [studies.turn]\nkind = \"motion\"\nstep = 5\ncolumns = [\"x(B)\"]\n\
        [studies.pieces]\nkind = \"tolerance\"\nover = \"turn\"\n\
        vary = { c = \"0.2 mm\", w = { between = [\"1 mm\", \"1.0001 mm\"] } }\nsamples = 300\ncolumns = [\"peak\"]\n";
    let result = found(text);
    // 20 / w^2 about 3 mm, whatever c is.
    let slope = 40.0 / 27.0;
    let deviation = slope * 1e-4 / 12.0_f64.sqrt();
    near(
        scalar(&result, "peak, deviation"),
        deviation,
        0.01 * deviation,
    );
    let missed = result.scalars.iter().find(|s| s.name == "lanes differ by");
    assert!(missed.is_none_or(|s| s.value <= 5.0), "{missed:?}");
}

/// A number that is the same in nearly all pieces: the first ones, which are all alike, do not tell how it differs.
#[test]
fn lanes_tell_what_is_the_same_in_most_pieces() {
    let text = slider(
        20.0,
        60.0,
        360.0,
        "vary = { a = \"0.1 mm\" }\nsamples = 4000\ncolumns = [\"max(max(x(C), 80.09 mm))\", \"max(x(C)) - a - b\"]",
    );
    let result = found(&text);
    // Above 80.09 mm lies a part of one in twenty of a, evenly up to 0.01 mm.
    let [part, top] = [0.05, 0.01];
    let mean = 80.09 + part * top / 2.0;
    near(
        scalar(&result, "max(max(x(C), 80.09 mm)), mean"),
        mean,
        1e-5,
    );
    let square = part * top * top / 3.0 - (mean - 80.09) * (mean - 80.09);
    near(
        scalar(&result, "max(max(x(C), 80.09 mm)), deviation"),
        square.sqrt(),
        1e-5,
    );
    let lines = lines(&result);
    assert!(!lines.contains("each piece moved by itself"), "{lines}");
}

/// A pin starts between the ends of its slot: pieces in which it would not are none that move, though their loops close.
#[test]
fn pieces_whose_pin_starts_beyond_its_slot_do_not_move() {
    let text = "units = { length = 'mm', angle = 'deg' }\n[parameters]\nr = '20 mm'\n[links]\nframe = { O = [0, 0], D = [70, 0] }\n\
                crank = { O-B = 'r' }\nplate = { D = [0, 0], A1 = [-100, 0], A2 = [-80, 6], A3 = [-60, 6], A4 = [-48, 0] }\n[joints]\n\
                slot = { pin = 'B', through = ['A1', 'A2', 'A3', 'A4'] }\n[drives]\nmotor = { turns = 'crank', from = 0, to = 360, speed = '60 rpm' }\n\
                [assembly]\nplate = { near = '0 deg' }\n[studies.turn]\nkind = 'motion'\nstep = 10\n[studies.tol]\nkind = 'tolerance'\nover = 'turn'\n\
                samples = 128\nvary = { r = '4 mm' }\ncolumns = ['range(angle(plate))']\n";
    let result = found(text);
    // The slot ends where the crank's pin starts at 70 - 48 mm, hardly more by rounding of the shoe.
    let wanted = 128.0 * (24.0 - 22.03) / 8.0;
    near(scalar(&result, "pieces that do not move"), wanted, 3.0);
}

/// A mean of forces over half a turn from a dead centre changes a little otherwise as the offset grows than as it shrinks: both are told, and the linear
/// answer takes the middle of them.
#[test]
fn where_both_sides_are_nearly_the_same_the_linear_answer_takes_their_middle() {
    let text = |off: &str| {
        format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\n[parameters]\noff = \"{off}\"\n\
             [links]\nframe = {{ A = [0, 0], G = [0, \"off\"], H = [200, \"off\"] }}\ncrank = {{ A-B = 30 }}\nrod = {{ B-C = 100 }}\n\
             [joints]\nslide = {{ pin = \"C\", on = \"G -> H\" }}\n[assembly]\nC = {{ near = [130, 0] }}\n\
             [drives]\nmotor = {{ turns = \"crank\", from = 0, to = 180, speed = \"60 rpm\" }}\n\
             [loads]\nwork = {{ force = [\"-100 N\", \"-40 N\"], at = \"C\" }}\n\
             [friction]\nslide = {{ coefficient = 0.1 }}\nA = {{ coefficient = 0.1, radius = 5 }}\n\
             [measures]\nlost = \"mean(power(motor))\"\n\
             [studies.go]\nkind = \"forces\"\nstep = 30\ncolumns = [\"lost\"]\n\
             [studies.tol]\nkind = \"tolerance\"\nover = \"go\"\nvary = {{ off = \"0.01 mm\" }}\nsamples = 20\ncolumns = [\"lost\"]\n"
        )
    };
    let at = |off: &str| {
        let model = model(&text(off));
        let found = run(&model, &model.studies[0], &mut Silent).unwrap();
        found.table.column("lost").unwrap().values[0]
    };
    let [low, own, high] = ["-0.01 mm", "0 mm", "0.01 mm"].map(at);
    let (grows, shrinks) = ((high - own) / 0.01, (own - low) / 0.01);
    assert!((grows / shrinks - 1.0).abs() > 0.01, "{grows} {shrinks}");
    let model = model(&text("0 mm"));
    let told = kempe_study::sensitivities(&model, None, &mut Silent).unwrap();
    let derivative = &told.measures[0].derivatives[0];
    let sides = derivative.sides.unwrap();
    assert!(derivative.value.is_nan());
    near(sides[0], grows, 1e-3 * grows.abs());
    near(sides[1], shrinks, 1e-3 * shrinks.abs());
    assert!(
        told.to_text().contains(" as it grows, "),
        "{}",
        told.to_text()
    );
    let pieces = run(&model, &model.studies[1], &mut Silent).unwrap();
    let worst = scalar(&pieces, "lost, linear worst case greatest");
    let by = 0.01 * 0.5 * (grows + shrinks).abs();
    near(worst - own, by, 1e-3 * by);
}

/// What is rounding of the lengths that a number is the difference of is told as nothing.
#[test]
fn rounding_is_told_as_nothing() {
    let result = found(
        "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\na = \"20 mm\"\nb = \"51 mm\"\n\
         [links]\nframe = { A = [0, 0], D = [60, 0] }\ncrank = { A-B = \"a\" }\ncoupler = { B-C = \"b\" }\nrocker = { D-C = 40 }\n\
         [drives]\nmotor = { turns = \"crank\", from = 0, to = 90, speed = \"60 rpm\" }\n[assembly]\nC = \"left of B -> D\"\n\
         [measures]\nopen = \"max(distance(B, C) - b) * 1\"\nheight = \"min(y(B))\"\n[studies.go]\nkind = \"motion\"\nstep = 5\n\
         [studies.t]\nkind = \"tolerance\"\nover = \"go\"\nvary = { a = \"0.1 mm\", b = \"0.1 mm\" }\ncolumns = [\"open\", \"height\"]\nsamples = 200\n",
    );
    for number in ["open", "height"] {
        for what in [
            "deviation",
            "least",
            "greatest",
            "linear deviation",
            "worst case least",
        ] {
            assert_eq!(
                scalar(&result, &format!("{number}, {what}")),
                0.0,
                "{number}, {what}"
            );
        }
    }
}
