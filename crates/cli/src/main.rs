//! The `kempe` command line: files, terminals and exit codes around the library.

mod arguments;
mod command;
mod exit;
mod files;
mod interrupt;
mod names;
mod output;
mod progress;
mod say;

use std::process::ExitCode;

use clap::Parser;

use arguments::{Arguments, Command};

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let exit = match &arguments.command {
        Command::Check(check) => command::check::check(check),
        Command::Run(run) => command::run::run(run),
        Command::Sensitivities(asked) => command::sensitivities::sensitivities(asked),
        Command::Draw(draw) => command::draw::draw(draw),
        Command::New(new) => command::new::new(new),
        Command::Schema => command::lists::schema(),
        Command::Measures(measures) => command::lists::measures(measures),
        Command::Verify(verify) => command::verify::verify(verify),
        Command::Completions(completions) => command::lists::completions(completions),
    };
    exit.code()
}
