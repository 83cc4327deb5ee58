//! All assemblies of a block without closed form, by a complete method.
//!
//! In isotropic coordinates (a planar vector as a complex number z and its conjugate as an independent one) every
//! joint of Kempe is linear or *bilinear*: linear in the plain coordinates and linear in the conjugate ones (Wampler,
//! "Solving the kinematics of planar mechanisms", J. Mech. Design 1999). After the linear equations are eliminated a
//! block has d plain and d conjugate unknowns and 2 d bilinear equations, hence at most C(2d, d) isolated solutions:
//! the two-homogeneous Bezout number; for the Assur group of class III with revolute joints that is 6, its exact number
//! of assemblies. Large blocks are loops that share few links, so that most equations feel few of the unknowns. All
//! isolated solutions are reached from a start system of products of linear functions in just these unknowns (Verschelde
//! and Haegemans, "The GBQ-algorithm for constructing start systems of homotopies for polynomial systems", SIAM J.
//! Numer. Anal. 1993), which has a start point, and a path, for every choice of factors that the unknowns can be matched
//! to.

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
/// Most plain unknowns of a block for which paths are counted.
const LARGEST: usize = 8;
/// Complex products that the paths of one search for assemblies may cost in all, some ten seconds of them: the bound
/// is not a time, so that the result is the same everywhere. Paths left over then count as lost.
pub const WORK_LIMIT: f64 = 3e9;
/// Most swaps of dependent and free unknowns.
const SWAPS: usize = 8;
/// Smallest coefficient (lengths in mechanism sizes) by which a dependent unknown is swapped for a free one.
const SWAP_PIVOT: f64 = 0.02;
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
    /// Whether some of these were not followed because [`WORK_LIMIT`] was reached.
    pub exhausted: bool,
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

/// All real solutions of a block. `work` is what is left of [`WORK_LIMIT`]; `told` hears the finished part of the paths and may stop the work.
pub fn all_real_solutions(
    block: &NewtonBlock,
    mechanism: &Mechanism,
    known: &Situation<'_, f64>,
    scale: f64,
    work: &mut f64,
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
    if bilinear.len() != 2 * d || d > LARGEST {
        return Solutions::NotAlgebraic;
    }
    let (solved, system, count) = sparsest(solved, &bilinear, d);
    if count > PATH_LIMIT {
        return Solutions::NotAlgebraic;
    }

    let Some((found, report)) = system.follow_all(work, told) else {
        return Solutions::Stopped;
    };

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

/// The system in the free variables that need the fewest paths, with their number. Which variables are eliminated is
/// a matter of choice: a link's unit length feels only the free links of its own loops, so a good choice leaves most
/// equations with few variables. Dependent and free variables are swapped while that saves paths.
fn sparsest(solved: Vec<Affine>, bilinear: &[Bilinear], d: usize) -> (Vec<Affine>, System, usize) {
    let mut best_solved = solved;
    let mut best = System::new(&best_solved, bilinear, d);
    let mut fewest = best.paths();
    for _ in 0..SWAPS {
        let mut better: Option<(Vec<Affine>, System, usize)> = None;
        for dependent in 0..best_solved.len() {
            for free in 0..d {
                let Some(swapped) = swap(&best_solved, dependent, free) else {
                    continue;
                };
                let system = System::new(&swapped, bilinear, d);
                let now = better.as_ref().map_or(fewest, |b| b.2);
                // Cheap to see: fewer entries are a precondition in practice.
                if system.entries() > best.entries() {
                    continue;
                }
                let count = system.paths();
                if count < now {
                    better = Some((swapped, system, count));
                }
            }
        }
        match better {
            Some((solved, system, count)) => (best_solved, best, fewest) = (solved, system, count),
            None => break,
        }
    }
    (best_solved, best, fewest)
}

/// Makes variable `dependent` the free variable number `free`; `None` where it is free already or hardly depends on it.
fn swap(solved: &[Affine], dependent: usize, free: usize) -> Option<Vec<Affine>> {
    let d = solved[dependent].0.len() - 1;
    let row = &solved[dependent].0;
    let is_free =
        row[d] == C::zero() && row[..d].iter().filter(|c| c.norm_sqr() > 0.0).count() == 1;
    let pivot = row[free];
    if is_free || pivot.norm_sqr() < SWAP_PIVOT * SWAP_PIVOT {
        return None;
    }
    // dependent = sum a_j y_j + c  =>  y_free = (dependent - sum of the others - c) / a_free.
    let inverse = pivot.recip();
    let mut y: Vec<Affine> = (0..d)
        .map(|j| {
            let mut f = Affine::constant(d, C::zero());
            f.add(j, C::one());
            f
        })
        .collect();
    y[free] = Affine(
        (row.iter().enumerate())
            .map(|(j, c)| if j == free { inverse } else { -(*c * inverse) })
            .collect(),
    );
    Some(solved.iter().map(|f| f.substitute(&y).cleaned()).collect())
}

/// 2 d bilinear equations in d plain and d conjugate unknowns.
struct System {
    d: usize,
    target: Vec<Bilinear>,
    /// Bits of the unknowns that the plain and the conjugate factors of every equation feel.
    supports: Vec<[u32; 2]>,
}

/// The product start system, one pair of linear factors per equation, each in the unknowns that the equation feels.
struct Start {
    gamma: C,
    plain: Vec<Affine>,
    conjugate: Vec<Affine>,
}

/// How carefully a path is followed.
#[derive(Clone, Copy)]
struct Care {
    /// Largest first correction, as a part of the unknowns' size: beyond it another path may be near.
    correction: f64,
    /// Largest growth of a step.
    growth: f64,
}

/// Points passed that the predictor looks back to.
const MEMORY: usize = 3;
/// Steps after which a path is given up.
const STEPS: usize = 20_000;
/// First correction aimed at, as a part of the largest.
const AIM: f64 = 0.2;

/// The usual care, and that for paths that were lost or met another.
const CARES: [Care; 2] = [
    Care {
        correction: 1e-4,
        growth: 2.0,
    },
    Care {
        correction: 1e-7,
        growth: 1.2,
    },
];

impl System {
    fn new(solved: &[Affine], bilinear: &[Bilinear], d: usize) -> Self {
        let conjugate: Vec<Affine> = solved.iter().map(Affine::conj).collect();
        let target: Vec<Bilinear> = bilinear
            .iter()
            .map(|e| {
                let terms = e.0.iter().map(|(l, r)| {
                    (
                        l.substitute(solved).cleaned(),
                        r.substitute(&conjugate).cleaned(),
                    )
                });
                Bilinear(terms.collect())
            })
            .collect();
        let bits = |f: &Affine| {
            let felt = f.0[..d]
                .iter()
                .enumerate()
                .filter(|(_, c)| c.norm_sqr() > 0.0);
            felt.fold(0_u32, |bits, (j, _)| bits | 1 << j)
        };
        let supports = target
            .iter()
            .map(|e| {
                (e.0.iter()).fold([0, 0], |[l, r], (left, right)| {
                    [l | bits(left), r | bits(right)]
                })
            })
            .collect();
        Self {
            d,
            target,
            supports,
        }
    }

    fn entries(&self) -> u32 {
        self.supports
            .iter()
            .map(|[l, r]| l.count_ones() + r.count_ones())
            .sum()
    }

    /// How many start points there are.
    fn paths(&self) -> usize {
        subsets(2 * self.d, self.d)
            .iter()
            .filter(|s| self.is_start(s))
            .count()
    }

    /// Whether the factors chosen by a subset of the equations have a common zero: with random coefficients, if the
    /// unknowns can be matched to them.
    fn is_start(&self, subset: &[bool]) -> bool {
        [(0, true), (1, false)].into_iter().all(|(group, wanted)| {
            let chosen = self
                .supports
                .iter()
                .zip(subset)
                .filter(|(_, s)| **s == wanted);
            matches_all(chosen.map(|(support, _)| support[group]), self.d)
        })
    }

    /// Follows every path and returns the distinct regular end points with what the paths did; `None` when stopped.
    fn follow_all(
        &self,
        work: &mut f64,
        told: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Option<(Vec<Vec<C>>, PathReport)> {
        let d = self.d;
        let n = 2 * d;
        let mut random = Random(0xd134_2543_de82_ef95);
        let mut factor = |support: u32| {
            let mut f = Affine((0..=d).map(|_| random.unit()).collect());
            for (j, c) in f.0[..d].iter_mut().enumerate() {
                if support >> j & 1 == 0 {
                    *c = C::zero();
                }
            }
            f
        };
        let start = Start {
            plain: self.supports.iter().map(|s| factor(s[0])).collect(),
            conjugate: self.supports.iter().map(|s| factor(s[1])).collect(),
            gamma: random.unit(),
        };
        let subsets: Vec<Vec<bool>> = subsets(n, d)
            .into_iter()
            .filter(|s| self.is_start(s))
            .collect();
        let mut tracker = Tracker::new(self, &start);
        let mut ends: Vec<End> = Vec::with_capacity(subsets.len());
        let follow = |tracker: &mut Tracker, subset: &[bool], care: Care, work: &mut f64| {
            match self.start_point(&start, subset) {
                Some(x) if *work > 0.0 => {
                    let before = tracker.solves;
                    let end = tracker.follow(x, care);
                    // A solve costs about n^3 / 3 products.
                    *work -= (tracker.solves - before) as f64 * (n * n * n) as f64 / 3.0;
                    end
                }
                _ => End::Lost,
            }
        };
        for (done, subset) in subsets.iter().enumerate() {
            told(done as f64 / subsets.len() as f64).continue_value()?;
            ends.push(follow(&mut tracker, subset, CARES[0], work));
        }
        // Paths that were lost, and all that ended at one point, are followed again with more care.
        let again: Vec<usize> = (0..ends.len())
            .filter(|&i| match &ends[i] {
                End::Lost => true,
                End::Infinite => false,
                End::Finite(x) => (0..ends.len())
                    .any(|j| j != i && matches!(&ends[j], End::Finite(y) if is_same(x, y))),
            })
            .collect();
        for i in again {
            told(1.0).continue_value()?;
            ends[i] = follow(&mut tracker, &subsets[i], CARES[1], work);
        }
        let mut report = PathReport {
            paths: subsets.len(),
            exhausted: *work <= 0.0,
            ..PathReport::default()
        };
        let mut found: Vec<Vec<C>> = Vec::new();
        for end in ends {
            match end {
                End::Infinite => report.infinite += 1,
                End::Lost => report.lost += 1,
                // Two paths at one point: a multiple solution, or a path that jumped.
                End::Finite(x) if found.iter().any(|y| is_same(&x, y)) => report.lost += 1,
                End::Finite(x) => found.push(x),
            }
        }
        report.finite = found.len();
        Some((found, report))
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
}

/// Whether `d` unknowns can be matched one to one to functions that feel the unknowns of their bits.
fn matches_all(supports: impl Iterator<Item = u32>, d: usize) -> bool {
    fn place(
        row: usize,
        rows: &[u32; LARGEST],
        owner: &mut [usize; LARGEST],
        seen: &mut u32,
    ) -> bool {
        let mut open = rows[row] & !*seen;
        while open != 0 {
            let column = open.trailing_zeros() as usize;
            *seen |= 1 << column;
            if owner[column] == usize::MAX || place(owner[column], rows, owner, seen) {
                owner[column] = row;
                return true;
            }
            open = rows[row] & !*seen;
        }
        false
    }
    let mut rows = [0; LARGEST];
    let mut count = 0;
    for support in supports {
        rows[count] = support;
        count += 1;
    }
    let mut owner = [usize::MAX; LARGEST];
    count == d && (0..count).all(|row| place(row, &rows, &mut owner, &mut 0))
}

fn is_same(x: &[C], y: &[C]) -> bool {
    (x.iter().zip(y)).all(|(a, b)| (*a - *b).norm() < 1e-6 * (1.0 + a.norm()))
}

/// An affine function by its entries that are not zero.
struct Sparse {
    entries: Vec<(usize, C)>,
    constant: C,
}

impl Sparse {
    fn of(f: &Affine, shift: usize) -> Self {
        let n = f.0.len() - 1;
        let entries = f.0[..n]
            .iter()
            .enumerate()
            .filter(|(_, c)| c.norm_sqr() > 0.0);
        Self {
            entries: entries.map(|(j, c)| (j + shift, *c)).collect(),
            constant: f.0[n],
        }
    }

    fn value(&self, x: &[C]) -> C {
        (self.entries.iter()).fold(self.constant, |sum, (j, c)| sum + *c * x[*j])
    }
}

/// Follows the paths of H = (1 - t) gamma G + t F.
struct Tracker {
    n: usize,
    start: Vec<(Sparse, Sparse)>,
    target: Vec<Vec<(Sparse, Sparse)>>,
    gamma: C,
    h: Vec<C>,
    jacobian: Vec<C>,
    to_t: Vec<C>,
    solves: usize,
}

impl Tracker {
    fn new(system: &System, start: &Start) -> Self {
        let (d, n) = (system.d, 2 * system.d);
        let pair = |l: &Affine, r: &Affine| (Sparse::of(l, 0), Sparse::of(r, d));
        Self {
            n,
            start: (start.plain.iter().zip(&start.conjugate))
                .map(|(l, r)| pair(l, r))
                .collect(),
            target: (system.target.iter())
                .map(|e| e.0.iter().map(|(l, r)| pair(l, r)).collect())
                .collect(),
            gamma: start.gamma,
            h: vec![C::zero(); n],
            jacobian: vec![C::zero(); n * n],
            to_t: vec![C::zero(); n],
            solves: 0,
        }
    }

    /// Value, Jacobian (row-major) and derivative to t.
    fn evaluate(&mut self, x: &[C], t: f64) {
        let n = self.n;
        self.jacobian.fill(C::zero());
        let weight = self.gamma * (1.0 - t);
        for k in 0..n {
            let row = &mut self.jacobian[k * n..(k + 1) * n];
            let (left, right) = &self.start[k];
            let (p, q) = (left.value(x), right.value(x));
            let g = self.gamma * p * q;
            for (j, c) in &left.entries {
                row[*j] += weight * q * *c;
            }
            for (j, c) in &right.entries {
                row[*j] += weight * p * *c;
            }
            let mut f = C::zero();
            for (left, right) in &self.target[k] {
                let (l, r) = (left.value(x), right.value(x));
                f += l * r;
                for (j, c) in &left.entries {
                    row[*j] += r * *c * t;
                }
                for (j, c) in &right.entries {
                    row[*j] += l * *c * t;
                }
            }
            self.h[k] = g * (1.0 - t) + f * t;
            self.to_t[k] = f - g;
        }
    }

    fn tangent(&mut self, x: &[C], t: f64) -> Option<Vec<C>> {
        self.evaluate(x, t);
        self.solves += 1;
        let mut rhs: Vec<C> = self.to_t.iter().map(|c| -*c).collect();
        solve(&mut self.jacobian, &mut rhs, self.n).then_some(rhs)
    }

    /// A step of the classical fourth-order rule: how a path begins.
    fn runge_kutta(&mut self, x: &[C], k1: &[C], t: f64, step: f64) -> Option<Vec<C>> {
        let ahead = |k: &[C], f: f64| -> Vec<C> {
            x.iter().zip(k).map(|(a, b)| *a + *b * (step * f)).collect()
        };
        let k2 = self.tangent(&ahead(k1, 0.5), t + 0.5 * step)?;
        let k3 = self.tangent(&ahead(&k2, 0.5), t + 0.5 * step)?;
        let k4 = self.tangent(&ahead(&k3, 1.0), t + step)?;
        Some(
            (0..self.n)
                .map(|i| x[i] + (k1[i] + (k2[i] + k3[i]) * 2.0 + k4[i]) * (step / 6.0))
                .collect(),
        )
    }

    /// Newton's method at fixed t; the first correction. `None` when it is too large (the path may have been left for
    /// another) or the corrections do not shrink.
    fn correct(&mut self, x: &mut [C], t: f64, care: Care) -> Option<f64> {
        const CORRECTIONS: usize = 3;
        let (mut first, mut last) = (0.0, f64::INFINITY);
        for round in 0..CORRECTIONS {
            self.evaluate(x, t);
            self.solves += 1;
            if !solve(&mut self.jacobian, &mut self.h, self.n) {
                return None;
            }
            for (a, b) in x.iter_mut().zip(&self.h) {
                *a -= *b;
            }
            let change = largest(&self.h) / (1.0 + largest(x));
            if !change.is_finite()
                || (round == 0 && change > care.correction)
                || (round > 0 && change > last)
            {
                return None;
            }
            if round == 0 {
                first = change;
            }
            last = change;
            if change < 1e-10 {
                return Some(first);
            }
        }
        None
    }

    /// Follows one path from t = 0 to 1.
    fn follow(&mut self, start: Vec<C>, care: Care) -> End {
        let mut step = 0.02_f64;
        let Some(slope) = self.tangent(&start, 0.0) else {
            return End::Lost;
        };
        let mut passed = vec![Passed {
            t: 0.0,
            x: start,
            slope,
        }];
        for _ in 0..STEPS {
            let Some(here) = passed.last() else { break };
            let t = here.t;
            let now = step.min(1.0 - t);
            let predicted = match passed.as_slice() {
                [first] => self.runge_kutta(&first.x, &first.slope, t, now),
                several => Some(extrapolate(several, t + now)),
            };
            let corrected = predicted.and_then(|mut next| {
                let first = self.correct(&mut next, t + now, care)?;
                Some((next, first))
            });
            let Some((x, first)) = corrected else {
                step = now * 0.4;
                // What lies far back does not help where the path bends.
                passed.drain(..passed.len().saturating_sub(2));
                if step < 1e-12 {
                    break;
                }
                continue;
            };
            if largest(&x) > INFINITY {
                return End::Infinite;
            }
            // The last step may end short of 1 by a rounding error.
            if (1.0 - (t + now)).abs() < f64::EPSILON {
                return End::Finite(x);
            }
            // The predictor's error goes with the power of the step that the points passed give.
            let order = 1.0 / (2 * passed.len().max(2)) as f64;
            let room = AIM * care.correction / first.max(f64::MIN_POSITIVE);
            step = now * math::exp(order * math::ln(room)).clamp(0.3, care.growth);
            let Some(slope) = self.tangent(&x, t + now) else {
                break;
            };
            if passed.len() == MEMORY {
                passed.remove(0);
            }
            passed.push(Passed {
                t: t + now,
                x,
                slope,
            });
        }
        // A path that runs away slows down as it grows.
        if passed.last().is_some_and(|here| largest(&here.x) > 1e3) {
            End::Infinite
        } else {
            End::Lost
        }
    }
}

fn largest(v: &[C]) -> f64 {
    v.iter().map(|c| c.norm_sqr()).fold(0.0, f64::max).sqrt()
}

/// A point of a path with its tangent.
struct Passed {
    t: f64,
    x: Vec<C>,
    slope: Vec<C>,
}

/// The polynomial through the points passed with their tangents (Hermite, by divided differences), a step further.
fn extrapolate(passed: &[Passed], t: f64) -> Vec<C> {
    let count = 2 * passed.len();
    let at = |i: usize| passed[i / 2].t;
    // Products (t - t_0)(t - t_0)(t - t_1)... in front of the differences.
    let mut factors = [1.0; 2 * MEMORY];
    for i in 1..count {
        factors[i] = factors[i - 1] * (t - at(i - 1));
    }
    let width = passed.first().map_or(0, |p| p.x.len());
    (0..width)
        .map(|k| {
            let mut table = [C::zero(); 2 * MEMORY];
            for (i, entry) in table[..count].iter_mut().enumerate() {
                *entry = passed[i / 2].x[k];
            }
            let mut sum = table[0];
            for order in 1..count {
                for i in 0..count - order {
                    table[i] = if order == 1 && i % 2 == 0 {
                        passed[i / 2].slope[k]
                    } else {
                        (table[i + 1] - table[i]) * (1.0 / (at(i + order) - at(i)))
                    };
                }
                sum += table[0] * factors[order];
            }
            sum
        })
        .collect()
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
