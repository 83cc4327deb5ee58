//! Picking vector instructions at run time.
//!
//! The gain that pays for the `unsafe` calls, in ns per lane over `Lanes8` on a Xeon with AVX-512 (2026):
//!
//! | | baseline (SSE2) | AVX2 | AVX-512 |
//! |---|---|---|---|
//! | `sin_cos` (scalar 8.6) | 4.2 | 2.0 | 1.3 |
//! | crank and dyad: `sin_cos`, 2 roots, 3 quotients (scalar 13.4) | 7.1 | 3.7 | 3.6 |
//! | the same with `Jet<_, 4>` (scalar 48) | 22 | 16 | 15 |

use std::sync::atomic::{AtomicU8, Ordering};

/// Vector instructions the processor offers, in rising order. All give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
#[non_exhaustive]
pub enum InstructionSet {
    /// What the program is compiled for: SSE2 on x86-64, NEON on AArch64, `simd128` or nothing on WebAssembly.
    Baseline = 1,
    /// 256-bit registers (x86-64).
    Avx2 = 2,
    /// 512-bit registers (x86-64), with the AVX-512 F, DQ and VL instructions.
    Avx512 = 3,
}

impl InstructionSet {
    /// All of them, in rising order.
    pub const ALL: [Self; 3] = [Self::Baseline, Self::Avx2, Self::Avx512];

    /// The best set this processor has; asked once, then remembered.
    #[inline]
    pub fn detect() -> Self {
        static KNOWN: AtomicU8 = AtomicU8::new(0);
        match KNOWN.load(Ordering::Relaxed) {
            1 => Self::Baseline,
            2 => Self::Avx2,
            3 => Self::Avx512,
            _ => {
                let set = Self::ask();
                KNOWN.store(set as u8, Ordering::Relaxed);
                set
            }
        }
    }

    #[cfg(target_arch = "x86_64")]
    fn ask() -> Self {
        let avx2 = std::is_x86_feature_detected!("avx2");
        let avx512 = std::is_x86_feature_detected!("avx512f")
            && std::is_x86_feature_detected!("avx512dq")
            && std::is_x86_feature_detected!("avx512vl");
        match (avx2, avx512) {
            (true, true) => Self::Avx512,
            (true, false) => Self::Avx2,
            _ => Self::Baseline,
        }
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn ask() -> Self {
        Self::Baseline
    }
}

/// Compiles one function once per [`InstructionSet`] and picks the best version when it is called.
///
/// The function after `=` does the work. It and all it calls in its hot loops must be `#[inline(always)]`, so that
/// the loops over [`Lanes`](crate::Lanes) are compiled anew in each version. One call costs a load and a jump, so let
/// it do microseconds of work. When the first parameter is written `set: InstructionSet`, the caller chooses the
/// version (tests compare all of them); a set the processor lacks is lowered to what it has. Then another function of the same
/// results may stand in where there is no more than the baseline: `= wide, baseline = narrow;`.
///
/// # Example
/// ```
/// use kempe_number::{InstructionSet, Lanes8, Number, multiversion};
///
/// #[inline(always)]
/// fn sines_inner(angles: &[Lanes8], out: &mut [Lanes8]) {
///     for (x, y) in angles.iter().zip(out) {
///         *y = x.sin_cos().0;
///     }
/// }
///
/// multiversion! {
///     /// Sines of all `angles`.
///     pub fn sines(set: InstructionSet, angles: &[Lanes8], out: &mut [Lanes8]) = sines_inner;
/// }
///
/// let angles = [Lanes8::from_fn(|k| k as f64); 3];
/// let [mut best, mut plain] = [[Lanes8::default(); 3]; 2];
/// sines(InstructionSet::detect(), &angles, &mut best);
/// sines(InstructionSet::Baseline, &angles, &mut plain);
/// assert_eq!(best, plain);
/// ```
#[macro_export]
macro_rules! multiversion {
    (
        $(#[$attribute:meta])*
        $visibility:vis fn $name:ident(set: InstructionSet $(, $argument:ident: $type:ty)* $(,)?) $(-> $result:ty)?
            = $inner:path, baseline = $narrow:path;
    ) => {
        $(#[$attribute])*
        $visibility fn $name(set: $crate::InstructionSet $(, $argument: $type)*) $(-> $result)? {
            // Inlined nowhere, as the caller lacks the features, but compiled with it alone: where an inline one is called, if anywhere.
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2")]
            #[inline]
            fn avx512($($argument: $type),*) $(-> $result)? {
                $inner($($argument),*)
            }
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx2")]
            #[inline]
            fn avx2($($argument: $type),*) $(-> $result)? {
                $inner($($argument),*)
            }
            match set.min($crate::InstructionSet::detect()) {
                // SAFETY: `detect` has found the features this version is compiled for.
                #[cfg(target_arch = "x86_64")]
                #[allow(unsafe_code, reason = "calling code for detected features; see `InstructionSet`")]
                $crate::InstructionSet::Avx512 => unsafe { avx512($($argument),*) },
                // SAFETY: as above.
                #[cfg(target_arch = "x86_64")]
                #[allow(unsafe_code, reason = "calling code for detected features; see `InstructionSet`")]
                $crate::InstructionSet::Avx2 => unsafe { avx2($($argument),*) },
                _ => $narrow($($argument),*),
            }
        }
    };
    (
        $(#[$attribute:meta])*
        $visibility:vis fn $name:ident(set: InstructionSet $(, $argument:ident: $type:ty)* $(,)?) $(-> $result:ty)?
            = $inner:path;
    ) => {
        $crate::multiversion! {
            $(#[$attribute])*
            $visibility fn $name(set: InstructionSet $(, $argument: $type)*) $(-> $result)?
                = $inner, baseline = $inner;
        }
    };
    (
        $(#[$attribute:meta])*
        $visibility:vis fn $name:ident($($argument:ident: $type:ty),* $(,)?) $(-> $result:ty)? = $inner:path;
    ) => {
        $(#[$attribute])*
        $visibility fn $name($($argument: $type),*) $(-> $result)? {
            $crate::multiversion! {
                fn versions(set: InstructionSet $(, $argument: $type)*) $(-> $result)? = $inner;
            }
            versions($crate::InstructionSet::detect() $(, $argument)*)
        }
    };
}
