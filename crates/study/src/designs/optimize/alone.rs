//! Designs alone: where branches cross on the way of a linkage it may do what no design beside it does, as a parallelogram may fold. Nobody can build one so
//! exactly, and no search shall find it.

use kempe_number::Random;
use kempe_optimize::Evaluation;

use super::designs::Designs;
use crate::designs::bench::crosses;

/// Why such a design is none.
const ALONE: &str = "branches cross on its way, and it goes on there as no design beside it does";
/// How far it is from one that can be asked: next to it are some.
const NEXT_TO: f64 = f64::EPSILON;
/// Designs beside it are asked so far from it, in parts of the bounds, the nearer first; farther where branches still cross, as they do by rounding between narrow
/// bounds.
const BESIDE: [f64; 2] = [1e-8, 1e-6];
const FARTHER: [f64; 2] = [1e-6, 1e-4];
/// In so many directions at most, in which every parameter changes by this part of the most at least: where branches cross some parameters may be anything, and
/// in a corner of the bounds few directions may lead to where designs can be asked. So many of these are enough.
const DIRECTIONS: usize = 24;
const SLANT: f64 = 0.1;
const ENOUGH: usize = 4;
/// What differs by less than this part of it, or than what rounding leaves of nothing, SI, is the same.
const SAME: f64 = 1e-7;
const NOTHING: f64 = 1e-10;
/// Where the file's own design stands alone, searches begin so far from it, in parts of the bounds.
const BEGIN: f64 = 1e-3;

impl Designs<'_, '_> {
    /// Whether a design on whose way branches cross is worth what none beside it is. Where none of those can be asked, as between values of catalogues, it is not.
    fn stands_alone(&self, values: &[f64], own: &Evaluation) -> bool {
        let design = self.variables(values);
        let mut asked = 0;
        for way in self.ways(&design, FARTHER[1]).take(DIRECTIONS) {
            let there = |by: f64| self.told(&self.values(&moved(&design, &way, by)));
            let ((near, _), crosses) = there(BESIDE[0]);
            let beside = match crosses {
                true => FARTHER.map(|by| there(by).0.0),
                false => [near, there(BESIDE[1]).0.0],
            };
            if !beside.iter().all(Evaluation::is_defined) {
                continue;
            }
            if goes_over(own, &beside) {
                return false;
            }
            asked += 1;
            if asked == ENOUGH {
                break;
            }
        }
        asked > 0
    }

    /// What parameters are worth, SI, to choose among designs: those that stand alone are refused.
    pub fn look(&self, values: &[f64]) -> (Evaluation, Option<String>) {
        let (told, crosses) = self.told(values);
        let may_be = crosses && self.no_alone && told.1.is_none();
        match may_be && self.stands_alone(values, &told.0) {
            true => (Evaluation::lacking(NEXT_TO), Some(ALONE.to_owned())),
            false => told,
        }
    }

    /// Whether any design stands alone, SI.
    pub fn is_alone(&self, values: &[f64]) -> bool {
        let ((own, why), crosses) = self.told(values);
        crosses && why.is_none() && self.stands_alone(values, &own)
    }

    /// Where searches begin: at the file's own design, or beside it where that stands alone, which is told besides.
    pub(super) fn begin(&self) -> (Vec<f64>, bool) {
        let own = self.variables(&self.bench.own_values());
        let inside = own.iter().zip(&self.bounds);
        let inside: Vec<f64> = inside
            .map(|(x, [low, high])| x.clamp(*low, *high))
            .collect();
        let crosses = match self.bench.own_motion().filter(|_| inside == own) {
            Some(motion) => crosses(motion),
            None => true,
        };
        if !crosses || self.look(&self.values(&inside)).1.as_deref() != Some(ALONE) {
            return (own, false);
        }
        let beside = self.ways(&inside, BEGIN).take(DIRECTIONS).find_map(|way| {
            let there = moved(&inside, &way, BEGIN);
            let (evaluation, _) = self.look(&self.values(&there));
            evaluation.is_defined().then_some(there)
        });
        match beside {
            Some(there) => (there, true),
            None => (own, false),
        }
    }

    /// Directions from a design, in which it stays between the bounds so far; as long as these are apart in some variable at most. Values of catalogues stay.
    fn ways(&self, design: &[f64], far: f64) -> impl Iterator<Item = Vec<f64>> {
        let mut random = Random(1);
        // Of every two the one leads the other way, where it may.
        let mut last: Option<Vec<f64>> = None;
        std::iter::repeat_with(move || {
            let before = last.take();
            let all = design.iter().zip(&self.bounds).zip(self.are_free());
            let way = all.enumerate().map(|(k, ((x, [low, high]), is_free))| {
                let size = (SLANT + (1.0 - SLANT) * random.uniform()) * (high - low);
                let any = if random.uniform() < 0.5 { size } else { -size };
                let by = (before.as_ref()).map_or(any, |before| -size.copysign(before[k]));
                let is_inside = (*low..=*high).contains(&(x + far * by));
                match (is_free, is_inside) {
                    (false, _) => 0.0,
                    (true, true) => by,
                    (true, false) => -by,
                }
            });
            let way: Vec<f64> = way.collect();
            last = before.is_none().then(|| way.clone());
            way
        })
    }
}

/// A design so far along a way.
fn moved(design: &[f64], way: &[f64], by: f64) -> Vec<f64> {
    design
        .iter()
        .zip(way)
        .map(|(x, way)| x + by * way)
        .collect()
}

/// Whether what designs are worth goes on evenly to one from others beside it, the nearer first.
fn goes_over(own: &Evaluation, [near, far]: &[Evaluation; 2]) -> bool {
    let all = |it: &Evaluation| [it.objectives.clone(), it.constraints.clone()].concat();
    let [own, near, far] = [own, near, far].map(all);
    own.iter().zip(&near).zip(&far).all(|((own, near), far)| {
        let (last, before) = (own - near, near - far);
        // As by any root, not as at a pole.
        let goes_on = last * before >= 0.0 && last.abs() <= before.abs();
        goes_on || last.abs() <= SAME * own.abs().max(near.abs()) + NOTHING
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn goes_on(own: f64, near: f64, far: f64) -> bool {
        let of = |x: f64| Evaluation {
            objectives: vec![1.0],
            constraints: vec![x],
            lack: 0.0,
        };
        goes_over(&of(own), &[of(near), of(far)])
    }

    #[test]
    fn what_goes_on_evenly_is_told_from_jumps_and_poles() {
        // A line, a root, and the sixth root, a hundred times as far away each.
        assert!(goes_on(2.0, 2.0 + 1e-8, 2.0 + 1e-6));
        assert!(goes_on(2.0, 2.0 + 1e-4, 2.0 + 1e-3));
        assert!(goes_on(0.0, 1.0, 2.154));
        // Nothing but rounding, of something and of nothing.
        assert!(goes_on(2.0, 2.0 + 1e-15, 2.0 - 1e-15));
        assert!(goes_on(3e-13, 5e-14, 2e-13));
        // Jumps, also of what is steep beside them, and poles to which something finite belongs.
        assert!(!goes_on(3.6, 1.8, 1.8));
        assert!(!goes_on(3.6, 1.8, 1.7));
        assert!(!goes_on(86.8, 5e4, 5e3));
        assert!(!goes_on(86.8, -5e4, -5e3));
    }
}
