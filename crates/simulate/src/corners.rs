//! Corners of what goes by time: where the sides of a least, greatest or absolute value change places.

use kempe_measure::measure::visit_parts;
use kempe_model::{Leaf, Measure, Model, value};
use kempe_units::{Builtin, Expr};

/// So many parts of the whole time are looked at.
const PARTS: usize = 1000;
/// Named measures are written out so often at most: they may name each other.
const WRITTEN_OUT: usize = 200;

/// The times from 0 to `until`, s, at which a measure has a corner that hangs on time alone; those between which it has two in a thousandth
/// part of the time are not seen.
pub(crate) fn corners(
    model: &Model,
    parameters: &[f64],
    measure: &Measure,
    until: f64,
) -> Vec<f64> {
    let over_time = |part: &Measure| written_out(model, parameters, part, &mut 0);
    let mut times = Vec::new();
    visit_parts(model, measure, &mut |part| {
        let Expr::Call(builtin @ (Builtin::Min | Builtin::Max | Builtin::Abs), arguments) = part
        else {
            return;
        };
        let mut sides: Vec<Expr<()>> = arguments.iter().filter_map(over_time).collect();
        if *builtin == Builtin::Abs {
            sides.push(Expr::Const(0.0));
        }
        let sign = if *builtin == Builtin::Min { -1.0 } else { 1.0 };
        if sides.len() > 1 {
            times.extend(changes(|time| largest(&sides, sign, time), until));
        }
    });
    times
}

/// Which of some functions of time is largest then, each times `sign`; the first of several.
fn largest(sides: &[Expr<()>], sign: f64, time: f64) -> usize {
    let mut best = (f64::NEG_INFINITY, 0);
    for (k, side) in sides.iter().enumerate() {
        let value = sign * side.eval(&mut |()| time);
        if value > best.0 {
            best = (value, k);
        }
    }
    best.1
}

/// A measure as an expression of time, where it is one of time and parameters alone.
fn written_out(
    model: &Model,
    parameters: &[f64],
    measure: &Measure,
    names: &mut usize,
) -> Option<Expr<()>> {
    let mut known = true;
    let found = measure.substitute(&mut |leaf| match leaf {
        Leaf::Time => Expr::Leaf(()),
        Leaf::Parameter(id) => Expr::Const(value(&Expr::Leaf(*id), parameters)),
        Leaf::Named(index) if known && *names < WRITTEN_OUT => {
            *names += 1;
            let named = model.measures.get(*index);
            let named = named.and_then(|it| written_out(model, parameters, &it.measure, names));
            known &= named.is_some();
            named.unwrap_or(Expr::Const(0.0))
        }
        _ => {
            known = false;
            Expr::Const(0.0)
        }
    });
    known.then_some(found)
}

/// Where what is told of times changes, each the first time at which it is otherwise.
fn changes(of: impl Fn(f64) -> usize, until: f64) -> Vec<f64> {
    let mut found = Vec::new();
    let mut known = (0.0, of(0.0));
    for k in 1..=PARTS {
        let time = until * k as f64 / PARTS as f64;
        let next = (time, of(time));
        if next.1 != known.1 {
            let (mut low, mut high) = (known.0, next.0);
            loop {
                let middle = low + 0.5 * (high - low);
                if middle <= low || middle >= high {
                    break;
                }
                match of(middle) == known.1 {
                    true => low = middle,
                    false => high = middle,
                }
            }
            found.push(high);
        }
        known = next;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(load: &str) -> Vec<f64> {
        let text = format!(
            "[parameters]\nlate = \"1.5 s\"\n[links]\nframe = {{ A = [0, 0] }}\narm = {{ A-B = 1 }}\n[drives]\nm = {{ turns = \"arm\", at = 0 }}\n\
             [measures]\nramp = \"min(1, max(0, (time - late) / 50 ms))\"\ntwice = \"ramp + ramp\"\n\
             [loads]\none = {{ torque = \"{load}\", on = \"arm\" }}\n"
        );
        let read = Model::from_toml(&text, "test", &mut |_| Err(String::new()));
        let model = read.expect("a model").model;
        let parameters = model.parameter_values::<f64>();
        let kempe_model::LoadKind::Torque { amount, .. } = &model.actions.loads[0].kind else {
            panic!("a torque");
        };
        let kempe_model::Amount::Measure(measure) = amount else {
            panic!("a measure");
        };
        let mut all = corners(&model, &parameters, measure, 4.0);
        all.sort_by(f64::total_cmp);
        all
    }

    #[test]
    fn corners_in_time_are_where_sides_change_places() {
        let near = |load: &str, wanted: &[f64]| {
            let found = found(load);
            assert_eq!(found.len(), wanted.len(), "{load}: {found:?}");
            for (a, b) in found.iter().zip(wanted) {
                assert!((a - b).abs() < 1e-15, "{load}: {found:?}");
            }
        };
        near(
            "-1 N m * min(1, max(0, (time - 1 s) * 20 / 1 s))",
            &[1.0, 1.05],
        );
        near("2 N m * ramp", &[1.5, 1.55]);
        near("2 N m * twice", &[1.5, 1.55]);
        near("1 N m / 1 s * abs(time - late)", &[1.5]);
        near("1 N m / 1 s * max(time, 0.3 s, 1 s)", &[1.0]);
        near("1 N m * sin(time * 3 rad / 1 s)", &[]);
        // As many as anybody may write.
        let many: String = (0..450).map(|k| format!(", {k} ms")).collect();
        near(&format!("1 N m / 1 s * max(time{many})"), &[0.449]);
        // What goes by the pose tells nothing before it is simulated.
        near("1 N m * min(1, angle(arm) / 1 rad)", &[]);
    }
}
