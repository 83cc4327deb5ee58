//! Contacts of a model made of the words of its file: which bodies touch, and how they resist.

use kempe_contact::{BlockInGuide, Fit, Friction, Material, Normal, PinWithPlay, Unfit, stiffness};
use kempe_mechanism::constraint::Constraint;
use kempe_mechanism::structure::{LineRef, Source};
use kempe_mechanism::{BodyId, Geometry, Mechanism};
use kempe_model::{
    Contact, ContactLaw, ContactStates, Dissipation, DriveId, DriveKind, FrictionOnset, JointId,
    JointKind, LinkId, LinkPointRef, PointId, Released, Scalar, value,
};
use kempe_units::Dimension;

use super::{JointContact, Resists, Shape};
use crate::number::ForceNumber;
use crate::problem::Problem;
use crate::reaction::Carrier;

/// Modulus of elasticity (Pa) and Poisson's ratio where the file says nothing: those of steel.
const STEEL: [f64; 2] = [207e9, 0.3];
/// Sliding speeds (m/s) between which friction sets in where the file says nothing.
const FRICTION_SPEEDS: [f64; 2] = [1e-3, 1e-2];

impl JointContact {
    /// Compiles those of the model, in its order; where one makes no sense, `problems` tells.
    pub(crate) fn all<T: ForceNumber>(
        mechanism: &Mechanism,
        geometry: &Geometry<T>,
        parameters: &[T],
        problems: &mut Vec<Problem>,
    ) -> Vec<Self> {
        let contacts = &mechanism.model.actions.contacts;
        if contacts.is_empty() {
            return Vec::new();
        }
        let parameters: Vec<f64> = parameters.iter().map(|p| p.value()).collect();
        let geometry = &geometry.map(|x| x.value());
        let compiled = contacts.iter().map(|contact| {
            let compile = Compile {
                mechanism,
                geometry,
                parameters: &parameters,
                contact,
            };
            compile.contact()
        });
        let sound = compiled.filter_map(|found| found.map_err(|why| problems.push(why)).ok());
        sound.collect()
    }
}

/// What a contact is made of.
struct Compile<'a> {
    mechanism: &'a Mechanism,
    geometry: &'a Geometry<f64>,
    parameters: &'a [f64],
    contact: &'a Contact,
}

impl Compile<'_> {
    fn contact(&self) -> Result<JointContact, Problem> {
        let (bodies, shape) = match self.contact.joint {
            Released::Pin { point, link } => self.pin(point, link)?,
            Released::Joint(joint) => self.block(joint)?,
        };
        let places = match shape {
            Shape::Pin(_) => 1,
            Shape::Block(_) => 4,
        };
        let touches = (0..places).map(|place| {
            let own = self.contact.touches.iter().filter(|t| t.place == place);
            own.copied().collect()
        });
        Ok(JointContact {
            joint: self.contact.joint.into(),
            along: self.along()?,
            resists: self.resists(&shape)?,
            touches: touches.collect(),
            parts: Vec::new(),
            bodies,
            shape,
        })
    }

    fn number(&self, scalar: &Option<Scalar>) -> Option<f64> {
        scalar.as_ref().map(|s| value(s, self.parameters))
    }

    /// Why it cannot be counted; `what` follows the name of the joint.
    fn problem(&self, what: &str) -> Problem {
        let name = Carrier::of(&self.contact.joint.into()).name(self.mechanism);
        let message = format!("contact at {name} {what}");
        Problem::new("no-contact-law", &self.contact.span, message)
    }

    /// What makes no sense, in the file's units, with what to write instead.
    fn unfit(&self, why: Unfit) -> Problem {
        let model = &self.mechanism.model;
        let length = |x: f64| model.shown(x, Dimension::LENGTH);
        let speed = |x: f64| model.shown(x, Dimension::SPEED);
        let (what, remedy) = match why {
            Unfit::Restitution(given) => (
                format!(
                    "has a restitution of {given}, which no law that gives delivers: it is the part of the speed that an impact gives back, above 0 and at most 1"
                ),
                "restitution = 0.1 for one that gives back little, or law = \"rigid\", which can take all, beside radial",
            ),
            Unfit::NoRoom { around, inside } => (
                format!(
                    "has no room: {} do not fit into {}",
                    length(inside),
                    length(around)
                ),
                "make radial positive: it is what lies between them",
            ),
            Unfit::NoClearance(radius) => (
                format!(
                    "has no room that could be computed with: {} beside a radius of {}",
                    length(self.contact.clearance),
                    length(radius)
                ),
                "give a larger radial, or the stiffness itself: stiffness = 6.6e10 (N/m^1.5), beside radial",
            ),
            Unfit::NotPositive { what, value } => (
                format!("makes no sense: its {what} comes to {value}, and is a number above 0"),
                "look at the values beside radial, and at their units",
            ),
            Unfit::Negative { what, value } => (
                format!(
                    "makes no sense: its {what} comes to {value}, and is a number that is not negative"
                ),
                "look at the values beside radial, and at their units",
            ),
            Unfit::Poisson(ratio) => (
                format!(
                    "has a Poisson's ratio of {ratio}: that of an elastic material is above -1 and at most 0.5"
                ),
                "poisson = 0.3 for steel, beside radial",
            ),
            Unfit::Onset { from, to } => (
                format!(
                    "rubs from {} on and in full from {} on, which do not rise",
                    speed(from),
                    speed(to)
                ),
                "friction_speeds = [\"1 mm/s\", \"10 mm/s\"], beside radial",
            ),
        };
        self.problem(&what).remedy(remedy)
    }

    /// That it is no joint whose bodies could part.
    fn never_lost(&self) -> Problem {
        (self.problem("cannot be lost: it can at pins and sliders alone"))
            .remedy("give this joint no clearance here, or ask for model = \"continuous\"")
    }

    /// The coordinates of the rows of its joint.
    fn along(&self) -> Result<[DriveId; 2], Problem> {
        let own = (self.mechanism.model.drives.iter().enumerate()).filter(|(_, drive)| {
            matches!(drive.kind, DriveKind::Release { of, .. } if of == self.contact.joint)
        });
        let own: Vec<DriveId> = own.map(|(index, _)| DriveId(index as u32)).collect();
        own.try_into().map_err(|_| self.never_lost())
    }

    /// The bore of a later link, and the pin that sits fast in the first.
    fn pin(&self, point: PointId, link: LinkId) -> Result<([BodyId; 2], Shape), Problem> {
        let marker = |link| self.mechanism.marker(LinkPointRef { link, point });
        let first = self.mechanism.model.points.get(point.index());
        let first = first.and_then(|p| p.links.first());
        let (Some(bore), Some(pin)) = (marker(link), first.and_then(|first| marker(*first))) else {
            return Err(self.never_lost());
        };
        // Without friction nothing hangs on the radius where the law is given.
        let radius = self.number(&self.contact.properties.radius).unwrap_or(0.0);
        let places = [bore, pin].map(|marker| self.geometry.marker(marker));
        let radii = [radius + self.contact.clearance, radius];
        let pin_with_play = PinWithPlay::new(places[0], places[1], radii);
        let shape = pin_with_play.map_err(|why| self.unfit(why))?;
        Ok(([bore.body, pin.body], Shape::Pin(shape)))
    }

    /// The guide and the block of a slider.
    fn block(&self, joint: JointId) -> Result<([BodyId; 2], Shape), Problem> {
        let kind = self.mechanism.model.joints.get(joint.index());
        let Some(JointKind::Slider { at, .. }) = kind.map(|j| &j.kind) else {
            return Err(self.never_lost());
        };
        let (Some(middle), Some((line, along))) = (self.mechanism.marker(*at), self.slider_rows())
        else {
            return Err(self.never_lost());
        };
        let words = &self.contact.properties;
        let Some(length) = self.number(&words.length) else {
            let needs = self.problem("needs the length of the slider, whose corners touch");
            return Err(needs.remedy("length = \"40 mm\", beside radial"));
        };
        let height = self.number(&words.height).unwrap_or(0.0);
        let guide = self.geometry.line(line);
        let block = BlockInGuide {
            guide: guide.origin,
            along: guide.direction,
            block: self.geometry.marker(middle),
            block_along: along,
            half_length: 0.5 * length,
            half_height: 0.5 * height,
            half_width: 0.5 * height + self.contact.clearance,
        };
        let block = block.checked().map_err(|why| self.unfit(why))?;
        Ok(([line.body, middle.body], Shape::Block(block)))
    }

    /// The line of a slider, and the direction of its length in its own body.
    fn slider_rows(&self) -> Option<(LineRef, [f64; 2])> {
        let joint: Source = self.contact.joint.into();
        let own = || (self.mechanism.constraints.iter()).filter(|(_, of)| *of == joint);
        let line = own().find_map(|(row, _)| match row {
            Constraint::ReleasedSlot(row) => Some(row.joint.line),
            _ => None,
        })?;
        let offset = own().find_map(|(row, _)| match row {
            Constraint::Direction(row) => self.geometry.angles.get(row.offset as usize),
            _ => None,
        })?;
        // The slider's body is turned against the guide's by the offset.
        let [x, y] = self.geometry.line(line).direction;
        let [c, s] = *offset;
        Some((line, [x * c + y * s, y * c - x * s]))
    }

    fn resists(&self, shape: &Shape) -> Result<Resists, Problem> {
        let words = &self.contact.properties;
        let restitution = self.number(&words.restitution);
        let normal = match (self.contact.states, self.law()) {
            (ContactStates::Two, _) => {
                let Some(spring) = self.number(&words.spring) else {
                    let needs = self.problem("needs a spring where it has two states");
                    return Err(needs.remedy("spring = \"5e7 N/m\", and damping, beside radial"));
                };
                let damping = self.number(&words.damping).unwrap_or(0.0);
                Normal::kelvin_voigt(spring, damping)
            }
            (ContactStates::Three, ContactLaw::Rigid) => {
                return Ok(Resists::AtOnce {
                    restitution: restitution.unwrap_or(0.0),
                    friction: self.friction_at_once(shape)?,
                });
            }
            (ContactStates::Three, ContactLaw::Hertz) => Normal::hertz(self.stiffness(shape)?),
            (ContactStates::Three, ContactLaw::Dissipating(dissipation)) => {
                let Some(restitution) = restitution else {
                    let needs = self.problem("needs the restitution of its impacts");
                    let remedy = "restitution = 0.9, beside radial; law = \"hertz\" loses nothing";
                    return Err(needs.remedy(remedy));
                };
                Normal::dissipating(self.stiffness(shape)?, restitution, dissipation)
            }
        };
        Ok(Resists::ByLaw {
            normal: normal.map_err(|why| self.unfit(why))?,
            friction: self.friction(shape)?,
        })
    }

    /// The law of a contact of three states: of a block at once unless the file says otherwise, as nobody knows how its corners give.
    fn law(&self) -> ContactLaw {
        let usual = match self.contact.joint {
            Released::Pin { .. } => ContactLaw::Dissipating(Dissipation::Exact),
            Released::Joint(_) => ContactLaw::Rigid,
        };
        self.contact.properties.law.unwrap_or(usual)
    }

    /// K of Hertz's law, N/m^1.5.
    fn stiffness(&self, shape: &Shape) -> Result<f64, Problem> {
        let words = &self.contact.properties;
        if let Some(given) = self.number(&words.stiffness) {
            return Ok(given);
        }
        let Shape::Pin(pin) = shape else {
            let needs =
                self.problem("needs the stiffness of its corners, which follows from no radius");
            let remedy = "stiffness = 1e10 (N/m^1.5), or law = \"rigid\", beside radial";
            return Err(needs.remedy(remedy));
        };
        self.has_radius()?;
        let [modulus, poisson] = STEEL;
        let material = Material {
            modulus: self.number(&words.modulus).unwrap_or(modulus),
            poisson: self.number(&words.poisson).unwrap_or(poisson),
        };
        stiffness([material; 2], pin.radii, Fit::Inside).map_err(|why| self.unfit(why))
    }

    fn has_radius(&self) -> Result<(), Problem> {
        match self.contact.properties.radius {
            Some(_) => Ok(()),
            None => Err((self.problem("needs the radius of its pin"))
                .remedy("radius = \"10 mm\", beside radial")),
        }
    }

    /// The coefficient of what takes no time: its friction sets in at once, too.
    fn friction_at_once(&self, shape: &Shape) -> Result<f64, Problem> {
        let words = &self.contact.properties;
        let coefficient = self.number(&words.friction).unwrap_or(0.0);
        if coefficient == 0.0 {
            return Ok(0.0);
        }
        if let Shape::Pin(_) = shape {
            self.has_radius()?;
        }
        if let Some(FrictionOnset::Ramp(Some(_))) = words.onset {
            let creeps = self.problem("takes no time, and no speeds at which its friction sets in");
            let remedy = "stiction = true in the place of friction_speeds, or a law that gives";
            return Err(creeps.remedy(remedy));
        }
        let friction = Friction::coulomb(coefficient).checked();
        friction
            .map(|friction| friction.kinetic)
            .map_err(|why| self.unfit(why))
    }

    fn friction(&self, shape: &Shape) -> Result<Friction<f64>, Problem> {
        let words = &self.contact.properties;
        let coefficient = self.number(&words.friction).unwrap_or(0.0);
        if coefficient == 0.0 {
            return Ok(Friction::none());
        }
        if let Shape::Pin(_) = shape {
            self.has_radius()?;
        }
        let friction = match &words.onset {
            Some(FrictionOnset::Sticks) => Friction::coulomb(coefficient),
            None | Some(FrictionOnset::Ramp(None)) => {
                let [from, to] = FRICTION_SPEEDS;
                Friction::ambrosio(coefficient, from, to)
            }
            Some(FrictionOnset::Ramp(Some(speeds))) => {
                let [from, to] = speeds.each_ref().map(|v| value(v, self.parameters));
                Friction::ambrosio(coefficient, from, to)
            }
        };
        friction.checked().map_err(|why| self.unfit(why))
    }
}
