//! Linkages that guide a body, from the text of a file to the files of the linkages: reference values, round trips, bad requests.
#![allow(
    clippy::disallowed_methods,
    reason = "poses made by hand beside ours, not reproducible ones"
)]

use crate::told::{assert_built_by_its_lengths, column, places_on_one_link};
use std::f64::consts::TAU;

use kempe_mechanism::Mechanism;
use kempe_model::{Diagnostic, Model};
use kempe_number::Random;
use kempe_study::{Figure, Silent, StudyResult, check, run};
use kempe_synthesis::{C, FourBar, Pose};

const HEAD: &str = "title = \"t\"\nunits = { length = \"mm\", angle = \"deg\" }\n[studies.s]\nkind = \"synthesize\"\ntask = \"motion\"\n";
const COLUMNS: &str = "columns = ['x(A)', 'y(A)']\nkeep = 1000\n";

fn rendered(found: &[Diagnostic], text: &str) -> String {
    let lines = found.iter().map(|d| d.render_plain("test.toml", text));
    lines.collect()
}

/// What a request finds; the files of its linkages read and run anew.
fn found(task: &str) -> StudyResult {
    let text = format!("{HEAD}{task}");
    let mut files = |_: &str| Err(String::new());
    let model = match Model::from_toml(&text, "test", &mut files) {
        Ok(checked) => checked.model,
        Err(found) => panic!("{}", rendered(&found, &text)),
    };
    let result = match run(&model, &model.studies[0], &mut Silent) {
        Ok(result) => result,
        Err(found) => panic!("{}", rendered(&found, &text)),
    };
    assert_eq!(result.designs.len(), result.table.rows());
    for design in result.designs.iter().take(3) {
        let text = design.file.toml.as_str();
        let checked = match Model::from_toml(text, "", &mut files) {
            Ok(checked) => checked,
            Err(found) => panic!("{}\n{text}", rendered(&found, text)),
        };
        assert!(checked.model.same_as(&design.model), "{text}");
        assert_built_by_its_lengths(&design.model, text);
        let warned = rendered(&checked.warnings, text);
        assert!(checked.warnings.is_empty(), "{warned}\n{text}");
        let again = run(&checked.model, &checked.model.studies[0], &mut Silent);
        let again = again.unwrap_or_else(|found| panic!("{}\n{text}", rendered(&found, text)));
        assert_eq!(again.table.unreached(), 0, "{text}");
    }
    result
}

fn why(result: &StudyResult) -> Vec<String> {
    let listing = (result.listings.iter()).find(|l| l.title == "found, but not accepted");
    listing.map_or_else(Vec::new, |l| l.rows.iter().map(|r| r[1].clone()).collect())
}

/// What is told of a request that cannot be answered, by `check` and by `run` alike.
fn refused(task: &str) -> Vec<&'static str> {
    let text = format!("{HEAD}{task}");
    let model = match Model::from_toml(&text, "test", &mut |_| Err("no files".into())) {
        Ok(checked) => checked.model,
        Err(found) => return found.iter().map(|d| d.code).collect(),
    };
    let told = match run(&model, &model.studies[0], &mut Silent) {
        Ok(result) => result.diagnostics,
        Err(found) => {
            let checked = check(&model).diagnostics;
            assert!(
                found.iter().all(|d| checked.contains(d)),
                "{}",
                rendered(&checked, &text)
            );
            found
        }
    };
    for d in &told {
        assert!(d.help.is_some(), "{}", d.render_plain("test.toml", &text));
    }
    told.iter().map(|d| d.code).collect()
}

#[track_caller]
fn near(value: f64, wanted: f64, tolerance: f64) {
    assert!(
        (value - wanted).abs() <= tolerance * (1.0 + wanted.abs()),
        "{value} against {wanted}"
    );
}

/// Poses as the file has them.
fn written(poses: &[Pose]) -> String {
    let all = poses.iter().map(|p| {
        let degrees = p.angle.to_degrees();
        format!("[{:?}, {:?}, '{degrees:?} deg']", p.origin.re, p.origin.im)
    });
    format!("poses = [{}]\n", all.collect::<Vec<_>>().join(", "))
}

const HAN: &str = "poses = [[0, 0, 0], [12, 6, 20], [20, 18, 55]]\n";

#[test]
fn hans_three_poses_with_given_moving_pivots() {
    let result = found(&format!(
        "{HAN}crank = {{ moving = [-10, 5] }}\nrocker = {{ moving = [15, 10] }}\ncolumns = ['x(A)', 'y(A)', 'x(D)', 'y(D)']\n"
    ));
    assert_eq!(result.designs.len(), 1);
    for (name, wanted) in [
        ("min(x(A))", -11.463732405799),
        ("min(y(A))", 39.178719688102),
        ("min(x(D))", 4.420969946282),
        ("min(y(D))", 25.774481233343),
        ("crank_length", 34.210048115629),
        ("coupler_length", 25.495097567964),
        ("rocker_length", 18.993423468626),
        ("ground", 20.784546599968),
    ] {
        near(column(&result, name)[0], wanted, 1e-12);
    }
    assert!(column(&result, "miss")[0] < 1e-12);
    // given fixed pivots
    let result = found(&format!(
        "{HAN}crank = {{ fixed = [-10, -20] }}\nrocker = {{ fixed = [40, -15] }}\n"
    ));
    match result.designs.first() {
        Some(design) => {
            let mechanism = Mechanism::new(&design.model);
            let parameters: Vec<f64> = design.model.parameter_values();
            let [b, c] = places_on_one_link(&mechanism, &parameters, &["B", "C"])[..] else {
                panic!("{}", design.file.toml)
            };
            near(b[0] * 1e3, -14.2624894694, 1e-10);
            near(c[1] * 1e3, 35.46092561, 1e-8);
        }
        None => assert_eq!(why(&result).len(), 1),
    }
}

const B3: [[f64; 3]; 5] = [
    [0.0, 0.0, 0.0],
    [2.9, -2.0, 15.0],
    [2.6, 1.6, -35.0],
    [0.4, 1.3, -55.0],
    [1.3, -0.3, 20.0],
];

fn poses(of: &[[f64; 3]]) -> Vec<Pose> {
    of.iter()
        .map(|[x, y, angle]| Pose::new(*x, *y, angle.to_radians()))
        .collect()
}

/// Four dyads, six four-bars, twelve with the driven link: none is lost.
#[test]
fn five_poses_with_four_dyads_are_six_four_bars_each_accounted_for() {
    let result = found(&format!(
        "linkage = 'four-bar'\n{}keep = 100\n",
        written(&poses(&B3))
    ));
    let why = why(&result);
    assert_eq!(result.designs.len() + why.len(), 12, "{why:#?}");
    let count = |part: &str| why.iter().filter(|w| w.contains(part)).count();
    assert_eq!(
        count("two circuits") + count("two branches"),
        12,
        "{why:#?}"
    );
    let listing = result
        .listings
        .iter()
        .find(|l| l.title == "found, but not accepted")
        .unwrap();
    for length in ["1.47833", "3.63031", "1.53245", "2.23583"] {
        let crank = format!("crank {length}");
        let own = listing.rows.iter().filter(|row| row[0].contains(&crank));
        assert_eq!(own.count(), 3, "{length}: {listing:#?}");
    }
    assert!(result.diagnostics.iter().any(|d| d.code == "none-accepted"));
}

/// Poses of the four-bar (3, -8), (30, -5) with pins (-4, 6), (14, 8): it is found, with its three other dyads.
#[test]
fn hans_five_poses_recover_their_linkage() {
    let five = [
        [0.0, 0.0, 0.0],
        [3.609884889775, 1.551905931908, 5.392391106860],
        [7.619850334647, 2.496465372013, 10.732234782727],
        [12.236443287997, 2.680673359965, 17.255026647706],
        [17.445059122559, 1.814199506687, 26.900360045044],
    ];
    let task = format!("linkage = 'four-bar'\n{}{COLUMNS}", written(&poses(&five)));
    let result = found(&task);
    let rows = column(&result, "min(x(A))")
        .into_iter()
        .zip(column(&result, "min(y(A))"));
    let rows: Vec<(f64, f64)> = rows.collect();
    for (x, y) in [
        (3.0, -8.0),
        (30.0, -5.0),
        (29.36329017, -6.17178155),
        (0.91010556, 17.41475418),
    ] {
        let has = rows.iter().any(|(a, b)| (a - x).hypot(b - y) < 1e-6);
        assert!(has, "({x}, {y}) of {rows:?}");
    }
    assert_eq!(result.designs.len() + why(&result).len(), 12);
    assert!(column(&result, "miss").iter().all(|m| *m < 1e-11));
    let plane = result.figures.iter().find_map(|f| match f {
        Figure::Plane { curves, .. } => Some(curves),
        _ => None,
    });
    assert_eq!(plane.unwrap().len(), 3);
}

/// R. L. Norton, Design of Machinery, examples 5-1 and 5-2: the dyads W, Z and U, S.
#[test]
fn nortons_dyads_of_two_and_of_three_poses() {
    let polar = |size: f64, degrees: f64| C::from_polar(size, degrees.to_radians());
    let [z, s] = [polar(1.507734, 38.551), polar(1.490764, 94.185)];
    let (p2, p3) = (polar(2.798, -31.19), polar(3.919, -16.34));
    let three = [
        Pose::new(0.0, 0.0, 0.0),
        Pose::new(p2.re, p2.im, (-45.0_f64).to_radians()),
        Pose::new(p3.re, p3.im, 9.3_f64.to_radians()),
    ];
    let task = format!(
        "{}crank = {{ moving = [{:?}, {:?}] }}\nrocker = {{ moving = [{:?}, {:?}] }}\nlinkage = 'four-bar'\n",
        written(&three),
        -z.re,
        -z.im,
        -s.re,
        -s.im
    );
    let result = found(&task);
    let lengths = match result.designs.is_empty() {
        false => format!(
            "crank {} rocker {}",
            column(&result, "crank_length")[0],
            column(&result, "rocker_length")[0]
        ),
        true => format!("{:?}", result.listings),
    };
    assert!(
        lengths.contains("crank 6.83") && lengths.contains("rocker 3.19"),
        "{lengths}"
    );

    // two poses: the fixed pivots on lines through the moving ones, along W and U as printed
    let [z, s] = [polar(1.298, 26.5), polar(1.035, 104.1)];
    let p2 = polar(2.416, 165.2);
    let two = [
        Pose::new(0.0, 0.0, 0.0),
        Pose::new(p2.re, p2.im, 43.3_f64.to_radians()),
    ];
    let given = |pin: C, degrees: f64| {
        let pin = -pin;
        let on = pin + polar(1.0, degrees);
        format!(
            "{{ moving = [{:?}, {:?}], fixed_on = [[{:?}, {:?}], [{:?}, {:?}]] }}",
            pin.re, pin.im, pin.re, pin.im, on.re, on.im
        )
    };
    let task = format!(
        "{}crank = {}\nrocker = {}\nlinkage = 'four-bar'\n",
        written(&two),
        given(z, 71.571),
        given(s, 15.416)
    );
    let result = found(&task);
    near(column(&result, "crank_length")[0], 2.4669, 1e-4);
    near(column(&result, "rocker_length")[0], 1.48563, 1e-4);
}

/// A body on a crank and a pin on a straight guide.
fn slider_poses(random: &mut Random, n: usize) -> Option<(C, f64, [C; 2], Vec<Pose>)> {
    let mut point = |size: f64| {
        C::new(
            size * (random.uniform() - 0.5),
            size * (random.uniform() - 0.5),
        )
    };
    let (fixed, guide, pins) = (point(100.0), point(100.0), [point(80.0), point(80.0)]);
    let crank = 20.0 + 40.0 * random.uniform();
    let (from, by) = (TAU * random.uniform(), 0.6 + random.uniform());
    let direction = C::from_polar(1.0, TAU * random.uniform());
    let coupler = pins[1] - pins[0];
    let poses = (0..n).map(|k| {
        let b = fixed + C::from_polar(crank, from + by * k as f64 / (n - 1) as f64);
        // along and across the guide
        let seen = (b - guide) * direction.conj();
        let square = coupler.norm_sqr() - seen.im * seen.im;
        if square < 0.1 * coupler.norm_sqr() {
            return None;
        }
        let c = guide + direction.scale(seen.re + square.sqrt());
        let angle = ((c - b) * coupler.conj()).arg();
        let origin = b - C::from_polar(1.0, angle) * pins[0];
        Some(Pose { origin, angle })
    });
    let poses: Option<Vec<Pose>> = poses.collect();
    Some((fixed, crank, pins, poses?))
}

/// A body on a crank, with a slot over a fixed pin.
fn slot_poses(random: &mut Random, n: usize) -> Option<(C, f64, [C; 2], Vec<Pose>)> {
    let mut point = |size: f64| {
        C::new(
            size * (random.uniform() - 0.5),
            size * (random.uniform() - 0.5),
        )
    };
    let (fixed, pin, moving) = (point(100.0), point(100.0), point(80.0));
    let crank = 15.0 + 30.0 * random.uniform();
    let (from, by) = (TAU * random.uniform(), 0.6 + random.uniform());
    let (offset, own) = (20.0 * (random.uniform() - 0.5), TAU * random.uniform());
    let poses = (0..n).map(|k| {
        let b = fixed + C::from_polar(crank, from + by * k as f64 / (n - 1) as f64);
        let to = pin - b;
        let square = to.norm_sqr() - offset * offset;
        if square < 0.2 * crank * crank {
            return None;
        }
        let angle = to.arg() - offset.atan2(square.sqrt()) - own;
        let origin = b - C::from_polar(1.0, angle) * moving;
        Some(Pose { origin, angle })
    });
    let poses: Option<Vec<Pose>> = poses.collect();
    Some((fixed, crank, [moving, pin], poses?))
}

/// A crank's pivot and length, the coupler's pins, the other fixed pivot, and poses.
type Sampled = (C, f64, [C; 2], C, Vec<Pose>);

fn bar_poses(random: &mut Random, n: usize) -> Option<Sampled> {
    let mut point = |size: f64| {
        C::new(
            size * (random.uniform() - 0.5),
            size * (random.uniform() - 0.5),
        )
    };
    let (fixed, moving) = ([point(100.0), point(100.0)], [point(80.0), point(80.0)]);
    let lengths = [
        15.0 + 60.0 * random.uniform(),
        15.0 + 60.0 * random.uniform(),
    ];
    let bar = FourBar {
        fixed,
        moving,
        lengths,
    };
    let (from, by) = (TAU * random.uniform(), 0.6 + random.uniform());
    let branch = if random.uniform() < 0.5 { 1 } else { -1 };
    // It closes all along, and not at a dead centre.
    let all: Option<Vec<Pose>> = (0..=60)
        .map(|k| bar.pose(from + by * f64::from(k) / 60.0, branch))
        .collect();
    all?;
    let [low, high] = bar.transmission_range(from, by);
    if low.sin().min(high.sin()) < 0.25 || bar.link_ratio() > 8.0 {
        return None;
    }
    let poses = (0..n).map(|k| bar.pose(from + by * k as f64 / (n - 1) as f64, branch));
    let poses: Option<Vec<Pose>> = poses.collect();
    Some((fixed[0], lengths[0], moving, fixed[1], poses?))
}

/// Whether one of the linkages found has this crank.
fn has_crank(result: &StudyResult, fixed: C, crank: f64) -> bool {
    if result.designs.is_empty() {
        return false;
    }
    let (x, y) = (column(result, "min(x(A))"), column(result, "min(y(A))"));
    let lengths = column(result, "crank_length");
    (0..x.len()).any(|k| {
        let off = (x[k] - fixed.re).hypot(y[k] - fixed.im) + (lengths[k] - crank).abs();
        off < 1e-4
    })
}

/// A line through a point as the file has it.
fn line(through: C) -> String {
    let (x, y) = (through.re, through.im);
    format!("[[{x:?}, {y:?}], [{:?}, {:?}]]", x + 3.0, y + 1.0)
}

/// Random linkages sampled at three, four and five poses are among what is found.
#[test]
fn two_hundred_linkages_are_recovered_from_their_poses() {
    let mut random = Random(11);
    let mut missed = Vec::new();
    let mut done = 0;
    let at = |p: C| format!("[{:?}, {:?}]", p.re, p.im);
    while done < 200 {
        let n = 3 + done % 3;
        let (name, task, fixed, crank) = match done % 10 {
            0 | 1 => {
                // Sliders: three poses with the pin's line, four with nothing given of the slider.
                let n = 3 + done % 2;
                let Some((fixed, crank, pins, poses)) = slider_poses(&mut random, n) else {
                    continue;
                };
                let given = match n {
                    3 => format!(
                        "crank = {{ moving = {} }}\nrocker = {{ moving_on = {} }}\n",
                        at(pins[0]),
                        line(pins[1])
                    ),
                    _ => format!("crank = {{ fixed_on = {} }}\n", line(fixed)),
                };
                (
                    "slider",
                    format!(
                        "linkage = 'slider-crank'\n{}{given}{COLUMNS}",
                        written(&poses)
                    ),
                    fixed,
                    crank,
                )
            }
            2 | 3 => {
                let n = 3 + done % 2;
                let Some((fixed, crank, [moving, pin], poses)) = slot_poses(&mut random, n) else {
                    continue;
                };
                let given = match n {
                    3 => format!(
                        "crank = {{ moving = {} }}\nrocker = {{ fixed_on = {} }}\n",
                        at(moving),
                        line(pin)
                    ),
                    _ => format!("crank = {{ moving_on = {} }}\n", line(moving)),
                };
                (
                    "slot",
                    format!(
                        "linkage = 'inverted slider-crank'\n{}{given}{COLUMNS}",
                        written(&poses)
                    ),
                    fixed,
                    crank,
                )
            }
            _ => {
                let Some((fixed, crank, moving, other, poses)) = bar_poses(&mut random, n) else {
                    continue;
                };
                let given = match n {
                    3 => format!(
                        "crank = {{ moving = {} }}\nrocker = {{ fixed = {} }}\n",
                        at(moving[0]),
                        at(other)
                    ),
                    4 => format!(
                        "crank = {{ moving_on = {} }}\nrocker = {{ fixed_on = {} }}\n",
                        line(moving[0]),
                        line(other)
                    ),
                    _ => String::new(),
                };
                (
                    "bar",
                    format!("linkage = 'four-bar'\n{}{given}{COLUMNS}", written(&poses)),
                    fixed,
                    crank,
                )
            }
        };
        done += 1;
        let result = found(&task);
        if !has_crank(&result, fixed, crank) {
            missed.push(format!(
                "{name} {done}\n{task}{fixed:?} {crank}\n{:#?}",
                result.listings
            ));
        }
    }
    assert!(
        missed.is_empty(),
        "{} of {done}\n{}",
        missed.len(),
        missed[0]
    );
}

/// Five poses of a slider-crank: its slider is among the dyads.
#[test]
fn a_slider_of_five_poses_is_found_among_the_dyads() {
    let mut random = Random(5);
    let mut done = 0;
    while done < 6 {
        let of_slider = done % 2 == 0;
        let made = match of_slider {
            true => slider_poses(&mut random, 5),
            false => slot_poses(&mut random, 5),
        };
        let Some((fixed, crank, _, poses)) = made else {
            continue;
        };
        done += 1;
        let kind = if of_slider {
            "slider-crank"
        } else {
            "inverted slider-crank"
        };
        let task = format!("linkage = '{kind}'\n{}{COLUMNS}", written(&poses));
        let result = found(&task);
        assert!(
            has_crank(&result, fixed, crank),
            "{task}{:#?}",
            result.listings
        );
    }
}

/// What a search finds lies in its boxes, and what a box excludes is told.
#[test]
fn boxes_bound_pivots() {
    let boxes = "pivots_in = [[-50, -50], [50, 50]]\npins_in = [[-30, -30], [30, 30]]\n";
    let result = found(&format!(
        "{HAN}linkage = 'four-bar'\n{boxes}columns = ['x(A)', 'y(A)', 'x(D)', 'y(D)']\nkeep = 50\naccept = 'min(transmission_angle) >= 30 deg'\n"
    ));
    assert!(result.designs.len() >= 20, "{:#?}", result.listings);
    for name in ["min(x(A))", "min(y(A))", "min(x(D))", "min(y(D))"] {
        assert!(
            column(&result, name).iter().all(|v| v.abs() <= 50.0 + 1e-9),
            "{name}"
        );
    }
    let tried = result
        .listings
        .iter()
        .find(|l| l.title.starts_with("linkages tried"));
    let rows = &tried.expect("told").rows;
    let count = |part: &str| {
        let row = rows.iter().find(|row| row[0].contains(part));
        row.map_or(0, |row| row[1].parse::<usize>().expect("a count"))
    };
    let reasons = [
        "outside `pins_in`",
        "two circuits",
        "two branches",
        "in their order",
        "they pass",
    ];
    let all: usize = reasons.iter().map(|part| count(part)).sum();
    assert_eq!(all, count("in all"), "{rows:#?}");
    // Han's own pivots lie outside of this one
    let result = found(&format!(
        "{HAN}crank = {{ moving = [-10, 5] }}\nrocker = {{ moving = [15, 10] }}\nlinkage = 'four-bar'\npivots_in = [[-5, 0], [5, 30]]\n"
    ));
    assert!(
        why(&result)[0].contains("outside `pivots_in`"),
        "{:?}",
        why(&result)
    );
}

/// Four poses along the curve of pivots; two poses on the lines that they leave; all kinds where none is said.
#[test]
fn searches_of_four_and_of_two_poses() {
    let four = written(
        &poses(&B3[..4])
            .iter()
            .map(|p| Pose {
                angle: 0.5 * p.angle,
                ..*p
            })
            .collect::<Vec<_>>(),
    );
    let result = found(&format!("{four}pivots_in = [[-8, -8], [8, 8]]\nkeep = 5\n"));
    let tried = result
        .listings
        .iter()
        .find(|l| l.title.starts_with("linkages tried"));
    let title = &tried.expect("told").title;
    assert!(
        title.contains("48 places along the curve") && title.contains("sliders"),
        "{title}"
    );
    let plane = result.figures.iter().find_map(|f| match f {
        Figure::Plane { curves, .. } => Some(curves),
        _ => None,
    });
    let names: Vec<&str> = plane
        .expect("a figure")
        .iter()
        .map(|c| c.name.as_str())
        .collect();
    assert!(names.contains(&"curve of fixed pivots"), "{names:?}");
    let result = found(
        "poses = [[0, 0, 0], [12, 6, 40]]\nlinkage = 'four-bar'\ncrank = { moving = [-10, 5] }\nrocker = { fixed_on = [[0, -20], [1, -20]] }\n\
         pivots_in = [[-50, -50], [50, 50]]\npins_in = [[-30, -30], [30, 30]]\ncolumns = ['y(D)']\n",
    );
    assert!(!result.designs.is_empty());
    assert!(
        column(&result, "min(y(D))")
            .iter()
            .all(|y| (y + 20.0).abs() < 1e-9)
    );
}

/// Links that come nearest each for itself are a poor four-bar here (4.2 mm off). Source: least squares over four-bar and crank angles from random
/// starts comes to 0.29 mm and 0.48 deg within these boxes.
#[test]
fn six_poses_are_approached_by_four_bars_as_a_whole() {
    let result = found(
        "poses = [[0, 0, '0 deg'], [6, 2, '9 deg'], [12, 6, '20 deg'], [17, 12, '38 deg'], [20, 18, '55 deg'], [22, 30, '80 deg']]\n\
         linkage = 'four-bar'\npivots_in = [[-80, -80], [80, 80]]\npins_in = [[-60, -60], [60, 60]]\ncolumns = ['x(A)', 'x(D)']\n",
    );
    assert!(column(&result, "rms_error")[0] < 0.29);
    assert!(column(&result, "rms_turn")[0] < 2.0);
    for name in ["min(x(A))", "min(x(D))"] {
        let all = column(&result, name);
        assert!(all.iter().all(|x| x.abs() <= 80.0 + 1e-6), "{all:?}");
    }
}

/// Eight poses near those of a linkage: it is told how near the fit comes, and that is as near as the poses are wrong.
#[test]
fn more_poses_are_approached() {
    let mut random = Random(2);
    let mut done = 0;
    while done < 5 {
        let Some((.., made)) = bar_poses(&mut random, 8) else {
            continue;
        };
        done += 1;
        let wrong = 0.05;
        let poses: Vec<Pose> = (made.iter())
            .map(|p| {
                let off = C::new(random.uniform() - 0.5, random.uniform() - 0.5);
                Pose {
                    origin: p.origin + off.scale(wrong),
                    ..*p
                }
            })
            .collect();
        let result = found(&format!("linkage = 'four-bar'\n{}", written(&poses)));
        assert!(!result.designs.is_empty(), "{:#?}", result.listings);
        let errors = column(&result, "rms_error");
        assert!(errors.is_sorted() && errors[0] < 3.0 * wrong, "{errors:?}");
        assert!(column(&result, "miss").iter().all(|m| *m < 1e-9));
        let [least, most] = [errors[0], errors[errors.len() - 1]];
        let between = 0.5 * (least + most);
        let kept = found(&format!(
            "linkage = 'four-bar'\n{}accept = ['rms_error <= {between} mm']\nrank = 'rms_turn'\n",
            written(&poses)
        ));
        assert!(column(&kept, "rms_error").iter().all(|e| *e <= between));
        assert!(column(&kept, "rms_turn").is_sorted());
        assert!(kept.designs.len() < result.designs.len() || least == most);
        let exact = found(&format!("linkage = 'four-bar'\n{}", written(&made)));
        assert!(
            column(&exact, "rms_error")[0] < 1e-7,
            "{:?}",
            column(&exact, "rms_error")
        );
    }
}

/// Linkages of all kinds stand in one table: what a kind has not is empty.
#[test]
fn all_kinds_stand_in_one_table() {
    let result = found(&format!(
        "{HAN}crank = {{ moving = [0, 0] }}\npivots_in = [[-50, -50], [50, 50]]\npins_in = [[-40, -40], [40, 40]]\nkeep = 60\n"
    ));
    let [rocker, offset, ground] =
        ["rocker_length", "offset", "ground"].map(|name| column(&result, name));
    let mut counts = [0; 3];
    for k in 0..rocker.len() {
        let has = [rocker[k], offset[k], ground[k]].map(f64::is_finite);
        let kind = match has {
            [true, false, true] => 0,
            [false, true, false] => 1,
            [false, true, true] => 2,
            other => panic!("{other:?}"),
        };
        counts[kind] += 1;
    }
    assert!(counts.iter().all(|count| *count > 2), "{counts:?}");
    assert!(column(&result, "miss").iter().all(|m| *m < 1e-9));
    assert!(column(&result, "link_ratio").is_sorted());
}

/// What is given of a dyad is kept exactly where the poses are only approached.
#[test]
fn given_pivots_are_kept_by_fits() {
    let mut random = Random(2);
    let (fixed, crank, _, other, poses) = std::iter::repeat_with(|| bar_poses(&mut random, 7))
        .flatten()
        .next()
        .expect("one of them");
    let task = format!(
        "{}crank = {{ fixed = [{:?}, {:?}] }}\nrocker = {{ fixed_on = {} }}\nlinkage = 'four-bar'\n{COLUMNS}",
        written(&poses),
        fixed.re,
        fixed.im,
        line(other)
    );
    let result = found(&task);
    assert!(
        has_crank(&result, fixed, crank),
        "{task}{:#?}",
        result.listings
    );
    let places = column(&result, "min(x(A))");
    assert!(
        places.iter().all(|x| (x - fixed.re).abs() < 1e-9),
        "{places:?}"
    );
}

#[test]
fn parameters_stand_in_poses_and_conditions() {
    let text = "units = { length = 'mm', angle = 'deg' }\n[parameters]\nlift = 6\nturn = '20 deg'\n[studies.s]\nkind = 'synthesize'\ntask = 'motion'\n\
                poses = [[0, 0, 0], [12, 'lift * 1 mm', 'turn'], [20, '3 * lift * 1 mm', '55 deg']]\ncrank = { moving = [-10, 5] }\nrocker = { moving = ['2.5 * lift * 1 mm', 10] }\n";
    let model = Model::from_toml(text, "x", &mut |_| Err(String::new()))
        .expect("a model")
        .model;
    let result = run(&model, &model.studies[0], &mut Silent).expect("a result");
    near(column(&result, "crank_length")[0], 34.210048115629, 1e-12);
}

#[test]
fn bad_requests_are_told_by_check_and_run_alike() {
    let given = "crank = { moving = [-10, 5] }\nrocker = { moving = [15, 10] }\n";
    let cases = [
        (format!("poses = [[0, 0, 0], [12, 6, 20], [12, 6, 20]]\n{given}"), "data-repeated"),
        (format!("poses = [[0, 0, 0], [0, 0, 360]]\n{given}"), "data-repeated"),
        ("poses = [[0, 0, 0], [1, 2, 0], [3, 3, 0], [5, 2, 0], [6, 0, 0]]\n".to_owned(), "data-dependent"),
        ("poses = [[0, 0, 0], [0, 0, 20], [0, 0, 40], [0, 0, 60], [0, 0, 90]]\n".to_owned(), "data-dependent"),
        (HAN.to_owned(), "data-too-few"),
        ("poses = [[0, 0, 0], [12, 6, 20]]\npivots_in = [[0, 0], [9, 9]]\npins_in = [[0, 0], [9, 9]]\n".to_owned(), "data-too-few"),
        ("poses = [[0, 0, 0], [12, 6, 20], [20, 18, 55], [22, 20, 60]]\n".to_owned(), "data-too-few"),
        (format!("{HAN}crank = {{ moving = [-10, 5], fixed = [1, 2] }}\nrocker = {{ moving = [15, 10] }}\n"), "data-too-many"),
        (format!("{HAN}linkage = 'slider-crank'\ncrank = {{ moving = [-10, 5] }}\nrocker = {{ moving = [15, 10] }}\n"), "data-too-many"),
        ("poses = [[0, 0, 0]]\n".to_owned(), "missing-key"),
        ("poses = [[0, 0], [1, 2]]\n".to_owned(), "wrong-type"),
        (given.to_owned(), "missing-key"),
        (format!("{HAN}crank = {{ moving = [1, 2], moving_on = [[1, 2], [2, 3]] }}\n"), "contradictory-values"),
        (format!("{HAN}crank = {{ moving_on = [[1, 2], [1, 2]] }}\n"), "bad-size"),
        (format!("{HAN}linkage = 'five-bar'\n{given}"), "bad-choice"),
        (format!("{HAN}crank = {{ along = 20 }}\n"), "bad-choice"),
        (format!("{HAN}linkage = 'four-bar'\nrocker = {{ along = 20 }}\n"), "bad-choice"),
        (format!("{HAN}linkage = 'slider-crank'\nrocker = {{ fixed = [1, 2] }}\n"), "bad-choice"),
        ("poses = [[0, 0, '3 mm'], [1, 2, 3]]\n".to_owned(), "unit-mismatch"),
        (format!("{HAN}pivots_in = [1, 2]\n{given}"), "wrong-type"),
    ];
    for (task, code) in cases {
        let told = refused(&task);
        assert!(told.contains(&code), "{task}: {told:?}");
    }
    // Collinear places of a moving pivot: its link is a slider, and no four-bar does it.
    let told = refused(
        "poses = [[0, 0, 0], [10, 0, 20], [25, 0, 35]]\nlinkage = 'four-bar'\ncrank = { moving = [0, 0] }\nrocker = { moving = [15, 10] }\n",
    );
    assert_eq!(told, ["no-linkage"]);
}

/// Poses and boxes at the ends of what can be computed with: an answer or a reason, and no harm.
#[test]
fn hostile_numbers_do_no_harm() {
    let area = "pivots_in = [[-50, -50], [50, 50]]\n";
    for task in [
        format!("poses = [[0, 0, 0], [1e25, 0, 20], [3, 1e-20, 40]]\n{area}"),
        format!("poses = [[0, 0, 0], [1e-20, 0, 20], [0, 1e-20, 40], [0, 0, 50]]\n{area}"),
        "poses = [[0, 0, 0], [1e20, 1e20, 20], [2e20, 5, 40], [0, 1e20, 50], [3, 4, 5]]\n".to_owned(),
        format!("poses = [[0, 0, 0], [10, 0, 180], [0, 10, 360]]\n{area}"),
        format!("poses = [[0, 0, 0], [10, 0, 1e9], [0, 10, -1e9]]\n{area}keep = 1\n"),
        format!("poses = [[0, 0, 0], [10, 0, 1e-9], [0, 10, 2e-9]]\n{area}keep = 1\n"),
        "poses = [[0, 0, 0], [10, 0, 20], [0, 10, 50]]\npivots_in = [[5, 5], [5, 5]]\n".to_owned(),
        "poses = [[0, 0, 0], [10, 0, 20], [0, 10, 50], [5, 5, 70]]\npivots_in = [[-1e25, -1e25], [1e25, 1e25]]\n".to_owned(),
    ] {
        let told = refused(&task);
        assert!(told.len() <= 1, "{task}: {told:?}");
    }
}
