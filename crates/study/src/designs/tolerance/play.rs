//! Joints with play in a tolerance study: each is let go, and how far it stands open is a parameter of a model made for that.
//!
//! The coordinates of a joint that is let go are drives that stand still (`Mechanism::releasing`); their laws become parameters of their own,
//! zero in the file's own design, so that a piece with its pins pressed to some side is a design like any other. A piece keeps the sides to
//! which its joints are pressed all along the motion.

use kempe_mechanism::constraint::Source as Of;
use kempe_model::{
    Diagnostic, DriveKind, Model, Parameter, ParameterId, Released, Span, StudyKind,
};
use kempe_motion::progress::Silent;
use kempe_number::Dual;
use kempe_units::{Dimension, Expr};

use super::source::{Kind, Play, Source};
use crate::clearance::{Joints, clearance_of, not_released};
use crate::prepared::{design, motion};
use crate::words::list;

/// The model whose joints with play stand open by parameters of their own.
pub(super) struct Played {
    pub model: Model,
    /// These parameters.
    pub parameters: Vec<ParameterId>,
    /// The joints; their places among varied parameters count from the first of these parameters.
    pub joints: Vec<Source>,
    /// What is to be told; none of it keeps the study from running.
    pub told: Vec<Diagnostic>,
}

impl Played {
    /// The joints of a model with play; `asked` is where the study asks for it, `over` what it runs, and `varied` are the parameters that differ.
    ///
    /// # Errors
    /// Why there is none that could be counted.
    pub fn new(
        model: &Model,
        over: &StudyKind,
        asked: &Span,
        varied: &[ParameterId],
    ) -> Result<Self, Vec<Diagnostic>> {
        let refuse = |message: &str, help: &str| {
            let error = Diagnostic::error("no-clearance-there", message);
            Err(vec![error.at(asked.clone(), "").help(help)])
        };
        if let StudyKind::Simulate(_) = over {
            return refuse(
                "a simulation knows joints with play as contacts",
                "use a study of kind = \"clearance\", or run a study of motion or forces for the pieces",
            );
        }
        let closed = design(model);
        let joints = Joints::new(&closed.mechanism, &closed.parameters);
        if !joints.refused.is_empty() {
            return Err(joints.refused);
        }
        if joints.plays.is_empty() {
            let [none, help] = [
                "no joint has any play",
                "give a clearance that is not zero: [clearance] B = { radial = \"50 um\" }",
            ];
            if varied.is_empty() || opens(model, varied) {
                return refuse(none, help);
            }
            // As where a sweep over how much there is begins.
            let told = Diagnostic::warning("clearance-left-out", none);
            return Ok(Self {
                model: model.clone(),
                parameters: Vec::new(),
                joints: Vec::new(),
                told: vec![told.at(asked.clone(), "").help(help)],
            });
        }
        let repeated = motion(&closed, &mut Silent).ok();
        let repeated = repeated.and_then(|motion| joints.repeated(&motion));
        let repeated = repeated.unwrap_or_else(|| vec![false; joints.plays.len()]);
        let pairs = || joints.plays.iter().zip(&joints.names).zip(&repeated);
        let counted = || {
            pairs()
                .filter(|(_, repeated)| !**repeated)
                .map(|(it, _)| it)
        };
        let left_out: Vec<String> = (pairs().filter(|(_, repeated)| **repeated))
            .map(|((_, name), _)| name.clone())
            .collect();
        if left_out.len() == joints.plays.len() {
            return refuse(
                "every joint with play opens only as other joints let it, which repeat it",
                "take out the link or joint that repeats others",
            );
        }
        let which: Vec<Of> = counted().map(|(play, _)| play.joint).collect();
        let open = (closed.mechanism.releasing(&which))
            .map_err(|why| vec![not_released(&closed.mechanism, why)])?;
        let mut it = Self {
            model: open.model.clone(),
            parameters: Vec::new(),
            joints: Vec::new(),
            told: joints.left_out(model).into_iter().collect(),
        };
        if !left_out.is_empty() {
            let message = format!(
                "no play is counted at {}: other joints repeat it, and let it open only as they do",
                list(&left_out)
            );
            let told = Diagnostic::warning("clearance-left-out", message).at(asked.clone(), "");
            it.told
                .push(told.help("take out the link or joint that repeats others"));
        }
        for (play, name) in counted() {
            let Some(clearance) = clearance_of(&closed.mechanism, play.joint) else {
                continue;
            };
            let counted = Play::new(clearance.radial.clone(), play.radial);
            let first = it.parameters.len();
            let kind = match play.joint {
                Of::Joint(id) => {
                    it.open(Released::Joint(id), name, asked);
                    Kind::Across(counted)
                }
                Of::Pin { point, link } => {
                    it.open(Released::Pin { point, link }, name, asked);
                    Kind::Round(counted)
                }
                Of::Drive(_) => continue,
            };
            it.joints.push(Source { first, kind });
        }
        Ok(it)
    }

    /// Makes parameters of the lengths by which a joint stands open.
    fn open(&mut self, joint: Released, name: &str, asked: &Span) {
        for drive in &mut self.model.drives {
            let DriveKind::Release { of, .. } = drive.kind else {
                continue;
            };
            if of != joint || drive.dimension != Dimension::LENGTH {
                continue;
            }
            let id = ParameterId(self.model.parameters.len() as u32);
            self.model.parameters.push(Parameter {
                name: format!("play at {name}"),
                value: Expr::Const(0.0),
                dimension: Dimension::LENGTH,
                span: asked.clone(),
            });
            drive.law.from = Expr::Leaf(id);
            self.parameters.push(id);
        }
    }
}

/// Whether parameters change how much play there is.
fn opens(model: &Model, varied: &[ParameterId]) -> bool {
    let mut values: Vec<Dual<f64, 1>> = Vec::with_capacity(model.parameters.len());
    for (index, parameter) in model.parameters.iter().enumerate() {
        let mut value = kempe_model::value(&parameter.value, &values);
        if varied.iter().any(|id| id.index() == index) {
            value.eps[0] += 1.0;
        }
        values.push(value);
    }
    let plays = model.clearances.iter();
    let mut plays = plays.map(|it| kempe_model::value(&it.radial, &values));
    plays.any(|play| play.eps[0] != 0.0)
}
