//! Other programs on benchmarks of simulation, of synthesis and of optimisation, where they can be installed: `benches/peers` of these crates.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::shell::{answers, cargo, root, run, target_folder};
use crate::work_precision::{read, table};

/// Names under which Python is installed; the variable `PYTHON` says another.
const PYTHONS: [&str; 2] = ["python3", "python"];

/// Numeric libraries of the peers keep to one thread, as Kempe's simulations do.
const ONE_THREAD: [(&str, &str); 3] = [
    ("OMP_NUM_THREADS", "1"),
    ("OPENBLAS_NUM_THREADS", "1"),
    ("MKL_NUM_THREADS", "1"),
];

/// A benchmark that has peers beside it.
struct Benchmark {
    /// The package `kempe-NAME`, in the folder `crates/NAME`; its benchmark, which leaves its own runs in `NAME.csv` of cargo's folder.
    name: &'static str,
    /// What the peers are given: a file beside the benchmark, or one that it leaves.
    input: Input,
}

enum Input {
    Kept(&'static str),
    Left(&'static str),
}

const BENCHMARKS: [Benchmark; 3] = [
    Benchmark {
        name: "simulate",
        input: Input::Kept("known.csv"),
    },
    Benchmark {
        name: "synthesis",
        input: Input::Left("synthesis-problems.txt"),
    },
    Benchmark {
        name: "optimize",
        input: Input::Left("optimize.csv"),
    },
];

/// Kempe's runs of the benchmarks, or of those named, those of the peers, and what the same error costs each. Where no peer can be installed,
/// this is told, and Kempe's runs stand alone.
///
/// # Errors
///
/// What failed.
pub fn peers(names: &[&str]) -> Result<(), String> {
    if let Some(name) = names
        .iter()
        .find(|name| BENCHMARKS.iter().all(|b| b.name != **name))
    {
        let known = BENCHMARKS.map(|b| b.name).join(", ");
        return Err(format!("no peers of `{name}`; there are those of {known}"));
    }
    let wanted = |name: &str| names.is_empty() || names.contains(&name);
    for Benchmark { name, .. } in BENCHMARKS.iter().filter(|b| wanted(b.name)) {
        let package = format!("kempe-{name}");
        cargo(&["bench", "-p", &package, "--bench", name], &[])?;
    }
    let mut all = BENCHMARKS.iter().filter(|b| wanted(b.name));
    all.try_for_each(beside_one)
}

/// The peers beside the runs that the benchmarks left last.
///
/// # Errors
///
/// What failed.
pub fn beside() -> Result<(), String> {
    BENCHMARKS.iter().try_for_each(beside_one)
}

fn beside_one(benchmark: &Benchmark) -> Result<(), String> {
    let name = benchmark.name;
    let folder = root().join(format!("crates/{name}/benches"));
    let left = target_folder().join("tmp");
    let own = left.join(format!("{name}.csv"));
    let theirs = left.join(format!("{name}-peers.csv"));
    let python = match environment(&folder.join("peers/requirements.txt")) {
        Ok(python) => python,
        Err(reason) => {
            println!("\npeers of {name} are left out: {reason}");
            return Ok(());
        }
    };
    let mut command = Command::new(python);
    command.arg("-B").arg(folder.join("peers/peers.py"));
    command.arg(match benchmark.input {
        Input::Kept(file) => folder.join(file),
        Input::Left(file) => left.join(file),
    });
    command.arg(&theirs);
    command.env("PYTHONPATH", root().join("xtask/peers"));
    run(command.envs(ONE_THREAD), "python peers.py")?;
    let mut runs = read(&text(&own)?)?;
    runs.extend(read(&text(&theirs)?)?);
    print!("\n{}", table(&runs));
    Ok(())
}

fn text(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

/// The Python of an environment of its own in cargo's folder, with those peers that could be installed there.
fn environment(requirements: &Path) -> Result<PathBuf, String> {
    let named = std::env::var("PYTHON").ok().filter(|name| !name.is_empty());
    let names = named.map_or(PYTHONS.map(String::from).to_vec(), |name| vec![name]);
    let python = (names.iter())
        .find(|name| answers(name, &["--version"]))
        .ok_or("there is no Python. PYTHON=/path/to/python3 says where one is")?;
    let folder = target_folder().join("peers");
    let own = match cfg!(windows) {
        true => folder.join("Scripts/python.exe"),
        false => folder.join("bin/python"),
    };
    if !answers(&own.to_string_lossy(), &["-m", "pip", "--version"]) {
        let mut command = Command::new(python);
        command.args(["-m", "venv", "--clear"]).arg(&folder);
        run(&mut command, &format!("{python} -m venv"))?;
    }
    let wanted = text(requirements)?;
    let wanted: Vec<&str> = wanted.lines().filter(|line| !line.is_empty()).collect();
    let installed = wanted.iter().filter(|peer| install(&own, peer)).count();
    match installed {
        0 => Err(format!(
            "none of {} is there for this Python, or no way to it",
            wanted.join(", ")
        )),
        _ => Ok(own),
    }
}

/// Installs a peer of one version unless it is there; whether it is there now. What has to be compiled is not taken: it would be
/// another program.
fn install(python: &Path, peer: &str) -> bool {
    let mut command = Command::new(python);
    command.args(["-m", "pip", "install", "--quiet"]);
    command.args(["--disable-pip-version-check", "--only-binary", ":all:"]);
    command.args(["--retries", "1", "--timeout", "20", peer]);
    let done = run(&mut command, &format!("pip install {peer}"));
    done.is_ok()
}
