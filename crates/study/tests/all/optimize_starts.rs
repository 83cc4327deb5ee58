//! Single goals with several valleys, among which limits part the bounds into islands.
#![allow(clippy::unwrap_used)]

use crate::optimize_fronts::CLAMP;
use crate::read::read;
use crate::told::scalar;
use kempe_study::{Silent, StudyResult, run};

/// The clamp's largest opening, with two bands of sizes that are not to be had: four islands.
const BEST: &str = r#"[studies.close]
kind = "motion"
step = 10
[studies.best]
kind = "optimize"
over = "close"
vary = { h = ["20 mm", "90 mm"], l = ["20 mm", "120 mm"], j = ["20 mm", "80 mm"], px = ["40 mm", "110 mm"] }
maximize = "open"
subject_to = ["min(transmission_angle(C)) >= 30 deg", "hold >= 1.5", "hold <= 10", "max(y(C)) <= 70 mm", "abs(j - 45 mm) >= 10 mm", "abs(px - 70 mm) >= 8 mm"]
"#;

fn best(study: &str) -> StudyResult {
    let (clamp, _) = CLAMP.split_once("[studies.close]").unwrap();
    let model = read(&format!("{clamp}{BEST}{study}"));
    run(&model, &model.studies[1], &mut Silent).unwrap()
}

fn told(result: &StudyResult) -> String {
    let rows = result.listings.iter().flat_map(|listing| &listing.rows);
    rows.flatten().cloned().collect::<Vec<_>>().join("\n")
}

/// On other islands there are 88.0 and 83.9 deg, to which six starts led with five of six seeds, untold. An evolution of another program and steps downhill from
/// its best say 93.539 deg.
#[test]
fn the_best_of_four_islands_is_found() {
    for seed in 1..=4 {
        let result = best(&format!("seed = {seed}\n"));
        let open = scalar(&result, "open");
        assert!((open - 93.5389).abs() < 1e-3, "{seed}: {open}");
        let told = told(&result);
        assert!(
            told.contains("of these ways led to optima of ") && told.contains(" different values"),
            "{told}"
        );
        assert!(!told.contains("further ones may lead to others"));
    }
}

/// Where designs do not do for it, it is said that other starts may lead to others.
#[test]
fn starts_that_still_lead_elsewhere_are_told() {
    let result = best("designs = 150\n");
    assert!(scalar(&result, "designs tried") <= 200.0);
    let told = told(&result);
    assert!(
        told.contains(
            "different values, and further ones may lead to others: more `designs` follow more"
        ),
        "{told}"
    );
}
