//! `[joints]`, `[drives]` and `[assembly]`.

use kempe_units::{Dimension, Expr};

use crate::drive::{Drive, DriveKind};
use crate::hint::HintKind;
use crate::ids::{FRAME, Line, Scalar};
use crate::item::{File, Item};
use crate::joint::{JointKind, Teeth, ToothSize};
use crate::key_table::{SIDES, word_of};
use crate::link::Side;
use crate::write::spelling::Writer;

type Entries = Vec<(String, Item)>;

impl Writer<'_> {
    pub fn mechanism(&mut self, file: &mut File) {
        let model = self.model;
        let joints = model.joints.iter();
        *file.section("joints") = joints
            .map(|j| (j.name.clone(), Item::Table(self.joint_entry(&j.kind))))
            .collect();
        let drives = model.drives.iter();
        *file.section("drives") = drives
            .filter_map(|d| Some((d.name.clone(), Item::Table(self.drive_entry(d)?))))
            .collect();
        let parameters = model.parameter_values::<f64>();
        if model.starting_elsewhere(&parameters).is_empty() {
            let hints = model.assembly.iter();
            *file.section("assembly") = hints.map(|h| self.hint(&h.kind)).collect();
            return;
        }
        // Hints would be about the start: what is drawn is told as it is drawn.
        let places = model.drawing.places.iter();
        *file.section("places") = places
            .map(|(point, place)| {
                let place = place.at.iter().map(|x| self.scalar(x, Dimension::LENGTH));
                (self.point(*point).to_owned(), Item::List(place.collect()))
            })
            .collect();
    }

    fn joint_entry(&self, kind: &JointKind) -> Entries {
        let text = |key: &str, text: &str| (key.to_owned(), Item::text(text));
        let angle = |key: &str, angle: &Scalar| {
            let given = (!is_nothing(angle)).then(|| self.scalar(angle, Dimension::ANGLE));
            given.map(|item| (key.to_owned(), item))
        };
        let mut entries;
        match kind {
            JointKind::Slider { at, on, angle: a } => {
                entries = vec![
                    text("slider", self.link(at.link)),
                    text("at", self.point(at.point)),
                    text("on", &self.line(*on)),
                ];
                entries.extend(angle("angle", a));
            }
            JointKind::Slot { pin, on } => {
                entries = vec![
                    text("pin", self.point(pin.point)),
                    text("on", &self.line(*on)),
                ];
            }
            JointKind::ArcSlot { pin, on } => {
                let ends = Line {
                    link: on.link,
                    from: on.from,
                    to: on.to,
                };
                entries = vec![
                    text("pin", self.point(pin.point)),
                    text("arc", &self.line(ends)),
                    (
                        "radius".to_owned(),
                        self.scalar(&on.radius, Dimension::LENGTH),
                    ),
                ];
                if on.side == Side::Right {
                    entries.push(text("side", word_of(&SIDES, &on.side)));
                }
                if on.closed {
                    entries.push(("closed".to_owned(), Item::Flag(true)));
                }
            }
            JointKind::CurveSlot { pin, on } => {
                let through = on.through.iter().map(|p| Item::text(self.point(*p)));
                entries = vec![
                    text("pin", self.point(pin.point)),
                    ("through".to_owned(), Item::List(through.collect())),
                ];
                if on.closed {
                    entries.push(("closed".to_owned(), Item::Flag(true)));
                }
            }
            JointKind::Belt {
                a,
                b,
                arm,
                radius_a,
                radius_b,
                crossed,
                chain,
                phase,
            } => {
                let links = [a, b].map(|l| Item::text(self.link(*l)));
                entries = vec![("belt".to_owned(), Item::List(links.to_vec()))];
                match teeth(radius_a).zip(teeth(radius_b)).filter(|_| *chain) {
                    Some(((teeth_a, pitch), (teeth_b, _))) => {
                        let teeth = [teeth_a, teeth_b].map(|t| self.scalar(t, Dimension::NONE));
                        entries.push(("teeth".to_owned(), Item::List(teeth.to_vec())));
                        entries.push(("pitch".to_owned(), self.scalar(pitch, Dimension::LENGTH)));
                    }
                    None => {
                        let radii = [radius_a, radius_b];
                        let radii = radii.map(|r| self.scalar(r, Dimension::LENGTH));
                        entries.push(("radii".to_owned(), Item::List(radii.to_vec())));
                    }
                }
                if *arm != FRAME {
                    entries.push(text("arm", self.link(*arm)));
                }
                if *crossed {
                    entries.push(("crossed".to_owned(), Item::Flag(true)));
                }
                entries.extend(angle("phase", phase));
            }
            JointKind::Weld {
                a,
                b,
                at,
                angle: by,
            } => {
                let links = [a, b].map(|l| Item::text(self.link(*l)));
                entries = vec![
                    ("weld".to_owned(), Item::List(links.to_vec())),
                    text("at", self.point(*at)),
                ];
                entries.extend(angle("angle", by));
            }
            JointKind::Gears {
                a,
                b,
                arm,
                teeth_a,
                teeth_b,
                internal,
                phase,
                teeth: form,
            } => {
                let links = [a, b].map(|l| Item::text(self.link(*l)));
                // A bare number counts teeth.
                let teeth = [teeth_a, teeth_b].map(|size| match form.size {
                    ToothSize::Counted => self.scalar(size, Dimension::NONE),
                    ToothSize::Module(_) => self.expression(size, Dimension::LENGTH),
                });
                entries = vec![
                    ("gears".to_owned(), Item::List(links.to_vec())),
                    ("teeth".to_owned(), Item::List(teeth.to_vec())),
                ];
                if *arm != FRAME {
                    entries.push(text("arm", self.link(*arm)));
                }
                if *internal {
                    entries.push(("internal".to_owned(), Item::Flag(true)));
                }
                entries.extend(angle("phase", phase));
                entries.extend(self.teeth(form));
            }
            JointKind::Rack {
                rack,
                pinion,
                center,
                radius,
                side,
                offset,
                teeth,
            } => {
                entries = vec![
                    text("rack", self.link(*rack)),
                    text("pinion", self.link(*pinion)),
                    text("center", self.point(*center)),
                    ("radius".to_owned(), self.scalar(radius, Dimension::LENGTH)),
                ];
                if *side == Side::Right {
                    entries.push(text("side", word_of(&SIDES, side)));
                }
                if !is_nothing(offset) {
                    entries.push(("offset".to_owned(), self.scalar(offset, Dimension::LENGTH)));
                }
                entries.extend(self.teeth(teeth));
            }
        }
        entries
    }

    fn teeth(&self, teeth: &Teeth) -> Entries {
        let module = match &teeth.size {
            ToothSize::Counted => None,
            ToothSize::Module(module) => module.as_ref(),
        };
        let angle = teeth.pressure_angle.as_ref();
        let mut entries = Entries::new();
        for (key, value, dimension) in [
            ("pressure_angle", angle, Dimension::ANGLE),
            ("module", module, Dimension::LENGTH),
        ] {
            if let Some(value) = value {
                entries.push((key.to_owned(), self.scalar(value, dimension)));
            }
        }
        entries
    }

    /// `None` for what files cannot say, such as a joint that is let go.
    fn drive_entry(&mut self, drive: &Drive) -> Option<Entries> {
        let text = |key: &str, text: &str| (key.to_owned(), Item::text(text));
        let mut entries = match drive.kind {
            DriveKind::Turn { link, relative_to } => {
                let mut entries = vec![text("turns", self.link(link))];
                if relative_to != FRAME {
                    entries.push(text("relative_to", self.link(relative_to)));
                }
                entries
            }
            DriveKind::Cylinder { a, b } => self.ends("cylinder", [&a, &b]),
            DriveKind::Slide { joint } => vec![text("slides", self.joint(joint))],
            DriveKind::Release { .. } | DriveKind::StandIn(_) => return None,
        };
        self.law(drive, &mut entries);
        Some(entries)
    }

    fn hint(&self, kind: &HintKind) -> (String, Item) {
        let near = |item: Item| Item::Table(vec![("near".to_owned(), item)]);
        match kind {
            HintKind::Side {
                point,
                side,
                from,
                to,
            } => {
                let (from, to) = (self.point(*from), self.point(*to));
                let side = format!("{} of {from} -> {to}", word_of(&SIDES, side));
                (self.point(*point).to_owned(), Item::Text(side))
            }
            HintKind::NearPlace { point, x, y } => {
                let place = [x, y].map(|c| self.scalar(c, Dimension::LENGTH));
                (
                    self.point(*point).to_owned(),
                    near(Item::List(place.to_vec())),
                )
            }
            HintKind::NearAngle { link, angle } => {
                let angle = self.scalar(angle, Dimension::ANGLE);
                (self.link(*link).to_owned(), near(angle))
            }
        }
    }
}

/// Whether a value is the zero that stands for one that is not given.
pub(super) fn is_nothing(scalar: &Scalar) -> bool {
    matches!(scalar, Scalar::Const(x) if x.to_bits() == 0)
}

/// Teeth and pitch of a wheel of a chain, from its radius as the reader makes it of them.
fn teeth(radius: &Scalar) -> Option<(&Scalar, &Scalar)> {
    let Expr::Div(round, _) = radius else {
        return None;
    };
    match &**round {
        Expr::Mul(teeth, pitch) => Some((teeth, pitch)),
        _ => None,
    }
}
