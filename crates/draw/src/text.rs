//! Widths of text without a font at hand, the same on every target: those of the widest of the usual sans-serif fonts, so
//! that what is laid out by them has room in whatever font a reader has.

/// Widths of the characters from the space to the tilde in parts of a thousandth of the font size: the larger of DejaVu Sans
/// and of Arial.
const ASCII: [u16; 95] = [
    318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361, 318, 337, 636, 636, 636,
    636, 636, 636, 636, 636, 636, 636, 337, 337, 838, 838, 838, 556, 1015, 684, 686, 722, 770, 667,
    611, 778, 752, 295, 500, 667, 557, 863, 748, 787, 667, 787, 722, 667, 611, 732, 684, 989, 685,
    667, 685, 390, 337, 390, 838, 556, 500, 613, 635, 550, 635, 615, 352, 635, 634, 278, 278, 579,
    278, 974, 634, 612, 635, 635, 411, 521, 392, 634, 592, 818, 592, 592, 525, 636, 337, 636, 838,
];

/// Height of capitals and of most other letters above the base line, in parts of the font size.
const ABOVE: f64 = 0.76;
/// What hangs below the base line: of letters such as g, and of others.
const BELOW: [f64; 2] = [0.24, 0.02];

/// Width of a line of sans-serif text of the given size, in the unit of the size.
pub fn width(text: &str, size: f64) -> f64 {
    text.chars().map(|c| relative_width(c) * size).sum()
}

/// How far a line of text goes below and above its base line, in the unit of the size.
pub fn height(text: &str, size: f64) -> [f64; 2] {
    let short =
        |c: char| c.is_ascii_alphanumeric() && !"gjpqyQ".contains(c) || " =-+.:".contains(c);
    let below = BELOW[usize::from(text.chars().all(short))];
    [below * size, ABOVE * size]
}

fn relative_width(c: char) -> f64 {
    match c {
        ' '..='~' => f64::from(ASCII[c as usize - ' ' as usize]) / 1000.0,
        '\u{300}'..='\u{36f}' => 0.0,
        '…' | '\u{2e80}'.. => 1.0,
        '\u{400}'..='\u{4ff}' => 0.75,
        _ => 0.65,
    }
}

/// The text, cut with an ellipsis where it would be wider than `room`.
pub fn shortened(text: &str, size: f64, room: f64) -> String {
    if width(text, size) <= room {
        return text.to_string();
    }
    let mut used = width("…", size);
    let fits = |c: &char| {
        used += relative_width(*c) * size;
        used <= room
    };
    let mut short: String = text.chars().take_while(fits).collect();
    short.truncate(short.trim_end().len());
    short.push('…');
    short
}

#[cfg(all(test, feature = "raster"))]
mod tests {
    use super::*;

    /// The carried font is the condensed one: every letter has this part of its usual width.
    const CONDENSED: f64 = 0.9;

    #[test]
    fn no_letter_is_wider_than_its_room() {
        for c in ' '..='~' {
            // a letter between others, as a space alone has no outline
            let text = format!("|{c}|");
            let drawn = crate::raster::text_width(&text).unwrap() / CONDENSED;
            let room = width(&text, 1.0);
            assert!(room > drawn - 2e-3, "`{c}`: {room} for {drawn}");
            assert!(room < 1.3 * drawn, "`{c}`: {room} for {drawn}");
        }
    }
}
