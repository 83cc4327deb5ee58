//! The near name for a misspelt one.

/// Words longer than this many characters are not compared: no name is that long, and the cost grows with the square.
const LONGEST_WORD: usize = 64;

/// The candidate nearest to `word`, if one is near enough to be meant.
///
/// The distance is Damerau–Levenshtein in its optimal-alignment form (insert, delete, replace, swap neighbours),
/// letters compared without case. Near enough is a third of the word's length, at least one edit, and always fewer
/// edits than the word has characters. Of equally near candidates one with the same first letter wins, then the
/// first one.
///
/// # Example
///
/// ```
/// assert_eq!(kempe_units::nearest("carnk", ["rocker", "crank"]), Some("crank"));
/// assert_eq!(kempe_units::nearest("piston", ["rocker", "crank"]), None);
/// ```
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let length = word.chars().count();
    if length > LONGEST_WORD {
        return None;
    }
    let allowed = length.div_ceil(3).max(1).min(length.saturating_sub(1));
    let folded: Vec<char> = word.to_lowercase().chars().collect();
    let mut best: Option<(usize, bool, &'a str)> = None;
    for candidate in candidates {
        if candidate == word || candidate.chars().count() > LONGEST_WORD {
            continue;
        }
        let other: Vec<char> = candidate.to_lowercase().chars().collect();
        let edits = distance(&folded, &other);
        // Among equal distances, the one that shares the first letter as written is meant more often.
        let other_start = candidate.chars().next() != word.chars().next();
        if edits <= allowed && best.is_none_or(|(b, s, _)| (edits, other_start) < (b, s)) {
            best = Some((edits, other_start, candidate));
        }
    }
    best.map(|(_, _, candidate)| candidate)
}

/// Optimal-alignment distance, by three rolling rows.
fn distance(a: &[char], b: &[char]) -> usize {
    let mut before: Vec<usize> = Vec::new();
    let mut above: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i; b.len() + 1];
        for j in 1..=b.len() {
            let replaced = above[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            row[j] = replaced.min(above[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                row[j] = row[j].min(before[j - 2] + 1);
            }
        }
        before = std::mem::replace(&mut above, row);
    }
    above[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances() {
        let d = |a: &str, b: &str| {
            distance(
                &a.chars().collect::<Vec<_>>(),
                &b.chars().collect::<Vec<_>>(),
            )
        };
        assert_eq!(d("", ""), 0);
        assert_eq!(d("abc", ""), 3);
        assert_eq!(d("kitten", "sitting"), 3);
        assert_eq!(d("crank", "carnk"), 1);
        assert_eq!(
            d("ca", "abc"),
            3,
            "optimal alignment, not the unrestricted distance"
        );
    }

    #[test]
    fn near_names() {
        assert_eq!(
            nearest("trasmission_angle", ["angle", "transmission_angle"]),
            Some("transmission_angle")
        );
        assert_eq!(nearest("Crank", ["crank"]), Some("crank"));
        assert_eq!(
            nearest("x", ["y", "z"]),
            None,
            "one letter is never a misspelling of another"
        );
        assert_eq!(nearest("X", ["x"]), Some("x"));
        assert_eq!(nearest("", ["x"]), None);
        assert_eq!(nearest(&"a".repeat(100), ["x"]), None);
        assert_eq!(
            nearest("ab", ["ac", "ad"]),
            Some("ac"),
            "the first of equals"
        );
    }
}
