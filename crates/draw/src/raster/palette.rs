//! One palette for all pictures of an animation: median cut over the colours that occur.

use std::collections::BTreeMap;

/// Colours in a palette; one index stays free for "unchanged". Few colours make small files.
pub(super) const MOST_COLORS: usize = 63;
/// The index that means "as before".
pub(super) const UNCHANGED: u8 = 63;

/// A palette and the way from colours to it.
pub(super) struct Palette {
    /// Red, green and blue of each colour, `MOST_COLORS` at most.
    pub colors: Vec<[u8; 3]>,
    lookup: BTreeMap<[u8; 3], u8>,
}

/// How often a colour occurs.
type Count = ([u8; 3], u64);

impl Palette {
    /// The palette of the pixels (three bytes each) of some pictures.
    pub fn of<'a>(pictures: impl Iterator<Item = &'a [u8]>) -> Palette {
        let mut counts: BTreeMap<[u8; 3], u64> = BTreeMap::new();
        for picture in pictures {
            for p in picture.chunks_exact(3) {
                *counts.entry([p[0], p[1], p[2]]).or_default() += 1;
            }
        }
        let mut boxes: Vec<Vec<Count>> = vec![counts.into_iter().collect()];
        while boxes.len() < MOST_COLORS {
            // split the box whose spread costs most
            let cost = |b: &Vec<Count>| {
                if b.len() < 2 {
                    0
                } else {
                    widest(b).1 * spread_weight(b)
                }
            };
            let Some((index, worst)) = boxes
                .iter()
                .enumerate()
                .map(|(i, b)| (i, cost(b)))
                .max_by_key(|(_, c)| *c)
            else {
                break;
            };
            if worst == 0 {
                break;
            }
            let mut whole = boxes.swap_remove(index);
            let channel = widest(&whole).0;
            whole.sort_by_key(|(c, _)| (c[channel], *c));
            let half = whole.iter().map(|(_, n)| n).sum::<u64>() / 2;
            let mut seen = 0;
            let middle = whole.iter().position(|(_, n)| {
                seen += n;
                seen > half
            });
            let upper = whole.split_off(middle.unwrap_or(0).clamp(1, whole.len() - 1));
            boxes.extend([whole, upper]);
        }
        let mut palette = Palette {
            colors: Vec::new(),
            lookup: BTreeMap::new(),
        };
        for members in boxes.iter().filter(|b| !b.is_empty()) {
            let index = palette.colors.len() as u8;
            // the commonest colour of a box stands for it, so that flat areas keep their exact colour
            let best = members
                .iter()
                .max_by_key(|(c, n)| (*n, *c))
                .map_or([0; 3], |(c, _)| *c);
            palette.colors.push(best);
            palette
                .lookup
                .extend(members.iter().map(|(c, _)| (*c, index)));
        }
        palette
    }

    /// The pixels as palette indices.
    pub fn indices(&self, rgb: &[u8]) -> Vec<u8> {
        let mut last = ([0, 0, 0], self.lookup.get(&[0, 0, 0]).copied().unwrap_or(0));
        let index = |p: &[u8]| {
            let color = [p[0], p[1], p[2]];
            if color != last.0 {
                last = (color, self.lookup.get(&color).copied().unwrap_or(0));
            }
            last.1
        };
        rgb.chunks_exact(3).map(index).collect()
    }
}

/// The channel with the widest range, and that range.
fn widest(members: &[Count]) -> (usize, u64) {
    let range = |k: usize| {
        let values = members.iter().map(|(c, _)| u64::from(c[k]));
        let (low, high) = values.fold((255, 0), |(low, high), v| (low.min(v), high.max(v)));
        high.saturating_sub(low)
    };
    (0..3)
        .map(|k| (k, range(k)))
        .max_by_key(|(_, r)| *r)
        .unwrap_or((0, 0))
}

/// Weight of a box by its pixels, growing slowly so that rare colours get their share.
fn spread_weight(members: &[Count]) -> u64 {
    let total: u64 = members.iter().map(|(_, n)| n).sum();
    total.isqrt().max(1)
}
