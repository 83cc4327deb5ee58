//! Studies that adjust: which values of some parameters make the mechanism do what was measured on it.

use crate::ids::{DriveId, ParameterId, Scalar, Span};
use crate::motion_study::{Column, MotionStudy};

/// Values of parameters from what was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct AdjustStudy {
    /// A row for each of what was measured; no columns or plots.
    pub along: MotionStudy,
    /// The parameters that are looked for; each is a number in the file.
    pub unknown: Vec<ParameterId>,
    /// The measures that rows give values of.
    pub measures: Vec<Column>,
    /// What was measured together, row by row.
    pub rows: Vec<MatchedRow>,
    /// Standard deviations of what was measured, where the file tells them.
    pub deviations: Vec<(Matched, Scalar)>,
    /// Between which values parameters are looked for.
    pub bounds: Vec<(ParameterId, [Option<Scalar>; 2])>,
    /// Where the study's name stands in the file.
    pub span: Span,
}

/// What a row gives a value of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Matched {
    /// The coordinate of a drive.
    Drive(DriveId),
    /// A measure, by its place among those of the study.
    Measure(usize),
}

/// Values that were measured together.
#[derive(Clone, Debug, PartialEq)]
pub struct MatchedRow {
    /// Where drives stood (the others at their start; where none is named the row tells of the whole motion), and what measures were there. Drives
    /// come first, then measures, in the order of the study.
    pub values: Vec<(Matched, Scalar)>,
    /// Where it stands in the file.
    pub span: Span,
}

impl MatchedRow {
    /// Where drives stood.
    pub fn drives(&self) -> impl Iterator<Item = (DriveId, &Scalar)> {
        self.values.iter().filter_map(|(what, value)| match what {
            Matched::Drive(drive) => Some((*drive, value)),
            Matched::Measure(_) => None,
        })
    }

    /// What measures were, by their places among those of the study.
    pub fn measures(&self) -> impl Iterator<Item = (usize, &Scalar)> {
        self.values.iter().filter_map(|(what, value)| match what {
            Matched::Measure(index) => Some((*index, value)),
            Matched::Drive(_) => None,
        })
    }
}

impl AdjustStudy {
    /// The standard deviation of what was measured of a drive or a measure, where the file tells it.
    pub fn deviation(&self, what: Matched) -> Option<&Scalar> {
        let mut own = self.deviations.iter().filter(|(of, _)| *of == what);
        own.next().map(|(_, value)| value)
    }

    /// Where its parts stand in the file.
    pub(crate) fn visit_places(&mut self, f: &mut dyn FnMut(&mut Span)) {
        f(&mut self.span);
        self.rows.iter_mut().for_each(|row| f(&mut row.span));
    }

    /// Every expression over parameters.
    pub(crate) fn visit_scalars(&mut self, f: &mut dyn FnMut(&mut Scalar)) {
        let rows = self.rows.iter_mut().flat_map(|row| &mut row.values);
        rows.chain(&mut self.deviations)
            .for_each(|(_, value)| f(value));
        let bounds = self.bounds.iter_mut().flat_map(|(_, ends)| ends);
        bounds.flatten().for_each(f);
    }
}
