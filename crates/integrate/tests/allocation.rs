//! Steps allocate nothing once their storage is there.

#[path = "support/counting.rs"]
mod counting;
mod support;

use counting::allocations;
use kempe_integrate::{Integrator, Method};
use support::{tolerance, van_der_pol};

#[test]
fn steps_between_and_restarts_allocate_nothing() {
    let mut system = van_der_pol(1e4);
    for method in [Method::Explicit, Method::Implicit, Method::Choose] {
        let mut it = Integrator::with(method, &mut system, 0.0, &[2.0, 0.0], 1.0, tolerance(1e-6))
            .expect("rates");
        let mut state = [0.0; 2];
        let mut go = |it: &mut Integrator, end: f64| {
            while it.time() < end {
                it.step(&mut system, end).expect("a step");
                let middle = 0.5 * (it.before() + it.time());
                assert!(it.between(&mut system, middle, &mut state));
            }
            assert!(it.restart(&mut system, end, &state));
        };
        // By then both methods were used where both may be.
        go(&mut it, 1.0);
        let used = it.used();
        assert_eq!(allocations(|| go(&mut it, 4.0)), 0, "{method:?}");
        if method == Method::Choose {
            assert!(it.used().explicit > used.explicit && it.used().implicit > used.implicit);
        }
    }
}
