//! One scale for a whole motion, which a single outlier does not shrink.

/// What is larger than so many times the [`SHARE`] quantile of the poses' largest values is off the scale.
const FAR: f64 = 10.0;
/// The share of the poses whose largest values set what is usual in a motion.
const SHARE: f64 = 0.75;

/// Forces, or moments, over a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Quantity {
    /// The value drawn at full size; larger ones are drawn at that size, broken.
    pub full: f64,
    /// The largest of all.
    pub largest: f64,
    /// The smallest share of the full value that is drawn.
    pub least: f64,
    /// Some were too small to draw.
    pub dropped: bool,
}

impl Quantity {
    /// The scale for the magnitudes of each pose; `None` where all are zero or not finite. Shares of the full value
    /// below `least` are not drawn.
    pub fn over(poses: impl Iterator<Item = Vec<f64>>, least: f64) -> Option<Quantity> {
        Quantity::within(poses, least, FAR)
    }

    /// The same where what is larger than `far` times the usual is off the scale.
    pub fn within(poses: impl Iterator<Item = Vec<f64>>, least: f64, far: f64) -> Option<Quantity> {
        let poses: Vec<Vec<f64>> = poses.collect();
        let mut peaks: Vec<f64> = poses
            .iter()
            .map(|pose| {
                pose.iter()
                    .copied()
                    .filter(|v| v.is_finite())
                    .fold(0.0, f64::max)
            })
            .filter(|peak| *peak > f64::MIN_POSITIVE)
            .collect();
        peaks.sort_by(f64::total_cmp);
        let largest = *peaks.last()?;
        let usual = peaks[(SHARE * (peaks.len() - 1) as f64) as usize];
        let full = largest.min(far * usual);
        let small = |v: &f64| *v > 0.0 && *v < least * full;
        Some(Quantity {
            full,
            largest,
            least,
            dropped: poses.iter().flatten().any(small),
        })
    }

    /// Whether some values are off the scale.
    pub fn capped(&self) -> bool {
        self.largest > self.full
    }

    /// The share of the full size at which a value is drawn, and whether it is off the scale; `None` when it is not drawn.
    pub fn share(&self, value: f64) -> Option<(f64, bool)> {
        (value.is_finite() && value >= self.least * self.full)
            .then(|| ((value / self.full).min(1.0), value > self.full))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn over(peaks: &[f64]) -> Quantity {
        Quantity::over(peaks.iter().map(|p| vec![*p, 0.01 * p, f64::NAN]), 0.07).unwrap()
    }

    #[test]
    fn an_outlier_is_capped_and_a_usual_peak_is_not() {
        let usual = over(&[100.0, 120.0, 90.0, 600.0]);
        assert_eq!((usual.full, usual.capped()), (600.0, false));
        let singular = over(&[100.0, 120.0, 90.0, 110.0, 1e9, f64::INFINITY]);
        assert_eq!((singular.full, singular.capped()), (1200.0, true));
        assert_eq!(singular.share(1e9), Some((1.0, true)));
        assert_eq!(singular.share(600.0), Some((0.5, false)));
        assert_eq!(singular.share(1.0), None);
        assert_eq!(singular.share(f64::NAN), None);
        assert!(singular.dropped);
    }

    #[test]
    fn nothing_to_draw_has_no_scale() {
        let none = [vec![0.0, f64::NAN], vec![f64::INFINITY], vec![]];
        assert_eq!(Quantity::over(none.into_iter(), 0.07), None);
    }
}
