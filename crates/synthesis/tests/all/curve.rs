//! The curves of four poses.

use crate::support;
use crate::support::{RandomFourBar, between};
use kempe_number::Random;
use kempe_synthesis::{
    BurmesterCurve, C, CurveDrawing, Dyad, DyadCondition, Line, Pose, SynthesisError, dyads, pole,
};

fn four(random: &mut Random) -> ([Pose; 4], RandomFourBar) {
    loop {
        let bar = RandomFourBar::new(random);
        if let Some((poses, _)) = bar.poses(random, 4, 0.3) {
            return ([poses[0], poses[1], poses[2], poses[3]], bar);
        }
    }
}

/// How far from the polyline of fixed pivots, and the piece's own moving pivot nearby.
fn distance(
    pieces: &[kempe_synthesis::CurvePiece],
    at: C,
    of: fn(&kempe_synthesis::CurvePoint) -> C,
) -> f64 {
    let mut least = f64::INFINITY;
    for piece in pieces {
        let mut points: Vec<C> = piece.points.iter().map(of).collect();
        if piece.closed {
            points.push(points[0]);
        }
        for w in points.windows(2) {
            let (chord, side) = (w[1] - w[0], at - w[0]);
            let along = ((chord.re * side.re + chord.im * side.im) / chord.norm_sqr().max(1e-300))
                .clamp(0.0, 1.0);
            least = least.min((side - chord.scale(along)).norm());
        }
    }
    least
}

#[test]
fn every_point_drawn_is_a_dyad_and_every_dyad_is_drawn() {
    let mut random = Random(31);
    let (mut points, mut missed, mut checked) = (0, 0, 0);
    for _ in 0..1000 {
        let (poses, bar) = four(&mut random);
        let curve = BurmesterCurve::new(&poses).unwrap();
        assert!((1..=2).contains(&curve.loops()), "{}", curve.loops());
        let pieces = curve.drawn(CurveDrawing::default().with_reach(100.0));
        for piece in &pieces {
            points += piece.points.len();
            for point in &piece.points {
                let dyad = Dyad::rr(point.fixed, point.moving, &poses[0]);
                let worst = poses
                    .iter()
                    .map(|p| dyad.residual(p).abs())
                    .fold(0.0, f64::max);
                assert!(worst < 1e-6, "{worst:e} {point:?}");
                let Some(Dyad::Rr { fixed, .. }) = curve.dyad(piece.of_loop, point.parameter)
                else {
                    panic!()
                };
                assert!((fixed - point.fixed).norm() < 1e-6);
            }
        }
        // The linkage's own dyads, and all those on a random line through one of them, found another way.
        let line = Line::at_angle(bar.fixed[0], between(&mut random, 0.0, 3.0));
        let mut known = vec![(bar.fixed[0], bar.moving[0]), (bar.fixed[1], bar.moving[1])];
        for d in dyads(&poses, &[DyadCondition::FixedOn(line)]).unwrap() {
            if let Dyad::Rr { fixed, moving, .. } = d.dyad {
                known.push((fixed, moving));
            }
        }
        for (fixed, moving) in known {
            if fixed.norm().max(moving.norm()) > 4.0 {
                continue;
            }
            checked += 1;
            let off =
                distance(&pieces, fixed, |p| p.fixed).max(distance(&pieces, moving, |p| p.moving));
            if off > 0.06 {
                missed += 1;
                println!("{off} {fixed:?} {moving:?}");
            }
        }
    }
    println!("{points} points, {missed} of {checked} not drawn");
    assert!(checked > 2000 && missed * 1000 <= checked);
}

#[test]
fn the_curve_passes_through_the_poles() {
    let mut random = Random(32);
    for _ in 0..300 {
        let (poses, _) = four(&mut random);
        let curve = BurmesterCurve::new(&poses).unwrap();
        let wide = CurveDrawing::default()
            .with_reach(300.0)
            .with_flatness(0.003);
        let pieces = curve.drawn(wide);
        for i in 0..4 {
            for j in i + 1..4 {
                let at = pole(&poses[i], &poses[j]).unwrap();
                if at.norm() < 5.0 {
                    let off = distance(&pieces, at, |p| p.fixed);
                    assert!(off < 0.05, "{off} {at:?}");
                }
            }
        }
    }
}

#[test]
fn parts_wanted_end_where_they_are_no_longer_wanted() {
    let mut random = Random(33);
    for _ in 0..300 {
        let (poses, _) = four(&mut random);
        let curve = BurmesterCurve::new(&poses).unwrap();
        let pieces = curve.drawn_where(CurveDrawing::default(), |fixed, _| fixed.im > 0.0);
        for piece in &pieces {
            assert!(piece.points.iter().all(|p| p.fixed.im > 0.0));
        }
    }
}

#[test]
fn units_do_not_matter_and_special_poses_are_told() {
    let mut random = Random(34);
    let (poses, _) = four(&mut random);
    let count = |poses: &[Pose; 4]| -> Vec<usize> {
        let curve = BurmesterCurve::new(poses).unwrap();
        curve
            .drawn(CurveDrawing::default())
            .iter()
            .map(|p| p.points.len())
            .collect()
    };
    for scale in [1e-6, 1e6] {
        let other = support::moved(&poses, scale, 0.0, C::zero());
        assert_eq!(
            count(&poses),
            count(&[other[0], other[1], other[2], other[3]])
        );
    }
    let same = [poses[0], poses[1], poses[0], poses[3]];
    assert!(matches!(
        BurmesterCurve::new(&same),
        Err(SynthesisError::Repeated {
            first: 0,
            second: 2
        })
    ));
    let slid = poses.map(|p| Pose { angle: 1.0, ..p });
    assert!(matches!(
        BurmesterCurve::new(&slid),
        Err(SynthesisError::Translations)
    ));
}
