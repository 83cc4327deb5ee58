//! Properties of the language: texts round trip, values agree with a second evaluator, nothing panics.

use kempe_units::{
    BinaryOp, Dimension, Expr, Issue, Kind, Natural, Node, Quantity, Resolver, Span, Spelling,
    Unit, check, check_condition, nearest, parse, parse_argument, parse_condition,
};
use proptest::prelude::*;

const UNIT_TEXTS: &[&str] = &[
    "mm", "m/s^2", "N m", "kg mm^2", "s^-1", "%", "rad/s", "L/min", "deg",
];
const NAMES: &[&str] = &["a", "crank", "s", "m", "h", "e5", "pi", "_x"];

fn node(kind: Kind) -> Node {
    Node::new(kind, 0..0)
}

/// Any tree a text can stand for, without spans.
fn tree() -> impl Strategy<Value = Node> {
    let number = prop_oneof![
        0.0..1e3_f64,
        1e-30..1e30_f64,
        (0..1000_u32).prop_map(f64::from)
    ];
    let name = proptest::sample::select(NAMES).prop_map(|name| node(Kind::Name(name.to_owned())));
    let point = proptest::sample::select(&["A", "B2", "N", "W"][..])
        .prop_map(|name| node(Kind::Point(name.to_owned())));
    let quantity =
        (number.clone(), proptest::sample::select(UNIT_TEXTS)).prop_map(|(value, unit)| {
            let unit = Unit::parse(unit).expect("a unit of the list");
            node(Kind::Quantity(Quantity {
                value,
                unit,
                unit_span: 0..0,
                joined: Vec::new(),
            }))
        });
    let leaf = prop_oneof![
        number.prop_map(|value| node(Kind::Number(value))),
        quantity,
        name,
        point.clone()
    ];
    let ops = [
        BinaryOp::Add,
        BinaryOp::Sub,
        BinaryOp::Mul,
        BinaryOp::Div,
        BinaryOp::Pow,
    ];
    leaf.prop_recursive(6, 48, 3, move |inner| {
        let line = (point.clone(), point.clone()).prop_map(|(from, to)| {
            node(Kind::Line {
                from: Box::new(from),
                to: Box::new(to),
            })
        });
        let argument = prop_oneof![4 => inner.clone(), 1 => line];
        prop_oneof![
            inner
                .clone()
                .prop_map(|inner| node(Kind::Neg(Box::new(inner)))),
            (proptest::sample::select(ops.to_vec()), inner.clone(), inner).prop_map(
                |(op, left, right)| {
                    node(Kind::Binary {
                        op,
                        left: Box::new(left),
                        right: Box::new(right),
                    })
                }
            ),
            (
                proptest::sample::select(&["f", "sin", "min", "s"][..]),
                proptest::collection::vec(argument, 0..4)
            )
                .prop_map(|(function, arguments)| {
                    node(Kind::Call {
                        function: function.to_owned(),
                        function_span: 0..0,
                        arguments,
                    })
                }),
        ]
    })
}

/// The tree without spans.
fn bare(mut tree: Node) -> Node {
    tree.span = 0..0;
    match &mut tree.kind {
        Kind::Number(_) | Kind::Name(_) | Kind::Point(_) => {}
        Kind::Quantity(quantity) => {
            quantity.unit_span = 0..0;
            quantity.joined.clear();
        }
        Kind::Neg(inner) => **inner = bare((**inner).clone()),
        Kind::Binary { left, right, .. }
        | Kind::Line {
            from: left,
            to: right,
        } => {
            **left = bare((**left).clone());
            **right = bare((**right).clone());
        }
        Kind::Call {
            function_span,
            arguments,
            ..
        } => {
            *function_span = 0..0;
            *arguments = std::mem::take(arguments).into_iter().map(bare).collect();
        }
    }
    tree
}

/// A text with what it must be worth, calculated beside it by plain `f64` arithmetic.
type Worth = (String, f64);

/// Lengths and numbers that the texts refer to.
const A: f64 = 0.0375;
const K: f64 = 1.75;

fn numbers(depth: u32) -> BoxedStrategy<Worth> {
    let literal = (0.0..10.0_f64).prop_map(|x| (format!("{x}"), x));
    let leaf = prop_oneof![
        literal,
        Just(("k".to_owned(), K)),
        Just(("pi".to_owned(), std::f64::consts::PI))
    ];
    if depth == 0 {
        return leaf.boxed();
    }
    let (n, l, a) = (numbers(depth - 1), lengths(depth - 1), angles(depth - 1));
    prop_oneof![
        1 => leaf,
        2 => (n.clone(), n.clone()).prop_map(|((s, x), (t, y))| (format!("({s}) + ({t})"), x + y)),
        2 => (n.clone(), n.clone()).prop_map(|((s, x), (t, y))| (format!("({s})*({t})"), x * y)),
        1 => (l.clone(), l).prop_map(|((s, x), (t, y))| (format!("({s})/({t})"), x / y)),
        1 => a.clone().prop_map(|(s, x)| (format!("sin({s})"), libm_sin(x))),
        1 => a.prop_map(|(s, x)| (format!("({s})/1 rad"), x)),
        1 => n.clone().prop_map(|(s, x)| (format!("sqrt(abs({s}))"), x.abs().sqrt())),
        1 => (n.clone(), -3..4_i32).prop_map(|((s, x), p)| (format!("({s})^{p}"), power(x, p))),
        1 => (n.clone(), n.clone()).prop_map(|((s, x), (t, y))| (format!("max({s}, {t})"), if x > y { x } else { y })),
        1 => n.prop_map(|(s, x)| (format!("-({s})"), -x)),
    ]
    .boxed()
}

fn lengths(depth: u32) -> BoxedStrategy<Worth> {
    let literal = (0.1..100.0_f64).prop_map(|x| (format!("{x} mm"), x / 1000.0));
    let inches = (0.1..100.0_f64).prop_map(|x| (format!("{x} in"), x * 127.0 / 5000.0));
    let leaf = prop_oneof![literal, inches, Just(("a".to_owned(), A))];
    if depth == 0 {
        return leaf.boxed();
    }
    let (n, l) = (numbers(depth - 1), lengths(depth - 1));
    prop_oneof![
        1 => leaf,
        2 => (l.clone(), l.clone()).prop_map(|((s, x), (t, y))| (format!("({s}) - ({t})"), x - y)),
        2 => (l.clone(), l.clone()).prop_map(|((s, x), (t, y))| (format!("({s}) + ({t})"), x + y)),
        2 => (n, l.clone()).prop_map(|((s, x), (t, y))| (format!("({s})*({t})"), x * y)),
        1 => (l.clone(), l.clone()).prop_map(|((s, x), (t, y))| (format!("sqrt(({s})^2 + ({t})^2)"), (x * x + y * y).sqrt())),
        1 => (l.clone(), l).prop_map(|((s, x), (t, y))| (format!("hypot({s}, {t})"), (x * x + y * y).sqrt())),
    ]
    .boxed()
}

fn angles(depth: u32) -> BoxedStrategy<Worth> {
    let leaf =
        (0.0..360.0_f64).prop_map(|x| (format!("{x} deg"), x * std::f64::consts::PI / 180.0));
    if depth == 0 {
        return leaf.boxed();
    }
    let (n, a, l) = (numbers(depth - 1), angles(depth - 1), lengths(depth - 1));
    prop_oneof![
        1 => leaf,
        2 => (a.clone(), a).prop_map(|((s, x), (t, y))| (format!("({s}) + ({t})"), x + y)),
        1 => n.prop_map(|(s, x)| (format!("({s})*(1 rad)"), x)),
        1 => (l.clone(), l).prop_map(|((s, x), (t, y))| (format!("atan2({s}, {t})"), kempe_number::math::atan2(x, y))),
    ]
    .boxed()
}

fn libm_sin(x: f64) -> f64 {
    kempe_number::math::sin_cos(x).0
}

/// A whole power by repeated products.
fn power(x: f64, p: i32) -> f64 {
    let product = (0..p.abs()).fold(1.0, |product, _| product * x);
    if p < 0 { 1.0 / product } else { product }
}

/// `a` is a length, every other name a number, every unknown call a number.
struct File;
impl Resolver<String> for File {
    fn name(&mut self, name: &str, _: Span) -> Result<(String, Dimension), Issue> {
        Ok((
            name.to_owned(),
            if name == "a" {
                Dimension::LENGTH
            } else {
                Dimension::NONE
            },
        ))
    }
}

/// The names of `File`, with constants in mm and deg.
struct Written([Unit; 2]);

impl Spelling<String> for Written {
    fn natural(&self, name: &String) -> Natural {
        Natural::fixed(match name.as_str() {
            "a" => Dimension::LENGTH,
            _ => Dimension::NONE,
        })
    }

    fn leaf(&self, name: &String, _: Dimension) -> Node {
        node(Kind::Name(name.clone()))
    }

    fn preferred(&self) -> &[Unit] {
        &self.0
    }
}

/// What is checked, written and checked again is the same to the last bit of each constant.
fn written_reads_back(expr: &Expr<String>, dimension: Dimension) -> Result<(), TestCaseError> {
    let unit = |text: &str| Unit::parse(text).expect("a unit of the table");
    let again = expr
        .to_node(dimension, &Written([unit("mm"), unit("deg")]))
        .to_string();
    if again.len() > kempe_units::MAX_LENGTH {
        return Ok(());
    }
    let read = parse(&again).and_then(|tree| check(&tree, &mut File));
    let Ok((read, measures)) = read else {
        return Err(TestCaseError::fail(format!("{again}: {read:?}")));
    };
    prop_assert_eq!(measures, dimension, "{}", &again);
    prop_assert_eq!(
        format!("{:?}", read.fold()),
        format!("{:?}", expr.fold()),
        "{}",
        again
    );
    Ok(())
}

/// What stands in texts, put together at random.
fn soup() -> impl Strategy<Value = String> {
    const PIECES: &[&str] = &[
        "a", "B", "crank", "5", "1e3", "1e308", "mm", "m", "s", "N", "+", "-", "*", "/", "^", "(",
        ")", ",", "->", "<=", ">", " ", "  ", "²", "⁻¹", "µm", "·", "sin", "atan2", "min", "%",
        "°", "0", ".", "=", "π", "×", "é", "$",
    ];
    proptest::collection::vec(proptest::sample::select(PIECES), 0..40)
        .prop_map(|pieces| pieces.concat())
}

/// Reads and checks `text` in every way; issues must point into it.
fn read_all(text: &str) -> Result<(), TestCaseError> {
    let mut issues: Vec<Issue> = Vec::new();
    for parsed in [parse(text), parse_argument(text)] {
        match parsed {
            Ok(tree) => {
                let again = tree.to_string();
                let mut spans = Vec::new();
                tree.visit(&mut |node| spans.push(node.span.clone()));
                prop_assert!(spans.iter().all(|span| text.get(span.clone()).is_some()));
                prop_assert_eq!(
                    parse_argument(&again).map(bare),
                    Ok(bare(tree.clone())),
                    "{}",
                    again
                );
                match check(&tree, &mut File) {
                    Ok((expr, _)) => {
                        let plain = expr.eval(&mut |_| 0.5);
                        let folded = expr.fold().eval(&mut |_| 0.5);
                        prop_assert!(
                            plain.to_bits() == folded.to_bits()
                                || plain.is_nan() && folded.is_nan()
                        );
                        if let Ok(checked) = expr.eval_f64_checked(&mut |_| 0.5) {
                            prop_assert_eq!(checked.to_bits(), plain.to_bits());
                        }
                        let _ = expr.to_string();
                    }
                    Err(found) => issues.extend(found),
                }
            }
            Err(found) => {
                prop_assert!(!found.is_empty());
                issues.extend(found);
            }
        }
    }
    match parse_condition(text) {
        Ok(condition) => issues.extend(
            check_condition(&condition, &mut File)
                .err()
                .unwrap_or_default(),
        ),
        Err(found) => issues.extend(found),
    }
    issues.extend(Unit::parse(text).err());
    for issue in issues {
        prop_assert!(
            text.get(issue.span.clone()).is_some(),
            "{:?} points out of {:?}",
            issue,
            text
        );
        prop_assert!(!issue.message.is_empty());
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn the_text_of_a_tree_reads_back_as_the_tree(tree in tree()) {
        let text = tree.to_string();
        prop_assert_eq!(parse(&text).map(bare), Ok(tree), "{}", text);
    }

    #[test]
    fn a_checked_expression_is_written_so_that_it_reads_back(
        (text, _) in prop_oneof![numbers(4), lengths(4), angles(4)],
    ) {
        let (expr, dimension) = check(&parse(&text).expect("sound"), &mut File).expect("sound");
        written_reads_back(&expr, dimension)?;
    }

    #[test]
    fn any_tree_that_checks_is_written_so_that_it_reads_back(tree in tree()) {
        if let Ok((expr, dimension)) = check(&tree, &mut File) {
            written_reads_back(&expr, dimension)?;
        }
    }

    #[test]
    fn every_constant_has_a_text_of_its_own(si in proptest::num::f64::NORMAL, pick in 0..UNIT_TEXTS.len()) {
        let unit = Unit::parse(UNIT_TEXTS[pick]).expect("a unit of the list");
        if let Some(x) = unit.exact_from_si(si) {
            prop_assert_eq!(unit.to_si(x).to_bits(), si.to_bits());
        }
        if let Some((x, exact)) = Unit::exact(si, unit.dimension(), &[unit]) {
            prop_assert_eq!(exact.to_si(x).to_bits(), si.to_bits());
        } else {
            prop_assert!(false, "SI has every number");
        }
    }

    #[test]
    fn sound_numbers_have_the_value_of_plain_arithmetic((text, expected) in numbers(4)) {
        agrees(&text, expected, Dimension::NONE)?;
    }

    #[test]
    fn sound_lengths_have_the_value_of_plain_arithmetic((text, expected) in lengths(4)) {
        agrees(&text, expected, Dimension::LENGTH)?;
    }

    #[test]
    fn sound_angles_have_the_value_of_plain_arithmetic((text, expected) in angles(4)) {
        agrees(&text, expected, Dimension::ANGLE)?;
    }

    #[test]
    fn no_text_panics(text in "\\PC{0,60}") {
        read_all(&text)?;
    }

    #[test]
    fn no_soup_panics(text in soup()) {
        read_all(&text)?;
    }

    #[test]
    fn a_swap_or_a_loss_is_understood(at in 0_usize..5) {
        let word = "cylinder_force";
        let mut swapped: Vec<char> = word.chars().collect();
        swapped.swap(at, at + 1);
        let swapped: String = swapped.into_iter().collect();
        prop_assert_eq!(nearest(&swapped, ["cylinder_speed", word]), Some(word));
        let lost: String = word.chars().enumerate().filter(|(i, _)| *i != at).map(|(_, c)| c).collect();
        prop_assert_eq!(nearest(&lost, ["cylinder_speed", word]), Some(word));
    }
}

/// Whether the checked text has this value and dimension.
fn agrees(text: &str, expected: f64, dimension: Dimension) -> Result<(), TestCaseError> {
    if text.len() > kempe_units::MAX_LENGTH {
        return Ok(());
    }
    let tree = parse(text).map_err(|errors| TestCaseError::fail(format!("{text}: {errors:?}")))?;
    let (expr, found) = check(&tree, &mut File)
        .map_err(|issues| TestCaseError::fail(format!("{text}: {issues:?}")))?;
    prop_assert_eq!(found, dimension);
    let value = expr.eval(&mut |leaf| if leaf == "a" { A } else { K });
    // The same operations in the same order: the same bits, but for the sign of a zero.
    prop_assert!(
        value == expected || value.is_nan() && expected.is_nan(),
        "{}: {} and {}",
        text,
        value,
        expected
    );
    Ok(())
}

#[test]
fn the_deepest_trees_fit_a_small_stack() {
    /// A quarter of what threads of a browser or a test get.
    const STACK: usize = 256 * 1024;
    let n = kempe_units::MAX_DEPTH - 1;
    let deep = [
        "(".repeat(n) + "k" + &")".repeat(n),
        "k+".repeat(n) + "k",
        "-".repeat(n) + "k",
        "k^".repeat(n) + "1",
        "sin(1 rad*".repeat(n / 2) + "k" + &")".repeat(n / 2),
    ];
    let work = move || {
        for text in deep {
            let tree = parse(&text).expect(&text);
            let (expr, _) = check(&tree, &mut File).expect(&text);
            let _ = (
                expr.to_string(),
                tree.to_string(),
                tree.clone(),
                expr.fold().leaves().count(),
            );
            let _ = expr.eval_f64_checked(&mut |_| 0.5);
        }
    };
    let thread = std::thread::Builder::new()
        .stack_size(STACK)
        .spawn(work)
        .expect("a thread");
    assert!(thread.join().is_ok());
}
