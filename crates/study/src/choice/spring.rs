//! The spring that leaves a wanted effort to a drive.

use kempe_dynamics::spring_choice::{ChosenSpring, EffortSample, choose_spring};
use kempe_model::{Acts, Diagnostic, Model, Scalar as Expression, Spring, SpringStudy, value};
use kempe_units::{Dimension, Unit};

use super::{bare, constant, effort, is_zero, set_beside, shown_by, values, weights};
use crate::motion::run_along;
use crate::quantity::Quantity;
use crate::result::{Figure, Listing, Scalar, StudyResult};
use crate::table::Column;
use crate::unit::Units;
use kempe_motion::progress::Progress;

/// Chooses a spring's stiffness and preload and shows the motion with it.
pub(crate) fn spring(
    model: &Model,
    name: &str,
    study: &SpringStudy,
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    let Some(own) = model.actions.springs.get(study.spring) else {
        return Err(Vec::new());
    };
    let asked = [effort(model, study.drive)];
    let with = |stiffness: f64, preload: f64| Spring {
        stiffness: constant(stiffness),
        preload: constant(preload),
        ..own.clone()
    };
    let without = replaced(model, study.spring, with(0.0, 0.0));
    let without = values(&without, &study.along, &asked, progress)?;
    // One unit of each, on the bare mechanism: acting both ways and without stops, so that it is linear.
    let mut unit = |stiffness: f64, preload: f64| {
        let mut alone = bare(model);
        alone.actions.gravity = Some([constant(0.0), constant(0.0)]);
        alone.actions.springs = vec![Spring {
            acts: Acts::Both,
            stops: [None, None],
            ..with(stiffness, preload)
        }];
        values(&alone, &study.along, &asked, progress)
    };
    let (by_stiffness, by_preload) = (unit(1.0, 0.0)?, unit(0.0, 1.0)?);
    let wanted = Quantity {
        name: "wanted".to_owned(),
        measure: study.wanted.clone(),
        ..effort(model, study.drive)
    };
    let wanted = values(model, &study.along, &[wanted], progress)?;
    let samples = samples(&without, &wanted, &by_stiffness, &by_preload);
    let parameters: Vec<f64> = model.parameter_values();
    let chosen = choose_spring(
        &samples,
        bounds(&study.stiffness, &parameters),
        bounds(&study.preload, &parameters),
    );

    let helped = replaced(model, study.spring, with(chosen.stiffness, chosen.preload));
    let mut result = run_along(
        &helped,
        name,
        &shown_by(&study.along, &asked),
        true,
        progress,
    )?;
    set_beside(&mut result, &asked, &without);
    if !is_zero(&study.wanted) {
        add_wanted(&mut result, &wanted);
    }
    tell(model, own, study, &chosen, &mut result);
    Ok(result)
}

fn replaced(model: &Model, index: usize, spring: Spring) -> Model {
    let mut changed = model.clone();
    if let Some(own) = changed.actions.springs.get_mut(index) {
        *own = spring;
    }
    changed
}

fn samples(
    without: &[Vec<f64>],
    wanted: &[Vec<f64>],
    by_stiffness: &[Vec<f64>],
    by_preload: &[Vec<f64>],
) -> Vec<EffortSample> {
    let all = |lists: &'_ [Vec<f64>]| lists.iter().flatten().copied().collect::<Vec<f64>>();
    let columns = [without, wanted, by_stiffness, by_preload].map(all);
    let rows = columns.iter().map(Vec::len).min().unwrap_or(0);
    // The first and the last row count half, so that the rows of a full turn count evenly.
    let weights = weights(rows);
    let row = |k: usize| {
        let weight = (weights[k] * rows as f64).sqrt();
        columns.each_ref().map(|c| c[k] * weight)
    };
    (0..rows)
        .map(row)
        .filter(|r| r.iter().all(|x| x.is_finite()))
        .map(|[without, wanted, by_stiffness, by_preload]| EffortSample {
            without,
            wanted,
            by_stiffness,
            by_preload,
        })
        .collect()
}

fn bounds([low, high]: &[Option<Expression>; 2], parameters: &[f64]) -> (f64, f64) {
    let of = |bound: &Option<Expression>, none: f64| {
        bound.as_ref().map_or(none, |b| value(b, parameters))
    };
    (of(low, f64::NEG_INFINITY), of(high, f64::INFINITY))
}

fn add_wanted(result: &mut StudyResult, wanted: &[Vec<f64>]) {
    let Some(Figure::Curves { curves, .. }) = result.figures.first_mut() else {
        return;
    };
    let Some(unit) = curves.first().map(|c| c.unit.clone()) else {
        return;
    };
    let rows = result.table.notes.len();
    let mut column = Column::new("wanted", unit);
    let values = wanted.iter().flatten().take(rows);
    column.values = values.map(|v| column.unit.from_si(*v)).collect();
    curves.push(column.clone());
    result.table.columns.push(column);
}

/// What was chosen, in numbers and as lines of the file.
fn tell(
    model: &Model,
    spring: &Spring,
    study: &SpringStudy,
    chosen: &ChosenSpring,
    result: &mut StudyResult,
) {
    let units = Units::of(model);
    let turns = matches!(spring.between, kempe_model::Between::Links(..));
    let (tension, stiffness) = if turns {
        (Dimension::TORQUE, Dimension::TORSIONAL_STIFFNESS)
    } else {
        (Dimension::FORCE, Dimension::FORCE / Dimension::LENGTH)
    };
    let scalar = |name: &str, si: f64, unit: Unit| Scalar {
        name: name.to_owned(),
        value: unit.from_si(si),
        unit,
    };
    let effort = effort(model, study.drive).dimension;
    result.scalars = vec![
        scalar("stiffness", chosen.stiffness, units.unit(stiffness)),
        scalar("preload", chosen.preload, units.unit(tension)),
        scalar(
            "effort less wanted, root mean square before",
            chosen.without,
            units.unit(effort),
        ),
        scalar(
            "effort less wanted, root mean square after",
            chosen.left,
            units.unit(effort),
        ),
    ];
    result.listings.push(Listing {
        title: format!(
            "Spring: what to write for `{}` under [springs]",
            spring.name
        ),
        head: Vec::new(),
        rows: vec![vec![format!(
            "stiffness = \"{}\", preload = \"{}\"",
            units.written(chosen.stiffness, stiffness),
            units.written(chosen.preload, tension)
        )]],
    });
    if spring.acts != Acts::Both || spring.stops.iter().any(Option::is_some) {
        result.diagnostics.push(
            Diagnostic::warning(
                "spring-not-linear",
                format!(
                    "study `{}`: `{}` acts one way or has stops; it was chosen as if it acted both ways without stops",
                    result.name, spring.name
                ),
            )
            .at(spring.span.clone(), "")
            .note("the values after are those of the spring as the file describes it")
            .help("leave `acts` and the stops out while it is chosen, or see in the values after whether it does"),
        );
    }
}
