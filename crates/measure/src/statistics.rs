//! Numbers over a whole motion: extremes located between rows, means integrated, ratios of times.
//!
//! All numbers that can be found together share their samples (`survey`): at each the mechanism is solved once, as series in
//! time, and every measure is read from that. From the series extremes are located (`extremes`) and means integrated (`mean`).
//! The samples stand between the knots of the laws (`stretches`), and of the loads' curves where forces are asked for
//! (`knots`). A number over a motion that another contains is found in a round before it.

mod extremes;
mod knots;
mod mean;
mod nature;
mod pole;
mod resolve;
mod reversals;
mod rivals;
mod rounds;
mod stretches;
mod survey;
mod time_ratio;

pub(crate) use self::nature::may_fold;
pub(crate) use self::reversals::{BESIDE as BESIDE_TURNS, Slide, turns_between};
pub(crate) use self::rounds::rounds;
use self::time_ratio::strokes;
pub(crate) use self::time_ratio::{cycle_of, time_ratio};

use kempe_model::{Measure, Statistic};
use kempe_motion::progress::Progress;

use self::extremes::Search;
use self::mean::Mean;
use self::pole::Pole;
use self::stretches::{parted, stretches};
use self::survey::{Closely, Point, survey};
use crate::extremes::Extremes;
use crate::force_source::ForceSource;
use crate::measure::{ORDER, order_of};
use crate::sampler::{Asked, Sampler};
use crate::statistic_note::StatisticNote;

/// Two values at one place of a drive that differ by no more than this part of them, or than rounding leaves of nothing (SI), are one.
const AS_MUCH: f64 = 1e-9;
const ROUNDING: f64 = 1e-12;
/// So many times at which a drive is at a place again are looked at.
const PASSINGS: usize = 16;

/// A measure on its way over the motion.
struct Course {
    /// It alone.
    asked: Asked,
    /// How many coefficients of its series are known.
    known: usize,
    extremes: Option<Search>,
    mean: Option<Mean>,
    /// Where it is infinite.
    poles: Vec<Pole>,
}

/// Numbers over the motion, with what is known and to be told of them.
#[derive(Default)]
pub(crate) struct Numbers {
    /// Their values, in the order asked for; NaN where the motion does not reach.
    pub values: Vec<f64>,
    /// Extremes of the measures.
    pub known: Vec<Extremes>,
    /// What is to be told, by the index of the number.
    pub notes: Vec<(usize, StatisticNote)>,
    /// Times at which it had to be looked closely.
    pub closely: Vec<f64>,
}

/// Evaluates statistics of measures over the motion, SI; `None` when stopped.
///
/// No statistic may contain another that is not known to the sampler yet: see [`rounds`].
pub(crate) fn over_motion<F: ForceSource>(
    sampler: &mut Sampler<F>,
    statistics: &[(Statistic, Measure)],
    progress: &mut dyn Progress,
) -> Option<Numbers> {
    let mut measures: Vec<&Measure> = Vec::new();
    let mut courses: Vec<Course> = Vec::new();
    for (statistic, measure) in statistics {
        if matches!(statistic, Statistic::At { .. }) {
            continue;
        }
        let place = measures.iter().position(|m| *m == measure);
        let place = place.unwrap_or_else(|| {
            measures.push(measure);
            courses.push(Course::new(sampler, measure));
            courses.len() - 1
        });
        let course = &mut courses[place];
        match statistic {
            Statistic::Mean => course.mean = Some(Mean::default()),
            _ => {
                let wanted = match statistic {
                    Statistic::Min => [true, false],
                    Statistic::Max => [false, true],
                    _ => [true; 2],
                };
                let search = course
                    .extremes
                    .get_or_insert_with(|| Search::new(sampler.duration()));
                (search.wanted.iter_mut().zip(wanted)).for_each(|(all, own)| *all |= own);
            }
        }
    }
    let duration = sampler.duration();
    let (mut too_fast, mut looked_closely) = (Vec::new(), Vec::new());
    if !courses.is_empty() {
        let together = sampler.asked(&measures);
        let mut stretches = stretches(sampler);
        if together.forces {
            let curves = sampler.forces().curves();
            let knots = knots::passed(sampler, &curves, &stretches, progress)?;
            stretches = parted(&stretches, &knots, duration);
        }
        let unseen = survey(
            sampler,
            &together,
            &stretches,
            progress,
            &mut |sampler, before, now| {
                for (index, course) in courses.iter_mut().enumerate() {
                    let before = before.map(|sample| sample.point(index));
                    course.add(sampler, before, now.point(index));
                }
                courses.iter().any(Course::goes_on)
            },
        )?;
        too_fast = unseen.too_fast;
        looked_closely = unseen.closely;
        for (index, between) in unseen.unbounded {
            if let Some(course) = courses.get_mut(index) {
                course.run_away(sampler, between, duration);
            }
        }
    }
    // Means that ask for forces look at the same places closely, and so do those that do not.
    let mut closely = [true, false].map(|forces| {
        let means = measures.iter().zip(&courses);
        let own =
            means.filter(|(_, course)| course.mean.is_some() && course.asked.forces == forces);
        Closely::new(sampler, own.map(|(measure, _)| *measure).collect())
    });
    let mut notes = Vec::new();
    let mut counted: Vec<(usize, [f64; 2])> = Vec::new();
    let values = (statistics.iter().enumerate())
        .map(|(number, (statistic, measure))| {
            if let Statistic::At { drive, value } = statistic {
                let at = kempe_model::value(value, sampler.parameters());
                let time = match drive {
                    Some(drive) => sampler.time_of(*drive, at),
                    None => sampler.within(at),
                };
                let Some(time) = time else { return f64::NAN };
                let asked = sampler.asked(&[measure]);
                let own = Point::take(sampler, &asked, time).value();
                let later = drive.map(|drive| sampler.times_after(time, drive, at));
                let other = |time: &f64| {
                    let there = Point::take(sampler, &asked, *time).value();
                    (there - own).abs() > AS_MUCH * own.abs().max(there.abs()) + ROUNDING
                };
                if let Some(again) = later.into_iter().flatten().take(PASSINGS).find(other) {
                    notes.push((number, StatisticNote::PassedAgain { first: time, again }));
                }
                return own;
            }
            let place = measures.iter().position(|m| *m == measure);
            let Some(course) = place.and_then(|place| courses.get(place)) else {
                return f64::NAN;
            };
            let mut tell = |note| notes.push((number, note));
            let by_loads = course.asked.forces && too_fast.contains(&None);
            if by_loads || too_fast.contains(&place) {
                tell(StatisticNote::TooFast);
            }
            if let (Statistic::Mean, Some(mean)) = (statistic, &course.mean) {
                let steep = course.poles.iter().find(|pole| !pole.is_integrable());
                if let Some(pole) = steep {
                    tell(StatisticNote::Diverges { time: pole.time });
                    return f64::NAN;
                }
                let closely = &mut closely[usize::from(!course.asked.forces)];
                let mut take = |time| closely.take(sampler, measure, time);
                let (mean, digits) = mean.finish(&mut take, course.known, duration, &course.poles);
                if let Some(digits) = digits {
                    tell(StatisticNote::Unsettled { digits });
                }
                return mean;
            }
            let Some((low, high)) = course.extremes.as_ref().and_then(Search::found) else {
                if let Some(pole) = course.poles.first() {
                    tell(StatisticNote::Infinite { time: pole.time });
                }
                return f64::NAN;
            };
            let (ends, value) = match statistic {
                Statistic::Min => ([low, low], low.1),
                Statistic::Max => ([high, high], high.1),
                Statistic::Range => ([low, high], high.1 - low.1),
                _ => {
                    let cycle = cycle_of(sampler, measure, high.1 - low.1);
                    let ratio = cycle.map(|part| {
                        let rivals = course.extremes.as_ref().map(Search::rivals);
                        let rivals = rivals.unwrap_or_default();
                        let cycle = part * duration;
                        let own = strokes([low.0, high.0], &rivals, cycle);
                        if let Some((again, other)) = own.other {
                            let side = usize::from(again[0] == own.ends[0]);
                            tell(StatisticNote::ExtremeAgain {
                                largest: side == 1,
                                first: own.ends[side],
                                again: again[side],
                                other,
                            });
                        }
                        counted.extend(place.map(|place| (place, own.ends)));
                        time_ratio(own.ends[1] - own.ends[0], cycle)
                    });
                    ([low, high], ratio.unwrap_or(f64::NAN))
                }
            };
            // At a pole or right at a sample. The smallest value of what runs away upwards alone is as good as any.
            if let Some((time, _)) = ends.into_iter().find(|at| at.1.is_infinite()) {
                tell(StatisticNote::Infinite { time });
            }
            value
        })
        .collect();
    let known = (measures.iter().zip(&courses).enumerate())
        .map(|(place, (measure, course))| Extremes {
            measure: (*measure).clone(),
            found: course.extremes.as_ref().and_then(Search::found),
            rivals: (course.extremes.as_ref()).map_or_else(Default::default, Search::rivals),
            strokes: (counted.iter().find(|(of, _)| *of == place)).map(|(_, ends)| *ends),
        })
        .collect();
    Some(Numbers {
        values,
        known,
        notes,
        closely: looked_closely,
    })
}

impl Course {
    fn new<F: ForceSource>(sampler: &Sampler<F>, measure: &Measure) -> Self {
        // Every differentiation takes a coefficient away.
        let order = order_of(sampler.motion().mechanism(), measure);
        Self {
            asked: sampler.asked(&[measure]),
            known: order.map_or(1, |order| ORDER - (order as usize).min(ORDER - 1)),
            extremes: None,
            mean: None,
            poles: Vec::new(),
        }
    }

    fn add<F: ForceSource>(&mut self, sampler: &mut Sampler<F>, before: Option<Point>, now: Point) {
        if let Some(extremes) = &mut self.extremes {
            extremes.add(sampler, &self.asked, self.known, before, now);
        }
        if let Some(mean) = &mut self.mean {
            mean.add(before.is_none(), now);
        }
    }

    /// Looks at a place where nothing bounds it.
    fn run_away<F: ForceSource>(
        &mut self,
        sampler: &mut Sampler<F>,
        between: [f64; 2],
        duration: f64,
    ) {
        let Some(pole) = Pole::at(sampler, &self.asked, between, duration) else {
            return;
        };
        if self
            .poles
            .iter()
            .any(|known| known.is_at(pole.time, duration))
        {
            return;
        }
        if let Some(extremes) = &mut self.extremes {
            let infinite = pole.sides.into_iter().filter(|side| *side != 0.0);
            infinite.for_each(|side| extremes.take_value(pole.time, side));
        }
        self.poles.push(pole);
    }

    /// Whether samples can still tell something.
    fn goes_on(&self) -> bool {
        self.mean.is_some() || self.extremes.as_ref().is_some_and(|it| !it.missing)
    }
}
