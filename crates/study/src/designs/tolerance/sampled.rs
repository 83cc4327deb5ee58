//! Pieces are drawn, moved and measured: in lanes what lanes can tell, the rest one piece after the other.

use kempe_batch::Executor;
use kempe_measure::side_by_side::{TOGETHER, widen};
use kempe_motion::Motion;
use kempe_motion::progress::{Done, Progress, Silent, Stage};
use kempe_number::InstructionSet;

use super::sobol::Sobol;
use super::source::{Kind, Source};
use crate::designs::bench::{Bench, Refused};
use crate::designs::lanes::{InLanes, PIECES};
use crate::designs::together::together;
use crate::quantity::Quantity;
use crate::rows::RowPlace;

/// Pieces of a task in lanes.
const LANES_TASK: usize = 4 * PIECES;
/// Pieces of a task that follows each.
const MOTIONS_TASK: usize = 8;
/// Tasks between two questions to the progress.
const TASKS_TOGETHER: usize = 32;
/// Of so many pieces the quantiles along the motion are told.
pub(crate) const KEPT: usize = 2048;
/// Of so many curves are followed that lanes do not tell, where nothing else is asked of their pieces.
pub(super) const KEPT_FOLLOWED: usize = 256;
/// So many pieces are moved by themselves to see how far lanes are right.
pub(super) const CHECKED: usize = 5;

/// What is asked of pieces.
pub(super) struct Question<'q, 'm> {
    pub bench: &'q Bench<'m>,
    pub sources: &'q [Source],
    pub own: Vec<f64>,
    pub sobol: Sobol,
    pub samples: usize,
    /// What is followed along the motion, and its rows.
    pub curves: &'q [Quantity],
    pub rows: &'q [RowPlace],
    pub lanes: Option<InLanes>,
    /// Whether pieces may have dimensions that make no sense.
    pub may_be_unsound: bool,
}

/// How a curve lies over the pieces, by row.
#[derive(Clone, Debug, Default)]
pub(super) struct Band {
    pub least: Vec<f64>,
    pub greatest: Vec<f64>,
    /// Values of the first pieces.
    pub kept: Vec<Vec<f64>>,
}

/// What was found of pieces.
#[derive(Clone, Debug, Default)]
pub(super) struct Pieces {
    /// How many there are.
    pub count: usize,
    /// By number.
    pub numbers: Vec<Vec<f64>>,
    /// Whether each moves as asked.
    pub moves: Vec<bool>,
    /// By curve.
    pub bands: Vec<Band>,
    /// Which of them lanes could not tell, as they are found.
    doubtful: Vec<usize>,
}

impl Pieces {
    fn new(numbers: usize, curves: usize, rows: usize) -> Self {
        let band = Band {
            least: vec![f64::INFINITY; rows],
            greatest: vec![f64::NEG_INFINITY; rows],
            kept: vec![Vec::new(); rows],
        };
        Self {
            count: 0,
            numbers: vec![Vec::new(); numbers],
            moves: Vec::new(),
            bands: vec![band; curves],
            doubtful: Vec::new(),
        }
    }

    /// Puts what was found of further pieces behind.
    fn append(&mut self, part: Self) {
        self.count += part.count;
        self.moves.extend(part.moves);
        for (own, more) in self.numbers.iter_mut().zip(part.numbers) {
            own.extend(more);
        }
        for (own, more) in self.bands.iter_mut().zip(part.bands) {
            own.append(more);
        }
    }
}

impl Band {
    fn add(&mut self, row: usize, value: f64, keep: bool) {
        if value < self.least[row] {
            self.least[row] = value;
        }
        if value > self.greatest[row] {
            self.greatest[row] = value;
        }
        if keep && value.is_finite() {
            self.kept[row].push(value);
        }
    }

    /// Those of many pieces; the first ones are kept.
    fn add_all(&mut self, row: usize, values: &[f64; TOGETHER], keep: usize) {
        let range = [self.least[row], self.greatest[row]];
        [self.least[row], self.greatest[row]] = widen(InstructionSet::detect(), range, values);
        let kept = values.iter().take(keep).filter(|x| x.is_finite());
        self.kept[row].extend(kept);
    }

    fn append(&mut self, more: Self) {
        for (own, value) in self.least.iter_mut().zip(more.least) {
            *own = own.min(value);
        }
        for (own, value) in self.greatest.iter_mut().zip(more.greatest) {
            *own = own.max(value);
        }
        for (own, values) in self.kept.iter_mut().zip(more.kept) {
            own.extend(values);
        }
    }
}

impl Question<'_, '_> {
    /// A varied parameter of a piece, where parameters alone differ.
    fn drawn(&self, piece: usize, k: usize) -> f64 {
        match &self.sources[k].kind {
            Kind::Parameter(deviation) => {
                self.own[k] + deviation.at(self.sobol.coordinate(piece as u32, k))
            }
            _ => self.values(piece)[k],
        }
    }

    /// The varied parameters of a piece.
    pub fn values(&self, piece: usize) -> Vec<f64> {
        let mut values = self.own.clone();
        let mut parameters = Vec::new();
        for (k, source) in self.sources.iter().enumerate() {
            let is_play = !matches!(source.kind, Kind::Parameter(_));
            // How much play there is may hang on what else differs.
            if is_play && parameters.is_empty() {
                parameters = self.bench.parameters(&values);
            }
            let part = self.sobol.coordinate(piece as u32, k);
            source.put(part, &parameters, &mut values);
        }
        values
    }

    /// Numbers that lanes do not tell.
    pub fn followed_numbers(&self) -> Vec<usize> {
        let told = |k: &usize| (self.lanes.as_ref()).is_some_and(|l| l.numbers[*k].is_some());
        (0..self.bench.numbers.len()).filter(|k| !told(k)).collect()
    }

    fn followed_curves(&self) -> Vec<usize> {
        let told = |k: &usize| (self.lanes.as_ref()).is_some_and(|l| l.curves[*k].is_some());
        (0..self.curves.len()).filter(|k| !told(k)).collect()
    }

    /// Curves that are followed where pieces are moved for nothing else: of the first pieces alone.
    pub fn curves_alone(&self) -> Vec<usize> {
        match self.followed_numbers().is_empty() && self.lanes.is_some() {
            true => self.followed_curves(),
            false => Vec::new(),
        }
    }

    /// Draws and measures all pieces, or as many as the progress allows.
    pub fn answer(&self, executor: &dyn Executor, progress: &mut dyn Progress) -> Pieces {
        let all = || Pieces::new(self.bench.numbers.len(), self.curves.len(), self.rows.len());
        let mut found = all();
        let (numbers, curves) = (self.followed_numbers(), self.followed_curves());
        let follows = !numbers.is_empty() || !curves.is_empty() || self.lanes.is_none();
        let task = if numbers.is_empty() && self.lanes.is_some() {
            LANES_TASK
        } else {
            MOTIONS_TASK
        };
        let own = (&numbers[..], &curves[..]);
        self.bench.watched(progress.watch(), || {
            let watch = self.bench.watch();
            let mut reached = |count: usize| {
                let done = Done::Of(count.min(self.samples), self.samples);
                progress.reached(Stage::Rows, done)
            };
            while found.count < self.samples {
                let first = found.count;
                let until = (first + task * TASKS_TOGETHER).min(self.samples);
                let ask = |k: usize| {
                    let mut part = all();
                    let range = first + k * task..(first + (k + 1) * task).min(until);
                    match &self.lanes {
                        Some(lanes) => self.in_lanes(lanes, range.clone(), &mut part),
                        None => part.unknown(range.len()),
                    }
                    if follows || !part.doubtful.is_empty() {
                        self.followed(own, range, &mut part);
                    }
                    part
                };
                let tasks = (until - first).div_ceil(task);
                let mut heard = |finished| reached(first + finished * task);
                let (parts, goes_on) = together(tasks, executor, &watch, &mut heard, ask);
                parts.into_iter().for_each(|part| found.append(part));
                if !goes_on || reached(found.count).is_break() {
                    break;
                }
            }
        });
        found
    }

    fn in_lanes(&self, lanes: &InLanes, range: std::ops::Range<usize>, part: &mut Pieces) {
        let mut scratch = lanes.scratch();
        for first in range.clone().step_by(PIECES) {
            let count = PIECES.min(range.end - first);
            let drawn = |piece: usize, k: usize| self.drawn(first + piece, k);
            lanes.pieces(count, drawn, &mut scratch, |from, found, along| {
                let own = TOGETHER.min(count - from);
                let sound =
                    |lane: usize| !self.may_be_unsound || self.is_sound(first + from + lane);
                let moves: Vec<bool> = (0..own)
                    .map(|lane| found.closes[lane] && sound(lane))
                    .collect();
                let good = moves.iter().zip(&found.doubtful);
                let good: Vec<bool> = good.map(|(moves, doubt)| *moves && !doubt).collect();
                let doubtful = (0..own).filter(|lane| moves[*lane] && !good[*lane]);
                part.doubtful.extend(doubtful.map(|lane| part.count + lane));
                for (numbers, value) in part.numbers.iter_mut().zip(&found.numbers) {
                    let values = value.0.iter().zip(&good);
                    numbers.extend(values.map(|(x, good)| if *good { *x } else { f64::NAN }));
                }
                let all_good = own == TOGETHER && good.iter().all(|good| *good);
                let keep = KEPT.saturating_sub(first + from).min(own);
                for (k, band) in part.bands.iter_mut().enumerate() {
                    for row in 0..self.rows.len() {
                        let Some(values) = along.curve(k, row) else {
                            break;
                        };
                        let counted = |lane: usize| match good.get(lane) {
                            Some(true) => values.0[lane],
                            _ => f64::NAN,
                        };
                        match all_good {
                            true => band.add_all(row, &values.0, keep),
                            false => band.add_all(row, &std::array::from_fn(counted), keep),
                        }
                    }
                }
                part.count += own;
                part.moves.extend(moves);
            });
        }
    }

    /// Whether the dimensions of a piece make sense.
    fn is_sound(&self, piece: usize) -> bool {
        let parameters = self.bench.parameters(&self.values(piece));
        let finite = parameters.iter().all(|x| x.is_finite());
        finite && self.bench.model.unsound(&parameters).is_empty()
    }

    /// Moves pieces one after the other: for what lanes do not tell, and where they tell nothing of a piece for all.
    fn followed(
        &self,
        (numbers, curves): (&[usize], &[usize]),
        range: std::ops::Range<usize>,
        part: &mut Pieces,
    ) {
        let all = (0..self.bench.numbers.len()).collect::<Vec<_>>();
        let in_lanes = (0..self.curves.len()).filter(|k| !curves.contains(k));
        let in_lanes: Vec<usize> = in_lanes.collect();
        for (index, piece) in range.enumerate() {
            let keep = piece < KEPT_FOLLOWED || !numbers.is_empty();
            let mut curves = if keep { curves } else { &[] };
            let mut numbers = numbers;
            let own;
            if part.doubtful.binary_search(&index).is_ok() {
                own = [&in_lanes[..], curves].concat();
                (numbers, curves) = (&all, &own);
            }
            if numbers.is_empty() && curves.is_empty() && self.lanes.is_some() {
                continue;
            }
            if self.bench.watch().stops() {
                return;
            }
            let Ok((found, along)) = self.piece(&self.values(piece), numbers, curves) else {
                part.moves[index] = false;
                part.numbers
                    .iter_mut()
                    .for_each(|values| values[index] = f64::NAN);
                continue;
            };
            for (k, value) in numbers.iter().zip(found) {
                part.numbers[*k][index] = value;
            }
            for (row, values) in along.iter().enumerate() {
                for (k, value) in curves.iter().zip(values) {
                    part.bands[*k].add(row, *value, piece < KEPT);
                }
            }
        }
    }

    /// Numbers of a piece that is moved by itself, and its curves by row.
    pub fn piece(
        &self,
        values: &[f64],
        numbers: &[usize],
        curves: &[usize],
    ) -> Result<(Vec<f64>, Vec<Vec<f64>>), Refused> {
        let motion = self.bench.motion(values, &mut self.bench.watch())?;
        let numbers = numbers.iter().map(|k| &self.bench.numbers[*k]);
        let quantities: Vec<&Quantity> = numbers
            .chain(curves.iter().map(|k| &self.curves[*k]))
            .collect();
        let behind = quantities.len() - curves.len();
        let mut along = self
            .bench
            .along(&motion, &quantities, &mut self.bench.watch())?;
        let mut first = along.values(RowPlace::Drive(motion.start));
        let rows = if curves.is_empty() {
            Vec::new()
        } else {
            let rows = self.rows.iter();
            rows.map(|row| along.values(*row).split_off(behind))
                .collect()
        };
        first.truncate(behind);
        Ok((first, rows))
    }

    /// Why a piece does not move.
    pub fn why(&self, piece: usize) -> String {
        match self.bench.motion(&self.values(piece), &mut Silent) {
            Err(refused) => refused.why,
            Ok(_) => {
                "it does not close all along on the branch of the file's own design".to_owned()
            }
        }
    }
}

impl Pieces {
    /// Pieces of which nothing is known yet.
    fn unknown(&mut self, count: usize) {
        self.count = count;
        self.moves = vec![true; count];
        self.numbers
            .iter_mut()
            .for_each(|values| *values = vec![f64::NAN; count]);
    }
}

/// Path parameters of rows.
pub(super) fn path_places(motion: &Motion, rows: &[RowPlace]) -> Vec<f64> {
    let (model, parameters) = (&motion.mechanism().model, &motion.design.parameters);
    let place = |row: &RowPlace| match row {
        RowPlace::Drive(p) => *p,
        RowPlace::Time(t) => motion.path.parameter_at(model, *t, parameters),
    };
    rows.iter().map(place).collect()
}
