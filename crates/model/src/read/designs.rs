//! Studies of many designs.
//!
//! ```toml
//! [studies.family]
//! kind = "sweep"
//! over = "lifting"
//! vary = { k = { from = "350 mm", to = "500 mm", count = 7 } }
//!
//! [studies.spread]
//! kind   = "tolerance"
//! over   = "lifting"
//! vary   = { k = "0.2 mm", m = { normal = "0.1 mm" } }
//! limits = ["range(y(M)) >= 450 mm"]
//!
//! [studies.best]
//! kind       = "optimize"
//! over       = "lifting"
//! vary       = { k = ["350 mm", "500 mm"], m = ["500 mm", "700 mm"] }
//! minimize   = "max(load)"
//! subject_to = ["range(y(M)) >= 450 mm"]     # or, instead of minimize, fit = { … }: see fit.rs
//! ```

use kempe_units::{Comparison, Dimension, Expr, check_condition, parse_condition};

use crate::bound::Keeps;
use crate::condition::Condition;
use crate::designs::{
    Among, Change, Chosen, Combine, Goal, Limit, OptimizeStudy, OverStudy, Spread, SweepStudy,
    Swept, SweptValues, ToleranceStudy, Toleranced,
};
use crate::diagnostic::Diagnostic;
use crate::ids::{ParameterId, Scalar, Span};
use crate::key_table::designs::{
    AMONG, COMBINE, MAX_VALUES, MAX_VARIED, OPTIMIZE_METHODS, SPACING, SPREAD, SWEPT,
};
use crate::measure::{Leaf, Measure};
use crate::motion_study::{Column, MotionStudy, Plot, Rows};
use crate::node::{Key, Node, Value};
use crate::read::adjust::free_parameter;
use crate::read::column::column;
use crate::read::context::Context;
use crate::read::entry::{Entry, entries};
use crate::read::fit;
use crate::read::measure_names::Measures;
use crate::read::names::COLUMNS;
use crate::read::nature::nature;
use crate::read::plots::plot;
use crate::read::synthesis::count;
use crate::study::StudyKind;

/// The words behind `kind`.
pub(crate) const KINDS: [&str; 3] = ["sweep", "tolerance", "optimize"];

/// Pieces that are drawn where the file does not say how many.
const SAMPLES: usize = 10_000;

/// The studies of the file that run by themselves, by their names (`None` of one that is wrong), and the names of those that run others.
#[derive(Default)]
pub(crate) struct Others<'a> {
    pub own: Vec<(&'a str, Option<&'a StudyKind>)>,
    pub of_designs: Vec<&'a str>,
}

pub(crate) fn read(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    name: &Key,
    others: &Others<'_>,
) -> Option<StudyKind> {
    let fit = entry.kind.key("fit").and_then(|_| entry.get("fit"));
    let over = over(cx, (entry, &name.name), others, fit.is_some());
    if let Some((_, Runs::Whole)) = over {
        no_measures(cx, entry)?;
    }
    let forces = (over.as_ref()).is_none_or(|(_, runs)| *runs != Runs::Motion);
    let over_name = over.as_ref().map(|(name, _)| name.clone());
    let columns = numbers(cx, entry, "columns", forces);
    let plots = match entry.kind.key("plot") {
        Some(_) => curves(cx, entry, forces),
        None => Some(Vec::new()),
    };
    let over = |columns: Vec<Goal>, plots: Vec<Plot>| {
        Some(OverStudy {
            name: over?.0,
            asked: MotionStudy {
                rows: Rows::Count(1),
                columns: columns.into_iter().map(|goal| goal.number).collect(),
                plots,
                circuit: false,
            },
            span: name.span.clone(),
        })
    };
    match entry.kind.name {
        "sweep" => {
            let vary = varied(cx, entry, swept);
            let combine = entry.choice(cx, "combine", &COMBINE);
            let combine = combine?.unwrap_or(Combine::Grid);
            let vary: Vec<Swept> = vary?;
            as_long(cx, entry, combine, &vary)?;
            // One at a time, all others are as in the file.
            if combine != Combine::OneAtATime {
                let values = vary
                    .iter()
                    .map(|it| (it.parameter, it.values.scalars(), &it.span));
                stand_still(cx, values.collect())?;
            }
            Some(StudyKind::Sweep(Box::new(SweepStudy {
                over: over(columns?, plots?)?,
                vary,
                combine,
            })))
        }
        "tolerance" => {
            let clearance = clearance(cx, entry);
            // Where joints have play nothing else needs to differ.
            let vary = match (&clearance, entry.has("vary")) {
                (Some(Some(_)), false) => Some(Vec::new()),
                _ => varied(cx, entry, toleranced),
            };
            let limits = limits(cx, entry, "limits", forces);
            let samples = count(cx, entry, "samples", SAMPLES);
            let seed = count(cx, entry, "seed", 1);
            Some(StudyKind::Tolerance(Box::new(ToleranceStudy {
                over: over(columns?, plots?)?,
                vary: vary?,
                clearance: clearance?,
                samples: samples?,
                seed: seed?,
                limits: limits?,
            })))
        }
        _ => {
            let vary = varied(cx, entry, chosen);
            let small = numbers(cx, entry, "minimize", forces);
            let large = numbers(cx, entry, "maximize", forces);
            let subject_to = limits(cx, entry, "subject_to", forces);
            let method = entry.choice(cx, "method", &OPTIMIZE_METHODS);
            let seed = count(cx, entry, "seed", 1);
            let designs = count(cx, entry, "designs", 0);
            let large = large?.into_iter().map(|goal| Goal {
                maximize: true,
                ..goal
            });
            let goals: Vec<Goal> = small?.into_iter().chain(large).collect();
            told_once(cx, entry, &goals)?;
            let vary: Vec<Chosen> = vary?;
            let values = vary
                .iter()
                .map(|it| (it.parameter, it.among.scalars(), &it.span));
            stand_still(cx, values.collect())?;
            let fit = match fit {
                None => None,
                Some(node) => {
                    let of_motion = over_fits(cx, entry, others, &over_name);
                    let varied: Vec<ParameterId> = vary.iter().map(|it| it.parameter).collect();
                    let fit = fit::read(cx, entry, node, &varied);
                    of_motion?;
                    Some(fit?)
                }
            };
            if let (Some(fit), Some(goal)) = (&fit, goals.first()) {
                let told = Diagnostic::error(
                    "over-specified",
                    format!("{} has a fit and another goal", entry.place),
                );
                cx.push(
                    told.at(fit.span.clone(), "what is missed here is to be small")
                        .see(goal.span.clone(), "and this is a goal, too")
                        .help("leave one of them out; what must be kept besides belongs under `subject_to`"),
                );
                return None;
            }
            if goals.is_empty() && fit.is_none() {
                if !(entry.has("minimize") || entry.has("maximize")) {
                    entry.required_like(cx, "minimize", entry.example_of("minimize"))?;
                }
                return cx.refuse(
                    "missing-key",
                    format!("{} has no goal", entry.place),
                    entry.span,
                    format!(
                        "say what is to be small or large: minimize = {}",
                        entry.example_of("minimize")
                    ),
                );
            }
            Some(StudyKind::Optimize(Box::new(OptimizeStudy {
                over: over(columns?, plots?)?,
                vary,
                goals,
                fit,
                subject_to: subject_to?,
                method: method?,
                seed: seed?,
                designs: designs.map(|n| (n > 0).then_some(n))?,
            })))
        }
    }
}

/// Goals of which each is another one.
fn told_once(cx: &mut Context<'_>, entry: &Entry<'_>, goals: &[Goal]) -> Option<()> {
    let twice = goals.iter().enumerate().find_map(|(k, goal)| {
        let known = goals[..k].iter().find(|known| {
            known.maximize == goal.maximize && known.number.measure == goal.number.measure
        });
        known.map(|known| (known, goal))
    });
    let Some((known, goal)) = twice else {
        return Some(());
    };
    let message = format!("{} has `{}` as a goal twice", entry.place, goal.number.name);
    cx.push(
        Diagnostic::error("over-specified", message)
            .at(goal.span.clone(), "")
            .see(known.span.clone(), "named here before")
            .help("leave one of the two out"),
    );
    None
}

/// What is asked of a study that is run for many designs.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Runs {
    /// Measures of a motion.
    Motion,
    /// Measures of a motion and of its forces.
    Forces,
    /// What it tells itself.
    Whole,
}

/// Of a study that is run as a whole no measures can be asked.
fn no_measures(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<()> {
    let mut given = ["columns", "plot"].into_iter();
    let Some(key) = given.find(|key| entry.has(key)) else {
        return Some(());
    };
    let span = entry.get(key).map(|node| node.span.clone());
    cx.refuse(
        "bad-choice",
        format!(
            "{} asks for measures of a study that is run as a whole",
            entry.place_of(key)
        ),
        &span.unwrap_or_default(),
        "leave it out: the numbers are those that the study tells, the curves those that it plots",
    )
}

/// The study that is run, and what can be asked of it; whole circuits can be fitted alone.
fn over(
    cx: &mut Context<'_>,
    (entry, own): (&Entry<'_>, &str),
    others: &Others<'_>,
    circuits: bool,
) -> Option<(String, Runs)> {
    let sweeps = entry.kind.name == "sweep";
    let forces_of = |kind: &StudyKind| match kind {
        StudyKind::Motion(along) if circuits || !along.circuit => Some(Runs::Motion),
        StudyKind::Forces(_) | StudyKind::Simulate(_) => Some(Runs::Forces),
        _ => sweeps.then_some(Runs::Whole),
    };
    let Some(node) = entry.get("over") else {
        let along = |kind: &&StudyKind| {
            let along = matches!(forces_of(kind), Some(Runs::Motion | Runs::Forces));
            along && !matches!(kind, StudyKind::Simulate(_))
        };
        let known = others
            .own
            .iter()
            .filter(|(_, kind)| kind.as_ref().is_some_and(along));
        let known: Vec<_> = known.collect();
        return match known.as_slice() {
            [(name, Some(kind))] => Some(((*name).to_owned(), forces_of(kind)?)),
            // One that is wrong may be the one that is meant.
            [] if others.own.iter().any(|(_, kind)| kind.is_none()) => None,
            _ => {
                let example = known.first().map_or_else(
                    || "\"turn\", and [studies.turn] with the line kind = \"motion\"".to_owned(),
                    |(name, _)| format!("\"{name}\""),
                );
                entry.required_like(cx, "over", &example);
                None
            }
        };
    };
    let text = entry.text(cx, "over", node)?;
    let name = text.content.trim();
    let wrong_kind = |cx: &mut Context<'_>, help| {
        let place = entry.place_of("over");
        let message = match name == own {
            true => format!("{place} names the study itself"),
            false => format!("{place} cannot be run for many designs"),
        };
        cx.refuse("bad-choice", message, &node.span, help)
    };
    if others.of_designs.contains(&name) {
        return wrong_kind(cx, OVER);
    }
    let Some((_, kind)) = others.own.iter().find(|(known, _)| *known == name) else {
        let known = others.own.iter().map(|(name, _)| *name);
        let d = cx.no_such("study", name, node.span.clone(), known);
        cx.push(d);
        return None;
    };
    let kind = (*kind)?;
    match (forces_of(kind), kind) {
        (Some(forces), _) => Some((name.to_owned(), forces)),
        (None, StudyKind::Clearance(_) | StudyKind::Contact(_)) => wrong_kind(cx, OVER_PLAY),
        (None, _) => wrong_kind(cx, OVER),
    }
}

/// What may be run for many designs, and how play is counted then.
const OVER: &str = "name a study of motion without `circuit = true`, of forces, or a simulation; sweeps take any study but other sweeps";
const OVER_PLAY: &str = "sweeps take it; tolerances count play over a study of motion or forces with `clearance = true`";

/// Whether what is run has paths that can be fitted as they are asked.
fn over_fits(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    others: &Others<'_>,
    name: &Option<String>,
) -> Option<()> {
    let name = name.as_deref()?;
    let (_, kind) = others.own.iter().find(|(known, _)| *known == name)?;
    let span = entry.get("over").map_or(entry.span, |node| &node.span);
    match (*kind)? {
        StudyKind::Simulate(_) => cx.refuse(
            "bad-choice",
            format!("{}: the path of a simulation is not fitted", entry.place),
            span,
            "name a study of motion or forces, whose drives keep their laws",
        ),
        StudyKind::Motion(along) if along.circuit => {
            let idle = entry.given(&["subject_to", "columns"]).next();
            match idle {
                None => Some(()),
                Some(key) => cx.refuse(
                    "contradictory-values",
                    format!(
                        "`{}` is of a motion, and `{name}` is a whole circuit",
                        key.name
                    ),
                    &key.span,
                    "leave it out, or name a study in which a drive goes one way",
                ),
            }
        }
        _ => Some(()),
    }
}

/// Where it is said that joints have play, if it is.
fn clearance(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<Option<Span>> {
    let counts = entry.flag(cx, "clearance")?;
    let node = entry.get("clearance").filter(|_| counts);
    Some(node.map(|node| node.span.clone()))
}

/// The parameters that vary, each with what is said of it.
fn varied<T>(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    mut read: impl FnMut(&mut Context<'_>, &Entry<'_>, ParameterId, &Node) -> Option<T>,
) -> Option<Vec<T>> {
    let node = entry.required(cx, "vary")?;
    let place = entry.place_of("vary");
    let table = cx.table(node, &place, entry.example_of("vary"))?;
    if table.entries.is_empty() || table.entries.len() > MAX_VARIED {
        let message = format!("{place} names {} parameters", table.entries.len());
        let help = format!("name 1 to {MAX_VARIED} of [parameters]");
        return cx.refuse("wrong-type", message, &node.span, help);
    }
    let mut found = Vec::new();
    let mut whole = true;
    for (key, node) in &table.entries {
        if COLUMNS.contains(&key.name.as_str()) {
            let message = format!("a parameter called `{}` cannot vary", key.name);
            let help = format!("choose another name, such as `my_{}`", key.name);
            let at = format!("tables have a column `{}` of their own", key.name);
            cx.push(
                Diagnostic::error("bad-name", message)
                    .at(key.span.clone(), at)
                    .help(help),
            );
            whole = false;
            continue;
        }
        let one = free_parameter(cx, &key.name, &key.span).and_then(|id| read(cx, entry, id, node));
        whole &= one.is_some();
        found.extend(one);
    }
    whole.then_some(found)
}

/// A value of a parameter.
fn value_of(cx: &mut Context<'_>, id: ParameterId, node: &Node) -> Option<Scalar> {
    let dimension = cx.model.parameters[id.index()].dimension;
    let value = cx.scalar(node, dimension)?;
    apart_from(cx, id, &value, node)?;
    Some(value)
}

/// What a parameter is to be cannot hang on itself.
fn apart_from(cx: &mut Context<'_>, id: ParameterId, value: &Scalar, node: &Node) -> Option<()> {
    // A parameter depends on earlier ones only.
    let mut hangs = vec![false; cx.model.parameters.len()];
    for (index, parameter) in cx.model.parameters.iter().enumerate() {
        hangs[index] = index == id.index() || parameter.value.leaves().any(|it| hangs[it.index()]);
    }
    if !value.leaves().any(|it| hangs[it.index()]) {
        return Some(());
    }
    let name = cx.model.parameters[id.index()].name.clone();
    cx.refuse(
        "bad-choice",
        format!("a value of `{name}` depends on `{name}`"),
        &node.span,
        "write a number",
    )
}

/// An amount by which a parameter changes, or a part of its value; not negative.
fn change(cx: &mut Context<'_>, id: ParameterId, node: &Node, place: &str) -> Option<Change> {
    let own = cx.model.parameters[id.index()].dimension;
    let name = cx.model.parameters[id.index()].name.clone();
    let part = match &node.value {
        Value::Text(text) => text.content.contains('%'),
        _ => false,
    };
    let dimension = match part {
        true => Dimension::NONE,
        false => own,
    };
    let value = cx.positive(
        node,
        dimension,
        &format!("{place}: the change of `{name}`"),
        false,
    )?;
    apart_from(cx, id, &value, node)?;
    let zero = cx.values.get(id.index()) == Some(&0.0);
    match part {
        true if zero => cx.refuse(
            "bad-size",
            format!("`{name}` is 0, and a part of it is nothing"),
            &node.span,
            "give an amount with its unit",
        ),
        true => Some(Change::Part(value)),
        false => Some(Change::By(value)),
    }
}

/// Two values of a parameter, the first the smaller.
fn in_order(
    cx: &mut Context<'_>,
    id: ParameterId,
    node: &Node,
    place: &str,
    example: &str,
) -> Option<[Scalar; 2]> {
    let (a, b) = match cx.array(node, place, example)? {
        [a, b] => (a, b),
        items => {
            let help = format!("write it like {example}");
            cx.not_two(node, items, format!("{place} has two entries"), &help);
            return None;
        }
    };
    let (low, high) = (value_of(cx, id, a), value_of(cx, id, b));
    let (low, high) = (low?, high?);
    if !(cx.number(&low) < cx.number(&high)) {
        let name = cx.model.parameters[id.index()].name.clone();
        return cx.refuse(
            "contradictory-values",
            format!("of `{name}` the first value is not below the second one"),
            &node.span,
            "write [least, greatest]",
        );
    }
    let parameter = &cx.model.parameters[id.index()];
    let (dimension, name) = (parameter.dimension, &parameter.name);
    let what = format!("the room between the first and the second value of `{name}`");
    cx.apart([&low, &high], &node.span, &what, dimension, Keeps::Positive);
    Some([low, high])
}

/// That no values of a parameter go by another that varies, too: they would be those that the file's own value of it makes them.
fn stand_still(cx: &mut Context<'_>, vary: Vec<(ParameterId, Vec<&Scalar>, &Span)>) -> Option<()> {
    let goes_by = |values: &[&Scalar]| {
        let mut open: Vec<ParameterId> = values.iter().flat_map(|x| x.leaves().copied()).collect();
        let mut known = Vec::new();
        while let Some(id) = open.pop() {
            if vary.iter().any(|(varied, ..)| *varied == id) {
                return Some(id);
            }
            if !known.contains(&id) {
                known.push(id);
                open.extend(cx.model.parameters[id.index()].value.leaves().copied());
            }
        }
        None
    };
    let found = vary.iter().find_map(|(parameter, values, span)| {
        goes_by(values).map(|other| (*parameter, other, (*span).clone()))
    });
    let Some((parameter, other, span)) = found else {
        return Some(());
    };
    let [name, other] = [parameter, other].map(|id| cx.model.parameters[id.index()].name.clone());
    cx.refuse(
        "contradictory-values",
        format!("the values of `{name}` go by `{other}`, which varies, too"),
        &span,
        format!("vary what is between the two, a parameter `ratio` with {name} = \"ratio * {other}\", and {other}"),
    )
}

/// Values of a parameter in brackets.
fn listed(
    cx: &mut Context<'_>,
    id: ParameterId,
    node: &Node,
    place: &str,
    example: &str,
) -> Option<Vec<Scalar>> {
    let items = cx.array(node, place, example)?;
    if items.is_empty() {
        return cx.refuse(
            "wrong-type",
            format!("{place} has no value"),
            &node.span,
            format!("write it like {example}"),
        );
    }
    let values: Vec<Option<Scalar>> = items.iter().map(|item| value_of(cx, id, item)).collect();
    values.into_iter().collect()
}

/// Whether values are one: the same in another unit may differ by rounding.
fn is_same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * a.abs()
}

/// Values of a list that stand there twice: one of them may be a slip of the pen.
fn told_twice(cx: &mut Context<'_>, id: ParameterId, values: &[Scalar], node: &Node) {
    let numbers: Vec<f64> = values.iter().map(|value| cx.number(value)).collect();
    let again = (1..numbers.len()).find(|k| numbers[..*k].iter().any(|x| is_same(*x, numbers[*k])));
    if let (Some(k), Value::Array(items)) = (again, &node.value) {
        let name = &cx.model.parameters[id.index()].name;
        let told = Diagnostic::warning(
            "over-specified",
            format!("the values of `{name}` name one twice"),
        );
        cx.push(
            told.at(items[k].span.clone(), "named before")
                .help("leave it out, or correct it"),
        );
    }
}

fn swept(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    parameter: ParameterId,
    node: &Node,
) -> Option<Swept> {
    let place = entry.place_of("vary");
    let span = node.span.clone();
    let example = "[\"1 mm\", \"2 mm\"]";
    let values = match &node.value {
        Value::Table(_) => {
            let table = Entry::inner(cx, node, &node.span, place.clone(), &SWEPT)?;
            even_or_around(cx, &table, parameter, &span)?
        }
        _ => {
            let values = listed(cx, parameter, node, &place, example)?;
            told_twice(cx, parameter, &values, node);
            SweptValues::These(values)
        }
    };
    Some(Swept {
        parameter,
        values,
        span,
    })
}

fn even_or_around(
    cx: &mut Context<'_>,
    table: &Entry<'_>,
    id: ParameterId,
    span: &Span,
) -> Option<SweptValues> {
    let around = table.get("by");
    let even: Vec<&Key> = table.given(&["from", "to", "count"]).collect();
    if let (Some(_), Some(key)) = (around, even.first()) {
        return cx.refuse(
            "over-specified",
            format!(
                "`by` goes around the file's own value: `{}` means nothing",
                key.name
            ),
            &key.span,
            "leave one of them out",
        );
    }
    if let Some(node) = around {
        return change(cx, id, node, &table.place).map(SweptValues::Around);
    }
    let missing = ["from", "to", "count"]
        .into_iter()
        .find(|key| !table.has(key));
    let wrong_count = count(cx, table, "count", 2);
    let ends = ["from", "to"].map(|key| table.get(key).map(|node| value_of(cx, id, node)));
    if ["from", "to", "count", "by"]
        .iter()
        .any(|key| table.misspelt(key))
    {
        return None;
    }
    if let Some(missing) = missing {
        return cx.refuse(
            "missing-key",
            format!("{} has no `{missing}`", table.place),
            span,
            format!("write it like {}", SWEPT.example),
        );
    }
    let [from, to] = ends.map(Option::flatten);
    let count = wrong_count?;
    if count < 2 {
        return cx.refuse(
            "bad-size",
            "from one value to another there are at least two",
            span,
            "write count = 2 or more, or one value in brackets",
        );
    }
    let (from, to) = (from?, to?);
    if is_same(cx.number(&from), cx.number(&to)) {
        let name = &cx.model.parameters[id.index()].name;
        let told = Diagnostic::warning(
            "over-specified",
            format!("`{name}` goes from a value to the same: {count} designs are one"),
        );
        cx.push(
            told.at(span.clone(), "")
                .help("correct an end, or give the one value in brackets"),
        );
    }
    Some(SweptValues::Even { from, to, count })
}

/// Values that go together are as many of each.
fn as_long(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    combine: Combine,
    vary: &[Swept],
) -> Option<()> {
    if combine != Combine::Together {
        return Some(());
    }
    let first = vary.first()?.values.count();
    match vary.iter().find(|swept| swept.values.count() != first) {
        None => Some(()),
        Some(odd) => cx.refuse(
            "contradictory-values",
            format!(
                "{}: values that go together are as many of each, and here are {} beside {first}",
                entry.place,
                odd.values.count()
            ),
            &odd.span.clone(),
            "give as many values of each parameter, or leave `combine` out: each with each",
        ),
    }
}

fn toleranced(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    parameter: ParameterId,
    node: &Node,
) -> Option<Toleranced> {
    let place = entry.place_of("vary");
    let span = node.span.clone();
    let spread = match &node.value {
        Value::Table(_) => {
            let table = Entry::inner(cx, node, &node.span, place.clone(), &SPREAD)?;
            let given: Vec<&Key> = table.given(&["uniform", "between", "normal"]).collect();
            match given.as_slice() {
                [] if ["uniform", "between", "normal"]
                    .iter()
                    .any(|key| table.misspelt(key)) =>
                {
                    return None;
                }
                [] => {
                    return cx.refuse(
                        "missing-key",
                        format!("{place} does not say how it differs"),
                        &node.span,
                        format!("write it like {}", SPREAD.example),
                    );
                }
                [one] => {
                    let node = table.get(&one.name)?;
                    match one.name.as_str() {
                        "uniform" => Spread::Even(change(cx, parameter, node, &place)?),
                        "normal" => Spread::Normal(change(cx, parameter, node, &place)?),
                        _ => {
                            let example = table.example_of("between");
                            let both = in_order(cx, parameter, node, &place, example)?;
                            Spread::Between(both)
                        }
                    }
                }
                [first, second, ..] => {
                    let [first, second] = [&first.name, &second.name];
                    table.contradiction(
                        cx,
                        &[first, second],
                        "it differs in one way",
                        "leave one of them out",
                    );
                    return None;
                }
            }
        }
        _ => Spread::Even(change(cx, parameter, node, &place)?),
    };
    Some(Toleranced {
        parameter,
        spread,
        span,
    })
}

fn chosen(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    parameter: ParameterId,
    node: &Node,
) -> Option<Chosen> {
    let place = entry.place_of("vary");
    let span = node.span.clone();
    let example = "[\"15 mm\", \"25 mm\"]";
    let among = match &node.value {
        Value::Table(_) => {
            let table = Entry::inner(cx, node, &node.span, place.clone(), &AMONG)?;
            let log = table.choice(cx, "spacing", &SPACING)?.unwrap_or(false);
            match (table.get("between"), table.get("only"), table.get("step")) {
                (Some(_), Some(_), _) | (_, Some(_), Some(_)) => {
                    table.contradiction(
                        cx,
                        &["only", "between", "step"],
                        "its values are told in two ways",
                        "leave `only` out, or all else",
                    );
                    return None;
                }
                (_, Some(_), _) | (_, _, Some(_)) if log => {
                    let other = if table.has("only") { "only" } else { "step" };
                    table.contradiction(
                        cx,
                        &["spacing", other],
                        "its values are given one by one",
                        "leave one of them out",
                    );
                    return None;
                }
                (None, Some(node), None) => {
                    let values = listed(cx, parameter, node, &place, example)?;
                    told_twice(cx, parameter, &values, node);
                    Among::Only(values)
                }
                (Some(node), None, step) => {
                    let between = in_order(cx, parameter, node, &place, example)?;
                    match step {
                        None if log => factors(cx, parameter, between, node)?,
                        None => Among::Between(between),
                        Some(node) => steps(cx, parameter, between, node)?,
                    }
                }
                (None, None, _) if ["between", "only"].iter().any(|key| table.misspelt(key)) => {
                    return None;
                }
                (None, None, step) => {
                    if let Some(node) = step {
                        let dimension = cx.model.parameters[parameter.index()].dimension;
                        cx.positive(node, dimension, "a step", false)?;
                    }
                    return cx.refuse(
                        "missing-key",
                        format!("{place} does not say among which values it is chosen"),
                        &node.span,
                        format!("write it like {}", AMONG.example),
                    );
                }
            }
        }
        _ => Among::Between(in_order(cx, parameter, node, &place, example)?),
    };
    Some(Chosen {
        parameter,
        among,
        span,
    })
}

/// Values between two that are spaced by factors, and so are positive.
fn factors(
    cx: &mut Context<'_>,
    id: ParameterId,
    between: [Scalar; 2],
    node: &Node,
) -> Option<Among> {
    if cx.number(&between[0]) > 0.0 {
        return Some(Among::Factors(between));
    }
    let name = cx.model.parameters[id.index()].name.clone();
    cx.refuse(
        "bad-size",
        format!("`{name}` is spaced by factors, and its least value is not above 0"),
        &node.span,
        "begin above 0, or leave `spacing` out",
    )
}

/// Whole multiples of a step between two values.
fn steps(
    cx: &mut Context<'_>,
    id: ParameterId,
    between: [Scalar; 2],
    node: &Node,
) -> Option<Among> {
    let dimension = cx.model.parameters[id.index()].dimension;
    let step = cx.positive(node, dimension, "a step", false)?;
    apart_from(cx, id, &step, node)?;
    let [low, high] = between.each_ref().map(|end| cx.number(end));
    let size = cx.number(&step);
    let few = (high / size).floor() - (low / size).ceil();
    if !(few >= 0.0) {
        return cx.refuse(
            "contradictory-values",
            "no whole multiple of this step lies between the least and the greatest value",
            &node.span,
            "take a smaller step",
        );
    }
    if few >= MAX_VALUES as f64 {
        return cx.refuse(
            "too-large",
            format!("more than {MAX_VALUES} whole multiples of this step lie between the least and the greatest value"),
            &node.span,
            "take a larger step, or leave it out and have any value between the two",
        );
    }
    Some(Among::Steps { between, step })
}

/// Numbers over the motion, with their places in the file.
fn numbers(cx: &mut Context<'_>, entry: &Entry<'_>, key: &str, forces: bool) -> Option<Vec<Goal>> {
    let mut found = Vec::new();
    let mut whole = true;
    for node in entries(cx, entry, key) {
        let one = column(cx, node, forces).and_then(|number| {
            if number.measure.leaves().next().is_none() {
                let name = number.name.clone();
                return cx.refuse(
                    "not-a-value",
                    format!("`{name}` is the same for all designs"),
                    &node.span,
                    "name a number over the motion, such as max(x(C))",
                );
            }
            if nature(&number.measure, &cx.natures).instant {
                let name = &number.name;
                return cx.refuse(
                    "not-over-the-motion",
                    format!("`{name}` has a value at every instant: which of them is meant?"),
                    &node.span,
                    format!("ask for one number: max({name}), min({name}), range({name}), mean({name}), at({name}, …)"),
                );
            }
            Some(Goal {
                number,
                maximize: false,
                span: node.span.clone(),
            })
        });
        whole &= one.is_some();
        found.extend(one);
    }
    whole.then_some(found)
}

/// What is plotted of several designs.
fn curves(cx: &mut Context<'_>, entry: &Entry<'_>, forces: bool) -> Option<Vec<Plot>> {
    let mut found = Vec::new();
    let mut whole = true;
    for node in entries(cx, entry, "plot") {
        let one = match plot(cx, node, forces) {
            Some(it @ (Plot::Curves(_) | Plot::Path(_))) => Some(it),
            Some(Plot::Hodograph(_)) => cx.refuse(
                "bad-choice",
                "hodographs are not plotted for several designs",
                &node.span,
                "plot reaction(B) or its parts",
            ),
            None => None,
        };
        whole &= one.is_some();
        found.extend(one);
    }
    whole.then_some(found)
}

/// Conditions on numbers over the motion, or on what has a value at every instant.
fn limits(cx: &mut Context<'_>, entry: &Entry<'_>, key: &str, forces: bool) -> Option<Vec<Limit>> {
    let place = entry.place_of(key);
    let mut found = Vec::new();
    let mut whole = true;
    for node in entries(cx, entry, key) {
        let one = limit(cx, node, &place, forces);
        whole &= one.is_some();
        found.extend(one);
    }
    whole.then_some(found)
}

/// Whether a measure is the same for every motion: of numbers and parameters alone.
fn is_fixed(measure: &Measure) -> bool {
    measure
        .leaves()
        .all(|leaf| matches!(leaf, Leaf::Parameter(_)))
}

fn limit(cx: &mut Context<'_>, node: &Node, place: &str, forces: bool) -> Option<Limit> {
    let text = cx.text(node, place, "\"range(angle(rocker)) >= 59 deg\"")?;
    let checked = parse_condition(&text.content).and_then(|tree| {
        let found = check_condition(&tree, &mut Measures(cx))?;
        let comparison = &tree.comparison_span;
        let sides = [
            text.content.get(..comparison.start),
            text.content.get(comparison.end..),
        ];
        Ok((
            sides.map(|side| side.unwrap_or_default().trim().to_owned()),
            found,
        ))
    });
    let ([left, right], condition) = match checked {
        Ok(found) => found,
        Err(issues) => {
            cx.issues(text, issues);
            return None;
        }
    };
    let at_least = matches!(
        condition.comparison,
        Comparison::Greater | Comparison::GreaterEqual
    );
    // What is written on either side may be what is limited.
    let reversed = is_fixed(&condition.left) && !is_fixed(&condition.right);
    let (written, limited) = match reversed {
        true => (right, condition.right.clone()),
        false => (left, condition.left.clone()),
    };
    let (large, small) = match at_least {
        true => (condition.left, condition.right),
        false => (condition.right, condition.left),
    };
    let above = Expr::Sub(Box::new(large), Box::new(small));
    if above.leaves().next().is_none() {
        return cx.refuse(
            "over-specified",
            format!("`{}` compares numbers alone", text.content.trim()),
            &node.span,
            "name what is to be kept, such as \"range(angle(rocker)) >= 59 deg\", or leave it out",
        );
    }
    if !forces && nature(&above, &cx.natures).forces {
        return cx.refuse(
            "needs-forces-study",
            "the study that is run knows no forces",
            &node.span,
            "run a study of kind = \"forces\": over = …",
        );
    }
    Some(Limit {
        condition: Condition {
            text: text.content.trim().to_owned(),
            above,
            dimension: condition.dimension,
        },
        limited: Column {
            name: written,
            measure: limited,
            dimension: condition.dimension,
        },
        at_least: at_least != reversed,
        span: node.span.clone(),
    })
}

impl SweptValues {
    /// How many there are.
    pub fn count(&self) -> usize {
        match self {
            Self::These(values) => values.len(),
            Self::Even { count, .. } => *count,
            Self::Around(_) => 3,
        }
    }
}
