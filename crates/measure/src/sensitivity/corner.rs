//! Corners of measures: where the size of what passes zero turns back, or the smaller of two gives way to the other, nothing is differentiable.
//!
//! In numbers a corner is met but for rounding: what passes zero is nothing against the size of what it is made of, and on dual numbers one side would
//! answer as if there were no other. Numbers over a motion close in on corners by themselves; these are looked for where a place is given.

use kempe_model::{Leaf, Measure, Model, PointId, PoseMeasure};
use kempe_units::{Builtin, Expr};

use crate::base::{CHUNK, Varying};
use crate::measure::{Along, Moment};

/// Less than this part of the size of what it is made of is rounding.
const NOTHING: f64 = 1e-12;

/// A measure's values at a place, and the sizes of what they are made of.
pub(super) struct Corners<'a, 'm> {
    pub model: &'a Model,
    pub moment: &'a Moment<'m, Varying>,
    /// Size of the mechanism, m.
    pub size: f64,
    /// Time in which the motion covers a mechanism size, or a radian, s.
    pub time: f64,
    /// What the lanes' parameters change by where they change by what they are.
    pub changes: [f64; CHUNK],
    /// Measures with a name that were looked at, and the sizes of those that are known: they may name each other many times over.
    pub looked: Vec<(usize, Along)>,
    pub sizes: Vec<((usize, Along), f64)>,
}

impl Corners<'_, '_> {
    /// A measure's value with derivatives as if there were one side alone, and which of them move it away from a corner.
    pub fn value(&mut self, measure: &Measure) -> (Varying, [bool; CHUNK]) {
        let value = self.moment.series(measure, Along::Time).coefficient(0);
        let mut at = [false; CHUNK];
        self.look(measure, Along::Time, &mut at);
        (value, at)
    }

    /// The size of what a measure is made of.
    pub fn size(&mut self, measure: &Measure) -> f64 {
        self.size_of(measure, Along::Time)
    }

    /// Looks for corners in all that a measure is made of here: numbers over the motion have their own.
    fn look(&mut self, measure: &Measure, along: Along, at: &mut [bool; CHUNK]) {
        match measure {
            Expr::Leaf(leaf) => self.look_at_leaf(leaf, along, at),
            Expr::Call(Builtin::Abs | Builtin::Sqrt | Builtin::Hypot, arguments) => {
                self.meet(arguments, along, at);
            }
            Expr::Call(which @ (Builtin::Min | Builtin::Max), arguments) => {
                let sign = if *which == Builtin::Min { 1.0 } else { -1.0 };
                let rank = |it: &&Measure| sign * self.of(it, along).re;
                let mut order: Vec<&Measure> = arguments.iter().collect();
                order.sort_by(|a, b| rank(a).total_cmp(&rank(b)));
                if let [first, second, ..] = order.as_slice() {
                    let [a, b] = [first, second].map(|it| Box::new((**it).clone()));
                    self.meet(&[Expr::Sub(a, b)], along, at);
                }
            }
            _ => {}
        }
        if !matches!(measure, Expr::Leaf(_)) {
            let parts = measure.children().into_iter();
            parts.for_each(|part| self.look(part, along, at));
        }
    }

    fn look_at_leaf(&mut self, leaf: &Leaf, along: Along, at: &mut [bool; CHUNK]) {
        let pose = |measure| Box::new(Expr::Leaf(Leaf::Pose(measure)));
        let place = |p: PointId| [pose(PoseMeasure::X(p)), pose(PoseMeasure::Y(p))];
        match leaf {
            Leaf::Named(index) => {
                let known = (*index, along);
                if let (false, Some(named)) = (
                    self.looked.contains(&known),
                    self.model.measures.get(*index),
                ) {
                    self.looked.push(known);
                    self.look(&named.measure, along, at);
                }
            }
            Leaf::Rate(inner, _) => self.look(inner, Along::Time, at),
            Leaf::Coefficient(inner, drive, _) => self.look(inner, Along::Drive(*drive), at),
            Leaf::Pose(PoseMeasure::Speed(p)) => {
                self.meet(&place(*p).map(|x| Expr::Leaf(Leaf::Rate(x, 1))), along, at);
            }
            Leaf::Pose(PoseMeasure::Acceleration(p)) => {
                self.meet(&place(*p).map(|x| Expr::Leaf(Leaf::Rate(x, 2))), along, at);
            }
            Leaf::Pose(PoseMeasure::Distance(a, b)) => {
                let [[ax, ay], [bx, by]] = [a, b].map(|p| place(*p));
                self.meet(&[Expr::Sub(bx, ax), Expr::Sub(by, ay)], along, at);
            }
            _ => {}
        }
    }

    /// Marks what moves these, where all of them are nothing.
    fn meet(&mut self, arguments: &[Measure], along: Along, at: &mut [bool; CHUNK]) {
        let mut moved = [false; CHUNK];
        for argument in arguments {
            let (value, size) = (self.of(argument, along), self.size_of(argument, along));
            if !(value.re.abs() <= NOTHING * size) {
                return;
            }
            let changes = value.eps.iter().zip(&self.changes);
            let changes = changes.map(|(slope, change)| (slope * change).abs());
            (moved.iter_mut().zip(changes)).for_each(|(it, change)| *it |= change > NOTHING * size);
        }
        at.iter_mut()
            .zip(moved)
            .for_each(|(it, moved)| *it |= moved);
    }

    fn of(&self, measure: &Measure, along: Along) -> Varying {
        self.moment.series(measure, along).coefficient(0)
    }

    /// The size of what a measure is made of.
    fn size_of(&mut self, measure: &Measure, along: Along) -> f64 {
        let mut size = |it: &Measure| self.size_of(it, along);
        match measure {
            Expr::Const(x) => x.abs(),
            Expr::Leaf(leaf) => self.size_of_leaf(leaf, along),
            Expr::Neg(a) => size(a),
            Expr::Add(a, b) | Expr::Sub(a, b) => size(a).max(size(b)),
            Expr::Mul(a, b) => size(a) * size(b),
            Expr::Div(a, b) => size(a) / self.of(b, along).re.abs(),
            Expr::Call(Builtin::Abs | Builtin::Min | Builtin::Max | Builtin::Hypot, arguments) => {
                arguments.iter().map(size).fold(0.0, f64::max)
            }
            Expr::Powi(..) | Expr::Powf(..) | Expr::Call(..) => self.moved(self.of(measure, along)),
        }
    }

    /// A value, or the most that the parameters change of it.
    fn moved(&self, value: Varying) -> f64 {
        let changes = value.eps.iter().zip(&self.changes);
        changes.fold(value.re.abs(), |all, (slope, change)| {
            all.max((slope * change).abs())
        })
    }

    fn size_of_leaf(&mut self, leaf: &Leaf, along: Along) -> f64 {
        if let Leaf::Named(index) = leaf {
            let of = (*index, along);
            if let Some((_, known)) = self.sizes.iter().find(|(it, _)| *it == of) {
                return *known;
            }
            let named = self.model.measures.get(*index);
            let size = named.map_or(0.0, |named| self.size_of(&named.measure, along));
            self.sizes.push((of, size));
            return size;
        }
        let (size, time) = (self.size, self.time);
        let usual = match leaf {
            Leaf::Rate(inner, order) => {
                let all = self.size_of(inner, Along::Time);
                (0..*order).fold(all, |all, _| all / time)
            }
            Leaf::Pose(measure) => match measure {
                PoseMeasure::Speed(_) => size / time,
                PoseMeasure::Acceleration(_) => size / (time * time),
                PoseMeasure::AngularSpeed(_) => 1.0 / time,
                PoseMeasure::AngularAcceleration(_) => 1.0 / (time * time),
                PoseMeasure::Angle(_)
                | PoseMeasure::AngleBetween(..)
                | PoseMeasure::Direction(..)
                | PoseMeasure::TransmissionAngle { .. } => 1.0,
                PoseMeasure::Curvature(_) => 1.0 / size,
                PoseMeasure::MechanicalAdvantage(..) => 0.0,
                _ => size,
            },
            _ => 0.0,
        };
        let value = self.of(&Expr::Leaf(leaf.clone()), along);
        usual.max(self.moved(value))
    }
}
