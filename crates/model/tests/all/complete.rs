//! Names are completed while somebody types.
#![allow(clippy::unwrap_used)]

use kempe_model::language::visit_keys;
use kempe_model::{Completion, CompletionKind, Model, PartKind, STARTERS, apply, complete};
use proptest::prelude::*;

/// A model with a line still to be typed: `|` stands for the cursor.
fn at(rest: &str) -> Vec<Completion> {
    let file = "units = { length = \"mm\" }\n[parameters]\na = \"20 mm\"\n[links]\nframe = { A = [0, 0], D = [60, 0] }\ncrank = { A-B = \"a\" }\nrod = { B-C = 50, P = [1, 2] }\n[joints]\nbore = { slider = \"rod\", at = \"C\", on = \"A -> D\" }\n[drives]\nmotor = { turns = \"crank\", speed = \"1 rad/s\" }\n[springs]\nback = { between = \"D-P\", stiffness = 1, free = 1 }\n[measures]\nlift = \"y(C)\"\n";
    let text = format!("{file}{}", rest.replace('|', ""));
    let offset = file.len() + rest.find('|').unwrap();
    let found = complete(&text, offset);
    for one in &found {
        // every edit fits and enters what is offered
        let edited = apply(&text, std::slice::from_ref(&one.edit)).unwrap();
        assert!(edited.contains(&one.edit.text));
    }
    found
}

fn labels(rest: &str) -> Vec<String> {
    at(rest).into_iter().map(|c| c.label).collect()
}

#[test]
fn sections_and_keys() {
    assert!(labels("[dam|").contains(&"dampers".to_owned()));
    assert!(!labels("[dam|").contains(&"title".to_owned()));
    assert_eq!(labels("[studies.t|"), [""; 0]);
    let file = complete("|", 0);
    assert!(
        file.iter()
            .any(|c| c.label == "links" && c.edit.text == "[links]")
    );
    assert!(
        file.iter()
            .any(|c| c.label == "gravity" && c.edit.text == "gravity = ")
    );
    assert_eq!(labels("[cylinders]\n|"), ["motor"]);
    assert_eq!(
        labels("[assembly]\n|"),
        ["frame", "A", "D", "crank", "B", "rod", "C", "P"]
    );
    assert_eq!(labels("[friction]\n|").last().unwrap(), "all");
}

#[test]
fn keys_of_the_kind_that_are_not_there_yet() {
    let keys = labels("[joints]\nx = { weld = [\"a\", \"b\"], | }");
    assert_eq!(keys, ["at", "angle"]);
    assert_eq!(
        labels("[joints]\nx = { rack = \"rod\", pin|"),
        [
            "pinion",
            "center",
            "radius",
            "side",
            "offset",
            "pressure_angle",
            "module"
        ]
    );
    assert!(labels("[joints]\nx = { | ").contains(&"gears".to_owned()));
    assert_eq!(
        labels("[drives.m]\nturns = \"crank\"\nfrom = 1\n|\n[links]"),
        [
            "relative_to",
            "to",
            "speed",
            "acceleration",
            "law",
            "in",
            "at"
        ]
    );
    assert_eq!(
        labels("[drives]\nm = { turns = \"crank\", law = [ { dwell = 1 }, { rise = 3, | } ] }"),
        ["in", "by", "speed", "acceleration"]
    );
    assert_eq!(
        labels("[loads]\nx = { torque = { table = \"t.csv\", | } }"),
        ["over", "argument", "value", "factor", "period"]
    );
    assert_eq!(
        labels("[loads]\nx = { force = [0, 1], |"),
        ["at", "on", "axes"]
    );
    // a study by its word, friction by what it is at
    assert_eq!(
        labels("[studies.s]\nkind = \"balance\"\n|"),
        ["step", "rows", "goal", "on", "radius"]
    );
    assert_eq!(
        labels("[friction]\nB = { static = 0.2, | }"),
        [
            "coefficient",
            "stribeck",
            "viscous",
            "drag",
            "radius",
            "holder"
        ]
    );
    assert_eq!(
        labels("[friction]\nbore = { | }"),
        ["coefficient", "static", "stribeck", "viscous", "drag"]
    );
    let contact = [
        "law",
        "restitution",
        "stiffness",
        "modulus",
        "poisson",
        "spring",
        "damping",
        "friction",
        "stiction",
        "friction_speeds",
    ];
    let pin = [&["radial", "on", "holder", "radius"], contact.as_slice()].concat();
    assert_eq!(labels("[clearance]\nB = { | }"), pin);
    let block = [&["radial", "length", "height"], contact.as_slice()].concat();
    assert_eq!(labels("[clearance]\nbore = { | }"), block);
    assert_eq!(labels("[clearance]\n|").last().unwrap(), "all");
    // of points and links that a spring may act between, one
    assert!(!labels("[springs]\nx = { between = \"A-P\", | }").contains(&"links".to_owned()));
    // the frame's points and the keys of a link
    let link = labels("[links.x]\nA-E = 3\n|");
    assert!(link.contains(&"mass".to_owned()) && link.contains(&"A".to_owned()));
    assert_eq!(labels("[drives]\nm = { turns = | }"), [""; 0]);
    assert_eq!(labels("[drives]\nm = 3 # [|"), [""; 0]);
}

#[test]
fn names_as_keys_of_tables() {
    let file = "[parameters]\narm = 1\nshort = 2\n[links]\nframe = { A = [0, 0] }\nrocker = { A-B = \"arm\" }\n[drives]\nmotor = { turns = \"rocker\" }\n[measures]\nlift = \"y(B)\"\n";
    let labels = |rest: &str| -> Vec<String> {
        let text = format!("{file}{rest}");
        let found = complete(&text, text.len());
        for one in &found {
            let edited = apply(&text, std::slice::from_ref(&one.edit)).unwrap();
            let typed = rest.trim_end_matches(char::is_alphanumeric);
            assert_eq!(edited, format!("{file}{typed}{}", one.edit.text));
        }
        found.into_iter().map(|c| c.label).collect()
    };
    for rest in [
        "[studies.o]\nkind = \"optimize\"\nvary = { ar",
        "[studies.o]\nkind = \"adjust\"\nbounds = {\n  # between\n  ar",
        "[studies.o.vary]\nar",
        "[studies.o]\nvary.ar",
        "[studies]\no.vary.ar",
        "[studies]\no = { kind = \"sweep\", vary.ar",
    ] {
        assert_eq!(labels(rest), ["arm", "short"], "{rest}");
    }
    assert_eq!(labels("[studies.o]\nvary = { short = 1, ar"), ["arm"]);
    for rest in [
        "[studies.o]\nmatch = [{ mo",
        "[studies.o]\nmatch = [{ rocker = 1, motor = 2 }, { mo",
        "[studies.o]\nmatch = { columns = { ro",
        "[studies.o]\ndeviations = { r",
        "[studies.o]\nstops = { ro",
    ] {
        let mut found = labels(rest);
        found.sort();
        assert_eq!(found, ["frame", "lift", "motor", "rocker"], "{rest}");
    }
    assert_eq!(labels("[studies.o]\nstart = { mo"), ["A", "B", "motor"]);
    assert_eq!(labels("[studies.o]\nfit.timing = { mo"), ["motor"]);
    assert_eq!(labels("[cylinders.mo"), ["motor"]);
    assert_eq!(labels("[motors . mo"), ["motor"]);
    assert_eq!(labels("[friction.al"), ["A", "B", "all"]);
    assert_eq!(labels("[studies.mo"), [""; 0]);
    assert!(labels("[drives.motor]\nfr").contains(&"from".to_owned()));
    let place = labels("lost = \"at(y(B), motor, ar");
    assert_eq!(place[..2], ["arm", "short"]);
    assert!(place.contains(&"hypot".to_owned()) && !place.contains(&"lift".to_owned()));
}

#[test]
fn sections_and_keys_come_with_their_sentence() {
    let mut seen = 0;
    visit_keys(&mut |section, kind, key| {
        let found = match (section, kind.name) {
            ("cylinders", "oil") => at("[cylinders]\nmotor = { oil = { | } }"),
            ("", _) => complete("", 0),
            ("springs", _) => at("[springs]\nx = { | }"),
            ("cylinders", "cylinder") => at("[cylinders]\nmotor = { | }"),
            ("units", _) => complete("units = {  }", 10),
            ("joints", "gears") => at("[joints]\nx = { gears = [], |"),
            _ => return,
        };
        let one = found.iter().find(|c| c.label == key.name);
        assert_eq!(one.is_none(), key.name == "gears", "{}", key.name);
        assert!(one.is_none_or(|one| one.doc == key.about), "{}", key.name);
        seen += 1;
    });
    assert!(seen > 40, "{seen}");
    assert!(at("[dam|").iter().all(|c| !c.doc.is_empty()));
}

#[test]
fn names_where_names_are_wanted() {
    assert_eq!(
        labels("[drives]\nm = { turns = \"|\" }"),
        ["frame", "crank", "rod"]
    );
    assert_eq!(
        labels("[drives]\nm = { turns = \"cr|"),
        ["frame", "crank", "rod"]
    );
    assert_eq!(
        labels("[drives]\nm = { slides = \"|\" }"),
        ["frame", "crank", "rod", "bore"]
    );
    assert_eq!(
        labels("[joints]\nx = { slider = \"rod\", at = \"|\" }"),
        ["B", "C", "P"]
    );
    assert_eq!(
        labels("[joints]\nx = { pin = \"|"),
        ["A", "D", "B", "C", "P"]
    );
    assert_eq!(labels("[assembly]\nC = \"|"), ["left of", "right of"]);
    assert_eq!(
        labels("[assembly]\nC = \"left of B -> |\""),
        ["A", "D", "B", "C", "P"]
    );
    assert_eq!(
        labels("[studies.s]\nkind = \"|\""),
        [
            "motion",
            "forces",
            "balance",
            "spring",
            "simulate",
            "clearance",
            "vibrations",
            "adjust",
            "sweep",
            "tolerance",
            "optimize",
            "synthesize"
        ]
    );
    assert_eq!(
        labels("[studies.s]\nkind = \"clearance\"\nrates = \"|\""),
        ["frozen", "turning"]
    );
    assert_eq!(labels("[studies.s]\nspring = \"|\""), ["back"]);
    assert_eq!(
        labels("[springs]\nx = { acts = \"te|\" }"),
        ["both", "tension", "compression"]
    );
    assert_eq!(
        labels("[drives]\nm = { law = \"3-|\" }"),
        ["cycloidal", "harmonic", "3-4-5", "4-5-6-7"]
    );
    assert_eq!(
        labels("[springs]\nx = { stops = [1, \"no|\"] }")[..2],
        ["none", "a"]
    );
    assert_eq!(
        labels("[links]\nx = { center = \"|\" }"),
        ["centroid", "A", "D", "B", "C", "P"]
    );
    assert_eq!(labels("[assembly]\ncrank = \"|\""), [""; 0]);
    let law = at("[drives]\nm = { law = \"3-|\" }");
    assert_eq!(law[2].edit.text, "3-4-5");
    assert_eq!(law[2].edit.span.len(), 2);
    assert_eq!(complete("title = \"\"", 9), []);
    assert_eq!(complete("units = { length = \"\" }", 20)[0].label, "mm");
}

#[test]
fn expressions_know_what_has_a_value_there() {
    let scalar = labels("[links.x]\nA-E = \"2 * |\"");
    assert_eq!(scalar[0], "a");
    assert!(scalar.contains(&"hypot".to_owned()) && !scalar.contains(&"y".to_owned()));
    let units = at("[links.x]\nA-E = \"2 * a + 5 |\"");
    assert!(units.iter().all(|c| c.kind == CompletionKind::Unit) && units[0].label == "mm");
    assert_eq!(labels("[links.x]\nA-E = \"2|\""), [""; 0]);
    assert!(labels("[links.x]\nA-E = \"e2 |\"").contains(&"a".to_owned()));
    let measure = labels("[measures]\nx = \"2 * l|\"");
    for wanted in [
        "a",
        "motor",
        "lift",
        "time",
        "transmission_angle",
        "kinetic_energy",
        "sqrt",
        "pi",
    ] {
        assert!(measure.contains(&wanted.to_owned()), "{wanted}");
    }
    assert!(!measure.contains(&"crank".to_owned()));
    assert_eq!(
        labels("[measures]\nx = \"angle(|\""),
        ["frame", "A", "D", "crank", "B", "rod", "C", "P"]
    );
    assert_eq!(
        labels("[measures]\nx = \"angle(A -> |"),
        ["A", "D", "B", "C", "P"]
    );
    assert_eq!(
        labels("[measures]\nx = \"x(C, |)\""),
        ["frame", "crank", "rod"]
    );
    assert_eq!(labels("[measures]\nx = \"spring_force(|)\""), ["back"]);
    assert_eq!(labels("[measures]\nx = \"d(y(C) + max(1, 2), |"), ["motor"]);
    assert!(labels("[measures]\nx = \"rate(|").contains(&"lift".to_owned()));
    assert!(labels("[studies.s]\ncolumns = [\"lift\", \"|\"]").contains(&"speed".to_owned()));
    assert_eq!(
        labels("[studies.s]\nplot = [\"path(|\"]"),
        ["frame", "A", "D", "crank", "B", "rod", "C", "P", "bore"]
    );
    let inserted = at("[measures]\nx = \"2 * spe|\"");
    let speed = inserted.iter().find(|c| c.label == "speed").unwrap();
    assert_eq!(
        (speed.edit.text.as_str(), speed.edit.span.len()),
        ("speed(", 3)
    );
    assert!(!speed.doc.is_empty());
}

#[test]
fn parts_are_known_of_lines_that_are_not_toml() {
    let text = "[links]\nframe = { A = [0, 0], D = [1, 0 }\ncrank = { A-B = \nrod = { B-C = 5 }\n[measures]\nx = \"x(";
    let partial = Model::partial(text, "x", &mut |_| Err(String::new()));
    assert!(partial.model.is_none() && !partial.diagnostics.is_empty());
    let names = |kind| -> Vec<&str> {
        let parts = partial.parts.iter().filter(|(p, _)| p.kind == kind);
        parts.map(|(p, _)| p.name.as_str()).collect()
    };
    assert_eq!(names(PartKind::Link), ["frame", "crank", "rod"]);
    assert_eq!(names(PartKind::Point), ["A", "D", "B", "C"]);
    let completed: Vec<String> = complete(text, text.len())
        .into_iter()
        .map(|c| c.label)
        .collect();
    assert_eq!(completed, ["A", "D", "B", "C"]);
    let whole = Model::partial(STARTERS[0].text, "x", &mut |_| Err(String::new()));
    assert!(whole.model.is_some() && whole.diagnostics.is_empty());
}

proptest! {
    #[test]
    fn every_prefix_of_a_file_completes(starter in 0..STARTERS.len(), cut in 0usize..3000, crlf: bool) {
        let text = STARTERS[starter].text;
        let text = if crlf { text.replace('\n', "\r\n") } else { text.to_owned() };
        let cut = text.floor_char_boundary(cut.min(text.len()));
        let typed = &text[..cut];
        for one in complete(typed, cut) {
            prop_assert!(apply(typed, std::slice::from_ref(&one.edit)).is_ok());
            prop_assert!(one.edit.span.start <= cut && cut <= one.edit.span.end);
        }
        // what comes behind the cursor does not matter to where it is
        for one in complete(&text, cut) {
            prop_assert!(apply(&text, std::slice::from_ref(&one.edit)).is_ok());
        }
    }
}
