//! Many designs at once.

use std::borrow::Borrow;
use std::collections::BTreeMap;
use std::sync::Arc;

use kempe_batch::{Batch, Designs as Parameters, Executor, Layout, Task};
use kempe_measure::{DesignsInLanes, is_of_poses};
use kempe_model::{Diagnostic, Leaf, Measure, Model, PointId, PoseMeasure};
use kempe_motion::Motion;
use kempe_motion::drive_path::DrivePath;
use kempe_number::Lanes;
use kempe_study::{Done, Progress, Quantity, Silent, Stage};
use kempe_units::Expr;

use crate::asked::Asked;
use crate::block::{Block, Heading};
use crate::closing::Closing;
use crate::executor::run;
use crate::sweep::{Valued, values};
use crate::way::{Way, extent, motion_over, reaches};
use crate::{Error, Session};

/// Poses that the lanes solve between two questions to the progress.
const POSES_TOGETHER: usize = 1 << 20;
/// Designs that are measured together, in the lanes of one number.
const LANES: usize = 8;
/// Groups of designs that are measured between two questions, for every thread.
const GROUPS_TOGETHER: usize = 64;
/// Designs that are followed one by one between two questions, for every thread.
const DESIGNS_TOGETHER: usize = 4;
/// Why a pose in lanes is missing.
const OPEN: &str = "does not close here on the branch of the session's own design";
const BEYOND: &str = "does not close on the way here from where the session's own design starts";

/// Values of some parameters for many designs, SI. The other parameters are the session's; those that depend on these follow.
#[derive(Clone, Debug, PartialEq)]
pub struct Designs {
    names: Vec<String>,
    /// By parameter.
    columns: Vec<Vec<f64>>,
    count: usize,
}

impl Designs {
    /// Designs by parameter: a column of values for each.
    ///
    /// # Errors
    ///
    /// `wrong-length` where the columns differ in length.
    ///
    /// # Example
    ///
    /// ```
    /// use kempe::Designs;
    /// let three = Designs::from_columns([("a", vec![0.02, 0.03, 0.04])]).unwrap();
    /// assert_eq!(three.count(), 3);
    /// assert_eq!(Designs::from_columns([("a", vec![0.1]), ("b", vec![])]).unwrap_err().code(), "wrong-length");
    /// ```
    pub fn from_columns<N: Into<String>>(
        columns: impl IntoIterator<Item = (N, Vec<f64>)>,
    ) -> Result<Self, Error> {
        let (names, columns): (Vec<String>, Vec<Vec<f64>>) =
            columns.into_iter().map(|(n, c)| (n.into(), c)).unzip();
        let count = columns.first().map_or(0, Vec::len);
        let odd = names.iter().zip(&columns).find(|(_, c)| c.len() != count);
        if let Some((name, column)) = odd {
            return Err(wrong_length(
                &format!("column `{name}`"),
                count,
                column.len(),
            ));
        }
        Ok(Self {
            names,
            columns,
            count,
        })
    }

    /// Designs one by one: a row of values of the named parameters for each.
    ///
    /// # Errors
    ///
    /// `wrong-length` where a row does not have one value for each parameter.
    ///
    /// # Example
    ///
    /// ```
    /// use kempe::Designs;
    /// let two = Designs::from_rows(&["a", "b"], [[0.02, 0.05], [0.03, 0.06]]).unwrap();
    /// assert_eq!(two, Designs::from_columns([("a", vec![0.02, 0.03]), ("b", vec![0.05, 0.06])]).unwrap());
    /// ```
    pub fn from_rows<R: AsRef<[f64]>>(
        names: &[&str],
        rows: impl IntoIterator<Item = R>,
    ) -> Result<Self, Error> {
        let mut columns = vec![Vec::new(); names.len()];
        let mut count = 0;
        for row in rows {
            let row = row.as_ref();
            if row.len() != names.len() {
                return Err(wrong_length(
                    &format!("design {count}"),
                    names.len(),
                    row.len(),
                ));
            }
            for (column, value) in columns.iter_mut().zip(row) {
                column.push(*value);
            }
            count += 1;
        }
        Ok(Self {
            names: names.iter().map(|n| (*n).to_owned()).collect(),
            columns,
            count,
        })
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.count
    }
}

fn wrong_length(what: &str, expected: usize, found: usize) -> Error {
    let message = format!("{what} has {found} values, and {expected} were expected");
    Error {
        name: String::new(),
        text: String::new(),
        diagnostics: vec![
            Diagnostic::error("wrong-length", message).help("give one value for each design"),
        ],
    }
}

/// Measures of many designs at the same places.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Many {
    /// How many designs.
    pub designs: usize,
    /// The places, SI.
    pub places: Vec<f64>,
    /// One column for each measure: the values of all designs at the first place, then at the second, and so on.
    pub columns: Vec<Block>,
    /// By measure: whether it was taken in lanes, on the branch of the session's own design. Otherwise every design was
    /// followed from its own start.
    pub in_lanes: Vec<bool>,
    /// By measure: how many values are missing (NaN).
    pub missing: Vec<usize>,
    /// Why a design has no value at all.
    refused: BTreeMap<usize, Arc<str>>,
    /// How far the designs close that were taken in lanes.
    closing: Closing,
    /// Why a design that was followed has no value at a place.
    unreached: BTreeMap<(usize, usize), Arc<str>>,
}

impl Many {
    /// A value, by the places of measure, place and design in what was asked; NaN where it is missing.
    pub fn get(&self, measure: usize, place: usize, design: usize) -> f64 {
        let column = self.columns.get(measure).filter(|_| design < self.designs);
        let value = column.and_then(|c| c.values.get(place * self.designs + design));
        value.copied().unwrap_or(f64::NAN)
    }

    /// Why a value is missing; `None` where it is not.
    pub fn reason(&self, measure: usize, place: usize, design: usize) -> Option<&str> {
        if design >= self.designs || place >= self.places.len() || measure >= self.columns.len() {
            return None;
        }
        if !self.get(measure, place, design).is_nan() {
            return None;
        }
        let followed = || self.unreached.get(&(design, place));
        match (self.refused.get(&design), self.in_lanes.get(measure)) {
            (Some(reason), _) => Some(reason),
            (None, Some(true)) if self.closing.is_beyond(self.places[place], design) => {
                Some(BEYOND)
            }
            (None, Some(true)) => Some(OPEN),
            _ => Some(followed().map_or("no value here", |reason| reason)),
        }
    }
}

impl Session {
    /// Measures of many designs at places (SI) of the drive that moves alone, or at times (s) where several do.
    ///
    /// Measures of poses (`x(P)`, `angle(rocker)`, `d(y(P), motor)`) are taken many at a time, in vector lanes and on threads,
    /// coordinates of points fastest, **on the branch that the session's own design has** at each place: right as long as no
    /// change point comes between a design and the session's. What a design does not close on the way to, looked at every 64th
    /// part of that from where the session's own starts, it does not reach. Every other measure (of time, of forces, over the
    /// motion, with turns to be counted) takes a motion for each design, followed from its own start: slower by far, and sure of
    /// its branch. So does every measure where the session's own design does not come to all places, or where other drives than
    /// the one that is moved alone do not go in all designs as in its own. `in_lanes` says which was which.
    ///
    /// # Errors
    ///
    /// `unknown-name`, `settled-parameter`, `duplicate-name` of a parameter with two columns, what is wrong with a measure, and
    /// why the session's own motion cannot start. A design that makes no sense or does not close is no error: its values are NaN,
    /// with the reason.
    ///
    /// # Example
    ///
    /// ```
    /// # fn main() -> Result<(), kempe::Error> {
    /// use kempe::{Designs, Model};
    /// let rocker: Model = r#"
    ///     [parameters]
    ///     a = "20 mm"
    ///     [links]
    ///     frame   = { A = [0, 0], D = ["60 mm", 0] }
    ///     crank   = { A-B = "a" }
    ///     coupler = { B-C = "50 mm" }
    ///     rocker  = { D-C = "40 mm" }
    ///     [drives]
    ///     motor = { turns = "crank", from = 0, to = 360, speed = "1 rad/s" }
    ///     [assembly]
    ///     C = "left of B -> D"
    /// "#.parse()?;
    /// let mut s = rocker.compile()?.session();
    /// let designs = Designs::from_columns([("a", vec![0.020, 0.025, 0.200])])?;
    /// let v = s.many(&designs, [0.0, 1.0], &["x(C)", "angle(rocker)", "angular_speed(rocker)"])?;
    /// assert_eq!((v.in_lanes.as_slice(), v.missing[0]), ([true, true, false].as_slice(), 2));
    /// // Both ways agree: C lies on the rocker.
    /// let x = 0.06 + 0.04 * v.get(1, 1, 1).cos();
    /// assert!((v.get(0, 1, 1) - x).abs() < 1e-15);
    /// assert!(v.get(0, 1, 2).is_nan() && v.reason(0, 1, 2).unwrap().starts_with("does not close"));
    /// assert!(v.reason(2, 1, 2).unwrap().contains("cannot be assembled"));
    /// # Ok(())
    /// # }
    /// ```
    pub fn many<M: AsRef<str>>(
        &mut self,
        designs: &Designs,
        places: impl IntoIterator<Item = impl Borrow<f64>>,
        measures: impl IntoIterator<Item = M>,
    ) -> Result<Many, Error> {
        self.many_with(designs, places, measures, &mut Silent)
    }

    /// As [`many`](Self::many); `progress` hears how many values are done and may stop it: what is then missing says so.
    ///
    /// # Errors
    ///
    /// As there.
    pub fn many_with<M: AsRef<str>>(
        &mut self,
        designs: &Designs,
        places: impl IntoIterator<Item = impl Borrow<f64>>,
        measures: impl IntoIterator<Item = M>,
        progress: &mut dyn Progress,
    ) -> Result<Many, Error> {
        let places: Vec<f64> = places.into_iter().map(|p| *p.borrow()).collect();
        let range = extent(&self.compiled, &places)?;
        let asked = self.quantities(measures)?;
        let given = self.given_of(designs)?;
        let (values, refused) = self.values_of(&given);
        let motion = self.known_motion(progress)?;
        let way = match motion.path {
            DrivePath::Coordinate { drive, .. } => Way::Drive(drive),
            DrivePath::Time { .. } => Way::Time,
        };
        let model = &self.design.mechanism.model;
        let mut routes: Vec<Route> = (asked.quantities.iter())
            .map(|q| match point_of(model, &q.measure) {
                Some((point, axis)) => Route::Point(point, axis),
                None if is_of_poses(&motion, &q.measure) => Route::Lanes,
                None => Route::Motion,
            })
            .collect();
        // What is asked in lanes goes along this motion, if all do.
        let mut along = None;
        if routes.iter().any(|route| !matches!(route, Route::Motion)) {
            let motion = self.motion_over(way, range, progress)?;
            let may = !motion.mechanism().has_open_curves() && !self.laws_vary(way, &values);
            match may && reaches(&motion, range) {
                true => along = Some(motion),
                false => routes.fill_with(|| Route::Motion),
            }
        }
        let of = |route: fn(&Route) -> bool| -> Vec<usize> {
            (0..routes.len()).filter(|k| route(&routes[*k])).collect()
        };
        let points = of(|route| matches!(route, Route::Point(..)));
        let measured = of(|route| matches!(route, Route::Lanes));
        let followed = of(|route| matches!(route, Route::Motion));
        let units = self.compiled.units();
        let room = places.len() * designs.count;
        let column = |q: &Quantity| Block {
            values: vec![f64::NAN; room],
            ..Block::new(Heading::of(q, units), 0)
        };
        let mut it = Many {
            designs: designs.count,
            columns: asked.quantities.iter().map(column).collect(),
            in_lanes: routes.iter().map(|r| !matches!(r, Route::Motion)).collect(),
            missing: vec![0; routes.len()],
            refused,
            closing: Closing::default(),
            unreached: BTreeMap::new(),
            places,
        };
        let ways = [&points, &measured, &followed];
        let total = room * ways.iter().filter(|list| !list.is_empty()).count();
        let mut tally = Tally {
            progress,
            done: 0,
            total,
        };
        let mut go_on = true;
        if let Some(motion) = along {
            // A place is the path parameter: of the drive that moves, or time.
            let at = it.places.clone();
            it.closing = Closing::new(&motion, (&values, it.designs), &at, self.threads);
            if !points.is_empty() {
                go_on = self.points_in_lanes(&motion, &values, (&routes, &at), &mut it, &mut tally);
            }
            if !measured.is_empty() && go_on {
                let wanted = (&asked, measured.as_slice());
                go_on =
                    self.measured_in_lanes(&motion, &values, (wanted, &at), &mut it, &mut tally);
            }
            it.leave_out_beyond();
        }
        if !followed.is_empty() && go_on {
            go_on = self.one_by_one(&given, way, range, (&asked, &followed), &mut it, &mut tally);
        }
        if !go_on {
            it.stopped();
        }
        for (missing, column) in it.missing.iter_mut().zip(&it.columns) {
            *missing = column.values.iter().filter(|v| v.is_nan()).count();
        }
        Ok(it)
    }

    /// Whether drives of some of the designs, but for one that is moved alone, do not go as those of the session's own do.
    fn laws_vary(&self, way: Way, values: &[f64]) -> bool {
        let own = &self.design.parameters;
        if own.is_empty() {
            return false;
        }
        let drives = self.compiled.data().drives.iter().enumerate();
        let mut laws = drives.filter(|(index, _)| way != Way::Drive(*index));
        laws.any(|(_, drive)| {
            let placed = drive.law.placed(own);
            let mut designs = values.chunks_exact(own.len());
            designs.any(|values| !drive.law.is_placed(&placed, values))
        })
    }

    /// What is given of every design, in the model's order.
    fn given_of(&self, designs: &Designs) -> Result<Vec<Vec<Option<f64>>>, Error> {
        let mut given = vec![self.given.clone(); designs.count];
        let ids = self.to_set(&designs.names)?;
        for (id, column) in ids.into_iter().zip(&designs.columns) {
            for (own, value) in given.iter_mut().zip(column) {
                own[id.index()] = Some(*value);
            }
        }
        Ok(given)
    }

    /// Parameter values of every design, one design after the other, and why designs make no sense.
    fn values_of(&self, given: &[Vec<Option<f64>>]) -> (Vec<f64>, BTreeMap<usize, Arc<str>>) {
        let model = self.compiled.data();
        let mut refused = BTreeMap::new();
        let mut all = Vec::with_capacity(given.len() * model.parameters.len());
        for (design, given) in given.iter().enumerate() {
            let own: Vec<f64> = model.parameter_values_with(&mut |id| given[id.index()]);
            let odd = model
                .parameters
                .iter()
                .zip(&own)
                .find(|(_, v)| !v.is_finite());
            let reason = match odd {
                Some((p, value)) => Some(format!("parameter `{}` is {value}", p.name)),
                None => model.unsound(&own).into_iter().next().map(|d| d.message),
            };
            if let Some(reason) = reason {
                refused.insert(design, reason.into());
            }
            all.extend(own);
        }
        (all, refused)
    }

    /// Fills the columns of points. False when stopped.
    fn points_in_lanes(
        &self,
        motion: &Arc<Motion>,
        values: &[f64],
        (routes, at): (&[Route], &[f64]),
        it: &mut Many,
        tally: &mut Tally<'_>,
    ) -> bool {
        let mut wanted: Vec<PointId> = (routes.iter())
            .filter_map(|route| match route {
                Route::Point(point, _) => Some(*point),
                _ => None,
            })
            .collect();
        wanted.sort_unstable();
        wanted.dedup();
        let Ok(batch) = Batch::new(motion, &wanted) else {
            return true;
        };
        let designs = Parameters {
            values,
            count: it.designs,
            layout: Layout::ByDesign,
        };
        let together = (POSES_TOGETHER / it.designs.max(1)).max(1);
        let mut out = Vec::new();
        for (first, places) in (0..).step_by(together).zip(at.chunks(together)) {
            let columns = batch.columns();
            out.clear();
            out.resize(places.len() * columns * it.designs, f64::NAN);
            let done = run(self.threads, |executor| {
                batch.designs_on(executor, designs, places, &mut out)
            });
            if done.is_err() {
                return true;
            }
            for (block, route) in it.columns.iter_mut().zip(routes) {
                let Route::Point(point, axis) = route else {
                    continue;
                };
                let column = 2 * wanted.binary_search(point).unwrap_or(0) + axis;
                for (k, place) in (first..first + places.len()).enumerate() {
                    let from = (k * columns + column) * it.designs;
                    let own = &out[from..from + it.designs];
                    let to = place * it.designs;
                    block.values[to..to + it.designs].copy_from_slice(own);
                    for design in it.refused.keys() {
                        block.values[to + design] = f64::NAN;
                    }
                }
            }
            if !tally.more(places.len() * it.designs) {
                return false;
            }
        }
        true
    }

    /// Fills the columns of other measures of poses. False when stopped.
    fn measured_in_lanes(
        &self,
        motion: &Arc<Motion>,
        values: &[f64],
        ((asked, columns), at): ((&Asked, &[usize]), &[f64]),
        it: &mut Many,
        tally: &mut Tally<'_>,
    ) -> bool {
        let parameters = motion.mechanism().model.parameters.len();
        let measures: Vec<&Measure> = columns
            .iter()
            .map(|k| &asked.quantities[*k].measure)
            .collect();
        let groups: Vec<usize> = (0..it.designs).step_by(LANES).collect();
        for some in groups.chunks(GROUPS_TOGETHER * self.threads) {
            // By group, place and measure.
            let mut found: Vec<Vec<Vec<Lanes<LANES>>>> = vec![Vec::new(); some.len()];
            let last = it.designs - 1;
            let tasks = (found.iter_mut().zip(some))
                .map(|(slot, first)| -> Task<'_> {
                    let measures = measures.clone();
                    Box::new(move || {
                        let own: Vec<Lanes<LANES>> = (0..parameters)
                            .map(|p| {
                                Lanes::from_fn(|k| values[(first + k).min(last) * parameters + p])
                            })
                            .collect();
                        let mut lanes = DesignsInLanes::new(motion, measures, &own);
                        *slot = at.iter().map(|p| lanes.at(*p)).collect();
                    })
                })
                .collect();
            run(self.threads, |executor| executor.run(tasks));
            for (places, first) in found.iter().zip(some) {
                let designs = *first..(first + LANES).min(it.designs);
                for (place, row) in places.iter().enumerate() {
                    for (column, value) in columns.iter().zip(row) {
                        let block = &mut it.columns[*column];
                        for design in designs.clone().filter(|d| !it.refused.contains_key(d)) {
                            block.values[place * it.designs + design] = value.lane(design - first);
                        }
                    }
                }
            }
            if !tally.more(some.len() * LANES * at.len()) {
                return false;
            }
        }
        true
    }

    /// Fills the other columns, each design on its own motion. False when stopped.
    fn one_by_one(
        &self,
        given: &[Vec<Option<f64>>],
        way: Way,
        range: (f64, f64),
        (asked, others): (&Asked, &[usize]),
        it: &mut Many,
        tally: &mut Tally<'_>,
    ) -> bool {
        let own = Asked {
            quantities: others
                .iter()
                .map(|k| asked.quantities[*k].clone())
                .collect(),
            forces: others.iter().map(|k| asked.forces[*k]).collect(),
            timed: others.iter().map(|k| asked.timed[*k]).collect(),
        };
        let together = DESIGNS_TOGETHER * self.threads;
        let places = it.places.clone();
        for first in (0..given.len()).step_by(together) {
            let last = (first + together).min(given.len());
            let mut found: Vec<Option<Result<Vec<Valued>, String>>> = Vec::new();
            found.resize_with(last - first, || None);
            let refused = &it.refused;
            let tasks = (found.iter_mut().zip(first..last))
                .filter(|(_, design)| !refused.contains_key(design))
                .map(|(slot, design)| -> Task<'_> {
                    let (own, places, given) = (&own, &places, &given[design]);
                    Box::new(move || *slot = Some(self.one(given, way, range, places, own)))
                })
                .collect();
            run(self.threads, |executor| executor.run(tasks));
            for (slot, design) in found.into_iter().zip(first..last) {
                match slot {
                    Some(Ok(rows)) => it.take(design, others, rows),
                    Some(Err(reason)) => {
                        let reason: Arc<str> = reason.into();
                        for place in 0..places.len() {
                            it.unreached.insert((design, place), reason.clone());
                        }
                    }
                    None => {}
                }
            }
            if !tally.more((last - first) * places.len()) {
                return false;
            }
        }
        true
    }

    /// One design, followed from its own start.
    fn one(
        &self,
        given: &[Option<f64>],
        way: Way,
        range: (f64, f64),
        places: &[f64],
        asked: &Asked,
    ) -> Result<Vec<Valued>, String> {
        let design = self.compiled.design(given);
        let motion =
            motion_over(&design, way, range, &mut Silent).map_err(|tally| tally.message)?;
        values(&self.compiled, &motion, way, places, asked).map_err(|error| {
            let first = error.diagnostics.into_iter().next();
            first.map_or_else(String::new, |tally| tally.message)
        })
    }
}

impl Many {
    /// Enters what was found of a design.
    fn take(&mut self, design: usize, columns: &[usize], rows: Vec<Valued>) {
        for (place, row) in rows.into_iter().enumerate() {
            for (column, value) in columns.iter().zip(row.values) {
                self.columns[*column].values[place * self.designs + design] = value;
            }
            if let Some(reason) = row.reason {
                self.unreached.insert((design, place), reason.into());
            }
        }
    }

    /// Leaves out what was taken in lanes of designs that do not come to where it was taken.
    fn leave_out_beyond(&mut self) {
        for design in self.closing.limited() {
            for (row, place) in self.places.iter().enumerate() {
                if !self.closing.is_beyond(*place, design) {
                    continue;
                }
                let columns = self.columns.iter_mut().zip(&self.in_lanes);
                for (column, _) in columns.filter(|(_, in_lanes)| **in_lanes) {
                    column.values[row * self.designs + design] = f64::NAN;
                }
            }
        }
    }

    /// Says of what is missing that it was not come to.
    fn stopped(&mut self) {
        let reason: Arc<str> = "stopped before this design was done".into();
        for design in 0..self.designs {
            let lacks = |column: &Block| {
                (0..self.places.len()).any(|p| column.values[p * self.designs + design].is_nan())
            };
            let known = (0..self.places.len()).any(|p| self.unreached.contains_key(&(design, p)));
            if self.columns.iter().any(lacks) && !known {
                self.refused.entry(design).or_insert_with(|| reason.clone());
            }
        }
    }
}

/// What the progress has heard.
struct Tally<'p> {
    progress: &'p mut dyn Progress,
    done: usize,
    total: usize,
}

impl Tally<'_> {
    /// Tells that more is done; false when it is to stop.
    fn more(&mut self, values: usize) -> bool {
        self.done += values;
        let done = Done::Of(self.done, self.total);
        self.progress.reached(Stage::Rows, done).is_continue() || self.done == self.total
    }
}

/// How the values of a measure are found.
enum Route {
    /// A coordinate of a point, in lanes.
    Point(PointId, usize),
    /// Another measure of poses, in lanes.
    Lanes,
    /// On a motion of each design's own.
    Motion,
}

/// The point and the axis, where a measure is a coordinate of a point.
fn point_of(model: &Model, measure: &Measure) -> Option<(PointId, usize)> {
    match measure {
        Expr::Leaf(Leaf::Pose(PoseMeasure::X(point))) => Some((*point, 0)),
        Expr::Leaf(Leaf::Pose(PoseMeasure::Y(point))) => Some((*point, 1)),
        Expr::Leaf(Leaf::Named(index)) => point_of(model, &model.measures.get(*index)?.measure),
        _ => None,
    }
}
