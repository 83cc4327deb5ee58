//! Motion generation: the dyads that guide a body through poses.
//!
//! A pin of the body keeps its distance from a fixed pivot. For every pose after the first that is linear in seven products: 1, the
//! moving pivot z, the fixed one g, and z conj(g). Four such equations leave a plane in the space of the products, and what makes
//! products of its points, w p = z conj(g), are two conics there: they meet in four points, the four dyads of L. Burmester's five poses
//! (1888). Conditions that are linear in a pivot, a line that it is to lie on, count as a pose each.

use kempe_linear::C;

use crate::conics::{Form, meet};
use crate::displacements::{Displacements, products, with_fixed, with_moving};
use crate::dyad::{Dyad, DyadSolution, gathered};
use crate::error::{SynthesisError, all_finite, balanced};
use crate::kernel::{DependentRow, kernel};
use crate::newton::{Products, Row, polished, residual};
use crate::pose::{Line, Pose, dot};

/// What a dyad is to keep besides its poses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DyadCondition {
    /// The fixed pivot lies at a place: counts as two poses.
    FixedAt(C),
    /// The moving pivot is a point of the body: counts as two poses.
    MovingAt(C),
    /// The fixed pivot lies on a line: counts as one pose.
    FixedOn(Line),
    /// The moving pivot lies on a line of the body: counts as one pose.
    MovingOn(Line),
}

impl DyadCondition {
    /// How many equations it makes.
    pub(crate) fn equations(&self) -> usize {
        match self {
            Self::FixedAt(_) | Self::MovingAt(_) => 2,
            Self::FixedOn(_) | Self::MovingOn(_) => 1,
        }
    }

    pub(crate) fn is_finite(&self) -> bool {
        match self {
            Self::FixedAt(point) | Self::MovingAt(point) => point.is_finite(),
            Self::FixedOn(line) | Self::MovingOn(line) => line.is_finite(),
        }
    }

    /// The condition as it is in the inverted motion.
    fn inverse(&self) -> Self {
        match *self {
            Self::FixedAt(point) => Self::MovingAt(point),
            Self::MovingAt(point) => Self::FixedAt(point),
            Self::FixedOn(line) => Self::MovingOn(line),
            Self::MovingOn(line) => Self::FixedOn(line),
        }
    }

    /// Whether a dyad keeps it. A pivot at infinity lies on no line.
    fn is_kept(&self, dyad: &Dyad, scale: f64) -> bool {
        let (fixed, moving) = match *dyad {
            Dyad::Rr { fixed, moving, .. } => (Some(fixed), Some(moving)),
            Dyad::Pr { moving, .. } => (None, Some(moving)),
            Dyad::Rp { fixed, .. } => (Some(fixed), None),
        };
        let near = |pivot: Option<C>, place: C, beside: &dyn Fn(C) -> f64| {
            pivot.is_some_and(|p| {
                let size = scale + (p - place).norm();
                beside(p).abs() <= ON_CONDITION * size
            })
        };
        match *self {
            Self::FixedAt(point) => near(fixed, point, &|p| (p - point).norm()),
            Self::MovingAt(point) => near(moving, point, &|p| (p - point).norm()),
            Self::FixedOn(line) => near(fixed, line.point, &|p| line.distance(p)),
            Self::MovingOn(line) => near(moving, line.point, &|p| line.distance(p)),
        }
    }
}

/// Places and conditions that a dyad found keeps agree to this part of the problem's size.
const ON_CONDITION: f64 = 1e-7;
/// Unknowns of a dyad with two pins.
const UNKNOWNS: usize = 4;

/// All real dyads that guide a body through poses and keep conditions: those with two pins, and where a pivot lies at infinity those with
/// a slider. Each pose after the first makes one equation, and there must be four: five poses, four and a line for a pivot, three
/// and a pivot, and so on.
///
/// Moving pivots are points of the body. The order is that of the solutions of a polynomial: the same for the same data, without
/// meaning. About 10 us for five poses.
///
/// # Errors
/// Poses that are too few or too many for the conditions, not finite, repeated, with turns about one point or (without a given pivot) none;
/// data that leave a dyad free. Data are counted with the poses first. Poses that no real dyad keeps give an empty list.
///
/// # Example
/// ```
/// use kempe_linear::C;
/// use kempe_synthesis::{Dyad, DyadCondition, Pose, dyads};
///
/// // Han's three poses (12, 6, 20 degrees), (20, 18, 55 degrees) from the origin, the body's point (-10, 5).
/// let poses = [(0.0, 0.0, 0.0), (12.0, 6.0, 20.0), (20.0, 18.0, 55.0_f64)]
///     .map(|(x, y, angle)| Pose::new(x, y, angle.to_radians()));
/// let found = dyads(&poses, &[DyadCondition::MovingAt(C::new(-10.0, 5.0))])?;
/// let Dyad::Rr { fixed, length, .. } = found[0].dyad else { unreachable!() };
/// assert!((fixed - C::new(-11.463732405799, 39.178719688102)).norm() < 1e-11);
/// assert!((length - 34.210048115629).abs() < 1e-11);
/// # Ok::<(), kempe_synthesis::SynthesisError>(())
/// ```
pub fn dyads(
    poses: &[Pose],
    conditions: &[DyadCondition],
) -> Result<Vec<DyadSolution>, SynthesisError> {
    let finite = poses.iter().map(Pose::is_finite);
    all_finite(finite.chain(conditions.iter().map(DyadCondition::is_finite)))?;
    let asked: usize = conditions.iter().map(DyadCondition::equations).sum();
    balanced(equations(poses.len(), asked), UNKNOWNS)?;

    let at = |wanted: fn(&DyadCondition) -> Option<C>| conditions.iter().find_map(wanted);
    let fixed = at(|c| match c {
        DyadCondition::FixedAt(point) => Some(*point),
        _ => None,
    });
    let moving = at(|c| match c {
        DyadCondition::MovingAt(point) => Some(*point),
        _ => None,
    });
    if let (Some(fixed), Some(moving), Some(pose)) = (fixed, moving, poses.first()) {
        return Ok(gathered([Dyad::rr(fixed, moving, pose)], poses, 0.0));
    }
    if moving.is_some() {
        let inverse: Vec<Pose> = poses.iter().map(Pose::inverse).collect();
        let conditions: Vec<DyadCondition> =
            conditions.iter().map(DyadCondition::inverse).collect();
        let found = dyads(&inverse, &conditions)?;
        return Ok(gathered(found.iter().map(|d| d.dyad.inverse()), poses, 0.0));
    }
    let problem = Problem::new(poses, conditions)?;
    match fixed {
        Some(fixed) => problem.with_fixed(fixed),
        None => problem.general(),
    }
}

/// A dyad that misses a pose by more than this part of the body's shifts, and this of how far its pivots lie, does not keep it: pivots so
/// far away solve the equations but for rounding.
const KEEPS: f64 = 1e-8;
const ROUNDED: f64 = 1e-14;
/// A pivot lies in a pole where what its place leaves of a row is this part of it.
const IN_POLE: f64 = 1e-12;

/// The equations of poses and conditions: what is asked of a body that has no pose is nothing.
pub(crate) fn equations(poses: usize, asked: usize) -> usize {
    if poses == 0 { 0 } else { poses - 1 + asked }
}

/// The rows of a problem and what they are of.
struct Problem<'a> {
    poses: &'a [Pose],
    conditions: &'a [DyadCondition],
    displacements: Displacements,
    rows: Vec<Row>,
}

impl<'a> Problem<'a> {
    fn new(poses: &'a [Pose], conditions: &'a [DyadCondition]) -> Result<Self, SynthesisError> {
        let displacements = Displacements::new(poses)?;
        let mut rows: Vec<Row> = displacements.rows().collect();
        for condition in conditions {
            match condition {
                DyadCondition::FixedOn(line) => {
                    let (n, at) = (C::i() * line.direction, displacements.seen(line.point));
                    rows.push([-dot(n, at), 0.0, 0.0, n.re, n.im, 0.0, 0.0]);
                }
                DyadCondition::MovingOn(line) => {
                    let n = C::i() * displacements.direction_of_body(line.direction);
                    let at = displacements.seen_of_body(line.point);
                    rows.push([-dot(n, at), n.re, n.im, 0.0, 0.0, 0.0, 0.0]);
                }
                DyadCondition::FixedAt(_) | DyadCondition::MovingAt(_) => {}
            }
        }
        Ok(Self {
            poses,
            conditions,
            displacements,
            rows,
        })
    }

    /// The datum of a row.
    fn dependent(&self, DependentRow(row): DependentRow) -> SynthesisError {
        SynthesisError::Dependent { datum: row + 1 }
    }

    /// A given fixed pivot: all is linear in the moving one.
    fn with_fixed(&self, fixed: C) -> Result<Vec<DyadSolution>, SynthesisError> {
        let g = self.displacements.seen(fixed);
        let length = |row: &[f64]| row.iter().map(|x| x * x).sum::<f64>().sqrt();
        let mut rows = Vec::with_capacity(2);
        for (k, row) in self.rows.iter().enumerate() {
            let left = with_fixed(row, g);
            // In a pole of two poses a link of any kind keeps them both.
            if length(&left) <= IN_POLE * length(row) * (1.0 + g.norm()) {
                return Err(self.dependent(DependentRow(k)));
            }
            rows.push(left);
        }
        let [[w, x, y]] = kernel::<3, 1>(&rows).map_err(|row| self.dependent(row))?;
        let z = C::new(x, y);
        let (of_g, p) = (g.scale(w), z * g.conj());
        let point = [w, x, y, of_g.re, of_g.im, p.re, p.im];
        Ok(self.all([dyad_of(&self.displacements, self.poses, &point)]))
    }

    fn general(&self) -> Result<Vec<DyadSolution>, SynthesisError> {
        self.displacements.must_turn()?;
        let found = plane_dyads(&self.displacements, self.poses, &self.rows)
            .map_err(|row| self.dependent(row))?;
        let Some(found) = found else {
            return Err(SynthesisError::Dependent {
                datum: self.rows.len(),
            });
        };
        Ok(self.all(found.into_iter().map(Some)))
    }

    fn all(&self, found: impl IntoIterator<Item = Option<Dyad>>) -> Vec<DyadSolution> {
        let scale = self.displacements.scale;
        let kept = (found.into_iter().flatten())
            .filter(|dyad| self.conditions.iter().all(|c| c.is_kept(dyad, scale)));
        let mut found = gathered(kept, self.poses, scale);
        let most = KEEPS * self.displacements.size;
        found.retain(|d| d.residual <= most + ROUNDED * d.dyad.reach());
        found
    }
}

/// A point of the plane further from a real one than this, as a part of its size, is no real solution. Those of a double one are
/// complex by the root of rounding.
const NEARLY_REAL: f64 = 1e-5;
/// The rows of a solution vanish to this part of their size and its.
const SOLVED: f64 = 1e-12;

/// The real dyads whose products four rows take to zero, as often as each counts; `None` where there are infinitely many.
fn plane_dyads(
    displacements: &Displacements,
    poses: &[Pose],
    rows: &[Row],
) -> Result<Option<Vec<Dyad>>, DependentRow> {
    let basis = kernel::<7, 3>(rows)?;
    let [first, second] = forms(&basis);
    let Some(points) = meet(&first, &second) else {
        return Ok(None);
    };
    let rows: Vec<Row> = (rows.iter())
        .map(|row| {
            let length = row.iter().map(|x| x * x).sum::<f64>().sqrt();
            row.map(|x| x / length)
        })
        .collect();
    let real = points.iter().filter_map(|point| {
        let (point, unreal) = nearest_real(point)?;
        let at: Row = std::array::from_fn(|k| (0..3).map(|b| point[b] * basis[b][k]).sum());
        if unreal > NEARLY_REAL {
            return None;
        }
        let at = improved(&rows, at, unreal);
        let size = at.iter().map(|x| x * x).sum::<f64>().sqrt();
        let left = residual(&rows, &at);
        let products = (C::new(at[1], at[2]) * C::new(at[3], at[4]).conj()
            - C::new(at[5], at[6]).scale(at[0]))
        .norm()
            / (size * size);
        (left <= SOLVED && products <= SOLVED)
            .then(|| dyad_of(displacements, poses, &at))
            .flatten()
    });
    Ok(Some(real.collect()))
}

/// The real and the imaginary part of w p - z conj(g) on the plane.
fn forms(basis: &[Row; 3]) -> [Form; 2] {
    let mut forms = [[[0.0; 3]; 3]; 2];
    for i in 0..3 {
        for j in 0..3 {
            let (a, b) = (&basis[i], &basis[j]);
            let half = |a: &Row, b: &Row| {
                [
                    a[0] * b[5] - a[1] * b[3] - a[2] * b[4],
                    a[0] * b[6] - a[2] * b[3] + a[1] * b[4],
                ]
            };
            let (one, other) = (half(a, b), half(b, a));
            for k in 0..2 {
                forms[k][i][j] = 0.5 * (one[k] + other[k]);
            }
        }
    }
    forms
}

/// A homogeneous point without its phase: its real part, of length 1, and how large the imaginary one is beside it.
fn nearest_real(point: &[C; 3]) -> Option<([f64; 3], f64)> {
    let largest = (point.iter()).max_by(|a, b| a.norm_sqr().total_cmp(&b.norm_sqr()))?;
    let phase = largest.recip();
    let turned = point.map(|x| x * phase);
    let real = turned.map(|x| x.re);
    let length = real.iter().map(|x| x * x).sum::<f64>().sqrt();
    let unreal = turned.iter().map(|x| x.im * x.im).sum::<f64>().sqrt() / length;
    (length.is_finite() && unreal.is_finite()).then(|| (real.map(|x| x / length), unreal))
}

/// A first step of Newton's method longer than this part of the pivots' size leads to another solution.
const FIRST_STEP: f64 = 1e-5;

/// The moving and the fixed pivot, in which conditions are linear as [`products`] says.
struct Pivots;

impl Products<UNKNOWNS> for Pivots {
    fn products(p: &[f64; UNKNOWNS]) -> Row {
        products(C::new(p[0], p[1]), C::new(p[2], p[3]))
    }

    fn derivatives(row: &Row, p: &[f64; UNKNOWNS]) -> [f64; UNKNOWNS] {
        let [_, zx, zy] = with_fixed(row, C::new(p[2], p[3]));
        let [_, gx, gy] = with_moving(row, C::new(p[0], p[1]));
        [zx, zy, gx, gy]
    }
}

/// A homogeneous point improved in the pivots' coordinates, where these are finite and that helps.
fn improved(rows: &[Row], at: Row, unreal: f64) -> Row {
    let w = at[0];
    let start = [at[1] / w, at[2] / w, at[3] / w, at[4] / w];
    let most = FIRST_STEP + 10.0 * unreal;
    let (pivots, left) = polished::<UNKNOWNS, Pivots>(rows, start, most);
    if left <= residual(rows, &at) {
        Pivots::products(&pivots)
    } else {
        at
    }
}

/// A pivot further away than this, in units of the problem, is tried at infinity.
const FAR: f64 = 1e6;
/// A dyad with a slider that keeps the poses to this part of the body's shifts is one.
const FITS: f64 = 1e-11;

/// The dyad of a homogeneous point (w, z, g, p); `None` where both pivots lie at infinity.
pub(crate) fn dyad_of(displacements: &Displacements, poses: &[Pose], point: &Row) -> Option<Dyad> {
    let w = point[0];
    let (z, g) = (C::new(point[1], point[2]), C::new(point[3], point[4]));
    let p = C::new(point[5], point[6]);
    let (far_z, far_g) = (z.norm(), g.norm());
    if FAR * w.abs() < far_z.max(far_g) {
        let slider = if far_g >= far_z {
            let pin = p * g.conj().recip();
            Dyad::Pr {
                guide: Line {
                    point: displacements.place(pin),
                    direction: C::i() * g.scale(1.0 / far_g),
                },
                moving: displacements.body_point(pin),
            }
        } else {
            let pivot = (p * z.recip()).conj();
            Dyad::Rp {
                fixed: displacements.place(pivot),
                guide: Line {
                    point: displacements.body_point(pivot),
                    direction: displacements.body_direction(C::i() * z.scale(1.0 / far_z)),
                },
            }
        };
        let worst = (poses.iter()).fold(0.0, |m: f64, pose| m.max(slider.residual(pose).abs()));
        let most = FITS * displacements.size + ROUNDED * slider.reach();
        if slider.reach().is_finite() && worst <= most {
            return Some(slider);
        }
    }
    let (z, g) = (z.scale(1.0 / w), g.scale(1.0 / w));
    let (fixed, moving) = (displacements.place(g), displacements.body_point(z));
    (fixed.is_finite() && moving.is_finite()).then(|| Dyad::rr(fixed, moving, &poses[0]))
}
