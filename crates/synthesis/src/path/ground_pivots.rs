//! Five points and both ground pivots, or four points, both ground pivots and a line for a moving one: all four-bars.
//!
//! All solutions of generic data are found once, from one that is made up, by carrying them round loops in the space of data until no
//! new one appears (monodromy); whatever is asked is then led to from these. Five points: 36 (Morgan and Wampler 1990).

use std::sync::OnceLock;

use kempe_linear::C;
use kempe_number::Random;

use super::PathLinkage;
use super::tracker::{CARES, End, Given, PLACES, State, follow, is_same};
use crate::dyad::Dyad;
use crate::error::{SynthesisError, all_finite, balanced};
use crate::linkage::Linkage;
use crate::pose::{Line, Pose};

/// All four-bars through points with both ground pivots given, and what became of the solutions of generic data.
#[derive(Clone, Debug, PartialEq)]
pub struct GroundPivotPaths {
    /// The real ones; the link at the first pivot first.
    pub linkages: Vec<PathLinkage>,
    /// Solutions of generic data: 36 for five points.
    pub generic: usize,
    /// How many of these led to finite solutions, real or not, each counted once.
    pub finite: usize,
    /// How many went to infinity: special data have fewer solutions.
    pub infinite: usize,
    /// How many could not be followed to the end, or fell together with others: these may hide a linkage, and mostly are multiple
    /// solutions of special data.
    pub lost: usize,
}

/// All four-bars with given ground pivots whose coupler carries a point through five points, or through four with the first link's moving pivot,
/// when the coupler is at the first of them, on a line. About 10 ms; the first time some tenths of a second more, for the generic
/// solutions.
///
/// # Errors
/// Data that are not finite, repeated, too few or too many; ground pivots that are one.
pub fn paths_with_ground_pivots(
    points: &[C],
    pivots: [C; 2],
    moving_on: Option<Line>,
) -> Result<GroundPivotPaths, SynthesisError> {
    let finite = points.iter().chain(&pivots).map(|p| p.is_finite());
    all_finite(finite.chain(moving_on.iter().map(Line::is_finite)))?;
    balanced(
        points.len().saturating_sub(1) + usize::from(moving_on.is_some()),
        PLACES,
    )?;
    let frame = pivots[1] - pivots[0];
    let unit = frame.recip();
    if !unit.is_finite() {
        return Err(SynthesisError::Repeated {
            first: points.len(),
            second: points.len() + 1,
        });
    }
    for second in 0..points.len() {
        for first in 0..second {
            if (points[first] - points[second]).norm() <= SAME_POINT * frame.norm() {
                return Err(SynthesisError::Repeated { first, second });
            }
        }
    }
    let places = points.len() - 1;
    let mut given = Given {
        places,
        d: [C::zero(); PLACES + 1],
        conjugate: [C::zero(); PLACES + 1],
        line: [C::zero(); 3],
    };
    for (k, point) in points.iter().enumerate() {
        given.d[k] = (*point - pivots[0]) * unit;
        given.conjugate[k] = given.d[k].conj();
    }
    if let Some(line) = moving_on {
        // Re(conj(n) (x - p)) = 0 about the first point.
        let n = C::i() * line.direction * unit;
        let n = n.scale(1.0 / n.norm());
        let p = (line.point - points[0]) * unit;
        let e = (n.conj() * p).re * 2.0;
        given.line = [n.conj(), n, C::from(e)];
    }
    let generic = generic(places);
    let mut ends: Vec<End> = (generic.solutions.iter())
        .map(|start| follow(start, &generic.given, &given, CARES[0]))
        .collect();
    // Those that were lost or met another once more, with more care.
    for k in 0..ends.len() {
        let again = match &ends[k] {
            End::Lost => true,
            End::Infinite => false,
            End::Finite(x) => (ends.iter().enumerate())
                .any(|(j, other)| j != k && matches!(other, End::Finite(y) if is_same(x, y))),
        };
        if again {
            ends[k] = follow(&generic.solutions[k], &generic.given, &given, CARES[1]);
        }
    }
    let mut result = GroundPivotPaths {
        linkages: Vec::new(),
        generic: ends.len(),
        finite: 0,
        infinite: 0,
        lost: 0,
    };
    let mut known: Vec<State> = Vec::new();
    for end in &ends {
        match end {
            End::Infinite => result.infinite += 1,
            End::Lost => result.lost += 1,
            End::Finite(x) if known.iter().any(|y| is_same(x, y)) => result.lost += 1,
            End::Finite(x) => {
                result.finite += 1;
                known.push(*x);
                result.linkages.extend(linkage(x, points, pivots));
            }
        }
    }
    Ok(result)
}

/// Points nearer than this part of the frame are one.
const SAME_POINT: f64 = 1e-12;
/// Plain and conjugate coordinates of a real solution agree to this part of their size.
const REAL: f64 = 1e-7;

/// The linkage of a solution; `None` where it is not real, or a link has no length.
fn linkage(x: &State, points: &[C], pivots: [C; 2]) -> Option<PathLinkage> {
    let places = points.len() - 1;
    let is_real = (0..2 + places).all(|k| {
        let (plain, conjugate) = (x[2 * k], x[2 * k + 1]);
        (plain - conjugate.conj()).norm() <= REAL * (1.0 + plain.norm())
    });
    if !is_real {
        return None;
    }
    // Of a real solution both coordinates tell the same: their mean.
    let mean = |k: usize| (x[2 * k] + x[2 * k + 1].conj()).scale(0.5);
    let frame = pivots[1] - pivots[0];
    let poses: Vec<Pose> = (points.iter().enumerate())
        .map(|(k, point)| Pose {
            origin: *point,
            angle: if k == 0 { 0.0 } else { mean(k + 1).arg() },
        })
        .collect();
    let dyad = |k: usize| Dyad::rr(pivots[k], mean(k) * frame, &poses[0]);
    Linkage::of(dyad(0), dyad(1)).map(|linkage| PathLinkage { linkage, poses })
}

/// Data of no meaning with all their solutions.
struct Generic {
    given: Given,
    solutions: Vec<State>,
}

/// Loops in a row that must find nothing new.
const QUIET_LOOPS: usize = 6;
/// Loops at most.
const LOOPS: usize = 60;

/// The generic data for so many places after the first, and all their solutions: found once, the same everywhere.
fn generic(places: usize) -> &'static Generic {
    static FOUR: OnceLock<Generic> = OnceLock::new();
    static THREE: OnceLock<Generic> = OnceLock::new();
    let once = if places == PLACES { &FOUR } else { &THREE };
    once.get_or_init(|| {
        let mut random = Random(0x5eed_4a36);
        let (given, first) = loop {
            if let Some(made) = made_up(places, &mut random) {
                break made;
            }
        };
        let mut solutions = vec![first];
        let mut quiet = 0;
        for _ in 0..LOOPS {
            let mut stations = [given; 4];
            for station in &mut stations[1..3] {
                for k in 0..=PLACES {
                    station.d[k] = random.complex();
                    station.conjugate[k] = random.complex();
                }
                station.line = [(); 3].map(|()| random.complex());
            }
            let before = solutions.len();
            for k in 0..before {
                let mut x = Some(solutions[k]);
                for leg in stations.windows(2) {
                    x = x.and_then(|x| match follow(&x, &leg[0], &leg[1], CARES[0]) {
                        End::Finite(there) => Some(there),
                        End::Infinite | End::Lost => None,
                    });
                }
                if let Some(x) = x.filter(|x| !solutions.iter().any(|y| is_same(x, y))) {
                    solutions.push(x);
                }
            }
            quiet = if solutions.len() > before {
                0
            } else {
                quiet + 1
            };
            if quiet == QUIET_LOOPS {
                break;
            }
        }
        Generic { given, solutions }
    })
}

/// Complex data with one solution: a made-up complex four-bar in places that it passes.
fn made_up(places: usize, random: &mut Random) -> Option<(Given, State)> {
    let mut state = [C::zero(); 4 + 2 * PLACES];
    for k in 0..4 {
        state[k] = random.complex();
    }
    let [x, x1, y, y1] = [state[0], state[1], state[2], state[3]];
    let mut given = Given {
        places,
        d: [C::zero(); PLACES + 1],
        conjugate: [C::zero(); PLACES + 1],
        line: [C::zero(); 3],
    };
    (given.d[0], given.conjugate[0]) = (random.complex(), random.complex());
    let one = C::one();
    let (d0, c0) = (given.d[0], given.conjugate[0]);
    // Squares of both links and of the coupler.
    let first = (d0 + x) * (c0 + x1);
    let second = (d0 + y - one) * (c0 + y1 - one);
    let coupler = (x - y) * (x1 - y1);
    for j in 0..places {
        let a = random.complex();
        let a1 = first * a.recip();
        // The second link s s' = second, (u - s)(u' - s') = coupler with u from the second pivot to the first link's end.
        let (u, u1) = (a - one, a1 - one);
        let half = (u * u1 + second - coupler).scale(0.5);
        let s = (half + (half * half - u * u1 * second).sqrt()) * u1.recip();
        let s1 = second * s.recip();
        let turn = (u - s) * (x - y).recip();
        let turn1 = (u1 - s1) * (x1 - y1).recip();
        (state[4 + 2 * j], state[5 + 2 * j]) = (turn, turn1);
        given.d[j + 1] = a - turn * x;
        given.conjugate[j + 1] = a1 - turn1 * x1;
    }
    let (c, c1) = (random.complex(), random.complex());
    given.line = [c, c1, c * x + c1 * x1];
    let finite = state.iter().chain(&given.d).chain(&given.conjugate);
    finite
        .clone()
        .all(|z| z.is_finite())
        .then_some((given, state))
}
