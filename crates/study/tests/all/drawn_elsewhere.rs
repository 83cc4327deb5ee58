//! What is drawn at other places of the drives than those at which the motion starts: the drawn assembly is followed there.
#![allow(clippy::unwrap_used)]

use kempe_model::Model;
use kempe_number::math::{atan2, cos, hypot, sin};
use kempe_study::{Silent, StudyResult, check, run};

fn model(text: &str) -> Model {
    let read = Model::from_toml(text, "drawn", &mut |_| Err("no files".into()));
    let checked = read.unwrap_or_else(|found| panic!("{found:?}\n{text}"));
    assert_eq!(checked.warnings, [], "{text}");
    checked.model
}

fn table(text: &str) -> StudyResult {
    let model = model(text);
    run(&model, &model.studies[0], &mut Silent).unwrap()
}

fn column(result: &StudyResult, name: &str) -> Vec<f64> {
    result.table.column(name).unwrap().si().to_vec()
}

fn d(a: [f64; 2], b: [f64; 2]) -> f64 {
    hypot(b[0] - a[0], b[1] - a[1])
}

fn deg(a: [f64; 2], b: [f64; 2]) -> f64 {
    atan2(b[1] - a[1], b[0] - a[0]).to_degrees()
}

/// The point at these distances from two others, left of the way from the first to the second.
fn meet(p: [f64; 2], r: f64, q: [f64; 2], s: f64) -> [f64; 2] {
    let l = d(p, q);
    let along = (r * r - s * s + l * l) / (2.0 * l);
    let across = (r * r - along * along).sqrt();
    let u = [(q[0] - p[0]) / l, (q[1] - p[1]) / l];
    [
        p[0] + along * u[0] - across * u[1],
        p[1] + along * u[1] + across * u[0],
    ]
}

const A: [f64; 2] = [0.0, 0.0];
const B: [f64; 2] = [0.17, 0.11];
const C: [f64; 2] = [0.55, 0.38];
const D: [f64; 2] = [0.60, 0.0];

fn four_bar(places: &str, motor: &str) -> String {
    format!(
        "units = {{ length = \"m\", angle = \"deg\" }}\n[places]\n{places}\n[links]\nframe = [\"A\", \"D\"]\ncrank = [\"A\", \"B\"]\ncoupler = [\"B\", \"C\"]\nrocker = [\"D\", \"C\"]\n[drives]\nmotor = {{ turns = \"crank\", {motor}, speed = \"1 rad/s\" }}\n[studies.s]\nkind = \"motion\"\nrows = 25\ncolumns = [\"angle(crank)\", \"angle(rocker)\", \"x(C)\", \"y(C)\"]\n"
    )
}

#[test]
fn the_branch_is_the_drawn_one_wherever_the_crank_starts() {
    let drawn = "A = [0, 0]\nB = [0.17, 0.11]\nC = [0.55, 0.38]\nD = [0.60, 0]";
    // drawn within the range, beyond its end, before its start, turns away, and the other way
    for (from, to) in [
        (0.0, 360.0),
        (200.0, 300.0),
        (50.0, 90.0),
        (-700.0, -500.0),
        (180.0, -180.0),
    ] {
        let text = four_bar(drawn, &format!("from = {from}, to = {to}"));
        let found = check(&model(&text));
        assert_eq!(found.diagnostics, [], "{text}");
        let [chosen] = &found.chosen[..] else {
            panic!("{:?}", found.chosen)
        };
        let words = "the one that is drawn, followed from motor = ";
        let drawn = chosen
            .strip_prefix(words)
            .and_then(|c| c.strip_suffix(" deg to the start"));
        let turns = (drawn.unwrap().parse::<f64>().unwrap() - deg(A, B)) / 360.0;
        assert!((turns - turns.round()).abs() < 1e-6, "{chosen}");
        let result = table(&text);
        let [crank, x, y] = ["angle(crank)", "x(C)", "y(C)"].map(|name| column(&result, name));
        assert_eq!(crank.len(), 25);
        assert!((crank[0].to_degrees() - from).abs() < 1e-9);
        let r = d(A, B);
        for i in 0..25 {
            let b = [r * cos(crank[i]), r * sin(crank[i])];
            let c = meet(b, d(B, C), D, d(D, C));
            assert!(d(c, [x[i], y[i]]) < 1e-12, "{from} {i}");
        }
    }
}

#[test]
fn a_parallelogram_drawn_open_starts_flat_on_its_branch() {
    let parallel = "A = [0, 0]\nB = [0.1, 0.2]\nC = [0.7, 0.2]\nD = [0.6, 0]";
    let result = table(&four_bar(parallel, "from = 0, to = 150"));
    let [crank, rocker] = ["angle(crank)", "angle(rocker)"].map(|n| column(&result, n));
    let off = |(a, b): (&f64, &f64)| (a - b).abs();
    assert!(crank.iter().zip(&rocker).map(off).fold(0.0, f64::max) < 1e-9);
    // the same bars, drawn crossed
    let b = [0.1, 0.2];
    let mirrored = {
        let (u, v) = ([D[0] - b[0], -b[1]], [0.6, 0.0]);
        let t = 2.0 * (u[0] * v[0] + u[1] * v[1]) / (u[0] * u[0] + u[1] * u[1]);
        [b[0] + t * u[0] - v[0], b[1] + t * u[1] - v[1]]
    };
    let crossed = parallel.replace(
        "C = [0.7, 0.2]",
        &format!("C = [{:?}, {:?}]", mirrored[0], mirrored[1]),
    );
    let result = table(&four_bar(&crossed, "from = 0, to = 150"));
    let [crank, rocker] = ["angle(crank)", "angle(rocker)"].map(|n| column(&result, n));
    assert!(
        (5..25).all(|i| (crank[i] - rocker[i]).abs() > 0.1),
        "{rocker:?}"
    );
}

#[test]
fn a_start_that_the_drawn_assembly_does_not_reach_is_told() {
    // the coupler is the shortest: two circuits, mirrored about the frame, that no motion joins
    let c = meet([0.3, 0.4], 0.2, D, 0.45);
    let places = format!(
        "A = [0, 0]\nB = [0.3, 0.4]\nC = [{:?}, {:?}]\nD = [0.60, 0]",
        c[0], c[1]
    );
    let text = four_bar(&places, "from = -55, to = -50");
    let found = check(&model(&text));
    let left: Vec<&str> = found.diagnostics.iter().map(|d| d.code).collect();
    assert_eq!(left, ["not-as-drawn", "several-assemblies"]);
    let message = &found.diagnostics[0].message;
    // the coupler in line with the rocker: the angle between frame and input by the law of cosines
    let (a, f, g) = (d(A, [0.3, 0.4]), 0.6, 0.2 + 0.45);
    let extreme = kempe_number::math::acos((a * a + f * f - g * g) / (2.0 * a * f)).to_degrees();
    let least = kempe_number::math::acos((a * a + f * f - 0.25 * 0.25) / (2.0 * a * f));
    let ends = [extreme, least.to_degrees()].map(|x| format!("{x:.4}"));
    assert!(
        ends.iter().any(|end| message.contains(end.as_str())),
        "{message} {ends:?}"
    );
    assert!(message.contains("starts at -55 deg"), "{message}");
    // what the file says itself chooses
    let said = text + "[assembly]\nC = \"left of B -> D\"\n";
    assert_eq!(check(&model(&said)).diagnostics, []);
}

/// A five-bar; the places at which its motors are drawn, and how they move.
fn five_bar(left: &str, right: &str) -> String {
    let (b, e) = ([0.1, 0.5], [0.95, 0.45]);
    let c = meet(b, 0.9, e, 0.8);
    // C is left of B -> E: above
    assert!(c[1] > 0.6);
    format!(
        "units = {{ length = \"m\", angle = \"deg\" }}\n[places]\nA = [0, 0]\nB = [{}, {}]\nC = [{:?}, {:?}]\nE = [{}, {}]\nF = [1, 0]\n[links]\nframe = [\"A\", \"F\"]\nleft = [\"A\", \"B\"]\nrod = [\"B\", \"C\"]\nstay = [\"E\", \"C\"]\nright = [\"F\", \"E\"]\n[drives]\none = {{ turns = \"left\", {left} }}\ntwo = {{ turns = \"right\", {right} }}\n[studies.s]\nkind = \"motion\"\nrows = 25\ncolumns = [\"angle(left)\", \"angle(right)\", \"x(C)\", \"y(C)\"]\n",
        b[0], b[1], c[0], c[1], e[0], e[1]
    )
}

#[test]
fn drives_that_are_held_or_move_together_are_moved_from_the_drawing() {
    let (b, e, f) = ([0.1, 0.5], [0.95, 0.45], [1.0, 0.0]);
    let cases = [
        // held elsewhere, the other as drawn; both elsewhere; both moving
        ("to = 120, speed = \"1 rad/s\"", "at = 60"),
        ("from = 40, to = 120, speed = \"1 rad/s\"", "at = 130"),
        (
            "from = 120, to = 60, speed = \"1 rad/s\"",
            "from = 60, to = 120, speed = \"1 rad/s\"",
        ),
        (
            "to = 60, speed = \"1 rad/s\"",
            "from = 420, to = 480, speed = \"1 rad/s\"",
        ),
    ];
    for (left, right) in cases {
        let text = five_bar(left, right);
        let found = check(&model(&text));
        assert_eq!(found.diagnostics, [], "{text}");
        let result = table(&text);
        let [p, q, x, y] =
            ["angle(left)", "angle(right)", "x(C)", "y(C)"].map(|n| column(&result, n));
        for i in 0..25 {
            let at = |o: [f64; 2], r: f64, a: f64| [o[0] + r * cos(a), o[1] + r * sin(a)];
            let c = meet(at(A, d(A, b), p[i]), 0.9, at(f, d(f, e), q[i]), 0.8);
            assert!(d(c, [x[i], y[i]]) < 1e-12, "{left} {right} {i}");
        }
    }
}

#[test]
fn wheels_turn_on_from_their_drawn_angles() {
    let places = "A = [0, 0]\nB = [0.3, 0.1]\nD = [0.6, 0]\nC = [0.5, 0.2]";
    let (sun, wheel) = (deg(A, [0.3, 0.1]), deg(D, [0.5, 0.2]));
    for (joint, ratio) in [
        ("gears = [\"sun\", \"wheel\"], teeth = [20, 30]", -2.0 / 3.0),
        ("belt = [\"sun\", \"wheel\"], radii = [0.1, 0.2]", 0.5),
        (
            "belt = [\"sun\", \"wheel\"], radii = [0.1, 0.2], crossed = true",
            -0.5,
        ),
    ] {
        for (from, to) in [
            (sun, 100.0),
            (100.0, 400.0),
            (-200.0, -900.0),
            (sun + 360.0, 0.0),
        ] {
            let text = format!(
                "units = {{ length = \"m\", angle = \"deg\" }}\n[places]\n{places}\n[links]\nframe = [\"A\", \"D\"]\nsun = [\"A\", \"B\"]\nwheel = [\"D\", \"C\"]\n[joints]\nmesh = {{ {joint} }}\n[drives]\nmotor = {{ turns = \"sun\", from = {from:?}, to = {to}, speed = \"1 rad/s\" }}\n[studies.s]\nkind = \"motion\"\nrows = 25\ncolumns = [\"angle(sun)\", \"angle(wheel)\"]\n"
            );
            assert_eq!(check(&model(&text)).diagnostics, [], "{text}");
            let result = table(&text);
            let [a, b] = ["angle(sun)", "angle(wheel)"].map(|n| column(&result, n));
            for (a, b) in a.iter().zip(&b) {
                let expected = wheel + ratio * (a.to_degrees() - sun);
                assert!(
                    (b.to_degrees() - expected).abs() < 1e-9,
                    "{joint} {from} {a} {b}"
                );
            }
        }
    }
}

#[test]
fn a_rack_meshes_where_it_is_drawn() {
    // the pinion on the left of the rack, its first point the centre; the rack starts beyond where it is drawn
    let text = |drive: &str| {
        format!(
            "units = {{ length = \"m\", angle = \"deg\" }}\n[places]\nA = [0.2, 0.1]\nB = [0.26, 0.18]\nR = [0.05, 0]\nS = [0.55, 0]\nE = [0, 0]\nF = [1, 0]\n[links]\nframe = [\"A\", \"E\", \"F\"]\npinion = [\"A\", \"B\"]\nbar = [\"R\", \"S\"]\n[joints]\nguide = {{ slider = \"bar\", at = \"R\", on = \"E -> F\" }}\nsteer = {{ rack = \"bar\", pinion = \"pinion\", radius = 0.1 }}\n[drives]\nmotor = {{ slides = \"bar\", {drive}, speed = \"1 m/s\" }}\n[studies.s]\nkind = \"motion\"\nrows = 9\ncolumns = [\"x(R)\", \"angle(pinion)\"]\n"
        )
    };
    let drawn = deg([0.2, 0.1], [0.26, 0.18]);
    for drive in ["to = 0.1", "from = 0.15, to = 0.2", "from = -0.3, to = 0.3"] {
        let text = text(drive);
        assert_eq!(check(&model(&text)).diagnostics, [], "{text}");
        let result = table(&text);
        let [x, angle] = ["x(R)", "angle(pinion)"].map(|n| column(&result, n));
        for (x, angle) in x.iter().zip(&angle) {
            // the rack below drags the pinion's lowest point along: to the right, it turns counter-clockwise
            let expected = drawn + ((x - 0.05) / 0.1).to_degrees();
            assert!((angle.to_degrees() - expected).abs() < 1e-9, "{drive} {x}");
        }
    }
}

#[test]
fn a_circuit_begins_at_the_start_not_at_the_drawing() {
    let drawn = "A = [0, 0]\nB = [0.17, 0.11]\nC = [0.55, 0.38]\nD = [0.60, 0]";
    let text = four_bar(drawn, "from = 200, to = 560").replace("rows = 25", "circuit = true");
    let result = table(&text);
    assert_eq!(result.diagnostics, []);
    let crank = column(&result, "angle(crank)");
    assert!((crank[0].to_degrees() - 200.0).abs() < 1e-9);
    let [x, y] = ["x(C)", "y(C)"].map(|name| column(&result, name));
    for i in 0..crank.len() {
        let r = d(A, B);
        let b = [r * cos(crank[i]), r * sin(crank[i])];
        let c = meet(b, d(B, C), D, d(D, C));
        assert!(d(c, [x[i], y[i]]) < 1e-9, "{i}");
    }
}

#[test]
fn a_model_that_starts_elsewhere_is_written_and_read_again() {
    let text = four_bar(
        "A = [0, 0]\nB = [0.17, 0.11]\nC = [0.55, -0.38]\nD = [0.60, 0]",
        "from = 200, to = 300",
    );
    let drawn = model(&text);
    let file = drawn.to_toml();
    let again = model(&file.toml);
    assert!(again.same_as(&drawn), "{}", file.toml);
    let (one, two) = (table(&text), table(&file.toml));
    assert_eq!(column(&one, "x(C)"), column(&two, "x(C)"));
}

/// Six-bars drawn at random: where the motion from the drawing reaches a place of the crank, the motion that starts there starts
/// in its pose; elsewhere it is told that it does not, or gets there the other way round.
#[test]
fn a_start_elsewhere_is_the_pose_to_which_the_drawing_moves() {
    let mut seed = 7u64;
    let mut random = |low: f64, high: f64| {
        seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        low + (high - low) * (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    let (mut reached, mut told) = (0, 0);
    for _ in 0..60 {
        let places: String = [
            ("A", 0.0, 0.0),
            ("B", 0.15, 0.1),
            ("C", 0.55, 0.4),
            ("D", 0.6, 0.0),
            ("P", 0.3, 0.4),
            ("Q", 0.6, 0.7),
            ("O", 0.9, 0.35),
        ]
        .map(|(name, x, y)| {
            format!(
                "{name} = [{:?}, {:?}]\n",
                x + random(-0.1, 0.1),
                y + random(-0.1, 0.1)
            )
        })
        .concat();
        let at = random(-120.0, 180.0);
        let text = |law: &str| {
            format!(
                "units = {{ length = \"m\", angle = \"deg\" }}\n[places]\n{places}[links]\nframe = [\"A\", \"D\", \"O\"]\ncrank = [\"A\", \"B\"]\ncoupler = [\"B\", \"C\", \"P\"]\nrocker = [\"D\", \"C\"]\nrod = [\"P\", \"Q\"]\noutput = [\"O\", \"Q\"]\n[drives]\nmotor = {{ turns = \"crank\", {law}, speed = \"1 rad/s\" }}\n[studies.s]\nkind = \"motion\"\nrows = 2\ncolumns = [\"x(C)\", \"y(C)\", \"x(Q)\", \"y(Q)\", \"angle(output)\"]\n"
            )
        };
        let plain = model(&text(&format!("to = {at:?}")));
        let drawn = run(&plain, &plain.studies[0], &mut Silent);
        let end = at + 0.01;
        let elsewhere = model(&text(&format!("from = {at:?}, to = {end:?}")));
        let left = (check(&elsewhere).diagnostics.iter())
            .any(|d| ["not-as-drawn", "cannot-assemble"].contains(&d.code));
        match drawn {
            Ok(drawn) => {
                reached += 1;
                assert!(!left, "{places}{at}");
                let started = run(&elsewhere, &elsewhere.studies[0], &mut Silent);
                // the range behind the start may end at once
                let Ok(started) = started else { continue };
                for name in ["x(C)", "y(C)", "x(Q)", "y(Q)", "angle(output)"] {
                    let (moved, start) = (column(&drawn, name)[1], column(&started, name)[0]);
                    assert!(
                        (moved - start).abs() < 1e-9,
                        "{name}: {moved} {start}\n{places}{at}"
                    );
                }
            }
            Err(_) => told += usize::from(left),
        }
    }
    assert!(reached > 20 && told > 3, "{reached} {told}");
}
