//! Random mechanisms let go, against the same in absolute coordinates: place and angle of every body with the constraints' multipliers,
//! Newton's and Euler's equations of each body, no plan, no coefficients and no reduced mass anywhere.
#![allow(clippy::unwrap_used, clippy::disallowed_methods)]

use crate::common::weigh;
use crate::mechanisms;
use crate::mechanisms::generate::{make, recipe};
use crate::mechanisms::{Case, Rng};
use kempe_dynamics::Forces;
use kempe_integrate::{Integrator, Method as Steps, Tolerance};
use kempe_linear::Lu;
use kempe_mechanism::configuration::input_of;
use kempe_mechanism::constraint::Joint;
use kempe_mechanism::{Design, Input, Pose, Situation};
use kempe_model::DriveId;
use kempe_motion::Silent;
use kempe_number::{Jet, Number};
use kempe_simulate::{Ending, Method, Question, simulate};

type Series = Jet<f64, 3>;

/// All bodies of a mechanism, by their own equations.
struct Absolute {
    design: Design<f64>,
    rich: Design<Series>,
    forces: Forces<f64>,
    gravity: [f64; 2],
    /// Angles to within half a turn.
    near: Vec<f64>,
}

impl Absolute {
    /// Rows of all constraints but those of drives, or of those at their coordinates, and the rows' accelerations where no body
    /// accelerates: `places` and `speeds` are those of the bodies but the frame.
    fn rows(
        &self,
        places: &[f64],
        speeds: &[f64],
        drives: Option<&[f64]>,
    ) -> (Vec<Vec<f64>>, Vec<f64>) {
        let mechanism = &self.design.mechanism;
        let mut poses = vec![Pose::identity(); mechanism.bodies];
        let mut series = vec![Pose::<Series>::identity(); mechanism.bodies];
        let mut near = self.near.clone();
        for body in 1..mechanism.bodies {
            let (q, v) = (&places[3 * (body - 1)..], &speeds[3 * (body - 1)..]);
            let [x, y, angle] = [0, 1, 2].map(|k| Series::from_coefficients([q[k], v[k], 0.0]));
            let (s, c) = angle.sin_cos();
            series[body] = Pose { x, y, c, s };
            poses[body] = Pose::from_angle(q[0], q[1], q[2]);
            near[body] = q[2];
        }
        let inputs: Vec<Input<f64>> = (mechanism.model.drives.iter())
            .enumerate()
            .map(|(k, drive)| input_of(drive, drives.map_or(0.0, |q| q[k])))
            .collect();
        let rich: Vec<Input<Series>> = (mechanism.model.drives.iter())
            .map(|drive| input_of(drive, Series::zero()))
            .collect();
        let plain = Situation {
            geometry: &self.design.geometry,
            inputs: &inputs,
            poses: &poses,
            near: &near,
        };
        let moving = Situation {
            geometry: &self.rich.geometry,
            inputs: &rich,
            poses: &series,
            near: &near,
        };
        let (mut rows, mut bends) = (Vec::new(), Vec::new());
        for (constraint, _) in &mechanism.constraints {
            if constraint.drive().is_some() != drives.is_some() {
                continue;
            }
            let first = rows.len();
            rows.extend(vec![vec![0.0; places.len()]; constraint.rows()]);
            plain.gradients(constraint, |gradient| {
                if let Some(column) = (3 * gradient.body.index()).checked_sub(3) {
                    for (out, to) in rows[first + gradient.row][column..]
                        .iter_mut()
                        .zip(gradient.to)
                    {
                        *out += to;
                    }
                }
            });
            let residual = moving.residual(constraint);
            bends.extend(
                residual
                    .iter()
                    .take(constraint.rows())
                    .map(|r| r.derivative(2)),
            );
        }
        (rows, bends)
    }

    /// How all bodies accelerate.
    fn accelerate(&self, places: &[f64], speeds: &[f64]) -> Option<Vec<f64>> {
        let (rows, bends) = self.rows(places, speeds, None);
        let (n, m) = (places.len(), rows.len());
        let mut matrix = vec![vec![0.0; n + m]; n + m];
        let mut right = vec![0.0; n + m];
        for mass in &self.forces.acting.masses {
            let first = 3 * (mass.body.index() - 1);
            let (angle, w) = (places[first + 2], speeds[first + 2]);
            let [x, y] = mass.center;
            let arm = [
                x * angle.cos() - y * angle.sin(),
                x * angle.sin() + y * angle.cos(),
            ];
            let by = mass.mass;
            // d/dt of momentum of the centre, and about the body's origin.
            for k in 0..2 {
                matrix[first + k][first + k] += by;
                right[first + k] += by * (self.gravity[k] + arm[k] * w * w);
            }
            let turned = [-arm[1], arm[0]];
            for k in 0..2 {
                matrix[first + k][first + 2] += by * turned[k];
                matrix[first + 2][first + k] += by * turned[k];
                right[first + 2] += by * turned[k] * self.gravity[k];
            }
            matrix[first + 2][first + 2] += mass.moment + by * (x * x + y * y);
        }
        for (row, values) in rows.iter().enumerate() {
            for (column, value) in values.iter().enumerate() {
                matrix[n + row][column] = *value;
                matrix[column][n + row] = *value;
            }
            right[n + row] = -bends[row];
        }
        let mut factors = Lu::new(n + m);
        factors.factor(|row, column| matrix[row][column]).then(|| {
            factors.solve(&mut right);
            right[..n].to_vec()
        })
    }

    /// The speeds of all bodies where the drives have these.
    fn speeds(&self, places: &[f64], drives: &[[f64; 2]]) -> Option<Vec<f64>> {
        let nothing = vec![0.0; places.len()];
        let (mut rows, _) = self.rows(places, &nothing, None);
        let coordinates: Vec<f64> = drives.iter().map(|drive| drive[0]).collect();
        let mut right = vec![0.0; rows.len()];
        // A driven row falls as its coordinate rises.
        rows.extend(self.rows(places, &nothing, Some(&coordinates)).0);
        right.extend(drives.iter().map(|drive| drive[1]));
        if rows.len() != places.len() {
            return None;
        }
        let mut factors = Lu::new(rows.len());
        factors.factor(|row, column| rows[row][column]).then(|| {
            factors.solve(&mut right);
            right
        })
    }
}

/// A mechanism's bodies: places and angles of all but the frame.
fn places(poses: &[Pose<f64>], near: &[f64]) -> Vec<f64> {
    let bodies = poses.iter().zip(near).skip(1);
    bodies
        .flat_map(|(pose, near)| [pose.x, pose.y, pose.angle_near(*near)])
        .collect()
}

#[test]
fn minimal_coordinates_move_as_absolute_ones_do() {
    let (mut compared, mut several) = (0, 0);
    for seed in 0..64 {
        let mut rng = Rng(seed ^ 0x5eed);
        let mut model = Case::of(&make(&recipe(seed)).spec).model;
        let size = Case::from_model(model.clone()).design.size();
        weigh(&mut model, size, |low, high| rng.range(low, high));
        model.actions.friction.clear();
        let case = Case::from_model(model);
        let plan = &case.mechanism.plan;
        // Loads that repeat each other have no multipliers of their own.
        if !plan.decomposition.surplus.is_empty()
            || plan.blocks.iter().any(|block| !block.surplus.is_empty())
        {
            continue;
        }
        let drives = &case.model.drives;
        let until = 0.3 * (size / 9.81).sqrt();
        let start: Vec<[f64; 2]> = (drives.iter())
            .map(|drive| {
                let unit = if drive.dimension == kempe_units::Dimension::ANGLE {
                    1.0
                } else {
                    size
                };
                [
                    drive.law.at(0.0, &case.parameters),
                    0.2 * unit * rng.range(-1.0, 1.0) / until,
                ]
            })
            .collect();
        let question = Question {
            free: (0..drives.len() as u32).map(DriveId).collect(),
            start: start.clone(),
            until,
            tolerance: 1e-11,
            method: Method::Choose,
            stops: Vec::new(),
            end_when: Vec::new(),
            coordinates: kempe_simulate::Coordinates::Minimal,
            contacts: Vec::new(),
        };
        let Ok(found) = simulate(&case.design, &question, &mut Silent) else {
            continue;
        };
        if found.ending != Ending::Until || !found.told_by().is_empty() {
            continue;
        }
        let motion = found.motion(&mut Silent).unwrap();
        let mut solver = motion.solver::<f64>();
        let mut at = |time: f64| {
            let design = &motion.design;
            let p = motion
                .path
                .parameter_at(&motion.mechanism().model, time, &design.parameters);
            motion.solve(design, p, &mut solver);
            places(&solver.state.poses, &solver.branch.near)
        };
        let (first, last) = (at(0.0), at(until));
        let design = case.design.clone();
        let absolute = Absolute {
            rich: design.lift(Series::from_f64),
            forces: Forces::new(design.clone()).unwrap(),
            gravity: [0.0, -9.81],
            near: vec![0.0; design.mechanism.bodies],
            design,
        };
        let Some(speeds) = absolute.speeds(&first, &start) else {
            continue;
        };
        let n = first.len();
        let mut system = |_: f64, y: &[f64], rates: &mut [f64]| {
            rates[..n].copy_from_slice(&y[n..]);
            match absolute.accelerate(&y[..n], &y[n..]) {
                Some(a) => rates[n..].copy_from_slice(&a),
                None => return false,
            }
            true
        };
        let tolerance = Tolerance {
            relative: 1e-11,
            absolute: vec![1e-11 * size.min(1.0); 2 * n],
        };
        let y = [first, speeds].concat();
        let mut it =
            Integrator::with(Steps::Explicit, &mut system, 0.0, &y, 1.0, tolerance).unwrap();
        let mut steps = 0;
        while it.time() < until {
            it.step(&mut system, until).unwrap();
            steps += 1;
            assert!(
                steps < 5000,
                "seed {seed}: {steps} steps to {}",
                it.time() / until
            );
        }
        for (body, (a, b)) in it.state()[..n].chunks(3).zip(last.chunks(3)).enumerate() {
            let off = ((a[0] - b[0]).abs() + (a[1] - b[1]).abs()) / size
                + mechanisms::wrapped(a[2] - b[2]).abs();
            assert!(off < 1e-8, "seed {seed}, body {}: {off:e}", body + 1);
        }
        compared += 1;
        several += usize::from(drives.len() > 1);
    }
    assert!(
        compared > 33 && several > 11,
        "{compared} compared, {several} of several freedoms"
    );
}
