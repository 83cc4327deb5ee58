//! Zeros and peaks of a function of one number, from samples of its range; it may have no value in places.

/// Steps of a golden section: it ends at a part of 1e-8 of where it begins, where a peak's value is exact to rounding.
const GOLDEN_STEPS: usize = 38;
/// Steps of a regula falsi at most.
const FALSI_STEPS: usize = 60;

type Function<'a> = &'a dyn Fn(f64) -> Option<f64>;

fn samples([low, high]: [f64; 2], steps: usize, f: Function<'_>) -> Vec<(f64, Option<f64>)> {
    let at = |k: usize| low + (high - low) * (k as f64 / steps as f64);
    match low < high {
        true => (0..=steps).map(|k| (at(k), f(at(k)))).collect(),
        false => Vec::new(),
    }
}

/// Where a function is zero, one place for each change of sign between two of its samples.
pub(crate) fn roots(range: [f64; 2], steps: usize, f: Function<'_>) -> Vec<f64> {
    let samples = samples(range, steps, f);
    let pairs = samples.windows(2);
    let found = pairs.filter_map(|pair| match pair {
        [(a, Some(fa)), (b, Some(fb))] if (*fa < 0.0) != (*fb < 0.0) => {
            falsi([*a, *b], [*fa, *fb], f)
        }
        _ => None,
    });
    found.collect()
}

/// Regula falsi after Illinois: an end that stays counts half.
fn falsi([mut a, mut b]: [f64; 2], [mut fa, mut fb]: [f64; 2], f: Function<'_>) -> Option<f64> {
    let mut stayed = 0;
    for _ in 0..FALSI_STEPS {
        let c = (a * fb - b * fa) / (fb - fa);
        if !(c > a.min(b) && c < a.max(b)) {
            break;
        }
        let fc = f(c)?;
        if fc == 0.0 {
            return Some(c);
        }
        if (fc < 0.0) == (fb < 0.0) {
            (b, fb) = (c, fc);
            if stayed == 1 {
                fa *= 0.5;
            }
            stayed = 1;
        } else {
            (a, fa) = (c, fc);
            if stayed == 2 {
                fb *= 0.5;
            }
            stayed = 2;
        }
    }
    Some(if fa.abs() < fb.abs() { a } else { b })
}

/// Where a function is greater than at its samples around: the place of each such peak, ends of its range among them.
pub(crate) fn peaks(range: [f64; 2], steps: usize, f: Function<'_>) -> Vec<f64> {
    peaks_of(&samples(range, steps, f), true, f)
}

/// The same of a function that comes round again behind its range.
pub(crate) fn peaks_around([low, high]: [f64; 2], steps: usize, f: Function<'_>) -> Vec<f64> {
    let step = (high - low) / steps as f64;
    peaks_of(&samples([low - step, high], steps + 1, f), false, f)
}

fn peaks_of(samples: &[(f64, Option<f64>)], ends: bool, f: Function<'_>) -> Vec<f64> {
    let value = |k: Option<usize>| {
        k.and_then(|k| samples.get(k)?.1)
            .unwrap_or(f64::NEG_INFINITY)
    };
    let mut found = Vec::new();
    for (k, (at, own)) in samples.iter().enumerate() {
        let Some(own) = own else { continue };
        let before = k.checked_sub(1);
        // Of equal ones the first counts.
        let is_end = before.is_none() || k + 1 == samples.len();
        if (is_end && !ends) || !(value(before) < *own && value(Some(k + 1)) <= *own) {
            continue;
        }
        let end = |k: Option<usize>| k.and_then(|k| samples.get(k)).map_or(*at, |s| s.0);
        let mut best = (*at, *own);
        golden([end(before), end(Some(k + 1))], GOLDEN_STEPS, &mut |at| {
            let value = f(at).unwrap_or(f64::NEG_INFINITY);
            if value > best.1 {
                best = (at, value);
            }
            value
        });
        found.push(best.0);
    }
    found
}

/// Looks at a function in places that close in on its peak between two places (a golden section of so many steps).
pub fn golden([mut low, mut high]: [f64; 2], steps: usize, look: &mut dyn FnMut(f64) -> f64) {
    const PART: f64 = 0.618_033_988_749_894_9;
    let mut inner = [high - PART * (high - low), low + PART * (high - low)];
    let mut values = inner.map(&mut *look);
    for _ in 0..steps {
        if values[0] >= values[1] {
            high = inner[1];
            inner = [high - PART * (high - low), inner[0]];
            values = [look(inner[0]), values[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + PART * (high - low)];
            values = [values[1], look(inner[1])];
        }
    }
}
