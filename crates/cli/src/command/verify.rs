//! `kempe verify`: the published reference cases, re-run.

use std::fs;
use std::path::{Path, PathBuf};

use kempe_model::Diagnostic;
use kempe_study::verify::{Case, Comparison, compare};
use serde_json::json;

use crate::arguments::Verify;
use crate::exit::Exit;
use crate::files::{plain, read_table};
use crate::say::{Speaker, print_json, put};

include!(concat!(env!("OUT_DIR"), "/embedded.rs"));

/// A case file with a way to read the files it names.
struct Found {
    name: String,
    text: String,
    folder: Option<PathBuf>,
}

impl Found {
    /// Reads a file named from the case's folder, or from that of a file named there.
    fn read(&self, name: &str, beside: &str) -> Result<String, String> {
        let path = Path::new(beside)
            .parent()
            .unwrap_or(Path::new(""))
            .join(name);
        match &self.folder {
            Some(folder) => read_table(folder, &path.to_string_lossy()),
            None => {
                let case = Path::new(&self.name).parent().unwrap_or(Path::new(""));
                let wanted = simplified(&case.join(path));
                EMBEDDED
                    .iter()
                    .find(|(path, _)| Path::new(path) == wanted)
                    .map(|(_, text)| (*text).to_owned())
                    .ok_or_else(|| format!("{} did not come with this program", wanted.display()))
            }
        }
    }
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
        match run_case(found, &mut speaker) {
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
                folder: None,
            })
            .collect());
    }
    let refuse = |path: &Path, error: &std::io::Error| {
        Box::new(Diagnostic::error(
            "no-file",
            format!("{} cannot be read: {}", path.display(), plain(error)),
        ))
    };
    let mut files: Vec<PathBuf> = Vec::new();
    for path in paths {
        if path.is_dir() {
            let entries = fs::read_dir(path).map_err(|e| refuse(path, &e))?;
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
        let text = fs::read_to_string(&path).map_err(|e| refuse(&path, &e))?;
        Ok(Found {
            name: path.display().to_string(),
            text,
            folder: Some(path.parent().unwrap_or(Path::new("")).to_owned()),
        })
    };
    files.into_iter().map(read).collect()
}

fn run_case(found: &Found, speaker: &mut Speaker) -> Result<Vec<Comparison>, Exit> {
    let case = Case::parse(&found.text, &mut |name| found.read(name, "")).map_err(|error| {
        speaker.tell(&[Diagnostic::error(
            "bad-case",
            format!("{}: {error}", found.name),
        )]);
        Exit::Usage
    })?;
    let model = found.read(&case.model, "").map_err(|error| {
        speaker.tell(&[Diagnostic::error(
            "bad-case",
            format!("{}: {error}", found.name),
        )]);
        Exit::Usage
    })?;
    let compared = compare(&case, &model, &mut |name| found.read(name, &case.model));
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
