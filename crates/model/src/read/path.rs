//! Studies that ask for linkages of which a point goes through points.
//!
//! ```toml
//! [studies.trace]
//! kind   = "synthesize"
//! task   = "path"
//! points = [[0, 0], [10, 8], [25, 12], [40, 10], [52, 2]]
//! crank  = { fixed = [0, -20] }
//! rocker = { fixed = [40, -25] }
//! ```

use kempe_units::{Dimension, Expr};

use crate::ids::Scalar;
use crate::key_table::synthesis::POINT_TABLE;
use crate::node::{Node, Value};
use crate::read::context::Context;
use crate::read::csv::{Ask, Pick, Words, all_columns};
use crate::read::entry::Entry;
use crate::read::guidance::{corners, dyad};
use crate::read::law_table::column_name;
use crate::synthesis::{PathTask, WantedPoint};

/// The fewest points between which a path is asked for.
const FEWEST: usize = 3;

const WORDS: Words = Words {
    not_rising: None,
    order: "rows are points in their order",
    least: FEWEST,
    few: "a path has at least three points",
};

pub(crate) fn read(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<PathTask> {
    let of_dyad: (&[&str], &str) = (&["along"], "a four-bar has no guide");
    let crank = dyad(cx, entry, "crank", of_dyad);
    let rocker = dyad(cx, entry, "rocker", of_dyad);
    let pivots_in = corners(cx, entry, "pivots_in");
    let angles = angles(cx, entry);
    let cognates = match entry.has("cognates") {
        true => entry.flag(cx, "cognates"),
        false => Some(false),
    };
    let node = entry.required(cx, "points")?;
    let points = match &node.value {
        Value::Table(_) => from_table(cx, entry, node),
        _ => points(cx, entry, node),
    };
    let (points, angles) = (points?, angles?);
    if let (Some(angles), Some(node)) = (&angles, entry.get("angles"))
        && angles.len() != points.len()
    {
        let message = format!(
            "{} points and {} angles of the crank",
            points.len(),
            angles.len()
        );
        let help = "give an angle for each point, in their order";
        return cx.refuse("contradictory-values", message, &node.span, help);
    }
    let turned = points.iter().any(|point| point.angle.is_some());
    if let (Some(true), Some(node)) = (cognates, entry.get("cognates"))
        && (angles.is_some() || turned)
    {
        return cx.refuse(
            "contradictory-values",
            "angles are those of one four-bar: its cognates turn otherwise",
            &node.span,
            "leave out `cognates`, or the angles",
        );
    }
    Some(PathTask {
        points,
        angles,
        cognates: cognates?,
        dyads: [crank?, rocker?],
        pivots_in: pivots_in?,
        span: node.span.clone(),
    })
}

fn points(cx: &mut Context<'_>, entry: &Entry<'_>, node: &Node) -> Option<Vec<WantedPoint>> {
    let place = entry.place_of("points");
    let items = cx.array(node, &place, entry.example_of("points"))?;
    let mut found = Vec::new();
    for point in items {
        let values = cx.array(point, "a point", "[10, 8]")?;
        let ([x, y], angle) = match values {
            [x, y] => ([x, y], None),
            [x, y, angle] => ([x, y], Some(angle)),
            _ => {
                let message = format!("a point of {place} has {} values", values.len());
                let help = "write [x, y], or [x, y, angle] with the coupler's angle there";
                return cx.refuse("wrong-type", message, &point.span, help);
            }
        };
        let at = [x, y].map(|x| cx.scalar(x, Dimension::LENGTH));
        let angle = match angle {
            Some(node) => cx.scalar(node, Dimension::ANGLE).map(Some),
            None => Some(None),
        };
        if let ([Some(x), Some(y)], Some(angle)) = (at, angle) {
            found.push(WantedPoint {
                place: [x, y],
                angle,
                span: point.span.clone(),
            });
        }
    }
    if items.len() < FEWEST {
        let message = format!("{place} are {}", items.len());
        return cx.refuse(
            "missing-key",
            message,
            &node.span,
            "a path has at least three points",
        );
    }
    (found.len() == items.len()).then_some(found)
}

fn from_table(cx: &mut Context<'_>, entry: &Entry<'_>, node: &Node) -> Option<Vec<WantedPoint>> {
    let table = Entry::inner(cx, node, &node.span, entry.place_of("points"), &POINT_TABLE)?;
    let file = table.required(cx, "table")?;
    let mut column = |key: &str| {
        let known = column_name(cx, &table, key)?;
        let (pick, span) = known.unwrap_or_else(|| (Pick::Name(key.to_owned()), file.span.clone()));
        Some(Ask {
            pick,
            span,
            dimension: Dimension::LENGTH,
        })
    };
    let (x, y) = (column("x")?, column("y")?);
    let columns = all_columns(cx, file, &[&x, &y], &WORDS)?;
    let [x, y] = &columns[..] else {
        return None;
    };
    let points = x.iter().zip(y).map(|(x, y)| WantedPoint {
        place: [Expr::Const(*x), Expr::Const(*y)],
        angle: None,
        span: file.span.clone(),
    });
    Some(points.collect())
}

/// The crank's angles; the outer `None` where they are wrong.
fn angles(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<Option<Vec<Scalar>>> {
    let Some(node) = entry.get("angles") else {
        return Some(None);
    };
    let items = cx.array(node, &entry.place_of("angles"), entry.example_of("angles"))?;
    let angles: Vec<Option<Scalar>> = items
        .iter()
        .map(|item| cx.scalar(item, Dimension::ANGLE))
        .collect();
    angles.into_iter().collect::<Option<Vec<_>>>().map(Some)
}
