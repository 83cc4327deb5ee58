//! The equations, and the linear systems of Newton's method and of following a path, solved place by place.
//!
//! From the first place of the coupler point: fixed pivots a, b and moving pivots x, y; at place j the point is at d and the coupler has turned
//! by T = 1 + g. That the links keep their lengths, and that T is a turn (C. W. Wampler, A. P. Morgan and A. J. Sommese, J. Mech. Design
//! 114:153, 1992):
//!
//!   (a' - d') x g + (a - d) x' g' + (a' - x') d + (a - x) d' - d d' = 0,  the same in b and y,  g g' + g + g' = 0
//!
//! with ' for hats. Only the three equations of place j feel its g and g'; what does not feel them is one combination of the three, an equation in the
//! eight pivot coordinates. At a pose g is given and the first two are such equations. Eight of them are left in all.

use kempe_linear::{C, Plain};
use kempe_number::{Complex, Number};

use crate::given::{Given, PLACES, TURNS};

/// Unknowns, at most: x, a, x', a', y, b, y', b', then g and g' of each point.
pub const UNKNOWNS: usize = 8 + 2 * PLACES;
/// Unknowns of the pivots.
pub const PIVOTS: usize = 8;

/// A solution: x, a, x', a', y, b, y', b', then g and g' of each point; zeros behind.
pub type State = [C; UNKNOWNS];

/// Complex numbers of any plain kind.
pub(crate) type Z<P> = Complex<P>;

/// One that lies between two sets of data: where, and how it moves.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Way {
    pub from: Given,
    pub rate: Given,
}

impl Way {
    pub fn new(from: &Given, to: &Given) -> Self {
        Self {
            from: *from,
            rate: from.to(to),
        }
    }

    /// The data themselves: a way that stays.
    pub fn at(given: &Given) -> Self {
        Self {
            from: *given,
            rate: Given::zero(given.kind),
        }
    }
}

/// A plain complex number in all lanes.
#[inline(always)]
fn wide<P: Plain>(z: C) -> Z<P> {
    Z::new(P::from_f64(z.re), P::from_f64(z.im))
}

/// a + t b with plain a and b.
#[inline(always)]
fn along<P: Plain>(a: C, b: C, t: P) -> Z<P> {
    Z::new(t * b.re + a.re, t * b.im + a.im)
}

#[inline(always)]
fn size<P: Plain>(z: Z<P>) -> P {
    z.re.abs() + z.im.abs()
}

#[inline(always)]
fn larger<P: Plain>(a: P, b: P) -> P {
    P::where_positive(a - b, a, b)
}

/// Both link equations of a place, or the one of a link: factors of g and g', of its four pivot coordinates, the value, and how it changes along the
/// way.
#[derive(Clone, Copy)]
pub(crate) struct Row<P> {
    pub turn: [Z<P>; 2],
    pub pivot: [Z<P>; 4],
    pub right: [Z<P>; 2],
}

/// The equation of one link at a place.
#[inline(always)]
pub(crate) fn link<P: Number>(
    [x, a, x1, a1]: [Z<P>; 4],
    [g, g1]: [Z<P>; 2],
    [d, c]: [Z<P>; 2],
    [d_rate, c_rate]: [Z<P>; 2],
) -> Row<P> {
    let (p, q) = (a1 - c, a - d);
    let (xg, xg1) = (x * g, x1 * g1);
    let (stretch, stretch1) = (a1 - x1 - c, a - x - d);
    Row {
        turn: [p * x, q * x1],
        pivot: [p * g - c, xg1 + c, q * g1 - d, xg + d],
        // (a' - x') d + (a - x) d' - d d', with d d' taken from the first.
        right: [
            p * xg + q * xg1 + stretch * d + (a - x) * c,
            (stretch - xg1) * d_rate + (stretch1 - xg) * c_rate,
        ],
    }
}

/// The three equations of a point.
#[derive(Clone, Copy)]
struct Point<P> {
    links: [Row<P>; 2],
    /// Of g g' + g + g' = 0.
    unit: [Z<P>; 2],
    rest: Z<P>,
}

/// Storage of [`solve`], made once.
pub(crate) struct Storage<P> {
    points: [Point<P>; PLACES],
    system: System<P>,
}

impl<P: Plain> Storage<P> {
    pub fn new() -> Self {
        let zero = Z::zero();
        let nothing = Row {
            turn: [zero; 2],
            pivot: [zero; 4],
            right: [zero; 2],
        };
        Self {
            points: [Point {
                links: [nothing; 2],
                unit: [zero; 2],
                rest: zero,
            }; PLACES],
            system: [[zero; PIVOTS + 2]; PIVOTS],
        }
    }
}

/// A linear system in lanes: eight rows, eight unknowns, two right-hand sides.
type System<P> = [[Z<P>; PIVOTS + 2]; PIVOTS];

/// The correction of Newton's method at a place of the way, and how the solution moves along it, both to be taken off. Where the system is singular they are
/// no numbers.
#[inline(always)]
pub(crate) fn solve<P: Plain>(
    way: &Way,
    t: P,
    at: &[Z<P>; UNKNOWNS],
    found: &mut [[Z<P>; UNKNOWNS]; 2],
    storage: &mut Storage<P>,
) {
    let Storage { points, system } = storage;
    let kind = way.from.kind;
    let zero = Z::<P>::zero();
    let first_link = [at[0], at[1], at[2], at[3]];
    let second_link = [at[4], at[5], at[6], at[7]];
    for j in 0..kind.points() {
        let turn = [at[8 + 2 * j], at[9 + 2 * j]];
        let place = [
            along(way.from.place[j], way.rate.place[j], t),
            along(way.from.hat[j], way.rate.hat[j], t),
        ];
        let rate = [wide(way.rate.place[j]), wide(way.rate.hat[j])];
        // Not mapped over arrays: that would not be compiled into this function.
        let point = &mut points[j];
        point.links[0] = link(first_link, turn, place, rate);
        point.links[1] = link(second_link, turn, place, rate);
        let [g, g1] = turn;
        let one = Z::<P>::one();
        let unit = [g1 + one, g + one];
        let rest = g * unit[0] + g1;
        // The combination that does not feel g and g'.
        let (l, m) = (point.links[0].turn, point.links[1].turn);
        let factors = [
            m[0] * unit[1] - unit[0] * m[1],
            unit[0] * l[1] - l[0] * unit[1],
            l[0] * m[1] - m[0] * l[1],
        ];
        let scale = larger(larger(size(factors[0]), size(factors[1])), size(factors[2]));
        let inverse = P::one() / scale;
        let f = factors[0].scale(inverse);
        let g = factors[1].scale(inverse);
        let h = factors[2].scale(inverse);
        let row = &mut system[j];
        for k in 0..4 {
            row[k] = f * point.links[0].pivot[k];
            row[4 + k] = g * point.links[1].pivot[k];
        }
        row[8] = f * point.links[0].right[0] + g * point.links[1].right[0] + h * rest;
        row[9] = f * point.links[0].right[1] + g * point.links[1].right[1];
        point.unit = unit;
        point.rest = rest;
    }
    let first = kind.points();
    for k in 0..kind.turns() {
        let j = first + k;
        let place = [
            along(way.from.place[j], way.rate.place[j], t),
            along(way.from.hat[j], way.rate.hat[j], t),
        ];
        let rate = [wide(way.rate.place[j]), wide(way.rate.hat[j])];
        let (turn, turn_rate) = turn_on_the_way(way, k, t);
        for side in 0..2 {
            let own = if side == 0 { first_link } else { second_link };
            let of_link = link(own, turn, place, rate);
            let row = &mut system[first + 2 * k + side];
            for m in 0..4 {
                row[4 * side + m] = of_link.pivot[m];
                row[4 - 4 * side + m] = zero;
            }
            row[8] = of_link.right[0];
            row[9] =
                of_link.right[1] + of_link.turn[0] * turn_rate[0] + of_link.turn[1] * turn_rate[1];
        }
    }
    eliminate(system);
    for side in 0..2 {
        for k in 0..PIVOTS {
            found[side][k] = system[k][8 + side];
        }
        for j in 0..kind.points() {
            let point = &points[j];
            let rest = if side == 0 { point.rest } else { zero };
            let of = &found[side];
            let first = point.links[0].left(&of[..4], side);
            let second = point.links[1].left(&of[4..8], side);
            let [g, g1] = turns(
                [point.links[0].turn, point.links[1].turn, point.unit],
                [first, second, rest],
            );
            found[side][8 + 2 * j] = g;
            found[side][9 + 2 * j] = g1;
        }
    }
}

impl<P: Plain> Row<P> {
    /// What is left of a right-hand side for the turn when the pivots are known.
    #[inline(always)]
    fn left(&self, pivots: &[Z<P>], side: usize) -> Z<P> {
        self.right[side]
            - self.pivot[0] * pivots[0]
            - self.pivot[1] * pivots[1]
            - self.pivot[2] * pivots[2]
            - self.pivot[3] * pivots[3]
    }
}

/// The turn less one of a given pose, its hat, and how both change along the way.
#[inline(always)]
fn turn_on_the_way<P: Plain>(way: &Way, pose: usize, t: P) -> ([Z<P>; 2], [Z<P>; 2]) {
    debug_assert!(pose < TURNS);
    let (from, rate) = (way.from.log_turn[pose], way.rate.log_turn[pose]);
    let log = along(from, rate, t);
    let (s, c) = log.im.sin_cos();
    let grown = log.re.exp();
    let turn = Z::new(grown * c, grown * s);
    let shrunk = P::one() / grown;
    let hat = Z::new(shrunk * c, -(shrunk * s));
    let one = Z::<P>::one();
    let rate = wide(rate);
    ([turn - one, hat - one], [rate * turn, -(rate * hat)])
}

/// Two unknowns of three equations that agree: the mean of what the three pairs tell, each as much as it knows.
#[inline(always)]
fn turns<P: Plain>(rows: [[Z<P>; 2]; 3], left: [Z<P>; 3]) -> [Z<P>; 2] {
    let (mut sums, mut weight) = ([Z::<P>::zero(); 2], P::zero());
    for (i, k) in [(0, 1), (0, 2), (1, 2)] {
        let (p, q) = (rows[i], rows[k]);
        let minor = (p[0] * q[1] - q[0] * p[1]).conj();
        weight += minor.norm_sqr();
        sums[0] += minor * (left[i] * q[1] - left[k] * p[1]);
        sums[1] += minor * (p[0] * left[k] - q[0] * left[i]);
    }
    let inverse = P::one() / weight;
    [sums[0].scale(inverse), sums[1].scale(inverse)]
}

/// Gaussian elimination with partial pivoting, each lane by its own pivots; the solutions take the place of the right-hand sides.
#[inline(always)]
fn eliminate<P: Plain>(a: &mut System<P>) {
    const N: usize = PIVOTS;
    let mut inverse = [Z::<P>::zero(); N];
    for k in 0..N {
        let (above, below) = a.split_at_mut(k + 1);
        let pivot = &mut above[k];
        for other in below.iter_mut() {
            let key = size(other[k]) - size(pivot[k]);
            if key.any_positive() {
                for j in k..N + 2 {
                    P::swap_where_positive(key, &mut pivot[j].re, &mut other[j].re);
                    P::swap_where_positive(key, &mut pivot[j].im, &mut other[j].im);
                }
            }
        }
        inverse[k] = pivot[k].recip();
        for other in below.iter_mut() {
            let factor = other[k] * inverse[k];
            for j in k + 1..N + 2 {
                other[j] -= factor * pivot[j];
            }
        }
    }
    for k in (0..N).rev() {
        for m in N..N + 2 {
            let mut sum = a[k][m];
            for j in k + 1..N {
                sum -= a[k][j] * a[j][m];
            }
            a[k][m] = sum * inverse[k];
        }
    }
}

/// What the equations miss zero by: both links at every place, then the units of the points; zeros behind.
pub fn residuals(given: &Given, at: &State) -> [C; 3 * PLACES] {
    let kind = given.kind;
    let mut out = [C::zero(); 3 * PLACES];
    for j in 0..kind.places() {
        let turn = if j < kind.points() {
            [at[8 + 2 * j], at[9 + 2 * j]]
        } else {
            given.turn(j - kind.points()).map(|t| t - C::one())
        };
        let place = [given.place[j], given.hat[j]];
        for side in 0..2 {
            let pivots = std::array::from_fn(|k| at[4 * side + k]);
            out[2 * j + side] = link::<f64>(pivots, turn, place, [C::zero(); 2]).right[0];
        }
        if j < kind.points() {
            out[2 * kind.places() + j] = turn[0] * turn[1] + turn[0] + turn[1];
        }
    }
    out
}

/// Newton's correction at given data, to be taken off; `None` where the system is singular.
pub fn correction(given: &Given, at: &State) -> Option<State> {
    let mut found = [[C::zero(); UNKNOWNS]; 2];
    solve::<f64>(&Way::at(given), 0.0, at, &mut found, &mut Storage::new());
    let finite = found[0].iter().all(|z| z.is_finite());
    finite.then_some(found[0])
}

/// Fills in the turns at the points of pivots that solve the equations: of each three equations, those two that tell best.
pub fn with_turns(given: &Given, pivots: &[C; PIVOTS]) -> State {
    let mut state = [C::zero(); UNKNOWNS];
    state[..PIVOTS].copy_from_slice(pivots);
    for j in 0..given.kind.points() {
        let place = [given.place[j], given.hat[j]];
        let rows = [0, 1].map(|side| {
            let own = std::array::from_fn(|k| pivots[4 * side + k]);
            link::<f64>(own, [C::zero(); 2], place, [C::zero(); 2])
        });
        let (p, q) = (rows[0].turn, rows[1].turn);
        let left = rows.map(|row| -row.right[0]);
        let inverse = (p[0] * q[1] - q[0] * p[1]).recip();
        state[8 + 2 * j] = (left[0] * q[1] - left[1] * p[1]) * inverse;
        state[9 + 2 * j] = (p[0] * left[1] - q[0] * left[0]) * inverse;
    }
    state
}
