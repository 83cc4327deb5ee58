//! Names and dimensions: a small file with parameters, points and measures.

use kempe_units::{
    Dimension, Expr, Issue, Node, Resolver, Span, Unit, check, check_as, check_condition, parse,
    parse_condition,
};

/// What the test file declares.
struct File;

const NAMES: &[(&str, Dimension)] = &[
    ("crank", Dimension::LENGTH),
    ("radius", Dimension::LENGTH),
    ("theta", Dimension::ANGLE),
    ("omega", Dimension::ANGULAR_SPEED),
    ("load", Dimension::FORCE),
    ("moment", Dimension::TORQUE),
    ("ratio", Dimension::NONE),
    ("inertia", Dimension::INERTIA),
    ("s", Dimension::LENGTH),
    ("m", Dimension::LENGTH),
];

impl Resolver<String> for File {
    fn name(&mut self, name: &str, span: Span) -> Result<(String, Dimension), Issue> {
        match NAMES.iter().find(|(known, _)| *known == name) {
            Some((_, dimension)) => Ok((name.to_owned(), *dimension)),
            None => Err(Issue::unknown_name(
                name,
                span,
                NAMES.iter().map(|(known, _)| *known),
            )),
        }
    }

    fn call(
        &mut self,
        function: &str,
        arguments: &[Node],
        span: Span,
    ) -> Option<Result<(String, Dimension), Vec<Issue>>> {
        let text = |node: &Node| node.to_string();
        Some(match (function, arguments) {
            ("x" | "y", [point]) => match point.as_point() {
                Some(point) => Ok((format!("{function}({point})"), Dimension::LENGTH)),
                None => Err(vec![Issue::new(
                    "not-a-point",
                    point.span.clone(),
                    "a point is expected",
                )]),
            },
            ("angle", [link]) => Ok((format!("angle({})", text(link)), Dimension::ANGLE)),
            ("d", [of, by]) => match (check(of, self), by.as_name()) {
                (Ok((_, of_is)), Some(_)) => Ok((
                    format!("d({}, {})", text(of), text(by)),
                    of_is / Dimension::ANGLE,
                )),
                (Err(issues), _) => Err(issues),
                (_, None) => Err(vec![Issue::new(
                    "not-a-drive",
                    by.span.clone(),
                    "a drive is expected",
                )]),
            },
            ("rate", [of]) => {
                check(of, self).map(|(_, is)| (format!("rate({})", text(of)), is / Dimension::TIME))
            }
            ("min" | "max" | "range", [of]) => {
                check(of, self).map(|(_, is)| (format!("{function}({})", text(of)), is))
            }
            ("distance", [a, b]) => match (a.as_point(), b.as_point()) {
                (Some(a), Some(b)) => Ok((format!("distance({a}, {b})"), Dimension::LENGTH)),
                _ => Err(vec![Issue::new("not-a-point", span, "points are expected")]),
            },
            _ => return None,
        })
    }

    fn declared(&self, name: &str) -> bool {
        NAMES.iter().any(|(known, _)| *known == name)
    }

    fn functions(&self) -> Vec<String> {
        ["x", "y", "angle", "d", "rate", "range", "distance"]
            .map(str::to_owned)
            .to_vec()
    }
}

fn measured(text: &str) -> Result<(Expr<String>, Dimension), Vec<Issue>> {
    check(
        &parse(text).unwrap_or_else(|errors| panic!("{text}: {errors:?}")),
        &mut File,
    )
}

fn dimension(text: &str) -> Dimension {
    measured(text)
        .unwrap_or_else(|issues| panic!("{text}: {issues:?}"))
        .1
}

/// Code, marked text, and message with help of every issue.
fn issues(text: &str) -> Vec<(&'static str, String, String)> {
    let issues = measured(text).expect_err(text);
    issues
        .into_iter()
        .map(|i| (i.code, text[i.span.clone()].to_owned(), i.to_string()))
        .collect()
}

#[test]
fn dimensions_of_sound_expressions() {
    for (text, expected) in [
        ("2*crank + 5 mm", Dimension::LENGTH),
        ("crank^2 + radius*crank", Dimension::AREA),
        ("sqrt(crank^2 + radius^2)", Dimension::LENGTH),
        ("(crank^2 + radius^2)^(1/2)", Dimension::LENGTH),
        ("(crank^3)^(1/3)", Dimension::LENGTH),
        ("crank^-1", Dimension::CURVATURE),
        ("hypot(crank, radius)", Dimension::LENGTH),
        ("atan2(crank, radius)", Dimension::ANGLE),
        ("atan2(crank, radius) + 30 deg", Dimension::ANGLE),
        ("crank*sin(theta + 30 deg)", Dimension::LENGTH),
        ("asin(crank/radius)", Dimension::ANGLE),
        ("moment*omega + 5 W", Dimension::POWER),
        ("omega^2*crank - 9.81 m/s^2", Dimension::ACCELERATION),
        ("moment/crank + load", Dimension::FORCE),
        ("inertia*omega^2 + 1 J", Dimension::ENERGY),
        ("max(crank, radius, 10 mm)", Dimension::LENGTH),
        ("max(crank)", Dimension::LENGTH),
        ("abs(-load)", Dimension::FORCE),
        ("exp(-ratio) + ln(crank/radius)", Dimension::NONE),
        ("ratio^ratio", Dimension::NONE),
        ("ratio^0.3", Dimension::NONE),
        ("2*pi*1 rad", Dimension::ANGLE),
        ("100 rpm - omega", Dimension::ANGULAR_SPEED),
        ("5 % + ratio", Dimension::NONE),
        (
            "d(angle(lower), lift) / d(angle(arm), lift)",
            Dimension::NONE,
        ),
        ("moment / abs(d(distance(B, D), turn))", Dimension::FORCE),
        ("rate(y(C))", Dimension::SPEED),
        ("2*s", Dimension::LENGTH),
        ("20 mm/s", Dimension::SPEED),
        ("-20 mm/s", Dimension::SPEED),
        ("5 N m + moment", Dimension::TORQUE),
    ] {
        let found = dimension(text);
        assert!(found.compatible(expected), "{text}: {found}");
    }
    // The radian stays where it counts.
    assert_eq!(dimension("omega*crank/crank"), Dimension::ANGULAR_SPEED);
    assert_eq!(
        dimension("(omega^2*crank + 1 m/s^2)"),
        Dimension::ACCELERATION
    );
}

#[test]
fn issues_name_both_sides() {
    for (text, code, marked, message) in [
        (
            "2*crank + 5",
            "unit-mismatch",
            "5",
            "a length plus a number (give it a unit: write `5 mm`)",
        ),
        (
            "5 - crank",
            "unit-mismatch",
            "5",
            "a number minus a length (give it a unit: write `5 mm`)",
        ),
        (
            "omega - 5",
            "unit-mismatch",
            "5",
            "an angular speed minus a number (give it a unit: write `5 deg/s`)",
        ),
        (
            "crank + theta",
            "unit-mismatch",
            "theta",
            "a length plus an angle (both must measure the same; an angle times a length is a length)",
        ),
        (
            "theta + ratio",
            "unit-mismatch",
            "ratio",
            "an angle plus a number (a number is made an angle by `* 1 deg` or `* 1 rad`, an angle a number by `/ 1 rad`)",
        ),
        (
            "omega + 5 Hz",
            "unit-mismatch",
            "5 Hz",
            "an angular speed plus a frequency (turns per second are `rev/s`: multiply the frequency by `1 rev`, or by `1 rad` if it is an angular one)",
        ),
        (
            "sin(crank)",
            "unit-mismatch",
            "crank",
            "`sin` takes an angle, found a length (an arc is made an angle by dividing it by its radius and `* 1 rad`; sides give one by `atan2(y, x)`, such as `sin(atan2(y, x))`)",
        ),
        (
            "sin(0.5)",
            "unit-mismatch",
            "0.5",
            "`sin` takes an angle, found a number (give it a unit: write `sin(0.5 deg)` or `sin(0.5 rad)`)",
        ),
        (
            "sin(2*ratio)",
            "unit-mismatch",
            "2*ratio",
            "`sin` takes an angle, found a number (a number is made an angle by `* 1 deg` where it counts degrees, by `* 1 rad` where it is an arc over its radius)",
        ),
        (
            "moment + load",
            "unit-mismatch",
            "load",
            "a torque plus a force (both must measure the same; a force times a length is a torque)",
        ),
        (
            "log(ratio)",
            "unknown-function",
            "log",
            "unknown function `log` (`ln(x)` is the natural logarithm; to the base 10 write `ln(x) / ln(10)`)",
        ),
        (
            "floor(ratio)",
            "unknown-function",
            "floor",
            "unknown function `floor` (the functions are sin, cos, tan, asin, acos, atan, atan2, sqrt, abs, exp, ln, min, max, hypot, and the questions that `kempe measures` tells)",
        ),
        (
            "asin(theta)",
            "unit-mismatch",
            "theta",
            "`asin` takes a number, found an angle (`asin` is of a number: divide the angle by `1 rad`)",
        ),
        (
            "exp(crank)",
            "unit-mismatch",
            "crank",
            "`exp` takes a number, found a length (divide by a quantity of the same kind)",
        ),
        (
            "max(crank, theta)",
            "unit-mismatch",
            "theta",
            "`max` of a length and an angle (both must measure the same; an angle times a length is a length)",
        ),
        (
            "max(crank, 5)",
            "unit-mismatch",
            "5",
            "`max` of a length and a number (give it a unit: write `5 mm`)",
        ),
        (
            "crnak",
            "unknown-name",
            "crnak",
            "unknown name `crnak` (did you mean `crank`?)",
        ),
        (
            "2*mm",
            "unknown-name",
            "mm",
            "unknown name `mm` (a unit stands after a number: write `1 mm`)",
        ),
        (
            "zzz",
            "unknown-name",
            "zzz",
            "unknown name `zzz` (known here: crank, radius, theta, omega, load, moment, ratio, inertia, s, m)",
        ),
        (
            "rnage(crank)",
            "unknown-function",
            "rnage",
            "unknown function `rnage` (did you mean `range`?)",
        ),
        (
            "sqtr(crank)",
            "unknown-function",
            "sqtr",
            "unknown function `sqtr` (did you mean `sqrt`?)",
        ),
        (
            "sin()",
            "wrong-arguments",
            "sin()",
            "`sin` does not take 0 arguments (it is called as `sin(angle)`)",
        ),
        (
            "atan2(crank)",
            "wrong-arguments",
            "atan2(crank)",
            "`atan2` does not take 1 argument (it is called as `atan2(y, x)`)",
        ),
        (
            "2*A",
            "not-a-value",
            "A",
            "the point `A` is not a value (take a measure of it, such as `x(A)`; names of parameters start with a small letter)",
        ),
        (
            "sqrt(A -> B)",
            "not-a-value",
            "A -> B",
            "a directed line is not a value (take a measure of it, such as `angle(A -> B)`; a difference is written `-`)",
        ),
        (
            "2^crank",
            "bad-exponent",
            "crank",
            "an exponent is a number, found a length (divide it by a quantity of the same kind)",
        ),
        (
            "crank^ratio",
            "bad-exponent",
            "ratio",
            "a length is raised to a constant only (only plain numbers have variable powers: divide the base by a quantity of its kind first)",
        ),
        (
            "crank^0.3",
            "bad-exponent",
            "crank^0.3",
            "a length has no power 0.3 (the exponents of a unit are whole numbers, halves, thirds or sixths)",
        ),
        (
            "ratio^1e9",
            "bad-exponent",
            "1e9",
            "an exponent is at most 1000 (write a smaller one, or use `exp` and `ln`)",
        ),
        (
            "ratio^(1/0)",
            "bad-exponent",
            "1/0",
            "an exponent is at most 1000 (write a smaller one, or use `exp` and `ln`)",
        ),
        ("x(crank)", "not-a-point", "crank", "a point is expected"),
    ] {
        let found = issues(text);
        assert_eq!(found.len(), 1, "one issue to a cause: {found:?}");
        assert_eq!(found[0].0, code, "{text}");
        assert_eq!(found[0].1, marked, "{text}");
        assert_eq!(found[0].2, message, "{text}");
        assert!(
            found[0].2.contains('(') || text == "x(crank)",
            "{text} has no remedy"
        );
    }
}

#[test]
fn all_issues_are_found_in_order() {
    let found = issues("sin(crank) + rate(zzz1) * (2 rad + 3 mm) - foo(1)");
    let codes: Vec<&str> = found.iter().map(|(code, ..)| *code).collect();
    assert_eq!(
        codes,
        [
            "unit-mismatch",
            "unknown-name",
            "unit-mismatch",
            "unknown-function"
        ]
    );
}

#[test]
fn a_unit_that_is_declared_too() {
    for text in [
        "radius + 5 mm * s",
        "20 mm / s",
        "20 mm /s",
        "5 N * m",
        "5 N*m",
        "-5 N·m",
    ] {
        let found = issues(text);
        assert_eq!(found[0].0, "ambiguous-name", "{text}: {found:?}");
    }
    for text in [
        "20 mm/s",
        "9.81 m/s^2 * 2",
        "20 mm s^-1",
        "(20 mm) / s",
        "5 N m",
        "5 s",
        "5 mm * crank",
    ] {
        assert!(measured(text).is_ok(), "{text}");
    }
    assert_eq!(dimension("20 mm/s"), Dimension::SPEED);
    assert_eq!(dimension("(20 mm)/s"), Dimension::NONE);
}

#[test]
fn the_place_gives_a_bare_number_its_unit() {
    let mm = Unit::parse("mm").unwrap();
    let deg = Unit::parse("deg").unwrap();
    let length = |text: &str| check_as(&parse(text).unwrap(), &mut File, Dimension::LENGTH, &mm);
    let angle = |text: &str| check_as(&parse(text).unwrap(), &mut File, Dimension::ANGLE, &deg);
    assert_eq!(length("57.5"), Ok((Expr::Const(0.0575), Dimension::LENGTH)));
    assert_eq!(
        length("-(13)"),
        Ok((Expr::Const(-0.013), Dimension::LENGTH))
    );
    assert_eq!(
        angle("180"),
        Ok((Expr::Const(std::f64::consts::PI), Dimension::ANGLE))
    );
    assert_eq!(length("2 cm"), Ok((Expr::Const(0.02), Dimension::LENGTH)));
    let message = |result: Result<(Expr<String>, Dimension), Vec<Issue>>| {
        let issues = result.unwrap_err();
        (issues[0].message.clone(), issues[0].label.clone())
    };
    assert_eq!(
        message(length("8 deg")),
        (
            "length expected, found an angle".into(),
            "this is an angle".into()
        )
    );
    assert_eq!(message(length("2*4")).0, "length expected, found a number");
    assert_eq!(message(angle("crank")).0, "angle expected, found a length");
    assert_eq!(message(length("2*crank + 5")).0, "a length plus a number");
    let inch = Unit::parse("in").unwrap();
    let issue = check_as(
        &parse("crank + 5").unwrap(),
        &mut File,
        Dimension::LENGTH,
        &inch,
    )
    .unwrap_err();
    assert_eq!(
        issue[0].help.as_deref(),
        Some("give it a unit: write `5 in`")
    );
}

#[test]
fn what_measures_something_else_comes_with_a_remedy() {
    for (text, dimension, unit, help) in [
        (
            "8 deg",
            Dimension::LENGTH,
            "mm",
            "a length is written like \"20 mm\"; an angle times a length is a length",
        ),
        (
            "30 mm",
            Dimension::ANGLE,
            "deg",
            "an angle is written like \"20 deg\"",
        ),
        (
            "2*ratio",
            Dimension::ANGLE,
            "deg",
            "give it a unit, here or where its parameters are declared: \"20 deg\"; a number is made an angle by `* 1 deg` or `* 1 rad`",
        ),
        (
            "1/4 rev",
            Dimension::ANGLE,
            "deg",
            "a unit binds tighter than `/`: write `0.25 rev` or `1/4 * 1 rev`",
        ),
        (
            "10 Hz",
            Dimension::ANGULAR_SPEED,
            "deg/s",
            "turns per second are written `10 rev/s`, radians per second `10 rad/s`",
        ),
        (
            "2*10 Hz",
            Dimension::ANGULAR_SPEED,
            "deg/s",
            "multiply it by `1 rev` if it counts turns, by `1 rad` if it is an angular frequency",
        ),
        (
            "10 deg",
            Dimension::ANGULAR_SPEED,
            "deg/s",
            "an angular speed is written like \"20 deg/s\"; an angle divided by a time is an angular speed",
        ),
        (
            "5 N",
            Dimension::TORQUE,
            "N m",
            "a torque is written like \"20 N m\"; a force times a length is a torque",
        ),
        (
            "5 N m",
            Dimension::FORCE,
            "N",
            "a force is written like \"20 N\"; a torque divided by a length is a force",
        ),
        (
            "1/4 rev",
            Dimension::LENGTH,
            "mm",
            "a length is written like \"20 mm\"",
        ),
        (
            "theta",
            Dimension::NONE,
            "1",
            "make it a number by `/ 1 rad`",
        ),
        (
            "crank",
            Dimension::NONE,
            "1",
            "a number has no unit: \"20\"",
        ),
    ] {
        let unit = Unit::parse(unit).unwrap();
        let issues = check_as(&parse(text).unwrap(), &mut File, dimension, &unit).unwrap_err();
        assert_eq!(issues[0].help.as_deref(), Some(help), "{text}");
    }
}

#[test]
fn conditions() {
    let checked = |text: &str| check_condition(&parse_condition(text).unwrap(), &mut File);
    let condition = checked("range(y(M)) >= 450 mm").unwrap();
    assert_eq!(condition.left, Expr::Leaf("range(y(M))".to_owned()));
    assert_eq!(condition.right, Expr::Const(0.45));
    assert_eq!(condition.dimension, Dimension::LENGTH);
    assert!(condition.comparison.holds(0.5, 0.45));
    assert!(!condition.comparison.holds(f64::NAN, 0.45));
    assert!(checked("rate(crank) <= 20 mm/s").is_ok());
    let issues = checked("range(y(M)) >= 30 deg").unwrap_err();
    assert_eq!(issues[0].message, "a length compared with an angle");
    let issues = checked("range(y(M)) >= 450").unwrap_err();
    assert_eq!(
        issues[0].help.as_deref(),
        Some("give it a unit: write `450 mm`")
    );
    assert_eq!(checked("zz1 >= zz2").unwrap_err().len(), 2);
}
