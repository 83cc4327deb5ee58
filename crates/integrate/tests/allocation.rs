//! Steps allocate nothing once their storage is there.
#![allow(unsafe_code, reason = "a counting allocator cannot be written without")]

mod support;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use kempe_integrate::{Integrator, Method};
use support::{tolerance, van_der_pol};

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

struct Counting;

// SAFETY: every call is handed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let _ = COUNT.try_with(|c| c.set(c.get() + 1));
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, ptr: *mut u8, layout: Layout) {
        unsafe { System.dealloc(ptr, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

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
        let (before, used) = (COUNT.with(Cell::get), it.used());
        go(&mut it, 4.0);
        assert_eq!(COUNT.with(Cell::get), before, "{method:?}");
        if method == Method::Choose {
            assert!(it.used().explicit > used.explicit && it.used().implicit > used.implicit);
        }
    }
}
