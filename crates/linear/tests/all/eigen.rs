//! Eigenvalues against matrices that were made of known ones, and against the equations they solve.
#![allow(clippy::unwrap_used)]

use kempe_linear::{Qr, eigenvalues, generalised_eigen, symmetric_eigen};
use kempe_number::Random;

fn random(n: usize, rng: &mut Random) -> Vec<f64> {
    (0..n * n).map(|_| rng.uniform()).collect()
}

fn product(a: &[f64], b: &[f64], n: usize) -> Vec<f64> {
    let entry = |k: usize| (0..n).map(|j| a[k / n * n + j] * b[j * n + k % n]).sum();
    (0..n * n).map(entry).collect()
}

fn transposed(a: &[f64], n: usize) -> Vec<f64> {
    (0..n * n).map(|k| a[k % n * n + k / n]).collect()
}

fn inverse(a: &[f64], n: usize) -> Vec<f64> {
    let mut qr = Qr::with_capacity(n, n);
    qr.reset(n, n);
    (0..n * n).for_each(|k| qr.add(k / n, k % n, a[k]));
    qr.factor();
    let mut columns = vec![0.0; n * n];
    for j in 0..n {
        let mut rhs = vec![0.0; n];
        rhs[j] = 1.0;
        qr.solve(&mut rhs);
        (0..n).for_each(|i| columns[i * n + j] = rhs[i]);
    }
    columns
}

#[test]
fn symmetric_matrices_are_what_their_eigenvectors_say() {
    let mut rng = Random(7);
    for n in 1..9 {
        for _ in 0..20 {
            let a = random(n, &mut rng);
            let a: Vec<f64> = a
                .iter()
                .zip(transposed(&a, n))
                .map(|(x, y)| x + y)
                .collect();
            let pairs = symmetric_eigen(&a, n);
            assert!(pairs.windows(2).all(|w| w[0].value <= w[1].value));
            for i in 0..n {
                for j in 0..n {
                    let made: f64 =
                        (pairs.iter().map(|p| p.value * p.vector[i] * p.vector[j])).sum();
                    assert!((made - a[i * n + j]).abs() < 1e-13, "{made}");
                    let dot: f64 = (pairs[i].vector.iter().zip(&pairs[j].vector))
                        .map(|(x, y)| x * y)
                        .sum();
                    assert!((dot - f64::from(u8::from(i == j))).abs() < 1e-14);
                }
            }
        }
    }
}

#[test]
fn small_eigenvalues_of_positive_matrices_keep_their_digits() {
    // D H D with H near 1: Jacobi's method finds them to rounding of their own (Demmel and Veselic 1992).
    let (d, h) = ([1.0, 1e-5, 1e-10], 0.1);
    let a: Vec<f64> = (0..9)
        .map(|k| d[k / 3] * d[k % 3] * if k / 3 == k % 3 { 1.0 } else { h })
        .collect();
    let found = symmetric_eigen(&a, 3);
    // The determinant is that of H times the squares of D.
    let whole: f64 = found.iter().map(|p| p.value).product();
    let exact = (1.0 - 3.0 * h * h + 2.0 * h * h * h) * 1e-30;
    assert!((whole / exact - 1.0).abs() < 1e-12, "{whole}");
    assert!((found[0].value / (exact / 1e-10 / (1.0 - h * h)) - 1.0).abs() < 1e-8);
}

#[test]
fn mass_and_stiffness_have_common_vectors() {
    let mut rng = Random(3);
    for n in 1..8 {
        for _ in 0..20 {
            let k = random(n, &mut rng);
            let k: Vec<f64> = k
                .iter()
                .zip(transposed(&k, n))
                .map(|(x, y)| x + y)
                .collect();
            let half = random(n, &mut rng);
            let mut m = product(&half, &transposed(&half, n), n);
            (0..n).for_each(|i| m[i * n + i] += 0.1);
            let pairs = generalised_eigen(&k, &m, n).unwrap();
            for a in &pairs {
                for row in 0..n {
                    let times =
                        |m: &[f64]| -> f64 { (0..n).map(|j| m[row * n + j] * a.vector[j]).sum() };
                    assert!(
                        (times(&k) - a.value * times(&m)).abs() < 1e-11 * (1.0 + a.value.abs())
                    );
                }
                for b in &pairs {
                    let mass: f64 = (0..n * n)
                        .map(|e| a.vector[e / n] * m[e] * b.vector[e % n])
                        .sum();
                    let same = f64::from(u8::from(std::ptr::eq(a, b)));
                    assert!((mass - same).abs() < 1e-11);
                }
            }
        }
    }
    assert_eq!(generalised_eigen(&[1.0], &[0.0], 1), Err(0));
    assert_eq!(
        generalised_eigen(&[1.0, 0.0, 0.0, 1.0], &[1.0, 1.0, 1.0, 1.0], 2),
        Err(1)
    );
}

#[test]
fn eigenvalues_of_matrices_made_of_known_ones() {
    let mut rng = Random(11);
    for n in 1..13 {
        for _ in 0..20 {
            // Blocks of conjugate pairs, and real ones, on the diagonal.
            let mut wanted: Vec<[f64; 2]> = Vec::new();
            let mut blocks = vec![0.0; n * n];
            let mut i = 0;
            while i < n {
                let re = 4.0 * rng.uniform() - 2.0;
                if i + 1 < n && rng.uniform() < 0.6 {
                    let im = 0.1 + rng.uniform();
                    (blocks[i * n + i], blocks[(i + 1) * n + i + 1]) = (re, re);
                    (blocks[i * n + i + 1], blocks[(i + 1) * n + i]) = (im, -im);
                    wanted.extend([[re, im], [re, -im]]);
                    i += 2;
                } else {
                    blocks[i * n + i] = re;
                    wanted.push([re, 0.0]);
                    i += 1;
                }
            }
            let mut basis = random(n, &mut rng);
            (0..n).for_each(|i| basis[i * n + i] += 3.0);
            let a = product(&product(&basis, &blocks, n), &inverse(&basis, n), n);
            let mut found = eigenvalues(&a, n).unwrap();
            assert_eq!(found.len(), n);
            for want in wanted {
                let off = |x: &[f64; 2]| (x[0] - want[0]).abs() + (x[1] - want[1]).abs();
                let (at, least) = found
                    .iter()
                    .map(off)
                    .enumerate()
                    .min_by(|a, b| a.1.total_cmp(&b.1))
                    .unwrap();
                assert!(least < 1e-9, "n {n}: {want:?} off by {least}");
                found.swap_remove(at);
            }
        }
    }
}

#[test]
fn cyclic_matrices_settle_too() {
    // Whose eigenvalues all lie on one circle: the roots of x^n = 1.
    for n in 2..10 {
        let a: Vec<f64> = (0..n * n)
            .map(|k| if (k / n + 1) % n == k % n { 1.0 } else { 0.0 })
            .collect();
        let found = eigenvalues(&a, n).unwrap();
        assert!(
            found
                .iter()
                .all(|[x, y]| (x * x + y * y - 1.0).abs() < 1e-12),
            "{found:?}"
        );
    }
    assert_eq!(eigenvalues(&[f64::NAN], 1), None);
}
