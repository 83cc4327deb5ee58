//! The `kempe` command line: files, terminals and exit codes around the library.

mod arguments;
mod clock;
mod command;
mod exit;
mod files;
mod fingerprint;
mod interrupt;
mod names;
mod output;
mod progress;
mod read;
mod say;

use std::process::ExitCode;

use clap::Parser;

use arguments::{Arguments, Command};
use exit::Exit;

fn main() -> ExitCode {
    let exit = match Arguments::try_parse() {
        Ok(arguments) => obey(&arguments.command),
        Err(answer) => say::answer(&answer),
    };
    // What could not be told is worse than what was to be told.
    match say::lost() {
        true => Exit::Usage.code(),
        false => exit.code(),
    }
}

fn obey(command: &Command) -> Exit {
    match command {
        Command::Check(check) => command::check::check(check),
        Command::Run(run) => command::run::run(run),
        Command::Sensitivities(asked) => command::sensitivities::sensitivities(asked),
        Command::Draw(draw) => command::draw::draw(draw),
        Command::New(new) => command::new::new(new),
        Command::Schema => command::lists::schema(),
        Command::Measures(measures) => command::lists::measures(measures),
        Command::Merge(merge) => command::merge::merge(merge),
        Command::Verify(verify) => command::verify::verify(verify),
        Command::Completions(completions) => command::lists::completions(completions),
    }
}
