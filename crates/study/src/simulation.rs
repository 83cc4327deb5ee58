//! Simulations: how a mechanism moves in time where drives are let go.
//!
//! What `kempe-simulate` finds are laws of the drives. The rows are those of a study of forces along the motion by these laws:
//! every measure is there, and inverse dynamics, which knows nothing of the simulation, must find that a drive that was let go
//! gives nothing.

use std::sync::Arc;

use kempe_mechanism::Design;
use kempe_model::{
    Amount, Chamber, Contact, Diagnostic, DriveId, ForceMeasure, Leaf, LinkId, Model, MotionStudy,
    Released, Rows, SimulateStudy, StepMethod, StopResistance, StudyKind, value,
};
use kempe_motion::progress::{Progress, Silent};
use kempe_motion::{EndReason, Motion, Stage};
use kempe_simulate::{
    Ending, Happened, Happening, Held, Method, NoStart, Place, Question, Resistance, Simulated,
    Stop, Unsimulated, simulate,
};
use kempe_units::{Dimension, Expr};

use crate::along::{force_problems, is_followed};
use crate::clearance::{joint_name, not_released};
use crate::explain::{cannot_move, stopped};
use crate::motion::rows_of;
use crate::motion_findings::{motion_findings, refused};
use crate::prepared::design;
use crate::quantity::Quantity;
use crate::result::{Listing, StudyResult};
use crate::rows::count;
use crate::table::{BalanceColumns, largest};
use crate::unit::Units;

/// Error of a step where the file does not say, in parts of what moves.
const TOLERANCE: f64 = 1e-13;
/// A balance that is off by more than this, or by more than a larger tolerance asks for, is told ...
const OFF: [(&str, f64); 2] = [("energy", 1e-8), ("power", 1e-6)];
/// ... and by more than this in any case.
const WRONG: f64 = 1e-3;
/// Where less than this part of the energies is moved, nothing moves: a balance is in parts of this.
const STANDS: f64 = 1e-9;
/// No step is better than that.
const FINEST: f64 = 1e-15;
/// A speed below this part of that before an impact is none.
const STAYS: f64 = 1e-9;
/// At most so many things that happened are listed.
const LISTED: usize = 30;
/// At most so many changes of what tells the place are listed.
const TOLD: usize = 4;

/// The motion that a simulation of the model finds.
///
/// # Errors
///
/// That there is no such simulation, and what keeps it from starting.
pub(crate) fn simulated_motion(
    model: &Model,
    name: &str,
    progress: &mut dyn Progress,
) -> Result<Arc<Motion>, Vec<Diagnostic>> {
    let named = model.studies.iter().find(|s| s.name == name);
    let Some(StudyKind::Simulate(study)) = named.map(|s| &s.kind) else {
        let message = format!("there is no simulation called `{name}`");
        return Err(vec![Diagnostic::error("unknown-name", message)]);
    };
    let run = Run::new(model, &with_strokes(model, study), &[], progress)?;
    run.motion(progress)
}

/// A simulation that was run.
struct Run {
    design: Design<f64>,
    question: Question,
    /// What stops it, as the question has them.
    stops: Vec<Named>,
    found: Simulated,
    /// What is to be told of the mechanism, whatever moves it.
    findings: Vec<Diagnostic>,
}

impl Run {
    fn new(
        model: &Model,
        study: &SimulateStudy,
        contacts: &[Contact],
        progress: &mut dyn Progress,
    ) -> Result<Self, Vec<Diagnostic>> {
        let design = design(model);
        let unknown = unfollowed(&design, study);
        if !unknown.is_empty() {
            return Err(unknown);
        }
        let (mut question, mut stops) = question(study, model, &design.parameters);
        question.contacts = contacts.to_vec();
        let found = simulate(&design, &question, progress)
            .map_err(|error| explain(&design, &stops, error))?;
        let rigid = found.rigid.iter();
        stops.extend(rigid.map(|at| Named {
            owner: String::new(),
            text: place_name(model, contacts, *at),
            is_angle: false,
        }));
        let findings = motion_findings(&found.first);
        if refused(&found.first) {
            return Err(findings);
        }
        Ok(Self {
            design,
            question,
            stops,
            found,
            findings,
        })
    }

    fn motion(&self, progress: &mut dyn Progress) -> Result<Arc<Motion>, Vec<Diagnostic>> {
        (self.found.motion(progress)).map_err(|error| vec![cannot_move(&self.design, &error)])
    }
}

/// A simulation, where joints have contacts also of these.
pub(crate) fn simulation(
    model: &Model,
    name: &str,
    study: &SimulateStudy,
    contacts: &[Contact],
    progress: &mut dyn Progress,
) -> Result<(StudyResult, Simulated), Vec<Diagnostic>> {
    let study = &with_strokes(model, study);
    let run = Run::new(model, study, contacts, progress)?;
    // What was found until it was stopped is shown.
    let was_stopped = run.found.ending == Ending::Stopped;
    let progress: &mut dyn Progress = if was_stopped { &mut Silent } else { progress };
    let motion = run.motion(progress)?;
    let Run {
        question,
        stops,
        found,
        findings: mut diagnostics,
        ..
    } = run;
    let hidden = hidden(&found.telling(), &found);
    let along = in_time(&study.along, question.until);
    let (mut result, values) = rows_of(
        &motion,
        &found.mechanism(),
        name,
        &along,
        (true, 0, &hidden),
        progress,
    )?;
    diagnostics.append(&mut result.diagnostics);
    let units = Units::of(model);
    let times = result
        .table
        .columns
        .first()
        .map(|c| c.si())
        .unwrap_or_default();
    let balance = balance(&question, &found, &times, &values);
    diagnostics.extend(out_of_balance(
        name,
        &units,
        &balance,
        &times,
        question.tolerance,
    ));
    diagnostics.extend(early(model, &units, &found));
    diagnostics.extend(cavitation(model, &units, study, &found));
    result.table.balance = Some(balance);
    for (note, time) in result.table.notes.iter_mut().zip(&times) {
        let held = held_at(&found, *time).map(|held| what_holds(held, &stops));
        let all: Vec<String> = note.take().into_iter().chain(held).collect();
        *note = (!all.is_empty()).then(|| all.join("; "));
    }
    result.listings.push(how(model, &question, &found, &result));
    result
        .listings
        .extend(happened(model, &units, study, &stops, &found));
    if was_stopped {
        let all = count(
            model,
            &along.rows,
            &model.parameter_values(),
            question.until,
        );
        result.demanded_rows = (all as usize).max(result.table.rows() + 1);
    }
    result.diagnostics = diagnostics;
    Ok((result, found))
}

/// What goes by the pressure of a cylinder that the study does not let go.
fn unfollowed(design: &Design<f64>, study: &SimulateStudy) -> Vec<Diagnostic> {
    let model = &design.mechanism.model;
    let actions = &model.actions;
    let measure = |amount: &Amount| match amount {
        Amount::Measure(measure) => measure.clone(),
        Amount::Table { over, .. } => (**over).clone(),
    };
    let loads = actions.loads.iter().flat_map(|load| {
        let measures = load.kind.amounts().map(measure);
        measures.map(|m| (format!("the load `{}`", load.name), m, load.span.clone()))
    });
    let name = |drive: DriveId| {
        model
            .drives
            .get(drive.index())
            .map_or("", |d| d.name.as_str())
    };
    let valves = (actions.cylinders.iter())
        .filter(|cylinder| study.released.contains(&cylinder.drive))
        .flat_map(|cylinder| {
            let oil = cylinder.oil.iter();
            let openings = oil.flat_map(|oil| std::iter::once(&oil.valve.0).chain(&oil.valve.1));
            let what = format!("the valve of `{}`", name(cylinder.drive));
            openings.map(move |it| (what.clone(), measure(it), cylinder.span.clone()))
        });
    let throttles = (actions.motors.iter())
        .filter(|motor| study.released.contains(&motor.drive))
        .filter_map(|motor| {
            let what = format!("the throttle of `{}`", name(motor.drive));
            Some((what, measure(motor.throttle.as_ref()?), motor.span.clone()))
        });
    let switches = actions.switches.iter().flat_map(|switch| {
        let conditions = std::iter::once(&switch.on).chain(&switch.off);
        let what = format!("the switch `{}`", switch.name);
        conditions.map(move |it| (what.clone(), it.above.clone(), switch.span.clone()))
    });
    let ends = study.end_when.iter();
    let ends = ends.map(|it| (format!("`{}`", it.text), it.above.clone(), 0..0));
    let all = (loads.chain(valves))
        .chain(throttles)
        .chain(switches)
        .chain(ends);
    let unknown = all.filter(|(_, measure, _)| !is_followed(&design.mechanism, study, measure));
    let told = unknown.map(|(what, _, span)| {
        let message = format!(
            "{what} goes by the pressure of a cylinder that keeps its law: nothing follows its oil"
        );
        let error = Diagnostic::error("needs-simulation", message);
        let error = if span.is_empty() {
            error
        } else {
            error.at(span, "")
        };
        error.help(
            "let its drive go too, by `release`, or go by where things are and how fast they move",
        )
    });
    told.collect()
}

/// The study with the ends of the strokes of cylinders that their oil moves as stops, where it has none of its own for them.
fn with_strokes(model: &Model, study: &SimulateStudy) -> SimulateStudy {
    let mut study = study.clone();
    for cylinder in &model.actions.cylinders {
        let drive = cylinder.drive;
        let what = Expr::Leaf(Leaf::Drive(drive));
        let told = study.stops.iter().any(|stop| stop.what == what);
        let stroke = cylinder.oil.as_ref().and_then(|oil| oil.stroke.clone());
        let (Some([closed, stroke]), Some(named)) = (stroke, model.drives.get(drive.index()))
        else {
            continue;
        };
        if told || !study.released.contains(&drive) {
            continue;
        }
        let open = Expr::Add(Box::new(closed.clone()), Box::new(stroke));
        study.stops.push(kempe_model::Stop {
            name: named.name.clone(),
            what,
            is_angle: false,
            between: [Some(closed), Some(open)],
            resistance: StopResistance::Rigid { restitution: None },
        });
    }
    study
}

/// The rows of a study in time: so many over the whole time asked for, however early it ends.
fn in_time(study: &MotionStudy, until: f64) -> MotionStudy {
    let mut study = study.clone();
    if let Rows::Count(rows) = study.rows
        && rows > 1
    {
        study.rows = Rows::TimeStep(Expr::Const(until / (rows - 1) as f64));
    }
    study
}

/// Something that stops the motion, in words.
struct Named {
    /// What it stops, as the study calls it.
    owner: String,
    /// `the lower stop of rocker`.
    text: String,
    is_angle: bool,
}

/// What is asked, with its stops in words.
fn question(study: &SimulateStudy, model: &Model, parameters: &[f64]) -> (Question, Vec<Named>) {
    let number = |scalar: &kempe_model::Scalar| value(scalar, parameters);
    let start = study.released.iter().map(|drive| {
        let law = model.drives.get(drive.index()).map(|d| &d.law);
        let own = study.start.iter().find(|s| s.drive == *drive);
        let at = own.and_then(|s| s.at.as_ref()).map(number);
        let rate = own.and_then(|s| s.rate.as_ref()).map_or(0.0, number);
        let of_law = || law.map_or(0.0, |law| law.at(0.0, parameters));
        [at.unwrap_or_else(of_law), rate]
    });
    let (mut stops, mut names) = (Vec::new(), Vec::new());
    for stop in &study.stops {
        let resistance = match &stop.resistance {
            StopResistance::Rigid { restitution } => Resistance::Rigid {
                restitution: restitution.as_ref().map_or(0.0, number),
            },
            StopResistance::Soft { stiffness, damping } => Resistance::Soft {
                stiffness: number(stiffness),
                damping: damping.as_ref().map_or(0.0, number),
            },
        };
        for (least, gap) in stop.gaps() {
            stops.push(Stop { gap, resistance });
            let end = if least { "lower" } else { "upper" };
            names.push(Named {
                owner: stop.name.clone(),
                text: format!("the {end} stop of {}", stop.name),
                is_angle: stop.is_angle,
            });
        }
    }
    let question = Question {
        free: study.released.clone(),
        start: start.collect(),
        until: number(&study.until),
        tolerance: study
            .tolerance
            .as_ref()
            .map_or(TOLERANCE, number)
            .max(FINEST),
        method: match study.method {
            None => Method::Choose,
            Some(StepMethod::Explicit) => Method::Explicit,
            Some(StepMethod::Implicit) => Method::Implicit,
        },
        stops,
        end_when: study.end_when.iter().map(|c| c.above.clone()).collect(),
        contacts: Vec::new(),
    };
    (question, names)
}

/// Energies, the rate of the kinetic one, and effort, speed and what the throttle goes by of every drive that is let go.
fn hidden(free: &[DriveId], found: &Simulated) -> Vec<Quantity> {
    let force = |measure: ForceMeasure| Expr::Leaf(Leaf::Force(measure));
    let quantity = |measure| Quantity {
        name: String::new(),
        measure,
        dimension: Dimension::NONE,
    };
    let kinetic = force(ForceMeasure::KineticEnergy);
    let mut list = vec![
        quantity(kinetic.clone()),
        quantity(force(ForceMeasure::PotentialEnergy)),
        quantity(Expr::Leaf(Leaf::Rate(Box::new(kinetic), 1))),
    ];
    for (place, drive) in free.iter().enumerate() {
        list.push(quantity(force(ForceMeasure::Drive(*drive))));
        let coordinate = Box::new(Expr::Leaf(Leaf::Drive(*drive)));
        list.push(quantity(Expr::Leaf(Leaf::Rate(coordinate, 1))));
        let throttle = found.throttle(place).cloned();
        list.push(quantity(throttle.unwrap_or(Expr::Const(1.0))));
    }
    list
}

/// What holds it at a time.
fn held_at(found: &Simulated, time: f64) -> impl Iterator<Item = &Held> {
    // Times rise: of two that meet there, both hold.
    let first = found.held.partition_point(|held| held.to < time);
    let from = found.held.get(first..).unwrap_or(&[]).iter();
    from.take_while(move |held| held.holds_at(time))
}

/// What holds it, in words.
fn what_holds(held: &Held, stops: &[Named]) -> String {
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

/// How well energy and power balance.
fn balance(
    question: &Question,
    found: &Simulated,
    times: &[f64],
    values: &[Vec<f64>],
) -> BalanceColumns {
    let value = |index: usize, row: usize| {
        let column = values.get(index);
        column.and_then(|c| c.get(row)).copied().unwrap_or(f64::NAN)
    };
    let rows = 0..times.len();
    let works: Vec<f64> = times.iter().map(|t| found.work.at(*t, &[])).collect();
    let energy = |row: usize| value(0, row) + value(1, row);
    let moved = |row: usize| {
        let (kinetic, potential) = (value(0, row), value(1, row) - value(1, 0));
        kinetic.abs().max(potential.abs()).max(works[row].abs())
    };
    let there = |row: usize| value(0, row).abs().max(value(1, row).abs());
    let rounding = STANDS * rows.clone().map(there).fold(0.0, f64::max);
    let most = rows.clone().map(moved).fold(rounding, f64::max);
    let fastest = rows
        .clone()
        .map(|row| value(2, row).abs())
        .fold(most / question.until, f64::max);
    let part = |x: f64, of: f64| if x == 0.0 { 0.0 } else { x / of };
    let is_held = |t: f64| held_at(found, t).next().is_some();
    let asked = |row: usize| {
        (0..found.free.len())
            .map(|k| {
                let [effort, speed, throttled] = [0, 1, 2].map(|j| value(3 + 3 * k + j, row));
                (effort - found.gives(k, [times[row], speed], throttled)) * speed
            })
            .sum::<f64>()
    };
    BalanceColumns {
        energy: (rows.clone())
            .map(|row| part(energy(row) - energy(0) - works[row], most))
            .collect(),
        power: rows
            .map(|row| match is_held(times[row]) {
                true => f64::NAN,
                false => part(asked(row), fastest),
            })
            .collect(),
    }
}

/// A balance that does not come out.
fn out_of_balance(
    name: &str,
    units: &Units,
    balance: &BalanceColumns,
    times: &[f64],
    tolerance: f64,
) -> Vec<Diagnostic> {
    let worst = OFF.iter().zip([&balance.energy, &balance.power]);
    let worst = worst.map(|((what, least), column)| {
        let limit = least.max(tolerance).min(WRONG);
        let sizes: Vec<f64> = column.iter().map(|x| x.abs()).collect();
        let (row, off) = largest(&sizes).filter(|(_, off)| *off > limit)?;
        let at = units.text(times.get(row).copied().unwrap_or(f64::NAN), Dimension::TIME);
        let message = format!(
            "study `{name}`: the balance of {what} is off by {off:.1e} of the most that is moved, at {at}"
        );
        let warning = Diagnostic::warning("out-of-balance", message);
        Some(warning.help("ask for a smaller `tolerance`; where something jumps there, its size is uncertain"))
    });
    worst.flatten().collect()
}

/// That it ended before it was to.
fn early(model: &Model, units: &Units, found: &Simulated) -> Option<Diagnostic> {
    let at = units.text(found.end, Dimension::TIME);
    let (why, help) = match found.ending {
        Ending::Until | Ending::Condition(_) | Ending::Stopped => return None,
        Ending::Limit(EndReason::Covered) | Ending::NoWay => (
            "no pose or no acceleration was found just ahead: nothing moves mass there, or what is let go comes to a dead point where no link turns on",
            "give the links that move there mass and inertia, or let another drive go, one whose coordinate goes on there",
        ),
        Ending::Limit(_) => (
            "what is let go comes to a dead point of its own, and no link turns on there whose angle would tell where the mechanism goes",
            "let another drive go, one whose coordinate goes on there",
        ),
        Ending::TooShort => (
            "no step is short enough: something runs away, jumps, or is very stiff",
            "look for a load, spring or stop that is very large there, or ask for a larger `tolerance`",
        ),
        Ending::TooMany => (
            "there is no end of steps or impacts",
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

/// The pressure of a chamber: `the pressure on the bore's side of lift`.
fn chamber(model: &Model, study: &SimulateStudy, free: usize, side: Chamber) -> String {
    let drive = study.released.get(free);
    let drive = drive.and_then(|drive| model.drives.get(drive.index()));
    let side = match side {
        Chamber::Bore => "bore",
        Chamber::Ring => "rod",
    };
    let name = drive.map_or("", |drive| drive.name.as_str());
    format!("the pressure on the {side}'s side of {name}")
}

/// That the pressure in a cylinder fell below that of a vacuum, where it did first.
fn cavitation(
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

/// How it was done, and how well.
fn how(model: &Model, question: &Question, found: &Simulated, result: &StudyResult) -> Listing {
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
fn told(model: &Model, question: &Question, found: &Simulated) -> Option<String> {
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
fn happened(
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

/// Why there is no simulation.
fn explain(design: &Design<f64>, stops: &[Named], error: Unsimulated) -> Vec<Diagnostic> {
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
        Unsimulated::FrictionOfSeveral => cannot(
            "friction is simulated where one coordinate moves alone, and here several do"
                .to_owned(),
        )
        .note("which of several joints stick is not decided yet")
        .help(
            "let one drive go and hold the others, or describe what takes the energy by [dampers]",
        ),
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
        Unsimulated::NoPlay(why) => not_released(&design.mechanism, why),
    }]
}
