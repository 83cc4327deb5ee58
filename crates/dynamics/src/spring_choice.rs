//! The spring for a wanted effort: stiffness and preload by linear least squares, each within its bounds.
//!
//! A spring's part in a drive's effort is linear in its stiffness and its preload: with length `L`, free length `L0` and
//! `L' = dL/dq`, the drive must give `(preload + stiffness (L - L0)) L'` more than without it.

/// What a spring would do at one place of the motion, and what is wanted there.
#[derive(Clone, Copy, Debug)]
pub struct EffortSample {
    /// What the drive gives without the spring, N m or N.
    pub without: f64,
    /// What it is to give.
    pub wanted: f64,
    /// What a stiffness of 1 N/m (or N m/rad) adds, without preload: `(L - L0) L'`.
    pub by_stiffness: f64,
    /// What a preload of 1 N (or N m) adds, without stiffness: `L'`.
    pub by_preload: f64,
}

/// A chosen spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChosenSpring {
    /// Stiffness, N/m or N m/rad.
    pub stiffness: f64,
    /// Tension at the free length, N or N m.
    pub preload: f64,
    /// Root of the mean square of what is left between given and wanted effort.
    pub left: f64,
    /// The same without the spring.
    pub without: f64,
}

/// Chooses stiffness and preload of a spring for the wanted efforts, in the sense of least squares. The least value on each side of every bound is compared, so the best within the bounds is found.
pub fn choose_spring(
    samples: &[EffortSample],
    stiffness: (f64, f64),
    preload: (f64, f64),
) -> ChosenSpring {
    let rows: Vec<[f64; 3]> = (samples.iter())
        .map(|s| [s.by_stiffness, s.by_preload, s.wanted - s.without])
        .collect();
    let sum = |f: &dyn Fn(&[f64; 3]) -> f64| rows.iter().map(f).sum::<f64>();
    let (a, b, c) = (
        sum(&|r| r[0] * r[0]),
        sum(&|r| r[0] * r[1]),
        sum(&|r| r[1] * r[1]),
    );
    let (u, v) = (sum(&|r| r[0] * r[2]), sum(&|r| r[1] * r[2]));
    let square = |k: f64, p: f64| sum(&|r| kempe_number::powi(k * r[0] + p * r[1] - r[2], 2));
    let best_preload = |k: f64| {
        let free = if c > 0.0 { (v - k * b) / c } else { 0.0 };
        free.max(preload.0).min(preload.1)
    };
    let best_stiffness = |p: f64| {
        let free = if a > 0.0 { (u - p * b) / a } else { 0.0 };
        free.max(stiffness.0).min(stiffness.1)
    };
    let mut candidates = Vec::with_capacity(5);
    let determinant = a * c - b * b;
    if determinant > 1e-14 * a * c {
        let (k, p) = ((u * c - v * b) / determinant, (v * a - u * b) / determinant);
        let inside = |x: f64, (low, high): (f64, f64)| low <= x && x <= high;
        if inside(k, stiffness) && inside(p, preload) {
            candidates.push((k, p));
        }
    }
    for k in [stiffness.0, stiffness.1] {
        if k.is_finite() {
            candidates.push((k, best_preload(k)));
        }
    }
    for p in [preload.0, preload.1] {
        if p.is_finite() {
            candidates.push((best_stiffness(p), p));
        }
    }
    let zero = 0.0_f64.max(stiffness.0).min(stiffness.1);
    let start = (zero, best_preload(zero));
    let (k, p) = (candidates.into_iter()).fold(start, |best, next| {
        if square(next.0, next.1) < square(best.0, best.1) {
            next
        } else {
            best
        }
    });
    let n = samples.len().max(1) as f64;
    ChosenSpring {
        stiffness: k,
        preload: p,
        left: (square(k, p) / n).sqrt(),
        without: (square(0.0, 0.0) / n).sqrt(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(k: f64, p: f64) -> Vec<EffortSample> {
        (0..20)
            .map(|i| {
                let length = 0.2 + 0.01 * f64::from(i);
                let slope = 0.1 + 0.003 * f64::from(i);
                EffortSample {
                    without: 5.0,
                    wanted: 5.0 + (p + k * (length - 0.15)) * slope,
                    by_stiffness: (length - 0.15) * slope,
                    by_preload: slope,
                }
            })
            .collect()
    }

    #[test]
    fn finds_the_spring_that_was_used() {
        let chosen = choose_spring(&samples(800.0, -12.0), (0.0, 1e6), (-1e3, 1e3));
        assert!((chosen.stiffness - 800.0).abs() < 1e-8, "{chosen:?}");
        assert!((chosen.preload + 12.0).abs() < 1e-8 && chosen.left < 1e-10);
    }

    #[test]
    fn keeps_to_its_bounds() {
        let list = samples(800.0, -12.0);
        let chosen = choose_spring(&list, (0.0, 1e6), (0.0, 1e3));
        assert_eq!(chosen.preload, 0.0);
        // No neighbour within the bounds is better.
        for k in [0.99, 1.01] {
            let other = choose_spring(
                &list,
                (chosen.stiffness * k, chosen.stiffness * k),
                (0.0, 0.0),
            );
            assert!(other.left > chosen.left);
        }
        assert!(chosen.left < chosen.without);
    }
}
