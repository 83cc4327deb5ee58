//! Numbers of which a number is the largest by its formula, as `max(a, b)` and `abs(a)` are.

use kempe_model::{Leaf, Measure, Model};
use kempe_units::Builtin;

/// A number that is the largest of more than so many by its formula is not parted into these.
const MOST_PARTS: usize = 32;
/// Measures that name others more often than this are not looked into.
pub(super) const MOST_LEAVES: usize = 200;

/// A measure with those that it names written out; `None` where that is long.
pub(super) fn written_out(model: &Model, measure: &Measure, left: &mut usize) -> Option<Measure> {
    let mut whole = true;
    let out = measure.substitute(&mut |leaf| {
        *left = left.saturating_sub(1);
        if *left == 0 || !whole {
            whole = false;
            return Measure::Leaf(leaf.clone());
        }
        match leaf {
            Leaf::Named(index) => {
                let named = model.measures.get(*index);
                let found = named.and_then(|named| written_out(model, &named.measure, left));
                whole &= found.is_some();
                found.unwrap_or_else(|| Measure::Leaf(leaf.clone()))
            }
            _ => Measure::Leaf(leaf.clone()),
        }
    });
    whole.then_some(out)
}

/// Numbers, each with its sign, of which one times its sign is the largest by its formula, as `max(a, b)`, `abs(a)` and sums of these are: where two are equally
/// large it has a kink. Where there is none, or there are too many, it alone.
pub(super) fn largest_of(model: &Model, measure: &Measure, sign: f64) -> Vec<(Measure, f64)> {
    let out = written_out(model, measure, &mut { MOST_LEAVES });
    let parts = out.map_or(Vec::new(), |out| parted(&out, sign));
    match (2..=MOST_PARTS).contains(&parts.len()) {
        true => parts,
        false => vec![(measure.clone(), sign)],
    }
}

fn parted(measure: &Measure, sign: f64) -> Vec<(Measure, f64)> {
    let of = |part: &Measure, sign: f64| parted(part, sign);
    let sum = |a: Vec<(Measure, f64)>, b: Vec<(Measure, f64)>| -> Vec<(Measure, f64)> {
        if a.len() * b.len() == 1 || a.len() * b.len() > MOST_PARTS {
            return vec![(measure.clone(), sign)];
        }
        let signed = |(part, own): &(Measure, f64)| match *own == sign {
            true => Box::new(part.clone()),
            false => Box::new(Measure::Neg(Box::new(part.clone()))),
        };
        let pairs = a.iter().flat_map(|a| b.iter().map(move |b| (a, b)));
        pairs
            .map(|(a, b)| (Measure::Add(signed(a), signed(b)), sign))
            .collect()
    };
    match measure {
        Measure::Call(Builtin::Max, all) if sign > 0.0 => {
            all.iter().flat_map(|part| of(part, sign)).collect()
        }
        Measure::Call(Builtin::Min, all) if sign < 0.0 => {
            all.iter().flat_map(|part| of(part, sign)).collect()
        }
        Measure::Call(Builtin::Abs, all) if sign > 0.0 => {
            let signs = all.iter().flat_map(|part| [(part, 1.0), (part, -1.0)]);
            signs.flat_map(|(part, sign)| of(part, sign)).collect()
        }
        Measure::Neg(part) => of(part, -sign),
        Measure::Add(a, b) => sum(of(a, sign), of(b, sign)),
        Measure::Sub(a, b) => sum(of(a, sign), of(b, -sign)),
        Measure::Mul(a, b) => match (a.as_constant(), b.as_constant()) {
            (Some(k), _) => scaled(k, b, sign),
            (_, Some(k)) => scaled(k, a, sign),
            _ => vec![(measure.clone(), sign)],
        },
        Measure::Div(a, b) => match b.as_constant() {
            Some(k) => scaled(1.0 / k, a, sign),
            None => vec![(measure.clone(), sign)],
        },
        _ => vec![(measure.clone(), sign)],
    }
}

/// The parts of a number so many times as large.
fn scaled(factor: f64, measure: &Measure, sign: f64) -> Vec<(Measure, f64)> {
    let parts = parted(measure, sign * factor.signum()).into_iter();
    let size = Measure::Const(factor.abs());
    parts
        .map(|(part, sign)| {
            let both = Measure::Mul(Box::new(size.clone()), Box::new(part));
            (both, sign)
        })
        .collect()
}
