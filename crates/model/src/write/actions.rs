//! What acts: gravity, loads, masses, springs, dampers, friction, cylinders, motors.

use kempe_units::{Dimension, Unit};

use crate::amount::Amount;
use crate::clearance::ClearanceAt;
use crate::contact::{ContactProperties, FrictionOnset};
use crate::ids::{FRAME, LinkId, LinkPointRef, PointId, Scalar};
use crate::item::{File, Item};
use crate::key_table::clearance::{LAWS, OF_ALL};
use crate::key_table::{ACTS, LEAKAGE, ON_OFF, word_of};
use crate::link::Place;
use crate::load::{
    Acts, Between, Damper, Friction, FrictionAt, HydraulicCylinder, Load, LoadKind, Motor,
    PointMass, Spring,
};
use crate::oil::Oil;
use crate::read::springs::tension;
use crate::write::mechanism::is_nothing;
use crate::write::spelling::Writer;

type Entries = Vec<(String, Item)>;

impl Writer<'_> {
    pub fn gravity(&self, file: &mut File) {
        if let Some(gravity) = &self.model.actions.gravity {
            let [x, y] = gravity
                .each_ref()
                .map(|part| self.scalar(part, Dimension::ACCELERATION));
            file.head
                .push(("gravity".to_owned(), Item::List(vec![x, y])));
        }
    }

    pub fn actions(&mut self, file: &mut File) {
        let acting = &self.model.actions;
        for load in &acting.loads {
            let entry = (load.name.clone(), Item::Table(self.load(load)));
            file.section("loads").push(entry);
        }
        for mass in &acting.masses {
            let entry = (mass.name.clone(), Item::Table(self.mass(mass)));
            file.section("masses").push(entry);
        }
        for spring in &acting.springs {
            let entry = (spring.name.clone(), Item::Table(self.spring(spring)));
            file.section("springs").push(entry);
        }
        for damper in &acting.dampers {
            let entry = (damper.name.clone(), Item::Table(self.damper(damper)));
            file.section("dampers").push(entry);
        }
        for friction in &acting.friction {
            let entry = self.friction(friction);
            file.section("friction").push(entry);
        }
        for cylinder in &acting.cylinders {
            let name = self.drive(cylinder.drive).to_owned();
            let mut entries = self.cylinder(cylinder);
            if let Some(oil) = &cylinder.oil {
                let oil = self.oil(&name, oil);
                entries.push(("oil".to_owned(), Item::Table(oil)));
            }
            let entry = (name, Item::Table(entries));
            file.section("cylinders").push(entry);
        }
        for motor in &acting.motors {
            let name = self.drive(motor.drive).to_owned();
            let mut entries = self.motor(motor);
            if let Some(throttle) = &motor.throttle {
                let throttle = self.amount(&name, throttle, Dimension::NONE);
                entries.push(("throttle".to_owned(), throttle));
            }
            file.section("motors").push((name, Item::Table(entries)));
        }
        for switch in &acting.switches {
            let off = switch.off.as_ref().map(|off| self.text("off", &off.text));
            let starts = switch
                .starts
                .map(|on| self.text("starts", word_of(&ON_OFF, &on)));
            let every = self.given("every", &switch.every, switch.on.dimension);
            let entries = [Some(self.text("on", &switch.on.text)), off, every, starts];
            let entries = entries.into_iter().flatten().collect();
            file.section("switches")
                .push((switch.name.clone(), Item::Table(entries)));
        }
    }

    pub fn clearances(&self, file: &mut File) {
        for clearance in &self.model.clearances {
            let radial = self.value("radial", &clearance.radial, Dimension::LENGTH);
            let mut entries = vec![radial];
            let name = match &clearance.at {
                ClearanceAt::Pin { point, on } => {
                    let links: Vec<Item> = on.iter().map(|l| Item::text(self.link(*l))).collect();
                    if !links.is_empty() {
                        entries.push(("on".to_owned(), Item::List(links)));
                    }
                    entries.extend(self.holder(*point));
                    self.point(*point)
                }
                ClearanceAt::Joint(joint) => self.joint(*joint),
                ClearanceAt::All => OF_ALL.name,
            };
            self.contact(&clearance.contact, &mut entries);
            let entry = (name.to_owned(), Item::Table(entries));
            file.section("clearance").push(entry);
        }
    }

    fn contact(&self, contact: &ContactProperties, entries: &mut Vec<(String, Item)>) {
        let mut put = |key: &str, value: &Option<Scalar>, dimension: Dimension| {
            let value = value.as_ref();
            entries.extend(value.map(|value| self.value(key, value, dimension)));
        };
        put("radius", &contact.radius, Dimension::LENGTH);
        put("length", &contact.length, Dimension::LENGTH);
        put("height", &contact.height, Dimension::LENGTH);
        put("restitution", &contact.restitution, Dimension::NONE);
        put("stiffness", &contact.stiffness, Dimension::NONE);
        put("modulus", &contact.modulus, Dimension::PRESSURE);
        put("poisson", &contact.poisson, Dimension::NONE);
        put("spring", &contact.spring, Dimension::STIFFNESS);
        put("damping", &contact.damping, Dimension::DAMPING);
        put("friction", &contact.friction, Dimension::NONE);
        if let Some(law) = &contact.law {
            entries.push(self.text("law", word_of(&LAWS, law)));
        }
        match &contact.onset {
            None => {}
            Some(FrictionOnset::Ramp(Some(speeds))) => {
                let speeds = speeds.iter().map(|v| self.scalar(v, Dimension::SPEED));
                entries.push(("friction_speeds".to_owned(), Item::List(speeds.collect())));
            }
            Some(onset) => {
                let sticks = *onset == FrictionOnset::Sticks;
                entries.push(("stiction".to_owned(), Item::Flag(sticks)));
            }
        }
    }

    fn text(&self, key: &str, text: &str) -> (String, Item) {
        (key.to_owned(), Item::text(text))
    }

    fn value(&self, key: &str, value: &Scalar, dimension: Dimension) -> (String, Item) {
        (key.to_owned(), self.scalar(value, dimension))
    }

    /// A value that may be given.
    fn given(
        &self,
        key: &str,
        value: &Option<Scalar>,
        dimension: Dimension,
    ) -> Option<(String, Item)> {
        value.as_ref().map(|v| self.value(key, v, dimension))
    }

    fn load(&mut self, load: &Load) -> Entries {
        match &load.kind {
            LoadKind::Force {
                at,
                components,
                axes,
            } => {
                let [x, y] = components;
                let x = self.amount(&load.name, x, Dimension::FORCE);
                let y = self.amount(&load.name, y, Dimension::FORCE);
                let mut entries = vec![
                    ("force".to_owned(), Item::List(vec![x, y])),
                    self.text("at", self.point(at.point)),
                ];
                if self.carrier(at.point) != Some(at.link) {
                    entries.push(self.text("on", self.link(at.link)));
                }
                if *axes != FRAME {
                    entries.push(self.text("axes", self.link(*axes)));
                }
                entries
            }
            LoadKind::Torque {
                on,
                against,
                amount,
            } => {
                let torque = self.amount(&load.name, amount, Dimension::TORQUE);
                let mut entries = vec![
                    ("torque".to_owned(), torque),
                    self.text("on", self.link(*on)),
                ];
                if *against != FRAME {
                    entries.push(self.text("against", self.link(*against)));
                }
                entries
            }
        }
    }

    /// The link that a force at a point acts on where none is named.
    fn carrier(&self, point: PointId) -> Option<LinkId> {
        let links = &self.model.points.get(point.index())?.links;
        let moving = links.iter().find(|l| **l != FRAME);
        moving.or(links.first()).copied()
    }

    fn amount(&mut self, name: &str, amount: &Amount, dimension: Dimension) -> Item {
        match amount {
            Amount::Measure(measure) => match measure.as_constant() {
                Some(x) if x.to_bits() == 0 => Item::Number(0.0),
                _ => self.measure(measure, dimension),
            },
            Amount::Table {
                over,
                over_dimension,
                at,
                values,
                period,
                factor,
            } => {
                let of_factor = self.measures(factor).dimension;
                let is = (dimension / of_factor).without_idle_angle();
                let columns = [head("argument", *over_dimension), head("value", is)];
                let table = self.table(name, &[(&columns[0], at), (&columns[1], values)]);
                let mut entries = vec![
                    ("table".to_owned(), table),
                    ("over".to_owned(), self.measure(over, *over_dimension)),
                    ("factor".to_owned(), self.scalar(factor, of_factor)),
                ];
                let period = period.map(Scalar::Const);
                entries.extend(self.given("period", &period, *over_dimension));
                Item::Table(entries)
            }
        }
    }

    fn mass(&self, mass: &PointMass) -> Entries {
        // one at a point of its link has that point's place
        let link = self.model.links.get(mass.on.index());
        let mut points = link.into_iter().flat_map(|l| &l.points);
        let at = match points.find(|p| p.place == mass.place) {
            Some(point) => Item::text(self.point(point.point)),
            None => self.place(&mass.place),
        };
        debug_assert!(
            !matches!((&at, &mass.place), (Item::List(_), Place::Triangle { .. })),
            "a corner of a triangle is a point"
        );
        vec![
            self.text("on", self.link(mass.on)),
            ("at".to_owned(), at),
            self.value("mass", &mass.mass, Dimension::MASS),
        ]
    }

    fn between(&self, between: &Between) -> Entries {
        match between {
            Between::Points(a, b) => self.ends("between", [a, b]),
            Between::Links(a, b) => {
                let links = [a, b].map(|l| Item::text(self.link(*l)));
                vec![("links".to_owned(), Item::List(links.to_vec()))]
            }
        }
    }

    /// Two points, with the links that are meant where several could be.
    pub(super) fn ends(&self, key: &str, ends: [&LinkPointRef; 2]) -> Entries {
        let pair = ends.map(|end| self.point(end.point)).join("-");
        let shared = |end: &&LinkPointRef| {
            let point = self.model.points.get(end.point.index());
            end.link != FRAME && point.is_some_and(|p| p.links.len() > 1)
        };
        let on = ends.into_iter().filter(shared);
        let on: Vec<Item> = on.map(|end| Item::text(self.link(end.link))).collect();
        let on = match on.len() {
            0 => None,
            1 => on.into_iter().next(),
            _ => Some(Item::List(on)),
        };
        let mut entries = vec![self.text(key, &pair)];
        entries.extend(on.map(|on| ("on".to_owned(), on)));
        entries
    }

    fn spring(&self, spring: &Spring) -> Entries {
        let force = tension(&spring.between);
        let travel = match spring.between {
            Between::Points(..) => Dimension::LENGTH,
            Between::Links(..) => Dimension::ANGLE,
        };
        let per = force / travel;
        let mut entries = self.between(&spring.between);
        entries.push(self.value("stiffness", &spring.stiffness, per));
        entries.push(self.value("free", &spring.free, travel));
        // without stiffness its force must be told, even if it has none
        let values = self.model.parameter_values::<f64>();
        let limp = crate::value(&spring.stiffness, &values) == 0.0;
        if limp || !is_nothing(&spring.preload) {
            entries.push(self.value("preload", &spring.preload, force));
        }
        if spring.acts != Acts::default() {
            entries.push(self.text("acts", word_of(&ACTS, &spring.acts)));
        }
        if spring.stops.iter().any(Option::is_some) {
            let stop = |stop: &Option<Scalar>| match stop {
                Some(stop) => self.scalar(stop, travel),
                None => Item::text("none"),
            };
            let stops = spring.stops.iter().map(stop).collect();
            entries.push(("stops".to_owned(), Item::List(stops)));
        }
        entries.extend(self.given("stop_stiffness", &spring.stop_stiffness, per));
        entries
    }

    fn damper(&self, damper: &Damper) -> Entries {
        let per = match damper.between {
            Between::Points(..) => Dimension::DAMPING,
            Between::Links(..) => Dimension::TORSIONAL_DAMPING,
        };
        let mut entries = self.between(&damper.between);
        entries.push(self.value("damping", &damper.damping, per));
        entries.extend(self.given("closing", &damper.closing, per));
        entries
    }

    fn friction(&self, friction: &Friction) -> (String, Item) {
        let (name, viscous, drag) = match friction.at {
            FrictionAt::Pin(point) => (
                self.point(point),
                Dimension::TORSIONAL_DAMPING,
                Dimension::TORQUE,
            ),
            FrictionAt::Joint(joint) => (self.joint(joint), Dimension::DAMPING, Dimension::FORCE),
            FrictionAt::All => ("all", Dimension::DAMPING, Dimension::FORCE),
        };
        let number = Dimension::NONE;
        let mut entries = vec![self.value("coefficient", &friction.coefficient, number)];
        let more = [
            self.given("static", &friction.static_coefficient, number),
            self.given("stribeck", &friction.stribeck_speed, Dimension::SPEED),
            self.given("viscous", &friction.viscous, viscous),
            self.given("drag", &friction.drag, drag),
            self.given("radius", &friction.radius, Dimension::LENGTH),
        ];
        entries.extend(more.into_iter().flatten());
        if let FrictionAt::Pin(point) = friction.at {
            entries.extend(self.holder(point));
        }
        (name.to_owned(), Item::Table(entries))
    }

    /// The link that a pin sits fast in, where it is named.
    fn holder(&self, point: PointId) -> Option<(String, Item)> {
        let holder = self.model.points.get(point.index())?.holder?;
        Some(("holder".to_owned(), Item::text(self.link(holder))))
    }

    fn cylinder(&self, cylinder: &HydraulicCylinder) -> Entries {
        let pressure = Dimension::PRESSURE;
        let mut entries = vec![
            self.value("bore", &cylinder.bore, Dimension::LENGTH),
            self.value("rod", &cylinder.rod, Dimension::LENGTH),
        ];
        let unless = |nothing: bool, entry: (String, Item)| (!nothing).then_some(entry);
        let one = matches!(cylinder.count, Scalar::Const(1.0));
        let more = [
            self.given("supply", &cylinder.supply, pressure),
            self.given("relief", &cylinder.relief, pressure),
            unless(
                is_nothing(&cylinder.back),
                self.value("back", &cylinder.back, pressure),
            ),
            self.given("flow", &cylinder.flow, Dimension::FLOW),
            unless(
                is_nothing(&cylinder.friction),
                self.value("friction", &cylinder.friction, Dimension::FORCE),
            ),
            unless(one, self.value("count", &cylinder.count, Dimension::NONE)),
        ];
        entries.extend(more.into_iter().flatten());
        entries
    }

    fn oil(&mut self, name: &str, oil: &Oil) -> Entries {
        let pressure = Dimension::PRESSURE;
        let both = |it: &Self, key: &str, both: &[Scalar; 2], dimension: Dimension| {
            let both = both.iter().map(|value| it.scalar(value, dimension));
            (key.to_owned(), Item::List(both.collect()))
        };
        let mut opening = |opening: &Amount| self.amount(name, opening, Dimension::NONE);
        let valve = match &oil.valve {
            (bore, None) => opening(bore),
            (bore, Some(ring)) => Item::List(vec![opening(bore), opening(ring)]),
        };
        let mut entries = vec![
            self.value("bulk_modulus", &oil.bulk_modulus, pressure),
            both(self, "volume", &oil.volume, Dimension::VOLUME),
            ("valve".to_owned(), valve),
            self.value("flow", &oil.flow, Dimension::FLOW),
            self.value("drop", &oil.drop, pressure),
        ];
        if let Some([closed, stroke]) = &oil.stroke {
            entries.push(self.value("closed", closed, Dimension::LENGTH));
            entries.push(self.value("stroke", stroke, Dimension::LENGTH));
        }
        entries.extend(self.given("hose_modulus", &oil.hose_modulus, pressure));
        entries.extend(self.given("wall_modulus", &oil.wall_modulus, pressure));
        if !is_nothing(&oil.damping) {
            entries.push(self.value("damping", &oil.damping, Dimension::DAMPING));
        }
        if !is_nothing(&oil.leakage) {
            entries.push(self.value("leakage", &oil.leakage, LEAKAGE));
        }
        entries.extend((oil.start.iter()).map(|start| both(self, "start", start, pressure)));
        entries
    }

    fn motor(&self, motor: &Motor) -> Entries {
        let pair = |(speed, torque): &(Scalar, Scalar)| {
            Item::List(vec![
                self.scalar(speed, Dimension::ANGULAR_SPEED),
                self.scalar(torque, Dimension::TORQUE),
            ])
        };
        let curve = motor.curve.iter().map(pair).collect();
        vec![("curve".to_owned(), Item::List(curve))]
    }
}

/// The head of a column in SI; of what no unit measures a bare number is in SI.
fn head(name: &str, dimension: Dimension) -> String {
    let unit = Unit::for_display(dimension, &[]);
    match unit.text() {
        "" => name.to_owned(),
        unit => format!("{name} [{unit}]"),
    }
}
