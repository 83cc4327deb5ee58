//! Benchmarks of multibody dynamics against solutions found apart from Kempe.
#![allow(clippy::unwrap_used, clippy::excessive_precision)]

use std::f64::consts::FRAC_PI_2;

use crate::common::{Free, at};
use crate::known;
use kempe_number::math::{asin, exp, ln, sin_cos};
use kempe_simulate::{Ending, Happened, Method, Resistance, Stop};

const PENDULUM: &str = include_str!("../../../../examples/benchmarks/pendulum.toml");

#[test]
fn a_pendulum_keeps_to_elliptic_functions() {
    let found = Free::new(PENDULUM, 10.0).run();
    for (time, x, y, rate) in known::PENDULUM {
        let [q, v] = at(&found, 0, time);
        let (s, c) = sin_cos(q);
        let off = (c - x).abs().max((s - y).abs());
        assert!(off < 1e-11, "{time}: {off:e}");
        assert!((v.abs() - f64::abs(rate)).abs() < 1e-10, "{time}: {v}");
    }
    let long = Free::new(PENDULUM, 2000.0).run();
    let (s, c) = sin_cos(at(&long, 0, 2000.0)[0]);
    let off = (c - 0.81460306858903215212)
        .abs()
        .max((s + 0.58001882783693546159).abs());
    assert!(off < 1e-8, "{off:e}");
}

#[test]
fn many_four_bars_pass_their_change_points() {
    const TWO: &str = include_str!("../../../../examples/benchmarks/n-four-bar-2.toml");
    const FORTY: &str = include_str!("../../../../examples/benchmarks/n-four-bar-40.toml");
    for (n, text, x, y, vx, vy) in [
        (
            2,
            TWO,
            0.328458111540815379,
            0.944518538178600962,
            1.42305147020694412,
            -0.494868845487042959,
        ),
        (
            40,
            FORTY,
            0.18051222668672839,
            0.983572740582311575,
            1.14844127746941413,
            -0.210770066779423932,
        ),
    ] {
        let mut free = Free::new(text, 10.0);
        free.question.start[0][1] = -1.0;
        free.question.tolerance = 1e-10;
        let found = free.run();
        assert_eq!(found.ending, Ending::Until);
        let [q, v] = at(&found, 0, 10.0);
        let (s, c) = sin_cos(q);
        for (found, exact) in [(c, x), (s, y), (-s * v, vx), (c * v, vy)] {
            assert!((found - exact).abs() < 1e-7, "{n}: {found}, not {exact}");
        }
    }
}

/// Amplitude `am(u)` and `dn(u)` of Jacobi's functions to a parameter below 1, and the quarter period, by means of arithmetic and geometry.
fn jacobi(m: f64, u: impl Fn(f64) -> f64) -> [f64; 3] {
    let (mut a, mut b) = (1.0_f64, (1.0 - m).sqrt());
    let mut ratios = Vec::new();
    while (a - b).abs() > 1e-16 && ratios.len() < 12 {
        let c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        ratios.push(c / a);
    }
    let quarter = FRAC_PI_2 / a;
    let start = a * f64::from(1_u32 << ratios.len()) * u(quarter);
    let angle = (ratios.iter().rev()).fold(start, |angle, ratio| {
        0.5 * (angle + asin(ratio * sin_cos(angle).0))
    });
    let s = sin_cos(angle).0;
    [angle, (1.0 - m * s * s).sqrt(), quarter]
}

/// By the measure of the library of benchmarks: places and speeds of B0 at 401 times, in parts of what they are or of a thousandth.
#[test]
fn many_four_bars_stay_with_elliptic_functions_all_the_way() {
    const TWO: &str = include_str!("../../../../examples/benchmarks/n-four-bar-2.toml");
    const FORTY: &str = include_str!("../../../../examples/benchmarks/n-four-bar-40.toml");
    for (n, text, allowed) in [(2.0, TWO, [3e-8, 5e-7]), (40.0, FORTY, [1.5e-8, 2e-7])] {
        let a = 9.81 * ((n + 1.0) / 2.0 + n) / ((n + 1.0) / 3.0 + n);
        let fastest = f64::sqrt(1.0 + 4.0 * a);
        let mut free = Free::new(text, 10.0);
        free.question.start[0][1] = -1.0;
        let found = free.run();
        let (mut squares, mut worst) = (0.0, 0.0_f64);
        for k in 0..=400 {
            let time = 0.025 * f64::from(k);
            let by = |quarter: f64| quarter - 0.5 * fastest * time;
            let [angle, dn, _] = jacobi(4.0 * a / (fastest * fastest), by);
            let state = |q: f64, v: f64| {
                let (s, c) = sin_cos(q);
                [c, s, -s * v, c * v]
            };
            let exact = state(2.0 * angle - FRAC_PI_2, -fastest * dn);
            let [q, v] = at(&found, 0, time);
            for (is, exact) in state(q, v).into_iter().zip(exact) {
                let off = (is - exact).abs() / f64::max(exact.abs(), 1e-3);
                squares += off * off / (4.0 * 401.0);
                worst = worst.max(off);
            }
        }
        assert!(f64::sqrt(squares) < allowed[0], "{n}: {squares:e}");
        assert!(worst < allowed[1], "{n}: {worst:e}");
    }
}

const ANDREWS: &str = include_str!("../../../../examples/benchmarks/andrews.toml");

#[test]
fn andrews_squeezer_runs_free() {
    let found = Free::new(ANDREWS, 0.03).run();
    for (time, beta, rate) in known::ANDREWS {
        let [q, v] = at(&found, 0, time);
        assert!((q / beta - 1.0).abs() < 1e-11, "{time}: {q}, not {beta}");
        assert!((v / rate - 1.0).abs() < 1e-9, "{time}: {v}, not {rate}");
    }
    // A spring and a constant torque: the work is that of the torque.
    let work: f64 = found.work.at(0.03, &[]);
    let turned = at(&found, 0, 0.03)[0] - at(&found, 0, 0.0)[0];
    assert!((work / (0.033 * turned) - 1.0).abs() < 1e-11, "{work}");
}

/// Which part of the mass of both the light cart is.
const LIGHT: f64 = 1e-6 / (1.0 + 1e-6);

/// How long the light cart's pole falls from level through an angle, s: the integral of the root of `(cos^2 + e sin^2) / (2 g sin)` by
/// Simpson's rule, over `u` near level where the angle is its square, and over `w` where it passes below, with `cos = sinh(w) sqrt(e / (1 - e))`.
fn falls_for(angle: f64) -> f64 {
    let simpson = |f: &dyn Fn(f64) -> f64, [low, high]: [f64; 2]| {
        let h = (high - low) / 6000.0;
        let weight = |k| match k {
            0 | 6000 => 1.0,
            k if k % 2 == 1 => 4.0,
            _ => 2.0,
        };
        let all = (0..=6000).map(|k| weight(k) * f(low + h * f64::from(k)));
        all.sum::<f64>() * h / 3.0
    };
    let level = |u: f64| {
        let (s, c) = sin_cos(u * u);
        // Twice `u` over the root of the sine of its square.
        let over = if u == 0.0 { 2.0 } else { 2.0 * u / s.sqrt() };
        over * ((c * c + LIGHT * s * s) / 19.62).sqrt()
    };
    let turn = (LIGHT / (1.0 - LIGHT)).sqrt();
    let below = |w: f64| {
        let e = exp(w);
        let [sinh, cosh] = [0.5 * (e - 1.0 / e), 0.5 * (e + 1.0 / e)];
        let c = turn * sinh;
        let s = (1.0 - c * c).sqrt();
        LIGHT.sqrt() * turn * cosh * cosh / (s * (19.62 * s).sqrt())
    };
    let third = std::f64::consts::FRAC_PI_3;
    let near = |angle: f64| simpson(&level, [0.0, angle.sqrt()]);
    let w = |angle: f64| {
        let x = sin_cos(angle).1 / turn;
        x.signum() * ln(x.abs() + (x * x + 1.0).sqrt())
    };
    if angle <= third {
        near(angle)
    } else if angle <= 2.0 * third {
        near(third) + simpson(&below, [w(angle), w(third)])
    } else {
        2.0 * near(third) + simpson(&below, [-w(third), w(third)])
            - near(std::f64::consts::PI - angle)
    }
}

#[test]
fn a_light_cart_is_thrown_about_by_its_pole() {
    // Peaks of 4429 rad/s and 1 us: 1e-6 kg below 1 kg on a metre. Its period is an elliptic integral.
    let text = include_str!("../../../../examples/benchmarks/cart-pole.toml");
    let period = 1.8060981427266355004;
    let half = falls_for(std::f64::consts::PI);
    assert!((2.0 * half - period).abs() < 1e-11);
    let found = Free::new(text, 10.0).run();
    assert_eq!(found.ending, Ending::Until);
    let (mut squares, mut late, mut off_rate, mut off_cart) = (0.0, 0.0_f64, 0.0_f64, 0.0_f64);
    for k in 0..2000 {
        let time = 10.0 * (f64::from(k) + 0.5) / 2000.0;
        let ([q, v], [x, u]) = (at(&found, 1, time), at(&found, 0, time));
        // When it is there: falling with a rate below nothing, and back.
        let there = falls_for(q.abs());
        let there = if v > 0.0 { period - there } else { there };
        let by = (time - there) - period * ((time - there) / period).round();
        let (s, c) = sin_cos(q);
        let apart = (v * by).abs();
        squares += apart * apart / 2000.0;
        late = late.max((v * by).abs() / (1.0 + v.abs()));
        // What falls moves: in parts of all that can.
        let moved = v * v * (c * c + LIGHT * s * s);
        off_rate = off_rate.max((moved + 19.62 * s).abs() / 19.62);
        // Nothing pushes both along the rail.
        let by_momentum = (1.0 - LIGHT) * (1.0 - c);
        off_cart = off_cart.max((x - by_momentum).abs());
        off_cart = off_cart.max((u - (1.0 - LIGHT) * s * v).abs() / (1.0 + v.abs()));
    }
    // The root of the mean square of the angle's errors, and at every instant how late it is, in nanoseconds.
    assert!(f64::sqrt(squares) < 1e-8, "{squares:e}");
    assert!(late < 1e-9, "{late:e}");
    assert!(off_rate < 1e-8, "{off_rate:e}");
    assert!(off_cart < 1e-10, "{off_cart:e}");
}

#[test]
fn a_slider_crank_runs_free_from_its_dead_point() {
    // Uniform rods, no gravity, 10 N m on the crank, stretched and at rest. Reference: another integrator, work against energy 5e-11.
    let text = include_str!("../../../../examples/benchmarks/free-slider-crank.toml");
    let found = Free::new(text, 1.0).run();
    let [q, v] = at(&found, 0, 1.0);
    assert!((q / 5.642_329_982_104_728 - 1.0).abs() < 1e-10, "{q}");
    assert!((v / 10.176_525_166_012_459 - 1.0).abs() < 1e-10, "{v}");
}

#[test]
fn a_crank_rocker_runs_free() {
    let text = include_str!("../../../../examples/benchmarks/crank-rocker.toml");
    let mut free = Free::new(text, 3.0);
    free.question.start[0][1] = 30.0;
    let found = free.run();
    for (time, angle, rate) in known::CRANK_ROCKER {
        let [q, v] = at(&found, 0, time);
        assert!(
            (q - angle).abs() < 1e-10 * angle,
            "{time}: {q}, not {angle}"
        );
        assert!((v - rate).abs() < 1e-10 * rate, "{time}: {v}, not {rate}");
    }
}

#[test]
fn a_pendulum_with_a_seal_swings_less_and_less_and_sticks() {
    // theta'' = -9.81 sin theta - 0.5 sgn(theta'): between rests, 9.81 (cos b - cos a) = 0.5 (a + b).
    let text = include_str!("../../../../examples/benchmarks/friction-pendulum.toml");
    let found = Free::new(text, 60.0).run();
    let exact = [
        1.41787328702911232,
        1.27690762583836481,
        1.14492617200563388,
        1.01990007064326988,
        0.900365090901768814,
    ];
    let down = -std::f64::consts::FRAC_PI_2;
    let breaks = found.laws[0].breaks(&[]);
    assert_eq!(found.ending, Ending::Until);
    for (k, amplitude) in exact.iter().enumerate() {
        let [q, v] = at(&found, 0, breaks[k + 1]);
        assert!(
            (f64::abs(q - down) - amplitude).abs() < 1e-10,
            "{k}: {}",
            q - down
        );
        assert!(v.abs() < 1e-10);
    }
    // At last it hangs where the seal holds it.
    let last = found.happenings.last().unwrap();
    assert_eq!(last.what, Happened::Sticks);
    let [q, _] = at(&found, 0, 60.0);
    assert!(9.81 * f64::abs(sin_cos(q - down).0) < 0.5);
    let work: f64 = found.work.at(60.0, &[]);
    let fallen = 9.81 * sin_cos(q).0;
    assert!((work - fallen).abs() < 1e-9, "{work} {fallen}");
}

const BALL: &str = "units = { length = \"m\" }\n[links]\nframe = { O = [0, 0], U = [0, 1] }\n\
    ball = { B = [0, 0], mass = \"1 kg\", inertia = \"1 kg m^2\" }\n[joints]\nrail = { slider = \"ball\", at = \"B\", on = \"O -> U\" }\n\
    [drives]\nfall = { slides = \"rail\", at = 1 }\n[measures]\nheight = \"y(B)\"\n";

#[test]
fn a_ball_bounces_and_comes_to_rest() {
    let mut free = Free::new(BALL, 3.0);
    free.stop("height", 0.5);
    let found = free.run();
    let first = f64::sqrt(2.0 / 9.81);
    let mut time = first;
    let mut flight = 2.0 * first;
    for happening in found.happenings.iter().take(8) {
        assert!(
            (happening.time - time).abs() < 1e-12,
            "{} {time}",
            happening.time
        );
        flight *= 0.5;
        time += flight;
        let Happened::Strikes { before, after, .. } = happening.what else {
            panic!("{happening:?}")
        };
        assert!((after + 0.5 * before).abs() < 1e-10);
    }
    let last = found.happenings.last().unwrap();
    assert!(matches!(last.what, Happened::Rests { stop: 0 }));
    assert!((last.time - 3.0 * first).abs() < 1e-7);
    assert!(at(&found, 0, 3.0)[0].abs() < 1e-12);
    // All of its energy is gone, and the work says where.
    let work: f64 = found.work.at(3.0, &[]);
    assert!((work + 9.81).abs() < 1e-9, "{work}");
}

/// It turns at the tops of its flights, of the last ones, too, which are hardly longer than rounding.
#[test]
fn a_ball_that_rubs_bounces_and_comes_to_rest() {
    let text = format!("{BALL}[friction]\nrail = {{ drag = \"0.5 N\" }}\n");
    let (up, down) = (9.81 + 0.5, 9.81 - 0.5);
    for until in [3.0, 10.0, 30.0] {
        for restitution in [0.2, 0.3, 0.4, 0.5, 0.6] {
            let mut free = Free::new(&text, until);
            free.stop("height", restitution);
            let found = free.run();
            assert_eq!(found.ending, Ending::Until, "{restitution} {until}");
            let first = f64::sqrt(2.0 / down);
            let slower = restitution * f64::sqrt(down / up);
            let flight = restitution * down * first * (1.0 / up + 1.0 / f64::sqrt(up * down));
            let rests = first + flight / (1.0 - slower);
            let last = found.happenings.last().unwrap();
            let off = last.time - rests;
            assert!(off.abs() < 1e-7 * until, "{restitution} {until}: {off:e}");
            assert!(at(&found, 0, until)[0].abs() < 1e-11);
        }
    }
}

#[test]
fn a_soft_stop_gives_back_what_it_takes() {
    let mut free = Free::new(BALL, 1.0);
    let gap = free.measure("height");
    free.question.stops.push(Stop {
        gap,
        resistance: Resistance::Soft {
            stiffness: 1e5,
            damping: 0.0,
        },
    });
    let found = free.run();
    // Deepest where m g (h + d) = k d^2 / 2; back at the height it came from.
    let deepest = (9.81 + f64::sqrt(9.81 * 9.81 + 2.0 * 1e5 * 9.81)) / 1e5;
    let (low, high) = found.laws[0].extent(&[]);
    assert!((low + deepest).abs() < 1e-9, "{low} {deepest}");
    assert!(high <= 1.0 + 1e-9);
    let breaks = found.laws[0].breaks(&[]);
    let [_, rebound] = at(&found, 0, breaks[2]);
    assert!((rebound - f64::sqrt(2.0 * 9.81)).abs() < 1e-8, "{rebound}");
}

#[test]
fn it_ends_where_it_is_asked_to() {
    let mut free = Free::new(BALL, 3.0);
    let height = free.measure("height");
    let below = kempe_units::Expr::Sub(Box::new(kempe_units::Expr::Const(0.25)), Box::new(height));
    free.question.end_when.push(below);
    let found = free.run();
    assert_eq!(found.ending, Ending::Condition(0));
    assert!(
        (found.end - f64::sqrt(2.0 * 0.75 / 9.81)).abs() < 1e-12,
        "{}",
        found.end
    );
}

/// What a stop keeps from going on never comes beyond, and yet is where a condition begins to hold.
#[test]
fn conditions_hold_where_stops_and_friction_end_a_motion() {
    let first = f64::sqrt(2.0 / 9.81);
    for restitution in [0.0, 0.5, 1.0] {
        let mut free = Free::new(BALL, 3.0);
        free.stop("height", restitution);
        let height = free.measure("height");
        free.question.end_when = vec![kempe_units::Expr::Neg(Box::new(height))];
        let found = free.run();
        assert_eq!(found.ending, Ending::Condition(0), "{restitution}");
        assert!((found.end - first).abs() < 1e-12, "{restitution}");
    }
    // A limit switch where the stop is: on at every impact, off by every flight, and on where it comes to rest.
    let text = format!("{BALL}[switches]\ndown = {{ on = \"height <= 0 m\" }}\n");
    let mut free = Free::new(&text, 3.0);
    free.stop("height", 0.5);
    let found = free.run();
    let all: Vec<bool> = (found.happenings.iter())
        .filter_map(|it| match it.what {
            Happened::Switches { on, .. } => Some(on),
            _ => None,
        })
        .collect();
    let struck = (found.happenings.iter()).filter(|it| matches!(it.what, Happened::Strikes { .. }));
    assert!(all.len() + 1 >= 2 * struck.count(), "{all:?}");
    assert!(all.iter().enumerate().all(|(k, on)| *on == (k % 2 == 0)));
    assert_eq!(all.last(), Some(&true));
    // Up at 3 m/s against its weight and a drag that holds it at the top: it comes to rest, and no further.
    let text = format!("{BALL}falls = \"-rate(fall)\"\n[friction]\nrail = {{ drag = \"11 N\" }}\n");
    let mut free = Free::new(&text, 1.0);
    free.question.start[0][1] = 3.0;
    free.question.end_when = vec![free.measure("falls")];
    let found = free.run();
    assert_eq!(found.ending, Ending::Condition(0));
    assert!((found.end - 3.0 / (9.81 + 11.0)).abs() < 1e-12);
}

#[test]
fn both_methods_find_one_motion() {
    let mut free = Free::new(ANDREWS, 0.01);
    let mut by = |method, tolerance| {
        free.question.method = method;
        free.question.tolerance = tolerance;
        let found = free.run();
        let used = found.used;
        let only = match method {
            Method::Explicit => used.implicit == 0,
            _ => used.explicit == 0,
        };
        assert!(only, "{used:?}");
        at(&found, 0, 0.01)
    };
    let explicit = by(Method::Explicit, 1e-13);
    let implicit = by(Method::Implicit, 1e-9);
    for (a, b) in explicit.iter().zip(implicit) {
        assert!((b / a - 1.0).abs() < 1e-8, "{a} {b}");
    }
}

#[test]
fn it_finds_by_itself_that_a_mechanism_is_stiff() {
    // A pendulum in a very thick fluid: rates of 1e6/s that die at once, then a slow fall.
    let text = PENDULUM.replace("180 deg", "0 deg")
        + "[dampers]\nfluid = { links = [\"frame\", \"rod\"], damping = \"1e6 N m s\" }\n";
    let mut free = Free::new(&text, 10.0);
    free.question.start[0][1] = 1.0;
    free.question.tolerance = 1e-9;
    let found = free.run();
    assert_eq!(found.ending, Ending::Until);
    assert!(
        found.used.implicit > 0 && found.evaluations < 100_000,
        "{:?}",
        found.used
    );
    let [q, v] = at(&found, 0, 10.0);
    assert!((v + 9.81e-6 * sin_cos(q).1).abs() < 1e-10, "{v}");
}

/// A slide on a pendulum held by a spring of 1e8 N/m with a thick damper: what rounding makes of its place keeps explicit steps far
/// below what is stable. It swings as one body.
#[test]
fn it_finds_that_rounding_holds_back_a_stiff_mechanism() {
    let text = r#"
units = { length = "m", angle = "deg" }
[links]
frame = { A = [0, 0] }
rod = { A-X = 1, mass = "0.2 kg", inertia = "0.02 kg m^2" }
bob = { Q = [0, 0], mass = "1 kg", inertia = "0.001 kg m^2" }
[joints]
slide = { slider = "bob", at = "Q", on = "A -> X" }
[springs]
hold = { between = "A-Q", on = ["rod", "bob"], stiffness = "1e8 N/m", free = "0.5 m" }
[dampers]
thick = { between = "A-Q", on = ["rod", "bob"], damping = "1e5 N s/m" }
[drives]
turn = { turns = "rod", at = -20 }
slip = { slides = "bob", at = 0.5 }
"#;
    let mut free = Free::new(text, 3.0);
    free.question.tolerance = 1e-10;
    let found = free.run();
    assert_eq!(found.ending, Ending::Until);
    assert!(
        found.used.implicit > 0 && found.evaluations < 500_000,
        "{:?} {}",
        found.used,
        found.evaluations
    );
    // As one body about A: rod with its center in the middle, bob at half a metre, which the spring lets go by its load over 1e8 N/m.
    let inertia = 0.02 + 0.2 * 0.25 + 0.001 + 0.25;
    let moment = 9.81 * (0.2 * 0.5 + 0.5);
    let [q, v] = at(&found, 0, 3.0);
    let [start, _] = at(&found, 0, 0.0);
    let fallen = moment * (sin_cos(start).0 - sin_cos(q).0);
    assert!(
        (0.5 * inertia * v * v / fallen - 1.0).abs() < 1e-6,
        "{q} {v}"
    );
}

/// A spring and a damper on a link of hardly any inertia: rates of 1e11/s, and after nothing of time theta = 90 deg (1 - exp(-k t / c)). Accelerations of
/// states that are off by what rounding and tolerance leave would be off by far more than it accelerates.
#[test]
fn a_link_of_hardly_any_inertia_takes_long_steps() {
    let text = "gravity = [0, 0]\n[links]\nframe = { O = [0, 0] }\narm = { O-P = 0.1, mass = \"1e-9 kg\", inertia = \"1e-12 kg m^2\" }\n\
        [drives]\npivot = { turns = \"arm\", at = 0 }\n[dampers]\nhinge = { links = [\"frame\", \"arm\"], damping = \"0.1 N m s\" }\n\
        [springs]\ndoor = { links = [\"frame\", \"arm\"], stiffness = \"3 N m/rad\", free = \"90 deg\" }\n";
    let found = Free::new(text, 1.0).run();
    assert_eq!(found.ending, Ending::Until);
    assert!(found.evaluations < 200_000, "{:?}", found.used);
    for time in [0.01, 0.03, 0.1, 0.3, 1.0] {
        let [q, v] = at(&found, 0, time);
        let left = FRAC_PI_2 * exp(-30.0 * time);
        assert!((q - (FRAC_PI_2 - left)).abs() < 1e-8, "{time} {q}");
        assert!((v - 30.0 * left).abs() < 1e-6, "{time} {v}");
    }
}

#[test]
fn a_load_that_grows_breaks_it_loose() {
    // 10 N m/s t against a seal of 5 N m, 1 kg on 1 m without weight: from 0.5 s on theta" = 10 t - 5.
    let text = "gravity = [0, 0]\n[links]\nframe = { O = [0, 0] }\nrod = { O-P = 1 }\n[drives]\npivot = { turns = \"rod\", at = 0 }\n\
        [masses]\nbob = { at = \"P\", mass = \"1 kg\" }\n[friction]\nO = { drag = \"5 N m\" }\n\
        [loads]\npush = { torque = \"10 N m/s * time\", on = \"rod\" }\n";
    let found = Free::new(text, 1.5).run();
    assert_eq!(found.ending, Ending::Until);
    let said: Vec<Happened> = found.happenings.iter().map(|h| h.what).collect();
    assert_eq!(said, [Happened::Sticks, Happened::Slips]);
    assert!((found.happenings[1].time - 0.5).abs() < 1e-9);
    let [q, v] = at(&found, 0, 1.5);
    assert!(
        (q - 10.0 / 6.0).abs() < 1e-8 && (v - 5.0).abs() < 1e-8,
        "{q} {v}"
    );
}

#[test]
fn what_hangs_on_a_drive_that_jumps_is_jerked_along() {
    // A cart that runs at 1 m/s turns round at once: the bob below it goes on, and swings about it at 2 rad/s.
    let text = "gravity = [0, \"-9.81 m/s^2\"]\nunits = { length = \"m\" }\n[links]\nframe = { O = [0, 0], X = [1, 0] }\n\
        cart = { C = [0, 0], mass = \"3 kg\", inertia = 1 }\nrod = { C-P = 1 }\n[joints]\nrail = { slider = \"cart\", at = \"C\", on = \"O -> X\" }\n\
        [drives]\nswing = { turns = \"rod\", at = \"-90 deg\" }\n\
        travel = { slides = \"rail\", from = 0, law = [{ to = 0.5, speed = \"1 m/s\" }, { to = 0, speed = \"1 m/s\" }] }\n\
        [masses]\nbob = { at = \"P\", mass = \"2 kg\" }\n";
    let mut free = Free::new(text, 0.9);
    free.question.free.truncate(1);
    free.question.start.truncate(1);
    let found = free.run();
    assert_eq!(found.ending, Ending::Until);
    let [q, v] = at(&found, 0, 0.4);
    assert!((q + std::f64::consts::FRAC_PI_2).abs() < 1e-12 && v.abs() < 1e-12);
    let [q, v] = at(&found, 0, 0.9);
    // Seen from the cart, which does not accelerate, a pendulum keeps its energy.
    let energy = 0.5 * v * v + 9.81 * sin_cos(q).0;
    assert!((energy - (2.0 - 9.81)).abs() < 1e-9, "{energy}");
    assert!(v > 0.0 || q > -std::f64::consts::FRAC_PI_2);
    // The cart's own change of energy is none; the bob's is what the drive gave.
    let work: f64 = found.work.at(0.9, &[]);
    let (s, c) = sin_cos(q);
    let [vx, vy] = [-1.0 - s * v, c * v];
    let gained = (vx * vx + vy * vy) - 1.0 + 2.0 * 9.81 * (s + 1.0);
    assert!((work - gained).abs() < 1e-8, "{work} {gained}");
}

#[test]
fn a_hard_stop_takes_all_speed_wherever_it_stands() {
    // Rounding leaves some speed after an impact, and puts the pose a little beyond the stop or before it.
    for degrees in 40..=80 {
        let text = BALL.replace(
            "height = \"y(B)\"",
            &format!("height = \"y(B) - {} m\"", 0.01 * f64::from(degrees)),
        );
        let mut free = Free::new(&text, 1.0);
        free.stop("height", 0.0);
        let found = free.run();
        assert_eq!(found.ending, Ending::Until, "{degrees}");
        let said: Vec<Happened> = found.happenings.iter().map(|h| h.what).collect();
        assert!(
            matches!(
                said.as_slice(),
                [Happened::Strikes { .. }, Happened::Rests { stop: 0 }]
            ),
            "{said:?}"
        );
        assert!((at(&found, 0, 1.0)[0] - 0.01 * f64::from(degrees)).abs() < 1e-12);
    }
}

#[test]
fn rattling_without_loss_comes_to_an_end_that_is_told() {
    let mut free = Free::new(BALL, 100.0);
    free.question.start[0][1] = 10.0;
    let height = free.measure("height");
    let bound = |x: f64| kempe_units::Expr::Const(x);
    for (large, small) in [
        (height.clone(), bound(0.9999)),
        (bound(1.0001), height.clone()),
    ] {
        free.question.stops.push(Stop {
            gap: kempe_units::Expr::Sub(Box::new(large), Box::new(small)),
            resistance: Resistance::Rigid { restitution: 1.0 },
        });
    }
    // A stop that nothing moves, besides.
    free.question.stops.push(Stop {
        gap: bound(0.0),
        resistance: Resistance::Rigid { restitution: 0.5 },
    });
    let found = free.run();
    assert_eq!(found.ending, Ending::TooManyEvents);
    assert!(found.happenings.len() > 100);
}

#[test]
fn a_conservative_motion_runs_back_the_way_it_came() {
    // Crank-rockers of all kinds, of both assemblies, some over change points: forth, and back with all speeds turned round.
    for (a, b, c, d, side) in [
        (20.0, 50.0, 40.0, 60.0, "left"),
        (20.0, 50.0, 40.0, 60.0, "right"),
        (60.0, 40.0, 50.0, 20.0, "left"),
        (30.0, 60.0, 30.0, 60.0, "right"),
        (25.0, 55.0, 45.0, 70.0, "right"),
        (2e-5, 5e-5, 4e-5, 6e-5, "left"),
        (2e5, 5e5, 4e5, 6e5, "left"),
    ] {
        let text = format!(
            "units = {{ length = \"mm\" }}\n[links]\nframe = {{ A = [0, 0], D = [{d}, 0] }}\n\
             crank = {{ A-B = {a}, mass = \"1 kg\", inertia = {} }}\n\
             coupler = {{ B-C = {b}, mass = \"2 kg\", inertia = {} }}\nrocker = {{ D-C = {c}, mass = \"1 kg\", inertia = {} }}\n\
             [drives]\nmotor = {{ turns = \"crank\", at = 50 }}\n[assembly]\nC = \"{side} of B -> D\"\n",
            a * a / 3.0,
            b * b / 3.0,
            c * c / 3.0,
        );
        // Long enough to swing, whatever the size.
        let time = f64::sqrt(a / 20.0) * 0.5;
        let mut forth = Free::new(&text, time);
        forth.question.start[0][1] = 3.0 / time;
        let found = forth.run();
        assert_eq!(found.ending, Ending::Until, "{text}");
        let [q, v] = at(&found, 0, time);
        let moved = q - forth.question.start[0][0];
        assert!(moved.abs() > 0.3, "{moved}");
        let mut back = Free::new(&text, time);
        back.question.start[0] = [q, -v];
        let found = back.run();
        assert_eq!(found.ending, Ending::Until, "{text}");
        let [home, rate] = at(&found, 0, time);
        let off = (home - forth.question.start[0][0]).abs();
        assert!(
            off < 1e-9 && (rate * time + 3.0).abs() < 1e-8,
            "{side} {a} {b}: {off:e} {rate}"
        );
    }
}

const DOUBLE: &str = "units = { length = \"m\" }\ngravity = [0, \"-9.81 m/s^2\"]\n[links]\nframe = { O = [0, 0] }\nupper = { O-A = 1 }\n\
    lower = { A-P = 0.7 }\n[drives]\nfirst = { turns = \"upper\", at = -20 }\nsecond = { turns = \"lower\", at = 10 }\n\
    [masses]\nelbow = { at = \"A\", mass = \"2 kg\" }\nbob = { at = \"P\", mass = \"1 kg\" }\n[measures]\nheight = \"y(P) + 1.1 m\"\n";

/// Kinetic energy and the momenta along the coordinates of the double pendulum, by its own formulas.
fn momenta([a, b]: [f64; 2], [u, w]: [f64; 2]) -> (f64, [f64; 2]) {
    let cos = sin_cos(a - b).1;
    let momenta = [3.0 * u + 0.7 * cos * w, 0.7 * cos * u + 0.49 * w];
    (0.5 * (momenta[0] * u + momenta[1] * w), momenta)
}

#[test]
fn a_stop_that_a_point_strikes_pushes_along_its_own_gradient() {
    let mut free = Free::new(DOUBLE, 1.5);
    free.stop("height", 0.6);
    let found = free.run();
    let strike = found.happenings[0];
    let Happened::Strikes { before, after, .. } = strike.what else {
        panic!("{strike:?}")
    };
    assert!((after + 0.6 * before).abs() < 1e-9 * before.abs());
    let t = strike.time;
    let [[a, u], [b, w]] = [0, 1].map(|drive| at(&found, drive, t * (1.0 - 1e-14)));
    let [[_, u2], [_, w2]] = [0, 1].map(|drive| at(&found, drive, t * (1.0 + 1e-14)));
    let height = |a: f64, b: f64| sin_cos(a).0 + 0.7 * sin_cos(b).0 + 1.1;
    assert!(height(a, b).abs() < 1e-10);
    let gradient = [sin_cos(a).1, 0.7 * sin_cos(b).1];
    assert!((gradient[0] * u + gradient[1] * w - before).abs() < 1e-8);
    let ((energy, p), (energy2, p2)) = (momenta([a, b], [u, w]), momenta([a, b], [u2, w2]));
    let change = [p2[0] - p[0], p2[1] - p[1]];
    // The impulse has the direction of the gradient, pushes, and takes what the restitution says.
    assert!((change[0] * gradient[1] - change[1] * gradient[0]).abs() < 1e-8);
    let impulse = change[0] / gradient[0];
    assert!(impulse > 0.0);
    assert!((energy2 - energy - 0.5 * impulse * (before + after)).abs() < 1e-8);
}

#[test]
fn stops_that_say_the_same_are_one() {
    let run = |times: usize| {
        let mut free = Free::new(DOUBLE, 2.0);
        for _ in 0..times {
            free.stop("height", 0.0);
        }
        let found = free.run();
        assert_eq!(found.ending, Ending::Until);
        [0, 1].map(|drive| at(&found, drive, 1.2))
    };
    for ([q, v], [p, u]) in run(1).into_iter().zip(run(3)) {
        assert!(
            (q - p).abs() < 1e-8 && (v - u).abs() < 1e-7,
            "{q} {p}, {v} {u}"
        );
    }
}
