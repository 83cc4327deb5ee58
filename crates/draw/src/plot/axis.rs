//! An axis: from values to paper, and the round numbers to write beside it.

use kempe_number::math::ln;

use kempe_number::text::{decade, fixed, power_of_ten, significant};

/// Values beyond this are not drawn.
const LARGEST: f64 = 1e290;
/// Steps of angles in degrees.
const DEGREES: [f64; 9] = [1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 90.0, 180.0];

/// A named axis with its unit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// What is measured, such as `angle of rocker`.
    pub label: String,
    /// Its unit, such as `deg`; empty when it has none.
    pub unit: String,
    /// Logarithmic; values that are not positive are left out.
    pub log: bool,
    /// Shown range; all of the data when `None`.
    pub limits: Option<[f64; 2]>,
}

impl Axis {
    /// A linear axis over all of the data.
    pub fn new(label: impl Into<String>, unit: impl Into<String>) -> Axis {
        Axis {
            label: label.into(),
            unit: unit.into(),
            ..Axis::default()
        }
    }

    /// `label [unit]`, or the label alone.
    pub fn title(&self) -> String {
        match (self.label.is_empty(), self.unit.is_empty()) {
            (_, true) => self.label.clone(),
            (true, false) => format!("[{}]", self.unit),
            (false, false) => format!("{} [{}]", self.label, self.unit),
        }
    }
}

/// A linear or logarithmic map from values to millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// Lowest value.
    pub low: f64,
    /// Highest value.
    pub high: f64,
    /// Where the lowest value lies, mm.
    pub from: f64,
    /// Where the highest value lies, mm.
    pub to: f64,
    /// Logarithmic.
    pub log: bool,
}

impl Scale {
    /// Where a value lies, mm; `None` when it cannot be drawn.
    pub fn at(&self, value: f64) -> Option<f64> {
        let share = if self.log {
            (ln(value) - ln(self.low)) / (ln(self.high) - ln(self.low))
        } else {
            (value - self.low) / (self.high - self.low)
        };
        (usable(value, self.log) && share.abs() < 1e6)
            .then_some(self.from + share * (self.to - self.from))
    }

    /// The range to show for some values, at least a little wide, with a margin as a share of it.
    pub fn range(values: impl Iterator<Item = f64>, log: bool, margin: f64) -> [f64; 2] {
        let usable_values = values.filter(|v| usable(*v, log));
        let (mut low, mut high) = usable_values
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
                (l.min(v), h.max(v))
            });
        if low > high {
            (low, high) = if log { (1.0, 10.0) } else { (0.0, 1.0) };
        }
        if log {
            return if high / low < 1.0001 {
                [low / 2.0, high * 2.0]
            } else {
                [low, high]
            };
        }
        let size = low.abs().max(high.abs());
        // a constant with rounding noise shows as a constant
        if high - low <= 1e-9 * size || high == low {
            let half = if size > 0.0 { 0.1 * size } else { 1.0 };
            return [(low + high) / 2.0 - half, (low + high) / 2.0 + half];
        }
        let pad = margin * (high - low);
        [low - pad, high + pad]
    }
}

fn usable(value: f64, log: bool) -> bool {
    value.abs() < LARGEST && (!log || value > 1e-290)
}

/// Ticks of an axis, and the power of ten that their texts leave to the axis title.
pub(super) struct Ticks {
    /// Values with their texts; a fine tick has none.
    pub marks: Vec<(f64, String)>,
    /// Texts are to be multiplied by this power of ten.
    pub power: i32,
}

impl Ticks {
    /// About `wanted` round ticks on an axis.
    pub fn new(scale: &Scale, wanted: f64, unit: &str) -> Ticks {
        if scale.log {
            return Ticks::log(scale, wanted);
        }
        let step = step((scale.high - scale.low) / wanted.max(1.0), unit);
        let largest = scale.low.abs().max(scale.high.abs());
        let magnitude = decade(largest);
        let power = if (-3..5).contains(&magnitude) {
            0
        } else {
            3 * magnitude.div_euclid(3)
        };
        let decimals = (power - decade(step * 1.0000001)).max(0) as usize;
        let first = (scale.low / step - 1e-9).ceil();
        let count = ((scale.high / step + 1e-9).floor() - first).clamp(0.0, 50.0) as usize;
        let mark = |k: usize| {
            let value = (first + k as f64) * step;
            (value, fixed(value / power_of_ten(power), decimals.min(12)))
        };
        Ticks {
            marks: (0..=count).map(mark).collect(),
            power,
        }
    }

    fn log(scale: &Scale, wanted: f64) -> Ticks {
        let (first, last) = (decade(scale.low), decade(scale.high));
        let every = (f64::from(last - first) / wanted.max(1.0)).ceil().max(1.0) as i32;
        let mut marks = Vec::new();
        for power in first..=last {
            for digit in 1..10 {
                let value = f64::from(digit) * power_of_ten(power);
                let shown = (power - first) % every == 0
                    && (digit == 1 || last - first <= 1 && (digit == 2 || digit == 5));
                if value >= scale.low * 0.9999
                    && value <= scale.high * 1.0001
                    && (shown || every == 1)
                {
                    marks.push((
                        value,
                        if shown {
                            significant(value, 3)
                        } else {
                            String::new()
                        },
                    ));
                }
            }
        }
        Ticks { marks, power: 0 }
    }
}

/// The round step at or above a raw one: 1, 2, 5 times a power of ten, or a usual part of a turn.
fn step(raw: f64, unit: &str) -> f64 {
    if unit == "deg" && raw > 0.5 && raw <= 180.0 {
        return DEGREES.into_iter().find(|s| *s >= raw).unwrap_or(180.0);
    }
    if !(raw > 0.0 && raw.is_finite()) {
        return 1.0;
    }
    let power = power_of_ten(decade(raw));
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|m| m * power)
        .find(|s| *s >= raw * 0.9999)
        .unwrap_or(10.0 * power)
}

/// ` × 10³` for an axis title; empty for 0.
pub(super) fn power_text(power: i32) -> String {
    if power == 0 {
        return String::new();
    }
    let digit = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4'..='9' => char::from_u32('⁴' as u32 + c as u32 - '4' as u32).unwrap_or(c),
        _ => '⁰',
    };
    format!(
        " × 10{}",
        power.to_string().chars().map(digit).collect::<String>()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(low: f64, high: f64, unit: &str) -> Vec<String> {
        let scale = Scale {
            low,
            high,
            from: 0.0,
            to: 100.0,
            log: false,
        };
        Ticks::new(&scale, 6.0, unit)
            .marks
            .into_iter()
            .map(|(_, t)| t)
            .collect()
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(texts(0.0, 360.0, "deg"), ["0", "90", "180", "270", "360"]);
        assert_eq!(
            texts(-0.13, 0.42, ""),
            ["-0.1", "0", "0.1", "0.2", "0.3", "0.4"]
        );
        assert_eq!(
            texts(0.0, 1.2e6, "N"),
            ["0", "0.2", "0.4", "0.6", "0.8", "1", "1.2"]
        );
        assert_eq!(power_text(-12), " × 10⁻¹²");
    }
}
