//! Studies that adjust, from the text of a file to the file with the values that were found: reference values, round trips, what errors of
//! measurement do, bad data.
#![allow(
    clippy::disallowed_methods,
    reason = "numbers found by hand beside ours, not reproducible ones"
)]

use crate::told::{column, scalar};
use kempe_model::{Diagnostic, Model};
use kempe_number::Random;
use kempe_study::{Silent, StudyResult, run};
use kempe_synthesis::{PrecisionPoint, two_lengths};

/// A throttle linkage: O and D on the frame, arm a, rod b, the box's arm c.
fn throttle(a: f64, b: f64, near: f64, study: &str) -> String {
    format!(
        "title = \"t\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\n[parameters]\na = \"{a} mm\"  # set\nb = \"{b} mm\"\nc = \"70 mm\"\nd = \"160 mm\"\n\
         [links]\nframe = {{ O = [0, 0], D = [\"d\", 0] }}\narm = {{ O-A = \"a\" }}\nrod = {{ A-C = \"b\" }}\nbox = {{ D = [0, 0], C = [\"-c\", 0] }}\n\
         [drives]\nlever = {{ turns = \"arm\", from = 30, to = 35, speed = \"10 deg/s\" }}\n[assembly]\nbox = {{ near = {near} }}\n\
         [studies.set]\nkind = \"adjust\"\nunknown = [\"a\", \"b\"]\n{study}\n"
    )
}

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

fn tried(text: &str) -> Result<StudyResult, Vec<Diagnostic>> {
    let model = model(text);
    let result = run(&model, &model.studies[0], &mut Silent)?;
    // Its file reads back, and finds itself.
    for design in &result.designs {
        let again = Model::from_toml(&design.file.toml, "", &mut |_| Err(String::new()));
        let again = again.expect("the file of what was found").model;
        assert!(again.same_as(&design.model));
    }
    Ok(result)
}

fn found(text: &str) -> StudyResult {
    match tried(text) {
        Ok(result) => result,
        Err(found) => panic!("{}", rendered(&found, text)),
    }
}

fn codes(text: &str) -> Vec<&'static str> {
    match tried(text) {
        Ok(result) => result.diagnostics.iter().map(|d| d.code).collect(),
        Err(found) => found.iter().map(|d| d.code).collect(),
    }
}

fn rows(pairs: &[(f64, f64)]) -> String {
    let rows = pairs
        .iter()
        .map(|(lever, of_box)| format!("{{ lever = {lever}, box = {of_box} }}"));
    format!("match = [{}]", rows.collect::<Vec<_>>().join(", "))
}

/// Of the reference: pairs of a linkage with a = 80, b = 150, the arms on opposite sides and on one side.
const OPPOSITE: [(f64, f64); 4] = [
    (30.0, 100.248244862532),
    (50.0, 67.320947122804),
    (70.0, 45.123231376383),
    (95.0, 24.538410092083),
];
const SAME_SIDE: [(f64, f64); 4] = [
    (-30.0, 147.836198636526),
    (-50.0, 126.203875007979),
    (-70.0, 104.209725936902),
    (-95.0, 75.568484465990),
];

#[test]
fn any_two_rows_of_the_reference_give_both_lengths() {
    for (all, near) in [(OPPOSITE, 100.0), (SAME_SIDE, 150.0)] {
        for (i, j) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
            let text = throttle(70.0, 140.0, near, &rows(&[all[i], all[j]]));
            let result = found(&text);
            let (a, b) = (scalar(&result, "a"), scalar(&result, "b"));
            assert!((a - 80.0).abs() < 2e-10, "{near} {i} {j}: {a} {b}");
            assert!((b - 150.0).abs() < 2e-10, "{near} {i} {j}: {b}");
            assert!(
                result.diagnostics.is_empty(),
                "{i} {j}: {}",
                rendered(&result.diagnostics, &text)
            );
        }
    }
}

/// Angles of one side entered for the other give wrong lengths that meet them: the reference's warning.
#[test]
fn angles_of_the_wrong_side_are_met_by_wrong_lengths() {
    let pairs = [(30.0, 147.836198636526), (50.0, 126.203875007979)];
    let result = found(&throttle(60.0, 140.0, 100.0, &rows(&pairs)));
    assert!((scalar(&result, "a") - 33.676140).abs() < 1e-6);
    assert!((scalar(&result, "b") - 197.641728).abs() < 1e-6);
}

/// Whole degrees: the closed form is linear least squares of squared distances, the study least squares of angles. Each is right, and they differ.
#[test]
fn whole_degrees_are_met_as_well_as_can_be() {
    let read: [(f64, f64); 4] = [(30.0, 100.0), (50.0, 67.0), (70.0, 45.0), (95.0, 25.0)];
    let points: Vec<PrecisionPoint> = read
        .iter()
        .map(|(lever, of_box)| {
            PrecisionPoint::new(lever.to_radians(), (of_box + 180.0).to_radians())
        })
        .collect();
    let closed = two_lengths(160.0, 70.0, &points).expect("lengths");
    assert!((closed.input - 79.4673409677).abs() < 1e-9);
    assert!((closed.coupler - 149.7833179169).abs() < 1e-9);
    let result = found(&throttle(60.0, 140.0, 100.0, &rows(&read)));
    // The reference's residuals of its own lengths, in deg.
    let of_closed: f64 = [0.174217_f64, -0.263482, -0.245663, 0.334021]
        .iter()
        .map(|r| r * r)
        .sum();
    let own: f64 = column(&result, "box missed").iter().map(|r| r * r).sum();
    assert!(own < of_closed, "{own} {of_closed}");
    // A minimum: residuals stand square on the derivatives, which the sensitivities invert.
    let (a, b) = (scalar(&result, "a"), scalar(&result, "b"));
    for (da, db) in [(1e-3, 0.0), (-1e-3, 0.0), (0.0, 1e-3), (0.0, -1e-3)] {
        let other = squares(a + da, b + db, &read);
        assert!(other > own, "{da} {db}: {other} {own}");
    }
}

/// The sum of squares of what a linkage misses, deg^2, by its own closure.
fn squares(a: f64, b: f64, pairs: &[(f64, f64)]) -> f64 {
    let one = |(lever, measured): &(f64, f64)| {
        let of_box = opposite(a, b, *lever).expect("closes");
        (of_box - measured) * (of_box - measured)
    };
    pairs.iter().map(one).sum()
}

/// The box's angle (deg) with its arm on the other side of the frame's line than the lever's.
fn opposite(a: f64, b: f64, lever: f64) -> Option<f64> {
    let (c, d) = (70.0_f64, 160.0);
    let (x, y) = (
        a * lever.to_radians().cos() - d,
        a * lever.to_radians().sin(),
    );
    // |D + c e^(i(180 + B)) - A| = b
    let r = x.hypot(y);
    let cos = (c * c + r * r - b * b) / (2.0 * c * r);
    (cos.abs() < 1.0).then(|| {
        let towards = y.atan2(x).to_degrees();
        // From the direction towards A on, round to the side below.
        let arm = towards + cos.acos().to_degrees();
        (arm - 180.0).rem_euclid(360.0)
    })
}

#[test]
fn the_reference_is_the_closure() {
    for (lever, of_box) in OPPOSITE {
        let ours = opposite(80.0, 150.0, lever).expect("closes");
        assert!((ours - of_box).abs() < 1e-9, "{lever}: {ours} {of_box}");
    }
}

/// Random linkages, read in two to four positions, come back; the closed form agrees.
#[test]
fn random_linkages_are_recovered() {
    let mut random = Random(7);
    let (mut tried, mut missed) = (0, Vec::new());
    while tried < 40 {
        let (a, b) = (
            30.0 + 90.0 * random.uniform(),
            90.0 + 120.0 * random.uniform(),
        );
        let first = 25.0 + 40.0 * random.uniform();
        let levers = [0.0, 14.0, 31.0, 45.0].map(|by| first + by);
        let boxes = levers.map(|lever| opposite(a, b, lever));
        let [Some(p), Some(q), Some(r), Some(s)] = boxes else {
            continue;
        };
        tried += 1;
        let pairs = [
            (levers[0], p),
            (levers[1], q),
            (levers[2], r),
            (levers[3], s),
        ];
        let pairs = &pairs[..2 + tried % 3];
        let text = throttle(a * 1.2, b * 0.95, p, &rows(pairs)).replace(
            "from = 30, to = 35",
            &format!("from = {first}, to = {}", first + 1.0),
        );
        let result = found(&text);
        let off = (scalar(&result, "a") - a).abs() + (scalar(&result, "b") - b).abs();
        if off > 1e-7 {
            missed.push((a, b, first, off));
        }
    }
    assert!(missed.is_empty(), "{missed:?}");
}

/// Two readings that three linkages meet: the one that is nearly the file's is taken, the others are told.
#[test]
fn of_several_the_nearest_is_taken() {
    let text = |c: f64, d: f64| {
        format!(
            "title = 't'\nunits = {{ length = 'm', angle = 'rad' }}\n[parameters]\nc = '{c:?} m'\nd = '{d:?} m'\n\
             [links]\nframe = {{ A = [0, 0], D = ['d', 0] }}\ncrank = {{ A-B = 1.0276726355817551 }}\n\
             coupler = {{ B-C = 1.0385226579705424 }}\nrocker = {{ D-C = 'c' }}\n[assembly]\nC = 'right of B -> D'\n\
             [drives]\nmotor = {{ turns = 'crank', from = -1.983734646066699, to = -0.8447805854392223, speed = '1 rad/s' }}\n\
             [studies.s]\nkind = 'adjust'\nunknown = ['c', 'd']\nmatch = [{{ motor = -1.983734646066699, rocker = -1.4586943788712636 }}, \
             {{ motor = -1.712006648898155, rocker = -1.2192469307662028 }}]\n"
        )
    };
    let both = [[1.515344331890046, 0.28975348904667475], [1.46062, 0.32878]];
    for [near, other] in [[both[0], both[1]], [both[1], both[0]]] {
        let result = found(&text(near[0] * 1.002, near[1] * 0.999));
        for (name, value) in [("c", near[0]), ("d", near[1])] {
            assert!((scalar(&result, name) - value).abs() < 1e-5, "{near:?}");
        }
        let listed = format!("{:?}", result.listings);
        let digits = format!("c = {:.4}", other[0]);
        assert!(listed.contains(&digits), "{digits}: {listed}");
    }
}

/// Measured values moved a little move the lengths as the columns of derivatives say, and so do the drive's.
#[test]
fn errors_of_measurement_do_what_is_told() {
    let read = [(30.0, 100.0), (50.0, 67.0), (70.0, 45.0), (95.0, 25.0)];
    let base = found(&throttle(80.0, 150.0, 100.0, &rows(&read)));
    let by = 1e-3;
    for row in 0..read.len() {
        let ends = [-by, by].map(|step| {
            let mut moved = read;
            moved[row].1 += step;
            found(&throttle(80.0, 150.0, 100.0, &rows(&moved)))
        });
        for name in ["a", "b"] {
            let slope = (scalar(&ends[1], name) - scalar(&ends[0], name)) / (2.0 * by);
            let told = column(&base, &format!("d({name})/d(box)"))[row].to_radians();
            // Gauss's derivatives leave out how the residuals bend.
            assert!(
                (slope - told).abs() < 0.05 * told.abs() + 0.01,
                "{row} {name}: {slope} {told}"
            );
        }
    }
    // Where all is met nothing bends.
    let exact = found(&throttle(70.0, 140.0, 100.0, &rows(&OPPOSITE[..2])));
    for (row, of_lever) in [(0, false), (1, false), (0, true), (1, true)] {
        let ends = [-by, by].map(|step| {
            let mut moved = [OPPOSITE[0], OPPOSITE[1]];
            match of_lever {
                true => moved[row].0 += step,
                false => moved[row].1 += step,
            }
            found(&throttle(80.0, 150.0, 100.0, &rows(&moved)))
        });
        let of = if of_lever { "lever" } else { "box" };
        for name in ["a", "b"] {
            let slope = (scalar(&ends[1], name) - scalar(&ends[0], name)) / (2.0 * by);
            let told = column(&exact, &format!("d({name})/d({of})"))[row].to_radians();
            assert!(
                (slope - told).abs() < 1e-5 * (1.0 + told.abs()),
                "{row} {name} {of}: {slope} {told}"
            );
        }
    }
}

/// Told confidence against many drawings of errors.
#[test]
fn lengths_scatter_as_they_are_told_to() {
    let mut random = Random(99);
    let mut normal = || {
        let (u, v) = (random.uniform().max(1e-12), random.uniform());
        (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
    };
    let (of_box, of_lever) = (0.2, 0.1);
    let deviations =
        format!("\ndeviations = {{ box = \"{of_box} deg\", lever = \"{of_lever} deg\" }}");
    let told = found(&throttle(
        80.0,
        150.0,
        100.0,
        &(rows(&OPPOSITE) + &deviations),
    ));
    let within = scalar(&told, "a within") / 1.959964;
    let count = 60;
    let squares: f64 = (0..count)
        .map(|_| {
            let moved =
                OPPOSITE.map(|(lever, at)| (lever + of_lever * normal(), at + of_box * normal()));
            let result = found(&throttle(80.0, 150.0, 100.0, &(rows(&moved) + &deviations)));
            (scalar(&result, "a") - 80.0) * (scalar(&result, "a") - 80.0)
        })
        .sum();
    let scatter = (squares / f64::from(count)).sqrt();
    assert!((scatter / within - 1.0).abs() < 0.3, "{scatter} {within}");
}

#[test]
fn what_the_data_do_not_tell_is_refused() {
    let of = |study: &str| codes(&throttle(60.0, 140.0, 100.0, study));
    assert_eq!(of(&rows(&[(40.0, 60.0)])), ["data-too-few"]);
    assert_eq!(of(&rows(&[(40.0, 60.0), (40.0, 60.0)])), ["data-repeated"]);
    assert_eq!(
        of(&rows(&[(40.0, 60.0), (40.0, 61.0)])),
        ["data-contradictory"]
    );
    // The reference's pairs that tell nothing of a.
    assert_eq!(
        of(&rows(&[(40.0, 60.0), (50.345099239141, 100.0)])),
        ["data-dependent"]
    );
    // Angles alone tell only the ratio of all lengths.
    let all = throttle(60.0, 140.0, 100.0, &rows(&OPPOSITE))
        .replace("[\"a\", \"b\"]", "[\"a\", \"b\", \"c\", \"d\"]");
    assert_eq!(codes(&all), ["data-dependent"]);
    // The lever read from its other end.
    let turned = [(210.0, 100.248244862532), (230.0, 67.320947122804)];
    assert_eq!(of(&rows(&turned)), ["turned-link"]);
    // The box on the other side.
    let other = SAME_SIDE.map(|(lever, of_box)| (-lever, -of_box));
    let result = found(&throttle(60.0, 140.0, 100.0, &rows(&other[..2])));
    let warning = &result.diagnostics[0];
    assert_eq!(warning.code, "other-assembly");
    assert!(
        warning.message.contains("a = 80 mm, b = 150 mm"),
        "{}",
        warning.message
    );
    assert_eq!(
        warning.help.as_deref(),
        Some("write under [assembly]: C = \"left of A -> D\"")
    );
}

/// Only the values that were looked for change in the file; comments stay.
#[test]
fn the_file_keeps_every_other_byte() {
    let text = throttle(60.0, 140.0, 100.0, &rows(&OPPOSITE[..2]));
    let result = found(&text);
    let wanted = text.replace(
        "a = \"60 mm\"  # set\nb = \"140 mm\"",
        "a = \"80 mm\"  # set\nb = \"150 mm\"",
    );
    let rounded = |line: &str| {
        let (name, value) = line.split_once(" = \"")?;
        let value: f64 = value.split_once(" mm\"")?.0.parse().ok()?;
        Some(format!("{name} = {value:.6}"))
    };
    for (ours, wanted) in result.designs[0].file.toml.lines().zip(wanted.lines()) {
        match ours.starts_with("a = ") || ours.starts_with("b = ") {
            true => assert_eq!(rounded(ours), rounded(wanted)),
            false => assert_eq!(ours, wanted),
        }
    }
    assert!(result.designs[0].file.toml.contains("# set"));
}

/// Crank and offset of a slider-crank by its stroke and time ratio: numbers over the whole motion.
#[test]
fn a_stroke_and_a_time_ratio_are_met() {
    let text = "title = \"t\"\nunits = { length = \"mm\", angle = \"deg\" }\n[parameters]\nr = \"30 mm\"\ne = \"5 mm\"\n\
        [links]\nframe = { O = [0, 0], E = [0, \"e\"], F = [100, \"e\"] }\ncrank = { O-A = \"r\" }\nrod = { A-B = 120 }\npiston = { B = [0, 0] }\n\
        [joints]\nguide = { slider = \"piston\", at = \"B\", on = \"E -> F\" }\n[drives]\nmotor = { turns = \"crank\", speed = \"1 rad/s\" }\n\
        [assembly]\nB = { near = [130, 5] }\n[measures]\nway = \"stroke(x(B))\"\nratio = \"time_ratio(x(B))\"\n\
        [studies.s]\nkind = \"adjust\"\nunknown = [\"r\", \"e\"]\nmatch = [{ way = \"80 mm\", ratio = 1.1 }]\n";
    let result = found(text);
    let (r, e) = (scalar(&result, "r"), scalar(&result, "e"));
    // Dead centres: both in line with the crank's pivot.
    let (out, back) = (
        ((120.0 + r).powi(2) - e * e).sqrt(),
        ((120.0 - r).powi(2) - e * e).sqrt(),
    );
    assert!((out - back - 80.0).abs() < 1e-8, "{r} {e}");
    let angle = (e / (120.0 - r)).asin() - (e / (120.0 + r)).asin();
    let pi = std::f64::consts::PI;
    let ratio = (pi + angle) / (pi - angle);
    assert!(
        (ratio - 1.1).abs() < 1e-9 || (1.0 / ratio - 1.1).abs() < 1e-9,
        "{ratio}"
    );
}

/// Stiffness and free length of a spring by the torque that holds an arm: measures of forces.
#[test]
fn a_spring_is_found_by_what_it_asks_of_a_drive() {
    let head = |k: &str, free: &str| {
        format!(
            "title = \"t\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\n[parameters]\nk = \"{k}\"\nfree = \"{free}\"\n\
         [links]\nframe = {{ O = [0, 0], S = [0, 100] }}\narm = {{ O-A = 80 }}\n[drives]\nlift = {{ turns = \"arm\", from = 0, to = 60, speed = \"1 deg/s\" }}\n\
         [springs]\nback = {{ between = \"S-A\", stiffness = \"k\", free = \"free\" }}\n[measures]\neffort = \"torque(lift)\"\n"
        )
    };
    let known = head("2 N/mm", "60 mm")
        + "[studies.f]\nkind = \"forces\"\nrows = 4\ncolumns = [\"effort\"]\n";
    let table = found(&known).table;
    let (at, efforts) = (
        &table.columns[1].values,
        table.column("effort").expect("a column"),
    );
    let unit = efforts.unit.text();
    let rows: Vec<String> = at
        .iter()
        .zip(&efforts.values)
        .map(|(at, effort)| format!("{{ lift = {at}, effort = \"{effort} {unit}\" }}"))
        .collect();
    let asked = head("1 N/mm", "40 mm")
        + &format!(
            "[studies.s]\nkind = \"adjust\"\nunknown = [\"k\", \"free\"]\nmatch = [{}]\n",
            rows.join(", ")
        );
    let result = found(&asked);
    assert!(
        (scalar(&result, "k") - 2000.0).abs() < 1e-5,
        "{}",
        scalar(&result, "k")
    );
    assert!(
        (scalar(&result, "free") - 60.0).abs() < 1e-6,
        "{}",
        scalar(&result, "free")
    );
}

/// A five-bar with two drives: where its point was seen gives back three lengths.
#[test]
fn two_drives_are_led_through_rows() {
    let head = |p: [f64; 3]| {
        format!(
            "title = \"t\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\n[parameters]\np = \"{} mm\"\nq = \"{} mm\"\nspan = \"{} mm\"\n\
         [links]\nframe = {{ A = [0, 0], E = [\"span\", 0] }}\nleft = {{ A-B = \"p\" }}\nl = {{ B-C = 90 }}\nr = {{ C-D = 95 }}\nright = {{ E-D = \"q\" }}\n\
         [drives]\none = {{ turns = \"left\", from = 110, to = 130, speed = \"1 deg/s\" }}\ntwo = {{ turns = \"right\", from = 70, to = 50, speed = \"1 deg/s\" }}\n\
         [assembly]\nC = {{ near = [40, 130] }}\n[measures]\nx = \"x(C)\"\ny = \"y(C)\"\n",
            p[0], p[1], p[2]
        )
    };
    let truth = [60.0, 65.0, 80.0];
    let mut rows = Vec::new();
    for (one, two) in [(112.0, 68.0), (125.0, 60.0), (100.0, 80.0)] {
        // Where it is: the forward kinematics by hand.
        let [p, q, span] = truth;
        let b = [
            p * f64::to_radians(one).cos(),
            p * f64::to_radians(one).sin(),
        ];
        let d = [
            span + q * f64::to_radians(two).cos(),
            q * f64::to_radians(two).sin(),
        ];
        let (dx, dy) = (d[0] - b[0], d[1] - b[1]);
        let r = dx.hypot(dy);
        let along = (90.0_f64.powi(2) - 95.0_f64.powi(2) + r * r) / (2.0 * r);
        let off = (90.0_f64.powi(2) - along * along).sqrt();
        let (x, y) = (
            b[0] + (along * dx - off * dy) / r,
            b[1] + (along * dy + off * dx) / r,
        );
        rows.push(format!("{{ one = {one}, two = {two}, x = {x}, y = {y} }}"));
    }
    let text = head([55.0, 70.0, 85.0])
        + &format!(
            "[studies.s]\nkind = \"adjust\"\nunknown = [\"p\", \"q\", \"span\"]\nmatch = [{}]\n",
            rows.join(", ")
        );
    let result = found(&text);
    for (name, value) in ["p", "q", "span"].iter().zip(truth) {
        assert!(
            (scalar(&result, name) - value).abs() < 1e-8,
            "{name}: {}",
            scalar(&result, name)
        );
    }
}

/// Rows from a table, its columns under other names. Beside the file it stands beside what comes out, too, in which only the values are others; of another
/// folder, what comes out has the rows in it.
#[test]
fn rows_come_from_a_table() {
    let csv = "nr;A [deg];box [rad]\n1;30;1.749661\n2;50;1.174972\n3;70;0.787549\n";
    for name in ["read.csv", "tables/read.csv"] {
        let text = throttle(
            60.0,
            140.0,
            100.0,
            &format!(
                "match = {{ table = \"{name}\", columns = {{ lever = \"A\", box = \"box\" }} }} # measured"
            ),
        );
        let read = Model::from_toml(&text, "", &mut |asked| match asked == name {
            true => Ok(csv.to_owned()),
            false => Err("no such file".to_owned()),
        });
        let model = match read {
            Ok(checked) => checked.model,
            Err(found) => panic!("{}", rendered(&found, &text)),
        };
        let result = run(&model, &model.studies[0], &mut Silent).expect("lengths");
        assert!((scalar(&result, "a") - 80.0).abs() < 1e-3);
        let (design, beside) = (&result.designs[0], name == "read.csv");
        let tables: Vec<(&str, &str)> = design.file.tables.iter().collect();
        assert_eq!(tables, if beside { vec![(name, csv)] } else { vec![] });
        let others = text.lines().zip(design.file.toml.lines());
        let others = others.filter(|(own, told)| own != told).count();
        assert_eq!(
            beside,
            others <= 3 && design.file.toml.contains("# measured"),
            "{others}"
        );
        let again = Model::from_toml(&design.file.toml, "", &mut design.file.tables.files());
        let again = again.expect("a whole file").model;
        assert!(again.same_as(&design.model));
    }
}
