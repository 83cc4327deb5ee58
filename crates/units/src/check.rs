//! Tree to expression: names resolved, dimensions checked, constants in SI.

use crate::issue::{Issue, Span};
use crate::suggest::nearest;
use crate::syntax::{BinaryOp, CONSTANTS, Comparison, Condition, Kind, Node, Quantity};
use crate::{Builtin, Dimension, Expr, Unit};

/// The largest whole exponent; beyond it a power is a mistake.
const MAX_EXPONENT: f64 = 1000.0;

/// What stands behind the names of a text: parameters, links, measures.
pub trait Resolver<L> {
    /// The leaf that `name` (which starts with a small letter) stands for, and what it measures.
    ///
    /// # Errors
    ///
    /// What is wrong with the name; [`Issue::unknown_name`] makes the usual one.
    fn name(&mut self, name: &str, span: Span) -> Result<(L, Dimension), Issue>;

    /// The leaf that a call stands for, such as the measure `x(P)`; `None` where the function is not the resolver's, and
    /// then the built-in functions are asked. So a resolver may take `min(load)` and leave `min(a, b)`.
    ///
    /// Arguments come as they were written. To check one as an expression, pass it back with the resolver itself:
    /// `check(&arguments[0], self)`; the call's span is that of the whole call.
    ///
    /// # Errors
    ///
    /// All that is wrong with the call.
    fn call(
        &mut self,
        function: &str,
        arguments: &[Node],
        span: Span,
    ) -> Option<Result<(L, Dimension), Vec<Issue>>> {
        let _ = (function, arguments, span);
        None
    }

    /// Whether `name` is declared, asked without any effect where the name is a unit too.
    fn declared(&self, name: &str) -> bool {
        let _ = name;
        false
    }

    /// The names of the functions that [`call`](Self::call) knows, for the help on a misspelt one.
    fn functions(&self) -> Vec<String> {
        Vec::new()
    }
}

/// A checked expression with its dimension.
type Checked<L> = Result<(Expr<L>, Dimension), Vec<Issue>>;

/// Resolves and checks `node`: the expression in SI, and what it measures.
///
/// The dimensions of both sides of `+` and `-`, and of all arguments of `min`, `max`, `hypot` and `atan2`, are
/// [compatible](Dimension::compatible). Trigonometric functions take angles, their inverses give them; `exp` and
/// `ln` take numbers. An exponent is a constant number; a number (not a quantity) may also be raised to an
/// expression, `x^y = exp(y ln x)`.
///
/// # A unit's name that is declared too
///
/// In `5 mm * h`, with a parameter `h`, the unit goes on to the hour, and the writer may have meant the parameter. This
/// is reported as `ambiguous-name` ([`Resolver::declared`] is asked). A division without blanks, as in `9.81 m/s^2`, is
/// the unit's, whatever is declared.
///
/// # Errors
///
/// All issues of the text, in its order.
pub fn check<L, R: Resolver<L> + ?Sized>(node: &Node, resolver: &mut R) -> Checked<L> {
    sorted(
        Checker {
            resolver,
            default: None,
        }
        .node(node),
    )
}

/// Resolves and checks `node` where a quantity of dimension `expected` must stand.
///
/// A bare number literal, possibly negated (`0.4`, `-30`), is in the unit `default`. Nothing else is: in `2*a + 5` the 5
/// is a number.
///
/// # Errors
///
/// All issues of the text, in its order; `unit-mismatch` where it measures something else.
///
/// # Example
///
/// ```
/// use kempe_units::{Dimension, Expr, Issue, Resolver, Span, Unit, check_as, parse};
/// struct Nothing;
/// impl Resolver<()> for Nothing {
///     fn name(&mut self, name: &str, span: Span) -> Result<((), Dimension), Issue> {
///         Err(Issue::unknown_name(name, span, []))
///     }
/// }
/// let mm = Unit::parse("mm").unwrap();
/// let check = |text| check_as(&parse(text).unwrap(), &mut Nothing, Dimension::LENGTH, &mm);
/// assert_eq!(check("57.5"), Ok((Expr::Const(0.0575), Dimension::LENGTH)));
/// assert_eq!(check("30 deg").unwrap_err()[0].message, "length expected, found an angle");
/// ```
pub fn check_as<L, R: Resolver<L> + ?Sized>(
    node: &Node,
    resolver: &mut R,
    expected: Dimension,
    default: &Unit,
) -> Checked<L> {
    if let Some(value) = node.as_bare_number() {
        return Ok((Expr::Const(default.to_si(value)), expected));
    }
    let (expr, found) = sorted(
        Checker {
            resolver,
            default: Some(default),
        }
        .node(node),
    )?;
    if found.compatible(expected) {
        return Ok((expr, found));
    }
    let message = format!("{expected} expected, found {}", found.with_article());
    let issue = Issue::new("unit-mismatch", node.span.clone(), message);
    let help = remedy(node, found, expected, default);
    Err(vec![
        issue
            .with_label(format!("this is {}", found.with_article()))
            .with_help(help),
    ])
}

/// A checked condition.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckedCondition<L> {
    /// Left side, in SI.
    pub left: Expr<L>,
    /// The comparison.
    pub comparison: Comparison,
    /// Right side, in SI.
    pub right: Expr<L>,
    /// What both sides measure.
    pub dimension: Dimension,
}

/// Resolves and checks both sides of a condition; they must be [compatible](Dimension::compatible).
///
/// # Errors
///
/// All issues of the text, in its order.
pub fn check_condition<L, R: Resolver<L> + ?Sized>(
    condition: &Condition,
    resolver: &mut R,
) -> Result<CheckedCondition<L>, Vec<Issue>> {
    let mut checker = Checker {
        resolver,
        default: None,
    };
    let left = checker.node(&condition.left);
    let right = checker.node(&condition.right);
    let ((left, left_is), (right, right_is)) = sorted(both(left, right))?;
    if !left_is.compatible(right_is) {
        let sides = [(&condition.left, left_is), (&condition.right, right_is)];
        let message = format!(
            "{} compared with {}",
            left_is.with_article(),
            right_is.with_article()
        );
        return Err(vec![checker.mismatch(message, sides)]);
    }
    Ok(CheckedCondition {
        left,
        comparison: condition.comparison,
        right,
        dimension: left_is.common(right_is),
    })
}

/// Both results, or the issues of both.
fn both<A, B>(a: Result<A, Vec<Issue>>, b: Result<B, Vec<Issue>>) -> Result<(A, B), Vec<Issue>> {
    match (a, b) {
        (Ok(a), Ok(b)) => Ok((a, b)),
        (Err(mut a), Err(b)) => {
            a.extend(b);
            Err(a)
        }
        (Err(issues), Ok(_)) | (Ok(_), Err(issues)) => Err(issues),
    }
}

/// The issues in the order of the text.
fn sorted<T>(result: Result<T, Vec<Issue>>) -> Result<T, Vec<Issue>> {
    result.map_err(|mut issues| {
        issues.sort_by_key(|issue| (issue.span.start, issue.span.end));
        issues
    })
}

/// The issue as the only one.
fn one<T>(issue: Issue) -> Result<T, Vec<Issue>> {
    Err(vec![issue])
}

/// A walk over a tree.
struct Checker<'a, R: ?Sized> {
    resolver: &'a mut R,
    /// The unit that a bare number would have had, for the help.
    default: Option<&'a Unit>,
}

impl<R: ?Sized> Checker<'_, R> {
    fn node<L>(&mut self, node: &Node) -> Checked<L>
    where
        R: Resolver<L>,
    {
        match &node.kind {
            Kind::Number(value) => Ok((Expr::Const(*value), Dimension::NONE)),
            Kind::Quantity(quantity) => self.quantity(quantity),
            Kind::Name(name) => match CONSTANTS.iter().find(|(constant, _)| constant == name) {
                Some((_, value)) => Ok((Expr::Const(*value), Dimension::NONE)),
                None => match self.resolver.name(name, node.span.clone()) {
                    Ok((leaf, dimension)) => Ok((Expr::Leaf(leaf), dimension)),
                    Err(issue) => one(issue),
                },
            },
            Kind::Point(name) => {
                let issue = Issue::new(
                    "not-a-value",
                    node.span.clone(),
                    format!("the point `{name}` is not a value"),
                );
                one(issue.with_label("this is a point").with_help(format!(
                    "take a measure of it, such as `x({name})`; names of parameters start with a small letter"
                )))
            }
            Kind::Line { .. } => {
                let issue = Issue::new(
                    "not-a-value",
                    node.span.clone(),
                    "a directed line is not a value",
                );
                one(issue.with_label("this is a line").with_help(
                    "take a measure of it, such as `angle(A -> B)`; a difference is written `-`",
                ))
            }
            Kind::Neg(inner) => {
                let (expr, dimension) = self.node(inner)?;
                Ok((Expr::Neg(Box::new(expr)), dimension))
            }
            Kind::Binary {
                op: BinaryOp::Pow,
                left,
                right,
            } => self.power(node, left, right),
            Kind::Binary { op, left, right } => self.binary(*op, left, right),
            Kind::Call {
                function,
                function_span,
                arguments,
            } => match self.resolver.call(function, arguments, node.span.clone()) {
                Some(Ok((leaf, dimension))) => Ok((Expr::Leaf(leaf), dimension)),
                Some(Err(issues)) => Err(issues),
                None => match Builtin::from_name(function) {
                    Some(builtin) => self.builtin(builtin, arguments, &node.span),
                    None => one(self.unknown_function(function, function_span)),
                },
            },
        }
    }

    fn quantity<L>(&mut self, quantity: &Quantity) -> Checked<L>
    where
        R: Resolver<L>,
    {
        let mut issues = Vec::new();
        for unit in &quantity.joined {
            if unit.tight_division || !self.resolver.declared(&unit.name) {
                continue;
            }
            let name = &unit.name;
            let message = format!("`{name}` could be the unit or what is declared by this name");
            let help = format!(
                "for what is declared, put the quantity before it in brackets; for the unit, write a blank instead of the \
                 operator (`N m`, `m s^-1`); or give `{name}` a longer name"
            );
            issues.push(Issue::new("ambiguous-name", unit.span.clone(), message).with_help(help));
        }
        if !issues.is_empty() {
            return Err(issues);
        }
        Ok((
            Expr::Const(quantity.unit.to_si(quantity.value)),
            quantity.unit.dimension(),
        ))
    }

    fn binary<L>(&mut self, op: BinaryOp, left: &Node, right: &Node) -> Checked<L>
    where
        R: Resolver<L>,
    {
        let left_checked = self.node(left);
        let right_checked = self.node(right);
        let ((a, a_is), (b, b_is)) = both(left_checked, right_checked)?;
        let (a, b) = (Box::new(a), Box::new(b));
        match op {
            BinaryOp::Mul => Ok((Expr::Mul(a, b), a_is * b_is)),
            BinaryOp::Div => Ok((Expr::Div(a, b), a_is / b_is)),
            _ if !a_is.compatible(b_is) => {
                let word = if op == BinaryOp::Add { "plus" } else { "minus" };
                let message = format!("{} {word} {}", a_is.with_article(), b_is.with_article());
                one(self.mismatch(message, [(left, a_is), (right, b_is)]))
            }
            BinaryOp::Add => Ok((Expr::Add(a, b), a_is.common(b_is))),
            _ => Ok((Expr::Sub(a, b), a_is.common(b_is))),
        }
    }

    /// The issue on two sides that do not fit: it marks the bare number if there is one, else the right side.
    fn mismatch(&self, message: String, sides: [(&Node, Dimension); 2]) -> Issue {
        let [(left, left_is), (right, right_is)] = sides;
        for (node, wanted) in [(right, left_is), (left, right_is)] {
            if let Some(value) = node.as_bare_number() {
                let number = kempe_number::text::shortest(value);
                let unit = self.unit_of(wanted);
                return Issue::new("unit-mismatch", node.span.clone(), message)
                    .with_label("this is a number")
                    .with_help(format!("give it a unit: write `{number} {unit}`"));
            }
        }
        let issue = Issue::new("unit-mismatch", right.span.clone(), message)
            .with_label(format!("this is {}", right_is.with_article()));
        issue.with_help(relation(left_is, right_is))
    }

    /// The unit to propose for a bare number beside a quantity of `dimension`.
    fn unit_of(&self, dimension: Dimension) -> Unit {
        let mut preferred: Vec<Unit> = self.default.into_iter().cloned().collect();
        preferred.extend(
            ["mm", "deg", "kg", "s"]
                .into_iter()
                .filter_map(|unit| Unit::parse(unit).ok()),
        );
        Unit::for_display(dimension, &preferred)
    }

    fn power<L>(&mut self, node: &Node, left: &Node, right: &Node) -> Checked<L>
    where
        R: Resolver<L>,
    {
        let base = self.node(left);
        let exponent = self.node(right);
        let ((base, base_is), (exponent, exponent_is)) = both(base, exponent)?;
        let bad = |message: String| Issue::new("bad-exponent", right.span.clone(), message);
        if exponent_is != Dimension::NONE {
            let message = format!(
                "an exponent is a number, found {}",
                exponent_is.with_article()
            );
            return one(bad(message)
                .with_label(format!("this is {}", exponent_is.with_article()))
                .with_help("divide it by a quantity of the same kind"));
        }
        let Some(constant) = exponent.as_constant() else {
            if base_is == Dimension::NONE {
                let logarithm = Expr::Call(Builtin::Ln, vec![base]);
                let product = Expr::Mul(Box::new(exponent), Box::new(logarithm));
                return Ok((Expr::Call(Builtin::Exp, vec![product]), Dimension::NONE));
            }
            let message = format!("{} is raised to a constant only", base_is.with_article());
            return one(bad(message).with_label("this is not constant").with_help(
                "only plain numbers have variable powers: divide the base by a quantity of its kind first",
            ));
        };
        if constant.is_nan() || constant.abs() > MAX_EXPONENT {
            let message = format!("an exponent is at most {MAX_EXPONENT}");
            return one(bad(message).with_help("write a smaller one, or use `exp` and `ln`"));
        }
        #[expect(clippy::cast_possible_truncation, reason = "bounded above")]
        let sixths = (6.0 * constant).round() as i32;
        // A sixth such as 1/3 is a rounding off; anything farther is another number.
        let is_sixths = (6.0 * constant - f64::from(sixths)).abs()
            <= 4.0 * f64::EPSILON * f64::from(sixths.abs());
        let dimension = match base_is {
            Dimension::NONE => Some(Dimension::NONE),
            _ if is_sixths => base_is.pow(sixths, 6),
            _ => None,
        };
        let Some(dimension) = dimension else {
            let message = format!(
                "{} has no power {}",
                base_is.with_article(),
                kempe_number::text::shortest(constant)
            );
            let help = "the exponents of a unit are whole numbers, halves, thirds or sixths";
            return one(Issue::new("bad-exponent", node.span.clone(), message).with_help(help));
        };
        let base = match constant {
            0.5 => Expr::Call(Builtin::Sqrt, vec![base]),
            c if c.fract() == 0.0 => Expr::Powi(Box::new(base), sixths / 6),
            c => Expr::Powf(Box::new(base), c),
        };
        Ok((base, dimension))
    }

    fn builtin<L>(&mut self, builtin: Builtin, arguments: &[Node], span: &Span) -> Checked<L>
    where
        R: Resolver<L>,
    {
        let mut issues = Vec::new();
        let mut checked = Vec::with_capacity(arguments.len());
        for argument in arguments {
            match self.node(argument) {
                Ok((expr, dimension)) => checked.push((argument, expr, dimension)),
                Err(found) => issues.extend(found),
            }
        }
        if !builtin.takes(arguments.len()) {
            let count = arguments.len();
            let plural = if count == 1 { "" } else { "s" };
            let message = format!("`{builtin}` does not take {count} argument{plural}");
            issues.push(
                Issue::new("wrong-arguments", span.clone(), message)
                    .with_help(format!("it is called as `{}`", builtin.usage())),
            );
        }
        let Some((first, ..)) = checked.first().filter(|_| issues.is_empty()) else {
            return Err(issues);
        };
        let x_is = checked[0].2;
        let wanted = |wanted: Dimension, help: String| {
            if x_is == wanted {
                return Ok(());
            }
            let message = format!(
                "`{builtin}` takes {}, found {}",
                wanted.with_article(),
                x_is.with_article()
            );
            let issue = Issue::new("unit-mismatch", first.span.clone(), message);
            one(issue
                .with_label(format!("this is {}", x_is.with_article()))
                .with_help(help))
        };
        let ratio_help = || match x_is == Dimension::ANGLE {
            true => format!("`{builtin}` is of a number: divide the angle by `1 rad`"),
            false => "divide by a quantity of the same kind".to_owned(),
        };
        let dimension = match builtin {
            Builtin::Sin | Builtin::Cos | Builtin::Tan => {
                wanted(Dimension::ANGLE, angle_help(builtin, first, x_is))?;
                Dimension::NONE
            }
            Builtin::Asin | Builtin::Acos | Builtin::Atan => {
                wanted(Dimension::NONE, ratio_help())?;
                Dimension::ANGLE
            }
            Builtin::Exp | Builtin::Ln => {
                wanted(Dimension::NONE, ratio_help())?;
                Dimension::NONE
            }
            Builtin::Sqrt => match x_is.sqrt() {
                Some(dimension) => dimension,
                None => {
                    let message = format!("{} has no square root", x_is.with_article());
                    let issue = Issue::new("unit-mismatch", first.span.clone(), message);
                    return one(issue.with_help(
                        "the exponents of a unit are whole numbers, halves, thirds or sixths",
                    ));
                }
            },
            Builtin::Abs => x_is,
            Builtin::Atan2 | Builtin::Min | Builtin::Max | Builtin::Hypot => {
                let mut common = x_is;
                for (argument, _, dimension) in &checked[1..] {
                    if dimension.compatible(x_is) {
                        common = common.common(*dimension);
                        continue;
                    }
                    let found = dimension.with_article();
                    let message = format!("`{builtin}` of {} and {found}", x_is.with_article());
                    let sides = [(*first, x_is), (*argument, *dimension)];
                    issues.push(self.mismatch(message, sides));
                }
                if !issues.is_empty() {
                    return Err(issues);
                }
                if builtin == Builtin::Atan2 {
                    Dimension::ANGLE
                } else {
                    common
                }
            }
        };
        Ok((
            Expr::Call(
                builtin,
                checked.into_iter().map(|(_, expr, _)| expr).collect(),
            ),
            dimension,
        ))
    }

    fn unknown_function<L>(&self, function: &str, span: &Span) -> Issue
    where
        R: Resolver<L>,
    {
        let known = self.resolver.functions();
        let builtins = Builtin::ALL.iter().map(|builtin| builtin.name());
        let issue = Issue::new(
            "unknown-function",
            span.clone(),
            format!("unknown function `{function}`"),
        )
        .with_label(match known.is_empty() {
            true => "no function, and no measure can stand here",
            false => "neither a measure nor a function",
        });
        if let Some((_, help)) = INSTEAD.iter().find(|(word, _)| *word == function) {
            return issue.with_help(*help);
        }
        let list: Vec<&str> = builtins.clone().collect();
        let list = list.join(", ");
        match nearest(function, known.iter().map(String::as_str).chain(builtins)) {
            Some(near) => issue.with_help(format!("did you mean `{near}`?")),
            None if known.is_empty() => issue.with_help(format!("the functions are {list}")),
            None => issue.with_help(format!(
                "the functions are {list}, and the questions that `kempe measures` tells"
            )),
        }
    }
}

/// What to write instead of functions of other languages.
const INSTEAD: &[(&str, &str)] = &[
    (
        "log",
        "`ln(x)` is the natural logarithm; to the base 10 write `ln(x) / ln(10)`",
    ),
    ("log10", "write `ln(x) / ln(10)`"),
    ("log2", "write `ln(x) / ln(2)`"),
    ("pow", "a power is written `x^2`"),
    ("sqr", "a square is written `x^2`"),
    ("square", "a square is written `x^2`"),
    ("cbrt", "write `x^(1/3)`"),
    ("arcsin", "it is called `asin`"),
    ("arccos", "it is called `acos`"),
    ("arctan", "it is called `atan`; of two sides `atan2(y, x)`"),
    ("deg", "a unit stands behind a number: write `x * 1 deg`"),
    ("rad", "a unit stands behind a number: write `x * 1 rad`"),
    (
        "radians",
        "write `x * 1 deg` where x counts degrees; angles carry their unit",
    ),
    (
        "degrees",
        "write `x / 1 deg` for the number of degrees; angles carry their unit",
    ),
    (
        "mod",
        "there is no remainder: angles count turns; give a table its `period`",
    ),
    (
        "fmod",
        "there is no remainder: angles count turns; give a table its `period`",
    ),
    (
        "sign",
        "there is no sign: `x / abs(x)` is 1 or -1 where x is not 0",
    ),
    (
        "sgn",
        "there is no sign: `x / abs(x)` is 1 or -1 where x is not 0",
    ),
];

/// Help where a trigonometric function got no angle.
fn angle_help(builtin: Builtin, argument: &Node, found: Dimension) -> String {
    if let Some(value) = argument.as_bare_number() {
        let number = kempe_number::text::shortest(value);
        return format!(
            "give it a unit: write `{builtin}({number} deg)` or `{builtin}({number} rad)`"
        );
    }
    if found == Dimension::NONE {
        return "a number is made an angle by `* 1 deg` where it counts degrees, by `* 1 rad` where it is an arc over its radius".to_owned();
    }
    if found.compatible(Dimension::LENGTH) {
        return format!(
            "an arc is made an angle by dividing it by its radius and `* 1 rad`; sides give one by `atan2(y, x)`, such as `{builtin}(atan2(y, x))`"
        );
    }
    format!("an angle has a unit such as `30 deg`: write `{builtin}(30 deg)`")
}

/// What to do where `found` stands and `expected` should.
fn remedy(node: &Node, found: Dimension, expected: Dimension, default: &Unit) -> String {
    if found == Dimension::NONE && expected != Dimension::NONE {
        let one = match expected == Dimension::ANGLE {
            true => "; a number is made an angle by `* 1 deg` or `* 1 rad`",
            false => "",
        };
        return format!(
            "give it a unit, here or where its parameters are declared: \"20 {}\"{one}",
            default.text()
        );
    }
    if let Some(help) = divided_unit(node, found, expected) {
        return help;
    }
    if expected == Dimension::NONE && found == Dimension::ANGLE {
        return "make it a number by `/ 1 rad`".to_owned();
    }
    if expected == Dimension::ANGULAR_SPEED && found == Dimension::FREQUENCY {
        let hertz = match &node.kind {
            Kind::Quantity(quantity) => quantity.unit.to_si(quantity.value),
            _ => f64::NAN,
        };
        let written = crate::unit::format_digits(hertz, &Unit::one(), 6);
        return match hertz.is_finite() {
            true => format!(
                "turns per second are written `{written} rev/s`, radians per second `{written} rad/s`"
            ),
            false => "multiply it by `1 rev` if it counts turns, by `1 rad` if it is an angular frequency".to_owned(),
        };
    }
    let example = match (expected == Dimension::NONE, default.text()) {
        (true, _) => "a number has no unit: \"20\"".to_owned(),
        (false, "") => format!("{} is expected", expected.with_article()),
        (false, unit) => format!("{} is written like \"20 {unit}\"", expected.with_article()),
    };
    match between(found, expected) {
        Some(how) => format!("{example}; {how}"),
        None => example,
    }
}

/// `1/4 rev` is 1/(4 rev): the help where that is what happened.
fn divided_unit(node: &Node, found: Dimension, expected: Dimension) -> Option<String> {
    let Kind::Binary {
        op: BinaryOp::Div,
        left,
        right,
    } = &node.kind
    else {
        return None;
    };
    let Kind::Quantity(quantity) = &right.kind else {
        return None;
    };
    let numerator = left.as_bare_number()?;
    if !(Dimension::NONE / found).compatible(expected) || quantity.value == 0.0 {
        return None;
    }
    let (unit, below) = (
        quantity.unit.text(),
        kempe_number::text::shortest(quantity.value),
    );
    let above = kempe_number::text::shortest(numerator);
    let value = crate::unit::format_digits(numerator / quantity.value, &Unit::one(), 12);
    Some(format!(
        "a unit binds tighter than `/`: write `{value} {unit}` or `{above}/{below} * 1 {unit}`"
    ))
}

/// How two dimensions that should be one are related.
fn relation(left: Dimension, right: Dimension) -> String {
    if [left, right].contains(&Dimension::ANGLE) && [left, right].contains(&Dimension::NONE) {
        return "a number is made an angle by `* 1 deg` or `* 1 rad`, an angle a number by `/ 1 rad`".to_owned();
    }
    let pair = [left, right];
    if pair.contains(&Dimension::ANGULAR_SPEED) && pair.contains(&Dimension::FREQUENCY) {
        return "turns per second are `rev/s`: multiply the frequency by `1 rev`, or by `1 rad` if it is an angular one".to_owned();
    }
    match between(right, left) {
        Some(how) => format!("both must measure the same; {how}"),
        None => {
            "both must measure the same: look for a wrong unit, a missing factor or a wrong name"
                .to_owned()
        }
    }
}

/// How one dimension becomes the other: `a force times a length is a torque`.
fn between(found: Dimension, expected: Dimension) -> Option<String> {
    // what has no word of its own says nothing in a sentence
    let has_word = |d: Dimension| !d.is_number() && !d.with_article().starts_with("a quantity");
    if !has_word(found) || !has_word(expected) {
        return None;
    }
    let (a, b) = (found.with_article(), expected.with_article());
    for by in [
        Dimension::LENGTH,
        Dimension::TIME,
        Dimension::MASS,
        Dimension::ANGLE,
        Dimension::AREA,
        Dimension::SPEED,
        Dimension::ANGULAR_SPEED,
        Dimension::ACCELERATION,
    ] {
        if (found * by).compatible(expected) {
            return Some(format!("{a} times {} is {b}", by.with_article()));
        }
        if (found / by).compatible(expected) {
            return Some(format!("{a} divided by {} is {b}", by.with_article()));
        }
    }
    None
}
