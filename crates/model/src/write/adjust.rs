//! Studies that adjust.

use kempe_units::Dimension;

use crate::adjust::{AdjustStudy, Matched};
use crate::ids::{ParameterId, Scalar};
use crate::item::Item;
use crate::write::spelling::Writer;

impl Writer<'_> {
    pub fn adjust(&self, study: &AdjustStudy, put: &mut dyn FnMut(&str, Item)) {
        let names = study.unknown.iter();
        let names = names.map(|id| Item::text(self.named_parameter(*id).0));
        put("unknown", Item::List(names.collect()));
        let value = |(what, value): &(Matched, Scalar)| {
            let (name, dimension) = match what {
                Matched::Drive(drive) => {
                    let known = self.model.drives.get(drive.index());
                    let dimension = known.map_or(Dimension::NONE, |d| d.dimension);
                    (self.drive(*drive), dimension)
                }
                Matched::Measure(index) => {
                    let known = study.measures.get(*index);
                    known.map_or(("?", Dimension::NONE), |m| (m.name.as_str(), m.dimension))
                }
            };
            (name.to_owned(), self.scalar(value, dimension))
        };
        let rows = study.rows.iter();
        let rows = rows.map(|row| Item::Table(row.values.iter().map(value).collect()));
        put("match", Item::List(rows.collect()));
        if !study.deviations.is_empty() {
            let table = study.deviations.iter().map(value).collect();
            put("deviations", Item::Table(table));
        }
        if !study.bounds.is_empty() {
            let table = study.bounds.iter().map(|(id, ends)| {
                let (name, dimension) = self.named_parameter(*id);
                (name.to_owned(), self.bounds(ends, dimension))
            });
            put("bounds", Item::Table(table.collect()));
        }
    }

    pub fn named_parameter(&self, id: ParameterId) -> (&str, Dimension) {
        let known = self.model.parameters.get(id.index());
        known.map_or(("?", Dimension::NONE), |p| (p.name.as_str(), p.dimension))
    }
}
