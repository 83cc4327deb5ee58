//! One plan, many numbers: derivatives against differences, gradients against dual numbers.
#![allow(clippy::unwrap_used, clippy::disallowed_methods)]
#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "not a number must fail too"
)]

use std::collections::BTreeMap;

use crate::support::generate::{config, make, recipe, recipes};
use crate::support::{Case, Rng};
use kempe_measure::Sampler;
use kempe_mechanism::constraint::Joint;
use kempe_mechanism::structure::BodyId;
use kempe_mechanism::{Design, Geometry, Input, Pose, Situation};
use kempe_model::{DriveKind, Measure};
use kempe_motion::Motion;
use kempe_number::{Dual, Jet, Number};
use proptest::prelude::*;

const N: usize = 7;
type Series = Jet<f64, N>;
type D = Dual<f64, 1>;

/// x, y (in sizes), cosine and sine of every body.
fn numbers<T: Number>(poses: &[Pose<T>], size: f64) -> Vec<T> {
    poses
        .iter()
        .skip(1)
        .flat_map(|p| [p.x / size, p.y / size, p.c, p.s])
        .collect()
}

fn plain_at(motion: &std::sync::Arc<Motion>, p: f64) -> Vec<f64> {
    let mut solver = motion.solver::<f64>();
    motion.solve(&motion.design, p, &mut solver);
    numbers(&solver.state.poses, motion.size())
}

/// Central differences of eighth order: first and second derivative.
fn differences(f: &dyn Fn(f64) -> Vec<f64>, p: f64, h: f64) -> (Vec<f64>, Vec<f64>) {
    const FIRST: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
    const SECOND: [f64; 4] = [8.0 / 5.0, -1.0 / 5.0, 8.0 / 315.0, -1.0 / 560.0];
    let middle = f(p);
    let mut first = vec![0.0; middle.len()];
    let mut second: Vec<f64> = middle.iter().map(|m| -205.0 / 72.0 * m).collect();
    for k in 0..4 {
        let (a, b) = (f(p + (k + 1) as f64 * h), f(p - (k + 1) as f64 * h));
        for i in 0..middle.len() {
            first[i] += FIRST[k] * (a[i] - b[i]);
            second[i] += SECOND[k] * (a[i] + b[i]);
        }
    }
    first.iter_mut().for_each(|x| *x /= h);
    second.iter_mut().for_each(|x| *x /= h * h);
    (first, second)
}

proptest! {
    #![proptest_config(config(200))]

    /// The series in the path parameter: first and second derivative of every pose.
    #[test]
    fn series_agree_with_differences(recipe in recipes(1.0), part in 0.05..0.95_f64) {
        let made = make(&recipe);
        let case = Case::of(&made.spec);
        let Ok(motion) = case.motion() else { return Ok(()) };
        let (low, high) = motion.reached();
        let p = low + part * (high - low);
        let design: Design<Series> = Design::new(&case.mechanism, &[]);
        let mut solver = motion.solver::<Series>();
        motion.solve(&design, Series::variable(p), &mut solver);
        let rich = numbers(&solver.state.poses, motion.size());
        // Not bit for bit: a Newton block is corrected once more for every coefficient. Rounding of the residuals moves
        // a pose by their part over the smallest singular value.
        let singular = Sampler::new(&motion, &[]).unwrap().without_time(p).smallest_singular_value;
        for (x, y) in rich.iter().zip(plain_at(&motion, p)) {
            let gap = (x.value() - y).abs();
            let allowed = (1e-11 * (1.0 + y.abs())).max(1e-14 / singular);
            prop_assert!(!(gap > allowed), "{} {y} {singular:e}\n{}", x.value(), case.text);
        }
        // How far the series can be trusted: the radius its own coefficients tell.
        let mut radius = f64::INFINITY;
        for x in &rich {
            for k in 2..N {
                let c = x.coefficient(k).abs();
                if c > 0.0 {
                    radius = radius.min(c.powf(-1.0 / k as f64));
                }
            }
        }
        let h = (0.02 * radius).min(0.01 * (high - low));
        let near_event = motion.events.iter().any(|e| (e.at - p).abs() < 5.0 * h + e.bridge);
        let far = rich.iter().any(|x| x.value().abs() > 50.0);
        if !(h > 1e-7 * (high - low)) || h < 1e-6 * p.abs() || p - 4.0 * h < low || p + 4.0 * h > high || near_event || far {
            return Ok(());
        }
        let (first, second) = differences(&|p| plain_at(&motion, p), p, h);
        // At the points of a smooth curve third derivatives jump, in the midst of the differences.
        let has_curves = !case.mechanism.curves.is_empty();
        let (off_first, off_second) = if has_curves { (1e-6, 1e-6) } else { (1e-10, 1e-9) };
        for (i, x) in rich.iter().enumerate() {
            let (a, b) = (x.derivative(1), x.derivative(2));
            prop_assert!(
                (a - first[i]).abs() * h <= off_first,
                "first {i}: {a} {} h {h:e}\n{}", first[i], case.text
            );
            prop_assert!(
                (b - second[i]).abs() * h * h <= off_second,
                "second {i}: {b} {} h {h:e}\n{}", second[i], case.text
            );
        }
    }
}

/// A dual number per coordinate: `gradients` is the derivative of `residual` for every kind of constraint, on the
/// constraints' surface and off it.
#[test]
fn gradients_are_the_derivatives_of_residuals() {
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    let mut rng = Rng(11);
    for seed in 0..150 {
        let made = make(&recipe(seed));
        let size = made.spec.size();
        let case = Case::of(&made.spec);
        let m = &case.mechanism;
        let at: Vec<[f64; 3]> = (0..m.bodies)
            .map(|b| {
                if b == 0 {
                    [0.0; 3]
                } else {
                    [
                        rng.range(-1.0, 1.0) * size,
                        rng.range(-1.0, 1.0) * size,
                        rng.angle(),
                    ]
                }
            })
            .collect();
        let near: Vec<f64> = at.iter().map(|a| a[2] + rng.range(-1.0, 1.0)).collect();
        let q: Vec<f64> = case
            .model
            .drives
            .iter()
            .map(|d| match d.kind {
                DriveKind::Turn { .. } => rng.angle(),
                _ => rng.range(0.1, 1.0) * size,
            })
            .collect();
        let input = |index: usize, value: D| match case.model.drives[index].kind {
            DriveKind::Turn { .. } => Input::turn(value),
            _ => Input::length(value),
        };
        let plain_poses: Vec<Pose<f64>> = at
            .iter()
            .map(|a| Pose::from_angle(a[0], a[1], a[2]))
            .collect();
        let plain_inputs: Vec<Input<f64>> = q
            .iter()
            .enumerate()
            .map(|(i, v)| match case.model.drives[i].kind {
                DriveKind::Turn { .. } => Input::turn(*v),
                _ => Input::length(*v),
            })
            .collect();
        let plain = Situation {
            geometry: &case.design.geometry,
            inputs: &plain_inputs,
            poses: &plain_poses,
            near: &near,
        };
        let geometry: Geometry<D> = Geometry::new(m, &[]);
        // Unknown 3 body + k for a body's coordinate, then the drives.
        let unknowns = 3 * m.bodies + q.len();
        for (constraint, _) in &m.constraints {
            let kind: String = format!("{constraint:?}")
                .chars()
                .take_while(|c| c.is_alphanumeric())
                .collect();
            *seen.entry(kind).or_default() += 1;
            let mut analytic = vec![[0.0; 2]; unknowns];
            let to_drive = plain.gradients(constraint, |g| {
                for k in 0..3 {
                    analytic[3 * g.body.index() + k][g.row] += g.to[k];
                }
            });
            if let Some(drive) = constraint.drive() {
                analytic[3 * m.bodies + drive.index()][0] = to_drive;
            }
            // On its surface a direction's gradient is exact; off it a sine's derivative is the cosine.
            for (unknown, expected) in analytic.iter().enumerate().skip(3) {
                let value = |index: usize, x: f64| {
                    if index == unknown {
                        D::variable(x, 0)
                    } else {
                        D::constant(x)
                    }
                };
                let poses: Vec<Pose<D>> = at
                    .iter()
                    .enumerate()
                    .map(|(b, a)| {
                        let [x, y, t] = [0, 1, 2].map(|k| value(3 * b + k, a[k]));
                        Pose::from_angle(x, y, t)
                    })
                    .collect();
                let inputs: Vec<Input<D>> = q
                    .iter()
                    .enumerate()
                    .map(|(i, v)| input(i, value(3 * m.bodies + i, *v)))
                    .collect();
                let situation = Situation {
                    geometry: &geometry,
                    inputs: &inputs,
                    poses: &poses,
                    near: &near,
                };
                let residual = situation.residual(constraint);
                for row in 0..constraint.rows() {
                    let got = residual[row].eps[0];
                    let scale = 1.0 + size + got.abs();
                    assert!(
                        (got - expected[row]).abs() < 1e-12 * scale,
                        "{constraint:?} row {row} to {unknown}: {got} {}",
                        expected[row]
                    );
                }
            }
        }
        assert_eq!(BodyId::GROUND.index(), 0);
    }
    for kind in [
        "Coincide",
        "OnLine",
        "Direction",
        "Distance",
        "Travel",
        "Gears",
        "Rack",
        "Belt",
        "OnArc",
        "OnCurve",
        "Shoe",
    ] {
        assert!(seen.get(kind).is_some_and(|n| *n > 10), "{kind}: {seen:?}");
    }
}

/// `rate`, `d` and their second orders, as measures, against differences of the measured values.
#[test]
fn rates_and_coefficients_agree_with_differences_of_measures() {
    let mut compared = 0;
    for seed in 0..120 {
        let mut made = make(&recipe(seed));
        if made.spec.drives[0].to == made.spec.drives[0].from {
            continue;
        }
        let last = made.spec.links.len() - 1;
        let link = made.spec.links[last].name.clone();
        let name = made.spec.links[last].points[0].0.clone();
        if made.idle.contains(&last) {
            continue;
        }
        for (measure, text) in [
            ("m_x", format!("x({name})")),
            ("m_a", format!("angle({link})")),
            ("m_dx", format!("d(x({name}), d0)")),
            ("m_da", format!("d(angle({link}), d0)")),
            ("m_ddx", format!("d(x({name}), d0, 2)")),
            ("m_dda", format!("d(angle({link}), d0, 2)")),
            ("m_rx", format!("rate(x({name}))")),
            ("m_ra", format!("rate(angle({link}))")),
            ("m_rra", format!("rate(angle({link}), 2)")),
        ] {
            made.spec.measures.push((measure.into(), text));
        }
        let case = Case::of(&made.spec);
        let Ok(motion) = case.motion() else { continue };
        let measures: Vec<&Measure> = case.model.measures.iter().map(|m| &m.measure).collect();
        let mut sampler = Sampler::new(&motion, &measures).unwrap();
        let (low, high) = motion.reached();
        let p = 0.5 * (low + high);
        let h = 2e-4 * (high - low);
        let row = sampler.at_parameter(p);
        let size = motion.size();
        if row.note.is_some() || row.smallest_singular_value < 0.03 || h == 0.0 {
            continue;
        }
        let near_event = motion
            .events
            .iter()
            .any(|e| (e.at - p).abs() < 0.1 * (high - low));
        if near_event {
            continue;
        }
        compared += 1;
        let sign = (made.spec.drives[0].to - made.spec.drives[0].from).signum();
        let speed = (made.spec.drives[0].to - made.spec.drives[0].from).abs()
            / made.spec.drives[0].time
            * sign;
        let sampler = std::cell::RefCell::new(sampler);
        let f = |p: f64| {
            let row = sampler.borrow_mut().at_parameter(p);
            vec![row.values[0] / size, row.values[1]]
        };
        let (first, second) = differences(&f, p, h);
        let v = &row.values;
        let h1 = high - low;
        let pairs = [
            (v[2] / size * h1, first[0] * h1),
            (v[3] * h1, first[1] * h1),
            (v[4] / size * h1 * h1, second[0] * h1 * h1),
            (v[5] * h1 * h1, second[1] * h1 * h1),
            (v[6] / size / speed * h1, first[0] * h1),
            (v[7] / speed * h1, first[1] * h1),
            (v[8] / speed / speed * h1 * h1, second[1] * h1 * h1),
        ];
        for (k, (got, wanted)) in pairs.iter().enumerate() {
            let order2 = matches!(k, 2 | 3 | 6);
            let allowed = if order2 { 1e-6 } else { 1e-9 } * (1.0 + wanted.abs());
            assert!(
                (got - wanted).abs() < allowed,
                "seed {seed} {k}: {got} {wanted}\n{}",
                case.text
            );
        }
    }
    assert!(compared > 40, "{compared}");
}
