//! Why pixels cannot be made of a scene.

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
