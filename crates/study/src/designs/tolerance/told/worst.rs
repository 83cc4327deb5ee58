//! What is said of the worst case.

use kempe_model::Diagnostic;
use kempe_number::math;
use kempe_units::Dimension;

use super::number::Told;
use super::teller::Teller;
use crate::designs::tolerance::source::{Kind, Source};
use crate::result::Listing;
use crate::unit::Units;

/// A pin stands off along an axis where it does across that by no more than this part.
const ALONG: f64 = 1e-9;

impl Teller<'_, '_> {
    /// How far numbers go where everything differs for the worst, and by what.
    pub(super) fn worst_cases(&self, told: &[Told<'_>], units: &Units) -> Option<Listing> {
        let rows = told.iter().filter_map(|it| {
            let worst = it.worst?;
            let mut row = vec![it.quantity.name.clone()];
            // What rounding alone makes larger says nothing.
            let stays = worst.values[1] - worst.values[0] <= it.rounding();
            for end in [0, 1] {
                row.push(it.text(worst.values[end]));
                row.push(match it.linear.is_known() {
                    true => it.text(it.linear.worst[end]),
                    false => String::new(),
                });
                row.push(match stays {
                    true => String::new(),
                    false => self.what_differs(&worst.at[end], units),
                });
            }
            Some(row)
        });
        let rows: Vec<Vec<String>> = rows.collect();
        let head = [
            "number", "least", "linear", "with", "greatest", "linear", "with",
        ];
        (!rows.is_empty()).then(|| Listing {
            title: match (self.ready.bench.has_slopes(), &self.worst.refused) {
                (false, _) => "worst case of the corners and pieces that were tried".to_owned(),
                (true, Some(_)) => "worst case, of what moves within the tolerances".to_owned(),
                (true, None) => "worst case, each number for itself".to_owned(),
            },
            head: head.map(str::to_owned).to_vec(),
            rows,
        })
    }

    /// Values of all that differs, in words; what stays as it is in the file is left out.
    fn what_differs(&self, values: &[f64], units: &Units) -> String {
        let (bench, own) = (&self.ready.bench, &self.question.own);
        let one = |(source, name): (&Source, &String)| {
            let k = source.first;
            let by = |k: usize| values[k] - own[k];
            let dimension = bench.model.parameters[bench.varied[k].index()].dimension;
            let text = |si: f64| units.text(si, dimension);
            match source.kind {
                _ if by(k) == 0.0 && source.play().is_none() => None,
                Kind::Parameter(_) => Some(format!("{name} = {}", text(values[k]))),
                Kind::Across(_) if by(k) == 0.0 => None,
                Kind::Across(_) => Some(format!("{name} by {}", text(by(k)))),
                Kind::Round(_) if by(k) == 0.0 && by(k + 1) == 0.0 => None,
                Kind::Round(_) => {
                    let size = math::hypot(by(k), by(k + 1));
                    let part = |x: f64| if x.abs() <= ALONG * size { 0.0 } else { x };
                    let way = math::atan2(part(by(k + 1)), part(by(k)));
                    let way = units.text(way, Dimension::ANGLE);
                    Some(format!("{name} by {} towards {way}", text(size)))
                }
            }
        };
        let all = self.ready.sources.iter().zip(&self.ready.names);
        all.filter_map(one).collect::<Vec<_>>().join(", ")
    }

    /// Numbers that have no bound within the tolerances.
    pub(super) fn without_bound(&self, told: &[Told<'_>], units: &Units) -> Vec<Diagnostic> {
        let ends = told.iter().flat_map(|it| {
            let ends = it
                .worst
                .into_iter()
                .flat_map(|worst| worst.values.into_iter().zip(&worst.at));
            ends.map(|(value, at)| (&it.quantity.name, value, at))
        });
        let endless = ends.filter(|(_, value, _)| value.is_infinite());
        endless
            .map(|(name, value, at)| {
                let way = if value > 0.0 { "grows" } else { "falls" };
                let place = self.what_differs(at, units);
                let message = format!(
                    "`{name}` has no bound within the tolerances: it {way} on and on towards {place}"
                );
                Diagnostic::warning("infinite", message)
                    .at(self.study.over.span.clone(), "")
                    .help("narrow the tolerances, or ask for what is finite there, such as the inverse")
            })
            .collect()
    }

    /// Where all pieces move, and the worst case does not.
    pub(super) fn worst_rests(&self) -> Option<Diagnostic> {
        let why = self.worst.refused.clone()?;
        (self.resting_count() == 0).then(|| {
            let message =
                "all pieces that were drawn move, but not all that lies within the tolerances"
                    .to_owned();
            let told = Diagnostic::warning("pieces-not-moving", message)
                .at(self.study.over.span.clone(), "")
                .note(why);
            told.help("narrow the tolerances, or move the design away from its limit")
        })
    }
}
