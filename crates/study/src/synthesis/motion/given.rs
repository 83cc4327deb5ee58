//! What is asked of a guided body, in numbers.

use kempe_model::{DyadGiven, GuidanceTask, LinkageKind, Model, Scalar, value};
use kempe_synthesis::{C, DyadCondition, Line, Pose, SliderCondition};

/// A box by two of its corners.
#[derive(Clone, Copy)]
pub(in crate::synthesis) struct Area {
    pub low: C,
    pub high: C,
}

impl Area {
    pub fn of([a, b]: [C; 2]) -> Self {
        Self {
            low: C::new(a.re.min(b.re), a.im.min(b.im)),
            high: C::new(a.re.max(b.re), a.im.max(b.im)),
        }
    }

    /// Whether a place lies in it, its edges and what rounding leaves of them included.
    pub fn holds(&self, place: C) -> bool {
        let slack = EDGE * (self.low.norm() + self.high.norm());
        let between = |x: f64, low: f64, high: f64| low - slack <= x && x <= high + slack;
        between(place.re, self.low.re, self.high.re) && between(place.im, self.low.im, self.high.im)
    }

    /// From where to where on a line one is in the box, in lengths from the line's point; `None` where it passes beside.
    pub fn on(&self, line: &Line) -> Option<[f64; 2]> {
        let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
        let axes = [
            (line.point.re, line.direction.re, self.low.re, self.high.re),
            (line.point.im, line.direction.im, self.low.im, self.high.im),
        ];
        for (at, along, low, high) in axes {
            if along == 0.0 {
                if at < low || at > high {
                    return None;
                }
                continue;
            }
            let ends = [(low - at) / along, (high - at) / along];
            from = from.max(ends[0].min(ends[1]));
            to = to.min(ends[0].max(ends[1]));
        }
        (from <= to && from.is_finite() && to.is_finite()).then_some([from, to])
    }
}

/// A place outside a box by less than this part of its corners' distances is on its edge.
const EDGE: f64 = 1e-9;

/// What is given of a dyad, in numbers.
pub(in crate::synthesis) struct Given {
    pub conditions: Vec<DyadCondition>,
    /// The direction of a guide, rad.
    pub along: Option<f64>,
}

impl Given {
    pub fn of(given: &DyadGiven, parameters: &[f64]) -> Self {
        let place = |at: &[Scalar; 2]| place(at, parameters);
        let line = |both: &[[Scalar; 2]; 2]| {
            let [a, b] = both.each_ref().map(place);
            Line::through(a, b)
        };
        let mut conditions = Vec::new();
        conditions.extend(
            given
                .fixed
                .as_ref()
                .map(|p| DyadCondition::FixedAt(place(p))),
        );
        let on = given.fixed_on.as_ref().and_then(line);
        conditions.extend(on.map(DyadCondition::FixedOn));
        conditions.extend(
            given
                .moving
                .as_ref()
                .map(|p| DyadCondition::MovingAt(place(p))),
        );
        let on = given.moving_on.as_ref().and_then(line);
        conditions.extend(on.map(DyadCondition::MovingOn));
        let number = |scalar| value::<f64>(scalar, parameters);
        Self {
            conditions,
            along: given.along.as_ref().map(number),
        }
    }

    /// Whether nothing is given.
    pub fn is_free(&self) -> bool {
        self.conditions.is_empty() && self.along.is_none()
    }

    /// As conditions on a slider with its pin on the body, or on the frame; `None` where what is given is nothing that it has.
    pub fn of_slider(&self, pin_on_frame: bool) -> Option<Vec<SliderCondition>> {
        let own = self.conditions.iter().map(|condition| match *condition {
            DyadCondition::MovingAt(pin) if !pin_on_frame => Some(SliderCondition::PinAt(pin)),
            DyadCondition::MovingOn(line) if !pin_on_frame => Some(SliderCondition::PinOn(line)),
            DyadCondition::FixedAt(pin) if pin_on_frame => Some(SliderCondition::PinAt(pin)),
            DyadCondition::FixedOn(line) if pin_on_frame => Some(SliderCondition::PinOn(line)),
            _ => None,
        });
        let along = self.along.map(|angle| Some(SliderCondition::Along(angle)));
        own.chain(along).collect()
    }
}

/// What is asked.
pub(super) struct Asked {
    pub poses: Vec<Pose>,
    /// Of the dyad that is driven, and of the other.
    pub given: [Given; 2],
    /// The kind, where it is said.
    pub linkage: Option<LinkageKind>,
    /// Where fixed pivots must lie.
    pub pivots_in: Option<Area>,
    /// Where moving pivots must lie.
    pub pins_in: Option<Area>,
}

impl Asked {
    pub fn new(model: &Model, task: &GuidanceTask) -> Self {
        let parameters = model.parameter_values::<f64>();
        let poses = task.poses.iter().map(|pose| Pose {
            origin: place(&pose.origin, &parameters),
            angle: value(&pose.angle, &parameters),
        });
        let area = |corners: &Option<[[Scalar; 2]; 2]>| {
            let corners = corners.as_ref()?.each_ref();
            Some(Area::of(corners.map(|corner| place(corner, &parameters))))
        };
        Self {
            poses: poses.collect(),
            given: (task.dyads.each_ref()).map(|given| Given::of(given, &parameters)),
            linkage: task.linkage,
            pivots_in: area(&task.pivots_in),
            pins_in: area(&task.pins_in),
        }
    }

    /// Whether linkages of a kind are wanted.
    pub fn wants(&self, kind: LinkageKind) -> bool {
        self.linkage.is_none_or(|wanted| wanted == kind)
    }

    /// How far the body goes: the largest distance of its origin's places.
    pub fn way(&self) -> f64 {
        let places = || self.poses.iter().map(|pose| pose.origin);
        let apart = places().flat_map(|a| places().map(move |b| (b - a).norm()));
        apart.fold(0.0, f64::max)
    }
}

pub(in crate::synthesis) fn place(at: &[Scalar; 2], parameters: &[f64]) -> C {
    let [x, y] = at.each_ref().map(|x| value::<f64>(x, parameters));
    C::new(x, y)
}
