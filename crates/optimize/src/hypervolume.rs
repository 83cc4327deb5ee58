//! How much of the space of objectives a front dominates.

/// The volume that points dominate below a reference (by slices of the last objective: L. While, P. Hingston, L. Barone and S. Huband 2006). Points that are
/// not below it in every objective count nothing.
pub fn hypervolume(points: &[Vec<f64>], reference: &[f64]) -> f64 {
    let below =
        |p: &&Vec<f64>| p.len() == reference.len() && p.iter().zip(reference).all(|(x, r)| x < r);
    let inside: Vec<&[f64]> = points.iter().filter(below).map(Vec::as_slice).collect();
    volume(&inside, reference)
}

fn volume(points: &[&[f64]], reference: &[f64]) -> f64 {
    let Some((last, rest)) = reference.split_last() else {
        return if points.is_empty() { 0.0 } else { 1.0 };
    };
    if points.is_empty() {
        return 0.0;
    }
    let m = rest.len();
    if m == 0 {
        let least = points.iter().map(|p| p[0]).fold(f64::INFINITY, f64::min);
        return last - least;
    }
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a[m].total_cmp(&b[m]));
    let mut total = 0.0;
    for k in 0..sorted.len() {
        let top = sorted.get(k + 1).map_or(*last, |next| next[m]);
        let thick = top - sorted[k][m];
        if thick > 0.0 {
            let slice: Vec<&[f64]> = sorted[..=k].iter().map(|p| &p[..m]).collect();
            total += thick * volume(&slice, rest);
        }
    }
    total
}
