//! Derivatives of fits against differences, whatever the timing.

use kempe_model::{Model, OptimizeStudy, StudyKind};

use super::super::benches;
use super::{Fitted, Pairing, sum, with_goal};
use kempe_motion::Silent;
use kempe_number::{Number, Random, math};

const FOUR_BAR: &str = r#"
units = { length = "mm", angle = "deg" }
[parameters]
x = "3 mm"
a = "20 mm"
b = "50 mm"
u = "25 mm"
v = "12 mm"
first = "20 deg"
[links]
frame   = { A = ["x", 1], D = [60, 0] }
crank   = { A-B = "a" }
coupler = { B-C = "b", P = ["u", "v"] }
rocker  = { D-C = 40 }
[drives]
motor = { turns = "crank", from = "FROM", to = "TO", speed = "60 rpm" }
[assembly]
C = "left of B -> D"
[studies.turn]
kind = "motion"
REST
"#;

/// A Stephenson III, of which the end of the second dyad is traced.
const SIX_BAR: &str = r#"
units = { length = "mm", angle = "deg" }
[parameters]
a = "20 mm"
e = "45 mm"
v = "12 mm"
[links]
frame   = { A = [0, 0], D = [60, 0], G = [30, 90] }
crank   = { A-B = "a" }
coupler = { B-C = 50, E = [25, "v"] }
rocker  = { D-C = 40 }
rod     = { E-F = "e", Q = [20, 5] }
arm     = { G-F = 50 }
[drives]
motor = { turns = "crank", from = 0, to = 360, speed = "60 rpm" }
[assembly]
C = "left of B -> D"
F = "right of E -> G"
[studies.turn]
kind = "motion"
"#;

const VARY: &str = "vary = { x = [-10, 10], a = [15, 25], b = [45, 60], u = [15, 35], v = [5, 20], first = ['10 deg', '30 deg'] }";

/// The six places of no path of it, within its reach.
const PLACES: &str = "[[42, 22], [31, 33], [17, 33], [9, 26], [12, 17], [24, 9]]";

fn with_fitted(text: &str, mut see: impl FnMut(&Fitted<'_, '_>, &OptimizeStudy)) {
    let checked = Model::from_toml(text, "test", &mut |_| Err(String::new()));
    let checked = checked.unwrap_or_else(|found| panic!("{found:#?}"));
    let study = checked.model.studies.iter().find_map(|s| match &s.kind {
        StudyKind::Optimize(study) => Some(with_goal(study)),
        _ => None,
    });
    let study = study.unwrap_or_else(|| panic!("no fit"));
    let (mut bench, _) = benches(&checked.model, &study).unwrap_or_else(|e| panic!("{e:#?}"));
    bench
        .begin(&mut Silent)
        .unwrap_or_else(|e| panic!("{e:#?}"));
    let fit = study.fit.as_ref().unwrap_or_else(|| panic!("no fit"));
    see(&Fitted::new(&bench, fit), &study);
}

fn four_bar(turn: [&str; 2], rest: &str, fit: &str) -> String {
    let text = FOUR_BAR.replace("FROM", turn[0]).replace("TO", turn[1]);
    let text = text.replace("REST", rest);
    format!("{text}[studies.fitted]\nkind = 'optimize'\nover = 'turn'\n{VARY}\nfit = {fit}\n")
}

/// Holds the slope of the sum of squares, and where nothing is free those of all residuals, against central differences of sixth order.
fn held(text: &str, pairing: Pairing, each: bool) {
    with_fitted(text, |fitted, _| {
        let own = fitted.bench.own_values();
        let misses = |values: &[f64]| -> Vec<f64> {
            let seen = fitted.seen_as(values, pairing);
            let seen = seen.unwrap_or_else(|refused| panic!("{}: {text}", refused.why));
            let size = fitted.asked.places.len();
            let all = seen.met.misses.iter();
            all.flat_map(|m| m[..size].to_vec()).collect()
        };
        let mut seen = fitted
            .seen_as(&own, pairing)
            .unwrap_or_else(|r| panic!("{}", r.why));
        let exact = fitted
            .residuals(&mut seen)
            .unwrap_or_else(|r| panic!("{}", r.why));
        let whole = sum(&exact);
        let squares = |m: &[f64]| m.iter().map(|x| x * x).sum::<f64>();
        assert!((whole.value - squares(&misses(&own))).abs() <= 1e-14 * whole.value);
        let largest = whole.slope.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        for k in 0..own.len() {
            let step = 1e-3 * own[k].abs();
            let at = |times: f64| {
                let mut moved = own.clone();
                moved[k] += times * step;
                misses(&moved)
            };
            let all: Vec<Vec<f64>> = [1.0, -1.0, 2.0, -2.0, 3.0, -3.0].map(at).to_vec();
            let slope = |of: &dyn Fn(&Vec<f64>) -> f64| {
                let [a, b, c, d, e, f] = [0, 1, 2, 3, 4, 5].map(|j| of(&all[j]));
                (45.0 * (a - b) - 9.0 * (c - d) + (e - f)) / (60.0 * step)
            };
            let by = slope(&|m| squares(m));
            let size = largest * own[0].abs().max(1e-3) / own[k].abs();
            assert!(
                (by - whole.slope[k]).abs() <= 1e-7 * size.max(largest),
                "{k}: {by} {} of {largest}\n{text}",
                whole.slope[k]
            );
            for (i, residual) in exact.iter().enumerate().filter(|_| each) {
                let by = slope(&|m| m[i]);
                let own = residual.slope[k];
                assert!(
                    (by - own).abs() <= 1e-7 * by.abs().max(1.0),
                    "{k} {i}: {by} {own}\n{text}"
                );
            }
        }
    });
}

const ROUND: [&str; 2] = ["0 deg", "360 deg"];
const PART: [&str; 2] = ["first", "300 deg"];

fn point(more: &str) -> String {
    format!("{{ point = 'P', to = {PLACES}{more} }}")
}

#[test]
fn of_places_that_are_met_where_they_are_nearest() {
    for more in ["", ", timing = 'nearest'"] {
        held(&four_bar(PART, "", &point(more)), Pairing::Asked, false);
        held(&four_bar(ROUND, "", &point(more)), Pairing::Asked, false);
        let closed = format!("{more}, closed = true");
        held(&four_bar(ROUND, "", &point(&closed)), Pairing::Asked, false);
    }
}

#[test]
fn of_places_that_lead() {
    held(&four_bar(PART, "", &point("")), Pairing::Leading, true);
    held(
        &four_bar(ROUND, "", &point(", closed = true")),
        Pairing::Leading,
        false,
    );
}

#[test]
fn of_places_with_a_timing() {
    for more in [
        ", timing = { motor = [30, 80, 120, 180, 220, 290] }",
        ", timing = { time = [0.05, 0.1, 0.25, 0.4, 0.5, 0.7] }",
        ", timing = 'even'",
        ", timing = 'arc-length'",
    ] {
        held(&four_bar(PART, "", &point(more)), Pairing::Asked, true);
    }
    for more in [", timing = 'even'", ", timing = 'arc-length'"] {
        let closed = format!("{more}, closed = true");
        held(&four_bar(ROUND, "", &point(&closed)), Pairing::Asked, false);
    }
}

#[test]
fn of_poses() {
    let to = "[[42, 22, 30], [31, 33, 25], [17, 33, 40], [9, 26, 55]]";
    for (more, each) in [
        ("", false),
        (", timing = 'nearest'", false),
        (", timing = 'even'", true),
        (", timing = 'arc-length'", true),
        (", timing = { motor = [30, 80, 120, 180] }", true),
    ] {
        let fit = format!("{{ link = 'coupler', at = 'P', radius = 30, to = {to}{more} }}");
        held(&four_bar(PART, "", &fit), Pairing::Asked, each);
    }
}

/// The crank may swing: the way goes there and back through two dead points, which move with the design.
#[test]
fn of_a_circuit() {
    let rest = "circuit = true";
    for more in ["", ", closed = true", ", timing = 'nearest'"] {
        let text = four_bar(["20 deg", "40 deg"], rest, &point(more));
        held(&text, Pairing::Asked, false);
        held(
            &text.replace("b = \"50 mm\"", "b = \"30 mm\""),
            Pairing::Asked,
            false,
        );
    }
}

#[test]
fn of_a_six_bar() {
    for more in [
        "",
        ", closed = true",
        ", timing = 'even'",
        ", timing = 'arc-length'",
    ] {
        let to = "[[42, 62], [31, 63], [27, 55], [29, 50], [38, 47], [44, 49]]";
        let vary = "vary = { a = [15, 25], e = [40, 50], v = [5, 20] }";
        let text = format!(
            "{SIX_BAR}[studies.fitted]\nkind = 'optimize'\nover = 'turn'\n{vary}\nfit = {{ point = 'Q', to = {to}{more} }}\n"
        );
        held(&text, Pairing::Asked, false);
    }
}

/// Places about a circle whose last ones may lie beyond the first: met in order within one turn, no worse than on any grid of places in order.
#[test]
fn of_places_that_pass_each_other_at_the_seam() {
    const GRID: usize = 360;
    const RADIUS: f64 = 0.02;
    let on_grid = |k: usize| math::sin_cos((k % GRID) as f64 / GRID as f64 * std::f64::consts::TAU);
    let mut random = Random(11);
    let mut passing = 0;
    for round in 0..60 {
        let n = 3 + round % 6;
        let places: Vec<[f64; 2]> = (0..n)
            .map(|k| {
                let noise = 1.5 * (random.uniform() - 0.5);
                let turned = (k as f64 + noise) / (n - 1) as f64 + random.uniform() / 1e3;
                let (sin, cos) = math::sin_cos(turned * std::f64::consts::TAU);
                let r = RADIUS * (1.0 + 0.4 * (random.uniform() - 0.5));
                [r * cos, r * sin]
            })
            .collect();
        let listed: Vec<String> = (places.iter())
            .map(|[x, y]| format!("['{x} m', '{y} m']"))
            .collect();
        let text = format!(
            "[parameters]\na = '{RADIUS} m'\n[links]\nframe = {{ A = [0, 0] }}\ncrank = {{ A-B = 'a' }}\n[drives]\n\
             motor = {{ turns = 'crank', from = 0, to = '360 deg', speed = '1 rad/s' }}\n[studies.turn]\nkind = 'motion'\n\
             [studies.fitted]\nkind = 'optimize'\nover = 'turn'\nvary = {{ a = ['0.01 m', '0.03 m'] }}\n\
             fit = {{ point = 'B', to = [{}], closed = true }}\n",
            listed.join(", ")
        );
        with_fitted(&text, |fitted, _| {
            let seen = fitted.seen(&fitted.bench.own_values());
            let met = seen.unwrap_or_else(|r| panic!("{}", r.why)).met;
            // Once round in one of both orders.
            let round = |at: &[f64]| {
                let next = at.iter().cycle().skip(1);
                let steps = at.iter().zip(next).map(|(a, b)| (b - a).rem_euclid(1.0));
                steps.filter(|step| *step < 1.0 - 1e-9).sum::<f64>()
            };
            let mut at = met.at.clone();
            let forth = round(&at);
            at.reverse();
            assert!(forth.min(round(&at)) < 1.0 + 1e-9, "{:?}", met.at);
            let cost = |place: &[f64; 2], k: usize| {
                let (sin, cos) = on_grid(k);
                (place[0] - RADIUS * cos).square() + (place[1] - RADIUS * sin).square()
            };
            let mut best = f64::INFINITY;
            let mut own = places.clone();
            for _ in 0..2 {
                for start in 0..GRID {
                    // The least cost of all places so far, the last no farther than there.
                    let mut least = vec![cost(&own[0], start); GRID + 1];
                    for place in &own[1..] {
                        let mut until = f64::INFINITY;
                        for (k, least) in least.iter_mut().enumerate() {
                            until = f64::min(until, *least + cost(place, start + k));
                            *least = until;
                        }
                    }
                    best = best.min(least[GRID]);
                }
                own.reverse();
            }
            let sum = met.square();
            assert!(sum <= best * (1.0 + 1e-9), "{sum} {best}\n{text}");
            let free: f64 = places
                .iter()
                .map(|[x, y]| (math::hypot(*x, *y) - RADIUS).square())
                .sum();
            passing += usize::from(sum > free * (1.0 + 1e-6));
        });
    }
    assert!(passing > 20, "{passing}");
}
