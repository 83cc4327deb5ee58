//! Shared by the integration tests: model files with what acts on them added in code.
#![allow(dead_code, reason = "each test uses a part of it")]

#[path = "../../../model/tests/support/read.rs"]
mod read;

pub use read::read as model;

use kempe_dynamics::{ForceSample, ForceSampler};
use kempe_mechanism::{Design, Mechanism};
use kempe_model::{
    Amount, DriveId, ForceMeasure, JointId, JointRef, Leaf, LinkId, LinkPointRef, Load, LoadKind,
    Measure, Model, PointId, Scalar,
};
use kempe_motion::Motion;
use kempe_units::Expr;

/// An example's text.
pub fn example(name: &str) -> String {
    let path = format!(
        "{}/../../examples/seeds/{name}.toml",
        env!("CARGO_MANIFEST_DIR")
    );
    std::fs::read_to_string(path).expect("an example file")
}

pub fn link(model: &Model, name: &str) -> LinkId {
    let at = model.links.iter().position(|l| l.name == name);
    LinkId(at.unwrap_or_else(|| panic!("link {name}")) as u32)
}

pub fn point(model: &Model, name: &str) -> PointId {
    let at = model.points.iter().position(|p| p.name == name);
    PointId(at.unwrap_or_else(|| panic!("point {name}")) as u32)
}

pub fn joint(model: &Model, name: &str) -> JointId {
    let at = model.joints.iter().position(|p| p.name == name);
    JointId(at.unwrap_or_else(|| panic!("joint {name}")) as u32)
}

pub fn on(model: &Model, link_name: &str, point_name: &str) -> LinkPointRef {
    LinkPointRef {
        link: link(model, link_name),
        point: point(model, point_name),
    }
}

pub fn number(x: f64) -> Scalar {
    Expr::Const(x)
}

pub fn amount(x: f64) -> Amount {
    Amount::Measure(Expr::Const(x))
}

pub fn no_gravity(model: &mut Model) {
    model.actions.gravity = Some([number(0.0), number(0.0)]);
}

pub fn force(name: &str, at: LinkPointRef, components: [f64; 2]) -> Load {
    Load {
        name: name.into(),
        kind: LoadKind::Force {
            at,
            components: components.map(amount),
            axes: kempe_model::FRAME,
        },
        span: 0..0,
    }
}

pub fn ask(measure: ForceMeasure) -> Measure {
    Expr::Leaf(Leaf::Force(measure))
}

pub fn drive() -> Measure {
    ask(ForceMeasure::Drive(DriveId(0)))
}

/// The size of a pin's load.
pub fn pin(model: &Model, name: &str) -> Measure {
    ask(ForceMeasure::Reaction(JointRef::Pin(
        point(model, name),
        None,
    )))
}

/// A pin's load on a link, along x and y.
pub fn pin_on(model: &Model, name: &str, on: &str) -> [Measure; 2] {
    let joint = JointRef::Pin(point(model, name), Some(link(model, on)));
    [
        ask(ForceMeasure::ReactionX(joint)),
        ask(ForceMeasure::ReactionY(joint)),
    ]
}

/// Rows of measures along the drive.
pub fn rows(model: &Model, measures: &[Measure], at: &[f64]) -> Vec<ForceSample> {
    with_sampler(model, measures, |sampler| {
        at.iter().map(|p| sampler.at_parameter(*p)).collect()
    })
}

/// Values of measures along the drive; every row must be sound.
pub fn values(model: &Model, measures: &[Measure], at: &[f64]) -> Vec<Vec<f64>> {
    rows(model, measures, at)
        .into_iter()
        .map(|row| {
            let evidence = row.evidence.expect("forces");
            assert!(evidence.route_difference < 1e-11, "{evidence:?}");
            assert!(evidence.residual < 1e-12, "{evidence:?}");
            row.sample.values
        })
        .collect()
}

/// Hands a sampler of a model's motion to `use_it`.
pub fn with_sampler<R>(
    model: &Model,
    measures: &[Measure],
    use_it: impl FnOnce(&mut ForceSampler) -> R,
) -> R {
    let mechanism = Mechanism::new(model);
    let parameters: Vec<f64> = model.parameter_values();
    let design = Design::new(&mechanism, &parameters);
    let motion = Motion::new(&design).expect("a motion");
    let measures: Vec<&Measure> = measures.iter().collect();
    let mut sampler = ForceSampler::new(&motion, &measures).expect("forces");
    use_it(&mut sampler)
}

#[track_caller]
pub fn close(what: &str, found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{what}: found {found:.16e}, expected {expected:.16e}, off by {:e}",
        found - expected
    );
}
