//! The sizes of a mechanism as a drawing shows them: of links, fixed points, guides, wheels and slots.

use kempe_draw::{ArcGuide, JointView, Wheel};
use kempe_draw::{DimensionKind, DimensionView, Guide, MechanismView};
use kempe_model::{FRAME, JointKind, Line, Link, Model, PointId, value};
use kempe_number::math::{atan2, hypot};
use kempe_number::text::significant;
use kempe_units::Dimension;

use crate::unit::{Units, shown};
use crate::view::shared;

/// Digits of a size.
const DIGITS: usize = 6;
/// Lengths below this part of the largest of the mechanism are none: rounding left them.
const NONE: f64 = 1e-9;
/// A size that follows a parameter does so to this part of itself.
const FOLLOWS: f64 = 1e-9;
/// A parameter is made larger by this part of itself to see what follows it.
const VARIED: f64 = 1e-3;

/// What is to be written into a picture with dimensions. Lengths are told in the file's units, by a parameter's name where
/// the length is that parameter and nothing else.
///
/// A link has the distances of its points that fix its shape. Fixed points lie across and up from the first fixed pivot.
/// Guides of the frame have their angle where they are neither level nor upright, and their distance from the first fixed
/// pivot. Points that only shape a slot or guide have none.
pub fn dimensions(model: &Model, view: &MechanismView) -> Vec<DimensionView> {
    let parameters: Vec<f64> = model.parameter_values();
    let places = |link: &Link| link.evaluate(&parameters);
    let places: Vec<[f64; 2]> = model.links.iter().flat_map(places).collect();
    let mut sizes = Sizes {
        model,
        view,
        size: places.iter().flatten().fold(0.0, |m, v| m.max(v.abs())),
        parameters,
        units: Units::of(model),
        found: Vec::new(),
    };
    for (index, link) in model.links.iter().enumerate() {
        match index == FRAME.index() {
            true => sizes.frame(link),
            false => sizes.link(index, link),
        }
    }
    for joint in &model.joints {
        if let Some((_, on)) = joint.kind.guide() {
            sizes.guide(on);
        }
    }
    for joint in &view.joints {
        match *joint {
            JointView::Gears { a, b, .. } | JointView::Belt { a, b, .. } => {
                sizes.wheel(a);
                sizes.wheel(b);
            }
            JointView::Rack { pinion, .. } => sizes.wheel(pinion),
            JointView::ArcSlot { arc, .. } => sizes.arc(arc),
            _ => {}
        }
    }
    sizes.found
}

struct Sizes<'a> {
    model: &'a Model,
    view: &'a MechanismView,
    parameters: Vec<f64>,
    units: Units,
    /// The largest coordinate of a point in its link, m.
    size: f64,
    found: Vec<DimensionView>,
}

impl Sizes<'_> {
    /// Adds a size that is computed from parameters, once.
    fn add(&mut self, kind: DimensionKind, size: impl Fn(&[f64]) -> f64) {
        self.add_with(kind, "", "", size);
    }

    fn add_with(
        &mut self,
        kind: DimensionKind,
        sign: &str,
        more: &str,
        size: impl Fn(&[f64]) -> f64,
    ) {
        let si = size(&self.parameters);
        if !si.is_finite() || self.found.iter().any(|d| d.kind == kind) {
            return;
        }
        let dimension = match kind {
            DimensionKind::Angle { .. } => Dimension::ANGLE,
            _ => Dimension::LENGTH,
        };
        let unit = self.units.unit(dimension);
        let number = significant(shown(si.abs(), &unit), DIGITS);
        let told = format!("{number} {}", unit.text());
        let text = match self.parameter(dimension, si, size) {
            Some(name) => format!("{name} = {told}{more}"),
            None => format!("{sign}{told}{more}"),
        };
        self.found.push(DimensionView {
            kind,
            value: si,
            text,
        });
    }

    /// The parameter that a size is: it has its value, and follows it.
    fn parameter(
        &self,
        dimension: Dimension,
        si: f64,
        size: impl Fn(&[f64]) -> f64,
    ) -> Option<&str> {
        let near = |a: f64, b: f64| (a - b).abs() <= FOLLOWS * b.abs();
        let is = |index: &usize| {
            let parameter = &self.model.parameters[*index];
            if parameter.dimension != dimension || !near(self.parameters[*index], si) {
                return false;
            }
            let mut varied = self.parameters.clone();
            varied[*index] *= 1.0 + VARIED;
            near(size(&varied), si * (1.0 + VARIED))
        };
        let found = (0..self.parameters.len()).find(is)?;
        Some(&self.model.parameters[found].name)
    }

    /// Whether a point is one of the mechanism, not only there for the shape of a guide or slot.
    fn shown(&self, point: PointId) -> bool {
        let only_shapes = self.model.joints.iter().any(|joint| match &joint.kind {
            JointKind::CurveSlot { on, .. } => on.through.contains(&point),
            kind => {
                let named = |(_, on): (_, Line)| on.from == point || on.to == point;
                kind.guide().is_some_and(named)
            }
        });
        let links = self.model.points[point.index()].links.len();
        links > 1 || !only_shapes || self.held(point)
    }

    /// Whether a cylinder, a spring or a damper holds to a point.
    fn held(&self, point: PointId) -> bool {
        self.view.joints.iter().any(|joint| match joint {
            JointView::Cylinder { a, b }
            | JointView::Spring { a, b }
            | JointView::Damper { a, b } => [*a, *b].contains(&point.index()),
            _ => false,
        })
    }

    /// The points of a link that are measured, by their number in it.
    fn measured(&self, link: &Link) -> Vec<usize> {
        let points = link.points.iter().enumerate();
        let shown = points.filter(|(_, p)| self.shown(p.point));
        shown.map(|(number, _)| number).collect()
    }

    /// The distances that fix the shape of a link: along its points where they lie on a line, otherwise from point to point
    /// and from the first to the others.
    fn link(&mut self, index: usize, link: &Link) {
        let mut points = self.measured(link);
        let places: Vec<[f64; 2]> = link.evaluate(&self.parameters);
        let apart = |a: usize, b: usize| {
            let (p, q) = (places[a], places[b]);
            hypot(q[0] - p[0], q[1] - p[1])
        };
        let Some(&first) = points.first() else { return };
        let far = points.iter().copied();
        let Some(last) = far.max_by(|a, b| apart(first, *a).total_cmp(&apart(first, *b))) else {
            return;
        };
        let long = apart(first, last);
        if !(long > NONE * self.size) {
            return;
        }
        let along = [0, 1].map(|k: usize| (places[last][k] - places[first][k]) / long);
        let on = |p: usize| {
            let [x, y] = [0, 1].map(|k: usize| places[p][k] - places[first][k]);
            [x * along[0] + y * along[1], y * along[0] - x * along[1]]
        };
        let straight = points.iter().all(|p| on(*p)[1].abs() < NONE * long);
        let mut pairs: Vec<(usize, usize)> = Vec::new();
        if straight {
            points.sort_by(|a, b| on(*a)[0].total_cmp(&on(*b)[0]));
        } else {
            pairs.extend(points.iter().skip(2).map(|p| (first, *p)));
        }
        pairs.extend(points.windows(2).map(|pair| (pair[0], pair[1])));
        pairs.retain(|(a, b)| apart(*a, *b) > NONE * self.size);
        for (a, b) in pairs {
            let at = |number: usize| link.points[number].point.index();
            let model = self.model;
            self.add(DimensionKind::Length { a: at(a), b: at(b) }, |parameters| {
                let places: Vec<[f64; 2]> = model.links[index].evaluate(parameters);
                hypot(places[b][0] - places[a][0], places[b][1] - places[a][1])
            });
        }
    }

    /// The point from which the frame is measured: its first pivot.
    fn datum(&self, frame: &Link) -> Option<usize> {
        let pivot = |p: &kempe_model::LinkPoint| self.model.points[p.point.index()].links.len() > 1;
        frame.points.iter().position(pivot)
    }

    /// Fixed points, across and up from the first; once where several are as far.
    fn frame(&mut self, frame: &Link) {
        let Some(datum) = self.datum(frame) else {
            return;
        };
        let places: Vec<[f64; 2]> = frame.evaluate(&self.parameters);
        let size = self.size;
        let mut seen: [Vec<f64>; 2] = [Vec::new(), Vec::new()];
        for number in self.measured(frame) {
            for k in 0..2 {
                let far = places[number][k] - places[datum][k];
                let again = seen[k].iter().any(|s| (s - far).abs() < NONE * size);
                if far.abs() < NONE * size || again {
                    continue;
                }
                seen[k].push(far);
                let [a, b] = [datum, number].map(|p| frame.points[p].point.index());
                let kind = match k {
                    0 => DimensionKind::Across { a, b },
                    _ => DimensionKind::Up { a, b },
                };
                let model = self.model;
                self.add(kind, |parameters| {
                    let places: Vec<[f64; 2]> = model.links[FRAME.index()].evaluate(parameters);
                    (places[number][k] - places[datum][k]).abs()
                });
            }
        }
    }

    /// The angle of a fixed guide and its distance from the first fixed pivot.
    fn guide(&mut self, on: Line) {
        if on.link != FRAME {
            return;
        }
        let model = self.model;
        let frame = &model.links[FRAME.index()];
        let number = |point| frame.points.iter().position(|p| p.point == point);
        let (Some(from), Some(to)) = (number(on.from), number(on.to)) else {
            return;
        };
        let guide = Guide {
            link: on.link.index(),
            from: on.from.index(),
            to: on.to.index(),
        };
        let way = |parameters: &[f64]| {
            let places: Vec<[f64; 2]> = frame.evaluate(parameters);
            let way = [0, 1].map(|k: usize| places[to][k] - places[from][k]);
            (places, way)
        };
        let (_, [x, y]) = way(&self.parameters);
        let long = hypot(x, y);
        if x.abs() > NONE * long && y.abs() > NONE * long {
            self.add(DimensionKind::Angle { guide }, |parameters| {
                let (_, [x, y]) = way(parameters);
                atan2(y * x.signum(), x.abs())
            });
        }
        let Some(datum) = self.datum(frame) else {
            return;
        };
        let off = |parameters: &[f64]| {
            let (places, [x, y]) = way(parameters);
            let [px, py] = [0, 1].map(|k: usize| places[datum][k] - places[from][k]);
            ((x * py - y * px) / hypot(x, y)).abs()
        };
        if off(&self.parameters) > NONE * self.size {
            let point = frame.points[datum].point.index();
            self.add(DimensionKind::Offset { point, guide }, off);
        }
    }

    fn wheel(&mut self, wheel: Wheel) {
        let teeth = match wheel.teeth {
            0 => String::new(),
            teeth => format!(", {teeth} teeth"),
        };
        let model = self.model;
        let radius = |parameters: &[f64]| radius(model, &wheel, parameters);
        self.add_with(DimensionKind::Wheel(wheel), "R ", &teeth, radius);
    }

    fn arc(&mut self, arc: ArcGuide) {
        let joints = &self.model.joints;
        let on = joints.iter().find_map(|joint| match &joint.kind {
            JointKind::ArcSlot { on, .. }
                if on.from.index() == arc.from && on.to.index() == arc.to =>
            {
                Some(&on.radius)
            }
            _ => None,
        });
        let Some(radius) = on else { return };
        self.add_with(DimensionKind::Arc(arc), "R ", "", |parameters| {
            value(radius, parameters)
        });
    }
}

/// The pitch radius of a wheel: of a belt or pinion as it is given, of a gear as it was drawn.
fn radius(model: &Model, wheel: &Wheel, parameters: &[f64]) -> f64 {
    let given = model.joints.iter().find_map(|joint| match &joint.kind {
        JointKind::Belt {
            a,
            b,
            arm,
            radius_a,
            radius_b,
            ..
        } => [(a, radius_a), (b, radius_b)]
            .into_iter()
            .find_map(|(link, radius)| {
                let center = shared(model, *link, *arm)?;
                (link.index() == wheel.link && center.index() == wheel.center).then_some(radius)
            }),
        JointKind::Rack {
            pinion,
            center,
            radius,
            ..
        } => (pinion.index() == wheel.link && center.index() == wheel.center).then_some(radius),
        _ => None,
    });
    given.map_or(wheel.radius, |radius| value(radius, parameters))
}
