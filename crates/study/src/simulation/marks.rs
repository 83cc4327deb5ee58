//! What happened in a simulation, as the report marks it: when, how long, and at which point of the drawing.

use kempe_draw::report::{Happening, HappeningKind};
use kempe_model::PointId;
use kempe_simulate::{Happened, Rubs, Simulated};

use super::points::{point_of_drive, point_of_source};
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
