//! The forces of one instant allocate nothing once their storage is there.
#![allow(unsafe_code, reason = "a counting allocator cannot be written without")]

mod support;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use kempe_dynamics::{Forces, Instant};
use kempe_mechanism::{Design, Mechanism};
use kempe_model::DriveId;
use kempe_motion::Motion;
use kempe_number::Jet;

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
fn forces_of_the_door_lock_allocate_nothing() {
    let mut model = support::model(&support::example("door-lock"));
    model.actions.friction.push(kempe_model::Friction {
        at: kempe_model::FrictionAt::All,
        coefficient: support::number(0.1),
        static_coefficient: None,
        stribeck_speed: None,
        viscous: None,
        radius: Some(support::number(0.01)),
        span: 0..0,
    });
    let mechanism = Mechanism::new(&model);
    let parameters: Vec<f64> = model.parameter_values();
    let design = Design::new(&mechanism, &parameters);
    let motion = Motion::new(&design).expect("a motion");
    let rich: Design<Jet<f64, 3>> =
        Design::new(&mechanism, &model.parameter_values::<Jet<f64, 3>>());
    let mut forces = Forces::new(design.clone()).expect("forces");
    let mut instant = Instant::new(&mechanism, 0);
    let mut solver = motion.solver();
    motion.solve(&rich, Jet::variable(0.3), &mut solver);
    let mut once = |speed: f64| {
        let near = &solver.branch.near;
        instant.set_along(&solver.state, near, DriveId(0), [speed, 2.0]);
        forces.solve(&instant);
        forces.drives[0].value
    };
    let first = once(1.0);
    let before = COUNT.with(Cell::get);
    let again = once(1.0);
    let other = once(2.0);
    assert_eq!(COUNT.with(Cell::get), before);
    assert!(first == again && other.is_finite() && other != first);
}
