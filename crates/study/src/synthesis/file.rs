//! Linkages as model files, in the names that every mechanism of their kind has: frame A and D, crank A-B, coupler B-C, rocker D-C.

use kempe_model::build::{Entry, ModelBuilder, Value, link, pin_in_slot, slider, study, turns};
use kempe_model::{FileUnits, Model};
use kempe_number::math;
use kempe_synthesis::{C, FourBar, InvertedSliderCrank, Line, Linkage, SliderCrank};
use kempe_units::{Dimension, Unit};

use super::own_linkage::OwnLinkage;
use crate::unit::Units;

/// The study of a linkage's file.
pub(super) const STUDY: &str = "motion";
/// Its drive.
pub(super) const DRIVE: &str = "motor";

/// The file of a linkage, with the parameters of the request that its measures name.
pub(super) fn file_of(
    candidate: &OwnLinkage,
    request: &Model,
    parameters: &[(String, String)],
) -> ModelBuilder {
    let writer = Pen::of(request);
    let mut file = units(ModelBuilder::new(&request.title), &request.units);
    for (name, value) in parameters.iter().chain(&candidate.parameters) {
        file = file.parameter(name, value.as_str());
    }
    let mut file = match &candidate.linkage {
        Linkage::FourBar(bar) => writer.four_bar(file, candidate, bar),
        Linkage::SliderCrank(it) => writer.slider_crank(file, candidate, it),
        Linkage::InvertedSliderCrank(it) => writer.inverted(file, candidate, it),
        Linkage::TwoSliders(..) => file,
    };
    // Which way a lever points decides between both assemblies, too.
    let lever = match candidate.linkage {
        Linkage::InvertedSliderCrank(_) => Some(("lever", candidate.start.angle)),
        _ => None,
    };
    if let Some((name, angle)) = candidate.turned.or(lever) {
        let near = Entry::new().with("near", writer.exact(angle, Dimension::ANGLE));
        file = file.entry("assembly", name, near);
    }
    let [from, to] = candidate
        .drive
        .map(|angle| writer.exact(angle, Dimension::ANGLE));
    let speed = "1 rad/s";
    file = file.drive(DRIVE, turns("crank").from(from).to(to).speed(speed));
    for (name, measure) in &candidate.measures {
        file = file.measure(name, measure);
    }
    let mut asked = study("motion").with("rows", 181);
    if candidate.point.is_some() {
        asked = asked.with("plot", ["path(P)"]);
    }
    file.study(STUDY, asked)
}

fn units(file: ModelBuilder, own: &FileUnits) -> ModelBuilder {
    let mut file = file.units(&own.length.name, &own.angle.name);
    for unit in &own.more {
        let of = Unit::parse(&unit.name).map(|u| u.dimension());
        let name = match of {
            Ok(Dimension::FORCE) => "force",
            Ok(Dimension::TORQUE) => "torque",
            Ok(Dimension::PRESSURE) => "pressure",
            Ok(Dimension::POWER) => "power",
            Ok(Dimension::MASS) => "mass",
            _ => continue,
        };
        file = file.unit(name, &unit.name);
    }
    file
}

/// Writes numbers in the file's units.
pub(super) struct Pen {
    units: Units,
}

impl Pen {
    pub fn of(request: &Model) -> Self {
        Self {
            units: Units::of(request),
        }
    }

    /// A value with all its digits and its unit.
    pub fn exact(&self, si: f64, dimension: Dimension) -> String {
        let unit = self.units.unit(dimension);
        format!("{} {}", crate::unit::shown(si, &unit), unit.text())
    }

    /// A coordinate in bare numbers.
    fn coordinate(&self, si: f64) -> f64 {
        crate::unit::shown(si, &self.units.unit(Dimension::LENGTH)) + 0.0
    }

    /// A place in bare numbers.
    fn place(&self, at: C) -> [f64; 2] {
        [at.re, at.im].map(|x| self.coordinate(x))
    }

    /// The same as the file writes it.
    pub fn place_text(&self, at: C) -> String {
        let [x, y] = self.place(at);
        format!("[{x}, {y}]")
    }

    fn lengths(&self, mut file: ModelBuilder, candidate: &OwnLinkage) -> ModelBuilder {
        for (name, length) in candidate.lengths() {
            file = file.parameter(name, self.exact(length, Dimension::LENGTH));
        }
        file
    }

    /// Two coordinates that grow with a parameter: where they are where it is nothing, and how far they go for each unit of it.
    fn following(&self, at: C, [x, y]: [f64; 2], name: &str) -> Vec<Value> {
        let coordinate = |at: f64, slope: f64| -> Value {
            let part = match slope.abs() == 1.0 {
                true => name.to_owned(),
                false => format!("{} * {name}", slope.abs()),
            };
            let sign = if slope < 0.0 { "-" } else { "+" };
            match (at + 0.0, slope) {
                (at, 0.0) => self.coordinate(at).into(),
                (0.0, slope) if slope > 0.0 => part.into(),
                (0.0, _) => format!("-{part}").into(),
                _ => format!("{} {sign} {part}", self.exact(at, Dimension::LENGTH)).into(),
            }
        };
        vec![coordinate(at.re, x), coordinate(at.im, y)]
    }

    /// The end of a length that begins at a place and goes towards another one: a parameter, so that what is at the end follows it.
    fn end_of(&self, from: C, to: C, name: &str) -> Vec<Value> {
        let way = to - from;
        let length = math::hypot(way.re, way.im);
        self.following(from, [way.re / length, way.im / length], name)
    }

    /// The frame's pivots.
    fn frame(&self, [a, d]: [C; 2]) -> Entry {
        link()
            .point("A", self.place(a))
            .point("D", self.end_of(a, d, "ground"))
    }

    /// The coupler with its moving pivots, and the point that is looked at.
    fn coupler(&self, candidate: &OwnLinkage, [b, c]: [C; 2]) -> Entry {
        let mut coupler = link();
        if !candidate.keeps_axes && candidate.point.is_none() {
            return coupler.distance("B", "C", "coupler_length");
        }
        coupler = coupler
            .point("B", self.place(b))
            .point("C", self.end_of(b, c, "coupler_length"));
        match candidate.point {
            Some(point) => coupler.point("P", self.place(point)),
            None => coupler,
        }
    }

    fn four_bar(&self, file: ModelBuilder, candidate: &OwnLinkage, bar: &FourBar) -> ModelBuilder {
        let file = self
            .lengths(file, candidate)
            .parameter(
                "link_ratio",
                "max(ground, crank_length, coupler_length, rocker_length) / min(ground, crank_length, coupler_length, rocker_length)",
            )
            .parameter(
                "grashof",
                "ground + crank_length + coupler_length + rocker_length - 2 * (max(ground, crank_length, coupler_length, rocker_length) + min(ground, crank_length, coupler_length, rocker_length))",
            )
            // Where crank and frame are stretched out and where they are folded the other two links must still meet.
            .parameter(
                "full_turn",
                "min(coupler_length + rocker_length - ground - crank_length, abs(ground - crank_length) - abs(coupler_length - rocker_length))",
            )
            .link("frame", self.frame(bar.fixed))
            .link("crank", link().distance("A", "B", "crank_length"))
            .link("coupler", self.coupler(candidate, bar.moving))
            .link("rocker", link().distance("D", "C", "rocker_length"))
            .measure("transmission_angle", "transmission_angle(C)");
        match bar.branch(&candidate.start) {
            1 => file.left_of("C", ["B", "D"]),
            -1 => file.right_of("C", ["B", "D"]),
            _ => file.near("C", self.place(candidate.start.place(bar.moving[1]))),
        }
    }

    /// Two points of a guide that passes `offset` to the left of a pivot: so far along it from where it is nearest.
    fn guide(&self, guide: &Line, pivot: C, along: [f64; 2]) -> [Vec<Value>; 2] {
        let (way, left) = (guide.direction, [-guide.direction.im, guide.direction.re]);
        along.map(|along| self.following(pivot + way.scale(along), left, "offset"))
    }

    fn slider_crank(
        &self,
        file: ModelBuilder,
        candidate: &OwnLinkage,
        it: &SliderCrank,
    ) -> ModelBuilder {
        let [crank, coupler, _] = it.dimensions();
        let [e, f] = self.guide(&it.guide, it.fixed, [0.0, crank + coupler]);
        let pin = candidate.start.place(it.moving[1]);
        self.lengths(file, candidate)
            .parameter(
                "link_ratio",
                "max(crank_length, coupler_length) / min(crank_length, coupler_length)",
            )
            .parameter("full_turn", "coupler_length - crank_length - abs(offset)")
            .link(
                "frame",
                link()
                    .point("A", self.place(it.fixed))
                    .point("E", e)
                    .point("F", f),
            )
            .link("crank", link().distance("A", "B", "crank_length"))
            .link("coupler", self.coupler(candidate, it.moving))
            .link("slider", link().point("C", [0.0, 0.0]))
            .joint("guide", slider("slider", "C", ["E", "F"]))
            .near("C", self.place(pin))
            .measure(
                "transmission_angle",
                "acos(abs(distance(B, E -> F)) / coupler_length)",
            )
    }

    fn inverted(
        &self,
        file: ModelBuilder,
        candidate: &OwnLinkage,
        it: &InvertedSliderCrank,
    ) -> ModelBuilder {
        let [a, d] = it.fixed;
        // In the axes of the link that carries it, from its pin on both sides.
        let reach = (d - a).norm() + it.crank;
        let [g, h] = self.guide(&it.guide, it.moving, [-reach, reach]);
        let mut lever = link()
            .point("B", self.place(it.moving))
            .point("G", g)
            .point("H", h);
        if let Some(point) = candidate.point {
            lever = lever.point("P", self.place(point));
        }
        self.lengths(file, candidate)
            .parameter(
                "link_ratio",
                "max(ground, crank_length) / min(ground, crank_length)",
            )
            .parameter("full_turn", "abs(ground - crank_length) - abs(offset)")
            .link("frame", self.frame(it.fixed))
            .link("crank", link().distance("A", "B", "crank_length"))
            .link("lever", lever)
            .joint("slot", pin_in_slot("D", ["G", "H"]))
            .measure("transmission_angle", "acos(abs(offset) / distance(B, D))")
    }
}
