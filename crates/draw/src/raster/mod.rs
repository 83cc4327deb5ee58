//! Pixels: the same scenes as PNG, GIF and APNG.

pub mod animation;
mod canvas;
mod font;
mod palette;

use crate::scene::Scene;
use crate::tokens::Theme;

pub use canvas::Canvas;

/// Why a picture could not be made.
#[derive(Clone, Debug, PartialEq)]
pub enum RasterError {
    /// The picture would have more pixels than are allowed.
    TooLarge {
        /// Width, pixels.
        width: u64,
        /// Height, pixels.
        height: u64,
        /// Limit.
        limit: u64,
    },
    /// There is no pose to show.
    NoFrames,
    /// The encoder failed.
    Encode(String),
}

impl std::fmt::Display for RasterError {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::TooLarge {
                width,
                height,
                limit,
            } => write!(
                out,
                "a picture of {width} x {height} pixels is larger than the limit of {limit} pixels: lower the resolution"
            ),
            Self::NoFrames => write!(out, "there is no pose to show"),
            Self::Encode(why) => write!(out, "cannot encode the picture: {why}"),
        }
    }
}

impl std::error::Error for RasterError {}

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
