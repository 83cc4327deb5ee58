//! Which files take names from which, and which of these go round.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The names that one file takes from another.
pub type Arrows = BTreeMap<(PathBuf, PathBuf), BTreeSet<String>>;

/// Those that lead back to where they begin.
pub fn in_circles(arrows: &Arrows) -> Arrows {
    let mut taken_by: BTreeMap<&Path, Vec<&Path>> = BTreeMap::new();
    for (from, to) in arrows.keys() {
        taken_by.entry(from).or_default().push(to);
    }
    let leads_back = |from: &Path, to: &Path| {
        let mut reached = BTreeSet::from([to]);
        let mut open = vec![to];
        while let Some(file) = open.pop() {
            let next = taken_by.get(file).into_iter().flatten();
            open.extend(next.filter(|to| reached.insert(to)));
        }
        reached.contains(from)
    };
    let circles = arrows.iter().filter(|((from, to), _)| leads_back(from, to));
    circles
        .map(|(files, names)| (files.clone(), names.clone()))
        .collect()
}
