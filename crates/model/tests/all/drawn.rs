//! `[places]` and links that list their points: what the reader makes of them, and how they are edited.
#![allow(clippy::unwrap_used)]

use kempe_model::{
    DriveKind, HintKind, Model, Part, PartKind, Place, apply, complete, delete, rename, value,
};

const FILE: &str = r#"
[parameters]
w = "55 m"
[places]
A = [0, 0]
B = [3, 4]
C = ["w", 38]
D = [60, 0]
P = [30, "42 m"]
[links]
frame = ["A", "D"]
crank = ["A", "B"]
coupler = ["B", "C", "P"]
rocker = { points = ["D", "C"], mass = "2 kg", inertia = 0 }
[drives]
motor = { turns = "crank", speed = 1 }
"#;

fn read(text: &str) -> Model {
    let read = Model::from_toml(text, "drawn", &mut |_| Err(String::new()));
    let checked = read.unwrap_or_else(|found| {
        panic!(
            "{}",
            found
                .iter()
                .map(|d| d.render_plain("drawn", text))
                .collect::<String>()
        )
    });
    assert_eq!(checked.warnings, [], "{text}");
    checked.model
}

fn codes(text: &str) -> Vec<&'static str> {
    let found = match Model::from_toml(text, "drawn", &mut |_| Err(String::new())) {
        Ok(checked) => checked.warnings,
        Err(found) => found,
    };
    found.iter().map(|d| d.code).collect()
}

/// The points of a link in its own coordinates.
fn points(model: &Model, link: &str) -> Vec<[f64; 2]> {
    let link = model.links.iter().find(|l| l.name == link).unwrap();
    link.evaluate(&model.parameter_values::<f64>())
}

fn hints(model: &Model) -> Vec<String> {
    let name = |kind: &HintKind| match kind {
        HintKind::Side { point, .. } | HintKind::NearPlace { point, .. } => {
            model.points[point.index()].name.clone()
        }
        HintKind::NearAngle { link, .. } => model.links[link.index()].name.clone(),
    };
    model.assembly.iter().map(|hint| name(&hint.kind)).collect()
}

#[test]
fn listed_points_lie_on_their_link_as_they_are_drawn() {
    let model = read(FILE);
    assert_eq!(points(&model, "frame"), [[0.0, 0.0], [60.0, 0.0]]);
    assert_eq!(points(&model, "crank"), [[0.0, 0.0], [5.0, 0.0]]);
    // by complex division: (P - B) / (C - B) |C - B|
    let (c, p) = ([52.0f64, 34.0f64], [27.0f64, 38.0f64]);
    let size = (c[0] * c[0] + c[1] * c[1]).sqrt();
    let expected = [
        [0.0, 0.0],
        [size, 0.0],
        [
            (p[0] * c[0] + p[1] * c[1]) / size,
            (p[1] * c[0] - p[0] * c[1]) / size,
        ],
    ];
    for (found, expected) in points(&model, "coupler").iter().zip(expected) {
        assert!(
            (0..2).all(|i| (found[i] - expected[i]).abs() < 1e-13),
            "{found:?} {expected:?}"
        );
    }
    assert_eq!(hints(&model), ["B", "C", "P", "coupler", "rocker"]);
    let from = value(&model.drives[0].law.from, &model.parameter_values::<f64>());
    assert!((from - kempe_number::math::atan2(4.0, 3.0)).abs() < 1e-15);
}

#[test]
fn given_distances_count_instead_of_drawn_ones() {
    let apart = |p: &[[f64; 2]], i: usize, j: usize| {
        kempe_number::math::hypot(p[i][0] - p[j][0], p[i][1] - p[j][1])
    };
    let drawn = points(&read(FILE), "coupler");
    let with = |given: &str| {
        let listed = format!("{{ points = [\"B\", \"C\", \"P\"], {given} }}");
        points(
            &read(&FILE.replace("[\"B\", \"C\", \"P\"]", &listed)),
            "coupler",
        )
    };
    // the axis alone: the rest keeps its place
    let one = with("C-B = \"w / 11\"");
    assert_eq!((one[1], one[2]), ([5.0, 0.0], drawn[2]));
    // from another point, along the drawn way
    let two = with("P-C = 10");
    assert!((apart(&two, 1, 2) - 10.0).abs() < 1e-14);
    let ways = [0, 1].map(|i| {
        (
            (two[2][i] - two[1][i]) / 10.0,
            (drawn[2][i] - drawn[1][i]) / apart(&drawn, 1, 2),
        )
    });
    assert!(ways.iter().all(|(a, b)| (a - b).abs() < 1e-14), "{ways:?}");
    // a whole triangle, on the drawn side
    let all = with("B-C = 60, B-P = 40, C-P = 30");
    let found = [apart(&all, 0, 1), apart(&all, 0, 2), apart(&all, 1, 2)];
    assert!(
        found
            .iter()
            .zip([60.0, 40.0, 30.0])
            .all(|(a, b)| (a - b).abs() < 1e-13),
        "{found:?}"
    );
    assert!(all[2][1] > 0.0 && drawn[2][1] > 0.0);
    let mirrored = FILE.replace("P = [30, \"42 m\"]", "P = [30, -42]").replace(
        "[\"B\", \"C\", \"P\"]",
        "{ points = [\"B\", \"C\", \"P\"], B-C = 60, B-P = 40, C-P = 30 }",
    );
    assert!(points(&read(&mirrored), "coupler")[2][1] < 0.0);
}

#[test]
fn hints_of_the_file_come_first_and_alone_where_it_starts_elsewhere() {
    let own = format!("{FILE}[assembly]\nC = \"left of B -> D\"\ncoupler = {{ near = 30 }}\n");
    assert_eq!(hints(&read(&own)), ["C", "coupler", "B", "P", "rocker"]);
    // drawn hints are about where it is drawn, those of the file about the start
    let elsewhere = read(&FILE.replace("speed", "from = 0, speed"));
    let [found] = elsewhere.starting_elsewhere(&elsewhere.parameter_values::<f64>())[..] else {
        panic!()
    };
    assert_eq!((found.start, hints(&elsewhere).len()), (0.0, 5));
    assert!((found.drawn - kempe_number::math::atan2(4.0, 3.0)).abs() < 1e-15);
    let said = own.replace("speed", "from = 0, speed");
    assert_eq!(hints(&read(&said)), ["C", "coupler"]);
    // a turn further, or few digits, is as drawn
    for from in ["53.1", "413.13", "-306.87"] {
        let near = FILE.replace("speed", &format!("from = {from}, speed"));
        let near = read(&near);
        let elsewhere = near.starting_elsewhere(&near.parameter_values::<f64>());
        assert_eq!((elsewhere, hints(&near).len()), (vec![], 5), "{from}");
    }
}

#[test]
fn what_is_not_drawn_is_read_as_before() {
    let mixed = r#"
[places]
C = [5, 4]
P = [3, 5]
[links]
frame = { A = [0, 0], D = [6, 0], E = [9, 9] }
crank = { A-B = 2 }
coupler = { points = ["C", "P"], C-B = 5, P-B = 5.5, B = "left of C -> P" }
rocker = { D-C = 4 }
[drives]
motor = { turns = "crank", from = 30, speed = 1 }
"#;
    let model = read(mixed);
    assert_eq!(hints(&model), ["C", "P", "coupler", "rocker"]);
    let coupler = &model.links[2];
    assert!(matches!(coupler.points[2].place, Place::Triangle { .. }));
    // nothing is drawn: nothing starts as drawn
    let plain = mixed
        .replace("[places]\nC = [5, 4]\nP = [3, 5]\n", "")
        .replace("[\"C\", \"P\"], C-B = 5", "[]");
    assert!(codes(&plain).contains(&"empty-link"));
    let cylinder = "[links]\nframe = { A = [0, 0], F = [3, 0] }\narm = { A-B = 2 }\n[drives]\nlift = { cylinder = \"F-B\", to = 2, speed = 1 }\n";
    assert_eq!(codes(cylinder), ["missing-key"]);
    let drawn = format!("[places]\nB = [0, 2]\n{cylinder}");
    let model = read(&drawn);
    assert!(matches!(model.drives[0].kind, DriveKind::Cylinder { .. }));
    let from = value(&model.drives[0].law.from, &model.parameter_values::<f64>());
    assert!((from - 13.0f64.sqrt()).abs() < 1e-15);
}

#[test]
fn a_session_may_not_turn_a_drawing_over() {
    let text = FILE.replace(
        "[\"B\", \"C\", \"P\"]",
        "{ points = [\"B\", \"C\", \"P\"], B-P = 47, C-P = 25 }",
    );
    let model = read(&text);
    let sound = |w: f64| model.unsound(&[w]).is_empty();
    assert!(sound(55.0) && sound(54.0));
    // with C far to the left the drawn point P lies on the other side of B -> C
    assert!(!sound(1.0));
}

#[test]
fn points_are_renamed_deleted_and_completed_in_lists() {
    let part = |name: &str| Part::new(PartKind::Point, name);
    let edits = rename(FILE, &part("C"), "Tip").unwrap();
    let renamed = apply(FILE, &edits).unwrap();
    let expected = FILE.replace("C = [", "Tip = [").replace("\"C\"", "\"Tip\"");
    assert_eq!(renamed, expected);
    let gone = apply(FILE, &delete(FILE, &part("P")).unwrap()).unwrap();
    assert_eq!(
        gone,
        FILE.replace("P = [30, \"42 m\"]\n", "")
            .replace(", \"P\"", "")
    );
    read(&gone);
    let labels = |text: &str| -> Vec<String> {
        let at = text.find('|').unwrap();
        let found = complete(&text.replace('|', ""), at);
        found.into_iter().map(|c| c.label).collect()
    };
    let more = |line: &str| FILE.replace("[drives]", &format!("{line}\n[drives]"));
    let all = ["A", "B", "C", "D", "P"];
    assert_eq!(labels(&more("extra = [\"A\", \"|\"]")), all);
    assert_eq!(labels(&more("extra = { points = [\"|\"] }")), all);
    assert!(labels(&more("extra = { p| }")).contains(&"points".to_owned()));
    let unplaced = FILE.replace("P = [30, \"42 m\"]\n", "|\n");
    assert_eq!(labels(&unplaced), ["P"]);
}

#[test]
fn hostile_drawings_end_soon() {
    let many = |n: usize, line: &dyn Fn(usize) -> String| (0..n).map(line).collect::<String>();
    let names = many(50_000, &|i| format!("\"P{i}\","));
    // all at one height, all at one place, at no place
    for place in [
        "[{i}, 0]",
        "[0, {i}]",
        "[1, 1]",
        "[\"1e300 m\", \"{i} m\"]",
        "[\"0 m\", \"{i} deg\"]",
        "[nan, inf]",
    ] {
        let places = many(50_000, &|i| {
            format!("P{i} = {}\n", place.replace("{i}", &i.to_string()))
        });
        let text =
            format!("[places]\n{places}[links]\nframe = {{ A = [0, 0] }}\nbig = [{names}]\n");
        assert!(!codes(&text).is_empty(), "{place}");
    }
    let nested = format!(
        "[places]\nA = [\"{}1{}\", 0]\n[links]\nframe = [\"A\"]\n",
        "(".repeat(60),
        ")".repeat(60)
    );
    assert_eq!(codes(&nested), [""; 0]);
    for list in [
        "[[\"A\"]]",
        "[\"A\", {}]",
        "[\"\"]",
        "[\"A-B\"]",
        "[true]",
        "{ points = [] }",
        "{ points = 5, A-B = 2 }",
        "[1979-05-27]",
    ] {
        let text = format!(
            "[places]\nA = [0, 0]\nB = [1, 0]\n[links]\nframe = [\"A\", \"B\"]\nl = {list}\n"
        );
        assert!(!codes(&text).is_empty(), "{list}");
    }
    for places in ["places = 5\n", "[[places]]\nA = 1\n", "places = [1]\n"] {
        let text = format!("{places}[links]\nframe = {{ A = [0, 0] }}\n");
        assert!(codes(&text).contains(&"wrong-type"), "{places}");
    }
}

#[test]
fn a_drive_may_end_where_it_is_drawn() {
    let to = |text: &str| {
        let model = read(text);
        let (_, high) = (model.drives[0].law).extent(&model.parameter_values());
        high
    };
    let drawn = to(&FILE.replace("speed", "from = 0, to = \"drawn\", speed"));
    assert!((drawn - kempe_number::math::atan2(4.0, 3.0)).abs() < 1e-15);
    let further = [
        "from = 0, to = \"drawn + 30 deg\", speed = 1",
        "from = 0, to = \"3 * drawn - 2 * (drawn - 15 deg)\", speed = 1",
        "from = 0, law = [{ to = \"drawn + 30 deg\", in = \"1 s\" }]",
    ];
    for law in further {
        let high = to(&FILE.replace("speed = 1", law));
        assert!((high - drawn - 30f64.to_radians()).abs() < 1e-14, "{law}");
    }
    let to_drawn = FILE.replace("speed = 1", "from = 0, law = [{ to = \"drawn\", in = 1 }]");
    assert!((to(&to_drawn) - drawn).abs() < 1e-15);
    for (wrong, code) in [
        ("drawn + 30 mm", "unit-mismatch"),
        ("drawn * drawn", "unit-mismatch"),
        ("drawnn + 30 deg", "unknown-name"),
        ("drawn * 2 / (drawn / drawn - 1)", "not-finite"),
    ] {
        let text = FILE.replace("speed", &format!("to = \"{wrong}\", speed"));
        assert!(codes(&text).contains(&code), "{wrong}: {:?}", codes(&text));
    }
    let held = FILE.replace("speed", "to = \"drawn\", speed");
    assert_eq!(codes(&held), ["no-motion"]);
    // a parameter of that name is meant instead
    let named = FILE.replace("w = \"55 m\"", "w = \"55 m\"\ndrawn = \"100 deg\"");
    let named = named.replace("speed", "to = \"drawn\", speed");
    assert!((to(&named) - 100f64.to_radians()).abs() < 1e-15);
}
