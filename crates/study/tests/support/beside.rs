//! Studies named `s` that ask for what belongs to a file's own mechanism, and what they find, moved again.

use std::fmt::Write as _;

use kempe_model::{Diagnostic, Model, ModelFile};
use kempe_number::Random;
use kempe_study::{Silent, StudyResult, run};

pub const HEAD: &str = r#"# A comment that stays.
title = "t"
units = { length = "mm", angle = "deg" }

"#;

/// The four-bar of the gallery's dwell six-bar.
pub const SYMMETRIC: &str = r#"[links]
frame   = { A = [0, 0], D = [120, 0] }   # two pivots
crank   = { A-B = 40 }
coupler = { B-C = 150, B-P = 281.9, C-P = 150, P = "right of B -> C" }
rocker  = { D-C = 150 }

[drives]
motor = { turns = "crank", from = 0, to = 360, speed = "60 rpm" }

[assembly]
C = "left of B -> D"
"#;

pub fn tried(text: &str) -> Result<StudyResult, Vec<Diagnostic>> {
    let model = Model::from_toml(text, "t", &mut |_| Err("no files".into()))?.model;
    let study = model.studies.iter().find(|study| study.name == "s");
    run(&model, study.expect("a study"), &mut Silent)
}

pub fn found(text: &str) -> StudyResult {
    let told = |told: Vec<Diagnostic>| -> String {
        told.iter().map(|d| d.render_plain("t", text)).collect()
    };
    tried(text).unwrap_or_else(|wrong| panic!("{}\n{text}", told(wrong)))
}

pub fn code(text: &str) -> &'static str {
    match tried(text) {
        Err(told) => told[0].code,
        Ok(result) => result.diagnostics.first().map_or("", |d| d.code),
    }
}

pub fn column(result: &StudyResult, name: &str) -> Vec<f64> {
    let found = result
        .table
        .columns
        .iter()
        .find(|column| column.name == name);
    let names: Vec<&String> = result.table.columns.iter().map(|c| &c.name).collect();
    found
        .unwrap_or_else(|| panic!("no {name} among {names:?}"))
        .values
        .clone()
}

/// A file that was found, run as any other.
pub fn moved(file: &ModelFile) -> StudyResult {
    let read = Model::from_toml(&file.toml, "t", &mut file.tables.files());
    let model = read
        .unwrap_or_else(|wrong| panic!("{wrong:?}\n{}", file.toml))
        .model;
    assert_eq!(model.studies.len(), 1, "{}", file.toml);
    run(&model, &model.studies[0], &mut Silent)
        .unwrap_or_else(|wrong| panic!("{wrong:?}\n{}", file.toml))
}

/// A crank-rocker of random lengths with a random coupler point, somewhere in the plane.
pub fn random_bar(random: &mut Random) -> String {
    loop {
        let mut length = |low: f64, high: f64| low + (high - low) * random.uniform();
        let [crank, ground, coupler, rocker] = [
            length(8.0, 20.0),
            length(40.0, 70.0),
            length(40.0, 70.0),
            length(40.0, 70.0),
        ];
        let longest = ground.max(coupler).max(rocker);
        if crank + 2.0 * longest > 0.97 * (ground + coupler + rocker) {
            continue;
        }
        let (x, y, turn) = (
            length(-100.0, 100.0),
            length(-100.0, 100.0),
            length(-3.0, 3.0),
        );
        let d = [
            x + ground * kempe_number::math::cos(turn),
            y + ground * kempe_number::math::sin(turn),
        ];
        let side = if length(-1.0, 1.0) > 0.0 {
            "left"
        } else {
            "right"
        };
        let mut text = HEAD.to_owned();
        let _ = write!(
            text,
            "[links]\nframe = {{ A = [{x}, {y}], D = [{}, {}] }}\ncrank = {{ A-B = {crank} }}\ncoupler = {{ B = [0, 0], C = [{coupler}, 0], P = [{}, {}] }}\nrocker = {{ D-C = {rocker} }}\n",
            d[0],
            d[1],
            length(-20.0, 80.0),
            length(-50.0, 50.0)
        );
        let _ = write!(
            text,
            "[drives]\nmotor = {{ turns = \"crank\", from = 0, to = 360, speed = \"60 rpm\" }}\n[assembly]\nC = \"{side} of B -> D\"\n"
        );
        return text;
    }
}
