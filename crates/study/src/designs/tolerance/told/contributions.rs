//! What deviations come from: parameters and joints with play, ranked.

use kempe_number::text::significant;

use super::number::{FEW_DIGITS, NOTHING, Told, percent, with_unit};
use super::teller::Teller;
use crate::designs::tolerance::effects::Effects;
use crate::designs::tolerance::source::Kind;
use crate::result::Listing;
use crate::sensitivities::unit_per;
use crate::unit::Units;

/// Digits of parts that come from pieces.
const SAMPLED_DIGITS: usize = 2;
/// What several do together is told where it is more than this: the rest may be what each does in ways that are not told from nothing.
const TOGETHER: f64 = 0.01;

impl Teller<'_, '_> {
    /// What the deviation of a number comes from: by its derivatives, and where it has none by the pieces.
    pub(super) fn contributions(
        &self,
        number: usize,
        it: &Told<'_>,
        units: &Units,
    ) -> Option<Listing> {
        match it.linear.is_known() {
            true => self.linear_contributions(it, units),
            false => self.sampled_contributions(number, it, units),
        }
    }

    /// What differs, in the words of a heading.
    fn what(&self) -> &'static str {
        match self.ready.sources.len() > self.study.vary.len() {
            true => "what differs",
            false => "parameter",
        }
    }

    /// How far one of the things differs that do.
    fn tolerance(&self, source: usize, units: &Units) -> String {
        let source = &self.ready.sources[source];
        let id = self.ready.bench.varied[source.first];
        let unit = units.unit(self.ready.bench.model.parameters[id.index()].dimension);
        let own = |si: f64| with_unit(unit.from_si(si) - unit.from_si(0.0), &unit);
        match &source.kind {
            Kind::Round(play) => format!("{} all round", own(play.own)),
            Kind::Across(play) => format!("{} to either side", own(play.own)),
            Kind::Parameter(deviation) => match (deviation.normal, deviation.mean() == 0.0) {
                (true, _) => format!("normal {}", own(deviation.deviation())),
                (false, true) => format!("± {}", own(deviation.ends[1])),
                (false, false) => {
                    let [low, high] = deviation.ends.map(own);
                    format!("{low} to {high}")
                }
            },
        }
    }

    /// The names of some of the things that differ.
    fn names_of(&self, which: &[usize]) -> String {
        let names = which.iter().map(|k| self.ready.names[*k].as_str());
        names.collect::<Vec<_>>().join(", ")
    }

    /// By the pieces: what each does by itself, and what several do together.
    fn sampled_contributions(
        &self,
        number: usize,
        it: &Told<'_>,
        units: &Units,
    ) -> Option<Listing> {
        let sampled = it.sampled.as_ref()?;
        if sampled.deviation <= it.rounding() {
            return None;
        }
        let effects = Effects::new(self.question, &self.pieces.numbers[number])?;
        let part = |x: f64| format!("{} %", significant(100.0 * x, SAMPLED_DIGITS));
        let mut ranked: Vec<usize> = (0..effects.parts.len()).collect();
        ranked.sort_by(|a, b| effects.parts[*b].total_cmp(&effects.parts[*a]));
        let (told, nothing): (Vec<usize>, Vec<usize>) =
            ranked.into_iter().partition(|k| effects.parts[*k] > 0.0);
        let row = |k: &usize| {
            vec![
                self.ready.names[*k].clone(),
                self.tolerance(*k, units),
                part(effects.parts[*k]),
            ]
        };
        let mut rows: Vec<Vec<String>> = told.iter().map(row).collect();
        let below = || format!("below {}", part(effects.least));
        if !nothing.is_empty() {
            rows.push(vec![self.names_of(&nothing), String::new(), below()]);
        }
        let together = 1.0 - effects.parts.iter().sum::<f64>();
        if together > TOGETHER.max(effects.least * effects.parts.len() as f64) {
            let all = "several of them together".to_owned();
            rows.push(vec![all, String::new(), part(together)]);
        }
        Some(Listing {
            title: format!("contributions to {}, by the pieces", it.quantity.name),
            head: [self.what(), "tolerance", "part by itself"]
                .map(str::to_owned)
                .to_vec(),
            rows,
        })
    }

    /// By derivatives.
    fn linear_contributions(&self, it: &Told<'_>, units: &Units) -> Option<Listing> {
        if it.linear.deviation <= it.rounding() {
            return None;
        }
        let title = format!("contributions to {}", it.quantity.name);
        let model = self.ready.bench.model;
        let row = |k: usize| {
            let source = &self.ready.sources[k];
            let parameter = &model.parameters[self.ready.bench.varied[source.first].index()];
            let unit = units.unit(parameter.dimension);
            let slope = source.slope(&it.linear.slope);
            let per = (it.unit.from_si(slope) - it.unit.from_si(0.0))
                / (unit.from_si(1.0) - unit.from_si(0.0));
            let per_unit = unit_per(&it.unit, &unit);
            let alone = source.deviation(&it.linear.slope);
            vec![
                self.ready.names[k].clone(),
                self.tolerance(k, units),
                format!("{} {per_unit}", significant(per, FEW_DIGITS))
                    .trim_end()
                    .to_owned(),
                it.difference_text(alone),
                percent(it.linear.parts[k]),
            ]
        };
        if it.linear.deviation <= it.rounding() {
            return Some(Listing {
                title,
                head: Vec::new(),
                rows: vec![vec![
                    "none: to first order it differs by rounding alone".to_owned(),
                ]],
            });
        }
        let ranked = it.linear.ranked();
        let (told, nothing): (Vec<usize>, Vec<usize>) = ranked
            .into_iter()
            .partition(|k| it.linear.parts[*k] >= NOTHING);
        let mut rows: Vec<Vec<String>> = told.into_iter().map(row).collect();
        if !nothing.is_empty() {
            rows.push(vec![
                self.names_of(&nothing),
                String::new(),
                String::new(),
                String::new(),
                format!("below {}", percent(NOTHING)),
            ]);
        }
        let head = [
            self.what(),
            "tolerance",
            "derivative",
            "deviation alone",
            "part",
        ];
        Some(Listing {
            title,
            head: head.map(str::to_owned).to_vec(),
            rows,
        })
    }
}
