//! What stops push on bodies.
//!
//! A stop bounds a measure of the pose, and pushes with a force along it: what that does to a body is the derivative of the measure as the body moves
//! by itself, whatever its joints say.

use kempe_measure::measure::{Along, History, measure};
use kempe_measure::{Abscissa, Series, State};
use kempe_mechanism::{Mechanism, Pose};
use kempe_model::{LinkId, Measure, Pressed};
use kempe_number::Number;

use crate::instant::Rates;
use crate::wrench::{self, Wrench};

/// Puts what stops push at a state's time on the links of its bodies, about the bodies' origins. Rates of these are not known.
pub(crate) fn press<B: Number>(
    all: &[Pressed],
    state: &State<B>,
    on_links: &mut Vec<Wrench<Rates<B>>>,
) {
    on_links.clear();
    for it in all {
        let push: B = it.push.at(state.time, &[]);
        if push.value() == 0.0 {
            continue;
        }
        on_links.resize(state.mechanism().model.links.len(), [Rates::zero(); 3]);
        for (link, slope) in slopes(state, &it.gap) {
            let force = slope.map(|slope| {
                let unknown = B::from_f64(f64::NAN);
                Rates::from_coefficients([push * slope, unknown, unknown])
            });
            wrench::add(&mut on_links[link.index()], force);
        }
    }
}

/// The derivatives of a measure of the pose to the places and the angle of every body, by one of its links: what a force along the measure does to
/// these, about their bodies' origins, is so many times as much.
pub fn slopes<B: Number>(state: &State<B>, of: &Measure) -> Vec<(LinkId, [B; 3])> {
    let mut moved = state.clone();
    moved.abscissa = Abscissa::time(state.time, 1.0);
    let still = |x: Series<B>| Series::constant(x.coefficient(0));
    for pose in &mut moved.poses {
        *pose = pose.map(still);
    }
    for coordinate in &mut moved.coordinates {
        *coordinate = still(*coordinate);
    }
    let rising = |x: Series<B>, by: B| x + Series::variable(B::zero()) * Series::constant(by);
    let mut found = Vec::new();
    for body in 1..moved.poses.len() {
        let Some(link) = first_link(state.mechanism(), body) else {
            continue;
        };
        let at = moved.poses[body];
        let mut along = |pose: Pose<Series<B>>| {
            moved.poses[body] = pose;
            measure(&moved, &History::default(), None, of, Along::Time).coefficient(1)
        };
        let (c, s) = (at.c.coefficient(0), at.s.coefficient(0));
        let slope = [
            along(Pose {
                x: rising(at.x, B::one()),
                ..at
            }),
            along(Pose {
                y: rising(at.y, B::one()),
                ..at
            }),
            along(Pose {
                c: rising(at.c, -s),
                s: rising(at.s, c),
                ..at
            }),
        ];
        moved.poses[body] = at;
        found.push((link, slope));
    }
    found
}

fn first_link(mechanism: &Mechanism, body: usize) -> Option<LinkId> {
    let link = (mechanism.seats.iter()).position(|seat| seat.body.index() == body)?;
    Some(LinkId(link as u32))
}
