//! What a parameter may be chosen among: between two ends, or some values alone.

use kempe_model::{Among, Model, OptimizeStudy, value};

/// So many whole multiples of a step are told apart at most.
const MOST_CHOICES: f64 = 1e6;

/// The least and the greatest value of every parameter, SI; discrete values lie between the ends of all.
pub(super) fn ranges(model: &Model, study: &OptimizeStudy) -> Vec<[f64; 2]> {
    let parameters = model.parameter_values::<f64>();
    let number = |x| value::<f64>(x, &parameters);
    let ends = study.vary.iter().map(|chosen| match &chosen.among {
        Among::Between([low, high]) | Among::Factors([low, high]) => [number(low), number(high)],
        Among::Steps { .. } | Among::Only(_) => {
            let all = choices(model, &chosen.among);
            let low = all.iter().copied().fold(f64::INFINITY, f64::min);
            let high = all.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            [low, high]
        }
    });
    ends.collect()
}

/// The values of a parameter that is chosen among some, SI and rising; none of one that may have any between two.
pub(super) fn choices(model: &Model, among: &Among) -> Vec<f64> {
    let parameters = model.parameter_values::<f64>();
    let number = |x| value::<f64>(x, &parameters);
    let mut all: Vec<f64> = match among {
        Among::Between(_) | Among::Factors(_) => Vec::new(),
        Among::Only(values) => values.iter().map(number).collect(),
        Among::Steps { between, step } => {
            let step = number(step);
            let [first, last] = [
                (number(&between[0]) / step - 1e-9).ceil(),
                (number(&between[1]) / step + 1e-9).floor(),
            ];
            let count = (last - first).min(MOST_CHOICES) as usize;
            (0..=count).map(|k| (first + k as f64) * step).collect()
        }
    };
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}
