//! The class II groups with sliders, slots and cylinders: where two loci meet, and which way a body then points.

use kempe_number::Number;

use crate::branch::Branch;
use crate::closed_form::{Locus, direction, meet, reach_locus};
use crate::configuration::Configuration;
use crate::design::Design;
use crate::ids::Marker;
use crate::plan_number::in_place;
use crate::pose::{Pose, add, cross, dot, left, sub};
use crate::step::{Carrier, Condition, Reach, Swing, SwingLine};

/// What a condition says about the point its carrier holds. The carrier's angle must be known.
///
/// Called for numbers that need not be compiled into their caller: it is the larger part of two kinds of steps.
#[cfg_attr(not(debug_assertions), inline(always))]
fn locus_of<T: Number, const ALL: bool>(
    design: &Design<T>,
    branch: &Branch,
    state: &Configuration<T>,
    carrier: Carrier,
    condition: Condition,
) -> Locus<T> {
    // Larger numbers' steps are called themselves: nothing is gained by a copy for each of them.
    match const { T::IN_LANES && in_place::<T, ALL>() || size_of::<T>() == size_of::<f64>() } {
        true => locus_in_place::<T, ALL>(design, branch, state, carrier, condition),
        false => locus_called::<T, ALL>(design, branch, state, carrier, condition),
    }
}

#[inline(never)]
fn locus_called<T: Number, const ALL: bool>(
    design: &Design<T>,
    branch: &Branch,
    state: &Configuration<T>,
    carrier: Carrier,
    condition: Condition,
) -> Locus<T> {
    locus_in_place::<T, ALL>(design, branch, state, carrier, condition)
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn locus_in_place<T: Number, const ALL: bool>(
    design: &Design<T>,
    branch: &Branch,
    state: &Configuration<T>,
    carrier: Carrier,
    condition: Condition,
) -> Locus<T> {
    let geometry = &design.geometry;
    let pose = &state.poses[carrier.body.index()];
    let pin = carrier
        .pin
        .map_or([T::zero(); 2], |pin| geometry.marker(pin));
    match condition {
        Condition::OnLine { own, line }
        | Condition::BesideLine { own, line, .. }
        | Condition::TravelOn { own, line, .. } => {
            let (origin, along) = state.placed_line(design, line);
            let from = sub(origin, pose.turn(sub(geometry.marker(own), pin)));
            on_line(state, condition, along, from)
        }
        Condition::Through { line, point }
        | Condition::LineBeside { line, point, .. }
        | Condition::TravelThrough { line, point, .. } => {
            let local = geometry.line(line);
            let along = pose.turn(local.direction);
            let from = sub(
                place(design, state, point),
                pose.turn(sub(local.origin, pin)),
            );
            match condition {
                Condition::TravelThrough { input, .. } => {
                    Locus::Line(along, dot(along, from) - state.inputs[input.index()].value)
                }
                Condition::LineBeside { input, .. } => {
                    let off = state.inputs[input.index()].value;
                    Locus::Line(left(along), dot(left(along), from) - off)
                }
                _ => Locus::Line(left(along), dot(left(along), from)),
            }
        }
        Condition::Roll { .. } if ALL => rolling(design, branch, state, carrier, condition),
        Condition::Roll { .. } => Locus::Line([T::zero(); 2], T::from_f64(f64::NAN)),
        Condition::OnArc { own, arc } => {
            let circle = geometry.arc(arc);
            let center = state.poses[arc.body.index()].place(circle.center);
            let from = sub(center, pose.turn(sub(geometry.marker(own), pin)));
            Locus::Circle(from, circle.radius)
        }
        Condition::ArcThrough { arc, point } => {
            let circle = geometry.arc(arc);
            let to = sub(
                place(design, state, point),
                pose.turn(sub(circle.center, pin)),
            );
            Locus::Circle(to, circle.radius)
        }
        Condition::Radius { own, center, input } => {
            let center = sub(
                place(design, state, center),
                pose.turn(sub(geometry.marker(own), pin)),
            );
            Locus::Circle(center, state.inputs[input.index()].value)
        }
    }
}

/// What a pinion on a carrier's pitch line says. Racks count turns, pose by pose: nothing is gained by compiling this in
/// place.
#[inline(never)]
fn rolling<T: Number>(
    design: &Design<T>,
    branch: &Branch,
    state: &Configuration<T>,
    carrier: Carrier,
    condition: Condition,
) -> Locus<T> {
    let Condition::Roll {
        line,
        center,
        constants,
    } = condition
    else {
        return Locus::Line([T::zero(); 2], T::from_f64(f64::NAN));
    };
    let geometry = &design.geometry;
    let pose = &state.poses[carrier.body.index()];
    let pin = carrier
        .pin
        .map_or([T::zero(); 2], |pin| geometry.marker(pin));
    let local = geometry.line(line);
    let along = pose.turn(local.direction);
    let from = sub(
        place(design, state, center),
        pose.turn(sub(local.origin, pin)),
    );
    let k = &geometry.gears[constants as usize];
    let situation = state.situation(design, branch);
    let roll = k.second * (situation.angle(center.body) - situation.angle(line.body));
    Locus::Line(along, dot(along, from) + roll - k.constant)
}

/// A point on the line through `from` along `along`, or with the drive's coordinate along it or beside it.
#[cfg_attr(not(debug_assertions), inline(always))]
fn on_line<T: Number>(
    state: &Configuration<T>,
    condition: Condition,
    along: [T; 2],
    from: [T; 2],
) -> Locus<T> {
    match condition {
        Condition::TravelOn { input, .. } => {
            Locus::Line(along, dot(along, from) + state.inputs[input.index()].value)
        }
        Condition::BesideLine { input, .. } => {
            let off = state.inputs[input.index()].value;
            Locus::Line(left(along), dot(left(along), from) + off)
        }
        _ => Locus::Line(left(along), dot(left(along), from)),
    }
}

/// Places a translating body by the point it carries.
#[cfg_attr(not(debug_assertions), inline(always))]
fn carry<T: Number>(design: &Design<T>, state: &mut Configuration<T>, carrier: Carrier, x: [T; 2]) {
    let pin = carrier
        .pin
        .map_or([T::zero(); 2], |pin| design.geometry.marker(pin));
    let pose = &mut state.poses[carrier.body.index()];
    *pose = Pose::pinned(pose.c, pose.s, pin, x);
}

/// A point from two conditions on translating bodies.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn cross_loci<T: Number, const ALL: bool>(
    design: &Design<T>,
    branch: &Branch,
    state: &mut Configuration<T>,
    (carriers, conditions): (&[Carrier; 2], &[Condition; 2]),
    sign: f64,
) -> T {
    let mut loci = [Locus::Line([T::zero(); 2], T::zero()); 2];
    for (locus, (carrier, condition)) in loci.iter_mut().zip(carriers.iter().zip(conditions)) {
        *locus = locus_of::<T, ALL>(design, branch, state, *carrier, *condition);
    }
    let (x, determinant) = meet(loci[0], loci[1], sign);
    for carrier in carriers {
        carry(design, state, *carrier, x);
    }
    determinant
}

/// A body pinned to a placed point, its angle from a condition on its tip. The placed point is `off` from its marker.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn swing<T: Number, const ALL: bool>(
    design: &Design<T>,
    branch: &Branch,
    state: &mut Configuration<T>,
    step: &Swing,
    sign: f64,
    off: Option<[T; 2]>,
) -> T {
    match const { in_place::<T, ALL>() } {
        true => swing_in_place::<T, ALL>(design, branch, state, step, sign, off),
        false => swing_called::<T, ALL>(design, branch, state, step, sign, off),
    }
}

/// One copy for the step and for the same with its pins open.
#[inline(never)]
fn swing_called<T: Number, const ALL: bool>(
    design: &Design<T>,
    branch: &Branch,
    state: &mut Configuration<T>,
    step: &Swing,
    sign: f64,
    off: Option<[T; 2]>,
) -> T {
    swing_in_place::<T, ALL>(design, branch, state, step, sign, off)
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn swing_in_place<T: Number, const ALL: bool>(
    design: &Design<T>,
    branch: &Branch,
    state: &mut Configuration<T>,
    step: &Swing,
    sign: f64,
    off: Option<[T; 2]>,
) -> T {
    let Swing {
        own,
        at,
        tip,
        condition,
        partner,
    } = *step;
    let mut center = place(design, state, at);
    if let Some(off) = off {
        center = add(center, off);
    }
    let pin = design.geometry.marker(own);
    let tip = match (partner, condition) {
        (None, Condition::ArcThrough { arc, .. }) => design.geometry.arc(arc).center,
        _ => design.geometry.marker(tip),
    };
    let arm = sub(tip, pin);
    let square = dot(arm, arm);
    // On the body itself the condition acts at the tip, whatever the body's angle.
    let locus = match (partner, condition) {
        (Some(carrier), _) => locus_of::<T, ALL>(design, branch, state, carrier, condition),
        (None, Condition::Radius { center, input, .. }) => Locus::Circle(
            place(design, state, center),
            state.inputs[input.index()].value,
        ),
        (
            None,
            Condition::OnLine { line, .. }
            | Condition::BesideLine { line, .. }
            | Condition::TravelOn { line, .. },
        ) => {
            let (origin, along) = state.placed_line(design, line);
            on_line(state, condition, along, origin)
        }
        (None, Condition::OnArc { arc, .. }) => {
            let circle = design.geometry.arc(arc);
            let center = state.poses[arc.body.index()].place(circle.center);
            Locus::Circle(center, circle.radius)
        }
        (None, Condition::ArcThrough { arc, point }) => {
            Locus::Circle(place(design, state, point), design.geometry.arc(arc).radius)
        }
        // Conditions with a line of the swinging body are `SwingLine`s.
        (
            None,
            Condition::Through { .. }
            | Condition::LineBeside { .. }
            | Condition::TravelThrough { .. }
            | Condition::Roll { .. },
        ) => {
            return T::from_f64(f64::NAN);
        }
    };
    let (reach, h) = reach_locus(center, square.sqrt(), locus, sign);
    let [c, s] = direction(arm, reach, square);
    state.poses[own.body.index()] = Pose::pinned(c, s, pin, center);
    if let Some(carrier) = partner {
        carry(
            design,
            state,
            carrier,
            [center[0] + reach[0], center[1] + reach[1]],
        );
    }
    h
}

/// A body pinned to a placed point, one of its lines through another. The placed points are `off` from their markers.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn swing_line<T: Number, const ALL: bool>(
    design: &Design<T>,
    state: &mut Configuration<T>,
    step: &SwingLine,
    sign: f64,
    off: Option<[[T; 2]; 2]>,
) -> T {
    match const { in_place::<T, ALL>() } {
        true => swing_line_in_place::<T>(design, state, step, sign, off),
        false => swing_line_called::<T>(design, state, step, sign, off),
    }
}

/// One copy for the step and for the same with its pins open.
#[inline(never)]
fn swing_line_called<T: Number>(
    design: &Design<T>,
    state: &mut Configuration<T>,
    step: &SwingLine,
    sign: f64,
    off: Option<[[T; 2]; 2]>,
) -> T {
    swing_line_in_place::<T>(design, state, step, sign, off)
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn swing_line_in_place<T: Number>(
    design: &Design<T>,
    state: &mut Configuration<T>,
    step: &SwingLine,
    sign: f64,
    off: Option<[[T; 2]; 2]>,
) -> T {
    let SwingLine {
        own,
        at,
        toward,
        reach,
        partner,
    } = *step;
    let geometry = &design.geometry;
    let (mut center, mut far) = (place(design, state, at), place(design, state, toward));
    if let Some([at, toward]) = off {
        (center, far) = (add(center, at), add(far, toward));
    }
    let pin = geometry.marker(own);
    let v = sub(far, center);
    // Turn of the partner against the body, as a unit vector.
    let relative = partner.map(|p| {
        let by = state.turn_by(design, p.offset, p.input, p.reversed);
        Pose {
            x: T::zero(),
            y: T::zero(),
            c: by[0],
            s: by[1],
        }
    });
    let outer = partner.map_or([T::zero(); 2], |p| geometry.marker(p.outer));
    let relative = relative.unwrap_or(Pose::identity());
    // Seen from the body, `v` has this known projection on this unit vector.
    let (unit, k) = match reach {
        Reach::Line { line } => {
            let local = geometry.line(line);
            let n = left(local.direction);
            (n, dot(n, sub(local.origin, pin)))
        }
        Reach::Travel { line, input } => {
            let local = geometry.line(line);
            (
                local.direction,
                state.inputs[input.index()].value + dot(local.direction, sub(local.origin, pin)),
            )
        }
        Reach::PartnerPoint { line, point } => {
            let local = geometry.line(line);
            let n = left(local.direction);
            let lever = relative.turn(sub(geometry.marker(point), outer));
            (n, dot(n, sub(local.origin, pin)) - dot(n, lever))
        }
        Reach::PartnerLine { point, line } => {
            let local = geometry.line(line);
            let n = relative.turn(left(local.direction));
            let origin = relative.turn(sub(local.origin, outer));
            (n, dot(n, sub(geometry.marker(point), pin)) - dot(n, origin))
        }
    };
    let square = dot(v, v);
    let (seen, h) = crate::closed_form::with_projection(unit, k, square, sign);
    // The body sees `v` as `seen`: its direction is v / seen.
    let (c, s) = (dot(seen, v) / square, cross(seen, v) / square);
    let pose = Pose::pinned(c, s, pin, center);
    state.poses[own.body.index()] = pose;
    if let Some(sliding) = partner {
        let [c, s] = pose.turn([relative.c, relative.s]);
        state.poses[sliding.outer.body.index()] = Pose::pinned(c, s, outer, far);
    }
    h
}

/// A marker in the frame.
#[cfg_attr(not(debug_assertions), inline(always))]
fn place<T: Number>(design: &Design<T>, state: &Configuration<T>, marker: Marker) -> [T; 2] {
    state.poses[marker.body.index()].place(design.geometry.marker(marker))
}

/// Places a body by two pins, `(own, at)`, to placed points that are `off` from their markers.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn pin_twice<T: Number>(
    design: &Design<T>,
    state: &mut Configuration<T>,
    [(a, at_a), (b, at_b)]: [(Marker, Marker); 2],
    off: Option<[[T; 2]; 2]>,
) -> T {
    let (mut wa, mut wb) = (state.place(design, at_a), state.place(design, at_b));
    if let Some([a, b]) = off {
        (wa, wb) = (add(wa, a), add(wb, b));
    }
    let seen = sub(wb, wa);
    let own = sub(design.geometry.marker(b), design.geometry.marker(a));
    let [c, s] = direction(own, seen, (dot(own, own) * dot(seen, seen)).sqrt());
    state.poses[a.body.index()] = Pose::pinned(c, s, design.geometry.marker(a), wa);
    T::one()
}
