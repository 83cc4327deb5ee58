//! Why there is no simulation, why it ended early, and where its oil boils.

use kempe_mechanism::evidence::NEARLY_SINGULAR;
use kempe_mechanism::{Design, NotCut, NotReleased};
use kempe_model::Diagnostic;
use kempe_motion::Stage;
use kempe_number::text::significant;
use kempe_simulate::{
    Ending, Happened, Lack, NoStart, NoTree, Simulated, Sought, Tied, Unsimulated,
};
use kempe_units::Dimension;

use crate::along::force_problems;
use crate::clearance::not_released;
use crate::explain::{cannot_move, stopped};
use crate::words::source_name;

use super::happened::most_frequent;
use super::told::{Told, place_name};

/// Among so many things that happened last what is most frequent is what repeats.
const REPEATS: usize = 500;

/// What can be done where something has no value.
const GIVE_VALUE: &str = "look in it for a quotient by zero, for the root, the logarithm or the asin of what has none, or for what has no direction there";

/// That it ended before it was to, in a pose that has this smallest singular value.
pub(super) fn early(
    told: &Told<'_>,
    found: &Simulated,
    regular: impl FnOnce() -> f64,
) -> Option<Diagnostic> {
    let at = told.units.text(found.end, Dimension::TIME);
    let mut span = None;
    let mut sought = |it: Sought| {
        let (name, place) = told.sought(it);
        span = place;
        name
    };
    let (why, help) = match found.ending {
        Ending::Until | Ending::Condition(_) | Ending::Stopped => return None,
        Ending::Limit(_) => match found.tied {
            None => (
                "what is let go comes to a dead point of its own, and no link turns on there whose angle would tell where the mechanism goes".to_owned(),
                "let another drive go, one whose coordinate goes on there",
            ),
            Some(tied) => {
                let (why, help) = at_own_dead_point(tied);
                let why = format!("what is let go comes to a dead point of its own, and ends there, because {why}");
                (why, help)
            }
        },
        Ending::NoWay(lack) => no_way(told, found.tied, lack),
        Ending::NoValue(it) => {
            let why = format!("{} has no finite value from there on", sought(it));
            (why, GIVE_VALUE)
        }
        Ending::Unyielding(stop) => kept_from_stop(told, stop),
        Ending::NoLength(drive) => (
            format!("the two points of the cylinder `{}` meet there, and it has no length", told.drive(drive)),
            "let it stop before, by `stops`, end the study there by `end_when`, or let a drive go that turns a link",
        ),
        Ending::RunsAway(it) => {
            let why = format!("{} grows without bound there, so that no step is short enough", sought(it));
            (why, "bound it, as by min() or max(), or end the study before, by `until` or `end_when`")
        }
        Ending::TooShort => match regular() {
            regular if regular <= NEARLY_SINGULAR => (
                format!("no step is short enough: it comes to a change point or a dead point (smallest singular value {})", significant(regular, 2)),
                match told.contacts.is_empty() {
                    true => "such places are passed where it goes through them, and not slowly nor right behind an event: start otherwise, or end before, by `until` or `end_when`",
                    false => "joints with play do not pass such places: let another drive go, one that turns on there, end before, by `until` or `end_when`, or leave the play out",
                },
            ),
            _ => (
                "no step is short enough: something runs away, jumps, or is very stiff".to_owned(),
                "look for a load, spring or stop that is very large there, or ask for a larger `tolerance`",
            ),
        },
        Ending::TooManySteps => (
            "it takes more steps than are made".to_owned(),
            "ask for a shorter time or a larger `tolerance`, or for method = \"implicit\" where something is stiff",
        ),
        Ending::TooManyEvents => repeats(told, found),
    };
    let model = told.model;
    let drives: Vec<String> = (found.laws.iter().zip(&model.drives))
        .map(|(law, drive)| {
            let q = law.at(found.end, &[]);
            format!("{} = {}", drive.name, told.units.text(q, drive.dimension))
        })
        .collect();
    let message = format!(
        "study `{}`: the simulation goes no farther than {at}",
        told.name
    );
    let error = Diagnostic::error("simulation-ended", message);
    let error = match span {
        Some(span) => error.at(span, ""),
        None => error,
    };
    Some(
        error
            .note(format!("{why} ({})", drives.join(", ")))
            .help(help),
    )
}

/// What happens again and again, and what can be done.
fn repeats(told: &Told<'_>, found: &Simulated) -> (String, &'static str) {
    const RATTLES: &str = "look for stops between which it rattles, or for what it switches to and fro; let the stop take more of the speed, or ask for a shorter time";
    const SWITCHES: &str = "where it is on and where it is off it goes back at once: give the switch an `off` of its own, apart from `on`";
    const HOLDS: &str = "ask for a smaller `tolerance`, or for a shorter time";
    let Some(line) = most_frequent(told, found, REPEATS) else {
        return ("more happens than is followed".to_owned(), RATTLES);
    };
    let what = told.what(&line.first.what);
    let (what, help) = match line.first.what {
        Happened::Switches { .. } => (what, SWITCHES),
        Happened::Counts { .. }
        | Happened::Cavitates { .. }
        | Happened::Jumps { .. }
        | Happened::Ends { .. } => (what, RATTLES),
        Happened::Sticks | Happened::Slips | Happened::Holds { .. } | Happened::LetsGo { .. } => {
            (what, HOLDS)
        }
        Happened::Meets { .. }
        | Happened::Separates { .. }
        | Happened::Strikes { .. }
        | Happened::Touches { .. }
        | Happened::Rests { .. }
        | Happened::Leaves { .. } => (format!("it {what}"), RATTLES),
    };
    let time = |t: f64| told.units.text(t, Dimension::TIME);
    let why = format!(
        "more happens than is followed: {what} {} times between {} and {}",
        line.count,
        time(line.first.time),
        time(line.last)
    );
    (why, help)
}

/// Why nothing is known of accelerations just ahead.
fn no_way(told: &Told<'_>, tied: Option<Tied>, lack: Lack) -> (String, &'static str) {
    match (lack, tied) {
        (Lack::Pose, Some(tied)) => {
            let (why, help) = at_own_dead_point(tied);
            let why = format!("no pose was found just ahead: what is let go comes to a dead point of its own, and ends there, because {why}");
            (why, help)
        }
        (Lack::Pose, None) => (
            "no pose was found just ahead: what is let go comes to a dead point of its own where no link turns on".to_owned(),
            "let another drive go, one whose coordinate goes on there, or keep it from there by `stops`",
        ),
        (lack, _) => lacks(told, lack),
    }
}

/// Why nothing is known of accelerations, and what can be done.
fn lacks(told: &Told<'_>, lack: Lack) -> (String, &'static str) {
    match lack {
        Lack::Pose => (
            "the pose there is singular: it stands at a dead point of what is let go, along which it moves in no direction".to_owned(),
            "start a little beside the dead point, or let another drive go, one whose coordinate goes on there",
        ),
        Lack::Value(sought) => {
            let why = format!("{} has no finite value there", told.sought(sought).0);
            (why, GIVE_VALUE)
        }
        Lack::Oil(drive) => (
            format!("on one side of the cylinder of `{}` there is no oil left", told.drive(drive)),
            "give more `volume`, or let its stroke end before, by `closed` and `stroke` or by `stops`",
        ),
        Lack::Mass if !told.contacts.is_empty() => (
            "what is let go moves no mass: its acceleration is not determined".to_owned(),
            "give every link that a joint with play lets go its mass and inertia, or take play from the joint",
        ),
        Lack::Mass => (
            "what is let go moves no mass: its acceleration is not determined".to_owned(),
            "give the links that move their mass and inertia, or hold the drive that moves none",
        ),
        Lack::Friction => (
            "friction jams it, or lets it move in more than one way: its acceleration is not determined".to_owned(),
            "lower the coefficients, or start elsewhere",
        ),
        Lack::Wedged(at) => (
            format!(
                "friction wedges {}: the bodies slide so that what holds them apart presses them together as much, and no acceleration is possible, or several are (Painlevé's paradox)",
                place_name(told.model, told.contacts, at)
            ),
            "lower the friction of that contact, let its bodies give by another `law`, or end the study before",
        ),
        Lack::Force => (
            "a force is infinite there, or has no direction, as that of a spring or damper whose ends lie upon each other".to_owned(),
            "keep the ends of what acts apart, by `stops` or by where they are",
        ),
        Lack::Rest => (
            "it rests on stops that repeat each other, so that what each of them pushes is not known".to_owned(),
            "leave one of these stops out",
        ),
    }
}

/// That what a stop bounds goes by drives that keep their laws, and what can be done.
fn kept_from_stop(told: &Told<'_>, stop: usize) -> (String, &'static str) {
    (
        format!(
            "nothing that is let go gives way at {}: what it bounds goes by drives that keep their laws, or by time, whatever stands in its way",
            told.stop(stop)
        ),
        "let the drive go that moves it, by `release`, end its law before the stop, or leave the stop out",
    )
}

/// Why no link tells the place in the stead of a drive at its dead point, and what can be done.
fn at_own_dead_point(tied: Tied) -> (&'static str, &'static str) {
    match tied {
        Tied::Play => (
            "joints with play are told by how far they stand open, and no link's angle tells that",
            "end it before, by `until` or `end_when`, keep it from there by `stops`, or leave the play out where the mechanism gets straight",
        ),
        Tied::Oil => (
            "what its oil gives goes by the drive's own length, and no link's angle tells that",
            "let the stroke end before there, by `stroke` of the oil or by `stops`, or end the study there by `end_when`",
        ),
        Tied::Throttle => (
            "what a throttled motor gives goes by the drive's own angle, and no link's angle tells that",
            "leave the throttle out, let a drive go whose coordinate goes on there, or end the study there by `end_when`",
        ),
        Tied::Asked => (
            "a load, stop, switch or condition asks for a derivative along it, which has no bound there",
            "ask for something else, such as rate(), or let a drive go whose coordinate goes on there",
        ),
    }
}

/// That the pressure in a cylinder fell below that of a vacuum, where it did first.
pub(super) fn cavitation(told: &Told<'_>, found: &Simulated) -> Option<Diagnostic> {
    let first = found.happenings.iter().find_map(|it| match it.what {
        Happened::Cavitates { free, side } => Some((it.time, free, side)),
        _ => None,
    });
    let (time, free, side) = first?;
    let message = format!(
        "{} falls below that of a vacuum at {}: oil would boil or let its air go, and what follows is not known",
        told.chamber(free, side),
        told.units.text(time, Dimension::TIME)
    );
    let warning = Diagnostic::warning("cavitation", message);
    let drive = told.study.released.get(free);
    let span = drive.and_then(|drive| Some(told.model.drives.get(drive.index())?.span.clone()));
    Some(
        warning
            .at(span.unwrap_or_default(), "")
            .help("let more oil in on that side, move more slowly, or hold the load with pressure on the other side"),
    )
}

/// That there is no simulation.
fn cannot(told: &Told<'_>, why: &str) -> Diagnostic {
    Diagnostic::error("cannot-simulate", format!("study `{}`: {why}", told.name))
}

/// Why there is no simulation.
pub(super) fn explain(
    design: &Design<f64>,
    told: &Told<'_>,
    error: Unsimulated,
) -> Vec<Diagnostic> {
    let (model, units) = (told.model, &told.units);
    let cannot = |message: String| cannot(told, &message);
    let error = match error {
        Unsimulated::Problems(problems) => return force_problems(problems),
        Unsimulated::Start(NoStart::Motion(error)) | Unsimulated::Motion(error) => {
            cannot_move(design, &error)
        }
        Unsimulated::Start(NoStart::NotReached(drive, reached)) => {
            let Some(drive) = model.drives.get(drive.index()) else {
                return vec![stopped(Stage::Simulating)];
            };
            let at = units.text(reached, drive.dimension);
            cannot(format!(
                "drive `{}` does not come to where it is to start: it comes to {at}",
                drive.name
            ))
            .at(drive.span.clone(), "")
            .help("start it where it comes to, or describe another assembly under [assembly]")
        }
        Unsimulated::Lacks(lack) => {
            let (why, help) = lacks(told, lack);
            let error = cannot(format!("it cannot begin: {why}")).help(help);
            match lack {
                Lack::Mass => error.note("links have no mass unless it is given"),
                _ => error,
            }
        }
        Unsimulated::NoValue(sought) => {
            let (what, span) = told.sought(sought);
            let error = cannot(format!(
                "it cannot begin: {what} has no finite value at the start"
            ));
            let error = match span {
                Some(span) => error.at(span, ""),
                None => error,
            };
            error.help(GIVE_VALUE)
        }
        Unsimulated::KeptFromStop(stop) => {
            let (why, help) = kept_from_stop(told, stop);
            cannot(why).help(help)
        }
        Unsimulated::AtChangePoint => {
            cannot("it cannot begin: it starts at a change point, where two branches cross".to_owned())
                .note("what acts decides which way it goes, and [assembly] tells the branches apart beside that place alone")
                .help("start a little beside it: `start` tells where; change points on the way are passed")
        }
        Unsimulated::BeyondStop(index, by) => beyond_stop(told, index, by),
        Unsimulated::BeyondPlay(place, by) => {
            let place = place_name(model, told.contacts, place);
            let by = units.text(by, Dimension::LENGTH);
            cannot(format!("{place} starts with its bodies in each other, by {by}"))
                .help("`start` in a study of clearance tells where a pin or slider is in its play, seen from the middle: no farther off than radial")
        }
        Unsimulated::NoPlay(why) => not_released(&design.mechanism, why),
        Unsimulated::NoTree(why) => no_tree(told, why),
    };
    let mut studies = model.studies.iter();
    vec![match studies.find(|study| study.name == told.name) {
        // What has no place of its own is said of the study.
        Some(study) if error.labels.is_empty() => error.at(study.span.clone(), ""),
        _ => error,
    }]
}

/// Why there are no coordinates of a spanning tree.
fn no_tree(told: &Told<'_>, why: NoTree) -> Diagnostic {
    let model = told.model;
    let (mut span, mut note) = (None, None);
    let why = match why {
        NoTree::Friction => "friction acts, and what joints carry is not known there".to_owned(),
        NoTree::Play => "joints have play, which is minimal coordinates' alone".to_owned(),
        NoTree::Along => {
            "a load, stop, switch or condition asks for a derivative along a drive, and loops are open there".to_owned()
        }
        NoTree::Cut(NotCut::OnCurve(source)) => {
            let name = source_name(model, source);
            format!("the pin of {name} runs on a smooth curve, whose place there is no coordinate")
        }
        NoTree::Cut(NotCut::Unreached(link)) => {
            let link = &model.links[link.index()];
            span = Some(link.span.clone());
            note = Some("the tree is made of pins and of straight slides");
            format!("no pin and no straight slide leads to link `{}`", link.name)
        }
        NoTree::Cut(NotCut::Closes(drive)) => {
            let drive = &model.drives[drive.index()];
            span = Some(drive.span.clone());
            format!(
                "drive `{}` moves what other drives move already",
                drive.name
            )
        }
        NoTree::Cut(NotCut::NotReleased(NotReleased::CarriesWheel(source))) => {
            let name = source_name(model, source);
            format!("{name} would have to be cut, where a wheel of gears or a belt turns")
        }
        NoTree::Cut(_) => "its loops cannot be cut".to_owned(),
    };
    let error = cannot(
        told,
        &format!("there are no coordinates of a spanning tree: {why}"),
    );
    let error = match span {
        Some(span) => error.at(span, ""),
        None => error,
    };
    let error = match note {
        Some(note) => error.note(note),
        None => error,
    };
    error.help("leave out `coordinates`: minimal ones do without")
}

/// That it starts beyond a stop of the study, or outside the stroke of a cylinder, by so much.
fn beyond_stop(told: &Told<'_>, index: usize, by: f64) -> Diagnostic {
    let stop = told.stops.get(index);
    let is_angle = stop.is_some_and(|stop| stop.is_angle);
    let dimension = if is_angle {
        Dimension::ANGLE
    } else {
        Dimension::LENGTH
    };
    let by = told.units.text(by, dimension);
    let cannot = |message: String| cannot(told, &message);
    let Some((drive, stroke)) = stop.and_then(|stop| stop.stroke) else {
        return cannot(format!("it starts beyond {}, by {by}", told.stop(index)))
            .help("start between the stops, or move them");
    };
    let [closed, open] = told.units.texts(stroke, dimension);
    let cylinders = &told.model.actions.cylinders;
    let cylinder = cylinders.iter().find(|it| it.drive == drive);
    let error = cannot(format!(
        "drive `{}` starts outside the stroke of its cylinder, by {by}: that goes from {closed} to {open}",
        told.drive(drive)
    ));
    let error = match cylinder {
        Some(cylinder) => error.at(cylinder.span.clone(), ""),
        None => error,
    };
    error.help("start the drive within the stroke, or change `closed` and `stroke` of the oil")
}
