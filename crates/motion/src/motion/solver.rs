//! Poses anywhere on a motion: every row is solved by itself.

use kempe_mechanism::PlanNumber;
use kempe_mechanism::{Branch, Configuration, Design};
use kempe_number::Number;

use super::Motion;

/// Storage for solving poses of a motion, reused from row to row.
#[derive(Clone, Debug)]
pub struct Solver<T> {
    /// The branch last used.
    pub branch: Branch,
    /// The state last solved.
    pub state: Configuration<T>,
    /// Drive coordinates last used.
    pub coordinates: Vec<T>,
}

impl<T: PlanNumber> Solver<T> {
    /// Solves with the branch and coordinates set.
    pub fn run(&mut self, motion: &Motion, design: &Design<T>) {
        self.state.set_inputs(motion.mechanism(), &self.coordinates);
        design.solve(&self.branch, &mut self.state);
    }
}

impl Motion {
    /// The motion's design as constants of the number `T`.
    pub fn design_on<T: Number>(&self) -> Design<T> {
        self.plain_design().lift(T::from_f64)
    }

    /// The motion's design, prepared anew.
    fn plain_design(&self) -> Design<f64> {
        self.design_of(&self.design.parameters)
    }

    /// The design of parameter values on the number `T`, its angles counted as this motion counts them.
    pub fn design_of<T: Number>(&self, parameters: &[T]) -> Design<T> {
        let mut design = Design::new(self.mechanism(), parameters);
        design.count_turns(&self.design.geometry.turns);
        design
    }

    /// Storage for solving poses of this motion on the number `T`.
    pub fn solver<T: PlanNumber>(&self) -> Solver<T> {
        Solver {
            branch: Branch::neutral(self.mechanism()),
            state: Configuration::new(self.mechanism()),
            coordinates: vec![T::zero(); self.mechanism().model.drives.len()],
        }
    }

    /// Solves the pose at a path parameter; several drives follow their laws for the design's parameters. The series'
    /// direction, if `T` has one, is the path's.
    pub fn solve<T: PlanNumber>(&self, design: &Design<T>, p: T, solver: &mut Solver<T>) {
        self.branch_at(p.value(), &mut solver.branch);
        (self.path).coordinates_for(p, &design.parameters, &mut solver.coordinates);
        solver.run(self, design);
    }

    /// The same for whom guesses are of no use afterwards: those of the solver's branch may be old.
    pub fn solve_alone<T: PlanNumber>(&self, design: &Design<T>, p: T, solver: &mut Solver<T>) {
        self.branch_to_solve_at(p.value(), &mut solver.branch);
        (self.path).coordinates_for(p, &design.parameters, &mut solver.coordinates);
        solver.run(self, design);
    }
}
