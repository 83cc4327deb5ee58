//! The picture of one pose: the mechanism, what acts on it, and the furniture of the sheet.

use crate::furniture;
use crate::scene::{Group, Scene};
use crate::stage::Stage;

impl Stage<'_> {
    /// The picture of one pose without the labels that are put for it alone.
    pub(crate) fn bare(&self, index: usize) -> Vec<Group> {
        let frame = self.context.frames.get(index);
        let mut groups = Vec::new();
        for &ghost in &self.options.ghosts {
            groups.extend(self.ghost(ghost));
        }
        for trace in &self.traces {
            groups.extend(trace.groups(index));
        }
        if let Some(frame) = frame {
            groups.extend(self.pose(frame));
        }
        if let Some(other) = &self.other {
            groups.extend(other.groups(index));
        }
        groups.extend(furniture::groups(self, frame));
        if let Some(loads) = &self.loads {
            groups.extend(loads.groups(&self.context, index));
            let furniture = self.options.scale_bar || self.options.caption;
            groups.push(loads.legend.group(if furniture { 9.5 } else { 2.0 }));
        }
        groups
    }

    /// The picture of one pose. Past the last pose, or where a pose cannot be drawn, it shows what there is.
    pub fn scene(&self, index: usize) -> Scene {
        let frame = self.context.frames.get(index);
        let mut groups = self.bare(index);
        groups.extend(self.labels(index, &groups));
        groups.sort_by_key(|group| group.layer);
        let [width, height] = self.size();
        let mut title = self.context.view.title.clone();
        if let Some(label) = frame.map(|f| f.label.as_str()).filter(|l| !l.is_empty()) {
            title = format!("{title}: {label}");
        }
        if let Some(other) = &self.other {
            title = format!("{title}; dashed: {}", other.name);
        }
        Scene {
            width,
            height,
            title,
            groups,
        }
    }
}
