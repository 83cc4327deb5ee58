//! Fits of paths and motions: linkages sampled by closed forms and found again, in any size and with any timing; what limits do to them; what is told.
#![allow(clippy::unwrap_used)]

use std::f64::consts::TAU;
use std::fmt::Write as _;

use crate::read::read;
use crate::told::scalar;
use kempe_model::Model;
use kempe_number::Random;
use kempe_number::math::{acos, atan2, cos, hypot, sin};
use kempe_study::{Silent, StudyResult, run};

/// The parameters of a four-bar: pivot, tilt, ground, crank, coupler, rocker, the point along and beside the coupler.
const NAMES: [&str; 9] = [
    "x", "y", "tilt", "ground", "crank", "coupler", "rocker", "u", "v",
];

/// A four-bar, its loop's far pin on the left of the line from crank pin to rocker pivot.
#[derive(Clone, Copy, Debug)]
struct Bar([f64; 9]);

impl Bar {
    /// A crank-rocker or double crank, about 50 in size.
    fn random(random: &mut Random) -> Self {
        loop {
            let mut number = |low: f64, high: f64| low + (high - low) * random.uniform();
            let bar = Self([
                number(-20.0, 20.0),
                number(-20.0, 20.0),
                number(-3.0, 3.0),
                number(30.0, 60.0),
                number(8.0, 20.0),
                number(30.0, 60.0),
                number(30.0, 60.0),
                number(5.0, 50.0),
                number(-30.0, 30.0),
            ]);
            let [_, _, _, ground, crank, coupler, rocker, ..] = bar.0;
            let longest = ground.max(coupler).max(rocker);
            // Clearly one whose crank goes round.
            if crank + longest < ground + coupler + rocker - longest - 4.0 {
                return bar;
            }
        }
    }

    /// The point and the coupler's angle at an angle of the crank.
    fn pose(&self, angle: f64) -> [f64; 3] {
        let [x, y, tilt, ground, crank, coupler, rocker, u, v] = self.0;
        let b = [x + crank * cos(angle), y + crank * sin(angle)];
        let d = [x + ground * cos(tilt), y + ground * sin(tilt)];
        let (dx, dy) = (d[0] - b[0], d[1] - b[1]);
        let far = hypot(dx, dy);
        let cosine = (coupler * coupler + far * far - rocker * rocker) / (2.0 * coupler * far);
        let turn = atan2(dy, dx) + acos(cosine);
        [
            b[0] + u * cos(turn) - v * sin(turn),
            b[1] + u * sin(turn) + v * cos(turn),
            turn,
        ]
    }

    /// The path at even angles of the crank.
    fn path(&self, count: usize) -> Vec<[f64; 2]> {
        let all = (0..count).map(|k| TAU * k as f64 / count as f64);
        all.map(|angle| {
            let [x, y, _] = self.pose(angle);
            [x, y]
        })
        .collect()
    }

    /// The model, lengths as many times as large, with what is fitted.
    fn model(&self, scale: f64, turn: [f64; 2], study: &str) -> Model {
        let mut text = String::from("units = { length = 'mm', angle = 'rad' }\n[parameters]\n");
        for (k, name) in NAMES.iter().enumerate() {
            let (size, unit) = match k {
                2 => (1.0, "rad"),
                _ => (scale, "mm"),
            };
            writeln!(text, "{name} = '{} {unit}'", size * self.0[k]).unwrap();
        }
        let [from, to] = turn;
        write!(
            text,
            "[links]\nframe = {{ A = ['x', 'y'], D = ['x + ground * cos(tilt)', 'y + ground * sin(tilt)'] }}\n\
             arm = {{ A-B = 'crank' }}\nrod = {{ B-C = 'coupler', P = ['u', 'v'] }}\nswing = {{ D-C = 'rocker' }}\n\
             [drives]\nmotor = {{ turns = 'arm', from = {from}, to = {to}, speed = 1 }}\n\
             [assembly]\nC = 'left of B -> D'\n[studies.turning]\nkind = 'motion'\n\
             [studies.fitted]\nkind = 'optimize'\nover = 'turning'\n{study}\n"
        )
        .unwrap();
        read(&text)
    }
}

/// Bounds about as wide as anything of the size is, for all parameters.
fn wide(scale: f64) -> String {
    let length = |low: f64, high: f64| format!("[{}, {}]", low * scale, high * scale);
    format!(
        "vary = {{ x = {o}, y = {o}, tilt = [-3.2, 3.2], ground = {r}, crank = {r}, coupler = {r}, rocker = {r}, u = {o}, v = {o} }}",
        o = length(-80.0, 80.0),
        r = length(4.0, 90.0)
    )
}

fn list(places: &[Vec<f64>]) -> String {
    let all = places.iter().map(|p| {
        let numbers: Vec<String> = p.iter().map(|x| format!("{x:?}")).collect();
        format!("[{}]", numbers.join(", "))
    });
    format!("[{}]", all.collect::<Vec<_>>().join(", "))
}

fn best(model: &Model) -> StudyResult {
    let study = model.studies.last().unwrap();
    run(model, study, &mut Silent).unwrap_or_else(|e| panic!("{e:#?}"))
}

/// The four-bar that was found.
fn found(result: &StudyResult, scale: f64) -> Bar {
    let mut all = NAMES.map(|name| scalar(result, name));
    for (k, x) in all.iter_mut().enumerate() {
        *x /= if k == 2 { 1.0 } else { scale };
    }
    Bar(all)
}

/// The largest distance of places of a path from another one.
fn apart(from: &[[f64; 2]], to: &[[f64; 2]]) -> f64 {
    let nearest = |p: &[f64; 2]| {
        let near = to.iter().map(|q| hypot(p[0] - q[0], p[1] - q[1]));
        near.fold(f64::INFINITY, f64::min)
    };
    from.iter().map(nearest).fold(0.0, f64::max)
}

/// A design of which nothing is like what is looked for.
const PLAIN: Bar = Bar([0.0, 0.0, 0.0, 40.0, 15.0, 40.0, 35.0, 20.0, 20.0]);

/// Fourteen points are more than any other four-bar's path shares: not only these are met, the whole path is the same. The cognates have it, too, so that
/// the dimensions need not come back.
#[test]
fn random_four_bars_are_found_again_from_far_away() {
    let mut random = Random(11);
    for _ in 0..3 {
        let bar = Bar::random(&mut random);
        let start = TAU * random.uniform();
        let places: Vec<Vec<f64>> = (0..14)
            .map(|k| {
                let some = 0.2 * random.uniform();
                let [x, y, _] = bar.pose(start - TAU * (f64::from(k) + some) / 14.0);
                vec![x, y]
            })
            .collect();
        let fit = format!(
            "{}\nfit = {{ point = 'P', to = {}, closed = true }}",
            wide(1.0),
            list(&places)
        );
        let result = best(&PLAIN.model(1.0, [0.0, TAU], &fit));
        assert!(scalar(&result, "largest miss") < 1e-7, "{bar:?}");
        let other = found(&result, 1.0);
        let [fine, some] = [other.path(20_000), bar.path(97)];
        assert!(apart(&some, &fine) < 0.05, "{bar:?} {other:?}");
    }
}

/// Sizes are powers of two, so that what is given is the same to the bit: in watches as in cranes the same designs are found.
#[test]
fn sizes_do_not_matter() {
    let bar = Bar::random(&mut Random(12));
    let at = |scale: f64| {
        let places: Vec<Vec<f64>> = (0..7)
            .map(|k| {
                let [x, y, _] = bar.pose(f64::from(k) * 0.8);
                // No four-bar's.
                let off = if k == 3 { 4.0 } else { 0.0 };
                vec![scale * (x + off), scale * y]
            })
            .collect();
        let vary = wide(scale).replace(", tilt = [-3.2, 3.2]", "");
        let vary = vary.replace(
            &format!(", ground = [{}, {}]", 4.0 * scale, 90.0 * scale),
            "",
        );
        let fit = format!(
            "{vary}\ndesigns = 600\nfit = {{ point = 'P', to = {}, timing = 'even' }}",
            list(&places)
        );
        let result = best(&PLAIN.model(scale, [0.0, 4.8], &fit));
        assert!(scalar(&result, "first-order residual") < 1e-6);
        scalar(&result, "sum of squares") / (scale * scale)
    };
    let one = at(1.0);
    assert!(one > 1e-3);
    for scale in [1.0 / 1024.0, 1024.0] {
        assert!(
            (at(scale) - one).abs() < 1e-7 * one,
            "{scale}: {} {one}",
            at(scale)
        );
    }
}

/// Where the crank has given angles the linkage itself comes back: cognates have cranks that stand otherwise.
#[test]
fn timed_places_give_the_very_linkage() {
    let mut random = Random(13);
    for timed in ["{ motor = ANGLES }", "{ time = ANGLES }"] {
        let bar = Bar::random(&mut random);
        let angles: Vec<f64> = (0..10).map(|k| 0.3 + 0.55 * f64::from(k)).collect();
        let places: Vec<Vec<f64>> = (angles.iter())
            .map(|angle| bar.pose(*angle)[..2].to_vec())
            .collect();
        let timing = timed.replace("ANGLES", &format!("{angles:?}"));
        let fit = format!(
            "{}\nfit = {{ point = 'P', to = {}, timing = {timing} }}",
            wide(1.0),
            list(&places)
        );
        let result = best(&PLAIN.model(1.0, [0.0, TAU], &fit));
        let other = found(&result, 1.0);
        for (k, name) in NAMES.iter().enumerate() {
            let off = (other.0[k] - bar.0[k]) / if k == 2 { TAU } else { 1.0 };
            let off = if k == 2 { off - off.round() } else { off };
            assert!(off.abs() < 1e-6, "{name}: {other:?} {bar:?}");
        }
    }
}

/// The coupler's poses, wherever along the motion.
#[test]
fn a_motion_gives_the_very_linkage() {
    let mut random = Random(14);
    for closed in [false, true] {
        let bar = Bar::random(&mut random);
        let angles = (0..9).map(|k| 0.4 + 0.6 * f64::from(k));
        let places: Vec<Vec<f64>> = angles.map(|angle| bar.pose(angle).to_vec()).collect();
        let fit = format!(
            "{}\nfit = {{ link = 'rod', at = 'P', radius = 40, to = {}, closed = {closed} }}",
            wide(1.0),
            list(&places)
        );
        let result = best(&PLAIN.model(1.0, [0.0, TAU], &fit));
        let other = found(&result, 1.0);
        assert!(scalar(&result, "largest miss") < 1e-7, "{bar:?} {other:?}");
        // Where its pins are on the coupler says the pose; angles of bars may differ by what is fixed to them.
        for angle in [0.1, 1.0, 2.0, 3.0, 4.0, 5.0] {
            let wanted = bar.pose(angle);
            let near = (0..20_000).map(|k| {
                let [x, y, turn] = other.pose(TAU * f64::from(k) / 20_000.0);
                let turned = (turn - wanted[2]) / TAU;
                hypot(
                    hypot(x - wanted[0], y - wanted[1]),
                    40.0 * TAU * (turned - turned.round()),
                )
            });
            assert!(
                near.fold(f64::INFINITY, f64::min) < 0.05,
                "{bar:?} {other:?}"
            );
        }
    }
}

/// Places at even parts of the path's length, open and closed.
#[test]
fn places_by_the_paths_length() {
    let mut random = Random(15);
    for closed in [false, true] {
        let bar = Bar::random(&mut random);
        let end = if closed { TAU } else { 4.0 };
        let count = 4000;
        let angle = |k: f64| end * k / f64::from(count);
        let mut sums = vec![0.0];
        for k in 1..=count {
            // A chord of a smooth curve, mended by that of its halves: L. F. Richardson.
            let [a, b, c] = [-1.0, -0.5, 0.0].map(|j| bar.pose(angle(f64::from(k) + j)));
            let chord = |p: [f64; 3], q: [f64; 3]| hypot(q[0] - p[0], q[1] - p[1]);
            let halves = chord(a, b) + chord(b, c);
            sums.push(sums[k as usize - 1] + halves + (halves - chord(a, c)) / 3.0);
        }
        let whole = sums.last().copied().unwrap();
        let at = |part: f64| -> Vec<f64> {
            let k = sums
                .partition_point(|s| *s < part * whole)
                .clamp(1, sums.len() - 1);
            let along = (part * whole - sums[k - 1]) / (sums[k] - sums[k - 1]);
            bar.pose(angle(k as f64 - 1.0 + along))[..2].to_vec()
        };
        // So many that the line through them is divided as the path is, but for a part in a thousand.
        let n = 60;
        let last = f64::from(if closed { n } else { n - 1 });
        let places: Vec<Vec<f64>> = (0..n).map(|k| at(f64::from(k) / last)).collect();
        let fit = format!(
            "{}\nmethod = 'local'\nfit = {{ point = 'P', to = {}, timing = 'arc-length', closed = {closed} }}",
            wide(1.0),
            list(&places)
        );
        let mut off = bar;
        off.0[3..].iter_mut().for_each(|x| *x *= 1.06);
        let result = best(&off.model(1.0, [0.0, end], &fit));
        let other = found(&result, 1.0);
        let missed = scalar(&result, "largest miss");
        assert!(missed < 0.1, "{missed} {closed}: {bar:?} {other:?}");
        let path = |bar: Bar| -> Vec<[f64; 2]> {
            let all = (0..20_000).map(|k| bar.pose(end * f64::from(k) / 20_000.0));
            all.map(|[x, y, _]| [x, y]).collect()
        };
        assert!(
            apart(&path(bar)[..19_900], &path(other)) < 0.05,
            "{bar:?} {other:?}"
        );
    }
}

/// Klann's bars: the path of a foot two dyads away, found again from lengths that are off, and from far away where few are not known.
#[test]
fn a_six_bars_foot_is_found_again() {
    let own = [26.8, 51.76, 32.06, 59.0, 109.9, -11.6, 89.66, 89.66];
    let names = [
        "crank", "upper", "lower", "rod", "kx", "ky", "thigh", "shank",
    ];
    let model = |values: &[f64], study: &str| {
        let mut text = String::from("units = { length = 'mm', angle = 'deg' }\n[parameters]\n");
        for (name, value) in names.iter().zip(values) {
            writeln!(text, "{name} = '{value} mm'").unwrap();
        }
        read(&format!(
            "{text}[links]\nframe = {{ O = [0, 0], P = [-23.3, 61.6], Q = [-59, -17.6] }}\nturn = {{ O-B = 'crank' }}\n\
             high = {{ P-H = 'upper' }}\nlow = {{ Q-E = 'lower' }}\nbar = {{ B-E = 'rod', K = ['kx', 'ky'] }}\n\
             leg = {{ K-H = 'thigh', F = ['shank', '210 deg'] }}\n[drives]\nmotor = {{ turns = 'turn', from = 180, to = 540, speed = 360 }}\n\
             [assembly]\nE = 'right of B -> Q'\nH = 'left of K -> P'\n\
             [studies.step]\nkind = 'motion'\nrows = 25\ncolumns = ['x(F)', 'y(F)']\n{study}"
        ))
    };
    let moved = best(&model(&own, ""));
    let column = |name: &str| moved.table.column(name).unwrap().values.clone();
    let places: Vec<Vec<f64>> = (column("x(F)").iter().zip(column("y(F)")))
        .map(|(x, y)| vec![*x, y])
        .take(24)
        .collect();
    let fitted = |vary: &str, rest: &str| {
        format!(
            "[studies.fitted]\nkind = 'optimize'\nover = 'step'\nvary = {{ {vary} }}\n{rest}\nfit = {{ point = 'F', to = {}, closed = true }}",
            list(&places)
        )
    };
    // All lengths a little off.
    let off: Vec<f64> = (own.iter().enumerate())
        .map(|(k, x)| x * if k % 2 == 0 { 1.02 } else { 0.98 })
        .collect();
    let vary: Vec<String> = (names.iter().zip(own))
        .map(|(name, x)| {
            format!(
                "{name} = [{:?}, {:?}]",
                (0.8 * x).min(1.2 * x),
                (0.8 * x).max(1.2 * x)
            )
        })
        .collect();
    let result = best(&model(&off, &fitted(&vary.join(", "), "method = 'local'")));
    for (name, own) in names.iter().zip(own) {
        assert!(
            (scalar(&result, name) - own).abs() < 1e-5,
            "{name}: {}",
            scalar(&result, name)
        );
    }
    // Four of them not known.
    let mut far = own;
    far[4..].copy_from_slice(&[130.0, 5.0, 70.0, 110.0]);
    let result = best(&model(
        &far,
        &fitted(
            "kx = [80, 140], ky = [-30, 20], thigh = [60, 120], shank = [60, 120]",
            "",
        ),
    ));
    assert!(scalar(&result, "largest miss") < 1e-6);
    for (name, own) in names.iter().zip(own) {
        if far[names.iter().position(|n| n == name).unwrap()] != own {
            assert!((scalar(&result, name) - own).abs() < 1e-5, "{name}");
        }
    }
}

/// A limit and a bound that hold a fit back, against a dense search in closed form.
#[test]
fn limits_and_bounds_are_kept() {
    let bar = Bar([0.0, 0.0, 0.0, 60.0, 26.0, 50.0, 40.0, 25.0, 10.0]);
    let angles: Vec<f64> = (0..8).map(|k| 0.7 * f64::from(k)).collect();
    let places: Vec<Vec<f64>> = angles.iter().map(|a| bar.pose(*a)[..2].to_vec()).collect();
    let study = format!(
        "vary = {{ crank = [10, 30], u = [20, 24] }}\nsubject_to = 'max(x(P)) <= 36 mm'\n\
         fit = {{ point = 'P', to = {}, timing = {{ motor = {angles:?} }} }}",
        list(&places)
    );
    let start = Bar([0.0, 0.0, 0.0, 60.0, 15.0, 50.0, 40.0, 21.0, 10.0]);
    let result = best(&start.model(1.0, [0.0, TAU], &study));
    let (crank, u) = (scalar(&result, "crank"), scalar(&result, "u"));
    let with = |crank: f64, u: f64| {
        let mut other = bar;
        other.0[4] = crank;
        other.0[7] = u;
        other
    };
    let squares = |bar: Bar| -> f64 {
        let misses = angles.iter().zip(&places).map(|(angle, place)| {
            let [x, y, _] = bar.pose(*angle);
            (x - place[0]) * (x - place[0]) + (y - place[1]) * (y - place[1])
        });
        misses.sum()
    };
    let right = |bar: Bar| {
        bar.path(720)
            .iter()
            .map(|p| p[0])
            .fold(f64::NEG_INFINITY, f64::max)
    };
    let own = squares(with(crank, u));
    assert!((scalar(&result, "sum of squares") - own).abs() < 1e-8 * own);
    assert!(right(with(crank, u)) < 36.0 + 1e-6 && (20.0..=24.0).contains(&u));
    let mut dense = f64::INFINITY;
    for i in 0..=200 {
        for j in 0..=80 {
            let bar = with(10.0 + 0.1 * f64::from(i), 20.0 + 0.05 * f64::from(j));
            if squares(bar) < dense && right(bar) <= 36.0 {
                dense = squares(bar);
            }
        }
    }
    assert!(own <= dense + 1e-9 && own > 0.9 * dense, "{own} {dense}");
    // The limit holds it: without it the fit is better.
    let free = study.replace("subject_to = 'max(x(P)) <= 36 mm'\n", "");
    let free = scalar(
        &best(&start.model(1.0, [0.0, TAU], &free)),
        "sum of squares",
    );
    assert!(free < 0.9 * own, "{free} {own}");
}

/// What is told: each place with where it is met and by how much it is missed; a picture; a file that runs.
#[test]
fn what_is_told_of_a_fit() {
    let places = [[30.0, 20.0], [24.0, 30.0], [10.0, 30.0], [2.0, 20.0]].map(|p| p.to_vec());
    let fit = format!(
        "vary = {{ u = [5, 40], v = [5, 40] }}\nfit = {{ point = 'P', to = {}, closed = true }}",
        list(&places)
    );
    let result = best(&PLAIN.model(1.0, [0.0, TAU], &fit));
    let squares = scalar(&result, "sum of squares");
    assert!((scalar(&result, "rms miss") - (squares / 4.0).sqrt()).abs() < 1e-12 * squares.sqrt());
    let table = &result.beside[0];
    assert_eq!(table.name, "places");
    let column = |name: &str| {
        &table
            .column(name)
            .unwrap_or_else(|| panic!("no {name}"))
            .values
    };
    assert_eq!(table.rows(), 4);
    let other = found(&result_with_all(&result), 1.0);
    let mut sum = 0.0;
    for k in 0..4 {
        let [x, y, _] = other.pose(column("motor")[k]);
        assert!((x - column("x")[k]).abs() < 1e-9 && (y - column("y")[k]).abs() < 1e-9);
        assert_eq!(
            [column("x given")[k], column("y given")[k]],
            [places[k][0], places[k][1]]
        );
        let miss = hypot(x - places[k][0], y - places[k][1]);
        assert!((miss - column("miss")[k]).abs() < 1e-9);
        // Nothing of the path is nearer, but for the order.
        sum += miss * miss;
    }
    assert!((sum - squares).abs() < 1e-9 * squares);
    let names: Vec<String> = result.figures.iter().map(|f| format!("{f:?}")).collect();
    assert!(
        names
            .iter()
            .any(|f| f.contains("fit-P") && f.contains("given") && f.contains("misses"))
    );
    let again = read(&result.designs[0].file.toml);
    run(&again, &again.studies[0], &mut Silent).unwrap();
}

/// The result with the parameters beside that do not vary.
fn result_with_all(result: &StudyResult) -> StudyResult {
    let mut all = result.clone();
    for (name, value) in NAMES.iter().zip(PLAIN.0) {
        if !all.scalars.iter().any(|s| s.name == *name) {
            let mut scalar = all.scalars[0].clone();
            scalar.name = (*name).to_owned();
            scalar.value = value;
            all.scalars.push(scalar);
        }
    }
    all
}

/// A four-bar whose crank goes round only where coupler and rocker are 80 long together fits best with both as short as that. Along this edge the best is sought by
/// golden sections over its path in closed form.
#[test]
fn a_fit_ends_at_the_edge_of_what_moves() {
    let places = [
        [17.5, 24.9],
        [22.3, 34.5],
        [21.5, 39.6],
        [16.3, 39.4],
        [10.1, 33.5],
        [6.6, 22.4],
        [8.8, 7.6],
        [2.7, 8.1],
        [0.2, 6.3],
        [1.4, 5.3],
        [5.2, 7.3],
        [10.8, 14.2],
    ];
    let squares = |coupler: f64, both: f64| -> f64 {
        let path = Bar([
            0.0,
            0.0,
            0.0,
            60.0,
            20.0,
            coupler,
            both - coupler,
            20.0,
            15.0,
        ])
        .path(8000);
        let to = |p: &[f64; 2]| {
            let ends = path.iter().zip(path.iter().cycle().skip(1));
            let far = ends.map(|(a, b)| {
                let (along, from) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
                let length = along[0] * along[0] + along[1] * along[1];
                let part = ((along[0] * from[0] + along[1] * from[1]) / length).clamp(0.0, 1.0);
                hypot(from[0] - part * along[0], from[1] - part * along[1])
            });
            far.fold(f64::INFINITY, f64::min)
        };
        places.iter().map(|p| to(p) * to(p)).sum()
    };
    // A hair inside, where the closed form has no root of less than nothing.
    let on_edge = |coupler: f64| squares(coupler, 80.0 + 1e-9);
    let (mut low, mut high) = (38.0, 46.0);
    while high - low > 1e-4 {
        let part = 0.381_966 * (high - low);
        match on_edge(low + part) < on_edge(high - part) {
            true => high -= part,
            false => low += part,
        }
    }
    let least = on_edge(low);
    assert!(squares(low, 80.1) > least + 1e-3);
    let to = list(&places.map(|p| p.to_vec()));
    for method in ["local", "multi-start"] {
        let bar = Bar([0.0, 0.0, 0.0, 60.0, 20.0, 50.0, 40.0, 20.0, 15.0]);
        let result = best(&bar.model(
            1.0,
            [0.0, TAU],
            &format!("vary = {{ coupler = [30, 60], rocker = [30, 50] }}\nmethod = '{method}'\nfit = {{ point = 'P', to = {to}, timing = 'nearest' }}"),
        ));
        let found = scalar(&result, "sum of squares");
        assert!(
            (found - least).abs() < 1e-5 * least,
            "{method}: {found} {least}"
        );
        let both = scalar(&result, "coupler") + scalar(&result, "rocker");
        assert!((both - 80.0).abs() < 1e-6, "{method}: {both}");
        assert!((scalar(&result, "coupler") - low).abs() < 0.01);
        let told: Vec<_> = result.diagnostics.iter().map(|d| d.code).collect();
        assert!(!told.contains(&"not-converged"), "{told:?}");
        let how = result
            .listings
            .iter()
            .find(|it| it.title == "how it was found");
        let how = how.unwrap().rows.concat().join("\n");
        assert!(
            how.contains("at the edge of the designs that can be asked"),
            "{how}"
        );
        assert!(
            how.contains("just beyond the best: drive `motor` cannot cover its range"),
            "{how}"
        );
    }
}

/// A geared five-bar comes round after two turns of its drive, where its second crank goes half as fast as its first: one turn is no closed way.
#[test]
fn a_way_is_closed_where_the_point_comes_back() {
    let fitted = |to: u32| {
        let model = read(&format!(
            "units = {{ length = 'mm', angle = 'deg' }}\n[parameters]\nrod = '60 mm'\n\
             [links]\nframe = {{ A = [0, 0], D = [60, 0] }}\none = {{ A-B = 20 }}\ntwo = {{ D-E = 20 }}\nleft = {{ B-C = 'rod' }}\nright = {{ C-E = 60 }}\n\
             [joints]\nmesh = {{ gears = ['one', 'two'], teeth = [20, 40] }}\n\
             [drives]\nmotor = {{ turns = 'one', from = 0, to = {to}, speed = '60 rpm' }}\n[assembly]\nC = 'left of B -> E'\n\
             [studies.turn]\nkind = 'motion'\n[studies.best]\nkind = 'optimize'\nover = 'turn'\nvary = {{ rod = ['55 mm', '70 mm'] }}\n\
             fit = {{ point = 'C', to = [[30, 60], [35, 62], [25, 70]], closed = true }}\n"
        ));
        run(&model, &model.studies[1], &mut Silent)
    };
    assert!(fitted(720).is_ok());
    let told = fitted(360).unwrap_err();
    let notes: Vec<&String> = told.iter().flat_map(|d| &d.notes).collect();
    let open = "the way does not come back to its start";
    assert!(notes.iter().any(|note| note.contains(open)), "{notes:?}");
}

/// Where a path turns back it has no direction to be free along: by hand, the ends of a slider's stroke are met in (150 - (q + r))^2 + 25 + (58 - (q - r))^2.
#[test]
fn places_at_the_ends_of_a_stroke_are_held_there() {
    for from in [-70, 0, 10] {
        let text = format!(
            "units = {{ length = 'mm', angle = 'deg' }}
[parameters]
r = '30 mm'
q = '100 mm'
[links]
frame = {{ O = [0, 0], G = [200, 0] }}
crank = {{ O-B = 'r' }}
rod = {{ B-C = 'q' }}
piston = {{ C = [0, 0] }}
[joints]
way = {{ slider = 'piston', at = 'C', on = 'O -> G' }}
[drives]
motor = {{ turns = 'crank', from = {from}, to = {}, speed = '60 rpm' }}
[assembly]
C = {{ near = [130, 0] }}
[studies.turn]
kind = 'motion'
[studies.best]
kind = 'optimize'
vary = {{ r = ['20 mm', '40 mm'], q = ['80 mm', '120 mm'] }}
fit = {{ point = 'C', to = [[150, 0], [100, 5], [58, 0]], timing = 'nearest' }}
",
            from + 360
        );
        let result = best(&read(&text));
        assert!(result.diagnostics.is_empty(), "{:?}", result.diagnostics);
        assert!((scalar(&result, "r") - 40.0).abs() < 1e-6);
        assert!((scalar(&result, "q") - 104.0).abs() < 1e-5);
        assert!((scalar(&result, "sum of squares") - 97.0).abs() < 1e-8);
        // Held by r alone: 2 (150 - 144) - 2 (58 - 64) = 24 mm^2 for 1 mm.
        let holds = result
            .listings
            .iter()
            .find(|l| l.title.starts_with("what holds"));
        let rows: Vec<String> =
            holds.map_or(Vec::new(), |l| l.rows.iter().map(|r| r.join(" ")).collect());
        assert!(
            rows.len() == 1 && rows[0].contains("r <= 40 mm"),
            "{rows:?}"
        );
    }
}
