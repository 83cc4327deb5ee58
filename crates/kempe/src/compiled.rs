//! A model compiled once: what sessions share.

use std::sync::Arc;

use kempe_mechanism::{Design, Mechanism};
use kempe_model::{Diagnostic, DriveId, LinkId, ParameterId, PointId};
use kempe_motion::Motion;
use kempe_study::{Units, cannot_move};
use kempe_units::{Expr, nearest};

use crate::Error;

/// A compiled mechanism: bodies, constraints and the plan by which it is solved. Owned and shared: a clone is a share, and any
/// thread may hold one. Questions are asked of a [`Session`](crate::Session).
///
/// ```
/// # fn main() -> Result<(), kempe::Error> {
/// # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds/tractor-hitch.toml");
/// let hitch = kempe::Model::from_path(path)?.compile()?;
/// assert_eq!(hitch.drives().collect::<Vec<_>>(), ["lift"]);
/// assert!(hitch.points().any(|p| p == "M") && hitch.links().any(|l| l == "strut"));
/// let share = hitch.clone();
/// std::thread::spawn(move || share.session().start().is_ok()).join().unwrap();
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Compiled {
    inner: Arc<Inner>,
}

#[derive(Debug)]
struct Inner {
    name: String,
    text: String,
    mechanism: Arc<Mechanism>,
    units: Units,
}

impl Compiled {
    /// Compiles a model. `name` and `text` are what diagnostics show.
    pub(crate) fn new(name: &str, text: &str, model: &kempe_model::Model) -> Result<Self, Error> {
        let it = Self {
            inner: Arc::new(Inner {
                name: name.to_owned(),
                text: text.to_owned(),
                mechanism: Mechanism::new(model),
                units: Units::of(model),
            }),
        };
        let design = it.design(&[]);
        match Motion::possible(&design) {
            Ok(()) => Ok(it),
            Err(error) => Err(it.error(cannot_move(&design, &error))),
        }
    }

    /// The model as plain data.
    pub fn data(&self) -> &kempe_model::Model {
        &self.inner.mechanism.model
    }

    /// The units of the file.
    pub fn units(&self) -> &Units {
        &self.inner.units
    }

    /// Names of the parameters, those before others that depend on them.
    pub fn parameters(&self) -> impl Iterator<Item = &str> {
        self.data().parameters.iter().map(|p| p.name.as_str())
    }

    /// Names of the drives.
    pub fn drives(&self) -> impl Iterator<Item = &str> {
        self.data().drives.iter().map(|d| d.name.as_str())
    }

    /// Names of the points.
    pub fn points(&self) -> impl Iterator<Item = &str> {
        self.data().points.iter().map(|p| p.name.as_str())
    }

    /// Names of the links, the frame first.
    pub fn links(&self) -> impl Iterator<Item = &str> {
        self.data().links.iter().map(|l| l.name.as_str())
    }

    /// Names of the file's own measures. A session takes any other that the language knows as well.
    pub fn measures(&self) -> impl Iterator<Item = &str> {
        self.data().measures.iter().map(|m| m.name.as_str())
    }

    /// Whether both are shares of one compiled mechanism.
    pub fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.inner, &other.inner)
    }

    /// The design with some parameters given (by index, `None` for the file's own).
    pub(crate) fn design(&self, given: &[Option<f64>]) -> Design<f64> {
        let mechanism = match given.iter().any(Option::is_some) {
            false => self.inner.mechanism.clone(),
            true => {
                let mut own = (*self.inner.mechanism).clone();
                let parameters = own.structure.model.parameters.iter_mut();
                for (parameter, given) in parameters.zip(given) {
                    if let Some(value) = given {
                        parameter.value = Expr::Const(*value);
                    }
                }
                Arc::new(own)
            }
        };
        let values: Vec<f64> = mechanism.model.parameter_values();
        Design::new(&mechanism, &values)
    }

    pub(crate) fn parameter(&self, name: &str) -> Result<ParameterId, Error> {
        let index = self.find("parameter", name, self.parameters())?;
        Ok(ParameterId(index as u32))
    }

    pub(crate) fn drive(&self, name: &str) -> Result<DriveId, Error> {
        let index = self.find("drive", name, self.drives())?;
        Ok(DriveId(index as u32))
    }

    pub(crate) fn point(&self, name: &str) -> Result<PointId, Error> {
        let index = self.find("point", name, self.points())?;
        Ok(PointId(index as u32))
    }

    pub(crate) fn link(&self, name: &str) -> Result<LinkId, Error> {
        let index = self.find("link", name, self.links())?;
        Ok(LinkId(index as u32))
    }

    fn find<'n>(
        &self,
        kind: &str,
        name: &str,
        known: impl Iterator<Item = &'n str>,
    ) -> Result<usize, Error> {
        let known: Vec<&str> = known.collect();
        if let Some(index) = known.iter().position(|k| *k == name) {
            return Ok(index);
        }
        let help = match nearest(name, known.iter().copied()) {
            Some(near) => format!("did you mean `{near}`?"),
            None if known.is_empty() => format!("the file has no {kind}s"),
            None => format!("the {kind}s are {}", known.join(", ")),
        };
        let diagnostic = Diagnostic::error("unknown-name", format!("there is no {kind} `{name}`"));
        Err(self.error(diagnostic.help(help)))
    }

    pub(crate) fn error(&self, diagnostic: Diagnostic) -> Error {
        self.errors(vec![diagnostic])
    }

    pub(crate) fn errors(&self, diagnostics: Vec<Diagnostic>) -> Error {
        Error {
            name: self.inner.name.clone(),
            text: self.inner.text.clone(),
            diagnostics,
        }
    }
}
