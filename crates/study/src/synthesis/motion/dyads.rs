//! The dyads that guide a body: all where they are determined, places evenly tried where they are not.

use std::f64::consts::PI;

use kempe_synthesis::{
    BurmesterCurve, C, CurveDrawing, Dyad, DyadCondition, FourBar, Line, Pose, SliderCondition,
    SynthesisError, dyads, fit_four_bars, fixed_guides, moving_guides,
};

use super::given::{Area, Asked, Given};

/// More poses than a dyad of two pins keeps.
pub(super) const MANY: usize = 6;
/// Places along a line or a curve on which pivots are tried.
const ALONG: usize = 48;
/// Places along a side of a box in which pivots are tried.
const ACROSS: usize = 11;
/// Directions in which guides are tried.
const DIRECTIONS: usize = 36;
/// How far curves are followed, in units of the task: as far as any box of use.
pub(super) const REACH: f64 = 300.0;

/// How one of the two joints on a dyad is made.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Sort {
    /// Two pins.
    Link,
    /// A slider on the frame, a pin on the body.
    Slider,
    /// A pin on the frame, a slot of the body.
    Slot,
}

/// Dyads of one sort.
#[derive(Default)]
pub(super) struct Family {
    pub dyads: Vec<Dyad>,
    /// How they were looked for where not all are known.
    pub tried: Option<String>,
}

impl Family {
    fn all(dyads: Vec<Dyad>) -> Self {
        Self { dyads, tried: None }
    }

    fn tried(dyads: Vec<Dyad>, how: impl Into<String>) -> Self {
        let tried = Some(how.into());
        Self { dyads, tried }
    }
}

fn sort_of(dyad: &Dyad) -> Sort {
    match dyad {
        Dyad::Rr { .. } => Sort::Link,
        Dyad::Pr { .. } => Sort::Slider,
        Dyad::Rp { .. } => Sort::Slot,
    }
}

impl Asked {
    /// The dyads of a sort that keep what is given of them.
    ///
    /// # Errors
    /// Why the poses and what is given leave too much open or too little, by the poses and then what is given.
    pub fn family(&self, given: &Given, sort: Sort) -> Result<Family, SynthesisError> {
        let mut found = match sort {
            Sort::Link => self.links(given),
            Sort::Slider | Sort::Slot => self.guides(given, sort),
        }?;
        found.dyads.retain(|dyad| sort_of(dyad) == sort);
        if let Some(tried) = &mut found.tried {
            // Of what is only tried nobody misses one that lies outside; of all there are each is accounted for.
            let before = found.dyads.len();
            found.dyads.retain(|dyad| match *dyad {
                Dyad::Rr { fixed, moving, .. } => self.inside(Some(fixed), Some(moving)),
                Dyad::Pr { moving, .. } => self.inside(None, Some(moving)),
                Dyad::Rp { fixed, .. } => self.inside(Some(fixed), None),
            });
            let outside = before - found.dyads.len();
            if outside > 0 {
                tried.push_str(&format!(" ({outside} of them outside the boxes)"));
            }
        }
        Ok(found)
    }

    /// Four-bars that come near to more poses than can be kept.
    ///
    /// # Errors
    /// As of [`Asked::family`], with the dyad, 0 or 1.
    pub fn four_bars(&self) -> Result<Vec<FourBar>, (usize, SynthesisError)> {
        let [crank, rocker] = &self.given;
        if crank.along.or(rocker.along).is_some() {
            return Ok(Vec::new());
        }
        let corners = |area: &Option<Area>| area.map(|area| [area.low, area.high]);
        let boxes = [corners(&self.pivots_in), corners(&self.pins_in)];
        fit_four_bars(&self.poses, [&crank.conditions, &rocker.conditions], boxes)
    }

    /// Whether what is given of the dyad that is not driven can be of a sort.
    pub fn can_be(&self, sort: Sort) -> bool {
        let [_, given] = &self.given;
        match sort {
            Sort::Link => given.along.is_none(),
            Sort::Slider => given.of_slider(false).is_some(),
            Sort::Slot => given.of_slider(true).is_some(),
        }
    }

    fn links(&self, given: &Given) -> Result<Family, SynthesisError> {
        const UNKNOWNS: usize = 4;
        let poses = &self.poses;
        let conditions = &given.conditions;
        if given.along.is_some() {
            return Ok(Family::default());
        }
        let asked: usize = conditions.iter().map(worth).sum();
        let equations = poses.len() - 1 + asked;
        if poses.len() >= MANY {
            // No link keeps so many; four-bars that come near are sought as a whole.
            return Ok(Family::default());
        }
        if equations >= UNKNOWNS {
            let found = dyads(poses, conditions)?;
            return Ok(Family::all(found.into_iter().map(|d| d.dyad).collect()));
        }
        let few = SynthesisError::TooFew {
            equations,
            unknowns: UNKNOWNS,
        };
        match (poses.as_slice(), conditions.as_slice()) {
            ([a, b, c, d], []) => self.on_curve(&[*a, *b, *c, *d]).unwrap_or(Err(few)),
            ([_, _, _], []) => self.on_grid().unwrap_or(Err(few)),
            ([_, _, _], [DyadCondition::FixedOn(line)]) => {
                let places = places_on(line, self.pivots_in.as_ref()).ok_or(few)?;
                self.each(&places, DyadCondition::FixedAt, "along its line")
            }
            ([_, _, _], [DyadCondition::MovingOn(line)]) => {
                let places = places_on(line, self.pins_in.as_ref()).ok_or(few)?;
                self.each(&places, DyadCondition::MovingAt, "along its line")
            }
            ([first, second], [one, more @ ..]) => self
                .of_two_poses([first, second], one, more)
                .unwrap_or(Err(few)),
            _ => Err(few),
        }
    }

    /// Dyads of three poses by one of their pivots.
    fn each(
        &self,
        places: &[C],
        at: fn(C) -> DyadCondition,
        how: &str,
    ) -> Result<Family, SynthesisError> {
        let mut found = Vec::new();
        let mut refused = None;
        for place in places {
            match dyads(&self.poses, &[at(*place)]) {
                Ok(one) => found.extend(one.into_iter().map(|d| d.dyad)),
                // A place in a pole leaves more open than a pivot.
                Err(error) => {
                    refused.get_or_insert(error);
                }
            }
        }
        match (found.is_empty(), refused) {
            (true, Some(error)) => Err(error),
            _ => Ok(Family::tried(
                found,
                format!("{} places {how}", places.len()),
            )),
        }
    }

    /// Four poses: places on the centre-point curve, evenly by arc; `None` where no box bounds it.
    fn on_curve(&self, poses: &[Pose; 4]) -> Option<Result<Family, SynthesisError>> {
        self.pivots_in.or(self.pins_in)?;
        let curve = match BurmesterCurve::new(poses) {
            Ok(curve) => curve,
            Err(error) => return Some(Err(error)),
        };
        let drawing = CurveDrawing::default().with_reach(REACH);
        let pieces = curve.drawn_where(drawing, |fixed, moving| {
            self.inside(Some(fixed), Some(moving))
        });
        // Chords with their lengths in the plane that is bounded.
        let mut chords: Vec<(usize, [f64; 2], f64)> = Vec::new();
        for piece in &pieces {
            for pair in piece.points.windows(2) {
                let apart = match self.pivots_in {
                    Some(_) => pair[1].fixed - pair[0].fixed,
                    None => pair[1].moving - pair[0].moving,
                };
                let ends = [pair[0].parameter, pair[1].parameter];
                chords.push((piece.of_loop, ends, apart.norm()));
            }
        }
        let whole: f64 = chords.iter().map(|(_, _, length)| length).sum();
        let mut found = Vec::new();
        let mut passed = 0.0;
        let mut next = 0;
        for (of_loop, [from, to], length) in chords {
            while next < ALONG {
                let at = whole * (next as f64 + 0.5) / ALONG as f64;
                if at > passed + length {
                    break;
                }
                let part = (at - passed) / length;
                found.extend(curve.dyad(of_loop, from + part * (to - from)));
                next += 1;
            }
            passed += length;
        }
        Some(Ok(Family::tried(
            found,
            format!("{ALONG} places along the curve of pivots, evenly by arc"),
        )))
    }

    /// Three poses: pivots on a grid; `None` without a box.
    fn on_grid(&self) -> Option<Result<Family, SynthesisError>> {
        let (area, at): (Area, fn(C) -> DyadCondition) = match (self.pivots_in, self.pins_in) {
            (Some(area), _) => (area, DyadCondition::FixedAt),
            (None, Some(area)) => (area, DyadCondition::MovingAt),
            (None, None) => return None,
        };
        let side =
            |k: usize, low: f64, high: f64| low + (high - low) * k as f64 / (ACROSS - 1) as f64;
        let places: Vec<C> = (0..ACROSS * ACROSS)
            .map(|k| {
                let x = side(k % ACROSS, area.low.re, area.high.re);
                C::new(x, side(k / ACROSS, area.low.im, area.high.im))
            })
            .collect();
        Some(self.each(&places, at, "on a grid in its box"))
    }

    /// Two poses with a pivot or a line for one: the other pivot lies on a line, too.
    fn of_two_poses(
        &self,
        [first, second]: [&Pose; 2],
        one: &DyadCondition,
        more: &[DyadCondition],
    ) -> Option<Result<Family, SynthesisError>> {
        // One pivot, and the line of the other one.
        let (is_fixed, places) = match (one, more) {
            (DyadCondition::FixedAt(place), []) => (true, vec![*place]),
            (DyadCondition::MovingAt(place), []) => (false, vec![*place]),
            (DyadCondition::FixedOn(line), [] | [DyadCondition::MovingOn(_)]) => {
                (true, places_on(line, self.pivots_in.as_ref())?)
            }
            (DyadCondition::MovingOn(line), []) => (false, places_on(line, self.pins_in.as_ref())?),
            _ => return None,
        };
        let other_area = match is_fixed {
            true => self.pins_in,
            false => self.pivots_in,
        };
        let mut found = Vec::new();
        for place in &places {
            if let [DyadCondition::MovingOn(line)] = more {
                let both = [
                    DyadCondition::FixedAt(*place),
                    DyadCondition::MovingOn(*line),
                ];
                let one = dyads(&self.poses, &both).unwrap_or_default();
                found.extend(one.into_iter().map(|d| d.dyad));
                continue;
            }
            let ends = [first, second].map(|pose| match is_fixed {
                true => pose.body_point(*place),
                false => pose.place(*place),
            });
            let between = Line::through(ends[0], ends[1])?;
            let bisector = Line {
                point: (ends[0] + ends[1]).scale(0.5),
                direction: C::i() * between.direction,
            };
            let others = places_on(&bisector, Some(&other_area?)).unwrap_or_default();
            found.extend(others.into_iter().map(|other| match is_fixed {
                true => Dyad::rr(*place, other, first),
                false => Dyad::rr(other, *place, first),
            }));
        }
        let how = format!("{} places on the lines that two poses leave", found.len());
        Some(Ok(Family::tried(found, how)))
    }

    /// Whether pivots lie in their boxes.
    pub fn inside(&self, fixed: Option<C>, moving: Option<C>) -> bool {
        let holds = |area: Option<Area>, place: Option<C>| match (area, place) {
            (Some(area), Some(place)) => area.holds(place),
            _ => true,
        };
        holds(self.pivots_in, fixed) && holds(self.pins_in, moving)
    }

    fn guides(&self, given: &Given, sort: Sort) -> Result<Family, SynthesisError> {
        const UNKNOWNS: usize = 3;
        let pin_on_frame = sort == Sort::Slot;
        let Some(conditions) = given.of_slider(pin_on_frame) else {
            return Ok(Family::default());
        };
        let solve = |conditions: &[SliderCondition]| match pin_on_frame {
            true => moving_guides(&self.poses, conditions),
            false => fixed_guides(&self.poses, conditions),
        };
        let asked: usize = conditions
            .iter()
            .map(|c| match c {
                SliderCondition::Along(_) | SliderCondition::PinOn(_) => 1,
                SliderCondition::PinAt(_) => 2,
            })
            .sum();
        let equations = self.poses.len() - 1 + asked;
        if self.poses.len() + 1 == MANY && conditions.is_empty() {
            // Five poses of a slider keep more than it can be asked for: where it is there, it is among the dyads.
            let found = dyads(&self.poses, &[])?;
            return Ok(Family::all(found.into_iter().map(|d| d.dyad).collect()));
        }
        if equations >= UNKNOWNS {
            let found = solve(&conditions)?;
            return Ok(Family::all(found.into_iter().map(|d| d.dyad).collect()));
        }
        let few = SynthesisError::TooFew {
            equations,
            unknowns: UNKNOWNS,
        };
        let area = match pin_on_frame {
            true => self.pivots_in,
            false => self.pins_in,
        };
        let tried: (Vec<SliderCondition>, &str) = match (self.poses.len(), conditions.as_slice()) {
            (3, []) => {
                let all = (0..DIRECTIONS).map(|k| PI * k as f64 / DIRECTIONS as f64);
                (
                    all.map(SliderCondition::Along).collect(),
                    "directions of its guide",
                )
            }
            (2, [SliderCondition::PinOn(line)]) => {
                let places = places_on(line, area.as_ref()).ok_or(few)?;
                let all = places.into_iter().map(SliderCondition::PinAt);
                (all.collect(), "places of its pin")
            }
            _ => return Err(few),
        };
        let mut found = Vec::new();
        let mut refused = None;
        for condition in &tried.0 {
            match solve(&[*condition]) {
                Ok(one) => found.extend(one.into_iter().map(|d| d.dyad)),
                Err(error) => {
                    refused.get_or_insert(error);
                }
            }
        }
        match (found.is_empty(), refused) {
            (true, Some(error)) => Err(error),
            _ => Ok(Family::tried(
                found,
                format!("{} {}", tried.0.len(), tried.1),
            )),
        }
    }
}

/// How many poses a condition stands for.
fn worth(condition: &DyadCondition) -> usize {
    match condition {
        DyadCondition::FixedAt(_) | DyadCondition::MovingAt(_) => 2,
        DyadCondition::FixedOn(_) | DyadCondition::MovingOn(_) => 1,
    }
}

/// Places along the part of a line that lies in a box, its ends included; `None` without a box.
fn places_on(line: &Line, area: Option<&Area>) -> Option<Vec<C>> {
    let area = area?;
    let Some([from, to]) = area.on(line) else {
        return Some(Vec::new());
    };
    let place = |k: usize| {
        let along = from + (to - from) * k as f64 / (ALONG - 1) as f64;
        line.point + line.direction.scale(along)
    };
    Some((0..ALONG).map(place).collect())
}
