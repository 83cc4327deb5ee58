//! The codes of diagnostics: stable, so that scripts and searches may rely on them.

/// A code with what it means.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[non_exhaustive]
pub struct Code {
    /// The code, in kebab-case.
    pub code: &'static str,
    /// What it means, in one sentence.
    pub meaning: &'static str,
}

const fn code(code: &'static str, meaning: &'static str) -> Code {
    Code { code, meaning }
}

/// All codes that reading a model file may give, in alphabetical order.
#[rustfmt::skip]
pub const CODES: &[Code] = &[
    code("ambiguous-name", "a name behind a number could be a unit or something declared"),
    code("ambiguous-transmission", "more or fewer than two links meet at a pin, so that its transmission angle needs the ends named"),
    code("bad-choice", "a word that is not among those that may stand at its place"),
    code("bad-exponent", "a power whose exponent is not a fitting constant"),
    code("bad-law", "a motion law or a piece of one cannot be read"),
    code("bad-line", "a point, a directed line `A -> B` or a pair `A-B` was expected"),
    code("bad-name", "a name breaks the rules: points start with a capital letter, everything else with a small one"),
    code("bad-side", "`left of A -> B` or `right of A -> B` was expected"),
    code("bad-size", "a value that must be positive is zero or negative"),
    code("contradictory-values", "two values that cannot both be right"),
    code("cyclic-measure", "measures that depend on each other in a circle"),
    code("cyclic-parameter", "parameters that depend on each other in a circle"),
    code("driven-twice", "two drives move the same thing"),
    code("duplicate-name", "a name is written twice in one table"),
    code("empty-link", "a link without points"),
    code("force-depends-on-force", "a load that depends on a force"),
    code("idle-hint", "a hint on the assembly that leaves nothing to choose"),
    code("idle-key", "a key that means nothing without another"),
    code("idle-load", "a load or a mass on the frame, which stands still"),
    code("loose-link", "a link that nothing holds: no pin, no joint"),
    code("missing-key", "something that must be said is missing"),
    code("name-clash", "one name for two things"),
    code("needs-forces-study", "a motion study asks for a force"),
    code("no-common-link", "two points that should be on one link are not"),
    code("no-common-point", "two links that should share a point do not"),
    code("no-derivative", "the derivative of a force to a drive"),
    code("no-drive", "a motion study in a file without drives"),
    code("no-frame", "the file has no link called `frame`"),
    code("no-inertia", "a link that turns has a mass but no moment of inertia"),
    code("no-motion", "a drive or a piece of its law starts and ends at the same place"),
    code("not-a-pin", "a point that is no pin, because only one link carries it"),
    code("not-a-slider", "something should slide along a line, but does not"),
    code("not-a-value", "a link, a joint, a point or a line stands where a value is needed"),
    code("not-at-one-instant", "a number over the whole motion stands where a value at every instant is needed"),
    code("not-finite", "a value is infinite or not a number"),
    code("not-placed", "a point whose place on its link is not determined"),
    code("not-utf8", "the file is not UTF-8 text"),
    code("over-specified", "something is said twice, or more is said than there is to say"),
    code("point-not-on-link", "a point is not a point of the link that is meant"),
    code("same-link", "a joint or a drive between a link and itself"),
    code("section-not-available", "the section is part of the language, but not of this version: it is skipped"),
    code("side-missing", "a point by two distances whose side is not said, or said of another line"),
    code("study-not-available", "the kind of study is part of the language, but not of this version: it is skipped"),
    code("syntax", "an expression cannot be read"),
    code("table-column", "a table of measured motion has no such column"),
    code("table-unreadable", "a table of measured motion cannot be read"),
    code("table-values", "a table of measured motion has a bad row or too few of them"),
    code("toml-syntax", "the file is not TOML"),
    code("too-deep", "an expression is nested too deeply"),
    code("too-large", "the file, or what it asks for, is beyond the limits"),
    code("too-long", "an expression is too long"),
    code("triangle-open", "a triangle whose sides cannot close"),
    code("unit-mismatch", "a value measures something else than what is expected"),
    code("unknown-function", "neither a function nor a measure"),
    code("unknown-key", "a key that is not known at its place"),
    code("unknown-name", "nothing of this kind has this name"),
    code("unknown-study", "there is no such kind of study"),
    code("unknown-unit", "there is no such unit"),
    code("unlikely-size", "a value so large or small that another unit is likely meant"),
    code("wrong-arguments", "a function got arguments it does not take"),
    code("wrong-direction", "the sign of a speed contradicts the limits of its drive"),
    code("wrong-drive", "a drive of another kind is meant"),
    code("wrong-type", "a value of another type was expected"),
];
