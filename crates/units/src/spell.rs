//! Checked expressions back to trees: what [`check`](crate::check()) would read as the same expression.
//!
//! A checked expression holds its constants in SI and no longer says what they measure: `2*crank + 5 mm` is
//! `2*crank + 0.005`. What they measure follows from what the whole measures and from the leaves. Where it does not follow,
//! as in a product of two constants, any choice reads back to the same numbers, and the plainest is taken.

use crate::syntax::{BinaryOp, CONSTANTS, Kind, Node, Quantity};
use crate::{Builtin, Dimension, Expr, Unit};
use kempe_number::text::shortest;

/// What an expression measures if its factors without leaves are taken for plain numbers, and whether it could measure
/// something else if they were not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Natural {
    /// What it measures then.
    pub dimension: Dimension,
    /// Whether it could measure something else.
    pub freedom: Freedom,
}

/// How free an expression is to measure what is wanted of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Freedom {
    /// Its leaves say what it measures.
    Fixed,
    /// Only some dimensions, such as squares.
    Powers,
    /// Any dimension.
    Free,
}

impl Natural {
    /// Of what measures `dimension` and nothing else.
    pub fn fixed(dimension: Dimension) -> Self {
        Self {
            dimension,
            freedom: Freedom::Fixed,
        }
    }

    /// What is asked of it where `wanted` is: its own dimension when that is fixed.
    fn or(self, wanted: Dimension) -> Dimension {
        match self.freedom {
            Freedom::Fixed => self.dimension,
            _ => wanted,
        }
    }
}

/// How leaves and constants of an expression are written.
pub trait Spelling<L> {
    /// What a leaf measures.
    fn natural(&self, leaf: &L) -> Natural;

    /// The leaf as it is written where it measures `dimension`, which matters only to one that is not
    /// [fixed](Freedom::Fixed).
    fn leaf(&self, leaf: &L, dimension: Dimension) -> Node;

    /// The units in which constants are written where they can be exactly, at most one for each dimension.
    fn preferred(&self) -> &[Unit] {
        &[]
    }
}

impl<L> Expr<L> {
    /// The tree of a text that [`check`](crate::check()) reads as this expression, measuring `dimension`.
    ///
    /// Every constant reads back to the same bits: it is written in a preferred unit where that has a number for it, else in
    /// another. So the expression that is read evaluates to the same bits as this one on any number; a negative constant is read
    /// as the negation of a positive one.
    ///
    /// # Example
    ///
    /// ```
    /// use kempe_units::{Dimension, Expr, Kind, Natural, Node, Spelling, Unit};
    /// struct Names([Unit; 1]);
    /// impl Spelling<&str> for Names {
    ///     fn natural(&self, _: &&str) -> Natural {
    ///         Natural::fixed(Dimension::LENGTH)
    ///     }
    ///     fn leaf(&self, name: &&str, _: Dimension) -> Node {
    ///         Node::new(Kind::Name((*name).to_owned()), 0..0)
    ///     }
    ///     fn preferred(&self) -> &[Unit] {
    ///         &self.0
    ///     }
    /// }
    /// let twice = Expr::Mul(Box::new(Expr::Const(2.0)), Box::new(Expr::Leaf("crank")));
    /// let sum = Expr::Add(Box::new(twice), Box::new(Expr::Const(0.0575)));
    /// let names = Names([Unit::parse("mm").unwrap()]);
    /// assert_eq!(sum.to_node(Dimension::LENGTH, &names).to_string(), "2 * crank + 57.5 mm");
    /// ```
    pub fn to_node<S: Spelling<L> + ?Sized>(&self, dimension: Dimension, spelling: &S) -> Node {
        let own = self.natural(spelling);
        match self {
            Self::Const(value) => constant(*value, dimension, spelling.preferred()),
            Self::Leaf(leaf) => spelling.leaf(leaf, own.or(dimension)),
            Self::Neg(a) => negative(a.to_node(dimension, spelling)),
            Self::Add(a, b) | Self::Sub(a, b) => {
                let op = match self {
                    Self::Add(..) => BinaryOp::Add,
                    _ => BinaryOp::Sub,
                };
                let wanted = own.or(dimension);
                let side = |e: &Self| e.to_node(e.natural(spelling).or(wanted), spelling);
                binary(op, side(a), side(b))
            }
            Self::Mul(a, b) | Self::Div(a, b) => {
                let product = matches!(self, Self::Mul(..));
                let (of_a, of_b) = (a.natural(spelling), b.natural(spelling));
                let (mut a_is, mut b_is) = (of_a.dimension, of_b.dimension);
                if own.dimension != dimension && own.freedom != Freedom::Fixed {
                    match (of_a.freedom >= of_b.freedom, product) {
                        (true, true) => a_is = dimension / b_is,
                        (true, false) => a_is = dimension * b_is,
                        (false, true) => b_is = dimension / a_is,
                        (false, false) => b_is = a_is / dimension,
                    }
                }
                let op = if product {
                    BinaryOp::Mul
                } else {
                    BinaryOp::Div
                };
                binary(op, a.to_node(a_is, spelling), b.to_node(b_is, spelling))
            }
            Self::Powi(a, n) => {
                let inner = root(a.natural(spelling), own, dimension, (1, *n));
                binary(
                    BinaryOp::Pow,
                    a.to_node(inner, spelling),
                    signed(f64::from(*n), number),
                )
            }
            Self::Powf(a, p) => {
                let inner = root(a.natural(spelling), own, dimension, (6, sixths(*p)));
                binary(
                    BinaryOp::Pow,
                    a.to_node(inner, spelling),
                    signed(*p, number),
                )
            }
            Self::Call(builtin, arguments) => {
                let wanted = match builtin {
                    Builtin::Sin | Builtin::Cos | Builtin::Tan => Dimension::ANGLE,
                    Builtin::Asin | Builtin::Acos | Builtin::Atan => Dimension::NONE,
                    Builtin::Exp | Builtin::Ln => Dimension::NONE,
                    Builtin::Sqrt => dimension.pow(2, 1).unwrap_or(dimension),
                    Builtin::Atan2 => together(arguments, spelling).dimension,
                    Builtin::Abs | Builtin::Min | Builtin::Max | Builtin::Hypot => {
                        own.or(dimension)
                    }
                };
                let argument = |e: &Self| e.to_node(e.natural(spelling).or(wanted), spelling);
                let kind = Kind::Call {
                    function: builtin.name().to_owned(),
                    function_span: 0..0,
                    arguments: arguments.iter().map(argument).collect(),
                };
                Node::new(kind, 0..0)
            }
        }
    }

    /// What the expression measures where its constant factors are plain numbers.
    pub fn natural<S: Spelling<L> + ?Sized>(&self, spelling: &S) -> Natural {
        match self {
            Self::Const(_) => Natural {
                dimension: Dimension::NONE,
                freedom: Freedom::Free,
            },
            Self::Leaf(leaf) => spelling.natural(leaf),
            Self::Neg(a) => a.natural(spelling),
            Self::Add(a, b) | Self::Sub(a, b) => {
                one_kind([a.natural(spelling), b.natural(spelling)])
            }
            Self::Mul(a, b) | Self::Div(a, b) => {
                let (a, b) = (a.natural(spelling), b.natural(spelling));
                let dimension = match self {
                    Self::Mul(..) => a.dimension * b.dimension,
                    _ => a.dimension / b.dimension,
                };
                Natural {
                    dimension,
                    freedom: a.freedom.max(b.freedom),
                }
            }
            Self::Powi(a, n) => power(a.natural(spelling), 6i32.saturating_mul(*n)),
            Self::Powf(a, p) => power(a.natural(spelling), sixths(*p)),
            Self::Call(builtin, arguments) => match builtin {
                Builtin::Sin | Builtin::Cos | Builtin::Tan | Builtin::Exp | Builtin::Ln => {
                    Natural::fixed(Dimension::NONE)
                }
                Builtin::Asin | Builtin::Acos | Builtin::Atan | Builtin::Atan2 => {
                    Natural::fixed(Dimension::ANGLE)
                }
                Builtin::Sqrt => power(together(arguments, spelling), 3),
                Builtin::Abs | Builtin::Min | Builtin::Max | Builtin::Hypot => {
                    together(arguments, spelling)
                }
            },
        }
    }
}

/// What arguments measure that measure the same.
fn together<L, S: Spelling<L> + ?Sized>(arguments: &[Expr<L>], spelling: &S) -> Natural {
    one_kind(arguments.iter().map(|a| a.natural(spelling)))
}

/// What several measure that measure the same: what the fixed ones do, else the least free.
fn one_kind(of: impl IntoIterator<Item = Natural>) -> Natural {
    let mut of = of.into_iter();
    let Some(first) = of.next() else {
        return Natural::fixed(Dimension::NONE);
    };
    of.fold(first, |known, next| match (known.freedom, next.freedom) {
        (Freedom::Fixed, Freedom::Fixed) => Natural::fixed(known.dimension.common(next.dimension)),
        (a, b) if b < a => next,
        _ => known,
    })
}

/// What a power of `sixths/6` measures.
fn power(base: Natural, sixths: i32) -> Natural {
    let dimension = base.dimension.pow(sixths, 6).unwrap_or(Dimension::NONE);
    let freedom = match base.freedom {
        // roots of anything measure anything, squares only squares
        free if sixths != 0 && 6 % sixths == 0 => free,
        _ if sixths == 0 => Freedom::Fixed,
        free => free.min(Freedom::Powers),
    };
    Natural { dimension, freedom }
}

/// What the base of a power measures so that the power measures `wanted`; its own where that does.
fn root(base: Natural, power: Natural, wanted: Dimension, (up, down): (i32, i32)) -> Dimension {
    if power.dimension == wanted || base.freedom == Freedom::Fixed {
        return base.dimension;
    }
    wanted.pow(up, down).unwrap_or(base.dimension)
}

/// An exponent in sixths; 0 for one that is none, as only plain numbers are raised to.
fn sixths(exponent: f64) -> i32 {
    let sixths = (6.0 * exponent).round();
    match sixths.abs() < 1e6 {
        #[expect(clippy::cast_possible_truncation, reason = "bounded above")]
        true => sixths as i32,
        false => 0,
    }
}

fn binary(op: BinaryOp, left: Node, right: Node) -> Node {
    let kind = Kind::Binary {
        op,
        left: Box::new(left),
        right: Box::new(right),
    };
    Node::new(kind, 0..0)
}

fn negative(node: Node) -> Node {
    Node::new(Kind::Neg(Box::new(node)), 0..0)
}

fn number(value: f64) -> Node {
    Node::new(Kind::Number(value), 0..0)
}

/// A tree has no negative numbers, only negations.
fn signed(value: f64, write: impl FnOnce(f64) -> Node) -> Node {
    match value.is_sign_negative() {
        true => negative(write(-value)),
        false => write(value),
    }
}

/// A constant of `dimension` with its unit.
fn constant(si: f64, dimension: Dimension, preferred: &[Unit]) -> Node {
    signed(si, |si| {
        if dimension == Dimension::NONE {
            let named = CONSTANTS.iter().find(|(_, value)| *value == si);
            return named.map_or_else(
                || number(si),
                |(name, _)| Node::new(Kind::Name((*name).to_owned()), 0..0),
            );
        }
        match Unit::exact(si, dimension, preferred) {
            Some((value, unit)) => quantity(value, unit),
            None => of_no_unit(si, dimension),
        }
    })
}

fn quantity(value: f64, unit: Unit) -> Node {
    let kind = Kind::Quantity(Quantity {
        value,
        unit,
        unit_span: 0..0,
        joined: Vec::new(),
    });
    Node::new(kind, 0..0)
}

/// A constant whose dimension no unit has, such as the root of a length: times a power of `1 m`.
fn of_no_unit(si: f64, dimension: Dimension) -> Node {
    let bases = [
        ("kg", dimension.mass),
        ("m", dimension.length),
        ("rad", dimension.angle),
        ("s", dimension.time),
    ];
    bases.into_iter().filter(|(_, sixths)| *sixths != 0).fold(
        number(si),
        |product, (base, sixths)| {
            let unit = Unit::parse(base).unwrap_or_else(|_| Unit::one());
            let exponent = binary(
                BinaryOp::Div,
                signed(f64::from(sixths), number),
                number(6.0),
            );
            let factor = binary(BinaryOp::Pow, quantity(1.0, unit), exponent);
            binary(BinaryOp::Mul, product, factor)
        },
    )
}

impl Unit {
    /// The number of the fewest digits that reads back, in this unit, as exactly `si`; `None` where no number does.
    ///
    /// # Example
    ///
    /// ```
    /// use kempe_units::Unit;
    /// let deg = Unit::parse("deg").unwrap();
    /// assert_eq!(deg.exact_from_si(deg.to_si(30.0)), Some(30.0));
    /// ```
    pub fn exact_from_si(&self, si: f64) -> Option<f64> {
        let near = self.from_si(si);
        let reads = |x: &f64| x.is_finite() && self.to_si(*x).to_bits() == si.to_bits();
        let rounded = |digits: usize| format!("{near:.*e}", digits - 1).parse::<f64>().ok();
        let neighbours =
            [1, -1, 2, -2].map(|by: i64| f64::from_bits(near.to_bits().wrapping_add_signed(by)));
        (1..=17).filter_map(rounded).chain(neighbours).find(reads)
    }

    /// The number and unit of `dimension` that are exactly `si`: in a preferred unit where that has such a number of no more
    /// digits, else in SI or in units of mm and deg. `None` where no unit has the dimension.
    pub fn exact(si: f64, dimension: Dimension, preferred: &[Self]) -> Option<(f64, Self)> {
        let drawn = ["mm", "deg"].map(|unit| Self::parse(unit).unwrap_or_else(|_| Self::one()));
        let candidates = [
            Some(Self::for_display(dimension, preferred)),
            Some(Self::for_display(dimension, &[])),
            Some(Self::for_display(dimension, &drawn)),
            Self::of_bases(dimension),
        ];
        let digits = |x: f64| {
            let text = shortest(x);
            let mantissa = text.split('e').next().unwrap_or("");
            let digits = mantissa.trim_start_matches(['-', '0', '.']);
            let digits = match digits.contains('.') {
                true => digits,
                false => digits.trim_end_matches('0'),
            };
            digits.chars().filter(char::is_ascii_digit).count()
        };
        candidates
            .into_iter()
            .flatten()
            .filter(|unit| unit.dimension() == dimension)
            .filter_map(|unit| Some((unit.exact_from_si(si)?, unit)))
            .min_by_key(|(x, _)| digits(*x))
    }

    /// The unit of SI made of kg, m, rad and s alone.
    fn of_bases(dimension: Dimension) -> Option<Self> {
        let bases = [
            ("kg", dimension.mass),
            ("m", dimension.length),
            ("rad", dimension.angle),
            ("s", dimension.time),
        ];
        let text: String = bases
            .into_iter()
            .filter(|(_, sixths)| *sixths != 0)
            .map(|(base, sixths)| format!("{base}^{} ", sixths / 6))
            .collect();
        let unit = Self::parse(text.trim_end()).ok()?;
        (unit.dimension() == dimension).then_some(unit)
    }
}
