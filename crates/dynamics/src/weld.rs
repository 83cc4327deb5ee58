//! What a weld carries: the equilibrium of the part of a body that hangs on it.

use kempe_mechanism::Mechanism;
use kempe_mechanism::structure::Marker;
use kempe_model::{JointId, JointKind, LinkId, LinkPointRef};

/// A weld, found in the tree of links that make up a body.
#[derive(Clone, Debug)]
pub struct Weld {
    /// The joint.
    pub joint: JointId,
    /// The link that hangs on the other.
    pub child: LinkId,
    /// The link on which it hangs.
    pub parent: LinkId,
    /// The welded point.
    pub at: Marker,
    /// The child and every link that hangs on it.
    pub part: Vec<LinkId>,
}

impl Weld {
    /// The welds whose loads equilibrium determines; one that closes a ring of welded links has none.
    pub(crate) fn all(mechanism: &Mechanism) -> Vec<Self> {
        let mut list: Vec<Self> = Vec::new();
        for (index, joint) in mechanism.model.joints.iter().enumerate() {
            let JointKind::Weld { a, b, at, .. } = joint.kind else {
                continue;
            };
            let hangs = |child: LinkId, parent: LinkId| {
                let seat = mechanism.seats[child.index()].weld.as_ref();
                seat.is_some_and(|(on, point, _)| *on == parent && *point == at)
                    && !list.iter().any(|w| w.child == child)
            };
            let (child, parent) = match (hangs(a, b), hangs(b, a)) {
                (true, _) => (a, b),
                (_, true) => (b, a),
                _ => continue,
            };
            let Some(marker) = mechanism.marker(LinkPointRef {
                link: child,
                point: at,
            }) else {
                continue;
            };
            list.push(Self {
                joint: JointId(index as u32),
                child,
                parent,
                at: marker,
                part: hanging_on(mechanism, child),
            });
        }
        list
    }
}

fn hanging_on(mechanism: &Mechanism, root: LinkId) -> Vec<LinkId> {
    let mut part = vec![root];
    let mut next = 0;
    while let Some(&link) = part.get(next) {
        next += 1;
        for (index, seat) in mechanism.seats.iter().enumerate() {
            if seat.weld.as_ref().is_some_and(|(on, _, _)| *on == link) {
                part.push(LinkId(index as u32));
            }
        }
    }
    part
}
