//! Balancing masses: rest at any pose, no shaking force, or as little of it as a counterweight can leave.

use kempe_number::math;

use crate::acting::Acting;
use crate::instant::Instant;
use crate::vector::cross;

/// A counterweight: its first moment about the pivot of its link, in the link's coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Counterweight {
    /// Mass times distance along the link's axes, kg m.
    pub first_moment: [f64; 2],
    /// What is left of the quantity that was to vanish, over what there was without the counterweight.
    pub left: f64,
}

impl Counterweight {
    /// Mass needed at a distance from the pivot, kg.
    pub fn mass_at(&self, radius: f64) -> f64 {
        math::hypot(self.first_moment[0], self.first_moment[1]) / radius
    }

    /// Direction from the pivot to the mass in the link's axes, rad.
    pub fn direction(&self) -> f64 {
        math::atan2(self.first_moment[1], self.first_moment[0])
    }
}

/// First harmonics of a turning vector over a full turn of a crank: `sum over k of forward_k e^{i k q} + back_k e^{-i k q}`.
#[derive(Clone, Debug, PartialEq)]
pub struct Harmonics {
    /// Mean.
    pub mean: [f64; 2],
    /// Complex amplitudes (real, imaginary) turning with the crank, k = 1, 2, ...
    pub forward: Vec<[f64; 2]>,
    /// Complex amplitudes turning against it.
    pub back: Vec<[f64; 2]>,
}

/// Harmonics of a vector given at evenly spread crank angles over one turn (the first at `start`, the turn's end left
/// out). Exact for as many harmonics as half the number of samples, less one.
pub fn harmonics(samples: &[[f64; 2]], start: f64, count: usize) -> Harmonics {
    let n = samples.len().max(1) as f64;
    let amplitude = |k: f64| {
        let mut sum = [0.0; 2];
        for (i, v) in samples.iter().enumerate() {
            let (s, c) = math::sin_cos(-k * (start + std::f64::consts::TAU * i as f64 / n));
            sum[0] += v[0] * c - v[1] * s;
            sum[1] += v[0] * s + v[1] * c;
        }
        sum.map(|x| x / n)
    };
    Harmonics {
        mean: amplitude(0.0),
        forward: (1..=count).map(|k| amplitude(k as f64)).collect(),
        back: (1..=count).map(|k| amplitude(-(k as f64))).collect(),
    }
}

/// The counterweight on a crank that takes away the part of the shaking force that turns with it.
///
/// At the constant speed `w` a first moment `u` (complex, in the crank's axes) shakes with `u w^2 e^{i q}`, so
/// `u = -forward_1 / w^2` takes the first harmonic that turns with the crank away whole; the one that turns against it
/// can only be balanced by a shaft that turns against it (F. W. Lanchester, 1911). `samples` are shaking forces at
/// evenly spread crank angles over one turn.
pub fn crank_counterweight(samples: &[[f64; 2]], start: f64, speed: f64) -> Counterweight {
    let first = harmonics(samples, start, 1).forward[0];
    let square = speed * speed;
    let u = first.map(|x| -x / square);
    let n = samples.len().max(1) as f64;
    let (mut before, mut after) = (0.0, 0.0);
    for (i, v) in samples.iter().enumerate() {
        let (s, c) = math::sin_cos(start + std::f64::consts::TAU * i as f64 / n);
        let taken = [
            (u[0] * c - u[1] * s) * square,
            (u[0] * s + u[1] * c) * square,
        ];
        before += v[0] * v[0] + v[1] * v[1];
        after += (v[0] + taken[0]).powi(2) + (v[1] + taken[1]).powi(2);
    }
    Counterweight {
        first_moment: u,
        left: ratio(after, before),
    }
}

/// The counterweight on a link turning about a fixed pivot that leaves the least shaking force over a motion, in the
/// sense of least squares. Each sample is the shaking force with the link's angle, angular speed and acceleration: a
/// first moment `u` adds `-u (i alpha - w^2) e^{i theta}`.
pub fn least_shaking(samples: &[([f64; 2], [f64; 3])]) -> Counterweight {
    let (mut diagonal, mut right, mut before) = (0.0, [0.0; 2], 0.0);
    let factor = |[angle, speed, acceleration]: [f64; 3]| {
        // -(i alpha - w^2) e^{i theta}
        let (s, c) = math::sin_cos(angle);
        let (re, im) = (speed * speed, -acceleration);
        [re * c - im * s, re * s + im * c]
    };
    for (force, motion) in samples {
        let z = factor(*motion);
        diagonal += z[0] * z[0] + z[1] * z[1];
        // conj(z) force
        right[0] -= z[0] * force[0] + z[1] * force[1];
        right[1] -= cross(z, *force);
        before += force[0] * force[0] + force[1] * force[1];
    }
    let u = right.map(|r| if diagonal > 0.0 { r / diagonal } else { 0.0 });
    let after: f64 = (samples.iter())
        .map(|(force, motion)| {
            let z = factor(*motion);
            (force[0] + u[0] * z[0] - u[1] * z[1]).powi(2)
                + (force[1] + u[0] * z[1] + u[1] * z[0]).powi(2)
        })
        .sum();
    Counterweight {
        first_moment: u,
        left: ratio(after, before),
    }
}

/// The counterweight on a link turning about a fixed pivot that holds the weights best: the reduced load of gravity at
/// every sample is least in the sense of least squares, and zero where that can be.
///
/// Each sample is the drive's reduced load of gravity with the link's angle and its kinematic coefficient
/// `dtheta/dq`. A first moment `u` under gravity `g` adds `dtheta/dq (i u e^{i theta}) . g`.
pub fn static_counterweight(samples: &[(f64, [f64; 2])], gravity: [f64; 2]) -> Counterweight {
    let (mut a, mut right, mut before) = ([[0.0; 2]; 2], [0.0; 2], 0.0);
    let row = |[angle, coefficient]: [f64; 2]| {
        let (s, c) = math::sin_cos(angle);
        // i e^{i theta} = (-s, c); i * i e^{i theta} = (-c, -s)
        [
            coefficient * (-s * gravity[0] + c * gravity[1]),
            coefficient * (-c * gravity[0] - s * gravity[1]),
        ]
    };
    for (load, motion) in samples {
        let z = row(*motion);
        for i in 0..2 {
            for j in 0..2 {
                a[i][j] += z[i] * z[j];
            }
            right[i] -= z[i] * load;
        }
        before += load * load;
    }
    let determinant = a[0][0] * a[1][1] - a[0][1] * a[1][0];
    let scale = a[0][0] + a[1][1];
    let u = if determinant > 1e-12 * scale * scale {
        [
            (right[0] * a[1][1] - right[1] * a[0][1]) / determinant,
            (right[1] * a[0][0] - right[0] * a[1][0]) / determinant,
        ]
    } else if scale > 0.0 {
        // One pose only: the shortest first moment that holds it.
        right.map(|r| r / scale)
    } else {
        [0.0; 2]
    };
    let after: f64 = (samples.iter())
        .map(|(load, motion)| {
            let z = row(*motion);
            (load + u[0] * z[0] + u[1] * z[1]).powi(2)
        })
        .sum();
    Counterweight {
        first_moment: u,
        left: ratio(after, before),
    }
}

/// The total mass (kg) and the common centre of all moving masses (m): a mechanism whose centre stands still has no
/// shaking force.
pub fn common_center(acting: &Acting<f64>, at: &Instant<f64>) -> (f64, [f64; 2]) {
    let (mut total, mut moment) = (0.0, [0.0; 2]);
    for mass in &acting.masses {
        let place = at.place(mass.body, mass.arm(at));
        total += mass.mass;
        moment[0] += mass.mass * place[0];
        moment[1] += mass.mass * place[1];
    }
    (total, moment.map(|m| m / total))
}

fn ratio(after: f64, before: f64) -> f64 {
    if before > 0.0 {
        (after / before).sqrt()
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turning_mass_is_balanced_whole_and_a_sliding_one_by_half() {
        let n = 24;
        let at = |k: usize| std::f64::consts::TAU * k as f64 / n as f64;
        // 2 kg at 0.1 m, 30 degrees ahead on the crank, at 5 rad/s.
        let turning: Vec<[f64; 2]> = (0..n)
            .map(|k| {
                let (s, c) = math::sin_cos(at(k) + 0.5235987755982988);
                [0.2 * 25.0 * c, 0.2 * 25.0 * s]
            })
            .collect();
        let weight = crank_counterweight(&turning, 0.0, 5.0);
        assert!(weight.left < 1e-14);
        assert!((weight.mass_at(0.1) - 2.0).abs() < 1e-13);
        let opposite = 0.5235987755982988 - std::f64::consts::PI;
        assert!((weight.direction() - opposite).abs() < 1e-13);
        let sliding: Vec<[f64; 2]> = (0..n).map(|k| [5.0 * math::cos(at(k)), 0.0]).collect();
        let weight = crank_counterweight(&sliding, 0.0, 5.0);
        assert!((weight.first_moment[0] + 0.1).abs() < 1e-14);
        assert!((weight.left - 0.5_f64.sqrt()).abs() < 1e-14);
        let found = harmonics(&sliding, 0.0, 2);
        assert!(
            (found.forward[0][0] - 2.5).abs() < 1e-14 && (found.back[0][0] - 2.5).abs() < 1e-14
        );
        assert!(found.forward[1][0].abs() < 1e-14);
    }

    #[test]
    fn least_squares_agree_with_harmonics_at_constant_speed() {
        let n = 36;
        let at = |k: usize| std::f64::consts::TAU * k as f64 / n as f64;
        let forces: Vec<[f64; 2]> = (0..n)
            .map(|k| {
                [
                    math::cos(at(k)) + 0.3 * math::cos(2.0 * at(k)),
                    0.4 * math::sin(at(k)),
                ]
            })
            .collect();
        let by_harmonics = crank_counterweight(&forces, 0.0, 3.0);
        let samples: Vec<_> = (0..n).map(|k| (forces[k], [at(k), 3.0, 0.0])).collect();
        let by_squares = least_shaking(&samples);
        for k in 0..2 {
            let difference = by_harmonics.first_moment[k] - by_squares.first_moment[k];
            assert!(difference.abs() < 1e-14);
        }
    }

    #[test]
    fn a_hanging_beam_is_held_at_every_pose() {
        let gravity = [0.0, -9.81];
        // First moment (0.7, 0.2) kg m on the driven link itself.
        let samples: Vec<(f64, [f64; 2])> = (0..9)
            .map(|k| {
                let angle = 0.3 * f64::from(k);
                let (s, c) = math::sin_cos(angle);
                (-9.81 * (0.7 * c - 0.2 * s), [angle, 1.0])
            })
            .collect();
        let weight = static_counterweight(&samples, gravity);
        assert!((weight.first_moment[0] + 0.7).abs() < 1e-13);
        assert!((weight.first_moment[1] + 0.2).abs() < 1e-13);
        assert!(weight.left < 1e-13);
    }
}
