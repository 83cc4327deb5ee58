//! At which point of the drawing something of a simulation is seen.

use kempe_measure::measure::visit_leaves;
use kempe_mechanism::Mechanism;
use kempe_mechanism::constraint::Source;
use kempe_model::{
    DriveId, DriveKind, FRAME, Leaf, Measure, Model, PointId, PoseMeasure, Released,
};

use crate::view::pivot;

/// The point at which a joint or a drive is seen.
pub(super) fn point_of_source(model: &Model, source: Source) -> Option<PointId> {
    match source {
        Source::Pin { point, .. } => Some(point),
        Source::Joint(id) => {
            let joint = model.joints.get(id.index())?;
            joint.kind.points().first().copied()
        }
        Source::Drive(id) => point_of_drive(model, id),
    }
}

/// The point at which a drive is seen.
pub(super) fn point_of_drive(model: &Model, drive: DriveId) -> Option<PointId> {
    match model.drives.get(drive.index())?.kind {
        DriveKind::Turn { link, relative_to } => pivot(model, link, relative_to),
        DriveKind::Cylinder { a, b } => Some(that_moves(model, b.point, a.point)),
        DriveKind::Slide { joint } => {
            let (at, _) = model.joints.get(joint.index())?.kind.guide()?;
            Some(at.point)
        }
        DriveKind::Release { of, .. } => match of {
            Released::Pin { point, .. } => Some(point),
            Released::Joint(id) => point_of_source(model, Source::Joint(id)),
        },
        DriveKind::StandIn(_) => None,
    }
}

/// The point at which something is seen that is measured.
pub(super) fn point_of_measure(mechanism: &Mechanism, measure: &Measure) -> Option<PointId> {
    let model = &mechanism.model;
    let mut found = None;
    visit_leaves(mechanism, measure, &mut |leaf| {
        let here = match leaf {
            Leaf::Drive(drive) => point_of_drive(model, *drive),
            Leaf::Pose(pose) => match *pose {
                PoseMeasure::X(p)
                | PoseMeasure::Y(p)
                | PoseMeasure::XOn(p, _)
                | PoseMeasure::YOn(p, _)
                | PoseMeasure::DistanceToLine(p, _)
                | PoseMeasure::TransmissionAngle { at: p, .. } => Some(p),
                PoseMeasure::Distance(a, b) | PoseMeasure::Direction(a, b) => {
                    Some(that_moves(model, b, a))
                }
                PoseMeasure::Travel(at, _) => Some(at.point),
                PoseMeasure::Angle(link) => pivot(model, link, FRAME),
                PoseMeasure::AngleBetween(link, other) => pivot(model, link, other),
                _ => None,
            },
            _ => None,
        };
        found = found.or(here);
    });
    found
}

/// The first of two points, or the other one where that stands still.
fn that_moves(model: &Model, first: PointId, other: PointId) -> PointId {
    let point = model.points.get(first.index());
    match point.is_some_and(|p| p.links.contains(&FRAME)) {
        true => other,
        false => first,
    }
}
