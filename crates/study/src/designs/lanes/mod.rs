//! Numbers of many designs at once, on the branch of the file's own design: `program.rs` says which numbers lanes can tell, `extreme.rs` finds extremes
//! between places. What cannot be told of a design this way is said of it (`Found::doubtful`), so that it can be moved by itself.

mod extreme;
mod program;

use std::sync::Arc;

use kempe_batch::{Batch, Designs, Layout};
use kempe_measure::DesignsInLanes;
use kempe_measure::side_by_side::{Many, TOGETHER, ends, rises, rivals};
use kempe_model::{Measure, ParameterId, value};
use kempe_motion::Motion;
use kempe_motion::drive_path::{DrivePath, law_knots};
use kempe_number::{InstructionSet, Lanes, Number, math};
use kempe_units::Expr;

use self::extreme::{THROUGH, is_smooth, largest};
use self::program::{Of, Program, Seen};
use crate::designs::bench::Bench;
use crate::quantity::Quantity;

/// Pieces whose poses are found together.
pub(super) const PIECES: usize = 2 * TOGETHER;
/// Places at which they are, before any is looked at: all of it stays in the processor's cache.
const PLACES: usize = 48;
/// Between the ends of a motion there are at least so many steps: rows that are fewer are parted.
const LEAST_STEPS: usize = 180;
/// Parts of a motion over which a mean is integrated.
const PARTS: usize = 16;
/// Lanes of a number whose poses are series.
const SERIES: usize = 8;

/// Places and weights of Gauss and Legendre's quadrature over five places, from 0 to 1.
#[rustfmt::skip]
const QUADRATURE: [(f64, f64); 5] = [
    (0.046_910_077_030_668_004, 0.118_463_442_528_094_54), (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_6, 0.239_314_335_249_683_23), (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

/// What lanes can tell of pieces.
pub(super) struct InLanes {
    motion: Arc<Motion>,
    varied: Vec<ParameterId>,
    program: Program,
    reach: Reach,
    batch: Batch,
    /// Path parameters: the grid, rising; places of means; those asked for.
    places: Vec<f64>,
    /// How many of them are the grid.
    grid: usize,
    /// Weights of the places of means behind the grid.
    weights: Vec<f64>,
    /// By place: coordinates of the drives.
    drives: Vec<Vec<f64>>,
    /// By place: angles of the bodies that are asked for, with sine and cosine.
    near: Vec<Vec<[f64; 3]>>,
    /// By place: angles between lines.
    near_betweens: Vec<Vec<[f64; 3]>>,
    /// By number of the study, where lanes tell it; and by how much the file's own exceeds what they tell of it.
    pub numbers: Vec<Option<(Expr<Of>, f64)>>,
    /// By curve of the study, where lanes tell it.
    pub curves: Vec<Option<usize>>,
    /// By row of the study: its place.
    rows: Vec<usize>,
}

/// How far designs lie apart, and how nearly their numbers are wanted.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// Designs lie hardly farther out than so many times the ends that are told.
    pub far_out: f64,
    /// A design whose determinants' squares change by more than this part of themselves, one over it, from place to place is doubtful: 1 where it may lock
    /// between them, more where extremes between places are to be good to more digits than so swift a design has.
    pub swift: f64,
}

/// Storage for pieces.
pub(super) struct Scratch {
    columns: Vec<f64>,
    /// By parameter, pieces side by side.
    parameters: Vec<f64>,
    /// By track and place.
    tracks: Vec<Vec<Many>>,
    /// By determinant that is watched and place.
    determinants: Vec<Vec<Many>>,
    /// By what passes zero at corners of tracks, one track after the other, and place.
    corners: Vec<Vec<Many>>,
}

/// What was found of some pieces.
pub(super) struct Found {
    /// By number; not a number where lanes do not tell it or the piece does not close.
    pub numbers: Vec<Many>,
    /// Whether each piece closes at all places.
    pub closes: [bool; TOGETHER],
    /// Whether lanes cannot tell all of it: it may not close between two places, or has a corner there where it is looked at.
    pub doubtful: [bool; TOGETHER],
}

/// How curves of some pieces run.
pub(super) struct Along<'l> {
    of: &'l InLanes,
    tracks: &'l [Vec<Many>],
}

impl Along<'_> {
    /// A curve of the study at a row; none where lanes do not tell it.
    pub fn curve(&self, curve: usize, row: usize) -> Option<&Many> {
        let (track, place) = (self.of.curves[curve]?, self.of.rows.get(row)?);
        Some(&self.tracks[track][*place])
    }
}

impl InLanes {
    /// What lanes can tell of the numbers, and of the curves at rows (path parameters). `None` where they can tell nothing: the branch of another
    /// design may be another where anything is met, its drives may stand elsewhere where their laws vary, and its pins beyond the ends of curved slots.
    pub fn new(
        bench: &Bench<'_>,
        motion: &Arc<Motion>,
        curves: &[Quantity],
        rows: &[f64],
        (ends, reach): (&[[f64; 2]], Reach),
    ) -> Option<Self> {
        let (low, high) = motion.demanded;
        let DrivePath::Coordinate { .. } = motion.path else {
            return None;
        };
        let others = !motion.events.is_empty() || motion.mechanism().has_open_curves();
        if others || !(low < high) || laws_vary(bench, ends) {
            return None;
        }
        let mut program = Program::new(bench.model, &bench.varied);
        let numbers = bench.numbers.iter();
        let numbers: Vec<Option<(Expr<Of>, f64)>> = numbers
            .map(|q| Some((program.number(motion, &q.measure)?, 0.0)))
            .collect();
        let curves: Vec<Option<usize>> = curves
            .iter()
            .map(|q| program.track(motion, &q.measure))
            .collect();
        if program.tracks.is_empty() {
            return None;
        }
        // Whether a piece closes is seen at a point.
        if program.points.is_empty() && program.bodies.is_empty() {
            let points = motion.mechanism().model.points.len() as u32;
            let mut points = (0..points).map(kempe_model::PointId);
            let moving = points.find(|p| {
                let marker = motion.mechanism().any_marker(*p);
                marker.is_some_and(|m| m.body != kempe_mechanism::BodyId::GROUND)
            });
            program.points.push(moving?);
        }
        let batch = Batch::with_bodies(motion, &program.points, &program.bodies).ok()?;
        let (grid, rows) = grid((low, high), rows);
        let mut places = grid.clone();
        let mut weights = Vec::new();
        if program.tracks.iter().any(|track| track.mean) {
            let nodes = quadrature(motion)?;
            places.extend(nodes.iter().map(|(p, _)| p));
            weights.extend(nodes.iter().map(|(_, w)| w));
        }
        places.extend(&program.asked);
        let mut it = Self {
            motion: motion.clone(),
            varied: bench.varied.clone(),
            reach,
            batch,
            grid: grid.len(),
            weights,
            drives: Vec::new(),
            near: Vec::new(),
            near_betweens: Vec::new(),
            numbers,
            curves,
            rows,
            places,
            program,
        };
        it.look_at_own();
        if it.may_lock(bench, ends) {
            it.batch = it.batch.with_determinants();
        }
        Some(it)
    }

    /// Whether pieces may come so near to a place where assemblies meet that it lies between the places that are looked at.
    fn may_lock(&self, bench: &Bench<'_>, ends: &[[f64; 2]]) -> bool {
        let own = bench.own_values();
        let mut designs = vec![own.clone()];
        for end in 0..2 {
            let far = |k: usize| own[k] + self.reach.far_out * ends[k][end];
            designs.extend((0..ends.len()).map(|k| {
                let mut one = own.clone();
                one[k] = far(k);
                one
            }));
            designs.push((0..own.len()).map(far).collect());
        }
        let parameters: Vec<f64> = designs.iter().flat_map(|it| bench.parameters(it)).collect();
        let batch = self.batch.clone().with_determinants();
        let (count, columns, watched) = (designs.len(), batch.columns(), batch.determinants());
        let designs = Designs {
            values: &parameters,
            count,
            layout: Layout::ByDesign,
        };
        let grid = &self.places[..self.grid];
        let mut found = vec![f64::NAN; grid.len() * columns * count];
        if watched > 0 && batch.designs(designs, grid, &mut found).is_err() {
            return true;
        }
        (columns - watched..columns).any(|which| {
            (0..count).any(|design| {
                let at = |place: usize| found[(place * columns + which) * count + design];
                !stays_away(grid.len(), at, FAR_AWAY * self.reach.swift)
            })
        })
    }

    /// Whether means are asked for, of which nobody sees to how many digits they are told.
    pub fn has_means(&self) -> bool {
        self.program.tracks.iter().any(|track| track.mean)
    }

    /// Whether anything needs poses as series, which takes lanes no less time than designs one by one.
    pub fn needs_series(&self) -> bool {
        self.program.needs_series()
    }

    /// How many places of the motion are looked at.
    pub fn places(&self) -> usize {
        self.grid
    }

    /// Where the file's own design has drives and angles.
    fn look_at_own(&mut self) {
        let mut solver = self.motion.solver::<f64>();
        for p in &self.places {
            self.motion.branch_at(*p, &mut solver.branch);
            (self.motion.path).coordinates(*p, &mut solver.coordinates);
            self.drives.push(solver.coordinates.clone());
            let bodies = self.program.bodies.iter();
            let angles = bodies.map(|body| with_direction(solver.branch.near[body.index()]));
            self.near.push(angles.collect());
        }
        let betweens = self.program.betweens;
        self.near_betweens = vec![vec![with_direction(0.0); betweens]; self.places.len()];
        if betweens == 0 {
            return;
        }
        let own = &self.motion.design.parameters;
        let mut columns = vec![f64::NAN; self.places.len() * self.batch.columns()];
        let designs = Designs {
            values: own,
            count: 1,
            layout: Layout::ByDesign,
        };
        let _ = self.batch.designs(designs, &self.places, &mut columns);
        let mut found = vec![0.0; betweens];
        for (place, own) in columns.chunks(self.batch.columns()).enumerate() {
            let alike: Vec<f64> = own.iter().flat_map(|x| [*x; TOGETHER]).collect();
            let seen = Seen {
                columns: &alike,
                count: TOGETHER,
                first: 0,
                points: self.program.points.len(),
                drives: &[],
                near: &[],
                near_betweens: &[],
                parameters: &[],
                seats: &[],
            };
            for made_of in self.program.tracks.iter().flat_map(|t| &t.made_of) {
                seen.betweens(made_of, &mut found);
            }
            let known = found.iter().map(|x| if x.is_finite() { *x } else { 0.0 });
            self.near_betweens[place] = known.map(with_direction).collect();
        }
    }

    /// Storage for pieces.
    pub fn scratch(&self) -> Scratch {
        let parameters = self.motion.mechanism().model.parameters.len();
        let track = vec![Many::from_f64(f64::NAN); self.places.len()];
        Scratch {
            columns: vec![f64::NAN; PLACES * self.batch.columns() * PIECES],
            parameters: vec![0.0; parameters * PIECES],
            determinants: vec![track.clone(); self.batch.determinants() * (PIECES / TOGETHER)],
            corners: vec![track.clone(); self.program.corners().count() * (PIECES / TOGETHER)],
            tracks: vec![track; self.program.tracks.len() * (PIECES / TOGETHER)],
        }
    }

    /// Pieces by their values of the varied parameters, one group after the other; what lies behind `count` is the last one again. `each` hears
    /// what was found of a group, and how its curves run.
    pub fn pieces(
        &self,
        count: usize,
        drawn: impl Fn(usize, usize) -> f64,
        scratch: &mut Scratch,
        mut each: impl FnMut(usize, Found, Along<'_>),
    ) {
        let groups = count.min(PIECES).div_ceil(TOGETHER);
        let parameters: Vec<Vec<Many>> = (0..groups)
            .map(|group| {
                self.parameters(|lane, k| drawn((group * TOGETHER + lane).min(count - 1), k))
            })
            .collect();
        let pieces = groups * TOGETHER;
        for (k, column) in scratch.parameters.chunks_mut(PIECES).enumerate() {
            for (group, own) in parameters.iter().enumerate() {
                column[group * TOGETHER..][..TOGETHER].copy_from_slice(&own[k].0);
            }
        }
        // Columns lie side by side without a gap.
        if pieces < PIECES {
            for k in 1..parameters[0].len() {
                scratch
                    .parameters
                    .copy_within(k * PIECES..k * PIECES + pieces, k * pieces);
            }
        }
        let designs = Designs {
            values: &scratch.parameters[..pieces * parameters[0].len()],
            count: pieces,
            layout: Layout::ByParameter,
        };
        let seats: Vec<Vec<Many>> = match self.program.bodies.is_empty() {
            true => vec![Vec::new(); groups],
            false => (parameters.iter())
                .map(|own| self.motion.design_of(own).geometry.seat_angles)
                .collect(),
        };
        let (tracks, watched) = (self.program.tracks.len(), self.batch.determinants());
        let corners = self.program.corners().count();
        let mut closing = vec![Many::zero(); groups];
        for (first, at) in (0..).step_by(PLACES).zip(self.places.chunks(PLACES)) {
            let size = at.len() * self.batch.columns() * pieces;
            let columns = &mut scratch.columns[..size];
            if self.batch.designs(designs, at, columns).is_err() {
                columns.fill(f64::NAN);
            }
            let one = self.batch.columns() * pieces;
            for (place, own) in (first..).zip(columns.chunks(one)) {
                for group in 0..groups {
                    let seen = Seen {
                        columns: own,
                        count: pieces,
                        first: group * TOGETHER,
                        points: self.program.points.len(),
                        drives: &self.drives[place],
                        near: &self.near[place],
                        near_betweens: &self.near_betweens[place],
                        parameters: &parameters[group],
                        seats: &seats[group],
                    };
                    for (sum, x) in closing[group].0.iter_mut().zip(seen.closing()) {
                        *sum += x * 0.0;
                    }
                    for (k, track) in self.program.tracks.iter().enumerate() {
                        if let Some(made_of) = &track.made_of {
                            seen.put(made_of, &mut scratch.tracks[group * tracks + k][place]);
                        }
                    }
                    for (k, corner) in self.program.corners().enumerate() {
                        seen.put(corner, &mut scratch.corners[group * corners + k][place]);
                    }
                    for k in 0..watched {
                        let own = seen.behind(self.program.bodies.len(), k);
                        scratch.determinants[group * watched + k][place] = Lanes(*own);
                    }
                }
            }
        }
        if self.program.needs_series() {
            for (group, own) in parameters.iter().enumerate() {
                self.by_series(own, &mut scratch.tracks[group * tracks..][..tracks]);
            }
        }
        for (group, own) in parameters.iter().enumerate() {
            let tracks = &scratch.tracks[group * tracks..][..tracks];
            let of_corners = &scratch.corners[group * corners..][..corners];
            let (numbers, mut doubtful) = self.numbers_of(tracks, of_corners, own);
            for values in &scratch.determinants[group * watched..][..watched] {
                for (lane, doubtful) in doubtful.iter_mut().enumerate() {
                    let at = |place: usize| values[place].0[lane];
                    *doubtful |= !stays_away(self.grid, at, self.reach.swift);
                }
            }
            let found = Found {
                numbers,
                closes: closing[group].0.map(|x| x == 0.0),
                doubtful,
            };
            each(group * TOGETHER, found, Along { of: self, tracks });
        }
    }

    /// All parameters; formulas follow.
    fn parameters(&self, drawn: impl Fn(usize, usize) -> f64) -> Vec<Many> {
        let model = &self.motion.mechanism().model;
        let mut all: Vec<Many> = Vec::with_capacity(model.parameters.len());
        for (index, parameter) in model.parameters.iter().enumerate() {
            let own = self.varied.iter().position(|id| id.index() == index);
            all.push(match own {
                Some(k) => Many::from_fn(|lane| drawn(lane, k)),
                None => value(&parameter.value, &all),
            });
        }
        all
    }

    /// Measures that need poses as series.
    fn by_series(&self, parameters: &[Many], tracks: &mut [Vec<Many>]) {
        let all = self.program.tracks.iter().enumerate();
        let slow = all.filter(|(_, track)| track.made_of.is_none());
        let (which, measures): (Vec<usize>, Vec<&Measure>) =
            slow.map(|(k, track)| (k, &track.measure)).unzip();
        for first in (0..TOGETHER).step_by(SERIES) {
            let own: Vec<Lanes<SERIES>> = (parameters.iter())
                .map(|p| Lanes::from_fn(|k| p.lane(first + k)))
                .collect();
            let mut lanes = DesignsInLanes::new(&self.motion, measures.clone(), &own);
            for (place, p) in self.places.iter().enumerate() {
                for (track, value) in which.iter().zip(lanes.at(*p)) {
                    tracks[*track][place].0[first..first + SERIES].copy_from_slice(&value.0);
                }
            }
        }
    }

    /// The numbers of pieces, and which of them have a corner where they are looked at.
    fn numbers_of(
        &self,
        tracks: &[Vec<Many>],
        mut corners: &[Vec<Many>],
        parameters: &[Many],
    ) -> (Vec<Many>, [bool; TOGETHER]) {
        let mut doubtful = [false; TOGETHER];
        let followed = self.program.tracks.iter().zip(tracks);
        let known: Vec<[Many; 3]> = followed
            .map(|(track, values)| {
                let nothing = Many::from_f64(f64::NAN);
                let own;
                (own, corners) = corners.split_at(track.corners().len());
                let [low, high] = match track.extremes {
                    [false, false] => [nothing; 2],
                    wanted => {
                        let corners = (&track.turns_at[..], own);
                        self.extremes(&values[..self.grid], corners, wanted, &mut doubtful)
                    }
                };
                let nodes = values[self.grid..].iter().zip(&self.weights);
                let mean = nodes.fold(Many::zero(), |sum, (value, weight)| sum + *value * *weight);
                [low, high, mean]
            })
            .collect();
        let asked = self.grid + self.weights.len();
        let tell = |number: &Option<(Expr<Of>, f64)>| match number {
            Some((number, more)) => {
                number.eval(&mut |of| match *of {
                    Of::Parameter(index) => parameters[index],
                    Of::Least(track) => known[track][0],
                    Of::Greatest(track) => known[track][1],
                    Of::Mean(track) => known[track][2],
                    Of::At(track, place) => tracks[track][asked + place],
                }) + *more
            }
            None => Many::from_f64(f64::NAN),
        };
        (self.numbers.iter().map(tell).collect(), doubtful)
    }

    /// The least and the greatest value over the grid, between its places too.
    fn extremes(
        &self,
        values: &[Many],
        (turns_at, corners): (&[f64], &[Vec<Many>]),
        wanted: [bool; 2],
        doubtful: &mut [bool; TOGETHER],
    ) -> [Many; 2] {
        let set = InstructionSet::detect();
        let ends = ends(set, values);
        let rivals = rivals(set, values, &ends);
        let mut beyond = |lane: usize, at: usize, sign: f64| {
            let from = at
                .saturating_sub(THROUGH / 2)
                .min(self.grid.saturating_sub(THROUGH));
            let n = THROUGH.min(self.grid);
            let mut own = [0.0; THROUGH];
            for (own, value) in own.iter_mut().zip(&values[from..from + n]) {
                *own = sign * value.0[lane];
            }
            let places = &self.places[from..from + n];
            let range = ends.high.0[lane] - ends.low.0[lane];
            let passes =
                |corner: &Vec<Many>| !stays_away(n, |place| corner[from + place].0[lane], 1.0);
            let turns = |at: &f64| !stays_away(n, |place| sign * own[place] - at, 1.0);
            doubtful[lane] |= !is_smooth(places, &own[..n], range)
                || corners.iter().any(passes)
                || turns_at.iter().any(turns);
            largest(places, &own[..n], at - from)
        };
        let mut between = |lane: usize, at: usize, side: usize, sign: f64| {
            // What is infinite or no number somewhere has no extreme here.
            if ends.finite.0[lane] != 0.0 {
                return f64::NAN;
            }
            let mut top = beyond(lane, at, sign);
            // Of a closed turn both ends are the same pose: the peak may lie beside the other one.
            let last = self.grid - 1;
            for (place, inwards) in [(0, [1, 2]), (last, [last - 1, last - 2])] {
                let [x, y, z] = [place, inwards[0], inwards[1]].map(|k| sign * values[k].0[lane]);
                let bends = (x - 2.0 * y + z).abs();
                if x >= y && x + bends > sign * values[at].0[lane] && place.abs_diff(at) > 1 {
                    top = top.max(beyond(lane, place, sign));
                }
            }
            if rivals[side][lane] {
                // Of several peaks as high the highest place need not stand below the highest peak.
                let known = sign * values[at].0[lane];
                for place in 1..self.grid - 1 {
                    let [x, y, z] = [place - 1, place, place + 1].map(|k| sign * values[k].0[lane]);
                    if y >= x && y >= z && y + rises(x, y, z) > known && place.abs_diff(at) > 1 {
                        top = top.max(beyond(lane, place, sign));
                    }
                }
            }
            sign * top
        };
        let mut end = |wanted: bool, at: &[usize; TOGETHER], side: usize, sign: f64| match wanted {
            true => Many::from_fn(|k| between(k, at[k], side, sign)),
            false => Many::from_f64(f64::NAN),
        };
        [
            end(wanted[0], &ends.low_at, 0, -1.0),
            end(wanted[1], &ends.high_at, 1, 1.0),
        ]
    }
}

/// Whether something that changes its sign or ends where assemblies meet stays away from there between all places: from one to the next
/// its square changes by less than so many parts of itself.
fn stays_away(places: usize, at: impl Fn(usize) -> f64, times: f64) -> bool {
    let square = |place: usize| at(place) * at(place);
    let mut before = square(0);
    (1..places).all(|place| {
        let now = square(place);
        let change = times * (now - before).abs();
        let away = change <= before && change <= now;
        before = now;
        away
    })
}

fn with_direction(angle: f64) -> [f64; 3] {
    let (s, c) = math::sin_cos(angle);
    [angle, s, c]
}

/// Whether the laws of the drives ask for anything that varies: then the pieces' drives stand elsewhere.
fn laws_vary(bench: &Bench<'_>, ends: &[[f64; 2]]) -> bool {
    let own = bench.own_values();
    let told = |values: &[f64]| -> Vec<u64> {
        let parameters = bench.parameters(values);
        let laws = bench.model.drives.iter().map(|drive| &drive.law);
        let numbers = laws.flat_map(|law| {
            let duration = law.duration(&parameters);
            let times = (0..=LAW_PLACES).map(|k| duration * k as f64 / LAW_PLACES as f64);
            let along: Vec<f64> = times.map(|t| law.at(t, &parameters)).collect();
            let (low, high) = law.extent(&parameters);
            let breaks = law.breaks(&parameters);
            along.into_iter().chain(breaks).chain([low, high, duration])
        });
        numbers.map(f64::to_bits).collect()
    };
    let meant = told(&own);
    ends.iter().enumerate().any(|(k, ends)| {
        ends.iter().any(|end| {
            let mut values = own.clone();
            values[k] += end;
            told(&values) != meant
        })
    })
}

/// What changes by no more than this part of itself from place to place comes near to nothing in no piece that lies between others.
const FAR_AWAY: f64 = 4.0;
/// Places at which laws are compared.
const LAW_PLACES: usize = 24;

/// Rising places over a range, rows among them, in steps that are small enough; and the place of each row.
fn grid((low, high): (f64, f64), rows: &[f64]) -> (Vec<f64>, Vec<usize>) {
    let within = |p: &f64| p.clamp(low, high);
    let mut ends: Vec<f64> = rows.iter().map(within).chain([low, high]).collect();
    ends.sort_by(f64::total_cmp);
    let near = (high - low) * 1e-9;
    ends.dedup_by(|b, a| (*b - *a).abs() <= near);
    let parts = LEAST_STEPS.div_ceil((ends.len() - 1).max(1));
    let mut all = Vec::with_capacity(ends.len() * parts);
    for pair in ends.windows(2) {
        let step = (pair[1] - pair[0]) / parts as f64;
        all.extend((0..parts).map(|k| pair[0] + step * k as f64));
    }
    all.extend(ends.last());
    let place = |row: &f64| {
        let behind = all.partition_point(|p| *p < *row);
        let around = [behind.saturating_sub(1), behind.min(all.len() - 1)];
        let nearer = |a: &usize, b: &usize| (all[*a] - row).abs() <= (all[*b] - row).abs();
        match nearer(&around[0], &around[1]) {
            true => around[0],
            false => around[1],
        }
    };
    let rows = rows.iter().map(place).collect();
    (all, rows)
}

/// Places over the time of a motion with their weights in a mean.
fn quadrature(motion: &Motion) -> Option<Vec<(f64, f64)>> {
    let (model, parameters) = (&motion.mechanism().model, &motion.design.parameters);
    let knots = law_knots(model, parameters, false);
    let end = knots.last()?[1];
    let mut nodes = Vec::new();
    for pair in knots.windows(2) {
        let (from, to) = (pair[0][1], pair[1][0]);
        let parts = ((to - from) / end * PARTS as f64).ceil().max(1.0) as usize;
        let part = (to - from) / parts as f64;
        for k in 0..parts {
            for (place, weight) in QUADRATURE {
                let time = from + part * (k as f64 + place);
                let p = motion.path.parameter_at(model, time, parameters);
                nodes.push((p, weight * part / end));
            }
        }
    }
    (!nodes.is_empty()).then_some(nodes)
}
