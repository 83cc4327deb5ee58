//! Chooses the place of each label: from the first choices on, labels are put elsewhere one by one as long as that is better.

use super::conflict::{APART, LINES_APART, OVERLAP, conflict};
use super::extent::Extent;
use super::surroundings::Surroundings;
use super::wanted::{Choice, Spot, Wanted};

/// Labels that are farther from each other than twice this do not matter to each other, mm.
const FREE: f64 = if APART > LINES_APART {
    APART
} else {
    LINES_APART
};
/// How often all labels are looked at again.
const SWEEPS: usize = 8;
/// With more labels than this, every label has its first choice.
const MOST_LABELS: usize = 300;

/// How many choices are worth while for each of so many labels.
pub(crate) fn most_choices(labels: usize) -> usize {
    match labels > MOST_LABELS {
        true => 1,
        false => usize::MAX,
    }
}

/// Chooses for each label one of its choices; `None` for those that are left out.
pub(crate) fn place(labels: &[Wanted], around: &[Surroundings]) -> Vec<Option<usize>> {
    let first = |label: &Wanted| (!label.choices.is_empty()).then_some(0);
    let mut chosen: Vec<Option<usize>> = labels.iter().map(first).collect();
    if labels.len() > MOST_LABELS {
        return chosen;
    }
    // what choices cost by themselves, where that was asked for
    let mut own: Vec<Vec<Cost>> = (labels.iter())
        .map(|label| vec![Cost::AtLeast(0.0); label.choices.len()])
        .collect();
    let extents: Vec<Vec<Vec<Extent>>> = (labels.iter())
        .map(|label| label.choices.iter().map(extents).collect())
        .collect();
    // those placed so far count; later labels do not stand anywhere yet
    let mut known = vec![false; labels.len()];
    for sweep in 0..SWEEPS {
        let mut changed = false;
        for number in 0..labels.len() {
            let mut best = (f64::INFINITY, None);
            for (index, choice) in labels[number].choices.iter().enumerate() {
                // nothing costs less than how much it is disliked
                if choice.dislike >= best.0 {
                    continue;
                }
                let cost = &mut own[number][index];
                if let Cost::AtLeast(least) = *cost
                    && least < best.0
                {
                    *cost = alone(choice, around, best.0);
                }
                let Cost::Is(mut cost) = *cost else {
                    continue;
                };
                let here = &extents[number][index];
                let mut others = (0..labels.len()).filter(|&k| k != number && known[k]);
                let mut among = 0.0;
                // others only make it worse
                let dearer = others.any(|k| {
                    if let Some(there) = chosen[k] {
                        let other = &labels[k].choices[there];
                        among += together((choice, here), (other, &extents[k][there]));
                    }
                    cost + among >= best.0
                });
                cost += among;
                if !dearer && cost < best.0 - 1e-9 {
                    best = (cost, Some(index));
                }
            }
            if labels[number].optional && best.0 >= OVERLAP {
                best.1 = None;
            }
            changed |= best.1 != chosen[number] || !known[number];
            chosen[number] = best.1;
            known[number] = true;
        }
        if sweep > 0 && !changed {
            break;
        }
    }
    chosen
}

/// What a choice costs by itself.
#[derive(Clone, Copy)]
enum Cost {
    /// So much.
    Is(f64),
    /// So much or more: nobody had to know it better.
    AtLeast(f64),
}

/// What a choice costs by itself: the mean over the poses. Where it is no less than `enough`, it need not be known.
fn alone(choice: &Choice, around: &[Surroundings], enough: f64) -> Cost {
    let one = |(spot, around): (&Option<Spot>, &Surroundings)| {
        let Some(spot) = spot else { return 0.0 };
        let lines = spot.lines.iter().map(|line| 0.3 * around.crossed(*line));
        around.covered(&spot.room) + lines.sum::<f64>()
    };
    let poses = around.len().max(1) as f64;
    let mut cost = choice.dislike;
    let mut all = 0.0;
    for pose in choice.spots.iter().zip(around) {
        all += one(pose);
        cost = choice.dislike + all / poses;
        if cost >= enough {
            return Cost::AtLeast(cost);
        }
    }
    Cost::Is(cost)
}

/// Where a choice puts its label in each pose, with the room that it keeps free.
fn extents(choice: &Choice) -> Vec<Extent> {
    let spots = choice.spots.iter().map(Option::as_ref);
    spots
        .map(|spot| spot.map_or(Extent::NONE, |s| Extent::of_spot(s).grown(FREE)))
        .collect()
}

/// What two choices cost each other: the mean over the poses.
fn together((a, around_a): (&Choice, &[Extent]), (b, around_b): (&Choice, &[Extent])) -> f64 {
    let one = |(a, b): (&Option<Spot>, &Option<Spot>)| match (a, b) {
        (Some(a), Some(b)) => conflict(a, b),
        _ => 0.0,
    };
    let poses = a.spots.iter().zip(&b.spots);
    let near = around_a.iter().zip(around_b).map(|(a, b)| a.meets(b));
    let met = poses.zip(near).filter(|(_, near)| *near);
    let all: f64 = met.map(|(pose, _)| one(pose)).sum();
    all / a.spots.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::labels::names::around_disc;
    use crate::labels::room::Room;
    use crate::scene::{Group, Item, Layer, Path, Point, Style};
    use crate::tokens::Token;

    fn choice(dislike: f64, x: f64) -> Choice {
        let room = Room::upright([x, 20.0], [3.0, 1.5]);
        let spot = Spot {
            room,
            lines: Vec::new(),
        };
        Choice {
            dislike,
            spots: vec![Some(spot)],
        }
    }

    fn wanted(places: &[f64], optional: bool) -> Wanted {
        let choices = places.iter().enumerate();
        let choices = choices.map(|(k, x)| choice(k as f64, *x)).collect();
        Wanted { choices, optional }
    }

    #[test]
    fn labels_give_way_to_each_other_and_to_what_is_drawn() {
        let bar = Path::polyline(&[[30.0, 0.0], [30.0, 40.0]]);
        let bar = Item::path(bar, Style::stroke(Token::Ink, 0.5));
        let group = Group::new(Layer::Link(1), vec![bar]);
        let around = [Surroundings::new([100.0, 40.0], &[group])];
        // the first choice of the first is on the bar, that of the second where the first goes to
        let labels = [
            wanted(&[30.0, 50.0], false),
            wanted(&[52.0, 70.0], false),
            wanted(&[71.0], true),
            wanted(&[99.0, 80.0], false),
        ];
        assert_eq!(place(&labels, &around), [Some(1), Some(1), None, Some(1)]);
        let least = place(&labels[..1], &[Surroundings::new([100.0, 40.0], &[])]);
        assert_eq!(least, [Some(0)]);
    }

    /// As [`place`], with everything looked at to its end.
    fn placed_plainly(labels: &[Wanted], around: &[Surroundings]) -> Vec<Option<usize>> {
        let mut chosen = vec![None; labels.len()];
        let mut known = vec![false; labels.len()];
        for _ in 0..SWEEPS {
            for number in 0..labels.len() {
                let mut best = (f64::INFINITY, None);
                for (index, choice) in labels[number].choices.iter().enumerate() {
                    let Cost::Is(own) = alone(choice, around, f64::INFINITY) else {
                        continue;
                    };
                    let others = (0..labels.len()).filter(|&k| k != number && known[k]);
                    let others = others.filter_map(|k| {
                        let other: &Choice = &labels[k].choices[chosen[k]?];
                        let spots = choice.spots.iter().zip(&other.spots);
                        let all: f64 = spots
                            .map(|(a, b)| match (a, b) {
                                (Some(a), Some(b)) => conflict(a, b),
                                _ => 0.0,
                            })
                            .sum();
                        Some(all / choice.spots.len() as f64)
                    });
                    let cost = own + others.sum::<f64>();
                    if cost < best.0 - 1e-9 {
                        best = (cost, Some(index));
                    }
                }
                if labels[number].optional && best.0 >= OVERLAP {
                    best.1 = None;
                }
                chosen[number] = best.1;
                known[number] = true;
            }
        }
        chosen
    }

    #[test]
    fn what_is_left_out_changes_no_choice() {
        let mut last = 0.7;
        let mut dice = |size: f64| {
            last = (last * 991.0 + 0.321) % 1.0;
            last * size
        };
        for crowd in [5, 15, 40] {
            let points: Vec<[Point; 2]> = (0..crowd)
                .map(|_| [0, 1].map(|_: usize| [10.0 + dice(80.0), 10.0 + dice(40.0)]))
                .collect();
            let around: Vec<Surroundings> = (0..2)
                .map(|pose| {
                    let bars = points.windows(2);
                    let bars = bars.map(|two| Path::polyline(&[two[0][pose], two[1][pose]]));
                    let bars = Item::Shape {
                        paths: bars.collect(),
                        style: Style::stroke(Token::Ink, 0.5),
                    };
                    Surroundings::new([100.0, 60.0], &[Group::new(Layer::Joint, vec![bars])])
                })
                .collect();
            let labels: Vec<Wanted> = (points.iter().enumerate())
                .map(|(k, places)| Wanted {
                    choices: around_disc(&places.map(Some), [1.9, 1.6], [4.0, 1.4]).collect(),
                    optional: k % 3 == 0,
                })
                .collect();
            assert_eq!(place(&labels, &around), placed_plainly(&labels, &around));
        }
    }
}
