//! How large an error may be, and how large it is against that.

/// How large the error of one step may be: `absolute + relative * |y|`, in the root of the mean square of all components.
#[derive(Clone, Debug, PartialEq)]
pub struct Tolerance {
    /// Part of the size of a component.
    pub relative: f64,
    /// By component, in its own unit; one for all where there is one only.
    pub absolute: Vec<f64>,
}

impl Tolerance {
    /// What counts as nothing in component `index`, in its own unit.
    pub(crate) fn absolute(&self, index: usize) -> f64 {
        let own = self.absolute.get(index).or(self.absolute.last());
        own.copied().unwrap_or(0.0)
    }

    /// The scale against which an error of component `index` of this size counts.
    fn scale(&self, index: usize, size: f64) -> f64 {
        self.absolute(index) + self.relative * size
    }

    /// Root of the mean square of something of so many components against the tolerance where they are so large.
    pub(crate) fn norm(
        &self,
        components: usize,
        value: impl Fn(usize) -> f64,
        at: impl Fn(usize) -> f64,
    ) -> f64 {
        let sum = (0..components).fold(0.0, |sum, k| {
            let value = value(k);
            // Nothing is within any tolerance, none included: a component that stays zero has no size.
            let part = match value == 0.0 {
                true => 0.0,
                false => value / self.scale(k, at(k).abs()),
            };
            sum + part * part
        });
        (sum / components.max(1) as f64).sqrt()
    }
}
