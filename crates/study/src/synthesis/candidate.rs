//! A linkage that is right where it is asked, before anybody has looked how it moves there.

use kempe_synthesis::{C, Linkage, Pose};
use kempe_units::Dimension;

/// What a task leads to.
pub(super) struct Found {
    /// All linkages that are right where it is asked.
    pub candidates: Vec<Candidate>,
    /// Those that already their geometry rules out.
    pub rejected: Vec<Rejected>,
    /// How many there can be, and how they were looked for.
    pub searched: String,
}

/// A linkage that is of no use.
pub(super) struct Rejected {
    /// The linkage by its dimensions.
    pub what: String,
    /// Why.
    pub why: String,
}

/// A linkage with the motion that leads it through what is asked. Its first dyad is the driven crank.
pub(super) struct Candidate {
    /// Its geometry, m.
    pub linkage: Linkage,
    /// The coupler where the drive starts.
    pub start: Pose,
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
}

impl Candidate {
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
}

/// Whether two values of a measure are one but for whole turns of an angle; what is between them.
pub(super) fn apart(a: f64, b: f64, dimension: Dimension) -> f64 {
    match dimension == Dimension::ANGLE {
        true => kempe_number::math::within_half_a_turn(a - b).abs(),
        false => (a - b).abs(),
    }
}
