//! Outlines of letters from the font that the crate carries, so that no system font is asked for:
//! DejaVu Sans Condensed (licence of Bitstream Vera, changes in the public domain).

use std::sync::OnceLock;

use tiny_skia::{Path, PathBuilder, Transform};
use ttf_parser::{Face, OutlineBuilder};

/// The font, deflated by the build script.
const STORED: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/font.deflate"));

fn face() -> Option<&'static Face<'static>> {
    static FONT: OnceLock<Vec<u8>> = OnceLock::new();
    static FACE: OnceLock<Option<Face<'static>>> = OnceLock::new();
    let font =
        FONT.get_or_init(|| miniz_oxide::inflate::decompress_to_vec(STORED).unwrap_or_default());
    FACE.get_or_init(|| Face::parse(font, 0).ok()).as_ref()
}

struct Pen<'a> {
    builder: &'a mut PathBuilder,
    x: f32,
}

impl OutlineBuilder for Pen<'_> {
    fn move_to(&mut self, x: f32, y: f32) {
        self.builder.move_to(self.x + x, y);
    }
    fn line_to(&mut self, x: f32, y: f32) {
        self.builder.line_to(self.x + x, y);
    }
    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.builder.quad_to(self.x + x1, y1, self.x + x, y);
    }
    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.builder
            .cubic_to(self.x + x1, y1, self.x + x2, y2, self.x + x, y);
    }
    fn close(&mut self) {
        self.builder.close();
    }
}

/// The outline of a line of text of size 1, y up, its base line starting at the origin, and its width.
pub(super) fn outline(text: &str) -> Option<(Path, f32)> {
    let face = face()?;
    let mut builder = PathBuilder::new();
    let mut x = 0.0_f32;
    for c in text.chars().take(1000) {
        let Some(glyph) = face.glyph_index(c).or_else(|| face.glyph_index('\u{fffd}')) else {
            continue;
        };
        face.outline_glyph(
            glyph,
            &mut Pen {
                builder: &mut builder,
                x,
            },
        );
        x += f32::from(face.glyph_hor_advance(glyph).unwrap_or(0));
    }
    let em = 1.0 / f32::from(face.units_per_em().max(1));
    let path = builder.finish()?.transform(Transform::from_scale(em, em))?;
    Some((path, x * em))
}
