//! Everything that acts on a mechanism, evaluated for one design.

use kempe_mechanism::{Geometry, Mechanism};
use kempe_model::{self as model, DriveId, InnerState, Leaf, Measure};

use crate::amount::Amount;
use crate::cylinder::Cylinder;
use crate::damper::Damper;
use crate::friction::{Friction, Sense};
use crate::inertia::Mass;
use crate::instant::Instant;
use crate::joint_contact::JointContact;
use crate::load::Load;
use crate::motor::Motor;
use crate::number::ForceNumber;
use crate::oil::Oil;
use crate::problem::Problem;
use crate::spring::Spring;
use crate::turning::Turning;
use crate::wrench::{self, Wrench};

/// Acceleration of gravity where the file gives none, m/s^2, along -y.
pub const GRAVITY: f64 = 9.81;

/// What acts on a mechanism, for one design.
#[derive(Clone, Debug)]
pub struct Acting<T: ForceNumber> {
    /// Acceleration of gravity, m/s^2.
    pub gravity: [T; 2],
    /// Masses that move.
    pub masses: Vec<Mass<T>>,
    /// Loads.
    pub loads: Vec<Load>,
    /// What the loads vary with, then the parts of the friction that is followed.
    pub amounts: Vec<Amount<T>>,
    /// Springs, in the model's order.
    pub springs: Vec<Spring<T>>,
    /// Dampers.
    pub dampers: Vec<Damper<T>>,
    /// Friction, and what parts wheels.
    pub friction: Vec<Friction<T>>,
    /// Hydraulic cylinders.
    pub cylinders: Vec<Cylinder<T>>,
    /// Their oil, of those of which it is told.
    pub oils: Vec<Oil<T>>,
    /// Motors.
    pub motors: Vec<Motor<T>>,
    /// Those of them whose drives are let go and hold nothing: they turn what they are on.
    pub turning: Vec<Turning>,
    /// Joints with play whose bodies touch and part.
    pub contacts: Vec<JointContact>,
}

impl<T: ForceNumber> Acting<T> {
    /// Evaluates what acts for parameter values (SI, in the model's order).
    ///
    /// # Errors
    /// Everything that makes forces meaningless: negative masses, springs between a point and itself, loads that depend
    /// on forces, contradictory pressures, and the like. In lanes: in any of them; of intervals: at their midpoints.
    pub fn new(
        mechanism: &Mechanism,
        geometry: &Geometry<T>,
        parameters: &[T],
    ) -> Result<Self, Vec<Problem>> {
        let actions = &mechanism.model.actions;
        let mut problems = Vec::new();
        let mut amounts = Vec::new();
        let loads = Load::all(mechanism, parameters, &mut amounts, &mut problems);
        let gravity = match &actions.gravity {
            Some(g) => [&g[0], &g[1]].map(|scalar| model::value(scalar, parameters)),
            None => [T::zero(), T::from_f64(-GRAVITY)],
        };
        let cylinders: Vec<Cylinder<T>> = (actions.cylinders.iter())
            .map(|c| {
                let cylinder = Cylinder::new(c, parameters);
                cylinder.check(c, &mut problems);
                cylinder
            })
            .collect();
        let oils = (actions.cylinders.iter().zip(&cylinders))
            .filter_map(|(c, machine)| Oil::new(mechanism, c, machine, parameters, &mut problems))
            .collect();
        let mut friction = Friction::all(mechanism, geometry, parameters, &mut problems);
        let mut contacts = JointContact::all(mechanism, geometry, parameters, &mut problems);
        // Of what rubs joints come first, then contacts.
        let mut part = (0..actions.followed_friction).map(|place| {
            amounts.push(Amount {
                measure: Measure::Leaf(Leaf::Inner(InnerState::Friction(place))),
                curve: None,
            });
            amounts.len() - 1
        });
        for it in friction.iter_mut().filter(|f| f.is_dry()) {
            if let Some(amount) = part.next() {
                it.sense = Sense::Amount(amount);
            }
        }
        for it in contacts.iter_mut().filter(|c| c.sticks()) {
            it.parts = part.by_ref().take(it.places()).collect();
        }
        let it = Self {
            gravity,
            masses: Mass::all(mechanism, geometry, parameters, &mut problems),
            springs: Spring::all(mechanism, geometry, parameters, &mut problems),
            dampers: Damper::all(mechanism, geometry, parameters, &mut problems),
            friction,
            motors: (actions.motors.iter())
                .map(|m| Motor::new(mechanism, m, parameters, &mut problems))
                .collect(),
            turning: Turning::all(mechanism),
            contacts,
            loads,
            amounts,
            cylinders,
            oils,
        };
        if problems.is_empty() {
            Ok(it)
        } else {
            Err(problems)
        }
    }

    /// Fills what acts on every link (weights, loads, springs, dampers) and `m a`, `J alpha` of every link.
    pub(crate) fn evaluate(
        &self,
        mechanism: &Mechanism,
        geometry: &Geometry<T>,
        at: &Instant<T>,
        applied: &mut [Wrench<T>],
        inertial: &mut [Wrench<T>],
    ) {
        applied.fill([T::zero(); 3]);
        inertial.fill([T::zero(); 3]);
        for mass in &self.masses {
            wrench::add(
                &mut applied[mass.link.index()],
                mass.weight(at, self.gravity),
            );
            wrench::add(&mut inertial[mass.link.index()], mass.inertial(at));
        }
        for load in &self.loads {
            load.act(mechanism, geometry, at, applied);
        }
        for spring in &self.springs {
            spring.act(geometry, at, applied);
        }
        for damper in &self.dampers {
            damper.act(geometry, at, applied);
        }
        for turning in &self.turning {
            turning.act(&self.motors, at, applied);
        }
        for (applied, pushed) in applied.iter_mut().zip(&at.pressed) {
            wrench::add(applied, *pushed);
        }
    }

    /// What the motor of a drive that is let go and holds nothing gives, N m; none without a motor.
    pub fn turns(&self, drive: DriveId, at: &Instant<T>) -> T {
        let own = (self.turning.iter()).find(|it| it.drive == drive);
        own.map_or(T::zero(), |it| it.torque(&self.motors, at))
    }
}
