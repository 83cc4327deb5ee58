//! Several drives along time, laws, held drives, and whole circuits.
#![allow(clippy::unwrap_used, clippy::disallowed_methods)]

use std::f64::consts::{PI, TAU};

use crate::support::generate::{Driver, GROUPS, Group, Recipe, make};
use crate::support::{Case, Rng, add, norm, polar, sub, times};
use kempe_measure::{RowNote, Sampler};
use kempe_model::Measure;
use kempe_motion::EndReason;
use kempe_motion::circuit::Circuit;

/// Two motors on a five-bar: the dyad by hand, at every time, with speeds by differences.
#[test]
fn a_five_bar_on_two_motors_is_where_its_dyad_says() {
    let mut rng = Rng(21);
    for _ in 0..20 {
        let (a, e) = (rng.range(20.0, 40.0), rng.range(20.0, 40.0));
        let (b, c, d) = (
            rng.range(80.0, 100.0),
            rng.range(80.0, 100.0),
            rng.range(40.0, 80.0),
        );
        let (p0, p1) = (rng.angle(), rng.range(-4.0, 4.0));
        let (q0, q1) = (rng.angle(), rng.range(-4.0, 4.0));
        let text = format!(
            "units = {{ length = \"mm\", angle = \"rad\" }}
[links]
frame = {{ A = [0, 0], E = [{d}, 0] }}
one = {{ A-B = {a} }}
two = {{ E-D = {e} }}
left = {{ B-C = {b} }}
right = {{ D-C = {c} }}
[drives]
first = {{ turns = \"one\", from = {p0:e}, to = {:e}, speed = \"{:e} rad/s\" }}
second = {{ turns = \"two\", from = {q0:e}, to = {:e}, law = \"cycloidal\", in = \"2 s\" }}
[assembly]
C = \"left of B -> D\"
[measures]
x = \"x(C)\"
y = \"y(C)\"
vx = \"rate(x(C))\"
ay = \"rate(y(C), 2)\"
d1 = \"d(x(C), first)\"
d2 = \"d(x(C), second)\"
",
            p0 + p1,
            p1.abs() / 2.0,
            q0 + q1
        );
        let case = Case::read(&text, "five-bar.toml");
        let motion = case.must_move();
        let measures: Vec<&Measure> = case.model.measures.iter().map(|m| &m.measure).collect();
        let mut sampler = Sampler::new(&motion, &measures).unwrap();
        let place = |p: f64, q: f64| {
            let (bb, dd) = (polar(a, p), add([d, 0.0], polar(e, q)));
            let v = sub(dd, bb);
            let r = norm(v);
            let along = (r * r + b * b - c * c) / (2.0 * r);
            let up = (b * b - along * along).sqrt();
            add(bb, add(times(v, along / r), times([-v[1], v[0]], up / r)))
        };
        let laws = |t: f64| {
            let s = t / 2.0;
            (p0 + p1 * s, q0 + q1 * (s - (TAU * s).sin() / TAU))
        };
        for k in 1..10 {
            let t = 0.2 * f64::from(k);
            let row = sampler.at_time(t);
            if t > motion.reached().1 - 1e-9 {
                // The coupler reaches no further: that is checked elsewhere.
                assert_eq!(motion.ends.1, EndReason::Limit);
                break;
            }
            assert!(row.note.is_none() && row.closure < 1e-12, "{:?}", row.note);
            if row.smallest_singular_value < 0.02 {
                continue;
            }
            let (p, q) = laws(t);
            let at = |t: f64| {
                let (p, q) = laws(t);
                place(p, q)
            };
            let truth = place(p, q);
            let off = norm(sub(times([row.values[0], row.values[1]], 1e3), truth));
            assert!(off < 1e-9, "t {t}: off {off:e}");
            let h = 1e-3;
            let rate = (8.0 * (at(t + h)[0] - at(t - h)[0])
                - (at(t + 2.0 * h)[0] - at(t - 2.0 * h)[0]))
                / (12.0 * h);
            assert!(
                (row.values[2] * 1e3 - rate).abs() < 1e-6 * (1.0 + rate.abs()),
                "vx at {t}"
            );
            let bend = (16.0 * (at(t + h)[1] + at(t - h)[1])
                - (at(t + 2.0 * h)[1] + at(t - 2.0 * h)[1])
                - 30.0 * truth[1])
                / (12.0 * h * h);
            assert!(
                (row.values[3] * 1e3 - bend).abs() < 1e-4 * (1.0 + bend.abs()),
                "ay at {t}"
            );
            let g = 1e-4;
            let slope = |f: &dyn Fn(f64) -> f64| {
                (8.0 * (f(g) - f(-g)) - (f(2.0 * g) - f(-2.0 * g))) / (12.0 * g)
            };
            let by_p = slope(&|g| place(p + g, q)[0]);
            let by_q = slope(&|g| place(p, q + g)[0]);
            assert!((row.values[4] * 1e3 - by_p).abs() < 1e-4, "d1 at {t}");
            assert!(
                (row.values[5] * 1e3 - by_q).abs() < 1e-4,
                "d2 at {t}: {} {by_q} d1 {by_p}\n{text}",
                row.values[5] * 1e3
            );
        }
    }
}

/// Random mechanisms of which every drive moves: closed at all times, from one sampler or another.
#[test]
fn random_mechanisms_close_along_time() {
    let mut moved = 0;
    for seed in 0..120_u64 {
        let mut rng = Rng(seed ^ 0x71e5);
        let mut groups = vec![
            [
                Group::Cylinder,
                Group::HeldBar,
                Group::HeldSlider,
                Group::TwoSlots,
            ][rng.below(4)],
        ];
        for _ in 0..rng.below(4) {
            groups.push(GROUPS[rng.below(GROUPS.len())]);
        }
        let recipe = Recipe {
            seed,
            driver: Driver::Turn,
            groups,
            decade: 0.0,
            hints: true,
        };
        let mut made = make(&recipe);
        for (index, drive) in made.spec.drives.iter_mut().enumerate() {
            drive.time = 2.0;
            drive.to = drive.from + rng.range(-0.3, 0.3);
            drive.law = [None, Some("cycloidal"), Some("harmonic"), Some("4-5-6-7")][index % 4];
        }
        if made.spec.drives.len() < 2 {
            continue;
        }
        let case = Case::of(&made.spec);
        let sigma = case.sigma(&made.spec.poses(), &made.spec.coordinates());
        let motion = match case.motion() {
            Ok(motion) => motion,
            Err(error) => {
                assert!(
                    sigma < 1e-4 || !made.idle.is_empty(),
                    "seed {seed}: {error:?}\n{}",
                    case.text
                );
                continue;
            }
        };
        moved += 1;
        let mut sampler = Sampler::new(&motion, &[]).unwrap();
        let (low, high) = motion.reached();
        for k in 0..=16 {
            let t = if k == 16 {
                high
            } else {
                low + (high - low) * f64::from(k) / 16.0
            };
            let row = sampler.at_time(t);
            if let Some(note) = &row.note {
                assert!(
                    matches!(note, RowNote::AtLimit | RowNote::ChangePoint(_)),
                    "seed {seed} at {t}: {note:?}"
                );
                continue;
            }
            let far = row
                .links
                .iter()
                .fold(1.0_f64, |f, l| f.max(l[0].abs()).max(l[1].abs()));
            assert!(
                row.closure < 1e-12 * far,
                "seed {seed} at {t}: {:e}\n{}",
                row.closure,
                case.text
            );
            let gap = made.spec.gap(&row.links, &row.coordinates);
            assert!(gap < 2e-12 * far * far, "seed {seed} at {t}: {gap:e}");
        }
    }
    assert!(moved > 70, "{moved}");
}

/// A crank-rocker's circuit is a turn; a double rocker's goes out and back between its dead points.
#[test]
fn circuits_close_and_run_through_their_dead_points() {
    let mut rng = Rng(31);
    let (mut open, mut turning) = (0, 0);
    for _ in 0..40 {
        let [a, b, c, d]: [f64; 4] = std::array::from_fn(|_| rng.range(20.0, 100.0));
        let cosine = |reach: f64| (a * a + d * d - reach * reach) / (2.0 * a * d);
        let near = cosine((b - c).abs());
        let far = cosine(b + c);
        let clear = |x: f64| (x.abs() - 1.0).abs() > 0.02;
        let (near, far, clear) = (
            near.clamp(-1.0, 1.0).acos(),
            far.clamp(-1.0, 1.0).acos(),
            clear(near) && clear(far),
        );
        if near + 0.1 >= far || !clear {
            continue;
        }
        let from = 0.5 * (near + far);
        let case = Case::read(
            &format!(
                "units = {{ length = \"mm\", angle = \"rad\" }}
[links]
frame = {{ A = [0, 0], D = [{d}, 0] }}
crank = {{ A-B = {a} }}
coupler = {{ B-C = {b} }}
rocker = {{ D-C = {c} }}
[drives]
motor = {{ turns = \"crank\", from = {from:e}, to = {:e}, speed = \"1 rad/s\" }}
[assembly]
C = \"left of B -> D\"
",
                from + 0.01
            ),
            "circuit.toml",
        );
        let circuit = Circuit::new(&case.design).unwrap();
        assert!(circuit.closed, "{:?}", [a, b, c, d]);
        let full = near == 0.0 && far == PI;
        let mut limits: Vec<f64> = Vec::new();
        for s in &circuit.stretches {
            let (low, high) = s.motion.reached();
            limits.extend([low, high]);
        }
        let low = limits.iter().copied().fold(f64::INFINITY, f64::min);
        let high = limits.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if full {
            turning += 1;
            assert!((high - low - TAU).abs() < 1e-9, "{low} {high}");
        } else {
            open += 1;
            let (want_low, want_high) = match (near > 0.0, far < PI) {
                (true, true) => (near, far),
                (true, false) => (near, TAU - near),
                _ => (-far, far),
            };
            assert!(
                (low - want_low).abs() < 1e-11 && (high - want_high).abs() < 1e-11,
                "{low} {high} {want_low} {want_high}"
            );
            for s in &circuit.stretches {
                assert_eq!(s.motion.ends, (EndReason::Limit, EndReason::Limit));
            }
        }
        let mut samplers =
            kempe_measure::circuit_samplers(&circuit, &[], &[], &mut kempe_motion::Silent).unwrap();
        for k in 0..=40 {
            let row = kempe_measure::circuit_row(
                &circuit,
                &mut samplers,
                circuit.length * f64::from(k) / 40.0,
            )
            .unwrap();
            assert!(
                row.closure < 1e-11,
                "{:?}: {:e} {:?}",
                [a, b, c, d],
                row.closure,
                row.note
            );
        }
    }
    assert!(open > 5 && turning > 2, "{open} {turning}");
}

/// Drives at constant speed start and stop with a jump of their rates; the motion goes on over every one of them.
#[test]
fn follows_drives_whose_rates_jump() {
    let text = r#"
        units = { length = "mm", angle = "deg" }
        [links]
        frame = { A = [0, 0], D = [100, 0] }
        left = { A-B = 30 }
        right = { D-C = 40 }
        lb = { B-P = 80 }
        rb = { C-P = 80 }
        [drives]
        one = { turns = "left", from = 0, to = 360, speed = "60 deg/s" }
        two = { turns = "right", from = 0, law = [ { dwell = "1 s" }, { to = "180 deg", speed = "90 deg/s" }, { dwell = "0.5 s" }, { to = "0 deg", speed = "60 deg/s" } ] }
        [assembly]
        P = "left of B -> C"
    "#;
    let checked = kempe_model::Model::from_toml(text, "jumps", &mut |_| Err("no files".into()))
        .expect("a model");
    let mechanism = kempe_mechanism::Mechanism::new(&checked.model);
    let parameters: Vec<f64> = checked.model.parameter_values();
    let design = kempe_mechanism::Design::new(&mechanism, &parameters);
    let motion = kempe_motion::Motion::new(&design).expect("a motion");
    assert_eq!(motion.reached(), (0.0, 6.5));
    let mut sampler = kempe_measure::Sampler::new(&motion, &[]).expect("a sampler");
    for k in 0..=130 {
        let row = sampler.at_time(0.05 * f64::from(k));
        assert!(row.closure < 1e-12, "at {} s: {:?}", row.time, row.note);
    }
}

/// A drive that stops while another goes on: however fast it was, over however long a time.
#[test]
fn a_fast_drive_may_stop_long_before_a_slow_one() {
    for (turns, rpm, seconds) in [
        (1.0, 600.0, 5.0),
        (50.0, 600.0, 5.0),
        (20.0, 1500.0, 2.0),
        (0.5, 3000.0, 3600.0),
    ] {
        let case = Case::read(
            &format!(
                "units = {{ length = \"mm\", angle = \"deg\" }}
[links]
frame = {{ A = [0, 0], G = [0, 50], D = [60, 0] }}
crank = {{ A-B = 20 }}
rod = {{ B-C = 50 }}
rocker = {{ D-C = 40 }}
block = {{ S = [0, 0] }}
[joints]
guide = {{ slider = \"block\", at = \"S\", on = \"A -> G\" }}
[drives]
motor = {{ turns = \"crank\", from = 0, to = {}, speed = \"{rpm} rpm\" }}
push = {{ slides = \"block\", from = 0, to = 50, speed = \"{:e} mm/s\" }}
[assembly]
C = \"left of B -> D\"
[measures]
x = \"x(B)\"
v = \"rate(x(B))\"
",
                360.0 * turns,
                50.0 / seconds
            ),
            "stops.toml",
        );
        let motion = case.must_move();
        assert_eq!(
            motion.ends,
            (EndReason::Covered, EndReason::Covered),
            "{rpm} {seconds}"
        );
        let measures: Vec<&Measure> = case.model.measures.iter().map(|m| &m.measure).collect();
        let mut sampler = Sampler::new(&motion, &measures).unwrap();
        let rate = rpm / 60.0 * TAU;
        let stop = TAU * turns / rate;
        for k in 0..=20 {
            for t in [stop * f64::from(k) / 20.0, seconds * f64::from(k) / 20.0] {
                let row = sampler.at_time(t);
                let (angle, speed) = (rate * t.min(stop), if t < stop { rate } else { 0.0 });
                let expected = [0.02 * angle.cos(), -0.02 * speed * angle.sin()];
                assert!((row.values[0] - expected[0]).abs() < 1e-11, "{t}: {row:?}");
                if (t - stop).abs() > 1e-9 {
                    assert!(
                        (row.values[1] - expected[1]).abs() < 1e-9 * rate,
                        "{t}: {row:?}"
                    );
                }
            }
        }
    }
}

/// Two drives that end after each other, whatever their times are: behind the end of the first its rate is none, to the last bit.
#[test]
fn a_drive_may_stop_at_any_time_before_another() {
    for k in 1..200 {
        let (first, second) = (0.01 * f64::from(k), 2.5 + 0.001 * f64::from(k));
        let case = Case::read(
            &format!(
                "units = {{ length = \"mm\", angle = \"rad\" }}
[links]
frame = {{ O = [0, 0] }}
one = {{ O-A = 20 }}
two = {{ A-B = 50 }}
[drives]
first = {{ turns = \"one\", from = 0, to = {first:e}, speed = \"1 rad/s\" }}
second = {{ turns = \"two\", relative_to = \"one\", from = 0, to = {:e}, speed = \"1 rad/s\" }}
[measures]
x = \"x(B)\"
",
                -second
            ),
            "stops.toml",
        );
        let motion = case.must_move();
        let covered = (EndReason::Covered, EndReason::Covered);
        assert_eq!(motion.ends, covered, "{first} {second}");
        let mut sampler = Sampler::new(&motion, &[&case.model.measures[0].measure]).unwrap();
        for t in [0.5 * first, first + 0.1, second] {
            let angle = t.min(first);
            let expected = 0.02 * angle.cos() + 0.05 * (angle - t).cos();
            let x = sampler.values_at_time(t)[0];
            assert!((x - expected).abs() < 1e-12, "{first} {second} {t}: {x}");
        }
    }
}

/// What a drive's coordinate is stands in the drive, however large the mechanism: here its size is exactly 1 m.
#[test]
fn a_slide_is_no_angle_at_any_size() {
    for (size, drive, is_angle) in [
        (
            1.0,
            "push = { slides = \"block\", from = 0.1, to = 0.2, speed = 1 }",
            false,
        ),
        (
            2.0,
            "push = { slides = \"block\", from = 0.1, to = 0.2, speed = 1 }",
            false,
        ),
        (
            1.0,
            "turn = { turns = \"arm\", from = 0, to = 1, speed = 1 }",
            true,
        ),
        (
            2.0,
            "turn = { turns = \"arm\", from = 0, to = 1, speed = 1 }",
            true,
        ),
    ] {
        let other = match is_angle {
            true => String::new(),
            false => "block = { S = [0, 0] }\n[joints]\nway = { slider = \"block\", at = \"S\", on = \"A -> D\" }".to_string(),
        };
        let arm = match is_angle {
            true => "arm = { A-P = 0.5 }\n",
            false => "",
        };
        let text = format!(
            "units = {{ length = \"m\", angle = \"rad\" }}
[links]
frame = {{ A = [0, 0], D = [{size}, 0] }}
{arm}{other}
[drives]
{drive}
"
        );
        let motion = Case::read(&text, "size.toml").must_move();
        assert_eq!(motion.path.coordinates_are_angles(), is_angle, "{text}");
        assert_eq!(motion.size() == 1.0, size == 1.0, "{}", motion.size());
    }
}
