//! As many poses and points as a four-bar can pass: all four-bars that do, by the solutions of generic data and `kempe-alt-burmester`.
//!
//! The data are seen from the first place, in a unit that is a power of two near their size, so neither the unit of length nor the origin costs
//! digits; what is proved is proved for the data as given, rounding of the differences included.

use std::ops::ControlFlow;
use std::sync::OnceLock;

use kempe_alt_burmester::{Bounds, Given, Kind, Proved, StartSet, State, cognate, real, solve};
use kempe_linear::C;
use kempe_number::{Complex, Interval, math};

use super::PathLinkage;
use super::one_curve::of_one_curve;
use crate::dyad::Dyad;
use crate::error::{SynthesisError, all_finite, balanced};
use crate::linkage::{Linkage, pairs};
use crate::motion::dyads;
use crate::pose::Pose;

/// All four-bars through poses and points, and what became of the solutions of generic data.
#[derive(Clone, Debug, PartialEq)]
pub struct FourBarsThrough {
    /// The real ones; of nine points three in a row trace one curve.
    pub four_bars: Vec<FourBarThrough>,
    /// Solutions of generic data, complex ones included: of nine points coupler curves, 1442; otherwise four-bars, 1112, 201 or 30 with two,
    /// three or four poses.
    pub generic: usize,
    /// How many of these led to finite regular solutions, each counted once.
    pub finite: usize,
    /// How many went to infinity: special data have fewer solutions.
    pub infinite: usize,
    /// How many came to singular solutions, or several to one: special data have multiple ones, or whole families.
    pub singular: usize,
    /// How many could not be followed to the end: these may hide a linkage.
    pub lost: usize,
}

/// A four-bar that passes what was asked.
#[derive(Clone, Debug, PartialEq)]
pub struct FourBarThrough {
    /// The four-bar and the poses of its coupler: those that were given, then those at the points. The coupler's angle counts from the first
    /// point where no pose is given.
    pub path: PathLinkage,
    /// Which solution it belongs to, counted from 0: the three cognates of a coupler curve share one.
    pub solution: usize,
    /// Whether interval arithmetic has proved that such a four-bar exists near this one, and is not that of another
    /// solution.
    pub certified: bool,
}

/// All four-bars whose coupler takes M poses and carries its origin through 10 - 2 M points further, M from 1 to 4, or through nine points
/// (H. Alt 1923; C. W. Wampler, A. P. Morgan and A. J. Sommese 1992; D. A. Brake et al. 2016). Tenths of a second for nine points or two poses, less for
/// more poses. Five poses are [`dyads`] in closed form, of which only real solutions are counted.
///
/// `progress` hears now and then how many paths of how many have ended, and may stop the search.
///
/// # Errors
/// Data that are not finite, repeated, too few or too many; a search that was stopped. Data are counted through poses, then points.
pub fn four_bars_through(
    poses: &[Pose],
    points: &[C],
    progress: &dyn Fn(usize, usize) -> ControlFlow<()>,
) -> Result<FourBarsThrough, SynthesisError> {
    let finite = poses.iter().map(Pose::is_finite);
    all_finite(finite.chain(points.iter().map(|p| p.is_finite())))?;
    let asked = if poses.is_empty() {
        points.len().saturating_sub(1)
    } else {
        2 * (poses.len() - 1) + points.len()
    };
    balanced(asked, UNKNOWNS)?;
    let Some(kind) = Kind::of_poses(poses.len()) else {
        return of_poses_alone(poses);
    };
    let task = Task::new(kind, poses, points)?;
    let solved = solve(starts(kind)?, &task.given, progress).ok_or(SynthesisError::Stopped)?;
    let mut found = FourBarsThrough {
        four_bars: Vec::new(),
        generic: kind.classes(),
        finite: solved.solutions.len(),
        infinite: solved.infinite,
        singular: solved.singular,
        lost: solved.lost,
    };
    let (mut solution, mut known) = (0, Vec::<Proved>::new());
    for state in &solved.solutions {
        let Some(state) = real(&task.given, state) else {
            continue;
        };
        let before = found.four_bars.len();
        let (forms, proof) = task.forms(state);
        let differs = proof.is_some_and(|proof| known.iter().all(|other| other.differs(&proof)));
        known.extend(proof);
        for (form, proved) in forms {
            let four_bar = task.four_bar(&form, solution, proved && differs);
            found.four_bars.extend(four_bar);
        }
        if found.four_bars.len() > before {
            solution += 1;
        }
    }
    Ok(found)
}

/// Pivot coordinates that the data are to fix.
const UNKNOWNS: usize = 8;
/// Places nearer than this part of the data's size are one, and so are turns this near in rad.
const SAME_PLACE: f64 = 1e-12;

/// The solutions of generic data that the build script has found.
fn starts(kind: Kind) -> Result<&'static StartSet, SynthesisError> {
    static SETS: [OnceLock<Option<StartSet>>; 4] = [const { OnceLock::new() }; 4];
    let bytes: [&[u8]; 4] = [
        include_bytes!(concat!(env!("OUT_DIR"), "/starts_0.bin")),
        include_bytes!(concat!(env!("OUT_DIR"), "/starts_1.bin")),
        include_bytes!(concat!(env!("OUT_DIR"), "/starts_2.bin")),
        include_bytes!(concat!(env!("OUT_DIR"), "/starts_3.bin")),
    ];
    let turns = kind.turns();
    let set = SETS[turns].get_or_init(|| StartSet::from_bytes(bytes[turns]));
    set.as_ref().ok_or(SynthesisError::None)
}

/// Five poses.
fn of_poses_alone(poses: &[Pose]) -> Result<FourBarsThrough, SynthesisError> {
    let found: Vec<Dyad> = dyads(poses, &[])?.into_iter().map(|d| d.dyad).collect();
    let four_bars: Vec<FourBarThrough> = (pairs(&found).into_iter())
        .filter(|linkage| matches!(linkage, Linkage::FourBar(_)))
        .enumerate()
        .map(|(solution, linkage)| FourBarThrough {
            path: PathLinkage {
                linkage,
                poses: poses.to_vec(),
            },
            solution,
            certified: false,
        })
        .collect();
    Ok(FourBarsThrough {
        generic: 6,
        finite: four_bars.len(),
        infinite: 0,
        singular: 0,
        lost: 0,
        four_bars,
    })
}

/// A task in its own unit, seen from its first place.
struct Task<'a> {
    given: Given,
    bounds: Bounds,
    poses: &'a [Pose],
    points: &'a [C],
    first: Pose,
    unit: f64,
}

impl<'a> Task<'a> {
    fn new(kind: Kind, poses: &'a [Pose], points: &'a [C]) -> Result<Self, SynthesisError> {
        let first = match (poses, points) {
            ([pose, ..], _) => *pose,
            ([], points) => Pose {
                origin: points[0],
                angle: 0.0,
            },
        };
        let origins: Vec<C> = (poses.iter().map(|pose| pose.origin))
            .chain(points.iter().copied())
            .collect();
        // Differences of numbers may be too large for one.
        let halves = origins
            .iter()
            .map(|p| p.scale(0.5) - first.origin.scale(0.5));
        let largest = halves.clone().fold(0.0, |most, half| {
            math::max(most, math::max(half.re.abs(), half.im.abs()))
        });
        all_finite(halves.map(|half| half.scale(2.0).is_finite()))?;
        // The power of two below, and nothing for what is too small.
        let unit = f64::from_bits((2.0 * largest).to_bits() & f64::INFINITY.to_bits());
        if unit == 0.0 {
            return Err(SynthesisError::Repeated {
                first: 0,
                second: 1,
            });
        }
        let place = |p: C| {
            let apart = p - first.origin;
            C::new(apart.re / unit, apart.im / unit)
        };
        for second in 0..origins.len() {
            for first in 0..second {
                let apart = (place(origins[first]) - place(origins[second])).norm();
                let both_turned = second < poses.len();
                let turned = both_turned && {
                    let angle = poses[first].angle - poses[second].angle;
                    !(math::within_half_a_turn(angle).abs() <= SAME_PLACE)
                };
                if apart <= SAME_PLACE && !turned {
                    return Err(SynthesisError::Repeated { first, second });
                }
            }
        }
        let seen: Vec<C> = origins.iter().map(|p| place(*p)).collect();
        of_one_curve(&seen)?;
        let further = &points[usize::from(poses.is_empty())..];
        let turned = poses.get(1..).unwrap_or_default();
        let places: Vec<C> = further.iter().map(|p| place(*p)).collect();
        let turns: Vec<(C, f64)> = (turned.iter())
            .map(|pose| (place(pose.origin), pose.angle - first.angle))
            .collect();
        let given = Given::real(kind, &places, &turns).ok_or(SynthesisError::None)?;
        let bound = |z: C| Complex::<Interval>::new(exactly(z.re), exactly(z.im));
        let of_place = |k: usize| {
            let place = match further.get(k) {
                Some(point) => *point,
                None => turned[k - further.len()].origin,
            };
            let apart = bound(place) - bound(first.origin);
            Complex::new(apart.re / exactly(unit), apart.im / exactly(unit))
        };
        // Differences of points as sums of two numbers, exactly, and so in a unit that is a power of two.
        let exactly_apart = |k: usize| {
            let point = further.get(k).copied().unwrap_or(first.origin);
            let pairs = [(point.re, first.origin.re), (point.im, first.origin.im)];
            pairs.map(|(a, b)| difference(a, b).map(|part| part / unit))
        };
        let of_angle = |k: usize| exactly(turned[k].angle) - exactly(first.angle);
        Ok(Self {
            given,
            bounds: Bounds::within(kind, of_place, of_angle).with_exact(exactly_apart),
            poses,
            points,
            first,
            unit,
        })
    }

    /// All forms of a real solution, the cognates of nine points, and whether each is proved; a proof of any.
    fn forms(&self, state: State) -> (Vec<(State, bool)>, Option<Proved>) {
        let mut forms = vec![state];
        if self.given.kind == Kind::NinePoints {
            for k in 0..2 {
                let next = cognate(&self.given, &forms[k]);
                // A cognate loses digits where moving pivots are near each other.
                forms.push(real(&self.given, &next).unwrap_or(next));
            }
        }
        let proved: Vec<Option<Proved>> = forms.iter().map(|f| self.bounds.certify(f)).collect();
        let count = forms.len();
        let any = proved.iter().flatten().next().copied();
        let forms = forms.into_iter().enumerate();
        let forms = forms
            .map(|(k, form)| {
                // Where rounding hides the proof of one cognate, another's proves it.
                let mut from = (1..count).filter_map(|back| {
                    let mut proof = proved[(k + count - back) % count]?;
                    for _ in 0..back {
                        proof = proof.cognate();
                    }
                    Some(proof)
                });
                let certified = proved[k].is_some() || from.any(|proof| proof.is_near(&form));
                (form, certified)
            })
            .collect();
        (forms, any)
    }

    /// The linkage of a real solution; `None` where it is none, as pivots are one or numbers too large.
    fn four_bar(&self, state: &State, solution: usize, certified: bool) -> Option<FourBarThrough> {
        let back = C::from_polar(1.0, -self.first.angle);
        let dyad = |side: usize| {
            let [moving, fixed] = [state[4 * side], state[4 * side + 1]];
            let fixed = self.first.origin + fixed.scale(self.unit);
            Dyad::rr(fixed, back * moving.scale(self.unit), &self.first)
        };
        let turned = (self.points.iter().enumerate()).map(|(k, point)| {
            let own = k.checked_sub(usize::from(self.poses.is_empty()));
            let angle = own.map_or(0.0, |own| (state[8 + 2 * own] + C::one()).arg());
            Pose {
                origin: *point,
                angle: self.first.angle + angle,
            }
        });
        let poses: Vec<Pose> = self.poses.iter().copied().chain(turned).collect();
        let (first, second) = (dyad(0), dyad(1));
        let finite = first.reach().is_finite() && second.reach().is_finite();
        let linkage = Linkage::of(first, second).filter(|_| finite)?;
        Some(FourBarThrough {
            path: PathLinkage { linkage, poses },
            solution,
            certified,
        })
    }
}

/// A difference and what rounding took from it (D. E. Knuth).
fn difference(a: f64, b: f64) -> [f64; 2] {
    let apart = a - b;
    let of_b = apart - a;
    [apart, (a - (apart - of_b)) - (b + of_b)]
}

/// A number as it is.
fn exactly(x: f64) -> Interval {
    Interval::new(x, x)
}
