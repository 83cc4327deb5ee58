//! Convex quadratic programmes, dense: D. Goldfarb and A. Idnani's dual active set method (1983).
//!
//! Beside the variables there are levels. A level is the largest of its rows, and its weight times it is minimised with the rest: so
//! the largest of several pieces, or of several violations, is minimised without a curvature of its own. The programme
//! is not strictly convex in its levels; what makes the method work there all the same is that one active row of each level (its
//! bearer) tells the level, so that every other row of that level counts by its difference to it.

use kempe_linear::{Qr, cholesky};

/// A row is broken from this part of its terms on; less is rounding.
const ROUNDING: f64 = 1e-13;
/// A row of which the active ones leave less than this part depends on them.
const DEPENDENT: f64 = 1e-11;
/// Changes of the active set at most, for every row and variable.
const CHANGES: usize = 20;

/// Minimise `slope . d + d . hessian d / 2 + sum of weights * levels` subject to rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Quadratic {
    /// The matrix by rows, symmetric and positive.
    pub hessian: Vec<f64>,
    /// The linear part.
    pub slope: Vec<f64>,
    /// The weight of every level, positive. Every level needs a row.
    pub weights: Vec<f64>,
    /// What must be kept.
    pub rows: Vec<Row>,
}

/// `normal . d <= limit`, or `normal . d - level <= limit`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Row {
    /// The factors of the variables.
    pub normal: Vec<f64>,
    /// The right side.
    pub limit: f64,
    /// The level that it raises.
    pub level: Option<usize>,
}

/// Where the minimum is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Minimum {
    /// The variables.
    pub step: Vec<f64>,
    /// The levels.
    pub levels: Vec<f64>,
    /// What every row costs, not negative; those of the rows of a level sum to its weight.
    pub multipliers: Vec<f64>,
}

/// Why there is no minimum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoMinimum {
    /// No variables keep all rows.
    Infeasible,
    /// The matrix has no positive pivot, or a level has no row.
    NotConvex,
    /// Rounding keeps the method from its end.
    Stalled,
}

/// The method's state: in coordinates in which the matrix is the unit matrix.
struct State<'a> {
    programme: &'a Quadratic,
    linear: Vec<f64>,
    normals: Vec<Vec<f64>>,
    y: Vec<f64>,
    levels: Vec<f64>,
    /// Active rows and their multipliers.
    active: Vec<(usize, f64)>,
    qr: Qr,
}

/// How a row that becomes active changes the rest, for each unit of its multiplier.
struct Direction {
    /// The change of the variables, with its sign turned.
    away: Vec<f64>,
    /// Of the active multipliers.
    multipliers: Vec<f64>,
}

/// The only minimum.
///
/// # Errors
/// Why there is none.
pub fn minimise(programme: &Quadratic) -> Result<Minimum, NoMinimum> {
    let n = programme.slope.len();
    let factor = cholesky(&programme.hessian, n).map_err(|_| NoMinimum::NotConvex)?;
    let turned = |v: &[f64]| forward(&factor, v);
    let mut state = State {
        programme,
        linear: turned(&programme.slope),
        normals: programme.rows.iter().map(|r| turned(&r.normal)).collect(),
        y: vec![0.0; n],
        levels: vec![0.0; programme.weights.len()],
        active: Vec::new(),
        qr: Qr::with_capacity(n, n),
    };
    state.begin()?;
    for _ in 0..CHANGES * (n + programme.rows.len()) + CHANGES {
        let Some(row) = state.most_broken() else {
            return Ok(state.answer(&factor));
        };
        state.keep(row)?;
    }
    Err(NoMinimum::Stalled)
}

impl State<'_> {
    /// The minimum where every level has one bearer: its row of the largest value at the start.
    fn begin(&mut self) -> Result<(), NoMinimum> {
        for (level, weight) in self.programme.weights.iter().enumerate() {
            let rows = self.programme.rows.iter().enumerate();
            let own = rows.filter(|(_, r)| r.level == Some(level));
            let bearer = own.min_by(|a, b| a.1.limit.total_cmp(&b.1.limit));
            let (bearer, _) = bearer.ok_or(NoMinimum::NotConvex)?;
            self.active.push((bearer, *weight));
        }
        self.settle();
        Ok(())
    }

    /// The variables that belong to the multipliers, and the levels that their bearers tell.
    fn settle(&mut self) {
        self.y = self.linear.iter().map(|x| -x).collect();
        for (row, multiplier) in &self.active {
            for (y, c) in self.y.iter_mut().zip(&self.normals[*row]) {
                *y -= multiplier * c;
            }
        }
        for level in 0..self.levels.len() {
            if let Some(bearer) = self.bearer(level) {
                let row = self.active[bearer].0;
                self.levels[level] =
                    dot(&self.normals[row], &self.y) - self.programme.rows[row].limit;
            }
        }
    }

    /// The place among the active of the row that bears a level: the one of the largest multiplier.
    fn bearer(&self, level: usize) -> Option<usize> {
        let own = (0..self.active.len())
            .filter(|i| self.programme.rows[self.active[*i].0].level == Some(level));
        own.max_by(|a, b| {
            self.active[*a]
                .1
                .total_cmp(&self.active[*b].1)
                .then(b.cmp(a))
        })
    }

    /// How far a row is broken, and the size of its terms.
    fn excess(&self, row: usize) -> (f64, f64) {
        let (r, c) = (&self.programme.rows[row], &self.normals[row]);
        let level = r.level.map_or(0.0, |k| self.levels[k]);
        let size: f64 = c.iter().zip(&self.y).map(|(a, b)| (a * b).abs()).sum();
        let terms = size + level.abs() + r.limit.abs();
        (dot(c, &self.y) - level - r.limit, terms)
    }

    /// The row that is broken the farthest, as a distance.
    fn most_broken(&self) -> Option<usize> {
        let mut most = None;
        for row in 0..self.programme.rows.len() {
            let (excess, terms) = self.excess(row);
            if !(excess > ROUNDING * terms) || self.active.iter().any(|(i, _)| *i == row) {
                continue;
            }
            let own = dot(&self.normals[row], &self.normals[row]);
            let share = if self.programme.rows[row].level.is_some() {
                1.0
            } else {
                0.0
            };
            let far = excess / (own + share).sqrt().max(f64::MIN_POSITIVE);
            if most.is_none_or(|(_, other)| far > other) {
                most = Some((row, far));
            }
        }
        most.map(|(row, _)| row)
    }

    /// Makes a broken row active, letting go the ones whose multipliers would become negative.
    fn keep(&mut self, row: usize) -> Result<(), NoMinimum> {
        let level = self.programme.rows[row].level;
        let mut own = 0.0;
        for _ in 0..=self.active.len() + self.programme.rows.len() {
            if level.is_some_and(|k| self.bearer(k).is_none()) {
                // It has taken over the whole weight: it tells the level.
                self.active.push((row, own));
                self.settle();
                return Ok(());
            }
            let Direction { away, multipliers } = self.direction(row);
            let square = dot(&away, &away);
            let (excess, _) = self.excess(row);
            let full = if square > 0.0 {
                excess / square
            } else {
                f64::INFINITY
            };
            let mut blocked = None;
            for (i, rate) in multipliers.iter().enumerate() {
                let length = -self.active[i].1 / rate;
                if *rate < 0.0 && blocked.is_none_or(|(_, other)| length < other) {
                    blocked = Some((i, length));
                }
            }
            let length = blocked.map_or(full, |(_, most)| full.min(most));
            if !length.is_finite() {
                return Err(NoMinimum::Infeasible);
            }
            let length = length.max(0.0);
            for (active, rate) in self.active.iter_mut().zip(&multipliers) {
                active.1 = (active.1 + length * rate).max(0.0);
            }
            own += length;
            for k in 0..self.levels.len() {
                if let Some(bearer) = self.bearer(k) {
                    let bearer = self.active[bearer].0;
                    self.levels[k] -= length * dot(&self.normals[bearer], &away);
                }
            }
            for (y, a) in self.y.iter_mut().zip(&away) {
                *y -= length * a;
            }
            match blocked {
                Some((i, most)) if most < full => {
                    self.active.remove(i);
                }
                _ => {
                    self.active.push((row, own));
                    self.settle();
                    return Ok(());
                }
            }
        }
        Err(NoMinimum::Stalled)
    }

    /// What of a row the active ones do not explain, and how their multipliers answer it.
    fn direction(&mut self, row: usize) -> Direction {
        let n = self.y.len();
        let bearers: Vec<Option<usize>> = (0..self.levels.len()).map(|k| self.bearer(k)).collect();
        let bearer_of = |row: usize| self.programme.rows[row].level.and_then(|k| bearers[k]);
        let less_bearer = |row: usize| -> Vec<f64> {
            let mut c = self.normals[row].clone();
            if let Some(bearer) = bearer_of(row) {
                let other = &self.normals[self.active[bearer].0];
                c.iter_mut().zip(other).for_each(|(c, b)| *c -= b);
            }
            c
        };
        let others: Vec<usize> = (0..self.active.len())
            .filter(|i| !bearers.contains(&Some(*i)))
            .collect();
        self.qr.reset(n, others.len());
        for (column, i) in others.iter().enumerate() {
            for (k, c) in less_bearer(self.active[*i].0).into_iter().enumerate() {
                self.qr.add(k, column, c);
            }
        }
        let mut away = less_bearer(row);
        let size = dot(&self.normals[row], &self.normals[row]).max(dot(&away, &away));
        self.qr.factor();
        self.qr.solve(&mut away);
        let mut multipliers = vec![0.0; self.active.len()];
        for (column, i) in others.iter().enumerate() {
            multipliers[*i] = -away[column];
            if let Some(bearer) = bearer_of(self.active[*i].0) {
                multipliers[bearer] += away[column];
            }
        }
        if let Some(bearer) = bearer_of(row) {
            multipliers[bearer] -= 1.0;
        }
        away[..others.len()].fill(0.0);
        self.qr.rotate(&mut away);
        if dot(&away, &away) <= DEPENDENT * DEPENDENT * size {
            away.fill(0.0);
        }
        Direction { away, multipliers }
    }

    /// The answer in the coordinates that were asked.
    fn answer(self, factor: &[f64]) -> Minimum {
        let mut multipliers = vec![0.0; self.programme.rows.len()];
        for (row, multiplier) in &self.active {
            multipliers[*row] = *multiplier;
        }
        Minimum {
            step: backward(factor, &self.y),
            levels: self.levels,
            multipliers,
        }
    }
}

/// `L^-1 v`.
fn forward(l: &[f64], v: &[f64]) -> Vec<f64> {
    let n = v.len();
    let mut x = v.to_vec();
    for i in 0..n {
        let known = dot(&l[i * n..i * n + i], &x[..i]);
        x[i] = (x[i] - known) / l[i * n + i];
    }
    x
}

/// `L^-T v`.
fn backward(l: &[f64], v: &[f64]) -> Vec<f64> {
    let n = v.len();
    let mut x = v.to_vec();
    for i in (0..n).rev() {
        for j in i + 1..n {
            x[i] -= l[j * n + i] * x[j];
        }
        x[i] /= l[i * n + i];
    }
    x
}

/// Sum of products.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
