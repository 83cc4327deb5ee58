//! `oil` of `[cylinders]`: what moves a cylinder whose drive is let go.
//!
//! ```toml
//! [cylinders.lift]
//! bore   = "80 mm"
//! rod    = "50 mm"
//! supply = "160 bar"
//! oil    = { bulk_modulus = "14000 bar", volume = ["1 L", "1 L"], valve = 0.5, flow = "40 L/min", drop = "35 bar" }
//! ```
//!
//! The openings of the valve may go by measures of the motion, which are read later: see `controls.rs`.

use kempe_units::Expr;

use crate::amount::Amount;
use crate::diagnostic::Diagnostic;
use crate::ids::Scalar;
use crate::key_table::OIL;
use crate::keys::Sign;
use crate::oil::Oil;
use crate::read::context::Context;
use crate::read::entry::Entry;

/// The oil of a cylinder, if it is told, its valve shut; the outer `None` when it is wrong.
pub(crate) fn read(
    cx: &mut Context<'_>,
    cylinder: &Entry<'_>,
    supplied: bool,
) -> Option<Option<Oil>> {
    let Some(entry) = entry(cx, cylinder)? else {
        return Some(None);
    };
    let bulk_modulus = entry.needed(cx, "bulk_modulus");
    let hose_modulus = entry.value(cx, "hose_modulus");
    let wall_modulus = entry.value(cx, "wall_modulus");
    let volume = entry.required(cx, "volume");
    let volume = volume.and_then(|_| both(cx, &entry, "volume", Sign::Positive)?);
    let valve = entry.required(cx, "valve");
    let flow = entry.needed(cx, "flow");
    let drop = entry.needed(cx, "drop");
    let stroke = stroke(cx, &entry);
    let damping = entry.value_or(cx, "damping", 0.0);
    let leakage = entry.value_or(cx, "leakage", 0.0);
    let start = both(cx, &entry, "start", Sign::Any);
    entry.idle(cx, &["wall_modulus"], "stroke");
    if !supplied {
        let place = &cylinder.place;
        cx.push(
            Diagnostic::error("missing-key", format!("{place} has `oil` and no `supply`"))
                .at(cylinder.span.clone(), "`supply` is missing")
                .help("add the pressure that feeds its valve: supply = \"180 bar\""),
        );
    }
    valve?;
    Some(Some(Oil {
        bulk_modulus: bulk_modulus?,
        hose_modulus: hose_modulus?,
        wall_modulus: wall_modulus?,
        volume: volume?,
        stroke: stroke?,
        valve: (Amount::Measure(Expr::Const(0.0)), None),
        flow: flow?,
        drop: drop?,
        damping: damping?,
        leakage: leakage?,
        start: start?,
    }))
    .filter(|_| supplied)
}

/// The table of a cylinder's oil, if it has one.
fn entry<'d>(cx: &mut Context<'_>, cylinder: &Entry<'d>) -> Option<Option<Entry<'d>>> {
    let Some((key, node)) = cylinder.entry("oil") else {
        return Some(None);
    };
    let place = format!("{} {}", OIL.what, cylinder.place);
    Entry::inner(cx, node, &key.span, place, &OIL).map(Some)
}

/// Two values, of both sides, that may be given.
fn both(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    key: &str,
    sign: Sign,
) -> Option<Option<[Scalar; 2]>> {
    let Some(node) = entry.get(key) else {
        return Some(None);
    };
    let (bore, ring) = entry.two(cx, node, key)?;
    let [bore, ring] = [bore, ring].map(|node| entry.signed(cx, key, node, sign));
    Some(Some([bore?, ring?]))
}

/// The length with the rod in and the stroke, one of which does not go without the other.
fn stroke(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<Option<[Scalar; 2]>> {
    let (closed, stroke) = (entry.value(cx, "closed"), entry.value(cx, "stroke"));
    match (closed?, stroke?) {
        (Some(closed), Some(stroke)) => Some(Some([closed, stroke])),
        (None, None) => Some(None),
        (closed, _) => {
            let lacks = if closed.is_some() { "stroke" } else { "closed" };
            entry.required(cx, lacks)?;
            None
        }
    }
}
