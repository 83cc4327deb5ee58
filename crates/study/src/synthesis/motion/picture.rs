//! Poses of a guided body with the pivots that guide it, and of four poses the curves of all pivots.

use kempe_model::Model;
use kempe_synthesis::{BurmesterCurve, C, CurveDrawing, Linkage, Pose};
use kempe_units::Dimension;

use super::dyads::REACH;
use crate::result::{Figure, PlaneCurve};
use crate::unit::Units;

/// The axes of a pose are drawn so long, as a part of the body's way.
const AXES: f64 = 0.08;
/// Half of the cross at a pivot, as a part of the picture.
const CROSS: f64 = 0.012;
/// Curves of pivots are drawn over this part of the picture to all sides.
const AROUND: f64 = 0.6;

/// The figure of poses and of linkages that guide through them.
pub(in crate::synthesis) fn picture(
    model: &Model,
    poses: &[Pose],
    kept: &[&Linkage],
) -> Option<Figure> {
    let first = poses.first()?;
    let unit = Units::of(model).unit(Dimension::LENGTH);
    let mut fixed: Vec<C> = Vec::new();
    let mut moving: Vec<C> = Vec::new();
    for linkage in kept {
        let (of_frame, of_body): (&[C], &[C]) = match linkage {
            Linkage::FourBar(it) => (&it.fixed, &it.moving),
            Linkage::SliderCrank(it) => (std::slice::from_ref(&it.fixed), &it.moving),
            Linkage::InvertedSliderCrank(it) => (&it.fixed, std::slice::from_ref(&it.moving)),
            Linkage::TwoSliders(..) => (&[], &[]),
        };
        // Of a body that only comes near, as everywhere in the first pose that is asked for.
        fixed.extend(of_frame);
        moving.extend(of_body.iter().map(|pin| first.place(*pin)));
    }
    let way = (poses.iter()).fold(0.0_f64, |m, p| m.max((p.origin - first.origin).norm()));
    let places = || {
        poses
            .iter()
            .map(|p| p.origin)
            .chain(fixed.iter().chain(&moving).copied())
    };
    let bound =
        |pick: fn(f64, f64) -> f64, of: fn(C) -> f64| places().map(of).reduce(pick).unwrap_or(0.0);
    let (low, high) = (
        C::new(bound(f64::min, |p| p.re), bound(f64::min, |p| p.im)),
        C::new(bound(f64::max, |p| p.re), bound(f64::max, |p| p.im)),
    );
    let size = (high - low).norm();
    let mut curves = Vec::new();
    let mut draw = |name: &str, dashed: bool, lines: Vec<Vec<C>>| {
        if lines.is_empty() {
            return;
        }
        let lines = lines.iter().map(|line| line.iter().map(|p| [p.re, p.im]));
        curves.push(PlaneCurve::lines(name, dashed, lines, &unit));
    };
    let arm = AXES * if way > 0.0 { way } else { size };
    let axes = poses.iter().map(|pose| {
        let [x, y] = [C::new(arm, 0.0), C::new(0.0, arm)];
        // A long x axis with a short y one tells them from each other.
        vec![pose.place(x.scale(2.0)), pose.origin, pose.place(y)]
    });
    draw("poses", false, axes.collect());
    if let [a, b, c, d] = poses
        && let Ok(curve) = BurmesterCurve::new(&[*a, *b, *c, *d])
    {
        let margin = C::new(AROUND * size, AROUND * size);
        let (low, high) = (low - margin, high + margin);
        let in_picture =
            |p: C| (low.re..=high.re).contains(&p.re) && (low.im..=high.im).contains(&p.im);
        let drawing = CurveDrawing::default().with_reach(REACH);
        let closed = |points: Vec<C>, closed: bool| {
            let again = points.first().copied().filter(|_| closed);
            points.into_iter().chain(again).collect::<Vec<C>>()
        };
        let centres = curve.drawn_where(drawing, |fixed, _| in_picture(fixed));
        let of_fixed = centres
            .iter()
            .map(|piece| closed(piece.points.iter().map(|p| p.fixed).collect(), piece.closed));
        let circles = curve.drawn_where(drawing, |_, pin| in_picture(first.place(pin)));
        let of_moving = circles.iter().map(|piece| {
            let points = piece.points.iter().map(|p| first.place(p.moving));
            closed(points.collect(), piece.closed)
        });
        draw("curve of fixed pivots", false, of_fixed.collect());
        draw(
            "curve of moving pivots in the first pose",
            true,
            of_moving.collect(),
        );
    }
    let half = CROSS * if size > 0.0 { size } else { 1.0 };
    // An upright cross, and one that lies.
    let crosses = |all: &[C], along: C| {
        let lines = all.iter().flat_map(|at| {
            [along, C::i() * along].map(|d| vec![*at - d.scale(half), *at + d.scale(half)])
        });
        lines.collect::<Vec<_>>()
    };
    draw("fixed pivots", false, crosses(&fixed, C::new(1.0, 0.0)));
    let diagonal = C::from_polar(1.0, std::f64::consts::FRAC_PI_4);
    draw(
        "moving pivots in the first pose",
        false,
        crosses(&moving, diagonal),
    );
    Some(Figure::Plane {
        name: "pivots".to_owned(),
        unit,
        curves,
    })
}
