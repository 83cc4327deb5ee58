//! Dampers: a force against the speed at which two points part, a torque against the relative turning of two links.

use kempe_mechanism::{Geometry, Mechanism};
use kempe_model as model;

use crate::ends::{Ends, Extension};
use crate::instant::Instant;
use crate::number::ForceNumber;
use crate::problem::Problem;
use crate::wrench::Wrench;

/// A damper in a mechanism.
#[derive(Clone, Debug)]
pub struct Damper<T> {
    /// Its ends.
    pub ends: Ends,
    /// Damping when the ends part or the angle grows, N s/m or N m s/rad.
    pub parting: T,
    /// Damping the other way.
    pub closing: T,
}

impl<T: ForceNumber> Damper<T> {
    /// Compiles the model's dampers.
    pub(crate) fn all(
        mechanism: &Mechanism,
        geometry: &Geometry<T>,
        parameters: &[T],
        problems: &mut Vec<Problem>,
    ) -> Vec<Self> {
        let mut list = Vec::new();
        for damper in &mechanism.model.actions.dampers {
            let name = &damper.name;
            let named = (
                ["damper-ends", "damper-idle"],
                format!("the damper `{name}`"),
                &damper.span,
            );
            let Some(ends) = Ends::checked(mechanism, geometry, &damper.between, named, problems)
            else {
                continue;
            };
            let parting = model::value(&damper.damping, parameters);
            let closing = (damper.closing.as_ref())
                .map_or(parting, |scalar| model::value(scalar, parameters));
            if parting.any_lane(|x| x < 0.0) || closing.any_lane(|x| x < 0.0) {
                problems.push(Problem::new(
                    "negative-damping",
                    &damper.span,
                    format!("the damping of `{name}` is negative: it would add energy"),
                ));
            }
            list.push(Self {
                ends,
                parting,
                closing,
            });
        }
        list
    }

    fn tension(&self, stretch: &Extension<T>) -> T {
        stretch.rate.choose(self.parting, self.closing) * stretch.rate
    }

    /// Its tension at an instant, N or N m.
    pub fn tension_at(&self, geometry: &Geometry<T>, at: &Instant<T>) -> T {
        self.tension(&self.ends.stretch(geometry, at))
    }

    /// Power it takes from the mechanism at an instant, W, never negative.
    pub fn dissipation(&self, geometry: &Geometry<T>, at: &Instant<T>) -> T {
        let stretch = self.ends.stretch(geometry, at);
        self.tension(&stretch) * stretch.rate
    }

    /// Adds what it does to the links.
    pub(crate) fn act(&self, geometry: &Geometry<T>, at: &Instant<T>, on_links: &mut [Wrench<T>]) {
        let stretch = self.ends.stretch(geometry, at);
        let tension = self.tension(&stretch);
        let pull = match self.ends {
            Ends::Links(_) => tension,
            Ends::Points(_) => (-stretch.length).choose_with(T::zero, || tension / stretch.length),
        };
        self.ends.pull(geometry, at, &stretch, pull, on_links);
    }
}
