//! Counterweights on links that are pinned to the frame.

use kempe_dynamics::balance::{Harmonics, counterweights, harmonics};
use kempe_model::{
    BalanceGoal, BalanceStudy, Diagnostic, DriveId, ForceMeasure, LinkId, Model, Place, PointId,
    PointMass, value,
};
use kempe_number::math;
use kempe_units::Dimension;

use super::{bare, constant, effort, force, set_beside, shown_by, values, weights};
use crate::motion::run_along;
use crate::quantity::Quantity;
use crate::result::{Figure, Listing, Scalar, StudyResult};
use crate::unit::Units;
use kempe_motion::progress::Progress;

/// A mass below this part of all masses on the links is none.
const NO_MASS: f64 = 1e-12;
/// Places are told to this part of a metre.
const FINEST: f64 = 1e-12;
/// Harmonics of the shaking force that are listed.
const HARMONICS: usize = 6;

/// Chooses counterweights and shows the motion with them.
pub(crate) fn balance(
    model: &Model,
    name: &str,
    study: &BalanceStudy,
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    let parameters: Vec<f64> = model.parameter_values();
    let radius = value(&study.radius, &parameters);
    let goal = goal(model, study.goal);

    let target = match study.goal {
        BalanceGoal::ShakingForce => values(model, &study.along, &goal, progress)?,
        BalanceGoal::Statics => values(&only_weights(model), &study.along, &goal, progress)?,
    };
    let mut units = Vec::new();
    for (link, pivot) in &study.on {
        let mut unit = |direction: f64| -> Result<Vec<f64>, Vec<Diagnostic>> {
            let mut bare = bare(model);
            // A first moment of 1 kg m.
            let weight = weight(
                "unit",
                model,
                *link,
                *pivot,
                radius,
                direction,
                1.0 / radius,
            );
            bare.actions.masses.push(weight);
            Ok(in_one(&values(&bare, &study.along, &goal, progress)?))
        };
        units.push([unit(0.0)?, unit(std::f64::consts::FRAC_PI_2)?]);
    }
    let moments = counterweights(&in_one(&target), &units);

    let mut balanced = model.clone();
    let weights: Vec<PointMass> = study
        .on
        .iter()
        .zip(&moments)
        .filter_map(|((link, pivot), moment)| {
            let size = math::hypot(moment[0], moment[1]);
            let direction = math::atan2(moment[1], moment[0]);
            let mass = size / radius;
            let name = format!("{}_weight", model.links.get(link.index())?.name);
            let name = free_name(model, name);
            (mass > NO_MASS * total_mass(model))
                .then(|| weight(&name, model, *link, *pivot, radius, direction, mass))
        })
        .collect();
    balanced.actions.masses.extend(weights.iter().cloned());

    let quantities = shown(model, study.goal);
    let before = values(model, &study.along, &quantities, progress)?;
    let mut result = run_along(
        &balanced,
        name,
        &shown_by(&study.along, &quantities),
        true,
        progress,
    )?;
    set_beside(&mut result, &quantities, &before);
    let left = match study.goal {
        BalanceGoal::ShakingForce => values(&balanced, &study.along, &goal, progress)?,
        BalanceGoal::Statics => values(&only_weights(&balanced), &study.along, &goal, progress)?,
    };
    result.scalars = left_over(model, study.goal, &target, &left);
    result.listings.push(advice(model, &weights));
    if study.goal == BalanceGoal::ShakingForce {
        result.figures.extend(hodographs(&result));
        result
            .listings
            .extend(harmonics_of(model, &target, &left, &result));
    }
    Ok(result)
}

/// What is to vanish.
fn goal(model: &Model, goal: BalanceGoal) -> Vec<Quantity> {
    match goal {
        BalanceGoal::ShakingForce => vec![
            force(
                "shaking_force_x",
                ForceMeasure::ShakingForceX,
                Dimension::FORCE,
            ),
            force(
                "shaking_force_y",
                ForceMeasure::ShakingForceY,
                Dimension::FORCE,
            ),
        ],
        BalanceGoal::Statics => (0..model.drives.len() as u32)
            .map(|d| {
                let drive = DriveId(d);
                Quantity {
                    name: format!(
                        "reduced_load({})",
                        model.drives.get(drive.index()).map_or("", |d| &d.name)
                    ),
                    ..force(
                        "",
                        ForceMeasure::ReducedLoad(drive),
                        effort(model, drive).dimension,
                    )
                }
            })
            .collect(),
    }
}

/// What is shown before and after.
fn shown(model: &Model, of: BalanceGoal) -> Vec<Quantity> {
    let mut list = match of {
        BalanceGoal::ShakingForce => {
            let mut list = vec![force(
                "shaking_force",
                ForceMeasure::ShakingForce,
                Dimension::FORCE,
            )];
            list.extend(goal(model, of));
            list.push(force(
                "shaking_moment",
                ForceMeasure::ShakingMoment,
                Dimension::TORQUE,
            ));
            list
        }
        BalanceGoal::Statics => goal(model, of),
    };
    list.extend((0..model.drives.len() as u32).map(|d| effort(model, DriveId(d))));
    list
}

/// The model with its masses and gravity alone: what acts besides is no matter of counterweights.
fn only_weights(model: &Model) -> Model {
    let mut heavy = bare(model);
    heavy.links.clone_from(&model.links);
    heavy.actions.masses.clone_from(&model.actions.masses);
    heavy
}

/// All values in one list, each with the root of its row's weight.
fn in_one(lists: &[Vec<f64>]) -> Vec<f64> {
    let weights = weights(lists.first().map_or(0, Vec::len));
    let weighted = lists.iter().flat_map(|list| {
        list.iter().zip(&weights).map(|(value, weight)| {
            // Rows that were not reached say nothing.
            if value.is_finite() {
                value * weight.sqrt()
            } else {
                0.0
            }
        })
    });
    weighted.collect()
}

/// A mass on a link at a distance from its pivot.
fn weight(
    name: &str,
    model: &Model,
    on: LinkId,
    pivot: PointId,
    radius: f64,
    direction: f64,
    mass: f64,
) -> PointMass {
    let parameters: Vec<f64> = model.parameter_values();
    let link = model.links.get(on.index());
    let place = link.and_then(|link| {
        let index = link.points.iter().position(|p| p.point == pivot)?;
        link.evaluate(&parameters).get(index).copied()
    });
    let [x, y] = place.unwrap_or_default();
    let (s, c) = math::sin_cos(direction);
    PointMass {
        name: name.to_owned(),
        on,
        place: Place::Cartesian {
            x: constant(x + radius * c),
            y: constant(y + radius * s),
        },
        mass: constant(mass),
        span: 0..0,
    }
}

fn total_mass(model: &Model) -> f64 {
    let parameters: Vec<f64> = model.parameter_values();
    let own = model
        .links
        .iter()
        .filter_map(|l| l.inertia.as_ref()?.mass.as_ref());
    let all = own.chain(model.actions.masses.iter().map(|m| &m.mass));
    all.map(|m| value(m, &parameters)).sum()
}

fn free_name(model: &Model, name: String) -> String {
    let taken = |name: &str| model.actions.masses.iter().any(|m| m.name == name);
    let numbered = (2..).map(|k| format!("{name}{k}"));
    std::iter::once(name.clone())
        .chain(numbered)
        .find(|n| !taken(n))
        .unwrap_or(name)
}

/// How much of what was to vanish is left.
fn left_over(
    model: &Model,
    goal: BalanceGoal,
    before: &[Vec<f64>],
    after: &[Vec<f64>],
) -> Vec<Scalar> {
    let units = Units::of(model);
    let rms = |lists: &[Vec<f64>]| in_one(lists).iter().map(|v| v * v).sum::<f64>().sqrt();
    let (what, dimension) = match goal {
        BalanceGoal::ShakingForce => ("shaking force", Dimension::FORCE),
        BalanceGoal::Statics => ("load of gravity", effort(model, DriveId(0)).dimension),
    };
    let unit = units.unit(dimension);
    let scalar = |name: String, si: f64| Scalar {
        name,
        value: unit.from_si(si),
        unit: unit.clone(),
    };
    vec![
        scalar(format!("{what}, root mean square before"), rms(before)),
        scalar(format!("{what}, root mean square after"), rms(after)),
    ]
}

/// The lines that put the counterweights into the file.
fn advice(model: &Model, weights: &[PointMass]) -> Listing {
    let parameters: Vec<f64> = model.parameter_values();
    let units = Units::of(model);
    let lines = weights.iter().filter_map(|w| {
        let Place::Cartesian { x, y } = &w.place else {
            return None;
        };
        let length = |s| {
            // Rounding of a direction along an axis is no place.
            let si = (value(s, &parameters) / FINEST).round() * FINEST;
            units.written(si, Dimension::LENGTH)
        };
        Some(vec![format!(
            "{} = {{ on = \"{}\", at = [\"{}\", \"{}\"], mass = \"{}\" }}",
            w.name,
            model.links.get(w.on.index())?.name,
            length(x),
            length(y),
            units.written(value(&w.mass, &parameters), Dimension::MASS),
        )])
    });
    let mut rows: Vec<Vec<String>> = lines.collect();
    if rows.is_empty() {
        rows.push(vec!["no counterweight on these links helps".to_owned()]);
    }
    Listing {
        title: "Counterweights: what to write under [masses]".to_owned(),
        head: Vec::new(),
        rows,
    }
}

/// The tip of the shaking force before and after.
fn hodographs(result: &StudyResult) -> Vec<Figure> {
    ["before", "after"]
        .iter()
        .filter_map(|when| {
            let column = |axis: &str| {
                let name = format!("shaking_force_{axis} {when}");
                result.table.column(&name).cloned()
            };
            let axes = [column("x")?, column("y")?];
            Some(Figure::Hodograph(format!("shaking force {when}"), axes))
        })
        .collect()
}

/// Harmonics of the shaking force, where one drive turns once around at constant speed and the rows are even.
fn harmonics_of(
    model: &Model,
    before: &[Vec<f64>],
    after: &[Vec<f64>],
    result: &StudyResult,
) -> Option<Listing> {
    let [drive] = model.drives.as_slice() else {
        return None;
    };
    let angles = result.table.columns.get(1)?.si();
    let times = result.table.columns.first()?.si();
    let (rows, first) = (angles.len(), *angles.first()?);
    let turn = angles.last()? - first;
    let even = |values: &[f64]| {
        let step = (values.last().copied().unwrap_or(0.0) - values.first().copied().unwrap_or(0.0))
            / (rows.max(2) - 1) as f64;
        let pairs = values.windows(2);
        pairs
            .map(|w| (w[1] - w[0] - step).abs())
            .fold(0.0, f64::max)
            <= 1e-9 * step.abs()
    };
    let whole = (turn.abs() - std::f64::consts::TAU).abs() <= 1e-9;
    if drive.dimension != Dimension::ANGLE
        || !whole
        || rows <= 2 * HARMONICS + 1
        || !even(&angles)
        || !even(&times)
    {
        return None;
    }
    let found = |lists: &[Vec<f64>]| -> Option<Harmonics> {
        let [x, y] = lists else { return None };
        // The last row is the first again.
        let samples: Vec<[f64; 2]> = x
            .iter()
            .zip(y)
            .take(rows - 1)
            .map(|(x, y)| [*x, *y])
            .collect();
        samples
            .iter()
            .flatten()
            .all(|v| v.is_finite())
            .then(|| harmonics(&samples, first, HARMONICS))
    };
    let (before, after) = (found(before)?, found(after)?);
    let size = |list: &[[f64; 2]], k: usize| {
        let [re, im] = list.get(k).copied().unwrap_or_default();
        kempe_number::text::significant(math::hypot(re, im), 5)
    };
    let rows = (0..HARMONICS).map(|k| {
        vec![
            (k + 1).to_string(),
            size(&before.forward, k),
            size(&before.back, k),
            size(&after.forward, k),
            size(&after.back, k),
        ]
    });
    let head = [
        "harmonic",
        "with the crank, before [N]",
        "against it, before [N]",
        "with the crank, after [N]",
        "against it, after [N]",
    ];
    Some(Listing {
        title: "Harmonics of the shaking force".to_owned(),
        head: head.map(String::from).to_vec(),
        rows: rows.collect(),
    })
}
