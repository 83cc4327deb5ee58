//! Where a motion starts, and how it is followed from there to both ends of its range.

use kempe_mechanism::mobility::surplus_of;
use kempe_mechanism::{Branch, Design};

use super::follow::follow_both;
use super::restriction::{Unlocated, restricting_steps};
use super::{Demand, EndReason, Motion, MotionError};
use crate::assemble::{Assemblies, Assembly, Earlier, find_assemblies_after};
use crate::drive_path::DrivePath;
use crate::progress::{Progress, Stage};
use crate::trace::{Follower, Node, Path, Storage, apart};

/// Sizes of mechanisms, m, whose poses, forces and derivatives come out to the digits of any other size; from 1e-60 to 1e60 they were
/// seen to.
pub const SIZES: (f64, f64) = (1e-40, 1e40);
/// Where a motion starts at a singular pose, its branch is looked for this far (in path scales) on the way, instead ...
const NEAR: [f64; 3] = [0.0137, 0.0411, 0.1234];
/// ... and at these parts of the range.
const PARTS: [f64; 5] = [0.0137, 0.0411, 0.1234, 0.3719, 0.7183];
/// Pivot ratio of the bordered Jacobian at a start above which it is far from where branches cross. The closed forms lose
/// half of their digits at a crossing, so a start on one comes out a little off it, with a tangent that means nothing.
const DETERMINED: f64 = 1e-6;
/// How much better (in that ratio) a place near a start that is not so far must be to begin there instead.
const BETTER: f64 = 30.0;
/// Places that are compared where none is that far, and tried where the mechanism cannot be assembled at the start.
const COMPARED: usize = 3;
const TRIES: usize = 2;
/// What redundant constraints hold at second order is stuck within so many path scales, where they miss each other by rounding.
const GIVES: f64 = 1e-4;
/// Assemblies no farther from the pose at the start than this many times the nearest one may all lead to it.
const LEADS_TO: f64 = 30.0;

/// Where a trace may begin.
struct Beginning {
    anchor: f64,
    /// The design, its angles counted as in the first of the assemblies.
    design: Design<f64>,
    /// The one to begin with first.
    assemblies: Assemblies,
    up: Node,
    down: Node,
    /// How well the tangent is determined.
    determined: f64,
    storage: Storage,
}

impl Motion {
    /// Follows the branch through the assembly meant by the file's hints over a demanded range.
    ///
    /// # Errors
    /// As [`Motion::with_progress`].
    pub fn along(
        design: &Design<f64>,
        demand: Demand,
        progress: &mut dyn Progress,
    ) -> Result<Self, MotionError> {
        Self::along_after(design, demand, Earlier::default(), progress)
    }

    /// As [`Motion::along`], with what is known of much the same dimensions.
    pub(super) fn along_after(
        design: &Design<f64>,
        demand: Demand,
        earlier: Earlier<'_>,
        progress: &mut dyn Progress,
    ) -> Result<Self, MotionError> {
        Self::possible(design)?;
        if demand.assemblies.is_none() {
            return Self::as_drawn(design, demand, earlier, progress);
        }
        let from = demand.start;
        Self::through(design, demand, from, earlier, progress)
    }

    /// The branch through the assembly that is meant at the place `from` of the path, where `demand.assemblies` are too.
    pub(super) fn through(
        design: &Design<f64>,
        demand: Demand,
        from: f64,
        earlier: Earlier<'_>,
        progress: &mut dyn Progress,
    ) -> Result<Self, MotionError> {
        let Demand {
            path,
            range: demanded,
            start,
            assemblies: mut known,
        } = demand;
        let scale = path.scale();
        let mut coordinates = vec![0.0; design.mechanism.model.drives.len()];
        let mut nothing: Option<Assemblies> = None;
        let mut standing: Option<Assemblies> = None;
        let mut at_start: Option<Vec<f64>> = None;
        let mut best: Option<Beginning> = None;
        let mut compared = 0;
        let mut missed = 0;
        for Anchor { anchor, inside } in places(&path, demanded, from) {
            // A start right at a limit may miss closure by a rounding error: look a little inside, and no farther.
            if nothing.is_some() && best.is_none() && (missed > TRIES || !inside) {
                continue;
            }
            path.coordinates(anchor, &mut coordinates);
            let assemblies = match known.take().filter(|_| anchor == from) {
                Some(known) => known,
                None => find_assemblies_after(design, &coordinates, earlier, progress).ok_or(
                    MotionError::Stopped {
                        stage: Stage::Assembling,
                    },
                )?,
            };
            if assemblies.list.is_empty() {
                missed += 1;
                nothing.get_or_insert(assemblies);
                continue;
            }
            if anchor == from {
                standing = Some(assemblies.clone());
            }
            let found = begin(design, &path, assemblies, anchor, &mut at_start);
            let Some(found) = found else { continue };
            let clear = found.determined > DETERMINED;
            let factor = if best.is_some() { BETTER } else { 1.0 };
            let before = best.as_ref().map_or(0.0, |b| b.determined);
            if found.determined > factor * before {
                best = Some(found);
            }
            compared += 1;
            if clear || compared == COMPARED {
                break;
            }
        }
        let Some(Beginning {
            anchor,
            design,
            assemblies,
            up,
            down,
            storage,
            ..
        }) = best
        else {
            return Err(match (standing, nothing) {
                (None, Some(assemblies)) => MotionError::CannotAssemble {
                    at: from,
                    assemblies: Box::new(assemblies),
                },
                // It stands where it starts, and nowhere beside it.
                (standing, _) => MotionError::Locked {
                    at: from,
                    assemblies: Box::new(standing.unwrap_or_default()),
                },
            });
        };
        // The share of the range that lies above it.
        let whole = (demanded.1 - demanded.0).max(f64::MIN_POSITIVE);
        let share = ((demanded.1 - anchor) / whole).clamp(0.0, 1.0);
        let mut follower = Follower::reusing(storage, &design, &path);
        let found = restricting_steps(&mut follower, |follower| {
            let range = (demanded.0 / scale, demanded.1 / scale);
            let (nodes, ends) = follow_both(follower, [&down, &up], range, share, progress)
                .ok_or(Unlocated::Stopped(Stage::Following))?;
            let (design, path, assemblies) = (design.clone(), path.clone(), assemblies.clone());
            let mut motion = Self::of_nodes(design, path, assemblies, nodes);
            motion.anchor = anchor;
            motion.start = start;
            motion.demanded = demanded;
            motion.ends = ends;
            motion.find_events(follower, progress)?;
            if from == start {
                motion.choices = motion.choices_at_start(follower);
            }
            Ok(motion)
        });
        if let (Ok(motion), Some(assemblies)) = (&found, &standing)
            && motion.only_gives()
        {
            return Err(MotionError::Locked {
                at: from,
                assemblies: Box::new(assemblies.clone()),
            });
        }
        match (found, nothing) {
            // It ends before the only place that is asked for.
            (Ok(motion), Some(assemblies))
                if demanded.0 == demanded.1 && !motion.reaches(start) =>
            {
                Err(MotionError::CannotAssemble {
                    at: start,
                    assemblies: Box::new(assemblies),
                })
            }
            (found, _) => found,
        }
    }

    /// Whether redundant constraints hold it: what they leave is a freedom of first order, as of bars in line.
    fn only_gives(&self) -> bool {
        let nodes = self.node_parameters();
        let wide = match (nodes.first(), nodes.last()) {
            (Some(first), Some(last)) => last - first,
            _ => 0.0,
        };
        [self.ends.0, self.ends.1].contains(&EndReason::Stuck)
            && wide <= GIVES * self.scale
            && !surplus_of(self.mechanism()).is_empty()
    }

    /// Whether a mechanism can be moved at all.
    ///
    /// # Errors
    /// [`MotionError::NoDrive`], [`MotionError::Undetermined`], [`MotionError::Scale`].
    pub fn possible(design: &Design<f64>) -> Result<(), MotionError> {
        let mechanism = &*design.mechanism;
        let plan = &mechanism.plan;
        if mechanism.model.drives.is_empty() {
            return Err(MotionError::NoDrive);
        }
        if !plan.decomposition.undetermined.is_empty() {
            let bodies = plan.decomposition.loose.clone();
            return Err(MotionError::Undetermined { bodies });
        }
        let size = design.size();
        if !(SIZES.0..=SIZES.1).contains(&size) {
            return Err(MotionError::Scale { size });
        }
        Ok(())
    }

    /// How many assemblies at the anchor lead to the pose at the start.
    fn choices_at_start(&self, follower: &Follower<'_, DrivePath>) -> usize {
        if self.start_crossing().is_none() {
            return 1;
        }
        let mut branch = Branch::neutral(self.mechanism());
        self.branch_at(self.start, &mut branch);
        let at_start = follower.scaled(&branch.guess, &branch.near, self.start);
        let far = |a: &Assembly| apart(&scaled(follower, a, self.anchor), &at_start);
        let list = &self.assemblies.list;
        let taken = list.first().map_or(0.0, far);
        list.iter()
            .filter(|a| far(a) <= LEADS_TO * taken)
            .count()
            .max(1)
    }
}

/// Where the branch of a motion may be looked for, and whether that is within its range.
struct Anchor {
    anchor: f64,
    inside: bool,
}

/// The start, places near it on the way of the motion, and places farther on.
fn places(path: &DrivePath, (low, high): (f64, f64), start: f64) -> Vec<Anchor> {
    let far = if (start - low).abs() > (high - start).abs() {
        low
    } else {
        high
    };
    let along = (far - start).abs();
    let near = NEAR.map(|part| part * path.scale());
    let direction = if far < start { -1.0 } else { 1.0 };
    // Along time the drives stand beyond the range.
    let beyond = matches!(path, DrivePath::Coordinate { .. });
    let mut places = vec![0.0];
    places.extend(near.into_iter().filter(|d| beyond || *d < along));
    if along > 0.0 {
        places.extend(PARTS.map(|part| part * along));
    }
    let place = |d: f64| Anchor {
        anchor: start + d * direction,
        inside: d <= along,
    };
    let mut places: Vec<Anchor> = places.into_iter().map(place).collect();
    if along == 0.0 && beyond {
        // A pose right at a limit: the motion that ends there is on one of its sides.
        places.extend([near[0], -near[0]].map(|d| Anchor {
            anchor: start + d,
            inside: true,
        }));
    }
    places
}

/// A beginning at a place with these assemblies: with the first that leads to the pose at the start, where there is one.
/// `at_start` is that pose, in scaled unknowns; it is set at the first place. `None` at a singular pose.
fn begin(
    design: &Design<f64>,
    path: &DrivePath,
    mut assemblies: Assemblies,
    anchor: f64,
    at_start: &mut Option<Vec<f64>>,
) -> Option<Beginning> {
    if let Some(at_start) = at_start {
        let follower = Follower::new(design, path);
        let list = assemblies.list.iter();
        let far: Vec<f64> = list
            .map(|assembly| apart(&scaled(&follower, assembly, anchor), at_start))
            .collect();
        let nearest = far.iter().copied().fold(f64::INFINITY, f64::min);
        let leads = |far: &f64| *far <= LEADS_TO * nearest;
        let first = far.iter().position(leads).unwrap_or(0);
        assemblies.list[..=first].rotate_right(1);
    }
    let first = assemblies.list.first()?;
    let design = first.count_in(design);
    let mut follower = Follower::new(&design, path);
    let z = scaled(&follower, first, anchor);
    at_start.get_or_insert_with(|| z.clone());
    let up = follower.start(z, 1.0)?;
    let down = up.clone().turned();
    let determined = follower.determined(&up);
    let storage = follower.into_storage();
    Some(Beginning {
        anchor,
        design,
        assemblies,
        up,
        down,
        determined,
        storage,
    })
}

/// Scaled unknowns of an assembly at a place.
fn scaled(follower: &Follower<'_, DrivePath>, assembly: &Assembly, at: f64) -> Vec<f64> {
    follower.scaled(&assembly.poses, &assembly.branch.near, at)
}
