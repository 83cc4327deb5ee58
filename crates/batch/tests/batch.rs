//! One pose at a time, eight in lanes on every instruction set, and in parallel: the same bits.
#![allow(
    clippy::unwrap_used,
    reason = "test helpers: a failure is the test's failure"
)]

use std::path::Path;
use std::sync::Arc;

use kempe_batch::{Batch, Designs, Layout, Serial, Threads, sweep_states};
use kempe_mechanism::{Design, Mechanism};
use kempe_model::{Model, PointId};
use kempe_motion::Motion;
use kempe_number::{InstructionSet, Jet};

/// Every example file, in order.
fn examples() -> Vec<(String, Model)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let mut files: Vec<_> = ["seeds", "gallery"]
        .iter()
        .flat_map(|folder| std::fs::read_dir(root.join(folder)).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .collect();
    files.sort();
    assert!(files.len() > 20);
    (files.into_iter())
        .map(|path| {
            let text = std::fs::read_to_string(&path).unwrap();
            let folder = path.parent().unwrap().to_owned();
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            let mut read =
                |file: &str| std::fs::read_to_string(folder.join(file)).map_err(|e| e.to_string());
            let checked = Model::from_toml(&text, &name, &mut read).unwrap();
            (name, checked.model)
        })
        .collect()
}

/// Every example that moves: its name, its design as the file has it, and its motion.
fn moving() -> impl Iterator<Item = (String, Design<f64>, Arc<Motion>)> {
    examples().into_iter().filter_map(|(name, model)| {
        let values: Vec<f64> = model.parameter_values();
        let design = Design::new(&Mechanism::new(&model), &values);
        let motion = Motion::new(&design).ok()?;
        Some((name, design, motion))
    })
}

fn random(seed: &mut u64) -> f64 {
    *seed = seed
        .wrapping_mul(6364136223846793005)
        .wrapping_add(1442695040888963407);
    (*seed >> 11) as f64 / (1_u64 << 53) as f64
}

/// Equal bits; two undefined numbers are equal.
#[track_caller]
fn assert_same(name: &str, a: &[f64], b: &[f64]) {
    assert_eq!(a.len(), b.len());
    for (i, (a, b)) in a.iter().zip(b).enumerate() {
        let same = a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
        assert!(same, "{name}: number {i} is {a:e} and {b:e}");
    }
}

fn all_points(model: &Model) -> Vec<PointId> {
    (0..model.points.len() as u32).map(PointId).collect()
}

/// Path parameters all over the motion and beyond its ends, in no order.
fn parameters(motion: &Motion, count: usize) -> Vec<f64> {
    let (low, high) = motion.reached();
    let mut seed = 7;
    let mut list: Vec<f64> = (0..count)
        .map(|i| {
            let part = if i % 3 == 0 {
                random(&mut seed)
            } else {
                i as f64 / count as f64
            };
            low + (high - low) * (1.1 * part - 0.05)
        })
        .collect();
    list.extend(motion.events.iter().map(|e| e.at));
    list.push(f64::NAN);
    list
}

#[test]
fn sweeps_have_the_same_bits_one_by_one_in_lanes_and_in_parallel() {
    for (name, design, motion) in moving() {
        let mechanism = motion.mechanism();
        let model = &mechanism.model;
        let points = all_points(model);
        let batch = Batch::new(&motion, &points).unwrap();
        let parameters = parameters(&motion, 83);
        let n = parameters.len();

        // The reference: the motion's own solve on plain numbers.
        let mut expected = vec![f64::NAN; n * batch.columns()];
        let mut solver = motion.solver::<f64>();
        let mut closed = 0;
        for (row, &p) in parameters.iter().enumerate() {
            if !motion.reaches(p) {
                continue;
            }
            motion.solve(&design, p, &mut solver);
            let finite = |x: &f64| x.is_finite();
            if !solver
                .state
                .poses
                .iter()
                .all(|q| [q.x, q.y, q.c, q.s].iter().all(finite))
            {
                continue;
            }
            closed += 1;
            for (j, &point) in points.iter().enumerate() {
                let place = solver
                    .state
                    .place(&design, mechanism.any_marker(point).unwrap());
                expected[2 * j * n + row] = place[0];
                expected[(2 * j + 1) * n + row] = place[1];
            }
        }
        assert!(closed > 40, "{name} closes at {closed} places");
        for set in InstructionSet::ALL {
            let batch = batch.clone().with_instructions(set);
            let mut out = vec![0.0; expected.len()];
            assert_eq!(batch.sweep(&parameters, &mut out), Ok(closed), "{name}");
            assert_same(&name, &out, &expected);
        }
        // A batch of one point leaves out bodies that do not carry it.
        for (j, &point) in points.iter().enumerate() {
            let batch = Batch::new(&motion, &[point]).unwrap();
            let mut out = vec![0.0; 2 * n];
            assert_eq!(batch.sweep(&parameters, &mut out), Ok(closed), "{name}");
            assert_same(&name, &out, &expected[2 * j * n..2 * (j + 1) * n]);
        }
    }
}

#[test]
fn rates_have_the_same_bits_one_by_one_and_in_lanes() {
    for (name, design, motion) in moving() {
        let mechanism = motion.mechanism();
        let model = &mechanism.model;
        let points = all_points(model);
        let batch = Batch::new(&motion, &points).unwrap();
        let parameters = parameters(&motion, 21);
        let n = parameters.len();
        let rich = design.lift(Jet::<f64, 3>::constant);
        let mut expected = vec![f64::NAN; 3 * n * batch.columns()];
        sweep_states(
            &motion,
            &rich,
            &parameters,
            Jet::<f64, 3>::variable,
            |row, state| {
                let Some(state) = state else { return };
                for (j, &point) in points.iter().enumerate() {
                    let place = state.place(&rich, mechanism.any_marker(point).unwrap());
                    for order in 0..3 {
                        for axis in 0..2 {
                            let column = order * batch.columns() + 2 * j + axis;
                            expected[column * n + row] = place[axis].derivative(order);
                        }
                    }
                }
            },
        );
        for set in InstructionSet::ALL {
            let batch = batch.clone().with_instructions(set);
            let mut out = vec![0.0; expected.len()];
            batch.sweep_rates(&parameters, &mut out).unwrap();
            assert_same(&name, &out, &expected);
        }
    }
}

/// Determinants are those of the plan on plain numbers, of groups by Newton's method too; sweeps tell those of closed forms.
#[test]
fn determinants_are_those_of_the_plan() {
    let (mut compared, mut newton) = (0, 0);
    for (name, design, motion) in moving() {
        let (mechanism, values) = (motion.mechanism(), &design.parameters);
        let model = &mechanism.model;
        let batch = Batch::new(&motion, &all_points(model)).unwrap();
        let positions = batch.columns();
        let batch = batch.with_determinants();
        let steps = mechanism.plan.steps.iter().enumerate();
        let telling: Vec<usize> = steps
            .filter(|(_, s)| s.tells_modes())
            .map(|(k, _)| k)
            .collect();
        assert_eq!(batch.determinants(), telling.len());
        assert_eq!(batch.columns(), positions + telling.len());
        let (low, high) = motion.reached();
        let at: Vec<f64> = (0..4)
            .map(|i| low + (high - low) * (0.07 + 0.23 * f64::from(i)))
            .collect();
        // The same design in every lane.
        let count = 3;
        let all: Vec<f64> = (0..count).flat_map(|_| values.clone()).collect();
        let designs = Designs {
            values: &all,
            count,
            layout: Layout::ByDesign,
        };
        let mut found = vec![f64::NAN; count * at.len() * batch.columns()];
        batch.designs(designs, &at, &mut found).unwrap();
        let mut swept = vec![f64::NAN; at.len() * batch.columns()];
        batch.sweep(&at, &mut swept).unwrap();
        let mut solver = motion.solver::<f64>();
        for (k, p) in at.iter().enumerate() {
            motion.solve(&design, *p, &mut solver);
            for (j, step) in telling.iter().enumerate() {
                let own = solver.state.determinants[*step];
                let column = positions + j;
                let near = |x: f64| (x - own).abs() <= 1e-9 * own.abs() || own.is_nan();
                for d in 0..count {
                    let x = found[(k * batch.columns() + column) * count + d];
                    assert!(near(x), "{name} at {p}: {x} for {own}");
                }
                match mechanism.plan.steps[*step].needs_guess() {
                    true => newton += 1,
                    false => assert!(near(swept[column * at.len() + k]), "{name} at {p}"),
                }
                compared += 1;
            }
        }
    }
    assert!(compared > 200 && newton > 20, "{compared} {newton}");
}

/// Places of points in many designs, each solved for itself on plain numbers, and how many poses close.
fn one_by_one(
    motion: &Motion,
    points: &[PointId],
    by_design: &[f64],
    count: usize,
    at: &[f64],
) -> (Vec<f64>, usize) {
    let mechanism = motion.mechanism();
    let own = mechanism.model.parameters.len();
    let columns = 2 * points.len();
    let mut told = vec![f64::NAN; count * at.len() * columns];
    let mut solver = motion.solver::<f64>();
    let mut closed = 0;
    for d in 0..count {
        let design = Design::new(mechanism, &by_design[d * own..(d + 1) * own]);
        for (k, &p) in at.iter().enumerate() {
            motion.solve(&design, p, &mut solver);
            let finite = |x: &f64| x.is_finite();
            let mut poses = solver.state.poses.iter();
            if !poses.all(|q| [q.x, q.y, q.c, q.s].iter().all(finite)) {
                continue;
            }
            closed += 1;
            for (j, &point) in points.iter().enumerate() {
                let marker = mechanism.any_marker(point).unwrap();
                let place = solver.state.place(&design, marker);
                for axis in 0..2 {
                    told[(k * columns + 2 * j + axis) * count + d] = place[axis];
                }
            }
        }
    }
    (told, closed)
}

#[test]
fn extreme_designs_have_the_same_bits_one_by_one_and_in_lanes() {
    let mut seed = 5;
    let mut compared = 0;
    // A crank-rocker, a parallelogram along one way and through its change points, a kite, nearly a change point, a
    // rocker that comes to its dead points, a rhombus; mm.
    let bars = [
        (20.0, 50.0, 40.0, 60.0, 360.0),
        (20.0, 60.0, 20.0, 60.0, 170.0),
        (20.0, 60.0, 20.0, 60.0, 360.0),
        (40.0, 40.0, 60.0, 60.0, 170.0),
        (20.0, 50.0, 40.0, 69.999, 360.0),
        (50.0, 40.0, 30.0, 60.0, 60.0),
        (30.0, 30.0, 30.0, 30.0, 170.0),
    ];
    let cases = bars.iter().flat_map(|bar| {
        [1.0, 1e9, 1e-9]
            .into_iter()
            .flat_map(move |scale| [false, true].map(move |mirrored| (*bar, scale, mirrored)))
    });
    for ((crank, coupler, rocker, ground, to), scale, mirrored) in cases {
        let mm = |x: f64| format!("\"{:e} mm\"", x * scale);
        let ([near, far], [from, to]) = match mirrored {
            false => ([-0.0, ground].map(mm), [0.0, to]),
            true => ([ground, 0.0].map(mm), [to, 0.0]),
        };
        // A second dyad stands on the coupler, and points off the axis follow.
        let text = format!(
            "[parameters]\na = {}\nb = {}\nc = {}\n\
             [links]\nframe = {{ A = [{near}, \"-0 mm\"], D = [{far}, 0] }}\ncrank = {{ A-B = \"a\" }}\n\
             coupler = {{ B = [0, 0], C = [\"b\", 0], Q = [\"0.3*b\", 0], P = [\"0.5*b\", \"0.2*b\"] }}\n\
             rocker = {{ D-C = \"c\" }}\narm = {{ Q-R = \"b\" }}\nswing = {{ D-R = \"b\" }}\n\
             [drives]\nmotor = {{ turns = \"crank\", from = \"{from} deg\", to = \"{to} deg\", speed = \"1 rad/s\" }}\n",
            mm(crank),
            mm(coupler),
            mm(rocker),
        );
        let model = Model::from_toml(&text, "bars", &mut |_| Err("no tables".into()));
        let model = model.unwrap_or_else(|e| panic!("{e:?}\n{text}")).model;
        let own: Vec<f64> = model.parameter_values();
        let design = Design::new(&Mechanism::new(&model), &own);
        let Ok(motion) = Motion::new(&design) else {
            continue;
        };
        let (low, high) = motion.reached();
        let at: Vec<f64> = (0..37)
            .map(|i| low + (high - low) * f64::from(i) / 36.0)
            .collect();
        let count = 33;
        let by_design: Vec<f64> = (0..count)
            .flat_map(|k| {
                let spread = [0.0, 1e-3, 1e-9, 0.5][k % 4];
                let vary = |v: &f64| v * (1.0 + spread * (random(&mut seed) - 0.5));
                let mut values: Vec<f64> = own.iter().map(vary).collect();
                if k == 5 {
                    // No crank at all.
                    values[0] = 0.0;
                }
                values
            })
            .collect();
        let designs = Designs {
            values: &by_design,
            count,
            layout: Layout::ByDesign,
        };
        let points = all_points(&model);
        // All of them, each alone and some in twos: then bodies are left out, or are places of one point and no more.
        let alone = points.chunks(1).chain(points.chunks(2));
        for points in std::iter::once(&points[..]).chain(alone) {
            let (expected, closed) = one_by_one(&motion, points, &by_design, count, &at);
            for set in InstructionSet::ALL {
                let batch = Batch::new(&motion, points).unwrap().with_instructions(set);
                let mut out = vec![0.0; expected.len()];
                assert_eq!(batch.designs(designs, &at, &mut out), Ok(closed), "{text}");
                assert_same(&text, &out, &expected);
                compared += closed;
            }
        }
    }
    assert!(compared > 500_000, "{compared}");
}

#[test]
fn designs_have_the_same_bits_one_by_one_in_lanes_and_in_parallel() {
    for (name, design, motion) in moving() {
        let values = &design.parameters;
        let points = all_points(&motion.mechanism().model);
        let batch = Batch::new(&motion, &points).unwrap();
        let (low, high) = motion.reached();
        // More places than are solved together.
        let at: Vec<f64> = (0..20)
            .map(|i| low + (high - low) * (0.05 + 0.04 * f64::from(i)))
            .collect();

        // Whole blocks and a rest; some far enough not to close.
        let count = 150;
        let mut seed = 3;
        let by_design: Vec<f64> = (0..count)
            .flat_map(|d| {
                let spread = if d % 10 == 9 { 0.8 } else { 0.04 };
                values
                    .iter()
                    .map(|v| v * (1.0 + spread * (random(&mut seed) - 0.5)))
                    .collect::<Vec<_>>()
            })
            .collect();
        let columns = batch.columns();
        let (expected, closed) = one_by_one(&motion, &points, &by_design, count, &at);
        let by_parameter: Vec<f64> = (0..values.len())
            .flat_map(|p| (0..count).map(move |d| (d, p)))
            .map(|(d, p)| by_design[d * values.len() + p])
            .collect();
        for set in InstructionSet::ALL {
            let batch = batch.clone().with_instructions(set);
            for (values, layout) in [
                (&by_design, Layout::ByDesign),
                (&by_parameter, Layout::ByParameter),
            ] {
                let designs = Designs {
                    values,
                    count,
                    layout,
                };
                let mut out = vec![0.0; expected.len()];
                assert_eq!(batch.designs(designs, &at, &mut out), Ok(closed), "{name}");
                assert_same(&name, &out, &expected);
                let mut out = vec![0.0; expected.len()];
                assert_eq!(
                    batch.designs_on(&Threads(3), designs, &at, &mut out),
                    Ok(closed)
                );
                assert_same(&name, &out, &expected);
            }
        }
        for (j, &point) in points.iter().enumerate() {
            let batch = Batch::new(&motion, &[point]).unwrap();
            let designs = Designs {
                values: &by_design,
                count,
                layout: Layout::ByDesign,
            };
            let mut out = vec![0.0; 2 * count * at.len()];
            assert_eq!(batch.designs(designs, &at, &mut out), Ok(closed), "{name}");
            for (k, out) in out.chunks(2 * count).enumerate() {
                let first = (k * columns + 2 * j) * count;
                assert_same(&name, out, &expected[first..first + 2 * count]);
            }
        }
    }
}

#[test]
fn a_long_sweep_is_the_same_on_any_number_of_threads() {
    let (_, model) = (examples().into_iter())
        .find(|(name, _)| name == "crank-rocker")
        .unwrap();
    let mechanism = Mechanism::new(&model);
    let values: Vec<f64> = model.parameter_values();
    let design = Design::new(&mechanism, &values);
    let motion = Motion::new(&design).unwrap();
    let batch = Batch::new(&motion, &all_points(&model)).unwrap();
    let parameters: Vec<f64> = (0..40_003)
        .map(|i| 6.25 * f64::from(i) / 40_000.0)
        .collect();
    let mut serial = vec![0.0; batch.columns() * parameters.len()];
    let closed = batch.sweep_on(&Serial, &parameters, &mut serial).unwrap();
    for threads in [1, 2, 7] {
        let mut out = vec![0.0; serial.len()];
        assert_eq!(
            batch.sweep_on(&Threads(threads), &parameters, &mut out),
            Ok(closed)
        );
        assert_same("crank-rocker", &out, &serial);
    }
    assert!(batch.sweep(&parameters, &mut [0.0; 3]).is_err());
    assert!(Batch::new(&motion, &[PointId(99)]).is_err());
}

#[test]
fn what_a_batch_keeps_from_call_to_call_does_not_show() {
    let mut seed = 11;
    for (name, design, motion) in moving() {
        let (low, high) = motion.reached();
        let points = all_points(&motion.mechanism().model);
        let fresh = || Batch::new(&motion, &points).unwrap();
        let mut used = fresh();
        // Few, some that do not close, many at many places, few again, and told more of.
        for (count, places, spread) in [(2, 1, 0.01), (20, 3, 0.9), (300, 40, 0.05), (1, 2, 0.0)] {
            let values: Vec<f64> = (0..count * design.parameters.len())
                .map(|k| {
                    let own = design.parameters[k % design.parameters.len()];
                    own * (1.0 + spread * (random(&mut seed) - 0.5))
                })
                .collect();
            let designs = Designs {
                values: &values,
                count,
                layout: Layout::ByDesign,
            };
            let at: Vec<f64> = (0..places)
                .map(|_| low + (high - low) * random(&mut seed))
                .collect();
            for telling in [false, true] {
                let (fresh, again) = match telling {
                    false => (fresh(), used.clone()),
                    true => (
                        fresh().with_determinants(),
                        used.clone().with_determinants(),
                    ),
                };
                let mut one = vec![0.0; fresh.columns() * count * places];
                let mut other = one.clone();
                let batch = if telling { &again } else { &used };
                let closed = fresh.designs(designs, &at, &mut one);
                assert_eq!(batch.designs(designs, &at, &mut other), closed, "{name}");
                assert_same(&name, &one, &other);
            }
        }
        used = used.with_determinants();
        let mut told = vec![0.0; used.columns()];
        let one = Designs {
            values: &design.parameters,
            count: 1,
            layout: Layout::ByDesign,
        };
        let mut expected = told.clone();
        let closed = fresh()
            .with_determinants()
            .designs(one, &[low], &mut expected);
        assert_eq!(used.designs(one, &[low], &mut told), closed);
        assert_same(&name, &told, &expected);
    }
}
