//! Why a pose is not proved.

use std::fmt;

use kempe_mechanism::Mechanism;
use kempe_mechanism::structure::BodyId;

/// Why a pose is not proved.
#[derive(Clone, Debug, PartialEq)]
pub enum NotProved {
    /// The path parameter lies beyond the motion.
    NotReached,
    /// A drive's law goes from one piece to the next inside the interval.
    Break,
    /// On plain numbers no pose was found that could be proved, or another one than was followed.
    NoPose,
    /// The two assemblies of a step are not told apart: they meet in the interval, or it is too wide.
    Modes {
        /// Index of the step in the plan.
        step: usize,
        /// The bodies that the step places.
        bodies: Vec<BodyId>,
    },
    /// The Jacobian is singular.
    Singular,
    /// No box was found that Krawczyk's operator maps into itself: singular, or the interval is too wide.
    Wide,
    /// The work allowed was used up before the interval was cut narrow enough.
    Spent,
    /// The pose is proved but for redundant constraints, whose agreement can not be proved.
    Redundant {
        /// How many rows.
        rows: usize,
    },
    /// A redundant constraint certainly does not hold.
    Contradiction {
        /// Index of the constraint.
        constraint: usize,
    },
}

impl fmt::Display for NotProved {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotReached => write!(f, "the motion does not reach this place"),
            Self::Break => write!(f, "a drive's law changes its piece inside the interval"),
            Self::Spent => write!(
                f,
                "the work allowed for a proof is used up: prove a shorter range"
            ),
            Self::NoPose => write!(f, "no pose was found that could be proved"),
            Self::Modes { step, .. } => {
                write!(
                    f,
                    "two assemblies of step {step} of the plan are not told apart"
                )
            }
            Self::Singular => write!(f, "the constraint Jacobian is singular"),
            Self::Wide => write!(
                f,
                "Krawczyk's operator does not contract: nearly singular, or the interval is too wide"
            ),
            Self::Redundant { rows } => write!(
                f,
                "{rows} redundant constraint rows are left out of the proof: that they agree can not be proved"
            ),
            Self::Contradiction { constraint } => {
                write!(f, "redundant constraint {constraint} does not hold")
            }
        }
    }
}

impl NotProved {
    /// The reason with the mechanism's own names.
    pub fn describe(&self, mechanism: &Mechanism) -> String {
        match self {
            Self::Modes { bodies, .. } => {
                let names: Vec<String> = bodies.iter().map(|b| mechanism.body_name(*b)).collect();
                format!(
                    "the two assemblies of {} are not told apart",
                    names.join(" and ")
                )
            }
            other => other.to_string(),
        }
    }
}
