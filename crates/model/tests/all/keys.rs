//! The table of keys against the reader: every key is read, every example is understood.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;

use kempe_model::language::{Key, Kind, Need, help, visit_keys};
use kempe_model::{Diagnostic, Model};

/// Everything that the examples of the table name.
const FILE: &str = r#"
[parameters]
a = "1 mm"
[links]
frame   = { A = [0, 0], D = [60, 0], O = [0, -50], P = [9, -50], E = [0, -90], F = [99, -90], Z = [0, 99], V = [40, 99], R = [0, 200] }
crank   = { A-B = 20 }
coupler = { B-C = 50 }
rocker  = { D-C = 40 }
piston  = { Q = [0, 0] }
lever   = { Z-Y = 10 }
leg     = { R-S = 10 }
foot    = { S-T = 10 }
sun     = { Z-U = 10 }
wheel   = { V-W = 10 }
bar     = { G = [0, 0] }
[joints]
guide = { slider = "piston", at = "Q", on = "E -> F" }
[drives]
motor = { turns = "crank", speed = 1 }
lift  = { cylinder = "Y-T", from = 1, to = 2, speed = 1 }
[springs]
back = { between = "A-C", stiffness = 1, free = 1 }
[switches]
top = { on = "y(C) <= 1 m" }
"#;

/// An entry of a kind that reads, but for what is asked of it.
fn entry(section: &str, kind: &Kind) -> (&'static str, Vec<(&'static str, &'static str)>) {
    match (section, kind.name) {
        ("joints", "slider") => (
            "j",
            vec![("slider", "'bar'"), ("at", "'G'"), ("on", "'O -> P'")],
        ),
        ("joints", "pin") => ("j", vec![("pin", "'Y'"), ("on", "'O -> P'")]),
        ("joints", "weld") => ("j", vec![("weld", "['leg', 'foot']")]),
        ("joints", "gears") => (
            "j",
            vec![("gears", "['sun', 'wheel']"), ("teeth", "[20, 40]")],
        ),
        ("joints", "belt") => ("j", vec![("belt", "['sun', 'wheel']"), ("radii", "[1, 2]")]),
        ("joints", _) => (
            "j",
            vec![("rack", "'bar'"), ("pinion", "'wheel'"), ("radius", "60")],
        ),
        ("links", _) => ("l", vec![("A-B", "20")]),
        ("drives", "turns") => ("d", vec![("turns", "'rocker'")]),
        ("drives", "cylinder") => ("d", vec![("cylinder", "'A-T'"), ("from", "1")]),
        ("drives", _) => ("d", vec![("slides", "'piston'")]),
        ("loads", "force") => ("x", vec![("force", "[0, 1]"), ("at", "'C'")]),
        ("loads", _) => ("x", vec![("torque", "1"), ("on", "'crank'")]),
        ("masses", _) => (
            "x",
            vec![("on", "'crank'"), ("at", "[0, 1]"), ("mass", "1")],
        ),
        ("springs", _) => (
            "s",
            vec![("between", "'A-C'"), ("stiffness", "1"), ("free", "1")],
        ),
        ("dampers", _) => ("s", vec![("between", "'A-C'"), ("damping", "1")]),
        ("friction", "pin") => ("B", vec![("coefficient", "0.1"), ("radius", "1")]),
        ("friction", "joint") => ("guide", vec![("coefficient", "0.1")]),
        ("friction", _) => ("all", vec![("coefficient", "0.1"), ("radius", "1")]),
        ("clearance", "pin") => ("B", vec![("radial", "0.1")]),
        ("clearance", "joint") => ("guide", vec![("radial", "0.1")]),
        ("clearance", _) => ("all", vec![("radial", "0.1")]),
        ("cylinders", _) => ("lift", vec![("bore", "2"), ("rod", "1"), ("supply", "3")]),
        ("switches", _) => ("s", vec![("on", "'y(C) <= 1 m'")]),
        ("motors", _) => ("motor", vec![("curve", "[[0, 1], [1, 0]]")]),
        ("studies", "motion") => ("x", vec![("kind", "'motion'")]),
        ("studies", "forces") => ("x", vec![("kind", "'forces'")]),
        ("studies", "balance") => (
            "x",
            vec![("kind", "'balance'"), ("on", "['crank']"), ("radius", "1")],
        ),
        ("studies", "clearance") => ("x", vec![("kind", "'clearance'")]),
        ("studies", "simulate") => ("x", vec![("kind", "'simulate'"), ("until", "1")]),
        ("studies", "vibrations") => ("x", vec![("kind", "'vibrations'"), ("release", "['lift']")]),
        ("studies", "adjust") => {
            let base = vec![
                ("kind", "'adjust'"),
                ("unknown", "['a']"),
                ("match", "[{ motor = 1, rocker = 1 }]"),
            ];
            ("x", base)
        }
        ("studies", "sweep") => ("x", vec![("kind", "'sweep'"), ("vary", "{ a = ['1 mm'] }")]),
        ("studies", "tolerance") => (
            "x",
            vec![("kind", "'tolerance'"), ("vary", "{ a = '1 mm' }")],
        ),
        ("studies", "optimize") => (
            "x",
            vec![
                ("kind", "'optimize'"),
                ("vary", "{ a = ['0.5 mm', '2 mm'] }"),
                ("minimize", "'max(x(C))'"),
            ],
        ),
        ("studies", "synthesize path") => {
            let base = vec![
                ("kind", "'synthesize'"),
                ("task", "'path'"),
                ("points", "[[0, 0], [10, 8], [25, 12]]"),
            ];
            ("x", base)
        }
        ("studies", "synthesize function") => {
            let base = vec![
                ("kind", "'synthesize'"),
                ("task", "'function'"),
                ("pairs", "[[1, 2], [2, 3], [4, 4]]"),
            ];
            ("x", base)
        }
        ("studies", "synthesize rates") => {
            let base = vec![
                ("kind", "'synthesize'"),
                ("task", "'rates'"),
                ("speeds", "[1, 2, 3]"),
                ("accelerations", "[1, 0, 3]"),
            ];
            ("x", base)
        }
        ("studies", "synthesize dead-centres") => {
            let base = vec![
                ("kind", "'synthesize'"),
                ("task", "'dead-centres'"),
                ("swing", "60"),
            ];
            ("x", base)
        }
        ("studies", "synthesize dwell") => {
            let base = vec![
                ("kind", "'synthesize'"),
                ("task", "'dwell'"),
                ("point", "'B'"),
                ("dwell", "100"),
                ("drive", "'motor'"),
            ];
            ("x", base)
        }
        ("studies", "synthesize cognates") => {
            let base = vec![
                ("kind", "'synthesize'"),
                ("task", "'cognates'"),
                ("point", "'B'"),
                ("drive", "'motor'"),
            ];
            ("x", base)
        }
        ("studies", "synthesize motion") => {
            let base = vec![
                ("kind", "'synthesize'"),
                ("task", "'motion'"),
                ("poses", "[[0, 0, 0], [12, 6, 20], [20, 18, 55]]"),
            ];
            ("x", base)
        }
        ("studies", _) => (
            "x",
            vec![
                ("kind", "'spring'"),
                ("spring", "'back'"),
                ("drive", "'motor'"),
            ],
        ),
        (section, kind) => panic!("[{section}] {kind}"),
    }
}

/// A study of many designs in which one parameter has such values.
fn of_designs(kind: &str, values: &str) -> String {
    let goal = match kind {
        "optimize" => "minimize = 'max(x(C))', ",
        _ => "",
    };
    format!("{{ kind = '{kind}', {goal}vary = {{ a = {values} }} }}")
}

/// A study that fits something.
fn of_fit(fit: &str) -> String {
    let vary = "vary = { a = ['0.5 mm', '2 mm'] }";
    format!("{{ kind = 'optimize', {vary}, fit = {fit} }}")
}

/// A file in which a key of a kind has a value, what else its entry needs being there.
fn with(section: &str, kind: &Kind, key: &str, value: &str) -> String {
    let inner = |needed: &[(&str, &str)]| {
        let mut all: Vec<String> = needed
            .iter()
            .filter(|(k, _)| *k != key)
            .map(|(k, v)| format!("{k} = {v}"))
            .collect();
        all.push(format!("{key} = {value}"));
        format!("{{ {} }}", all.join(", "))
    };
    let (name, table) = match kind.what {
        "units" => return format!("units = {}\n{FILE}", inner(&[])),
        "bar" => ("l", format!("{{ A-B = 1, bar = {} }}", inner(&[]))),
        "hint" => ("C", inner(&[])),
        "piece" => {
            let end: &[(&str, &str)] = if ["rise", "fall", "to", "dwell"].contains(&key) {
                &[("in", "1")]
            } else {
                &[("rise", "1")]
            };
            let end = if key == "dwell" { &[] } else { end };
            (
                "d",
                format!("{{ turns = 'rocker', law = [{}] }}", inner(end)),
            )
        }
        "stop" => (
            "x",
            format!(
                "{{ kind = 'simulate', until = 1, stops = {{ rocker = {} }} }}",
                inner(&[("between", "[0, 9]")])
            ),
        ),
        "function" => {
            let curve = inner(&[
                ("y", "'x'"),
                ("x", "[1, 2]"),
                ("input", "[0, 1]"),
                ("output", "[0, 1]"),
            ]);
            (
                "x",
                format!("{{ kind = 'synthesize', task = 'function', function = {curve} }}"),
            )
        }
        "measured table" => {
            let table = inner(&[("table", "'t.csv'")]);
            (
                "x",
                format!("{{ kind = 'adjust', unknown = ['a'], match = {table} }}"),
            )
        }
        "swept values" => ("x", of_designs("sweep", &inner(&[]))),
        "spread" => ("x", of_designs("tolerance", &inner(&[]))),
        "choice" => {
            let needed: &[(&str, &str)] = match key {
                "step" => &[("between", "['1 mm', '2 mm']")],
                _ => &[],
            };
            ("x", of_designs("optimize", &inner(needed)))
        }
        "fit" => {
            let of_link = ["link", "at", "radius"].contains(&key);
            let needed: &[(&str, &str)] = match of_link {
                true => &[
                    ("link", "'rocker'"),
                    ("at", "'C'"),
                    ("radius", "1"),
                    ("to", "[[1, 2, 3], [3, 4, 5]]"),
                ],
                false => &[("point", "'C'"), ("to", "[[1, 2], [3, 4], [5, 4]]")],
            };
            ("x", of_fit(&inner(needed)))
        }
        "place table" => {
            let to = inner(&[("table", "'t.csv'")]);
            let traced = match key {
                "angle" => "link = 'rocker', at = 'C', radius = 1",
                _ => "point = 'C'",
            };
            ("x", of_fit(&format!("{{ {traced}, to = {to} }}")))
        }
        "point table" => {
            let table = inner(&[("table", "'t.csv'")]);
            (
                "x",
                format!("{{ kind = 'synthesize', task = 'path', points = {table} }}"),
            )
        }
        // Only a slider has a stroke.
        _ if kind.name == "synthesize dwell" && key == "stroke" => {
            let (name, mut needed) = entry(section, kind);
            needed.push(("output", "'slider'"));
            (name, inner(&needed))
        }
        "dyad" => {
            let dyad = inner(&[]);
            let poses = "[[0, 0, 0], [12, 6, 20], [20, 18, 55]]";
            (
                "x",
                format!(
                    "{{ kind = 'synthesize', task = 'motion', poses = {poses}, rocker = {dyad} }}"
                ),
            )
        }
        "oil of" => {
            let stroke: &[(&str, &str)] = match key {
                "closed" | "wall_modulus" => &[("stroke", "1"), ("closed", "1")],
                "stroke" => &[("closed", "1")],
                _ => &[],
            };
            let needed = [
                ("bulk_modulus", "1"),
                ("volume", "[1, 1]"),
                ("valve", "1"),
                ("flow", "1"),
                ("drop", "1"),
            ];
            let oil = inner(&[&needed[..], stroke].concat());
            (
                "lift",
                format!("{{ bore = 2, rod = 1, supply = 3, oil = {oil} }}"),
            )
        }
        "law table" => (
            "d",
            format!(
                "{{ turns = 'rocker', law = {} }}",
                inner(&[("table", "'t.csv'")])
            ),
        ),
        "load table" => {
            let table = inner(&[("table", "'t.csv'"), ("over", "'angle(crank)'")]);
            match section {
                "cylinders" => (
                    "lift",
                    format!(
                        "{{ bore = 2, rod = 1, supply = 3, oil = {{ bulk_modulus = 1, volume = [1, 1], flow = 1, drop = 1, \
                         valve = {table} }} }}"
                    ),
                ),
                "motors" => (
                    "motor",
                    format!("{{ curve = [[0, 1], [1, 0]], throttle = {table} }}"),
                ),
                _ => ("x", format!("{{ torque = {table}, on = 'crank' }}")),
            }
        }
        _ => {
            let (name, needed) = entry(section, kind);
            (name, inner(&needed))
        }
    };
    let line = format!("{name} = {table}\n");
    let head = format!("[{section}]\n");
    match FILE.contains(&head) {
        true => FILE.replace(&head, &format!("{head}{line}")),
        false => format!("{FILE}{head}{line}"),
    }
}

fn said(text: &str) -> Vec<Diagnostic> {
    let mut files = |_: &str| Ok("t,value\n0,0\n1,1\n".to_owned());
    match Model::from_toml(text, "x", &mut files) {
        Ok(checked) => checked.warnings,
        Err(found) => found,
    }
}

/// A date is nothing that any key takes: where it stands the reader must have looked.
#[test]
fn the_reader_looks_at_every_key() {
    const DATE: &str = "1979-05-27";
    let mut count = 0;
    visit_keys(&mut |section, kind, key| {
        let text = match section {
            "" => format!(
                "{} = {DATE}\n{}",
                key.name,
                FILE.replace(&format!("[{}]", key.name), "[nothing]")
            ),
            _ => with(section, kind, key.name, DATE),
        };
        let at = text.find(DATE).unwrap();
        let found = said(&text);
        let looked = |d: &Diagnostic| {
            d.code != "unknown-key"
                && d.labels.iter().any(|l| {
                    l.primary
                        && (l.span.start == at
                            || text[..at].ends_with(&format!("{} = ", &text[l.span.clone()])))
                })
        };
        assert!(
            found.iter().any(looked),
            "[{section}] {} {}: {found:#?}",
            kind.what,
            key.name
        );
        count += 1;
    });
    assert!(count > 150, "{count}");
}

/// The reader takes the example of every key for a value of its kind, whatever else it finds wrong with it.
#[test]
fn the_reader_understands_every_example() {
    visit_keys(&mut |section, kind, key| {
        // every kind of study has its own word behind `kind`
        if key.name == "kind" {
            return;
        }
        if section.is_empty() {
            return;
        }
        let text = with(section, kind, key.name, key.example);
        let wrong = [
            "wrong-type",
            "unit-mismatch",
            "unknown-key",
            "bad-choice",
            "bad-law",
            "bad-line",
            "bad-side",
            "not-toml",
            "wrong-arguments",
        ];
        let found: Vec<Diagnostic> = said(&text)
            .into_iter()
            .filter(|d| wrong.contains(&d.code))
            .collect();
        assert!(
            found.is_empty(),
            "[{section}] {} {}: {found:#?}",
            kind.what,
            key.name
        );
    });
}

/// What the table says must be there is missed where it is not.
#[test]
fn the_reader_misses_what_must_be_there() {
    visit_keys(&mut |section, kind: &Kind, key: &'static Key| {
        if section.is_empty() || key.need != Need::Required {
            return;
        }
        // without the key that makes it one it is no joint or drive, and no spring of a study's kind
        let text = with(section, kind, key.name, "1")
            .replace(&format!(", {} = 1", key.name), "")
            .replace(&format!("{} = 1", key.name), "");
        let missed = |d: &Diagnostic| d.code == "missing-key";
        assert!(
            said(&text).iter().any(missed),
            "[{section}] {} {}\n{text}",
            kind.what,
            key.name
        );
    });
}

#[test]
fn kinds_have_no_key_twice_and_rows_are_whole() {
    visit_keys(&mut |section, kind, key| {
        let names: Vec<&str> = kind.keys().map(|key| key.name).collect();
        let once: BTreeSet<&str> = names.iter().copied().collect();
        assert_eq!(names.len(), once.len(), "{}", kind.name);
        assert!(key.about.ends_with('.'), "{}", key.name);
        assert!(!key.example.is_empty(), "{}", key.name);
        assert!(
            help(key.name).unwrap().contains(key.about),
            "[{section}] {}",
            key.name
        );
    });
}

#[test]
fn help_tells_of_a_key_in_every_place() {
    let text = help("stiffness").unwrap();
    for part in [
        "[springs]",
        "[studies]",
        "a stiffness",
        "needed",
        "such as stiffness = \"2 N/mm\"",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert!(help("springs").unwrap().contains("Springs."));
    assert!(
        help("rack")
            .unwrap()
            .contains("its keys: rack, pinion, center")
    );
    assert!(help("between").unwrap().contains("one of between, links"));
    assert!(help("").is_none());
}
