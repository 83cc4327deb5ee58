//! Steps restricted near places where branches come near each other.

/// Longest step near a place where branches nearly cross, as a part of the way to it.
const LONGEST_PART: f64 = 0.25;
/// Shortest such step, over the root of the residual between the branches.
const SHORTEST_PART: f64 = 0.02;
/// Places where branches nearly cross that are one.
const SAME_PLACE: f64 = 1e-3;

/// A place where two branches come near each other without crossing: they are followed with steps that shrink towards it.
#[derive(Clone, Debug)]
struct StepRestriction {
    /// Scaled unknowns, between the branches.
    z: Vec<f64>,
    /// Largest residual there, in mechanism sizes and rad: what keeps the branches apart.
    residual: f64,
    /// Part of the usual restricted steps to take: smaller each time that the branches were missed there.
    part: f64,
}

/// All such places of a trace.
#[derive(Clone, Debug, Default)]
pub(super) struct StepRestrictions(Vec<StepRestriction>);

impl StepRestrictions {
    /// Restricts the steps near a place from now on.
    pub fn add(&mut self, z: Vec<f64>, residual: f64) {
        let again = (self.0.iter()).filter(|c| apart(&c.z, &z) < SAME_PLACE);
        let part = kempe_number::powi(0.5, again.count().min(30) as i32);
        self.0.push(StepRestriction { z, residual, part });
    }

    /// The longest step allowed from a point: a part of the way to the nearest such place, and no shorter than
    /// a part of the distance that the branches keep there, which goes with the root of the residual between them.
    pub fn longest_step(&self, z: &[f64]) -> f64 {
        let mut least = f64::INFINITY;
        for restriction in &self.0 {
            let floor = SHORTEST_PART * restriction.residual.sqrt();
            let step = (LONGEST_PART * apart(z, &restriction.z)).max(floor);
            least = least.min(restriction.part * step);
        }
        least
    }
}

/// Distance of two configurations: places in mechanism sizes, angles in rad modulo turns, the path parameter left out.
pub(crate) fn apart(a: &[f64], b: &[f64]) -> f64 {
    let bodies = a.iter().zip(b).take(a.len() - 1).enumerate();
    let squares = bodies.map(|(i, (a, b))| {
        let gap = a - b;
        let turns = if i % 3 == 2 {
            (gap / std::f64::consts::TAU).round()
        } else {
            0.0
        };
        kempe_number::powi(gap - turns * std::f64::consts::TAU, 2)
    });
    squares.sum::<f64>().sqrt()
}
