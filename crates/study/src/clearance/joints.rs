//! Which joints have how much play.

use std::sync::Arc;

use kempe_dynamics::clearance::{Clearances, Play};
use kempe_mechanism::constraint::Source;
use kempe_mechanism::{Mechanism, NotReleased};
use kempe_model::{Clearance, ClearanceAt, Diagnostic, JointKind, LinkId, Model, Released, value};
use kempe_motion::Motion;

/// The joints with play.
#[derive(Default)]
pub(crate) struct Joints {
    /// Each with its clearance.
    pub plays: Vec<Play>,
    /// What they are called.
    pub names: Vec<String>,
    /// Pins that `all` means and that cannot have play, because wheels turn on them.
    carry_wheels: Vec<String>,
    /// Why others that the file names cannot have it.
    pub refused: Vec<Diagnostic>,
}

impl Joints {
    /// The joints to which the model gives some clearance with these parameter values.
    pub fn new(mechanism: &Mechanism, parameters: &[f64]) -> Self {
        let model = &mechanism.model;
        let mut it = Self::default();
        let mut seen: Vec<Source> = Vec::new();
        for (_, source) in &mechanism.constraints[..mechanism.joint_constraints] {
            if seen.contains(source) {
                continue;
            }
            seen.push(*source);
            let Some(clearance) = clearance_of(mechanism, *source) else {
                continue;
            };
            let radial = value(&clearance.radial, parameters);
            if radial == 0.0 {
                continue;
            }
            match mechanism.releasing(&[*source]) {
                Ok(_) => {
                    let joint = *source;
                    it.plays.push(Play { joint, radial });
                    it.names.push(joint_name(model, joint));
                }
                Err(_) if clearance.at == ClearanceAt::All => {
                    it.carry_wheels.push(joint_name(model, *source));
                }
                Err(why) => it.refused.push(not_released(mechanism, why)),
            }
        }
        for clearance in &model.clearances {
            let some = value(&clearance.radial, parameters) != 0.0;
            let welded = welded(mechanism, &clearance.at).filter(|_| some);
            it.refused
                .extend(welded.map(|what| no_clearance_there(&what, WELDED, Some(clearance))));
        }
        it
    }

    /// By joint with play: whether other joints repeat it where a motion starts, so that it opens only as these let it; `None` where that is
    /// not known.
    pub fn repeated(&self, motion: &Arc<Motion>) -> Option<Vec<bool>> {
        let mut clearances = Clearances::new(motion, &self.plays, false, &[]).ok()?;
        clearances.go_to(0.0).ok()?;
        let all = 0..self.plays.len();
        Some(all.map(|joint| clearances.is_undetermined(joint)).collect())
    }

    /// That some pins were left out.
    pub fn left_out(&self, model: &Model) -> Option<Diagnostic> {
        let names = self.carry_wheels.join(", ");
        let all = model.clearances.iter().find(|c| c.at == ClearanceAt::All)?;
        (!names.is_empty()).then(|| {
            Diagnostic::warning(
                "clearance-left-out",
                format!("no clearance is counted at {names}: wheels of gears or belts turn there"),
            )
            .at(all.span.clone(), "")
            .note("how wheels mesh whose axes stand off is not modelled")
            .help("tell of the pins that count: B = { radial = \"10 um\" }")
        })
    }
}

/// The entry that tells of a joint.
pub(crate) fn clearance_of(mechanism: &Mechanism, source: Source) -> Option<&Clearance> {
    let model = &mechanism.model;
    let entries = || model.clearances.iter().rev();
    let of_all = || entries().find(|c| c.at == ClearanceAt::All);
    match source {
        Source::Pin { point, link } => {
            let own =
                |c: &&Clearance| matches!(c.at, ClearanceAt::Pin { point: p, .. } if p == point);
            let Some(own) = entries().find(own) else {
                return of_all();
            };
            // Links that are welded sit on the pin as one.
            let body = mechanism.body_of(link);
            match &own.at {
                ClearanceAt::Pin { on, .. } if on.is_empty() => Some(own),
                ClearanceAt::Pin { on, .. } => {
                    let mut on = on.iter();
                    on.any(|named| mechanism.body_of(*named) == body)
                        .then_some(own)
                }
                _ => None,
            }
        }
        Source::Joint(id) => {
            let slides = matches!(
                model.joints.get(id.index())?.kind,
                JointKind::Slider { .. } | JointKind::Slot { .. } | JointKind::ArcSlot { .. }
            );
            let own = entries().find(|c| c.at == ClearanceAt::Joint(id));
            own.or_else(of_all).filter(|_| slides)
        }
        Source::Drive(_) => None,
    }
}

/// Why there is no play between links that are one.
const WELDED: &str = "its links are welded together and part nowhere";

/// What an entry tells of that holds no two bodies together, because its links are welded.
fn welded(mechanism: &Mechanism, at: &ClearanceAt) -> Option<String> {
    let model = &mechanism.model;
    let one = |a: LinkId, b: LinkId| mechanism.body_of(a) == mechanism.body_of(b);
    match at {
        ClearanceAt::Pin { point, on } => {
            let point = model.points.get(point.index())?;
            let (first, later) = point.links.split_first()?;
            let fast = |link: &&LinkId| one(*first, **link);
            if on.is_empty() {
                return later
                    .iter()
                    .all(|link| fast(&link))
                    .then(|| point.name.clone());
            }
            let link = model.links.get(on.iter().find(fast)?.index())?;
            Some(format!("{} of {}", point.name, link.name))
        }
        ClearanceAt::Joint(id) => {
            let joint = model.joints.get(id.index())?;
            let [a, b] = match &joint.kind {
                JointKind::Slider { at: pin, on, .. } | JointKind::Slot { pin, on } => {
                    [pin.link, on.link]
                }
                JointKind::ArcSlot { pin, on } => [pin.link, on.link],
                _ => return None,
            };
            one(a, b).then(|| joint.name.clone())
        }
        ClearanceAt::All => None,
    }
}

/// What a joint is called.
pub(crate) fn joint_name(model: &Model, source: Source) -> String {
    let name = match source {
        Source::Pin { point, link } => Released::Pin { point, link }.name(model),
        Source::Joint(id) => Released::Joint(id).name(model),
        Source::Drive(id) => model.drives.get(id.index()).map(|d| d.name.clone()),
    };
    name.unwrap_or_default()
}

/// A joint that the file gives a clearance and that cannot have one.
pub(crate) fn not_released(mechanism: &Mechanism, why: NotReleased) -> Diagnostic {
    let (source, reason) = match why {
        NotReleased::NoConstraint(source) => (source, "it holds no two bodies together"),
        NotReleased::OnCurve(source) => (source, "its slot runs along a smooth curve"),
        NotReleased::CarriesWheel(source) => (source, "a wheel of gears or a belt turns there"),
        NotReleased::Twice(source) => (source, "it is let go already"),
        _ => return Diagnostic::error("no-clearance-there", why.to_string()),
    };
    let name = joint_name(&mechanism.model, source);
    no_clearance_there(&name, reason, clearance_of(mechanism, source))
}

fn no_clearance_there(name: &str, reason: &str, clearance: Option<&Clearance>) -> Diagnostic {
    let message = format!("the clearance at {name} cannot be counted: {reason}");
    let diagnostic = Diagnostic::error("no-clearance-there", message)
        .help("leave it out under [clearance]; there may be play at other pins, sliders and slots");
    match clearance {
        Some(clearance) => diagnostic.at(clearance.span.clone(), ""),
        None => diagnostic,
    }
}
