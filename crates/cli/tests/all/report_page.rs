//! The report of a run in a real browser: it plays, answers, saves and tells no error, on a desktop and on a phone.
#![cfg(unix)]

use crate::support;
use std::collections::BTreeSet;
use std::fs;
use std::io::Cursor;
use std::path::Path;

use crate::browser::Page;
use crate::support::kempe;
use kempe_number::math::{atan2, hypot};

/// A crank-rocker with a study of motion and one of forces. `root` has no value on a part of the turn; the rate of `speed`
/// is plotted and in no table.
const MODEL: &str = r#"title = "Crank-rocker <&>"
units = { length = "mm", angle = "deg" }
gravity = [0, "-9.81 m/s^2"]
[parameters]
a = "20 mm"
reach = "2*a"
[links]
frame = { A = [0, 0], D = [60, 0] }
crank = { A-B = "a", mass = "0.1 kg", inertia = 0 }
coupler = { B-C = 50, P = [25, 0], mass = "0.2 kg", inertia = 0 }
rocker = { D-C = 40, mass = "0.2 kg", inertia = 0 }
[drives]
motor = { turns = "crank", from = 0, to = 360, speed = "1 rad/s" }
[assembly]
C = "left of B -> D"
[measures]
swing = "angle(rocker)"
speed = "rate(swing)"
vx = "rate(x(P))"
vy = "rate(y(P))"
root = "sqrt(x(P)/reach - 0.5)"
[studies.turn]
kind = "motion"
step = 1
columns = ["swing", "speed", "vx", "vy", "root"]
plot = ["swing", ["speed", "angular_speed(coupler)"], "rate(speed)", "path(P)"]
[studies.loads]
kind = "forces"
step = 5
"#;

/// Selectors of the first study's parts, which is the one that shows.
const SHOWN: &str = ".motion:not(.hidden)";

/// A table as it is read from a CSV file without quotes: heads, and rows of fields.
struct Table {
    heads: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    fn read(text: &str) -> Table {
        let mut lines = text
            .lines()
            .map(|line| line.split(',').map(str::to_owned).collect::<Vec<String>>());
        Table {
            heads: lines.next().expect("a head"),
            rows: lines.collect(),
        }
    }

    fn number(&self, row: usize, head: &str) -> f64 {
        let column = self.heads.iter().position(|h| h == head);
        let field = &self.rows[row][column.unwrap_or_else(|| panic!("no {head}"))];
        field.parse().unwrap_or(f64::NAN)
    }
}

#[test]
fn the_report_works_in_a_browser() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    fs::write(at.join("m.toml"), MODEL).expect("written");
    let ran = kempe(
        at,
        &["run", "m.toml", "--out", "out", "--set", "reach=45mm"],
    );
    let report = at.join("out/report.html");
    assert!(report.exists(), "{}", support::said(&ran));
    let page = Page::start();
    for (size, phone, dark) in [([1400, 900], false, false), ([390, 844], true, true)] {
        page.open(&report, size, phone, dark);
        everything_is_in_sight(&page);
        it_plays_and_stops(&page);
        the_place_is_moved_by_hand(&page, phone);
        a_point_shows_how_it_moves(&page, at);
        what_is_chosen_is_plotted(&page, at);
        a_plot_is_enlarged(&page);
        what_is_saved_is_whole(&page, at);
        the_other_study_shows_its_forces(&page);
        everything_is_in_sight(&page);
        assert_eq!(page.complaints(), Vec::<String>::new(), "at {size:?}");
    }
}

/// Two designs on one page: the other one moves along, its curves are read out, saved and chosen with this one's.
#[test]
fn a_report_of_two_designs_works_in_a_browser() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    fs::write(at.join("m.toml"), MODEL).expect("written");
    // other rows, and an end before this one's
    let other = MODEL
        .replace("step = 1\n", "step = 4\n")
        .replace("to = 360", "to = 300");
    fs::write(at.join("other.toml"), other).expect("written");
    let runs: [(&str, &[&str]); 2] = [
        ("same", &["--against-set", "a=25mm"]),
        (
            "elsewhere",
            &["--against", "other.toml", "--against-set", "a=25mm"],
        ),
    ];
    let page = Page::start();
    for (out, arguments) in runs {
        let ran = kempe(
            at,
            &[
                &["run", "m.toml", "--set", "reach=45mm", "--out", out],
                arguments,
            ]
            .concat(),
        );
        let report = at.join(out).join("report.html");
        assert!(report.exists(), "{}", support::said(&ran));
        for (size, phone, dark) in [([1400, 900], false, false), ([390, 844], true, true)] {
            page.open(&report, size, phone, dark);
            everything_is_in_sight(&page);
            // a phone shows more than its width where something needs it
            let wide = page.number("document.documentElement.scrollWidth");
            assert!(wide <= f64::from(size[0]), "{wide} of {size:?}");
            it_plays_and_stops(&page);
            both_are_read_out(&page, &at.join(out));
            the_outline_moves_along(&page, out == "elsewhere");
            both_are_chosen_and_saved(&page);
            the_other_study_shows_its_forces(&page);
            everything_is_in_sight(&page);
            assert_eq!(page.complaints(), Vec::<String>::new(), "{out} at {size:?}");
        }
    }
}

/// Where the outline's crank pin stands on paper: a crank of 25 mm at the angle of this one, which is 20 mm long.
fn the_outline_moves_along(page: &Page, ends_before: bool) {
    let place = |selector: &str| {
        let centre = |axis: &str, size: &str| {
            page.number(&format!(
                "(() => {{ const b = document.querySelector('{SHOWN} {selector}').getBoundingClientRect(); return b.{axis} + b.{size} / 2; }})()"
            ))
        };
        [centre("x", "width"), centre("y", "height")]
    };
    // a bar's middle from the crank's pivot, which both have; both bars are as wide
    let length = |selector: &str| {
        page.number(&format!(
            "(() => {{ const b = document.querySelector('{SHOWN} {selector} path').getBBox(); return Math.max(b.width, b.height); }})()"
        ))
    };
    let wide = 2.0 * 1.7;
    let (own, other) = (
        length(".link-1") - wide,
        length(".other[data-part=\"0\"]") - wide,
    );
    assert!((other / own - 1.25).abs() < 0.01, "{own}, {other}");
    page.key("Home");
    let before = place(".other[data-part=\"0\"]");
    for _ in 0..9 {
        page.value("document.body.dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowRight', shiftKey: true, bubbles: true }))");
    }
    let after = place(".other[data-part=\"0\"]");
    assert!(
        hypot(after[0] - before[0], after[1] - before[1]) > 5.0,
        "{before:?} {after:?}"
    );
    assert!(row(page) > 80.0);
    let turned = |selector: &str| {
        page.text(&format!(
            "document.querySelector('{SHOWN} {selector}').getAttribute('transform').match(/rotate\\((.*?)\\)/)[1]"
        ))
    };
    let (this, against): (f64, f64) = (
        turned(".link-1").parse().expect("a number"),
        turned(".other[data-part=\"0\"]").parse().expect("a number"),
    );
    assert!((this - against).abs() < 2.1, "{this}, {against}");
    page.key("End");
    let shown = page.text(&format!(
        "document.querySelector('{SHOWN} .other[data-part=\"0\"]').getAttribute('visibility')"
    ));
    assert_eq!(shown, if ends_before { "hidden" } else { "visible" });
    let display = format!(
        "getComputedStyle(document.querySelector('{SHOWN} .other[data-part=\"0\"]')).display"
    );
    let switch = || page.click(&format!("{SHOWN} [data-in=other]"));
    switch();
    page.wait(&format!("{display} === 'none'"));
    switch();
    page.wait(&format!("{display} === 'inline'"));
}

/// At 120 deg, where both have a row: the values are those of the two tables.
fn both_are_read_out(page: &Page, out: &Path) {
    page.value(&format!(
        "(() => {{ const i = document.querySelector('{SHOWN} [data-in=drive]'); i.value = 120; i.dispatchEvent(new Event('change')); i.blur(); }})()"
    ));
    let at_120 = |file: &str| {
        let table = Table::read(&fs::read_to_string(out.join(file)).expect("text"));
        let mut rows = 0..table.rows.len();
        let row = rows.find(|row| (table.number(*row, "motor [deg]") - 120.0).abs() < 1e-9);
        table.number(row.expect("a row"), "swing [deg]")
    };
    let cells = |k: usize| {
        page.text(&format!(
            "[...document.querySelectorAll('{SHOWN} .readout tr')].find((r) => r.cells[0].textContent === 'swing').cells[{k}].textContent"
        ))
    };
    for (k, file) in [(1, "turn.csv"), (2, "turn.against.csv")] {
        let (told, expected) = (cells(k).parse::<f64>().expect("a number"), at_120(file));
        assert!(
            (told - expected).abs() < 1e-3,
            "{file}: {told} is not {expected}"
        );
    }
    // under the pointer both are told
    let [x, y] = page.place(&format!("{SHOWN} .plot svg"), [0.5, 0.5]);
    page.mouse("mouseMoved", [x, y]);
    let tip = page.text(&format!("document.querySelector('{SHOWN} .tip').innerText"));
    assert!(
        tip.contains("swing = ") && tip.contains("swing, against = "),
        "{tip}"
    );
    page.mouse("mouseMoved", [2.0, 2.0]);
}

fn both_are_chosen_and_saved(page: &Page) {
    choose(page, "y", "vx [mm/s]");
    choose(page, "x", "motor [deg]");
    let picture =
        format!("document.querySelector('{SHOWN} .choose').closest('.plot').querySelector('svg')");
    let dashes = format!(
        "[...{picture}.querySelectorAll('g[clip-path] path')].map((p) => p.getAttribute('stroke-dasharray')).join()"
    );
    assert_eq!(page.text(&dashes), "none,7 5");
    choose(page, "with", "vy");
    assert_eq!(page.text(&dashes), "none,none,7 5,7 5");
    choose(page, "x", "swing [deg]");
    choose(page, "x", "row");
    let (name, bytes) = page.saved(&format!("{SHOWN} [data-tool=svg]"));
    assert_eq!(name, "turn-swing.svg");
    let svg = String::from_utf8(bytes).expect("text");
    assert!(svg.contains(">this</text>") && svg.contains(">against</text>"));
    assert!(svg.contains("stroke-dasharray=\"7 5\"") && !svg.contains("var("));
    let (picture, pixels) = saved_png(page);
    let mut colors = pixels[..picture.buffer_size()].chunks(picture.color_type.samples());
    assert!(
        colors.any(|c| c.starts_with(&[0xe6, 0x9f, 0x00])),
        "the other curve"
    );
}

/// The plot that is shown, saved as PNG.
fn saved_png(page: &Page) -> (png::OutputInfo, Vec<u8>) {
    let (name, bytes) = page.saved(&format!("{SHOWN} [data-tool=png]"));
    assert_eq!(name, "turn-swing.png");
    let mut reader = png::Decoder::new(Cursor::new(bytes))
        .read_info()
        .expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    let picture = reader.next_frame(&mut pixels).expect("a picture");
    (picture, pixels)
}

/// The page is no wider than the window, and what can be used has a name.
fn everything_is_in_sight(page: &Page) {
    page.wait(&format!(
        "document.querySelectorAll('{SHOWN} .sheet svg path').length > 0"
    ));
    let [wide, window] =
        ["document.documentElement.scrollWidth", "innerWidth"].map(|x| page.number(x));
    assert!(
        wide <= window,
        "the page is {wide} wide in a window of {window}"
    );
    assert_eq!(page.nameless(), Vec::<String>::new());
    // text of one size on every plot, and none beyond its picture
    let sizes = page.text(&format!(
        "[...new Set([...document.querySelectorAll('{SHOWN} .sheet text')].map((t) => getComputedStyle(t).fontSize))].join()"
    ));
    assert_eq!(sizes, "12px");
    let outside = page.text(&format!(
        "[...document.querySelectorAll('{SHOWN} .sheet text')].filter((t) => {{ const a = t.getBoundingClientRect(), \
         b = t.ownerSVGElement.getBoundingClientRect(); \
         return a.left < b.left - 1 || a.right > b.right + 1 || a.top < b.top - 1 || a.bottom > b.bottom + 1; }}) \
         .map((t) => t.textContent).join()"
    ));
    assert_eq!(outside, "", "texts beyond their pictures");
}

fn row(page: &Page) -> f64 {
    page.number(&format!(
        "+document.querySelector('{SHOWN} [data-in=row]').value"
    ))
}

fn it_plays_and_stops(page: &Page) {
    let before = row(page);
    page.wait(&format!(
        "+document.querySelector('{SHOWN} [data-in=row]').value !== {before}"
    ));
    page.value("document.activeElement.blur()");
    page.key(" ");
    let button = format!("document.querySelector('{SHOWN} [data-do=play]')");
    assert_eq!(
        page.text(&format!("{button}.getAttribute('aria-pressed')")),
        "false"
    );
    let stopped = row(page);
    page.value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))");
    assert_eq!(row(page), stopped);
}

/// By keys, and by a click on a plot: where the axis says 180 the motor stands at 180.
fn the_place_is_moved_by_hand(page: &Page, phone: bool) {
    page.key("End");
    assert_eq!(row(page), 360.0);
    page.key("Home");
    page.key("ArrowRight");
    assert_eq!(row(page), 1.0);
    let [_, y] = page.place(&format!("{SHOWN} .plot svg"), [0.5, 0.4]);
    let tick = format!(
        "(() => {{ const t = [...document.querySelectorAll('{SHOWN} .plot svg text')].find((t) => t.textContent === '180'); \
         const b = t.getBoundingClientRect(); return b.x + b.width / 2; }})()"
    );
    let there = [page.number(&tick), y];
    page.mouse("mouseMoved", there);
    let tip = page.text(&format!("document.querySelector('{SHOWN} .tip').innerText"));
    let lines: Vec<&str> = tip.lines().filter(|l| !l.is_empty()).collect();
    assert!(
        lines[0].starts_with("motor = 1") && lines[0].ends_with(" deg"),
        "{tip}"
    );
    assert!(
        lines[1].starts_with("swing = 1") && lines[1].ends_with(" deg"),
        "{tip}"
    );
    page.mouse("mousePressed", there);
    page.mouse("mouseReleased", there);
    assert!((row(page) - 180.0).abs() <= 2.0, "{}", row(page));
    let line = format!("document.querySelector('{SHOWN} .plot .cursor')");
    let at = page.number(&format!(
        "(() => {{ const b = {line}.getBoundingClientRect(); return b.x + b.width / 2; }})()"
    ));
    assert!(
        (at - there[0]).abs() < 4.0,
        "the line stands at {at}, not at {}",
        there[0]
    );
    let shown = format!("!document.querySelector('{SHOWN} .tip').hidden");
    if phone {
        // what a finger asked for stays when it is lifted, until the next touch
        page.tap([there[0] - 60.0, there[1]]);
        page.wait(&format!(
            "{shown} && +document.querySelector('{SHOWN} [data-in=row]').value < 150"
        ));
        page.tap(page.place("h1", [0.5, 0.5]));
        page.wait(&format!("!({shown})"));
    } else {
        // with keys alone: the plot is reached, and tells the place of the player
        page.mouse("mouseMoved", [5.0, 5.0]);
        page.value(&format!(
            "document.querySelector('{SHOWN} [data-do=csv]').focus()"
        ));
        page.key("Tab");
        page.wait(&shown);
        page.key("End");
        page.wait(&format!(
            "document.querySelector('{SHOWN} .tip').innerText.startsWith('motor = 360 deg')"
        ));
        page.key("Tab");
        page.wait(&format!("!({shown})"));
    }
}

/// The velocity of P is that of the table, which is its measured rate.
fn a_point_shows_how_it_moves(page: &Page, at: &Path) {
    let arrow = format!("document.querySelector('{SHOWN} .vector-velocity')");
    assert_eq!(
        page.text(&format!("getComputedStyle({arrow}).display")),
        "none"
    );
    page.click(&format!("{SHOWN} [data-vector=velocity]"));
    assert_eq!(
        page.text(&format!("getComputedStyle({arrow}).display")),
        "inline"
    );
    let table = Table::read(&fs::read_to_string(at.join("out/turn.csv")).expect("text"));
    let (row, line) = (
        row(page) as usize,
        format!(
            "[...document.querySelectorAll('{SHOWN} .moving tr')].find((r) => r.textContent.startsWith('velocity of P'))"
        ),
    );
    let [vx, vy] = ["vx [mm/s]", "vy [mm/s]"].map(|head| table.number(row, head));
    let cell = |k: usize| page.text(&format!("{line}.cells[{k}].textContent"));
    let size: f64 = cell(1).parse().expect("a number");
    assert!(
        (size - hypot(vx, vy)).abs() < 1e-3 * size,
        "{size} is not {}",
        hypot(vx, vy)
    );
    let direction: f64 = cell(3)
        .trim_start_matches("at ")
        .trim_end_matches(" deg")
        .parse()
        .expect("a number");
    assert!(
        (direction - atan2(vy, vx).to_degrees()).abs() < 0.2,
        "{direction}"
    );
    page.click(&format!("{SHOWN} [data-vector=velocity]"));
}

fn choose(page: &Page, list: &str, name: &str) {
    page.value(&format!(
        "(() => {{ const s = document.querySelector('{SHOWN} [data-choose={list}]'); \
         const o = [...s.options].find((o) => o.text === {name:?}); s.value = o.value; s.dispatchEvent(new Event('change')); }})()"
    ));
}

/// The chosen columns are those of the file; where one has no value, its curve has a gap.
fn what_is_chosen_is_plotted(page: &Page, at: &Path) {
    choose(page, "y", "root");
    choose(page, "x", "time [s]");
    let picture =
        format!("document.querySelector('{SHOWN} .choose').closest('.plot').querySelector('svg')");
    assert_eq!(
        page.text(&format!("{picture}.getAttribute('aria-label')")),
        "root over time"
    );
    let table = Table::read(&fs::read_to_string(at.join("out/turn.csv")).expect("text"));
    let known: Vec<bool> = (0..table.rows.len())
        .map(|row| table.number(row, "root [1]").is_finite())
        .collect();
    let stretches = known
        .iter()
        .enumerate()
        .filter(|(k, here)| **here && (*k == 0 || !known[k - 1]))
        .count();
    assert!(
        stretches > 0 && known.contains(&false),
        "the model has a gap"
    );
    let starts = page.number(&format!(
        "{picture}.querySelector('g[clip-path] path').getAttribute('d').split('M').length - 1"
    ));
    assert_eq!(starts, stretches as f64);
    choose(page, "x", "row");
    choose(page, "y", "rate(speed) [rad/s^2]");
    assert_eq!(
        page.text(&format!("{picture}.getAttribute('aria-label')")),
        "rate(speed) over row"
    );
    let details = format!("{SHOWN} .plot:has(.choose) summary");
    page.click(&details);
    let cells =
        format!("document.querySelectorAll('{SHOWN} .plot:has(.choose) tbody tr')[100].cells");
    page.wait(&format!(
        "document.querySelectorAll('{SHOWN} .plot:has(.choose) tbody tr').length === 361"
    ));
    assert_eq!(page.text(&format!("{cells}[0].textContent")), "101");
    // the second derivative of the table's own angle, by differences of 1 deg
    let swing = |row| table.number(row, "swing [deg]");
    let step = table.number(1, "time [s]");
    let bend = (swing(101) - 2.0 * swing(100) + swing(99)).to_radians() / (step * step);
    let told: f64 = page
        .text(&format!("{cells}[1].textContent"))
        .parse()
        .expect("a number");
    assert!(
        (told - bend).abs() < 1e-3 * bend.abs().max(0.1),
        "{told} is not {bend}"
    );
    page.click(&details);
}

fn a_plot_is_enlarged(page: &Page) {
    let wide = || {
        page.number(&format!("document.querySelector('{SHOWN} .plot svg, dialog .plot svg').getBoundingClientRect().width"))
    };
    let before = wide();
    page.click(&format!("{SHOWN} [data-tool=enlarge]"));
    page.wait("document.querySelector('dialog').open");
    let large = page.number("document.querySelector('dialog svg').getBoundingClientRect().width");
    let window = page.number("innerWidth");
    assert!(
        large > 0.85 * window && large <= window,
        "{large} in a window of {window}"
    );
    page.key("Escape");
    page.wait("!document.querySelector('dialog').open");
    assert_eq!(page.text("document.activeElement.dataset.tool"), "enlarge");
    page.wait(&format!(
        "document.querySelector('{SHOWN} .plot svg').getBoundingClientRect().width === {before}"
    ));
}

/// A picture as SVG and PNG, and the table as the run's own file.
fn what_is_saved_is_whole(page: &Page, at: &Path) {
    let (name, bytes) = page.saved(&format!("{SHOWN} [data-tool=svg]"));
    assert_eq!(name, "turn-swing.svg");
    let svg = String::from_utf8(bytes).expect("text");
    assert!(
        svg.starts_with("<svg") && svg.contains("xmlns=") && svg.trim_end().ends_with("</svg>")
    );
    assert!(svg.contains("swing [deg]") && svg.contains("motor [deg]"));
    assert!(
        !svg.contains("var(") && !svg.contains("cursor"),
        "it stands by itself"
    );

    let (picture, pixels) = saved_png(page);
    let box_ = page.value(&format!(
        "document.querySelector('{SHOWN} .plot svg').getAttribute('viewBox').split(' ').map(Number)"
    ));
    let size = [2, 3].map(|k| 2 * box_[k].as_u64().expect("a number") as u32);
    assert_eq!(
        [picture.width, picture.height],
        size,
        "twice as fine as the page"
    );
    let colors: BTreeSet<&[u8]> = pixels[..picture.buffer_size()]
        .chunks(picture.color_type.samples())
        .collect();
    let has = |rgb: [u8; 3]| colors.iter().any(|c| c.starts_with(&rgb));
    assert!(
        has([0xff, 0xff, 0xff]) && has([0x00, 0x72, 0xb2]),
        "a blue curve on white paper"
    );

    let (name, bytes) = page.saved(&format!("{SHOWN} [data-do=csv]"));
    assert_eq!(name, "turn.csv");
    let saved = String::from_utf8(bytes).expect("text");
    let file = fs::read_to_string(at.join("out/turn.csv")).expect("text");
    assert_eq!(saved.lines().count(), file.lines().count());
    for (saved, own) in saved.lines().zip(file.lines()) {
        assert!(saved.starts_with(&format!("{own},")), "{saved}\n{own}");
    }
    let head = saved.lines().next().unwrap_or("");
    assert!(
        head.ends_with(
            ",note,angular_speed(coupler) [rad/s],rate(speed) [rad/s^2],x(P) [mm],y(P) [mm]"
        ),
        "{head}"
    );
}

fn the_other_study_shows_its_forces(page: &Page) {
    page.click("[role=tab]:nth-of-type(2)");
    page.wait(&format!(
        "document.querySelector('{SHOWN}').dataset.motion === '1'"
    ));
    page.wait(&format!(
        "document.querySelectorAll('{SHOWN} .load path').length > 0"
    ));
    page.click(&format!("{SHOWN} [data-role=reaction]"));
    let shown =
        format!("getComputedStyle(document.querySelector('{SHOWN} .load-reaction')).display");
    assert_eq!(page.text(&shown), "none");
    page.wait(
        "[...document.querySelectorAll('td')].some((c) => c.textContent === '--set reach=45mm')",
    );
    page.wait("document.querySelector('.source pre').textContent.includes('root = \"sqrt(x(P)/reach - 0.5)\"')");
}
