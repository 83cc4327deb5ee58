//! Integrals of functions that may have kinks: Gauss quadrature, refined where it matters most.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Gauss-Legendre points and weights on [-1, 1] (8 points).
const GAUSS: [(f64, f64); 8] = [
    (-0.960_289_856_497_536_2, 0.101_228_536_290_376_26),
    (-0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (-0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (-0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_2, 0.101_228_536_290_376_26),
];

/// A part is halved as long as its halves differ from its whole by more than this part of the whole integral of sizes.
const AGREED: f64 = 1e-14;
/// Halvings at most: a jump, whose error only halves each time, takes about fifty.
const HALVINGS: usize = 2000;
/// A part this much narrower than where it came from is not halved further.
const NARROWEST: f64 = 1e-15;

/// A stretch with its integral by halves.
struct Part<const K: usize> {
    from: f64,
    to: f64,
    /// Width of the stretch that it came from.
    origin: f64,
    halves: [[f64; K]; 2],
    /// Difference of whole and halves, in parts of the whole integral of sizes.
    error: f64,
}

impl<const K: usize> Ord for Part<K> {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_error = self.error.total_cmp(&other.error);
        by_error.then(other.from.total_cmp(&self.from))
    }
}
impl<const K: usize> PartialOrd for Part<K> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl<const K: usize> PartialEq for Part<K> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}
impl<const K: usize> Eq for Part<K> {}

/// Integrals of `K` functions over stretches that lie side by side; `None` when `f` says so.
///
/// Every stretch is integrated whole and by halves; the worst is halved until all agree to about [`AGREED`] of the
/// integral of the functions' sizes (or of `floor`, where that is more). Kinks, jumps and roots are closed in on that way.
pub(crate) fn integrate<const K: usize>(
    stretches: &[[f64; 2]],
    floor: f64,
    f: &mut dyn FnMut(f64) -> Option<[f64; K]>,
) -> Option<[f64; K]> {
    let mut sizes = [floor; K];
    let mut gauss = |from: f64, to: f64, sizes: Option<&mut [f64; K]>| {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let mut sum = [0.0; K];
        let mut size = [0.0; K];
        for (x, w) in GAUSS {
            let values = f(middle + half * x)?;
            for (k, value) in values.into_iter().enumerate() {
                sum[k] += w * half * value;
                size[k] += (w * half * value).abs();
            }
        }
        if let Some(sizes) = sizes {
            sizes.iter_mut().zip(size).for_each(|(all, s)| *all += s);
        }
        Some(sum)
    };
    let mut parts: Vec<(Part<K>, [f64; K])> = Vec::with_capacity(stretches.len());
    for &[from, to] in stretches.iter().filter(|[from, to]| to > from) {
        let middle = 0.5 * (from + to);
        let whole = gauss(from, to, None)?;
        let halves = [
            gauss(from, middle, Some(&mut sizes))?,
            gauss(middle, to, Some(&mut sizes))?,
        ];
        let (origin, error) = (to - from, 0.0);
        parts.push((
            Part {
                from,
                to,
                origin,
                halves,
                error,
            },
            whole,
        ));
    }
    let error = |whole: &[f64; K], halves: &[[f64; K]; 2]| {
        let gaps = (0..K).map(|k| match (whole[k] - halves[0][k] - halves[1][k]).abs() {
            0.0 => 0.0,
            gap => gap / sizes[k],
        });
        // What has no value needs no closer look.
        gaps.filter(|gap| gap.is_finite()).fold(0.0, f64::max)
    };
    let mut heap: BinaryHeap<Part<K>> = (parts.into_iter())
        .map(|(part, whole)| Part {
            error: error(&whole, &part.halves),
            ..part
        })
        .collect();
    let mut done: Vec<Part<K>> = Vec::new();
    for _ in 0..HALVINGS {
        let Some(worst) = heap.pop() else {
            break;
        };
        if worst.error <= AGREED {
            heap.push(worst);
            break;
        }
        if worst.to - worst.from <= NARROWEST * worst.origin {
            done.push(worst);
            continue;
        }
        let middle = 0.5 * (worst.from + worst.to);
        let ends = [[worst.from, middle], [middle, worst.to]];
        for ([from, to], whole) in ends.into_iter().zip(worst.halves) {
            let middle = 0.5 * (from + to);
            let halves = [gauss(from, middle, None)?, gauss(middle, to, None)?];
            heap.push(Part {
                from,
                to,
                origin: worst.origin,
                error: error(&whole, &halves),
                halves,
            });
        }
    }
    done.extend(heap);
    done.sort_by(|a, b| a.from.total_cmp(&b.from));
    let mut sum = [0.0; K];
    for half in done.iter().flat_map(|part| part.halves) {
        sum.iter_mut().zip(half).for_each(|(all, h)| *all += h);
    }
    Some(sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinks_jumps_and_roots_are_closed_in_on() {
        let over = |f: &dyn Fn(f64) -> f64| {
            integrate(&[[0.0, 1.0], [1.0, 3.0]], 0.0, &mut |x| Some([f(x)])).unwrap()[0]
        };
        let third = 1.0 / 3.0;
        let cases: [(&dyn Fn(f64) -> f64, f64); 4] = [
            (
                &|x: f64| (x - third).abs(),
                third * third / 2.0 + 32.0 / 9.0,
            ),
            (&|x: f64| if x < 0.7 { 1.0 } else { -2.0 }, 0.7 - 4.6),
            (&|x: f64| x.sqrt(), 2.0 * 3.0_f64.sqrt()),
            (&|x: f64| x * x * x, 20.25),
        ];
        for (index, (f, truth)) in cases.into_iter().enumerate() {
            let found = over(f);
            assert!((found - truth).abs() < 1e-13, "{index}: {found} {truth}");
        }
        assert_eq!(
            integrate(&[[0.0, 1.0]], 0.0, &mut |_| None::<[f64; 1]>),
            None
        );
    }
}
