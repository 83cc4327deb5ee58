//! Coordinates of a spanning tree: loops are cut, and ties keep them closed.
//!
//! The coordinates are more than the mechanism has freedoms. Of all states that they can tell those count in which what was cut
//! closes, `c(q, t) = 0`, and goes on closing, `G v + c_t = 0`. Any other state stands for the one of these that is nearest, by Newton's
//! method along the rows of `G` at the state itself: so the equations of motion are smooth functions of all states, and what
//! steps lose of the closures never grows. Accelerations are those that the ties ask for and, in the directions that they leave, those of
//! the forces there: whether ties repeat each other, and which masses move along a coordinate alone, does not matter.

use kempe_dynamics::{Instant, Rates};
use kempe_linear::{Qr, Span};
use kempe_mechanism::constraint::{Constraint, Joint};
use kempe_mechanism::structure::{BodyId, Marker};
use kempe_model::DriveId;
use kempe_number::{Number, math};

use crate::barrier::Gap;
use crate::several::Several;
use crate::vector::dot;

/// Closures are closed where they are off by this part of the mechanism's size, or of 1 rad: rounding.
const CLOSED: f64 = 4.0 * f64::EPSILON;
/// And as closed as they can be where they are off by no more than this and get no nearer.
const NEARLY: f64 = 1e-11;
/// A correction that leaves this part of what was off is no use: derivatives are taken anew.
const SLOW: f64 = 0.3;
/// A row of which this part goes along what ties leave is none.
const NOTHING: f64 = 1e-9;
/// Change points are looked for where ties are so near to repeating each other.
const CLOSE: f64 = 0.1;
/// The power by which a determinant vanishes is a whole number, but for this.
const WHOLE: f64 = 0.1;
/// Corrections, at most.
const CORRECTIONS: usize = 40;

/// How the coordinate of a drive that is let go is known.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Own {
    /// It is one of those of the tree, by its place.
    Coordinate(usize),
    /// The distance of two points.
    Length([Marker; 2]),
    /// How far one body is turned against another, and what is added to that, rad.
    Angle([BodyId; 2], f64),
}

/// What keeps loops closed.
pub(crate) struct Ties {
    constraints: Vec<Constraint>,
    /// The mechanism's size, m.
    size: f64,
    /// What makes their rows comparable: lengths count in mechanism sizes.
    factors: Vec<f64>,
    /// The drives that are let go.
    pub drives: Vec<DriveId>,
    /// How their coordinates are known.
    pub own: Vec<Own>,
    /// Their sizes: 1 rad, or the mechanism's.
    pub sizes: Vec<f64>,
    /// The bodies whose angles tell the place in their stead, along the motion that is found.
    pub pilots: Vec<Option<BodyId>>,
    /// The ties' rows of derivatives to the coordinates, in these' own sizes, and their span.
    rows: Vec<Vec<f64>>,
    span: Span,
    /// By row: derivatives to the drives that keep their laws.
    by_driven: Vec<Vec<f64>>,
    /// By drive that keeps its law: how fast each coordinate goes with it, where nothing else does.
    with_driven: Vec<Vec<f64>>,
    /// Accelerations that the ties ask for at the state last looked at.
    pub asked: Vec<f64>,
    /// The state that was closed last, and its coordinates and speeds then.
    known: Option<(f64, Vec<f64>)>,
    closed: Vec<[f64; 2]>,
    /// How far the closures of that were off, in mechanism sizes or rad.
    pub off: f64,
    /// By drive, how every body turned by what tells the place for it where that was looked at last, and when, s.
    pub turned: Option<(f64, Vec<Vec<f64>>)>,
    /// The drive that told the place poorly where that was looked at last, by its place, with how every body turns by it there.
    pub poor: Option<(usize, Vec<f64>)>,
    /// The most that was taken from a state at the end of a step.
    pub taken: f64,
}

/// What closures are about: the coordinates of the tree with their sizes, and the drives that keep their laws.
pub(crate) struct About<'a> {
    pub free: &'a [DriveId],
    pub driven: &'a [DriveId],
    pub scales: &'a [f64],
}

impl Ties {
    /// Of constraints that were cut in a mechanism of this size.
    pub fn new(
        constraints: Vec<Constraint>,
        (drives, own): (Vec<DriveId>, Vec<Own>),
        sizes: Vec<f64>,
        size: f64,
    ) -> Self {
        let factors = constraints.iter();
        let factors = factors.flat_map(|it| vec![it.unit().factor(size); it.rows()]);
        Self {
            factors: factors.collect(),
            size,
            constraints,
            pilots: vec![None; drives.len()],
            drives,
            own,
            sizes,
            rows: Vec::new(),
            span: Span::default(),
            by_driven: Vec::new(),
            with_driven: Vec::new(),
            asked: Vec::new(),
            known: None,
            closed: Vec::new(),
            off: 0.0,
            poor: None,
            turned: None,
            taken: 0.0,
        }
    }

    /// Puts the nearest state that closes in the place of the coordinates, which are those of the state `y` at a time. `at` gets the
    /// poses and the coefficients there. False where there is none.
    pub fn close(
        &mut self,
        (time, y): (f64, &[f64]),
        about: &About<'_>,
        places: &mut Several,
        coordinates: &mut [Rates],
        at: &mut Instant<f64>,
    ) -> bool {
        let n = about.free.len();
        let told = &y[..2 * n];
        let same =
            (self.known.as_ref()).is_some_and(|(known, state)| *known == time && state == told);
        if !same {
            self.known = None;
            if !self.close_anew(time, about, places, coordinates, at) {
                return false;
            }
            let state = about.free.iter().map(|drive| {
                let q = &coordinates[drive.index()];
                [q.coefficient(0), q.coefficient(1)]
            });
            self.closed = state.collect();
            self.known = Some((time, told.to_vec()));
        }
        for (drive, [q, v]) in about.free.iter().zip(&self.closed) {
            coordinates[drive.index()] = Rates::from_coefficients([*q, *v, 0.0]);
        }
        true
    }

    fn close_anew(
        &mut self,
        time: f64,
        about: &About<'_>,
        places: &mut Several,
        coordinates: &mut [Rates],
        at: &mut Instant<f64>,
    ) -> bool {
        let mut off = self.open(time, places, coordinates);
        let mut size = largest(&off);
        self.off = size;
        if !places.slopes_at(time, coordinates, at) || !size.is_finite() {
            return false;
        }
        self.find_span(time, about, places, at);
        // Of what is flung far rounding is more.
        let far = at.poses.iter().map(|pose| pose.x.abs().max(pose.y.abs()));
        let far = far.fold(self.size, f64::max) / self.size;
        let (closed, nearly) = (CLOSED * far, NEARLY * far);
        let mut fresh = true;
        let mut corrections = 0;
        while size > closed {
            let before: Vec<Rates> = coordinates.to_vec();
            self.shift(&off, about, coordinates, 0);
            off = self.open(time, places, coordinates);
            let now = largest(&off);
            corrections += 1;
            if now > SLOW * size || !now.is_finite() {
                if size <= nearly {
                    // Rounding leaves no more.
                    if !(now < size) {
                        coordinates.copy_from_slice(&before);
                        self.open(time, places, coordinates);
                    }
                    break;
                }
                if fresh && !(now < size) || corrections > CORRECTIONS || !now.is_finite() {
                    return false;
                }
                if !places.slopes_at(time, coordinates, at) {
                    return false;
                }
                self.find_span(time, about, places, at);
                fresh = true;
            } else {
                fresh = false;
            }
            size = now;
        }
        if corrections > 0 {
            if !places.slopes_at(time, coordinates, at) {
                return false;
            }
            self.find_span(time, about, places, at);
        }
        self.close_speeds(about, coordinates, at);
        true
    }

    /// The rows of the ties at these coordinates, comparable.
    fn open(&self, time: f64, places: &mut Several, coordinates: &[Rates]) -> Vec<f64> {
        let rows = places.rows_at(time, coordinates, &self.constraints);
        rows.iter().zip(&self.factors).map(|(x, f)| x * f).collect()
    }

    /// Shifts coordinates (or their speeds, for the coefficient 1) by the least that changes rows by the opposite of these.
    fn shift(
        &self,
        rows: &[f64],
        about: &About<'_>,
        coordinates: &mut [Rates],
        coefficient: usize,
    ) {
        let step = self.span.shortest(rows);
        for ((drive, scale), step) in about.free.iter().zip(about.scales).zip(&step) {
            let q = &mut coordinates[drive.index()];
            let mut all = *q.coefficients();
            all[coefficient] -= scale * step;
            *q = Rates::from_coefficients(all);
        }
    }

    /// Finds the span of the ties' rows where poses and coefficients are known.
    fn find_span(&mut self, time: f64, about: &About<'_>, places: &Several, at: &Instant<f64>) {
        (self.rows, self.by_driven) = self.derivatives(time, about, places, at);
        self.span = Span::of(&self.rows, about.free.len());
    }

    /// The derivatives of the ties' rows to the coordinates, in these' own sizes, and to drives that keep laws, where poses and coefficients
    /// are known.
    fn derivatives(
        &self,
        time: f64,
        about: &About<'_>,
        places: &Several,
        at: &Instant<f64>,
    ) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
        let mut rows = vec![vec![0.0; about.free.len()]; self.factors.len()];
        let mut by_driven = vec![vec![0.0; about.driven.len()]; self.factors.len()];
        let factors = &self.factors;
        let to_body = |row: usize, body: BodyId, to: [f64; 3]| {
            let along = |drive: &DriveId| {
                let k = at.coefficients[drive.index()][body.index()];
                factors[row] * (to[0] * k[0] + to[1] * k[1] + to[2] * k[2])
            };
            let own = rows[row].iter_mut().zip(about.free).zip(about.scales);
            for ((x, drive), scale) in own {
                *x += scale * along(drive);
            }
            for (x, drive) in by_driven[row].iter_mut().zip(about.driven) {
                *x += along(drive);
            }
        };
        let mut held: Vec<(usize, DriveId, f64)> = Vec::new();
        places.gradients_of(time, &self.constraints, to_body, |row, drive, own| {
            held.push((row, drive, own));
        });
        for (row, drive, own) in held {
            if let Some(k) = about.driven.iter().position(|it| *it == drive) {
                by_driven[row][k] += factors[row] * own;
            }
        }
        (rows, by_driven)
    }

    /// How long it is, s, until ties that say something of their own come to repeat each other, at a change point, if it goes on as it does
    /// at these coordinates, which were closed last and where the instant is: by how their determinant, of whatever order it vanishes,
    /// changes within `just`, s. None where they do not.
    pub fn meets_in(
        &self,
        (time, just): (f64, f64),
        about: &About<'_>,
        places: &mut Several,
        coordinates: &[Rates],
        at: &Instant<f64>,
    ) -> Option<f64> {
        if self.span.least_part() > CLOSE {
            return None;
        }
        let across = self.span.across();
        let mut instant = at.clone();
        let mut size_at = |before: f64| -> Option<f64> {
            let there: Vec<Rates> = (coordinates.iter())
                .map(|q| Rates::constant(q.value() - before * q.coefficient(1)))
                .collect();
            places.rows_at(time, &there, &self.constraints);
            let known = places.slopes_at(time, &there, &mut instant);
            let (rows, _) = self.derivatives(time, about, places, &instant);
            let own = self.span.own_rows().iter().map(|row| &rows[*row]);
            let all: Vec<&Vec<f64>> = own.chain(&across).collect();
            let n = all.len();
            let mut system = Qr::with_capacity(n, n);
            system.reset(n, n);
            for (column, row) in all.iter().enumerate() {
                for (k, x) in row.iter().enumerate() {
                    system.add(k, column, *x);
                }
            }
            system.factor();
            known.then(|| math::ln(system.determinant().abs()))
        };
        let [now, before, earlier] = [size_at(0.0)?, size_at(just)?, size_at(2.0 * just)?];
        // Of the power k of the way it falls by k over the way, and that faster and faster.
        let (falls, faster) = (before - now, (before - now) - (earlier - before));
        let (way, power) = (just * falls / faster, falls * falls / faster);
        // At a dead point of what is driven it falls as a root does, and beside what is no change point as nothing of the kind.
        let whole = power.round();
        let meets = falls > 0.0 && faster > 0.0 && whole >= 1.0;
        (meets && (power - whole).abs() <= WHOLE).then_some(way)
    }

    /// Takes what does not close from the speeds, where the span was found; what drives that keep laws do along their own coordinates is
    /// what they do to a mechanism that stays closed.
    fn close_speeds(
        &mut self,
        about: &About<'_>,
        coordinates: &mut [Rates],
        at: &mut Instant<f64>,
    ) {
        let speed = |drive: &DriveId| coordinates[drive.index()].coefficient(1);
        let own = about.free.iter().zip(about.scales);
        let own: Vec<f64> = own.map(|(drive, scale)| speed(drive) / scale).collect();
        let driven: Vec<f64> = about.driven.iter().map(speed).collect();
        let rows = self.rows.iter().zip(&self.by_driven);
        let off: Vec<f64> = rows.map(|(a, b)| dot(a, &own) + dot(b, &driven)).collect();
        self.shift(&off, about, coordinates, 1);
        self.with_driven.clear();
        for (k, drive) in about.driven.iter().enumerate() {
            let column: Vec<f64> = self.by_driven.iter().map(|row| row[k]).collect();
            let step = self.span.shortest(&column).into_iter().zip(about.scales);
            let step: Vec<f64> = step.map(|(x, scale)| -scale * x).collect();
            let mut whole = std::mem::take(&mut at.coefficients[drive.index()]);
            for (free, part) in about.free.iter().zip(&step) {
                for (sum, k) in whole.iter_mut().zip(&at.coefficients[free.index()]) {
                    *sum = std::array::from_fn(|i| sum[i] + part * k[i]);
                }
            }
            at.coefficients[drive.index()] = whole;
            self.with_driven.push(step);
        }
    }

    /// Finds the accelerations that the ties ask for, where it was looked at how the links move.
    pub fn ask(&mut self, time: f64, about: &About<'_>, places: &Several) {
        let series = places.series_of(time, &self.constraints);
        let bends = series.iter().zip(&self.factors);
        let bends: Vec<f64> = bends.map(|(x, f)| 2.0 * f * x.coefficient(2)).collect();
        let step = self.span.shortest(&bends).into_iter().zip(about.scales);
        self.asked = step.map(|(x, scale)| -scale * x).collect();
    }

    /// The directions that the ties leave where the state was closed last: how fast every coordinate goes.
    pub fn directions(&self, scales: &[f64]) -> Vec<Vec<f64>> {
        let mut across = self.span.across();
        for way in &mut across {
            way.iter_mut()
                .zip(scales)
                .for_each(|(x, scale)| *x *= scale);
        }
        across
    }

    /// The ties' rows, in the coordinates' own sizes, and what these are to come to where drives that keep laws go so fast.
    pub fn asks_of_speeds(&self, driven: &[f64]) -> (Vec<Vec<f64>>, Vec<f64>) {
        let products = self.by_driven.iter().map(|row| -dot(row, driven));
        (self.rows.clone(), products.collect())
    }

    /// How near ties are to repeating each other that do not, at the state closed last: 0 where they do.
    pub fn least_part(&self) -> f64 {
        self.span.least_part()
    }

    /// How many rows the ties have.
    pub fn rows(&self) -> usize {
        self.factors.len()
    }

    /// How many directions the ties leave.
    pub fn freedoms(&self, coordinates: usize) -> usize {
        coordinates - self.span.rank()
    }

    /// A row of derivatives to the coordinates without what it asks of the ties: nothing goes along that.
    pub fn along(&self, row: &[f64], scales: &[f64]) -> Vec<f64> {
        let sized: Vec<f64> = row.iter().zip(scales).map(|(x, scale)| x * scale).collect();
        let mut left = sized.clone();
        self.span.take_off(&mut left);
        let (all, rest) = (dot(&sized, &sized), dot(&left, &left));
        if rest <= NOTHING * NOTHING * all {
            left.fill(0.0);
        }
        left.iter()
            .zip(scales)
            .map(|(x, scale)| x / scale)
            .collect()
    }

    /// A gap as the ties have it, at the state last looked at: opened by what goes along them alone.
    pub fn of_gap(&self, gap: Gap, scales: &[f64]) -> Gap {
        let with = self.with_driven.iter().map(|with| dot(&gap.gradient, with));
        let by_driven = gap.by_driven.iter().zip(with);
        Gap {
            bend: gap.bend + dot(&gap.gradient, &self.asked),
            by_driven: by_driven.map(|(own, with)| own + with).collect(),
            gradient: self.along(&gap.gradient, scales),
            ..gap
        }
    }

    /// The speeds of the coordinates without what goes with drives that keep their laws, which have these speeds.
    pub fn beside_driven(&self, speeds: &[f64], driven: &[f64]) -> Vec<f64> {
        let mut left = speeds.to_vec();
        for (with, speed) in self.with_driven.iter().zip(driven) {
            left.iter_mut().zip(with).for_each(|(x, w)| *x -= w * speed);
        }
        left
    }
}

/// The largest of some numbers, without its sign; NaN where one is.
fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().map(|x| x.abs()).fold(0.0, math::max)
}
