//! A normal distribution that adapts to the landscape (N. Hansen 2016, "The CMA evolution strategy: a tutorial").

use kempe_linear::symmetric_eigen;
use kempe_number::Random;
use kempe_number::math::{exp, ln, max, min};

use crate::population::{Asker, Found, PopulationOptions};
use crate::problem::Problem;
use crate::progress::Hears;
use crate::rank::compare;
use crate::space::Space;

/// The spread at the start, in parts of the box.
const SPREAD: f64 = 0.3;
/// Below this spread a search has come to rest, and begins anew with more designs.
const AT_REST: f64 = 1e-12;
/// How often a design outside of the box is drawn again before it is put on the bound.
const DRAWS: usize = 20;

/// The best design that the strategy finds from a design on, begun anew elsewhere with twice as many designs each time it comes to rest (A. Auger and
/// N. Hansen 2005); `None` where the bounds do not fit.
pub fn cma_es(
    problem: &mut dyn Problem,
    start: &[f64],
    options: &PopulationOptions,
    hears: Hears,
) -> Option<Found> {
    let n = start.len();
    let space = Space::new(problem.bounds());
    if !space.holds(n) {
        return None;
    }
    let own = space.unit(&space.within(start));
    let mut size = options
        .size
        .unwrap_or(4 + (3.0 * ln(n as f64)) as usize)
        .max(4);
    let mut random = Random(options.seed ^ 0x9e37_79b9);
    let (mut asker, _) = Asker::begin(problem, vec![own.clone()], options.evaluations, hears);
    let mut mean = own;
    while !asker.is_over() {
        descend(&mut asker, mean, size, &mut random);
        size *= 2;
        mean = (0..n).map(|_| random.uniform()).collect();
    }
    asker.found()
}

/// One search from a mean until it comes to rest.
fn descend(asker: &mut Asker<'_, '_>, mut mean: Vec<f64>, size: usize, random: &mut Random) {
    let n = mean.len();
    let dimension = n as f64;
    let parents = size / 2;
    let raw: Vec<f64> = (1..=parents)
        .map(|i| ln(parents as f64 + 0.5) - ln(i as f64))
        .collect();
    let total: f64 = raw.iter().sum();
    let weights: Vec<f64> = raw.iter().map(|w| w / total).collect();
    let effective = 1.0 / weights.iter().map(|w| w * w).sum::<f64>();
    let c_path = (4.0 + effective / dimension) / (dimension + 4.0 + 2.0 * effective / dimension);
    let c_size = (effective + 2.0) / (dimension + effective + 5.0);
    let c_one = 2.0 / ((dimension + 1.3) * (dimension + 1.3) + effective);
    let c_rank = min(
        1.0 - c_one,
        2.0 * (effective - 2.0 + 1.0 / effective)
            / ((dimension + 2.0) * (dimension + 2.0) + effective),
    );
    let damping =
        1.0 + c_size + 2.0 * max(0.0, ((effective - 1.0) / (dimension + 1.0)).sqrt() - 1.0);
    let length =
        dimension.sqrt() * (1.0 - 1.0 / (4.0 * dimension) + 1.0 / (21.0 * dimension * dimension));
    let mut sigma = SPREAD;
    let mut covariance = vec![0.0; n * n];
    (0..n).for_each(|k| covariance[k * n + k] = 1.0);
    let mut path = vec![0.0; n];
    let mut path_size = vec![0.0; n];
    let mut generation = 0;
    let mut unchanged = 0;
    let mut last = f64::INFINITY;
    while !asker.is_over() {
        generation += 1;
        let axes = symmetric_eigen(&covariance, n);
        let roots: Vec<f64> = axes
            .iter()
            .map(|axis| max(axis.value, 0.0).sqrt())
            .collect();
        // A normal vector stretched along the axes.
        let stretched = |z: &[f64]| -> Vec<f64> {
            (0..n)
                .map(|i| {
                    axes.iter()
                        .zip(&roots)
                        .zip(z)
                        .map(|((a, r), z)| a.vector[i] * r * z)
                        .sum()
                })
                .collect()
        };
        let mut places = Vec::with_capacity(size);
        for _ in 0..size {
            let mut draws = 0;
            let place = loop {
                let z: Vec<f64> = (0..n).map(|_| random.normal()).collect();
                let place: Vec<f64> = mean
                    .iter()
                    .zip(stretched(&z))
                    .map(|(m, y)| m + sigma * y)
                    .collect();
                draws += 1;
                let inside = place.iter().all(|x| (0.0..=1.0).contains(x));
                if inside || draws >= DRAWS {
                    break place
                        .iter()
                        .map(|x| x.clamp(0.0, 1.0))
                        .collect::<Vec<f64>>();
                }
            };
            places.push(place);
        }
        let mut members = asker.ask(places);
        members.sort_by(|a, b| compare(&a.evaluation, &b.evaluation, &asker.scales));
        let steps: Vec<Vec<f64>> = members[..parents]
            .iter()
            .map(|m| {
                m.place
                    .iter()
                    .zip(&mean)
                    .map(|(x, m)| (x - m) / sigma)
                    .collect()
            })
            .collect();
        let step: Vec<f64> = (0..n)
            .map(|k| steps.iter().zip(&weights).map(|(y, w)| w * y[k]).sum())
            .collect();
        for (m, y) in mean.iter_mut().zip(&step) {
            *m += sigma * y;
        }
        // The step in the distribution's own axes.
        let white: Vec<f64> = (axes.iter().zip(&roots))
            .map(|(a, r)| {
                let along: f64 = a.vector.iter().zip(&step).map(|(v, y)| v * y).sum();
                if *r > 0.0 { along / r } else { 0.0 }
            })
            .collect();
        let turned: Vec<f64> = (0..n)
            .map(|i| axes.iter().zip(&white).map(|(a, w)| a.vector[i] * w).sum())
            .collect();
        let keep = (c_size * (2.0 - c_size) * effective).sqrt();
        for (p, w) in path_size.iter_mut().zip(&turned) {
            *p = (1.0 - c_size) * *p + keep * w;
        }
        let long = path_size.iter().map(|p| p * p).sum::<f64>().sqrt();
        let faded = 1.0 - (0..2 * generation).fold(1.0, |p, _| p * (1.0 - c_size));
        let is_steady = long / faded.sqrt() < (1.4 + 2.0 / (dimension + 1.0)) * length;
        let keep = (c_path * (2.0 - c_path) * effective).sqrt();
        for (p, y) in path.iter_mut().zip(&step) {
            *p = (1.0 - c_path) * *p + if is_steady { keep * y } else { 0.0 };
        }
        let lost = if is_steady {
            0.0
        } else {
            c_one * c_path * (2.0 - c_path)
        };
        for i in 0..n {
            for j in 0..n {
                let rank: f64 = steps
                    .iter()
                    .zip(&weights)
                    .map(|(y, w)| w * y[i] * y[j])
                    .sum();
                let own = &mut covariance[i * n + j];
                *own = (1.0 - c_one - c_rank + lost) * *own
                    + c_one * path[i] * path[j]
                    + c_rank * rank;
            }
        }
        sigma *= exp(min(1.0, c_size / damping * (long / length - 1.0)));
        let widest = sigma * roots.iter().copied().fold(0.0, max);
        let best = members[0].evaluation.largest();
        unchanged = if (best - last).abs() <= 1e-14 * best.abs() {
            unchanged + 1
        } else {
            0
        };
        last = best;
        if !(widest > AT_REST) || !sigma.is_finite() || unchanged > 10 + 30 * n / size {
            return;
        }
    }
}
