//! Whether two models are the same but for how and where they are written.

use std::sync::Arc;

use crate::amount::Amount;
use crate::contact::ContactStudy;
use crate::designs::measures_of;
use crate::drawing::Drawing;
use crate::drive::LawPiece;
use crate::hint::HintKind;
use crate::ids::{Scalar, Span};
use crate::joint::JointKind;
use crate::link::{Center, Place};
use crate::load::{Actions, LoadKind};
use crate::measure::{Leaf, Measure, PoseMeasure, Statistic};
use crate::model::Model;
use crate::motion_study::{Column, Plot, Rows};
use crate::oil::Oil;
use crate::simulate_study::StopResistance;
use crate::study::StudyKind;

impl Model {
    /// Whether two models are the same but for the places in their files and for how their constants are written.
    ///
    /// Names and their order count, and every expression must evaluate to the same bits on every number.
    pub fn same_as(&self, other: &Self) -> bool {
        self.bare() == other.bare()
    }

    /// The model without places, every part without leaves replaced by its value.
    fn bare(&self) -> Self {
        let mut model = self.clone();
        model.forget_places();
        // What values must keep to follows from the rest; what was put into numbers is in them.
        model.bounds.clear();
        model.settled.clear();
        model.source = None;
        model.tables = Arc::default();
        // So are links, drives and hints that were drawn; not where drives are drawn that start elsewhere.
        let parameters = model.parameter_values::<f64>();
        let coordinates = match model.starting_elsewhere(&parameters).is_empty() {
            true => Vec::new(),
            false => std::mem::take(&mut model.drawing.coordinates),
        };
        model.drawing = Drawing {
            coordinates,
            ..Drawing::default()
        };
        model.visit_scalars(&mut |scalar| *scalar = scalar.fold());
        model.visit_measures(&mut |measure| *measure = folded(measure));
        model
    }

    fn forget_places(&mut self) {
        let forget = |span: &mut Span| *span = 0..0;
        self.parameters.iter_mut().for_each(|p| forget(&mut p.span));
        for link in &mut self.links {
            forget(&mut link.span);
            link.points.iter_mut().for_each(|p| forget(&mut p.span));
        }
        self.joints.iter_mut().for_each(|p| forget(&mut p.span));
        self.drives.iter_mut().for_each(|p| forget(&mut p.span));
        self.assembly.iter_mut().for_each(|p| forget(&mut p.span));
        self.measures.iter_mut().for_each(|p| forget(&mut p.span));
        for study in &mut self.studies {
            forget(&mut study.span);
            if let StudyKind::Contact(contact) = &mut study.kind {
                let plays = contact.motion.plays.iter_mut();
                plays.for_each(|p| forget(&mut p.span));
            }
            if let StudyKind::Adjust(asked) = &mut study.kind {
                asked.visit_places(&mut |span| *span = 0..0);
            }
            if let StudyKind::Synthesize(asked) = &mut study.kind {
                asked.visit_places(&mut |span| *span = 0..0);
            }
            match &mut study.kind {
                StudyKind::Sweep(asked) => asked.visit_places(&mut |span| *span = 0..0),
                StudyKind::Tolerance(asked) => asked.visit_places(&mut |span| *span = 0..0),
                StudyKind::Optimize(asked) => asked.visit_places(&mut |span| *span = 0..0),
                _ => {}
            }
        }
        let acting = &mut self.actions;
        acting.loads.iter_mut().for_each(|p| forget(&mut p.span));
        acting.masses.iter_mut().for_each(|p| forget(&mut p.span));
        acting.springs.iter_mut().for_each(|p| forget(&mut p.span));
        acting.dampers.iter_mut().for_each(|p| forget(&mut p.span));
        acting.friction.iter_mut().for_each(|p| forget(&mut p.span));
        let cylinders = acting.cylinders.iter_mut();
        cylinders.for_each(|p| forget(&mut p.span));
        acting.motors.iter_mut().for_each(|p| forget(&mut p.span));
        acting.switches.iter_mut().for_each(|p| forget(&mut p.span));
        self.clearances.iter_mut().for_each(|p| forget(&mut p.span));
    }

    /// Every expression over parameters.
    fn visit_scalars(&mut self, f: &mut dyn FnMut(&mut Scalar)) {
        self.parameters.iter_mut().for_each(|p| f(&mut p.value));
        for link in &mut self.links {
            for point in &mut link.points {
                place(&mut point.place, f);
            }
            if let Some(inertia) = &mut link.inertia {
                inertia.mass.iter_mut().for_each(&mut *f);
                inertia.moment.iter_mut().for_each(&mut *f);
                if let Center::Place(at) = &mut inertia.center {
                    place(at, f);
                }
            }
        }
        for joint in &mut self.joints {
            match &mut joint.kind {
                JointKind::Slider { angle, .. } | JointKind::Weld { angle, .. } => f(angle),
                JointKind::Slot { .. } | JointKind::CurveSlot { .. } => {}
                JointKind::ArcSlot { on, .. } => f(&mut on.radius),
                JointKind::Belt {
                    radius_a,
                    radius_b,
                    phase,
                    ..
                } => [radius_a, radius_b, phase].into_iter().for_each(&mut *f),
                JointKind::Gears {
                    teeth_a,
                    teeth_b,
                    phase,
                    teeth,
                    ..
                } => ([teeth_a, teeth_b, phase].into_iter())
                    .chain(teeth.scalars_mut())
                    .for_each(&mut *f),
                JointKind::Rack {
                    radius,
                    offset,
                    teeth,
                    ..
                } => ([radius, offset].into_iter())
                    .chain(teeth.scalars_mut())
                    .for_each(&mut *f),
            }
        }
        for drive in &mut self.drives {
            f(&mut drive.law.from);
            for piece in &mut drive.law.pieces {
                match piece {
                    LawPiece::ConstantSpeed { to, speed: rate }
                    | LawPiece::ConstantAcceleration {
                        to,
                        acceleration: rate,
                    } => {
                        f(to);
                        f(rate);
                    }
                    LawPiece::Dwell { duration } => f(duration),
                    LawPiece::Rise { to, duration, .. } => {
                        f(to);
                        f(duration);
                    }
                    LawPiece::Table { .. } | LawPiece::Polynomials(_) => {}
                }
            }
        }
        for (_, drawn) in &mut self.drawing.coordinates {
            f(drawn);
        }
        for hint in &mut self.assembly {
            match &mut hint.kind {
                HintKind::Side { .. } => {}
                HintKind::NearPlace { x, y, .. } => {
                    f(x);
                    f(y);
                }
                HintKind::NearAngle { angle, .. } => f(angle),
            }
        }
        self.visit_scalars_of_actions(f);
        for clearance in &mut self.clearances {
            f(&mut clearance.radial);
            clearance.contact.scalars_mut().for_each(&mut *f);
        }
        for study in &mut self.studies {
            let along = match &mut study.kind {
                StudyKind::Motion(along) | StudyKind::Forces(along) => along,
                StudyKind::Balance(study) => {
                    f(&mut study.radius);
                    &mut study.along
                }
                StudyKind::Spring(study) => {
                    let bounds = study.stiffness.iter_mut().chain(&mut study.preload);
                    bounds.flatten().for_each(&mut *f);
                    &mut study.along
                }
                StudyKind::Simulate(study)
                | StudyKind::Contact(ContactStudy { motion: study, .. }) => {
                    f(&mut study.until);
                    study.tolerance.iter_mut().for_each(&mut *f);
                    for start in &mut study.start {
                        start.at.iter_mut().for_each(&mut *f);
                        start.rate.iter_mut().for_each(&mut *f);
                    }
                    for play in &mut study.plays {
                        play.place.iter_mut().flatten().for_each(&mut *f);
                        play.rate.iter_mut().flatten().for_each(&mut *f);
                    }
                    for stop in &mut study.stops {
                        stop.between.iter_mut().flatten().for_each(&mut *f);
                        match &mut stop.resistance {
                            StopResistance::Rigid { restitution } => {
                                restitution.iter_mut().for_each(&mut *f);
                            }
                            StopResistance::Soft { stiffness, damping } => {
                                f(stiffness);
                                damping.iter_mut().for_each(&mut *f);
                            }
                        }
                    }
                    &mut study.along
                }
                StudyKind::Clearance(study) => &mut study.along,
                StudyKind::Vibrations(study) => {
                    study.at.iter_mut().for_each(|(_, at)| f(at));
                    &mut study.along
                }
                StudyKind::Adjust(study) => {
                    study.visit_scalars(f);
                    &mut study.along
                }
                StudyKind::Synthesize(study) => {
                    study.visit_scalars(f);
                    &mut study.along
                }
                StudyKind::Sweep(study) => {
                    study.visit_scalars(f);
                    &mut study.over.asked
                }
                StudyKind::Tolerance(study) => {
                    study.visit_scalars(f);
                    &mut study.over.asked
                }
                StudyKind::Optimize(study) => {
                    study.visit_scalars(f);
                    &mut study.over.asked
                }
            };
            match &mut along.rows {
                Rows::DriveStep(step) | Rows::TimeStep(step) => f(step),
                Rows::Count(_) => {}
            }
        }
    }

    fn visit_scalars_of_actions(&mut self, f: &mut dyn FnMut(&mut Scalar)) {
        let acting = &mut self.actions;
        acting.gravity.iter_mut().flatten().for_each(&mut *f);
        for load in &mut acting.loads {
            for amount in amounts(&mut load.kind) {
                if let Amount::Table { factor, .. } = amount {
                    f(factor);
                }
            }
        }
        for mass in &mut acting.masses {
            place(&mut mass.place, f);
            f(&mut mass.mass);
        }
        for spring in &mut acting.springs {
            f(&mut spring.stiffness);
            f(&mut spring.free);
            f(&mut spring.preload);
            let stops = spring.stops.iter_mut().flatten();
            stops.chain(&mut spring.stop_stiffness).for_each(&mut *f);
        }
        for damper in &mut acting.dampers {
            f(&mut damper.damping);
            damper.closing.iter_mut().for_each(&mut *f);
        }
        for friction in &mut acting.friction {
            f(&mut friction.coefficient);
            let rest = friction.static_coefficient.iter_mut();
            rest.chain(&mut friction.stribeck_speed)
                .chain(&mut friction.viscous)
                .chain(&mut friction.drag)
                .chain(&mut friction.radius)
                .for_each(&mut *f);
        }
        for cylinder in &mut acting.cylinders {
            let given = cylinder.supply.iter_mut();
            given
                .chain(&mut cylinder.relief)
                .chain(&mut cylinder.flow)
                .for_each(&mut *f);
            f(&mut cylinder.bore);
            f(&mut cylinder.rod);
            f(&mut cylinder.back);
            f(&mut cylinder.friction);
            f(&mut cylinder.count);
            let oil = cylinder.oil.iter_mut().flat_map(Oil::scalars_mut);
            oil.for_each(&mut *f);
        }
        for amount in controls(acting) {
            if let Amount::Table { factor, .. } = amount {
                f(factor);
            }
        }
        acting
            .switches
            .iter_mut()
            .flat_map(|s| &mut s.every)
            .for_each(&mut *f);
        for (speed, torque) in acting.motors.iter_mut().flat_map(|m| &mut m.curve) {
            f(speed);
            f(torque);
        }
    }

    /// Every measure.
    fn visit_measures(&mut self, f: &mut dyn FnMut(&mut Measure)) {
        self.measures.iter_mut().for_each(|m| f(&mut m.measure));
        for load in &mut self.actions.loads {
            for amount in amounts(&mut load.kind) {
                match amount {
                    Amount::Measure(measure) => f(measure),
                    Amount::Table { over, .. } => f(over),
                }
            }
        }
        for amount in controls(&mut self.actions) {
            match amount {
                Amount::Measure(measure) => f(measure),
                Amount::Table { over, .. } => f(over),
            }
        }
        for switch in &mut self.actions.switches {
            f(&mut switch.on.above);
            switch.off.iter_mut().for_each(|off| f(&mut off.above));
        }
        for study in &mut self.studies {
            let along = match &mut study.kind {
                StudyKind::Motion(along) | StudyKind::Forces(along) => along,
                StudyKind::Balance(study) => &mut study.along,
                StudyKind::Spring(study) => {
                    f(&mut study.wanted);
                    &mut study.along
                }
                StudyKind::Simulate(study)
                | StudyKind::Contact(ContactStudy { motion: study, .. }) => {
                    study.stops.iter_mut().for_each(|s| f(&mut s.what));
                    study.end_when.iter_mut().for_each(|c| f(&mut c.above));
                    &mut study.along
                }
                StudyKind::Clearance(study) => &mut study.along,
                StudyKind::Vibrations(study) => &mut study.along,
                StudyKind::Adjust(study) => {
                    study.measures.iter_mut().for_each(|c| f(&mut c.measure));
                    &mut study.along
                }
                StudyKind::Synthesize(study) => &mut study.along,
                StudyKind::Sweep(study) => &mut study.over.asked,
                StudyKind::Tolerance(study) => {
                    measures_of(&mut study.limits).for_each(&mut *f);
                    &mut study.over.asked
                }
                StudyKind::Optimize(study) => {
                    let goals = study.goals.iter_mut();
                    goals.for_each(|goal| f(&mut goal.number.measure));
                    measures_of(&mut study.subject_to).for_each(&mut *f);
                    &mut study.over.asked
                }
            };
            let mut column = |c: &mut Column| f(&mut c.measure);
            along.columns.iter_mut().for_each(&mut column);
            for plot in &mut along.plots {
                if let Plot::Curves(curves) = plot {
                    curves.iter_mut().for_each(&mut column);
                }
            }
        }
    }
}

/// The openings of valves and the throttles of motors.
fn controls(acting: &mut Actions) -> impl Iterator<Item = &mut Amount> {
    let oils = acting.cylinders.iter_mut().flat_map(|c| &mut c.oil);
    let openings = oils.flat_map(Oil::openings_mut);
    openings.chain(acting.motors.iter_mut().flat_map(|m| &mut m.throttle))
}

fn amounts(kind: &mut LoadKind) -> Vec<&mut Amount> {
    match kind {
        LoadKind::Force { components, .. } => components.iter_mut().collect(),
        LoadKind::Torque { amount, .. } => vec![amount],
    }
}

fn place(place: &mut Place, f: &mut dyn FnMut(&mut Scalar)) {
    let (a, b) = match place {
        Place::Cartesian { x, y } => (x, y),
        Place::Polar { radius, angle } => (radius, angle),
        Place::Triangle {
            from_distance,
            to_distance,
            ..
        } => (from_distance, to_distance),
    };
    f(a);
    f(b);
}

/// The measure folded, and all measures within it.
fn folded(measure: &Measure) -> Measure {
    let within = |inner: &Measure| Box::new(folded(inner));
    measure
        .map_leaves(&mut |leaf| match leaf {
            Leaf::Rate(inner, n) => Leaf::Rate(within(inner), *n),
            Leaf::Coefficient(inner, drive, n) => Leaf::Coefficient(within(inner), *drive, *n),
            Leaf::Over(Statistic::At { drive, value }, inner) => {
                let (drive, value) = (*drive, value.fold());
                Leaf::Over(Statistic::At { drive, value }, within(inner))
            }
            Leaf::Over(statistic, inner) => Leaf::Over(statistic.clone(), within(inner)),
            Leaf::Pose(PoseMeasure::MechanicalAdvantage(inner, drive)) => {
                Leaf::Pose(PoseMeasure::MechanicalAdvantage(within(inner), *drive))
            }
            other => other.clone(),
        })
        .fold()
}
