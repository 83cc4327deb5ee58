//! Whole turns of links, counted alike in a family of designs.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::Motion;

impl Motion {
    /// The motion with the angles of its links counted by such whole turns that they start nearest to those of another motion of the
    /// same mechanism. By itself each design counts from within half a turn, so that of two that differ by little one may count from
    /// 179.9 degrees and the other from -179.9. As it is where wheels or racks tell whole turns apart, or the drives start elsewhere.
    pub fn counted_as(self: Arc<Self>, other: &Self) -> Arc<Self> {
        let (own, others) = (self.mechanism(), other.mechanism());
        let [names, other_names] = [own, others].map(|it| it.model.links.iter().map(|l| &l.name));
        // A simulation makes each design's mechanism anew.
        let same = Arc::ptr_eq(own, others) || names.eq(other_names);
        if !same || self.mechanism().model.counts_turns() || self.at_start() != other.at_start() {
            return self;
        }
        let turns = |motion: &Self| {
            let mut branch = motion.solver::<f64>().branch;
            motion.branch_at(motion.start, &mut branch);
            let seats = motion.mechanism().seats.iter();
            let angles = seats.zip(&motion.design.geometry.seat_angles);
            let angles = angles.map(|(seat, angle)| branch.near[seat.body.index()] + angle);
            angles.collect::<Vec<f64>>()
        };
        let (own, others) = (turns(&self), turns(other));
        let further = own.iter().zip(&others);
        let further: Vec<f64> = further
            .map(|(a, b)| TAU * ((b - a) / TAU).round())
            .collect();
        if further.iter().all(|turns| *turns == 0.0) {
            return self;
        }
        let mut motion = Arc::unwrap_or_clone(self);
        let counted = motion.design.geometry.turns.iter().zip(&further);
        let counted: Vec<f64> = counted.map(|(turns, more)| turns + more).collect();
        motion.design.count_turns(&counted);
        Arc::new(motion)
    }

    /// Coordinates of the drives at the start.
    fn at_start(&self) -> Vec<f64> {
        let mut coordinates = vec![0.0; self.mechanism().model.drives.len()];
        self.path.coordinates(self.start, &mut coordinates);
        coordinates
    }
}
