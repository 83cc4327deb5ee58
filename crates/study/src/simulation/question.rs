//! What a study asks of a simulation, and what it asks in vain.

use kempe_measure::measure::visit_leaves;
use kempe_mechanism::{Design, Mechanism};
use kempe_model::{
    Amount, CoordinateKind, Diagnostic, DriveId, Leaf, Measure, Model, SimulateStudy, StepMethod,
    StopResistance, value,
};
use kempe_simulate::{Coordinates, Method, Question, Resistance, Sought, Stop};
use kempe_units::Expr;

use crate::along::is_followed;

use super::points::point_of_measure;
use super::told::{Named, Told};

/// Error of a step where the file does not say, in parts of what moves.
const TOLERANCE: f64 = 1e-13;
/// No step is better than that.
const FINEST: f64 = 1e-15;
/// With a larger error of its steps nothing is told of a motion.
const COARSEST: f64 = 0.01;

/// What is asked, with its stops in words.
pub(super) fn question(study: &SimulateStudy, design: &Design<f64>) -> (Question, Vec<Named>) {
    let model = &design.mechanism.model;
    let parameters = &design.parameters;
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
    let own = study.stops.iter().map(|stop| (stop.clone(), None));
    let strokes = strokes(model, study);
    let strokes = strokes.into_iter().map(|(drive, stop)| {
        let between = stop.between.each_ref();
        let between = between.map(|end| end.as_ref().map_or(f64::NAN, number));
        (stop, Some((drive, between)))
    });
    for (stop, stroke) in own.chain(strokes) {
        let resistance = match &stop.resistance {
            StopResistance::Rigid { restitution } => Resistance::Rigid {
                restitution: restitution.as_ref().map_or(0.0, number),
            },
            StopResistance::Soft { stiffness, damping } => Resistance::Soft {
                stiffness: number(stiffness),
                damping: damping.as_ref().map_or(0.0, number),
            },
        };
        let point = point_of_measure(&design.mechanism, &stop.what);
        for (least, gap) in stop.gaps() {
            stops.push(Stop { gap, resistance });
            let end = if least { "lower" } else { "upper" };
            names.push(Named {
                text: format!("the {end} stop of {}", stop.name),
                is_angle: stop.is_angle,
                stroke,
                point,
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
        coordinates: match study.coordinates {
            None | Some(CoordinateKind::Minimal) => Coordinates::Minimal,
            Some(CoordinateKind::SpanningTree) => Coordinates::SpanningTree,
        },
        stops,
        end_when: study.end_when.iter().map(|c| c.above.clone()).collect(),
        contacts: Vec::new(),
    };
    (question, names)
}

/// That the error of a step that is asked for says nothing of a motion.
pub(super) fn too_coarse(
    name: &str,
    study: &SimulateStudy,
    parameters: &[f64],
) -> Option<Diagnostic> {
    let tolerance = value(study.tolerance.as_ref()?, parameters);
    let coarse = !(tolerance <= COARSEST);
    coarse.then(|| {
        let message = format!(
            "study `{name}`: a `tolerance` of {tolerance} tells nothing of the motion: it is the error of a step, in parts of what moves"
        );
        Diagnostic::error("cannot-simulate", message).help(format!(
            "ask for {COARSEST} at most; {TOLERANCE:e}, what it is unless said otherwise, takes little more time"
        ))
    })
}

/// That a condition that is to end it compares what never changes.
pub(super) fn idle_conditions(
    mechanism: &Mechanism,
    name: &str,
    study: &SimulateStudy,
) -> Vec<Diagnostic> {
    let is_constant = |measure: &Measure| {
        let mut constant = true;
        visit_leaves(mechanism, measure, &mut |leaf| {
            constant &= matches!(leaf, Leaf::Parameter(_) | Leaf::Named(_));
        });
        constant
    };
    let idle = study.end_when.iter().filter(|it| is_constant(&it.above));
    let idle = idle.map(|it| {
        let message = format!(
            "study `{name}`: the condition `{}` of `end_when` compares what never changes: it ends nothing",
            it.text
        );
        Diagnostic::warning("condition-idle", message)
            .note("a condition counts from where it did not hold")
            .help("compare something that changes along the motion, or leave it out")
    });
    idle.collect()
}

/// What goes by the pressure of a cylinder that the study does not let go.
pub(super) fn unfollowed(
    design: &Design<f64>,
    name: &str,
    study: &SimulateStudy,
) -> Vec<Diagnostic> {
    let model = &design.mechanism.model;
    let actions = &model.actions;
    let measure = |amount: &Amount| match amount {
        Amount::Measure(measure) => measure.clone(),
        Amount::Table { over, .. } => (**over).clone(),
    };
    let loads = actions.loads.iter().enumerate().flat_map(|(index, load)| {
        let measures = load.kind.amounts().map(measure);
        measures.map(move |m| (Sought::Load(index), m))
    });
    let valves = (actions.cylinders.iter())
        .filter(|cylinder| study.released.contains(&cylinder.drive))
        .flat_map(|cylinder| {
            let oil = cylinder.oil.iter();
            let openings = oil.flat_map(|oil| std::iter::once(&oil.valve.0).chain(&oil.valve.1));
            openings.map(move |it| (Sought::Valve(cylinder.drive), measure(it)))
        });
    let throttles = (actions.motors.iter())
        .filter(|motor| study.released.contains(&motor.drive))
        .filter_map(|motor| {
            Some((
                Sought::Throttle(motor.drive),
                measure(motor.throttle.as_ref()?),
            ))
        });
    let switches = (actions.switches.iter().enumerate()).flat_map(|(index, switch)| {
        let conditions = std::iter::once(&switch.on).chain(&switch.off);
        conditions.map(move |it| (Sought::Switch(index), it.above.clone()))
    });
    let ends = study.end_when.iter().enumerate();
    let ends = ends.map(|(index, it)| (Sought::Condition(index), it.above.clone()));
    let all = (loads.chain(valves))
        .chain(throttles)
        .chain(switches)
        .chain(ends);
    let unknown = all.filter(|(_, measure)| !is_followed(&design.mechanism, study, measure));
    let told = Told::new(model, (name, study), &[], &[]);
    let unknown = unknown.map(|(sought, _)| {
        let (what, span) = told.sought(sought);
        let message = format!(
            "study `{name}`: {what} goes by the pressure of a cylinder that keeps its law: nothing follows its oil"
        );
        let error = Diagnostic::error("needs-simulation", message);
        let error = match span {
            Some(span) => error.at(span, ""),
            None => error,
        };
        error.help(
            "let its drive go too, by `release`, or go by where things are and how fast they move",
        )
    });
    unknown.collect()
}

/// The ends of the strokes of cylinders that their oil moves, as stops, where the study has none of its own for them.
fn strokes(model: &Model, study: &SimulateStudy) -> Vec<(DriveId, kempe_model::Stop)> {
    let mut all = Vec::new();
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
        let stop = kempe_model::Stop {
            name: named.name.clone(),
            what,
            is_angle: false,
            between: [Some(closed), Some(open)],
            resistance: StopResistance::Rigid { restitution: None },
        };
        all.push((drive, stop));
    }
    all
}
