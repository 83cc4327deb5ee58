//! What the table of keys says of a path of a file.

use crate::key_table::FILE;
use crate::keys::{Key, Kind, Takes};
use crate::read::names::{is_point_name, pair_of};

/// Kinds of which an entry may be.
pub(crate) type Kinds = Vec<&'static Kind>;

/// What the value of a path may be, one by one: none where the language has no such path.
///
/// Where an entry may be of several kinds, `kinds_of` says of which it is, given its path: one, or those that it may be.
pub(crate) fn takes_at(
    path: &[String],
    kinds_of: &dyn Fn(&[String], &[&'static Kind]) -> Kinds,
) -> Vec<Takes> {
    let mut here = vec![Takes::Table(&FILE)];
    for (i, name) in path.iter().enumerate() {
        let mut inner = Vec::new();
        for takes in here {
            match takes {
                Takes::Table(kind) => match (key_of(kind, name), kind.alone()) {
                    (Some(key), _) => each(&key.takes, &mut inner),
                    (
                        None,
                        Some(Key {
                            takes: Takes::List(one, _),
                            ..
                        }),
                    ) if is_index(name) => {
                        each(one, &mut inner);
                    }
                    _ => {}
                },
                Takes::Entries(kinds) => {
                    let kinds = kinds_of(path.get(..=i).unwrap_or(path), kinds);
                    inner.extend(kinds.into_iter().map(Takes::Table));
                }
                Takes::Values(one) => each(one, &mut inner),
                Takes::Two(one) | Takes::List(one, _) if is_index(name) => each(one, &mut inner),
                Takes::Pair(_) if is_index(name) => inner.push(Takes::AnyValue),
                _ => {}
            }
        }
        here = inner;
    }
    here
}

/// The place of an element of an array, as paths have it.
pub(crate) fn is_index(name: &str) -> bool {
    !name.is_empty() && name.bytes().all(|b| b.is_ascii_digit())
}

/// The key of a name, of one's own choice too.
fn key_of(kind: &'static Kind, name: &str) -> Option<&'static Key> {
    let like = |key: &&Key| match pair_of(key.name) {
        Some(_) => pair_of(name).is_some(),
        None => is_point_name(name),
    };
    kind.key(name).or_else(|| kind.points.iter().find(like))
}

/// What something takes, one by one.
fn each(takes: &Takes, to: &mut Vec<Takes>) {
    match *takes {
        Takes::AnyOf(some) => some.iter().for_each(|one| each(one, to)),
        Takes::Amount(kind) => to.extend([Takes::Measure, Takes::Table(kind)]),
        one => to.push(one),
    }
}
