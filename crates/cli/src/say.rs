//! What is said to people: diagnostics on the error stream, in colour on terminals, or kept for the JSON output.

use std::io::{ErrorKind, IsTerminal, Write as _};
use std::sync::atomic::{AtomicBool, Ordering};

use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use kempe_model::{Diagnostic, Severity};
use kempe_number::text::{is_hidden, visible};
use kempe_study::{ReportOrigin, of_other_design};
use serde_json::Value;

use crate::exit::Exit;
use crate::read::plain;

/// Says diagnostics about one file.
pub struct Speaker {
    json: bool,
    quiet: bool,
    strict: bool,
    file: String,
    text: String,
    /// The parameters of the other design, while that is spoken of.
    other: Option<Vec<(String, String)>>,
    /// What was said: nothing is said twice.
    told: Vec<Diagnostic>,
}

impl Speaker {
    /// A speaker that keeps what is said for JSON, or that leaves out warnings when quiet.
    pub fn new(json: bool, quiet: bool) -> Self {
        Self {
            json,
            quiet,
            strict: false,
            file: String::new(),
            text: String::new(),
            other: None,
            told: Vec::new(),
        }
    }

    /// As it is, but every warning is an error.
    pub fn strictly(mut self, strict: bool) -> Self {
        self.strict = strict;
        self
    }

    /// The file that diagnostics are about from now on.
    pub fn name_file(&mut self, name: &str, text: &str) {
        name.clone_into(&mut self.file);
        text.clone_into(&mut self.text);
    }

    /// From now on diagnostics are about the other one of two designs, a file with these parameters, and say so.
    pub fn turn_to_other(&mut self, file: &str, text: &str, set: &[(String, String)]) {
        self.name_file(file, text);
        self.other = Some(set.to_vec());
    }

    /// From now on diagnostics are about this design again, or about both.
    pub fn turn_back(&mut self, file: &str, text: &str) {
        self.other = None;
        self.name_file(file, text);
    }

    /// A diagnostic with whose it is.
    fn marked(&self, diagnostic: &Diagnostic) -> Diagnostic {
        let Some(set) = &self.other else {
            return diagnostic.clone();
        };
        let origin = ReportOrigin {
            file_name: &self.file,
            text: &self.text,
            set,
            ..ReportOrigin::default()
        };
        of_other_design(diagnostic, &origin)
    }

    /// Says diagnostics.
    pub fn tell(&mut self, diagnostics: &[Diagnostic]) {
        for diagnostic in diagnostics {
            let mut diagnostic = self.marked(diagnostic);
            if self.strict {
                diagnostic.severity = Severity::Error;
            }
            if self.told.contains(&diagnostic) {
                continue;
            }
            if !self.json && (!self.quiet || diagnostic.severity == Severity::Error) {
                let text = rendered(&diagnostic, &self.file, &self.text);
                put_error(&format!("{text}\n\n"));
            }
            self.told.push(diagnostic);
        }
    }

    /// Says a warning on the error stream even where only errors are wanted, and keeps it for JSON.
    pub fn insist(&mut self, diagnostic: &Diagnostic) {
        if self.json || (self.quiet && !self.strict) {
            let text = rendered(diagnostic, &self.file, &self.text);
            put_error(&format!("{text}\n\n"));
        }
        self.tell(std::slice::from_ref(diagnostic));
    }

    /// What was said, for the JSON output.
    pub fn diagnostics(&self) -> Value {
        let told = self.told.iter().map(kempe_study::encode::diagnostic);
        Value::Array(told.collect())
    }

    /// How a command ends that did its work and said this: found something, or did not find what was asked for.
    pub fn exit(&self) -> Exit {
        let worst = |severity| self.told.iter().any(|d| d.severity == severity);
        if worst(Severity::Error) {
            Exit::CannotSolve
        } else if worst(Severity::Warning) {
            Exit::Finding
        } else {
            Exit::Ok
        }
    }

    /// Prints the JSON object of a command that could not be finished.
    pub fn print_failure(&self) {
        if self.json {
            print_json(&serde_json::json!({ "diagnostics": self.diagnostics() }));
        }
    }

    /// How a command that failed ends: with what [`print_failure`](Self::print_failure) prints.
    pub fn failed(&self, exit: Exit) -> Exit {
        self.print_failure();
        exit
    }
}

/// Prints JSON on the standard output, what a terminal would obey escaped as JSON does.
pub fn print_json(value: &Value) {
    let text = serde_json::to_string_pretty(value).unwrap_or_default();
    let mut out = String::with_capacity(text.len() + 1);
    for c in text.chars() {
        match is_hidden(c) {
            true => out.push_str(&format!("\\u{:04x}", u32::from(c))),
            false => out.push(c),
        }
    }
    put_whole(&(out + "\n"));
}

/// Whether something could not be put on the standard output.
static LOST: AtomicBool = AtomicBool::new(false);

/// Prints text for people on the standard output, nothing in it that a terminal obeys; a reader that went away is no error.
pub fn put(text: &str) {
    put_whole(&visible(text));
}

/// Prints text on the standard output as it is.
fn put_whole(text: &str) {
    let mut out = std::io::stdout().lock();
    arrived(out.write_all(text.as_bytes()).and_then(|()| out.flush()));
}

/// Says what the command line's grammar answers: the help that was asked for, or what is wrong.
pub fn answer(answer: &clap::Error) -> Exit {
    if answer.use_stderr() {
        if std::env::args_os().any(|argument| argument == "--json") {
            print_json(
                &serde_json::json!({ "diagnostics": [kempe_study::encode::diagnostic(&refused(answer))] }),
            );
        } else {
            let _ = answer.print();
        }
        return Exit::Usage;
    }
    arrived(answer.print().and_then(|()| std::io::stdout().flush()));
    Exit::Ok
}

/// What is wrong with a command line, as a diagnostic.
fn refused(answer: &clap::Error) -> Diagnostic {
    let text = answer.to_string();
    let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    let first = lines.next().unwrap_or_default();
    let message = first.strip_prefix("error: ").unwrap_or(first);
    let diagnostic = Diagnostic::error("command-line", message);
    let told = lines.take_while(|line| !line.starts_with("Usage:"));
    let diagnostic = told.fold(diagnostic, |diagnostic, line| diagnostic.note(line));
    diagnostic.help("kempe --help tells all commands, kempe COMMAND --help what one takes")
}

/// Whether the standard output lost something.
pub fn lost() -> bool {
    LOST.load(Ordering::Relaxed)
}

/// Tells once where the standard output cannot be written.
fn arrived(written: std::io::Result<()>) {
    let Err(error) = written else {
        return;
    };
    if error.kind() == ErrorKind::BrokenPipe || LOST.swap(true, Ordering::Relaxed) {
        return;
    }
    let message = format!("the standard output cannot be written: {}", plain(&error));
    let diagnostic = Diagnostic::error("cannot-write", message)
        .help("make room on the disk, or send the output elsewhere");
    put_error(&format!("{}\n\n", rendered(&diagnostic, "", "")));
}

/// Prints text for people on the error stream, nothing in it that a terminal obeys; a reader that went away is no error.
pub fn complain(text: &str) {
    put_error(&visible(text));
}

/// Prints text with the colours that we gave it on the error stream.
fn put_error(text: &str) {
    let _ = std::io::stderr().lock().write_all(text.as_bytes());
}

/// A diagnostic in which everything shows.
fn shown(diagnostic: &Diagnostic) -> Diagnostic {
    let mut it = diagnostic.clone();
    let tame = |text: &mut String| *text = visible(text).into_owned();
    tame(&mut it.message);
    it.help.iter_mut().for_each(tame);
    it.notes.iter_mut().for_each(tame);
    for label in &mut it.labels {
        tame(&mut label.text);
        if let Some(source) = &mut label.source {
            tame(&mut source.name);
            source.text = in_place(&source.text);
        }
    }
    it
}

/// A text into which places point: what does not show gives way to signs of as many bytes.
fn in_place(text: &str) -> String {
    let stand_in = |c: char| match c.len_utf8() {
        _ if !is_hidden(c) || c == '\r' => c,
        1 => '?',
        2 => '¿',
        _ => '\u{fffd}',
    };
    text.chars().map(stand_in).collect()
}

/// Whether the error stream is a terminal that takes colours.
fn colours() -> bool {
    std::io::stderr().is_terminal()
        && std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty())
        && std::env::var_os("TERM").is_none_or(|t| t != "dumb")
}

/// A line without the codes that colour it.
fn uncoloured(line: &str) -> String {
    let parts = line.split('\u{1b}').enumerate();
    let plain = parts.map(|(index, part)| match part.split_once('m') {
        Some((_, rest)) if index > 0 => rest,
        _ => part,
    });
    plain.collect()
}

/// A diagnostic as text over its file, nothing in it that a terminal obeys but our colours.
fn rendered(diagnostic: &Diagnostic, file: &str, text: &str) -> String {
    drawn(&shown(diagnostic), &visible(file), &in_place(text))
}

fn drawn(diagnostic: &Diagnostic, file: &str, text: &str) -> String {
    let level = match diagnostic.severity {
        Severity::Warning => Level::WARNING,
        _ => Level::ERROR,
    };
    let mut group = Group::with_title(level.primary_title(&diagnostic.message).id(diagnostic.code));
    // One snippet for each text that labels point into, that of the primary label first.
    let mut sources: Vec<(&str, &str)> = Vec::new();
    let source_of = |label: &'_ kempe_model::Label| -> (String, String) {
        match &label.source {
            Some(source) => (source.name.clone(), source.text.clone()),
            None => (file.to_owned(), text.to_owned()),
        }
    };
    let owned: Vec<(String, String)> = diagnostic.labels.iter().map(source_of).collect();
    for (label, (name, content)) in diagnostic.labels.iter().zip(&owned) {
        let entry = (name.as_str(), content.as_str());
        if !sources.contains(&entry) {
            if label.primary {
                sources.insert(0, entry);
            } else {
                sources.push(entry);
            }
        }
    }
    for (name, content) in sources {
        let mut snippet = Snippet::source(content).path(name).fold(true);
        for (label, source) in diagnostic.labels.iter().zip(&owned) {
            if (source.0.as_str(), source.1.as_str()) != (name, content) {
                continue;
            }
            let kind = if label.primary {
                AnnotationKind::Primary
            } else {
                AnnotationKind::Context
            };
            let start = content.floor_char_boundary(label.span.start.min(content.len()));
            let end = content
                .ceil_char_boundary(label.span.end.min(content.len()))
                .max(start);
            let mut annotation = kind.span(start..end);
            if !label.text.is_empty() {
                annotation = annotation.label(label.text.as_str());
            }
            snippet = snippet.annotation(annotation);
        }
        group = group.element(snippet);
    }
    for note in &diagnostic.notes {
        group = group.element(Level::NOTE.message(note));
    }
    if let Some(help) = &diagnostic.help {
        group = group.element(Level::HELP.message(help));
    }
    let renderer = if colours() {
        Renderer::styled()
    } else {
        Renderer::plain()
    };
    let text = renderer.decor_style(DecorStyle::Ascii).render(&[group]);
    if diagnostic.labels.is_empty() {
        // Without a place there is no margin to keep free.
        let lines = text.lines().filter(|line| uncoloured(line).trim() != "|");
        return lines.collect::<Vec<_>>().join("\n");
    }
    text
}
