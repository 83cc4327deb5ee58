//! Crank-rockers and slider-cranks by how far they go and how much faster they come back.
//!
//! In the dead centres crank and coupler are in line, so the crank's pivot sees the ends of the stroke under the angle by which the crank turns
//! more than half a turn one way and less the other. With a stroke of chord S, seen under the angle t at the distances b + a and b - a:
//! S^2 = 4 (a^2 cos^2(t/2) + b^2 sin^2(t/2)).

use std::f64::consts::PI;

use kempe_linear::C;
use kempe_number::math;

use crate::error::SynthesisError;
use crate::four_bar::{FourBar, Grashof, Turning};
use crate::pose::Line;
use crate::slider_crank::SliderCrank;

/// The angle, rad, by which a crank's turn one way exceeds half a turn, where the way there takes so many times the way back:
/// pi (ratio - 1) / (ratio + 1).
pub fn imbalance(time_ratio: f64) -> f64 {
    PI * (time_ratio - 1.0) / (time_ratio + 1.0)
}

/// The time of the slower way over that of the quicker, with a crank that turns evenly, for an imbalance in rad.
pub fn time_ratio(imbalance: f64) -> f64 {
    (PI + imbalance) / (PI - imbalance)
}

/// Lengths of a crank-rocker, in units of the rocker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrankRocker {
    /// The frame.
    pub frame: f64,
    /// The crank.
    pub crank: f64,
    /// The coupler.
    pub coupler: f64,
}

impl CrankRocker {
    /// The four-bar with the crank first, its pivot at 0, the rocker of length 1.
    pub fn four_bar(&self) -> FourBar {
        FourBar {
            fixed: [C::zero(), C::from(self.frame)],
            moving: [C::zero(), C::from(self.coupler)],
            lengths: [self.crank, 1.0],
        }
    }

    /// How far the transmission angle stays from 0 and pi, rad.
    pub fn transmission(&self) -> f64 {
        let [low, high] = self
            .four_bar()
            .transmission_range(0.0, std::f64::consts::TAU);
        math::min(low, PI - high)
    }
}

/// Chord, crank and the crank pivot's distances, of a stroke of this chord; `None` where no crank is left.
fn crank_of(chord: f64, imbalance: f64, coupler: f64) -> Option<f64> {
    let (s, c) = math::sin_cos(0.5 * imbalance);
    let square = (0.25 * chord * chord - coupler * coupler * s * s) / (c * c);
    let crank = math::max(square, 0.0).sqrt();
    (square > 0.0 && crank < coupler).then_some(crank)
}

/// Angles of a swing and an imbalance that can be.
fn within(datum: usize, value: f64, least: f64, most: f64) -> Result<(), SynthesisError> {
    if !value.is_finite() {
        return Err(SynthesisError::NotFinite { datum });
    }
    if !(value >= least && value <= most) {
        return Err(SynthesisError::OutOfRange {
            datum,
            value,
            least,
            most,
        });
    }
    Ok(())
}

/// Swings and imbalances, rad, this near to none or to half a turn leave no linkage.
const MARGIN: f64 = 1e-9;

/// Crank-rockers whose rocker swings by an angle (rad) with an imbalance (rad, 0 for equal times, see [`imbalance`]), with a coupler of this
/// length in units of the rocker: none, one or two, one for each sense in which the crank may go round as the rocker goes the slower
/// way.
///
/// # Errors
/// A swing (datum 0) not between 0 and half a turn, an imbalance (1) not from 0 to half a turn, a coupler (2) not positive.
pub fn crank_rockers(
    swing: f64,
    imbalance: f64,
    coupler: f64,
) -> Result<Vec<CrankRocker>, SynthesisError> {
    within(0, swing, MARGIN, PI - MARGIN)?;
    within(1, imbalance, 0.0, PI - MARGIN)?;
    within(2, coupler, f64::MIN_POSITIVE, f64::MAX)?;
    let half = math::sin(0.5 * swing);
    let Some(crank) = crank_of(2.0 * half, imbalance, coupler) else {
        return Ok(Vec::new());
    };
    // The rocker's pivot at 0, the chord at x = cos(swing / 2) from y = -half to half; the crank's pivot at b + a from the upper end.
    let along = math::cos(0.5 * swing);
    let y = -coupler * crank / half;
    let square = (coupler + crank) * (coupler + crank) - (half - y) * (half - y);
    let beside = math::max(square, 0.0).sqrt();
    let sides: &[f64] = if beside > MARGIN {
        &[1.0, -1.0]
    } else {
        &[0.0]
    };
    let found = sides.iter().map(|side| CrankRocker {
        frame: math::hypot(along + side * beside, y),
        crank,
        coupler,
    });
    // The ends of the stroke may lie on different sides of the frame: then these are dead centres of different assemblies.
    Ok(found.filter(|rocker| keeps(rocker, swing)).collect())
}

/// A swing found from the lengths agrees to this, rad: its cosine is rounded.
const SAME_SWING: f64 = 1e-6;

fn keeps(rocker: &CrankRocker, swing: f64) -> bool {
    let bar = rocker.four_bar();
    let swings = match bar.exchanged().turning(1.0) {
        Turning::Crank => f64::INFINITY,
        Turning::Rocker { half, .. } => 2.0 * half,
    };
    bar.grashof() == Grashof::Grashof
        && bar.turning(0.0) == Turning::Crank
        && (swings - swing).abs() < SAME_SWING
}

/// The crank-rocker of a swing and an imbalance, rad, whose transmission angle stays furthest from 0 and pi; with a coupler of
/// [`LONGEST_COUPLER`] rockers where longer ones are ever better, as with equal times.
///
/// # Errors
/// As of [`crank_rockers`], and [`SynthesisError::None`] where there is none.
pub fn best_crank_rocker(swing: f64, imbalance: f64) -> Result<CrankRocker, SynthesisError> {
    let chord = 2.0 * math::sin(0.5 * swing);
    // From a coupler as long as the crank to one with none, or so long that nothing changes.
    let longest = math::min(0.5 * chord / math::sin(0.5 * imbalance), LONGEST_COUPLER);
    crank_rockers(swing, imbalance, longest)?;
    let worth = |coupler: f64| {
        let found = crank_rockers(swing, imbalance, coupler).unwrap_or_default();
        let with = found.into_iter().map(|r| (r.transmission(), r));
        with.max_by(|a, b| a.0.total_cmp(&b.0))
    };
    largest(0.5 * chord, longest, worth).ok_or(SynthesisError::None)
}

/// The longest coupler among which the best is looked for, in units of the rocker or of the stroke: longer ones change hardly anything more.
pub const LONGEST_COUPLER: f64 = 50.0;
/// Samples in which the best is looked for, and golden sections then.
const SAMPLES: usize = 400;
const SECTIONS: usize = 80;
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The linkage of the largest worth between two lengths.
fn largest<T>(low: f64, high: f64, worth: impl Fn(f64) -> Option<(f64, T)>) -> Option<T> {
    // Evenly in the logarithm.
    let (from, over) = (math::ln(low), math::ln(high / low));
    let at = |part: f64| worth(math::exp(from + over * part));
    let value = |part: f64| at(part).map_or(f64::NEG_INFINITY, |(value, _)| value);
    let step = 1.0 / SAMPLES as f64;
    let best = (1..SAMPLES)
        .map(|k| k as f64 * step)
        .max_by(|p, q| value(*p).total_cmp(&value(*q)))?;
    let (mut low, mut high) = (best - step, best + step);
    for _ in 0..SECTIONS {
        let (p, q) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
        if value(p) > value(q) {
            high = q;
        } else {
            low = p;
        }
    }
    let middle = 0.5 * (low + high);
    let place = if value(middle) >= value(best) {
        middle
    } else {
        best
    };
    at(place).map(|(_, found)| found)
}

/// What of a slider-crank is chosen besides stroke and imbalance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SliderCrankChoice {
    /// The coupler's length.
    Coupler(f64),
    /// How far the guide passes beside the crank's pivot.
    Offset(f64),
}

/// Lengths of an offset slider-crank.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokeSliderCrank {
    /// The crank.
    pub crank: f64,
    /// The coupler.
    pub coupler: f64,
    /// How far the guide passes beside the crank's pivot.
    pub offset: f64,
}

impl StrokeSliderCrank {
    /// The slider-crank with its pivot at 0 and its guide along the first axis; the coupler lies along its own first axis.
    pub fn slider_crank(&self) -> SliderCrank {
        SliderCrank {
            fixed: C::zero(),
            crank: self.crank,
            moving: [C::zero(), C::from(self.coupler)],
            guide: Line {
                point: C::new(0.0, self.offset),
                direction: C::one(),
            },
        }
    }

    /// How far the angle between coupler and the guide's normal stays from 0 and pi, rad.
    pub fn transmission(&self) -> f64 {
        math::acos(math::min((self.offset + self.crank) / self.coupler, 1.0))
    }
}

/// The slider-crank of a stroke and an imbalance (rad), with its coupler or its offset chosen.
///
/// # Errors
/// A stroke (datum 0) or a choice (2) that is not positive (an offset may be 0 where the imbalance is, and only there), an imbalance (1)
/// not from 0 to half a turn; [`SynthesisError::None`] where the crank cannot turn fully.
pub fn stroke_slider_crank(
    stroke: f64,
    imbalance: f64,
    choice: SliderCrankChoice,
) -> Result<StrokeSliderCrank, SynthesisError> {
    within(0, stroke, f64::MIN_POSITIVE, f64::MAX)?;
    within(1, imbalance, 0.0, PI - MARGIN)?;
    let sine = math::sin(imbalance);
    let coupler = match choice {
        SliderCrankChoice::Coupler(coupler) => coupler,
        SliderCrankChoice::Offset(offset) => {
            // b^2 - a^2 = h S / sin t, and the sum of squares above.
            within(2, offset, 0.0, f64::MAX)?;
            if sine == 0.0 {
                return Err(SynthesisError::Dependent { datum: 2 });
            }
            let c = math::cos(0.5 * imbalance);
            (c * c * offset * stroke / sine + 0.25 * stroke * stroke).sqrt()
        }
    };
    within(2, coupler, f64::MIN_POSITIVE, f64::MAX)?;
    let crank = crank_of(stroke, imbalance, coupler).ok_or(SynthesisError::None)?;
    let found = StrokeSliderCrank {
        crank,
        coupler,
        offset: (coupler + crank) * (coupler - crank) * sine / stroke,
    };
    // Both ends of the stroke on one side of where the guide is nearest.
    if found.coupler > found.crank + found.offset {
        Ok(found)
    } else {
        Err(SynthesisError::None)
    }
}

/// The slider-crank of a stroke and an imbalance (rad) whose transmission angle stays furthest from 0 and pi; with a coupler
/// of [`LONGEST_COUPLER`] strokes where longer ones are ever better, as with equal times.
///
/// # Errors
/// As of [`stroke_slider_crank`].
pub fn best_stroke_slider_crank(
    stroke: f64,
    imbalance: f64,
) -> Result<StrokeSliderCrank, SynthesisError> {
    within(0, stroke, f64::MIN_POSITIVE, f64::MAX)?;
    within(1, imbalance, 0.0, PI - MARGIN)?;
    let longest = math::min(0.5 / math::sin(0.5 * imbalance), LONGEST_COUPLER) * stroke;
    let worth = |coupler: f64| {
        let found =
            stroke_slider_crank(stroke, imbalance, SliderCrankChoice::Coupler(coupler)).ok()?;
        Some((found.transmission(), found))
    };
    largest(0.5 * stroke, longest, worth).ok_or(SynthesisError::None)
}
