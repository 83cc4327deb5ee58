//! One stretch of a motion, proved, and its tie to the one before.

use kempe_mechanism::configuration::input_of;
use kempe_mechanism::evidence::is_finite;
use kempe_mechanism::pose::Pose;
use kempe_motion::bridge::across;
use kempe_number::{Interval, Number};

use super::{Cell, Certifier, same_but};
use crate::krawczyk::{Curve, Given, Middle, Tube, middle_of};
use crate::not_proved::NotProved;

impl Certifier {
    /// Proves the stretch from one path parameter to another.
    pub(super) fn cell(&mut self, from: f64, to: f64) -> Result<(Cell, Tube), NotProved> {
        let range = Interval::new(from, to);
        self.prepare(range)?;
        let at = range.midpoint();
        let traced = self.traced(at)?;
        let motion = &*self.motion.clone();
        let size = motion.size();
        let drives = &motion.mechanism().model.drives;
        let mut coordinates = vec![Curve::zero(); drives.len()];
        let mut curve = |p: Curve| {
            motion.path.coordinates(p, &mut coordinates);
            drives
                .iter()
                .zip(&coordinates)
                .map(|(drive, q)| input_of(drive, *q))
                .collect()
        };
        let (inputs, near) = (&self.wide.state.inputs, &self.plain.branch.near);
        let given = Given::new(&self.design, inputs, near, size);
        let poses = &mut self.wide.state.poses;
        let tube = self.system.tube(
            &given,
            &self.rich,
            (at, range),
            traced.clone(),
            poses,
            &mut curve,
        )?;
        if !same_but(&self.idle, &traced, &tube.middle, size) {
            return Err(NotProved::NoPose);
        }
        if let Err(reason @ NotProved::Contradiction { .. }) = self.check_redundant() {
            return Err(reason);
        }
        let cell = Cell {
            from,
            to,
            poses: self.wide.state.poses.clone(),
            tube: self.system.narrowest(&tube.radii, size),
            widest: self.system.widest(&tube.image, size),
            joined: false,
        };
        Ok((cell, tube))
    }

    /// Whether the pose at `p` is proved to be the pose of all these tubes.
    pub(super) fn joins(&mut self, tubes: &[&Tube], p: f64) -> bool {
        let mut attempt = || -> Result<bool, NotProved> {
            self.prepare(Interval::from_f64(p))?;
            let mut middle = self.traced(p)?;
            let size = self.motion.size();
            let (inputs, near) = (&self.wide.state.inputs, &self.plain.branch.near);
            let given = Given::new(&self.design, inputs, near, size);
            let poses = &mut self.wide.state.poses;
            let (image, _) = self.system.enclose(&given, &mut middle, poses)?;
            Ok(tubes
                .iter()
                .all(|tube| self.system.is_in_tube(tube, p, &middle, &image)))
        };
        attempt().unwrap_or(false)
    }

    /// Where the traced branch is at a path parameter, to full accuracy: solved, or joined across a change point.
    fn traced(&mut self, p: f64) -> Result<Middle, NotProved> {
        let motion = &*self.motion.clone();
        if let Some(event) = motion.bridge(p) {
            let joined = across::<1>(motion, &self.side, event, p, &mut motion.solver());
            motion.branch_at(p, &mut self.plain.branch);
            self.plain.state.poses = joined.iter().map(Pose::value).collect();
        } else {
            motion.solve(&motion.design, p, &mut self.plain);
        }
        let poses = &self.plain.state.poses;
        if !poses.iter().all(is_finite) {
            return Err(NotProved::NoPose);
        }
        Ok(middle_of(poses, &self.plain.branch.near))
    }
}
