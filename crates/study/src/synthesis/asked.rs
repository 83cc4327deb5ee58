//! Measures and conditions that a request names, read in the names of the linkages' files.

use kempe_model::{Asked, Diagnostic, Model, ModelFile, Span, SynthesizeStudy, value};

use super::candidate::Candidate;
use crate::unit::{Units, shown};

/// What is asked of every linkage.
pub(super) struct Questions<'a> {
    /// The model that asks.
    pub request: &'a Model,
    /// The study.
    pub study: &'a SynthesizeStudy,
    /// Parameters of the request that its texts name, as they are written into a linkage's file.
    pub parameters: Vec<(String, String)>,
}

impl<'a> Questions<'a> {
    /// Looks at every question in the names of a linkage of the kind.
    ///
    /// # Errors
    ///
    /// What is wrong with them, over the model file.
    pub fn new(
        request: &'a Model,
        study: &'a SynthesizeStudy,
        sample: &Candidate,
    ) -> Result<Self, Vec<Diagnostic>> {
        let questions = Self {
            request,
            study,
            parameters: parameters(request, study, sample),
        };
        let file = sample.file(&request.title, request, &questions.parameters);
        let linkage = match read(&file) {
            Ok(model) => model,
            Err(wrong) => return Err(not_a_file(wrong, sample, &file)),
        };
        let placed = |d: Diagnostic, asked: &Asked| placed(d, asked, sample);
        let mut told = Vec::new();
        for asked in &study.accept {
            match linkage.condition(&asked.text) {
                Ok(found) if found.left.needs_forces => told.push(needs_forces(asked)),
                Ok(_) => {}
                Err(wrong) => told.extend(wrong.into_iter().map(|d| placed(d, asked))),
            }
        }
        for asked in study.rank.iter().chain(&study.columns) {
            match linkage.measure(&asked.text) {
                Ok(found) if found.needs_forces => told.push(needs_forces(asked)),
                Ok(_) => {}
                Err(wrong) => told.extend(wrong.into_iter().map(|d| placed(d, asked))),
            }
        }
        match told.is_empty() {
            true => Ok(questions),
            false => Err(told),
        }
    }
}

/// What is wrong with the text of a question, where that stands in the model file.
fn placed(mut diagnostic: Diagnostic, asked: &Asked, sample: &Candidate) -> Diagnostic {
    let start = asked.span.start;
    for label in &mut diagnostic.labels {
        if label.source.take().is_some() {
            let Span {
                start: from,
                end: to,
            } = label.span;
            label.span = start + from..start + to;
        }
    }
    diagnostic.note(format!("the linkages have {}", sample.names()))
}

fn needs_forces(asked: &Asked) -> Diagnostic {
    Diagnostic::error(
        "needs-forces-study",
        format!("`{}` asks for a force", asked.text),
    )
    .at(
        asked.span.clone(),
        "nothing acts on the linkages that are found",
    )
    .help("ask how they move; forces belong to a study of the linkage's own file")
}

/// A linkage's file that cannot be read: only what the request adds to it can be wrong with it, or what is joined to the request's own links.
fn not_a_file(
    diagnostics: Vec<Diagnostic>,
    sample: &Candidate,
    file: &ModelFile,
) -> Vec<Diagnostic> {
    let told = diagnostics.into_iter().map(|mut d| {
        let labels = std::mem::take(&mut d.labels);
        let line = labels.first().and_then(|label| line_at(&file.toml, label.span.start));
        let d = match line {
            Some(line) => d.note(format!("where it says `{line}`")),
            None => d,
        };
        match sample {
            Candidate::Linkage(_) => d
                .note("in the file of a linkage that was found")
                .help("parameters that the study names go into the linkages' files: give them names that no part of these has"),
            Candidate::Beside(it) => d.note(format!(
                "in this file with what was found joined to it: {}",
                it.names
            )),
        }
    });
    told.collect()
}

/// The line of a text that holds a place, without what stands around it.
fn line_at(text: &str, at: usize) -> Option<&str> {
    let before = text.get(..at)?;
    let start = before.rfind('\n').map_or(0, |end| end + 1);
    text[start..].lines().next().map(str::trim)
}

/// A file that was made, read.
pub(super) fn read(file: &ModelFile) -> Result<Model, Vec<Diagnostic>> {
    let read = Model::from_toml(&file.toml, "", &mut file.tables.files());
    read.map(|checked| checked.model)
}

/// The parameters that the texts of a study name; what stands beside the request's own mechanism has them all.
fn parameters(
    request: &Model,
    study: &SynthesizeStudy,
    sample: &Candidate,
) -> Vec<(String, String)> {
    let Candidate::Linkage(sample) = sample else {
        return Vec::new();
    };
    let asked = study.accept.iter().chain(&study.rank).chain(&study.columns);
    let measures = sample.measures.iter().map(|(_, text)| text.as_str());
    let texts: Vec<&str> = asked.map(|a| a.text.as_str()).chain(measures).collect();
    let values = request.parameter_values::<f64>();
    let units = Units::of(request);
    // What the linkage has a name for is the linkage's.
    let own = sample
        .lengths()
        .into_iter()
        .map(|(name, _)| name.to_owned());
    let more = sample.parameters.iter().map(|(name, _)| name.clone());
    let formulas = ["link_ratio", "grashof", "full_turn"].map(str::to_owned);
    let own: Vec<String> = own.chain(more).chain(formulas).collect();
    let named = request
        .parameters
        .iter()
        .filter(|p| !own.contains(&p.name))
        .filter(|p| texts.iter().any(|t| names(t, &p.name)));
    named
        .map(|p| {
            let unit = units.unit(p.dimension);
            let number = shown(value(&p.value, &values), &unit);
            (
                p.name.clone(),
                format!("{number} {}", unit.text()).trim_end().to_owned(),
            )
        })
        .collect()
}

/// Whether a text has a name in it.
pub(super) fn names(text: &str, name: &str) -> bool {
    let part_of_name = |c: char| c.is_alphanumeric() || c == '_';
    text.split(|c| !part_of_name(c)).any(|word| word == name)
}
