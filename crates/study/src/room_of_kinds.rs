//! What a study of each kind will hold, before any of it is computed.

use kempe_mechanism::Mechanism;
use kempe_model::{
    ContactStudy, Model, MotionStudy, Plot, Rows, Study, StudyKind, ToleranceStudy, VibrationStudy,
    value,
};

use crate::clearance::COLUMNS;
use crate::columns::Asked;
use crate::designs::{DEFAULT_CURVES, KEPT, numbers_of};
use crate::named::study_named;
use crate::room::{HELD, Held, NUMBER, bytes_of_motion, held, row_bytes, row_of_forces};
use crate::rows::count;
use crate::vibrations::SHAPE_POSES;

/// Columns of a natural vibration.
const VIBRATION_COLUMNS: usize = 10;

/// Quantities that a choice shows besides those of the drives, at most.
const SHOWN: usize = 4;

/// A linkage that is kept, with its motion.
const BYTES_OF_LINKAGE: usize = 1 << 19;

/// What a study that is no sweep will hold, before any of it is computed.
pub(crate) fn bytes_of_one(model: &Model, study: &Study) -> Held {
    match &study.kind {
        StudyKind::Motion(motion) => bytes_of_motion(model, motion),
        StudyKind::Forces(forces) => held(model, forces, row_of_forces(model, forces)),
        StudyKind::Simulate(study) | StudyKind::Contact(ContactStudy { motion: study, .. }) => {
            let until = value(&study.until, &model.parameter_values());
            Held {
                rows: count(model, &study.along.rows, &model.parameter_values(), until),
                row: row_of_forces(model, &study.along),
            }
        }
        StudyKind::Clearance(play) => {
            let asked = Asked::of_clearance(&Mechanism::new(model), &play.along);
            let columns = COLUMNS * (asked.columns.len() + asked.curves.len()) * (1 + HELD);
            let row = row_bytes(model, &Asked::default(), play.along.plots.len(), true);
            held(model, &play.along, row + columns * NUMBER)
        }
        // Two directions of each counterweight.
        StudyKind::Balance(choice) => bytes_of_choice(model, &choice.along, 2 * choice.on.len()),
        // Stiffness and preload.
        StudyKind::Spring(choice) => bytes_of_choice(model, &choice.along, 2),
        StudyKind::Vibrations(asked) => bytes_of_vibrations(model, asked),
        StudyKind::Adjust(asked) => {
            let row = row_bytes(model, &Asked::default(), 0, false);
            let columns = (3 + asked.unknown.len()) * (asked.measures.len() + model.drives.len());
            held(model, &asked.along, row + columns * (1 + HELD) * NUMBER)
        }
        StudyKind::Tolerance(asked) => bytes_of_tolerance(model, asked),
        // They hold what they need in parts; a sweep reckons them itself, by its designs.
        StudyKind::Optimize(_) | StudyKind::Sweep(_) => Held {
            rows: 1.0,
            row: NUMBER,
        },
        StudyKind::Synthesize(asked) => Held {
            rows: asked.keep as f64,
            row: BYTES_OF_LINKAGE,
        },
    }
}

/// What a study of tolerances will hold: the numbers of all pieces, or what its bands need along the motion.
fn bytes_of_tolerance(model: &Model, study: &ToleranceStudy) -> Held {
    let over = study_named(model, &study.over.name).ok();
    let numbers = over.map_or(1, |over| numbers_of(model, &study.over, over).len());
    // Of each number a sorted copy is made; two for each limit.
    let pieces = Held {
        rows: study.samples as f64,
        row: (2 * (numbers + 2 * study.limits.len()) + 1) * NUMBER,
    };
    let plots = study.over.asked.plots.iter().map(|plot| match plot {
        Plot::Curves(columns) => columns.len(),
        _ => 2,
    });
    let curves = plots.sum::<usize>().max(DEFAULT_CURVES);
    let kept = 2 * study.samples.min(KEPT);
    let along = over.map(|over| {
        let own = bytes_of_one(model, over);
        Held {
            row: own.row + curves * (kept + 5 * (1 + HELD)) * NUMBER,
            ..own
        }
    });
    let larger = along.filter(|along| along.bytes() > pieces.bytes());
    larger.unwrap_or(pieces)
}

/// What a study of natural vibrations will hold.
fn bytes_of_vibrations(model: &Model, study: &VibrationStudy) -> Held {
    let row = row_bytes(model, &Asked::default(), 0, false);
    let modes = study.release.len();
    // Numbers of each mode as columns and in pictures; about one pose, a row and moving poses for each.
    let columns = VIBRATION_COLUMNS * (1 + HELD) * modes + model.points.len();
    let held = held(model, &study.along, row + columns * NUMBER);
    match study.along.rows {
        Rows::Count(1) => Held {
            rows: (modes * (1 + SHAPE_POSES)) as f64,
            ..held
        },
        _ => held,
    }
}

/// What a study holds that chooses something and tries so many units of it along its rows.
fn bytes_of_choice(model: &Model, along: &MotionStudy, units: usize) -> Held {
    // What is shown before and after, as columns and in pictures.
    let shown = 2 * (SHOWN + model.drives.len()) * (1 + HELD);
    let tried = units * model.drives.len().max(2);
    let row = row_bytes(model, &Asked::default(), 0, true);
    held(model, along, row + (shown + tried) * NUMBER)
}

#[cfg(test)]
mod tests {
    use std::mem::size_of;

    use kempe_dynamics::ForceArrow;

    use super::*;
    use crate::{Frame, Silent, run, study_bytes};

    fn model(studies: &str) -> Model {
        let text = format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\n[links]\nframe = {{ A = [0, 0], D = [60, 0] }}\n\
             crank = {{ A-B = 20 }}\ncoupler = {{ B-C = 50, mass = 1, inertia = \"0.001 kg m^2\" }}\nrocker = {{ D-C = 40 }}\n[drives]\n\
             motor = {{ turns = \"crank\", from = 0, to = 360, speed = \"1 rad/s\" }}\n[assembly]\n\
             C = \"left of B -> D\"\n{studies}"
        );
        let checked = Model::from_toml(&text, "x", &mut |_| Err(String::new()));
        checked.expect("a model").model
    }

    /// Bytes that a result really holds, its pictures aside.
    fn counted(result: &crate::StudyResult) -> usize {
        let table = &result.table;
        let mut numbers: usize = table.with_evidence().iter().map(|c| c.values.len()).sum();
        for figure in &result.figures {
            numbers += match figure {
                crate::Figure::Curves { curves, limits } => {
                    curves.iter().chain(limits).map(|c| c.values.len()).sum()
                }
                crate::Figure::Hodograph(_, [x, y]) => x.values.len() + y.values.len(),
                crate::Figure::Within { curve, bound } => curve.values.len() + bound.values.len(),
                crate::Figure::Path(_)
                | crate::Figure::Plane { .. }
                | crate::Figure::Graph { .. }
                | crate::Figure::Front { .. }
                | crate::Figure::Histogram { .. } => 0,
            };
        }
        let mut bytes = numbers * NUMBER + table.notes.len() * size_of::<Option<String>>();
        for frame in &result.frames {
            bytes += size_of::<Frame>();
            bytes += (3 * frame.links.len() + 2 * frame.points.len()) * NUMBER;
            bytes += frame.rates.len() * size_of::<kempe_measure::PointRates>();
            let names: usize = frame.arrows.iter().map(|a| a.name.len()).sum();
            bytes += frame.arrows.len() * size_of::<ForceArrow>() + names;
        }
        bytes
    }

    #[test]
    fn what_is_reckoned_is_no_less_than_what_is_held_and_not_much_more() {
        for kind in [
            "kind = \"motion\"",
            "kind = \"motion\"\nstep = 0.5\nplot = [\"path(C)\", \"angle(rocker)\"]",
            "kind = \"motion\"\ncircuit = true\nrows = 500",
            "kind = \"motion\"\nstep = \"10 ms\"",
            "kind = \"forces\"\nrows = 100",
            "kind = \"clearance\"\nrows = 100\nplot = [\"angle(rocker)\", \"torque(motor)\"]\n[clearance]\nB = { radial = 0.1 }",
        ] {
            let model = model(&format!("[studies.a]\n{kind}\n"));
            let study = &model.studies[0];
            let result = run(&model, study, &mut Silent).expect("a result");
            let (held, counted) = (study_bytes(&model, study).bytes(), counted(&result) as f64);
            assert!(held >= counted, "{kind}: {held} < {counted}");
            assert!(held < 4.0 * counted, "{kind}: {held} > 4 * {counted}");
        }
    }

    #[test]
    fn too_much_is_told_at_once() {
        for kind in [
            "kind = \"motion\"\nrows = 10000000",
            "kind = \"forces\"\nrows = 5000000",
            "kind = \"motion\"\nrows = 10000000\ncircuit = true",
            "kind = \"motion\"\nstep = 0.00005\ncircuit = true",
            "kind = \"balance\"\non = [\"rocker\"]\nradius = 20\nstep = 0.00005",
        ] {
            let model = model(&format!("[studies.a]\n{kind}\n"));
            let refused = run(&model, &model.studies[0], &mut Silent);
            let codes: Vec<&str> = refused
                .err()
                .into_iter()
                .flatten()
                .map(|d| d.code)
                .collect();
            assert_eq!(codes, ["too-large"], "{kind}");
        }
    }
}
