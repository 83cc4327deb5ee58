//! The worst case of tolerances: closed forms at corners and between them, corners that do not move, play, and samples that never go beyond it.
#![allow(
    clippy::disallowed_methods,
    reason = "numbers found by hand beside ours, not reproducible ones"
)]

use crate::told::scalar;
use kempe_model::Model;
use kempe_study::{Silent, StudyResult, run};

fn found(text: &str) -> StudyResult {
    let read = Model::from_toml(text, "test", &mut |_| Err("no files".into()));
    let model = read.expect("a model").model;
    run(&model, &model.studies[1], &mut Silent).expect("a result")
}

/// A slider-crank without offset: crank a, rod b, a length that nothing is made of, from 0 as far as asked.
fn slider([a, b]: [&str; 2], to: f64, study: &str) -> String {
    format!(
        "units = {{ length = \"mm\", angle = \"deg\" }}\n[parameters]\na = \"{a}\"\nt = \"0 mm\"\nb = \"{b}\"\n\
         [links]\nframe = {{ A = [0, 0], E = [0, 0], F = [100, 0] }}\ncrank = {{ A-B = \"a\" }}\nrod = {{ B-C = \"b\" }}\nblock = {{ C = [0, 0] }}\n\
         [joints]\nguide = {{ slider = \"block\", at = \"C\", on = \"E -> F\" }}\n\
         [drives]\nmotor = {{ turns = \"crank\", from = 0, to = {to}, speed = \"1 rad/s\" }}\n[assembly]\nC = {{ near = [90, 0] }}\n\
         [studies.turn]\nkind = \"motion\"\nstep = 2\ncolumns = [\"x(C)\"]\n\
         [studies.pieces]\nkind = \"tolerance\"\nover = \"turn\"\nsamples = 2000\n{study}\n"
    )
}

fn near(found: f64, wanted: f64, by: f64) {
    assert!((found - wanted).abs() <= by, "{found} instead of {wanted}");
}

/// What stands beside a number among the worst cases: with what it is least, and greatest.
fn with(result: &StudyResult, number: &str) -> [String; 2] {
    let mut all = result.listings.iter();
    let listing = all.find(|l| l.title.starts_with("worst case"));
    let mut rows = listing.expect("worst cases").rows.iter();
    let row = rows.find(|row| row[0] == number).expect("a number");
    [row[3].clone(), row[6].clone()]
}

#[test]
fn corners_meet_their_closed_form_near_a_dead_point() {
    let number = "at(x(C), motor, 90)";
    let result = found(&slider(
        ["50 mm", "51 mm"],
        90.0,
        &format!("vary = {{ a = \"0.4 mm\", b = \"0.4 mm\" }}\ncolumns = [\"{number}\"]"),
    ));
    let height = |a: f64, b: f64| (b * b - a * a).sqrt();
    let told = |what: &str| scalar(&result, &format!("{number}, {what}"));
    near(told("worst case least"), height(50.4, 50.6), 1e-9);
    near(told("worst case greatest"), height(49.6, 51.4), 1e-9);
    assert_eq!(
        with(&result, number),
        ["a = 50.4 mm, b = 50.6 mm", "a = 49.6 mm, b = 51.4 mm"]
    );
    // The linear one, which such a piece may well go beyond.
    let own = height(50.0, 51.0);
    near(
        told("linear worst case least"),
        own - 0.4 * (50.0 + 51.0) / own,
        1e-9,
    );
    assert!(told("least") < told("linear worst case least"));
    assert!(told("worst case least") <= told("least"));
}

/// The rod is longest where its length has no slope, between the ends of what differs.
#[test]
fn what_is_worst_between_the_ends_is_found_there() {
    let number = "max(x(C))";
    let result = found(&slider(
        ["20 mm", "60 mm - (t - 0.1 mm) * (t - 0.1 mm) / (1 mm)"],
        360.0,
        &format!("vary = {{ t = \"0.3 mm\" }}\ncolumns = [\"{number}\"]"),
    ));
    let told = |what: &str| scalar(&result, &format!("{number}, {what}"));
    near(told("worst case greatest"), 80.0, 1e-6);
    near(told("worst case least"), 80.0 - 0.16, 1e-9);
    assert!(told("greatest") <= told("worst case greatest"));
    // In the file's own design it falls by 0.2 mm per mm.
    near(told("linear worst case greatest"), 79.99 + 0.06, 1e-9);
}

/// Even pieces that all move do not say that all within the tolerances do, whatever number is asked: the crank's pin goes by the crank alone, which the rod does
/// not follow where it is short.
#[test]
fn a_worst_case_that_does_not_move_is_told() {
    for number in ["at(x(C), motor, 90)", "max(y(B))"] {
        let vary = "vary = { a = \"0.36 mm\", b = \"0.36 mm\" }";
        let study = format!("{vary}\ncolumns = [\"{number}\"]\nsamples = 40");
        let text = slider(["50 mm", "50.7 mm"], 90.0, &study);
        let result = found(&text.replace("samples = 2000\n", ""));
        let mut scalars = result.scalars.iter();
        assert!(scalars.all(|s| s.name != "pieces that do not move"));
        let mut told = result.diagnostics.iter();
        let told = told.find(|d| d.code == "pieces-not-moving");
        let told = told.expect("a warning");
        let said = "not all that lies within the tolerances";
        assert!(told.message.contains(said), "{}", told.message);
        let mut all = result.listings.iter();
        assert!(all.any(|l| l.title == "worst case, of what moves within the tolerances"));
    }
}

/// At a change point, which one coupler of all meets, the rocker goes on to the other side and swings twice as far: it is left out, and told. The worst is what the
/// couplers beside it come to.
#[test]
fn a_worst_case_is_on_the_branch_of_what_is_beside_it() {
    let result = found(
        "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\nb = \"50 mm\"\n[links]\nframe = { A = [0, 0], D = [60, 0] }\n\
         crank = { A-B = 29.5 }\ncoupler = { B-C = \"b\" }\nrocker = { D-C = 40 }\n\
         [drives]\nmotor = { turns = \"crank\", from = 0, to = 360, speed = \"60 rpm\" }\n[assembly]\nC = \"left of B -> D\"\n\
         [studies.turn]\nkind = \"motion\"\n[studies.pieces]\nkind = \"tolerance\"\nover = \"turn\"\nsamples = 200\n\
         vary = { b = \"0.5 mm\" }\ncolumns = [\"range(angle(rocker))\"]\n",
    );
    // Between the two dead points of a coupler that is longer by no more than rounding.
    let at = |reach: f64| ((40.0 * 40.0 + 60.0 * 60.0 - reach * reach) / 4800.0_f64).acos();
    let swing = at(49.5 + 29.5) - at(49.5 - 29.5);
    let told = scalar(&result, "range(angle(rocker)), worst case greatest");
    near(told, swing.to_degrees(), 0.01);
    let mut all = result.diagnostics.iter();
    let warned = all.find(|d| d.code == "pieces-not-moving");
    let notes = &warned.expect("a warning").notes;
    assert!(notes.iter().any(|note| note.contains("branches cross")));
}

/// What is nothing but for rounding is not sought after.
#[test]
fn rounding_has_the_worst_case_of_its_pieces() {
    let result = found(
        "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\nr = \"30 mm\"\n[links]\nframe = { O = [0, 0], E = [100, 0] }\n\
         crank = { O-B = \"r\" }\nyoke = { Y = [0, 0], S = [0, 45], T = [0, -45] }\n\
         [joints]\nway = { slider = \"yoke\", at = \"Y\", on = \"O -> E\" }\nslot = { pin = \"B\", on = \"T -> S\" }\n\
         [drives]\nmotor = { turns = \"crank\", from = 0, to = 360, speed = \"10 rad/s\" }\n\
         [studies.turn]\nkind = \"motion\"\n[studies.tol]\nkind = \"tolerance\"\nover = \"turn\"\nsamples = 32\n\
         vary = { r = \"0.09 mm\" }\ncolumns = [\"max(travel(yoke) - r * cos(angle(crank)))\"]\n",
    );
    let told = |what: &str| {
        let name = format!("max(travel(yoke) - r * cos(angle(crank))), {what}");
        scalar(&result, &name)
    };
    assert_eq!(told("worst case greatest"), told("greatest"));
    assert_eq!(told("worst case least"), told("least"));
    assert!(told("worst case greatest").abs() < 1e-12);
}

/// A mass on a spring with a damper that a force pulls aside: at 0.7 s it is farthest with all five at an end, at a corner to which no derivative of the file's
/// own design points. Closed form.
#[test]
fn simulations_are_tried_at_all_corners() {
    let result = found(
        "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\nm = \"2 kg\"\nk = \"800 N/m\"\nc = \"8 N s/m\"\nf = \"20 N\"\nphi = \"30 deg\"\n\
         [links]\nframe = { A = [0, 0], E = [0, 0], H = [1000, 0], S = [-100, 0] }\nblock = { C = [0, 0], mass = \"m\" }\n\
         [joints]\nrail = { slider = \"block\", at = \"C\", on = \"E -> H\" }\n\
         [drives]\ngo = { slides = \"block\", from = 0, to = 1000, speed = \"1 m/s\" }\n\
         [springs]\nsp = { between = \"S-C\", stiffness = \"k\", free = 100 }\n[dampers]\ndp = { between = \"S-C\", damping = \"c\" }\n\
         [loads]\npush = { force = [\"f\", \"phi\"], at = \"C\" }\n\
         [studies.sim]\nkind = \"simulate\"\nrelease = \"go\"\nstart = { go = 0 }\nuntil = \"1.5 s\"\nrows = 31\n\
         [studies.tol]\nkind = \"tolerance\"\nover = \"sim\"\nsamples = 40\n\
         vary = { m = \"10 %\", k = \"10 %\", c = { normal = \"1 N s/m\" }, f = { between = [\"-2 N\", \"3 N\"] }, phi = \"5 deg\" }\n\
         columns = [\"at(travel(block), time, 0.7 s)\"]\n",
    );
    let travel = |m: f64, k: f64, c: f64, f: f64, phi: f64| {
        let (decay, end) = (c / (2.0 * m), f * phi.to_radians().cos() / k);
        let turns = (k / m - decay * decay).sqrt();
        let t = 0.7;
        let swings = (turns * t).cos() + decay / turns * (turns * t).sin();
        end * (1.0 - (-decay * t).exp() * swings)
    };
    let told = scalar(
        &result,
        "at(travel(block), time, 0.7 s), worst case greatest",
    );
    near(told, 1e3 * travel(1.8, 880.0, 5.0, 23.0, 25.0), 1e-6);
}

/// The height of the crank's pin is that of the crank, with a pin of play on a circle about its own place: the worst of both together.
#[test]
fn play_and_lengths_are_worst_together() {
    let text = slider(
        ["20 mm", "60 mm"],
        90.0,
        "vary = { a = \"0.1 mm\" }\nclearance = true\nsamples = 100\ncolumns = [\"at(y(B), motor, 90)\"]",
    )
    .replace("samples = 2000\n", "")
    .replace("[studies.turn]", "[clearance]\nA = { radial = \"50 um\" }\n[studies.turn]");
    let result = found(&text);
    let number = "at(y(B), motor, 90)";
    let told = |what: &str| scalar(&result, &format!("{number}, {what}"));
    near(told("worst case greatest"), 20.15, 1e-9);
    near(told("worst case least"), 19.85, 1e-9);
    let [least, greatest] = with(&result, number);
    assert!(
        least.contains("a = 19.9 mm") && least.contains("towards -90 deg"),
        "{least}"
    );
    assert!(greatest.contains("by 0.05 mm towards 90 deg"), "{greatest}");
}

/// Three deviations of a normal length, as linearly.
#[test]
fn normal_lengths_count_with_three_deviations() {
    let result = found(&slider(
        ["20 mm", "60 mm"],
        360.0,
        "vary = { a = { normal = \"0.1 mm\" } }\ncolumns = [\"max(x(C))\"]",
    ));
    near(
        scalar(&result, "max(x(C)), worst case greatest"),
        80.3,
        1e-9,
    );
    near(scalar(&result, "max(x(C)), worst case least"), 79.7, 1e-9);
}

/// Deviations of which none is zero: the file's own design is no piece.
#[test]
fn a_design_outside_of_its_tolerances_is_no_worst_case() {
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\nl = \"60 mm\"\n[links]\nframe = { A = [0, 0] }\nlever = { A-B = \"l\" }\n\
        [drives]\nm = { turns = \"lever\", from = 10, to = 80, speed = 10 }\n[studies.turn]\nkind = \"motion\"\n\
        [studies.t]\nkind = \"tolerance\"\nover = \"turn\"\nvary = { l = { between = [FROM, TO] } }\ncolumns = [\"max(y(B))\", \"min(x(B))\"]\nsamples = 256\n";
    for ends in [[0.2, 0.5], [-0.5, -0.2]] {
        let [from, to] = ends.map(|x| format!("\"{x} mm\""));
        let result = found(&text.replace("FROM", &from).replace("TO", &to));
        let (sin, cos) = (80.0_f64.to_radians().sin(), 80.0_f64.to_radians().cos());
        for (name, by) in [("max(y(B))", sin), ("min(x(B))", cos)] {
            let told = |what: &str| scalar(&result, &format!("{name}, worst case {what}"));
            near(told("least"), (60.0 + ends[0]) * by, 1e-9);
            near(told("greatest"), (60.0 + ends[1]) * by, 1e-9);
        }
    }
}

/// The stroke of a slider-crank goes by its offset evenly: drawn without any, the derivative is rounding, and the least stroke has none. That of the
/// crank says where it is: 2 a.
#[test]
fn what_derivatives_say_nothing_of_is_moved_by_itself() {
    let text = slider(
        ["30 mm", "100 mm"],
        360.0,
        "vary = { t = \"10 mm\", a = \"0.01 mm\", b = \"10 mm\" }\ncolumns = [\"range(x(C))\"]",
    )
    .replace(
        "E = [0, 0], F = [100, 0]",
        "E = [0, \"t\"], F = [100, \"t\"]",
    );
    let result = found(&text);
    let told = |what: &str| scalar(&result, &format!("range(x(C)), {what}"));
    near(told("worst case least"), 2.0 * 29.99, 1e-9);
    let stroke = |a: f64, b: f64, e: f64| {
        ((b + a) * (b + a) - e * e).sqrt() - ((b - a) * (b - a) - e * e).sqrt()
    };
    near(told("worst case greatest"), stroke(30.01, 90.0, 10.0), 1e-9);
    assert_eq!(with(&result, "range(x(C))")[0], "a = 29.99 mm");
}

/// A slider-crank with an offset, over a turn.
fn with_offset([a, b, e]: [&str; 3], study: &str) -> String {
    slider([a, b], 360.0, study)
        .replace("t = \"0 mm\"", &format!("t = \"{e}\""))
        .replace(
            "E = [0, 0], F = [100, 0]",
            "E = [0, \"t\"], F = [100, \"t\"]",
        )
}

/// The rod leans by asin((a + |e|) / b) at most: drawn in line it leans as far to both sides, and any offset adds to one of them. The least is on that
/// ridge, with both lengths at their ends.
#[test]
fn the_least_of_two_equal_peaks_lies_on_their_ridge() {
    let number = "max(abs(angle(rod)))";
    let study = format!(
        "vary = {{ a = \"0.5 mm\", b = \"1 mm\", t = \"2 mm\" }}\ncolumns = [\"{number}\"]"
    );
    for e in ["0 mm", "0.7 mm", "-1.9 mm"] {
        let result = found(&with_offset(["30 mm", "105 mm", e], &study));
        let own: f64 = e.trim_end_matches(" mm").parse().expect("a length");
        let told = |what: &str| scalar(&result, &format!("{number}, worst case {what}"));
        let lean = |a: f64, b: f64, e: f64| ((a + e) / b).asin().to_degrees();
        near(told("least"), lean(29.5, 106.0, 0.0), 1e-9);
        let at_rest = if own == 0.0 { "" } else { ", t = 0 mm" };
        assert_eq!(
            with(&result, number)[0],
            format!("a = 29.5 mm, b = 106 mm{at_rest}")
        );
        let far = own.abs() + 2.0;
        near(told("greatest"), lean(30.5, 104.0, far), 1e-9);
    }
}

/// The higher of both ends of a swing, and the larger of two numbers of a formula: least where both are alike.
#[test]
fn the_least_of_two_ends_lies_where_they_are_alike() {
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\nl = \"60.3 mm\"\ns = \"4 deg\"\n[links]\nframe = { A = [0, 0] }\n\
        lever = { A-B = \"l\" }\n[drives]\nm = { turns = \"lever\", from = \"60 deg + s\", to = \"120 deg + s\", speed = 10 }\n[studies.turn]\nkind = \"motion\"\n\
        [studies.t]\nkind = \"tolerance\"\nover = \"turn\"\nvary = { l = \"1 mm\", s = \"5 deg\" }\n\
        columns = [\"max(abs(x(B)))\", \"max(max(y(B)), 120 mm - max(y(B)))\"]\nsamples = 256\n";
    let result = found(text);
    let told = |number: &str, what: &str| scalar(&result, &format!("{number}, worst case {what}"));
    let at = |deg: f64| deg.to_radians().cos();
    let number = "max(abs(x(B)))";
    near(told(number, "least"), 59.3 * at(60.0), 1e-8);
    near(told(number, "greatest"), 61.3 * at(51.0), 1e-9);
    let number = "max(max(y(B)), 120 mm - max(y(B)))";
    near(told(number, "least"), 60.0, 1e-9);
    near(told(number, "greatest"), 61.3, 1e-9);
}

/// A sum of two sizes has four pieces: with both at one sign in the file's own design, the greatest lies at another corner than theirs.
#[test]
fn the_greatest_of_several_pieces_may_be_that_of_another() {
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\nl = \"60 mm\"\ns = \"1 deg\"\n[links]\nframe = { A = [0, 0] }\n\
        lever = { A-B = \"l\" }\n[drives]\nm = { turns = \"lever\", from = \"60 deg + s\", to = \"120 deg + s\", speed = 10 }\n[studies.turn]\nkind = \"motion\"\n\
        [studies.t]\nkind = \"tolerance\"\nover = \"turn\"\nvary = { l = { between = [-1, 1] }, s = { between = [\"-9 deg\", \"5 deg\"] } }\n\
        columns = [\"max(abs(x(B)))\"]\nsamples = 30\n"
        .replace("[-1, 1]", "[\"-1 mm\", \"1 mm\"]");
    let result = found(&text);
    let number = "max(abs(x(B)))";
    let told = |what: &str| scalar(&result, &format!("{number}, worst case {what}"));
    // It leans to -8 deg farther than to 6 deg.
    near(told("greatest"), 61.0 * 52.0_f64.to_radians().cos(), 1e-9);
    near(told("least"), 59.0 * 60.0_f64.to_radians().cos(), 1e-8);
}

/// A number that rises to both ends of a tolerance, to one of them less: neither the slope of the file's own design nor a single piece says to which.
#[test]
fn corners_are_all_tried_where_they_are_few() {
    let number = "max(x(C))";
    for seed in 1..5 {
        let study = format!(
            "seed = {seed}\nvary = {{ t = {{ between = [\"-0.5 mm\", \"2 mm\"] }} }}\ncolumns = [\"{number}\"]"
        );
        let length = "60 mm + (t - 0.1 mm) * (t - 0.1 mm) / (1 mm)";
        let text = slider(["20 mm", length], 360.0, &study);
        let result = found(&text.replace("samples = 2000", "samples = 1"));
        let told = |what: &str| scalar(&result, &format!("{number}, worst case {what}"));
        near(told("greatest"), 80.0 + 1.9 * 1.9, 1e-9);
        near(told("least"), 80.0, 1e-6);
    }
}

/// What has a pole within its tolerances has no worst case, and is told so; what is large beside it, but bounded, has one.
#[test]
fn what_has_no_bound_has_an_infinite_worst_case() {
    let study = "vary = { t = \"2 mm\" }\ncolumns = [\"max(x(C)) / (t - 1 mm)\", \"x(C) ^ 2 / ((t - 1 mm) ^ 2 + (0.1 mm) ^ 2)\"]";
    let study = study.replace("\"x(C) ^ 2", "\"max(x(C)) ^ 2");
    let result = found(&slider(["20 mm", "60 mm"], 360.0, &study));
    let told = |number: &str, what: &str| scalar(&result, &format!("{number}, worst case {what}"));
    let pole = "max(x(C)) / (t - 1 mm)";
    assert_eq!(told(pole, "greatest"), f64::INFINITY);
    assert_eq!(told(pole, "least"), f64::NEG_INFINITY);
    let peak = "max(x(C)) ^ 2 / ((t - 1 mm) ^ 2 + (0.1 mm) ^ 2)";
    near(told(peak, "greatest"), 800.0 * 800.0, 1e-3);
    let endless = result.diagnostics.iter().filter(|d| d.code == "infinite");
    let names: Vec<&str> = endless.map(|d| d.message.as_str()).collect();
    assert_eq!(names.len(), 2, "{names:?}");
    assert!(
        names
            .iter()
            .all(|it| it.contains(pole) && it.contains("t = 1")),
        "{names:?}"
    );
}
