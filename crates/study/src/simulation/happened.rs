//! The list of what happened in a simulation.

use kempe_simulate::{Ending, Happened, Happening, Simulated};
use kempe_units::Dimension;

use crate::result::Listing;
use crate::words::cut;

use super::told::Told;

/// At most so many things that happened are listed.
const LISTED: usize = 30;

/// What happened, in words.
pub(super) fn happened(told: &Told<'_>, found: &Simulated) -> Option<Listing> {
    let rows = lines(told, found).into_iter().map(|line| {
        let what = match line.count {
            1 => told.in_full(&line.first.what),
            count => format!(
                "{}, {count} times until {}",
                told.what(&line.first.what),
                told.units.text(line.last, Dimension::TIME)
            ),
        };
        vec![told.units.text(line.first.time, Dimension::TIME), what]
    });
    let mut rows = cut(rows.collect(), LISTED);
    rows.extend(went_on(told, found));
    (!rows.is_empty()).then(|| Listing {
        title: "What happened".to_owned(),
        head: vec!["time".to_owned(), "what".to_owned()],
        rows,
    })
}

/// That it ran to its end because nothing that was to end it before came to hold.
fn went_on(told: &Told<'_>, found: &Simulated) -> Option<Vec<String>> {
    if !matches!(found.ending, Ending::Until) {
        return None;
    }
    let all = told.study.end_when.iter().zip(&found.held_throughout);
    let (held, open): (Vec<_>, Vec<_>) = all.partition(|(_, held)| **held);
    let never = match open.as_slice() {
        [] => None,
        [(one, _)] => Some(format!("`{}` never came to hold", one.text)),
        _ if held.is_empty() => Some("no condition of `end_when` came to hold".to_owned()),
        _ => Some("the others never came to hold".to_owned()),
    };
    let held = held.iter().map(|(one, _)| {
        format!(
            "`{}` held from the start, and counts from where it does not",
            one.text
        )
    });
    let what: Vec<String> = held.chain(never).collect();
    if what.is_empty() {
        return None;
    }
    let what = what.join("; ");
    let end = told.units.text(found.end, Dimension::TIME);
    Some(vec![end, format!("it ends: {what}, and this is `until`")])
}

/// Something that happened, perhaps many times.
pub(super) struct Line<'f> {
    pub first: &'f Happening,
    /// When it did last, s.
    pub last: f64,
    pub count: usize,
}

/// All that happened in order; at joints with play, whose contacts have a list of their own, what is alike in one line.
fn lines<'f>(told: &Told<'_>, found: &'f Simulated) -> Vec<Line<'f>> {
    let mut lines: Vec<Line<'f>> = Vec::new();
    let mut of_play: Vec<(String, usize)> = Vec::new();
    for it in &found.happenings {
        let in_play = match it.what {
            // What gives is told contact by contact.
            Happened::Meets { .. } | Happened::Separates { .. } => continue,
            Happened::Strikes { stop, .. }
            | Happened::Rests { stop }
            | Happened::Leaves { stop } => found.place_of(stop).is_some(),
            _ => false,
        };
        if in_play {
            let what = told.what(&it.what);
            if let Some((_, line)) = of_play.iter().find(|(known, _)| *known == what) {
                lines[*line].last = it.time;
                lines[*line].count += 1;
                continue;
            }
            of_play.push((what, lines.len()));
        }
        lines.push(Line {
            first: it,
            last: it.time,
            count: 1,
        });
    }
    lines
}

/// Of the last so many things that happened the one that did most often: when it did first, when last and how often, over the whole
/// time.
pub(super) fn most_frequent<'f>(
    told: &Told<'_>,
    found: &'f Simulated,
    among: usize,
) -> Option<Line<'f>> {
    let all = &found.happenings;
    let mut counts: Vec<(String, usize)> = Vec::new();
    for it in all.iter().rev().take(among) {
        let what = told.what(&it.what);
        match counts.iter_mut().find(|(known, _)| *known == what) {
            Some((_, count)) => *count += 1,
            None => counts.push((what, 1)),
        }
    }
    // Of equals the last counts.
    let (what, _) = counts.into_iter().rev().max_by_key(|(_, count)| *count)?;
    let mut alike = all.iter().filter(|it| told.what(&it.what) == what);
    let first = alike.next()?;
    let (mut last, mut count) = (first.time, 1);
    for it in alike {
        (last, count) = (it.time, count + 1);
    }
    Some(Line { first, last, count })
}
