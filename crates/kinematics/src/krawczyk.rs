//! Poses proved by interval arithmetic: Krawczyk's operator on the constraint rows.
//!
//! For a system F(x) = 0, a plain approximate inverse Y of its Jacobian at x0 and a box U of corrections about x0,
//!
//! K(U) = -Y F(x0) + (I - Y J(x0 + U)) U.
//!
//! If K(U) lies in the interior of U, then F has exactly one zero in x0 + U, it lies in x0 + K(U), and every matrix of
//! J(x0 + U) is regular (R. Krawczyk, Computing 4 (1969) 187; R. E. Moore, SIAM J. Numer. Anal. 14 (1977) 611; S. M.
//! Rump, Acta Numerica 19 (2010) 287, theorem 13.2). All of it holds for every value of a parameter at once when F and J
//! are evaluated for an interval of that parameter: existence and uniqueness all along a stretch of the motion
//! (A. Neumaier, *Interval Methods for Systems of Equations*, 1990, section 5.1).
//!
//! The unknowns are x, y (m) and the angle (rad) of the bodies, an angle entering the rows by enclosures of its sine and
//! cosine: a direction can not leave the unit circle. A box is looked for by epsilon inflation (S. M. Rump, 1983): the
//! image, a little widened, is tried as the next box.

use kempe_number::{Interval, Jet, Number, math};

use crate::blocks::{Row, Unknown};
use crate::certify::NotProved;
use crate::constraint::{Input, Situation};
use crate::geometry::Geometry;
use crate::mechanism::Mechanism;
use crate::newton::PlanNumber;
use crate::plan::{NewtonBlock, Plan};
use crate::pose::Pose;
use crate::qr::Qr;
use crate::state::{Branch, Design, State};

/// Boxes tried before a proof is given up.
const INFLATIONS: usize = 12;
/// How much wider than the last image the next box is.
const INFLATION: f64 = 1.1;
/// Absolute part of the inflation, in mechanism sizes and rad: a box must have an interior.
const SMALLEST: f64 = 1e-17;
/// Sums of `n` non-negative numbers are too small by less than this part, for every n below 10^3.
const SUMMED: f64 = 1.0 + 1e-12;
/// Half widths (mechanism sizes and rad) of the boxes tried for uniqueness once a pose is proved, the widest first.
const ROOMS: [f64; 9] = [0.3, 0.1, 0.03, 0.01, 1e-3, 1e-5, 1e-7, 1e-9, 1e-11];
/// Inflations of each of them.
const ROOM_TRIES: usize = 3;
/// Newton steps on plain numbers that polish the middle of a box.
const POLISH: usize = 8;

/// A series that carries the remainder of second order.
pub(crate) type Curve = Jet<Interval, 3>;

/// As many rows as unknowns: a block of the plan, or all of its blocks.
#[derive(Clone, Debug)]
pub(crate) struct System {
    /// How many numbers are sought.
    pub size: usize,
    unknowns: Vec<(Unknown, usize)>,
    /// Columns of every body's place and angle.
    columns: Vec<[Option<usize>; 2]>,
    /// Constraints with the places of their rows.
    rows: Vec<(usize, [Option<usize>; 2])>,
}

/// What the rows are evaluated with.
pub(crate) struct Given<'a> {
    pub mechanism: &'a Mechanism,
    pub geometry: &'a Geometry<Interval>,
    pub plain: &'a Geometry<f64>,
    pub inputs: &'a [Input<Interval>],
    pub near: &'a [f64],
    /// Size of the mechanism, m.
    pub size: f64,
}

/// The middle of a box: x, y and angle of every body.
pub(crate) type Middle = Vec<[f64; 3]>;

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
    /// The square part of one block.
    pub fn of_block(mechanism: &Mechanism, block: &NewtonBlock) -> Self {
        let unknowns = block
            .unknowns
            .iter()
            .copied()
            .zip(block.columns.iter().copied());
        Self::new(mechanism, unknowns.collect(), block.size, &block.rows)
    }

    /// The square parts of all blocks of a plan: every body's pose, without redundant rows and idle angles.
    pub fn whole(mechanism: &Mechanism, plan: &Plan) -> Self {
        let (mut unknowns, mut rows, mut size) = (Vec::new(), Vec::new(), 0);
        for block in plan
            .decomposition
            .blocks
            .iter()
            .filter(|b| !b.rows.is_empty())
        {
            for &unknown in &block.unknowns {
                unknowns.push((unknown, size));
                size += unknown.size();
            }
            rows.extend_from_slice(&block.rows);
        }
        Self::new(mechanism, unknowns, size, &rows)
    }

    fn new(
        mechanism: &Mechanism,
        unknowns: Vec<(Unknown, usize)>,
        size: usize,
        all: &[Row],
    ) -> Self {
        let mut columns = vec![[None; 2]; mechanism.bodies];
        for &(unknown, column) in &unknowns {
            let angle = usize::from(matches!(unknown, Unknown::Angle(_)));
            columns[unknown.body().index()][angle] = Some(column);
        }
        let mut rows: Vec<(usize, [Option<usize>; 2])> = Vec::new();
        for (place, row) in all.iter().take(size).enumerate() {
            let known = rows.iter().position(|(c, _)| *c == row.constraint);
            let entry = known.unwrap_or_else(|| {
                rows.push((row.constraint, [None; 2]));
                rows.len() - 1
            });
            rows[entry].1[row.row] = Some(place);
        }
        Self {
            size,
            unknowns,
            columns,
            rows,
        }
    }

    fn residuals<T: Number>(&self, mechanism: &Mechanism, situation: &Situation<'_, T>) -> Vec<T> {
        let mut list = vec![T::zero(); self.size];
        for (constraint, at) in &self.rows {
            let rows = situation.residual(&mechanism.constraints[*constraint].0);
            for k in 0..2 {
                if let Some(place) = at[k] {
                    list[place] = rows[k];
                }
            }
        }
        list
    }

    /// Hands every entry of the Jacobian to `emit` as row, column, value; entries of one place add up.
    fn jacobian<T: Number>(
        &self,
        mechanism: &Mechanism,
        situation: &Situation<'_, T>,
        mut emit: impl FnMut(usize, usize, T),
    ) {
        for (constraint, at) in &self.rows {
            situation.gradients(&mechanism.constraints[*constraint].0, |gradient| {
                let Some(row) = at[gradient.row] else { return };
                let [place, angle] = self.columns[gradient.body.index()];
                if let Some(column) = place {
                    emit(row, column, gradient.to[0]);
                    emit(row, column + 1, gradient.to[1]);
                }
                if let Some(column) = angle {
                    emit(row, column, gradient.to[2]);
                }
            });
        }
    }

    /// Plain poses of a middle; bodies that are not sought keep the pose they have.
    fn plain_poses(&self, middle: &Middle, poses: &mut [Pose<f64>]) {
        for (unknown, _) in &self.unknowns {
            let body = unknown.body().index();
            let [x, y, angle] = middle[body];
            let pose = &mut poses[body];
            match unknown {
                Unknown::Place(_) => (pose.x, pose.y) = (x, y),
                Unknown::Angle(_) => (pose.s, pose.c) = math::sin_cos(angle),
            }
        }
    }

    fn factor(&self, mechanism: &Mechanism, situation: &Situation<'_, f64>, qr: &mut Qr) {
        qr.reset(self.size, self.size);
        self.jacobian(mechanism, situation, |row, column, value| {
            qr.add(row, column, value)
        });
        qr.factor();
    }

    /// Newton's method on plain numbers. Returns the factored Jacobian at the result; `None` when it does not settle.
    pub fn polish(
        &self,
        given: &Given<'_>,
        inputs: &[Input<f64>],
        poses: &mut [Pose<f64>],
        middle: &mut Middle,
    ) -> Option<Qr> {
        let mut qr = Qr::with_capacity(self.size, self.size);
        let mut last = f64::INFINITY;
        for _ in 0..POLISH {
            self.plain_poses(middle, poses);
            let situation = Situation {
                geometry: given.plain,
                inputs,
                poses,
                near: given.near,
            };
            let mut step = self.residuals(given.mechanism, &situation);
            self.factor(given.mechanism, &situation, &mut qr);
            qr.solve(&mut step);
            let mut length = 0.0_f64;
            for &(unknown, column) in &self.unknowns {
                let at = &mut middle[unknown.body().index()];
                match unknown {
                    Unknown::Place(_) => {
                        at[0] -= step[column];
                        at[1] -= step[column + 1];
                        let part = (step[column].abs() + step[column + 1].abs()) / given.size;
                        length = math::max(length, part);
                    }
                    Unknown::Angle(_) => {
                        at[2] -= step[column];
                        length = math::max(length, step[column].abs());
                    }
                }
            }
            if !length.is_finite() {
                return None;
            }
            if length < 1e-14 || (length < 1e-9 && length > 0.3 * last) {
                return Some(qr);
            }
            last = length;
        }
        None
    }

    /// The approximate inverse, row after row.
    fn inverse(&self, qr: &Qr) -> Option<Vec<f64>> {
        let n = self.size;
        let mut inverse = vec![0.0; n * n];
        for column in 0..n {
            let mut unit = vec![0.0; n];
            unit[column] = 1.0;
            qr.solve(&mut unit);
            for (row, value) in unit.iter().enumerate() {
                inverse[row * n + column] = *value;
            }
        }
        inverse.iter().all(|v| v.is_finite()).then_some(inverse)
    }

    /// Boxes for the poses sought: the middle, moved along the rates by `h`, within `reach` of each unknown.
    fn spread(
        &self,
        middle: &Middle,
        (rates, h): (&[f64], Interval),
        reach: &[Interval],
        poses: &mut [Pose<Interval>],
    ) {
        let at = |column: usize, from: f64| h * rates[column] + reach[column] + from;
        for &(unknown, column) in &self.unknowns {
            let body = unknown.body().index();
            let pose = &mut poses[body];
            match unknown {
                Unknown::Place(_) => {
                    (pose.x, pose.y) =
                        (at(column, middle[body][0]), at(column + 1, middle[body][1]));
                }
                Unknown::Angle(_) => (pose.s, pose.c) = at(column, middle[body][2]).sin_cos(),
            }
        }
    }

    /// Finds a box of corrections that Krawczyk's operator maps into itself: its half widths, and the image. With
    /// `widen` the half widths are those of a larger box, in which the zero is still the only one.
    ///
    /// `value` encloses Y F at the middle, `spread` gives the poses for a reach.
    fn contract(
        &self,
        given: &Given<'_>,
        inverse: &[f64],
        value: &[Interval],
        widen: bool,
        poses: &mut [Pose<Interval>],
        mut spread: impl FnMut(&[Interval], &mut [Pose<Interval>]),
    ) -> Result<(Vec<f64>, Vec<Interval>), NotProved> {
        let units = self.units(given.size);
        let least = |i: usize| value[i].mag() * INFLATION + SMALLEST * units[i];
        let mut deviation = Vec::new();
        let mut attempt = |mut radii: Vec<f64>, tries: usize| {
            for _ in 0..tries {
                let reach: Vec<Interval> = radii.iter().map(|r| Interval::new(-r, *r)).collect();
                spread(&reach, poses);
                let situation = Situation {
                    geometry: given.geometry,
                    inputs: given.inputs,
                    poses,
                    near: given.near,
                };
                self.deviation(given.mechanism, &situation, inverse, &mut deviation);
                let image: Vec<Interval> = (deviation.chunks_exact(self.size).zip(value))
                    .map(|(row, value)| {
                        let products = row.iter().zip(&radii).map(|(m, r)| m.mag() * r);
                        let sum = products.sum::<f64>() * SUMMED;
                        Interval::new(-sum, sum) - *value
                    })
                    .collect();
                // An empty or undefined image is inside nothing.
                if image
                    .iter()
                    .zip(&reach)
                    .all(|(image, reach)| image.is_inside_interior(*reach))
                {
                    return Some((radii, image));
                }
                // Grow only: a box that shrinks in one unknown while it grows in another may go round in circles.
                for (i, radius) in radii.iter_mut().enumerate() {
                    let next = image[i].mag() * INFLATION + SMALLEST * units[i];
                    *radius = math::max(*radius, next);
                    if !radius.is_finite() {
                        return None;
                    }
                }
            }
            None
        };
        let tight = (0..self.size).map(least).collect();
        let (radii, image) = attempt(tight, INFLATIONS).ok_or(NotProved::Wide)?;
        if widen {
            for room in ROOMS {
                let floor = radii
                    .iter()
                    .zip(&units)
                    .map(|(r, unit)| math::max(*r, room * unit));
                if let Some((wide, _)) = attempt(floor.collect(), ROOM_TRIES) {
                    return Ok((wide, image));
                }
            }
        }
        Ok((radii, image))
    }

    /// What counts as one for every unknown: the mechanism's size, a radian.
    fn units(&self, size: f64) -> Vec<f64> {
        let mut units = vec![1.0; self.size];
        for &(unknown, column) in &self.unknowns {
            if matches!(unknown, Unknown::Place(_)) {
                units[column] = size;
                units[column + 1] = size;
            }
        }
        units
    }

    /// I - Y J, a sparse J entry by entry, row after row.
    fn deviation(
        &self,
        mechanism: &Mechanism,
        situation: &Situation<'_, Interval>,
        inverse: &[f64],
        out: &mut Vec<Interval>,
    ) {
        let n = self.size;
        let zero = Interval::from_f64(0.0);
        out.clear();
        out.resize(n * n, zero);
        for i in 0..n {
            out[i * n + i] = Interval::from_f64(1.0);
        }
        self.jacobian(mechanism, situation, |row, column, entry| {
            if entry == zero {
                return;
            }
            for i in 0..n {
                let y = inverse[i * n + row];
                if y != 0.0 {
                    out[i * n + column] -= entry * y;
                }
            }
        });
    }

    /// Proves one pose near `middle` for the given inputs, which may be intervals, and encloses it in `poses`. Poses of
    /// bodies that are not sought are taken as they are. Returns the half widths in which the pose is the only one,
    /// where it lies, and the determinant at the middle.
    pub fn enclose(
        &self,
        given: &Given<'_>,
        middle: &mut Middle,
        widen: bool,
        poses: &mut [Pose<Interval>],
    ) -> Result<(Vec<f64>, Vec<Interval>, f64), NotProved> {
        let plain_inputs: Vec<Input<f64>> = given.inputs.iter().map(plain_input).collect();
        let mut plain: Vec<Pose<f64>> = poses.iter().map(Pose::value).collect();
        let qr = self
            .polish(given, &plain_inputs, &mut plain, middle)
            .ok_or(NotProved::NoPose)?;
        let inverse = self.inverse(&qr).ok_or(NotProved::Singular)?;
        let still = vec![0.0; self.size];
        let here = (still.as_slice(), Interval::from_f64(0.0));
        let nothing = vec![Interval::from_f64(0.0); self.size];
        self.spread(middle, here, &nothing, poses);
        let situation = Situation {
            geometry: given.geometry,
            inputs: given.inputs,
            poses,
            near: given.near,
        };
        let value = multiply(&inverse, &self.residuals(given.mechanism, &situation));
        let (radii, image) =
            self.contract(given, &inverse, &value, widen, poses, |reach, poses| {
                self.spread(middle, here, reach, poses);
            })?;
        self.spread(middle, here, &image, poses);
        Ok((radii, image, qr.determinant()))
    }

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
        let plain_inputs: Vec<Input<f64>> = (thin.iter())
            .map(|q| Input {
                value: q.value.value(),
                c: q.c.value(),
                s: q.s.value(),
            })
            .collect();
        let mut plain: Vec<Pose<f64>> = poses.iter().map(Pose::value).collect();
        let qr = self
            .polish(given, &plain_inputs, &mut plain, &mut middle)
            .ok_or(NotProved::NoPose)?;
        let inverse = self.inverse(&qr).ok_or(NotProved::Singular)?;

        let mut series: Vec<Pose<Curve>> = poses.iter().map(constant_pose).collect();
        let mut along = |rates: &[f64], h: Interval, inputs: &[Input<Curve>]| {
            for &(unknown, column) in &self.unknowns {
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
        self.unknowns.iter().all(|&(unknown, column)| {
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

    /// Smallest of half widths: angles in rad, lengths in mechanism sizes.
    pub fn narrowest(&self, radii: &[f64], size: f64) -> f64 {
        let parts = self
            .unknowns
            .iter()
            .map(|&(unknown, column)| match unknown {
                Unknown::Place(_) => math::min(radii[column], radii[column + 1]) / size,
                Unknown::Angle(_) => radii[column],
            });
        parts.fold(f64::INFINITY, math::min)
    }

    /// Largest width of an image: angles in rad, lengths in mechanism sizes.
    pub fn widest(&self, image: &[Interval], size: f64) -> f64 {
        let mut widest = 0.0;
        for &(unknown, column) in &self.unknowns {
            widest = match unknown {
                Unknown::Place(_) => {
                    let part = math::max(image[column].width(), image[column + 1].width());
                    math::max(widest, part / size)
                }
                Unknown::Angle(_) => math::max(widest, image[column].width()),
            };
        }
        widest
    }
}

/// Matrix times vector, the matrix exact.
fn multiply(matrix: &[f64], vector: &[Interval]) -> Vec<Interval> {
    matrix
        .chunks_exact(vector.len().max(1))
        .map(|row| {
            row.iter()
                .zip(vector)
                .fold(Interval::from_f64(0.0), |sum, (y, f)| {
                    if *y == 0.0 { sum } else { sum + *f * *y }
                })
        })
        .collect()
}

fn plain_input(input: &Input<Interval>) -> Input<f64> {
    Input {
        value: input.value.value(),
        c: input.c.value(),
        s: input.s.value(),
    }
}

fn constant_pose(pose: &Pose<Interval>) -> Pose<Curve> {
    Pose {
        x: Jet::constant(pose.x),
        y: Jet::constant(pose.y),
        c: Jet::constant(pose.c),
        s: Jet::constant(pose.s),
    }
}

/// The middle of poses with unwrapped angles near `near`.
pub(crate) fn middle_of(poses: &[Pose<f64>], near: &[f64]) -> Middle {
    let parts = poses.iter().zip(near);
    parts
        .map(|(pose, near)| [pose.x, pose.y, pose.angle_near(*near)])
        .collect()
}

/// Encloses the pose of a Newton block, or says why it is not proved.
pub(crate) fn enclose_block(
    block: &NewtonBlock,
    mechanism: &Mechanism,
    design: &Design<Interval>,
    branch: &Branch,
    state: &mut State<Interval>,
) -> Result<Interval, NotProved> {
    let system = System::of_block(mechanism, block);
    let plain = design.plain.first().ok_or(NotProved::NoPose)?;
    let given = Given {
        mechanism,
        geometry: &design.geometry,
        plain,
        inputs: &state.inputs,
        near: &branch.near,
        size: plain.size(mechanism),
    };
    let mut middle = middle_of(&branch.guess, &branch.near);
    let (_, _, determinant) = system.enclose(&given, &mut middle, false, &mut state.poses)?;
    // The Jacobian is regular in all of the box, so its determinant keeps this sign.
    Ok(Interval::from_f64(determinant))
}

impl PlanNumber for Interval {
    /// The poses are proved by Krawczyk's operator; where they are not, they and the determinant are empty.
    fn solve_newton(
        block: &NewtonBlock,
        mechanism: &Mechanism,
        design: &Design<Self>,
        branch: &Branch,
        state: &mut State<Self>,
    ) -> Self {
        enclose_block(block, mechanism, design, branch, state).unwrap_or_else(|_| {
            for unknown in &block.unknowns {
                let pose = &mut state.poses[unknown.body().index()];
                match unknown {
                    Unknown::Place(_) => (pose.x, pose.y) = (Self::EMPTY, Self::EMPTY),
                    Unknown::Angle(_) => (pose.c, pose.s) = (Self::EMPTY, Self::EMPTY),
                }
            }
            Self::EMPTY
        })
    }
}
