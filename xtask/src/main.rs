//! Developer tasks: `cargo xtask test`, what people and CI run before a change goes in.

mod chromium;
mod circles;
mod fuzz;
mod peers;
mod shell;
mod slim;
mod tasks;
mod wasm;
mod work_precision;

use std::process::ExitCode;

const HELP: &str = "\
Developer tasks.

  cargo xtask test         everything below but bench, peers and fuzz: format, lints, docs, all tests and doctests, slim, wasm
  cargo xtask test --fast  format, all tests and doctests
  cargo xtask circles      no file takes names from one that takes names from it, straight or through others
  cargo xtask slim         the library without default features builds and pulls nothing it should not
  cargo xtask wasm         the WebAssembly module gives the native bytes under node; installs its target where it can
  cargo xtask bench        all benchmarks, ratios printed, peers beside them; arguments as for `cargo bench`, then without peers
  cargo xtask peers [NAME] simulate, synthesis and optimize beside other programs, as far as these can be installed: errors, times, their ratios
  cargo xtask fuzz [SECS]  every fuzz target for SECS seconds (30); needs a nightly toolchain and cargo-fuzz
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match arguments.as_slice() {
        ["test"] => tasks::test(false),
        ["test", "--fast"] => tasks::test(true),
        ["bench", rest @ ..] => tasks::bench(rest),
        ["peers", names @ ..] => peers::peers(names),
        ["circles"] => circles::circles(),
        ["slim"] => slim::slim(),
        ["wasm"] => wasm::wasm(),
        ["fuzz"] => fuzz::fuzz(30),
        ["fuzz", seconds] => match seconds.parse() {
            Ok(seconds) => fuzz::fuzz(seconds),
            Err(_) => Err(format!("`{seconds}` is no number of seconds")),
        },
        [] | ["help" | "--help" | "-h"] => {
            print!("{HELP}");
            return ExitCode::SUCCESS;
        }
        other => Err(format!("there is no task `{}`\n\n{HELP}", other.join(" "))),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("xtask: {message}");
            ExitCode::FAILURE
        }
    }
}
