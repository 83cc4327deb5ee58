//! What a host asks, asked natively; that the module says the same under node is held by `cargo xtask wasm`.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;

use kempe_model::Model;
use kempe_study::{Silent, encode};
use kempe_wasm::{Request, check, exports, run};

const TEXT: &str = r#"
[links]
frame   = { A = [0, 0], D = [60, 0] }
crank   = { A-B = 20 }
coupler = { B-C = 50 }
rocker  = { D-C = 40 }
[drives]
motor = { turns = "crank", law = { table = "turn.csv" } }
[assembly]
C = "left of B -> D"
[measures]
swing = "angle(rocker)"
"#;
const TABLE: &str = "t [s],value [deg]\n0,10\n1,60\n2,140\n3,200\n4,250\n";

fn asked(study: Option<&str>) -> Request {
    Request {
        text: TEXT.to_owned(),
        title: "four-bar".to_owned(),
        tables: BTreeMap::from([("turn.csv".to_owned(), TABLE.to_owned())]),
        study: study.map(str::to_owned),
    }
}

fn codes(refusal: &serde_json::Value) -> Vec<&str> {
    let all = refusal["diagnostics"].as_array().unwrap();
    all.iter().map(|d| d["code"].as_str().unwrap()).collect()
}

#[test]
fn a_study_gives_the_bytes_of_its_table() {
    let model = Model::from_toml(TEXT, "four-bar", &mut |_| Ok(TABLE.to_owned()))
        .unwrap()
        .model;
    let result = kempe_study::run(&model, &model.studies[0], &mut Silent).unwrap();
    let csv = encode::csv(&result.table);
    assert!(csv.lines().count() > 10);
    assert_eq!(run(&asked(None)), Ok(csv.clone()));
    assert_eq!(run(&asked(Some(&model.studies[0].name))), Ok(csv));
}

#[test]
fn a_check_counts_and_tells() {
    let report = check(&asked(None)).unwrap();
    assert_eq!(report["mobility_count"], 1);
    assert!(report["diagnostics"].as_array().unwrap().is_empty());
}

#[test]
fn what_cannot_be_answered_says_why() {
    assert_eq!(
        codes(&run(&asked(Some("no"))).unwrap_err()),
        ["unknown-study"]
    );
    let mut still = asked(None);
    still.text = "[links]\nframe = { A = [0, 0] }\n".to_owned();
    assert_eq!(codes(&run(&still).unwrap_err()), ["no-drive"]);
    let mut without = asked(None);
    without.tables.clear();
    assert_eq!(codes(&check(&without).unwrap_err()), ["table-unreadable"]);
    let mut bent = asked(None);
    bent.text = bent.text.replace("A-B = 20", "A-B = -20");
    assert_eq!(codes(&run(&bent).unwrap_err()), ["bad-size"]);
}

#[test]
fn nonsense_over_the_border_is_refused() {
    for bytes in [
        "",
        "{",
        "[]",
        "{}",
        r#"{ "text": "", "sutdy": "turn" }"#,
        "\u{0}",
    ] {
        let refusal = Request::from_json(bytes.as_bytes()).unwrap_err();
        assert_eq!(codes(&refusal), ["bad-request"], "{bytes}");
    }
    // Nobody has written into the room.
    assert!(!exports::request(100).is_null());
    assert_eq!(exports::run(), exports::REFUSED);
    assert_eq!(exports::check(), exports::REFUSED);
    assert!(exports::answer_length() > 10);
    assert!(!exports::answer().is_null());
}
