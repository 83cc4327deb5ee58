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
    let help = match (
        found == Dimension::NONE,
        expected == Dimension::NONE && found == Dimension::ANGLE,
    ) {
        (true, _) if expected == Dimension::ANGLE => {
            Some("make it an angle by `* 1 rad`".to_owned())
        }
        (_, true) => Some("make it a number by `/ 1 rad`".to_owned()),
        _ => None,
    };
    Err(vec![
        Issue { help, ..issue }.with_label(format!("this is {}", found.with_article())),
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
                one(issue.with_label("this is a line"))
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
                let number = crate::unit::format_number(value);
                let unit = self.unit_of(wanted);
                return Issue::new("unit-mismatch", node.span.clone(), message)
                    .with_label("this is a number")
                    .with_help(format!("give it a unit: write `{number} {unit}`"));
            }
        }
        let issue = Issue::new("unit-mismatch", right.span.clone(), message)
            .with_label(format!("this is {}", right_is.with_article()));
        let angle_and_number = [left_is, right_is].contains(&Dimension::ANGLE)
            && [left_is, right_is].contains(&Dimension::NONE);
        if angle_and_number {
            return issue.with_help(
                "a number is made an angle by `* 1 rad`, an angle a number by `/ 1 rad`",
            );
        }
        issue
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
            return one(bad(message).with_label(format!("this is {}", exponent_is.with_article())));
        }
        let Some(constant) = exponent.as_constant() else {
            if base_is == Dimension::NONE {
                let logarithm = Expr::Call(Builtin::Ln, vec![base]);
                let product = Expr::Mul(Box::new(exponent), Box::new(logarithm));
                return Ok((Expr::Call(Builtin::Exp, vec![product]), Dimension::NONE));
            }
            let message = format!("{} is raised to a constant only", base_is.with_article());
            return one(bad(message).with_label("this is not constant"));
        };
        if constant.is_nan() || constant.abs() > MAX_EXPONENT {
            return one(bad(format!("an exponent is at most {MAX_EXPONENT}")));
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
                crate::unit::format_number(constant)
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
        let wanted = |wanted: Dimension, help: &str| {
            if x_is == wanted {
                return Ok(());
            }
            let message = format!(
                "`{builtin}` takes {}, found {}",
                wanted.with_article(),
                x_is.with_article()
            );
            let issue = Issue::new("unit-mismatch", first.span.clone(), message);
            let issue = issue.with_label(format!("this is {}", x_is.with_article()));
            one(if help.is_empty() {
                issue
            } else {
                issue.with_help(help)
            })
        };
        let dimension = match builtin {
            Builtin::Sin | Builtin::Cos | Builtin::Tan => {
                let help = if x_is == Dimension::NONE {
                    "a number is made an angle by `* 1 rad`"
                } else {
                    ""
                };
                wanted(Dimension::ANGLE, help)?;
                Dimension::NONE
            }
            Builtin::Asin | Builtin::Acos | Builtin::Atan => {
                wanted(Dimension::NONE, "divide by a quantity of the same kind")?;
                Dimension::ANGLE
            }
            Builtin::Exp | Builtin::Ln => {
                wanted(Dimension::NONE, "divide by a quantity of the same kind")?;
                Dimension::NONE
            }
            Builtin::Sqrt => match x_is.sqrt() {
                Some(dimension) => dimension,
                None => {
                    let message = format!("{} has no square root", x_is.with_article());
                    return one(Issue::new("unit-mismatch", first.span.clone(), message));
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
        .with_label("neither a measure nor a function");
        match nearest(function, known.iter().map(String::as_str).chain(builtins)) {
            Some(near) => issue.with_help(format!("did you mean `{near}`?")),
            None => issue,
        }
    }
}
