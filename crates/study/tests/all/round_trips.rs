//! Ten thousand random linkages, read in some positions, whose lengths a study finds again.
//!
//! Takes half an hour on two cores: `cargo nextest run -p kempe-study --run-ignored only -E 'test(round_trips)' --no-capture`.

use std::fmt::Write as _;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;

use kempe_model::Model;
use kempe_number::Random;
use kempe_number::math::{acos, atan2, cos, hypot, sin};
use kempe_study::{Silent, StudyResult, run};

const CASES: u64 = 10_000;
/// The lengths by their names in the file.
const NAMES: [&str; 4] = ["crank", "coupler", "rocker", "ground"];

/// A four-bar whose rocker is read at some angles of its crank, some of its lengths not known.
struct Case {
    lengths: [f64; 4],
    side: f64,
    /// Angles of the crank and what the rocker's was there, rad.
    pairs: Vec<[f64; 2]>,
    unknown: Vec<usize>,
    /// The lengths in the file, of which the unknown ones are off.
    written: [f64; 4],
}

/// The rocker's angle at one of the crank's, both from the line of the pivots, by the law of cosines.
fn closure([a, b, c, d]: [f64; 4], side: f64, crank: f64) -> Option<f64> {
    let (x, y) = (a * cos(crank) - d, a * sin(crank));
    let r = hypot(x, y);
    let cosine = (c * c + r * r - b * b) / (2.0 * c * r);
    // What nearly lies in line is read with no digits.
    (cosine.abs() < 0.98).then(|| atan2(y, x) - side * acos(cosine))
}

impl Case {
    fn new(seed: u64) -> Option<Self> {
        let mut random = Random(seed);
        let mut number = |low: f64, high: f64| low + (high - low) * random.uniform();
        let lengths = [
            number(20.0, 80.0),
            number(60.0, 160.0),
            number(40.0, 120.0),
            number(60.0, 160.0),
        ];
        let side = if number(-1.0, 1.0) > 0.0 { 1.0 } else { -1.0 };
        let count = 2 + (seed % 3) as usize;
        let unknown: Vec<usize> = match seed % 4 {
            0 | 1 => vec![0, 1],
            2 => vec![1, 2],
            _ => vec![0, 2],
        };
        let mut angle = number(-3.0, 3.0);
        let mut pairs = Vec::new();
        for _ in 0..count {
            pairs.push([angle, closure(lengths, side, angle)?]);
            angle += number(0.2, 0.6);
        }
        // One motion leads through them.
        let (first, last) = (pairs[0][0], pairs[count - 1][0]);
        for k in 0..=40 {
            closure(lengths, side, first + (last - first) * f64::from(k) / 40.0)?;
        }
        let mut written = lengths;
        for k in &unknown {
            written[*k] *= number(0.85, 1.15);
        }
        Some(Self {
            lengths,
            side,
            pairs,
            unknown,
            written,
        })
    }

    fn text(&self) -> String {
        let mut text =
            "title = \"t\"\nunits = { length = \"mm\", angle = \"rad\" }\n[parameters]\n"
                .to_owned();
        for (name, length) in NAMES.iter().zip(self.written) {
            let _ = writeln!(text, "{name}_length = \"{length} mm\"");
        }
        let first = self.pairs[0][0];
        let last = self.pairs[self.pairs.len() - 1][0];
        let side = if self.side > 0.0 { "left" } else { "right" };
        let unknown: Vec<String> = (self.unknown.iter())
            .map(|k| format!("{}_length", NAMES[*k]))
            .collect();
        let rows: Vec<String> = (self.pairs.iter())
            .map(|[crank, rocker]| format!("{{ motor = {crank}, rocker = {rocker} }}"))
            .collect();
        let _ = write!(
            text,
            "[links]\nframe = {{ A = [0, 0], D = [\"ground_length\", 0] }}\ncrank = {{ A-B = \"crank_length\" }}\n\
             coupler = {{ B-C = \"coupler_length\" }}\nrocker = {{ D-C = \"rocker_length\" }}\n[assembly]\nC = \"{side} of B -> D\"\n\
             [drives]\nmotor = {{ turns = \"crank\", from = {first}, to = {last}, speed = \"1 rad/s\" }}\n\
             [studies.s]\nkind = \"adjust\"\nunknown = {unknown:?}\nmatch = [{}]\n",
            rows.join(", ")
        );
        text
    }

    /// By how much the nearest of the answers is off, in parts of the lengths; what is told where there is none.
    fn off(&self) -> Result<f64, String> {
        let text = self.text();
        let model = Model::from_toml(&text, "t", &mut |_| Err("no files".into()));
        let model = model.map_err(|told| format!("{told:?}"))?.model;
        let result = run(&model, &model.studies[0], &mut Silent);
        let result = result.map_err(|told| told[0].message.clone())?;
        let best = self.unknown.iter().map(|k| {
            let name = format!("{}_length", NAMES[*k]);
            let own = result.scalars.iter().find(|s| s.name == name);
            own.map_or(f64::INFINITY, |s| (s.value / self.lengths[*k] - 1.0).abs())
        });
        let best = best.fold(0.0, f64::max);
        match best > 1e-6 && self.is_listed(&result) {
            true => Ok(0.0),
            false => Ok(best),
        }
    }

    /// Whether the lengths are told among other values that do as well, to the digits that are told there.
    fn is_listed(&self, result: &StudyResult) -> bool {
        let rows = result.listings.iter().flat_map(|listing| &listing.rows);
        let mut texts = rows.map(|row| row.join(" "));
        texts.any(|text| {
            self.unknown.iter().all(|k| {
                let name = format!("{}_length = ", NAMES[*k]);
                let Some((_, behind)) = text.split_once(&name) else {
                    return false;
                };
                let number = behind.split_whitespace().next().unwrap_or("");
                let told: f64 = number.parse().unwrap_or(f64::NAN);
                (told / self.lengths[*k] - 1.0).abs() < 1e-4
            })
        })
    }
}

#[test]
#[ignore = "an hour on two cores"]
fn ten_thousand_adjustments() {
    let next = AtomicU64::new(1);
    let tried = AtomicU64::new(0);
    let missed = thread::scope(|scope| {
        let count = thread::available_parallelism().map_or(1, usize::from);
        let work = || {
            let mut missed = Vec::new();
            while tried.load(Ordering::Relaxed) < CASES {
                let seed = next.fetch_add(1, Ordering::Relaxed);
                let Some(case) = Case::new(seed) else {
                    continue;
                };
                let done = tried.fetch_add(1, Ordering::Relaxed);
                if done.is_multiple_of(500) {
                    println!("{done}");
                }
                match case.off() {
                    Ok(off) if off < 1e-6 => {}
                    Ok(off) => missed.push(format!("{seed}: off by {off:e}")),
                    Err(why) => missed.push(format!("{seed}: {why}")),
                }
            }
            missed
        };
        let all: Vec<_> = (0..count).map(|_| scope.spawn(work)).collect();
        let all = all.into_iter().map(|it| it.join().expect("no panic"));
        all.flatten().collect::<Vec<String>>()
    });
    println!("{} missed of {CASES}:\n{}", missed.len(), missed.join("\n"));
    assert!(missed.len() as u64 * 1000 <= CASES);
}

/// A few of them.
#[test]
fn some_adjustments() {
    let cases = (1..).filter_map(Case::new).take(8);
    for case in cases {
        let off = case.off();
        assert!(
            off.as_ref().is_ok_and(|off| *off < 1e-6),
            "{off:?}\n{}",
            case.text()
        );
    }
}
