//! Whether a text has one value more or another one, and else says what another does.

use toml::de::{DeTable, DeValue};

/// Whether the tree `after` is `before` with `new` at `path`.
pub(super) fn only_change(
    before: &DeTable<'_>,
    after: &DeTable<'_>,
    path: &[&str],
    new: &DeValue<'_>,
) -> bool {
    same_tables(before, after, Some((path, new)))
}

/// A value that differs, by the path to it.
type Change<'c> = Option<(&'c [&'c str], &'c DeValue<'c>)>;

fn same_tables(before: &DeTable<'_>, after: &DeTable<'_>, change: Change<'_>) -> bool {
    let to = change.and_then(|(path, _)| path.first());
    let is_there = |key: &str| after.get(key).is_some();
    let kept = before.keys().all(|key| is_there(key.get_ref()));
    kept && to.is_none_or(|key| is_there(key))
        && after.iter().all(|(key, value)| {
            let key = key.get_ref().as_ref();
            let old = before.get(key).map(|old| old.get_ref());
            same(old, value.get_ref(), under(change, key))
        })
}

fn same(before: Option<&DeValue<'_>>, after: &DeValue<'_>, change: Change<'_>) -> bool {
    if let Some(([], new)) = change {
        return same(Some(new), after, None);
    }
    match (before, after) {
        (Some(DeValue::Table(a)), DeValue::Table(b)) => same_tables(a, b, change),
        // a table that the change brings
        (None, DeValue::Table(b)) if change.is_some() => same_tables(&DeTable::new(), b, change),
        (Some(DeValue::Array(a)), DeValue::Array(b)) => {
            let mut pairs = a.iter().zip(b.iter()).enumerate();
            let in_range = |(path, _): (&[&str], _)| {
                let place = path.first().and_then(|part| part.parse::<usize>().ok());
                place.is_some_and(|place| place < b.len())
            };
            a.len() == b.len()
                && change.is_none_or(in_range)
                && pairs.all(|(i, (a, b))| same(Some(a.get_ref()), b.get_ref(), at(change, i)))
        }
        _ if change.is_some() => false,
        (Some(DeValue::String(a)), DeValue::String(b)) => a == b,
        (Some(DeValue::Integer(a)), DeValue::Integer(b)) => {
            (a.as_str(), a.radix()) == (b.as_str(), b.radix())
        }
        (Some(DeValue::Float(a)), DeValue::Float(b)) => a.as_str() == b.as_str(),
        (Some(DeValue::Boolean(a)), DeValue::Boolean(b)) => a == b,
        (Some(DeValue::Datetime(a)), DeValue::Datetime(b)) => a == b,
        _ => false,
    }
}

/// What of a change is under a key.
fn under<'c>(change: Change<'c>, key: &str) -> Change<'c> {
    let (path, new) = change?;
    let (first, rest) = path.split_first()?;
    (*first == key).then_some((rest, new))
}

/// What of a change is at a place of an array.
fn at(change: Change<'_>, place: usize) -> Change<'_> {
    let (path, new) = change?;
    let (first, rest) = path.split_first()?;
    (first.parse() == Ok(place)).then_some((rest, new))
}
