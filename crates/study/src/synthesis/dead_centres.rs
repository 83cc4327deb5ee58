//! Crank-rockers and slider-cranks by stroke and time ratio.

use std::f64::consts::TAU;

use kempe_model::{DeadCentresTask, Diagnostic, Model, Span, Stroke, value};
use kempe_synthesis::Pose;
use kempe_synthesis::{
    C, CrankRocker, FourBar, LONGEST_COUPLER, Linkage, SliderCrank, SliderCrankChoice,
    SynthesisError, best_crank_rocker, best_stroke_slider_crank, crank_rockers, imbalance,
    stroke_slider_crank,
};
use kempe_units::Dimension;

use super::candidate::{Candidate, Found};
use super::own_linkage::{OwnLinkage, Wanted};
use super::refused::{Data, Datum};
use crate::unit::Units;

pub(super) fn candidates(
    model: &Model,
    task: &DeadCentresTask,
    whole: Span,
) -> Result<Found, Box<Diagnostic>> {
    let parameters = model.parameter_values::<f64>();
    let number = |scalar| value::<f64>(scalar, &parameters);
    let ratio: f64 = number(&task.time_ratio);
    let slower = ratio.max(1.0 / ratio);
    let units = Units::of(model);
    let goes = match task.stroke {
        Stroke::Swing { .. } => ("the swing", Dimension::ANGLE),
        Stroke::Travel { .. } => ("the stroke", Dimension::LENGTH),
    };
    let names = [
        goes,
        ("the time ratio", Dimension::NONE),
        ("what is chosen besides", Dimension::LENGTH),
    ];
    let data = Data {
        data: (names.into_iter().zip(&task.spans))
            .map(|((name, dimension), span)| Datum {
                name: name.to_owned(),
                span: span.clone(),
                dimension,
            })
            .collect(),
        whole,
        remedy:
            "ask for a smaller time ratio, another stroke, or leave the coupler to the synthesis"
                .to_owned(),
        units: &units,
    };
    let off = imbalance(slower);
    let linkages: Result<Vec<(Linkage, f64)>, SynthesisError> = match &task.stroke {
        Stroke::Swing {
            swing,
            rocker,
            coupler,
        } => {
            let (swing, rocker): (f64, f64) = (number(swing), number(rocker));
            let found = match coupler {
                Some(coupler) => crank_rockers(swing, off, number(coupler) / rocker),
                None => best_crank_rocker(swing, off).map(|best| vec![best]),
            };
            found.map(|all| {
                let all = all.iter();
                all.map(|it| (Linkage::FourBar(scaled(it, rocker)), swing))
                    .collect()
            })
        }
        Stroke::Travel {
            travel,
            coupler,
            offset,
        } => {
            let stroke: f64 = number(travel);
            let found = match (coupler, offset) {
                (Some(coupler), _) => {
                    stroke_slider_crank(stroke, off, SliderCrankChoice::Coupler(number(coupler)))
                }
                (_, Some(offset)) => {
                    stroke_slider_crank(stroke, off, SliderCrankChoice::Offset(number(offset)))
                }
                _ => best_stroke_slider_crank(stroke, off),
            };
            found.map(|it| vec![(Linkage::SliderCrank(it.slider_crank()), stroke)])
        }
    };
    let linkages = linkages.map_err(|error| data.refused(&error))?;
    let warnings = at_bound(task, &linkages);
    let candidates = linkages.into_iter().filter_map(|(linkage, stroke)| {
        let (start, output) = match &linkage {
            Linkage::FourBar(bar) => (bar.pose(0.0, 1)?, "angle(rocker)"),
            Linkage::SliderCrank(it) => (stretched(it)?, "x(C)"),
            _ => return None,
        };
        let measures = vec![
            ("stroke".to_owned(), format!("range({output})")),
            ("time_ratio".to_owned(), format!("time_ratio({output})")),
        ];
        let all = [
            ("stroke", stroke, None),
            ("time_ratio", slower, Some(slower)),
        ];
        let wanted = all.map(|(measure, value, scale)| Wanted {
            measure: measure.to_owned(),
            at: 0.0,
            value,
            scale,
        });
        Some(OwnLinkage {
            linkage,
            start,
            turned: None,
            drive: [0.0, TAU],
            point: None,
            keeps_axes: false,
            parameters: Vec::new(),
            measures,
            told: Vec::new(),
            wanted: wanted.into(),
        })
    });
    Ok(Found {
        candidates: candidates.map(Candidate::from).collect(),
        searched: "one for each sense in which the crank may go round".to_owned(),
        warnings,
        ..Found::default()
    })
}

/// A coupler of this part of the longest that is looked at is that one, but for rounding.
const LONGEST_PART: f64 = 0.999;

/// That the best coupler is the longest that is looked at, where none is asked for.
fn at_bound(task: &DeadCentresTask, found: &[(Linkage, f64)]) -> Vec<Diagnostic> {
    let (is_free, length) = match &task.stroke {
        Stroke::Swing { coupler, .. } => (coupler.is_none(), "the rocker"),
        Stroke::Travel {
            coupler, offset, ..
        } => (coupler.is_none() && offset.is_none(), "the stroke"),
    };
    let parts = found.iter().map(|(linkage, stroke)| match linkage {
        Linkage::FourBar(bar) => {
            let [.., coupler, rocker] = bar.all_lengths();
            coupler / rocker
        }
        Linkage::SliderCrank(it) => it.dimensions()[1] / stroke,
        _ => 0.0,
    });
    let longest = parts.fold(0.0, f64::max);
    if !(is_free && longest > LONGEST_PART * LONGEST_COUPLER) {
        return Vec::new();
    }
    let message = format!(
        "the best coupler is the longest that is looked at, {LONGEST_COUPLER} times {length}"
    );
    let warning = Diagnostic::warning("at-bound", message);
    vec![
        warning
            .at(task.spans[0].clone(), "")
            .note("with this time ratio a longer one transmits better still, by ever less")
            .help("say how long it may be: `coupler`"),
    ]
}

fn scaled(it: &CrankRocker, rocker: f64) -> FourBar {
    let own = it.four_bar();
    FourBar {
        fixed: own.fixed.map(|p| p.scale(rocker)),
        moving: own.moving.map(|p| p.scale(rocker)),
        lengths: own.lengths.map(|l| l * rocker),
    }
}

/// The coupler where the crank lies along the guide, the slider ahead.
fn stretched(it: &SliderCrank) -> Option<Pose> {
    let [crank, coupler, _] = it.dimensions();
    let end = it.fixed + it.guide.direction.scale(crank);
    let height = it.guide.distance(end);
    let square = coupler * coupler - height * height;
    let along = C::new(square.max(0.0).sqrt(), -height);
    let own = it.moving[1] - it.moving[0];
    let turn = it.guide.direction * along * own.conj();
    let angle = turn.arg();
    let turned = C::from_polar(1.0, angle);
    let origin = end - turned * it.moving[0];
    (square > 0.0).then(|| Pose::new(origin.re, origin.im, angle))
}
