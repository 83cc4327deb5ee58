//! Solutions that are one answer: the same four-bar with its links exchanged, and of nine points the three cognates of one coupler curve.
//!
//! The symmetric functions of the three foci are the same for all six forms (S. Roberts 1875); with poses, those of the two dyads for both.

use kempe_linear::C;

use crate::equations::{State, UNKNOWNS};
use crate::given::{Given, Kind};

/// What all forms of an answer share: each number with the size of what it is a sum of.
#[derive(Clone, Copy, Debug)]
pub struct Class {
    shared: [(C, f64); 8],
}

/// Classes nearer than this, beside the sizes, are one: far above rounding, far below what lies between generic solutions.
pub const SAME_CLASS: f64 = 1e-7;

impl Class {
    /// The class of a solution.
    pub fn of(kind: Kind, state: &State) -> Self {
        let [x, a, x1, a1, y, b, y1, b1] = std::array::from_fn(|k| state[k]);
        let (plain, hats) = (four(kind, [x, a, y, b]), four(kind, [x1, a1, y1, b1]));
        Self {
            shared: std::array::from_fn(|k| if k < 4 { plain[k] } else { hats[k - 4] }),
        }
    }

    /// Whether two solutions are of one class.
    pub fn is(&self, other: &Self) -> bool {
        (self.shared.iter().zip(&other.shared))
            .all(|((p, size), (q, _))| (*p - *q).norm() <= SAME_CLASS * size)
    }

    /// By what classes are sorted, and how far off those of one class may be.
    fn key(&self) -> (f64, f64) {
        let (first, size) = self.shared[0];
        (first.re, SAME_CLASS * size)
    }
}

/// The third focus, seen as the first two.
fn third_focus([x, a, y, b]: [C; 4]) -> C {
    (b * x - a * y) * (x - y).recip()
}

/// The next of the three four-bars of nine points that trace one coupler curve, at the same points; thrice back. Its links turn as this one's second link, coupler and
/// first link do: no number where the moving pivots are one.
///
/// (x, a, y, b) goes to ((x - a) y / (x - y), (b x - a y) / (x - y), a - x, a), and its coupler turns as the first link did.
pub fn cognate(given: &Given, state: &State) -> State {
    let mut next = [C::zero(); UNKNOWNS];
    for hat in [0, 2] {
        let [x, a, y, b] = [0, 1, 4, 5].map(|k| state[k + hat]);
        let over = (x - y).recip();
        next[hat] = (x - a) * y * over;
        next[1 + hat] = (b * x - a * y) * over;
        next[4 + hat] = a - x;
        next[5 + hat] = a;
        let link = (x - a).recip();
        for j in 0..given.kind.points() {
            let (place, turn) = if hat == 0 {
                (given.place[j], 8 + 2 * j)
            } else {
                (given.hat[j], 9 + 2 * j)
            };
            next[turn] = (place + state[turn] * x) * link;
        }
    }
    next
}

fn four(kind: Kind, pivots: [C; 4]) -> [(C, f64); 4] {
    let [x, a, y, b] = pivots;
    if kind == Kind::NinePoints {
        let c = third_focus(pivots);
        let size = 1.0 + a.norm() + b.norm() + c.norm();
        let products = a * b + b * c + c * a;
        [
            (a + b + c, size),
            (products, size * size),
            (a * b * c, size * size * size),
            (products, size * size),
        ]
    } else {
        let (fixed, moving) = (1.0 + a.norm() + b.norm(), 1.0 + x.norm() + y.norm());
        [
            (a + b, fixed),
            (a * b, fixed * fixed),
            (x + y, moving),
            (a * x + b * y, fixed * moving),
        ]
    }
}

/// Classes, each with a number, that are quickly found again.
#[derive(Default)]
pub(crate) struct Classes {
    /// By key.
    sorted: Vec<(f64, Class, usize)>,
}

impl Classes {
    /// The number of a class that is known.
    pub fn find(&self, class: &Class) -> Option<usize> {
        let (key, reach) = class.key();
        let from = self.sorted.partition_point(|(k, ..)| *k < key - reach);
        (self.sorted[from..].iter())
            .take_while(|(k, ..)| *k <= key + reach)
            .find(|(_, other, _)| class.is(other))
            .map(|(.., number)| *number)
    }

    /// Adds a class that is not known.
    pub fn add(&mut self, class: Class, number: usize) {
        let (key, _) = class.key();
        let at = self.sorted.partition_point(|(k, ..)| *k < key);
        self.sorted.insert(at, (key, class, number));
    }
}
