//! Hostile input: whatever the bytes, reading ends soon, in bounded memory, with a model or with diagnostics.
#![allow(clippy::unwrap_used)]

use std::fmt::Write as _;

use crate::mutants::{Chance, mutate};
use kempe_model::{Amount, Checked, Diagnostic, LoadKind, Model, set_value, value};

fn read(text: &str) -> Result<Checked, Vec<Diagnostic>> {
    Model::from_toml(text, "hostile", &mut |_| {
        Ok("t,angle\n0,0\n1,2\n".to_owned())
    })
}

fn refused(what: &str, text: &str, code: &str) {
    let found = match read(text) {
        Ok(checked) => checked.warnings,
        Err(found) => found,
    };
    assert!(
        found.iter().any(|d| d.code == code),
        "{what}: {:?}",
        found.iter().map(|d| d.code).collect::<Vec<_>>()
    );
    assert!(found.len() <= 300, "{what}: {} diagnostics", found.len());
    for d in found.iter().take(20) {
        assert!(
            d.render_plain("hostile", text).len() < 100_000,
            "{what}: {}",
            d.code
        );
    }
}

fn many(count: usize, mut line: impl FnMut(usize) -> String) -> String {
    let mut text = String::new();
    for i in 0..count {
        writeln!(text, "{}", line(i)).unwrap();
    }
    text
}

const FRAME: &str = "[links]\nframe = { A = [0, 0], D = [1, 0] }\ncrank = { A-B = 1 }\n";

#[test]
fn messages_are_short_whatever_a_table_holds() {
    let zeros = "\0".repeat(3_000_000);
    let text = FRAME.to_owned()
        + "[drives]\nmotor = { turns = \"crank\", law = { table = \"zeros.csv\" } }\n";
    let found = Model::from_toml(&text, "zeros", &mut |_| Ok(zeros.clone())).unwrap_err();
    for d in &found {
        let diagnostic = d.render_plain("zeros.toml", &text);
        assert!(
            diagnostic.len() < 2000 && !diagnostic.contains('\0'),
            "{} bytes",
            diagnostic.len()
        );
    }
    let found = Model::from_toml(&text, "large", &mut |_| Ok(" ".repeat(70 << 20))).unwrap_err();
    assert_eq!(found[0].code, "too-large");
}

#[test]
fn nesting() {
    refused(
        "arrays",
        &format!("a = {}{}", "[".repeat(1_000_000), "]".repeat(1_000_000)),
        "toml-syntax",
    );
    refused(
        "tables",
        &format!("a = {}{}", "{a=".repeat(300_000), "}".repeat(300_000)),
        "toml-syntax",
    );
    refused(
        "keys",
        &format!("[{}a]\n", "a.".repeat(500_000)),
        "toml-syntax",
    );
    refused(
        "header",
        &format!("{}\n", "[".repeat(1_000_000)),
        "toml-syntax",
    );
    refused(
        "brackets",
        &format!("[parameters]\na = \"{}1\"\n{FRAME}", "(".repeat(3_000)),
        "too-deep",
    );
    refused(
        "signs",
        &format!("[parameters]\na = \"{}1\"\n{FRAME}", "-".repeat(3_000)),
        "too-deep",
    );
}

#[test]
fn sheer_size() {
    refused("bytes", &"#".repeat(9 << 20), "too-large");
    refused(
        "links",
        &format!(
            "{FRAME}{}",
            many(300_000, |i| format!("l{i} = {{ A-B = 1 }}"))
        ),
        "too-large",
    );
    refused(
        "links by header",
        &format!("{FRAME}{}", many(1_000_000, |i| format!("[a{i}]"))),
        "too-large",
    );
    let points = many(200_000, |i| format!("P{i} = [{i}, 1]"));
    refused("points", &format!("[links.frame]\n{points}"), "too-large");
    refused(
        "joints",
        &format!(
            "{FRAME}[joints]\n{}",
            many(50_000, |i| format!(
                "j{i} = {{ pin = \"B\", on = \"A -> D\" }}"
            ))
        ),
        "too-large",
    );
    refused(
        "drives",
        &format!(
            "{FRAME}[drives]\n{}",
            many(50_000, |i| format!("j{i} = {{ turns = \"crank\" }}"))
        ),
        "too-large",
    );
    refused(
        "measures",
        &format!(
            "{FRAME}[measures]\n{}",
            many(200_000, |i| format!("m{i} = \"m{} + x(A)\"", i + 1))
        ),
        "too-large",
    );
    for (section, line) in [
        ("loads", "{ force = [0, 1], at = \"B\" }"),
        ("masses", "{ at = \"B\", mass = 1 }"),
        ("springs", "{ between = \"B-D\", stiffness = 1, free = 1 }"),
        ("dampers", "{ between = \"B-D\", damping = 1 }"),
        ("cylinders", "{ bore = 2, rod = 1 }"),
        ("motors", "{ curve = [[0, 1], [1, 0]] }"),
        ("friction", "{ coefficient = 1 }"),
        ("switches", "{ on = \"x(B) >= 0\" }"),
    ] {
        let text = format!(
            "{FRAME}[{section}]\n{}",
            many(120_000, |i| format!("s{i} = {line}"))
        );
        refused(section, &text, "too-large");
    }
    let pairs = (0..100_000).map(|i| format!("[{i}, 1]"));
    let curve = pairs.collect::<Vec<_>>().join(", ");
    refused(
        "a curve",
        &format!(
            "{FRAME}[drives]\nm = {{ turns = \"crank\" }}\n[motors]\nm = {{ curve = [{curve}] }}\n"
        ),
        "too-large",
    );
    refused(
        "unknown keys",
        &format!("{FRAME}{}", many(300_000, |i| format!("[k{i}]"))),
        "unknown-key",
    );
    refused(
        "syntax errors",
        &format!("{FRAME}{}", "= = =\n".repeat(500_000)),
        "toml-syntax",
    );
    refused(
        "names",
        &format!("{FRAME}[measures]\na = \"{}\"\n", "x".repeat(4_000)),
        "unknown-name",
    );
}

#[test]
fn long_chains() {
    let parameters = many(60_000, |i| format!("p{i} = \"p{} + 1\"", i + 1));
    refused(
        "parameters that lead to nothing",
        &format!("[parameters]\n{parameters}{FRAME}"),
        "unknown-name",
    );
    let circle = many(60_000, |i| format!("p{i} = \"p{} + 1\"", (i + 1) % 60_000));
    refused(
        "a circle of parameters",
        &format!("[parameters]\n{circle}{FRAME}"),
        "cyclic-parameter",
    );
    // a chain of triangles, written backwards: each waits for the next
    let n = 20_000;
    let strip = many(n, |i| {
        let k = n - i;
        format!(
            "P{} = \"left of P{} -> P{k}\"\nP{}-P{} = 1\nP{k}-P{} = 1",
            k + 1,
            k - 1,
            k - 1,
            k + 1,
            k + 1
        )
    });
    let text = format!("{FRAME}[links.strip]\nP0-P1 = 1\n{strip}loose = 1\n");
    refused("a strip of triangles", &text, "unknown-key");
    let star = many(9_000, |i| format!("l{i} = {{ A-B = 1 }}"));
    let joints = many(9_000, |i| {
        format!("j{i} = {{ slider = \"l{i}\", at = \"B\", on = \"A -> B\" }}")
    });
    refused(
        "a star",
        &format!("{FRAME}{star}[joints]\n{joints}[measures]\na = \"transmission_angle(A)\""),
        "ambiguous-transmission",
    );
}

#[test]
fn numbers() {
    refused(
        "overflow",
        &format!("{FRAME}[parameters]\na = \"1e308*10\"\n"),
        "not-finite",
    );
    refused(
        "infinite",
        &FRAME.replace("A-B = 1", "A-B = inf"),
        "not-finite",
    );
    refused("nan", &FRAME.replace("[1, 0]", "[nan, 0]"), "not-finite");
    refused(
        "huge integers",
        &FRAME.replace("A-B = 1", &format!("A-B = 1{}", "0".repeat(400))),
        "not-finite",
    );
    refused(
        "a motion that never ends",
        &format!(
            "{FRAME}[drives]\nm = {{ turns = \"crank\", speed = \"1e-308 rad/s\", to = 1e3 }}\n"
        ),
        "out-of-range",
    );
    for (what, body, code) in [
        (
            "mass",
            "[masses]\nm = { at = \"B\", mass = -1 }",
            "bad-size",
        ),
        (
            "load",
            "[loads]\nm = { force = [nan, 1], at = \"B\" }",
            "not-finite",
        ),
        (
            "load of zero",
            "[loads]\nm = { force = [\"1 N/0\", 1], at = \"B\" }",
            "not-finite",
        ),
        (
            "spring",
            "[springs]\nm = { links = [\"frame\", \"crank\"], stiffness = 0, free = 0 }",
            "bad-size",
        ),
        (
            "stops",
            "[springs]\nm = { links = [\"frame\", \"crank\"], stiffness = 1, free = 0, stops = [1e999, -1] }",
            "not-finite",
        ),
    ] {
        refused(what, &format!("{FRAME}{body}\n"), code);
    }
    refused("zero", &FRAME.replace("A-B = 1", "A-B = 0"), "bad-size");
    refused(
        "negative",
        &FRAME.replace("A-B = 1", "A-B = -1"),
        "bad-size",
    );
    refused(
        "step",
        &format!(
            "{FRAME}[drives]\nm = {{ turns = \"crank\", speed = 1, to = 1e29 }}\n[studies.a]\nkind = \"motion\"\nstep = 1e-29\n"
        ),
        "too-large",
    );
}

#[test]
fn bytes_that_are_no_text() {
    let mut files = |_: &str| Err(String::new());
    let found = Model::from_bytes(b"title = \"\xff\xfe\"", "x", &mut files, &[]).unwrap_err();
    assert_eq!(
        (found[0].code, found[0].labels[0].span.start),
        ("not-utf8", 9)
    );
    let found = Model::from_bytes(b"\xef\xbb\xbf\0\0", "x", &mut files, &[]).unwrap_err();
    assert!(!found.is_empty());
}

/// What acts is sound: finite values, tables that rise, names that are there.
fn acting(model: &Model, values: &[f64]) {
    let acts = &model.actions;
    let finite = |scalar: &kempe_model::Scalar| assert!(value(scalar, values).is_finite());
    for inertia in model.links.iter().filter_map(|l| l.inertia.as_ref()) {
        inertia.mass.iter().for_each(finite);
        inertia.moment.iter().for_each(finite);
    }
    acts.gravity.iter().flatten().for_each(finite);
    acts.masses.iter().for_each(|m| finite(&m.mass));
    for spring in &acts.springs {
        finite(&spring.stiffness);
        finite(&spring.free);
        spring.stops.iter().flatten().for_each(finite);
    }
    for cylinder in &acts.cylinders {
        assert!(value(&cylinder.rod, values) < value(&cylinder.bore, values));
    }
    for load in &acts.loads {
        let amounts = match &load.kind {
            LoadKind::Force { components, .. } => components.to_vec(),
            LoadKind::Torque { amount, .. } => vec![amount.clone()],
        };
        for amount in amounts {
            match amount {
                Amount::Measure(measure) => assert!(!model.needs_forces(&measure)),
                Amount::Table { at, values, .. } => {
                    assert!(at.len() == values.len() && at.windows(2).all(|w| w[0] < w[1]));
                }
            }
        }
    }
}

#[test]
fn mutants_of_real_files_do_no_harm() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests");
    let mut seeds: Vec<(std::path::PathBuf, Vec<u8>)> = ["good", "bad"]
        .iter()
        .flat_map(|f| std::fs::read_dir(format!("{folder}/{f}")).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .map(|path| (path.clone(), std::fs::read(&path).unwrap()))
        .collect();
    seeds.sort();
    // the good ones more often: their mutants get further
    let good: Vec<_> = seeds
        .iter()
        .filter(|(path, _)| path.parent().is_some_and(|p| p.ends_with("good")))
        .cloned()
        .collect();
    seeds.extend((0..10).flat_map(|_| good.clone()));
    let mut chance = Chance::new();
    let mut read_well = 0;
    for round in 0..8_000 {
        let mut text = seeds[round % seeds.len()].1.clone();
        mutate(&mut text, &mut chance);
        let files =
            &mut |_: &str| Ok(String::from_utf8_lossy(&seeds[round % seeds.len()].1).into_owned());
        let overrides = [("a".to_owned(), "25 mm".to_owned())];
        let given = if round % 5 == 0 { &overrides[..] } else { &[] };
        match Model::from_bytes(&text, "mutant", files, given) {
            Ok(checked) => {
                read_well += 1;
                let values: Vec<f64> = checked.model.parameter_values();
                for link in &checked.model.links {
                    assert_eq!(link.evaluate(&values).len(), link.points.len());
                }
                acting(&checked.model, &values);
                for drive in &checked.model.drives {
                    let end: f64 = drive.law.duration(&values);
                    assert!(
                        end.is_finite() && drive.law.at(end / 2.0, &values).is_finite(),
                        "drive `{}` lasts {end} s:\n{}",
                        drive.name,
                        String::from_utf8_lossy(&text)
                    );
                }
            }
            Err(found) => {
                assert!(!found.is_empty());
                let text = String::from_utf8_lossy(&text);
                for d in &found {
                    let _ = d.render_plain("mutant", &text);
                    for label in d
                        .labels
                        .iter()
                        .filter(|l| l.source.is_none() && d.code != "not-utf8")
                    {
                        assert!(text.get(label.span.clone()).is_some(), "{d:?}");
                    }
                }
            }
        }
        if let Ok(text) = std::str::from_utf8(&text) {
            let _ = set_value(text, &["parameters", "a"], "\"1 mm\"");
            let _ = set_value(text, &["links", "crank", "A-B"], "3");
        }
    }
    assert!(
        read_well > 60,
        "the mutants are too wild to test much: {read_well}"
    );
}
