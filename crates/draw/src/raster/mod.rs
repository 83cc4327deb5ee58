//! Pixels: the same scenes as PNG, GIF and APNG.

pub mod animation;
mod canvas;
mod error;
mod font;
mod palette;

use crate::scene::Scene;
use crate::tokens::Theme;

pub use canvas::Canvas;
pub use error::RasterError;

/// A PNG file of a scene at a resolution in dots per inch.
///
/// # Errors
/// [`RasterError::TooLarge`] above 64 million pixels.
pub fn png(scene: &Scene, theme: Theme, dpi: f64) -> Result<Vec<u8>, RasterError> {
    let canvas = Canvas::draw(scene, theme, dpi / 25.4)?;
    let encode = || -> Result<Vec<u8>, png::EncodingError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, canvas.width, canvas.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::Balanced);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&canvas.rgb)?;
        writer.finish()?;
        Ok(bytes)
    };
    encode().map_err(|error| RasterError::Encode(error.to_string()))
}

/// Width of a line of text of size 1 in the font of the pictures.
#[cfg(test)]
pub(crate) fn text_width(text: &str) -> Option<f64> {
    font::outline(text).map(|(_, width)| f64::from(width))
}
