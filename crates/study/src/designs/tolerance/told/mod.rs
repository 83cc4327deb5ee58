//! What is said of pieces.

mod contributions;
mod number;
mod teller;
mod worst;

use kempe_model::Diagnostic;
use kempe_number::text::significant;
use kempe_units::Unit;

use super::ready::Limited;
use super::rounding::scale_of;
use super::sampled::{CHECKED, KEPT, KEPT_FOLLOWED};
use super::summary::{Counts, PARTS, Summary, Yield, quantile};
use crate::designs::over::valueless;
use crate::result::{Figure, Listing, Scalar, StudyResult};
use crate::table::Column;
use crate::unit::{SHORT_DIGITS, Units};
use number::{FEW_DIGITS, Told, percent, rounding, with_unit};
pub(super) use teller::Teller;

/// The linear and the sampled answer part where they differ by more than this part of the linear deviation ...
const PARTED: f64 = 0.05;
/// ... and by more than so many times what the number of pieces leaves open.
const SURE: f64 = 3.0;

impl Teller<'_, '_> {
    /// Says all that was found beside the motion of the file's own design.
    pub fn tell(&self, result: &mut StudyResult) {
        let units = Units::of(self.ready.bench.model);
        let numbers = self.ready.bench.numbers.iter().zip(&self.ready.linear);
        let numbers = numbers.zip(&self.pieces.numbers).zip(&self.worst.numbers);
        let told: Vec<Told<'_>> = numbers
            .map(|(((quantity, linear), values), worst)| Told {
                unit: quantity.unit(&units),
                quantity,
                linear,
                sampled: Summary::new(values),
                worst: worst.as_ref(),
                scale: scale_of(quantity.dimension, self.size),
            })
            .collect();
        result.scalars = self.scalars(&told);
        result.listings = self.listings(&told, &units);
        self.add_bands(result, &units);
        let histograms = told.iter().enumerate();
        let histograms = histograms.filter_map(|(k, it)| self.histogram(k, it));
        result.figures.extend(histograms);
        result.diagnostics.extend(self.resting());
        result.diagnostics.extend(self.worst_rests());
        result.diagnostics.extend(self.without_bound(&told, &units));
        result.diagnostics.extend(self.valueless());
        // Its rows are whole, and what they tell is not.
        result.stopped_at = self.stopped_at();
    }

    /// Of each number that is told, how many pieces that move have none.
    fn missing(&self) -> Vec<usize> {
        let without = |values: &Vec<f64>| {
            let pieces = values.iter().zip(&self.pieces.moves);
            pieces
                .filter(|(x, moves)| **moves && !x.is_finite())
                .count()
        };
        let numbers = self.pieces.numbers.iter().take(self.ready.shown);
        numbers.map(without).collect()
    }

    fn valueless(&self) -> Vec<Diagnostic> {
        let numbers = self.ready.bench.numbers.iter().zip(self.missing());
        let of = format!(
            "{} pieces; what is told of it is of the others",
            self.pieces.count
        );
        numbers
            .filter(|(_, missing)| *missing > 0)
            .map(|(number, missing)| valueless(&number.name, (missing, &of), &self.study.over))
            .collect()
    }

    fn good(&self, limit: &Limited) -> usize {
        self.pieces.numbers[limit.kept]
            .iter()
            .filter(|x| limit.keeps(**x))
            .count()
    }

    /// Pieces that keep all limits, or without limits move.
    fn all_good(&self) -> usize {
        let pieces = 0..self.pieces.count;
        let good = |piece: &usize| {
            let mut limits = self.ready.limits.iter();
            self.pieces.moves[*piece]
                && limits.all(|limit| limit.keeps(self.pieces.numbers[limit.kept][*piece]))
        };
        pieces.filter(good).count()
    }

    fn scalars(&self, told: &[Told<'_>]) -> Vec<Scalar> {
        let mut all = Vec::new();
        let mut tell = |name: String, value: f64, unit: &Unit| {
            // What has no value is told in words.
            if !value.is_nan() {
                let unit = unit.clone();
                all.push(Scalar { name, unit, value });
            }
        };
        let one = Unit::one();
        let percent = Unit::parse("%").unwrap_or_else(|_| Unit::one());
        let count = self.pieces.count;
        tell("pieces".to_owned(), count as f64, &one);
        let resting = self.resting_count();
        if resting > 0 {
            tell("pieces that do not move".to_owned(), resting as f64, &one);
        }
        if !self.study.limits.is_empty() || resting > 0 {
            let all = Yield::new(self.all_good(), count);
            tell("yield".to_owned(), percent.from_si(all.part), &percent);
            let [low, high] = all.within;
            tell("yield at least".to_owned(), percent.from_si(low), &percent);
            tell("yield at most".to_owned(), percent.from_si(high), &percent);
        }
        for (limit, own) in self.study.limits.iter().zip(&self.ready.limits) {
            let part = Yield::new(self.good(own), count).part;
            let name = format!("yield of {}", limit.condition.text);
            tell(name, percent.from_si(part), &percent);
        }
        for (it, missing) in told.iter().zip(self.missing()) {
            let name = &it.quantity.name;
            let more = |what: &str| format!("{name}, {what}");
            tell(name.clone(), it.value(it.linear.own), &it.unit);
            if missing > 0 {
                tell(more("pieces without a value"), missing as f64, &one);
            }
            if let Some(sampled) = &it.sampled {
                tell(more("mean"), it.value(sampled.mean), &it.unit);
                tell(
                    more("deviation"),
                    it.difference(sampled.deviation),
                    &it.unit,
                );
                tell(more("least"), it.value(sampled.least), &it.unit);
                tell(more("greatest"), it.value(sampled.greatest), &it.unit);
            }
            if it.linear.is_known() {
                tell(more("linear mean"), it.value(it.linear.mean), &it.unit);
                let deviation = it.difference(it.linear.deviation);
                tell(more("linear deviation"), deviation, &it.unit);
                let [low, high] = it.linear.worst;
                tell(more("linear worst case least"), it.value(low), &it.unit);
                tell(more("linear worst case greatest"), it.value(high), &it.unit);
            }
            if let Some([low, high]) = it.worst.map(|worst| worst.values) {
                tell(more("worst case least"), it.value(low), &it.unit);
                tell(more("worst case greatest"), it.value(high), &it.unit);
            }
        }
        if let Some(missed) = self.worst_missed() {
            tell(
                "lanes differ by".to_owned(),
                percent.from_si(missed),
                &percent,
            );
        }
        all
    }

    /// By how much lanes miss pieces that were moved by themselves, in parts of a number's deviation; none where they tell nothing.
    fn worst_missed(&self) -> Option<f64> {
        let numbers = self.ready.bench.numbers.iter().zip(&self.ready.linear);
        let numbers = numbers.zip(&self.pieces.numbers).zip(self.missed);
        let parts = numbers.filter_map(|(((quantity, linear), values), missed)| {
            let missed = (*missed)?;
            let sampled = Summary::new(values)?;
            let scale = scale_of(quantity.dimension, self.size);
            // What does not vary but for rounding is missed by rounding.
            let least = rounding(linear, Some(&sampled), scale);
            Some(if missed == 0.0 || sampled.deviation <= least {
                0.0
            } else {
                missed / sampled.deviation
            })
        });
        parts.filter(|x| x.is_finite()).reduce(f64::max)
    }

    fn listings(&self, told: &[Told<'_>], units: &Units) -> Vec<Listing> {
        let mut all = Vec::new();
        all.push(self.how());
        all.extend(self.limits(units));
        all.push(sampled(told, self.pieces.count));
        all.push(linear(told, !self.ready.bench.has_slopes()));
        all.extend(self.worst_cases(told, units));
        all.extend(self.parted(told));
        let numbered = told.iter().enumerate();
        all.extend(numbered.filter_map(|(k, it)| self.contributions(k, it, units)));
        all
    }

    /// How pieces were found.
    fn how(&self) -> Listing {
        let mut rows = Vec::new();
        let mut line = |text: String| rows.push(vec![text]);
        let names = |which: &[usize]| {
            let names = which.iter().map(|k| &*self.ready.bench.numbers[*k].name);
            names.collect::<Vec<_>>().join(", ")
        };
        let followed = self.question.followed_numbers();
        if let Some(lanes) = &self.question.lanes {
            let told: Vec<usize> = (0..self.ready.bench.numbers.len())
                .filter(|k| !followed.contains(k))
                .collect();
            if !told.is_empty() {
                line(format!(
                    "in lanes on the branch of the file's own design, at {} places of the motion: {}",
                    lanes.places(),
                    names(&told)
                ));
                let shown = told.iter().filter(|k| **k < self.ready.shown);
                let miss = shown.filter_map(|k| {
                    let quantity = &self.ready.bench.numbers[*k];
                    let unit = quantity.unit(&Units::of(self.ready.bench.model));
                    let miss = unit.from_si(self.missed[*k]?) - unit.from_si(0.0);
                    let miss = format!("{} {}", significant(miss, 2), unit.text());
                    Some(format!("{} by {}", quantity.name, miss.trim_end()))
                });
                let miss: Vec<String> = miss.collect();
                let checked = CHECKED.min(self.question.samples);
                line(format!(
                    "of {checked} pieces that were moved by themselves they miss at most: {}",
                    miss.join(", ")
                ));
            }
        }
        if !followed.is_empty() {
            line(format!("each piece moved by itself: {}", names(&followed)));
        }
        if self.ready.sources.len() > self.study.vary.len() {
            line("joints with play stay pressed to one side all along a piece's motion: what changing sides adds is not counted".to_owned());
        }
        let resting = self.resting_count();
        if let Some(first) = self.pieces.moves.iter().position(|moves| !moves) {
            line(format!(
                "{resting} do not move as asked, the first of them number {}: {}",
                first + 1,
                self.question.why(first)
            ));
        }
        Listing {
            title: match self.stopped_at() {
                Some(at) => format!("stopped at {at}"),
                None => format!("{} pieces", self.pieces.count),
            },
            head: Vec::new(),
            rows,
        }
    }

    fn limits(&self, units: &Units) -> Option<Listing> {
        if self.study.limits.is_empty() {
            return None;
        }
        let row = |name: String, own: String, good: usize| {
            let all = Yield::new(good, self.pieces.count);
            let [low, high] = all.within.map(percent);
            vec![name, own, percent(all.part), low, high]
        };
        let limits = self.study.limits.iter().zip(&self.ready.limits);
        let mut rows: Vec<Vec<String>> = limits
            .map(|(limit, own)| {
                let unit = units.of_measure(&limit.condition.above, limit.condition.dimension);
                let margin = self.ready.linear[own.kept].own;
                let margin = with_unit(unit.from_si(margin) - unit.from_si(0.0), &unit);
                row(limit.condition.text.clone(), margin, self.good(own))
            })
            .collect();
        if rows.len() > 1 || self.resting_count() > 0 {
            rows.push(row("all".to_owned(), String::new(), self.all_good()));
        }
        let head = [
            "limit",
            "the file's own keeps it by",
            "good",
            "at least (95 %)",
            "at most (95 %)",
        ];
        Some(Listing {
            title: "yield".to_owned(),
            head: head.map(str::to_owned).to_vec(),
            rows,
        })
    }

    /// Where the linear and the sampled answer are not the same.
    fn parted(&self, told: &[Told<'_>]) -> Option<Listing> {
        let rows: Vec<Vec<String>> = told
            .iter()
            .filter_map(|it| Some(vec![it.quantity.name.clone(), parted(it)?]))
            .collect();
        (!rows.is_empty()).then(|| Listing {
            title: "where linear and sampled part".to_owned(),
            head: ["number", "the sampled"].map(str::to_owned).to_vec(),
            rows,
        })
    }

    /// The band of every curve behind the curve of the file's own design.
    fn add_bands(&self, result: &mut StudyResult, units: &Units) {
        result.figures.clear();
        let followed = result.table.rows();
        for (quantity, band) in self.question.curves.iter().zip(&self.pieces.bands) {
            let unit = quantity.unit(units);
            let column = |what: &str, values: Vec<f64>| Column {
                values: values.iter().map(|x| unit.from_si(*x)).collect(),
                ..Column::new(format!("{}, {what}", quantity.name), unit.clone())
            };
            let rows = |of: &dyn Fn(usize) -> f64| -> Vec<f64> {
                let finite = |x: f64| if x.is_finite() { x } else { f64::NAN };
                (0..followed).map(|row| finite(of(row))).collect()
            };
            let at = |values: &[f64], row: usize| values.get(row).copied().unwrap_or(f64::NAN);
            let mut kept = band.kept.clone();
            let [few, most] = [0.05, 0.95].map(|part| -> Vec<f64> {
                let rows = kept.iter_mut();
                rows.map(|own| quantile(own, part)).collect()
            });
            let columns = [
                column("least", rows(&|row| at(&band.least, row))),
                column("5 %", rows(&|row| at(&few, row))),
                column("95 %", rows(&|row| at(&most, row))),
                column("greatest", rows(&|row| at(&band.greatest, row))),
            ];
            let own = result.table.column(&quantity.name);
            let own = own.map_or(&[][..], |own| &own.values);
            // A band is thin beside the curve itself.
            let deviation = |column: &Column| Column {
                name: format!("deviation of {}", column.name),
                values: (column.values.iter().zip(own))
                    .map(|(x, own)| x - own)
                    .collect(),
                ..column.clone()
            };
            result.figures.push(Figure::Curves {
                curves: columns.iter().map(deviation).collect(),
                limits: Vec::new(),
            });
            result.table.columns.extend(columns);
        }
        let mut told = |title: String| {
            result.listings.push(Listing {
                title,
                head: Vec::new(),
                rows: Vec::new(),
            });
        };
        let alone = self.question.curves_alone();
        if alone.len() < self.question.curves.len() && KEPT < self.pieces.count {
            told(format!(
                "the parts of 5 % and 95 % along the motion are those of the first {KEPT} pieces"
            ));
        }
        if !alone.is_empty() && KEPT_FOLLOWED < self.pieces.count {
            let names = alone.iter().map(|k| self.question.curves[*k].name.clone());
            let names = names.collect::<Vec<_>>().join(", ");
            told(format!(
                "the band of {names} along the motion is that of the first {KEPT_FOLLOWED} pieces"
            ));
        }
    }

    fn histogram(&self, number: usize, it: &Told<'_>) -> Option<Figure> {
        let sampled = it.sampled.as_ref()?;
        let counts = Counts::new(&self.pieces.numbers[number], sampled)?;
        let limits = self.study.limits.iter().zip(&self.ready.limits);
        let limits = limits.filter(|(_, own)| own.limited == number);
        let limits = limits.map(|(limit, own)| {
            let kept = self.ready.linear[own.kept].own;
            let side = if limit.at_least { -kept } else { kept };
            (limit.condition.text.clone(), it.value(it.linear.own + side))
        });
        Some(Figure::Histogram {
            number: it.quantity.name.clone(),
            unit: it.unit.clone(),
            edges: counts.edges.iter().map(|x| it.value(*x)).collect(),
            counts: counts.counts,
            limits: limits.collect(),
        })
    }

    /// Pieces that do not move as asked.
    fn resting(&self) -> Option<Diagnostic> {
        let resting = self.resting_count();
        let first = self.pieces.moves.iter().position(|moves| !moves)?;
        let part = resting as f64 / self.pieces.count as f64;
        let message = format!(
            "{resting} of {} pieces do not move as asked, {}",
            self.pieces.count,
            percent(part)
        );
        let told = Diagnostic::warning("pieces-not-moving", message)
            .at(self.study.over.span.clone(), "")
            .note(format!("piece {}: {}", first + 1, self.question.why(first)));
        Some(told.help("narrow the tolerances, or move the design away from its limit"))
    }
}

fn sampled(told: &[Told<'_>], count: usize) -> Listing {
    let parts = PARTS.map(|part| format!("{} %", significant(100.0 * part, SHORT_DIGITS)));
    let mut head = vec![
        "number".to_owned(),
        "mean".to_owned(),
        "deviation".to_owned(),
    ];
    head.push("least".to_owned());
    head.extend(parts);
    head.push("greatest".to_owned());
    let row = |it: &Told<'_>| {
        let mut row = vec![it.quantity.name.clone()];
        match &it.sampled {
            None => row.push("no piece has a value".to_owned()),
            Some(sampled) => {
                row.push(it.text(sampled.mean));
                row.push(it.difference_text(sampled.deviation));
                row.push(it.text(sampled.least));
                let parts = sampled.quantiles.iter();
                row.extend(parts.map(|x| x.map_or_else(String::new, |x| it.text(x))));
                row.push(it.text(sampled.greatest));
            }
        }
        row
    };
    Listing {
        title: format!("sampled, {count} pieces"),
        head,
        rows: told.iter().map(row).collect(),
    }
}

fn linear(told: &[Told<'_>], differences: bool) -> Listing {
    let head = [
        "number",
        "the file's own",
        "mean",
        "deviation",
        "worst case from",
        "to",
    ];
    let row = |it: &Told<'_>| {
        let mut row = vec![it.quantity.name.clone(), it.text(it.linear.own)];
        if it.linear.is_known() {
            row.push(it.text(it.linear.mean));
            row.push(it.difference_text(it.linear.deviation));
            row.extend(it.linear.worst.map(|x| it.text(x)));
        } else {
            row.push("has no derivatives here".to_owned());
        }
        row
    };
    let by = match differences {
        true => "differences over a deviation",
        false => "exact derivatives",
    };
    Listing {
        title: format!("linear, by {by}"),
        head: head.map(str::to_owned).to_vec(),
        rows: told.iter().map(row).collect(),
    }
}

/// How the sampled answer differs from the linear one, in words, where it does.
fn parted(it: &Told<'_>) -> Option<String> {
    let sampled = it.sampled.as_ref()?;
    if !it.linear.is_known() {
        return Some("is the only one".to_owned());
    }
    let n = sampled.count as f64;
    let size = it.linear.deviation.max(sampled.deviation);
    // Of no piece is a number known better.
    let least = it.rounding();
    let shift = sampled.mean - it.linear.mean;
    let mut words = Vec::new();
    if shift.abs() > least && shift.abs() > (SURE * size / n.sqrt()).max(PARTED * size) {
        let way = if shift > 0.0 { "above" } else { "below" };
        words.push(format!(
            "mean lies {} {way}",
            it.difference_text(shift.abs())
        ));
    }
    let more = sampled.deviation - it.linear.deviation;
    let open = SURE / (2.0 * (n - 1.0).max(1.0)).sqrt();
    if more.abs() > least && more.abs() > size * open.max(PARTED) {
        let times = match it.linear.deviation > it.rounding() {
            true => format!(
                "{} times the linear one",
                significant(sampled.deviation / it.linear.deviation, FEW_DIGITS)
            ),
            false => "where the linear one is 0".to_owned(),
        };
        words.push(format!(
            "deviation is {}, {times}",
            it.difference_text(sampled.deviation)
        ));
    }
    (!words.is_empty()).then(|| words.join("; "))
}
