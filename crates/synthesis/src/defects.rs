//! What a linkage that is right in every pose may lack between them: one circuit, one branch, the poses in order.

use std::f64::consts::TAU;

use kempe_number::math;

use crate::four_bar::{Driver, FourBar, Grashof, Turning, within_a_turn};
use crate::linkage::Linkage;
use crate::pose::Pose;
use crate::slider_crank::{InvertedSliderCrank, SliderCrank};

/// How a linkage passes through its poses, driven at one of its links.
#[derive(Clone, Debug, PartialEq)]
pub struct Passage {
    /// Whether all poses are on one circuit: reached without taking the linkage apart.
    pub one_circuit: bool,
    /// Whether all poses are on one branch: reached by the driver without passing a dead centre.
    pub one_branch: bool,
    /// Whether the driver, always turning in one sense (a rocker to and fro, round its circuit), meets the poses in the order given, or in
    /// the reverse one.
    pub in_order: bool,
    /// Whether the driver turns fully.
    pub crank: bool,
    /// The driver's angles at the poses, rad, each on from the one before in the sense of the order (of a slider: the angle of the crank
    /// beside it).
    pub driver_angles: Vec<f64>,
    /// The smallest and the largest transmission angle, rad from 0 to pi, over all the motion, and from the first to the last pose.
    /// `None` where the driver's link carries the slider's guide.
    pub transmission: Option<[[f64; 2]; 2]>,
}

impl Passage {
    /// No defect.
    pub fn is_clean(&self) -> bool {
        self.one_circuit && self.one_branch && self.in_order
    }
}

/// One pose in a passage.
struct Station {
    circuit: i8,
    branch: i8,
    /// The driver's angle, rad.
    angle: f64,
    turning: Turning,
}

/// How a linkage passes through poses; `None` of those with two sliders and of poses fewer than two.
pub fn passage(linkage: &Linkage, poses: &[Pose], driver: Driver) -> Option<Passage> {
    if poses.len() < 2 {
        return None;
    }
    match linkage {
        Linkage::FourBar(bar) => Some(of_four_bar(&bar.driven_first(driver), poses)),
        Linkage::SliderCrank(slider) => match driver {
            Driver::First => Some(of_slider_crank(slider, poses)),
            Driver::Second => None,
        },
        Linkage::InvertedSliderCrank(slider) => match driver {
            Driver::First => Some(of_inverted(slider, poses)),
            Driver::Second => None,
        },
        Linkage::TwoSliders(..) => None,
    }
}

fn of_four_bar(bar: &FourBar, poses: &[Pose]) -> Passage {
    let stations: Vec<Station> = (poses.iter())
        .map(|pose| {
            let angle = bar.first_angle(pose);
            Station {
                circuit: bar.circuit(pose),
                branch: bar.branch(pose),
                angle,
                turning: bar.turning(angle),
            }
        })
        .collect();
    let mut passage = through(&stations);
    let over_all = match stations[0].turning {
        Turning::Crank => bar.transmission_range(0.0, TAU),
        Turning::Rocker { middle, half } => bar.transmission_range(middle - half, 2.0 * half),
    };
    let between = swept(&passage.driver_angles, |from, by| {
        bar.transmission_range(from, by)
    });
    passage.transmission = Some([over_all, between]);
    // At a change point the circuits meet.
    passage.one_circuit |= bar.grashof() != Grashof::Grashof;
    passage
}

fn of_slider_crank(slider: &SliderCrank, poses: &[Pose]) -> Passage {
    let stations: Vec<Station> = (poses.iter())
        .map(|pose| {
            let angle = slider.crank_angle(pose);
            Station {
                circuit: slider.circuit(pose),
                branch: slider.branch(pose),
                angle,
                turning: slider.turning(angle),
            }
        })
        .collect();
    let mut passage = through(&stations);
    let over_all = match stations[0].turning {
        Turning::Crank => slider.transmission_range(0.0, TAU),
        Turning::Rocker { middle, half } => slider.transmission_range(middle - half, 2.0 * half),
    };
    let between = swept(&passage.driver_angles, |from, by| {
        slider.transmission_range(from, by)
    });
    passage.transmission = Some([over_all, between]);
    passage
}

fn of_inverted(slider: &InvertedSliderCrank, poses: &[Pose]) -> Passage {
    let stations: Vec<Station> = (poses.iter())
        .map(|pose| Station {
            circuit: slider.circuit(pose),
            branch: slider.branch(pose),
            angle: slider.crank_angle(pose),
            turning: slider.turning(),
        })
        .collect();
    through(&stations)
}

/// The smallest and the largest of what ranges from each of the driver's angles to the next hold.
fn swept(angles: &[f64], range: impl Fn(f64, f64) -> [f64; 2]) -> [f64; 2] {
    (angles.windows(2)).fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], pair| {
        let [least, most] = range(pair[0], pair[1] - pair[0]);
        [math::min(low, least), math::max(high, most)]
    })
}

fn through(stations: &[Station]) -> Passage {
    let all_one = |of: fn(&Station) -> i8| {
        let first = of(&stations[0]);
        stations.iter().all(|s| of(s) == first)
    };
    // A place on the closed circuit as an angle: the crank's own, or that whose cosine a rocker follows, there on one branch and back on
    // the other.
    let around: Vec<f64> = (stations.iter())
        .map(|s| match s.turning {
            Turning::Crank => s.angle,
            Turning::Rocker { middle, half } => {
                let part = math::within_half_a_turn(s.angle - middle) / half;
                math::acos(part.clamp(-1.0, 1.0)) * if s.branch < 0 { -1.0 } else { 1.0 }
            }
        })
        .collect();
    let n = around.len();
    let turns = (0..n)
        .map(|k| within_a_turn(around[(k + 1) % n] - around[k]))
        .sum::<f64>()
        / TAU;
    let (forward, backward) = (
        (turns - 1.0).abs() < 0.5,
        (turns - (n - 1) as f64).abs() < 0.5,
    );
    let crank = stations[0].turning == Turning::Crank;
    let mut driver_angles: Vec<f64> = Vec::with_capacity(n);
    for s in stations {
        let angle = match driver_angles.last() {
            None => s.angle,
            Some(last) if !crank || n == 2 => last + math::within_half_a_turn(s.angle - last),
            Some(last) if forward => last + within_a_turn(s.angle - last),
            Some(last) if backward => last - within_a_turn(last - s.angle),
            Some(last) => last + math::within_half_a_turn(s.angle - last),
        };
        driver_angles.push(angle);
    }
    if let Turning::Rocker { middle, .. } = stations[0].turning {
        // Of a rocker within its swing.
        for angle in &mut driver_angles {
            *angle = middle + math::within_half_a_turn(*angle - middle);
        }
    }
    Passage {
        one_circuit: all_one(|s| s.circuit),
        one_branch: all_one(|s| s.branch),
        in_order: forward || backward,
        crank,
        driver_angles,
        transmission: None,
    }
}
