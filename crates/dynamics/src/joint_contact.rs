//! Joints with play in which contact comes and goes: what their bodies do to each other while they touch.
//!
//! Such a joint is let go ([`kempe_mechanism::Mechanism::releasing`]); the coordinates of its rows tell how far it stands open, and
//! indentations come from them, not from small differences of places. Where contact begins and ends is found by the
//! simulation, which knows how fast every contact began.

use kempe_contact::{
    BlockInGuide, Body, Damping, Fit, Friction, Material, Normal, PinWithPlay, Touch, Unfit,
    factor, stiffness,
};
use kempe_mechanism::constraint::Constraint;
use kempe_mechanism::structure::{LineRef, Source};
use kempe_mechanism::{BodyId, Geometry, Mechanism};
use kempe_model::{
    self as model, Contact, ContactLaw, ContactStates, Dissipation, DriveId, DriveKind, JointKind,
    LinkPointRef, Released, Touching,
};

use crate::instant::Instant;
use crate::number::ForceNumber;
use crate::problem::Problem;
use crate::wrench::{self, Wrench};

/// Modulus of elasticity (Pa) and Poisson's ratio where the file says nothing: those of steel.
pub const STEEL: [f64; 2] = [207e9, 0.3];
/// Sliding speeds (m/s) between which friction sets in where the file says nothing.
pub const FRICTION_SPEEDS: [f64; 2] = [1e-3, 1e-2];

/// What touches.
#[derive(Clone, Debug)]
enum Shape<T> {
    /// A pin in its bore.
    Pin(PinWithPlay<T>),
    /// A block in its guide.
    Block(BlockInGuide<T>),
}

/// A joint with play whose bodies touch and part.
#[derive(Clone, Debug)]
pub struct JointContact<T> {
    /// Its place among the model's contacts.
    pub index: usize,
    /// The joint.
    pub joint: Source,
    /// The coordinates of its rows.
    pub along: [DriveId; 2],
    /// The bodies of the bore or guide, and of the pin or block.
    bodies: [BodyId; 2],
    shape: Shape<T>,
    /// The law of the force that presses.
    pub normal: Normal<T>,
    friction: Friction<T>,
    /// When it touches at every place, in order: one place of a pin, the four corners of a block.
    pub touches: Vec<Vec<Touching>>,
}

impl<T: ForceNumber> JointContact<T> {
    /// Compiles those of the model; rigid ones are none of these, they are constraints while they last.
    pub(crate) fn all(
        mechanism: &Mechanism,
        geometry: &Geometry<T>,
        parameters: &[T],
        problems: &mut Vec<Problem>,
    ) -> Vec<Self> {
        let contacts = mechanism.model.actions.contacts.iter().enumerate();
        contacts
            .filter(|(_, contact)| !is_rigid(contact))
            .map(|(index, contact)| {
                let new = Self::new(mechanism, geometry, parameters, contact)?;
                Ok(Self { index, ..new })
            })
            .filter_map(|contact| match contact {
                Ok(found) => Some(found),
                Err(problem) => {
                    problems.push(problem);
                    None
                }
            })
            .collect()
    }

    fn new(
        mechanism: &Mechanism,
        geometry: &Geometry<T>,
        parameters: &[T],
        contact: &Contact,
    ) -> Result<Self, Problem> {
        let (bodies, shape) = shape(mechanism, geometry, parameters, contact)?;
        let unfit = |why: Unfit| no_contact(contact, why.to_string());
        let normal = law(parameters, contact, &shape)?;
        let of = |scalar: &model::Scalar| model::value(scalar, parameters);
        let words = &contact.properties;
        let friction = match &words.friction {
            None => Friction::none(),
            Some(coefficient) => {
                let [from, to] = match &words.friction_speeds {
                    Some([from, to]) => [of(from), of(to)],
                    None => FRICTION_SPEEDS.map(T::from_f64),
                };
                Friction::ambrosio(of(coefficient), from, to)
            }
        };
        let places = match shape {
            Shape::Pin(_) => 1,
            Shape::Block(_) => 4,
        };
        let touches = (0..places).map(|place| {
            let own = contact.touches.iter().filter(|touch| touch.place == place);
            own.copied().collect()
        });
        Ok(Self {
            index: 0,
            joint: contact.joint.into(),
            along: along(mechanism, contact)?,
            bodies,
            friction: friction.checked().map_err(unfit)?,
            normal,
            touches: touches.collect(),
            shape,
        })
    }

    /// How many places can touch.
    pub fn places(&self) -> usize {
        self.touches.len()
    }

    fn bodies_at(&self, at: &Instant<T>) -> [Body<T>; 2] {
        self.bodies.map(|body| Body {
            pose: at.poses[body.index()],
            motion: at.velocities[body.index()],
        })
    }

    /// Where it touches or would touch at an instant, place by place; `visit` is handed the bodies, too.
    fn each_touch(&self, at: &Instant<T>, mut visit: impl FnMut(usize, &Touch<T>, &[Body<T>; 2])) {
        let bodies = self.bodies_at(at);
        let open = self.along.map(|drive| at.inputs[drive.index()]);
        match &self.shape {
            Shape::Pin(pin) => {
                // The bore's centre seen from the pin's.
                let apart = open.map(|row| -row.value);
                visit(0, &pin.touch_at(&bodies, apart), &bodies);
            }
            Shape::Block(block) => {
                let [angle, off] = open;
                let turned = [angle.c, angle.s];
                let all = block.touches_at(&bodies, off.value, turned);
                for (place, touch) in all.iter().enumerate() {
                    visit(place, touch, &bodies);
                }
            }
        }
    }

    /// How far it is open at a place, m, and how fast it opens, m/s, where the coordinates of its rows are and move so.
    pub fn gap(&self, place: usize, open: [T; 2], rates: [T; 2]) -> [T; 2] {
        match &self.shape {
            Shape::Pin(pin) => pin.gap(open, rates),
            Shape::Block(block) => {
                let swapped = |[angle, off]: [T; 2]| [off, angle];
                block.gap(place, swapped(open), swapped(rates))
            }
        }
    }

    /// What it does to its bodies at an instant, about their origins: `add` is called for each.
    pub(crate) fn act(&self, at: &Instant<T>, mut add: impl FnMut(BodyId, Wrench<T>)) {
        if self.touching(at.time).next().is_none() {
            return;
        }
        self.each_touch(at, |place, touch, bodies| {
            let Some(began) = self.began(place, at.time) else {
                return;
            };
            let forces = touch.forces(&self.normal, &self.friction, T::from_f64(began));
            let wrenches = touch.wrenches(bodies, forces);
            for (body, wrench) in self.bodies.iter().zip(wrenches) {
                add(*body, wrench);
            }
        });
    }

    /// The places that touch at a time.
    pub fn touching(&self, time: f64) -> impl Iterator<Item = usize> {
        (0..self.places()).filter(move |place| self.began(*place, time).is_some())
    }

    /// How fast the contact at a place began that lasts at a time, m/s; none where it does not touch.
    fn began(&self, place: usize, time: f64) -> Option<f64> {
        let touches = self.touches.get(place)?;
        let next = touches.partition_point(|touch| touch.from <= time);
        let last = touches.get(next.checked_sub(1)?)?;
        (time < last.to).then_some(last.speed)
    }
}

/// Adds what contacts do to the bodies at an instant.
pub(crate) fn act<T: ForceNumber>(
    contacts: &[JointContact<T>],
    at: &Instant<T>,
    on_bodies: &mut [Wrench<T>],
) {
    for contact in contacts {
        contact.act(at, |body, w| wrench::add(&mut on_bodies[body.index()], w));
    }
}

/// The power that contacts give to the mechanism, W: what they take up and give back, and what is lost in them.
pub(crate) fn power<T: ForceNumber>(contacts: &[JointContact<T>], at: &Instant<T>) -> T {
    let mut sum = T::zero();
    for contact in contacts {
        contact.act(at, |body, w| {
            sum += wrench::power(w, at.velocities[body.index()]);
        });
    }
    sum
}

/// Whether a contact's bodies resist at once: no force of a law presses them.
pub fn is_rigid(contact: &Contact) -> bool {
    contact.states == ContactStates::Three && law_of(contact) == ContactLaw::Rigid
}

/// The law of a contact of three states: of a block at once unless the file says otherwise, as nobody knows how its corners give.
fn law_of(contact: &Contact) -> ContactLaw {
    let usual = match contact.joint {
        Released::Pin { .. } => ContactLaw::Dissipating(Dissipation::Exact),
        Released::Joint(_) => ContactLaw::Rigid,
    };
    contact.properties.law.unwrap_or(usual)
}

fn no_contact(contact: &Contact, message: String) -> Problem {
    Problem::new("no-contact-law", &contact.span, message)
}

fn missing(contact: &Contact, what: &str, remedy: &'static str) -> Problem {
    no_contact(contact, format!("contact there needs {what}")).remedy(remedy)
}

/// The coordinates of the rows of its joint.
fn along(mechanism: &Mechanism, contact: &Contact) -> Result<[DriveId; 2], Problem> {
    let drives = mechanism.model.drives.iter().enumerate();
    let own = drives.filter(
        |(_, drive)| matches!(drive.kind, DriveKind::Release { of, .. } if of == contact.joint),
    );
    let own: Vec<DriveId> = own.map(|(index, _)| DriveId(index as u32)).collect();
    own.try_into().map_err(|_| {
        no_contact(
            contact,
            "contact is lost at pins and sliders only".to_owned(),
        )
    })
}

fn shape<T: ForceNumber>(
    mechanism: &Mechanism,
    geometry: &Geometry<T>,
    parameters: &[T],
    contact: &Contact,
) -> Result<([BodyId; 2], Shape<T>), Problem> {
    let of = |scalar: &model::Scalar| model::value(scalar, parameters);
    let unfit = |why: Unfit| no_contact(contact, why.to_string());
    let words = &contact.properties;
    let clearance = T::from_f64(contact.clearance);
    let lost = || {
        no_contact(
            contact,
            "contact is lost at pins and sliders only".to_owned(),
        )
    };
    match contact.joint {
        Released::Pin { point, link } => {
            let first = mechanism.model.points.get(point.index());
            let first = first.and_then(|p| p.links.first()).ok_or_else(lost)?;
            let marker = |link| mechanism.marker(LinkPointRef { link, point });
            let (bore, pin) = (
                marker(link).ok_or_else(lost)?,
                marker(*first).ok_or_else(lost)?,
            );
            let radius = words.radius.as_ref().map(of);
            // Without friction nothing hangs on the radius, and the law may be given.
            let needs = words.friction.is_some() || needs_radius(contact);
            if needs && radius.is_none() {
                return Err(missing(
                    contact,
                    "the radius of its pin",
                    "radius = \"10 mm\", beside radial",
                ));
            }
            let radius = radius.unwrap_or(T::zero());
            let places = [geometry.marker(bore), geometry.marker(pin)];
            let radii = [radius + clearance, radius];
            let pin_with_play = PinWithPlay::new(places[0], places[1], radii).map_err(unfit)?;
            Ok(([bore.body, pin.body], Shape::Pin(pin_with_play)))
        }
        Released::Joint(id) => {
            let joint = mechanism.model.joints.get(id.index());
            let kind = joint.map(|j| &j.kind);
            let Some(JointKind::Slider { at, .. }) = kind else {
                return Err(lost());
            };
            let middle = mechanism.marker(*at).ok_or_else(lost)?;
            let (line, along) = slider_rows(mechanism, geometry, contact).ok_or_else(lost)?;
            let length = words.length.as_ref().map(of).ok_or_else(|| {
                let remedy = "length = \"40 mm\", beside radial";
                missing(contact, "the length of the slider", remedy)
            })?;
            let height = words.height.as_ref().map_or(T::zero(), of);
            let local = geometry.line(line);
            let block = BlockInGuide {
                guide: local.origin,
                along: local.direction,
                block: geometry.marker(middle),
                block_along: along,
                half_length: length * 0.5,
                half_height: height * 0.5,
                half_width: height * 0.5 + clearance,
            };
            let block = block.checked().map_err(unfit)?;
            Ok(([line.body, middle.body], Shape::Block(block)))
        }
    }
}

/// The line of a slider, and the direction of its length in its own body.
fn slider_rows<T: ForceNumber>(
    mechanism: &Mechanism,
    geometry: &Geometry<T>,
    contact: &Contact,
) -> Option<(LineRef, [T; 2])> {
    let joint: Source = contact.joint.into();
    let own = || mechanism.constraints.iter().filter(|(_, of)| *of == joint);
    let line = own().find_map(|(row, _)| match row {
        Constraint::ReleasedSlot(row) => Some(row.joint.line),
        _ => None,
    })?;
    let offset = own().find_map(|(row, _)| match row {
        Constraint::Direction(row) => geometry.angles.get(row.offset as usize),
        _ => None,
    })?;
    // The slider's body is turned against the guide's by the offset.
    let [x, y] = geometry.line(line).direction;
    let [c, s] = *offset;
    Some((line, [x * c + y * s, y * c - x * s]))
}

/// Whether the law of a pin follows from its radius.
fn needs_radius(contact: &Contact) -> bool {
    contact.states == ContactStates::Three && contact.properties.stiffness.is_none()
}

/// The law of the force that presses.
fn law<T: ForceNumber>(
    parameters: &[T],
    contact: &Contact,
    shape: &Shape<T>,
) -> Result<Normal<T>, Problem> {
    let words = &contact.properties;
    let of = |scalar: &model::Scalar| model::value(scalar, parameters);
    let unfit = |why: Unfit| no_contact(contact, why.to_string());
    if contact.states == ContactStates::Two {
        let Some(spring) = &words.spring else {
            let remedy = "spring = \"5e7 N/m\", and its damping, beside radial";
            return Err(missing(contact, "a spring where it has two states", remedy));
        };
        return Ok(Normal {
            stiffness: of(spring),
            exponent: 1.0,
            damping: Damping::Viscous(words.damping.as_ref().map_or(T::zero(), of)),
        });
    }
    let stiffness = match (&words.stiffness, shape) {
        (Some(given), _) => of(given),
        (None, Shape::Pin(pin)) => {
            let [modulus, poisson] = STEEL;
            let material = Material {
                modulus: words.modulus.as_ref().map_or(T::from_f64(modulus), of),
                poisson: words.poisson.as_ref().map_or(T::from_f64(poisson), of),
            };
            stiffness([material; 2], pin.radii, Fit::Inside).map_err(unfit)?
        }
        (None, Shape::Block(_)) => {
            let remedy = "stiffness = 1e10 (N/m^1.5), or law = \"rigid\", beside radial";
            let what = "the stiffness of its corners, which follows from no radius";
            return Err(missing(contact, what, remedy));
        }
    };
    let damping = match law_of(contact) {
        ContactLaw::Hertz => Damping::None,
        ContactLaw::Rigid => return Err(no_contact(contact, "a rigid contact has no law".into())),
        ContactLaw::Dissipating(dissipation) => {
            let Some(restitution) = &words.restitution else {
                let remedy = "restitution = 0.9, beside radial; law = \"hertz\" loses nothing";
                return Err(missing(contact, "the restitution of its impacts", remedy));
            };
            let chi = factor(dissipation, of(restitution).value()).map_err(unfit)?;
            Damping::Factor(T::from_f64(chi))
        }
    };
    Ok(Normal {
        stiffness,
        exponent: HERTZ,
        damping,
    })
}

/// The exponent of Hertz's law.
const HERTZ: f64 = 1.5;
