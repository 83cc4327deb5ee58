//! Time per pose for the forces of the six-bar door lock, beside its position alone and beside a kernel written by hand
//! for this linkage: `cargo bench -p kempe-dynamics`. The ratios count; the nanoseconds depend on the machine.
//!
//! Every measurement is repeated in turn with the ones that it is compared with, and the fastest repeat counts. Before
//! anything is timed, the general forces are held against the kernel.

use std::hint::black_box;
use std::time::Instant as Clock;

use kempe_dynamics::{Forces, Instant};
use kempe_mechanism::{Branch, Configuration, Design, Mechanism};
use kempe_model::{DriveId, Model};
use kempe_motion::Motion;
use kempe_number::{Jet, Number};

const ROWS: usize = 512;
const REPEATS: usize = 40;
type Series = Jet<f64, 3>;

/// A link of the kernel: mass, inertia, centre in its own frame.
type Body = (f64, f64, [f64; 2]);
/// A pin of the kernel: earlier and later link (0 the frame), with its place on both.
type Pin = (usize, usize, [f64; 2], [f64; 2]);

/// The lock as its own program: seven pins, five links, fifteen equations, Gauss with partial pivoting.
struct Kernel {
    bodies: [Body; 5],
    pins: [Pin; 7],
    driven: usize,
}

impl Kernel {
    /// Torque and the seven pins' forces from poses (x, y, cosine, sine) and accelerations.
    fn forces(&self, poses: &[[f64; 4]; 6], accelerations: &[[f64; 4]; 6]) -> [f64; 15] {
        let mut a = [[0.0; 16]; 15];
        for (k, (mass, inertia, center)) in self.bodies.iter().enumerate() {
            let [_, _, c, s] = poses[k + 1];
            let r = [c * center[0] - s * center[1], s * center[0] + c * center[1]];
            let [ax, ay, alpha, w] = accelerations[k + 1];
            let ax = ax - alpha * r[1] - w * w * r[0];
            let ay = ay + alpha * r[0] - w * w * r[1] + 9.81;
            a[3 * k][15] = mass * ax;
            a[3 * k + 1][15] = mass * ay;
            a[3 * k + 2][15] = mass * (r[0] * ay - r[1] * ax) + inertia * alpha;
        }
        for (j, (first, second, on_first, on_second)) in self.pins.iter().enumerate() {
            for (body, place, sign) in [(*first, on_first, -1.0), (*second, on_second, 1.0)] {
                if body == 0 {
                    continue;
                }
                let [_, _, c, s] = poses[body];
                let r = [c * place[0] - s * place[1], s * place[0] + c * place[1]];
                let row = 3 * (body - 1);
                a[row][2 * j] = sign;
                a[row + 1][2 * j + 1] = sign;
                a[row + 2][2 * j] = -sign * r[1];
                a[row + 2][2 * j + 1] = sign * r[0];
            }
        }
        a[3 * (self.driven - 1) + 2][14] = 1.0;
        for k in 0..15 {
            let mut pivot = k;
            for i in k + 1..15 {
                if a[i][k].abs() > a[pivot][k].abs() {
                    pivot = i;
                }
            }
            a.swap(k, pivot);
            let head = a[k];
            for row in a.iter_mut().skip(k + 1) {
                let factor = row[k] / head[k];
                if factor != 0.0 {
                    for j in k + 1..16 {
                        row[j] -= factor * head[j];
                    }
                }
            }
        }
        let mut x = [0.0; 15];
        for k in (0..15).rev() {
            let sum: f64 = (k + 1..15).map(|j| a[k][j] * x[j]).sum();
            x[k] = (a[k][15] - sum) / a[k][k];
        }
        x
    }
}

fn best(mut work: impl FnMut()) -> f64 {
    let start = Clock::now();
    work();
    start.elapsed().as_secs_f64() / ROWS as f64 * 1e9
}

fn main() {
    let text = include_str!("../../../examples/seeds/door-lock.toml");
    let Ok(checked) = Model::from_toml(text, "door-lock", &mut |n| Err(n.to_owned())) else {
        println!("the example is broken");
        return;
    };
    let model = checked.model;
    let mechanism = Mechanism::new(&model);
    let parameters: Vec<f64> = model.parameter_values();
    let design = Design::new(&mechanism, &parameters);
    let Ok(motion) = Motion::new(&design) else {
        println!("the example does not move");
        return;
    };
    let rich: Design<Series> = Design::new(&mechanism, &model.parameter_values::<Series>());
    let Ok(mut forces) = Forces::new(design.clone()) else {
        println!("the example has no forces");
        return;
    };
    let from = (-50.0_f64).to_radians();
    let places: Vec<f64> = (0..ROWS)
        .map(|k| from + 2.6 * k as f64 / ROWS as f64)
        .collect();
    let branches: Vec<Branch> = (places.iter())
        .map(|p| {
            let mut branch = Branch::neutral(&mechanism);
            motion.branch_at(*p, &mut branch);
            branch
        })
        .collect();

    let kernel = kernel_of(&mechanism, &forces);
    let mut plain: Configuration<f64> = Configuration::new(&mechanism);
    let mut series: Configuration<Series> = Configuration::new(&mechanism);
    let mut states: Vec<Configuration<Series>> = Vec::with_capacity(ROWS);
    for (p, branch) in places.iter().zip(&branches) {
        series.set_inputs(&mechanism, &[Series::variable(*p)]);
        rich.solve(branch, &mut series);
        states.push(series.clone());
    }
    let rate = |p: f64| [(4.0 * (p - from)).max(0.0).sqrt(), 2.0];
    let mut instant = Instant::new(&mechanism, 0);
    let mut worst = 0.0_f64;
    for ((p, branch), state) in places.iter().zip(&branches).zip(&states) {
        instant.set_along(state, &branch.near, DriveId(0), rate(*p));
        forces.solve(&instant);
        let by_hand = kernel.forces(&inputs(&instant).0, &inputs(&instant).1)[14];
        worst = worst.max((by_hand - forces.drives[0].value).abs() / by_hand.abs().max(1.0));
    }
    println!("largest difference of the drive's torque from the kernel's: {worst:.1e}");

    let mut times = [f64::INFINITY; 5];
    for _ in 0..REPEATS {
        let position = best(|| {
            for (p, branch) in places.iter().zip(&branches) {
                plain.set_inputs(&mechanism, &[*p]);
                design.solve(branch, &mut plain);
                black_box(&plain);
            }
        });
        let rates = best(|| {
            for (p, branch) in places.iter().zip(&branches) {
                series.set_inputs(&mechanism, &[Series::variable(*p)]);
                rich.solve(branch, &mut series);
                black_box(&series);
            }
        });
        let alone = best(|| {
            for ((p, branch), state) in places.iter().zip(&branches).zip(&states) {
                instant.set_along(state, &branch.near, DriveId(0), rate(*p));
                forces.solve(&instant);
                black_box(&forces.drives);
            }
        });
        let whole = best(|| {
            for (p, branch) in places.iter().zip(&branches) {
                series.set_inputs(&mechanism, &[Series::variable(*p)]);
                rich.solve(branch, &mut series);
                instant.set_along(&series, &branch.near, DriveId(0), rate(*p));
                forces.solve(&instant);
                black_box(&forces.drives);
            }
        });
        let by_hand = best(|| {
            for ((p, branch), state) in places.iter().zip(&branches).zip(&states) {
                instant.set_along(state, &branch.near, DriveId(0), rate(*p));
                let (poses, accelerations) = inputs(&instant);
                black_box(kernel.forces(&poses, &accelerations));
            }
        });
        for (time, new) in times
            .iter_mut()
            .zip([position, rates, alone, whole, by_hand])
        {
            *time = time.min(new);
        }
    }
    let [position, rates, alone, whole, by_hand] = times;
    println!("position                         {position:8.0} ns");
    println!("position, speed, acceleration    {rates:8.0} ns");
    println!("forces, both routes              {alone:8.0} ns");
    println!("all of it                        {whole:8.0} ns");
    println!("forces by hand, one route        {by_hand:8.0} ns");
    println!("all of it over position          {:8.2}", whole / position);
    println!("forces over forces by hand       {:8.2}", alone / by_hand);
}

/// Poses and accelerations as the kernel wants them.
fn inputs(at: &Instant<f64>) -> ([[f64; 4]; 6], [[f64; 4]; 6]) {
    let (mut poses, mut accelerations) = ([[0.0; 4]; 6], [[0.0; 4]; 6]);
    for k in 0..6 {
        let (pose, a) = (&at.poses[k], at.accelerations[k]);
        poses[k] = [pose.x, pose.y, pose.c.value(), pose.s];
        accelerations[k] = [a[0], a[1], a[2], at.velocities[k][2]];
    }
    (poses, accelerations)
}

fn kernel_of(mechanism: &Mechanism, forces: &Forces<f64>) -> Kernel {
    use kempe_mechanism::constraint::{Coincide, Constraint};
    let mut bodies = [(0.0, 0.0, [0.0; 2]); 5];
    for mass in &forces.acting.masses {
        bodies[mass.body.index() - 1] = (mass.mass, mass.moment, mass.center);
    }
    let mut pins = [(0, 0, [0.0; 2], [0.0; 2]); 7];
    let mut at = 0;
    for (constraint, _) in &mechanism.constraints {
        if let Constraint::Coincide(Coincide { a, b }) = constraint {
            let local = |m| forces.design.geometry.marker(m);
            pins[at] = (a.body.index(), b.body.index(), local(*a), local(*b));
            at += 1;
        }
    }
    Kernel {
        bodies,
        pins,
        driven: 5,
    }
}
