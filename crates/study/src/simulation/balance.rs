//! How well energy and power balance in the rows of a simulation, and what holds the mechanism meanwhile.

use kempe_model::{Diagnostic, DriveId, ForceMeasure, Leaf};
use kempe_simulate::{Held, Question, Simulated};
use kempe_units::{Dimension, Expr};

use crate::quantity::Quantity;
use crate::table::{BalanceColumns, largest};
use crate::unit::Units;

/// A balance that is off by more than this, or by more than a larger tolerance asks for, is told ...
const OFF: [(&str, f64); 2] = [("energy", 1e-8), ("power", 1e-6)];
/// ... and by more than this in any case.
const WRONG: f64 = 1e-3;
/// Where less than this part of the energies is moved, nothing moves: a balance is in parts of this.
const STANDS: f64 = 1e-9;

/// Energies, the rate of the kinetic one, and effort, speed and what the throttle goes by of every drive that is let go.
pub(super) fn hidden(free: &[DriveId], found: &Simulated) -> Vec<Quantity> {
    let force = |measure: ForceMeasure| Expr::Leaf(Leaf::Force(measure));
    let quantity = |measure| Quantity {
        name: String::new(),
        measure,
        dimension: Dimension::NONE,
    };
    let kinetic = force(ForceMeasure::KineticEnergy);
    let mut list = vec![
        quantity(kinetic.clone()),
        quantity(force(ForceMeasure::PotentialEnergy)),
        quantity(Expr::Leaf(Leaf::Rate(Box::new(kinetic), 1))),
    ];
    for (place, drive) in free.iter().enumerate() {
        list.push(quantity(force(ForceMeasure::Drive(*drive))));
        let coordinate = Box::new(Expr::Leaf(Leaf::Drive(*drive)));
        list.push(quantity(Expr::Leaf(Leaf::Rate(coordinate, 1))));
        let throttle = found.throttle(place).cloned();
        list.push(quantity(throttle.unwrap_or(Expr::Const(1.0))));
    }
    list
}

/// What holds it at a time.
pub(super) fn held_at(found: &Simulated, time: f64) -> impl Iterator<Item = &Held> {
    // Times rise: of two that meet there, both hold.
    let first = found.held.partition_point(|held| held.to < time);
    let from = found.held.get(first..).unwrap_or(&[]).iter();
    from.take_while(move |held| held.holds_at(time))
}

/// How well energy and power balance.
pub(super) fn balance(
    question: &Question,
    found: &Simulated,
    times: &[f64],
    values: &[Vec<f64>],
) -> BalanceColumns {
    let value = |index: usize, row: usize| {
        let column = values.get(index);
        column.and_then(|c| c.get(row)).copied().unwrap_or(f64::NAN)
    };
    let rows = 0..times.len();
    // What is struck at once has cost its work before the first row.
    let before = found.work.at(0.0, &[]);
    let works = times.iter().map(|t| found.work.at(*t, &[]) - before);
    let works: Vec<f64> = works.collect();
    let energy = |row: usize| value(0, row) + value(1, row);
    let moved = |row: usize| {
        let (kinetic, potential) = (value(0, row), value(1, row) - value(1, 0));
        kinetic.abs().max(potential.abs()).max(works[row].abs())
    };
    let there = |row: usize| value(0, row).abs().max(value(1, row).abs());
    let rounding = STANDS * rows.clone().map(there).fold(0.0, f64::max);
    let most = rows.clone().map(moved).fold(rounding, f64::max);
    let fastest = rows
        .clone()
        .map(|row| value(2, row).abs())
        .fold(most / question.until, f64::max);
    let part = |x: f64, of: f64| if x == 0.0 { 0.0 } else { x / of };
    let is_held = |t: f64| held_at(found, t).next().is_some();
    let asked = |row: usize| {
        (0..found.free.len())
            .map(|k| {
                let [effort, speed, throttled] = [0, 1, 2].map(|j| value(3 + 3 * k + j, row));
                (effort - found.gives(k, [times[row], speed], throttled)) * speed
            })
            .sum::<f64>()
    };
    BalanceColumns {
        energy: (rows.clone())
            .map(|row| part(energy(row) - energy(0) - works[row], most))
            .collect(),
        power: rows
            .map(|row| match is_held(times[row]) {
                true => f64::NAN,
                false => part(asked(row), fastest),
            })
            .collect(),
    }
}

/// A balance that does not come out.
pub(super) fn out_of_balance(
    name: &str,
    units: &Units,
    balance: &BalanceColumns,
    times: &[f64],
    tolerance: f64,
) -> Vec<Diagnostic> {
    let worst = OFF.iter().zip([&balance.energy, &balance.power]);
    let worst = worst.map(|((what, least), column)| {
        let limit = least.max(tolerance).min(WRONG);
        let sizes: Vec<f64> = column.iter().map(|x| x.abs()).collect();
        let (row, off) = largest(&sizes).filter(|(_, off)| *off > limit)?;
        let at = units.text(times.get(row).copied().unwrap_or(f64::NAN), Dimension::TIME);
        let message = format!(
            "study `{name}`: the balance of {what} is off by {off:.1e} of the most that is moved, at {at}"
        );
        let warning = Diagnostic::warning("out-of-balance", message);
        Some(warning.help("ask for a smaller `tolerance`; where something jumps there, its size is uncertain"))
    });
    worst.flatten().collect()
}
