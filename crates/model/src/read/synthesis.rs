//! Studies that ask for linkages.
//!
//! ```toml
//! [studies.generator]
//! kind   = "synthesize"
//! task   = "function"                       # or "rates", "dead-centres", "motion", "path", "dwell", "cognates"
//! pairs  = [[45, 52], [90, 82], [135, 112]]
//! ground = "50 mm"
//! accept = ["min(transmission_angle) >= 35 deg", "max(link_ratio) <= 5"]
//! rank   = "max(link_ratio)"
//! ```

use kempe_units::{Dimension, Expr};

use crate::diagnostic::Diagnostic;
use crate::ids::Scalar;
use crate::key_table::synthesis::{CURVE, FREE, LINKAGES, OF_THE_FILE, TASKS};
use crate::keys::Kind;
use crate::motion_study::{MotionStudy, Rows};
use crate::node::{Key, Node, Value};
use crate::read::context::Context;
use crate::read::entry::{Entry, entries};
use crate::read::{cognates, dwell, guidance, path};
use crate::study::StudyKind;
use crate::synthesis::{
    Asked, DeadCentresTask, FunctionTask, LinkageKind, RatesTask, Stroke, SynthesisTask,
    SynthesizeStudy, WantedCurve, WantedFunction, WantedPair,
};

/// The word behind `kind`.
pub(crate) const KIND: &str = "synthesize";

/// So many linkages are kept where the file does not say.
const KEPT: usize = 20;
/// Rows of the motion that measures are taken over and pictures made of.
const ROWS: usize = 181;

/// Whether all that is asked for are linkages, and none that belongs to a mechanism of the file's own: such a file needs none.
pub(crate) fn alone(studies: &[&(Key, Node)]) -> bool {
    let says = |node: &Node, key: &str, word: &str| match &node.value {
        Value::Table(table) => match table.get(key).map(|node| &node.value) {
            Some(Value::Text(text)) => text.content.trim() == word,
            _ => false,
        },
        _ => false,
    };
    let asked = |(_, node): &&(Key, Node)| says(node, "kind", KIND);
    let own = |(_, node): &&(Key, Node)| {
        (OF_THE_FILE.iter()).any(|kind| says(node, "task", task_of(kind)))
    };
    studies.iter().any(asked) && !studies.iter().any(own)
}

/// The task of a kind of table: `function` of `synthesize function`.
fn task_of(kind: &Kind) -> &'static str {
    kind.name.split_once(' ').map_or("", |(_, task)| task)
}

pub(crate) fn read(cx: &mut Context<'_>, entry: &(Key, Node)) -> Option<StudyKind> {
    let (key, node) = entry;
    let table = cx.table(node, "", TASKS[0].example)?;
    let place = format!("study `{}`", key.name);
    let words = TASKS.map(|kind| (task_of(kind), kind));
    let any = Entry::of(table, &key.span, place, TASKS[0]);
    any.required_like(cx, "task", any.example_of("task"))?;
    let kind = any.choice(cx, "task", &words)??;
    let mut entry = Entry::new(cx, entry, kind)?;
    let task = match task_of(kind) {
        "rates" => rates(cx, &entry).map(SynthesisTask::Rates),
        "dead-centres" => dead_centres(cx, &entry).map(SynthesisTask::DeadCentres),
        "path" => path::read(cx, &entry).map(|task| SynthesisTask::Path(Box::new(task))),
        "motion" => guidance::read(cx, &entry).map(|task| SynthesisTask::Motion(Box::new(task))),
        "dwell" => dwell::read(cx, &mut entry).map(|task| SynthesisTask::Dwell(Box::new(task))),
        "cognates" => cognates::read(cx, &entry).map(SynthesisTask::Cognates),
        _ => function(cx, &entry).map(SynthesisTask::Function),
    };
    let accept = texts(cx, &entry, "accept");
    let rank = texts(cx, &entry, "rank").into_iter().next();
    let columns = texts(cx, &entry, "columns");
    let keep = count(cx, &entry, "keep", KEPT);
    Some(StudyKind::Synthesize(Box::new(SynthesizeStudy {
        along: MotionStudy {
            rows: Rows::Count(ROWS),
            columns: Vec::new(),
            plots: Vec::new(),
            circuit: false,
        },
        task: task?,
        accept,
        rank,
        columns,
        keep: keep?,
        span: key.span.clone(),
    })))
}

/// Measures and conditions of the linkages that will be found, as written.
fn texts(cx: &mut Context<'_>, entry: &Entry<'_>, key: &str) -> Vec<Asked> {
    let place = entry.place_of(key);
    let mut found = Vec::new();
    for node in entries(cx, entry, key) {
        if let Some(text) = cx.text(node, &place, entry.example_of(key)) {
            let trimmed = text.content.trim();
            let before = text.content.len() - text.content.trim_start().len();
            found.push(Asked {
                text: trimmed.to_owned(),
                span: text.span(before..before + trimmed.len()),
            });
        }
    }
    found
}

/// A whole number as the table of keys bounds it.
pub(crate) fn count(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    key: &str,
    default: usize,
) -> Option<usize> {
    let Some(node) = entry.get(key) else {
        return Some(default);
    };
    let most = match entry.kind.key(key).map(|row| row.takes) {
        Some(crate::keys::Takes::Count(most)) => most,
        _ => usize::MAX,
    };
    match node.value {
        Value::Number(n) if n == n.trunc() && n >= 1.0 && n <= most as f64 => Some(n as usize),
        _ => cx.refuse(
            "bad-size",
            format!(
                "{} is no whole number from 1 to {most}",
                entry.place_of(key)
            ),
            &node.span,
            format!("write {key} = {}", entry.example_of(key)),
        ),
    }
}

/// The distance of the fixed pivots; one in the file's unit where it is not given.
fn ground(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<Scalar> {
    let one = cx.bare_unit(Dimension::LENGTH).to_si(1.0);
    entry.value_or(cx, "ground", one)
}

fn function(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<FunctionTask> {
    let linkage = entry.choice(cx, "linkage", &LINKAGES)?;
    let linkage = linkage.unwrap_or(LinkageKind::FourBar);
    let slides = linkage == LinkageKind::SliderCrank;
    let of_output = match slides {
        true => Dimension::LENGTH,
        false => Dimension::ANGLE,
    };
    let zeros = zeros(cx, entry, of_output);
    let ground = match slides {
        true => {
            if let Some((key, _)) = entry.entry("ground") {
                cx.push(
                    Diagnostic::warning("idle-key", "`ground` means nothing here")
                        .at(key.span.clone(), "a slider-crank has one fixed pivot")
                        .help("leave it out: the slider's places say how large it is"),
                );
            }
            Some(None)
        }
        false => ground(cx, entry).map(Some),
    };
    let wanted = match (entry.get("pairs"), entry.entry("function")) {
        (Some(_), Some((key, _))) => {
            let message = format!("{} has both `pairs` and `function`", entry.place);
            cx.refuse(
                "over-specified",
                message,
                &key.span,
                "leave one of them out",
            )
        }
        (Some(node), None) => pairs(cx, entry, node, of_output).map(WantedFunction::Pairs),
        (None, Some((key, node))) => {
            let free = zeros
                .as_ref()
                .map_or(0, |z| z.iter().filter(|z| z.is_none()).count());
            let exact = match linkage {
                LinkageKind::InvertedSliderCrank => 2,
                _ => 3,
            };
            curve(cx, key, node, of_output, exact + free)
                .map(|c| WantedFunction::Curve(Box::new(c)))
        }
        (None, None) => {
            entry.required(cx, "pairs");
            None
        }
    };
    Some(FunctionTask {
        linkage,
        wanted: wanted?,
        zeros: zeros?,
        ground: ground?,
    })
}

/// Where links stand as their dials say zero.
fn zeros(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    of_output: Dimension,
) -> Option<[Option<Scalar>; 2]> {
    let Some(node) = entry.get("zeros") else {
        return Some([Some(Expr::Const(0.0)), Some(Expr::Const(0.0))]);
    };
    let (input, output) = entry.two(cx, node, "zeros")?;
    let mut zero = |node: &Node, dimension| match &node.value {
        Value::Text(text) if text.content.trim() == FREE => Some(None),
        _ => cx.scalar(node, dimension).map(Some),
    };
    let (input, output) = (zero(input, Dimension::ANGLE), zero(output, of_output));
    Some([input?, output?])
}

fn pairs(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    node: &Node,
    of_output: Dimension,
) -> Option<Vec<WantedPair>> {
    let place = entry.place_of("pairs");
    let example = entry.example_of("pairs");
    let ratio = of_output / Dimension::ANGLE;
    let dimensions = [Dimension::ANGLE, of_output, ratio, ratio / Dimension::ANGLE];
    let mut found = Vec::new();
    let mut whole = true;
    for pair in cx.array(node, &place, example)? {
        let items = cx.array(pair, "a pair", "[45, 52]")?;
        if !(2..=4).contains(&items.len()) {
            let message = format!("a pair of {place} has {} values", items.len());
            let help = "write [input, output], and behind them, where they are wanted, the output's change for the input's and the change of that";
            return cx.refuse("wrong-type", message, &pair.span, help);
        }
        let values: Vec<Option<Scalar>> = items
            .iter()
            .zip(dimensions)
            .map(|(item, dimension)| cx.scalar(item, dimension))
            .collect();
        whole &= values.iter().all(Option::is_some);
        let mut values = values.into_iter().flatten();
        if let (Some(input), Some(output)) = (values.next(), values.next()) {
            found.push(WantedPair {
                input,
                output,
                ratio: values.next(),
                ratio_rate: values.next(),
                span: pair.span.clone(),
            });
        }
    }
    if found.is_empty() && whole {
        return cx.refuse(
            "missing-key",
            format!("{place} names no pair"),
            &node.span,
            format!("write pairs = {example}"),
        );
    }
    whole.then_some(found)
}

fn curve(
    cx: &mut Context<'_>,
    key: &Key,
    node: &Node,
    of_output: Dimension,
    points: usize,
) -> Option<WantedCurve> {
    let entry = Entry::inner(cx, node, &key.span, "`function`".to_owned(), &CURVE)?;
    let two = |cx: &mut Context<'_>, key: &str, dimension| {
        let node = entry.required(cx, key)?;
        let (a, b) = entry.two(cx, node, key)?;
        let (a, b) = (cx.scalar(a, dimension), cx.scalar(b, dimension));
        Some([a?, b?])
    };
    let x = two(cx, "x", Dimension::NONE);
    let input = two(cx, "input", Dimension::ANGLE);
    let output = two(cx, "output", of_output);
    let points = count(cx, &entry, "points", points);
    let node = entry.required(cx, "y")?;
    let y = cx.formula_of(node, "x")?;
    let (text, y) = y;
    let (x, input, output) = (x?, input?, output?);
    for (what, ends) in [("x", &x), ("input", &input), ("output", &output)] {
        if cx.number(&ends[0]) == cx.number(&ends[1]) {
            let message = format!("both ends of `{what}` of `function` are the same");
            let at = entry.get(what).map_or(key.span.clone(), |n| n.span.clone());
            return cx.refuse("bad-size", message, &at, "a dial has a range");
        }
    }
    Some(WantedCurve {
        text,
        y,
        x,
        input,
        output,
        points: points?,
        span: key.span.clone(),
    })
}

fn rates(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<RatesTask> {
    let three = |cx: &mut Context<'_>, key: &str| {
        let node = entry.required(cx, key)?;
        let items = cx.array(node, &entry.place_of(key), entry.example_of(key))?;
        let [first, coupler, second] = items else {
            let message = format!("{} has {} values", entry.place_of(key), items.len());
            let help = format!(
                "of crank, coupler and rocker: {key} = {}",
                entry.example_of(key)
            );
            return cx.refuse("wrong-type", message, &node.span, help);
        };
        let dimension = entry.dimension(key);
        let all = [first, coupler, second].map(|node| cx.scalar(node, dimension));
        let [first, coupler, second] = all;
        let spans = [&items[0], &items[1], &items[2]].map(|node| node.span.clone());
        Some(([first?, coupler?, second?], spans))
    };
    let speeds = three(cx, "speeds");
    let accelerations = three(cx, "accelerations");
    let ground = ground(cx, entry);
    let (speeds, spans) = speeds?;
    Some(RatesTask {
        speeds,
        accelerations: accelerations?.0,
        ground: ground?,
        spans,
    })
}

fn dead_centres(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<DeadCentresTask> {
    let time_ratio = entry.value_or(cx, "time_ratio", 1.0);
    let swing = entry.value(cx, "swing")?;
    let travel = entry.value(cx, "stroke")?;
    let coupler = entry.value(cx, "coupler")?;
    let offset = entry.value(cx, "offset")?;
    let stroke = match (swing, travel) {
        (Some(_), Some(_)) => {
            entry.contradiction(
                cx,
                &["swing", "stroke"],
                "a rocker swings, or a slider goes to and fro",
                "leave one of them out",
            );
            return None;
        }
        (Some(swing), None) => {
            entry.idle(cx, &["offset"], "stroke");
            let one = cx.bare_unit(Dimension::LENGTH).to_si(1.0);
            let rocker = entry.value_or(cx, "rocker", one)?;
            Stroke::Swing {
                swing,
                rocker,
                coupler,
            }
        }
        (None, Some(travel)) => {
            entry.idle(cx, &["rocker"], "swing");
            if coupler.is_some() && offset.is_some() {
                entry.contradiction(
                    cx,
                    &["coupler", "offset"],
                    "stroke and time ratio leave one of them to choose",
                    "leave one of them out",
                );
                return None;
            }
            Stroke::Travel {
                travel,
                coupler,
                offset,
            }
        }
        (None, None) => {
            entry.required(cx, "swing");
            return None;
        }
    };
    let span_of = |keys: [&str; 2]| {
        let given = keys.iter().find_map(|key| entry.get(key));
        given.map_or(0..0, |node| node.span.clone())
    };
    let choices = [
        ["swing", "stroke"],
        ["time_ratio"; 2],
        ["coupler", "offset"],
    ];
    Some(DeadCentresTask {
        stroke,
        time_ratio: time_ratio?,
        spans: choices.map(span_of),
    })
}
