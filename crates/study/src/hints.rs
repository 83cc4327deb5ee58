//! What the hints of a file decide: which of them do nothing, which contradict each other, and whether one assembly is left.

use kempe_mechanism::{Design, Pose};
use kempe_model::{HintKind, Model, Side};
use kempe_motion::assemble::{Assemblies, Assembly, Found, Standing, found_near, standings};
use kempe_number::math::hypot;
use kempe_units::{Dimension, format_digits};

use crate::unit::Units;
use crate::words::list;

/// Two assemblies are as near to the hints when their distances differ by less than this part of the mechanism's size.
const AS_NEAR: f64 = 1e-6;
/// Digits in which it is told how far a hint is missed.
const DIGITS: usize = 3;
/// A hint missed by less than this part of the mechanism's size, or of a radian, is met.
const ROUNDING: f64 = 1e-12;
/// Contradictions of up to so many sides are looked for; of more all are named.
const SMALL: usize = 4;

/// The sides that decide nothing, by their place in the file, each with the reason.
pub(crate) fn idle(design: &Design<f64>, assemblies: &Assemblies) -> Vec<(usize, String)> {
    let mechanism = &*design.mechanism;
    let model = &mechanism.model;
    let all = assemblies.list.iter().chain(&assemblies.others);
    let all = standings(design, all.map(|assembly| &assembly.poses[..]));
    let idle = |index: usize| {
        let mut found = all.iter().filter_map(|s| s.get(index).copied().flatten());
        let first = found.next()?;
        if first == Standing::Fails || found.any(|s| s == Standing::Fails) {
            return None;
        }
        let lies = all
            .iter()
            .any(|s| s.get(index) == Some(&Some(Standing::OnTheLine)));
        match (lies, parts(model, index)) {
            (true, Some((point, _, line))) => Some(format!("{point} lies on {line} here")),
            // Of those that were not found nothing is known.
            _ => (assemblies.complete).then(|| "every assembly agrees with it".to_owned()),
        }
    };
    (0..model.assembly.len())
        .filter_map(|index| Some((index, idle(index)?)))
        .collect()
}

/// The assemblies that agree with the file's sides and are as near to its places and angles as the chosen one, that one first.
pub(crate) fn as_near<'a>(design: &Design<f64>, assemblies: &'a Assemblies) -> &'a [Assembly] {
    let list = &assemblies.list;
    let nearest = list.first().map_or(0.0, |first| first.distance);
    let farther = |a: &Assembly| a.distance - nearest > AS_NEAR * design.size();
    let alike = list.iter().position(farther).unwrap_or(list.len());
    &list[..alike]
}

/// How far poses are from every place and angle that the file asks for: `C 12 mm and rocker 3 deg`.
pub(crate) fn off(design: &Design<f64>, units: &Units, poses: &[Pose<f64>]) -> String {
    let model = &design.mechanism.model;
    let found = found_near(design, poses).into_iter().zip(&model.assembly);
    let rough = |x: f64, dimension| {
        let size = match dimension {
            Dimension::LENGTH => design.size(),
            _ => 1.0,
        };
        let x = if x <= ROUNDING * size { 0.0 } else { x };
        format_digits(x, &units.unit(dimension), DIGITS)
    };
    let parts: Vec<String> = found
        .filter_map(|(found, hint)| {
            Some(match (found?, &hint.kind) {
                (Found::Place { off, .. }, HintKind::NearPlace { point, .. }) => format!(
                    "{} {}",
                    model.points.get(point.index())?.name,
                    rough(hypot(off[0], off[1]), Dimension::LENGTH)
                ),
                (Found::Angle { off, .. }, HintKind::NearAngle { link, .. }) => format!(
                    "{} {}",
                    model.links.get(link.index())?.name,
                    rough(off.abs(), Dimension::ANGLE)
                ),
                _ => return None,
            })
        })
        .collect();
    list(&parts)
}

/// The smallest set of sides that no assembly agrees with, by their place in the file.
pub(crate) fn contradiction(design: &Design<f64>, assemblies: &Assemblies) -> Vec<usize> {
    let fails = failing(design, &assemblies.others);
    let mut sides: Vec<usize> = fails.iter().flatten().copied().collect();
    sides.sort_unstable();
    sides.dedup();
    let excluded = |set: &[usize]| fails.iter().all(|f| f.iter().any(|i| set.contains(i)));
    (1..=SMALL.min(sides.len()))
        .find_map(|count| chosen(&sides, count, &mut Vec::new(), &excluded))
        .unwrap_or(sides)
}

/// The first choice of `count` of the `sides` that is `good`.
fn chosen(
    sides: &[usize],
    count: usize,
    taken: &mut Vec<usize>,
    good: &dyn Fn(&[usize]) -> bool,
) -> Option<Vec<usize>> {
    if count == 0 {
        return good(taken).then(|| taken.clone());
    }
    for (k, side) in sides.iter().enumerate() {
        taken.push(*side);
        let found = chosen(&sides[k + 1..], count - 1, taken, good);
        taken.pop();
        if found.is_some() {
            return found;
        }
    }
    None
}

/// The sides with which each assembly does not agree.
fn failing(design: &Design<f64>, assemblies: &[Assembly]) -> Vec<Vec<usize>> {
    let all = standings(design, assemblies.iter().map(|a| &a.poses[..]));
    let fails = |standings: Vec<Option<Standing>>| {
        let sides = standings.into_iter().enumerate();
        let fails = sides.filter(|(_, s)| *s == Some(Standing::Fails));
        fails.map(|(index, _)| index).collect()
    };
    all.into_iter().map(fails).collect()
}

/// How the assembly lies that agrees with most of the hints: `D left of A -> C`.
pub(crate) fn nearest(design: &Design<f64>, assemblies: &Assemblies) -> Option<String> {
    let mechanism = &*design.mechanism;
    let fails = failing(design, &assemblies.others).into_iter();
    let fewest = fails.min_by_key(Vec::len)?;
    let lies: Vec<String> = (fewest.into_iter())
        .filter_map(|index| {
            let (point, side, line) = parts(&mechanism.model, index)?;
            let other = if side == "left" { "right" } else { "left" };
            Some(format!("{point} {other} of {line}"))
        })
        .collect();
    Some(list(&lies))
}

/// A side in words: its point, `left` or `right`, its line.
fn parts(model: &Model, index: usize) -> Option<(&str, &'static str, String)> {
    let HintKind::Side {
        point,
        side,
        from,
        to,
    } = model.assembly.get(index)?.kind
    else {
        return None;
    };
    let name = |p: kempe_model::PointId| Some(model.points.get(p.index())?.name.as_str());
    let side = match side {
        Side::Left => "left",
        Side::Right => "right",
    };
    Some((
        name(point)?,
        side,
        format!("{} -> {}", name(from)?, name(to)?),
    ))
}

/// A hint in words: `B = left of A -> D`.
pub(crate) fn text(model: &Model, index: usize) -> String {
    parts(model, index).map_or_else(String::new, |(point, side, line)| {
        format!("{point} = \"{side} of {line}\"")
    })
}
