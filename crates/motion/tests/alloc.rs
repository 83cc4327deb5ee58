//! No position solve allocates, on any number.
#![allow(unsafe_code, reason = "an allocator that counts has to be one")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::path::Path;

use kempe_mechanism::{Design, Mechanism, PlanNumber};
use kempe_model::Model;
use kempe_motion::Motion;
use kempe_number::{Dual, Jet, Lanes, Lanes8, Number};

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

/// The system's allocator, counting the calls of each thread.
struct Counting;

// SAFETY: everything is handed on to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.with(|c| c.set(c.get() + 1));
        // SAFETY: the caller's promise.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(at, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn allocations(mut work: impl FnMut()) -> usize {
    let before = COUNT.with(Cell::get);
    work();
    COUNT.with(Cell::get) - before
}

/// Solves along the whole motion on one kind of number.
fn solves<T: PlanNumber>(name: &str, motion: &Motion, seed: impl Fn(f64) -> T) {
    let design = motion.design_on::<T>();
    let mut solver = motion.solver::<T>();
    let (low, high) = motion.reached();
    let mut sum = 0.0;
    let count = allocations(|| {
        for i in 0..20 {
            let p = low + (high - low) * (f64::from(i) + 0.5) / 20.0;
            motion.solve(&design, seed(p), &mut solver);
            sum += solver.state.poses[1].c.value();
        }
    });
    assert!(sum.is_finite(), "{name}");
    assert_eq!(count, 0, "{name} on {}", std::any::type_name::<T>());
}

#[test]
fn no_position_solve_allocates() {
    let files = [
        "seeds/crank-rocker",
        "seeds/tractor-hitch",
        "seeds/door-lock",
        "gallery/jansen",
        "gallery/geared-five-bar",
        "gallery/whitworth",
        "gallery/groove-cam",
        "gallery/overhead-door",
    ];
    assert!(allocations(|| drop(std::hint::black_box(Box::new(1)))) > 0);
    for file in files {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
        let text = std::fs::read_to_string(root.join(format!("{file}.toml"))).unwrap();
        let model = Model::from_toml(&text, file, &mut |_| Err("no tables".into()))
            .unwrap()
            .model;
        let mechanism = Mechanism::new(&model);
        let values: Vec<f64> = model.parameter_values();
        let design = Design::new(&mechanism, &values);
        let motion = Motion::new(&design).unwrap();
        solves(file, &motion, |p| p);
        solves(file, &motion, Jet::<f64, 4>::variable);
        solves(file, &motion, Dual::<f64, 2>::from_f64);
        solves(file, &motion, Lanes8::from_f64);
        solves(file, &motion, |p| {
            Jet::<Lanes<2>, 3>::variable(Lanes([p; 2]))
        });
    }
}
