//! Which numbers are asked of every design.

use kempe_model::{Leaf, Limit, Measure, Model, OverStudy, Statistic, Study, StudyKind};
use kempe_units::Expr;

use crate::columns::{Asked, numbers};
use crate::quantity::Quantity;

/// The numbers that a study of designs tells of every one of them: those of the file, or all named numbers over the motion that the study that is run knows, or without such the least and the largest of
/// each of its columns.
pub(crate) fn numbers_of(model: &Model, over: &OverStudy, study: &Study) -> Vec<Quantity> {
    if !over.asked.columns.is_empty() {
        let mut found: Vec<Quantity> = Vec::new();
        for column in &over.asked.columns {
            if found.iter().all(|known| known.name != column.name) {
                found.push(Quantity {
                    name: column.name.clone(),
                    measure: column.measure.clone(),
                    dimension: column.dimension,
                });
            }
        }
        return found;
    }
    let forces = knows_forces(study);
    let known = |q: &Quantity| forces || !model.needs_forces(&q.measure);
    let mut named = numbers(model);
    named.retain(known);
    if !named.is_empty() {
        return named;
    }
    let columns = match &study.kind {
        StudyKind::Motion(along) => Asked::of_motion(model, along).columns,
        _ => Asked::of_motion(model, study.kind.along()).columns,
    };
    let ends = |q: Quantity| {
        let both = [("min", Statistic::Min), ("max", Statistic::Max)];
        both.map(|(word, statistic)| Quantity {
            name: format!("{word}({})", q.name),
            measure: over_motion(statistic, q.measure.clone()),
            dimension: q.dimension,
        })
    };
    columns.into_iter().flat_map(ends).collect()
}

/// Whether a study knows forces.
pub(crate) fn knows_forces(study: &Study) -> bool {
    !matches!(study.kind, StudyKind::Motion(_))
}

fn over_motion(statistic: Statistic, measure: Measure) -> Measure {
    Expr::Leaf(Leaf::Over(statistic, Box::new(measure)))
}

/// How far a design keeps a limit, a number over the motion: not negative where it does. What has a value at every instant must keep it all along.
pub(crate) fn kept(model: &Model, limit: &Limit) -> Quantity {
    let above = &limit.condition.above;
    let measure = match is_one_number(model, above) {
        true => above.clone(),
        false => over_motion(Statistic::Min, above.clone()),
    };
    Quantity {
        name: limit.condition.text.clone(),
        measure,
        dimension: limit.condition.dimension,
    }
}

/// What a limit limits as a number over the motion: where it has a value at every instant, the one nearest to the limit.
pub(crate) fn limited_side(model: &Model, limit: &Limit) -> Quantity {
    let limited = &limit.limited;
    let (name, measure) = match is_one_number(model, &limited.measure) {
        true => (limited.name.clone(), limited.measure.clone()),
        false => {
            let (word, statistic) = match limit.at_least {
                true => ("min", Statistic::Min),
                false => ("max", Statistic::Max),
            };
            let measure = over_motion(statistic, limited.measure.clone());
            (format!("{word}({})", limited.name), measure)
        }
    };
    Quantity {
        name,
        measure,
        dimension: limited.dimension,
    }
}

/// Whether a measure is one number over the whole motion.
fn is_one_number(model: &Model, measure: &Measure) -> bool {
    crate::columns::is_number(model, measure)
}
