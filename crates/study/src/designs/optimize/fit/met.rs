//! Where along a way given places are met, and by how much they are missed.

/// The given places, in lengths: x, y and the arc of an angle.
pub(in super::super) struct Given {
    pub places: Vec<[f64; 3]>,
    /// The arc of a whole turn; 0 of a point.
    pub turn: f64,
}

impl Given {
    /// An arc without whole turns, between minus and plus half of one.
    pub fn turned(&self, arc: f64) -> f64 {
        match self.turn > 0.0 {
            true => arc - self.turn * (arc / self.turn).round(),
            false => arc,
        }
    }
}

/// What is passed less a given place.
pub(super) fn miss(at: &[f64; 3], given: &Given, place: usize) -> [f64; 3] {
    let to = &given.places[place];
    [at[0] - to[0], at[1] - to[1], given.turned(at[2] - to[2])]
}

pub(super) fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn square(miss: &[f64; 3]) -> f64 {
    dot(miss, miss)
}

/// How the place where something is met moves with the design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in super::super) enum Moving {
    /// Its time stays, but for what is free.
    Held,
    /// It is an end of the motion, and goes with it.
    End,
    /// Where the given drive has its value; by place.
    Timed(usize),
    /// Where the way is passed to this part of the whole.
    Paced(f64),
}

/// Where given places are met, and by how much they are missed.
pub(in super::super) struct Met {
    /// Where along the way.
    pub at: Vec<f64>,
    pub misses: Vec<[f64; 3]>,
    pub moving: Vec<Moving>,
    /// What may move along the way by itself: directions of length one, each of some places alone.
    pub free: Vec<Vec<(usize, [f64; 3])>>,
}

impl Met {
    pub fn new(places: usize) -> Self {
        Self {
            at: vec![f64::NAN; places],
            misses: vec![[f64::NAN; 3]; places],
            moving: vec![Moving::Held; places],
            free: Vec::new(),
        }
    }

    /// The sum of the squares.
    pub fn square(&self) -> f64 {
        self.misses.iter().map(square).sum()
    }
}
