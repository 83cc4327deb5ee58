//! Moving pictures: animated GIF and PNG of a mechanism over its poses.

use super::{Canvas, RasterError, palette};
use crate::stage::Stage;
use crate::tokens::Theme;

/// Most pictures in an animation.
pub const MOST_PICTURES: usize = 600;
/// Most pixels of all pictures together.
const MOST_PIXELS: u64 = 400_000_000;

/// How an animation is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnimationOptions {
    /// Width, pixels.
    pub width: u32,
    /// Most pictures; poses are left out evenly. At most [`MOST_PICTURES`].
    pub pictures: usize,
    /// How long one pass over the poses takes, s.
    pub period: f64,
    /// Forth and back instead of starting again.
    pub ping_pong: bool,
    /// Colours.
    pub theme: Theme,
}

impl Default for AnimationOptions {
    /// 640 pixels wide, 72 pictures in 3.6 s: 20 a second, which every viewer shows smoothly.
    fn default() -> Self {
        AnimationOptions {
            width: 640,
            pictures: 72,
            period: 3.6,
            ping_pong: false,
            theme: Theme::Light,
        }
    }
}

/// The part of a picture that differs from the one before it, as palette indices.
struct Change {
    left: u32,
    top: u32,
    width: u32,
    height: u32,
    indices: Vec<u8>,
}

struct Film {
    width: u32,
    height: u32,
    colors: Vec<[u8; 3]>,
    changes: Vec<Change>,
    /// How long each picture stays, in hundredths of a second.
    delay: u16,
}

/// An animated GIF of the poses.
///
/// # Errors
/// [`RasterError::NoFrames`] without a pose, [`RasterError::TooLarge`] above 400 million pixels in all.
pub fn gif(stage: &Stage, options: &AnimationOptions) -> Result<Vec<u8>, RasterError> {
    let film = Film::new(stage, options)?;
    let mut flat: Vec<u8> = film.colors.iter().flatten().copied().collect();
    flat.resize(3 * (usize::from(palette::UNCHANGED) + 1), 0);
    let (width, height) = (
        film.width.min(65_535) as u16,
        film.height.min(65_535) as u16,
    );
    let encode = || -> Result<Vec<u8>, gif::EncodingError> {
        let mut bytes = Vec::new();
        let mut encoder = gif::Encoder::new(&mut bytes, width, height, &flat)?;
        encoder.set_repeat(gif::Repeat::Infinite)?;
        for change in &film.changes {
            let frame = gif::Frame {
                delay: film.delay,
                dispose: gif::DisposalMethod::Keep,
                transparent: Some(palette::UNCHANGED),
                left: change.left as u16,
                top: change.top as u16,
                width: change.width as u16,
                height: change.height as u16,
                buffer: change.indices.as_slice().into(),
                ..gif::Frame::default()
            };
            encoder.write_frame(&frame)?;
        }
        drop(encoder);
        Ok(bytes)
    };
    encode().map_err(|error| RasterError::Encode(error.to_string()))
}

/// An animated PNG of the poses. Viewers that know no animation show the first.
///
/// # Errors
/// As [`gif()`].
pub fn apng(stage: &Stage, options: &AnimationOptions) -> Result<Vec<u8>, RasterError> {
    let film = Film::new(stage, options)?;
    let mut colors: Vec<u8> = film.colors.iter().flatten().copied().collect();
    let mut alpha = vec![255_u8; film.colors.len()];
    while alpha.len() <= usize::from(palette::UNCHANGED) {
        colors.extend([0, 0, 0]);
        alpha.push(0);
    }
    let encode = || -> Result<Vec<u8>, png::EncodingError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, film.width, film.height);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_palette(colors);
        encoder.set_trns(alpha);
        encoder.set_compression(png::Compression::High);
        encoder.set_animated(film.changes.len() as u32, 0)?;
        encoder.set_frame_delay(film.delay, 100)?;
        let mut writer = encoder.write_header()?;
        for (number, change) in film.changes.iter().enumerate() {
            if number > 0 {
                writer.set_blend_op(png::BlendOp::Over)?;
                writer.reset_frame_position()?;
                writer.set_frame_dimension(change.width, change.height)?;
                writer.set_frame_position(change.left, change.top)?;
            }
            writer.write_image_data(&change.indices)?;
        }
        writer.finish()?;
        Ok(bytes)
    };
    encode().map_err(|error| RasterError::Encode(error.to_string()))
}

impl Film {
    fn new(stage: &Stage, options: &AnimationOptions) -> Result<Film, RasterError> {
        let shown = shown(stage.len(), options);
        if shown.is_empty() {
            return Err(RasterError::NoFrames);
        }
        let [mm_wide, mm_high] = stage.size();
        let density = f64::from(options.width.clamp(16, 8000)) / mm_wide;
        let each = (mm_wide * density).ceil() * (mm_high * density).ceil();
        if each * shown.len() as f64 > MOST_PIXELS as f64 {
            let height = (mm_high * density) as u64 * shown.len() as u64;
            return Err(RasterError::TooLarge {
                width: u64::from(options.width),
                height,
                limit: MOST_PIXELS,
            });
        }
        let draw = |&index: &usize| Canvas::draw(&stage.scene(index), options.theme, density);
        let pictures: Vec<Canvas> = shown.iter().map(draw).collect::<Result<_, _>>()?;
        let palette = palette::Palette::of(pictures.iter().map(|p| p.rgb.as_slice()));
        let (width, height) = (pictures[0].width, pictures[0].height);
        let mut before: Option<Vec<u8>> = None;
        let mut changes = Vec::with_capacity(pictures.len());
        for picture in &pictures {
            let indices = palette.indices(&picture.rgb);
            changes.push(change(before.as_deref(), &indices, width, height));
            before = Some(indices);
        }
        let passes = if options.ping_pong { 2.0 } else { 1.0 };
        let seconds = if options.period.is_finite() {
            options.period.clamp(0.1, 600.0) * passes
        } else {
            3.6
        };
        let delay = (100.0 * seconds / shown.len() as f64)
            .round()
            .clamp(2.0, 60_000.0) as u16;
        Ok(Film {
            width,
            height,
            colors: palette.colors,
            changes,
            delay,
        })
    }
}

/// The poses to show, in order.
fn shown(frames: usize, options: &AnimationOptions) -> Vec<usize> {
    let limit = options.pictures.clamp(1, MOST_PICTURES);
    let most = if options.ping_pong {
        limit / 2 + 1
    } else {
        limit
    };
    let count = frames.min(most);
    let spread = |k: usize| {
        if count < 2 {
            0
        } else {
            (k * (frames - 1) + (count - 1) / 2) / (count - 1)
        }
    };
    let mut shown: Vec<usize> = (0..count).map(spread).collect();
    if options.ping_pong && count > 2 {
        shown.extend((1..count - 1).rev().map(spread));
    }
    shown
}

/// The smallest rectangle that changed, with unchanged pixels marked; one pixel when nothing did.
fn change(before: Option<&[u8]>, now: &[u8], width: u32, height: u32) -> Change {
    let Some(before) = before else {
        return Change {
            left: 0,
            top: 0,
            width,
            height,
            indices: now.to_vec(),
        };
    };
    let w = width as usize;
    let (mut x0, mut x1, mut y0, mut y1) = (w, 0, height as usize, 0);
    for (k, _) in now
        .iter()
        .zip(before)
        .enumerate()
        .filter(|(_, (a, b))| a != b)
    {
        let (x, y) = (k % w, k / w);
        (x0, x1) = (x0.min(x), x1.max(x));
        (y0, y1) = (y0.min(y), y1.max(y));
    }
    if x0 > x1 {
        (x0, x1, y0, y1) = (0, 0, 0, 0);
    }
    let pixel = |k: usize| {
        if now[k] == before[k] {
            palette::UNCHANGED
        } else {
            now[k]
        }
    };
    let indices = (y0..=y1)
        .flat_map(|y| (x0..=x1).map(move |x| pixel(y * w + x)))
        .collect();
    Change {
        left: x0 as u32,
        top: y0 as u32,
        width: (x1 - x0 + 1) as u32,
        height: (y1 - y0 + 1) as u32,
        indices,
    }
}
