//! What joints that are let go are called, and their coordinates.

use crate::drive::{DriveKind, Released};
use crate::joint::JointKind;
use crate::model::Model;

impl DriveKind {
    /// What the coordinate of a joint's row is called that is let go: `B play x`; nothing of other drives.
    pub fn released_name(&self, model: &Model) -> Option<String> {
        let Self::Release { of, row } = self else {
            return None;
        };
        let rows = match *of {
            Released::Pin { .. } => ["play x", "play y"],
            Released::Joint(joint) => match model.joints.get(joint.index())?.kind {
                JointKind::Slider { .. } => ["play angle", "play"],
                _ => ["play", "play 2"],
            },
        };
        let name = of.name(model)?;
        let row = rows.get(usize::from(*row)).copied().unwrap_or("play");
        Some(format!("{name} {row}"))
    }
}

impl Released {
    /// What it is called: `B`, or `B of rod` where the point has more than two links.
    pub fn name(&self, model: &Model) -> Option<String> {
        match *self {
            Self::Pin { point, link } => {
                let point = model.points.get(point.index())?;
                let several = (point.links.len() > 2).then(|| model.links.get(link.index()));
                Some(match several.flatten() {
                    Some(link) => format!("{} of {}", point.name, link.name),
                    None => point.name.clone(),
                })
            }
            Self::Joint(joint) => Some(model.joints.get(joint.index())?.name.clone()),
        }
    }
}
