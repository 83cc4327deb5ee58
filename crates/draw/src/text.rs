//! Widths of text without a font at hand: close enough to lay out labels, the same on every target.

/// Estimated width of a line of sans-serif text of the given size, in the unit of the size.
pub fn width(text: &str, size: f64) -> f64 {
    text.chars().map(|c| relative_width(c) * size).sum()
}

fn relative_width(c: char) -> f64 {
    match c {
        'i' | 'j' | 'l' | '\'' | '|' | '.' | ',' | ':' | ';' | '!' => 0.26,
        'f' | 't' | 'r' | 'I' | '(' | ')' | '[' | ']' | ' ' | '/' | '-' => 0.34,
        'm' | 'w' | 'M' | 'W' | '@' | '%' => 0.86,
        'A'..='Z' | '&' => 0.68,
        '0'..='9' | 'a'..='z' => 0.55,
        '\u{300}'..='\u{36f}' => 0.0,
        c if (c as u32) >= 0x2e80 => 1.0,
        _ => 0.6,
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
