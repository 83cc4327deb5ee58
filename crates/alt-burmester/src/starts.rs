//! Generic data with all their solutions, to start from; as bytes, so that they need be found only once.

use kempe_linear::C;

use crate::equations::{PIVOTS, State, correction, with_turns};
use crate::given::{Given, Kind};
use crate::monodromy::{Found, monodromy};

/// Generic data with one solution of each class.
#[derive(Clone, Debug, PartialEq)]
pub struct StartSet {
    /// The data.
    pub given: Given,
    /// The solutions.
    pub solutions: Vec<State>,
}

/// Newton's corrections of solutions that were read.
const CORRECTIONS: usize = 3;
/// Seeds that are tried, one after the other, until nothing is missing.
const SEEDS: std::ops::Range<u64> = 1..5;

impl StartSet {
    /// Finds the solutions by monodromy: a second of work. `None` where some are missing, which has not been seen.
    pub fn found(kind: Kind) -> Option<Self> {
        SEEDS.map(|seed| monodromy(kind, seed)).find_map(
            |Found {
                 given, solutions, ..
             }| {
                (solutions.len() == kind.classes()).then_some(Self { given, solutions })
            },
        )
    }

    /// As little-endian `f64`s: poses after the first, the data, and the pivot coordinates of the solutions.
    pub fn to_bytes(&self) -> Vec<u8> {
        let given = &self.given;
        let (places, turns) = (given.kind.places(), given.kind.turns());
        let data = given.place[..places]
            .iter()
            .chain(&given.hat[..places])
            .chain(&given.log_turn[..turns]);
        let pivots = self.solutions.iter().flat_map(|state| &state[..PIVOTS]);
        let mut bytes = Vec::from((turns as f64).to_le_bytes());
        for z in data.chain(pivots) {
            bytes.extend(z.re.to_le_bytes());
            bytes.extend(z.im.to_le_bytes());
        }
        bytes
    }

    /// Reads what [`Self::to_bytes`] wrote, and corrects it by Newton's method; `None` for anything else.
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let (numbers, rest) = bytes.as_chunks::<8>();
        if !rest.is_empty() {
            return None;
        }
        let mut numbers = numbers.iter().map(|bytes| f64::from_le_bytes(*bytes));
        let turns = numbers.next()?;
        let kind = Kind::ALL.into_iter().find(|k| k.turns() as f64 == turns)?;
        let mut next = || Some(C::new(numbers.next()?, numbers.next()?));
        let mut given = Given::zero(kind);
        for place in &mut given.place[..kind.places()] {
            *place = next()?;
        }
        for hat in &mut given.hat[..kind.places()] {
            *hat = next()?;
        }
        for log in &mut given.log_turn[..kind.turns()] {
            *log = next()?;
        }
        let mut solutions = Vec::with_capacity(kind.classes());
        while let Some(first) = next() {
            let mut pivots = [first; PIVOTS];
            for pivot in &mut pivots[1..] {
                *pivot = next()?;
            }
            let mut state = with_turns(&given, &pivots);
            for _ in 0..CORRECTIONS {
                let step = correction(&given, &state)?;
                for (x, step) in state.iter_mut().zip(step) {
                    *x -= step;
                }
            }
            solutions.push(state);
        }
        Some(Self { given, solutions })
    }
}
