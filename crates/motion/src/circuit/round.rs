//! Following the curve of poses all the way round.

use kempe_mechanism::Mechanism;
use kempe_model::DriveKind;

use crate::drive_path::DrivePath;
use crate::events::locate_limit;
use crate::motion::runs_away;
use crate::progress::{Done, Progress, Stage};
use crate::trace::{Follower, Node, WIGGLE, distance, hermite, hides_limits};

/// Steps after which a circuit that has not closed is given up.
pub const CIRCUIT_STEPS: usize = 50_000;

/// Follows the curve until it is back at its start (angles of bodies and of a turning drive count modulo a turn). Along
/// time, where nothing comes back, until the motion's `end`; and no further than to where a part runs away. `None` when
/// stopped.
pub(crate) fn go_round(
    follower: &mut Follower<'_, DrivePath>,
    start: Node,
    mechanism: &Mechanism,
    path: &DrivePath,
    end: f64,
    progress: &mut dyn Progress,
) -> Option<(Vec<Node>, bool)> {
    let turning = match path {
        DrivePath::Coordinate { drive, .. } => {
            matches!(
                mechanism.model.drives.get(*drive).map(|d| &d.kind),
                Some(DriveKind::Turn { .. })
            )
        }
        DrivePath::Time { .. } => false,
    };
    let last = start.z.len() - 1;
    let is_angle = |i: usize| (i < last && i % 3 == 2) || (i == last && turning);
    // The start, seen whole turns away, nearest to a point.
    let image = |z: &[f64]| -> Vec<f64> {
        (0..=last)
            .map(|i| {
                let turns = if is_angle(i) {
                    ((z[i] - start.z[i]) / std::f64::consts::TAU).round()
                } else {
                    0.0
                };
                start.z[i] + turns * std::f64::consts::TAU
            })
            .collect()
    };
    let mut nodes = vec![start.clone()];
    let mut step = 0.02;
    let mut travelled = 0.0;
    for _ in 0..CIRCUIT_STEPS {
        progress
            .reached(Stage::Following, Done::Unknown)
            .continue_value()?;
        let from = nodes[nodes.len() - 1].clone();
        let Some(next) = follower.advance(&from, &mut step) else {
            return Some((nodes, false));
        };
        let h = distance(&from.z, &next.z);
        travelled += h;
        // Back at the start when it lies between the two nodes and the travel is the same way.
        let home = image(&next.z);
        let ahead: f64 = (home.iter().zip(&from.z))
            .zip(&from.tangent)
            .map(|((a, b), t)| (a - b) * t)
            .sum();
        let same_way: f64 = start
            .tangent
            .iter()
            .zip(&from.tangent)
            .map(|(a, b)| a * b)
            .sum();
        let reached = travelled > 2.0 * h && (0.0..=1.05 * h).contains(&ahead) && same_way > 0.9;
        if reached && distance(&hermite_home(&from, &next, &home, h), &home) < 0.02 * h.max(1e-6) {
            let home = Node::new(home, start.tangent.clone());
            // Dead points just before the start.
            let rest = distance(&from.z, &home.z);
            if from.parameter_rate() * home.parameter_rate() < 0.0 {
                nodes.push(locate_limit(follower, &from, &home));
            } else if rest < WIGGLE {
                nodes.pop();
            } else if hides_limits(&from, &home) {
                step = 0.5 * rest;
                continue;
            }
            nodes.push(home);
            return Some((nodes, true));
        }
        if from.parameter_rate() * next.parameter_rate() < 0.0 {
            nodes.push(locate_limit(follower, &from, &next));
        }
        let over = matches!(path, DrivePath::Time { .. }) && follower.parameter(&next.z) > end;
        let away = runs_away(&next.z, &start.z, false);
        nodes.push(next);
        if over || away {
            break;
        }
    }
    Some((nodes, false))
}

/// The point of the step's cubic that lies nearest to `home`, by its projection on the chord.
fn hermite_home(from: &Node, next: &Node, home: &[f64], h: f64) -> Vec<f64> {
    let mut s = 0.5;
    for _ in 0..20 {
        let z = hermite(from, next, s);
        let miss: f64 = (home.iter().zip(&z))
            .zip(from.z.iter().zip(&next.z))
            .map(|((a, b), (p, q))| (a - b) * (q - p))
            .sum();
        s += miss / (h * h);
        s = s.clamp(-0.1, 1.1);
    }
    hermite(from, next, s)
}
