//! How much of the space of objectives a front dominates (E. Zitzler and L. Thiele, 1998).
//!
//! Exact for any number of objectives by the exclusive volumes of L. While, L. Bradstreet and L. Barone (WFG, 2012): points are taken from the worst last
//! objective on, so that what a point shares with those after it is a volume of one dimension less.

use crate::dominance::dominates;

/// The volume of all that the points dominate up to a reference, for objectives that are to be small. Points that are not better than the
/// reference in every objective dominate nothing of it.
pub fn hypervolume(points: &[Vec<f64>], reference: &[f64]) -> f64 {
    let inside =
        |p: &&Vec<f64>| p.len() == reference.len() && p.iter().zip(reference).all(|(x, r)| x < r);
    volume(points.iter().filter(inside).cloned().collect(), reference)
}

/// The same of points that are all inside.
fn volume(points: Vec<Vec<f64>>, reference: &[f64]) -> f64 {
    let mut points = undominated(points);
    let [rest @ .., end] = reference else {
        return 0.0;
    };
    let last = rest.len();
    if last == 0 {
        return points.iter().map(|p| end - p[0]).fold(0.0, f64::max);
    }
    points.sort_by(|a, b| b[last].total_cmp(&a[last]).then_with(|| by_all(a, b)));
    if last == 1 {
        // A staircase: along it the first objective rises as the second falls.
        let mut area = 0.0;
        let mut from = rest[0];
        for p in points.iter().rev() {
            area += (from - p[0]).max(0.0) * (end - p[1]);
            from = from.min(p[0]);
        }
        return area;
    }
    let mut sum = 0.0;
    for (k, p) in points.iter().enumerate() {
        let own: f64 = p[..last].iter().zip(rest).map(|(x, r)| r - x).product();
        let shared = points[k + 1..]
            .iter()
            .map(|q| q[..last].iter().zip(p).map(|(x, y)| x.max(*y)).collect());
        sum += (end - p[last]) * (own - volume(shared.collect(), rest));
    }
    sum
}

/// An order of points.
fn by_all(a: &[f64], b: &[f64]) -> std::cmp::Ordering {
    let orders = a.iter().zip(b).map(|(x, y)| x.total_cmp(y));
    orders.fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
}

/// The points that no other dominates, each once.
fn undominated(points: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let mut kept: Vec<Vec<f64>> = Vec::with_capacity(points.len());
    for p in points {
        if !kept.iter().any(|q| dominates(q, &p) || *q == p) {
            kept.retain(|q| !dominates(&p, q));
            kept.push(p);
        }
    }
    kept
}
