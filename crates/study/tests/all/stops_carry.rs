//! What stops push on bodies: joints carry what equilibrium says, and drives that are let go give nothing.

use kempe_model::Model;
use kempe_study::{Silent, StudyResult, run};

fn found(text: &str) -> StudyResult {
    let read = Model::from_toml(text, "test", &mut |_| Err("no files".into()));
    let model = read.expect("a model").model;
    run(&model, &model.studies[0], &mut Silent).expect("a result")
}

/// The last row of a column, SI.
fn last(result: &StudyResult, name: &str) -> f64 {
    let column = result.table.column(name);
    let column = column.unwrap_or_else(|| panic!("no {name}"));
    *column.si().last().expect("a row")
}

fn near(found: f64, wanted: f64, by: f64) {
    assert!((found - wanted).abs() <= by, "{found} instead of {wanted}");
}

/// A rod whose tip comes to lie on a table: half of its weight is the table's.
fn rod(stop: &str) -> StudyResult {
    found(&format!(
        "units = {{ length = \"m\", angle = \"deg\" }}\ngravity = [0, \"-10 m/s^2\"]\n[links]\nframe = {{ O = [0, 0] }}\n\
         rod = {{ O-P = 1, mass = \"2 kg\", inertia = \"0.2 kg m^2\", center = [0.5, 0] }}\n[drives]\nm = {{ turns = \"rod\", at = 10 }}\n\
         [measures]\nheight = \"y(P)\"\n[studies.s]\nkind = \"simulate\"\nuntil = \"5 s\"\nstep = \"0.1 s\"\n\
         stops = {{ {stop} }}\ncolumns = [\"torque(m)\", \"reaction_x(O, rod)\", \"reaction_y(O, rod)\"]\n"
    ))
}

#[test]
fn a_rod_on_a_table_rests_half_on_its_pin() {
    for stop in [
        "height = [\"0 m\", \"none\"]",
        "height = { between = [\"0 m\", \"none\"], stiffness = \"1e5 N/m\", damping = \"1e3 N s/m\" }",
    ] {
        let result = rod(stop);
        near(last(&result, "torque(m)"), 0.0, 1e-6);
        near(last(&result, "reaction_x(O, rod)"), 0.0, 1e-2);
        near(last(&result, "reaction_y(O, rod)"), 10.0, 1e-3);
    }
}

#[test]
fn a_stop_on_the_angle_of_a_link_is_a_torque_from_the_frame() {
    // Held level: the pin carries all of the weight, and the stop all of the moment.
    let result = rod("rod = [\"0 deg\", \"none\"]");
    near(last(&result, "reaction_y(O, rod)"), 20.0, 1e-6);
    near(last(&result, "torque(m)"), 0.0, 1e-6);
    // On the drive's own coordinate it is what shows in the drive's effort.
    let result = rod("m = [\"0 deg\", \"none\"]");
    near(last(&result, "reaction_y(O, rod)"), 20.0, 1e-6);
    near(last(&result, "torque(m)"), 10.0, 1e-6);
}

/// Between the last bounces, of nanoseconds, a drive that is let go gives as little as before.
#[test]
fn nothing_is_given_where_bounces_die_out() {
    let result = found(
        "units = { length = \"m\", angle = \"deg\" }\ngravity = [0, \"-10 m/s^2\"]\n[links]\nframe = { O = [0, 0] }\n\
         rod = { O-P = 1, mass = \"2 kg\", inertia = \"0.2 kg m^2\", center = [0.5, 0] }\n[drives]\nm = { turns = \"rod\", at = 10 }\n\
         [springs]\ns = { links = [\"frame\", \"rod\"], stiffness = \"1 N m/rad\", free = \"0 deg\" }\n[studies.s]\nkind = \"simulate\"\n\
         until = \"1.5 s\"\nstep = \"0.1 s\"\nstops = { m = { between = [-30, \"none\"], restitution = 0.6 } }\n\
         columns = [\"max(torque(m))\", \"min(torque(m))\"]\n",
    );
    near(last(&result, "min(torque(m))"), 0.0, 1e-6);
    // At rest the stop carries what the spring does not.
    let held = 10.0 * 0.75_f64.sqrt() - std::f64::consts::PI / 6.0;
    near(last(&result, "max(torque(m))"), held, 1e-6);
}

/// A four-bar that falls until its rocker lies on a stop: all its links are in equilibrium by what their pins say, but for a moment on the rocker.
#[test]
fn all_links_of_a_four_bar_at_rest_on_its_rocker_are_in_equilibrium() {
    let result = found(
        "units = { length = \"mm\", angle = \"deg\" }\n[links]\nframe = { A = [0, 0], D = [60, 0] }\n\
         crank = { A-B = 20, mass = \"1 kg\", inertia = \"1e-4 kg m^2\", center = [10, 0] }\n\
         coupler = { B-C = 50, mass = \"2 kg\", inertia = \"4e-4 kg m^2\", center = [25, 0] }\n\
         rocker = { D-C = 40, mass = \"1 kg\", inertia = \"3e-4 kg m^2\", center = [20, 0] }\n\
         [drives]\nmotor = { turns = \"crank\", at = 80 }\n[assembly]\nC = \"left of B -> D\"\n\
         [studies.s]\nkind = \"simulate\"\nuntil = \"3 s\"\nstep = \"0.05 s\"\nstops = { rocker = [\"none\", \"130 deg\"] }\n\
         columns = [\"angle(rocker)\", \"torque(motor)\", \"reaction_x(A, crank)\", \"reaction_y(A, crank)\", \"reaction_x(B, coupler)\", \"reaction_y(B, coupler)\", \
         \"reaction_x(C, coupler)\", \"reaction_y(C, coupler)\", \"reaction_x(D, rocker)\", \"reaction_y(D, rocker)\", \"x(B)\", \"y(B)\", \"x(C)\", \"y(C)\"]\n",
    );
    let of = |name: &str| last(&result, name);
    near(of("angle(rocker)"), 130.0_f64.to_radians(), 1e-9);
    near(of("torque(motor)"), 0.0, 1e-9);
    let g = 9.81;
    let [ax, ay] = ["reaction_x(A, crank)", "reaction_y(A, crank)"].map(of);
    let [bx, by] = ["reaction_x(B, coupler)", "reaction_y(B, coupler)"].map(of);
    let [cx, cy] = ["reaction_x(C, coupler)", "reaction_y(C, coupler)"].map(of);
    let [dx, dy] = ["reaction_x(D, rocker)", "reaction_y(D, rocker)"].map(of);
    let b = ["x(B)", "y(B)"].map(of);
    let c = ["x(C)", "y(C)"].map(of);
    // The crank, on which the coupler presses with what it gets, reversed.
    near(ax - bx, 0.0, 1e-9);
    near(ay - by - g, 0.0, 1e-9);
    near(b[0] * -by - b[1] * -bx - g * b[0] / 2.0, 0.0, 1e-9);
    // The coupler, about B.
    near(bx + cx, 0.0, 1e-9);
    near(by + cy - 2.0 * g, 0.0, 1e-9);
    let arm = [c[0] - b[0], c[1] - b[1]];
    near(
        arm[0] * cy - arm[1] * cx - 2.0 * g * arm[0] / 2.0,
        0.0,
        1e-9,
    );
    // The rocker: the stop pushes with a moment alone.
    near(dx - cx, 0.0, 1e-9);
    near(dy - cy - g, 0.0, 1e-9);
}

/// A block that slides along the frame and carries a rod whose tip lies on a table: friction goes by the weight that the table leaves to the block, so that it comes
/// to rest after `v^2 / (2 a)` with `a = mu g (M + m / 2) / (M + m)`, by a quarter more than if the block had all of it.
#[test]
fn friction_goes_by_what_a_stop_leaves_to_a_joint() {
    let result = found(
        "units = { length = \"mm\", angle = \"deg\" }\ngravity = [0, \"-10 m/s^2\"]\n[links]\nframe = { E = [0, 0], F = [1000, 0] }\n\
         block = { H = [0, 0], mass = \"3 kg\", inertia = \"0.01 kg m^2\", center = \"H\" }\n\
         rod = { H-P = 500, mass = \"2 kg\", inertia = \"0.05 kg m^2\", center = [250, 0] }\n\
         [joints]\nguide = { slider = \"block\", at = \"H\", on = \"E -> F\" }\n[friction]\nguide = { coefficient = 0.2 }\n\
         [drives]\ngo = { slides = \"block\", at = 100 }\nswing = { turns = \"rod\", at = 0 }\n[measures]\nheight = \"y(P)\"\n\
         [studies.s]\nkind = \"simulate\"\nuntil = \"2 s\"\nstep = \"10 ms\"\nstart = { go = \"100 mm\", go_rate = \"1 m/s\" }\n\
         stops = { height = [\"0 mm\", \"none\"] }\ncolumns = [\"go\", \"reaction_y(H, rod)\"]\n",
    );
    near(last(&result, "go"), 0.1 + 1.0 / (2.0 * 1.6), 1e-9);
    near(last(&result, "reaction_y(H, rod)"), 10.0, 1e-9);
}

/// A four-bar with friction in its pins that falls onto a stop that gives.
fn rubbing(stops: &str) -> StudyResult {
    let result = found(&format!(
        "units = {{ length = \"mm\", angle = \"deg\" }}\n[links]\nframe = {{ A = [0, 0], D = [60, 0] }}\n\
         crank = {{ A-B = 20, mass = \"1 kg\", inertia = \"1e-4 kg m^2\", center = [10, 0] }}\n\
         coupler = {{ B-C = 50, mass = \"2 kg\", inertia = \"4e-4 kg m^2\", center = [25, 0] }}\n\
         rocker = {{ D-C = 40, mass = \"1 kg\", inertia = \"3e-4 kg m^2\", center = [20, 0] }}\n\
         [drives]\nmotor = {{ turns = \"crank\", at = 80 }}\n[assembly]\nC = \"left of B -> D\"\n\
         [friction]\nC = {{ coefficient = 0.2, radius = 5 }}\nD = {{ coefficient = 0.2, radius = 5 }}\n\
         [measures]\napart = \"angle(rocker) + motor\"\nmost = \"max(reaction(D))\"\n\
         [studies.s]\nkind = \"simulate\"\nuntil = \"0.7 s\"\nstep = \"0.2 ms\"\nstops = {{ {stops} }}\ncolumns = [\"torque(motor)\", \"reaction(D)\"]\n"
    ));
    let told: Vec<String> = result
        .listings
        .iter()
        .flat_map(|l| l.rows.concat())
        .collect();
    assert!(
        told.iter().any(|text| text.contains("touches the")),
        "{told:?}"
    );
    result
}

/// Inverse dynamics, which finds friction by what joints carry in every row, asks no more than the simulation gave.
#[test]
fn what_rubs_while_a_stop_gives_balances() {
    for (stops, free) in [
        (
            "rocker = { between = [\"none\", \"130 deg\"], stiffness = \"20 N m/rad\", damping = \"0.05 N m s\" }",
            true,
        ),
        // Part of it is the drive's own coordinate.
        (
            "apart = { between = [\"none\", \"220 deg\"], stiffness = \"20 N m/rad\", damping = \"0.05 N m s\" }",
            false,
        ),
    ] {
        let result = rubbing(stops);
        assert!(result.diagnostics.is_empty(), "{:?}", result.diagnostics);
        let balance = result.table.balance.as_ref().expect("a simulation");
        let off = balance
            .power
            .iter()
            .fold(0.0_f64, |most, x| most.max(x.abs()));
        assert!(off < 1e-9, "{stops}: {off:e}");
        let effort = result.table.column("torque(motor)").expect("a column").si();
        let most = effort.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        assert_eq!(most < 1e-8, free, "{stops}: {most}");
        // What is told of the whole motion is that of its rows.
        let told = result
            .scalars
            .iter()
            .find(|s| s.name == "most")
            .expect("a number")
            .value;
        let rows = result.table.column("reaction(D)").expect("a column").si();
        let rows = rows.iter().copied().fold(0.0_f64, f64::max);
        assert!(told >= rows && told < 1.001 * rows, "{told} {rows}");
    }
}
