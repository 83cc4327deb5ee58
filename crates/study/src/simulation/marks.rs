//! What happened in a simulation, as the report marks it: when, how long, and at which point of the drawing.

use kempe_draw::report::{Happening, HappeningKind};
use kempe_measure::measure::visit_leaves;
use kempe_mechanism::Mechanism;
use kempe_mechanism::constraint::Source;
use kempe_model::{
    DriveId, DriveKind, FRAME, Leaf, Measure, Model, PointId, PoseMeasure, Released,
};
use kempe_simulate::{Happened, Rubs, Simulated};

use crate::view::pivot;

use super::told::Told;

/// What happened, each kind of thing at each place once, with all its times, s.
pub(super) fn happenings(told: &Told<'_>, found: &Simulated) -> Vec<Happening> {
    let mut all = All::default();
    for it in &found.touched {
        let to = it.parting.map_or(found.end, |_| it.touching.to);
        let point = told.contacts.get(it.at.contact);
        let point = point.and_then(|c| point_of_source(told.model, c.joint.into()));
        let label = told.what(&Happened::Meets {
            at: it.at,
            speed: 0.0,
        });
        let times = [it.touching.from, to];
        all.add(HappeningKind::Contact, label, point, times);
    }
    // Where one drive is let go, it is what friction holds.
    let only = match told.study.released.as_slice() {
        [only] => point_of_drive(told.model, *only),
        _ => None,
    };
    for held in &found.held {
        let times = [held.from, held.to];
        for stop in &held.stops {
            let label = match found.place_of(*stop) {
                Some(_) => format!("touches {}", told.stop(*stop)),
                None => format!("lies on {}", told.stop(*stop)),
            };
            all.add(HappeningKind::Contact, label, told.stop_point(*stop), times);
        }
        if held.by_friction {
            let label = told.what(&Happened::Sticks);
            all.add(HappeningKind::Held, label, only, times);
        }
    }
    let mut holds: Vec<(Rubs, f64)> = Vec::new();
    for it in &found.happenings {
        let at_once = [it.time; 2];
        match it.what {
            Happened::Strikes { stop, .. } => {
                let label = told.what(&it.what);
                all.add(HappeningKind::Impact, label, told.stop_point(stop), at_once);
            }
            Happened::Holds { at } => {
                if holds.iter().all(|(held, _)| *held != at) {
                    holds.push((at, it.time));
                }
            }
            Happened::LetsGo { at } => {
                if let Some(held) = holds.iter().position(|(held, _)| *held == at) {
                    let (at, since) = holds.swap_remove(held);
                    all.holds(told, at, [since, it.time]);
                }
            }
            Happened::Jumps { drive, .. } => {
                let point = point_of_drive(told.model, drive);
                all.add(HappeningKind::Event, told.what(&it.what), point, at_once);
            }
            Happened::Switches { .. }
            | Happened::Counts { .. }
            | Happened::Cavitates { .. }
            | Happened::Ends { .. } => {
                all.add(HappeningKind::Event, told.what(&it.what), None, at_once);
            }
            // These begin or end what lasts, which is there already.
            Happened::Meets { .. }
            | Happened::Separates { .. }
            | Happened::Touches { .. }
            | Happened::Rests { .. }
            | Happened::Leaves { .. }
            | Happened::Sticks
            | Happened::Slips => {}
        }
    }
    for (at, since) in holds {
        all.holds(told, at, [since, found.end]);
    }
    for it in &mut all.0 {
        it.times.sort_by(|a, b| a[0].total_cmp(&b[0]));
    }
    all.0
}

/// What happened so far.
#[derive(Default)]
struct All(Vec<Happening>);

impl All {
    fn add(&mut self, kind: HappeningKind, label: String, point: Option<PointId>, times: [f64; 2]) {
        let point = point.map(PointId::index);
        let same = |it: &&mut Happening| it.kind == kind && it.label == label && it.point == point;
        let Some(known) = self.0.iter_mut().find(same) else {
            self.0.push(Happening {
                label,
                kind,
                point,
                times: vec![times],
            });
            return;
        };
        match known.times.last_mut() {
            // the same goes on
            Some(last) if kind.lasts() && last[1] == times[0] => last[1] = times[1],
            _ => known.times.push(times),
        }
    }

    fn holds(&mut self, told: &Told<'_>, at: Rubs, times: [f64; 2]) {
        let model = told.model;
        let point = match at {
            Rubs::Joint(source) => point_of_source(model, source),
            Rubs::Contact(place) => (told.contacts.get(place.contact))
                .and_then(|c| point_of_source(model, c.joint.into())),
            Rubs::Seals(drive) => point_of_drive(model, drive),
        };
        let label = told.what(&Happened::Holds { at });
        self.add(HappeningKind::Held, label, point, times);
    }
}

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

fn point_of_drive(model: &Model, drive: DriveId) -> Option<PointId> {
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
