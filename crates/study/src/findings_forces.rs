//! What acts on a mechanism, as the check tells it: what is assumed, and what makes forces meaningless.

use kempe_dynamics::Acting;
use kempe_dynamics::acting::GRAVITY;
use kempe_kinematics::{Design, Mechanism};
use kempe_model::{Center, Diagnostic, Model, Study, StudyKind, value};
use kempe_units::Dimension;

use crate::explain::list;
use crate::unit::Units;

/// What acts, and what is taken for granted about masses and gravity.
pub(crate) fn assumptions(model: &Model, units: &Units) -> Vec<String> {
    let parameters: Vec<f64> = model.parameter_values();
    let actions = &model.actions;
    let mut told = acting(model);
    let own = model
        .links
        .iter()
        .skip(1)
        .filter_map(|l| l.inertia.as_ref()?.mass.as_ref());
    let masses = own.chain(actions.masses.iter().map(|m| &m.mass));
    let total: f64 = masses.map(|m| value(m, &parameters)).sum();
    if total == 0.0 {
        return told;
    }
    told.push(format!(
        "mass: {} in all",
        units.text(total, Dimension::MASS)
    ));
    let gravity = match &actions.gravity {
        None => [0.0, -GRAVITY],
        Some(g) => [&g[0], &g[1]].map(|g| value(g, &parameters)),
    };
    told.push(match gravity {
        [0.0, 0.0] => "gravity: none".to_owned(),
        [0.0, y] if y < 0.0 => format!("gravity: {} m/s^2 along -y", -y),
        [x, y] => format!("gravity: [{x}, {y}] m/s^2"),
    });
    let named = |test: &dyn Fn(&kempe_model::Link) -> bool| {
        let links = model.links.iter().skip(1).filter(|l| test(l));
        links.map(|l| format!("`{}`", l.name)).collect::<Vec<_>>()
    };
    let centroid = named(&|l| {
        let inertia = l.inertia.as_ref();
        inertia.is_some_and(|i| i.mass.is_some() && matches!(i.center, Center::Centroid))
    });
    if !centroid.is_empty() {
        told.push(format!(
            "centre of mass at the mean of its points: {}",
            list(&centroid)
        ));
    }
    let massless = named(&|l| l.inertia.as_ref().is_none_or(|i| i.mass.is_none()));
    if !massless.is_empty() {
        told.push(format!("without mass: {}", list(&massless)));
    }
    told
}

/// What acts besides weights, and that no study asks for it.
fn acting(model: &Model) -> Vec<String> {
    let actions = &model.actions;
    let mut told = Vec::new();
    let mut add = |what: &str, names: Vec<&str>| {
        if !names.is_empty() {
            told.push(format!("{what}: {}", names.join(", ")));
        }
    };
    add(
        "loads",
        actions.loads.iter().map(|l| l.name.as_str()).collect(),
    );
    add(
        "springs",
        actions.springs.iter().map(|s| s.name.as_str()).collect(),
    );
    add(
        "dampers",
        actions.dampers.iter().map(|d| d.name.as_str()).collect(),
    );
    let asks = |s: &Study| !matches!(s.kind, StudyKind::Motion(_));
    if !told.is_empty() && !model.studies.iter().any(asks) {
        told.push(
            "forces: no study asks for them; add [studies.loads] kind = \"forces\"".to_owned(),
        );
    }
    told
}

/// What makes forces meaningless for the dimensions at hand.
pub(crate) fn problems(mechanism: &Mechanism, design: &Design<f64>) -> Vec<Diagnostic> {
    let parameters: Vec<f64> = mechanism.model.parameter_values();
    match Acting::new(mechanism, &design.geometry, &parameters) {
        Ok(_) => Vec::new(),
        Err(problems) => problems
            .into_iter()
            .map(|p| Diagnostic::error(p.code, p.message).at(p.span, ""))
            .collect(),
    }
}
