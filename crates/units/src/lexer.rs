//! Text to tokens.

use crate::issue::{Issue, Span, SyntaxError};

/// What a token is.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Token {
    /// A number literal.
    Number(f64),
    /// A name: of a parameter, a point, a function or a unit.
    Name(String),
    /// Raised digits, `²` or `⁻¹`.
    Raised(i32),
    /// `+`.
    Plus,
    /// `-`.
    Minus,
    /// `*`.
    Star,
    /// `·`.
    Dot,
    /// `/`.
    Slash,
    /// `^`.
    Caret,
    /// `(`.
    Open,
    /// `)`.
    Close,
    /// `,`.
    Comma,
    /// `->`.
    Arrow,
    /// `<=` or `≤`.
    LessEqual,
    /// `>=` or `≥`.
    GreaterEqual,
    /// `<`.
    Less,
    /// `>`.
    Greater,
    /// The end of the text.
    End,
}

/// The tokens of `text` with their spans, ended by [`Token::End`]; what cannot be read goes to `errors`, and where it was left
/// out to `skipped`.
pub(crate) fn tokens(
    text: &str,
    errors: &mut Vec<SyntaxError>,
    skipped: &mut Vec<usize>,
) -> Vec<(Token, Span)> {
    let mut out = Vec::new();
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        let rest = &text[at..];
        let (token, length) = if first.is_whitespace() {
            at += first.len_utf8();
            continue;
        } else if first.is_ascii_digit()
            || first == '.' && rest[1..].starts_with(|c: char| c.is_ascii_digit())
        {
            let length = number_length(rest);
            let value = rest[..length].parse().unwrap_or(f64::INFINITY);
            if !value.is_finite() {
                errors.push(too_large(at..at + length));
            }
            (Token::Number(value), length)
        } else if starts_name(first) {
            let length = rest.find(|c| !continues_name(c)).unwrap_or(rest.len());
            (Token::Name(rest[..length].to_owned()), length)
        } else if matches!(first, '%' | '°') {
            (Token::Name(first.to_string()), first.len_utf8())
        } else if raised_digit(first).is_some() || first == '⁻' {
            let length = rest
                .find(|c| raised_digit(c).is_none() && c != '⁻')
                .unwrap_or(rest.len());
            match raised(&rest[..length]) {
                Some(power) => (Token::Raised(power), length),
                None => {
                    let issue = Issue::new(
                        "syntax",
                        at..at + length,
                        "these raised digits are not a power",
                    );
                    errors.push(issue.with_help("a power is written `a^2` or `a^-2`"));
                    at += length;
                    continue;
                }
            }
        } else if let Some(symbol) = symbol(rest) {
            symbol
        } else {
            let (meant, length, help) = stands_for(rest);
            let span = at..at + length;
            let sign = rest[..length].escape_debug();
            errors.push(
                Issue::new("syntax", span, format!("`{sign}` has no meaning here")).with_help(help),
            );
            match meant {
                Some(meant) => (meant, length),
                None => {
                    skipped.push(at);
                    // what stands behind a comment's sign is none of the expression
                    at = if first == '#' {
                        text.len()
                    } else {
                        at + length
                    };
                    continue;
                }
            }
        };
        out.push((token, at..at + length));
        at += length;
    }
    out.push((Token::End, text.len()..text.len()));
    out
}

/// Signs, longest first.
fn symbol(rest: &str) -> Option<(Token, usize)> {
    let signs = [
        ("->", Token::Arrow),
        ("<=", Token::LessEqual),
        (">=", Token::GreaterEqual),
        ("≤", Token::LessEqual),
        ("≥", Token::GreaterEqual),
        ("<", Token::Less),
        (">", Token::Greater),
        ("+", Token::Plus),
        ("-", Token::Minus),
        ("*", Token::Star),
        ("·", Token::Dot),
        ("/", Token::Slash),
        ("^", Token::Caret),
        ("(", Token::Open),
        (")", Token::Close),
        (",", Token::Comma),
    ];
    signs
        .into_iter()
        .find(|(sign, _)| rest.starts_with(sign))
        .map(|(sign, token)| (token, sign.len()))
}

/// The issue of a number beyond all numbers.
pub(crate) fn too_large(span: Span) -> SyntaxError {
    Issue::new("syntax", span, "this number is too large")
        .with_help("numbers go up to about 1e308: look for a wrong exponent or a missing point")
}

/// What is meant by the sign at the start of `rest` that the language does not have, so that the reading goes on as if it were
/// written; the sign's length; and advice.
fn stands_for(rest: &str) -> (Option<Token>, usize, &'static str) {
    const COMPARISON: &str =
        "a comparison is one of `<=`, `>=`, `<`, `>`, and stands in conditions alone";
    const EQUAL: &str = "what is to be equal takes two conditions, one with `<=` and one with `>=`";
    const BOTH: &str = "write two conditions, one for each";
    const ROUND: &str = "only round brackets group";
    for (sign, meant, help) in [
        ("==", Some(Token::LessEqual), EQUAL),
        ("!=", Some(Token::LessEqual), COMPARISON),
        ("=", Some(Token::LessEqual), EQUAL),
        ("&&", None, BOTH),
        ("||", None, BOTH),
    ] {
        if rest.starts_with(sign) {
            return (meant, sign.len(), help);
        }
    }
    let sign = rest.chars().next().unwrap_or(' ');
    let (meant, help) = match sign {
        '−' | '–' | '—' => (Some(Token::Minus), "minus is written `-`"),
        '×' | '⋅' | '∙' | '•' => (Some(Token::Star), "times is written `*`"),
        '÷' | ':' | '∕' | '⁄' => (Some(Token::Slash), "a division is written `/`"),
        '→' => (Some(Token::Arrow), "a directed line is written `A -> B`"),
        '[' | '{' => (Some(Token::Open), ROUND),
        ']' | '}' => (Some(Token::Close), ROUND),
        'π' => (
            Some(Token::Name("pi".to_owned())),
            "the constant is called `pi`",
        ),
        ';' => (
            Some(Token::Comma),
            "arguments are parted by `,`: `atan2(y, x)`",
        ),
        '√' => (
            Some(Token::Name("sqrt".to_owned())),
            "a root is written `sqrt(x)`",
        ),
        '"' | '\'' | '`' | '´' | '“' | '”' | '„' | '‘' | '’' | '‚' | '«' | '»' => (
            None,
            "leave it out: a value stands between two plain double quotes and holds none itself",
        ),
        '′' | '″' => (None, "feet and inches are written `ft` and `in`"),
        '.' => (None, "a decimal point stands beside a digit, as in `0.5`"),
        '#' => (
            None,
            "leave it out: a comment stands behind the closing quote",
        ),
        '!' | '&' | '|' | '?' | '~' => (
            None,
            "there is no logic in expressions: values are made by `+ - * / ^` and functions",
        ),
        '@' | '$' | '\\' => (
            None,
            "names are made of letters, digits and `_`; leave this out",
        ),
        c if c.is_control() || is_invisible(c) => (
            None,
            "a sign that does not show, perhaps from a copied text: type the value again",
        ),
        _ => (
            None,
            "an expression is made of numbers, units, names and `+ - * / ^ ( ) ,`: leave this out",
        ),
    };
    (meant, sign.len_utf8(), help)
}

/// Whether a sign has no width, such as a byte order mark or a joiner.
fn is_invisible(c: char) -> bool {
    matches!(c, '\u{ad}' | '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
}

/// Whether a name may start with `c`.
fn starts_name(c: char) -> bool {
    (c.is_alphabetic() && c != 'π') || c == '_'
}

/// Whether a name may go on with `c`.
fn continues_name(c: char) -> bool {
    starts_name(c) || c.is_ascii_digit()
}

/// Length of the number literal `rest` starts with: digits, a point, digits, and `e` with digits.
fn number_length(rest: &str) -> usize {
    let digits = |from: usize| rest[from..].bytes().take_while(u8::is_ascii_digit).count();
    let mut length = digits(0);
    if rest[length..].starts_with('.') {
        length += 1 + digits(length + 1);
    }
    if rest[length..].starts_with(['e', 'E']) {
        let sign = usize::from(rest[length + 1..].starts_with(['+', '-']));
        let exponent = digits(length + 1 + sign);
        if exponent > 0 {
            length += 1 + sign + exponent;
        }
    }
    length
}

/// The value of a raised digit.
fn raised_digit(c: char) -> Option<i32> {
    "⁰¹²³⁴⁵⁶⁷⁸⁹"
        .chars()
        .position(|d| d == c)
        .and_then(|d| i32::try_from(d).ok())
}

/// The number raised digits stand for; `None` for a lone or misplaced minus or more than three digits.
fn raised(text: &str) -> Option<i32> {
    let (sign, digits) = text
        .strip_prefix('⁻')
        .map_or((1, text), |digits| (-1, digits));
    if digits.is_empty() || digits.chars().count() > 3 {
        return None;
    }
    let value = digits
        .chars()
        .try_fold(0, |value, c| Some(10 * value + raised_digit(c)?))?;
    Some(sign * value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> (Vec<Token>, Vec<String>) {
        let mut errors = Vec::new();
        let tokens = tokens(text, &mut errors, &mut Vec::new())
            .into_iter()
            .map(|(token, _)| token)
            .collect();
        (tokens, errors.into_iter().map(|e| e.to_string()).collect())
    }

    #[test]
    fn numbers() {
        for (text, value) in [
            ("120", 120.0),
            ("1.5e-3", 1.5e-3),
            (".5", 0.5),
            ("5.", 5.0),
            ("2E+2", 200.0),
        ] {
            assert_eq!(read(text).0, [Token::Number(value), Token::End]);
        }
        assert_eq!(
            read("2e").0,
            [Token::Number(2.0), Token::Name("e".into()), Token::End]
        );
        assert!(read("1e999").1[0].starts_with("this number is too large (numbers go up to"));
    }

    #[test]
    fn names_and_signs() {
        let name = |text: &str| Token::Name(text.to_owned());
        assert_eq!(
            read("A->B2").0,
            [name("A"), Token::Arrow, name("B2"), Token::End]
        );
        assert_eq!(read("5%").0, [Token::Number(5.0), name("%"), Token::End]);
        assert_eq!(read("µm²").0, [name("µm"), Token::Raised(2), Token::End]);
        assert_eq!(read("s⁻¹²").0, [name("s"), Token::Raised(-12), Token::End]);
        assert_eq!(
            read("a<=b").0,
            [name("a"), Token::LessEqual, name("b"), Token::End]
        );
        assert_eq!(
            read("2×3").1,
            ["`×` has no meaning here (times is written `*`)"]
        );
        assert_eq!(read("2⁻").1.len(), 1);
        assert_eq!(
            read("2\u{a0}mm").0,
            [Token::Number(2.0), name("mm"), Token::End],
            "a blank of any width is a blank"
        );
    }
}
