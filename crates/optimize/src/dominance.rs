//! Which designs others leave behind in every objective, and how crowded a front is (K. Deb, A. Pratap, S. Agarwal and T. Meyarivan, 2002).

use crate::standing::Standing;

/// Whether one list of objectives is nowhere larger than another and somewhere smaller.
pub fn dominates(one: &[f64], other: &[f64]) -> bool {
    one.iter().zip(other).all(|(a, b)| a <= b) && one.iter().zip(other).any(|(a, b)| a < b)
}

/// The same under constraints: of two designs that do not both keep them, the better one by K. Deb's rules (2000).
pub(crate) fn dominates_under(one: (&Standing, &[f64]), other: (&Standing, &[f64])) -> bool {
    match (one.0, other.0) {
        (Standing::Feasible(_), Standing::Feasible(_)) => dominates(one.1, other.1),
        (a, b) => a.order(b).is_lt(),
    }
}

/// The places of designs in fronts: the first is dominated by none, each next one only by those before (fast nondominated sort).
pub(crate) fn fronts(all: &[(Standing, &[f64])]) -> Vec<Vec<usize>> {
    let mut below: Vec<Vec<usize>> = vec![Vec::new(); all.len()];
    let mut above = vec![0_usize; all.len()];
    for i in 0..all.len() {
        for j in 0..i {
            let (a, b) = ((&all[i].0, all[i].1), (&all[j].0, all[j].1));
            if dominates_under(a, b) {
                below[i].push(j);
                above[j] += 1;
            } else if dominates_under(b, a) {
                below[j].push(i);
                above[i] += 1;
            }
        }
    }
    let mut fronts = Vec::new();
    let mut front: Vec<usize> = (0..all.len()).filter(|k| above[*k] == 0).collect();
    while !front.is_empty() {
        let mut next = Vec::new();
        for i in &front {
            for j in &below[*i] {
                above[*j] -= 1;
                if above[*j] == 0 {
                    next.push(*j);
                }
            }
        }
        next.sort_unstable();
        fronts.push(std::mem::replace(&mut front, next));
    }
    fronts
}

/// How much room each design of a front has: the sum over objectives of the distance between its neighbours, by the front's range; infinite
/// at the ends. Designs without objectives have none.
pub(crate) fn crowding(front: &[&[f64]]) -> Vec<f64> {
    let mut room = vec![0.0; front.len()];
    let objectives = front.first().map_or(0, |f| f.len());
    if front.iter().any(|f| f.len() != objectives) {
        return room;
    }
    for k in 0..objectives {
        let mut order: Vec<usize> = (0..front.len()).collect();
        order.sort_by(|a, b| front[*a][k].total_cmp(&front[*b][k]).then(a.cmp(b)));
        let (first, last) = (order[0], order[order.len() - 1]);
        let range = front[last][k] - front[first][k];
        room[first] = f64::INFINITY;
        room[last] = f64::INFINITY;
        if range > 0.0 {
            for three in order.windows(3) {
                room[three[1]] += (front[three[2]][k] - front[three[0]][k]) / range;
            }
        }
    }
    room
}
