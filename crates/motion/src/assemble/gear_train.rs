//! Trains of gears: their angles are linear in each other.

use kempe_linear::Qr;
use kempe_mechanism::blocks::Unknown;
use kempe_mechanism::constraint::{InAngles, Joint, Situation};
use kempe_mechanism::plan::NewtonBlock;
use kempe_mechanism::pose::Pose;
use kempe_mechanism::structure::BodyId;
use kempe_mechanism::{Branch, Configuration, Design};

/// Angles of a block of gears and angle drives alone: linear equations, one solution.
pub(super) fn gear_train(
    design: &Design<f64>,
    block: &NewtonBlock,
    state: &Configuration<f64>,
    branch: &mut Branch,
) -> Option<Vec<Pose<f64>>> {
    let mechanism = &*design.mechanism;
    let column = |body: BodyId| {
        block
            .unknowns
            .iter()
            .position(|u| *u == Unknown::Angle(body))
    };
    if block
        .unknowns
        .iter()
        .any(|u| matches!(u, Unknown::Place(_)))
        || block.rows.len() != block.size
    {
        return None;
    }
    let mut qr = Qr::with_capacity(block.size, block.size);
    qr.reset(block.size, block.size);
    let mut rhs = vec![0.0; block.size];
    let near = branch.near.clone();
    let situation = Situation {
        geometry: &design.geometry,
        inputs: &state.inputs,
        poses: &state.poses,
        near: &near,
    };
    for (row, entry) in block.rows.iter().enumerate() {
        let constraint = &mechanism.constraints[entry.constraint].0;
        let InAngles { terms, constant } = constraint.in_angles(&situation)?;
        rhs[row] = constant;
        for (body, factor) in terms {
            match column(body) {
                Some(column) => qr.add(row, column, factor),
                None => rhs[row] -= factor * branch.near[body.index()],
            }
        }
    }
    qr.factor();
    qr.solve(&mut rhs);
    let mut poses = state.poses.clone();
    for (unknown, angle) in block.unknowns.iter().zip(&rhs) {
        let body = unknown.body().index();
        poses[body] = Pose::from_angle(poses[body].x, poses[body].y, *angle);
        branch.near[body] = *angle;
    }
    rhs.iter().all(|a| a.is_finite()).then_some(poses)
}
