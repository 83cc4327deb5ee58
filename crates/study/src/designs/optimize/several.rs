//! Numbers of many designs at once, for searches that compare them: each is moved by itself, so that it is known which assembly it is and that it goes all the
//! way; numbers of poses are then taken in lanes, in a small part of the time. They are good to about eight digits. Who is told of a design asks it alone.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use kempe_measure::side_by_side::TOGETHER;
use kempe_mechanism::Branch;
use kempe_mechanism::plan::Step;
use kempe_model::StudyKind;
use kempe_motion::Motion;
use kempe_optimize::{Evaluation, Workers, each};
use kempe_units::Dimension;

use super::journal::lock;
use super::worth::Aims;
use crate::designs::bench::Bench;
use crate::designs::lanes::{InLanes, Reach};

/// Lanes that miss a number by more than this part of what it is at most are not asked again.
const AGREE: f64 = 1e-6;
/// Steps in which lanes look at a motion, and at every turn of a drive: far from the file's own design it may be swift.
const STEPS: usize = 720;
/// All over the box, and so swift that a curve through five places of half a degree tells six digits: it misses by the fifth power of what determinants
/// change.
const REACH: Reach = Reach {
    far_out: 1.0,
    swift: 16.0,
};
/// Of more turns lanes would have to keep too much.
const MOST_TURNS: f64 = 8.0;
/// So many designs are asked both ways before lanes are trusted.
const CHECKED: usize = 5;

/// What tells many designs at once.
pub(super) struct Several {
    lanes: InLanes,
    motion: Arc<Motion>,
    /// How the file's own design stands at the start.
    own: Branch,
    /// Whether lanes told the same as single designs so far.
    trusted: AtomicBool,
    /// Designs of which lanes told anything.
    checked: AtomicUsize,
    /// The best that was told of each goal, of designs that keep all limits.
    best: Mutex<Vec<f64>>,
}

impl Several {
    /// For designs between the least and the greatest value of every parameter; none where lanes do not tell all numbers.
    pub fn new(bench: &Bench<'_>, ranges: &[[f64; 2]]) -> Option<Self> {
        match &bench.over.kind {
            StudyKind::Motion(along) if !along.circuit => {}
            StudyKind::Forces(_) => {}
            _ => return None,
        }
        let motion = bench.own_motion()?;
        let own = bench.own_values();
        let ends = ranges.iter().zip(&own);
        let ends: Vec<[f64; 2]> = ends.map(|(ends, own)| ends.map(|end| end - own)).collect();
        // Poses that are found from others nearby may be those of another assembly far away.
        if (motion.mechanism().plan.steps.iter()).any(Step::needs_guess) {
            return None;
        }
        let (low, high) = motion.demanded;
        let turns = turns(motion);
        if turns > MOST_TURNS {
            return None;
        }
        let steps = (STEPS as f64 * turns.max(1.0)).ceil() as usize;
        let place = |k: usize| low + (high - low) * k as f64 / steps as f64;
        let places: Vec<f64> = (0..=steps).map(place).collect();
        let lanes = InLanes::new(bench, motion, &[], &places, (&ends, REACH))?;
        let all = lanes.numbers.iter().all(Option::is_some);
        (all && !lanes.has_means() && !lanes.needs_series()).then(|| Self {
            own: branch(motion),
            motion: motion.clone(),
            lanes,
            trusted: AtomicBool::new(true),
            checked: AtomicUsize::new(0),
            best: Mutex::default(),
        })
    }

    /// The numbers of designs, by their parameters, SI, in their order; none of those that are to be asked alone.
    pub fn numbers(
        &self,
        (bench, aims): (&Bench<'_>, &Aims),
        designs: &[Vec<f64>],
        workers: &dyn Workers,
    ) -> Vec<Option<Vec<f64>>> {
        if !self.trusted.load(Ordering::Relaxed) {
            return vec![None; designs.len()];
        }
        let ride = each(workers, designs.iter().collect(), |values: &Vec<f64>| {
            self.rides(bench, values)
        });
        let riding: Vec<usize> = (0..designs.len()).filter(|k| ride[*k]).collect();
        let groups: Vec<&[usize]> = riding.chunks(TOGETHER).collect();
        let told = each(workers, groups, |group| self.group(designs, group));
        let mut all = vec![None; designs.len()];
        for (k, numbers) in riding.into_iter().zip(told.into_iter().flatten()) {
            all[k] = numbers;
        }
        let to_check = self.to_check(aims, &all);
        let asked = to_check.iter().map(|k| &designs[*k]).collect();
        let exact = each(workers, asked, |values: &Vec<f64>| bench.numbers(values));
        let sizes = sizes(&all);
        let agree = to_check.iter().zip(exact).all(|(k, exact)| {
            let both = all[*k].iter().flatten().zip(exact.iter().flatten());
            exact.is_ok() && (both.zip(&sizes)).all(|((a, b), size)| (a - b).abs() <= AGREE * size)
        });
        if !agree && !bench.watch().stops() {
            self.trusted.store(false, Ordering::Relaxed);
            all.fill(None);
        }
        all
    }

    /// The numbers of some of the designs, as many as lanes take.
    fn group(&self, designs: &[Vec<f64>], group: &[usize]) -> Vec<Option<Vec<f64>>> {
        let mut told = Vec::with_capacity(group.len());
        let drawn = |lane: usize, k: usize| designs[group[lane]][k];
        let scratch = &mut self.lanes.scratch();
        (self.lanes).pieces(group.len(), drawn, scratch, |_, found, _| {
            told.extend((0..group.len()).map(|lane| {
                let numbers: Vec<f64> = found.numbers.iter().map(|n| n.0[lane]).collect();
                let sound = found.closes[lane] && !found.doubtful[lane];
                (sound && numbers.iter().all(|x| x.is_finite())).then_some(numbers)
            }));
        });
        told
    }

    /// Which designs are asked both ways: the first ones, and where one is the best so far in a goal.
    fn to_check(&self, aims: &Aims, told: &[Option<Vec<f64>>]) -> Vec<usize> {
        let known = told.iter().enumerate();
        let known = known.filter_map(|(k, numbers)| Some((k, aims.worth(numbers.as_ref()?).0)));
        let known: Vec<(usize, Evaluation)> = known.collect();
        let checked = self.checked.fetch_add(known.len(), Ordering::Relaxed);
        let first = known.iter().take(CHECKED.saturating_sub(checked));
        let mut all: Vec<usize> = first.map(|(k, _)| *k).collect();
        let mut best = lock(&self.best);
        best.resize(aims.goals, f64::INFINITY);
        for (goal, best) in best.iter_mut().enumerate() {
            let kept = known
                .iter()
                .filter(|(_, it)| it.constraints.iter().all(|c| *c <= 0.0));
            let values = kept.map(|(k, it)| (*k, it.objectives[goal]));
            if let Some((k, value)) = values.min_by(|a, b| a.1.total_cmp(&b.1))
                && value < *best
            {
                *best = value;
                all.push(k);
            }
        }
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Whether a design moves as the file's own does: all the way, in the same assembly, its angles counted alike.
    fn rides(&self, bench: &Bench<'_>, values: &[f64]) -> bool {
        let Ok(motion) = bench.motion(values, &mut bench.watch()) else {
            return false;
        };
        let (own, it) = (&self.own, branch(&motion));
        let mut angles = own.near.iter().zip(&it.near);
        motion.events.is_empty()
            && motion.demanded == self.motion.demanded
            && motion.start == self.motion.start
            && own.signs == it.signs
            && angles.all(|(a, b)| (a - b).abs() < FRAC_PI_2)
    }
}

/// How a motion stands at its start.
fn branch(motion: &Motion) -> Branch {
    let mut branch = Branch::neutral(motion.mechanism());
    motion.branch_at(motion.start, &mut branch);
    branch
}

/// How many turns the drive that turns most makes.
fn turns(motion: &Motion) -> f64 {
    let drives = &motion.mechanism().model.drives;
    let ends = <[f64; 2]>::from(motion.demanded).map(|p| {
        let mut coordinates = vec![0.0; drives.len()];
        motion.path.coordinates(p, &mut coordinates);
        coordinates
    });
    let turning = (0..drives.len()).filter(|k| drives[*k].dimension == Dimension::ANGLE);
    let ways = turning.map(|k| (ends[1][k] - ends[0][k]).abs());
    ways.fold(0.0, f64::max) / TAU
}

/// What numbers are at most.
fn sizes(all: &[Option<Vec<f64>>]) -> Vec<f64> {
    let mut sizes = Vec::new();
    for numbers in all.iter().flatten() {
        sizes.resize(numbers.len(), 0.0);
        for (size, x) in sizes.iter_mut().zip(numbers) {
            *size = f64::max(*size, x.abs());
        }
    }
    sizes
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use kempe_model::Model;
    use kempe_motion::progress::Silent;
    use kempe_number::Random;
    use kempe_optimize::{Alone, Problem};

    const ROCKER: &str = "
[parameters]
a = '20 mm'
b = '50 mm'
c = '40 mm'
px = '25 mm'
py = '10 mm'
[links]
frame   = { A = [0, 0], D = ['60 mm', 0] }
crank   = { A-B = 'a' }
coupler = { B-C = 'b', P = ['px', 'py'] }
rocker  = { D-C = 'c' }
[drives]
motor = { turns = 'crank', from = 'FROM', to = 'TO', speed = '60 rpm' }
[assembly]
C = 'left of B -> D'
[studies.turn]
kind = 'motion'
[studies.best]
kind = 'optimize'
over = 'turn'
vary = { a = ['5 mm', '60 mm'], b = ['20 mm', '120 mm'], c = ['10 mm', '120 mm'], px = ['-80 mm', '80 mm'], py = ['-80 mm', '80 mm'] }
minimize = 'GOAL'
subject_to = ['range(x(P)) >= 40 mm', 'transmission_angle(C) >= 40 deg', 'max(angle(rocker)) <= 300 deg']
";

    /// Two tops of x(P) are as high as places of half a degree tell.
    const LEVEL: [f64; 5] = [
        0.021_225_590,
        0.087_773_710,
        0.076_942_701,
        0.035_822_614,
        -0.065_478_516,
    ];

    /// Far and wide in the box, with designs that do not assemble, lock or turn over.
    #[test]
    fn many_at_once_are_worth_what_each_is() {
        let mut random = Random(7);
        let (mut told, mut all) = (0, 0);
        for (from, to) in [
            ("0 deg", "360 deg"),
            ("30 deg", "80 deg"),
            ("350 deg", "200 deg"),
            ("0 deg", "1000 deg"),
        ] {
            for goal in [
                "range(y(P))",
                "max(distance(P, D))",
                "min(angle(coupler)) / 1 deg + max(y(P)) / 1 mm",
            ] {
                let text = ROCKER
                    .replace("FROM", from)
                    .replace("TO", to)
                    .replace("GOAL", goal);
                let read = Model::from_toml(&text, "test", &mut |_| Err(String::new()));
                let model = read.unwrap().model;
                let StudyKind::Optimize(study) = &model.studies[1].kind else {
                    panic!();
                };
                let (mut bench, _) = super::super::benches(&model, study).unwrap();
                bench.begin(&mut Silent).unwrap();
                let problem = super::super::problem(&bench, study, None);
                let several = problem.several.as_ref().unwrap();
                let mut designs: Vec<Vec<f64>> = (0..160)
                    .map(|_| {
                        let ends = problem.bounds().iter();
                        ends.map(|[low, high]| low + (high - low) * random.uniform())
                            .collect()
                    })
                    .collect();
                designs.push(LEVEL.to_vec());
                let numbers = several.numbers((&bench, &problem.aims), &designs, &Alone);
                assert!(several.trusted.load(Ordering::Relaxed), "{from} {goal}");
                let sizes = sizes(&numbers);
                for (values, numbers) in designs.iter().zip(&numbers) {
                    let exact = bench.numbers(values);
                    all += usize::from(exact.is_ok());
                    let Some(numbers) = numbers else { continue };
                    told += 1;
                    for ((a, b), size) in numbers.iter().zip(exact.unwrap()).zip(&sizes) {
                        assert!(
                            (a - b).abs() <= AGREE * size,
                            "{from} {goal}: {values:?} {a} {b}"
                        );
                    }
                }
                let nearly = problem.nearly(&designs, &Alone);
                for (design, nearly) in designs.iter().zip(nearly) {
                    let exact = problem.evaluate(design);
                    assert_eq!(exact.is_defined(), nearly.is_defined());
                    assert!((exact.lack - nearly.lack).abs() < 1e-12);
                }
            }
        }
        println!("{told} of {all} designs that move are told at once");
        assert!(2 * told > all, "{told} of {all}");
    }

    /// Lanes that miss what a design alone tells are found out, and asked no more.
    #[test]
    fn lanes_that_miss_are_not_believed() {
        let text = ROCKER
            .replace("FROM", "0 deg")
            .replace("TO", "360 deg")
            .replace("GOAL", "range(y(P))");
        let read = Model::from_toml(&text, "test", &mut |_| Err(String::new()));
        let model = read.unwrap().model;
        let StudyKind::Optimize(study) = &model.studies[1].kind else {
            panic!();
        };
        let (mut bench, _) = super::super::benches(&model, study).unwrap();
        bench.begin(&mut Silent).unwrap();
        let mut problem = super::super::problem(&bench, study, None);
        // What they miss of the goal, m: a ten-thousandth of it.
        let several = problem.several.as_mut().unwrap();
        several.lanes.numbers[0].as_mut().unwrap().1 = 1e-5;
        let own = problem.variables(&bench.own_values());
        let designs: Vec<Vec<f64>> = (0..20)
            .map(|k| {
                own.iter()
                    .map(|x| x * (1.0 + 1e-3 * f64::from(k)))
                    .collect()
            })
            .collect();
        let nearly = problem.nearly(&designs, &Alone);
        let several = problem.several.as_ref().unwrap();
        assert!(!several.trusted.load(Ordering::Relaxed));
        for (design, nearly) in designs.iter().zip(nearly) {
            assert_eq!(problem.evaluate(design), nearly);
        }
    }
}
