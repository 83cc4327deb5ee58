//! Numbers whose lanes are poses of one sweep.

use kempe_mechanism::plan::Plan;
use kempe_mechanism::structure::Marker;
use kempe_mechanism::{Branch, Configuration, Design, PlanNumber, PointRoom};
use kempe_number::{Jet, Lanes};

/// A number with `W` lanes, each of which holds a value and perhaps its derivatives to the path parameter.
pub(super) trait Wide<const W: usize>: PlanNumber {
    /// How many orders one lane holds: 1 for values, 3 with first and second derivatives.
    const ORDERS: usize;

    /// What one lane holds.
    type Lane: Single;

    /// The path parameter itself.
    fn seed(p: Lanes<W>) -> Self;

    /// The values (order 0) or derivatives of one order.
    fn order(self, order: usize) -> Lanes<W>;

    /// [`Plan::place_point`], for numbers that can.
    #[inline(always)]
    fn place_point(
        _: &Plan,
        _: usize,
        _: Marker,
        _: &Design<Self>,
        _: &Branch,
        _: &[Configuration<Self>],
        _: &mut impl PointRoom<W>,
    ) -> Option<f64> {
        None
    }

    /// Puts one lane in its place.
    fn set_lane(&mut self, lane: usize, to: Self::Lane);
}

/// What one lane holds: a value and perhaps its derivatives to the path parameter.
pub(super) trait Single: PlanNumber {
    /// The path parameter itself.
    fn seed(p: f64) -> Self;

    /// The value (order 0) or the derivative of one order.
    fn order(self, order: usize) -> f64;
}

impl Single for f64 {
    fn seed(p: f64) -> Self {
        p
    }

    fn order(self, _: usize) -> f64 {
        self
    }
}

impl<const N: usize> Single for Jet<f64, N> {
    fn seed(p: f64) -> Self {
        Self::variable(p)
    }

    fn order(self, order: usize) -> f64 {
        self.derivative(order)
    }
}

impl<const W: usize> Wide<W> for Lanes<W> {
    const ORDERS: usize = 1;

    type Lane = f64;

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn seed(p: Lanes<W>) -> Self {
        p
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn order(self, _: usize) -> Lanes<W> {
        self
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn place_point(
        plan: &Plan,
        step: usize,
        point: Marker,
        design: &Design<Self>,
        branch: &Branch,
        states: &[Configuration<Self>],
        rooms: &mut impl PointRoom<W>,
    ) -> Option<f64> {
        plan.place_point(step, point, design, branch, states, rooms)
    }

    fn set_lane(&mut self, lane: usize, to: f64) {
        self.0[lane] = to;
    }
}

impl<const W: usize, const N: usize> Wide<W> for Jet<Lanes<W>, N> {
    const ORDERS: usize = N;

    type Lane = Jet<f64, N>;

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn seed(p: Lanes<W>) -> Self {
        Self::variable(p)
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn order(self, order: usize) -> Lanes<W> {
        self.derivative(order)
    }

    fn set_lane(&mut self, lane: usize, to: Jet<f64, N>) {
        *self = Self::from_coefficients(std::array::from_fn(|k| {
            let mut lanes = self.coefficient(k);
            lanes.0[lane] = to.coefficient(k);
            lanes
        }));
    }
}
