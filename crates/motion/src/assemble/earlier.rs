//! What is known of a design that is much like the one to assemble.

use kempe_homotopy::PathReport;
use kempe_mechanism::Design;

use super::assemblies::Assembly;

/// What is known of a design that is much like the one to assemble.
#[derive(Clone, Copy, Default)]
pub(crate) struct Earlier<'a> {
    /// What the homotopies did for it: assemblies are found the sooner.
    pub paths: &'a [PathReport],
    /// How it stands itself: what its assembly has to say of which one is meant.
    pub like: Option<Like<'a>>,
}

/// The assembly of a design like which another is put together.
#[derive(Clone, Copy)]
pub(crate) struct Like<'a> {
    pub design: &'a Design<f64>,
    pub assembly: &'a Assembly,
    /// Whether the assembly nearest to it is meant, whatever `near` hints say; else it tells whole turns alone.
    pub nearest: bool,
}

impl Like<'_> {
    /// Angle of a link, rad.
    pub(super) fn angle(&self, link: usize) -> f64 {
        let body = self.design.mechanism.seats[link].body.index();
        self.body_angle(body) + self.design.geometry.seat_angles[link]
    }

    /// Angle of a body, rad.
    pub(super) fn body_angle(&self, body: usize) -> f64 {
        let Assembly { poses, branch, .. } = self.assembly;
        poses[body].angle_near(branch.near[body])
    }
}
