//! Which row of another design belongs to a row of this one.

use crate::result::{Frame, StudyResult};

/// Places nearer than this part of the whole way are the same place.
const SAME_PLACE: f64 = 1e-9;

/// Digits of how far a pose lies away.
const FAR_DIGITS: usize = 3;

/// How the rows of two designs belong together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum By {
    /// Row by row: both stand at the same places.
    Rows,
    /// By the coordinate that both run along, which goes one way.
    Coordinate,
    /// By the share of the rows that have passed.
    Share,
}

/// For each row of this design, the place among the rows of the other one.
#[derive(Clone, Debug)]
pub(crate) struct Matched {
    by: By,
    name: String,
    /// A row of the other design, and the share of the way to its next row; `None` where it has no such place.
    places: Vec<Option<(usize, f64)>>,
}

impl Matched {
    /// How the rows of two results of one study belong together.
    pub fn of(this: &StudyResult, other: &StudyResult) -> Self {
        let columns = [this.abscissa(), other.abscissa()];
        let rows = [this.table.rows(), other.table.rows()];
        let name = columns[0].map_or_else(String::new, |c| c.name.clone());
        let matched = |by, places| Self {
            by,
            name: name.clone(),
            places,
        };
        if let [Some(one), Some(two)] = columns
            && one.name == two.name
            && one.unit.dimension() == two.unit.dimension()
        {
            let (one, two) = (one.si(), two.si());
            let near = SAME_PLACE * way(&one).max(way(&two));
            let same = |(a, b): (&f64, &f64)| (a - b).abs() <= near;
            if one.len() == two.len() && one.iter().zip(&two).all(same) {
                return matched(By::Rows, (0..rows[0]).map(|k| Some((k, 0.0))).collect());
            }
            if let (Some(_), Some(sense)) = (sense(&one), sense(&two)) {
                let place = |at: &f64| place(&two, *at, sense, near);
                return matched(By::Coordinate, one.iter().map(place).collect());
            }
        }
        let last = |k: usize| rows[k].saturating_sub(1) as f64;
        let share = |row: usize| {
            let at = row as f64 / last(0).max(1.0) * last(1);
            let first = at.floor();
            (rows[1] > 0).then_some((first as usize, at - first))
        };
        matched(By::Share, (0..rows[0]).map(share).collect())
    }

    /// How, in words.
    pub fn told(&self, other: &StudyResult) -> String {
        let name = &self.name;
        match self.by {
            By::Rows => format!("both at the same {name}"),
            By::Coordinate => {
                let far = self.farthest(other);
                let far = far.map_or_else(String::new, |far| format!(", at most {far} away"));
                format!(
                    "both at the same {name}; its rows lie elsewhere: its values are interpolated between them, its pose is that of \
                     the nearest one{far}"
                )
            }
            By::Share => "both after the same share of their rows, which do not run the same way; its values and its pose are those \
                 of the nearest row"
                .to_owned(),
        }
    }

    /// The row of the other design that is nearest.
    fn nearest(&self, place: (usize, f64)) -> usize {
        place.0 + usize::from(place.1 > 0.5)
    }

    /// Values of the other design's rows at the rows of this one.
    pub fn values(&self, column: &[f64]) -> Vec<f64> {
        let at = |row: usize| column.get(row).copied().unwrap_or(f64::NAN);
        let value = |place: &Option<(usize, f64)>| match *place {
            None => f64::NAN,
            Some((row, 0.0)) => at(row),
            Some(place) if self.by == By::Share => at(self.nearest(place)),
            Some((row, share)) => at(row) + share * (at(row + 1) - at(row)),
        };
        self.places.iter().map(value).collect()
    }

    /// Poses of the other design at the rows of this one.
    pub fn frames<'f>(&self, frames: &'f [Frame]) -> Vec<Option<&'f Frame>> {
        let frame = |place: &Option<(usize, f64)>| frames.get(self.nearest((*place)?));
        self.places.iter().map(frame).collect()
    }

    /// The farthest that a pose of the other design lies from the place it is shown at, such as `0.5 deg`; `None` where it lies
    /// right there.
    fn farthest(&self, other: &StudyResult) -> Option<String> {
        let along = other.abscissa().filter(|_| self.by == By::Coordinate)?;
        let gaps = self.places.iter().flatten().map(|(row, share)| {
            let at = |k: usize| along.values.get(k).copied().unwrap_or(f64::NAN);
            let part = share.min(1.0 - share);
            if part > 0.0 {
                part * (at(row + 1) - at(*row)).abs()
            } else {
                0.0
            }
        });
        let farthest = gaps.filter(|g| g.is_finite()).fold(0.0, f64::max);
        let text = kempe_number::text::significant(farthest, FAR_DIGITS);
        (farthest > 0.0).then(|| {
            format!("{text} {}", along.unit.text())
                .trim_end()
                .to_owned()
        })
    }
}

/// How far values go.
fn way(values: &[f64]) -> f64 {
    let finite = || values.iter().copied().filter(|v| v.is_finite());
    let (low, high) = (
        finite().fold(f64::INFINITY, f64::min),
        finite().fold(f64::NEG_INFINITY, f64::max),
    );
    (high - low).max(0.0)
}

/// +1 where values grow from each to the next, -1 where they fall; `None` where they do neither.
fn sense(values: &[f64]) -> Option<f64> {
    let first = values.get(1)? - values.first()?;
    let sense = if first > 0.0 { 1.0 } else { -1.0 };
    let steps = values.windows(2);
    let mut signed = steps.map(|pair| sense * (pair[1] - pair[0]));
    signed.all(|step| step > 0.0).then_some(sense)
}

/// The place of a value among those that run one way.
fn place(values: &[f64], at: f64, sense: f64, near: f64) -> Option<(usize, f64)> {
    let last = values.len().checked_sub(1)?;
    let after = values.partition_point(|v| sense * (v - at) < -near);
    let next = *values.get(after)?;
    if (next - at).abs() <= near {
        return Some((after, 0.0));
    }
    let row = after.checked_sub(1).filter(|row| *row < last)?;
    let before = values[row];
    Some((row, (at - before) / (next - before)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_has_its_place_between_rows_and_none_beyond() {
        let rows = [0.0, 10.0, 30.0];
        for (at, expected) in [
            (0.0, Some((0, 0.0))),
            (2.5, Some((0, 0.25))),
            (10.0 + 1e-12, Some((1, 0.0))),
            (25.0, Some((1, 0.75))),
            (30.0, Some((2, 0.0))),
            (31.0, None),
            (-1.0, None),
            (f64::NAN, None),
        ] {
            assert_eq!(place(&rows, at, 1.0, 1e-9), expected, "{at}");
        }
        let falling = [30.0, 10.0, 0.0];
        assert_eq!(place(&falling, 20.0, -1.0, 1e-9), Some((0, 0.5)));
        assert_eq!(sense(&falling), Some(-1.0));
        assert_eq!(sense(&[0.0, 1.0, 0.5]), None);
    }
}
