//! Which load of one pose is which of the next: the same role and label, in the same order.

use std::collections::BTreeMap;

use super::{LoadRole, LoadView};
use crate::view::Frame;

/// A load through a motion.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Track {
    /// What it comes from.
    pub role: LoadRole,
    /// What stands at it.
    pub label: String,
    /// Its number among the loads of each pose that has it.
    pub rows: BTreeMap<usize, usize>,
}

impl Track {
    /// All loads of a motion, in the order in which they first occur.
    pub fn all(frames: &[Frame]) -> Vec<Track> {
        let mut tracks: Vec<Track> = Vec::new();
        let mut known: BTreeMap<(LoadRole, &str, usize), usize> = BTreeMap::new();
        for (row, frame) in frames.iter().enumerate() {
            let mut seen: BTreeMap<(LoadRole, &str), usize> = BTreeMap::new();
            for (number, load) in frame.loads.iter().enumerate() {
                let occurrence = seen.entry((load.role, &load.label)).or_default();
                let key = (load.role, load.label.as_str(), *occurrence);
                *occurrence += 1;
                let track = *known.entry(key).or_insert_with(|| {
                    tracks.push(Track {
                        role: load.role,
                        label: load.label.clone(),
                        rows: BTreeMap::new(),
                    });
                    tracks.len() - 1
                });
                tracks[track].rows.insert(row, number);
            }
        }
        tracks
    }

    /// The load in a pose.
    pub fn load<'a>(&self, frames: &'a [Frame], row: usize) -> Option<&'a LoadView> {
        frames.get(row)?.loads.get(*self.rows.get(&row)?)
    }
}
