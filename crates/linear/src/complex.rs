//! Small dense complex systems that are solved once, for all their right-hand sides together; [`Lu`](crate::Lu) keeps factors.

use kempe_number::Complex;

/// A complex number.
pub type C = Complex<f64>;

/// Solves `a x = b` in place for several right-hand sides, the columns of `b`, by Gaussian elimination with partial
/// pivoting; `a` is row-major, `n` by `n`. Returns false when a pivot vanishes.
pub fn solve_complex<const M: usize>(a: &mut [C], b: &mut [[C; M]], n: usize) -> bool {
    // The sizes of the commonest groups, unrolled.
    match n {
        4 => solve_sized(a, b, 4),
        6 => solve_sized(a, b, 6),
        n => solve_sized(a, b, n),
    }
}

#[inline(always)]
fn solve_sized<const M: usize>(a: &mut [C], b: &mut [[C; M]], n: usize) -> bool {
    let (a, b) = (&mut a[..n * n], &mut b[..n]);
    for k in 0..n {
        let (mut pivot, mut largest) = (k, -1.0);
        for i in k..n {
            let size = a[i * n + k].norm_sqr();
            if size >= largest {
                (pivot, largest) = (i, size);
            }
        }
        if !(largest > f64::MIN_POSITIVE) {
            return false;
        }
        if pivot != k {
            for j in k..n {
                a.swap(pivot * n + j, k * n + j);
            }
            b.swap(pivot, k);
        }
        let inverse = a[k * n + k].recip();
        let (above, below) = a.split_at_mut((k + 1) * n);
        let row = &above[k * n..];
        let (done, left) = b.split_at_mut(k + 1);
        for (other, rest) in below.chunks_exact_mut(n).zip(left) {
            if other[k].norm_sqr() == 0.0 {
                continue;
            }
            let factor = other[k] * inverse;
            for j in k + 1..n {
                other[j] -= factor * row[j];
            }
            for (rest, known) in rest.iter_mut().zip(&done[k]) {
                *rest -= factor * *known;
            }
        }
    }
    for k in (0..n).rev() {
        let inverse = a[k * n + k].recip();
        for m in 0..M {
            let mut sum = b[k][m];
            for j in k + 1..n {
                sum -= a[k * n + j] * b[j][m];
            }
            b[k][m] = sum * inverse;
        }
    }
    b.iter().flatten().all(|x| x.is_finite())
}
