//! Scale bar, title and caption of a drawing.

use crate::scene::{Align, Group, Item, Layer, Path, Style, Text};
use crate::stage::Stage;
use crate::symbols::outline_style;
use crate::text::shortened;
use crate::tokens::Token;
use crate::view::Frame;
use kempe_number::text::{decade, power_of_ten, significant};

/// About how long a scale bar is, as a share of the sheet's width.
const BAR_SHARE: f64 = 0.22;

pub(crate) fn groups(stage: &Stage, frame: Option<&Frame>) -> Vec<Group> {
    let [width, height] = stage.size();
    let mut furniture = Vec::new();
    let mut caption = Vec::new();
    if stage.options.scale_bar {
        furniture.extend(scale_bar(stage));
    }
    if stage.options.title {
        let title = shortened(&stage.context.view.title, 4.6, width - 12.0);
        caption.push(Item::Text(Text {
            bold: true,
            ..Text::new([6.0, height - 8.5], 4.6, title)
        }));
    }
    if let (true, Some(other)) = (stage.options.title, &stage.other) {
        let [x, y] = [6.0, height - 13.0];
        let line = Path::polyline(&[[x, y + 1.0], [x + 9.0, y + 1.0]]);
        caption.push(Item::path(line, outline_style()));
        let name = shortened(other.name, 3.2, width - 24.0);
        caption.push(Item::Text(
            Text::new([x + 11.0, y], 3.2, name).colored(Token::Muted),
        ));
    }
    if let (true, Some(frame)) = (stage.options.caption, frame) {
        let label = shortened(&frame.label, 3.4, width * 0.6);
        let text = Text::new([width - 6.0, 5.0], 3.4, label)
            .aligned(Align::End)
            .colored(Token::Muted);
        caption.push(Item::Text(text));
    }
    vec![
        Group::new(Layer::Furniture, furniture),
        Group::new(Layer::Caption, caption),
    ]
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
