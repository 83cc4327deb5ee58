//! Nearest circles and lines against what is known of shapes, and against a search that knows nothing of them.

use kempe_number::{Random, math};
use kempe_synthesis::{C, NearestCircle, nearest_circle, nearest_line};

fn arc(from: f64, to: f64, count: usize, place: impl Fn(f64) -> C) -> Vec<C> {
    let at = |k: usize| from + (to - from) * k as f64 / (count - 1) as f64;
    (0..count).map(|k| place(at(k))).collect()
}

/// The half width of the ring about a centre that holds all places.
fn ring(places: &[C], centre: C) -> f64 {
    let far = places.iter().map(|p| (*p - centre).norm());
    let (low, high) = far.fold((f64::INFINITY, 0.0_f64), |(l, h), d| (l.min(d), h.max(d)));
    0.5 * (high - low)
}

/// The least ring near a centre by a pattern search that halves its steps.
fn searched(places: &[C], start: C, mut step: f64) -> f64 {
    let (mut centre, mut best) = (start, ring(places, start));
    while step > 1e-9 {
        let around = (0..16)
            .map(|k| centre + C::from_polar(step, f64::from(k) * std::f64::consts::TAU / 16.0));
        let tried = around.map(|c| (ring(places, c), c));
        let Some((width, next)) = tried.min_by(|a, b| a.0.total_cmp(&b.0)) else {
            break;
        };
        if width < best {
            (best, centre) = (width, next);
        } else {
            step *= 0.5;
        }
    }
    best
}

fn assert_touches(places: &[C], it: &NearestCircle) {
    let off = |p: C| (p - it.centre).norm() - it.radius;
    for k in it.touched {
        let miss = off(places[k]).abs() - it.deviation;
        assert!(
            miss.abs() < 1e-9 * (it.radius + it.deviation),
            "{k}: {miss:e} of {it:?}"
        );
    }
    let outside = it.touched.iter().filter(|k| off(places[**k]) > 0.0).count();
    assert_eq!(outside, 2, "{it:?}");
    assert!((ring(places, it.centre) - it.deviation).abs() < 1e-9 * it.radius);
}

#[test]
fn a_circle_is_its_own_nearest() {
    let mut random = Random(1);
    for _ in 0..200 {
        let centre = C::new(random.uniform() - 0.5, random.uniform() - 0.5).scale(1000.0);
        let radius = math::exp(9.0 * (random.uniform() - 0.5));
        let from = 6.0 * random.uniform();
        let places = arc(from, from + 0.3 + 5.0 * random.uniform(), 40, |t| {
            centre + C::from_polar(radius, t)
        });
        let it = nearest_circle(&places).expect("a circle");
        assert!(it.deviation < 1e-11 * (1000.0 + radius), "{it:?}");
        assert!(
            (it.centre - centre).norm() < 1e-7 * (1000.0 + radius),
            "{it:?}"
        );
    }
}

#[test]
fn rings_are_as_narrow_as_a_blind_search_finds_them() {
    let mut random = Random(2);
    for case in 0..100 {
        let waves: Vec<[f64; 2]> = (2..6)
            .map(|_| [random.uniform(), random.uniform()])
            .collect();
        let size = 0.05 * random.uniform();
        let places = arc(0.0, 1.0 + 2.0 * random.uniform(), 61, |t| {
            let off = waves
                .iter()
                .enumerate()
                .map(|(k, [a, phase])| size * a * math::sin((k + 2) as f64 * t + 6.0 * phase));
            C::from_polar(1.0 + off.sum::<f64>(), t)
        });
        let it = nearest_circle(&places).expect("a circle");
        assert_touches(&places, &it);
        let blind = searched(&places, it.centre, 0.05);
        assert!(
            it.deviation <= blind * (1.0 + 1e-6),
            "{case}: {} and {blind}",
            it.deviation
        );
        let from_elsewhere = searched(&places, C::new(0.0, 0.0), 0.3);
        assert!(
            it.deviation <= from_elsewhere * (1.0 + 1e-6),
            "{case}: {} and {from_elsewhere}",
            it.deviation
        );
    }
}

#[test]
fn rings_move_and_grow_with_their_places() {
    let places = arc(0.0, 2.0, 50, |t| C::new(t, 0.3 * t * t + 0.05 * t * t * t));
    let own = nearest_circle(&places).expect("a circle");
    let own_line = nearest_line(&places).expect("a line");
    for scale in [1e-6, 1.0, 1e6] {
        for turn in [0.0, 1.0, 2.5] {
            for mirrored in [false, true] {
                let shift = C::new(700.0, -300.0).scale(scale);
                let moved = |p: C| {
                    let p = if mirrored { p.conj() } else { p };
                    p * C::from_polar(scale, turn) + shift
                };
                let there: Vec<C> = places.iter().map(|p| moved(*p)).collect();
                let it = nearest_circle(&there).expect("a circle");
                assert!(
                    (it.deviation / scale - own.deviation).abs() < 1e-9,
                    "{it:?}"
                );
                assert!((it.centre - moved(own.centre)).norm() < 1e-7 * scale);
                assert_eq!(it.touched, own.touched);
                let it = nearest_line(&there).expect("a line");
                assert!(
                    (it.deviation / scale - own_line.deviation).abs() < 1e-9,
                    "{it:?}"
                );
            }
        }
    }
}

#[test]
fn flat_arcs_have_far_centres_until_they_are_lines() {
    for radius in [1e2, 1e4] {
        let places = arc(-0.5 / radius, 0.5 / radius, 41, |t| {
            C::from_polar(radius, t) - C::new(radius, 0.0)
        });
        let it = nearest_circle(&places).expect("a circle");
        assert!((it.radius / radius - 1.0).abs() < 1e-5, "{it:?}");
        // The places themselves are rounded as numbers of the radius's size.
        assert!(it.deviation < 1e-15 * radius);
    }
    let straight = arc(0.0, 1.0, 41, |t| C::new(t, 2.0 * t));
    assert!(nearest_circle(&straight).is_none());
    let line = nearest_line(&straight).expect("a line");
    assert!(line.deviation < 1e-15);
    assert!((line.direction - C::new(1.0, 2.0).scale(1.0 / 5.0_f64.sqrt())).norm() < 1e-14);
}

#[test]
fn the_line_of_a_parabola_is_chebyshevs() {
    // Of t^2 over -1 to 1 the nearest line is y = 1/2, off by 1/2 at both ends and in the middle: as long as a strip across is no narrower.
    let places = arc(-1.0, 1.0, 101, |t| C::new(t, 0.1 * t * t));
    let it = nearest_line(&places).expect("a line");
    assert!((it.deviation - 0.05).abs() < 1e-15, "{it:?}");
    assert!((it.point.im - 0.05).abs() < 1e-15);
    let mut touched = it.touched;
    touched.sort_unstable();
    assert_eq!(touched, [0, 50, 100]);
}

#[test]
fn nothing_is_near_to_nothing() {
    let one = C::new(1.0, 2.0);
    assert!(nearest_circle(&[one; 3]).is_none());
    assert!(nearest_circle(&[one; 9]).is_none());
    assert!(nearest_line(&[one; 9]).is_none());
    assert!(nearest_line(&[]).is_none());
    let wild = [
        one,
        C::new(f64::NAN, 0.0),
        C::new(2.0, 3.0),
        C::new(4.0, 4.0),
    ];
    assert!(nearest_circle(&wild).is_none() && nearest_line(&wild).is_none());
    // Places to and fro, and corners.
    let to_and_fro = arc(0.0, 2.0, 30, |t| {
        C::from_polar(1.0, if t > 1.0 { 2.0 - t } else { t })
    });
    assert!(nearest_circle(&to_and_fro).is_some_and(|it| it.deviation < 1e-12));
    let square = [
        C::new(0.0, 0.0),
        C::new(1.0, 0.0),
        C::new(1.0, 1.0),
        C::new(0.0, 1.0),
    ];
    assert!(nearest_circle(&square).is_some_and(|it| it.deviation < 1e-12));
}
