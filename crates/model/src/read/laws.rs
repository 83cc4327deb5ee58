//! How a drive moves: limits and a speed, a standard law, a sequence, a measured table.

use kempe_units::{Builtin, Dimension, Expr};

use crate::bound::Keeps;
use crate::diagnostic::Diagnostic;
use crate::drive::{Law, LawPiece, RiseLaw};
use crate::ids::{Scalar, Span};
use crate::key_table::{DRAWN, LAW_TABLE, LAWS, PIECE};
use crate::node::{Node, Value};
use crate::read::context::Context;
use crate::read::entry::Entry;
use crate::read::law_table::read_table;

/// A sequence has at most so many pieces.
const MAX_PIECES: usize = 1_000;

/// A drive's law while it is read.
struct LawReader<'e, 'd> {
    entry: &'e Entry<'d>,
    place: &'e str,
    dimension: Dimension,
    /// Where the drive stands as drawn.
    drawn: Option<Scalar>,
    /// Whether it is known what the drive moves.
    known: bool,
}

/// Reads the law of a drive, with where it stands if the file draws it; `None` if it is not known what it moves.
pub(crate) fn read_law(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    drawn: Option<Option<Scalar>>,
) -> Option<Law> {
    LawReader {
        entry,
        place: &entry.place,
        dimension: entry.dimension("from"),
        known: drawn.is_some(),
        drawn: drawn.flatten(),
    }
    .read(cx)
}

impl<'d> LawReader<'_, 'd> {
    fn read(&self, cx: &mut Context<'_>) -> Option<Law> {
        if let Some(node) = self.entry.get("at") {
            return self.held(cx, node);
        }
        match self.entry.get("law") {
            Some(
                node @ Node {
                    value: Value::Table(_),
                    span,
                },
            ) => {
                self.idle(
                    cx,
                    &["from", "to", "speed", "acceleration", "in"],
                    "the table says it all",
                );
                let place = format!("the table law of {}", self.place);
                let table = Entry::inner(cx, node, span, place, &LAW_TABLE)?;
                read_table(cx, &table, self.dimension)
            }
            Some(Node {
                value: Value::Array(pieces),
                span,
            }) => {
                self.idle(
                    cx,
                    &["to", "speed", "acceleration", "in"],
                    "the sequence says it all",
                );
                self.sequence(cx, pieces, span)
            }
            Some(node) => self.standard(cx, node),
            None => self.constant(cx),
        }
    }

    /// `at = 30`: the coordinate is held.
    fn held(&self, cx: &mut Context<'_>, node: &'d Node) -> Option<Law> {
        self.idle(
            cx,
            &["from", "to", "speed", "acceleration", "law", "in"],
            "`at` holds the drive where it is",
        );
        let from = self.coordinate(cx, node)?;
        Some(Law {
            pieces: vec![LawPiece::Dwell {
                duration: Expr::Const(0.0),
            }],
            from,
        })
    }

    /// A place of the drive that is within its bounds.
    fn coordinate(&self, cx: &mut Context<'_>, node: &Node) -> Option<Scalar> {
        let coordinate = self.coordinate_anywhere(cx, node)?;
        self.check_coordinate(cx, &coordinate, &node.span);
        Some(coordinate)
    }

    /// A value, `"drawn"`, or what is computed of it: `"drawn + 30 deg"`.
    fn coordinate_anywhere(&self, cx: &mut Context<'_>, node: &Node) -> Option<Scalar> {
        match &node.value {
            Value::Text(text) if names(&text.content, DRAWN) && !cx.names.contains_key(DRAWN) => {
                let drawn = self.as_drawn(cx, node)?;
                cx.scalar_over(node, self.dimension, Some((DRAWN, &drawn)))
            }
            _ => cx.scalar(node, self.dimension),
        }
    }

    /// `"drawn"`.
    fn as_drawn(&self, cx: &mut Context<'_>, node: &Node) -> Option<Scalar> {
        if self.drawn.is_none() && self.known && cx.broken_places.is_empty() {
            let example = cx.example(self.dimension);
            return cx.refuse(
                "no-place",
                format!("{} is not drawn", self.place),
                &node.span,
                format!(
                    "draw the points that it is between under [places], or give a value: {example}"
                ),
            );
        }
        self.drawn.clone()
    }

    /// Reports keys that say something a second time.
    fn idle(&self, cx: &mut Context<'_>, keys: &[&str], why: &str) {
        for key in self.entry.given(keys) {
            cx.push(
                Diagnostic::error(
                    "over-specified",
                    format!("{} needs no `{}`", self.place, key.name),
                )
                .at(key.span.clone(), why)
                .help(format!("leave `{}` out", key.name)),
            );
        }
    }

    /// The start: as drawn, or 0, unless said otherwise; a cylinder that is not drawn has no such default.
    fn from(&self, cx: &mut Context<'_>) -> Option<Scalar> {
        match self.entry.get("from") {
            Some(node) => self.coordinate(cx, node),
            None if self.drawn.is_some() => {
                let drawn = self.drawn.clone()?;
                self.check_coordinate(cx, &drawn, self.entry.span);
                Some(drawn)
            }
            None if self.entry.kind.name == "cylinder" => {
                // a broken place may be all that is missing
                if !cx.broken_places.is_empty() {
                    return None;
                }
                self.entry
                    .required_like(cx, "from", "\"380 mm\", the length at the start");
                None
            }
            None => Some(Expr::Const(0.0)),
        }
    }

    /// The end: one turn further unless said otherwise; lengths have no such default.
    fn to(&self, cx: &mut Context<'_>, from: Option<&Scalar>) -> Option<Scalar> {
        match self.entry.get("to") {
            Some(node) => self.coordinate(cx, node),
            None if self.entry.kind.name == "turns" => {
                let turn = Expr::Const(std::f64::consts::TAU);
                match from? {
                    Expr::Const(x) => Some(Expr::Const(x + std::f64::consts::TAU)),
                    from => Some(Expr::Add(Box::new(from.clone()), Box::new(turn))),
                }
            }
            None => {
                let example = cx.example(self.dimension);
                self.entry.required_like(cx, "to", &example);
                None
            }
        }
    }

    fn check_coordinate(&self, cx: &mut Context<'_>, scalar: &Scalar, span: &Span) {
        if self.entry.kind.name == "cylinder" {
            length_of_cylinder(cx, self.place, scalar, span);
        }
    }

    fn limits(&self, cx: &mut Context<'_>) -> Option<(Scalar, Scalar)> {
        let from = self.from(cx);
        let to = self.to(cx, from.as_ref());
        let (from, to) = (from?, to?);
        if cx.number(&from) == cx.number(&to) {
            let span = self
                .entry
                .get("to")
                .or(self.entry.get("from"))
                .map_or(self.entry.span.clone(), |n| n.span.clone());
            cx.push(
                Diagnostic::error(
                    "no-motion",
                    format!("{} starts and ends at the same place", self.place),
                )
                .at(span, "")
                .help("to hold a drive, write at = … instead of from and to"),
            );
            return None;
        }
        let span = &self.entry.span;
        cx.bound(
            &way(&from, &to),
            span,
            &format!("{}: its way", self.place),
            self.dimension,
            Keeps::NotZero,
        );
        Some((from, to))
    }

    /// `from`, `to` and `speed` or `acceleration`.
    fn constant(&self, cx: &mut Context<'_>) -> Option<Law> {
        let limits = self.limits(cx);
        let rates = ["speed", "acceleration"];
        if let Some(rate) = rates.into_iter().find(|key| self.entry.get(key).is_some())
            && self.entry.get("in").is_some()
        {
            self.idle(cx, &["in"], &format!("`{rate}` says how it moves"));
            return None;
        }
        if let Some((key, _)) = self.entry.entry("in") {
            cx.push(
                Diagnostic::error("missing-key", format!("{} has `in` but no `law`", self.place))
                    .at(key.span.clone(), "in this time, but how?")
                    .help("add law = \"cycloidal\", \"harmonic\", \"3-4-5\" or \"4-5-6-7\", or give a speed instead"),
            );
            return None;
        }
        let piece = match (self.entry.get("speed"), self.entry.get("acceleration")) {
            (Some(_), Some(_)) => {
                self.idle(cx, &["acceleration"], "`speed` says how it moves");
                return None;
            }
            (None, None) => {
                let unit = cx.bare_unit(rate(self.dimension, 1)).text().to_owned();
                cx.push(
                    Diagnostic::error("missing-key", format!("{}: how fast?", self.place))
                        .at(self.entry.span.clone(), "`speed` is missing")
                        .help(format!(
                            "add speed = \"1 {unit}\"; or acceleration = \"1 {unit}^2\" from rest; or law = \"cycloidal\" and in = \"1 s\""
                        )),
                );
                return None;
            }
            (Some(node), None) => self.moving(cx, node, 1, limits.as_ref()),
            (None, Some(node)) => self.moving(cx, node, 2, limits.as_ref()),
        };
        let (from, _) = limits?;
        Some(Law {
            pieces: vec![piece?],
            from,
        })
    }

    /// A piece of constant speed (`order` 1) or acceleration (2) between the limits.
    fn moving(
        &self,
        cx: &mut Context<'_>,
        node: &Node,
        order: i32,
        limits: Option<&(Scalar, Scalar)>,
    ) -> Option<LawPiece> {
        let what = if order == 1 { "speed" } else { "acceleration" };
        let dimension = rate(self.dimension, order);
        let rate = cx.scalar(node, dimension)?;
        let size = cx.number(&rate);
        let (from, to) = limits?;
        let travel = cx.number(to) - cx.number(from);
        if size == 0.0 {
            cx.push(
                Diagnostic::error(
                    "bad-size",
                    format!("{}: with {what} zero it never arrives", self.place),
                )
                .at(node.span.clone(), "this is zero")
                .help(format!(
                    "give a {what} that is not zero, or hold the drive with at = …"
                )),
            );
            return None;
        }
        if size < 0.0 && travel > 0.0 {
            let (a, b) = (
                cx.show(cx.number(from), self.dimension),
                cx.show(cx.number(to), self.dimension),
            );
            cx.push(
                Diagnostic::error("wrong-direction", format!("{}: a negative {what} does not lead from {a} to {b}", self.place))
                    .at(node.span.clone(), "leads the other way")
                    .help(format!("from and to say the direction: write the {what} without a sign, or swap from and to")),
            );
            return None;
        }
        let rate = if size < 0.0 {
            Expr::Call(Builtin::Abs, vec![rate])
        } else {
            let bound = format!("{}: its {what}", self.place);
            cx.bound(&rate, &node.span, &bound, dimension, Keeps::Positive);
            rate
        };
        let to = to.clone();
        Some(if order == 1 {
            LawPiece::ConstantSpeed { to, speed: rate }
        } else {
            LawPiece::ConstantAcceleration {
                to,
                acceleration: rate,
            }
        })
    }

    /// `law = "cycloidal"` with `in`.
    fn standard(&self, cx: &mut Context<'_>, node: &'d Node) -> Option<Law> {
        self.idle(
            cx,
            &["speed", "acceleration"],
            "the law and `in` say how fast",
        );
        let by = rise_law(cx, self.entry, "law", node);
        let limits = self.limits(cx);
        let duration = duration(cx, self.entry);
        let (from, to) = limits?;
        Some(Law {
            pieces: vec![LawPiece::Rise {
                to,
                duration: duration?,
                by: by?,
            }],
            from,
        })
    }

    /// `law = [ { dwell = … }, { rise = …, in = …, by = … } ]`.
    fn sequence(&self, cx: &mut Context<'_>, pieces: &'d [Node], span: &Span) -> Option<Law> {
        let start = self.from(cx)?;
        if pieces.is_empty() || pieces.len() > MAX_PIECES {
            let message = format!("{}: a sequence of {} pieces", self.place, pieces.len());
            let help = format!(
                "write law = [ {{ dwell = \"0.1 s\" }}, {{ rise = \"30 deg\", in = \"0.3 s\" }} ], at most {MAX_PIECES} pieces"
            );
            return cx.refuse("bad-law", message, span, help);
        }
        let mut from = start.clone();
        let mut read = Vec::with_capacity(pieces.len());
        let mut whole = true;
        for node in pieces {
            let place = format!("a piece of the law of {}", self.place);
            let piece = Entry::inner(cx, node, &node.span, place, &PIECE).and_then(|mut piece| {
                piece.turning = self.entry.turning;
                self.piece(cx, &piece, node, &from)
            });
            let Some(piece) = piece else {
                whole = false;
                continue;
            };
            if let LawPiece::Rise { to, .. }
            | LawPiece::ConstantSpeed { to, .. }
            | LawPiece::ConstantAcceleration { to, .. } = &piece
            {
                from = to.clone();
                self.check_coordinate(cx, to, &node.span);
            }
            read.push(piece);
        }
        whole.then_some(Law {
            pieces: read,
            from: start,
        })
    }

    /// Keys of a piece that would not be looked at.
    fn contradictions(&self, cx: &mut Context<'_>, piece: &Entry<'_>, end: &str) {
        let (says, idle): (&str, &[&str]) = if end == "dwell" {
            ("dwell", &["in", "by", "speed", "acceleration"])
        } else if piece.has("speed") {
            ("speed", &["in", "by", "acceleration"])
        } else if piece.has("acceleration") {
            ("acceleration", &["in", "by"])
        } else {
            return;
        };
        let why = match says {
            "dwell" => "`dwell` is the time for which it stands still".to_owned(),
            _ => format!("`{says}` says how it moves"),
        };
        for key in piece.given(idle) {
            cx.push(
                Diagnostic::error(
                    "over-specified",
                    format!("{}: this piece needs no `{}`", self.place, key.name),
                )
                .at(key.span.clone(), why.clone())
                .help(format!("leave `{}` out, or `{says}`", key.name)),
            );
        }
    }

    fn piece(
        &self,
        cx: &mut Context<'_>,
        piece: &Entry<'_>,
        node: &Node,
        from: &Scalar,
    ) -> Option<LawPiece> {
        let ends: Vec<&str> = ["dwell", "rise", "fall", "to"]
            .into_iter()
            .filter(|k| piece.has(k))
            .collect();
        let [end] = ends.as_slice() else {
            cx.push(
                Diagnostic::error("bad-law", format!("{}: a piece is one of `dwell`, `rise`, `fall` and `to`", self.place))
                    .at(node.span.clone(), if ends.is_empty() { "none of them here" } else { "several of them here" })
                    .help("write { dwell = \"0.1 s\" }, { rise = \"30 deg\", in = \"0.3 s\" }, { fall = … } or { to = … }"),
            );
            return None;
        };
        let value = piece.get(end)?;
        self.contradictions(cx, piece, end);
        if *end == "dwell" {
            let duration = cx.positive(value, Dimension::TIME, "a dwell", false)?;
            return Some(LawPiece::Dwell { duration });
        }
        let by_how_much = match *end {
            "to" => self.coordinate_anywhere(cx, value)?,
            _ => cx.scalar(value, self.dimension)?,
        };
        let to = match (*end, from, by_how_much) {
            ("to", _, to) => to,
            ("rise", Expr::Const(a), Expr::Const(b)) => Expr::Const(a + b),
            (_, Expr::Const(a), Expr::Const(b)) => Expr::Const(a - b),
            ("rise", a, b) => Expr::Add(Box::new(a.clone()), Box::new(b)),
            (_, a, b) => Expr::Sub(Box::new(a.clone()), Box::new(b)),
        };
        cx.bound(
            &way(from, &to),
            &value.span,
            &format!("{}: the way of this piece", self.place),
            self.dimension,
            Keeps::NotZero,
        );
        if cx.number(&to) == cx.number(from) {
            return cx.refuse(
                "no-motion",
                format!(
                    "{}: this piece starts and ends at the same place",
                    self.place
                ),
                &value.span,
                "to stand still, write { dwell = \"0.1 s\" }",
            );
        }
        let limits = (from.clone(), to.clone());
        match (piece.get("speed"), piece.get("acceleration")) {
            (Some(node), _) => return self.moving(cx, node, 1, Some(&limits)),
            (None, Some(node)) => return self.moving(cx, node, 2, Some(&limits)),
            (None, None) => {}
        }
        let duration = duration(cx, piece);
        let by = match piece.get("by") {
            None => Some(RiseLaw::Cycloidal),
            Some(node) => rise_law(cx, piece, "by", node),
        };
        Some(LawPiece::Rise {
            to,
            duration: duration?,
            by: by?,
        })
    }
}

/// Whether an expression has a name in it.
fn names(text: &str, name: &str) -> bool {
    let mut words = text.split(|c: char| !c.is_alphanumeric() && c != '_');
    words.any(|word| word == name)
}

/// The dimension of the `order`-th rate of a coordinate.
pub(crate) fn rate(coordinate: Dimension, order: i32) -> Dimension {
    let per = Dimension::TIME.powi(order).unwrap_or(Dimension::TIME);
    coordinate / per
}

/// The time in which something moves, which must be there.
fn duration(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<Scalar> {
    entry.required_like(cx, "in", entry.example_of("in"))?;
    entry.needed(cx, "in")
}

fn rise_law<'d>(
    cx: &mut Context<'_>,
    entry: &Entry<'d>,
    key: &str,
    node: &'d Node,
) -> Option<RiseLaw> {
    let text = entry.text(cx, key, node)?;
    let name = text.content.trim();
    if let Some((_, law)) = LAWS.iter().find(|(word, _)| *word == name) {
        return Some(*law);
    }
    let names = LAWS.map(|(name, _)| name);
    let help = match kempe_units::nearest(name, names) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("the laws are {}", names.join(", ")),
    };
    cx.push(
        Diagnostic::error("bad-law", format!("there is no law `{name}`"))
            .at(text.span(0..text.content.len()), "")
            .help(help),
    );
    None
}

/// Refuses a coordinate of a cylinder that is no length: that is positive.
pub(crate) fn length_of_cylinder(
    cx: &mut Context<'_>,
    place: &str,
    scalar: &Scalar,
    span: &Span,
) -> Option<()> {
    if cx.number(scalar) > 0.0 {
        let what = format!("{place}: a cylinder's length");
        cx.bound(scalar, span, &what, Dimension::LENGTH, Keeps::Positive);
        return Some(());
    }
    cx.refuse(
        "bad-size",
        format!("{place}: a cylinder's length must be positive"),
        span,
        "the coordinate of a cylinder is the distance of its two points, not its stroke",
    )
}

/// How far it is from one place to another.
fn way(from: &Scalar, to: &Scalar) -> Scalar {
    Expr::Sub(Box::new(to.clone()), Box::new(from.clone()))
}
