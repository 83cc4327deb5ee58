//! Levers, sliders and slots that rest, against the same turned place by place, and against others beside them.

use std::f64::consts::{PI, TAU};

use kempe_number::{Random, math};
use kempe_synthesis::{C, DwellLever, Rest, Stretch, Way, nearest_circle, nearest_line, stretches};

/// The coupler point of a crank-rocker by the crank's angle.
struct Bar {
    ground: f64,
    crank: f64,
    coupler: f64,
    rocker: f64,
    point: C,
}

impl Bar {
    /// That of the gallery's dwell six-bar.
    fn symmetric() -> Self {
        let arm = C::new(80.0, 126.886).norm();
        let (b, c, p) = (
            C::new(-40.0, 0.0),
            C::new(40.0, 126.886),
            C::new(182.844, 172.661),
        );
        Self {
            ground: 120.0,
            crank: 40.0,
            coupler: arm,
            rocker: arm,
            point: (p - b) * (c - b).conj().scale(1.0 / arm),
        }
    }

    /// Hoeken's.
    fn straight() -> Self {
        Self {
            ground: 2.0,
            crank: 1.0,
            coupler: 2.5,
            rocker: 2.5,
            point: C::new(5.0, 0.0),
        }
    }

    fn random(random: &mut Random) -> Self {
        loop {
            let mut length = |low: f64, high: f64| low + (high - low) * random.uniform();
            let it = Self {
                crank: length(0.5, 1.5),
                ground: length(2.0, 4.0),
                coupler: length(2.0, 4.0),
                rocker: length(2.0, 4.0),
                point: C::new(length(-1.0, 5.0), length(-3.0, 3.0)),
            };
            let others = [it.ground, it.coupler, it.rocker];
            let longest = others.iter().fold(0.0_f64, |m, x| m.max(*x));
            if it.crank + 2.0 * longest < 0.97 * others.iter().sum::<f64>() {
                return it;
            }
        }
    }

    fn place(&self, angle: f64) -> C {
        let b = C::from_polar(self.crank, angle);
        let to_d = C::new(self.ground, 0.0) - b;
        let far = to_d.norm();
        let along =
            (far * far + self.coupler * self.coupler - self.rocker * self.rocker) / (2.0 * far);
        let aside = (self.coupler * self.coupler - along * along).sqrt();
        let c = C::new(along, aside) * to_d.scale(1.0 / far);
        b + self.point * c.scale(1.0 / self.coupler)
    }

    fn way(&self, steps: usize) -> Vec<C> {
        (0..=steps)
            .map(|k| self.place(TAU * k as f64 / steps as f64))
            .collect()
    }
}

fn circles(bar: &Bar, length: f64) -> Vec<Stretch<(C, f64)>> {
    let mut place = |at: f64| Some(bar.place(at));
    let mut way = Way {
        place: &mut place,
        range: [0.0, TAU],
        closed: true,
    };
    let nearest = |places: &[C]| {
        let it = nearest_circle(places)?;
        Some((it.deviation, (it.centre, it.radius)))
    };
    stretches(&mut way, length, 12, &nearest).expect("a way")
}

fn size(way: &[C]) -> f64 {
    way.iter().fold(0.0, |m, p| m.max((*p - way[0]).norm()))
}

/// A box about a way.
fn around(way: &[C]) -> [C; 2] {
    let far = 2.0 * size(way);
    [way[0] - C::new(far, far), way[0] + C::new(far, far)]
}

/// The swing and the least angle between rod and lever, the rod's end followed from place to place as the nearer meeting point of two circles.
fn followed(way: &[C], pivot: C, [length, rod]: [f64; 2], start: C) -> Option<[f64; 2]> {
    let (mut end, mut turned) = (start, 0.0_f64);
    let (mut low, mut high, mut least) = (0.0_f64, 0.0_f64, PI);
    for place in way {
        let to = *place - pivot;
        let far = to.norm();
        let along = (length * length + far * far - rod * rod) / (2.0 * far);
        let square = length * length - along * along;
        if square < 0.0 {
            return None;
        }
        let both = [1.0, -1.0]
            .map(|side| pivot + C::new(along, side * square.sqrt()) * to.scale(1.0 / far));
        let next = if (both[0] - end).norm() < (both[1] - end).norm() {
            both[0]
        } else {
            both[1]
        };
        let step = (next - pivot) * (end - pivot).conj();
        turned += math::atan2(step.im, step.re);
        (low, high) = (low.min(turned), high.max(turned));
        let corner = (pivot - next) * (*place - next).conj();
        let between = math::atan2(corner.im, corner.re).abs();
        least = least.min(between.min(PI - between));
        end = next;
    }
    Some([high - low, least])
}

#[test]
fn the_gallery_s_dwell_is_found() {
    let bar = Bar::symmetric();
    let all = circles(&bar, 135.0_f64.to_radians());
    let best = &all[0];
    assert!((best.from.to_degrees() - 112.5).abs() < 0.05, "{best:?}");
    // Its page says 0.1 mm about (230.86, 304.54).
    assert!(best.deviation < 0.1, "{best:?}");
    assert!(
        (best.near.0 - C::new(230.86, 304.54)).norm() < 0.5,
        "{best:?}"
    );
    assert!(
        all.windows(2)
            .all(|pair| pair[0].deviation <= pair[1].deviation)
    );
}

#[test]
fn stretches_are_the_best_of_all_starts() {
    let mut random = Random(11);
    for _ in 0..20 {
        let bar = Bar::random(&mut random);
        let length = 0.6 + 1.8 * random.uniform();
        let found = circles(&bar, length);
        let error = |from: f64| {
            let at = |k: usize| bar.place(from + length * k as f64 / 150.0);
            let places: Vec<C> = (0..=150).map(at).collect();
            nearest_circle(&places).map_or(f64::INFINITY, |it| it.deviation)
        };
        let blind = (0..720)
            .map(|k| error(TAU * f64::from(k) / 720.0))
            .fold(f64::INFINITY, f64::min);
        let best = found.first().map_or(f64::INFINITY, |it| it.deviation);
        // Samples of the arc are a little less than the arc.
        assert!(best <= 1.01 * blind + 1e-9, "{best:e} and {blind:e}");
        for stretch in &found {
            let again = error(stretch.from);
            assert!(
                (again / stretch.deviation - 1.0).abs() < 0.02 || stretch.deviation < 1e-9,
                "{again} at {stretch:?} of {}",
                size(&bar.way(100))
            );
        }
    }
}

fn assert_moves(bar: &Bar, it: &DwellLever, rod: f64, [centre, middle]: [C; 2]) {
    let way = bar.way(2880);
    // From where the rod's end is known: the middle of the rest, wherever that is on the way.
    let nearest = (0..way.len()).min_by(|a, b| {
        (way[*a] - middle)
            .norm()
            .total_cmp(&(way[*b] - middle).norm())
    });
    let mut turned = way[..2880].to_vec();
    turned.rotate_left(nearest.unwrap_or(0) % 2880);
    turned.push(turned[0]);
    let [swing, least] =
        followed(&turned, it.pivot, [it.length, rod], centre).expect("a lever that moves");
    assert!(
        (swing - it.swing).abs() < 1e-3 * swing + 1e-4,
        "{swing} of {it:?}"
    );
    assert!((least - it.transmission).abs() < 2e-3, "{least} of {it:?}");
}

#[test]
fn levers_do_what_is_said_of_them_and_no_neighbour_does_better() {
    let mut random = Random(5);
    let mut levers = 0;
    for case in 0..24 {
        let bar = Bar::random(&mut random);
        let way = bar.way(1440);
        let length = 0.8 + random.uniform();
        let wanted = (case % 2 == 0).then(|| 0.3 + 0.4 * random.uniform());
        for stretch in circles(&bar, length).iter().take(2) {
            let (centre, rod) = stretch.near;
            let middle = bar.place(stretch.from + 0.5 * length);
            let rest = Rest { way: &way, middle };
            for it in rest.levers(centre, rod, around(&way), wanted) {
                if it.transmission < 0.1 {
                    continue;
                }
                levers += 1;
                assert_moves(&bar, &it, rod, [centre, middle]);
                if let Some(wanted) = wanted {
                    assert!((it.swing - wanted).abs() < 1e-9, "{it:?}");
                }
                // A lever a little aside, of the same swing where one is asked for, transmits no better.
                for turn in [-0.02, 0.02] {
                    let aside = centre + (it.pivot - centre) * C::from_polar(1.0, turn);
                    let ends = [0.98, 1.02].map(|part| centre + (aside - centre).scale(part));
                    let [low, high] = around(&way);
                    let inside = |p: &C| {
                        (low.re..=high.re).contains(&p.re) && (low.im..=high.im).contains(&p.im)
                    };
                    if !ends.iter().all(inside) {
                        continue;
                    }
                    for part in 0..=40 {
                        let pivot = ends[0] + (ends[1] - ends[0]).scale(f64::from(part) / 40.0);
                        let lengths = [(pivot - centre).norm(), rod];
                        // From the rest's middle on, once round.
                        let mut on: Vec<C> = (0..=720)
                            .map(|k| {
                                bar.place(stretch.from + 0.5 * length + TAU * f64::from(k) / 720.0)
                            })
                            .collect();
                        on[0] = middle;
                        let Some([swing, least]) = followed(&on, pivot, lengths, centre) else {
                            continue;
                        };
                        let same = wanted.is_none_or(|wanted| (swing - wanted).abs() < 2e-4);
                        assert!(
                            !same || least < it.transmission + 2e-3,
                            "{least} beside {it:?}"
                        );
                    }
                }
            }
        }
    }
    assert!(levers > 20, "{levers}");
}

#[test]
fn sliders_go_as_far_as_asked() {
    let mut random = Random(9);
    let mut sliders = 0;
    for _ in 0..20 {
        let bar = Bar::random(&mut random);
        let way = bar.way(1440);
        for stretch in circles(&bar, 1.2).iter().take(2) {
            let (centre, rod) = stretch.near;
            let middle = bar.place(stretch.from + 0.6);
            let rest = Rest { way: &way, middle };
            let stroke = (0.5 + random.uniform()) * size(&way);
            for (it, wanted) in (rest
                .sliders(centre, rod, Some(stroke))
                .into_iter()
                .map(|it| (it, Some(stroke))))
            .chain(
                rest.sliders(centre, rod, None)
                    .into_iter()
                    .map(|it| (it, None)),
            ) {
                sliders += 1;
                let at = |p: &C| it.place(*p, centre, rod);
                for place in &way {
                    let end = centre + it.direction.scale(at(place));
                    assert!(((end - *place).norm() - rod).abs() < 1e-9 * rod);
                }
                assert!(
                    at(&middle).abs() < 2.0 * stretch.deviation / math::sin(it.transmission) + 1e-9
                );
                if let Some(wanted) = wanted {
                    let (low, high) = way
                        .iter()
                        .map(at)
                        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
                            (l.min(x), h.max(x))
                        });
                    assert!((high - low - wanted).abs() < 1e-3 * wanted, "{it:?}");
                }
            }
        }
    }
    assert!(sliders > 20, "{sliders}");
}

#[test]
fn a_slot_rests_on_hoeken_s_line() {
    let bar = Bar::straight();
    let mut place = |at: f64| Some(bar.place(at));
    let mut way = Way {
        place: &mut place,
        range: [0.0, TAU],
        closed: true,
    };
    let nearest = |places: &[C]| {
        let it = nearest_line(places)?;
        Some((it.deviation, (it.point, it.direction)))
    };
    let all = stretches(&mut way, PI, 12, &nearest).expect("a way");
    let best = &all[0];
    // Known for half a turn of the crank about 180 deg: a line of some four cranks, off by a hundredth of the crank or so.
    assert!((best.from - 0.5 * PI).abs() < 0.4, "{best:?}");
    assert!(best.deviation < 0.02, "{best:?}");
    assert!(best.near.1.im.abs() < 0.01);
    let places = bar.way(1440);
    let rest = Rest {
        way: &places,
        middle: bar.place(best.from + 0.5 * PI),
    };
    let swing = 40.0_f64.to_radians();
    let slots = rest.slots(best.near.0, best.near.1, around(&places), swing);
    assert!(slots.len() >= 2, "{slots:?}");
    for it in slots {
        let angles = places.iter().map(|p| (*p - it.pivot).arg());
        // Seen from beside the way, the angles are on one side of its middle direction.
        let first = (places[0] - it.pivot).arg();
        let all = angles.map(|a| math::within_half_a_turn(a - first));
        let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
            (l.min(x), h.max(x))
        });
        assert!((high - low - swing).abs() < 1e-4, "{it:?}");
        let off = ((it.pivot - best.near.0) * best.near.1.conj()).im;
        assert!(off.abs() < 1e-12);
    }
}

#[test]
fn what_is_senseless_has_no_answer() {
    let bar = Bar::symmetric();
    let way = bar.way(360);
    let rest = Rest {
        way: &way,
        middle: way[0],
    };
    let nowhere = [C::new(0.0, 0.0), C::new(0.0, 0.0)];
    assert!(
        rest.levers(C::new(1e3, 1e3), 5.0, around(&way), None)
            .is_empty()
    );
    assert!(
        rest.levers(C::new(230.0, 304.0), 140.0, nowhere, None)
            .is_empty()
    );
    assert!(
        rest.sliders(C::new(230.0, 304.0), f64::NAN, None)
            .is_empty()
    );
    assert!(
        rest.slots(C::new(f64::NAN, 0.0), C::new(1.0, 0.0), around(&way), 1.0)
            .is_empty()
    );
    let mut place = |_: f64| None;
    let mut way = Way {
        place: &mut place,
        range: [0.0, TAU],
        closed: true,
    };
    assert!(stretches(&mut way, 1.0, 4, &|_| Some((0.0, ()))).is_none());
    let mut place = |at: f64| Some(C::from_polar(1.0, at));
    let mut way = Way {
        place: &mut place,
        range: [0.0, 1.0],
        closed: false,
    };
    for length in [0.0, -1.0, f64::NAN, 1.5] {
        assert!(stretches(&mut way, length, 4, &|_| Some((0.0, ()))).is_none());
    }
    // All of an open way is one stretch of it.
    assert!(stretches(&mut way, 1.0, 4, &|_| Some((0.0, ()))).is_some_and(|all| all.len() == 1));
}
