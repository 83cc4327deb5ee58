//! What has to be known before a simulation begins, and what keeps it from that.

use std::sync::Arc;

use kempe_dynamics::Forces;
use kempe_integrate::Used;
use kempe_measure::measure::visit_leaves;
use kempe_mechanism::{Design, Mechanism};
use kempe_model::{DriveId, Law, Leaf, Measure, Model, PoseMeasure, Pressed};
use kempe_motion::{Motion, Placed, Progress};
use kempe_units::Dimension;

use crate::barrier::Barrier;
use crate::cut::{LetGoDrives, in_tree};
use crate::joints::{opened, rigid_stops};
use crate::lack::{Lack, Sought};
use crate::leap::Approach;
use crate::places::Places;
use crate::plant::{Plant, motor_sense};
use crate::question::{Coordinates, Question};
use crate::record::{Ending, Machine, Pilots, Record, Simulated, Tree};
use crate::sharp::Sharp;
use crate::site::places_that_rub;
use crate::start::start;
use crate::step_limits::StepLimits;
use crate::tellers::Tellers;
use crate::toggle::Toggle;
use crate::touched::{Place, touched};
use crate::unsimulated::{NoTree, Unsimulated};

use super::{BACK, Run, TOUCHED, USUAL, beside};

/// A simulation that can begin.
pub struct Ready {
    run: Run,
    /// Ends of stretches between which the laws of drives are smooth, s.
    breaks: Vec<f64>,
    rigid: Vec<Place>,
    first: Arc<Motion>,
    design: Design<f64>,
    placed: Placed,
}

impl Ready {
    /// The motion on which the pose of the start was found: the assembly that was chosen, and what it has to say.
    pub fn first(&self) -> &Motion {
        &self.first
    }

    /// Simulates. What ends it early is told with what was found until then.
    pub fn simulate(self, progress: &mut dyn Progress) -> Simulated {
        let Ready {
            mut run,
            breaks,
            rigid,
            first,
            design,
            placed,
        } = self;
        let ending = run.whole(&breaks, progress);
        if matches!(ending, Ending::Until | Ending::Condition(_)) {
            run.was_here();
        }
        let acting = &run.plant.forces.acting;
        let mut machines: Vec<Machine> = (run.plant.motors.iter())
            .map(|it| Machine {
                motor: it.map(|it| (acting.motors[it.motor].clone(), it.sense)),
                oil: None,
                seals: None,
            })
            .collect();
        for moved in &run.plant.inner.moved {
            machines[moved.free].oil = Some((acting.oils[moved.oil].clone(), moved.place));
        }
        for (moved, place) in run.plant.seals() {
            machines[moved.free].seals = Some(place);
        }
        let end = run.time;
        let (used, evaluations) = run.effort();
        let mut laws = run.record.laws(end);
        let links = run.tellers.used();
        let pilots = (!links.is_empty()).then(|| Pilots {
            mechanism: run.tellers.piloted(),
            count: laws.places.len(),
            laws: [laws.places, laws.choices].concat(),
            links: links.to_vec(),
        });
        let work = laws.beside.remove(0);
        let bearing: Vec<usize> = run.plant.on_bodies().collect();
        let pushes = laws.beside.split_off(laws.beside.len() - bearing.len());
        let pressed = bearing.into_iter().zip(pushes).map(|(stop, push)| {
            let gap = run.question.stops[stop].gap.clone();
            (stop, Pressed { gap, push })
        });
        let inner = &run.plant.inner;
        let mut inner_laws: Vec<Option<Law>> = vec![None; inner.values.len()];
        let pressures = inner.moved.iter().flat_map(|m| [m.place, m.place + 1]);
        let friction = run.plant.friction_places();
        let switches = inner.values.len() - inner.switches().len()..inner.values.len();
        for (place, law) in pressures.chain(friction).chain(switches).zip(laws.beside) {
            inner_laws[place] = Some(law);
        }
        Simulated {
            tied: run.plant.tied(),
            tree: run.plant.ties.as_ref().map(|ties| Tree {
                coordinates: run.plant.free.len(),
                ties: ties.rows(),
                off: ties.taken,
            }),
            free: run.question.free.clone(),
            touched: touched(&run.plant.forces.acting.contacts, &laws.drives, end),
            rigid_from: run.question.stops.len(),
            rigid,
            laws: laws.drives,
            work,
            pressed: (pressed.filter(|(_, it)| it.push.extent(&[]) != (0.0, 0.0))).collect(),
            end,
            ending,
            held_throughout: (run.conditions.iter().map(|armed| !armed))
                .take(run.question.end_when.len())
                .collect(),
            happenings: run.happenings,
            held: run.held,
            used,
            evaluations,
            across: run.approach.made,
            known: run.known,
            first,
            pilots,
            inner: inner_laws,
            machines,
            design,
            placed,
        }
    }
}

/// Makes a simulation of a design ready to begin.
///
/// # Errors
/// Why it cannot begin.
pub fn ready(
    design: &Design<f64>,
    question: &Question,
    progress: &mut dyn Progress,
) -> Result<Ready, Unsimulated> {
    let model = &design.mechanism.model;
    let parameters = design.parameters.clone();
    let mut coordinates: Vec<f64> = (model.drives.iter())
        .map(|d| d.law.at(0.0, &parameters))
        .collect();
    for (drive, [q, _]) in question.free.iter().zip(&question.start) {
        coordinates[drive.index()] = *q;
    }
    let from = start(design, &coordinates, progress).map_err(Unsimulated::Start)?;
    // Laws are those of the file: what was found may stand still.
    let laws = |index: usize| model.drives.get(index).map(|d| d.law.clone());
    let (mut from, rows) = opened(from, &question.contacts).map_err(Unsimulated::NoPlay)?;
    let mut design = from.design.with_laws(laws);
    let model = &design.mechanism.model.clone();
    coordinates.resize(model.drives.len(), 0.0);
    for row in &rows {
        coordinates[row.drive.index()] = row.start[0];
    }
    let question = Question {
        free: (question.free.iter().copied())
            .chain(rows.iter().map(|row| row.drive))
            .collect(),
        start: (question.start.iter().copied())
            .chain(rows.iter().map(|row| row.start))
            .collect(),
        ..question.clone()
    };
    let (mut placed, first_motion) = (from.placed.clone(), from.first.clone());
    let mut forces = Forces::new(design.clone()).map_err(Unsimulated::Problems)?;
    // Places that rub slide each in its own sense, which the motion that is found keeps.
    let followed = places_that_rub(&forces.acting, &question.free);
    if followed > 0 {
        let follow = |model: &mut Model| model.actions.followed_friction = followed;
        (from.design, design) = (from.design.with_model(follow), design.with_model(follow));
        forces = Forces::new(design.clone()).map_err(Unsimulated::Problems)?;
    }
    for spring in &mut forces.acting.springs {
        spring.align(&forces.design.geometry, &placed.near);
    }
    let (rigid, barriers): (Vec<Place>, Vec<Barrier>) =
        rigid_stops(&forces.acting.contacts).into_iter().unzip();
    let asked = question.stops.iter();
    let asked = asked.map(|stop| Barrier::of(&design.mechanism, stop));
    let stops = asked.chain(barriers);
    let driven: Vec<DriveId> = (0..model.drives.len() as u32)
        .map(DriveId)
        .filter(|drive| {
            let law = &model.drives[drive.index()].law;
            !question.free.contains(drive) && law.duration(&parameters) > 0.0
        })
        .collect();
    let mut breaks: Vec<f64> = (driven.iter())
        .flat_map(|drive| model.drives[drive.index()].law.breaks(&parameters))
        .filter(|t| 0.0 < *t && *t < question.until)
        .chain([question.until])
        .collect();
    breaks.sort_by(f64::total_cmp);
    breaks.dedup();
    let play = |drive: &DriveId| {
        let row = rows.iter().find(|row| row.drive == *drive);
        row.map(|row| row.clearance)
    };
    let scales: Vec<f64> = (question.free.iter())
        .map(|drive| match model.drives[drive.index()].dimension {
            Dimension::ANGLE => 1.0,
            // What has play is hardly ever off by more.
            _ => play(drive).unwrap_or_else(|| design.size()),
        })
        .collect();
    let senses = question.free.iter().map(|drive| {
        let law = model.drives.get(drive.index()).map(|d| &d.law);
        law.map_or(1.0, |law| motor_sense(law, &parameters))
    });
    let senses: Vec<f64> = senses.collect();
    let tellers = Tellers::new(
        design.clone(),
        first_motion.clone(),
        [question.free.clone(), driven.clone()],
        senses.clone(),
    );
    let mut plant = match question.coordinates {
        Coordinates::Minimal => {
            let moving: Vec<DriveId> = question.free.iter().chain(&driven).copied().collect();
            let places = Places::new(from, &moving, progress).map_err(Unsimulated::Motion)?;
            let moving = [question.free.clone(), driven];
            Plant::new(&design, forces, places, moving, scales, stops.collect())
        }
        Coordinates::SpanningTree => {
            let own = LetGoDrives {
                free: question.free.clone(),
                senses,
                scales,
            };
            in_tree(&design, (from, forces), own, driven, stops.collect())?
        }
    };
    plant.back = BACK / question.until;
    if followed > 0 {
        plant.follow_friction();
    }
    let mut y = plant.start(&question.start)?;
    y.extend(vec![0.0; plant.inner.pressures() + 1]);
    if plant.places.start_at_change_point() {
        return Err(Unsimulated::AtChangePoint);
    }
    for stop in 0..question.stops.len() {
        if plant.goes_by_itself(stop, &y)
            && plant.closes_by_itself(stop, question.until, &y, progress)
        {
            return Err(Unsimulated::KeptFromStop(stop));
        }
    }
    // What was placed is the pose in the middle of all play.
    if rows.iter().any(|row| row.start[0] != 0.0) {
        if let Some((place, by)) = plant.beyond_play(TOUCHED, &y) {
            return Err(Unsimulated::BeyondPlay(place, by));
        }
        if !plant.look(0.0, &y) {
            return Err(Unsimulated::Lacks(Lack::Pose));
        }
        let instant = plant.instant();
        placed = Placed {
            poses: instant.poses.clone(),
            near: instant.angles().collect(),
        };
    }
    // Switches may go by pressures, and pressures by loads that are switched.
    Toggle::all(&mut plant, &y);
    let own = question.stops.len();
    if !plant.pressures_at_start(&mut y) {
        let lacks = plant.lacks();
        // Beyond its stroke a cylinder may hold no oil: the stroke is the cause.
        between_stops(&mut plant, own, &y)?;
        return Err(lacks);
    }
    let toggles = Toggle::all(&mut plant, &y);
    between_stops(&mut plant, own, &y)?;
    let asked = (question.stops.iter().map(|stop| &stop.gap))
        .chain(&question.end_when)
        .chain(toggles.iter().flat_map(Toggle::measures))
        .chain(plant.amounts.measures());
    let asked: Vec<&Measure> = asked.into_iter().collect();
    let along = |drives: &[DriveId]| {
        let mut asked = asked.iter();
        asked.any(|what| asks_along(&design.mechanism, what, drives))
    };
    let every: Vec<DriveId> = (0..model.drives.len() as u32).map(DriveId).collect();
    if plant.ties.is_some() && along(&every) {
        return Err(Unsimulated::NoTree(NoTree::Along));
    }
    plant.asked_along = along(&question.free);
    let limits = StepLimits::new(
        &design.mechanism,
        &parameters,
        question.until,
        plant.amounts.all(),
        &plant.driven,
    );
    let sharp = Sharp::new(&plant, question.until);
    let mut run = Run {
        record: Record::new(coordinates, beside(&plant, &y)),
        time: 0.0,
        y,
        ends: (question.end_when.iter())
            .chain(toggles.iter().map(|toggle| &toggle.awaits))
            .cloned()
            .collect(),
        conditions: vec![false; question.end_when.len() + toggles.len()],
        toggles,
        happenings: Vec::new(),
        held: Vec::new(),
        steps: 0,
        integrator: None,
        approach: Approach::new(USUAL * question.until),
        known: Vec::new(),
        earlier: (Used::default(), 0),
        resized: false,
        exchanged: false,
        at_start: Vec::new(),
        question,
        tellers,
        limits,
        sharp,
        plant,
    };
    run.begin()?;
    Ok(Ready {
        run,
        breaks,
        rigid,
        first: first_motion,
        design,
        placed,
    })
}

/// Simulates a design.
///
/// # Errors
/// Why it cannot begin. What ends it early is told with what was found until then.
pub fn simulate(
    design: &Design<f64>,
    question: &Question,
    progress: &mut dyn Progress,
) -> Result<Simulated, Unsimulated> {
    ready(design, question, progress).map(|ready| ready.simulate(progress))
}

/// Whether a measure asks for a derivative along one of these drives, itself or by another measure.
fn asks_along(mechanism: &Mechanism, measure: &Measure, drives: &[DriveId]) -> bool {
    let mut found = false;
    visit_leaves(mechanism, measure, &mut |leaf| {
        found |= match leaf {
            Leaf::Coefficient(_, drive, _)
            | Leaf::Pose(PoseMeasure::MechanicalAdvantage(_, drive)) => drives.contains(drive),
            _ => false,
        };
    });
    found
}

/// Refuses a state that is beyond one of the `own` stops of the question, or where one has no value.
fn between_stops(plant: &mut Plant, own: usize, y: &[f64]) -> Result<(), Unsimulated> {
    let scale = plant.scales.iter().copied().fold(0.0, f64::max);
    for stop in 0..own {
        let Some(open) = plant.open(stop, 0.0, y) else {
            return Err(Unsimulated::Lacks(Lack::Pose));
        };
        if !open.is_finite() {
            return Err(Unsimulated::NoValue(Sought::Stop(stop)));
        }
        if open < -TOUCHED * scale {
            return Err(Unsimulated::BeyondStop(stop, -open));
        }
    }
    Ok(())
}
