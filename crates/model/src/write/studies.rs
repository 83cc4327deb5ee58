//! `[measures]` and `[studies]`.

use kempe_units::{Dimension, Expr};

use crate::clearance::{ClearanceModel, ClearanceRates};
use crate::contact::ContactStates;
use crate::drive::{Law, LawPiece};
use crate::ids::Scalar;
use crate::item::{File, Item};
use crate::key_table::clearance::{MODELS, RATES};
use crate::key_table::{COORDINATES, GOALS, METHODS, word_of};
use crate::motion_study::{MotionStudy, Rows};
use crate::read::springs::tension;
use crate::simulate_study::{PlayAt, SimulateStudy, Stop, StopResistance};
use crate::study::{BalanceGoal, Study, StudyKind, VibrationStudy};
use crate::write::spelling::Writer;

type Entries = Vec<(String, Item)>;

impl Writer<'_> {
    pub fn questions(&self, file: &mut File) {
        for measure in &self.model.measures {
            let item = self.measure(&measure.measure, measure.dimension);
            file.section("measures").push((measure.name.clone(), item));
        }
        for study in &self.model.studies {
            let entry = (study.name.clone(), Item::Table(self.study(study)));
            file.section("studies").push(entry);
        }
    }

    fn study(&self, study: &Study) -> Entries {
        let kind = match &study.kind {
            StudyKind::Motion(_) => "motion",
            StudyKind::Forces(_) => "forces",
            StudyKind::Balance(_) => "balance",
            StudyKind::Spring(_) => "spring",
            StudyKind::Simulate(_) => "simulate",
            StudyKind::Clearance(_) | StudyKind::Contact(_) => "clearance",
            StudyKind::Vibrations(_) => "vibrations",
            StudyKind::Adjust(_) => "adjust",
            StudyKind::Sweep(_) => "sweep",
            StudyKind::Tolerance(_) => "tolerance",
            StudyKind::Optimize(_) => "optimize",
            StudyKind::Synthesize(_) => "synthesize",
        };
        let mut entries = vec![("kind".to_owned(), Item::text(kind))];
        let one_pose = |study: &VibrationStudy| study.along.rows == Rows::Count(1);
        let no_rows = match &study.kind {
            StudyKind::Vibrations(study) => one_pose(study),
            StudyKind::Synthesize(_)
            | StudyKind::Adjust(_)
            | StudyKind::Sweep(_)
            | StudyKind::Tolerance(_)
            | StudyKind::Optimize(_) => true,
            _ => false,
        };
        if !no_rows {
            self.along(study.kind.along(), &mut entries);
        }
        let mut put = |key: &str, item: Item| entries.push((key.to_owned(), item));
        match &study.kind {
            StudyKind::Motion(_) | StudyKind::Forces(_) => {}
            StudyKind::Clearance(study) => {
                let model = ClearanceModel::Continuous;
                put("model", Item::text(word_of(&MODELS, &model)));
                if study.rates != ClearanceRates::Frozen {
                    put("rates", Item::text(word_of(&RATES, &study.rates)));
                }
            }
            StudyKind::Balance(study) => {
                if study.goal != BalanceGoal::ShakingForce {
                    put("goal", Item::text(word_of(&GOALS, &study.goal)));
                }
                let on = study
                    .on
                    .iter()
                    .map(|(link, _)| Item::text(self.link(*link)));
                put("on", Item::List(on.collect()));
                put("radius", self.scalar(&study.radius, Dimension::LENGTH));
            }
            StudyKind::Spring(study) => {
                let spring = self.model.actions.springs.get(study.spring);
                put(
                    "spring",
                    Item::text(spring.map_or("?", |s| s.name.as_str())),
                );
                put("drive", Item::text(self.drive(study.drive)));
                let drive = self.model.drives.get(study.drive.index());
                let effort = match drive.map(|d| d.dimension) {
                    Some(Dimension::ANGLE) => Dimension::TORQUE,
                    _ => Dimension::FORCE,
                };
                if study.wanted != Expr::Const(0.0) {
                    put("wanted", self.measure(&study.wanted, effort));
                }
                let force = spring.map_or(Dimension::FORCE, |s| tension(&s.between));
                let travel = match force {
                    Dimension::TORQUE => Dimension::ANGLE,
                    _ => Dimension::LENGTH,
                };
                put("stiffness", self.bounds(&study.stiffness, force / travel));
                put("preload", self.bounds(&study.preload, force));
            }
            StudyKind::Contact(study) => {
                let model = match study.states {
                    ContactStates::Two => ClearanceModel::TwoState,
                    ContactStates::Three => ClearanceModel::ThreeState,
                };
                put("model", Item::text(word_of(&MODELS, &model)));
                self.in_time(&study.motion, 0, &mut put);
            }
            StudyKind::Simulate(study) => {
                self.in_time(study, self.model.drives.len(), &mut put);
            }
            StudyKind::Vibrations(study) => self.vibrations(study, &mut put),
            StudyKind::Adjust(study) => self.adjust(study, &mut put),
            StudyKind::Sweep(study) => self.sweep(study, &mut put),
            StudyKind::Tolerance(study) => self.tolerance(study, &mut put),
            StudyKind::Optimize(study) => self.optimize(study, &mut put),
            StudyKind::Synthesize(study) => self.synthesis(study, &mut put),
        }
        entries
    }

    /// How something moves in time; so many drives are let go where the file does not say.
    fn in_time(&self, study: &SimulateStudy, unsaid: usize, put: &mut dyn FnMut(&str, Item)) {
        put("until", self.scalar(&study.until, Dimension::TIME));
        if study.released.len() != unsaid {
            let released = study.released.iter();
            let names = released.map(|drive| Item::text(self.drive(*drive)));
            put("release", Item::List(names.collect()));
        }
        let mut start = Entries::new();
        for it in &study.start {
            let name = self.drive(it.drive);
            let drive = self.model.drives.get(it.drive.index());
            let coordinate = drive.map_or(Dimension::NONE, |d| d.dimension);
            if let Some(at) = &it.at {
                start.push((name.to_owned(), self.scalar(at, coordinate)));
            }
            if let Some(rate) = &it.rate {
                let rate = self.scalar(rate, coordinate / Dimension::TIME);
                start.push((format!("{name}_rate"), rate));
            }
        }
        for it in &study.plays {
            let (name, second) = match it.at {
                PlayAt::Pin(point) => (self.point(point), Dimension::LENGTH),
                PlayAt::Joint(joint) => (self.joint(joint), Dimension::ANGLE),
            };
            let pair = |[a, b]: &[Scalar; 2], per: Dimension| {
                let pair = [(a, Dimension::LENGTH), (b, second)];
                Item::List(pair.map(|(x, of)| self.scalar(x, of / per)).into())
            };
            let place = it
                .place
                .iter()
                .map(|at| (name.to_owned(), pair(at, Dimension::NONE)));
            start.extend(place);
            let rate = it.rate.iter();
            start.extend(rate.map(|rate| (format!("{name}_rate"), pair(rate, Dimension::TIME))));
        }
        if !start.is_empty() {
            put("start", Item::Table(start));
        }
        if !study.stops.is_empty() {
            let stops = study.stops.iter();
            put(
                "stops",
                Item::Table(stops.map(|s| (s.name.clone(), self.stop(s))).collect()),
            );
        }
        match study.end_when.as_slice() {
            [] => {}
            [one] => put("end_when", Item::text(&one.text)),
            many => {
                let texts = many.iter().map(|c| Item::text(&c.text));
                put("end_when", Item::List(texts.collect()));
            }
        }
        if let Some(tolerance) = &study.tolerance {
            put("tolerance", self.scalar(tolerance, Dimension::NONE));
        }
        if let Some(method) = &study.method {
            put("method", Item::text(word_of(&METHODS, method)));
        }
        if let Some(coordinates) = &study.coordinates {
            put(
                "coordinates",
                Item::text(word_of(&COORDINATES, coordinates)),
            );
        }
    }

    fn stop(&self, stop: &Stop) -> Item {
        let (coordinate, force) = match stop.is_angle {
            true => (Dimension::ANGLE, Dimension::TORQUE),
            false => (Dimension::LENGTH, Dimension::FORCE),
        };
        let between = self.bounds(&stop.between, coordinate);
        let mut entries = vec![("between".to_owned(), between)];
        let mut put = |key: &str, item: Item| entries.push((key.to_owned(), item));
        match &stop.resistance {
            StopResistance::Rigid { restitution: None } => {
                return self.bounds(&stop.between, coordinate);
            }
            StopResistance::Rigid {
                restitution: Some(restitution),
            } => put("restitution", self.scalar(restitution, Dimension::NONE)),
            StopResistance::Soft { stiffness, damping } => {
                put("stiffness", self.scalar(stiffness, force / coordinate));
                if let Some(damping) = damping {
                    let rate = coordinate / Dimension::TIME;
                    put("damping", self.scalar(damping, force / rate));
                }
            }
        }
        Item::Table(entries)
    }

    fn vibrations(&self, study: &VibrationStudy, put: &mut dyn FnMut(&str, Item)) {
        // without it all are let go
        if study.release.len() < self.model.drives.len() {
            let release = study.release.iter().map(|d| Item::text(self.drive(*d)));
            put("release", Item::List(release.collect()));
        }
        if !study.at.is_empty() {
            let at = study.at.iter().map(|(drive, at)| {
                let dimension = self.model.drives.get(drive.index()).map(|d| d.dimension);
                let place = self.scalar(at, dimension.unwrap_or(Dimension::NONE));
                (self.drive(*drive).to_owned(), place)
            });
            put("at", Item::Table(at.collect()));
        }
        if !study.settles {
            put("equilibrium", Item::Flag(false));
        }
        if study.moving {
            put("moving", Item::Flag(true));
        }
    }

    pub fn bounds(&self, bounds: &[Option<Scalar>; 2], dimension: Dimension) -> Item {
        let bound = |bound: &Option<Scalar>| match bound {
            Some(bound) => self.scalar(bound, dimension),
            None => Item::text("none"),
        };
        Item::List(bounds.iter().map(bound).collect())
    }

    fn along(&self, along: &MotionStudy, entries: &mut Entries) {
        let mut put = |key: &str, item: Item| entries.push((key.to_owned(), item));
        match &along.rows {
            Rows::Count(rows) => put("rows", Item::Number(*rows as f64)),
            Rows::TimeStep(step) => put("step", self.expression(step, Dimension::TIME)),
            Rows::DriveStep(step) => {
                // all drives but one are held
                let held = |law: &Law| matches!(law.pieces.as_slice(), [LawPiece::Dwell { .. }]);
                let moving = self.model.drives.iter().find(|d| !held(&d.law));
                let is = moving.map_or(Dimension::NONE, |d| d.dimension);
                put("step", self.scalar(step, is));
            }
        }
        if along.circuit {
            put("circuit", Item::Flag(true));
        }
        // a column's head is its text
        if !along.columns.is_empty() {
            let columns = along.columns.iter().map(|c| Item::text(&c.name));
            put("columns", Item::List(columns.collect()));
        }
        if !along.plots.is_empty() {
            let plots = along.plots.iter().map(|plot| self.plot(plot));
            put("plot", Item::List(plots.collect()));
        }
    }
}
