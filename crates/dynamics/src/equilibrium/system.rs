//! The system of equations of an instant: which row and column is what, and what stands there.

use kempe_mechanism::BodyId;
use kempe_mechanism::constraint::Unit;

use super::contact::FrictionContact;
use super::order::Order;
use crate::friction::Friction;
use crate::number::ForceNumber;
use crate::wrench::Wrench;

/// One entry of J: derivatives of a row to a body's x, y and angle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry<T> {
    pub row: usize,
    pub body: BodyId,
    pub to: [T; 3],
}

/// Which row and column is what.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    /// First row of every constraint.
    pub first_row: Vec<usize>,
    /// In what the multiplier of every row is counted.
    pub units: Vec<Unit>,
    /// Where rows and columns stand in the factored matrix.
    pub order: Order,
    /// Bodies whose angle nothing determines: the last rows hold them.
    pub idle: Vec<BodyId>,
    pub rows: usize,
    pub columns: usize,
}

/// The equations of an instant, put together.
pub(super) struct Equations<'a, T: ForceNumber> {
    pub layout: &'a Layout,
    pub entries: &'a [Entry<T>],
    pub contacts: &'a [FrictionContact<T>],
    pub frictions: &'a [Friction<T>],
    /// `m a - applied` of every body, about its origin.
    pub needed: &'a [Wrench<T>],
}
