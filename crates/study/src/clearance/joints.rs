//! Which joints have how much play.

use kempe_dynamics::clearance::Play;
use kempe_mechanism::constraint::Source;
use kempe_mechanism::{Mechanism, NotReleased};
use kempe_model::{Clearance, ClearanceAt, Diagnostic, JointKind, Model, PointId, value};
use kempe_units::Dimension;

use crate::unit::Units;

/// The joints with play.
#[derive(Default)]
pub(crate) struct Joints {
    /// Each with its clearance.
    pub plays: Vec<Play>,
    /// What they are called.
    pub names: Vec<String>,
    /// Whether the play is across a line, to two sides alone.
    pub across: Vec<bool>,
    /// Pins that `all` means and that cannot have play, because wheels turn on them.
    carry_wheels: Vec<String>,
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
            let Some(clearance) = of(model, *source) else {
                continue;
            };
            let radial = value(&clearance.radial, parameters);
            if radial == 0.0 {
                continue;
            }
            let name = joint_name(model, *source);
            let carries = mechanism.releasing(&[*source]).is_err();
            if clearance.at == ClearanceAt::All && carries {
                it.carry_wheels.push(name);
                continue;
            }
            let joint = *source;
            it.plays.push(Play { joint, radial });
            it.names.push(name);
            it.across.push(matches!(source, Source::Joint(_)));
        }
        it
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
pub(super) fn of(model: &Model, source: Source) -> Option<&Clearance> {
    let entries = || model.clearances.iter().rev();
    let of_all = || entries().find(|c| c.at == ClearanceAt::All);
    match source {
        Source::Pin { point, link } => {
            let own =
                |c: &&Clearance| matches!(c.at, ClearanceAt::Pin { point: p, .. } if p == point);
            let Some(own) = entries().find(own) else {
                return of_all();
            };
            match &own.at {
                ClearanceAt::Pin { on, .. } => (on.is_empty() || on.contains(&link)).then_some(own),
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

/// What a joint is called.
pub(crate) fn joint_name(model: &Model, source: Source) -> String {
    let point = |id: PointId| model.points.get(id.index());
    match source {
        Source::Pin { point: id, link } => {
            let name = point(id).map_or("?", |p| p.name.as_str());
            let link = model.links.get(link.index()).map_or("?", |l| &l.name);
            match point(id).is_some_and(|p| p.links.len() > 2) {
                true => format!("{name} of {link}"),
                false => name.to_owned(),
            }
        }
        Source::Joint(id) => {
            (model.joints.get(id.index())).map_or(String::new(), |j| j.name.clone())
        }
        Source::Drive(id) => {
            (model.drives.get(id.index())).map_or(String::new(), |d| d.name.clone())
        }
    }
}

/// A joint that the file gives a clearance and that cannot have one.
pub(crate) fn not_released(mechanism: &Mechanism, why: NotReleased) -> Diagnostic {
    let model = &mechanism.model;
    let (source, reason) = match why {
        NotReleased::NoConstraint(source) => (source, "it holds no two bodies together"),
        NotReleased::OnCurve(source) => (source, "its slot runs along a smooth curve"),
        NotReleased::CarriesWheel(source) => (source, "a wheel of gears or a belt turns there"),
        NotReleased::Twice(source) => (source, "it is let go already"),
        _ => return Diagnostic::error("no-clearance-there", why.to_string()),
    };
    let message = format!(
        "the clearance at {} cannot be counted: {reason}",
        joint_name(model, source)
    );
    let diagnostic = Diagnostic::error("no-clearance-there", message)
        .help("leave it out under [clearance]; there may be play at other pins, sliders and slots");
    match of(model, source) {
        Some(clearance) => diagnostic.at(clearance.span.clone(), ""),
        None => diagnostic,
    }
}

/// The clearances that a file gives, for people.
pub(crate) fn given(model: &Model, units: &Units) -> Option<String> {
    let parameters: Vec<f64> = model.parameter_values();
    let text = |clearance: &Clearance| {
        let name = match &clearance.at {
            ClearanceAt::Pin { point, .. } => model.points.get(point.index()).map(|p| &p.name),
            ClearanceAt::Joint(id) => model.joints.get(id.index()).map(|j| &j.name),
            ClearanceAt::All => None,
        };
        let radial = value(&clearance.radial, &parameters);
        let name = name.map_or("all", String::as_str);
        format!("{name} {}", units.text(radial, Dimension::LENGTH))
    };
    let all: Vec<String> = model.clearances.iter().map(text).collect();
    (!all.is_empty()).then(|| format!("clearance: {}", all.join(", ")))
}
