//! Studies of clearance in which contact is lost, as a user runs them.
#![allow(clippy::unwrap_used)]

use kempe_model::Model;
use kempe_study::{Figure, Silent, StudyResult, run};

const FOUR_BAR: &str = r#"
units = { length = "mm" }
[links]
frame   = { A = [0, 0], D = [60, 0] }
crank   = { A-B = 20, mass = 1, inertia = "100 kg mm^2" }
coupler = { B-C = 50, mass = 1, inertia = "100 kg mm^2" }
rocker  = { D-C = 40, mass = 1, inertia = "100 kg mm^2" }
[clearance]
B = { radial = "50 um", radius = "5 mm", restitution = 0.3, law = "LAW" }
[drives]
motor = { turns = "crank", from = 0, to = 90, speed = "300 rpm" }
[assembly]
C = { near = [50, 40] }
[measures]
swing = "angle(rocker)"
[studies.rattle]
kind    = "clearance"
model   = "three-state"
until   = "60 ms"
rows    = 121
columns = ["swing", "reaction(B)"]
"#;

fn result(text: &str) -> StudyResult {
    let model = Model::from_toml(text, "contact", &mut |_| Err("no files".into()))
        .unwrap()
        .model;
    run(&model, &model.studies[0], &mut Silent).unwrap()
}

/// The crank keeps its law, against every impact, and stands still all at once where that ends, at 50 ms: what it gives is
/// counted, so that the energy balances, and inverse dynamics finds nothing along what is let go.
#[test]
fn energy_balances_where_a_drive_keeps_its_law_and_stops_at_once() {
    {
        let law = "rigid";
        let result = result(&FOUR_BAR.replace("LAW", law));
        assert_eq!(result.table.rows(), 121);
        let balance = result.table.balance.as_ref().unwrap();
        let worst = |column: &[f64]| {
            let sizes = column.iter().filter(|x| x.is_finite());
            sizes.fold(0.0_f64, |most, x| most.max(x.abs()))
        };
        assert!(
            worst(&balance.energy) < 1e-7,
            "{law}: {:e}",
            worst(&balance.energy)
        );
        assert!(
            worst(&balance.power) < 1e-6,
            "{law}: {:e}",
            worst(&balance.power)
        );
        let column = |name: &str| result.table.column(name).unwrap().values.clone();
        let (x, y) = (column("B play x"), column("B play y"));
        let (touching, force) = (column("B touching"), column("reaction(B)"));
        for row in 0..121 {
            // A bore that gives lets the pin in a little deeper, and a force is where it touches.
            let off = kempe_number::math::hypot(x[row], y[row]);
            assert!(off < 0.0505, "{law}: {off} mm in row {row}");
            if touching[row] == 0.0 {
                assert!(force[row] < 1e-6, "{law}: {} N in row {row}", force[row]);
            } else {
                assert!(off > 0.05 - 1e-9, "{law}: {off} mm in row {row}");
            }
        }
        assert!(touching.contains(&1.0) && touching.contains(&0.0));
        // Half a tenth of a millimetre turns a rocker of 40 mm by some hundredths of a degree.
        let deviation = column("swing deviation");
        assert!(worst(&deviation) > 1e-3 && worst(&deviation) < 0.5);
        let orbit =
            |figure: &Figure| matches!(figure, Figure::Hodograph(name, _) if name == "orbit of B");
        assert!(result.figures.iter().any(orbit));
    }
}
