//! Mechanisms of every size that is read move alike.
#![allow(clippy::unwrap_used)]

use kempe_model::Model;
use kempe_study::{Silent, run};

/// A crank-rocker with lengths of so many metres.
fn crank_rocker(size: &str) -> String {
    format!(
        r#"
        [links]
        frame   = {{ A = [0, 0], D = ["6*{size} m", 0] }}
        crank   = {{ A-B = "2*{size} m", mass = 1, inertia = "{size} kg m^2" }}
        coupler = {{ B-C = "5*{size} m" }}
        rocker  = {{ D-C = "4*{size} m" }}
        [drives]
        motor = {{ turns = "crank", from = 0, to = 360, speed = "60 rpm" }}
        [assembly]
        C = "left of B -> D"
        [studies.turn]
        kind = "forces"
        rows = 37
        columns = ["angle(rocker)", "rate(angle(rocker))", "torque(motor)", "path_length(C)"]
        "#
    )
}

#[test]
fn the_largest_and_the_smallest_move_like_any_other() {
    let table = |size: &str| {
        let text = crank_rocker(size);
        let model = Model::from_toml(&text, "size", &mut |_| Err(String::new()))
            .unwrap()
            .model;
        let result = run(&model, &model.studies[0], &mut Silent).unwrap();
        assert!(result.diagnostics.is_empty(), "{:?}", result.diagnostics);
        result.table.clone()
    };
    let one = table("1");
    for size in ["1e-30", "1e-20", "1e29"] {
        let other = table(size);
        assert!(
            other.worst_closure() < 1e-13,
            "{size}: {:e}",
            other.worst_closure()
        );
        for name in ["angle(rocker)", "rate(angle(rocker))"] {
            let (a, b) = (one.column(name).unwrap(), other.column(name).unwrap());
            for (a, b) in a.values.iter().zip(&b.values) {
                assert!(
                    (a - b).abs() < 1e-9 * (1.0 + a.abs()),
                    "{size}: {name} {a} {b}"
                );
            }
        }
        assert!(
            other
                .columns
                .iter()
                .all(|c| c.values.iter().all(|v| v.is_finite()))
        );
    }
}

/// What is refused is told with its place, and what is left is never without a number.
#[test]
fn what_is_too_large_or_small_is_refused_when_it_is_read() {
    for size in ["1e-31", "1e31", "1e-80", "1e300", "1e-308"] {
        let text = crank_rocker(size);
        let found = Model::from_toml(&text, "size", &mut |_| Err(String::new())).unwrap_err();
        let alike = |d: &kempe_model::Diagnostic| {
            d.code == "out-of-range" && d.help.is_some() && !d.labels.is_empty()
        };
        assert!(found.iter().all(alike), "{found:#?}");
    }
}
