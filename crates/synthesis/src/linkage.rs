//! Pairs of dyads as linkages.

use kempe_linear::C;

use crate::dyad::Dyad;
use crate::four_bar::FourBar;
use crate::slider_crank::{InvertedSliderCrank, SliderCrank};

/// A body on two dyads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Linkage {
    /// Two links with pins.
    FourBar(FourBar),
    /// A link with pins and a slider on a fixed guide.
    SliderCrank(SliderCrank),
    /// A link with pins and a slider on a guide of the body.
    InvertedSliderCrank(InvertedSliderCrank),
    /// Two sliders.
    TwoSliders(Dyad, Dyad),
}

/// Pivots nearer to each other than this part of the links are one: a dyad twice, a frame or coupler without length.
const ONE_PIVOT: f64 = 1e-9;

impl Linkage {
    /// The linkage of two dyads, a link with pins first; `None` where they share a pivot or a guide, and so guide nothing.
    pub fn of(first: Dyad, second: Dyad) -> Option<Self> {
        let apart = |a: C, b: C, size: f64| (a - b).norm() > ONE_PIVOT * size;
        match (first, second) {
            (
                Dyad::Rr {
                    fixed: a0,
                    moving: a,
                    length: first,
                },
                Dyad::Rr {
                    fixed: b0,
                    moving: b,
                    length: second,
                },
            ) => (apart(a0, b0, first + second) && apart(a, b, first + second)).then_some(
                Self::FourBar(FourBar {
                    fixed: [a0, b0],
                    moving: [a, b],
                    lengths: [first, second],
                }),
            ),
            (
                Dyad::Rr {
                    fixed,
                    moving,
                    length,
                },
                Dyad::Pr { guide, moving: pin },
            ) => apart(moving, pin, length).then_some(Self::SliderCrank(SliderCrank {
                fixed,
                crank: length,
                moving: [moving, pin],
                guide,
            })),
            (
                Dyad::Rr {
                    fixed,
                    moving,
                    length,
                },
                Dyad::Rp { fixed: pin, guide },
            ) => apart(fixed, pin, length).then_some(Self::InvertedSliderCrank(
                InvertedSliderCrank {
                    fixed: [fixed, pin],
                    crank: length,
                    moving,
                    guide,
                },
            )),
            (_, Dyad::Rr { .. }) => Self::of(second, first),
            _ => (first != second).then_some(Self::TwoSliders(first, second)),
        }
    }
}

/// All linkages of pairs of dyads, each pair once, in the dyads' order.
pub fn pairs(dyads: &[Dyad]) -> Vec<Linkage> {
    let mut found = Vec::new();
    for (k, first) in dyads.iter().enumerate() {
        for second in &dyads[k + 1..] {
            found.extend(Linkage::of(*first, *second));
        }
    }
    found
}
