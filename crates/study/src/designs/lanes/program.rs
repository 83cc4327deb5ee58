//! Which numbers lanes can tell, and from what.

use kempe_measure::is_of_poses;
use kempe_measure::side_by_side::{Many, TOGETHER, angle};
use kempe_mechanism::BodyId;
use kempe_model::{Leaf, Measure, Model, ParameterId, PointId, PoseMeasure, Statistic};
use kempe_motion::Motion;
use kempe_number::{Lanes, Number, math};
use kempe_units::{Builtin, Expr};

/// A formula of more leaves than this, named measures written out, is not taken apart for lanes.
const MOST_LEAVES: usize = 400;

/// What a measure is made of at a place.
#[derive(Clone, Debug)]
pub(super) enum At {
    Parameter(usize),
    /// The coordinate of a drive, which all pieces have alike.
    Drive(usize),
    X(usize),
    Y(usize),
    /// Angle of a link: its body and itself.
    Angle(usize, usize),
    Distance(usize, usize),
    /// Distance of a point from a line through two.
    Aside(usize, [usize; 2]),
    /// Place of a point along a line through two, from the first.
    Along(usize, [usize; 2]),
    /// Angle between the lines from a point to two, folded or not; and its number among these.
    Between(usize, [usize; 2], bool, usize),
}

/// What a number is made of.
#[derive(Clone, Debug)]
pub(in crate::designs) enum Of {
    Parameter(usize),
    Least(usize),
    Greatest(usize),
    Mean(usize),
    /// A measure at one of the places that are asked for.
    At(usize, usize),
}

/// A measure that is followed along the motion.
#[derive(Clone, Debug)]
pub(super) struct Track {
    pub measure: Measure,
    /// From points and bodies; `None` where series are needed.
    pub made_of: Option<Expr<At>>,
    /// Values at which it has a corner itself.
    pub turns_at: Vec<f64>,
    /// What passes zero where it has a corner, a jump or a pole.
    corners: Vec<Expr<At>>,
    /// Whether its least and its greatest value are asked for.
    pub extremes: [bool; 2],
    /// Whether its mean is.
    pub mean: bool,
}

/// What lanes follow, and what they need for it.
#[derive(Clone, Debug, Default)]
pub(super) struct Program {
    pub tracks: Vec<Track>,
    pub points: Vec<PointId>,
    /// Bodies whose angles are asked for.
    pub bodies: Vec<BodyId>,
    /// How many angles between lines there are.
    pub betweens: usize,
    /// Path parameters that are asked for by `at`.
    pub asked: Vec<f64>,
    /// Which parameters differ from piece to piece, or hang on one that does.
    differ: Vec<bool>,
}

impl Track {
    /// What passes zero at corners, where that is to be known: beside extremes.
    pub fn corners(&self) -> &[Expr<At>] {
        match self.extremes {
            [false, false] => &[],
            _ => &self.corners,
        }
    }
}

impl Program {
    /// What passes zero at corners of tracks, one track after the other.
    pub fn corners(&self) -> impl Iterator<Item = &Expr<At>> {
        self.tracks.iter().flat_map(Track::corners)
    }

    /// For pieces in which these parameters vary.
    pub fn new(model: &Model, varied: &[ParameterId]) -> Self {
        let mut differ = Vec::with_capacity(model.parameters.len());
        for (index, parameter) in model.parameters.iter().enumerate() {
            let own = varied.iter().any(|id| id.index() == index);
            differ.push(own || parameter.value.leaves().any(|id| differ[id.index()]));
        }
        Self {
            differ,
            ..Self::default()
        }
    }

    /// A number over the motion; `None` where lanes cannot tell it.
    pub fn number(&mut self, motion: &Motion, measure: &Measure) -> Option<Expr<Of>> {
        let mut it = self.clone();
        let mut left = MOST_LEAVES;
        let found = it.of(motion, measure, &mut left)?;
        *self = it;
        Some(found)
    }

    fn of(&mut self, motion: &Motion, measure: &Measure, left: &mut usize) -> Option<Expr<Of>> {
        let mut whole = true;
        let found = measure.substitute(&mut |leaf| {
            let own = self.of_leaf(motion, leaf, left);
            whole &= own.is_some();
            own.unwrap_or(Expr::Const(f64::NAN))
        });
        whole.then_some(found)
    }

    fn of_leaf(&mut self, motion: &Motion, leaf: &Leaf, left: &mut usize) -> Option<Expr<Of>> {
        *left = left.checked_sub(1)?;
        match leaf {
            Leaf::Parameter(id) => Some(Expr::Leaf(Of::Parameter(id.index()))),
            Leaf::Named(index) => {
                let named = motion.mechanism().model.measures.get(*index)?;
                self.of(motion, &named.measure, left)
            }
            Leaf::Over(statistic, inner) => {
                let track = self.track(motion, inner)?;
                let own = &mut self.tracks[track];
                let leaf = |of| Box::new(Expr::Leaf(of));
                own.extremes[0] |= matches!(statistic, Statistic::Min | Statistic::Range);
                own.extremes[1] |= matches!(statistic, Statistic::Max | Statistic::Range);
                own.mean |= matches!(statistic, Statistic::Mean);
                match statistic {
                    Statistic::Min => Some(Expr::Leaf(Of::Least(track))),
                    Statistic::Max => Some(Expr::Leaf(Of::Greatest(track))),
                    Statistic::Range => {
                        Some(Expr::Sub(leaf(Of::Greatest(track)), leaf(Of::Least(track))))
                    }
                    Statistic::Mean => Some(Expr::Leaf(Of::Mean(track))),
                    Statistic::At { drive, value } => {
                        // Lanes look at the same places of all pieces.
                        if value.leaves().any(|id| self.differ[id.index()]) {
                            return None;
                        }
                        let at = kempe_model::value(value, &motion.design.parameters);
                        let place = place_of(motion, drive.map(|d| d.index()), at)?;
                        self.asked.push(place);
                        Some(Expr::Leaf(Of::At(track, self.asked.len() - 1)))
                    }
                    Statistic::TimeRatio => None,
                }
            }
            _ => None,
        }
    }

    /// A measure along the motion; `None` where lanes cannot tell it.
    pub fn track(&mut self, motion: &Motion, measure: &Measure) -> Option<usize> {
        if let Some(known) = self.tracks.iter().position(|t| t.measure == *measure) {
            return Some(known);
        }
        if !is_of_poses(motion, measure) || motion.mechanism().comes_apart() {
            return None;
        }
        let mut it = self.clone();
        let made_of = it.at(motion, measure, &mut MOST_LEAVES.clone());
        if made_of.is_some() {
            *self = it;
        }
        self.tracks.push(Track {
            measure: measure.clone(),
            turns_at: made_of.as_ref().map_or(Vec::new(), turns_at),
            corners: made_of.as_ref().map_or(Vec::new(), corners),
            made_of,
            extremes: [false; 2],
            mean: false,
        });
        Some(self.tracks.len() - 1)
    }

    fn at(&mut self, motion: &Motion, measure: &Measure, left: &mut usize) -> Option<Expr<At>> {
        let mut whole = true;
        let found = measure.substitute(&mut |leaf| {
            let own = self.at_leaf(motion, leaf, left);
            whole &= own.is_some();
            own.unwrap_or(Expr::Const(f64::NAN))
        });
        whole.then_some(found)
    }

    fn at_leaf(&mut self, motion: &Motion, leaf: &Leaf, left: &mut usize) -> Option<Expr<At>> {
        *left = left.checked_sub(1)?;
        let at = match leaf {
            Leaf::Parameter(id) => At::Parameter(id.index()),
            Leaf::Drive(id) => At::Drive(id.index()),
            Leaf::Named(index) => {
                let named = motion.mechanism().model.measures.get(*index)?;
                return self.at(motion, &named.measure, left);
            }
            Leaf::Pose(pose) => return self.of_pose(motion, pose),
            _ => return None,
        };
        Some(Expr::Leaf(at))
    }

    fn of_pose(&mut self, motion: &Motion, pose: &PoseMeasure) -> Option<Expr<At>> {
        let mechanism = motion.mechanism();
        let mut point = |point: PointId| {
            mechanism.any_marker(point)?;
            let known = self.points.iter().position(|p| *p == point);
            Some(known.unwrap_or_else(|| {
                self.points.push(point);
                self.points.len() - 1
            }))
        };
        let at = match pose {
            PoseMeasure::X(p) => At::X(point(*p)?),
            PoseMeasure::Y(p) => At::Y(point(*p)?),
            PoseMeasure::Distance(a, b) => At::Distance(point(*a)?, point(*b)?),
            PoseMeasure::DistanceToLine(p, line) => {
                At::Aside(point(*p)?, [point(line.from)?, point(line.to)?])
            }
            PoseMeasure::Travel(own, line) => {
                At::Along(point(own.point)?, [point(line.from)?, point(line.to)?])
            }
            PoseMeasure::TransmissionAngle { at, a, b, folded } => {
                let ends = [point(*a)?, point(*b)?];
                let it = At::Between(point(*at)?, ends, *folded, self.betweens);
                self.betweens += 1;
                it
            }
            PoseMeasure::Angle(link) => self.angle(motion, link.index())?,
            PoseMeasure::AngleBetween(link, other) => {
                let [a, b] = [link, other].map(|link| self.angle(motion, link.index()));
                let leaf = |at| Box::new(Expr::Leaf(at));
                return Some(Expr::Sub(leaf(a?), leaf(b?)));
            }
            _ => return None,
        };
        Some(Expr::Leaf(at))
    }

    fn angle(&mut self, motion: &Motion, link: usize) -> Option<At> {
        let links = motion.mechanism().model.links.len();
        let id = (link < links).then_some(kempe_model::LinkId(link as u32))?;
        let body = motion.mechanism().body_of(id);
        // The frame's own angle is no matter of poses.
        if body == BodyId::GROUND {
            return None;
        }
        let known = self.bodies.iter().position(|b| *b == body);
        let body = known.unwrap_or_else(|| {
            self.bodies.push(body);
            self.bodies.len() - 1
        });
        Some(At::Angle(body, link))
    }

    /// Whether anything needs poses as series.
    pub fn needs_series(&self) -> bool {
        self.tracks.iter().any(|track| track.made_of.is_none())
    }
}

/// Values at which an expression that is one thing alone has a corner.
fn turns_at(of: &Expr<At>) -> Vec<f64> {
    match of {
        Expr::Leaf(At::Distance(..)) => vec![0.0],
        // Folded at a right angle, and where both lines lie on each other.
        Expr::Leaf(At::Between(_, _, folded, _)) => {
            let turn = if *folded { 0.5 } else { 1.0 };
            vec![0.0, turn * std::f64::consts::PI]
        }
        _ => Vec::new(),
    }
}

/// What passes zero where an expression that is made of several things has a corner, a jump or a pole.
fn corners(of: &Expr<At>) -> Vec<Expr<At>> {
    let less = |a: &Expr<At>, b: &Expr<At>| Expr::Sub(Box::new(a.clone()), Box::new(b.clone()));
    let mut all = Vec::new();
    for part in of.children() {
        all.extend(corners(part));
        all.extend(
            turns_at(part)
                .into_iter()
                .map(|at| less(&Expr::Const(at), part)),
        );
    }
    match of {
        Expr::Call(Builtin::Min | Builtin::Max, several) => {
            for (k, a) in several.iter().enumerate() {
                all.extend(several[k + 1..].iter().map(|b| less(a, b)));
            }
        }
        Expr::Call(Builtin::Abs | Builtin::Sqrt | Builtin::Ln | Builtin::Atan2, several) => {
            all.extend(several.iter().cloned());
        }
        Expr::Call(Builtin::Hypot, _) => all.push(of.clone()),
        Expr::Call(Builtin::Tan, angle) => {
            let cosine = angle
                .iter()
                .cloned()
                .map(|x| Expr::Call(Builtin::Cos, vec![x]));
            all.extend(cosine);
        }
        Expr::Call(Builtin::Asin | Builtin::Acos, sine) => {
            for x in sine {
                let square = Expr::Mul(Box::new(x.clone()), Box::new(x.clone()));
                all.push(less(&Expr::Const(1.0), &square));
            }
        }
        Expr::Div(_, by) => all.push((**by).clone()),
        Expr::Powi(by, exponent) if *exponent < 0 => all.push((**by).clone()),
        Expr::Powf(by, _) => all.push((**by).clone()),
        _ => {}
    }
    all.retain(|it| !matches!(it, Expr::Const(_) | Expr::Leaf(At::Parameter(_))));
    all
}

/// Where on the motion a drive stands at a coordinate, or what time it is.
fn place_of(motion: &Motion, drive: Option<usize>, value: f64) -> Option<f64> {
    use kempe_motion::drive_path::DrivePath;
    let (model, parameters) = (&motion.mechanism().model, &motion.design.parameters);
    let DrivePath::Coordinate { drive: moving, .. } = &motion.path else {
        return None;
    };
    let place = match drive {
        Some(drive) if drive == *moving => value,
        Some(_) => return None,
        None => {
            let end = kempe_motion::drive_path::duration(model, parameters);
            if !(0.0..=end).contains(&value) {
                return None;
            }
            motion.path.parameter_at(model, value, parameters)
        }
    };
    let (low, high) = motion.demanded;
    ((low..=high).contains(&place) && motion.reaches(place)).then_some(place)
}

/// What all pieces have alike at a place, and where the poses of several pieces stand.
pub(super) struct Seen<'a> {
    /// Columns of points, then of bodies; so many pieces each.
    pub columns: &'a [f64],
    /// Pieces in a column.
    pub count: usize,
    /// The first of those that are looked at.
    pub first: usize,
    /// Points there are columns of.
    pub points: usize,
    /// Coordinates of the drives.
    pub drives: &'a [f64],
    /// By body: the angle that the file's own design has, with its sine and cosine.
    pub near: &'a [[f64; 3]],
    /// The same of the angles between lines.
    pub near_betweens: &'a [[f64; 3]],
    /// By parameter.
    pub parameters: &'a [Many],
    /// By link, the angle of its seat in its body.
    pub seats: &'a [Many],
}

impl Seen<'_> {
    #[inline(always)]
    fn numbers(&self, column: usize) -> &[f64; TOGETHER] {
        let from = column * self.count + self.first;
        let own = self.columns.get(from..).and_then(|it| it.first_chunk());
        own.unwrap_or(&[f64::NAN; TOGETHER])
    }

    #[inline(always)]
    fn column(&self, column: usize) -> Many {
        Lanes(*self.numbers(column))
    }

    fn point(&self, point: usize) -> [Many; 2] {
        [self.column(2 * point), self.column(2 * point + 1)]
    }

    /// From one point to another.
    fn way(&self, from: usize, to: usize) -> [Many; 2] {
        let ([x0, y0], [x1, y1]) = (self.point(from), self.point(to));
        [x1 - x0, y1 - y0]
    }

    /// What is told behind points and bodies.
    pub fn behind(&self, bodies: usize, which: usize) -> &[f64; TOGETHER] {
        self.numbers(2 * self.points + 4 * bodies + which)
    }

    /// Finite where a piece closes.
    pub fn closing(&self) -> &[f64; TOGETHER] {
        self.numbers(0)
    }

    /// Puts down the value of a measure.
    pub fn put(&self, made_of: &Expr<At>, value: &mut Many) {
        match made_of {
            // Most often it is a coordinate as it stands, which is copied once.
            Expr::Leaf(At::X(point)) => value.0.copy_from_slice(self.numbers(2 * point)),
            Expr::Leaf(At::Y(point)) => value.0.copy_from_slice(self.numbers(2 * point + 1)),
            _ => *value = made_of.eval(&mut |at| self.at(at)),
        }
    }

    fn at(&self, at: &At) -> Many {
        match *at {
            At::Parameter(index) => self.parameters[index],
            At::Drive(index) => Many::from_f64(self.drives[index]),
            At::X(point) => self.column(2 * point),
            At::Y(point) => self.column(2 * point + 1),
            At::Angle(body, link) => {
                let first = 2 * self.points + 4 * body;
                let (c, s) = (self.column(first + 2), self.column(first + 3));
                angle(&c, &s, self.near[body]) + self.seats[link]
            }
            At::Distance(a, b) => {
                let [x, y] = self.way(a, b);
                (x * x + y * y).sqrt()
            }
            At::Aside(point, [from, to]) => {
                let ([x, y], [u, v]) = (self.way(from, point), self.direction(from, to));
                u * y - v * x
            }
            At::Along(point, [from, to]) => {
                let ([x, y], [u, v]) = (self.way(from, point), self.direction(from, to));
                u * x + v * y
            }
            At::Between(corner, [a, b], folded, number) => {
                let [c, s] = self.between(corner, [a, b], folded);
                angle(&c, &s, self.near_betweens[number])
            }
        }
    }

    fn direction(&self, from: usize, to: usize) -> [Many; 2] {
        let [u, v] = self.way(from, to);
        let length = (u * u + v * v).sqrt();
        [u / length, v / length]
    }

    /// Two numbers as the cosine and sine of the angle between the lines from a point to two.
    fn between(&self, corner: usize, [a, b]: [usize; 2], folded: bool) -> [Many; 2] {
        let ([ux, uy], [vx, vy]) = (self.way(corner, a), self.way(corner, b));
        let along = ux * vx + uy * vy;
        let across = (ux * vy - uy * vx).abs();
        [if folded { along.abs() } else { along }, across]
    }

    /// The angles between lines of the first piece.
    pub fn betweens(&self, made_of: &Expr<At>, found: &mut [f64]) {
        for leaf in made_of.leaves() {
            if let At::Between(corner, ends, folded, number) = *leaf {
                let [c, s] = self.between(corner, ends, folded);
                found[number] = math::atan2(s.lane(0), c.lane(0));
            }
        }
    }
}
