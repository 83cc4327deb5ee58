//! What a linkage that is right in every pose may lack between them: one circuit, one branch, the poses in order.

use std::f64::consts::TAU;

use kempe_number::math;

use crate::four_bar::{Driver, Turning, within_a_turn};
use crate::linkage::Linkage;
use crate::pose::Pose;

/// How a linkage passes through its poses, driven at one of its links.
#[derive(Clone, Debug, PartialEq)]
pub struct Passage {
    /// Whether all poses are on one circuit: reached without taking the linkage apart.
    pub one_circuit: bool,
    /// Whether all poses are on one branch: reached by the driver without passing a dead centre.
    pub one_branch: bool,
    /// Whether the driver, always turning in one sense (a rocker or slider to and fro, round its circuit), meets the poses in the order
    /// given, or in the reverse one.
    pub in_order: bool,
    /// Whether the driver turns fully.
    pub crank: bool,
    /// Where the driver is at the poses: the angle of a crank, rocker or guide from the line of the fixed pivots (of a slider-crank's from the
    /// guide), rad, of a crank each on from the one before in the sense of the order; a slider's place from where its guide is
    /// nearest to the crank's pivot.
    pub driver: Vec<f64>,
    /// The smallest and the largest transmission angle, rad from 0 to pi, over all the motion, and from the first to the last pose.
    /// `None` where the crank of an inverted slider-crank drives: what it drives has no angle to the crank's push.
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
    /// The driver's angle, rad, or place.
    driver: f64,
    /// How the driver may go from there.
    way: Way,
}

/// How a driver may go.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    Round,
    /// Between two angles: the middle and half of the swing.
    Swing(f64, f64),
    /// Between two places.
    Straight(f64, f64),
}

impl From<Turning> for Way {
    fn from(turning: Turning) -> Self {
        match turning {
            Turning::Crank => Self::Round,
            Turning::Rocker { middle, half } => Self::Swing(middle, half),
        }
    }
}

/// How a linkage passes through poses, driven at its first or its second dyad; `None` of those with two sliders and of poses fewer than two.
pub fn passage(linkage: &Linkage, poses: &[Pose], driver: Driver) -> Option<Passage> {
    if poses.len() < 2 {
        return None;
    }
    let stations = |of: &dyn Fn(&Pose) -> Station| poses.iter().map(of).collect::<Vec<Station>>();
    Some(match (linkage, driver) {
        (Linkage::FourBar(bar), driver) => {
            let bar = bar.driven_first(driver);
            let stations = stations(&|pose| {
                let angle = bar.first_angle(pose);
                Station {
                    circuit: bar.circuit(pose),
                    branch: bar.branch(pose),
                    driver: angle,
                    way: bar.turning(angle).into(),
                }
            });
            through(
                &stations,
                Some(&|from, by| bar.transmission_range(from, by)),
            )
        }
        (Linkage::SliderCrank(slider), Driver::First) => {
            let stations = stations(&|pose| {
                let angle = slider.crank_angle(pose);
                Station {
                    circuit: slider.circuit(pose),
                    branch: slider.branch(pose),
                    driver: angle,
                    way: slider.turning(angle).into(),
                }
            });
            through(
                &stations,
                Some(&|from, by| slider.transmission_range(from, by)),
            )
        }
        (Linkage::SliderCrank(slider), Driver::Second) => {
            let stations = stations(&|pose| {
                let place = slider.slider_place(pose);
                let [middle, half] = slider.travel(place);
                Station {
                    circuit: slider.circuit(pose),
                    branch: slider.slider_branch(pose),
                    driver: place,
                    way: Way::Straight(middle, half),
                }
            });
            through(
                &stations,
                Some(&|from, by| slider.slider_transmission_range(from, by)),
            )
        }
        (Linkage::InvertedSliderCrank(slider), Driver::First) => {
            let stations = stations(&|pose| Station {
                circuit: slider.circuit(pose),
                branch: slider.branch(pose),
                driver: slider.crank_angle(pose),
                way: slider.turning().into(),
            });
            through(&stations, None)
        }
        (Linkage::InvertedSliderCrank(slider), Driver::Second) => {
            let stations = stations(&|pose| {
                let angle = slider.guide_angle(pose);
                Station {
                    circuit: slider.circuit(pose),
                    branch: slider.guide_branch(pose),
                    driver: angle,
                    way: slider.guide_turning(angle).into(),
                }
            });
            through(
                &stations,
                Some(&|from, by| slider.guide_transmission_range(from, by)),
            )
        }
        (Linkage::TwoSliders(..), _) => return None,
    })
}

/// The least and the most of something while the driver goes from one place through a way.
type Range<'a> = &'a dyn Fn(f64, f64) -> [f64; 2];

fn through(stations: &[Station], transmission: Option<Range>) -> Passage {
    let all_one = |of: fn(&Station) -> i8| {
        let first = of(&stations[0]);
        stations.iter().all(|s| of(s) == first)
    };
    // A place on the closed circuit as an angle: the crank's own, or that whose cosine a rocker follows, there on one branch and back on
    // the other.
    let around: Vec<f64> = (stations.iter())
        .map(|s| {
            let part = match s.way {
                Way::Round => return s.driver,
                Way::Swing(middle, half) => math::within_half_a_turn(s.driver - middle) / half,
                Way::Straight(middle, half) => (s.driver - middle) / half,
            };
            math::acos(part.clamp(-1.0, 1.0)) * if s.branch < 0 { -1.0 } else { 1.0 }
        })
        .collect();
    let n = around.len();
    let turns = (0..n)
        .map(|k| within_a_turn(around[(k + 1) % n] - around[k]))
        .sum::<f64>()
        / TAU;
    let forward = (turns - 1.0).abs() < 0.5;
    let backward = (turns - (n - 1) as f64).abs() < 0.5;
    let way = stations[0].way;
    let mut driver: Vec<f64> = Vec::with_capacity(n);
    for s in stations {
        let next = match (way, driver.last()) {
            (Way::Swing(middle, _), _) => middle + math::within_half_a_turn(s.driver - middle),
            (Way::Straight(..), _) | (_, None) => s.driver,
            (_, Some(last)) if n > 2 && forward => last + within_a_turn(s.driver - last),
            (_, Some(last)) if n > 2 && backward => last - within_a_turn(last - s.driver),
            (_, Some(last)) => last + math::within_half_a_turn(s.driver - last),
        };
        driver.push(next);
    }
    let transmission = transmission.map(|range| {
        let over_all = match way {
            Way::Round => range(0.0, TAU),
            Way::Swing(middle, half) | Way::Straight(middle, half) => {
                range(middle - half, 2.0 * half)
            }
        };
        let between = (driver.windows(2)).fold([f64::INFINITY, 0.0], |[low, high], pair| {
            let [least, most] = range(pair[0], pair[1] - pair[0]);
            [math::min(low, least), math::max(high, most)]
        });
        [over_all, between]
    });
    Passage {
        one_circuit: all_one(|s| s.circuit),
        one_branch: all_one(|s| s.branch),
        in_order: forward || backward,
        crank: way == Way::Round,
        driver,
        transmission,
    }
}
