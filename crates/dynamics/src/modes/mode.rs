//! A natural vibration: its frequency, its shape, how it dies away or grows.

/// What grows by less than this part of how fast it swings does so by rounding.
pub(super) const FLUTTERS: f64 = 1e-7;

/// A natural vibration.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Square of the angular frequency without damping, 1/s^2: zero of a free motion, negative where it is unstable.
    pub square: f64,
    /// How far each coordinate goes, SI, for a modal mass of 1 kg m^2 or kg.
    pub shape: Vec<f64>,
    /// The two values of `s` (real and imaginary part, 1/s) with damping: conjugates where it vibrates, two real ones where it
    /// creeps.
    pub rates: [[f64; 2]; 2],
    /// Whether it swings and grows, or dies away, even without damping: loads that follow the motion feed it, and it has no frequency of its own.
    pub flutters: bool,
}

impl Mode {
    /// Angular frequency without damping, rad/s; 0 of a free motion, `None` of one that is unstable without damping.
    pub fn angular_frequency(&self) -> Option<f64> {
        (self.square >= 0.0 && !self.flutters).then(|| self.square.sqrt())
    }

    /// Angular frequency with damping, rad/s; 0 where it creeps.
    pub fn damped_angular_frequency(&self) -> f64 {
        self.rates[0][1].abs()
    }

    /// Damping in parts of the least for which it does not swing; `None` of free and unstable motions.
    pub fn damping_ratio(&self) -> Option<f64> {
        let known = self.square > 0.0 && !self.flutters;
        known.then(|| self.ratio_of_rates()).flatten()
    }

    /// The same by the rates alone, whatever brings it back: gyroscopic terms may. `None` where it does not die away or swing to both sides.
    pub fn ratio_of_rates(&self) -> Option<f64> {
        let [a, b] = self.rates;
        let product = a[0] * b[0] - a[1] * b[1];
        (product > 0.0).then(|| -(a[0] + b[0]) / 2.0 / product.sqrt() + 0.0)
    }

    /// Whether it grows by more than rounding.
    pub fn grows(&self) -> bool {
        let size = |s: [f64; 2]| s[0].abs() + s[1].abs();
        self.growth() > FLUTTERS * self.rates.map(size).into_iter().fold(0.0, f64::max)
    }

    /// The rate at which it grows, 1/s: negative where it dies away.
    pub fn growth(&self) -> f64 {
        self.rates[0][0].max(self.rates[1][0])
    }
}
