//! `[measures]` and `[studies]`.

use kempe_units::{Dimension, Expr};

use crate::drive::{Law, LawPiece};
use crate::ids::Scalar;
use crate::item::{File, Item};
use crate::key_table::{GOALS, word_of};
use crate::read::springs::tension;
use crate::study::{BalanceGoal, MotionStudy, Plot, Rows, Study, StudyKind};
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
        for study in &self.model.announced {
            let kind = vec![("kind".to_owned(), Item::text(&study.kind))];
            let entry = (study.name.clone(), Item::Table(kind));
            file.section("studies").push(entry);
        }
    }

    fn study(&self, study: &Study) -> Entries {
        let kind = match &study.kind {
            StudyKind::Motion(_) => "motion",
            StudyKind::Forces(_) => "forces",
            StudyKind::Balance(_) => "balance",
            StudyKind::Spring(_) => "spring",
        };
        let mut entries = vec![("kind".to_owned(), Item::text(kind))];
        self.along(study.kind.along(), &mut entries);
        let mut put = |key: &str, item: Item| entries.push((key.to_owned(), item));
        match &study.kind {
            StudyKind::Motion(_) | StudyKind::Forces(_) => {}
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
        }
        entries
    }

    fn bounds(&self, bounds: &[Option<Scalar>; 2], dimension: Dimension) -> Item {
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
            let plot = |plot: &Plot| match plot {
                Plot::Curves(curves) => match curves.as_slice() {
                    [one] => Item::text(&one.name),
                    many => Item::List(many.iter().map(|c| Item::text(&c.name)).collect()),
                },
                Plot::Path(point) => Item::Text(format!("path({})", self.point(*point))),
                Plot::Hodograph(hodograph) => Item::text(&hodograph.name),
            };
            put("plot", Item::List(along.plots.iter().map(plot).collect()));
        }
    }
}
