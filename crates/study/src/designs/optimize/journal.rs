//! What was asked of designs, so that a search that was killed goes on where it was: the same search is made again, and what it asked before is looked up.
//!
//! Which designs are asked hangs on the answers alone, so that a search over answers that were kept runs as it did the first time, whatever
//! the method. In the parts there is what was asked since the part before, in whatever order it was answered.

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

use kempe_model::Diagnostic;
use kempe_motion::Watch;
use kempe_optimize::{Evaluation, Piece, Slopes};

use crate::designs::kept_parts::Parts;

/// Answers in the first parts; later parts have more, so that there are never too many of them.
const IN_PART: usize = 16;
/// After so many parts each has as many more.
const STEP: usize = 64;
/// So many parts there are at most: what is asked after them is not kept.
pub(super) const MOST_PARTS: usize = 4096;

/// What is asked of designs: the numbers that methods see, or those of a fit of which they see the sum, its places paired as the number says.
pub(super) type Of = u64;
/// The numbers that methods see.
pub(super) const SUMS: Of = 0;

/// What is asked, and the parameters of a design by their bits.
type Key = Vec<u64>;

/// An answer, and why there is none.
#[derive(Clone, Debug, PartialEq)]
enum Answer {
    Evaluation(Evaluation, Option<String>),
    Slopes(Option<Slopes>),
}

/// What was asked, and what was answered.
#[derive(Debug, Default)]
pub(super) struct Journal {
    evaluations: BTreeMap<Key, (Evaluation, Option<String>)>,
    slopes: BTreeMap<Key, Option<Slopes>>,
    /// What is in no part yet.
    new: Mutex<Vec<(Key, Answer)>>,
    /// How many parts there are.
    parts: usize,
    /// Whether anything is kept.
    keeps: bool,
    /// What says whether answers may be cut short: these are not kept.
    pub watch: Watch,
}

/// What a lock holds, whatever became of who held it.
pub(super) fn lock<T>(it: &Mutex<T>) -> MutexGuard<'_, T> {
    it.lock().unwrap_or_else(PoisonError::into_inner)
}

fn key(of: Of, values: &[f64]) -> Key {
    let bits = values.iter().map(|x| x.to_bits());
    [of].into_iter().chain(bits).collect()
}

impl Journal {
    /// What was kept of a search with so many variables, objectives and constraints.
    ///
    /// # Errors
    ///
    /// Why it cannot be had.
    pub fn open(parts: &mut dyn Parts, shape: [usize; 3]) -> Result<Self, Box<Diagnostic>> {
        let mut journal = Self {
            keeps: parts.rows(),
            ..Self::default()
        };
        while journal.keeps && journal.parts < MOST_PARTS {
            let bytes = parts.kept(journal.parts)?;
            let Some(answers) = bytes.and_then(|bytes| {
                Reader {
                    left: &bytes,
                    shape,
                }
                .all()
            }) else {
                break;
            };
            for (key, answer) in answers {
                match answer {
                    Answer::Evaluation(evaluation, why) => {
                        journal.evaluations.insert(key, (evaluation, why));
                    }
                    Answer::Slopes(slopes) => {
                        journal.slopes.insert(key, slopes);
                    }
                }
            }
            journal.parts += 1;
        }
        Ok(journal)
    }

    /// What a design is worth: looked up, or asked.
    pub fn evaluation(
        &self,
        of: Of,
        values: &[f64],
        ask: impl FnOnce() -> (Evaluation, Option<String>),
    ) -> (Evaluation, Option<String>) {
        let key = key(of, values);
        if let Some(known) = self.evaluations.get(&key) {
            return known.clone();
        }
        let (evaluation, why) = ask();
        self.add(key, || Answer::Evaluation(evaluation.clone(), why.clone()));
        (evaluation, why)
    }

    /// The slopes of a design: looked up, or asked.
    pub fn slopes(
        &self,
        of: Of,
        values: &[f64],
        ask: impl FnOnce() -> Option<Slopes>,
    ) -> Option<Slopes> {
        let key = key(of, values);
        if let Some(known) = self.slopes.get(&key) {
            return known.clone();
        }
        let slopes = ask();
        self.add(key, || Answer::Slopes(slopes.clone()));
        slopes
    }

    fn add(&self, key: Key, answer: impl FnOnce() -> Answer) {
        if self.keeps && !self.watch.stops() {
            lock(&self.new).push((key, answer()));
        }
    }

    /// Keeps what was asked since the last part, if it is enough for one.
    ///
    /// # Errors
    ///
    /// Why it cannot be kept.
    pub fn keep(&self, next: &mut usize, parts: &mut dyn Parts) -> Result<(), Box<Diagnostic>> {
        let mut new = lock(&self.new);
        if new.len() < IN_PART * (1 + *next / STEP) {
            return Ok(());
        }
        let answers = std::mem::take(&mut *new);
        if *next < MOST_PARTS {
            let mut bytes = Vec::new();
            answers.iter().for_each(|answer| write(&mut bytes, answer));
            parts.keep(*next, bytes)?;
            *next += 1;
        }
        Ok(())
    }

    /// How many parts there are to begin with.
    pub fn parts(&self) -> usize {
        self.parts
    }
}

fn count(bytes: &mut Vec<u8>, n: usize) {
    bytes.extend((n as u32).to_le_bytes());
}

fn number(bytes: &mut Vec<u8>, x: f64) {
    bytes.extend(x.to_bits().to_le_bytes());
}

/// An answer with what was asked: a letter, the design, then what there is.
fn write(bytes: &mut Vec<u8>, (key, answer): &(Key, Answer)) {
    bytes.push(match answer {
        Answer::Evaluation(..) => b'e',
        Answer::Slopes(Some(_)) => b's',
        Answer::Slopes(None) => b'n',
    });
    key.iter().for_each(|bits| bytes.extend(bits.to_le_bytes()));
    match answer {
        Answer::Evaluation(evaluation, why) => {
            number(bytes, evaluation.lack);
            let why = why.as_deref().unwrap_or_default();
            count(bytes, why.len());
            bytes.extend(why.as_bytes());
            if evaluation.is_defined() {
                let values = evaluation.objectives.iter().chain(&evaluation.constraints);
                values.for_each(|x| number(bytes, *x));
            }
        }
        Answer::Slopes(Some(slopes)) => {
            for pieces in slopes.objectives.iter().chain(&slopes.constraints) {
                count(bytes, pieces.len());
                for piece in pieces {
                    number(bytes, piece.value);
                    piece.slope.iter().for_each(|x| number(bytes, *x));
                }
            }
        }
        Answer::Slopes(None) => {}
    }
}

/// Reads answers of a search with so many variables, objectives and constraints.
struct Reader<'b> {
    left: &'b [u8],
    shape: [usize; 3],
}

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (own, rest) = self.left.split_first_chunk::<N>()?;
        self.left = rest;
        Some(*own)
    }

    fn bits(&mut self) -> Option<u64> {
        self.take().map(u64::from_le_bytes)
    }

    fn count(&mut self) -> Option<usize> {
        self.take().map(|bytes| u32::from_le_bytes(bytes) as usize)
    }

    fn numbers(&mut self, count: usize) -> Option<Vec<f64>> {
        (0..count)
            .map(|_| self.bits().map(f64::from_bits))
            .collect()
    }

    fn functions(&mut self, count: usize) -> Option<Vec<Vec<Piece>>> {
        let [variables, ..] = self.shape;
        let one = |reader: &mut Self| {
            let pieces = reader.count()?;
            let piece = |reader: &mut Self| {
                Some(Piece {
                    value: reader.numbers(1)?[0],
                    slope: reader.numbers(variables)?,
                })
            };
            (0..pieces).map(|_| piece(reader)).collect()
        };
        (0..count).map(|_| one(self)).collect()
    }

    fn one(&mut self) -> Option<(Key, Answer)> {
        let [letter] = self.take()?;
        let [variables, objectives, constraints] = self.shape;
        let key: Option<Key> = (0..=variables).map(|_| self.bits()).collect();
        let key = key?;
        let answer = match letter {
            b'e' => {
                let lack = f64::from_bits(self.bits()?);
                let length = self.count()?;
                let why = self.left.get(..length)?;
                let why = std::str::from_utf8(why).ok()?.to_owned();
                self.left = &self.left[length..];
                let mut evaluation = Evaluation::lacking(lack);
                if evaluation.is_defined() {
                    evaluation.objectives = self.numbers(objectives)?;
                    evaluation.constraints = self.numbers(constraints)?;
                }
                Answer::Evaluation(evaluation, (!why.is_empty()).then_some(why))
            }
            b's' => Answer::Slopes(Some(Slopes {
                objectives: self.functions(objectives)?,
                constraints: self.functions(constraints)?,
            })),
            b'n' => Answer::Slopes(None),
            _ => return None,
        };
        Some((key, answer))
    }

    fn all(&mut self) -> Option<Vec<(Key, Answer)>> {
        let mut all = Vec::new();
        while !self.left.is_empty() {
            all.push(self.one()?);
        }
        Some(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn answers_are_read_as_they_were_written() {
        let piece = |value: f64| Piece {
            value,
            slope: vec![1.0 / 3.0, -0.0],
        };
        let evaluation = Evaluation {
            objectives: vec![0.1],
            constraints: vec![-1e300, 5e-324],
            lack: 0.0,
        };
        let all = [
            (
                key(SUMS, &[0.1, -0.0]),
                Answer::Evaluation(evaluation, None),
            ),
            (
                key(SUMS, &[f64::MIN_POSITIVE, 2.0]),
                Answer::Evaluation(
                    Evaluation::lacking(0.25),
                    Some("it does not close: ä".to_owned()),
                ),
            ),
            (
                key(1, &[1.0, 2.0]),
                Answer::Slopes(Some(Slopes {
                    objectives: vec![vec![piece(1.0), piece(0.5)]],
                    constraints: vec![vec![piece(2.0)], vec![piece(3.0)]],
                })),
            ),
            (key(2, &[3.0, 4.0]), Answer::Slopes(None)),
        ];
        let mut bytes = Vec::new();
        all.iter().for_each(|answer| write(&mut bytes, answer));
        let read = |left: &[u8], shape| Reader { left, shape }.all();
        assert_eq!(read(&bytes, [2, 1, 2]).as_deref(), Some(&all[..]));
        // Cut anywhere but between two answers, or read as of another search, it is nothing.
        let whole: Vec<usize> = (1..bytes.len())
            .filter(|end| read(&bytes[..*end], [2, 1, 2]).is_some())
            .collect();
        assert_eq!(whole.len(), all.len() - 1);
        assert_eq!(read(&bytes, [3, 1, 2]), None);
    }
}
