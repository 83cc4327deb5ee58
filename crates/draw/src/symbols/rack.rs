//! Racks: a toothed strip whose pitch line touches the pinion.

use std::f64::consts::PI;

use kempe_number::math::sin_cos;

use super::gear;
use super::part::{Part, link_token};
use crate::context::{Anchor, Context, link_angle};
use crate::scene::{Item, Layer, Path, Point, Style};
use crate::tokens::Token;
use crate::view::{Frame, Wheel};

/// Thickness of the strip behind the teeth, mm.
const BACK: f64 = 2.2;
/// Fewer teeth are not drawn.
const FEWEST_TEETH: u32 = 5;
/// More teeth than this are left out.
const MOST_TEETH: f64 = 400.0;

pub(super) fn parts(context: &Context, link: usize, pinion: Wheel, side: f64) -> Option<Part> {
    let frame = context.reference?;
    let first = *context.view.links.get(link)?.points.first()?;
    let center = local(context, frame, link, first, pinion.center)?;
    let side = if side < 0.0 { -1.0 } else { 1.0 };
    let radius = pinion.radius.abs() * context.fit.scale;
    let along = context
        .frames
        .iter()
        .filter_map(|f| local(context, f, link, first, pinion.center))
        .map(|p| p[0]);
    let (low, high) = along.fold((center[0], center[0]), |(low, high), x| {
        (low.min(x), high.max(x))
    });
    // Without teeth there is no pitch: a strip along the way.
    let pitch = match pinion.teeth {
        FEWEST_TEETH.. => 2.0 * PI * radius / f64::from(pinion.teeth),
        _ => 0.0,
    };
    let (x0, x1) = (low - 6.0 - pitch, high + 6.0 + pitch);
    let pitch_line = center[1] - side * radius;
    let module = pitch / PI;
    let has_teeth = module > 0.45 && (x1 - x0) / pitch < MOST_TEETH;
    // teeth that are not drawn one by one: their tips, beside the pitch line (ISO 2203)
    let height = match (has_teeth, pinion.teeth) {
        (true, _) => module,
        (false, FEWEST_TEETH..) => module.min(gear::tip_height(radius)),
        (false, _) => gear::tip_height(radius),
    };
    let back = pitch_line - side * (1.2 * height + BACK);
    let mut points: Vec<Point> = vec![[x1, back], [x0, back]];
    if has_teeth {
        let root = pitch_line - side * 1.2 * module;
        points.push([x0, root]);
        // a tooth of the rack stands half a pitch beside the pinion's tooth nearest to the contact
        let contact = link_angle(frame, link)? - side * PI / 2.0;
        let past =
            (contact - link_angle(frame, pinion.link)?) * f64::from(pinion.teeth) / (2.0 * PI);
        let tooth = center[0] - side * (past - past.floor()) * pitch + pitch / 2.0;
        let first_tooth = ((x0 - tooth) / pitch).ceil() as i64;
        let last_tooth = ((x1 - tooth) / pitch).floor() as i64;
        for k in first_tooth..=last_tooth {
            let x = tooth + k as f64 * pitch;
            for (at, height) in [(-0.36, -1.2), (-0.13, 1.0), (0.13, 1.0), (0.36, -1.2)] {
                points.push([
                    (x + at * pitch).clamp(x0, x1),
                    pitch_line + side * height * module,
                ]);
            }
        }
        points.push([x1, root]);
    } else {
        let tips = pitch_line + side * height;
        points.extend([[x0, tips], [x1, tips]]);
    }
    let token = link_token(link);
    let style = Style::stroke(token, 0.45).filled(token, 0.16);
    let line = Path::polyline(&[[x0, pitch_line], [x1, pitch_line]]);
    // the bar of its own link does not show through, but the pinion's teeth do
    let root = pitch_line - side * 1.2 * height;
    let strip = Path::rectangle([x0, back.min(root)], [x1, back.max(root)], 0.0);
    let items = vec![
        Item::path(strip, Style::fill(Token::Background)),
        Item::path(Path::polygon(&points), style),
        Item::path(line, Style::stroke(token, 0.25).dashed(&gear::PITCH_LINE)),
    ];
    let layer = if link == 0 {
        Layer::Ground
    } else {
        Layer::Body
    };
    Some(Part::new(layer, Anchor::On(first, link, 0.0), items))
}

/// A point in the axes of a link in a pose, mm from one of the link's points.
fn local(
    context: &Context,
    frame: &Frame,
    link: usize,
    origin: usize,
    index: usize,
) -> Option<Point> {
    let (a, b) = (context.paper(frame, origin)?, context.paper(frame, index)?);
    let (s, c) = sin_cos(link_angle(frame, link)?);
    let (x, y) = (b[0] - a[0], b[1] - a[1]);
    Some([c * x + s * y, c * y - s * x])
}
