//! The circle and the line from which the places of an arc lie the least far, in the worst of them (Chebyshev's sense).

use crate::C;

mod references;

use references::minimax;

/// A circle near an arc.
#[derive(Clone, Copy, Debug)]
pub struct NearestCircle {
    /// Its centre.
    pub centre: C,
    /// Its radius.
    pub radius: f64,
    /// How far the places lie from it at most: half of the width of the ring that holds them.
    pub deviation: f64,
    /// Four places that lie that far off, by their indices, rising: no circle near by comes nearer to these four.
    pub touched: [usize; 4],
}

/// A line near an arc.
#[derive(Clone, Copy, Debug)]
pub struct NearestLine {
    /// A point of it.
    pub point: C,
    /// Its direction, of length one, from the first place to the last rather than back.
    pub direction: C,
    /// How far the places lie from it at most: half of the width of the strip that holds them.
    pub deviation: f64,
    /// Two places on one edge of the strip, and one on the other.
    pub touched: [usize; 3],
}

/// A circle of a larger radius, in sizes of the arc, is a line.
const FLATTEST: f64 = 1e6;
/// Steps towards the nearest circle at most; each squares the error where it is small.
const STEPS: usize = 40;
/// A step that leads nowhere is halved so often.
const HALVINGS: usize = 12;
/// A step this small, with the arc's size as unit, changes nothing more.
const SETTLED: f64 = 1e-13;

/// A circle or line by its signed curvature, the angle of its gradient in the origin, and the distance of the origin: smooth through the line.
#[derive(Clone, Copy)]
struct Curve {
    curvature: f64,
    angle: f64,
    distance: f64,
}

impl Curve {
    fn through(a: C, b: C, c: C) -> Option<Self> {
        let (u, v) = (b - a, c - a);
        let twice = 2.0 * (u.conj() * v).im;
        let off = (v.scale(u.norm_sqr()) - u.scale(v.norm_sqr())) * C::new(0.0, -1.0);
        let centre = a + off.scale(1.0 / twice);
        // Nearly a line: its circle is too far away to be told by its centre.
        match centre.norm() < FLATTEST {
            true => Some(Self {
                curvature: 1.0 / (a - centre).norm(),
                angle: (-centre).arg(),
                distance: centre.norm() - (a - centre).norm(),
            }),
            false => Self::line(a, c),
        }
    }

    fn line(a: C, b: C) -> Option<Self> {
        let normal = C::i() * (b - a);
        let length = normal.norm();
        (length > 0.0).then(|| Self {
            curvature: 0.0,
            angle: normal.arg(),
            distance: -(normal.conj() * a).re / length,
        })
    }

    /// How far a place lies from it, with a sign, and how that changes with its three numbers.
    fn off(&self, place: C) -> (f64, [f64; 3]) {
        let Self {
            curvature,
            angle,
            distance,
        } = *self;
        let normal = C::from_polar(1.0, angle);
        let own = normal.conj() * place;
        let (along, across) = (own.re, own.im);
        let reach = 1.0 + curvature * distance;
        let moved = 0.5 * ((along + distance) * (along + distance) + across * across);
        // The power of the place halved: curvature / 2 off^2 + off.
        let power = distance + along + curvature * moved;
        let root = (1.0 + 2.0 * curvature * power).max(0.0).sqrt();
        let off = 2.0 * power / (1.0 + root);
        let slopes = [
            moved - 0.5 * off * off,
            reach * across,
            1.0 + curvature * (along + distance),
        ];
        (off, slopes.map(|slope| slope / root))
    }

    fn worst(&self, places: &[C]) -> f64 {
        places.iter().fold(0.0, |m, p| m.max(self.off(*p).0.abs()))
    }

    fn moved(&self, by: [f64; 3], part: f64) -> Self {
        Self {
            curvature: self.curvature + part * by[0],
            angle: self.angle + part * by[1],
            distance: self.distance + part * by[2],
        }
    }
}

/// The circle that is nearest to an arc.
///
/// It is found by steps, each the exact minimax of the distances made linear, from circles through three places each and from a line; the nearest that
/// these lead to counts. Of all circles near by none has a smaller greatest distance to the four places that are `touched`, let alone to all; of an arc
/// that is near to no circle another one far away may.
///
/// `None` for fewer than four places, places that are not finite or all one, and arcs that are nearer to a line.
pub fn nearest_circle(places: &[C]) -> Option<NearestCircle> {
    if places.len() < 4 {
        return None;
    }
    let (middle, size, own) = scaled(places)?;
    let at = |part: f64| own[(part * (own.len() - 1) as f64).round() as usize];
    let farthest = |from: C| {
        let all = own.iter().copied();
        all.max_by(|a, b| (*a - from).norm().total_cmp(&(*b - from).norm()))
    };
    let (one, other) = (own[0], farthest(own[0])?);
    let aside = |p: &C| ((*p - one) * (other - one).conj()).im.abs();
    let third = own
        .iter()
        .copied()
        .max_by(|a, b| aside(a).total_cmp(&aside(b)))?;
    let starts = [
        Curve::through(at(0.067), at(0.5), at(0.933)),
        Curve::through(one, third, other),
        Curve::line(one, other),
    ];
    let settled = starts
        .into_iter()
        .flatten()
        .filter_map(|it| settled(it, &own));
    let (worst, curve, mut touched) = settled.min_by(|a, b| a.0.total_cmp(&b.0))?;
    if !(curve.curvature.abs() * FLATTEST > 1.0) {
        return None;
    }
    touched.sort_unstable();
    let reach = (1.0 + curve.curvature * curve.distance) / curve.curvature;
    Some(NearestCircle {
        centre: middle - C::from_polar(1.0, curve.angle).scale(reach * size),
        radius: size / curve.curvature.abs(),
        deviation: worst * size,
        touched,
    })
}

/// The nearest curve to places that is found from one on: its greatest distance, and the four places that are that far away.
fn settled(start: Curve, places: &[C]) -> Option<(f64, Curve, [usize; 4])> {
    let (mut worst, mut curve) = (start.worst(places), start);
    let last = places.len() - 1;
    let mut touched = [0, last / 4, last - last / 4, last];
    for _ in 0..STEPS {
        let rows: Vec<(f64, [f64; 3])> = places.iter().map(|p| curve.off(*p)).collect();
        let step = minimax(&rows, &mut touched)?;
        // What is linear need not be so far away.
        let parts = std::iter::successors(Some(1.0), |part| Some(0.5 * part)).take(HALVINGS);
        let tried = parts.map(|part| curve.moved(step, part));
        let mut tried = tried.map(|it| (it.worst(places), it));
        let Some((error, next)) = tried.find(|(error, _)| *error < worst) else {
            break;
        };
        (worst, curve) = (error, next);
        if step.iter().fold(0.0_f64, |m, x| m.max(x.abs())) < SETTLED {
            break;
        }
    }
    worst.is_finite().then_some((worst, curve, touched))
}

/// The line that is nearest to an arc: midway in the narrowest strip that holds its places.
///
/// `None` for fewer than three places, and places that are not finite or all one.
pub fn nearest_line(places: &[C]) -> Option<NearestLine> {
    if places.len() < 3 {
        return None;
    }
    let (middle, size, own) = scaled(places)?;
    let hull = hull(&own);
    let edges = (0..hull.len()).map(|k| (hull[k], hull[(k + 1) % hull.len()]));
    let strips = edges.filter_map(|(a, b)| {
        let along = own[b] - own[a];
        let length = along.norm();
        let across = |k: &usize| ((own[*k] - own[a]) * along.conj()).im / length;
        let widths = hull.iter().map(|k| (across(k), *k));
        let (width, far) = widths.max_by(|x, y| x.0.abs().total_cmp(&y.0.abs()))?;
        (length > 0.0).then(|| (width, [a, b, far], along.scale(1.0 / length)))
    });
    let (width, touched, along) = strips.min_by(|x, y| x.0.abs().total_cmp(&y.0.abs()))?;
    let onwards = own[own.len() - 1] - own[0];
    let sense = if (onwards * along.conj()).re < 0.0 {
        -1.0
    } else {
        1.0
    };
    let midway = own[touched[0]] + C::i() * along.scale(0.5 * width);
    Some(NearestLine {
        point: middle + midway.scale(size),
        direction: along.scale(sense),
        deviation: 0.5 * width.abs() * size,
        touched,
    })
}

/// The place in the middle of an arc, the arc's size, and the places from there in that unit.
fn scaled(places: &[C]) -> Option<(C, f64, Vec<C>)> {
    let middle = *places.get(places.len() / 2)?;
    let far = places.iter().map(|p| (*p - middle).norm());
    let size = far.fold(0.0_f64, f64::max);
    let finite = places.iter().all(|p| p.re.is_finite() && p.im.is_finite());
    let own = places.iter().map(|p| (*p - middle).scale(1.0 / size));
    (finite && size > 0.0 && size.is_finite()).then(|| (middle, size, own.collect()))
}

/// The corners of the convex hull by their indices, counter-clockwise (Andrew's chains).
fn hull(places: &[C]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..places.len()).collect();
    order.sort_by(|a, b| {
        let (a, b) = (places[*a], places[*b]);
        a.re.total_cmp(&b.re).then(a.im.total_cmp(&b.im))
    });
    let chain = |order: &mut dyn Iterator<Item = &usize>| {
        let mut chain: Vec<usize> = Vec::new();
        for next in order {
            while let [.., a, b] = chain.as_slice() {
                let (first, second) = (places[*b] - places[*a], places[*next] - places[*b]);
                if (first.conj() * second).im > 0.0 {
                    break;
                }
                chain.pop();
            }
            chain.push(*next);
        }
        chain.pop();
        chain
    };
    let mut below = chain(&mut order.iter());
    below.extend(chain(&mut order.iter().rev()));
    below
}
