//! Values of expressions, on plain and on richer numbers.

use kempe_number::{Dual, Interval, Jet, Number};
use kempe_units::{Builtin, Dimension, EvalFault, Expr, Issue, Resolver, Span, check, parse};

/// Every name is a plain number.
struct Numbers;
impl Resolver<String> for Numbers {
    fn name(&mut self, name: &str, _: Span) -> Result<(String, Dimension), Issue> {
        Ok((name.to_owned(), Dimension::NONE))
    }
}

fn expr(text: &str) -> Expr<String> {
    check(&parse(text).expect(text), &mut Numbers)
        .unwrap_or_else(|issues| panic!("{text}: {issues:?}"))
        .0
}

fn value(text: &str, x: f64) -> f64 {
    expr(text).eval(&mut |_| x)
}

#[test]
fn values_known_by_hand() {
    for (text, x, expected) in [
        ("1 + 2*3", 0.0, 7.0),
        ("2^3^2", 0.0, 512.0),
        ("-2^2", 0.0, -4.0),
        ("7 - 2 - 1", 0.0, 4.0),
        ("12/3/2", 0.0, 2.0),
        ("x^-2", 2.0, 0.25),
        ("x^0", 0.0, 1.0),
        ("x^0.5", 9.0, 3.0),
        ("x^1.5", 4.0, 8.0),
        ("x^-0.5", 4.0, 0.5),
        ("2^x", 10.0, 1024.0),
        ("sin(30 deg)", 0.0, 0.5),
        ("cos(60 deg)", 0.0, 0.5),
        ("tan(45 deg)", 0.0, 1.0),
        ("asin(1/2) / 1 deg", 0.0, 30.0),
        ("acos(-1/2) / 1 deg", 0.0, 120.0),
        ("acos(1) / 1 deg", 0.0, 0.0),
        ("asin(-1) / 1 deg", 0.0, -90.0),
        ("atan(1) / 1 deg", 0.0, 45.0),
        ("atan2(1, -1) / 1 deg", 0.0, 135.0),
        ("sqrt(2)^2", 0.0, 2.0),
        ("abs(-3) + min(4, 2, 3) + max(1, 5, 2)", 0.0, 10.0),
        ("hypot(3, 4)", 0.0, 5.0),
        ("ln(exp(3))", 0.0, 3.0),
        ("(1 h)/(1 min)", 0.0, 60.0),
        ("2*pi*1 rad / 1 rev", 0.0, 1.0),
        ("50 %", 0.0, 0.5),
        ("(3 km + 1 ft) / 1 m", 0.0, 3000.3048),
    ] {
        let found = value(text, x);
        assert!(
            (found - expected).abs() <= 8.0 * f64::EPSILON * expected.abs().max(1.0),
            "{text}: {found}"
        );
    }
}

/// Texts with their derivatives by x, by the rules of school.
const DERIVATIVES: &[(&str, &str)] = &[
    ("sin(x*1 rad)", "cos(x*1 rad)"),
    ("tan(x*1 rad)", "1 + tan(x*1 rad)^2"),
    ("asin(x)/1 rad", "1/sqrt(1 - x^2)"),
    ("acos(x)/1 rad", "-1/sqrt(1 - x^2)"),
    ("atan(x)/1 rad", "1/(1 + x^2)"),
    ("atan2(2, x)/1 rad", "-2/(x^2 + 4)"),
    ("hypot(x, 3)", "x/sqrt(x^2 + 9)"),
    ("x^5", "5*x^4"),
    ("x^-3", "-3*x^-4"),
    ("x^2.5", "2.5*x^1.5"),
    ("x^0.3", "0.3*x^-0.7"),
    ("x^x", "x^x*(ln(x) + 1)"),
    ("sqrt(x)", "0.5/sqrt(x)"),
    ("exp(-x)*ln(x)", "exp(-x)/x - exp(-x)*ln(x)"),
    ("max(x^2, x)*min(3 - x, 2*x)", "4*x"), // x 2x where x is below 1
    ("abs(-x)", "1"),
    ("(1 - x)/(2 - x)", "-1/(2 - x)^2"),
];

#[test]
fn derivatives_come_with_the_number() {
    for (text, derivative) in DERIVATIVES {
        for x in [0.2, 0.7] {
            let expected = value(derivative, x);
            let jet: Jet<f64, 3> = expr(text).eval(&mut |_| Jet::variable(x));
            let dual: Dual<f64, 1> = expr(text).eval(&mut |_| Dual::variable(x, 0));
            for found in [jet.derivative(1), dual.eps[0]] {
                assert!(
                    (found - expected).abs() < 1e-13 * expected.abs().max(1.0),
                    "{text} at {x}: {found}, {expected}"
                );
            }
            assert_eq!(jet.value(), value(text, x), "{text}");
        }
    }
}

#[test]
fn bounds_come_with_the_number() {
    for (text, _) in DERIVATIVES {
        let bounds = expr(text).eval(&mut |_| Interval::new(0.29, 0.31));
        for x in [0.29, 0.295, 0.3, 0.31] {
            assert!(bounds.contains(value(text, x)), "{text} at {x}: {bounds:?}");
        }
    }
}

#[test]
fn faults_name_the_part() {
    for (text, x, fault, part) in [
        (
            "1 + sqrt(x - 1)",
            0.0,
            EvalFault::NegativeRoot,
            "sqrt(x - 1)",
        ),
        ("2/(x - 1)", 1.0, EvalFault::DivisionByZero, "2 / (x - 1)"),
        ("x^-2", 0.0, EvalFault::DivisionByZero, "x^(-2)"),
        ("x^0.3", -1.0, EvalFault::NegativePower, "x^0.3"),
        ("x^-0.5", 0.0, EvalFault::DivisionByZero, "x^(-0.5)"),
        ("ln(x)", 0.0, EvalFault::Logarithm, "ln(x)"),
        ("acos(x) / 1 rad", 1.1, EvalFault::ArcFunction, "acos(x)"),
        ("x + 1", f64::NAN, EvalFault::Leaf, "x"),
        ("exp(x)", 1e3, EvalFault::Overflow, "exp(x)"),
        ("min(sqrt(x), 1)", -1.0, EvalFault::NegativeRoot, "sqrt(x)"),
    ] {
        let expr = expr(text);
        let error = expr.eval_f64_checked(&mut |_| x).unwrap_err();
        assert_eq!(
            (error.fault, error.expr.to_string().as_str()),
            (fault, part),
            "{text}"
        );
    }
    assert!(value("sqrt(x)", -1.0).is_nan());
    assert!(
        value("min(sqrt(x), 1)", -1.0).is_nan(),
        "a fault is not hidden by the other argument"
    );
}

#[test]
fn leaves_and_folding() {
    let expr = expr("a*(2 + 3) + sin(b*(1 rad)/2) - a");
    assert_eq!(expr.leaves().collect::<Vec<_>>(), ["a", "b", "a"]);
    assert_eq!(expr.fold().to_string(), "a * 5 + sin(b * 1 / 2) - a");
    let upper = expr.map_leaves(&mut |leaf| leaf.to_uppercase());
    assert_eq!(upper.leaves().collect::<Vec<_>>(), ["A", "B", "A"]);
    let known: Expr<String> = expr.substitute(&mut |leaf| match leaf.as_str() {
        "a" => Expr::Const(2.0),
        _ => Expr::Leaf(leaf.clone()),
    });
    assert_eq!(known.leaves().collect::<Vec<_>>(), ["b"]);
    assert_eq!(known.as_constant(), None);
    assert_eq!(self::expr("2^3 + 1").as_constant(), Some(9.0));
    // What has no value is left for the report.
    assert_eq!(self::expr("1/0").fold(), self::expr("1/0"));
    assert_eq!(self::expr("2*3").fold(), Expr::Const(6.0));
}

#[test]
fn each_function_has_a_name_and_a_usage() {
    for builtin in Builtin::ALL {
        assert_eq!(Builtin::from_name(builtin.name()), Some(builtin));
        assert!(builtin.usage().starts_with(builtin.name()));
        assert_eq!(builtin.to_string(), builtin.name());
    }
    assert_eq!(Builtin::from_name("sinh"), None);
}

#[test]
fn formulas_as_text() {
    for text in [
        "a - (b - c)",
        "-a^2",
        "(-a)^2",
        "(a^2)^3",
        "a * -b",
        "a / (b * c)",
        "max(a, b + 1)",
        "a^(-2)",
    ] {
        assert_eq!(expr(text).to_string(), text);
    }
    assert_eq!(
        Expr::Powi(Box::new(Expr::<String>::Const(-2.0)), 2).to_string(),
        "(-2)^2"
    );
}
