//! Where pins leave their curved slots, along the whole motion, whatever rows are asked for.
#![allow(clippy::unwrap_used)]

use kempe_model::{Diagnostic, Model};
use kempe_number::math;
use kempe_study::{Silent, run};

fn told(text: &str) -> Vec<Diagnostic> {
    let read = Model::from_toml(text, "slots", &mut |_| Err("no files".into()));
    let model = read
        .unwrap_or_else(|found| panic!("{found:?}\n{text}"))
        .model;
    let found = run(&model, &model.studies[0], &mut Silent).unwrap();
    let slots = found.diagnostics.into_iter();
    slots.filter(|d| d.code == "leaves-slot").collect()
}

/// The number after some words.
fn after(message: &str, words: &str) -> f64 {
    let rest = message.split(words).nth(1).unwrap();
    rest.split(' ').next().unwrap().parse().unwrap()
}

#[test]
fn a_pin_leaves_its_curve_between_rows_too() {
    // Crank 20, rod 90: the pin is at an end Q of the curve where |B - Q| = 90, by the law of cosines.
    let angles = |[x, y]: [f64; 2], turn: f64| {
        let (far, to) = (math::hypot(x, y), math::atan2(y, x).to_degrees());
        let off = math::acos((400.0 + far * far - 8100.0) / (40.0 * far)).to_degrees();
        [to + off, to - off + turn]
    };
    let ways = ["from = 90, to = 450", "from = 450, to = 90"];
    for (way, rows) in ways
        .into_iter()
        .flat_map(|way| [2, 3, 361].map(|rows| (way, rows)))
    {
        let text = format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\n[links]\n\
             frame = {{ A = [0, 0], E = [75, 30], F = [90, 35], H = [102, 30] }}\ncrank = {{ A-B = 20 }}\nrod = {{ B-P = 90 }}\n\
             [joints]\ntrack = {{ pin = \"P\", through = [\"E\", \"F\", \"H\"] }}\n\
             [drives]\nmotor = {{ turns = \"crank\", {way}, speed = \"60 rpm\" }}\n[assembly]\nP = {{ near = [90, 35] }}\n\
             [studies.s]\nkind = \"motion\"\nrows = {rows}\ncolumns = [\"x(P)\"]\n"
        );
        let found = told(&text);
        let [one] = &found[..] else {
            panic!("{found:?}");
        };
        let (before, behind) = (angles([75.0, 30.0], 360.0), angles([102.0, 30.0], 0.0));
        let wanted = match way == ways[0] {
            true => before,
            false => [behind[0] + 360.0, behind[1] + 360.0],
        };
        let found = ["from motor = ", "to motor = "].map(|words| after(&one.message, words));
        for (found, wanted) in found.iter().zip(wanted) {
            assert!(
                (found - wanted).abs() < 1e-2,
                "{found} {wanted}: {}",
                one.message
            );
        }
        assert!(
            one.message.contains(" and once more, farthest at "),
            "{}",
            one.message
        );
        assert!(
            (after(&one.message, "by ") - 11.7).abs() < 0.05,
            "{}",
            one.message
        );
        assert!(one.notes[0].ends_with(&format!("of {rows} rows")));
    }
}

/// A crank a little longer than the 20.24 mm that bring the pin to the end of its arc.
#[test]
fn a_pin_that_leaves_its_arc_a_hair_is_told() {
    let text = |a: f64| {
        format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\n[links]\n\
             frame = {{ A = [0, 0], E = [63.486229709906326, 39.84778792366982], F = [24.04823814803332, 17.534845871563093] }}\n\
             crank = {{ A-B = {a} }}\ncoupler = {{ B-C = 50 }}\n[joints]\nslot = {{ pin = \"C\", arc = \"E -> F\", radius = 40 }}\n\
             [drives]\nmotor = {{ turns = \"crank\", from = 0, to = 360, speed = \"1 rad/s\" }}\n[assembly]\nC = \"left of B -> E\"\n\
             [studies.s]\nkind = \"motion\"\nrows = 2\ncolumns = [\"x(C)\"]\n"
        )
    };
    assert_eq!(told(&text(20.2)), []);
    let found = told(&text(20.25));
    let [one] = &found[..] else {
        panic!("{found:?}");
    };
    let [from, to] = ["from motor = ", "to motor = "].map(|words| after(&one.message, words));
    assert!(from < to && to - from < 20.0, "{}", one.message);
}
