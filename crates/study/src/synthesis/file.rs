//! Linkages as model files, in the names that every mechanism of their kind has: frame A and D, crank A-B, coupler B-C, rocker D-C.

use kempe_model::build::{Entry, ModelBuilder, link, pin_in_slot, slider, study, turns};
use kempe_model::{FileUnits, Model};
use kempe_synthesis::{C, FourBar, InvertedSliderCrank, Line, Linkage, SliderCrank};
use kempe_units::{Dimension, Unit};

use super::asked::Questions;
use super::candidate::OwnLinkage;
use crate::unit::Units;

/// The study of a linkage's file.
pub(super) const STUDY: &str = "motion";
/// Its drive.
pub(super) const DRIVE: &str = "motor";

/// The file of a linkage, with the parameters of the request that its measures name.
pub(super) fn file_of(candidate: &OwnLinkage, questions: &Questions<'_>) -> ModelBuilder {
    let request = questions.request;
    let writer = Pen::of(request);
    let mut file = units(ModelBuilder::new(&request.title), &request.units);
    for (name, value) in questions.parameters.iter().chain(&candidate.parameters) {
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

    /// A place in bare numbers.
    fn place(&self, at: C) -> [f64; 2] {
        let unit = self.units.unit(Dimension::LENGTH);
        [at.re, at.im].map(|x| crate::unit::shown(x, &unit) + 0.0)
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

    /// The coupler with its moving pivots, and the point that is looked at.
    fn coupler(&self, candidate: &OwnLinkage, [b, c]: [C; 2]) -> Entry {
        let mut coupler = link();
        if !candidate.keeps_axes && candidate.point.is_none() {
            return coupler.distance("B", "C", "coupler_length");
        }
        coupler = coupler.point("B", self.place(b)).point("C", self.place(c));
        match candidate.point {
            Some(point) => coupler.point("P", self.place(point)),
            None => coupler,
        }
    }

    fn four_bar(&self, file: ModelBuilder, candidate: &OwnLinkage, bar: &FourBar) -> ModelBuilder {
        let [a, d] = bar.fixed;
        let along = a == C::zero() && d.im == 0.0 && d.re > 0.0;
        let frame = match along {
            true => link().point("A", [0.0, 0.0]).point("D", ("ground", 0)),
            false => link().point("A", self.place(a)).point("D", self.place(d)),
        };
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
            .link("frame", frame)
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

    /// Two points of a guide, from where it is nearest to a place, so far on.
    fn guide(&self, guide: &Line, near: C, length: f64) -> [[f64; 2]; 2] {
        let along = (near - guide.point) * guide.direction.conj();
        let foot = guide.point + guide.direction.scale(along.re);
        [foot, foot + guide.direction.scale(length)].map(|p| self.place(p))
    }

    fn slider_crank(
        &self,
        file: ModelBuilder,
        candidate: &OwnLinkage,
        it: &SliderCrank,
    ) -> ModelBuilder {
        let [crank, coupler, _] = it.dimensions();
        let [e, f] = self.guide(&it.guide, it.fixed, crank + coupler);
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
        let ground = (d - a).norm();
        // In the axes of the link that carries it, from its pin on both sides.
        let reach = ground + it.crank;
        let back = Line {
            point: it.guide.point - it.guide.direction.scale(reach),
            ..it.guide
        };
        let near = it.moving - it.guide.direction.scale(reach);
        let [g, h] = self.guide(&back, near, 2.0 * reach);
        let mut lever = link()
            .point("B", self.place(it.moving))
            .point("G", g)
            .point("H", h);
        if let Some(point) = candidate.point {
            lever = lever.point("P", self.place(point));
        }
        let frame = match a == C::zero() && d.im == 0.0 && d.re > 0.0 {
            true => link().point("A", [0.0, 0.0]).point("D", ("ground", 0)),
            false => link().point("A", self.place(a)).point("D", self.place(d)),
        };
        self.lengths(file, candidate)
            .parameter(
                "link_ratio",
                "max(ground, crank_length) / min(ground, crank_length)",
            )
            .parameter("full_turn", "abs(ground - crank_length) - abs(offset)")
            .link("frame", frame)
            .link("crank", link().distance("A", "B", "crank_length"))
            .link("lever", lever)
            .joint("slot", pin_in_slot("D", ["G", "H"]))
            .measure("transmission_angle", "acos(abs(offset) / distance(B, D))")
    }
}
