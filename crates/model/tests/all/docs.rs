//! The pages people learn the language from: every ```toml block of `docs/language.md` and `README.md` reads without a word.
//!
//! A plain block is a whole file. A `fragment` is merged into the page's `base`: a line whose name its section already has
//! stands in its place. A `wrong` block gives the diagnostics that the ```text block after it shows. ```csv blocks are the
//! files beside the models, by name.
#![allow(clippy::unwrap_used)]

use std::collections::{BTreeMap, BTreeSet};

use kempe_model::language::{Takes, visit_keys};
use kempe_model::{Diagnostic, Model, Registry, Severity};
use kempe_units::{Builtin, Unit};

/// A fenced block: its language, the words behind that, its text and the line on which it starts.
struct Block {
    language: String,
    about: String,
    text: String,
    line: usize,
}

fn blocks(page: &str) -> Vec<Block> {
    let mut found: Vec<Block> = Vec::new();
    let mut open = false;
    for (number, line) in page.lines().enumerate() {
        if let Some(head) = line.strip_prefix("```") {
            if !open {
                let (language, about) = head.split_once(' ').unwrap_or((head, ""));
                found.push(Block {
                    language: language.to_owned(),
                    about: about.trim().to_owned(),
                    text: String::new(),
                    line: number + 2,
                });
            }
            open = !open;
        } else if let (true, Some(block)) = (open, found.last_mut()) {
            block.text += line;
            block.text += "\n";
        }
    }
    assert!(!open, "a block is not closed");
    found
}

/// Sections with their entries, the lines before the first section under an empty head. An entry goes on over lines that
/// start with a blank.
fn sections(text: &str) -> Vec<(&str, Vec<String>)> {
    let mut sections: Vec<(&str, Vec<String>)> = vec![("", Vec::new())];
    for line in text.lines().filter(|l| !l.trim().is_empty()) {
        let (_, entries) = sections.last_mut().unwrap();
        match entries.last_mut() {
            _ if line.starts_with('[') => sections.push((line.trim_end(), Vec::new())),
            Some(entry) if line.starts_with(' ') => *entry += &format!("\n{line}"),
            _ => entries.push(line.to_owned()),
        }
    }
    sections
}

fn merged(base: &str, fragment: &str) -> String {
    let name = |entry: &str| entry.split('=').next().unwrap_or("").trim().to_owned();
    let mut whole = sections(base);
    for (head, entries) in sections(fragment) {
        let Some((_, known)) = whole.iter_mut().find(|(h, _)| *h == head) else {
            whole.push((head, entries));
            continue;
        };
        for entry in entries {
            match known.iter_mut().find(|k| name(k) == name(&entry)) {
                Some(old) => *old = entry,
                None => known.push(entry),
            }
        }
    }
    let section =
        |(head, entries): &(&str, Vec<String>)| format!("{head}\n{}\n", entries.join("\n"));
    whole.iter().map(section).collect()
}

/// Everything that is said about a file, warnings included.
fn said(text: &str, files: &BTreeMap<&str, &str>) -> Vec<Diagnostic> {
    let mut ask = |name: &str| {
        let found = files.get(name).map(|text| (*text).to_owned());
        found.ok_or_else(|| format!("the page shows no `{name}`"))
    };
    match Model::from_toml(text, "page", &mut ask) {
        Ok(checked) => checked.warnings,
        Err(found) => found,
    }
}

/// What is wrong with a page, and how many models it shows.
fn trouble(page: &str, name: &str) -> (String, usize) {
    let blocks = blocks(page);
    let files: BTreeMap<&str, &str> = blocks
        .iter()
        .filter(|b| b.language == "csv")
        .map(|b| (b.about.as_str(), b.text.as_str()))
        .collect();
    let base = blocks.iter().find(|b| b.about == "base");
    let base = base.map_or("", |b| b.text.as_str());
    let (mut wrong, mut count) = (String::new(), 0);
    for (i, block) in blocks.iter().enumerate() {
        if block.language != "toml" {
            continue;
        }
        count += 1;
        let text = match block.about.as_str() {
            "" | "base" | "wrong" => block.text.clone(),
            "fragment" => merged(base, &block.text),
            other => panic!("{name}:{}: what is a `{other}` block?", block.line),
        };
        let found = said(&text, &files);
        let place = format!("{name}, block at line {}", block.line);
        if block.about == "wrong" {
            let shown = blocks.get(i + 1).map_or("", |b| b.text.as_str());
            assert!(!found.is_empty(), "{place} is not wrong");
            for d in &found {
                let word = if d.severity == Severity::Error {
                    "error"
                } else {
                    "warning"
                };
                let head = format!("{word}[{}]: {}\n", d.code, d.message);
                let help = d.help.clone().unwrap_or_default();
                if !shown.contains(&head) || !shown.contains(&help) {
                    wrong += &format!("the page does not show: {}", d.render_plain(&place, &text));
                }
            }
        } else {
            wrong.extend(found.iter().map(|d| d.render_plain(&place, &text)));
        }
    }
    (wrong, count)
}

fn page(path: &str) -> String {
    let path = format!("{}/../../{path}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).unwrap()
}

#[test]
fn every_model_of_the_pages_reads() {
    for (path, least) in [("docs/language.md", 15), ("README.md", 1)] {
        let (wrong, count) = trouble(&page(path), path);
        assert!(wrong.is_empty(), "{wrong}");
        assert!(count >= least, "{path} shows {count} models");
    }
}

#[test]
fn a_page_that_is_wrong_is_found() {
    let base = "```toml base\n[links]\nframe = { A = [0, 0] }\ncrank = { A-B = 1 }\n[drives]\nm = { turns = \"crank\", speed = 1 }\n```\n";
    assert_eq!(trouble(base, "page"), (String::new(), 1));
    let fragment = |line: &str| {
        trouble(
            &format!("{base}```toml fragment\n[links]\n{line}\n```\n"),
            "page",
        )
        .0
    };
    assert_eq!(fragment("crank = { A-B = 2, mass = 1, inertia = 0 }"), "");
    assert!(fragment("crank = { A-B = \"2 s\" }").contains("unit-mismatch"));
    assert!(
        fragment("crank = { A-B = 2, mass = 1 }").contains("no-inertia"),
        "warnings count"
    );
}

/// The words that stand for something in a model file: keys, kinds and their choices, measures.
fn words() -> BTreeSet<String> {
    fn choices(takes: &Takes, all: &mut BTreeSet<String>) {
        match takes {
            Takes::Words(words) => all.extend(words.iter().map(|w| (*w).to_owned())),
            Takes::AnyOf(some) => some.iter().for_each(|one| choices(one, all)),
            Takes::Two(one) | Takes::List(one, _) => choices(one, all),
            _ => {}
        }
    }
    let measures = Registry::all().iter().map(|m| m.name);
    let mut all: BTreeSet<String> = measures.map(str::to_owned).collect();
    visit_keys(&mut |_, _, key| {
        all.insert(key.name.to_owned());
        choices(&key.takes, &mut all);
    });
    all
}

#[test]
fn the_language_page_leaves_nothing_out() {
    let page = page("docs/language.md");
    let all = words();
    // the page writes "shaking_force (also _x, _y)"
    let diagnostic = |word: &str| {
        let stem = word.strip_suffix("_x").or(word.strip_suffix("_y"));
        let word = stem.filter(|w| *w == "shaking_force").unwrap_or(word);
        let letter = |c: char| c.is_alphanumeric() || c == '_';
        page.match_indices(word).any(|(at, _)| {
            let (before, after) = (&page[..at], &page[at + word.len()..]);
            !before.ends_with(letter) && !after.starts_with(letter)
        })
    };
    let missing: Vec<&String> = all.iter().filter(|w| !diagnostic(w)).collect();
    assert!(all.len() > 150, "{all:?}");
    assert!(
        missing.is_empty(),
        "docs/language.md does not name {missing:?}"
    );
}

/// The other words that the page puts in quotes of code, small letters and no more.
#[rustfmt::skip]
const OTHER: &[&str] = &[
    // what always has this name
    "frame", "all", "pi", "inf", "path", "hodograph", "before", "false",
    // columns that tables have of their own
    "arc", "closure", "condition", "energy_residual", "equilibrium_residual", "note", "power_residual", "route_difference", "smallest_singular_value", "_rate",
    "amplitude", "angular_frequency", "damped_frequency", "damping_ratio", "frequency", "growth", "modal_inertia", "modal_mass", "period", "shape",
    // names of the linkages that studies find
    "beside_rest", "body", "body_length", "coupler_acceleration", "coupler_length", "coupler_speed", "crank", "crank_length", "deviation", "full_turn", "grashof", "lever", "lever_length", "link_ratio", "miss", "motor",
    "pressure_angle", "rest_from", "rms_error", "rms_turn", "rod", "rod_length", "turn", "stir", "rocker_acceleration", "rocker_length", "rocker_speed", "structural_error",
    // on the command line
    "kempe", "check", "new", "run", "draw", "schema",
    // parts of names and phrases, and names of the page's own models
    "_", "_x", "_y", "of", "a", "phi",
];

/// Words in code quotes that are nothing the language knows.
fn unknown_words(page: &str) -> Vec<String> {
    let mut fenced = false;
    let mut prose = String::new();
    for line in page.lines() {
        fenced ^= line.starts_with("```");
        if !fenced && !line.starts_with("```") {
            prose += line;
            prose += " ";
        }
    }
    let known = words();
    let functions: Vec<&str> = Builtin::ALL.iter().map(|f| f.name()).collect();
    let small =
        |word: &str| !word.is_empty() && word.chars().all(|c| c.is_ascii_lowercase() || c == '_');
    let quoted = prose.split('`').skip(1).step_by(2);
    let quoted = quoted.flat_map(|code| match code.split_once(" = ") {
        // `key = value` and `name(arguments)` are about what stands in front
        Some((key, _)) => vec![key],
        None if code.contains('(') => code.split('(').take(1).collect(),
        None => code.split(' ').collect(),
    });
    let stranger = |word: &&str| {
        small(word)
            && !known.contains(*word)
            && !functions.contains(word)
            && !OTHER.contains(word)
            && Unit::parse(word).is_err()
    };
    let found: BTreeSet<&str> = quoted.filter(stranger).collect();
    found.into_iter().map(str::to_owned).collect()
}

#[test]
fn the_language_page_names_nothing_that_is_not_there() {
    let found = unknown_words(&page("docs/language.md"));
    assert!(found.is_empty(), "docs/language.md names {found:?}");
    let wrong = "`stiffnes` and `speedy(P)` and `clossing = 3`, not `stiffness` or `speed(P)`";
    assert_eq!(unknown_words(wrong), ["clossing", "speedy", "stiffnes"]);
}
