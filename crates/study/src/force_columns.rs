//! What a study of forces reports where it names no columns: everything that drives and joints carry.

use kempe_mechanism::Mechanism;
use kempe_model::{
    Chamber, Column, Drive, DriveId, DriveKind, ForceMeasure, Hodograph, InnerState, JointId,
    JointRef, Leaf, Plot, PointId,
};
use kempe_units::{Dimension, Expr};

use crate::quantity::Quantity;

/// Efforts and powers of all drives, the loads of all joints, shaking force and energies, named as a file would ask for
/// them.
pub(crate) fn standard(mechanism: &Mechanism) -> Vec<Quantity> {
    let model = &mechanism.model;
    let mut list = Vec::new();
    // What gives along a joint that is let go is the joint's load.
    let is_drive = |drive: &Drive| !matches!(drive.kind, DriveKind::Release { .. });
    let drives = model.drives.iter().enumerate();
    for (index, drive) in drives.filter(|(_, drive)| is_drive(drive)) {
        let (id, name) = (DriveId(index as u32), &drive.name);
        list.push(match drive.kind {
            DriveKind::Turn { .. } => force(
                format!("torque({name})"),
                ForceMeasure::Drive(id),
                Dimension::TORQUE,
            ),
            _ => force(
                format!("force({name})"),
                ForceMeasure::Drive(id),
                Dimension::FORCE,
            ),
        });
        list.push(force(
            format!("power({name})"),
            ForceMeasure::Power(id),
            Dimension::POWER,
        ));
        let (reduced, load) = if drive.dimension == Dimension::ANGLE {
            (Dimension::INERTIA, Dimension::TORQUE)
        } else {
            (Dimension::MASS, Dimension::FORCE)
        };
        list.push(force(
            format!("reduced_mass({name})"),
            ForceMeasure::ReducedMass(id),
            reduced,
        ));
        list.push(force(
            format!("reduced_load({name})"),
            ForceMeasure::ReducedLoad(id),
            load,
        ));
        let sides = [
            ("bore_pressure", Chamber::Bore),
            ("ring_pressure", Chamber::Ring),
        ];
        let pressures = sides.map(|(what, side)| (what, InnerState::Pressure(id, side)));
        if pressures
            .iter()
            .any(|(_, state)| model.inner_law(*state).is_some())
        {
            list.extend(pressures.map(|(what, state)| Quantity {
                name: format!("{what}({name})"),
                measure: Expr::Leaf(Leaf::Inner(state)),
                dimension: Dimension::PRESSURE,
            }));
        } else if let Some(cylinder) = model.actions.cylinders.iter().find(|c| c.drive == id) {
            list.push(force(
                format!("pressure({name})"),
                ForceMeasure::Pressure(id),
                Dimension::PRESSURE,
            ));
            if cylinder.supply.is_some() || cylinder.relief.is_some() {
                list.push(force(
                    format!("capacity({name})"),
                    ForceMeasure::Capacity(id),
                    Dimension::FORCE,
                ));
            }
        }
    }
    for (joint, text, moment) in joints(mechanism) {
        let size = ForceMeasure::Reaction(joint);
        list.push(force(format!("reaction({text})"), size, Dimension::FORCE));
        let x = ForceMeasure::ReactionX(joint);
        list.push(force(format!("reaction_x({text})"), x, Dimension::FORCE));
        let y = ForceMeasure::ReactionY(joint);
        list.push(force(format!("reaction_y({text})"), y, Dimension::FORCE));
        let angle = ForceMeasure::ReactionAngle(joint);
        list.push(force(
            format!("reaction_angle({text})"),
            angle,
            Dimension::ANGLE,
        ));
        if moment {
            let moment = ForceMeasure::ReactionMoment(joint);
            list.push(force(
                format!("reaction_moment({text})"),
                moment,
                Dimension::TORQUE,
            ));
        }
    }
    let whole = [
        (
            "shaking_force",
            ForceMeasure::ShakingForce,
            Dimension::FORCE,
        ),
        (
            "shaking_force_x",
            ForceMeasure::ShakingForceX,
            Dimension::FORCE,
        ),
        (
            "shaking_force_y",
            ForceMeasure::ShakingForceY,
            Dimension::FORCE,
        ),
        (
            "shaking_moment",
            ForceMeasure::ShakingMoment,
            Dimension::TORQUE,
        ),
        (
            "kinetic_energy",
            ForceMeasure::KineticEnergy,
            Dimension::ENERGY,
        ),
        (
            "potential_energy",
            ForceMeasure::PotentialEnergy,
            Dimension::ENERGY,
        ),
    ];
    list.extend(whole.map(|(name, measure, dimension)| force(name.to_owned(), measure, dimension)));
    list
}

/// Joints whose force is drawn as a hodograph where a study of forces names no plot: at most this many.
const MOST_HODOGRAPHS: usize = 4;

/// The plots of a study of forces that names none: what the drives give, beside what they can give, and the forces of the
/// first joints.
pub(crate) fn standard_plots(mechanism: &Mechanism) -> Vec<Plot> {
    let quantities = standard(mechanism);
    let column = |quantity: &Quantity| Column {
        name: quantity.name.clone(),
        measure: quantity.measure.clone(),
        dimension: quantity.dimension,
    };
    let capacity = |id: DriveId| {
        let mut found = quantities.iter();
        found.find(|q| q.measure == Expr::Leaf(Leaf::Force(ForceMeasure::Capacity(id))))
    };
    let of_drives = quantities.iter().filter_map(|q| match &q.measure {
        Expr::Leaf(Leaf::Force(ForceMeasure::Drive(id))) => {
            let both = std::iter::once(q).chain(capacity(*id));
            Some(Plot::Curves(both.map(column).collect()))
        }
        Expr::Leaf(Leaf::Force(ForceMeasure::Power(_) | ForceMeasure::Pressure(_))) => {
            Some(Plot::Curves(vec![column(q)]))
        }
        _ => None,
    });
    let of_joints = joints(mechanism).into_iter().take(MOST_HODOGRAPHS);
    let of_joints = of_joints.map(|(joint, text, _)| {
        Plot::Hodograph(Hodograph {
            name: format!("hodograph({text})"),
            joint,
        })
    });
    of_drives.chain(of_joints).collect()
}

/// All joints with a load of their own: each with the link that feels it, how a file writes that, and whether it carries
/// a moment. A pin of many links is there once for every later one.
pub(crate) fn joints(mechanism: &Mechanism) -> Vec<(JointRef, String, bool)> {
    let model = &mechanism.model;
    let link = |id: kempe_model::LinkId| model.links.get(id.index()).map_or("", |l| &l.name);
    let mut list = Vec::new();
    for (index, point) in model.points.iter().enumerate() {
        for (place, later) in point.links.iter().enumerate().skip(1) {
            // Links that are welded there are one body: the weld carries that load.
            let body = mechanism.body_of(*later);
            let mut before = point.links.iter().take(place);
            if before.any(|l| mechanism.body_of(*l) == body) {
                continue;
            }
            list.push((
                JointRef::Pin(PointId(index as u32), Some(*later)),
                format!("{}, {}", point.name, link(*later)),
                false,
            ));
        }
    }
    for (index, joint) in model.joints.iter().enumerate() {
        let first = joint.kind.links().0;
        let moment = joint.kind.holds_angle();
        list.push((
            JointRef::Joint(JointId(index as u32), Some(first)),
            format!("{}, {}", joint.name, link(first)),
            moment,
        ));
    }
    list
}

fn force(name: String, measure: ForceMeasure, dimension: Dimension) -> Quantity {
    Quantity {
        name,
        measure: Expr::Leaf(Leaf::Force(measure)),
        dimension,
    }
}
