//! Drives that something is too weak for between the rows of a study alone.

use kempe_dynamics::ForceNote;
use kempe_model::Diagnostic;
use kempe_motion::Motion;
use kempe_motion::drive_path::duration;

use crate::along::Along;
use crate::events::place;
use crate::force_notes::ForceNotes;
use crate::rows::RowPlace;

/// Even parts of its time at whose ends a motion is looked at.
const PARTS: usize = 360;

/// Warnings of motors and cylinders that are too weak somewhere on a motion, but in no row of a study, whose notes are known.
pub(crate) fn weak_between(
    study: &str,
    motion: &Motion,
    sampler: &mut Along,
    known: &ForceNotes,
) -> Vec<Diagnostic> {
    let mechanism = motion.mechanism();
    let actions = &mechanism.model.actions;
    if actions.cylinders.is_empty() && actions.motors.is_empty() {
        return Vec::new();
    }
    let (mut notes, mut met) = (ForceNotes::default(), Vec::with_capacity(PARTS + 1));
    let lasts = duration(&mechanism.model, &motion.design.parameters);
    for k in 0..=PARTS {
        let row = sampler.row(RowPlace::Time(lasts * (k as f64 / PARTS as f64)));
        met.push(row.sample.parameter);
        let all = row.forces.into_iter().flat_map(|forces| forces.notes);
        notes.add(k, all.filter(is_weak).collect());
    }
    let at = |k: usize| place(motion, met.get(k).copied().unwrap_or(f64::NAN));
    let warnings = notes.beside(known, (study, mechanism), at).into_iter();
    warnings.map(|d| d.note("between the rows")).collect()
}

/// Whether it says that what drives is too weak.
fn is_weak(note: &ForceNote) -> bool {
    matches!(
        note,
        ForceNote::MotorTooWeak { .. }
            | ForceNote::CylinderTooWeak { .. }
            | ForceNote::FlowTooSmall { .. }
    )
}
