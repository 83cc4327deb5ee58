//! A mechanism with all its poses, laid out on one sheet: the box over all poses, so that an animation does not jump.

use kempe_number::math::sin_cos;

use crate::context::{Anchor, Context, point, reference_frame};
use crate::fit::{Bounds, Fit, Margins};
use crate::ghost::{Ghost, Outline};
use crate::labels::{self, Named};
use crate::loads::{LEAST_SCALE, LoadSheet, SHARES};
use crate::roles::Roles;
use crate::scene::{Group, Layer, Point};
use crate::symbols::{self, Part};
use crate::trace::TracePath;
use crate::view::{Frame, JointView, MechanismView};

/// How a mechanism is laid out.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawOptions {
    /// Width of the picture, mm.
    pub width: f64,
    /// Largest height of the picture, mm; it is lower for a flat mechanism.
    pub max_height: f64,
    /// Title above the drawing.
    pub title: bool,
    /// The pose's own label below the drawing.
    pub caption: bool,
    /// Names of the points.
    pub labels: bool,
    /// Paths of the traced points.
    pub traces: bool,
    /// A bar of known length.
    pub scale_bar: bool,
    /// Other poses to show faintly, by index.
    pub ghosts: Vec<usize>,
    /// Names keep their places over the motion, as in an animation; otherwise each picture has those that are best for it.
    pub steady: bool,
    /// Model coordinates (m) that must be on the sheet: lower left and upper right corner; all poses when `None`.
    pub view_box: Option<[[f64; 2]; 2]>,
}

impl Default for DrawOptions {
    /// A sheet 160 mm wide with everything but ghosts: it fills a text page at full width.
    fn default() -> Self {
        DrawOptions {
            width: 160.0,
            max_height: 130.0,
            title: true,
            caption: true,
            labels: true,
            traces: true,
            scale_bar: true,
            ghosts: Vec::new(),
            steady: false,
            view_box: None,
        }
    }
}

/// A mechanism laid out on paper, ready to be drawn at any of its poses.
pub struct Stage<'a> {
    pub(crate) context: Context<'a>,
    pub(crate) options: DrawOptions,
    pub(crate) parts: Vec<Part>,
    pub(crate) names: Vec<Named>,
    pub(crate) traces: Vec<TracePath>,
    pub(crate) loads: Option<LoadSheet>,
    pub(crate) other: Option<Ghost<'a>>,
}

/// Room around the mechanism for the paper-sized symbols, mm.
const SYMBOL_ROOM: f64 = 9.0;
/// The same with dimensions, mm.
const DIMENSION_ROOM: f64 = 21.0;
/// The lowest sheet, mm.
const LEAST_HEIGHT: f64 = 40.0;

impl<'a> Stage<'a> {
    /// Lays the mechanism out. Poses may be missing or not finite; what cannot be drawn is left out.
    pub fn new(view: &'a MechanismView, frames: &'a [Frame], options: DrawOptions) -> Stage<'a> {
        Stage::with_outline(view, frames, None, options)
    }

    /// Lays the mechanism out with another design over it, both at one scale.
    pub fn with_outline(
        view: &'a MechanismView,
        frames: &'a [Frame],
        other: Option<Outline<'a>>,
        options: DrawOptions,
    ) -> Stage<'a> {
        let options = DrawOptions {
            width: if options.width.is_finite() {
                options.width.clamp(20.0, 5000.0)
            } else {
                160.0
            },
            max_height: if options.max_height.is_finite() {
                options.max_height.clamp(20.0, 5000.0)
            } else {
                130.0
            },
            ..options
        };
        let roles = Roles::new(view);
        let mut bounds = Bounds::EMPTY;
        match options.view_box {
            Some(corners) => corners.iter().for_each(|&p| bounds.add(p, 0.0)),
            None => {
                add_all(&mut bounds, view, &roles, frames);
                if let Some(other) = &other {
                    add_all(
                        &mut bounds,
                        other.view,
                        &Roles::new(other.view),
                        other.frames,
                    );
                }
            }
        }
        let room = match view.dimensions.is_empty() || options.steady {
            true => SYMBOL_ROOM,
            false => DIMENSION_ROOM,
        };
        let top = match (options.title, &other) {
            (true, Some(_)) => 15.0,
            (true, None) => 10.0,
            (false, _) => 0.0,
        };
        let bottom = if options.scale_bar || options.caption {
            9.0
        } else {
            0.0
        };
        let sheet = [options.width, options.max_height];
        let fitted = |legend: f64, bounds| {
            let margins = Margins {
                sides: [room, room, room + top, room + bottom + legend],
            };
            // the legend has a room of its own below the drawing
            let heights = [LEAST_HEIGHT + legend, options.max_height + legend];
            let unit = view.length_unit.size();
            Fit::new(bounds, options.width, heights, margins, unit)
        };
        let with_arrows = |share: f64| {
            let loads = LoadSheet::new(view, frames, sheet, options.labels, share);
            let legend = loads.as_ref().map_or(0.0, |l| l.legend.height());
            let plain = fitted(legend, bounds);
            let fit = match (&loads, options.view_box) {
                (Some(loads), None) => {
                    loads.fit(frames, bounds, plain, |bounds| fitted(legend, bounds))
                }
                _ => plain,
            };
            (loads, fit, fit.scale >= LEAST_SCALE * plain.scale)
        };
        let [first, shorter @ ..] = SHARES;
        let mut found = with_arrows(first);
        for share in shorter {
            if found.2 {
                break;
            }
            found = with_arrows(share);
        }
        let (loads, fit, _) = found;
        let context = Context {
            view,
            frames,
            fit,
            roles,
            reference: reference_frame(view, frames),
        };
        let parts = symbols::parts(&context);
        let names = match options.labels {
            true => labels::named(&context),
            false => Vec::new(),
        };
        let traces = if options.traces {
            TracePath::all(&context)
        } else {
            Vec::new()
        };
        let other = other.map(|other| Ghost::new(other, fit, options.traces));
        let mut stage = Stage {
            context,
            options,
            parts,
            names,
            traces,
            loads,
            other,
        };
        if stage.options.steady {
            stage.settle_labels();
        }
        stage
    }

    /// Number of poses.
    pub fn len(&self) -> usize {
        self.context.frames.len()
    }

    /// Whether there is no pose at all.
    pub fn is_empty(&self) -> bool {
        self.context.frames.is_empty()
    }

    /// Width and height of the sheet, mm.
    pub fn size(&self) -> [f64; 2] {
        [self.context.fit.width, self.context.fit.height]
    }

    /// Millimetres on paper per metre of the mechanism.
    pub fn scale(&self) -> f64 {
        self.context.fit.scale
    }

    /// The mechanism itself in a pose, each group with the number of its part as key.
    pub(crate) fn pose(&self, frame: &Frame) -> Vec<Group> {
        let group = |(number, part): (usize, &Part)| {
            let place = self.context.place(frame, part.anchor)?;
            Some(Group {
                layer: part.layer,
                key: Some(number.to_string()),
                place,
                items: part.items.clone(),
            })
        };
        self.parts.iter().enumerate().filter_map(group).collect()
    }

    pub(crate) fn ghost(&self, index: usize) -> Vec<Group> {
        let Some(frame) = self.context.frames.get(index) else {
            return Vec::new();
        };
        let solid = |part: &&Part| matches!(part.layer, Layer::Link(_) | Layer::Gear | Layer::Body);
        let group = |part: &Part| {
            let place = self.context.place(frame, part.anchor)?;
            let items = part.items.iter().map(symbols::ghost_item).collect();
            Some(Group {
                layer: Layer::Ghost,
                key: None,
                place,
                items,
            })
        };
        self.parts.iter().filter(solid).filter_map(group).collect()
    }

    /// For scripts that move the drawing: how each part is anchored, in the order of the keys of the groups.
    pub fn anchors(&self) -> Vec<Anchor> {
        self.parts.iter().map(|part| part.anchor).collect()
    }
}

/// All poses of a mechanism.
fn add_all(bounds: &mut Bounds, view: &MechanismView, roles: &Roles, frames: &[Frame]) {
    frames
        .iter()
        .for_each(|frame| add_frame(bounds, view, roles, frame));
    view.joints
        .iter()
        .for_each(|joint| add_rack(bounds, frames, joint));
}

fn add_frame(bounds: &mut Bounds, view: &MechanismView, roles: &Roles, frame: &Frame) {
    for index in 0..view.points.len() {
        if let (Some(p), false) = (point(frame, index), roles.point(index).only_guides()) {
            bounds.add(p, 0.0);
        }
    }
    for joint in &view.joints {
        match joint {
            JointView::Gears { a, b, .. } | JointView::Belt { a, b, .. } => {
                for wheel in [a, b] {
                    point(frame, wheel.center)
                        .into_iter()
                        .for_each(|p| bounds.add(p, wheel.radius.abs()));
                }
            }
            JointView::Rack { pinion, .. } => {
                point(frame, pinion.center)
                    .into_iter()
                    .for_each(|p| bounds.add(p, pinion.radius.abs()));
            }
            _ => {}
        }
    }
}

/// A rack is as long as its pinion's travel; both its ends belong on the sheet in every pose.
fn add_rack(bounds: &mut Bounds, frames: &[Frame], joint: &JointView) {
    let JointView::Rack { link, pinion, side } = joint else {
        return;
    };
    let placed = |frame: &Frame| Some((point(frame, pinion.center)?, *frame.links.get(*link)?));
    let along = |(p, l): (Point, [f64; 3])| {
        let (s, c) = sin_cos(l[2]);
        (p[0] - l[0]) * c + (p[1] - l[1]) * s
    };
    let travel: Vec<f64> = frames
        .iter()
        .filter_map(placed)
        .map(along)
        .filter(|s| s.is_finite())
        .collect();
    let low = travel.iter().copied().fold(f64::INFINITY, f64::min);
    let high = travel.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    for (p, l) in frames.iter().filter_map(placed) {
        let ((s, c), here, r) = (sin_cos(l[2]), along((p, l)), side * pinion.radius);
        for end in [low - here, high - here] {
            bounds.add([p[0] + r * s + end * c, p[1] - r * c + end * s], 0.0);
        }
    }
}
