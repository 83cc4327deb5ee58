//! Four-bars that come near to more pairs of angles than they can keep.

use std::f64::consts::PI;

use kempe_linear::{C, Qr, Residuals, independent_least_squares, smallest_squares};

use super::driven::{COSINES, Generates, LONG, Lots, Way, with_driven};
use super::{DialZeros, FunctionFourBar, PrecisionPoint, SAME_ANGLE, distinct, functions};
use crate::error::{SynthesisError, all_finite};

/// A four-bar near to pairs of angles.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The four-bar.
    pub bar: FunctionFourBar,
    /// The branch it is on, with the first link driven.
    pub branch: i8,
    /// Its output's angle less the one wanted at every pair, rad.
    pub errors: Vec<f64>,
}

impl Fit {
    /// The root of the mean square of the errors, rad.
    pub fn rms(&self) -> f64 {
        (self.errors.iter().map(|e| e * e).sum::<f64>() / self.errors.len() as f64).sqrt()
    }
}

/// The four-bar with both dial zeros given that keeps Freudenstein's equation best in the sum of squares of what is left of it,
/// K1 cos(output) - K2 cos(input) + K3 - cos(input - output): linear, exact for three pairs.
///
/// # Errors
/// Fewer than three pairs, not finite, repeated or contradictory, or pairs that leave a length free.
pub fn fit_lengths(
    points: &[PrecisionPoint],
    input_zero: f64,
    output_zero: f64,
) -> Result<FunctionFourBar, SynthesisError> {
    all_finite(points.iter().map(PrecisionPoint::is_finite))?;
    if points.len() < 3 {
        return Err(SynthesisError::TooFew {
            equations: points.len(),
            unknowns: 3,
        });
    }
    let pairs: Vec<[f64; 2]> = points.iter().map(|p| [p.input, p.output]).collect();
    distinct(&pairs, |_| SAME_ANGLE, true)?;
    let (input, output) = (
        C::from_polar(1.0, input_zero),
        C::from_polar(1.0, output_zero),
    );
    let turned: Vec<[C; 2]> = (points.iter())
        .map(|p| {
            [
                input * C::from_polar(1.0, p.input),
                output * C::from_polar(1.0, p.output),
            ]
        })
        .collect();
    let column = |of: fn(&[C; 2]) -> f64| turned.iter().map(of).collect::<Vec<f64>>();
    let columns = [
        column(|[_, q]| q.re),
        column(|[e, _]| -e.re),
        column(|_| 1.0),
    ];
    let target = column(|[e, q]| e.re * q.re + e.im * q.im);
    let k = independent_least_squares(&[&columns[0], &columns[1], &columns[2]], &target);
    // K1 = 1 / a, K2 = 1 / c, K3 = (a^2 - b^2 + c^2 + 1) / 2ac.
    let (a, c) = (1.0 / k[0], 1.0 / k[1]);
    let square = a * a + c * c + 1.0 - 2.0 * a * c * k[2];
    if !(a.is_finite() && c.is_finite()) {
        return Err(SynthesisError::Dependent {
            datum: points.len() - 1,
        });
    }
    if !(square > 0.0) {
        return Err(SynthesisError::None);
    }
    Ok(FunctionFourBar {
        input: input.scale(a),
        output: output.scale(c),
        coupler: square.sqrt(),
    })
}

/// Local minima of the sum of squares of the output's errors over more pairs of angles than can be kept, the best first: from the exact
/// solutions of pairs spread over the list, by Marquardt's method. Zeros of dials that are given are kept.
///
/// # Errors
/// As of [`functions`], and [`SynthesisError::None`] where no four-bar on one branch comes out of any start.
pub fn fit_function(
    points: &[PrecisionPoint],
    zeros: DialZeros,
) -> Result<Vec<Fit>, SynthesisError> {
    all_finite(points.iter().map(PrecisionPoint::is_finite))?;
    let exact = zeros.exact();
    if points.len() < exact {
        return Err(SynthesisError::TooFew {
            equations: points.len(),
            unknowns: exact,
        });
    }
    let pairs: Vec<[f64; 2]> = points.iter().map(|p| [p.input, p.output]).collect();
    distinct(&pairs, |_| SAME_ANGLE, true)?;
    let mut starts = Vec::new();
    for chosen in spreads(points.len(), exact) {
        starts.extend(functions(&plain(points, &chosen), zeros).unwrap_or_default());
    }
    if let (Some(input), Some(output)) = (zeros.input, zeros.output)
        && let Ok(bar) = fit_lengths(points, input, output)
    {
        starts.push(bar);
    }
    let mut fits: Vec<Fit> = Vec::new();
    for start in starts {
        for branch in [1, -1] {
            let problem = Errors {
                points,
                zeros,
                branch,
            };
            let least = smallest_squares(&problem, &problem.unknowns(&start));
            let Some(fit) = least.and_then(|at| problem.fit(&at)) else {
                continue;
            };
            let near = |a: C, b: C| (a - b).norm() <= SAME_FIT * (1.0 + a.norm());
            let same = |a: &FunctionFourBar, b: &FunctionFourBar| {
                near(a.input, b.input) && near(a.output, b.output)
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

/// Some of the pairs, without conditions on changes.
fn plain(points: &[PrecisionPoint], chosen: &[usize]) -> Vec<PrecisionPoint> {
    let plain = |k: &usize| PrecisionPoint::new(points[*k].input, points[*k].output);
    chosen.iter().map(plain).collect()
}

/// What [`fit_function`] finds, and the best four-bars that the first link drives from one end of the input's range, rad, to the other, with
/// a transmission angle that keeps from 0 and 180 degrees by 2, 10, 20, 30 and 40 degrees where the best of all does not: the best first.
///
/// # Errors
/// As of [`fit_function`].
pub fn fit_driven_function(
    points: &[PrecisionPoint],
    zeros: DialZeros,
    range: [f64; 2],
) -> Result<Vec<Fit>, SynthesisError> {
    let problems = [1, -1].map(|branch| Errors {
        points,
        zeros,
        branch,
    });
    with_driven(&problems, fit_function(points, zeros), range)
}

/// Choices of so many of a list to start from: evenly spread, and shifted by parts of their distance.
pub(super) fn spreads(count: usize, chosen: usize) -> impl Iterator<Item = Vec<usize>> {
    [0.0, 0.3, -0.3].into_iter().map(move |shift| {
        let at = |k: usize| {
            let part = (k as f64 + 0.5 + shift) / chosen as f64;
            ((part * count as f64) as usize).min(count - 1)
        };
        (0..chosen).map(at).collect()
    })
}

/// Links nearer than this part of their size are those of one minimum.
pub(super) const SAME_FIT: f64 = 1e-5;

/// The output's errors as a function of links.
struct Errors<'a> {
    points: &'a [PrecisionPoint],
    zeros: DialZeros,
    branch: i8,
}

impl Errors<'_> {
    fn bar(&self, unknowns: &[f64]) -> FunctionFourBar {
        let mut rest = unknowns[1..].iter().copied();
        let mut link = |zero: Option<f64>| {
            let first = rest.next().unwrap_or(0.0);
            match zero {
                Some(zero) => C::from_polar(1.0, zero).scale(first),
                None => C::new(first, rest.next().unwrap_or(0.0)),
            }
        };
        FunctionFourBar {
            input: link(self.zeros.input),
            output: link(self.zeros.output),
            coupler: unknowns[0],
        }
    }

    fn errors(&self, bar: &FunctionFourBar) -> Option<Vec<f64>> {
        (self.points.iter())
            .map(|p| {
                bar.output_angle(p.input, self.branch, p.output)
                    .map(|angle| angle - p.output)
            })
            .collect()
    }
}

impl Residuals for Errors<'_> {
    fn residuals(&self, unknowns: &[f64]) -> Option<Vec<f64>> {
        self.errors(&self.bar(unknowns))
    }

    /// d output / d unknown = -(dF / d unknown) / (dF / d output), F = |coupler|^2 / 2 - b^2 / 2.
    fn jacobian(&self, unknowns: &[f64], residuals: &[f64], jacobian: &mut Qr) -> bool {
        let bar = self.bar(unknowns);
        for (k, (point, error)) in self.points.iter().zip(residuals).enumerate() {
            let output = point.output + error;
            let coupler = bar.coupler_at(point.input, output);
            let (e, q) = (C::from_polar(1.0, point.input), C::from_polar(1.0, output));
            let by = |change: C| coupler.re * change.re + coupler.im * change.im;
            let slope = by(C::i() * bar.output * q);
            if slope == 0.0 {
                return false;
            }
            jacobian.add(k, 0, bar.coupler / slope);
            let mut column = 1;
            for (turned, zero) in [(-e, self.zeros.input), (q, self.zeros.output)] {
                let directions = match zero {
                    Some(zero) => vec![C::from_polar(1.0, zero)],
                    None => vec![C::one(), C::i()],
                };
                for direction in directions {
                    jacobian.add(k, column, -by(direction * turned) / slope);
                    column += 1;
                }
            }
        }
        true
    }
}

impl Generates for Errors<'_> {
    type Linkage = FunctionFourBar;
    type Fit = Fit;

    fn pairs(&self) -> [usize; 2] {
        [self.points.len(), self.zeros.exact()]
    }

    /// The frame.
    fn size(&self) -> f64 {
        1.0
    }

    /// Coupler, and each link as a vector, or as a length along its given zero.
    fn unknowns(&self, bar: &FunctionFourBar) -> Vec<f64> {
        let mut all = vec![bar.coupler];
        for (link, zero) in [
            (bar.input, self.zeros.input),
            (bar.output, self.zeros.output),
        ] {
            match zero {
                Some(zero) => all.push((link * C::from_polar(1.0, -zero)).re),
                None => all.extend([link.re, link.im]),
            }
        }
        all
    }

    fn of_fit(&self, fit: &Fit) -> (i8, Vec<f64>, f64) {
        (fit.branch, self.unknowns(&fit.bar), fit.rms())
    }

    fn fit(&self, unknowns: &[f64]) -> Option<Fit> {
        let bar = self.bar(unknowns);
        let errors = self.errors(&bar)?;
        let branch = self.branch;
        Some(Fit {
            bar,
            branch,
            errors,
        })
    }

    fn exact(&self, chosen: &[usize]) -> Vec<FunctionFourBar> {
        functions(&plain(self.points, chosen), self.zeros).unwrap_or_default()
    }

    fn by_lot(&self, lots: &mut Lots) -> FunctionFourBar {
        let mut link = || C::from_polar(lots.length(1.0), lots.angle());
        FunctionFourBar {
            input: link(),
            output: link(),
            coupler: lots.length(1.0),
        }
    }

    fn nearest_errors(&self, unknowns: &[f64]) -> Vec<f64> {
        let bar = self.bar(unknowns);
        let off = |p: &PrecisionPoint| {
            bar.nearest_output_angle(p.input, self.branch, p.output) - p.output
        };
        self.points.iter().map(off).collect()
    }

    /// The fixed pivots' distance from the coupler's ends is least and largest where the first link lies along the frame.
    fn cosines(&self, unknowns: &[f64], way: Way) -> [f64; COSINES] {
        let bar = self.bar(unknowns);
        let along = -bar.input.arg();
        let [from, to] = way.0;
        let [near, far] = [along, along + PI].map(|angle| way.nearest(angle));
        [from, to, near, far].map(|input| bar.transmission_cosine(input))
    }

    fn is_sound(&self, unknowns: &[f64]) -> bool {
        let bar = self.bar(unknowns);
        let lengths = [bar.input.norm(), bar.coupler, bar.output.norm()];
        lengths
            .iter()
            .all(|length| (LONG.recip()..=LONG).contains(length))
    }
}
