//! What happens in time, for the page: marks along the bar of the player, and rows at which places of the drawing light up.

use super::json;
use super::motion_report::{Happening, HappeningKind, MotionReport};
use super::rows::Rows;
use kempe_number::text::significant;

/// So many places along the bar are told apart: more than a screen shows.
const PLACES: f64 = 600.0;

/// The happenings of a motion, each with where it is along the rows that the page carries.
pub(super) struct Along<'m> {
    last: usize,
    all: Vec<(&'m Happening, Vec<[f64; 2]>)>,
}

impl<'m> Along<'m> {
    /// Nothing where there is no clock that runs on from row to row.
    pub fn of(motion: &'m MotionReport, rows: &Rows) -> Along<'m> {
        let clock = motion.columns.first().map_or(&[][..], |c| &c.values);
        let kept = rows.kept.iter().filter_map(|row| clock.get(*row).copied());
        let times: Vec<f64> = kept.collect();
        let runs = times.len() > 1
            && times.iter().all(|t| t.is_finite())
            && times.is_sorted()
            && times.first() < times.last();
        let places = |happening: &'m Happening| {
            let all = happening.times.iter();
            let all = all.filter(|[from, to]| from <= to);
            let places = all.map(|ends| ends.map(|time| place(&times, time)));
            (happening, places.collect())
        };
        let shown = motion.happenings.iter().filter(|_| runs);
        Along {
            last: times.len().saturating_sub(1),
            all: shown.map(places).collect(),
        }
    }

    /// The marks along the bar of the player, of each kind no more than can be told apart, and what they mean.
    pub fn marks(&self) -> (String, String) {
        let (mut marks, mut legend) = (String::new(), String::new());
        for kind in HappeningKind::ALL {
            let of_kind = self.all.iter().filter(|(it, _)| it.kind == kind);
            let mut spans: Vec<[f64; 2]> = of_kind.flat_map(|(_, all)| all).copied().collect();
            if spans.is_empty() {
                continue;
            }
            spans.sort_by(|a, b| a[0].total_cmp(&b[0]));
            let (name, lasts) = (name(kind), kind.lasts());
            let percent = |places: f64| significant(100.0 * places / self.last as f64, 4);
            for [from, to] in joined(spans, self.last as f64 / PLACES) {
                let wide = match lasts {
                    true => format!(";width:{}%", percent(to - from)),
                    false => String::new(),
                };
                let left = percent(from);
                marks.push_str(&format!(
                    "<i class=\"{name}\" style=\"left:{left}%{wide}\"></i>"
                ));
            }
            let meaning = meaning(kind);
            legend.push_str(&format!("<span><i class=\"{name}\"></i> {meaning}</span> "));
        }
        (marks, legend)
    }

    /// Each happening with its rows: from the first to the last one near it, over and over.
    pub fn json(&self) -> String {
        let one = |(it, places): &(&Happening, Vec<[f64; 2]>)| {
            let mut rows: Vec<[usize; 2]> = Vec::new();
            for [first, last] in places.iter().map(|ends| ends.map(|at| at.round() as usize)) {
                match rows.last_mut().filter(|before| first <= before[1] + 1) {
                    Some(before) => before[1] = before[1].max(last),
                    None => rows.push([first, last]),
                }
            }
            let rows = rows.iter().flatten().map(usize::to_string);
            json::object(&[
                ("label", json::string(&it.label)),
                ("kind", json::string(name(it.kind))),
                ("p", it.point.map_or("null".into(), |p| p.to_string())),
                ("rows", json::array(rows)),
            ])
        };
        json::array(self.all.iter().map(one))
    }
}

/// Where a time is among those of the rows: 2.5 half-way from the third to the fourth.
fn place(times: &[f64], time: f64) -> f64 {
    let after = times.partition_point(|t| *t < time);
    let (Some(before), Some(end)) = (after.checked_sub(1), times.get(after)) else {
        return after.min(times.len().saturating_sub(1)) as f64;
    };
    let begin = times[before];
    before as f64 + (time - begin) / (end - begin)
}

/// Spans in order, those joined that are less than `apart` from each other.
fn joined(spans: Vec<[f64; 2]>, apart: f64) -> Vec<[f64; 2]> {
    let mut all: Vec<[f64; 2]> = Vec::new();
    for [from, to] in spans {
        match all.last_mut().filter(|before| from - before[1] < apart) {
            Some(before) => before[1] = before[1].max(to),
            None => all.push([from, to]),
        }
    }
    all
}

/// What a kind is called in the page.
fn name(kind: HappeningKind) -> &'static str {
    match kind {
        HappeningKind::Contact => "contact",
        HappeningKind::Held => "held",
        HappeningKind::Impact => "impact",
        HappeningKind::Event => "event",
    }
}

/// What a mark of a kind means.
fn meaning(kind: HappeningKind) -> &'static str {
    match kind {
        HappeningKind::Contact => "bodies touch",
        HappeningKind::Held => "friction holds",
        HappeningKind::Impact => "impact",
        HappeningKind::Event => "event",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_between_rows_that_are_not_evenly_apart_have_their_place() {
        let times = [0.0, 1.0, 1.0, 3.0];
        assert_eq!(place(&times, 0.25), 0.25);
        assert_eq!(place(&times, 2.0), 2.5);
        assert_eq!(place(&times, -1.0), 0.0);
        assert_eq!(place(&times, 9.0), 3.0);
    }

    #[test]
    fn what_cannot_be_told_apart_is_one_mark() {
        let often: Vec<[f64; 2]> = (0..100_000).map(|k| [f64::from(k) * 0.02; 2]).collect();
        let all = joined(often, 2000.0 / PLACES);
        assert_eq!(all, [[0.0, 1999.98]]);
        assert_eq!(joined(vec![[0.0, 1.0], [5.0, 5.0]], 2.0).len(), 2);
    }

    #[test]
    fn thousands_of_impacts_are_no_more_than_a_page_can_show() {
        let often = Happening {
            label: "touches C".into(),
            kind: HappeningKind::Impact,
            point: Some(3),
            times: Vec::new(),
        };
        let places: Vec<[f64; 2]> = (0..200_000).map(|k| [f64::from(k) * 0.01; 2]).collect();
        // every other row, too
        let apart = (0..1000).map(|k| [f64::from(k) * 2.0; 2]).collect();
        for (places, most) in [(places, 1), (apart, 600)] {
            let along = Along {
                last: 2000,
                all: vec![(&often, places)],
            };
            let (marks, legend) = along.marks();
            let count = marks.matches("<i ").count();
            assert!(count <= most, "{count}");
            assert!(legend.contains("impact") && !legend.contains("friction"));
            assert!(along.json().len() < 12_000, "{}", along.json().len());
        }
    }

    #[test]
    fn what_lasts_is_near_from_its_first_row_to_its_last() {
        let touch = Happening {
            label: "touches C".into(),
            kind: HappeningKind::Contact,
            point: Some(3),
            times: Vec::new(),
        };
        let along = Along {
            last: 10,
            all: vec![(&touch, vec![[1.2, 4.0], [4.6, 5.1], [8.0, 8.0]])],
        };
        let json = along.json();
        assert!(
            json.contains("\"p\":3") && json.ends_with("\"rows\":[1,5,8,8]}]"),
            "{json}"
        );
        let (marks, _) = along.marks();
        assert!(
            marks.starts_with("<i class=\"contact\" style=\"left:12%;width:28%\"></i>"),
            "{marks}"
        );
    }
}
