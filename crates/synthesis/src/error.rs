//! Why a request has no answer, or more than can be listed.

use kempe_linear::C;

/// What is wrong with a request. Data are counted from 0 in the order given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SynthesisError {
    /// A datum that is no finite number.
    NotFinite {
        /// Which.
        datum: usize,
    },
    /// So many data and conditions leave freedom: there are infinitely many answers.
    TooFew {
        /// Equations that the data and conditions make.
        equations: usize,
        /// Unknowns that they are to fix.
        unknowns: usize,
    },
    /// So many data and conditions can be kept by no linkage of the kind, unless by chance.
    TooMany {
        /// Equations that the data and conditions make.
        equations: usize,
        /// Unknowns that they are to fix.
        unknowns: usize,
    },
    /// Two lists that belong together differ in length.
    Lengths {
        /// Entries of the first.
        first: usize,
        /// Entries of the second.
        second: usize,
    },
    /// Two data say the same.
    Repeated {
        /// The earlier.
        first: usize,
        /// The later.
        second: usize,
    },
    /// Two data cannot both be: one input is to have two outputs, or the like.
    Contradictory {
        /// The earlier.
        first: usize,
        /// The later.
        second: usize,
    },
    /// The body does not turn: links that move it parallel to itself come in families, as sides of parallelograms.
    Translations,
    /// All poses are turns about one point: any point of the body moves on a circle about it.
    OnePole {
        /// The point.
        pole: C,
    },
    /// A datum outside what its kind may be.
    OutOfRange {
        /// Which.
        datum: usize,
        /// Its value.
        value: f64,
        /// Least allowed.
        least: f64,
        /// Largest allowed.
        most: f64,
    },
    /// The data depend on each other: what they ask for has infinitely many answers.
    Dependent {
        /// The datum, as far as one can be named, that adds nothing to the ones before it.
        datum: usize,
    },
    /// More places of a coupler's point lie on one line or circle than a coupler curve can have in common with it.
    OneCurve {
        /// On what.
        curve: OnCurve,
        /// How many.
        count: usize,
        /// One of them.
        datum: usize,
    },
    /// No such linkage keeps the data.
    None,
    /// The search was stopped before its end.
    Stopped,
}

/// A curve on which places lie that are too special.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OnCurve {
    /// A straight line.
    Line,
    /// A circle.
    Circle,
}

impl std::fmt::Display for OnCurve {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Line => "line",
            Self::Circle => "circle",
        })
    }
}

impl std::fmt::Display for SynthesisError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NotFinite { datum } => write!(f, "datum {} is no finite number", datum + 1),
            Self::TooFew {
                equations,
                unknowns,
            } => write!(
                f,
                "{equations} equations for {unknowns} unknowns: infinitely many linkages do it; give more data or conditions"
            ),
            Self::TooMany {
                equations,
                unknowns,
            } => write!(
                f,
                "{equations} equations for {unknowns} unknowns: no linkage of this kind can keep them all; give fewer"
            ),
            Self::Lengths { first, second } => write!(
                f,
                "{first} entries on one side and {second} on the other: each needs its partner"
            ),
            Self::Repeated { first, second } => {
                write!(f, "data {} and {} are the same", first + 1, second + 1)
            }
            Self::Contradictory { first, second } => write!(
                f,
                "data {} and {} contradict each other",
                first + 1,
                second + 1
            ),
            Self::Translations => write!(
                f,
                "the body does not turn from pose to pose: links come in families, as sides of parallelograms"
            ),
            Self::OnePole { pole } => write!(
                f,
                "all poses are turns about one point ({}, {}): a pin there does it, and any point of the body moves on a circle",
                pole.re, pole.im
            ),
            Self::OutOfRange {
                datum,
                value,
                least,
                most,
            } => write!(
                f,
                "datum {} is {value}, it must lie between {least} and {most}",
                datum + 1
            ),
            Self::Dependent { datum } => write!(
                f,
                "datum {} adds nothing to the others: infinitely many linkages do it",
                datum + 1
            ),
            Self::OneCurve { curve, count, .. } => write!(
                f,
                "{count} places lie on one {curve}, which a coupler curve meets in at most six"
            ),
            Self::None => write!(f, "no linkage of this kind does it"),
            Self::Stopped => write!(f, "stopped before all linkages were found"),
        }
    }
}

impl std::error::Error for SynthesisError {}

/// The first entry that is not finite, as an error.
pub(crate) fn all_finite(values: impl IntoIterator<Item = bool>) -> Result<(), SynthesisError> {
    match values.into_iter().position(|finite| !finite) {
        Some(datum) => Err(SynthesisError::NotFinite { datum }),
        None => Ok(()),
    }
}

/// Whether equations and unknowns are of one number.
pub(crate) fn balanced(equations: usize, unknowns: usize) -> Result<(), SynthesisError> {
    match equations.cmp(&unknowns) {
        std::cmp::Ordering::Less => Err(SynthesisError::TooFew {
            equations,
            unknowns,
        }),
        std::cmp::Ordering::Greater => Err(SynthesisError::TooMany {
            equations,
            unknowns,
        }),
        std::cmp::Ordering::Equal => Ok(()),
    }
}
