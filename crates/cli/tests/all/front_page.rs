//! A front in the report, in a real browser: points are clicked and gone along with keys, and every point's file runs.
#![cfg(unix)]

use std::fs;
use std::path::Path;

use crate::browser::Page;
use crate::support::{kempe, said};

/// A crank-rocker whose swing is to be large and whose transmission angle is to stay large; neither without the other.
const MODEL: &str = r#"title = "Swing against transmission"
units = { length = "mm", angle = "deg" }
[parameters]
a = "20 mm"
c = "40 mm"
[links]
frame = { A = [0, 0], D = [60, 0] }
crank = { A-B = "a" }
coupler = { B-C = 50 }
rocker = { D-C = "c" }
[drives]
motor = { turns = "crank", from = 0, to = 360, speed = "60 deg/s" }
[assembly]
C = "left of B -> D"
[measures]
swing = "range(angle(rocker))"
least = "min(transmission_angle(C))"
[studies.turn]
kind = "motion"
step = 5
columns = ["angle(rocker)"]
[studies.trade]
kind = "optimize"
over = "turn"
vary = { a = ["15 mm", "25 mm"], c = ["36 mm", "46 mm"] }
maximize = ["swing", "least"]
designs = 80
"#;

/// The table of the front as it is read from its file: heads, and rows of fields.
fn table(path: &Path) -> (Vec<String>, Vec<Vec<String>>) {
    let text = fs::read_to_string(path).expect("text");
    let mut lines = text
        .lines()
        .map(|line| line.split(',').map(str::to_owned).collect::<Vec<String>>());
    (lines.next().expect("a head"), lines.collect())
}

fn column(head: &[String], name: &str) -> usize {
    let place = head.iter().position(|h| h.starts_with(name));
    place.unwrap_or_else(|| panic!("no {name} in {head:?}"))
}

#[test]
fn a_front_is_clicked() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    fs::write(at.join("m.toml"), MODEL).expect("written");
    let ran = kempe(at, &["run", "m.toml", "trade", "--out", "out"]);
    let report = at.join("out/report.html");
    assert!(report.exists(), "{}", said(&ran));
    let told = String::from_utf8_lossy(&ran.stdout).into_owned();
    assert!(told.contains("hypervolume"), "{told}");
    let (head, rows) = table(&at.join("out/trade.csv"));
    let [a, swing, least] = ["a [", "swing", "least"].map(|name| column(&head, name));
    assert!(rows.len() > 3, "a front has points: {}", rows.len());
    let page = Page::start();
    for (size, phone, dark) in [([1400, 900], false, false), ([390, 844], true, true)] {
        page.open(&report, size, phone, dark);
        page.wait("document.querySelectorAll('.front .hit').length > 0");
        let count = page.number("document.querySelectorAll('.front .hit').length");
        assert_eq!(count, rows.len() as f64);
        let wide = page.number("document.documentElement.scrollWidth");
        assert!(wide <= f64::from(size[0]), "{wide} of {size:?}");
        assert_eq!(page.nameless(), Vec::<String>::new());
        // the last one, by a click on its point or a finger
        let last = rows.len() - 1;
        let point = format!(".front .hit:nth-of-type({})", last + 2);
        match phone {
            true => page.tap(page.place(&point, [0.5, 0.5])),
            false => page.click(&point),
        }
        page.wait(&format!(
            "document.querySelector({point:?}).getAttribute('aria-checked') === 'true'"
        ));
        is_shown(&page, last, &rows, [a, swing, least]);
        // the next one along the front, by a key; the player stays where it is
        let place = "+document.querySelector('.motion:not(.hidden) [data-in=row]').value";
        page.value("document.querySelector('.motion:not(.hidden) [data-do=play]').click()");
        let before = page.number(place);
        let order = {
            let mut order: Vec<usize> = (0..rows.len()).collect();
            let of = |k: &usize| rows[*k][swing].parse::<f64>().expect("a number");
            order.sort_by(|j, k| of(j).total_cmp(&of(k)));
            order
        };
        page.value("document.querySelector('.front .hit[aria-checked=true]').focus()");
        page.key("Home");
        is_shown(&page, order[0], &rows, [a, swing, least]);
        page.key("ArrowRight");
        is_shown(&page, order[1], &rows, [a, swing, least]);
        assert_eq!(page.number(place), before);
        let focused = page.text("document.activeElement.getAttribute('aria-checked')");
        assert_eq!(focused, "true", "the keys stay with the chosen one");
        // a row of the table
        page.click(".front tbody tr:nth-of-type(2)");
        is_shown(&page, 1, &rows, [a, swing, least]);
        // its mechanism moves, and stops
        let pose = "[...document.querySelectorAll('.chosen svg [data-part]')].map((g) => g.getAttribute('transform')).join()";
        let first = page.text(pose);
        page.wait(&format!("{pose} !== {first:?}"));
        page.click(".chosen [data-do=move]");
        let stopped = page.text(pose);
        page.value(
            "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))",
        );
        assert_eq!(page.text(pose), stopped);
        let (name, bytes) = page.saved(".front [data-tool=svg]");
        assert_eq!(name, "trade-front.svg");
        let svg = String::from_utf8(bytes).expect("text");
        let dots = svg.matches("<circle").count();
        assert!(dots > rows.len(), "{dots} dots, with the file's own");
        assert!(!svg.contains("var(") && !svg.contains("picked"));
        // one end has its motion with plots
        page.click(".front tbody tr:nth-of-type(1)");
        page.click(".chosen [data-do=motion]");
        page.wait("document.querySelector('.motion:not(.hidden) h2').textContent === 'trade-01'");
        assert_eq!(page.complaints(), Vec::<String>::new(), "at {size:?}");
    }
}

/// The point is marked in the picture and in the table; its numbers are those of the file, which is named.
fn is_shown(page: &Page, design: usize, rows: &[Vec<String>], columns: [usize; 3]) {
    let checked = "[...document.querySelectorAll('.front .hit')].map((h, k) => h.getAttribute('aria-checked') === 'true' ? k : '').join('')";
    assert_eq!(page.text(checked), design.to_string());
    let marked = "[...document.querySelectorAll('.front tbody tr')].map((r, k) => r.hasAttribute('aria-current') ? k : '').join('')";
    assert_eq!(page.text(marked), design.to_string());
    let file = page.text("document.querySelector('.chosen code').textContent");
    assert_eq!(file, format!("trade/{:02}.toml", design + 1));
    let ring = page.text(
        "(() => { const [r, h] = ['.picked', '.hit[aria-checked=true]'].map((s) => document.querySelector('.front ' + s)); \
         return String(['cx', 'cy'].every((a) => r.getAttribute(a) === h.getAttribute(a))); })()",
    );
    assert_eq!(ring, "true");
    for (k, name) in columns.into_iter().zip(["a", "swing", "least"]) {
        let told = page.text(&format!(
            "[...document.querySelectorAll('.chosen .facts div')].find((d) => d.firstChild.textContent === '{name}').lastChild.textContent"
        ));
        let told: f64 = told
            .split(' ')
            .next()
            .and_then(|t| t.parse().ok())
            .expect("a number");
        let known: f64 = rows[design][k].parse().expect("a number");
        assert!(
            (told - known).abs() <= 1e-5 * known.abs(),
            "{name}: {told} is not {known}"
        );
    }
    assert_eq!(
        page.number("document.querySelectorAll('.chosen svg').length"),
        1.0
    );
}

#[test]
fn every_point_of_a_front_is_a_file_that_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    fs::write(at.join("m.toml"), MODEL).expect("written");
    let ran = kempe(at, &["run", "m.toml", "trade", "--out", "out"]);
    let (head, rows) = table(&at.join("out/trade.csv"));
    assert!(rows.len() > 3, "{}", said(&ran));
    for (k, row) in rows.iter().enumerate() {
        let file = format!("out/trade/{:02}.toml", k + 1);
        let ran = kempe(at, &["run", &file, "turn", "--json"]);
        assert!(ran.status.success(), "{file}: {}", said(&ran));
        let answer: serde_json::Value = serde_json::from_slice(&ran.stdout).expect("JSON");
        let values = answer["studies"][0]["values"].as_array().expect("values");
        for name in ["swing", "least"] {
            let told = values.iter().find(|v| v["name"] == name).expect("a value");
            let told = told["value"].as_f64().expect("a number");
            let known: f64 = row[column(&head, name)].parse().expect("a number");
            assert!(
                (told - known).abs() < 1e-9 * known.abs(),
                "{file}: {name} = {told}, not {known}"
            );
        }
    }
}
