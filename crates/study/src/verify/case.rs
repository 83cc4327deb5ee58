//! Reading validation cases.

use kempe_model::partial_table;
use kempe_units::Unit;
use toml::Value;

use super::quantity::Reference;

/// Relative difference that passes besides what the reference's last digit leaves open.
const TOLERANCE: f64 = 1e-12;

/// Why a case cannot be run, in a sentence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CaseError(pub String);

impl std::fmt::Display for CaseError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for CaseError {}

/// A validation case.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Title.
    pub title: String,
    /// The model file, from the case's folder.
    pub model: String,
    /// Parameters set from outside.
    pub set: Vec<(String, String)>,
    /// The simulation whose motion is meant, or another study whose columns and numbers are compared; the motion of the drives' laws
    /// without one.
    pub study: Option<String>,
    /// What is expected.
    pub expected: Vec<Expected>,
}

/// What is asked of the model.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// A measure, at a place such as `motor = 90 deg`, or over the motion.
    Measure {
        /// Where; anywhere when the measure is one number over the motion.
        at: Option<String>,
        /// The measure.
        measure: String,
    },
    /// The coordinate of the nearest event: `limit` or `change-point`.
    Event(String),
    /// A number of the check's report.
    Check(String),
}

/// A reference value with what it is a value of.
#[derive(Clone, Debug, PartialEq)]
pub struct Expected {
    /// What is asked.
    pub target: Target,
    /// The reference.
    pub reference: Reference,
    /// The difference that passes, in the reference's unit.
    pub allowed: f64,
    /// Where the reference comes from.
    pub source: String,
}

impl Case {
    /// Reads a case. `files` gives the text of tables in files of their own.
    ///
    /// # Errors
    ///
    /// What is wrong with it, in a sentence.
    pub fn parse(
        text: &str,
        files: &mut dyn FnMut(&str) -> Result<String, String>,
    ) -> Result<Self, CaseError> {
        let root: toml::Table = text
            .parse()
            .map_err(|e: toml::de::Error| CaseError(e.message().to_owned()))?;
        known(
            &root,
            &[
                "title",
                "model",
                "source",
                "tolerance",
                "set",
                "study",
                "table",
                "value",
            ],
            "a case",
        )?;
        let model =
            text_of(&root, "model")?.ok_or_else(|| CaseError("`model` is missing".into()))?;
        let source = text_of(&root, "source")?.unwrap_or_default();
        let tolerance = number_of(&root, "tolerance")?.unwrap_or(TOLERANCE);
        let mut case = Self {
            title: text_of(&root, "title")?.unwrap_or_else(|| model.clone()),
            model,
            set: Vec::new(),
            study: text_of(&root, "study")?,
            expected: Vec::new(),
        };
        for (name, value) in root
            .get("set")
            .and_then(Value::as_table)
            .into_iter()
            .flatten()
        {
            let text = value
                .as_str()
                .map_or_else(|| value.to_string(), str::to_owned);
            case.set.push((name.clone(), text));
        }
        for table in tables(&root, "table")? {
            known(
                table,
                &["file", "rows", "source", "tolerance"],
                "a [[table]]",
            )?;
            let rows = match (text_of(table, "file")?, text_of(table, "rows")?) {
                (Some(file), None) => {
                    files(&file).map_err(|e| CaseError(format!("{file}: {e}")))?
                }
                (None, Some(rows)) => rows,
                _ => return Err(CaseError("a [[table]] has either `file` or `rows`".into())),
            };
            if let Some(how_far) = partial_table(&rows) {
                let message = format!("its table is a partial result: {how_far}");
                return Err(CaseError(message));
            }
            let source = text_of(table, "source")?.unwrap_or_else(|| source.clone());
            let tolerance = number_of(table, "tolerance")?.unwrap_or(tolerance);
            case.add_rows(&rows, &source, tolerance)?;
        }
        for value in tables(&root, "value")? {
            known(
                value,
                &[
                    "at",
                    "measure",
                    "event",
                    "check",
                    "expect",
                    "source",
                    "tolerance",
                ],
                "a [[value]]",
            )?;
            let target = match (text_of(value, "measure")?, text_of(value, "event")?, text_of(value, "check")?) {
                (Some(measure), None, None) => Target::Measure {
                    at: text_of(value, "at")?,
                    measure,
                },
                (None, Some(event), None) if event == "limit" || event == "change-point" => Target::Event(event),
                (None, None, Some(field)) => Target::Check(field),
                _ => return Err(CaseError("a [[value]] has one of `measure`, `event` (\"limit\" or \"change-point\") and `check`".into())),
            };
            let expect = value
                .get("expect")
                .ok_or_else(|| CaseError("`expect` is missing".into()))?;
            let expect = expect
                .as_str()
                .map_or_else(|| expect.to_string(), str::to_owned);
            let reference = Reference::parse(&expect).map_err(CaseError)?;
            let relative =
                number_of(value, "tolerance")?.unwrap_or(tolerance) * reference.value.abs();
            case.expected.push(Expected {
                target,
                allowed: relative + reference.half_digit,
                reference,
                source: text_of(value, "source")?.unwrap_or_else(|| source.clone()),
            });
        }
        Ok(case)
    }

    /// Adds a table: the first column says where, the others are measures.
    fn add_rows(&mut self, text: &str, source: &str, tolerance: f64) -> Result<(), CaseError> {
        let mut lines = text
            .lines()
            .map(str::trim)
            .filter(|l| !l.is_empty() && !l.starts_with('#'));
        let heads: Vec<(String, Unit)> = fields(lines.next().unwrap_or(""))
            .iter()
            .map(|h| head(h))
            .collect::<Result<_, _>>()?;
        let Some((along, along_unit)) = heads.first().cloned() else {
            return Err(CaseError("a table needs a head".into()));
        };
        let mut cells: Vec<Vec<(String, Reference)>> = vec![Vec::new(); heads.len()];
        for line in lines {
            let fields = fields(line);
            let place = fields.first().map_or("", String::as_str);
            let at = format!("{along} = {place} {}", along_unit.text());
            for ((field, (_, unit)), cells) in fields.iter().zip(&heads).zip(&mut cells).skip(1) {
                if !field.is_empty() {
                    let reference = Reference::new(field, unit.clone()).map_err(CaseError)?;
                    cells.push((at.trim().to_owned(), reference));
                }
            }
        }
        for ((measure, _), cells) in heads.iter().zip(cells) {
            let largest = cells.iter().map(|(_, r)| r.value.abs()).fold(0.0, f64::max);
            for (at, reference) in cells {
                self.expected.push(Expected {
                    target: Target::Measure {
                        at: Some(at),
                        measure: measure.clone(),
                    },
                    allowed: tolerance * largest + reference.half_digit,
                    reference,
                    source: source.to_owned(),
                });
            }
        }
        Ok(())
    }
}

/// A head: `name [unit]`.
fn head(text: &str) -> Result<(String, Unit), CaseError> {
    let text = text.trim();
    let split = text.strip_suffix(']').and_then(|t| t.rsplit_once('['));
    let Some((name, unit)) = split else {
        return Ok((text.to_owned(), Unit::one()));
    };
    let unit = Unit::parse(unit.trim())
        .map_err(|_| CaseError(format!("`{unit}` is no unit, in the head `{text}`")))?;
    Ok((name.trim().to_owned(), unit))
}

/// The fields of a CSV line; quotes protect commas.
fn fields(line: &str) -> Vec<String> {
    let mut out = vec![String::new()];
    let mut quoted = false;
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            ',' if !quoted => out.push(String::new()),
            c => {
                if let Some(last) = out.last_mut() {
                    last.push(c);
                }
            }
        }
    }
    out.into_iter().map(|f| f.trim().to_owned()).collect()
}

fn known(table: &toml::Table, keys: &[&str], place: &str) -> Result<(), CaseError> {
    match table.keys().find(|k| !keys.contains(&k.as_str())) {
        Some(key) => Err(CaseError(format!(
            "{place} has no key `{key}`: it has {}",
            keys.join(", ")
        ))),
        None => Ok(()),
    }
}

fn text_of(table: &toml::Table, key: &str) -> Result<Option<String>, CaseError> {
    match table.get(key) {
        None => Ok(None),
        Some(Value::String(text)) => Ok(Some(text.clone())),
        Some(_) => Err(CaseError(format!("`{key}` is a text"))),
    }
}

fn number_of(table: &toml::Table, key: &str) -> Result<Option<f64>, CaseError> {
    match table.get(key) {
        None => Ok(None),
        Some(Value::Float(x)) if *x >= 0.0 => Ok(Some(*x)),
        Some(Value::Integer(x)) if *x >= 0 => Ok(Some(*x as f64)),
        Some(_) => Err(CaseError(format!("`{key}` is a number, not negative"))),
    }
}

fn tables<'t>(root: &'t toml::Table, key: &str) -> Result<Vec<&'t toml::Table>, CaseError> {
    match root.get(key) {
        None => Ok(Vec::new()),
        Some(Value::Array(list)) if list.iter().all(Value::is_table) => {
            Ok(list.iter().filter_map(Value::as_table).collect())
        }
        Some(_) => Err(CaseError(format!("write [[{key}]]"))),
    }
}
