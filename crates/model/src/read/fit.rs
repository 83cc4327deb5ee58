//! What the path of a point, or the motion of a link, is to fit.
//!
//! ```toml
//! fit = { point = "P", to = [[20, 20], [20, 25], [20, 30]] }
//! fit = { point = "P", to = { table = "foot.csv", x = "x", y = "y" }, timing = "arc-length", closed = true }
//! fit = { point = "P", to = [[3, 3], [2.759, 3.363]], timing = { motor = [30, 45] } }
//! fit = { link = "coupler", at = "P", to = [[0, 0, 0], [12, 6, 20]], radius = 30 }
//! ```

use kempe_units::{Dimension, Expr};

use crate::diagnostic::Diagnostic;
use crate::fit::{Fit, GivenPlace, Timing, Traced};
use crate::ids::{DriveId, FRAME, LinkId, ParameterId, PointId, Scalar, Span};
use crate::key_table::designs::{FIT, FIT_TABLE, TIMINGS};
use crate::node::{Node, Value};
use crate::read::context::{Context, Meaning};
use crate::read::csv::{Ask, Pick, Words, all_columns};
use crate::read::entry::Entry;
use crate::read::law_table::column_name;
use crate::read::simulate::coordinate;

/// The fewest places that are a curve.
const FEWEST: usize = 2;

const WORDS: Words = Words {
    not_rising: None,
    order: "rows are places in their order",
    least: FEWEST,
    few: "a curve has at least two points",
};

/// What the fit of a link looks like: it has other keys than that of a point.
const OF_LINK: &str =
    "fit = { link = \"rocker\", at = \"C\", to = [[20, 30, 0], [25, 32, 15]], radius = \"50 mm\" }";

/// What is given at places of a table.
struct Column {
    drive: Option<DriveId>,
    ask: Ask,
}

/// The fit of a study that varies these parameters.
pub(crate) fn read(
    cx: &mut Context<'_>,
    study: &Entry<'_>,
    node: &Node,
    varied: &[ParameterId],
) -> Option<Fit> {
    let mut entry = Entry::inner(cx, node, &node.span, study.place_of("fit"), &FIT)?;
    let turned = entry.has("link") && !entry.has("point");
    if turned {
        entry.example = OF_LINK;
    }
    let traced = traced(cx, &entry);
    let closed = entry.flag(cx, "closed");
    let to = entry.required(cx, "to");
    let given = to.and_then(|to| match &to.value {
        Value::Table(_) => from_table(cx, &entry, to, turned),
        _ => {
            let places = listed(cx, &entry, to, turned)?;
            let timing = timing(cx, &entry)?;
            Some((places, timing))
        }
    });
    let (traced, closed, (to, timing)) = (traced?, closed?, given?);
    if let Timing::At(_, values) = &timing {
        let place = entry.get("timing").map_or(&node.span, |n| &n.span);
        if values.len() != to.len() {
            let message = format!("{} places and {} values", to.len(), values.len());
            let help = "give a value for each place, in their order";
            return cx.refuse("contradictory-values", message, place, help);
        }
        if closed {
            entry.contradiction(
                cx,
                &["closed", "timing"],
                "a closed way may be begun anywhere, but its timing says where it is",
                "leave out `closed`, or write timing = \"even\"",
            );
            return None;
        }
    }
    let fit = Fit {
        traced,
        to,
        timing,
        closed,
        span: node.span.clone(),
    };
    known(cx, &fit, varied)?;
    apart(cx, &entry, &fit)?;
    Some(fit)
}

/// What goes along the places.
fn traced(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<Traced> {
    if entry.has("point") && entry.has("link") {
        entry.contradiction(
            cx,
            &["point", "link"],
            "either a point or a link is traced",
            "of a link its point is named so: at = \"P\"",
        );
        return None;
    }
    if !entry.has("link") {
        for key in ["at", "radius"] {
            entry.idle(cx, &[key], "link");
        }
        let (point, node) = entry.point(cx, "point")?;
        moves(cx, point, &node.span)?;
        return Some(Traced::Point(point));
    }
    let link = entry.link(cx, "link")?;
    let (at, node) = entry.point(cx, "at")?;
    let radius = entry.needed(cx, "radius")?;
    if link == FRAME {
        let span = &entry.get("link")?.span;
        return cx.refuse(
            "bad-choice",
            "the frame stands still: it goes through no poses",
            span,
            "name a link that moves",
        );
    }
    on_link(cx, at, link, &node.span)?;
    Some(Traced::Link { link, at, radius })
}

/// A point that the frame carries goes nowhere.
fn moves(cx: &mut Context<'_>, point: PointId, span: &Span) -> Option<()> {
    if !cx.carriers(point).contains(&FRAME) {
        return Some(());
    }
    let message = format!("`{}` is a point of the frame", cx.point_name(point));
    cx.refuse(
        "bad-choice",
        message,
        span,
        "it stands still: name a point that moves",
    )
}

fn on_link(cx: &mut Context<'_>, point: PointId, link: LinkId, span: &Span) -> Option<()> {
    if cx.carriers(point).contains(&link) {
        return Some(());
    }
    let [point, link] = [cx.point_name(point), cx.link_name(link)].map(str::to_owned);
    cx.refuse(
        "point-not-on-link",
        format!("`{point}` is not a point of `{link}`"),
        span,
        format!("name one of the points of `{link}`"),
    )
}

/// Places in brackets.
fn listed(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    node: &Node,
    turned: bool,
) -> Option<Vec<GivenPlace>> {
    let place = entry.place_of("to");
    let items = cx.array(node, &place, entry.example_of("to"))?;
    if items.len() < FEWEST {
        let message = match items.len() {
            0 => format!("{place} has no places"),
            _ => format!("{place} has one place alone"),
        };
        return cx.refuse("missing-key", message, &node.span, WORDS.few);
    }
    let mut found = Vec::new();
    for item in items {
        let values = cx.array(item, "a place", "[10, 8]")?;
        let ([x, y], angle) = match values {
            [x, y] if !turned => ([x, y], None),
            [x, y, angle] if turned => ([x, y], Some(angle)),
            _ => {
                let message = format!("a place of {place} has {} values", values.len());
                let help = match turned {
                    true => "a link is traced: write [x, y, angle]",
                    false => {
                        "write [x, y]; where the angle counts, too, name the link: link = \"coupler\", at = \"P\""
                    }
                };
                return cx.refuse("wrong-type", message, &item.span, help);
            }
        };
        let at = [x, y].map(|x| cx.scalar(x, Dimension::LENGTH));
        let angle = match angle {
            Some(node) => cx.scalar(node, Dimension::ANGLE).map(Some),
            None => Some(None),
        };
        if let ([Some(x), Some(y)], Some(angle)) = (at, angle) {
            found.push(GivenPlace {
                place: [x, y],
                angle,
                span: item.span.clone(),
            });
        }
    }
    (found.len() == items.len()).then_some(found)
}

/// Where places in brackets are met.
fn timing(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<Timing> {
    let Some(node) = entry.get("timing") else {
        return Some(Timing::Ordered);
    };
    let Some((drive, dimension, name, values)) = timed_by(cx, entry, node)? else {
        return word(cx, entry);
    };
    let items = cx.array(values, &entry.place_of("timing"), "[30, 45, 60]")?;
    let values: Vec<Option<Scalar>> = items
        .iter()
        .map(|item| match drive {
            Some(drive) => coordinate(cx, drive, &name, item),
            None => cx.scalar(item, dimension),
        })
        .collect();
    let values = values.into_iter().collect::<Option<Vec<_>>>()?;
    Some(Timing::At(drive, values))
}

fn word(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<Timing> {
    let word = entry.choice(cx, "timing", &TIMINGS)?;
    let index = word.unwrap_or(0);
    Some(match index {
        1 => Timing::Nearest,
        2 => Timing::Even,
        3 => Timing::ArcLength,
        _ => Timing::Ordered,
    })
}

/// The drive, or the time, that tells when places are met, with what it is called and its values; the inner `None` of a word.
#[allow(clippy::type_complexity)]
fn timed_by<'n>(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    node: &'n Node,
) -> Option<Option<(Option<DriveId>, Dimension, String, &'n Node)>> {
    if let Value::Text(_) = &node.value {
        return Some(None);
    }
    let place = entry.place_of("timing");
    let table = cx.table(node, &place, entry.example_of("timing"))?;
    let [(key, values)] = table.entries.as_slice() else {
        let message = format!("{place} names {} of drives and time", table.entries.len());
        let help = format!("name one: timing = {}", entry.example_of("timing"));
        return cx.refuse("wrong-type", message, &node.span, help);
    };
    if key.name == "time" {
        return Some(Some((None, Dimension::TIME, key.name.clone(), values)));
    }
    let Some(Meaning::Drive(i)) = cx.names.get(&key.name).map(|(meaning, _)| *meaning) else {
        let names = cx.model.drives.iter().map(|d| d.name.as_str());
        let d = cx.no_such("drive", &key.name, key.span.clone(), names.chain(["time"]));
        cx.push(d);
        return None;
    };
    let drive = cx.drives.get(i).copied().flatten()?;
    let dimension = cx.model.drives.get(drive.index())?.dimension;
    Some(Some((Some(drive), dimension, key.name.clone(), values)))
}

/// Places of a table beside the file, and when they are met.
fn from_table(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    node: &Node,
    turned: bool,
) -> Option<(Vec<GivenPlace>, Timing)> {
    let table = Entry::inner(cx, node, &node.span, entry.place_of("to"), &FIT_TABLE)?;
    let file = table.required(cx, "table")?;
    if !turned && let Some((key, _)) = table.entry("angle") {
        let help = "name the link whose angle it is: link = \"coupler\", at = \"P\"";
        let message = "a point has no angle";
        return cx.refuse("contradictory-values", message, &key.span, help);
    }
    let column = |cx: &mut Context<'_>, key: &str, dimension: Dimension| {
        let known = column_name(cx, &table, key)?;
        let (pick, span) = known.unwrap_or_else(|| (Pick::Name(key.to_owned()), file.span.clone()));
        Some(Ask {
            pick,
            span,
            dimension,
        })
    };
    let mut asks = vec![
        column(cx, "x", Dimension::LENGTH)?,
        column(cx, "y", Dimension::LENGTH)?,
    ];
    if turned {
        asks.push(column(cx, "angle", Dimension::ANGLE)?);
    }
    let timed = match entry.get("timing") {
        None => None,
        Some(node) => match timed_by(cx, entry, node)? {
            None => None,
            Some((drive, dimension, _, head)) => {
                let text = cx.text(head, &entry.place_of("timing"), "\"theta\"")?;
                Some(Column {
                    drive,
                    ask: Ask {
                        pick: Pick::Name(text.content.trim().to_owned()),
                        span: head.span.clone(),
                        dimension,
                    },
                })
            }
        },
    };
    let wanted: Vec<&Ask> = asks.iter().chain(timed.iter().map(|t| &t.ask)).collect();
    let mut columns = all_columns(cx, file, &wanted, &WORDS)?;
    let timing = match timed {
        Some(column) => {
            let values = columns.pop()?.into_iter().map(Expr::Const);
            Timing::At(column.drive, values.collect())
        }
        None => word(cx, entry)?,
    };
    let count = columns.first().map_or(0, Vec::len);
    let places = (0..count).map(|i| GivenPlace {
        place: [Expr::Const(columns[0][i]), Expr::Const(columns[1][i])],
        angle: columns.get(2).map(|angles| Expr::Const(angles[i])),
        span: file.span.clone(),
    });
    Some((places.collect(), timing))
}

/// What is given cannot hang on what is chosen.
fn known(cx: &mut Context<'_>, fit: &Fit, varied: &[ParameterId]) -> Option<()> {
    // A parameter depends on earlier ones only.
    let mut hangs = vec![false; cx.model.parameters.len()];
    for (index, parameter) in cx.model.parameters.iter().enumerate() {
        hangs[index] = varied.iter().any(|id| id.index() == index)
            || parameter.value.leaves().any(|id| hangs[id.index()]);
    }
    let mut all = fit.clone();
    let mut depends = false;
    all.visit_scalars(&mut |value| depends |= value.leaves().any(|id| hangs[id.index()]));
    match depends {
        false => Some(()),
        true => cx.refuse(
            "bad-choice",
            "what is to be fitted depends on a parameter that varies",
            &fit.span,
            "write the numbers that are given",
        ),
    }
}

/// Places that are the same say nothing of a curve.
fn apart(cx: &mut Context<'_>, entry: &Entry<'_>, fit: &Fit) -> Option<()> {
    let at = |given: &GivenPlace| -> Vec<f64> {
        let all = given.place.iter().chain(&given.angle);
        all.map(|x| cx.number(x)).collect()
    };
    let places: Vec<Vec<f64>> = fit.to.iter().map(at).collect();
    if places.iter().all(|place| *place == places[0]) {
        let place = entry.place_of("to");
        return cx.refuse(
            "same-place",
            format!("{place}: all places are the same"),
            &fit.span,
            "give a curve",
        );
    }
    if let Some(k) = (1..places.len()).find(|k| places[*k] == places[k - 1]) {
        cx.push(
            Diagnostic::warning(
                "same-place",
                format!("places {k} and {} of {} are the same", k + 1, entry.place),
            )
            .at(fit.to[k].span.clone(), "it counts twice")
            .help("leave one of them out, unless it is to weigh as two"),
        );
    }
    Some(())
}
