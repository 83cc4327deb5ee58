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

/// Weights of the divided difference of all points, by that of a step in the middle.
const STEP: [f64; 8] = {
    let (mut weights, mut unit) = ([0.0; 8], 0.0);
    let mut i = 0;
    while i < 8 {
        let (mut product, mut j) = (1.0, 0);
        while j < 8 {
            if j != i {
                product *= GAUSS[i].0 - GAUSS[j].0;
            }
            j += 1;
        }
        weights[i] = 1.0 / product;
        unit += if i < 4 { 0.0 } else { weights[i] };
        i += 1;
    }
    i = 0;
    while i < 8 {
        weights[i] /= unit;
        i += 1;
    }
    weights
};

/// What is known to rounding agrees to this part.
pub(crate) const AGREED: f64 = 1e-14;
/// Halvings at most, and so many more for every stretch: a kink takes about a hundred.
const HALVINGS: (usize, usize) = (2000, 40);
/// Where halving everything that is open leaves more than this part of all differences, and does so again, they are rounding
/// of the functions: a jump, which is slowest, leaves a half.
const LEFT_BY_ROUNDING: f64 = 0.7;
/// How much of a jump is left hangs on where it lies in its part, so that its differences may stall, too. What differs by more than this part of its
/// share of the integral of the functions' sizes is no rounding, unless there are more such parts than functions have jumps.
const ROUGH: f64 = 1e-9;
const MOST_ROUGH: usize = 32;
/// What was halved so often and still differs may have a jump inside, which is looked for by single values.
const LOOKED_INTO: u8 = 5;
/// Its ends are looked at so far inside, as a part of it; and what is left of its change between two neighbouring places is a jump if it is more than
/// this part.
const BESIDE_ENDS: f64 = 1e-9;
const JUMPS: f64 = 1e-3;
/// A part this much narrower than the stretch that it came from is not halved further.
const NARROWEST: f64 = 1e-15;
/// A step nearer to the middle of a part, or to a seam, than all points of the rule changes the integrals by whole and by halves alike. Its height is told
/// by the points' [divided difference](STEP), and looked into where it is more than this part of the functions' mean size.
const STEPS: f64 = 1e-3;
/// The first and the last stretch are graded towards their ends in so many steps of this factor: a kink nearer to an end
/// than all points of the rule would not be seen.
const GRADING: (i32, f64) = (4, 0.125);

/// What the rule says of a part.
#[derive(Clone, Copy)]
struct Sum<const K: usize> {
    integral: [f64; K],
    /// Integral of the functions' sizes.
    size: [f64; K],
    /// By how much the functions step up in its middle: their divided difference over all points, of which smooth ones leave next to nothing.
    step: [f64; K],
}

/// A part of a stretch with its integral by halves.
#[derive(Clone)]
pub(crate) struct Part<const K: usize> {
    pub from: f64,
    pub to: f64,
    /// Width of the stretch that it came from.
    origin: f64,
    halves: [Sum<K>; 2],
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
        std::array::from_fn(|k| a.integral[k] + b.integral[k])
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

/// Below what functions count as rounding.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Floor<const K: usize> {
    /// The least integral of each function's size.
    pub size: f64,
    /// ... and of the first one's size, by so much: what is nothing but rounding would never agree, and keep what stands beside it from being closed in on.
    pub of_first: [f64; K],
    /// Integrals by the whole and by halves agree when they differ by no more than this part of the integral of the functions' sizes.
    pub agreed: [f64; K],
}

impl<const K: usize> Floor<K> {
    /// The same size for all functions.
    pub const fn of(size: f64) -> Self {
        Self {
            size,
            of_first: [0.0; K],
            agreed: [AGREED; K],
        }
    }
}

/// Integrates `K` functions over stretches in rising order, as [`parts`] does; `None` when `f` says so.
pub(crate) fn integrate<const K: usize>(
    stretches: &[[f64; 2]],
    floor: Floor<K>,
    f: &mut dyn FnMut(f64) -> Option<[f64; K]>,
) -> Option<[f64; K]> {
    let mut sum = [0.0; K];
    for half in parts(stretches, floor, f)?
        .iter()
        .flat_map(|part| part.halves)
    {
        let both = sum.iter_mut().zip(half.integral);
        both.for_each(|(all, h)| *all += h);
    }
    Some(sum)
}

/// The integral over one part, by the rule alone.
pub(crate) fn gauss<const K: usize>(
    from: f64,
    to: f64,
    f: &mut dyn FnMut(f64) -> Option<[f64; K]>,
) -> Option<[f64; K]> {
    sum(from, to, f).map(|sum| sum.integral)
}

/// What the rule says of one part.
fn sum<const K: usize>(
    from: f64,
    to: f64,
    f: &mut dyn FnMut(f64) -> Option<[f64; K]>,
) -> Option<Sum<K>> {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let mut sum = Sum {
        integral: [0.0; K],
        size: [0.0; K],
        step: [0.0; K],
    };
    for ((x, w), difference) in GAUSS.into_iter().zip(STEP) {
        let values = f(middle + half * x)?;
        for (k, value) in values.into_iter().enumerate() {
            sum.integral[k] += w * half * value;
            sum.size[k] += (w * half * value).abs();
            sum.step[k] += difference * value;
        }
    }
    Some(sum)
}

/// Parts of stretches in rising order on each of which the rule integrates `K` functions as well as they are known; `None`
/// when `f` says so.
///
/// Every stretch is integrated whole and by halves, and halved again until all agree, within parts and over the seams
/// between them, to the agreed part of the integral of the functions' sizes (or of the floor, where that is more). Kinks, jumps
/// and roots are closed in on that way.
pub(crate) fn parts<const K: usize>(
    stretches: &[[f64; 2]],
    floor: Floor<K>,
    f: &mut dyn FnMut(f64) -> Option<[f64; K]>,
) -> Option<Vec<Part<K>>> {
    let stretches = stretches.iter().filter(|[from, to]| to > from);
    let stretches: Vec<[f64; 2]> = stretches.copied().collect();
    let width: f64 = stretches.iter().map(|[from, to]| to - from).sum();
    let mut sizes = [floor.size; K];
    let mut sums: Vec<[Sum<K>; 3]> = Vec::with_capacity(stretches.len());
    for &[from, to] in &stretches {
        let middle = 0.5 * (from + to);
        let whole = sum(from, to, f)?;
        let halves = [sum(from, middle, f)?, sum(middle, to, f)?];
        for half in &halves {
            let both = sizes.iter_mut().zip(half.size);
            both.for_each(|(all, s)| *all += s);
        }
        sums.push([whole, halves[0], halves[1]]);
    }
    let first = sizes.first().copied().unwrap_or(0.0);
    for (size, part) in sizes.iter_mut().zip(floor.of_first) {
        *size = size.max(part * first);
    }
    // Whole and halves, and so much for a step that neither sees.
    let gap = |whole: &Sum<K>, [a, b]: [&Sum<K>; 2], [from, to]: [f64; 2], halved: u8| {
        std::array::from_fn(|k| {
            let differs = (whole.integral[k] - a.integral[k] - b.integral[k]).abs();
            let step = whole.step[k].abs();
            match halved <= LOOKED_INTO && step * width > STEPS * sizes[k] {
                true => differs + step * (to - from),
                false => differs,
            }
        })
    };
    let mut parts: Vec<Part<K>> = (stretches.iter().zip(&sums))
        .map(|(&[from, to], [whole, a, b])| Part {
            from,
            to,
            origin: to - from,
            gap: gap(whole, [a, b], [from, to], 0),
            halves: [*a, *b],
            seam: None,
            halved: 0,
        })
        .collect();
    // What has no value needs no closer look.
    let differ = |gap: &[f64; K]| {
        let mut gaps = gap.iter().zip(sizes).zip(floor.agreed);
        gaps.any(|((gap, size), agreed)| *gap > agreed * size)
    };
    let most = |gap: &[f64; K]| {
        let gaps = gap.iter().zip(sizes).map(|(gap, size)| gap / size);
        gaps.filter(|gap| gap.is_finite()).fold(0.0, f64::max)
    };
    let mut left = HALVINGS.0 + HALVINGS.1 * stretches.len();
    let (mut last, mut stalled, mut only_rough) = (f64::INFINITY, false, false);
    loop {
        for k in 1..parts.len() {
            let (a, b) = (&parts[k - 1], &parts[k]);
            if a.seam.is_none() && a.to == b.from {
                let ends = [a.middle(), b.middle()];
                let whole = sum(ends[0], ends[1], f)?;
                let halved = a.halved.max(b.halved);
                let seam = gap(&whole, [&a.halves[1], &b.halves[0]], ends, halved);
                parts[k - 1].seam = Some(seam);
            }
        }
        // Gaps of a part: its own, and at its seams.
        let gaps = |k: usize| {
            let before = k.checked_sub(1).and_then(|k| parts[k].seam.as_ref());
            [Some(&parts[k].gap), parts[k].seam.as_ref(), before]
                .into_iter()
                .flatten()
        };
        let rough: Vec<bool> = (parts.iter().enumerate())
            .map(|(k, part)| {
                let share = (part.to - part.from) / width;
                gaps(k).any(|gap| most(gap) > ROUGH * share)
            })
            .collect();
        let jumps = rough.iter().filter(|rough| **rough).count() <= MOST_ROUGH;
        let smooth: f64 = (parts.iter().zip(&rough))
            .filter(|(_, rough)| !(jumps && **rough))
            .flat_map(|(part, _)| [Some(part.gap), part.seam])
            .map(|gap| gap.map_or(0.0, |gap| most(&gap)))
            .sum();
        let stalls = smooth > LEFT_BY_ROUNDING * last;
        only_rough |= stalls && stalled;
        (last, stalled) = (smooth, stalls);
        let open: Vec<bool> = (parts.iter().enumerate())
            .map(|(k, part)| {
                gaps(k).any(differ)
                    && part.to - part.from > NARROWEST * part.origin
                    && (!only_rough || jumps && rough[k])
            })
            .collect();
        let halved = open.iter().filter(|open| **open).count();
        if halved == 0 || halved > left {
            break;
        }
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
                    Some(_) => sum(from, to, f)?,
                    None => known,
                };
                let middle = 0.5 * (from + to);
                let halves = [sum(from, middle, f)?, sum(middle, to, f)?];
                let halved = part.halved.saturating_add(1);
                finer.push(Part {
                    from,
                    to,
                    origin: part.origin,
                    gap: gap(&whole, [&halves[0], &halves[1]], [from, to], halved),
                    halves,
                    seam: None,
                    halved,
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
        integrate(&graded(10), Floor::of(0.0), &mut |x| Some([f(x)])).unwrap()[0]
    }

    #[test]
    fn jumps_and_roots_are_closed_in_on() {
        let jump = |x: f64| if x < 0.123 { 1.0 } else { -2.0 };
        assert!((over(&jump) - (0.123 - 2.0 * 0.877)).abs() < 1e-13);
        assert!((over(&|x| x.sqrt()) - 2.0 / 3.0).abs() < 1e-13);
        assert!((over(&|x| x * x * x) - 0.25).abs() < 1e-15);
        let stopped = integrate(&graded(3), Floor::of(0.0), &mut |_| None::<[f64; 1]>);
        assert_eq!(stopped, None);
    }

    /// A jump costs no more than some hundred values, and what is smooth beside it no digits.
    #[test]
    fn jumps_take_few_values() {
        for at in [0.123, 0.700_000_1, 1.0 / 3.0] {
            let mut asked = 0;
            let found = integrate(&graded(10), Floor::of(0.0), &mut |x: f64| {
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

    /// However the differences of a jump happen to fall from round to round, and where it lies beside a seam or the middle of a part.
    #[test]
    fn jumps_are_closed_in_on_wherever_they_are() {
        let sin = kempe_number::math::sin;
        let rising = |x: f64| (1.0 - kempe_number::math::cos(3.0 * x)) / 3.0;
        for k in 0..1000 {
            let at = (f64::from(k) * 0.618_033_988_749_895).fract();
            let second = (at * 7.3 + 0.21).fract();
            let found = over(&|x| {
                let first = if x < at { 1.0 } else { 2.0 };
                first * sin(3.0 * x) + if x < second { 0.3 } else { 0.0 }
            });
            let truth = 2.0 * rising(1.0) - rising(at) + 0.3 * second;
            assert!(
                (found - truth).abs() < 1e-11,
                "{at} {second}: {found} {truth}"
            );
        }
    }

    /// Beside a function that is rounding of the first everywhere, jumps are closed in on as without.
    #[test]
    fn what_is_rounding_is_known_as_that() {
        let floor = Floor {
            size: 0.0,
            of_first: [0.0, 0.0, 1e-3],
            agreed: [AGREED; 3],
        };
        for at in [0.123, 0.700_000_1, 1.0 / 3.0] {
            let found = integrate(&graded(10), floor, &mut |x: f64| {
                let noise = (1e4 * kempe_number::math::sin(1e6 * x)).fract();
                Some([x, if x < at { -1.0 } else { 1.0 }, 1e-20 * noise])
            });
            let [_, jumps, rounding] = found.unwrap();
            assert!((jumps - (1.0 - 2.0 * at)).abs() < 1e-13, "{jumps}");
            assert!(rounding.abs() < 1e-20);
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
