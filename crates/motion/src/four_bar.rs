//! Four-bar loops and their Grashof types.

use kempe_mechanism::geometry::Geometry;
use kempe_mechanism::pose::sub;
use kempe_mechanism::structure::{BodyId, Structure};
use kempe_model::PointId;

/// Most loops that are listed.
const LOOP_LIMIT: usize = 64;
/// Lengths equal to this part count as equal: a change-point linkage. A motion tells branches apart whose pivots differ by
/// [`CROSSING`](crate::motion::CROSSING), and these go with the root of what is left between the lengths.
pub const SAME_LENGTH: f64 = crate::motion::CROSSING * crate::motion::CROSSING;

/// A loop of four bodies joined by four pins.
#[derive(Clone, Debug, PartialEq)]
pub struct FourBar {
    /// The bodies in order round the loop, the frame first when it takes part.
    pub bodies: [BodyId; 4],
    /// The pins: `pins[k]` joins `bodies[k]` and the next one.
    pub pins: [PointId; 4],
    /// Lengths between the pins of each body, m.
    pub lengths: [f64; 4],
    /// What the lengths allow.
    pub kind: FourBarKind,
}

/// Grashof types (Grashof 1883): what can turn fully.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FourBarKind {
    /// Shortest + longest < sum of the others, the shortest next to the frame: it turns fully, its opposite rocks.
    CrankRocker,
    /// As above with the frame shortest: both its neighbours turn fully (drag link).
    DoubleCrank,
    /// As above with the coupler shortest: both neighbours of the frame rock, the coupler turns fully.
    DoubleRocker,
    /// As above, the frame not being part of the loop: the shortest body turns fully against the others.
    Grashof,
    /// Shortest + longest = sum of the others: there are poses with all pins in line.
    ChangePoint,
    /// Shortest + longest > sum of the others: nothing turns fully (triple rocker).
    NonGrashof,
    /// One length exceeds the other three together: the loop cannot be closed.
    Open,
}

impl FourBarKind {
    /// The name used in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::CrankRocker => "crank-rocker",
            Self::DoubleCrank => "double crank",
            Self::DoubleRocker => "Grashof double rocker",
            Self::Grashof => "Grashof",
            Self::ChangePoint => "change point",
            Self::NonGrashof => "non-Grashof triple rocker",
            Self::Open => "cannot close",
        }
    }

    /// The type of a loop by its lengths; `lengths[0]` is the frame when `framed`.
    pub fn of(lengths: [f64; 4], framed: bool) -> Self {
        let mut order = [0, 1, 2, 3];
        order.sort_by(|&a, &b| lengths[a].total_cmp(&lengths[b]));
        let [s, p, q, l] = order.map(|i| lengths[i]);
        let total = s + p + q + l;
        let excess = (s + l) - (p + q);
        if l > (s + p + q) * (1.0 + SAME_LENGTH) {
            Self::Open
        } else if excess.abs() <= SAME_LENGTH * total {
            Self::ChangePoint
        } else if excess > 0.0 {
            Self::NonGrashof
        } else if !framed {
            Self::Grashof
        } else {
            match order[0] {
                0 => Self::DoubleCrank,
                2 => Self::DoubleRocker,
                _ => Self::CrankRocker,
            }
        }
    }
}

/// All four-bar loops of a mechanism.
pub fn four_bars(structure: &Structure, geometry: &Geometry<f64>) -> Vec<FourBar> {
    // The pins: every point with the bodies it joins.
    let pins: Vec<Vec<BodyId>> = structure
        .model
        .points
        .iter()
        .map(|point| {
            let mut bodies: Vec<BodyId> =
                point.links.iter().map(|&l| structure.body_of(l)).collect();
            bodies.sort_unstable();
            bodies.dedup();
            bodies
        })
        .collect();
    let mut on_body: Vec<Vec<usize>> = vec![Vec::new(); structure.bodies];
    for (pin, bodies) in pins.iter().enumerate().filter(|(_, b)| b.len() > 1) {
        for body in bodies {
            on_body[body.index()].push(pin);
        }
    }
    let place = |body: BodyId, pin: usize| {
        structure
            .markers
            .iter()
            .zip(&geometry.markers)
            .find(|(at, _)| at.point.index() == pin && structure.body_of(at.link) == body)
            .map_or([f64::NAN; 2], |(_, p)| *p)
    };
    let length = |body: BodyId, a: usize, b: usize| {
        let v = sub(place(body, b), place(body, a));
        kempe_number::math::hypot(v[0], v[1])
    };
    let next = |body: BodyId, not: usize| {
        on_body[body.index()]
            .iter()
            .copied()
            .filter(move |&p| p != not)
    };

    let mut found: Vec<FourBar> = Vec::new();
    // Each loop is met from its lowest body, in one of two directions.
    for a in (0..structure.bodies).map(|b| BodyId(b as u32)) {
        for &p0 in &on_body[a.index()] {
            for &b in pins[p0].iter().filter(|&&b| b > a) {
                for p1 in next(b, p0) {
                    for &c in pins[p1].iter().filter(|&&c| c > a && c != b) {
                        for p2 in next(c, p1).filter(|&p| p != p0) {
                            for &d in pins[p2].iter().filter(|&&d| d > b && d != c) {
                                let closing = next(d, p2)
                                    .filter(|&p| p != p0 && p != p1 && pins[p].contains(&a));
                                for p3 in closing {
                                    let lengths = [
                                        length(a, p3, p0),
                                        length(b, p0, p1),
                                        length(c, p1, p2),
                                        length(d, p2, p3),
                                    ];
                                    let kind = FourBarKind::of(lengths, a == BodyId::GROUND);
                                    let pins = [p0, p1, p2, p3].map(|p| PointId(p as u32));
                                    found.push(FourBar {
                                        bodies: [a, b, c, d],
                                        pins,
                                        lengths,
                                        kind,
                                    });
                                    if found.len() >= LOOP_LIMIT {
                                        return found;
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_the_grashof_types() {
        use FourBarKind::*;
        assert_eq!(FourBarKind::of([60.0, 20.0, 50.0, 40.0], true), CrankRocker);
        assert_eq!(FourBarKind::of([20.0, 50.0, 40.0, 60.0], true), DoubleCrank);
        assert_eq!(
            FourBarKind::of([50.0, 40.0, 20.0, 60.0], true),
            DoubleRocker
        );
        assert_eq!(
            FourBarKind::of([410.0, 230.0, 430.0, 210.0], true),
            ChangePoint
        );
        let almost = [60.0, 20.0, 60.0, 20.000_000_1];
        assert_eq!(FourBarKind::of(almost, true), CrankRocker);
        assert_eq!(FourBarKind::of([60.0, 50.0, 30.0, 30.0], true), NonGrashof);
        assert_eq!(FourBarKind::of([200.0, 50.0, 30.0, 30.0], true), Open);
        assert_eq!(FourBarKind::of([60.0, 20.0, 50.0, 40.0], false), Grashof);
    }
}
