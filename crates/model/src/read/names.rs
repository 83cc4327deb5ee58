//! The names of a file: collected before anything is read, so that order does not matter.

use crate::diagnostic::Diagnostic;
use crate::document::{Key, Node, Table, Value};
use crate::model::{Link, LinkId, Point, PointId};
use crate::read::context::{Context, Meaning};

/// Links and points a file may have at most.
pub(crate) const MAX_LINKS: usize = 10_000;
/// See [`MAX_LINKS`].
pub(crate) const MAX_POINTS: usize = 100_000;

/// The sections whose names share one space.
pub(crate) struct Sections<'d> {
    pub parameters: Vec<&'d (Key, Node)>,
    /// The frame first.
    pub links: Vec<&'d (Key, Node)>,
    pub joints: Vec<&'d (Key, Node)>,
    pub drives: Vec<&'d (Key, Node)>,
    pub measures: Vec<&'d (Key, Node)>,
    pub assembly: Vec<&'d (Key, Node)>,
    pub studies: Vec<&'d (Key, Node)>,
    pub loads: Vec<&'d (Key, Node)>,
    pub masses: Vec<&'d (Key, Node)>,
    pub springs: Vec<&'d (Key, Node)>,
    pub dampers: Vec<&'d (Key, Node)>,
    pub friction: Vec<&'d (Key, Node)>,
    pub cylinders: Vec<&'d (Key, Node)>,
    pub motors: Vec<&'d (Key, Node)>,
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
pub(crate) fn collect<'d>(cx: &mut Context<'_>, root: &'d Table) -> Sections<'d> {
    let mut section = |name: &str, example: &str| -> Vec<&'d (Key, Node)> {
        let Some(node) = root.get(name) else {
            return Vec::new();
        };
        match cx.table(node, &format!("[{name}]"), example) {
            Some(table) => table.entries.iter().collect(),
            None => Vec::new(),
        }
    };
    let mut sections = Sections {
        parameters: section(
            "parameters",
            "[parameters] with lines such as a = \"20 mm\"",
        ),
        links: section(
            "links",
            "[links] with lines such as crank = { A-B = \"20 mm\" }",
        ),
        joints: section(
            "joints",
            "[joints] with lines such as bore = { slider = \"piston\", at = \"C\", on = \"E -> F\" }",
        ),
        drives: section(
            "drives",
            "[drives] with lines such as motor = { turns = \"crank\", from = 0, to = 360, speed = \"1 rad/s\" }",
        ),
        measures: section(
            "measures",
            "[measures] with lines such as swing = \"angle(rocker)\"",
        ),
        assembly: section(
            "assembly",
            "[assembly] with lines such as C = \"left of B -> D\"",
        ),
        studies: section("studies", "[studies.turn] with the line kind = \"motion\""),
        loads: section(
            "loads",
            "[loads] with lines such as hook = { force = [0, \"-100 N\"], at = \"E\" }",
        ),
        masses: section(
            "masses",
            "[masses] with lines such as weight = { on = \"crank\", at = [-20, 0], mass = \"2 kg\" }",
        ),
        springs: section(
            "springs",
            "[springs] with lines such as return = { between = \"A-B\", stiffness = \"2 N/mm\", free = \"80 mm\" }",
        ),
        dampers: section(
            "dampers",
            "[dampers] with lines such as closer = { between = \"A-B\", damping = \"50 N s/m\" }",
        ),
        friction: section(
            "friction",
            "[friction] with lines such as B = { coefficient = 0.1, radius = \"10 mm\" }",
        ),
        cylinders: section(
            "cylinders",
            "[cylinders] with lines such as lift = { bore = \"80 mm\", rod = \"40 mm\" }",
        ),
        motors: section(
            "motors",
            "[motors] with lines such as motor = { curve = [[\"0 rpm\", \"12 N m\"], [\"3000 rpm\", \"0 N m\"]] }",
        ),
    };
    // the frame is link 0 wherever it stands
    sections.links.sort_by_key(|(k, _)| k.name != "frame");
    let kept = cx.limited(&sections.links, MAX_LINKS, "links").len();
    sections.links.truncate(kept);
    // parameters get their numbers when they are put in order
    for (i, (key, _)) in sections.parameters.iter().enumerate() {
        declare(
            cx,
            key,
            Meaning::Parameter(crate::model::ParameterId(i as u32)),
        );
    }
    for (i, (key, node)) in sections.links.iter().enumerate() {
        declare(cx, key, Meaning::Link(LinkId(i as u32)));
        collect_points(cx, LinkId(i as u32), key, node);
    }
    for (i, (key, _)) in sections.joints.iter().enumerate() {
        declare(cx, key, Meaning::Joint(i));
    }
    for (i, (key, _)) in sections.drives.iter().enumerate() {
        declare(cx, key, Meaning::Drive(i));
    }
    for (i, (key, _)) in sections.measures.iter().enumerate() {
        declare(cx, key, Meaning::Measure(i));
    }
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
pub(crate) fn long_name(cx: &mut Context<'_>, name: &str, span: &crate::model::Span) -> bool {
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

/// Names the language keeps for itself.
pub(crate) const RESERVED: &[&str] = &[
    "time",
    "pi",
    "kinetic_energy",
    "potential_energy",
    "shaking_force",
    "shaking_force_x",
    "shaking_force_y",
    "shaking_moment",
];

/// Columns that every table has, or every table of a circuit or of forces: what is a column itself is not called so.
pub(crate) const COLUMNS: &[&str] = &[
    "arc",
    "closure",
    "smallest_singular_value",
    "route_difference",
    "equilibrium_residual",
    "condition",
    "note",
];

fn declare(cx: &mut Context<'_>, key: &Key, meaning: Meaning) {
    let name = key.name.as_str();
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
    } else if RESERVED.contains(&name) {
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
    if let Some((other, place)) = cx.names.get(name).cloned() {
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
    let Value::Table(table) = &node.value else {
        return;
    };
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

fn enter_point(cx: &mut Context<'_>, name: &str, link: LinkId) {
    let next = PointId(cx.model.points.len() as u32);
    let point = *cx.points.entry(name.to_owned()).or_insert(next);
    if point == next {
        cx.model.points.push(Point {
            name: name.to_owned(),
            links: vec![link],
        });
    } else if let Some(known) = cx.model.points.get_mut(point.index())
        && known.links.last() != Some(&link)
    {
        known.links.push(link);
    }
}
