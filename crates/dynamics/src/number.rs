//! The numbers on which forces are computed.

use kempe_number::{Dual, Interval, Jet, Lanes, Number};

use crate::sliding_sense;

/// A number on which forces can be computed.
///
/// What has to branch (friction, whether a pose is singular) is decided on plain numbers: for every lane by itself, so that
/// each gives what it would give alone. Numbers that are not in lanes have one lane.
pub trait ForceNumber: Number {
    /// This number without its derivatives.
    type Plain: PlainNumber;
    /// This number in one of its lanes, derivatives included.
    type InLane: Number;

    /// Passes of refinement after which a linear solve with the plain matrix is exact in every coefficient and derivative.
    const PASSES: usize;
    /// Coefficients of the series that it is.
    const ORDER: usize = 1;

    /// A coefficient without its derivatives.
    fn coefficient_of(self, order: usize) -> Self::Plain;

    /// This number with so much more in a coefficient.
    #[must_use]
    fn plus(self, order: usize, more: Self::Plain) -> Self;

    /// So many times this number.
    #[must_use]
    fn times(self, factor: Self::Plain) -> Self;

    /// What is in a lane.
    fn in_lane(self, lane: usize) -> Self::InLane;

    /// This number with something else in a lane.
    #[must_use]
    fn with_lane(self, lane: usize, value: Self::InLane) -> Self;

    /// This number, with parts that are not known (NaN, or without bounds) taken from another.
    #[must_use]
    fn completed(self, other: Self) -> Self;

    /// The value without derivatives.
    #[inline(always)]
    fn plain(self) -> Self::Plain {
        self.coefficient_of(0)
    }

    /// The plain value in a lane; of an interval its midpoint.
    #[inline(always)]
    fn value_in(self, lane: usize) -> f64 {
        self.plain().lane_value(lane)
    }

    /// Whether the plain value of some lane is like this.
    #[inline]
    fn any_lane(self, is_so: impl Fn(f64) -> bool) -> bool {
        (0..Self::Plain::LANES).any(|lane| is_so(self.value_in(lane)))
    }
}

/// A number without derivatives on which forces can be computed.
pub trait PlainNumber: ForceNumber<Plain = Self> {
    /// How many lanes it has.
    const LANES: usize;
    /// Whether it is bounds: what is asked of it is proved then.
    const BOUNDS: bool = false;

    /// The plain value in a lane; of an interval its midpoint.
    fn lane_value(self, lane: usize) -> f64;

    /// The number with these plain values in its lanes.
    fn of_lanes(value: impl FnMut(usize) -> f64) -> Self;

    /// A rising function of it.
    #[must_use]
    fn rising(self, function: impl Fn(f64) -> f64) -> Self;

    /// The larger of two numbers, or the one that is known.
    #[must_use]
    fn larger(self, other: Self) -> Self;

    /// The sense of a speed, see [`direction`](crate::friction::direction); an interval that is not of one sense gives all from -1 to 1.
    #[must_use]
    fn direction(self, acceleration: Self, still: [Self; 2]) -> Self;

    /// An interval that holds it in every lane.
    fn bounds(self) -> Interval {
        let lanes = (0..Self::LANES).map(|lane| Interval::from_f64(self.lane_value(lane)));
        lanes.fold(Interval::EMPTY, Interval::hull)
    }

    /// The number with these bounds: in every lane their midpoint, where it is none of bounds itself.
    fn of_bounds(bounds: Interval) -> Self {
        Self::of_lanes(|_| bounds.midpoint())
    }
}

/// What a number that is its own lane and has one coefficient says of itself.
macro_rules! of_one {
    ($plain:ty) => {
        type Plain = $plain;
        type InLane = Self;

        #[inline(always)]
        fn plus(self, _: usize, more: $plain) -> Self {
            self + more
        }

        #[inline(always)]
        fn times(self, factor: $plain) -> Self {
            self * factor
        }

        #[inline(always)]
        fn in_lane(self, _: usize) -> Self {
            self
        }

        #[inline(always)]
        fn with_lane(self, _: usize, value: Self) -> Self {
            value
        }
    };
}

impl ForceNumber for f64 {
    of_one!(f64);

    const PASSES: usize = 1;

    #[inline(always)]
    fn coefficient_of(self, _: usize) -> f64 {
        self
    }

    #[inline(always)]
    fn completed(self, other: Self) -> Self {
        if self.is_nan() { other } else { self }
    }
}

impl<const K: usize> ForceNumber for Dual<f64, K> {
    of_one!(f64);

    const PASSES: usize = 2;

    #[inline(always)]
    fn coefficient_of(self, _: usize) -> f64 {
        self.re
    }

    #[inline(always)]
    fn completed(self, other: Self) -> Self {
        if self.is_finite() { self } else { other }
    }
}

impl ForceNumber for Interval {
    of_one!(Interval);

    const PASSES: usize = 1;

    #[inline(always)]
    fn coefficient_of(self, _: usize) -> Self {
        self
    }

    /// The narrower one: both are bounds.
    #[inline]
    fn completed(self, other: Self) -> Self {
        let wider = self.is_empty() || other.width() < self.width();
        if wider { other } else { self }
    }
}

impl<const W: usize> ForceNumber for Lanes<W> {
    type Plain = Self;
    type InLane = f64;

    const PASSES: usize = 1;

    #[inline(always)]
    fn coefficient_of(self, _: usize) -> Self {
        self
    }

    #[inline(always)]
    fn plus(self, _: usize, more: Self) -> Self {
        self + more
    }

    #[inline(always)]
    fn times(self, factor: Self) -> Self {
        self * factor
    }

    #[inline(always)]
    fn in_lane(self, lane: usize) -> f64 {
        self.0[lane]
    }

    #[inline(always)]
    fn with_lane(mut self, lane: usize, value: f64) -> Self {
        self.0[lane] = value;
        self
    }

    #[inline(always)]
    fn completed(self, other: Self) -> Self {
        Self::from_fn(|k| self.0[k].completed(other.0[k]))
    }
}

impl<B: ForceNumber, const N: usize> ForceNumber for Jet<B, N> {
    type Plain = B::Plain;
    type InLane = Jet<B::InLane, N>;

    const PASSES: usize = N + B::PASSES - 1;
    const ORDER: usize = N;

    #[inline(always)]
    fn coefficient_of(self, order: usize) -> B::Plain {
        self.coefficient(order).plain()
    }

    #[inline(always)]
    fn plus(self, order: usize, more: B::Plain) -> Self {
        let mut coefficients = *self.coefficients();
        coefficients[order] = coefficients[order].plus(0, more);
        Self::from_coefficients(coefficients)
    }

    #[inline(always)]
    fn times(self, factor: B::Plain) -> Self {
        Self::from_coefficients(self.coefficients().map(|c| c.times(factor)))
    }

    #[inline(always)]
    fn in_lane(self, lane: usize) -> Self::InLane {
        Jet::from_coefficients(self.coefficients().map(|c| c.in_lane(lane)))
    }

    #[inline(always)]
    fn with_lane(self, lane: usize, value: Self::InLane) -> Self {
        Self::from_coefficients(std::array::from_fn(|k| {
            self.coefficient(k).with_lane(lane, value.coefficient(k))
        }))
    }

    #[inline(always)]
    fn completed(self, other: Self) -> Self {
        Self::from_coefficients(std::array::from_fn(|k| {
            self.coefficient(k).completed(other.coefficient(k))
        }))
    }
}

impl PlainNumber for f64 {
    const LANES: usize = 1;

    #[inline(always)]
    fn lane_value(self, _: usize) -> f64 {
        self
    }

    #[inline(always)]
    fn of_lanes(mut value: impl FnMut(usize) -> f64) -> Self {
        value(0)
    }

    #[inline(always)]
    fn rising(self, function: impl Fn(f64) -> f64) -> Self {
        function(self)
    }

    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        f64::max(self, other)
    }

    #[inline(always)]
    fn direction(self, acceleration: Self, still: [Self; 2]) -> Self {
        sliding_sense::direction(self, acceleration, still)
    }
}

impl<const W: usize> PlainNumber for Lanes<W> {
    const LANES: usize = W;

    #[inline(always)]
    fn lane_value(self, lane: usize) -> f64 {
        self.0[lane]
    }

    #[inline(always)]
    fn of_lanes(value: impl FnMut(usize) -> f64) -> Self {
        Self::from_fn(value)
    }

    #[inline(always)]
    fn rising(self, function: impl Fn(f64) -> f64) -> Self {
        Self(self.0.map(function))
    }

    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Self::from_fn(|k| f64::max(self.0[k], other.0[k]))
    }

    #[inline(always)]
    fn direction(self, acceleration: Self, still: [Self; 2]) -> Self {
        Self::from_fn(|k| {
            sliding_sense::direction(self.0[k], acceleration.0[k], still.map(|s| s.0[k]))
        })
    }
}

impl PlainNumber for Interval {
    const LANES: usize = 1;
    const BOUNDS: bool = true;

    #[inline(always)]
    fn lane_value(self, _: usize) -> f64 {
        self.midpoint()
    }

    #[inline(always)]
    fn of_lanes(mut value: impl FnMut(usize) -> f64) -> Self {
        Self::from_f64(value(0))
    }

    #[inline]
    fn rising(self, function: impl Fn(f64) -> f64) -> Self {
        Self::new(function(self.lo()), function(self.hi()))
    }

    #[inline]
    fn larger(self, other: Self) -> Self {
        Self::new(
            f64::max(self.lo(), other.lo()),
            f64::max(self.hi(), other.hi()),
        )
    }

    fn direction(self, acceleration: Self, still: [Self; 2]) -> Self {
        sliding_sense::directions(self, acceleration, still)
    }

    fn bounds(self) -> Interval {
        self
    }

    fn of_bounds(bounds: Interval) -> Self {
        bounds
    }
}
