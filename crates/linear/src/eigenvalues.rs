//! The eigenvalues of a real matrix that need not be symmetric.
//!
//! By the QR method with double shifts of J. G. F. Francis (1961), on the matrix reduced to Hessenberg form by elimination, as
//! in B. T. Smith et al., "Matrix eigensystem routines: EISPACK guide" (1976), routines ELMHES and HQR.

/// Steps for one eigenvalue at most; about three are usual.
const STEPS: usize = 60;
/// Every so many steps without success the shift is another, so that no cycle goes on for ever.
const OTHER_SHIFT: usize = 10;

/// The eigenvalues (real, imaginary part) of a matrix by rows, `n` by `n`. Conjugate pairs follow each other, the one with
/// the positive imaginary part first. `None` where numbers are not finite, or in the rare case that the method does not settle.
pub fn eigenvalues(matrix: &[f64], n: usize) -> Option<Vec<[f64; 2]>> {
    if !matrix.iter().all(|x| x.is_finite()) {
        return None;
    }
    let mut h = Hessenberg {
        a: matrix.to_vec(),
        n,
    };
    h.reduce();
    h.values()
}

struct Hessenberg {
    a: Vec<f64>,
    n: usize,
}

impl Hessenberg {
    fn at(&self, i: usize, j: usize) -> f64 {
        self.a[i * self.n + j]
    }

    fn set(&mut self, i: usize, j: usize, x: f64) {
        self.a[i * self.n + j] = x;
    }

    /// Eliminates what lies below the first subdiagonal, by transformations that keep the eigenvalues.
    fn reduce(&mut self) {
        let n = self.n;
        for m in 1..n.saturating_sub(1) {
            let mut pivot = m;
            for i in m..n {
                if self.at(i, m - 1).abs() > self.at(pivot, m - 1).abs() {
                    pivot = i;
                }
            }
            let x = self.at(pivot, m - 1);
            if pivot != m {
                for j in 0..n {
                    self.a.swap(pivot * n + j, m * n + j);
                }
                for i in 0..n {
                    self.a.swap(i * n + pivot, i * n + m);
                }
            }
            if x == 0.0 {
                continue;
            }
            for i in m + 1..n {
                let y = self.at(i, m - 1) / x;
                if y == 0.0 {
                    continue;
                }
                for j in m - 1..n {
                    let less = y * self.at(m, j);
                    self.a[i * n + j] -= less;
                }
                for k in 0..n {
                    let more = y * self.at(k, i);
                    self.a[k * n + m] += more;
                }
                self.set(i, m - 1, 0.0);
            }
        }
    }

    fn values(&mut self) -> Option<Vec<[f64; 2]>> {
        let n = self.n;
        let mut found = vec![[0.0; 2]; n];
        let norm: f64 = self.a.iter().map(|x| x.abs()).sum();
        let mut shifted = 0.0;
        let mut end = n;
        let mut steps = 0;
        while end > 0 {
            let low = self.split(end, norm);
            let last = end - 1;
            let x = self.at(last, last);
            if low == last {
                found[last] = [x + shifted, 0.0];
                (end, steps) = (end - 1, 0);
                continue;
            }
            let y = self.at(last - 1, last - 1);
            let w = self.at(last, last - 1) * self.at(last - 1, last);
            if low + 1 == last {
                let [one, other] = of_two(x + shifted, y + shifted, w);
                (found[last - 1], found[last]) = (one, other);
                (end, steps) = (end - 2, 0);
                continue;
            }
            if steps == STEPS {
                return None;
            }
            let mut shift = [x, y, w];
            if steps > 0 && steps % OTHER_SHIFT == 0 {
                shifted += x;
                for i in 0..end {
                    self.a[i * n + i] -= x;
                }
                let s = self.at(last, last - 1).abs() + self.at(last - 1, last - 2).abs();
                shift = [0.75 * s, 0.75 * s, -0.4375 * s * s];
            }
            steps += 1;
            self.step(low, last, shift);
        }
        Some(found)
    }

    /// The first row of the last block: where a subdiagonal entry vanishes beside its diagonal ones.
    fn split(&mut self, end: usize, norm: f64) -> usize {
        for l in (1..end).rev() {
            let beside = self.at(l - 1, l - 1).abs() + self.at(l, l).abs();
            let beside = if beside == 0.0 { norm } else { beside };
            if self.at(l, l - 1).abs() <= f64::EPSILON * beside {
                self.set(l, l - 1, 0.0);
                return l;
            }
        }
        0
    }

    /// One double step on the rows from `low` to `last`.
    fn step(&mut self, low: usize, last: usize, [x, y, w]: [f64; 3]) {
        let n = self.n;
        // Where two small subdiagonal entries follow each other the step may begin.
        let mut m = last - 2;
        let mut first;
        loop {
            let z = self.at(m, m);
            let (r, s) = (x - z, y - z);
            let p = (r * s - w) / self.at(m + 1, m) + self.at(m, m + 1);
            let q = self.at(m + 1, m + 1) - z - r - s;
            let r = self.at(m + 2, m + 1);
            let size = p.abs() + q.abs() + r.abs();
            first = [p / size, q / size, r / size];
            if m == low {
                break;
            }
            let [p, q, r] = first;
            let u = self.at(m, m - 1).abs() * (q.abs() + r.abs());
            let beside = self.at(m - 1, m - 1).abs() + z.abs() + self.at(m + 1, m + 1).abs();
            if u <= f64::EPSILON * p.abs() * beside {
                break;
            }
            m -= 1;
        }
        for i in m + 2..=last {
            self.set(i, i - 2, 0.0);
            if i > m + 2 {
                self.set(i, i - 3, 0.0);
            }
        }
        let [mut p, mut q, mut r] = first;
        for k in m..last {
            let three = k + 1 != last;
            let mut size = 1.0;
            if k != m {
                p = self.at(k, k - 1);
                q = self.at(k + 1, k - 1);
                r = if three { self.at(k + 2, k - 1) } else { 0.0 };
                size = p.abs() + q.abs() + r.abs();
                if size == 0.0 {
                    continue;
                }
                (p, q, r) = (p / size, q / size, r / size);
            }
            let length = (p * p + q * q + r * r).sqrt();
            let s = if p < 0.0 { -length } else { length };
            if s == 0.0 {
                continue;
            }
            if k != m {
                self.set(k, k - 1, -s * size);
            } else if low != m {
                let turned = -self.at(k, k - 1);
                self.set(k, k - 1, turned);
            }
            p += s;
            let (x, y, z) = (p / s, q / s, r / s);
            q /= p;
            r /= p;
            for j in k..n {
                let mut sum = self.at(k, j) + q * self.at(k + 1, j);
                if three {
                    sum += r * self.at(k + 2, j);
                    self.a[(k + 2) * n + j] -= sum * z;
                }
                self.a[(k + 1) * n + j] -= sum * y;
                self.a[k * n + j] -= sum * x;
            }
            for i in 0..=last.min(k + 3) {
                let mut sum = x * self.at(i, k) + y * self.at(i, k + 1);
                if three {
                    sum += z * self.at(i, k + 2);
                    self.a[i * n + k + 2] -= sum * r;
                }
                self.a[i * n + k + 1] -= sum * q;
                self.a[i * n + k] -= sum;
            }
        }
    }
}

/// The eigenvalues of the last two rows: `x` and `y` on the diagonal, `w` the product of the other two entries.
fn of_two(x: f64, y: f64, w: f64) -> [[f64; 2]; 2] {
    let p = (y - x) / 2.0;
    let q = p * p + w;
    let z = q.abs().sqrt();
    if q < 0.0 {
        return [[x + p, z], [x + p, -z]];
    }
    let far = p + if p < 0.0 { -z } else { z };
    let near = if far == 0.0 { x } else { x - w / far };
    [[x + far, 0.0], [near, 0.0]]
}
