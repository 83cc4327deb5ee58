//! A linkage of its own, with the motion that leads it through what is asked.

use kempe_synthesis::{C, Linkage, Pose};
use kempe_units::Dimension;

/// A linkage with the motion that leads it through what is asked. Its first dyad is the driven crank.
pub(super) struct OwnLinkage {
    /// Its geometry, m.
    pub linkage: Linkage,
    /// The coupler where the drive starts.
    pub start: Pose,
    /// The link whose angle is looked at, and that angle where the drive starts, rad: whole turns count.
    pub turned: Option<(&'static str, f64)>,
    /// Where its crank goes from and to, rad from the frame's first axis.
    pub drive: [f64; 2],
    /// A point of the coupler that is looked at, in the coupler's own axes, m.
    pub point: Option<C>,
    /// Whether the coupler's own axes are to be kept: they are those of a body that is guided.
    pub keeps_axes: bool,
    /// Named numbers of its file: name, and what is written behind it.
    pub parameters: Vec<(String, String)>,
    /// Named measures of its file.
    pub measures: Vec<(String, String)>,
    /// Numbers that are told of it besides: name, value (SI), what it measures. The first is what it is ordered by where nothing else is said.
    pub told: Vec<(String, f64, Dimension)>,
    /// What it must do, so that it can be held against what it does.
    pub wanted: Vec<Wanted>,
}

/// A value that a measure of a linkage must have.
pub(super) struct Wanted {
    /// The measure, in the names of the linkage's file.
    pub measure: String,
    /// Where its crank stands, rad.
    pub at: f64,
    /// The value, SI.
    pub value: f64,
    /// What a miss of it is measured in, SI, where it is no length in its linkage, and no angle.
    pub scale: Option<f64>,
}

/// What misses of rates are measured in, of the first order and of the second, as these are asked for of what has this size (SI): the largest
/// there is. An output that turns back, or stands still, has rates of 0, and rounding leaves a part of the others of them.
pub(super) fn scales_of_rates(size: f64, first: &[f64], second: &[f64]) -> [f64; 2] {
    let largest = |of: &[f64]| of.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let first = largest(first);
    [first, largest(second).max(first * first / size)]
}

impl OwnLinkage {
    /// The lengths by which it is known, by their names in its file, m.
    pub fn lengths(&self) -> Vec<(&'static str, f64)> {
        match &self.linkage {
            Linkage::FourBar(bar) => {
                let [ground, crank, coupler, rocker] = bar.all_lengths();
                let all = [
                    ("ground", ground),
                    ("crank_length", crank),
                    ("coupler_length", coupler),
                    ("rocker_length", rocker),
                ];
                all.to_vec()
            }
            Linkage::SliderCrank(slider) => {
                let [crank, coupler, offset] = slider.dimensions();
                vec![
                    ("crank_length", crank),
                    ("coupler_length", coupler),
                    ("offset", offset),
                ]
            }
            Linkage::InvertedSliderCrank(slider) => {
                let ground = (slider.fixed[1] - slider.fixed[0]).norm();
                let [crank, _, offset] = slider.dimensions();
                vec![
                    ("ground", ground),
                    ("crank_length", crank),
                    ("offset", offset),
                ]
            }
            Linkage::TwoSliders(..) => Vec::new(),
        }
    }

    /// The lengths of its links, m.
    pub fn links(&self) -> Vec<f64> {
        links_of(&self.lengths())
    }
}

/// Of lengths in a linkage's file those of its links.
pub(super) fn links_of(lengths: &[(&str, f64)]) -> Vec<f64> {
    let links = lengths.iter().filter(|(name, _)| *name != "offset");
    links.map(|(_, length)| *length).collect()
}
