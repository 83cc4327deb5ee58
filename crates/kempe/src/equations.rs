//! The equations of motion of a pose.

use std::sync::Arc;

use kempe_dynamics::{EquationsOfMotion, Rates, Source};
use kempe_measure::measure::{Along, History, measure};
use kempe_measure::{ForceSource, Series, State};
use kempe_mechanism::Branch;
use kempe_model::Diagnostic;
use kempe_number::Number;
use kempe_study::force_problems;

use crate::Error;
use crate::pose::Pose;

impl Pose {
    /// The equations of motion `M q" + h = Q` here in the coordinates of the drives, SI, in the order of
    /// [`Compiled::drives`](crate::Compiled::drives), whose speeds are these: what a controller or a simulation of one's own
    /// wants. `h` is what the drives give where none of them accelerates, from weights, loads, springs, dampers and speeds;
    /// friction is not in it. Loads that go by the time are those of the pose's.
    ///
    /// # Errors
    ///
    /// `wrong-length` where there are not as many speeds as drives; `not-finite` where a speed is no number; what is wrong
    /// with what acts; `no-value` at a singular pose, or where a load has none.
    ///
    /// # Example
    ///
    /// A double pendulum of two rods of 0.5 m with 1 kg at the end of each, its angles from the horizontal, as every book on mechanics has it:
    ///
    /// ```
    /// # fn main() -> Result<(), kempe::Error> {
    /// # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/gallery/double-pendulum.toml");
    /// let mut s = kempe::Model::from_path(path)?.compile()?.session();
    /// let (l, g, a, b) = (0.5, 9.81, -1.0_f64, 0.3_f64);
    /// let [v, w] = [2.0, -3.0];
    /// let p = s.pose([("upper_angle", a), ("lower_angle", b)])?;
    /// let equations = p.equations_of_motion(&[v, w])?;
    /// let coupling = l * l * (a - b).cos();
    /// let turning = l * l * (a - b).sin();
    /// let mass = [2.0 * l * l, coupling, coupling, l * l];
    /// let bias = [
    ///     turning * w * w + 2.0 * g * l * a.cos(),
    ///     -turning * v * v + g * l * b.cos(),
    /// ];
    /// let near = |found: &[f64], known: &[f64]| found.iter().zip(known).all(|(f, k)| (f - k).abs() < 1e-12);
    /// assert!(near(&equations.mass, &mass) && near(&equations.bias, &bias));
    /// // How both fall when they are let go.
    /// let free = [kempe::model::DriveId(0), kempe::model::DriveId(1)];
    /// let falls = equations.accelerations(&free, &[0.0; 2], &[0.0; 2]).unwrap();
    /// assert!(near(&equations.needed(&falls), &[0.0; 2]));
    /// # Ok(())
    /// # }
    /// ```
    pub fn equations_of_motion(&self, speeds: &[f64]) -> Result<EquationsOfMotion<f64>, Error> {
        let drives = self.coordinates.len();
        if speeds.len() != drives {
            let message = format!("{} speeds for {drives} drives", speeds.len());
            let diagnostic = Diagnostic::error("wrong-length", message);
            return Err(self
                .compiled
                .error(diagnostic.help("give one speed for each drive, SI")));
        }
        if let Some(speed) = speeds.iter().find(|speed| !speed.is_finite()) {
            let diagnostic = Diagnostic::error("not-finite", format!("a speed is {speed}"));
            return Err(self
                .compiled
                .error(diagnostic.help("give finite speeds, in SI")));
        }
        let motion = &self.motion;
        let no_value = |why: &str| {
            let message = format!("no equations of motion here: {why}");
            self.compiled.error(Diagnostic::error("no-value", message))
        };
        // What a row of the motion would say: at a limit or where branches cross coordinates of drives do not tell how it moves.
        if let Some(note) = self.row_note() {
            return Err(no_value(&note));
        }
        let mut source = Source::new(motion, &motion.design.parameters)
            .map_err(|problems| self.compiled.errors(force_problems(problems)))?;
        let mut branch = Branch::neutral(motion.mechanism());
        motion.branch_at(self.at, &mut branch);
        let moving: Vec<Series<f64>> = (self.coordinates.iter().zip(speeds))
            .map(|(q, speed)| Series::from_coefficients([*q, *speed, 0.0, 0.0, 0.0]))
            .collect();
        let design = Arc::new(motion.design_on::<Series<f64>>());
        let state = State::moving(&design, &branch, self.time(), &moving);
        let amounts: Vec<Series<f64>> = (source.measures().iter())
            .map(|m| measure(&state, &History::default(), None, m, Along::Time))
            .collect();
        source.solve(&state, &amounts);
        let found = source.forces.equations_of_motion(&source.instant);
        let plain = |all: &[Rates]| all.iter().map(|it| it.value()).collect();
        let equations = EquationsOfMotion {
            size: found.size,
            mass: plain(&found.mass),
            bias: plain(&found.bias),
        };
        let mut known = equations.mass.iter().chain(&equations.bias);
        match known.all(|it| it.is_finite()) {
            true => Ok(equations),
            false => Err(no_value("a load has no value")),
        }
    }
}
