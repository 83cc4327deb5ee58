//! What is heavy: `gravity`, `[masses]`, and the mass of links by their shape.
//!
//! ```toml
//! gravity = [0, "-9.81 m/s^2"]        # the default; a single value acts along -y: "1.62 m/s^2", or 0 for none
//! [links]
//! crank = { A-B = 20, bar = { width = "20 mm", thickness = "5 mm", density = "7850 kg/m^3" } }
//! rod   = { B-C = 50, linear_density = "1 kg/m" }
//! [masses]
//! weight = { on = "crank", at = [-20, 0], mass = "2 kg" }
//! ```
//!
//! A bar runs between the two points of the link's first distance, or else between its first two points, and ends there;
//! its width lies in the plane. A rod is one without width. Mass, moment of inertia and centre follow the parameters.

use kempe_units::{Builtin, Dimension, Expr};

use crate::diagnostic::Diagnostic;
use crate::ids::{FRAME, LinkId, PointId, Scalar, Span};
use crate::joint::JointKind;
use crate::key_table::{BAR, MASS};
use crate::link::{Center, Inertia, LinkPoint, Place};
use crate::load::PointMass;
use crate::node::{Key, Node, Value};
use crate::read::algebra::{minus, over, place_in_xy, plus, times};
use crate::read::carrier::moving_carrier;
use crate::read::context::Context;
use crate::read::draft::Draft;
use crate::read::entry::{Entry, on_link};
use crate::read::names::is_point_name;
use crate::read::springs::plain_name;

/// A file has at most so many point masses.
const MAX: usize = 10_000;

/// Gravity outside these limits, m/s^2, is more likely a slip of units than another planet.
const LIKELY: [f64; 2] = [0.1, 100.0];

/// Reads the file's gravity.
pub(crate) fn read_gravity(cx: &mut Context<'_>, node: &Node) {
    let gravity = match &node.value {
        Value::Array(items) => match items.as_slice() {
            [x, y] => gravity_pair(cx, x, y),
            _ => {
                cx.wrong_type(node, "`gravity`", "a pair [x, y]", "[0, \"-9.81 m/s^2\"]");
                None
            }
        },
        _ => single_gravity(cx, node),
    };
    let Some([x, y]) = gravity else { return };
    let size = kempe_number::math::hypot(cx.number(&x), cx.number(&y));
    if size > 0.0 && !(LIKELY[0]..=LIKELY[1]).contains(&size) {
        let shown = kempe_units::format_digits(
            size,
            &kempe_units::Unit::parse("m/s^2").unwrap_or_else(|_| kempe_units::Unit::one()),
            6,
        );
        let unit = cx.bare_unit(Dimension::ACCELERATION).text().to_owned();
        cx.push(
            Diagnostic::warning("unlikely-size", format!("gravity of {shown}"))
                .at(
                    node.span.clone(),
                    format!("a bare number here is in {unit}"),
                )
                .help("give it a unit: gravity = [0, \"-9.81 m/s^2\"]; for none, gravity = 0"),
        );
    }
    cx.model.actions.gravity = Some([x, y]);
}

/// One value points along -y.
fn single_gravity(cx: &mut Context<'_>, node: &Node) -> Option<[Scalar; 2]> {
    let size = cx.scalar(node, Dimension::ACCELERATION)?;
    let x = cx.number(&size);
    if x < 0.0 {
        let found = cx.show(x, Dimension::ACCELERATION);
        let up = cx.show(-x, Dimension::ACCELERATION);
        cx.push(
            Diagnostic::error(
                "bad-size",
                format!("`gravity` must not be negative, found {found}"),
            )
            .at(node.span.clone(), format!("this is {found}"))
            .help(format!(
                "one value alone points down: leave the sign out, or write the pair [0, \"{found}\"]; [0, \"{up}\"] points up"
            )),
        );
        return None;
    }
    Some([Expr::Const(0.0), Expr::Neg(Box::new(size))])
}

fn gravity_pair(cx: &mut Context<'_>, x: &Node, y: &Node) -> Option<[Scalar; 2]> {
    let first = cx.scalar(x, Dimension::ACCELERATION);
    let second = cx.inferred(y, Dimension::ACCELERATION);
    let (first, (second, is)) = (first?, second?);
    if is == Dimension::ANGLE {
        let part = |function| {
            let direction = Expr::Call(function, vec![second.clone()]);
            Expr::Mul(Box::new(first.clone()), Box::new(direction))
        };
        return Some([part(Builtin::Cos), part(Builtin::Sin)]);
    }
    if is.compatible(Dimension::ACCELERATION) {
        return Some([first, second]);
    }
    cx.push(
        Diagnostic::error(
            "unit-mismatch",
            format!(
                "acceleration or angle expected, found {}",
                is.with_article()
            ),
        )
        .at(y.span.clone(), format!("this is {}", is.with_article()))
        .help("gravity is [x, y], or [size, direction]"),
    );
    None
}

/// Reads all point masses.
pub(crate) fn read(cx: &mut Context<'_>, entries: &[&(Key, Node)]) {
    for entry in cx.limited(entries, MAX, "masses") {
        plain_name(cx, &entry.0, "a mass");
        let mass = read_mass(cx, entry);
        cx.model.actions.masses.extend(mass);
    }
}

fn read_mass(cx: &mut Context<'_>, entry: &(Key, Node)) -> Option<PointMass> {
    let (key, _) = entry;
    let entry = Entry::new(cx, entry, &MASS)?;
    let mass = entry.needed(cx, "mass");
    let at = entry.required(cx, "at")?;
    let (on, place) = match &at.value {
        Value::Text(text) if is_point_name(text.content.trim()) => {
            let point = cx.point_text(text)?;
            let on = match entry.has("on") {
                true => entry.link(cx, "on"),
                false => moving_carrier(cx, point, &entry.place, &key.span),
            }?;
            on_link(cx, point, on, at)?;
            let place = cx
                .model
                .links
                .get(on.index())
                .and_then(|l| l.points.iter().find(|p| p.point == point))
                .map(|p| p.place.clone());
            (on, place)
        }
        Value::Text(_) => {
            cx.wrong_type(
                at,
                &entry.place_of("at"),
                "a point or a place",
                "at = \"B\" or at = [-20, 0]",
            );
            return None;
        }
        _ => {
            let on = entry.link(cx, "on");
            let place = cx.place(at, &entry.place_of("at"));
            (on?, place)
        }
    };
    on_the_frame(cx, on, &entry.place, &key.span);
    Some(PointMass {
        name: key.name.clone(),
        on,
        place: place?,
        mass: mass?,
        span: key.span.clone(),
    })
}

/// Warns of what acts on the frame alone.
pub(crate) fn on_the_frame(cx: &mut Context<'_>, on: LinkId, place: &str, span: &Span) {
    if on != FRAME {
        return;
    }
    cx.push(
        Diagnostic::warning(
            "idle-load",
            format!("{place} is on the frame, which stands still"),
        )
        .at(span.clone(), "moves nothing")
        .help("say on which moving link it is: on = \"crank\""),
    );
}

/// Warns of a mass of the frame.
pub(crate) fn mass_of_frame(cx: &mut Context<'_>, link: &Entry<'_>) {
    let mut keys = ["mass", "inertia", "bar", "linear_density"].iter();
    let Some((key, _)) = keys.find_map(|key| link.entry(key)) else {
        return;
    };
    cx.push(
        Diagnostic::warning("idle-load", "the frame stands still: its mass does nothing")
            .at(key.span.clone(), "moves nothing")
            .help("leave it out, or give it to a link that moves"),
    );
}

/// The mass properties of a link.
pub(crate) fn read_inertia(
    cx: &mut Context<'_>,
    link: &Entry<'_>,
    (draft, points): (&Draft, &[LinkPoint]),
    center: impl FnOnce(&mut Context<'_>, &Node) -> Option<Center>,
) -> Option<Inertia> {
    let place = &link.place;
    let shape = ["bar", "linear_density"]
        .iter()
        .find_map(|key| link.entry(key));
    if let Some((key, node)) = shape {
        let others = ["mass", "inertia", "center", "linear_density"];
        if let Some((other, _)) = others
            .iter()
            .filter_map(|k| link.entry(k))
            .find(|(k, _)| k.name != key.name)
        {
            cx.push(
                Diagnostic::error(
                    "over-specified",
                    format!("{place} has both `{}` and `{}`", key.name, other.name),
                )
                .at(other.span.clone(), "one thing too many")
                .see(key.span.clone(), "says mass, inertia and center")
                .help("leave one of the two out"),
            );
            return None;
        }
        return shaped(cx, link, (key, node), (draft, points));
    }
    let scalar = |cx: &mut Context<'_>, name: &str| link.value(cx, name).flatten();
    let (mass, moment) = (scalar(cx, "mass"), scalar(cx, "inertia"));
    if moment.is_none() && link.has("inertia") {
        // told: it is not missing
        return None;
    }
    let center = match link.entry("center") {
        None => Center::Centroid,
        Some((_, node)) => center(cx, node)?,
    };
    if !link.has("mass") && !link.has("inertia") {
        if let Some((center, _)) = link.entry("center") {
            cx.push(
                Diagnostic::warning("idle-key", format!("{place} has a center but no mass"))
                    .at(center.span.clone(), "means nothing without `mass`")
                    .help("add mass = \"1 kg\" and inertia = \"1 kg m^2\", or leave center out"),
            );
        }
        return None;
    }
    Some(Inertia {
        mass,
        moment,
        center,
    })
}

/// Mass properties of a bar or rod.
fn shaped<'d>(
    cx: &mut Context<'_>,
    link: &Entry<'d>,
    (key, node): (&Key, &'d Node),
    (draft, points): (&Draft, &[LinkPoint]),
) -> Option<Inertia> {
    let what = link.place_of(&key.name);
    let (per_length, width) = if key.name == BAR.name {
        let bar = Entry::inner(cx, node, &node.span, what.clone(), &BAR)?;
        let width = bar.needed(cx, "width");
        let thickness = bar.needed(cx, "thickness");
        let density = bar.needed(cx, "density");
        let width = width?;
        (times(times(density?, width.clone()), thickness?), width)
    } else {
        (link.needed(cx, &key.name)?, Expr::Const(0.0))
    };
    let Some(([ax, ay], [bx, by])) = ends(draft, points) else {
        // points without a place have been told
        if !draft.broken && points.len() == draft.points.len() {
            cx.push(
                Diagnostic::error("not-placed", format!("{what}: from where to where?"))
                    .at(key.span.clone(), "")
                    .help("a bar runs between the link's first two points: give their distance, A-B = 20, or their coordinates; for other shapes write mass, inertia and center"),
            );
        }
        return None;
    };
    let length = Expr::Call(Builtin::Hypot, vec![minus(&bx, &ax), minus(&by, &ay)]).fold();
    let mass = times(per_length, length.clone());
    let squares = plus(
        Expr::Powi(Box::new(length), 2),
        Expr::Powi(Box::new(width), 2),
    );
    let moment = over(times(mass.clone(), squares), Expr::Const(12.0));
    cx.finite(&mass, &node.span, Dimension::MASS)?;
    cx.finite(&moment, &node.span, Dimension::INERTIA)?;
    let middle = |a: Scalar, b: Scalar| over(plus(a, b), Expr::Const(2.0)).fold();
    Some(Inertia {
        mass: Some(mass.fold()),
        moment: Some(moment.fold()),
        center: Center::Place(Place::Cartesian {
            x: middle(ax, bx),
            y: middle(ay, by),
        }),
    })
}

/// Where a bar starts and ends: the points of the first distance, or else, and of a link that lists its points, the first two.
fn ends(draft: &Draft, points: &[LinkPoint]) -> Option<([Scalar; 2], [Scalar; 2])> {
    let named = draft.distances.first().map(|d| (d.a, d.b));
    let named = named.filter(|_| !draft.listed);
    let mut first = draft.points.iter().map(|(point, _)| *point);
    let (a, b) = match named {
        Some(pair) => pair,
        None => (first.next()?, first.next()?),
    };
    let coordinates = |point: PointId| {
        let of = points.iter().find(|p| p.point == point)?;
        place_in_xy(&of.place)
    };
    Some((coordinates(a)?, coordinates(b)?))
}

/// Warns of links that turn and have a mass but no moment of inertia.
pub(crate) fn without_inertia(cx: &mut Context<'_>) {
    if cx.joints.iter().any(Option::is_none) {
        return;
    }
    let slides_on_frame = |link: LinkId| {
        cx.model.joints.iter().any(
            |j| matches!(j.kind, JointKind::Slider { at, on, .. } if at.link == link && on.link == FRAME),
        )
    };
    let mut messages = Vec::new();
    for (i, link) in cx.model.links.iter().enumerate().skip(1) {
        let Some(Inertia {
            mass: Some(mass),
            moment: None,
            ..
        }) = &link.inertia
        else {
            continue;
        };
        if cx.number(mass) > 0.0 && !slides_on_frame(LinkId(i as u32)) {
            messages.push((link.name.clone(), link.span.clone()));
        }
    }
    for (name, span) in messages {
        cx.push(
            Diagnostic::warning(
                "no-inertia",
                format!("link `{name}` has a mass but no moment of inertia"),
            )
            .at(span, "counts as a point mass at its center")
            .help("add inertia = \"0.01 kg m^2\" about the center of mass; inertia = 0 says that it is a point mass"),
        );
    }
}
