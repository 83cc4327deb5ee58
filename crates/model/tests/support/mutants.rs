//! Texts near to those that people write, the same in every run.
#![allow(dead_code, reason = "each test uses a part of it")]

/// A small generator with a fixed seed (Marsaglia's xorshift): the same mutants in every run.
pub struct Chance(u64);

impl Chance {
    pub fn new() -> Self {
        Self(0x2545_f491_4f6c_dd1d)
    }

    /// A number from 0 to `n`, without `n`; 0 where `n` is 0.
    pub fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % n.max(1) as u64) as usize
    }
}

const PIECES: &[&str] = &[
    "\"",
    "'",
    "[",
    "]",
    "{",
    "}",
    "=",
    ",",
    ".",
    "\n",
    "#",
    "\\",
    "\\u",
    "\"\"\"",
    "->",
    " of ",
    "-",
    "(",
    ")",
    "A",
    "A-B",
    "crank",
    "1e308",
    "nan",
    "-0",
    "0",
    " mm",
    " deg",
    "*",
    "/0",
    "^",
    "rate(",
    "d(",
    "at(",
    "min(",
    "angle(",
    "frame",
    "left of A -> B",
    "torque(",
    "reaction(",
    "none",
    "all",
    "near",
    "é",
    "\u{feff}",
    "\r",
    "\t",
];

/// Damage anywhere in a text: most of it is then no model any more.
pub fn mutate(text: &mut Vec<u8>, chance: &mut Chance) {
    for _ in 0..=chance.below(4) {
        let at = chance.below(text.len() + 1);
        match chance.below(5) {
            0 if at < text.len() => text[at] ^= 1 << chance.below(8),
            1 => drop(text.drain(at..(at + chance.below(12)).min(text.len()))),
            2 => {
                let end = (at + chance.below(60)).min(text.len());
                let copy = text[at..end].to_vec();
                let to = chance.below(text.len() + 1);
                drop(text.splice(to..to, copy));
            }
            _ => drop(text.splice(at..at, PIECES[chance.below(PIECES.len())].bytes())),
        }
    }
}

/// What a number may become: nothing, the other way round, a little, a lot, or far out of scale.
const NUMBERS: &[&str] = &["0", "-1", "1", "1e-9", "1e9", "0.5", "90", "360", "1e-3"];

/// Changes that leave most models models: of numbers and names in their places, and of whole lines.
pub fn vary(text: &str, chance: &mut Chance) -> String {
    let mut text = text.to_owned();
    for _ in 0..=chance.below(3) {
        text = match chance.below(8) {
            0 => without_a_line(&text, chance),
            1 | 2 => another(&text, &names(&text), chance),
            _ => another_number(&text, chance),
        };
    }
    text
}

fn without_a_line(text: &str, chance: &mut Chance) -> String {
    let gone = chance.below(text.lines().count());
    let kept = text.lines().enumerate().filter(|(i, _)| *i != gone);
    kept.flat_map(|(_, line)| [line, "\n"]).collect()
}

/// The stretches of a text whose letters are all of one kind.
fn runs(text: &str, one: impl Fn(char) -> bool) -> Vec<std::ops::Range<usize>> {
    let mut found: Vec<std::ops::Range<usize>> = Vec::new();
    for (at, _) in text.char_indices().filter(|(_, c)| one(*c)) {
        match found.last_mut() {
            Some(last) if last.end == at => last.end = at + 1,
            _ => found.push(at..at + 1),
        }
    }
    found
}

/// Names of points, which are single capital letters in the examples.
fn names(text: &str) -> Vec<std::ops::Range<usize>> {
    let words = runs(text, |c| c.is_ascii_alphanumeric() || c == '_');
    let point = |word: &std::ops::Range<usize>| text.as_bytes()[word.start].is_ascii_uppercase();
    words
        .into_iter()
        .filter(|w| w.len() == 1 && point(w))
        .collect()
}

/// Puts one of some stretches in the place of another.
fn another(text: &str, stretches: &[std::ops::Range<usize>], chance: &mut Chance) -> String {
    if stretches.is_empty() {
        return text.to_owned();
    }
    let [at, from] = [0; 2].map(|_| stretches[chance.below(stretches.len())].clone());
    format!("{}{}{}", &text[..at.start], &text[from], &text[at.end..])
}

fn another_number(text: &str, chance: &mut Chance) -> String {
    let mut numbers = runs(text, |c| c.is_ascii_digit() || c == '.');
    numbers.retain(|n| text[n.clone()].parse::<f64>().is_ok());
    if numbers.is_empty() {
        return text.to_owned();
    }
    if chance.below(3) == 0 {
        return another(text, &numbers, chance);
    }
    let at = numbers[chance.below(numbers.len())].clone();
    let value: f64 = text[at.clone()].parse().unwrap_or(1.0);
    let new = match chance.below(3) {
        0 => format!("{}", value * (0.5 + chance.below(1000) as f64 * 1e-3)),
        1 => format!("{}", value * (1.0 + 1e-9)),
        _ => NUMBERS[chance.below(NUMBERS.len())].to_owned(),
    };
    format!("{}{new}{}", &text[..at.start], &text[at.end..])
}
