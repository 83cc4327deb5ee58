//! Newton and Euler: the equilibrium of every body, solved for the multipliers of all joints and drives at once.
//!
//! `m a - applied = J^T lambda + friction(lambda)`, with J the gradients of the joints' and drives' residuals
//! (d'Alembert, Lagrange). By the scaling of those residuals the multipliers are: of a pin the force on the later body,
//! of a point on a line the normal force along the line's left normal on the point, of a direction the torque on its
//! first body, of a cylinder's length the push on its eye, of a travel the push along the guide, of a rack and of gears
//! with known pins the tooth force along the common tangent of the pitch circles.
//!
//! With more rows than unknowns the loads of some joints are not determined by equilibrium; the shortest solution is
//! given (moments counted over the mechanism's size) and those joints are named. What friction does is then a load as any other: the joints carry the
//! shortest solution of what is left.
//!
//! What has to branch is decided on plain numbers, for every lane by itself ([`PlainEquilibrium`]). From there multipliers
//! are carried over to series and derivatives by refinement, and bounds of them are proved.

mod contact;
mod friction;
mod order;
mod pace;
mod plain;
mod proof;
mod system;

use kempe_mechanism::constraint::{Gradient, Joint, Unit};
use kempe_mechanism::{BodyId, Geometry, Mechanism};
use kempe_number::Number;

use self::contact::{FrictionContact, resistance};
pub use self::friction::Rubbing;
use self::order::Order;
pub use self::pace::{Pace, STILL, UNMOVED};
pub use self::plain::{
    FRICTION_STEP, FRICTION_STEPS, FrictionOutcome, PlainEquilibrium, SINGULAR, UNIQUE,
};
use self::system::{Entry, Equations, Layout};
use crate::friction::Friction;
use crate::instant::Instant;
use crate::number::{ForceNumber, PlainNumber};
use crate::wrench::Wrench;

/// The equations of an equilibrium, whose other fields stay free to be changed.
macro_rules! equations {
    ($equilibrium:expr, $frictions:expr, $needed:expr) => {
        Equations {
            layout: &$equilibrium.layout,
            entries: &$equilibrium.entries,
            contacts: &$equilibrium.contacts,
            frictions: $frictions,
            needed: $needed,
        }
    };
}
use equations;

/// The equilibrium of a mechanism, with storage that is reused from instant to instant.
#[derive(Clone, Debug)]
pub struct Equilibrium<T: ForceNumber> {
    layout: Layout,
    /// What counts as moving.
    pub pace: Pace,
    entries: Vec<Entry<T>>,
    contacts: Vec<FrictionContact<T>>,
    /// The senses in which what rubs dry is taken to slide, in the order of [`Self::sliding`]; by its speed where there is none.
    pub(crate) senses: Vec<Option<f64>>,
    wide: Vec<T::InLane>,
    rest: Vec<T>,
    /// What the least multipliers are combinations of: of a column of J each, where equilibrium does not determine them.
    combined: Vec<T>,
    /// Multipliers: joints and drives in the mechanism's order, then the torques that hold idle bodies. NaN in lanes where
    /// the pose is singular or friction jams; intervals without bounds where none are proved.
    pub lambda: Vec<T>,
    /// What was found in plain numbers, lane by lane.
    pub lanes: Vec<PlainEquilibrium>,
}

impl<T: ForceNumber> Equilibrium<T> {
    /// Storage for a mechanism of this size (m) in every lane.
    pub fn new(mechanism: &Mechanism, size: impl Fn(usize) -> f64, frictions: usize) -> Self {
        let mut first_row = Vec::with_capacity(mechanism.constraints.len());
        let mut units = Vec::new();
        for (constraint, _) in &mechanism.constraints {
            first_row.push(units.len());
            units.resize(units.len() + constraint.rows(), constraint.load_unit());
        }
        let idle = mechanism.plan.decomposition.idle.clone();
        units.resize(units.len() + idle.len(), Unit::Angle);
        let (rows, columns) = (units.len(), 3 * (mechanism.bodies - 1));
        let layout = Layout {
            order: Order::new(mechanism, &first_row, rows),
            first_row,
            units,
            idle,
            rows,
            columns,
        };
        Self {
            lanes: (0..T::Plain::LANES)
                .map(|lane| PlainEquilibrium::new(&layout, lane, size(lane), frictions > 0))
                .collect(),
            layout,
            pace: Pace::default(),
            entries: Vec::with_capacity(4 * rows),
            contacts: Vec::with_capacity(frictions),
            senses: Vec::new(),
            wide: vec![T::InLane::zero(); rows.max(columns)],
            rest: vec![T::zero(); columns],
            combined: vec![T::zero(); columns],
            lambda: vec![T::zero(); rows],
        }
    }

    /// First row of a constraint.
    pub fn row(&self, constraint: usize) -> usize {
        self.layout.first_row[constraint]
    }

    /// The largest load anywhere in a lane, in the unit of a constraint's multiplier.
    pub fn largest_at(&self, constraint: usize, lane: usize) -> f64 {
        let plain = &self.lanes[lane];
        plain.largest * plain.unit[self.row(constraint)]
    }

    /// Rows beyond the number of unknown motions: loads that equilibrium does not determine.
    pub fn redundant_rows(&self) -> usize {
        self.layout.rows.saturating_sub(self.layout.columns)
    }

    /// Torques that hold bodies whose angle nothing determines; a true motion needs none.
    pub fn holding_torques(&self) -> &[T] {
        &self.lambda[self.layout.rows - self.layout.idle.len()..]
    }

    /// Bodies whose angle nothing determines.
    pub fn idle_bodies(&self) -> &[BodyId] {
        &self.layout.idle
    }

    /// Constraints whose loads equilibrium does not determine. In lanes: in any of them.
    pub fn not_unique(&self) -> Vec<usize> {
        let lanes = self.lanes.iter();
        let mut list: Vec<usize> = lanes
            .flat_map(|lane| lane.not_unique(&self.layout))
            .collect();
        list.sort_unstable();
        list.dedup();
        list
    }

    /// Solves an instant: `needed` is `m a - applied` of every body, about its origin.
    pub(crate) fn solve(
        &mut self,
        mechanism: &Mechanism,
        geometry: &Geometry<T>,
        frictions: &[Friction<T>],
        at: &Instant<T>,
        needed: &[Wrench<T>],
    ) {
        self.assemble(mechanism, geometry, at);
        self.find_contacts(mechanism, geometry, frictions, at);
        let equations = equations!(self, frictions, needed);
        for lane in &mut self.lanes {
            lane.settle(&equations);
        }
        self.lambda.fill(T::zero());
        match T::Plain::BOUNDS {
            true => self.prove(frictions, needed),
            false => self.refine(frictions, needed),
        }
        let equations = equations!(self, frictions, needed);
        for lane in self.lanes.iter_mut().filter(|lane| !lane.singular) {
            lane.measure_residual(&equations, &self.lambda);
        }
    }

    fn assemble(&mut self, mechanism: &Mechanism, geometry: &Geometry<T>, at: &Instant<T>) {
        let situation = at.situation(geometry);
        self.entries.clear();
        for (index, (constraint, _)) in mechanism.constraints.iter().enumerate() {
            let row = self.layout.first_row[index];
            let entries = &mut self.entries;
            let take: &mut dyn FnMut(Gradient<T>) = &mut |g| {
                entries.push(Entry {
                    row: row + g.row,
                    body: g.body,
                    to: g.to,
                });
            };
            // Called: no joint is compiled once more for these entries.
            constraint.load_gradients(&situation, take);
        }
        for (k, body) in self.layout.idle.iter().enumerate() {
            self.entries.push(Entry {
                row: self.layout.rows - self.layout.idle.len() + k,
                body: *body,
                to: [T::zero(), T::zero(), T::one()],
            });
        }
    }

    /// Carries the plain multipliers over to every coefficient and derivative, lane by lane with the matrix last factored;
    /// NaN where there are none.
    pub(crate) fn refine(&mut self, frictions: &[Friction<T>], needed: &[Wrench<T>]) {
        for (index, lane) in self.lanes.iter().enumerate() {
            let known = lane.is_settled();
            if known && frictions.is_empty() {
                continue;
            }
            for (lambda, plain) in self.lambda.iter_mut().zip(&lane.lambda) {
                let start = if known { *plain } else { f64::NAN };
                *lambda = lambda.with_lane(index, T::InLane::from_f64(start));
            }
        }
        if !self.lanes.iter().any(PlainEquilibrium::is_settled) {
            return;
        }
        let undetermined = self.redundant_rows() > 0;
        if undetermined {
            self.begin_least();
            self.combine();
        }
        for pass in 0..T::PASSES {
            // Without friction there are no multipliers yet.
            let loaded = pass > 0 || !frictions.is_empty();
            self.fill_rest(frictions, needed, loaded);
            let order = &self.layout.order;
            for (index, lane) in self.lanes.iter().enumerate().filter(|l| l.1.is_settled()) {
                let scale = |k: usize| if k % 3 < 2 { lane.size } else { 1.0 };
                for (k, (place, rest)) in order.columns.iter().zip(&self.rest).enumerate() {
                    self.wide[*place] = rest.in_lane(index) * scale(k);
                }
                self.wide[self.layout.columns..].fill(T::InLane::zero());
                lane.qr.solve_transposed(&mut self.wide);
                if undetermined {
                    lane.free.as_ref().unwrap_or(&lane.qr).solve(&mut self.wide);
                    for (k, (place, sum)) in
                        order.columns.iter().zip(&mut self.combined).enumerate()
                    {
                        let more = self.wide[*place] * scale(k);
                        *sum = sum.with_lane(index, sum.in_lane(index) + more);
                    }
                    continue;
                }
                let places = order.rows.iter().zip(&lane.unit);
                for (lambda, (place, unit)) in self.lambda.iter_mut().zip(places) {
                    let more = self.wide[*place] * *unit;
                    *lambda = lambda.with_lane(index, lambda.in_lane(index) + more);
                }
            }
            if undetermined {
                self.combine();
            }
        }
        if frictions.is_empty() {
            self.keep_frictionless();
        }
    }

    fn keep_frictionless(&mut self) {
        let lanes = self.lanes.iter_mut().enumerate();
        for (index, lane) in lanes.filter(|l| l.1.is_settled()) {
            for (plain, lambda) in lane.frictionless.iter_mut().zip(&self.lambda) {
                *plain = lambda.value_in(index);
            }
        }
    }

    /// What the least multipliers are combinations of begins with what plain ones are.
    fn begin_least(&mut self) {
        self.combined.fill(T::zero());
        for (index, lane) in self.lanes.iter().enumerate() {
            for (sum, plain) in self.combined.iter_mut().zip(&lane.combined) {
                *sum = sum.with_lane(index, T::InLane::from_f64(*plain));
            }
        }
    }

    /// Where equilibrium does not determine all multipliers, the least of them in their units, of what friction leaves to balance. They stay the least as
    /// everything moves: combinations of the columns of J at every order, not only the least that each order needs.
    fn combine(&mut self) {
        self.lambda.fill(T::zero());
        for entry in self.entries.iter().filter(|e| e.body != BodyId::GROUND) {
            let own = &self.combined[3 * (entry.body.index() - 1)..][..3];
            for (to, combined) in entry.to.iter().zip(own) {
                self.lambda[entry.row] += *to * *combined;
            }
        }
        for (index, lane) in self.lanes.iter().enumerate() {
            for (lambda, unit) in self.lambda.iter_mut().zip(&lane.unit) {
                let own = match lane.is_settled() {
                    true => lambda.in_lane(index) * (unit * unit),
                    false => T::InLane::from_f64(f64::NAN),
                };
                *lambda = lambda.with_lane(index, own);
            }
        }
    }

    /// What is left of every body's equilibrium at the multipliers, which are all zero where it is not `loaded`.
    fn fill_rest(&mut self, frictions: &[Friction<T>], needed: &[Wrench<T>], loaded: bool) {
        for (rest, w) in self.rest.chunks_exact_mut(3).zip(&needed[1..]) {
            rest.copy_from_slice(w);
        }
        if !loaded {
            return;
        }
        for entry in self.entries.iter().filter(|e| e.body != BodyId::GROUND) {
            let rest = &mut self.rest[3 * (entry.body.index() - 1)..][..3];
            for (rest, to) in rest.iter_mut().zip(entry.to) {
                *rest -= to * self.lambda[entry.row];
            }
        }
        for contact in &self.contacts {
            let resistance = resistance(frictions, contact, &self.lambda);
            for (body, unit) in contact.unit.iter().filter(|u| u.0 != BodyId::GROUND) {
                let rest = &mut self.rest[3 * (body.index() - 1)..][..3];
                for (rest, unit) in rest.iter_mut().zip(unit) {
                    *rest -= *unit * resistance;
                }
            }
        }
    }

    /// Hands out what every constraint does to each of its bodies: constraint, body, wrench about the body's origin.
    pub(crate) fn each_reaction(&self, mut take: impl FnMut(usize, BodyId, Wrench<T>)) {
        let mut constraint = 0;
        let held = self.layout.rows - self.layout.idle.len();
        for entry in self.entries.iter().filter(|e| e.row < held) {
            while self
                .layout
                .first_row
                .get(constraint + 1)
                .is_some_and(|next| *next <= entry.row)
            {
                constraint += 1;
            }
            let lambda = self.lambda[entry.row];
            take(constraint, entry.body, entry.to.map(|to| to * lambda));
        }
    }
}
