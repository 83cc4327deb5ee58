//! The steps of one path: prediction from places passed, and what a correction says of it.
//!
//! The predictor goes through the last places with their slopes (Hermite's interpolation), so that one linear system per correction is all a step
//! takes. Steps aim at a first correction of a size; a step is taken back where the first is too large or the next does not shrink as
//! Newton's corrections do: then another solution may be near.

use kempe_number::math;

use crate::equations::State;
use crate::flock::MEMORY;

/// How carefully paths are followed. Corrections are measured beside the unknowns' size.
#[derive(Clone, Copy, Debug)]
pub struct Care {
    /// The first correction after a step that is aimed at where Newton's method converges well.
    pub aim: f64,
    /// That where it converges badly: the next correction beside the first.
    pub calm: f64,
    /// The least first correction aimed at, so that rounding does not look like bad convergence.
    pub least: f64,
    /// A correction after which a place is good enough even where rounding leaves corrections that do not shrink.
    pub rounded: f64,
    /// Steps of a path at most.
    pub steps: usize,
    /// Whether it is followed with twice the digits.
    pub doubled: bool,
}

/// The usual care, and that for paths that were lost or met another.
pub const CARES: [Care; 3] = [
    Care {
        aim: 1e-3,
        calm: 1e-2,
        least: 1e-7,
        rounded: 1e-8,
        steps: 4000,
        doubled: false,
    },
    Care {
        aim: 1e-5,
        calm: 1e-3,
        least: 1e-8,
        rounded: 3e-9,
        steps: 20_000,
        doubled: false,
    },
    Care {
        aim: 1e-4,
        calm: 1e-3,
        least: 1e-15,
        rounded: 1e-18,
        steps: 20_000,
        doubled: true,
    },
];

/// The first correction that is too much, in what is aimed at.
const TOO_MUCH: f64 = 10.0;
/// Where a path ended.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// At a regular solution.
    Arrived(Box<State>),
    /// Its unknowns grew without bound at the end of the way.
    Infinite,
    /// It came near a singular solution at the end of the way.
    Singular,
    /// It could not be followed.
    Lost,
}

/// The first step, as a part of what is left of the way.
const FIRST_STEP: f64 = 1e-4;
/// And at least: where less is left, all of it.
const LEAST_FIRST_STEP: f64 = 1e-12;
/// The shortest step.
const SHORTEST: f64 = 1e-13;
/// By how much a step may be longer or shorter than the last.
const LONGER: f64 = 2.0;
const SHORTER: f64 = 0.2;
/// What is left of a step that is taken back, least and most.
const BACK: [f64; 2] = [0.1, 0.5];
/// The first correction of a start at most.
const AT_THE_START: f64 = 1e-3;
/// What corrections that vanish are taken for where something is divided by them.
const TINY: f64 = 1e-300;
/// A part less than what the corrections would allow.
const SAFETY: f64 = 0.85;
/// By how much a correction must be smaller than the one before, where it is not small enough anyway.
const CONTRACTION: f64 = 0.02;
/// A correction at the end of the way after which nothing is left to correct.
const AT_THE_END: f64 = 1e-13;
/// Corrections at the end of the way at most.
const LAST_CORRECTIONS: usize = 8;
/// What is left of the way where a path that cannot go on has met the end.
const NEAR_THE_END: f64 = 1e-3;
/// The pivot coordinates that count as infinite there, in units of the data.
const INFINITY: f64 = 1e5;

/// What is to be done in the path's lane.
pub(crate) enum Next {
    /// Another correction.
    Correct,
    /// The iterate is a place passed: predict the next.
    Step,
    /// Predict again, nearer.
    Back,
    /// The corrected iterate is where the path ends.
    Arrived,
    /// It ends without a solution.
    Ended(End),
}

/// A path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tracker {
    care: Care,
    /// Where it was last, how far it wants to go next, and where it looks now.
    pub t: f64,
    step: f64,
    pub at: f64,
    /// Places passed, the last first.
    passed: [f64; MEMORY],
    count: usize,
    corrections: usize,
    first: f64,
    last: f64,
    /// The last second correction over the square of the first before it.
    bend: f64,
    steps: usize,
    /// Whether the last step was taken back.
    back: bool,
    largest: f64,
}

impl Tracker {
    /// A path that begins at a part of the way.
    pub fn new(care: Care, from: f64) -> Self {
        Self {
            care,
            t: from,
            step: math::max(FIRST_STEP * (1.0 - from), LEAST_FIRST_STEP),
            at: from,
            passed: [0.0; MEMORY],
            count: 0,
            corrections: 0,
            first: 0.0,
            last: 0.0,
            bend: 1.0,
            steps: 0,
            back: false,
            largest: 0.0,
        }
    }

    /// What a correction of this squared size, beside unknowns of this squared size, says.
    pub fn decide(&mut self, correction: f64, largest: f64) -> Next {
        let size = correction.sqrt();
        if self.corrections == 0 {
            self.first = size;
        }
        self.corrections += 1;
        if self.corrections == 2 {
            self.bend = size / math::max(self.first * self.first, TINY);
        }
        let aim = self.aim();
        // NaN is too much.
        let fits = if self.corrections == 1 {
            size <= TOO_MUCH * aim || self.count == 0 && size <= AT_THE_START
        } else {
            size <= aim && size <= CONTRACTION * self.first || size <= self.care.rounded
        };
        let at_the_end = self.at == 1.0;
        let rounded =
            self.corrections > 1 && size <= self.care.rounded && size > CONTRACTION * self.last;
        self.last = size;
        if at_the_end && self.corrections > 1 {
            if size <= AT_THE_END || rounded {
                return Next::Arrived;
            }
            if fits && self.corrections < LAST_CORRECTIONS {
                return Next::Correct;
            }
            return self.go_back();
        }
        if !fits {
            return self.go_back();
        }
        if self.corrections == 1 || at_the_end {
            return Next::Correct;
        }
        self.largest = largest;
        self.steps += 1;
        if self.steps > self.care.steps {
            return self.stuck();
        }
        self.passed.rotate_right(1);
        self.passed[0] = self.at;
        if self.count > 0 {
            let most = if self.back { 1.0 } else { LONGER };
            self.step = (self.at - self.t) * self.factor().clamp(SHORTER, most);
        }
        self.back = false;
        self.count = (self.count + 1).min(MEMORY);
        self.t = self.at;
        self.look();
        Next::Step
    }

    /// The first correction that is aimed at.
    fn aim(&self) -> f64 {
        math::max(
            math::min(self.care.aim, self.care.calm / self.bend),
            self.care.least,
        )
    }

    /// By how much the step may be longer for the correction that is aimed at.
    fn factor(&self) -> f64 {
        // A prediction through n places with slopes misses by the step to 2 n.
        let part = self.aim() / math::max(self.first, TINY);
        SAFETY * root(part, 2 * self.count as u64)
    }

    fn go_back(&mut self) -> Next {
        if self.count == 0 {
            return Next::Ended(End::Lost);
        }
        let factor = self.factor();
        // What is no number asks for the shortest.
        let factor = if factor >= BACK[0] {
            factor.min(BACK[1])
        } else {
            BACK[0]
        };
        self.step = (self.at - self.t) * factor;
        self.back = true;
        self.steps += 1;
        if !(self.step > SHORTEST) || self.steps > self.care.steps {
            return self.stuck();
        }
        self.look();
        Next::Back
    }

    fn look(&mut self) {
        self.corrections = 0;
        self.at = if self.t + self.step >= 1.0 {
            1.0
        } else {
            self.t + self.step
        };
    }

    fn stuck(&self) -> Next {
        Next::Ended(if 1.0 - self.t > NEAR_THE_END {
            End::Lost
        } else if self.largest >= INFINITY * INFINITY {
            End::Infinite
        } else {
            End::Singular
        })
    }

    /// Factors of the places passed and of their slopes (which are to be taken off) in the prediction of the next place.
    pub fn weights(&self) -> [[f64; 2]; MEMORY] {
        let mut weights = [[0.0; 2]; MEMORY];
        let t = self.at;
        for k in 0..self.count {
            let own = self.passed[k];
            let (mut basis, mut slope) = (1.0, 0.0);
            for j in (0..self.count).filter(|j| *j != k) {
                let over = 1.0 / (own - self.passed[j]);
                basis *= (t - self.passed[j]) * over;
                slope += over;
            }
            let square = basis * basis;
            weights[k] = [
                square * (1.0 - 2.0 * (t - own) * slope),
                -square * (t - own),
            ];
        }
        weights
    }
}

/// A root of a positive number to a few hundredths: the exponent is divided, and the digits with it.
fn root(x: f64, degree: u64) -> f64 {
    let one = 1.0_f64.to_bits();
    if !(x.is_finite() && x > 0.0) {
        return x;
    }
    f64::from_bits(if x >= 1.0 {
        one + (x.to_bits() - one) / degree
    } else {
        one - (one - x.to_bits()) / degree
    })
}
