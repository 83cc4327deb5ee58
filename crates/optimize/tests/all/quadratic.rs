//! Quadratic programmes beside all their active sets, gone through one by one.

use kempe_linear::Lu;
use kempe_number::Random;
use kempe_optimize::{Minimum, NoMinimum, Quadratic, Row, minimise};

/// The value of a programme at variables, its levels as low as they may be.
fn value(q: &Quadratic, d: &[f64]) -> f64 {
    let n = d.len();
    let dot = |a: &[f64]| a.iter().zip(d).map(|(a, b)| a * b).sum::<f64>();
    let bent: f64 = (0..n)
        .map(|k| d[k] * dot(&q.hessian[k * n..(k + 1) * n]))
        .sum();
    let level = |k: usize| {
        let own = q.rows.iter().filter(|r| r.level == Some(k));
        own.map(|r| dot(&r.normal) - r.limit)
            .fold(f64::NEG_INFINITY, f64::max)
    };
    let levels: f64 = (q.weights.iter().enumerate())
        .map(|(k, w)| w * level(k))
        .sum();
    dot(&q.slope) + bent / 2.0 + levels
}

/// Whether variables keep the rows of no level.
fn kept(q: &Quadratic, d: &[f64]) -> bool {
    let left = |r: &Row| r.normal.iter().zip(d).map(|(a, b)| a * b).sum::<f64>() - r.limit;
    q.rows
        .iter()
        .filter(|r| r.level.is_none())
        .all(|r| left(r) <= 1e-9)
}

/// The least value over all active sets.
fn by_enumeration(q: &Quadratic) -> Option<f64> {
    let (n, levels, m) = (q.slope.len(), q.weights.len(), q.rows.len());
    let mut least: Option<f64> = None;
    for set in 0_u32..1 << m {
        let active: Vec<&Row> = (0..m)
            .filter(|k| set >> k & 1 == 1)
            .map(|k| &q.rows[k])
            .collect();
        let size = n + levels + active.len();
        let mut a = vec![0.0; size * size];
        let mut b = vec![0.0; size];
        for i in 0..n {
            for j in 0..n {
                a[i * size + j] = q.hessian[i * n + j];
            }
            b[i] = -q.slope[i];
        }
        for k in 0..levels {
            b[n + k] = -q.weights[k];
        }
        for (row, r) in active.iter().enumerate() {
            let place = n + levels + row;
            for j in 0..n {
                a[j * size + place] = r.normal[j];
                a[place * size + j] = r.normal[j];
            }
            if let Some(k) = r.level {
                a[(n + k) * size + place] = -1.0;
                a[place * size + n + k] = -1.0;
            }
            b[place] = r.limit;
        }
        let mut lu = Lu::new(size);
        if !lu.factor(|i, j| a[i * size + j]) {
            continue;
        }
        lu.solve(&mut b);
        let d = &b[..n];
        let multipliers = &b[n + levels..];
        if multipliers.iter().all(|u| *u >= -1e-9) && d.iter().all(|x| x.abs() < 1e6) && kept(q, d)
        {
            let value = value(q, d);
            // Levels are then what their rows tell, if these are the highest.
            least = Some(least.map_or(value, |l: f64| l.min(value)));
        }
    }
    least
}

fn random_programme(random: &mut Random) -> Quadratic {
    let n = 1 + random.below(4);
    let levels = random.below(3);
    let mut number = || {
        let x = 2.0 * random.uniform() - 1.0;
        // Now and then a coincidence.
        if x.abs() < 0.1 { 0.0 } else { x }
    };
    let half: Vec<f64> = (0..n * n).map(|_| number()).collect();
    let hessian = (0..n * n).map(|k| {
        let product: f64 = (0..n)
            .map(|j| half[k / n * n + j] * half[k % n * n + j])
            .sum();
        product + if k / n == k % n { 0.05 } else { 0.0 }
    });
    let hessian = hessian.collect();
    let slope = (0..n).map(|_| number()).collect();
    let mut rows = Vec::new();
    for k in 0..7 {
        let level = match k {
            0..=1 if levels > 0 => Some(0),
            2..=3 if levels > 1 => Some(1),
            4 if levels > 0 => Some(levels - 1),
            _ => None,
        };
        let normal = (0..n).map(|_| number()).collect();
        let limit = number() + if level.is_none() { 0.5 } else { 0.0 };
        rows.push(Row {
            normal,
            limit,
            level,
        });
    }
    // A row twice is degenerate.
    let twice = rows[6].clone();
    rows.push(twice);
    let weights = (0..levels).map(|k| 1.0 + 3.0 * k as f64).collect();
    Quadratic {
        hessian,
        slope,
        weights,
        rows,
    }
}

#[test]
fn minima_are_those_of_the_best_active_set() {
    let mut random = Random(11);
    let (mut found, mut infeasible) = (0, 0);
    for case in 0..600 {
        let q = random_programme(&mut random);
        match (minimise(&q), by_enumeration(&q)) {
            (Ok(minimum), Some(least)) => {
                found += 1;
                let own = value(&q, &minimum.step);
                assert!(kept(&q, &minimum.step), "{case}");
                assert!(
                    (own - least).abs() < 1e-8 * (1.0 + least.abs()),
                    "{case}: {own} {least}"
                );
                check_conditions(&q, &minimum);
            }
            (Err(NoMinimum::Infeasible), None) => infeasible += 1,
            (ours, theirs) => panic!("{case}: {ours:?} {theirs:?} {q:?}"),
        }
    }
    assert!(found > 400 && infeasible > 5, "{found} {infeasible}");
}

/// The Lagrangian's slope vanishes, and multipliers of levels sum to their weights.
fn check_conditions(q: &Quadratic, minimum: &Minimum) {
    let n = q.slope.len();
    for i in 0..n {
        let bent: f64 = (0..n).map(|j| q.hessian[i * n + j] * minimum.step[j]).sum();
        let rows = q.rows.iter().zip(&minimum.multipliers);
        let rows: f64 = rows.map(|(r, u)| u * r.normal[i]).sum();
        assert!((q.slope[i] + bent + rows).abs() < 1e-9);
    }
    for (k, weight) in q.weights.iter().enumerate() {
        let own = q
            .rows
            .iter()
            .zip(&minimum.multipliers)
            .filter(|(r, _)| r.level == Some(k));
        assert!((own.map(|(_, u)| u).sum::<f64>() - weight).abs() < 1e-9);
    }
    for (r, u) in q.rows.iter().zip(&minimum.multipliers) {
        let level = r.level.map_or(0.0, |k| minimum.levels[k]);
        let left = r
            .normal
            .iter()
            .zip(&minimum.step)
            .map(|(a, b)| a * b)
            .sum::<f64>()
            - level
            - r.limit;
        assert!(
            *u >= 0.0 && left < 1e-9 && (*u == 0.0 || left > -1e-9),
            "{u} {left}"
        );
    }
}

/// K. Schittkowski's example of a vertex with more rows than variables.
#[test]
fn a_vertex_of_too_many_rows_is_reached() {
    let row = |a: f64, b: f64, limit: f64| Row {
        normal: vec![a, b],
        limit,
        level: None,
    };
    let rows = vec![
        row(1.0, 0.0, 1.0),
        row(0.0, 1.0, 1.0),
        row(1.0, 1.0, 2.0),
        row(2.0, 1.0, 3.0),
        row(1.0, 2.0, 3.0),
    ];
    let q = Quadratic {
        hessian: vec![1.0, 0.0, 0.0, 1.0],
        slope: vec![-5.0, -5.0],
        weights: Vec::new(),
        rows,
    };
    let minimum = minimise(&q).expect("a minimum");
    assert!(
        minimum.step.iter().all(|x| (x - 1.0).abs() < 1e-12),
        "{minimum:?}"
    );
}

#[test]
fn no_minimum_is_told() {
    let row = |a: f64, limit: f64| Row {
        normal: vec![a],
        limit,
        level: None,
    };
    let q = |hessian: f64, rows: Vec<Row>, weights: Vec<f64>| Quadratic {
        hessian: vec![hessian],
        slope: vec![1.0],
        weights,
        rows,
    };
    let both = vec![row(1.0, -1.0), row(-1.0, -1.0)];
    assert_eq!(minimise(&q(1.0, both, vec![])), Err(NoMinimum::Infeasible));
    assert_eq!(
        minimise(&q(-1.0, vec![], vec![])),
        Err(NoMinimum::NotConvex)
    );
    assert_eq!(
        minimise(&q(1.0, vec![], vec![1.0])),
        Err(NoMinimum::NotConvex)
    );
}
