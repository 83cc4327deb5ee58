//! What the values of a model must keep to when its parameters are set to others than the file's.
//!
//! The reader refuses a file whose values break these rules. A program that sets parameters without reading the file again
//! asks here.

use std::f64::consts::TAU;

use kempe_number::math;
use kempe_units::{Dimension, Unit, format_digits};

use crate::bound::{Bound, Keeps, STEEPEST, beyond, remedy};
use crate::diagnostic::Diagnostic;
use crate::geometry::value;
use crate::link::{Link, Place};
use crate::model::Model;

/// A corner of a triangle that misses its distance by this part of it or more does not close: rounding stays far below.
const OPEN: f64 = 1e-9;

impl Model {
    /// What is wrong with parameter values (SI, in the model's order); nothing where a file with them would be read.
    ///
    /// `not-finite`, `out-of-range`, `bad-size`, `pressure-angle`, `wound-spring`, `triangle-open` and `clearance-too-large`, each labelled where the value stands in the file.
    pub fn unsound(&self, parameters: &[f64]) -> Vec<Diagnostic> {
        let broken = self
            .bounds
            .iter()
            .filter_map(|b| b.broken(self, parameters));
        let open = (self.links.iter()).filter_map(|link| open_triangle(link, parameters));
        (broken.chain(open))
            .chain(self.clearances_too_large(parameters))
            .collect()
    }
}

impl Model {
    /// A value in the file's units, for people.
    pub fn shown(&self, x: f64, dimension: Dimension) -> String {
        let preferred: Vec<Unit> = [&self.units.length, &self.units.angle]
            .into_iter()
            .chain(&self.units.more)
            .filter_map(|unit| Unit::parse(&unit.name).ok())
            .collect();
        format_digits(x, &Unit::for_display(dimension, &preferred), 6)
    }
}

impl Bound {
    fn broken(&self, model: &Model, parameters: &[f64]) -> Option<Diagnostic> {
        let x = value(&self.value, parameters);
        let finding = |code, message| {
            Diagnostic::error(code, message)
                .at(self.span.clone(), "with the parameters as they are set")
        };
        if !x.is_finite() {
            let found = if x.is_nan() {
                "not a number"
            } else {
                "infinite"
            };
            return Some(
                finding("not-finite", format!("{} is {found}", self.what)).help(
                    "look for a division by zero, the root of a negative number or an overflow",
                ),
            );
        }
        let positive = matches!(self.keeps, Keeps::Positive) && x > 0.0;
        if let Some(how) = beyond(x, self.dimension).filter(|_| positive || x.abs() > 1.0) {
            let message = format!("{} is {how} to be computed with", self.what);
            return Some(finding("out-of-range", message).help(remedy(self.dimension)));
        }
        let wanted = match self.keeps {
            Keeps::Positive if x <= 0.0 => "must be positive",
            Keeps::NotNegative if x < 0.0 => "must not be negative",
            Keeps::NotZero if x == 0.0 => "must not be zero",
            Keeps::AtMostOne if x > 1.0 => "must not be above 1",
            Keeps::PressureAngle if x >= STEEPEST => "must be below 45 deg",
            Keeps::WithinATurn if x.abs() >= TAU => "must be less than a whole turn",
            _ => return None,
        };
        let code = match self.keeps {
            Keeps::PressureAngle => "pressure-angle",
            Keeps::WithinATurn => "wound-spring",
            _ => "bad-size",
        };
        let found = model.shown(x, self.dimension);
        Some(
            finding(code, format!("{} {wanted}, found {found}", self.what))
                .help("set the parameters that it is made of to values that leave it so"),
        )
    }
}

/// The first corner of a link that its two distances do not reach.
fn open_triangle(link: &Link, parameters: &[f64]) -> Option<Diagnostic> {
    let depends = |place: &Place| matches!(place, Place::Triangle { .. });
    if !link.points.iter().any(|p| depends(&p.place)) {
        return None;
    }
    let points: Vec<[f64; 2]> = link.evaluate(parameters);
    let open = link.points.iter().zip(&points).find(|(point, at)| {
        let Place::Triangle {
            from,
            to,
            from_distance,
            to_distance,
            ..
        } = &point.place
        else {
            return false;
        };
        [(from, from_distance), (to, to_distance)]
            .into_iter()
            .any(|(end, distance)| {
                let wanted = value(distance, parameters);
                let found = (points.get(*end))
                    .map_or(f64::NAN, |p| math::hypot(at[0] - p[0], at[1] - p[1]));
                !((found - wanted).abs() <= OPEN * found.max(wanted))
            })
    })?;
    Some(
        Diagnostic::error(
            "triangle-open",
            format!("link `{}`: a triangle cannot close", link.name),
        )
        .at(open.0.span.clone(), "with the parameters as they are set")
        .help("each side of a triangle is shorter than the other two together"),
    )
}
