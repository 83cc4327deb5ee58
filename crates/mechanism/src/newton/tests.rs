//! The equations of spanning trees are held to the joints' own definition.
#![allow(clippy::unwrap_used, reason = "a failure is the test's failure")]

use std::path::Path;
use std::sync::Arc;

use kempe_linear::{Elimination, Matrix, Qr};
use kempe_model::Model;
use kempe_number::{Dual, Number};

use super::rows::factor_block;
use crate::Mechanism;
use crate::constraint::{Coincide, Constraint, Input, Situation};
use crate::geometry::Geometry;
use crate::pose::Pose;
use crate::spanning_tree::SpanningTree;

/// Files with Newton groups: of pins alone, with sliders, gears, racks and bodies that no pin holds.
const FILES: [&str; 9] = [
    "../../examples/seeds/door-lock",
    "../../examples/gallery/chebyshev",
    "../../examples/gallery/class-iii",
    "../../examples/gallery/scissor-lift",
    "../../examples/gallery/stephenson-ii",
    "../../examples/gallery/groove-cam",
    "../motion/tests/models/two-triads-floating",
    "../motion/tests/models/gear-in-loop",
    "../motion/tests/models/rack-after-loop",
];
/// A plate that slides on two lines, no pin holding it, and a bar pinned to it.
const FLOATING: &str = r#"
units = { length = "mm", angle = "deg" }
[links]
frame = { A = [0, 0], B = [100, 0], C = [10, 100], D = [0, -40], E = [100, -50] }
plate = { U = [5, 0], V = [60, 10], P = [40, 50] }
bar = { P-Q = 90 }
[joints]
u = { pin = "U", on = "A -> B" }
v = { pin = "V", on = "A -> C" }
q = { pin = "Q", on = "D -> E" }
[drives]
fold = { turns = "bar", relative_to = "plate", from = 10, to = 20, speed = "1 rad/s" }
"#;
/// More coordinates than any of their trees has.
const K: usize = 24;

type Rich = Dual<f64, K>;

struct Case {
    mechanism: Arc<Mechanism>,
    geometry: Geometry<f64>,
    near: Vec<f64>,
    poses: Vec<Pose<f64>>,
    inputs: Vec<Input<f64>>,
}

impl Case {
    fn read(file: &str) -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("{file}.toml"));
        Self::of(&std::fs::read_to_string(path).unwrap())
    }

    /// A file's dimensions at a pose that closes nothing.
    fn of(text: &str) -> Self {
        let checked = Model::from_toml(text, "test", &mut |_| Err("no tables".into())).unwrap();
        let mechanism = Mechanism::new(&checked.model);
        let values: Vec<f64> = checked.model.parameter_values();
        let geometry = Geometry::new(&mechanism, &values);
        let size = geometry.size(&mechanism);
        let near: Vec<f64> = (0..mechanism.bodies).map(|b| 0.7 * b as f64).collect();
        let place = |b: usize, k: usize| size * (((3 * b + k) * 7 % 11) as f64 / 11.0 - 0.5);
        let poses = (near.iter().enumerate())
            .map(|(b, angle)| match b {
                0 => Pose::identity(),
                _ => Pose::from_angle(place(b, 0), place(b, 1), *angle),
            })
            .collect();
        let inputs = (checked.model.drives.iter())
            .map(|drive| crate::configuration::input_of(drive, 0.6 * size))
            .collect();
        Self {
            mechanism,
            geometry,
            near,
            poses,
            inputs,
        }
    }

    fn situation<'a>(&'a self, poses: &'a [Pose<f64>]) -> Situation<'a, f64> {
        Situation {
            geometry: &self.geometry,
            inputs: &self.inputs,
            poses,
            near: &self.near,
        }
    }

    /// The poses with the bodies of a tree hanging, and the tree's points.
    fn hung(&self, tree: &SpanningTree) -> (Vec<Pose<f64>>, Vec<[f64; 2]>) {
        let (mut poses, mut points) = (self.poses.clone(), vec![[0.0; 2]; tree.points()]);
        tree.hang(&self.geometry, &mut poses, &mut points);
        (poses, points)
    }

    /// Residuals and Jacobian to the coordinates of a tree, by rows.
    fn linearised(&self, tree: &SpanningTree) -> (Vec<f64>, Vec<Vec<f64>>) {
        let (poses, points) = self.hung(tree);
        let mut rhs = vec![0.0; tree.size];
        let situation = self.situation(&poses);
        tree.residuals(&self.mechanism, &situation, &points, &mut rhs);
        let mut entries = Entries(vec![vec![0.0; tree.size]; tree.size]);
        tree.linearise(&self.mechanism, &situation, &points, &mut entries);
        (rhs, entries.0)
    }
}

/// A matrix that is only filled.
struct Entries(Vec<Vec<f64>>);

impl Matrix<f64> for Entries {
    fn add(&mut self, row: usize, column: usize, value: f64) {
        self.0[row][column] += value;
    }

    fn clear(&mut self, _: usize) {
        unreachable!()
    }

    fn factor(&mut self) {
        unreachable!()
    }

    fn solve(&self, _: &mut [f64]) {
        unreachable!()
    }

    fn determinant(&self) -> f64 {
        unreachable!()
    }
}

/// Every tree of the files.
fn each_tree(mut check: impl FnMut(&str, &Case, usize, &SpanningTree)) {
    let mut others = Vec::new();
    let (mut free, mut many) = (0, 0);
    let cases = FILES.map(|file| (file, Case::read(file)));
    for (file, case) in cases.into_iter().chain([("floating", Case::of(FLOATING))]) {
        for (index, block) in case.mechanism.plan.newton_blocks.iter().enumerate() {
            let Some(tree) = &block.tree else { continue };
            assert!(tree.size <= K, "{file}");
            check(file, &case, index, tree);
            free += tree.places.len();
            many += usize::from(tree.size > 4);
            others.extend(
                (tree.others.iter()).map(|row| case.mechanism.constraints[row.constraint].0),
            );
        }
    }
    assert!(free > 0 && many > 0);
    assert!((others.iter()).any(|c| matches!(c, Constraint::OnLine { .. })));
    assert!((others.iter()).any(|c| matches!(c, Constraint::Direction { .. })));
    assert!((others.iter()).any(|c| matches!(c, Constraint::Gears { .. })));
}

#[test]
fn jacobians_are_the_derivatives_of_the_joints_own_rows() {
    each_tree(|file, case, _, tree| {
        let geometry = case.geometry.map(Rich::from_f64);
        let lift = |p: &Pose<f64>| Pose {
            x: Rich::from_f64(p.x),
            y: Rich::from_f64(p.y),
            c: Rich::from_f64(p.c),
            s: Rich::from_f64(p.s),
        };
        let mut poses: Vec<Pose<Rich>> = case.poses.iter().map(lift).collect();
        for (column, body) in tree.angles.iter().enumerate() {
            let pose = &mut poses[body.index()];
            *pose = pose.moved(Rich::zero(), Rich::zero(), Rich::variable(0.0, column));
        }
        for (k, body) in tree.places.iter().enumerate() {
            let (pose, column) = (&mut poses[body.index()], tree.angles.len() + 2 * k);
            pose.x = Rich::variable(pose.x.value(), column);
            pose.y = Rich::variable(pose.y.value(), column + 1);
        }
        let mut points = vec![[Rich::zero(); 2]; tree.points()];
        tree.hang(&geometry, &mut poses, &mut points);
        let inputs: Vec<Input<Rich>> = (case.inputs.iter())
            .map(|i| Input {
                c: Rich::from_f64(i.c),
                s: Rich::from_f64(i.s),
                value: Rich::from_f64(i.value),
            })
            .collect();
        let situation = Situation {
            geometry: &geometry,
            inputs: &inputs,
            poses: &poses,
            near: &case.near,
        };
        let (rhs, matrix) = case.linearised(tree);
        let mut rich = vec![Rich::zero(); tree.size];
        tree.residuals(&case.mechanism, &situation, &points, &mut rich);
        for row in 0..tree.size {
            assert!((rhs[row] - rich[row].value()).abs() < 1e-14, "{file}");
            for column in 0..tree.size {
                let (own, dual) = (matrix[row][column], rich[row].eps[column]);
                assert!(
                    (own - dual).abs() < 1e-12 * (1.0 + dual.abs()),
                    "{file}, {row}, {column}: {own} {dual}"
                );
            }
        }
        // The pins of the tree are met, and those that close loops are the joint's own difference.
        let (hung, _) = case.hung(tree);
        let situation = case.situation(&hung);
        for pin in &tree.hung {
            let gap = situation.residual(&Constraint::Coincide(Coincide {
                a: pin.own,
                b: pin.at,
            }));
            assert!(gap[0].abs().max(gap[1].abs()) < 1e-14, "{file}");
        }
        for (closure, ends) in tree.closures.iter().zip(tree.tips.as_chunks().0) {
            let &[a, b] = ends;
            let gap = situation.residual(&Constraint::Coincide(Coincide { a, b }));
            assert_eq!(gap, [rhs[closure.row], rhs[closure.row + 1]], "{file}");
        }
    });
}

#[test]
fn the_determinant_of_a_tree_is_that_of_its_block() {
    each_tree(|file, case, index, tree| {
        let block = &case.mechanism.plan.newton_blocks[index];
        let (poses, _) = case.hung(tree);
        let mut qr = Qr::default();
        factor_block(block, &case.mechanism, &case.situation(&poses), &mut qr);
        let whole = qr.determinant();
        let (_, matrix) = case.linearised(tree);
        qr.reset(tree.size, tree.size);
        for (row, entries) in matrix.iter().enumerate() {
            for (column, x) in entries.iter().enumerate() {
                qr.add(row, column, *x);
            }
        }
        let norm = qr.norm();
        qr.factor();
        let own = tree.sign * qr.determinant();
        assert!(
            (own - whole).abs() <= 1e-9 * whole.abs() || norm == 0.0,
            "{file}: {own} {whole}"
        );
    });
}

#[test]
fn elimination_solves_what_needs_rows_swapped() {
    fn check<const N: usize>(size: usize) {
        let mut matrix = Elimination::<f64, N>::storage();
        let entry = |r: usize, c: usize| {
            ((31 * r + 17 * c + 7) * 2_654_435_761 % 1009) as f64 / 500.0 - 1.0
        };
        let mut qr = Qr::default();
        qr.reset(size, size);
        matrix.clear(size);
        for r in 0..size {
            for c in 0..size {
                // Nothing on the diagonal of the first rows.
                let x = if r == c && r < 2 { 0.0 } else { entry(r, c) };
                matrix.add(r, c, x);
                qr.add(r, c, x);
            }
        }
        matrix.factor();
        qr.factor();
        let ratio = matrix.determinant() / qr.determinant();
        assert!((ratio - 1.0).abs() < 1e-12, "{size}: {ratio}");
        let mut rhs: Vec<f64> = (0..N)
            .map(|r| if r < size { r as f64 - 0.5 } else { 0.0 })
            .collect();
        let mut expected = rhs[..size].to_vec();
        matrix.solve(&mut rhs);
        qr.solve(&mut expected);
        for (x, y) in rhs.iter().zip(&expected) {
            assert!((x - y).abs() < 1e-11 * (1.0 + y.abs()), "{size}: {x} {y}");
        }
    }
    check::<2>(2);
    check::<4>(3);
    check::<4>(4);
    check::<6>(5);
    check::<8>(7);
    check::<8>(8);
}
