//! The oil in hydraulic cylinders that are let go: how their pressures change, and with what force they push.
//!
//! Of two values the first is that of the bore's side, the second that of the ring round the rod. Pressures count from that of
//! the air. With the length `L` of the drive, the stroke `s = L - closed` and pressures `p0`, `p1`
//!
//! ```text
//! force = A0 p0 - A1 p1 - d L'
//! p0' = K0/V0 (-A0 L' + Q0 - Ql)      V0 = volume0 + A0 s
//! p1' = K1/V1 ( A1 L' + Q1 + Ql)      V1 = volume1 + A1 (stroke - s)
//! Q = u Qn root((ps - p) / dpn), or u Qn root((p - pt) / dpn) where u < 0; Ql = leakage (p0 - p1)
//! 1/K = 1/K_oil + (V - volume)/(V K_wall) + volume/(V K_hose)
//! ```
//!
//! Without a stroke the volumes are constant. The root has the sign of what is under it; below a small drop the flow is laminar
//! and goes to zero smoothly. The law is that of `HydraulicActuatorSimple` of Exudyn (Gerstmayr), with leakage.

use kempe_mechanism::Mechanism;
use kempe_model::{self as model, Chamber, DriveId, HydraulicCylinder};

use crate::amount::Amount;
use crate::cylinder::Cylinder;
use crate::number::ForceNumber;
use crate::problem::Problem;

/// A pressure cannot fall below that of a vacuum, Pa, counted from the air's: the oil would boil or let its air go.
pub const VACUUM: f64 = -101_325.0;

/// Below this drop of pressure, Pa, a valve's flow goes over from the root of the drop to the drop itself, as it becomes laminar.
const LAMINAR: f64 = 1e4;

/// The oil of the cylinders behind a drive, all together, and their valve.
#[derive(Clone, Debug)]
pub struct Oil<T> {
    /// The drive.
    pub drive: DriveId,
    /// Areas on which it presses, m^2.
    pub area: [T; 2],
    /// Bulk modulus of the oil, Pa.
    pub bulk_modulus: T,
    /// That of the walls around `volume`.
    pub hose_modulus: Option<T>,
    /// That of the cylinders' walls.
    pub wall_modulus: Option<T>,
    /// Volumes that are always full, m^3.
    pub volume: [T; 2],
    /// Length of the drive with the rod in, and how far that comes out, m.
    pub stroke: Option<[T; 2]>,
    /// Openings of the valve; the second is the opposite of the first where it is not given.
    pub valve: (Amount<T>, Option<Amount<T>>),
    /// Flow through the whole opening, m^3/s, ...
    pub flow: T,
    /// ... at this drop of pressure, Pa.
    pub drop: T,
    /// Viscous resistance, N s/m.
    pub damping: T,
    /// Friction of the seals, N.
    pub friction: T,
    /// What leaks past the pistons, m^3/s per Pa.
    pub leakage: T,
    /// Pressure that feeds the valve, Pa.
    pub supply: T,
    /// Pressure into which it drains, Pa.
    pub tank: T,
    /// Pressures at the start, Pa; those that hold the load where they are not given.
    pub start: Option<[T; 2]>,
}

impl<T: ForceNumber> Oil<T> {
    /// Evaluates the oil of a cylinder, if it has any.
    pub(crate) fn new(
        mechanism: &Mechanism,
        cylinder: &HydraulicCylinder,
        machine: &Cylinder<T>,
        parameters: &[T],
        problems: &mut Vec<Problem>,
    ) -> Option<Self> {
        let oil = cylinder.oil.as_ref()?;
        let of = |scalar: &model::Scalar| model::value(scalar, parameters);
        let name = mechanism.model.drives.get(cylinder.drive.index());
        let what = format!("the valve of `{}`", name.map_or("", |d| d.name.as_str()));
        let mut opening = |opening: &model::Amount| {
            Amount::new(
                mechanism,
                opening,
                parameters,
                &cylinder.span,
                &what,
                problems,
            )
        };
        let valve = (opening(&oil.valve.0), oil.valve.1.as_ref().map(opening));
        let Some(supply) = machine.highest else {
            let message = "a cylinder with oil has no supply pressure that feeds its valve";
            problems.push(Problem::new("missing-supply", &cylinder.span, message));
            return None;
        };
        let count = machine.count;
        let it = Self {
            drive: cylinder.drive,
            area: [machine.bore_area * count, machine.ring_area * count],
            bulk_modulus: of(&oil.bulk_modulus),
            hose_modulus: oil.hose_modulus.as_ref().map(of),
            wall_modulus: oil.wall_modulus.as_ref().map(of),
            volume: oil.volume.each_ref().map(|volume| of(volume) * count),
            stroke: oil.stroke.as_ref().map(|stroke| stroke.each_ref().map(of)),
            valve,
            flow: of(&oil.flow),
            drop: of(&oil.drop),
            damping: of(&oil.damping) * count,
            friction: machine.friction * count,
            leakage: of(&oil.leakage) * count,
            supply,
            tank: machine.back,
            start: oil.start.as_ref().map(|start| start.each_ref().map(of)),
        };
        it.check(cylinder, problems);
        Some(it)
    }

    fn check(&self, cylinder: &HydraulicCylinder, problems: &mut Vec<Problem>) {
        let stiff = self.hose_modulus.iter().chain(&self.wall_modulus);
        let positive = (stiff
            .chain(&self.volume)
            .chain(self.stroke.iter().flatten()))
        .chain([&self.bulk_modulus, &self.flow, &self.drop]);
        let mut positive = positive.copied();
        if positive.any(|x| x.any_lane(|x| !(x > 0.0))) {
            let message =
                "bulk moduli, volumes, stroke, flow and drop of a cylinder's oil are above zero";
            problems.push(Problem::new("oil-not-positive", &cylinder.span, message));
        }
        if [self.damping, self.leakage]
            .iter()
            .any(|x| x.any_lane(|x| x < 0.0))
        {
            let message =
                "damping and leakage of a cylinder's oil are never negative: they would add energy";
            problems.push(Problem::new("negative-damping", &cylinder.span, message));
        }
    }

    /// The force with which it pushes the rod out, N, at these pressures, Pa, and this speed of the drive, m/s; the friction of the
    /// seals left out.
    pub fn push(&self, pressures: [T; 2], speed: T) -> T {
        pressures[0] * self.area[0] - pressures[1] * self.area[1] - self.damping * speed
    }

    /// Pressures that push by so much more, N, than those of the tank on both sides: one side stays at that.
    pub fn holding(&self, more: T) -> [T; 2] {
        let (bore, ring) = (more / self.area[0], -more / self.area[1]);
        [
            self.tank + more.choose(bore, T::zero()),
            self.tank + more.choose(T::zero(), ring),
        ]
    }
}

impl Oil<f64> {
    /// Rates of the pressures, Pa/s, at a length and speed of the drive, m and m/s, for openings of the valve. `None` where a side
    /// holds no oil any more.
    pub fn rates(
        &self,
        [length, speed]: [f64; 2],
        pressures: [f64; 2],
        openings: [f64; 2],
    ) -> Option<[f64; 2]> {
        let leaks = self.leakage * (pressures[0] - pressures[1]);
        let mut rates = [0.0; 2];
        for (side, sense) in [(0, -1.0), (1, 1.0)] {
            let volume = self.volume_at(side, length);
            if !(volume > 0.0) {
                return None;
            }
            let enters = self.enters(openings[side], pressures[side]) + sense * leaks;
            rates[side] =
                self.stiffness(side, volume) / volume * (sense * self.area[side] * speed + enters);
        }
        Some(rates)
    }

    /// Oil on a side at a length of the drive, m^3.
    fn volume_at(&self, side: usize, length: f64) -> f64 {
        let free = match self.stroke {
            None => 0.0,
            Some([closed, _]) if side == 0 => length - closed,
            Some([closed, stroke]) => closed + stroke - length,
        };
        self.volume[side] + self.area[side] * free
    }

    /// Bulk modulus of a side with its walls, Pa.
    fn stiffness(&self, side: usize, volume: f64) -> f64 {
        let still = self.volume[side] / volume;
        let yields =
            |part: f64, modulus: Option<f64>| modulus.map_or(0.0, |modulus| part / modulus);
        let all = 1.0 / self.bulk_modulus
            + yields(1.0 - still, self.wall_modulus)
            + yields(still, self.hose_modulus);
        1.0 / all
    }

    /// Flow of the valve into a side, m^3/s, at an opening and a pressure there.
    pub fn enters(&self, opening: f64, pressure: f64) -> f64 {
        let drop = match opening >= 0.0 {
            true => self.supply - pressure,
            false => pressure - self.tank,
        };
        opening * self.flow * root(drop) / self.drop.sqrt()
    }

    /// The largest pressure that its equations are likely to know, Pa: what errors of pressures are measured by.
    pub fn scale(&self) -> f64 {
        let start = self.start.iter().flatten().map(|p| p.abs());
        start.fold(self.supply.abs().max(-VACUUM), f64::max)
    }
}

/// The root of a drop of pressure with its sign; near zero the odd polynomial that joins it with two derivatives.
fn root(drop: f64) -> f64 {
    if drop.abs() >= LAMINAR {
        return drop.abs().sqrt() * drop.signum();
    }
    let u = drop / LAMINAR;
    let square = u * u;
    LAMINAR.sqrt() * u * (45.0 + square * (-18.0 + 5.0 * square)) / 32.0
}

/// A side by its place among two values.
pub fn side(chamber: Chamber) -> usize {
    match chamber {
        Chamber::Bore => 0,
        Chamber::Ring => 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_is_smooth_and_odd() {
        let step = 1e-3 * LAMINAR;
        for at in [0.0, 0.3 * LAMINAR, LAMINAR, -LAMINAR, 2.0 * LAMINAR] {
            let slope = |x: f64| (root(x + step) - root(x - step)) / (2.0 * step);
            let (before, after) = (slope(at - step), slope(at + step));
            assert!(
                (after / before - 1.0).abs() < 0.01,
                "{at}: {before} {after}"
            );
            assert_eq!(root(-at), -root(at));
        }
        assert_eq!(root(4.0 * LAMINAR), 2.0 * root(LAMINAR));
        assert_eq!(root(LAMINAR), LAMINAR.sqrt());
    }
}
