//! The report of what moves in time, in a real browser whose clock the test turns: it is played in real time or so much slower as it
//! says, and marks where bodies touch.
#![cfg(unix)]

use crate::support;
use std::fs;
use std::path::{Path, PathBuf};

use crate::browser::Page;
use crate::support::kempe;
use serde_json::json;

/// A clock that the test turns: the page is drawn anew when `turned` says that so many milliseconds have passed.
const CLOCK: &str = "{ let now = 0, waiting = []; \
    window.requestAnimationFrame = (f) => waiting.push(f); \
    window.turned = (ms) => { now += ms; const all = waiting; waiting = []; all.forEach((f) => f(now)); }; }";

/// A rod that falls from level on a stop, from which it bounces.
fn falling(until: &str) -> String {
    format!(
        r#"units = {{ length = "m", angle = "deg" }}
gravity = [0, "-9.81 m/s^2"]
[links]
frame = {{ O = [0, 0] }}
rod = {{ O-P = 1, mass = "1 kg", inertia = "0.1 kg m^2" }}
[drives]
pivot = {{ turns = "rod", at = 0 }}
[studies.fall]
kind = "simulate"
stops = {{ pivot = {{ between = [-60, "none"], restitution = 0.4 }} }}
until = "{until}"
rows = 201
columns = ["pivot"]
"#
    )
}

/// The folder of a run of a file.
fn run(at: &Path, name: &str, text: &str) -> PathBuf {
    let file = format!("{name}.toml");
    fs::write(at.join(&file), text).expect("written");
    let ran = kempe(at, &["run", &file, "--out", name]);
    let report = at.join(name).join("report.html");
    assert!(report.exists(), "{}", support::said(&ran));
    at.join(name)
}

/// A page of a report whose clock stands.
fn opened(folder: &Path) -> Page {
    let page = Page::start();
    let source = json!({"source": CLOCK});
    page.ask("Page.addScriptToEvaluateOnNewDocument", source);
    page.open(&folder.join("report.html"), [1400, 900], false, false);
    page
}

fn input(name: &str) -> String {
    format!("document.querySelector('[data-in={name}]')")
}

fn chosen(page: &Page) -> String {
    let speed = input("speed");
    page.text(&format!("{speed}.selectedOptions[0].text"))
}

fn set(page: &Page, name: &str, value: &str, event: &str) {
    let input = input(name);
    page.value(&format!(
        "{{ {input}.value = {value:?}; {input}.dispatchEvent(new Event({event:?})); }}"
    ));
}

/// The time of the motion that passes in a second, from its start.
fn passes(page: &Page) -> f64 {
    set(page, "row", "0", "input");
    // the first picture only begins to count
    page.value("document.querySelector('[data-do=play]').getAttribute('aria-pressed') === 'true' || document.querySelector('[data-do=play]').click()");
    page.value("turned(0)");
    let time = || page.number(&format!("+{}.value", input("time")));
    let before = time();
    page.value("for (let k = 0; k < 20; k++) turned(50)");
    time() - before
}

#[test]
fn what_moves_in_time_is_played_in_real_time_or_as_it_says() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let cases = [
        // the middle of the range that is watched as it is
        ("seconds", "4 s", "real time", 1.0),
        ("rattle", "24 ms", "250 × slower", 0.004),
        ("hour", "600 s", "100 × faster", 100.0),
    ];
    for (name, until, told, pace) in cases {
        let page = opened(&run(at, name, &falling(until)));
        assert_eq!(chosen(&page), told);
        let row = match name {
            "seconds" => 4.0 / 200.0,
            "rattle" => 0.024 / 200.0,
            _ => 600.0 / 200.0,
        };
        let passed = passes(&page);
        assert!(
            (passed - pace).abs() <= row,
            "{name}: {passed} s in a second"
        );
        // real time can be had of everything
        let options = page.text(
            "[...document.querySelector('[data-in=speed]').options].map((o) => o.text).join()",
        );
        assert!(options.split(',').any(|o| o == "real time"), "{options}");
        if name == "seconds" {
            set(&page, "speed", "0.1", "change");
            assert_eq!(chosen(&page), "10 × slower");
            let passed = passes(&page);
            assert!((passed - 0.1).abs() <= row, "{passed}");
            let note = page.text("document.querySelector('.rate').textContent");
            assert_eq!(
                note,
                "1 s on screen is 0.1 s of the motion; a pass takes 40 s"
            );
        }
        assert_eq!(page.complaints(), Vec::<String>::new());
    }
}

/// Rings that are lit, by the names of their points.
fn lit(page: &Page) -> String {
    page.text("[...document.querySelectorAll('.touch.on')].map((g) => g.dataset.point).join()")
}

#[test]
fn a_stop_lights_up_where_it_is_struck_and_where_it_is_lain_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let page = opened(&run(folder.path(), "fall", &falling("4 s")));
    let marks = |kind: &str| {
        page.number(&format!(
            "document.querySelectorAll('.marks .{kind}').length"
        ))
    };
    assert!(marks("impact") >= 2.0 && marks("contact") == 1.0);
    // words stand above the bar while it stands still
    page.value("document.querySelector('[data-do=play][aria-pressed=true]').click()");
    set(&page, "row", "0", "input");
    assert_eq!(lit(&page), "");
    set(&page, "row", "200", "input");
    assert_eq!(lit(&page), "O");
    let said = page.text("document.querySelector('.status').textContent");
    assert_eq!(said, "Row 201 of 201, lies on the lower stop of pivot");
    // the mark of the rest ends where the bar does
    let ends = page.number(
        "(() => { const b = document.querySelector('.marks .contact').getBoundingClientRect(), m = document.querySelector('.marks').getBoundingClientRect(); return m.right - b.right; })()",
    );
    assert!(ends.abs() < 1.0, "{ends} px");
    assert_eq!(page.nameless(), Vec::<String>::new());
}

/// At every row at which the table says that the bodies of C touch, and at those right beside, C is lit; nowhere else.
#[test]
fn a_joint_with_play_lights_up_while_its_bodies_touch() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = include_str!("../../../../examples/benchmarks/clearance-slider-crank.toml")
        .replace("step    = \"0.02 ms\"", "rows = 151");
    let out = run(folder.path(), "rattle", &text);
    let page = opened(&out);
    let table = fs::read_to_string(out.join("rattle.csv")).expect("text");
    let mut lines = table.lines();
    let heads: Vec<&str> = lines.next().expect("heads").split(',').collect();
    let column = |name: &str| heads.iter().position(|h| *h == name).expect("a column");
    let touching = column("C touching [1]");
    let touches: Vec<bool> = lines
        .map(|line| line.split(',').nth(touching).expect("a field") != "0")
        .collect();
    assert!(touches.iter().any(|t| *t) && touches.iter().any(|t| !t));
    let all = page.value(
        "(() => { const row = document.querySelector('[data-in=row]'); const all = []; \
         for (let k = 0; k <= +row.max; k++) { row.value = k; row.dispatchEvent(new Event('input')); \
         all.push([...document.querySelectorAll('.touch.on')].map((g) => g.dataset.point).join()); } return all; })()",
    );
    let all = all.as_array().expect("a list");
    assert_eq!(all.len(), touches.len());
    let mut dark = 0;
    for (row, shown) in all.iter().enumerate() {
        let shown = shown.as_str().expect("text");
        assert!(shown == "C" || shown.is_empty(), "{shown}");
        if touches[row] {
            assert_eq!(shown, "C", "row {row}");
        }
        dark += usize::from(shown.is_empty());
    }
    assert!(dark > 0, "it is dark where nothing touches");
    assert_eq!(page.complaints(), Vec::<String>::new());
}
