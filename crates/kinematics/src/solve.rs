//! Running a plan: from drive coordinates to poses.

use kempe_model::DriveId;
use kempe_number::Number;

use crate::closed_form::{DYAD_CONSTANTS, Locus, direction, dyad, meet, reach_locus};
use crate::constraint::Situation;
use crate::geometry::Geometry;
use crate::mechanism::{BodyId, Constraint, LineRef, Marker, Mechanism, Spot};
use crate::newton::PlanNumber;
use crate::plan::{Carrier, Condition, Plan, Reach, Sliding, Step};
use crate::pose::{Pose, cross, dot, left, sub};
use crate::state::{Branch, Design, State};

impl Plan {
    /// Finds the pose for the drive coordinates in `state.inputs` on the given branch: fills `state.poses` and
    /// `state.determinants`. Where the mechanism cannot be assembled the poses become NaN (empty for intervals).
    ///
    /// Allocates nothing.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn solve<T: PlanNumber>(
        &self,
        mechanism: &Mechanism,
        design: &Design<T>,
        branch: &Branch,
        state: &mut State<T>,
    ) {
        for (index, &sign) in branch.signs.iter().enumerate() {
            self.solve_step(index, sign, mechanism, design, branch, state);
        }
    }

    /// Solves one step with the given assembly mode; the steps before it must have been solved.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn solve_step<T: PlanNumber>(
        &self,
        index: usize,
        sign: f64,
        mechanism: &Mechanism,
        design: &Design<T>,
        branch: &Branch,
        state: &mut State<T>,
    ) {
        let determinant = match self.steps[index] {
            Step::Turn {
                body,
                from,
                offset,
                input,
                reversed,
            } => {
                let by = turn_by(design, state, offset, input, reversed);
                let [c, s] = match from {
                    BodyId::GROUND => by,
                    _ => state.poses[from.index()].turn(by),
                };
                let pose = &mut state.poses[body.index()];
                (pose.c, pose.s) = (c, s);
                T::one()
            }
            Step::Pin { own, at } => {
                let world = place(design, state, at);
                let pose = &mut state.poses[own.body.index()];
                *pose = pinned(design, own, [pose.c, pose.s], world);
                T::one()
            }
            Step::Dyad {
                outer_a,
                at_a,
                inner_a,
                outer_b,
                at_b,
                inner_b,
                constants,
            } => {
                let (wa, wb) = (place(design, state, at_a), place(design, state, at_b));
                let k = &design.constants[constants..constants + DYAD_CONSTANTS];
                let (da, db, h) = dyad(k, sub(wb, wa), sign);
                let a = direction_by([k[0], k[1]], da, (outer_a, inner_a));
                let b = direction_by([k[2], k[3]], db, (outer_b, inner_b));
                state.poses[inner_a.body.index()] = pinned(design, outer_a, a, wa);
                state.poses[inner_b.body.index()] = pinned(design, outer_b, b, wb);
                h
            }
            Step::Swing {
                own,
                at,
                tip,
                condition,
                partner,
            } => swing(
                design,
                branch,
                state,
                (own, at, tip),
                condition,
                partner,
                sign,
            ),
            Step::SwingLine {
                own,
                at,
                toward,
                reach,
                partner,
            } => swing_line(design, state, (own, at, toward), reach, partner, sign),
            Step::Cross {
                carriers,
                conditions,
            } => {
                let loci = [0, 1].map(|k| locus(design, branch, state, carriers[k], conditions[k]));
                let (x, determinant) = meet(loci[0], loci[1], sign);
                for carrier in carriers {
                    carry(design, state, carrier, x);
                }
                determinant
            }
            Step::TwoPins { a, at_a, b, at_b } => {
                let (wa, wb) = (place(design, state, at_a), place(design, state, at_b));
                let seen = sub(wb, wa);
                let own = sub(design.geometry.marker(b), design.geometry.marker(a));
                let [c, s] = direction(own, seen, (dot(own, own) * dot(seen, seen)).sqrt());
                state.poses[a.body.index()] = Pose::pinned(c, s, design.geometry.marker(a), wa);
                T::one()
            }
            Step::Hold { body } => {
                let pose = &mut state.poses[body.index()];
                (pose.c, pose.s) = (T::one(), T::zero());
                T::one()
            }
            Step::Roll {
                own,
                at,
                constraint,
            } => {
                // The centre is in place whatever the angle.
                let world = place(design, state, at);
                let (body, pin) = (own.body, design.geometry.marker(own));
                state.poses[body.index()] = Pose::pinned(T::one(), T::zero(), pin, world);
                let situation = state.situation(design, branch);
                if let Some(angle) = gear(&situation, mechanism, body, constraint) {
                    let (s, c) = angle.sin_cos();
                    state.poses[body.index()] = Pose::pinned(c, s, pin, world);
                }
                T::one()
            }
            Step::Gear { body, constraint } => gear(
                &state.situation(design, branch),
                mechanism,
                body,
                constraint,
            )
            .map_or(T::one(), |angle| {
                let (s, c) = angle.sin_cos();
                let pose = &mut state.poses[body.index()];
                (pose.c, pose.s) = (c, s);
                T::one()
            }),
            Step::Newton { block } => {
                T::solve_newton(&self.newton_blocks[block], mechanism, design, branch, state)
            }
        };
        state.determinants[index] = determinant;
    }
}

/// A marker in the frame.
#[cfg_attr(not(debug_assertions), inline(always))]
fn place<T: Number>(design: &Design<T>, state: &State<T>, marker: Marker) -> [T; 2] {
    place_in(&design.geometry, &state.poses, marker)
}

/// A marker in the frame, with what is known of its place taken into account.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn place_in<T: Number>(
    geometry: &Geometry<T>,
    poses: &[Pose<T>],
    marker: Marker,
) -> [T; 2] {
    let p = geometry.marker(marker);
    if marker.spot == Spot::Frame {
        return p;
    }
    let pose = &poses[marker.body.index()];
    match marker.spot {
        Spot::Origin => [pose.x, pose.y],
        Spot::Axis => [pose.x + pose.c * p[0], pose.y + pose.s * p[0]],
        Spot::Frame | Spot::Anywhere => pose.place(p),
    }
}

/// The pose of a body with this direction whose marker `own` lies at `world`.
#[cfg_attr(not(debug_assertions), inline(always))]
fn pinned<T: Number>(design: &Design<T>, own: Marker, [c, s]: [T; 2], world: [T; 2]) -> Pose<T> {
    let p = design.geometry.marker(own);
    let [x, y] = match own.spot {
        Spot::Origin => world,
        Spot::Axis => [world[0] - c * p[0], world[1] - s * p[0]],
        Spot::Frame | Spot::Anywhere => return Pose::pinned(c, s, p, world),
    };
    Pose { x, y, c, s }
}

/// Direction of a body whose vector between two markers is seen as `seen`; `k` is that vector over its square.
#[cfg_attr(not(debug_assertions), inline(always))]
fn direction_by<T: Number>(k: [T; 2], seen: [T; 2], (from, to): (Marker, Marker)) -> [T; 2] {
    let on_axis = |m: Marker| matches!(m.spot, Spot::Origin | Spot::Axis);
    if on_axis(from) && on_axis(to) {
        [k[0] * seen[0], k[0] * seen[1]]
    } else {
        [dot(k, seen), cross(k, seen)]
    }
}

/// Origin and unit direction of a line in the frame.
#[cfg_attr(not(debug_assertions), inline(always))]
fn placed_line<T: Number>(design: &Design<T>, state: &State<T>, line: LineRef) -> ([T; 2], [T; 2]) {
    let local = design.geometry.line(line);
    if line.body == BodyId::GROUND {
        return (local.origin, local.direction);
    }
    let pose = &state.poses[line.body.index()];
    (pose.place(local.origin), pose.turn(local.direction))
}

/// The turn by an angle constant and a drive, as a unit vector.
#[cfg_attr(not(debug_assertions), inline(always))]
fn turn_by<T: Number>(
    design: &Design<T>,
    state: &State<T>,
    offset: u32,
    input: Option<DriveId>,
    reversed: bool,
) -> [T; 2] {
    let mut by = design.geometry.angles[offset as usize];
    if let Some(drive) = input {
        let q = &state.inputs[drive.index()];
        by = [by[0] * q.c - by[1] * q.s, by[1] * q.c + by[0] * q.s];
    }
    if reversed {
        by[1] = -by[1];
    }
    by
}

/// What a condition says about the point its carrier holds. The carrier's angle must be known.
#[cfg_attr(not(debug_assertions), inline(always))]
fn locus<T: Number>(
    design: &Design<T>,
    branch: &Branch,
    state: &State<T>,
    carrier: Carrier,
    condition: Condition,
) -> Locus<T> {
    let geometry = &design.geometry;
    let pose = &state.poses[carrier.body.index()];
    let pin = carrier
        .pin
        .map_or([T::zero(); 2], |pin| geometry.marker(pin));
    match condition {
        Condition::OnLine { own, line } | Condition::TravelOn { own, line, .. } => {
            let (origin, along) = placed_line(design, state, line);
            let from = sub(origin, pose.turn(sub(geometry.marker(own), pin)));
            on_line(state, condition, along, from)
        }
        Condition::Through { line, point } | Condition::TravelThrough { line, point, .. } => {
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
                _ => Locus::Line(left(along), dot(left(along), from)),
            }
        }
        Condition::Roll {
            line,
            center,
            constants,
        } => {
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
        Condition::Radius { own, center, input } => {
            let center = sub(
                place(design, state, center),
                pose.turn(sub(geometry.marker(own), pin)),
            );
            Locus::Circle(center, state.inputs[input.index()].value)
        }
    }
}

/// A point on the line through `from` along `along`, or with the drive's coordinate along it.
#[cfg_attr(not(debug_assertions), inline(always))]
fn on_line<T: Number>(
    state: &State<T>,
    condition: Condition,
    along: [T; 2],
    from: [T; 2],
) -> Locus<T> {
    match condition {
        Condition::TravelOn { input, .. } => {
            Locus::Line(along, dot(along, from) + state.inputs[input.index()].value)
        }
        _ => Locus::Line(left(along), dot(left(along), from)),
    }
}

/// Places a translating body by the point it carries.
#[cfg_attr(not(debug_assertions), inline(always))]
fn carry<T: Number>(design: &Design<T>, state: &mut State<T>, carrier: Carrier, x: [T; 2]) {
    let pin = carrier
        .pin
        .map_or([T::zero(); 2], |pin| design.geometry.marker(pin));
    let pose = &mut state.poses[carrier.body.index()];
    *pose = Pose::pinned(pose.c, pose.s, pin, x);
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn swing<T: Number>(
    design: &Design<T>,
    branch: &Branch,
    state: &mut State<T>,
    (own, at, tip): (Marker, Marker, Marker),
    condition: Condition,
    partner: Option<Carrier>,
    sign: f64,
) -> T {
    let center = place(design, state, at);
    let pin = design.geometry.marker(own);
    let arm = sub(design.geometry.marker(tip), pin);
    let square = dot(arm, arm);
    // On the body itself the condition acts at the tip, whatever the body's angle.
    let locus = match (partner, condition) {
        (Some(carrier), _) => locus(design, branch, state, carrier, condition),
        (None, Condition::Radius { center, input, .. }) => Locus::Circle(
            place(design, state, center),
            state.inputs[input.index()].value,
        ),
        (None, Condition::OnLine { line, .. } | Condition::TravelOn { line, .. }) => {
            let (origin, along) = placed_line(design, state, line);
            on_line(state, condition, along, origin)
        }
        // Conditions with a line of the swinging body are `SwingLine`s.
        (
            None,
            Condition::Through { .. } | Condition::TravelThrough { .. } | Condition::Roll { .. },
        ) => {
            return T::from_f64(f64::NAN);
        }
    };
    let (reach, h) = reach_locus(center, square.sqrt(), locus, sign);
    let [c, s] = direction(arm, reach, square);
    state.poses[own.body.index()] = pinned(design, own, [c, s], center);
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

#[cfg_attr(not(debug_assertions), inline(always))]
fn swing_line<T: Number>(
    design: &Design<T>,
    state: &mut State<T>,
    (own, at, toward): (Marker, Marker, Marker),
    reach: Reach,
    partner: Option<Sliding>,
    sign: f64,
) -> T {
    let geometry = &design.geometry;
    let (center, far) = (place(design, state, at), place(design, state, toward));
    let pin = geometry.marker(own);
    let v = sub(far, center);
    // Turn of the partner against the body, as a unit vector.
    let relative = partner.map(|p| {
        let by = turn_by(design, state, p.offset, p.input, p.reversed);
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

/// Angle of a body from a gear pair or a rack; `None` when the constraint is of another kind.
#[inline]
pub(crate) fn gear<T: Number>(
    situation: &Situation<'_, T>,
    mechanism: &Mechanism,
    body: crate::mechanism::BodyId,
    constraint: usize,
) -> Option<T> {
    match mechanism.constraints[constraint].0 {
        Constraint::Gears {
            a,
            b,
            arm,
            constants,
        } => {
            let k = &situation.geometry.gears[constants as usize];
            let angle = |body| situation.angle(body);
            Some(if body == a {
                (k.constant - k.second * (angle(b) - angle(arm))) / k.first + angle(arm)
            } else if body == b {
                (k.constant - k.first * (angle(a) - angle(arm))) / k.second + angle(arm)
            } else {
                (k.first * angle(a) + k.second * angle(b) - k.constant) / (k.first + k.second)
            })
        }
        Constraint::Rack {
            line,
            center,
            constants,
        } => {
            let k = &situation.geometry.gears[constants as usize];
            let (origin, along) = situation.line(line);
            let turn = (k.constant - dot(along, sub(situation.place(center), origin))) / k.second;
            // The rack itself can only be the one sought when its line's place is known without its angle.
            (body == center.body).then(|| situation.angle(line.body) + turn)
        }
        _ => None,
    }
}
