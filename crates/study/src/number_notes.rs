//! What is to be told of numbers over a motion: where they are infinite, and how far they are to be trusted.

use kempe_measure::StatisticNote;
use kempe_model::Diagnostic;
use kempe_motion::Motion;
use kempe_units::Dimension;

use crate::events::place;
use crate::unit::{Units, number_text};

/// Warnings of numbers over a motion, of a study where it is one: their names, with what is to be told of them.
pub fn number_notes<'q>(
    study: Option<&str>,
    motion: &Motion,
    numbers: impl Iterator<Item = (&'q str, Vec<StatisticNote>)>,
) -> Vec<Diagnostic> {
    let mut told = Vec::new();
    for (name, notes) in numbers {
        for note in notes {
            let warning = warning(study, name, note, motion);
            if !told.contains(&warning) {
                told.push(warning);
            }
        }
    }
    told
}

fn warning(study: Option<&str>, name: &str, note: StatisticNote, motion: &Motion) -> Diagnostic {
    let number = match study {
        Some(study) => format!("study `{study}`: `{name}`"),
        None => format!("`{name}`"),
    };
    match note {
        StatisticNote::Infinite { time } => Diagnostic::warning(
            "infinite",
            format!(
                "{number} is infinite, or of something that is, at {}",
                at_time(motion, time)
            ),
        )
        .help("keep the motion away from there, or ask for what is finite there, such as the inverse"),
        StatisticNote::Diverges { time } => Diagnostic::warning(
            "diverges",
            format!(
                "{number} has no value: what is averaged runs away too fast at {}",
                at_time(motion, time)
            ),
        )
        .help("the mean over a range that does not hold that place has one"),
        StatisticNote::Unsettled { digits } => Diagnostic::warning(
            "not-settled",
            format!("{number} did not settle: {digits} of its digits hold"),
        )
        .help("what is averaged jumps or oscillates too fast: take the mean over a shorter range, or of something smoother"),
        StatisticNote::PassedAgain { first, again } => {
            let units = Units::of(&motion.mechanism().model);
            let [first, again] = [first, again].map(|time| units.text(time, Dimension::TIME));
            Diagnostic::warning(
                "passed-again",
                format!(
                    "{number} is that of the first time, at {first}: its drive is there again at {again}, where the value is another"
                ),
            )
            .help(format!("ask for the other by its time: `at(…, time, {again})`"))
        }
        StatisticNote::ExtremeAgain { largest, first, again, other } => {
            let (so, most) = match largest {
                true => ("large", "largest"),
                false => ("small", "smallest"),
            };
            let [first, again] = [first, again].map(|time| at_time(motion, time));
            let other = number_text(other);
            Diagnostic::warning(
                "extreme-again",
                format!(
                    "{number} counts from where what it is of is {most} first, at {first}: at {again} it is as {so}, and from there the ratio is {other}"
                ),
            )
            .help("begin the motion between both places where the second is meant")
        }
        StatisticNote::TooFast => Diagnostic::warning(
            "changes-too-fast",
            format!("{number} is of something that changes faster than it was looked at: peaks may be missed"),
        )
        .help("look at a shorter range, where what changes fast is looked at more closely"),
    }
}

/// Where a motion is at a time, s.
fn at_time(motion: &Motion, time: f64) -> String {
    let model = &motion.mechanism().model;
    let parameters = &motion.design.parameters;
    place(motion, motion.path.parameter_at(model, time, parameters))
}
