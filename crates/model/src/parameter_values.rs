//! The values of a model's parameters, on any [`Number`].

use kempe_number::Number;

use crate::geometry::value;
use crate::ids::ParameterId;
use crate::model::Model;

impl Model {
    /// The parameters' values in order, as the file gives them, in SI.
    pub fn parameter_values<T: Number>(&self) -> Vec<T> {
        self.parameter_values_with(&mut |_| None)
    }

    /// The parameters' values in order, where `given` may set some of them; those computed from them follow.
    ///
    /// This is how a design is varied: hand a dual number to a parameter and everything built on it carries the
    /// derivative.
    pub fn parameter_values_with<T: Number>(
        &self,
        given: &mut impl FnMut(ParameterId) -> Option<T>,
    ) -> Vec<T> {
        let mut values: Vec<T> = Vec::with_capacity(self.parameters.len());
        for (i, parameter) in self.parameters.iter().enumerate() {
            let next =
                given(ParameterId(i as u32)).unwrap_or_else(|| value(&parameter.value, &values));
            values.push(next);
        }
        values
    }
}
