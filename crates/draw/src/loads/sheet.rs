//! All loads of a motion laid out: their scale, who is who from pose to pose, where labels stand, the legend.

use super::arrow::{HEAD, RIM, TURN, moment_radius};
use super::label::{self, STANCES, Stance};
use super::legend::Legend;
use super::track::Track;
use super::{LoadRole, LoadView, Quantity, Shape};
use crate::context::{Context, complete};
use crate::fit::{Bounds, Fit, drawable};
use crate::labels::{Spot, Wanted, Words, leader};
use crate::scene::{Group, Item, Layer, Point};
use crate::text::shortened;
use crate::tokens::Token;
use crate::view::{Frame, MechanismView};

/// Lengths of the largest force as shares of the shorter side of the sheet: the first that leaves the mechanism
/// [`LEAST_SCALE`], or the last.
pub(crate) const SHARES: [f64; 4] = [0.2, 0.16, 0.13, 0.1];
/// The scale that arrows leave a mechanism at least, in parts of that without arrows.
pub(crate) const LEAST_SCALE: f64 = 0.5;

/// Moments that stay below this part of a force at full size times how far apart forces act are none.
const NO_MOMENT: f64 = 1e-7;

/// How far apart loads act, m.
fn extent(frames: &[Frame]) -> f64 {
    let mut ends = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    let all = frames.iter().flat_map(|f| &f.loads);
    for at in all.map(|l| l.at).filter(|at| drawable(*at)) {
        for k in 0..2 {
            ends[0][k] = ends[0][k].min(at[k]);
            ends[1][k] = ends[1][k].max(at[k]);
        }
    }
    (0..2).map(|k| ends[1][k] - ends[0][k]).fold(0.0, f64::max)
}

/// A box on paper: lower left and upper right corner.
type Box2 = [Point; 2];

/// The loads of a motion on paper.
pub(crate) struct LoadSheet {
    /// Scale of the forces.
    pub force: Option<Quantity>,
    /// Scale of the moments.
    pub moment: Option<Quantity>,
    /// Length of a force at full size, mm.
    pub length: f64,
    /// Roles that occur.
    pub roles: Vec<LoadRole>,
    /// Loads through the motion.
    pub tracks: Vec<Track>,
    /// Each track's label.
    pub words: Vec<Words>,
    /// How each track's label stands over the motion.
    pub stances: Vec<Stance>,
    /// What the arrows mean.
    pub legend: Legend,
}

impl LoadSheet {
    /// The loads of the poses, the largest force as long as `share` of the sheet's shorter side; `None` when there are
    /// none.
    pub fn new(
        view: &MechanismView,
        frames: &[Frame],
        sheet: [f64; 2],
        labels: bool,
        share: f64,
    ) -> Option<LoadSheet> {
        let mut tracks = Track::all(frames);
        for track in &mut tracks {
            track.label = shortened(&track.label, label::SIZE, label::LONGEST);
            if !labels {
                track.label.clear();
            }
        }
        let role = |r: &LoadRole| tracks.iter().any(|t| t.role == *r);
        let roles: Vec<LoadRole> = LoadRole::ALL.into_iter().filter(role).collect();
        if roles.is_empty() {
            return None;
        }
        let length = share * sheet[0].min(sheet[1]);
        let over = |size: fn(&LoadView) -> f64, least| {
            let pose = |f: &Frame| {
                f.loads
                    .iter()
                    .filter(|l| drawable(l.at))
                    .map(size)
                    .collect()
            };
            Quantity::over(frames.iter().map(pose), least)
        };
        let force = over(force, 1.2 * HEAD / length);
        let moment = over(|l| l.moment.abs(), HEAD / moment_radius(roles[0]) / TURN);
        // What is no moment at all beside the forces is rounding: arcs of it would be as large as any.
        let arm = extent(frames);
        let counts = |moment: &Quantity| {
            let by_forces = force.as_ref().map_or(0.0, |force| force.full * arm);
            moment.largest > NO_MOMENT * by_forces
        };
        let moment = moment.filter(counts);
        // a pose that was not reached has no loads either: nothing to tell
        let reached = frames.iter().filter(|f| complete(view, f));
        let broken =
            |l: &&LoadView| !(drawable(l.at) && force_is_finite(l) && l.moment.is_finite());
        let not_finite = reached.flat_map(|f| &f.loads).filter(broken).count();
        let words = tracks
            .iter()
            .map(|t| Words::new(t.label.clone(), label::SIZE));
        let words: Vec<Words> = words.collect();
        let stances = vec![STANCES[0]; tracks.len()];
        let legend = Legend::new(
            (&force, &view.load_units.force),
            (&moment, &view.load_units.moment),
            length,
            &roles,
            labels,
            not_finite,
            sheet[0],
        );
        Some(LoadSheet {
            force,
            moment,
            length,
            roles,
            tracks,
            words,
            stances,
            legend,
        })
    }

    /// A load on paper, its point given there: the force, and the moment.
    pub fn shapes(&self, load: &LoadView, at: Point) -> [Option<Shape>; 2] {
        let push = || {
            let size = force(load);
            let (share, broken) = self.force.as_ref()?.share(size)?;
            let along = [load.vector[0] / size, load.vector[1] / size];
            let long = share * self.length;
            Some(Shape::Force {
                tail: [at[0] + RIM * along[0], at[1] + RIM * along[1]],
                vector: [long * along[0], long * along[1]],
                broken,
            })
        };
        let turn = || {
            let (share, broken) = self.moment.as_ref()?.share(load.moment.abs())?;
            Some(Shape::Moment {
                center: at,
                radius: moment_radius(load.role),
                sweep: share * TURN * load.moment.signum(),
                broken,
            })
        };
        [push(), turn()]
    }

    /// What the loads of a pose take up on paper, from their points: lower left and upper right corner.
    fn reach(&self, words: &Words, load: &LoadView) -> Option<Box2> {
        let mut bounds = Bounds::EMPTY;
        let shapes = self.shapes(load, [0.0; 2]);
        for shape in shapes.iter().flatten() {
            match *shape {
                Shape::Force { .. } => bounds.add(shape.tip().0, 0.0),
                Shape::Moment { center, radius, .. } => bounds.add(center, radius),
            }
        }
        if let (Some(shape), false) = (shapes.iter().flatten().next(), words.content.is_empty()) {
            let room = label::room(words, shape, &STANCES[0]);
            for sign in [-1.0, 1.0] {
                let corner = |k: usize| room.middle[k] + sign * room.half[k];
                bounds.add([corner(0), corner(1)], 0.0);
            }
        }
        (!bounds.is_empty()).then_some([bounds.low, bounds.high])
    }

    /// The largest scale, up to that of `plain`, at which the mechanism and its arrows lie on the sheet.
    pub fn fit(
        &self,
        frames: &[Frame],
        poses: Bounds,
        plain: Fit,
        again: impl Fn(Bounds) -> Fit,
    ) -> Fit {
        let reach = |(track, words): (&Track, &Words)| -> Vec<(Point, Box2)> {
            let of = |row: &usize| {
                let load = track.load(frames, *row).filter(|l| drawable(l.at))?;
                Some((load.at, self.reach(words, load)?))
            };
            track.rows.keys().filter_map(of).collect()
        };
        let tracks = self.tracks.iter().zip(&self.words);
        let all: Vec<(Point, Box2)> = tracks.flat_map(reach).collect();
        let mut fit = plain;
        // arrows keep their size on paper: the scale that makes room for them is the limit of this series
        for _ in 0..12 {
            let mut bounds = poses;
            for (at, corners) in &all {
                for corner in corners {
                    let on = |k: usize| at[k] + corner[k] / fit.scale;
                    bounds.add([on(0), on(1)], 0.0);
                }
            }
            let mut next = again(bounds);
            next.scale = next.scale.min(plain.scale);
            fit = next;
        }
        fit
    }

    /// The labels with their arrows in some poses, as they may stand over the whole motion: one for each track, each in at
    /// most so many ways.
    pub fn steady_labels(&self, context: &Context, rows: &[usize], most: usize) -> Vec<Wanted> {
        let wanted = |(track, words): (&Track, &Words)| {
            let shape = |row: &usize| self.first_shape(context, track, *row);
            let shapes: Vec<Option<Shape>> = rows.iter().map(shape).collect();
            let named = !words.content.is_empty();
            Wanted {
                choices: match named && shapes.iter().any(Option::is_some) {
                    true => label::steady(words, &shapes).take(most).collect(),
                    false => Vec::new(),
                },
                optional: false,
            }
        };
        self.tracks.iter().zip(&self.words).map(wanted).collect()
    }

    /// The labels in one pose: the number of their track, and where they may stand, each in at most so many ways.
    pub fn free_labels(&self, context: &Context, row: usize, most: usize) -> Vec<(usize, Wanted)> {
        let tracks = self.tracks.iter().zip(&self.words).enumerate();
        let wanted = tracks.filter_map(|(number, (track, words))| {
            let shape = self.first_shape(context, track, row)?;
            let wanted = Wanted {
                choices: label::free(words, &shape, most),
                optional: false,
            };
            (!words.content.is_empty()).then_some((number, wanted))
        });
        wanted.collect()
    }

    /// A label at a place.
    pub fn label(&self, number: usize, spot: &Spot) -> Option<Group> {
        let (track, words) = (self.tracks.get(number)?, self.words.get(number)?);
        let token = Token::Load(track.role);
        let mut items: Vec<Item> = spot.lines.iter().map(|l| leader(*l, token)).collect();
        items.push(Item::Text(words.text(&spot.room).colored(token)));
        Some(Group::new(Layer::LoadLabel(track.role), items))
    }

    /// The labels of a pose where they stand over the whole motion.
    pub fn labels(&self, context: &Context, row: usize) -> Vec<Group> {
        let tracks = self.tracks.iter().zip(&self.words).enumerate();
        let group = |(number, (track, words)): (usize, (&Track, &Words))| {
            let shape = self.first_shape(context, track, row)?;
            if words.content.is_empty() {
                return None;
            }
            let room = label::room(words, &shape, &self.stances[number]);
            let lines = Vec::new();
            self.label(number, &Spot { room, lines })
        };
        tracks.filter_map(group).collect()
    }

    fn first_shape(&self, context: &Context, track: &Track, row: usize) -> Option<Shape> {
        let load = track.load(context.frames, row)?;
        let at = context.fit.paper(load.at)?;
        self.shapes(load, at).into_iter().flatten().next()
    }

    /// The loads of a pose.
    pub fn groups(&self, context: &Context, row: usize) -> Vec<Group> {
        let group = |track: &Track| {
            let load = track.load(context.frames, row)?;
            let at = context.fit.paper(load.at)?;
            let shapes = self.shapes(load, at);
            let items = shapes.iter().flatten();
            let items = items.flat_map(|shape| shape.items(track.role)).collect();
            Some(Group::new(Layer::Load(track.role), items))
        };
        self.tracks.iter().filter_map(group).collect()
    }
}

fn force(load: &LoadView) -> f64 {
    kempe_number::math::hypot(load.vector[0], load.vector[1])
}

fn force_is_finite(load: &LoadView) -> bool {
    force(load).is_finite()
}
