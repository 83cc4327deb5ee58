//! A pose for a mechanism that its drives do not determine: what they leave free is held somewhere.

use std::sync::Arc;

use kempe_mechanism::Design;
use kempe_mechanism::Mechanism;
use kempe_model::{Drive, DriveKind, HintKind, Law, LawPiece, LinkId, Model};
use kempe_units::{Dimension, Expr};

use crate::assemble::{Assembly, find_assemblies};
use crate::drive_path::DrivePath;
use crate::progress::Progress;

/// Places at which held drives are tried, one after the other.
const TRIALS: usize = 24;
/// The first angle tried, rad, and the step to the next: special poses tend to lie at special angles.
const ANGLES: (f64, f64) = (0.61, 2.4);
/// The first length tried, in mechanism sizes, and the step to the next.
const LENGTHS: (f64, f64) = (0.37, 0.11);

/// A model in which drives of their own hold what nothing determines, and how it then goes together.
#[derive(Clone, Debug)]
pub struct Held {
    /// The model with these drives behind its own.
    pub model: Model,
    /// Its pose; bodies are those of the model without them.
    pub assembly: Assembly,
}

/// Finds a pose of a mechanism with too few drives: those that it lacks are held near the file's hints, or anywhere.
/// `None` where no angle of a link and no travel of a slider determines the rest, or nothing closes at the places tried.
pub fn hold(
    mechanism: &Mechanism,
    parameters: &[f64],
    progress: &mut dyn Progress,
) -> Option<Held> {
    let own = mechanism.model.drives.len();
    let mut model = mechanism.model.clone();
    let mut state = Determined::of(&model);
    while state.free > 0 {
        let (drive, next) = candidates(&model).into_iter().find_map(|drive| {
            let mut more = model.clone();
            more.drives.push(drive.clone());
            let next = Determined::of(&more);
            // A drive that says what is said already would be one too many.
            (next.surplus == state.surplus && next.free < state.free).then_some((drive, next))
        })?;
        model.drives.push(drive);
        state = next;
    }
    let mut best: Option<Held> = None;
    let asks_near = model
        .assembly
        .iter()
        .any(|h| !matches!(h.kind, HintKind::Side { .. }));
    for trial in 0..TRIALS {
        let size = state.size(parameters);
        for (k, drive) in model.drives.iter_mut().enumerate().skip(own) {
            let step = (trial + 3 * (k - own)) as f64;
            let value = match drive.dimension {
                Dimension::ANGLE => ANGLES.0 + ANGLES.1 * step,
                _ => size * (LENGTHS.0 + LENGTHS.1 * step),
            };
            let wanted = hinted(&mechanism.model, drive, parameters).filter(|_| trial == 0);
            drive.law.from = Expr::Const(wanted.unwrap_or(value));
        }
        let mechanism = Mechanism::new(&model);
        let design = Design::new(&mechanism, parameters);
        let path = DrivePath::new(&model, parameters, size);
        let mut coordinates = vec![0.0; model.drives.len()];
        path.coordinates(path.start(&model, parameters), &mut coordinates);
        let found = find_assemblies(&design, &coordinates, progress)?;
        let Some(assembly) = found.list.into_iter().next() else {
            continue;
        };
        if best
            .as_ref()
            .is_none_or(|b| assembly.distance < b.assembly.distance)
        {
            let model = model.clone();
            best = Some(Held { model, assembly });
        }
        if !asks_near {
            break;
        }
    }
    best
}

/// The angle that a file's hint tells of a held link, rad.
fn hinted(model: &Model, drive: &Drive, parameters: &[f64]) -> Option<f64> {
    let DriveKind::Turn { link, .. } = drive.kind else {
        return None;
    };
    model.assembly.iter().find_map(|hint| match &hint.kind {
        HintKind::NearAngle { link: of, angle } if *of == link => {
            Some(kempe_model::value(angle, parameters))
        }
        _ => None,
    })
}

/// Drives that may hold something: every link against the frame, every slider and slot on its line.
fn candidates(model: &Model) -> Vec<Drive> {
    let drive = |name: &str, kind, dimension| Drive {
        name: name.to_owned(),
        kind,
        law: Law {
            from: Expr::Const(0.0),
            pieces: vec![LawPiece::Dwell {
                duration: Expr::Const(0.0),
            }],
        },
        dimension,
        span: 0..0,
    };
    let frame = model
        .links
        .iter()
        .position(|l| l.name == "frame")
        .unwrap_or(0);
    let frame = LinkId(frame as u32);
    let turns = (0..model.links.len() as u32)
        .map(LinkId)
        .filter(|l| *l != frame);
    let turns = turns.map(|link| {
        let kind = DriveKind::Turn {
            link,
            relative_to: frame,
        };
        drive(&model.links[link.index()].name, kind, Dimension::ANGLE)
    });
    let slides = model.joints.iter().enumerate();
    let slides = slides
        .filter(|(_, j)| j.kind.guide().is_some())
        .map(|(index, joint)| {
            let kind = DriveKind::Slide {
                joint: kempe_model::JointId(index as u32),
            };
            drive(&joint.name, kind, Dimension::LENGTH)
        });
    turns.chain(slides).collect()
}

/// How much the drives of a model determine.
struct Determined {
    mechanism: Arc<Mechanism>,
    /// Unknowns that nothing determines.
    free: usize,
    /// Constraints that say what others say.
    surplus: usize,
}

impl Determined {
    fn of(model: &Model) -> Self {
        let mechanism = Mechanism::new(model);
        let parts = &mechanism.plan.decomposition;
        let inside: usize = parts.blocks.iter().map(|b| b.surplus.len()).sum();
        Self {
            free: parts.undetermined.len(),
            surplus: inside + parts.surplus.len(),
            mechanism,
        }
    }

    fn size(&self, parameters: &[f64]) -> f64 {
        kempe_mechanism::geometry::Geometry::new(&self.mechanism, parameters).size(&self.mechanism)
    }
}
