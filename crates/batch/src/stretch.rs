//! Where on a motion which assembly modes hold.

use kempe_mechanism::Branch;

use crate::mask::lanes_where;
use kempe_motion::Motion;

/// A stretch of the path parameter with one set of assembly modes.
#[derive(Clone, Debug)]
pub(super) struct ModeStretch {
    from: f64,
    /// First parameter beyond it.
    to: f64,
    pub(super) branch: Branch,
}

/// The motion's stretches with a margin at both ends; together they cover what the motion reaches.
pub(super) fn stretches(motion: &Motion) -> Vec<ModeStretch> {
    let margin = motion.margin();
    let last = motion.node_parameters().last().copied();
    let mut list: Vec<ModeStretch> = Vec::new();
    for (from, signs) in motion.stretches() {
        let mut branch = Branch::neutral(motion.mechanism());
        branch.signs.copy_from_slice(signs);
        if let Some(before) = list.last_mut() {
            before.to = from;
        }
        list.push(ModeStretch {
            from,
            to: f64::INFINITY,
            branch,
        });
    }
    if let Some(first) = list.first_mut() {
        first.from -= margin;
    }
    if let (Some(stretch), Some(last)) = (list.last_mut(), last) {
        stretch.to = (last + margin).next_up();
    }
    list
}

impl ModeStretch {
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn holds(&self, p: f64) -> bool {
        (self.from <= p) & (p < self.to)
    }

    /// Whether it holds all of them.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn holds_all(&self, parameters: &[f64]) -> bool {
        let mut outside = 0_u64;
        for p in parameters {
            outside |= u64::from(!self.holds(*p));
        }
        outside == 0
    }

    /// Which of the lanes it holds, one bit for each.
    pub(super) fn lanes<const W: usize>(&self, p: &[f64; W]) -> u32 {
        lanes_where(|lane| self.holds(p[lane]), W)
    }
}

/// The stretch in which `p` lies, tried at `cursor` first.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn find_stretch(stretches: &[ModeStretch], p: f64, cursor: &mut usize) -> bool {
    let within = |s: &ModeStretch| s.holds(p);
    if stretches.get(*cursor).is_some_and(within) {
        return true;
    }
    *cursor = stretches.partition_point(|s| s.from <= p).max(1) - 1;
    stretches.get(*cursor).is_some_and(within)
}

/// The stretch in which `p` lies; beyond the ends the first or the last.
pub(super) fn nearest_stretch(stretches: &[ModeStretch], p: f64) -> Option<&ModeStretch> {
    stretches.get(stretches.partition_point(|s| s.from <= p).max(1) - 1)
}
