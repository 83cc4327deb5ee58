//! The equations of motion made linear about a pose: `M x" + C x' + K x = f`, `x` the way from the pose.
//!
//! `K` is what the generalised forces lose as the coordinates grow: springs, the geometric stiffness of their tension and of
//! weights and loads, and loads that depend on where the mechanism is. `C` is what they lose as the speeds grow: dampers,
//! viscous friction, loads that depend on speeds. All derivatives are exact: the forces are computed on dual numbers whose
//! parts are the coordinates, speeds and accelerations. Left out is what has no derivative at rest: dry friction.
//!
//! All rests, unless drives are said to move: then what their motion asks of the masses is part of all three, the stiffness and the forces of
//! centrifugal terms, the damping (without any power) of gyroscopic ones.

use std::sync::Arc;

use kempe_measure::measure::{Along, History, measure};
use kempe_measure::{ForceSource as _, Series, State, Varying};
use kempe_mechanism::{BodyId, Branch, Design};
use kempe_model::DriveId;
use kempe_number::{Dual, Number};
use kempe_units::Dimension;

use crate::damper::Damper;
use crate::ends::Ends;
use crate::equations_of_motion::mass_matrix;
use crate::instant::{Rates, cut};
use crate::problem::Problem;
use crate::source::Source;
use crate::spring::Spring;
use crate::virtual_power::project;
use crate::wrench::{self, Wrench};

/// A spring this near to where it goes slack or meets a stop, in parts of its length or of its largest term of tension, is
/// there.
const AT_KINK: f64 = 1e-9;

/// What acts on a link or a body.
type OnOne = Wrench<Rates<Varying>>;

/// The linear equations of motion of some coordinates about a pose at rest. Matrices by rows, in SI as the coordinates of row
/// and column ask.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearised {
    /// How many coordinates.
    pub size: usize,
    /// Mass matrix; what loads take that depend on accelerations included.
    pub mass: Vec<f64>,
    /// Damping matrix.
    pub damping: Vec<f64>,
    /// Stiffness matrix.
    pub stiffness: Vec<f64>,
    /// Sizes of the terms of which the stiffness is the sum: what its rounding is to be counted in.
    pub stiffness_terms: Vec<f64>,
    /// Forces that act along the coordinates at the pose, N or N m: none where it is one of equilibrium.
    pub force: Vec<f64>,
    /// Sizes of the terms of which these are the sums.
    pub force_terms: Vec<f64>,
}

impl Linearised {
    /// Whether all of it is known: a load may have no value.
    pub fn is_finite(&self) -> bool {
        let all = [&self.mass, &self.damping, &self.stiffness, &self.force];
        all.into_iter().flatten().all(|x| x.is_finite())
    }

    /// The largest force over the sizes of its terms: 1e-15 is rounding.
    pub fn imbalance(&self) -> f64 {
        let parts = self.force.iter().zip(&self.force_terms);
        parts.fold(0.0, |most, (force, terms)| {
            let part = if *force == 0.0 {
                0.0
            } else {
                force.abs() / terms
            };
            if part > most || part.is_nan() {
                part
            } else {
                most
            }
        })
    }
}

/// What a linear description leaves out, or takes for something simpler; by their places in the model's actions.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LeftOut {
    /// Somewhere rubs dry friction.
    pub dry_friction: bool,
    /// Dampers that damp differently both ways: the mean counts.
    pub uneven_dampers: Vec<usize>,
}

/// Makes the equations of motion linear, pose by pose.
pub struct Lineariser {
    design: Arc<Design<Series<Varying>>>,
    source: Source<Varying>,
    left_out: LeftOut,
    /// Speeds and accelerations of all drives, SI; nothing where all rest.
    moving: Vec<[f64; 2]>,
}

impl Lineariser {
    /// Prepares a design; `near` are the bodies' angles to within half a turn where springs about pins begin to count turns,
    /// rad.
    ///
    /// # Errors
    /// All problems of what acts on the mechanism.
    pub fn new(design: &Design<f64>, near: &[f64]) -> Result<Self, Vec<Problem>> {
        let mut source = Source::of(design.lift(Rates::from_f64), near)?;
        let acting = &mut source.forces.acting;
        let mut left_out = LeftOut {
            dry_friction: (acting.friction.iter()).any(|f| {
                let dry = [f.law.kinetic, f.law.at_rest, f.law.drag];
                f.rubs() && dry.iter().any(|x| x.value() > 0.0)
            }),
            uneven_dampers: Vec::new(),
        };
        for (index, damper) in acting.dampers.iter_mut().enumerate() {
            if even_out(damper) {
                left_out.uneven_dampers.push(index);
            }
        }
        Ok(Self {
            design: Arc::new(design.lift(Series::from_f64)),
            source,
            left_out,
            moving: Vec::new(),
        })
    }

    /// Lets the drives move with these speeds and accelerations, SI, in all poses from here on; nothing lets all rest.
    pub fn let_move(&mut self, rates: Vec<[f64; 2]>) {
        self.moving = rates;
    }

    /// What is left out of it everywhere.
    pub fn left_out(&self) -> &LeftOut {
        &self.left_out
    }

    /// The linear equations of the coordinates in `free` about the pose on a branch at these coordinates of all drives (SI), where
    /// everything rests unless it was [let move](Self::let_move), at a time, s. NaN where the mechanism cannot be assembled or a load has no value.
    pub fn at(
        &mut self,
        branch: &Branch,
        coordinates: &[f64],
        time: f64,
        free: &[DriveId],
    ) -> Linearised {
        let n = free.len();
        let zero = || vec![0.0; n * n];
        let mut it = Linearised {
            size: n,
            mass: zero(),
            damping: zero(),
            stiffness: zero(),
            stiffness_terms: zero(),
            force: vec![0.0; n],
            force_terms: vec![0.0; n],
        };
        let directions: Vec<(usize, usize)> = (0..3)
            .flat_map(|order| (0..n).map(move |k| (order, k)))
            .collect();
        for chunk in directions.chunks(Varying::zero().eps.len()) {
            self.solve(branch, coordinates, time, free, chunk);
            self.take(free, chunk, &mut it);
        }
        self.count_together(free, &mut it);
        it
    }

    /// Counts the terms of the forces in those of the stiffness, and the other way round, by radians and mechanism sizes: a
    /// weight that no longer pulls has its rounding still.
    fn count_together(&self, free: &[DriveId], it: &mut Linearised) {
        let design = &self.source.forces.design;
        let (n, size) = (it.size, design.plain[0].size(&design.mechanism));
        let unit = |drive: &DriveId| match design.mechanism.model.drives[drive.index()].dimension {
            Dimension::ANGLE => 1.0,
            _ => size,
        };
        let units: Vec<f64> = free.iter().map(unit).collect();
        let forces = it.force_terms.clone();
        for (row, unit) in units.iter().enumerate() {
            for (column, other) in units.iter().enumerate() {
                let terms = &mut it.stiffness_terms[row * n + column];
                it.force_terms[row] += *terms * other;
                *terms += (forces[row] / other + forces[column] / unit) / 2.0;
            }
        }
    }

    /// Fills the instant, with the coordinates, speeds (1) and accelerations (2) of the directions as dual parts.
    fn solve(
        &mut self,
        branch: &Branch,
        coordinates: &[f64],
        time: f64,
        free: &[DriveId],
        directions: &[(usize, usize)],
    ) {
        let moving: Vec<Series<Varying>> = (coordinates.iter().enumerate())
            .map(|(drive, q)| {
                let mut parts = [Varying::zero(); 3];
                parts[0].re = *q;
                if let Some([speed, acceleration]) = self.moving.get(drive) {
                    (parts[1].re, parts[2].re) = (*speed, 0.5 * acceleration);
                }
                for (slot, (order, k)) in directions.iter().enumerate() {
                    if free[*k].index() == drive {
                        // The coefficient of the square is half of the acceleration.
                        parts[*order].eps[slot] = if *order == 2 { 0.5 } else { 1.0 };
                    }
                }
                let [q, v, a] = parts;
                Series::from_coefficients([q, v, a, Dual::zero(), Dual::zero()])
            })
            .collect();
        let state = State::moving(&self.design, branch, Varying::from_f64(time), &moving);
        let source = &mut self.source;
        let amounts: Vec<Series<Varying>> = (source.measures().iter())
            .map(|m| measure(&state, &History::default(), None, m, Along::Time))
            .collect();
        source.instant.set(&state);
        let acting = &source.forces.acting.amounts;
        let filled = source.instant.amounts.iter_mut().zip(&amounts);
        for ((value, measured), amount) in filled.zip(acting) {
            *value = amount.of(cut(*measured));
        }
    }

    /// Adds up what every single thing that acts gives along the free coordinates.
    fn take(&mut self, free: &[DriveId], directions: &[(usize, usize)], it: &mut Linearised) {
        let Source {
            forces, instant, ..
        } = &mut self.source;
        let (design, acting) = (&forces.design, &forces.acting);
        let (mechanism, geometry) = (&*design.mechanism, &design.geometry);
        let n = free.len();
        // The value itself is there with every chunk: it counts with the first.
        let first = directions.first() == Some(&(0, 0));
        let mut add = |on_bodies: &[OnOne]| {
            for (row, drive) in free.iter().enumerate() {
                let along = project(on_bodies, &instant.coefficients[drive.index()]);
                let given = along.value.coefficient(0);
                if first {
                    it.force[row] += given.re;
                    it.force_terms[row] += along.scale;
                }
                for (slot, (order, column)) in directions.iter().enumerate() {
                    let (entry, slope) = (row * n + column, given.eps[slot]);
                    match order {
                        0 => {
                            it.stiffness[entry] -= slope;
                            it.stiffness_terms[entry] += slope.abs();
                        }
                        1 => it.damping[entry] -= slope,
                        _ => it.mass[entry] -= slope,
                    }
                }
            }
        };
        let mut on_links = vec![[Rates::zero(); 3]; forces.applied.len()];
        let mut on_bodies = vec![[Rates::zero(); 3]; mechanism.bodies];
        let mut one = |act: &dyn Fn(&mut [OnOne])| {
            on_links.fill([Rates::zero(); 3]);
            on_bodies.fill([Rates::zero(); 3]);
            act(&mut on_links);
            for (seat, wrench) in mechanism.seats.iter().zip(&on_links) {
                wrench::add(&mut on_bodies[seat.body.index()], *wrench);
            }
            add(&on_bodies);
        };
        for mass in &acting.masses {
            one(&|on| {
                wrench::add(
                    &mut on[mass.link.index()],
                    mass.weight(instant, acting.gravity),
                )
            });
        }
        let moves = !self.moving.is_empty();
        for mass in acting.masses.iter().filter(|_| moves) {
            one(&|on| {
                let asked = mass.inertial(instant);
                wrench::add(&mut on[mass.link.index()], wrench::opposite(asked));
            });
        }
        for load in &acting.loads {
            one(&|on| load.act(mechanism, geometry, instant, on));
        }
        for spring in &acting.springs {
            one(&|on| spring.act(geometry, instant, on));
        }
        for damper in &acting.dampers {
            one(&|on| damper.act(geometry, instant, on));
        }
        on_bodies.fill([Rates::zero(); 3]);
        let mut rub = |body: BodyId, wrench| wrench::add(&mut on_bodies[body.index()], wrench);
        (forces.equilibrium).each_viscous(mechanism, geometry, &acting.friction, instant, &mut rub);
        add(&on_bodies);
        // Where it moves the masses are counted by what they ask.
        if first && !moves {
            let all = mass_matrix(acting, instant);
            let drives = instant.coefficients.len();
            for (row, a) in free.iter().enumerate() {
                for (column, b) in free.iter().enumerate() {
                    it.mass[row * n + column] += all[a.index() * drives + b.index()].value();
                }
            }
        }
    }

    /// How every body moves at the pose last made linear when the free coordinates go with these speeds: the velocity of its
    /// origin and its angular speed.
    pub fn velocities(&self, free: &[DriveId], speeds: &[f64]) -> Vec<[f64; 3]> {
        let coefficients = &self.source.instant.coefficients;
        let bodies = self.source.forces.design.mechanism.bodies;
        let velocity = |body: usize| {
            let mut sum = [0.0; 3];
            for (drive, speed) in free.iter().zip(speeds) {
                let along = &coefficients[drive.index()][body];
                (0..3).for_each(|k| sum[k] += along[k].value() * speed);
            }
            sum
        };
        (0..bodies).map(velocity).collect()
    }

    /// Springs that are where their law has a kink at the pose last made linear, by their place in the model's actions: the
    /// stiffness of one side counts.
    pub fn springs_at_kinks(&self) -> Vec<usize> {
        let design = &self.source.forces.design;
        let (geometry, size) = (&design.geometry, design.plain[0].size(&design.mechanism));
        let at_kink = |spring: &Spring<Rates<Varying>>| {
            let length = spring.length(geometry, &self.source.instant).value();
            let law = &spring.law;
            let stops = law.stops.iter().flatten();
            let mut stops =
                stops.map(|stop| (length - stop.value()).abs() <= AT_KINK * length.abs());
            let terms = [law.preload.value(), law.stiffness.value() * length];
            let most = terms.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let own = terms[0] + law.stiffness.value() * (length - law.free.value());
            // Ends that meet and are drawn together or pushed apart all the same.
            let met = matches!(spring.ends, Ends::Points(_))
                && length <= AT_KINK * size
                && terms[0] != law.stiffness.value() * law.free.value();
            let slack = law.acts != kempe_model::Acts::Both && own.abs() <= AT_KINK * most;
            met || slack || stops.any(|at| at)
        };
        let springs = self.source.forces.acting.springs.iter().enumerate();
        springs
            .filter(|(_, s)| at_kink(s))
            .map(|(k, _)| k)
            .collect()
    }
}

/// Gives a damper its mean damping both ways; whether that changes it. Over a cycle of vibration it takes the same energy.
fn even_out(damper: &mut Damper<Rates<Varying>>) -> bool {
    let uneven = damper.parting.value() != damper.closing.value();
    let mean = (damper.parting + damper.closing) / 2.0;
    (damper.parting, damper.closing) = (mean, mean);
    uneven
}
