//! Poses with the contacts where the reactions have them.

use kempe_measure::Series;
use kempe_mechanism::Pose;
use kempe_mechanism::evidence::is_finite as is_known;
use kempe_number::Number;

use super::opening::{Opening, contact, size_of};
use super::{CLOSED, Clearances, NO_LOAD, NotSettled, is_finite};
use crate::instant::Rates;

/// A pose stays where nothing moves by more than this, in mechanism sizes and rad.
const SETTLED: f64 = 1e-12;

/// How often the contacts are looked for. Where they are found at all, each look leaves a small part of the last error.
const LOOKS: usize = 60;

/// Steps in which a pose with play is followed from that without, to see that both are of one branch.
const STEPS: usize = 8;

/// Two of these steps that differ by more than this part are no steps along one smooth branch.
const SMOOTH: f64 = 0.5;

impl Clearances {
    /// Goes on from the state without play to the one with the clearances where the reactions have them.
    ///
    /// # Errors
    /// Why there is none.
    pub fn settle(&mut self) -> Result<(), NotSettled> {
        let time = self.state.time;
        let ideal = self.state.poses.clone();
        let mut coordinates = self.state.coordinates.clone();
        let mut change = f64::INFINITY;
        let mut flipping = None;
        for look in 0..LOOKS {
            let last: Vec<Pose<f64>> = self.state.poses.iter().map(Pose::value).collect();
            flipping = self.set_contacts(&mut coordinates, look > 0)?;
            self.find(time, &coordinates);
            if !is_finite(&self.state) {
                return Err(NotSettled::NotClosed);
            }
            let before = std::mem::replace(&mut change, self.moved(&last));
            // Speeds go by how the contacts turn, which goes on settling after the pose has.
            let settled = change < SETTLED && (!self.turning || before < SETTLED);
            if settled {
                if !self.closes() {
                    return Err(NotSettled::NotClosed);
                }
                let places: Vec<f64> = coordinates.iter().map(|q| q.value()).collect();
                return self.on_branch(&ideal, &places);
            }
        }
        Err(flipping.map_or(NotSettled::Moves(change), NotSettled::Flips))
    }

    /// What a joint with play carries along the ways in which it may stand open, N.
    fn load(&self, opening: &Opening) -> Vec<Rates> {
        let drives = opening.along.iter();
        drives
            .map(|d| self.source.forces.drives[d.index()].value)
            .collect()
    }

    /// The size of what a joint with play carries, N.
    pub(super) fn load_size(&self, opening: &Opening) -> f64 {
        size_of(&self.load(opening))
    }

    /// The largest component of a force between links, N.
    pub(super) fn largest_load(&self) -> f64 {
        let sides = self.source.forces.sides.iter().flatten();
        let components = sides.flat_map(|side| side.wrench[..2].iter());
        components.fold(0.0, |largest: f64, f| largest.max(f.value().abs()))
    }

    /// Puts the contacts where the forces of the state want them. Answers which one went to the other side.
    fn set_contacts(
        &self,
        coordinates: &mut [Series<f64>],
        again: bool,
    ) -> Result<Option<usize>, NotSettled> {
        let none = NO_LOAD * self.largest_load();
        let mut flipping = None;
        for (joint, opening) in self.openings.iter().enumerate() {
            if !opening.held {
                continue;
            }
            let force = self.load(opening);
            let size = size_of(&force);
            if opening.undetermined || size.is_nan() {
                return Err(NotSettled::Undetermined(joint));
            }
            if size <= none {
                return Err(NotSettled::NoReaction(joint));
            }
            let there = contact(&force, opening.radial, self.turning);
            let mut along = 0.0;
            for (drive, to) in opening.along.iter().zip(there) {
                let place = &mut coordinates[drive.index()];
                along += place.value() * to.value();
                *place = to;
            }
            if again && along < 0.0 {
                flipping = Some(joint);
            }
        }
        Ok(flipping)
    }

    /// How far the state is from these poses, in mechanism sizes and rad.
    fn moved(&self, from: &[Pose<f64>]) -> f64 {
        let pairs = self.state.poses.iter().zip(from);
        let part = pairs.map(|(now, before)| apart(&now.value(), before, self.motion.size()));
        part.fold(0.0, f64::max)
    }

    /// Whether the poses between the one without play and the state's, the contacts where they are, follow each other evenly:
    /// then both are of one branch.
    fn on_branch(&mut self, ideal: &[Pose<Series<f64>>], places: &[f64]) -> Result<(), NotSettled> {
        let size = self.motion.size();
        let own = self.motion.mechanism().model.drives.len();
        let mut last: Vec<Pose<f64>> = ideal.iter().map(Pose::value).collect();
        let mut branch = self.branch.clone();
        let mut ways: Vec<Vec<f64>> = Vec::new();
        for step in 1..=STEPS {
            let part = step as f64 / STEPS as f64;
            let mut there = places.to_vec();
            there[own..].iter_mut().for_each(|q| *q *= part);
            branch.guess.clone_from(&last);
            self.configuration.set_inputs(&self.plain.mechanism, &there);
            self.plain.solve(&branch, &mut self.configuration);
            if !self.configuration.poses.iter().all(is_known) {
                return Err(NotSettled::OtherBranch);
            }
            let poses = self.configuration.poses.iter();
            let way = poses.clone().zip(&last).flat_map(|(now, before)| {
                let [x, y] = [now.x - before.x, now.y - before.y].map(|d| d / size);
                [x, y, now.c - before.c, now.s - before.s]
            });
            ways.push(way.collect());
            last = poses.copied().collect();
        }
        let norm = |list: &mut dyn Iterator<Item = f64>| list.fold(0.0, |a: f64, b| a.max(b.abs()));
        let longest = ways.iter().map(|way| norm(&mut way.iter().copied()));
        let longest = longest.fold(0.0, f64::max);
        let even = ways.windows(2).all(|pair| {
            let mut differences = pair[0].iter().zip(&pair[1]).map(|(a, b)| a - b);
            let difference = norm(&mut differences);
            difference <= (SMOOTH * longest).max(SETTLED)
        });
        // The last step ends where the contacts settled.
        let end = (last.iter().zip(&self.state.poses))
            .map(|(a, b)| apart(a, &b.value(), size))
            .fold(0.0, f64::max);
        match even && end <= CLOSED {
            true => Ok(()),
            false => Err(NotSettled::OtherBranch),
        }
    }
}

/// How far two poses are apart, in mechanism sizes and rad.
fn apart(a: &Pose<f64>, b: &Pose<f64>, size: f64) -> f64 {
    let lengths = [a.x - b.x, a.y - b.y].map(|d| d.abs() / size);
    let directions = [a.c - b.c, a.s - b.s].map(f64::abs);
    (lengths.into_iter().chain(directions)).fold(0.0, |m, x| if x.is_nan() { x } else { m.max(x) })
}
