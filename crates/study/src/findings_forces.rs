//! What acts on a mechanism, as the check tells it: what is assumed, and what makes forces meaningless.

use kempe_dynamics::Acting;
use kempe_dynamics::acting::GRAVITY;
use kempe_kinematics::{Design, Mechanism};
use kempe_model::{Center, Diagnostic, Model, value};
use kempe_units::Dimension;

use crate::explain::list;
use crate::unit::Units;

/// What is taken for granted about masses and gravity; nothing of a mechanism without masses.
pub(crate) fn assumptions(model: &Model, units: &Units) -> Vec<String> {
    let parameters: Vec<f64> = model.parameter_values();
    let actions = &model.actions;
    let own = model
        .links
        .iter()
        .filter_map(|l| l.inertia.as_ref()?.mass.as_ref());
    let masses = own.chain(actions.masses.iter().map(|m| &m.mass));
    let total: f64 = masses.map(|m| value(m, &parameters)).sum();
    if total == 0.0 {
        return Vec::new();
    }
    let mut told = vec![format!(
        "mass: {} in all",
        units.text(total, Dimension::MASS)
    )];
    told.push(match &actions.gravity {
        None => format!(
            "gravity: {} along -y",
            units.text(GRAVITY, Dimension::ACCELERATION)
        ),
        Some([x, y]) => {
            let [x, y] = [x, y].map(|g| value(g, &parameters));
            format!(
                "gravity: [{}, {}]",
                units.text(x, Dimension::ACCELERATION),
                units.text(y, Dimension::ACCELERATION)
            )
        }
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
