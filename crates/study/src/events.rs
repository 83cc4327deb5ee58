//! What a motion met, with the row nearest to each place.

use kempe_motion::Motion;
use kempe_motion::drive_path::DrivePath;
use kempe_motion::events::EventKind;
use kempe_units::Dimension;

use crate::result::Event;
use crate::unit::Units;

/// Where a motion is at a path parameter: the coordinate of its only moving drive, or the time.
pub(crate) fn place(motion: &Motion, at: f64) -> String {
    let model = &motion.mechanism().model;
    let drive = match motion.path {
        DrivePath::Coordinate { drive, .. } => model.drives.get(drive),
        DrivePath::Time { .. } => None,
    };
    let (name, dimension) = drive.map_or(("time", Dimension::TIME), |d| (&d.name, d.dimension));
    let at = Units::of(model).place_text(at, dimension, motion.demanded);
    format!("{name} = {at}")
}

/// What the motion met, with the row nearest to each place.
pub(crate) fn events(motion: &Motion, parameters: &[f64]) -> Vec<Event> {
    let nearest = |at: f64| {
        let gap = |row: &usize| (parameters[*row] - at).abs();
        (0..parameters.len())
            .min_by(|a, b| gap(a).total_cmp(&gap(b)))
            .unwrap_or(0)
    };
    let shown = motion
        .events
        .iter()
        .filter(|e| e.kind != EventKind::ModeChange);
    shown
        .map(|event| Event {
            kind: event.kind,
            at: event.at,
            place: place(motion, event.at),
            label: match event.kind {
                EventKind::Limit => "limit of the drive".to_owned(),
                _ => "change point: branches cross, the motion goes on smoothly".to_owned(),
            },
            row: nearest(event.at),
        })
        .collect()
}
