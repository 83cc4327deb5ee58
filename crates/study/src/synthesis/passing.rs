//! Linkages that are right at every place, looked at by their geometry: whether their crank can lead them from one place to the next.

use std::f64::consts::TAU;

use kempe_number::math;
use kempe_synthesis::{C, Driver, Linkage, Passage, Pose, passage};
use kempe_units::Dimension;

use super::candidate::{Found, Rejected, dimensions_in_words};
use super::own_linkage::{OwnLinkage, Wanted};
use crate::result::Listing;
use crate::unit::Units;

/// So many linkages are moved at most: the most compact that transmit best.
const MOST_MOVED: usize = 200;
/// So many that cannot be used are listed one by one; more are counted.
const LISTED: usize = 30;

/// Why a linkage that is right at every place is not moved.
pub(super) enum Defect {
    /// A fixed pivot lies outside its box.
    Fixed(C),
    /// A moving pivot does.
    Moving(C),
    Circuits,
    Branches,
    /// The crank does not meet the places one after the other.
    Order,
    /// Of a fit: it does not close where the crank should stand.
    Open,
    /// Of a fit: it comes no nearer than this, m.
    Poor(f64),
}

impl Defect {
    fn text(&self, units: &Units, places: &str) -> String {
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
            _ => self.kind(places),
        }
    }

    /// The same without its numbers, for counting.
    fn kind(&self, places: &str) -> String {
        match self {
            Self::Fixed(_) => "a fixed pivot lies outside `pivots_in`".to_owned(),
            Self::Moving(_) => "a moving pivot lies outside `pins_in`".to_owned(),
            Self::Circuits => format!(
                "its {places} lie on two circuits: it would have to be taken apart between them"
            ),
            Self::Branches => format!(
                "its {places} lie on two branches: the crank cannot drive it through the dead centre between them"
            ),
            Self::Order => {
                format!("the crank, turning one way, does not meet the {places} in their order")
            }
            Self::Open => format!("it cannot be closed at all {places}"),
            Self::Poor(_) => format!("it does not come near the {places}"),
        }
    }
}

/// What a linkage must do at a place, by its number: the pose of its coupler and the crank's angle (rad) there.
pub(super) type WantedAt<'a> = &'a dyn Fn(&Linkage, usize, &Pose, f64) -> Vec<Wanted>;

/// Linkages that are gone through.
pub(super) struct Passing<'a> {
    units: &'a Units,
    /// What is passed: poses, points.
    places: &'static str,
    /// Whether behind the last place comes the first.
    round: bool,
    candidates: Vec<(f64, OwnLinkage)>,
    rejected: Vec<(OwnLinkage, Defect, bool)>,
}

impl<'a> Passing<'a> {
    pub fn new(units: &'a Units, places: &'static str) -> Self {
        Self {
            units,
            places,
            round: false,
            candidates: Vec::new(),
            rejected: Vec::new(),
        }
    }

    /// Whether behind the last place comes the first again, after a whole turn of the crank.
    pub fn round(self, round: bool) -> Self {
        Self { round, ..self }
    }

    /// A linkage whose coupler carries its own origin.
    pub fn candidate(linkage: Linkage, start: Pose) -> OwnLinkage {
        OwnLinkage {
            linkage,
            start,
            turned: None,
            drive: [0.0; 2],
            point: Some(C::new(0.0, 0.0)),
            keeps_axes: true,
            parameters: Vec::new(),
            measures: Vec::new(),
            told: Vec::new(),
            wanted: Vec::new(),
        }
    }

    pub fn reject(&mut self, candidate: OwnLinkage, defect: Defect) {
        self.rejected.push((candidate, defect, false));
    }

    /// Whether the crank leads a linkage through poses of its coupler, from the first to the last.
    pub fn pass(&mut self, mut candidate: OwnLinkage, met: &[Pose], wanted: WantedAt<'_>) {
        let Some(passed) = passage(&candidate.linkage, met, Driver::First) else {
            return;
        };
        if let Some(defect) = defect(&passed) {
            // Whether it only has to be driven at its other link.
            let other = match candidate.linkage {
                Linkage::FourBar(_) => passage(&candidate.linkage, met, Driver::Second),
                _ => None,
            };
            let other_way = other.is_some_and(|other| self::defect(&other).is_none());
            self.rejected.push((candidate, defect, other_way));
            return;
        }
        let reference = reference(&candidate.linkage);
        let driver: Vec<f64> = (passed.driver.iter())
            .map(|angle| angle + reference)
            .collect();
        if let (Some(from), Some(to)) = (driver.first(), driver.last()) {
            let turned = from + TAU.copysign(to - from);
            candidate.drive = [*from, if self.round { turned } else { *to }];
        }
        if let Some(first) = met.first() {
            candidate.start = *first;
        }
        let stations = met.iter().zip(&driver).enumerate();
        let of_pose =
            |(k, (pose, at)): (usize, (&Pose, &f64))| wanted(&candidate.linkage, k, pose, *at);
        candidate.wanted = stations.flat_map(of_pose).collect();
        self.candidates
            .push((merit(&candidate, &passed), candidate));
    }

    /// Those that pass, the best first, and the others with the reasons; `how` they were looked for is told where the search is not over all there
    /// are.
    pub fn found(mut self, how: String, is_search: bool, guided: Vec<Pose>) -> Found {
        let right = self.candidates.len();
        self.candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
        self.candidates.truncate(MOST_MOVED);
        let many = self.rejected.len() > LISTED;
        let is_told = is_search || many || right > MOST_MOVED;
        let tried = is_told.then(|| self.told(&how, right));
        let counted = if many { self.rejected.len() } else { 0 } + right.saturating_sub(MOST_MOVED);
        let rejected = match many {
            true => Vec::new(),
            false => (self.rejected.iter())
                .map(|(candidate, defect, other_way)| {
                    let more = match other_way {
                        true => "; driven at its other link it passes them",
                        false => "",
                    };
                    Rejected {
                        what: dimensions_in_words(&candidate.lengths(), self.units),
                        why: defect.text(self.units, self.places) + more,
                    }
                })
                .collect(),
        };
        Found {
            candidates: self.candidates.into_iter().map(|(_, c)| c.into()).collect(),
            rejected,
            searched: how,
            tried,
            counted,
            counts: Vec::new(),
            solutions: None,
            guided,
            figure: None,
            warnings: Vec::new(),
        }
    }

    /// What was tried, and how much of it is of use.
    fn told(&self, how: &str, right: usize) -> Listing {
        let all = right + self.rejected.len();
        let mut rows: Vec<(String, usize)> = vec![("in all".to_owned(), all)];
        for (_, defect, _) in &self.rejected {
            let kind = defect.kind(self.places);
            match rows.iter_mut().find(|(known, _)| *known == kind) {
                Some((_, count)) => *count += 1,
                None => rows.push((kind, 1)),
            }
        }
        rows.push((format!("they pass the {}", self.places), right));
        if right > MOST_MOVED {
            let of = "of these moved, those of the least link ratio over the sine of the transmission angle";
            rows.push((of.to_owned(), MOST_MOVED));
        }
        let rows = rows.into_iter();
        Listing {
            title: format!("linkages tried: {how}"),
            head: vec!["linkages".to_owned(), "how many".to_owned()],
            rows: rows
                .map(|(what, count)| vec![what, count.to_string()])
                .collect(),
        }
    }
}

/// Where the coupler's origin is, and how it is turned, as measures of a linkage's file.
pub(super) fn pose_wanted(linkage: &Linkage, pose: &Pose, at: f64) -> Vec<Wanted> {
    let angle = match linkage {
        Linkage::InvertedSliderCrank(_) => "angle(lever)",
        _ => "angle(coupler)",
    };
    let turn = Wanted {
        measure: angle.to_owned(),
        at,
        value: pose.angle,
        scale: None,
    };
    point_wanted(pose, at).into_iter().chain([turn]).collect()
}

/// Where the coupler's origin is.
pub(super) fn point_wanted(pose: &Pose, at: f64) -> Vec<Wanted> {
    let both = [("x(P)", pose.origin.re), ("y(P)", pose.origin.im)];
    let both = both.map(|(measure, value)| Wanted {
        measure: measure.to_owned(),
        at,
        value,
        scale: None,
    });
    both.into()
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

/// How large a linkage's links are beside each other, over how well it transmits: the less the better.
fn merit(candidate: &OwnLinkage, passed: &Passage) -> f64 {
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
