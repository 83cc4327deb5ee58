//! What acts on a mechanism, as the check tells it: what is assumed, and what makes forces meaningless.

use kempe_dynamics::Acting;
use kempe_dynamics::acting::GRAVITY;
use kempe_mechanism::Design;
use kempe_model::{
    Between, Center, Clearance, ClearanceAt, Diagnostic, DriveId, DriveKind, FRAME, Friction,
    FrictionAt, LinkPointRef, Load, LoadKind, Model, Study, StudyKind, value,
};
use kempe_number::text::significant;
use kempe_units::Dimension;

use crate::along::force_problems;
use crate::unit::Units;
use crate::words::list;

/// Digits in which gravity is told.
const GRAVITY_DIGITS: usize = 6;
/// A component of gravity below this part of the other is the rounding of a direction.
const NO_GRAVITY: f64 = 1e-12;

/// What acts, and what is taken for granted about masses and gravity.
pub(crate) fn assumptions(model: &Model, units: &Units) -> Vec<String> {
    let parameters: Vec<f64> = model.parameter_values();
    let actions = &model.actions;
    let mut diagnostics = acting(model);
    diagnostics.extend(clearances(model, units));
    let own = model
        .links
        .iter()
        .skip(1)
        .filter_map(|l| l.inertia.as_ref()?.mass.as_ref());
    let masses = own.chain(actions.masses.iter().map(|m| &m.mass));
    let total: f64 = masses.map(|m| value(m, &parameters)).sum();
    if total == 0.0 {
        return diagnostics;
    }
    diagnostics.push(format!(
        "mass: {} in all",
        units.text(total, Dimension::MASS)
    ));
    let gravity = match &actions.gravity {
        None => [0.0, -GRAVITY],
        Some(g) => [&g[0], &g[1]].map(|g| value(g, &parameters)),
    };
    diagnostics.push(match gravity {
        [0.0, 0.0] => "gravity: none".to_owned(),
        [0.0, y] if y < 0.0 => format!(
            "gravity: {} m/s^2 along -y",
            significant(-y, GRAVITY_DIGITS)
        ),
        [x, y] => {
            let size = x.abs().max(y.abs());
            let shown = |v: f64| match v.abs() < NO_GRAVITY * size {
                true => "0".to_owned(),
                false => significant(v, GRAVITY_DIGITS),
            };
            format!("gravity: [{}, {}] m/s^2", shown(x), shown(y))
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
        diagnostics.push(format!(
            "centre of mass at the mean of its points: {}",
            list(&centroid)
        ));
    }
    let massless = named(&|l| l.inertia.as_ref().is_none_or(|i| i.mass.is_none()));
    if !massless.is_empty() {
        diagnostics.push(format!("without mass: {}", list(&massless)));
    }
    diagnostics
}

/// What acts besides weights, and that no study asks for it.
fn acting(model: &Model) -> Vec<String> {
    let actions = &model.actions;
    let mut diagnostics = Vec::new();
    let of_drive = |drive: DriveId| {
        (model.drives.get(drive.index())).map_or(String::new(), |d| d.name.clone())
    };
    let mut add = |what: &str, names: Vec<String>| {
        if !names.is_empty() {
            diagnostics.push(format!("{what}: {}", names.join(", ")));
        }
    };
    add(
        "loads",
        actions
            .loads
            .iter()
            .map(|load| acting_on(model, load))
            .collect(),
    );
    add(
        "point masses",
        actions.masses.iter().map(|m| m.name.clone()).collect(),
    );
    add(
        "springs",
        (actions.springs.iter())
            .map(|s| s.name.clone() + &ends_on(model, &s.between))
            .collect(),
    );
    add(
        "dampers",
        (actions.dampers.iter())
            .map(|d| d.name.clone() + &ends_on(model, &d.between))
            .collect(),
    );
    add(
        "friction",
        actions
            .friction
            .iter()
            .map(|f| friction_name(model, f))
            .collect(),
    );
    add(
        "cylinders",
        actions
            .cylinders
            .iter()
            .map(|c| {
                let oil = if c.oil.is_some() { " with oil" } else { "" };
                of_drive(c.drive) + oil
            })
            .collect(),
    );
    add(
        "switches of simulations",
        actions.switches.iter().map(|s| s.name.clone()).collect(),
    );
    add(
        "motors",
        actions.motors.iter().map(|m| of_drive(m.drive)).collect(),
    );
    let asks = |s: &Study| !matches!(s.kind, StudyKind::Motion(_));
    if !diagnostics.is_empty() && !model.studies.iter().any(asks) {
        diagnostics.push(
            "forces: no study asks for them; add [studies.loads] kind = \"forces\"".to_owned(),
        );
    }
    diagnostics
}

/// A load, with the link on which it acts.
fn acting_on(model: &Model, load: &Load) -> String {
    match &load.kind {
        LoadKind::Force { at, .. } => load.name.clone() + &on_links(model, &[at]),
        LoadKind::Torque { .. } => load.name.clone(),
    }
}

/// The links on which what is between two points acts.
fn ends_on(model: &Model, between: &Between) -> String {
    match between {
        Between::Points(a, b) => on_links(model, &[a, b]),
        Between::Links(..) => String::new(),
    }
}

/// The links on which something acts at points of several that move: ` (at C on rocker)`.
pub(crate) fn on_links(model: &Model, ends: &[&LinkPointRef]) -> String {
    let told = ends.iter().filter_map(|end| {
        let point = model.points.get(end.point.index())?;
        let link = model.links.get(end.link.index())?;
        let moving = point.links.iter().filter(|l| **l != FRAME).count();
        (moving > 1).then(|| format!("at {} on {}", point.name, link.name))
    });
    let told: Vec<String> = told.collect();
    match told.is_empty() {
        true => String::new(),
        false => format!(" ({})", told.join(", ")),
    }
}

/// What a friction is said of, as in the file.
fn friction_name(model: &Model, friction: &Friction) -> String {
    let name = match friction.at {
        FrictionAt::Pin(point) => model.points.get(point.index()).map(|p| &p.name),
        FrictionAt::Joint(joint) => model.joints.get(joint.index()).map(|j| &j.name),
        FrictionAt::All => return format!("all other joints{}", but_for_cylinders(model)),
    };
    name.cloned().unwrap_or_default()
}

/// What is said of "all" where drives are cylinders: their own pins are parts of the drive, and neither rub nor have play.
fn but_for_cylinders(model: &Model) -> String {
    let drives = model.drives.iter();
    let cylinders = drives.filter(|drive| matches!(drive.kind, DriveKind::Cylinder { .. }));
    let names: Vec<String> = cylinders.map(|drive| format!("`{}`", drive.name)).collect();
    match names.len() {
        0 => String::new(),
        1 => format!(" but for the pins of cylinder drive {}", list(&names)),
        _ => format!(" but for the pins of cylinder drives {}", list(&names)),
    }
}

/// The clearances that a file gives, for people.
fn clearances(model: &Model, units: &Units) -> Option<String> {
    let parameters: Vec<f64> = model.parameter_values();
    let text = |clearance: &Clearance| {
        let name = match &clearance.at {
            ClearanceAt::Pin { point, .. } => model.points.get(point.index()).map(|p| &p.name),
            ClearanceAt::Joint(id) => model.joints.get(id.index()).map(|j| &j.name),
            ClearanceAt::All => None,
        };
        let radial = value(&clearance.radial, &parameters);
        let but = match clearance.at {
            ClearanceAt::All => but_for_cylinders(model),
            _ => String::new(),
        };
        let name = name.map_or("all", String::as_str);
        format!("{name} {}{but}", units.text(radial, Dimension::LENGTH))
    };
    let all: Vec<String> = model.clearances.iter().map(text).collect();
    (!all.is_empty()).then(|| format!("clearance: {}", all.join(", ")))
}

/// Whether anything gives rise to forces: a mass that moves, a load, a spring, a damper, viscous friction.
fn something_acts(model: &Model) -> bool {
    let parameters: Vec<f64> = model.parameter_values();
    let actions = &model.actions;
    let heavy = model.links.iter().skip(1).any(|link| {
        let inertia = link.inertia.as_ref();
        let own = inertia.into_iter().flat_map(|i| [&i.mass, &i.moment]);
        own.flatten().any(|s| value::<f64>(s, &parameters) != 0.0)
    });
    heavy
        || !actions.masses.is_empty()
        || !actions.loads.is_empty()
        || !actions.springs.is_empty()
        || !actions.dampers.is_empty()
        || actions
            .friction
            .iter()
            .any(|f| f.viscous.is_some() || f.drag.is_some())
}

/// Where forces are asked for and there are none.
pub(crate) fn nothing_acts(model: &Model) -> Option<Diagnostic> {
    let diagnostic = || {
        Diagnostic::warning(
            "nothing-acts",
            "nothing acts on the mechanism: there are no forces",
        )
        .note("links have no mass unless it is given")
        .help("say what acts: mass = \"1 kg\" of a link, or [loads], [springs], [dampers]")
    };
    (!something_acts(model)).then(diagnostic)
}

/// What makes forces meaningless for the dimensions at hand.
pub(crate) fn problems(design: &Design<f64>) -> Vec<Diagnostic> {
    let mechanism = &*design.mechanism;
    let parameters: Vec<f64> = mechanism.model.parameter_values();
    match Acting::new(mechanism, &design.geometry, &parameters) {
        Ok(_) => Vec::new(),
        Err(problems) => force_problems(problems),
    }
}
