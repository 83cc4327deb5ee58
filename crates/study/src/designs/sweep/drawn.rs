//! What is drawn of several designs in one picture.

use kempe_model::{Plot, PointId};

/// What is drawn of several designs in one picture.
#[derive(Clone, Debug)]
pub(super) enum Drawn {
    /// Columns, by their names.
    Curves(Vec<String>),
    /// The path of a point.
    Path(PointId),
}

impl Drawn {
    /// What a plot of one design is of several; hodographs are not drawn of several.
    pub fn of(plot: &Plot) -> Option<Self> {
        match plot {
            Plot::Curves(columns) => {
                let names = columns.iter().map(|column| column.name.clone());
                Some(Self::Curves(names.collect()))
            }
            Plot::Path(point) => Some(Self::Path(*point)),
            Plot::Hodograph(_) => None,
        }
    }
}
