//! Links with given rates at one pose (S. S. Bloch).

use kempe_model::{Diagnostic, Model, RatesTask, Span, value};
use kempe_synthesis::{C, LinkRates, Linkage, Pose, SynthesisError, bloch};
use kempe_units::Dimension;

use super::candidate::{Found, around};
use super::own_linkage::{OwnLinkage, Wanted, scales_of_rates};
use super::refused::{Data, Datum};
use crate::unit::{Units, shown};

/// A crank that has less room to move in, rad, stands in its dead centre.
const NARROWEST: f64 = 1e-9;

pub(super) fn candidates(
    model: &Model,
    task: &RatesTask,
    whole: Span,
) -> Result<Found, Box<Diagnostic>> {
    let parameters = model.parameter_values::<f64>();
    let number = |scalar| value::<f64>(scalar, &parameters);
    let speeds = task.speeds.each_ref().map(number);
    let accelerations = task.accelerations.each_ref().map(number);
    let ground: f64 = number(&task.ground);
    let rates = [0, 1, 2].map(|k| LinkRates {
        velocity: speeds[k],
        acceleration: accelerations[k],
    });
    let units = Units::of(model);
    let links = ["the crank", "the coupler", "the rocker"]
        .iter()
        .zip(&task.spans);
    let data = Data {
        data: links
            .map(|(name, span)| Datum {
                name: (*name).to_owned(),
                span: span.clone(),
                dimension: Dimension::ANGULAR_SPEED,
            })
            .collect(),
        whole,
        remedy: "two links that turn alike, or all that turn by one law, leave more than size and direction open: change a speed or an acceleration".to_owned(),
        units: &units,
    };
    let refused = |error: &SynthesisError| data.refused(error);
    if speeds[0] == 0.0 && speeds[1..].iter().any(|speed| *speed != 0.0) {
        return Err(at_rest(task));
    }
    let found = bloch(rates).map_err(|e| refused(&e))?;
    let vectors = found.with_frame(C::new(-ground, 0.0));
    let vectors = vectors.ok_or_else(|| refused(&SynthesisError::None))?;
    let bar = vectors.four_bar();
    let pose = Pose::new(0.0, 0.0, 0.0);
    let angle = bar.first_angle(&pose);
    let drive = around(angle, bar.turning(angle));
    if !(drive[1] - drive[0] > NARROWEST) {
        return Err(at_rest(task));
    }
    // The pose where the drive starts: the same branch.
    let start = bar.pose(drive[0], bar.branch(&pose)).unwrap_or(pose);
    let text = |si: f64, dimension| {
        let unit = units.unit(dimension);
        format!("{} {}", shown(si, &unit), unit.text())
    };
    let parameters = vec![
        (
            "crank_speed".to_owned(),
            text(speeds[0], Dimension::ANGULAR_SPEED),
        ),
        (
            "crank_acceleration".to_owned(),
            text(accelerations[0], Dimension::ANGULAR_ACCELERATION),
        ),
    ];
    // With the crank at its speed and acceleration, wherever it stands.
    let of = |link: &str| {
        let speed = format!("d(angle({link}), motor) * crank_speed");
        let acceleration = format!(
            "d(angle({link}), motor) * crank_acceleration + d(angle({link}), motor, 2) * crank_speed^2"
        );
        [
            (format!("{link}_speed"), speed),
            (format!("{link}_acceleration"), acceleration),
        ]
    };
    let measures: Vec<(String, String)> =
        ["coupler", "rocker"].iter().flat_map(|l| of(l)).collect();
    let values = [speeds[1], accelerations[1], speeds[2], accelerations[2]];
    let scales = scales_of_rates(1.0, &speeds, &accelerations);
    let wanted = measures
        .iter()
        .zip(values)
        .zip(scales.into_iter().cycle())
        .map(|(((name, _), value), scale)| Wanted {
            measure: name.clone(),
            at: angle,
            value,
            scale: Some(scale),
        });
    let wanted = wanted.collect();
    let candidate = OwnLinkage {
        linkage: Linkage::FourBar(bar),
        start,
        turned: None,
        drive,
        point: None,
        keeps_axes: false,
        parameters,
        measures,
        told: Vec::new(),
        wanted,
    };
    Ok(Found {
        candidates: vec![candidate.into()],
        searched: "there is one, but for its size and direction".to_owned(),
        ..Found::default()
    })
}

/// A crank that is driven moves the others by its own speed; in its dead centre they would need to be without bound beside it.
fn at_rest(task: &RatesTask) -> Box<Diagnostic> {
    let error = Diagnostic::error(
        "data-contradictory",
        "the crank stands still, or all but, while the others turn: it is in its dead centre, where it cannot drive them",
    );
    Box::new(
        error
            .at(task.spans[0].clone(), "too little beside the others")
            .help("give the crank a speed, or exchange crank and rocker"),
    )
}
