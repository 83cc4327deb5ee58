//! Numbers whose lanes are poses of one sweep.

use kempe_number::{Jet, Lanes};

use crate::newton::PlanNumber;

/// A number with `W` lanes, each of which holds a value and perhaps its derivatives to the path parameter.
pub(super) trait Wide<const W: usize>: PlanNumber {
    /// How many orders one lane holds: 1 for values, 3 with first and second derivatives.
    const ORDERS: usize;

    /// What one lane holds.
    type Lane: PlanNumber;

    /// The path parameter itself.
    fn seed(p: Lanes<W>) -> Self;

    /// The path parameter in one lane.
    fn seed_lane(p: f64) -> Self::Lane;

    /// The values (order 0) or derivatives of one order.
    fn order(self, order: usize) -> Lanes<W>;

    /// The same of one lane.
    fn order_of_lane(lane: Self::Lane, order: usize) -> f64;

    /// Puts one lane in its place.
    fn set_lane(&mut self, lane: usize, to: Self::Lane);
}

impl<const W: usize> Wide<W> for Lanes<W> {
    const ORDERS: usize = 1;

    type Lane = f64;

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn seed(p: Lanes<W>) -> Self {
        p
    }

    fn seed_lane(p: f64) -> f64 {
        p
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn order(self, _: usize) -> Lanes<W> {
        self
    }

    fn order_of_lane(lane: f64, _: usize) -> f64 {
        lane
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

    fn seed_lane(p: f64) -> Jet<f64, N> {
        Jet::variable(p)
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn order(self, order: usize) -> Lanes<W> {
        self.derivative(order)
    }

    fn order_of_lane(lane: Jet<f64, N>, order: usize) -> f64 {
        lane.derivative(order)
    }

    fn set_lane(&mut self, lane: usize, to: Jet<f64, N>) {
        *self = Self::from_coefficients(std::array::from_fn(|k| {
            let mut lanes = self.coefficient(k);
            lanes.0[lane] = to.coefficient(k);
            lanes
        }));
    }
}
