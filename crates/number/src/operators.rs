//! Operators every number kind derives from a few basic ones.

/// Implements the assigning operators from the plain ones, and `Sub<f64>` from `Add<f64>`.
macro_rules! assigning_operators {
    ([$($generics:tt)*] $type:ty) => {
        impl<$($generics)*> std::ops::Sub<f64> for $type {
            type Output = Self;
            #[inline(always)]
            fn sub(self, other: f64) -> Self {
                self + (-other)
            }
        }
        impl<$($generics)*> std::ops::AddAssign for $type {
            #[inline(always)]
            fn add_assign(&mut self, other: Self) {
                *self = *self + other;
            }
        }
        impl<$($generics)*> std::ops::SubAssign for $type {
            #[inline(always)]
            fn sub_assign(&mut self, other: Self) {
                *self = *self - other;
            }
        }
        impl<$($generics)*> std::ops::MulAssign for $type {
            #[inline(always)]
            fn mul_assign(&mut self, other: Self) {
                *self = *self * other;
            }
        }
    };
}
pub(crate) use assigning_operators;
