//! Integrals of functions that may have kinks: Gauss quadrature, refined where it matters most.

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

/// Integrals of a part by its whole and by its halves agree when they differ by no more than this part of the integral of
/// the functions' sizes.
const AGREED: f64 = 1e-14;
/// Halvings at most, and so many more for every stretch: a kink takes about a hundred.
const HALVINGS: (usize, usize) = (2000, 40);
/// Where halving everything that is open leaves more than this part of all differences, and does so again, they are rounding
/// of the functions: a jump, which is slowest, leaves a half.
const LEFT_BY_ROUNDING: f64 = 0.7;
/// What was halved so often and still differs may have a jump inside, which is looked for by single values.
const LOOKED_INTO: u8 = 5;
/// Its ends are looked at so far inside, as a part of it; and what is left of its change between two neighbouring places is a jump if it is more than
/// this part.
const BESIDE_ENDS: f64 = 1e-9;
const JUMPS: f64 = 1e-3;
/// A part this much narrower than the stretch that it came from is not halved further.
const NARROWEST: f64 = 1e-15;
/// The first and the last stretch are graded towards their ends in so many steps of this factor: a kink nearer to an end
/// than all points of the rule would not be seen.
const GRADING: (i32, f64) = (4, 0.125);

/// A part of a stretch with its integral by halves.
#[derive(Clone)]
pub(crate) struct Part<const K: usize> {
    pub from: f64,
    pub to: f64,
    /// Width of the stretch that it came from.
    origin: f64,
    halves: [[f64; K]; 2],
    /// By how much whole and halves differ.
    gap: [f64; K],
    /// By how much the sum of two neighbouring halves, its own upper and the next part's lower, differs from what is
    /// integrated over both at once: a kink beside the seam is seen there, and by neither part alone.
    seam: Option<[f64; K]>,
    /// How often it was halved since it began, or was parted at a jump.
    halved: u8,
}

impl<const K: usize> Part<K> {
    /// The integrals over it.
    pub fn integral(&self) -> [f64; K] {
        let [a, b] = &self.halves;
        std::array::from_fn(|k| a[k] + b[k])
    }

    fn middle(&self) -> f64 {
        0.5 * (self.from + self.to)
    }
}

/// Evenly many stretches from 0 to 1, the outer ones graded towards their ends.
pub(crate) fn graded(count: usize) -> Vec<[f64; 2]> {
    graded_with(count, &[])
}

/// The same, parted at some more places between.
pub(crate) fn graded_with(count: usize, more: &[f64]) -> Vec<[f64; 2]> {
    let width = 1.0 / count.max(1) as f64;
    let mut cuts: Vec<f64> = (0..=count.max(1)).map(|k| k as f64 * width).collect();
    cuts.extend(more.iter().filter(|x| 0.0 < **x && **x < 1.0));
    for step in 1..=GRADING.0 {
        let inward = width * kempe_number::powi(GRADING.1, step);
        cuts.extend([inward, 1.0 - inward]);
    }
    cuts.sort_by(f64::total_cmp);
    cuts.windows(2).map(|w| [w[0], w[1]]).collect()
}

/// Integrates `K` functions over stretches in rising order, as [`parts`] does; `None` when `f` says so.
pub(crate) fn integrate<const K: usize>(
    stretches: &[[f64; 2]],
    floor: f64,
    f: &mut dyn FnMut(f64) -> Option<[f64; K]>,
) -> Option<[f64; K]> {
    let mut sum = [0.0; K];
    for half in parts(stretches, floor, f)?
        .iter()
        .flat_map(|part| part.halves)
    {
        sum.iter_mut().zip(half).for_each(|(all, h)| *all += h);
    }
    Some(sum)
}

/// The integral over one part, by the rule alone.
pub(crate) fn gauss<const K: usize>(
    from: f64,
    to: f64,
    f: &mut dyn FnMut(f64) -> Option<[f64; K]>,
) -> Option<[f64; K]> {
    gauss_with_sizes(from, to, f).map(|[sum, _]| sum)
}

/// The integral over one part, and that of the functions' sizes.
fn gauss_with_sizes<const K: usize>(
    from: f64,
    to: f64,
    f: &mut dyn FnMut(f64) -> Option<[f64; K]>,
) -> Option<[[f64; K]; 2]> {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let (mut sum, mut size) = ([0.0; K], [0.0; K]);
    for (x, w) in GAUSS {
        let values = f(middle + half * x)?;
        for (k, value) in values.into_iter().enumerate() {
            sum[k] += w * half * value;
            size[k] += (w * half * value).abs();
        }
    }
    Some([sum, size])
}

/// Parts of stretches in rising order on each of which the rule integrates `K` functions as well as they are known; `None`
/// when `f` says so.
///
/// Every stretch is integrated whole and by halves, and halved again until all agree, within parts and over the seams
/// between them, to [`AGREED`] of the integral of the functions' sizes (or of `floor`, where that is more). Kinks, jumps
/// and roots are closed in on that way.
pub(crate) fn parts<const K: usize>(
    stretches: &[[f64; 2]],
    floor: f64,
    f: &mut dyn FnMut(f64) -> Option<[f64; K]>,
) -> Option<Vec<Part<K>>> {
    let mut sizes = [floor; K];
    let gap = |whole: [f64; K], [a, b]: [[f64; K]; 2]| {
        std::array::from_fn(|k| (whole[k] - a[k] - b[k]).abs())
    };
    let mut parts: Vec<Part<K>> = Vec::with_capacity(stretches.len());
    for &[from, to] in stretches.iter().filter(|[from, to]| to > from) {
        let middle = 0.5 * (from + to);
        let whole = gauss(from, to, f)?;
        let mut half = |from: f64, to: f64| {
            let [sum, size] = gauss_with_sizes(from, to, f)?;
            sizes.iter_mut().zip(size).for_each(|(all, s)| *all += s);
            Some(sum)
        };
        let halves = [half(from, middle)?, half(middle, to)?];
        parts.push(Part {
            from,
            to,
            origin: to - from,
            gap: gap(whole, halves),
            halves,
            seam: None,
            halved: 0,
        });
    }
    // What has no value needs no closer look.
    let differ = |gap: &[f64; K]| {
        let mut gaps = gap.iter().zip(sizes);
        gaps.any(|(gap, size)| *gap > AGREED * size)
    };
    let mut left = HALVINGS.0 + HALVINGS.1 * stretches.len();
    let (mut last, mut stalled) = (f64::INFINITY, false);
    loop {
        for k in 1..parts.len() {
            let (a, b) = (&parts[k - 1], &parts[k]);
            if a.seam.is_none() && a.to == b.from {
                let whole = gauss(a.middle(), b.middle(), f)?;
                let seam = gap(whole, [a.halves[1], b.halves[0]]);
                parts[k - 1].seam = Some(seam);
            }
        }
        let open: Vec<bool> = (0..parts.len())
            .map(|k| {
                let part = &parts[k];
                let before = k.checked_sub(1).and_then(|k| parts[k].seam.as_ref());
                let seams = part.seam.as_ref().into_iter().chain(before);
                (differ(&part.gap) || seams.into_iter().any(differ))
                    && part.to - part.from > NARROWEST * part.origin
            })
            .collect();
        let halved = open.iter().filter(|open| **open).count();
        if halved == 0 || halved > left {
            break;
        }
        let most = |gap: &[f64; K]| {
            let gaps = gap.iter().zip(sizes).map(|(gap, size)| gap / size);
            gaps.filter(|gap| gap.is_finite()).fold(0.0, f64::max)
        };
        let gaps = (parts.iter()).flat_map(|part| [Some(part.gap), part.seam]);
        let all: f64 = gaps.flatten().map(|gap| most(&gap)).sum();
        let stalls = all > LEFT_BY_ROUNDING * last;
        if stalls && stalled {
            break;
        }
        (last, stalled) = (all, stalls);
        left -= halved;
        let mut finer: Vec<Part<K>> = Vec::with_capacity(parts.len() + halved);
        for (part, open) in parts.into_iter().zip(open) {
            if !open {
                finer.push(part);
                continue;
            }
            if let Some(before) = finer.last_mut() {
                before.seam = None;
            }
            let jump = match part.halved == LOOKED_INTO {
                true => jump(&part, &sizes, f)?,
                false => None,
            };
            let middle = part.middle();
            let ends = match jump {
                Some([before, behind]) => [[part.from, before], [behind, part.to]],
                None => [[part.from, middle], [middle, part.to]],
            };
            for ([from, to], known) in ends.into_iter().zip(part.halves) {
                let whole = match jump {
                    Some(_) => gauss(from, to, f)?,
                    None => known,
                };
                let middle = 0.5 * (from + to);
                let halves = [gauss(from, middle, f)?, gauss(middle, to, f)?];
                finer.push(Part {
                    from,
                    to,
                    origin: part.origin,
                    gap: gap(whole, halves),
                    halves,
                    seam: None,
                    halved: part.halved.saturating_add(1),
                });
            }
        }
        parts = finer;
    }
    Some(parts)
}

/// Where functions jump inside a part, by bisection to neighbouring places before and behind; none where they do not, as at a kink. `None` when
/// `f` says so.
fn jump<const K: usize>(
    part: &Part<K>,
    sizes: &[f64; K],
    f: &mut dyn FnMut(f64) -> Option<[f64; K]>,
) -> Option<Option<[f64; 2]>> {
    let inside = BESIDE_ENDS * (part.to - part.from);
    let (mut low, mut high) = (part.from + inside, part.to - inside);
    let (mut before, mut behind) = (f(low)?, f(high)?);
    // The function that changes the most tells.
    let change = |k: usize| ((behind[k] - before[k]) / sizes[k]).abs();
    let tells = (0..K).filter(|k| change(*k).is_finite());
    let Some(k) = tells.max_by(|a, b| change(*a).total_cmp(&change(*b))) else {
        return Some(None);
    };
    let all = (behind[k] - before[k]).abs();
    while high - low > NARROWEST * part.origin {
        let middle = 0.5 * (low + high);
        if !(low < middle && middle < high) {
            break;
        }
        let there = f(middle)?;
        match (there[k] - before[k]).abs() <= (there[k] - behind[k]).abs() {
            true => (low, before) = (middle, there),
            false => (high, behind) = (middle, there),
        }
    }
    let jumps = (behind[k] - before[k]).abs() > JUMPS * all;
    Some(jumps.then_some([low, high]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn over(f: &dyn Fn(f64) -> f64) -> f64 {
        integrate(&graded(10), 0.0, &mut |x| Some([f(x)])).unwrap()[0]
    }

    #[test]
    fn jumps_and_roots_are_closed_in_on() {
        let jump = |x: f64| if x < 0.123 { 1.0 } else { -2.0 };
        assert!((over(&jump) - (0.123 - 2.0 * 0.877)).abs() < 1e-13);
        assert!((over(&|x| x.sqrt()) - 2.0 / 3.0).abs() < 1e-13);
        assert!((over(&|x| x * x * x) - 0.25).abs() < 1e-15);
        let stopped = integrate(&graded(3), 0.0, &mut |_| None::<[f64; 1]>);
        assert_eq!(stopped, None);
    }

    /// A jump costs no more than some hundred values, and what is smooth beside it no digits.
    #[test]
    fn jumps_take_few_values() {
        for at in [0.123, 0.700_000_1, 1.0 / 3.0] {
            let mut asked = 0;
            let found = integrate(&graded(10), 0.0, &mut |x: f64| {
                asked += 1;
                let more = if x < at { 0.0 } else { x * x };
                Some([kempe_number::math::sin(x), more])
            });
            let [smooth, jumps] = found.unwrap();
            assert!((smooth - 1.0 + kempe_number::math::cos(1.0)).abs() < 1e-14);
            assert!((jumps - (1.0 - at * at * at) / 3.0).abs() < 1e-14, "{at}");
            assert!(asked < 1500, "{asked}");
        }
    }

    /// Wherever it is, beside seams and ends too.
    #[test]
    fn kinks_are_closed_in_on() {
        let beside = [0.5, 0.3, 1.0].map(|seam| [1e-3, 1e-5, 1e-8].map(|d| seam - d));
        let even = (0..400).map(|k| (f64::from(k) * 0.618_033_988_749_895).fract());
        for kink in even.chain(beside.into_iter().flatten()) {
            let found = over(&|x| (x - kink).abs());
            let truth = 0.5 * (kink * kink + (1.0 - kink) * (1.0 - kink));
            assert!((found - truth).abs() < 3e-14, "{kink}: {found} {truth}");
        }
    }
}
