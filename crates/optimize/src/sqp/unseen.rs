//! Ways that a descent never took. Where its slope is nothing from the start in some direction, as at a design that is its own mirror image, the
//! descent cannot tell the least from the largest there: first-order conditions hold at both. Its curvature was never learnt in these
//! directions, so they are tried.

use super::vector::dot;

/// A direction that the descent moved along by less than this part of the box is not known.
const MOVED: f64 = 1e-6;
/// What is left of a direction when those that are known are taken away counts from this length on.
const NEW: f64 = 1e-3;
/// How far ways are tried, in parts of the box: far enough that a curvature shows.
const TRIED: f64 = 0.01;
/// Ways between two directions are tried where no more than so many are left: there are too many of them otherwise.
const PAIRED: usize = 4;

/// The span of the steps that were taken, as orthonormal directions in parts of the box.
#[derive(Clone, Debug, Default)]
pub(super) struct Seen(Vec<Vec<f64>>);

impl Seen {
    /// Learns a step.
    pub fn learn(&mut self, step: &[f64]) {
        self.add(step, MOVED);
    }

    /// Adds what is new of a direction, where that is longer than `least`.
    fn add(&mut self, direction: &[f64], least: f64) {
        if self.0.len() >= direction.len() {
            return;
        }
        let mut new = direction.to_vec();
        // Twice is enough for rounding (W. Kahan; L. Giraud et al., 2005).
        for known in self.0.iter().chain(&self.0) {
            let along = dot(known, &new);
            new.iter_mut().zip(known).for_each(|(x, k)| *x -= along * k);
        }
        let length = dot(&new, &new).sqrt();
        if !(length > least) {
            return;
        }
        new.iter_mut().for_each(|x| *x /= length);
        self.0.push(new);
    }

    /// Steps to try, that neither steps nor the directions that hold the design have a part in: along an orthonormal basis of what is left, each
    /// way, and where it is short between any two of it.
    pub fn ways(&self, held: &[Vec<f64>], n: usize) -> Vec<Vec<f64>> {
        let mut all = self.clone();
        for direction in held {
            let length = dot(direction, direction).sqrt();
            all.add(direction, NEW * length);
        }
        let known = all.0.len();
        for k in 0..n {
            let unit: Vec<f64> = (0..n).map(|j| f64::from(u8::from(j == k))).collect();
            all.add(&unit, NEW);
        }
        let left = &all.0[known..];
        let along = |parts: &[(&Vec<f64>, f64)]| -> Vec<f64> {
            let length = (parts.len() as f64).sqrt();
            (0..n)
                .map(|j| parts.iter().map(|(d, sign)| sign * d[j]).sum::<f64>() * TRIED / length)
                .collect()
        };
        let mut ways = Vec::new();
        for (k, one) in left.iter().enumerate() {
            ways.extend([1.0, -1.0].map(|sign| along(&[(one, sign)])));
            let others = match left.len() <= PAIRED {
                true => &left[k + 1..],
                false => &[],
            };
            for other in others {
                for (a, b) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                    ways.push(along(&[(one, a), (other, b)]));
                }
            }
        }
        ways
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_is_at_right_angles_to_what_is_known() {
        let mut seen = Seen::default();
        seen.learn(&[0.3, 0.3, 0.0, 0.0]);
        seen.learn(&[-0.1, -0.1, 1e-9, 0.0]);
        let held = vec![vec![0.0, 0.0, 0.0, -7.0]];
        let ways = seen.ways(&held, 4);
        // Two directions are left: two ways along each, four between them.
        assert_eq!(ways.len(), 8);
        for way in &ways {
            assert!((way[0] + way[1]).abs() < 1e-15 && way[3] == 0.0, "{way:?}");
            assert!((dot(way, way).sqrt() - TRIED).abs() < 1e-15);
        }
        seen.learn(&[0.0, 1.0, 0.0, 0.0]);
        seen.learn(&[0.0, 0.0, 1.0, 0.0]);
        assert_eq!(seen.ways(&held, 4).len(), 0);
    }
}
