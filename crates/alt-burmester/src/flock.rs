//! Several paths side by side in lanes: one linear system each, and what follows from the decisions of their trackers.

use kempe_linear::{C, Plain};
use kempe_number::{Lanes8, multiversion};

use crate::double::Double;
use crate::equations::{PIVOTS, State, Storage, UNKNOWNS, Way, Z, solve};

/// Numbers that paths are followed in.
pub(crate) trait Pack: Plain {
    /// Paths side by side.
    const LANES: usize;

    /// The plain number in a lane.
    fn lane(self, lane: usize) -> f64;

    /// Puts a plain number into a lane.
    fn set_lane(&mut self, lane: usize, x: f64);

    /// Carries out the orders, then solves in every lane at its place of the way.
    fn advance(way: &Way, flock: &mut Flock<Self>, orders: &Orders<Self>);
}

/// Eight paths, as wide as the widest vector instructions: a fifth faster than four.
impl Pack for Lanes8 {
    const LANES: usize = 8;

    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        self.0[lane]
    }

    #[inline(always)]
    fn set_lane(&mut self, lane: usize, x: f64) {
        self.0[lane] = x;
    }

    fn advance(way: &Way, flock: &mut Flock<Self>, orders: &Orders<Self>) {
        advance_eight(way, flock, orders);
    }
}

/// One path with twice the digits.
impl Pack for Double {
    const LANES: usize = 1;

    fn lane(self, _: usize) -> f64 {
        self.high
    }

    fn set_lane(&mut self, _: usize, x: f64) {
        *self = Self { high: x, low: 0.0 };
    }

    fn advance(way: &Way, flock: &mut Flock<Self>, orders: &Orders<Self>) {
        advance_inner(way, flock, orders);
    }
}

/// A place of a path: which part of the way it is at, and the solution there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub t: f64,
    pub state: State,
}

impl Place {
    /// Where a path begins.
    pub fn start(state: &State) -> Self {
        Self {
            t: 0.0,
            state: *state,
        }
    }
}

/// Places passed that the predictor looks back to.
pub(crate) const MEMORY: usize = 3;

/// What a tracker decides for its lane after a solve. Numbers are 1 for yes and -1 for no.
#[derive(Clone, Copy)]
pub(crate) struct Orders<P> {
    /// Whether the corrected iterate is a place passed.
    pub accept: P,
    /// Whether the next iterate is a predicted one; otherwise the corrected one.
    pub predict: P,
    /// Factors of the places passed, and of their slopes, in the prediction.
    pub weights: [[P; 2]; MEMORY],
}

impl<P: Pack> Orders<P> {
    pub fn none() -> Self {
        Self {
            accept: P::from_f64(-1.0),
            predict: P::from_f64(-1.0),
            weights: [[P::zero(); 2]; MEMORY],
        }
    }
}

/// Paths side by side.
pub(crate) struct Flock<P> {
    /// Where on the way each is looked at.
    pub t: P,
    /// Iterates.
    x: [Z<P>; UNKNOWNS],
    /// Corrections and slopes, both to be taken off.
    found: [[Z<P>; UNKNOWNS]; 2],
    /// Places passed and slopes there, the last first.
    passed: [[[Z<P>; UNKNOWNS]; 2]; MEMORY],
    storage: Storage<P>,
    /// The squares of the corrections' sizes, beside the unknowns'.
    pub correction: P,
    /// The squares of the largest pivot coordinates.
    pub largest: P,
}

impl<P: Pack> Flock<P> {
    pub fn new() -> Self {
        let zeros = [Z::zero(); UNKNOWNS];
        Self {
            t: P::zero(),
            x: zeros,
            found: [zeros; 2],
            passed: [[zeros; 2]; MEMORY],
            storage: Storage::new(),
            correction: P::zero(),
            largest: P::zero(),
        }
    }

    /// Puts a path into a lane that begins at a place of it.
    pub fn load(&mut self, lane: usize, place: &Place) {
        self.t.set_lane(lane, place.t);
        for (k, x) in place.state.iter().enumerate() {
            self.x[k].re.set_lane(lane, x.re);
            self.x[k].im.set_lane(lane, x.im);
            let old = self.passed.iter_mut().flatten().chain(&mut self.found);
            for of in old {
                of[k].re.set_lane(lane, 0.0);
                of[k].im.set_lane(lane, 0.0);
            }
        }
    }

    /// The last place that the path in a lane passed.
    pub fn last(&self, lane: usize) -> State {
        let [last, _] = &self.passed[0];
        std::array::from_fn(|k| C::new(last[k].re.lane(lane), last[k].im.lane(lane)))
    }

    /// The corrected iterate of a lane.
    pub fn corrected(&self, lane: usize) -> State {
        std::array::from_fn(|k| {
            let x = self.x[k] - self.found[0][k];
            C::new(x.re.lane(lane), x.im.lane(lane))
        })
    }
}

multiversion! {
    fn advance_eight(way: &Way, flock: &mut Flock<Lanes8>, orders: &Orders<Lanes8>) = advance_inner;
}

#[inline(always)]
fn advance_inner<P: Pack>(way: &Way, flock: &mut Flock<P>, orders: &Orders<P>) {
    let unknowns = way.from.kind.unknowns();
    let any_accepted = orders.accept.any_positive();
    let any_predicted = orders.predict.any_positive();
    for k in 0..unknowns {
        let fresh = flock.x[k] - flock.found[0][k];
        if any_accepted {
            for of in 0..2 {
                for m in (1..MEMORY).rev() {
                    flock.passed[m][of][k] = where_yes(
                        orders.accept,
                        flock.passed[m - 1][of][k],
                        flock.passed[m][of][k],
                    );
                }
            }
            flock.passed[0][0][k] = where_yes(orders.accept, fresh, flock.passed[0][0][k]);
            flock.passed[0][1][k] =
                where_yes(orders.accept, flock.found[1][k], flock.passed[0][1][k]);
        }
        flock.x[k] = fresh;
        if any_predicted {
            let mut sum = Z::<P>::zero();
            for (weights, passed) in orders.weights.iter().zip(&flock.passed) {
                sum += passed[0][k].scale(weights[0]) + passed[1][k].scale(weights[1]);
            }
            flock.x[k] = where_yes(orders.predict, sum, fresh);
        }
    }
    solve(way, flock.t, &flock.x, &mut flock.found, &mut flock.storage);
    let (mut worst, mut largest) = (P::zero(), P::zero());
    for k in 0..unknowns {
        let square = flock.x[k].norm_sqr();
        let part = flock.found[0][k].norm_sqr() / (square + 1.0);
        // NaN is kept.
        worst = P::where_positive(worst - part, worst, part);
        if k < PIVOTS {
            largest = P::where_positive(square - largest, square, largest);
        }
    }
    flock.correction = worst;
    flock.largest = largest;
}

#[inline(always)]
fn where_yes<P: Plain>(key: P, yes: Z<P>, no: Z<P>) -> Z<P> {
    Z::new(
        P::where_positive(key, yes.re, no.re),
        P::where_positive(key, yes.im, no.im),
    )
}
