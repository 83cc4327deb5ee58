//! Play at joints against mechanisms in which the clearances are links of their own, against shifted guides, and against virtual
//! work.
#![allow(clippy::unwrap_used, clippy::disallowed_methods)]

use crate::mechanisms;
use std::sync::Arc;

use crate::mechanisms::generate::{make, recipe};
use crate::mechanisms::{Case, Rng};
use kempe_dynamics::ForceSampler;
use kempe_dynamics::clearance::{Clearances, NotSettled, Play};
use kempe_mechanism::constraint::Source;
use kempe_model::{JointKind, LinkId, Measure, Model, PoseMeasure};
use kempe_motion::Motion;
use kempe_motion::drive_path::duration;
use kempe_number::Number;
use kempe_units::Expr;

/// The joint of a pin, or of a name under `[joints]`.
fn joint(motion: &Motion, name: &str) -> Source {
    let model = &motion.mechanism().model;
    let own = |source: &Source| match source {
        Source::Pin { point, .. } => model.points[point.index()].name == name,
        Source::Joint(id) => model.joints[id.index()].name == name,
        Source::Drive(_) => false,
    };
    let mut sources = motion.mechanism().constraints.iter().map(|(_, s)| *s);
    sources.find(own).unwrap()
}

fn clearances(motion: &Arc<Motion>, plays: &[(&str, f64)], turning: bool) -> Clearances {
    let plays: Vec<Play> = (plays.iter())
        .map(|(name, radial)| Play {
            joint: joint(motion, name),
            radial: *radial,
        })
        .collect();
    Clearances::new(motion, &plays, turning, &[]).unwrap()
}

fn measure(model: &Model, text: &str) -> Measure {
    model.measure(text).unwrap().measure
}

fn value(at: &Clearances, text: &str) -> f64 {
    at.value(&measure(&at.state().mechanism().model, text))
}

/// Values along a motion at a time.
fn values(motion: &Arc<Motion>, texts: &[&str], time: f64) -> Vec<f64> {
    let measures: Vec<Measure> = (texts.iter())
        .map(|text| measure(&motion.mechanism().model, text))
        .collect();
    let measures: Vec<&Measure> = measures.iter().collect();
    let mut sampler = ForceSampler::new(motion, &measures).unwrap();
    sampler.at_time(time).sample.values
}

/// Where the contacts of the first two pins are, rad, and how fast they turn, rad/s.
fn contact(at: &Clearances, pin: usize) -> [f64; 2] {
    let state = at.state();
    let released = &state.mechanism().released[2 * pin..2 * pin + 2];
    let [x, y] = [released[0], released[1]].map(|d| state.coordinates[d.index()]);
    let angle = y.atan2(x);
    [angle.value(), angle.coefficient(1)]
}

/// A four-bar whose pins B and C are links of these lengths and directions where there are any.
fn four_bar(rng: &mut Rng, gaps: Option<[(f64, f64); 2]>) -> String {
    let [a, b, c, d] =
        [(0.15, 0.25), (0.5, 0.6), (0.45, 0.55), (0.55, 0.65)].map(|(l, h)| rng.range(l, h));
    let mut mass = || {
        let (m, j, x, y) = (
            rng.range(0.5, 3.0),
            rng.range(0.005, 0.05),
            rng.range(0.0, 0.2),
            rng.range(-0.05, 0.05),
        );
        format!("mass = {m:?}, inertia = {j:?}, center = [{x:?}, {y:?}]")
    };
    let (crank, coupler, rocker) = (mass(), mass(), mass());
    let (speed, from) = (rng.range(2.0, 12.0), rng.range(-180.0, 180.0));
    let (links, drives, [p, q]) = match gaps {
        None => (String::new(), String::new(), ["B", "C"]),
        Some([(e, at), (f, to)]) => (
            format!("gap_b = {{ B-Bq = {e:?} }}\ngap_c = {{ C-Cq = {f:?} }}\n"),
            format!(
                "at_b = {{ turns = \"gap_b\", at = \"{at:?} rad\" }}\nat_c = {{ turns = \"gap_c\", at = \"{to:?} rad\" }}\n"
            ),
            ["Bq", "Cq"],
        ),
    };
    format!(
        "[links]\nframe = {{ A = [0, 0], D = [{d:?}, 0] }}\ncrank = {{ A-B = {a:?}, {crank} }}\n\
         coupler = {{ {p}-C = {b:?}, {coupler} }}\nrocker = {{ D-{q} = {c:?}, {rocker} }}\n{links}\
         [drives]\nmotor = {{ turns = \"crank\", from = {from:?}, to = {to:?}, speed = \"{speed:?} rad/s\" }}\n{drives}\
         [assembly]\nC = \"left of B -> D\"\n",
        to = from + 90.0
    )
}

#[test]
fn a_clearance_is_a_massless_link_along_the_reaction() {
    let asked = [
        "angle(rocker)",
        "angular_speed(rocker)",
        "angular_acceleration(rocker)",
        "torque(motor)",
        "reaction(A)",
        "reaction(D)",
        "reaction_x(B, crank)",
    ];
    let mut compared = 0;
    for seed in 0..40 {
        let e = [1e-3, 1e-5][seed as usize % 2];
        let motion = Case::read(&four_bar(&mut Rng(seed), None), "play").must_move();
        let mut at = clearances(&motion, &[("B", e), ("C", 2.0 * e)], false);
        let time = 0.37 * duration(&motion.mechanism().model, &[]);
        at.go_to(time).unwrap();
        let Ok(()) = at.settle() else { continue };
        let gaps = [(e, contact(&at, 0)[0]), (2.0 * e, contact(&at, 1)[0])];
        let linked = Case::read(&four_bar(&mut Rng(seed), Some(gaps)), "linked").must_move();
        let found = values(&linked, &asked, time);
        for (text, wanted) in asked.iter().zip(found) {
            let ours = value(&at, text);
            assert!(
                (ours - wanted).abs() <= 1e-9 * wanted.abs().max(1.0),
                "{seed}: {text} {ours} {wanted}"
            );
        }
        // Along the reaction: nothing need turn the links.
        let torques = values(
            &linked,
            &["torque(at_b)", "torque(at_c)", "reaction(A)"],
            time,
        );
        for torque in &torques[..2] {
            assert!(torque.abs() <= 1e-8 * e * torques[2], "{seed}: {torques:?}");
        }
        // And it pushes: the bore holds the pin back.
        let crank_feels = [
            value(&at, "reaction_x(B, crank)"),
            value(&at, "reaction_y(B, crank)"),
        ];
        let to = gaps[0].1;
        assert!(crank_feels[0] * to.cos() + crank_feels[1] * to.sin() > 0.0);
        compared += 1;
    }
    assert!(compared >= 35, "{compared}");
}

#[test]
fn a_slider_stands_off_to_the_side_its_guide_pushes_from() {
    let text = |off: f64| {
        format!(
            "[links]\nframe = {{ A = [0, 0], E = [0, {off:?}], F = [1, {off:?}] }}\n\
             crank = {{ A-B = 0.1, mass = 1, inertia = 0.01 }}\nrod = {{ B-C = 0.3, mass = 2, inertia = 0.02 }}\n\
             piston = {{ C = [0, 0], mass = 3, inertia = 0.001 }}\n\
             [joints]\nbore = {{ slider = \"piston\", at = \"C\", on = \"E -> F\" }}\n\
             [drives]\nmotor = {{ turns = \"crank\", from = 10, to = 170, speed = \"30 rad/s\" }}\n\
             [assembly]\nC = {{ near = [0.4, 0] }}\n"
        )
    };
    let motion = Case::read(&text(0.0), "slider").must_move();
    let mut at = clearances(&motion, &[("bore", 1e-3)], false);
    let asked = [
        "x(C)",
        "angle(rod)",
        "acceleration(C)",
        "torque(motor)",
        "reaction(bore)",
    ];
    let mut sides = Vec::new();
    for part in [0.05, 0.2, 0.4, 0.6, 0.8, 0.95] {
        let time = part * duration(&motion.mechanism().model, &[]);
        at.go_to(time).unwrap();
        at.settle().unwrap();
        let side = -value(&at, "reaction_y(bore, piston)").signum();
        sides.push(side);
        let shifted = Case::read(&text(1e-3 * side), "shifted").must_move();
        for (text, wanted) in asked.iter().zip(values(&shifted, &asked, time)) {
            let ours = value(&at, text);
            assert!(
                (ours - wanted).abs() <= 1e-10 * wanted.abs().max(1.0),
                "{part} {text}: {ours} {wanted}"
            );
        }
    }
    assert!(sides.contains(&1.0) && sides.contains(&-1.0), "{sides:?}");
}

/// Innocenti; Tsai and Lai (2004): what the clearances e of joints with reactions R give way under a load F is sum(e R) / F.
#[test]
fn what_gives_way_under_a_load_is_told_by_virtual_work() {
    for seed in 0..20 {
        let mut rng = Rng(seed ^ 0xf00d);
        let (x, y) = (rng.range(-40.0, 40.0), rng.range(-40.0, 40.0));
        let size = x.hypot(y);
        let from = rng.range(20.0, 160.0);
        let text = format!(
            "gravity = 0\n[links]\nframe = {{ A = [0, 0], D = [0.6, 0] }}\ncrank = {{ A-B = 0.2 }}\n\
             coupler = {{ B-C = 0.5, P = [0.3, 0.2] }}\nrocker = {{ D-C = 0.45 }}\n\
             [drives]\nmotor = {{ turns = \"crank\", at = {from:?} }}\n\
             [loads]\npush = {{ force = [\"{x:?} N\", \"{y:?} N\"], at = \"P\", on = \"coupler\" }}\n\
             [assembly]\nC = \"left of B -> D\"\n"
        );
        let motion = Case::read(&text, "loaded").must_move();
        let plays = [("A", 2e-8), ("B", 1e-8), ("C", 3e-8), ("D", 4e-8)];
        let ideal = values(&motion, &["x(P)", "y(P)"], 0.0);
        let reactions = values(
            &motion,
            &["reaction(A)", "reaction(B)", "reaction(C)", "reaction(D)"],
            0.0,
        );
        let mut at = clearances(&motion, &plays, false);
        at.go_to(0.0).unwrap();
        at.settle().unwrap();
        let [dx, dy] = [value(&at, "x(P)") - ideal[0], value(&at, "y(P)") - ideal[1]];
        let along = (dx * x + dy * y) / size;
        let wanted: f64 = plays
            .iter()
            .zip(&reactions)
            .map(|((_, e), r)| e * r / size)
            .sum();
        assert!(
            (along - wanted).abs() <= 1e-5 * wanted,
            "{seed}: {along} {wanted}"
        );
    }
}

/// Random mechanisms with play at every joint that can have it: the derivatives to the clearances are the first order of what
/// they do, what is left falls with their square, and no clearance leaves the motion as it is.
#[test]
fn small_clearances_do_what_their_derivatives_say() {
    let mut compared = 0;
    for seed in 0..160 {
        let mut model = Case::of(&make(&recipe(seed)).spec).model;
        let mut rng = Rng(seed ^ 0x91a7);
        for link in &mut model.links[1..] {
            link.inertia = Some(kempe_model::Inertia {
                mass: Some(Expr::Const(rng.range(0.1, 2.0))),
                moment: Some(Expr::Const(rng.range(0.001, 0.01))),
                center: kempe_model::Center::Place(kempe_model::Place::Cartesian {
                    x: Expr::Const(rng.range(-0.05, 0.05)),
                    y: Expr::Const(rng.range(-0.05, 0.05)),
                }),
            });
        }
        model.actions.friction.clear();
        let Ok(motion) = Case::from_model(model).motion() else {
            continue;
        };
        let mechanism = motion.mechanism();
        let mut open: Vec<Source> = Vec::new();
        for (_, source) in &mechanism.constraints[..mechanism.joint_constraints] {
            let slides = match source {
                Source::Joint(id) => matches!(
                    mechanism.model.joints[id.index()].kind,
                    JointKind::Slider { .. } | JointKind::Slot { .. } | JointKind::ArcSlot { .. }
                ),
                _ => true,
            };
            if slides && !open.contains(source) && mechanism.releasing(&[*source]).is_ok() {
                open.push(*source);
            }
        }
        let angles: Vec<Measure> = (1..mechanism.model.links.len() as u32)
            .map(|link| Expr::Leaf(kempe_model::Leaf::Pose(PoseMeasure::Angle(LinkId(link)))))
            .collect();
        let time = 0.43 * duration(&mechanism.model, &motion.design.parameters);
        let mut left = Vec::new();
        for part in [1e-5, 1e-6] {
            let radial = part * motion.size();
            let plays: Vec<Play> = open
                .iter()
                .map(|joint| Play {
                    joint: *joint,
                    radial,
                })
                .collect();
            let mut at = Clearances::new(&motion, &plays, false, &[]).unwrap();
            if at.go_to(time).is_err() || at.evidence().smallest_singular_value < 0.02 {
                break;
            }
            let slopes: Vec<Vec<[f64; 2]>> = angles.iter().map(|m| at.slopes(m)).collect();
            let before: Vec<f64> = angles.iter().map(|m| at.value(m)).collect();
            if at.settle().is_err() {
                break;
            }
            let state = at.state();
            let released = &state.mechanism().released;
            let lengths = |joint: &Source| -> Vec<f64> {
                let drives = released
                    .iter()
                    .map(|d| (d, &state.mechanism().model.drives[d.index()]));
                let own = drives.filter(|(_, drive)| match drive.kind {
                    kempe_model::DriveKind::Release { of, .. } => {
                        Source::from(of) == *joint
                            && drive.dimension == kempe_units::Dimension::LENGTH
                    }
                    _ => false,
                });
                own.map(|(d, _)| state.coordinates[d.index()].value())
                    .collect()
            };
            let mut most = 0.0_f64;
            for ((measure, slopes), before) in angles.iter().zip(&slopes).zip(&before) {
                let first: f64 = (slopes.iter().zip(&open))
                    .map(|(slope, joint)| {
                        slope
                            .iter()
                            .zip(lengths(joint))
                            .map(|(a, b)| a * b)
                            .sum::<f64>()
                    })
                    .sum();
                most = most.max((at.value(measure) - before - first).abs());
                // No directions give more than the worst case.
                let worst: f64 = slopes.iter().map(|[x, y]| x.hypot(*y) * radial).sum();
                assert!(first.abs() <= worst * (1.0 + 1e-12) + 1e-15, "{seed}");
            }
            left.push(most);
        }
        let [coarse, fine] = left[..] else { continue };
        assert!(coarse <= 1e-5, "{seed}: {coarse}");
        assert!(fine <= 0.02 * coarse + 1e-14, "{seed}: {coarse} {fine}");
        compared += 1;
    }
    println!("{compared} mechanisms");
    assert!(compared >= 60, "{compared}");
}

#[test]
fn without_clearances_nothing_changes_and_without_forces_nothing_is_known() {
    let motion = Case::read(&four_bar(&mut Rng(3), None), "play").must_move();
    let asked = ["angle(rocker)", "torque(motor)", "reaction(B)"];
    let mut at = clearances(&motion, &[], false);
    at.go_to(0.05).unwrap();
    at.settle().unwrap();
    for (text, wanted) in asked.iter().zip(values(&motion, &asked, 0.05)) {
        assert!(
            (value(&at, text) - wanted).abs() <= 1e-12 * wanted.abs().max(1.0),
            "{text}"
        );
    }
    let idle = "[links]\nframe = { A = [0, 0], D = [0.6, 0] }\ncrank = { A-B = 0.2 }\ncoupler = { B-C = 0.5 }\nrocker = { D-C = 0.45 }\n\
                [drives]\nmotor = { turns = \"crank\", speed = 1 }\n[assembly]\nC = \"left of B -> D\"\n";
    let motion = Case::read(idle, "idle").must_move();
    let mut at = clearances(&motion, &[("B", 1e-5)], false);
    at.go_to(1.0).unwrap();
    assert_eq!(at.settle(), Err(NotSettled::NoReaction(0)));
    // What the drives never reach has no pose.
    assert_eq!(at.go_to(f64::NAN), Err(NotSettled::NoMotion));
}

/// A clearance that the loops cannot take up: the four-bar is nearly stretched.
#[test]
fn what_does_not_close_is_told() {
    let text = "[links]\nframe = { A = [0, 0], D = [0.6, 0] }\ncrank = { A-B = 0.2, mass = 1, inertia = 0.01 }\n\
                coupler = { B-C = 0.35, mass = 1, inertia = 0.01 }\nrocker = { D-C = 0.4502, mass = 1, inertia = 0.01 }\n\
                [drives]\nmotor = { turns = \"crank\", from = 176, to = 180, speed = 1 }\n[assembly]\nC = \"left of B -> D\"\n";
    let motion = Case::read(text, "stretched").must_move();
    let mut at = clearances(
        &motion,
        &[("B", 5e-3), ("C", 5e-3), ("D", 5e-3), ("A", 5e-3)],
        false,
    );
    let end = duration(&motion.mechanism().model, &[]);
    at.go_to(end).unwrap();
    let why = at.settle();
    assert!(
        matches!(
            why,
            Err(NotSettled::NotClosed
                | NotSettled::Flips(_)
                | NotSettled::OtherBranch
                | NotSettled::Moves(_))
        ),
        "{why:?}"
    );
}

#[test]
fn turning_links_turn_as_the_contacts_do() {
    for seed in 0..10 {
        let motion = Case::read(&four_bar(&mut Rng(seed), None), "play").must_move();
        let mut at = clearances(&motion, &[("B", 1e-6), ("C", 1e-6)], true);
        let time = 0.4 * duration(&motion.mechanism().model, &[]);
        let h = 1e-4 * time;
        let mut angles = Vec::new();
        for t in [time - h, time + h] {
            at.go_to(t).unwrap();
            at.settle().unwrap();
            angles.push([contact(&at, 0)[0], contact(&at, 1)[0]]);
        }
        at.go_to(time).unwrap();
        at.settle().unwrap();
        for pin in 0..2 {
            let [_, rate] = contact(&at, pin);
            let wanted = mechanisms::wrapped(angles[1][pin] - angles[0][pin]) / (2.0 * h);
            assert!(
                (rate - wanted).abs() <= 1e-3 * wanted.abs().max(1.0),
                "{seed}: {rate} {wanted}"
            );
        }
    }
}

/// A crank: its name, its pins on the frame and on the coupler, and where both are on these, m.
type Crank<'a> = (&'a str, &'a str, &'a str, f64);

/// A parallelogram whose coupler hangs on these cranks, that in the middle without a mass, and a dyad on it.
fn parallelogram(cranks: &[Crank<'_>]) -> String {
    let list = |of: &dyn Fn(&Crank<'_>) -> String| -> String {
        cranks.iter().map(of).collect::<Vec<_>>().join("")
    };
    format!(
        "[links]\nframe = {{ {}G = [1.1, -0.3] }}\n{}\
         coupler = {{ {}P = [1.0, 0.1], mass = 2, inertia = 0.1 }}\n\
         arm = {{ P-Q = 0.4, mass = 1.5, inertia = 0.02 }}\nswing = {{ G-Q = 0.5, mass = 1, inertia = 0.03 }}\n\
         [drives]\nmotor = {{ turns = \"{}\", from = 40, to = 140, speed = \"3 rad/s\" }}\n\
         [assembly]\nQ = {{ near = [1.4, 0.1] }}\n{}",
        list(&|(_, on, _, x)| format!("{on} = [{x:?}, 0], ")),
        list(&|(link, on, to, x)| {
            let mass = if *x == 0.3 {
                ""
            } else {
                ", mass = 1, inertia = 0.01"
            };
            format!("{link} = {{ {on}-{to} = 0.25{mass} }}\n")
        }),
        list(&|(_, _, to, x)| format!("{to} = [{x:?}, 0], ")),
        cranks[0].0,
        list(&|(_, _, to, x)| format!("{to} = {{ near = [{}, 0.16] }}\n", x + 0.19)),
    )
}

/// A third crank repeats the others: none of the pins of the parallelogram opens by itself, whatever they are called. What hangs
/// on it does, as where two cranks do the same.
#[test]
fn joints_that_repeat_each_other_are_told_and_the_others_do_as_without_them() {
    let two = [("crank", "A", "B", 0.0), ("other", "D", "C", 0.6)];
    let names = [
        [two[0], two[1], ("third", "E", "F", 0.3)],
        [two[0], ("third", "E", "F", 0.3), two[1]],
        [two[0], ("third", "A1", "A2", 0.6), ("a", "Z", "B1", 0.3)],
    ];
    let time = 0.3;
    for cranks in names {
        let motion = Case::read(&parallelogram(&cranks), "three").must_move();
        let pins: Vec<&str> = cranks
            .iter()
            .flat_map(|(_, on, to, _)| [*on, *to])
            .collect();
        for pin in pins {
            let mut at = clearances(&motion, &[(pin, 1e-5), ("Q", 1e-5)], false);
            at.go_to(time).unwrap();
            assert!(at.is_undetermined(0) && !at.is_undetermined(1), "{pin}");
            assert!(!at.is_idle(0), "{pin}");
            let slopes = at.slopes(&measure(&motion.mechanism().model, "angle(swing)"));
            assert!(
                slopes[0][0].is_nan() && slopes[1][0].is_finite(),
                "{pin}: {slopes:?}"
            );
            assert_eq!(at.settle(), Err(NotSettled::Undetermined(0)), "{pin}");
        }
        let simple = Case::read(&parallelogram(&two), "two").must_move();
        let found = [&motion, &simple].map(|motion| {
            let mut at = clearances(motion, &[("Q", 1e-4), ("G", 2e-4), ("P", 3e-4)], false);
            at.go_to(time).unwrap();
            let slopes = at.slopes(&measure(&motion.mechanism().model, "angle(swing)"));
            at.settle().unwrap();
            let asked = [
                "angle(swing)",
                "angular_acceleration(arm)",
                "torque(motor)",
                "reaction(Q)",
            ];
            let values = asked.map(|text| value(&at, text));
            (slopes, values)
        });
        for (a, b) in found[0].0.iter().flatten().zip(found[1].0.iter().flatten()) {
            assert!((a - b).abs() < 1e-11, "{found:?}");
        }
        for (a, b) in found[0].1.iter().zip(found[1].1) {
            assert!((a - b).abs() < 1e-9 * b.abs().max(1.0), "{found:?}");
        }
    }
}
