//! Circuits, branches, order and transmission against linkages turned step by step.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use std::f64::consts::{PI, TAU};

use crate::support::{RandomFourBar, between, place};
use kempe_number::{Random, math};
use kempe_synthesis::{
    C, Driver, Dyad, FourBar, Grashof, InvertedSliderCrank, Line, Linkage, Pose, SliderCrank,
    Turning, dyads, pairs, passage,
};

/// Steps of a turn.
const STEPS: usize = 2880;

/// A driven linkage by brute force: whether it closes at an angle, and its poses on both branches.
trait Turned {
    fn driver(&self) -> Driver {
        Driver::First
    }
    fn poses(&self, angle: f64) -> Option<[Pose; 2]>;
    fn linkage(&self) -> Linkage;
}

fn link(lengths: [C; 2]) -> f64 {
    (lengths[1] - lengths[0]).norm()
}

/// The pose that brings two points of a body to two places.
fn carried(points: [C; 2], places: [C; 2]) -> Pose {
    let turn = (places[1] - places[0]) * (points[1] - points[0]).recip();
    Pose {
        origin: places[0] - turn * points[0],
        angle: turn.arg(),
    }
}

/// The left and the right meeting point of two circles, seen from the first centre.
fn circles(a: C, r: f64, b: C, s: f64) -> Option<[C; 2]> {
    let (to, d) = (b - a, (b - a).norm());
    let along = (d * d + r * r - s * s) / (2.0 * d);
    let square = r * r - along * along;
    (square >= 0.0).then(|| {
        let unit = to.scale(1.0 / d);
        [1.0, -1.0].map(|side| a + unit * C::new(along, side * square.sqrt()))
    })
}

impl Turned for FourBar {
    fn poses(&self, angle: f64) -> Option<[Pose; 2]> {
        let frame = self.fixed[1] - self.fixed[0];
        let a = self.fixed[0] + C::from_polar(self.lengths[0], angle + frame.arg());
        let meet = circles(a, link(self.moving), self.fixed[1], self.lengths[1])?;
        Some(meet.map(|b| carried(self.moving, [a, b])))
    }
    fn linkage(&self) -> Linkage {
        Linkage::FourBar(*self)
    }
}

impl Turned for SliderCrank {
    fn poses(&self, angle: f64) -> Option<[Pose; 2]> {
        let u = self.guide.direction;
        let a = self.fixed + u * C::from_polar(self.crank, angle);
        let h = self.guide.distance(a);
        let square = self.dimensions()[1] * self.dimensions()[1] - h * h;
        (square >= 0.0).then(|| {
            [1.0, -1.0].map(|side| {
                let b = a - C::i() * u * h + u * (side * square.sqrt());
                carried(self.moving, [a, b])
            })
        })
    }
    fn linkage(&self) -> Linkage {
        Linkage::SliderCrank(*self)
    }
}

impl Turned for InvertedSliderCrank {
    fn poses(&self, angle: f64) -> Option<[Pose; 2]> {
        let frame = self.fixed[1] - self.fixed[0];
        let a = self.fixed[0] + C::from_polar(self.crank, angle + frame.arg());
        // The point of the guide that is in the pivot, seen from the crank's end.
        let foot = self.guide.point
            + self.guide.direction * {
                let side = self.moving - self.guide.point;
                side.re * self.guide.direction.re + side.im * self.guide.direction.im
            };
        let (h, f) = ((foot - self.moving).norm(), (self.fixed[1] - a).norm());
        let square = f * f - h * h;
        (square >= 0.0).then(|| {
            [1.0, -1.0].map(|side| {
                let on = foot + self.guide.direction * (side * square.sqrt());
                carried([self.moving, on], [a, self.fixed[1]])
            })
        })
    }
    fn linkage(&self) -> Linkage {
        Linkage::InvertedSliderCrank(*self)
    }
}

/// The same linkages driven at the slider: by an "angle" that stands for its place, and at the guide.
struct AtSlider(SliderCrank);

impl Turned for AtSlider {
    fn driver(&self) -> Driver {
        Driver::Second
    }
    fn poses(&self, angle: f64) -> Option<[Pose; 2]> {
        let s = &self.0;
        let [a, b, _] = s.dimensions();
        let reach = 1.1 * (a + b);
        // Half a turn of steps lies beyond all reach, so that runs end.
        let along = reach * (2.0 * angle / std::f64::consts::PI - 1.0);
        let foot = s.fixed - C::i() * s.guide.direction * s.guide.distance(s.fixed);
        let slider = foot + s.guide.direction * along;
        let meet = circles(s.fixed, a, slider, b)?;
        Some(meet.map(|end| carried(s.moving, [end, slider])))
    }
    fn linkage(&self) -> Linkage {
        Linkage::SliderCrank(self.0)
    }
}

struct AtGuide(InvertedSliderCrank);

impl Turned for AtGuide {
    fn driver(&self) -> Driver {
        Driver::Second
    }
    fn poses(&self, angle: f64) -> Option<[Pose; 2]> {
        let s = &self.0;
        let u = C::from_polar(1.0, angle);
        // The crank's end stays this far beside the guide's parallel through the pivot: on a line across the crank's circle.
        let beside = s.guide.distance(s.moving);
        let middle = s.fixed[1] + C::i() * u * beside;
        let to = s.fixed[0] - middle;
        let along = u.re * to.re + u.im * to.im;
        let off = to.norm() * to.norm() - along * along;
        let square = s.crank * s.crank - off;
        (square >= 0.0).then(|| {
            [1.0, -1.0].map(|side| {
                let end = middle + u * (along + side * square.sqrt());
                let turn = u * s.guide.direction.conj();
                Pose {
                    origin: end - turn * s.moving,
                    angle: turn.arg(),
                }
            })
        })
    }
    fn linkage(&self) -> Linkage {
        Linkage::InvertedSliderCrank(self.0)
    }
}

/// Where the runs of steps that close begin and how long they are; one of all steps where all close.
fn runs(closes: &[bool]) -> Vec<(usize, usize)> {
    if closes.iter().all(|c| *c) {
        return vec![(0, STEPS)];
    }
    let mut found = Vec::new();
    for k in 0..STEPS {
        if closes[k] && !closes[(k + STEPS - 1) % STEPS] {
            let length = (0..STEPS).take_while(|i| closes[(k + i) % STEPS]).count();
            found.push((k, length));
        }
    }
    found
}

/// Holds a linkage's passage through random poses of it against the runs.
fn check(turned: &dyn Turned, random: &mut Random) -> bool {
    let closes: Vec<bool> = (0..STEPS)
        .map(|k| turned.poses(TAU * k as f64 / STEPS as f64).is_some())
        .collect();
    let runs = runs(&closes);
    let count = 2 + (random.uniform() * 4.0) as usize;
    let mut stations: Vec<(usize, f64, usize, f64, Pose)> = Vec::new();
    for _ in 0..400 {
        if stations.len() == count {
            break;
        }
        let angle = random.uniform() * TAU;
        let k = (angle / TAU * STEPS as f64) as usize % STEPS;
        let Some(poses) = turned.poses(angle) else {
            continue;
        };
        // Which run, a few steps from its ends.
        let Some((run, at, length)) = runs.iter().enumerate().find_map(|(run, (begin, length))| {
            let at = (k + STEPS - begin) % STEPS;
            (at < *length).then_some((run, at, *length))
        }) else {
            continue;
        };
        let full = length == STEPS;
        if !full && (at < 3 || at + 3 >= length) {
            continue;
        }
        let branch = usize::from(random.uniform() < 0.5);
        // Place round the circuit.
        let (circuit, around) = if full {
            (branch, angle / TAU)
        } else {
            let part = at as f64 / length as f64 + 1e-6 * random.uniform();
            (
                run,
                if branch == 0 {
                    0.5 * part
                } else {
                    1.0 - 0.5 * part
                },
            )
        };
        stations.push((circuit, around, branch, angle, poses[branch]));
    }
    if stations.len() < count {
        return false;
    }
    let poses: Vec<Pose> = stations.iter().map(|s| s.4).collect();
    let known = passage(&turned.linkage(), &poses, turned.driver()).unwrap();
    let one_circuit = stations.iter().all(|s| s.0 == stations[0].0);
    assert_eq!(known.one_circuit, one_circuit, "circuit");
    let one_branch = stations.iter().all(|s| s.2 == stations[0].2);
    assert_eq!(known.one_branch, one_branch, "branch");
    assert_eq!(known.crank, closes.iter().all(|c| *c), "crank");
    if one_circuit {
        let mut sorted: Vec<usize> = (0..count).collect();
        sorted.sort_by(|i, j| stations[*i].1.total_cmp(&stations[*j].1));
        let zero = sorted.iter().position(|k| *k == 0).unwrap();
        let round: Vec<usize> = (0..count).map(|k| sorted[(zero + k) % count]).collect();
        let forward = round.iter().copied().eq(0..count);
        let backward = round[1..].iter().copied().eq((1..count).rev());
        let close = (0..count).any(|k| {
            let apart = stations[sorted[(k + 1) % count]].1 - stations[sorted[k]].1;
            (apart - apart.round()).abs() < 2e-3
        });
        if !close {
            assert_eq!(known.in_order, forward || backward, "order {stations:?}");
        }
    }
    true
}

#[test]
fn passages_agree_with_linkages_turned_step_by_step() {
    let mut random = Random(41);
    let mut seen = [0; 5];
    while seen.iter().any(|n| *n < 700) {
        let bar = RandomFourBar::new(&mut random);
        let four_bar = FourBar {
            fixed: bar.fixed,
            moving: bar.moving,
            lengths: bar.lengths,
        };
        let guide = Line::at_angle(place(&mut random, 2.0), between(&mut random, -3.0, 3.0));
        let slider = SliderCrank {
            fixed: bar.fixed[0],
            crank: bar.lengths[0],
            moving: bar.moving,
            guide,
        };
        let inverted = InvertedSliderCrank {
            fixed: bar.fixed,
            crank: bar.lengths[0],
            moving: bar.moving[0],
            guide,
        };
        let (at_slider, at_guide) = (AtSlider(slider), AtGuide(inverted));
        let kinds: [&dyn Turned; 5] = [&four_bar, &slider, &inverted, &at_slider, &at_guide];
        for (kind, count) in kinds.iter().zip(&mut seen) {
            *count += usize::from(check(*kind, &mut random));
        }
    }
}

#[test]
fn a_crank_rocker_of_known_angles() {
    // a = 20, b = 50, c = 40, d = 60.
    let bar = FourBar {
        fixed: [C::zero(), C::new(60.0, 0.0)],
        moving: [C::zero(), C::new(50.0, 0.0)],
        lengths: [20.0, 40.0],
    };
    assert_eq!(bar.grashof(), Grashof::Grashof);
    assert_eq!(bar.turning(0.3), Turning::Crank);
    let [low, high] = bar.transmission_range(0.0, TAU).map(f64::to_degrees);
    assert!((low - 51.317812546511).abs() < 1e-10 && (high - 125.099632195394).abs() < 1e-10);
    // The rocker swings between 180 less these angles, seen from its own pivot.
    let Turning::Rocker { middle, half } = bar.exchanged().turning(-1.0) else {
        panic!()
    };
    let ends = [middle - half, middle + half].map(|a| 180.0 + a.to_degrees());
    assert!((ends[0] - 93.583321698472).abs() < 1e-10, "{ends:?}");
    assert!((ends[1] - 153.615670250592).abs() < 1e-10, "{ends:?}");
    assert!((bar.link_ratio() - 3.0).abs() < 1e-15);
    // Poses by the crank's angle, C above: the coupler's angle of the table.
    for (first, coupler) in [
        (60.0, 26.52779262819),
        (90.0, 20.78195158351),
        (300.0, 64.74100332993_f64),
    ] {
        let pose = bar.pose(f64::to_radians(first), 1).unwrap();
        assert!((pose.angle.to_degrees() - coupler).abs() < 1e-10);
        assert!(
            (math::within_half_a_turn(bar.first_angle(&pose) - f64::to_radians(first))).abs()
                < 1e-14
        );
        assert_eq!(bar.branch(&pose), 1);
    }
}

#[test]
fn the_transmission_range_holds_the_extremes_of_dense_samples() {
    let mut random = Random(43);
    for _ in 0..300 {
        let bar = RandomFourBar::new(&mut random);
        let bar = FourBar {
            fixed: bar.fixed,
            moving: bar.moving,
            lengths: bar.lengths,
        };
        let (from, by) = (
            between(&mut random, -6.0, 6.0),
            between(&mut random, -6.0, 6.0),
        );
        let [low, high] = bar.transmission_range(from, by);
        let samples = (0..=2000).map(|k| bar.transmission_angle(from + by * k as f64 / 2000.0));
        let (least, most) = samples.fold((PI, 0.0_f64), |(l, m), x| (l.min(x), m.max(x)));
        assert!(low <= least + 1e-12 && high >= most - 1e-12);
        assert!(least - low < 1e-2 && high - most < 1e-2);
    }
}

#[test]
fn the_linkage_whose_poses_are_given_is_a_clean_pair() {
    let mut random = Random(44);
    let mut seen = 0;
    while seen < 300 {
        let bar = RandomFourBar::new(&mut random);
        let geometry = FourBar {
            fixed: bar.fixed,
            moving: bar.moving,
            lengths: bar.lengths,
        };
        if geometry.turning(0.0) != Turning::Crank {
            continue;
        }
        let branch = if random.uniform() < 0.5 { 1 } else { -1 };
        let start = between(&mut random, -3.0, 3.0);
        let angles: Vec<f64> = (0..5).map(|k| start + k as f64 * 0.9).collect();
        let poses: Vec<Pose> = angles
            .iter()
            .filter_map(|a| geometry.pose(*a, branch))
            .collect();
        let Ok(found) = dyads(&poses, &[]) else {
            continue;
        };
        let list: Vec<Dyad> = found.iter().map(|d| d.dyad).collect();
        let all = pairs(&list);
        assert_eq!(all.len(), list.len() * (list.len() - 1) / 2);
        let clean = all.iter().any(|linkage| match linkage {
            Linkage::FourBar(b) => {
                let near = |k: usize, l: usize| (b.fixed[k] - bar.fixed[l]).norm() < 1e-6;
                let driver = if near(0, 0) && near(1, 1) {
                    Driver::First
                } else if near(0, 1) && near(1, 0) {
                    Driver::Second
                } else {
                    return false;
                };
                let known = passage(linkage, &poses, driver).unwrap();
                let swept = known.driver[4] - known.driver[0];
                known.is_clean() && known.crank && (swept.abs() - 3.6).abs() < 1e-7
            }
            _ => false,
        });
        assert!(clean, "{bar:?}");
        seen += 1;
    }
}

/// The angle between two vectors, rad, 0 to pi.
fn angle_of(a: C, b: C) -> f64 {
    math::acos(((a.re * b.re + a.im * b.im) / (a.norm() * b.norm())).clamp(-1.0, 1.0))
}

#[test]
fn transmission_angles_of_sliders_are_those_seen_in_their_poses() {
    let mut random = Random(45);
    let mut seen = 0;
    while seen < 500 {
        let bar = RandomFourBar::new(&mut random);
        let guide = Line::at_angle(place(&mut random, 2.0), between(&mut random, -3.0, 3.0));
        let slider = SliderCrank {
            fixed: bar.fixed[0],
            crank: bar.lengths[0],
            moving: bar.moving,
            guide,
        };
        let inverted = InvertedSliderCrank {
            fixed: bar.fixed,
            crank: bar.lengths[0],
            moving: bar.moving[0],
            guide,
        };
        let angle = between(&mut random, -3.0, 3.0);
        let (Some(at_crank), Some(at_slider), Some(at_guide)) = (
            slider.poses(angle),
            AtSlider(slider).poses(angle.abs()),
            AtGuide(inverted).poses(angle),
        ) else {
            continue;
        };
        seen += 1;
        let normal = C::i() * guide.direction;
        for pose in at_crank.iter().chain(&at_slider) {
            let [a, b] = slider.moving.map(|m| pose.place(m));
            let angle = slider.crank_angle(pose);
            assert!((slider.transmission_angle(angle) - angle_of(b - a, normal)).abs() < 1e-7);
            let place = slider.slider_place(pose);
            let known = angle_of(b - a, slider.fixed - a);
            assert!((slider.slider_transmission_angle(place) - known).abs() < 1e-7);
            // Within the travel, whose ends are where crank and coupler are in line.
            let [middle, half] = slider.travel(place);
            assert!((place - middle).abs() <= half + 1e-9);
        }
        for pose in &at_guide {
            let crank = pose.place(inverted.moving) - inverted.fixed[0];
            let normal = C::i() * pose.turn() * inverted.guide.direction;
            let angle = inverted.guide_angle(pose);
            let known = angle_of(crank, normal);
            let told = inverted.guide_transmission_angle(angle);
            assert!((told - known).abs() < 1e-7 || (told - (PI - known)).abs() < 1e-7);
        }
        let (from, by) = (
            between(&mut random, -3.0, 3.0),
            between(&mut random, -3.0, 3.0),
        );
        type Angle<'a> = &'a dyn Fn(f64) -> f64;
        let kinds: [(Angle, [f64; 2]); 3] = [
            (
                &|x| slider.transmission_angle(x),
                slider.transmission_range(from, by),
            ),
            (
                &|x| slider.slider_transmission_angle(x),
                slider.slider_transmission_range(from, by),
            ),
            (
                &|x| inverted.guide_transmission_angle(x),
                inverted.guide_transmission_range(from, by),
            ),
        ];
        for (angle, [low, high]) in kinds {
            let samples = (0..=2000).map(|k| angle(from + by * f64::from(k) / 2000.0));
            let (least, most) = samples.fold((PI, 0.0_f64), |(l, m), x| (l.min(x), m.max(x)));
            assert!(low <= least + 1e-12 && high >= most - 1e-12);
            assert!(
                least - low < 2e-2 && high - most < 2e-2,
                "{least} {low} {high} {most}"
            );
        }
    }
}
