//! Names and lists of them, as sentences say them.

use kempe_mechanism::constraint::Source;
use kempe_model::Model;

/// `a`, `b` and `c`.
pub(crate) fn list(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

pub(crate) fn source_name(model: &Model, source: Source) -> String {
    match source {
        Source::Pin { point, .. } => model
            .points
            .get(point.index())
            .map_or(String::new(), |p| format!("pin {}", p.name)),
        Source::Joint(joint) => model
            .joints
            .get(joint.index())
            .map_or(String::new(), |j| j.name.clone()),
        Source::Drive(drive) => model
            .drives
            .get(drive.index())
            .map_or(String::new(), |d| d.name.clone()),
    }
}
