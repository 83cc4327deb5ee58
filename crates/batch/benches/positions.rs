//! Time per position of the general plan, beside kernels written by hand for one mechanism with the same formula, in the
//! same run: `cargo bench -p kempe-batch` (with `-- closed-forms` not the Newton groups, with `-- newton` only these, with
//! `-- motions` only whole motions). The ratios count; the nanoseconds depend on the machine. A four-bar and an eight-bar:
//! one design over a sweep, pose by pose and in lanes, with and without rates; many designs in lanes.
//!
//! Every measurement runs over a table of inputs into a table of outputs (no result feeds the next input), is repeated
//! in turn with the one that it is compared with, and the fastest repeat counts. Before anything is timed, the plan and
//! the kernel are held against each other.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use kempe_batch::{Batch, Designs, Layout, sweep_states};
use kempe_mechanism::{Design, Mechanism};
use kempe_model::{Model, PointId};
use kempe_motion::Motion;
use kempe_motion::progress::Silent;
use kempe_motion::trace::Follower;
use kempe_number::{InstructionSet, Jet, Lanes, Lanes8, Number, multiversion};

/// Rows of a table: it and its results stay in the second-level cache.
const ROWS: usize = 4096;
/// Repeats, of which the fastest counts.
const REPEATS: usize = 60;
/// Designs, and the drive positions at which each is solved.
const DESIGNS: usize = 1024;
const PLACES: usize = 36;

type Rates = Jet<f64, 3>;
type LaneRates = Jet<Lanes8, 3>;

/// The meeting point of two circles seen from the first centre; `k` holds r1^2 - r2^2, (r1 + r2)^2, (r1 - r2)^2.
#[inline(always)]
fn meet<T: Number>(v: [T; 2], k: [T; 3], side: f64) -> [T; 2] {
    let square = v[0] * v[0] + v[1] * v[1];
    let along = square + k[0];
    let h = ((k[1] - square) * (square - k[2])).sqrt() * side;
    let scale = T::from_f64(0.5) / square;
    [
        (v[0] * along - v[1] * h) * scale,
        (v[1] * along + v[0] * h) * scale,
    ]
}

#[inline(always)]
fn circles<T: Number>(a: T, b: T) -> [T; 3] {
    [a * a - b * b, (a + b) * (a + b), (a - b) * (a - b)]
}

/// A four-bar from A to (d, 0) with the coupler point at p of the way from B to C.
#[derive(Clone, Copy)]
struct FourBar<T> {
    a: T,
    d: T,
    p: T,
    circles: [T; 3],
}

impl<T: Number> FourBar<T> {
    #[inline(always)]
    fn new([a, b, c, d]: [T; 4]) -> Self {
        Self {
            a,
            d,
            p: T::from_f64(0.5),
            circles: circles(b, c),
        }
    }

    #[inline(always)]
    fn coupler_point(&self, (s, c): (T, T)) -> [T; 2] {
        let b = [self.a * c, self.a * s];
        let reach = meet([self.d - b[0], -b[1]], self.circles, 1.0);
        [b[0] + self.p * reach[0], b[1] + self.p * reach[1]]
    }
}

#[inline(always)]
fn four_bar_lanes(k: &FourBar<f64>, angles: &[f64], out: &mut [f64]) {
    let k = FourBar {
        a: Lanes8::from_f64(k.a),
        d: Lanes8::from_f64(k.d),
        p: Lanes8::from_f64(k.p),
        circles: k.circles.map(Lanes8::from_f64),
    };
    let (xs, ys) = out.split_at_mut(angles.len());
    let columns = (xs.as_chunks_mut::<8>().0.iter_mut()).zip(ys.as_chunks_mut::<8>().0);
    for (angles, (xs, ys)) in angles.as_chunks::<8>().0.iter().zip(columns) {
        let [x, y] = k.coupler_point(Lanes(*angles).sin_cos());
        (*xs, *ys) = (x.0, y.0);
    }
}

#[inline(always)]
fn four_bar_rates(k: &FourBar<f64>, angles: &[f64], out: &mut [f64]) {
    let lift = LaneRates::from_f64;
    let k = FourBar {
        a: lift(k.a),
        d: lift(k.d),
        p: lift(k.p),
        circles: k.circles.map(lift),
    };
    for (block, angles) in angles.as_chunks::<8>().0.iter().enumerate() {
        let place = k.coupler_point(LaneRates::variable(Lanes(*angles)).sin_cos());
        write_rates(place, block, out);
    }
}

/// Columns of x and y, of their first and of their second derivatives.
#[inline(always)]
fn write_rates(place: [LaneRates; 2], block: usize, out: &mut [f64]) {
    for order in 0..3 {
        for axis in 0..2 {
            let column = (2 * order + axis) * ROWS + 8 * block;
            out[column..column + 8].copy_from_slice(&place[axis].derivative(order).0);
        }
    }
}

/// A kernel for many designs with `P` parameters each.
trait Kernel<const P: usize> {
    fn new(parameters: [Lanes8; P]) -> Self;
    fn place(&self, direction: (Lanes8, Lanes8)) -> [Lanes8; 2];
}

impl Kernel<4> for FourBar<Lanes8> {
    #[inline(always)]
    fn new(parameters: [Lanes8; 4]) -> Self {
        Self::new(parameters)
    }

    #[inline(always)]
    fn place(&self, direction: (Lanes8, Lanes8)) -> [Lanes8; 2] {
        self.coupler_point(direction)
    }
}

impl Kernel<11> for Jansen<Lanes8> {
    #[inline(always)]
    fn new(parameters: [Lanes8; 11]) -> Self {
        Self::new(parameters)
    }

    #[inline(always)]
    fn place(&self, direction: (Lanes8, Lanes8)) -> [Lanes8; 2] {
        self.foot(direction)
    }
}

#[inline(always)]
fn designs<K: Kernel<P>, const P: usize>(
    columns: &[f64],
    directions: &[(f64, f64)],
    out: &mut [f64],
) {
    let count = columns.len() / P;
    for first in (0..count).step_by(8) {
        let mut parameters = [Lanes8::zero(); P];
        for (k, parameter) in parameters.iter_mut().enumerate() {
            let column = &columns[k * count + first..];
            *parameter = column.first_chunk().map_or(Lanes8::zero(), |x| Lanes(*x));
        }
        let kernel = K::new(parameters);
        for (at, (s, c)) in directions.iter().enumerate() {
            let place = kernel.place((Lanes8::from_f64(*s), Lanes8::from_f64(*c)));
            for axis in 0..2 {
                let column = (2 * at + axis) * count + first;
                out[column..column + 8].copy_from_slice(&place[axis].0);
            }
        }
    }
}

/// Jansen's leg: crank, four circle meetings, two triangles.
#[derive(Clone, Copy)]
struct Jansen<T> {
    crank: T,
    z: [T; 2],
    bz_c: [T; 3],
    bz_e: [T; 3],
    de_g: [T; 3],
    /// D seen from Z in the direction of Z to C, over that length; F seen from E likewise.
    d: [T; 2],
    f: [T; 2],
}

/// The third corner of a triangle over its base, in base lengths.
#[inline(always)]
fn corner<T: Number>(base: T, from: T, to: T) -> [T; 2] {
    let x = (base * base + from * from - to * to) / (base * 2.0);
    [x / base, (from * from - x * x).sqrt() / base]
}

/// Crank, B-C, B-E, Z-E, D-G, Z-C, Z-D, C-D, E-G, E-F, G-F of Jansen's leg, in cm.
const JANSEN: [f64; 11] = [
    15.0, 50.0, 61.9, 39.3, 39.4, 41.5, 40.1, 55.8, 36.7, 49.0, 65.7,
];

impl<T: Number> Jansen<T> {
    #[inline(always)]
    fn new([crank, bc, be, ze, dg, zc, zd, cd, eg, ef, gf]: [T; 11]) -> Self {
        Self {
            crank,
            z: [T::from_f64(-0.380), T::from_f64(-0.078)],
            bz_c: circles(bc, zc),
            bz_e: circles(be, ze),
            de_g: circles(dg, eg),
            d: corner(zc, zd, cd),
            f: corner(eg, ef, gf),
        }
    }
}

impl Jansen<f64> {
    /// The same on a richer number.
    #[inline(always)]
    fn lift<T: Number>(&self) -> Jansen<T> {
        Jansen {
            crank: T::from_f64(self.crank),
            z: self.z.map(T::from_f64),
            bz_c: self.bz_c.map(T::from_f64),
            bz_e: self.bz_e.map(T::from_f64),
            de_g: self.de_g.map(T::from_f64),
            d: self.d.map(T::from_f64),
            f: self.f.map(T::from_f64),
        }
    }
}

impl<T: Number> Jansen<T> {
    #[inline(always)]
    fn foot(&self, (s, c): (T, T)) -> [T; 2] {
        let b = [self.crank * c, self.crank * s];
        let bz = [self.z[0] - b[0], self.z[1] - b[1]];
        let bc = meet(bz, self.bz_c, -1.0);
        let be = meet(bz, self.bz_e, 1.0);
        let zc = [bc[0] - bz[0], bc[1] - bz[1]];
        let d = [
            self.z[0] + self.d[0] * zc[0] - self.d[1] * zc[1],
            self.z[1] + self.d[1] * zc[0] + self.d[0] * zc[1],
        ];
        let e = [b[0] + be[0], b[1] + be[1]];
        let de = [e[0] - d[0], e[1] - d[1]];
        let dg = meet(de, self.de_g, -1.0);
        let eg = [dg[0] - de[0], dg[1] - de[1]];
        [
            e[0] + self.f[0] * eg[0] - self.f[1] * eg[1],
            e[1] + self.f[1] * eg[0] + self.f[0] * eg[1],
        ]
    }
}

#[inline(always)]
fn jansen_lanes(k: &Jansen<f64>, angles: &[f64], out: &mut [f64]) {
    let k = k.lift::<Lanes8>();
    let (xs, ys) = out.split_at_mut(angles.len());
    let columns = (xs.as_chunks_mut::<8>().0.iter_mut()).zip(ys.as_chunks_mut::<8>().0);
    for (angles, (xs, ys)) in angles.as_chunks::<8>().0.iter().zip(columns) {
        let [x, y] = k.foot(Lanes(*angles).sin_cos());
        (*xs, *ys) = (x.0, y.0);
    }
}

#[inline(always)]
fn jansen_rates(k: &Jansen<f64>, angles: &[f64], out: &mut [f64]) {
    let k = k.lift::<LaneRates>();
    for (block, angles) in angles.as_chunks::<8>().0.iter().enumerate() {
        write_rates(
            k.foot(LaneRates::variable(Lanes(*angles)).sin_cos()),
            block,
            out,
        );
    }
}

multiversion! {
    fn hand_four_bar(set: InstructionSet, k: &FourBar<f64>, angles: &[f64], out: &mut [f64]) = four_bar_lanes;
}
multiversion! {
    fn hand_four_bar_rates(set: InstructionSet, k: &FourBar<f64>, angles: &[f64], out: &mut [f64]) = four_bar_rates;
}
multiversion! {
    fn hand_jansen_rates(set: InstructionSet, k: &Jansen<f64>, angles: &[f64], out: &mut [f64]) = jansen_rates;
}
multiversion! {
    fn four_bar_designs(set: InstructionSet, columns: &[f64], directions: &[(f64, f64)], out: &mut [f64])
        = designs::<FourBar<Lanes8>, 4>;
}
multiversion! {
    fn jansen_designs(set: InstructionSet, columns: &[f64], directions: &[(f64, f64)], out: &mut [f64])
        = designs::<Jansen<Lanes8>, 11>;
}
multiversion! {
    fn hand_jansen(set: InstructionSet, k: &Jansen<f64>, angles: &[f64], out: &mut [f64]) = jansen_lanes;
}

/// A model of the examples with its plan.
struct Loaded {
    mechanism: Arc<Mechanism>,
    parameters: Vec<f64>,
}

/// The text of an example file.
fn example(name: &str) -> String {
    let path = format!("{}/../../examples/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).expect("an example file")
}

/// Jansen's leg with its lengths as parameters.
fn jansen_with_parameters() -> String {
    let names = [
        "O-B", "B-C", "B-E", "Z-E", "D-G", "Z-C", "Z-D", "C-D", "E-G", "E-F", "G-F",
    ];
    let mut text = example("gallery/jansen");
    let mut table = String::from("[parameters]\n");
    for (k, (name, length)) in names.iter().zip(JANSEN).enumerate() {
        text = text.replace(&format!("{name} = {length}"), &format!("{name} = \"p{k}\""));
        table += &format!("p{k} = \"{length} cm\"\n");
    }
    text.replacen("[links]", &format!("{table}\n[links]"), 1)
}

impl Loaded {
    fn new(name: &str) -> Self {
        Self::from_text(name, &example(name))
    }

    fn from_text(name: &str, text: &str) -> Self {
        let model = Model::from_toml(text, name, &mut |_| Err("no tables".into()))
            .expect("a valid example")
            .model;
        let mechanism = Mechanism::new(&model);
        Self {
            parameters: model.parameter_values(),
            mechanism,
        }
    }

    fn design<T: Number>(&self) -> Design<T> {
        let parameters: Vec<T> = self.mechanism.model.parameter_values();
        Design::new(&self.mechanism, &parameters)
    }

    fn motion(&self, design: &Design<f64>) -> Arc<Motion> {
        Motion::new(design).expect("a motion")
    }

    fn point(&self, name: &str) -> PointId {
        let points = &self.mechanism.model.points;
        PointId(points.iter().position(|p| p.name == name).expect("a point") as u32)
    }
}

/// Fastest time of each, in ns per item, repeated in turn.
fn compare(items: usize, mut jobs: Vec<Box<dyn FnMut() + '_>>) -> Vec<f64> {
    let mut best = vec![f64::INFINITY; jobs.len()];
    for _ in 0..REPEATS {
        for (job, best) in jobs.iter_mut().zip(&mut best) {
            let start = Instant::now();
            job();
            *best = best.min(start.elapsed().as_secs_f64() * 1e9 / items as f64);
        }
    }
    best
}

fn report(what: &str, general: f64, hand: f64) {
    println!(
        "{what:<58} {general:>9.2} {hand:>9.2} {:>8.2}",
        general / hand
    );
}

/// The largest difference of two tables: plan and kernel must compute the same.
fn same(a: &[f64], b: &[f64]) {
    let gap = a
        .iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, |m: f64, d| if d <= m { m } else { d });
    assert!(gap < 1e-12, "plan and kernel differ by {gap}");
}

fn sets() -> Vec<InstructionSet> {
    (InstructionSet::ALL.into_iter())
        .filter(|s| *s <= InstructionSet::detect())
        .collect()
}

/// Scalar, rates and lanes sweeps of one mechanism against its kernel on every number.
#[allow(
    clippy::too_many_arguments,
    clippy::type_complexity,
    reason = "one kernel on every number"
)]
fn single_design(
    title: &str,
    file: &str,
    point: &str,
    scalar: &dyn Fn(&[f64], &mut [f64]),
    rates: &dyn Fn(&[f64], &mut [[Rates; 2]]),
    lanes: &dyn Fn(InstructionSet, &[f64], &mut [f64]),
    lane_rates: &dyn Fn(InstructionSet, &[f64], &mut [f64]),
) {
    let loaded = Loaded::new(file);
    let design = loaded.design::<f64>();
    let motion = loaded.motion(&design);
    let point = loaded.point(point);
    let angles: Vec<f64> = (0..ROWS)
        .map(|i| 0.01 + 6.2 * i as f64 / ROWS as f64)
        .collect();
    let marker = loaded.mechanism.any_marker(point).expect("a marker");
    let (mut general, mut hand) = (vec![0.0; 2 * ROWS], vec![0.0; 2 * ROWS]);

    let best = compare(
        ROWS,
        vec![
            Box::new(|| {
                let out = black_box(&mut general);
                sweep_states(
                    &motion,
                    &design,
                    black_box(&angles),
                    |p| p,
                    |row, state| {
                        if let Some(state) = state {
                            let place = state.place(&design, marker);
                            (out[row], out[ROWS + row]) = (place[0], place[1]);
                        }
                    },
                );
            }),
            Box::new(|| scalar(black_box(&angles), black_box(&mut hand))),
        ],
    );
    same(&general, &hand);
    report(&format!("{title}, one at a time"), best[0], best[1]);

    let rich = loaded.design::<Rates>();
    let blank = [[Rates::constant(0.0); 2]; ROWS];
    let (mut general_rates, mut hand_rates) = (blank, blank);
    let best = compare(
        ROWS,
        vec![
            Box::new(|| {
                let out = black_box(&mut general_rates);
                sweep_states(
                    &motion,
                    &rich,
                    black_box(&angles),
                    Rates::variable,
                    |row, state| {
                        if let Some(state) = state {
                            out[row] = state.place(&rich, marker);
                        }
                    },
                );
            }),
            Box::new(|| rates(black_box(&angles), black_box(&mut hand_rates))),
        ],
    );
    let flat = |table: &[[Rates; 2]]| -> Vec<f64> {
        table
            .iter()
            .flatten()
            .flat_map(|j| *j.coefficients())
            .collect()
    };
    same(&flat(&general_rates), &flat(&hand_rates));
    report(
        &format!("{title}, v and a, one at a time"),
        best[0],
        best[1],
    );

    for set in sets() {
        let batch = Batch::new(&motion, &[point])
            .expect("a point")
            .with_instructions(set);
        let best = compare(
            ROWS,
            vec![
                Box::new(|| {
                    let closed = batch.sweep(black_box(&angles), black_box(&mut general));
                    assert_eq!(closed, Ok(ROWS));
                }),
                Box::new(|| lanes(set, black_box(&angles), black_box(&mut hand))),
            ],
        );
        same(&general, &hand);
        report(&format!("{title}, in lanes, {set:?}"), best[0], best[1]);
    }
    let (mut general, mut hand) = (vec![0.0; 6 * ROWS], vec![0.0; 6 * ROWS]);
    for set in sets() {
        let batch = Batch::new(&motion, &[point])
            .expect("a point")
            .with_instructions(set);
        let best = compare(
            ROWS,
            vec![
                Box::new(|| {
                    let closed = batch.sweep_rates(black_box(&angles), black_box(&mut general));
                    assert_eq!(closed, Ok(ROWS));
                }),
                Box::new(|| lane_rates(set, black_box(&angles), black_box(&mut hand))),
            ],
        );
        same(&general, &hand);
        report(
            &format!("{title}, v and a, in lanes, {set:?}"),
            best[0],
            best[1],
        );
    }
}

/// Columns of parameters within `spread` of the given ones, from a fixed sequence.
fn varied(parameters: &[f64], spread: f64, designs: usize) -> Vec<f64> {
    let mut seed = 1_u64;
    let mut columns = vec![0.0; parameters.len() * designs];
    for (i, value) in columns.iter_mut().enumerate() {
        seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        let unit = (seed >> 11) as f64 / (1_u64 << 53) as f64;
        *value = parameters[i / designs] * (1.0 + spread * (2.0 * unit - 1.0));
    }
    columns
}

/// A kernel for columns of parameters and the drive's directions.
type DesignsKernel = fn(InstructionSet, &[f64], &[(f64, f64)], &mut [f64]);

/// Many designs, their parameters within `spread` of the file's, against a kernel.
fn many_designs(title: &str, loaded: &Loaded, point: &str, spread: f64, kernel: DesignsKernel) {
    let design = loaded.design::<f64>();
    let motion = loaded.motion(&design);
    let at: Vec<f64> = (0..PLACES)
        .map(|i| 0.01 + 6.2 * i as f64 / PLACES as f64)
        .collect();
    let directions: Vec<(f64, f64)> = at.iter().map(|q| Number::sin_cos(*q)).collect();
    let columns = varied(&loaded.parameters, spread, DESIGNS);
    let designs = Designs {
        values: &columns,
        count: DESIGNS,
        layout: Layout::ByParameter,
    };
    let rows = DESIGNS * PLACES;
    let (mut general, mut hand) = (vec![0.0; 2 * rows], vec![0.0; 2 * rows]);
    for set in sets() {
        let batch = Batch::new(&motion, &[loaded.point(point)])
            .expect("a point")
            .with_instructions(set);
        let best = compare(
            rows,
            vec![
                Box::new(|| {
                    let closed = batch.designs(black_box(designs), &at, black_box(&mut general));
                    assert_eq!(closed, Ok(rows));
                }),
                Box::new(|| kernel(set, black_box(&columns), &directions, black_box(&mut hand))),
            ],
        );
        same(&general, &hand);
        let title = format!("{title}, {DESIGNS} designs at {PLACES} places, {set:?}");
        report(&title, best[0], best[1]);
    }
}

/// The door lock with its lengths as parameters, within which it can be varied.
fn lock_with_parameters() -> String {
    let lengths = [
        ("O-A", 230),
        ("A-B", 430),
        ("A-E", 700),
        ("B-E", 315),
        ("D-B", 210),
        ("D-G", 505),
        ("B-G", 330),
        ("F-G", 380),
        ("E-F", 300),
    ];
    let mut text = example("seeds/door-lock");
    let mut table = String::from("[parameters]\n");
    for (k, (name, length)) in lengths.iter().enumerate() {
        text = text.replace(&format!("{name} = {length}"), &format!("{name} = \"p{k}\""));
        table += &format!("p{k} = \"{length} mm\"\n");
    }
    text.replacen("[parameters]\n", &table, 1)
}

/// A Newton group in the coordinates of its spanning tree, beside the same in the poses of all its bodies.
fn newton() {
    println!(
        "{:<58} {:>9} {:>9} {:>8}",
        "ns per position", "tree", "bodies", "ratio"
    );
    let text = lock_with_parameters();
    let loaded = Loaded::from_text("door-lock", &text);
    let mut slow = Loaded::from_text("door-lock", &text);
    let mut mechanism = (*slow.mechanism).clone();
    for block in &mut mechanism.plan.newton_blocks {
        block.tree = None;
    }
    slow.mechanism = Arc::new(mechanism);
    let motion = loaded.motion(&loaded.design());
    let slow_motion = slow.motion(&slow.design());
    // Short of the change point, which other lengths would make a limit.
    let (low, high) = motion.reached();
    let places = |count: usize| -> Vec<f64> {
        (0..count)
            .map(|i| low + 0.8 * (high - low) * (i as f64 + 0.5) / count as f64)
            .collect()
    };
    let at = places(512);
    let rows = at.len();
    let point = [loaded.point("G")];
    let (mut tree, mut bodies) = (vec![0.0; 2 * rows], vec![0.0; 2 * rows]);
    let batches = [&motion, &slow_motion].map(|m| Batch::new(m, &point).expect("a point"));
    let best = compare(
        rows,
        vec![
            Box::new(|| {
                let closed = batches[0].sweep(black_box(&at), black_box(&mut tree));
                assert_eq!(closed, Ok(rows));
            }),
            Box::new(|| {
                let closed = batches[1].sweep(black_box(&at), black_box(&mut bodies));
                assert_eq!(closed, Ok(rows));
            }),
        ],
    );
    same(&tree, &bodies);
    report("door lock, one at a time", best[0], best[1]);
    let (rich, slow_rich) = (loaded.design::<Rates>(), slow.design::<Rates>());
    let sweep = |motion: &Motion, rich: &Design<Rates>| {
        sweep_states(motion, rich, black_box(&at), Rates::variable, |_, state| {
            black_box(state.map(|s| s.poses[1].x));
        });
    };
    let best = compare(
        rows,
        vec![
            Box::new(|| sweep(&motion, &rich)),
            Box::new(|| sweep(&slow_motion, &slow_rich)),
        ],
    );
    report("door lock, v and a, one at a time", best[0], best[1]);

    let columns = varied(&loaded.parameters, 0.002, 128);
    let designs = Designs {
        values: &columns,
        count: 128,
        layout: Layout::ByParameter,
    };
    let at = places(PLACES);
    let rows = designs.count * at.len();
    let (mut tree, mut bodies) = (vec![0.0; 2 * rows], vec![0.0; 2 * rows]);
    for set in sets() {
        let batches = batches.clone().map(|batch| batch.with_instructions(set));
        let best = compare(
            rows,
            vec![
                Box::new(|| {
                    let closed = batches[0].designs(black_box(designs), &at, black_box(&mut tree));
                    assert_eq!(closed, Ok(rows));
                }),
                Box::new(|| {
                    let closed =
                        batches[1].designs(black_box(designs), &at, black_box(&mut bodies));
                    assert_eq!(closed, Ok(rows));
                }),
            ],
        );
        same(&tree, &bodies);
        let title = format!("door lock, 128 designs at {PLACES} places, {set:?}");
        report(&title, best[0], best[1]);
    }
}

/// The trace of a motion by the bordered systems of all constraints alone, from its anchor both ways: how it was found before, without
/// its start and events.
fn bordered_trace(motion: &Motion) -> usize {
    let mut follower = Follower::new(&motion.design, &motion.path).without_plan();
    let (low, high) = motion.reached();
    let at = motion.node_parameters();
    let (p, poses, near) = motion.node(at.iter().position(|p| *p >= motion.anchor).unwrap_or(0));
    let mut nodes = 0;
    for direction in [1.0, -1.0] {
        let z = follower.scaled(&poses, &near, p);
        let mut node = follower.start(z, direction).expect("a start");
        let mut step = 0.02;
        while (low..high).contains(&follower.parameter(&node.z)) {
            let Some(next) = follower.advance(&node, &mut step) else {
                break;
            };
            node = next;
            nodes += 1;
        }
    }
    nodes
}

/// Whole motions beside their traces by the bordered systems alone, and motions of designs that differ by a thousandth in one
/// dimension, found from the one before.
fn motions() {
    println!(
        "{:<58} {:>9} {:>9} {:>8}",
        "us per motion", "whole", "bordered", "ratio"
    );
    for file in ["seeds/crank-rocker", "gallery/jansen", "seeds/door-lock"] {
        let loaded = Loaded::new(file);
        let design = loaded.design::<f64>();
        let motion = loaded.motion(&design);
        let mut other = design.clone();
        if let Some(marker) = other.geometry.markers.iter_mut().rfind(|m| m[0] != 0.0) {
            marker[0] *= 1.001;
        }
        let designs = [
            Design::from_geometry(
                &loaded.mechanism,
                &loaded.parameters,
                other.geometry.clone(),
                vec![other.geometry],
            ),
            design.clone(),
        ];
        let mut last = motion.clone();
        let mut turn = 0;
        let best = compare(
            1,
            vec![
                Box::new(|| {
                    black_box(loaded.motion(black_box(&design)));
                }),
                Box::new(|| {
                    black_box(bordered_trace(black_box(&motion)));
                }),
                Box::new(|| {
                    turn += 1;
                    let again = last.again(black_box(&designs[turn % 2]), &mut Silent);
                    last = again.expect("a motion");
                }),
            ],
        );
        report(file, best[0] / 1e3, best[1] / 1e3);
        report(&format!("{file} again"), best[2] / 1e3, best[1] / 1e3);
    }
}

fn main() {
    // `cargo test --benches` asks only whether it builds.
    if !std::env::args().any(|a| a == "--bench") {
        return;
    }
    println!("best instruction set: {:?}", InstructionSet::detect());
    if std::env::args().any(|a| a == "motions") {
        motions();
        return;
    }
    if std::env::args().any(|a| a == "newton") {
        newton();
        motions();
        return;
    }
    println!(
        "{:<58} {:>9} {:>9} {:>8}",
        "ns per position", "plan", "by hand", "ratio"
    );
    let k = FourBar::new([0.020, 0.050, 0.040, 0.060]);
    let rich = FourBar::new([0.020, 0.050, 0.040, 0.060].map(Rates::constant));
    single_design(
        "four-bar, coupler point",
        "seeds/crank-rocker",
        "P",
        &|angles, out| {
            let (xs, ys) = out.split_at_mut(angles.len());
            for (q, (x, y)) in angles.iter().zip(xs.iter_mut().zip(ys)) {
                [*x, *y] = k.coupler_point(Number::sin_cos(*q));
            }
        },
        &|angles, out| {
            for (q, out) in angles.iter().zip(out) {
                *out = rich.coupler_point(Rates::variable(*q).sin_cos());
            }
        },
        &|set, angles, out| hand_four_bar(set, &k, angles, out),
        &|set, angles, out| hand_four_bar_rates(set, &k, angles, out),
    );
    let k = Jansen::new(JANSEN.map(|cm| 0.01 * cm));
    let rich = k.lift::<Rates>();
    single_design(
        "eight-bar (Jansen), foot",
        "gallery/jansen",
        "F",
        &|angles, out| {
            let (xs, ys) = out.split_at_mut(angles.len());
            for (q, (x, y)) in angles.iter().zip(xs.iter_mut().zip(ys)) {
                [*x, *y] = k.foot(Number::sin_cos(*q));
            }
        },
        &|angles, out| {
            for (q, out) in angles.iter().zip(out) {
                *out = rich.foot(Rates::variable(*q).sin_cos());
            }
        },
        &|set, angles, out| hand_jansen(set, &k, angles, out),
        &|set, angles, out| hand_jansen_rates(set, &k, angles, out),
    );
    let loaded = Loaded::new("seeds/crank-rocker");
    many_designs("four-bar", &loaded, "P", 0.05, four_bar_designs);
    let loaded = Loaded::from_text("jansen", &jansen_with_parameters());
    many_designs("eight-bar", &loaded, "F", 0.004, jansen_designs);
    if !std::env::args().any(|a| a == "closed-forms") {
        newton();
        motions();
    }
}
