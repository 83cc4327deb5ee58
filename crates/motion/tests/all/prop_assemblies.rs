//! All assemblies: the complete method against a dense search that shares nothing with it.
#![allow(clippy::unwrap_used, clippy::disallowed_methods)]
#![allow(clippy::needless_range_loop, reason = "matrices by their indices")]

use crate::support::generate::{Driver, Group, Recipe, make};
use crate::support::{Case, Rng, Spec, difference};
use kempe_motion::assemble::all_assemblies;

/// Levenberg and Marquardt's method on the errors of all joints, from a start; `None` where it does not close.
fn close(spec: &Spec, coordinates: &[f64], start: Vec<[f64; 3]>) -> Option<Vec<[f64; 3]>> {
    let size = spec.size();
    let n = 3 * (start.len() - 1);
    let mut poses = start;
    let square = |e: &[f64]| e.iter().map(|x| x * x).sum::<f64>();
    let step_of = |k: usize| if k % 3 == 2 { 1.0 } else { size };
    let mut errors = spec.errors(&poses, coordinates);
    let mut damping = 1e-2;
    for _ in 0..120 {
        if square(&errors) < 1e-24 {
            return Some(poses);
        }
        let columns: Vec<Vec<f64>> = (0..n)
            .map(|k| {
                let by = |h: f64| {
                    let mut moved = poses.clone();
                    moved[k / 3 + 1][k % 3] += h * step_of(k);
                    spec.errors(&moved, coordinates)
                };
                let (a, b) = (by(1e-6), by(-1e-6));
                a.iter().zip(&b).map(|(x, y)| (x - y) / 2e-6).collect()
            })
            .collect();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let mut better = false;
        for _ in 0..12 {
            let mut a = vec![vec![0.0; n + 1]; n];
            for i in 0..n {
                for j in 0..n {
                    a[i][j] = dot(&columns[i], &columns[j]);
                }
                a[i][i] += damping;
                a[i][n] = dot(&columns[i], &errors);
            }
            let step = gauss(a)?;
            let mut trial = poses.clone();
            for (k, d) in step.iter().enumerate() {
                trial[k / 3 + 1][k % 3] -= d * step_of(k);
            }
            let now = spec.errors(&trial, coordinates);
            if square(&now) < square(&errors) {
                (poses, errors) = (trial, now);
                damping = (damping * 0.2).max(1e-15);
                better = true;
                break;
            }
            damping *= 5.0;
        }
        if !better {
            break;
        }
    }
    (square(&errors) < 1e-20).then_some(poses)
}

fn gauss(mut a: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let n = a.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|i, j| a[*i][k].abs().total_cmp(&a[*j][k].abs()))?;
        a.swap(k, pivot);
        if a[k][k] == 0.0 {
            return None;
        }
        for i in k + 1..n {
            let f = a[i][k] / a[k][k];
            for j in k..=n {
                a[i][j] -= f * a[k][j];
            }
        }
    }
    let mut x = vec![0.0; n];
    for k in (0..n).rev() {
        let rest: f64 = (k + 1..n).map(|j| a[k][j] * x[j]).sum();
        x[k] = (a[k][n] - rest) / a[k][k];
    }
    Some(x)
}

/// Every pose that the search finds is among the assemblies, and the search finds all of them.
fn agree(recipe: &Recipe, starts: usize) -> (usize, usize) {
    let made = make(recipe);
    let spec = &made.spec;
    let case = Case::of(spec);
    let coordinates = spec.coordinates();
    if !case.mechanism.plan.decomposition.surplus.is_empty()
        || !case.mechanism.plan.decomposition.undetermined.is_empty()
    {
        return (0, 0);
    }
    let found = all_assemblies(&case.design, &coordinates);
    let size = spec.size();
    let known: Vec<Vec<[f64; 3]>> = found
        .list
        .iter()
        .map(|a| case.link_poses(&a.poses))
        .collect();
    let mut met = vec![false; known.len()];
    let mut rng = Rng(recipe.seed ^ 77);
    for _ in 0..starts {
        let start: Vec<[f64; 3]> = (0..spec.links.len())
            .map(|l| {
                if l == 0 {
                    [0.0; 3]
                } else {
                    [
                        rng.range(-1.5, 1.5) * size,
                        rng.range(-1.5, 1.5) * size,
                        rng.angle(),
                    ]
                }
            })
            .collect();
        let Some(pose) = close(spec, &coordinates, start) else {
            continue;
        };
        // Beyond its ends a curve is followed, but no assembly is looked for there.
        if spec.is_off_curves(&pose) {
            continue;
        }
        // Nearly double solutions are told apart by neither.
        if case.sigma(&pose, &coordinates) < 1e-4 {
            continue;
        }
        let at = known
            .iter()
            .position(|k| difference(k, &pose, size, &made.idle) < 1e-5);
        match at {
            Some(at) => met[at] = true,
            None => {
                let far = pose
                    .iter()
                    .any(|p| p[0].abs().max(p[1].abs()) > 100.0 * size);
                assert!(
                    far || !found.complete,
                    "{recipe:?}: a pose is missing among {}: {pose:?}\n{}",
                    known.len(),
                    case.text
                );
            }
        }
    }
    (known.len(), met.iter().filter(|m| **m).count())
}

fn recipe(seed: u64, driver: Driver, groups: &[Group]) -> Recipe {
    Recipe {
        seed,
        driver,
        groups: groups.to_vec(),
        decade: 0.0,
        hints: false,
    }
}

#[test]
fn triads_have_the_assemblies_that_a_dense_search_finds() {
    let (mut all, mut met) = (0, 0);
    for seed in 0..14 {
        let (a, b) = agree(&recipe(seed, Driver::Turn, &[Group::Triad]), 60);
        all += a;
        met += b;
    }
    assert!(all >= 28, "{all}");
    // Most are met by as few starts as this; none was met that is not listed.
    assert!(met * 10 >= all * 7, "{met} of {all}");
}

#[test]
fn floating_drives_have_the_assemblies_that_a_dense_search_finds() {
    let (mut all, mut met) = (0, 0);
    for seed in 0..40 {
        let groups: &[Group] = match seed % 4 {
            0 => &[Group::Rrr],
            1 => &[Group::Rrr, Group::Rrr],
            2 => &[Group::Rrp, Group::Rpr],
            _ => &[Group::Rpr],
        };
        let (a, b) = agree(&recipe(seed, Driver::Floating, groups), 30);
        all += a;
        met += b;
    }
    assert!(all >= 30, "{all}");
    assert!(met * 10 >= all * 7, "{met} of {all}");
}

#[test]
fn dyads_have_the_assemblies_that_a_dense_search_finds() {
    let kinds = [
        Group::Rrr,
        Group::Rpr,
        Group::Rrp,
        Group::PinInSlot,
        Group::SlotOnPin,
        Group::Prp,
        Group::Rpp,
        Group::Cylinder,
        Group::OffsetSlider,
        Group::TwoSlots,
        Group::PinInArc,
        Group::ArcOnPin,
        Group::PinOnCurve,
        Group::CurveOnPin,
    ];
    let (mut all, mut met) = (0, 0);
    for (seed, kind) in kinds.iter().cycle().take(36).enumerate() {
        let (a, b) = agree(&recipe(seed as u64, Driver::Turn, &[*kind]), 30);
        all += a;
        met += b;
    }
    assert!(met * 10 >= all * 9, "{met} of {all}");
}

/// Of more assemblies than are listed the one that the hints tell is among them, whichever that is: twelve four-bars side by side.
#[test]
fn the_nearest_of_thousands_is_found() {
    let all = |line: &dyn Fn(u32) -> String| (0..12).map(line).collect::<String>();
    let ground = all(&|k| format!("A{k} = [{}, 0], D{k} = [{}, 0], ", 100 * k, 100 * k + 60));
    let links = all(&|k| {
        format!(
            "c{k} = {{ A{k}-B{k} = 20 }}\nk{k} = {{ B{k}-C{k} = 50 }}\nr{k} = {{ D{k}-C{k} = 40 }}\n"
        )
    });
    let drives = all(&|k| format!("m{k} = {{ turns = \"c{k}\", at = 40 }}\n"));
    let frame = format!("frame = {{ {} }}\n", ground.trim_end_matches(", "));
    // Where C lies on either side of the line from B to D.
    let (s, c) = 40.0_f64.to_radians().sin_cos();
    let (b, d) = ([20.0 * c, 20.0 * s], [60.0, 0.0]);
    let way = [d[0] - b[0], d[1] - b[1]];
    let span = way[0].hypot(way[1]);
    let along = (50.0_f64 * 50.0 - 40.0 * 40.0 + span * span) / (2.0 * span);
    let up = (50.0 * 50.0 - along * along).sqrt();
    let at = |side: f64| {
        let [x, y] = way.map(|w| w / span);
        [
            b[0] + along * x - side * up * y,
            b[1] + along * y + side * up * x,
        ]
    };
    for pattern in [0_u32, 0b1111_1111_1111, 0b1011_0100_1011, 0b0000_0000_0111] {
        let place = |k: u32| {
            let [x, y] = at(if pattern >> k & 1 == 1 { -1.0 } else { 1.0 });
            format!("C{k} = {{ near = [{}, {y}] }}\n", x + 100.0 * f64::from(k))
        };
        let hints = all(&place);
        let text = format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\n[links]\n{frame}{links}[drives]\n{drives}[assembly]\n{hints}"
        );
        let case = Case::read(&text, "twelve.toml");
        let coordinates = vec![40.0_f64.to_radians(); 12];
        let found = all_assemblies(&case.design, &coordinates);
        assert!(!found.complete && found.list.len() > 100);
        assert!(
            found.list[0].distance < 1e-9,
            "{pattern:b}: {}",
            found.list[0].distance
        );
    }
}
