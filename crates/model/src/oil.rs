//! The oil in a hydraulic cylinder: what moves a cylinder drive that is let go.

use crate::amount::Amount;
use crate::ids::Scalar;

/// The oil of a cylinder and the valve that feeds it. Of two values the first is that of the bore's side, the second that of the
/// ring round the rod.
#[derive(Clone, Debug, PartialEq)]
pub struct Oil {
    /// Bulk modulus of the oil, Pa.
    pub bulk_modulus: Scalar,
    /// That of the hoses' walls; stiff where it is not given.
    pub hose_modulus: Option<Scalar>,
    /// That of the cylinder's walls; stiff where it is not given.
    pub wall_modulus: Option<Scalar>,
    /// Volumes that are always full, in hoses and at the ends of the stroke, of one cylinder, m^3.
    pub volume: [Scalar; 2],
    /// Length of the drive with the rod in, and how far that comes out, m; without them the volumes do not depend on the stroke.
    pub stroke: Option<[Scalar; 2]>,
    /// How far the valve is open to both sides, as parts of the whole: from the supply where positive, to the tank where
    /// negative. Where the second is not given it is the opposite of the first.
    pub valve: (Amount, Option<Amount>),
    /// Flow through the whole opening, m^3/s, ...
    pub flow: Scalar,
    /// ... at this drop of pressure, Pa.
    pub drop: Scalar,
    /// Viscous resistance of one cylinder, N s/m.
    pub damping: Scalar,
    /// What leaks past the piston of one cylinder, m^3/s per Pa.
    pub leakage: Scalar,
    /// Pressures at the start, Pa; those that hold the load where they are not given.
    pub start: Option<[Scalar; 2]>,
}

impl Oil {
    /// All values that the reader gave.
    pub(crate) fn scalars_mut(&mut self) -> impl Iterator<Item = &mut Scalar> {
        let single = [
            &mut self.bulk_modulus,
            &mut self.flow,
            &mut self.drop,
            &mut self.damping,
            &mut self.leakage,
        ];
        (single.into_iter())
            .chain(&mut self.hose_modulus)
            .chain(&mut self.wall_modulus)
            .chain(&mut self.volume)
            .chain(self.stroke.iter_mut().flatten())
            .chain(self.start.iter_mut().flatten())
    }

    /// The openings of the valve.
    pub(crate) fn openings_mut(&mut self) -> impl Iterator<Item = &mut Amount> {
        std::iter::once(&mut self.valve.0).chain(&mut self.valve.1)
    }
}
