//! What the numbers of a design are worth: goals, and then what must be kept.

use kempe_optimize::Evaluation;

use super::pieces::Wanted;

/// What is wanted of designs.
pub(super) struct Aims {
    /// What is to be small or large, then what must be kept.
    pub wanted: Vec<Wanted>,
    /// So many of these are goals.
    pub goals: usize,
}

impl Aims {
    /// What numbers are worth.
    pub fn worth(&self, numbers: &[f64]) -> (Evaluation, Option<String>) {
        if let Some(k) = numbers.iter().position(|x| !x.is_finite()) {
            let why = format!("`{}` has no finite value", self.wanted[k].number.name);
            return (Evaluation::lacking(1.0), Some(why));
        }
        let signed = numbers.iter().zip(&self.wanted).map(|(x, w)| w.sign * x);
        let mut objectives: Vec<f64> = signed.collect();
        let constraints = objectives.split_off(self.goals);
        let evaluation = Evaluation {
            objectives,
            constraints,
            lack: 0.0,
        };
        (evaluation, None)
    }
}
