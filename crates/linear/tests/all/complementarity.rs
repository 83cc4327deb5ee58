//! Complementarity problems against their own conditions, and against all choices of what is zero.
#![allow(clippy::unwrap_used)]

use kempe_linear::{Lu, complementary};
use kempe_number::Random;

/// How far unknowns are off the conditions: signs, and products of pairs.
fn off(matrix: &[Vec<f64>], q: &[f64], z: &[f64]) -> f64 {
    (0..q.len()).fold(0.0, |most: f64, i| {
        let w = q[i] + matrix[i].iter().zip(z).map(|(m, z)| m * z).sum::<f64>();
        most.max(-w).max(-z[i]).max(w.min(z[i]).abs())
    })
}

/// All solutions, by trying every choice of what is not zero.
fn all_choices(matrix: &[Vec<f64>], q: &[f64]) -> Vec<Vec<f64>> {
    let n = q.len();
    let choices = (0..1_usize << n).filter_map(|choice| {
        let acts: Vec<usize> = (0..n).filter(|k| choice >> k & 1 == 1).collect();
        let mut factors = Lu::new(acts.len());
        if !factors.factor(|i, j| matrix[acts[i]][acts[j]]) {
            return None;
        }
        let mut found: Vec<f64> = acts.iter().map(|k| -q[*k]).collect();
        factors.solve(&mut found);
        let mut z = vec![0.0; n];
        acts.iter().zip(found).for_each(|(k, x)| z[*k] = x);
        (off(matrix, q, &z) < 1e-9).then_some(z)
    });
    choices.collect()
}

fn random(n: usize, m: usize, rng: &mut Random) -> Vec<Vec<f64>> {
    let number = |rng: &mut Random| 2.0 * rng.uniform() - 1.0;
    (0..n)
        .map(|_| (0..m).map(|_| number(rng)).collect())
        .collect()
}

/// Positive, and not symmetric: there is one solution.
#[test]
fn the_one_solution_is_found() {
    let mut rng = Random(11);
    for n in 1..8 {
        for _ in 0..100 {
            let (a, b) = (random(n, n, &mut rng), random(n, n, &mut rng));
            let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
            let entry = |i: usize, j: usize| dot(&a[i], &a[j]) + b[i][j] - b[j][i];
            let matrix: Vec<Vec<f64>> = (0..n)
                .map(|i| (0..n).map(|j| entry(i, j)).collect())
                .collect();
            let q = random(1, n, &mut rng).remove(0);
            let z = complementary(|i, j| matrix[i][j], &q).unwrap();
            assert!(off(&matrix, &q, &z) < 1e-9, "{q:?} {z:?}");
            let known = all_choices(&matrix, &q);
            assert!(known.iter().all(|known| {
                let apart = known.iter().zip(&z).map(|(a, b)| (a - b).abs());
                apart.fold(0.0, f64::max) < 1e-7 * (1.0 + known.iter().sum::<f64>())
            }));
        }
    }
}

/// Rows that repeat each other, all with ties: what two say is shared in some way, and nothing goes round in circles.
#[test]
fn rows_that_repeat_each_other_tie() {
    for n in 1..12 {
        let z = complementary(|_, _| 1.0, &vec![-1.0; n]).unwrap();
        assert!((z.iter().sum::<f64>() - 1.0).abs() < 1e-14, "{z:?}");
    }
}

#[test]
fn what_has_no_solution_is_told() {
    // A push that presses together what it should part.
    assert_eq!(complementary(|_, _| -1.0, &[-1.0]), None);
    assert_eq!(complementary(|_, _| -1.0, &[1.0]), Some(vec![0.0]));
    assert_eq!(complementary(|_, _| 1.0, &[f64::NAN]), None);
}
