//! Blocks on guides and pins in slots.

use super::ground;
use super::part::{LINE, Part, link_token};
use crate::context::{Anchor, Context};
use crate::scene::{Item, Layer, Path, Style};
use crate::tokens::Token;
use crate::view::Guide;

/// Half the length and half the width of a block, mm.
const BLOCK: [f64; 2] = [4.0, 2.5];
/// Half the width of a slot, mm.
const SLOT: f64 = 1.75;
/// How far a guide goes on past the travel, mm.
const BEYOND: f64 = 2.5;

pub(super) fn slider(context: &Context, block: usize, at: usize, guide: Guide) -> Vec<Part> {
    let (Some(angle), Some((low, high))) = (context.guide_angle(guide), context.travel(guide, at))
    else {
        return Vec::new();
    };
    let (x0, x1) = (low - BLOCK[0] - BEYOND, high + BLOCK[0] + BEYOND);
    let on_guide = Anchor::On(guide.from, guide.link, angle);
    let track = if guide.link == 0 {
        Part::new(
            Layer::Ground,
            on_guide,
            ground::hatched_line(x0, x1, -BLOCK[1], true),
        )
    } else {
        // a moving guide is a rod of its link, from the link's own point to the end of the travel
        let rod = Path::rectangle([x0.min(0.0), -0.8], [x1.max(0.0), 0.8], 0.8);
        let token = link_token(guide.link);
        let style = Style::stroke(token, LINE).filled(token, 0.5);
        Part::new(
            Layer::Link(guide.link),
            on_guide,
            vec![Item::path(rod, style)],
        )
    };
    let outline = Path::rectangle([-BLOCK[0], -BLOCK[1]], BLOCK, 0.7);
    let token = link_token(block);
    let items = vec![
        Item::path(outline.clone(), Style::fill(Token::Background)),
        Item::path(outline, Style::stroke(token, 0.5).filled(token, 0.32)),
    ];
    vec![
        track,
        Part::new(Layer::Body, Anchor::On(at, guide.link, angle), items),
    ]
}

pub(super) fn slot(context: &Context, pin: usize, guide: Guide) -> Vec<Part> {
    let (Some(angle), Some((low, high))) = (context.guide_angle(guide), context.travel(guide, pin))
    else {
        return Vec::new();
    };
    let (x0, x1) = (low - SLOT - 0.4, high + SLOT + 0.4);
    let token = link_token(guide.link);
    let channel = Path::rectangle([x0, -SLOT], [x1, SLOT], SLOT);
    let on_guide = Anchor::On(guide.from, guide.link, angle);
    let mut parts = Vec::new();
    if guide.link == 0 {
        let mut walls = ground::hatched_line(x0, x1, -SLOT - 0.6, true);
        walls.extend(ground::hatched_line(x0, x1, SLOT + 0.6, false));
        parts.push(Part::new(Layer::Ground, on_guide, walls));
    } else {
        // the link reaches around its slot, wherever its named points are
        let cheek = Path::rectangle(
            [x0.min(0.0) - 1.6, -SLOT - 1.6],
            [x1.max(0.0) + 1.6, SLOT + 1.6],
            SLOT + 1.6,
        );
        let style = Style::stroke(token, 0.5).filled(token, 0.2);
        parts.push(Part::new(
            Layer::Link(guide.link),
            on_guide,
            vec![Item::path(cheek, style)],
        ));
    }
    let style = Style::stroke(token, LINE).filled(Token::Background, 1.0);
    let layer = if guide.link == 0 {
        Layer::Ground
    } else {
        Layer::Link(guide.link)
    };
    parts.push(Part::new(layer, on_guide, vec![Item::path(channel, style)]));
    parts
}
