//! The equations of a block in isotropic coordinates.

use kempe_homotopy::{Affine, Bilinear, C};
use kempe_mechanism::Mechanism;
use kempe_mechanism::blocks::Unknown;
use kempe_mechanism::constraint::Situation;
use kempe_mechanism::plan::NewtonBlock;
use kempe_mechanism::structure::{BodyId, Constraint, LineRef, Marker};
use kempe_number::Complex;

pub(super) struct Builder<'a> {
    pub(super) block: &'a NewtonBlock,
    pub(super) mechanism: &'a Mechanism,
    pub(super) known: &'a Situation<'a, f64>,
    pub(super) scale: f64,
    pub(super) variables: usize,
}

impl Builder<'_> {
    fn variable(&self, unknown: Unknown) -> Option<usize> {
        self.block.unknowns.iter().position(|u| *u == unknown)
    }

    /// Direction of a body as an affine function.
    fn direction(&self, body: BodyId) -> Affine {
        let pose = &self.known.poses[body.index()];
        match (body != BodyId::GROUND)
            .then(|| self.variable(Unknown::Angle(body)))
            .flatten()
        {
            Some(variable) => {
                let mut f = Affine::constant(self.variables, C::zero());
                f.add(variable, C::one());
                f
            }
            None => Affine::constant(self.variables, Complex::new(pose.c, pose.s)),
        }
    }

    /// A vector of a body.
    fn vector(&self, body: BodyId, local: [f64; 2], unit: f64) -> Affine {
        let local = Complex::new(local[0] / unit, local[1] / unit);
        Affine(
            self.direction(body)
                .0
                .into_iter()
                .map(|c| c * local)
                .collect(),
        )
    }

    /// A point of a body, in units of the scale.
    fn point(&self, body: BodyId, local: [f64; 2]) -> Affine {
        let mut f = self.vector(body, local, self.scale);
        let pose = &self.known.poses[body.index()];
        match (body != BodyId::GROUND)
            .then(|| self.variable(Unknown::Place(body)))
            .flatten()
        {
            Some(variable) => f.add(variable, C::one()),
            None => f.add_constant(Complex::new(pose.x / self.scale, pose.y / self.scale)),
        }
        f
    }

    fn marker(&self, marker: Marker) -> Affine {
        self.point(marker.body, self.known.geometry.marker(marker))
    }

    /// Direction of a line, and the vector from its origin to a point.
    fn along(&self, line: LineRef, point: Marker) -> (Affine, Affine) {
        let local = self.known.geometry.line(line);
        let origin = self.point(line.body, local.origin);
        (
            self.vector(line.body, local.direction, 1.0),
            self.marker(point).minus(&origin),
        )
    }

    fn one(&self) -> Affine {
        Affine::constant(self.variables, C::one())
    }

    fn number(&self, value: f64) -> Affine {
        Affine::constant(self.variables, Complex::new(value, 0.0))
    }
}

/// The block's equations, or `None` when it holds a joint that is not algebraic in these coordinates (gears, racks).
pub(super) fn equations(b: &Builder<'_>) -> Option<(Vec<Affine>, Vec<Bilinear>)> {
    let mut linear = Vec::new();
    let mut bilinear = Vec::new();
    let mut tied: Vec<BodyId> = Vec::new();
    for (place, row) in b.block.rows[..b.block.size].iter().enumerate() {
        let rows = &b.block.rows[..b.block.size];
        let both = rows
            .iter()
            .filter(|r| r.constraint == row.constraint)
            .count()
            == 2;
        if rows[..place].iter().any(|r| r.constraint == row.constraint) {
            continue;
        }
        match b.mechanism.constraints[row.constraint].0 {
            Constraint::Coincide { a, b: c } => {
                let gap = b.marker(c).minus(&b.marker(a));
                if both {
                    linear.push(gap);
                } else {
                    // One row only: real or imaginary part, gap -/+ conjugate gap.
                    let sign = if row.row == 0 { 1.0 } else { -1.0 };
                    let conjugate = gap.conj();
                    bilinear.push(Bilinear(vec![(gap, b.one()), (b.number(sign), conjugate)]));
                }
            }
            Constraint::Direction {
                a,
                b: from,
                offset,
                input,
            } => {
                // u_a = u_b * turn: linear, and it replaces the unit-length equation of one body.
                let mut by = b.known.geometry.angles[offset as usize];
                if let Some(drive) = input {
                    let q = &b.known.inputs[drive.index()];
                    by = [by[0] * q.c - by[1] * q.s, by[1] * q.c + by[0] * q.s];
                }
                linear.push(b.direction(a).minus(&b.vector(from, by, 1.0)));
                let of = [a, from].into_iter().find(|body| {
                    *body != BodyId::GROUND
                        && b.variable(Unknown::Angle(*body)).is_some()
                        && !tied.contains(body)
                })?;
                tied.push(of);
            }
            Constraint::OnLine { point, line } => {
                let (t, w) = b.along(line, point);
                let minus = Affine(t.0.iter().map(|c| -*c).collect());
                bilinear.push(Bilinear(vec![(w.clone(), t.conj()), (minus, w.conj())]));
            }
            Constraint::Travel { point, line, input } => {
                let (t, w) = b.along(line, point);
                let q = b.known.inputs[input.index()].value / b.scale;
                let terms = vec![
                    (w.clone(), t.conj()),
                    (t, w.conj()),
                    (b.number(-2.0 * q), b.one()),
                ];
                bilinear.push(Bilinear(terms));
            }
            Constraint::Distance { a, b: c, input } => {
                let w = b.marker(c).minus(&b.marker(a));
                let q = b.known.inputs[input.index()].value / b.scale;
                bilinear.push(Bilinear(vec![
                    (w.clone(), w.conj()),
                    (b.number(-q * q), b.one()),
                ]));
            }
            Constraint::Gears { .. } | Constraint::Rack { .. } => return None,
        }
    }
    for unknown in &b.block.unknowns {
        if let Unknown::Angle(body) = unknown
            && !tied.contains(body)
        {
            let u = b.direction(*body);
            bilinear.push(Bilinear(vec![
                (u.clone(), u.conj()),
                (b.number(-1.0), b.one()),
            ]));
        }
    }
    Some((linear, bilinear))
}
