//! Where a pin leaves the ends of its curved slot: the motion goes on along the slot's circle or the cubic of its end, the
//! part would not.

use kempe_mechanism::curve::LocalCurve;
use kempe_model::{
    CircularArc, Diagnostic, Joint, JointKind, LinkPointRef, Model, PointId, SmoothCurve, value,
};
use kempe_number::math::{atan2, hypot, sin_cos};
use kempe_number::text::significant;
use kempe_units::Dimension;

use crate::force_notes::place;
use crate::result::Frame;
use crate::table::Table;
use crate::unit::Units;

/// A pin this little, in radii or in lengths of the slot, beyond the end of its slot stands at it.
const AT_END: f64 = 1e-9;

/// What to do about it.
pub(crate) const MOVE_ENDS: &str =
    "move the ends of the slot apart, or say `closed = true` where it goes all the way round";

/// Whether a pin can leave a curved slot at all.
pub(crate) fn has_ends(model: &Model) -> bool {
    model.joints.iter().any(|joint| match &joint.kind {
        JointKind::ArcSlot { on, .. } => !on.closed,
        JointKind::CurveSlot { on, .. } => !on.closed,
        _ => false,
    })
}

/// How far the pin of a curved slot is beyond its ends, m, where the points of the model are in these places: not above zero between them,
/// `None` of another joint or without a pose.
pub(crate) fn past(joint: &Joint, parameters: &[f64], points: &[[f64; 2]]) -> Option<f64> {
    match &joint.kind {
        JointKind::ArcSlot { pin, on } if !on.closed => {
            let radius = value(&on.radius, parameters);
            Some(past_ends(points, *pin, on, radius)? - AT_END * radius)
        }
        JointKind::CurveSlot { pin, on } if !on.closed => past_curve(points, *pin, on),
        _ => None,
    }
}

/// The same; `None` between the ends, too.
fn beyond(joint: &Joint, parameters: &[f64], points: &[[f64; 2]]) -> Option<f64> {
    past(joint, parameters, points).filter(|far| *far > 0.0)
}

/// The point that runs in a curved slot.
pub(crate) fn pin_of(joint: &Joint) -> Option<PointId> {
    match &joint.kind {
        JointKind::ArcSlot { pin, .. } | JointKind::CurveSlot { pin, .. } => Some(pin.point),
        _ => None,
    }
}

pub(crate) fn length(units: &Units, si: f64) -> String {
    let unit = units.unit(Dimension::LENGTH);
    let value = significant(unit.from_si(si), 3);
    format!("{value} {}", unit.text())
}

/// What is to be told where the points of a model are in these places: which pins are beyond the ends of their curved slots.
pub fn slot_note(model: &Model, parameters: &[f64], points: &[[f64; 2]]) -> Option<String> {
    let notes = model.joints.iter().filter_map(|joint| {
        let far = beyond(joint, parameters, points)?;
        let point = model.points.get(pin_of(joint)?.index())?;
        let far = length(&Units::of(model), far);
        Some(format!(
            "{} is beyond the end of the curved slot `{}`, by {far}",
            point.name, joint.name
        ))
    });
    let notes: Vec<String> = notes.collect();
    (!notes.is_empty()).then(|| notes.join("; "))
}

/// In how many of these places the pin of a curved slot is beyond its ends.
pub(crate) fn rows_beyond(joint: &Joint, parameters: &[f64], frames: &[Frame]) -> usize {
    let beyond = |frame: &&Frame| beyond(joint, parameters, &frame.points).is_some();
    frames.iter().filter(beyond).count()
}

/// A warning for each curved slot whose pin is beyond its ends in some row, with where it is farthest.
pub(crate) fn left_slots(
    model: &Model,
    parameters: &[f64],
    (frames, table): (&[Frame], &Table),
    along: usize,
) -> Vec<Diagnostic> {
    let units = Units::of(model);
    let warnings = model.joints.iter().filter_map(|joint| {
        let rows = frames.iter().enumerate();
        let beyond: Vec<(usize, f64)> = rows
            .filter_map(|(row, frame)| Some((row, beyond(joint, parameters, &frame.points)?)))
            .collect();
        let (row, far) = *beyond.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let point = model.points.get(pin_of(joint)?.index())?;
        Some(
            Diagnostic::warning(
                "leaves-slot",
                format!(
                    "study `{}`: {} leaves the curved slot `{}` in {} of {} rows, farthest at {}, by {}",
                    table.name,
                    point.name,
                    joint.name,
                    beyond.len(),
                    table.rows(),
                    place(table, along, row),
                    length(&units, far)
                ),
            )
            .at(joint.span.clone(), "")
            .help(MOVE_ENDS),
        )
    });
    warnings.collect()
}

/// How far a pin is from the nearest place of its slot, m, where it has left that, and the negative distance of the nearer end in it; `None`
/// without a pose.
fn past_curve(places: &[[f64; 2]], pin: LinkPointRef, on: &SmoothCurve) -> Option<f64> {
    let at = |point: PointId| places.get(point.index()).copied();
    let points: Vec<[f64; 2]> = on.through.iter().map(|p| at(*p)).collect::<Option<_>>()?;
    let pin = at(pin.point)?;
    let apart = |a: &[f64; 2], b: &[f64; 2]| hypot(b[0] - a[0], b[1] - a[1]);
    let length: f64 = points
        .windows(2)
        .map(|ends| apart(&ends[0], &ends[1]))
        .sum();
    let far = LocalCurve::through(&points, on.closed).distance(pin) - AT_END * length;
    let ends = [points.first()?, points.last()?].map(|end| apart(end, &pin));
    let past = if far > 0.0 {
        far
    } else {
        -ends[0].min(ends[1])
    };
    past.is_finite().then_some(past)
}

/// How far along its circle a pin is beyond the end of a slot that is nearer, m; negative between the ends, `None` without a pose.
fn past_ends(places: &[[f64; 2]], pin: LinkPointRef, on: &CircularArc, radius: f64) -> Option<f64> {
    let at = |point: PointId| places.get(point.index()).copied();
    let (a, b, p) = (at(on.from)?, at(on.to)?, at(pin.point)?);
    let half = [0.5 * (b[0] - a[0]), 0.5 * (b[1] - a[1])];
    let reach = hypot(half[0], half[1]);
    let rise = (radius * radius - reach * reach).max(0.0).sqrt();
    // Seen from the centre, the slot's middle lies away from the side on which the centre is.
    let out = [half[1] * on.side.sign(), -half[0] * on.side.sign()].map(|x| x / reach);
    let center = [0, 1].map(|i| a[i] + half[i] - out[i] * rise);
    let middle = atan2(out[1], out[0]);
    let off = atan2(p[1] - center[1], p[0] - center[0]) - middle;
    let (s, c) = sin_cos(off);
    let off = atan2(s, c).abs();
    let spread = atan2(reach, rise);
    let past = off - spread;
    past.is_finite().then_some(past * radius)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    use kempe_model::{LinkId, PointId, Side};
    use kempe_units::Expr;

    #[test]
    fn beyond_and_between_the_ends() {
        let arc = |side| CircularArc {
            link: LinkId(0),
            from: PointId(0),
            to: PointId(1),
            radius: Expr::Const(2.0_f64.sqrt()),
            side,
            closed: false,
        };
        let pin = LinkPointRef {
            link: LinkId(1),
            point: PointId(2),
        };
        let past = |p: [f64; 2], side| {
            let places = [[1.0, 0.0], [-1.0, 0.0], p];
            past_ends(&places, pin, &arc(side), 2.0_f64.sqrt()).map(|far| far / 2.0_f64.sqrt())
        };
        // From (1, 0) to (-1, 0) the left is below: centre (0, -1), the slot's middle on top.
        let top = [0.0, 2.0_f64.sqrt() - 1.0];
        assert!((past(top, Side::Left).unwrap_or(f64::NAN) + PI / 4.0).abs() < 1e-12);
        let right = [2.0_f64.sqrt(), -1.0];
        assert!((past(right, Side::Left).unwrap_or(f64::NAN) - PI / 4.0).abs() < 1e-12);
        assert!((past([1.0, 0.0], Side::Left).unwrap_or(f64::NAN)).abs() < 1e-12);
        // The other way round the centre is above.
        let bottom = [0.0, 1.0 - 2.0_f64.sqrt()];
        assert!((past(bottom, Side::Right).unwrap_or(f64::NAN) + PI / 4.0).abs() < 1e-12);
        assert!(past([f64::NAN; 2], Side::Left).is_none());
    }
}
