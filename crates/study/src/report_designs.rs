//! Mechanisms that a study found in the report: side by side, and the first ones moving.

use kempe_draw::plot::PlotSpec;
use kempe_draw::report::{Block, MotionReport, Section};
use kempe_draw::scene::Scene;
use kempe_draw::{DrawOptions, Stage};
use kempe_model::Model;

use crate::figures::{chosen, figures};
use crate::report::motion;
use crate::result::{Figure, FoundDesign, StudyResult};
use crate::view::{drawing_frames, mechanism_view};

/// So many move in the page; the files of all move when they are run.
const MOVING: usize = 6;
/// So many are drawn side by side.
const DRAWN: usize = 60;
/// Poses drawn behind the first one.
const GHOSTS: usize = 4;
/// Width and height of a picture beside others, mm.
const SMALL: [f64; 2] = [70.0, 60.0];

/// A mechanism that was found, at its first pose with some of its others behind; none where it does not move.
pub fn design_picture(design: &FoundDesign) -> Option<Scene> {
    picture(design, DrawOptions::default())
}

fn picture(design: &FoundDesign, options: DrawOptions) -> Option<Scene> {
    let motion = design.motion.as_ref()?;
    let study = design.model.studies.first();
    let view = mechanism_view(&design.model, study.map(|s| s.kind.along()));
    let frames = drawing_frames(&design.model, motion);
    let last = frames.len().checked_sub(1)?;
    let ghosts = (1..=GHOSTS).map(|k| k * last / GHOSTS);
    let options = DrawOptions {
        ghosts: ghosts.collect(),
        ..options
    };
    Some(Stage::new(&view, &frames, options).scene(0))
}

/// All that were found side by side.
pub(crate) fn designs_section(result: &StudyResult) -> Option<Section> {
    let small = || DrawOptions {
        width: SMALL[0],
        max_height: SMALL[1],
        labels: false,
        title: false,
        caption: false,
        ..DrawOptions::default()
    };
    let designs = result.designs.iter().take(DRAWN);
    let pictures: Vec<(String, Scene)> = designs
        .filter_map(|design| Some((design.title.clone(), picture(design, small())?)))
        .collect();
    (!pictures.is_empty()).then(|| Section {
        title: format!("{}: side by side", result.name),
        blocks: vec![Block::Pictures(pictures)],
    })
}

/// Width and height of a picture of the plane, mm.
const PLANE: [f64; 2] = [170.0, 130.0];

/// What a study shows in the plane beside the mechanisms that it found.
pub(crate) fn planes_section(model: &Model, result: &StudyResult) -> Option<Section> {
    let in_the_plane =
        |figure: &Figure| matches!(figure, Figure::Plane { .. } | Figure::Graph { .. });
    if !result.frames.is_empty() || !result.figures.iter().any(in_the_plane) {
        return None;
    }
    let is_plane = |figure: &Figure| matches!(figure, Figure::Plane { .. });
    let title = match result.figures.iter().all(is_plane) {
        true => "in the plane",
        false => "plots",
    };
    let plots = figures(model, result).into_iter();
    let pictures = plots.map(|(_, plot)| Block::Picture(plot.draw(PLANE[0], PLANE[1]).scene));
    Some(Section {
        title: format!("{}: {title}", result.name),
        blocks: pictures.collect(),
    })
}

/// The plots of a study but for how often numbers have their values, which no place of the motion has.
pub(crate) fn along_the_motion(model: &Model, result: &StudyResult) -> Vec<(String, PlotSpec)> {
    let shown = chosen(model, result);
    let plots = figures(model, result).into_iter().zip(&shown);
    let along = plots.filter(|(_, figure)| !matches!(figure, Figure::Histogram { .. }));
    along.map(|(plot, _)| plot).collect()
}

/// How often numbers have their values.
pub(crate) fn histograms_section(model: &Model, result: &StudyResult) -> Option<Section> {
    let shown = chosen(model, result);
    let plots = figures(model, result).into_iter().zip(&shown);
    let own = plots.filter(|(_, figure)| matches!(figure, Figure::Histogram { .. }));
    let pictures: Vec<Block> = own
        .map(|((_, plot), _)| Block::Picture(plot.draw(HISTOGRAM[0], HISTOGRAM[1]).scene))
        .collect();
    (!pictures.is_empty()).then(|| Section {
        title: format!("{}: how often", result.name),
        blocks: pictures,
    })
}

/// Width and height of a histogram, mm.
const HISTOGRAM: [f64; 2] = [140.0, 80.0];

/// The first ones with their motions.
pub(crate) fn moving_designs(result: &StudyResult) -> Vec<MotionReport> {
    let moving = result.designs.iter().filter_map(|design| {
        let study = design.model.studies.first()?;
        let own = motion(
            &design.model,
            study.kind.along(),
            design.motion.as_ref()?,
            None,
        );
        Some(MotionReport {
            name: format!("{}-{}", result.name, design.name),
            ..own
        })
    });
    moving.take(MOVING).collect()
}
