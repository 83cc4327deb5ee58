//! What measures are, and how they change with the unknown parameters, where these have given values.

use std::sync::Arc;

use kempe_dynamics::sensitivities_at as with_forces;
use kempe_measure::{Held, Sensitivities, sensitivities_at};
use kempe_mechanism::{Design, Mechanism};
use kempe_model::{AdjustStudy, Law, LawPiece, Leaf, Measure, Model, ParameterId, value};
use kempe_motion::assemble::{Assemblies, Assembly, find_assemblies};
use kempe_motion::drive_path::DrivePath;
use kempe_motion::progress::Silent;
use kempe_motion::{Motion, MotionError};
use kempe_number::math;
use kempe_units::{Dimension, Expr};

use super::data::Data;
use crate::prepared::design;

/// Which way to put the mechanism together.
#[derive(Clone, Debug)]
pub(super) enum Assembled {
    /// The one that the file means.
    AsMeant,
    /// Another, known by one like it where the motion begins.
    Like(Begin, Box<Assembly>),
}

/// Where the motion through all rows begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Begin {
    /// Where the file's own motion does.
    Start,
    /// In the first row: from the file's start it may not be reached.
    FirstRow,
}

impl Assembled {
    pub fn is_meant(&self) -> bool {
        matches!(self, Self::AsMeant)
    }
}

/// A mechanism that is asked for what was measured on it.
pub(super) struct Bench<'m> {
    pub model: &'m Model,
    pub study: &'m AdjustStudy,
    pub data: Data,
    measures: Vec<&'m Measure>,
    forces: bool,
    /// The mechanism, moving as its file says.
    own: Arc<Mechanism>,
    /// The mechanism, moving from its start through all rows, and from the first row.
    through: Arc<Mechanism>,
    from_first: Arc<Mechanism>,
    /// Whether the first row stands elsewhere than the file's start.
    first_is_elsewhere: bool,
}

/// The mechanism with given values of its parameters, moved.
pub(super) struct Moved {
    through: Option<Arc<Motion>>,
    own: Option<Arc<Motion>>,
}

/// What measures are there: one entry for each value that was measured, in the order of the data.
pub(super) struct Measured {
    /// SI.
    pub values: Vec<f64>,
    /// Their derivatives to the unknown parameters, SI.
    pub slopes: Vec<Vec<f64>>,
}

impl<'m> Bench<'m> {
    pub fn new(model: &'m Model, study: &'m AdjustStudy) -> Self {
        let own = design(model);
        let data = Data::new(model, study);
        let start = starts(&own);
        let first = data.rows.iter().find_map(|row| row.at.clone());
        let first_is_elsewhere = first.as_ref().is_some_and(|first| *first != start);
        let through = |start: &[f64]| {
            let laws = laws_through(start, &data);
            own.with_laws(|drive| Some(laws[drive].clone()))
        };
        let (through, from_first) = (through(&start), through(&first.unwrap_or(start)));
        let of_force = |measure: &Measure| {
            measure.leaves().any(|leaf| match leaf {
                Leaf::Named(i) => model.measures.get(*i).is_some_and(|m| m.needs_forces),
                _ => false,
            })
        };
        Self {
            model,
            study,
            measures: study.measures.iter().map(|c| &c.measure).collect(),
            forces: study.measures.iter().any(|c| of_force(&c.measure)),
            data,
            own: own.mechanism.clone(),
            through: through.mechanism.clone(),
            from_first: from_first.mechanism.clone(),
            first_is_elsewhere,
        }
    }

    /// All parameters where the unknown ones have these values, SI: formulas follow.
    pub fn parameters(&self, unknown: &[f64]) -> Vec<f64> {
        let mut values: Vec<f64> = Vec::with_capacity(self.model.parameters.len());
        for (index, parameter) in self.model.parameters.iter().enumerate() {
            let own = self.study.unknown.iter().position(|id| id.index() == index);
            let known = own.and_then(|k| unknown.get(k)).copied();
            values.push(known.unwrap_or_else(|| value(&parameter.value, &values)));
        }
        values
    }

    /// The values of the unknown parameters in the file, SI.
    pub fn start(&self) -> Vec<f64> {
        let values = self.model.parameter_values::<f64>();
        let unknown = self.study.unknown.iter();
        unknown.map(|id| values[id.index()]).collect()
    }

    /// Sizes of the unknown parameters at these values of them, SI: of one that is nothing, that of the mechanism, or 1.
    pub fn sizes(&self, unknown: &[f64]) -> Vec<f64> {
        let pairs = self.study.unknown.iter().zip(unknown);
        let size = |(id, value): (&ParameterId, &f64)| {
            let dimension = self.model.parameters[id.index()].dimension;
            match dimension {
                Dimension::ANGLE => 1.0,
                _ if *value != 0.0 => value.abs(),
                Dimension::LENGTH => self.design(unknown).size(),
                _ => 1.0,
            }
        };
        pairs.map(size).collect()
    }

    /// The design with these values.
    pub fn design(&self, unknown: &[f64]) -> Design<f64> {
        Design::new(&self.through, &self.parameters(unknown))
    }

    /// All ways to put the mechanism together where a motion begins.
    pub fn assemblies(&self, unknown: &[f64], begin: Begin) -> Vec<Assembly> {
        let design = Design::new(self.beginning(begin), &self.parameters(unknown));
        let found = find_assemblies(&design, &starts(&design), &mut Silent);
        let found = found.unwrap_or_default();
        found.list.into_iter().chain(found.others).collect()
    }

    fn beginning(&self, begin: Begin) -> &Arc<Mechanism> {
        match begin {
            Begin::Start => &self.through,
            Begin::FirstRow => &self.from_first,
        }
    }

    /// Where motions can begin: what is told of the whole motion begins where the file says.
    pub fn begins(&self) -> &'static [Begin] {
        match self.first_is_elsewhere && self.data.rows.iter().all(|row| row.at.is_some()) {
            true => &[Begin::Start, Begin::FirstRow],
            false => &[Begin::Start],
        }
    }

    /// The mechanism moved through all rows, and where rows tell of the whole motion, as its file says.
    ///
    /// # Errors
    /// Why it does not move; without a reason where it stops before a row.
    pub fn moved(
        &self,
        unknown: &[f64],
        assembled: &Assembled,
    ) -> Result<Moved, Option<Box<MotionError>>> {
        let Assembled::Like(begin, _) = assembled else {
            let from = |begin| self.moved_from(begin, unknown, assembled);
            let begins = self.begins().iter();
            // From the file's start where the rows can be reached from there, else as its hints mean it in the first row.
            let found = begins.clone().find_map(|begin| from(*begin).ok());
            return found.map_or_else(|| from(Begin::Start), Ok);
        };
        self.moved_from(*begin, unknown, assembled)
    }

    fn moved_from(
        &self,
        begin: Begin,
        unknown: &[f64],
        assembled: &Assembled,
    ) -> Result<Moved, Option<Box<MotionError>>> {
        let parameters = self.parameters(unknown);
        let rows = &self.data.rows;
        let along = |wanted: bool, mechanism: &Arc<Mechanism>| match wanted {
            true => motion(&Design::new(mechanism, &parameters), assembled).map(Some),
            false => Ok(None),
        };
        let of_rows = rows.iter().any(|row| row.at.is_some());
        let through = along(of_rows, self.beginning(begin))?;
        let own = along(rows.iter().any(|row| row.at.is_none()), &self.own)?;
        let moved = Moved { through, own };
        match self.unreached(&moved) {
            None => Ok(moved),
            Some(_) => Err(None),
        }
    }

    /// A row that the motion does not reach.
    fn unreached(&self, moved: &Moved) -> Option<usize> {
        let motion = moved.through.as_ref()?;
        let places = self.places(motion);
        let reached = |held: &Held| match held {
            Held::Path(p) | Held::Time(p) | Held::Break(p) | Held::Extreme { time: p, .. } => {
                motion.reaches(*p)
            }
        };
        places
            .iter()
            .position(|(_, held)| !reached(held))
            .map(|k| places[k].0)
    }

    /// Rows with a place of their own, and where that is on the motion through all of them.
    fn places(&self, motion: &Motion) -> Vec<(usize, Held)> {
        let rows = self.data.rows.iter().enumerate();
        rows.filter_map(|(index, row)| {
            let at = row.at.as_ref()?;
            let held = match motion.path {
                DrivePath::Coordinate { drive, .. } => Held::Path(*at.get(drive)?),
                DrivePath::Time { .. } => Held::Time(row.time),
            };
            Some((index, held))
        })
        .collect()
    }

    /// What the measures are, with their derivatives to `parameters`; `None` where one of them has no finite value.
    pub fn measured(&self, moved: &Moved, parameters: &[ParameterId]) -> Option<Measured> {
        let all = self.asked(moved, &self.measures, parameters)?;
        let mut found = Measured {
            values: Vec::with_capacity(self.data.values.len()),
            slopes: Vec::with_capacity(self.data.values.len()),
        };
        for datum in &self.data.values {
            let of_row = all.get(datum.row)?.as_ref()?;
            let value = *of_row.values.get(datum.measure)?;
            let mut slopes = of_row.derivatives.get(datum.measure)?.clone();
            // At a corner one side leads on: a distance that is nothing may be what was measured.
            let own = of_row.one_sided.iter();
            for side in own.filter(|side| side.measure == datum.measure) {
                slopes[side.parameter] = side.slope;
            }
            if !(value.is_finite() && slopes.iter().all(|d| d.is_finite())) {
                return None;
            }
            found.values.push(value);
            found.slopes.push(slopes);
        }
        Some(found)
    }

    /// How what was measured changes with each drive that its row gives, SI: by values, in the order of the row's drives; not a number where
    /// that is not known.
    pub fn by_drives(&self, moved: &Moved) -> Vec<Vec<f64>> {
        let drives: Vec<_> = self.data.drives();
        let of = |measure: &&Measure| {
            let measure = (*measure).clone();
            drives.iter().map(move |drive| {
                Expr::Leaf(Leaf::Coefficient(Box::new(measure.clone()), *drive, 1))
            })
        };
        let asked: Vec<Measure> = self.measures.iter().flat_map(of).collect();
        let asked: Vec<&Measure> = asked.iter().collect();
        let all = self.asked(moved, &asked, &[]).unwrap_or_default();
        let values = self.data.values.iter().map(|datum| {
            let given = &self.data.rows[datum.row].given;
            let slope = |drive| {
                let k = drives.iter().position(|d| d == drive)?;
                let of_row = all.get(datum.row)?.as_ref()?;
                of_row.values.get(datum.measure * drives.len() + k).copied()
            };
            given.iter().map(|d| slope(d).unwrap_or(f64::NAN)).collect()
        });
        values.collect()
    }

    /// Measures at all rows.
    fn asked(
        &self,
        moved: &Moved,
        measures: &[&Measure],
        parameters: &[ParameterId],
    ) -> Option<Vec<Option<Sensitivities>>> {
        let at = |motion: &Arc<Motion>, held: &[Held]| match self.forces {
            true => with_forces(motion, held, measures, parameters).ok(),
            false => {
                let none = || kempe_measure::NoForces;
                let found =
                    sensitivities_at(motion, held, measures, parameters, none(), |_| none());
                found.ok()
            }
        };
        let mut all: Vec<Option<Sensitivities>> = vec![None; self.data.rows.len()];
        if let Some(motion) = &moved.through {
            let (rows, places): (Vec<usize>, Vec<Held>) = self.places(motion).into_iter().unzip();
            for (row, found) in rows.into_iter().zip(at(motion, &places)?) {
                all[row] = Some(found);
            }
        }
        if let Some(motion) = &moved.own {
            let found = at(motion, &[Held::Path(motion.start)])?.pop();
            for (row, place) in self.data.rows.iter().zip(&mut all) {
                if row.at.is_none() {
                    place.clone_from(&found);
                }
            }
        }
        Some(all)
    }

    /// The assembly that a motion is of.
    pub fn assembly_of<'a>(&self, moved: &'a Moved) -> Option<&'a Assembly> {
        let motion = moved.through.as_ref().or(moved.own.as_ref())?;
        motion.assemblies.list.first()
    }

    /// The motion that was found.
    pub fn motion_of<'a>(&self, moved: &'a Moved) -> Option<&'a Arc<Motion>> {
        moved.through.as_ref().or(moved.own.as_ref())
    }
}

/// Where the drives start.
fn starts(design: &Design<f64>) -> Vec<f64> {
    let drives = design.mechanism.model.drives.iter();
    drives.map(|d| d.law.at(0.0, &design.parameters)).collect()
}

/// The motion that laws ask of a design.
fn motion(
    design: &Design<f64>,
    assembled: &Assembled,
) -> Result<Arc<Motion>, Option<Box<MotionError>>> {
    let refused = |error: MotionError| Some(Box::new(error));
    let Assembled::Like(_, known) = assembled else {
        return Motion::new(design).map_err(refused);
    };
    let found = find_assemblies(design, &starts(design), &mut Silent).unwrap_or_default();
    let mut list: Vec<Assembly> = found.list.into_iter().chain(found.others).collect();
    list.retain(|it| it.branch.signs == known.branch.signs);
    // Of those that signs do not tell apart the nearest.
    let apart = |it: &Assembly| -> f64 {
        let bodies = it.poses.iter().zip(&known.poses);
        bodies
            .map(|(a, b)| {
                let place = math::hypot(a.x - b.x, a.y - b.y) / design.size();
                place + math::hypot(a.c - b.c, a.s - b.s)
            })
            .sum()
    };
    list.sort_by(|a, b| apart(a).total_cmp(&apart(b)));
    list.truncate(1);
    if list.is_empty() {
        return Err(None);
    }
    let mut demand = Motion::demand(design);
    demand.assemblies = Some(Assemblies {
        list,
        complete: found.complete,
        ..Assemblies::default()
    });
    let found = Motion::along(design, demand, &mut Silent);
    found.map(Arc::new).map_err(refused)
}

/// Laws that lead every drive from a start through all rows, each in a second.
fn laws_through(start: &[f64], data: &Data) -> Vec<Law> {
    let places = || data.rows.iter().filter_map(|row| row.at.as_ref());
    let law = |(drive, start): (usize, &f64)| {
        let mut at = *start;
        let pieces = places().map(|place| {
            let to = place.get(drive).copied().unwrap_or(at);
            let way = (to - at).abs();
            at = to;
            match way > 0.0 {
                true => LawPiece::ConstantSpeed {
                    to: Expr::Const(to),
                    speed: Expr::Const(way),
                },
                false => LawPiece::Dwell {
                    duration: Expr::Const(1.0),
                },
            }
        });
        Law {
            pieces: pieces.collect(),
            from: Expr::Const(*start),
        }
    };
    start.iter().enumerate().map(law).collect()
}
