//! What was measured, in SI.

use kempe_model::{AdjustStudy, Diagnostic, DriveId, Matched, Model, Span, value};
use kempe_units::Dimension;

use crate::prepared::design;
use crate::unit::Units;

/// All that was measured.
pub(super) struct Data {
    pub rows: Vec<Row>,
    /// What is to be met, row by row.
    pub values: Vec<Datum>,
    /// Standard deviations of the coordinates of drives, SI.
    pub of_drives: Vec<(DriveId, f64)>,
    /// Whether the file tells how far what was measured is off.
    pub weighted: bool,
    /// Values that have no given deviation although others have, by their measures.
    pub without: Vec<usize>,
}

/// What was measured together.
pub(super) struct Row {
    /// Coordinates of all drives, SI; none where the row tells of the whole motion.
    pub at: Option<Vec<f64>>,
    /// The drives whose coordinates were measured.
    pub given: Vec<DriveId>,
    /// When it is passed on the way through all rows, s.
    pub time: f64,
    pub span: Span,
}

/// A value that was measured.
#[derive(Clone, Debug)]
pub(super) struct Datum {
    pub row: usize,
    /// Which of the study's measures.
    pub measure: usize,
    pub dimension: Dimension,
    /// SI.
    pub value: f64,
    /// What an error of it is measured by, SI: its standard deviation, or where none is given a typical size.
    pub scale: f64,
    /// Its typical size, SI: an angle of 1 rad, a length of the mechanism.
    pub typical: f64,
}

impl Data {
    pub fn new(model: &Model, study: &AdjustStudy) -> Self {
        let own = design(model);
        let parameters = &own.parameters;
        let start: Vec<f64> = (model.drives.iter())
            .map(|d| d.law.at(0.0, parameters))
            .collect();
        let number = |scalar| value::<f64>(scalar, parameters);
        let weighted = !study.deviations.is_empty();
        let mut time = 0.0;
        let (mut rows, mut values) = (Vec::new(), Vec::new());
        for (index, row) in study.rows.iter().enumerate() {
            let given: Vec<DriveId> = row.drives().map(|(drive, _)| drive).collect();
            let at = (!given.is_empty()).then(|| {
                let mut at = start.clone();
                for (drive, coordinate) in row.drives() {
                    at[drive.index()] = number(coordinate);
                }
                at
            });
            if at.is_some() {
                time += 1.0;
            }
            for (measure, measured) in row.measures() {
                let dimension = study.measures[measure].dimension;
                let measured = number(measured);
                values.push(Datum {
                    row: index,
                    measure,
                    dimension,
                    value: measured,
                    scale: match study.deviation(Matched::Measure(measure)) {
                        Some(deviation) => number(deviation),
                        None => 0.0,
                    },
                    typical: 0.0,
                });
            }
            rows.push(Row {
                at,
                given,
                time,
                span: row.span.clone(),
            });
        }
        let mut without: Vec<usize> = Vec::new();
        // Where drives alone have deviations, measures are right.
        if values.iter().any(|datum: &Datum| datum.scale > 0.0) {
            let open = values.iter().filter(|datum: &&Datum| !(datum.scale > 0.0));
            without.extend(open.map(|datum| datum.measure));
            without.dedup();
        }
        // Without deviations what is measured alike counts alike: angles in rad, lengths in parts of the mechanism, others in
        // parts of the largest of them.
        let typical = |measure: usize, dimension: Dimension| match dimension {
            Dimension::ANGLE => 1.0,
            Dimension::LENGTH => own.size(),
            _ => {
                let of = values
                    .iter()
                    .filter(|datum: &&Datum| datum.measure == measure);
                let largest = of.map(|datum| datum.value.abs()).fold(0.0, f64::max);
                match largest > 0.0 {
                    true => largest,
                    false => 1.0,
                }
            }
        };
        let sizes: Vec<f64> = (values.iter())
            .map(|datum| typical(datum.measure, datum.dimension))
            .collect();
        for (datum, size) in values.iter_mut().zip(sizes) {
            datum.typical = size;
            if !(datum.scale > 0.0) {
                datum.scale = size;
            }
        }
        let of_drives = study
            .deviations
            .iter()
            .filter_map(|(of, deviation)| match of {
                Matched::Drive(drive) => Some((*drive, number(deviation))),
                Matched::Measure(_) => None,
            });
        Self {
            rows,
            values,
            of_drives: of_drives.collect(),
            weighted,
            without,
        }
    }

    /// The drives whose coordinates were measured somewhere.
    pub fn drives(&self) -> Vec<DriveId> {
        let mut all: Vec<DriveId> = self.rows.iter().flat_map(|row| row.given.clone()).collect();
        all.sort_by_key(|drive| drive.index());
        all.dedup();
        all
    }

    /// What is measured further than its value says, in units of its scale; angles to within half a turn.
    pub fn misses(&self, values: &[f64]) -> Vec<f64> {
        let pairs = self.values.iter().zip(values);
        pairs
            .map(|(datum, value)| {
                let miss = value - datum.value;
                let miss = match datum.dimension == Dimension::ANGLE {
                    true => kempe_number::math::within_half_a_turn(miss),
                    false => miss,
                };
                miss / datum.scale
            })
            .collect()
    }

    /// What is wrong with so many data for so many unknowns.
    pub fn refused(&self, study: &AdjustStudy, units: &Units) -> Vec<Diagnostic> {
        let unknowns = study.unknown.len();
        if let Some(measure) = self.without.first() {
            let name = &study.measures[*measure].name;
            let message = format!("`{name}` has no deviation, and others have");
            let error = Diagnostic::error("missing-key", message)
                .at(study.span.clone(), "")
                .help(format!(
                    "values weigh by their deviations: give that of `{name}` too, or none"
                ));
            return vec![error];
        }
        let doubled = self.doubled(study);
        if self.values.len() - doubled.len().min(self.values.len()) >= unknowns {
            return Vec::new();
        }
        // With so few data each must tell something new.
        if let Some((first, second)) = doubled.first() {
            let [a, b] = [first, second].map(|k| &self.values[*k]);
            let rows = [a, b].map(|datum| &self.rows[datum.row]);
            let name = &study.measures[a.measure].name;
            let same = (a.value - b.value).abs() <= SAME * a.typical;
            let (code, message, help) = match same {
                true => (
                    "data-repeated",
                    format!(
                        "row {} says of `{name}` what row {} says",
                        b.row + 1,
                        a.row + 1
                    ),
                    "measure it elsewhere",
                ),
                false => (
                    "data-contradictory",
                    format!(
                        "row {} says that `{name}` is {}, and row {} that it is {} at the same place",
                        b.row + 1,
                        units.text(b.value, b.dimension),
                        a.row + 1,
                        units.text(a.value, a.dimension)
                    ),
                    "leave one of them out, or measure more: with more rows than unknowns they are brought into balance",
                ),
            };
            return vec![
                Diagnostic::error(code, message)
                    .at(rows[1].span.clone(), "")
                    .see(rows[0].span.clone(), "the first time")
                    .help(help),
            ];
        }
        let message = match (self.values.len(), unknowns) {
            (1, _) => format!("one value was measured, and {unknowns} parameters are unknown"),
            (values, _) => {
                format!("{values} values were measured, and {unknowns} parameters are unknown")
            }
        };
        vec![
            Diagnostic::error("data-too-few", message)
                .at(study.span.clone(), "")
                .help("measure more, or look for fewer parameters"),
        ]
    }

    /// Pairs of values of one measure at one place.
    fn doubled(&self, study: &AdjustStudy) -> Vec<(usize, usize)> {
        let mut found = Vec::new();
        // Enough rows leave enough without them.
        if self.values.len() > 4 * study.unknown.len() + FEW {
            return found;
        }
        for (second, b) in self.values.iter().enumerate() {
            let same =
                |a: &Datum| a.measure == b.measure && self.rows[a.row].at == self.rows[b.row].at;
            if let Some(first) = self.values[..second].iter().position(same) {
                found.push((first, second));
            }
        }
        found
    }
}

/// So many rows more than unknowns are not looked through for pairs.
const FEW: usize = 64;
/// Values this near to each other, in parts of their scale, are one.
const SAME: f64 = 1e-12;
