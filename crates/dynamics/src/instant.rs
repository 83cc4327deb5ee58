//! One instant of a motion, as the forces need it.

use kempe_measure::{Series, State};
use kempe_mechanism::configuration::input_of;
use kempe_mechanism::constraint::{Input, Situation};
use kempe_mechanism::{BodyId, Configuration, Geometry, Mechanism, Pose};
use kempe_model::DriveId;
use kempe_number::{Dual, Jet, Number};

use crate::vector::{add, left, times};

/// Series in time of force quantities: value, rate and second derivative are what the series of the poses leave exact.
pub type Rates<B = f64> = Jet<B, 3>;

/// Where everything is, how it moves, and how each drive alone would move it.
#[derive(Clone, Debug)]
pub struct Instant<T> {
    /// Poses of the bodies.
    pub poses: Vec<Pose<T>>,
    /// Velocity of the bodies' origins (m/s) and angular speed (rad/s).
    pub velocities: Vec<[T; 3]>,
    /// Acceleration of the bodies' origins (m/s^2) and angular acceleration (rad/s^2).
    pub accelerations: Vec<[T; 3]>,
    /// For every drive and body the kinematic coefficients: derivatives of x, y and angle to the drive's coordinate.
    pub coefficients: Vec<Vec<[T; 3]>>,
    /// Derivatives of the coefficients of each drive to its own coordinate.
    pub coefficient_rates: Vec<Vec<[T; 3]>>,
    /// Drive coordinates.
    pub inputs: Vec<Input<T>>,
    /// Speeds of the drives' coordinates.
    pub drive_speeds: Vec<T>,
    /// Accelerations of the drives' coordinates.
    pub drive_accelerations: Vec<T>,
    /// Angles of the bodies to within half a turn, rad.
    pub near: Vec<f64>,
    /// Values of everything that varies: see [`crate::amount`].
    pub amounts: Vec<T>,
    /// What stops push on every link, about its body's origin; nothing where none does.
    pub pressed: Vec<[T; 3]>,
    /// The time, s: contacts are known to begin and end in time.
    pub time: f64,
}

impl<T: Number> Instant<T> {
    /// What the joints of a design with these dimensions are asked at.
    pub(crate) fn situation<'a>(&'a self, geometry: &'a Geometry<T>) -> Situation<'a, T> {
        Situation {
            geometry,
            inputs: &self.inputs,
            poses: &self.poses,
            near: &self.near,
        }
    }

    /// Storage for a mechanism with so many varying amounts; everything at rest.
    pub fn new(mechanism: &Mechanism, amounts: usize) -> Self {
        let (bodies, drives) = (mechanism.bodies, mechanism.model.drives.len());
        let zero = [T::zero(); 3];
        Self {
            poses: vec![Pose::identity(); bodies],
            velocities: vec![zero; bodies],
            accelerations: vec![zero; bodies],
            coefficients: vec![vec![zero; bodies]; drives],
            coefficient_rates: vec![vec![zero; bodies]; drives],
            inputs: vec![Input::length(T::zero()); drives],
            drive_speeds: vec![T::zero(); drives],
            drive_accelerations: vec![T::zero(); drives],
            near: vec![0.0; bodies],
            amounts: vec![T::zero(); amounts],
            pressed: Vec::new(),
            time: 0.0,
        }
    }

    /// The unwrapped angle of a body, rad.
    pub fn angle(&self, body: BodyId) -> T {
        self.poses[body.index()].angle_near(self.near[body.index()])
    }

    /// The unwrapped angles of the bodies, rad.
    pub fn angles(&self) -> impl Iterator<Item = T> {
        (0..self.poses.len()).map(|body| self.angle(BodyId(body as u32)))
    }

    /// From a body's origin to a point given in the body's coordinates, along the frame's axes.
    #[inline(always)]
    pub fn arm(&self, body: BodyId, local: [T; 2]) -> [T; 2] {
        self.poses[body.index()].turn(local)
    }

    /// Place of a point at `arm` from a body's origin.
    #[inline(always)]
    pub fn place(&self, body: BodyId, arm: [T; 2]) -> [T; 2] {
        let pose = &self.poses[body.index()];
        add([pose.x, pose.y], arm)
    }

    /// Velocity of a point at `arm` from a body's origin.
    #[inline(always)]
    pub fn velocity(&self, body: BodyId, arm: [T; 2]) -> [T; 2] {
        let v = self.velocities[body.index()];
        add([v[0], v[1]], times(left(arm), v[2]))
    }

    /// Acceleration of a point at `arm` from a body's origin.
    #[inline(always)]
    pub fn acceleration(&self, body: BodyId, arm: [T; 2]) -> [T; 2] {
        let (w, a) = (
            self.velocities[body.index()][2],
            self.accelerations[body.index()],
        );
        add(
            add([a[0], a[1]], times(left(arm), a[2])),
            times(arm, -(w * w)),
        )
    }
}

/// Angular part of a series of poses: `c s' - s c'`.
#[inline(always)]
fn turning<B: Number, const N: usize>(pose: &Pose<Jet<B, N>>) -> Jet<B, N> {
    pose.c * pose.s.differentiate() - pose.s * pose.c.differentiate()
}

/// First and second derivatives of a pose's place and angle.
fn slopes_of(pose: &Pose<Rates>) -> ([f64; 3], [f64; 3]) {
    let (c, s) = (pose.c.coefficients(), pose.s.coefficients());
    let first = [
        pose.x.coefficient(1),
        pose.y.coefficient(1),
        c[0] * s[1] - s[0] * c[1],
    ];
    let second = [
        2.0 * pose.x.coefficient(2),
        2.0 * pose.y.coefficient(2),
        2.0 * (c[0] * s[2] - s[0] * c[2]),
    ];
    (first, second)
}

#[inline(always)]
fn slopes<B: Number, const N: usize>(pose: &Pose<Jet<B, N>>) -> [Jet<B, N>; 3] {
    [
        pose.x.differentiate(),
        pose.y.differentiate(),
        turning(pose),
    ]
}

pub(crate) fn cut<B: Number>(series: Series<B>) -> Rates<B> {
    Rates::from_coefficients([0, 1, 2].map(|k| series.coefficient(k)))
}

impl<B: Number> Instant<Rates<B>> {
    /// Takes everything but the amounts from a state. Coefficients of drives other than the one along which the state's
    /// series run are known at the instant only: their rates are NaN.
    pub fn set(&mut self, state: &State<B>) {
        // The frame stands still, as it was made.
        for body in 1..state.poses.len() {
            let pose = state.pose(BodyId(body as u32));
            let velocity = slopes(&pose);
            self.poses[body] = pose.map(cut);
            self.velocities[body] = velocity.map(cut);
            self.accelerations[body] = velocity.map(|v| cut(v.differentiate()));
        }
        self.near.copy_from_slice(&state.near);
        self.time = state.time.value();
        let unknown = B::from_f64(f64::NAN);
        for (index, drive) in state.mechanism().model.drives.iter().enumerate() {
            let id = DriveId(index as u32);
            let coordinate = state.coordinate(id);
            self.inputs[index] = input_of(drive, cut(coordinate));
            let speed = coordinate.differentiate();
            self.drive_speeds[index] = cut(speed);
            self.drive_accelerations[index] = cut(speed.differentiate());
            let along_path = state.abscissa.drive == Some(id);
            let poses = state.along(id);
            for body in 1..self.poses.len() {
                let (first, second) = match poses {
                    None => (
                        [Rates::from_f64(f64::NAN); 3],
                        [Rates::from_f64(f64::NAN); 3],
                    ),
                    Some(poses) => {
                        let first = slopes(&poses[body]);
                        let second = first.map(|s| s.differentiate());
                        let in_time = |s: Series<B>| {
                            if along_path {
                                s.compose_to(&state.abscissa.clock)
                            } else {
                                Rates::from_coefficients([s.coefficient(0), unknown, unknown])
                            }
                        };
                        (first.map(in_time), second.map(in_time))
                    }
                };
                self.coefficients[index][body] = first;
                self.coefficient_rates[index][body] = second;
            }
        }
    }
}

impl Instant<Rates> {
    /// The plain values.
    pub fn value_into(&self, out: &mut Instant<f64>) {
        let three = |from: &[[Rates; 3]], to: &mut [[f64; 3]]| {
            for (from, to) in from.iter().zip(to) {
                *to = from.map(Number::value);
            }
        };
        for (from, to) in self.poses.iter().zip(&mut out.poses) {
            *to = from.value();
        }
        three(&self.velocities, &mut out.velocities);
        three(&self.accelerations, &mut out.accelerations);
        for (from, to) in self.coefficients.iter().zip(&mut out.coefficients) {
            three(from, to);
        }
        for (from, to) in self
            .coefficient_rates
            .iter()
            .zip(&mut out.coefficient_rates)
        {
            three(from, to);
        }
        for (from, to) in self.inputs.iter().zip(&mut out.inputs) {
            *to = from.plain();
        }
        for (from, to) in self.drive_speeds.iter().zip(&mut out.drive_speeds) {
            *to = from.value();
        }
        let accelerations = self.drive_accelerations.iter();
        for (from, to) in accelerations.zip(&mut out.drive_accelerations) {
            *to = from.value();
        }
        out.near.copy_from_slice(&self.near);
        out.time = self.time;
        for (from, to) in self.amounts.iter().zip(&mut out.amounts) {
            *to = from.value();
        }
    }
}

impl Instant<f64> {
    /// Takes poses that were solved as series in time, with the coordinates of the drives as such series (SI). `near` are the
    /// bodies' angles to within half a turn. Kinematic coefficients are not touched.
    pub fn set_in_time(
        &mut self,
        state: &Configuration<Rates>,
        near: &[f64],
        coordinates: &[Rates],
    ) {
        for (body, pose) in state.poses.iter().enumerate().skip(1) {
            let (first, second) = slopes_of(pose);
            self.poses[body] = pose.value();
            self.velocities[body] = first;
            self.accelerations[body] = second;
        }
        for (out, input) in self.inputs.iter_mut().zip(&state.inputs) {
            *out = input.plain();
        }
        for (index, q) in coordinates.iter().enumerate() {
            self.drive_speeds[index] = q.coefficient(1);
            self.drive_accelerations[index] = 2.0 * q.coefficient(2);
        }
        self.near.copy_from_slice(near);
    }

    /// Takes the kinematic coefficients of some drives from poses that were solved with their derivatives to the coordinates of these.
    pub fn set_coefficients<const K: usize>(
        &mut self,
        drives: &[DriveId],
        state: &Configuration<Dual<f64, K>>,
    ) {
        for (k, drive) in drives.iter().enumerate().take(K) {
            let out = &mut self.coefficients[drive.index()];
            for (out, pose) in out.iter_mut().zip(&state.poses).skip(1) {
                let turns = pose.c.re * pose.s.eps[k] - pose.s.re * pose.c.eps[k];
                *out = [pose.x.eps[k], pose.y.eps[k], turns];
            }
        }
    }

    /// Takes the derivatives of the coefficients of a drive to its coordinate from such series.
    pub fn set_coefficient_rates(&mut self, drive: DriveId, state: &Configuration<Rates>) {
        let out = &mut self.coefficient_rates[drive.index()];
        for (out, pose) in out.iter_mut().zip(&state.poses).skip(1) {
            *out = slopes_of(pose).1;
        }
    }

    /// Lets the coordinate of a drive accelerate by so much more.
    pub fn accelerate(&mut self, drive: DriveId, by: f64) {
        self.drive_accelerations[drive.index()] += by;
        let coefficients = &self.coefficients[drive.index()];
        for (acceleration, k) in self.accelerations.iter_mut().zip(coefficients).skip(1) {
            for (a, k) in acceleration.iter_mut().zip(k) {
                *a += k * by;
            }
        }
    }

    /// Takes a state that was solved as a series in the coordinate of one drive, which moves with this speed and
    /// acceleration while the others stand still. Allocates nothing. `near` are the bodies' angles to within half a turn.
    pub fn set_along(
        &mut self,
        state: &Configuration<Rates>,
        near: &[f64],
        drive: DriveId,
        [speed, acceleration]: [f64; 2],
    ) {
        for (index, (input_out, input_in)) in self.inputs.iter_mut().zip(&state.inputs).enumerate()
        {
            *input_out = input_in.plain();
            let moves = index == drive.index();
            self.drive_speeds[index] = if moves { speed } else { 0.0 };
            self.drive_accelerations[index] = if moves { acceleration } else { 0.0 };
        }
        let square = speed * speed;
        let (first_out, second_out) = (
            &mut self.coefficients[drive.index()],
            &mut self.coefficient_rates[drive.index()],
        );
        for (body, pose) in state.poses.iter().enumerate().skip(1) {
            let (first, second) = slopes_of(pose);
            self.poses[body] = pose.value();
            for k in 0..3 {
                self.velocities[body][k] = first[k] * speed;
                self.accelerations[body][k] = first[k] * acceleration + second[k] * square;
            }
            first_out[body] = first;
            second_out[body] = second;
        }
        self.near.copy_from_slice(near);
    }
}
