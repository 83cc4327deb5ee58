//! What is told of a fit besides: where each place is met, by how much it is missed, and how it looks.

use kempe_model::{Chosen, Fit};
use kempe_number::math;
use kempe_units::{Dimension, Unit};

use super::fitted::{Fitted, Seen};
use super::met::square;
use crate::result::{Figure, PlaneCurve, Scalar, StudyResult};
use crate::rows::path_drive;
use crate::table::{Column, Table};
use crate::unit::{Units, shown};

/// Places of a drawn path for each stroke.
const DRAWN: usize = 360;
/// Half a cross, in parts of the picture, and how many times as long the arm is that points along an angle.
const CROSS: f64 = 0.012;
const LONGER: f64 = 4.0;

/// Adds to the result of a study what its best design meets.
pub(in super::super) fn tell(
    fitted: &Fitted<'_, '_>,
    fit: &Fit,
    vary: &[Chosen],
    result: &mut StudyResult,
) {
    let units = Units::of(fitted.bench.model);
    let mut rows = result.table.notes.iter();
    let own = rows.position(|note| note.as_deref() == Some("the file's own"));
    let row = |number: f64| {
        result
            .table
            .columns
            .first()?
            .values
            .iter()
            .position(|x| *x == number)
    };
    let Some(best) = row(1.0) else { return };
    let design = |row: usize| -> Vec<f64> {
        let columns = result.table.columns.iter().skip(1).take(vary.len());
        columns.map(|c| c.unit.to_si(c.values[row])).collect()
    };
    let Ok(mut seen) = fitted.seen(&design(best)) else {
        return;
    };
    let length = units.unit(Dimension::LENGTH);
    let misses: Vec<f64> = seen.met.misses.iter().map(|m| square(m).sqrt()).collect();
    let rms = (seen.met.square() / misses.len() as f64).sqrt();
    let largest = misses.iter().copied().fold(0.0, f64::max);
    for (k, (name, value)) in [("rms miss", rms), ("largest miss", largest)]
        .into_iter()
        .enumerate()
    {
        let scalar = Scalar {
            name: name.to_owned(),
            unit: length.clone(),
            value: shown(value, &length),
        };
        result
            .scalars
            .insert((1 + k).min(result.scalars.len()), scalar);
    }
    result.beside.push(table(fitted, fit, &mut seen, &units));
    let way = path(&mut seen);
    let mut curves = vec![
        given(fitted, fit, &way, &length),
        PlaneCurve::lines("found", false, [way], &length),
        rays(&seen, &length, fitted),
    ];
    if let Some(own) = own
        && let Ok(mut seen) = fitted.seen(&design(own))
    {
        let way = path(&mut seen);
        curves.push(PlaneCurve::lines("the file's own", true, [way], &length));
    }
    let name = match fit.link() {
        Some(link) => &fitted.bench.model.links[link.index()].name,
        None => &fitted.bench.model.points[fit.point().index()].name,
    };
    result.figures.push(Figure::Plane {
        name: format!("fit-{name}"),
        unit: length,
        curves,
    });
}

/// The given places, where they are met and by how much they are missed.
fn table(fitted: &Fitted<'_, '_>, fit: &Fit, seen: &mut Seen, units: &Units) -> Table {
    let (length, angle) = (units.unit(Dimension::LENGTH), units.unit(Dimension::ANGLE));
    let (met, places) = (&seen.met, &fitted.given.places);
    let column = |name: &str, unit: &Unit, values: Vec<f64>| {
        let mut column = Column::new(name, unit.clone());
        column.values = values.into_iter().map(|x| shown(x, unit)).collect();
        column
    };
    let one = Unit::one();
    let count = places.len();
    let model = fitted.bench.model;
    let motion = seen.way.motion(0).clone();
    let drive = match motion.path {
        kempe_motion::drive_path::DrivePath::Coordinate { .. } => {
            model.drives.get(path_drive(&motion))
        }
        kempe_motion::drive_path::DrivePath::Time { .. } => None,
    };
    let (along, unit) = match drive {
        Some(drive) => (drive.name.clone(), units.unit(drive.dimension)),
        None => ("time".to_owned(), units.unit(Dimension::TIME)),
    };
    let coordinates = met.at.iter().map(|u| seen.way.coordinate(*u)).collect();
    let mut columns = vec![column(
        "place",
        &one,
        (1..=count).map(|k| k as f64).collect(),
    )];
    let of = |k: usize| places.iter().map(|p| p[k]).collect::<Vec<f64>>();
    let passed = |k: usize| {
        (places.iter().zip(&met.misses))
            .map(|(p, m)| p[k] + m[k])
            .collect::<Vec<f64>>()
    };
    columns.push(column("x given", &length, of(0)));
    columns.push(column("y given", &length, of(1)));
    let turns = |arcs: Vec<f64>| {
        arcs.into_iter()
            .map(|arc| arc / fitted.asked.radius)
            .collect::<Vec<f64>>()
    };
    if fit.link().is_some() {
        columns.push(column("angle given", &angle, turns(of(2))));
    }
    columns.push(column(&along, &unit, coordinates));
    columns.push(column("x", &length, passed(0)));
    columns.push(column("y", &length, passed(1)));
    if fit.link().is_some() {
        columns.push(column("angle", &angle, turns(passed(2))));
    }
    columns.push(column(
        "miss",
        &length,
        met.misses.iter().map(|m| square(m).sqrt()).collect(),
    ));
    Table {
        name: "places".to_owned(),
        columns,
        places: 1,
        closure: vec![f64::NAN; count],
        smallest_singular_value: vec![f64::NAN; count],
        forces: None,
        balance: None,
        notes: vec![None; count],
    }
}

/// The given places as crosses; of a link the longer arm points along its angle.
fn given(fitted: &Fitted, fit: &Fit, way: &[[f64; 2]], unit: &Unit) -> PlaneCurve {
    let places = &fitted.given.places;
    let extent = |axis: usize| {
        let all = places.iter().map(|p| p[axis]);
        let all = all.chain(way.iter().map(|p| p[axis]));
        let ends = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
            [low.min(x), high.max(x)]
        });
        ends[1] - ends[0]
    };
    let size = CROSS * extent(0).max(extent(1));
    let lines = places.iter().flat_map(|p| {
        let (angle, longer) = match fit.link() {
            Some(_) => (p[2] / fitted.asked.radius, LONGER),
            None => (0.0, 1.0),
        };
        let (s, c) = (math::sin(angle), math::cos(angle));
        let at = |along: f64, beside: f64| {
            [
                p[0] + size * (along * c - beside * s),
                p[1] + size * (along * s + beside * c),
            ]
        };
        [
            [at(-1.0, 0.0), at(longer, 0.0)],
            [at(0.0, -1.0), at(0.0, 1.0)],
        ]
    });
    PlaneCurve::lines("given", false, lines, unit)
}

/// The path of a design.
fn path(seen: &mut Seen) -> Vec<[f64; 2]> {
    let count = DRAWN * seen.way.strokes();
    let step = seen.way.end() / count as f64;
    (0..=count)
        .map(|k| {
            let at = seen.way.here(step * k as f64).at;
            [at[0], at[1]]
        })
        .collect()
}

/// From each given place to where it is met.
fn rays(seen: &Seen, unit: &Unit, fitted: &Fitted<'_, '_>) -> PlaneCurve {
    let all = fitted.given.places.iter().zip(&seen.met.misses);
    let lines = all.map(|(p, m)| [[p[0], p[1]], [p[0] + m[0], p[1] + m[1]]]);
    PlaneCurve::lines("misses", false, lines, unit)
}
