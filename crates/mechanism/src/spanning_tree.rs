//! The spanning tree of a block's pins: which places follow from angles, and what is left to solve for.
//!
//! A pin gives the place of one of its two bodies from the pose of the other, exactly. So the places of all bodies that
//! hang by pins on placed ones are no unknowns: sought are the angles (each against the frame) and the places of what no
//! pin holds, from the pins that close loops and the rows of all other constraints. The Jacobian to these *tree
//! coordinates* is the Schur complement of the block's own over the rows of the tree's pins, whose determinant is one; up
//! to a sign known here both have the same determinant.
//!
//! A body that turns carries along all that hangs on it without turning it: the derivative of a place to the angle of a
//! body between is the way from that body's own pin to the pin by which the rest hangs on it, turned by a quarter. These
//! ways are the *levers*.

use crate::blocks::{Block, Unknown};
use crate::constraint::{Coincide, Constraint};
use crate::ids::{BodyId, Marker};
use crate::layout::{Columns, Rows};
use crate::structure::Structure;

/// Largest number of tree coordinates for which elimination runs on the stack, and in lanes.
pub(crate) const ON_STACK: usize = 8;

/// A spanning tree of a block's pins, with the rows that it leaves.
#[derive(Clone, Debug)]
pub struct SpanningTree {
    /// Bodies whose angles are sought: the first columns.
    pub(crate) angles: Vec<BodyId>,
    /// Bodies whose places no pin of the block gives: two columns each, after the angles.
    pub(crate) places: Vec<BodyId>,
    /// How many numbers are sought.
    pub(crate) size: usize,
    /// Bodies placed by a pin, each after the body it hangs on. Their pins are the first points.
    pub(crate) hung: Vec<Hung>,
    /// Bodies that do not hang and whose angles are sought: their origins are the points after the pins.
    pub(crate) roots: Vec<BodyId>,
    /// Pins that close loops.
    pub(crate) closures: Vec<Closure>,
    /// Both points of every one of them: the points after the origins.
    pub(crate) tips: Vec<Marker>,
    /// The rows of all other constraints.
    pub(crate) others: Vec<OtherRow>,
    /// How every body of the mechanism is reached; only those of the block are.
    pub(crate) reached: Vec<Option<Reached>>,
    /// The block's determinant over the tree's: 1 or -1.
    pub(crate) sign: f64,
}

/// A body placed by a pin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hung {
    /// Its point at the pin.
    pub own: Marker,
    /// The point it hangs on, of a body placed before.
    pub at: Marker,
}

/// The way between two points, whose quarter turn is the derivative of all that hangs beyond to an angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lever {
    /// Column of the angle.
    pub column: usize,
    /// The point at which the turning body hangs, or its origin.
    pub from: usize,
    /// The pin by which the next body hangs on it.
    pub to: usize,
}

/// How a body's pose depends on the coordinates of the tree.
#[derive(Clone, Debug)]
pub(crate) struct Reached {
    /// Column of its own angle, if that is sought.
    pub angle: Option<usize>,
    /// The pin it hangs by.
    pub pin: Option<usize>,
    /// The point about which it turns: its pin or its origin; only if its angle is sought.
    pub base: Option<usize>,
    /// What the angles of the bodies between it and its root do to its place.
    pub levers: Vec<Lever>,
    /// First column of its root's place, if that is sought.
    pub root: Option<usize>,
}

/// A row that is not of a pin that closes a loop with both of its rows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OtherRow {
    /// Index of the constraint.
    pub constraint: usize,
    /// Which of its rows.
    pub part: usize,
    /// The row in the tree.
    pub row: usize,
}

/// A pin that closes a loop.
#[derive(Clone, Debug)]
pub(crate) struct Closure {
    /// The first of its two rows in the tree.
    pub row: usize,
    /// Its points: the residual is the second less the first.
    pub points: [usize; 2],
    /// Levers of the bodies between the points and their roots, those of the first turned about; what both share cancels.
    pub levers: Vec<Lever>,
    /// First columns of the roots' places, each with its sign.
    pub roots: Vec<(f64, usize)>,
}

impl SpanningTree {
    /// Chooses the tree of a block whose unknowns have these first columns: every body as few pins as possible away from a
    /// placed one. `None` where no pin saves anything, or redundant rows have to be held as well.
    pub(crate) fn new(structure: &Structure, block: &Block, columns: &Columns) -> Option<Self> {
        if !block.surplus.is_empty() {
            return None;
        }
        let rows = Rows::new(block.rows.iter().copied()).by_constraint;
        let pin = |index: usize| match structure.constraints[index].0 {
            Constraint::Coincide(Coincide { a, b }) => Some((a, b)),
            _ => None,
        };

        // Breadth first, from the bodies whose places are known; then from one that is not, until none is left.
        let mut waiting: Vec<BodyId> = (block.unknowns.iter())
            .filter_map(|unknown| match unknown {
                Unknown::Place(body) => Some(*body),
                Unknown::Angle(_) => None,
            })
            .collect();
        let (mut hung, mut tree_pins, mut places) = (Vec::new(), Vec::new(), Vec::new());
        while !waiting.is_empty() {
            let layer: Vec<(usize, Hung)> = (rows.iter().enumerate())
                .filter_map(|(index, (constraint, at))| {
                    let (a, b) = pin(*constraint)?;
                    let waits = [a, b].map(|marker| waiting.contains(&marker.body));
                    match (at, waits) {
                        ([Some(_), Some(_)], [true, false]) => {
                            Some((index, Hung { own: a, at: b }))
                        }
                        ([Some(_), Some(_)], [false, true]) => {
                            Some((index, Hung { own: b, at: a }))
                        }
                        _ => None,
                    }
                })
                .collect();
            if layer.is_empty() {
                places.push(waiting.remove(0));
            }
            for (index, new) in layer {
                // A body of the layer may have several pins to placed ones.
                if let Some(found) = waiting.iter().position(|body| *body == new.own.body) {
                    waiting.remove(found);
                    hung.push(new);
                    tree_pins.push(index);
                }
            }
        }
        if hung.is_empty() {
            return None;
        }

        let angles: Vec<BodyId> = (block.unknowns.iter())
            .filter_map(|unknown| match unknown {
                Unknown::Angle(body) => Some(*body),
                Unknown::Place(_) => None,
            })
            .collect();
        let size = angles.len() + 2 * places.len();
        let mut it = Self {
            size,
            roots: Vec::new(),
            closures: Vec::new(),
            tips: Vec::new(),
            others: Vec::new(),
            reached: vec![None; structure.bodies],
            sign: 1.0,
            angles,
            places,
            hung,
        };
        for body in it.bodies(block) {
            it.reach(body);
        }

        // The block's rows and columns in the order of the tree: its pins with the places they give come first.
        let mut row_order: Vec<usize> = Vec::new();
        for index in &tree_pins {
            row_order.extend(rows[*index].1.iter().flatten());
        }
        let mut row = 0;
        for (index, (constraint, at)) in rows.iter().enumerate() {
            if tree_pins.contains(&index) {
                continue;
            }
            let first = row;
            for place in at.iter().flatten() {
                row_order.push(*place);
                row += 1;
            }
            match (pin(*constraint), at) {
                (Some((a, b)), [Some(_), Some(_)]) => {
                    let closure = it.closure([a, b], first);
                    it.closures.push(closure);
                }
                _ => {
                    let parts = (0..2).filter(|part| at[*part].is_some());
                    it.others
                        .extend(parts.zip(first..).map(|(part, row)| OtherRow {
                            constraint: *constraint,
                            part,
                            row,
                        }));
                }
            }
        }
        let place = |body: BodyId| columns.of(body).into_iter().take(2);
        let hung = it.hung.iter().flat_map(|hung| place(hung.own.body));
        let angles = it.angles.iter().map(|body| columns.of(*body)[2]);
        let places = it.places.iter().flat_map(|body| place(*body));
        let column_order: Option<Vec<usize>> = hung.chain(angles).chain(places).collect();
        let column_order = column_order?;
        it.sign = parity(&row_order) * parity(&column_order);
        (row == size).then_some(it)
    }

    /// The block's bodies, each once.
    fn bodies(&self, block: &Block) -> Vec<BodyId> {
        let mut bodies: Vec<BodyId> = block.unknowns.iter().map(|u| u.body()).collect();
        bodies.sort_unstable();
        bodies.dedup();
        bodies
    }

    /// Notes how a body is reached.
    fn reach(&mut self, body: BodyId) {
        let mut levers = Vec::new();
        let (mut now, mut pin) = (body, self.pin(body));
        while let Some(to) = pin {
            now = self.hung[to].at.body;
            if let Some(column) = self.angle(now) {
                let from = self.base(now);
                levers.push(Lever { column, from, to });
            }
            pin = self.pin(now);
        }
        let place = self.places.iter().position(|root| *root == now);
        self.reached[body.index()] = Some(Reached {
            angle: self.angle(body),
            pin: self.pin(body),
            base: self.angle(body).map(|_| self.base(body)),
            levers,
            root: place.map(|k| self.angles.len() + 2 * k),
        });
    }

    /// The pin a body hangs by.
    fn pin(&self, body: BodyId) -> Option<usize> {
        self.hung.iter().position(|hung| hung.own.body == body)
    }

    /// Column of a body's angle, if that is sought.
    fn angle(&self, body: BodyId) -> Option<usize> {
        self.angles.iter().position(|sought| *sought == body)
    }

    /// The point about which a body turns: its pin, or the origin of a root.
    fn base(&mut self, body: BodyId) -> usize {
        if let Some(pin) = self.pin(body) {
            return pin;
        }
        let root = match self.roots.iter().position(|root| *root == body) {
            Some(root) => root,
            None => {
                self.roots.push(body);
                self.roots.len() - 1
            }
        };
        self.hung.len() + root
    }

    /// A pin that closes a loop, with its first row; the origins of all roots must be known.
    fn closure(&mut self, markers: [Marker; 2], row: usize) -> Closure {
        let first = self.points();
        self.tips.extend(markers);
        let [back, mut levers] = [0, 1].map(|k| self.levers_to(markers[k].body, first + k));
        for lever in back {
            match levers.iter().position(|other| *other == lever) {
                Some(same) => {
                    levers.remove(same);
                }
                None => levers.push(Lever {
                    from: lever.to,
                    to: lever.from,
                    ..lever
                }),
            }
        }
        let [from, to] = markers.map(|marker| {
            let reached = self.reached[marker.body.index()].as_ref();
            reached.and_then(|reached| reached.root)
        });
        let roots = match from == to {
            true => Vec::new(),
            false => (to.map(|column| (1.0, column)).into_iter())
                .chain(from.map(|column| (-1.0, column)))
                .collect(),
        };
        Closure {
            row,
            points: [first, first + 1],
            levers,
            roots,
        }
    }

    /// The levers of a body and of those between it and its root, to one of its own points.
    fn levers_to(&self, body: BodyId, point: usize) -> Vec<Lever> {
        let Some(reached) = &self.reached[body.index()] else {
            return Vec::new();
        };
        let own = (reached.angle.zip(reached.base)).map(|(column, from)| Lever {
            column,
            from,
            to: point,
        });
        own.into_iter().chain(reached.levers.clone()).collect()
    }

    /// How many points a pose of the tree has.
    pub(crate) fn points(&self) -> usize {
        self.hung.len() + self.roots.len() + self.tips.len()
    }

    /// The block's determinant over the tree's: 1 or -1.
    pub(crate) fn sign(&self) -> f64 {
        self.sign
    }

    /// How many numbers are sought.
    pub(crate) fn size(&self) -> usize {
        self.size
    }
}

/// The sign of a permutation.
fn parity(order: &[usize]) -> f64 {
    let mut sign = 1.0;
    for (k, a) in order.iter().enumerate() {
        for b in &order[k + 1..] {
            if a > b {
                sign = -sign;
            }
        }
    }
    sign
}
