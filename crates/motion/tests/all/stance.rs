//! A stance led from place to place against the motion that is traced there.
#![allow(clippy::unwrap_used)]

use crate::support::generate::{make, recipe};
use crate::support::{Case, spread};
use kempe_motion::Stance;

#[test]
fn a_stance_comes_to_the_poses_of_the_motion() {
    let (mut compared, mut lost) = (0, 0);
    for seed in 0..120 {
        let case = Case::of(&make(&recipe(seed)).spec);
        let Ok(motion) = case.motion() else { continue };
        // Between change points and limits the branch is what closes next to where it was.
        if !motion.events.is_empty() || !motion.places.is_empty() {
            continue;
        }
        let Some(mut stance) = Stance::on(&motion, motion.start) else {
            continue;
        };
        let mut solver = motion.solver();
        for p in spread(&motion, 5) {
            let Some(placed) = motion.placed(p, &mut solver) else {
                continue;
            };
            let mut to = vec![0.0; motion.mechanism().model.drives.len()];
            motion.path.coordinates(p, &mut to);
            if !stance.go(&to) {
                lost += 1;
                continue;
            }
            assert_eq!(stance.coordinates(), to);
            assert!(stance.evidence().closure < 1e-10, "seed {seed}");
            let size = motion.size();
            for (body, (a, b)) in stance.poses().iter().zip(&placed.poses).enumerate() {
                let off = [(a.x - b.x) / size, (a.y - b.y) / size, a.c - b.c, a.s - b.s];
                assert!(
                    off.iter().all(|x| x.abs() < 1e-9),
                    "seed {seed}, body {body} at {p}: {off:?}"
                );
                let turned = stance.branch().near[body] - placed.near[body];
                assert!(turned.abs() < 1.0, "seed {seed}: turns {turned}");
            }
            compared += 1;
        }
    }
    assert!(
        compared > 150 && lost * 20 < compared,
        "{compared} compared, {lost} lost"
    );
}

#[test]
fn a_stance_ends_at_a_limit_and_stays_where_it_was() {
    // Non-Grashof: the crank comes to 55.77 deg where coupler and rocker are stretched, (30 + 20)^2 = 40^2 + 60^2 - 4800 cos.
    let text = "[links]\nframe = { A = [0, 0], D = [60, 0] }\ncrank = { A-B = 40 }\ncoupler = { B-C = 30 }\nrocker = { D-C = 20 }\n\
                [assembly]\nC = \"left of B -> D\"\n[drives]\nmotor = { turns = \"crank\", at = 10 }\n";
    let motion = Case::read(text, "limited").must_move();
    let mut stance = Stance::on(&motion, motion.start).unwrap();
    let limit = kempe_number::math::acos((1600.0 + 3600.0 - 2500.0) / 4800.0);
    let before = stance.poses().to_vec();
    assert!(!stance.go(&[limit + 1e-3]) && !stance.go(&[3.0]) && !stance.go(&[f64::NAN]));
    assert_eq!(stance.poses(), before);
    assert!(stance.go(&[limit - 1e-4]));
    assert!(stance.go(&[0.2]));
    let there = stance.places().1;
    assert!(stance.go(&[0.9]) && stance.go(&[0.2]));
    for (a, b) in there.iter().zip(stance.places().1) {
        assert!((a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-10);
    }
}
