//! The way of a point of the request's own mechanism, as one drive goes on.

use std::f64::consts::TAU;

use kempe_measure::Sample;
use kempe_model::{Diagnostic, DriveId, Model, PointId, Span};
use kempe_motion::EndReason;
use kempe_motion::drive_path::{DrivePath, WHOLE};
use kempe_motion::progress::Silent;
use kempe_synthesis::C;
use kempe_units::Dimension;

use crate::along::Along;
use crate::prepared::{design, motion};
use crate::quantity::Quantity;
use crate::rows::RowPlace;
use crate::unit::Units;

/// A point on its way.
pub(super) struct PointWay {
    along: Along,
    /// The drive's coordinate over the way.
    pub range: [f64; 2],
    /// Whether it is a cycle: a whole turn of the drive, after which the point is where it was.
    pub closed: bool,
    /// The mechanism where the motion starts.
    pub start: Sample,
}

impl PointWay {
    /// The way of a point over a drive's whole range; both stand in the study at their places.
    pub fn of(
        model: &Model,
        (point, at_point): (PointId, &Span),
        (drive, at_study): (DriveId, &Span),
    ) -> Result<Self, Box<Diagnostic>> {
        let moved = motion(&design(model), &mut Silent).map_err(first)?;
        let index = drive.index();
        let drive = &model.drives[index];
        match moved.path {
            DrivePath::Coordinate { drive, .. } if drive == index => {}
            _ => {
                let message = format!("`{}` is not the only drive that moves", drive.name);
                let error = Diagnostic::error("not-the-path", message).at(at_study.clone(), "");
                let help = "hold all drives but one: what is asked for goes with that one";
                return Err(Box::new(error.help(help)));
            }
        }
        if moved.ends.0 != EndReason::Covered || moved.ends.1 != EndReason::Covered {
            let reached = Units::of(model).range_text(moved.reached(), drive.dimension);
            let error = Diagnostic::error(
                "not-reached",
                format!(
                    "the mechanism does not get through the range of `{}`",
                    drive.name
                ),
            );
            let error = error
                .at(at_point.clone(), "its way is not whole")
                .note(format!("it moves for {reached}"));
            let help = "let the drive go as far as the mechanism does: `kempe run` of a motion study tells";
            return Err(Box::new(error.help(help)));
        }
        let name = &model.points[point.index()].name;
        let coordinate = |axis: &str| -> Result<Quantity, Vec<Diagnostic>> {
            let it = model.measure(&format!("{axis}({name})"))?;
            Ok(Quantity {
                name: it.name,
                measure: it.measure,
                dimension: it.dimension,
            })
        };
        let (x, y) = (
            coordinate("x").map_err(first)?,
            coordinate("y").map_err(first)?,
        );
        let mut along = Along::new(model, &moved, &[&x, &y], false).map_err(first)?;
        let (low, high) = moved.demanded;
        let is_turn = drive.dimension == Dimension::ANGLE && high - low >= TAU * (1.0 - WHOLE);
        let ends = [low, if is_turn { low + TAU } else { high }].map(|at| place(&mut along, at));
        let size = moved.size();
        let closed =
            is_turn && matches!(ends, [Some(a), Some(b)] if (a - b).norm() <= WHOLE * size);
        let start = along.row(RowPlace::Drive(moved.start)).sample;
        Ok(Self {
            along,
            range: [low, if closed { low + TAU } else { high }],
            closed,
            start,
        })
    }

    /// Where the point is, m, at a coordinate of the drive; `None` where it does not get.
    pub fn place(&mut self, at: f64) -> Option<C> {
        place(&mut self.along, at)
    }

    /// Where everything is.
    pub fn whole(&mut self, at: f64) -> Sample {
        self.along.row(RowPlace::Drive(at)).sample
    }
}

fn place(along: &mut Along, at: f64) -> Option<C> {
    match along.values(RowPlace::Drive(at)).as_slice() {
        [x, y] if x.is_finite() && y.is_finite() => Some(C::new(*x, *y)),
        _ => None,
    }
}

/// A point that is not everywhere.
pub(super) fn lost(name: &str, at: &Span) -> Box<Diagnostic> {
    let error = Diagnostic::error(
        "not-reached",
        format!("`{name}` is not everywhere on its way"),
    );
    Box::new(error.at(at.clone(), ""))
}

/// The first of several errors.
fn first(all: Vec<Diagnostic>) -> Box<Diagnostic> {
    let mut errors = all.into_iter();
    Box::new(
        errors
            .next()
            .unwrap_or_else(|| Diagnostic::error("not-reached", "it does not move")),
    )
}
