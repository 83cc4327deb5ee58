//! The coupler curve of the request's own four-bar, traced otherwise: by the other two four-bars of S. Roberts's theorem (1875), or by a body that goes
//! along it without turning.

use kempe_measure::Sample;
use kempe_model::{CognatesTask, Diagnostic, FRAME, LinkId, Model, PointId, Span};
use kempe_synthesis::{C, CouplerCurve, Linkage, PathLinkage, Pose};
use kempe_units::Dimension;

use super::beside::{Beside, Extended, text_value};
use super::candidate::Found;
use super::own_linkage::Wanted;
use super::passing::{Passing, point_wanted};
use super::path::cognates;
use super::point_way::{PointWay, lost};
use crate::unit::Units;

/// So many places of the curve a cognate is led through, and so often it is looked whether a body has turned.
const PLACES: usize = 24;
/// A point that lies to the side of a line by less, in parts of its distance, lies on it.
const IN_LINE: f64 = 1e-6;

pub(super) fn candidates(
    model: &Model,
    task: &CognatesTask,
    whole: &Span,
) -> Result<Found, Box<Diagnostic>> {
    let own = FourBar::of(model, task)?;
    let way = PointWay::of(model, (task.point, &task.span), (task.drive, whole))?;
    match task.parallel {
        true => own.parallel(way),
        false => own.others(way),
    }
}

/// A four-bar of the request whose coupler has the point.
struct FourBar<'a> {
    model: &'a Model,
    task: &'a CognatesTask,
    /// The links between coupler and frame, with their fixed and moving pivots.
    dyads: [Dyad; 2],
}

#[derive(Clone, Copy)]
struct Dyad {
    link: LinkId,
    fixed: PointId,
    moving: PointId,
}

/// The links that are pinned to the frame and to another.
fn dyads(model: &Model, coupler: LinkId) -> Vec<Dyad> {
    let of = |link: LinkId| {
        let ids = (0..model.points.len()).map(|k| PointId(k as u32));
        ids.filter(move |id| model.points[id.index()].links.contains(&link))
    };
    let mut found: Vec<Dyad> = Vec::new();
    for moving in of(coupler) {
        for link in &model.points[moving.index()].links {
            let fixed = of(*link).find(|id| model.points[id.index()].links.contains(&FRAME));
            let Some(fixed) = fixed.filter(|_| *link != coupler && *link != FRAME) else {
                continue;
            };
            if found.iter().all(|known| known.link != *link) {
                found.push(Dyad {
                    link: *link,
                    fixed,
                    moving,
                });
            }
        }
    }
    found
}

impl<'a> FourBar<'a> {
    fn of(model: &'a Model, task: &'a CognatesTask) -> Result<Self, Box<Diagnostic>> {
        let point = &model.points[task.point.index()];
        let refused = |message: String, help: &str| {
            let error = Diagnostic::error("bad-choice", message);
            Err(Box::new(error.at(task.span.clone(), "").help(help)))
        };
        let help =
            "name a point of a link that two others, each pinned to the frame, carry by pins";
        for coupler in &point.links {
            let [first, second, ..] = dyads(model, *coupler)[..] else {
                continue;
            };
            if [first.moving, second.moving].contains(&task.point) {
                let message = format!(
                    "`{}` goes on a circle, a pin of a crank as it is",
                    point.name
                );
                return refused(message, help);
            }
            return Ok(Self {
                model,
                task,
                dyads: [first, second],
            });
        }
        refused(
            format!("`{}` is no point of a four-bar's coupler", point.name),
            help,
        )
    }

    fn name(&self) -> &str {
        &self.model.points[self.task.point.index()].name
    }

    /// The four-bar in a pose of the mechanism.
    fn curve(&self, at: &Sample) -> CouplerCurve {
        let place = |id: PointId| {
            let [x, y] = at.points.get(id.index()).copied().unwrap_or([f64::NAN; 2]);
            C::new(x, y)
        };
        CouplerCurve {
            fixed: self.dyads.map(|dyad| place(dyad.fixed)),
            moving: self.dyads.map(|dyad| place(dyad.moving)),
            point: place(self.task.point),
        }
    }

    /// Coordinates of the drive along the way, evenly.
    fn places(way: &PointWay) -> impl Iterator<Item = f64> + use<> {
        let [low, high] = way.range;
        let last = if way.closed { PLACES - 1 } else { PLACES };
        (0..=last).map(move |k| low + (high - low) * (k as f64 / PLACES as f64))
    }

    /// The other four-bars, driven at either link.
    fn others(&self, mut way: PointWay) -> Result<Found, Box<Diagnostic>> {
        let along = Self::places(&way);
        let samples: Vec<Sample> = along.map(|at| way.whole(at)).collect();
        let curves: Vec<CouplerCurve> = samples.iter().map(|at| self.curve(at)).collect();
        if !curves.iter().all(|curve| curve.point.is_finite()) {
            return Err(lost(self.name(), &self.task.span));
        }
        let own = PathLinkage {
            linkage: Linkage::FourBar(curves[0].four_bar()),
            poses: (curves.iter())
                .map(|curve| {
                    let [first, here] = [&curves[0], curve].map(|c| c.moving[1] - c.moving[0]);
                    Pose {
                        origin: curve.point,
                        angle: (here * first.conj()).arg(),
                    }
                })
                .collect(),
        };
        let units = Units::of(self.model);
        let mut passing = Passing::new(&units, "places").round(way.closed);
        for other in cognates(&own) {
            let Linkage::FourBar(bar) = other.linkage else {
                continue;
            };
            for bar in [bar, bar.exchanged()] {
                let candidate = Passing::candidate(Linkage::FourBar(bar), other.poses[0]);
                passing.pass(candidate, &other.poses, &|_, _, pose, at| {
                    point_wanted(pose, at)
                });
            }
        }
        let how = format!(
            "two other four-bars trace the way of `{}`, each driven at either link",
            self.name()
        );
        Ok(passing.found(how, false, Vec::new()))
    }

    /// Bodies that go along the way without turning, one for each of the four-bar's links on the frame.
    fn parallel(&self, way: PointWay) -> Result<Found, Box<Diagnostic>> {
        let mut found = Found {
            searched: format!(
                "a link with a third pivot, and a rod from there to the body at `{}`",
                self.name()
            ),
            ..Found::default()
        };
        let places: Vec<f64> = Self::places(&way).collect();
        let start = way.start.clone();
        for shared in [1, 0] {
            let whole = self.curve(&start);
            let seen = match shared {
                1 => whole,
                _ => CouplerCurve {
                    fixed: [whole.fixed[1], whole.fixed[0]],
                    moving: [whole.moving[1], whole.moving[0]],
                    ..whole
                },
            };
            if let Some(added) = self.body(&start, &seen, self.dyads[shared].link, &places)? {
                found.candidates.push(added.into());
            }
        }
        Ok(found)
    }

    /// The file with a body that follows the point: the link, second of the four-bar as seen here, has a third pivot.
    fn body(
        &self,
        start: &Sample,
        seen: &CouplerCurve,
        link: LinkId,
        places: &[f64],
    ) -> Result<Option<Beside>, Box<Diagnostic>> {
        let (Some(added), Some([x, y, angle])) =
            (seen.parallel_motion(), start.links.get(link.index()))
        else {
            return Ok(None);
        };
        let [from, to] = added.coupler;
        let body = added.carried[1] - added.carried[0];
        if !(body.is_finite() && from.is_finite()) {
            return Ok(None);
        }
        let mut file = Extended::new(self.model)?;
        file.keep_drawn(start)?;
        let [third, end] = ["E", "F"].map(|name| file.name(name));
        let [rod, carried] = ["rod", "body"].map(|name| file.name(name));
        let mut lengths = Vec::new();
        let rod_length = file.length("rod_length", (to - from).norm(), &mut lengths)?;
        let body_length = file.length("body_length", body.norm(), &mut lengths)?;
        let local = (from - C::new(*x, *y)) * C::from_polar(1.0, -angle);
        file.point_on(link, &third, local)?;
        file.distance(&rod, [&third, &end], &rod_length)?;
        file.distance(&carried, [self.name(), &end], &body_length)?;
        let side = ((added.carried[0] - from).conj() * (to - from)).im;
        let size = (added.carried[0] - from).norm() * (to - from).norm();
        let hint = match side.abs() > IN_LINE * size {
            true => {
                let side = if side > 0.0 { "left" } else { "right" };
                text_value(&format!("{side} of {third} -> {}", self.name()))
            }
            false => format!("{{ near = {} }}", file.pen.place_text(to)),
        };
        file.add("assembly", &end, &hint)?;
        let transmission = file.name("transmission_angle");
        let text = format!("transmission_angle({end})");
        file.add("measures", &transmission, &text_value(&text))?;
        let pressure = file.name("pressure_angle");
        let text = format!("90 deg - {transmission}");
        file.add("measures", &pressure, &text_value(&text))?;
        let turn = file.name("turn");
        let text = format!("range(angle({carried}))");
        file.add("measures", &turn, &text_value(&text))?;
        let plots = [format!("path({})", self.name()), format!("path({end})")];
        let (file, study, names) = file.finished(&plots)?;
        let wanted = places.iter().map(|at| Wanted {
            measure: format!("angle({carried})"),
            at: *at,
            value: body.arg(),
            scale: None,
        });
        Ok(Some(Beside {
            file,
            study,
            drive: self.task.drive,
            lengths,
            told: Vec::<(String, f64, Dimension)>::new(),
            wanted: wanted.collect(),
            rank: format!("max({pressure})"),
            columns: vec![turn],
            names,
        }))
    }
}
