//! Studies that ask for four-bars of which a point passes points: published numbers, round trips, bad requests.
#![allow(
    clippy::disallowed_methods,
    reason = "numbers found by hand beside ours, not reproducible ones"
)]

use std::fmt::Write as _;

use crate::told::assert_built_by_its_lengths;
use kempe_model::{Diagnostic, Model};
use kempe_number::Random;
use kempe_study::{Silent, StudyResult, run};

fn text(task: &str) -> String {
    format!(
        "title = \"t\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\n[studies.s]\nkind = \"synthesize\"\ntask = \"path\"\nkeep = 500\n{task}\n"
    )
}

fn tried(task: &str) -> Result<StudyResult, Vec<Diagnostic>> {
    let text = text(task);
    let model = Model::from_toml(&text, "t", &mut |_| Err("no files".into()))?.model;
    run(&model, &model.studies[0], &mut Silent)
}

fn found(task: &str) -> StudyResult {
    match tried(task) {
        Ok(result) => {
            for design in &result.designs {
                assert_built_by_its_lengths(&design.model, &design.file.toml);
            }
            result
        }
        Err(told) => panic!(
            "{}",
            told.iter()
                .map(|d| d.render_plain("t", task))
                .collect::<String>()
        ),
    }
}

fn code(task: &str) -> &'static str {
    match tried(task) {
        Err(told) => told[0].code,
        Ok(result) => result.diagnostics.first().map_or("", |d| d.code),
    }
}

/// A four-bar on the frame, its crank at an angle: the coupler point and the coupler's angle.
struct Bar {
    ground: f64,
    crank: f64,
    coupler: f64,
    rocker: f64,
    point: [f64; 2],
    at: [f64; 2],
    turn: f64,
    side: f64,
}

impl Bar {
    /// A crank-rocker in general position; its crank turns fully, so that every pose is on one branch.
    fn random(random: &mut Random) -> Self {
        loop {
            let mut length = |low: f64, high: f64| low + (high - low) * random.uniform();
            let bar = Self {
                crank: length(8.0, 20.0),
                ground: length(40.0, 70.0),
                coupler: length(40.0, 70.0),
                rocker: length(40.0, 70.0),
                point: [length(10.0, 50.0), length(15.0, 50.0)],
                at: [length(-30.0, 30.0), length(-30.0, 30.0)],
                turn: length(-1.0, 1.0),
                side: if length(-1.0, 1.0) > 0.0 { 1.0 } else { -1.0 },
            };
            let all = [bar.crank, bar.ground, bar.coupler, bar.rocker];
            let longest = all.iter().copied().fold(0.0, f64::max);
            let sum: f64 = all.iter().sum();
            // Grashof's condition with some room.
            if bar.crank + longest < 0.95 * (sum - bar.crank - longest) {
                return bar;
            }
        }
    }

    /// The coupler point, and the coupler's angle, as the crank stands at an angle from the frame's line.
    fn place(&self, crank: f64) -> ([f64; 2], f64) {
        let b = [self.crank * crank.cos(), self.crank * crank.sin()];
        let (dx, dy) = (self.ground - b[0], -b[1]);
        let far = dx.hypot(dy);
        let along = (self.coupler.powi(2) - self.rocker.powi(2) + far * far) / (2.0 * far);
        let off = self.side * (self.coupler.powi(2) - along * along).sqrt();
        let angle = dy.atan2(dx) + off.atan2(along);
        let (s, c) = angle.sin_cos();
        let [u, v] = self.point;
        let own = [b[0] + c * u - s * v, b[1] + s * u + c * v];
        let (s, c) = self.turn.sin_cos();
        let turned = [c * own[0] - s * own[1], s * own[0] + c * own[1]];
        (
            [self.at[0] + turned[0], self.at[1] + turned[1]],
            angle + self.turn,
        )
    }

    fn rocker_pivot(&self) -> [f64; 2] {
        let (s, c) = self.turn.sin_cos();
        [self.at[0] + self.ground * c, self.at[1] + self.ground * s]
    }

    /// Whether it is among those that were accepted.
    fn is_in(&self, result: &StudyResult) -> bool {
        let column = |name: &str| {
            result
                .table
                .column(name)
                .map_or_else(Vec::new, |c| c.values.clone())
        };
        let own = [self.ground, self.crank, self.coupler, self.rocker];
        let all = ["ground", "crank_length", "coupler_length", "rocker_length"].map(column);
        (0..result.table.rows()).any(|row| {
            let mut pairs = all.iter().zip(own);
            pairs.all(|(column, own)| (column[row] - own).abs() < 1e-5 * own)
        })
    }
}

/// Angles of a crank, one way round, no two near each other.
fn stations(random: &mut Random, count: usize) -> Vec<f64> {
    let start = std::f64::consts::TAU * random.uniform();
    let step = 5.6 / count as f64;
    (0..count)
        .map(|k| start + step * (k as f64 + 0.5 * random.uniform()))
        .collect()
}

/// Points of a four-bar's coupler point as a request has them, those before `posed` with the coupler's angle.
fn points(bar: &Bar, cranks: &[f64], posed: usize) -> String {
    let mut text = String::new();
    for (k, crank) in cranks.iter().enumerate() {
        let ([x, y], angle) = bar.place(*crank);
        let _ = match k < posed {
            true => write!(text, "[{x}, {y}, {}], ", angle.to_degrees()),
            false => write!(text, "[{x}, {y}], "),
        };
    }
    format!("points = [{}]", text.trim_end_matches(", "))
}

/// Morgan and Wampler's problem 7: five points on a line, fifteen real four-bars, each accepted or told why not.
#[test]
fn five_points_between_two_pivots_are_all_accounted_for() {
    let task = "points = [[0.50, 1.06], [-0.83, -0.27], [-0.34, 0.22], [-0.13, 0.43], [0.22, 0.78]]\ncrank = { fixed = [0, 0] }\nrocker = { fixed = [1, 0] }";
    let result = found(task);
    let listing = result
        .listings
        .iter()
        .find(|l| l.title.contains("not accepted"))
        .expect("a listing");
    assert_eq!(result.table.rows() + listing.rows.len(), 15);
    // The published one, by the lengths of its links.
    let (x, y): ([f64; 2], [f64; 2]) = (
        [-0.0877960434509, -0.851386907516],
        [0.235837391307, -1.41899202704],
    );
    let crank = (0.5_f64 + x[0]).hypot(1.06 + x[1]);
    let rocker = (0.5_f64 + y[0] - 1.0).hypot(1.06 + y[1]);
    let coupler = (x[0] - y[0]).hypot(x[1] - y[1]);
    let numbers = |text: &str| -> Vec<f64> {
        let words = text.split([' ', ',']);
        words.filter_map(|word| word.parse().ok()).collect()
    };
    let same = |row: &Vec<String>| {
        let all = numbers(&row[0]);
        let mut pairs = all.iter().zip([1.0, crank, coupler, rocker]);
        pairs.all(|(a, b)| (a - b).abs() < 1e-5 * b)
    };
    assert!(listing.rows.iter().any(same), "{:?}", listing.rows);
}

#[test]
fn nine_points_of_a_four_bar_give_it_back() {
    let mut random = Random(3);
    for _ in 0..3 {
        let bar = Bar::random(&mut random);
        let result = found(&points(&bar, &stations(&mut random, 9), 0));
        assert!(bar.is_in(&result));
    }
}

#[test]
fn poses_and_points_of_a_four_bar_give_it_back() {
    let mut random = Random(4);
    for (posed, plain) in [(4, 2), (3, 4), (2, 6), (1, 8)] {
        for _ in 0..3 {
            let bar = Bar::random(&mut random);
            let cranks = stations(&mut random, posed + plain);
            let result = found(&points(&bar, &cranks, posed));
            assert!(bar.is_in(&result), "{posed} poses, {plain} points");
        }
    }
}

#[test]
fn points_in_time_with_a_crank_give_it_back() {
    let mut random = Random(5);
    for _ in 0..20 {
        let bar = Bar::random(&mut random);
        let cranks = stations(&mut random, 5);
        let angles: Vec<String> = cranks
            .iter()
            .map(|a| (a + 0.7).to_degrees().to_string())
            .collect();
        let task = format!(
            "{}\nangles = [{}]",
            points(&bar, &cranks, 0),
            angles.join(", ")
        );
        assert!(bar.is_in(&found(&task)));
        // Three points, and both pivots.
        let [x, y] = bar.rocker_pivot();
        let task = format!(
            "{}\nangles = [{}]\ncrank = {{ fixed = [{}, {}] }}\nrocker = {{ fixed = [{x}, {y}] }}",
            points(&bar, &cranks[..3], 0),
            angles[..3].join(", "),
            bar.at[0],
            bar.at[1]
        );
        assert!(bar.is_in(&found(&task)));
    }
}

#[test]
fn points_with_both_pivots_or_the_crank_give_it_back() {
    let mut random = Random(6);
    for _ in 0..10 {
        let bar = Bar::random(&mut random);
        let cranks = stations(&mut random, 5);
        let ([x, y], pivot) = (bar.rocker_pivot(), bar.at);
        let both = format!(
            "{}\ncrank = {{ fixed = [{}, {}] }}\nrocker = {{ fixed = [{x}, {y}] }}",
            points(&bar, &cranks, 0),
            pivot[0],
            pivot[1]
        );
        assert!(bar.is_in(&found(&both)));
        // The crank as a whole: its end seen from the first point.
        let (first, _) = bar.place(cranks[0]);
        let (s, c) = (cranks[0] + bar.turn).sin_cos();
        let end = [
            pivot[0] + bar.crank * c - first[0],
            pivot[1] + bar.crank * s - first[1],
        ];
        let given = format!(
            "{}\ncrank = {{ fixed = [{}, {}], moving = [{}, {}] }}",
            points(&bar, &cranks, 0),
            pivot[0],
            pivot[1],
            end[0],
            end[1]
        );
        assert!(bar.is_in(&found(&given)));
    }
}

/// The moving pivot on a line of the coupler, whose axes begin in its point: wherever the mechanism stands.
#[test]
fn points_with_both_pivots_and_a_line_for_a_pin_give_it_back() {
    let mut random = Random(9);
    for _ in 0..20 {
        let bar = Bar::random(&mut random);
        let cranks = stations(&mut random, 4);
        let ([x, y], pivot) = (bar.rocker_pivot(), bar.at);
        let (first, _) = bar.place(cranks[0]);
        let (s, c) = (cranks[0] + bar.turn).sin_cos();
        let end = [
            pivot[0] + bar.crank * c - first[0],
            pivot[1] + bar.crank * s - first[1],
        ];
        let (s, c) = (std::f64::consts::TAU * random.uniform()).sin_cos();
        let given = format!(
            "{}\ncrank = {{ fixed = [{}, {}], moving_on = [[{}, {}], [{}, {}]] }}\nrocker = {{ fixed = [{x}, {y}] }}",
            points(&bar, &cranks, 0),
            pivot[0],
            pivot[1],
            end[0] - 7.0 * c,
            end[1] - 7.0 * s,
            end[0] + 9.0 * c,
            end[1] + 9.0 * s
        );
        assert!(bar.is_in(&found(&given)), "{given}");
    }
}

/// Cognates pass the same points: their files are moved and measured as all others.
#[test]
fn cognates_pass_the_same_points() {
    let mut random = Random(8);
    let bar = Bar::random(&mut random);
    let ([x, y], pivot) = (bar.rocker_pivot(), bar.at);
    let given = format!(
        "{}\ncrank = {{ fixed = [{}, {}] }}\nrocker = {{ fixed = [{x}, {y}] }}",
        points(&bar, &stations(&mut random, 5), 0),
        pivot[0],
        pivot[1]
    );
    let (plain, more) = (found(&given), found(&(given.clone() + "\ncognates = true")));
    assert!(bar.is_in(&more));
    // Of a crank-rocker's cognates one is a crank-rocker, too.
    assert!(more.table.rows() > plain.table.rows());
    let missed = more.table.column("miss").expect("a column");
    assert!(
        missed.values.iter().all(|miss| *miss < 1e-9),
        "{:?}",
        missed.values
    );
    assert_eq!(
        code(&(given + "\nangles = [0, 1, 2, 3, 4]\ncognates = true")),
        "contradictory-values"
    );
}

#[test]
fn what_cannot_be_answered_is_told() {
    let five = "points = [[0.5, 1.06], [-0.83, -0.27], [-0.34, 0.22], [-0.13, 0.43], [0.22, 0.78]]";
    assert_eq!(code(five), "data-too-few");
    assert_eq!(
        code(&format!("{five}\ncrank = {{ fixed = [0, 0] }}")),
        "data-too-few"
    );
    let pivots = "\ncrank = { fixed = [0, 0] }\nrocker = { fixed = [1, 0] }";
    let six = five.replace("]]", "], [3, 4]]");
    assert_eq!(code(&(six + pivots)), "data-too-many");
    let twice = five.replace("[0.22, 0.78]", "[-0.34, 0.22]");
    assert_eq!(code(&(twice + pivots)), "data-repeated");
    assert_eq!(
        code(&format!(
            "{five}\ncrank = {{ fixed = [0, 0] }}\nrocker = {{ fixed = [0, 0] }}"
        )),
        "data-repeated"
    );
    // Nothing that is given is left aside without a word.
    for more in [
        "crank = { fixed = [0, 0] }\nrocker = { fixed = [1, 0], moving = [3, 3] }",
        "crank = { fixed = [0, 0] }\nrocker = { fixed = [1, 0], moving_on = [[3, 3], [4, 3]] }",
        "crank = { moving = [3, 3] }\nangles = [0, 20, 40, 60, 80]",
    ] {
        assert_eq!(code(&format!("{five}\n{more}")), "data-too-many", "{more}");
    }
    let turned = five.replace("-0.27]", "-0.27, 20]");
    assert_eq!(code(&(turned.clone() + pivots)), "data-too-many");
    assert_eq!(
        code(&(turned + "\nangles = [0, 20, 40, 60, 80]")),
        "data-too-many"
    );
    assert_eq!(
        code(&format!("{five}\nangles = [0, 30, 60]")),
        "contradictory-values"
    );
    assert_eq!(code("points = [[0, 0], [1, 0]]"), "missing-key");
    // Points on a circle about the crank's pivot: nothing is found, which does not say that there is nothing.
    let circle = tried(
        "points = [[0, 5], [5, 0], [0, -5], [-5, 0], [3, 4]]\ncrank = { fixed = [0, 0] }\nrocker = { fixed = [10, 0] }",
    )
    .expect("an answer");
    let told: Vec<&str> = circle.diagnostics.iter().map(|d| d.code).collect();
    assert_eq!(told, ["search-incomplete", "no-linkage"]);
    assert!(
        !circle.diagnostics[1]
            .message
            .contains("no linkage of this kind")
    );
    let nine: Vec<String> = (0..9).map(|k| format!("[{k}, 0]")).collect();
    let straight = code(&format!("points = [{}]", nine.join(", ")));
    assert_eq!(straight, "data-contradictory");
}
