//! How well unknown parameters are known: what of them the data tell, and how far they are right.

use kempe_linear::{Qr, symmetric_eigen};
use kempe_number::math;

/// What is known of parameters at a minimum.
pub(super) struct Certainty {
    /// How far every parameter would be moved by an error of one scale in every value: `moved[parameter][value]`.
    pub moved: Vec<Vec<f64>>,
    /// Largest over smallest singular value of the derivatives, each parameter counted in its own size.
    pub condition: f64,
    /// Standard deviations of the parameters and how many of them 95 % confidence takes; none where what was measured tells nothing of its
    /// errors.
    pub deviations: Option<(Vec<f64>, f64)>,
}

/// Parameters that the data do not tell apart.
pub(super) struct Untold {
    /// How they may change together, the largest change 1 in parts of each parameter's size; all others are 0.
    pub together: Vec<f64>,
}

/// A combination of parameters that moves what is measured by less than this part of what others do is not told by the data.
const UNTOLD: f64 = 1e-7;
/// A parameter with less than this part in such a combination has none.
const PART: f64 = 1e-3;

/// What is known of parameters of these sizes, by the derivatives of what was measured in units of its scales; `square` is the sum of squares of what is
/// missed, and `known` whether the scales are standard deviations.
pub(super) fn certainty(
    slopes: &[Vec<f64>],
    sizes: &[f64],
    square: f64,
    known: bool,
) -> Result<Certainty, Untold> {
    let (rows, columns) = (slopes.len(), sizes.len());
    let mut qr = Qr::with_capacity(rows.max(columns), columns);
    qr.reset(rows.max(columns), columns);
    let mut normal = vec![0.0; columns * columns];
    for (row, slopes) in slopes.iter().enumerate() {
        for (i, size) in sizes.iter().enumerate() {
            qr.add(row, i, slopes[i] * size);
            for j in 0..columns {
                normal[i * columns + j] += slopes[i] * size * slopes[j] * sizes[j];
            }
        }
    }
    let eigen = symmetric_eigen(&normal, columns);
    let largest = eigen.last().map_or(0.0, |pair| pair.value.max(0.0).sqrt());
    qr.factor();
    let smallest = qr.smallest_singular_value();
    if !(smallest > UNTOLD * largest) {
        let mut together = eigen
            .first()
            .map_or_else(Vec::new, |pair| pair.vector.clone());
        let most = together.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        for part in &mut together {
            *part /= most.max(f64::MIN_POSITIVE);
            if part.abs() < PART {
                *part = 0.0;
            }
        }
        return Err(Untold { together });
    }
    let mut moved = vec![vec![0.0; rows]; columns];
    for value in 0..rows {
        let mut right = vec![0.0; rows.max(columns)];
        right[value] = 1.0;
        qr.solve(&mut right);
        for (k, size) in sizes.iter().enumerate() {
            moved[k][value] = right[k] * size;
        }
    }
    let spread = |moved: &Vec<f64>| moved.iter().map(|x| x * x).sum::<f64>().sqrt();
    let own: Vec<f64> = moved.iter().map(spread).collect();
    let freedom = rows.saturating_sub(columns);
    let deviations = match (known, freedom) {
        (true, _) => Some((own, NORMAL)),
        (false, 0) => None,
        (false, freedom) => {
            let error = (square / freedom as f64).sqrt();
            let own = own.into_iter().map(|x| x * error).collect();
            Some((own, student(freedom)))
        }
    };
    Ok(Certainty {
        moved,
        condition: largest / smallest,
        deviations,
    })
}

/// So many standard deviations of a normal distribution hold 95 % of it.
const NORMAL: f64 = 1.959_963_984_540_054;

/// So many standard deviations of Student's distribution with these degrees of freedom hold 95 % of it: G. W. Hill's expansion (Comm. ACM 13:619, 1970);
/// exact for one and two.
fn student(freedom: usize) -> f64 {
    let n = freedom as f64;
    let p = 0.05;
    match freedom {
        1 => 1.0 / math::tan(p * std::f64::consts::FRAC_PI_2),
        2 => (2.0 / (p * (2.0 - p)) - 2.0).sqrt(),
        _ => {
            let a = 1.0 / (n - 0.5);
            let b = 48.0 / (a * a);
            let mut c = ((20_700.0 * a / b - 98.0) * a - 16.0) * a + 96.36;
            let d =
                ((94.5 / (b + c) - 3.0) / b + 1.0) * (a * std::f64::consts::FRAC_PI_2).sqrt() * n;
            let mut y = math::powf(d * p, 2.0 / n);
            if y > 0.05 + a {
                let x = -NORMAL;
                y = x * x;
                if freedom < 5 {
                    c += 0.3 * (n - 4.5) * (x + 0.6);
                }
                c += (((0.05 * d * x - 5.0) * x - 7.0) * x - 2.0) * x + b;
                y = (((((0.4 * y + 6.3) * y + 36.0) * y + 94.5) / c - y - 3.0) / b + 1.0) * x;
                y = a * y * y;
                y = if y > 0.002 {
                    math::exp(y) - 1.0
                } else {
                    0.5 * y * y + y
                };
            } else {
                y = ((1.0 / (((n + 6.0) / (n * y) - 0.089 * d - 0.822) * (n + 2.0) * 3.0)
                    + 0.5 / (n + 4.0))
                    * y
                    - 1.0)
                    * (n + 1.0)
                    / (n + 2.0)
                    + 1.0 / y;
            }
            (n * y).sqrt()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tables of Student's distribution, two-sided 5 %.
    #[test]
    fn quantiles_are_those_of_the_tables() {
        let known = [
            (1, 12.706_204_736),
            (2, 4.302_652_730),
            (3, 3.182_446_305),
            (4, 2.776_445_105),
            (5, 2.570_581_836),
            (10, 2.228_138_852),
            (30, 2.042_272_456),
            (100, 1.983_971_519),
            (1000, 1.962_339_081),
        ];
        for (freedom, t) in known {
            let found = student(freedom);
            assert!((found - t).abs() < 2e-4 * t, "{freedom}: {found} {t}");
        }
    }

    /// A straight line through five values: slope and intercept with their textbook deviations.
    #[test]
    fn a_line_is_as_certain_as_books_say() {
        let x = [0.0, 1.0, 2.0, 3.0, 4.0];
        let slopes: Vec<Vec<f64>> = x.iter().map(|x| vec![1.0, *x]).collect();
        let Ok(known) = certainty(&slopes, &[1.0, 1.0], 0.3, false) else {
            panic!("told apart");
        };
        let (deviations, _) = known.deviations.expect("more values than unknowns");
        // s^2 = 0.3 / 3; s / sqrt(Sxx) and s sqrt(sum x^2 / (n Sxx)), Sxx = 10.
        assert!((deviations[1] - (0.1_f64 / 10.0).sqrt()).abs() < 1e-14);
        assert!((deviations[0] - (0.1_f64 * 30.0 / 50.0).sqrt()).abs() < 1e-14);
    }

    #[test]
    fn what_changes_together_is_named() {
        let slopes = vec![
            vec![1.0, 2.0, 0.0],
            vec![2.0, 4.0, 1.0],
            vec![3.0, 6.0, -1.0],
        ];
        let Err(untold) = certainty(&slopes, &[1.0, 1.0, 1.0], 0.0, true) else {
            panic!("the first two columns are one");
        };
        let [a, b, c] = untold.together[..] else {
            panic!("three");
        };
        assert!((a / b + 2.0).abs() < 1e-6 && c == 0.0, "{a} {b} {c}");
    }
}
