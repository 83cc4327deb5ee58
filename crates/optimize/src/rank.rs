//! Which of two designs is the better one.

use std::cmp::Ordering;

use crate::problem::{Evaluation, Scales};

/// A violation below this, by the constraints' scales, is kept: what local methods polish.
pub(crate) const KEPT: f64 = 1e-9;

/// The better of two designs first (K. Deb 2000): one that can be evaluated before one that cannot, of those by what is lacking; one that keeps
/// all constraints before one that does not, of those by the largest violation; and last by the largest objective.
pub fn compare(a: &Evaluation, b: &Evaluation, scales: &Scales) -> Ordering {
    feasibility(a, b, scales).then_with(|| a.largest().total_cmp(&b.largest()))
}

/// The same without the objectives: equal where both keep all constraints.
pub(crate) fn feasibility(a: &Evaluation, b: &Evaluation, scales: &Scales) -> Ordering {
    let lack = |e: &Evaluation| if e.is_defined() { 0.0 } else { e.lack };
    let by_lack = lack(a).total_cmp(&lack(b));
    if by_lack != Ordering::Equal || !a.is_defined() {
        return by_lack;
    }
    let violation = |e: &Evaluation| match e.violation(scales) {
        kept if kept <= KEPT => 0.0,
        missed => missed,
    };
    violation(a).total_cmp(&violation(b))
}
