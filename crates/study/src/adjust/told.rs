//! What is said of parameters that were looked for.

mod findings;
mod rows;
mod values;

use kempe_model::{Diagnostic, Model, MotionStudy, Rows, Severity};
use kempe_motion::progress::Silent;
use kempe_number::text::significant;
use kempe_units::Dimension;

use super::bench::{Assembled, Bench};
use super::certainty::{Certainty, Untold};
use super::fit::Solution;
use crate::alternatives::hints;
use crate::explain::cannot_move;
use crate::motion::run_along;
use crate::result::{FoundDesign, StudyResult};
use crate::unit::Units;
use crate::words::list;

/// An answer of which the sum of squares is this many times that of another is worse.
const WORSE: f64 = 1.001;
/// Rows of the motion of what was found.
const ROWS: usize = 121;

pub(super) struct Teller<'b, 'm> {
    bench: &'b Bench<'m>,
    name: &'b str,
    units: Units,
}

impl<'b, 'm> Teller<'b, 'm> {
    pub fn new(bench: &'b Bench<'m>, name: &'b str) -> Self {
        Self {
            bench,
            name,
            units: Units::of(bench.model),
        }
    }

    fn names(&self) -> Vec<String> {
        let ids = self.bench.study.unknown.iter();
        ids.map(|id| format!("`{}`", self.bench.model.parameters[id.index()].name))
            .collect()
    }

    fn dimension(&self, unknown: usize) -> Dimension {
        let id = self.bench.study.unknown[unknown];
        self.bench.model.parameters[id.index()].dimension
    }

    /// `a = 80 mm, b = 150 mm`
    fn values(&self, unknown: &[f64]) -> String {
        let pairs = self.bench.study.unknown.iter().zip(unknown);
        let texts = pairs.map(|(id, value)| {
            let parameter = &self.bench.model.parameters[id.index()];
            let text = self.units.text(*value, parameter.dimension);
            format!("{} = {text}", parameter.name)
        });
        texts.collect::<Vec<_>>().join(", ")
    }

    /// The largest miss in words: box by 0.33 deg in row 4.
    fn worst(&self, solution: &Solution) -> String {
        let values = self.bench.data.values.iter().zip(&solution.misses);
        let worst = values.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        worst.map_or_else(String::new, |(datum, miss)| {
            let miss = self.units.text((miss * datum.scale).abs(), datum.dimension);
            let name = &self.bench.study.measures[datum.measure].name;
            format!("{name} by {miss} in row {}", datum.row + 1)
        })
    }

    /// Why there are no values.
    pub fn nothing(&self, found: &[Solution]) -> Diagnostic {
        let names = list(&self.names());
        let span = self.bench.study.span.clone();
        let error = |message: String| Diagnostic::error("no-answer", message).at(span.clone(), "");
        if let Some(turned) = found.first().filter(|it| !self.is_sound(it)) {
            return self.turned(turned, Diagnostic::error);
        }
        if let Some(other) = found.first() {
            let message = format!(
                "no {names} are found with which all rows can be reached, put together as the file means it"
            );
            return match self.hint(other) {
                Some(hint) => error(message)
                    .note(format!(
                        "put together otherwise, {} misses {}",
                        self.values(&other.unknown),
                        self.worst(other)
                    ))
                    .help(format!("write under [assembly]: {hint}")),
                None => error(message),
            };
        }
        let error = error(format!(
            "no {names} are found with which all rows can be reached"
        ));
        let start = self.bench.start();
        let error = match self.bench.moved(&start, &Assembled::AsMeant) {
            Ok(_) => error.note("measures have no finite value in some row"),
            Err(None) => {
                error.note("with the file's values a row lies beyond a limit of the motion")
            }
            Err(Some(why)) => {
                let told = cannot_move(&self.bench.design(&start), &why);
                error.note(format!("with the file's values: {}", told.message))
            }
        };
        error.help("give the parameters values with which the rows can be reached: the search begins there")
    }

    /// Whether a file can have the values.
    pub fn is_sound(&self, solution: &Solution) -> bool {
        let parameters = self.bench.parameters(&solution.unknown);
        self.bench.model.unsound(&parameters).is_empty()
    }

    /// Values with which the rows are met, and no file can have them: a length that points the other way.
    fn turned(
        &self,
        solution: &Solution,
        kind: fn(&'static str, String) -> Diagnostic,
    ) -> Diagnostic {
        let parameters = self.bench.parameters(&solution.unknown);
        let wrong = self.bench.model.unsound(&parameters);
        let values = self.values(&solution.unknown);
        let met = match solution.is_exact(self.bench) {
            true => "the rows are met".to_owned(),
            false => format!("the rows are met best, {}", self.worst(solution)),
        };
        let negative = (0..solution.unknown.len())
            .find(|k| solution.unknown[*k] < 0.0 && self.dimension(*k) == Dimension::LENGTH);
        let message = match negative {
            Some(k) => format!(
                "with {values} {met}: {} points the other way",
                self.names()[k]
            ),
            None => format!("with {values} {met}, and no file can have these"),
        };
        let diagnostic = kind("turned-link", message).at(self.bench.study.span.clone(), "");
        let diagnostic = wrong
            .iter()
            .fold(diagnostic, |d, wrong| d.note(wrong.message.clone()));
        match negative {
            Some(_) => diagnostic.help(
                "its link is turned by half a turn against what was measured: add 180 deg to its angles, or measure from the other end",
            ),
            None => diagnostic.help("give bounds, or look for another parameter"),
        }
    }

    /// What to write under `[assembly]` for the way in which a solution is put together.
    fn hint(&self, solution: &Solution) -> Option<String> {
        let Assembled::Like(begin, known) = &solution.assembled else {
            return None;
        };
        let all = self.bench.assemblies(&solution.unknown, *begin);
        let k = all
            .iter()
            .position(|it| it.branch.signs == known.branch.signs)?;
        let lines = hints(&self.bench.design(&solution.unknown), &all);
        lines.into_iter().nth(k)
    }

    /// Parameters that the data do not tell.
    pub fn untold(&self, untold: &Untold) -> Diagnostic {
        let names = self.names();
        let part = untold.together.iter().enumerate();
        let of: Vec<usize> = part.filter(|(_, x)| **x != 0.0).map(|(k, _)| k).collect();
        let error = |message: String| {
            Diagnostic::error("data-dependent", message).at(self.bench.study.span.clone(), "")
        };
        if let [one] = of[..] {
            return error(format!(
                "nothing that was measured depends on {}",
                names[one]
            ))
            .help(
                "give it a value, and take it from `unknown`; or measure something that it moves",
            );
        }
        let named: Vec<String> = of.iter().map(|k| names[*k].clone()).collect();
        let together = of
            .iter()
            .map(|k| format!("{} by {} %", names[*k], significant(untold.together[*k], 3)));
        error(format!(
            "what was measured does not tell {} apart",
            list(&named)
        ))
        .note(format!(
            "it stays as it is where these change together: {}",
            together.collect::<Vec<_>>().join(", ")
        ))
        .help("give one of them a value; or measure where they move something differently")
    }

    /// All that is told.
    pub fn result(
        &self,
        found: &[Solution],
        best: &Solution,
        known: &Certainty,
        (scales, square): (&[f64], f64),
    ) -> Result<StudyResult, Vec<Diagnostic>> {
        let (table, along) = self.table(best, known);
        let mut diagnostics = self.findings(found, best, (scales, square));
        let (designs, told) = self.designs(best);
        // Of what is not the answer nothing more is told.
        if diagnostics.is_empty() {
            diagnostics.extend(told);
        }
        let motion = self.bench.motion_of(&best.moved);
        let frames = motion.map_or_else(Vec::new, |motion| self.frames(motion));
        let mut table = table;
        if let Some((closure, singular)) = self.evidence(best) {
            table.closure = closure;
            table.smallest_singular_value = singular;
        }
        Ok(StudyResult {
            name: self.name.to_owned(),
            figures: self.figures(&table, best.is_exact(self.bench)),
            scalars: self.scalars(best, known, square),
            listings: self.listings(found, best, known, square),
            beside: Vec::new(),
            contacts: Vec::new(),
            happenings: Vec::new(),
            frames,
            shapes: Vec::new(),
            designs,
            events: Vec::new(),
            along,
            assemblies: motion.map_or((0, 0), |m| (m.assemblies.list.len(), m.assemblies.rejected)),
            diagnostics,
            demanded_rows: table.rows(),
            stopped_at: None,
            table,
        })
    }

    /// The file with the values that were found, moving along its own laws; and what is to be told of that.
    fn designs(&self, best: &Solution) -> (Vec<FoundDesign>, Vec<Diagnostic>) {
        let ids = self.bench.study.unknown.iter().copied();
        let values: Vec<_> = ids.zip(best.unknown.iter().copied()).collect();
        let (model, file) = self.bench.model.with_values(&values);
        let read = Model::from_toml(&file.toml, &model.title, &mut file.tables.files());
        let model = read.map_or(model, |checked| checked.model);
        let along = MotionStudy {
            rows: Rows::Count(ROWS),
            columns: Vec::new(),
            plots: Vec::new(),
            circuit: false,
        };
        let motion = run_along(&model, self.name, &along, false, &mut Silent);
        let (motion, told) = match motion {
            Ok(motion) => (Some(Box::new(motion)), Vec::new()),
            // The values are right whatever becomes of the rest.
            Err(told) => {
                let told = told.into_iter().map(|mut d| {
                    d.severity = Severity::Warning;
                    d
                });
                (None, told.collect())
            }
        };
        let design = FoundDesign {
            name: "01".to_owned(),
            title: self.values(&best.unknown),
            file,
            model,
            motion,
        };
        (vec![design], told)
    }
}
