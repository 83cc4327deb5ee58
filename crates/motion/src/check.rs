//! Everything worth knowing about a mechanism before it moves.

use std::sync::Arc;

use kempe_mechanism::assur::{AssurGroup, assur_groups};
use kempe_mechanism::mobility::{Mobility, mobility, state_at, surplus_of};
use kempe_mechanism::structure::{BodyId, Source};
use kempe_mechanism::{Branch, Design};

use crate::assemble::Assemblies;
use crate::drive_path::DrivePath;
use crate::events::Event;
use crate::four_bar::{FourBar, four_bars};
use crate::motion::{Demand, EndReason, Motion, MotionError};
use crate::progress::{Progress, Silent};
use crate::temporary_drives::hold;

/// A cylinder or slide is followed this many mechanism sizes from its start when its reach is asked for.
const FAR: f64 = 20.0;
/// Constraints that miss each other by no more than this along a motion, in mechanism sizes and rad, agree as far as rows of a
/// table are taken to close.
const AGREED: f64 = 1e-9;
/// Shortest length of a cylinder that is tried, in mechanism sizes.
const SHORTEST: f64 = 1e-6;

/// What a check found.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Findings {
    /// Freedoms, counted and measured.
    pub mobility: Mobility,
    /// How many drives there are.
    pub drives: usize,
    /// Assur groups in the order in which they are solved.
    pub groups: Vec<AssurGroup>,
    /// Four-bar loops.
    pub four_bars: Vec<FourBar>,
    /// Bodies with an idle freedom.
    pub idle: Vec<BodyId>,
    /// Joints with redundant constraints.
    pub redundant: Vec<Source>,
    /// All assemblies where one was chosen, at the start or as drawn.
    pub assemblies: Assemblies,
    /// Whether assemblies were looked for: with too few drives there is no place at which they could be counted.
    pub searched: bool,
    /// How far the drive can go on this circuit.
    pub reach: Option<Reach>,
    /// The motion that the drives' laws demand, as far as it goes.
    pub motion: Option<Arc<Motion>>,
    /// Why there is no motion, if there is none.
    pub problem: Option<MotionError>,
}

/// How far a drive can go.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Reach {
    /// Lowest and highest coordinate (or time), SI.
    pub range: (f64, f64),
    /// Why it ends there.
    pub ends: (EndReason, EndReason),
    /// The drive can turn on without end.
    pub full_turn: bool,
    /// Dead points and change points of the demanded motion.
    pub events: Vec<Event>,
}

/// Checks a mechanism for the model's parameter values.
pub fn check(design: &Design<f64>) -> Findings {
    check_with_progress(design, &mut Silent)
}

/// As [`check`]; `progress` hears how far it has come. Stopped, it returns what it found until then, with
/// [`MotionError::Stopped`] as the problem.
pub fn check_with_progress(design: &Design<f64>, progress: &mut dyn Progress) -> Findings {
    let mechanism = &*design.mechanism;
    let plan = &mechanism.plan;
    let mut findings = Findings {
        mobility: mobility(design, None),
        drives: mechanism.model.drives.len(),
        groups: assur_groups(mechanism),
        four_bars: four_bars(mechanism, &design.geometry),
        idle: plan.decomposition.idle.clone(),
        redundant: Vec::new(),
        assemblies: Assemblies::default(),
        searched: true,
        reach: None,
        motion: None,
        problem: None,
    };
    for row in &plan.decomposition.surplus {
        let source = mechanism.constraints[row.constraint].1;
        if !findings.redundant.contains(&source) {
            findings.redundant.push(source);
        }
    }
    match Motion::with_progress(design, progress) {
        Ok(motion) => {
            findings.mobility = mobility_at_start(&motion);
            match reach(&motion, progress) {
                Ok(reach) => findings.reach = Some(reach),
                Err(stopped) => findings.problem = Some(stopped),
            }
            findings.assemblies = motion.assemblies.clone();
            findings.motion = Some(motion);
        }
        Err(problem) => {
            if let MotionError::CannotAssemble { assemblies, .. }
            | MotionError::Locked { assemblies, .. } = &problem
            {
                findings.assemblies = (**assemblies).clone();
            }
            findings.mobility = mobility_standing(design, &findings.assemblies);
            if matches!(
                problem,
                MotionError::NoDrive | MotionError::Undetermined { .. }
            ) {
                findings.searched = false;
                // The bodies and what joins them are the same however they are held.
                if let Some(held) = hold(mechanism, &design.parameters, progress) {
                    let coordinates = vec![0.0; mechanism.model.drives.len()];
                    let state = state_at(mechanism, &held.assembly.poses, &coordinates);
                    let mut branch = Branch::neutral(mechanism);
                    branch.near = held.assembly.branch.near;
                    findings.mobility = mobility(design, Some((&state, &branch)));
                }
            }
            findings.problem = Some(problem);
        }
    }
    findings
}

/// Freedoms of what stands and does not move, in the first of its assemblies.
pub fn mobility_standing(design: &Design<f64>, assemblies: &Assemblies) -> Mobility {
    let mechanism = &*design.mechanism;
    let Some(stands) = assemblies.list.first() else {
        return mobility(design, None);
    };
    // The joints are the same wherever the drives hold it.
    let coordinates = vec![0.0; mechanism.model.drives.len()];
    let state = state_at(mechanism, &stands.poses, &coordinates);
    mobility(design, Some((&state, &stands.branch)))
}

/// Freedoms in the assembly from which a motion starts.
pub fn mobility_at_start(motion: &Motion) -> Mobility {
    let (mechanism, design) = (motion.mechanism(), &motion.design);
    let Some(chosen) = motion.assemblies.list.first() else {
        return mobility(design, None);
    };
    let mut coordinates = vec![0.0; mechanism.model.drives.len()];
    motion.path.coordinates(motion.anchor, &mut coordinates);
    let state = state_at(mechanism, &chosen.poses, &coordinates);
    let found = mobility(design, Some((&state, &chosen.branch)));
    let driven = mechanism.model.drives.len() + mechanism.plan.decomposition.idle.len();
    match surplus_misfit(motion) {
        // It moves all the same, where constraints that repeat others nearly agree with them.
        Some(misfit) if found.by_rank.is_some_and(|rank| rank < driven) && misfit <= AGREED => {
            let nearly = (found.clone()).nearly(design, (&state, &chosen.branch), misfit);
            match nearly.by_rank.is_some_and(|rank| rank >= driven) {
                true => nearly,
                false => found,
            }
        }
        _ => found,
    }
}

/// How far the constraints that the plan leaves out miss the others at the ends and in the middle of a motion, in mechanism
/// sizes and rad; `None` where there are none.
fn surplus_misfit(motion: &Motion) -> Option<f64> {
    let (mechanism, size) = (motion.mechanism(), motion.size());
    let surplus = surplus_of(mechanism);
    if surplus.is_empty() {
        return None;
    }
    let (low, high) = motion.reached();
    let mut solver = motion.solver::<f64>();
    let mut misfit = 0.0_f64;
    for p in [low, 0.5 * (low + high), high] {
        motion.branch_at(p, &mut solver.branch);
        motion.path.coordinates(p, &mut solver.coordinates);
        solver.run(motion, &motion.design);
        let situation = solver.state.situation(&motion.design, &solver.branch);
        for row in &surplus {
            let residual = situation.residual(&mechanism.constraints[row.constraint].0)[row.row];
            misfit = misfit.max(residual.abs() / size);
        }
    }
    Some(misfit)
}

/// How far the moving drive can go from its start. Where the demanded motion ends by itself, that is its end; beyond an end
/// that was only asked for it is followed on.
fn reach(motion: &Motion, progress: &mut dyn Progress) -> Result<Reach, MotionError> {
    let mut reach = Reach {
        range: motion.reached(),
        ends: motion.ends,
        full_turn: false,
        events: motion.events.clone(),
    };
    let open = [motion.ends.0, motion.ends.1].map(|end| end == EndReason::Covered);
    let DrivePath::Coordinate { drive, .. } = &motion.path else {
        return Ok(reach);
    };
    let Some(law) = motion.mechanism().model.drives.get(*drive) else {
        return Ok(reach);
    };
    let turning = matches!(law.kind, kempe_model::DriveKind::Turn { .. });
    let far = if turning {
        std::f64::consts::TAU
    } else {
        FAR * motion.size()
    };
    // At least what the file demands.
    let mut demanded = (
        (motion.anchor - far).min(motion.demanded.0),
        (motion.anchor + far).max(motion.demanded.1),
    );
    if matches!(law.kind, kempe_model::DriveKind::Cylinder { .. }) {
        demanded.0 = demanded.0.max(SHORTEST * motion.size());
    }
    let demand = Demand {
        path: motion.path.clone(),
        range: demanded,
        start: motion.anchor,
        assemblies: Some(motion.assemblies.clone()),
    };
    if open == [false, false] {
        return Ok(reach);
    }
    match Motion::along(&motion.design, demand, progress) {
        Ok(wide) => {
            let (low, high) = wide.reached();
            if open[0] {
                (reach.range.0, reach.ends.0) = (low.min(reach.range.0), wide.ends.0);
            }
            if open[1] {
                (reach.range.1, reach.ends.1) = (high.max(reach.range.1), wide.ends.1);
            }
            reach.full_turn = turning && reach.ends == (EndReason::Covered, EndReason::Covered);
            Ok(reach)
        }
        Err(stopped @ MotionError::Stopped { .. }) => Err(stopped),
        Err(_) => Ok(reach),
    }
}
