//! Blocks without a closed form: every pose they can take.

use std::cmp::Ordering;

use kempe_mechanism::blocks::Unknown;
use kempe_mechanism::constraint::Joint;
use kempe_mechanism::plan::NewtonBlock;
use kempe_mechanism::pose::Pose;
use kempe_mechanism::structure::Constraint;
use kempe_mechanism::{Branch, Configuration};
use kempe_number::{Random, math};

use super::along_curve;
use super::assemblies::Shortfall;
use super::gear_train::gear_train;
use super::open_loop::{self, Gear};
use super::polynomial::{Solutions, all_real_solutions};
use super::search::Search;

/// Random starts for a block to which the complete method does not apply.
const SEARCH_STARTS: usize = 400;
/// Residual of a row, in mechanism sizes, up to which a block closes.
const ROW_CLOSED: f64 = 1e-9;
/// Residual of a row, m or rad, up to which a block closes however small the mechanism is.
const ROW_CLOSED_ANYWAY: f64 = 1e-12;
/// A wheel may stand this far, rad, beyond half a turn from where its angle is counted: rounding decides no assembly.
const HALF_TURN: f64 = 1e-9;
/// A pose read off a trace may miss the bodies placed before by this much (in sizes of the mechanism, and rad).
const SAME_BEFORE: f64 = 1e-2;

impl Search<'_> {
    /// Goes on from every pose of a block.
    pub(super) fn descend_block(
        &mut self,
        step: usize,
        block: usize,
        state: Configuration<f64>,
        mut branch: Branch,
        wanted: bool,
    ) {
        let block = &self.plan.newton_blocks[block];
        if let Some(poses) = gear_train(self.design, block, &state, &mut branch) {
            branch.guess.clone_from(&poses);
            let mut state = state;
            if self.solve(step, 1.0, &mut state, &mut branch) {
                self.descend(step + 1, state, branch, wanted);
            } else {
                self.left_open(step, &branch, wanted);
            }
            return;
        }
        let Some(candidates) = self.candidates(block, step, &state, &branch) else {
            self.stopped = true;
            return;
        };
        let mut found: Vec<(Configuration<f64>, Branch)> = Vec::new();
        for candidate in candidates {
            let (mut state, mut branch) = (state.clone(), branch.clone());
            branch.guess.clone_from(&candidate);
            for unknown in &block.unknowns {
                let body = unknown.body().index();
                branch.near[body] = candidate[body].angle_near(self.hints.meant[body]);
            }
            if self.solve(step, 1.0, &mut state, &mut branch)
                && self.closes(block, &state, &branch)
                && self.counts_from(block, &state, &branch)
                && found
                    .iter()
                    .all(|(other, _)| !self.same(&other.poses, &state.poses))
            {
                branch.guess.clone_from(&state.poses);
                found.push((state, branch));
            }
        }
        if found.is_empty() {
            self.left_open(step, &branch, wanted);
        }
        // In a fixed order: by the angles of the block's bodies.
        let angles = |(state, _): &(Configuration<f64>, Branch)| -> Vec<f64> {
            let poses = block
                .unknowns
                .iter()
                .map(|u| &state.poses[u.body().index()]);
            poses.map(|pose| pose.angle_near(0.0)).collect()
        };
        found.sort_by(|a, b| {
            let (a, b) = (angles(a), angles(b));
            let mut orders = a.iter().zip(&b).map(|(x, y)| x.total_cmp(y));
            orders.find(|o| o.is_ne()).unwrap_or(Ordering::Equal)
        });
        self.order(step, &mut found);
        for (state, branch) in found {
            let wanted = wanted && self.hints.sides_hold(step, &state.poses);
            self.descend(step + 1, state, branch, wanted);
        }
    }

    /// Poses in whose neighbourhood those of a block are looked for; `None` when stopped.
    fn candidates(
        &mut self,
        block: &NewtonBlock,
        step: usize,
        state: &Configuration<f64>,
        branch: &Branch,
    ) -> Option<Vec<Vec<Pose<f64>>>> {
        let situation = state.situation(self.design, branch);
        // The pose that the file tells is tried as well: no path may lose it.
        let mut candidates = vec![self.hints.start(&state.poses)];
        let (mechanism, size) = (self.mechanism, self.size);
        let mut work = self.work;
        let earlier = self.earlier.get(self.paths.len());
        let hears = &mut |part| self.tell(Some(part));
        let solutions = all_real_solutions(
            block, mechanism, &situation, size, earlier, &mut work, hears,
        );
        self.work = work;
        match solutions {
            Solutions::Stopped => return None,
            Solutions::Found(poses, report) => {
                if report.exhausted {
                    self.shortfall.get_or_insert(Shortfall::Exhausted);
                } else if report.lost > 0 {
                    self.shortfall.get_or_insert(Shortfall::LostPath);
                }
                self.paths.push(report);
                candidates.extend(poses);
            }
            Solutions::NotAlgebraic => {
                if let Some(found) = along_curve::poses(self.design, block, state) {
                    candidates.extend(found);
                    return Some(candidates);
                }
                let opened = self.opened_at_gear(block, step, state)?;
                self.shortfall.get_or_insert(if opened.is_empty() {
                    Shortfall::Searched
                } else {
                    Shortfall::Scanned
                });
                if opened.is_empty() {
                    candidates.extend(random_starts(block, &state.poses, self.size));
                }
                candidates.extend(opened);
            }
        }
        Some(candidates)
    }

    /// Poses near those of a block that holds one gear pair or rack, for the poses found so far; none where it holds
    /// more, or cannot be opened. `None` when stopped.
    fn opened_at_gear(
        &mut self,
        block: &NewtonBlock,
        step: usize,
        state: &Configuration<f64>,
    ) -> Option<Vec<Vec<Pose<f64>>>> {
        let mut gears = (block.rows.iter().map(|row| row.constraint))
            .filter(|index| self.mechanism.constraints[*index].0.counts_turns());
        let (Some(gear), None) = (gears.next(), gears.next()) else {
            return Some(Vec::new());
        };
        if self.opened.iter().all(|(index, _)| *index != gear) {
            let found = open_loop::candidates(
                self.design,
                self.coordinates,
                Gear {
                    constraint: gear,
                    step,
                    meant: &self.hints.meant,
                },
                self.progress,
            )?;
            self.opened.push((gear, found));
        }
        let before = &self.plan.blocks[..step];
        let fits = |poses: &Vec<Pose<f64>>| {
            before.iter().flat_map(|b| &b.unknowns).all(|unknown| {
                let body = unknown.body().index();
                let (a, b) = (&poses[body], &state.poses[body]);
                match unknown {
                    Unknown::Angle(_) => (a.c - b.c).abs().max((a.s - b.s).abs()) <= SAME_BEFORE,
                    Unknown::Place(_) => {
                        (a.x - b.x).abs().max((a.y - b.y).abs()) <= SAME_BEFORE * self.size
                    }
                }
            })
        };
        let found = self.opened.iter().filter(|(index, _)| *index == gear);
        let near = found.flat_map(|(_, list)| list).filter(|p| fits(p));
        Some(near.cloned().collect())
    }

    /// Whether the block's rows hold, within the ends of its joints.
    fn closes(&self, block: &NewtonBlock, state: &Configuration<f64>, branch: &Branch) -> bool {
        let situation = state.situation(self.design, branch);
        let enough = (ROW_CLOSED * self.size.max(f64::MIN_POSITIVE)).max(ROW_CLOSED_ANYWAY);
        block.rows.iter().all(|row| {
            let constraint = &self.mechanism.constraints[row.constraint].0;
            let residual = situation.residual(constraint)[row.row];
            residual.abs() <= enough
                && !situation.is_reversed(constraint)
                && !constraint.is_past_end(&situation)
        })
    }

    /// Whether the wheels of the block's gears and racks stand within half a turn of the angles they are counted from.
    fn counts_from(
        &self,
        block: &NewtonBlock,
        state: &Configuration<f64>,
        branch: &Branch,
    ) -> bool {
        let constraints = block
            .rows
            .iter()
            .map(|row| &self.mechanism.constraints[row.constraint].0);
        constraints
            .filter(|c| c.counts_turns())
            .flat_map(Constraint::bodies)
            .all(|body| {
                let index = body.index();
                let angle = state.poses[index].angle_near(branch.near[index]);
                (angle - self.hints.meant[index]).abs() <= std::f64::consts::PI + HALF_TURN
            })
    }
}

/// Starts spread over the mechanism's surroundings, for blocks with gears or too many paths.
fn random_starts(block: &NewtonBlock, poses: &[Pose<f64>], size: f64) -> Vec<Vec<Pose<f64>>> {
    let mut random = Random(0x005e_ed0f_ba11);
    let reach = 4.0 * size;
    let mut starts = Vec::with_capacity(SEARCH_STARTS);
    for _ in 0..SEARCH_STARTS {
        let mut poses = poses.to_vec();
        for unknown in &block.unknowns {
            let pose = &mut poses[unknown.body().index()];
            match unknown {
                Unknown::Angle(_) => {
                    (pose.s, pose.c) = math::sin_cos(random.uniform() * std::f64::consts::TAU);
                }
                Unknown::Place(_) => {
                    pose.x = (random.uniform() - 0.5) * reach;
                    pose.y = (random.uniform() - 0.5) * reach;
                }
            }
        }
        starts.push(poses);
    }
    starts
}
