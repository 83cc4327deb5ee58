//! Labels and dimensions of a mechanism's drawing: put for one picture, or labels for a whole motion.

use crate::dimensions::Dimension;
use crate::labels::{Choice, Named, Spot, Surroundings, Wanted, most_choices, place};
use crate::loads::STANCES;
use crate::scene::{Group, Layer};
use crate::stage::Stage;
use crate::symbols::Part;

/// Poses looked at to place labels for a whole motion.
const SAMPLES: usize = 8;

impl Stage<'_> {
    fn most_choices(&self) -> usize {
        let arrows = self.loads.as_ref().map_or(0, |l| l.tracks.len());
        most_choices(self.names.len() + arrows + self.context.view.dimensions.len())
    }

    /// Gives the labels places that they keep over the motion: names become parts of the drawing.
    pub(crate) fn settle_labels(&mut self) {
        let poses = self.context.frames.len();
        let step = poses.div_ceil(SAMPLES).max(1);
        let rows: Vec<usize> = (0..poses).step_by(step).collect();
        let around: Vec<Surroundings> = rows
            .iter()
            .map(|&row| Surroundings::new(self.size(), &self.bare(row)))
            .collect();
        let most = self.most_choices();
        let name = |named: &Named| {
            let at = |&row: &usize| self.context.paper(&self.context.frames[row], named.index);
            named.wanted(&rows.iter().map(at).collect::<Vec<_>>(), most)
        };
        let mut wanted: Vec<Wanted> = self.names.iter().map(name).collect();
        if let Some(loads) = &self.loads {
            wanted.extend(loads.steady_labels(&self.context, &rows, most));
        }
        let chosen = place(&wanted, &around);
        let (names, arrows) = chosen.split_at(self.names.len());
        for (named, choice) in self.names.iter().zip(names) {
            if let Some((anchor, items)) = choice.and_then(|choice| named.items(choice)) {
                self.parts.push(Part::new(Layer::Label, anchor, items));
            }
        }
        if let Some(loads) = &mut self.loads {
            for (stance, choice) in loads.stances.iter_mut().zip(arrows) {
                *stance = choice.map_or(STANCES[0], |choice| STANCES[choice]);
            }
        }
    }

    /// The labels of a picture without them.
    pub(crate) fn labels(&self, index: usize, bare: &[Group]) -> Vec<Group> {
        if self.options.steady {
            let loads = self.loads.as_ref();
            return loads.map_or_else(Vec::new, |l| l.labels(&self.context, index));
        }
        let Some(frame) = self.context.frames.get(index) else {
            return Vec::new();
        };
        let around = Surroundings::new(self.size(), bare);
        let most = self.most_choices();
        let shown = self.names.iter().filter_map(|named| {
            let at = self.context.paper(frame, named.index)?;
            Some((named, named.wanted(&[Some(at)], most)))
        });
        let (named, names): (Vec<&Named>, Vec<Wanted>) = shown.unzip();
        let arrows = match &self.loads {
            Some(loads) => loads.free_labels(&self.context, index, most),
            None => Vec::new(),
        };
        let (tracks, arrows): (Vec<_>, Vec<_>) = arrows.into_iter().unzip();
        let sizes = Dimension::all(&self.context, frame);
        let mut wanted = names;
        wanted.extend(arrows);
        let labels = wanted.len();
        wanted.extend(sizes.iter().map(|size| size.wanted(most)));
        let chosen = place(&wanted, &[around]);
        let spots: Vec<Option<&Spot>> = wanted
            .iter()
            .zip(&chosen)
            .map(|(wanted, choice)| spot(&wanted.choices, *choice))
            .collect();
        let (of_names, of_arrows) = spots[..labels].split_at(named.len());
        let mut groups = Vec::new();
        for (named, spot) in named.iter().zip(of_names) {
            groups.extend(spot.map(|spot| Group::new(Layer::Label, named.drawn(spot))));
        }
        for (track, spot) in tracks.iter().zip(of_arrows) {
            let loads = self.loads.as_ref();
            groups.extend(loads.zip(*spot).and_then(|(l, spot)| l.label(*track, spot)));
        }
        let sizes = sizes.iter().zip(&chosen[labels..]);
        let drawn = sizes.filter_map(|(size, choice)| size.drawn((*choice)?));
        groups.extend(drawn.map(|items| Group::new(Layer::Dimension, items)));
        groups
    }
}

/// Where a label stands in the only pose.
fn spot(choices: &[Choice], chosen: Option<usize>) -> Option<&Spot> {
    choices.get(chosen?)?.spots.first()?.as_ref()
}
