//! Forces and torques from outside.

use std::ops::Range;

use kempe_mechanism::structure::Marker;
use kempe_mechanism::{Geometry, Mechanism};
use kempe_model::{LinkId, LoadKind};
use kempe_number::Number;

use crate::amount::Amount;
use crate::instant::Instant;
use crate::problem::Problem;
use crate::wrench::{self, Wrench};

/// A load in a mechanism; amounts by index into [`Instant::amounts`].
#[derive(Clone, Copy, Debug)]
pub enum Load {
    /// A force at a point of a link.
    Force {
        /// The link.
        link: LinkId,
        /// The point.
        at: Marker,
        /// The link in whose axes the components are.
        axes: LinkId,
        /// Index of the first component; the second follows.
        amount: usize,
    },
    /// A torque between two links.
    Torque {
        /// The link that feels it, counter-clockwise.
        on: LinkId,
        /// The link that takes the reaction.
        against: LinkId,
        /// Index of the torque.
        amount: usize,
    },
}

impl Load {
    /// The places of its amounts in [`Instant::amounts`].
    pub fn amounts(&self) -> Range<usize> {
        match *self {
            Self::Force { amount, .. } => amount..amount + 2,
            Self::Torque { amount, .. } => amount..amount + 1,
        }
    }

    /// Compiles the model's loads and what they vary with.
    pub(crate) fn all<T: Number>(
        mechanism: &Mechanism,
        parameters: &[T],
        amounts: &mut Vec<Amount<T>>,
        problems: &mut Vec<Problem>,
    ) -> Vec<Self> {
        let mut list = Vec::new();
        for load in &mechanism.model.actions.loads {
            let what = format!("the load `{}`", load.name);
            let mut add = |amount, problems: &mut Vec<Problem>| {
                amounts.push(Amount::new(
                    mechanism, amount, parameters, &load.span, &what, problems,
                ));
                amounts.len() - 1
            };
            match &load.kind {
                LoadKind::Force {
                    at,
                    components,
                    axes,
                } => {
                    let Some(marker) = mechanism.marker(*at) else {
                        let message =
                            format!("{what} acts at a point that its link does not carry");
                        problems.push(Problem::new("load-on-nothing", &load.span, message));
                        continue;
                    };
                    let amount = add(&components[0], problems);
                    add(&components[1], problems);
                    list.push(Self::Force {
                        link: at.link,
                        at: marker,
                        axes: *axes,
                        amount,
                    });
                }
                LoadKind::Torque {
                    on,
                    against,
                    amount,
                } => {
                    let amount = add(amount, problems);
                    list.push(Self::Torque {
                        on: *on,
                        against: *against,
                        amount,
                    });
                }
            }
        }
        list
    }

    /// A force load's components along the frame's axes, N; of a torque nothing.
    pub fn force<T: Number>(
        &self,
        mechanism: &Mechanism,
        geometry: &Geometry<T>,
        at: &Instant<T>,
    ) -> Option<[T; 2]> {
        match *self {
            Self::Force { axes, amount, .. } => {
                let local = [at.amounts[amount], at.amounts[amount + 1]];
                let seat = &geometry.seats[axes.index()];
                Some(at.poses[mechanism.body_of(axes).index()].turn(seat.turn(local)))
            }
            Self::Torque { .. } => None,
        }
    }

    /// Adds what it does to the links.
    pub(crate) fn act<T: Number>(
        &self,
        mechanism: &Mechanism,
        geometry: &Geometry<T>,
        at: &Instant<T>,
        on_links: &mut [Wrench<T>],
    ) {
        match *self {
            Self::Force {
                link, at: marker, ..
            } => {
                if let Some(force) = self.force(mechanism, geometry, at) {
                    let arm = at.arm(marker.body, geometry.marker(marker));
                    wrench::add(&mut on_links[link.index()], wrench::of_force(force, arm));
                }
            }
            Self::Torque {
                on,
                against,
                amount,
            } => {
                on_links[on.index()][2] += at.amounts[amount];
                on_links[against.index()][2] -= at.amounts[amount];
            }
        }
    }
}
