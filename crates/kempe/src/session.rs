//! A session: one design of a compiled mechanism, and what is known of it so far.

use std::sync::Arc;

use kempe_mechanism::Design;
use kempe_model::{Diagnostic, ParameterId};
use kempe_motion::Motion;
use kempe_study::{Progress, cannot_move};
use kempe_units::{Dimension, Issue, Resolver, Span, check, parse};

use crate::asked::Asked;
use crate::{Compiled, Error};

/// One design of a mechanism, to be asked anything: parameters are set without reading the file again, and what was found for
/// a design (its motion) is kept until a parameter changes.
///
/// It owns what it needs. A clone goes its own way from there, on another thread if need be.
#[derive(Clone, Debug)]
pub struct Session {
    pub(crate) compiled: Compiled,
    /// Parameters that were set, in the model's order.
    pub(crate) given: Vec<Option<f64>>,
    pub(crate) design: Design<f64>,
    /// The motion by the file's laws.
    pub(crate) motion: Option<Arc<Motion>>,
    /// That of an earlier design, from which the next is found sooner.
    earlier: Option<Arc<Motion>>,
    /// By drive: the motion of that drive alone, the others where their laws start.
    pub(crate) alone: Vec<Option<Arc<Motion>>>,
    pub(crate) threads: usize,
}

impl Session {
    pub(crate) fn new(compiled: Compiled) -> Self {
        let design = compiled.design(&[]);
        Self {
            given: vec![None; compiled.data().parameters.len()],
            motion: None,
            earlier: None,
            alone: vec![None; compiled.data().drives.len()],
            threads: threads(),
            design,
            compiled,
        }
    }

    /// The compiled mechanism.
    pub fn compiled(&self) -> &Compiled {
        &self.compiled
    }

    /// Sets a parameter, in SI. Parameters that depend on it follow; one that itself depends on others no longer does, until it
    /// is [reset](Self::reset).
    ///
    /// # Errors
    ///
    /// `unknown-name`, `not-finite`; `bad-size` and `triangle-open` where a dimension of the file would make no sense;
    /// `settled-parameter` for one whose value the reader put into numbers. The session is then as it was.
    ///
    /// # Example
    ///
    /// ```
    /// # fn main() -> Result<(), kempe::Error> {
    /// let lever: kempe::Model = r#"
    ///     [parameters]
    ///     a = "20 mm"
    ///     b = "2 * a"
    ///     [links]
    ///     frame = { A = [0, 0] }
    ///     lever = { A-B = "a", P = ["b", 0] }
    ///     [drives]
    ///     hand = { turns = "lever", from = 0, to = 90, speed = "1 rad/s" }
    /// "#.parse()?;
    /// let mut s = lever.compile()?.session();
    /// s.set("a", 0.03)?;
    /// assert_eq!(s.value("b")?, 0.06);
    /// s.set("b", 0.05)?; // from now on it does not follow
    /// s.set("a", 0.01)?;
    /// assert_eq!(s.value("b")?, 0.05);
    /// assert_eq!(s.set("c", 1.0).unwrap_err().code(), "unknown-name");
    /// assert_eq!(s.set("a", -1.0).unwrap_err().code(), "bad-size");
    /// assert_eq!(s.value("a")?, 0.01);
    /// # Ok(())
    /// # }
    /// ```
    pub fn set(&mut self, parameter: &str, value: f64) -> Result<(), Error> {
        self.set_all([(parameter, value)])
    }

    /// Sets several parameters at once, in SI: what lies between them need make no sense.
    ///
    /// # Errors
    ///
    /// As [`set`](Self::set), and `duplicate-name` where one is named twice.
    ///
    /// # Example
    ///
    /// ```
    /// # fn main() -> Result<(), kempe::Error> {
    /// # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds/tractor-hitch.toml");
    /// let mut s = kempe::Model::from_path(path)?.compile()?.session();
    /// s.set_all([("weight", 12_000.0), ("pace", 0.03)])?;
    /// assert_eq!(s.value("pace")?, 0.03);
    /// # Ok(())
    /// # }
    /// ```
    pub fn set_all<'n>(
        &mut self,
        values: impl IntoIterator<Item = (&'n str, f64)>,
    ) -> Result<(), Error> {
        let mut given = self.given.clone();
        let (names, values): (Vec<&str>, Vec<f64>) = values.into_iter().unzip();
        let ids = self.to_set(&names)?;
        for ((name, id), value) in names.iter().zip(ids).zip(values) {
            if !value.is_finite() {
                let diagnostic =
                    Diagnostic::error("not-finite", format!("parameter `{name}` is {value}"));
                return Err(self
                    .compiled
                    .error(diagnostic.help("give it a finite value, in SI")));
            }
            given[id.index()] = Some(value);
        }
        self.take(given)
    }

    /// Sets a parameter as a person writes it, such as `"480 mm"` or `"2 * strut"` (by the parameters' values of now). As in
    /// the file a bare number is a plain number.
    ///
    /// # Errors
    ///
    /// Those of [`set`](Self::set), `unit-mismatch` and whatever is wrong with the text, labelled in it.
    ///
    /// # Example
    ///
    /// ```
    /// # fn main() -> Result<(), kempe::Error> {
    /// # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds/tractor-hitch.toml");
    /// let mut s = kempe::Model::from_path(path)?.compile()?.session();
    /// s.set_text("pace", "2 cm/s")?;
    /// assert_eq!(s.value("pace")?, 0.02);
    /// assert_eq!(s.set_text("pace", "2 cm").unwrap_err().code(), "unit-mismatch");
    /// # Ok(())
    /// # }
    /// ```
    pub fn set_text(&mut self, parameter: &str, text: &str) -> Result<(), Error> {
        let id = self.compiled.parameter(parameter)?;
        let wanted = self.compiled.data().parameters[id.index()].dimension;
        let diagnostic = |issue: Issue| Diagnostic::of_issue(issue, parameter, text);
        let (expr, found) = parse(text)
            .and_then(|tree| check(&tree, &mut Parameters(&self.compiled)))
            .map_err(|issues| {
                self.compiled
                    .errors(issues.into_iter().map(diagnostic).collect())
            })?;
        if !found.compatible(wanted) {
            let message = format!("{wanted} expected, found {}", found.with_article());
            let unit = self.compiled.units().unit(wanted);
            let issue = Issue::new("unit-mismatch", 0..text.len(), message)
                .with_label(format!("this is {}", found.with_article()))
                .with_help(match unit.text() {
                    "" => "give a plain number".to_owned(),
                    unit => format!("give it a unit, such as {unit}"),
                });
            return Err(self.compiled.error(diagnostic(issue)));
        }
        self.set(
            parameter,
            kempe_model::value(&expr, &self.design.parameters),
        )
    }

    /// Gives a parameter back the value, or the expression, that it has in the file.
    ///
    /// # Errors
    ///
    /// As [`set`](Self::set).
    ///
    /// # Example
    ///
    /// ```
    /// # fn main() -> Result<(), kempe::Error> {
    /// # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds/tractor-hitch.toml");
    /// let mut s = kempe::Model::from_path(path)?.compile()?.session();
    /// s.set("weight", 12_000.0)?;
    /// s.reset("weight")?;
    /// assert_eq!(s.value("weight")?, 9810.0);
    /// # Ok(())
    /// # }
    /// ```
    pub fn reset(&mut self, parameter: &str) -> Result<(), Error> {
        let id = self.compiled.parameter(parameter)?;
        let mut given = self.given.clone();
        given[id.index()] = None;
        self.take(given)
    }

    /// The value of a parameter, SI.
    ///
    /// # Errors
    ///
    /// `unknown-name`.
    ///
    /// # Example
    ///
    /// ```
    /// # fn main() -> Result<(), kempe::Error> {
    /// # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds/tractor-hitch.toml");
    /// let s = kempe::Model::from_path(path)?.compile()?.session();
    /// assert_eq!(s.value("pace")?, 0.02);
    /// let error = s.value("wieght").unwrap_err();
    /// assert!(error.to_string().contains("did you mean `weight`?"));
    /// # Ok(())
    /// # }
    /// ```
    pub fn value(&self, parameter: &str) -> Result<f64, Error> {
        let id = self.compiled.parameter(parameter)?;
        Ok(self.design.parameters[id.index()])
    }

    /// Values of all parameters, SI, in the order of [`Compiled::parameters`].
    pub fn values(&self) -> &[f64] {
        &self.design.parameters
    }

    /// How many threads [`many`](Self::many) may use; as many as the machine has unless set. Results do not depend on it.
    pub fn use_threads(&mut self, threads: usize) {
        self.threads = threads.max(1);
    }

    /// Parameters that are set together: each once, and all may be set.
    pub(crate) fn to_set<N: AsRef<str>>(&self, names: &[N]) -> Result<Vec<ParameterId>, Error> {
        let mut ids = Vec::with_capacity(names.len());
        for name in names.iter().map(AsRef::as_ref) {
            let id = self.compiled.parameter(name)?;
            self.may_be_set(id)?;
            if ids.contains(&id) {
                let message = format!("parameter `{name}` is set twice");
                let diagnostic = Diagnostic::error("duplicate-name", message);
                return Err(self.compiled.error(diagnostic.help("name each once")));
            }
            ids.push(id);
        }
        Ok(ids)
    }

    /// Whether a parameter may be set without reading the file again.
    pub(crate) fn may_be_set(&self, id: ParameterId) -> Result<(), Error> {
        let model = self.compiled.data();
        let name = |id: ParameterId| model.parameters.get(id.index()).map_or("", |p| &p.name);
        let Some(settled) = model.settled_by(id) else {
            return Ok(());
        };
        let diagnostic = Diagnostic::error(
            "settled-parameter",
            format!(
                "`{}` cannot be set in a session: the period of a table is made of `{}`",
                name(id),
                name(settled)
            ),
        );
        let span = model.parameters[settled.index()].span.clone();
        Err(self.compiled.error(diagnostic.at(span, "taken for a number when the file was read").help(
            "read the model with another value: Model::with(parameter, value), and compile that",
        )))
    }

    /// Takes other values, if they make sense.
    fn take(&mut self, given: Vec<Option<f64>>) -> Result<(), Error> {
        let design = self.compiled.design(&given);
        let model = &design.mechanism.model;
        let mut diagnostics: Vec<Diagnostic> = (model.parameters.iter().zip(&design.parameters))
            .filter(|(_, value)| !value.is_finite())
            .map(|(p, value)| {
                Diagnostic::error("not-finite", format!("parameter `{}` is {value}", p.name))
                    .at(p.span.clone(), "with the parameters as they are set")
                    .help(
                        "look for a division by zero, the root of a negative number or an overflow",
                    )
            })
            .collect();
        diagnostics.extend(model.unsound(&design.parameters));
        if !diagnostics.is_empty() {
            return Err(self.compiled.errors(diagnostics));
        }
        self.given = given;
        self.design = design;
        self.earlier = self.motion.take().or(self.earlier.take());
        self.alone.fill(None);
        Ok(())
    }

    /// The motion by the file's laws.
    pub(crate) fn known_motion(
        &mut self,
        progress: &mut dyn Progress,
    ) -> Result<Arc<Motion>, Error> {
        if let Some(motion) = &self.motion {
            return Ok(motion.clone());
        }
        let motion = match &self.earlier {
            Some(earlier) => earlier.again(&self.design, progress),
            None => Motion::with_progress(&self.design, progress),
        }
        .map_err(|error| self.compiled.error(cannot_move(&self.design, &error)))?;
        self.motion = Some(motion.clone());
        Ok(motion)
    }

    /// Reads measures of this design.
    pub(crate) fn quantities<M: AsRef<str>>(
        &self,
        measures: impl IntoIterator<Item = M>,
    ) -> Result<Asked, Error> {
        Asked::of(&self.compiled, &self.design.mechanism.model, measures)
    }
}

impl Compiled {
    /// A session: parameters as the file gives them, nothing known yet.
    pub fn session(&self) -> Session {
        Session::new(self.clone())
    }
}

/// Parameters by their names.
struct Parameters<'a>(&'a Compiled);

impl Resolver<ParameterId> for Parameters<'_> {
    fn name(&mut self, name: &str, span: Span) -> Result<(ParameterId, Dimension), Issue> {
        let model = self.0.data();
        let index = model.parameters.iter().position(|p| p.name == name);
        match index {
            Some(index) => Ok((ParameterId(index as u32), model.parameters[index].dimension)),
            None => Err(Issue::unknown_name(name, span, self.0.parameters())),
        }
    }
}

#[cfg(not(target_family = "wasm"))]
fn threads() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
}

#[cfg(target_family = "wasm")]
fn threads() -> usize {
    1
}
