//! Studies that ask for linkages.

use kempe_units::Dimension;

use crate::ids::Scalar;
use crate::item::Item;
use crate::key_table::synthesis::{FREE, LINKAGES, OUTPUTS};
use crate::key_table::word_of;
use crate::synthesis::{
    Asked, CognatesTask, DeadCentresTask, DwellOutput, DwellTask, DyadGiven, FunctionTask,
    GuidanceTask, LinkageKind, PathTask, RatesTask, Stroke, SynthesisTask, SynthesizeStudy,
    WantedCurve, WantedFunction, WantedPair,
};
use crate::write::spelling::Writer;

impl Writer<'_> {
    pub fn synthesis(&self, study: &SynthesizeStudy, put: &mut dyn FnMut(&str, Item)) {
        match &study.task {
            SynthesisTask::Function(task) => self.function(task, put),
            SynthesisTask::Rates(task) => self.rates(task, put),
            SynthesisTask::DeadCentres(task) => self.dead_centres(task, put),
            SynthesisTask::Motion(task) => self.guidance(task, put),
            SynthesisTask::Path(task) => self.path(task, put),
            SynthesisTask::Dwell(task) => self.dwell(task, put),
            SynthesisTask::Cognates(task) => self.cognates(task, put),
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

    pub fn listed(&self, values: &[Scalar], dimension: Dimension) -> Item {
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

    fn guidance(&self, task: &GuidanceTask, put: &mut dyn FnMut(&str, Item)) {
        put("task", Item::text("motion"));
        if let Some(kind) = &task.linkage {
            put("linkage", Item::text(word_of(&LINKAGES, kind)));
        }
        let poses = task.poses.iter().map(|pose| {
            let origin = (pose.origin.iter()).map(|x| self.scalar(x, Dimension::LENGTH));
            let angle = self.scalar(&pose.angle, Dimension::ANGLE);
            Item::List(origin.chain([angle]).collect())
        });
        put("poses", Item::List(poses.collect()));
        self.dyads(&task.dyads, put);
        for (name, corners) in [("pivots_in", &task.pivots_in), ("pins_in", &task.pins_in)] {
            if let Some(corners) = corners {
                put(name, self.two_places(corners));
            }
        }
    }

    fn path(&self, task: &PathTask, put: &mut dyn FnMut(&str, Item)) {
        put("task", Item::text("path"));
        let points = task.points.iter().map(|point| {
            let place = (point.place.iter()).map(|x| self.scalar(x, Dimension::LENGTH));
            let angle = point.angle.iter();
            let angle = angle.map(|angle| self.scalar(angle, Dimension::ANGLE));
            Item::List(place.chain(angle).collect())
        });
        put("points", Item::List(points.collect()));
        if let Some(angles) = &task.angles {
            let angles = angles.iter().map(|a| self.scalar(a, Dimension::ANGLE));
            put("angles", Item::List(angles.collect()));
        }
        if task.cognates {
            put("cognates", Item::Flag(true));
        }
        self.dyads(&task.dyads, put);
        if let Some(corners) = &task.pivots_in {
            put("pivots_in", self.two_places(corners));
        }
    }

    fn dwell(&self, task: &DwellTask, put: &mut dyn FnMut(&str, Item)) {
        put("task", Item::text("dwell"));
        put("point", Item::text(self.point(task.point)));
        put("drive", Item::text(self.drive(task.drive)));
        let drive = self.model.drives.get(task.drive.index());
        let coordinate = drive.map_or(Dimension::ANGLE, |d| d.dimension);
        put("dwell", self.scalar(&task.dwell, coordinate));
        put("output", Item::text(word_of(&OUTPUTS, &task.output)));
        let (key, dimension) = match task.output {
            DwellOutput::Slider => ("stroke", Dimension::LENGTH),
            _ => ("swing", Dimension::ANGLE),
        };
        if let Some(stroke) = &task.stroke {
            put(key, self.scalar(stroke, dimension));
        }
        if let Some(corners) = &task.pivots_in {
            put("pivots_in", self.two_places(corners));
        }
    }

    fn cognates(&self, task: &CognatesTask, put: &mut dyn FnMut(&str, Item)) {
        put("task", Item::text("cognates"));
        put("point", Item::text(self.point(task.point)));
        put("drive", Item::text(self.drive(task.drive)));
        if task.parallel {
            put("parallel", Item::Flag(true));
        }
    }

    fn dyads(&self, dyads: &[DyadGiven; 2], put: &mut dyn FnMut(&str, Item)) {
        for (name, dyad) in ["crank", "rocker"].iter().zip(dyads) {
            if *dyad
                != (DyadGiven {
                    span: dyad.span.clone(),
                    ..DyadGiven::default()
                })
            {
                put(name, self.dyad(dyad));
            }
        }
    }

    fn two_places(&self, both: &[[Scalar; 2]; 2]) -> Item {
        let places = both.iter().map(|p| self.listed(p, Dimension::LENGTH));
        Item::List(places.collect())
    }

    fn dyad(&self, dyad: &DyadGiven) -> Item {
        let mut entries = Vec::new();
        let points = [
            ("fixed", &dyad.fixed, &dyad.fixed_on),
            ("moving", &dyad.moving, &dyad.moving_on),
        ];
        for (name, point, line) in points {
            if let Some(point) = point {
                entries.push((name.to_owned(), self.listed(point, Dimension::LENGTH)));
            }
            if let Some(line) = line {
                entries.push((format!("{name}_on"), self.two_places(line)));
            }
        }
        if let Some(along) = &dyad.along {
            entries.push(("along".to_owned(), self.scalar(along, Dimension::ANGLE)));
        }
        Item::Table(entries)
    }
}
