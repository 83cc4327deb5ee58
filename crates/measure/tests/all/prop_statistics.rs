//! Numbers over a motion against dense samples of the same measures, and how many samples they take.
#![allow(clippy::unwrap_used, clippy::disallowed_methods)]

use std::cell::Cell;
use std::rc::Rc;

use crate::support::{Case, Rng};
use kempe_measure::{ForceSource, Sampler, Series, State};
use kempe_model::{ForceMeasure, Measure};
use kempe_number::{Jet, Number};

/// Measures of a four-bar, smooth and with kinks; `K` is a place that its point passes.
const MEASURES: [&str; 14] = [
    "x(P)",
    "speed(P)",
    "rate(y(P), 2)",
    "abs(x(P) - K)",
    "max(x(P), y(P))",
    "angle(rocker)",
    "sin(7 * motor)",
    "path_length(P)",
    "d(x(P), motor, 2)",
    "abs(angular_speed(rocker))",
    "x(P) * y(P) + x(P) * x(P)",
    "min(abs(cos(3 * motor)), 0.4)",
    "curvature(B)",
    "rate(y(P), 3)",
];

/// A four-bar whose crank turns fully, by a random law.
fn four_bar(rng: &mut Rng, measures: &str) -> String {
    let short = rng.range(10.0, 25.0);
    let (coupler, rocker) = (rng.range(55.0, 80.0), rng.range(50.0, 70.0));
    let base = rng.range(60.0, 75.0);
    let from = rng.range(-180.0, 180.0);
    let law = match rng.below(4) {
        0 => format!(
            "from = {from:e}, to = {:e}, speed = \"90 rpm\"",
            from + 360.0
        ),
        1 => format!(
            "from = {from:e}, to = {:e}, speed = \"90 rpm\"",
            from + rng.range(20.0, 700.0)
        ),
        2 => format!(
            "from = {from:e}, to = {:e}, law = \"cycloidal\", in = 2",
            from + rng.range(20.0, 300.0)
        ),
        _ => format!(
            "from = {from:e}, law = [{{ rise = {:e}, in = {:e} }}, {{ dwell = 0.3 }}, {{ fall = {:e}, in = 1 }}]",
            rng.range(20.0, 200.0),
            rng.range(0.1, 2.0),
            rng.range(20.0, 200.0)
        ),
    };
    format!(
        "units = {{ length = \"mm\", angle = \"deg\" }}
[links]
frame = {{ A = [0, 0], D = [{base:e}, 0] }}
crank = {{ A-B = {short:e} }}
coupler = {{ B-C = {coupler:e}, P = [20, 15] }}
rocker = {{ D-C = {rocker:e} }}
[drives]
motor = {{ turns = \"crank\", {law} }}
[assembly]
C = \"left of B -> D\"
[measures]
{measures}
"
    )
}

#[test]
fn numbers_over_a_motion_are_those_of_dense_samples() {
    const DENSE: usize = 3000;
    let mut rng = Rng(41);
    let mut compared = 0;
    for _ in 0..24 {
        let place = rng.range(-5.0, 40.0);
        let mut texts = String::new();
        for (index, measure) in MEASURES.iter().enumerate() {
            let measure = measure.replace('K', &format!("{place:e} mm"));
            texts += &format!("v{index} = \"{measure}\"\n");
            for statistic in ["min", "max", "range", "mean"] {
                texts += &format!("{statistic}{index} = \"{statistic}(v{index})\"\n");
            }
        }
        let case = Case::read(&four_bar(&mut rng, &texts), "statistics.toml");
        let motion = case.must_move();
        let all: Vec<&Measure> = case.model.measures.iter().map(|m| &m.measure).collect();
        let mut sampler = Sampler::new(&motion, &all).unwrap();
        let duration = sampler.duration();
        let rows: Vec<Vec<f64>> = (0..=DENSE)
            .map(|k| duration * (k as f64 / DENSE as f64))
            .map(|t| sampler.at_time(t).values)
            .collect();
        for index in 0..MEASURES.len() {
            let column = 5 * index;
            let values: Vec<f64> = rows.iter().map(|row| row[column]).collect();
            let [low, high, range, mean] = [1, 2, 3, 4].map(|k| rows[0][column + k]);
            let what = format!("{}: {low} {high} {mean}\n{}", MEASURES[index], case.text);
            let dense_low = values.iter().copied().fold(f64::INFINITY, f64::min);
            let dense_high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            if !values.iter().all(|v| v.is_finite()) {
                continue;
            }
            compared += 1;
            let (size, all) = (
                dense_low.abs().max(dense_high.abs()),
                dense_high - dense_low,
            );
            let rounding = 1e-12 * size;
            // No row lies beyond, and not much lies beyond the rows: a jump between two of them at most.
            assert!(low <= dense_low + rounding, "{dense_low} {what}");
            assert!(high >= dense_high - rounding, "{dense_high} {what}");
            assert!(
                dense_low - low <= 0.02 * all + rounding,
                "{dense_low} {what}"
            );
            assert!(
                high - dense_high <= 0.02 * all + rounding,
                "{dense_high} {what}"
            );
            assert!((range - (high - low)).abs() <= rounding, "{what}");
            let inner: f64 = values[1..DENSE].iter().sum();
            let trapezoids = (inner + 0.5 * (values[0] + values[DENSE])) / DENSE as f64;
            assert!(
                (mean - trapezoids).abs() <= 2e-3 * all + rounding,
                "{trapezoids} {what}"
            );
        }
    }
    assert!(compared > 200, "{compared}");
}

/// Zeros of what has a kink there are found to the last bits, and the extremes beside them too.
#[test]
fn kinks_are_closed_in_on_from_both_sides() {
    let mut rng = Rng(43);
    for _ in 0..40 {
        let (from, at) = (rng.range(-1.0, 1.0), rng.range(0.2, 5.0));
        let text = format!(
            "units = {{ length = \"mm\", angle = \"rad\" }}
[links]
frame = {{ A = [0, 0] }}
crank = {{ A-B = 20 }}
[drives]
motor = {{ turns = \"crank\", from = {from:e}, to = {:e}, speed = 1 }}
[measures]
low = \"min(abs(motor / 1 rad - {:e}) + 0.25)\"
high = \"max(2 - abs(sin(motor - {:e} rad)))\"
bend = \"max(sin(motor)) + max(cos(motor))\"
half = \"mean(abs(motor / 1 rad - {:e}))\"
",
            from + 7.0,
            from + at,
            from + at,
            from + at
        );
        let case = Case::read(&text, "kinks.toml");
        let motion = case.must_move();
        let all: Vec<&Measure> = case.model.measures.iter().map(|m| &m.measure).collect();
        let values = Sampler::new(&motion, &all).unwrap().at_time(0.0).values;
        let half = 0.5 * (at * at + (7.0 - at) * (7.0 - at)) / 7.0;
        let allowed = [4e-15, 4e-15, 4e-15, 1e-13];
        for ((found, truth), allowed) in values.iter().zip([0.25, 2.0, 2.0, half]).zip(allowed) {
            assert!((found - truth).abs() < allowed, "{found} {truth} {text}");
        }
    }
}

/// Forces that count how often they are solved: a torque that follows the crank.
struct Counting {
    solved: Rc<Cell<usize>>,
    now: Series<f64>,
}

impl ForceSource for Counting {
    fn measures(&self) -> &[Measure] {
        &[]
    }

    fn solve(&mut self, state: &State<f64>, _: &[Series<f64>]) {
        self.solved.set(self.solved.get() + 1);
        let angle = state.abscissa.clock;
        let series = (angle * 2.0).sin_cos().0 + (angle * 3.0).sin_cos().1;
        let known = |k: usize| {
            if k < 3 {
                series.coefficient(k)
            } else {
                f64::NAN
            }
        };
        self.now = Jet::from_coefficients(std::array::from_fn(known));
    }

    fn answer(&self, _: &ForceMeasure) -> Series<f64> {
        self.now
    }
}

/// Many numbers of one motion take hardly more solutions than one: those of the grid, and a few at each extreme.
#[test]
fn numbers_over_a_motion_share_their_samples() {
    let text = "units = { length = \"mm\", angle = \"rad\" }
[links]
frame = { A = [0, 0] }
crank = { A-B = 20 }
[drives]
motor = { turns = \"crank\", from = 0, to = \"360 deg\", speed = \"1 rad/s\" }
[measures]
torque1 = \"torque(motor)\"
low = \"min(torque1)\"
high = \"max(torque1)\"
all = \"range(torque1)\"
mean1 = \"mean(torque1)\"
ratio = \"time_ratio(torque1)\"
mean2 = \"mean(power(motor))\"
";
    let case = Case::read(text, "counting.toml");
    let motion = case.must_move();
    let all: Vec<&Measure> = case.model.measures.iter().map(|m| &m.measure).collect();
    let solved = Rc::new(Cell::new(0));
    let source = Counting {
        solved: solved.clone(),
        now: Series::from_f64(f64::NAN),
    };
    let mut sampler = Sampler::with_forces(&motion, &all, source).unwrap();
    let taken = solved.get();
    assert!((360..420).contains(&taken), "{taken} solutions");
    let values = sampler.at_time(0.0).values;
    let dense = |k: u32| {
        let angle = f64::from(k) * std::f64::consts::TAU / 1e6;
        (2.0 * angle).sin() + (3.0 * angle).cos()
    };
    let high = (0..1_000_000).map(dense).fold(f64::NEG_INFINITY, f64::max);
    assert!((values[2] - high).abs() < 1e-10, "{} {high}", values[2]);
    assert!(values[4].abs() < 1e-13, "{}", values[4]);
}
