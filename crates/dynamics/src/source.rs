//! Forces along a motion, for the sampler of `kempe-measure`.

use kempe_measure::measure::{Moment, Series};
use kempe_measure::{Curve, ForceSource};
use kempe_model::{ForceMeasure, Measure};

use crate::forces::Forces;
use crate::instant::{Instant, Rates};

/// The forces of the moment last solved, as series in time.
pub(crate) struct Source {
    pub forces: Forces<Rates>,
    pub instant: Instant<Rates>,
    measures: Vec<Measure>,
}

impl Source {
    pub fn new(forces: Forces<Rates>) -> Self {
        let measures: Vec<Measure> = (forces.acting.amounts.iter())
            .map(|a| a.measure.clone())
            .collect();
        Self {
            instant: Instant::new(&forces.design.mechanism, measures.len()),
            measures,
            forces,
        }
    }
}

impl ForceSource for Source {
    fn measures(&self) -> &[Measure] {
        &self.measures
    }

    fn curves(&self) -> Vec<Curve> {
        let amounts = self.forces.acting.amounts.iter();
        let curves = amounts.filter_map(|amount| {
            let (table, _) = amount.curve.as_ref()?;
            Some(Curve {
                over: amount.measure.clone(),
                at: table.knots().to_vec(),
                period: table.period(),
            })
        });
        curves.collect()
    }

    fn solve(&mut self, moment: &Moment<'_, f64>) {
        self.instant.set(moment);
        for (value, amount) in self
            .instant
            .amounts
            .iter_mut()
            .zip(&self.forces.acting.amounts)
        {
            *value = amount.rates(moment);
        }
        self.forces.solve(&self.instant);
    }

    fn answer(&self, measure: &ForceMeasure) -> Series<f64> {
        let rates = self.forces.answer(&self.instant, measure);
        Series::from_coefficients(std::array::from_fn(|k| {
            if k < 3 {
                rates.coefficient(k)
            } else {
                f64::NAN
            }
        }))
    }
}
