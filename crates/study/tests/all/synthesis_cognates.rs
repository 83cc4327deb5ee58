//! Studies that ask how else a coupler curve is traced: the cognates, and bodies that go along it without turning, moved again.

use crate::beside::{HEAD, SYMMETRIC, code, column, found, moved, random_bar, tried};
use kempe_number::Random;
use kempe_study::{FoundDesign, StudyResult};

fn asked(more: &str) -> String {
    format!("\n[studies.s]\nkind = \"synthesize\"\ntask = \"cognates\"\npoint = \"P\"\n{more}\n")
}

/// Hoeken's line: its pivots, the point and the coupler's pins are in line.
const HOEKEN: &str = r#"[links]
frame   = { A = [0, 0], D = [40, 0] }
crank   = { A-B = 20 }
coupler = { B-P = 100, C = [50, 0] }
rocker  = { D-C = 50 }
[drives]
motor = { turns = "crank", from = 0, to = 360, speed = "60 rpm" }
[assembly]
C = "left of B -> D"
"#;

/// The way of a point of the file's own mechanism, in mm.
fn way(bar: &str) -> Vec<[f64; 2]> {
    let study = "[studies.s]\nkind = \"motion\"\nrows = 1441\ncolumns = [\"x(P)\", \"y(P)\"]\n";
    let own = found(&format!("{bar}{study}"));
    let (x, y) = (column(&own, "x(P)"), column(&own, "y(P)"));
    x.into_iter().zip(y).map(|(x, y)| [x, y]).collect()
}

/// How far places are from a way's nearest segment at most, mm.
fn off(places: &[[f64; 2]], way: &[[f64; 2]]) -> f64 {
    let from_segment = |p: &[f64; 2], a: &[f64; 2], b: &[f64; 2]| {
        let along = [b[0] - a[0], b[1] - a[1]];
        let whole = along[0] * along[0] + along[1] * along[1];
        let part = ((p[0] - a[0]) * along[0] + (p[1] - a[1]) * along[1]) / whole;
        let part = part.clamp(0.0, 1.0);
        kempe_number::math::hypot(p[0] - a[0] - part * along[0], p[1] - a[1] - part * along[1])
    };
    let nearest = |p: &[f64; 2]| {
        let pairs = way.windows(2);
        pairs
            .map(|ab| from_segment(p, &ab[0], &ab[1]))
            .fold(f64::INFINITY, f64::min)
    };
    places.iter().map(nearest).fold(0.0, f64::max)
}

/// The way of the point in each file found, mm.
fn places(result: &StudyResult) -> Vec<Vec<[f64; 2]>> {
    let designs = result.designs.iter();
    let own = designs.map(|design| {
        let own = with_columns(design, &["x(P)", "y(P)"]);
        assert!(own.diagnostics.is_empty(), "{:?}", own.diagnostics);
        let (x, y) = (column(&own, "x(P)"), column(&own, "y(P)"));
        x.into_iter().zip(y).map(|(x, y)| [x, y]).collect()
    });
    own.collect()
}

/// A file that was found, moved with other columns.
fn with_columns(design: &FoundDesign, columns: &[&str]) -> StudyResult {
    let mut file = design.file.clone();
    let text = file
        .toml
        .replace("plot = [", &format!("columns = {columns:?}, plot = ["));
    let line = file
        .toml
        .replace("\nplot = [", &format!("\ncolumns = {columns:?}\nplot = ["));
    file.toml = if line == file.toml { text } else { line };
    assert!(file.toml.contains("columns"), "{}", file.toml);
    moved(&file)
}

/// How many bodies do not turn; all that are accepted do not, and their far end goes as the point does.
fn assert_parallel(result: &StudyResult) -> usize {
    let turn = column(result, "turn");
    for (design, turn) in result.designs.iter().zip(&turn) {
        assert!(turn.abs() < 1e-7, "{turn}");
        let own = with_columns(design, &["x(P)", "y(P)", "x(F)", "y(F)"]);
        for axis in ["x", "y"] {
            let [p, f] = ["P", "F"].map(|point| column(&own, &format!("{axis}({point})")));
            let apart: Vec<f64> = p.iter().zip(&f).map(|(p, f)| f - p).collect();
            let most = apart
                .iter()
                .map(|by| (by - apart[0]).abs())
                .fold(0.0, f64::max);
            assert!(most < 1e-6, "{most}: {}", design.file.toml);
            let goes = p.iter().map(|x| (x - p[0]).abs()).fold(0.0, f64::max);
            assert!(goes > 1.0, "{goes}");
        }
    }
    result.designs.len()
}

#[test]
fn hoekens_line_has_chebyshevs_for_a_cognate() {
    let result = found(&format!("{HEAD}{HOEKEN}{}", asked("")));
    let own = way(&format!("{HEAD}{HOEKEN}"));
    let [crank, coupler, rocker, ground] =
        ["crank_length", "coupler_length", "rocker_length", "ground"]
            .map(|name| column(&result, name));
    // The cognate whose crank turns is Hoeken's again, from the other side; the third is Chebyshev's, which does not turn.
    assert_eq!(crank.len(), 1, "{:?}", result.listings);
    for (length, wanted) in [
        (crank[0], 20.0),
        (coupler[0], 50.0),
        (rocker[0], 50.0),
        (ground[0], 40.0),
    ] {
        assert!((length - wanted).abs() < 1e-9, "{length} {wanted}");
    }
    assert!(column(&result, "miss")[0] < 1e-10);
    for places in places(&result) {
        assert!(off(&places, &own) < 2e-4);
        assert!(off(&own, &places) < 2e-2);
    }
    let rejected = &result.listings.last().expect("a list").rows;
    assert_eq!(rejected.len(), 3, "{rejected:?}");
    assert!(
        rejected[0][0].contains("ground 80 mm, crank 100 mm, coupler 40 mm, rocker 100 mm"),
        "{rejected:?}"
    );
}

#[test]
fn cognates_trace_the_whole_curve() {
    let mut random = Random(5);
    let mut count = 0;
    for _ in 0..12 {
        let bar = random_bar(&mut random);
        let result = found(&format!("{bar}{}", asked("")));
        let own = way(&bar);
        for places in places(&result) {
            assert!(off(&places, &own) < 1e-2, "{}", off(&places, &own));
            assert!(off(&own, &places) < 0.2, "{}", off(&own, &places));
            count += 1;
        }
        // Two cognates, each driven at either link.
        let scalar = |name: &str| {
            result
                .scalars
                .iter()
                .find(|s| s.name == name)
                .map(|s| s.value)
        };
        assert_eq!(scalar("linkages"), Some(4.0));
        assert!(scalar("accepted") >= Some(1.0));
    }
    assert!(count >= 12);
}

#[test]
fn bodies_follow_without_turning() {
    let mut random = Random(11);
    let mut count = 0;
    for _ in 0..12 {
        let bar = random_bar(&mut random);
        let result = found(&format!("{bar}{}", asked("parallel = true")));
        count += assert_parallel(&result);
    }
    assert!(count >= 12, "{count}");
    for bar in [SYMMETRIC, HOEKEN] {
        let result = found(&format!("{HEAD}{bar}{}", asked("parallel = true")));
        assert!(assert_parallel(&result) > 0);
        assert!(
            result
                .designs
                .iter()
                .all(|it| !bar.contains('#') || it.file.toml.contains("# two pivots"))
        );
    }
}

#[test]
fn a_drawn_mechanism_gets_a_body_too() {
    let drawn = r#"[places]
A = [0, 0]
B = [-40, 0]
C = [40, 126.886]
D = [120, 0]
P = [182.844, 172.661]
[links]
frame   = ["A", "D"]
crank   = ["A", "B"]
coupler = ["B", "C", "P"]
rocker  = ["D", "C"]
[drives]
motor = { turns = "crank", from = 0, to = 360, speed = "60 rpm" }
"#;
    let result = found(&format!("{HEAD}{drawn}{}", asked("parallel = true")));
    assert!(assert_parallel(&result) > 0);
    assert!(
        !found(&format!("{HEAD}{drawn}{}", asked("")))
            .designs
            .is_empty()
    );
}

#[test]
fn a_part_of_the_curve_and_other_drives_do() {
    let part = HOEKEN.replace("from = 0, to = 360", "from = 120, to = 240");
    let result = found(&format!("{HEAD}{part}{}", asked("")));
    // On a part of it Chebyshev's linkage is led by its rockers, too.
    assert!(result.designs.len() > 1, "{:?}", result.listings);
    assert!(column(&result, "miss").iter().all(|miss| *miss < 1e-9));
    let back = HOEKEN.replace(
        "turns = \"crank\", from = 0, to = 360",
        "turns = \"rocker\", from = 110, to = 140",
    );
    for more in ["", "parallel = true"] {
        let result = found(&format!("{HEAD}{back}{}", asked(more)));
        assert!(!result.designs.is_empty(), "{more}");
    }
}

#[test]
fn names_that_the_file_has_are_left_to_it() {
    let named = SYMMETRIC
        .replace("B-C = 150, ", "B-C = 150, F = [10, 10], E = [5, 5], ")
        .replace(
            "[drives]",
            "[parameters]\nrod_length = 3\n[measures]\nturn = \"angle(coupler)\"\n[drives]",
        );
    let result = found(&format!(
        "{HEAD}{named}{}",
        asked("parallel = true\naccept = [\"turn2 <= 1e-6 deg\"]")
    ));
    assert!(!result.designs.is_empty());
    assert!(
        result.designs[0].file.toml.contains("E2-F2"),
        "{}",
        result.designs[0].file.toml
    );
}

#[test]
fn bad_requests_say_what_is_wrong() {
    let with = |bar: &str, point: &str| {
        format!(
            "{HEAD}{bar}{}",
            asked("").replace("\"P\"", &format!("\"{point}\""))
        )
    };
    assert_eq!(code(&with(SYMMETRIC, "D")), "bad-choice");
    assert_eq!(code(&with(SYMMETRIC, "C")), "bad-choice");
    assert_eq!(code(&with(SYMMETRIC, "X")), "unknown-name");
    let slider = r#"[links]
frame  = { A = [0, 0], E = [0, -5], F = [100, -5] }
crank  = { A-B = 20 }
rod    = { B-C = 60, P = [30, 12] }
piston = { C = [0, 0] }
[joints]
guide = { slider = "piston", at = "C", on = "E -> F" }
[drives]
motor = { turns = "crank", from = 0, to = 360, speed = "60 rpm" }
[assembly]
C = { near = [80, -5] }
"#;
    assert_eq!(code(&with(slider, "P")), "bad-choice");
    let told = tried(&with(slider, "P")).expect_err("no four-bar");
    assert!(told[0].message.contains("coupler"), "{}", told[0].message);
    let beyond = SYMMETRIC.replace("D = [120, 0]", "D = [300, 0]");
    assert_eq!(code(&with(&beyond, "P")), "not-reached");
}
