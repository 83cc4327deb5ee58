//! Random mechanisms: the pose first, the dimensions measured from it, so that every group closes at the start.

use super::{
    Rng, SDrive, SJoint, SKind, SLink, SmoothCurve, Spec, V, add, cross, dot, norm, polar, sub,
    times, turn,
};

/// What a step adds to a mechanism: an Assur group, or a body that an existing one carries along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    Rrr,
    /// Two bars in line at the start but for a sliver.
    Sliver,
    /// R and R outside, a slider inside.
    Rpr,
    /// A slider on a line, a bar from its pin.
    Rrp,
    /// The same without a body of its own for the slider.
    PinInSlot,
    /// A bar with a slot over a placed point.
    SlotOnPin,
    /// A bar whose pin is in a curved slot.
    PinInArc,
    /// A plate with a curved slot over a placed point.
    ArcOnPin,
    /// A bar whose pin is on a smooth curve.
    PinOnCurve,
    /// A plate with a smooth curve over a placed point.
    CurveOnPin,
    /// A wheel turned over a belt by a link that is pinned to the same arm.
    Belt,
    /// Two sliders pinned together.
    Prp,
    /// Pinned, sliding, sliding.
    Rpp,
    /// A bar with pins in two slots, its angle from a third: a slider on it.
    TwoSlots,
    /// A cylinder of held length, swinging a bar.
    Cylinder,
    /// A slider held along its line.
    HeldSlider,
    /// A bar turned against its carrier by a held drive.
    HeldBar,
    Gear,
    Ring,
    /// A rack moved by a pinion.
    Rack,
    /// A pinion turned by a rack.
    Pinion,
    Weld,
    /// Class III: a ternary plate on three bars.
    Triad,
    /// A roller in a slot: its turning is idle.
    Roller,
    /// Two bars with an offset slider, its line on a moving link where there is one.
    OffsetSlider,
}

pub const GROUPS: [Group; 23] = [
    Group::Rrr,
    Group::Sliver,
    Group::Rpr,
    Group::Rrp,
    Group::PinInSlot,
    Group::SlotOnPin,
    Group::Prp,
    Group::Rpp,
    Group::TwoSlots,
    Group::Cylinder,
    Group::HeldSlider,
    Group::HeldBar,
    Group::Gear,
    Group::Ring,
    Group::Rack,
    Group::Pinion,
    Group::Weld,
    Group::Triad,
    Group::Roller,
    Group::OffsetSlider,
    Group::PinInArc,
    Group::ArcOnPin,
    Group::Belt,
];

/// Every so many seeds a pin on a smooth curve comes after the groups of a recipe.
const CURVE_EVERY: u64 = 5;

/// The groups of a recipe with what its seed adds.
fn with_curve(seed: u64, mut groups: Vec<Group>) -> Vec<Group> {
    if seed.is_multiple_of(CURVE_EVERY) {
        let pin_moves = (seed / CURVE_EVERY).is_multiple_of(2);
        groups.push(if pin_moves {
            Group::PinOnCurve
        } else {
            Group::CurveOnPin
        });
    }
    groups
}

/// What moves the first link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driver {
    Turn,
    Cylinder,
    Slide,
    /// A drive between two links that both may move.
    Floating,
}

/// How to make a mechanism; proptest shrinks this.
#[derive(Clone, Debug)]
pub struct Recipe {
    pub seed: u64,
    pub driver: Driver,
    pub groups: Vec<Group>,
    /// Power of ten of its size in m.
    pub decade: f64,
    pub hints: bool,
}

/// A made mechanism: its data and which links may turn idly.
#[derive(Clone, Debug)]
pub struct Made {
    pub spec: Spec,
    pub idle: Vec<usize>,
}

struct Maker {
    rng: Rng,
    spec: Spec,
    unit: f64,
    count: usize,
    idle: Vec<usize>,
}

/// A point by its name, where it is and a link that carries it.
#[derive(Clone, Debug)]
struct At {
    name: String,
    link: usize,
    world: V,
}

impl Maker {
    fn name(&mut self) -> String {
        self.count += 1;
        format!("P{}", self.count)
    }

    fn somewhere(&mut self) -> V {
        [
            self.rng.range(-1.0, 1.0) * self.unit,
            self.rng.range(-1.0, 1.0) * self.unit,
        ]
    }

    fn link(&mut self, pose: [f64; 3]) -> usize {
        let index = self.spec.links.len();
        let name = if index == 0 {
            "frame".into()
        } else {
            format!("l{index}")
        };
        self.spec.links.push(SLink {
            name,
            points: Vec::new(),
            pose,
        });
        index
    }

    /// Names a new point of a link at a place in the frame.
    fn mark(&mut self, link: usize, world: V) -> At {
        let name = self.name();
        self.mark_as(link, &name, world);
        At { name, link, world }
    }

    fn mark_as(&mut self, link: usize, name: &str, world: V) {
        let local = self.spec.links[link].local(world);
        self.spec.links[link].points.push((name.to_owned(), local));
    }

    /// A bar between two points of other links, its x axis along it.
    fn bar(&mut self, a: &At, b: &At) -> usize {
        let v = sub(b.world, a.world);
        let link = self.link([a.world[0], a.world[1], v[1].atan2(v[0])]);
        self.spec.links[link]
            .points
            .push((a.name.clone(), [0.0, 0.0]));
        self.spec.links[link]
            .points
            .push((b.name.clone(), [norm(v), 0.0]));
        link
    }

    /// A link laid anyhow through a pin.
    fn plate(&mut self, pins: &[&At]) -> usize {
        let at = if self.rng.chance(0.5) {
            pins[0].world
        } else {
            self.somewhere()
        };
        let angle = self.rng.angle();
        let link = self.link([at[0], at[1], angle]);
        for pin in pins {
            self.mark_as(link, &pin.name, pin.world);
        }
        link
    }

    /// A bar or a plate through two points.
    fn rod(&mut self, a: &At, b: &At) -> usize {
        if self.rng.chance(0.6) {
            self.bar(a, b)
        } else {
            self.plate(&[a, b])
        }
    }

    fn any_link(&mut self) -> usize {
        let n = self.spec.links.len();
        // The frame half as often again as any other.
        let pick = self.rng.below(2 * n + 1);
        if pick >= 2 * n { 0 } else { pick / 2 }
    }

    /// A point of a link: one that is there, or a new one.
    fn attach(&mut self, link: usize) -> At {
        let known = self.spec.links[link].points.len();
        if known > 0 && self.rng.chance(0.4) {
            let (name, local) = self.spec.links[link].points[self.rng.below(known)].clone();
            let world = self.spec.links[link].world(local);
            return At { name, link, world };
        }
        let world = self.somewhere();
        self.mark(link, world)
    }

    /// Two points of different links (of one where there is only one), well apart.
    fn two_ends(&mut self) -> (At, At) {
        loop {
            let (i, j) = (self.any_link(), self.any_link());
            if i == j && self.spec.links.len() > 1 {
                continue;
            }
            let a = self.attach(i);
            let b = self.attach(j);
            if a.name != b.name && norm(sub(a.world, b.world)) > 0.2 * self.unit {
                return (a, b);
            }
        }
    }

    /// A new point well apart from others, not in line with them.
    fn clear_of(&mut self, others: &[V]) -> V {
        loop {
            let p = self.somewhere();
            let apart = others.iter().all(|q| norm(sub(p, *q)) > 0.2 * self.unit);
            let bent = others.len() < 2 || {
                let (u, v) = (sub(others[0], p), sub(others[1], p));
                cross(u, v).abs() > 0.15 * norm(u) * norm(v)
            };
            if apart && bent {
                return p;
            }
        }
    }

    /// A line on a link through a place; returns its points' names and its direction's angle.
    fn line(&mut self, link: usize, through: V, angle: f64) -> [String; 2] {
        let (s, e) = (
            self.rng.range(0.3, 0.9) * self.unit,
            self.rng.range(0.3, 0.9) * self.unit,
        );
        let from = self.mark(link, add(through, polar(-s, angle)));
        let to = self.mark(link, add(through, polar(e, angle)));
        [from.name, to.name]
    }

    /// Ends of an arc on a link that passes a place with a tangent of this angle; its radius and whether its centre lies
    /// on the left of the way.
    fn arc(&mut self, link: usize, through: V, tangent: f64) -> ([String; 2], f64, bool) {
        let radius = self.rng.range(0.2, 1.0) * self.unit;
        let left = self.rng.chance(0.5);
        let side = if left { 1.0 } else { -1.0 };
        let out = tangent - side * std::f64::consts::FRAC_PI_2;
        let center = add(through, polar(-radius, out));
        let (back, ahead) = (self.rng.range(0.2, 1.3), self.rng.range(0.2, 1.3));
        let ends = [-back, ahead].map(|by| {
            let at = add(center, polar(radius, out + side * by));
            self.mark(link, at).name
        });
        (ends, radius, left)
    }

    /// Points of `link` with a smooth curve through `through`, between two of them, that has the direction `tangent` there.
    fn curve(&mut self, link: usize, through: V, tangent: f64) -> (Vec<String>, bool) {
        let closed = self.rng.chance(0.5);
        let size = self.rng.range(0.3, 1.0) * self.unit;
        let bend = self.rng.range(-0.5, 0.5);
        let points: Vec<V> = (0..7)
            .map(|k| match closed {
                true => {
                    let angle = f64::from(k) * std::f64::consts::TAU / 7.0;
                    let angle = angle + self.rng.range(-0.15, 0.15);
                    polar(self.rng.range(0.8, 1.2) * size, angle)
                }
                false => {
                    let x = f64::from(k - 3) * 0.4 + self.rng.range(-0.08, 0.08);
                    times([x, bend * x * x + self.rng.range(-0.05, 0.05)], size)
                }
            })
            .collect();
        let curve = SmoothCurve::through(&points, closed);
        let (place, along) = curve.at(2 + self.rng.below(2), self.rng.range(0.2, 0.8));
        let by = tangent - along[1].atan2(along[0]);
        let names = points.iter().map(|p| {
            let at = add(through, turn(sub(*p, place), by));
            self.mark(link, at).name
        });
        (names.collect(), closed)
    }

    /// A slider of `link` at a point named there, on a new line of `on` with the direction `angle`.
    fn slide(&mut self, link: usize, at: &At, on: usize, angle: f64) -> usize {
        let line = self.line(on, at.world, angle);
        self.slide_on(link, &at.name, on, line, angle)
    }

    fn slide_on(
        &mut self,
        link: usize,
        at: &str,
        on: usize,
        line: [String; 2],
        angle: f64,
    ) -> usize {
        self.spec.joints.push(SJoint::Slider {
            link,
            at: at.to_owned(),
            on,
            line,
            angle: super::wrapped(self.spec.links[link].pose[2] - angle),
        });
        self.spec.joints.len() - 1
    }

    fn held(&mut self, kind: SKind, at: f64) {
        self.spec.drives.push(SDrive {
            kind,
            from: at,
            to: at,
            time: 1.0,
            law: None,
        });
    }

    /// Coordinate along a line from its first point.
    fn travel(&self, on: usize, line: &[String; 2], world: V) -> f64 {
        let link = &self.spec.links[on];
        let find = |n: &str| link.world(link.point(n).expect("on the line"));
        let (a, b) = (find(&line[0]), find(&line[1]));
        let v = sub(b, a);
        dot(v, sub(world, a)) / norm(v)
    }

    fn add(&mut self, group: Group) {
        match group {
            Group::Rrr => {
                let (a, b) = self.two_ends();
                let inner = self.clear_of(&[a.world, b.world]);
                let c = At {
                    name: self.name(),
                    link: 0,
                    world: inner,
                };
                self.rod(&a, &c);
                self.rod(&b, &c);
            }
            Group::Sliver => {
                let (a, b) = self.two_ends();
                let v = sub(b.world, a.world);
                let part = *[0.4, 1.7, -0.6].get(self.rng.below(3)).expect("three");
                let off = 10_f64.powf(self.rng.range(-5.0, -2.0));
                let normal = [-v[1] * off, v[0] * off];
                let inner = add(add(a.world, super::times(v, part)), normal);
                let c = At {
                    name: self.name(),
                    link: 0,
                    world: inner,
                };
                self.bar(&a, &c);
                self.bar(&b, &c);
            }
            Group::Rpr => {
                let (a, b) = self.two_ends();
                let first = self.plate(&[&a]);
                let second = self.plate(&[&b]);
                let near = self.clear_of(&[a.world, b.world]);
                let at = self.mark(second, near);
                // Not across the line of the pins, where the group is singular.
                let v = sub(b.world, a.world);
                let angle = v[1].atan2(v[0]) + self.rng.range(-1.2, 1.2);
                self.slide(second, &at, first, angle);
            }
            Group::Rrp => {
                let (a, _) = self.two_ends();
                let on = self.any_link();
                let inner = self.clear_of(&[a.world]);
                let c = At {
                    name: self.name(),
                    link: 0,
                    world: inner,
                };
                self.rod(&a, &c);
                let slider = self.plate(&[&c]);
                let v = sub(inner, a.world);
                let angle = v[1].atan2(v[0]) + self.rng.range(-1.2, 1.2);
                self.slide(slider, &c, on, angle);
            }
            Group::OffsetSlider => {
                let (a, _) = self.two_ends();
                let on = self.any_link();
                let inner = self.clear_of(&[a.world]);
                let c = At {
                    name: self.name(),
                    link: 0,
                    world: inner,
                };
                self.rod(&a, &c);
                let slider = self.plate(&[&c]);
                let v = sub(inner, a.world);
                let angle = v[1].atan2(v[0]) + self.rng.range(-1.2, 1.2);
                let beside = self.somewhere();
                let at = self.mark(slider, beside);
                self.slide(slider, &at, on, angle);
            }
            Group::PinInSlot => {
                let (a, _) = self.two_ends();
                let on = self.any_link();
                let inner = self.clear_of(&[a.world]);
                let c = At {
                    name: self.name(),
                    link: 0,
                    world: inner,
                };
                let rod = self.rod(&a, &c);
                let v = sub(inner, a.world);
                let angle = v[1].atan2(v[0]) + self.rng.range(-1.2, 1.2);
                let line = self.line(on, inner, angle);
                self.spec.joints.push(SJoint::Slot {
                    link: rod,
                    pin: c.name,
                    on,
                    line,
                });
            }
            Group::SlotOnPin => {
                let (a, b) = self.two_ends();
                let first = self.plate(&[&a]);
                let v = sub(b.world, a.world);
                let angle = v[1].atan2(v[0]) + self.rng.range(-1.2, 1.2);
                let line = self.line(first, b.world, angle);
                self.spec.joints.push(SJoint::Slot {
                    link: b.link,
                    pin: b.name,
                    on: first,
                    line,
                });
            }
            Group::PinInArc => {
                let (a, _) = self.two_ends();
                let on = self.any_link();
                let inner = self.clear_of(&[a.world]);
                let c = At {
                    name: self.name(),
                    link: 0,
                    world: inner,
                };
                let rod = self.rod(&a, &c);
                let v = sub(inner, a.world);
                let angle = v[1].atan2(v[0]) + self.rng.range(-1.2, 1.2);
                let (ends, radius, left) = self.arc(on, inner, angle);
                self.spec.joints.push(SJoint::Arc {
                    link: rod,
                    pin: c.name,
                    on,
                    ends,
                    radius,
                    left,
                });
            }
            Group::ArcOnPin => {
                let (a, b) = self.two_ends();
                let first = self.plate(&[&a]);
                let v = sub(b.world, a.world);
                let angle = v[1].atan2(v[0]) + self.rng.range(-1.2, 1.2);
                let (ends, radius, left) = self.arc(first, b.world, angle);
                self.spec.joints.push(SJoint::Arc {
                    link: b.link,
                    pin: b.name,
                    on: first,
                    ends,
                    radius,
                    left,
                });
            }
            Group::PinOnCurve => {
                let (a, _) = self.two_ends();
                let on = self.any_link();
                let inner = self.clear_of(&[a.world]);
                let c = At {
                    name: self.name(),
                    link: 0,
                    world: inner,
                };
                let rod = self.rod(&a, &c);
                let v = sub(inner, a.world);
                let angle = v[1].atan2(v[0]) + self.rng.range(-1.2, 1.2);
                let (through, closed) = self.curve(on, inner, angle);
                self.spec.joints.push(SJoint::Curve {
                    link: rod,
                    pin: c.name,
                    on,
                    through,
                    closed,
                });
            }
            Group::CurveOnPin => {
                let (a, b) = self.two_ends();
                let first = self.plate(&[&a]);
                let v = sub(b.world, a.world);
                let angle = v[1].atan2(v[0]) + self.rng.range(-1.2, 1.2);
                let (through, closed) = self.curve(first, b.world, angle);
                self.spec.joints.push(SJoint::Curve {
                    link: b.link,
                    pin: b.name,
                    on: first,
                    through,
                    closed,
                });
            }
            Group::Belt => {
                // The first pin, from somewhere on, of two links.
                let links = &self.spec.links;
                let pins: Vec<(usize, usize, V)> = (0..links.len())
                    .flat_map(|arm| (0..links.len()).map(move |other| (arm, other)))
                    .filter(|(arm, other)| arm != other)
                    .filter_map(|(arm, other)| {
                        let mut own = links[arm].points.iter();
                        let shared = own.find(|p| links[other].point(&p.0).is_some())?;
                        Some((arm, other, links[arm].world(shared.1)))
                    })
                    .collect();
                if pins.is_empty() {
                    return;
                }
                let (arm, other, axis) = pins[self.rng.below(pins.len())];
                let center = self.clear_of(&[axis]);
                let center = self.mark(arm, center);
                let wheel = self.plate(&[&center]);
                let end = self.clear_of(&[center.world]);
                self.mark(wheel, end);
                let apart = norm(sub(center.world, axis));
                let radii = [0, 1].map(|_| self.rng.range(0.1, 0.45) * apart);
                let crossed = self.rng.chance(0.5);
                let second = if crossed { radii[1] } else { -radii[1] };
                let on_arm = |l: usize| self.spec.links[l].pose[2] - self.spec.links[arm].pose[2];
                let phase = (radii[0] * on_arm(wheel) + second * on_arm(other)) / radii[0];
                self.spec.joints.push(SJoint::Belt {
                    a: wheel,
                    b: other,
                    arm,
                    radii,
                    crossed,
                    phase,
                });
            }
            Group::Prp => {
                let (i, j) = (self.any_link(), self.any_link());
                let place = self.somewhere();
                let c = At {
                    name: self.name(),
                    link: 0,
                    world: place,
                };
                let first = self.plate(&[&c]);
                let second = self.plate(&[&c]);
                let angle = self.rng.angle();
                self.slide(first, &c, i, angle);
                let beside = self.somewhere();
                let at = self.mark(second, beside);
                let other = angle + self.rng.range(0.4, 2.7);
                self.slide(second, &at, j, other);
            }
            Group::Rpp => {
                let (a, _) = self.two_ends();
                let on = self.any_link();
                let first = self.plate(&[&a]);
                let place = self.somewhere();
                let angle = self.rng.angle();
                let second = self.link([place[0], place[1], angle]);
                let at = self.mark(second, place);
                // One of the two lines is on the moving link, whichever way round.
                let (way, across) = (self.rng.angle(), self.rng.range(0.4, 2.7));
                if self.rng.chance(0.5) {
                    self.slide(second, &at, first, way);
                } else {
                    let line = self.line(second, a.world, way);
                    self.slide_on(first, &a.name, second, line, way);
                }
                self.slide(second, &at, on, way + across);
            }
            Group::TwoSlots => {
                // A rod with both pins in slots, its angle from a held drive against the link of one slot.
                let (i, j) = (self.any_link(), self.any_link());
                let (p, q) = (self.somewhere(), self.somewhere());
                let angle = self.rng.angle();
                let rod = self.link([p[0], p[1], angle]);
                let (a, b) = (self.mark(rod, p), self.mark(rod, q));
                let way = self.rng.angle();
                let across = self.rng.range(0.4, 2.7);
                for (at, on, angle) in [(a, i, way), (b, j, way + across)] {
                    let line = self.line(on, at.world, angle);
                    self.spec.joints.push(SJoint::Slot {
                        link: rod,
                        pin: at.name,
                        on,
                        line,
                    });
                }
                // A driven angle counts its turns.
                let relative = super::wrapped(angle - self.spec.links[i].pose[2]);
                self.spec.links[rod].pose[2] = self.spec.links[i].pose[2] + relative;
                self.held(
                    SKind::Turn {
                        link: rod,
                        relative_to: i,
                    },
                    relative,
                );
            }
            Group::Cylinder => {
                let (a, b) = self.two_ends();
                let eye = self.clear_of(&[a.world, b.world]);
                let bar = self.plate(&[&a]);
                let tip = self.mark(bar, eye);
                let length = norm(sub(eye, b.world));
                self.held(
                    SKind::Cylinder {
                        a: (b.link, b.name),
                        b: (bar, tip.name),
                    },
                    length,
                );
            }
            Group::HeldSlider => {
                let on = self.any_link();
                let place = self.somewhere();
                let angle = self.rng.angle();
                let slider = self.link([place[0], place[1], angle]);
                let at = self.mark(slider, place);
                let way = self.rng.angle();
                let line = self.line(on, place, way);
                let joint = self.slide_on(slider, &at.name, on, line.clone(), way);
                let travel = self.travel(on, &line, place);
                self.held(SKind::Slide { joint }, travel);
            }
            Group::HeldBar => {
                let on = self.any_link();
                let a = self.attach(on);
                let bar = self.plate(&[&a]);
                let end = self.clear_of(&[a.world]);
                self.mark(bar, end);
                let relative =
                    super::wrapped(self.spec.links[bar].pose[2] - self.spec.links[on].pose[2]);
                self.spec.links[bar].pose[2] = self.spec.links[on].pose[2] + relative;
                self.held(
                    SKind::Turn {
                        link: bar,
                        relative_to: on,
                    },
                    relative,
                );
            }
            Group::Gear | Group::Ring => {
                let arm = self.any_link();
                let other = loop {
                    let other = self.any_link();
                    if other != arm || self.spec.links.len() == 1 {
                        break other;
                    }
                };
                if other == arm {
                    return;
                }
                let a = self.attach(arm);
                let gear = self.plate(&[&a]);
                let end = self.clear_of(&[a.world]);
                self.mark(gear, end);
                let teeth = [
                    (12 + self.rng.below(40)) as f64,
                    (12 + self.rng.below(40)) as f64,
                ];
                let internal = group == Group::Ring && teeth[0] != teeth[1];
                let second = if internal { -teeth[1] } else { teeth[1] };
                let angle = |l: usize| self.spec.links[l].pose[2];
                let on_arm = |l: usize| angle(l) - angle(arm);
                let phase = (teeth[0] * on_arm(gear) + second * on_arm(other)) / teeth[0];
                self.spec.joints.push(SJoint::Gears {
                    a: gear,
                    b: other,
                    arm,
                    teeth,
                    internal,
                    phase,
                });
            }
            Group::Rack | Group::Pinion => {
                if self.spec.links.len() < 2 {
                    return;
                }
                let wheel = 1 + self.rng.below(self.spec.links.len() - 1);
                let on = self.any_link();
                let radius = self.rng.range(0.1, 0.4) * self.unit;
                let left = self.rng.chance(0.5);
                let side = if left { 1.0 } else { -1.0 };
                if group == Group::Rack {
                    // A bar sliding along a line of `on`, its teeth parallel to it.
                    let center = self.attach(wheel);
                    let way = self.rng.angle();
                    let place = self.somewhere();
                    let bar = self.link([place[0], place[1], way]);
                    let at = self.mark(bar, place);
                    let skew = self.rng.range(-0.6, 0.6);
                    self.slide(bar, &at, on, way + skew);
                    self.rack(bar, wheel, &center, radius, left, side);
                } else {
                    // A pinion pinned to `on` and turned by a link that passes.
                    let center = self.attach(on);
                    let pinion = self.plate(&[&center]);
                    self.rack(wheel, pinion, &center, radius, left, side);
                }
            }
            Group::Weld => {
                let to = self.any_link();
                if self.idle.contains(&to) {
                    return;
                }
                let at = self.attach(to);
                let other = self.plate(&[&at]);
                let end = self.clear_of(&[at.world]);
                self.mark(other, end);
                let angle =
                    super::wrapped(self.spec.links[other].pose[2] - self.spec.links[to].pose[2]);
                self.spec.links[other].pose[2] = self.spec.links[to].pose[2] + angle;
                self.spec.joints.push(SJoint::Weld {
                    a: to,
                    b: other,
                    at: at.name,
                    angle,
                });
            }
            Group::Triad => {
                let (a, b) = self.two_ends();
                let third = loop {
                    let link = self.any_link();
                    let p = self.attach(link);
                    let apart =
                        |q: &At| p.name != q.name && norm(sub(p.world, q.world)) > 0.2 * self.unit;
                    if apart(&a) && apart(&b) {
                        break p;
                    }
                };
                let mut corners: Vec<At> = Vec::new();
                for outer in [&a, &b, &third] {
                    let mut others: Vec<V> = vec![outer.world];
                    others.extend(corners.iter().map(|c| c.world));
                    let world = loop {
                        let p = self.somewhere();
                        if others.iter().all(|q| norm(sub(p, *q)) > 0.3 * self.unit) {
                            break p;
                        }
                    };
                    corners.push(At {
                        name: self.name(),
                        link: 0,
                        world,
                    });
                }
                let all: Vec<&At> = corners.iter().collect();
                self.plate(&all);
                for (outer, corner) in [&a, &b, &third].into_iter().zip(&corners) {
                    self.bar(outer, corner);
                }
            }
            Group::Roller => {
                let (a, _) = self.two_ends();
                let on = self.any_link();
                let inner = self.clear_of(&[a.world]);
                let c = At {
                    name: self.name(),
                    link: 0,
                    world: inner,
                };
                self.rod(&a, &c);
                let angle = self.rng.angle();
                let roller = self.link([inner[0], inner[1], angle]);
                self.spec.links[roller]
                    .points
                    .push((c.name.clone(), [0.0, 0.0]));
                self.idle.push(roller);
                let v = sub(inner, a.world);
                let angle = v[1].atan2(v[0]) + self.rng.range(-1.2, 1.2);
                let line = self.line(on, inner, angle);
                self.spec.joints.push(SJoint::Slot {
                    link: roller,
                    pin: c.name,
                    on,
                    line,
                });
            }
        }
    }

    fn rack(
        &mut self,
        rack: usize,
        pinion: usize,
        center: &At,
        radius: f64,
        left: bool,
        side: f64,
    ) {
        if rack == pinion {
            return;
        }
        let bar = &self.spec.links[rack];
        let s = bar.local(center.world)[0];
        let angle = self.spec.links[pinion].pose[2] - bar.pose[2];
        self.spec.joints.push(SJoint::Rack {
            rack,
            pinion,
            center: center.name.clone(),
            radius,
            left,
            offset: s + side * radius * angle,
        });
    }
}

/// Makes the mechanism of a recipe.
pub fn make(recipe: &Recipe) -> Made {
    let mut m = Maker {
        rng: Rng(recipe.seed),
        spec: Spec {
            hints: recipe.hints,
            ..Spec::default()
        },
        unit: 10_f64.powf(recipe.decade),
        count: 0,
        idle: Vec::new(),
    };
    m.link([0.0; 3]);
    let place = m.somewhere();
    let pivot = m.mark(0, place);
    match recipe.driver {
        Driver::Slide => {
            let angle = m.rng.angle();
            let slider = m.link([place[0], place[1], angle]);
            let at = m.mark(slider, place);
            let way = m.rng.angle();
            let line = m.line(0, place, way);
            let joint = m.slide_on(slider, &at.name, 0, line.clone(), way);
            let end = m.clear_of(&[place]);
            m.mark(slider, end);
            let from = m.travel(0, &line, place);
            let by = m.rng.range(0.05, 0.6) * m.unit * sign(&mut m.rng);
            m.spec.drives.push(SDrive {
                kind: SKind::Slide { joint },
                from,
                to: from + by,
                time: 2.0,
                law: None,
            });
        }
        _ => {
            let end = m.clear_of(&[place]);
            let tip = At {
                name: m.name(),
                link: 0,
                world: end,
            };
            let crank = m.rod(&pivot, &tip);
            if recipe.driver == Driver::Cylinder {
                let foot = m.clear_of(&[place, end]);
                let foot = m.mark(0, foot);
                let length = norm(sub(end, foot.world));
                let by = m.rng.range(0.02, 0.4) * m.unit * sign(&mut m.rng);
                m.spec.drives.push(SDrive {
                    kind: SKind::Cylinder {
                        a: (0, foot.name),
                        b: (crank, tip.name),
                    },
                    from: length,
                    to: (length + by).max(0.1 * length),
                    time: 2.0,
                    law: None,
                });
            } else {
                let from = m.spec.links[crank].pose[2];
                let by = if m.rng.chance(0.5) {
                    m.rng.range(0.2, 2.0)
                } else {
                    std::f64::consts::TAU
                } * sign(&mut m.rng);
                m.spec.drives.push(SDrive {
                    kind: SKind::Turn {
                        link: crank,
                        relative_to: 0,
                    },
                    from,
                    to: from + by,
                    time: 2.0,
                    law: None,
                });
            }
        }
    }
    for &group in &recipe.groups {
        m.add(group);
    }
    if recipe.driver == Driver::Floating {
        let n = m.spec.links.len();
        let (i, j) = (m.rng.below(n), m.rng.below(n));
        let taken = m.spec.drives.iter().skip(1).any(|d| match d.kind {
            SKind::Turn { link, relative_to } => {
                (link, relative_to) == (i, j) || (link, relative_to) == (j, i)
            }
            _ => false,
        });
        if i != j && i != 0 && !taken {
            let from = m.spec.links[i].pose[2] - m.spec.links[j].pose[2];
            let by = m.spec.drives[0].to - m.spec.drives[0].from;
            let drive = &mut m.spec.drives[0];
            drive.kind = SKind::Turn {
                link: i,
                relative_to: j,
            };
            (drive.from, drive.to) = (from, from + by);
        }
    }
    if recipe.driver == Driver::Floating {
        // The first bar may hang on nothing now.
        m.idle.push(1);
    }
    Made {
        spec: m.spec,
        idle: m.idle,
    }
}

/// Any recipe; shrinks by leaving groups out.
pub fn recipes(hints: f64) -> impl proptest::strategy::Strategy<Value = Recipe> {
    use proptest::prelude::*;
    let drivers = [
        Driver::Turn,
        Driver::Turn,
        Driver::Cylinder,
        Driver::Slide,
        Driver::Floating,
    ];
    (
        any::<u64>(),
        proptest::sample::select(drivers.to_vec()),
        proptest::collection::vec(proptest::sample::select(GROUPS.to_vec()), 1..=6),
        prop_oneof![Just(0.0), -6.0..6.0_f64],
        proptest::bool::weighted(hints),
    )
        .prop_map(|(seed, driver, groups, decade, hints)| Recipe {
            seed,
            driver,
            groups: with_curve(seed, groups),
            decade,
            hints,
        })
}

/// How property tests run: always the same cases (others with `KEMPE_SEED`), failures kept beside the test.
pub fn config(cases: u32) -> proptest::test_runner::Config {
    let seed = std::env::var("KEMPE_SEED").ok();
    proptest::test_runner::Config {
        cases,
        rng_seed: proptest::test_runner::RngSeed::Fixed(
            seed.and_then(|s| s.parse().ok()).unwrap_or(7),
        ),
        failure_persistence: Some(Box::new(
            proptest::test_runner::FileFailurePersistence::WithSource("regressions"),
        )),
        ..Default::default()
    }
}

/// A recipe from a seed alone.
pub fn recipe(seed: u64) -> Recipe {
    let mut rng = Rng(seed ^ 0x5eed);
    let drivers = [
        Driver::Turn,
        Driver::Turn,
        Driver::Turn,
        Driver::Cylinder,
        Driver::Slide,
        Driver::Floating,
    ];
    let driver = drivers[rng.below(drivers.len())];
    let count = 1 + rng.below(6);
    Recipe {
        seed,
        driver,
        groups: {
            let groups = (0..count).map(|_| GROUPS[rng.below(GROUPS.len())]);
            with_curve(seed, groups.collect())
        },
        decade: if rng.chance(0.5) {
            0.0
        } else {
            rng.range(-6.0, 6.0)
        },
        hints: rng.chance(0.8),
    }
}

fn sign(rng: &mut Rng) -> f64 {
    if rng.chance(0.5) { 1.0 } else { -1.0 }
}
