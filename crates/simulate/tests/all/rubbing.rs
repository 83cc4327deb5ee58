//! Friction where several coordinates move: against motions known exactly, against one coordinate alone, and against inverse dynamics.
#![allow(clippy::unwrap_used)]

use crate::common::{Free, at, weigh};
use crate::mechanisms::generate::{make, recipe};
use crate::mechanisms::{Case, Rng};
use kempe_dynamics::ForceSampler;
use kempe_mechanism::Design;
use kempe_mechanism::constraint::Source;
use kempe_model::{DriveId, Friction, FrictionAt, JointId};
use kempe_motion::Silent;
use kempe_number::Number;
use kempe_number::math::{cos, sin};
use kempe_simulate::{Ending, Happened, Happening, Method, Question, Rubs, Simulated, simulate};
use kempe_units::Expr;

const G: f64 = 9.81;

/// A block slides on a plank that slides on the ground.
fn plank(deck: &str, ground: &str) -> String {
    format!(
        r#"
        units = {{ length = "m", angle = "rad" }}
        gravity = [0, "-9.81 m/s^2"]
        [links]
        frame = {{ O = [0, 0], X = [1, 0] }}
        plank = {{ A = [0, 0], Q = [1, 0], mass = 2, inertia = 1, center = [0, 0] }}
        block = {{ C = [0, 0], mass = 1, inertia = 1, center = [0, 0] }}
        [joints]
        floor = {{ slider = "plank", at = "A", on = "O -> X" }}
        deck  = {{ slider = "block", at = "C", on = "A -> Q" }}
        [friction]
        floor = {{ {ground} }}
        deck  = {{ {deck} }}
        [drives]
        under = {{ slides = "floor", at = 0 }}
        over  = {{ slides = "deck", at = 0 }}
        "#
    )
}

fn near(found: &Simulated, drive: usize, time: f64, wanted: [f64; 2]) {
    let is = at(found, drive, time);
    for (is, wanted) in is.iter().zip(wanted) {
        assert!(
            (is - wanted).abs() < 1e-11 * (1.0 + wanted.abs()),
            "drive {drive} at {time}: {is} instead of {wanted}"
        );
    }
}

#[test]
fn a_block_slides_on_a_plank_rides_on_it_and_both_come_to_rest() {
    let mut free = Free::new(&plank("coefficient = 0.4", "coefficient = 0.05"), 8.0);
    free.question.start[1][1] = 3.0;
    let found = free.run();
    assert_eq!(found.ending, Ending::Until);
    // (0.4 - 0.05 3) g / 2 forwards, and 0.4 g against it.
    let (plank, block) = (0.125 * G, -0.4 * G);
    let together = 3.0 / (plank - block);
    let fast = plank * together;
    let rest = together + fast / (0.05 * G);
    for k in 0..=20 {
        let t = together * f64::from(k) / 20.0;
        near(&found, 0, t, [0.5 * plank * t * t, plank * t]);
        let s = block - plank;
        near(&found, 1, t, [3.0 * t + 0.5 * s * t * t, 3.0 + s * t]);
        let later = together + (rest - together) * f64::from(k) / 20.0;
        let dt = later - together;
        let way = 0.5 * fast * together + fast * dt - 0.025 * G * dt * dt;
        near(&found, 0, later, [way, fast - 0.05 * G * dt]);
        near(&found, 1, later, [1.5 * together, 0.0]);
    }
    let way = 0.5 * fast * rest;
    near(&found, 0, 8.0, [way, 0.0]);
    let told: Vec<Happened> = found.happenings.iter().map(|h| h.what).collect();
    let deck = Rubs::Joint(Source::Joint(JointId(1)));
    assert_eq!(told, [Happened::Holds { at: deck }, Happened::Sticks]);
    assert!((found.happenings[0].time - together).abs() < 1e-12);
    assert!((found.happenings[1].time - rest).abs() < 1e-11);
}

/// A crank-rocker with friction in all its pins and a motor that lets it stop; beside it, whatever hangs there.
fn rocker(beside: &str, drive: &str) -> String {
    format!(
        r#"
        units = {{ length = "m", angle = "rad" }}
        gravity = [0, "-9.81 m/s^2"]
        [links]
        frame   = {{ A = [0, 0], D = [0.6, 0], O = [3, 0] }}
        crank   = {{ A-B = 0.2, mass = 3, inertia = 0.02, center = [0.15, 0] }}
        coupler = {{ B-C = 0.5, mass = 2, inertia = 0.05, center = [0.25, 0] }}
        rocker  = {{ D-C = 0.4, mass = 2, inertia = 0.04, center = [0.2, 0] }}
        {beside}
        [assembly]
        C = "left of B -> D"
        [friction]
        A = {{ coefficient = 0.2, radius = 0.03, drag = 0.1 }}
        B = {{ coefficient = 0.3, radius = 0.02 }}
        C = {{ drag = 1.5 }}
        D = {{ coefficient = 0.2, radius = 0.02, viscous = 0.05 }}
        [drives]
        motor = {{ turns = "crank", at = 1 }}
        {drive}
        "#
    )
}

#[test]
fn beside_another_mechanism_each_moves_as_it_does_alone() {
    let pendulum = "rod = { O-P = 1, mass = 1, inertia = 0.1, center = [0.5, 0] }";
    let swing = "swing = { turns = \"rod\", at = 0.3 }";
    for (start, until) in [(0.0, 6.0), (9.0, 4.0), (-6.0, 4.0)] {
        let mut alone = Free::new(&rocker("", ""), until);
        alone.question.start[0][1] = start;
        let alone = alone.run();
        let mut both = Free::new(&rocker(pendulum, swing), until);
        both.question.start[0][1] = start;
        let both = both.run();
        assert_eq!(
            both.ending,
            Ending::Until,
            "{} {:?}",
            both.end,
            &both.happenings[..both.happenings.len().min(8)]
        );
        for k in 0..=200 {
            let t = until * f64::from(k) / 200.0;
            let (one, other) = (at(&alone, 0, t), at(&both, 0, t));
            for (one, other) in one.iter().zip(other) {
                assert!(
                    (one - other).abs() < 1e-9,
                    "start {start}, {t}: {one} {other}"
                );
            }
        }
        let sticks = |found: &Simulated| {
            let told = found.happenings.iter();
            told.filter(|h| matches!(h.what, Happened::Sticks)).count()
        };
        println!(
            "{start}: {} {:?} {} {}",
            sticks(&alone),
            both.happenings,
            alone.evaluations,
            both.evaluations
        );
    }
}

/// What inverse dynamics of the motion that was found asks of the coordinates that were let go, over the largest load anywhere: nothing, if the
/// friction that it finds is the one that acted.
fn unbalanced(found: &Simulated, until: f64) -> f64 {
    let motion = found.motion(&mut Silent).unwrap();
    let mut sampler = ForceSampler::new(&motion, &[]).unwrap();
    let mut worst = 0.0_f64;
    for k in 0..=400 {
        let sample = sampler.at_time(until * f64::from(k) / 400.0);
        let evidence = sample.evidence.unwrap();
        assert!(evidence.route_difference < 1e-9, "{evidence:?}");
        let (forces, _) = sampler.solved();
        let largest = forces.equilibrium.lanes[0].largest;
        for drive in found.telling() {
            let asked = forces.drives[drive.index()].value.value();
            worst = worst.max(asked.abs() / largest);
        }
    }
    worst
}

#[test]
fn inverse_dynamics_of_what_was_found_asks_for_nothing() {
    let mut free = Free::new(&plank("coefficient = 0.4", "coefficient = 0.05"), 8.0);
    free.question.start[1][1] = 3.0;
    let off = unbalanced(&free.run(), 8.0);
    assert!(off < 1e-11, "{off:e}");
    let pendulum = "rod = { O-P = 1, mass = 1, inertia = 0.1, center = [0.5, 0] }";
    let swing = "swing = { turns = \"rod\", at = 0.3 }";
    let free = Free::new(&rocker(pendulum, swing), 6.0);
    let off = unbalanced(&free.run(), 6.0);
    assert!(off < 3e-8, "{off:e}");
}

/// A five-bar whose cranks are let go, with friction in its pins.
const FIVE_BAR: &str = r#"
    units = { length = "m", angle = "rad" }
    gravity = [0, "-9.81 m/s^2"]
    [links]
    frame = { A = [0, 0], E = [0.5, 0] }
    left  = { A-B = 0.25, mass = 1, inertia = 0.01, center = [0.12, 0] }
    reach = { B-C = 0.5, mass = 1.2, inertia = 0.03, center = [0.25, 0.02] }
    arm   = { D-C = 0.5, mass = 0.8, inertia = 0.02, center = [0.25, 0] }
    right = { E-D = 0.25, mass = 1, inertia = 0.01, center = [0.1, 0.03] }
    [assembly]
    C = "left of B -> D"
    [friction]
    all = { coefficient = 0.15, radius = 0.02 }
    B = { coefficient = 0.2, static = 0.3, stribeck = "10 mm/s", radius = 0.02, drag = 0.05 }
    C = { drag = 0.3, viscous = 0.02 }
    [drives]
    one = { turns = "left", at = 2.2 }
    two = { turns = "right", at = 0.9 }
"#;

#[test]
fn a_five_bar_with_friction_in_all_pins_swings_until_it_rests() {
    let mut free = Free::new(FIVE_BAR, 6.0);
    free.question.start = vec![[2.2, 1.0], [0.9, -2.0]];
    free.question.tolerance = 1e-11;
    let found = free.run();
    println!("{:?} {} {}", found.ending, found.end, found.evaluations);
    for h in &found.happenings {
        println!("{:?}", h);
    }
    assert_eq!(found.ending, Ending::Until);
    let off = unbalanced(&found, 6.0);
    assert!(off < 1e-8, "{off:e}");
}

/// A block on a belt, held back by a spring.
fn belt(friction: &str) -> String {
    format!(
        r#"
        units = {{ length = "m", angle = "rad" }}
        gravity = [0, "-9.81 m/s^2"]
        [links]
        frame = {{ O = [0, 0], X = [1, 0], W = [-1, 0] }}
        belt  = {{ A = [0, 0], Q = [1, 0] }}
        block = {{ C = [0, 0], mass = 2, inertia = 1, center = "C" }}
        [joints]
        rollers = {{ slider = "belt", at = "A", on = "O -> X" }}
        contact = {{ slider = "block", at = "C", on = "A -> Q" }}
        [springs]
        back = {{ between = "W-C", stiffness = "2000 N/m", free = 1 }}
        [friction]
        contact = {{ {friction} }}
        [drives]
        feed = {{ slides = "rollers", from = 0, to = 0.2, speed = "0.1 m/s" }}
        slip = {{ slides = "contact", at = 0 }}
        "#
    )
}

fn on_belt(friction: &str, until: f64) -> Free {
    let mut free = Free::new(&belt(friction), until);
    free.question.free.remove(0);
    free.question.start.remove(0);
    free
}

/// Stuck until the spring pulls as hard as friction holds, by a harmonic motion about that place where it slides.
#[test]
fn a_block_on_a_belt_sticks_and_slips_as_it_must() {
    let (mass, rate, speed): (f64, f64, f64) = (2.0, 2000.0, 0.1);
    let mut free = on_belt("coefficient = 0.3", 0.5);
    // It starts against the belt, and comes back slowly enough for friction to catch it.
    free.question.start = vec![[0.0, -2.5 * speed]];
    let found = free.run();
    assert_eq!(found.ending, Ending::Until);
    let (w, middle) = ((rate / mass).sqrt(), 0.3 * mass * G / rate);
    let (a, b) = (-middle, -1.5 * speed / w);
    let place = |t: f64| middle + a * cos(w * t) + b * sin(w * t);
    let velocity = |t: f64| w * (b * cos(w * t) - a * sin(w * t));
    // It comes back, and is as fast as the belt before it is fastest.
    let fastest = (std::f64::consts::PI - kempe_number::math::atan2(a / b, 1.0)) / w;
    let (mut low, mut high) = (0.0, fastest);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if velocity(middle) < speed {
            low = middle;
        } else {
            high = middle;
        }
    }
    let sticks = low;
    let slips = sticks + (middle - place(sticks)) / speed;
    let half = slips + std::f64::consts::PI / w;
    assert!(half < 0.5, "{half}");
    for k in 0..=300 {
        let t = half * f64::from(k) / 300.0;
        let (x, v) = if t < sticks {
            (place(t), velocity(t))
        } else if t < slips {
            (place(sticks) + speed * (t - sticks), speed)
        } else {
            let phase = w * (t - slips);
            (middle + speed / w * sin(phase), speed * cos(phase))
        };
        near(&found, 1, t, [x - speed * t, v - speed]);
    }
    let told: Vec<(f64, Happened)> = found.happenings.iter().map(|h| (h.time, h.what)).collect();
    let contact = Rubs::Joint(Source::Joint(JointId(1)));
    assert_eq!(told[0].1, Happened::Holds { at: contact });
    assert_eq!(told[1].1, Happened::LetsGo { at: contact });
    assert!(
        (told[0].0 - sticks).abs() < 1e-11 && (told[1].0 - slips).abs() < 1e-10,
        "{told:?}"
    );
}

/// With a coefficient that falls it goes on sticking and slipping, each time alike.
#[test]
fn a_falling_coefficient_keeps_a_block_juddering() {
    for tolerance in [1e-9, 1e-11, 1e-13] {
        let mut free = on_belt(
            "coefficient = 0.15, static = 0.3, stribeck = \"5 mm/s\"",
            2.0,
        );
        free.question.tolerance = tolerance;
        let found = free.run();
        assert_eq!(found.ending, Ending::Until);
        let slips = |h: &&Happening| matches!(h.what, Happened::LetsGo { .. });
        let slips: Vec<f64> = found
            .happenings
            .iter()
            .filter(slips)
            .map(|h| h.time)
            .collect();
        assert_eq!(slips.len(), 10, "{slips:?}");
        assert!((slips[0] - 0.3 * 2.0 * G / 2000.0 / 0.1).abs() < 1e-12);
        for pair in slips.windows(2) {
            assert!(
                (pair[1] - pair[0] - 0.20364199375).abs() < 1e4 * tolerance.max(1e-11),
                "{slips:?}"
            );
        }
        let off = unbalanced(&found, 2.0);
        assert!(off < 1e-6, "{off:e}");
    }
}

/// Random mechanisms whose drives are let go, with friction wherever anything turns or slides: what is found is balanced as well as it is
/// without friction. Some jam: friction circles are wider than links are long.
#[test]
fn random_mechanisms_with_friction_are_balanced() {
    let (mut done, mut several, mut held, mut jams) = (0, 0, 0, 0);
    for seed in 0..48 {
        let mut rng = Rng(seed ^ 0xf00d);
        let mut model = Case::of(&make(&recipe(seed)).spec).model;
        let size = Case::from_model(model.clone()).design.size();
        weigh(&mut model, size, |low, high| rng.range(low, high));
        model.actions.friction = vec![Friction {
            at: FrictionAt::All,
            coefficient: Expr::Const(0.1),
            static_coefficient: None,
            stribeck_speed: None,
            viscous: None,
            drag: None,
            radius: Some(Expr::Const(0.005 * size)),
            span: model.drives[0].span.clone(),
        }];
        let case = Case::from_model(model);
        let plan = &case.mechanism.plan;
        if !plan.decomposition.surplus.is_empty()
            || plan.blocks.iter().any(|block| !block.surplus.is_empty())
        {
            continue;
        }
        let drives = &case.model.drives;
        let until = 0.5 * (size / 9.81).sqrt();
        let start = drives.iter().map(|drive| {
            let angle = drive.dimension == kempe_units::Dimension::ANGLE;
            let unit = if angle { 1.0 } else { size };
            let law = drive.law.at(0.0, &case.parameters);
            [law, 0.1 * unit * rng.range(-1.0, 1.0) / until]
        });
        let question = Question {
            free: (0..drives.len() as u32).map(DriveId).collect(),
            start: start.collect(),
            until,
            tolerance: 1e-10,
            method: Method::Choose,
            stops: Vec::new(),
            end_when: Vec::new(),
            coordinates: kempe_simulate::Coordinates::Minimal,
            contacts: Vec::new(),
        };
        let off = |design: &Design<f64>| {
            let found = simulate(design, &question, &mut Silent).ok()?;
            (found.ending == Ending::Until).then(|| (unbalanced(&found, until), found.happenings))
        };
        let smooth = case
            .design
            .with_model(|model| model.actions.friction.clear());
        let Some((without, _)) = off(&smooth) else {
            continue;
        };
        let Some((with, happenings)) = off(&case.design) else {
            jams += 1;
            continue;
        };
        assert!(
            with < 3e-5 + 1e3 * without,
            "seed {seed}: {with:e} instead of {without:e}"
        );
        done += 1;
        several += usize::from(drives.len() > 1);
        held += usize::from(!happenings.is_empty());
    }
    assert!(
        done > 30 && several > 10 && held > 0 && jams < 6,
        "{done} done, {several} of several freedoms, {held} held, {jams} jam"
    );
}

/// What is viscous alone never holds anything: it is a damper.
#[test]
fn what_has_no_dry_friction_is_never_held() {
    let pendulum = |friction: &str| {
        format!(
            r#"
            units = {{ length = "m", angle = "rad" }}
            gravity = [0, "-9.81 m/s^2"]
            [links]
            frame = {{ O = [0, 0] }}
            upper = {{ O-P = 1, mass = 1, inertia = 0.1, center = [0.5, 0] }}
            lower = {{ P-Q = 1, mass = 1, inertia = 0.1, center = [0.5, 0] }}
            {friction}
            [drives]
            one = {{ turns = "upper", at = "-90 deg" }}
            two = {{ turns = "lower", at = "-90 deg" }}
            "#
        )
    };
    let mut ends = Vec::new();
    for friction in [
        "[dampers]\nhinge = { links = [\"upper\", \"lower\"], damping = \"0.2 N m s\" }",
        "[friction]\nP = { coefficient = 0, radius = 0.1, viscous = \"0.2 N m s\" }",
    ] {
        // Hanging still, and swinging.
        let still = Free::new(&pendulum(friction), 1.0).run();
        assert!(still.happenings.is_empty() && still.ending == Ending::Until);
        let mut free = Free::new(&pendulum(friction), 3.0);
        free.question.start[1][1] = 4.0;
        let found = free.run();
        assert!(found.happenings.is_empty(), "{:?}", found.happenings);
        ends.push([at(&found, 0, 3.0), at(&found, 1, 3.0)]);
    }
    for (one, other) in ends[0].iter().flatten().zip(ends[1].iter().flatten()) {
        assert!((one - other).abs() < 1e-10, "{ends:?}");
    }
}
