//! All solutions from a single one.

use std::time::Instant;

use kempe_alt_burmester::{Kind, monodromy};

fn reaches(kind: Kind) {
    for seed in [1, 2] {
        let begin = Instant::now();
        let found = monodromy(kind, seed);
        println!(
            "{kind:?} {seed}: {} of {} by {} paths, {:.2} s",
            found.solutions.len(),
            kind.classes(),
            found.paths,
            begin.elapsed().as_secs_f64()
        );
        assert_eq!(found.solutions.len(), kind.classes());
    }
}

#[test]
fn four_poses_and_two_points_have_30_four_bars() {
    reaches(Kind::FourPoses);
}

#[test]
fn three_poses_and_four_points_have_201_four_bars() {
    reaches(Kind::ThreePoses);
}

#[test]
fn two_poses_and_six_points_have_1112_four_bars() {
    reaches(Kind::TwoPoses);
}

#[test]
fn nine_points_have_1442_coupler_curves() {
    reaches(Kind::NinePoints);
}
