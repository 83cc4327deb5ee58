//! What does not meet where a mechanism cannot be assembled, and which lengths would have to be others.

use kempe_mechanism::plan::{Condition, Dyad, Step, Swing};
use kempe_mechanism::pose::{dot, left, sub};
use kempe_mechanism::structure::Marker;
use kempe_mechanism::{Configuration, Design};
use kempe_motion::assemble::OpenStep;
use kempe_motion::drive_path::DrivePath;
use kempe_number::math::hypot;
use kempe_units::Dimension;

use crate::unit::Units;
use crate::words::list;

/// What does not meet.
#[derive(Debug)]
pub(crate) struct Gap {
    /// In words.
    pub message: String,
    /// The links.
    pub links: Vec<String>,
    /// By how much, in sizes of the mechanism, where that is known.
    pub by: Option<f64>,
    /// What would close it, where that is known.
    remedy: Option<String>,
}

impl Default for Gap {
    fn default() -> Self {
        Self {
            message: "a loop does not close".to_owned(),
            links: Vec::new(),
            by: None,
            remedy: None,
        }
    }
}

impl Gap {
    /// What would close it, as an advice.
    pub fn remedy(&self) -> String {
        let known = self.remedy.clone();
        known.unwrap_or_else(|| {
            "change a length, or start the drive where the loop closes".to_owned()
        })
    }
}

/// What does not meet in a step of the plan, with the drives where they are at a place of their path.
pub(crate) fn gap(design: &Design<f64>, at: f64, open: &OpenStep) -> Gap {
    let mechanism = &*design.mechanism;
    let mut coordinates = vec![0.0; mechanism.model.drives.len()];
    let path = DrivePath::new(&mechanism.model, &design.parameters, design.size());
    path.coordinates(at, &mut coordinates);
    let mut state = Configuration::new(mechanism);
    state.set_inputs(mechanism, &coordinates);
    design.solve(&open.branch, &mut state);
    let seen = Seen {
        design,
        state: &state,
        coordinates: &coordinates,
        units: Units::of(&mechanism.model),
    };
    let step = mechanism.plan.steps.get(open.step);
    let measured = step.and_then(|step| seen.measured(step));
    measured.unwrap_or_else(|| of_block(design, open.step))
}

/// A group of which no more is known than that it does not close.
fn of_block(design: &Design<f64>, step: usize) -> Gap {
    let mechanism = &*design.mechanism;
    let block = mechanism.plan.blocks.get(step);
    let unknowns = block.map_or(&[][..], |block| &block.unknowns);
    let mut bodies: Vec<_> = unknowns.iter().map(|u| u.body()).collect();
    bodies.sort_unstable();
    bodies.dedup();
    let links: Vec<String> = bodies.iter().map(|b| mechanism.body_name(*b)).collect();
    let quoted: Vec<String> = links.iter().map(|l| format!("`{l}`")).collect();
    let message = match quoted.as_slice() {
        [] => return Gap::default(),
        [one] => format!("{one} cannot be put in its place"),
        _ => format!("the group of {} does not close", list(&quoted)),
    };
    Gap {
        message,
        links,
        ..Gap::default()
    }
}

/// A length that is to reach, and what it is called.
struct Length {
    name: String,
    size: f64,
}

/// A mechanism with all placed that comes before the step.
struct Seen<'s> {
    design: &'s Design<f64>,
    state: &'s Configuration<f64>,
    coordinates: &'s [f64],
    units: Units,
}

impl Seen<'_> {
    /// The distances that contradict each other, where the step is of a kind that has them.
    fn measured(&self, step: &Step) -> Option<Gap> {
        match *step {
            Step::Dyad(Dyad { a, b, .. }) => {
                let ends = [self.placed(a.at)?, self.placed(b.at)?];
                let sides = [self.side(a.outer, a.inner)?, self.side(b.outer, b.inner)?];
                self.between(ends, sides)
            }
            Step::Swing(
                swing @ Swing {
                    condition:
                        Condition::OnLine { .. }
                        | Condition::BesideLine { .. }
                        | Condition::TravelOn { .. },
                    ..
                },
            ) => self.beside_line(&swing),
            Step::Swing(Swing {
                own,
                at,
                tip,
                condition,
                partner: None,
            }) => {
                let (center, other) = self.circle(condition)?;
                let ends = [self.placed(at)?, center];
                self.between(ends, [self.side(own, tip)?, other])
            }
            _ => None,
        }
    }

    /// The circle that a condition keeps a point on: its centre with its name, and its radius.
    fn circle(&self, condition: Condition) -> Option<(([f64; 2], String), Length)> {
        match condition {
            Condition::Radius { center, input, .. } => {
                let drives = &self.design.mechanism.model.drives;
                let length = Length {
                    name: format!("the cylinder `{}`", drives.get(input.index())?.name),
                    size: *self.coordinates.get(input.index())?,
                };
                Some((self.placed(center)?, length))
            }
            Condition::OnArc { arc, .. } => {
                let circle = self.design.geometry.arc(arc);
                let center = self.state.poses.get(arc.body.index())?;
                let length = Length {
                    name: "the slot".to_owned(),
                    size: circle.radius,
                };
                let name = "the centre of the curved slot".to_owned();
                Some(((center.place(circle.center), name), length))
            }
            _ => None,
        }
    }

    /// Two lengths from two placed points to one that both are to reach.
    fn between(&self, [a, b]: [([f64; 2], String); 2], sides: [Length; 2]) -> Option<Gap> {
        let [first, second] = &sides;
        let distance = hypot(b.0[0] - a.0[0], b.0[1] - a.0[1]);
        let (sum, difference) = (first.size + second.size, (first.size - second.size).abs());
        let [ends, names] = [[&a.1, &b.1], [&first.name, &second.name]];
        let says = |what: &str, length: f64| {
            let (apart, length) = (self.text(distance), self.text(length));
            format!(
                "{} and {} are {apart} apart, but {} and {} {what} {length}",
                ends[0], ends[1], names[0], names[1]
            )
        };
        let (message, by, remedy) = if distance > sum {
            let by = distance - sum;
            let more = self.text(by);
            let remedy = format!(
                "make {} or {} longer, by {more} together at least, or start the drive where {} and {} are nearer to each other",
                names[0], names[1], ends[0], ends[1]
            );
            (says("reach only", sum), by, remedy)
        } else if distance < difference {
            let by = difference - distance;
            let (long, short) = match first.size > second.size {
                true => (first, second),
                false => (second, first),
            };
            let remedy = format!(
                "make {} shorter or {} longer, by {} together at least, or start the drive where {} and {} are farther apart",
                long.name,
                short.name,
                self.text(by),
                ends[0],
                ends[1]
            );
            (says("differ by", difference), by, remedy)
        } else {
            return None;
        };
        Some(self.found(message, by, remedy, &sides))
    }

    /// A length from a placed point to a line.
    fn beside_line(&self, swing: &Swing) -> Option<Gap> {
        let (from, name) = self.placed(swing.at)?;
        let side = self.side(swing.own, swing.tip)?;
        let (normal, k) = self.line(swing)?;
        let distance = (dot(normal, from) - k).abs();
        let by = distance - side.size;
        if !(by > 0.0) {
            return None;
        }
        let tip = self.name(swing.tip)?;
        let (apart, reach) = (self.text(distance), self.text(side.size));
        let message = format!(
            "{name} is {apart} from the line on which {tip} is to lie, but {} reaches only {reach}",
            side.name
        );
        let remedy = format!(
            "make {} longer, by {} at least, or bring that line and {name} nearer to each other",
            side.name,
            self.text(by)
        );
        Some(self.found(message, by, remedy, &[side]))
    }

    /// The line on which the tip of a swinging body is kept, by its unit normal and its distance.
    fn line(&self, swing: &Swing) -> Option<([f64; 2], f64)> {
        let (Condition::OnLine { own, line }
        | Condition::BesideLine { own, line, .. }
        | Condition::TravelOn { own, line, .. }) = swing.condition
        else {
            return None;
        };
        let (origin, along) = self.state.placed_line(self.design, line);
        let geometry = &self.design.geometry;
        // What slides may carry its pin beside the line.
        let from = match swing.partner.as_ref().and_then(|it| Some((it, it.pin?))) {
            Some((carrier, pin)) => {
                let pose = self.state.poses.get(carrier.body.index())?;
                let beside = sub(geometry.marker(own), geometry.marker(pin));
                sub(origin, pose.turn(beside))
            }
            None => origin,
        };
        let (normal, driven) = match swing.condition {
            Condition::BesideLine { input, .. } => (left(along), Some(input)),
            Condition::TravelOn { input, .. } => (along, Some(input)),
            _ => (left(along), None),
        };
        let off = match driven {
            Some(input) => *self.coordinates.get(input.index())?,
            None => 0.0,
        };
        Some((normal, dot(normal, from) + off))
    }

    fn found(&self, message: String, by: f64, remedy: String, sides: &[Length]) -> Gap {
        let names = sides
            .iter()
            .map(|side| side.name.trim_matches('`').to_owned());
        Gap {
            message,
            links: names.collect(),
            by: Some(by / self.design.size()),
            remedy: Some(remedy),
        }
    }

    fn text(&self, length: f64) -> String {
        self.units.text(length, Dimension::LENGTH)
    }

    /// Where a point is, and its name.
    fn placed(&self, m: Marker) -> Option<([f64; 2], String)> {
        let pose = self.state.poses.get(m.body.index())?;
        let p = pose.place(self.design.geometry.marker(m));
        let placed = p[0].is_finite() && p[1].is_finite();
        placed.then_some((p, self.name(m)?))
    }

    fn name(&self, m: Marker) -> Option<String> {
        let mechanism = &self.design.mechanism;
        let at = mechanism.markers.get(m.index as usize)?;
        let point = mechanism.model.points.get(at.point.index());
        point.map(|p| p.name.clone())
    }

    /// The length of a body between two of its points, by the name of the link.
    fn side(&self, from: Marker, to: Marker) -> Option<Length> {
        let mechanism = &self.design.mechanism;
        let at = mechanism.markers.get(to.index as usize)?;
        let link = mechanism.model.links.get(at.link.index())?;
        let [a, b] = [from, to].map(|m| self.design.geometry.marker(m));
        Some(Length {
            name: format!("`{}`", link.name),
            size: hypot(b[0] - a[0], b[1] - a[1]),
        })
    }
}
