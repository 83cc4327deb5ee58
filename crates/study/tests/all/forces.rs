//! Studies of forces, from the text of a file to the rows of a table.
#![allow(
    clippy::disallowed_methods,
    reason = "numbers found by hand beside ours, not reproducible ones"
)]

use crate::told::{column, scalar};
use kempe_model::{Diagnostic, Model};
use kempe_study::{Figure, Silent, StudyResult, check, encode, run};

/// A crank-rocker of steel bars, upright, with a spring to the frame.
const FOUR_BAR: &str = r#"
units = { length = "mm", angle = "deg" }
gravity = "9.81 m/s^2"
[links]
frame   = { A = [0, 0], D = [60, 0], S = [-30, 40] }
crank   = { A-B = 20, mass = "0.2 kg", inertia = "8 kg mm^2", center = "centroid" }
coupler = { B-C = 50, P = [25, 10], mass = "0.5 kg", inertia = "110 kg mm^2", center = "P" }
rocker  = { D-C = 40, mass = "0.4 kg", inertia = "60 kg mm^2", center = [15, 3] }
[drives]
motor = { turns = "crank", from = 0, to = 360, speed = "20 rad/s" }
[assembly]
C = "left of B -> D"
[springs]
back = { between = "S-P", stiffness = "0.4 N/mm", free = "30 mm" }
[measures]
swing  = "angle(rocker)"
effort = "torque(motor)"
gap    = "power(motor) - rate(kinetic_energy + potential_energy)"
heavy  = "max(reaction(B))"
"#;

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

fn ran(text: &str) -> StudyResult {
    let model = model(text);
    match run(&model, &model.studies[0], &mut Silent) {
        Ok(result) => result,
        Err(found) => panic!("{}", rendered(&found, text)),
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |a, b| a.max(b.abs()))
}

#[test]
fn without_columns_everything_that_joints_and_drives_carry_is_there() {
    let result = ran(&format!(
        "{FOUR_BAR}[studies.loads]\nkind = \"forces\"\nstep = 2\n"
    ));
    for name in [
        "effort",
        "torque(motor)",
        "power(motor)",
        "reaction(A, crank)",
        "reaction_x(B, coupler)",
        "reaction_y(C, rocker)",
        "reaction_angle(D, rocker)",
        "shaking_force",
        "shaking_moment",
    ] {
        assert!(
            column(&result, name).iter().all(|v| v.is_finite()),
            "{name}"
        );
    }
    let head = |name: &str| result.table.column(name).map(|c| c.head());
    assert_eq!(head("kinetic_energy"), Some("kinetic_energy [J]".into()));
    assert_eq!(head("torque(motor)"), Some("torque(motor) [N m]".into()));
    // Both routes, and the power of the motor against what the energies gain.
    assert!(
        result
            .table
            .worst_route_difference()
            .is_some_and(|(_, d)| d < 1e-12)
    );
    let gap = largest(&column(&result, "gap"));
    assert!(
        gap < 1e-11 * largest(&column(&result, "power(motor)")),
        "{gap}"
    );
    // Size and direction are those of the components.
    let polar = |name: &str| {
        let size = column(&result, &format!("reaction({name})"));
        let angle = column(&result, &format!("reaction_angle({name})"));
        let x = column(&result, &format!("reaction_x({name})"));
        let y = column(&result, &format!("reaction_y({name})"));
        for (((r, a), x), y) in size.iter().zip(&angle).zip(&x).zip(&y) {
            let (sin, cos) = a.to_radians().sin_cos();
            assert!((r * cos - x).abs() < 1e-12 * r && (r * sin - y).abs() < 1e-12 * r);
        }
    };
    polar("B, coupler");
    polar("D, rocker");
    // Largest over the motion, between rows: no less than in any row, and hardly more.
    let rows = largest(&column(&result, "reaction(B, coupler)"));
    let heavy = result
        .scalars
        .iter()
        .find(|s| s.name == "heavy")
        .map_or(f64::NAN, |s| s.value);
    assert!(heavy >= rows && heavy < 1.001 * rows, "{heavy} {rows}");
    let csv = encode::csv(&result.table);
    let head = csv.lines().next().unwrap_or("");
    assert!(
        head.ends_with("closure [1],smallest_singular_value [1],route_difference [1],equilibrium_residual [1],condition [1],note"),
        "{head}"
    );
    assert!(result.diagnostics.is_empty(), "{:?}", result.diagnostics);
}

/// What acts on every body of every row adds up to `m a`: arrows, weights and springs against the table's accelerations.
#[test]
fn arrows_are_in_equilibrium_with_the_motion() {
    let text = FOUR_BAR.replace(
        "[measures]",
        "[measures]\nax = \"rate(x(P), 2)\"\nay = \"rate(y(P), 2)\"",
    );
    let text = format!("{text}[studies.loads]\nkind = \"forces\"\nrows = 7\n");
    let model = model(&text);
    let result = ran(&text);
    let coupler = model
        .links
        .iter()
        .position(|l| l.name == "coupler")
        .unwrap_or(0);
    let (ax, ay) = (
        result.table.column("ax").unwrap().si(),
        result.table.column("ay").unwrap().si(),
    );
    for (row, frame) in result.frames.iter().enumerate() {
        let mut sum = [0.0, 0.0];
        let mut size = 0.0_f64;
        for arrow in &frame.arrows {
            // The pin at C is told on the rocker, its later link: the coupler feels the opposite.
            let sign = match arrow.name.as_str() {
                "C" => -1.0,
                _ if arrow.link.index() == coupler => 1.0,
                _ => continue,
            };
            size = size.max(arrow.force[0].hypot(arrow.force[1]));
            sum = [
                sum[0] + sign * arrow.force[0],
                sum[1] + sign * arrow.force[1],
            ];
        }
        let rest = [sum[0] - 0.5 * ax[row], sum[1] - 0.5 * ay[row]];
        assert!(
            rest[0].hypot(rest[1]) < 1e-12 * size,
            "row {row}: {rest:?} of {size}"
        );
    }
}

#[test]
fn a_motion_leaves_out_what_needs_forces() {
    let result = ran(FOUR_BAR);
    let heads: Vec<String> = result
        .table
        .columns
        .iter()
        .map(|c| c.name.clone())
        .collect();
    assert_eq!(heads, ["time", "motor", "swing"]);
    assert!(result.scalars.is_empty() && result.table.forces.is_none());
}

#[test]
fn pictures_hold_several_curves_and_hodographs() {
    let plots = "plot = [[\"kinetic_energy\", \"potential_energy\"], \"hodograph(B)\", \"path(P)\", \"effort\"]";
    let result = ran(&format!(
        "{FOUR_BAR}[studies.loads]\nkind = \"forces\"\nrows = 5\ncolumns = \"effort\"\n{plots}\n"
    ));
    assert_eq!(result.figures.len(), 4);
    assert!(
        matches!(&result.figures[0], Figure::Curves { curves: both, .. } if both.len() == 2 && both[1].values.len() == 5)
    );
    let Figure::Hodograph(name, [x, y]) = &result.figures[1] else {
        panic!("{:?}", result.figures[1]);
    };
    assert_eq!(
        (name.as_str(), x.values.len(), y.values.len()),
        ("hodograph(B)", 5, 5)
    );
    assert!(
        matches!(&result.figures[3], Figure::Curves { curves: one, .. } if one[0].name == "effort")
    );
    assert_eq!(result.table.columns.len(), 3);
}

const LIFT: &str = r#"
[links]
frame = { A = [0, 0], F = [0.5, -0.4] }
boom  = { A-T = 2, B = [0.8, 0], mass = "200 kg", inertia = "70 kg m^2", center = "centroid" }
[drives]
lift = { cylinder = "F-B", from = "0.45 m", to = "0.95 m", speed = "20 mm/s" }
[assembly]
T = { near = [2, 0] }
[loads]
hook = { force = [0, "-26 kN"], at = "T" }
[cylinders]
lift = { bore = "80 mm", rod = "50 mm", supply = "160 bar" }
[studies.loads]
kind = "forces"
"#;

#[test]
fn a_cylinder_that_is_too_weak_is_told_once_with_the_worst_place() {
    let result = ran(LIFT);
    let weak: Vec<_> = result
        .diagnostics
        .iter()
        .filter(|d| d.code == "cylinder-too-weak")
        .collect();
    assert_eq!(weak.len(), 1, "{:?}", result.diagnostics);
    let force = column(&result, "force(lift)");
    let capacity = column(&result, "capacity(lift)");
    let pressure = column(&result, "pressure(lift)");
    let worst = (0..force.len())
        .max_by(|a, b| pressure[*a].total_cmp(&pressure[*b]))
        .unwrap_or(0);
    let at = column(&result, "lift")[worst];
    assert!(
        weak[0].message.contains("lift needs") && weak[0].message.contains("has 160"),
        "{}",
        weak[0].message
    );
    assert!(
        weak[0].message.contains(&format!("lift = {at:.6}")),
        "{} {at}",
        weak[0].message
    );
    let rows = force.iter().zip(&capacity).filter(|(f, c)| f > c).count();
    assert!(
        weak[0].notes[0].contains(&format!("in {rows} of")),
        "{:?}",
        weak[0].notes
    );
    // A boom that hardly moves: moments about its pivot.
    for (force, expected) in force.iter().zip(moments_about_the_pivot()) {
        assert!(
            (force - expected).abs() < 2e-3 * expected.abs(),
            "{force} {expected}"
        );
    }
}

/// What a few rows do not meet is told as what many do, but for the rows.
#[test]
fn a_cylinder_that_is_too_weak_between_rows_is_told() {
    let told = |rows: usize| {
        let text = format!(
            "[links]\nframe = {{ A = [0, 0], F = [0.5, -0.4] }}\nboom = {{ A-T = 2, B = [0.8, 0], mass = \"200 kg\", inertia = \"70 kg m^2\" }}\n\
             [drives]\nlift = {{ cylinder = \"F-B\", from = 0.45, to = 1.1, speed = \"20 mm/s\" }}\n[assembly]\nT = {{ near = [2, 0] }}\n\
             [loads]\nhook = {{ force = [\"-30 kN*sin(pi/1 s*0.0307692307692307692*time * 1 rad)\", 0], at = \"T\" }}\n\
             [cylinders]\nlift = {{ bore = \"80 mm\", rod = \"50 mm\", supply = \"160 bar\", back = \"5 bar\" }}\n\
             [studies.s]\nkind = \"forces\"\nrows = {rows}\ncolumns = [\"force(lift)\"]\n"
        );
        let found = ran(&text).diagnostics.into_iter();
        let mut weak = found.filter(|d| d.code == "cylinder-too-weak");
        let one = weak.next().unwrap();
        assert!(weak.next().is_none());
        one
    };
    let [few, many] = [2, 2000].map(told);
    let bar = |message: &str| -> f64 {
        let needs = message.split("lift needs ").nth(1).unwrap();
        needs.split(' ').next().unwrap().parse().unwrap()
    };
    assert!(
        (bar(&few.message) - bar(&many.message)).abs() < 0.05,
        "{few:?} {many:?}"
    );
    assert_eq!(few.notes, ["between the rows"]);
}

/// The boom's cylinder force at rest by hand, row by row.
fn moments_about_the_pivot() -> Vec<f64> {
    let (fx, fy, ab) = (0.5_f64, -0.4_f64, 0.8_f64);
    let af = fx.hypot(fy);
    let foot = fy.atan2(fx);
    (0..=180)
        .map(|k| {
            let length = 0.45 + 0.5 * f64::from(k) / 180.0;
            let at_a = ((af * af + ab * ab - length * length) / (2.0 * af * ab)).acos();
            let boom = foot + at_a;
            // Lever of the cylinder's line about A.
            let lever = af * ab * at_a.sin() / length;
            // The centroid of A, T and B.
            let center = (2.0 + 0.8) / 3.0;
            (26e3 * 2.0 + 200.0 * 9.81 * center) * boom.cos() / lever
        })
        .collect()
}

#[test]
fn loads_that_equilibrium_does_not_determine_are_named() {
    let text = r#"
[links]
frame = { A = [0, 0], D = [2, 0], G = [1, 0] }
left  = { A-B = 0.5 }
bar   = { B = [0, 0], C = [2, 0], H = [1, 0], mass = "10 kg", inertia = "3 kg m^2", center = "H" }
right = { D-C = 0.5 }
mid   = { G-H = 0.5 }
[drives]
motor = { turns = "left", from = "20 deg", to = "160 deg", speed = "1 rad/s" }
[assembly]
C = { near = [2.4, 0.2] }
[studies.loads]
kind = "forces"
"#;
    let result = ran(text);
    let loose: Vec<_> = result
        .diagnostics
        .iter()
        .filter(|d| d.code == "reactions-not-unique")
        .collect();
    assert_eq!(loose.len(), 1, "{:?}", result.diagnostics);
    assert!(
        loose[0].message.contains("overconstrained") && loose[0].message.contains('H'),
        "{}",
        loose[0].message
    );
    // The torque is unique all the same.
    assert!(
        result
            .table
            .worst_route_difference()
            .is_some_and(|(_, d)| d < 1e-10)
    );
}

#[test]
fn at_a_change_point_the_torque_is_finite_and_the_rows_say_why_joints_are_not() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../examples/seeds/door-lock.toml"
    );
    let text = std::fs::read_to_string(path).expect("the lock");
    let text = text.replace(
        "kind = \"forces\"\nstep = 1",
        "kind = \"forces\"\nstep = 167.5122065166411",
    );
    let model = model(&text);
    let study = model
        .studies
        .iter()
        .find(|s| s.name == "ideal")
        .expect("forces");
    let result = run(&model, study, &mut Silent).expect("rows");
    assert!(
        column(&result, "torque(lock)")
            .iter()
            .all(|v| v.is_finite())
    );
    let first = result.table.notes[1].as_deref().unwrap_or("");
    assert!(first.contains("singular"), "{first}");
    assert!(
        result
            .diagnostics
            .iter()
            .any(|d| d.code == "singular-pose" || d.code == "nearly-singular"),
        "{:?}",
        result.diagnostics
    );
}

/// A law that comes to rest ends at rest, whatever rounding leaves of its speed: friction is not counted there.
#[test]
fn friction_is_not_counted_where_the_motion_comes_to_rest() {
    let text = r#"
[links]
frame = { A = [0, 0], P = [3.2, -0.7] }
body  = { A = [0, 0], Q = [3.6, 0.1], G = [2.1, 0.8], mass = "15000 kg", inertia = "1 kg m^2", center = "G" }
[drives]
lift = { cylinder = "P-Q", from = 0.9, to = 3.65, law = "3-4-5", in = "15 s" }
[assembly]
Q = "right of P -> A"
[studies.t]
kind = "forces"
rows = 4
columns = "force(lift)"
"#;
    let free = column(&ran(text), "force(lift)");
    let rubbed = text.replace(
        "[assembly]",
        "[friction]\nall = { coefficient = 0.1, radius = \"50 mm\" }\n[assembly]",
    );
    let result = ran(&rubbed);
    let rubbed = column(&result, "force(lift)");
    for row in [0, 3] {
        assert!(
            (free[row] - rubbed[row]).abs() < 1e-9 * free[row].abs(),
            "{free:?} {rubbed:?}"
        );
        let note = result.table.notes[row].as_deref().unwrap_or("");
        assert!(note.contains("at rest"), "{note}");
    }
    assert!((free[1] - rubbed[1]).abs() > 1e-4 * free[1].abs());
}

/// A weight on a pivot whose pin rubs: the support's force passes on the friction circle, beside the centre.
#[test]
fn a_pin_rubs_on_the_friction_circle() {
    let text = r#"
[links]
frame = { A = [0, 0] }
body  = { A = [0, 0], G = [1, 0], mass = "100 kg", inertia = 0, center = "G" }
[friction]
A = { coefficient = 0.3, radius = "50 mm" }
[drives]
m = { turns = "body", from = "0 deg", to = "90 deg", speed = "1e-6 rad/s" }
[studies.t]
kind = "forces"
rows = 2
columns = "torque(m)"
"#;
    let torque = column(&ran(text), "torque(m)");
    let circle = 0.05 * 0.3_f64.atan().sin();
    assert!(
        (torque[0] - 981.0 * (1.0 + circle)).abs() < 1e-6,
        "{torque:?}"
    );
    assert!((torque[1] - 981.0 * circle).abs() < 1e-6, "{torque:?}");
}

/// Loads, dampers and motors are asked for by name; results are shown in the units that the file names.
#[test]
fn what_acts_is_measured_in_the_units_of_the_file() {
    let text = r#"
units = { length = "mm", angle = "deg", force = "kN", torque = "kN m", mass = "t" }
[links]
frame = { A = [0, 0], S = [0, 500] }
arm   = { A-B = 400, mass = 0.002, inertia = "0.1 kg m^2", center = [200, 0] }
[drives]
motor = { turns = "arm", from = 0, to = 90, speed = "2 rad/s" }
[loads]
hook  = { force = [0.3, -0.4], at = "B" }
brake = { torque = "-20 N m * cos(motor)", on = "arm" }
[dampers]
oil = { between = "S-B", damping = "50 N s/m" }
[motors]
motor = { curve = [["0 rad/s", "300 N m"], ["4 rad/s", "100 N m"]] }
[measures]
pull = "load(hook)"
side = "load_x(hook)"
stop = "load(brake)"
oily = "damper_force(oil)"
can  = "capacity(motor)"
rest = "torque(motor) - reduced_mass(motor) * rate(motor, 2) + reduced_load(motor)"
[studies.t]
kind = "forces"
rows = 4
columns = ["pull", "side", "load_y(hook)", "stop", "oily", "can", "torque(motor)", "reaction(A)", "rate(distance(S, B))", "rest"]
"#;
    let result = ran(text);
    let heads: Vec<String> = result.table.columns.iter().map(|c| c.head()).collect();
    assert!(
        heads.contains(&"pull [kN]".to_owned()) && heads.contains(&"can [kN m]".to_owned()),
        "{heads:?}"
    );
    let near = |name: &str, expected: &dyn Fn(usize) -> f64| {
        for (row, value) in column(&result, name).iter().enumerate() {
            assert!(
                (value - expected(row)).abs() < 1e-12,
                "{name} {row}: {value} {}",
                expected(row)
            );
        }
    };
    near("pull", &|_| 0.5);
    near("side", &|_| 0.3);
    near("load_y(hook)", &|_| -0.4);
    let angle = column(&result, "motor");
    near("stop", &|row| -0.02 * angle[row].to_radians().cos());
    let parting = column(&result, "rate(distance(S, B))");
    near("oily", &|row| 50.0 * parting[row] * 1e-3 * 1e-3);
    near("can", &|_| 0.2);
    near("rest", &|_| 0.0);
}

#[test]
fn values_that_are_missing_are_told() {
    let text = FOUR_BAR.replace(
        "[measures]",
        "[loads]\npush = { torque = \"1 N m deg / motor\", on = \"rocker\" }\n[measures]\nlog = \"ln(y(P) / 1 mm - 20)\"",
    );
    let result = ran(&format!(
        "{text}[studies.t]\nkind = \"forces\"\nrows = 13\ncolumns = [\"log\", \"effort\"]\n"
    ));
    let codes: Vec<&str> = result.diagnostics.iter().map(|d| d.code).collect();
    assert!(
        codes.contains(&"no-value") && codes.contains(&"load-without-value"),
        "{codes:?}"
    );
    assert!(
        result.table.notes[0]
            .as_deref()
            .is_some_and(|n| n.contains("`push`"))
    );
    assert!(result.table.notes[3].is_none());
}

#[test]
fn a_peak_over_a_singular_pose_is_told_as_one() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../examples/seeds/door-lock.toml"
    );
    let text = std::fs::read_to_string(path).expect("the lock");
    let text = text.replace("[studies.turn]", "load = \"reaction(O)\"\npeak = \"max(load)\"\neffort = \"max(torque(lock))\"\n[studies.turn]");
    let run_to = |text: &str| {
        let model = model(text);
        let study = model
            .studies
            .iter()
            .find(|s| s.name == "ideal")
            .expect("forces");
        let warnings = run(&model, study, &mut Silent).expect("rows").diagnostics;
        let diagnostic = warnings.into_iter().filter(|d| d.code == "unbounded-load");
        diagnostic.map(|d| d.message).collect::<Vec<_>>()
    };
    let diagnostic = run_to(&text);
    assert!(
        diagnostic.len() == 1
            && diagnostic[0].contains("`peak`")
            && diagnostic[0].contains("lock = 117.512 deg"),
        "{diagnostic:?}"
    );
    assert!(run_to(&text.replace("to = 125", "to = 110")).is_empty());
}

#[test]
fn check_tells_all_that_acts() {
    let text = "units = { length = \"mm\", angle = \"deg\" }\ngravity = [\"9.81 m/s^2\", \"-30 deg\"]\n[links]\n\
                frame = { A = [0, 0], F = [50, -40] }\narm = { A-T = 200, B = [80, 0] }\n[drives]\n\
                lift = { cylinder = \"F-B\", from = 60, to = 90, speed = \"20 mm/s\" }\n[assembly]\nT = { near = [200, 0] }\n\
                [masses]\nbob = { at = \"T\", mass = \"1 kg\" }\n[friction]\nA = { coefficient = 0.1, radius = \"5 mm\" }\n\
                all = { coefficient = 0.1, radius = \"5 mm\" }\n[cylinders]\nlift = { bore = 20, rod = 10 }\n[clearance]\nall = { radial = \"0.1 mm\" }\n\
                [studies.f]\nkind = \"forces\"\n";
    let said = kempe_study::check(&model(text)).to_text();
    for line in [
        "point masses  bob",
        "friction      A, all other joints but for the pins of cylinder drive `lift`",
        "clearance     all 0.1 mm but for the pins of cylinder drive `lift`",
        "cylinders     lift",
        "gravity       [8.49571, -4.905] m/s^2",
        "study f       forces, a row every 0.166667 mm of lift",
    ] {
        assert!(said.contains(line), "{line}: {said}");
    }
}

#[test]
fn a_hodograph_of_rounding_is_a_point() {
    let text = format!(
        "{FOUR_BAR}[studies.loads]\nkind = \"forces\"\nrows = 9\ncolumns = [\"reaction_x(B, coupler)\"]\n"
    );
    let (model, mut result) = (model(&text), ran(&text));
    let noisy = |column: &kempe_study::Column| {
        let mut column = column.clone();
        column.values.iter_mut().for_each(|v| *v *= 1e-15);
        column
    };
    let loads = column(&result, "reaction_x(B, coupler)");
    assert!(largest(&loads) > 0.0);
    let real = result
        .table
        .column("reaction_x(B, coupler)")
        .expect("a column")
        .clone();
    result.figures = vec![
        kempe_study::Figure::Hodograph("real".into(), [real.clone(), real.clone()]),
        kempe_study::Figure::Hodograph("none".into(), [noisy(&real), noisy(&real)]),
    ];
    let drawn = kempe_study::figures(&model, &result);
    let values = |index: usize| -> f64 { largest(&drawn[index].1.curves[0].x) };
    assert!(values(0) > 0.0);
    assert_eq!(values(1), 0.0);
}

/// The reader takes the period of a table for a number: how forces change with it is not known, and told so.
#[test]
fn forces_have_no_derivative_to_the_period_of_a_table() {
    const CARD: &str = "phi [deg],M [N m]\n0,1\n90,2\n360,1\n";
    let text = FOUR_BAR.replace(
        "[measures]\n",
        "[parameters]
whole = \"360 deg\"
per = \"whole\"
arm = \"1 mm\"
[loads]
g = { torque = { table = \"card.csv\", over = \"angle(crank)\", period = \"per\", factor = \"arm / (1 mm)\" }, on = \"crank\" }
[measures]
t = \"mean(torque(motor))\"
y = \"range(y(P))\"
",
    );
    let read = Model::from_toml(&text, "test", &mut |_| Ok(CARD.into()));
    let model = read.unwrap_or_else(|found| panic!("{}", rendered(&found, &text)));
    let found = kempe_study::sensitivities(&model.model, None, &mut Silent).unwrap();
    let slope = |measure: &str, parameter: &str| {
        let of = found.measures.iter().find(|m| m.name == measure).unwrap();
        let of = of.derivatives.iter().find(|d| d.parameter == parameter);
        of.unwrap().value
    };
    assert!(slope("t", "per").is_nan() && slope("t", "whole").is_nan());
    assert!(slope("t", "arm") != 0.0 && slope("t", "arm").is_finite());
    assert_eq!((slope("y", "per"), slope("y", "whole")), (0.0, 0.0));
    let told = found.diagnostics.iter();
    let told = told.filter(|d| d.code == "settled-parameter");
    assert_eq!(told.count(), 2);
}

/// A load's card with a peak narrower than any grid: its points are looked at, and nothing in the table lies beyond the
/// extremes.
#[test]
fn points_of_a_card_and_rows_lie_within_the_extremes() {
    const CARD: &str = "phi [deg],F [N]\n0,1\n100,1\n100.05,77\n100.1,1\n250,3\n360,1\n";
    let text = FOUR_BAR.replace(
        "[measures]\n",
        "[loads]
g = { force = [{ table = \"card.csv\", over = \"angle(crank)\", period = 360 }, 0], at = \"P\" }
s = { torque = \"-1 N m * exp(-((angle(rocker) - 120 deg) / (0.02 deg))^2)\", on = \"rocker\" }
[measures]
peak = \"max(load(g))\"
least = \"min(load(g))\"
all = \"mean(load(g))\"
most = \"max(effort)\"
fewest = \"min(effort)\"
work = \"mean(power(motor))\"
",
    ) + "[studies.loads]\nkind = \"forces\"\nstep = 0.05\ncolumns = [\"effort\"]\n";
    let model = Model::from_toml(&text, "test", &mut |_| Ok(CARD.into()))
        .unwrap_or_else(|found| panic!("{}", rendered(&found, &text)))
        .model;
    let result = run(&model, &model.studies[0], &mut Silent)
        .unwrap_or_else(|found| panic!("{}", rendered(&found, &text)));
    let number = |name: &str| {
        let scalar = result.scalars.iter().find(|s| s.name == name);
        scalar.map_or(f64::NAN, |s| s.value)
    };
    let near = |name: &str, truth: f64| {
        let found = number(name);
        assert!((found - truth).abs() < 1e-9 * truth, "{name}: {found}");
    };
    near("peak", 77.0);
    near("least", 1.0);
    // The card is flat at all of its points: every segment counts with the mean of its ends.
    near(
        "all",
        (100.0 * 1.0 + 0.1 * 39.0 + 149.9 * 2.0 + 110.0 * 2.0) / 360.0,
    );
    let effort = column(&result, "effort");
    let (low, high) = (number("fewest"), number("most"));
    assert!(
        effort.iter().all(|x| low <= *x && *x <= high),
        "{low} {high}"
    );
    // What the peak does is seen in the drive.
    assert!(high - low > 1.0, "{low} {high}");
}

/// A gas force at a wrist pin presses the piston, whatever the order of the links; at other pins of several links the file is
/// asked which is meant.
#[test]
fn a_load_at_a_pin_acts_on_the_slider_or_the_file_is_asked() {
    let text = |links: &str, load: &str| {
        format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\n[links]\nframe = {{ O = [0, 0], G = [0, 300] }}\n\
             crank = {{ O-A = 50 }}\n{links}\n[joints]\nbore = {{ slider = \"piston\", at = \"B\", on = \"O -> G\" }}\n\
             [drives]\nmotor = {{ turns = \"crank\", from = 30, to = 90, speed = \"60 rpm\" }}\n\
             [assembly]\nB = {{ near = [0, 200] }}\n[loads]\ngas = {{ force = [0, \"-10 kN\"], {load} }}\n\
             [studies.f]\nkind = \"forces\"\ncolumns = [\"reaction(B, rod)\"]\n"
        )
    };
    let rod_first = "rod = { A-B = 150 }\npiston = { B = [0, 0] }";
    let piston_first = "piston = { B = [0, 0] }\nrod = { A-B = 150 }";
    let told = |text: &str| {
        let read = Model::from_toml(text, "pin", &mut |_| Err("no files".into())).unwrap();
        let codes: Vec<&str> = read.warnings.iter().map(|d| d.code).collect();
        let result = run(&read.model, &read.model.studies[0], &mut Silent).unwrap();
        let report = check(&read.model);
        (
            codes,
            result.table.columns[2].values.clone(),
            report.assumptions.join("\n"),
        )
    };
    let (codes, named, _) = told(&text(rod_first, "at = \"B\", on = \"piston\""));
    assert!(codes.is_empty(), "{codes:?}");
    // The rod carries the gas force over its slope.
    assert!(named.iter().all(|f| *f > 9_999.9), "{named:?}");
    for links in [rod_first, piston_first] {
        let (codes, values, assumed) = told(&text(links, "at = \"B\""));
        assert!(codes.is_empty(), "{codes:?}");
        assert_eq!(values, named);
        assert!(assumed.contains("gas (at B on piston)"), "{assumed}");
    }
    // A joint that could not be read is told alone: it may say which link is meant.
    let unread = text(rod_first, "at = \"B\"").replace("O -> G", "O -> K");
    let found = Model::from_toml(&unread, "pin", &mut |_| Err("no files".into())).unwrap_err();
    assert!(
        found.iter().all(|d| d.code != "link-not-named"),
        "{found:?}"
    );
    assert!(
        found
            .iter()
            .any(|d| d.severity == kempe_model::Severity::Error)
    );
    // On the rod itself the pin carries what presses the rod against the bore alone.
    let (_, on_rod, _) = told(&text(rod_first, "at = \"B\", on = \"rod\""));
    assert!(on_rod.iter().all(|f| *f < 5_000.0), "{on_rod:?}");
    let (codes, values, assumed) = told(&text(rod_first, "at = \"A\""));
    assert_eq!(codes, ["link-not-named"]);
    assert_eq!(
        values,
        told(&text(rod_first, "at = \"A\", on = \"crank\"")).1
    );
    assert!(assumed.contains("gas (at A on crank)"), "{assumed}");
    // Links that are welded together are one.
    let welded = text(
        &format!("{rod_first}\nplate = {{ O = [0, 0], A = [50, 0] }}"),
        "at = \"A\"",
    );
    let welded = welded
        .replace(
            "[drives]",
            "fast = { weld = [\"crank\", \"plate\"], at = \"O\" }\n[drives]",
        )
        .replace("rod = { A-B", "rod = { E-B")
        .replace("crank = { O-A = 50 }", "crank = { O-A = 50, E = [50, 0] }");
    let (codes, ..) = told(&welded);
    assert!(codes.is_empty(), "{codes:?}");
}

/// A four-bar whose coupler pin is also the end of a spring: the pin carries the spring's force or not, by the link it acts on.
#[test]
fn a_spring_and_a_cylinder_act_on_the_link_that_is_named() {
    let text = |on: &str, lift: &str| {
        format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\n[links]\nframe = {{ A = [0, 0], D = [60, 0], G = [30, 90] }}\n\
             crank = {{ A-B = 20 }}\ncoupler = {{ B-C = 50 }}\nrocker = {{ D-C = 40 }}\n\
             [assembly]\nC = \"left of B -> D\"\n[drives]\n{lift}\n\
             [springs]\nback = {{ between = \"C-G\", stiffness = 0, preload = \"100 N\"{on} }}\n\
             [studies.f]\nkind = \"forces\"\nrows = 13\ncolumns = [\"reaction_x(C, rocker)\", \"reaction_y(C, rocker)\", \"x(C)\", \"y(C)\", \"reaction(B)\"]\n"
        )
    };
    let turn = "m = { turns = \"crank\", from = 10, to = 100, speed = \"1 rad/s\" }";
    let told = |text: &str| {
        let read = Model::from_toml(text, "spring", &mut |_| Err("no files".into())).unwrap();
        let codes: Vec<&str> = read.warnings.iter().map(|d| d.code).collect();
        let again =
            kempe_model::Model::from_toml(&read.model.to_toml().toml, "spring", &mut |_| {
                Err("no files".into())
            });
        assert_eq!(
            again.unwrap().model.actions.springs[0].between,
            read.model.actions.springs[0].between
        );
        let result = run(&read.model, &read.model.studies[0], &mut Silent).unwrap();
        let columns: Vec<Vec<f64>> = result
            .table
            .columns
            .iter()
            .map(|c| c.values.clone())
            .collect();
        let column = |name: &str| {
            let at = result.table.columns.iter().position(|c| c.name == name);
            columns[at.unwrap()].clone()
        };
        let names = [
            "reaction_x(C, rocker)",
            "reaction_y(C, rocker)",
            "x(C)",
            "y(C)",
        ];
        (
            codes,
            names.map(column),
            check(&read.model).assumptions.join("\n"),
        )
    };
    let (codes, coupler, assumed) = told(&text(", on = \"coupler\"", turn));
    assert!(codes.is_empty(), "{codes:?}");
    assert!(assumed.contains("back (at C on coupler)"), "{assumed}");
    let (_, rocker, assumed) = told(&text(", on = [\"rocker\", \"frame\"]", turn));
    assert!(assumed.contains("back (at C on rocker)"), "{assumed}");
    for row in 0..13 {
        // The pin hands the spring's pull on where it acts on the other link.
        let [x, y] = [coupler[2][row], coupler[3][row]];
        let way = [30.0 - x, 90.0 - y];
        let length = way[0].hypot(way[1]);
        for k in 0..2 {
            let difference = coupler[k][row] - rocker[k][row];
            assert!(
                (difference - 100.0 * way[k] / length).abs() < 1e-9,
                "{row}: {difference}"
            );
        }
    }
    let (codes, unnamed, _) = told(&text("", turn));
    assert_eq!((codes, unnamed), (vec!["link-not-named"], coupler));
    // A cylinder is asked for its link where forces are asked for.
    let lift = "m = { cylinder = \"G-B\", from = 80, to = 90, speed = \"1 mm/s\" }";
    let on = ", on = \"rocker\"";
    assert_eq!(told(&text(on, lift)).0, ["link-not-named"]);
    let named = lift.replace("G-B\"", "G-B\", on = \"crank\"");
    let (codes, _, assumed) = told(&text(on, &named));
    assert!(
        codes.is_empty() && assumed.contains("drive m (at B on crank): 80 mm to 90 mm"),
        "{assumed}"
    );
    let motion = text(on, lift).replace("\"forces\"", "\"motion\"");
    let motion = motion.split("columns").next().unwrap().to_owned();
    let read = Model::from_toml(&motion, "spring", &mut |_| Err("no files".into())).unwrap();
    assert!(read.warnings.is_empty(), "{:?}", read.warnings);
}

/// An energy is one by whatever name, in rows, beside them and among derivatives.
#[test]
fn energies_are_told_in_joules_everywhere() {
    let bare = FOUR_BAR.split("[studies").next().unwrap_or_default();
    let more = "[measures]\nwhole = \"kinetic_energy + potential_energy\"\ntop = \"max(whole)\"\nleast = \"-top\"\nhalf = \"0.5*abs(whole)/2 + 1 J\"\ntq = \"torque(motor)\"";
    let bare = bare
        .replace("A-B = 20", "A-B = \"a\"")
        .replace("[measures]", more);
    let model = model(&format!(
        "{bare}\n[parameters]\na = \"20 mm\"\n\
         [studies.energy]\nkind = \"forces\"\nrows = 5\ncolumns = [\"whole\", \"kinetic_energy\", \"top\", \"least\", \"half\", \"tq\"]\n\
         [studies.best]\nkind = \"optimize\"\nover = \"energy\"\nvary = {{ a = [\"15 mm\", \"22 mm\"] }}\n\
         maximize = \"top\"\nsubject_to = [\"max(whole) <= 1e-6 J\", \"max(torque(motor)) <= 10 N m\"]\ndesigns = 60\n\
         [studies.made]\nkind = \"tolerance\"\nover = \"energy\"\nvary = {{ a = \"0.1 mm\" }}\n\
         columns = [\"top\"]\nlimits = [\"max(whole) <= 1 J\", \"max(torque(motor)) <= 10 N m\"]\nsamples = 200\n"
    ));
    let study = model.studies.iter().find(|s| s.name == "energy");
    let result = run(&model, study.expect("a study"), &mut Silent).expect("a result");
    let at = kempe_study::sensitivities(&model, None, &mut Silent);
    let derivatives = at.expect("derivatives").measures;
    for (name, unit) in [
        ("whole", "J"),
        ("kinetic_energy", "J"),
        ("top", "J"),
        ("least", "J"),
        ("half", "J"),
        ("tq", "N m"),
    ] {
        let column = result.table.column(name).expect("a column");
        assert_eq!(column.unit.text(), unit, "{name}");
        for scalar in result.scalars.iter().filter(|s| s.name == name) {
            assert_eq!(scalar.unit.text(), unit, "{name}");
        }
        for found in derivatives.iter().filter(|m| m.name == name) {
            assert_eq!(found.unit, unit, "{name}");
        }
    }
    assert!(derivatives.iter().any(|m| m.name == "top"));
    // What limits are of as well: those that are met or missed, and how far a piece's own keeps them.
    for name in ["best", "made"] {
        let study = model.studies.iter().find(|s| s.name == name);
        let result = run(&model, study.expect("a study"), &mut Silent).expect("a result");
        let told = |number: &str, unit: &str| {
            let rows = result.listings.iter().flat_map(|listing| &listing.rows);
            let rows: Vec<_> = rows
                .filter(|row| row.len() > 1 && row[0].starts_with(number))
                .collect();
            assert!(!rows.is_empty(), "{name}: {number}");
            for row in rows {
                assert!(row[1].ends_with(unit), "{name}: {row:?}");
            }
        };
        told("max(whole)", " J");
        told("max(torque(motor))", " N m");
        let notes = result.diagnostics.iter().flat_map(|told| &told.notes);
        let missed: Vec<_> = notes.filter(|note| note.contains("is missed by")).collect();
        assert!(missed.iter().all(|note| note.ends_with(" J")), "{missed:?}");
        assert_eq!(missed.len(), usize::from(name == "best"));
    }
}

/// The direction of a force jumps where it passes half a turn: its extremes are those of both sides, however many rows there are, by name or by formula.
#[test]
fn directions_of_forces_have_both_sides_of_half_a_turn() {
    let numbers = |rows: usize| {
        let text = format!(
            "units = {{ length = 'm', angle = 'rad' }}
[links]
frame = {{ A = [0.21, -0.1], D = [0.76, -0.44], S = [1, 1] }}
crank = {{ A-B = 0.17, mass = '1 kg', inertia = '0.01 kg m^2' }}
coupler = {{ B-C = 0.3, P = [0.1, 0.2], mass = '1 kg', inertia = '0.02 kg m^2' }}
rocker = {{ D-C = 0.66, mass = '0.5 kg', inertia = '0.02 kg m^2' }}
[drives]
motor = {{ turns = 'crank', from = 1.56, to = 7.84, speed = 3 }}
[assembly]
C = 'left of B -> D'
[springs]
pull = {{ between = 'S-P', on = ['frame', 'coupler'], stiffness = 50, free = 1, acts = 'tension' }}
[measures]
low = 'min(reaction_angle(B, coupler))'
high = 'max(reaction_angle(B, coupler))'
span = 'range(atan2(reaction_y(B, coupler), reaction_x(B, coupler)))'
[studies.turn]
kind = 'forces'
rows = {rows}
columns = ['low', 'high', 'span']
"
        );
        let result = ran(&text);
        ["low", "high", "span"].map(|name| column(&result, name)[0])
    };
    use std::f64::consts::{PI, TAU};
    for rows in [5, 361] {
        let found = numbers(rows);
        for (found, right) in found.iter().zip([-PI, PI, TAU]) {
            assert!((found - right).abs() < 1e-9, "{rows}: {found} {right}");
        }
    }
}

/// That nothing acts is told before the forces are found, too, once.
#[test]
fn forces_of_nothing_are_told_of_by_check_and_run() {
    for (mass, told) in [("", 1), (", mass = '1 kg'", 0)] {
        let text = format!(
            "[links]\nframe = {{ A = [0, 0] }}\nlever = {{ A-B = '1 m'{mass} }}\n[drives]\n\
             hand = {{ turns = 'lever', from = 0, to = 1, speed = '1 rad/s' }}\n[studies.work]\nkind = 'forces'\n"
        );
        for found in [check(&model(&text)).diagnostics, ran(&text).diagnostics] {
            let of_nothing = found.iter().filter(|d| d.code == "nothing-acts");
            assert_eq!(of_nothing.count(), told, "{found:?}");
        }
    }
}

/// A number without a value does not tell how near a pose was looked at.
#[test]
fn a_peak_at_a_singular_pose_itself_has_no_value_that_tells() {
    let text = "[links]\nframe = { A = [0, 0], E = ['-0.4 m', 0], F = ['0.4 m', 0] }\ncrank = { A-B = '50 mm' }\n\
                rod = { B-C = '150 mm' }\npiston = { C = [0, 0] }\n[joints]\nbore = { slider = 'piston', at = 'C', on = 'E -> F' }\n\
                [drives]\npush = { slides = 'piston', from = '550 mm', to = '600 mm', speed = '10 mm/s' }\n\
                [assembly]\nB = 'left of A -> C'\n[loads]\nbrake = { on = 'crank', torque = '1 N m' }\n\
                [measures]\npeak = 'max(reaction(A))'\n[studies.work]\nkind = 'forces'\nrows = 11\n";
    let result = ran(text);
    assert!(!result.scalars[0].value.is_finite());
    let found = result
        .diagnostics
        .iter()
        .find(|d| d.code == "unbounded-load");
    let notes = &found.expect("a warning").notes;
    assert!(
        notes.iter().all(|note| !note.contains("how near")),
        "{notes:?}"
    );
}

/// Beside a rest friction is looked at no nearer than it slides, and what lies between counts all the same.
#[test]
fn means_miss_nothing_beside_a_rest() {
    let means = |rows: u32| {
        let text = format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\n[links]\nframe = {{ A = [0, 0], D = [120, 0] }}\n\
             crank = {{ A-B = 40, mass = \"0.3 kg\", inertia = \"100 kg mm^2\" }}\n\
             coupler = {{ B-C = 100, mass = \"0.5 kg\", inertia = \"600 kg mm^2\" }}\nrocker = {{ D-C = 80 }}\n\
             [assembly]\nC = \"left of B -> D\"\n[friction]\nall = {{ coefficient = 0.1, radius = \"5 mm\" }}\n\
             [loads]\nhook = {{ force = [0, \"-3 N\"], at = \"C\", on = \"rocker\" }}\n[drives]\n\
             motor = {{ turns = \"crank\", from = 30, law = [{{ dwell = \"0.1 s\" }}, {{ rise = 60, in = \"0.3 s\", by = \"4-5-6-7\" }}, {{ dwell = \"0.1 s\" }}, {{ fall = 40, in = \"0.2 s\" }}] }}\n\
             [studies.s]\nkind = \"forces\"\nrows = {rows}\ncolumns = [\"mean(time)\", \"mean(torque(motor))\"]\n"
        );
        let read = Model::from_toml(&text, "rest", &mut |_| Err("no files".into()));
        let model = read.expect("a model").model;
        let result = run(&model, &model.studies[0], &mut Silent).expect("a result");
        ["mean(time)", "mean(torque(motor))"]
            .map(|name| result.table.column(name).expect("told").si()[0])
    };
    let few = means(3);
    let many = means(601);
    for [time, torque] in [few, many] {
        assert!((time - 0.35).abs() < 1e-10, "{time}");
        assert!(
            (torque / many[1] - 1.0).abs() < 1e-9,
            "{torque} of {}",
            many[1]
        );
    }
}

/// Of three links on one pin the file says which holds it: the others rub on that one, wherever the links stand in the file.
#[test]
fn friction_at_a_shared_pin_goes_by_its_holder_and_not_by_the_order_of_the_file() {
    const LINKS: [(&str, &str); 3] = [
        ("rod", "rod = { B-C = 150 }"),
        ("upper", "upper = { D-C = 120 }"),
        ("lower", "lower = { C-E = 120 }"),
    ];
    let peak = |order: [usize; 3], holder: Option<&str>| {
        let links = order.map(|k| LINKS[k].1).join("\n");
        let holder = holder.map_or_else(String::new, |name| format!(", holder = \"{name}\""));
        let text = format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\n[links]\nframe = {{ D = [0, 240], F = [0, -60], A = [-182, 130] }}\n\
             crank = {{ A-B = 30 }}\n{links}\nram = {{ E = [0, 0], mass = \"60 kg\" }}\n[joints]\n\
             way = {{ slider = \"ram\", at = \"E\", on = \"D -> F\" }}\n[loads]\nblank = {{ force = [0, \"9 kN\"], at = \"E\", on = \"ram\" }}\n\
             [friction]\nC = {{ coefficient = 0.08, radius = 20{holder} }}\n[drives]\n\
             motor = {{ turns = \"crank\", from = 180, to = 540, speed = \"60 rpm\" }}\n[assembly]\nC = \"right of B -> D\"\nE = {{ near = [0, 30] }}\n\
             [measures]\npeak = \"max(torque(motor))\"\n[studies.s]\nkind = \"forces\"\nrows = 5\n"
        );
        let checked = Model::from_toml(&text, "test", &mut |_| Err("no files".into()));
        let checked = checked.unwrap_or_else(|found| panic!("{}", rendered(&found, &text)));
        let told = checked.warnings.iter().any(|d| d.code == "link-not-named");
        assert_eq!(told, holder.is_empty());
        // A file that is written from it says the same.
        let written = checked.model.to_toml().toml;
        let again = Model::from_toml(&written, "again", &mut |_| Err("no files".into()));
        let of = |model: &Model| {
            let result = run(model, &model.studies[0], &mut Silent).expect("forces");
            scalar(&result, "peak")
        };
        let peak = of(&checked.model);
        let second = of(&again.expect("a model").model);
        assert!((peak - second).abs() < 1e-9 * peak);
        peak
    };
    let orders = [[0, 1, 2], [1, 0, 2], [2, 1, 0]];
    let mut found = Vec::new();
    for first in orders {
        let name = LINKS[first[0]].0;
        let alone = peak(first, None);
        for order in orders {
            let by_name = peak(order, Some(name));
            assert!(
                (by_name - alone).abs() < 1e-9 * alone,
                "{name}: {by_name} {alone}"
            );
        }
        found.push(alone);
    }
    // It matters.
    assert!(
        found
            .iter()
            .skip(1)
            .all(|peak| (peak / found[0] - 1.0).abs() > 1e-3),
        "{found:?}"
    );
}

/// A link that turns idly on its only pin is one wherever its own coordinates begin: with the pin in their origin, at their end and elsewhere.
#[test]
fn a_link_hangs_on_any_of_its_points() {
    const FOUR: &str = "frame = { A = [0, 0], D = [60, 0] }\ncrank = { A-B = 20 }\nplate = { B-C = 50, P = [25, 10], mass = \"2 kg\", inertia = 0 }\nrocker = { D-C = 40 }\n";
    const SIX: &str = "frame = { O = [-100, 0], G = [0, 0], H = [80, -10] }\ncrank = { O-A = 20 }\nrod = { A-B = 75 }\n\
                       plate = { B = [0, 0], C = [30, 15], E = [90, 5], P = [20, 3], mass = \"2 kg\", inertia = 0 }\nlever = { G-C = 60 }\nlink = { H-E = 75 }\n";
    for (links, hint) in [
        (FOUR, "C = \"left of B -> D\""),
        (SIX, "C = { near = [11, 59] }"),
    ] {
        let found = [
            "P-T = 15",
            "T-P = 15",
            "T = [3, 4], P = [12, 16]",
            "Q = [0, 0], P = [0, 0], T = [15, 0]",
        ].map(|tag| {
            let text = format!(
                "units = {{ length = \"mm\", angle = \"deg\" }}\n[links]\n{links}tag = {{ {tag}, mass = \"3 kg\", inertia = \"2 kg mm^2\" }}\n[drives]\n\
                 motor = {{ turns = \"crank\", from = 0, to = 360, speed = \"60 rpm\" }}\n[assembly]\n{hint}\n[measures]\n\
                 m = \"max(torque(motor))\"\nr = \"max(reaction(P))\"\ny = \"range(y(P))\"\n[studies.s]\nkind = \"forces\"\nrows = 13\n\
                 columns = [\"torque(motor)\", \"reaction_x(P, tag)\", \"reaction_y(P, tag)\", \"x(P)\"]\n"
            );
            let model = model(&text);
            let result = run(&model, &model.studies[0], &mut Silent).expect("forces");
            let told = result.diagnostics.iter().filter(|d| d.code == "idle-freedom");
            assert_eq!(told.count(), 1);
            assert!(result.table.closure.iter().all(|gap| *gap < 1e-12));
            let mut all: Vec<f64> = ["m", "r", "y"].map(|name| scalar(&result, name)).to_vec();
            for name in ["torque(motor)", "reaction_x(P, tag)", "reaction_y(P, tag)", "x(P)"] {
                all.extend(column(&result, name));
            }
            all
        });
        let [first, rest @ ..] = &found;
        for other in rest {
            for (a, b) in first.iter().zip(other) {
                assert!((a - b).abs() <= 1e-9 * a.abs().max(1.0), "{a} {b}");
            }
        }
    }
}
