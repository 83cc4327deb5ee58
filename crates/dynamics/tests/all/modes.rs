//! Modes of matrices against what is known of them by hand, and against the equations that they are to satisfy.
#![allow(clippy::unwrap_used, clippy::disallowed_methods)]

use kempe_dynamics::{Linearised, Mode, NoModes, modes};
use kempe_linear::{C, solve_complex};

fn made(n: usize, mass: &[f64], damping: &[f64], stiffness: &[f64]) -> Vec<Mode> {
    let it = Linearised {
        size: n,
        mass: mass.to_vec(),
        damping: damping.to_vec(),
        stiffness: stiffness.to_vec(),
        stiffness_terms: stiffness.iter().map(|x| x.abs()).collect(),
        force: vec![0.0; n],
        force_terms: vec![0.0; n],
    };
    modes(&it).expect("modes")
}

#[test]
fn one_coordinate_by_hand() {
    let [swings] = &made(1, &[4.0], &[8.0], &[100.0])[..] else {
        panic!()
    };
    assert_eq!(swings.square, 25.0);
    assert_eq!(swings.damping_ratio(), Some(0.2));
    assert!((swings.damped_angular_frequency() - 24.0_f64.sqrt()).abs() < 1e-14);
    let [creeps] = &made(1, &[1.0], &[5.0], &[4.0])[..] else {
        panic!()
    };
    assert_eq!(creeps.rates, [[-1.0, 0.0], [-4.0, 0.0]]);
    assert_eq!(creeps.damping_ratio(), Some(1.25));
    let [falls] = &made(1, &[1.0], &[0.0], &[-9.0])[..] else {
        panic!()
    };
    assert_eq!(
        (
            falls.growth(),
            falls.angular_frequency(),
            falls.damping_ratio()
        ),
        (3.0, None, None)
    );
    let [free] = &made(1, &[1.0], &[0.0], &[0.0])[..] else {
        panic!()
    };
    assert_eq!((free.growth(), free.angular_frequency()), (0.0, Some(0.0)));
}

#[test]
fn damping_between_modes_satisfies_the_equation() {
    // Two masses in a row, one damper between the first and the wall: not proportional.
    let (m, c, k) = (
        [1.0, 0.0, 0.0, 2.0],
        [3.0, 0.0, 0.0, 0.0],
        [30.0, -10.0, -10.0, 10.0],
    );
    for factor in [0.01, 0.3, 1.0, 5.0, 40.0] {
        let c: Vec<f64> = c.iter().map(|x| x * factor).collect();
        let modes = made(2, &m, &c, &k);
        let mut sum = 0.0;
        for s in modes.iter().flat_map(|mode| mode.rates) {
            let s = C::new(s[0], s[1]);
            let p =
                |e: usize| s * s * C::new(m[e], 0.0) + s * C::new(c[e], 0.0) + C::new(k[e], 0.0);
            let singular = p(0) * p(3) - p(1) * p(2);
            assert!(
                singular.norm() < 1e-9 * (1.0 + s.norm_sqr() * s.norm_sqr()),
                "{factor}: {s:?}"
            );
            sum += s.re;
        }
        // The sum of all is minus the trace of the damping over the mass.
        assert!((sum + 3.0 * factor).abs() < 1e-10 * (1.0 + factor));
    }
}

#[test]
fn every_rate_makes_the_equation_singular_whatever_the_damping() {
    let mut random = kempe_number::Random(5);
    for n in 1..6 {
        for strength in [0.0, 0.05, 1.0, 20.0] {
            let mut positive = |size: f64| {
                let half: Vec<f64> = (0..n * n).map(|_| random.uniform() - 0.5).collect();
                let entry = |k: usize| -> f64 {
                    (0..n)
                        .map(|j| half[k / n * n + j] * half[k % n * n + j])
                        .sum()
                };
                let own = |k: usize| if k / n == k % n { 0.2 } else { 0.0 };
                (0..n * n)
                    .map(|k| size * (entry(k) + own(k)))
                    .collect::<Vec<f64>>()
            };
            let (m, c, k) = (positive(1.0), positive(strength), positive(50.0));
            let found = made(n, &m, &c, &k);
            assert!(found.windows(2).all(|w| w[0].square <= w[1].square));
            for [re, im] in found.iter().flat_map(|mode| mode.rates) {
                assert!(re <= 0.0, "{re}");
                // A right side that the singular matrix cannot make makes the solution large.
                let s = C::new(re, im);
                let number = |x: f64| C::new(x, 0.0);
                let mut matrix: Vec<C> = (0..n * n)
                    .map(|e| s * s * number(m[e]) + s * number(c[e]) + number(k[e]))
                    .collect();
                let largest = |m: &[f64]| m.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
                let size = s.norm_sqr() * largest(&m) + largest(&k);
                let mut y: Vec<[C; 1]> = (0..n).map(|k| [number(1.0 + 0.3 * k as f64)]).collect();
                if solve_complex(&mut matrix, &mut y, n) {
                    let large = y.iter().fold(0.0_f64, |most, x| most.max(x[0].norm()));
                    assert!(large * size > 1e7, "{n} {strength}: {re} {im}: {large:e}");
                }
            }
        }
    }
}

#[test]
fn a_following_load_makes_it_flutter() {
    // x" + K x = 0 with K = [1 b; -b 2]: the squares of w meet at b = 1/2 and part into the plane.
    let below = made(2, &[1.0, 0.0, 0.0, 1.0], &[0.0; 4], &[1.0, 0.3, -0.3, 2.0]);
    let w = |sign: f64| 1.5 + sign * (0.25_f64 - 0.09).sqrt();
    assert!(
        (below[0].square - w(-1.0)).abs() < 1e-9 && (below[1].square - w(1.0)).abs() < 1e-9,
        "{below:?}"
    );
    assert!(below.iter().all(|m| m.growth().abs() < 1e-9));
    let above = made(2, &[1.0, 0.0, 0.0, 1.0], &[0.0; 4], &[1.0, 0.8, -0.8, 2.0]);
    let most = above.iter().map(Mode::growth).fold(f64::MIN, f64::max);
    // s^2 = -(3/2) +- i sqrt(b^2 - 1/4)
    let im = (0.64_f64 - 0.25).sqrt();
    let size = (2.25 + im * im).sqrt();
    assert!(
        (most - ((size - 1.5) / 2.0).sqrt()).abs() < 1e-9,
        "{above:?}"
    );
    // The docs: an unstable motion has no frequency of its own.
    assert!(above.iter().all(|m| m.angular_frequency().is_none()));
    assert!(below.iter().all(|m| m.angular_frequency().is_some()));
}

#[test]
fn what_nothing_brings_back_stays_free_beside_following_loads() {
    let mut random = kempe_number::Random(17);
    for n in 2..6 {
        for _ in 0..20 {
            let mut any = || 2.0 * random.uniform() - 1.0;
            // Neither stiffness nor damping feels one motion, which takes part in every coordinate.
            let still: Vec<f64> = (0..n).map(|_| 1.0 + 0.5 * any()).collect();
            let length: f64 = still.iter().map(|x| x * x).sum();
            let mut blind = |own: f64, follows: f64| -> Vec<f64> {
                let whole: Vec<f64> = (0..n * n)
                    .map(|k| if k / n == k % n { own } else { follows * any() })
                    .collect();
                let entry = |k: usize| {
                    let row = &whole[k / n * n..][..n];
                    let along: f64 = row.iter().zip(&still).map(|(a, x)| a * x).sum();
                    row[k % n] - along * still[k % n] / length
                };
                (0..n * n).map(entry).collect()
            };
            let (damping, stiffness) = (blind(0.5, 0.1), blind(50.0, 4.0));
            let mass: Vec<f64> = (0..n * n)
                .map(|k| {
                    if k / n == k % n {
                        1.0 + 0.1 * k as f64
                    } else {
                        0.1
                    }
                })
                .collect();
            let found = made(n, &mass, &damping, &stiffness);
            let free: Vec<&Mode> = found.iter().filter(|m| m.square == 0.0).collect();
            assert_eq!(free.len(), 1, "{found:?}");
            assert_eq!(free[0].rates, [[0.0; 2]; 2], "{found:?}");
            assert!(found.iter().all(|m| m.growth() <= 0.0), "{found:?}");
        }
    }
}

/// Two wheels on a shaft that turns freely, the lighter of them in tar: the motion that stands still is that of the free mode, and the other two rates are those of the
/// sprung one, however much the tar ties both together.
#[test]
fn what_stands_still_is_the_free_mode_in_tar_too() {
    for tar in [0.1, 1.0, 10.0, 1e3] {
        let found = made(
            2,
            &[2.0, 0.0, 0.0, 1.0],
            &[0.0, 0.0, 0.0, tar],
            &[5.0, -5.0, -5.0, 5.0],
        );
        let [free, sprung] = found.as_slice() else {
            panic!("{found:?}")
        };
        assert_eq!(free.square, 0.0);
        assert!(free.rates.contains(&[0.0; 2]), "{free:?}");
        assert!(sprung.rates.iter().all(|s| s[0] < 0.0), "{sprung:?}");
        // The lighter wheel is all but held by much tar: the heavier one swings against it.
        if tar >= 1e3 {
            assert!((sprung.damped_angular_frequency() - 2.5_f64.sqrt()).abs() < 1e-3);
        }
    }
}

#[test]
fn a_slow_mode_keeps_its_digits_beside_a_stiff_one() {
    // A milligram on a stiff spring and a ton on a soft one, joined by another; then two that nothing holds.
    let mass = [1e-6, 0.0, 0.0, 1e3];
    let [slow, fast] = &made(2, &mass, &[0.0; 4], &[1e7 + 1.0, -1.0, -1.0, 2.0])[..] else {
        panic!()
    };
    // By the sum and the product of both squares.
    let (sum, product) = ((1e7 + 1.0) / 1e-6 + 2e-3, ((1e7 + 1.0) * 2.0 - 1.0) / 1e-3);
    assert!((fast.square / sum - 1.0).abs() < 1e-12);
    assert!(
        (slow.square * fast.square / product - 1.0).abs() < 1e-11,
        "{}",
        slow.square
    );
    let [free, swings] = &made(2, &mass, &[0.0; 4], &[1e7, -1e7, -1e7, 1e7])[..] else {
        panic!()
    };
    assert_eq!(free.square, 0.0);
    assert!((swings.square / (1e7 * (1e6 + 1e-3)) - 1.0).abs() < 1e-12);
}

#[test]
fn what_moves_no_mass_is_named() {
    let it = Linearised {
        size: 2,
        mass: vec![1.0, 0.0, 0.0, 0.0],
        damping: vec![0.0; 4],
        stiffness: vec![1.0, 0.0, 0.0, 1.0],
        stiffness_terms: vec![1.0; 4],
        force: vec![0.0; 2],
        force_terms: vec![0.0; 2],
    };
    assert_eq!(modes(&it), Err(NoModes::NoMass(1)));
}

#[test]
fn a_following_load_makes_it_flutter_beside_a_stiff_spring_too() {
    let k = [1.0, 0.8, 0.0, -0.8, 2.0, 0.0, 0.0, 0.0, 1e12];
    let mass = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let found = made(3, &mass, &[0.0; 9], &k);
    let most = found.iter().map(Mode::growth).fold(f64::MIN, f64::max);
    let im = (0.64_f64 - 0.25).sqrt();
    let size = (2.25 + im * im).sqrt();
    let wanted = ((size - 1.5) / 2.0).sqrt();
    assert!((most - wanted).abs() < 1e-6 * wanted, "{found:?}");
}

#[test]
fn damping_between_slow_modes_counts_beside_a_light_link_in_tar() {
    // Two equal masses on equal springs, a weak damper between the second and the wall and a weaker one between both; a milligram
    // beside them is damped a hundred million times as much for its mass.
    let (k, far, joint) = (100.0, 2e-3, 4e-5);
    let mass = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1e-6];
    let damping = [
        joint,
        -joint,
        0.0,
        -joint,
        far + joint,
        0.0,
        0.0,
        0.0,
        100.0,
    ];
    let stiffness = [k, 0.0, 0.0, 0.0, k, 0.0, 0.0, 0.0, 1.0];
    let found = made(3, &mass, &damping, &stiffness);
    // Both swing alike but for their damping, along its own axes: s^2 + c s + k = 0 with its eigenvalues c.
    let (mean, apart) = (joint + far / 2.0, (far * far / 4.0 + joint * joint).sqrt());
    let mut growth: Vec<f64> = (found.iter())
        .filter(|m| m.damped_angular_frequency() > 1.0)
        .map(Mode::growth)
        .collect();
    growth.sort_by(f64::total_cmp);
    let wanted = [-(mean + apart) / 2.0, -(mean - apart) / 2.0];
    assert_eq!(growth.len(), 2, "{found:?}");
    for (found, wanted) in growth.iter().zip(wanted) {
        assert!(
            (found - wanted).abs() < 1e-4 * wanted.abs(),
            "{found:e}, not {wanted:e}"
        );
    }
}
