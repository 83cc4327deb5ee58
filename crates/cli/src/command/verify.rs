//! `kempe verify`: the reference values of publications and closed forms, re-computed.

use std::fs;
use std::path::{Path, PathBuf};

use kempe_model::Diagnostic;
use kempe_study::verify::{Case, Comparison, compare};
use serde_json::json;

use crate::arguments::Verify;
use crate::exit::Exit;
use crate::files::near_file;
use crate::read::{Tables, plain, read_named};
use crate::say::{Speaker, print_json, put};

include!(concat!(env!("OUT_DIR"), "/embedded.rs"));

/// A case file with a way to read the files it names.
struct Found {
    name: String,
    text: String,
    /// It came with this program, and so did what it names.
    embedded: bool,
}

impl Found {
    /// The folder of the case, or of a file that it names.
    fn folder(&self, beside: &str) -> PathBuf {
        let parent = |path: &Path| path.parent().unwrap_or(Path::new("")).to_owned();
        parent(Path::new(&self.name)).join(parent(Path::new(beside)))
    }

    /// The model of the case, wherever it is.
    fn model(&self, name: &str) -> Result<String, String> {
        let path = self.folder("").join(name);
        match self.embedded {
            true => embedded(&path),
            false => read_named(&path).map_err(|why| format!("{}: {why}", path.display())),
        }
    }

    /// The tables beside the case, or beside a file that it names.
    fn tables(&self, beside: &str, outside: bool) -> impl FnMut(&str) -> Result<String, String> {
        let folder = self.folder(beside);
        let mut tables = Tables::of(&folder, outside);
        let embedded_too = self.embedded;
        move |name| match embedded_too {
            true => embedded(&folder.join(name)),
            false => tables.read(name),
        }
    }
}

/// A file that came with this program.
fn embedded(path: &Path) -> Result<String, String> {
    let wanted = simplified(path);
    EMBEDDED
        .iter()
        .find(|(path, _)| Path::new(path) == wanted)
        .map(|(_, text)| (*text).to_owned())
        .ok_or_else(|| format!("{} did not come with this program", wanted.display()))
}

/// A path without `..`.
fn simplified(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            std::path::Component::ParentDir => {
                out.pop();
            }
            std::path::Component::CurDir => {}
            part => out.push(part),
        }
    }
    out
}

/// Runs `kempe verify`.
pub fn verify(arguments: &Verify) -> Exit {
    let mut speaker = Speaker::new(arguments.json, false);
    let cases = match gather(&arguments.paths) {
        Ok(cases) => cases,
        Err(diagnostic) => {
            speaker.tell(&[*diagnostic]);
            speaker.print_failure();
            return Exit::Usage;
        }
    };
    let mut all: Vec<Comparison> = Vec::new();
    let mut worst = Exit::Ok;
    let mut out = String::new();
    let mut not_run = 0;
    for found in &cases {
        match run_case(found, arguments.allow_outside, &mut speaker) {
            Ok(comparisons) => {
                out.push_str(&summary(found, &comparisons, arguments.all));
                all.extend(comparisons);
            }
            Err(exit) => {
                out.push_str(&format!("{}: not run\n", found.name));
                not_run += 1;
                worst = worst.max(exit);
            }
        }
    }
    let missed = all.iter().filter(|c| !c.passed).count();
    if arguments.json {
        print_json(&json!({
            "cases": cases.len(),
            "not_run": not_run,
            "compared": all.len(),
            "missed": missed,
            "comparisons": all,
            "diagnostics": speaker.diagnostics(),
        }));
    } else {
        put(&format!(
            "{out}{} values in {} cases compared, {missed} missed{}\n",
            all.len(),
            cases.len() - not_run,
            match not_run {
                0 => String::new(),
                n => format!("; {n} cases not run"),
            }
        ));
    }
    if missed > 0 {
        worst.max(Exit::Finding)
    } else {
        worst
    }
}

/// The cases at the paths, or those that came with the program.
fn gather(paths: &[PathBuf]) -> Result<Vec<Found>, Box<Diagnostic>> {
    if paths.is_empty() {
        let cases = EMBEDDED
            .iter()
            // Models of cases stand in a folder below.
            .filter(|(path, _)| {
                let case = path.strip_prefix("validation/");
                case.is_some_and(|name| name.ends_with(".toml") && !name.contains('/'))
            });
        return Ok(cases
            .map(|(path, text)| Found {
                name: (*path).to_owned(),
                text: (*text).to_owned(),
                embedded: true,
            })
            .collect());
    }
    let refuse = |path: &Path, why: &str| {
        let message = format!("{} cannot be read: {why}", path.display());
        let error = Diagnostic::error("no-file", message);
        let near = near_file(path).filter(|_| !path.exists());
        Box::new(error.help(match near {
            Some(near) => format!("did you mean {near}?"),
            None => "name a file of reference values or a folder of them; without any those that came with the program are re-computed".to_owned(),
        }))
    };
    let mut files: Vec<PathBuf> = Vec::new();
    for path in paths {
        if path.is_dir() {
            let entries = fs::read_dir(path).map_err(|e| refuse(path, &plain(&e)))?;
            let mut inside: Vec<PathBuf> = entries
                .filter_map(|e| Some(e.ok()?.path()))
                .filter(|p| p.extension().is_some_and(|e| e == "toml"))
                .collect();
            inside.sort();
            files.extend(inside);
        } else {
            files.push(path.clone());
        }
    }
    let read = |path: PathBuf| {
        Ok(Found {
            text: read_named(&path).map_err(|why| refuse(&path, &why))?,
            name: path.display().to_string(),
            embedded: false,
        })
    };
    files.into_iter().map(read).collect()
}

fn run_case(found: &Found, outside: bool, speaker: &mut Speaker) -> Result<Vec<Comparison>, Exit> {
    let bad = |speaker: &mut Speaker, why: &dyn std::fmt::Display| {
        let message = format!("{}: {why}", found.name);
        speaker.tell(&[Diagnostic::error("bad-case", message)]);
        Exit::Usage
    };
    let case = Case::parse(&found.text, &mut found.tables("", outside));
    let case = case.map_err(|error| bad(speaker, &error))?;
    let model = found.model(&case.model);
    let model = model.map_err(|error| bad(speaker, &error))?;
    let compared = compare(&case, &model, &mut found.tables(&case.model, outside));
    compared.map_err(|errors| {
        speaker.name_file(&case.model, &model);
        speaker.tell(&errors);
        Exit::CannotSolve
    })
}

/// A case in one line, with its misses or all its values.
fn summary(found: &Found, comparisons: &[Comparison], all: bool) -> String {
    let missed = comparisons.iter().filter(|c| !c.passed).count();
    let title = comparisons.first().map_or("", |c| c.case.as_str());
    let worst = comparisons
        .iter()
        .map(|c| c.difference.abs() / c.allowed)
        .fold(0.0, f64::max);
    let verdict = match missed {
        0 => format!("ok, at most {worst:.2} of what is allowed"),
        n => format!("{n} MISSED"),
    };
    let mut out = format!(
        "{} ({title}): {} values, {verdict}\n",
        found.name,
        comparisons.len()
    );
    for c in comparisons.iter().filter(|c| all || !c.passed) {
        let mark = if c.passed { "ok    " } else { "MISSED" };
        let place = if c.place.is_empty() {
            String::new()
        } else {
            format!(" at {}", c.place)
        };
        let ours = match &c.problem {
            Some(problem) => problem.clone(),
            None => format!("ours {:.17}", c.ours),
        };
        out.push_str(&format!(
            "  {mark} {}{place}\n         {ours}\n         ref  {} {}   difference {:.1e}, allowed {:.1e}   {}\n",
            c.what, c.reference, c.unit, c.difference, c.allowed, c.source
        ));
    }
    out
}
