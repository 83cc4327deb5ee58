//! Children of two designs: simulated binary crossover (K. Deb and R. B. Agrawal, 1995) and polynomial mutation (K. Deb and M. Goyal, 1996), both
//! in the form that stays within the box.

use kempe_number::{Random, math};

/// Variables closer than this part of the box are not crossed.
const SAME: f64 = 1e-14;
/// How likely a pair is crossed, and one of its variables.
const CROSSED: f64 = 0.9;
const VARIABLE: f64 = 0.5;
/// How near children stay: of crossover and of mutation; the larger the nearer.
const CROSSOVER_INDEX: f64 = 15.0;
const MUTATION_INDEX: f64 = 20.0;

/// Two children of two designs.
pub(crate) fn crossed(
    random: &mut Random,
    bounds: &[[f64; 2]],
    parents: [&[f64]; 2],
) -> [Vec<f64>; 2] {
    let mut children = parents.map(<[f64]>::to_vec);
    if random.uniform() >= CROSSED {
        return children;
    }
    for (k, [low, high]) in bounds.iter().enumerate() {
        let (one, two) = (parents[0][k], parents[1][k]);
        if random.uniform() >= VARIABLE || (one - two).abs() <= SAME * (high - low) {
            continue;
        }
        let (less, more) = (one.min(two), one.max(two));
        let chance = random.uniform();
        let spread = |room: f64| {
            let beta = 1.0 + 2.0 * room / (more - less);
            let alpha = 2.0 - math::powf(beta, -(CROSSOVER_INDEX + 1.0));
            let base = match chance <= 1.0 / alpha {
                true => chance * alpha,
                false => 1.0 / (2.0 - chance * alpha),
            };
            math::powf(base, 1.0 / (CROSSOVER_INDEX + 1.0))
        };
        let lower = 0.5 * ((less + more) - spread(less - low) * (more - less));
        let upper = 0.5 * ((less + more) + spread(high - more) * (more - less));
        let pair = [lower, upper].map(|x| x.max(*low).min(*high));
        let [first, second] = if random.uniform() < 0.5 {
            pair
        } else {
            [pair[1], pair[0]]
        };
        children[0][k] = first;
        children[1][k] = second;
    }
    children
}

/// Changes a design: one of its variables, on average.
pub(crate) fn mutate(random: &mut Random, bounds: &[[f64; 2]], design: &mut [f64]) {
    let likely = 1.0 / bounds.len().max(1) as f64;
    let power = 1.0 / (MUTATION_INDEX + 1.0);
    for (x, [low, high]) in design.iter_mut().zip(bounds) {
        let width = high - low;
        if random.uniform() >= likely || !(width > 0.0) {
            continue;
        }
        let chance = random.uniform();
        let change = match chance < 0.5 {
            true => {
                let room = math::powf(1.0 - (*x - low) / width, MUTATION_INDEX + 1.0);
                math::powf(2.0 * chance + (1.0 - 2.0 * chance) * room, power) - 1.0
            }
            false => {
                let room = math::powf(1.0 - (high - *x) / width, MUTATION_INDEX + 1.0);
                1.0 - math::powf(2.0 * (1.0 - chance) + (2.0 * chance - 1.0) * room, power)
            }
        };
        *x = (*x + change * width).max(*low).min(*high);
    }
}
