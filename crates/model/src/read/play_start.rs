//! Where the bodies of joints with play start in a study of clearance.
//!
//! ```toml
//! start = { B = ["50 um", "-90 deg"], B_rate = ["2 mm/s", 0], bore = ["10 um", "0.1 deg"] }
//! ```

use kempe_units::{Builtin, Dimension, Expr};

use crate::ids::Scalar;
use crate::joint::JointKind;
use crate::node::{Key, Node};
use crate::read::context::{Context, Meaning};
use crate::read::names::is_point_name;
use crate::simulate_study::{PlayAt, PlayStart};

/// What follows the name of a drive or a joint whose speed is meant.
pub(crate) const RATE: &str = "_rate";

/// Whether a key is meant for a joint, and for no drive.
pub(crate) fn names(cx: &Context<'_>, key: &str) -> bool {
    let is_joint = |name: &str| matches!(cx.names.get(name), Some((Meaning::Joint(_), _)));
    is_point_name(key) || is_joint(key) || key.strip_suffix(RATE).is_some_and(is_joint)
}

/// Reads one key.
pub(crate) fn read(
    cx: &mut Context<'_>,
    key: &Key,
    node: &Node,
    list: &mut Vec<PlayStart>,
) -> Option<()> {
    let known = cx.points.contains_key(&key.name) || cx.names.contains_key(&key.name);
    let rate_of = key.name.strip_suffix(RATE).filter(|_| !known);
    let name = rate_of.unwrap_or(&key.name);
    let at = joint(cx, key, name)?;
    let second = match at {
        PlayAt::Pin(_) => Dimension::LENGTH,
        PlayAt::Joint(_) => Dimension::ANGLE,
    };
    let per = match rate_of {
        Some(_) => Dimension::TIME,
        None => Dimension::NONE,
    };
    let pair = pair(
        cx,
        key,
        node,
        [Dimension::LENGTH, second].map(|of| of / per),
    )?;
    let index = list.iter().position(|it| it.at == at).unwrap_or_else(|| {
        list.push(PlayStart {
            at,
            place: None,
            rate: None,
            span: key.span.clone(),
        });
        list.len() - 1
    });
    let it = list.get_mut(index)?;
    *(match rate_of {
        Some(_) => &mut it.rate,
        None => &mut it.place,
    }) = Some(pair);
    Some(())
}

/// The pin or slider of a name.
fn joint(cx: &mut Context<'_>, key: &Key, name: &str) -> Option<PlayAt> {
    if let Some((Meaning::Joint(index), _)) = cx.names.get(name) {
        let id = cx.joints.get(*index).copied().flatten()?;
        let kind = cx.model.joints.get(id.index()).map(|j| &j.kind);
        if matches!(kind, Some(JointKind::Slider { .. })) {
            return Some(PlayAt::Joint(id));
        }
        return cx.refuse(
            "not-a-slider",
            format!("`{name}` is no slider, and loses no contact"),
            &key.span,
            "pins, by their points, and sliders may start anywhere in their play",
        );
    }
    let point = cx.point(name, key.span.clone())?;
    match cx.carriers(point).len() > 1 {
        true => Some(PlayAt::Pin(point)),
        false => cx.refuse(
            "not-a-pin",
            format!("{name} is no pin: only one link carries it"),
            &key.span,
            "pins, by their points, and sliders may start anywhere in their play",
        ),
    }
}

/// Two values; of two alike also `[size, angle]`.
fn pair(cx: &mut Context<'_>, key: &Key, node: &Node, of: [Dimension; 2]) -> Option<[Scalar; 2]> {
    let what = format!("`{}`", key.name);
    let example = format!("[{}, {}]", cx.example(of[0]), cx.example(of[1]));
    let items = cx.array(node, &what, &example)?;
    let [first, second] = items else {
        let help = format!("write two, {example}");
        cx.not_two(node, items, format!("{what} has two values"), &help);
        return None;
    };
    if of[0] == of[1]
        && let (angle, Dimension::ANGLE) = cx.inferred(second, of[1])?
    {
        let size = cx.scalar(first, of[0])?;
        let part = |function| {
            let direction = Expr::Call(function, vec![angle.clone()]);
            Expr::Mul(Box::new(size.clone()), Box::new(direction))
        };
        return Some([part(Builtin::Cos), part(Builtin::Sin)]);
    }
    let (first, second) = (cx.scalar(first, of[0]), cx.scalar(second, of[1]));
    Some([first?, second?])
}
