//! The plan: how the pose is found, block by block, for given drive coordinates.
//!
//! A plan is made once for a topology. Its steps hold indices only; dimensions live in [`Design`](crate::Design), the
//! choice between assemblies in [`Branch`](crate::Branch), so one plan serves every design on every kind of number.

use kempe_model::DriveId;

use crate::blocks::{Block, Decomposition, Row, Unknown, decompose};
use crate::mechanism::{BodyId, Constraint, LineRef, Marker, Mechanism};

/// A condition on a body whose other side is already placed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Condition {
    /// A point of the body lies on a placed line.
    OnLine {
        /// The body's point.
        own: Marker,
        /// The placed line.
        line: LineRef,
    },
    /// A line of the body passes through a placed point.
    Through {
        /// The body's line.
        line: LineRef,
        /// The placed point.
        point: Marker,
    },
    /// A point of the body has the drive's coordinate along a placed line.
    TravelOn {
        /// The body's point.
        own: Marker,
        /// The placed line.
        line: LineRef,
        /// The drive.
        input: DriveId,
    },
    /// A placed point has the drive's coordinate along a line of the body.
    TravelThrough {
        /// The body's line.
        line: LineRef,
        /// The placed point.
        point: Marker,
        /// The drive.
        input: DriveId,
    },
    /// A pinion whose centre is placed rolls on the body's pitch line, both angles known.
    Roll {
        /// The body's pitch line.
        line: LineRef,
        /// The pinion's centre.
        center: Marker,
        /// Index into the geometry's gear constants.
        constants: u32,
    },
    /// A point of the body is at the drive's distance from a placed point.
    Radius {
        /// The body's point.
        own: Marker,
        /// The placed point.
        center: Marker,
        /// The drive.
        input: DriveId,
    },
}

/// A translating body that carries the point sought; without a pin the point is the body's origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carrier {
    /// The body, its angle known.
    pub body: BodyId,
    /// The body's point at the point sought.
    pub pin: Option<Marker>,
}

/// One step of a plan: one block solved.
#[derive(Clone, Debug)]
pub enum Step {
    /// The angle of a body from that of another ([`Constraint::Direction`]).
    Turn {
        /// The body.
        body: BodyId,
        /// The other body, already turned.
        from: BodyId,
        /// Index of the angle constant.
        offset: u32,
        /// The drive that is added.
        input: Option<DriveId>,
        /// The constant and the drive count backwards: `angle = angle(from) - offset - drive`.
        reversed: bool,
    },
    /// The angle of a body from angles of others (gears) or from a travel (rack).
    Gear {
        /// The body.
        body: BodyId,
        /// Index of the constraint.
        constraint: usize,
    },
    /// A pinion pinned at its centre to a placed point, its angle from a rack that is placed.
    Roll {
        /// The pinion's centre.
        own: Marker,
        /// The placed point there.
        at: Marker,
        /// Index of the rack's constraint.
        constraint: usize,
    },
    /// An idle angle, kept at zero.
    Hold {
        /// The body.
        body: BodyId,
    },
    /// A body whose angle is known, pinned to a placed point.
    Pin {
        /// The body's point.
        own: Marker,
        /// The placed point.
        at: Marker,
    },
    /// A body pinned at both of its ends to placed points (overconstrained unless the distance fits).
    TwoPins {
        /// The body's first point.
        a: Marker,
        /// Where it is pinned.
        at_a: Marker,
        /// The body's second point.
        b: Marker,
        /// Where it is pinned.
        at_b: Marker,
    },
    /// A point from two conditions on translating bodies (RPP and PRP dyads, two slots, two cylinders).
    Cross {
        /// Who carries the point, for each condition; twice the same body for a single one.
        carriers: [Carrier; 2],
        /// The conditions.
        conditions: [Condition; 2],
    },
    /// A body pinned to a placed point, its angle from a condition on one of its points: driven bars, RRP dyads
    /// (`partner` is the translating body pinned to it).
    Swing {
        /// The body's point at the pin.
        own: Marker,
        /// The placed point.
        at: Marker,
        /// The body's point on which the condition acts.
        tip: Marker,
        /// The condition, on the body itself or on its partner.
        condition: Condition,
        /// The translating body pinned at the tip.
        partner: Option<Carrier>,
    },
    /// A body pinned to a placed point, one of its own lines through (or along by a travel) a placed point. With a
    /// partner this is the RPR dyad: the partner keeps its angle to the body.
    SwingLine {
        /// The body's point at the pin.
        own: Marker,
        /// The placed point at the pin.
        at: Marker,
        /// The other placed point.
        toward: Marker,
        /// What is kept constant.
        reach: Reach,
        /// The second body of an RPR dyad.
        partner: Option<Sliding>,
    },
    /// Two bodies pinned to each other and each to a placed point: the RRR dyad.
    Dyad {
        /// First body: its outer pin.
        outer_a: Marker,
        /// The placed point there.
        at_a: Marker,
        /// First body: its inner pin.
        inner_a: Marker,
        /// Second body: its outer pin.
        outer_b: Marker,
        /// The placed point there.
        at_b: Marker,
        /// Second body: its inner pin.
        inner_b: Marker,
        /// First of seven constants in the design.
        constants: usize,
    },
    /// Everything else: Newton's method on the block's rows.
    Newton {
        /// Index into [`Plan::newton_blocks`].
        block: usize,
    },
}

/// Which projection of the vector between the two placed points, seen from the body, is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reach {
    /// The body's own line passes through the far point.
    Line {
        /// The body's line.
        line: LineRef,
    },
    /// The far point has the drive's coordinate along the body's own line.
    Travel {
        /// The body's line.
        line: LineRef,
        /// The drive.
        input: DriveId,
    },
    /// RPR: a point of the partner stays on the body's line.
    PartnerPoint {
        /// The body's line.
        line: LineRef,
        /// The partner's point.
        point: Marker,
    },
    /// RPR: a point of the body stays on the partner's line.
    PartnerLine {
        /// The body's point.
        point: Marker,
        /// The partner's line.
        line: LineRef,
    },
}

/// The second body of an RPR dyad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sliding {
    /// Its outer pin.
    pub outer: Marker,
    /// Index of the angle constant between the two.
    pub offset: u32,
    /// A drive added to that angle.
    pub input: Option<DriveId>,
    /// The constant gives the first body's angle against the partner's, not the other way round.
    pub reversed: bool,
}

/// A block left to Newton's method.
#[derive(Clone, Debug)]
pub struct NewtonBlock {
    /// Its unknowns.
    pub unknowns: Vec<Unknown>,
    /// Column of each unknown's first number.
    pub columns: Vec<usize>,
    /// How many numbers are sought.
    pub size: usize,
    /// Constraints with the rows used; the first `size` rows belong to the square system.
    pub rows: Vec<Row>,
}

/// How the pose is found.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Steps in order.
    pub steps: Vec<Step>,
    /// For each step, the block of the decomposition it solves.
    pub blocks: Vec<Block>,
    /// Blocks left to Newton's method.
    pub newton_blocks: Vec<NewtonBlock>,
    /// How many constants a design prepares.
    pub constants: usize,
    /// The decomposition it was made from.
    pub decomposition: Decomposition,
}

impl Step {
    /// Whether the step has two assembly modes, told apart by a sign.
    pub fn has_modes(&self) -> bool {
        match self {
            Step::Dyad { .. } | Step::Swing { .. } | Step::SwingLine { .. } => true,
            Step::Cross { conditions, .. } => conditions
                .iter()
                .any(|c| matches!(c, Condition::Radius { .. })),
            _ => false,
        }
    }

    /// Whether the step looks at the branch's guesses or turn counts: Newton blocks, gears and racks.
    pub fn needs_guess(&self) -> bool {
        let rolls = |condition: &Condition| matches!(condition, Condition::Roll { .. });
        match self {
            Step::Newton { .. } | Step::Gear { .. } | Step::Roll { .. } => true,
            Step::Cross { conditions, .. } => conditions.iter().any(rolls),
            Step::Swing { condition, .. } => rolls(condition),
            _ => false,
        }
    }
}

impl Plan {
    /// Makes the plan of a mechanism with its drives. Freedoms without a drive are left where they are (see
    /// [`Decomposition::undetermined`]): the caller decides whether that is an error.
    pub fn new(mechanism: &Mechanism) -> Self {
        let decomposition = decompose(mechanism, true);
        let mut plan = Self {
            steps: Vec::new(),
            blocks: Vec::new(),
            newton_blocks: Vec::new(),
            constants: 0,
            decomposition: decomposition.clone(),
        };
        for &body in &decomposition.idle {
            plan.steps.push(Step::Hold { body });
            plan.blocks.push(Block {
                unknowns: vec![Unknown::Angle(body)],
                rows: vec![],
                surplus: vec![],
            });
        }
        for block in &decomposition.blocks {
            if block.rows.is_empty() {
                continue;
            }
            let step = match recognise(mechanism, block) {
                Some(Step::Dyad {
                    outer_a,
                    at_a,
                    inner_a,
                    outer_b,
                    at_b,
                    inner_b,
                    ..
                }) => {
                    let constants = plan.constants;
                    plan.constants += crate::closed_form::DYAD_CONSTANTS;
                    Step::Dyad {
                        outer_a,
                        at_a,
                        inner_a,
                        outer_b,
                        at_b,
                        inner_b,
                        constants,
                    }
                }
                Some(step) => step,
                None => {
                    plan.newton_blocks.push(newton_block(block));
                    Step::Newton {
                        block: plan.newton_blocks.len() - 1,
                    }
                }
            };
            plan.steps.push(step);
            plan.blocks.push(block.clone());
        }
        plan
    }
}

fn newton_block(block: &Block) -> NewtonBlock {
    let mut columns = Vec::new();
    let mut size = 0;
    for unknown in &block.unknowns {
        columns.push(size);
        size += unknown.size();
    }
    let rows = block.rows.iter().chain(&block.surplus).copied().collect();
    NewtonBlock {
        unknowns: block.unknowns.clone(),
        columns,
        size,
        rows,
    }
}

/// The constraints of a block, each once, with whether all of its rows are there.
fn constraints_of<'m>(mechanism: &'m Mechanism, rows: &[Row]) -> Option<Vec<&'m Constraint>> {
    let mut list: Vec<(usize, usize)> = Vec::new();
    for row in rows {
        match list.iter_mut().find(|(c, _)| *c == row.constraint) {
            Some((_, count)) => *count += 1,
            None => list.push((row.constraint, 1)),
        }
    }
    list.into_iter()
        .map(|(index, count)| {
            let constraint = &mechanism.constraints[index].0;
            (constraint.rows() == count).then_some(constraint)
        })
        .collect()
}

/// Finds the closed form of a block, if there is one.
fn recognise(mechanism: &Mechanism, block: &Block) -> Option<Step> {
    let rows: Vec<Row> = block.rows.iter().chain(&block.surplus).copied().collect();
    let constraints = constraints_of(mechanism, &rows)?;
    match (block.unknowns.as_slice(), block.surplus.len()) {
        ([Unknown::Angle(body)], 0) => angle_alone(*body, block, constraints[0]),
        ([Unknown::Place(body)], 0) => place_alone(*body, &constraints),
        ([Unknown::Angle(body), Unknown::Place(_)], 0) if body.index() > 0 && one_body(block) => {
            swing(*body, &constraints).or_else(|| pinion(*body, block, mechanism))
        }
        ([Unknown::Angle(body), Unknown::Place(_)], 1) if one_body(block) => {
            two_pins(*body, &constraints)
        }
        ([Unknown::Place(i), Unknown::Place(j)], 0) => prp(*i, *j, &constraints),
        ([_, _, _], 0) => rrp(block, &constraints),
        ([_, _, _, _], 0) => two_bodies(block)
            .and_then(|(i, j)| rrr(i, j, &constraints).or_else(|| rpr(i, j, &constraints))),
        _ => None,
    }
}

fn one_body(block: &Block) -> bool {
    block
        .unknowns
        .iter()
        .all(|u| u.body() == block.unknowns[0].body())
}

/// The two bodies of a block that seeks angle and place of both.
fn two_bodies(block: &Block) -> Option<(BodyId, BodyId)> {
    match block.unknowns.as_slice() {
        &[
            Unknown::Angle(i),
            Unknown::Angle(j),
            Unknown::Place(k),
            Unknown::Place(l),
        ] if i == k && j == l => Some((i, j)),
        _ => None,
    }
}

fn angle_alone(body: BodyId, block: &Block, constraint: &Constraint) -> Option<Step> {
    match *constraint {
        Constraint::Direction {
            a,
            b,
            offset,
            input,
        } => {
            let reversed = a != body;
            Some(Step::Turn {
                body,
                from: if reversed { a } else { b },
                offset,
                input,
                reversed,
            })
        }
        Constraint::Gears { .. } | Constraint::Rack { .. } => Some(Step::Gear {
            body,
            constraint: block.rows[0].constraint,
        }),
        _ => None,
    }
}

/// `(own, other)` of a pin between `body` and anything else.
fn pin_of(body: BodyId, constraint: &Constraint) -> Option<(Marker, Marker)> {
    match *constraint {
        Constraint::Coincide { a, b } if a.body == body => Some((a, b)),
        Constraint::Coincide { a, b } if b.body == body => Some((b, a)),
        _ => None,
    }
}

fn condition_of(body: BodyId, constraint: &Constraint) -> Option<Condition> {
    match *constraint {
        Constraint::OnLine { point, line } if point.body == body => {
            Some(Condition::OnLine { own: point, line })
        }
        Constraint::OnLine { point, line } if line.body == body => {
            Some(Condition::Through { line, point })
        }
        Constraint::Travel { point, line, input } if point.body == body => {
            Some(Condition::TravelOn {
                own: point,
                line,
                input,
            })
        }
        Constraint::Travel { point, line, input } if line.body == body => {
            Some(Condition::TravelThrough { line, point, input })
        }
        Constraint::Rack {
            line,
            center,
            constants,
        } if line.body == body => Some(Condition::Roll {
            line,
            center,
            constants,
        }),
        Constraint::Distance { a, b, input } if a.body == body => Some(Condition::Radius {
            own: a,
            center: b,
            input,
        }),
        Constraint::Distance { a, b, input } if b.body == body => Some(Condition::Radius {
            own: b,
            center: a,
            input,
        }),
        _ => None,
    }
}

fn place_alone(body: BodyId, constraints: &[&Constraint]) -> Option<Step> {
    match constraints {
        [pin] => pin_of(body, pin).map(|(own, at)| Step::Pin { own, at }),
        [first, second] => {
            let carrier = Carrier { body, pin: None };
            let conditions = [condition_of(body, first)?, condition_of(body, second)?];
            Some(Step::Cross {
                carriers: [carrier; 2],
                conditions,
            })
        }
        _ => None,
    }
}

/// One pin to something placed and one more condition.
fn swing(body: BodyId, constraints: &[&Constraint]) -> Option<Step> {
    let [first, second] = constraints else {
        return None;
    };
    let (pin, other) = if pin_of(body, first).is_some() {
        (first, second)
    } else {
        (second, first)
    };
    let (own, at) = pin_of(body, pin)?;
    match condition_of(body, other)? {
        Condition::Through { line, point } => Some(Step::SwingLine {
            own,
            at,
            toward: point,
            reach: Reach::Line { line },
            partner: None,
        }),
        Condition::TravelThrough { line, point, input } => Some(Step::SwingLine {
            own,
            at,
            toward: point,
            reach: Reach::Travel { line, input },
            partner: None,
        }),
        // The travel depends on the angle sought.
        Condition::Roll { .. } => None,
        condition @ (Condition::OnLine { own: tip, .. }
        | Condition::TravelOn { own: tip, .. }
        | Condition::Radius { own: tip, .. }) => Some(Step::Swing {
            own,
            at,
            tip,
            condition,
            partner: None,
        }),
    }
}

/// A pinion pinned at its centre: the rack's travel is known before its angle.
fn pinion(body: BodyId, block: &Block, mechanism: &Mechanism) -> Option<Step> {
    let constraint = |row: &Row| mechanism.constraints[row.constraint].0;
    let (own, at) = block
        .rows
        .iter()
        .find_map(|row| pin_of(body, &constraint(row)))?;
    block.rows.iter().find_map(|row| match constraint(row) {
        Constraint::Rack { line, center, .. } if center == own && line.body != body => {
            Some(Step::Roll {
                own,
                at,
                constraint: row.constraint,
            })
        }
        _ => None,
    })
}

fn two_pins(body: BodyId, constraints: &[&Constraint]) -> Option<Step> {
    let [first, second] = constraints else {
        return None;
    };
    let ((a, at_a), (b, at_b)) = (pin_of(body, first)?, pin_of(body, second)?);
    Some(Step::TwoPins { a, at_a, b, at_b })
}

/// The pin between two bodies, as `(on i, on j)`.
fn pin_between(i: BodyId, j: BodyId, constraint: &Constraint) -> Option<(Marker, Marker)> {
    pin_of(i, constraint).filter(|(_, other)| other.body == j)
}

fn prp(i: BodyId, j: BodyId, constraints: &[&Constraint]) -> Option<Step> {
    let inner = constraints.iter().find_map(|c| pin_between(i, j, c))?;
    let outer: Vec<&&Constraint> = constraints
        .iter()
        .filter(|c| pin_between(i, j, c).is_none())
        .collect();
    let [first, second] = outer.as_slice() else {
        return None;
    };
    let (first, second) = if condition_of(i, first).is_some() {
        (first, second)
    } else {
        (second, first)
    };
    let conditions = [condition_of(i, first)?, condition_of(j, second)?];
    if touches(first, j) || touches(second, i) {
        return None;
    }
    let carriers = [
        Carrier {
            body: i,
            pin: Some(inner.0),
        },
        Carrier {
            body: j,
            pin: Some(inner.1),
        },
    ];
    Some(Step::Cross {
        carriers,
        conditions,
    })
}

fn touches(constraint: &Constraint, body: BodyId) -> bool {
    constraint.bodies().any(|b| b == body)
}

/// Angle and place of one body, place of a second whose angle is known.
fn rrp(block: &Block, constraints: &[&Constraint]) -> Option<Step> {
    let swinging = block
        .unknowns
        .iter()
        .find_map(|u| matches!(u, Unknown::Angle(_)).then(|| u.body()))?;
    let mut places = block
        .unknowns
        .iter()
        .filter(|u| matches!(u, Unknown::Place(_)))
        .map(|u| u.body());
    let (first, second) = (places.next()?, places.next()?);
    let sliding = match (first == swinging, second == swinging) {
        (true, false) => second,
        (false, true) => first,
        _ => return None,
    };
    let inner = constraints
        .iter()
        .find_map(|c| pin_between(swinging, sliding, c))?;
    let outer = constraints
        .iter()
        .filter(|c| !touches(c, sliding))
        .find_map(|c| pin_of(swinging, c))?;
    let condition = constraints
        .iter()
        .filter(|c| !touches(c, swinging))
        .find_map(|c| condition_of(sliding, c))?;
    (constraints.len() == 3).then_some(Step::Swing {
        own: outer.0,
        at: outer.1,
        tip: inner.0,
        condition,
        partner: Some(Carrier {
            body: sliding,
            pin: Some(inner.1),
        }),
    })
}

fn rrr(i: BodyId, j: BodyId, constraints: &[&Constraint]) -> Option<Step> {
    if constraints.len() != 3 {
        return None;
    }
    let inner = constraints.iter().find_map(|c| pin_between(i, j, c))?;
    let outer_i = constraints
        .iter()
        .filter(|c| !touches(c, j))
        .find_map(|c| pin_of(i, c))?;
    let outer_j = constraints
        .iter()
        .filter(|c| !touches(c, i))
        .find_map(|c| pin_of(j, c))?;
    Some(Step::Dyad {
        outer_a: outer_i.0,
        at_a: outer_i.1,
        inner_a: inner.0,
        outer_b: outer_j.0,
        at_b: outer_j.1,
        inner_b: inner.1,
        constants: 0,
    })
}

fn rpr(i: BodyId, j: BodyId, constraints: &[&Constraint]) -> Option<Step> {
    if constraints.len() != 4 {
        return None;
    }
    let outer_i = constraints
        .iter()
        .filter(|c| !touches(c, j))
        .find_map(|c| pin_of(i, c))?;
    let outer_j = constraints
        .iter()
        .filter(|c| !touches(c, i))
        .find_map(|c| pin_of(j, c))?;
    let (offset, input, reversed) = constraints.iter().find_map(|c| match **c {
        Constraint::Direction {
            a,
            b,
            offset,
            input,
        } if a == j && b == i => Some((offset, input, false)),
        Constraint::Direction {
            a,
            b,
            offset,
            input,
        } if a == i && b == j => Some((offset, input, true)),
        _ => None,
    })?;
    let reach = constraints.iter().find_map(|c| match **c {
        Constraint::OnLine { point, line } if line.body == i && point.body == j => {
            Some(Reach::PartnerPoint { line, point })
        }
        Constraint::OnLine { point, line } if line.body == j && point.body == i => {
            Some(Reach::PartnerLine { point, line })
        }
        _ => None,
    })?;
    let partner = Some(Sliding {
        outer: outer_j.0,
        offset,
        input,
        reversed,
    });
    Some(Step::SwingLine {
        own: outer_i.0,
        at: outer_i.1,
        toward: outer_j.1,
        reach,
        partner,
    })
}
