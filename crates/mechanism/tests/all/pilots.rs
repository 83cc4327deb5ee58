//! What tells the place of a mechanism that is let go: rows and gradients, and the pose that they give.
#![allow(clippy::unwrap_used)]

use kempe_mechanism::constraint::{Constraint, Joint};
use kempe_mechanism::{Configuration, Design, Input, Mechanism, Pose, Situation};
use kempe_model::{DriveId, LinkId, Model};

const SLIDER_CRANK: &str = r#"
units = { length = "mm" }
[links]
frame  = { O = [0, 0], X = [200, 0] }
crank  = { O-B = 40 }
rod    = { B-C = 140 }
piston = { C = [0, 0] }
[joints]
bore = { slider = "piston", at = "C", on = "O -> X" }
[drives]
travel = { slides = "bore", at = "150 mm" }
"#;

/// The mechanism whose place its travel tells (0), or the angle of the crank (1) or of the rod (2), and what its drives are.
fn piloted() -> Design<f64> {
    let read = Model::from_toml(SLIDER_CRANK, "pilots", &mut |_| Err("no files".into()));
    let mechanism = Mechanism::new(&read.unwrap().model);
    let links = [LinkId(1), LinkId(2)];
    let mechanism = mechanism.piloted(&[(DriveId(0), 1.0)], &links);
    Design::new(&mechanism, &[])
}

#[test]
fn the_gradient_of_what_tells_is_the_derivative_of_its_row() {
    // Half a step to both sides, rad or m.
    const STEP: f64 = 1e-6;
    let design = piloted();
    let mechanism = &design.mechanism;
    let mut pilots = mechanism.constraints.iter();
    let (pilot, _) = pilots
        .find(|(c, _)| matches!(c, Constraint::Pilot(_)))
        .unwrap();
    assert_eq!(pilot.drive(), Some(DriveId(1)));
    // Off the surface, so that nothing is zero by chance.
    let places = [
        [0.0; 3],
        [0.01, -0.02, 0.7],
        [0.03, 0.05, -0.4],
        [0.14, 0.02, 0.3],
    ];
    let near: Vec<f64> = places.iter().map(|p| p[2]).collect();
    let residual = |places: &[[f64; 3]; 4], q: f64, choice: f64| {
        let poses: Vec<Pose<f64>> = (places.iter())
            .map(|p| Pose::from_angle(p[0], p[1], p[2]))
            .collect();
        let inputs = [Input::length(0.0), Input::turn(q), Input::length(choice)];
        let at = Situation {
            geometry: &design.geometry,
            inputs: &inputs,
            poses: &poses,
            near: &near,
        };
        let mut gradient = [[0.0; 3]; 4];
        let to_drive = at.gradients(pilot, |it| {
            assert_eq!(it.row, 0);
            for (sum, x) in gradient[it.body.index()].iter_mut().zip(it.to) {
                *sum += x;
            }
        });
        (at.residual(pilot)[0], gradient, to_drive)
    };
    for choice in [0.0, 1.0, 2.0] {
        let q = 0.25;
        let (_, gradient, to_drive) = residual(&places, q, choice);
        for body in 1..4 {
            for k in 0..3 {
                let [mut low, mut high] = [places; 2];
                low[body][k] -= STEP;
                high[body][k] += STEP;
                let slope =
                    (residual(&high, q, choice).0 - residual(&low, q, choice).0) / (2.0 * STEP);
                let off = (slope - gradient[body][k]).abs();
                assert!(off < 1e-8, "{choice}: {body} {k}: {slope} {gradient:?}");
            }
        }
        let slope = (residual(&places, q + STEP, choice).0 - residual(&places, q - STEP, choice).0)
            / (2.0 * STEP);
        assert!(
            (slope - to_drive).abs() < 1e-8,
            "{choice}: {slope} {to_drive}"
        );
    }
}

#[test]
fn whichever_tells_the_pose_is_the_same() {
    let design = piloted();
    // Crank at 60 degrees: rod and travel by the cosine rule.
    let crank = std::f64::consts::FRAC_PI_3;
    let (s, c) = kempe_number::math::sin_cos(crank);
    let down = 0.04 * s / 0.14;
    let rod = -kempe_number::math::atan2(down, (1.0 - down * down).sqrt());
    let (rod_s, rod_c) = kempe_number::math::sin_cos(rod);
    let travel = 0.04 * c + 0.14 * rod_c;
    let exact = [
        [0.0; 3],
        [0.0, 0.0, crank],
        [0.04 * c, 0.04 * s, rod],
        [travel, 0.0, 0.0],
    ];
    assert!((0.04 * s + 0.14 * rod_s).abs() < 1e-15);
    let poses: Vec<Pose<f64>> = (exact.iter())
        .map(|p| Pose::from_angle(p[0], p[1], p[2]))
        .collect();
    let near: Vec<f64> = exact.iter().map(|p| p[2]).collect();
    for (choice, told) in [(0.0, travel), (1.0, crank), (2.0, rod)] {
        let coordinates = [travel, told, choice];
        // Begun a little beside.
        let beside: Vec<Pose<f64>> = (exact.iter())
            .map(|p| Pose::from_angle(p[0] + 1e-3, p[1] - 1e-3, p[2] + 0.02))
            .collect();
        let mut branch = design.branch_through(&poses, &near, &coordinates);
        branch.guess = beside;
        let mut state = Configuration::new(&design.mechanism);
        state.set_inputs(&design.mechanism, &coordinates);
        design.solve(&branch, &mut state);
        for (found, wanted) in state.poses.iter().zip(&poses).skip(1) {
            let off = [
                found.x - wanted.x,
                found.y - wanted.y,
                found.c - wanted.c,
                found.s - wanted.s,
            ];
            assert!(off.iter().all(|x| x.abs() < 1e-12), "{choice}: {off:?}");
        }
    }
}
