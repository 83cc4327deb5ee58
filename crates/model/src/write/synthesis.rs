//! Studies that ask for linkages.

use kempe_units::Dimension;

use crate::ids::Scalar;
use crate::item::Item;
use crate::key_table::synthesis::{FREE, LINKAGES};
use crate::key_table::word_of;
use crate::synthesis::{
    Asked, DeadCentresTask, FunctionTask, LinkageKind, RatesTask, Stroke, SynthesisTask,
    SynthesizeStudy, WantedCurve, WantedFunction, WantedPair,
};
use crate::write::spelling::Writer;

impl Writer<'_> {
    pub fn synthesis(&self, study: &SynthesizeStudy, put: &mut dyn FnMut(&str, Item)) {
        match &study.task {
            SynthesisTask::Function(task) => self.function(task, put),
            SynthesisTask::Rates(task) => self.rates(task, put),
            SynthesisTask::DeadCentres(task) => self.dead_centres(task, put),
        }
        let texts = |asked: &[Asked]| {
            let texts = asked.iter().map(|asked| Item::text(&asked.text));
            Item::List(texts.collect())
        };
        if !study.accept.is_empty() {
            put("accept", texts(&study.accept));
        }
        if let Some(rank) = &study.rank {
            put("rank", Item::text(&rank.text));
        }
        if !study.columns.is_empty() {
            put("columns", texts(&study.columns));
        }
        put("keep", Item::Number(study.keep as f64));
    }

    fn listed<const N: usize>(&self, values: &[Scalar; N], dimension: Dimension) -> Item {
        let items = values.iter().map(|value| self.scalar(value, dimension));
        Item::List(items.collect())
    }

    fn function(&self, task: &FunctionTask, put: &mut dyn FnMut(&str, Item)) {
        put("task", Item::text("function"));
        put("linkage", Item::text(word_of(&LINKAGES, &task.linkage)));
        let of_output = match task.linkage {
            LinkageKind::SliderCrank => Dimension::LENGTH,
            _ => Dimension::ANGLE,
        };
        match &task.wanted {
            WantedFunction::Pairs(pairs) => {
                let pairs = pairs.iter().map(|pair| self.pair(pair, of_output));
                put("pairs", Item::List(pairs.collect()));
            }
            WantedFunction::Curve(curve) => put("function", self.curve(curve, of_output)),
        }
        let zero = |zero: &Option<Scalar>, dimension| match zero {
            Some(zero) => self.scalar(zero, dimension),
            None => Item::text(FREE),
        };
        let [input, output] = &task.zeros;
        let zeros = vec![zero(input, Dimension::ANGLE), zero(output, of_output)];
        put("zeros", Item::List(zeros));
        if let Some(ground) = &task.ground {
            put("ground", self.scalar(ground, Dimension::LENGTH));
        }
    }

    fn pair(&self, pair: &WantedPair, of_output: Dimension) -> Item {
        let ratio = of_output / Dimension::ANGLE;
        let mut items = vec![
            self.scalar(&pair.input, Dimension::ANGLE),
            self.scalar(&pair.output, of_output),
        ];
        items.extend(pair.ratio.iter().map(|r| self.scalar(r, ratio)));
        let rate = ratio / Dimension::ANGLE;
        items.extend(pair.ratio_rate.iter().map(|r| self.scalar(r, rate)));
        Item::List(items)
    }

    fn curve(&self, curve: &WantedCurve, of_output: Dimension) -> Item {
        Item::Table(vec![
            ("y".to_owned(), Item::text(&curve.text)),
            ("x".to_owned(), self.listed(&curve.x, Dimension::NONE)),
            (
                "input".to_owned(),
                self.listed(&curve.input, Dimension::ANGLE),
            ),
            ("output".to_owned(), self.listed(&curve.output, of_output)),
            ("points".to_owned(), Item::Number(curve.points as f64)),
        ])
    }

    fn rates(&self, task: &RatesTask, put: &mut dyn FnMut(&str, Item)) {
        put("task", Item::text("rates"));
        put(
            "speeds",
            self.listed(&task.speeds, Dimension::ANGULAR_SPEED),
        );
        let dimension = Dimension::ANGULAR_ACCELERATION;
        put("accelerations", self.listed(&task.accelerations, dimension));
        put("ground", self.scalar(&task.ground, Dimension::LENGTH));
    }

    fn dead_centres(&self, task: &DeadCentresTask, put: &mut dyn FnMut(&str, Item)) {
        put("task", Item::text("dead-centres"));
        let mut length = |key: &str, value: &Scalar| {
            put(key, self.scalar(value, Dimension::LENGTH));
        };
        let (coupler, offset) = match &task.stroke {
            Stroke::Swing {
                rocker, coupler, ..
            } => {
                length("rocker", rocker);
                (coupler, &None)
            }
            Stroke::Travel {
                travel,
                coupler,
                offset,
            } => {
                length("stroke", travel);
                (coupler, offset)
            }
        };
        coupler.iter().for_each(|c| length("coupler", c));
        offset.iter().for_each(|o| length("offset", o));
        if let Stroke::Swing { swing, .. } = &task.stroke {
            put("swing", self.scalar(swing, Dimension::ANGLE));
        }
        put("time_ratio", self.scalar(&task.time_ratio, Dimension::NONE));
    }
}
