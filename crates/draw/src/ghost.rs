//! Another design over a drawn one: its links, gears and pins as thin dashed outlines, the paths of its points dashed.

use crate::context::{Anchor, Context, reference_frame};
use crate::fit::Fit;
use crate::roles::Roles;
use crate::scene::{Group, Item, Layer};
use crate::symbols::{self, Part};
use crate::trace::TracePath;
use crate::view::{Frame, MechanismView};

/// A design that is shown as an outline over another one, pose by pose.
#[derive(Clone, Copy, Debug)]
pub struct Outline<'a> {
    /// What it is called.
    pub name: &'a str,
    /// The mechanism.
    pub view: &'a MechanismView,
    /// Its pose at each pose of the drawn design; one without points where it has none.
    pub frames: &'a [Frame],
}

/// The other design, laid out on the same paper.
pub(crate) struct Ghost<'a> {
    pub name: &'a str,
    pub context: Context<'a>,
    pub parts: Vec<Part>,
    traces: Vec<TracePath>,
}

impl<'a> Ghost<'a> {
    pub fn new(other: Outline<'a>, fit: Fit, traces: bool) -> Ghost<'a> {
        let context = Context {
            view: other.view,
            frames: other.frames,
            fit,
            roles: Roles::new(other.view),
            reference: reference_frame(other.view, other.frames),
        };
        let solid = |part: &Part| {
            matches!(
                part.layer,
                Layer::Link(_) | Layer::Gear | Layer::Body | Layer::Joint
            )
        };
        let outlined = |part: Part| Part {
            layer: Layer::Other,
            items: part.items.iter().map(symbols::outlined_item).collect(),
            ..part
        };
        let parts = symbols::parts(&context).into_iter();
        let parts = parts.filter(solid).map(outlined).collect();
        let traces = match traces {
            true => TracePath::all(&context),
            false => Vec::new(),
        };
        Ghost {
            name: other.name,
            context,
            parts,
            traces,
        }
    }

    /// The pose of a row, each group with the number of its part as key, and the paths of the points.
    pub fn groups(&self, index: usize) -> Vec<Group> {
        let empty = Frame::default();
        let frame = self.context.frames.get(index).unwrap_or(&empty);
        let pose = self.parts.iter().enumerate().filter_map(|(number, part)| {
            Some(Group {
                layer: part.layer,
                key: Some(number.to_string()),
                place: self.context.place(frame, part.anchor)?,
                items: part.items.clone(),
            })
        });
        let path = |trace: &TracePath| {
            let style = symbols::outline_style();
            let paths = trace.paths(usize::MAX);
            (!paths.is_empty())
                .then(|| Group::new(Layer::OtherTrace, vec![Item::Shape { paths, style }]))
        };
        let traces = self.traces.iter().filter_map(path);
        traces.chain(pose).collect()
    }

    /// How each part is anchored, in the order of the keys of the groups.
    pub fn anchors(&self) -> Vec<Anchor> {
        self.parts.iter().map(|part| part.anchor).collect()
    }
}
