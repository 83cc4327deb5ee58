//! The sense in which a joint slides, by its speed and by how it starts.

use kempe_number::{Interval, Number};

use crate::vector::sign;

/// What comes to rest slides until its speed is less than this part of what counts as none.
const COMES_TO_REST: f64 = 1e-3;

/// The sense in which a joint slides: that of its speed, or at rest that in which it starts; 0 when it stays at rest.
/// Speeds and accelerations that are no larger than those of `still` count as none.
pub fn direction(speed: f64, acceleration: f64, still: [f64; 2]) -> f64 {
    let slows = speed * acceleration < 0.0 && acceleration.abs() > still[1];
    let least = if slows {
        COMES_TO_REST * still[0]
    } else {
        still[0]
    };
    if speed.abs() > least {
        sign(speed)
    } else if acceleration.abs() > still[1] {
        sign(acceleration)
    } else {
        0.0
    }
}

/// The senses in which joints slide whose speeds and accelerations lie in these bounds: all from -1 to 1 where there are
/// several. What counts as none is told by the size of the middle design: that of the others is taken to be half as large at
/// least, and twice as large at most.
pub(crate) fn directions(
    speed: Interval,
    acceleration: Interval,
    still: [Interval; 2],
) -> Interval {
    let sense = |x: Interval, still: Interval| {
        let (least, most) = (still.lo() / 2.0, still.hi() * 2.0);
        if x.lo() > most || x.hi() < -most {
            Some(sign(x.lo()))
        } else {
            (x.mag() <= least).then_some(0.0)
        }
    };
    let of_speed = sense(speed, still[0]);
    let found = match of_speed {
        Some(0.0) => sense(acceleration, still[1]).filter(|sense| {
            // What may still come to rest from there slides to either side.
            let slides = COMES_TO_REST * still[0].lo() / 2.0;
            *sense == 0.0 || sense * speed.lo() >= -slides && sense * speed.hi() >= -slides
        }),
        _ => of_speed,
    };
    found.map_or(Interval::new(-1.0, 1.0), Interval::from_f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whatever lies in bounds slides in one of the senses that hold of them, also what hardly moves and comes to rest or begins to.
    #[test]
    fn the_senses_of_bounds_hold_all_senses_within() {
        let still = [1e-12, 1e-9];
        let sizes = [0.0, 1e-17, 3e-16, 2e-15, 4e-13, 0.9e-12, 3e-12, 1e-9, 1e-6];
        let all: Vec<f64> = sizes.iter().flat_map(|x| [-x, *x]).collect();
        let within = |a: f64, b: f64| Interval::new(a.min(b), a.max(b));
        for (a, b) in all.iter().flat_map(|a| all.iter().map(move |b| (*a, *b))) {
            for (c, d) in all
                .iter()
                .flat_map(|c| all.iter().map(move |d| (1e3 * c, 1e3 * d)))
            {
                let bounds = directions(within(a, b), within(c, d), still.map(Interval::from_f64));
                for (speed, gain) in [(a, c), (a, d), (b, c), (b, d)] {
                    let sense = direction(speed, gain, still);
                    let holds = bounds.lo() <= sense && sense <= bounds.hi();
                    assert!(holds, "{speed:e} {gain:e}: {sense} in {bounds:?}");
                }
            }
        }
        // What slows down slides on, what gains speed has begun to.
        assert_eq!(direction(-4e-13, 1e-6, still), -1.0);
        assert_eq!(direction(4e-13, 1e-6, still), 1.0);
        assert_eq!(direction(-1e-17, 1e-6, still), 1.0);
        assert_eq!(direction(-4e-13, 1e-10, still), 0.0);
    }
}
