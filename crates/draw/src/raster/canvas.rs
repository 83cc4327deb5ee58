//! A scene drawn into pixels.

use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Paint as Ink, Path as Outline, PathBuilder, Pixmap, Stroke,
    StrokeDash, Transform,
};

use super::error::RasterError;
use super::font;
use crate::scene::{
    Align, Group, Item, Paint, Path, Placement, Point, Scene, Style, Text, arc_points,
};
use crate::tokens::{Theme, Token};

/// Most pixels in a picture.
const MOST_PIXELS: u64 = 64_000_000;

/// Pixels of an opaque picture.
pub struct Canvas {
    /// Width, pixels.
    pub width: u32,
    /// Height, pixels.
    pub height: u32,
    /// Three bytes a pixel, row by row from the top.
    pub rgb: Vec<u8>,
}

impl Canvas {
    /// Draws a scene at so many pixels per mm.
    ///
    /// # Errors
    /// [`RasterError::TooLarge`] above 64 million pixels.
    pub fn draw(scene: &Scene, theme: Theme, density: f64) -> Result<Canvas, RasterError> {
        let pixels = |mm: f64| (mm * density).round().max(1.0) as u64;
        let (width, height) = (pixels(scene.width), pixels(scene.height));
        let too_large = RasterError::TooLarge {
            width,
            height,
            limit: MOST_PIXELS,
        };
        if width.saturating_mul(height) > MOST_PIXELS {
            return Err(too_large);
        }
        let mut pixmap = Pixmap::new(width as u32, height as u32).ok_or(too_large)?;
        let dark = theme == Theme::Dark;
        pixmap.fill(color(Token::Background.into(), dark));
        let mut brush = Brush {
            pixmap: &mut pixmap,
            density,
            height: scene.height,
            dark,
            place: Placement::PAPER,
        };
        for group in &scene.groups {
            brush.group(group);
        }
        let rgb = pixmap
            .data()
            .chunks_exact(4)
            .flat_map(|p| [p[0], p[1], p[2]])
            .collect();
        Ok(Canvas {
            width: width as u32,
            height: height as u32,
            rgb,
        })
    }
}

fn color(paint: Paint, dark: bool) -> Color {
    let rgb = paint.token.rgb(dark);
    let byte = |shift: u32| ((rgb >> shift) & 255) as u8;
    let mut color = Color::from_rgba8(byte(16), byte(8), byte(0), 255);
    color.set_alpha(paint.alpha.clamp(0.0, 1.0) as f32);
    color
}

/// The sides of an arc's polygon stay this near to it, pixels.
const SAGITTA: f64 = 0.05;

struct Brush<'a> {
    pixmap: &'a mut Pixmap,
    density: f64,
    height: f64,
    dark: bool,
    place: Placement,
}

impl Brush<'_> {
    fn group(&mut self, group: &Group) {
        self.place = group.place;
        for item in &group.items {
            match item {
                Item::Shape { paths, style } => {
                    let mut builder = PathBuilder::new();
                    for path in paths {
                        self.add_path(&mut builder, path);
                    }
                    self.shape(builder.finish(), style);
                }
                Item::Circle {
                    center,
                    radius,
                    style,
                } => {
                    let ([x, y], r) = (self.pixel(*center), (radius * self.density) as f32);
                    self.shape(PathBuilder::from_circle(x, y, r), style);
                }
                Item::Text(text) => self.text(text),
            }
        }
    }

    fn pixel(&self, p: Point) -> [f32; 2] {
        let p = self.place.apply(p);
        [
            (p[0] * self.density) as f32,
            ((self.height - p[1]) * self.density) as f32,
        ]
    }

    /// How far a polygon may be from its arc, mm: less than what is seen.
    fn sagitta(&self) -> f64 {
        SAGITTA / self.density
    }

    fn add_path(&self, builder: &mut PathBuilder, path: &Path) {
        let Some(first) = path.vertices.first() else {
            return;
        };
        let [x, y] = self.pixel(first.at);
        builder.move_to(x, y);
        for (from, to, bulge) in path.segments() {
            for p in arc_points(from, to, bulge, self.sagitta()) {
                let [x, y] = self.pixel(p);
                builder.line_to(x, y);
            }
        }
        if path.closed {
            builder.close();
        }
    }

    fn ink(&self, paint: Paint) -> Ink<'static> {
        let mut ink = Ink {
            anti_alias: true,
            ..Ink::default()
        };
        ink.set_color(color(paint, self.dark));
        ink
    }

    fn shape(&mut self, outline: Option<Outline>, style: &Style) {
        let Some(outline) = outline else { return };
        if let Some(paint) = style.fill {
            let ink = self.ink(paint);
            self.pixmap.fill_path(
                &outline,
                &ink,
                FillRule::EvenOdd,
                Transform::identity(),
                None,
            );
        }
        if let Some(paint) = style.stroke {
            let dash: Vec<f32> = style
                .dash
                .iter()
                .map(|d| (d * self.density) as f32)
                .collect();
            let stroke = Stroke {
                width: (style.width * self.density) as f32,
                line_cap: LineCap::Round,
                line_join: LineJoin::Round,
                dash: StrokeDash::new(dash, 0.0),
                ..Stroke::default()
            };
            let ink = self.ink(paint);
            self.pixmap
                .stroke_path(&outline, &ink, &stroke, Transform::identity(), None);
        }
    }

    fn text(&mut self, text: &Text) {
        let Some((outline, width)) = font::outline(&text.content) else {
            return;
        };
        let size = (text.size * self.density) as f32;
        let shift = match text.align {
            Align::Start => 0.0,
            Align::Middle => -width / 2.0,
            Align::End => -width,
        };
        let [x, y] = self.pixel(text.at);
        let turn = (-text.turn - self.place.angle.to_degrees()) as f32;
        let transform = Transform::from_translate(x, y)
            .pre_concat(Transform::from_rotate(turn))
            .pre_scale(size, -size)
            .pre_translate(shift, 0.0);
        let ink = self.ink(text.paint);
        let rim = |width: f32| Stroke {
            width,
            line_join: LineJoin::Round,
            ..Stroke::default()
        };
        if text.halo {
            let paper = self.ink(Token::Background.into());
            self.pixmap
                .stroke_path(&outline, &paper, &rim(0.28), transform, None);
        }
        self.pixmap
            .fill_path(&outline, &ink, FillRule::Winding, transform, None);
        if text.bold {
            self.pixmap
                .stroke_path(&outline, &ink, &rim(0.045), transform, None);
        }
    }
}
