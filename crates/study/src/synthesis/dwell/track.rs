//! Where a point is as a drive goes on.

use std::sync::Arc;

use kempe_measure::Sample;
use kempe_model::{Diagnostic, Model};
use kempe_motion::Motion;
use kempe_synthesis::C;

use crate::along::Along;
use crate::quantity::Quantity;
use crate::rows::RowPlace;

/// A point on its way.
pub(super) struct Track {
    along: Along,
}

impl Track {
    /// The way of a point along a motion.
    pub fn new(model: &Model, motion: &Arc<Motion>, point: &str) -> Result<Self, Vec<Diagnostic>> {
        let coordinate = |axis: &str| -> Result<Quantity, Vec<Diagnostic>> {
            let it = model.measure(&format!("{axis}({point})"))?;
            Ok(Quantity {
                name: it.name,
                measure: it.measure,
                dimension: it.dimension,
            })
        };
        let (x, y) = (coordinate("x")?, coordinate("y")?);
        let along = Along::new(model, motion, &[&x, &y], false)?;
        Ok(Self { along })
    }

    /// Where the point is, m, at a coordinate of the drive; `None` where it does not get.
    pub fn place(&mut self, at: f64) -> Option<C> {
        match self.along.values(RowPlace::Drive(at)).as_slice() {
            [x, y] if x.is_finite() && y.is_finite() => Some(C::new(*x, *y)),
            _ => None,
        }
    }

    /// Where everything is.
    pub fn whole(&mut self, at: f64) -> Sample {
        self.along.row(RowPlace::Drive(at)).sample
    }
}
