//! What is to be told of values that were found.

use kempe_model::Diagnostic;
use kempe_number::text::significant;

use super::{Teller, WORSE};
use crate::adjust::fit::Solution;
use crate::words::list;

/// A value that is missed by so many standard deviations is told.
const FAR: f64 = 4.0;
/// The sum of squares may exceed what deviations let expect by so many of its own deviations.
const EXCESS: f64 = 4.0;
/// A value this near to a bound, in parts of it, is on it.
const AT_BOUND: f64 = 1e-9;

impl Teller<'_, '_> {
    pub(super) fn findings(
        &self,
        found: &[Solution],
        best: &Solution,
        (scales, square): (&[f64], f64),
    ) -> Vec<Diagnostic> {
        let span = self.bench.study.span.clone();
        let mut told = Vec::new();
        let data = &self.bench.data;
        let exact = best.is_exact(self.bench);
        let determined = data.values.len() == self.bench.study.unknown.len();
        let better = |it: &&Solution| {
            let much = match determined {
                true => it.is_exact(self.bench) && !exact,
                false => WORSE * it.square() < best.square(),
            };
            much && !self.is(it, best)
        };
        let other = found.iter().find(better);
        match other {
            Some(other) if !self.is_sound(other) => {
                told.push(self.turned(other, Diagnostic::warning));
            }
            Some(other) => {
                let met = match other.is_exact(self.bench) {
                    true => "the rows are met".to_owned(),
                    false => format!("less is missed, {}", self.worst(other)),
                };
                let message = format!(
                    "put together otherwise, {met} with {}",
                    self.values(&other.unknown)
                );
                let warning = Diagnostic::warning("other-assembly", message).at(span.clone(), "");
                told.push(match self.hint(other) {
                    Some(hint) => warning.help(format!("write under [assembly]: {hint}")),
                    None => warning.help("say under [assembly] how it is put together"),
                });
            }
            None => {}
        }
        if !exact && determined && other.is_none() {
            let message = format!("no {} are found that meet every row", list(&self.names()));
            told.push(
                Diagnostic::warning("data-contradictory", message)
                    .at(span.clone(), "")
                    .note(format!("the nearest miss {}", self.worst(best)))
                    .help("look at what was measured: its signs, from where angles count, and which way it is put together"),
            );
        }
        for k in self.on_bounds(best) {
            let message = format!("{} stands on its bound", self.names()[k]);
            told.push(
                Diagnostic::warning("at-bound", message)
                    .at(span.clone(), "")
                    .help("less is missed beyond it: widen the bounds, or look for another parameter too"),
            );
        }
        if data.weighted {
            told.extend(self.unexpected(best, (scales, square)));
        }
        told
    }

    /// Unknowns that their bounds hold.
    pub(in crate::adjust) fn on_bounds(&self, best: &Solution) -> Vec<usize> {
        if best.is_exact(self.bench) {
            return Vec::new();
        }
        let parameters = self.bench.parameters(&best.unknown);
        let bounds = self.bench.study.bounds.iter();
        let held = bounds.filter_map(|(id, ends)| {
            let k = self.bench.study.unknown.iter().position(|of| of == id)?;
            let mut ends = ends.iter().flatten();
            let at = ends.any(|end| {
                let end = kempe_model::value::<f64>(end, &parameters);
                (end - best.unknown[k]).abs() <= AT_BOUND * end.abs()
            });
            at.then_some(k)
        });
        held.collect()
    }

    /// What is missed by more than deviations let expect.
    pub(super) fn unexpected(
        &self,
        best: &Solution,
        (scales, square): (&[f64], f64),
    ) -> Option<Diagnostic> {
        let data = &self.bench.data;
        let freedom = data.values.len() - self.bench.study.unknown.len();
        let expected = freedom as f64;
        if freedom == 0 || square <= expected + EXCESS * (2.0 * expected).sqrt() {
            return None;
        }
        let far = |value: &usize| {
            (best.misses[*value] * data.values[*value].scale / scales[*value]).abs()
        };
        let mut worst: Vec<usize> = (0..data.values.len()).filter(|v| far(v) > FAR).collect();
        worst.sort_by(|a, b| far(b).total_cmp(&far(a)));
        let message = format!(
            "the rows are missed by {} times what their deviations say",
            significant((square / expected).sqrt(), 3)
        );
        let warning = Diagnostic::warning("deviations-exceeded", message);
        let row = worst.first().map_or(0, |value| data.values[*value].row);
        let warning = worst.iter().take(3).fold(warning, |warning, value| {
            let datum = &data.values[*value];
            let name = &self.bench.study.measures[datum.measure].name;
            warning.note(format!(
                "`{name}` in row {} is off by {} deviations",
                datum.row + 1,
                significant(far(value), 3)
            ))
        });
        Some(
            warning
                .at(data.rows[row].span.clone(), "")
                .help("a row may be misread, the deviations may be too small, or another parameter is not what the file says"),
        )
    }
}
