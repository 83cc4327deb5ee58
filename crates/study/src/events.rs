//! What a motion met, with the row nearest to each place.

use kempe_motion::Motion;
use kempe_motion::drive_path::DrivePath;
use kempe_motion::events::EventKind;
use kempe_units::Dimension;

use crate::result::Event;
use crate::unit::Units;

/// What the motion met, with the row nearest to each place.
pub(crate) fn events(motion: &Motion, units: &Units, parameters: &[f64]) -> Vec<Event> {
    let model = &motion.mechanism().model;
    let (name, dimension) = match motion.path {
        DrivePath::Coordinate { drive, .. } => model
            .drives
            .get(drive)
            .map_or(("time", Dimension::TIME), |d| {
                (d.name.as_str(), d.dimension)
            }),
        DrivePath::Time { .. } => ("time", Dimension::TIME),
    };
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
            place: format!(
                "{name} = {}",
                units.place_text(event.at, dimension, motion.demanded)
            ),
            label: match event.kind {
                EventKind::Limit => "limit of the drive".to_owned(),
                _ => "change point: branches cross, the motion goes on smoothly".to_owned(),
            },
            row: nearest(event.at),
        })
        .collect()
}
