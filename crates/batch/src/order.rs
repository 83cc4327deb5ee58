//! What a batch makes of the motion's plan before it runs it.

use kempe_mechanism::Mechanism;
use kempe_mechanism::PlanNumber;
use kempe_mechanism::plan::{Plan, Step};
use kempe_mechanism::structure::{BodyId, Marker, Spot};
use kempe_mechanism::{Configuration, Design};
use kempe_model::{Place, Scalar};

/// A step that is run for the place of one point alone: nobody looks at the poses that it finds.
#[derive(Clone, Copy, Debug)]
pub(super) struct PointStep {
    pub step: usize,
    /// Which of the points.
    pub point: usize,
}

/// A plan whose branch is signs alone, in the order in which a batch runs it.
#[derive(Clone, Debug)]
pub(super) struct Order {
    /// The plan, without the bodies whose poses nobody looks at.
    pub plan: Plan,
    /// Steps that give the same for every design and every coordinate of the drives.
    pub fixed: Vec<usize>,
    /// Steps that give the same for every design.
    pub driven: Vec<usize>,
    /// All other steps.
    pub rest: Vec<usize>,
    /// Those of them that are run for the place of one point alone.
    pub point_steps: Vec<PointStep>,
    /// The others of them.
    pub other_steps: Vec<usize>,
    /// All but the fixed ones.
    pub moving: Vec<usize>,
    /// The moving bodies whose poses somebody looks at.
    pub wanted: Vec<usize>,
    /// Those of them that may have no pose though all the markers have a place and all the others have one.
    pub watched: Vec<usize>,
    /// The others, each as the index of its dyad's constants and the first of its own there.
    pub spares: Vec<(usize, usize)>,
}

impl Order {
    /// For a batch that looks at these markers and bodies.
    pub(super) fn new(mechanism: &Mechanism, markers: &[Marker], bodies: &[usize]) -> Self {
        let plan = &mechanism.plan;
        let mut it = Self {
            plan: plan.clone(),
            fixed: Vec::new(),
            driven: Vec::new(),
            rest: Vec::new(),
            point_steps: Vec::new(),
            other_steps: Vec::new(),
            moving: Vec::new(),
            wanted: (1..mechanism.bodies).collect(),
            watched: Vec::new(),
            spares: Vec::new(),
        };
        for (index, step) in plan.steps.iter().enumerate() {
            let list = match *step {
                Step::Pin { own, at } if is_fixed(mechanism, at) && own.spot == Spot::Origin => {
                    &mut it.fixed
                }
                Step::Turn { from, offset, .. }
                    if from == BodyId::GROUND
                        && mechanism.is_zero(&mechanism.angles[offset as usize]) =>
                {
                    &mut it.driven
                }
                _ => &mut it.rest,
            };
            list.push(index);
        }
        it.moving = [&it.driven[..], &it.rest].concat();
        let uses = it.uses(mechanism, markers, bodies);
        it.leave_out(&uses);
        let watched = it.wanted.iter().filter(|body| !it.shows(**body, markers));
        it.watched = watched.copied().collect();
        for step in it.rest.clone() {
            match it.point_step(step, &uses, markers) {
                Some(point_step) => it.point_steps.push(point_step),
                None => it.other_steps.push(step),
            }
        }
        it
    }

    /// The point whose place is all that anybody asks of a step.
    fn point_step(&self, step: usize, uses: &[usize], markers: &[Marker]) -> Option<PointStep> {
        let Step::Dyad(dyad) = &self.plan.steps[step] else {
            return None;
        };
        let bodies = [dyad.a, dyad.b].map(|side| side.inner.body);
        let on = |marker: &Marker| bodies.contains(&marker.body);
        let point = markers.iter().position(on)?;
        // each is used by the step itself
        let alone = bodies.iter().map(|body| uses[body.index()]).sum::<usize>() == bodies.len() + 1;
        (alone && self.plan.places_point(step, markers[point])).then_some(PointStep { step, point })
    }

    /// Whether a body without a pose leaves one of the markers without a place, or the body of a later step without a pose:
    /// whatever is off the body's origin is nowhere if the body's direction is none.
    fn shows(&self, body: usize, markers: &[Marker]) -> bool {
        let off = |marker: &Marker| {
            marker.body.index() == body && matches!(marker.spot, Spot::Axis | Spot::Anywhere)
        };
        markers.iter().any(off)
            || self.plan.steps.iter().any(|step| match step {
                Step::Dyad(dyad) => off(&dyad.a.at) || off(&dyad.b.at),
                Step::Pin { at, .. } => off(at),
                _ => false,
            })
    }

    /// Solves steps without assembly modes once for many poses. Called, so that the loops over poses stay small.
    #[inline(never)]
    pub(super) fn solve_once<T: PlanNumber>(
        &self,
        steps: &[usize],
        design: &Design<T>,
        states: &mut [Configuration<T>],
    ) {
        self.plan.solve_simple(steps, design, states);
    }

    /// How many blocks, markers and wanted bodies each body is in.
    fn uses(&self, mechanism: &Mechanism, markers: &[Marker], bodies: &[usize]) -> Vec<usize> {
        let mut uses = vec![0; mechanism.bodies];
        for block in &self.plan.blocks {
            let mut seen = vec![false; mechanism.bodies];
            // Newton's method holds a block to its surplus rows too.
            for row in block.rows.iter().chain(&block.surplus) {
                for body in mechanism.constraints[row.constraint].0.bodies() {
                    uses[body.index()] += usize::from(!seen[body.index()]);
                    seen[body.index()] = true;
                }
            }
        }
        for marker in markers {
            uses[marker.body.index()] += 1;
        }
        for body in bodies {
            uses[*body] += 1;
        }
        uses
    }

    /// Leaves out one body of every dyad where one is not wanted itself, carries none of the markers, and no later step looks at it.
    fn leave_out(&mut self, uses: &[usize]) {
        for step in &mut self.plan.steps {
            let Step::Dyad(dyad) = step else { continue };
            for (first, side) in [(0, &mut dyad.a), (2, &mut dyad.b)] {
                let body = side.inner.body.index();
                if uses[body] == 1 {
                    side.wanted = false;
                    self.wanted.retain(|wanted| *wanted != body);
                    self.spares.push((dyad.constants, first));
                    break;
                }
            }
        }
    }
}

/// Whether a marker is at the same place of the frame for every design.
fn is_fixed(mechanism: &Mechanism, marker: Marker) -> bool {
    let at = mechanism.markers[marker.index as usize];
    let points = &mechanism.model.links[at.link.index()].points;
    marker.spot == Spot::Frame
        && mechanism.seats[at.link.index()].weld.is_none()
        && points.iter().any(|point| {
            let is_constant = matches!(
                point.place,
                Place::Cartesian {
                    x: Scalar::Const(_),
                    y: Scalar::Const(_)
                }
            );
            point.point == at.point && is_constant
        })
}
