//! Constraint rows and as many unknowns: residuals, Jacobian and boxes of poses.

use kempe_mechanism::Mechanism;
use kempe_mechanism::blocks::Unknown;
use kempe_mechanism::constraint::Situation;
use kempe_mechanism::layout::{Columns, Rows, To};
use kempe_mechanism::plan::NewtonBlock;
use kempe_mechanism::pose::Pose;
use kempe_number::{Interval, Number, math};

/// The middle of a box: x, y and angle of every body.
pub(crate) type Middle = Vec<[f64; 3]>;

/// The middle of poses with unwrapped angles near `near`.
pub(crate) fn middle_of(poses: &[Pose<f64>], near: &[f64]) -> Middle {
    let parts = poses.iter().zip(near);
    parts
        .map(|(pose, near)| [pose.x, pose.y, pose.angle_near(*near)])
        .collect()
}

/// As many rows as unknowns: a block of the plan, or all of its blocks.
#[derive(Clone, Debug)]
pub(crate) struct System {
    /// How many numbers are sought.
    pub size: usize,
    pub(super) columns: Columns,
    rows: Rows,
}

impl System {
    /// The square part of one block.
    pub fn of_block(block: &NewtonBlock) -> Self {
        let rows = block.rows.iter().take(block.size);
        Self::new(block.columns.clone(), Rows::new(rows.copied()))
    }

    /// The square parts of all blocks of a plan: every body's pose, without redundant rows and idle angles.
    pub fn whole(mechanism: &Mechanism) -> Self {
        let blocks = &mechanism.plan.decomposition.blocks;
        let solved = || blocks.iter().filter(|block| !block.rows.is_empty());
        let unknowns: Vec<Unknown> = solved().flat_map(|b| b.unknowns.clone()).collect();
        let rows = Rows::new(solved().flat_map(|b| b.rows.iter().copied()));
        Self::new(Columns::new(unknowns), rows)
    }

    fn new(columns: Columns, rows: Rows) -> Self {
        Self {
            size: columns.count,
            columns,
            rows,
        }
    }

    /// Residuals in the order of the rows.
    pub(super) fn residuals<T: Number>(
        &self,
        mechanism: &Mechanism,
        situation: &Situation<'_, T>,
    ) -> Vec<T> {
        let mut list = vec![T::zero(); self.size];
        (self.rows).residuals(mechanism, situation, |row, _, value| list[row] = value);
        list
    }

    /// Hands every entry of the Jacobian to `emit` as row, column, value; entries of one place add up.
    pub(super) fn jacobian<T: Number>(
        &self,
        mechanism: &Mechanism,
        situation: &Situation<'_, T>,
        mut emit: impl FnMut(usize, usize, T),
    ) {
        let put = |row, _, to: To, value| {
            if let Some(column) = to.column() {
                emit(row, column, value);
            }
        };
        (self.rows).jacobian(&self.columns, mechanism, situation, put);
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
        for &(unknown, column) in &self.columns.unknowns {
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
        for &(unknown, column) in &self.columns.unknowns {
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
            .columns
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
        for &(unknown, column) in &self.columns.unknowns {
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
