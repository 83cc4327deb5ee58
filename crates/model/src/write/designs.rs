//! Studies of many designs.

use kempe_units::{Dimension, Expr};

use crate::designs::{
    Among, Change, Combine, Goal, Limit, OptimizeStudy, OverStudy, Spread, SweepStudy, SweptValues,
    ToleranceStudy,
};
use crate::fit::{Fit, Timing, Traced};
use crate::ids::{ParameterId, Scalar};
use crate::item::Item;
use crate::key_table::designs::{COMBINE, OPTIMIZE_METHODS, SPACING, TIMINGS};
use crate::key_table::word_of;
use crate::motion_study::Plot;
use crate::write::spelling::Writer;

/// One of a hundred.
const PERCENT: f64 = 0.01;

impl Writer<'_> {
    pub fn sweep(&self, study: &SweepStudy, put: &mut dyn FnMut(&str, Item)) {
        self.over(&study.over, put);
        self.vary(&study.vary, put, |it| {
            let (_, dimension) = self.named_parameter(it.parameter);
            let values = match &it.values {
                SweptValues::These(values) => self.listed(values, dimension),
                SweptValues::Even { from, to, count } => Item::Table(vec![
                    ("from".to_owned(), self.scalar(from, dimension)),
                    ("to".to_owned(), self.scalar(to, dimension)),
                    ("count".to_owned(), Item::Number(*count as f64)),
                ]),
                SweptValues::Around(change) => {
                    Item::Table(vec![("by".to_owned(), self.change(change, dimension))])
                }
            };
            (it.parameter, values)
        });
        if study.combine != Combine::Grid {
            put("combine", Item::text(word_of(&COMBINE, &study.combine)));
        }
    }

    pub fn tolerance(&self, study: &ToleranceStudy, put: &mut dyn FnMut(&str, Item)) {
        self.over(&study.over, put);
        self.vary(&study.vary, put, |it| {
            let (_, dimension) = self.named_parameter(it.parameter);
            let spread = match &it.spread {
                Spread::Even(change) => self.change(change, dimension),
                Spread::Normal(change) => {
                    Item::Table(vec![("normal".to_owned(), self.change(change, dimension))])
                }
                Spread::Between(both) => {
                    Item::Table(vec![("between".to_owned(), self.listed(both, dimension))])
                }
            };
            (it.parameter, spread)
        });
        if study.clearance.is_some() {
            put("clearance", Item::Flag(true));
        }
        limits("limits", &study.limits, put);
        put("samples", Item::Number(study.samples as f64));
        put("seed", Item::Number(study.seed as f64));
    }

    pub fn optimize(&self, study: &OptimizeStudy, put: &mut dyn FnMut(&str, Item)) {
        self.over(&study.over, put);
        self.vary(&study.vary, put, |it| {
            let (_, dimension) = self.named_parameter(it.parameter);
            let among = match &it.among {
                Among::Between(both) => self.listed(both, dimension),
                Among::Factors(both) => Item::Table(vec![
                    ("between".to_owned(), self.listed(both, dimension)),
                    ("spacing".to_owned(), Item::text(word_of(&SPACING, &true))),
                ]),
                Among::Steps { between, step } => Item::Table(vec![
                    ("between".to_owned(), self.listed(between, dimension)),
                    ("step".to_owned(), self.scalar(step, dimension)),
                ]),
                Among::Only(values) => {
                    Item::Table(vec![("only".to_owned(), self.listed(values, dimension))])
                }
            };
            (it.parameter, among)
        });
        for (key, large) in [("minimize", false), ("maximize", true)] {
            let of = |goal: &&Goal| goal.maximize == large;
            let names = study.goals.iter().filter(of);
            let names: Vec<Item> = names.map(|goal| Item::text(&goal.number.name)).collect();
            if !names.is_empty() {
                put(key, Item::List(names));
            }
        }
        if let Some(fit) = &study.fit {
            put("fit", self.fit(fit));
        }
        limits("subject_to", &study.subject_to, put);
        if let Some(method) = &study.method {
            put("method", Item::text(word_of(&OPTIMIZE_METHODS, method)));
        }
        put("seed", Item::Number(study.seed as f64));
        if let Some(designs) = study.designs {
            put("designs", Item::Number(designs as f64));
        }
    }

    fn fit(&self, fit: &Fit) -> Item {
        let mut entries = Vec::new();
        match &fit.traced {
            Traced::Point(point) => {
                entries.push(("point".to_owned(), Item::text(self.point(*point))));
            }
            Traced::Link { link, at, radius } => {
                entries.push(("link".to_owned(), Item::text(self.link(*link))));
                entries.push(("at".to_owned(), Item::text(self.point(*at))));
                let radius = self.scalar(radius, Dimension::LENGTH);
                entries.push(("radius".to_owned(), radius));
            }
        }
        let places = fit.to.iter().map(|given| {
            let place = given.place.iter();
            let place = place.map(|x| self.scalar(x, Dimension::LENGTH));
            let angle = given.angle.iter();
            let angle = angle.map(|angle| self.scalar(angle, Dimension::ANGLE));
            Item::List(place.chain(angle).collect())
        });
        entries.push(("to".to_owned(), Item::List(places.collect())));
        let word = |index: usize| Item::text(word_of(&TIMINGS, &index));
        let timing = match &fit.timing {
            Timing::Ordered => None,
            Timing::Nearest => Some(word(1)),
            Timing::Even => Some(word(2)),
            Timing::ArcLength => Some(word(3)),
            Timing::At(drive, values) => {
                let known = drive.and_then(|drive| {
                    let dimension = self.model.drives.get(drive.index())?.dimension;
                    Some((self.drive(drive), dimension))
                });
                let (name, dimension) = known.unwrap_or(("time", Dimension::TIME));
                let values = self.listed(values, dimension);
                Some(Item::Table(vec![(name.to_owned(), values)]))
            }
        };
        entries.extend(timing.map(|timing| ("timing".to_owned(), timing)));
        if fit.closed {
            entries.push(("closed".to_owned(), Item::Flag(true)));
        }
        Item::Table(entries)
    }

    fn over(&self, over: &OverStudy, put: &mut dyn FnMut(&str, Item)) {
        put("over", Item::text(&over.name));
        let names = over.asked.columns.iter().map(|c| Item::text(&c.name));
        if !over.asked.columns.is_empty() {
            put("columns", Item::List(names.collect()));
        }
        if !over.asked.plots.is_empty() {
            let plots = over.asked.plots.iter().map(|plot| self.plot(plot));
            put("plot", Item::List(plots.collect()));
        }
    }

    fn vary<T>(
        &self,
        all: &[T],
        put: &mut dyn FnMut(&str, Item),
        one: impl Fn(&T) -> (ParameterId, Item),
    ) {
        let entries = all.iter().map(|it| {
            let (id, item) = one(it);
            (self.named_parameter(id).0.to_owned(), item)
        });
        put("vary", Item::Table(entries.collect()));
    }

    fn change(&self, change: &Change, dimension: Dimension) -> Item {
        match change {
            Change::By(by) => self.scalar(by, dimension),
            Change::Part(part) => self.part(part),
        }
    }

    /// A part of a value is told by its sign.
    fn part(&self, part: &Scalar) -> Item {
        let whole = |part: f64| (part * 100.0).to_string();
        match part {
            Expr::Const(part) if (part * 100.0) * PERCENT == *part => {
                Item::Text(format!("{} %", whole(*part)))
            }
            _ => {
                let part = part.to_node(Dimension::NONE, self);
                Item::Text(format!("({part}) * 100 %"))
            }
        }
    }

    pub fn plot(&self, plot: &Plot) -> Item {
        match plot {
            Plot::Curves(curves) => match curves.as_slice() {
                [one] => Item::text(&one.name),
                many => Item::List(many.iter().map(|c| Item::text(&c.name)).collect()),
            },
            Plot::Path(point) => Item::Text(format!("path({})", self.point(*point))),
            Plot::Hodograph(hodograph) => Item::text(&hodograph.name),
        }
    }
}

fn limits(key: &str, limits: &[Limit], put: &mut dyn FnMut(&str, Item)) {
    if !limits.is_empty() {
        let texts = limits.iter().map(|limit| Item::text(&limit.condition.text));
        put(key, Item::List(texts.collect()));
    }
}
