//! The other one of two designs that are set beside each other.

use kempe_model::{Diagnostic, Study};
use kempe_study::{Comparison, Design, StudyOutcome, compare};

use crate::arguments::{ModelFile, Run};
use crate::exit::Exit;
use crate::files::{Loaded, load_other};
use crate::say::Speaker;

/// What the other design gave.
pub struct Against<'r> {
    /// The other design.
    pub loaded: &'r Loaded,
    /// What became of its studies.
    pub outcomes: &'r [StudyOutcome<'r>],
    /// Both beside each other.
    pub comparison: Comparison,
    name: String,
}

impl<'r> Against<'r> {
    /// Sets both designs beside each other.
    pub fn of(
        this: &Loaded,
        outcomes: &[StudyOutcome<'_>],
        loaded: &'r Loaded,
        other_outcomes: &'r [StudyOutcome<'r>],
    ) -> Self {
        let names = [this, loaded].map(|design| design.origin().design_name());
        let design = Design {
            name: &names[0],
            model: &this.checked.model,
            outcomes,
        };
        let other = Design {
            name: &names[1],
            model: &loaded.checked.model,
            outcomes: other_outcomes,
        };
        let comparison = compare(&design, &other);
        let [_, name] = names;
        Self {
            loaded,
            outcomes: other_outcomes,
            comparison,
            name,
        }
    }

    /// The other design.
    pub fn design(&self) -> Design<'_> {
        Design {
            name: &self.name,
            model: &self.loaded.checked.model,
            outcomes: self.outcomes,
        }
    }
}

/// The other design, where one is asked for. The speaker speaks of this one again afterwards.
pub fn other(
    arguments: &Run,
    this: &Loaded,
    speaker: &mut Speaker,
) -> Result<Option<Loaded>, Exit> {
    if arguments.against.is_none() && arguments.against_set.is_empty() {
        return Ok(None);
    }
    let own = &arguments.model;
    let mut set = arguments.against_set.clone();
    // This file with other values keeps the values given besides.
    if arguments.against.is_none() {
        let kept = own.set.iter();
        let kept = kept.filter(|(name, _)| set.iter().all(|(other, _)| other != name));
        set = kept.cloned().chain(set.iter().cloned()).collect();
    }
    let model = ModelFile {
        file: arguments.against.clone().unwrap_or(own.file.clone()),
        set,
        strict: own.strict,
        allow_outside: own.allow_outside,
    };
    let same_file = model.file.canonicalize().ok() == own.file.canonicalize().ok();
    if same_file && sorted(&model.set) == sorted(&own.set) {
        speaker.tell(&[same_design(this)]);
        return Err(Exit::Usage);
    }
    speaker.turn_to_other(&model.file.display().to_string(), "", &model.set);
    let loaded = load_other(&model, this, speaker);
    speaker.turn_back(&this.name, &this.text);
    loaded.map(Some)
}

fn sorted(set: &[(String, String)]) -> Vec<(String, String)> {
    let mut set = set.to_vec();
    set.sort();
    set
}

fn same_design(this: &Loaded) -> Diagnostic {
    let name = this.origin().design_name();
    let message = format!("both designs are {name}: there is nothing to compare");
    Diagnostic::error("nothing-to-compare", message)
        .help("give the other one another value, as in --against-set a=25mm, or name another file: --against old.toml")
}

/// The studies of the other design that are called as those of this one.
pub fn studies_of_other<'o>(
    this: &[&Study],
    other: &'o Loaded,
    speaker: &mut Speaker,
) -> Vec<&'o Study> {
    let all = &other.checked.model.studies;
    let named = |study: &&Study| all.iter().find(|s| s.name == study.name);
    let studies: Vec<&Study> = this.iter().filter_map(named).collect();
    if studies.is_empty() {
        let has: Vec<&str> = all.iter().map(|s| s.name.as_str()).collect();
        let asked: Vec<&str> = this.iter().map(|s| s.name.as_str()).collect();
        let message = format!(
            "{} has no study called {}: there is nothing to compare",
            other.name,
            asked.join(" or ")
        );
        let diagnostic = Diagnostic::warning("nothing-to-compare", message);
        let diagnostic = match has.is_empty() {
            true => diagnostic,
            false => diagnostic.note(format!("its studies are {}", has.join(", "))),
        };
        speaker.tell(&[diagnostic.help("give the studies of both files the same names")]);
    }
    studies
}
