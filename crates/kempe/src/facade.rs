//! A model with the text it came from, and the questions most people ask.

use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use kempe_mechanism::Mechanism;
use kempe_model::{Diagnostic, ModelFile, Tables};
use kempe_motion::temporary_drives::hold;
use kempe_study::{CheckReport, Progress, Setting, Silent, StudyResult};

use crate::{Compiled, Error, Pose};

/// A mechanism read from a model file, checked and ready to run.
#[derive(Clone, Debug)]
pub struct Model {
    name: String,
    text: String,
    tables: Beside,
    set: Vec<(String, String)>,
    inner: kempe_model::Model,
    warnings: Vec<Diagnostic>,
}

/// Where the tables are that a model names.
#[derive(Clone, Debug)]
enum Beside {
    /// In the folder of its file.
    Folder(PathBuf),
    /// In memory.
    Memory(Tables),
    /// Nowhere: of a text alone.
    Nothing,
}

impl Model {
    /// Reads a model file. Tables that it names are read from its folder.
    ///
    /// # Errors
    ///
    /// `no-file` when it cannot be read; everything that is wrong with it.
    ///
    /// # Example
    ///
    /// ```
    /// # fn main() -> Result<(), kempe::Error> {
    /// # let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds");
    /// # std::env::set_current_dir(folder).unwrap();
    /// let hitch = kempe::Model::from_path("tractor-hitch.toml")?;
    /// let lifting = hitch.run("lifting")?;
    /// // Rise of the hitch axis, from the closed form of the eight-bar.
    /// let rise = lifting.scalars.iter().find(|s| s.name == "rise").unwrap();
    /// assert!((rise.value - 0.480_653_495).abs() < 1e-9);
    /// # Ok(())
    /// # }
    /// ```
    pub fn from_path(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let name = path.display().to_string();
        let bytes = read_bounded(path, kempe_model::MAX_FILE_BYTES).map_err(|error| Error {
            diagnostics: vec![Diagnostic::error(
                "no-file",
                format!("{name} cannot be read: {error}"),
            )],
            name: name.clone(),
            text: String::new(),
        })?;
        let tables = path
            .parent()
            .map_or(Beside::Nothing, |folder| Beside::Folder(folder.to_owned()));
        Self::read(&bytes, name, tables, Vec::new())
    }

    /// Reads a model that is in memory with the tables that it names: one that was built in Rust, that a study found, or whose tables a program measured.
    ///
    /// # Errors
    ///
    /// Everything that is wrong with it.
    ///
    /// # Example
    ///
    /// ```
    /// use kempe::model::build::{Entry, ModelBuilder, belt, link, turns};
    /// # fn main() -> Result<(), kempe::Error> {
    /// let built = ModelBuilder::new("two pulleys, the first moved as it was measured")
    ///     .units("mm", "deg")
    ///     .link("frame", link().point("A", [0, 0]).point("B", [90, 0]))
    ///     .link("small", link().distance("A", "P", 10))
    ///     .link("large", link().distance("B", "Q", 30))
    ///     .joint("run", belt("small", "large", [10, 30]))
    ///     .drive("motor", turns("small").measured("measured"))
    ///     .table("measured", &[("t [s]", &[0.0, 1.0, 2.0]), ("value [deg]", &[0.0, 60.0, 90.0])]);
    /// let mut s = kempe::Model::from_file(&built.file())?.compile()?.session();
    /// let turned = s.sweep("time", [0.0, 2.0], &["angle(large)"])?;
    /// assert!((turned.columns[0].in_unit()[1] - 30.0).abs() < 1e-9);
    ///
    /// // The same of a text, and tables as CSV.
    /// let mut tables = kempe::model::Tables::new();
    /// tables.insert("measured", "t [s],value [deg]\n0,0\n2,90\n");
    /// let file = kempe::model::ModelFile::new(built.file().toml, tables);
    /// assert!(kempe::Model::from_file(&file)?.check().mobility_rank == Some(1));
    /// # Ok(())
    /// # }
    /// ```
    pub fn from_file(file: &ModelFile) -> Result<Self, Error> {
        let tables = Beside::Memory(file.tables.clone());
        Self::read(file.toml.as_bytes(), "model".to_owned(), tables, Vec::new())
    }

    fn read(
        bytes: &[u8],
        name: String,
        tables: Beside,
        set: Vec<(String, String)>,
    ) -> Result<Self, Error> {
        let text = String::from_utf8_lossy(bytes).into_owned();
        let title = Path::new(&name)
            .file_stem()
            .map_or(name.clone(), |s| s.to_string_lossy().into_owned());
        let mut files = |wanted: &str| match &tables {
            Beside::Folder(folder) => {
                let table = folder.join(wanted);
                let bytes = read_bounded(&table, kempe_model::MAX_TABLE_BYTES);
                let bytes = bytes.map_err(|e| e.to_string())?;
                String::from_utf8(bytes).map_err(|_| "it is not UTF-8 text".to_owned())
            }
            Beside::Memory(tables) => tables.files()(wanted),
            Beside::Nothing => Err("a text alone has no tables: hand them over with it".to_owned()),
        };
        match kempe_model::Model::from_bytes(bytes, &title, &mut files, &set) {
            Ok(checked) => Ok(Self {
                name,
                text,
                tables,
                set,
                inner: checked.model,
                warnings: checked.warnings,
            }),
            Err(diagnostics) => Err(Error {
                name,
                text,
                diagnostics,
            }),
        }
    }

    /// The model with a parameter set to another value, such as `"25 mm"`.
    ///
    /// # Errors
    ///
    /// `unknown-name` when there is no such parameter, and what is wrong with the value.
    pub fn with(&self, parameter: &str, value: &str) -> Result<Self, Error> {
        let mut set = self.set.clone();
        set.push((parameter.to_owned(), value.to_owned()));
        Self::read(
            self.text.as_bytes(),
            self.name.clone(),
            self.tables.clone(),
            set,
        )
    }

    /// What a careful engineer would want to be told about the file.
    pub fn warnings(&self) -> &[Diagnostic] {
        &self.warnings
    }

    /// The model as plain data.
    pub fn data(&self) -> &kempe_model::Model {
        &self.inner
    }

    /// The names of its studies.
    pub fn studies(&self) -> impl Iterator<Item = &str> {
        self.inner.studies.iter().map(|s| s.name.as_str())
    }

    /// Mobility two ways, Assur groups, Grashof types, assemblies, reach.
    ///
    /// # Example
    ///
    /// ```
    /// # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/gallery/three-crank.toml");
    /// let check = kempe::Model::from_path(path).unwrap().check();
    /// // Three parallel cranks: overconstrained, yet they turn.
    /// assert_eq!((check.mobility_count, check.mobility_rank), (0, Some(1)));
    /// ```
    pub fn check(&self) -> CheckReport {
        kempe_study::check(&self.inner)
    }

    /// Compiles the model: what sessions ask, shared and owned.
    ///
    /// # Errors
    ///
    /// `no-drive`, `undetermined` and `scale`: why it cannot move at all.
    ///
    /// # Example
    ///
    /// ```
    /// # fn main() -> Result<(), kempe::Error> {
    /// # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds/tractor-hitch.toml");
    /// let hitch = kempe::Model::from_path(path)?.compile()?;
    /// let mut s = hitch.session();
    /// assert!(s.start()?.closure() < 1e-12);
    /// # Ok(())
    /// # }
    /// ```
    pub fn compile(&self) -> Result<Compiled, Error> {
        Compiled::new(&self.name, &self.text, &self.inner)
    }

    /// Runs the first study of the file; a file without studies moves its drives through their laws.
    ///
    /// # Errors
    ///
    /// Why it cannot start: `no-drive`, `cannot-assemble`, `range-beyond-limit`, …
    pub fn run_first(&self) -> Result<StudyResult, Error> {
        match self.inner.studies.first() {
            Some(study) => self.run(&study.name),
            None => Err(self.error(vec![Diagnostic::error(
                "no-drive",
                "nothing moves the mechanism",
            )])),
        }
    }

    /// Runs a study.
    ///
    /// # Errors
    ///
    /// `unknown-study`, and why it cannot start.
    pub fn run(&self, study: &str) -> Result<StudyResult, Error> {
        self.run_with(study, &mut Silent)
    }

    /// Runs a study that tells how far it has come, and that may be stopped.
    ///
    /// # Errors
    ///
    /// See [`run`](Self::run).
    pub fn run_with(&self, study: &str, progress: &mut dyn Progress) -> Result<StudyResult, Error> {
        let Some(found) = self.inner.studies.iter().find(|s| s.name == study) else {
            let known: Vec<&str> = self.studies().collect();
            let diagnostic =
                Diagnostic::error("unknown-study", format!("there is no study `{study}`"));
            return Err(self.error(vec![
                diagnostic.help(format!("the file has: {}", known.join(", "))),
            ]));
        };
        kempe_study::run(&self.inner, found, progress).map_err(|found| self.error(found))
    }

    /// The pose where drives stand as in `"motor = 30 deg"` (several between commas), or at a time as in `"time = 2 s"`; drives
    /// that are not named at their start. What too few drives leave free is held somewhere.
    ///
    /// # Errors
    ///
    /// `unknown-name`, and why the place cannot be reached.
    pub fn pose(&self, place: &str) -> Result<Pose, Error> {
        let parts = place.split(',').filter(|part| !part.trim().is_empty());
        let settings =
            Setting::all(&self.inner, parts).map_err(|diagnostic| self.error(vec![diagnostic]))?;
        let compiled = match self.compile() {
            Err(error) if ["no-drive", "undetermined"].contains(&error.code()) => {
                let design = Mechanism::new(&self.inner);
                let values: Vec<f64> = self.inner.parameter_values();
                match hold(&design, &values, &mut Silent) {
                    Some(held) => Compiled::new(&self.name, &self.text, &held.model)?,
                    None => return Err(error),
                }
            }
            compiled => compiled?,
        };
        let places = settings.iter().map(|s| (s.name.as_str(), s.value));
        compiled.session().pose(places)
    }

    fn error(&self, diagnostics: Vec<Diagnostic>) -> Error {
        Error {
            name: self.name.clone(),
            text: self.text.clone(),
            diagnostics,
        }
    }
}

/// The bytes of a plain file that has no more than `limit`: a pipe may never say anything, and a device has no end.
fn read_bounded(path: &Path, limit: usize) -> std::io::Result<Vec<u8>> {
    if !std::fs::metadata(path)?.is_file() {
        return Err(std::io::Error::other("it is not a plain file"));
    }
    let mut bytes = Vec::new();
    std::fs::File::open(path)?
        .take(limit as u64 + 1)
        .read_to_end(&mut bytes)?;
    if bytes.len() > limit {
        let message = format!("it has more than {} MiB", limit >> 20);
        return Err(std::io::Error::other(message));
    }
    Ok(bytes)
}

/// Reads a model from its text.
impl FromStr for Model {
    type Err = Error;
    fn from_str(text: &str) -> Result<Self, Error> {
        let name = "model".to_owned();
        Self::read(text.as_bytes(), name, Beside::Nothing, Vec::new())
    }
}
