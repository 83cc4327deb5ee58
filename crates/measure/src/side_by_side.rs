//! What is made of numbers of many designs side by side, on the best vector instructions that the processor has.

use kempe_number::{InstructionSet, Lanes, Number, multiversion};

/// Designs that stand side by side.
pub const TOGETHER: usize = 64;

/// A number of all of them.
pub type Many = Lanes<TOGETHER>;

/// The tangent of an angle from that of the file's own design below which a short series is exact.
const NEAR: f64 = 0.125;
/// Designs that fit into registers.
const ABREAST: usize = 8;

/// The least and the greatest of what runs along a motion, by design.
#[derive(Clone, Debug)]
pub struct Ends {
    /// The least.
    pub low: Many,
    /// The first place where it is.
    pub low_at: [usize; TOGETHER],
    /// The greatest.
    pub high: Many,
    /// The first place where it is.
    pub high_at: [usize; TOGETHER],
    /// Zero for designs of which it is a finite number all along.
    pub finite: Many,
}

/// The angle of a direction, not of unit length, to within half a turn of another (that angle, its sine and its cosine): near it by a
/// series, which is quicker by far for many.
pub fn angle(c: &Many, s: &Many, from: [f64; 3]) -> Many {
    let mut found = Many::zero();
    match angles_near(InstructionSet::detect(), c, s, from, &mut found) {
        true => found,
        false => {
            let [near, sin, cos] = from;
            let (y, x) = (*s * cos - *c * sin, *c * cos + *s * sin);
            y.atan2(x) + near
        }
    }
}

multiversion! {
    fn angles_near(set: InstructionSet, c: &Many, s: &Many, from: [f64; 3], found: &mut Many) -> bool = by_series;
}

/// Whether all are near, and then the angles.
#[cfg_attr(not(debug_assertions), inline(always))]
fn by_series(c: &Many, s: &Many, [near, sin, cos]: [f64; 3], found: &mut Many) -> bool {
    let mut is_near = true;
    for first in (0..TOGETHER).step_by(ABREAST) {
        let [c, s] = [c, s].map(|it| Lanes::<ABREAST>::from_fn(|k| it.0[first + k]));
        let (y, x) = (s * cos - c * sin, c * cos + s * sin);
        for k in 0..ABREAST {
            // What is no number comes out as none either way.
            is_near &= !(y.0[k].abs() > NEAR * x.0[k]);
        }
        let t = y / x;
        let square = t * t;
        // t - t^3 / 3 + t^5 / 5 ...: the first term left out is below 1e-17 of the angle.
        let mut sum = Lanes::from_f64(1.0 / 17.0);
        for k in (0..8).rev() {
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
            sum = sum * square + sign / f64::from(2 * k + 1);
        }
        found.0[first..first + ABREAST].copy_from_slice(&(t * sum + near).0);
    }
    is_near
}

multiversion! {
    /// The least and the greatest of what runs along a motion.
    pub fn ends(set: InstructionSet, values: &[Many]) -> Ends = ends_in_lanes;
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn ends_in_lanes(values: &[Many]) -> Ends {
    let mut all = Ends {
        low: Many::zero(),
        low_at: [0; TOGETHER],
        high: Many::zero(),
        high_at: [0; TOGETHER],
        finite: Many::zero(),
    };
    for first in (0..TOGETHER).step_by(ABREAST) {
        let mut low = [f64::INFINITY; ABREAST];
        let mut high = [f64::NEG_INFINITY; ABREAST];
        let (mut low_at, mut high_at, mut finite) =
            ([0.0; ABREAST], [0.0; ABREAST], [0.0; ABREAST]);
        for (place, value) in values.iter().enumerate() {
            // As a number of the same width as the values.
            let place = place as f64;
            for k in 0..ABREAST {
                let x = value.0[first + k];
                finite[k] += x * 0.0;
                let (lower, higher) = (x < low[k], x > high[k]);
                low[k] = if lower { x } else { low[k] };
                low_at[k] = if lower { place } else { low_at[k] };
                high[k] = if higher { x } else { high[k] };
                high_at[k] = if higher { place } else { high_at[k] };
            }
        }
        for k in 0..ABREAST {
            let lane = first + k;
            (all.low.0[lane], all.high.0[lane]) = (low[k], high[k]);
            (all.low_at[lane], all.high_at[lane]) = (low_at[k] as usize, high_at[k] as usize);
            all.finite.0[lane] = finite[k];
        }
    }
    all
}

multiversion! {
    /// Whether something else than the least, and than the greatest, may lie as low, or as high, between places: where values stand lower, or higher, than both
    /// their neighbours, by no more than a parabola through the three goes beyond them.
    pub fn rivals(set: InstructionSet, values: &[Many], ends: &Ends) -> [[bool; TOGETHER]; 2] = rivals_in_lanes;
}

/// Whether a value that is no less than both its neighbours may be passed by this much between them: twice what the parabola through the three does, as
/// steps may be uneven.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn rises(before: f64, value: f64, after: f64) -> f64 {
    0.25 * (2.0 * value - before - after)
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn rivals_in_lanes(values: &[Many], ends: &Ends) -> [[bool; TOGETHER]; 2] {
    let mut all = [[false; TOGETHER]; 2];
    for first in (0..TOGETHER).step_by(ABREAST) {
        let mut found = [[0.0; ABREAST]; 2];
        // Turned into numbers once, outside the loop over all places.
        let at = [&ends.low_at, &ends.high_at]
            .map(|at| std::array::from_fn::<f64, ABREAST, _>(|k| at[first + k] as f64));
        for place in 1..values.len().saturating_sub(1) {
            let here = place as f64;
            let [x, y, z] =
                [place - 1, place, place + 1].map(|place| &values[place].0[first..first + ABREAST]);
            for k in 0..ABREAST {
                let beyond = y[k] + rises(x[k], y[k], z[k]);
                // Beside the end itself it is the same extreme.
                let beside = |at: f64| (here - at).abs() <= 1.0;
                let valley = (y[k] <= x[k]) & (y[k] <= z[k]) & (beyond < ends.low.0[first + k]);
                let peak = (y[k] >= x[k]) & (y[k] >= z[k]) & (beyond > ends.high.0[first + k]);
                let valley = valley & !beside(at[0][k]);
                let peak = peak & !beside(at[1][k]);
                found[0][k] = if valley { 1.0 } else { found[0][k] };
                found[1][k] = if peak { 1.0 } else { found[1][k] };
            }
        }
        for (all, found) in all.iter_mut().zip(found) {
            for (k, found) in found.into_iter().enumerate() {
                all[first + k] = found > 0.0;
            }
        }
    }
    all
}

multiversion! {
    /// Widens the range from the least to the greatest of some values by those of designs; what is no number does not count.
    pub fn widen(set: InstructionSet, range: [f64; 2], values: &[f64; TOGETHER]) -> [f64; 2] = widen_in_lanes;
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn widen_in_lanes(range: [f64; 2], values: &[f64; TOGETHER]) -> [f64; 2] {
    let (mut low, mut high) = ([range[0]; ABREAST], [range[1]; ABREAST]);
    for eight in values.chunks_exact(ABREAST) {
        for k in 0..ABREAST {
            low[k] = if eight[k] < low[k] { eight[k] } else { low[k] };
            high[k] = if eight[k] > high[k] {
                eight[k]
            } else {
                high[k]
            };
        }
    }
    low.iter()
        .zip(&high)
        .fold(range, |[a, b], (low, high)| [a.min(*low), b.max(*high)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use kempe_number::{Random, math};

    const SETS: [InstructionSet; 3] = [
        InstructionSet::Baseline,
        InstructionSet::Avx2,
        InstructionSet::Avx512,
    ];

    /// Numbers between -1 and 1.
    fn drawn(random: &mut Random) -> Many {
        Many::from_fn(|_| 2.0 * random.uniform() - 1.0)
    }

    #[test]
    fn angles_are_those_of_the_arc_tangent_near_and_far() {
        let mut random = Random(7);
        for reach in [0.1, 0.124, 0.126, 3.0] {
            let near = 40.0 * random.uniform() - 20.0;
            let (sin, cos) = math::sin_cos(near);
            let length = drawn(&mut random) * 0.5 + 1.0;
            let own = drawn(&mut random) * reach + near;
            let (s, c) = own.sin_cos();
            let (c, s, from) = (c * length, s * length, [near, sin, cos]);
            let found = angle(&c, &s, from);
            for k in 0..TOGETHER {
                assert!((found.0[k] - own.0[k]).abs() < 2e-14, "{reach}: {k}");
            }
            let by = |set| {
                let mut found = Many::zero();
                (angles_near(set, &c, &s, from, &mut found), found)
            };
            assert!(
                SETS.into_iter()
                    .all(|set| by(set) == by(InstructionSet::Baseline))
            );
            let all_near = own
                .0
                .iter()
                .all(|x| (x - near).abs() <= math::atan2(NEAR, 1.0));
            assert_eq!(by(InstructionSet::Baseline).0, all_near);
        }
    }

    #[test]
    fn ends_are_the_first_of_all_and_what_is_no_number_is_told() {
        let mut random = Random(3);
        let mut values: Vec<Many> = (0..50).map(|_| drawn(&mut random)).collect();
        values[20].0[5] = f64::NAN;
        values[30].0[6] = f64::INFINITY;
        values[10].0[7] = -2.0;
        values[40].0[7] = -2.0;
        let found = ends(InstructionSet::detect(), &values);
        for k in 0..TOGETHER {
            let own: Vec<f64> = values.iter().map(|value| value.0[k]).collect();
            let low = own.iter().copied().fold(f64::INFINITY, f64::min);
            let high = own.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            assert_eq!((found.low.0[k], found.high.0[k]), (low, high));
            assert_eq!(own.iter().position(|x| *x == low), Some(found.low_at[k]));
            assert_eq!(own.iter().position(|x| *x == high), Some(found.high_at[k]));
            assert_eq!(found.finite.0[k] == 0.0, k != 5 && k != 6);
        }
        for set in SETS {
            let other = ends(set, &values);
            assert_eq!((other.low, other.low_at), (found.low, found.low_at));
            assert_eq!((other.high, other.high_at), (found.high, found.high_at));
        }
    }

    #[test]
    fn what_may_go_as_far_between_places_is_told() {
        // A wave of many tops: between places each comes near one. In every other lane it rises all along.
        let value = |place: usize, lane: usize| {
            let phase = lane as f64 * 0.1;
            let rise = 0.01 * (lane % 2 * place) as f64;
            rise + math::sin(place as f64 * 0.37 + phase)
                + 1e-3 * math::cos(place as f64 * 0.037 * phase)
        };
        let values: Vec<Many> = (0..200)
            .map(|place| Many::from_fn(|lane| value(place, lane)))
            .collect();
        let ends = ends(InstructionSet::detect(), &values);
        let found = rivals(InstructionSet::detect(), &values, &ends);
        let mut some = [0, 0];
        for lane in 0..TOGETHER {
            let own: Vec<f64> = (0..200).map(|place| value(place, lane)).collect();
            for (side, sign) in [-1.0, 1.0].into_iter().enumerate() {
                let (most, at) = match side {
                    0 => (-ends.low.0[lane], ends.low_at[lane]),
                    _ => (ends.high.0[lane], ends.high_at[lane]),
                };
                let wanted = own.windows(3).enumerate().any(|(k, three)| {
                    let [x, y, z] = [three[0], three[1], three[2]].map(|x| sign * x);
                    y >= x && y >= z && y + rises(x, y, z) > most && (k + 1).abs_diff(at) > 1
                });
                assert_eq!(found[side][lane], wanted, "{side} {lane}");
                some[usize::from(wanted)] += 1;
            }
        }
        assert!(some.iter().all(|some| *some > 10), "{some:?}");
        for set in SETS {
            assert_eq!(rivals(set, &values, &ends), found);
        }
    }

    #[test]
    fn a_range_is_widened_by_numbers_alone() {
        let mut random = Random(4);
        let mut values = drawn(&mut random);
        (values.0[3], values.0[60]) = (-5.0, 4.0);
        assert_eq!(
            widen(InstructionSet::detect(), [-1.0, 1.0], &values.0),
            [-5.0, 4.0]
        );
        assert_eq!(
            widen(InstructionSet::detect(), [-6.0, 7.0], &values.0),
            [-6.0, 7.0]
        );
        let none = [f64::NAN; TOGETHER];
        let empty = [f64::INFINITY, f64::NEG_INFINITY];
        assert_eq!(widen(InstructionSet::detect(), empty, &none), empty);
    }
}
