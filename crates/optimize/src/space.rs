//! The box that designs lie in.

/// A place nearer to its bound than this part of both is on it.
const ON_BOUND: f64 = 4.0 * f64::EPSILON;

/// The box, with the widths that make its variables comparable.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Space {
    pub bounds: Vec<[f64; 2]>,
    pub widths: Vec<f64>,
}

impl Space {
    /// The box of these bounds. A variable whose bounds meet has the width zero: nothing moves it.
    pub fn new(bounds: &[[f64; 2]]) -> Self {
        Self {
            bounds: bounds.to_vec(),
            widths: bounds
                .iter()
                .map(|[low, high]| (high - low).max(0.0))
                .collect(),
        }
    }

    /// Whether designs have so many variables and all bounds are numbers in their order.
    pub fn holds(&self, variables: usize) -> bool {
        let sound = |[low, high]: &[f64; 2]| low <= high && (high - low).is_finite();
        self.bounds.len() == variables && self.bounds.iter().all(sound)
    }

    /// The design as near as the box allows, on its bounds what is there but for rounding.
    pub fn within(&self, design: &[f64]) -> Vec<f64> {
        (design.iter().zip(&self.bounds))
            .map(|(x, [low, high])| {
                let near = |end: f64| (x - end).abs() <= ON_BOUND * (high - low).max(end.abs());
                match () {
                    () if !(*x > *low) || near(*low) => *low,
                    () if *x > *high || near(*high) => *high,
                    () => *x,
                }
            })
            .collect()
    }

    /// The design at a place of the unit box.
    pub fn design(&self, unit: &[f64]) -> Vec<f64> {
        let places = unit.iter().zip(&self.bounds).zip(&self.widths);
        let design: Vec<f64> = places.map(|((u, [low, _]), w)| low + w * u).collect();
        self.within(&design)
    }

    /// The place of a design in the unit box.
    pub fn unit(&self, design: &[f64]) -> Vec<f64> {
        (design.iter().zip(&self.bounds).zip(&self.widths))
            .map(|((x, [low, _]), w)| if *w > 0.0 { (x - low) / w } else { 0.0 })
            .collect()
    }

    /// The design a step of parts of the widths away.
    pub fn moved(&self, design: &[f64], step: &[f64], part: f64) -> Vec<f64> {
        let steps = design.iter().zip(step).zip(&self.widths);
        self.within(
            &steps
                .map(|((x, d), w)| x + part * d * w)
                .collect::<Vec<_>>(),
        )
    }

    /// The step from one design to another, in parts of the widths.
    pub fn step(&self, from: &[f64], to: &[f64]) -> Vec<f64> {
        (from.iter().zip(to).zip(&self.widths))
            .map(|((a, b), w)| if *w > 0.0 { (b - a) / w } else { 0.0 })
            .collect()
    }

    /// The largest difference of two designs, in parts of the widths.
    pub fn distance(&self, a: &[f64], b: &[f64]) -> f64 {
        (a.iter().zip(b).zip(&self.widths))
            .filter(|(_, w)| **w > 0.0)
            .map(|((a, b), w)| (a - b).abs() / w)
            .fold(0.0, f64::max)
    }
}
