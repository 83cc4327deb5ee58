//! Mechanisms drawn as they stand move as the same mechanisms given by lengths, and follow their parameters.
#![allow(clippy::unwrap_used)]

use kempe_model::{Model, value};
use kempe_number::math::{atan2, hypot};
use kempe_study::{Silent, StudyResult, check, run, sensitivities};

fn model(text: &str) -> Model {
    let read = Model::from_toml(text, "drawn", &mut |_| Err("no files".into()));
    let checked = read.unwrap_or_else(|found| {
        let found: String = found
            .iter()
            .map(|d| d.render_plain("drawn", text))
            .collect();
        panic!("{found}\n{text}")
    });
    assert_eq!(checked.warnings, [], "{text}");
    checked.model
}

fn table(text: &str) -> StudyResult {
    let model = model(text);
    run(&model, &model.studies[0], &mut Silent).unwrap()
}

/// Both files move through the same poses; the size of what is compared is about 1 m or 1 rad.
fn agree(drawn: &str, given: &str) {
    let (drawn_text, given_text) = (drawn, given);
    let (drawn, given) = (table(drawn_text), table(given_text));
    assert_eq!(drawn.table.rows(), given.table.rows());
    assert_eq!(drawn.table.unreached() + given.table.unreached(), 0);
    let mut compared = 0;
    for column in &drawn.table.columns {
        let other = given.table.column(&column.name).unwrap();
        for (a, b) in column.si().iter().zip(other.si()) {
            assert!(
                (a - b).abs() < 1e-12,
                "{}: {a} {b}\n{drawn_text}{given_text}",
                column.name
            );
            compared += 1;
        }
    }
    assert!(compared > 50);
    // one assembly is meant, and it is the drawn one
    let found = check(&model(drawn_text));
    assert_eq!(found.diagnostics, [], "{drawn_text}");
}

fn d(a: [f64; 2], b: [f64; 2]) -> f64 {
    hypot(b[0] - a[0], b[1] - a[1])
}

/// The direction from one point to another, deg.
fn deg(a: [f64; 2], b: [f64; 2]) -> f64 {
    atan2(b[1] - a[1], b[0] - a[0]).to_degrees()
}

/// A point in the coordinates of a link from `a` along `b`.
fn on(a: [f64; 2], b: [f64; 2], p: [f64; 2]) -> [f64; 2] {
    let (x, r) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let size = hypot(x[0], x[1]);
    [
        (x[0] * r[0] + x[1] * r[1]) / size,
        (x[0] * r[1] - x[1] * r[0]) / size,
    ]
}

const UNITS: &str = "units = { length = \"m\", angle = \"deg\" }\n";
const A: [f64; 2] = [0.0, 0.0];
const B: [f64; 2] = [0.17, 0.11];
const C: [f64; 2] = [0.55, 0.38];
const D: [f64; 2] = [0.60, 0.0];
const P: [f64; 2] = [0.30, 0.42];
const Q: [f64; 2] = [0.62, 0.71];
const O: [f64; 2] = [0.93, 0.35];
const PLACES: &str =
    "[places]\nA = [0, 0]\nB = [0.17, 0.11]\nC = [0.55, 0.38]\nD = [0.60, 0]\nP = [0.30, 0.42]\n";
const FOUR_BAR: &str = "frame = [\"A\", \"D\"]\ncrank = [\"A\", \"B\"]\ncoupler = [\"B\", \"C\", \"P\"]\nrocker = [\"D\", \"C\"]\n";
const MOTOR: &str = "[drives]\nmotor = { turns = \"crank\", speed = \"1 rad/s\" }\n";
const STUDY: &str = "[studies.turn]\nkind = \"motion\"\nrows = 25\n";

#[test]
fn a_four_bar() {
    let columns = "columns = [\"angle(coupler)\", \"angle(rocker)\", \"x(P)\", \"y(P)\", \"x(C)\", \"rate(y(P))\"]\n";
    let [px, py] = on(B, C, P);
    for (b, side) in [(B, "left"), ([0.17, -0.11], "left")] {
        let drawn = format!("{UNITS}{PLACES}[links]\n{FOUR_BAR}{MOTOR}{STUDY}{columns}")
            .replace("B = [0.17, 0.11]", &format!("B = [{:?}, {:?}]", b[0], b[1]));
        let [px, py] = if b == B { [px, py] } else { on(b, C, P) };
        let given = format!(
            "{UNITS}[links]\nframe = {{ A = [0, 0], D = [0.6, 0] }}\ncrank = {{ A-B = {:?} }}\ncoupler = {{ B-C = {:?}, P = [{px:?}, {py:?}] }}\nrocker = {{ D-C = {:?} }}\n[drives]\nmotor = {{ turns = \"crank\", from = {:?}, speed = \"1 rad/s\" }}\n[assembly]\nC = \"{side} of B -> D\"\n{STUDY}{columns}",
            d(A, b),
            d(b, C),
            d(D, C),
            deg(A, b)
        );
        agree(&drawn, &given);
    }
}

#[test]
fn the_other_branch_is_the_other_drawing() {
    // C mirrored about B -> D: the same lengths, the other assembly
    let (u, v) = ([D[0] - B[0], D[1] - B[1]], [C[0] - B[0], C[1] - B[1]]);
    let t = 2.0 * (u[0] * v[0] + u[1] * v[1]) / (u[0] * u[0] + u[1] * u[1]);
    let c = [B[0] + t * u[0] - v[0], B[1] + t * u[1] - v[1]];
    let columns = "columns = [\"angle(rocker)\", \"x(C)\", \"y(C)\"]\n";
    let drawn = format!("{UNITS}{PLACES}[links]\n{FOUR_BAR}{MOTOR}{STUDY}{columns}")
        .replace("C = [0.55, 0.38]", &format!("C = [{:?}, {:?}]", c[0], c[1]));
    let given = format!(
        "{UNITS}[links]\nframe = {{ A = [0, 0], D = [0.6, 0] }}\ncrank = {{ A-B = {:?} }}\ncoupler = {{ B-C = {:?} }}\nrocker = {{ D-C = {:?} }}\n[drives]\nmotor = {{ turns = \"crank\", from = {:?}, speed = \"1 rad/s\" }}\n[assembly]\nC = \"right of B -> D\"\n{STUDY}{columns}",
        d(A, B),
        d(B, C),
        d(D, C),
        deg(A, B)
    );
    agree(&drawn, &given);
}

#[test]
fn a_six_bar() {
    let columns =
        "columns = [\"angle(output)\", \"x(Q)\", \"y(Q)\", \"x(P)\", \"rate(angle(output))\"]\n";
    let drawn = format!(
        "{UNITS}{PLACES}Q = [0.62, 0.71]\nO = [0.93, 0.35]\n[links]\n{}rod = [\"P\", \"Q\"]\noutput = [\"O\", \"Q\"]\n{MOTOR}{STUDY}{columns}",
        FOUR_BAR.replace("[\"A\", \"D\"]", "[\"A\", \"D\", \"O\"]")
    )
    .replace("speed", "to = 100, speed");
    let [px, py] = on(B, C, P);
    let given = format!(
        "{UNITS}[links]\nframe = {{ A = [0, 0], D = [0.6, 0], O = [0.93, 0.35] }}\ncrank = {{ A-B = {:?} }}\ncoupler = {{ B-C = {:?}, P = [{px:?}, {py:?}] }}\nrocker = {{ D-C = {:?} }}\nrod = {{ P-Q = {:?} }}\noutput = {{ O-Q = {:?} }}\n[drives]\nmotor = {{ turns = \"crank\", from = {:?}, to = 100, speed = \"1 rad/s\" }}\n[assembly]\nC = \"left of B -> D\"\nQ = \"left of P -> O\"\n{STUDY}{columns}",
        d(A, B),
        d(B, C),
        d(D, C),
        d(P, Q),
        d(O, Q),
        deg(A, B)
    );
    agree(&drawn, &given);
}

#[test]
fn a_slider_crank_driven_at_either_end() {
    let (b, c) = ([0.1, 0.3], [0.9, -0.05]);
    let columns = "columns = [\"angle(rod)\", \"x(C)\", \"y(B)\", \"angle(piston)\"]\n";
    let drives = [
        (
            "turns = \"crank\"",
            deg(A, b),
            "to = 200, speed = \"1 rad/s\"",
        ),
        (
            "slides = \"piston\"",
            c[0] - 0.2,
            "to = 0.5, speed = \"1 m/s\"",
        ),
    ];
    for (what, from, rest) in drives {
        // a piston of one point is parallel to its guide, one of two is as drawn
        for (more, listed, own) in [
            ("", "[\"C\"]", "C = [0, 0]"),
            ("G = [1.0, -0.05]\n", "[\"C\", \"G\"]", "C-G = 0.1"),
        ] {
            let drawn = format!(
                "{UNITS}[places]\nA = [0, 0]\nB = [0.1, 0.3]\nC = [0.9, -0.05]\nE = [0.2, -0.05]\nF = [2, -0.05]\n{more}[links]\nframe = [\"A\", \"E\", \"F\"]\ncrank = [\"A\", \"B\"]\nrod = [\"B\", \"C\"]\npiston = {listed}\n[joints]\nbore = {{ slider = \"piston\", at = \"C\", on = \"E -> F\" }}\n[drives]\nmotor = {{ {what}, {rest} }}\n{STUDY}{columns}"
            );
            let given = format!(
                "{UNITS}[links]\nframe = {{ A = [0, 0], E = [0.2, -0.05], F = [2, -0.05] }}\ncrank = {{ A-B = {:?} }}\nrod = {{ B-C = {:?} }}\npiston = {{ {own} }}\n[joints]\nbore = {{ slider = \"piston\", at = \"C\", on = \"E -> F\" }}\n[drives]\nmotor = {{ {what}, from = {from:?}, {rest} }}\n[assembly]\nB = {{ near = [0.1, 0.3] }}\nC = {{ near = [0.9, -0.05] }}\n{STUDY}{columns}",
                d(A, b),
                d(b, c)
            );
            agree(&drawn, &given);
        }
    }
}

#[test]
fn an_arm_lifted_by_a_cylinder() {
    let (f, b, l) = ([-0.25, 0.75], [0.85, 0.85], [1.9, 0.25]);
    let a = [0.0, 1.6];
    let columns = "columns = [\"angle(arm)\", \"x(L)\", \"y(L)\"]\n";
    let drawn = format!(
        "{UNITS}[places]\nA = [0, 1.6]\nF = [-0.25, 0.75]\nB = [0.85, 0.85]\nL = [1.9, 0.25]\n[links]\nframe = [\"A\", \"F\"]\narm = [\"A\", \"L\", \"B\"]\n[drives]\nlift = {{ cylinder = \"F-B\", to = 1.8, speed = \"1 m/s\" }}\n{STUDY}{columns}"
    );
    let [bx, by] = on(a, l, b);
    let given = format!(
        "{UNITS}[links]\nframe = {{ A = [0, 1.6], F = [-0.25, 0.75] }}\narm = {{ A-L = {:?}, B = [{bx:?}, {by:?}] }}\n[drives]\nlift = {{ cylinder = \"F-B\", from = {:?}, to = 1.8, speed = \"1 m/s\" }}\n[assembly]\nB = {{ near = [0.85, 0.85] }}\n{STUDY}{columns}",
        d(a, l),
        d(f, b)
    );
    agree(&drawn, &given);
    // held where it is drawn, it stays there
    let held = drawn.replace("to = 1.8, speed = \"1 m/s\"", "at = \"drawn\"");
    let result = table(&held.replace("rows = 25\n", ""));
    let y = result.table.column("y(L)").unwrap().si();
    assert!(y.iter().all(|y| (y - 0.25).abs() < 1e-12), "{y:?}");
}

#[test]
fn gears_mesh_as_they_are_drawn() {
    let text = format!(
        "{UNITS}[places]\nA = [0, 0]\nB = [0.3, 0.1]\nD = [0.6, 0]\nC = [0.5, 0.2]\n[links]\nframe = [\"A\", \"D\"]\nsun = [\"A\", \"B\"]\nwheel = [\"D\", \"C\"]\n[joints]\nmesh = {{ gears = [\"sun\", \"wheel\"], teeth = [20, 30] }}\n[drives]\nmotor = {{ turns = \"sun\", to = 100, speed = \"1 rad/s\" }}\n{STUDY}columns = [\"x(C)\", \"y(C)\", \"angle(wheel)\"]\n"
    );
    let result = table(&text);
    let at = |name: &str| result.table.column(name).unwrap().si();
    assert!((at("x(C)")[0] - 0.5).abs() < 1e-12 && (at("y(C)")[0] - 0.2).abs() < 1e-12);
    let turned = at("angle(wheel)")[24] - at("angle(wheel)")[0];
    let sun = (100.0 - deg(A, [0.3, 0.1])).to_radians();
    assert!((turned + sun * 20.0 / 30.0).abs() < 1e-12);
}

/// A drawing whose places follow parameters.
fn drawn_with(c: f64, px: f64) -> String {
    let places = PLACES
        .replace(
            "C = [0.55, 0.38]",
            "C = [\"0.5 * c + 0.25 m\", \"sqrt(c^2 - 0.2156 m^2)\"]",
        )
        .replace("P = [0.30", "P = [\"px\"");
    format!(
        "{UNITS}[parameters]\nc = \"{c:?} m\"\npx = \"{px:?} m\"\n{places}[links]\n{}{MOTOR}[measures]\nswing = \"angle(rocker)\"\nreach = \"x(P)\"\nheight = \"y(P)\"\n",
        FOUR_BAR.replace(
            "[\"D\", \"C\"]",
            "{ points = [\"D\", \"C\"], D-C = \"0.64 * c\" }"
        )
    )
}

#[test]
fn derivatives_to_parameters_of_places_are_those_of_differences() {
    let setting = kempe_study::Setting::new("motor", 1.3);
    let values = |c: f64, px: f64| -> Vec<f64> {
        let found = sensitivities(&model(&drawn_with(c, px)), Some(&setting), &mut Silent).unwrap();
        found.measures.iter().map(|m| m.value).collect()
    };
    let found = sensitivities(&model(&drawn_with(0.6, 0.3)), Some(&setting), &mut Silent).unwrap();
    let h = 1e-3;
    for (k, step) in [[h, 0.0], [0.0, h]].into_iter().enumerate() {
        let at = |n: f64| values(0.6 + n * step[0], 0.3 + n * step[1]);
        // central differences of sixth order
        let around: Vec<_> = [-3.0, -2.0, -1.0, 1.0, 2.0, 3.0]
            .map(at)
            .into_iter()
            .collect();
        for (i, measure) in found.measures.iter().enumerate() {
            let f = |n: usize| around[n][i];
            let slope = (45.0 * (f(3) - f(2)) - 9.0 * (f(4) - f(1)) + (f(5) - f(0))) / (60.0 * h);
            let exact = measure.derivatives[k].value;
            let size = exact.abs().max(measure.value.abs());
            assert!(
                (slope - exact).abs() < 1e-8 * size,
                "{}: {slope} {exact}",
                measure.name
            );
        }
    }
    assert_eq!(found.measures.len(), 3);
}

#[test]
fn every_point_starts_where_it_is_drawn_whatever_the_parameters() {
    for (c, px) in [(0.6, 0.3), (0.57, 0.35), (0.66, 0.1)] {
        let text = drawn_with(c, px)
            .replace(", D-C = \"0.64 * c\"", "")
            .replace("speed", "to = 60, speed");
        let model = model(&text);
        let columns = "[studies.s]\nkind = \"motion\"\nrows = 3\ncolumns = [\"x(B)\", \"y(B)\", \"x(C)\", \"y(C)\", \"x(P)\", \"y(P)\"]\n";
        let result = table(&(text + columns));
        let parameters: Vec<f64> = model.parameter_values();
        for (point, place) in &model.drawing.places {
            let name = &model.points[point.index()].name;
            for (axis, at) in ["x", "y"].into_iter().zip(&place.at) {
                if let Some(column) = result.table.column(&format!("{axis}({name})")) {
                    let off = column.si()[0] - value(at, &parameters);
                    assert!(off.abs() < 1e-12, "{axis}({name}): {off}");
                }
            }
        }
    }
}

#[test]
fn check_tells_the_lengths_and_what_is_not_as_drawn() {
    let text = format!(
        "{UNITS}{PLACES}[links]\n{}{MOTOR}",
        FOUR_BAR
            .replace("[\"D\", \"C\"]", "{ points = [\"D\", \"C\"], D-C = 0.4 }")
            .replace("[\"A\", \"B\"]", "{ A-B = 0.2 }")
    );
    let report = check(&model(&text)).to_text();
    let expected = "Drawn as
  frame    A-D 0.6 m
  crank    A-B 0.2 m (drawn 0.202485 m)
  coupler  B-C 0.466154 m, B-P 0.336155 m, C-P 0.25318 m
  rocker   D-C 0.4 m (drawn 0.383275 m)
";
    assert!(report.contains(expected), "{report}");
}
