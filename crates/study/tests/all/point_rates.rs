//! Velocities and accelerations of the points of a study, against differences of their places.

use kempe_model::Model;
use kempe_study::{Silent, StudyResult, run};

fn result(law: &str, study: &str) -> StudyResult {
    let text = format!(
        "units = {{ length = \"mm\", angle = \"deg\" }}\n[links]\nframe = {{ A = [0, 0], D = [60, 0] }}\n\
         crank = {{ A-B = 20 }}\ncoupler = {{ B-C = 50, P = [25, 10] }}\nrocker = {{ D-C = 40 }}\n[drives]\n\
         motor = {{ turns = \"crank\", {law} }}\n[assembly]\nC = \"left of B -> D\"\n[studies.s]\nkind = \"motion\"\n{study}"
    );
    let checked = Model::from_toml(&text, "x", &mut |_| Err(String::new()));
    let model = checked.expect("a model").model;
    run(&model, &model.studies[0], &mut Silent).expect("a result")
}

/// Holds the rates of rows that stand `step` apart in the abscissa against differences of fourth
/// order; returns how many were compared.
fn compare(result: &StudyResult, abscissa: &[f64]) -> usize {
    let mut compared = 0;
    for row in 2..result.frames.len() - 2 {
        let h = abscissa[row + 1] - abscissa[row];
        let even =
            (row - 2..row + 2).all(|k| (abscissa[k + 1] - abscissa[k] - h).abs() < 1e-9 * h.abs());
        if !even || h == 0.0 {
            continue;
        }
        for (point, rates) in result.frames[row].rates.iter().enumerate() {
            for k in 0..2 {
                let at = |by: isize| result.frames[row.wrapping_add_signed(by)].points[point][k];
                let first = (at(-2) - 8.0 * at(-1) + 8.0 * at(1) - at(2)) / (12.0 * h);
                let second = (-at(-2) + 16.0 * at(-1) - 30.0 * at(0) + 16.0 * at(1) - at(2))
                    / (12.0 * h * h);
                let (v, a) = (rates.velocity[k], rates.acceleration[k]);
                assert!(
                    (v - first).abs() < 1e-8,
                    "row {row}, point {point}: {v} is not {first}"
                );
                assert!(
                    (a - second).abs() < 1e-6,
                    "row {row}, point {point}: {a} is not {second}"
                );
                compared += 1;
            }
        }
    }
    compared
}

#[test]
fn in_time_they_are_the_derivatives_of_the_places() {
    // a constant rate, and one that starts and ends at rest
    for law in [
        "from = 0, to = 360, speed = \"1 rad/s\"",
        "from = 10, to = 200, in = \"2 s\", law = \"cycloidal\"",
    ] {
        let result = result(law, "rows = 2001\n");
        let time = &result.table.column("time").expect("time").values;
        assert!(compare(&result, time) > 10_000, "{law}");
    }
}

#[test]
fn along_a_circuit_they_are_those_to_the_drive() {
    let result = result(
        "from = 0, to = 360, speed = \"1 rad/s\"",
        "circuit = true\nstep = 0.25\n",
    );
    let motor = result.table.column("motor").expect("the drive").si();
    assert!(compare(&result, &motor) > 2000);
}
