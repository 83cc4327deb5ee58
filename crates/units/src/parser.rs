//! Text to tree: a Pratt parser that reports all it finds.
//!
//! # Grammar
//!
//! ```text
//! condition  = expression comparison expression ;
//! comparison = "<=" | ">=" | "<" | ">" ;
//! expression = term { ( "+" | "-" ) term } ;
//! term       = factor { ( "*" | "·" | "/" ) factor } ;
//! factor     = ( "-" | "+" ) factor | power ;
//! power      = atom [ "^" factor | raised ] ;
//! atom       = number [ unit ] | name | point | call | "(" expression ")" ;
//! call       = name "(" [ argument { "," argument } ] ")" ;
//! argument   = expression [ "->" expression ] ;
//! unit       = unit-power { ( blank | "*" | "·" | "/" ) unit-power } ;
//! unit-power = unit-name [ "^" [ "-" ] digits | raised ] ;
//! number     = ( digits [ "." [ digits ] ] | "." digits ) [ "e" [ "+" | "-" ] digits ] ;
//! raised     = [ "⁻" ] ( "⁰" | "¹" | "²" | … | "⁹" ) { … } ;
//! name       = ( small letter | "_" ) { letter | digit | "_" } ;
//! point      = capital letter { letter | digit | "_" } ;
//! ```
//!
//! Written alone ([`Unit::parse`]), a unit may also be `1`, start with `1/`, or be empty: the unit of plain numbers.
//!
//! # How a number takes its unit
//!
//! * A unit stands directly after a number literal and binds tighter than any operator: `1/2 m` is `1/(2 m)`,
//!   `5 mm^2` is five square millimetres, `(5 mm)^2` is 25. Nothing else may follow a number without an operator,
//!   so `2 crank` is an error, and a unit is raised once: `5 mm^2^2` is an error too.
//! * The unit goes on greedily while a blank, `*`, `·` or `/` is followed by a unit's name that is not called:
//!   `9.81 m/s^2`, `3 N m`, `2 kg*mm^2`. After a blank the name must be a unit; after an operator any other name ends the
//!   unit. Elsewhere a unit's name is an ordinary name: in `2*s` it is the parameter `s`.
//! * A product by a blank does not follow a division: `kg/m s` could mean two things and is an error.
//! * Where a name behind `*`, `·` or a spaced `/` is both a unit and declared, [`check`](crate::check()) does not
//!   guess: see there. A division without blanks, `9.81 m/s^2`, is the unit's.

mod unit;

use crate::Unit;
use crate::issue::{Issue, Span, SyntaxError};
use crate::lexer::{Token, tokens, too_large};
use crate::syntax::{BinaryOp, CONSTANTS, Comparison, Condition, Kind, Node, Quantity};
use crate::unit_table::{find, foreign, instead_of};
use kempe_number::text::{rounded, shortest};

/// The longest text that is read, in bytes.
pub const MAX_LENGTH: usize = 4096;

/// The deepest tree that is built: nested brackets, and operators in a row.
pub const MAX_DEPTH: usize = 128;

/// After this many problems no more are looked for.
const MAX_ERRORS: usize = 16;

/// The expression written `text`.
///
/// # Errors
///
/// All problems found, in the order of the text.
///
/// # Example
///
/// ```
/// let node = kempe_units::parse("2*crank + 5 mm").unwrap();
/// assert_eq!(node.to_string(), "2 * crank + 5 mm");
/// let errors = kempe_units::parse("2*crank + 5 mmm").unwrap_err();
/// assert_eq!(errors[0].message, "unknown unit `mmm`");
/// assert_eq!(errors[0].help.as_deref(), Some("did you mean `mm`?"));
/// ```
pub fn parse(text: &str) -> Result<Node, Vec<SyntaxError>> {
    Parser::run(text, |parser| parser.expression(Power::LOWEST).node)
}

/// One argument written alone: an expression, or a directed line `A -> B`.
///
/// # Errors
///
/// All problems found, in the order of the text.
pub fn parse_argument(text: &str) -> Result<Node, Vec<SyntaxError>> {
    Parser::run(text, |parser| parser.argument().node)
}

/// The condition written `text`, such as `range(y(M)) >= 450 mm`.
///
/// # Errors
///
/// All problems found, in the order of the text.
pub fn parse_condition(text: &str) -> Result<Condition, Vec<SyntaxError>> {
    Parser::run(text, Parser::condition)
}

/// How tightly operators bind.
struct Power;

impl Power {
    const LOWEST: u8 = 0;
    const SUM: u8 = 1;
    const PRODUCT: u8 = 3;
    const NEGATION: u8 = 5;
    const POWER: u8 = 7;
}

/// A node, where it stands with the brackets around it, and the height of the tree.
struct Built {
    node: Node,
    outer: Span,
    height: usize,
}

impl Built {
    fn new(node: Node, height: usize) -> Self {
        Self {
            outer: node.span.clone(),
            node,
            height,
        }
    }
}

/// The tokens, the place in them, and what is wrong so far.
struct Parser<'t> {
    text: &'t str,
    tokens: Vec<(Token, Span)>,
    /// Where signs were left out that the language does not have.
    skipped: Vec<usize>,
    at: usize,
    depth: usize,
    /// Whether a comparison may stand at the outermost level.
    compares: bool,
    errors: Vec<SyntaxError>,
}

impl<'t> Parser<'t> {
    /// Reads `text` by `read` up to its end.
    fn run<T>(text: &'t str, read: impl FnOnce(&mut Self) -> T) -> Result<T, Vec<SyntaxError>> {
        if text.len() > MAX_LENGTH {
            let issue = Issue::new(
                "too-long",
                0..text.len(),
                format!("the text is longer than {MAX_LENGTH} bytes"),
            )
            .with_help("give parts of it names");
            return Err(vec![issue]);
        }
        let (mut errors, mut skipped) = (Vec::new(), Vec::new());
        let tokens = tokens(text, &mut errors, &mut skipped);
        let mut parser = Self {
            text,
            tokens,
            skipped,
            at: 0,
            depth: 0,
            compares: false,
            errors,
        };
        let out = read(&mut parser);
        parser.rest();
        if parser.errors.is_empty() {
            return Ok(out);
        }
        parser
            .errors
            .sort_by_key(|error| (error.span.start, error.span.end));
        parser.errors.truncate(MAX_ERRORS);
        Err(parser.errors)
    }

    /// Reports what stands behind the end of the reading, and goes on reading there for further problems.
    fn rest(&mut self) {
        while self.peek() != &Token::End && self.errors.len() < MAX_ERRORS {
            self.unexpected();
            if !self.starts_operand() {
                self.advance();
            }
            let before = self.at;
            if self.starts_operand() {
                self.expression(Power::LOWEST);
            }
            if self.at == before && self.peek() != &Token::End {
                self.advance();
            }
        }
    }

    /// Reports a token with which no expression goes on.
    fn unexpected(&mut self) {
        let (message, help) = match self.peek() {
            Token::Close => (
                "a bracket is closed that was not opened",
                "leave it out, or open one with `(` before it".to_owned(),
            ),
            Token::Comma => match self.decimal() {
                Some((span, number)) => {
                    let issue = Issue::new("syntax", span, "a comma stands in a number")
                        .with_help(format!("decimals have a point: {number}"));
                    return self.push(issue);
                }
                None => (
                    "a comma stands outside of a call",
                    "decimals have a point; commas part the arguments of a call".to_owned(),
                ),
            },
            Token::Arrow => (
                "a directed line stands only as an argument",
                "such as in `angle(A -> B)`".to_owned(),
            ),
            _ => ("an operator is missing before this", self.operator_help()),
        };
        let issue = self.issue_here(message);
        self.push(issue.with_help(help));
    }

    /// The number that is meant by `20,5` around the comma here, and where it stands.
    fn decimal(&self) -> Option<(Span, String)> {
        let comma = self.span();
        let before = self.at.checked_sub(1)?;
        let [(whole, a), (part, b)] = [before, self.at + 1].map(|at| {
            let span = self.tokens.get(at).map_or(0..0, |(_, span)| span.clone());
            (self.written(at), span)
        });
        let number = |at: usize| matches!(self.tokens.get(at), Some((Token::Number(_), _)));
        let joined = a.end == comma.start && comma.end == b.start;
        let fits = number(before) && number(self.at + 1) && !whole.contains('.');
        (joined && fits).then(|| (a.start..b.end, format!("{whole}.{part}")))
    }

    /// What to write where two values stand side by side.
    fn operator_help(&self) -> String {
        let here = self.written(self.at);
        let before = match self.at.checked_sub(1).map(|at| &self.tokens[at].0) {
            Some(Token::Name(name)) if find(name).is_none() => format!("{name} "),
            _ => String::new(),
        };
        let after = |k: usize| self.tokens.get(self.at + k).map(|(token, _)| token);
        // `1 1/mm`: a unit below a line.
        if let (Token::Number(_), Some(Token::Slash), Some(Token::Name(name))) =
            (self.peek(), after(1), after(2))
            && find(name).is_some()
        {
            return format!("for the inverse of a unit write `/ 1 {name}`");
        }
        match self.peek() {
            Token::Name(name) if find(name).is_some() => {
                format!("a unit stands behind a number: write `{before}* 1 {here}`")
            }
            Token::Name(_) | Token::Number(_) => format!("for a product write `{before}* {here}`"),
            _ => "for a product write `*` between the two".to_owned(),
        }
    }

    /// A token as it was written.
    fn written(&self, at: usize) -> &'t str {
        let span = self.tokens.get(at).map_or(0..0, |(_, span)| span.clone());
        self.text.get(span).unwrap_or("")
    }

    fn peek(&self) -> &Token {
        &self.tokens[self.at].0
    }

    fn peek_second(&self) -> &Token {
        &self.tokens[(self.at + 1).min(self.tokens.len() - 1)].0
    }

    fn span(&self) -> Span {
        self.tokens[self.at].1.clone()
    }

    fn advance(&mut self) -> Span {
        let span = self.span();
        self.at = (self.at + 1).min(self.tokens.len() - 1);
        span
    }

    fn starts_operand(&self) -> bool {
        matches!(
            self.peek(),
            Token::Number(_) | Token::Name(_) | Token::Open | Token::Minus | Token::Plus
        )
    }

    /// Records an issue, unless one starts at the same place already, it follows from a sign that was left out before it, or the
    /// reading was stopped.
    fn push(&mut self, issue: SyntaxError) {
        let known =
            |error: &Issue| error.span.start == issue.span.start || error.code == "too-deep";
        let before = self
            .tokens
            .partition_point(|(_, span)| span.start < issue.span.start);
        let from = before.checked_sub(1).map_or(0, |i| self.tokens[i].1.end);
        let follows = self
            .skipped
            .iter()
            .any(|at| (from..issue.span.start).contains(at));
        if !follows && !self.errors.iter().any(known) {
            self.errors.push(issue);
        }
    }

    fn issue_here(&self, message: &str) -> SyntaxError {
        Issue::new("syntax", self.span(), message)
    }

    fn error_here(&mut self, message: &str, help: &str) {
        self.push(self.issue_here(message).with_help(help));
    }

    /// A stand-in for what could not be read; no result that holds one is ever returned.
    fn stand_in(&self) -> Built {
        let start = self.span().start;
        Built::new(Node::new(Kind::Number(0.0), start..start), 1)
    }

    /// Builds the node of `kind`, or stops the reading where the tree gets too deep.
    fn build(&mut self, kind: Kind, span: Span, below: usize) -> Built {
        if below + 1 > MAX_DEPTH {
            self.too_deep(span.clone());
            return Built::new(Node::new(Kind::Number(0.0), span), 1);
        }
        Built::new(Node::new(kind, span), below + 1)
    }

    fn too_deep(&mut self, span: Span) {
        let message = format!("the expression has more than {MAX_DEPTH} levels");
        self.push(Issue::new("too-deep", span, message).with_help("give parts of it names"));
        self.at = self.tokens.len() - 1;
    }

    /// The comparison that comes next.
    fn at_comparison(&self) -> Option<Comparison> {
        match self.peek() {
            Token::LessEqual => Some(Comparison::LessEqual),
            Token::GreaterEqual => Some(Comparison::GreaterEqual),
            Token::Less => Some(Comparison::Less),
            Token::Greater => Some(Comparison::Greater),
            _ => None,
        }
    }

    /// `condition`.
    fn condition(&mut self) -> Condition {
        self.compares = true;
        let left = self.expression(Power::LOWEST).node;
        let comparison = self.at_comparison();
        let comparison_span = self.span();
        if comparison.is_some() {
            self.advance();
        } else if self.errors.is_empty() {
            let issue = self.issue_here("a condition needs a comparison");
            self.push(issue.with_help("such as `max(load) <= 80 kN`"));
        }
        let right = match comparison {
            Some(_) => self.expression(Power::LOWEST).node,
            None => self.stand_in().node,
        };
        if self.at_comparison().is_some() {
            let issue = self.issue_here("a condition has one comparison");
            self.push(issue.with_help("write two conditions for two bounds"));
            self.compares = false;
        }
        Condition {
            left,
            comparison: comparison.unwrap_or(Comparison::LessEqual),
            comparison_span,
            right,
        }
    }

    /// `expression`, of operators that bind at least as tightly as `lowest`.
    fn expression(&mut self, lowest: u8) -> Built {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            self.too_deep(self.span());
            self.depth -= 1;
            return self.stand_in();
        }
        let mut left = self.operand();
        loop {
            let (op, power, right_power) = match self.peek() {
                Token::Plus => (BinaryOp::Add, Power::SUM, Power::SUM + 1),
                Token::Minus => (BinaryOp::Sub, Power::SUM, Power::SUM + 1),
                Token::Star | Token::Dot => (BinaryOp::Mul, Power::PRODUCT, Power::PRODUCT + 1),
                Token::Slash => (BinaryOp::Div, Power::PRODUCT, Power::PRODUCT + 1),
                Token::Caret => (BinaryOp::Pow, Power::POWER, Power::NEGATION),
                Token::Raised(_) => (BinaryOp::Pow, Power::POWER, Power::POWER),
                // read as if it joined two values, so that both sides are looked at
                Token::LessEqual | Token::GreaterEqual | Token::Less | Token::Greater
                    if !(self.compares && self.depth == 1) =>
                {
                    (BinaryOp::Sub, Power::LOWEST, Power::SUM)
                }
                _ => break,
            };
            if power < lowest {
                break;
            }
            if power == Power::LOWEST {
                self.error_here(
                    "a comparison has no place here",
                    "a value is wanted: `max(x, y)` and `min(x, y)` choose one of two",
                );
            }
            let right = if let Token::Raised(exponent) = *self.peek() {
                self.raised(exponent)
            } else {
                self.advance();
                if op == BinaryOp::Mul && self.peek() == &Token::Star {
                    let issue = self.issue_here("two operators stand side by side");
                    self.push(issue.with_help("a power is written `^`"));
                    self.advance();
                }
                self.expression(right_power)
            };
            let span = left.outer.start..right.outer.end;
            let below = left.height.max(right.height);
            let kind = Kind::Binary {
                op,
                left: Box::new(left.node),
                right: Box::new(right.node),
            };
            left = self.build(kind, span, below);
        }
        self.depth -= 1;
        left
    }

    /// The exponent that raised digits stand for.
    fn raised(&mut self, exponent: i32) -> Built {
        let span = self.advance();
        let number = self.build(Kind::Number(f64::from(exponent.abs())), span.clone(), 0);
        if exponent < 0 {
            self.build(Kind::Neg(Box::new(number.node)), span, number.height)
        } else {
            number
        }
    }

    /// `atom`, or a negation.
    fn operand(&mut self) -> Built {
        match self.peek().clone() {
            Token::Minus => {
                let start = self.advance().start;
                let inner = self.expression(Power::NEGATION);
                let span = start..inner.outer.end;
                self.build(Kind::Neg(Box::new(inner.node)), span, inner.height)
            }
            // a sign that changes nothing leaves no node
            Token::Plus => {
                let start = self.advance().start;
                let inner = self.expression(Power::NEGATION);
                let outer = start..inner.outer.end;
                Built { outer, ..inner }
            }
            Token::Number(value) => self.number(value),
            Token::Name(name) if self.peek_second() == &Token::Open => self.call(name),
            Token::Name(name) => {
                let span = self.advance();
                let kind = if name.starts_with(char::is_uppercase) {
                    Kind::Point(name)
                } else {
                    Kind::Name(name)
                };
                self.build(kind, span, 0)
            }
            Token::Open => {
                let open = self.advance();
                let inner = self.expression(Power::LOWEST);
                let outer = open.start..self.span().end;
                self.close(open);
                Built { outer, ..inner }
            }
            Token::End => {
                let help = if self.at == 0 {
                    "write a value, such as `20 mm` or `2 * a`"
                } else {
                    "write the value that is missing, or leave out what stands before it"
                };
                self.error_here("the text ends where a value is expected", help);
                self.stand_in()
            }
            _ => {
                let help = if self.at == 0 {
                    "a value starts with a number, a name, a sign or a bracket"
                } else {
                    "a value is missing between this and what stands before it"
                };
                self.error_here("a value is expected here", help);
                self.stand_in()
            }
        }
    }

    /// The `)` that belongs to the bracket at `open`; what stands before it is reported and skipped.
    fn close(&mut self, open: Span) {
        let mut diagnostic = false;
        loop {
            match self.peek() {
                Token::Close => {
                    self.advance();
                    return;
                }
                Token::End => {
                    let issue = Issue::new("syntax", open, "this bracket is not closed");
                    return self.push(issue.with_help("add the `)` that belongs to it"));
                }
                _ if !diagnostic => {
                    diagnostic = true;
                    self.unexpected();
                }
                _ => {}
            }
            let before = self.at;
            if self.starts_operand() {
                self.expression(Power::LOWEST);
            }
            if self.at == before {
                self.advance();
            }
        }
    }

    /// `call`, at its name.
    fn call(&mut self, function: String) -> Built {
        let function_span = self.advance();
        let open = self.advance();
        let mut arguments = Vec::new();
        let mut below = 0;
        while !matches!(self.peek(), Token::Close | Token::End) {
            let argument = self.argument();
            below = below.max(argument.height);
            arguments.push(argument.node);
            // What no argument goes on with is reported and skipped up to the next one.
            if !matches!(self.peek(), Token::Comma | Token::Close | Token::End) {
                self.unexpected();
                self.skip_argument();
            }
            if self.peek() == &Token::Comma {
                self.advance();
                if matches!(self.peek(), Token::Close) {
                    self.error_here(
                        "an argument is expected after the comma",
                        "write it, or leave the comma out",
                    );
                }
            }
        }
        let end = self.span().end;
        self.close(open);
        let span = function_span.start..end;
        self.build(
            Kind::Call {
                function,
                function_span,
                arguments,
            },
            span,
            below,
        )
    }

    /// Skips to the comma or bracket that ends the argument.
    fn skip_argument(&mut self) {
        let mut open = 0_usize;
        loop {
            match self.peek() {
                Token::End => return,
                Token::Comma if open == 0 => return,
                Token::Close if open == 0 => return,
                Token::Close => open -= 1,
                Token::Open => open += 1,
                _ => {}
            }
            self.advance();
        }
    }

    /// `argument`.
    fn argument(&mut self) -> Built {
        let from = self.expression(Power::LOWEST);
        if self.peek() != &Token::Arrow {
            return from;
        }
        self.advance();
        let to = self.expression(Power::LOWEST);
        for end in [&from.node, &to.node] {
            if end.as_point().is_none() {
                let issue = Issue::new(
                    "syntax",
                    end.span.clone(),
                    "a directed line goes from a point to a point",
                );
                self.push(issue.with_help("such as `A -> B`; points start with a capital letter"));
            }
        }
        let span = from.node.span.start..to.node.span.end;
        let below = from.height.max(to.height);
        self.build(
            Kind::Line {
                from: Box::new(from.node),
                to: Box::new(to.node),
            },
            span,
            below,
        )
    }

    /// `number [ unit ]`.
    fn number(&mut self, value: f64) -> Built {
        let span = self.advance();
        let Token::Name(name) = self.peek() else {
            return self.build(Kind::Number(value), span, 0);
        };
        let name = name.clone();
        let calls = self.peek_second() == &Token::Open;
        let constant = CONSTANTS.iter().any(|(constant, _)| *constant == name);
        let unit = find(&name).is_some() || instead_of(&name).is_some();
        if calls || constant || foreign(&name).is_some() || !unit {
            let number = shortest(value);
            let product = format!("for a product write `{number}*{name}`");
            let issue = match calls || constant {
                true => self
                    .issue_here("an operator is missing before this")
                    .with_help(product),
                false => {
                    let unit = self.issue_of_unit(&name, self.span());
                    match foreign(&name) {
                        Some((factor, unit_of_ours)) => unit.with_help(format!(
                            "write `{} {unit_of_ours}`",
                            shortest(rounded(value * factor, 6))
                        )),
                        None => unit.with_help(product),
                    }
                }
            };
            self.push(issue);
            if !calls {
                self.advance();
            }
            return self.build(Kind::Number(value), span, 0);
        }
        let mut factors = Vec::new();
        let start = self.span().start;
        let (joined, end) = self.unit_factors(&mut factors, false);
        if matches!(self.peek(), Token::Caret | Token::Raised(_)) {
            let issue = self.issue_here("this power could be of the unit or of the quantity");
            self.push(issue.with_help("set the quantity in brackets to raise it: `(5 mm^2)^2`"));
        }
        let unit = Unit::from_factors(&factors);
        if !unit.to_si(value).is_finite() {
            self.push(too_large(span.clone()));
        }
        let quantity = Quantity {
            value,
            unit,
            unit_span: start..end,
            joined,
        };
        self.build(Kind::Quantity(quantity), span.start..end, 0)
    }
}
