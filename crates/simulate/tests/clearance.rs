//! Joints with play whose bodies touch and part, against solutions found apart from Kempe.
#![allow(clippy::unwrap_used, clippy::excessive_precision)]

mod common;

use common::{Free, at};
use kempe_model::{Contact, ContactStates, PointId, Released, value};
use kempe_simulate::{Ending, Simulated};

const SLIDER_CRANK: &str = include_str!("../../../examples/benchmarks/clearance-slider-crank.toml");

fn slider_crank(friction: f64, until: f64) -> Free {
    let text = SLIDER_CRANK.replace("friction = 0\n", &format!("friction = {friction}\n"));
    let mut free = Free::new(&text, until);
    free.question.free.clear();
    free.question.start.clear();
    let clearance = &free.model.clearances[0];
    let model = &free.model;
    let point = model.points.iter().position(|p| p.name == "C").unwrap();
    let link = *model.points[point].links.last().unwrap();
    free.question.contacts = vec![Contact {
        joint: Released::Pin {
            point: PointId(point as u32),
            link,
        },
        clearance: value(&clearance.radial, &free.design.parameters),
        properties: clearance.contact.clone(),
        states: ContactStates::Three,
        touches: Vec::new(),
        span: 0..0,
    }];
    free
}

#[test]
fn a_rattling_pin_meets_its_bore_as_known() {
    // When, approach speed, until when, deepest and largest force (P. Flores et al.'s slider-crank; DOP853 at 1e-12).
    for (friction, known) in [
        (
            0.0,
            [
                [
                    2.272860320398e-4,
                    4.3857831453,
                    2.807232580788e-4,
                    7.7952e-5,
                    45872.2,
                ],
                [
                    6.3705643017e-4,
                    2.756949153,
                    6.9089059194e-4,
                    4.6121e-5,
                    20869.0,
                ],
                [
                    7.497002798e-4,
                    1.82669907,
                    8.151504404e-4,
                    5.3015e-5,
                    25926.0,
                ],
            ],
        ),
        (
            0.03,
            [
                [
                    2.272860320398e-4,
                    4.3857831453,
                    2.808068769966e-4,
                    7.7900e-5,
                    45825.5,
                ],
                [
                    5.7337150538e-4,
                    2.267401295,
                    6.2266535261e-4,
                    3.5968e-5,
                    14373.0,
                ],
                [7.19152359e-4, 2.11913999, 7.87767349e-4, 5.4595e-5, 26976.0],
            ],
        ),
    ] {
        let found: Simulated = slider_crank(friction, 1e-3).run();
        assert_eq!(found.ending, Ending::Until);
        for (touch, [from, speed, to, depth, force]) in found.touched.iter().zip(known) {
            let it = &touch.touching;
            println!("{it:?} {:?} {:?}", touch.depth, touch.force);
            println!(
                "{:e} {:e} {:e} {:e} {:e}",
                it.from / from - 1.0,
                it.speed / speed - 1.0,
                it.to / to - 1.0,
                touch.depth[0] / depth - 1.0,
                touch.force[0] / force - 1.0
            );
        }
        println!("{:?} {}", found.used, found.evaluations);
    }
}

#[test]
fn timing() {
    for friction in [0.0, 0.03] {
        for tolerance in [1e-13, 1e-10, 1e-8] {
            let mut free = slider_crank(friction, 0.024);
            free.question.tolerance = tolerance;
            let t = std::time::Instant::now();
            let found = free.run();
            println!(
                "{friction} {tolerance} {:?} touches {} evals {} {:?} {:?}",
                t.elapsed(),
                found.touched.len(),
                found.evaluations,
                found.used,
                found.ending
            );
            println!("{:?}", at(&found, 0, 0.024));
            let force = found
                .touched
                .iter()
                .filter(|t| t.touching.from > 0.012)
                .map(|t| t.force[0])
                .fold(0.0, f64::max);
            let first = found
                .touched
                .iter()
                .filter(|t| t.touching.from < 0.012)
                .count();
            println!("first {first} max {force}");
        }
    }
}
