//! Sessions on the published systems: against the studies of the same files, against reference values of `validation/`, and
//! against themselves asked another way.

use kempe::Stage;
use kempe::prelude::*;
use std::ops::ControlFlow;

use kempe::{AssemblyData, EventKind, ForceColumns, Heading, MotionData, MotionEvent, Value};

fn model(name: &str) -> Model {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/");
    Model::from_path(format!("{root}{name}.toml")).expect("an example")
}

fn session(name: &str) -> Session {
    model(name).compile().expect("it moves").session()
}

fn close(a: f64, b: f64, digits: f64) -> bool {
    (a - b).abs() <= digits * b.abs().max(1e-3)
}

const CRANK_ROCKER: &str = r#"
units = { length = "mm", angle = "deg" }
[parameters]
a = "20 mm"
b = "2.5 * a"
[links]
frame   = { A = [0, 0], D = [60, 0] }
crank   = { A-B = "a" }
coupler = { B-C = "b", P = ["b / 2", "5 mm"] }
rocker  = { D-C = 40 }
[drives]
motor = { turns = "crank", from = 0, to = 360, speed = "1 rad/s" }
[assembly]
C = "left of B -> D"
"#;

fn crank_rocker() -> Session {
    let model: Model = CRANK_ROCKER.parse().expect("a model");
    model.compile().expect("it moves").session()
}

#[test]
fn everything_that_is_handed_out_is_owned_and_goes_to_any_thread() {
    fn owned<T: Send + Sync + Clone + 'static>() {}
    owned::<Model>();
    owned::<Compiled>();
    owned::<Session>();
    owned::<Pose>();
    owned::<Sweep>();
    owned::<Derivatives>();
    owned::<Designs>();
    owned::<Many>();
    owned::<Block>();
    owned::<Heading>();
    owned::<Value>();
    owned::<MotionData>();
    owned::<MotionEvent>();
    owned::<AssemblyData>();
    owned::<ForceColumns>();
    owned::<Error>();
    owned::<StudyResult>();
    owned::<Table>();
    owned::<CheckReport>();
    owned::<kempe::mechanism::Mechanism>();
    owned::<kempe::motion::Motion>();
}

/// A sweep over the places of a study has the study's own numbers.
fn same_as_study(name: &str, study: &str, drive: &str) {
    let model = model(name);
    let table = model.run(study).expect("it runs").table;
    let mut s = model.compile().expect("it moves").session();
    let places = table.column(drive).expect("the drive").si();
    // Behind time and the drives.
    let columns = &table.columns[2..];
    let names: Vec<&str> = columns.iter().map(|c| c.name.as_str()).collect();
    let swept = s.sweep(drive, &places, &names).expect("it sweeps");
    assert_eq!(swept.rows(), table.rows());
    for (own, theirs) in swept.columns.iter().zip(columns) {
        assert_eq!(own.heading.unit, theirs.unit);
        let size = theirs.values.iter().fold(1e-9, |s: f64, v| s.max(v.abs()));
        for (row, (a, b)) in own.in_unit().iter().zip(&theirs.values).enumerate() {
            let same = (a - b).abs() <= 1e-9 * size || (a.is_nan() && b.is_nan());
            assert!(same, "{} row {row}: {a} {b}", own.name());
        }
    }
    assert_eq!(swept.forces.is_some(), table.forces.is_some());
    for row in 0..swept.rows() {
        assert!(swept.closure[row] < 1e-9 && swept.reason(row).is_none());
    }
}

#[test]
fn a_sweep_has_the_numbers_of_the_studies() {
    same_as_study("seeds/tractor-hitch", "lifting", "lift");
    same_as_study("seeds/tractor-hitch", "loads", "lift");
    same_as_study("seeds/slider-crank", "turn", "shaft");
}

#[test]
fn a_sweep_has_the_published_numbers() {
    // validation/s4-tractor-hitch.toml
    let mut s = session("seeds/tractor-hitch");
    let places = [0.38, 0.415, 0.45, 0.52];
    let t = s
        .sweep("lift", places, ["y(M)", "-reduced_load(lift)"])
        .expect("it sweeps");
    let y = [0.0590474033, 0.1527496472, 0.2635783524, 0.5397008986];
    let push = [29188.2988831, 35129.7785439, 41043.5719108, 55789.7675354];
    for row in 0..4 {
        assert!((t.columns[0].values[row] - y[row]).abs() < 1e-10);
        assert!((t.columns[1].values[row] - push[row]).abs() < 1e-6);
    }
    let forces = t.forces.expect("forces were asked for");
    assert!(forces.route_difference.iter().all(|d| *d < 1e-9));
    assert!(forces.residual.iter().all(|r| *r < 1e-9));

    // validation/s3-slider-crank.toml, at 30 degrees; a number over the motion besides.
    let mut s = session("seeds/slider-crank");
    let measures = ["angle(rod)", "rate(y(C))", "range(y(C))"];
    let t = s
        .sweep("shaft", [30.0_f64.to_radians()], measures)
        .expect("it sweeps");
    assert!(close(t.columns[0].in_unit()[0], 100.0915332495733, 1e-13));
    assert!(close(t.columns[1].in_unit()[0], 13728.30814008131, 1e-12));
    assert!(close(t.columns[2].in_unit()[0], 115.2390340889153, 1e-13));
}

#[test]
fn the_lock_is_dragged_through_its_change_point() {
    // validation/s1-door-lock.toml
    let mut s = session("seeds/door-lock");
    let motion = s.motion().expect("it moves");
    let crossing = motion
        .events
        .iter()
        .find(|e| e.kind == EventKind::ChangePoint);
    let at = crossing.expect("a change point").at.to_degrees();
    assert!(close(at, 117.512_206_516_641_08, 1e-13));

    let mut p = s
        .pose([("lock", (-50.0_f64).to_radians())])
        .expect("the start");
    for degrees in -49..=125 {
        p = s
            .pose_near(&p, "lock", f64::from(degrees).to_radians())
            .expect("it goes on");
    }
    let angle = |link: &str| p.angle(link).expect("a link").to_degrees();
    assert!((angle("bar2") - 196.503266969257).abs() < 1e-9);
    assert!((angle("bar5") - 164.975506743242).abs() < 1e-9);
    let at = crossing.expect("a change point").at;
    let p = s.pose_near(&p, "lock", at).expect("it goes through");
    assert!(
        p.note()
            .expect("a note")
            .starts_with("change point at lock = 117.512 deg")
    );

    // Beyond the laws, up to the limit at 132.74 degrees, and no farther.
    let p = s
        .pose_near(&p, "lock", 132.0_f64.to_radians())
        .expect("it can");
    assert!(p.closure() < 1e-9);
    let error = s.pose_near(&p, "lock", 133.0_f64.to_radians()).unwrap_err();
    assert_eq!(error.code(), "range-beyond-limit");
    assert!(error.to_string().contains("132.7"), "{error}");
    let t = s
        .sweep(
            "lock",
            [131.0_f64.to_radians(), 133.0_f64.to_radians()],
            ["angle(bar2)"],
        )
        .expect("it sweeps");
    assert!(t.reached(0) && !t.reached(1) && t.reason(0).is_none());
    assert!(t.reason(1).expect("a reason").contains("132.7"));
}

#[test]
fn a_dragged_pose_is_the_pose_from_scratch() {
    for (name, drive) in [("seeds/tractor-hitch", "lift"), ("seeds/door-closer", "")] {
        let mut s = session(name);
        let own = s.compiled().drives().next().expect("a drive").to_owned();
        let drive = if drive.is_empty() {
            own.as_str()
        } else {
            drive
        };
        let (low, high) = s.motion().expect("it moves").reached;
        let mut p = s.start().expect("a start");
        for place in linspace(low, high, 41) {
            p = s.pose_near(&p, drive, place).expect("on the motion");
            let whole = s.pose([(drive, place)]).expect("on the motion");
            for (a, b) in p.points().iter().zip(whole.points()) {
                assert!((a[0] - b[0]).abs() < 1e-12 && (a[1] - b[1]).abs() < 1e-12);
            }
            assert_eq!(p.coordinate(drive).expect("the drive"), place);
        }
    }
}

#[test]
fn several_drives_go_together_or_one_by_one() {
    let mut s = session("gallery/excavator");
    let places = [
        ("boom_cylinder", 2.3),
        ("stick_cylinder", 3.1),
        ("bucket_cylinder", 2.4),
    ];
    let together = s.pose(places).expect("they get there");
    let mut one_by_one = s.start().expect("a start");
    for (drive, place) in places {
        one_by_one = s
            .pose_near(&one_by_one, drive, place)
            .expect("it gets there");
    }
    assert_eq!(together.coordinates().len(), 3);
    for (a, b) in together.points().iter().zip(one_by_one.points()) {
        assert!((a[0] - b[0]).abs() < 1e-9 && (a[1] - b[1]).abs() < 1e-9);
    }
    // Where they all stand there is no motion, and so no force and no number over it.
    for measure in ["force(boom_cylinder)", "max(y(X))", "y(X) / range(y(X))"] {
        let error = together.measure(measure).unwrap_err();
        assert_eq!(error.code(), "not-on-the-motion", "{measure}");
    }
    assert!(together.measure("y(X)").expect("a place").si.is_finite());
    assert_eq!(together.measure("speed(X)").unwrap_err().code(), "no-value");

    // One drive from a pose on, the others held there.
    let t = s
        .sweep_from(
            &together,
            "stick_cylinder",
            [2.9, 3.0, 3.1],
            ["y(X)", "bucket_cylinder"],
            &mut Silent,
        )
        .expect("it sweeps");
    assert!((t.columns[0].values[2] - together.point("X").expect("a point")[1]).abs() < 1e-9);
    assert!(t.columns[1].values.iter().all(|q| *q == 2.4));
    let error = s
        .pose([("boom_cylinder", 2.3), ("boom_cylinder", 2.4)])
        .unwrap_err();
    assert_eq!(error.code(), "over-specified");

    // Over time every drive moves by its law: the rows of the file's own motion.
    let table = model("gallery/excavator")
        .run_first()
        .expect("it runs")
        .table;
    let times = table.columns[0].si();
    let t = s.sweep("time", &times, ["y(X)"]).expect("it sweeps");
    let own = table.column("depth").expect("a measure of the file").si();
    for (a, b) in t.columns[0].values.iter().zip(own) {
        assert!((a - b).abs() < 1e-12);
    }
    let t = s.sweep("time", [-1.0, 1e3], ["y(X)"]).expect("it sweeps");
    assert!(t.reason(0).is_some() && t.reason(1).expect("a reason").contains("not pass"));
}

#[test]
fn parameters_that_are_set_are_as_if_the_file_said_so() {
    let model: Model = CRANK_ROCKER.parse().expect("a model");
    let mut s = crank_rocker();
    s.set_text("a", "25 mm").expect("it can be set");
    let again = model.with("a", "25 mm").expect("it can be set");
    let mut other = again.compile().expect("it moves").session();
    let measures = ["x(P)", "angle(rocker)", "range(angle(rocker))", "speed(C)"];
    let places = linspace(0.0, 6.2, 50);
    let [a, b] = [&mut s, &mut other].map(|s| s.sweep("motor", &places, measures).expect("rows"));
    for (a, b) in a.columns.iter().zip(&b.columns) {
        assert_eq!(a.values, b.values);
    }
    // What follows is set on its own, and given back.
    s.set("b", 0.055).expect("it can be set");
    s.set("a", 0.02).expect("it can be set");
    assert_eq!(s.value("b").expect("a parameter"), 0.055);
    // It no longer follows: the derivative of what is made of it alone is zero.
    let j = s
        .derivatives(["distance(B, P)"], ["a", "b"])
        .expect("derivatives");
    assert!(j.get(0, 0).abs() < 1e-12 && j.get(0, 1) > 0.1);
    s.reset("b").expect("it is given back");
    assert!((s.value("b").expect("a parameter") - 0.05).abs() < 1e-16);
    let j = s
        .derivatives(["distance(B, P)"], ["a"])
        .expect("derivatives");
    assert!(j.get(0, 0) > 1.0);
}

#[test]
fn what_makes_no_sense_is_refused_and_changes_nothing() {
    let mut s = crank_rocker();
    let before = s.values().to_vec();
    for (name, value, code) in [
        ("c", 1.0, "unknown-name"),
        ("a", f64::NAN, "not-finite"),
        ("a", 0.0, "bad-size"),
        ("b", -0.01, "bad-size"),
    ] {
        let error = s.set(name, value).unwrap_err();
        assert_eq!(error.code(), code);
        assert!(!error.to_string().is_empty());
    }
    for (text, code) in [
        ("3 kg", "unit-mismatch"),
        ("3", "unit-mismatch"),
        ("2 * q", "unknown-name"),
        ("2 *", "syntax"),
    ] {
        assert_eq!(s.set_text("a", text).unwrap_err().code(), code, "{text}");
    }
    assert_eq!(s.values(), before);
    s.set_text("b", "3 * a")
        .expect("an expression of parameters");
    assert!((s.value("b").expect("a parameter") - 0.06).abs() < 1e-16);
    assert_eq!(
        s.sweep("moter", [0.0], ["x(B)"]).unwrap_err().code(),
        "unknown-name"
    );
    assert_eq!(
        s.sweep("motor", [f64::INFINITY], ["x(B)"])
            .unwrap_err()
            .code(),
        "not-finite"
    );
    assert_eq!(
        s.sweep("motor", [0.0], ["x(Q)"]).unwrap_err().code(),
        "unknown-name"
    );
    // A design that cannot be put together says why, and where in the file.
    s.set("a", 0.5).expect("a length");
    let error = s.sweep("motor", [0.0], ["x(B)"]).unwrap_err();
    assert_eq!(error.code(), "cannot-assemble");
    assert!(error.to_string().contains("model:"), "{error}");

    let open: Model = "[parameters]\na = \"3 m\"\n[links]\nframe = { A = [0, 0] }\n\
        plate = { A-B = 4, A-P = \"a\", B-P = 2, P = \"left of A -> B\" }\n\
        [drives]\nm = { turns = \"plate\", speed = \"1 rad/s\" }\n"
        .parse()
        .expect("a model");
    let mut s = open.compile().expect("it moves").session();
    assert_eq!(s.set("a", 1.0).unwrap_err().code(), "triangle-open");
    s.set("a", 5.0).expect("it closes");
}

#[test]
fn parameters_that_the_reader_took_for_numbers_cannot_be_set() {
    let card = "[loads]\ngas = { torque = { table = \"card\", over = \"angle(crank)\", period = \"a * 18000 deg / (1 m)\" }, on = \"crank\" }\n";
    let mut tables = kempe::model::Tables::new();
    tables.insert("card", "angle [deg],torque [N m]\n0,0\n180,1\n");
    let file = kempe::model::ModelFile::new(CRANK_ROCKER.to_owned() + card, tables);
    let model = Model::from_file(&file).expect("a model");
    let mut s = model.compile().expect("it moves").session();
    assert_eq!(s.set("a", 0.021).unwrap_err().code(), "settled-parameter");
    s.set("b", 0.051).expect("nothing was settled of it");
    // As the error says: another file.
    let mut other = model
        .with("a", "21 mm")
        .and_then(|m| m.compile())
        .expect("it moves")
        .session();
    assert!(other.start().is_ok());
}

#[test]
fn what_is_handed_over_twice_or_is_no_number_is_refused() {
    let mut s = crank_rocker();
    let twice = s.set_all([("a", 0.021), ("b", 0.05), ("a", 0.022)]);
    assert_eq!(twice.unwrap_err().code(), "duplicate-name");
    assert_eq!(s.value("a").expect("as it was"), 0.02);
    let columns = [("a", vec![0.02]), ("a", vec![0.03])];
    let designs = Designs::from_columns(columns).expect("of one length");
    let many = s.many(&designs, [1.0], ["x(P)"]);
    assert_eq!(many.unwrap_err().code(), "duplicate-name");
    let pose = s.start().expect("a pose");
    let equations = pose.equations_of_motion(&[f64::NAN]);
    assert_eq!(equations.unwrap_err().code(), "not-finite");
}

#[test]
fn a_place_that_hangs_on_parameters_follows_them_in_a_session() {
    let text = CRANK_ROCKER.to_owned()
        + "[measures]\nthere = \"at(x(P), motor, a * 50 rad / (1 m))\"\n\
           beyond = \"at(x(P), motor, 0.3 mm * 1 rad / (20.3 mm - a))\"\n";
    let model: Model = text.parse().expect("a model");
    let mut s = model.compile().expect("it moves").session();
    let told = |s: &mut Session| {
        let j = s.derivatives(["there"], ["a"]).expect("a number");
        (j.values[0], j.get(0, 0))
    };
    let (_, slope) = told(&mut s);
    let mut ends = [0.0; 2];
    for (end, a) in ends.iter_mut().zip([0.02 - 1e-6, 0.02 + 1e-6]) {
        s.set("a", a).expect("it goes with it");
        *end = told(&mut s).0;
        // as the file with that value
        let other = model.with("a", &format!("{a} m")).and_then(|m| m.compile());
        assert_eq!(told(&mut other.expect("it moves").session()).0, *end);
    }
    assert!(
        close((ends[1] - ends[0]) / 2e-6, slope, 1e-6),
        "{ends:?} {slope}"
    );
    // A place beyond the motion, or none at all.
    for a in [0.02029, 0.0203] {
        s.set("a", a).expect("it goes with it");
        let j = s.derivatives(["beyond"], ["a"]).expect("what there is");
        assert!(j.values[0].is_nan() && j.notes[0].is_some(), "{j:?}");
    }
    // Designs beside each other have places of their own.
    let lengths = [0.02, 0.021];
    let designs = Designs::from_columns([("a", lengths.to_vec())]).expect("designs");
    let many = s.many(&designs, lengths.map(|a| 50.0 * a), ["x(P) - there"]);
    let many = many.expect("values");
    for design in 0..2 {
        assert!(many.get(0, design, design).abs() < 1e-15);
        assert!(many.get(0, 1 - design, design).abs() > 1e-4);
    }
}

#[test]
fn every_value_that_is_missing_has_its_reason() {
    let mut s = crank_rocker();
    // Behind the law's end no speed is known; at a place where it divides by zero there is no value.
    let measures = [
        "x(C)",
        "speed(C)",
        "x(C) / (motor - 1 rad) * (motor - 1 rad)",
    ];
    let t = s.sweep("motor", [0.5, 1.0, 7.0], measures).expect("rows");
    assert!(t.reason(0).is_none());
    assert!(t.reason(1).expect("a reason").contains("no value here"));
    assert!(t.columns[0].values[2].is_finite() && t.columns[1].values[2].is_nan());
    assert!(
        t.reason(2)
            .expect("a reason")
            .contains("no law of the drives passes")
    );
    for row in 0..t.rows() {
        let missing = t.columns.iter().any(|c| c.values[row].is_nan());
        assert_eq!(missing, t.reason(row).is_some());
    }
}

#[test]
fn derivatives_are_those_of_the_designs_beside() {
    let mut s = crank_rocker();
    let measures = ["range(angle(rocker))", "x(P)"];
    let j = s
        .derivatives_at("motor", 1.0, measures, ["a"])
        .expect("derivatives");
    let h = 1e-6;
    let mut at = |a: f64| {
        s.set("a", a).expect("it can be set");
        let t = s.sweep("motor", [1.0], measures).expect("rows");
        [t.columns[0].values[0], t.columns[1].values[0]]
    };
    let (low, high) = (at(0.02 - h), at(0.02 + h));
    for k in 0..2 {
        let slope = (high[k] - low[k]) / (2.0 * h);
        assert!(close(j.get(k, 0), slope, 1e-6), "{} {slope}", j.get(k, 0));
    }
    assert!(j.notes.iter().all(Option::is_none) && j.get(0, 1).is_nan());
}

#[test]
fn many_designs_are_the_designs_one_by_one_whatever_the_threads() {
    let mut s = crank_rocker();
    let lengths = linspace(0.015, 0.024, 37);
    let designs = Designs::from_columns([("a", lengths.clone())]).expect("designs");
    let places = [0.2, 1.0, 4.0];
    let measures = [
        "x(P)",
        "y(P)",
        "transmission_angle(C)",
        "d(y(P), motor)",
        "speed(P)",
    ];
    let mut all = Vec::new();
    for threads in [1, 3] {
        s.use_threads(threads);
        all.push(s.many(&designs, places, measures).expect("values"));
    }
    for (a, b) in all[0].columns.iter().zip(&all[1].columns) {
        assert_eq!(a.values, b.values);
    }
    let v = &all[0];
    assert_eq!(
        (v.missing.as_slice(), v.in_lanes.as_slice()),
        (&[0; 5][..], &[true, true, true, true, false][..])
    );
    for (design, a) in lengths.iter().enumerate() {
        s.set("a", *a).expect("it can be set");
        let t = s.sweep("motor", places, measures).expect("rows");
        for measure in 0..measures.len() {
            for place in 0..3 {
                let (many, one) = (
                    v.get(measure, place, design),
                    t.columns[measure].values[place],
                );
                assert!((many - one).abs() < 1e-13, "{many} {one}");
            }
        }
    }
}

/// Along time the drives of every design stand where its own laws have them.
#[test]
fn many_designs_follow_their_own_laws() {
    let text = "[parameters]
w = \"1 rad/s\"
a = \"30 mm\"
[links]
frame = { A = [0, 0], E = [\"100 mm\", 0] }
left  = { A-B = \"a\" }
up    = { B-C = \"70 mm\" }
down  = { C-D = \"70 mm\" }
right = { E-D = \"30 mm\" }
[drives]
one = { turns = \"left\", from = \"90 deg\", to = \"120 deg\", speed = \"w\" }
two = { turns = \"right\", from = \"80 deg\", to = \"60 deg\", speed = \"1 rad/s\" }
[assembly]
C = \"left of B -> D\"
";
    let model: Model = text.parse().expect("a model");
    let mut s = model.compile().expect("it moves").session();
    let designs = Designs::from_rows(&["w", "a"], [[1.0, 0.03], [0.8, 0.03], [1.2, 0.031]]);
    let designs = designs.expect("designs");
    let v = s.many(&designs, [0.1, 0.3], ["x(C)", "2 * x(C)", "angle(left)"]);
    let v = v.expect("values");
    assert_eq!(v.in_lanes, [false; 3]);
    for (place, time) in [0.1, 0.3].into_iter().enumerate() {
        for (design, speed) in [1.0, 0.8, 1.2].into_iter().enumerate() {
            let (plain, twice) = (v.get(0, place, design), v.get(1, place, design));
            assert!((twice - 2.0 * plain).abs() < 1e-15, "{plain} {twice}");
            let turned = std::f64::consts::FRAC_PI_2 + speed * time;
            assert!((v.get(2, place, design) - turned).abs() < 1e-12);
        }
    }
}

/// Forces of many designs are those of rows with all their evidence, to the bit, and what is missing is missing for the same reason: beyond a limit, and
/// where no law passes a place.
#[test]
fn forces_of_many_designs_are_those_of_rows_to_the_bit() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../examples/seeds/tractor-hitch.toml"
    );
    let mut s = Model::from_path(path).unwrap().compile().unwrap().session();
    let weights = [9000.0, 12_000.0];
    let designs = Designs::from_columns([("weight", weights.to_vec())]).expect("designs");
    let places = [0.36, 0.40, 0.47, 0.53, 0.9];
    let measures = ["force(lift)", "reaction(K)", "speed(M)", "max(force(lift))"];
    let v = s.many(&designs, places, measures).expect("values");
    assert!(v.in_lanes.iter().all(|lanes| !lanes));
    let (mut there, mut missing) = (0, 0);
    for (design, weight) in weights.iter().enumerate() {
        s.set("weight", *weight).expect("it can be set");
        let t = s.sweep("lift", places, measures).expect("rows");
        for place in 0..places.len() {
            for measure in 0..measures.len() {
                let many = v.get(measure, place, design);
                let one = t.columns[measure].values[place];
                assert_eq!(many.is_nan(), one.is_nan(), "{measure} {place}");
                if one.is_nan() {
                    missing += 1;
                    assert_eq!(v.reason(measure, place, design), t.reason(place));
                    assert!(t.reason(place).is_some());
                } else {
                    there += 1;
                    assert_eq!(many.to_bits(), one.to_bits(), "{measure} {place}");
                }
            }
        }
    }
    assert!(there >= 16 && missing >= 8, "{there} {missing}");
}

#[test]
fn designs_that_do_not_close_or_make_no_sense_are_counted_with_their_reasons() {
    let mut s = crank_rocker();
    let designs = Designs::from_rows(&["a", "b"], [[0.02, 0.05], [0.3, 0.05], [-0.02, 0.05]])
        .expect("designs");
    let v = s
        .many(&designs, [1.0], ["x(C)", "angle(rocker)"])
        .expect("values");
    assert_eq!(v.missing, [2, 2]);
    for measure in 0..2 {
        assert!(v.reason(measure, 0, 0).is_none() && v.get(measure, 0, 0).is_finite());
        assert!(v.reason(measure, 0, 1).is_some() && v.get(measure, 0, 1).is_nan());
        assert!(
            v.reason(measure, 0, 2)
                .expect("a reason")
                .contains("must be positive")
        );
    }
    let mut none = |_: Stage, done: Done| match done {
        Done::Of(..) => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    };
    let v = s
        .many_with(&designs, [1.0], ["angle(rocker)", "x(C)"], &mut none)
        .expect("values");
    assert!(v.get(1, 0, 0).is_finite());
    assert_eq!(
        v.reason(0, 0, 0),
        Some("stopped before this design was done")
    );
    let wrong = Designs::from_columns([("q", vec![1.0])]).expect("designs");
    assert_eq!(
        s.many(&wrong, [1.0], ["x(C)"]).unwrap_err().code(),
        "unknown-name"
    );
}

#[test]
fn a_pose_of_another_design_is_told_from_ours() {
    let mut s = crank_rocker();
    let p = s.pose([("motor", 1.0)]).expect("a pose");
    let q = s.pose_near(&p, "motor", 1.1).expect("near it");
    s.set("a", 0.021).expect("it can be set");
    assert_eq!(
        s.pose_near(&p, "motor", 1.1).unwrap_err().code(),
        "another-design"
    );
    s.set("a", 0.02).expect("it can be set");
    let again = s.pose_near(&p, "motor", 1.1).expect("near it");
    assert_eq!(again.points(), q.points());
    assert_eq!(
        crank_rocker()
            .pose_near(&p, "motor", 1.0)
            .unwrap_err()
            .code(),
        "another-design"
    );
}

#[test]
fn a_sweep_may_be_stopped_and_clones_go_their_own_way() {
    let mut s = crank_rocker();
    let mut five = |_: Stage, done: Done| match done {
        Done::Of(rows, _) if rows >= 5 => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    };
    let t = s
        .sweep_with("motor", linspace(0.0, 1.0, 100), ["x(B)"], &mut five)
        .expect("rows");
    assert!(t.rows() == 5 && t.interrupted());
    let mut other = s.clone();
    other.set("a", 0.022).expect("it can be set");
    assert_eq!(s.value("a").expect("a parameter"), 0.02);
}

#[test]
fn what_cannot_move_says_so_when_it_is_compiled() {
    let text = "[links]\nframe = { A = [0, 0], D = [3, 0] }\ncrank = { A-B = 1 }\n\
        coupler = { B-C = 3 }\nrocker = { D-C = 2 }\n";
    let loose: Model = text.parse().expect("a model");
    assert_eq!(loose.compile().unwrap_err().code(), "no-drive");
    // A single pose is found all the same: what is free is held somewhere.
    let pose = loose.pose("").expect("a pose");
    let [b, c] = ["B", "C"].map(|name| pose.point(name).expect("a point"));
    assert!((kempe::number::math::hypot(b[0] - c[0], b[1] - c[1]) - 3.0).abs() < 1e-12);
}

/// Places are expressions: a parameter moves the drawing, and with it lengths, start and assembly.
#[test]
fn a_drawing_follows_its_parameters() {
    let text = |w: &str| {
        format!(
            "units = {{ length = \"mm\" }}\n[parameters]\nw = \"{w}\"\n[places]\nA = [0, 0]\nB = [\"w / 3\", 11]\nC = [\"w\", 38]\nD = [60, 0]\n\
             [links]\nframe = [\"A\", \"D\"]\ncrank = [\"A\", \"B\"]\ncoupler = [\"B\", \"C\"]\nrocker = [\"D\", \"C\"]\n\
             [drives]\nmotor = {{ turns = \"crank\", to = 90, speed = 1 }}\n"
        )
    };
    let session = |w: &str| {
        let model: Model = text(w).parse().expect("a model");
        model.compile().expect("it moves").session()
    };
    let mut set = session("50 mm");
    set.set("w", 0.055).expect("sound");
    let (moved, anew) = (
        set.start().expect("a pose"),
        session("55 mm").start().expect("a pose"),
    );
    for (point, drawn) in [("B", [0.055 / 3.0, 0.011]), ("C", [0.055, 0.038])] {
        for pose in [&moved, &anew] {
            let at = pose.point(point).expect("a point");
            assert!(
                (0..2).all(|i| (at[i] - drawn[i]).abs() < 1e-12),
                "{point}: {at:?} {drawn:?}"
            );
        }
    }
}

/// A drawing whose drive starts elsewhere is followed to the start, for the parameters of the session.
#[test]
fn a_drawing_that_starts_elsewhere_follows_its_parameters() {
    let text = "[parameters]\nw = \"0.5 m\"\n[places]\nA = [0, 0]\nB = [0.1, 0.2]\nC = [\"w + 0.1 m\", 0.2]\nD = [\"w\", 0]\n\
        [links]\nframe = [\"A\", \"D\"]\ncrank = [\"A\", \"B\"]\ncoupler = [\"B\", \"C\"]\nrocker = [\"D\", \"C\"]\n\
        [drives]\nmotor = { turns = \"crank\", from = 0, to = 2, speed = 1 }\n";
    let model: Model = text.parse().expect("a model");
    let mut session = model.compile().expect("it moves").session();
    // a parallelogram, whatever its width: every place is that of the crank, moved by the width
    for w in [0.5, 0.55, 0.3] {
        session.set("w", w).expect("sound");
        let at = session.pose([("motor", 1.5)]).expect("a pose");
        let [b, c] = ["B", "C"].map(|name| at.point(name).expect("a point"));
        assert!(
            (c[0] - b[0] - w).abs() < 1e-12 && (c[1] - b[1]).abs() < 1e-12,
            "{w}: {b:?} {c:?}"
        );
    }
}

#[test]
fn infinite_numbers_over_the_motion_are_told_by_every_question() {
    let mut s = crank_rocker();
    // The crank's end passes x = 0 at 90 and 270 degrees; its highest place is finite.
    let asked = ["max(1 / x(B)^2)", "max(y(B))"];
    let infinite = |warnings: &[Diagnostic]| {
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        assert_eq!(warnings[0].code, "infinite");
        let told = &warnings[0].message;
        assert!(
            told.contains("max(1 / x(B)^2)") && told.contains(" at motor = "),
            "{told}"
        );
    };
    let table = s.sweep("motor", [0.5], asked).expect("rows");
    infinite(&table.warnings);
    assert_eq!(table.columns[0].values, [f64::INFINITY]);
    let pose = s.pose([("motor", 0.5)]).expect("a pose");
    infinite(
        &pose
            .measure(asked[0])
            .expect("infinite is a value")
            .warnings,
    );
    assert!(pose.measure(asked[1]).expect("a value").warnings.is_empty());
    infinite(&s.derivatives(asked, ["a"]).expect("derivatives").warnings);
    assert!(
        s.sweep("motor", [0.5], [asked[1]])
            .expect("rows")
            .warnings
            .is_empty()
    );
}

/// Where a measure turns back at once its extreme stays where both sides meet: derivatives are those of differences, and none of what is
/// a right angle in every design near.
#[test]
fn derivatives_of_extremes_at_folds_are_those_of_differences() {
    let asked = [
        "max(transmission_angle(C))",
        "max(angle(A, B, C))",
        "min(abs(angle(rocker) - 123 deg))",
        "max(y(P) - 40 mm * abs(angle(rocker) - 123 deg) / 1 rad)",
        "min(x(P) + 90 mm * abs(angle(rocker) - 100 deg) / 1 rad)",
        "range(abs(angle(rocker) - 110 deg))",
        "max(y(P))",
    ];
    let derivatives = |a: f64| {
        let mut s = crank_rocker();
        s.set("a", a).expect("a length");
        s.derivatives(asked, ["a"]).expect("derivatives")
    };
    let (a, by) = (0.0201, 1e-7);
    let (found, low, high) = (derivatives(a), derivatives(a - by), derivatives(a + by));
    let mut folds = 0;
    for (k, name) in asked.iter().enumerate() {
        let difference = (high.values[k] - low.values[k]) / (2.0 * by);
        let exact = found.get(k, 0);
        assert!(
            (exact - difference).abs() <= 1e-5 * difference.abs().max(1.0),
            "{name}: {exact} for {difference}"
        );
        folds += usize::from(difference != 0.0);
    }
    assert!(folds >= 4);
}

/// Where the session's own design does not come, and where laws of designs differ, many designs are what each is by itself.
#[test]
fn many_designs_tell_no_more_than_their_motions() {
    let rocker = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\na = \"20 mm\"\n[links]\nframe = { A = [0, 0], D = [60, 0] }\n\
        crank = { A-B = \"a\" }\ncoupler = { B-C = 50, P = [25, 5] }\nrocker = { D-C = 40 }\n[drives]\n\
        motor = { turns = \"rocker\", from = 120, to = 140, speed = \"1 rad/s\" }\n[assembly]\nB = \"left of A -> C\"\n";
    let mut s = rocker
        .parse::<kempe::Model>()
        .unwrap()
        .compile()
        .unwrap()
        .session();
    let designs = kempe::Designs::from_columns([("a", vec![0.02, 0.021])]).unwrap();
    let at = [-2.5, 2.3];
    let many = s.many(&designs, at, ["x(P)", "angle(coupler)"]).unwrap();
    assert_eq!(
        (many.in_lanes.as_slice(), many.missing.as_slice()),
        ([false; 2].as_slice(), [2, 2].as_slice())
    );
    assert!(
        many.reason(0, 0, 0).unwrap().contains("limit is at 93.58"),
        "{:?}",
        many.reason(0, 0, 0)
    );
    let reached = s.many(&designs, [2.3], ["x(P)", "angle(coupler)"]).unwrap();
    assert_eq!(reached.in_lanes, [true; 2]);
    for (measure, design) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        let [a, b] = [
            many.get(measure, 1, design),
            reached.get(measure, 0, design),
        ];
        assert!((a - b).abs() < 1e-12, "{a} {b}");
    }

    let arms = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\na = \"30 mm\"\npace = \"50 deg/s\"\n[links]\nframe = { A = [0, 0], E = [60, 0] }\n\
        l1 = { A-B = \"a\" }\nl2 = { B-C = 55 }\nl3 = { D-C = 50 }\nl4 = { E-D = 25 }\n[drives]\nm1 = { turns = \"l1\", from = 90, to = 120, speed = \"pace\" }\n\
        m2 = { turns = \"l4\", from = 30, to = 60, law = \"cycloidal\", in = \"0.5 s\" }\n[assembly]\nC = { near = [30, 60] }\n";
    let mut s = arms
        .parse::<kempe::Model>()
        .unwrap()
        .compile()
        .unwrap()
        .session();
    for (name, value, lanes) in [("a", 0.031, true), ("pace", 0.6, false)] {
        let designs = kempe::Designs::from_columns([(name, vec![value])]).unwrap();
        let many = s.many(&designs, [0.2, 0.4], ["x(C)"]).unwrap();
        assert_eq!(many.in_lanes, [lanes]);
        let mut alone = s.clone();
        alone.set(name, value).unwrap();
        let sweep = alone.sweep("time", [0.2, 0.4], ["x(C)"]).unwrap();
        for place in 0..2 {
            let [a, b] = [many.get(0, place, 0), sweep.columns[0].values[place]];
            assert!((a - b).abs() < 1e-12, "{name}: {a} {b}");
        }
    }
}

/// What comes within no motion of a design is told of none of its measures, however they are taken: behind a limit a linkage may close again. At a stretched-out
/// pose, where it closes but for rounding, and behind, it is told.
#[test]
fn many_designs_end_where_each_of_them_does() {
    let text = "[parameters]\na = \"0.2 m\"\nc = \"0.5 m\"\n[links]\nframe = { A = [0, 0], D = [0.6, 0] }\ncrank = { A-B = \"a\" }\n\
        coupler = { B-C = \"c\" }\nrocker = { D-C = 0.4 }\n[drives]\nmotor = { turns = \"crank\", from = 20, to = 360, speed = \"60 deg/s\" }\n\
        [assembly]\nC = \"left of B -> D\"\n";
    let mut s = text
        .parse::<kempe::Model>()
        .unwrap()
        .compile()
        .unwrap()
        .session();
    let lengths: Vec<f64> = (0..40).map(|k| 0.2 + 0.0101 * f64::from(k)).collect();
    let places = [-50.0, -10.0, 1.0, 5.0, 20.0, 90.0, 170.0, 300.0, 359.0].map(f64::to_radians);
    let measures = ["x(B)", "x(C)", "angle(rocker)", "angle(A -> C)"];
    let designs = kempe::Designs::from_columns([("a", lengths.clone())]).unwrap();
    let many = s.many(&designs, places, measures).unwrap();
    assert_eq!(many.in_lanes, [true, true, true, false]);
    let mut behind = 0;
    for design in 0..lengths.len() {
        for (place, at) in places.iter().enumerate() {
            let missing: Vec<bool> = (0..4)
                .map(|m| many.get(m, place, design).is_nan())
                .collect();
            assert!(
                missing.iter().all(|it| *it == missing[3]),
                "{} at {at}: {missing:?}",
                lengths[design]
            );
            let reason = many.reason(0, place, design);
            assert_eq!(reason.is_some(), missing[0]);
            behind += usize::from(reason.is_some_and(|why| why.contains("on the way here")));
        }
    }
    assert!(behind > 20, "{behind}");
    // A parallelogram of any size is stretched out at half a turn.
    let even = text.replace(
        "frame = { A = [0, 0], D = [0.6, 0] }",
        "frame = { A = [0, 0], D = [\"c\", 0] }",
    );
    let even = even
        .replace("D-C = 0.4", "D-C = \"a\"")
        .replace("360", "178");
    let mut s = even
        .parse::<kempe::Model>()
        .unwrap()
        .compile()
        .unwrap()
        .session();
    let lengths: Vec<f64> = (0..40).map(|k| 0.2 + 0.0073 * f64::from(k)).collect();
    let designs = kempe::Designs::from_columns([("a", lengths)]).unwrap();
    let many = s.many(&designs, [0.5, 1.0, 3.1], ["x(C)"]).unwrap();
    assert_eq!((many.in_lanes[0], many.missing[0]), (true, 0));
}

/// What `kempe run` warns of a session tells, too: hints that are missed and what else there is to say of a mechanism with the motion, for the values that are set;
/// a pin that is beyond its slot in its rows and poses.
#[test]
fn what_runs_warn_of_sessions_tell() {
    let text = |near: &str| {
        format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\n[parameters]\na = \"20 mm\"\n[links]\nframe = {{ A = [0, 0], D = [60, 0] }}\n\
             crank = {{ A-B = \"a\" }}\ncoupler = {{ B-C = 50 }}\nrocker = {{ D-C = 40 }}\n[drives]\n\
             motor = {{ turns = \"crank\", from = 0, to = 360, speed = \"60 rpm\" }}\n[assembly]\nC = {{ near = {near} }}\n"
        )
    };
    let codes = |s: &mut kempe::Session| -> Vec<&str> {
        let warnings = s.motion().unwrap().warnings;
        warnings.iter().map(|d| d.code).collect()
    };
    let session = |text: String| {
        let model = text.parse::<kempe::Model>().unwrap();
        model.compile().unwrap().session()
    };
    assert_eq!(codes(&mut session(text("[45, 300]"))), ["hint-missed"]);
    let mut s = session(text("[50, 39]"));
    assert!(codes(&mut s).is_empty());
    s.set("a", 0.045).unwrap();
    assert_eq!(codes(&mut s), ["hint-missed", "range-beyond-limit"]);

    let cam = "units = { length = \"mm\", angle = \"deg\" }\n[links]\nframe = { A = [0, 0], D = [100, 0] }\ncrank = { A-B = 40 }\n\
        lever = { D = [0, 0], E = [100, 0], F = [130, 5] }\n[joints]\ncam = { pin = \"B\", arc = \"E -> F\", radius = 60 }\n[drives]\n\
        motor = { turns = \"crank\", from = 60, to = 300, speed = \"60 rpm\" }\n[assembly]\nlever = { near = \"140 deg\" }\n";
    let mut s = session(cam.to_owned());
    let places = [60.0, 120.0, 180.0, 240.0].map(f64::to_radians);
    let sweep = s.sweep("motor", places, ["angle(lever)"]).unwrap();
    let beyond = "B is beyond the end of the curved slot `cam`, by ";
    let notes = sweep.notes.iter();
    let told: Vec<bool> = notes
        .map(|note| note.as_ref().is_some_and(|note| note.contains(beyond)))
        .collect();
    assert!(told.contains(&true) && told.contains(&false), "{told:?}");
    for (place, told) in places.iter().zip(&told) {
        let pose = s.pose([("motor", *place)]).unwrap();
        assert_eq!(pose.note().is_some_and(|note| note.contains(beyond)), *told);
    }
}

/// The code of an error is that of what is wrong, whatever is warned of before it.
#[test]
fn codes_of_errors_are_of_errors() {
    let text = "[links]\nframe = { A = [0, 0] }\ncrank = { A-B = 1, mass = \"1 kg\" }\n[drives]\nmotor = { turns = \"crank\", from = 0, to = 1, speed = \"1 rad/s\" }\n\
        [measures]\nm = \"y(Q)\"\n";
    let error = text.parse::<kempe::Model>().unwrap_err();
    let severities: Vec<_> = error.diagnostics().iter().map(|d| d.severity).collect();
    assert!(
        severities.contains(&kempe::model::Severity::Warning),
        "{error}"
    );
    assert_eq!(error.code(), "unknown-name", "{error}");
    assert_eq!(format!("{error:?}"), error.to_string());
}

/// What the equations of motion need for the accelerations of the file's motion is what its drives give, found by inverse dynamics.
#[test]
fn the_equations_of_motion_of_a_pose_are_those_of_its_drives() {
    let cases: [(&str, &[[&str; 2]]); 5] = [
        (
            "gallery/belt-leg",
            &[["hip", "torque(hip)"], ["knee", "torque(knee)"]],
        ),
        ("gallery/balanced-four-bar", &[["motor", "torque(motor)"]]),
        ("gallery/landing-gear", &[["actuator", "force(actuator)"]]),
        ("gallery/garage-door", &[["lift", "torque(lift)"]]),
        (
            "gallery/excavator",
            &[
                ["boom_cylinder", "force(boom_cylinder)"],
                ["stick_cylinder", "force(stick_cylinder)"],
                ["bucket_cylinder", "force(bucket_cylinder)"],
            ],
        ),
    ];
    for (name, drives) in cases {
        let mut s = session(name);
        let asked = drives.iter().flat_map(|[drive, effort]| {
            let rate = |order: u32| format!("rate({drive}, {order})");
            [rate(1), rate(2), (*effort).to_owned()]
        });
        let asked: Vec<String> = asked.collect();
        let end = s.motion().expect("a motion").duration;
        for part in [0.05, 0.3, 0.45, 0.8] {
            let time = part * end;
            let found = s.sweep("time", [time], &asked).expect("it sweeps");
            let of = |k: usize| -> Vec<f64> {
                let each = found.columns[k..].iter().step_by(3);
                each.map(|column| column.values[0]).collect()
            };
            let pose = s.pose([("time", time)]).expect("a pose");
            let equations = pose.equations_of_motion(&of(0)).expect("equations");
            let needed = equations.needed(&of(1));
            let size = needed.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
            for (needed, given) in needed.iter().zip(of(2)) {
                assert!(
                    (needed - given).abs() <= 1e-9 * size,
                    "{name} {time}: {needed} {given}"
                );
            }
        }
    }
    let mut s = session("gallery/belt-leg");
    let error = s.start().expect("a start").equations_of_motion(&[1.0]);
    assert_eq!(error.expect_err("two drives").code(), "wrong-length");
}

/// A slider at the end of its stroke, stretched out, moves no crank: there are no equations, and that is said.
#[test]
fn a_singular_pose_has_no_equations_of_motion() {
    let stretched: Model = "[links]\nframe = { A = [0, 0], E = ['-1 m', 0], F = ['1 m', 0] }\ncrank = { A-B = '0.1 m', mass = '1 kg' }\n\
        rod = { B-C = '0.3 m', mass = '1 kg' }\npiston = { C = [0, 0], mass = '1 kg' }\n[joints]\nbore = { slider = 'piston', at = 'C', on = 'E -> F' }\n\
        [drives]\npush = { slides = 'piston', from = '1.3 m', to = '1.4 m', speed = '10 mm/s' }\n[assembly]\nB = 'left of A -> C'\n"
        .parse()
        .expect("a model");
    let mut s = stretched.compile().expect("it moves").session();
    let inside = s.pose([("push", 1.35)]).expect("a pose");
    assert!(inside.equations_of_motion(&[0.1]).is_ok());
    let end = s.pose([("push", 1.4)]).expect("its end");
    let error = end.equations_of_motion(&[0.1]).expect_err("singular");
    assert_eq!(error.code(), "no-value");
}

/// A pin starts between the ends of its slot, of many designs, too: beyond them its loop closes all the same.
#[test]
fn many_designs_whose_pin_starts_beyond_its_slot_do_not_move() {
    let slot: Model = "units = { length = 'mm', angle = 'deg' }\n[parameters]\nr = '20 mm'\n[links]\nframe = { O = [0, 0], D = [70, 0] }\n\
        crank = { O-B = 'r' }\nplate = { D = [0, 0], A1 = [-100, 0], A2 = [-80, 6], A3 = [-60, 6], A4 = [-48, 0] }\n[joints]\n\
        slot = { pin = 'B', through = ['A1', 'A2', 'A3', 'A4'] }\n[drives]\nmotor = { turns = 'crank', from = 0, to = 360, speed = '60 rpm' }\n\
        [assembly]\nplate = { near = '0 deg' }\n"
        .parse()
        .expect("a model");
    let mut s = slot.compile().expect("it moves").session();
    let designs = Designs::from_columns([("r", vec![0.02, 0.021, 0.0235])]).expect("three");
    let found = s
        .many(&designs, [0.5, 1.5], ["angle(plate)", "x(A1)"])
        .expect("values");
    // Each column tells its places one after the other.
    for column in &found.columns {
        let known: Vec<bool> = column.values.iter().map(|x| x.is_finite()).collect();
        assert_eq!(known, [true, true, false, true, true, false]);
    }
}

/// Designs whose other drives stand elsewhere, or whose drives go otherwise between the least and the largest value of a parameter or by
/// several together, are followed: lanes would take the drives of the session's own design for theirs.
#[test]
fn many_designs_have_their_own_drives() {
    let with_drives = |drives: &str| -> kempe::Session {
        let text = format!(
            "[parameters]\np = \"60 deg\"\nq = 1\n[links]\nframe = {{ A = [0, 0], E = [1, 0] }}\nl1 = {{ A-B = 1 }}\nl2 = {{ B-C = 1 }}\n\
             r1 = {{ E-F = 1 }}\nr2 = {{ F-C = 1 }}\n[drives]\n{drives}\n[assembly]\nC = \"left of F -> B\"\n"
        );
        text.parse::<Model>().unwrap().compile().unwrap().session()
    };
    let one = "m1 = { turns = \"l1\", from = 100, to = 120, speed = \"1 rad/s\" }\nm2 = { turns = \"r1\", at = \"p\" }";
    let both = "m1 = { turns = \"l1\", from = \"90 deg + q * (p - 60 deg)\", to = 150, speed = \"1 rad/s\" }\n\
                m2 = { turns = \"r1\", from = 60, to = 80, speed = \"1 rad/s\" }";
    let bent = both.replace("q * (p - 60 deg)", "(p - 60 deg) * (p - 60 deg) / 1 rad");
    let deg = f64::to_radians;
    let cases = [
        // The drive that is held.
        (one, "m1", [(deg(60.0), 1.0), (deg(90.0), 1.0)], 1.8),
        // Two parameters of which none alone moves anything.
        (both, "time", [(deg(60.0), 0.5), (deg(66.0), 0.5)], 0.1),
        // Between ends that are alike.
        (&bent, "time", [(deg(60.0), 1.0), (deg(63.0), 1.0)], 0.1),
    ];
    for (drives, over, designs, place) in cases {
        let drives = &drives.replace(
            "from = 100, to = 120",
            "from = \"100 deg\", to = \"120 deg\"",
        );
        let drives = &drives
            .replace("to = 150", "to = \"150 deg\"")
            .replace("from = 60, to = 80", "from = \"60 deg\", to = \"80 deg\"");
        let mut s = with_drives(drives);
        let rows = designs.map(|(p, q)| [p, q]);
        let many = Designs::from_rows(&["p", "q"], rows).unwrap();
        let measures = ["x(F)", "x(C)", "angle(r1)", "angle(l1)"];
        let v = s.many(&many, [place], measures).unwrap();
        for (design, (p, q)) in designs.into_iter().enumerate() {
            s.set_all([("p", p), ("q", q)]).unwrap();
            let t = s.sweep(over, [place], measures).unwrap();
            for measure in 0..measures.len() {
                let (ours, rows) = (v.get(measure, 0, design), t.columns[measure].values[0]);
                assert!(
                    (ours - rows).abs() < 1e-14,
                    "{over} {measure}: {ours} {rows}"
                );
            }
        }
    }
}

/// A place beyond a limit takes nothing from places on the other side, to which the motion of the pose was not followed yet.
#[test]
fn places_beyond_a_limit_leave_the_others_reached() {
    let text = "units = { length = \"mm\" }\n[links]\nframe = { A = [0, 0], D = [60, 0] }\ncrank = { A-B = 40 }\ncoupler = { B-C = 30 }\nrocker = { D-C = 45 }\n\
                [drives]\nmotor = { turns = \"crank\", from = 0, to = \"20 deg\", speed = \"1 rad/s\" }\n[assembly]\nC = \"left of B -> D\"\n";
    let mut s = text.parse::<Model>().unwrap().compile().unwrap().session();
    let start = s.start().unwrap();
    let pose = s.pose_near(&start, "motor", 1.6).unwrap();
    let of = |places: &[f64]| {
        let rows = s.sweep_from(&pose, "motor", places, ["x(C)"], &mut Silent);
        rows.unwrap().columns[0].values.clone()
    };
    let alone = of(&[-0.5])[0];
    let with_others = of(&[2.0, -0.5]);
    assert!(alone.is_finite() && with_others[0].is_nan());
    assert!((with_others[1] - alone).abs() < 1e-14);
}
