//! The parser: every production of the grammar, how things bind, errors, limits.

use kempe_units::{
    Kind, MAX_DEPTH, MAX_LENGTH, Node, Unit, parse, parse_argument, parse_condition,
};

fn text(source: &str) -> String {
    parse(source)
        .unwrap_or_else(|errors| panic!("{source}: {errors:?}"))
        .to_string()
}

/// Code, marked text, and message with help of every error.
fn errors(source: &str) -> Vec<(&'static str, String, String)> {
    let errors = parse(source).expect_err(source);
    errors
        .into_iter()
        .map(|e| (e.code, source[e.span.clone()].to_owned(), e.to_string()))
        .collect()
}

#[test]
fn every_production_has_an_example() {
    let examples: &[(&str, &[&str])] = &[
        (
            "condition",
            &["range(y(M)) >= 450 mm", "a <= b", "2 < 3", "a > 1 mm + b"],
        ),
        (
            "comparison",
            &["a <= b", "a >= b", "a < b", "a > b", "a ≤ b", "a ≥ b"],
        ),
        ("expression", &["a", "a + b", "a - b + c"]),
        ("term", &["a * b", "a·b", "a / b * c"]),
        ("factor", &["-a", "--a", "+a", "a^b"]),
        ("power", &["a^2", "a^-2", "a^b^c", "a²", "a⁻¹"]),
        ("atom", &["5", "5 mm", "a", "A", "f(a)", "(a + b)"]),
        ("call", &["f()", "f(a)", "f(a, 2 mm)"]),
        ("argument", &["A -> B", "A - B", "angle(rocker)"]),
        (
            "unit",
            &["1 mm", "1 N m", "1 N*m", "1 N·m", "1 m/s", "1 kg mm^2/s^2"],
        ),
        ("unit-power", &["1 m", "1 m^2", "1 s^-1", "1 m²", "1 s⁻¹"]),
        ("number", &["1", "1.5", "1.", ".5", "1e3", "1.5E-3", "2e+2"]),
        ("raised", &["a²", "a⁻¹²"]),
        ("name", &["a", "crank_1", "_x", "größe"]),
        ("point", &["A", "B2", "Äußerer"]),
    ];
    let grammar = include_str!("../../src/parser.rs");
    let productions: Vec<&str> = grammar
        .lines()
        .skip_while(|line| *line != "//! ```text")
        .take_while(|line| *line != "//! ```")
        .filter_map(|line| {
            line.strip_prefix("//! ")?
                .split_once(" = ")
                .map(|(name, _)| name.trim())
        })
        .collect();
    assert_eq!(productions.len(), examples.len());
    for (production, (name, texts)) in productions.iter().zip(examples) {
        assert_eq!(production, name);
        for text in *texts {
            let ok = match *name {
                "condition" | "comparison" => parse_condition(text).is_ok(),
                "argument" => parse_argument(text).is_ok(),
                _ => parse(text).is_ok(),
            };
            assert!(ok, "{name}: {text}");
        }
    }
}

#[test]
fn operators_bind_as_in_mathematics() {
    for (source, bracketed) in [
        ("a+b*c", "a + b * c"),
        ("(a+b)*c", "(a + b) * c"),
        ("a-b-c", "a - b - c"),
        ("a-(b-c)", "a - (b - c)"),
        ("a/b/c", "a / b / c"),
        ("a/(b*c)", "a / (b * c)"),
        ("-a^2", "-a^2"),
        ("(-a)^2", "(-a)^2"),
        ("a^b^c", "a^b^c"),
        ("(a^b)^c", "(a^b)^c"),
        ("2^-b", "2^(-b)"),
        ("-a*b", "-a * b"),
        ("-(a*b)", "-(a * b)"),
        ("a*-b", "a * -b"),
        ("+5 mm", "5 mm"),
        ("a - +b", "a - b"),
        ("-+a^2", "-a^2"),
        ("a³", "a^3"),
        ("((a))", "a"),
        ("f(a,g( b ),A->B, A-B)", "f(a, g(b), A -> B, A - B)"),
    ] {
        assert_eq!(text(source), bracketed);
        assert_eq!(text(bracketed), bracketed);
    }
    let value = parse("-2^2").unwrap();
    assert!(matches!(value.kind, Kind::Neg(_)));
}

#[test]
fn a_unit_binds_to_the_number_before_it() {
    for (source, bracketed) in [
        ("5mm", "5 mm"),
        ("9.81 m/s^2", "9.81 m/s^2"),
        ("9.81 m / s^2", "9.81 m/s^2"),
        ("3 N*m", "3 N m"),
        ("3 N m", "3 N m"),
        ("2*crank + 5 mm", "2 * crank + 5 mm"),
        ("5 mm * crank", "5 mm * crank"),
        ("5 mm / crank", "5 mm / crank"),
        ("5 mm * s(a)", "5 mm * s(a)"),
        ("5 mm / 2 s", "5 mm / 2 s"),
        ("2*s", "2 * s"),
        ("(5 m)/s", "(5 m) / s"),
        ("(5 m)/(s + a)", "5 m / (s + a)"),
        ("(5 m)/s^2", "(5 m) / s^2"),
        ("(a * 5 m)/s", "(a * 5 m) / s"),
        ("(5 mm)^2", "(5 mm)^2"),
        ("5 mm^2", "5 mm^2"),
        ("5 mm²", "5 mm^2"),
        ("30°", "30 deg"),
        ("5 %", "5 %"),
        ("10 µm", "10 um"),
        ("677.5636 kg mm^2", "677.5636 kg mm^2"),
    ] {
        assert_eq!(text(source), bracketed);
        assert_eq!(text(bracketed), bracketed);
    }
    let Kind::Quantity(quantity) = parse("2 m/s*kg").unwrap().kind else {
        panic!()
    };
    assert_eq!(quantity.unit, Unit::parse("m kg/s").unwrap());
    let joined: Vec<_> = quantity
        .joined
        .iter()
        .map(|j| (j.name.as_str(), j.span.clone(), j.tight_division))
        .collect();
    assert_eq!(joined, [("s", 4..5, true), ("kg", 6..8, false)]);
    let Kind::Quantity(quantity) = parse("2 m /s").unwrap().kind else {
        panic!()
    };
    assert!(!quantity.joined[0].tight_division);
}

#[test]
fn nodes_know_where_they_stand() {
    let source = "2 * (a + 5 mm) - f(A -> B)";
    let mut seen = Vec::new();
    parse(source)
        .unwrap()
        .visit(&mut |node: &Node| seen.push(source[node.span.clone()].to_owned()));
    let expected = [
        source,
        "2 * (a + 5 mm)",
        "2",
        "a + 5 mm",
        "a",
        "5 mm",
        "f(A -> B)",
        "A -> B",
        "A",
        "B",
    ];
    assert_eq!(seen, expected);
    assert_eq!(parse(source).unwrap().names(), [("a", 5..6)]);
}

#[test]
fn pairs_lines_and_bare_numbers() {
    assert_eq!(parse("A-B").unwrap().as_pair(), Some(("A", "B")));
    assert_eq!(parse("A-b").unwrap().as_pair(), None);
    assert_eq!(
        parse_argument("E -> F").unwrap().as_line(),
        Some(("E", "F"))
    );
    assert_eq!(parse("-0.4").unwrap().as_bare_number(), Some(-0.4));
    assert_eq!(parse("0.4*1").unwrap().as_bare_number(), None);
    assert_eq!(parse("C").unwrap().as_point(), Some("C"));
}

#[test]
fn errors_say_where_and_what() {
    for (source, code, marked, message) in [
        (
            "",
            "syntax",
            "",
            "the text ends where a value is expected (write a value, such as `20 mm` or `2 * a`)",
        ),
        (
            "2 +",
            "syntax",
            "",
            "the text ends where a value is expected (write the value that is missing, or leave out what stands before it)",
        ),
        (
            "(a",
            "syntax",
            "(",
            "this bracket is not closed (add the `)` that belongs to it)",
        ),
        (
            "f(a",
            "syntax",
            "(",
            "this bracket is not closed (add the `)` that belongs to it)",
        ),
        (
            "a)",
            "syntax",
            ")",
            "a bracket is closed that was not opened (leave it out, or open one with `(` before it)",
        ),
        (
            "a b",
            "syntax",
            "b",
            "an operator is missing before this (for a product write `a * b`)",
        ),
        (
            "5 mm 3 mm",
            "syntax",
            "3",
            "an operator is missing before this (for a product write `* 3`)",
        ),
        (
            "2 1/mm",
            "syntax",
            "1",
            "an operator is missing before this (for the inverse of a unit write `/ 1 mm`)",
        ),
        (
            "2 crank",
            "unknown-unit",
            "crank",
            "unknown unit `crank` (for a product write `2*crank`)",
        ),
        (
            "2 pi",
            "syntax",
            "pi",
            "an operator is missing before this (for a product write `2*pi`)",
        ),
        (
            "2 sin(a)",
            "syntax",
            "sin",
            "an operator is missing before this (for a product write `2*sin`)",
        ),
        (
            "2 mmm",
            "unknown-unit",
            "mmm",
            "unknown unit `mmm` (did you mean `mm`?)",
        ),
        (
            "1,5",
            "syntax",
            "1,5",
            "a comma stands in a number (decimals have a point: 1.5)",
        ),
        (
            "a ** 2",
            "syntax",
            "*",
            "two operators stand side by side (a power is written `^`)",
        ),
        (
            "2 × a",
            "syntax",
            "×",
            "`×` has no meaning here (times is written `*`)",
        ),
        (
            "a $ b",
            "syntax",
            "$",
            "`$` has no meaning here (names are made of letters, digits and `_`; leave this out)",
        ),
        (
            "a # b",
            "syntax",
            "#",
            "`#` has no meaning here (leave it out: a comment stands behind the closing quote)",
        ),
        (
            "@",
            "syntax",
            "@",
            "`@` has no meaning here (names are made of letters, digits and `_`; leave this out)",
        ),
        (
            "a == b",
            "syntax",
            "==",
            "`==` has no meaning here (what is to be equal takes two conditions, one with `<=` and one with `>=`)",
        ),
        (
            "“20 mm",
            "syntax",
            "“",
            "`“` has no meaning here (leave it out: a value stands between two plain double quotes and holds none itself)",
        ),
        (
            "20\u{200b}mm",
            "syntax",
            "\u{200b}",
            "`\\u{200b}` has no meaning here (a sign that does not show, perhaps from a copied text: type the value again)",
        ),
        (
            "pi rad",
            "syntax",
            "rad",
            "an operator is missing before this (a unit stands behind a number: write `pi * 1 rad`)",
        ),
        (
            "(1/4) rev",
            "syntax",
            "rev",
            "an operator is missing before this (a unit stands behind a number: write `* 1 rev`)",
        ),
        (
            "(a b)",
            "syntax",
            "b",
            "an operator is missing before this (for a product write `a * b`)",
        ),
        (
            "(a < b)",
            "syntax",
            "<",
            "a comparison has no place here (a value is wanted: `max(x, y)` and `min(x, y)` choose one of two)",
        ),
        (
            "a * / b",
            "syntax",
            "/",
            "a value is expected here (a value is missing between this and what stands before it)",
        ),
        (
            "5 rpms",
            "unknown-unit",
            "rpms",
            "unknown unit `rpms` (did you mean `rpm`?)",
        ),
        (
            "5 slug",
            "unknown-unit",
            "slug",
            "unknown unit `slug` (write `72.9695 kg`)",
        ),
        (
            "5 furlong",
            "unknown-unit",
            "furlong",
            "unknown unit `furlong` (for a product write `5*furlong`)",
        ),
        (
            "atan2(a; b)",
            "syntax",
            ";",
            "`;` has no meaning here (arguments are parted by `,`: `atan2(y, x)`)",
        ),
        (
            "f(a,)",
            "syntax",
            ")",
            "an argument is expected after the comma (write it, or leave the comma out)",
        ),
        (
            "f(a b)",
            "syntax",
            "b",
            "an operator is missing before this (for a product write `a * b`)",
        ),
        (
            "A -> B",
            "syntax",
            "->",
            "a directed line stands only as an argument (such as in `angle(A -> B)`)",
        ),
        (
            "5 mm^2^2",
            "syntax",
            "^",
            "this power could be of the unit or of the quantity (set the quantity in brackets to raise it: `(5 mm^2)^2`)",
        ),
        (
            "5 mm^a",
            "syntax",
            "a",
            "the power of a unit is a whole number (set the quantity in brackets to raise it: `(5 mm)^n`)",
        ),
        (
            "a <= b",
            "syntax",
            "<=",
            "a comparison has no place here (a value is wanted: `max(x, y)` and `min(x, y)` choose one of two)",
        ),
        (
            "1e999",
            "syntax",
            "1e999",
            "this number is too large (numbers go up to about 1e308: look for a wrong exponent or a missing point)",
        ),
        (
            "1e308 km",
            "syntax",
            "1e308",
            "this number is too large (numbers go up to about 1e308: look for a wrong exponent or a missing point)",
        ),
        (
            "2π",
            "syntax",
            "π",
            "`π` has no meaning here (the constant is called `pi`)",
        ),
    ] {
        let found = errors(source);
        assert_eq!(found.len(), 1, "one error to a cause: {source}: {found:?}");
        assert_eq!(found[0].2, message, "{source}");
        assert_eq!(found[0].0, code, "{source}");
        assert_eq!(found[0].1, marked, "{source}");
        assert!(found[0].2.ends_with(')'), "{source} has no remedy");
    }
}

#[test]
fn all_errors_are_found() {
    let found = errors("f(2 mmm, a b, 3 furlong) + 4 dge");
    let marked: Vec<&str> = found.iter().map(|(_, marked, _)| marked.as_str()).collect();
    assert_eq!(marked, ["mmm", "b", "furlong", "dge"]);
    assert_eq!(
        errors("f(a -> B)")[0].2,
        "a directed line goes from a point to a point (such as `A -> B`; points start with a capital letter)"
    );
}

#[test]
fn conditions() {
    let condition = parse_condition("min(transmission_angle(K)) >= 30 deg").unwrap();
    assert_eq!(
        condition.to_string(),
        "min(transmission_angle(K)) >= 30 deg"
    );
    let message = |source| parse_condition(source).unwrap_err()[0].to_string();
    assert_eq!(
        message("a + b"),
        "a condition needs a comparison (such as `max(load) <= 80 kN`)"
    );
    assert_eq!(
        message("1 < a < 2"),
        "a condition has one comparison (write two conditions for two bounds)"
    );
    assert_eq!(
        message("a == b"),
        "`==` has no meaning here (what is to be equal takes two conditions, one with `<=` and one with `>=`)"
    );
    assert_eq!(
        message("a <="),
        "the text ends where a value is expected (write the value that is missing, or leave out what stands before it)"
    );
    assert!(message("(a < b) < c").starts_with("a comparison has no place here"));
}

#[test]
fn hostile_texts_meet_a_limit() {
    let code = |source: String| parse(&source).unwrap_err()[0].code;
    assert_eq!(code("(".repeat(MAX_LENGTH)), "too-deep");
    assert_eq!(code("-".repeat(MAX_LENGTH)), "too-deep");
    assert_eq!(code("+".repeat(MAX_LENGTH)), "too-deep");
    assert_eq!(code("f(".repeat(MAX_LENGTH / 2)), "too-deep");
    assert_eq!(code("a^".repeat(MAX_LENGTH / 2)), "too-deep");
    assert_eq!(code("a+".repeat(MAX_LENGTH / 2 - 1) + "a"), "too-deep");
    assert_eq!(code("a".repeat(MAX_LENGTH + 1)), "too-long");
    assert!(parse(&("(".repeat(MAX_DEPTH - 1) + "a" + &")".repeat(MAX_DEPTH - 1))).is_ok());
    assert!(parse(&("a+".repeat(MAX_DEPTH - 1) + "a")).is_ok());
    assert!(parse(&"a".repeat(MAX_LENGTH)).is_ok());
    assert!(parse(&"$".repeat(MAX_LENGTH)).unwrap_err().len() <= 16);
}
