//! Masses of links and counterweights.

use kempe_mechanism::{BodyId, Geometry, Mechanism};
use kempe_model::{self as model, LinkId};

use crate::instant::Instant;
use crate::number::ForceNumber;
use crate::problem::Problem;
use crate::vector::{add, cross, dot, left, sub, times};
use crate::wrench::{self, Wrench};

/// A mass that moves with a link: the link's own, or one fixed to it.
#[derive(Clone, Copy, Debug)]
pub struct Mass<T> {
    /// The link.
    pub link: LinkId,
    /// Its body.
    pub body: BodyId,
    /// Centre of mass in the body's coordinates, m.
    pub center: [T; 2],
    /// Mass, kg.
    pub mass: T,
    /// Moment of inertia about the centre of mass, kg m^2.
    pub moment: T,
}

/// How a mass moves with a coordinate, by its rate: its centre along the frame's axes, and its angle.
pub(crate) type Moved<T> = ([T; 2], T);

impl<T: ForceNumber> Mass<T> {
    /// All masses of a mechanism that can move; those of the frame feel nothing.
    pub(crate) fn all(
        mechanism: &Mechanism,
        geometry: &Geometry<T>,
        parameters: &[T],
        problems: &mut Vec<Problem>,
    ) -> Vec<Self> {
        let model = &mechanism.model;
        let of = |scalar: &model::Scalar| model::value(scalar, parameters);
        let mut list = Vec::new();
        let mut take = |link: LinkId, center: [T; 2], mass: T, moment: T| {
            let body = mechanism.body_of(link);
            if body != BodyId::GROUND {
                list.push(Self {
                    link,
                    body,
                    center: geometry.seats[link.index()].place(center),
                    mass,
                    moment,
                });
            }
        };
        for (index, link) in model.links.iter().enumerate() {
            let Some(inertia) = &link.inertia else {
                continue;
            };
            let mass = inertia.mass.as_ref().map_or(T::zero(), of);
            let moment = inertia.moment.as_ref().map_or(T::zero(), of);
            if mass.any_lane(|m| m < 0.0) || moment.any_lane(|m| m < 0.0) {
                problems.push(Problem::new(
                    "negative-mass",
                    &link.span,
                    format!("the mass or inertia of `{}` is negative", link.name),
                ));
            }
            let center = link.center_of_mass(parameters).unwrap_or([T::zero(); 2]);
            take(LinkId(index as u32), center, mass, moment);
        }
        for extra in &model.actions.masses {
            let Some(link) = model.links.get(extra.on.index()) else {
                continue;
            };
            let mass = of(&extra.mass);
            if mass.any_lane(|m| m < 0.0) {
                problems.push(Problem::new(
                    "negative-mass",
                    &extra.span,
                    format!("the mass `{}` is negative", extra.name),
                ));
            }
            take(
                extra.on,
                link.locate(&extra.place, parameters),
                mass,
                T::zero(),
            );
        }
        list
    }

    /// From the body's origin to the centre of mass, along the frame's axes.
    #[inline(always)]
    pub fn arm(&self, at: &Instant<T>) -> [T; 2] {
        at.arm(self.body, self.center)
    }

    /// `m a` at the centre of mass and `J alpha`, about the body's origin.
    #[inline(always)]
    pub(crate) fn inertial(&self, at: &Instant<T>) -> Wrench<T> {
        let arm = self.arm(at);
        let acceleration = at.acceleration(self.body, arm);
        let mut w = wrench::of_force(acceleration.map(|a| a * self.mass), arm);
        w[2] += self.moment * at.accelerations[self.body.index()][2];
        w
    }

    /// Its weight, about the body's origin.
    #[inline(always)]
    pub(crate) fn weight(&self, at: &Instant<T>, gravity: [T; 2]) -> Wrench<T> {
        wrench::of_force(gravity.map(|g| g * self.mass), self.arm(at))
    }

    /// How it moves, its centre as far from its body's origin as `arm` says, where the bodies move so about their origins.
    #[inline(always)]
    pub(crate) fn moved(&self, arm: [T; 2], bodies: &[[T; 3]]) -> Moved<T> {
        let [x, y, turn] = bodies[self.body.index()];
        (add([x, y], times(left(arm), turn)), turn)
    }

    /// Its part of the mass matrix in the row and the column of two coordinates that move it so: `m u . v + J w z`.
    #[inline(always)]
    pub(crate) fn coupling(&self, (v, w): &Moved<T>, (u, z): &Moved<T>) -> T {
        dot(*v, *u) * self.mass + *w * *z * self.moment
    }

    /// Kinetic energy, J.
    pub fn kinetic_energy(&self, at: &Instant<T>) -> T {
        let v = at.velocity(self.body, self.arm(at));
        let w = at.velocities[self.body.index()][2];
        ((v[0].square() + v[1].square()) * self.mass + w.square() * self.moment) / 2.0
    }

    /// Momentum, kg m/s, and angular momentum about the frame's origin, kg m^2/s.
    pub fn momentum(&self, at: &Instant<T>) -> Wrench<T> {
        let arm = self.arm(at);
        let v = at.velocity(self.body, arm);
        let about_origin = cross(at.place(self.body, arm), v) * self.mass
            + at.velocities[self.body.index()][2] * self.moment;
        [v[0] * self.mass, v[1] * self.mass, about_origin]
    }

    /// Moment of inertia about a point of its body given in the body's coordinates, kg m^2.
    pub fn moment_about(&self, point: [T; 2]) -> T {
        let r = sub(self.center, point);
        self.moment + (r[0].square() + r[1].square()) * self.mass
    }
}
