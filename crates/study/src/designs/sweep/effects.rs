//! What each parameter does to each number: exactly at the file's own design, and by the values that were tried one at a time.

use kempe_model::{Combine, StudyKind, SweepStudy};

use super::order::Order;
use crate::designs::bench::{Answer, Bench, Refused};
use crate::result::Listing;
use crate::unit::{Units, number_text};

/// Of one parameter at a time, or of one parameter alone.
pub(super) fn effects(
    bench: &Bench<'_>,
    study: &SweepStudy,
    order: &Order,
    answers: &[Result<Answer, Refused>],
    units: &Units,
) -> Vec<Listing> {
    if study.combine != Combine::OneAtATime && bench.varied.len() > 1 {
        return Vec::new();
    }
    let mut all = Vec::new();
    if study.combine == Combine::OneAtATime && answers.len() == order.designs.len() {
        all.extend(
            (0..bench.numbers.len()).filter_map(|k| tornado(bench, k, order, answers, units)),
        );
    }
    all.extend(derivatives(bench, units));
    all
}

/// The parameters by how far they move a number, the farthest first.
fn tornado(
    bench: &Bench<'_>,
    number: usize,
    order: &Order,
    answers: &[Result<Answer, Refused>],
    units: &Units,
) -> Option<Listing> {
    let own = answers.first()?.as_ref().ok()?.numbers[number];
    let quantity = &bench.numbers[number];
    let mut rows: Vec<(f64, Vec<String>)> = Vec::new();
    for (k, id) in bench.varied.iter().enumerate() {
        let parameter = &bench.model.parameters[id.index()];
        let tried = order.of.iter().zip(&order.designs).zip(answers);
        let tried = tried.filter(|((of, _), _)| **of == Some(k));
        let mut found: Vec<(f64, f64)> = tried
            .filter_map(|((_, design), answer)| {
                Some((design[k], answer.as_ref().ok()?.numbers[number]))
            })
            .filter(|(_, value)| value.is_finite())
            .collect();
        found.push((bench.own_values()[k], own));
        let least = *found.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let most = *found.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let at = |(x, value): (f64, f64)| {
            format!(
                "{} at {}",
                units.text(value, quantity.dimension),
                units.text(x, parameter.dimension)
            )
        };
        let moved = most.1 - least.1;
        let failed = (order.of.iter().zip(answers))
            .filter(|(of, answer)| **of == Some(k) && answer.is_err());
        let lost = match failed.count() {
            0 => String::new(),
            count => format!("{count} do not move as asked"),
        };
        rows.push((
            moved,
            vec![
                parameter.name.clone(),
                at(least),
                at(most),
                units.text(moved, quantity.dimension),
                lost,
            ],
        ));
    }
    rows.sort_by(|a, b| b.0.total_cmp(&a.0));
    Some(Listing {
        title: format!(
            "{}: {} in the file",
            quantity.name,
            units.text(own, quantity.dimension)
        ),
        head: ["parameter", "least", "largest", "moves it by", ""]
            .map(str::to_owned)
            .to_vec(),
        rows: rows.into_iter().map(|(_, row)| row).collect(),
    })
}

/// Exact derivatives at the file's own design; none of simulations.
fn derivatives(bench: &Bench<'_>, units: &Units) -> Option<Listing> {
    if let StudyKind::Simulate(_) = bench.over.kind {
        return None;
    }
    let slopes = bench.slopes(&bench.own_values()).ok()?;
    let mut head = vec!["per".to_owned()];
    let own_units: Vec<_> = bench.numbers.iter().map(|q| q.unit(units)).collect();
    head.extend(
        bench
            .numbers
            .iter()
            .zip(&own_units)
            .map(|(q, unit)| match unit.text() {
                "" => q.name.clone(),
                text => format!("{} [{text}]", q.name),
            }),
    );
    let rows = bench.varied.iter().enumerate().map(|(k, id)| {
        let parameter = &bench.model.parameters[id.index()];
        let unit = units.unit(parameter.dimension);
        let one = match unit.text() {
            "" => format!("1 of {}", parameter.name),
            text => format!("1 {text} of {}", parameter.name),
        };
        let mut row = vec![one];
        row.extend(slopes.iter().zip(&own_units).map(|(slope, own)| {
            let value = (own.from_si(slope.slope[k]) - own.from_si(0.0)) * unit.to_si(1.0);
            if value.is_finite() {
                number_text(value)
            } else {
                "none".to_owned()
            }
        }));
        row
    });
    Some(Listing {
        title: "exact derivatives at the file's own design".to_owned(),
        rows: rows.collect(),
        head,
    })
}
