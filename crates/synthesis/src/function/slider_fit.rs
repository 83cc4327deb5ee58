//! Slider-cranks that come near to more pairs of angle and place than they can keep.

use std::f64::consts::{FRAC_PI_2, PI};

use kempe_linear::{C, Qr, Residuals, smallest_squares};

use super::SAME_ANGLE;
use super::driven::{COSINES, Generates, LONG, Lots, Way, with_driven};
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
    let exact = exact(crank_zero, slider_zero);
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
        let chosen = plain(points, &chosen);
        let starts = slider_functions(&chosen, crank_zero, slider_zero).unwrap_or_default();
        for (start, branch) in starts.iter().flat_map(|s| [(s, 1), (s, -1)]) {
            let problem = Errors {
                points,
                crank_zero,
                slider_zero,
                branch,
            };
            let least = smallest_squares(&problem, &problem.unknowns(start));
            let Some(fit) = least.and_then(|at| problem.fit(&at)) else {
                continue;
            };
            let near = |a: C, b: C| (a - b).norm() <= SAME_FIT * (size + a.norm());
            let same = |a: &SliderFunction, b: &SliderFunction| {
                near(a.crank, b.crank) && near(a.slider, b.slider)
            };
            if !fits
                .iter()
                .any(|f| f.branch == branch && same(&f.bar, &fit.bar))
            {
                fits.push(fit);
            }
        }
    }
    fits.sort_by(|a, b| a.rms().total_cmp(&b.rms()));
    if fits.is_empty() {
        return Err(SynthesisError::None);
    }
    Ok(fits)
}

/// Some of the pairs, without rates.
fn plain(points: &[SliderPoint], chosen: &[usize]) -> Vec<SliderPoint> {
    let plain = |k: &usize| SliderPoint::new(points[*k].angle, points[*k].place);
    chosen.iter().map(plain).collect()
}

/// What [`fit_slider_function`] finds, and the best slider-cranks that the crank drives from one end of its range, rad, to the other, with a
/// transmission angle that keeps from 0 and 180 degrees by 2, 10, 20, 30 and 40 degrees where the best of all does not: the best first.
///
/// # Errors
/// As of [`fit_slider_function`].
pub fn fit_driven_slider_function(
    points: &[SliderPoint],
    crank_zero: Option<f64>,
    slider_zero: Option<f64>,
    range: [f64; 2],
) -> Result<Vec<SliderFit>, SynthesisError> {
    let problems = [1, -1].map(|branch| Errors {
        points,
        crank_zero,
        slider_zero,
        branch,
    });
    with_driven(
        &problems,
        fit_slider_function(points, crank_zero, slider_zero),
        range,
    )
}

/// How many pairs determine a slider-crank.
fn exact(crank_zero: Option<f64>, slider_zero: Option<f64>) -> usize {
    5 - usize::from(crank_zero.is_some()) - usize::from(slider_zero.is_some())
}

/// The slider's errors as a function of lengths.
struct Errors<'a> {
    points: &'a [SliderPoint],
    crank_zero: Option<f64>,
    slider_zero: Option<f64>,
    branch: i8,
}

impl Errors<'_> {
    /// The least and the largest place.
    fn ends(&self) -> [f64; 2] {
        let places = self.points.iter().map(|p| p.place);
        places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
            [low.min(x), high.max(x)]
        })
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

impl Generates for Errors<'_> {
    type Linkage = SliderFunction;
    type Fit = SliderFit;

    fn pairs(&self) -> [usize; 2] {
        let exact = exact(self.crank_zero, self.slider_zero);
        [self.points.len(), exact]
    }

    /// How far the places are apart.
    fn size(&self) -> f64 {
        let [low, high] = self.ends();
        high - low
    }

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

    fn of_fit(&self, fit: &SliderFit) -> (i8, Vec<f64>, f64) {
        (fit.branch, self.unknowns(&fit.bar), fit.rms())
    }

    fn fit(&self, unknowns: &[f64]) -> Option<SliderFit> {
        let bar = self.bar(unknowns);
        let errors = self.errors(&bar)?;
        let branch = self.branch;
        Some(SliderFit {
            bar,
            branch,
            errors,
        })
    }

    fn exact(&self, chosen: &[usize]) -> Vec<SliderFunction> {
        let chosen = plain(self.points, chosen);
        slider_functions(&chosen, self.crank_zero, self.slider_zero).unwrap_or_default()
    }

    /// A free zero is where the slider would be about there with the crank square to the guide.
    fn by_lot(&self, lots: &mut Lots) -> SliderFunction {
        let [low, high] = self.ends();
        let (size, middle) = (high - low, 0.5 * (low + high));
        let far = match self.slider_zero {
            Some(zero) => size.max((zero + middle).abs()),
            None => size,
        };
        let coupler = lots.length(far);
        let height = lots.sign() * (lots.length(size) - size / 3.0);
        SliderFunction {
            crank: C::from_polar(lots.length(size), lots.angle()),
            slider: C::new(lots.sign() * coupler - middle, height),
            coupler,
        }
    }

    fn nearest_errors(&self, unknowns: &[f64]) -> Vec<f64> {
        let bar = self.bar(unknowns);
        let off = |p: &SliderPoint| bar.nearest_place(p.angle, self.branch) - p.place;
        self.points.iter().map(off).collect()
    }

    /// The crank's end is farthest from the guide where the crank is square to it.
    fn cosines(&self, unknowns: &[f64], way: Way) -> [f64; COSINES] {
        let bar = self.bar(unknowns);
        let square = FRAC_PI_2 - bar.crank.arg();
        let [from, to] = way.0;
        let [up, down] = [square, square + PI].map(|angle| way.nearest(angle));
        [from, to, up, down].map(|angle| bar.transmission_cosine(angle))
    }

    fn is_sound(&self, unknowns: &[f64]) -> bool {
        let bar = self.bar(unknowns);
        let lengths = [bar.crank.norm() / self.size(), bar.coupler / self.size()];
        lengths
            .iter()
            .all(|length| (LONG.recip()..=LONG).contains(length))
    }
}
