//! Joints with play beside parameters that differ: closed forms, what studies of clearance tell to first order, and what cannot be counted.
#![allow(
    clippy::disallowed_methods,
    reason = "numbers found by hand beside ours, not reproducible ones"
)]

use crate::told::{column, scalar};
use kempe_batch::{Serial, Threads};
use kempe_model::Model;
use kempe_study::{Silent, StudyResult, check, run, run_with};

fn model(text: &str) -> Model {
    let read = Model::from_toml(text, "test", &mut |_| Err("no files".into()));
    read.unwrap_or_else(|told| panic!("{told:?}")).model
}

fn found(text: &str, study: usize) -> StudyResult {
    let model = model(text);
    run(&model, &model.studies[study], &mut Silent).unwrap_or_else(|told| panic!("{told:?}"))
}

fn near(found: f64, wanted: f64, within: f64) {
    assert!(
        (found - wanted).abs() <= within,
        "{found} for {wanted} +- {within}"
    );
}

/// A four-bar with play at its pins.
fn four_bar(clearance: &str, study: &str) -> String {
    format!(
        "units = {{ length = \"mm\", angle = \"deg\" }}\n[parameters]\nc = \"40 mm\"\nplay = \"50 um\"\n\
         [links]\nframe = {{ A = [0, 0], D = [60, 0] }}\ncrank = {{ A-B = 20 }}\ncoupler = {{ B-C = 50, P = [25, 10], mass = \"1 kg\" }}\nrocker = {{ D-C = \"c\" }}\n\
         [drives]\nmotor = {{ turns = \"crank\", from = 0, to = 180, speed = \"1 rad/s\" }}\n[assembly]\nC = \"left of B -> D\"\n\
         [clearance]\n{clearance}\n\
         [studies.turn]\nkind = \"motion\"\nstep = 10\ncolumns = [\"angle(rocker)\", \"y(P)\"]\n\
         [studies.forces]\nkind = \"forces\"\nstep = 10\n\
         [studies.worn]\nkind = \"clearance\"\nmodel = \"continuous\"\nstep = 10\ncolumns = [\"angle(rocker)\", \"y(P)\"]\n\
         [studies.pieces]\nkind = \"tolerance\"\nover = \"turn\"\n{study}\n"
    )
}

#[test]
fn first_order_is_that_of_a_study_of_clearance() {
    let text = four_bar(
        "all = { radial = \"play\" }\nC = { radial = \"20 um\" }",
        "clearance = true\nsamples = 100\ncolumns = [\"at(angle(rocker), motor, 70)\", \"at(y(P), motor, 130)\"]",
    );
    let (pieces, worn) = (found(&text, 3), found(&text, 2));
    for (name, number, row) in [
        ("angle(rocker)", "at(angle(rocker), motor, 70)", 7),
        ("y(P)", "at(y(P), motor, 130)", 13),
    ] {
        let column = |what: &str| {
            let column = worn.table.column(&format!("{name} {what}"));
            column.expect("a column to first order").values[row]
        };
        near(
            scalar(&pieces, &format!("{number}, linear deviation")),
            column("rms"),
            1e-9,
        );
        let own = scalar(&pieces, number);
        near(
            scalar(&pieces, &format!("{number}, linear worst case greatest")) - own,
            column("worst case"),
            1e-9,
        );
        near(
            own - scalar(&pieces, &format!("{number}, linear worst case least")),
            column("worst case"),
            1e-9,
        );
    }
}

#[test]
fn a_pin_all_round_meets_its_closed_form() {
    // B stands where A does and further on by the crank: its height differs by that of a point on a circle.
    let text = four_bar(
        "A = { radial = \"play\" }",
        "clearance = true\nsamples = 2048\ncolumns = [\"at(y(B), motor, 40)\"]",
    );
    let result = found(&text, 3);
    let (number, play) = ("at(y(B), motor, 40)", 0.05);
    let middle = 20.0 * 40.0_f64.to_radians().sin();
    let told = |what: &str| scalar(&result, &format!("{number}, {what}"));
    near(told("linear deviation"), play * 0.5_f64.sqrt(), 1e-12);
    near(told("deviation"), play * 0.5_f64.sqrt(), 2e-5);
    near(told("mean"), middle, 1e-6);
    near(told("least"), middle - play, 1e-5);
    near(told("greatest"), middle + play, 1e-5);
    // The part below x of a height on a circle: 1/2 + asin(x / play) / pi.
    let sampled = result
        .listings
        .iter()
        .find(|l| l.title.starts_with("sampled"));
    let row = &sampled.expect("what was sampled").rows[0];
    let low: f64 = row[5].trim_end_matches(" mm").parse().expect("a length");
    near(
        low - middle,
        -play * (0.45 * std::f64::consts::PI).sin(),
        1e-4,
    );
}

#[test]
fn a_slider_is_pressed_to_either_side() {
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\na = \"20 mm\"\nplay = \"a / 400\"\n\
         [links]\nframe = { A = [0, 0], E = [0, 0], F = [100, 0] }\ncrank = { A-B = \"a\" }\nrod = { B-C = 60 }\nblock = { C = [0, 0] }\n\
         [joints]\nguide = { slider = \"block\", at = \"C\", on = \"E -> F\" }\n\
         [drives]\nmotor = { turns = \"crank\", from = 0, to = 90, speed = \"1 rad/s\" }\n[assembly]\nC = { near = [80, 0] }\n\
         [clearance]\nguide = { radial = \"play\" }\n\
         [studies.turn]\nkind = \"motion\"\nstep = 10\ncolumns = [\"x(C)\"]\n\
         [studies.pieces]\nkind = \"tolerance\"\nover = \"turn\"\nclearance = true\nsamples = 400\ncolumns = [\"at(y(C), motor, 30)\", \"at(x(C), motor, 90)\"]\nVARY\n";
    let result = found(&text.replace("VARY", ""), 1);
    for what in [
        "deviation",
        "linear deviation",
        "greatest",
        "worst case greatest",
    ] {
        // Each piece has it to one side: the deviation of few pieces is a little larger.
        near(
            scalar(&result, &format!("at(y(C), motor, 30), {what}")),
            0.05,
            1e-4,
        );
    }
    let ends = [-0.05_f64, 0.05].map(|y| (60.0_f64.powi(2) - (20.0 - y).powi(2)).sqrt());
    let number = "at(x(C), motor, 90)";
    near(scalar(&result, &format!("{number}, least")), ends[0], 1e-9);
    near(
        scalar(&result, &format!("{number}, greatest")),
        ends[1],
        1e-9,
    );
    // Play that goes with a length which differs itself.
    let both = text.replace("VARY", "vary = { a = { between = [\"0 mm\", \"4 mm\"] } }");
    let both = found(&both, 1);
    let greatest = scalar(&both, "at(y(C), motor, 30), greatest");
    assert!((0.059..0.06).contains(&greatest), "{greatest}");
}

#[test]
fn pieces_are_the_same_on_any_number_of_threads_and_as_linear_says() {
    let text = four_bar(
        "all = { radial = \"play\" }",
        "vary = { c = \"0.05 mm\" }\nclearance = true\nsamples = 256\ncolumns = [\"range(y(P))\", \"min(transmission_angle(C))\"]",
    );
    let model = model(&text);
    let [one, four] = [&Serial as &dyn kempe_batch::Executor, &Threads(4)].map(|executor| {
        run_with(&model, &model.studies[3], executor, &mut Silent).expect("a result")
    });
    assert_eq!(format!("{:?}", one.scalars), format!("{:?}", four.scalars));
    for number in ["range(y(P))", "min(transmission_angle(C))"] {
        let [linear, sampled] = ["linear deviation", "deviation"]
            .map(|what| scalar(&one, &format!("{number}, {what}")));
        near(sampled, linear, 0.03 * linear);
    }
    // Forces of a piece, too: they hang on where its pins stand.
    let forces = text
        .replace("over = \"turn\"", "over = \"forces\"")
        .replace("samples = 256", "samples = 64")
        .replace(
            "\"range(y(P))\"",
            "\"max(torque(motor))\", \"max(reaction(B))\"",
        );
    let forces = found(&forces, 3);
    for number in ["max(torque(motor))", "max(reaction(B))"] {
        let [linear, sampled] = ["linear deviation", "deviation"]
            .map(|what| scalar(&forces, &format!("{number}, {what}")));
        assert!(linear > 0.0, "{number}");
        near(sampled, linear, 0.2 * linear);
    }
}

#[test]
fn what_cannot_be_counted_is_told() {
    let codes = |text: &str| -> Vec<&'static str> {
        let model = model(text);
        let told = match run(&model, &model.studies[3], &mut Silent) {
            Ok(result) => result.diagnostics,
            Err(told) => told,
        };
        let checked = check(&model).diagnostics;
        assert!(
            told.iter().all(|d| checked.contains(d)),
            "{told:?}\n{checked:?}"
        );
        assert!(told.iter().all(|d| d.help.is_some()), "{told:?}");
        told.iter().map(|d| d.code).collect()
    };
    let study = "clearance = true\nsamples = 50\ncolumns = [\"range(y(P))\"]";
    assert_eq!(
        codes(&four_bar("A = { radial = 0 }", study)),
        ["no-clearance-there"]
    );
    let varied = |vary: &str| {
        let text = four_bar(
            "A = { radial = \"play\" }",
            &format!("{study}\nvary = {{ {vary} }}"),
        );
        codes(&text.replace("play = \"50 um\"", "play = \"0 um\""))
    };
    assert_eq!(
        varied("play = { between = [0, 0.1] }"),
        ["no-clearance-there"]
    );
    // Where other things differ, there are pieces all the same.
    assert!(varied("c = 0.1").contains(&"clearance-left-out"));
    let simulated = four_bar("A = { radial = 0.1 }", study).replace(
        "kind = \"motion\"\nstep = 10",
        "kind = \"simulate\"\nuntil = \"0.1 s\"\nstep = \"0.05 s\"",
    );
    assert_eq!(codes(&simulated), ["no-clearance-there"]);
    // A third crank repeats the other two.
    let repeated = four_bar("all = { radial = 0.1 }", study)
        .replace("D = [60, 0] }", "D = [60, 0], G = [30, 0] }")
        .replace("coupler = { B-C = 50, P = [25, 10], mass = \"1 kg\" }", "coupler = { B-C = 60, H = [30, 0], P = [25, 10], mass = \"1 kg\" }\nmiddle = { G-H = 20 }")
        .replace("D-C = \"c\"", "D-C = 20")
        .replace("from = 0, to = 180", "from = 20, to = 160")
;
    assert_eq!(codes(&repeated), ["no-clearance-there"]);
}

/// A clearance that is a parameter varies as any other: it is not idle, the worst case has all of it, and the linear deviation is that of the
/// pieces.
#[test]
fn a_play_that_differs_counts() {
    let text = four_bar(
        "all = { radial = \"play\" }\nC = { radial = \"0.1 mm\" }",
        "clearance = true\nsamples = 20000\nvary = { play = { between = [\"-0.04 mm\", \"0.1 mm\"] } }\n\
         columns = [\"at(angle(rocker), motor, 90)\", \"at(y(P), motor, 90)\"]",
    );
    let result = found(&text, 3);
    assert!(
        result
            .diagnostics
            .iter()
            .all(|d| d.code != "idle-parameter")
    );
    for number in ["at(angle(rocker), motor, 90)", "at(y(P), motor, 90)"] {
        let told = |what: &str| scalar(&result, &format!("{number}, {what}"));
        near(told("linear deviation") / told("deviation"), 1.0, 0.01);
        assert!(told("worst case least") <= told("least"));
        assert!(told("greatest") <= told("worst case greatest"));
        // Nor is it farther off than pieces come.
        let [all, worst] = [
            ["least", "greatest"],
            ["worst case least", "worst case greatest"],
        ]
        .map(|[low, high]| told(high) - told(low));
        assert!(all > 0.8 * worst, "{all} of {worst}");
    }
}

/// An angle at a pin is one of its two links to each other, and a distance on a link is that link's, where pins stand open by pieces, too.
#[test]
fn what_is_between_points_of_one_link_is_that_links() {
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[links]\nframe = { A = [0, 250], D = [-350, 0], J = [0, 0] }\n\
        lever = { D-C = 400 }\nlink = { C-B = 350 }\nbucket = { J-B = 380 }\n\
        [drives]\npush = { turns = \"lever\", from = 80, to = 120, speed = \"10 deg/s\" }\n[assembly]\nB = \"right of C -> J\"\n\
        [clearance]\nall = { radial = 0.4 }\n[studies.go]\nkind = \"motion\"\nrows = 5\n\
        [studies.tol]\nkind = \"tolerance\"\nover = \"go\"\nclearance = true\nsamples = 200\n\
        columns = [\"at(transmission_angle(B), push, 100)\", \"at(angle(C, B, J), push, 100)\", \"at(angle(bucket, link), push, 100)\", \"at(distance(C, B), push, 100)\"]\n";
    let result = found(text, 1);
    for what in ["deviation", "linear deviation"] {
        let of = |name: &str| scalar(&result, &format!("at({name}, push, 100), {what}"));
        let wanted = of("angle(bucket, link)");
        assert!(wanted > 0.01);
        near(of("transmission_angle(B)"), wanted, 1e-6 * wanted);
        near(of("angle(C, B, J)"), wanted, 1e-6 * wanted);
        assert!(of("distance(C, B)") < 1e-9);
    }
}

/// Play at the pivot of a slotted lever and at its slot: the file's own design, in which neither stands open, is as good as its pieces.
#[test]
fn a_slotted_lever_with_play_at_its_pivot_keeps_its_own_design() {
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[links]\nframe = { S = [0, 0], A = [0, 80] }\ncrank = { A-B = 30 }\nlever = { S-T = 200 }\n\
                [joints]\nslot = { pin = \"B\", on = \"S -> T\" }\n[drives]\nmotor = { turns = \"crank\", speed = \"60 rpm\" }\n\
                [assembly]\nlever = { near = \"70 deg\" }\n[clearance]\nS = { radial = \"0.2 mm\" }\nslot = { radial = \"0.15 mm\" }\n\
                [measures]\nswing = \"range(angle(lever))\"\n[studies.turn]\nkind = \"motion\"\n\
                [studies.tol]\nkind = \"tolerance\"\nover = \"turn\"\nclearance = true\nsamples = 100\ncolumns = [\"swing\"]\nlimits = [\"swing <= 45 deg\"]\n";
    let result = found(text, 1);
    // Twice the arc whose sine is 30 / 80.
    near(scalar(&result, "swing"), 44.048_625_674_084_33, 1e-9);
    let [linear, sampled] = ["swing, linear deviation", "swing, deviation"];
    near(scalar(&result, linear), scalar(&result, sampled), 3e-3);
    assert!(result.diagnostics.is_empty(), "{:?}", result.diagnostics);
}

/// Joints with play rub as those without: a guide that stands off rubs as one that is made off, and the file's own design as a study of
/// forces has it.
#[test]
fn joints_with_play_rub() {
    let text = |friction: &str, clearance: &str, off: &str| {
        format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\ngravity = 0\n[parameters]\nmu = 0.2\noff = \"{off}\"\n\
             [links]\nframe = {{ O = [0, 0], E = [0, \"off\"], X = [500, \"off\"] }}\ncrank = {{ O-B = 50 }}\nrod = {{ B-C = 200 }}\nblock = {{ C = [0, 0] }}\n\
             [joints]\nway = {{ slider = \"block\", at = \"C\", on = \"E -> X\" }}\n\
             [drives]\nmotor = {{ turns = \"crank\", from = 20, to = 160, speed = \"60 rpm\" }}\n[assembly]\nC = {{ near = [250, 0] }}\n\
             [loads]\nwork = {{ force = [\"-100 N\", 0], at = \"C\", on = \"block\" }}\n\
             [friction]\n{friction}\n[clearance]\n{clearance}\n\
             [studies.go]\nkind = \"forces\"\nrows = 71\ncolumns = [\"torque(motor)\"]\n\
             [studies.tol]\nkind = \"tolerance\"\nover = \"go\"\nclearance = true\nsamples = 50\ncolumns = [\"at(torque(motor), motor, 90)\"]\n"
        )
    };
    let at = |result: &StudyResult| {
        let column = result.table.column("torque(motor)");
        column.expect("the torque").values[35]
    };
    for (friction, clearance) in [
        ("way = { coefficient = \"mu\" }", "way = { radial = 0.5 }"),
        (
            "all = { coefficient = \"mu\", radius = 20 }",
            "all = { radial = 0.5 }",
        ),
        (
            "B = { coefficient = \"mu\", radius = 20, drag = \"1 N m\" }",
            "B = { radial = 0.5 }",
        ),
    ] {
        let file = text(friction, clearance, "0 mm");
        let (forces, pieces) = (found(&file, 0), found(&file, 1));
        let smooth = at(&found(&text("", clearance, "0 mm"), 0));
        let number = "at(torque(motor), motor, 90)";
        let own = scalar(&pieces, number);
        near(own, at(&forces), 1e-9);
        assert!((own - smooth).abs() > 0.1, "{own}: nothing rubs");
        if !clearance.starts_with("way") {
            continue;
        }
        let made = ["-0.5 mm", "0.5 mm"].map(|off| at(&found(&text(friction, "", off), 0)));
        let told = ["worst case least", "worst case greatest"]
            .map(|what| scalar(&pieces, &format!("{number}, {what}")));
        near(told[0], made[0].min(made[1]), 1e-9);
        near(told[1], made[0].max(made[1]), 1e-9);
    }
}

/// Play that is varied where nobody counts it changes nothing, and it is said how it counts.
#[test]
fn play_that_is_not_counted_is_told() {
    let text = four_bar(
        "all = { radial = \"play\" }",
        "samples = 50\nvary = { play = \"10 um\", c = \"0.1 mm\" }\ncolumns = [\"at(y(P), motor, 90)\"]",
    );
    let told = found(&text, 3).diagnostics;
    let [idle] = told.as_slice() else {
        panic!("{told:?}");
    };
    assert_eq!(idle.code, "idle-parameter");
    let help = format!("{idle:?}");
    assert!(help.contains("`clearance = true`"), "{help}");
}

/// A pin in a curved slot stands off its arc by all of its play, and rubs there as in a slot made so: not to first order alone.
#[test]
fn a_curved_slot_with_play_is_one_of_another_radius() {
    let text = |friction: &str, off: &str| {
        format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\n[parameters]\noff = \"{off}\"\n\
             [links]\nframe = {{ A = [0, 0], U = [\"110 mm + off\", 20], V = [50, \"80 mm + off\"] }}\ncrank = {{ A-B = 20 }}\nrod = {{ B-Q = 100 }}\n\
             [joints]\nbow = {{ pin = \"Q\", arc = \"U -> V\", radius = \"60 mm + off\" }}\n\
             [loads]\nwork = {{ force = [\"-20 N\", \"-50 N\"], at = \"Q\", on = \"rod\" }}\n\
             [friction]\nbow = {{ {friction} }}\n[clearance]\nbow = {{ radial = 1 }}\n\
             [drives]\nmotor = {{ turns = \"crank\", from = 90, to = 150, speed = \"60 rpm\" }}\n[assembly]\nQ = {{ near = [80, 70] }}\n\
             [studies.go]\nkind = \"forces\"\nstep = 5\ncolumns = [\"torque(motor)\", \"x(Q)\"]\n\
             [studies.tol]\nkind = \"tolerance\"\nover = \"go\"\nclearance = true\nsamples = 20\ncolumns = [\"at(torque(motor), motor, 100)\", \"at(x(Q), motor, 100)\"]\n"
        )
    };
    for friction in [
        "coefficient = 0, drag = \"40 N\"",
        "coefficient = 0, viscous = \"200 N s/m\"",
        "coefficient = 0.2",
    ] {
        let pieces = found(&text(friction, "0 mm"), 1);
        let made = ["-1 mm", "1 mm"].map(|off| found(&text(friction, off), 0));
        for name in ["torque(motor)", "x(Q)"] {
            let of = |result: &StudyResult| result.table.column(name).expect(name).values[2];
            let [low, high] = made.each_ref().map(of);
            let [least, most] = ["least", "greatest"].map(|end| {
                scalar(
                    &pieces,
                    &format!("at({name}, motor, 100), worst case {end}"),
                )
            });
            near(least, low.min(high), 1e-9 * low.abs());
            near(most, low.max(high), 1e-9 * low.abs());
        }
    }
}

/// To first order and as the worst case, also where what rubs turns back right at the ends of the motion: a crank whose pin stands off across the guide,
/// which has play itself, is an offset one.
#[test]
fn a_mean_of_forces_with_play_is_that_of_an_offset() {
    let text = |clearance: &str, off: &str| {
        format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\n[parameters]\noff = \"{off}\"\nmu = 0.2\n\
             [links]\nframe = {{ A = [0, 0], G = [0, \"off\"], H = [200, \"off\"] }}\ncrank = {{ A-B = 30 }}\nrod = {{ B-C = 100 }}\n\
             [joints]\nslide = {{ pin = \"C\", on = \"G -> H\" }}\n[assembly]\nC = {{ near = [130, 0] }}\n\
             [drives]\nmotor = {{ turns = \"crank\", from = 0, to = 360, speed = \"60 rpm\" }}\n\
             [loads]\nwork = {{ force = [\"-100 N\", \"-40 N\"], at = \"C\" }}\n\
             [friction]\nslide = {{ coefficient = \"mu\" }}\nA = {{ coefficient = \"mu\", radius = 5 }}\n\
             [clearance]\n{clearance}\n\
             [studies.go]\nkind = \"forces\"\nstep = 30\ncolumns = [\"mean(power(motor))\"]\n\
             [studies.tol]\nkind = \"tolerance\"\nover = \"go\"\nclearance = true\nsamples = 20\ncolumns = [\"mean(power(motor))\"]\n"
        )
    };
    let number = "mean(power(motor))";
    let play = "A = { radial = 0.5 }\nslide = { radial = 0.1 }";
    let pieces = found(&text(play, "0 mm"), 1);
    let made = |off: &str| column(&found(&text("", off), 0), number)[0];
    let told = |what: &str| scalar(&pieces, &format!("{number}, {what}"));
    let [low, high] = ["0.6 mm", "-0.6 mm"].map(made);
    near(told("worst case least"), low, 1e-8 * low);
    let [least, greatest] =
        ["-90", "90"].map(|way| format!("play at A by 0.5 mm towards {way} deg"));
    let lines = format!("{:?}", pieces.listings);
    assert!(
        lines.contains(&least) && lines.contains(&greatest),
        "{lines}"
    );
    near(told("worst case greatest"), high, 1e-8 * high);
    let [low, high] = ["0.01 mm", "-0.01 mm"].map(made);
    let (own, by) = (scalar(&pieces, number), 60.0 * 0.5 * (high - low));
    near(told("linear worst case least"), own - by, 1e-3 * by);
    near(told("linear worst case greatest"), own + by, 1e-3 * by);
}

/// The worst case of a mean of forces comes to its end: a pin stands off until its derivatives promise nothing more, not to the last digit.
#[test]
fn the_worst_case_of_a_mean_of_forces_is_met_where_a_pin_stands_off() {
    let text = |clearance: &str, x: &str| {
        format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\n[parameters]\nx = \"{x}\"\n\
             [links]\nframe = {{ A = [\"x\", 0], D = [70, 0] }}\ncrank = {{ A-B = 20 }}\nlever = {{ D = [0, 0], S = [-110, 10], T = [-30, 10] }}\n\
             [joints]\nslot = {{ pin = \"B\", arc = \"S -> T\", radius = 90, side = \"left\" }}\n[assembly]\nlever = {{ near = \"0 deg\" }}\n\
             [drives]\nmotor = {{ turns = \"crank\", from = 0, to = 360, speed = \"60 rpm\" }}\n\
             [loads]\nhook = {{ torque = \"2 N m\", on = \"lever\" }}\n[friction]\nslot = {{ coefficient = 0.1 }}\n[clearance]\n{clearance}\n\
             [studies.go]\nkind = \"forces\"\nstep = 30\ncolumns = [\"mean(reaction(slot))\"]\n\
             [studies.tol]\nkind = \"tolerance\"\nover = \"go\"\nclearance = true\nsamples = 20\ncolumns = [\"mean(reaction(slot))\"]\n"
        )
    };
    let number = "mean(reaction(slot))";
    let pieces = found(&text("A = { radial = 0.1 }", "0 mm"), 1);
    for (end, x) in [("least", "-0.1 mm"), ("greatest", "0.1 mm")] {
        let made = column(&found(&text("", x), 0), number)[0];
        let told = scalar(&pieces, &format!("{number}, worst case {end}"));
        near(told, made, 1e-8 * made);
    }
}
