//! Outputs that rest while the file's own mechanism moves on: stretches of a point's way that come near to a circle or a line, and what a rod or a
//! slot makes of them.
//!
//! `dwell/asked.rs` is what is asked, `dwell/output.rs` writes the links that are added, `dwell/picture.rs` shows the way with its stretches.

mod asked;
mod output;
mod picture;

use kempe_measure::Sample;
use kempe_model::{Diagnostic, DwellOutput, DwellTask, Model, Span, value};
use kempe_synthesis::{C, Rest, Stretch, Way, nearest_circle, nearest_line, stretches};
use kempe_units::Dimension;

use super::candidate::{Found, Rejected, dimensions_in_words};
use super::point_way::{PointWay, lost};
use crate::result::Listing;
use crate::unit::Units;
use asked::{Asked, Near, wrapped};
use output::{Output, Writing};

/// So many stretches are looked at, the best first.
const MOST_STRETCHES: usize = 12;
/// So many outputs of each.
const MOST_OUTPUTS: usize = 4;
/// A stretch that is further off than this part of its way's size is near to nothing.
const OFF: f64 = 0.02;
/// A point that stays this near to a circle all the way, in sizes of the way, moves nothing at the rod's end.
const STILL: f64 = 1e-9;
/// An output that moves by more than this part of its whole way during the rest does not rest.
const STIRS: f64 = 0.1;
/// Steps of the way in which outputs are measured.
const STEPS: usize = 1440;
/// Where nothing is said the pivot lies at most this part of the mechanism's size away from it.
const AROUND: f64 = 0.5;

pub(super) fn candidates(
    model: &Model,
    task: &DwellTask,
    whole: &Span,
) -> Result<Found, Box<Diagnostic>> {
    let point = &model.points[task.point.index()].name;
    let mut track = PointWay::of(model, (task.point, &task.spans[0]), (task.drive, whole))?;
    let PointWay { range, closed, .. } = track;
    let mut place = |at: f64| track.place(at);
    let mut way = Way {
        place: &mut place,
        range,
        closed,
    };
    let no_way = || lost(point, &task.spans[0]);
    let places = way.places(STEPS).ok_or_else(no_way)?;
    let parameters = model.parameter_values::<f64>();
    let dwell: f64 = value(&task.dwell, &parameters);
    if !(dwell < range[1] - range[0]) {
        let units = Units::of(model);
        let coordinate = model.drives[task.drive.index()].dimension;
        let [dwell, goes] = [dwell, range[1] - range[0]].map(|x| units.text(x, coordinate));
        let message = format!("a rest of {dwell} is all of the drive's range of {goes}, or more");
        let error = Diagnostic::error("data-out-of-range", message);
        return Err(Box::new(
            error
                .at(task.spans[1].clone(), "")
                .help("ask for a shorter rest, or let the drive go further"),
        ));
    }
    let nearest = |places: &[C]| -> Option<(f64, Near)> {
        match task.output {
            DwellOutput::Slot => {
                let line = nearest_line(places)?;
                let (point, direction) = (line.point, line.direction);
                Some((line.deviation, Near::Line { point, direction }))
            }
            _ => {
                let circle = nearest_circle(places)?;
                let (centre, radius) = (circle.centre, circle.radius);
                Some((circle.deviation, Near::Circle { centre, radius }))
            }
        }
    };
    let extent = places
        .iter()
        .fold(0.0_f64, |m, p| m.max((*p - places[0]).norm()));
    // A point that goes on one circle all the way is as good as fixed to a link that turns about its centre.
    if task.output != DwellOutput::Slot
        && nearest_circle(&places).is_some_and(|it| it.deviation <= STILL * extent)
    {
        let error = Diagnostic::error(
            "data-contradictory",
            format!(
                "`{point}` stays on one circle all the way: at its centre a rod's end would rest for ever"
            ),
        );
        return Err(Box::new(
            error
                .at(task.spans[0].clone(), "")
                .help("name a point of a coupler"),
        ));
    }
    let found = stretches(&mut way, dwell, MOST_STRETCHES, &nearest).ok_or_else(no_way)?;
    let start = track.start.clone();
    let asked = Asked {
        model,
        task,
        units: Units::of(model),
        dwell,
        range,
        closed,
        stroke: task.stroke.as_ref().map(|s| value(s, &parameters)),
        corners: corners(task, &parameters, &places, &start),
        way: places,
        start,
    };
    asked.found(&mut track, &found, extent)
}

/// The corners that are given, or those of a box around the mechanism at its start and the point's way.
fn corners(task: &DwellTask, parameters: &[f64], way: &[C], start: &Sample) -> [C; 2] {
    if let Some(corners) = &task.pivots_in {
        return corners
            .each_ref()
            .map(|[x, y]| C::new(value(x, parameters), value(y, parameters)));
    }
    let all = || {
        way.iter()
            .copied()
            .chain(start.points.iter().map(|[x, y]| C::new(*x, *y)))
    };
    let bound = |pick: fn(f64, f64) -> f64| {
        let both = |of: fn(&C) -> f64| all().map(|p| of(&p)).filter(|x| x.is_finite()).reduce(pick);
        C::new(both(|p| p.re).unwrap_or(0.0), both(|p| p.im).unwrap_or(0.0))
    };
    let (low, high) = (bound(f64::min), bound(f64::max));
    let margin = AROUND * (high - low).norm();
    let margin = C::new(margin, margin);
    [low - margin, high + margin]
}

impl Asked<'_> {
    fn found(
        &self,
        track: &mut PointWay,
        stretches: &[Stretch<Near>],
        extent: f64,
    ) -> Result<Found, Box<Diagnostic>> {
        let writing = Writing::new(self);
        let rests = stretches.iter().filter(|it| it.deviation <= OFF * extent);
        let mut found = Found {
            figure: Some(picture::picture(self, &rests.collect::<Vec<_>>())),
            ..Found::default()
        };
        let mut rows = Vec::new();
        for stretch in stretches {
            let middle = wrapped(stretch.from + 0.5 * self.dwell, self.range, self.closed);
            let middle = track.place(middle);
            let outputs = match middle {
                Some(middle) if stretch.deviation <= OFF * extent => {
                    self.outputs(&stretch.near, middle)
                }
                _ => Vec::new(),
            };
            let mut row = self.told(stretch, outputs.len());
            row.push(
                self.why_none(stretch, extent, outputs.is_empty())
                    .unwrap_or_default(),
            );
            rows.push(row);
            let Some(middle) = middle else { continue };
            for output in outputs.iter().take(MOST_OUTPUTS) {
                let ends = writing.furthest(track, stretch.from, middle, output);
                let [low, high] = ends.map(|(_, point)| output.moved(middle, point));
                match self.restless(output, high - low) {
                    Some(restless) => found.rejected.push(restless),
                    None => found
                        .candidates
                        .push(writing.beside(stretch, output, &ends)?.into()),
                }
            }
        }
        let [shape, more] = match self.task.output {
            DwellOutput::Slot => ["line", "direction"],
            _ => ["circle", "radius"],
        };
        let name = &self.model.points[self.task.point.index()].name;
        found.searched = format!(
            "{} stretches of the way of `{name}` come nearer to a {shape} than their neighbours",
            stretches.len()
        );
        found.tried = Some(Listing {
            title: format!("stretches of the way of {name} that are nearest to a {shape}"),
            head: ["from", "to", "off by", more, "outputs", "why none"]
                .map(str::to_owned)
                .to_vec(),
            rows,
        });
        Ok(found)
    }

    /// The outputs that rest on a stretch, the best first.
    fn outputs(&self, near: &Near, middle: C) -> Vec<Output> {
        let rest = Rest {
            way: &self.way,
            middle,
        };
        match (self.task.output, *near) {
            (DwellOutput::Lever, Near::Circle { centre, radius }) => {
                let all = rest.levers(centre, radius, self.corners, self.stroke);
                all.into_iter()
                    .map(|it| Output::Lever(it, radius))
                    .collect()
            }
            (DwellOutput::Slider, Near::Circle { centre, radius }) => {
                let all = rest.sliders(centre, radius, self.stroke);
                let all = all.into_iter();
                all.map(|it| Output::Slider(it, centre, radius)).collect()
            }
            (_, Near::Line { point, direction }) => {
                let swing = self.stroke.unwrap_or(0.0);
                let all = rest.slots(point, direction, self.corners, swing);
                all.into_iter().map(Output::Slot).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Why an output does not rest that stirs so far.
    fn restless(&self, output: &Output, stir: f64) -> Option<Rejected> {
        let (goes, dimension) = output.goes();
        let text = |x: f64| self.units.text(x, dimension);
        let goes_on = self.units.text(self.dwell, self.coordinate());
        (stir > STIRS * goes).then(|| Rejected {
            what: dimensions_in_words(&output.lengths(), &self.units),
            why: format!(
                "it does not rest: it moves by {} while the drive goes on by {goes_on}, of {} in all",
                text(stir),
                text(goes)
            ),
        })
    }

    /// A row of the list of stretches.
    fn told(&self, stretch: &Stretch<Near>, outputs: usize) -> Vec<String> {
        let of_drive = |at: f64| self.units.text(at, self.coordinate());
        let more = match stretch.near {
            Near::Circle { radius, .. } => self.units.text(radius, Dimension::LENGTH),
            Near::Line { direction, .. } => self.units.text(direction.arg(), Dimension::ANGLE),
        };
        vec![
            of_drive(stretch.from),
            of_drive(stretch.from + self.dwell),
            self.units.text(stretch.deviation, Dimension::LENGTH),
            more,
            outputs.min(MOST_OUTPUTS).to_string(),
        ]
    }

    /// Why a stretch leads to nothing.
    fn why_none(&self, stretch: &Stretch<Near>, extent: f64, none: bool) -> Option<String> {
        let off = self.units.text(stretch.deviation, Dimension::LENGTH);
        if !(stretch.deviation <= OFF * extent) {
            return Some(format!("the point is off by {off}, which is no rest"));
        }
        if !none {
            return None;
        }
        let so_far = match (&self.stroke, self.task.output) {
            (None, _) => String::new(),
            (Some(stroke), DwellOutput::Slider) => {
                format!(" that goes {}", self.units.text(*stroke, Dimension::LENGTH))
            }
            (Some(swing), _) => {
                format!(" that swings {}", self.units.text(*swing, Dimension::ANGLE))
            }
        };
        Some(match self.task.output {
            DwellOutput::Lever => format!(
                "no lever{so_far} has its pivot within `pivots_in` and is never in line with the rod, of {}",
                match stretch.near {
                    Near::Circle { radius, .. } => self.units.text(radius, Dimension::LENGTH),
                    Near::Line { .. } => off,
                }
            ),
            DwellOutput::Slider => {
                format!("no slider{so_far} lets the rod reach the point all the way")
            }
            DwellOutput::Slot => {
                format!(
                    "no lever{so_far} has its pivot on the line and within `pivots_in`, away from the way"
                )
            }
        })
    }
}
