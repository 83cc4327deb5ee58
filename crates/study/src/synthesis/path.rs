//! Path generation: a point of the coupler passes points.
//!
//! What is given beside the points decides how linkages are found: the crank's angles, the crank itself, both fixed pivots, the coupler's
//! angles at some of the points, or nothing at nine of them.

use std::ops::ControlFlow;

use kempe_model::{Diagnostic, Model, PathTask, value};
use kempe_synthesis::{
    C, CouplerCurve, DyadCondition, Line, Linkage, PathLinkage, Pose, SynthesisError,
    four_bars_through, paths_with_crank, paths_with_ground_pivots, timed_paths,
};
use kempe_units::Dimension;

use super::candidate::Found;
use super::motion::{Area, Given, place};
use super::passing::{Defect, Passing, point_wanted, pose_wanted};
use super::refused::{Data, Datum};
use super::solutions::solutions;
use crate::unit::Units;

/// Points nearer to each other than this part of their spread are one.
const SAME_POINT: f64 = 1e-12;

/// All four-bars of which a point passes points as a task asks.
pub(super) fn candidates(model: &Model, task: &PathTask) -> Result<Found, Box<Diagnostic>> {
    let units = Units::of(model);
    let asked = Asked::new(model, task);
    let refused = |error: &SynthesisError| data(task, &units).refused(error);
    if let Some(repeated) = asked.repeated() {
        return Err(refused(&repeated));
    }
    if asked.leaves_aside() {
        let Data { whole, remedy, .. } = data(task, &units);
        let message = "what is given beside the points cannot all be kept at once";
        let error = Diagnostic::error("data-too-many", message);
        return Err(Box::new(error.at(whole, "").help(remedy)));
    }
    let Answer {
        linkages,
        mut how,
        either_way,
        complete,
        counts,
        unsure,
    } = asked.answer().map_err(|error| refused(&error))?;
    // What passes nine points comes with its cognates already.
    let more: Vec<PathLinkage> = match task.cognates && !asked.is_bare() {
        true => linkages.iter().flat_map(cognates).collect(),
        false => Vec::new(),
    };
    if !more.is_empty() {
        how += &format!("; {} cognates of these", more.len());
    }
    let solutions = Some(solutions(&linkages, either_way, &units));
    let own = linkages.iter().map(|it| (it, either_way));
    let mut passing = Passing::new(&units, "points");
    for (found, either_way) in own.chain(more.iter().map(|it| (it, true))) {
        let mut both = vec![found.linkage];
        if let (true, Linkage::FourBar(bar)) = (either_way, &found.linkage) {
            both.push(Linkage::FourBar(bar.exchanged()));
        }
        for linkage in both {
            let Linkage::FourBar(bar) = &linkage else {
                continue;
            };
            let candidate = Passing::candidate(linkage, found.poses[0]);
            let outside = (bar.fixed.iter())
                .find(|pivot| asked.pivots_in.is_some_and(|area| !area.holds(**pivot)));
            if let Some(pivot) = outside {
                passing.reject(candidate, Defect::Fixed(*pivot));
                continue;
            }
            let wanted = |linkage: &Linkage, k: usize, pose: &Pose, at: f64| match asked.turns[k] {
                Some(_) => pose_wanted(linkage, pose, at),
                None => point_wanted(pose, at),
            };
            passing.pass(candidate, &found.poses, &wanted);
        }
    }
    Ok(Found {
        counts,
        solutions,
        warnings: unsure.map_or_else(Vec::new, |unsure| vec![incomplete(task, unsure)]),
        ..passing.found(how, !complete, Vec::new())
    })
}

/// The other two four-bars that trace a linkage's coupler curve (S. Roberts 1875), with their couplers' poses at the points.
pub(super) fn cognates(of: &PathLinkage) -> Vec<PathLinkage> {
    let Linkage::FourBar(bar) = &of.linkage else {
        return Vec::new();
    };
    let at = |pose: &Pose| CouplerCurve::of(bar, pose, C::zero()).cognates();
    let Some(both) = of.poses.first().and_then(at) else {
        return Vec::new();
    };
    let turn = |curve: &CouplerCurve| curve.moving[1] - curve.moving[0];
    let which = both.iter().enumerate();
    which
        .filter_map(|(k, first)| {
            let poses = of.poses.iter().map(|pose| {
                let there = turn(&at(pose)?[k]) * turn(first).conj();
                Some(Pose {
                    origin: pose.origin,
                    angle: there.arg(),
                })
            });
            Some(PathLinkage {
                linkage: Linkage::FourBar(first.four_bar()),
                poses: poses.collect::<Option<_>>()?,
            })
        })
        .collect()
}

/// What is asked, in numbers.
struct Asked {
    places: Vec<C>,
    /// The coupler's angles there, rad, where they are asked for.
    turns: Vec<Option<f64>>,
    /// The crank's angles there, rad.
    angles: Option<Vec<f64>>,
    crank: Given,
    rocker: Given,
    pivots_in: Option<Area>,
}

/// Linkages that pass the points.
struct Answer {
    linkages: Vec<PathLinkage>,
    /// How many there can be, and how they were found.
    how: String,
    /// Whether either link may be the crank.
    either_way: bool,
    /// Whether they are all there are.
    complete: bool,
    /// What became of the solutions of generic data, where they were followed.
    counts: Vec<(&'static str, usize)>,
    /// How many of how many of these may hide linkages.
    unsure: Option<[usize; 2]>,
}

impl Asked {
    fn new(model: &Model, task: &PathTask) -> Self {
        let parameters = model.parameter_values::<f64>();
        let number = |scalar| value::<f64>(scalar, &parameters);
        let [crank, rocker] = task
            .dyads
            .each_ref()
            .map(|given| Given::of(given, &parameters));
        let corners = task.pivots_in.as_ref().map(<[_; 2]>::each_ref);
        Self {
            places: task
                .points
                .iter()
                .map(|p| place(&p.place, &parameters))
                .collect(),
            turns: task
                .points
                .iter()
                .map(|p| p.angle.as_ref().map(number))
                .collect(),
            angles: task
                .angles
                .as_ref()
                .map(|all| all.iter().map(number).collect()),
            crank,
            rocker,
            pivots_in: corners.map(|both| Area::of(both.map(|corner| place(corner, &parameters)))),
        }
    }

    /// Two points that are one, or one that is no number. What is passed twice is passed at two times: the crank's angles tell them apart.
    fn repeated(&self) -> Option<SynthesisError> {
        let places = &self.places;
        if let Some(datum) = places.iter().position(|p| !p.is_finite()) {
            return Some(SynthesisError::NotFinite { datum });
        }
        if self.angles.is_some() {
            return None;
        }
        let size = places
            .iter()
            .map(|p| (*p - places[0]).norm())
            .fold(0.0, f64::max);
        let pairs = (1..places.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
        let mut same = pairs.filter(|(a, b)| (places[*a] - places[*b]).norm() <= SAME_POINT * size);
        let (first, second) = same.next()?;
        Some(SynthesisError::Repeated { first, second })
    }

    /// Whether nothing is given of the links.
    fn is_bare(&self) -> bool {
        self.angles.is_none() && self.crank.is_free() && self.rocker.is_free()
    }

    /// Whether something is given that the way in which the rest is answered takes no account of.
    fn leaves_aside(&self) -> bool {
        use DyadCondition::{FixedAt, MovingAt, MovingOn};
        let has = |given: &Given, is: fn(&DyadCondition) -> bool| given.conditions.iter().any(is);
        let fixed = |given| has(given, |it| matches!(it, FixedAt(_)));
        let has_pin = |given| has(given, |it| matches!(it, MovingAt(_) | MovingOn(_)));
        let has_end = has(&self.crank, |it| matches!(it, MovingAt(_)));
        let turned = self.posed() > 0;
        if self.angles.is_some() {
            // The crank's end is seen from its pivot there.
            return turned || has_pin(&self.crank);
        }
        let whole = fixed(&self.crank) && has_end;
        let both = fixed(&self.crank) && fixed(&self.rocker);
        whole && turned || both && !has_end && (turned || has_pin(&self.rocker))
    }

    /// How many points have an angle of the coupler.
    fn posed(&self) -> usize {
        self.turns.iter().flatten().count()
    }

    fn answer(&self) -> Result<Answer, SynthesisError> {
        let fixed = |given: &Given| {
            given
                .conditions
                .iter()
                .find_map(|condition| match condition {
                    DyadCondition::FixedAt(pivot) => Some(*pivot),
                    _ => None,
                })
        };
        let moving = self
            .crank
            .conditions
            .iter()
            .find_map(|condition| match condition {
                DyadCondition::MovingAt(pin) => Some(*pin),
                _ => None,
            });
        let free = self.is_bare();
        let turned = self.posed() > 0;
        let pivots = (fixed(&self.crank), fixed(&self.rocker));
        match (&self.angles, pivots, moving) {
            (Some(angles), ..) => self.timed(angles),
            (None, (Some(pivot), _), Some(pin)) => {
                let end = self.places[0] + pin;
                let linkages = paths_with_crank(&self.places, pivot, end, &self.rocker.conditions)?;
                Ok(Answer {
                    linkages,
                    how: "the crank has two places at every point after the first, and each choice makes poses of the points".to_owned(),
                    either_way: false,
                    complete: true,
                    counts: Vec::new(),
                    unsure: None,
                })
            }
            (None, (Some(first), Some(second)), None) => self.between([first, second]),
            _ if free => self.through(),
            _ if turned => Err(SynthesisError::TooMany {
                equations: self.places.len() + 1,
                unknowns: self.places.len(),
            }),
            _ => Err(SynthesisError::TooFew {
                equations: self.places.len(),
                unknowns: 9,
            }),
        }
    }

    /// The crank's angles are given.
    fn timed(&self, angles: &[f64]) -> Result<Answer, SynthesisError> {
        let (crank, rocker) = (&self.crank.conditions, &self.rocker.conditions);
        Ok(Answer {
            linkages: timed_paths(&self.places, angles, crank, rocker)?,
            how: "up to four cranks, each with up to four links to guide the poses that it makes of the points".to_owned(),
            either_way: false,
            complete: true,
            counts: Vec::new(),
            unsure: None,
        })
    }

    /// Both fixed pivots are given.
    fn between(&self, pivots: [C; 2]) -> Result<Answer, SynthesisError> {
        let line = self
            .crank
            .conditions
            .iter()
            .find_map(|condition| match condition {
                // The coupler's axes begin in its point.
                DyadCondition::MovingOn(line) => Some(Line {
                    point: line.point + self.places[0],
                    ..*line
                }),
                _ => None,
            });
        let found = paths_with_ground_pivots(&self.places, pivots, line)?;
        let met = Met {
            generic: found.generic,
            finite: found.finite,
            infinite: found.infinite,
            unsure: found.lost,
            real: found.linkages.len(),
            proved: 0,
        };
        Ok(met.answer(found.linkages, false))
    }

    /// Nothing is given but the points, and the coupler's angles at some of them.
    fn through(&self) -> Result<Answer, SynthesisError> {
        // Those with angles first, as they are counted there.
        let count = self.places.len();
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by_key(|k| self.turns[*k].is_none());
        let posed = self.posed();
        let poses: Vec<Pose> = order[..posed]
            .iter()
            .map(|k| Pose {
                origin: self.places[*k],
                angle: self.turns[*k].unwrap_or(0.0),
            })
            .collect();
        let points: Vec<C> = order[posed..].iter().map(|k| self.places[*k]).collect();
        let found = four_bars_through(&poses, &points, &|_, _| ControlFlow::Continue(()));
        let found = found.map_err(|error| in_order(error, &order))?;
        let met = Met {
            generic: found.generic,
            finite: found.finite,
            infinite: found.infinite,
            unsure: found.singular + found.lost,
            real: found.four_bars.len(),
            proved: found.four_bars.iter().filter(|it| it.certified).count(),
        };
        let linkages = found.four_bars.into_iter().map(|it| {
            let mut poses = vec![it.path.poses[0]; count];
            for (pose, k) in it.path.poses.iter().zip(&order) {
                poses[*k] = *pose;
            }
            PathLinkage {
                linkage: it.path.linkage,
                poses,
            }
        });
        Ok(met.answer(linkages.collect(), true))
    }
}

/// An error about data that were counted in another order.
fn in_order(error: SynthesisError, order: &[usize]) -> SynthesisError {
    let at = |datum: usize| order.get(datum).copied().unwrap_or(datum);
    match error {
        SynthesisError::Repeated { first, second } => {
            let (a, b) = (at(first), at(second));
            SynthesisError::Repeated {
                first: a.min(b),
                second: a.max(b),
            }
        }
        SynthesisError::Dependent { datum } => SynthesisError::Dependent { datum: at(datum) },
        SynthesisError::NotFinite { datum } => SynthesisError::NotFinite { datum: at(datum) },
        SynthesisError::OneCurve {
            curve,
            count,
            datum,
        } => SynthesisError::OneCurve {
            curve,
            count,
            datum: at(datum),
        },
        other => other,
    }
}

/// What became of the solutions that generic data have.
struct Met {
    generic: usize,
    /// Each that was met, once.
    finite: usize,
    infinite: usize,
    /// That came together with others, or could not be followed.
    unsure: usize,
    /// Linkages that are real.
    real: usize,
    /// Of these, by intervals.
    proved: usize,
}

impl Met {
    fn answer(&self, linkages: Vec<PathLinkage>, either_way: bool) -> Answer {
        Answer {
            linkages,
            how: self.text(),
            either_way,
            complete: self.unsure == 0,
            counts: self.numbers(),
            unsure: (self.unsure > 0).then_some([self.unsure, self.generic]),
        }
    }

    fn text(&self) -> String {
        let Self {
            generic,
            finite,
            real,
            ..
        } = self;
        let gone = match self.infinite {
            0 => String::new(),
            gone => format!(", {gone} gone to infinity"),
        };
        let unsure = match self.unsure {
            0 => String::new(),
            unsure => format!(", {unsure} fallen together or lost, which may hide linkages"),
        };
        let proved = match self.proved {
            0 => String::new(),
            proved => format!(", {proved} of them proved by intervals"),
        };
        format!(
            "{finite} of the {generic} solutions of generic data{gone}{unsure}; {real} real four-bars{proved}"
        )
    }

    fn numbers(&self) -> Vec<(&'static str, usize)> {
        let mut all = vec![
            ("solutions", self.generic),
            ("finite solutions", self.finite),
            ("lost solutions", self.unsure),
            ("real four-bars", self.real),
        ];
        if self.proved > 0 {
            all.push(("proved four-bars", self.proved));
        }
        all
    }
}

/// That solutions may hide linkages.
fn incomplete(task: &PathTask, [unsure, all]: [usize; 2]) -> Diagnostic {
    let message = format!(
        "{unsure} of {all} solutions came together or could not be followed: linkages may be missing"
    );
    Diagnostic::warning("search-incomplete", message)
        .at(task.span.clone(), "")
        .note("solutions come together where points and pivots are special, as on one circle or in symmetry")
        .help("move a point a little and see what is found besides")
}

/// The data of a request as the synthesis counts them: points, then what is given of the links.
fn data<'a>(task: &PathTask, units: &'a Units) -> Data<'a> {
    let points = task.points.iter().enumerate().map(|(k, point)| Datum {
        name: format!("point {}", k + 1),
        span: point.span.clone(),
        dimension: Dimension::LENGTH,
    });
    let links = ["`crank`", "`rocker`"].iter().zip(&task.dyads);
    let links = links
        .filter(|(_, given)| !given.span.is_empty())
        .map(|(name, given)| Datum {
            name: format!("what is given of {name}"),
            span: given.span.clone(),
            dimension: Dimension::LENGTH,
        });
    Data {
        data: points.chain(links).collect(),
        whole: task.span.clone(),
        remedy: "a path has nine points with nothing else given; or M of them with the coupler's angle and 10 - 2 M more; or five with both pivots (`crank = { fixed = … }`, \
                 `rocker = { fixed = … }`), or with the crank's `angles`, of which each pivot saves two"
            .to_owned(),
        units,
    }
}
