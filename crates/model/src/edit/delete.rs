//! Deleting a part, alone or with all that refers to it.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use crate::diagnostic::Diagnostic;
use crate::edit::removal::{removals, within};
use crate::edit::rename::unknown;
use crate::outline::Outline;
use crate::part::{Naming, Namings, Part, PartKind, is_drawn_place, place_of};
use crate::text_edit::TextEdit;

/// Why a part is not deleted.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum DeleteError {
    /// The text has no such part.
    Unknown(Diagnostic),
    /// Others refer to it, here.
    InUse(Vec<Naming>),
    /// Every mechanism has it.
    Needed(Diagnostic),
}

impl fmt::Display for DeleteError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown(d) | Self::Needed(d) => f.write_str(&d.message),
            Self::InUse(by) => {
                let mut paths: Vec<String> = by.iter().map(|n| n.path.join(".")).collect();
                paths.dedup();
                write!(f, "it is used by {}", paths.join(", "))
            }
        }
    }
}

impl std::error::Error for DeleteError {}

/// What is deleted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Deletion {
    /// The edits of the text.
    pub edits: Vec<TextEdit>,
    /// The paths of the entries, keys and elements that go.
    pub paths: Vec<Vec<String>>,
    /// The parts that go.
    pub parts: Vec<Part>,
}

/// The edits that delete a part to which nothing else refers. A point goes with its place and the keys of links that name it.
///
/// # Errors
///
/// [`DeleteError::InUse`] with every place that refers to the part, or to a point that only the deleted link has;
/// [`DeleteError::Needed`] when it is the link `frame`; [`DeleteError::Unknown`] when there is no such part.
///
/// # Example
///
/// ```
/// use kempe_model::{DeleteError, Part, PartKind, apply, delete};
/// let text = "[parameters]\na = 1\nb = 2\n[links]\nframe = { A = [\"a\", 0] }\n";
/// let used = delete(text, &Part::new(PartKind::Parameter, "a")).unwrap_err();
/// assert_eq!(used.to_string(), "it is used by links.frame.A.0");
/// let edits = delete(text, &Part::new(PartKind::Parameter, "b")).unwrap();
/// assert_eq!(apply(text, &edits).unwrap(), text.replace("b = 2\n", ""));
/// ```
pub fn delete(text: &str, part: &Part) -> Result<Vec<TextEdit>, DeleteError> {
    let outline = Outline::new(text);
    let namings = Namings::new(text, &outline);
    let mut going = Going::new(&outline, &namings);
    going.part(part).map_err(DeleteError::Unknown)?;
    let users = going.users();
    if !users.is_empty() {
        return Err(DeleteError::InUse(users));
    }
    if *part == Part::new(PartKind::Link, "frame") {
        let message = "the link `frame` stands still, and a file of links has one";
        let needed = Diagnostic::error("no-frame", message).help("change its points instead");
        return Err(DeleteError::Needed(needed));
    }
    Ok(going.deletion(text).edits)
}

/// The edits that delete a part and all that refers to it, directly or through others: entries whole, but of a link only the
/// keys, and of a study only the columns and plots, that name what goes.
///
/// What is left need not be a sound model: a link may have lost what places one of its points. The reader tells.
///
/// # Errors
///
/// `unknown-name` when there is no such part.
///
/// # Example
///
/// ```
/// use kempe_model::{Part, PartKind, apply, delete_with_dependants};
/// let text = "[parameters]\na = 1\n[measures]\nm = \"2 * a\"\nn = \"time\"\n[studies.s]\nkind = \"motion\"\ncolumns = [\"m\", \"n\"]\n";
/// let gone = delete_with_dependants(text, &Part::new(PartKind::Parameter, "a")).unwrap();
/// assert_eq!(
///     apply(text, &gone.edits).unwrap(),
///     "[parameters]\n[measures]\nn = \"time\"\n[studies.s]\nkind = \"motion\"\ncolumns = [\"n\"]\n",
/// );
/// ```
pub fn delete_with_dependants(text: &str, part: &Part) -> Result<Deletion, Diagnostic> {
    let outline = Outline::new(text);
    let namings = Namings::new(text, &outline);
    let mut going = Going::new(&outline, &namings);
    going.part(part)?;
    while let Some(part) = going.waiting.pop() {
        for i in going.places(&part) {
            if let Some(user) = namings.all.get(i).filter(|n| !going.goes(&n.path)) {
                going.user(user);
            }
        }
    }
    Ok(going.deletion(text))
}

/// What goes so far.
struct Going<'o> {
    outline: &'o Outline,
    namings: &'o Namings,
    paths: BTreeSet<Vec<String>>,
    parts: BTreeSet<Part>,
    /// Parts that go and whose users have not been looked at.
    waiting: Vec<Part>,
    /// Where each part is named.
    places: BTreeMap<&'o Part, Vec<usize>>,
    /// The namings that declare, by their path; those that go are taken out.
    declaring: BTreeMap<&'o [String], Vec<usize>>,
    /// How often each part is still declared.
    declared: BTreeMap<&'o Part, usize>,
    /// How many elements each list of a study still has.
    elements: BTreeMap<&'o [String], usize>,
}

impl<'o> Going<'o> {
    fn new(outline: &'o Outline, namings: &'o Namings) -> Self {
        let mut going = Self {
            outline,
            namings,
            paths: BTreeSet::new(),
            parts: BTreeSet::new(),
            waiting: Vec::new(),
            places: BTreeMap::new(),
            declaring: BTreeMap::new(),
            declared: BTreeMap::new(),
            elements: BTreeMap::new(),
        };
        for (i, naming) in namings.all.iter().enumerate() {
            going.places.entry(&naming.part).or_default().push(i);
            if naming.declares {
                going.declaring.entry(&naming.path).or_default().push(i);
                *going.declared.entry(&naming.part).or_default() += 1;
            }
        }
        for value in outline.values.iter().filter(|v| v.path.len() == ELEMENT) {
            if place_of(&value.path).0 == "studies" {
                let list = value.path.get(..ELEMENT - 1).unwrap_or(&[]);
                *going.elements.entry(list).or_default() += 1;
            }
        }
        going
    }

    fn places(&self, part: &Part) -> Vec<usize> {
        self.places.get(part).cloned().unwrap_or_default()
    }

    /// Deletes a part: everything that declares it.
    fn part(&mut self, part: &Part) -> Result<(), Diagnostic> {
        if !self.namings.declared(part) {
            return Err(unknown(self.namings, part));
        }
        for naming in self.namings.of(part).filter(|n| n.declares) {
            self.path(naming.path.clone());
        }
        Ok(())
    }

    fn goes(&self, path: &[String]) -> bool {
        within(&self.paths, path)
    }

    /// Deletes what stands at a path, and with it the parts that nothing else declares.
    fn path(&mut self, path: Vec<String>) {
        let under = self.declaring.range(path.as_slice()..);
        let under = under.take_while(|(known, _)| known.starts_with(&path));
        let keys: Vec<&[String]> = under.map(|(known, _)| *known).collect();
        for key in keys {
            for i in self.declaring.remove(key).unwrap_or_default() {
                let Some(naming) = self.namings.all.get(i) else {
                    continue;
                };
                let left = self.declared.entry(&naming.part).or_default();
                *left = left.saturating_sub(1);
                if *left == 0 {
                    self.parts.insert(naming.part.clone());
                    self.waiting.push(naming.part.clone());
                    let drawn = self.places(&naming.part).into_iter();
                    let drawn = drawn.filter_map(|i| self.namings.all.get(i));
                    let drawn = drawn.filter(|n| is_drawn_place(&n.path));
                    self.paths.extend(drawn.map(|n| n.path.clone()));
                }
            }
        }
        self.paths.insert(path);
    }

    /// Where what stays names what goes.
    fn users(&self) -> Vec<Naming> {
        let all = self.namings.all.iter();
        all.filter(|n| self.parts.contains(&n.part) && !self.goes(&n.path))
            .cloned()
            .collect()
    }

    /// Deletes what names something that goes.
    fn user(&mut self, user: &'o Naming) {
        let (section, _) = place_of(&user.path);
        let upto = |n: usize| user.path.get(..n.min(user.path.len())).unwrap_or(&[]);
        let list = user.path.get(2).map_or("", String::as_str);
        let depth = match (section, list) {
            ("links", _) if user.path.len() > 2 => 3,
            ("studies", "columns" | "plot" | "on" | "release" | "end_when")
                if user.path.len() >= ELEMENT =>
            {
                let left = self.elements.entry(upto(ELEMENT - 1)).or_default();
                *left = left.saturating_sub(1);
                // the last of a list takes the list with it, and a study of no link is none
                match (*left, list) {
                    (0, "on" | "release") => 2,
                    (0, _) => 3,
                    _ => ELEMENT,
                }
            }
            ("studies", "columns" | "plot" | "end_when") => 3,
            ("studies", "at" | "start" | "stops") => ELEMENT,
            _ => 2,
        };
        self.path(upto(depth).to_vec());
    }

    fn deletion(&self, text: &str) -> Deletion {
        let outermost = |path: &Vec<String>| {
            let above = path.len().saturating_sub(1);
            !path.get(..above).is_some_and(|above| self.goes(above))
        };
        let paths = self.paths.iter().filter(|p| outermost(p)).cloned();
        let paths: BTreeSet<Vec<String>> = paths.collect();
        Deletion {
            edits: removals(text, self.outline, &paths),
            paths: paths.into_iter().collect(),
            parts: self.parts.iter().cloned().collect(),
        }
    }
}

/// Parts in the path of an element of a study's list: `studies.turn.columns.0`.
const ELEMENT: usize = 4;
