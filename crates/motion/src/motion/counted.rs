//! Whole turns of links and directions, counted alike in a family of designs.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

use kempe_mechanism::Branch;
use kempe_mechanism::constraint::Joint;
use kempe_model::LinkId;
use kempe_units::Dimension;

use super::Motion;
use crate::assemble::all_assemblies;

impl Motion {
    /// The motion with the angles of its links, and directions from point to point, counted by such whole turns that they start nearest
    /// to those of another motion of the same mechanism. By itself each design counts from within half a turn, so that of two that differ
    /// by little one may count from 179.9 degrees and the other from -179.9. As it is where the drives start in another quarter.
    pub fn counted_as(self: Arc<Self>, other: &Arc<Self>) -> Arc<Self> {
        let (own, others) = (self.mechanism(), other.mechanism());
        let [names, other_names] = [own, others].map(|it| it.model.links.iter().map(|l| &l.name));
        // A simulation makes each design's mechanism anew.
        let same = Arc::ptr_eq(own, others) || names.eq(other_names);
        if !same || !self.starts_beside(other) {
            return self;
        }
        let further = self.turns_to(other);
        let mut motion = Arc::unwrap_or_clone(self);
        if further.iter().any(|turns| *turns != 0.0) {
            let counted = motion.design.geometry.turns.iter().zip(&further);
            let counted: Vec<f64> = counted.map(|(turns, more)| turns + more).collect();
            motion.design.count_turns(&counted);
        }
        motion.counts_as = Some(other.clone());
        Arc::new(motion)
    }

    /// Whole turns, rad, by which every link's angle is counted further where the motion starts as another one does: none where wheels or
    /// racks tell them apart.
    fn turns_to(&self, other: &Self) -> Vec<f64> {
        if self.mechanism().model.counts_turns() {
            return vec![0.0; self.mechanism().seats.len()];
        }
        let angles = |motion: &Self| -> Vec<f64> {
            let near = motion.branch_at_start().near;
            let seats = motion.mechanism().seats.iter();
            let angles = seats.zip(&motion.design.geometry.seat_angles);
            let angles = angles.map(|(seat, angle)| near[seat.body.index()] + angle);
            angles.collect()
        };
        let (own, others) = (angles(self), angles(other));
        let further = own.iter().zip(&others);
        further
            .map(|(a, b)| TAU * ((b - a) / TAU).round())
            .collect()
    }

    /// Whether it starts in the assembly modes of another motion of the same mechanism.
    pub fn starts_in_modes_of(&self, other: &Self) -> bool {
        self.branch_at_start().signs == other.branch_at_start().signs
    }

    fn branch_at_start(&self) -> Branch {
        let mut branch = self.solver::<f64>().branch;
        self.branch_at(self.start, &mut branch);
        branch
    }

    /// The first link of a wheel or rack, which tell turns apart, that the file's hints alone would count from another turn at the start.
    pub fn counted_otherwise(&self) -> Option<LinkId> {
        let mechanism = self.mechanism();
        let wheels = mechanism.constraints.iter().map(|it| &it.0);
        let wheels = wheels.filter(|it| it.counts_turns());
        let mut wheeled = wheels.flat_map(|it| it.bodies()).peekable();
        wheeled.peek()?;
        let alone = all_assemblies(&self.design, &self.at_start());
        let alone = &alone.list.first()?.branch.near;
        let own = self.branch_at_start().near;
        let body = wheeled.find(|body| (own[body.index()] - alone[body.index()]).abs() > PI)?;
        let link = (mechanism.seats.iter()).position(|seat| seat.body == body)?;
        Some(LinkId(link as u32))
    }

    /// Whether the drives start within a quarter of a turn of where they do in another motion: an angle that is driven is what its drive
    /// says.
    fn starts_beside(&self, other: &Self) -> bool {
        let drives = self.mechanism().model.drives.iter();
        let starts = drives.zip(self.at_start().into_iter().zip(other.at_start()));
        let mut turning = starts.filter(|(drive, _)| drive.dimension == Dimension::ANGLE);
        turning.all(|(_, (own, other))| (own - other).abs() < FRAC_PI_2)
    }

    /// Coordinates of the drives at the start.
    fn at_start(&self) -> Vec<f64> {
        let mut coordinates = vec![0.0; self.mechanism().model.drives.len()];
        self.path.coordinates(self.start, &mut coordinates);
        coordinates
    }
}
