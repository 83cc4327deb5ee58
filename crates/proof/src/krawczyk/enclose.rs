//! One pose, proved: its middle is polished, and a box about it looked for.

use kempe_mechanism::constraint::Input;
use kempe_mechanism::pose::Pose;
use kempe_number::{Interval, Number};

use super::contract::multiply;
use super::given::Given;
use super::system::{Middle, System};
use crate::not_proved::NotProved;

impl System {
    /// Proves one pose near `middle` for the given inputs, which may be intervals, and encloses it in `poses`. Poses of
    /// bodies that are not sought are taken as they are. Returns where it lies about the middle, and the determinant there.
    pub fn enclose(
        &self,
        given: &Given<'_>,
        middle: &mut Middle,
        poses: &mut [Pose<Interval>],
    ) -> Result<(Vec<Interval>, f64), NotProved> {
        let plain_inputs: Vec<Input<f64>> = given.inputs.iter().map(Input::plain).collect();
        let (qr, inverse) = self.polish(given, &plain_inputs, poses, middle)?;
        let still = vec![0.0; self.size];
        let zero = Interval::from_f64(0.0);
        let here = (still.as_slice(), zero);
        self.spread(middle, here, &vec![zero; self.size], poses);
        let residuals = self.residuals(given.mechanism, &given.situation(poses));
        let value = multiply(&inverse, &residuals);
        let (_, image) = self.contract(given, &inverse, &value, false, poses, |reach, poses| {
            self.spread(middle, here, reach, poses);
        })?;
        self.spread(middle, here, &image, poses);
        Ok((image, qr.determinant()))
    }
}
