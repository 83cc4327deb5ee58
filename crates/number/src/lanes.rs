//! Several plain numbers side by side: the same formula for `W` designs or `W` instants at once.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::operators::assigning_operators;
use crate::{Number, math};

/// Does something for every lane. Written out where there are eight or sixteen: unrolling a loop for each operation takes the
/// compiler a tenth of the time that it needs for the whole program.
macro_rules! for_lanes {
    ($lanes:expr, $k:ident, $does:expr) => {
        if $lanes == 2 {
            for_lanes!(@ $k, $does, 0 1);
        } else if $lanes == 4 {
            for_lanes!(@ $k, $does, 0 1 2 3);
        } else if $lanes == 8 {
            for_lanes!(@ $k, $does, 0 1 2 3 4 5 6 7);
        } else if $lanes == 16 {
            for_lanes!(@ $k, $does, 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15);
        } else {
            for $k in 0..$lanes { $does; }
        }
    };
    (@ $k:ident, $does:expr, $($index:literal)*) => { $( { let $k: usize = $index; $does; } )* };
}

/// `W` independent `f64`s worked on together.
///
/// Every operation is the same for each lane, which the compiler turns into vector instructions of whatever
/// width the calling function is compiled for (see [`multiversion!`](crate::multiversion)). Lane k of a result has
/// exactly the bits that the scalar formula gives for lane k of the arguments.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Lanes<const W: usize>(pub [f64; W]);

/// Four lanes: one 256-bit register.
pub type Lanes4 = Lanes<4>;
/// Eight lanes: one 512-bit register, one cache line.
pub type Lanes8 = Lanes<8>;

impl<const W: usize> Lanes<W> {
    /// The number whose lane k is `f(k)`.
    #[inline(always)]
    pub fn from_fn(f: impl FnMut(usize) -> f64) -> Self {
        Self(std::array::from_fn(f))
    }

    /// The value in lane `k`.
    ///
    /// # Panics
    /// When `k >= W`.
    #[inline(always)]
    pub fn lane(&self, k: usize) -> f64 {
        self.0[k]
    }

    /// `P` lanes from the one with number `P * k` on. By value, so that they are read as what is known to lie at whole registers.
    ///
    /// ```
    /// use kempe_number::Lanes;
    /// let mut all = Lanes([1.0, 2.0, 3.0, 4.0]);
    /// assert_eq!(all.part::<2>(1), Lanes([3.0, 4.0]));
    /// all.set_part(0, Lanes([5.0, 6.0]));
    /// assert_eq!(all, Lanes([5.0, 6.0, 3.0, 4.0]));
    /// ```
    ///
    /// # Panics
    /// When there are not as many.
    #[inline(always)]
    pub fn part<const P: usize>(self, k: usize) -> Lanes<P> {
        Lanes(self.0.as_chunks::<P>().0[k])
    }

    /// Puts `P` lanes in the places of those from number `P * k` on.
    ///
    /// # Panics
    /// When there are not as many.
    #[inline(always)]
    pub fn set_part<const P: usize>(&mut self, k: usize, part: Lanes<P>) {
        self.0.as_chunks_mut::<P>().0[k] = part.0;
    }

    /// Applies `f` to every lane.
    #[inline(always)]
    fn each(mut self, f: impl Fn(f64) -> f64) -> Self {
        for_lanes!(W, k, self.0[k] = f(self.0[k]));
        self
    }

    /// Applies `f` to both arguments lane by lane.
    #[inline(always)]
    fn pairwise(mut self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        for_lanes!(W, k, self.0[k] = f(self.0[k], other.0[k]));
        self
    }
}

impl<const W: usize> Default for Lanes<W> {
    /// Zero in every lane.
    fn default() -> Self {
        Self([0.0; W])
    }
}

/// Implements the operators between two lane numbers and with one `f64`.
macro_rules! lane_operators {
    ($($trait:ident $method:ident $operator:tt;)*) => {$(
        impl<const W: usize> $trait for Lanes<W> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.pairwise(other, |a, b| a $operator b)
            }
        }
    )*};
}

lane_operators! {
    Add add +;
    Sub sub -;
    Mul mul *;
    Div div /;
}

/// Implements the operators with one `f64` for all lanes (`Sub<f64>` comes from `assigning_operators!`).
macro_rules! lane_scalar_operators {
    ($($trait:ident $method:ident $operator:tt;)*) => {$(
        impl<const W: usize> $trait<f64> for Lanes<W> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                self.each(|a| a $operator other)
            }
        }
    )*};
}

lane_scalar_operators! {
    Add add +;
    Mul mul *;
    Div div /;
}

impl<const W: usize> Neg for Lanes<W> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.each(|a| -a)
    }
}

assigning_operators!([const W: usize] Lanes<W>);

impl<const W: usize> Number for Lanes<W> {
    const LANE_COUNT: usize = W;

    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        Self([x; W])
    }

    /// The first lane.
    #[inline(always)]
    fn value(self) -> f64 {
        self.0[0]
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.each(f64::sqrt)
    }

    /// All lanes through the vector code; if any lane is beyond [`math::SIN_COS_LIMIT`], one lane at a time.
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let mut near = true;
        for k in 0..W {
            near &= self.0[k].abs() <= math::SIN_COS_LIMIT;
        }
        if !near {
            return one_by_one(self.0);
        }
        let (mut sin, mut cos) = (self, self);
        for k in 0..W {
            (sin.0[k], cos.0[k]) = math::sin_cos_core(self.0[k]);
        }
        (sin, cos)
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        self.pairwise(x, math::atan2)
    }

    #[inline(always)]
    fn exp(self) -> Self {
        self.each(math::exp)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        self.each(math::ln)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.each(f64::abs)
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.pairwise(other, math::min)
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.pairwise(other, math::max)
    }

    #[inline(always)]
    fn choose(mut self, nonnegative: Self, negative: Self) -> Self {
        for k in 0..W {
            self.0[k] = self.0[k].choose(nonnegative.0[k], negative.0[k]);
        }
        self
    }

    #[inline(always)]
    fn nonnegative(self) -> Option<bool> {
        let (mut all, mut none) = (true, true);
        for k in 0..W {
            all &= self.0[k] >= 0.0;
            none &= self.0[k] < 0.0;
        }
        (all || none).then_some(all)
    }

    #[inline(always)]
    fn constant_part(self) -> Self {
        self
    }

    #[inline(always)]
    fn floor(self) -> Self {
        self.each(f64::floor)
    }

    #[inline(always)]
    fn is_finite(self) -> bool {
        let mut finite = true;
        for k in 0..W {
            finite &= self.0[k].is_finite();
        }
        finite
    }
}

/// The rare path of `sin_cos`, kept out of the caller's code; by value, so that the caller's lanes stay in registers.
#[cold]
#[inline(never)]
fn one_by_one<const W: usize>(x: [f64; W]) -> (Lanes<W>, Lanes<W>) {
    let both = x.map(math::sin_cos);
    (
        Lanes(both.map(|(sin, _)| sin)),
        Lanes(both.map(|(_, cos)| cos)),
    )
}
