//! Slider-cranks that come near to more pairs of angle and place than they can keep.

use kempe_linear::{C, Qr, Residuals, smallest_squares};

use super::SAME_ANGLE;
use super::least_squares::{SAME_FIT, spreads};
use super::slider::{SliderFunction, SliderPoint, slider_functions};
use crate::error::{SynthesisError, all_finite};

/// A slider-crank near to pairs of angle and place.
#[derive(Clone, Debug, PartialEq)]
pub struct SliderFit {
    /// The slider-crank.
    pub bar: SliderFunction,
    /// Whether the slider is ahead of the crank's end (1) or behind it (-1).
    pub branch: i8,
    /// Its slider's place less the one wanted at every pair.
    pub errors: Vec<f64>,
}

impl SliderFit {
    /// The root of the mean square of the errors.
    pub fn rms(&self) -> f64 {
        (self.errors.iter().map(|e| e * e).sum::<f64>() / self.errors.len() as f64).sqrt()
    }
}

/// Local minima of the sum of squares of the slider's errors over more pairs than can be kept, the best first: from the exact solutions of
/// pairs spread over the list, by Marquardt's method. A zero that is given is kept. Rates are not looked at.
///
/// # Errors
/// As of [`slider_functions`], and [`SynthesisError::None`] where no slider-crank on one branch comes out of any start.
pub fn fit_slider_function(
    points: &[SliderPoint],
    crank_zero: Option<f64>,
    slider_zero: Option<f64>,
) -> Result<Vec<SliderFit>, SynthesisError> {
    all_finite(points.iter().map(SliderPoint::is_finite))?;
    let exact = 5 - usize::from(crank_zero.is_some()) - usize::from(slider_zero.is_some());
    if points.len() < exact {
        return Err(SynthesisError::TooFew {
            equations: points.len(),
            unknowns: exact,
        });
    }
    let pairs: Vec<[f64; 2]> = points.iter().map(|p| [p.angle, p.place]).collect();
    super::distinct(&pairs, |_| SAME_ANGLE, true)?;
    let size = points.iter().fold(0.0, |m: f64, p| m.max(p.place.abs()));
    let mut fits: Vec<SliderFit> = Vec::new();
    for chosen in spreads(points.len(), exact) {
        let chosen: Vec<SliderPoint> = (chosen.into_iter())
            .map(|k| SliderPoint::new(points[k].angle, points[k].place))
            .collect();
        let starts = slider_functions(&chosen, crank_zero, slider_zero).unwrap_or_default();
        for (start, branch) in starts.iter().flat_map(|s| [(s, 1), (s, -1)]) {
            let problem = Errors {
                points,
                crank_zero,
                slider_zero,
                branch,
            };
            let Some(at) = smallest_squares(&problem, &problem.unknowns(start)) else {
                continue;
            };
            let bar = problem.bar(&at);
            let Some(errors) = problem.errors(&bar) else {
                continue;
            };
            let near = |a: C, b: C| (a - b).norm() <= SAME_FIT * (size + a.norm());
            let known = fits.iter().any(|f| {
                f.branch == branch && near(f.bar.crank, bar.crank) && near(f.bar.slider, bar.slider)
            });
            if !known {
                fits.push(SliderFit {
                    bar,
                    branch,
                    errors,
                });
            }
        }
    }
    fits.sort_by(|a, b| a.rms().total_cmp(&b.rms()));
    if fits.is_empty() {
        return Err(SynthesisError::None);
    }
    Ok(fits)
}

/// The slider's errors as a function of lengths.
struct Errors<'a> {
    points: &'a [SliderPoint],
    crank_zero: Option<f64>,
    slider_zero: Option<f64>,
    branch: i8,
}

impl Errors<'_> {
    /// Coupler, height of the guide, the slider's zero where it is free, and the crank as a vector or along its zero.
    fn unknowns(&self, bar: &SliderFunction) -> Vec<f64> {
        let mut all = vec![bar.coupler, bar.slider.im];
        if self.slider_zero.is_none() {
            all.push(bar.slider.re);
        }
        match self.crank_zero {
            Some(zero) => all.push((bar.crank * C::from_polar(1.0, -zero)).re),
            None => all.extend([bar.crank.re, bar.crank.im]),
        }
        all
    }

    fn bar(&self, unknowns: &[f64]) -> SliderFunction {
        let mut rest = unknowns.iter().copied();
        let mut next = || rest.next().unwrap_or(0.0);
        let (coupler, height) = (next(), next());
        let zero = match self.slider_zero {
            Some(zero) => zero,
            None => next(),
        };
        let crank = match self.crank_zero {
            Some(zero) => C::from_polar(1.0, zero).scale(next()),
            None => C::new(next(), next()),
        };
        SliderFunction {
            crank,
            slider: C::new(zero, height),
            coupler,
        }
    }

    fn errors(&self, bar: &SliderFunction) -> Option<Vec<f64>> {
        (self.points.iter())
            .map(|p| bar.place(p.angle, self.branch).map(|place| place - p.place))
            .collect()
    }
}

impl Residuals for Errors<'_> {
    fn residuals(&self, unknowns: &[f64]) -> Option<Vec<f64>> {
        self.errors(&self.bar(unknowns))
    }

    /// place = Re(u e) + r - X with r^2 = b^2 - y^2, y = h - Im(u e).
    fn jacobian(&self, unknowns: &[f64], _: &[f64], jacobian: &mut Qr) -> bool {
        let bar = self.bar(unknowns);
        for (k, point) in self.points.iter().enumerate() {
            let e = C::from_polar(1.0, point.angle);
            let y = bar.slider.im - (bar.crank * e).im;
            let square = bar.coupler * bar.coupler - y * y;
            if !(square > 0.0) {
                return false;
            }
            let r = f64::from(self.branch) * square.sqrt();
            jacobian.add(k, 0, bar.coupler / r);
            jacobian.add(k, 1, -y / r);
            let mut column = 2;
            if self.slider_zero.is_none() {
                jacobian.add(k, column, -1.0);
                column += 1;
            }
            let directions = match self.crank_zero {
                Some(zero) => vec![C::from_polar(1.0, zero)],
                None => vec![C::one(), C::i()],
            };
            for direction in directions {
                let change = direction * e;
                jacobian.add(k, column, change.re + y * change.im / r);
                column += 1;
            }
        }
        true
    }
}
