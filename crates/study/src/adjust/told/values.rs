//! The values that were found as numbers and in words.

use kempe_number::text::significant;
use kempe_units::Unit;

use super::{Teller, WORSE};
use crate::adjust::bench::Assembled;
use crate::adjust::certainty::Certainty;
use crate::adjust::fit::Solution;
use crate::result::{Listing, Scalar};
use crate::unit::shown;

/// Other minima that are told.
const OTHERS: usize = 8;

impl Teller<'_, '_> {
    /// The values, how far they are right, and what is missed.
    pub(super) fn scalars(&self, best: &Solution, known: &Certainty, square: f64) -> Vec<Scalar> {
        let mut all = Vec::new();
        let mut tell = |name: String, value: f64, unit: Unit| {
            all.push(Scalar { name, unit, value });
        };
        for (k, id) in self.bench.study.unknown.iter().enumerate() {
            let parameter = &self.bench.model.parameters[id.index()];
            let unit = self.units.unit(parameter.dimension);
            tell(
                parameter.name.clone(),
                shown(best.unknown[k], &unit),
                unit.clone(),
            );
            if let Some((deviations, times)) = &known.deviations {
                let within = unit.from_si(deviations[k] * times) - unit.from_si(0.0);
                tell(format!("{} within", parameter.name), within, unit);
            }
        }
        for (measure, asked) in self.bench.study.measures.iter().enumerate() {
            let values = self.bench.data.values.iter().zip(&best.misses);
            let own = values.filter(|(datum, _)| datum.measure == measure);
            let squares: Vec<f64> = own
                .map(|(d, miss)| (miss * d.scale) * (miss * d.scale))
                .collect();
            if squares.is_empty() {
                continue;
            }
            let rms = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
            let unit = self.units.unit(asked.dimension);
            let value = unit.from_si(rms) - unit.from_si(0.0);
            tell(format!("rms of {}", asked.name), value, unit);
        }
        if self.bench.data.weighted {
            tell("chi_square".to_owned(), square, Unit::one());
        }
        tell("condition".to_owned(), known.condition, Unit::one());
        all
    }

    pub(super) fn listings(
        &self,
        found: &[Solution],
        best: &Solution,
        known: &Certainty,
        square: f64,
    ) -> Vec<Listing> {
        let values = self.bench.data.values.len();
        let unknowns = self.bench.study.unknown.len();
        let mut rows = Vec::new();
        for (k, id) in self.bench.study.unknown.iter().enumerate() {
            let parameter = &self.bench.model.parameters[id.index()];
            let dimension = parameter.dimension;
            let before = self.bench.start()[k];
            let within = match &known.deviations {
                Some((deviations, times)) => self.units.text(deviations[k] * times, dimension),
                None => String::new(),
            };
            // Most of what an error of one typical size does comes from one value.
            let moved = &known.moved[k];
            let most = (0..values).max_by(|a, b| moved[*a].abs().total_cmp(&moved[*b].abs()));
            let most = most.map_or_else(String::new, |value| self.moves(k, value, moved[value]));
            rows.push(vec![
                parameter.name.clone(),
                self.units.text(before, dimension),
                self.units.text(best.unknown[k], dimension),
                within,
                most,
            ]);
        }
        let head = [
            "parameter",
            "in the file",
            "adjusted",
            "within (95 %)",
            "most moved by",
        ];
        let fit = match (values - unknowns, best.is_exact(self.bench)) {
            (0, true) => "as many values as unknowns, all met".to_owned(),
            (0, false) => format!("as many values as unknowns, not met: {}", self.worst(best)),
            (_, true) => format!("{values} values for {unknowns} unknowns, all met"),
            (_, false) => format!(
                "{values} values for {unknowns} unknowns, missed at most {}",
                self.worst(best)
            ),
        };
        let mut listings = vec![Listing {
            title: format!("adjusted: {fit}"),
            head: head.map(str::to_owned).to_vec(),
            rows,
        }];
        let others: Vec<Vec<String>> = found
            .iter()
            .filter(|it| !std::ptr::eq(*it, best) && !self.is(it, best))
            .filter(|it| {
                it.square() <= WORSE * square || it.is_exact(self.bench) || values == unknowns
            })
            .filter(|it| values > unknowns || it.is_exact(self.bench))
            .take(OTHERS)
            .map(|it| {
                let how = match (&it.assembled, self.hint(it)) {
                    (Assembled::AsMeant, _) => String::new(),
                    (_, Some(hint)) => format!("with {hint} under [assembly]"),
                    (_, None) => "put together otherwise".to_owned(),
                };
                let parameters = self.bench.parameters(&it.unknown);
                let sound = self.bench.model.unsound(&parameters);
                let how = sound.first().map_or(how, |wrong| wrong.message.clone());
                vec![self.values(&it.unknown), how]
            })
            .collect();
        if !others.is_empty() {
            listings.push(Listing {
                title: "other values that do as well".to_owned(),
                head: vec!["values".to_owned(), "how".to_owned()],
                rows: others,
            });
        }
        listings
    }

    /// Whether two are one answer.
    pub(super) fn is(&self, a: &Solution, b: &Solution) -> bool {
        let sizes = self.bench.sizes(&b.unknown);
        let pairs = a.unknown.iter().zip(&b.unknown).zip(&sizes);
        let mut near = pairs.map(|((x, y), size)| (x - y).abs() <= 1e-4 * size);
        near.all(|near| near) && a.meant == b.meant
    }

    /// `-0.37 mm for 0.1 deg of box in row 2`
    pub(super) fn moves(&self, unknown: usize, value: usize, moved: f64) -> String {
        let datum = &self.bench.data.values[value];
        let unit = self.units.unit(datum.dimension);
        // A tenth of the unit that is read.
        let step = unit.to_si(0.1) - unit.to_si(0.0);
        let by = moved / datum.scale * step;
        let own = self.units.unit(self.dimension(unknown));
        let by = own.from_si(by) - own.from_si(0.0);
        let name = &self.bench.study.measures[datum.measure].name;
        format!(
            "{} {} by 0.1 {} of {name} in row {}",
            significant(by, 3),
            own.text(),
            unit.text(),
            datum.row + 1
        )
    }
}
