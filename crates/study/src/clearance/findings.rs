//! What is to be told of a study of clearance, whoever asks: `check` and `run` say the same.

use std::sync::Arc;

use kempe_dynamics::Acting;
use kempe_mechanism::{Design, Mechanism};
use kempe_model::{ClearanceStudy, Diagnostic, Measure, Model, Severity};
use kempe_motion::Motion;

use super::joints::Joints;
use crate::columns::{Asked, is_of_whole_motion};
use crate::findings_forces::nothing_acts;
use crate::prepared::design;
use crate::words::list;

/// Whether there is an error among what is told.
pub(crate) fn refuses(findings: &[Diagnostic]) -> bool {
    findings.iter().any(|d| d.severity == Severity::Error)
}

/// What a study of clearance works on.
pub(super) struct Prepared {
    /// The design without friction.
    pub design: Design<f64>,
    /// Where there is play.
    pub joints: Joints,
    /// What is asked.
    pub asked: Asked,
    /// What is to be told before anything moves; where there is an error in it, nothing can be found.
    pub findings: Vec<Diagnostic>,
}

impl Prepared {
    pub fn new(model: &Model, name: &str, study: &ClearanceStudy) -> Self {
        let mut findings = Vec::new();
        let model = without_friction(model, name, &mut findings);
        findings.extend(nothing_acts(&model));
        let design = design(&model);
        let mechanism = &*design.mechanism;
        let joints = Joints::new(mechanism, &design.parameters);
        findings.extend(joints.refused.iter().cloned());
        findings.extend(joints.left_out(&model));
        let asked = Asked::of_clearance(mechanism, &study.along);
        findings.extend(not_at_an_instant(mechanism, &asked));
        findings.extend(whole_motion_load(&design));
        Self {
            design,
            joints,
            asked,
            findings,
        }
    }
}

/// What is to be told of a study of clearance called `name` before its rows are known; of joints that repeat others, as they do
/// where a motion that is known starts.
pub(crate) fn findings_of_clearance(
    model: &Model,
    name: &str,
    study: &ClearanceStudy,
    motion: Option<&Arc<Motion>>,
) -> Vec<Diagnostic> {
    let it = Prepared::new(model, name, study);
    let repeated = || {
        let repeated = it.joints.repeated(motion?)?;
        repeat_each_other(name, &it.joints, &repeated)
    };
    let repeated = if refuses(&it.findings) {
        None
    } else {
        repeated()
    };
    it.findings.into_iter().chain(repeated).collect()
}

/// That joints with play repeat others, so that nothing is known of what their clearance does.
pub(super) fn repeat_each_other(
    name: &str,
    joints: &Joints,
    repeated: &[bool],
) -> Option<Diagnostic> {
    let of = |which: bool| -> Vec<String> {
        let names = joints.names.iter().zip(repeated);
        names
            .filter(|(_, repeated)| **repeated == which)
            .map(|(name, _)| name.clone())
            .collect()
    };
    let (repeated, alone) = (of(true), of(false));
    if repeated.is_empty() {
        return None;
    }
    let open = match repeated.as_slice() {
        [_] => "opens only as these let it",
        _ => "open only as these let them",
    };
    let message = format!(
        "study `{name}`: what clearance does is not known: other joints repeat {}, which {open}",
        list(&repeated)
    );
    let help = match alone.is_empty() {
        true => "take out the link or joint that repeats others".to_owned(),
        false => format!(
            "take out the link or joint that repeats others, or give clearance only where nothing is repeated: {}",
            list(&alone)
        ),
    };
    Some(
        Diagnostic::warning("clearance-undetermined", message)
            .note("equilibrium does not determine the loads of such joints, so nothing says where their contacts are; columns to first order are empty, too")
            .help(help),
    )
}

/// The model without friction, where it has some: a warning says so.
fn without_friction(model: &Model, name: &str, findings: &mut Vec<Diagnostic>) -> Model {
    let mut smooth = model.clone();
    let Some(first) = model.actions.friction.first() else {
        return smooth;
    };
    findings.push(
        Diagnostic::warning(
            "friction-left-out",
            format!("study `{name}`: friction is left out, in the motion with clearance and in the ideal one"),
        )
        .at(first.span.clone(), "")
        .note("the link in a clearance lies along the force between smooth surfaces")
        .help("see what friction asks of the drives in a study of forces"),
    );
    smooth.actions.friction.clear();
    smooth
}

/// What is asked that is no matter of an instant, as diagnostics over the model file.
fn not_at_an_instant(mechanism: &Mechanism, asked: &Asked) -> Vec<Diagnostic> {
    let whole = (asked.all()).filter(|q| is_of_whole_motion(mechanism, &q.measure));
    let diagnostics = whole.map(|quantity| {
        let message = format!(
            "`{}` cannot be evaluated with clearance: it asks for the whole motion, and every row is found by itself",
            quantity.name
        );
        Diagnostic::error("not-measurable", message)
            .help("ask for what has a value at every instant; numbers over the ideal motion are told by other studies")
    });
    diagnostics.collect()
}

/// That a load follows more of the motion than an instant.
fn whole_motion_load(design: &Design<f64>) -> Option<Diagnostic> {
    let mechanism = &*design.mechanism;
    // What makes no sense is told by whoever asks for forces.
    let acting = Acting::new(mechanism, &design.geometry, &design.parameters).ok()?;
    let mut followed = acting.amounts.iter();
    let whole = |measure: &Measure| is_of_whole_motion(mechanism, measure);
    followed.any(|amount| whole(&amount.measure)).then(|| {
        let message = "a load follows how far a point has gone, which is not known with clearance";
        Diagnostic::error("not-measurable", message)
            .help("let loads follow drives, time, and what has a value at every instant")
    })
}
