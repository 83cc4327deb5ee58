//! Play at joints, contact never lost: each clearance is a massless link of known length along the reaction of its joint
//! (S. W. E. Earles and C. L. S. Wu, 1973).
//!
//! A joint with play is let go, and its coordinates are held where the contact has it: the centre of a pin on the later link
//! stands off that on the first link by the clearance, against the force that the later link feels, because the bore holds the
//! pin back from there. A slider stands off its line to the side that its guide pushes away from; it keeps its angle.
//!
//! Where the contacts are depends on the forces, and these on where the contacts are: both are found in turns, from the forces
//! of the mechanism without play, until the pose stays. It has to stay on the branch of the motion without play.

use std::f64::consts::PI;
use std::sync::Arc;

use kempe_measure::measure::{Along, History, measure};
use kempe_measure::{ForceSource, Series, State};
use kempe_mechanism::bordered::Bordered;
use kempe_mechanism::constraint::Source as Of;
use kempe_mechanism::evidence::{Evidence, evidence, is_finite as is_known};
use kempe_mechanism::{Branch, Configuration, Design, Mechanism, NotReleased, Pose};
use kempe_model::{DriveId, DriveKind, Measure, Released};
use kempe_motion::Motion;
use kempe_motion::motion::Solver;
use kempe_number::Number;
use kempe_number::math;
use kempe_units::Dimension;

use crate::instant::Rates;
use crate::note::ForceNote;
use crate::problem::Problem;
use crate::sampler::ForceEvidence;
use crate::source::{Source, pace};

/// A pose stays where nothing moves by more than this, in mechanism sizes and rad.
const SETTLED: f64 = 1e-12;

/// How often the contacts are looked for. Where they are found at all, each look leaves a small part of the last error.
const LOOKS: usize = 60;

/// Below this part of the largest load of a mechanism a reaction has no direction.
const NO_LOAD: f64 = 1e-12;

/// Steps in which a pose with play is followed from that without, to see that both are of one branch.
const STEPS: usize = 8;

/// Two of these steps that differ by more than this part are no steps along one smooth branch.
const SMOOTH: f64 = 0.5;

/// A pose closes up to this part of the mechanism's size.
const CLOSED: f64 = 1e-9;

/// Play at a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Play {
    /// The joint.
    pub joint: Of,
    /// The clearance, m.
    pub radial: f64,
}

/// Why there are no clearances to look at.
#[derive(Debug)]
pub enum NoClearances {
    /// A joint cannot have play.
    NotReleased(NotReleased),
    /// What acts on the mechanism makes no sense.
    Problems(Vec<Problem>),
}

/// Why no pose with play was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NotSettled {
    /// The motion without play does not come here, or is singular here.
    NoMotion,
    /// The reaction of a joint has no direction: nothing holds the contact. Which of the joints with play.
    NoReaction(usize),
    /// Equilibrium does not determine the reaction of a joint: which of the joints with play.
    Undetermined(usize),
    /// The loops do not close with the clearances where the forces want them.
    NotClosed,
    /// A contact jumps from side to side: which of the joints with play.
    Flips(usize),
    /// The pose goes on changing, by so much each time, in mechanism sizes and rad.
    Moves(f64),
    /// The pose found is not of the branch of the motion without play.
    OtherBranch,
}

impl NotSettled {
    /// Why, in words; `names` are those of the joints with play.
    pub fn text(&self, names: &[String]) -> String {
        let name = |joint: &usize| names.get(*joint).map_or("?", String::as_str);
        match self {
            Self::NoMotion => "no regular pose without clearance".to_owned(),
            Self::NoReaction(joint) => format!("no reaction holds the contact at {}", name(joint)),
            Self::Undetermined(joint) => {
                format!(
                    "equilibrium does not determine the reaction at {}",
                    name(joint)
                )
            }
            Self::NotClosed => "the loops do not close with these clearances".to_owned(),
            Self::Flips(joint) => format!(
                "the contact at {} does not settle: it jumps from side to side",
                name(joint)
            ),
            Self::Moves(by) => format!(
                "the contacts do not settle: the pose still moves by {by:.1e} of the mechanism's size"
            ),
            Self::OtherBranch => {
                "with these clearances the branch of the ideal motion has no pose here".to_owned()
            }
        }
    }
}

/// A joint with play: its clearance, m, the coordinates along which it stands open, and whether a force is to hold it open.
struct Opening {
    radial: f64,
    along: Vec<DriveId>,
    held: bool,
}

/// Places along a motion with clearances: first the one without play is found ([`Clearances::go_to`]), then the one with it
/// ([`Clearances::settle`]).
pub struct Clearances {
    motion: Arc<Motion>,
    openings: Vec<Opening>,
    /// Whether the massless links turn with the reactions.
    turning: bool,
    /// Parameters as constants of series in time.
    parameters: Vec<Series<f64>>,
    /// The mechanism with its joints let go.
    plain: Design<f64>,
    design: Arc<Design<Series<f64>>>,
    source: Source<f64>,
    ideal: Solver<f64>,
    configuration: Configuration<f64>,
    system: Bordered,
    branch: Branch,
    state: State<f64>,
    history: History<f64>,
    evidence: Evidence,
}

impl Clearances {
    /// Prepares a motion for clearances. `turning` says whether the massless links turn evenly, as fast as the reactions do;
    /// otherwise they keep their directions. Friction acts at joints without play alone.
    ///
    /// # Errors
    /// A joint that cannot have play, or problems of what acts on the mechanism.
    pub fn new(motion: &Arc<Motion>, plays: &[Play], turning: bool) -> Result<Self, NoClearances> {
        let joints: Vec<Of> = plays.iter().map(|play| play.joint).collect();
        let open = (motion.mechanism().releasing(&joints)).map_err(NoClearances::NotReleased)?;
        let given = &motion.design.parameters;
        let turns = &motion.design.geometry.turns;
        let mut plain = Design::new(&open, given);
        plain.count_turns(turns);
        let mut rich: Design<Rates> = {
            let parameters: Vec<Rates> = given.iter().map(|x| Rates::constant(*x)).collect();
            Design::new(&open, &parameters)
        };
        rich.count_turns(turns);
        let mut start = Branch::neutral(motion.mechanism());
        motion.branch_at(motion.start, &mut start);
        let mut source = Source::of(rich, &start.near).map_err(NoClearances::Problems)?;
        source.forces.equilibrium.pace = pace(&motion.design);
        let design = Arc::new(plain.lift(Series::constant));
        let neutral = Branch::neutral(&open);
        let at_rest = vec![Series::constant(0.0); open.model.drives.len()];
        Ok(Self {
            openings: plays.iter().map(|play| opening(&open, play)).collect(),
            turning,
            parameters: given.iter().map(|x| Series::constant(*x)).collect(),
            ideal: motion.solver(),
            configuration: Configuration::new(&open),
            system: Bordered::new(&open),
            state: State::moving(&design, &neutral, 0.0, &at_rest),
            history: History::default(),
            evidence: Evidence {
                closure: f64::NAN,
                smallest_singular_value: f64::NAN,
            },
            branch: neutral,
            motion: motion.clone(),
            plain,
            design,
            source,
        })
    }

    /// The state last found: after [`Clearances::go_to`] the one without play.
    pub fn state(&self) -> &State<f64> {
        &self.state
    }

    /// How far the pose last found can be trusted.
    pub fn evidence(&self) -> Evidence {
        self.evidence
    }

    /// How far the forces of the state last found can be trusted, and what is to be told of them.
    pub fn force_evidence(&self) -> (ForceEvidence, Vec<ForceNote>) {
        let (forces, at) = (&self.source.forces, &self.source.instant);
        let evidence = crate::sampler::evidence(forces, at);
        (evidence, crate::note::notes(forces, at, evidence.condition))
    }

    /// What the loads follow, which must have a value at every instant.
    pub fn followed(&self) -> &[Measure] {
        self.source.measures()
    }

    /// Finds the state without play at a time of the motion, s; `history` is what measures there need of the motion so far.
    ///
    /// # Errors
    /// That the motion does not come there, or that it is singular there.
    pub fn go_to(&mut self, time: f64, history: History<f64>) -> Result<(), NotSettled> {
        self.history = history;
        let motion = self.motion.clone();
        let model = &motion.mechanism().model;
        let along = (motion.path).parameter_at(model, Series::variable(time), &self.parameters);
        let p = along.value();
        if !motion.reaches(p) || motion.limit_at(p).is_some() || motion.bridge(p).is_some() {
            return Err(NotSettled::NoMotion);
        }
        motion.solve(&motion.design, p, &mut self.ideal);
        let mut coordinates = vec![Series::constant(0.0); self.plain.mechanism.model.drives.len()];
        let own = model.drives.len();
        (motion.path).coordinates_for(along, &self.parameters, &mut coordinates[..own]);
        let places: Vec<f64> = coordinates.iter().map(|q| q.value()).collect();
        let (poses, near) = (&self.ideal.state.poses, &self.ideal.branch.near);
        self.branch = self.plain.branch_through(poses, near, &places);
        self.find(time, &coordinates);
        match is_finite(&self.state) && self.closes(&places) {
            true => Ok(()),
            false => Err(NotSettled::NoMotion),
        }
    }

    /// Derivatives of a measure of geometry to the ways in which each joint may stand open, at the state last found: along the
    /// frame's axes for a pin, across its line for a slider.
    pub fn slopes(&self, asked: &Measure) -> Vec<[f64; 2]> {
        let slope = |drive: &DriveId| {
            let series = measure(
                &self.state,
                &self.history,
                None,
                asked,
                Along::Drive(*drive),
            );
            series.coefficient(1)
        };
        let of = |opening: &Opening| {
            let mut slopes = opening.along.iter().map(slope);
            std::array::from_fn(|_| slopes.next().unwrap_or(0.0))
        };
        self.openings.iter().map(of).collect()
    }

    /// The value of a measure of the state last found, SI.
    pub fn value(&self, asked: &Measure) -> f64 {
        let answer = |measure: &_| self.source.answer(measure);
        measure(
            &self.state,
            &self.history,
            Some(&answer),
            asked,
            Along::Time,
        )
        .value()
    }

    /// Goes on from the state without play to the one with the clearances where the reactions have them.
    ///
    /// # Errors
    /// Why there is none.
    pub fn settle(&mut self) -> Result<(), NotSettled> {
        let time = self.state.time;
        let ideal = self.state.poses.clone();
        let mut coordinates = self.state.coordinates.clone();
        let mut change = f64::INFINITY;
        let mut flipping = None;
        for look in 0..LOOKS {
            let last: Vec<Pose<f64>> = self.state.poses.iter().map(Pose::value).collect();
            flipping = self.set_contacts(&mut coordinates, look > 0)?;
            self.find(time, &coordinates);
            if !is_finite(&self.state) {
                return Err(NotSettled::NotClosed);
            }
            let before = std::mem::replace(&mut change, self.moved(&last));
            // Speeds go by how the contacts turn, which goes on settling after the pose has.
            let settled = change < SETTLED && (!self.turning || before < SETTLED);
            if settled {
                let places: Vec<f64> = coordinates.iter().map(|q| q.value()).collect();
                if !self.closes(&places) {
                    return Err(NotSettled::NotClosed);
                }
                return self.on_branch(&ideal, &places);
            }
        }
        Err(flipping.map_or(NotSettled::Moves(change), NotSettled::Flips))
    }

    /// Whether no force acts at a joint with play in the state last found.
    pub fn is_idle(&self, joint: usize) -> bool {
        let load = self
            .openings
            .get(joint)
            .map(|opening| size_of(&self.load(opening)));
        load.is_some_and(|size| size <= NO_LOAD * self.largest_load())
    }

    /// Leaves a joint without play from now on, but for [`Clearances::slopes`]: no force ever holds a contact there.
    pub fn leave_closed(&mut self, joint: usize) {
        if let Some(opening) = self.openings.get_mut(joint) {
            opening.held = false;
        }
    }

    /// What a joint with play carries along the ways in which it may stand open, N.
    fn load(&self, opening: &Opening) -> Vec<Rates> {
        let drives = opening.along.iter();
        drives
            .map(|d| self.source.forces.drives[d.index()].value)
            .collect()
    }

    /// The largest component of a force between links, N.
    fn largest_load(&self) -> f64 {
        let sides = self.source.forces.sides.iter().flatten();
        let components = sides.flat_map(|side| side.wrench[..2].iter());
        components.fold(0.0, |largest: f64, f| largest.max(f.value().abs()))
    }

    /// Puts the contacts where the forces of the state want them. Answers which one went to the other side.
    fn set_contacts(
        &self,
        coordinates: &mut [Series<f64>],
        again: bool,
    ) -> Result<Option<usize>, NotSettled> {
        let none = NO_LOAD * self.largest_load();
        let mut flipping = None;
        for (joint, opening) in self.openings.iter().enumerate() {
            if !opening.held {
                continue;
            }
            let force = self.load(opening);
            let size = size_of(&force);
            if size.is_nan() {
                return Err(NotSettled::Undetermined(joint));
            }
            if size <= none {
                return Err(NotSettled::NoReaction(joint));
            }
            let there = contact(&force, opening.radial, self.turning);
            let mut along = 0.0;
            for (drive, to) in opening.along.iter().zip(there) {
                let place = &mut coordinates[drive.index()];
                along += place.value() * to.value();
                *place = to;
            }
            if again && along < 0.0 {
                flipping = Some(joint);
            }
        }
        Ok(flipping)
    }

    /// Finds state and forces for these coordinates.
    fn find(&mut self, time: f64, coordinates: &[Series<f64>]) {
        self.state = State::moving(&self.design, &self.branch, time, coordinates);
        let amounts: Vec<Series<f64>> = (self.source.measures().iter())
            .map(|m| measure(&self.state, &self.history, None, m, Along::Time))
            .collect();
        self.source.solve(&self.state, &amounts);
    }

    /// How far the state is from these poses, in mechanism sizes and rad.
    fn moved(&self, from: &[Pose<f64>]) -> f64 {
        let pairs = self.state.poses.iter().zip(from);
        let part = pairs.map(|(now, before)| apart(&now.value(), before, self.motion.size()));
        part.fold(0.0, f64::max)
    }

    /// Whether the state's pose closes; fills its evidence.
    fn closes(&mut self, places: &[f64]) -> bool {
        self.configuration.set_inputs(&self.plain.mechanism, places);
        for (pose, found) in (self.configuration.poses.iter_mut()).zip(&self.state.poses) {
            *pose = found.value();
        }
        self.evidence = evidence(
            &self.plain,
            &self.branch,
            &self.configuration,
            self.motion.size(),
            &mut self.system,
        );
        self.evidence.closure <= CLOSED
    }

    /// Whether the poses between the one without play and the state's, the contacts where they are, follow each other evenly:
    /// then both are of one branch.
    fn on_branch(&mut self, ideal: &[Pose<Series<f64>>], places: &[f64]) -> Result<(), NotSettled> {
        let size = self.motion.size();
        let own = self.motion.mechanism().model.drives.len();
        let mut last: Vec<Pose<f64>> = ideal.iter().map(Pose::value).collect();
        let mut branch = self.branch.clone();
        let mut ways: Vec<Vec<f64>> = Vec::new();
        for step in 1..=STEPS {
            let part = step as f64 / STEPS as f64;
            let mut there = places.to_vec();
            there[own..].iter_mut().for_each(|q| *q *= part);
            branch.guess.clone_from(&last);
            self.configuration.set_inputs(&self.plain.mechanism, &there);
            self.plain.solve(&branch, &mut self.configuration);
            if !self.configuration.poses.iter().all(is_known) {
                return Err(NotSettled::OtherBranch);
            }
            let poses = self.configuration.poses.iter();
            let way = poses.clone().zip(&last).flat_map(|(now, before)| {
                let [x, y] = [now.x - before.x, now.y - before.y].map(|d| d / size);
                [x, y, now.c - before.c, now.s - before.s]
            });
            ways.push(way.collect());
            last = poses.copied().collect();
        }
        let norm = |list: &mut dyn Iterator<Item = f64>| list.fold(0.0, |a: f64, b| a.max(b.abs()));
        let longest = ways.iter().map(|way| norm(&mut way.iter().copied()));
        let longest = longest.fold(0.0, f64::max);
        let even = ways.windows(2).all(|pair| {
            let mut differences = pair[0].iter().zip(&pair[1]).map(|(a, b)| a - b);
            let difference = norm(&mut differences);
            difference <= (SMOOTH * longest).max(SETTLED)
        });
        // The last step ends where the contacts settled.
        let end = (last.iter().zip(&self.state.poses))
            .map(|(a, b)| apart(a, &b.value(), size))
            .fold(0.0, f64::max);
        match even && end <= CLOSED {
            true => Ok(()),
            false => Err(NotSettled::OtherBranch),
        }
    }
}

/// The coordinates along which a joint with play stands open: those that are lengths.
fn opening(open: &Mechanism, play: &Play) -> Opening {
    let is_own = |drive: &DriveId| match open.model.drives[drive.index()].kind {
        DriveKind::Release { of, .. } => is_of(of, play.joint),
        _ => false,
    };
    let is_length =
        |drive: &DriveId| open.model.drives[drive.index()].dimension == Dimension::LENGTH;
    Opening {
        held: true,
        radial: play.radial,
        along: (open.released.iter().copied())
            .filter(|drive| is_own(drive) && is_length(drive))
            .collect(),
    }
}

fn is_of(released: Released, joint: Of) -> bool {
    Of::from(released) == joint
}

/// Where the contact is under a force, m, in time: off by the clearance, against the force.
fn contact(force: &[Rates], radial: f64, turning: bool) -> Vec<Series<f64>> {
    if let ([x, y], true) = (force, turning) {
        let angle = y.atan2(*x) + PI;
        let coefficients = [angle.value(), angle.coefficient(1), 0.0, 0.0, 0.0];
        let (s, c) = Series::from_coefficients(coefficients).sin_cos();
        return vec![c * radial, s * radial];
    }
    let size = size_of(force);
    let places = force.iter().map(|f| -radial * f.value() / size);
    places.map(Series::constant).collect()
}

/// The size of a force, N.
fn size_of(force: &[Rates]) -> f64 {
    force.iter().fold(0.0, |sum, f| math::hypot(sum, f.value()))
}

/// How far two poses are apart, in mechanism sizes and rad.
fn apart(a: &Pose<f64>, b: &Pose<f64>, size: f64) -> f64 {
    let lengths = [a.x - b.x, a.y - b.y].map(|d| d.abs() / size);
    let directions = [a.c - b.c, a.s - b.s].map(f64::abs);
    (lengths.into_iter().chain(directions)).fold(0.0, |m, x| if x.is_nan() { x } else { m.max(x) })
}

fn is_finite(state: &State<f64>) -> bool {
    let mut poses = state.poses.iter();
    poses.all(|pose| is_known(&pose.value()))
}
