//! Where the edge of what can be evaluated is beside a design, sought by halving.
//!
//! Where steps end there again and again, the edge is sought beside the design by halving, and goes into the programmes as a limit of its own. Steps that
//! it holds go along it, and are led back to it. It asks of designs only whether they can be evaluated: what they lack need not be smooth. Steps go a little
//! beside it: on it there may be no slopes, and towards it a goal may be steep without bound, as an angle is where a linkage locks. At the end it is met, or nearly.

use crate::problem::Evaluation;
use crate::workers::Alone;

use super::super::local::Local;
use super::super::search::{Search, Step, is_enough};
use super::super::vector::{along, dot, length};
use super::{Edge, INSIDE};

/// The edge is sought at this distance to all sides of a place, in parts of the box.
const BESIDE: f64 = 1e-3;
/// How exactly it is met, in parts of the box.
const MET: f64 = 1e-11;
/// The first distance at which the edge is looked for beside a step is the step's square, as of what is curved; it grows by the factor.
const FARTHER: f64 = 8.0;
/// What is looked for along a step is no nearer than this.
const NEAREST: f64 = 1e-9;
/// At the end it is met, or so nearly: right on it a linkage may go on otherwise, as at a change point.
const SHORT_OF: [f64; 4] = [0.0, 1e-9, 1e-8, 1e-7];
/// A penalty that is another on the edge than beside it by more than on all the way there, and by more than this, jumps.
const JUMPED: f64 = 1e-9;
/// Steps along it are shortened by this part, so often.
const SHORTER: f64 = 0.25;
const SHORTENED: usize = 9;

/// Where a way meets the edge.
enum Meeting {
    /// The last place on the way that can be evaluated.
    At(f64),
    /// All of the way can be evaluated.
    Inside,
    /// No place on the way, or it leads out of the box.
    Nowhere,
}

impl Search<'_> {
    /// Whether a place of the unit box can be evaluated; `None` where that is not asked.
    fn can(&mut self, place: &[f64]) -> Option<bool> {
        self.lack(place).map(|lack| lack == 0.0)
    }

    /// What a place of the unit box lacks; `None` outside of the box, and where all designs that are allowed are used.
    fn lack(&mut self, place: &[f64]) -> Option<f64> {
        let is_outside = !place.iter().all(|x| (0.0..=1.0).contains(x));
        if is_outside || self.evaluations >= self.allowed {
            return None;
        }
        let design = self.space.design(place);
        let told = self.evaluate(std::slice::from_ref(&design), &Alone);
        Some(told.iter().fold(0.0, |most, it| most.max(it.lack)))
    }

    /// Where the line through a place meets the edge, sought from so near on up to so far: outwards where the place can be evaluated, else
    /// inwards.
    fn meeting(&mut self, (from, way): (&[f64], &[f64]), [near, far]: [f64; 2]) -> Meeting {
        let Some(inside) = self.can(from) else {
            return Meeting::Nowhere;
        };
        let sign = if inside { 1.0 } else { -1.0 };
        let (mut last, mut next) = (0.0, near.min(far));
        loop {
            match self.can(&along(from, way, sign * next)) {
                None => return Meeting::Nowhere,
                Some(there) if there != inside => break,
                Some(_) if next >= far && inside => return Meeting::Inside,
                Some(_) if next >= far => return Meeting::Nowhere,
                Some(_) => (last, next) = (next, (next * FARTHER).min(far)),
            }
        }
        let (can, cannot) = match inside {
            true => (last, next),
            false => (-next, -last),
        };
        Meeting::At(self.between((from, way), can, cannot))
    }

    /// The last place on a way that can be evaluated, between one that can and one that cannot: by halving, and where what is lacking goes evenly towards
    /// nothing by where that leads.
    fn between(&mut self, (from, way): (&[f64], &[f64]), mut can: f64, mut cannot: f64) -> f64 {
        // The last two that cannot, the nearer first.
        let mut lacks: [Option<(f64, f64)>; 2] = [None; 2];
        // How many guesses could, and whether the last one that could not left more than half.
        let (mut met, mut halves) = (0, false);
        while cannot - can > MET {
            let guess = match lacks {
                [Some((a, at_a)), Some((b, at_b))] if met < 2 && !halves && at_b > at_a => {
                    // First a little on this side of where it should be, then on the other.
                    let side = if met == 0 { -0.4 } else { 0.4 };
                    Some(a - at_a * (b - a) / (at_b - at_a) + side * MET)
                }
                _ => None,
            };
            let guess = guess.filter(|t| can < *t && *t < cannot);
            let next = guess.unwrap_or(0.5 * (can + cannot));
            let lack = self.lack(&along(from, way, next)).unwrap_or(f64::INFINITY);
            match lack == 0.0 {
                true => {
                    met += usize::from(guess.is_some());
                    halves = false;
                    can = next;
                }
                false => {
                    halves = guess.is_some() && next - can > 0.5 * (cannot - can);
                    lacks = [Some((next, lack)), lacks[0]];
                    cannot = next;
                }
            }
        }
        can
    }

    /// The edge that a step from a place meets.
    pub fn edge_ahead(&mut self, place: &Local, step: &[f64]) -> Option<Edge> {
        let size = dot(step, step).sqrt();
        if !(size > NEAREST) {
            return None;
        }
        let way: Vec<f64> = step.iter().map(|x| x / size).collect();
        let from = self.space.unit(&place.design);
        match self.meeting((&from, &way), [NEAREST, size]) {
            Meeting::At(t) => self.edge_at(along(&from, &way, t), &way),
            _ => None,
        }
    }

    /// The edge at a place on it, from where a way leads out: by where it is to all sides of the place.
    fn edge_at(&mut self, at: Vec<f64>, way: &[f64]) -> Option<Edge> {
        let mut normal = way.to_vec();
        for side in self.sides(way) {
            let met = [1.0, -1.0].map(|part| self.turned((&at, way), &side, part));
            let slope = match met {
                [Some(a), Some(b)] => 0.5 * (a + b),
                // Beside a bound of the box there is one side alone, where it is asked again, nearer.
                [Some(a), None] => self.nearer((&at, way), &side, (0.5, a)),
                [None, Some(b)] => self.nearer((&at, way), &side, (-0.5, b)),
                [None, None] => return None,
            };
            normal
                .iter_mut()
                .zip(&side)
                .for_each(|(n, s)| *n -= slope * s);
        }
        let size = dot(&normal, &normal).sqrt();
        normal.iter_mut().for_each(|n| *n /= size);
        Some(Edge { normal, at })
    }

    /// By how much the edge at a place on it lies farther out for each step to a side: by where it is some part of a distance beside the place.
    fn turned(&mut self, (at, way): (&[f64], &[f64]), side: &[f64], part: f64) -> Option<f64> {
        let beside = along(at, side, part * BESIDE);
        let reach = [BESIDE * BESIDE, BESIDE * FARTHER];
        match self.meeting((&beside, way), reach) {
            Meeting::At(t) => Some(t / (part * BESIDE)),
            _ => None,
        }
    }

    /// The same where the sides' distances go to nothing, by what is known of a whole one and by another part; that of the whole one where there is no other.
    fn nearer(&mut self, about: (&[f64], &[f64]), side: &[f64], (part, whole): (f64, f64)) -> f64 {
        let nearer = self.turned(about, side, part);
        nearer.map_or(whole, |nearer| 2.0 * nearer - whole)
    }

    /// Directions at right angles to a way and to each other, in which designs can differ (A. S. Householder, 1958).
    fn sides(&self, way: &[f64]) -> Vec<Vec<f64>> {
        let order = |a: &usize, b: &usize| way[*a].abs().total_cmp(&way[*b].abs());
        let Some(largest) = (0..way.len()).max_by(order) else {
            return Vec::new();
        };
        let mut mirror = way.to_vec();
        mirror[largest] += 1.0_f64.copysign(way[largest]);
        let size = dot(&mirror, &mirror);
        let others = (0..way.len()).filter(|k| *k != largest && self.space.widths[*k] > 0.0);
        let side = |k: usize| {
            let unit = |j: usize| f64::from(u8::from(j == k));
            let sides = mirror.iter().enumerate();
            sides
                .map(|(j, m)| unit(j) - 2.0 * m * mirror[k] / size)
                .collect()
        };
        others.map(side).collect()
    }

    /// The first place along the edge that a step leads to, shortened again and again, that is good enough.
    pub fn along_edge(&mut self, place: &Local, step: Step) -> Option<Local> {
        let edge = place.edge.as_ref()?;
        let size = length(&step.minimum.step);
        let mut part = 1.0;
        for _ in 0..SHORTENED {
            let ahead = self.space.moved(&place.design, &step.minimum.step, part);
            let ahead = self.space.unit(&ahead);
            let out = within(&edge.normal, &ahead);
            let far = (part * size).max(2.0 * INSIDE);
            let reach = [(far * far).max(2.0 * INSIDE), far];
            let (there, on_edge) = match self.meeting((&ahead, &out), reach) {
                Meeting::At(t) => {
                    let inside = along(&ahead, &out, t - INSIDE);
                    (Some(inside), Some(along(&ahead, &out, t)))
                }
                Meeting::Inside => (Some(ahead), None),
                Meeting::Nowhere => (None, None),
            };
            if let Some(there) = there {
                let design = self.space.design(&there);
                let told = self.evaluate(std::slice::from_ref(&design), &Alone);
                let evaluation = told.into_iter().next()?;
                let penalty = self.penalty(&evaluation, step.weight);
                if design != place.design
                    && is_enough(place, step, part, penalty)
                    && let Some(next) = self.with_slopes(design, evaluation)
                {
                    let edge = on_edge.and_then(|at| {
                        let way = (&at[..], &out[..], INSIDE);
                        match self.steep_normal(&next, way) {
                            Some(normal) => Some(Edge { normal, at }),
                            None => self.edge_at(at, &out),
                        }
                    });
                    return Some(next.beside(edge, &self.space));
                }
            }
            part *= SHORTER;
        }
        None
    }

    /// The design on the edge that is nearest to a place beside it, where it is no worse there; else one as near to the edge as it is not.
    pub fn onto_edge(&mut self, place: &Local, weight: f64) -> Option<(Vec<f64>, Evaluation)> {
        let (from, out, t) = self.way_out(place)?;
        let here = place.penalty(weight);
        let mut at = |short: f64| {
            let design = self.space.design(&along(&from, &out, t - short));
            let told = self.evaluate(std::slice::from_ref(&design), &Alone);
            let evaluation = told.into_iter().next().filter(Evaluation::is_defined)?;
            let penalty = self.penalty(&evaluation, weight);
            Some((penalty, (design, evaluation)))
        };
        let [first, second] = [SHORT_OF[0], SHORT_OF[1]].map(&mut at);
        // What is gained on the edge alone, and on no way to it, no design beside it has.
        let jumps = |(on_edge, _): &(f64, _)| {
            let beside = second.as_ref().map_or(f64::INFINITY, |(beside, _)| *beside);
            (on_edge - beside).abs() > (beside - here).abs() + JUMPED
        };
        let met = first.filter(|it| !jumps(it)).into_iter().chain(second);
        let nearly = SHORT_OF[2..].iter().filter_map(|short| at(*short));
        let mut all = met.chain(nearly);
        let told = all.find(|(penalty, _)| *penalty <= here);
        told.map(|(_, told)| told)
    }

    /// The way out from a place to the edge beside it, in parts of the box, and how far that is. What is on a bound stays there.
    pub fn way_out(&mut self, place: &Local) -> Option<(Vec<f64>, Vec<f64>, f64)> {
        let edge = place.edge.as_ref()?;
        let from = self.space.unit(&place.design);
        let on_bound = |x: f64| x <= MET || x >= 1.0 - MET;
        let both = edge.normal.iter().zip(&from);
        let out = of_length_one(both.map(|(w, x)| if on_bound(*x) { 0.0 } else { *w }));
        match self.meeting((&from, &out), [2.0 * INSIDE, BESIDE]) {
            Meeting::At(t) => Some((from, out, t)),
            _ => None,
        }
    }

    /// A design just beyond the edge that a place is at; `None` where there is no edge.
    pub fn beyond(&mut self, place: &Local) -> Option<Vec<f64>> {
        let edge = place.edge.as_ref()?;
        let from = self.space.unit(&place.design);
        let out = within(&edge.normal, &from);
        let mut past = 2.0 * INSIDE;
        while past < BESIDE {
            let there: Vec<f64> = along(&from, &out, past);
            let there: Vec<f64> = there.iter().map(|x| x.clamp(0.0, 1.0)).collect();
            if self.can(&there) == Some(false) {
                return Some(self.space.design(&there));
            }
            past *= FARTHER;
        }
        None
    }
}

/// A way without what would lead out of the box from a place, of length one; nothing where all of it would.
fn within(way: &[f64], place: &[f64]) -> Vec<f64> {
    let leads_out = |x: f64, w: f64| (x <= MET && w < 0.0) || (x >= 1.0 - MET && w > 0.0);
    let both = way.iter().zip(place);
    of_length_one(both.map(|(w, x)| if leads_out(*x, *w) { 0.0 } else { *w }))
}

/// A way of length one, or none at all.
fn of_length_one(way: impl Iterator<Item = f64>) -> Vec<f64> {
    let way: Vec<f64> = way.collect();
    let size = dot(&way, &way).sqrt();
    match size > 0.0 {
        true => way.iter().map(|w| w / size).collect(),
        false => way,
    }
}
