//! `kempe run`: the studies of a model, as tables, figures and a report.

use std::path::{Path, PathBuf};

use kempe_draw::report::{Block, Section};
use kempe_draw::{DrawOptions, Stage, Theme, svg};
use kempe_model::{Diagnostic, Model, Study};
use kempe_study::{
    MECHANISM, StudyOutcome, StudyResult, drawing_frames, encode, figures, mechanism_view,
};
use kempe_units::nearest;
use serde_json::{Value, json};

use crate::arguments::Run;
use crate::exit::Exit;
use crate::files::{Loaded, load, plain};
use crate::output::Batch;
use crate::progress::Bar;
use crate::say::{Speaker, print_json, put};
use crate::{interrupt, names};

/// Width and height of a plot, mm.
const PLOT: [f64; 2] = [160.0, 100.0];

/// Runs `kempe run`.
pub fn run(arguments: &Run) -> Exit {
    let mut speaker =
        Speaker::new(arguments.json, arguments.quiet).strictly(arguments.model.strict);
    let loaded = match load(&arguments.model, &mut speaker) {
        Ok(loaded) => loaded,
        Err(exit) => return failed(&speaker, exit),
    };
    let model = &loaded.checked.model;
    let studies = match chosen(model, &arguments.studies, &loaded.name) {
        Ok(studies) => studies,
        Err(diagnostic) => {
            speaker.tell(&[*diagnostic]);
            return failed(&speaker, Exit::Usage);
        }
    };
    interrupt::listen();
    let mut outcomes: Vec<StudyOutcome<'_>> = Vec::new();
    for study in &studies {
        let mut bar = Bar::new(&study.name, arguments.quiet || arguments.json);
        let result = kempe_study::run(model, study, &mut bar);
        drop(bar);
        match &result {
            Ok(result) => speaker.tell(&result.diagnostics),
            Err(errors) => speaker.tell(errors),
        }
        outcomes.push(StudyOutcome { study, result });
        if interrupt::stopped() {
            break;
        }
    }
    let mut files = Vec::new();
    let finished: Vec<&str> = (outcomes.iter().filter(|o| o.result.is_ok()))
        .map(|o| o.study.name.as_str())
        .collect();
    let missing: Vec<&str> = (studies.iter().map(|s| s.name.as_str()))
        .filter(|name| !finished.contains(name))
        .collect();
    if let (Some(folder), false) = (&arguments.out, finished.is_empty()) {
        if arguments.model.strict && speaker.exit() != Exit::Ok {
            speaker.tell(&[warned(folder)]);
        } else if !missing.is_empty() && !interrupt::stopped() {
            speaker.tell(&[nothing_written(&loaded, folder, &finished, &missing)]);
        } else {
            match write(
                &loaded,
                folder,
                &outcomes,
                &missing,
                arguments.quiet || arguments.json,
            ) {
                Ok(written) => files = written,
                Err(diagnostic) => {
                    speaker.tell(&[*diagnostic]);
                    return failed(&speaker, Exit::Usage);
                }
            }
        }
    }
    if arguments.json {
        print_json(&summary_json(
            &loaded,
            &outcomes,
            &files,
            arguments.out.is_none(),
            &speaker,
        ));
    } else if !arguments.quiet {
        put(&summary(&outcomes, arguments.out.as_deref(), &files));
    }
    match interrupt::stopped() {
        true => Exit::Interrupted,
        false => speaker.exit(),
    }
}

fn failed(speaker: &Speaker, exit: Exit) -> Exit {
    speaker.print_failure();
    exit
}

/// With `--strict` a warning keeps results from being written.
pub fn warned(target: &Path) -> Diagnostic {
    let message = format!(
        "nothing was written to {}: with --strict every warning is an error",
        target.display()
    );
    Diagnostic::error("not-written", message)
        .note("earlier results are as they were")
        .help("mend what is warned of, or leave out --strict")
}

/// A folder holds the results of one run: where a study could not run, nothing of the others is written either.
fn nothing_written(
    loaded: &Loaded,
    folder: &Path,
    finished: &[&str],
    missing: &[&str],
) -> Diagnostic {
    let names: Vec<String> = missing.iter().map(|name| format!("`{name}`")).collect();
    let message = format!(
        "nothing was written to {}: {} could not run",
        folder.display(),
        names.join(", ")
    );
    Diagnostic::warning("not-written", message)
        .note("earlier results are as they were")
        .help(format!(
            "run the others by themselves: kempe run {} {} --out {}",
            loaded.name,
            finished.join(" "),
            folder.display()
        ))
}

/// The studies named on the command line, each once, or all.
fn chosen<'m>(
    model: &'m Model,
    names: &[String],
    file: &str,
) -> Result<Vec<&'m Study>, Box<Diagnostic>> {
    let mut studies: Vec<&Study> = Vec::new();
    for name in names {
        let study = model.studies.iter().find(|s| s.name == *name);
        let study = study.ok_or_else(|| Box::new(unknown_study(model, name, file)))?;
        if studies.iter().all(|s| s.name != study.name) {
            studies.push(study);
        }
    }
    if names.is_empty() {
        studies.extend(&model.studies);
    }
    match studies.is_empty() {
        true => Err(Box::new(nothing_to_run(model))),
        false => Ok(studies),
    }
}

/// Why a model without studies that can run has none.
pub fn nothing_to_run(model: &Model) -> Diagnostic {
    if model.drives.is_empty() {
        return Diagnostic::error(
            "no-drive",
            "there is nothing to run: the file has no study and no drive",
        )
        .help("say what moves: [drives] motor = { turns = \"crank\", from = 0, to = 360, speed = \"1 rad/s\" }");
    }
    let skipped: Vec<String> = (model.announced.iter())
        .map(|s| format!("`{}` is a study of kind \"{}\"", s.name, s.kind))
        .collect();
    Diagnostic::error(
        "study-not-available",
        "there is nothing to run: this version has none of the kinds of study that the file asks for",
    )
    .note(skipped.join(", "))
    .help("ask for the motion: [studies.turn] with the line kind = \"motion\"")
}

/// A study named on the command line that cannot be meant.
fn unknown_study(model: &Model, name: &str, file: &str) -> Diagnostic {
    if let Some(skipped) = model.announced.iter().find(|s| s.name == *name) {
        let message = format!(
            "study `{name}` cannot run: this version has no `{}` studies",
            skipped.kind
        );
        return Diagnostic::error("study-not-available", message).help(others(model));
    }
    let diagnostic = Diagnostic::error("unknown-study", format!("there is no study `{name}`"));
    if Path::new(name).extension().is_some_and(|e| e == "toml") || Path::new(name).is_file() {
        return diagnostic
            .note(format!(
                "what follows the model file {file} are its studies"
            ))
            .help(format!("one model file at a time: kempe run {name}"));
    }
    let known = model.studies.iter().map(|s| s.name.as_str());
    match nearest(name, known) {
        Some(near) => diagnostic.help(format!("did you mean `{near}`?")),
        None => diagnostic.help(others(model)),
    }
}

/// The studies that can run.
fn others(model: &Model) -> String {
    let known: Vec<&str> = model.studies.iter().map(|s| s.name.as_str()).collect();
    match known.is_empty() {
        true => "the file has no other study; ask for the motion: [studies.turn] with the line kind = \"motion\"".to_owned(),
        false => format!("the file has: {}", known.join(", ")),
    }
}

/// Writes all files of a run, each whole or none.
fn write(
    loaded: &Loaded,
    folder: &Path,
    outcomes: &[StudyOutcome<'_>],
    missing: &[&str],
    quiet: bool,
) -> Result<Vec<PathBuf>, Box<Diagnostic>> {
    let diagnostic = |path: &Path, reason: &str| {
        let message = format!("{} cannot be written: {reason}", path.display());
        Box::new(
            Diagnostic::error("cannot-write", message).note("earlier results are as they were"),
        )
    };
    let mut batch = Batch::in_folder(folder).map_err(|e| diagnostic(folder, &plain(&e)))?;
    let mut add = |name: String, bytes: &[u8]| {
        let path = folder.join(name);
        batch
            .add(&path, bytes)
            .map_err(|e| diagnostic(&path, &plain(&e)))
    };
    let model = &loaded.checked.model;
    let origin = vec![
        ("program".to_owned(), generator()),
        ("model".to_owned(), loaded.name.clone()),
        (
            "model_hash".to_owned(),
            format!("fnv1a64:{:016x}", hash(loaded.text.as_bytes())),
        ),
        ("length_unit".to_owned(), model.units.length.name.clone()),
        ("angle_unit".to_owned(), model.units.angle.name.clone()),
    ];
    for outcome in outcomes {
        let Ok(result) = &outcome.result else {
            continue;
        };
        let name = &result.name;
        add(format!("{name}.csv"), encode::csv(&result.table).as_bytes())?;
        let bytes = encode::parquet(&result.table, &origin);
        let bytes = bytes
            .map_err(|e| diagnostic(&folder.join(format!("{name}.parquet")), &e.to_string()))?;
        add(format!("{name}.parquet"), &bytes)?;
        add(
            names::picture(model, name, MECHANISM),
            picture(model, outcome.study, result).as_bytes(),
        )?;
        for (plot, spec) in figures(model, result) {
            let height = if spec.equal_aspect {
                PLOT[0] * 0.8
            } else {
                PLOT[1]
            };
            let scene = spec.draw(PLOT[0], height).scene;
            add(
                names::picture(model, name, &plot),
                svg::document(&scene, Theme::Light).as_bytes(),
            )?;
        }
    }
    // Stopped, it is not begun anew: the report says so.
    let check = kempe_study::check_with_progress(model, &mut Bar::new("check", quiet));
    let mut report = kempe_study::report(
        model,
        &loaded.name,
        &generator(),
        &loaded.checked.warnings,
        &check,
        outcomes,
    );
    report.first.splice(0..0, stopped_before(missing));
    add("report.html".to_owned(), report.to_html().as_bytes())?;
    batch.publish().map_err(|unpublished| {
        if unpublished.kept.is_empty() {
            return diagnostic(folder, &plain(&unpublished.error));
        }
        let kept = unpublished.kept.iter().map(|p| p.display().to_string());
        let message = format!(
            "{} cannot be written: {}",
            folder.display(),
            plain(&unpublished.error)
        );
        let note = "earlier results could not all be put back; they are kept as";
        Box::new(
            Diagnostic::error("cannot-write", message)
                .note(format!("{note} {}", kept.collect::<Vec<_>>().join(", "))),
        )
    })
}

/// What a report says of studies that Ctrl-C kept from running.
fn stopped_before(missing: &[&str]) -> Option<Section> {
    let diagnostic = |name: &&str| {
        format!(
            "{name}: not run; its files in this folder, if there are any, are those of an earlier run"
        )
    };
    (!missing.is_empty()).then(|| Section {
        title: "Stopped by Ctrl-C".to_owned(),
        blocks: vec![Block::List(missing.iter().map(diagnostic).collect())],
    })
}

/// The mechanism at its first row that was reached.
fn picture(model: &Model, study: &Study, result: &StudyResult) -> String {
    let view = mechanism_view(model, Some(study.kind.along()));
    let frames = drawing_frames(model, result);
    let row = result
        .table
        .closure
        .iter()
        .position(|c| c.is_finite())
        .unwrap_or(0);
    let stage = Stage::new(&view, &frames, DrawOptions::default());
    svg::document(&stage.scene(row), Theme::Light)
}

/// The program's name and version, for files that say where they come from.
fn generator() -> String {
    format!("kempe {}", env!("CARGO_PKG_VERSION"))
}

/// FNV-1a of a model's text: tells whether a table belongs to a file.
fn hash(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

fn summary(outcomes: &[StudyOutcome<'_>], folder: Option<&Path>, files: &[PathBuf]) -> String {
    let mut out = String::new();
    for outcome in outcomes {
        let Ok(result) = &outcome.result else {
            out.push_str(&format!("{}: not run\n", outcome.study.name));
            continue;
        };
        let table = &result.table;
        out.push_str(&format!("{}: {} rows", result.name, table.rows()));
        if result.interrupted() {
            out.push_str(&format!(" of {}, stopped", result.demanded_rows));
        }
        if table.unreached() > 0 {
            out.push_str(&format!(", {} not reached", table.unreached()));
        }
        out.push_str(&format!(
            ", loops closed to {:.1e} of the mechanism's size",
            table.worst_closure()
        ));
        if let Some((_, difference)) = table.worst_route_difference() {
            out.push_str(&format!(
                ", virtual power and Newton-Euler agree to {difference:.1e}"
            ));
        }
        out.push('\n');
        let width = result
            .scalars
            .iter()
            .map(|s| s.name.chars().count())
            .max()
            .unwrap_or(0);
        for scalar in &result.scalars {
            let value = kempe_number::text::significant(scalar.value, 12);
            out.push_str(
                format!("  {:width$}  {value} {}", scalar.name, scalar.unit.text()).trim_end(),
            );
            out.push('\n');
        }
        for listing in &result.listings {
            out.push_str(&format!("  {}\n", listing.title));
            let rows = std::iter::once(&listing.head).chain(&listing.rows);
            out.push_str(&aligned(rows.filter(|r| !r.is_empty()), 4));
        }
        for event in &result.events {
            out.push_str(&format!("  {}: {}\n", event.place, event.label));
        }
    }
    if let (Some(folder), false) = (folder, files.is_empty()) {
        out.push_str(&format!(
            "{} files in {}: open ",
            files.len(),
            folder.display()
        ));
        out.push_str(&format!("{}\n", folder.join("report.html").display()));
    }
    out
}

/// Rows of words with their columns below each other.
fn aligned<'r>(rows: impl Iterator<Item = &'r Vec<String>>, indent: usize) -> String {
    let rows: Vec<&Vec<String>> = rows.collect();
    let columns = rows.iter().map(|r| r.len()).max().unwrap_or(0);
    let width = |k: usize| {
        rows.iter()
            .filter_map(|r| r.get(k))
            .map(|c| c.chars().count())
            .max()
    };
    let widths: Vec<usize> = (0..columns).map(|k| width(k).unwrap_or(0)).collect();
    let line = |row: &Vec<String>| {
        let cells = row
            .iter()
            .zip(&widths)
            .map(|(cell, w)| format!("{cell:w$}"));
        let text = cells.collect::<Vec<_>>().join("  ");
        format!("{:indent$}{}\n", "", text.trim_end())
    };
    rows.into_iter().map(line).collect()
}

fn summary_json(
    loaded: &Loaded,
    outcomes: &[StudyOutcome<'_>],
    files: &[PathBuf],
    with_tables: bool,
    speaker: &Speaker,
) -> Value {
    let studies = outcomes.iter().map(|outcome| match &outcome.result {
        Ok(result) => encode::result(result, with_tables),
        Err(_) => json!({ "study": outcome.study.name, "failed": true }),
    });
    json!({
        "file": loaded.name,
        "title": loaded.checked.model.title,
        "studies": studies.collect::<Vec<_>>(),
        "files": files.iter().map(|f| f.display().to_string()).collect::<Vec<_>>(),
        "diagnostics": speaker.diagnostics(),
    })
}
