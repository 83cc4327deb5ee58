//! Where the label of an arrow stands: beyond its tip or beside it, with a leader from further away.

use std::f64::consts::FRAC_PI_2;

use super::{HEAD, Shape};
use crate::labels::{Choice, Room, Spot, Words, around_disc, beside};
use crate::scene::Point;
use kempe_number::math::{atan2, hypot};

/// Font size, mm.
pub(crate) const SIZE: f64 = 2.8;
/// Longest label, mm.
pub(super) const LONGEST: f64 = 26.0;
/// How much worse a label around an arrow's tip is than one that goes on from it.
const AROUND: f64 = 3.0;

/// Where a label stands as seen from its arrow, the same over a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stance {
    /// Its direction, turned from the arrow's own, rad.
    pub turn: f64,
    /// From the arrow to the label, mm.
    pub gap: f64,
    /// From where on the arrow, as a share of its length.
    pub share: f64,
    /// How much worse it is than the best.
    dislike: f64,
}

/// All stances, the best first.
pub(crate) const STANCES: [Stance; 12] = [
    stance(0.0, 1.0, 1.0, 0.0),
    stance(1.05, 1.0, 1.0, 0.3),
    stance(-1.05, 1.0, 1.0, 0.3),
    stance(1.75, 1.0, 1.0, 0.6),
    stance(-1.75, 1.0, 1.0, 0.6),
    stance(FRAC_PI_2, 1.4, 0.5, 1.5),
    stance(-FRAC_PI_2, 1.4, 0.5, 1.5),
    stance(0.0, 3.0, 1.0, 2.5),
    stance(1.05, 3.0, 1.0, 3.0),
    stance(-1.05, 3.0, 1.0, 3.0),
    stance(1.75, 3.0, 1.0, 3.5),
    stance(-1.75, 3.0, 1.0, 3.5),
];

const fn stance(turn: f64, gap: f64, share: f64, dislike: f64) -> Stance {
    Stance {
        turn,
        gap,
        share,
        dislike,
    }
}

/// The room of a label that stands so at a shape.
pub(super) fn room(words: &Words, shape: &Shape, stance: &Stance) -> Room {
    let (tip, along) = shape.tip();
    let back = match *shape {
        Shape::Force { vector, .. } => vector.map(|v| v * (1.0 - stance.share)),
        Shape::Moment { .. } => [0.0; 2],
    };
    let from = [tip[0] - back[0], tip[1] - back[1]];
    let direction = atan2(along[1], along[0]) + stance.turn;
    beside(from, stance.gap, words.half, direction)
}

/// The stances as choices for a label over some poses.
pub(super) fn steady(words: &Words, shapes: &[Option<Shape>]) -> impl Iterator<Item = Choice> {
    let choice = |stance: &Stance| {
        let spot = |shape: &Option<Shape>| {
            let room = room(words, shape.as_ref()?, stance);
            let lines = Vec::new();
            Some(Spot { room, lines })
        };
        Choice {
            dislike: stance.dislike,
            spots: shapes.iter().map(spot).collect(),
        }
    };
    STANCES.iter().map(choice)
}

/// The choices in a single pose: the stances, and all around the tip of an arrow or the arc of a moment.
pub(super) fn free(words: &Words, shape: &Shape, most: usize) -> Vec<Choice> {
    let (at, discs, worse) = match *shape {
        Shape::Force { vector, .. } => {
            let (tip, _) = shape.tip();
            let size = hypot(vector[0], vector[1]);
            // leaders go to the shaft behind the head
            let back = HEAD.min(size) / size;
            let at: Point = [0, 1].map(|k: usize| tip[k] - back * vector[k]);
            (at, [3.0, 1.6], AROUND)
        }
        Shape::Moment { center, radius, .. } => (center, [radius + 1.4, radius + 0.4], 0.0),
    };
    let at = [Some(at)];
    let around = around_disc(&at, discs, words.half).map(|choice| Choice {
        dislike: choice.dislike + worse,
        ..choice
    });
    match shape {
        Shape::Force { .. } => steady(words, &[Some(*shape)])
            .chain(around)
            .take(most)
            .collect(),
        Shape::Moment { .. } => around.take(most).collect(),
    }
}
