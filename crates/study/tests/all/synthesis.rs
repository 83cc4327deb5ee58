//! Studies that ask for linkages, from the text of a file to the files of the linkages: reference values, round trips, bad requests.
#![allow(
    clippy::disallowed_methods,
    reason = "numbers found by hand beside ours, not reproducible ones"
)]

use crate::told::{assert_built_by_its_lengths, column};
use kempe_model::{Diagnostic, Model};
use kempe_number::Random;
use kempe_study::{Silent, StudyResult, check, run};

const HEAD: &str = "title = \"t\"\nunits = { length = \"mm\", angle = \"deg\" }\n[studies.s]\nkind = \"synthesize\"\n";

fn text(task: &str) -> String {
    format!("{HEAD}{task}")
}

fn model(text: &str) -> Model {
    match Model::from_toml(text, "test", &mut |_| Err("no files".into())) {
        Ok(checked) => checked.model,
        Err(found) => panic!("{}", rendered(&found, text)),
    }
}

fn rendered(found: &[Diagnostic], text: &str) -> String {
    let lines = found.iter().map(|d| d.render_plain("test.toml", text));
    lines.collect()
}

/// What a request finds, every linkage of it run anew from its file.
fn found(task: &str) -> StudyResult {
    let text = text(task);
    let model = model(&text);
    let result = match run(&model, &model.studies[0], &mut Silent) {
        Ok(result) => result,
        Err(found) => panic!("{}", rendered(&found, &text)),
    };
    assert_eq!(result.designs.len(), result.table.rows());
    for design in &result.designs {
        again(design.file.toml.as_str(), &design.model);
    }
    result
}

/// Reads and runs a linkage's file.
fn again(text: &str, known: &Model) -> StudyResult {
    let checked = match Model::from_toml(text, "", &mut |_| Err(String::new())) {
        Ok(checked) => checked,
        Err(found) => panic!("{}\n{text}", rendered(&found, text)),
    };
    assert!(checked.model.same_as(known), "{text}");
    assert_built_by_its_lengths(known, text);
    assert!(
        checked.warnings.is_empty(),
        "{}\n{text}",
        rendered(&checked.warnings, text)
    );
    let result = match run(&checked.model, &checked.model.studies[0], &mut Silent) {
        Ok(result) => result,
        Err(found) => panic!("{}\n{text}", rendered(&found, text)),
    };
    assert_eq!(result.table.unreached(), 0, "{text}");
    result
}

fn why(result: &StudyResult) -> Vec<String> {
    let listing = result
        .listings
        .iter()
        .find(|l| l.title == "found, but not accepted");
    listing.map_or_else(Vec::new, |l| l.rows.iter().map(|r| r[1].clone()).collect())
}

/// What is told of a request that cannot be answered, by `check` and by `run` alike.
fn refused(task: &str) -> Vec<&'static str> {
    let text = text(task);
    let model = match Model::from_toml(&text, "test", &mut |_| Err("no files".into())) {
        Ok(checked) => checked.model,
        Err(found) => return found.iter().map(|d| d.code).collect(),
    };
    let told = match run(&model, &model.studies[0], &mut Silent) {
        Ok(result) => result.diagnostics,
        Err(found) => {
            let checked = check(&model).diagnostics;
            let same = found.iter().all(|d| checked.contains(d));
            assert!(
                same,
                "{}\nagainst {}",
                rendered(&found, &text),
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

/// J. Denavit's and R. S. Hartenberg's kind of problem: the linkage of least lengths.
fn lengths(result: &StudyResult, row: usize) -> [f64; 3] {
    ["crank_length", "coupler_length", "rocker_length"].map(|name| column(result, name)[row])
}

#[test]
fn three_pairs_give_the_published_four_bar_in_all_readings() {
    for (pairs, wanted) in [
        (
            "[[45, 52], [90, 82], [135, 112]]",
            [0.552585713179, 1.144725789330, 0.822207109373],
        ),
        (
            "[[52, 45], [82, 90], [112, 135]]",
            [0.822207109373, 1.144725789330, 0.552585713179],
        ),
        (
            "[[45, '52 deg + 10 arcmin'], [90, '82 deg + 10 arcmin'], [135, '112 deg + 10 arcmin']]",
            [0.540927247356, 1.138322642641, 0.803130233388],
        ),
    ] {
        let result = found(&format!(
            "task = 'function'\nground = 50\npairs = {pairs}\n"
        ));
        assert_eq!(result.designs.len(), 1);
        for (value, wanted) in lengths(&result, 0).iter().zip(wanted) {
            near(value / 50.0, wanted, 1e-12);
        }
        assert!(column(&result, "miss")[0] < 1e-12);
    }
    let offset =
        found("task = 'function'\npairs = [[45, 52], [90, 82], [135, 112]]\nzeros = [20, 30]\n");
    for (value, wanted) in lengths(&offset, 0)
        .iter()
        .zip([0.602723012, 0.914473925, 0.853851423])
    {
        near(*value, wanted, 1e-9);
    }
}

/// Chebyshev's spacing: lengths, angles at the start of the range, coupler and structural error, all real solutions; those that cannot be
/// driven through the range are listed.
#[test]
fn five_places_of_a_curve_give_the_tabulated_four_bars() {
    let log = "y = 'ln(x) / ln(10)', x = [1, 2]";
    let cases = [
        (
            "y = 'x^1.5', x = [1, 4], input = [0, 90], output = [0, 90]",
            3,
            vec![
                (5.904736370570, 5.623252390599, 0.824441312709, 0.1724),
                (2.433295301667, 1.572391542962, 2.319172911854, 0.02276),
                (11.277774065783, 3.830185228303, 7.371929959912, 0.01136),
            ],
        ),
        (
            &*format!("{log}, input = [0, 60], output = [0, 60]"),
            1,
            vec![(3.432879234679, 3.559259777356, 0.815257514300, 0.01186)],
        ),
        (
            &*format!("{log}, input = [0, 60], output = [0, 90]"),
            1,
            vec![(3.057181500381, 8.529191228270, 6.366254701163, 0.04161)],
        ),
        (
            "y = 'sin(x * 90 deg)', x = [0, 1], input = [0, 90], output = [0, 90]",
            1,
            vec![(2.075165127358, 0.756642033129, 2.410662841018, 0.2883)],
        ),
        (
            "y = '1 / x', x = [1, 2], input = [0, 90], output = [0, 90]",
            1,
            vec![(2.542728438340, 2.544960874499, 0.873010570756, 0.05674)],
        ),
    ];
    for (curve, count, wanted) in cases {
        let result = found(&format!(
            "task = 'function'\nzeros = ['free', 'free']\nfunction = {{ {curve}, points = 5 }}\ncolumns = ['max(structural_error)', 'min(structural_error)']\n"
        ));
        assert_eq!(result.designs.len() + why(&result).len(), count, "{curve}");
        for row in 0..result.designs.len() {
            let [crank, coupler, rocker] = lengths(&result, row);
            let known = wanted.iter().find(|w| (w.0 - crank).abs() < 1e-9);
            let (_, c, b, error) = known.unwrap_or_else(|| panic!("{curve}: {crank}"));
            near(rocker, *c, 1e-11);
            near(coupler, *b, 1e-11);
            let own = column(&result, "max(structural_error)")[row]
                .max(-column(&result, "min(structural_error)")[row]);
            assert!(
                (own / error - 1.0).abs() < 5e-4,
                "{curve}: {own} against {error}"
            );
        }
        assert!(!result.designs.is_empty(), "{curve}");
    }
}

#[test]
fn given_rates_give_the_published_proportions() {
    let result = found(
        "task = 'rates'\nspeeds = ['20 rad/s', '8.5 rad/s', '13 rad/s']\naccelerations = ['0 rad/s^2', '-10 rad/s^2', '-160 rad/s^2']\nground = 100\n",
    );
    let [crank, coupler, rocker] = lengths(&result, 0);
    near(coupler / crank, 2.77480413, 1e-8);
    near(rocker / crank, 1.48126161, 1e-8);
    near(100.0 / crank, 1.3617821, 1e-7);
    assert!(column(&result, "miss")[0] < 1e-12);
}

/// The loop of a four-bar from the first fixed pivot round, without its frame.
type Loop = [[f64; 2]; 3];

fn norm([x, y]: [f64; 2]) -> f64 {
    x.hypot(y)
}

/// Rates w of coupler and rocker of which those of a loop's links make nothing with the crank's and what is known besides.
fn solved([a, b, c]: Loop, first: f64, known: [f64; 2]) -> [f64; 2] {
    let right = [known[0] - first * a[0], known[1] - first * a[1]];
    let by = b[0] * c[1] - b[1] * c[0];
    [
        (right[0] * c[1] - right[1] * c[0]) / by,
        (b[0] * right[1] - b[1] * right[0]) / by,
    ]
}

/// Links that stand still, or go evenly, at the pose: 0 is asked of them, or as good as 0, and kept to what rounding leaves of the others.
#[test]
fn rates_may_be_nothing() {
    let mut random = Random(11);
    for case in 0..40 {
        let mut between = |a: f64, b: f64| a + (b - a) * random.uniform();
        let (angle, size) = (between(-3.0, 3.0), between(1.0, 4.0));
        let a = [size * angle.cos(), size * angle.sin()];
        let mut other = || {
            let (angle, size) = (angle + between(0.5, 2.5), between(1.0, 4.0));
            [size * angle.cos(), size * angle.sin()]
        };
        let parallel = a.map(|x| x * [0.6, -1.7, 2.3][case % 3]);
        let (mut vectors, still) = match case % 4 {
            0 => ([a, other(), parallel], Some(1)),
            1 => ([a, parallel, other()], Some(2)),
            _ => ([a, other(), other()], None),
        };
        let [b, c] = [vectors[1], vectors[2]];
        if (b[0] * c[1] - b[1] * c[0]).abs() < 0.3 * norm(b) * norm(c) {
            vectors[2] = [-c[1], c[0]];
            if still == Some(1) {
                continue;
            }
        }
        let crank = between(0.5, 30.0);
        let [w2, w3] = solved(vectors, crank, [0.0; 2]);
        let mut speeds = [crank, w2, w3];
        if let Some(link) = still {
            assert!(speeds[link].abs() < 1e-12 * crank, "{speeds:?}");
            speeds[link] = [0.0, 1e-9][(case / 4) % 2];
        }
        let centripetal = [0, 1].map(|axis| {
            let links = vectors.iter().zip(speeds);
            // d/dt of i w r is i a r - w^2 r: with all turned back by a right angle, a r + i w^2 r.
            let turned = links.map(|(r, w)| w * w * [r[1], -r[0]][axis]);
            turned.sum::<f64>()
        });
        let accelerations = |first: f64| {
            let [a2, a3] = solved(vectors, first, centripetal);
            [first, a2, a3]
        };
        let (none, one) = (accelerations(0.0), accelerations(1.0));
        let mut rates = none;
        if case % 4 > 1 {
            let link = case % 4 - 1;
            rates = accelerations(-none[link] / (one[link] - none[link]));
            rates[link] = 0.0;
        }
        let ground = norm([0, 1].map(|axis| vectors.iter().map(|r| r[axis]).sum()));
        let written = |all: [f64; 3], unit: &str| all.map(|x| format!("'{x} {unit}'")).join(", ");
        let result = found(&format!(
            "task = 'rates'\nspeeds = [{}]\naccelerations = [{}]\nground = {ground}\n",
            written(speeds, "rad/s"),
            written(rates, "rad/s^2")
        ));
        assert_eq!(result.designs.len(), 1, "{vectors:?}: {:?}", why(&result));
        for (found, wanted) in lengths(&result, 0).iter().zip(vectors) {
            near(*found, norm(wanted), 1e-6);
        }
    }
}

/// Where a rocker turns back: its ratio there is 0.
#[test]
fn dead_centres_are_pairs_with_a_ratio_of_nothing() {
    let mut random = Random(12);
    let mut tried = 0;
    while tried < 30 {
        let mut between = |a: f64, b: f64| a + (b - a) * random.uniform();
        let [a, b, c] = [between(0.2, 0.6), between(0.7, 1.5), between(0.7, 1.5)];
        let sides = [[a + b, c, 1.0], [(b - a).abs(), c, 1.0]];
        let turns = |[x, y, z]: [f64; 3]| x + y > z + 0.05 && y + z > x + 0.05 && z + x > y + 0.05;
        if b < a || !sides.into_iter().all(turns) {
            continue;
        }
        tried += 1;
        let output = |input: f64| {
            let (x, y) = (1.0 - a * input.cos(), -a * input.sin());
            let square = x * x + y * y;
            let cos = (b * b - square - c * c) / (2.0 * c * square.sqrt());
            y.atan2(x) + cos.acos()
        };
        // Stretched, crank and coupler are a side of a triangle above the frame.
        let far = a + b;
        let at = ((1.0 + far * far - c * c) / (2.0 * far)).acos();
        let next = at + between(0.3, 0.8);
        let [first, second] = [at, next].map(|input| (input, output(input)));
        let by = (second.1 - first.1 + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU)
            - std::f64::consts::PI;
        let result = found(&format!(
            "task = 'function'\nground = 1\npairs = [['{} rad', '{} rad', 0], ['{} rad', '{} rad']]\n",
            first.0,
            first.1,
            second.0,
            first.1 + by
        ));
        let is_it = |row| {
            let own = lengths(&result, row);
            let mut pairs = own.iter().zip([a, b, c]);
            pairs.all(|(x, y)| (x - y).abs() < 1e-6)
        };
        let rows = 0..result.designs.len();
        assert!(rows.clone().any(is_it), "{a} {b} {c}: {:?}", why(&result));
        for row in rows {
            assert!(column(&result, "miss")[row] < 1e-9);
        }
    }
    for task in [
        "ground = 50\npairs = [[10, 20, 0], [40, 44]]\n",
        "linkage = 'slider-crank'\npairs = [[20, 100, 0], [160, 40]]\n",
        "linkage = 'inverted slider-crank'\nground = 50\npairs = [[60, 150, 0]]\n",
    ] {
        let result = found(&format!("task = 'function'\n{task}"));
        assert!(!result.designs.is_empty(), "{task}: {:?}", why(&result));
        assert!(column(&result, "miss").iter().all(|m| *m < 1e-9), "{task}");
    }
}

#[test]
fn strokes_and_time_ratios_are_those_asked_for() {
    for task in [
        "swing = 60\ntime_ratio = 1.2\nrocker = 40\n",
        "swing = 60\ntime_ratio = 1.2\nrocker = 40\ncoupler = 45\n",
        "swing = 35\nrocker = 40\n",
        "stroke = 80\ntime_ratio = 1.3\n",
        "stroke = 80\ntime_ratio = 1.3\noffset = 20\n",
        "stroke = 80\ncoupler = 120\n",
    ] {
        let result = found(&format!("task = 'dead-centres'\n{task}"));
        assert!(!result.designs.is_empty(), "{task}: {:?}", why(&result));
        assert!(column(&result, "miss").iter().all(|m| *m < 1e-9), "{task}");
    }
}

/// With equal times longer couplers are ever better: the longest that is looked at is told to be that.
#[test]
fn the_best_at_the_bound_of_its_search_is_told() {
    let told = |task: &str| {
        let result = found(&format!("task = 'dead-centres'\n{task}"));
        let codes = result.diagnostics.iter().map(|d| d.code);
        codes.collect::<Vec<_>>()
    };
    assert_eq!(told("swing = 35\nrocker = 40\n"), ["at-bound"]);
    assert_eq!(told("stroke = 80\n"), ["at-bound"]);
    for free in [
        "swing = 35\nrocker = 40\ncoupler = 2000\n",
        "stroke = 80\ncoupler = 4000\n",
        "swing = 60\ntime_ratio = 1.2\n",
        "stroke = 80\ntime_ratio = 1.3\n",
    ] {
        assert!(told(free).is_empty(), "{free}");
    }
}

/// A dial that is to show a turn more does not show the same; one that begins a turn on does.
#[test]
fn whole_turns_of_the_output_count() {
    let pairs = |pairs: &str| {
        found(&format!(
            "task = 'function'\nground = 50\npairs = {pairs}\n"
        ))
    };
    let beyond = pairs("[[45, 52], [90, 82], [135, 472]]");
    assert_eq!(beyond.designs.len(), 0);
    let reason = &why(&beyond)[0];
    assert!(
        reason.contains("output is 112 deg where it should be 472 deg"),
        "{reason}"
    );
    for on in [
        "[[45, 412], [90, 442], [135, 472]]",
        "[[45, -308], [90, -278], [135, -248]]",
    ] {
        let result = pairs(on);
        assert_eq!(result.designs.len(), 1, "{on}: {:?}", why(&result));
    }
}

/// Random four-bars, sampled at pairs of angles on one branch, are among what is found, whatever their pairs' zeros.
#[test]
fn sampled_four_bars_come_back() {
    let mut random = Random(7);
    let mut between = |a: f64, b: f64| a + (b - a) * (random.uniform());
    let (mut tried, mut missed) = (0, Vec::new());
    while tried < 60 {
        let [a, b, c] = [between(0.3, 3.0), between(0.3, 3.0), between(0.3, 3.0)];
        let (from, by, side) = (
            between(-3.0, 3.0),
            between(0.4, 1.6),
            between(-1.0, 1.0).signum(),
        );
        let output = |input: f64| {
            let (x, y) = (1.0 - a * input.cos(), -a * input.sin());
            let square = x * x + y * y;
            let cos = (b * b - square - c * c) / (2.0 * c * square.sqrt());
            (cos.abs() < 0.98).then(|| y.atan2(x) + side * cos.acos())
        };
        for (count, zeros) in [(3, "[0, 0]"), (4, "[0, 'free']"), (5, "['free', 'free']")] {
            let inputs = (0..count).map(|k| from + by * k as f64 / (count - 1) as f64);
            let pairs: Option<Vec<(f64, f64)>> = inputs.map(|i| Some((i, output(i)?))).collect();
            let dense = (0..=100).all(|k| output(from + by * k as f64 / 100.0).is_some());
            let Some(pairs) = pairs.filter(|_| dense) else {
                continue;
            };
            // the rocker's angle goes on as it turns past half a turn
            let mut last = pairs[0].1;
            let list: Vec<String> = (pairs.iter())
                .map(|(i, o)| {
                    last += (o - last + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU)
                        - std::f64::consts::PI;
                    format!("['{i} rad', '{last} rad']")
                })
                .collect();
            let result = found(&format!(
                "task = 'function'\nground = '1 mm'\nzeros = {zeros}\npairs = [{}]\n",
                list.join(", ")
            ));
            tried += 1;
            let is_it = |row: usize| {
                let own = lengths(&result, row);
                own.iter()
                    .zip([a, b, c])
                    .all(|(x, y)| (x - y).abs() < 1e-5 * (1.0 + y))
            };
            if !(0..result.designs.len()).any(is_it) {
                missed.push((a, b, c, from, by, side, count, why(&result)));
            }
        }
    }
    assert!(
        missed.is_empty(),
        "{} of {tried}: {missed:#?}",
        missed.len()
    );
}

#[test]
fn conditions_and_ranks_decide() {
    let task = |more: &str| {
        format!(
            "task = 'function'\nzeros = ['free', 'free']\nfunction = {{ y = 'x^1.5', x = [1, 4], input = [0, 90], output = [0, 90], points = 5 }}\n{more}"
        )
    };
    let all = found(&task(""));
    let count = all.designs.len();
    assert!(count >= 2, "{:?}", why(&all));
    let ratios = column(&all, "link_ratio");
    assert!(ratios.is_sorted());
    let turned = found(&task("rank = '-link_ratio'\n"));
    assert_eq!(lengths(&turned, 0), lengths(&all, count - 1));
    let kept = found(&task("keep = 1\n"));
    assert_eq!(kept.designs.len(), 1);
    assert!(
        kept.listings
            .iter()
            .any(|l| l.title.contains("beyond the 1"))
    );
    // a condition on a measure with a value at every instant holds all along
    let angles = found(&task("columns = 'min(transmission_angle)'\n"));
    let least = column(&angles, "min(transmission_angle)");
    let limit = 0.5 * (least[0] + least[1]);
    for condition in ["transmission_angle", "min(transmission_angle)"] {
        let some = found(&task(&format!("accept = '{condition} >= {limit} deg'\n")));
        assert_eq!(
            some.designs.len(),
            least.iter().filter(|l| **l >= limit).count(),
            "{condition}"
        );
        assert!(
            why(&some)
                .iter()
                .any(|w| w.contains("min(transmission_angle) = ")),
            "{:?}",
            why(&some)
        );
    }
}

#[test]
fn parameters_of_the_request_stand_in_its_conditions() {
    let text = format!(
        "[parameters]\nleast = '30 deg'\nhalf = 25\n{}",
        "title = 't'\nunits = { length = 'mm', angle = 'deg' }\n[studies.s]\nkind = 'synthesize'\ntask = 'function'\npairs = [[45, 52], [90, 82], [135, 112]]\nground = '2 * half * 1 mm'\naccept = 'min(transmission_angle) >= least'\n"
            .replacen("title = 't'\nunits = { length = 'mm', angle = 'deg' }\n", "", 1)
    );
    let text = format!("units = {{ length = 'mm', angle = 'deg' }}\n{text}");
    let model = model(&text);
    let result = run(&model, &model.studies[0], &mut Silent).unwrap();
    near(column(&result, "ground")[0], 50.0, 1e-14);
    assert!(result.designs[0].file.toml.contains("least = \"30 deg\""));
}

#[test]
fn bad_requests_are_told_by_check_and_run_alike() {
    let cases = [
        (
            "task = 'function'\npairs = [[10, 20], [10, 30], [40, 50]]\n",
            "data-contradictory",
        ),
        (
            "task = 'function'\npairs = [[10, 20], [20, 30], [20, 30]]\n",
            "data-repeated",
        ),
        (
            "task = 'function'\npairs = [[10, 20], [20, 30]]\n",
            "data-too-few",
        ),
        (
            "task = 'function'\npairs = [[10, 20, 1], [20, 30, 1], [50, 70, 2]]\n",
            "data-too-many",
        ),
        ("task = 'function'\npairs = []\n", "missing-key"),
        ("task = 'function'\npairs = [[1]]\n", "wrong-type"),
        (
            "task = 'function'\npairs = [[1, '2 mm']]\n",
            "unit-mismatch",
        ),
        ("task = 'function'\n", "missing-key"),
        (
            "task = 'function'\nfunction = { y = '1 / (x - 1)', x = [1, 2], input = [0, 9], output = [0, 9] }\n",
            "not-finite",
        ),
        (
            "task = 'function'\nfunction = { y = 'x^2', x = [-1, 1], input = [0, 9], output = [0, 9] }\n",
            "not-finite",
        ),
        (
            "task = 'function'\nfunction = { y = 'z', x = [-1, 1], input = [0, 9], output = [0, 9] }\n",
            "unknown-name",
        ),
        (
            "task = 'function'\nfunction = { y = 'x', x = [1, 1], input = [0, 9], output = [0, 9] }\n",
            "bad-size",
        ),
        (
            "task = 'function'\npairs = [[45, 52], [90, 82], [135, 112]]\naccept = 'min(transmission) >= 3 deg'\n",
            "unknown-name",
        ),
        (
            "task = 'function'\npairs = [[45, 52], [90, 82], [135, 112]]\naccept = 'min(transmission_angle) >= 3 mm'\n",
            "unit-mismatch",
        ),
        (
            "task = 'function'\npairs = [[45, 52], [90, 82], [135, 112]]\naccept = 'torque(motor) >= 3'\n",
            "unit-mismatch",
        ),
        (
            "task = 'function'\npairs = [[45, 52], [90, 82], [135, 112]]\nrank = 'torque(motor)'\n",
            "needs-forces-study",
        ),
        (
            "task = 'function'\npairs = [[45, 52], [90, 82], [135, 112]]\ncolumns = ['x(Q)']\n",
            "unknown-name",
        ),
        (
            "task = 'function'\npairs = [[45, 52], [90, 82], [135, 112]]\nkeep = 0\n",
            "bad-size",
        ),
        ("task = 'functoin'\n", "bad-choice"),
        (
            "task = 'rates'\nspeeds = [1, 2]\naccelerations = [1, 2, 3]\n",
            "wrong-type",
        ),
        (
            "task = 'rates'\nspeeds = [1, 1, 2]\naccelerations = [0, 0, 1]\n",
            "data-dependent",
        ),
        (
            "task = 'rates'\nspeeds = [0, 8.5, 13]\naccelerations = [0, 50, -160]\n",
            "data-contradictory",
        ),
        (
            "task = 'rates'\nspeeds = [0, 8.5, 13]\naccelerations = [5, 50, -160]\n",
            "data-contradictory",
        ),
        (
            "task = 'rates'\nspeeds = ['1e-9 rad/s', '8.5 rad/s', '13 rad/s']\naccelerations = [0, 50, -160]\n",
            "data-contradictory",
        ),
        ("task = 'dead-centres'\nswing = 190\n", "data-out-of-range"),
        ("task = 'dead-centres'\n", "missing-key"),
        (
            "task = 'dead-centres'\nswing = 10\nstroke = 10\n",
            "contradictory-values",
        ),
        (
            "task = 'dead-centres'\nstroke = 80\ntime_ratio = 1.5\ncoupler = 10\n",
            "no-answer",
        ),
    ];
    for (task, code) in cases {
        let told = refused(task);
        assert!(told.contains(&code), "{task}: {told:?}");
    }
}

/// What depends on the rest is named as the file has it.
#[test]
fn what_says_nothing_more_is_called_by_its_name() {
    for (task, name) in [
        (
            "pairs = [[0, 0], [30, 30], [60, 60]]",
            "where the dials show 0",
        ),
        (
            "function = { y = 'x', x = [0, 1], input = [0, 60], output = [0, 60] }",
            "where the dials show 0",
        ),
        (
            "zeros = ['free', 'free']\npairs = [[0, 0], [20, 20], [30, 30], [45, 45], [60, 60]]",
            "pair 4",
        ),
    ] {
        let text = text(&format!("task = 'function'\n{task}\n"));
        let told = run(&model(&text), &model(&text).studies[0], &mut Silent).expect_err(task);
        assert_eq!(told[0].code, "data-dependent");
        assert!(told[0].message.starts_with(name), "{}", told[0].message);
    }
}

/// Whatever a user writes, there is an answer: linkages, reasons or diagnostics.
#[test]
fn hostile_numbers_do_no_harm() {
    let values = [
        "0", "1e-300", "1e300", "-1e9", "90", "180", "360", "1e-9", "45",
    ];
    let mut random = Random(3);
    let mut pick = || values[((random.uniform()) * values.len() as f64) as usize % values.len()];
    for k in 0..400 {
        let count = 2 + k % 5;
        let pairs: Vec<String> = (0..count)
            .map(|_| format!("[{}, {}]", pick(), pick()))
            .collect();
        let linkage = ["four-bar", "slider-crank", "inverted slider-crank"][k % 3];
        let zeros = ["[0, 0]", "['free', 'free']", "[0, 'free']"][k / 3 % 3];
        let text = text(&format!(
            "task = 'function'\nlinkage = '{linkage}'\nzeros = {zeros}\npairs = [{}]\n",
            pairs.join(", ")
        ));
        if let Ok(checked) = Model::from_toml(&text, "test", &mut |_| Err(String::new())) {
            let _ = run(&checked.model, &checked.model.studies[0], &mut Silent);
        }
    }
}

/// A crank that is said to turn all around does, and no other.
#[test]
fn cranks_turn_fully_where_it_is_said() {
    let mut random = Random(17);
    let mut seen = [[0; 2]; 3];
    let kinds = ["four-bar", "slider-crank", "inverted slider-crank"];
    for k in 0..120 {
        let mut between = |a: f64, b: f64| a + (b - a) * random.uniform();
        let kind = k % 3;
        let mut outputs = [
            between(20.0, 160.0),
            between(20.0, 160.0),
            between(20.0, 160.0),
        ];
        outputs.sort_by(f64::total_cmp);
        let count = if kind == 2 { 2 } else { 3 };
        let first = between(0.0, 90.0);
        let pairs: Vec<String> = (outputs.iter().take(count).enumerate())
            .map(|(k, output)| match kind {
                1 => format!("[{}, '{output} mm']", first + 40.0 * k as f64),
                _ => format!("[{}, {output}]", first + 40.0 * k as f64),
            })
            .collect();
        let ground = if kind == 1 { "" } else { "ground = '50 mm'" };
        let text = text(&format!(
            "task = 'function'\nlinkage = '{}'\n{ground}\npairs = [{}]\ncolumns = ['full_turn']\n",
            kinds[kind],
            pairs.join(", ")
        ));
        let asked = model(&text);
        let Ok(result) = run(&asked, &asked.studies[0], &mut Silent) else {
            continue;
        };
        for (row, design) in result.designs.iter().enumerate() {
            let full = column(&result, "full_turn")[row];
            let line = design.file.toml.lines().find(|l| l.starts_with("motor = "));
            let from = line.and_then(|l| l.split("from = \"").nth(1)?.split(' ').next());
            let from: f64 = from.expect("a start").parse().expect("a number");
            let around = design.file.toml.replace(
                line.expect("a drive"),
                &format!(
                    "motor = {{ turns = \"crank\", from = \"{from} deg\", to = \"{} deg\", speed = \"1 rad/s\" }}",
                    from + 360.0
                ),
            );
            let read = Model::from_toml(&around, "", &mut |_| Err(String::new()));
            let moved = read.expect("a file").model;
            let moved = run(&moved, &moved.studies[0], &mut Silent);
            let turns = moved.is_ok_and(|moved| moved.table.unreached() == 0);
            assert_eq!(turns, full >= 0.0, "{full}\n{around}");
            seen[kind][usize::from(turns)] += 1;
        }
    }
    assert!(seen.iter().flatten().all(|count| *count > 0), "{seen:?}");
}
