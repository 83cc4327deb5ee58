//! The unit part of the grammar, and units written alone.

use std::str::FromStr;

use super::Parser;
use crate::Unit;
use crate::issue::{Issue, Span, SyntaxError};
use crate::lexer::Token;
use crate::syntax::JoinedUnit;
use crate::unit::MAX_UNIT_POWER;
use crate::unit_table::{UNITS, UnitDefinition, find, foreign, instead_of};

/// Powers of the table's units, in the order of writing.
type Factors = Vec<(&'static UnitDefinition, i32)>;

const UNIT_HELP: &str = "such as `mm`, `rad/s` or `kg m^2`";

impl Unit {
    /// The unit written `text`: `mm`, `rad/s`, `N m`, `kg*mm^2`, `kg mm²`, `1/s`, or `1` for plain numbers.
    ///
    /// # Errors
    ///
    /// An issue `unknown-unit` or `syntax`, its span in `text`.
    ///
    /// # Example
    ///
    /// ```
    /// use kempe_units::{Dimension, Unit};
    /// let unit = Unit::parse("kg*mm²").unwrap();
    /// assert_eq!(unit.text(), "kg mm^2");
    /// assert_eq!(unit.dimension(), Dimension::INERTIA);
    /// assert_eq!(unit.to_si(500.0), 5e-4);
    /// ```
    pub fn parse(text: &str) -> Result<Self, SyntaxError> {
        let unit = Parser::run(text, |parser| {
            let mut factors = Vec::new();
            let mut divides = false;
            if parser.peek() == &Token::Number(1.0) {
                parser.advance();
                if parser.peek() == &Token::Slash {
                    parser.advance();
                    divides = true;
                }
            }
            match parser.peek() {
                Token::End if !divides => {}
                Token::Name(_) => {
                    parser.unit_factors(&mut factors, divides);
                }
                _ => parser.error_here("a unit is expected", UNIT_HELP),
            }
            Unit::from_factors(&factors)
        });
        unit.map_err(|mut errors| errors.swap_remove(0))
    }
}

impl FromStr for Unit {
    type Err = SyntaxError;
    fn from_str(text: &str) -> Result<Self, SyntaxError> {
        Self::parse(text)
    }
}

impl Parser<'_> {
    /// The issue of a name that is no unit, with what may be meant.
    pub(super) fn issue_of_unit(&self, name: &str, span: Span) -> SyntaxError {
        let help = match (foreign(name), instead_of(name)) {
            (Some((factor, unit)), _) => format!("it is {factor} {unit}"),
            (None, Some(near)) => format!("did you mean `{near}`?"),
            (None, None) => {
                let units: Vec<&str> = UNITS.iter().map(|unit| unit.symbol).collect();
                format!("the units are {}", units.join(", "))
            }
        };
        Issue::new("unknown-unit", span, format!("unknown unit `{name}`")).with_help(help)
    }

    /// `unit`, at its first name, into `factors`; returns the names that an operator stands before, and the end.
    pub(super) fn unit_factors(
        &mut self,
        factors: &mut Factors,
        mut divides: bool,
    ) -> (Vec<JoinedUnit>, usize) {
        let mut joined = Vec::new();
        let mut divided = divides;
        let mut end = self.unit_power(factors, divides);
        loop {
            let operator = match self.peek() {
                Token::Name(_) => None,
                Token::Star | Token::Dot | Token::Slash => Some(self.peek().clone()),
                _ => break,
            };
            match (&operator, self.peek_second()) {
                (None, Token::Open) => break,
                (None, _) if divided => {
                    let issue =
                        self.issue_here("a unit after a division needs `*` or `/` before it");
                    self.push(issue.with_help("write `kg s/m`, or `kg/m/s`"));
                }
                (None, _) => {}
                (Some(_), Token::Name(name)) => {
                    let called = self
                        .tokens
                        .get(self.at + 2)
                        .is_some_and(|(token, _)| token == &Token::Open);
                    if called || find(name).is_none() {
                        break;
                    }
                    let (sign, span) = (self.span(), self.tokens[self.at + 1].1.clone());
                    let tight = end == sign.start && sign.end == span.start;
                    joined.push(JoinedUnit {
                        name: name.clone(),
                        span,
                        tight_division: tight && operator == Some(Token::Slash),
                    });
                    self.advance();
                }
                (Some(_), _) => break,
            }
            divides = operator == Some(Token::Slash);
            divided |= divides;
            end = self.unit_power(factors, divides);
        }
        (joined, end)
    }

    /// `unit-power`, at its name; returns its end.
    fn unit_power(&mut self, factors: &mut Factors, divides: bool) -> usize {
        let Token::Name(name) = self.peek().clone() else {
            self.error_here("a unit is expected", UNIT_HELP);
            return self.span().start;
        };
        let span = self.advance();
        let definition = find(&name);
        if definition.is_none() {
            let issue = self.issue_of_unit(&name, span.clone());
            self.push(issue);
        }
        let (power, end) = self.unit_exponent(span.end);
        if let Some(definition) = definition {
            factors.push((definition, if divides { -power } else { power }));
        }
        end
    }

    /// The exponent of a unit whose name ends at `name_end`, one where none is written, and the end of both.
    fn unit_exponent(&mut self, name_end: usize) -> (i32, usize) {
        let start = self.span().start;
        let power = match *self.peek() {
            Token::Raised(power) => f64::from(power),
            Token::Caret => {
                self.advance();
                let sign = if self.peek() == &Token::Minus {
                    self.advance();
                    -1.0
                } else {
                    1.0
                };
                let Token::Number(power) = *self.peek() else {
                    let issue = self.issue_here("the power of a unit is a whole number");
                    self.push(
                        issue.with_help("set the quantity in brackets to raise it: `(5 mm)^n`"),
                    );
                    return (1, name_end);
                };
                sign * power
            }
            _ => return (1, name_end),
        };
        let end = self.advance().end;
        if power.fract() != 0.0 || power == 0.0 || power.abs() > f64::from(MAX_UNIT_POWER) {
            let message = format!(
                "the power of a unit is a whole number from 1 to {MAX_UNIT_POWER}, or its negative"
            );
            self.push(
                Issue::new("syntax", start..end, message).with_help("such as `mm^2` or `s^-1`"),
            );
            return (1, end);
        }
        #[expect(
            clippy::cast_possible_truncation,
            reason = "a small whole number, checked above"
        )]
        (power as i32, end)
    }
}
