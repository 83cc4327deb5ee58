//! Which numbers over a motion can be found together.

use kempe_model::{Leaf, Measure, Statistic};

use crate::force_source::ForceSource;
use crate::measure::visit_leaves;
use crate::sampler::Sampler;

/// Statistics in rounds, each of which contains only those of rounds before it. The order within is kept. Measures of forces
/// contain what the loads are made of.
pub(crate) fn rounds<F: ForceSource>(
    sampler: &Sampler<F>,
    statistics: Vec<(Statistic, Measure)>,
) -> Vec<Vec<(Statistic, Measure)>> {
    let mechanism = sampler.motion().mechanism();
    let place = |statistic: &Statistic, measure: &Measure| {
        (statistics.iter()).position(|(s, m)| s == statistic && m == measure)
    };
    let inside = |measure: &Measure| {
        let (mut places, mut forces) = (Vec::new(), false);
        visit_leaves(mechanism, measure, &mut |leaf| match leaf {
            Leaf::Over(statistic, inner) => places.extend(place(statistic, inner)),
            Leaf::Force(_) => forces = true,
            _ => {}
        });
        (places, forces)
    };
    let inputs = sampler.forces().measures();
    let of_loads: Vec<usize> = inputs.iter().flat_map(|input| inside(input).0).collect();
    let contained: Vec<Vec<usize>> = (statistics.iter())
        .map(|(_, measure)| {
            let (mut places, forces) = inside(measure);
            if forces {
                places.extend(&of_loads);
            }
            places
        })
        .collect();
    // The inner ones stand first: one pass is enough. A load that asks for itself has no value.
    let mut round_of = vec![0; statistics.len()];
    for (index, places) in contained.iter().enumerate() {
        let before = places.iter().filter(|place| **place < index);
        round_of[index] = before.map(|place| round_of[*place] + 1).max().unwrap_or(0);
    }
    let count = round_of.iter().max().map_or(0, |last| last + 1);
    let mut rounds = vec![Vec::new(); count];
    for (statistic, round) in statistics.into_iter().zip(round_of) {
        rounds[round].push(statistic);
    }
    rounds
}
