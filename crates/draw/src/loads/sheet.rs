//! All loads of a motion laid out: their scale, who is who from pose to pose, where labels stand, the legend.

use super::arrow::{HEAD, RIM, TURN, moment_radius};
use super::label::{self, Box2};
use super::legend::Legend;
use super::track::Track;
use super::{LoadRole, LoadView, Quantity, Shape};
use crate::context::{Context, complete};
use crate::fit::{Bounds, Fit, drawable};
use crate::scene::{Group, Item, Layer, Placement, Point};
use crate::symbols::Part;
use crate::text::shortened;
use crate::tokens::Token;
use crate::view::{Frame, MechanismView};

/// Lengths of the largest force as shares of the shorter side of the sheet: the first that leaves the mechanism
/// [`LEAST_SCALE`], or the last.
pub(crate) const SHARES: [f64; 4] = [0.2, 0.16, 0.13, 0.1];
/// The scale that arrows leave a mechanism at least, in parts of that without arrows.
pub(crate) const LEAST_SCALE: f64 = 0.5;
/// Poses looked at to place labels.
const SAMPLES: usize = 16;
/// With more loads than this, labels stand beyond the tips without a search.
const SEARCHED: usize = 60;

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
    /// The side of each track's label.
    pub sides: Vec<usize>,
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
        // a pose that was not reached has no loads either: nothing to tell
        let reached = frames.iter().filter(|f| complete(view, f));
        let broken =
            |l: &&LoadView| !(drawable(l.at) && force_is_finite(l) && l.moment.is_finite());
        let not_finite = reached.flat_map(|f| &f.loads).filter(broken).count();
        let sides = vec![0; tracks.len()];
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
            sides,
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
    fn reach(&self, track: &Track, load: &LoadView) -> Option<Box2> {
        let mut bounds = Bounds::EMPTY;
        let shapes = self.shapes(load, [0.0; 2]);
        for shape in shapes.iter().flatten() {
            match *shape {
                Shape::Force { .. } => bounds.add(shape.tip().0, 0.0),
                Shape::Moment { center, radius, .. } => bounds.add(center, radius),
            }
        }
        if let (Some(shape), false) = (shapes.iter().flatten().next(), track.label.is_empty()) {
            let [low, high] = label::room(&track.label, shape, 0);
            bounds.add(low, 0.0);
            bounds.add(high, 0.0);
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
        let reach = |track: &Track| -> Vec<(Point, Box2)> {
            let of = |row: &usize| {
                let load = track.load(frames, *row).filter(|l| drawable(l.at))?;
                Some((load.at, self.reach(track, load)?))
            };
            track.rows.keys().filter_map(of).collect()
        };
        let all: Vec<(Point, Box2)> = self.tracks.iter().flat_map(reach).collect();
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

    /// Chooses a side for each label on which it crosses least over the motion.
    pub fn place_labels(&mut self, context: &Context, parts: &[Part]) {
        if self.tracks.len() > SEARCHED {
            return;
        }
        let frames = context.frames;
        let step = frames.len().div_ceil(SAMPLES).max(1);
        let rows: Vec<usize> = (0..frames.len()).step_by(step).collect();
        let mut taken: Vec<Vec<Box2>> = rows.iter().map(|_| Vec::new()).collect();
        for (names, &row) in taken.iter_mut().zip(&rows) {
            names.extend(
                parts
                    .iter()
                    .filter_map(|p| name_room(context, &frames[row], p)),
            );
        }
        for number in 0..self.tracks.len() {
            let track = &self.tracks[number];
            if track.label.is_empty() {
                continue;
            }
            let room = |row: usize, side: usize| {
                let shape = self.first_shape(context, track, row)?;
                Some(label::room(&track.label, &shape, side))
            };
            let cost = |side: usize| -> f64 {
                let at = |(names, &row): (&Vec<Box2>, &usize)| {
                    let Some(room) = room(row, side) else {
                        return 0.0;
                    };
                    let over = names.iter().map(|b| label::overlap(&room, b)).sum::<f64>();
                    over + self.crossed(context, &room, row)
                };
                taken.iter().zip(&rows).map(at).sum::<f64>() + 0.2 * side as f64
            };
            let mut best = (f64::INFINITY, 0);
            for side in 0..label::SIDES.len() {
                let c = cost(side);
                if c < best.0 {
                    best = (c, side);
                }
            }
            let rooms: Vec<_> = rows.iter().map(|&row| room(row, best.1)).collect();
            taken
                .iter_mut()
                .zip(rooms)
                .for_each(|(names, room)| names.extend(room));
            self.sides[number] = best.1;
        }
    }

    fn first_shape(&self, context: &Context, track: &Track, row: usize) -> Option<Shape> {
        let load = track.load(context.frames, row)?;
        let at = context.fit.paper(load.at)?;
        self.shapes(load, at).into_iter().flatten().next()
    }

    /// How much of the arrows of a pose runs through a box, mm.
    fn crossed(&self, context: &Context, room: &Box2, row: usize) -> f64 {
        let arrow = |track: &Track| match self.first_shape(context, track, row) {
            Some(Shape::Force { tail, vector, .. }) => {
                label::crossing(room, tail, [tail[0] + vector[0], tail[1] + vector[1]])
            }
            _ => 0.0,
        };
        self.tracks.iter().map(arrow).sum()
    }

    /// The loads of a pose.
    pub fn groups(&self, context: &Context, row: usize) -> Vec<Group> {
        let mut groups = Vec::new();
        for (track, &side) in self.tracks.iter().zip(&self.sides) {
            let at = track
                .load(context.frames, row)
                .and_then(|load| Some((load, context.fit.paper(load.at)?)));
            let Some((load, at)) = at else { continue };
            let shapes = self.shapes(load, at);
            let items: Vec<Item> = shapes
                .iter()
                .flatten()
                .flat_map(|shape| shape.items(track.role))
                .collect();
            groups.push(Group::new(Layer::Load(track.role), items));
            if let (Some(shape), false) = (shapes.iter().flatten().next(), track.label.is_empty()) {
                let text = label::text(&track.label, shape, side).colored(Token::Load(track.role));
                groups.push(Group::new(
                    Layer::LoadLabel(track.role),
                    vec![Item::Text(text)],
                ));
            }
        }
        groups
    }
}

fn force(load: &LoadView) -> f64 {
    kempe_number::math::hypot(load.vector[0], load.vector[1])
}

fn force_is_finite(load: &LoadView) -> bool {
    force(load).is_finite()
}

/// The room of a point's name in a pose.
fn name_room(context: &Context, frame: &Frame, part: &Part) -> Option<Box2> {
    let (Layer::Label, [Item::Text(text)]) = (part.layer, part.items.as_slice()) else {
        return None;
    };
    let Placement { at, .. } = context.place(frame, part.anchor)?;
    let (x, y) = (at[0] + text.at[0], at[1] + text.at[1]);
    let half = crate::text::width(&text.content, text.size) / 2.0;
    Some([[x - half, y], [x + half, y + 0.8 * text.size]])
}
