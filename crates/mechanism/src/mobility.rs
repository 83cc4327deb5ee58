//! Freedoms counted and measured.

use kempe_linear::{RANK_TOLERANCE, SparseRow, rank};

use crate::Mechanism;
use crate::blocks::Row;
use crate::branch::Branch;
use crate::configuration::Configuration;
use crate::constraint::{Joint, Pairs};
use crate::design::Design;
use crate::evidence::is_finite;
use crate::layout::{Columns, Rows, rows_of, unknowns_of};
use crate::pose::Pose;

/// Constraints that others repeat to this part nearly repeat them.
const NEARLY: f64 = 1e-6;

/// Mobility two ways.
#[derive(Clone, Debug, PartialEq)]
pub struct Mobility {
    /// Links, the frame included, welded links counted once; a cylinder counts as its barrel and rod.
    pub links: usize,
    /// Lower pairs (pins and sliders); a multiple joint of k links counts k - 1, a cylinder its two pins and its slide.
    pub lower_pairs: usize,
    /// Higher pairs (pins in slots, gears, racks).
    pub higher_pairs: usize,
    /// Chebyshev-Grübler: `3 (links - 1) - 2 lower_pairs - higher_pairs`.
    pub count: i64,
    /// Unknowns less the rank of the constraint Jacobian of the joints at the pose, when a pose is known.
    pub by_rank: Option<usize>,
    /// Rows of the joints' constraints beyond their rank at the pose.
    pub redundant_rows: Option<usize>,
    /// How far redundant constraints miss each other, in mechanism sizes and rad, where they are taken to agree though they do
    /// not quite: exactly as its dimensions are, the mechanism has less freedoms.
    pub misfit: Option<f64>,
}

impl Mobility {
    /// The same with constraints that nearly repeat others, which they miss by `misfit`, taken to agree with them.
    pub fn nearly(
        mut self,
        design: &Design<f64>,
        (state, branch): (&Configuration<f64>, &Branch),
        misfit: f64,
    ) -> Self {
        let mechanism = &*design.mechanism;
        let total = rows_of(mechanism, mechanism.joint_constraints).count();
        let rank = joint_rank(design, branch, state, NEARLY);
        self.by_rank = Some(3 * (mechanism.bodies - 1) - rank);
        self.redundant_rows = Some(total - rank);
        self.misfit = Some(misfit);
        self
    }
}

/// The rows that the plan leaves out because others say the same.
pub fn surplus_of(mechanism: &Mechanism) -> Vec<Row> {
    let decomposition = &mechanism.plan.decomposition;
    let in_blocks = decomposition.blocks.iter().flat_map(|b| &b.surplus);
    in_blocks.chain(&decomposition.surplus).copied().collect()
}

/// Counts and, with a pose, measures the mobility.
pub fn mobility(design: &Design<f64>, pose: Option<(&Configuration<f64>, &Branch)>) -> Mobility {
    let mechanism = &*design.mechanism;
    let mut pairs = Pairs::default();
    for (constraint, _) in &mechanism.constraints {
        let of = constraint.pairs();
        pairs.links += of.links;
        pairs.lower += of.lower;
        pairs.higher += of.higher;
    }
    let links = mechanism.bodies as i64 + pairs.links;
    let mut it = Mobility {
        links: links as usize,
        lower_pairs: pairs.lower as usize,
        higher_pairs: pairs.higher as usize,
        count: 3 * (links - 1) - 2 * pairs.lower - pairs.higher,
        by_rank: None,
        redundant_rows: None,
        misfit: None,
    };
    if let Some((state, branch)) = pose.filter(|(s, _)| s.poses.iter().all(is_finite)) {
        let rows: usize = mechanism.constraints[..mechanism.joint_constraints]
            .iter()
            .map(|(c, _)| c.rows())
            .sum();
        let rank = joint_rank(design, branch, state, RANK_TOLERANCE);
        it.by_rank = Some(3 * (mechanism.bodies - 1) - rank);
        it.redundant_rows = Some(rows - rank);
    }
    it
}

/// Rank of the joints' scaled constraint Jacobian at a pose.
fn joint_rank(
    design: &Design<f64>,
    branch: &Branch,
    state: &Configuration<f64>,
    tolerance: f64,
) -> usize {
    let mechanism = &*design.mechanism;
    let size = design.size();
    let situation = state.situation(design, branch);
    let joints = Rows::new(rows_of(mechanism, mechanism.joint_constraints));
    let columns = Columns::new(unknowns_of(mechanism));
    let mut rows: Vec<SparseRow> = vec![Vec::with_capacity(6); joints.count];
    joints.scaled_jacobian(&columns, mechanism, &situation, size, |row, to, value| {
        let Some(column) = to.column() else { return };
        let row = &mut rows[row];
        match row.iter_mut().find(|(c, _)| *c == column) {
            Some((_, sum)) => *sum += value,
            None if value != 0.0 => row.push((column, value)),
            None => {}
        }
    });
    for row in &mut rows {
        row.sort_unstable_by_key(|(column, _)| *column);
    }
    rank(rows, columns.count, tolerance)
}

/// A state at given poses, ready for residuals and gradients.
pub fn state_at(
    mechanism: &Mechanism,
    poses: &[Pose<f64>],
    coordinates: &[f64],
) -> Configuration<f64> {
    let mut state = Configuration::new(mechanism);
    state.poses.copy_from_slice(poses);
    state.set_inputs(mechanism, coordinates);
    state
}
