//! Drives and joints let go: a mechanism with more freedoms.

use std::sync::Arc;

use kempe_model::{Drive, DriveId, DriveKind, Law, LawPiece, Model, PointId, Released};
use kempe_units::{Dimension, Expr};

use crate::Mechanism;
use crate::constraint::{Joint, Source, Unit};
use crate::structure::Structure;

/// Why something cannot be let go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum NotReleased {
    /// The mechanism has no such joint or drive, or its bodies are one: a weld, or a pin between links that are welded.
    NoConstraint(Source),
    /// It is let go already, or named twice.
    Twice(Source),
    /// Its pin runs on a smooth curve: its rows say where along the curve the pin is, not how far off it stands.
    OnCurve(Source),
    /// A wheel of a gear pair or belt turns on this pin: how it meshes with its pin open, nobody says.
    CarriesWheel(Source),
}

impl std::fmt::Display for NotReleased {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoConstraint(what) => write!(
                f,
                "{what:?} holds no two bodies together: name a drive, or a joint that is no weld"
            ),
            Self::Twice(what) => write!(f, "{what:?} is let go already: name it once"),
            Self::OnCurve(what) => write!(
                f,
                "{what:?} is a pin on a smooth curve, which cannot be let go: let go of a drive, or of another joint"
            ),
            Self::CarriesWheel(what) => write!(
                f,
                "on {what:?} turns a wheel, whose gears or belt need the pin: let go of these, too"
            ),
        }
    }
}

impl std::error::Error for NotReleased {}

impl Mechanism {
    /// Whether joints are let go, so that a point may be at several places: on each of its links at another.
    pub fn comes_apart(&self) -> bool {
        let mut drives = self.model.drives.iter();
        drives.any(|drive| matches!(drive.kind, DriveKind::Release { .. }))
    }

    /// The mechanism with drives and joints let go: [`Mechanism::released`] names the coordinates that are free then.
    ///
    /// A drive keeps its coordinate and gives nothing any more. A joint gets a coordinate for each of its rows, how far it
    /// stands open there, in the row's unit (a pin: the later link's point seen from the first link's, m along the frame's
    /// axes; a slider: the angle it is turned by, rad, and its distance from the line, m). They are drives behind
    /// the model's own, which stand at zero unless somebody says otherwise: bodies, parameters and markers stay what they
    /// are, so that a pose of the mechanism is one of the new mechanism with these coordinates at zero
    /// ([`Design::branch_through`](crate::Design::branch_through) gives its branch). What other joints say as well is no
    /// freedom: such rows are in the surplus of the plan's decomposition.
    ///
    /// # Errors
    /// The first of `what` that cannot be let go.
    pub fn releasing(&self, what: &[Source]) -> Result<Arc<Self>, NotReleased> {
        let mut model = self.model.clone();
        let mut released = self.released.clone();
        for &source in what {
            let before = released.len();
            match source {
                Source::Drive(drive) => {
                    if drive.index() >= self.model.drives.len() {
                        return Err(NotReleased::NoConstraint(source));
                    }
                    if released.contains(&drive) {
                        return Err(NotReleased::Twice(source));
                    }
                    released.push(drive);
                }
                Source::Pin { point, link } => {
                    self.release(&mut model, &mut released, Released::Pin { point, link })?;
                }
                Source::Joint(joint) => {
                    self.release(&mut model, &mut released, Released::Joint(joint))?;
                }
            }
            if released.len() == before {
                return Err(NotReleased::NoConstraint(source));
            }
        }
        let structure = Structure::new(&model);
        let needed = structure
            .constraints
            .iter()
            .filter_map(|(c, _)| c.needs_pins());
        let needed: Vec<PointId> = (needed.flatten())
            .map(|pin| structure.markers[pin.index as usize].point)
            .collect();
        let carries = |source: &&Source| matches!(source, Source::Pin { point, .. } if needed.contains(point));
        if let Some(pin) = what.iter().find(carries) {
            return Err(NotReleased::CarriesWheel(*pin));
        }
        let mut it = Self::planned(structure);
        it.released = released;
        Ok(Arc::new(it))
    }

    /// Adds a drive for every row of a joint.
    fn release(
        &self,
        model: &mut Model,
        released: &mut Vec<DriveId>,
        of: Released,
    ) -> Result<(), NotReleased> {
        let is_let_go =
            |drive: &Drive| matches!(drive.kind, DriveKind::Release { of: open, .. } if open == of);
        if model.drives.iter().any(is_let_go) {
            return Err(NotReleased::Twice(of.into()));
        }
        let own = self
            .constraints
            .iter()
            .filter(|(_, from)| *from == of.into());
        if own
            .clone()
            .any(|(it, _)| it.releasing(0, DriveId(0)).is_none())
        {
            return Err(NotReleased::OnCurve(of.into()));
        }
        let units = own.flat_map(|(constraint, _)| vec![constraint.unit(); constraint.rows()]);
        for (row, unit) in (0..).zip(units) {
            released.push(DriveId(model.drives.len() as u32));
            let kind = DriveKind::Release { of, row };
            model.drives.push(Drive {
                name: kind.released_name(model).unwrap_or_default(),
                kind,
                law: Law {
                    from: Expr::Const(0.0),
                    pieces: vec![LawPiece::Dwell {
                        duration: Expr::Const(0.0),
                    }],
                },
                dimension: match unit {
                    Unit::Length => Dimension::LENGTH,
                    Unit::Angle => Dimension::ANGLE,
                },
                span: 0..0,
            });
        }
        Ok(())
    }
}
