//! The links that rest, in a model file beside the mechanism that moves them.

use std::f64::consts::TAU;

use kempe_model::Diagnostic;
use kempe_number::math;
use kempe_number::text::rounded;
use kempe_synthesis::{C, DwellLever, DwellSlider, DwellSlot, Stretch, golden};
use kempe_units::Dimension;

use super::asked::{Asked, Near, wrapped};
use crate::synthesis::beside::{Beside, Extended, key, text_value};
use crate::synthesis::file::Pen;
use crate::synthesis::own_linkage::Wanted;
use crate::synthesis::point_way::PointWay;

/// Places of a rest at which an output is looked at, and steps towards the one where it is furthest out.
const LOOKS: usize = 192;
const STEPS: usize = 40;

/// So many turns, or lengths of its parts, no output goes while the drive turns once, or goes through its range.
const FAR: f64 = 10.0;

/// What rests.
pub(super) enum Output {
    /// A lever, with its rod's length.
    Lever(DwellLever, f64),
    /// A slider, with its rod's end at rest and length.
    Slider(DwellSlider, C, f64),
    /// A slotted lever.
    Slot(DwellSlot),
}

impl Output {
    /// Where it is while the point is at a place: an angle, rad, or how far along its guide, m.
    fn at(&self, point: C) -> f64 {
        match self {
            Self::Lever(it, rod) => it.angle(point, *rod),
            Self::Slider(it, centre, rod) => it.place(point, *centre, *rod),
            Self::Slot(it) => (point - it.pivot).arg(),
        }
    }

    /// How far it goes in all.
    pub fn goes(&self) -> (f64, Dimension) {
        match self {
            Self::Lever(it, _) => (it.swing, Dimension::ANGLE),
            Self::Slider(it, ..) => (it.stroke, Dimension::LENGTH),
            Self::Slot(it) => (it.swing, Dimension::ANGLE),
        }
    }

    /// The lengths by which it is known, m.
    pub fn lengths(&self) -> Vec<(&'static str, f64)> {
        match self {
            Self::Lever(it, rod) => vec![("rod_length", *rod), ("lever_length", it.length)],
            Self::Slider(_, _, rod) => vec![("rod_length", *rod)],
            Self::Slot(it) => vec![("slot_from", it.slot[0]), ("slot_to", it.slot[1])],
        }
    }

    /// How far it is from there where the point is at another place.
    pub fn moved(&self, from: C, to: C) -> f64 {
        let by = self.at(to) - self.at(from);
        match self {
            Self::Slider(..) => by,
            _ => math::within_half_a_turn(by),
        }
    }
}

/// Writes files of what was found.
pub(super) struct Writing<'a> {
    asked: &'a Asked<'a>,
}

/// The measure of an output, and what it is beyond where the output is by [`Output::at`].
struct Measured {
    name: String,
    text: String,
    more: f64,
}

impl<'a> Writing<'a> {
    pub fn new(asked: &'a Asked<'a>) -> Self {
        Self { asked }
    }

    /// The mechanism with what rests on a stretch, where it is furthest out at two ends.
    pub fn beside(
        &self,
        stretch: &Stretch<Near>,
        output: &Output,
        ends: &[(f64, C); 2],
    ) -> Result<Beside, Box<Diagnostic>> {
        let asked = self.asked;
        let mut file = Extended::new(asked.model)?;
        file.keep_drawn(&asked.start)?;
        let mut lengths = Vec::new();
        let mut columns = Vec::new();
        let measured = match output {
            Output::Lever(it, rod) => {
                self.lever(&mut file, it, *rod, (&mut lengths, &mut columns))?
            }
            Output::Slider(it, centre, rod) => {
                let of = (*centre, *rod);
                self.slider(&mut file, it, of, (&mut lengths, &mut columns))?
            }
            Output::Slot(it) => self.slot(&mut file, it)?,
        };
        let Measured { name, text, more } = measured;
        file.add("measures", &name, &text_value(&text))?;
        let beside = file.name("beside_rest");
        let text = self.beside_rest(&file.pen, stretch.from, output);
        file.add("measures", &beside, &text_value(&text))?;
        let stir = file.name("stir");
        let text = format!("max({name} - {beside}) - min({name} + {beside})");
        file.add("measures", &stir, &text_value(&text))?;
        let whole = match output {
            Output::Slider(..) => "stroke",
            _ => "swing",
        };
        let swing = file.name(whole);
        file.add("measures", &swing, &text_value(&format!("range({name})")))?;
        columns.insert(0, swing);
        let point = &asked.model.points[asked.task.point.index()].name;
        let plots = [name.clone(), format!("path({point})")];
        let (file, study, names) = file.finished(&plots)?;
        let mut told = vec![
            ("rest_from".to_owned(), stretch.from, asked.coordinate()),
            ("deviation".to_owned(), stretch.deviation, Dimension::LENGTH),
        ];
        if let Output::Slot(it) = output {
            let ends = ["slot_from", "slot_to"].into_iter().zip(it.slot);
            told.extend(ends.map(|(name, at)| (name.to_owned(), at, Dimension::LENGTH)));
        }
        Ok(Beside {
            file,
            study,
            drive: asked.task.drive,
            lengths,
            told,
            wanted: ends
                .map(|(at, point)| Wanted {
                    measure: name.clone(),
                    at,
                    value: output.at(point) + more,
                    scale: None,
                })
                .into(),
            rank: stir,
            columns,
            names,
        })
    }

    /// A measure that is nothing during the rest and grows beside it by more than any output goes: what is furthest out less that is
    /// furthest out during the rest, whatever the lengths.
    fn beside_rest(&self, pen: &Pen, from: f64, output: &Output) -> String {
        let asked = self.asked;
        let drive = &asked.model.drives[asked.task.drive.index()];
        let [low, high] = asked.range;
        let until = wrapped(from + asked.dwell, asked.range, asked.closed);
        let text = |at: f64| pen.exact(at, drive.dimension);
        let (begins, ends) = (
            format!("{} - {}", text(from), drive.name),
            format!("{} - {}", drive.name, text(until)),
        );
        let off = match from < until {
            true => format!("{begins}, {ends}"),
            false => format!("min({begins}, {ends})"),
        };
        let far = match output {
            Output::Slider(it, _, rod) => {
                let length = rounded(FAR * (2.0 * it.stroke + rod), 2);
                pen.exact(length, Dimension::LENGTH)
            }
            _ => pen.exact(FAR * TAU, Dimension::ANGLE),
        };
        // Of several turns each moves the output as far.
        let once = match drive.dimension {
            Dimension::ANGLE => (high - low).min(TAU),
            _ => high - low,
        };
        let [nothing, once] = [0.0, once].map(text);
        format!("{far} * max({nothing}, {off}) / {once}")
    }

    fn point(&self) -> &str {
        &self.asked.model.points[self.asked.task.point.index()].name
    }

    /// Where the output is furthest back and furthest on during the rest: the drive's coordinate, and the point's place.
    pub fn furthest(
        &self,
        track: &mut PointWay,
        from: f64,
        middle: C,
        output: &Output,
    ) -> [(f64, C); 2] {
        let asked = self.asked;
        let mut look = |at: f64| -> (f64, C, f64) {
            let at = wrapped(at, asked.range, asked.closed);
            let point = track.place(at).unwrap_or(middle);
            (at, point, output.moved(middle, point))
        };
        let part = |k: usize| from + asked.dwell * (k as f64 / LOOKS as f64);
        let looks: Vec<_> = (0..=LOOKS).map(|k| look(part(k))).collect();
        [-1.0, 1.0].map(|sense: f64| {
            let worth = |k: &usize| sense * looks[*k].2;
            let most = (0..=LOOKS).max_by(|a, b| worth(a).total_cmp(&worth(b)));
            let most = most.unwrap_or(0);
            let mut best = looks[most];
            let ends = [most.saturating_sub(1), (most + 1).min(LOOKS)].map(part);
            golden(ends, STEPS, &mut |at| {
                let it = look(at);
                if sense * it.2 > sense * best.2 {
                    best = it;
                }
                sense * it.2
            });
            (best.0, best.1)
        })
    }

    fn lever(
        &self,
        file: &mut Extended<'_>,
        it: &DwellLever,
        rod: f64,
        (lengths, columns): (&mut Vec<(String, f64)>, &mut Vec<String>),
    ) -> Result<Measured, Box<Diagnostic>> {
        let [pivot, end] = ["O", "Q"].map(|name| file.name(name));
        let [rod_link, output] = ["rod", "output"].map(|name| file.name(name));
        let rod_length = file.length("rod_length", rod, lengths)?;
        let lever_length = file.length("lever_length", it.length, lengths)?;
        file.frame_point(&pivot, it.pivot)?;
        file.distance(&rod_link, [self.point(), &end], &rod_length)?;
        file.distance(&output, [&pivot, &end], &lever_length)?;
        let side = if it.side > 0.0 { "left" } else { "right" };
        let hint = format!("{side} of {pivot} -> {}", self.point());
        file.add("assembly", &end, &text_value(&hint))?;
        let transmission = file.name("transmission_angle");
        let text = format!("transmission_angle({end})");
        file.add("measures", &transmission, &text_value(&text))?;
        columns.push(transmission);
        Ok(Measured {
            name: file.name("lever"),
            text: format!("angle({output})"),
            more: 0.0,
        })
    }

    fn slider(
        &self,
        file: &mut Extended<'_>,
        it: &DwellSlider,
        (centre, rod): (C, f64),
        (lengths, columns): (&mut Vec<(String, f64)>, &mut Vec<String>),
    ) -> Result<Measured, Box<Diagnostic>> {
        let [from, to, end] = ["E", "F", "Q"].map(|name| file.name(name));
        let [rod_link, output] = ["rod", "output"].map(|name| file.name(name));
        let guide = file.name("guide");
        let rod_length = file.length("rod_length", rod, lengths)?;
        // Behind all places of the slider, so that its distance from there is its way.
        let back = 2.0 * it.stroke + rod;
        let begin = centre - it.direction.scale(back);
        file.frame_point(&from, begin)?;
        file.frame_point(&to, centre + it.direction.scale(back))?;
        file.distance(&rod_link, [self.point(), &end], &rod_length)?;
        file.add("links", &output, &format!("{{ {} = [0, 0] }}", key(&end)))?;
        let joint = format!(
            "{{ slider = {}, at = {}, on = {} }}",
            text_value(&output),
            text_value(&end),
            text_value(&format!("{from} -> {to}"))
        );
        file.add("joints", &guide, &joint)?;
        let start = self.start();
        let near = centre + it.direction.scale(it.place(start, centre, rod));
        let near = file.pen.place_text(near);
        file.add("assembly", &end, &format!("{{ near = {near} }}"))?;
        let transmission = file.name("transmission_angle");
        let text = format!(
            "acos(abs(distance({}, {from} -> {to})) / {rod_length})",
            self.point()
        );
        file.add("measures", &transmission, &text_value(&text))?;
        columns.push(transmission);
        Ok(Measured {
            name: file.name("travel"),
            text: format!("distance({from}, {end})"),
            more: back,
        })
    }

    fn slot(&self, file: &mut Extended<'_>, it: &DwellSlot) -> Result<Measured, Box<Diagnostic>> {
        let [pivot, end] = ["O", "Q"].map(|name| file.name(name));
        let output = file.name("output");
        let slot = file.name("slot");
        file.frame_point(&pivot, it.pivot)?;
        let length = file.pen.exact(it.slot[1], Dimension::LENGTH);
        file.distance(&output, [&pivot, &end], &length)?;
        let joint = format!(
            "{{ pin = {}, on = {} }}",
            text_value(self.point()),
            text_value(&format!("{pivot} -> {end}"))
        );
        file.add("joints", &slot, &joint)?;
        let angle = (self.start() - it.pivot).arg();
        let near = text_value(&file.pen.exact(angle, Dimension::ANGLE));
        file.add("assembly", &output, &format!("{{ near = {near} }}"))?;
        Ok(Measured {
            name: file.name("lever"),
            text: format!("angle({output})"),
            more: 0.0,
        })
    }

    /// Where the point is as the motion starts.
    fn start(&self) -> C {
        let start = self.asked.start.points.get(self.asked.task.point.index());
        start.map_or(C::new(f64::NAN, f64::NAN), |[x, y]| C::new(*x, *y))
    }
}
