//! All solutions of generic data, found from a single one: solutions are carried between a few sets of data until nothing new appears.
//!
//! Each way between two sets is a bijection of their solutions, and round each loop of ways solutions change places (T. Duff et al., IMA J.
//! Numer. Anal. 39:1421, 2019). Each solution is carried along each way at most once. As the number of solutions is known, it is also known when
//! all are found.

use std::ops::ControlFlow;

use kempe_linear::C;
use kempe_number::Random;

use crate::class::{Class, Classes};
use crate::equations::{PIVOTS, State, UNKNOWNS, correction};
use crate::follow::follow_all;
use crate::given::{Given, Kind, PLACES, random_log};
use crate::tracker::{CARES, End};

/// Data with their solutions, one of each class.
#[derive(Clone, Debug)]
pub struct Found {
    /// The data.
    pub given: Given,
    /// Solutions.
    pub solutions: Vec<State>,
    /// Paths that were followed for them.
    pub paths: usize,
}

/// A made-up complex four-bar at places that it passes; `None` by chance.
pub fn made_up(kind: Kind, random: &mut Random) -> Option<(Given, State)> {
    let mut state = [C::zero(); UNKNOWNS];
    for pivot in &mut state[..PIVOTS] {
        *pivot = random.complex();
    }
    let [x, a, x1, a1, y, b, y1, b1] = std::array::from_fn(|k| state[k]);
    let mut given = Given::zero(kind);
    for log in &mut given.log_turn[..kind.turns()] {
        *log = random_log(random);
    }
    let one = C::one();
    for j in 0..kind.places() {
        let [turn, hat] = if j < kind.points() {
            let turn = random.complex();
            (state[8 + 2 * j], state[9 + 2 * j]) = (turn - one, turn.recip() - one);
            [turn, turn.recip()]
        } else {
            given.turn(j - kind.points())
        };
        let (g, g1) = (turn - one, hat - one);
        // Of each link: p d + q d' + r = d d'.
        let link =
            |[x, a, x1, a1]: [C; 4]| [a1 - x1 - x1 * g1, a - x - x * g, a1 * x * g + a * x1 * g1];
        let (first, second) = (link([x, a, x1, a1]), link([y, b, y1, b1]));
        // Their difference is linear: d' = u d + v.
        let over = (second[1] - first[1]).recip();
        let u = (first[0] - second[0]) * over;
        let v = (first[2] - second[2]) * over;
        // u d^2 + (v - p - q u) d - q v - r = 0.
        let [p, q, r] = first;
        let half = (v - p - q * u).scale(0.5);
        let root = (half * half + u * (q * v + r)).sqrt();
        let d = (root - half) * u.recip();
        (given.place[j], given.hat[j]) = (d, u * d + v);
    }
    let step = correction(&given, &state)?;
    let fits = step.iter().all(|z| z.norm() < 1e-9);
    fits.then_some((given, state))
}

/// Sets of data that solutions are carried between, and more where these are not enough.
const NODES: usize = 4;
const MORE_NODES: usize = 12;

struct Node {
    given: Given,
    solutions: Vec<State>,
    classes: Classes,
}

struct Edge {
    ends: [usize; 2],
    /// Of the solutions of either end, those that came from or went to the other one.
    carried: [Vec<bool>; 2],
}

/// All solutions of some generic data, one of each class; fewer than [`Kind::classes`] only where paths were lost. The same everywhere for the same seed.
pub fn monodromy(kind: Kind, seed: u64) -> Found {
    let mut random = Random(seed);
    let (given, first) = loop {
        if let Some(made) = made_up(kind, &mut random) {
            break made;
        }
    };
    let mut nodes = vec![node(given)];
    nodes[0].take(&first);
    let mut edges: Vec<Edge> = Vec::new();
    let mut paths = 0;
    for nodes_wanted in NODES..=MORE_NODES {
        while nodes.len() < nodes_wanted {
            let new = nodes.len();
            nodes.push(node(Given::random(kind, &mut random)));
            edges.extend((0..new).map(|old| Edge {
                ends: [old, new],
                carried: [Vec::new(), Vec::new()],
            }));
        }
        let mut quiet = false;
        while !quiet {
            quiet = true;
            for edge in &mut edges {
                for side in 0..2 {
                    if let Some(full) = nodes
                        .iter()
                        .position(|n| n.solutions.len() >= kind.classes())
                    {
                        let full = nodes.swap_remove(full);
                        return Found {
                            given: full.given,
                            solutions: full.solutions,
                            paths,
                        };
                    }
                    let sent = edge.carry(&mut nodes, side);
                    paths += sent;
                    quiet &= sent == 0;
                }
            }
        }
    }
    let most = nodes.into_iter().max_by_key(|n| n.solutions.len());
    let (given, solutions) = most.map_or((given, vec![first]), |n| (n.given, n.solutions));
    Found {
        given,
        solutions,
        paths,
    }
}

fn node(given: Given) -> Node {
    Node {
        given,
        solutions: Vec::new(),
        classes: Classes::default(),
    }
}

impl Node {
    /// The number of a solution, which is kept if it is new.
    fn take(&mut self, state: &State) -> usize {
        let class = Class::of(self.given.kind, state);
        if let Some(known) = self.classes.find(&class) {
            return known;
        }
        let number = self.solutions.len();
        self.classes.add(class, number);
        self.solutions.push(*state);
        number
    }
}

impl Edge {
    /// Carries what has not been carried yet from one end to the other; how many that were.
    fn carry(&mut self, nodes: &mut [Node], side: usize) -> usize {
        let (from, to) = (self.ends[side], self.ends[1 - side]);
        let own = &mut self.carried[side];
        own.resize(nodes[from].solutions.len(), false);
        let open: Vec<usize> = (0..own.len()).filter(|k| !own[*k]).collect();
        open.iter().for_each(|k| own[*k] = true);
        let starts: Vec<State> = open.iter().map(|k| nodes[from].solutions[*k]).collect();
        let (start, target) = (nodes[from].given, nodes[to].given);
        let go_on = |_, _| ControlFlow::Continue(());
        let ends = follow_all(&start, &target, &starts, CARES[0], &go_on).unwrap_or_default();
        for end in &ends {
            if let End::Arrived(state) = end {
                let number = nodes[to].take(state);
                let other = &mut self.carried[1 - side];
                if other.len() <= number {
                    other.resize(number + 1, false);
                }
                other[number] = true;
            }
        }
        debug_assert!(target.kind.places() <= PLACES);
        starts.len()
    }
}
