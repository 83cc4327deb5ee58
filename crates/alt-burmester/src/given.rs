//! What is given: places of the coupler point, and the coupler's turns at some of them.
//!
//! Everything is seen from the first place, where the coupler is not turned. A plane vector and its conjugate are independent complex
//! numbers here (isotropic coordinates), "hat" marks the conjugate: data and solutions are real where each hat is the conjugate.

use kempe_linear::C;
use kempe_number::{Random, math};

/// Places after the first, at most.
pub const PLACES: usize = 8;
/// Poses after the first, at most.
pub const TURNS: usize = 3;

/// One of the problems with finitely many answers: M poses and 10 - 2 M points further, M from 1 to 4.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Nine points (H. Alt 1923), or a pose and eight points, which is the same.
    NinePoints,
    /// Two poses and six points.
    TwoPoses,
    /// Three poses and four points.
    ThreePoses,
    /// Four poses and two points.
    FourPoses,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 4] = [
        Self::NinePoints,
        Self::TwoPoses,
        Self::ThreePoses,
        Self::FourPoses,
    ];

    /// The kind with so many poses, the first of them included; one pose is as good as none. `None` from five on.
    pub fn of_poses(poses: usize) -> Option<Self> {
        Some(match poses {
            0 | 1 => Self::NinePoints,
            2 => Self::TwoPoses,
            3 => Self::ThreePoses,
            4 => Self::FourPoses,
            _ => return None,
        })
    }

    /// Poses after the first place.
    pub const fn turns(self) -> usize {
        match self {
            Self::NinePoints => 0,
            Self::TwoPoses => 1,
            Self::ThreePoses => 2,
            Self::FourPoses => 3,
        }
    }

    /// Points after the first place.
    pub const fn points(self) -> usize {
        PLACES - 2 * self.turns()
    }

    /// Places after the first: points, then poses.
    pub const fn places(self) -> usize {
        self.points() + self.turns()
    }

    /// Classes of solutions of generic data: of nine points triples of cognates, otherwise four-bars.
    ///
    /// 1442 by C. W. Wampler, A. P. Morgan and A. J. Sommese (J. Mech. Design 114:153, 1992), the others by D. A. Brake et al. (2016), who
    /// count both orders of the two links.
    pub const fn classes(self) -> usize {
        match self {
            Self::NinePoints => 1442,
            Self::TwoPoses => 1112,
            Self::ThreePoses => 201,
            Self::FourPoses => 30,
        }
    }

    /// Unknowns: eight, and two for each point.
    pub const fn unknowns(self) -> usize {
        8 + 2 * self.points()
    }
}

/// The data of a problem.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Given {
    /// Which problem.
    pub kind: Kind,
    /// Where the coupler point is, less where it is first: points, then poses.
    pub place: [C; PLACES],
    /// The hats of these.
    pub hat: [C; PLACES],
    /// Logarithms of the turns e^(i angle) from the first pose to the others; the hat of a turn is one over it.
    pub log_turn: [C; TURNS],
}

impl Given {
    /// Real data: points and poses after the first place, as seen from it; angles in rad.
    pub fn real(kind: Kind, points: &[C], poses: &[(C, f64)]) -> Option<Self> {
        if points.len() != kind.points() || poses.len() != kind.turns() {
            return None;
        }
        let mut given = Self::zero(kind);
        let places = points.iter().chain(poses.iter().map(|(place, _)| place));
        for (k, place) in places.enumerate() {
            given.place[k] = *place;
            given.hat[k] = place.conj();
        }
        for (log, (_, angle)) in given.log_turn.iter_mut().zip(poses) {
            *log = C::new(0.0, math::within_half_a_turn(*angle));
        }
        Some(given)
    }

    /// Data of no meaning.
    pub fn random(kind: Kind, random: &mut Random) -> Self {
        let mut given = Self::zero(kind);
        for k in 0..kind.places() {
            given.place[k] = random.complex();
            given.hat[k] = random.complex();
        }
        for k in 0..kind.turns() {
            given.log_turn[k] = random_log(random);
        }
        given
    }

    pub(crate) fn zero(kind: Kind) -> Self {
        Self {
            kind,
            place: [C::zero(); PLACES],
            hat: [C::zero(); PLACES],
            log_turn: [C::zero(); TURNS],
        }
    }

    /// The turn of a pose and its hat.
    pub fn turn(&self, pose: usize) -> [C; 2] {
        let log = self.log_turn[pose];
        let turn = C::from_polar(math::exp(log.re), log.im);
        [turn, turn.recip()]
    }

    /// What is to be added to come to another, whose turns are reached the shorter way round.
    pub(crate) fn to(&self, other: &Self) -> Self {
        let mut rate = Self::zero(self.kind);
        for k in 0..PLACES {
            rate.place[k] = other.place[k] - self.place[k];
            rate.hat[k] = other.hat[k] - self.hat[k];
        }
        for k in 0..TURNS {
            let log = other.log_turn[k] - self.log_turn[k];
            rate.log_turn[k] = C::new(log.re, math::within_half_a_turn(log.im));
        }
        rate
    }
}

/// The logarithm of a turn of no meaning.
pub(crate) fn random_log(random: &mut Random) -> C {
    let turn = random.complex();
    C::new(0.5 * math::ln(turn.norm_sqr()), turn.arg())
}
