//! Where equations and unknowns stand in a linear system: from constraint, row and body to row and column.
//!
//! Newton's method, Krawczyk's operator, the continuation, rank and equilibrium fill their matrices by this map. They differ
//! in the rows and unknowns they take, in their order, and in how they scale them.

use std::collections::BTreeMap;

use kempe_model::DriveId;
use kempe_number::Number;

use crate::blocks::{Row, Unknown};
use crate::constraint::{Gradient, Joint, Situation};
use crate::ids::BodyId;
use crate::structure::Structure;

/// Place and angle of every body but the frame, in their order.
pub fn unknowns_of(structure: &Structure) -> impl Iterator<Item = Unknown> + Clone {
    let bodies = (1..structure.bodies).map(|index| BodyId(index as u32));
    bodies.flat_map(|body| [Unknown::Place(body), Unknown::Angle(body)])
}

/// All rows of a mechanism's first so many constraints: its joints come first.
pub fn rows_of(structure: &Structure, constraints: usize) -> impl Iterator<Item = Row> {
    let constraints = structure.constraints[..constraints].iter().enumerate();
    constraints.flat_map(|(constraint, (kind, _))| {
        (0..kind.rows()).map(move |row| Row { constraint, row })
    })
}

/// The columns of unknowns.
#[derive(Clone, Debug, Default)]
pub struct Columns {
    /// What is sought, with the column of its first number.
    pub unknowns: Vec<(Unknown, usize)>,
    /// How many columns.
    pub count: usize,
    /// Index of the first body that has some.
    first: usize,
    /// Columns of the place and of the angle of every body from there on.
    seats: Vec<[Option<usize>; 2]>,
}

impl Columns {
    /// One unknown after the other; of one that comes again the first place counts.
    pub fn new(unknowns: impl IntoIterator<Item = Unknown> + Clone) -> Self {
        let bodies = || unknowns.clone().into_iter().map(|u| u.body().index());
        let first = bodies().min().unwrap_or(0);
        let mut it = Self {
            first,
            seats: vec![[None; 2]; bodies().max().map_or(0, |last| last + 1 - first)],
            ..Self::default()
        };
        for unknown in unknowns {
            let seat = &mut it.seats[unknown.body().index() - first];
            let seat = match unknown {
                Unknown::Place(_) => &mut seat[0],
                Unknown::Angle(_) => &mut seat[1],
            };
            if seat.is_none() {
                *seat = Some(it.count);
                it.unknowns.push((unknown, it.count));
                it.count += unknown.size();
            }
        }
        it
    }

    /// The columns of a body's x, y and angle, of those that are sought.
    #[inline]
    pub fn of(&self, body: BodyId) -> [Option<usize>; 3] {
        let index = body.index().wrapping_sub(self.first);
        let [place, angle] = self.seats.get(index).copied().unwrap_or_default();
        [place, place.map(|column| column + 1), angle]
    }
}

/// The rows of constraints.
#[derive(Clone, Debug, Default)]
pub struct Rows {
    /// How many rows.
    pub count: usize,
    /// Constraints with the places of their rows, in the order of their first ones.
    pub by_constraint: Vec<(usize, [Option<usize>; 2])>,
}

/// What a row of a Jacobian is derived to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum To {
    /// A body's x or y, per m, in this column.
    Length(usize),
    /// A body's angle, per rad, in this column.
    Angle(usize),
    /// The coordinate of a drive.
    Drive(DriveId),
}

impl To {
    /// The column of an unknown.
    #[inline]
    pub fn column(self) -> Option<usize> {
        match self {
            Self::Length(column) | Self::Angle(column) => Some(column),
            Self::Drive(_) => None,
        }
    }
}

impl Rows {
    /// One row after the other; of one that comes again the first place counts.
    pub fn new(rows: impl IntoIterator<Item = Row>) -> Self {
        let mut it = Self::default();
        let mut found = BTreeMap::new();
        for row in rows {
            let index = *found.entry(row.constraint).or_insert_with(|| {
                it.by_constraint.push((row.constraint, [None; 2]));
                it.by_constraint.len() - 1
            });
            let place = &mut it.by_constraint[index].1[row.row];
            if place.is_none() {
                *place = Some(it.count);
                it.count += 1;
            }
        }
        it
    }

    /// Hands every residual to `put`: its row, and the constraint's index.
    #[inline]
    pub fn residuals<T: Number>(
        &self,
        structure: &Structure,
        situation: &Situation<'_, T>,
        mut put: impl FnMut(usize, usize, T),
    ) {
        for &(constraint, at) in &self.by_constraint {
            let rows = situation.residual(&structure.constraints[constraint].0);
            for (place, value) in at.into_iter().zip(rows) {
                if let Some(row) = place {
                    put(row, constraint, value);
                }
            }
        }
    }

    /// Hands every entry of the Jacobian to `put`: its row, the constraint's index, what it is the derivative to, and its value,
    /// which counts in the constraint's unit. Entries of one place add up.
    #[inline]
    pub fn jacobian<T: Number>(
        &self,
        columns: &Columns,
        structure: &Structure,
        situation: &Situation<'_, T>,
        mut put: impl FnMut(usize, usize, To, T),
    ) {
        for &(constraint, at) in &self.by_constraint {
            let kind = &structure.constraints[constraint].0;
            let mut take = |gradient: Gradient<T>| {
                let Some(row) = at[gradient.row] else { return };
                let [x, y, angle] = columns.of(gradient.body);
                let to = [x.map(To::Length), y.map(To::Length), angle.map(To::Angle)];
                for (to, value) in to.into_iter().zip(gradient.to) {
                    if let Some(to) = to {
                        put(row, constraint, to, value);
                    }
                }
            };
            let to_drive = match const { size_of::<T>() == size_of::<f64>() } {
                true => situation.gradients(kind, take),
                // Called: no joint is compiled once more for these entries.
                false => situation.gradients(kind, &mut take as &mut dyn FnMut(Gradient<T>)),
            };
            if let (Some(row), Some(drive)) = (at[0], kind.drive()) {
                put(row, constraint, To::Drive(drive), to_drive);
            }
        }
    }

    /// [`Rows::jacobian`] of a mechanism of this size (m), with all lengths counted in it: rows of lengths and of angles compare.
    #[inline]
    pub fn scaled_jacobian(
        &self,
        columns: &Columns,
        structure: &Structure,
        situation: &Situation<'_, f64>,
        size: f64,
        mut put: impl FnMut(usize, To, f64),
    ) {
        self.jacobian(
            columns,
            structure,
            situation,
            |row, constraint, to, value| {
                let unit = structure.constraints[constraint].0.unit().factor(size);
                let value = match to {
                    To::Length(_) => value * size * unit,
                    To::Angle(_) | To::Drive(_) => value * unit,
                };
                put(row, to, value);
            },
        );
    }
}
