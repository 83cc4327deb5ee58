//! Minimax of linear errors in three numbers, by references of four errors (E. Stiefel 1959).

/// Exchanges of references at most: each raises the least error that is known, of finitely many.
const EXCHANGES: usize = 200;
/// An error that is greater than that of the reference by no more than this part is none.
const SAME: f64 = 1e-12;

/// The three numbers for which the greatest of the errors `e + s . x` is least, and the reference of four errors that says so.
///
/// Of five errors the least greatest is the greatest of their references' own: so one more error at a time is exchanged for the one that leaves the
/// most. `None` where no four errors determine anything.
pub(super) fn minimax(rows: &[(f64, [f64; 3])], reference: &mut [usize; 4]) -> Option<[f64; 3]> {
    let size = rows.iter().fold(0.0_f64, |m, (e, _)| m.max(e.abs()));
    let mut best = solved(rows, *reference).map(|(error, x)| (error, x, *reference));
    for _ in 0..EXCHANGES {
        let (error, x) = best.map_or((0.0, [0.0; 3]), |(error, x, _)| (error, x));
        let of = |k: usize| {
            let (e, s) = rows[k];
            (e + s[0] * x[0] + s[1] * x[1] + s[2] * x[2]).abs()
        };
        let worst = (0..rows.len()).max_by(|a, b| of(*a).total_cmp(&of(*b)))?;
        if best.is_some() && of(worst) <= error + SAME * size {
            break;
        }
        let exchanged = (0..4).filter_map(|leaving| {
            let mut next = *reference;
            next[leaving] = worst;
            solved(rows, next).map(|(error, x)| (error, x, next))
        });
        let next = exchanged.max_by(|a, b| a.0.total_cmp(&b.0));
        match next {
            Some(next) if best.is_none() || next.0 > error => {
                *reference = next.2;
                best = Some(next);
            }
            _ => break,
        }
    }
    best.map(|(_, x, _)| x)
}

/// The least greatest error of four, and the numbers that give it.
fn solved(rows: &[(f64, [f64; 3])], reference: [usize; 4]) -> Option<(f64, [f64; 3])> {
    let [a, b, c, d] = reference.map(|k| rows[k].1);
    // How the four slopes depend on each other.
    let weights = [det(b, c, d), -det(a, c, d), det(a, b, d), -det(a, b, c)];
    let sum: f64 = weights.iter().map(|w| w.abs()).sum();
    if !(sum > 0.0) {
        return None;
    }
    let errors = reference.map(|k| rows[k].0);
    let level = weights.iter().zip(errors).map(|(w, e)| w * e).sum::<f64>() / sum;
    // Each error comes to the level, with its weight's sign; of the three with the largest determinant the numbers follow.
    let aims: Vec<f64> = (0..4)
        .map(|k| weights[k].signum() * level - errors[k])
        .collect();
    let left = (0..4).max_by(|a, b| weights[*a].abs().total_cmp(&weights[*b].abs()))?;
    let three: Vec<usize> = (0..4).filter(|k| *k != left).collect();
    let slopes = [0, 1, 2].map(|k| rows[reference[three[k]]].1);
    let aim = [0, 1, 2].map(|k| aims[three[k]]);
    let whole = det(slopes[0], slopes[1], slopes[2]);
    let with = |column: usize| {
        let mut own = slopes;
        for (row, aim) in own.iter_mut().zip(aim) {
            row[column] = aim;
        }
        det(own[0], own[1], own[2]) / whole
    };
    Some((level.abs(), [with(0), with(1), with(2)]))
}

fn det(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}
