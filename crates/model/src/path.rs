//! From a place of a text to a path such as `joints.bore.at`, and from a path to its places.

use crate::ids::Span;
use crate::outline::Outline;

/// What stands at a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PathPart {
    /// A key.
    Key,
    /// A value.
    Value,
}

/// The path of a place.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct PathAt {
    /// Keys from the outside in, and places in arrays as numbers: `["links", "frame", "D", "0"]`.
    pub path: Vec<String>,
    /// Whether it is the key or the value of the path's last part.
    pub part: PathPart,
    /// The whole key or value.
    pub span: Span,
}

/// The innermost key or value at a byte of a text, its end included; `None` between entries, in comments and blanks there.
///
/// The text may have errors on other lines, and even on this one as far as it can be followed.
///
/// # Example
///
/// ```
/// use kempe_model::path_at;
/// let text = "[joints]\nbore = { slider = \"piston\", at = \"C\" }\n[drives\nm = ";
/// let at = path_at(text, text.find("piston").unwrap() + 2).unwrap();
/// assert_eq!(at.path, ["joints", "bore", "slider"]);
/// assert_eq!(&text[at.span], "\"piston\"");
/// ```
pub fn path_at(text: &str, offset: usize) -> Option<PathAt> {
    let outline = Outline::new(text);
    let holds = |span: &Span| span.start <= offset && offset <= span.end;
    let keys = outline.keys.iter().filter(|k| holds(&k.span));
    let keys = keys.map(|k| (&k.path, PathPart::Key, &k.span));
    let values = outline.values.iter().filter(|v| holds(&v.span));
    let values = values.map(|v| (&v.path, PathPart::Value, &v.span));
    // what is within something else is shorter
    let innermost = values.chain(keys).min_by_key(|(_, _, span)| span.len());
    innermost.map(|(path, part, span)| PathAt {
        path: path.clone(),
        part,
        span: span.clone(),
    })
}

/// Where a path is written.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct PathPlaces {
    /// The path's last key wherever it stands: a table may have several headers. None for an element of an array.
    pub keys: Vec<Span>,
    /// The value; `None` of a table that headers or dotted keys make.
    pub value: Option<Span>,
}

/// Where the key and the value of a path stand in a text; `None` when the path leads nowhere.
///
/// # Example
///
/// ```
/// use kempe_model::places_of;
/// let text = "[links]\nframe = { A = [0, 0], D = [60, 0] }\n";
/// let d = places_of(text, &["links", "frame", "D", "0"]).unwrap();
/// assert_eq!(&text[d.value.unwrap()], "60");
/// let frame = places_of(text, &["links", "frame"]).unwrap();
/// assert_eq!(&text[frame.keys[0].clone()], "frame");
/// assert!(places_of(text, &["links", "crank"]).is_none());
/// ```
pub fn places_of(text: &str, path: &[&str]) -> Option<PathPlaces> {
    let outline = Outline::new(text);
    let is = |known: &[String]| known.iter().map(String::as_str).eq(path.iter().copied());
    let places = PathPlaces {
        keys: (outline.keys.iter())
            .filter(|k| is(&k.path))
            .map(|k| k.span.clone())
            .collect(),
        value: (outline.values.iter())
            .find(|v| is(&v.path))
            .map(|v| v.span.clone()),
    };
    (places != PathPlaces::default()).then_some(places)
}
