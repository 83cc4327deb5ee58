//! Colours and outlines of shapes.

use crate::tokens::Token;

/// A colour with its opacity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paint {
    /// Colour.
    pub token: Token,
    /// Opacity, 0 to 1.
    pub alpha: f64,
}

impl From<Token> for Paint {
    fn from(token: Token) -> Self {
        Paint { token, alpha: 1.0 }
    }
}

/// How a shape is drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Style {
    /// Inside.
    pub fill: Option<Paint>,
    /// Outline.
    pub stroke: Option<Paint>,
    /// Width of the outline, mm.
    pub width: f64,
    /// Dashes and gaps by turns, mm; empty for a solid line.
    pub dash: Vec<f64>,
}

impl Style {
    /// Filled, without outline.
    pub fn fill(token: Token) -> Style {
        Style {
            fill: Some(token.into()),
            ..Style::default()
        }
    }

    /// Outline of the given width in mm, not filled.
    pub fn stroke(token: Token, width: f64) -> Style {
        Style {
            stroke: Some(token.into()),
            width,
            ..Style::default()
        }
    }

    /// The same with an opaque or translucent fill.
    pub fn filled(mut self, token: Token, alpha: f64) -> Style {
        self.fill = Some(Paint { token, alpha });
        self
    }

    /// The same with dashes, mm.
    pub fn dashed(mut self, dash: &[f64]) -> Style {
        self.dash = dash.to_vec();
        self
    }

    /// The same with everything fainter by a factor.
    pub fn faded(mut self, factor: f64) -> Style {
        for paint in [&mut self.fill, &mut self.stroke].into_iter().flatten() {
            paint.alpha *= factor;
        }
        self
    }
}
