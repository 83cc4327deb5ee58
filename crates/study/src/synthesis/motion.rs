//! Motion generation: a body is guided through poses.
//!
//! `motion/given.rs` has what is asked in numbers, `motion/dyads.rs` the dyads that keep it, `motion/picture.rs` shows poses and pivots. Here
//! dyads become linkages, and those that cannot pass the poses are sorted out before anything is moved.

mod dyads;
mod given;
mod picture;

use kempe_model::{Diagnostic, GuidanceTask, LinkageKind, Model};
use kempe_number::math;
use kempe_synthesis::{C, Driver, Dyad, Linkage, Passage, Pose, SynthesisError, passage};
use kempe_units::Dimension;

use super::candidate::{Candidate, Found, Rejected, Wanted};
use super::dimensions_in_words;
use super::refused::{Data, Datum};
use crate::result::Listing;
use crate::unit::Units;
use dyads::{Family, MANY, Sort};
use given::Asked;
pub(super) use picture::picture;

/// So many linkages are moved at most: the most compact that transmit best.
const MOST_MOVED: usize = 200;
/// So many that cannot be used are listed one by one; more are counted.
const LISTED: usize = 30;
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

/// Why a linkage that is right in every pose is not moved.
enum Defect {
    /// A fixed pivot lies outside its box.
    Fixed(C),
    /// A moving pivot does.
    Moving(C),
    Circuits,
    Branches,
    /// The crank does not meet the poses one after the other; whether the other link would.
    Order,
    /// Of a fit: it does not close where the crank should stand.
    Open,
    /// Of a fit: it comes no nearer than this, m.
    Poor(f64),
}

impl Defect {
    fn text(&self, units: &Units) -> String {
        let at = |place: &C| {
            let [x, y] = [place.re, place.im].map(|x| units.text(x, Dimension::LENGTH));
            format!("({x}, {y})")
        };
        match self {
            Self::Fixed(place) => {
                format!("a fixed pivot lies at {}, outside `pivots_in`", at(place))
            }
            Self::Moving(place) => format!(
                "a moving pivot lies at {} of the body, outside `pins_in`",
                at(place)
            ),
            Self::Poor(error) => format!(
                "it comes no nearer than {} in the root of the mean square",
                units.text(*error, Dimension::LENGTH)
            ),
            _ => self.kind().to_owned(),
        }
    }

    /// The same without its numbers, for counting.
    fn kind(&self) -> &'static str {
        match self {
            Self::Fixed(_) => "a fixed pivot lies outside `pivots_in`",
            Self::Moving(_) => "a moving pivot lies outside `pins_in`",
            Self::Circuits => {
                "its poses lie on two circuits: it would have to be taken apart between them"
            }
            Self::Branches => {
                "its poses lie on two branches: the crank cannot drive it through the dead centre between them"
            }
            Self::Order => "the crank, turning one way, does not meet the poses in their order",
            Self::Open => "it cannot be closed at all poses",
            Self::Poor(_) => "it does not come near the poses",
        }
    }
}

/// Linkages that are gone through.
struct Search<'a> {
    asked: &'a Asked,
    units: &'a Units,
    candidates: Vec<(f64, Candidate)>,
    rejected: Vec<(Candidate, Defect, bool)>,
    paired: usize,
    /// How dyads were looked for.
    how: Vec<String>,
    is_search: bool,
}

impl<'a> Search<'a> {
    fn new(asked: &'a Asked, units: &'a Units) -> Self {
        Self {
            asked,
            units,
            candidates: Vec::new(),
            rejected: Vec::new(),
            paired: 0,
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

    fn add(&mut self, crank: Dyad, other: Dyad) {
        let Some(linkage) = Linkage::of(crank, other) else {
            return;
        };
        self.paired += 1;
        let mut candidate = Candidate {
            linkage,
            start: self.asked.poses[0],
            turned: None,
            drive: [0.0; 2],
            point: Some(C::new(0.0, 0.0)),
            keeps_axes: true,
            parameters: Vec::new(),
            measures: Vec::new(),
            told: Vec::new(),
            wanted: Vec::new(),
        };
        if let Some(outside) = self.outside(&candidate.linkage) {
            self.rejected.push((candidate, outside, false));
            return;
        }
        let met = match self.met(&mut candidate) {
            Ok(met) => met,
            Err(defect) => {
                self.rejected.push((candidate, defect, false));
                return;
            }
        };
        let Some(passed) = passage(&candidate.linkage, &met, Driver::First) else {
            return;
        };
        if let Some(defect) = defect(&passed) {
            // Whether it only has to be driven at its other link.
            let other = match candidate.linkage {
                Linkage::FourBar(_) => passage(&candidate.linkage, &met, Driver::Second),
                _ => None,
            };
            let other_way = other.is_some_and(|other| self::defect(&other).is_none());
            self.rejected.push((candidate, defect, other_way));
            return;
        }
        let reference = reference(&candidate.linkage);
        let driver: Vec<f64> = passed
            .driver
            .iter()
            .map(|angle| angle + reference)
            .collect();
        if let (Some(from), Some(to)) = (driver.first(), driver.last()) {
            candidate.drive = [*from, *to];
        }
        candidate.start = met[0];
        candidate.wanted = wanted(&candidate.linkage, &met, &driver);
        self.candidates
            .push((merit(&candidate, &passed), candidate));
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
    fn met(&self, candidate: &mut Candidate) -> Result<Vec<Pose>, Defect> {
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
        Ok(met)
    }

    fn found(mut self) -> Found {
        let right = self.candidates.len();
        self.candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
        self.candidates.truncate(MOST_MOVED);
        let how = self.how.join("; ");
        let many = self.rejected.len() > LISTED;
        let is_told = self.is_search || many || right > MOST_MOVED;
        let tried = is_told.then(|| self.told(&how, right));
        let counted = if many { self.rejected.len() } else { 0 };
        let rejected = match many {
            true => Vec::new(),
            false => (self.rejected.iter())
                .map(|(candidate, defect, other_way)| {
                    let more = match other_way {
                        true => "; driven at its other link it passes them",
                        false => "",
                    };
                    Rejected {
                        what: dimensions_in_words(candidate, self.units),
                        why: defect.text(self.units) + more,
                    }
                })
                .collect(),
        };
        Found {
            candidates: self.candidates.into_iter().map(|(_, c)| c).collect(),
            rejected,
            searched: how,
            tried,
            counted,
            guided: self.asked.poses.clone(),
        }
    }

    /// What was tried, and how much of it is of use.
    fn told(&self, how: &str, right: usize) -> Listing {
        let mut rows: Vec<(String, usize)> = vec![("in all".to_owned(), self.paired)];
        for (_, defect, _) in &self.rejected {
            let kind = defect.kind();
            match rows.iter_mut().find(|(known, _)| known == kind) {
                Some((_, count)) => *count += 1,
                None => rows.push((kind.to_owned(), 1)),
            }
        }
        rows.push(("they pass the poses".to_owned(), right));
        if right > MOST_MOVED {
            let of = "of these moved, those of the least link ratio over the sine of the transmission angle";
            rows.push((of.to_owned(), MOST_MOVED));
        }
        let rows = rows.into_iter();
        Listing {
            title: format!("linkages tried: {how}"),
            head: vec!["pairs of dyads".to_owned(), "how many".to_owned()],
            rows: rows
                .map(|(what, count)| vec![what, count.to_string()])
                .collect(),
        }
    }
}

/// What keeps a linkage from being led through the poses.
fn defect(passed: &Passage) -> Option<Defect> {
    if !passed.one_circuit {
        return Some(Defect::Circuits);
    }
    if !passed.one_branch {
        return Some(Defect::Branches);
    }
    let goes = |sense: f64| {
        let mut pairs = passed.driver.windows(2);
        pairs.all(|pair| sense * (pair[1] - pair[0]) > 0.0)
    };
    // A rocker meets all of three on its circuit in some order, but not on one way.
    (!passed.in_order || !(goes(1.0) || goes(-1.0))).then_some(Defect::Order)
}

/// The angle of the line from which a linkage's crank is counted.
fn reference(linkage: &Linkage) -> f64 {
    match linkage {
        Linkage::FourBar(it) => (it.fixed[1] - it.fixed[0]).arg(),
        Linkage::SliderCrank(it) => it.guide.direction.arg(),
        Linkage::InvertedSliderCrank(it) => (it.fixed[1] - it.fixed[0]).arg(),
        Linkage::TwoSliders(..) => 0.0,
    }
}

fn wanted(linkage: &Linkage, met: &[Pose], driver: &[f64]) -> Vec<Wanted> {
    let angle = match linkage {
        Linkage::InvertedSliderCrank(_) => "angle(lever)",
        _ => "angle(coupler)",
    };
    let of_pose = |(pose, at): (&Pose, &f64)| {
        let all = [
            ("x(P)", pose.origin.re),
            ("y(P)", pose.origin.im),
            (angle, pose.angle),
        ];
        let at = *at;
        all.map(|(measure, value)| Wanted {
            measure: measure.to_owned(),
            at,
            value,
        })
    };
    met.iter().zip(driver).flat_map(of_pose).collect()
}

/// How large a linkage's links are beside each other, over how well it transmits: the less the better.
fn merit(candidate: &Candidate, passed: &Passage) -> f64 {
    if let Some((_, error, _)) = candidate.told.first() {
        return *error;
    }
    let links = candidate.links();
    let [least, most] =
        [f64::min, f64::max].map(|pick| links.iter().copied().reduce(pick).unwrap_or(1.0));
    let transmits = passed
        .transmission
        .map_or(1.0, |[_, [low, high]]| math::sin(low).min(math::sin(high)));
    most / least / transmits.max(f64::MIN_POSITIVE)
}
