//! The equations of a block in isotropic coordinates.

use kempe_homotopy::{Affine, Bilinear, C};
use kempe_mechanism::Mechanism;
use kempe_mechanism::blocks::Unknown;
use kempe_mechanism::constraint::{Isotropic, Joint, Situation, Vector};
use kempe_mechanism::plan::NewtonBlock;
use kempe_mechanism::structure::BodyId;
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

    /// What a constraint's vector is.
    fn affine(&self, vector: Vector) -> Affine {
        match vector {
            Vector::Between([(from, a), (to, b)]) => self.point(to, b).minus(&self.point(from, a)),
            Vector::Fixed(body, local) => self.vector(body, local, 1.0),
        }
    }

    fn one(&self) -> Affine {
        Affine::constant(self.variables, C::one())
    }

    fn number(&self, value: f64) -> Affine {
        Affine::constant(self.variables, Complex::new(value, 0.0))
    }
}

/// The block's equations, or `None` when it holds a joint that is not algebraic in these coordinates.
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
        let constraint = &b.mechanism.constraints[row.constraint].0;
        match constraint.isotropic(b.known, b.scale)? {
            Isotropic::Vanishes(vector) if both => linear.push(b.affine(vector)),
            Isotropic::Vanishes(vector) => {
                // One row only: real or imaginary part, gap -/+ conjugate gap.
                let gap = b.affine(vector);
                let sign = if row.row == 0 { 1.0 } else { -1.0 };
                let conjugate = gap.conj();
                bilinear.push(Bilinear(vec![(gap, b.one()), (b.number(sign), conjugate)]));
            }
            Isotropic::Same { directions, bodies } => {
                // Linear, and it replaces the unit-length equation of one body.
                let [u, v] = directions.map(|d| b.affine(d));
                linear.push(u.minus(&v));
                let of = bodies.into_iter().find(|body| {
                    *body != BodyId::GROUND
                        && b.variable(Unknown::Angle(*body)).is_some()
                        && !tied.contains(body)
                })?;
                tied.push(of);
            }
            Isotropic::Bilinear { products, constant } => {
                let product = |(sign, v, w): (f64, Vector, Vector)| {
                    let mut v = b.affine(v);
                    if sign < 0.0 {
                        v = Affine(v.0.iter().map(|c| -*c).collect());
                    }
                    (v, b.affine(w).conj())
                };
                let mut terms: Vec<_> = products.into_iter().map(product).collect();
                if constant != 0.0 {
                    terms.push((b.number(constant), b.one()));
                }
                bilinear.push(Bilinear(terms));
            }
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
