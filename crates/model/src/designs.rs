//! Studies of many designs: another study, run again with other values of some parameters.

use crate::condition::Condition;
use crate::fit::Fit;
use crate::ids::{ParameterId, Scalar, Span};
use crate::motion_study::{Column, MotionStudy};

/// What studies of many designs share.
#[derive(Clone, Debug, PartialEq)]
pub struct OverStudy {
    /// The name of the study that is run for every design.
    pub name: String,
    /// Numbers over its motion that are told of every design, and what of it is plotted for several; no rows of its own.
    pub asked: MotionStudy,
    /// Where this study's name stands in the file.
    pub span: Span,
}

/// A study run for given values of parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepStudy {
    /// What is run.
    pub over: OverStudy,
    /// The parameters, each with its values.
    pub vary: Vec<Swept>,
    /// How their values go together.
    pub combine: Combine,
}

/// A parameter of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Swept {
    /// The parameter.
    pub parameter: ParameterId,
    /// Its values.
    pub values: SweptValues,
    /// Where they stand in the file.
    pub span: Span,
}

/// Values of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum SweptValues {
    /// These.
    These(Vec<Scalar>),
    /// So many, evenly from one to another.
    Even {
        /// The first.
        from: Scalar,
        /// The last.
        to: Scalar,
        /// How many, at least two.
        count: usize,
    },
    /// The file's own, and that less and more by this.
    Around(Change),
}

impl SweptValues {
    /// What it is told by.
    pub fn scalars(&self) -> Vec<&Scalar> {
        match self {
            Self::These(values) => values.iter().collect(),
            Self::Even { from, to, .. } => vec![from, to],
            Self::Around(Change::By(by) | Change::Part(by)) => vec![by],
        }
    }
}

/// By how much a parameter changes.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// By so much, in its own dimension.
    By(Scalar),
    /// By this part of its value.
    Part(Scalar),
}

/// How the values of several parameters go together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Combine {
    /// Each with each.
    Grid,
    /// One parameter after the other, the rest as in the file.
    OneAtATime,
    /// The first values of all, then the second ones, and so on.
    Together,
}

/// What tolerances do to a study's numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct ToleranceStudy {
    /// What is run.
    pub over: OverStudy,
    /// The parameters that differ from piece to piece.
    pub vary: Vec<Toleranced>,
    /// Where it is said that joints have the play of the file's clearances, in directions that differ from piece to piece; none where they have none.
    pub clearance: Option<Span>,
    /// How many pieces are drawn.
    pub samples: usize,
    /// Which ones.
    pub seed: usize,
    /// What a piece must keep to be good.
    pub limits: Vec<Limit>,
}

/// A parameter that differs from piece to piece.
#[derive(Clone, Debug, PartialEq)]
pub struct Toleranced {
    /// The parameter.
    pub parameter: ParameterId,
    /// How it differs from its value in the file.
    pub spread: Spread,
    /// Where that stands in the file.
    pub span: Span,
}

/// How a parameter differs from its value in the file.
#[derive(Clone, Debug, PartialEq)]
pub enum Spread {
    /// Evenly, by as much to either side.
    Even(Change),
    /// Evenly between two deviations, of which the first is the smaller.
    Between([Scalar; 2]),
    /// Normally, with this standard deviation.
    Normal(Change),
}

/// Something that a design must keep.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// As written, and what is not negative where it holds.
    pub condition: Condition,
    /// What is limited: the left side, or the right one where the left is of numbers and parameters alone.
    pub limited: Column,
    /// Whether that must be the larger side.
    pub at_least: bool,
    /// Where it stands in the file.
    pub span: Span,
}

/// The design that does something best.
#[derive(Clone, Debug, PartialEq)]
pub struct OptimizeStudy {
    /// What is run.
    pub over: OverStudy,
    /// The parameters that may be chosen.
    pub vary: Vec<Chosen>,
    /// What is to be small or large; several make a front. None where something is fitted.
    pub goals: Vec<Goal>,
    /// The path or motion that is fitted instead.
    pub fit: Option<Fit>,
    /// What must be kept.
    pub subject_to: Vec<Limit>,
    /// How it is looked for; as suits where it is not said.
    pub method: Option<OptimizeMethod>,
    /// Which random numbers are used.
    pub seed: usize,
    /// How many designs are tried at most; as the method needs where it is not said.
    pub designs: Option<usize>,
}

/// A parameter that may be chosen.
#[derive(Clone, Debug, PartialEq)]
pub struct Chosen {
    /// The parameter.
    pub parameter: ParameterId,
    /// Among which values.
    pub among: Among,
    /// Where they stand in the file.
    pub span: Span,
}

/// The values among which a parameter is chosen.
#[derive(Clone, Debug, PartialEq)]
pub enum Among {
    /// All between two.
    Between([Scalar; 2]),
    /// All between two positive ones, every factor alike: as many from 1 to 10 as from 10 to 100.
    Factors([Scalar; 2]),
    /// Those between two that are whole multiples of a step.
    Steps {
        /// The least and the greatest.
        between: [Scalar; 2],
        /// The step.
        step: Scalar,
    },
    /// These alone, as of a catalogue.
    Only(Vec<Scalar>),
}

impl Among {
    /// What it is told by.
    pub fn scalars(&self) -> Vec<&Scalar> {
        match self {
            Self::Between([low, high]) | Self::Factors([low, high]) => vec![low, high],
            Self::Steps {
                between: [low, high],
                step,
            } => vec![low, high, step],
            Self::Only(values) => values.iter().collect(),
        }
    }
}

/// What is to be small or large.
#[derive(Clone, Debug, PartialEq)]
pub struct Goal {
    /// The number.
    pub number: Column,
    /// Whether it is to be large.
    pub maximize: bool,
    /// Where it stands in the file.
    pub span: Span,
}

/// How an optimum is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OptimizeMethod {
    /// Downhill from the file's own values, by exact derivatives.
    Local,
    /// The same from many starts.
    MultiStart,
    /// By differential evolution, and downhill from its best.
    DifferentialEvolution,
    /// By adapting a normal distribution, and downhill from its best.
    CmaEs,
}

impl OverStudy {
    fn visit_places(&mut self, f: &mut dyn FnMut(&mut Span)) {
        f(&mut self.span);
    }
}

impl Change {
    fn scalar(&mut self) -> &mut Scalar {
        match self {
            Self::By(x) | Self::Part(x) => x,
        }
    }
}

impl SweepStudy {
    /// Where its parts stand in the file.
    pub(crate) fn visit_places(&mut self, f: &mut dyn FnMut(&mut Span)) {
        self.over.visit_places(f);
        self.vary.iter_mut().for_each(|it| f(&mut it.span));
    }

    /// Every expression over parameters.
    pub(crate) fn visit_scalars(&mut self, f: &mut dyn FnMut(&mut Scalar)) {
        for swept in &mut self.vary {
            match &mut swept.values {
                SweptValues::These(values) => values.iter_mut().for_each(&mut *f),
                SweptValues::Even { from, to, .. } => [from, to].into_iter().for_each(&mut *f),
                SweptValues::Around(change) => f(change.scalar()),
            }
        }
    }
}

impl ToleranceStudy {
    /// Where its parts stand in the file.
    pub(crate) fn visit_places(&mut self, f: &mut dyn FnMut(&mut Span)) {
        self.over.visit_places(f);
        self.vary.iter_mut().for_each(|it| f(&mut it.span));
        self.clearance.iter_mut().for_each(&mut *f);
        self.limits.iter_mut().for_each(|it| f(&mut it.span));
    }

    /// Every expression over parameters.
    pub(crate) fn visit_scalars(&mut self, f: &mut dyn FnMut(&mut Scalar)) {
        for toleranced in &mut self.vary {
            match &mut toleranced.spread {
                Spread::Even(change) | Spread::Normal(change) => f(change.scalar()),
                Spread::Between(both) => both.iter_mut().for_each(&mut *f),
            }
        }
    }
}

impl OptimizeStudy {
    /// Where its parts stand in the file.
    pub(crate) fn visit_places(&mut self, f: &mut dyn FnMut(&mut Span)) {
        self.over.visit_places(f);
        self.vary.iter_mut().for_each(|it| f(&mut it.span));
        self.goals.iter_mut().for_each(|it| f(&mut it.span));
        if let Some(fit) = &mut self.fit {
            fit.visit_places(f);
        }
        self.subject_to.iter_mut().for_each(|it| f(&mut it.span));
    }

    /// Every expression over parameters.
    pub(crate) fn visit_scalars(&mut self, f: &mut dyn FnMut(&mut Scalar)) {
        for chosen in &mut self.vary {
            match &mut chosen.among {
                Among::Between(both) | Among::Factors(both) => both.iter_mut().for_each(&mut *f),
                Among::Steps { between, step } => {
                    between.iter_mut().for_each(&mut *f);
                    f(step);
                }
                Among::Only(values) => values.iter_mut().for_each(&mut *f),
            }
        }
        if let Some(fit) = &mut self.fit {
            fit.visit_scalars(f);
        }
    }
}

/// The measures of limits.
pub(crate) fn measures_of(limits: &mut [Limit]) -> impl Iterator<Item = &mut crate::Measure> {
    limits
        .iter_mut()
        .flat_map(|limit| [&mut limit.condition.above, &mut limit.limited.measure])
}
