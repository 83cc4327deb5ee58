//! The field's drawing symbols (after ISO 3952): each file draws one. Symbols keep their size on paper, bars scale.

mod belt;
mod curved_slot;
mod cylinder;
mod drive;
mod gear;
mod ground;
mod link;
mod part;
mod pin;
mod rack;
mod slider;
mod smooth_slot;
mod spring;
mod weld;

pub(crate) use part::{PIN, Part, link_token};

use crate::context::Context;
use crate::scene::{Item, Style};
use crate::tokens::Token;
use crate::view::JointView;

/// All parts of a mechanism but its labels.
pub(crate) fn parts(context: &Context) -> Vec<Part> {
    let mut parts = Vec::new();
    parts.extend(gear::parts(context));
    parts.extend(link::parts(context));
    for joint in &context.view.joints {
        match *joint {
            JointView::Slider { block, at, guide } => {
                parts.extend(slider::slider(context, block, at, guide))
            }
            JointView::Slot { pin, guide } => parts.extend(slider::slot(context, pin, guide)),
            JointView::ArcSlot { arc, .. } => parts.extend(curved_slot::parts(context, arc)),
            JointView::CurveSlot { ref curve, .. } => {
                parts.extend(smooth_slot::parts(context, curve))
            }
            JointView::Belt {
                a,
                b,
                crossed,
                chain,
            } => parts.extend(belt::parts(context, [a, b], crossed, chain)),
            JointView::Weld { at, links } => parts.extend(weld::parts(context, at, links)),
            JointView::Rack { link, pinion, side } => {
                parts.extend(rack::parts(context, link, pinion, side))
            }
            JointView::Cylinder { a, b } => parts.extend(cylinder::cylinder(context, a, b)),
            JointView::Damper { a, b } => parts.extend(cylinder::damper(context, a, b)),
            JointView::Spring { a, b } => parts.extend(spring::parts(context, a, b)),
            JointView::Gears { .. } => {}
        }
    }
    parts.extend(pin::parts(context));
    parts.extend(drive::parts(context));
    parts
}

/// An item as it looks in a ghost pose: a faint outline.
pub(crate) fn ghost_item(item: &Item) -> Item {
    restyled(item, |style| Style {
        fill: None,
        stroke: style
            .stroke
            .or(style.fill)
            .map(|paint| crate::scene::Paint {
                alpha: 0.3,
                ..paint
            }),
        width: 0.3,
        dash: style.dash.clone(),
    })
}

/// How another design is drawn.
pub(crate) fn outline_style() -> Style {
    Style::stroke(Token::Muted, 0.4).dashed(&[1.5, 0.9])
}

/// An item as it looks in another design: a thin dashed outline, but for circles, which are too small for dashes.
pub(crate) fn outlined_item(item: &Item) -> Item {
    let small = matches!(item, Item::Circle { radius, .. } if *radius < SMALL_CIRCLE);
    restyled(item, |_| match small {
        true => Style::stroke(Token::Muted, 0.3),
        false => outline_style(),
    })
}

/// A circle of a smaller radius has no room for dashes, mm.
const SMALL_CIRCLE: f64 = 3.0;

fn restyled(item: &Item, change: impl Fn(&Style) -> Style) -> Item {
    match item {
        Item::Shape { paths, style } => Item::Shape {
            paths: paths.clone(),
            style: change(style),
        },
        Item::Circle {
            center,
            radius,
            style,
        } => Item::Circle {
            center: *center,
            radius: *radius,
            style: change(style),
        },
        Item::Text(text) => Item::Text(text.clone()),
    }
}
