//! Wheels: gears in mesh, toothed wheels with their pitch circles, the teeth of one in the gaps of the other.

use std::f64::consts::PI;

use kempe_number::math::{atan2, sin_cos};

use super::part::{LINE, Part, link_token};
use crate::context::{Anchor, Context, link_angle};
use crate::scene::{Item, Layer, Path, Point, Style};
use crate::tokens::Token;
use crate::view::{JointView, Wheel};

/// Teeth smaller than this module on paper (mm) are left out.
const FINEST_MODULE: f64 = 0.45;
/// More teeth than this are left out.
const MOST_TEETH: u32 = 400;
/// Dashes and gaps of pitch circles and pitch lines, mm.
pub(super) const PITCH_LINE: [f64; 4] = [2.4, 0.7, 0.5, 0.7];
/// Teeth lower than this have no pitch circle of their own to be seen, mm.
const LEAST_TIP: f64 = 0.2;

/// Height of teeth of unknown size above a pitch circle, mm on paper.
pub(super) fn tip_height(radius: f64) -> f64 {
    (0.12 * radius).min(1.1)
}

/// A wheel with the angle of its first tooth in its link's axes.
#[derive(Clone, Copy)]
struct Placed {
    wheel: Wheel,
    ring: bool,
    /// It has teeth, whether or not they are drawn: it is no pulley.
    gear: bool,
    phase: f64,
}

pub(super) fn parts(context: &Context) -> Vec<Part> {
    let mut placed: Vec<Placed> = Vec::new();
    for joint in &context.view.joints {
        match *joint {
            JointView::Gears { a, b, internal } => {
                let ring_a = internal && a.radius.abs() > b.radius.abs();
                let known = |wheel: Wheel, placed: &[Placed]| {
                    placed.iter().find(|p| same(&p.wheel, &wheel)).copied()
                };
                let (first, second) = if known(a, &placed).is_none() && known(b, &placed).is_some()
                {
                    ((b, internal && !ring_a), (a, ring_a))
                } else {
                    ((a, ring_a), (b, internal && !ring_a))
                };
                let one = known(first.0, &placed).unwrap_or(Placed {
                    wheel: first.0,
                    ring: first.1,
                    gear: true,
                    phase: 0.0,
                });
                if known(first.0, &placed).is_none() {
                    placed.push(one);
                }
                if known(second.0, &placed).is_none() {
                    let phase = meshing_phase(context, &one, second.0, internal).unwrap_or(0.0);
                    placed.push(Placed {
                        wheel: second.0,
                        ring: second.1,
                        gear: true,
                        phase,
                    });
                }
            }
            JointView::Belt { a, b, .. } => {
                for wheel in [a, b] {
                    if !placed.iter().any(|p| same(&p.wheel, &wheel)) {
                        placed.push(Placed {
                            wheel,
                            ring: false,
                            gear: false,
                            phase: 0.0,
                        });
                    }
                }
            }
            JointView::Rack { pinion, .. } if !placed.iter().any(|p| same(&p.wheel, &pinion)) => {
                placed.push(Placed {
                    wheel: pinion,
                    ring: false,
                    gear: true,
                    phase: 0.0,
                });
            }
            _ => {}
        }
    }
    placed.iter().filter_map(|p| draw(context, p)).collect()
}

fn same(a: &Wheel, b: &Wheel) -> bool {
    a.link == b.link && a.center == b.center && a.radius.abs() == b.radius.abs()
}

/// The phase of the second wheel at which its teeth stand in the gaps of the first, in the reference pose.
fn meshing_phase(context: &Context, one: &Placed, other: Wheel, internal: bool) -> Option<f64> {
    if one.wheel.teeth == 0 || other.teeth == 0 {
        return None;
    }
    let frame = context.reference?;
    let (a, b) = (
        context.paper(frame, one.wheel.center)?,
        context.paper(frame, other.center)?,
    );
    let between = atan2(b[1] - a[1], b[0] - a[0]);
    let pitch = |wheel: &Wheel| 2.0 * PI / f64::from(wheel.teeth);
    let (angle_a, angle_b) = (
        link_angle(frame, one.wheel.link)?,
        link_angle(frame, other.link)?,
    );
    // how far the contact is past a tooth of the first wheel, in teeth
    let contact = if internal && !one.ring {
        between + PI
    } else {
        between
    };
    let past = (contact - angle_a - one.phase) / pitch(&one.wheel);
    Some(if internal {
        contact - angle_b - past * pitch(&other)
    } else {
        contact + PI - angle_b - (0.5 - past) * pitch(&other)
    })
}

/// Outline of a toothed wheel around the origin.
fn toothed(radius: f64, teeth: u32, phase: f64) -> Path {
    let module = 2.0 * radius / f64::from(teeth);
    let pitch = 2.0 * PI / f64::from(teeth);
    let corner = |tooth: u32, at: f64, r: f64| -> Point {
        let (s, c) = sin_cos(phase + (f64::from(tooth) + at) * pitch);
        [r * c, r * s]
    };
    let (root, tip) = (radius - 1.2 * module, radius + module);
    let profile = [(-0.36, root), (-0.13, tip), (0.13, tip), (0.36, root)];
    let points: Vec<Point> = (0..teeth)
        .flat_map(|t| profile.map(|(at, r)| corner(t, at, r)))
        .collect();
    Path::polygon(&points)
}

fn draw(context: &Context, placed: &Placed) -> Option<Part> {
    let Placed {
        wheel,
        ring,
        gear,
        phase,
    } = *placed;
    let radius = wheel.radius.abs() * context.fit.scale;
    if !(radius.is_finite() && radius > 0.05) || wheel.link >= context.view.links.len() {
        return None;
    }
    let token = link_token(wheel.link);
    let style = Style::stroke(token, 0.45).filled(token, 0.16);
    let module = 2.0 * radius / f64::from(wheel.teeth.max(1));
    let has_teeth = (5..=MOST_TEETH).contains(&wheel.teeth) && module > FINEST_MODULE;
    // teeth that are not drawn one by one: their tips, beside the pitch circle (ISO 2203)
    let height = match (gear, has_teeth, wheel.teeth) {
        (false, ..) => 0.0,
        (true, true, _) => module,
        (true, false, 5..) => module.min(tip_height(radius)),
        (true, false, _) => tip_height(radius),
    };
    let circle = |r: f64| crate::hull::rounded_hull(&[[0.0, 0.0]], r);
    let mut paths = vec![match (has_teeth, ring) {
        (true, _) => toothed(radius, wheel.teeth, phase),
        (false, true) => circle(radius - height)?,
        (false, false) => circle(radius + height)?,
    }];
    if ring {
        paths.push(circle(radius + 1.2 * height + 2.4)?);
    }
    let pitch_line = Style::stroke(token, 0.25).dashed(&PITCH_LINE);
    let (s, c) = sin_cos(phase);
    let (from, to) = if ring {
        (radius + 0.4, radius + 2.2)
    } else {
        (radius * 0.35, radius * 0.78)
    };
    let mark = Path::polyline(&[[from * c, from * s], [to * c, to * s]]);
    let mut items = vec![Item::Shape { paths, style }];
    if height > LEAST_TIP {
        items.push(Item::circle([0.0, 0.0], radius, pitch_line));
    }
    items.push(Item::path(mark, Style::stroke(token, LINE * 2.0)));
    if !ring && radius > 6.0 {
        items.push(Item::circle(
            [0.0, 0.0],
            2.4,
            Style::stroke(token, LINE).filled(Token::Background, 0.6),
        ));
    }
    Some(Part::new(
        Layer::Gear,
        Anchor::On(wheel.center, wheel.link, 0.0),
        items,
    ))
}
