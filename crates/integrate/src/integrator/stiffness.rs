//! Whether the other method would get further for the same work.

/// Explicit steps of order 8 are stable up to about this length, times the rate of the fastest solution nearby.
const STABLE: f64 = 6.1;
/// From here on steps are near that bound: held at it, they are longer and shorter in turn.
const STRAIN: f64 = 4.0;
/// Shorter ones are held back, too, where solutions nearby change so many times as much in them as this one bends: the rounding of rates
/// that those multiply looks like an error of the step.
const HELD_BACK: f64 = 0.25;
const STRAIGHT: f64 = 1e-3;
/// Rates asked for in an explicit step.
const EXPLICIT_WORK: f64 = 12.0;
/// So many explicit steps near the bound of stability show a stiff system,
const STRAINED: usize = 15;
/// unless so many in a row were not.
const CALM: usize = 6;
/// Implicit steps whose progress is looked at together.
const WINDOW: usize = 10;
/// Explicit steps must promise so much more progress for their work before they are taken again.
const GAIN: f64 = 2.0;
/// Nobody waits longer than so many strained steps.
const LONGEST_PATIENCE: usize = 100;

/// What the steps so far tell.
#[derive(Clone, Debug)]
pub(super) struct Watch {
    /// Strained explicit steps, and those in a row that were not.
    strained: usize,
    calm: usize,
    /// How many strained ones it takes: more after implicit steps that were no gain.
    patience: usize,
    /// How long explicit steps come to be, times the fastest solution's rate.
    reach: f64,
    /// Implicit steps since the switch.
    stayed: usize,
    /// Way and work since the window began.
    way: f64,
    work_before: usize,
    wants_other: bool,
}

impl Default for Watch {
    fn default() -> Self {
        Self {
            strained: 0,
            calm: 0,
            patience: STRAINED,
            reach: STABLE,
            stayed: 0,
            way: 0.0,
            work_before: 0,
            wants_other: false,
        }
    }
}

impl Watch {
    /// Whether the next step is the other method's.
    pub(super) fn wants_other(&self) -> bool {
        self.wants_other
    }

    /// The other method goes on, after so many rates were asked for.
    pub(super) fn switched(&mut self, work: usize) {
        *self = Self {
            patience: self.patience,
            reach: self.reach,
            work_before: work,
            ..Self::default()
        };
    }

    /// After an explicit step of this length, times the fastest solution's rate (Hairer, Nørsett, Wanner's test), over which the rates
    /// changed by a part `bend`.
    pub(super) fn explicit_step(&mut self, strain: f64, bend: f64) {
        let held_back = strain > HELD_BACK && bend < STRAIGHT * strain;
        if strain > STRAIN || held_back {
            let reach = if strain > STRAIN { STABLE } else { strain };
            self.reach = match self.strained {
                0 => reach,
                _ => self.reach.max(reach),
            };
            self.calm = 0;
            self.strained += 1;
            self.wants_other = self.strained >= self.patience;
        } else {
            self.calm += 1;
            if self.calm == CALM {
                self.strained = 0;
            }
        }
    }

    /// After an implicit step of this length, with all the work so far; `fastest` is the fastest solution's rate.
    pub(super) fn implicit_step(
        &mut self,
        length: f64,
        work: usize,
        fastest: impl FnOnce() -> f64,
    ) {
        self.stayed += 1;
        self.way += length;
        if !self.stayed.is_multiple_of(WINDOW) {
            return;
        }
        let implicit = self.way / work.saturating_sub(self.work_before).max(1) as f64;
        let explicit = self.reach / fastest() / EXPLICIT_WORK;
        (self.way, self.work_before) = (0.0, work);
        self.wants_other = explicit > GAIN * implicit;
        if self.wants_other {
            self.patience = match self.stayed == WINDOW {
                true => (2 * self.patience).min(LONGEST_PATIENCE),
                false => STRAINED,
            };
        }
    }
}
