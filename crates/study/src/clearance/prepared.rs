//! What a study of clearance in which contact is lost works on, and what is to be told of it before anything moves.

use kempe_dynamics::clearance::Play;
use kempe_dynamics::{Acting, friction};
use kempe_mechanism::constraint::Source;
use kempe_mechanism::{Design, Mechanism};
use kempe_model::{
    ClearanceAt, Contact, ContactProperties, ContactStates, ContactStudy, Diagnostic, FrictionAt,
    Model, PlayAt, Released, Scalar, value,
};

use super::joints::{Joints, clearance_of, joint_name, not_released};
use crate::along::force_problems;
use crate::prepared::design;
use crate::words::list;

/// What such a study works on.
pub(super) struct WithContacts {
    /// The design, whose joints with play have no friction but that of their contacts.
    pub design: Design<f64>,
    /// The contacts that the clearances make.
    pub contacts: Vec<Contact>,
    /// What is to be told; none of it keeps the study from running.
    pub findings: Vec<Diagnostic>,
}

impl WithContacts {
    /// The joints of a model with play, if their contacts can be counted.
    ///
    /// # Errors
    /// Why they cannot.
    pub fn new(model: &Model, name: &str, study: &ContactStudy) -> Result<Self, Vec<Diagnostic>> {
        let closed = design(model);
        let mechanism = &*closed.mechanism;
        let joints = Joints::new(mechanism, &closed.parameters);
        let mut findings: Vec<Diagnostic> = joints.left_out(model).into_iter().collect();
        if !joints.refused.is_empty() {
            return Err(joints.refused);
        }
        let mut contacts = contacts(mechanism, &joints.plays, study.states);
        if contacts.is_empty() {
            let error = Diagnostic::error("no-clearance-there", "no joint has any play to move in")
                .help("give a clearance that is not zero: [clearance] B = { radial = \"50 um\" }");
            return Err(vec![match model.clearances.first() {
                Some(first) => error.at(first.span.clone(), ""),
                None => error,
            }]);
        }
        let unknown = start(model, name, study, &mut contacts);
        if !unknown.is_empty() {
            return Err(unknown);
        }
        findings.extend(friction_left_out(model, name, &contacts));
        let smooth = contacts.iter().map(|contact| contact.joint).collect();
        let design = closed.with_model(|model| model.actions.smooth = smooth);
        let open = kempe_simulate::with_play(&design, &contacts)
            .map_err(|why| vec![not_released(&design.mechanism, why)])?;
        Acting::new(&open.mechanism, &open.geometry, &open.parameters).map_err(force_problems)?;
        Ok(Self {
            design,
            contacts,
            findings,
        })
    }

    /// The model, whose joints with play have no friction but that of their contacts.
    pub fn model(&self) -> &Model {
        &self.design.mechanism.model
    }
}

/// The contacts that the file's clearances make.
fn contacts(mechanism: &Mechanism, plays: &[Play], states: ContactStates) -> Vec<Contact> {
    let clearances = &mechanism.model.clearances;
    let of_all = clearances.iter().find(|c| c.at == ClearanceAt::All);
    let others = of_all.map_or_else(ContactProperties::default, |c| c.contact.clone());
    let contact = |play: &Play| {
        let entry = clearance_of(mechanism, play.joint)?;
        let joint = match play.joint {
            Source::Pin { point, link } => Released::Pin { point, link },
            Source::Joint(id) => Released::Joint(id),
            Source::Drive(_) => return None,
        };
        Some(Contact {
            joint,
            clearance: play.radial,
            properties: entry.contact.or(&others),
            states,
            start: [[0.0; 2]; 2],
            touches: Vec::new(),
            span: entry.span.clone(),
        })
    };
    plays.iter().filter_map(contact).collect()
}

/// Takes up where contacts start; tells of starts of what is none of them.
fn start(
    model: &Model,
    name: &str,
    study: &ContactStudy,
    contacts: &mut [Contact],
) -> Vec<Diagnostic> {
    let parameters: Vec<f64> = model.parameter_values();
    let mut unknown = Vec::new();
    for it in &study.motion.plays {
        let joint = match it.at {
            PlayAt::Pin(point) => model.points.get(point.index()).map(|p| &p.name),
            PlayAt::Joint(joint) => model.joints.get(joint.index()).map(|j| &j.name),
        };
        let is_meant = |contact: &&mut Contact| match (contact.joint, it.at) {
            (Released::Pin { point, .. }, PlayAt::Pin(named)) => point == named,
            (Released::Joint(joint), PlayAt::Joint(named)) => joint == named,
            _ => false,
        };
        let mut meant: Vec<&mut Contact> = contacts.iter_mut().filter(is_meant).collect();
        let [contact] = meant.as_mut_slice() else {
            let joint = joint.map_or("", String::as_str);
            let (why, help) = match meant.is_empty() {
                true => (
                    "has no play to start in",
                    "give it some under [clearance], or leave its start out",
                ),
                false => (
                    "has play on several links: which of them is meant is not clear",
                    "name one link that has play there, [clearance] B = { radial = …, on = \"rod\" }, or leave its start out",
                ),
            };
            let message = format!("study `{name}`: {joint} {why}");
            let error = Diagnostic::error("no-clearance-there", message);
            unknown.push(error.at(it.span.clone(), "").help(help));
            continue;
        };
        let of = |pair: &Option<[Scalar; 2]>| {
            let pair = pair.as_ref();
            pair.map_or([0.0; 2], |pair| {
                pair.each_ref().map(|x| value(x, &parameters))
            })
        };
        let (place, rate) = (of(&it.place), of(&it.rate));
        let mut rows = [[place[0], rate[0]], [place[1], rate[1]]];
        if let PlayAt::Joint(_) = it.at {
            // The rows of a slider are its angle and its distance.
            rows.reverse();
        }
        contact.start = rows;
    }
    unknown
}

/// That friction of the file counts for nothing at joints with play: a warning for each entry that tells of some.
fn friction_left_out(model: &Model, name: &str, contacts: &[Contact]) -> Vec<Diagnostic> {
    let entries = model.actions.friction.iter();
    let warnings = entries.filter_map(|entry| {
        let tells = |contact: &&Contact| {
            let told = friction::told_of(model, contact.joint.into());
            told.is_some_and(|told| std::ptr::eq(told, entry))
        };
        let own: Vec<&Contact> = contacts.iter().filter(tells).collect();
        let first = own.first()?;
        let names: Vec<String> = own.iter().map(|c| joint_name(model, c.joint.into())).collect();
        let message = format!(
            "study `{name}`: [friction] at {} is left out, with play and in the ideal motion",
            list(&names)
        );
        let own = match entry.at {
            FrictionAt::All => "all".to_owned(),
            _ => joint_name(model, first.joint.into()),
        };
        Some(
            Diagnostic::warning("friction-left-out", message)
                .at(entry.span.clone(), "")
                .note("where a joint has play its bodies rub only where they touch, as their contact says")
                .help(format!(
                    "give the contact a coefficient under [clearance]: {own} = {{ radial = …, friction = 0.1 }}"
                )),
        )
    });
    warnings.collect()
}
