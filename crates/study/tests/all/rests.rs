//! What lies on stops, strikes them beside links that are driven, and passes dead points where it rubs.
#![allow(clippy::unwrap_used)]

use kempe_model::Model;
use kempe_study::{Silent, StudyResult, run};

fn result(text: &str) -> StudyResult {
    let read = Model::from_toml(text, "rests", &mut |_| Err("no files".into()));
    let model = read.unwrap().model;
    run(&model, &model.studies[0], &mut Silent).unwrap()
}

fn column<'r>(result: &'r StudyResult, name: &str) -> &'r [f64] {
    &result.table.column(name).unwrap().values
}

/// The largest of what is a number, without its sign.
fn worst(column: &[f64]) -> f64 {
    let sizes = column.iter().filter(|x| x.is_finite());
    sizes.fold(0.0_f64, |most, x| most.max(x.abs()))
}

fn balances(result: &StudyResult, what: &str) {
    let balance = result.table.balance.as_ref().unwrap();
    assert!(
        worst(&balance.energy) < 1e-9,
        "{what}: {:e}",
        worst(&balance.energy)
    );
    assert!(
        worst(&balance.power) < 1e-6,
        "{what}: {:e}",
        worst(&balance.power)
    );
    assert_eq!(result.table.unreached(), 0, "{what}");
}

/// An arm on a base that is driven in jerks, between stops in the frame: told by its angle in the frame and by that against the
/// base it is one mechanism, and what the base's drive gives against the impacts is counted.
#[test]
fn stops_hold_what_hangs_on_a_driven_link_however_it_is_told() {
    const ARM: &str = r#"
units = { length = "m", angle = "deg" }
[links]
frame = { O = [0, 0] }
base  = { O-A = 1 }
arm   = { A-B = 0.5, mass = "2 kg", inertia = "0.3 kg m^2", center = [0.3, 0] }
[drives]
g = { turns = "base", from = 0, law = [{ dwell = "0.3 s" }, { rise = 20, speed = "200 deg/s" }, { dwell = "0.2 s" }, { fall = 20, speed = "300 deg/s" }] }
m = { turns = "arm", TOLD at = 0 }
[studies.s]
kind    = "simulate"
release = "m"
until   = "1.5 s"
rows    = 151
stops   = { arm = { between = ["-20 deg", "none"], restitution = GIVEN } }
columns = ["angle(arm)", "angular_speed(arm)"]
"#;
    for given in ["0", "0.5"] {
        let [apart, against] = ["", "relative_to = \"base\","].map(|told| {
            let text = ARM.replace("TOLD", told).replace("GIVEN", given);
            result(&text)
        });
        for (it, what) in [(&apart, "in the frame"), (&against, "against the base")] {
            balances(it, &format!("{what}, {given}"));
            let angle = column(it, "angle(arm)");
            assert!(angle.iter().all(|a| *a > -20.0 - 1e-9), "{what} {given}");
            for (row, note) in it.table.notes.iter().enumerate() {
                if note.as_deref().is_some_and(|n| n.contains("lies on")) {
                    assert!((angle[row] + 20.0).abs() < 1e-9, "{what}: {}", angle[row]);
                }
            }
        }
        let lies = |it: &StudyResult| it.table.notes.iter().flatten().count();
        assert_eq!(lies(&apart), lies(&against), "{given}");
        assert!(given != "0" || lies(&apart) > 20);
        for name in ["angle(arm)", "angular_speed(arm)"] {
            let pairs = column(&apart, name).iter().zip(column(&against, name));
            let off = pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
            assert!(off < 1e-6, "{name} {given}: {off:e}");
        }
    }
}

/// Two contacts at once stay where they are, as long as they are looked at.
#[test]
fn what_lies_on_two_stops_stays_there() {
    const BEAM: &str = r#"
units = { length = "mm", angle = "deg" }
gravity = [0, "-9.81 m/s^2"]
[links]
frame = { O = [0, 0], X = [0, 1000] }
post  = { C = [0, 0], mass = "0.2 kg", inertia = "50 kg mm^2" }
beam  = { C = [0, 0], L = [-200, 0], R = [200, 0], mass = "1 kg", inertia = "3000 kg mm^2", center = "C" }
[joints]
way = { slider = "post", at = "C", on = "O -> X" }
[drives]
lift = { slides = "way", at = "100 mm" }
tilt = { turns = "beam", relative_to = "post", at = 0 }
[measures]
left  = "y(L) - 50 mm"
right = "y(R) - 50 mm"
[studies.s]
kind    = "simulate"
start   = { tilt = "-87 deg" }
until   = "10 s"
step    = "0.5 s"
stops   = { left = { between = ["0 mm", "none"], restitution = 0.3 }, right = { between = ["0 mm", "none"], restitution = 0.3 } }
columns = ["left", "right"]
"#;
    let beam = result(BEAM);
    balances(&beam, "beam");
    for name in ["left", "right"] {
        let rests = &column(&beam, name)[4..];
        assert!(worst(rests) < 1e-8, "{name}: {:e} mm", worst(rests));
    }
    // A block that falls by its play of 0.1 mm, and lies on its guide for as long again as it fell a thousand times.
    const BLOCK: &str = r#"
units = { length = "mm" }
gravity = [0, "-9.81 m/s^2"]
[links]
frame = { O = [0, 0], X = [1000, 0] }
block = { C = [0, 0], mass = "1 kg", inertia = "500 kg mm^2" }
[joints]
way = { slider = "block", at = "C", on = "O -> X" }
[drives]
travel = { slides = "way", at = "100 mm" }
[clearance]
way = { radial = "0.1 mm", length = "40 mm", height = "20 mm", law = "rigid", restitution = 0.3 }
[studies.s]
kind    = "clearance"
model   = "three-state"
release = "travel"
until   = "10 s"
step    = "0.5 s"
columns = ["y(C)", "reaction(way)"]
"#;
    let block = result(BLOCK);
    balances(&block, "block");
    let fallen = column(&block, "y(C)")[1..]
        .iter()
        .map(|y| y + 0.1)
        .collect::<Vec<_>>();
    assert!(worst(&fallen) < 1e-9, "{:e} mm", worst(&fallen));
    assert!(
        column(&block, "way touching")[1..]
            .iter()
            .all(|n| *n == 2.0)
    );
    let weight = column(&block, "reaction(way)")[1..]
        .iter()
        .map(|n| n - 9.81)
        .collect::<Vec<_>>();
    assert!(worst(&weight) < 1e-9, "{:e} N", worst(&weight));
    // It falls and bounces for 8.4 ms of the 10 s; what lies on its guide touches it.
    let counted = block.listings.iter().find(|it| it.title == "Contacts");
    assert_eq!(counted.unwrap().rows[0][4], "99.9 %");
}

/// Friction jams a rocker long before its crank's dead point, not the mechanism.
#[test]
fn where_friction_jams_what_is_let_go_a_link_tells_the_place() {
    for (coefficient, radius) in [(0.2, 5), (0.3, 3), (0.1, 9)] {
        let text = format!(
            r#"
units = {{ length = "mm" }}
[links]
frame   = {{ A = [0, 0], D = [60, 0] }}
crank   = {{ A-B = 20, mass = "0.3 kg", inertia = "100 kg mm^2", center = [8, 3] }}
coupler = {{ B-C = 50, mass = "0.5 kg", inertia = "110 kg mm^2", center = [20, 5] }}
rocker  = {{ D-C = 40, mass = "0.4 kg", inertia = "60 kg mm^2", center = [15, -4] }}
[assembly]
C = "left of B -> D"
B = "left of A -> C"
[drives]
n = {{ turns = "rocker", at = 100.87923888412327 }}
[friction]
all = {{ coefficient = {coefficient}, radius = "{radius} mm" }}
[studies.s]
kind    = "simulate"
until   = "1.5 s"
rows    = 31
start   = {{ n_rate = "7.36838020935399 rad/s" }}
columns = ["angle(crank)"]
"#
        );
        let found = result(&text);
        assert_eq!(found.table.rows(), 31, "{coefficient} {radius}");
        balances(&found, &format!("{coefficient} {radius}"));
    }
}

/// The speed of a box that slides to rest has a rate until then, and none that is bounded from then on: its largest value is known all the same.
#[test]
fn the_largest_speed_of_what_comes_to_rest_is_seen() {
    let found = result(
        r#"
units = { length = "mm", angle = "deg" }
[links]
frame = { A = [0, 0], B = [1000, 0] }
box   = { P = [0, 0], mass = "2 kg" }
[joints]
way = { slider = "box", at = "P", on = "A -> B" }
[friction]
way = { coefficient = 0.25 }
[drives]
d = { slides = "box", at = 0 }
[measures]
fastest = "max(speed(P))"
mean    = "mean(speed(P))"
[studies.slide]
kind    = "simulate"
until   = "3 s"
start   = { d_rate = "1 m/s" }
columns = ["d"]
"#,
    );
    assert!(found.diagnostics.is_empty(), "{:?}", found.diagnostics);
    let number = |name: &str| found.scalars.iter().find(|s| s.name == name).unwrap().value;
    let way = 1000.0 / (2.0 * 0.25 * 9.81);
    assert!((number("fastest") - 1000.0).abs() < 1e-9);
    assert!((number("mean") - way / 3.0).abs() < 1e-9 * way);
    assert_eq!(found.table.unreached(), 0);
}
