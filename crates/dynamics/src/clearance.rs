//! Play at joints, contact never lost: each clearance is a massless link of known length along the reaction of its joint
//! (S. W. E. Earles and C. L. S. Wu, 1973).
//!
//! A joint with play is let go, and its coordinates are held where the contact has it: the centre of a pin on the later link
//! stands off that on the first link by the clearance, against the force that the later link feels, because the bore holds the
//! pin back from there. A slider stands off its line to the side that its guide pushes away from; it keeps its angle.
//!
//! Where the contacts are depends on the forces, and these on where the contacts are: both are found in turns, from the forces
//! of the mechanism without play, until the pose stays (`settle.rs`). It has to stay on the branch of the motion without play.
//!
//! Joints that repeat each other are a case of its own: one of them can open only as the others let it, and equilibrium does
//! not determine their reactions. Where clearance at them leads is not known ([`Clearances::is_undetermined`]).

mod opening;
mod settle;

use std::sync::Arc;

use kempe_measure::measure::{Along, History, measure};
use kempe_measure::{Directions, ForceSource, Series, State};
use kempe_mechanism::bordered::Bordered;
use kempe_mechanism::constraint::Source as Of;
use kempe_mechanism::evidence::is_finite as is_known;
use kempe_mechanism::evidence::{Evidence, closure, evidence};
use kempe_mechanism::{Branch, Configuration, Design, NotReleased};
use kempe_model::{DriveId, Measure};
use kempe_motion::Motion;
use kempe_motion::motion::Solver;
use kempe_number::Number;

use self::opening::Opening;
pub use self::opening::Play;
use crate::instant::Rates;
use crate::note::ForceNote;
use crate::problem::Problem;
use crate::sampler::ForceEvidence;
use crate::source::{Source, pace};

/// Below this part of the largest load of a mechanism a reaction has no direction.
const NO_LOAD: f64 = 1e-12;

/// A pose closes up to this part of the mechanism's size.
const CLOSED: f64 = 1e-9;

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
    directions: Directions,
    ideal: Solver<f64>,
    configuration: Configuration<f64>,
    system: Bordered,
    branch: Branch,
    state: State<f64>,
    history: History<f64>,
}

impl Clearances {
    /// Prepares a motion for clearances and for values of the measures in `asked`. `turning` says whether the massless links turn
    /// evenly, as fast as the reactions do; otherwise they keep their directions. Friction acts at joints without play alone.
    ///
    /// # Errors
    /// A joint that cannot have play, or problems of what acts on the mechanism.
    pub fn new(
        motion: &Arc<Motion>,
        plays: &[Play],
        turning: bool,
        asked: &[Measure],
    ) -> Result<Self, NoClearances> {
        let joints: Vec<Of> = plays.iter().map(|play| play.joint).collect();
        let open = (motion.mechanism().releasing(&joints)).map_err(NoClearances::NotReleased)?;
        let given = &motion.design.parameters;
        let turns = &motion.design.geometry.turns;
        let mut plain = Design::new(&open, given).with_model(|model| {
            let smooth = plays.iter().filter_map(|play| play.joint.released());
            model.actions.smooth.extend(smooth);
        });
        let open = plain.mechanism.clone();
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
        let measures = asked.iter().chain(source.measures());
        Ok(Self {
            openings: plays.iter().map(|play| Opening::new(&open, play)).collect(),
            turning,
            parameters: given.iter().map(|x| Series::constant(*x)).collect(),
            directions: Directions::of(motion, measures),
            ideal: motion.solver(),
            configuration: Configuration::new(&open),
            system: Bordered::new(&open),
            state: State::moving(&design, &neutral, 0.0, &at_rest),
            history: History::default(),
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
    pub fn evidence(&mut self) -> Evidence {
        self.stand();
        let (design, system) = (&self.plain, &mut self.system);
        let size = self.motion.size();
        evidence(design, &self.branch, &self.configuration, size, system)
    }

    /// How far the forces of the state last found can be trusted, and what is to be told of them.
    pub fn force_evidence(&self) -> (ForceEvidence, Vec<ForceNote>) {
        let (forces, at) = (&self.source.forces, &self.source.instant);
        let evidence = crate::sampler::evidence(forces, at);
        (evidence, crate::note::notes(forces, at, evidence.condition))
    }

    /// Finds the state without play at a time of the motion, s.
    ///
    /// # Errors
    /// That the motion does not come there, or that it is singular there.
    pub fn go_to(&mut self, time: f64) -> Result<(), NotSettled> {
        let motion = self.motion.clone();
        let model = &motion.mechanism().model;
        let along = (motion.path).parameter_at(model, Series::variable(time), &self.parameters);
        let p = along.value();
        if !motion.reaches(p) || motion.limit_at(p).is_some() || motion.bridge(p).is_some() {
            return Err(NotSettled::NoMotion);
        }
        self.history = self.directions.history(&motion, p);
        motion.solve(&motion.design, p, &mut self.ideal);
        let mut coordinates = vec![Series::constant(0.0); self.plain.mechanism.model.drives.len()];
        let own = model.drives.len();
        (motion.path).coordinates_for(along, &self.parameters, &mut coordinates[..own]);
        let places: Vec<f64> = coordinates.iter().map(|q| q.value()).collect();
        let (poses, near) = (&self.ideal.state.poses, &self.ideal.branch.near);
        self.branch = self.plain.branch_through(poses, near, &places);
        self.find(time, &coordinates);
        if !is_finite(&self.state) || !self.closes() {
            return Err(NotSettled::NoMotion);
        }
        let loose = self.source.forces.equilibrium.not_unique();
        for opening in &mut self.openings {
            opening.undetermined = opening.rows.iter().any(|row| loose.contains(row));
        }
        Ok(())
    }

    /// Derivatives of a measure of geometry to the ways in which each joint may stand open, at the state last found: along the
    /// frame's axes for a pin, across its line for a slider. NaN of a joint that opens only as others let it
    /// ([`Clearances::is_undetermined`]).
    pub fn slopes(&self, asked: &Measure) -> Vec<[f64; 2]> {
        let slope = |drive: &DriveId| {
            let along = Along::Drive(*drive);
            measure(&self.state, &self.history, None, asked, along).coefficient(1)
        };
        let of = |opening: &Opening| {
            if opening.undetermined {
                return [f64::NAN; 2];
            }
            let mut slopes = opening.along.iter().map(slope);
            std::array::from_fn(|_| slopes.next().unwrap_or(0.0))
        };
        self.openings.iter().map(of).collect()
    }

    /// The value of a measure of the state last found, SI.
    pub fn value(&self, asked: &Measure) -> f64 {
        let answer = |measure: &_| self.source.answer(measure);
        let (state, history) = (&self.state, &self.history);
        measure(state, history, Some(&answer), asked, Along::Time).value()
    }

    /// Whether other joints repeat a joint with play in the pose without play last found: how far it stands open is no choice of
    /// its own, and equilibrium does not determine what it carries.
    pub fn is_undetermined(&self, joint: usize) -> bool {
        let opening = self.openings.get(joint);
        opening.is_some_and(|opening| opening.undetermined)
    }

    /// Whether no force acts at a joint with play in the state last found.
    pub fn is_idle(&self, joint: usize) -> bool {
        let idle = |opening: &Opening| {
            !opening.undetermined && self.load_size(opening) <= NO_LOAD * self.largest_load()
        };
        self.openings.get(joint).is_some_and(idle)
    }

    /// Leaves a joint without play from now on, but for [`Clearances::slopes`]: no force ever holds a contact there.
    pub fn leave_closed(&mut self, joint: usize) {
        if let Some(opening) = self.openings.get_mut(joint) {
            opening.held = false;
        }
    }

    /// Finds state and forces for these coordinates.
    fn find(&mut self, time: f64, coordinates: &[Series<f64>]) {
        self.state = State::moving(&self.design, &self.branch, time, coordinates);
        let amounts: Vec<Series<f64>> = (self.source.measures().iter())
            .map(|m| measure(&self.state, &self.history, None, m, Along::Time))
            .collect();
        self.source.solve(&self.state, &amounts);
    }

    /// Puts the configuration where the state is.
    fn stand(&mut self) {
        let places: Vec<f64> = self.state.coordinates.iter().map(|q| q.value()).collect();
        self.configuration
            .set_inputs(&self.plain.mechanism, &places);
        for (pose, found) in (self.configuration.poses.iter_mut()).zip(&self.state.poses) {
            *pose = found.value();
        }
    }

    /// Whether the state's pose closes.
    fn closes(&mut self) -> bool {
        self.stand();
        let size = self.motion.size();
        closure(&self.plain, &self.branch, &self.configuration, size) <= CLOSED
    }
}

/// Whether every pose of a state is known.
fn is_finite(state: &State<f64>) -> bool {
    let mut poses = state.poses.iter();
    poses.all(|pose| is_known(&pose.value()))
}
