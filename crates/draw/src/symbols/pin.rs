//! Pins, ground pivots, multiple joints and points that draw curves.

use super::ground;
use super::part::{LINE, PIN, Part, link_token};
use crate::context::{Anchor, Context};
use crate::scene::{Item, Layer, Path, Style};
use crate::tokens::Token;

/// What a point is drawn as.
enum Look {
    /// A pin with so many rings around it.
    Pin { rings: usize, ground: bool },
    /// A point of one moving link.
    Dot(usize),
    /// A fixed point of reference.
    Cross,
    /// Nothing: another symbol shows it.
    Nothing,
}

pub(super) fn parts(context: &Context) -> Vec<Part> {
    (0..context.view.points.len())
        .flat_map(|index| point_parts(context, index))
        .collect()
}

fn look(context: &Context, index: usize) -> Look {
    let role = context.roles.point(index);
    let ground = role.grounded();
    match (role.carriers.len().saturating_sub(role.welds), role.pinned) {
        (0, _) => Look::Nothing,
        (bodies @ 2.., _) => Look::Pin {
            rings: bodies - 2,
            ground,
        },
        (1, true) => Look::Pin { rings: 0, ground },
        _ if role.welds > 0 || role.slides => Look::Nothing,
        _ if !ground => Look::Dot(role.carriers[0]),
        _ if role.guides => Look::Nothing,
        _ => Look::Cross,
    }
}

fn point_parts(context: &Context, index: usize) -> Vec<Part> {
    let joint = |items| Part::new(Layer::Joint, Anchor::Point(index), items);
    match look(context, index) {
        Look::Nothing => Vec::new(),
        Look::Dot(link) => {
            let rim = Style::stroke(Token::Background, 0.25).filled(link_token(link), 1.0);
            vec![joint(vec![Item::circle([0.0, 0.0], 0.85, rim)])]
        }
        Look::Cross => {
            let paths = vec![
                Path::polyline(&[[-1.2, 0.0], [1.2, 0.0]]),
                Path::polyline(&[[0.0, -1.2], [0.0, 1.2]]),
            ];
            vec![joint(vec![Item::Shape {
                paths,
                style: Style::stroke(Token::Ground, LINE),
            }])]
        }
        Look::Pin { rings, ground } => {
            let style = Style::stroke(Token::Ink, 0.45).filled(Token::Pin, 1.0);
            let ring = |k: usize| Item::circle([0.0, 0.0], PIN + 0.8 * k as f64, style.clone());
            let pin = joint((0..=rings.min(4)).rev().map(ring).collect());
            let foot =
                ground.then(|| Part::new(Layer::Ground, Anchor::Point(index), ground::pedestal()));
            foot.into_iter().chain([pin]).collect()
        }
    }
}
