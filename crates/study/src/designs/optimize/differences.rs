//! Derivatives by differences: of simulations, and of what has a value and no exact derivative.
//!
//! A norm has no derivative where it is nothing, nor has the length of a way that ends at rest. There the values beside the design tell how a number
//! changes, and whether it has a corner there.

use kempe_optimize::Piece;

use super::designs::Designs;
use super::fit::Pairing;
use super::pieces::{Difference, by_differences, seen};
use crate::quantity::Quantity;
use crate::rows::RowPlace;

/// Steps in parts of the box: simulations keep ten digits and more.
const DIFFERENCE: f64 = 1e-5;
/// A number may have a corner where its slopes to both sides differ by this part of their mean; it has one where so much of that is left at this part of the
/// steps.
const SHARP: f64 = 0.1;
const CORNER: f64 = 0.5;
const NEARER: f64 = 0.25;

/// Two designs, below and above another in one variable, with its value in each.
type Beside = [(f64, Vec<f64>); 2];

impl Designs<'_, '_> {
    /// The designs below and above a design in a variable, by a part of its width and within the bounds; none where it has no width.
    fn beside(&self, design: &[f64], k: usize, part: f64) -> Option<Beside> {
        let [low, high] = self.bounds[k];
        let both = [-1.0, 1.0].map(|side| {
            let mut moved = design.to_vec();
            moved[k] = (design[k] + side * part * (high - low)).clamp(low, high);
            (moved[k], moved)
        });
        (both[1].0 > both[0].0).then_some(both)
    }

    /// Pieces of all numbers, with derivatives to the variables by differences.
    pub fn by_differences(&self, design: &[f64]) -> Option<Vec<Vec<Piece>>> {
        let seen = |design: &[f64]| seen(self.bench, &self.aims.wanted, &self.values(design)).ok();
        let own = seen(design)?;
        let beside = (0..design.len()).map(|k| self.beside(design, k, DIFFERENCE));
        let beside = beside.map(|both| match both {
            Some([(below, first), (above, second)]) => {
                Some(Some((above - below, [seen(&first)?, seen(&second)?])))
            }
            None => Some(None),
        });
        let beside: Vec<_> = beside.collect::<Option<_>>()?;
        Some(by_differences(&self.aims.wanted, &own, &beside))
    }

    /// Quantities of a design over its motion, with derivatives to the parameters by differences.
    pub(super) fn differences(
        &self,
        values: &[f64],
        asked: &[&Quantity],
    ) -> Option<Vec<Difference>> {
        self.differences_of(values, &|values| {
            let motion = self.bench.motion(values, &mut self.bench.watch()).ok()?;
            let along = self.bench.along(&motion, asked, &mut self.bench.watch());
            let row = along.ok()?.row(RowPlace::Drive(motion.start));
            Some(row.sample.values)
        })
    }

    /// The misses of what is fitted with derivatives to the parameters: exact ones where there are some.
    pub(super) fn residuals(&self, values: &[f64], pairing: Pairing) -> Option<Vec<Piece>> {
        let fit = self.fit.as_ref()?;
        let exact = fit.residuals(&mut fit.seen_as(values, pairing).ok()?).ok();
        exact.or_else(|| {
            let found = self.differences_of(values, &|values| fit.misses(values, pairing))?;
            let piece = |it: Difference| Piece {
                value: it.value,
                slope: it.slope,
            };
            Some(found.into_iter().map(piece).collect())
        })
    }

    /// Numbers of parameters with derivatives to these by central differences; from one side where the other has no such numbers.
    fn differences_of(
        &self,
        values: &[f64],
        told: &dyn Fn(&[f64]) -> Option<Vec<f64>>,
    ) -> Option<Vec<Difference>> {
        let finite = |numbers: &Vec<f64>| numbers.iter().all(|x| x.is_finite());
        let told = |values: &[f64]| told(values).filter(finite);
        let own = told(values)?;
        let (design, growth) = (self.variables(values), self.growth(values));
        let nothing = own.iter().map(|value| Difference {
            value: *value,
            slope: vec![0.0; values.len()],
            bends: vec![0.0; values.len()],
        });
        let mut all: Vec<Difference> = nothing.collect();
        for k in 0..values.len() {
            let sides = |part: f64| {
                let both = self.beside(&design, k, part * DIFFERENCE)?;
                let told = |(x, moved): (f64, Vec<f64>)| match x == design[k] {
                    true => None,
                    false => Some((x, told(&self.values(&moved))?)),
                };
                let [below, above] = both.map(told);
                Some(Sides {
                    here: (design[k], &own),
                    below,
                    above,
                })
            };
            let Some(far) = sides(1.0) else { continue };
            let may_turn = |i: usize| far.bend(i).abs() > SHARP * far.slope(i).abs();
            let near = (0..all.len()).any(may_turn).then(|| sides(NEARER));
            let near = near.flatten();
            for (i, it) in all.iter_mut().enumerate() {
                it.slope[k] = far.slope(i) / growth[k];
                // A curve bends the less the nearer it is looked at, a corner does not.
                let stays = |near: &Sides| near.bend(i).abs() > CORNER * far.bend(i).abs();
                if may_turn(i) && near.as_ref().is_some_and(stays) {
                    it.bends[k] = far.bend(i) / growth[k];
                }
            }
        }
        Some(all)
    }
}

/// Numbers at a design and on both sides of it, each with the value of one variable; none where there are no numbers.
struct Sides<'n> {
    here: (f64, &'n [f64]),
    below: Option<(f64, Vec<f64>)>,
    above: Option<(f64, Vec<f64>)>,
}

impl Sides<'_> {
    fn slope(&self, i: usize) -> f64 {
        let here = (self.here.0, self.here.1[i]);
        let at = |side: &Option<(f64, Vec<f64>)>| side.as_ref().map_or(here, |it| (it.0, it.1[i]));
        let (below, above) = (at(&self.below), at(&self.above));
        (above.1 - below.1) / (above.0 - below.0)
    }

    /// Half of what the slopes to both sides differ by; nothing where there is one side alone.
    fn bend(&self, i: usize) -> f64 {
        let (Some(below), Some(above)) = (&self.below, &self.above) else {
            return 0.0;
        };
        let (x, value) = (self.here.0, self.here.1[i]);
        let slope = |side: &(f64, Vec<f64>)| (side.1[i] - value) / (side.0 - x);
        (slope(above) - slope(below)) / 2.0
    }
}
