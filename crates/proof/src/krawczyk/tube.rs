//! A tube about a straight line, in which the pose is proved for a whole range of the path parameter.

use kempe_mechanism::blocks::Unknown;
use kempe_mechanism::constraint::{Input, Situation};
use kempe_mechanism::geometry::Geometry;
use kempe_mechanism::pose::Pose;
use kempe_number::{Interval, Jet, Number};

use super::contract::multiply;
use super::given::Given;
use super::system::{Middle, System};
use crate::not_proved::NotProved;

/// A series that carries the remainder of second order.
pub(crate) type Curve = Jet<Interval, 3>;

/// A straight line through the unknowns, and how far from it the one curve of solutions stays.
#[derive(Clone, Debug)]
pub(crate) struct Tube {
    /// Path parameter of the middle.
    pub at: f64,
    /// Path parameters for which it is proved.
    pub range: Interval,
    pub middle: Middle,
    /// Rate of every unknown along the line.
    rates: Vec<f64>,
    /// Half widths of the tube in which the solution is the only one.
    pub radii: Vec<f64>,
    /// Where in the tube it lies.
    pub image: Vec<Interval>,
}

impl System {
    /// Proves the curve of poses over a range of the path parameter: a tube about the tangent at its middle in which
    /// there is exactly one pose for every parameter of the range.
    ///
    /// The residual along the tangent is a Taylor polynomial with its remainder, F0 + F1 h + F2(range) h^2, so that the
    /// tube narrows with the square of the range. `given.inputs` must cover the range; `curve` gives them as series.
    pub fn tube(
        &self,
        given: &Given<'_>,
        rich: &Geometry<Curve>,
        (at, range): (f64, Interval),
        mut middle: Middle,
        poses: &mut [Pose<Interval>],
        curve: &mut dyn FnMut(Curve) -> Vec<Input<Curve>>,
    ) -> Result<Tube, NotProved> {
        let n = self.size;
        let zero = Interval::from_f64(0.0);
        let here = Interval::from_f64(at);
        let (thin, wide) = (curve(Jet::variable(here)), curve(Jet::variable(range)));
        let plain_inputs: Vec<Input<f64>> = thin.iter().map(Input::plain).collect();
        let (qr, inverse) = self.polish(given, &plain_inputs, poses, &mut middle)?;

        let mut series: Vec<Pose<Curve>> = poses.iter().map(constant_pose).collect();
        let mut along = |rates: &[f64], h: Interval, inputs: &[Input<Curve>]| {
            for &(unknown, column) in &self.columns.unknowns {
                let body = unknown.body().index();
                let line = |column: usize, from: f64| {
                    let rate = Interval::from_f64(rates[column]);
                    Curve::from_coefficients([rate * h + from, rate, zero])
                };
                let [x, y, angle] = middle[body];
                let pose = &mut series[body];
                match unknown {
                    Unknown::Place(_) => (pose.x, pose.y) = (line(column, x), line(column + 1, y)),
                    Unknown::Angle(_) => (pose.s, pose.c) = line(column, angle).sin_cos(),
                }
            }
            let situation = Situation {
                geometry: rich,
                inputs,
                poses: &series,
                near: given.near,
            };
            let list = self.residuals(given.mechanism, &situation);
            [0, 1, 2].map(|k| {
                list.iter()
                    .map(|r| r.coefficient(k))
                    .collect::<Vec<Interval>>()
            })
        };
        // The tangent: the rates that take away the residual's slope.
        let mut rates: Vec<f64> = along(&vec![0.0; n], zero, &thin)[1]
            .iter()
            .map(|slope| -slope.midpoint())
            .collect();
        qr.solve(&mut rates);
        if !rates.iter().all(|r| r.is_finite()) {
            return Err(NotProved::Singular);
        }
        let h = range - here;
        let [f0, f1, _] = along(&rates, zero, &thin);
        let [_, _, f2] = along(&rates, h, &wide);
        let parts = [f0, f1, f2].map(|f| multiply(&inverse, &f));
        let square = h.square();
        let value: Vec<Interval> = (0..n)
            .map(|i| parts[0][i] + parts[1][i] * h + parts[2][i] * square)
            .collect();

        let (radii, image) =
            self.contract(given, &inverse, &value, true, poses, |reach, poses| {
                self.spread(&middle, (&rates, h), reach, poses);
            })?;
        self.spread(&middle, (&rates, h), &image, poses);
        Ok(Tube {
            at,
            range,
            middle,
            rates,
            radii,
            image,
        })
    }

    /// Whether the box of poses about `middle` lies in a tube at the path parameter `p`: its pose is then the tube's.
    pub fn is_in_tube(&self, tube: &Tube, p: f64, middle: &Middle, image: &[Interval]) -> bool {
        let h = Interval::from_f64(p) - Interval::from_f64(tube.at);
        let inside = |column: usize, offset: Interval| {
            let u = offset + image[column] - h * tube.rates[column];
            u.is_inside(Interval::new(-tube.radii[column], tube.radii[column]))
        };
        self.columns.unknowns.iter().all(|&(unknown, column)| {
            let body = unknown.body().index();
            let offset = |k: usize| {
                Interval::from_f64(middle[body][k]) - Interval::from_f64(tube.middle[body][k])
            };
            match unknown {
                Unknown::Place(_) => inside(column, offset(0)) && inside(column + 1, offset(1)),
                // Both angles are near the same unwrapped one.
                Unknown::Angle(_) => inside(column, offset(2)),
            }
        })
    }
}

/// A pose that does not change.
fn constant_pose(pose: &Pose<Interval>) -> Pose<Curve> {
    Pose {
        x: Jet::constant(pose.x),
        y: Jet::constant(pose.y),
        c: Jet::constant(pose.c),
        s: Jet::constant(pose.s),
    }
}
