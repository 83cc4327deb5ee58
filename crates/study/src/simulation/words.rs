//! What a simulation tells in words: how it was done, what happened, what holds the mechanism.

use kempe_model::{Chamber, Contact, LinkId, Model, Released, SimulateStudy};
use kempe_simulate::{Happened, Happening, Held, Place, Question, Simulated};
use kempe_units::Dimension;

use crate::clearance::joint_name;
use crate::result::{Listing, StudyResult};
use crate::table::largest;
use crate::unit::Units;

use super::question::Named;

/// A speed below this part of that before an impact is none.
const STAYS: f64 = 1e-9;
/// At most so many things that happened are listed.
const LISTED: usize = 30;
/// At most so many changes of what tells the place are listed.
const TOLD: usize = 4;

/// What holds it, in words.
pub(super) fn what_holds(held: &Held, stops: &[Named]) -> String {
    let named = held.stops.iter().filter_map(|stop| stops.get(*stop));
    let lies = named.map(|stop| format!("lies on {}", stop.text));
    let friction = held.by_friction.then(|| "friction holds it".to_owned());
    lies.chain(friction).collect::<Vec<_>>().join(", ")
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

/// The pressure of a chamber: `the pressure on the bore's side of lift`.
pub(super) fn chamber(model: &Model, study: &SimulateStudy, free: usize, side: Chamber) -> String {
    let drive = study.released.get(free);
    let drive = drive.and_then(|drive| model.drives.get(drive.index()));
    let side = match side {
        Chamber::Bore => "bore",
        Chamber::Ring => "rod",
    };
    let name = drive.map_or("", |drive| drive.name.as_str());
    format!("the pressure on the {side}'s side of {name}")
}

/// How it was done, and how well.
pub(super) fn how(
    model: &Model,
    question: &Question,
    found: &Simulated,
    result: &StudyResult,
) -> Listing {
    let units = &Units::of(model);
    let balance = result.table.balance.as_ref();
    let worst = |column: Option<&Vec<f64>>| {
        let sizes: Vec<f64> = column.into_iter().flatten().map(|x| x.abs()).collect();
        largest(&sizes).map_or("not known".to_owned(), |(_, off)| format!("{off:.1e}"))
    };
    let used = found.used;
    let explicit = "explicit Runge-Kutta of order 8 (Dormand and Prince)";
    let implicit = "implicit Runge-Kutta of order 5 (Radau IIA)";
    let methods: Vec<String> = match used.implicit_from {
        None => vec![explicit.to_owned()],
        Some(_) if used.explicit == 0 => vec![implicit.to_owned()],
        Some(from) => vec![
            format!("{explicit}, {} steps,", used.explicit),
            format!(
                "{implicit}, {} steps, first at {}",
                used.implicit,
                units.text(from, Dimension::TIME)
            ),
        ],
    };
    let mut rows = vec![
        vec![
            "method".to_owned(),
            format!("minimal coordinates, {}", methods.join(" and ")),
        ],
        vec![
            "steps".to_owned(),
            format!(
                "{}, {} evaluations",
                used.explicit + used.implicit,
                found.evaluations
            ),
        ],
        vec![
            "energy".to_owned(),
            format!(
                "balanced to {} of the most that was moved",
                worst(balance.map(|b| &b.energy))
            ),
        ],
        vec![
            "power".to_owned(),
            format!(
                "inverse dynamics asks no more of what is let go than it gives, to {}",
                worst(balance.map(|b| &b.power))
            ),
        ],
    ];
    if let Some(told) = told(model, question, found) {
        rows.insert(1, vec!["coordinates".to_owned(), told]);
    }
    Listing {
        title: "How it was simulated".to_owned(),
        head: Vec::new(),
        rows,
    }
}

/// What told the place of the mechanism, where that was not what was let go all the time: `travel, from 0.1 s angle(crank)`.
pub(super) fn told(model: &Model, question: &Question, found: &Simulated) -> Option<String> {
    let units = Units::of(model);
    let drive = |place: usize| {
        let id = question.free.get(place)?;
        Some(model.drives.get(id.index())?.name.clone())
    };
    let link = |link: &LinkId| {
        let link = model.links.get(link.index())?;
        Some(format!("angle({})", link.name))
    };
    let told = found.told_by();
    let mut parts: Vec<String> = (told.iter().enumerate().take(TOLD))
        .map(|(index, (since, links))| {
            let names = links.iter().enumerate();
            let names: Vec<String> = names
                .filter_map(|(place, it)| it.as_ref().map_or_else(|| drive(place), link))
                .collect();
            match index {
                0 => names.join(" and "),
                _ => format!(
                    "from {} {}",
                    units.text(*since, Dimension::TIME),
                    names.join(" and ")
                ),
            }
        })
        .collect();
    if told.len() > TOLD {
        parts.push(format!("and so on, {} times", told.len() - 1));
    }
    (!parts.is_empty()).then(|| parts.join(", "))
}

/// What happened, in words.
pub(super) fn happened(
    model: &Model,
    units: &Units,
    study: &SimulateStudy,
    stops: &[Named],
    found: &Simulated,
) -> Option<Listing> {
    let name = |index: &usize| stops.get(*index).map_or("", |stop| stop.text.as_str());
    let speed = |index: &usize, rate: f64| {
        let is_angle = stops.get(*index).is_some_and(|stop| stop.is_angle);
        let coordinate = if is_angle {
            Dimension::ANGLE
        } else {
            Dimension::LENGTH
        };
        units.text(rate, coordinate / Dimension::TIME)
    };
    // Contacts in joints have a list of their own.
    let told =
        |it: &&Happening| !matches!(it.what, Happened::Meets { .. } | Happened::Separates { .. });
    let all = found.happenings.iter().filter(told);
    let count = all.clone().count();
    let rows = all.take(LISTED).map(|it| {
        let what = match &it.what {
            Happened::Meets { .. } | Happened::Separates { .. } => String::new(),
            Happened::Strikes {
                stop,
                before,
                after,
            } => {
                let after = match *after > -STAYS * before {
                    true => format!("leaves at {}", speed(stop, *after)),
                    false => "stays".to_owned(),
                };
                let before = speed(stop, -before);
                format!("strikes {} at {before}, {after}", name(stop))
            }
            Happened::Touches { stop, speed: rate } => {
                format!("touches {} at {}", name(stop), speed(stop, *rate))
            }
            Happened::Rests { stop } => format!("rests on {}", name(stop)),
            Happened::Leaves { stop } => format!("leaves {}", name(stop)),
            Happened::Sticks => "friction holds it".to_owned(),
            Happened::Slips => "friction lets it go".to_owned(),
            Happened::Holds { place } => format!("friction holds {}", rubs(*place)),
            Happened::LetsGo { place } => format!("friction lets {} go", rubs(*place)),
            Happened::Switches { switch, on } => {
                let named = model.actions.switches.get(*switch);
                let name = named.map_or("", |s| s.name.as_str());
                format!("{name} goes {}", if *on { "on" } else { "off" })
            }
            Happened::Counts { switch, to } => {
                let named = model.actions.switches.get(*switch);
                let name = named.map_or("", |s| s.name.as_str());
                format!("{name} counts {to}")
            }
            Happened::Cavitates { free, side } => {
                format!("{} falls below vacuum", chamber(model, study, *free, *side))
            }
            Happened::Ends { condition } => {
                let text = study
                    .end_when
                    .get(*condition)
                    .map_or("", |c| c.text.as_str());
                format!("it ends: {text}")
            }
        };
        vec![units.text(it.time, Dimension::TIME), what]
    });
    let mut rows: Vec<Vec<String>> = rows.collect();
    let more = count.saturating_sub(LISTED);
    if more > 0 {
        rows.push(vec!["…".to_owned(), format!("and {more} more")]);
    }
    (!rows.is_empty()).then(|| Listing {
        title: "What happened".to_owned(),
        head: vec!["time".to_owned(), "what".to_owned()],
        rows,
    })
}
