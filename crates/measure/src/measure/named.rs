//! Named measures, evaluated once at each moment however often others name them.

use std::cell::RefCell;

use kempe_number::Number;

use super::{Along, Series};

/// What is known of one named measure: along what, and the series.
type Known<B> = Vec<(Along, Series<B>)>;

/// Named measures that were evaluated at a moment already, by their place in the model.
#[derive(Clone, Debug)]
pub(crate) struct NamedSeries<B>(RefCell<Vec<Known<B>>>);

impl<B> Default for NamedSeries<B> {
    fn default() -> Self {
        Self(RefCell::default())
    }
}

impl<B: Number> NamedSeries<B> {
    /// The series of a named measure: the known one, or that of `evaluate`, which may ask for others meanwhile.
    pub(super) fn or_evaluate(
        &self,
        index: usize,
        along: Along,
        evaluate: impl FnOnce() -> Series<B>,
    ) -> Series<B> {
        let known = |all: &Vec<Known<B>>| {
            let own = all.get(index)?.iter().find(|(a, _)| *a == along)?;
            Some(own.1)
        };
        let found = known(&self.0.borrow());
        found.unwrap_or_else(|| {
            let series = evaluate();
            let mut all = self.0.borrow_mut();
            if all.len() <= index {
                all.resize_with(index + 1, Vec::new);
            }
            all[index].push((along, series));
            series
        })
    }
}
