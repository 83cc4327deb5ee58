//! Edits as data: parts renamed and deleted, entries added, places and paths.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use kempe_model::{
    DeleteError, Model, ModelFile, Part, PartKind, PathPart, STARTERS, add_entry, apply, complete,
    delete, delete_with_dependants, namings, parts, path_at, places_of, rename, set_value,
};
use proptest::prelude::*;

/// The texts of the examples, the starters and the tests that read, each with its folder.
fn texts() -> Vec<(String, PathBuf)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut texts: Vec<(String, PathBuf)> = STARTERS
        .iter()
        .map(|s| (s.text.to_owned(), root.to_owned()))
        .collect();
    for folder in [
        "../../examples/gallery",
        "../../examples/seeds",
        "tests/good",
    ] {
        let mut files: Vec<PathBuf> = std::fs::read_dir(root.join(folder))
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .filter(|p| p.extension().is_some_and(|e| e == "toml"))
            .collect();
        files.sort();
        let read = files
            .iter()
            .map(|p| (std::fs::read_to_string(p).unwrap(), root.join(folder)));
        texts.extend(read);
    }
    texts
}

fn read(text: &str, folder: &Path) -> Result<Model, String> {
    let mut tables = |name: &str| match std::fs::read_to_string(folder.join(name)) {
        Ok(text) => Ok(text),
        Err(_) => match name {
            "measured.csv" => Ok("t [s];angle\n0;10\n0.5;20\n1;25\n2;20\n".to_owned()),
            "card.csv" => Ok("p [bar],phi [deg]\n1,0\n50,360\n2,400\n1,719\n".to_owned()),
            "plain.csv" => Ok("time,force\n0,10\n1,20\n".to_owned()),
            _ => Err("no such file".to_owned()),
        },
    };
    match Model::from_toml(text, "", &mut tables) {
        Ok(checked) => Ok(checked.model),
        Err(found) => Err(found
            .iter()
            .map(|d| d.render_plain("edited", text))
            .collect()),
    }
}

/// A name that no text has.
fn other_name(kind: PartKind) -> &'static str {
    match kind {
        PartKind::Point => "Zz_other",
        _ => "zz_other",
    }
}

#[test]
fn drives_that_a_study_lets_go_are_renamed_deleted_and_completed() {
    let text = "[links]\nframe = { O = [0, 0] }\nupper = { O-P = 1 }\nlower = { P-Q = 1 }\n[drives]\na = { turns = \"upper\", at = 0 }\n\
                b = { turns = \"lower\", at = 0 }\n[studies.m]\nkind = \"vibrations\"\nrelease = [\"a\", \"b\"]\nat = { a = 3, b = 4 }\n";
    let a = Part::new(PartKind::Drive, "a");
    let renamed = apply(text, &rename(text, &a, "swing").unwrap()).unwrap();
    assert!(
        renamed.contains("release = [\"swing\", \"b\"]\nat = { swing = 3, b = 4 }"),
        "{renamed}"
    );
    assert!(read(&renamed, Path::new("")).is_ok());
    assert!(matches!(delete(text, &a), Err(DeleteError::InUse(by)) if by.len() == 2));
    let gone = delete_with_dependants(text, &a).unwrap();
    let left = apply(text, &gone.edits).unwrap();
    assert!(left.contains("release = [\"b\"]\nat = { b = 4 }"), "{left}");
    let labels = |at: &str| -> Vec<String> {
        let offset = text.find(at).unwrap() + at.len();
        complete(text, offset)
            .into_iter()
            .map(|c| c.label)
            .collect()
    };
    assert_eq!(labels("release = [\""), ["a", "b"]);
    let typed = text.replace("at = { a = 3, b = 4 }", "at = {  }");
    let offset = typed.find("at = { ").unwrap() + 7;
    let found: Vec<String> = complete(&typed, offset)
        .into_iter()
        .map(|c| c.label)
        .collect();
    assert_eq!(found, ["a", "b"]);
}

#[test]
fn a_part_renamed_is_the_same_part_and_renamed_back_the_same_text() {
    let mut renamed = 0;
    for (text, folder) in texts() {
        let model = read(&text, &folder).unwrap();
        let written = model.to_toml();
        for (part, _) in parts(&text) {
            if part.name == "frame" {
                assert_eq!(
                    rename(&text, &part, "zz_other").unwrap_err().code,
                    "bad-name"
                );
                continue;
            }
            let to = other_name(part.kind);
            let edits = rename(&text, &part, to).unwrap();
            let edited = apply(&text, &edits).unwrap();
            let names_of = |file: &ModelFile| file.toml.replace(to, &part.name);
            let changed =
                read(&edited, &folder).unwrap_or_else(|diagnostic| panic!("{part}: {diagnostic}"));
            assert_eq!(names_of(&changed.to_toml()), written.toml, "{part}");
            let back = rename(&edited, &Part::new(part.kind, to), &part.name).unwrap();
            assert_eq!(apply(&edited, &back).unwrap(), text, "{part}");
            // only names were changed
            for edit in &edits {
                assert_eq!(
                    (&text[edit.span.clone()], edit.text.as_str()),
                    (part.name.as_str(), to)
                );
            }
            renamed += 1;
        }
    }
    assert!(renamed > 500, "{renamed}");
}

#[test]
fn what_cannot_be_renamed_is_refused() {
    let text = "[parameters]\na = 3\nlong = \"5 N/a\"\n[links]\nframe = { A = [0, 0], D = [1, 0] }\nbar = { A-B = \"a * 1 m\" }\n[drives]\nm = { turns = \"bar\", speed = 1 }\n[measures]\nw = \"m + a * 1 rad\"\n[studies.turn]\nkind = \"motion\"\n[studies.slow]\nkind = \"motion\"\n";
    let code = |kind, name: &str, to: &str| {
        rename(text, &Part::new(kind, name), to).map_err(|d| (d.code, d.message))
    };
    for (kind, name, to, wanted) in [
        (PartKind::Parameter, "b", "c", "unknown-name"),
        (PartKind::Point, "b", "C", "unknown-name"),
        (PartKind::Parameter, "a", "A", "bad-name"),
        (PartKind::Parameter, "a", "a b", "bad-name"),
        (PartKind::Parameter, "a", "pi", "bad-name"),
        (PartKind::Point, "A", "a", "bad-name"),
        (PartKind::Drive, "m", "note", "bad-name"),
        (PartKind::Link, "bar", "frame", "bad-name"),
        (PartKind::Parameter, "a", "bar", "name-clash"),
        (PartKind::Point, "A", "B", "name-clash"),
        (PartKind::Study, "turn", "SLOW", "name-clash"),
        (PartKind::Study, "turn", "con", "bad-name"),
        // `5 N/a` would be 5 newton per metre
        (PartKind::Parameter, "a", "mm", "bad-name"),
    ] {
        assert_eq!(
            code(kind, name, to).unwrap_err().0,
            wanted,
            "{name} -> {to}"
        );
    }
    assert!(
        code(PartKind::Parameter, "a", "mm")
            .unwrap_err()
            .1
            .contains("something else")
    );
    assert_eq!(code(PartKind::Study, "turn", "Turn").unwrap().len(), 1);
    // A parameter that varies has a column of its own in tables.
    let varies = format!(
        "{text}[studies.best]\nkind = \"sweep\"\nover = \"turn\"\nvary = {{ a = [1, 2] }}\n"
    );
    let parameter = Part::new(PartKind::Parameter, "a");
    assert!(rename(text, &parameter, "design").is_ok());
    assert_eq!(
        rename(&varies, &parameter, "design").unwrap_err().code,
        "bad-name"
    );
    assert!(rename(&varies, &Part::new(PartKind::Parameter, "long"), "design").is_ok());
    let broken = format!("{text}[loads]\nx = {{ torque = \"2 * (a\", on = \"bar\" }}\n");
    let diagnostic = rename(&broken, &Part::new(PartKind::Parameter, "a"), "c").unwrap_err();
    assert_eq!(&broken[diagnostic.labels[0].span.clone()], "\"2 * (a\"");
    // what does not name it may be broken
    assert!(rename(&broken, &Part::new(PartKind::Drive, "m"), "motor").is_ok());
}

#[test]
fn a_part_that_a_table_may_name_by_a_head_is_renamed_where_columns_say_what_they_are() {
    let file = |rows: &str| {
        format!(
            "[parameters]\na = 1\n[links]\nframe = {{ O = [0, 0] }}\nbar = {{ O-P = \"a\" }}\n[drives]\nm = {{ turns = \"bar\" }}\n[measures]\nh = \"y(P)\"\n\
             [studies.set]\nkind = \"adjust\"\nunknown = [\"a\"]\n{rows}"
        )
    };
    let by_heads = [
        "match = { table = \"m.csv\" }\n",
        "[studies.set.match]\ntable = \"m.csv\"\n",
    ];
    let parts = [PartKind::Drive, PartKind::Measure, PartKind::Link];
    for (kind, name) in parts.into_iter().zip(["m", "h", "bar"]) {
        let part = Part::new(kind, name);
        for rows in by_heads {
            let text = file(rows);
            let told = rename(&text, &part, "other").unwrap_err();
            assert_eq!(told.code, "table-column");
            assert_eq!(&text[told.labels[0].span.clone()], "\"m.csv\"");
        }
        let text = file("match = { table = \"m.csv\", columns = { m = \"m\", h = \"h\" } }\n");
        assert!(rename(&text, &part, "other").is_ok());
    }
    assert!(
        rename(
            &file(by_heads[0]),
            &Part::new(PartKind::Parameter, "a"),
            "b"
        )
        .is_ok()
    );
}

#[test]
fn names_are_found_wherever_they_stand() {
    let text = r#"
[links]
frame = { A = [0, 0], "D" = [6, 0] }
'b1' = { "A-B" = 2 }
[links.c]
B-C = 5
P = "left of B -> C"
B-P = 3
P-C = 4
center = "P"
[links.r]
D - C = 4
"D-E" = 1
[joints]
j = { pin = "P", on = "D -> C" }
[assembly]
C = "left of B -> D"
[springs]
b1 = { between = "P-D", stiffness = 0, preload = "x * 1 N", stops = ["none", 3] }
[parameters]
x = "1"
none = 3
[friction]
C = { coefficient = "x", radius = 1 }
[clearance]
C = { radial = "x * 1 um", on = "c" }
[drives]
m = { turns = "b1", law = [ { rise = "x * 1 deg", in = "none * 1 s", by = "harmonic" } ] }
[measures]
one = "x(C, c) + travel(j) * x + \u0073peed(C) * 1 s"
two = """spring_force(b1) / x \
   + 1 N"""
[studies.s]
kind = "forces"
columns = "one"
plot = [["one", "x(C)"], "path(C)", "hodograph(C, c)"]
"#;
    let count = |kind, name: &str| namings(text, &Part::new(kind, name)).len();
    assert_eq!(count(PartKind::Point, "C"), 12);
    assert_eq!(count(PartKind::Point, "P"), 6);
    assert_eq!(count(PartKind::Point, "D"), 6);
    assert_eq!(count(PartKind::Link, "c"), 4);
    assert_eq!(count(PartKind::Link, "b1"), 2);
    assert_eq!(count(PartKind::Spring, "b1"), 2);
    assert_eq!(count(PartKind::Parameter, "x"), 7);
    assert_eq!(count(PartKind::Parameter, "none"), 2);
    assert_eq!(count(PartKind::Measure, "one"), 3);
    for (part, _) in parts(text) {
        for naming in namings(text, &part) {
            assert_eq!(&text[naming.span.clone()], part.name);
        }
    }
    // a key gets quotes when it needs them
    let edits = rename(text, &Part::new(PartKind::Point, "C"), "É").unwrap();
    let edited = apply(text, &edits).unwrap();
    assert!(
        edited.contains("\"B-É\" = 5") && !edited.contains("\nP-C"),
        "{edited}"
    );
    assert!(
        edited.contains("\"P-É\" = 4") && edited.contains("[assembly]\n\"É\" ="),
        "{edited}"
    );
}

#[test]
fn a_part_that_nothing_names_goes_and_the_rest_reads() {
    let kinds = [
        PartKind::Parameter,
        PartKind::Measure,
        PartKind::Study,
        PartKind::Load,
        PartKind::Mass,
        PartKind::Spring,
        PartKind::Damper,
        PartKind::Switch,
    ];
    let (mut gone, mut used) = (0, 0);
    for (text, folder) in texts() {
        for (part, _) in parts(&text) {
            match delete(&text, &part) {
                Ok(edits) => {
                    let left = apply(&text, &edits).unwrap();
                    assert!(namings(&left, &part).is_empty());
                    assert!(
                        toml::from_str::<toml::Table>(&left).is_ok(),
                        "{part}: {left}"
                    );
                    // of a file that asks for linkages alone something must be left
                    let nothing = !left.contains("[links") && !left.contains("[studies");
                    if kinds.contains(&part.kind) && !nothing {
                        read(&left, &folder)
                            .unwrap_or_else(|diagnostic| panic!("{part}: {diagnostic}"));
                        gone += 1;
                    }
                }
                Err(DeleteError::InUse(by)) => {
                    assert!(!by.is_empty());
                    used += 1;
                }
                Err(DeleteError::Needed(why)) => {
                    assert_eq!((part.name.as_str(), why.code), ("frame", "no-frame"));
                }
                Err(other) => panic!("{part}: {other}"),
            }
        }
    }
    assert!(gone > 50 && used > 100, "{gone} {used}");
}

/// What is left of a text when a part goes with all that names it, with line ends of LF and of CRLF.
fn left(text: &str, part: &Part) -> String {
    let after = |text: &str| {
        let gone = delete_with_dependants(text, part).unwrap();
        let left = apply(text, &gone.edits).unwrap();
        assert!(toml::from_str::<toml::Table>(&left).is_ok(), "{left}");
        left
    };
    let found = after(text);
    assert_eq!(
        after(&text.replace('\n', "\r\n")),
        found.replace('\n', "\r\n")
    );
    found
}

#[test]
fn the_frame_stays() {
    let text = "[links]\nframe = { A = [0, 0] }\nbar = { A-B = 1 }\n";
    let error = delete(text, &Part::new(PartKind::Link, "frame")).unwrap_err();
    assert!(matches!(&error, DeleteError::Needed(why) if why.code == "no-frame"));
    assert!(error.to_string().contains("stands still"), "{error}");
    assert!(delete(text, &Part::new(PartKind::Link, "bar")).is_ok());
}

#[test]
fn comments_of_what_stays_stay() {
    let bar = Part::new(PartKind::Link, "bar");
    for (text, wanted) in [
        (
            "[links]\nframe = { A = [0, 0] }\n[links.bar]\nA-B = 1\n\n# The drive: 60 rpm as measured in May\n[drives]\nmotor = { turns = \"frame\" }\n",
            "[links]\nframe = { A = [0, 0] }\n\n# The drive: 60 rpm as measured in May\n[drives]\nmotor = { turns = \"frame\" }\n",
        ),
        (
            "[links]\nframe = 1\n# of links\n\n# of the bar\n# too\n[links.bar] # here\n# its length\nA-B = 1 # long\n\n# light\nmass = 2\n# no more\n\n# apart\n\n[drives]\n",
            "[links]\nframe = 1\n# of links\n\n# apart\n\n[drives]\n",
        ),
        (
            "[links]\nframe = \"\"\"x\n# no comment\"\"\"\n[links.bar]\n# its own\nA-B = 1\n# of drives\n[drives]\n",
            "[links]\nframe = \"\"\"x\n# no comment\"\"\"\n# of drives\n[drives]\n",
        ),
        (
            "# top\n\n[links]\n# the frame\nframe = 1\n# the bar\n  # is long\nbar = { A-B = 1 } # 1 m\n# the rod\nrod = 2\n",
            "# top\n\n[links]\n# the frame\nframe = 1\n# the rod\nrod = 2\n",
        ),
        ("[links.bar]\nA-B = 1\n\n# end\n", "# end\n"),
    ] {
        assert_eq!(left(text, &bar), wanted);
    }
}

#[test]
fn the_comment_of_a_line_between_brackets_goes_with_its_entry() {
    let m = Part::new(PartKind::Measure, "m");
    for (columns, wanted) in [
        (
            "\"n\", # first\n  \"m\", # second\n  \"o\", # third\n",
            "\"n\", # first\n  \"o\", # third\n",
        ),
        ("\"m\", # first\n  \"n\" # second\n", "\n  \"n\" # second\n"),
        ("\"n\", # first\n  \"m\" # second\n", "\"n\" # first\n"),
        (
            "\n  # of n\n  \"n\",\n  # of m\n  \"m\",\n\n  # of none\n\n  # of o\n  \"o\"\n",
            "\n  # of n\n  \"n\",\n\n  # of none\n\n  # of o\n  \"o\"\n",
        ),
        ("\"n\", \"m\", # both\n  \"o\"", "\"n\", # both\n  \"o\""),
        ("\"m\", \"m\", # both\n  \"o\"", "\n  \"o\""),
        ("\"n\",\n  \"m\"", "\"n\""),
        (
            "\n  \"n\"\n  # of m\n  , \"m\" # m\n",
            "\n  \"n\"\n  # of m\n",
        ),
        ("\"m\", \"n\", \"m\", \"o\", \"m\"", "\"n\", \"o\""),
        ("\"n\", \"m\", ", "\"n\", "),
    ] {
        let text = |columns: &str| {
            format!(
                "[measures]\nn = \"time\"\n[studies.s]\ncolumns = [{columns}] # all\nstep = 1\n"
            )
        };
        let before = text(columns).replace("[studies", "m = \"time\"\n[studies");
        assert_eq!(left(&before, &m), text(wanted), "{columns}");
    }
    let text = "[links]\nframe = { A = [0, 0], # origin\n  B = [1, 1], # b\n  C = [2, 2] }\n";
    assert_eq!(
        left(text, &Part::new(PartKind::Point, "B")),
        text.replace("\n  B = [1, 1], # b", "")
    );
    assert_eq!(
        left(text, &Part::new(PartKind::Point, "A")),
        text.replace("A = [0, 0], # origin", "")
            .replace("{ \n", "{\n")
    );
    assert_eq!(
        left(text, &Part::new(PartKind::Point, "C")),
        text.replace("], # b\n  C = [2, 2] }", "] # b\n  }")
    );
}

#[test]
fn with_all_that_names_it_nothing_names_it() {
    for (text, folder) in texts() {
        for (part, _) in parts(&text) {
            let gone = delete_with_dependants(&text, &part).unwrap();
            let left = apply(&text, &gone.edits).unwrap();
            assert!(gone.parts.contains(&part));
            for part in &gone.parts {
                assert!(namings(&left, part).is_empty(), "{part} in {left}");
            }
            assert!(
                toml::from_str::<toml::Table>(&left).is_ok(),
                "{part}: {left}"
            );
            // of what is left no name is missing
            if let Err(diagnostic) = read(&left, &folder) {
                assert!(
                    !diagnostic.contains("[unknown-name]"),
                    "{part}: {diagnostic}\n{left}"
                );
            }
        }
    }
}

#[test]
fn every_key_and_value_is_found_by_its_path() {
    for (text, _) in texts() {
        // every few letters are enough to meet every key and value
        for (at, _) in text.char_indices().step_by(17) {
            if let Some(here) = path_at(&text, at) {
                let path: Vec<&str> = here.path.iter().map(String::as_str).collect();
                let places = places_of(&text, &path).unwrap();
                match here.part {
                    PathPart::Key => assert!(places.keys.contains(&here.span)),
                    _ => assert_eq!(places.value, Some(here.span.clone())),
                }
                assert!(here.span.start <= at && at <= here.span.end);
            }
        }
    }
}

#[test]
fn entries_are_added_where_they_belong() {
    let add = |text: &str, section: &str| {
        let edit = add_entry(text, section, "new", "{ a = 1 }")
            .unwrap_or_else(|found| panic!("{section}: {found:?}\n{text}"));
        apply(text, &[edit]).unwrap()
    };
    assert_eq!(add("", "loads"), "[loads]\nnew = { a = 1 }\n");
    assert_eq!(add("[loads]\n", "loads"), "[loads]\nnew = { a = 1 }\n");
    assert_eq!(
        add("[loads]\nx = 1 # c", "loads"),
        "[loads]\nx = 1 # c\nnew = { a = 1 }\n"
    );
    assert_eq!(
        add("loads = { x = 1 }", "loads"),
        "loads = { x = 1, new = { a = 1 } }"
    );
    assert_eq!(
        add("[studies.a]\r\nk = 1\r\n", "studies"),
        "[studies.a]\r\nk = 1\r\n\r\n[studies]\r\nnew = { a = 1 }\r\n"
    );
    let edit = add_entry("parameters.a = 1\n[links]\n", "parameters", "b", "2").unwrap();
    assert_eq!(
        apply("parameters.a = 1\n[links]\n", &[edit]).unwrap(),
        "parameters.a = 1\nparameters.b = 2\n[links]\n"
    );
    assert_eq!(
        add_entry("[a]\nnew = 1", "a", "new", "1").unwrap_err().code,
        "name-clash"
    );
    assert_eq!(
        add_entry("[a]\n", "a", "new", "1\nx = 2").unwrap_err().code,
        "toml-syntax"
    );
    for (text, _) in texts() {
        for section in ["parameters", "loads", "studies", "links"] {
            let edited = add(&text, section);
            let table: toml::Table = toml::from_str(&edited).unwrap();
            assert_eq!(table[section]["new"]["a"].as_integer(), Some(1));
        }
    }
}

/// The paths of all tables of a tree.
fn tables(here: &toml::Value, path: &[String], out: &mut Vec<Vec<String>>) {
    let inner = |name: String| [path, &[name]].concat();
    match here {
        toml::Value::Table(table) => {
            out.push(path.to_vec());
            for (name, value) in table {
                tables(value, &inner(name.clone()), out);
            }
        }
        toml::Value::Array(items) => {
            for (i, value) in items.iter().enumerate() {
                tables(value, &inner(i.to_string()), out);
            }
        }
        _ => {}
    }
}

#[test]
fn every_table_takes_an_entry_and_nothing_else_changes() {
    let mut seen = 0;
    for (text, _) in texts() {
        for text in [text.replace("\r\n", "\n"), text.replace('\n', "\r\n")] {
            let before: toml::Value = toml::Value::Table(toml::from_str(&text).unwrap());
            let mut paths = Vec::new();
            tables(&before, &[], &mut paths);
            for path in paths {
                let mut names: Vec<&str> = path.iter().map(String::as_str).collect();
                names.push("zz new");
                let edited = set_value(&text, &names, "[1, 'x']").unwrap();
                let mut wanted = before.clone();
                let table = path.iter().fold(&mut wanted, |here, part| match here {
                    toml::Value::Array(items) => &mut items[part.parse::<usize>().unwrap()],
                    here => &mut here[part.as_str()],
                });
                let new = vec![toml::Value::Integer(1), toml::Value::String("x".into())];
                let table = table.as_table_mut().unwrap();
                table.insert("zz new".to_owned(), toml::Value::Array(new));
                let after = toml::Value::Table(toml::from_str(&edited).unwrap());
                assert!(after == wanted, "{names:?}\n{edited}");
                // every line of before is there, ended as it was
                let mut lines = edited.split_inclusive('\n');
                let kept = |line: &str| lines.any(|after| after == line);
                let missing = text
                    .split_inclusive('\n')
                    .filter(|line| !line.contains(['{', '}']));
                assert!(
                    missing.clone().all(kept) || !text.ends_with('\n'),
                    "{names:?}\n{edited}"
                );
                seen += 1;
            }
        }
    }
    assert!(seen > 2000, "{seen}");
}

#[test]
fn large_files_are_edited_in_time() {
    let count = 20_000;
    let mut text = "[parameters]\np0 = 1\n".to_owned();
    for i in 1..count {
        text += &format!("p{i} = \"p{} + 1\"\n", i - 1);
    }
    text += "[links]\nframe = { ";
    for i in 0..count {
        text += &format!("A{i} = [{i}, \"p{i} * 1 m\"], ");
    }
    text += "Z = [0, 0] }\n[studies.s]\nkind = \"motion\"\ncolumns = [\"time\"";
    for i in 0..count {
        text += &format!(", \"x(A{i})\"");
    }
    text += "]\n";
    let first = Part::new(PartKind::Parameter, "p0");
    let gone = delete_with_dependants(&text, &first).unwrap();
    let left = apply(&text, &gone.edits).unwrap();
    assert_eq!(
        left,
        "[parameters]\n[links]\nframe = { Z = [0, 0] }\n[studies.s]\nkind = \"motion\"\ncolumns = [\"time\"]\n"
    );
    assert_eq!(rename(&text, &first, "q").unwrap().len(), 3);
    assert!(!complete(&text, text.len()).is_empty());
}

/// Pieces of model files, put together at random.
fn soup() -> impl Strategy<Value = String> {
    const PIECES: &[&str] = &[
        "[links]\n",
        "[studies.a]\n",
        "frame = { ",
        "A-B = 2",
        "A = [0, ",
        "\"left of A -> B\"",
        "\"",
        "'''",
        "\n",
        "\r\n",
        " = ",
        "}",
        "]",
        ",",
        "[measures]\n",
        "m = \"x(A)\"\n",
        "# c",
        "é",
        ".",
        "b.c = 3\n",
        "\\",
        "m",
        "A",
        "{",
        "[",
        "\"\"\"",
    ];
    proptest::collection::vec(proptest::sample::select(PIECES), 0..40).prop_map(|p| p.concat())
}

#[test]
fn words_and_files_name_no_part() {
    let text = "title = \"motion\"\ngravity = \"none\"\n[parameters]\nnone = \"9.8 m/s^2\"\nmotion = 1\ncentroid = 1\n[links]\nx = { A-B = \"motion\", center = \"centroid\" }\n[springs]\ns = { stops = [\"none\", \"motion\"], stiffness = \"none\" }\n[studies.t]\nkind = \"motion\"\nlater = \"motion\"\n";
    let paths = |name: &str| -> Vec<String> {
        let found = namings(text, &Part::new(PartKind::Parameter, name));
        found.iter().map(|n| n.path.join(".")).collect()
    };
    // a parameter may be called like a word of the language
    assert_eq!(
        paths("none"),
        ["gravity", "parameters.none", "springs.s.stiffness"]
    );
    assert_eq!(
        paths("motion"),
        [
            "parameters.motion",
            "links.x.A-B",
            "springs.s.stops.1",
            "studies.t.later"
        ]
    );
    assert_eq!(paths("centroid"), ["parameters.centroid"]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn no_text_is_too_broken(text in soup(), at in 0usize..400) {
        let _ = path_at(&text, at);
        for (part, span) in parts(&text) {
            prop_assert!(text.get(span).is_some());
            if let Ok(edits) = rename(&text, &part, other_name(part.kind)) {
                prop_assert!(apply(&text, &edits).is_ok());
            }
            if let Ok(gone) = delete_with_dependants(&text, &part) {
                let left = apply(&text, &gone.edits);
                prop_assert!(left.is_ok(), "{:?} {:?}", text, gone);
            }
        }
    }
}
