//! What a value of the file must keep to.

use kempe_units::Dimension;

use crate::ids::{Scalar, Span};

/// A value of the file that depends on parameters, and what it must keep to.
#[derive(Clone, Debug, PartialEq)]
pub struct Bound {
    /// The value.
    pub value: Scalar,
    /// What it must keep to.
    pub keeps: Keeps,
    /// What it is, in words.
    pub what: String,
    /// Its dimension.
    pub dimension: Dimension,
    /// Where it stands in the file.
    pub span: Span,
}

/// What a value must keep to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keeps {
    /// It is a number.
    Finite,
    /// It is above zero.
    Positive,
    /// It is not below zero.
    NotNegative,
}
