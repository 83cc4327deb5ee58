//! Motion generation: a body is guided through poses.
//!
//! `motion/given.rs` has what is asked in numbers, `motion/dyads.rs` the dyads that keep it, `motion/picture.rs` shows poses and pivots. Here
//! dyads become linkages, and those that cannot pass the poses are sorted out before anything is moved.

mod dyads;
mod given;
mod picture;

use kempe_model::{Diagnostic, GuidanceTask, LinkageKind, Model};
use kempe_number::math;
use kempe_synthesis::{C, Dyad, FourBar, Linkage, Pose, SynthesisError};
use kempe_units::Dimension;

use super::candidate::Found;
use super::own_linkage::OwnLinkage;
use super::passing::{Defect, Passing, pose_wanted};
use super::refused::{Data, Datum};
use crate::unit::{Units, shown};
use dyads::{Family, MANY, Sort};
use given::Asked;
pub(super) use given::{Area, Given, place};
pub(super) use picture::picture;

/// A fit whose error is more than this part of the body's way is none.
const POOR: f64 = 0.2;
/// Poses nearer to each other than this part of the body's way and of a turn are one.
const SAME_POSE: f64 = 1e-11;

/// All linkages that guide a body as a task asks.
pub(super) fn candidates(model: &Model, task: &GuidanceTask) -> Result<Found, Box<Diagnostic>> {
    let units = Units::of(model);
    let asked = Asked::new(model, task);
    let refused = |which: usize, error: &SynthesisError| data(task, which, &units).refused(error);
    if let Some(repeated) = repeated(&asked) {
        return Err(refused(0, &repeated));
    }
    if asked.poses.len() >= MANY && asked.wants(LinkageKind::FourBar) {
        let bars = asked.four_bars();
        let bars = bars.map_err(|(which, error)| refused(which, &error))?;
        let mut search = Search::new(&asked, &units);
        search.fitted(bars);
        return Ok(search.found());
    }
    let kinds = [
        (LinkageKind::FourBar, Sort::Link),
        (LinkageKind::SliderCrank, Sort::Slider),
        (LinkageKind::InvertedSliderCrank, Sort::Slot),
    ];
    let [crank, rocker] = &asked.given;
    let alike = crank.is_free() && rocker.is_free();
    let cranks = asked
        .family(crank, Sort::Link)
        .map_err(|error| refused(0, &error))?;
    let mut search = Search::new(&asked, &units);
    let mut wrong = None;
    let mut any = false;
    search.tried("cranks", &cranks);
    for (kind, sort) in kinds.into_iter().filter(|(kind, _)| asked.wants(*kind)) {
        if alike && sort == Sort::Link {
            search.both_ways(&cranks.dyads);
            any = true;
            continue;
        }
        match asked.family(rocker, sort) {
            Ok(others) => {
                any = true;
                if !asked.can_be(sort) {
                    continue;
                }
                search.tried(second_name(kind), &others);
                search.pairs(&cranks.dyads, &others.dyads);
            }
            Err(error) => {
                wrong.get_or_insert(error);
            }
        }
    }
    match (any, wrong) {
        (false, Some(error)) => Err(refused(1, &error)),
        _ => Ok(search.found()),
    }
}

fn second_name(kind: LinkageKind) -> &'static str {
    match kind {
        LinkageKind::FourBar => "rockers",
        LinkageKind::SliderCrank => "sliders",
        LinkageKind::InvertedSliderCrank => "slots",
    }
}

/// The data of a request as the synthesis of one of its dyads counts them: poses, then what is given of the dyad.
fn data<'a>(task: &GuidanceTask, which: usize, units: &'a Units) -> Data<'a> {
    let poses = task.poses.iter().enumerate().map(|(k, pose)| Datum {
        name: format!("pose {}", k + 1),
        span: pose.span.clone(),
        dimension: Dimension::LENGTH,
    });
    let (name, given) = (["`crank`", "`rocker`"][which], &task.dyads[which]);
    let is_given = [
        given.fixed.is_some(),
        given.fixed_on.is_some(),
        given.moving.is_some(),
        given.moving_on.is_some(),
        given.along.is_some(),
    ];
    let conditions = is_given.into_iter().filter(|it| *it).map(|_| Datum {
        name: format!("what is given of {name}"),
        span: given.span.clone(),
        dimension: Dimension::LENGTH,
    });
    let of_dyad = match given.span.is_empty() {
        true => task.span.clone(),
        false => given.span.clone(),
    };
    Data {
        data: poses.chain(conditions).collect(),
        whole: of_dyad,
        remedy: "a link keeps five poses, a slider four; in place of two poses a pivot can be given (`fixed`, `moving`), in place of one a line for it \
                 (`fixed_on`, `moving_on`). Three and four poses may leave the rest to a search in a box: `pivots_in`, `pins_in`"
            .to_owned(),
        units,
    }
}

/// Two poses that are one, or one that is no number.
fn repeated(asked: &Asked) -> Option<SynthesisError> {
    let poses = &asked.poses;
    if let Some(datum) = poses.iter().position(|pose| !pose.is_finite()) {
        return Some(SynthesisError::NotFinite { datum });
    }
    let near = SAME_POSE * asked.way();
    let same = |a: &Pose, b: &Pose| {
        (a.origin - b.origin).norm() <= near
            && math::within_half_a_turn(a.angle - b.angle).abs() <= SAME_POSE
    };
    let pairs = (1..poses.len()).flat_map(|second| (0..second).map(move |first| (first, second)));
    let mut found = pairs.filter(|(a, b)| same(&poses[*a], &poses[*b]));
    found
        .next()
        .map(|(first, second)| SynthesisError::Repeated { first, second })
}

/// Pairs of dyads that are gone through.
struct Search<'a> {
    asked: &'a Asked,
    passing: Passing<'a>,
    units: &'a Units,
    /// How dyads were looked for.
    how: Vec<String>,
    is_search: bool,
}

impl<'a> Search<'a> {
    fn new(asked: &'a Asked, units: &'a Units) -> Self {
        Self {
            asked,
            passing: Passing::new(units, "poses"),
            units,
            how: Vec::new(),
            is_search: false,
        }
    }

    fn tried(&mut self, name: &str, family: &Family) {
        let count = family.dyads.len();
        self.how.push(match &family.tried {
            Some(how) => format!("{count} {name}, from {how}"),
            None => format!("{count} {name}, all there are"),
        });
        self.is_search |= family.tried.is_some();
    }

    /// Pairs of dyads that are alike: either is driven.
    fn both_ways(&mut self, dyads: &[Dyad]) {
        for (k, first) in dyads.iter().enumerate() {
            for (l, second) in dyads.iter().enumerate() {
                if k != l {
                    self.add(*first, *second);
                }
            }
        }
    }

    /// Pairs of cranks with what is not driven.
    fn pairs(&mut self, cranks: &[Dyad], others: &[Dyad]) {
        for crank in cranks {
            for other in others {
                self.add(*crank, *other);
            }
        }
    }

    /// Four-bars that come near to the poses as a whole.
    fn fitted(&mut self, bars: Vec<FourBar>) {
        let how = "minima of what the body is off, from pairs of links that keep some poses, or come nearest alone";
        self.how.push(format!("{} four-bars, {how}", bars.len()));
        self.is_search = true;
        for bar in bars {
            self.add_linkage(Linkage::FourBar(bar));
        }
    }

    fn add(&mut self, crank: Dyad, other: Dyad) {
        if let Some(linkage) = Linkage::of(crank, other) {
            self.add_linkage(linkage);
        }
    }

    fn add_linkage(&mut self, linkage: Linkage) {
        let mut candidate = Passing::candidate(linkage, self.asked.poses[0]);
        if let Some(outside) = self.outside(&candidate.linkage) {
            self.passing.reject(candidate, outside);
            return;
        }
        let met = match self.met(&mut candidate) {
            Ok(met) => met,
            Err(defect) => {
                self.passing.reject(candidate, defect);
                return;
            }
        };
        let wanted =
            |linkage: &Linkage, _: usize, pose: &Pose, at: f64| pose_wanted(linkage, pose, at);
        self.passing.pass(candidate, &met, &wanted);
    }

    fn outside(&self, linkage: &Linkage) -> Option<Defect> {
        let (fixed, moving): (Vec<C>, Vec<C>) = match linkage {
            Linkage::FourBar(it) => (it.fixed.to_vec(), it.moving.to_vec()),
            Linkage::SliderCrank(it) => (vec![it.fixed], it.moving.to_vec()),
            Linkage::InvertedSliderCrank(it) => (it.fixed.to_vec(), vec![it.moving]),
            Linkage::TwoSliders(..) => (Vec::new(), Vec::new()),
        };
        let out_of = |of: &[C], is_fixed: bool| {
            of.iter().copied().find(|place| match is_fixed {
                true => !self.asked.inside(Some(*place), None),
                false => !self.asked.inside(None, Some(*place)),
            })
        };
        let fixed = out_of(&fixed, true).map(Defect::Fixed);
        fixed.or_else(|| out_of(&moving, false).map(Defect::Moving))
    }

    /// Where the coupler is at the poses: in them, or of a fit near to them, which is told.
    fn met(&self, candidate: &mut OwnLinkage) -> Result<Vec<Pose>, Defect> {
        let poses = &self.asked.poses;
        let (true, Linkage::FourBar(bar)) = (poses.len() >= MANY, &candidate.linkage) else {
            return Ok(poses.clone());
        };
        let branch = bar.branch(&poses[0]);
        let met: Option<Vec<Pose>> = (poses.iter())
            .map(|pose| bar.pose(bar.first_angle(pose), branch))
            .collect();
        let met = met.ok_or(Defect::Open)?;
        let mean = |of: &dyn Fn(&Pose, &Pose) -> f64| {
            let all = poses.iter().zip(&met).map(|(a, b)| {
                let x = of(a, b);
                x * x
            });
            (all.sum::<f64>() / poses.len() as f64).sqrt()
        };
        let error = mean(&|a, b| (a.origin - b.origin).norm());
        let turn = mean(&|a, b| math::within_half_a_turn(a.angle - b.angle));
        if !(error <= POOR * self.asked.way()) {
            return Err(Defect::Poor(error));
        }
        candidate.told = vec![
            ("rms_error".to_owned(), error, Dimension::LENGTH),
            ("rms_turn".to_owned(), turn, Dimension::ANGLE),
        ];
        // Conditions can name them.
        let written = candidate.told.iter().map(|(name, si, dimension)| {
            let unit = self.units.unit(*dimension);
            let value = format!("{} {}", shown(*si, &unit), unit.text());
            (name.clone(), value)
        });
        candidate.parameters = written.collect();
        Ok(met)
    }

    fn found(self) -> Found {
        let how = self.how.join("; ");
        let guided = self.asked.poses.clone();
        self.passing.found(how, self.is_search, guided)
    }
}
