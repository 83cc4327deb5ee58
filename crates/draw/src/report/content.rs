//! What a report shows: fronts, motions, findings and the model file.

use super::motion_report::{Column, MotionReport};
use super::sections::Section;
use crate::plot::PlotSpec;
use crate::view::{Frame, MechanismView};

/// Everything a report shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// Title of the mechanism.
    pub title: String,
    /// The model file it comes from.
    pub file_name: String,
    /// Fronts of designs, above the motions.
    pub fronts: Vec<FrontReport>,
    /// Studies with a motion, in the order of the tabs.
    pub motions: Vec<MotionReport>,
    /// What stands above the motions: warnings.
    pub first: Vec<Section>,
    /// Findings, in order: mobility, groups, assemblies.
    pub sections: Vec<Section>,
    /// The text of the model file; none is shown when it is empty.
    pub source: String,
    /// Name and text of the other design's file, where that is another one.
    pub other_source: Option<(String, String)>,
    /// The program that wrote it, with its version, for the last line.
    pub generator: String,
    /// When it was written; not told when empty, so that the same run gives the same bytes.
    pub date: String,
}

/// Designs none of which is better than another in all goals, to choose among.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontReport {
    /// Name of the study.
    pub name: String,
    /// What it is, in a sentence; may be empty.
    pub about: String,
    /// Number, parameters, goals and further numbers: the columns of the table, a value for each design.
    pub columns: Vec<Column>,
    /// Which of the columns are goals, two at least.
    pub goals: Vec<usize>,
    /// The goals of the file's own design, in their columns' units, where it has them.
    pub own: Option<Vec<f64>>,
    /// The picture before a script draws it: the second goal over the first.
    pub plot: PlotSpec,
    /// The designs, in the order of the columns' values.
    pub designs: Vec<FrontDesign>,
}

/// A design of a front.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontDesign {
    /// Its name: `07`.
    pub name: String,
    /// Its file beside the report: `front/07.toml`; empty where it has none.
    pub file: String,
    /// What is said about it; may be empty.
    pub note: String,
    /// The mechanism and its poses; none where nothing of it moves.
    pub moving: Option<(MechanismView, Vec<Frame>)>,
    /// The name of the motion that shows it with plots, where the report has it.
    pub motion: String,
}
