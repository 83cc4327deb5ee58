//! Joints with play in which contact is lost: what a file says of the bodies that touch, and the study of how they move.

use crate::drive::Released;
use crate::ids::{Scalar, Span};
use crate::simulate_study::SimulateStudy;

/// Whose factor makes a law of contact of a wanted restitution e.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Dissipation {
    /// The factor that delivers the wanted restitution.
    #[default]
    Exact,
    /// 3 (1 - e) / 2: K. H. Hunt and F. R. E. Crossley, 1975.
    HuntCrossley,
    /// 6 (1 - e) / ((2 e - 1)^2 + 3): R. G. Herbert and D. C. McWhannell, 1977.
    HerbertMcWhannell,
    /// 3 (1 - e) / 4: T. W. Lee and A. C. Wang, 1983.
    LeeWang,
    /// 3 (1 - e^2) / 4: H. M. Lankarani and P. E. Nikravesh, 1990.
    LankaraniNikravesh,
    /// (1 - e^2) / e: the approximation of Y. Gonthier et al., 2004.
    Gonthier,
    /// 3 (1 - e^2) exp(2 (1 - e)) / 4: Q. Zhiying and L. Qishao, 2006.
    ZhiyingQishao,
    /// 8 (1 - e) / (5 e): P. Flores et al., 2011.
    Flores,
    /// 3 (1 - e) / (2 e): S. Hu and X. Guo, 2015.
    HuGuo,
}

impl Dissipation {
    /// All of them, the default first.
    pub const ALL: [Self; 9] = [
        Self::Exact,
        Self::HuntCrossley,
        Self::HerbertMcWhannell,
        Self::LeeWang,
        Self::LankaraniNikravesh,
        Self::Gonthier,
        Self::ZhiyingQishao,
        Self::Flores,
        Self::HuGuo,
    ];
}

/// How two bodies resist where they touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactLaw {
    /// By Hertz's law with a part that dissipates.
    Dissipating(Dissipation),
    /// By Hertz's law, losing nothing.
    Hertz,
    /// At once: an impact takes no time, and contact that stays is a constraint.
    Rigid,
}

/// What a file says of the bodies in a joint with play, as far as they touch.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactProperties {
    /// Radius of the pin, m.
    pub radius: Option<Scalar>,
    /// Length of a block along its guide, m.
    pub length: Option<Scalar>,
    /// Height of a block across its guide, m.
    pub height: Option<Scalar>,
    /// How they resist.
    pub law: Option<ContactLaw>,
    /// The part of the speed that an impact gives back.
    pub restitution: Option<Scalar>,
    /// Stiffness of Hertz's law, N/m^1.5.
    pub stiffness: Option<Scalar>,
    /// Modulus of elasticity of both bodies, Pa.
    pub modulus: Option<Scalar>,
    /// Poisson's ratio of both bodies.
    pub poisson: Option<Scalar>,
    /// Stiffness of a contact that is a spring, N/m.
    pub spring: Option<Scalar>,
    /// Damping of a contact that is a spring, N s/m.
    pub damping: Option<Scalar>,
    /// Coefficient of friction.
    pub friction: Option<Scalar>,
    /// How it sets in.
    pub onset: Option<FrictionOnset>,
}

/// How the friction of a contact sets in where it hardly slides.
#[derive(Clone, Debug, PartialEq)]
pub enum FrictionOnset {
    /// At once (Coulomb): what rests is held until that takes more than the coefficient allows.
    Sticks,
    /// From one sliding speed to another, m/s, those of all contacts unless said otherwise: what should rest creeps.
    Ramp(Option<[Scalar; 2]>),
}

impl FrictionOnset {
    fn speeds_mut(&mut self) -> Option<&mut [Scalar; 2]> {
        match self {
            Self::Sticks => None,
            Self::Ramp(speeds) => speeds.as_mut(),
        }
    }
}

impl ContactProperties {
    /// Every number in it.
    pub(crate) fn scalars_mut(&mut self) -> impl Iterator<Item = &mut Scalar> {
        let single = [
            &mut self.radius,
            &mut self.length,
            &mut self.height,
            &mut self.restitution,
            &mut self.stiffness,
            &mut self.modulus,
            &mut self.poisson,
            &mut self.spring,
            &mut self.damping,
            &mut self.friction,
        ];
        let two = self.onset.iter_mut().filter_map(FrictionOnset::speeds_mut);
        let two = two.flatten();
        single.into_iter().flatten().chain(two)
    }

    /// These, and what they leave out as `others` say it.
    pub fn or(&self, others: &Self) -> Self {
        let of = |own: &Option<Scalar>, other: &Option<Scalar>| own.clone().or(other.clone());
        Self {
            radius: of(&self.radius, &others.radius),
            length: of(&self.length, &others.length),
            height: of(&self.height, &others.height),
            law: self.law.or(others.law),
            restitution: of(&self.restitution, &others.restitution),
            stiffness: of(&self.stiffness, &others.stiffness),
            modulus: of(&self.modulus, &others.modulus),
            poisson: of(&self.poisson, &others.poisson),
            spring: of(&self.spring, &others.spring),
            damping: of(&self.damping, &others.damping),
            friction: of(&self.friction, &others.friction),
            onset: self.onset.clone().or(others.onset.clone()),
        }
    }
}

/// The states that a contact can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactStates {
    /// Apart, and pressed together by a spring and a damper.
    Two,
    /// Apart, in an impact, and following: pressed together by a law that knows how fast the impact began.
    Three,
}

/// A joint with play in a motion in which its bodies touch and part. Studies add it to a model whose joint they let go.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// The joint.
    pub joint: Released,
    /// How far the centres of a pin and its bore may part, or how far a block may leave its line to either side, m.
    pub clearance: f64,
    /// What is known of its bodies.
    pub properties: ContactProperties,
    /// The states it can have.
    pub states: ContactStates,
    /// Where its bodies start, by the coordinates of its rows: how far it stands open, and how fast that grows. Of a pin along the frame's x and
    /// y, m; of a slider the angle by which it is turned, rad, and how far it is off its line, m.
    pub start: [[f64; 2]; 2],
    /// When its bodies touch, in order of time for each place.
    pub touches: Vec<Touching>,
    /// Where its clearance stands in the file.
    pub span: Span,
}

/// A time in which the bodies of a joint with play touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touching {
    /// Where: the corner of a block; 0 of a pin.
    pub place: usize,
    /// Since when, s.
    pub from: f64,
    /// Until when, s.
    pub to: f64,
    /// How fast they came together, m/s.
    pub speed: f64,
    /// The speed by which the law of the contact goes, m/s: that, or more where others at this joint were much faster.
    pub counts_as: f64,
}

/// A study of clearance in which contact is lost.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactStudy {
    /// The states that a contact can have.
    pub states: ContactStates,
    /// How the mechanism moves in time. What is let go besides the joints, from where, how long.
    pub motion: SimulateStudy,
}
