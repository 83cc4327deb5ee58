//! Mechanisms that a study found in the report: side by side, and the first ones moving.

use kempe_draw::report::{Block, FrontDesign, FrontReport, MotionReport, Section};
use kempe_draw::scene::Scene;
use kempe_draw::{DrawOptions, Stage};
use kempe_draw::{Frame as PoseFrame, MechanismView};
use kempe_model::Model;

use crate::figures::{chosen, figures, front};
use crate::report_motion::{motion, shown};
use crate::result::{Figure, FoundDesign, StudyResult};
use crate::table::Column;
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

/// The front that a study found, to choose a design from.
pub(crate) fn front_report(result: &StudyResult) -> Option<FrontReport> {
    let pairs: Vec<(&Column, &Column, Option<[f64; 2]>)> = (result.figures.iter())
        .filter_map(|figure| match figure {
            Figure::Front { x, y, own } => Some((x, y, *own)),
            _ => None,
        })
        .collect();
    let (x, y, own) = *pairs.first()?;
    let columns = &result.table.columns;
    let named = std::iter::once(x).chain(pairs.iter().map(|(_, y, _)| *y));
    let place = |goal: &Column| columns.iter().position(|c| c.name == goal.name);
    let goals: Option<Vec<usize>> = named.map(place).collect();
    let own = own.map(|[first, _]| {
        let others = pairs
            .iter()
            .map(|(.., own)| own.map_or(f64::NAN, |own| own[1]));
        std::iter::once(first).chain(others).collect()
    });
    let count = result.table.rows();
    let design = |row: usize| {
        let found = result.designs.get(row);
        FrontDesign {
            name: found.map_or_else(|| (row + 1).to_string(), |it| it.name.clone()),
            file: found.map_or_else(String::new, |it| {
                format!("{}/{}.toml", result.name, it.name)
            }),
            note: result
                .table
                .notes
                .get(row)
                .cloned()
                .flatten()
                .unwrap_or_default(),
            moving: found.and_then(moving),
            motion: found.map_or_else(String::new, |it| format!("{}-{}", result.name, it.name)),
        }
    };
    Some(FrontReport {
        name: result.name.clone(),
        about: format!(
            "{count} designs. None is better than another in all goals: what one gains in the one it loses in another. A click on a point or a row shows it."
        ),
        columns: columns.iter().map(shown).collect(),
        goals: goals?,
        own,
        plot: front(x, y, pairs[0].2),
        designs: (0..count).map(design).collect(),
    })
}

/// A mechanism that was found with its poses.
fn moving(design: &FoundDesign) -> Option<(MechanismView, Vec<PoseFrame>)> {
    let motion = design.motion.as_ref()?;
    let study = design.model.studies.first();
    let view = mechanism_view(&design.model, study.map(|s| s.kind.along()));
    Some((view, drawing_frames(&design.model, motion)))
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

/// So many of a list at most, the first and the last among them.
fn evenly<T>(list: &[T], most: usize) -> Vec<&T> {
    let count = list.len().min(most);
    let last = list.len().saturating_sub(1);
    let place = |k: usize| k * last / count.saturating_sub(1).max(1);
    (0..count).filter_map(|k| list.get(place(k))).collect()
}

/// The first ones with their motions; of a front some evenly from end to end.
pub(crate) fn moving_designs(result: &StudyResult) -> Vec<MotionReport> {
    let is_front = |figure: &Figure| matches!(figure, Figure::Front { .. });
    let shown: Vec<&FoundDesign> = match result.figures.iter().any(is_front) {
        true => evenly(&result.designs, MOVING),
        false => result.designs.iter().collect(),
    };
    let moving = shown.into_iter().filter_map(|design| {
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

impl StudyResult {
    /// Pictures that move: one of all rows, one for each natural vibration, or those of the first designs; none of a table of designs.
    pub fn motions(&self) -> usize {
        match (self.shapes.len(), self.frames.is_empty()) {
            (0, false) => 1,
            (0, true) => moving_designs(self).len(),
            (shapes, _) => shapes,
        }
    }
}
