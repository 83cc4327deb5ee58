//! No position solve allocates, on any number.
#![allow(clippy::unwrap_used)]

#[path = "../../integrate/tests/support/counting.rs"]
mod counting;

use std::path::Path;

use counting::allocations;
use kempe_mechanism::{Design, Mechanism, PlanNumber};
use kempe_model::Model;
use kempe_motion::Motion;
use kempe_number::{Dual, Jet, Lanes, Lanes8, Number};

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

/// A platform on three motors, moved together along time: one group of three loops, found by Newton's method.
const PLATFORM: &str = r#"
units = { length = "mm", angle = "deg" }
[parameters]
pace = "5 deg/s"
[links]
frame    = { A = [0, 0], D = [100, 0], G = [50, 90] }
crank_1  = { A-B = 30 }
crank_2  = { D-E = 30 }
crank_3  = { G-H = 30 }
rod_1    = { B-P = 40 }
rod_2    = { E-Q = 40 }
rod_3    = { H-R = 40 }
platform = { P = [0, 0], Q = [30, 0], R = [15, 25] }
[drives]
one   = { turns = "crank_1", from = 80, to = 100, law = "cycloidal", in = "2 s" }
two   = { turns = "crank_2", from = 200, to = 190, speed = "pace" }
three = { turns = "crank_3", from = 300, to = 320, law = "3-4-5", in = "1 s" }
[assembly]
P = { near = [35, 35] }
"#;

fn moved(name: &str, text: &str, tables: &Path) -> std::sync::Arc<Motion> {
    let mut files =
        |table: &str| std::fs::read_to_string(tables.join(table)).map_err(|e| e.to_string());
    let model = Model::from_toml(text, name, &mut files).unwrap().model;
    let mechanism = Mechanism::new(&model);
    let values: Vec<f64> = model.parameter_values();
    Motion::new(&Design::new(&mechanism, &values)).unwrap()
}

fn solves_on_every_number(name: &str, motion: &Motion) {
    solves(name, motion, |p| p);
    solves(name, motion, Jet::<f64, 4>::variable);
    solves(name, motion, Dual::<f64, 2>::from_f64);
    solves(name, motion, Lanes8::from_f64);
    solves(name, motion, |p| {
        Jet::<Lanes<2>, 3>::variable(Lanes([p; 2]))
    });
}

#[test]
fn no_position_solve_allocates() {
    assert!(allocations(|| drop(std::hint::black_box(Box::new(1)))) > 0);
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    for file in [
        "seeds/crank-rocker",
        "seeds/tractor-hitch",
        "seeds/door-lock",
        "gallery/jansen",
        "gallery/geared-five-bar",
        "gallery/whitworth",
        "gallery/groove-cam",
        "gallery/overhead-door",
    ] {
        let text = std::fs::read_to_string(root.join(format!("{file}.toml"))).unwrap();
        solves_on_every_number(file, &moved(file, &text, &root));
    }
}

/// Then the path is time, and every drive's law is evaluated at every place.
#[test]
fn no_position_solve_on_several_drives_allocates() {
    let gallery = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/gallery");
    let five_bar = std::fs::read_to_string(gallery.join("five-bar.toml")).unwrap();
    for (name, text, drives) in [("five-bar", &*five_bar, 2), ("platform", PLATFORM, 3)] {
        let motion = moved(name, text, &gallery);
        let mechanism = motion.mechanism();
        assert_eq!(mechanism.model.drives.len(), drives);
        let by_newton = !mechanism.plan.newton_blocks.is_empty();
        assert_eq!(by_newton, name == "platform");
        solves_on_every_number(name, &motion);
    }
}
