//! All assemblies of a block without closed form, by a complete method.
//!
//! In isotropic coordinates (a planar vector as a complex number z and its conjugate as an independent one) every
//! joint of Kempe is linear or *bilinear*: linear in the plain coordinates and linear in the conjugate ones (Wampler,
//! "Solving the kinematics of planar mechanisms", J. Mech. Design 1999). After the linear equations are eliminated a
//! block has d plain and d conjugate unknowns and 2 d bilinear equations, hence at most C(2d, d) isolated solutions:
//! the two-homogeneous Bezout number. All of them are reached by as many paths from a product start system; for the
//! Assur group of class III with revolute joints that is 6, its exact number of assemblies.

use std::ops::ControlFlow;

use kempe_number::{Complex, math};

use crate::blocks::Unknown;
use crate::complex_linear::{Affine, C, eliminate, solve};
use crate::constraint::Situation;
use crate::mechanism::{BodyId, Constraint, LineRef, Marker, Mechanism};
use crate::plan::NewtonBlock;
use crate::pose::Pose;

/// Largest number of paths followed; a block that needs more is searched from many starts instead.
pub const PATH_LIMIT: usize = 3432;
/// Size of the unknowns (in units of the mechanism) beyond which a path counts as gone to infinity.
const INFINITY: f64 = 1e7;
/// Imaginary part below which an end point counts as real.
const REAL: f64 = 1e-7;

/// What the paths found.
#[derive(Clone, Debug, Default)]
pub struct PathReport {
    /// How many paths were followed.
    pub paths: usize,
    /// How many ended at a regular finite solution, real or not.
    pub finite: usize,
    /// How many went to infinity.
    pub infinite: usize,
    /// How many could not be followed to the end.
    pub lost: usize,
}

/// A bilinear equation: the sum of products of a plain and a conjugate affine function.
#[derive(Clone, Debug)]
struct Bilinear(Vec<(Affine, Affine)>);

struct Builder<'a> {
    block: &'a NewtonBlock,
    mechanism: &'a Mechanism,
    known: &'a Situation<'a, f64>,
    scale: f64,
    variables: usize,
}

impl Builder<'_> {
    fn variable(&self, unknown: Unknown) -> Option<usize> {
        self.block.unknowns.iter().position(|u| *u == unknown)
    }

    /// Direction of a body as an affine function.
    fn direction(&self, body: BodyId) -> Affine {
        let pose = &self.known.poses[body.index()];
        match (body != BodyId::GROUND)
            .then(|| self.variable(Unknown::Angle(body)))
            .flatten()
        {
            Some(variable) => {
                let mut f = Affine::constant(self.variables, C::zero());
                f.add(variable, C::one());
                f
            }
            None => Affine::constant(self.variables, Complex::new(pose.c, pose.s)),
        }
    }

    /// A vector of a body.
    fn vector(&self, body: BodyId, local: [f64; 2], unit: f64) -> Affine {
        let local = Complex::new(local[0] / unit, local[1] / unit);
        Affine(
            self.direction(body)
                .0
                .into_iter()
                .map(|c| c * local)
                .collect(),
        )
    }

    /// A point of a body, in units of the scale.
    fn point(&self, body: BodyId, local: [f64; 2]) -> Affine {
        let mut f = self.vector(body, local, self.scale);
        let pose = &self.known.poses[body.index()];
        match (body != BodyId::GROUND)
            .then(|| self.variable(Unknown::Place(body)))
            .flatten()
        {
            Some(variable) => f.add(variable, C::one()),
            None => f.add_constant(Complex::new(pose.x / self.scale, pose.y / self.scale)),
        }
        f
    }

    fn marker(&self, marker: Marker) -> Affine {
        self.point(marker.body, self.known.geometry.marker(marker))
    }

    /// Direction of a line, and the vector from its origin to a point.
    fn along(&self, line: LineRef, point: Marker) -> (Affine, Affine) {
        let local = self.known.geometry.line(line);
        let origin = self.point(line.body, local.origin);
        (
            self.vector(line.body, local.direction, 1.0),
            self.marker(point).minus(&origin),
        )
    }

    fn one(&self) -> Affine {
        Affine::constant(self.variables, C::one())
    }

    fn number(&self, value: f64) -> Affine {
        Affine::constant(self.variables, Complex::new(value, 0.0))
    }
}

/// The block's equations, or `None` when it holds a joint that is not algebraic in these coordinates (gears, racks).
fn equations(b: &Builder<'_>) -> Option<(Vec<Affine>, Vec<Bilinear>)> {
    let mut linear = Vec::new();
    let mut bilinear = Vec::new();
    let mut tied: Vec<BodyId> = Vec::new();
    for (place, row) in b.block.rows[..b.block.size].iter().enumerate() {
        let rows = &b.block.rows[..b.block.size];
        let both = rows
            .iter()
            .filter(|r| r.constraint == row.constraint)
            .count()
            == 2;
        if rows[..place].iter().any(|r| r.constraint == row.constraint) {
            continue;
        }
        match b.mechanism.constraints[row.constraint].0 {
            Constraint::Coincide { a, b: c } => {
                let gap = b.marker(c).minus(&b.marker(a));
                if both {
                    linear.push(gap);
                } else {
                    // One row only: real or imaginary part, gap -/+ conjugate gap.
                    let sign = if row.row == 0 { 1.0 } else { -1.0 };
                    let conjugate = gap.conj();
                    bilinear.push(Bilinear(vec![(gap, b.one()), (b.number(sign), conjugate)]));
                }
            }
            Constraint::Direction {
                a,
                b: from,
                offset,
                input,
            } => {
                // u_a = u_b * turn: linear, and it replaces the unit-length equation of one body.
                let mut by = b.known.geometry.angles[offset as usize];
                if let Some(drive) = input {
                    let q = &b.known.inputs[drive.index()];
                    by = [by[0] * q.c - by[1] * q.s, by[1] * q.c + by[0] * q.s];
                }
                linear.push(b.direction(a).minus(&b.vector(from, by, 1.0)));
                let of = [a, from].into_iter().find(|body| {
                    *body != BodyId::GROUND
                        && b.variable(Unknown::Angle(*body)).is_some()
                        && !tied.contains(body)
                })?;
                tied.push(of);
            }
            Constraint::OnLine { point, line } => {
                let (t, w) = b.along(line, point);
                let minus = Affine(t.0.iter().map(|c| -*c).collect());
                bilinear.push(Bilinear(vec![(w.clone(), t.conj()), (minus, w.conj())]));
            }
            Constraint::Travel { point, line, input } => {
                let (t, w) = b.along(line, point);
                let q = b.known.inputs[input.index()].value / b.scale;
                let terms = vec![
                    (w.clone(), t.conj()),
                    (t, w.conj()),
                    (b.number(-2.0 * q), b.one()),
                ];
                bilinear.push(Bilinear(terms));
            }
            Constraint::Distance { a, b: c, input } => {
                let w = b.marker(c).minus(&b.marker(a));
                let q = b.known.inputs[input.index()].value / b.scale;
                bilinear.push(Bilinear(vec![
                    (w.clone(), w.conj()),
                    (b.number(-q * q), b.one()),
                ]));
            }
            Constraint::Gears { .. } | Constraint::Rack { .. } => return None,
        }
    }
    for unknown in &b.block.unknowns {
        if let Unknown::Angle(body) = unknown
            && !tied.contains(body)
        {
            let u = b.direction(*body);
            bilinear.push(Bilinear(vec![
                (u.clone(), u.conj()),
                (b.number(-1.0), b.one()),
            ]));
        }
    }
    Some((linear, bilinear))
}

/// What the complete method came to.
#[derive(Clone, Debug)]
pub enum Solutions {
    /// Poses of the block's bodies for every real solution, not yet polished; bodies outside the block keep theirs.
    Found(Vec<Vec<Pose<f64>>>, PathReport),
    /// It does not apply: a gear or rack inside the block, or too many paths.
    NotAlgebraic,
    /// It was stopped on the way.
    Stopped,
}

/// All real solutions of a block. `told` hears the finished part of the paths and may stop the work.
pub fn all_real_solutions(
    block: &NewtonBlock,
    mechanism: &Mechanism,
    known: &Situation<'_, f64>,
    scale: f64,
    told: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Solutions {
    let builder = Builder {
        block,
        mechanism,
        known,
        scale,
        variables: block.unknowns.len(),
    };
    let Some((linear, bilinear)) = equations(&builder) else {
        return Solutions::NotAlgebraic;
    };
    let Some(solved) = eliminate(&linear, builder.variables) else {
        return Solutions::Found(Vec::new(), PathReport::default());
    };
    let d = solved.first().map_or(0, |f| f.0.len() - 1);
    if bilinear.len() != 2 * d || choose(2 * d, d) > PATH_LIMIT {
        return Solutions::NotAlgebraic;
    }
    let conjugate: Vec<Affine> = solved.iter().map(Affine::conj).collect();
    let system = System {
        d,
        target: (bilinear.into_iter())
            .map(|e| {
                let terms = e.0.into_iter();
                Bilinear(
                    terms
                        .map(|(l, r)| (l.substitute(&solved), r.substitute(&conjugate)))
                        .collect(),
                )
            })
            .collect(),
    };

    // Two different start systems: a path that one loses the other usually finds, and agreement is evidence.
    let mut report = PathReport::default();
    let mut found: Vec<Vec<C>> = Vec::new();
    for seed in 0..2 {
        let mut this = PathReport::default();
        let Some(ends) = system.follow_all(seed, &mut this, told) else {
            return Solutions::Stopped;
        };
        for end in ends {
            let is_new = |x: &Vec<C>| {
                let gap = x
                    .iter()
                    .zip(&end)
                    .map(|(a, b)| (*a - *b).norm_sqr())
                    .fold(0.0, f64::max);
                gap > 1e-12
            };
            if found.iter().all(is_new) {
                found.push(end);
            }
        }
        let better = seed == 0 || this.lost < report.lost;
        if better {
            report = this;
        }
        if report.lost == 0 && found.len() == report.finite {
            break;
        }
    }
    report.finite = found.len();

    let mut poses = Vec::new();
    for x in &found {
        let (y, hat) = x.split_at(d);
        let real = y
            .iter()
            .zip(hat)
            .all(|(a, b)| (*b - a.conj()).norm() <= REAL * (1.0 + a.norm()));
        if !real {
            continue;
        }
        let mut pose = known.poses.to_vec();
        for (unknown, f) in block.unknowns.iter().zip(&solved) {
            let z = f.value(y);
            let at = &mut pose[unknown.body().index()];
            match unknown {
                Unknown::Angle(_) => {
                    let size = z.norm();
                    (at.c, at.s) = (z.re / size, z.im / size);
                }
                Unknown::Place(_) => (at.x, at.y) = (z.re * scale, z.im * scale),
            }
        }
        poses.push(pose);
    }
    Solutions::Found(poses, report)
}

fn choose(n: usize, k: usize) -> usize {
    (0..k).fold(1_usize, |c, i| c.saturating_mul(n - i) / (i + 1))
}

/// 2 d bilinear equations in d plain and d conjugate unknowns.
struct System {
    d: usize,
    target: Vec<Bilinear>,
}

/// The product start system, one pair of linear factors per equation.
struct Start {
    gamma: C,
    plain: Vec<Affine>,
    conjugate: Vec<Affine>,
}

impl System {
    /// Follows every path of one start system and returns the distinct regular end points; `None` when stopped.
    fn follow_all(
        &self,
        seed: u64,
        report: &mut PathReport,
        told: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Option<Vec<Vec<C>>> {
        let d = self.d;
        let n = 2 * d;
        let mut random =
            Random(0x9e37_79b9_7f4a_7c15 ^ (seed + 1).wrapping_mul(0xd134_2543_de82_ef95));
        let mut factor = || Affine((0..=d).map(|_| random.unit()).collect());
        let start = Start {
            plain: (0..n).map(|_| factor()).collect(),
            conjugate: (0..n).map(|_| factor()).collect(),
            gamma: random.unit(),
        };
        let mut ends: Vec<Vec<C>> = Vec::new();
        let subsets = subsets(n, d);
        for subset in &subsets {
            told(report.paths as f64 / subsets.len() as f64).continue_value()?;
            report.paths += 1;
            let Some(x) = self.start_point(&start, subset) else {
                report.lost += 1;
                continue;
            };
            match self.follow(&start, x) {
                End::Finite(x) => {
                    let same = |y: &Vec<C>| {
                        y.iter()
                            .zip(&x)
                            .all(|(a, b)| (*a - *b).norm() < 1e-6 * (1.0 + a.norm()))
                    };
                    if ends.iter().any(same) {
                        // Two paths at one point: a multiple solution, or a path that jumped.
                        report.lost += 1;
                    } else {
                        report.finite += 1;
                        ends.push(x);
                    }
                }
                End::Infinite => report.infinite += 1,
                End::Lost => report.lost += 1,
            }
        }
        Some(ends)
    }

    fn start_point(&self, start: &Start, subset: &[bool]) -> Option<Vec<C>> {
        let d = self.d;
        let mut x = Vec::with_capacity(2 * d);
        for (factors, wanted) in [(&start.plain, true), (&start.conjugate, false)] {
            let rows = factors
                .iter()
                .zip(subset)
                .filter(|(_, s)| **s == wanted)
                .map(|(f, _)| f);
            let mut a = Vec::with_capacity(d * d);
            let mut b = Vec::with_capacity(d);
            for row in rows {
                a.extend_from_slice(&row.0[..d]);
                b.push(-row.0[d]);
            }
            if !solve(&mut a, &mut b, d) {
                return None;
            }
            x.extend(b);
        }
        Some(x)
    }

    /// Value, Jacobian (row-major) and derivative to t of H = (1 - t) gamma G + t F.
    fn evaluate(
        &self,
        start: &Start,
        x: &[C],
        t: f64,
        h: &mut [C],
        jacobian: &mut [C],
        to_t: &mut [C],
    ) {
        let d = self.d;
        let n = 2 * d;
        let (y, hat) = x.split_at(d);
        for k in 0..n {
            let row = &mut jacobian[k * n..(k + 1) * n];
            row.fill(C::zero());
            let (p, q) = (start.plain[k].value(y), start.conjugate[k].value(hat));
            let g = start.gamma * p * q;
            let weight = start.gamma * (1.0 - t);
            for j in 0..d {
                row[j] += weight * q * start.plain[k].0[j];
                row[d + j] += weight * p * start.conjugate[k].0[j];
            }
            let mut f = C::zero();
            for (left, right) in &self.target[k].0 {
                let (l, r) = (left.value(y), right.value(hat));
                f += l * r;
                for j in 0..d {
                    row[j] += r * left.0[j] * t;
                    row[d + j] += l * right.0[j] * t;
                }
            }
            h[k] = g * (1.0 - t) + f * t;
            to_t[k] = f - g;
        }
    }

    /// Follows one path from t = 0 to 1 with an adaptive fourth-order predictor and Newton's corrector.
    fn follow(&self, start: &Start, mut x: Vec<C>) -> End {
        const CORRECTIONS: usize = 3;
        let n = 2 * self.d;
        let (mut h, mut jacobian, mut to_t) = (
            vec![C::zero(); n],
            vec![C::zero(); n * n],
            vec![C::zero(); n],
        );
        let size = |v: &[C]| v.iter().map(|c| c.norm_sqr()).fold(0.0, f64::max).sqrt();
        let (mut t, mut step) = (0.0, 0.02_f64);
        let mut tangent = |x: &[C], t: f64| {
            self.evaluate(start, x, t, &mut h, &mut jacobian, &mut to_t);
            let mut rhs: Vec<C> = to_t.iter().map(|c| -*c).collect();
            solve(&mut jacobian, &mut rhs, n).then_some(rhs)
        };
        let (mut h2, mut jacobian2, mut unused) = (
            vec![C::zero(); n],
            vec![C::zero(); n * n],
            vec![C::zero(); n],
        );
        for _ in 0..20_000 {
            if t >= 1.0 {
                break;
            }
            let now = step.min(1.0 - t);
            let ahead = |x: &[C], k: &[C], f: f64| -> Vec<C> {
                x.iter().zip(k).map(|(a, b)| *a + *b * (now * f)).collect()
            };
            let predicted = (|| {
                let k1 = tangent(&x, t)?;
                let k2 = tangent(&ahead(&x, &k1, 0.5), t + 0.5 * now)?;
                let k3 = tangent(&ahead(&x, &k2, 0.5), t + 0.5 * now)?;
                let k4 = tangent(&ahead(&x, &k3, 1.0), t + now)?;
                Some(
                    (0..n)
                        .map(|i| x[i] + (k1[i] + (k2[i] + k3[i]) * 2.0 + k4[i]) * (now / 6.0))
                        .collect::<Vec<C>>(),
                )
            })();
            let mut good = false;
            if let Some(mut next) = predicted {
                let target = t + now;
                let mut last = f64::INFINITY;
                for round in 0..CORRECTIONS {
                    self.evaluate(start, &next, target, &mut h2, &mut jacobian2, &mut unused);
                    if !solve(&mut jacobian2, &mut h2, n) {
                        break;
                    }
                    for (a, b) in next.iter_mut().zip(&h2) {
                        *a -= *b;
                    }
                    let change = size(&h2) / (1.0 + size(&next));
                    // The first correction must be small, or the path may have been left for another.
                    if !change.is_finite()
                        || (round == 0 && change > 1e-4)
                        || (round > 0 && change > last)
                    {
                        break;
                    }
                    last = change;
                    if change < 1e-10 {
                        good = true;
                        break;
                    }
                }
                if good {
                    x = next;
                    t = target;
                    step = now * 1.6;
                    if size(&x) > INFINITY {
                        return End::Infinite;
                    }
                    continue;
                }
            }
            step = now * 0.4;
            if step < 1e-12 {
                break;
            }
        }
        if t < 1.0 {
            // A path that runs away slows down as it grows.
            return if size(&x) > 1e3 {
                End::Infinite
            } else {
                End::Lost
            };
        }
        End::Finite(x)
    }
}

enum End {
    Finite(Vec<C>),
    Infinite,
    Lost,
}

/// All ways to mark `d` of `n`.
fn subsets(n: usize, d: usize) -> Vec<Vec<bool>> {
    let mut all = Vec::new();
    let mut chosen: Vec<usize> = (0..d).collect();
    loop {
        let mut marks = vec![false; n];
        for &i in &chosen {
            marks[i] = true;
        }
        all.push(marks);
        let Some(place) = (0..d).rev().find(|&i| chosen[i] < n - d + i) else {
            return all;
        };
        chosen[place] += 1;
        for later in place + 1..d {
            chosen[later] = chosen[later - 1] + 1;
        }
    }
}

/// A small reproducible generator (splitmix64): the start systems must be generic, not secret.
pub(crate) struct Random(pub u64);

impl Random {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A complex number of size between 1/2 and 3/2.
    fn unit(&mut self) -> C {
        let (s, c) = math::sin_cos(self.next() * std::f64::consts::TAU);
        let size = 0.5 + self.next();
        Complex::new(c * size, s * size)
    }
}
