//! Mechanisms for the tests of simulations.
#![allow(clippy::unwrap_used, dead_code)]

use kempe_mechanism::{Design, Mechanism};
use kempe_model::{
    Center, ClearanceAt, Contact, ContactStates, DriveId, Inertia, Measure, Model, Place, Released,
    value,
};
use kempe_motion::Silent;
use kempe_simulate::{Method, Question, Resistance, Simulated, Stop, simulate};
use kempe_units::Expr;

/// A mechanism whose drives are all let go.
pub struct Free {
    pub model: Model,
    pub design: Design<f64>,
    pub question: Question,
}

impl Free {
    /// From where its laws start, at rest, for so long.
    pub fn new(text: &str, until: f64) -> Self {
        let read = Model::from_toml(text, "free", &mut |_| Err("no files".into())).unwrap();
        let model = read.model;
        let design = Design::new(&Mechanism::new(&model), &model.parameter_values());
        let free: Vec<DriveId> = (0..model.drives.len() as u32).map(DriveId).collect();
        let start = (model.drives.iter())
            .map(|d| [d.law.at(0.0, &design.parameters), 0.0])
            .collect();
        Self {
            question: Question {
                free,
                start,
                until,
                tolerance: 1e-13,
                method: Method::Choose,
                stops: Vec::new(),
                end_when: Vec::new(),
                coordinates: kempe_simulate::Coordinates::Minimal,
                contacts: Vec::new(),
            },
            design,
            model,
        }
    }

    /// The named measure as one that is asked for.
    pub fn measure(&self, name: &str) -> Measure {
        let found = self.model.measures.iter().find(|m| m.name == name);
        found.unwrap().measure.clone()
    }

    pub fn stop(&mut self, name: &str, restitution: f64) {
        let gap = self.measure(name);
        self.question.stops.push(Stop {
            gap,
            resistance: Resistance::Rigid { restitution },
        });
    }

    /// Gives its joint the first clearance of the file; where its bodies start there, see [`Contact::start`].
    pub fn play(&mut self, states: ContactStates, start: [[f64; 2]; 2]) {
        let clearance = &self.model.clearances[0];
        let joint = match clearance.at {
            ClearanceAt::Pin { point, .. } => Released::Pin {
                point,
                link: *self.model.points[point.index()].links.last().unwrap(),
            },
            ClearanceAt::Joint(joint) => Released::Joint(joint),
            ClearanceAt::All => panic!("at no joint"),
        };
        self.question.contacts = vec![Contact {
            joint,
            clearance: value(&clearance.radial, &self.design.parameters),
            properties: clearance.contact.clone(),
            states,
            start,
            touches: Vec::new(),
            span: 0..0,
        }];
    }

    pub fn run(&self) -> Simulated {
        simulate(&self.design, &self.question, &mut Silent).unwrap()
    }
}

/// Coordinate and speed of a drive at a time.
pub fn at(found: &Simulated, drive: usize, time: f64) -> [f64; 2] {
    use kempe_number::Jet;
    let q: Jet<f64, 2> = found.laws[drive].at(Jet::variable(time), &[]);
    [q.derivative(0), q.derivative(1)]
}

/// Gives every link some mass, in proportion to a scale (m).
pub fn weigh(model: &mut Model, scale: f64, mut random: impl FnMut(f64, f64) -> f64) {
    for link in &mut model.links {
        let mut number = |low: f64, high: f64| Expr::Const(random(low, high));
        link.inertia = Some(Inertia {
            mass: Some(number(0.1, 2.0)),
            moment: Some(number(0.05 * scale * scale, 0.2 * scale * scale)),
            center: Center::Place(Place::Cartesian {
                x: number(-0.3 * scale, 0.3 * scale),
                y: number(-0.3 * scale, 0.3 * scale),
            }),
        });
    }
}
