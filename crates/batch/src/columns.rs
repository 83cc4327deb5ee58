//! From solved states to columns of numbers.

use kempe_mechanism::structure::{Marker, Spot};
use kempe_mechanism::{Branch, Configuration, Design, PlanNumber, PointRoom, Pose};
use kempe_number::{Lanes, Number};

use crate::batch::{Batch, PARTS};
use crate::error::BatchError;
use crate::mask::{all_lanes, lanes_where};
use crate::order::PointStep;
use crate::wide::Wide;

/// The columns of a body's pose, in order.
#[inline(always)]
pub(super) fn parts<T: Copy>(pose: &Pose<T>) -> [T; PARTS] {
    [pose.x, pose.y, pose.c, pose.s]
}

/// Where the results of one state go.
#[derive(Clone, Copy, Default)]
pub(super) struct Target {
    /// Its first column.
    pub column: usize,
    /// Row of its first lane.
    pub row: usize,
    /// The lanes that are wanted, one bit for each.
    pub wanted: u32,
}

/// Where one of the points goes.
struct PointColumns<'t, 'o, 'c> {
    /// Its first column among those of a target.
    column: usize,
    targets: &'t [Target],
    columns: &'o mut [&'c mut [f64]],
}

impl<const W: usize> PointRoom<W> for PointColumns<'_, '_, '_> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn room(&mut self, state: usize) -> Option<[&mut [f64; W]; 2]> {
        let target = &self.targets[state];
        let columns = self.columns[target.column + self.column..].first_chunk_mut::<2>()?;
        let [x, y] = columns;
        let row = target.row / W;
        Some([
            x.as_chunks_mut().0.get_mut(row)?,
            y.as_chunks_mut().0.get_mut(row)?,
        ])
    }
}

/// Writes the places of the batch's points in every state, and runs the [`PointStep`]s, which have not been run;
/// returns how many lanes close.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn write_places<T: Wide<W>, const W: usize>(
    batch: &Batch,
    design: &Design<T>,
    branch: &Branch,
    point_steps: &[PointStep],
    states: &mut [Configuration<T>],
    targets: &[Target],
    columns: &mut [&mut [f64]],
) -> usize {
    let order = &batch.order;
    let mut together = closing_spares(batch, design);
    if !order.watched.is_empty() {
        for state in &*states {
            together += closing(state, &order.watched);
        }
    }
    let mut wanted = all_lanes(W);
    for (_, target) in states.iter().zip(targets) {
        wanted &= target.wanted;
    }
    if wanted != all_lanes(W) {
        solve_point_steps(batch, point_steps, design, branch, states);
        return write_wanted(batch, design, states, targets, columns);
    }
    let mut sum_of_placed = 0.0;
    for it in point_steps {
        let rooms = &mut PointColumns {
            column: 2 * it.point,
            targets,
            columns: &mut *columns,
        };
        let point = batch.markers[it.point];
        let sum = T::place_point(&order.plan, it.step, point, design, branch, states, rooms);
        sum_of_placed += sum.unwrap_or(f64::NAN);
    }
    for (j, marker) in batch.markers.iter().enumerate() {
        if point_steps.iter().any(|it| it.point == j) {
            continue;
        }
        // What is known of the marker is asked once for all states, and known to the compiler from there on.
        macro_rules! write_each {
            ($spot:expr) => {{
                let marker = Marker {
                    spot: $spot,
                    ..*marker
                };
                for (state, target) in states.iter().zip(targets) {
                    let [x, y] = state.place(design, marker);
                    together += x.order(0);
                    for order in 0..T::ORDERS {
                        let column = target.column + order * batch.columns() + 2 * j;
                        let place = [x.order(order), y.order(order)];
                        write(columns, column, target.row, place);
                    }
                }
            }};
        }
        match marker.spot {
            Spot::Frame => write_each!(Spot::Frame),
            Spot::Origin => write_each!(Spot::Origin),
            Spot::Axis => write_each!(Spot::Axis),
            Spot::Anywhere => write_each!(Spot::Anywhere),
        }
    }
    for (j, body) in batch.bodies.iter().enumerate() {
        for (state, target) in states.iter().zip(targets) {
            let [x, y, c, s] = parts(&state.poses[*body]);
            for order in 0..T::ORDERS {
                let column = target.column + first_of(batch, order, j);
                let parts = [
                    x.order(order),
                    y.order(order),
                    c.order(order),
                    s.order(order),
                ];
                write(columns, column, target.row, parts);
            }
        }
    }
    for (j, step) in batch.determinants.iter().enumerate() {
        for (state, target) in states.iter().zip(targets) {
            for order in 0..T::ORDERS {
                let column = target.column + determinant_of(batch, order, j);
                let determinant = [state.determinants[*step].order(order)];
                write(columns, column, target.row, determinant);
            }
        }
    }
    // What does not close is rare: it is found out behind what is written, and written again.
    if !(sum_of_placed.is_finite() && all_zero(&(together * 0.0).0)) {
        solve_point_steps(batch, point_steps, design, branch, states);
        return write_wanted(batch, design, states, targets, columns);
    }
    W * states.len()
}

/// Finds the poses of steps that place one point alone.
#[cold]
#[inline(never)]
fn solve_point_steps<T: PlanNumber>(
    batch: &Batch,
    point_steps: &[PointStep],
    design: &Design<T>,
    branch: &Branch,
    states: &mut [Configuration<T>],
) {
    let steps = point_steps.iter().map(|it| it.step);
    batch.order.plan.solve_dyads(steps, design, branch, states);
}

/// Writes lanes into columns beside each other, one for each, at a row that is a multiple of their number.
#[cfg_attr(not(debug_assertions), inline(always))]
fn write<const W: usize, const N: usize>(
    columns: &mut [&mut [f64]],
    first: usize,
    row: usize,
    lanes: [Lanes<W>; N],
) {
    debug_assert_eq!(row % W, 0);
    let Some((columns, _)) = columns[first..].split_first_chunk_mut::<N>() else {
        return;
    };
    for (column, lanes) in columns.iter_mut().zip(&lanes) {
        if let Some(to) = column.as_chunks_mut().0.get_mut(row / W) {
            *to = lanes.0;
        }
    }
}

/// [`write_places`] for the lanes that are wanted alone, NaN where they do not close.
#[cold]
#[inline(never)]
fn write_wanted<T: Wide<W>, const W: usize>(
    batch: &Batch,
    design: &Design<T>,
    states: &[Configuration<T>],
    targets: &[Target],
    columns: &mut [&mut [f64]],
) -> usize {
    let mut closed = 0;
    for (state, target) in states.iter().zip(targets) {
        let closing = closing_spares(batch, design) + closing(state, &batch.order.wanted);
        let closes = lanes_where(|lane| closing.0[lane].is_finite(), W);
        closed += (target.wanted & closes).count_ones() as usize;
        let mut write = |column: usize, values: &[f64; W]| {
            let to = columns[target.column + column].iter_mut().skip(target.row);
            for (lane, (to, value)) in to.zip(values).enumerate() {
                if target.wanted >> lane & 1 == 1 {
                    *to = if closes >> lane & 1 == 1 {
                        *value
                    } else {
                        f64::NAN
                    };
                }
            }
        };
        for order in 0..T::ORDERS {
            for (j, marker) in batch.markers.iter().enumerate() {
                let place = state.place(design, *marker);
                for axis in 0..2 {
                    write(
                        order * batch.columns() + 2 * j + axis,
                        &place[axis].order(order).0,
                    );
                }
            }
            for (j, body) in batch.bodies.iter().enumerate() {
                for (k, part) in parts(&state.poses[*body]).iter().enumerate() {
                    write(first_of(batch, order, j) + k, &part.order(order).0);
                }
            }
            for (j, step) in batch.determinants.iter().enumerate() {
                let determinant = &state.determinants[*step];
                write(determinant_of(batch, order, j), &determinant.order(order).0);
            }
        }
    }
    closed
}

/// The first column of a body.
#[inline(always)]
fn first_of(batch: &Batch, order: usize, body: usize) -> usize {
    order * batch.columns() + 2 * batch.markers.len() + PARTS * body
}

/// The column of a determinant.
#[inline(always)]
fn determinant_of(batch: &Batch, order: usize, index: usize) -> usize {
    first_of(batch, order, batch.bodies.len()) + index
}

/// Finite in every lane in which these bodies have a pose.
#[cfg_attr(not(debug_assertions), inline(always))]
fn closing<T: Wide<W>, const W: usize>(state: &Configuration<T>, bodies: &[usize]) -> Lanes<W> {
    let mut sum = Lanes([0.0; W]);
    for body in bodies {
        let pose = &state.poses[*body];
        sum += pose.x.order(0) + pose.c.order(0);
    }
    sum
}

/// Finite in every lane in which the other bodies have a pose if those have one with which they are dyads.
#[cfg_attr(not(debug_assertions), inline(always))]
fn closing_spares<T: Wide<W>, const W: usize>(batch: &Batch, design: &Design<T>) -> Lanes<W> {
    let mut sum = Lanes([0.0; W]);
    for &(dyad, first) in &batch.order.spares {
        let own = &design.constants[dyad][first..first + 2];
        sum += own[0].order(0) + own[1].order(0);
    }
    sum
}

/// Whether all are zero, of either sign. Called, so that the lanes go to memory as whole registers.
#[inline(never)]
fn all_zero(closing: &[f64]) -> bool {
    let mut bits = 0;
    for x in closing {
        bits |= x.to_bits();
    }
    bits << 1 == 0
}

/// Cuts every column of `rows` values into pieces, and gathers the pieces that belong together.
pub(super) fn split_columns(out: &mut [f64], rows: usize, piece: usize) -> Vec<Vec<&mut [f64]>> {
    let mut pieces: Vec<Vec<&mut [f64]>> = Vec::new();
    pieces.resize_with(rows.div_ceil(piece), Vec::new);
    if rows > 0 {
        for column in out.chunks_mut(rows) {
            for (piece, part) in pieces.iter_mut().zip(column.chunks_mut(piece)) {
                piece.push(part);
            }
        }
    }
    pieces
}

pub(super) fn check_length(
    what: &'static str,
    expected: usize,
    got: usize,
) -> Result<(), BatchError> {
    if expected == got {
        return Ok(());
    }
    Err(BatchError::Length {
        what,
        expected,
        got,
    })
}

/// Whether every body has a pose.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn closes<T: Number>(state: &Configuration<T>) -> bool {
    let mut sum = 0.0;
    for pose in &state.poses[1..] {
        sum += pose.x.value() + pose.c.value();
    }
    sum.is_finite()
}
