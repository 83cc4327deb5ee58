//! The files of a run.

use std::ops::ControlFlow;
use std::path::PathBuf;

use kempe_draw::plot::PlotSpec;
use kempe_draw::report::{Block, Report, Section};
use kempe_draw::{DrawOptions, Frame, Outline, Theme, svg};
use kempe_model::{Diagnostic, Model, PARTIAL_TABLE, Study, StudyKind};
use kempe_study::{
    CheckReport, Done, MECHANISM, ModeShape, Progress, Proof, ReportAgainst, ReportOrigin,
    RowFiles, RowsError, Stage, StudyOutcome, StudyResult, design_picture, drawing_frames, drawn,
    encode, figures, figures_against, mechanism_view, outline,
};

use super::against::Against;
use crate::files::Loaded;
use crate::fingerprint::fnv1a64;
use crate::names;
use crate::output::{Kept, Output};

/// Width and height of a plot, mm.
const PLOT: [f64; 2] = [160.0, 100.0];

/// The page that shows everything.
pub const REPORT: &str = "report.html";

/// The names of a run's files that are known before it runs.
pub fn known_names(model: &Model, studies: &[&Study]) -> Vec<String> {
    let of_study = |study: &&Study| {
        let name = &study.name;
        let own = [
            format!("{name}.csv"),
            format!("{name}.parquet"),
            names::picture(model, name, MECHANISM),
        ];
        let rows = matches!(study.kind, StudyKind::Sweep(_)).then(|| names::rows(name, 0, 1));
        // How many mechanisms a search finds it tells when it has ended.
        let finds = matches!(
            study.kind,
            StudyKind::Optimize(_) | StudyKind::Synthesize(_) | StudyKind::Adjust(_)
        );
        let first = finds.then(|| names::design(name, "01.toml"));
        own.into_iter().chain(rows).chain(first)
    };
    let own = studies.iter().flat_map(of_study);
    own.chain([REPORT.to_owned()]).collect()
}

/// The names of the files that another design beside this one adds.
pub fn known_names_against(model: &Model, studies: &[&Study]) -> Vec<String> {
    let tables = studies.iter().flat_map(|study| {
        let of = |ending| names::of_other_design(&format!("{}.{ending}", study.name));
        ["csv", "parquet"].map(of)
    });
    tables
        .chain([names::comparison(model).to_owned()])
        .collect()
}

/// What a run has found, to be written.
pub struct Results<'r> {
    /// The model.
    pub loaded: &'r Loaded,
    /// What became of the studies.
    pub outcomes: &'r [StudyOutcome<'r>],
    /// What is to be known of the mechanism.
    pub check: CheckReport,
    /// The other design, where two are set beside each other.
    pub against: Option<&'r Against<'r>>,
    /// What is proved of the motion, where that was asked for.
    pub proof: Option<&'r Proof>,
    /// Of a run that was stopped, the studies that have no rows; `None` of a whole one.
    pub stopped: Option<Vec<&'r str>>,
    /// When, where the report shall tell it.
    pub date: Option<String>,
}

/// The files of a run.
pub struct Written {
    /// Where they are.
    pub files: Vec<PathBuf>,
    /// Whether the run was stopped, before or while it was drawn.
    pub stopped: bool,
}

/// A picture of a study.
struct Picture {
    /// The place of the study among the outcomes.
    study: usize,
    name: String,
    svg: String,
}

/// Pictures and the page.
#[derive(Default)]
struct Drawn {
    pictures: Vec<Picture>,
    page: Option<String>,
}

/// What draws some pictures, each with its name.
type Draws<'d> = Box<dyn Fn() -> Vec<(String, String)> + 'd>;

impl Results<'_> {
    /// Draws and writes all files, each whole or none. Those of a run that was stopped have names of their own and say so inside; where
    /// it is stopped while it is drawn, they are its tables and what was drawn by then.
    pub fn write(
        mut self,
        mut output: Output,
        kept: &mut [Kept],
        progress: &mut dyn Progress,
    ) -> Result<Written, Box<Diagnostic>> {
        let drawn = self.drawn(progress);
        if drawn.page.is_none() && self.stopped.is_none() {
            self.stopped = Some(Vec::new());
        }
        let partial = self.stopped.is_some();
        for result in self.outcomes.iter().filter_map(|o| o.result.as_ref().ok()) {
            // Of what a run that was stopped had found nothing stays beside the whole.
            let all: &[bool] = if partial { &[true] } else { &[false, true] };
            for partial in all {
                let file = names::of_run(&names::design(&result.name, ""), *partial);
                if let Some((inner, _)) = file.split_once('/') {
                    output.renew(inner);
                }
            }
        }
        for outcome in self.outcomes.iter().filter(|_| !partial) {
            let mut own = kept.iter_mut().filter(|k| !k.is_search());
            let own = own.find(|k| k.study() == outcome.study.name);
            if let (Some(parts), Ok(_)) = (own, &outcome.result) {
                self.write_rows(outcome.study, parts, &mut output)?;
            }
        }
        let model = &self.loaded.checked.model;
        let mut add = |name: &str, bytes: &[u8]| {
            if !partial {
                output.outdate(names::of_run(name, true));
            }
            output.add(&names::of_run(name, partial), bytes)
        };
        for (index, outcome) in self.outcomes.iter().enumerate() {
            let Ok(result) = &outcome.result else {
                continue;
            };
            let name = &result.name;
            self.write_table(self.loaded, result, |name| name.to_owned(), &mut add)?;
            // They were drawn in this order.
            let pictures = drawn.pictures.iter().filter(|p| p.study == index);
            let mut pictures = pictures.peekable();
            let mechanism = names::picture(model, name, MECHANISM);
            if let Some(picture) = pictures.next_if(|p| p.name == mechanism) {
                add(&picture.name, picture.svg.as_bytes())?;
            }
            for design in &result.designs {
                let own = |ending: &str| names::design(name, &format!("{}.{ending}", design.name));
                add(&own("toml"), design.file.toml.as_bytes())?;
                for (table, text) in design.file.tables.iter() {
                    add(&names::design(name, table), text.as_bytes())?;
                }
                if let Some(picture) = pictures.next_if(|p| p.name == own("svg")) {
                    add(&picture.name, picture.svg.as_bytes())?;
                }
            }
            for picture in pictures {
                add(&picture.name, picture.svg.as_bytes())?;
            }
        }
        if let Some(against) = self.against {
            for result in against
                .outcomes
                .iter()
                .filter_map(|o| o.result.as_ref().ok())
            {
                self.write_table(against.loaded, result, names::of_other_design, &mut add)?;
            }
            let table = encode::comparison_csv(&against.comparison);
            let table = match partial {
                true => encode::marked_partial(&table, "the run was stopped"),
                false => table,
            };
            add(names::comparison(model), table.as_bytes())?;
        }
        match &drawn.page {
            Some(page) => add(REPORT, page.as_bytes())?,
            // That of an earlier run that was stopped shows another one.
            None => output.outdate(names::of_run(REPORT, true)),
        }
        Ok(Written {
            files: output.publish()?,
            stopped: partial,
        })
    }

    /// All pictures and the page. A run that was stopped before is drawn to its end: what is finished is shown.
    fn drawn(&self, progress: &mut dyn Progress) -> Drawn {
        let draws: Vec<(usize, Draws<'_>)> = (self.outcomes.iter().enumerate())
            .flat_map(|(index, outcome)| {
                let draws = outcome.result.as_ref().ok();
                let draws = draws.map(|result| self.draws(outcome.study, result));
                draws.into_iter().flatten().map(move |draw| (index, draw))
            })
            .collect();
        let report = self.report();
        let all = draws.len() + report.parts();
        let mut reached = |done: usize| match progress.reached(Stage::Drawing, Done::Of(done, all))
        {
            ControlFlow::Break(()) if self.stopped.is_none() => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        };
        let mut drawn = Drawn::default();
        for (done, (study, draw)) in draws.iter().enumerate() {
            if reached(done).is_break() {
                return drawn;
            }
            let pictures = draw().into_iter();
            drawn.pictures.extend(pictures.map(|(name, svg)| Picture {
                study: *study,
                name,
                svg,
            }));
        }
        if reached(draws.len()).is_continue() {
            drawn.page = report.to_html_with(&mut |parts| reached(draws.len() + parts));
        }
        drawn
    }

    /// What draws the pictures of a study: its mechanism, those of the designs that it found, its vibrations and its plots.
    fn draws<'d>(&'d self, study: &'d Study, result: &'d StudyResult) -> Vec<Draws<'d>> {
        let model = &self.loaded.checked.model;
        let name = &result.name;
        let mut all: Vec<Draws<'d>> = Vec::new();
        if !result.frames.is_empty() {
            all.push(Box::new(move || {
                let picture = names::picture(model, name, MECHANISM);
                vec![(picture, self.picture(study, result))]
            }));
        }
        for design in &result.designs {
            all.push(Box::new(move || {
                let own = names::design(name, &format!("{}.svg", design.name));
                let picture = design_picture(design).into_iter();
                let drawn = picture.map(|scene| svg::document(&scene, Theme::Light));
                drawn.map(|svg| (own.clone(), svg)).collect()
            }));
        }
        for shape in &result.shapes {
            all.push(Box::new(move || {
                let own = names::picture(model, name, &shape.name);
                vec![(own, shape_picture(model, study, shape))]
            }));
        }
        for (plot, spec) in self.plots(result) {
            all.push(Box::new(move || {
                let height = if spec.equal_aspect {
                    PLOT[0] * 0.8
                } else {
                    PLOT[1]
                };
                let scene = spec.draw(PLOT[0], height).scene;
                let own = names::picture(model, name, &plot);
                vec![(own, svg::document(&scene, Theme::Light))]
            }));
        }
        all
    }

    /// The rows of all designs of a sweep.
    fn write_rows(
        &self,
        study: &Study,
        parts: &mut Kept,
        output: &mut Output,
    ) -> Result<(), Box<Diagnostic>> {
        let Some(files) = RowFiles::of(&self.loaded.checked.model, study) else {
            return Ok(());
        };
        let origin = origin(self.loaded, None);
        let mut refused = None;
        for number in 0..files.count() {
            let name = names::rows(&study.name, number, files.count());
            output.add_with(&name, |file| {
                match files.write(number, parts, &origin, file) {
                    Ok(()) => Ok(true),
                    Err(RowsError::Written(error)) => Err(error),
                    Err(RowsError::Part(diagnostic)) => {
                        refused = Some(diagnostic);
                        Ok(false)
                    }
                }
            })?;
        }
        refused.map_or(Ok(()), Err)
    }

    /// A table as CSV and Parquet, under the names that `named` makes of the study's.
    fn write_table(
        &self,
        loaded: &Loaded,
        result: &StudyResult,
        named: impl Fn(&str) -> String,
        add: &mut impl FnMut(&str, &[u8]) -> Result<(), Box<Diagnostic>>,
    ) -> Result<(), Box<Diagnostic>> {
        let name = &result.name;
        let [csv, parquet] = ["csv", "parquet"].map(|ending| named(&format!("{name}.{ending}")));
        let why = self.stopped.as_ref().map(|_| how_far(result));
        let table = encode::csv(&result.table);
        match &why {
            Some(why) => add(&csv, encode::marked_partial(&table, why).as_bytes())?,
            None => add(&csv, table.as_bytes())?,
        }
        drop(table);
        for table in &result.beside {
            let name = named(&format!("{name}.{}.csv", table.name));
            let table = encode::csv(table);
            match &why {
                Some(why) => add(&name, encode::marked_partial(&table, why).as_bytes())?,
                None => add(&name, table.as_bytes())?,
            }
        }
        let bytes = encode::parquet(&result.table, &origin(loaded, why));
        let bytes = bytes.map_err(|error| not_encoded(&parquet, &error.to_string()))?;
        add(&parquet, &bytes)
    }

    /// The other design's model with its result of the same study.
    fn beside(&self, result: &StudyResult) -> Option<(&Model, &StudyResult)> {
        let against = self.against?;
        let other = against.design().result(&result.name)?;
        Some((&against.loaded.checked.model, other))
    }

    fn plots(&self, result: &StudyResult) -> Vec<(String, PlotSpec)> {
        // Of mechanisms that were found each has its own, but for what belongs to no motion.
        if result.frames.is_empty() && result.figures.is_empty() {
            return Vec::new();
        }
        let model = &self.loaded.checked.model;
        match self.beside(result) {
            Some((other_model, other)) => figures_against(model, result, other_model, other),
            None => figures(model, result),
        }
    }

    /// The mechanism at its first row that was reached, by both designs where that may be.
    fn picture(&self, study: &Study, result: &StudyResult) -> String {
        let model = &self.loaded.checked.model;
        let view = mechanism_view(model, Some(study.kind.along()));
        let frames = drawing_frames(model, result);
        let beside = self.beside(result);
        let beside = beside.map(|(model, other)| outline(result, model, other));
        let name = self.against.map_or("", |a| a.comparison.against.as_str());
        let other = beside
            .as_ref()
            .map(|(view, frames)| Outline { name, view, frames });
        let closure = &result.table.closure;
        let reached = |row: &usize| closure.get(*row).is_some_and(|c| c.is_finite());
        let both = |row: &usize| {
            let pose = other.map(|o| o.frames.get(*row).is_some_and(is_placed));
            reached(row) && pose.unwrap_or(true)
        };
        let mut rows = 0..closure.len();
        let first = rows.clone().find(both).or_else(|| rows.find(reached));
        let stage = kempe_draw::Stage::with_outline(&view, &frames, other, DrawOptions::default());
        svg::document(&stage.scene(first.unwrap_or(0)), Theme::Light)
    }

    fn report(&self) -> Report {
        let origin = ReportOrigin {
            generator: &generator(),
            date: self.date.as_deref().unwrap_or(""),
            ..self.loaded.origin()
        };
        let other = self.against.map(|against| against.loaded.origin());
        let against = (self.against.zip(other.as_ref())).map(|(against, origin)| ReportAgainst {
            design: against.design(),
            origin,
            warnings: &against.loaded.checked.warnings,
            comparison: &against.comparison,
        });
        let mut report = kempe_study::report(
            &self.loaded.checked.model,
            &origin,
            &self.loaded.checked.warnings,
            &self.check,
            self.outcomes,
            against.as_ref(),
        );
        if let Some(proof) = self.proof {
            report.sections.insert(0, proof.section());
        }
        if let Some(missing) = &self.stopped {
            report.title = format!("{} (partial: the run was stopped)", report.title);
            let others = self.against.map_or(&[][..], |against| against.outcomes);
            report
                .first
                .insert(0, partial_section(self.outcomes, others, missing));
            let results = self.outcomes.iter().filter_map(|o| o.result.as_ref().ok());
            let results = results.flat_map(|r| std::iter::repeat_n(r, r.motions()));
            for (motion, result) in report.motions.iter_mut().zip(results) {
                motion.mark = format!("{PARTIAL_TABLE} {}", how_far(result));
            }
        }
        report
    }
}

/// A natural vibration with both ends of its way behind its middle.
fn shape_picture(model: &Model, study: &Study, shape: &ModeShape) -> String {
    let view = mechanism_view(model, Some(study.kind.along()));
    let frames = shape.frames.iter();
    let frames: Vec<Frame> = frames
        .map(|f| drawn(model, f, shape.title.clone()))
        .collect();
    let options = DrawOptions {
        ghosts: shape.extremes.to_vec(),
        ..DrawOptions::default()
    };
    let scene = kempe_draw::Stage::new(&view, &frames, options).scene(0);
    svg::document(&scene, Theme::Light)
}

/// How much of a study a run has that was stopped.
fn how_far(result: &StudyResult) -> String {
    let (name, rows) = (&result.name, result.table.rows());
    match result.how_far() {
        Some(how_far) => format!("{how_far} of {name}, the run was stopped"),
        None => format!("all {rows} rows of {name}, but the run was stopped before its end"),
    }
}

/// What the report of a run says that was stopped.
fn partial_section(
    outcomes: &[StudyOutcome<'_>],
    others: &[StudyOutcome<'_>],
    missing: &[&str],
) -> Section {
    let results = outcomes.iter().filter_map(|o| o.result.as_ref().ok());
    let of_other = others.iter().filter_map(|o| o.result.as_ref().ok());
    let of_other = of_other.map(|r| format!("{} (the other design)", how_far(r)));
    let lines = results.map(how_far).chain(of_other);
    let without = missing.iter().map(|name| format!("{name}: no rows"));
    Section {
        title: "Partial result: the run was stopped".to_owned(),
        blocks: vec![Block::List(lines.chain(without).collect())],
    }
}

fn not_encoded(name: &str, why: &str) -> Box<Diagnostic> {
    let message = format!("{name} cannot be written: {why}");
    Box::new(Diagnostic::error("cannot-write", message).note("earlier results are as they were"))
}

/// Where a table comes from, for its metadata.
fn origin(loaded: &Loaded, partial: Option<String>) -> Vec<(String, String)> {
    let units = &loaded.checked.model.units;
    let hash = fnv1a64(loaded.text.as_bytes());
    let mut all = vec![
        ("program".to_owned(), generator()),
        ("model".to_owned(), loaded.name.clone()),
        ("model_hash".to_owned(), format!("fnv1a64:{hash:016x}")),
        ("length_unit".to_owned(), units.length.name.clone()),
        ("angle_unit".to_owned(), units.angle.name.clone()),
    ];
    all.extend(partial.map(|why| ("partial".to_owned(), why)));
    all
}

/// Whether a pose has its points.
fn is_placed(pose: &Frame) -> bool {
    !pose.points.is_empty() && pose.points.iter().flatten().all(|v| v.is_finite())
}

/// The program's name and version, for files that say where they come from.
fn generator() -> String {
    format!("kempe {}", env!("CARGO_PKG_VERSION"))
}
