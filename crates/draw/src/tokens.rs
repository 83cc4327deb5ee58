//! Colour tokens: the one place where colours are written. Okabe-Ito for links, so that they stay apart for
//! colour-blind readers; light and dark values for every token.

use crate::loads::LoadRole;

/// A colour by its meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Token {
    /// The paper.
    Background,
    /// Panels on the paper.
    Panel,
    /// Text and outlines.
    Ink,
    /// Secondary text.
    Muted,
    /// Grid lines and borders.
    Grid,
    /// The frame: ground symbols, hatching, guides.
    Ground,
    /// The face of a pin.
    Pin,
    /// A link or a curve by its number; they repeat after six.
    Series(usize),
    /// What is moved from outside.
    Drive,
    /// A force or a moment by what it comes from.
    Load(LoadRole),
    /// The velocity of a point.
    Velocity,
    /// The acceleration of a point.
    Acceleration,
    /// Something wrong: a gap, a row not reached.
    Error,
    /// Something to look at: a dead point, a change point.
    Warning,
    /// Where bodies touch or strike each other.
    Contact,
    /// The playhead and the control that has the focus.
    Accent,
}

/// Which set of colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Theme {
    /// Dark on white.
    #[default]
    Light,
    /// Light on near-black.
    Dark,
    /// CSS custom properties of the page that holds the picture (see [`css`]).
    Page,
}

const SERIES_LIGHT: [u32; 6] = [0x0072B2, 0xE69F00, 0x009E73, 0xCC79A7, 0x56B4E9, 0xD55E00];
const SERIES_DARK: [u32; 6] = [0x4BA3E3, 0xF0B429, 0x2FC49A, 0xE29AC4, 0x8CCDF5, 0xF07B3A];

/// Light and dark, in the order of [`LoadRole::ALL`].
const LOADS: [(u32, u32); 6] = [
    (0xB3202A, 0xFF8A8A),
    (0x1F55B5, 0x86B4FF),
    (0x6B4E16, 0xDDBB74),
    (0xC2410C, 0xFF9A5C),
    (0x17703A, 0x62D494),
    (0x7B3FA0, 0xD5A8F2),
];

const PLAIN: [Token; 14] = [
    Token::Background,
    Token::Panel,
    Token::Ink,
    Token::Muted,
    Token::Grid,
    Token::Ground,
    Token::Pin,
    Token::Drive,
    Token::Velocity,
    Token::Acceleration,
    Token::Error,
    Token::Warning,
    Token::Contact,
    Token::Accent,
];

impl Token {
    /// The colour as 0xRRGGBB; `dark` picks the set for a dark page.
    pub fn rgb(self, dark: bool) -> u32 {
        let (light_value, dark_value) = match self {
            Token::Background => (0xFFFFFF, 0x12161B),
            Token::Panel => (0xF6F7F9, 0x1A2027),
            Token::Ink => (0x1A1F24, 0xE8ECF0),
            Token::Muted => (0x59626D, 0xA2ACB8),
            Token::Grid => (0xDDE1E6, 0x313A44),
            Token::Ground => (0x5B6470, 0x97A3B1),
            Token::Pin => (0xFFFFFF, 0x12161B),
            Token::Series(index) => (SERIES_LIGHT[index % 6], SERIES_DARK[index % 6]),
            Token::Drive => (0xC2410C, 0xFF9A5C),
            Token::Load(role) => LOADS[role.index()],
            Token::Velocity => (0x0B7285, 0x5FD3E8),
            Token::Acceleration => (0xA61E8C, 0xF0A6E4),
            Token::Error => (0xC92A2A, 0xFF8787),
            Token::Warning => (0x9A5B00, 0xF2C14E),
            Token::Contact => (0xC2255C, 0xFF8FB8),
            Token::Accent => (0x1F6FEB, 0x6CA8FF),
        };
        if dark { dark_value } else { light_value }
    }

    /// Name of the CSS custom property, without the dashes.
    pub fn name(self) -> String {
        match self {
            Token::Series(index) => format!("series-{}", index % 6 + 1),
            Token::Background => "background".into(),
            Token::Panel => "panel".into(),
            Token::Ink => "ink".into(),
            Token::Muted => "muted".into(),
            Token::Grid => "grid".into(),
            Token::Ground => "ground".into(),
            Token::Pin => "pin".into(),
            Token::Drive => "drive".into(),
            Token::Load(role) => format!("load-{}", role.name()),
            Token::Velocity => "velocity".into(),
            Token::Acceleration => "acceleration".into(),
            Token::Error => "error".into(),
            Token::Warning => "warning".into(),
            Token::Contact => "contact".into(),
            Token::Accent => "accent".into(),
        }
    }

    /// The colour as SVG and CSS write it.
    pub fn css(self, theme: Theme) -> String {
        match theme {
            Theme::Page => format!("var(--{})", self.name()),
            _ => format!("#{:06x}", self.rgb(theme == Theme::Dark)),
        }
    }
}

/// All tokens as CSS custom properties, for `:root` of a page: light, or dark.
pub fn css(dark: bool) -> String {
    let all = PLAIN.into_iter().chain((0..6).map(Token::Series));
    let all = all.chain(LoadRole::ALL.into_iter().map(Token::Load));
    all.map(|token| format!("--{}:#{:06x};", token.name(), token.rgb(dark)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn luminance(rgb: u32) -> f64 {
        let channel = |shift: u32| {
            let c = f64::from((rgb >> shift) & 255) / 255.0;
            if c <= 0.03928 {
                c / 12.92
            } else {
                kempe_number::math::exp(2.4 * kempe_number::math::ln((c + 0.055) / 1.055))
            }
        };
        0.2126 * channel(16) + 0.7152 * channel(8) + 0.0722 * channel(0)
    }

    #[test]
    fn text_tokens_have_contrast_4_5_on_both_papers() {
        for dark in [false, true] {
            for paper in [Token::Background, Token::Panel] {
                let plain = [
                    Token::Ink,
                    Token::Muted,
                    Token::Drive,
                    Token::Velocity,
                    Token::Acceleration,
                    Token::Error,
                    Token::Warning,
                    Token::Contact,
                    Token::Ground,
                ];
                let loads = LoadRole::ALL.map(Token::Load);
                for text in plain.into_iter().chain(loads) {
                    let (a, b) = (luminance(text.rgb(dark)), luminance(paper.rgb(dark)));
                    let ratio = (a.max(b) + 0.05) / (a.min(b) + 0.05);
                    assert!(ratio >= 4.5, "{text:?} on {paper:?}: {ratio}");
                }
            }
        }
    }
}
