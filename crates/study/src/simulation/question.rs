//! What a study asks of a simulation, and what it asks in vain.

use kempe_mechanism::Design;
use kempe_model::{
    Amount, Diagnostic, DriveId, Leaf, Model, SimulateStudy, StepMethod, StopResistance, value,
};
use kempe_simulate::{Method, Question, Resistance, Stop};
use kempe_units::Expr;

use crate::along::is_followed;

/// Error of a step where the file does not say, in parts of what moves.
const TOLERANCE: f64 = 1e-13;
/// No step is better than that.
const FINEST: f64 = 1e-15;

/// Something that stops the motion, in words.
pub(super) struct Named {
    /// What it stops, as the study calls it.
    pub owner: String,
    /// `the lower stop of rocker`.
    pub text: String,
    pub is_angle: bool,
}

/// What is asked, with its stops in words.
pub(super) fn question(
    study: &SimulateStudy,
    model: &Model,
    parameters: &[f64],
) -> (Question, Vec<Named>) {
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

/// What goes by the pressure of a cylinder that the study does not let go.
pub(super) fn unfollowed(design: &Design<f64>, study: &SimulateStudy) -> Vec<Diagnostic> {
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
pub(super) fn with_strokes(model: &Model, study: &SimulateStudy) -> SimulateStudy {
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
