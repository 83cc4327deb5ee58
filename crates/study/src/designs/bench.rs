//! One design after the other on the bench: moved, and asked for numbers over its motion.

use std::sync::{Arc, Mutex, PoisonError, RwLock};

use kempe_dynamics::sensitivities_at as with_forces;
use kempe_measure::{Held, NoForces, OneSided, Sensitivities, sensitivities_at};
use kempe_mechanism::{Design, Mechanism};
use kempe_model::{
    Diagnostic, Measure, Model, ModelFile, OverStudy, ParameterId, SimulateStudy, Study, StudyKind,
    value,
};
use kempe_motion::circuit::Circuit;
use kempe_motion::events::EventKind;
use kempe_motion::{Motion, MotionError, Progress, PutTogether, Watch};

use super::asked::knows_forces;
use super::notes::with_notes;
use super::over::study_of;
use crate::along::{Along, not_answered};
use crate::columns::Asked;
use crate::explain::cannot_move;
use crate::motion_findings::{beyond_ends, motion_findings};
use crate::prepared::{design, motion};
use crate::quantity::Quantity;
use crate::rows::RowPlace;
use crate::simulation::moved;
use crate::unit::Units;

/// A corner at which both sides differ by less than this part of a derivative is blunt: the middle of both does for a derivative.
const BLUNT: f64 = 0.1;

/// A design that cannot be asked.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Refused {
    /// How far it is from one that can: below 1 the part of its way that is not reached, above 1 it does not even start. Infinite where the work
    /// was stopped.
    pub lack: f64,
    /// Why.
    pub why: String,
}

/// What a design answers.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Answer {
    /// Its numbers, SI; infinite or not a number where one has no value.
    pub numbers: Vec<f64>,
    /// Evidence of the pose in which its motion starts, as of a table's row.
    pub closure: f64,
    pub smallest_singular_value: f64,
    /// Whether branches cross on its way.
    pub crosses: bool,
}

/// A number with its derivatives to the varied parameters, SI.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Sloped {
    pub value: f64,
    pub slope: Vec<f64>,
}

/// A motion and what is to be told of it.
pub(crate) type Told = (Arc<Motion>, Vec<Diagnostic>);

/// What designs are put on.
#[derive(Clone)]
pub(crate) struct Bench<'m> {
    pub model: &'m Model,
    /// The study that is run.
    pub over: &'m Study,
    /// The parameters that differ from design to design.
    pub varied: Vec<ParameterId>,
    /// The numbers that are asked of every design.
    pub numbers: Vec<Quantity>,
    own: Design<f64>,
    /// How designs are put together that are much like the file's own.
    put_together: PutTogether,
    /// The motion by the file's own values, from which others are found sooner.
    first: Option<Arc<Motion>>,
    /// What a simulation by them finds, as which others count their turns: none where it does not begin, nothing until it is asked for.
    simulated: Arc<Mutex<Option<Option<Arc<Motion>>>>>,
    /// Whether designs on whose way branches cross are refused.
    apart: bool,
    /// What says whether the designs at hand are still wanted.
    watch: Arc<RwLock<Watch>>,
}

impl<'m> Bench<'m> {
    /// A bench for a study of designs.
    ///
    /// # Errors
    ///
    /// What of it no design can answer.
    pub fn new(
        model: &'m Model,
        over: &OverStudy,
        varied: Vec<ParameterId>,
        numbers: Vec<Quantity>,
    ) -> Result<Self, Vec<Diagnostic>> {
        let over = study_of(model, over)?;
        let own = design(model);
        let asked = Asked {
            columns: numbers.clone(),
            ..Asked::default()
        };
        let unanswered = match over.kind {
            // What it follows itself is known there.
            StudyKind::Simulate(_) => Vec::new(),
            _ => not_answered(&own.mechanism, &asked),
        };
        match unanswered.is_empty() {
            false => Err(unanswered),
            true => Ok(Self {
                model,
                over,
                varied,
                numbers,
                own,
                put_together: PutTogether::WithItsTurns,
                first: None,
                simulated: Arc::default(),
                apart: false,
                watch: Arc::default(),
            }),
        }
    }

    /// The same for pieces that are made alike: they are put together like the file's own design, whatever its hints are near.
    pub fn of_pieces(mut self) -> Self {
        self.put_together = PutTogether::LikeIt;
        self
    }

    /// Moves the file's own design first: others are then found sooner. What is to be told of it; errors where it does not move as asked.
    pub fn begin(
        &mut self,
        progress: &mut dyn Progress,
    ) -> Result<Vec<Diagnostic>, Vec<Diagnostic>> {
        if let StudyKind::Simulate(_) = self.over.kind {
            return Ok(Vec::new());
        }
        let first = motion(&self.own, progress)?;
        let told = motion_findings(&first);
        self.first = Some(first);
        Ok(told)
    }

    /// The motion by the file's own values, where it is known.
    pub fn own_motion(&self) -> Option<&Arc<Motion>> {
        self.first.as_ref()
    }

    /// Does work on designs, of which each stops where this says so. What is asked of designs afterwards, to tell what was found,
    /// goes on to its end.
    pub fn watched<T>(&self, watch: Watch, work: impl FnOnce() -> T) -> T {
        let watch_with = |watch: Watch| {
            *self.watch.write().unwrap_or_else(PoisonError::into_inner) = watch;
        };
        watch_with(watch);
        let done = work();
        watch_with(Watch::default());
        done
    }

    /// What says whether the designs at hand are still wanted. What was answered when they are not may be cut short.
    pub fn watch(&self) -> Watch {
        let watch = self.watch.read();
        watch.unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Takes over what another bench of the same model knows of the file's own motion.
    pub fn share(&mut self, other: &Self) {
        self.own = other.own.clone();
        self.first = other.first.clone();
        self.simulated = other.simulated.clone();
    }

    /// The mechanism that all designs share.
    pub fn mechanism(&self) -> &Mechanism {
        &self.own.mechanism
    }

    /// The values of the varied parameters in the file, SI.
    pub fn own_values(&self) -> Vec<f64> {
        let all = &self.own.parameters;
        self.varied.iter().map(|id| all[id.index()]).collect()
    }

    /// All parameters where the varied ones have these values, SI: formulas follow.
    pub fn parameters(&self, values: &[f64]) -> Vec<f64> {
        let mut all: Vec<f64> = Vec::with_capacity(self.model.parameters.len());
        for (index, parameter) in self.model.parameters.iter().enumerate() {
            let own = self.varied.iter().position(|id| id.index() == index);
            let given = own.and_then(|k| values.get(k)).copied();
            all.push(given.unwrap_or_else(|| value(&parameter.value, &all)));
        }
        all
    }

    /// How these values are set when a study is run.
    pub fn set(&self, values: &[f64]) -> String {
        let units = Units::of(self.model);
        let all = self.varied.iter().zip(values).filter_map(|(id, si)| {
            let own = self.model.parameters.get(id.index())?;
            let value = units.text(*si, own.dimension);
            Some(format!("--set \"{} = {value}\"", own.name))
        });
        all.collect::<Vec<_>>().join(" ")
    }

    /// The model with these values, and its file.
    pub fn model_with(&self, values: &[f64]) -> (Model, ModelFile) {
        let given: Vec<_> = self
            .varied
            .iter()
            .copied()
            .zip(values.iter().copied())
            .collect();
        self.model.with_values(&given)
    }

    /// The design with these values.
    ///
    /// # Errors
    ///
    /// Why its dimensions make no sense.
    pub fn design(&self, values: &[f64]) -> Result<Design<f64>, Refused> {
        let parameters = self.parameters(values);
        let odd = (self.model.parameters.iter().zip(&parameters)).find(|(_, x)| !x.is_finite());
        let why = match odd {
            Some((p, x)) => Some(format!("parameter `{}` is {x}", p.name)),
            None => (self.model.unsound(&parameters).into_iter().next()).map(|d| d.message),
        };
        match why {
            Some(why) => Err(Refused { lack: 3.0, why }),
            None => Ok(Design::new(&self.own.mechanism, &parameters)),
        }
    }

    /// How a simulation of the design with these values moves, turns of links counted as those of the file's own design, and what is to be
    /// told of it.
    fn simulated(
        &self,
        values: &[f64],
        study: &SimulateStudy,
        (warned, progress): (bool, &mut dyn Progress),
    ) -> Result<Told, Refused> {
        let refused = |lack: f64, why: Option<&Diagnostic>| Refused {
            lack,
            why: why.map_or_else(String::new, with_notes),
        };
        let mut found_by = |values: &[f64], warned: bool| {
            let (model, _) = self.model_with(values);
            moved(&model, (&self.over.name, study), warned, progress)
        };
        let found = found_by(values, warned).map_err(|told| refused(2.0, told.first()))?;
        if let Some((why, left)) = &found.ended {
            return Err(refused(left.clamp(f64::EPSILON, 1.0), Some(why)));
        }
        let own = self.own_values();
        let mut known = (self.simulated.lock()).unwrap_or_else(PoisonError::into_inner);
        if known.is_none() {
            let own = match values == own {
                true => Ok(found.motion.clone()),
                false => found_by(&own, false).map(|own| own.motion),
            };
            // What was stopped tells nothing; where the file's own design does not move, others may.
            match own {
                Err(told) if told.iter().any(|d| d.code == "stopped") => {}
                own => *known = Some(own.ok()),
            }
        }
        let motion = match known.iter().flatten().next() {
            Some(own) => found.motion.counted_as(own),
            None => found.motion,
        };
        Ok((motion, found.told))
    }

    /// How the design with these values moves.
    ///
    /// # Errors
    ///
    /// Why it does not move as asked.
    pub fn motion(
        &self,
        values: &[f64],
        progress: &mut dyn Progress,
    ) -> Result<Arc<Motion>, Refused> {
        (self.moves(values, false, progress)).map(|(motion, _)| motion)
    }

    /// The same, and what a simulation is warned of.
    ///
    /// # Errors
    ///
    /// Why it does not move as asked.
    pub fn told_motion(
        &self,
        values: &[f64],
        progress: &mut dyn Progress,
    ) -> Result<Told, Refused> {
        self.moves(values, true, progress)
    }

    /// Refuses designs on whose way branches cross from now on, if it does not cross them itself: their numbers are of no design beside them.
    pub fn keep_apart(&mut self, motion: &Motion) {
        self.apart = !crosses(motion);
    }

    fn moves(
        &self,
        values: &[f64],
        warned: bool,
        progress: &mut dyn Progress,
    ) -> Result<Told, Refused> {
        let design = self.design(values)?;
        if let StudyKind::Simulate(study) = &self.over.kind {
            return self.simulated(values, study, (warned, progress));
        }
        let found = match &self.first {
            Some(first) => first
                .again_as(&design, self.put_together, progress)
                .map(|motion| motion.counted_as(first)),
            None => Motion::with_progress(&design, progress),
        };
        let moved = found.map_err(|error| Refused {
            lack: match error {
                MotionError::Stopped { .. } => f64::INFINITY,
                MotionError::CannotAssemble { .. } => 1.0 + open_by(&design, &error),
                _ => 2.0,
            },
            why: cannot_move(&design, &error).message,
        })?;
        // A circuit goes as far as it goes.
        let ends = match &self.over.kind {
            StudyKind::Motion(along) if along.circuit => None,
            _ => beyond_ends(&moved),
        };
        match ends {
            None if self.apart && crosses(&moved) => Err(Refused {
                lack: f64::EPSILON,
                why: "branches cross on its way, and it may go on as what is beside it does not"
                    .to_owned(),
            }),
            None => {
                let told = match warned && self.put_together != PutTogether::LikeIt {
                    true => self.assembled_otherwise(&moved),
                    false => Vec::new(),
                };
                Ok((moved, told))
            }
            Some(told) => {
                let (asked, reached) = (moved.demanded, moved.reached());
                let part = (reached.1 - reached.0).max(0.0) / (asked.1 - asked.0).abs();
                Err(Refused {
                    lack: (1.0 - part).clamp(f64::EPSILON, 1.0),
                    why: told,
                })
            }
        }
    }

    /// Where a design goes with another way to put the mechanism together than the file's own, or than it would by itself.
    fn assembled_otherwise(&self, moved: &Motion) -> Vec<Diagnostic> {
        let Some(first) = &self.first else {
            return Vec::new();
        };
        let mut told = Vec::new();
        if !moved.starts_in_modes_of(first) {
            let message = "it is put together in another way than the file's own design, as the hints of [assembly] ask";
            told.push(Diagnostic::warning("other-assembly", message));
        }
        if let Some(link) = moved.counted_otherwise() {
            let name = &self.model.links[link.index()].name;
            let message = format!(
                "`{name}` starts nearest to where it does in the file's own design; by itself it would be counted from a whole turn away, which wheels tell apart: a hint says which, such as {name} = {{ near = … }} in [assembly]"
            );
            told.push(Diagnostic::warning("other-assembly", message));
        }
        told
    }

    /// The whole circuit of the design with these values.
    ///
    /// # Errors
    ///
    /// Why it cannot be followed.
    pub fn circuit(&self, values: &[f64]) -> Result<Circuit, Refused> {
        let design = self.design(values)?;
        Circuit::new(&design).map_err(|error| Refused {
            lack: match error {
                MotionError::CannotAssemble { .. } => 1.0 + open_by(&design, &error),
                _ => 2.0,
            },
            why: cannot_move(&design, &error).message,
        })
    }

    /// What moves along a motion on the bench, ready to be sampled for quantities.
    ///
    /// # Errors
    ///
    /// What cannot be measured, or what acts makes no sense.
    pub fn along(
        &self,
        motion: &Arc<Motion>,
        quantities: &[&Quantity],
        progress: &mut dyn Progress,
    ) -> Result<Along, Refused> {
        let model = &motion.mechanism().model;
        let forces =
            knows_forces(self.over) && quantities.iter().any(|q| model.needs_forces(&q.measure));
        Along::with_progress(model, motion, quantities, forces, &[], progress).map_err(|told| {
            let stopped = told.iter().any(|d| d.code == "stopped");
            Refused {
                lack: if stopped { f64::INFINITY } else { 2.0 },
                why: told.first().map_or_else(String::new, |d| d.message.clone()),
            }
        })
    }

    /// What the design with these values answers.
    ///
    /// # Errors
    ///
    /// Why it does not move as asked.
    pub fn answer(&self, values: &[f64]) -> Result<Answer, Refused> {
        let motion = self.motion(values, &mut self.watch())?;
        self.answer_of(&motion)
    }

    /// What a design answers whose motion is known.
    ///
    /// # Errors
    ///
    /// What cannot be measured.
    pub fn answer_of(&self, motion: &Arc<Motion>) -> Result<Answer, Refused> {
        let quantities: Vec<&Quantity> = self.numbers.iter().collect();
        let mut along = self.along(motion, &quantities, &mut self.watch())?;
        let row = along.row(RowPlace::Drive(motion.start)).sample;
        Ok(Answer {
            numbers: row.values,
            closure: row.closure,
            smallest_singular_value: row.smallest_singular_value,
            crosses: crosses(motion),
        })
    }

    /// The numbers of the design with these values, SI; infinite or not a number where a number has no value.
    ///
    /// # Errors
    ///
    /// Why it has none at all.
    pub fn numbers(&self, values: &[f64]) -> Result<Vec<f64>, Refused> {
        self.answer(values).map(|answer| answer.numbers)
    }

    /// Whether numbers have exact derivatives: those of simulations have none.
    pub fn has_slopes(&self) -> bool {
        !matches!(self.over.kind, StudyKind::Simulate(_))
    }

    /// The numbers of the design with these values and their exact derivatives to the varied parameters, SI; not a number where there is none,
    /// as at a corner. Of simulations there are none.
    ///
    /// # Errors
    ///
    /// Why it does not move as asked.
    pub fn slopes(&self, values: &[f64]) -> Result<Vec<Sloped>, Refused> {
        let motion = self.motion(values, &mut self.watch())?;
        let measures: Vec<&Measure> = self.numbers.iter().map(|q| &q.measure).collect();
        let found = self.two_sided_sensitivities(&motion, &[Held::Path(motion.start)], &measures);
        let found = found?.pop();
        let found = found
            .into_iter()
            .flat_map(|it| it.values.into_iter().zip(it.derivatives));
        Ok(found
            .map(|(value, slope)| Sloped { value, slope })
            .collect())
    }

    /// Measures of a design's motion at places, with their derivatives to the varied parameters. Numbers over the motion go on by one side at
    /// their corners: who asks follows all their peaks.
    ///
    /// # Errors
    ///
    /// What cannot be measured.
    pub fn sensitivities(
        &self,
        motion: &Arc<Motion>,
        held: &[Held],
        measures: &[&Measure],
    ) -> Result<Vec<Sensitivities>, Refused> {
        let mut all = self.two_sided_sensitivities(motion, held, measures)?;
        for found in &mut all {
            let (sides, derivatives) = (&found.one_sided, &mut found.derivatives);
            for side in sides.iter().filter(|side| side.over_motion) {
                derivatives[side.measure][side.parameter] = side.slope;
            }
        }
        Ok(all)
    }

    /// The same without derivatives at corners, but the middle of both sides at those that are blunt.
    ///
    /// # Errors
    ///
    /// What cannot be measured.
    pub fn two_sided_sensitivities(
        &self,
        motion: &Arc<Motion>,
        held: &[Held],
        measures: &[&Measure],
    ) -> Result<Vec<Sensitivities>, Refused> {
        let model = &motion.mechanism().model;
        let forces = measures.iter().any(|m| model.needs_forces(m));
        let none = || Refused {
            lack: 2.0,
            why: "it cannot be measured as asked".to_owned(),
        };
        let mut all = match forces {
            true => with_forces(motion, held, measures, &self.varied).map_err(|_| none()),
            false => {
                let found =
                    sensitivities_at(motion, held, measures, &self.varied, NoForces, |_| NoForces);
                found.map_err(|_| none())
            }
        }?;
        for found in &mut all {
            let (sides, derivatives) = (&found.one_sided, &mut found.derivatives);
            for side in sides.iter().filter(|side| is_blunt(side)) {
                derivatives[side.measure][side.parameter] = 0.5 * (side.slope + side.other);
            }
        }
        Ok(all)
    }
}

/// Whether both sides of a corner are known and nearly the same.
fn is_blunt(side: &OneSided) -> bool {
    (side.slope - side.other).abs() <= BLUNT * side.slope.abs().max(side.other.abs())
}

/// By how much a mechanism misses being assembled, in its sizes; 1 where that is not known.
fn open_by(design: &Design<f64>, error: &MotionError) -> f64 {
    crate::explain::open_by(design, error).unwrap_or(1.0)
}

/// Whether branches cross on the way of a motion.
pub(crate) fn crosses(motion: &Motion) -> bool {
    motion
        .events
        .iter()
        .any(|event| event.kind == EventKind::ChangePoint)
}
