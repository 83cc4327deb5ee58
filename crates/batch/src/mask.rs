//! Some of the lanes, one bit for each.

/// The lanes for which something holds, one bit for each.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn lanes_where(holds: impl Fn(usize) -> bool, lanes: usize) -> u32 {
    let mut mask = 0;
    for lane in 0..lanes {
        mask |= u32::from(holds(lane)) << lane;
    }
    mask
}

/// All of this many lanes.
pub(super) const fn all_lanes(lanes: usize) -> u32 {
    u32::MAX >> (u32::BITS as usize - lanes)
}
