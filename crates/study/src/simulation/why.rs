//! Why there is no simulation, why it ended early, and where its oil boils.

use kempe_mechanism::Design;
use kempe_model::{Contact, Diagnostic, Model, SimulateStudy};
use kempe_motion::{EndReason, Stage};
use kempe_simulate::{Ending, Happened, NoStart, Simulated, Tied, Unsimulated};
use kempe_units::Dimension;

use crate::along::force_problems;
use crate::clearance::not_released;
use crate::explain::{cannot_move, stopped};
use crate::unit::Units;

use super::question::Named;
use super::words::{chamber, place_name};

/// That it ended before it was to.
pub(super) fn early(model: &Model, units: &Units, found: &Simulated) -> Option<Diagnostic> {
    let at = units.text(found.end, Dimension::TIME);
    let (why, help) = match found.ending {
        Ending::Until | Ending::Condition(_) | Ending::Stopped => return None,
        Ending::Limit(EndReason::Covered) | Ending::NoWay => match found.tied {
            None => (
                "no pose or no acceleration was found just ahead: nothing moves mass there, or what is let go comes to a dead point where no link turns on".to_owned(),
                "give the links that move there mass and inertia, or let another drive go, one whose coordinate goes on there",
            ),
            Some(tied) => {
                let (why, help) = at_own_dead_point(tied);
                let why = format!(
                    "no pose or no acceleration was found just ahead: nothing moves mass there, or what is let go comes to a dead point of its own, where it ends, because {why}"
                );
                (why, help)
            }
        },
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
        Ending::TooShort => (
            "no step is short enough: something runs away, jumps, or is very stiff".to_owned(),
            "look for a load, spring or stop that is very large there, or ask for a larger `tolerance`",
        ),
        Ending::TooMany => (
            "there is no end of steps or impacts".to_owned(),
            "look for stops between which it rattles, or loads that jump to and fro, or ask for a shorter time",
        ),
    };
    let drives: Vec<String> = (found.laws.iter().zip(&model.drives))
        .map(|(law, drive)| {
            let q = law.at(found.end, &[]);
            format!("{} = {}", drive.name, units.text(q, drive.dimension))
        })
        .collect();
    Some(
        Diagnostic::error(
            "simulation-ended",
            format!("the simulation goes no farther than {at}"),
        )
        .note(format!("{why} ({})", drives.join(", ")))
        .help(help),
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
pub(super) fn cavitation(
    model: &Model,
    units: &Units,
    study: &SimulateStudy,
    found: &Simulated,
) -> Option<Diagnostic> {
    let first = found.happenings.iter().find_map(|it| match it.what {
        Happened::Cavitates { free, side } => Some((it.time, free, side)),
        _ => None,
    });
    let (time, free, side) = first?;
    let message = format!(
        "{} falls below that of a vacuum at {}: oil would boil or let its air go, and what follows is not known",
        chamber(model, study, free, side),
        units.text(time, Dimension::TIME)
    );
    let warning = Diagnostic::warning("cavitation", message);
    let drive = study.released.get(free);
    let span = drive.and_then(|drive| Some(model.drives.get(drive.index())?.span.clone()));
    Some(
        warning
            .at(span.unwrap_or_default(), "")
            .help("let more oil in on that side, move more slowly, or hold the load with pressure on the other side"),
    )
}

/// Why there is no simulation.
pub(super) fn explain(
    design: &Design<f64>,
    stops: &[Named],
    contacts: &[Contact],
    error: Unsimulated,
) -> Vec<Diagnostic> {
    let model = &design.mechanism.model;
    let units = Units::of(model);
    let cannot = |message: String| Diagnostic::error("cannot-simulate", message);
    vec![match error {
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
        Unsimulated::NoMass => cannot(
            "what is let go moves no mass, or friction jams it: its acceleration is not determined"
                .to_owned(),
        )
        .note("links have no mass unless it is given")
        .help("give the links that move their mass and inertia, or start away from a dead point"),
        Unsimulated::BeyondStop(index, by) => {
            let stop = stops.get(index);
            let (name, is_angle) = stop.map_or(("", false), |s| (s.owner.as_str(), s.is_angle));
            let dimension = if is_angle {
                Dimension::ANGLE
            } else {
                Dimension::LENGTH
            };
            cannot(format!(
                "it starts beyond the stop of `{name}`, by {}",
                units.text(by, dimension)
            ))
            .help("start between the stops, or move them")
        }
        Unsimulated::BeyondPlay(place, by) => {
            let place = place_name(model, contacts, place);
            let by = units.text(by, Dimension::LENGTH);
            cannot(format!("{place} starts with its bodies in each other, by {by}"))
                .help("`start` in a study of clearance tells where a pin or slider is in its play, seen from the middle: no farther off than radial")
        }
        Unsimulated::NoPlay(why) => not_released(&design.mechanism, why),
    }]
}
