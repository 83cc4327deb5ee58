//! Elementary functions of `f64`, the same bits on every target.
//!
//! The standard library's functions call whatever the platform offers and so differ in the last bit between a
//! native build and WebAssembly. Everything here is either plain IEEE arithmetic written out ([`sin_cos`], [`min`],
//! [`max`]) or a call to the `libm` crate, which is. No function uses a fused multiply-add.

use std::f64::consts::TAU;

/// Largest |x| in rad for which [`sin_cos`] uses Kempe's own reduction; beyond it `libm`'s exact (and slow) one.
///
/// At 1e5 the quotient x / (pi/2) needs 16 bits, which is what the split of pi/2 below leaves room for.
pub const SIN_COS_LIMIT: f64 = 1e5;

/// pi/2 in three parts of 37, 36 and 53 bits: a 16-bit integer times each of the first two is exact.
const HALF_PI_HIGH: f64 = f64::from_bits(0x3FF9_21FB_5444_0000);
const HALF_PI_MIDDLE: f64 = f64::from_bits(0x3D86_8C23_4C4C_0000);
const HALF_PI_LOW: f64 = f64::from_bits(0x3B29_8A2E_0370_7345);
/// Adding and subtracting 1.5 * 2^52 rounds to the nearest integer and leaves it in the low bits of the sum.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// Sine and cosine of `x` rad; NaN for infinities and NaN.
///
/// Within 1 ulp of the exact values (0.76 observed over 40 000 arguments; hard ones in `tests/all/sin_cos.rs`). The same steps run in
/// [`Lanes`](crate::Lanes), so scalar and lanes agree bit for bit.
#[inline(always)]
pub fn sin_cos(x: f64) -> (f64, f64) {
    if x.abs() <= SIN_COS_LIMIT {
        sin_cos_core(x)
    } else {
        sin_cos_far(x)
    }
}

/// Arguments beyond [`SIN_COS_LIMIT`]: rare, so kept out of the caller's code.
#[cold]
#[inline(never)]
fn sin_cos_far(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

/// Sine and cosine for |x| <= [`SIN_COS_LIMIT`], without a branch, so that a loop over it becomes vector code.
///
/// x = n pi/2 + (r + tail) with |r| <= pi/4 (Cody and Waite 1980, ch. 8, with the tail kept), then the minimax
/// polynomials of FreeBSD's msun `k_sin.c` and `k_cos.c` (Sun Microsystems 1993), then the quadrant n mod 4 swaps
/// and negates by bit masks. Outside the limit the result is meaningless.
#[inline(always)]
pub(crate) fn sin_cos_core(x: f64) -> (f64, f64) {
    let shifted = x * std::f64::consts::FRAC_2_PI + ROUND;
    let quadrant = shifted.to_bits();
    let n = shifted - ROUND;

    // Both products and the first difference are exact; the tail holds the rounding of the second and the third part.
    let first = x - n * HALF_PI_HIGH;
    let middle = n * HALF_PI_MIDDLE;
    let r = first - middle;
    let tail = ((first - r) - middle) - n * HALF_PI_LOW;

    let (sine, cosine) = (sin_kernel(r, tail), cos_kernel(r, tail));
    let swap = 0_u64.wrapping_sub(quadrant & 1);
    let (s, c) = (sine.to_bits(), cosine.to_bits());
    let difference = (s ^ c) & swap;
    let s = (s ^ difference) ^ ((quadrant & 2) << 62);
    let c = (c ^ difference) ^ ((quadrant.wrapping_add(1) & 2) << 62);
    (f64::from_bits(s), f64::from_bits(c))
}

/// sin(x + y) for |x| <= pi/4 and a tail |y| < 2^-53 (msun `k_sin.c`).
#[allow(clippy::excessive_precision, reason = "printed as in the source")]
#[inline(always)]
fn sin_kernel(x: f64, y: f64) -> f64 {
    const S1: f64 = -1.666_666_666_666_663_243_48e-1;
    const S2: f64 = 8.333_333_333_322_489_461_24e-3;
    const S3: f64 = -1.984_126_982_985_794_931_34e-4;
    const S4: f64 = 2.755_731_370_707_006_767_89e-6;
    const S5: f64 = -2.505_076_025_340_686_341_95e-8;
    const S6: f64 = 1.589_690_995_211_550_102_21e-10;
    let z = x * x;
    let w = z * z;
    let r = S2 + z * (S3 + z * S4) + z * w * (S5 + z * S6);
    let v = z * x;
    x - ((z * (0.5 * y - v * r) - y) - v * S1)
}

/// cos(x + y) for |x| <= pi/4 and a tail |y| < 2^-53 (msun `k_cos.c`).
#[allow(clippy::excessive_precision, reason = "printed as in the source")]
#[inline(always)]
fn cos_kernel(x: f64, y: f64) -> f64 {
    const C1: f64 = 4.166_666_666_666_660_190_37e-2;
    const C2: f64 = -1.388_888_888_887_410_957_49e-3;
    const C3: f64 = 2.480_158_728_947_672_941_78e-5;
    const C4: f64 = -2.755_731_435_139_066_330_35e-7;
    const C5: f64 = 2.087_572_321_298_174_827_90e-9;
    const C6: f64 = -1.135_964_755_778_819_482_65e-11;
    let z = x * x;
    let w = z * z;
    let r = z * (C1 + z * (C2 + z * C3)) + w * w * (C4 + z * (C5 + z * C6));
    let half = 0.5 * z;
    let w = 1.0 - half;
    w + (((1.0 - w) - half) + (z * r - x * y))
}

/// Sine of `x` rad: the first half of [`sin_cos`].
#[inline]
pub fn sin(x: f64) -> f64 {
    sin_cos(x).0
}

/// Cosine of `x` rad: the second half of [`sin_cos`].
#[inline]
pub fn cos(x: f64) -> f64 {
    sin_cos(x).1
}

/// The smaller of two numbers, NaN if either is (`f64::min` would drop the NaN); `b` when they are equal.
#[inline(always)]
pub fn min(a: f64, b: f64) -> f64 {
    if a < b || a.is_nan() { a } else { b }
}

/// The larger of two numbers, NaN if either is (`f64::max` would drop the NaN); `b` when they are equal.
#[inline(always)]
pub fn max(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}

/// Angle of the vector (`x`, `y`) in rad, in [-pi, pi]; -pi only for y = -0 and x < 0.
#[inline]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// An angle less whole turns, rad, from -pi to pi.
#[inline]
pub fn within_half_a_turn(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

/// Length of the vector (`x`, `y`) without intermediate overflow.
#[inline]
pub fn hypot(x: f64, y: f64) -> f64 {
    libm::hypot(x, y)
}

/// `x` to the power `y`.
#[inline]
pub fn powf(x: f64, y: f64) -> f64 {
    libm::pow(x, y)
}

/// Declares one-argument functions that pass through to `libm`.
macro_rules! from_libm {
    ($($(#[$doc:meta])* $name:ident = $libm:ident;)*) => {
        $($(#[$doc])* #[inline] pub fn $name(x: f64) -> f64 { libm::$libm(x) })*
    };
}

from_libm! {
    /// Tangent of `x` rad.
    tan = tan;
    /// Arc sine in rad, in [-pi/2, pi/2]; NaN outside [-1, 1].
    asin = asin;
    /// Arc cosine in rad, in [0, pi]; NaN outside [-1, 1].
    acos = acos;
    /// Arc tangent in rad, in [-pi/2, pi/2].
    atan = atan;
    /// Hyperbolic sine.
    sinh = sinh;
    /// Hyperbolic cosine.
    cosh = cosh;
    /// Hyperbolic tangent.
    tanh = tanh;
    /// Inverse hyperbolic sine.
    asinh = asinh;
    /// Inverse hyperbolic cosine; NaN below 1.
    acosh = acosh;
    /// Inverse hyperbolic tangent; NaN outside [-1, 1].
    atanh = atanh;
    /// e to the power `x`.
    exp = exp;
    /// 2 to the power `x`.
    exp2 = exp2;
    /// e to the power `x`, minus 1, accurate near zero.
    exp_m1 = expm1;
    /// Natural logarithm; NaN below zero, -inf at zero.
    ln = log;
    /// Natural logarithm of 1 + `x`, accurate near zero.
    ln_1p = log1p;
    /// Logarithm to base 2.
    log2 = log2;
    /// Logarithm to base 10.
    log10 = log10;
    /// Cube root, negative for negative `x`.
    cbrt = cbrt;
}
