//! Forces and moments on a mechanism: arrows on one scale for the whole motion, with a legend.

mod arrow;
mod label;
mod legend;
mod scale;
mod sheet;
mod track;

pub(crate) use arrow::{BREAK, HALF_HEAD, HEAD, RIM, Shape, Stroke, moment_radius};
pub(crate) use label::{SIZE as LABEL_SIZE, STANCES};
pub(crate) use scale::Quantity;
pub(crate) use sheet::{LEAST_SCALE, LoadSheet, SHARES};

/// What a force comes from; each has its own colour, line and head.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum LoadRole {
    /// What a joint passes on.
    #[default]
    Reaction,
    /// Put on from outside.
    Load,
    /// Weight.
    Weight,
    /// What a drive gives.
    Drive,
    /// A spring or a damper.
    Spring,
    /// Friction.
    Friction,
}

impl LoadRole {
    /// All roles, in the order of the legend.
    pub const ALL: [LoadRole; 6] = [
        LoadRole::Reaction,
        LoadRole::Load,
        LoadRole::Weight,
        LoadRole::Drive,
        LoadRole::Spring,
        LoadRole::Friction,
    ];

    /// A stable name for classes, colours and CAD layers.
    pub fn name(self) -> &'static str {
        match self {
            LoadRole::Reaction => "reaction",
            LoadRole::Load => "load",
            LoadRole::Weight => "weight",
            LoadRole::Drive => "drive",
            LoadRole::Spring => "spring",
            LoadRole::Friction => "friction",
        }
    }

    /// As the legend and the switches of a page call it.
    pub fn title(self) -> &'static str {
        match self {
            LoadRole::Reaction => "Joint reaction",
            LoadRole::Load => "Load",
            LoadRole::Weight => "Weight",
            LoadRole::Drive => "Drive",
            LoadRole::Spring => "Spring or damper",
            LoadRole::Friction => "Friction",
        }
    }

    /// Its number in [`LoadRole::ALL`].
    pub(crate) fn index(self) -> usize {
        self as usize
    }
}

/// A force, a moment or both, acting on the body that the label names. A force is drawn with its tail at the point, a
/// moment as an arc around it. What is not finite is not drawn; the legend says so.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoadView {
    /// Where it acts, in the fixed frame, m.
    pub at: [f64; 2],
    /// Force, in the fixed frame, N.
    pub vector: [f64; 2],
    /// Moment, N m, counter-clockwise positive; 0 for none.
    pub moment: f64,
    /// What it comes from.
    pub role: LoadRole,
    /// The body it acts on, or what else is to stand at the arrow; may be empty.
    pub label: String,
}

impl LoadView {
    /// A force on a body at a point.
    pub fn force(
        role: LoadRole,
        label: impl Into<String>,
        at: [f64; 2],
        vector: [f64; 2],
    ) -> LoadView {
        LoadView {
            at,
            vector,
            moment: 0.0,
            role,
            label: label.into(),
        }
    }

    /// A moment on a body, drawn around a point.
    pub fn moment(role: LoadRole, label: impl Into<String>, at: [f64; 2], moment: f64) -> LoadView {
        LoadView {
            moment,
            ..LoadView::force(role, label, at, [0.0; 2])
        }
    }
}
