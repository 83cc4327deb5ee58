//! What a simulation goes by and what happens in it, in the words of the file.

use kempe_mechanism::constraint::Source;
use kempe_model::{Chamber, Contact, DriveId, Model, PointId, Released, SimulateStudy, Span};
use kempe_simulate::{Happened, Held, Place, Rubs, Simulated, Sought};
use kempe_units::Dimension;

use crate::clearance::joint_name;
use crate::unit::Units;
use crate::words::source_name;

use super::points::point_of_source;

/// A speed below this part of that before an impact is none.
const STAYS: f64 = 1e-9;

/// Something that stops the motion, in words.
pub(super) struct Named {
    /// `the lower stop of rocker`.
    pub text: String,
    pub is_angle: bool,
    /// The drive of the cylinder whose stroke ends there, with the lengths between which that is, m; none of a stop that the study has.
    pub stroke: Option<(DriveId, [f64; 2])>,
    /// The point at which it is seen.
    pub point: Option<PointId>,
}

impl Named {
    /// A place of a joint with play that resists at once.
    pub fn of_place(model: &Model, contacts: &[Contact], at: Place) -> Self {
        let joint = contacts.get(at.contact).map(|c| c.joint);
        Self {
            point: joint.and_then(|joint| point_of_source(model, joint.into())),
            text: place_name(model, contacts, at),
            is_angle: false,
            stroke: None,
        }
    }
}

/// What names are needed to tell of a simulation.
pub(super) struct Told<'a> {
    pub model: &'a Model,
    /// The name of the study.
    pub name: &'a str,
    pub units: Units,
    pub study: &'a SimulateStudy,
    /// What stops it; behind those that were asked for the places with play that do.
    pub stops: &'a [Named],
    pub contacts: &'a [Contact],
}

impl<'a> Told<'a> {
    pub fn new(
        model: &'a Model,
        (name, study): (&'a str, &'a SimulateStudy),
        stops: &'a [Named],
        contacts: &'a [Contact],
    ) -> Self {
        Self {
            units: Units::of(model),
            model,
            name,
            study,
            stops,
            contacts,
        }
    }

    /// The name of a drive.
    pub fn drive(&self, id: DriveId) -> &'a str {
        let drive = self.model.drives.get(id.index());
        drive.map_or("", |drive| drive.name.as_str())
    }

    /// What stops it: `the upper stop of rocker`.
    pub fn stop(&self, index: usize) -> &'a str {
        self.stops.get(index).map_or("", |stop| stop.text.as_str())
    }

    /// The point at which a stop is seen.
    pub fn stop_point(&self, index: usize) -> Option<PointId> {
        self.stops.get(index)?.point
    }

    /// Something that it goes by, and where the file tells of it.
    pub fn sought(&self, sought: Sought) -> (String, Option<Span>) {
        let actions = &self.model.actions;
        match sought {
            Sought::Stop(index) => (format!("what {} bounds", self.stop(index)), None),
            Sought::Condition(index) => {
                let condition = self.study.end_when.get(index);
                let text = condition.map_or("", |c| &c.text);
                (format!("the condition `{text}`"), None)
            }
            Sought::Switch(index) => {
                let switch = actions.switches.get(index);
                let name = switch.map_or("", |s| &s.name);
                (
                    format!("what turns the switch `{name}`"),
                    switch.map(|s| s.span.clone()),
                )
            }
            Sought::Load(index) => {
                let load = actions.loads.get(index);
                let name = load.map_or("", |l| &l.name);
                (format!("the load `{name}`"), load.map(|l| l.span.clone()))
            }
            Sought::Throttle(drive) => {
                let motor = actions.motors.iter().find(|m| m.drive == drive);
                let text = format!("the throttle of `{}`", self.drive(drive));
                (text, motor.map(|m| m.span.clone()))
            }
            Sought::Valve(drive) => {
                let cylinder = actions.cylinders.iter().find(|c| c.drive == drive);
                let text = format!("the valve of `{}`", self.drive(drive));
                (text, cylinder.map(|c| c.span.clone()))
            }
            Sought::Law(drive) => {
                let named = self.model.drives.get(drive.index());
                let text = format!("the law of drive `{}`", self.drive(drive));
                (text, named.map(|d| d.span.clone()))
            }
        }
    }

    /// What holds it.
    pub fn what_holds(&self, held: &Held) -> String {
        let lies = held.stops.iter().map(|stop| self.stop(*stop));
        let lies = lies.map(|stop| format!("lies on {stop}"));
        let friction = held.by_friction.then(|| "friction holds it".to_owned());
        lies.chain(friction).collect::<Vec<_>>().join(", ")
    }

    /// What the stops push at a time that show in no drive's effort.
    pub fn pushes<'f>(
        &'f self,
        found: &'f Simulated,
        time: f64,
    ) -> impl Iterator<Item = String> + 'f {
        found.pressed.iter().filter_map(move |(stop, pressed)| {
            let push = pressed.push.at(time, &[]);
            let is_angle = self.stops.get(*stop).is_some_and(|stop| stop.is_angle);
            let dimension = match is_angle {
                true => Dimension::TORQUE,
                false => Dimension::FORCE,
            };
            let text = self.units.text(push, dimension);
            (push != 0.0).then(|| format!("{} pushes with {text}", self.stop(*stop)))
        })
    }

    /// The pressure of a chamber: `the pressure on the bore's side of lift`.
    pub fn chamber(&self, free: usize, side: Chamber) -> String {
        let drive = self.study.released.get(free);
        let name = drive.map_or("", |drive| self.drive(*drive));
        let side = match side {
            Chamber::Bore => "bore",
            Chamber::Ring => "rod",
        };
        format!("the pressure on the {side}'s side of {name}")
    }

    fn speed(&self, stop: usize, rate: f64) -> String {
        let is_angle = self.stops.get(stop).is_some_and(|stop| stop.is_angle);
        let coordinate = if is_angle {
            Dimension::ANGLE
        } else {
            Dimension::LENGTH
        };
        self.units.text(rate, coordinate / Dimension::TIME)
    }

    /// What happened, however fast: all that repeats says the same.
    pub fn what(&self, happened: &Happened) -> String {
        let switch = |index: &usize| {
            let named = self.model.actions.switches.get(*index);
            named.map_or("", |s| s.name.as_str())
        };
        match happened {
            Happened::Meets { at, .. } => format!("touches {}", self.place(*at)),
            Happened::Separates { at, .. } => format!("parts at {}", self.place(*at)),
            Happened::Strikes { stop, .. } => format!("strikes {}", self.stop(*stop)),
            Happened::Touches { stop, .. } => format!("touches {}", self.stop(*stop)),
            Happened::Rests { stop } => format!("rests on {}", self.stop(*stop)),
            Happened::Leaves { stop } => format!("leaves {}", self.stop(*stop)),
            Happened::Sticks => "friction holds it".to_owned(),
            Happened::Slips => "friction lets it go".to_owned(),
            Happened::Holds { at } => format!("friction holds {}", self.rubs(*at)),
            Happened::LetsGo { at } => format!("friction lets {} go", self.rubs(*at)),
            Happened::Switches { switch: it, on } => {
                format!("{} goes {}", switch(it), if *on { "on" } else { "off" })
            }
            Happened::Counts { switch: it, .. } => format!("{} counts on", switch(it)),
            Happened::Cavitates { free, side } => {
                format!("{} falls below vacuum", self.chamber(*free, *side))
            }
            Happened::Jumps { drive, .. } => format!("{} jumps", self.drive(*drive)),
            Happened::Ends { condition } => {
                let condition = self.study.end_when.get(*condition);
                format!("it ends: {}", condition.map_or("", |c| c.text.as_str()))
            }
        }
    }

    /// What happened, and how fast.
    pub fn in_full(&self, happened: &Happened) -> String {
        let what = self.what(happened);
        match happened {
            Happened::Strikes {
                stop,
                before,
                after,
            } => {
                let after = match *after > -STAYS * before {
                    true => format!("leaves at {}", self.speed(*stop, *after)),
                    false => "without rebound".to_owned(),
                };
                format!("{what} at {}, {after}", self.speed(*stop, -before))
            }
            Happened::Touches { stop, speed } => {
                format!("{what} at {}", self.speed(*stop, *speed))
            }
            Happened::Counts { switch, to } => {
                let named = self.model.actions.switches.get(*switch);
                format!("{} counts {to}", named.map_or("", |s| s.name.as_str()))
            }
            Happened::Jumps {
                drive,
                before,
                after,
            } => {
                let known = self.model.drives.get(drive.index());
                let coordinate = known.map_or(Dimension::NONE, |drive| drive.dimension);
                let speeds = [*before, *after];
                let [before, after] = self.units.texts(speeds, coordinate / Dimension::TIME);
                format!("{what} from {before} to {after}")
            }
            _ => what,
        }
    }

    /// What rubs.
    fn rubs(&self, at: Rubs) -> String {
        match at {
            Rubs::Joint(source) => source_name(self.model, source),
            Rubs::Contact(at) => match self.contacts.get(at.contact).map(|c| c.joint) {
                Some(pin @ Released::Pin { .. }) => source_name(self.model, pin.into()),
                _ => self.place(at),
            },
            Rubs::Seals(drive) => {
                format!(
                    "the seals of {}",
                    source_name(self.model, Source::Drive(drive))
                )
            }
        }
    }

    fn place(&self, at: Place) -> String {
        place_name(self.model, self.contacts, at)
    }
}

/// A place of a joint with play, in words.
pub(crate) fn place_name(model: &Model, contacts: &[Contact], at: Place) -> String {
    let joint = contacts.get(at.contact).map(|c| c.joint);
    let name = joint.map_or(String::new(), |joint| joint_name(model, joint.into()));
    match joint {
        Some(Released::Joint(_)) => {
            let corners = ["rear left", "front left", "rear right", "front right"];
            let corner = corners.get(at.place).copied().unwrap_or_default();
            format!("the {corner} corner of {name}")
        }
        _ => name,
    }
}
