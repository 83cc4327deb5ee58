//! The command line's grammar and its help.

use std::ffi::OsStr;
use std::path::PathBuf;

use clap::builder::{PossibleValue, StringValueParser, TypedValueParser};
use clap::{Args, Parser, Subcommand};

use crate::output::Shard;

/// A workbench for planar linkages: one short model file becomes motion, numbers and pictures.
#[derive(Debug, Parser)]
#[command(
    name = "kempe",
    version,
    propagate_version = true,
    after_help = "Start here:\n  kempe new my-linkage.toml\n  kempe run my-linkage.toml --out results\n\n\
                  Exit codes:\n  0    all is well\n  1    done, and something was found: a warning, a miss of verify, a gap in a proof\n  \
                  2    the command line or the model file is wrong, or something cannot be read or written\n  \
                  3    the mechanism cannot be assembled or moved as asked, or a warning with --strict\n  130  stopped by Ctrl-C, SIGTERM or SIGHUP: finished rows are kept as a partial result, a check tells what it found"
)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The verbs.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Tell mobility, Assur groups, Grashof types, assemblies and reach of a mechanism
    Check(Check),
    /// Run the studies of a model: tables, figures and one HTML report
    Run(Run),
    /// Tell how every measure changes with every parameter at one place
    Sensitivities(Sensitivities),
    /// Draw a mechanism at one pose, or move it: SVG, PNG, DXF, GIF, APNG
    Draw(Draw),
    /// Write a commented starter file
    New(New),
    /// Print the JSON schema of the model file, for editors
    Schema,
    /// List what may be measured
    Measures(Measures),
    /// Join the parts of a sweep that several machines computed: what one run would have written
    Merge(Merge),
    /// Re-compute all reference values: ours, theirs, the difference, the source
    Verify(Verify),
    /// Print a completion script for a shell
    Completions(Completions),
}

/// The model file with its overrides: what every verb that reads a model takes.
#[derive(Debug, Args)]
pub struct ModelFile {
    /// Model file
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Set a parameter, as in --set a=25mm; may be repeated
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = name_and_value)]
    pub set: Vec<(String, String)>,
    /// Take every warning for an error: exit code 3, and nothing is written
    #[arg(long)]
    pub strict: bool,
    /// Read tables from anywhere, not only beside and below the file
    #[arg(long)]
    pub allow_outside: bool,
}

fn name_and_value(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() && !value.trim().is_empty() => {
            Ok((name.trim().to_owned(), value.trim().to_owned()))
        }
        _ => Err("write a name and a value, such as a=25mm".to_owned()),
    }
}

/// `kempe check`
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  kempe check hitch.toml\n  kempe check hitch.toml --set k=450mm --json\n  kempe check hitch.toml --certify\n\n\
                        Exit codes: 0 nothing to say, 1 warnings or a gap in the proof (a change point is one),\n\
                        2 bad file, 3 the mechanism cannot move as asked,\n\
                        130 stopped by Ctrl-C, SIGTERM or SIGHUP (what was found until then is told)."
)]
pub struct Check {
    #[command(flatten)]
    pub model: ModelFile,
    /// Prove the motion by interval arithmetic: how much of it is certain, where it is not, and bounds of its numbers
    #[arg(long)]
    pub certify: bool,
    /// Print one JSON object instead of text
    #[arg(long)]
    pub json: bool,
}

/// `kempe sensitivities`
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  kempe sensitivities crank.toml --at motor=30deg\n  kempe sensitivities crank.toml --set a=25mm --json\n\n\
                        Derivatives of [measures] to [parameters], the drive's place held; without --at at its start."
)]
pub struct Sensitivities {
    #[command(flatten)]
    pub model: ModelFile,
    /// Where the drive stands, as in --at motor=30deg or --at time=2s
    #[arg(long, value_name = "DRIVE=VALUE")]
    pub at: Option<String>,
    /// Print one JSON object instead of text
    #[arg(long)]
    pub json: bool,
}

/// `kempe run`
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  kempe run hitch.toml --out results\n  kempe run hitch.toml lifting --out results --set k=450mm\n  \
                        kempe run hitch.toml --json --quiet | jq .studies[0].values\n  \
                        kempe run hitch.toml --against-set k=450mm --out results\n  \
                        kempe run new.toml --against old.toml\n\n\
                        Writes STUDY.csv, STUDY.parquet, STUDY-*.svg and report.html. All appear at the end, each whole.\n\
                        Where a study cannot run (exit code 3) or a file cannot be written, none does, and the folder\n\
                        stays as it was. Earlier files of studies that are not asked for stay.\n\n\
                        Nothing is replaced but what Kempe wrote and nobody changed; .kempe-files.json in the folder\n\
                        lists that. One run at a time writes to a folder.\n\n\
                        With --against or --against-set it writes comparison.csv and the other design's STUDY.against.csv\n\
                        and STUDY.against.parquet besides; pictures and report show both. --set is of this design alone,\n\
                        but where the other one is given by --against-set without --against. The exit code is the worse\n\
                        of both; a design that cannot run beside this one does not keep this one's results from being\n\
                        written.\n\n\
                        Ctrl-C, SIGTERM and SIGHUP keep the finished rows beside an earlier result: STUDY.partial.csv,\n\
                        report.partial.html and so on, which say inside how far the run came.\n\n\
                        A sweep also writes STUDY.rows.parquet, the rows of all its designs. Its finished parts are kept in\n\
                        STUDY.parts until it is whole: the same command goes on from there, however the run before ended.\n\
                        A study that optimises keeps there what it has asked of designs, and goes on in the same way.\n\
                        With --shard K/N several machines share a sweep; kempe merge joins their parts."
)]
pub struct Run {
    #[command(flatten)]
    pub model: ModelFile,
    /// Studies to run; all of the file unless named
    #[arg(value_name = "STUDY")]
    pub studies: Vec<String>,
    /// Folder for the results; without it, only the summary is printed
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Set the design of another model file beside this one: drawings, plots, and a table of differences
    #[arg(long, value_name = "FILE")]
    pub against: Option<PathBuf>,
    /// Set a parameter of the other design, as in --against-set a=25mm; may be repeated. Without --against the other design is
    /// this file with these values, and those of --set
    #[arg(long = "against-set", value_name = "NAME=VALUE", value_parser = name_and_value)]
    pub against_set: Vec<(String, String)>,
    /// Prove the motion and its largest and smallest values by interval arithmetic; the report tells which numbers are proved
    #[arg(long)]
    pub certify: bool,
    /// Go on from what a run that was ended left in the folder, or say that nothing there fits; without it that is gone on from, too, and what
    /// does not fit is computed anew
    #[arg(long, requires = "out")]
    pub resume: bool,
    /// Of sweeps compute only the parts that are one machine's of several, as in --shard 2/4, and leave them in the folder for
    /// kempe merge
    #[arg(long, value_name = "K/N", value_parser = Shard::parse, requires = "out",
          conflicts_with_all = ["against", "against_set", "certify", "date", "strict"])]
    pub shard: Option<Shard>,
    /// Tell in the report when it was written; without it, the same run gives the same bytes
    #[arg(long)]
    pub date: bool,
    /// Print one JSON object instead of text
    #[arg(long)]
    pub json: bool,
    /// Print nothing but errors (and JSON, if asked for)
    #[arg(long, short)]
    pub quiet: bool,
}

/// `kempe merge`
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  kempe run crane.toml tie-rods --out shard-1 --shard 1/2\n  kempe run crane.toml tie-rods --out shard-2 --shard 2/2\n  \
                        kempe merge crane.toml tie-rods shard-1 shard-2 --out results\n\n\
                        Writes the very files that kempe run crane.toml tie-rods --out results would. All parts must\n\
                        be there, of the same model file with the same parameters set, by the same version; they stay."
)]
pub struct Merge {
    #[command(flatten)]
    pub model: ModelFile,
    /// The sweep
    #[arg(value_name = "STUDY")]
    pub study: String,
    /// Folders to which its shards were written
    #[arg(value_name = "PARTS", required = true)]
    pub parts: Vec<PathBuf>,
    /// Folder for the results
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Tell in the report when it was written
    #[arg(long)]
    pub date: bool,
    /// Print one JSON object instead of text
    #[arg(long)]
    pub json: bool,
    /// Print nothing but errors (and JSON, if asked for)
    #[arg(long, short)]
    pub quiet: bool,
}

/// `kempe draw`
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  kempe draw crank.toml -o crank.svg\n  kempe draw crank.toml --at motor=30deg -o pose.dxf\n  \
                        kempe draw crank.toml -o crank.gif --width 800\n  kempe draw crank.toml -o sizes.svg --dimensions\n\n\
                        GIF and APNG move through the first study of the file. SVG, PNG and DXF show one pose.\n\
                        Only a picture that Kempe wrote and nobody changed is replaced; .kempe-files.json beside it\n\
                        lists those."
)]
pub struct Draw {
    #[command(flatten)]
    pub model: ModelFile,
    /// Where the drives stand, as in --at motor=30deg, once for each; or when, as in --at time=2s
    #[arg(long, value_name = "DRIVE=VALUE")]
    pub at: Vec<String>,
    /// Picture to write: .svg, .png, .dxf, .gif or .apng
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,
    /// Width of PNG, GIF and APNG in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(64..=8000))]
    pub width: u32,
    /// Light drawing on a dark ground
    #[arg(long)]
    pub dark: bool,
    /// Show what acts on the links: joint reactions, loads, weights, drives, springs
    #[arg(long)]
    pub forces: bool,
    /// Write sizes into the picture: lengths of links, places of fixed points, guides, radii
    #[arg(long)]
    pub dimensions: bool,
    /// Leave out the names of the points
    #[arg(long)]
    pub no_labels: bool,
}

/// `kempe new`
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  kempe new\n  kempe new six-bar\n  kempe new press.toml --kind slider-crank\n\n\
                  Without a name it lists the kinds. An existing file is never overwritten."
)]
pub struct New {
    /// What to start from, one of the kinds, or a file to write that ends in .toml
    #[arg(value_name = "NAME")]
    pub name: Option<PathBuf>,
    /// What to start from, whatever the file's name
    #[arg(long, value_parser = Kinds)]
    pub kind: Option<String>,
}

/// The kinds of starter files, for help and completion. An unknown one is told by the verb, with all kinds.
#[derive(Clone)]
struct Kinds;

impl TypedValueParser for Kinds {
    type Value = String;

    fn parse_ref(
        &self,
        command: &clap::Command,
        argument: Option<&clap::Arg>,
        value: &OsStr,
    ) -> Result<String, clap::Error> {
        StringValueParser::new().parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        let kinds = kempe_model::STARTERS.iter();
        Some(Box::new(
            kinds.map(|s| PossibleValue::new(s.name).help(s.doc)),
        ))
    }
}

/// `kempe measures`
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  kempe measures\n  kempe measures angle\n  kempe measures --json"
)]
pub struct Measures {
    /// Only this measure
    #[arg(value_name = "NAME")]
    pub name: Option<String>,
    /// Print a JSON array instead of text
    #[arg(long)]
    pub json: bool,
}

/// `kempe verify`
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  kempe verify\n  kempe verify validation/door-lock.toml\n  kempe verify --all\n\n\
                        Without a path the cases that came with this program are run. Exit code 1 on a miss."
)]
pub struct Verify {
    /// Case files, or folders of them
    #[arg(value_name = "PATH")]
    pub paths: Vec<PathBuf>,
    /// Read tables from anywhere, not only beside and below the files that name them
    #[arg(long)]
    pub allow_outside: bool,
    /// Print every comparison, not only one line a case and the misses
    #[arg(long)]
    pub all: bool,
    /// Print one JSON object instead of text
    #[arg(long)]
    pub json: bool,
}

/// `kempe completions`
#[derive(Debug, Args)]
#[command(
    after_help = "Example:\n  kempe completions bash > ~/.local/share/bash-completion/completions/kempe"
)]
pub struct Completions {
    /// Shell
    #[arg(value_name = "SHELL")]
    pub shell: clap_complete::Shell,
}
