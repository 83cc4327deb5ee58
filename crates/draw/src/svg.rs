//! Scenes as SVG text. Sizes in mm; the same scene gives the same bytes.

use std::fmt::Write as _;

use crate::escape::escape;
use crate::scene::{
    Align, Group, Item, Paint, Path, Placement, Point, Scene, Style, Text, distance,
};
use crate::tokens::{Theme, Token};
use kempe_number::text::fixed;

/// Fonts to try, in order.
const FONTS: &str =
    "system-ui, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, 'Liberation Sans', sans-serif";

/// A whole SVG file: paper, title for readers who cannot see it, and the drawing.
pub fn document(scene: &Scene, theme: Theme) -> String {
    let (w, h) = (fixed(scene.width, 3), fixed(scene.height, 3));
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}mm\" height=\"{h}mm\" viewBox=\"0 0 {w} {h}\" \
         role=\"img\" font-family=\"{FONTS}\">\n<title>{}</title>\n<rect width=\"{w}\" height=\"{h}\" fill=\"{}\"/>\n",
        escape(&scene.title),
        Token::Background.css(theme),
    );
    out.push_str(&groups(scene, theme));
    out.push_str("</svg>\n");
    out
}

/// An `svg` element for a page that sets fonts, and colours by [`crate::tokens::css`]. `attributes` go into its tag.
pub fn element(scene: &Scene, attributes: &str) -> String {
    let (w, h) = (fixed(scene.width, 3), fixed(scene.height, 3));
    format!(
        "<svg viewBox=\"0 0 {w} {h}\" role=\"img\" aria-label=\"{}\" {attributes}>\n{}</svg>\n",
        escape(&scene.title),
        groups(scene, Theme::Page)
    )
}

fn groups(scene: &Scene, theme: Theme) -> String {
    let mut out = String::new();
    for group in &scene.groups {
        write_group(&mut out, group, scene.height, theme);
    }
    out
}

fn write_group(out: &mut String, group: &Group, height: f64, theme: Theme) {
    if group.items.is_empty() {
        return;
    }
    let _ = write!(out, "<g class=\"{}\"", group.layer.name());
    if let Some(key) = &group.key {
        let _ = write!(out, " data-part=\"{}\"", escape(key));
    }
    let moved = group.place != Placement::PAPER;
    if moved {
        let [x, y] = group.place.at;
        let _ = write!(
            out,
            " transform=\"translate({} {})",
            fixed(x, 3),
            fixed(height - y, 3)
        );
        let turn = fixed(-group.place.angle.to_degrees() % 360.0, 3);
        if turn != "0" {
            let _ = write!(out, " rotate({turn})");
        }
        out.push('"');
    }
    out.push_str(">\n");
    // inside a moved group, y counts from the group's own origin
    let view = View {
        base: if moved { 0.0 } else { height },
        stretch: group.place.stretch,
        theme,
    };
    for item in &group.items {
        view.item(out, item);
    }
    out.push_str("</g>\n");
}

struct View {
    base: f64,
    stretch: f64,
    theme: Theme,
}

impl View {
    fn at(&self, p: Point) -> String {
        format!(
            "{} {}",
            fixed(p[0] * self.stretch, 3),
            fixed(self.base - p[1], 3)
        )
    }

    fn item(&self, out: &mut String, item: &Item) {
        match item {
            Item::Shape { paths, style } => {
                let data: String = paths.iter().map(|path| self.path(path)).collect();
                if !data.is_empty() {
                    let _ = writeln!(out, "<path d=\"{data}\"{}/>", self.style(style));
                }
            }
            Item::Circle {
                center,
                radius,
                style,
            } => {
                let (x, y) = (
                    fixed(center[0] * self.stretch, 3),
                    fixed(self.base - center[1], 3),
                );
                let _ = writeln!(
                    out,
                    "<circle cx=\"{x}\" cy=\"{y}\" r=\"{}\"{}/>",
                    fixed(radius.max(0.0), 3),
                    self.style(style)
                );
            }
            Item::Text(text) => self.text(out, text),
        }
    }

    fn path(&self, path: &Path) -> String {
        let Some(first) = path.vertices.first() else {
            return String::new();
        };
        let mut data = format!("M{}", self.at(first.at));
        for (from, to, bulge) in path.segments() {
            let chord = distance(from, to);
            if bulge.abs() > 1e-9 && chord > 0.0 {
                let radius = fixed(chord * (1.0 + bulge * bulge) / (4.0 * bulge.abs()), 3);
                let (large, sweep) = (u8::from(bulge.abs() > 1.0), u8::from(bulge < 0.0));
                let _ = write!(data, "A{radius} {radius} 0 {large} {sweep} {}", self.at(to));
            } else {
                let _ = write!(data, "L{}", self.at(to));
            }
        }
        if path.closed {
            data.push('Z');
        }
        data
    }

    fn style(&self, style: &Style) -> String {
        let mut out = String::new();
        match style.fill {
            Some(paint) => out.push_str(&self.paint("fill", paint)),
            None => out.push_str(" fill=\"none\""),
        }
        if style.fill.is_some() {
            out.push_str(" fill-rule=\"evenodd\"");
        }
        if let Some(paint) = style.stroke {
            out.push_str(&self.paint("stroke", paint));
            let _ = write!(out, " stroke-width=\"{}\"", fixed(style.width, 3));
            out.push_str(" stroke-linecap=\"round\" stroke-linejoin=\"round\"");
            if !style.dash.is_empty() {
                let dash: Vec<String> = style.dash.iter().map(|d| fixed(*d, 3)).collect();
                let _ = write!(out, " stroke-dasharray=\"{}\"", dash.join(" "));
            }
        }
        out
    }

    fn paint(&self, attribute: &str, paint: Paint) -> String {
        let mut out = format!(" {attribute}=\"{}\"", paint.token.css(self.theme));
        if paint.alpha < 1.0 {
            let _ = write!(
                out,
                " {attribute}-opacity=\"{}\"",
                fixed(paint.alpha.max(0.0), 3)
            );
        }
        out
    }

    fn text(&self, out: &mut String, text: &Text) {
        let (x, y) = (
            fixed(text.at[0] * self.stretch, 3),
            fixed(self.base - text.at[1], 3),
        );
        let _ = write!(
            out,
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\"",
            fixed(text.size, 3)
        );
        out.push_str(match text.align {
            Align::Start => "",
            Align::Middle => " text-anchor=\"middle\"",
            Align::End => " text-anchor=\"end\"",
        });
        if text.bold {
            out.push_str(" font-weight=\"600\"");
        }
        out.push_str(&self.paint("fill", text.paint));
        if text.halo {
            let paper = Token::Background.css(self.theme);
            let _ = write!(
                out,
                " stroke=\"{paper}\" stroke-width=\"{}\" stroke-linejoin=\"round\" paint-order=\"stroke\"",
                fixed(text.size * 0.28, 3)
            );
        }
        let turn = fixed(-text.turn, 3);
        if turn != "0" {
            let _ = write!(out, " transform=\"rotate({turn} {x} {y})\"");
        }
        let _ = writeln!(out, ">{}</text>", escape(&text.content));
    }
}
