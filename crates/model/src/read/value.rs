//! Values: a bare number in the file's unit, or a string with an expression.

use kempe_units::{Dimension, Expr, Issue, Resolver, Unit, check, check_as, format_digits, parse};

use crate::bound::{Bound, Keeps, STEEPEST, beyond, remedy};
use crate::decimal::torn;
use crate::diagnostic::{Diagnostic, Label};
use crate::geometry::value;
use crate::ids::{ParameterId, Scalar, Span};
use crate::link::Place;
use crate::node::{Node, Text, Value};
use crate::read::context::{Context, Meaning};

/// The code of an issue that follows from one already told, and is not told again.
pub(crate) const ALREADY_TOLD: &str = "already-told";

/// Names of an expression over the parameters.
pub(crate) struct Parameters<'c, 'a>(pub &'c Context<'a>);

impl Resolver<ParameterId> for Parameters<'_, '_> {
    fn name(&mut self, name: &str, span: Span) -> Result<(ParameterId, Dimension), Issue> {
        match self.0.names.get(name) {
            Some((Meaning::Parameter(id), _)) => self.0.parameter(*id, span),
            Some((meaning, _)) => {
                let message = format!(
                    "`{name}` is {}: a dimension is computed from parameters only",
                    meaning.what()
                );
                Err(Issue::new("unknown-name", span, message)
                    .with_label("not a parameter")
                    .with_help("give what both need a name under [parameters]"))
            }
            None => {
                let known = self
                    .0
                    .names
                    .iter()
                    .filter(|(_, (m, _))| matches!(m, Meaning::Parameter(_)));
                Err(Issue::unknown_name(
                    name,
                    span,
                    known.map(|(name, _)| name.as_str()),
                ))
            }
        }
    }

    fn declared(&self, name: &str) -> bool {
        matches!(self.0.names.get(name), Some((Meaning::Parameter(_), _)))
    }
}

/// Names of an expression over the parameters and one name more, which is `None`.
struct OneMore<'c, 'a> {
    parameters: Parameters<'c, 'a>,
    more: Option<(&'c str, Dimension)>,
}

impl Resolver<Option<ParameterId>> for OneMore<'_, '_> {
    fn name(&mut self, name: &str, span: Span) -> Result<(Option<ParameterId>, Dimension), Issue> {
        match self.more {
            Some((more, dimension)) if more == name => Ok((None, dimension)),
            _ => {
                let (id, dimension) = self.parameters.name(name, span)?;
                Ok((Some(id), dimension))
            }
        }
    }

    fn declared(&self, name: &str) -> bool {
        self.more.is_some_and(|(more, _)| more == name) || self.parameters.declared(name)
    }
}

impl Context<'_> {
    /// A parameter with its dimension, unless it is broken.
    pub fn parameter(
        &self,
        id: ParameterId,
        span: Span,
    ) -> Result<(ParameterId, Dimension), Issue> {
        match (
            self.sound.get(id.index()),
            self.model.parameters.get(id.index()),
        ) {
            (Some(true), Some(p)) => Ok((id, p.dimension)),
            _ => Err(Issue::new(ALREADY_TOLD, span, "")),
        }
    }

    /// Tells what is wrong with a text of the file.
    pub fn issues(&mut self, text: &Text, issues: Vec<Issue>) {
        for issue in issues.into_iter().filter(|i| i.code != ALREADY_TOLD) {
            let mut d = Diagnostic::error(issue.code, issue.message).maybe_help(issue.help);
            d.labels.push(Label {
                span: text.span(issue.span),
                text: issue.label,
                primary: true,
                source: None,
            });
            self.push(d);
        }
    }

    /// The unit of bare numbers where a `dimension` is expected.
    pub fn bare_unit(&self, dimension: Dimension) -> Unit {
        Unit::for_display(dimension, &self.preferred)
    }

    /// A dimension of the design: an expression over the parameters that measures `expected` and is finite.
    pub fn scalar(&mut self, node: &Node, expected: Dimension) -> Option<Scalar> {
        self.scalar_over(node, expected, None)
    }

    /// As [`scalar`](Self::scalar), over one more name too, of the same dimension.
    pub fn scalar_over(
        &mut self,
        node: &Node,
        expected: Dimension,
        more: Option<(&str, &Scalar)>,
    ) -> Option<Scalar> {
        let scalar = match &node.value {
            Value::Number(x) => Expr::Const(self.bare_unit(expected).to_si(*x)),
            Value::Text(text) => {
                let unit = self.bare_unit(expected);
                let mut names = OneMore {
                    parameters: Parameters(self),
                    more: more.map(|(name, _)| (name, expected)),
                };
                let checked = parse(&text.content)
                    .and_then(|tree| check_as(&tree, &mut names, expected, &unit));
                match checked {
                    Ok((scalar, _)) => scalar.substitute(&mut |leaf| match (leaf, more) {
                        (None, Some((_, value))) => value.clone(),
                        // no other leaf is without a parameter
                        (leaf, _) => leaf.map_or(Expr::Const(f64::NAN), Expr::Leaf),
                    }),
                    Err(issues) => {
                        self.issues(text, issues);
                        return None;
                    }
                }
            }
            _ => {
                let example = self.example(expected);
                self.wrong_type(
                    node,
                    &format!("this {expected}"),
                    "a number or a string",
                    &example,
                );
                return None;
            }
        };
        self.finite(&scalar, &node.span, expected)?;
        Some(scalar)
    }

    /// A plain number as a formula over the parameters and one number more, with its text.
    pub fn formula_of(
        &mut self,
        node: &Node,
        variable: &str,
    ) -> Option<(String, Expr<Option<ParameterId>>)> {
        let text = self.text(
            node,
            &format!("a formula of {variable}"),
            &format!("\"{variable}^2\""),
        )?;
        let mut names = OneMore {
            parameters: Parameters(self),
            more: Some((variable, Dimension::NONE)),
        };
        let checked = parse(&text.content)
            .and_then(|tree| check_as(&tree, &mut names, Dimension::NONE, &Unit::one()));
        match checked {
            Ok((formula, _)) => Some((text.content.trim().to_owned(), formula)),
            Err(issues) => {
                self.issues(text, issues);
                None
            }
        }
    }

    /// A dimension of the design whose dimension is to be seen from the text; a bare number measures `bare`.
    pub fn inferred(&mut self, node: &Node, bare: Dimension) -> Option<(Scalar, Dimension)> {
        let Value::Text(text) = &node.value else {
            return self.scalar(node, bare).map(|s| (s, bare));
        };
        let checked = parse(&text.content).and_then(|tree| match tree.as_bare_number() {
            Some(x) => Ok((Expr::Const(self.bare_unit(bare).to_si(x)), bare)),
            None => check(&tree, &mut Parameters(self)),
        });
        match checked {
            Ok((scalar, dimension)) => {
                self.finite(&scalar, &node.span, dimension)?;
                Some((scalar, dimension))
            }
            Err(issues) => {
                self.issues(text, issues);
                None
            }
        }
    }

    /// The value of a scalar in SI.
    pub fn number(&self, scalar: &Scalar) -> f64 {
        value(scalar, &self.values)
    }

    /// The value, or an error when it is not finite or beyond what can be computed with.
    pub fn finite(&mut self, scalar: &Scalar, span: &Span, dimension: Dimension) -> Option<f64> {
        let x = self.number(scalar);
        if x.is_finite() {
            // what comes to nearly nothing was likely to come to nothing, unless it is written so
            let written = scalar.as_constant().is_some() || x.abs() > 1.0;
            if written && let Some(how) = beyond(x, dimension) {
                return self.out_of_range(how, "this value", span, dimension);
            }
            self.bound(scalar, span, "this value", dimension, Keeps::Finite);
            return Some(x);
        }
        let found = if x.is_nan() {
            "not a number"
        } else {
            "infinite"
        };
        self.push(
            Diagnostic::error("not-finite", format!("this value is {found}"))
                .at(span.clone(), format!("{found} with the parameters' values"))
                .help("look for a division by zero, the root of a negative number or an overflow"),
        );
        None
    }

    /// Tells a value that nothing can be computed with.
    fn out_of_range<T>(
        &mut self,
        how: &str,
        what: &str,
        span: &Span,
        dimension: Dimension,
    ) -> Option<T> {
        let message = format!("{what} is {how} to be computed with");
        self.refuse("out-of-range", message, span, remedy(dimension))
    }

    /// Notes what a value that depends on parameters must keep to.
    pub fn bound(
        &mut self,
        scalar: &Scalar,
        span: &Span,
        what: &str,
        dimension: Dimension,
        keeps: Keeps,
    ) {
        if scalar.leaves().next().is_some() {
            self.model.bounds.push(Bound {
                value: scalar.clone(),
                keeps,
                what: what.to_owned(),
                dimension,
                span: span.clone(),
            });
        }
    }

    /// The same for how far the second of two values is above the first.
    pub fn apart(
        &mut self,
        [low, high]: [&Scalar; 2],
        span: &Span,
        what: &str,
        dimension: Dimension,
        keeps: Keeps,
    ) {
        let apart = Expr::Sub(Box::new(high.clone()), Box::new(low.clone()));
        self.bound(&apart, span, what, dimension, keeps);
    }

    /// The value of a scalar that goes into the model as a plain number.
    pub fn settle(&mut self, scalar: &Scalar) -> f64 {
        self.model.settled.extend(scalar.leaves().copied());
        self.number(scalar)
    }

    /// A scalar that must be positive (or, with `zero`, not negative).
    pub fn positive(
        &mut self,
        node: &Node,
        dimension: Dimension,
        what: &str,
        zero: bool,
    ) -> Option<Scalar> {
        let scalar = self.scalar(node, dimension)?;
        self.sized(scalar, &node.span, dimension, what, zero)
    }

    /// One that was read, which must be positive (or, with `zero`, not negative).
    pub fn sized(
        &mut self,
        scalar: Scalar,
        span: &Span,
        dimension: Dimension,
        what: &str,
        zero: bool,
    ) -> Option<Scalar> {
        let x = self.number(&scalar);
        if x > 0.0 || (zero && x == 0.0) {
            if let Some(how) = beyond(x, dimension) {
                return self.out_of_range(how, what, span, dimension);
            }
            let keeps = if zero {
                Keeps::NotNegative
            } else {
                Keeps::Positive
            };
            self.bound(&scalar, span, what, dimension, keeps);
            return Some(scalar);
        }
        let found = if x == 0.0 {
            "zero".to_owned()
        } else {
            self.show(x, dimension)
        };
        let wanted = if zero {
            "must not be negative"
        } else {
            "must be positive"
        };
        let or_zero = if zero { "0, or " } else { "" };
        self.push(
            Diagnostic::error("bad-size", format!("{what} {wanted}, found {found}"))
                .at(span.clone(), format!("this is {found}"))
                .help(match dimension {
                    // Plain numbers have bounds of their own.
                    Dimension::NONE => format!("give {or_zero}a positive number"),
                    _ => {
                        let example = self.example(dimension);
                        format!("give {or_zero}a positive value, such as {example}")
                    }
                }),
        );
        None
    }

    /// Refuses a positive pressure angle that no gear has.
    pub fn pressure_angle(&mut self, angle: &Scalar, node: &Node, what: &str) -> Option<()> {
        self.bound(
            angle,
            &node.span,
            what,
            Dimension::ANGLE,
            Keeps::PressureAngle,
        );
        if self.number(angle) < STEEPEST {
            return Some(());
        }
        let found = self.show(self.number(angle), Dimension::ANGLE);
        self.refuse(
            "pressure-angle",
            format!("{what} must be below 45 deg, found {found}"),
            &node.span,
            "give that of the teeth's profile: \"20 deg\" by the standard, \"14.5 deg\" or \"25 deg\" where drawings say so",
        )
    }

    /// A value in the file's units.
    pub fn show(&self, x: f64, dimension: Dimension) -> String {
        format_digits(x, &self.bare_unit(dimension), 6)
    }

    /// An example of a value of a dimension, as it would stand in the file.
    pub fn example(&self, dimension: Dimension) -> String {
        match dimension {
            Dimension::NONE => "20".to_owned(),
            d => format!("\"20 {}\"", self.bare_unit(d).text()),
        }
    }

    /// Tells that a list has not two entries.
    pub fn not_two(&mut self, node: &Node, items: &[Node], message: String, help: &str) {
        let d = Diagnostic::error("wrong-type", format!("{message}, found {}", items.len()));
        let torn = torn(items).filter(|_| items.len() > 2);
        self.push(match torn {
            Some((at, meant)) => d
                .at(at, "two values")
                .help(format!("decimals have a point: {meant}")),
            None => d.at(node.span.clone(), "").help(help),
        });
    }

    /// A pair: `[x, y]`, or `[r, angle]` when the second is an angle.
    pub fn place(&mut self, node: &Node, what: &str) -> Option<Place> {
        let items = self.array(node, what, "[0, 20] or [\"20 mm\", \"30 deg\"]")?;
        let [first, second] = items else {
            self.not_two(
                node,
                items,
                format!("{what} has two values"),
                "write [x, y], or [radius, angle] with the angle as a string such as \"30 deg\"",
            );
            return None;
        };
        let a = self.inferred(first, Dimension::LENGTH);
        let b = self.inferred(second, Dimension::LENGTH);
        let ((a, a_is), (b, b_is)) = (a?, b?);
        let is_length = |d: Dimension| d.compatible(Dimension::LENGTH);
        if is_length(a_is) && is_length(b_is) {
            return Some(Place::Cartesian { x: a, y: b });
        }
        if is_length(a_is) && b_is == Dimension::ANGLE {
            return Some(Place::Polar {
                radius: a,
                angle: b,
            });
        }
        let (bad, found) = if is_length(a_is) {
            (second, b_is)
        } else {
            (first, a_is)
        };
        let wanted = if is_length(a_is) {
            "length or angle"
        } else {
            "length"
        };
        let help = if a_is == Dimension::ANGLE && is_length(b_is) {
            format!(
                "polar coordinates are [radius, angle]: write [{}, {}]",
                as_written(second),
                as_written(first)
            )
        } else {
            "a place is [x, y] in lengths, or [radius, angle]".to_owned()
        };
        self.push(
            Diagnostic::error(
                "unit-mismatch",
                format!("{wanted} expected, found {}", found.with_article()),
            )
            .at(
                bad.span.clone(),
                format!("this is {}", found.with_article()),
            )
            .help(help),
        );
        None
    }
}

/// A number or a string as it would be written.
fn as_written(node: &Node) -> String {
    match &node.value {
        Value::Text(text) => format!("{:?}", text.content),
        Value::Number(x) => format!("{x}"),
        _ => "…".to_owned(),
    }
}
