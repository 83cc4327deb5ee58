//! Constraint rows and as many unknowns: residuals, Jacobian and boxes of poses.

use kempe_mechanism::Mechanism;
use kempe_mechanism::blocks::{ConstraintRows, Row, Unknown, by_constraint};
use kempe_mechanism::constraint::Situation;
use kempe_mechanism::plan::NewtonBlock;
use kempe_mechanism::pose::Pose;
use kempe_number::{Interval, Number, math};

use super::Middle;

/// As many rows as unknowns: a block of the plan, or all of its blocks.
#[derive(Clone, Debug)]
pub(crate) struct System {
    /// How many numbers are sought.
    pub size: usize,
    /// What is sought, with the column of its first number.
    pub(super) unknowns: Vec<(Unknown, usize)>,
    /// Columns of every body's place and angle.
    columns: Vec<[Option<usize>; 2]>,
    /// Constraints with the places of their rows.
    rows: Vec<ConstraintRows>,
}

impl System {
    /// The square part of one block.
    pub fn of_block(mechanism: &Mechanism, block: &NewtonBlock) -> Self {
        let unknowns = block
            .unknowns
            .iter()
            .copied()
            .zip(block.columns.iter().copied());
        Self::new(mechanism, unknowns.collect(), block.size, &block.rows)
    }

    /// The square parts of all blocks of a plan: every body's pose, without redundant rows and idle angles.
    pub fn whole(mechanism: &Mechanism) -> Self {
        let plan = &mechanism.plan;
        let (mut unknowns, mut rows, mut size) = (Vec::new(), Vec::new(), 0);
        for block in plan
            .decomposition
            .blocks
            .iter()
            .filter(|b| !b.rows.is_empty())
        {
            for &unknown in &block.unknowns {
                unknowns.push((unknown, size));
                size += unknown.size();
            }
            rows.extend_from_slice(&block.rows);
        }
        Self::new(mechanism, unknowns, size, &rows)
    }

    fn new(
        mechanism: &Mechanism,
        unknowns: Vec<(Unknown, usize)>,
        size: usize,
        all: &[Row],
    ) -> Self {
        let mut columns = vec![[None; 2]; mechanism.bodies];
        for &(unknown, column) in &unknowns {
            let angle = usize::from(matches!(unknown, Unknown::Angle(_)));
            columns[unknown.body().index()][angle] = Some(column);
        }
        Self {
            size,
            unknowns,
            columns,
            rows: by_constraint(&all[..size.min(all.len())]),
        }
    }

    /// Residuals in the order of the rows.
    pub(super) fn residuals<T: Number>(
        &self,
        mechanism: &Mechanism,
        situation: &Situation<'_, T>,
    ) -> Vec<T> {
        let mut list = vec![T::zero(); self.size];
        for (constraint, at) in &self.rows {
            let rows = situation.residual(&mechanism.constraints[*constraint].0);
            for k in 0..2 {
                if let Some(place) = at[k] {
                    list[place] = rows[k];
                }
            }
        }
        list
    }

    /// Hands every entry of the Jacobian to `emit` as row, column, value; entries of one place add up.
    pub(super) fn jacobian<T: Number>(
        &self,
        mechanism: &Mechanism,
        situation: &Situation<'_, T>,
        mut emit: impl FnMut(usize, usize, T),
    ) {
        for (constraint, at) in &self.rows {
            situation.gradients(&mechanism.constraints[*constraint].0, |gradient| {
                let Some(row) = at[gradient.row] else { return };
                let [place, angle] = self.columns[gradient.body.index()];
                if let Some(column) = place {
                    emit(row, column, gradient.to[0]);
                    emit(row, column + 1, gradient.to[1]);
                }
                if let Some(column) = angle {
                    emit(row, column, gradient.to[2]);
                }
            });
        }
    }

    /// Boxes for the poses sought: the middle, moved along the rates by `h`, within `reach` of each unknown.
    pub(super) fn spread(
        &self,
        middle: &Middle,
        (rates, h): (&[f64], Interval),
        reach: &[Interval],
        poses: &mut [Pose<Interval>],
    ) {
        let at = |column: usize, from: f64| h * rates[column] + reach[column] + from;
        for &(unknown, column) in &self.unknowns {
            let body = unknown.body().index();
            let pose = &mut poses[body];
            match unknown {
                Unknown::Place(_) => {
                    (pose.x, pose.y) =
                        (at(column, middle[body][0]), at(column + 1, middle[body][1]));
                }
                Unknown::Angle(_) => (pose.s, pose.c) = at(column, middle[body][2]).sin_cos(),
            }
        }
    }

    /// What counts as one for every unknown: the mechanism's size, a radian.
    pub(super) fn units(&self, size: f64) -> Vec<f64> {
        let mut units = vec![1.0; self.size];
        for &(unknown, column) in &self.unknowns {
            if matches!(unknown, Unknown::Place(_)) {
                units[column] = size;
                units[column + 1] = size;
            }
        }
        units
    }

    /// Smallest of half widths: angles in rad, lengths in mechanism sizes.
    pub fn narrowest(&self, radii: &[f64], size: f64) -> f64 {
        let parts = self
            .unknowns
            .iter()
            .map(|&(unknown, column)| match unknown {
                Unknown::Place(_) => math::min(radii[column], radii[column + 1]) / size,
                Unknown::Angle(_) => radii[column],
            });
        parts.fold(f64::INFINITY, math::min)
    }

    /// Largest width of an image: angles in rad, lengths in mechanism sizes.
    pub fn widest(&self, image: &[Interval], size: f64) -> f64 {
        let mut widest = 0.0;
        for &(unknown, column) in &self.unknowns {
            widest = match unknown {
                Unknown::Place(_) => {
                    let part = math::max(image[column].width(), image[column + 1].width());
                    math::max(widest, part / size)
                }
                Unknown::Angle(_) => math::max(widest, image[column].width()),
            };
        }
        widest
    }
}
