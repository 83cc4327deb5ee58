//! The names of a file: collected before anything is read, so that order does not matter.

use crate::diagnostic::Diagnostic;
use crate::ids::{FRAME, LinkId, ParameterId, PointId};
use crate::key_table::FILE;
use crate::keys::Takes;
use crate::link::{Link, Point};
use crate::node::{Key, Node, Value};
use crate::read::context::{Context, Meaning};
use crate::read::entry::Entry;
use crate::read::measure_names::bare;

/// Links and points a file may have at most.
pub(crate) const MAX_LINKS: usize = 10_000;
/// See [`MAX_LINKS`].
pub(crate) const MAX_POINTS: usize = 100_000;

/// The entries of each section.
pub(crate) struct Sections<'d> {
    entries: Vec<(&'static str, Vec<&'d (Key, Node)>)>,
    /// The link of the first entry of `[links]`: the one behind the frame where the file has no frame.
    pub first_link: usize,
}

impl<'d> Sections<'d> {
    /// The entries of a section in the order of the file; of the links the frame first.
    pub fn of(&self, name: &str) -> &[&'d (Key, Node)] {
        let section = self.entries.iter().find(|(known, _)| *known == name);
        debug_assert!(section.is_some(), "no section `{name}` in the table");
        section.map_or(&[], |(_, entries)| entries)
    }
}

/// Which entry of `[links]` is the frame: the one of this name, or else one that is likely meant so.
pub(crate) fn frame_of(entries: &[&(Key, Node)]) -> Option<usize> {
    let is = |name: &str| entries.iter().position(|(key, _)| key.name == name);
    let near = || {
        let mut keys = entries.iter().map(|(key, _)| key.name.as_str());
        keys.position(|name| kempe_units::nearest(name, ["frame"]).is_some())
    };
    let others = || {
        ["ground", "base", "fixed", "chassis"]
            .into_iter()
            .find_map(is)
    };
    is("frame").or_else(others).or_else(near)
}

/// Whether a name is a point's: it starts with a capital letter.
pub(crate) fn is_point_name(name: &str) -> bool {
    let mut letters = name.chars();
    letters.next().is_some_and(char::is_uppercase)
        && letters.all(|c| c.is_alphanumeric() || c == '_')
}

/// Whether a name may stand in an expression for something that is not a point.
pub(crate) fn is_small_name(name: &str) -> bool {
    let mut letters = name.chars();
    letters
        .next()
        .is_some_and(|c| c == '_' || (c.is_alphabetic() && !c.is_uppercase()))
        && letters.all(|c| c.is_alphanumeric() || c == '_')
}

/// The two points of a key `A-B`.
pub(crate) fn pair_of(key: &str) -> Option<(&str, &str)> {
    let (a, b) = key.split_once('-')?;
    let (a, b) = (a.trim(), b.trim());
    (is_point_name(a) && is_point_name(b)).then_some((a, b))
}

/// Enters all names of the file: small-letter names, links with their points.
pub(crate) fn collect<'d>(cx: &mut Context<'_>, file: &Entry<'d>) -> Sections<'d> {
    let tables = FILE
        .keys()
        .filter(|key| matches!(key.takes, Takes::Values(_) | Takes::Entries(_)));
    let mut sections = Vec::new();
    let mut first_link = 0;
    for section in tables {
        let name = section.name;
        let example = match name {
            "studies" => format!("[studies.turn] with the line {}", section.example),
            _ => format!("[{name}] with lines such as {}", section.example),
        };
        let node = file.get(name);
        let table = node.and_then(|node| cx.table(node, &format!("[{name}]"), &example));
        let mut entries: Vec<&(Key, Node)> =
            table.map_or(Vec::new(), |table| table.entries.iter().collect());
        if name == "links" {
            // the frame is link 0 wherever it stands, and where it is missing nothing else is
            match frame_of(&entries).map(|at| entries.remove(at)) {
                Some(frame) => entries.insert(0, frame),
                None => first_link = 1,
            }
            let kept = cx.limited(&entries, MAX_LINKS, "links").len();
            entries.truncate(kept);
        }
        sections.push((name, entries));
    }
    let sections = Sections {
        entries: sections,
        first_link,
    };
    if first_link > 0 {
        cx.broken.lose_frame();
        cx.model.links.push(Link {
            name: "frame".to_owned(),
            points: Vec::new(),
            inertia: None,
            span: 0..0,
        });
    }
    let mut declare_all = |section: &str, meaning: &dyn Fn(usize) -> Meaning| {
        for (i, (key, node)) in sections.of(section).iter().enumerate() {
            let meaning = meaning(i);
            declare(cx, key, meaning);
            if let Meaning::Link(link) = meaning {
                collect_points(cx, link, key, node);
            }
        }
    };
    // parameters get their numbers when they are put in order
    declare_all("parameters", &|i| Meaning::Parameter(ParameterId(i as u32)));
    declare_all("links", &|i| Meaning::Link(LinkId((first_link + i) as u32)));
    declare_all("joints", &Meaning::Joint);
    declare_all("drives", &Meaning::Drive);
    declare_all("measures", &Meaning::Measure);
    // named by others, it is not to be missed a second time
    cx.names
        .entry("frame".to_owned())
        .or_insert((Meaning::Link(FRAME), 0..0));
    if cx.model.points.len() > MAX_POINTS {
        cx.push(
            Diagnostic::error("too-large", format!("{} points", cx.model.points.len()))
                .help(format!("a model has at most {MAX_POINTS} points")),
        );
    }
    sections
}

/// A name has at most so many bytes: names become those of files, two to a file.
pub(crate) const MAX_NAME: usize = 64;

/// Tells a name that is too long; whether it was.
pub(crate) fn long_name(cx: &mut Context<'_>, name: &str, span: &crate::ids::Span) -> bool {
    let bytes = name.len();
    if bytes > MAX_NAME {
        cx.push(
            Diagnostic::error("bad-name", format!("a name of {bytes} bytes"))
                .at(span.clone(), "too long")
                .help(format!(
                    "a name has at most {MAX_NAME} bytes, one for a letter without accents"
                )),
        );
    }
    bytes > MAX_NAME
}

/// Whether the language keeps a name for itself.
pub(crate) fn is_reserved(name: &str) -> bool {
    matches!(name, "time" | "pi") || bare(name).is_some()
}

/// Columns that every table has, or every table of a circuit, of forces or of designs, and numbers that a tolerance study tells: what is a
/// column itself is not called so.
pub(crate) const COLUMNS: &[&str] = &[
    "arc",
    "closure",
    "smallest_singular_value",
    "route_difference",
    "equilibrium_residual",
    "condition",
    "note",
    "design",
    "pieces",
    "yield",
];

fn declare(cx: &mut Context<'_>, key: &Key, meaning: Meaning) {
    let name = key.name.as_str();
    let told = cx.found.len();
    if long_name(cx, name, &key.span) {
        // the length is what is wrong, whatever else is
    } else if !is_small_name(name) {
        let capital = name.chars().next().is_some_and(char::is_uppercase);
        let help = if capital {
            format!(
                "only points start with a capital letter: write `{}`",
                name.to_lowercase()
            )
        } else {
            format!(
                "a name starts with a small letter and goes on with letters, digits and _: write `{}`",
                tame(name)
            )
        };
        cx.push(
            Diagnostic::error(
                "bad-name",
                format!("`{name}` cannot name {}", meaning.what()),
            )
            .at(key.span.clone(), "")
            .help(help),
        );
    } else if is_reserved(name) {
        cx.push(
            Diagnostic::error(
                "bad-name",
                format!("`{name}` cannot name {}", meaning.what()),
            )
            .at(
                key.span.clone(),
                format!("`{name}` already means something in every file"),
            )
            .help("ask for it by this name, or choose another one"),
        );
    } else if COLUMNS.contains(&name) && matches!(meaning, Meaning::Drive(_) | Meaning::Measure(_))
    {
        cx.push(
            Diagnostic::error(
                "bad-name",
                format!("`{name}` cannot name {}", meaning.what()),
            )
            .at(
                key.span.clone(),
                format!("tables have a column `{name}` of their own"),
            )
            .help(format!("choose another name, such as `my_{name}`")),
        );
    }
    if cx.found.len() > told {
        cx.broken.misname(name);
    }
    if let Some((other, place)) = cx.names.get(name).cloned() {
        cx.broken.misname(name);
        cx.push(
            Diagnostic::error(
                "name-clash",
                format!("`{name}` names {} and {}", other.what(), meaning.what()),
            )
            .at(key.span.clone(), format!("{} here", meaning.what()))
            .see(place, format!("{} here", other.what()))
            .help("a name means one thing in the whole file: rename one of them"),
        );
        return;
    }
    cx.names
        .insert(name.to_owned(), (meaning, key.span.clone()));
}

/// A near name that would do.
fn tame(name: &str) -> String {
    let tamed: String = name
        .chars()
        .map(|c| if c.is_alphanumeric() { c } else { '_' })
        .collect();
    let tamed = tamed.to_lowercase();
    if tamed.chars().next().is_some_and(char::is_alphabetic) {
        tamed
    } else {
        format!("n{tamed}")
    }
}

/// Enters the link and the points its keys name.
fn collect_points(cx: &mut Context<'_>, id: LinkId, key: &Key, node: &Node) {
    cx.model.links.push(Link {
        name: key.name.clone(),
        points: Vec::new(),
        inertia: None,
        span: key.span.clone(),
    });
    let table = match &node.value {
        Value::Table(table) => table,
        Value::Array(listed) => return collect_listed(cx, id, listed),
        _ => return,
    };
    // they are placed first, wherever the list stands
    if let Some(Value::Array(listed)) = table.get(LISTED).map(|node| &node.value) {
        collect_listed(cx, id, listed);
    }
    for (key, _) in &table.entries {
        let pair = pair_of(&key.name);
        let single = is_point_name(&key.name).then_some(key.name.as_str());
        for name in pair.into_iter().flat_map(|(a, b)| [a, b]).chain(single) {
            if !cx.points.contains_key(name) {
                long_name(cx, name, &key.span);
            }
            enter_point(cx, name, id);
        }
    }
}

/// The key of a link's list of points.
pub(crate) const LISTED: &str = "points";

/// Enters the points that a link lists by their names.
fn collect_listed(cx: &mut Context<'_>, id: LinkId, listed: &[Node]) {
    for node in listed {
        if let Value::Text(text) = &node.value
            && is_point_name(text.content.trim())
        {
            let name = text.content.trim();
            if !cx.points.contains_key(name) {
                long_name(cx, name, &node.span);
            }
            enter_point(cx, name, id);
        }
    }
}

fn enter_point(cx: &mut Context<'_>, name: &str, link: LinkId) {
    let next = PointId(cx.model.points.len() as u32);
    let point = *cx.points.entry(name.to_owned()).or_insert(next);
    if point == next {
        cx.model.points.push(Point {
            name: name.to_owned(),
            links: vec![link],
            holder: None,
        });
    } else if let Some(known) = cx.model.points.get_mut(point.index())
        && known.links.last() != Some(&link)
    {
        known.links.push(link);
    }
}
