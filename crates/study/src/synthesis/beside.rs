//! Links beside those of a request's own mechanism: its file with more in it, and its studies replaced by one of its motion.

use std::collections::BTreeSet;

use kempe_measure::Sample;
use kempe_model::{
    Diagnostic, DriveId, FRAME, LinkId, Model, ModelFile, Part, PartKind, PointId, add_entry,
    apply, delete, parts, set_value, value_edit,
};
use kempe_synthesis::C;
use kempe_units::Dimension;

use super::file::{Pen, STUDY};
use super::own_linkage::Wanted;

/// Links beside a mechanism.
pub(super) struct Beside {
    /// The whole file.
    pub file: ModelFile,
    /// Its study.
    pub study: String,
    /// The drive that moves it, as the request counts them.
    pub drive: DriveId,
    /// The lengths by which it is known, by their names in its file, m.
    pub lengths: Vec<(String, f64)>,
    /// Numbers that are told of it besides: name, value (SI), what it measures.
    pub told: Vec<(String, f64, Dimension)>,
    /// What it must do.
    pub wanted: Vec<Wanted>,
    /// The measure it is ordered by where nothing else is said.
    pub rank: String,
    /// Measures that are told of it, whatever is asked.
    pub columns: Vec<String>,
    /// What its file names beside what the request's names, in words.
    pub names: String,
}

impl Beside {
    /// Its file under a title.
    pub fn titled(&self, title: &str) -> ModelFile {
        let mut file = self.file.clone();
        let title = text_value(title);
        if let Ok(toml) = set_value(&file.toml, &["title"], &title) {
            file.toml = toml;
        }
        file
    }
}

/// A string as TOML writes it.
pub(super) fn text_value(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

/// A key as TOML writes it.
pub(super) fn key(name: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    match name.chars().all(bare) {
        true => name.to_owned(),
        false => text_value(name),
    }
}

fn is_array(text: &str) -> bool {
    let table = format!("it = {text}").parse::<toml::Table>();
    table.is_ok_and(|table| table.get("it").is_some_and(toml::Value::is_array))
}

/// A request's file while it is being added to.
pub(super) struct Extended<'m> {
    request: &'m Model,
    file: ModelFile,
    taken: BTreeSet<String>,
    /// Names that were added, with what they are.
    names: Vec<String>,
    pub pen: Pen,
}

impl<'m> Extended<'m> {
    /// The request's file without its studies.
    pub fn new(request: &'m Model) -> Result<Self, Box<Diagnostic>> {
        let mut file = request.as_written();
        let all = parts(&file.toml);
        for (part, _) in all.iter().filter(|(part, _)| part.kind == PartKind::Study) {
            // An announced study is no part that anything could use.
            if let Ok(edits) = delete(&file.toml, &Part::new(PartKind::Study, &*part.name))
                && let Ok(toml) = apply(&file.toml, &edits)
            {
                file.toml = toml;
            }
        }
        let end = file.toml.trim_end().len();
        file.toml.truncate(end);
        file.toml.push('\n');
        let named = all.into_iter().map(|(part, _)| part);
        let named = named.filter(|part| part.kind != PartKind::Study);
        let taken = named.map(|part| part.name).collect();
        Ok(Self {
            request,
            file,
            taken,
            names: Vec::new(),
            pen: Pen::of(request),
        })
    }

    /// A name that the file has not: this one, with a number behind it where it must be.
    pub fn name(&mut self, wanted: &str) -> String {
        let numbered = (2..).map(|k| format!("{wanted}{k}"));
        let mut names = std::iter::once(wanted.to_owned()).chain(numbered);
        let free = names.find(|name| !self.taken.contains(name));
        let free = free.unwrap_or_else(|| wanted.to_owned());
        self.taken.insert(free.clone());
        self.names.push(format!("`{free}`"));
        free
    }

    /// An entry of a section, with its value as TOML.
    pub fn add(&mut self, section: &str, name: &str, value: &str) -> Result<(), Box<Diagnostic>> {
        let edit = add_entry(&self.file.toml, section, name, value).map_err(Box::new)?;
        self.edit(edit)
    }

    fn edit(&mut self, edit: kempe_model::TextEdit) -> Result<(), Box<Diagnostic>> {
        self.file.toml = apply(&self.file.toml, &[edit])
            .map_err(|error| Box::new(Diagnostic::error("toml-syntax", error.to_string())))?;
        Ok(())
    }

    /// A point of the frame.
    pub fn frame_point(&mut self, name: &str, place: C) -> Result<(), Box<Diagnostic>> {
        self.point_on(FRAME, name, place)
    }

    /// A point of a link, at a place in its axes.
    pub fn point_on(&mut self, link: LinkId, name: &str, place: C) -> Result<(), Box<Diagnostic>> {
        let link = self.request.links[link.index()].name.clone();
        let place = self.pen.place_text(place);
        // A link that lists its points is the same as a table of that list, which may have more.
        let whole = value_edit(&self.file.toml, &["links", &link], "[]");
        let listed = whole.ok().and_then(|edit| self.file.toml.get(edit.span));
        if let Some(listed) = listed.filter(|text| is_array(text)) {
            let table = format!("{{ points = {listed}, {} = {place} }}", key(name));
            let edit = value_edit(&self.file.toml, &["links", &link], &table);
            return self.edit(edit.map_err(Box::new)?);
        }
        let edit = value_edit(&self.file.toml, &["links", &link, name], &place);
        self.edit(edit.map_err(Box::new)?)
    }

    /// A length as a parameter, by its name, which is added to those by which the whole is known.
    pub fn length(
        &mut self,
        name: &str,
        length: f64,
        lengths: &mut Vec<(String, f64)>,
    ) -> Result<String, Box<Diagnostic>> {
        let name = self.name(name);
        let text = text_value(&self.pen.exact(length, Dimension::LENGTH));
        self.add("parameters", &name, &text)?;
        lengths.push((name.clone(), length));
        Ok(name)
    }

    /// A link of two points.
    pub fn distance(
        &mut self,
        link: &str,
        [a, b]: [&str; 2],
        length: &str,
    ) -> Result<(), Box<Diagnostic>> {
        let key = key(&format!("{a}-{b}"));
        self.add(
            "links",
            link,
            &format!("{{ {key} = {} }}", text_value(length)),
        )
    }

    /// Hints for what the drawing alone puts together: they count no more beside others.
    pub fn keep_drawn(&mut self, start: &Sample) -> Result<(), Box<Diagnostic>> {
        let drawing = &self.request.drawing;
        let own_hints = self.request.assembly.len() > drawing.hints;
        if drawing.places.is_empty() || own_hints {
            return Ok(());
        }
        let moving = |id: &&PointId| {
            let point = self.request.points.get(id.index());
            point.is_some_and(|point| !point.links.contains(&FRAME))
        };
        let mut hints: Vec<(String, String)> = Vec::new();
        for id in drawing.places.keys().filter(moving) {
            if let (Some(point), Some([x, y])) = (
                self.request.points.get(id.index()),
                start.points.get(id.index()),
            ) {
                let near = self.pen.place_text(C::new(*x, *y));
                hints.push((point.name.clone(), near));
            }
        }
        for id in drawing.links.iter().filter(|id| **id != FRAME) {
            if let (Some(link), Some([.., angle])) = (
                self.request.links.get(id.index()),
                start.links.get(id.index()),
            ) {
                let near = text_value(&self.pen.exact(*angle, Dimension::ANGLE));
                hints.push((link.name.clone(), near));
            }
        }
        for (name, near) in hints {
            self.add("assembly", &name, &format!("{{ near = {near} }}"))?;
        }
        Ok(())
    }

    /// The study of the motion with what is plotted; the file, its study's name, and what it names beside the request's names.
    pub fn finished(
        mut self,
        plots: &[String],
    ) -> Result<(ModelFile, String, String), Box<Diagnostic>> {
        let names = self.names.join(", ");
        let plots: Vec<String> = plots.iter().map(|plot| text_value(plot)).collect();
        let study = format!(
            "{{ kind = \"motion\", rows = 361, plot = [{}] }}",
            plots.join(", ")
        );
        self.add("studies", STUDY, &study)?;
        Ok((self.file, STUDY.to_owned(), names))
    }
}
