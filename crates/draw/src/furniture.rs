//! Scale bar, title and caption of a drawing.

use crate::scene::{Align, Group, Item, Layer, Path, Style, Text};
use crate::stage::Stage;
use crate::symbols::outline_style;
use crate::text::{shortened, width};
use crate::tokens::Token;
use crate::view::Frame;
use kempe_number::text::{decade, power_of_ten, significant};

/// About how long a scale bar is, as a share of the sheet's width.
const BAR_SHARE: f64 = 0.22;
/// Font size of the caption, mm, and the longest line of it, as a share of the sheet's width.
const CAPTION: f64 = 3.4;
const CAPTION_SHARE: f64 = 0.58;

pub(crate) fn groups(stage: &Stage, frame: Option<&Frame>) -> Vec<Group> {
    let [wide, height] = stage.size();
    let mut furniture = Vec::new();
    let mut caption = Vec::new();
    if stage.options.scale_bar {
        furniture.extend(scale_bar(stage));
    }
    if stage.options.title {
        let title = shortened(&stage.context.view.title, 4.6, wide - 12.0);
        caption.push(Item::Text(Text {
            bold: true,
            ..Text::new([6.0, height - 8.5], 4.6, title)
        }));
    }
    if let (true, Some(other)) = (stage.options.title, &stage.other) {
        let [x, y] = [6.0, height - 13.0];
        let line = Path::polyline(&[[x, y + 1.0], [x + 9.0, y + 1.0]]);
        caption.push(Item::path(line, outline_style()));
        let name = shortened(other.name, 3.2, wide - 24.0);
        caption.push(Item::Text(
            Text::new([x + 11.0, y], 3.2, name).colored(Token::Muted),
        ));
    }
    if let (true, Some(frame)) = (stage.options.caption, frame) {
        let lines = broken(&frame.label, wide * CAPTION_SHARE);
        let bases: &[f64] = if lines.len() > 1 { &[7.0, 2.2] } else { &[5.0] };
        for (line, base) in lines.into_iter().zip(bases) {
            let text = Text::new([wide - 6.0, *base], CAPTION, line)
                .aligned(Align::End)
                .colored(Token::Muted);
            caption.push(Item::Text(text));
        }
    }
    vec![
        Group::new(Layer::Furniture, furniture),
        Group::new(Layer::Caption, caption),
    ]
}

/// A caption in one line, or in two where it is longer than `room` and tells several things.
fn broken(label: &str, room: f64) -> Vec<String> {
    let whole = width(label, CAPTION) <= room;
    let commas = label.match_indices(", ").map(|(at, _)| at + 1);
    let longer = |at: &usize| {
        let (first, second) = label.split_at(*at);
        width(first, CAPTION).max(width(second, CAPTION))
    };
    let best = commas.min_by(|a, b| longer(a).total_cmp(&longer(b)));
    match best {
        Some(at) if !whole => {
            let (first, second) = label.split_at(at);
            [first, second.trim_start()]
                .map(|line| shortened(line, CAPTION, room))
                .into()
        }
        _ => vec![shortened(label, CAPTION, room)],
    }
}

fn scale_bar(stage: &Stage) -> Vec<Item> {
    let unit = &stage.context.view.length_unit;
    let per_unit = stage.scale() * unit.size();
    let wanted = stage.size()[0] * BAR_SHARE / per_unit;
    if !wanted.is_finite() || wanted <= 0.0 {
        return Vec::new();
    }
    let power = power_of_ten(decade(wanted));
    let length = [5.0, 2.0, 1.0]
        .into_iter()
        .map(|m| m * power)
        .find(|l| *l <= wanted * 1.0001)
        .unwrap_or(power);
    let (x0, y) = (6.0, 4.6);
    let x1 = x0 + length * per_unit;
    let ticks = [x0, (x0 + x1) / 2.0, x1].into_iter().zip([1.6, 1.0, 1.6]);
    let mut paths = vec![Path::polyline(&[[x0, y], [x1, y]])];
    paths.extend(ticks.map(|(x, h)| Path::polyline(&[[x, y], [x, y + h]])));
    let label = format!(
        "{} {}",
        significant(length, 3),
        shortened(&unit.name, 3.2, 24.0)
    );
    vec![
        Item::Shape {
            paths,
            style: Style::stroke(Token::Muted, 0.3),
        },
        Item::Text(Text::new([x1 + 1.8, y], 3.2, label).colored(Token::Muted)),
    ]
}
