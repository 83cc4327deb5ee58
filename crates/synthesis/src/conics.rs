//! Where two conics meet: all that is left of a synthesis problem once its linear part is solved.

use kempe_linear::C;

use crate::polynomial::roots;

/// A real symmetric form in three homogeneous coordinates.
pub(crate) type Form = [[f64; 3]; 3];

/// A generic turn of the coordinates (quaternion 0.7, 0.4, -0.5, 0.3 made unit), so that no two solutions share a
/// coordinate and none lies at infinity.
const TURN: Form = [
    [31.0 / 99.0, -82.0 / 99.0, -46.0 / 99.0],
    [2.0 / 99.0, 49.0 / 99.0, -86.0 / 99.0],
    [94.0 / 99.0, 26.0 / 99.0, 17.0 / 99.0],
];
/// A form below this part of what it was made of is what rounding left of zero.
const VANISHES: f64 = 1e-12;
/// Newton's steps on a point where the conics meet.
const STEPS: usize = 6;

/// The four points, real or complex, where two conics meet, as often as each counts. `None` where they share a part.
pub(crate) fn meet(first: &Form, second: &Form) -> Option<Vec<[C; 3]>> {
    let first = scaled(&turned(first), 0.0)?;
    let second = scaled(&turned(second), 0.0)?;
    // Of the second only what the first does not explain.
    let shared: f64 = (0..9)
        .map(|k| first[k / 3][k % 3] * second[k / 3][k % 3])
        .sum();
    let mut rest = second;
    for (row, known) in rest.iter_mut().zip(&first) {
        for (x, y) in row.iter_mut().zip(known) {
            *x -= shared * y;
        }
    }
    let second = scaled(&rest, VANISHES)?;

    // Both as a quadratic in y whose coefficients are polynomials in x, with z = 1; their resultant.
    let quadratic = |q: &Form| {
        (
            q[1][1],
            [2.0 * q[1][2], 2.0 * q[0][1]],
            [q[2][2], 2.0 * q[0][2], q[0][0]],
        )
    };
    let ((a1, b1, c1), (a2, b2, c2)) = (quadratic(&first), quadratic(&second));
    let ac: [f64; 3] = std::array::from_fn(|k| a1 * c2[k] - a2 * c1[k]);
    let ab: [f64; 2] = std::array::from_fn(|k| a1 * b2[k] - a2 * b1[k]);
    let mut bc = [0.0; 4];
    for i in 0..2 {
        for j in 0..3 {
            bc[i + j] += b1[i] * c2[j] - b2[i] * c1[j];
        }
    }
    let mut resultant = [0.0; 5];
    for i in 0..3 {
        for j in 0..3 {
            resultant[i + j] += ac[i] * ac[j];
        }
    }
    for i in 0..2 {
        for j in 0..4 {
            resultant[i + j] -= ab[i] * bc[j];
        }
    }
    if resultant.iter().all(|c| c.abs() < VANISHES) {
        return None;
    }
    let found = roots(&resultant).into_iter().map(|x| {
        let at = |p: &[f64]| p.iter().rev().fold(C::zero(), |f, c| f * x + C::from(*c));
        let y = -(at(&ac) * at(&ab).recip());
        let [x, y] = polished(&first, &second, [x, y]);
        let point = [x, y, C::one()];
        std::array::from_fn(|i| (0..3).fold(C::zero(), |s, k| s + point[k] * TURN[k][i]))
    });
    Some(found.collect())
}

/// The form in coordinates along the rows of the turn.
fn turned(form: &Form) -> Form {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let mut sum = 0.0;
            for k in 0..3 {
                for l in 0..3 {
                    sum += TURN[i][k] * form[k][l] * TURN[j][l];
                }
            }
            sum
        })
    })
}

/// The form made of size 1; `None` where it is no larger than `least`.
fn scaled(form: &Form, least: f64) -> Option<Form> {
    let size = form.iter().flatten().map(|x| x * x).sum::<f64>().sqrt();
    (size > least && size.is_finite()).then(|| form.map(|row| row.map(|x| x / size)))
}

fn polished(first: &Form, second: &Form, start: [C; 2]) -> [C; 2] {
    let evaluate = |q: &Form, p: [C; 2]| {
        let p = [p[0], p[1], C::one()];
        let half: [C; 3] =
            std::array::from_fn(|i| (0..3).fold(C::zero(), |s, k| s + p[k] * q[i][k]));
        let value = (0..3).fold(C::zero(), |s, k| s + half[k] * p[k]);
        (value, [half[0] * 2.0, half[1] * 2.0])
    };
    let size = |p: [C; 2]| evaluate(first, p).0.norm_sqr() + evaluate(second, p).0.norm_sqr();
    let (mut p, mut now) = (start, size(start));
    for _ in 0..STEPS {
        let ((f, df), (g, dg)) = (evaluate(first, p), evaluate(second, p));
        let inverse = (df[0] * dg[1] - df[1] * dg[0]).recip();
        let next = [
            p[0] - (f * dg[1] - g * df[1]) * inverse,
            p[1] - (df[0] * g - dg[0] * f) * inverse,
        ];
        let there = size(next);
        if !(there < now) {
            break;
        }
        (p, now) = (next, there);
    }
    p
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn circle_and_ellipse_meet_in_four_points() {
        let circle = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -4.0]];
        let ellipse = [[0.25, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, -2.0]];
        // y^2 = 4 - x^2 and x^2 / 4 + 4 y^2 = 2: x^2 = 56 / 15.
        let points = meet(&circle, &ellipse).unwrap();
        assert_eq!(points.len(), 4);
        for [x, y, z] in points {
            let (x, y) = (x * z.recip(), y * z.recip());
            assert!(((x * x).re - 56.0 / 15.0).abs() < 1e-13 && x.im.abs() < 1e-13);
            assert!(((y * y).re - 4.0 / 15.0).abs() < 1e-13);
        }
        assert!(meet(&circle, &circle.map(|r| r.map(|x| 2.0 * x))).is_none());
    }
}
