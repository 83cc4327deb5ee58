//! The hand-made mechanisms with made-up forces, for looking at: every role, a singular place, a row that is not finite.
#![allow(dead_code)]

use kempe_draw::{LoadRole, LoadView};
use kempe_number::math::sin_cos;

use crate::mechanisms::{self, Case};

/// The mechanisms with forces.
pub fn all() -> Vec<Case> {
    vec![rocker(), slider(), singular()]
}

/// Every role once.
pub fn rocker() -> Case {
    let mut case = mechanisms::crank_rocker();
    case.file = "forces";
    for (row, t) in case.drive.clone().into_iter().enumerate() {
        let frame = &mut case.frames[row];
        let [a, d, b, c, p] = [0, 1, 2, 3, 4].map(|k| frame.points[k]);
        let (s, co) = sin_cos(t);
        let push = [900.0 + 500.0 * co, 700.0 * s - 400.0];
        frame.loads = vec![
            LoadView::force(LoadRole::Load, "coupler", p, [-700.0, -300.0]),
            LoadView::force(LoadRole::Weight, "coupler", p, [0.0, -180.0]),
            LoadView::force(LoadRole::Reaction, "coupler", b, push),
            LoadView::force(
                LoadRole::Reaction,
                "rocker",
                c,
                [600.0 * s, 500.0 + 300.0 * co],
            ),
            LoadView::force(
                LoadRole::Reaction,
                "rocker",
                d,
                [-600.0 * s, -500.0 - 300.0 * co],
            ),
            LoadView::force(LoadRole::Reaction, "crank", a, [-push[0], -push[1]]),
            LoadView::moment(LoadRole::Drive, "crank", a, 12.0 + 9.0 * s),
            LoadView::moment(LoadRole::Friction, "rocker", c, 4.0 * co),
            LoadView::force(LoadRole::Spring, "rocker", c, [350.0, 80.0 * s]),
        ];
    }
    case
}

/// A piston: gas force, side force on the guide, friction.
pub fn slider() -> Case {
    let mut case = mechanisms::slider_crank();
    case.file = "forces-slider";
    for (row, t) in case.drive.clone().into_iter().enumerate() {
        let frame = &mut case.frames[row];
        let last = frame.points.len() - 1;
        let (s, c) = sin_cos(t);
        let p = frame.points[last];
        frame.loads = vec![
            LoadView::force(
                LoadRole::Load,
                "piston",
                p,
                [0.0, -2000.0 - 1800.0 * c.abs()],
            ),
            LoadView::force(LoadRole::Reaction, "piston", p, [900.0 * s, 0.0]),
            LoadView::force(LoadRole::Friction, "piston", p, [0.0, 400.0 * s.signum()]),
            LoadView::force(
                LoadRole::Drive,
                "crank",
                frame.points[3],
                [-1500.0 * s, 1500.0 * c],
            ),
        ];
    }
    case
}

/// Forces that grow beyond bounds where the crank lies along x, and are not finite at one row.
pub fn singular() -> Case {
    let mut case = mechanisms::crank_rocker();
    case.file = "forces-singular";
    for (row, t) in case.drive.clone().into_iter().enumerate() {
        let frame = &mut case.frames[row];
        let (s, c) = sin_cos(t - 0.3);
        let size = if row == 30 { f64::NAN } else { 2e4 / s };
        let [b, d] = [frame.points[2], frame.points[1]];
        frame.loads = vec![
            LoadView::force(LoadRole::Reaction, "coupler", b, [size * 0.3, size * 0.8]),
            LoadView::force(LoadRole::Reaction, "rocker", d, [3e4 * c, 2e4]),
            LoadView::moment(LoadRole::Drive, "crank", frame.points[0], 0.3 * size),
        ];
    }
    case
}
