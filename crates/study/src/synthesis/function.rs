//! Function generation: the output goes as the input asks.

use std::f64::consts::PI;

use kempe_model::{
    Diagnostic, FunctionTask, LinkageKind, Model, Span, WantedCurve, WantedFunction, WantedPair,
    value,
};
use kempe_number::math;
use kempe_synthesis::{
    C, DialZeros, FunctionFourBar, InvertedSliderFunction, Linkage, Passage, Pose, PrecisionPoint,
    SliderFunction, SliderPoint, SynthesisError, Turning, chebyshev_spacing, fit_driven_function,
    fit_driven_slider_function, functions, inverted_slider_functions, passage, slider_functions,
};
use kempe_synthesis::{Driver, FourBar, InvertedSliderCrank, SliderCrank};
use kempe_units::Dimension;

use super::candidate::{Found, Rejected, around, dimensions_in_words};
use super::own_linkage::{OwnLinkage, Wanted, scales_of_rates};
use super::refused::{Data, Datum};
use crate::unit::{Units, shown};

/// A fit whose error is more than this part of the output's range is none.
const POOR: f64 = 0.2;

/// An input with its output, SI, in the order of the inputs.
#[derive(Clone, Copy)]
struct Point {
    input: f64,
    output: f64,
    ratio: Option<f64>,
    ratio_rate: Option<f64>,
}

/// What is asked, in numbers.
struct Asked<'a> {
    task: &'a FunctionTask,
    points: Vec<Point>,
    /// From where to where the input is to go.
    range: [f64; 2],
    zeros: [Option<f64>; 2],
    /// Distance of the fixed pivots, m.
    ground: f64,
    units: Units,
    model: &'a Model,
}

/// All linkages that do what a task of a function asks.
pub(super) fn candidates(model: &Model, task: &FunctionTask) -> Result<Found, Box<Diagnostic>> {
    let parameters = model.parameter_values::<f64>();
    let number = |scalar| value::<f64>(scalar, &parameters);
    let (points, given, whole) = match &task.wanted {
        WantedFunction::Pairs(pairs) => {
            let mut both: Vec<(Point, &WantedPair)> = pairs
                .iter()
                .map(|pair| {
                    let point = Point {
                        input: number(&pair.input),
                        output: number(&pair.output),
                        ratio: pair.ratio.as_ref().map(number),
                        ratio_rate: pair.ratio_rate.as_ref().map(number),
                    };
                    (point, pair)
                })
                .collect();
            // A function has no order of its own: its input passes them one after the other.
            both.sort_by(|a, b| a.0.input.total_cmp(&b.0.input));
            // They are called by their order in the file.
            let data = both.iter().map(|(_, pair)| Datum {
                name: format!(
                    "pair {}",
                    1 + pairs.iter().take_while(|p| p.span != pair.span).count()
                ),
                span: pair.span.clone(),
                dimension: Dimension::ANGLE,
            });
            let mut data: Vec<Datum> = data.collect();
            let ends = pairs.first().zip(pairs.last());
            let whole = ends.map_or(0..0, |(a, b)| a.span.start..b.span.end);
            data.push(dials(&whole));
            (
                both.into_iter().map(|(point, _)| point).collect(),
                data,
                whole,
            )
        }
        WantedFunction::Curve(curve) => {
            let points = points_of(curve, &parameters)?;
            let places = (1..=points.len()).map(|k| Datum {
                name: format!("place {k} of the curve"),
                span: curve.span.clone(),
                dimension: Dimension::ANGLE,
            });
            let data = places.chain([dials(&curve.span)]).collect();
            (points, data, curve.span.clone())
        }
    };
    let range = match &task.wanted {
        WantedFunction::Pairs(_) => {
            let points: &Vec<Point> = &points;
            let input = |p: Option<&Point>| p.map_or(0.0, |p| p.input);
            [input(points.first()), input(points.last())]
        }
        WantedFunction::Curve(curve) => {
            let [a, b] = curve.input.each_ref().map(number);
            [a.min(b), a.max(b)]
        }
    };
    let zeros = task.zeros.each_ref().map(|zero| zero.as_ref().map(number));
    let asked = Asked {
        task,
        points,
        range,
        zeros,
        ground: task.ground.as_ref().map_or(1.0, number),
        units: Units::of(model),
        model,
    };
    let data = Data {
        data: given,
        whole,
        remedy: asked.remedy(),
        units: &asked.units,
    };
    let found = match task.linkage {
        LinkageKind::FourBar => asked.four_bars(),
        LinkageKind::SliderCrank => asked.slider_cranks(),
        LinkageKind::InvertedSliderCrank => asked.inverted(),
    };
    found.map_err(|error| data.refused(&error))
}

/// What given zeros say, behind all pairs.
fn dials(span: &Span) -> Datum {
    Datum {
        name: "where the dials show 0".to_owned(),
        span: span.clone(),
        dimension: Dimension::ANGLE,
    }
}

/// Places where a curve is met: by P. L. Chebyshev's spacing.
fn points_of(curve: &WantedCurve, parameters: &[f64]) -> Result<Vec<Point>, Box<Diagnostic>> {
    let number = |scalar| value::<f64>(scalar, parameters);
    let x = curve.x.each_ref().map(number);
    let y = |at: f64| {
        let own = |leaf: &Option<_>| match leaf {
            Some(id) => kempe_model::Scalar::Leaf(*id),
            None => kempe_model::Scalar::Const(at),
        };
        value::<f64>(&curve.y.substitute(&mut |leaf| own(leaf)), parameters)
    };
    let ends = x.map(y);
    let input = curve.input.each_ref().map(number);
    let output = curve.output.each_ref().map(number);
    let scaled = |v: f64, from: [f64; 2], to: [f64; 2]| {
        to[0] + (v - from[0]) / (from[1] - from[0]) * (to[1] - to[0])
    };
    let mut points = Vec::new();
    for at in chebyshev_spacing(x[0], x[1], curve.points) {
        let point = Point {
            input: scaled(at, x, input),
            output: scaled(y(at), ends, output),
            ratio: None,
            ratio_rate: None,
        };
        if !(point.input.is_finite() && point.output.is_finite()) {
            let message = match ends[0] == ends[1] {
                true => format!(
                    "{} is the same at both ends: the output's dial has no scale",
                    curve.text
                ),
                false => format!("{} is no number at x = {at}", curve.text),
            };
            return Err(Box::new(
                Diagnostic::error("not-finite", message)
                    .at(curve.span.clone(), "")
                    .help("choose a range of x in which it rises or falls"),
            ));
        }
        points.push(point);
    }
    points.sort_by(|a, b| a.input.total_cmp(&b.input));
    Ok(points)
}

impl Asked<'_> {
    fn remedy(&self) -> String {
        let given = self.zeros.iter().flatten().count();
        let exact = self.exact() - given;
        let more = match self.task.linkage {
            LinkageKind::InvertedSliderCrank => "",
            _ => ", and more pairs without changes as nearly as can be",
        };
        let free = match given {
            0 => "",
            _ => "; a zero that is \"free\" takes one more",
        };
        format!("with these zeros {exact} conditions are kept exactly{more}{free}")
    }

    /// Conditions that determine a linkage, zeros that are given among them.
    fn exact(&self) -> usize {
        match self.task.linkage {
            LinkageKind::InvertedSliderCrank => 4,
            _ => 5,
        }
    }

    /// Whether there are more pairs than can be kept, so that they are to be approached.
    fn is_fit(&self) -> bool {
        let conditions = self
            .points
            .iter()
            .map(|p| 1 + usize::from(p.ratio.is_some()) + usize::from(p.ratio_rate.is_some()));
        let given = self.zeros.iter().flatten().count();
        let plain = self.points.iter().all(|p| p.ratio.is_none());
        plain && conditions.sum::<usize>() + given > self.exact()
    }

    fn angles(&self) -> Vec<PrecisionPoint> {
        let points = self.points.iter();
        points
            .map(|p| PrecisionPoint {
                input: p.input,
                output: p.output,
                ratio: p.ratio,
                ratio_rate: p.ratio_rate,
            })
            .collect()
    }

    fn dials(&self) -> DialZeros {
        let [input, output] = self.zeros;
        DialZeros { input, output }
    }

    fn four_bars(&self) -> Result<Found, SynthesisError> {
        let points = self.angles();
        let first = self.points.first();
        let bars: Vec<(FunctionFourBar, i8, Vec<f64>)> = match self.is_fit() {
            true => {
                let fits = fit_driven_function(&points, self.dials(), self.range)?.into_iter();
                fits.map(|fit| (fit.bar, fit.branch, fit.errors)).collect()
            }
            false => {
                let exact = functions(&points, self.dials())?.into_iter();
                exact
                    .map(|bar| {
                        let branch = first.map_or(1, |p| bar.branch(p.input, p.output));
                        (bar, branch, Vec::new())
                    })
                    .collect()
            }
        };
        let known = format!(
            "all of up to {}, by the roots of one polynomial",
            match self.dials() {
                DialZeros {
                    input: None,
                    output: None,
                } => 3,
                DialZeros {
                    input: Some(_),
                    output: Some(_),
                } => 1,
                _ => 2,
            }
        );
        let mut found = self.found(known);
        for (bar, branch, errors) in bars {
            let own = bar.four_bar();
            let linkage = Linkage::FourBar(FourBar {
                fixed: own.fixed.map(|p| p.scale(self.ground)),
                moving: own.moving.map(|p| p.scale(self.ground)),
                lengths: own.lengths.map(|l| l * self.ground),
            });
            // Of a fit the output is where the linkage has it, not where it is wanted.
            let met: Option<Vec<Pose>> = (self.points.iter())
                .map(|p| {
                    let output = match self.is_fit() {
                        true => bar.output_angle(p.input, branch, p.output)?,
                        false => p.output,
                    };
                    Some(scaled_pose(bar.pose(p.input, output), self.ground))
                })
                .collect();
            let zero = self.zero(0, bar.input);
            let range = self.range(zero, &|angle| own.turning(angle));
            let near = first.map_or(0.0, |p| p.output);
            let output = bar.output_angle(range[0], branch, near);
            let start = output.map(|output| scaled_pose(bar.pose(range[0], output), self.ground));
            let stands = self.zero(1, bar.output);
            let turned = output.map(|output| ("rocker", stands + output));
            let reading = self.dial("rocker", stands);
            let solution = Solution {
                linkage,
                met,
                start,
                turned,
                range,
                zero,
                reading,
                errors,
            };
            self.add(&mut found, solution);
        }
        Ok(found)
    }

    fn slider_cranks(&self) -> Result<Found, SynthesisError> {
        let points: Vec<SliderPoint> = (self.points.iter())
            .map(|p| SliderPoint {
                angle: p.input,
                place: p.output,
                rate: p.ratio,
                second_rate: p.ratio_rate,
            })
            .collect();
        let [crank, slider] = self.zeros;
        let first = self.points.first();
        let bars: Vec<(SliderFunction, i8, Vec<f64>)> = match self.is_fit() {
            true => {
                let fits =
                    fit_driven_slider_function(&points, crank, slider, self.range)?.into_iter();
                fits.map(|fit| (fit.bar, fit.branch, fit.errors)).collect()
            }
            false => {
                let exact = slider_functions(&points, crank, slider)?.into_iter();
                exact
                    .map(|bar| {
                        let branch = first.map_or(1, |p| bar.branch(p.input, p.output));
                        (bar, branch, Vec::new())
                    })
                    .collect()
            }
        };
        let mut found = self.found("all of up to 3, by the roots of one polynomial".to_owned());
        for (bar, branch, errors) in bars {
            let it: SliderCrank = bar.slider_crank();
            let met: Option<Vec<Pose>> = (self.points.iter())
                .map(|p| {
                    let place = match self.is_fit() {
                        true => bar.place(p.input, branch)?,
                        false => p.output,
                    };
                    Some(bar.pose(p.input, place))
                })
                .collect();
            let zero = self.zero(0, bar.crank);
            let range = self.range(zero, &|angle| it.turning(angle));
            let place = bar.place(range[0], branch);
            let start = place.map(|place| bar.pose(range[0], place));
            let unit = self.units.unit(Dimension::LENGTH);
            let reading = format!("x(C) - ({} {})", shown(bar.slider.re, &unit), unit.text());
            let (linkage, turned) = (Linkage::SliderCrank(it), None);
            let solution = Solution {
                linkage,
                met,
                start,
                turned,
                range,
                zero,
                reading,
                errors,
            };
            self.add(&mut found, solution);
        }
        Ok(found)
    }

    fn inverted(&self) -> Result<Found, SynthesisError> {
        let bars: Vec<InvertedSliderFunction> =
            inverted_slider_functions(&self.angles(), self.dials())?;
        let mut found = self.found("all of up to 2".to_owned());
        for bar in bars {
            let own = bar.slider_crank();
            let linkage = Linkage::InvertedSliderCrank(InvertedSliderCrank {
                fixed: own.fixed.map(|p| p.scale(self.ground)),
                crank: own.crank * self.ground,
                moving: own.moving.scale(self.ground),
                guide: kempe_synthesis::Line {
                    point: own.guide.point.scale(self.ground),
                    direction: own.guide.direction,
                },
            });
            let poses = self.points.iter();
            let poses = poses.map(|p| scaled_pose(bar.pose(p.input, p.output), self.ground));
            let first = self.points.first().copied();
            let start = first.map(|p| scaled_pose(bar.pose(p.input, p.output), self.ground));
            let stands = self.zero(1, bar.guide);
            let turned = first.map(|p| ("lever", stands + p.output));
            let reading = self.dial("lever", stands);
            let (met, zero) = (Some(poses.collect()), self.zero(0, bar.crank));
            let range = self.range(zero, &|_| own.turning());
            let errors = Vec::new();
            let solution = Solution {
                linkage,
                met,
                start,
                turned,
                range,
                zero,
                reading,
                errors,
            };
            self.add(&mut found, solution);
        }
        Ok(found)
    }

    fn found(&self, searched: String) -> Found {
        let searched = match self.is_fit() {
            true => "minima of the sum of squares, from many starts, and the least where the transmission angle keeps from 0 and 180 deg".to_owned(),
            false => searched,
        };
        Found {
            searched,
            ..Found::default()
        }
    }

    /// Where a link stands as its dial shows nothing, rad: as it is given, or opposite.
    fn zero(&self, which: usize, vector: C) -> f64 {
        match self.zeros[which] {
            Some(given) => {
                let along = (vector * C::from_polar(1.0, given).conj()).re;
                if along < 0.0 { given + PI } else { given }
            }
            None => vector.arg(),
        }
    }

    /// What the dial of a link shows that stands at `zero` (rad) as the dial shows nothing.
    fn dial(&self, link: &str, zero: f64) -> String {
        let unit = self.units.unit(Dimension::ANGLE);
        match shown(zero, &unit) + 0.0 {
            0.0 => format!("angle({link})"),
            angle => format!("angle({link}) - ({angle} {})", unit.text()),
        }
    }

    /// From where to where the input goes; of a single pair a little to both sides, on a linkage whose crank stands at `zero` as its dial
    /// shows nothing.
    fn range(&self, zero: f64, turning: &dyn Fn(f64) -> Turning) -> [f64; 2] {
        match self.range[0] == self.range[1] {
            true => {
                let angle = zero + self.range[0];
                around(angle, turning(angle)).map(|angle| angle - zero)
            }
            false => self.range,
        }
    }

    /// Adds a linkage.
    fn add(&self, found: &mut Found, solution: Solution) {
        let Solution {
            linkage,
            met,
            start,
            turned,
            range,
            zero,
            reading,
            errors,
        } = solution;
        let mut measures = vec![
            ("input".to_owned(), self.dial("crank", zero)),
            ("output".to_owned(), reading),
        ];
        if let WantedFunction::Curve(curve) = &self.task.wanted {
            measures.push(("wanted".to_owned(), self.formula(curve)));
            measures.push(("structural_error".to_owned(), "output - wanted".to_owned()));
        }
        let mut candidate = OwnLinkage {
            linkage,
            start: Pose::new(0.0, 0.0, 0.0),
            turned,
            drive: range.map(|input| zero + input),
            point: None,
            keeps_axes: false,
            parameters: Vec::new(),
            measures,
            told: self.errors_told(&errors),
            wanted: Vec::new(),
        };
        candidate.wanted = self.wanted(&candidate, zero, &errors);
        let (Some(met), Some(start)) = (met, start) else {
            let what = dimensions_in_words(&candidate.lengths(), &self.units);
            let why = "it cannot be closed all along the range".to_owned();
            found.rejected.push(Rejected { what, why });
            return;
        };
        candidate.start = start;
        let outputs = self.points.iter().map(|p| p.output);
        let [low, high] = outputs.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
            [low.min(x), high.max(x)]
        });
        if let Some((_, rms, dimension)) = candidate.told.first()
            && *rms > POOR * (high - low)
        {
            let what = dimensions_in_words(&candidate.lengths(), &self.units);
            let rms = self.units.text(*rms, *dimension);
            let why = format!("it comes no nearer than {rms} in the root of the mean square");
            found.rejected.push(Rejected { what, why });
            return;
        }
        let passed = passage(&candidate.linkage, &met, Driver::First);
        match passed.as_ref().and_then(|p| defect(p, self.points.len())) {
            Some(why) => {
                let what = dimensions_in_words(&candidate.lengths(), &self.units);
                found.rejected.push(Rejected { what, why });
            }
            None => found.candidates.push(candidate.into()),
        }
    }

    /// What the output must do on a linkage whose crank stands at `zero` (rad) as its dial shows nothing.
    fn wanted(&self, of: &OwnLinkage, zero: f64, errors: &[f64]) -> Vec<Wanted> {
        // What the output goes by as the input turns by a radian, of rates that nobody asks for.
        let size = match self.task.linkage {
            LinkageKind::SliderCrank => of.links().into_iter().fold(0.0, f64::max),
            _ => 1.0,
        };
        let ratios = self.points.iter().filter_map(|p| p.ratio);
        let first: Vec<f64> = ratios.chain([size]).collect();
        let second: Vec<f64> = self.points.iter().filter_map(|p| p.ratio_rate).collect();
        let [first, second] = scales_of_rates(size, &first, &second);
        let mut wanted = Vec::new();
        for (k, point) in self.points.iter().enumerate() {
            let error = errors.get(k).copied().unwrap_or(0.0);
            let all = [
                ("output", Some(point.output + error), None),
                ("d(output, motor)", point.ratio, Some(first)),
                ("d(output, motor, 2)", point.ratio_rate, Some(second)),
            ];
            wanted.extend(all.into_iter().filter_map(|(measure, value, scale)| {
                Some(Wanted {
                    measure: measure.to_owned(),
                    at: zero + point.input,
                    value: value?,
                    scale,
                })
            }));
        }
        wanted
    }

    /// How near a fit comes.
    fn errors_told(&self, errors: &[f64]) -> Vec<(String, f64, Dimension)> {
        if errors.is_empty() {
            return Vec::new();
        }
        let dimension = match self.task.linkage {
            LinkageKind::SliderCrank => Dimension::LENGTH,
            _ => Dimension::ANGLE,
        };
        let square = errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64;
        let largest = errors.iter().fold(0.0, |m: f64, e| m.max(e.abs()));
        vec![
            ("rms_error".to_owned(), square.sqrt(), dimension),
            ("largest_error".to_owned(), largest, dimension),
        ]
    }

    /// What the output's dial should show, as a measure of the linkage's file.
    fn formula(&self, curve: &WantedCurve) -> String {
        let parameters = self.model.parameter_values::<f64>();
        let numbers = |ends: &[kempe_model::Scalar; 2]| {
            ends.each_ref()
                .map(|scalar| value::<f64>(scalar, &parameters))
        };
        let of = |dimension: Dimension, [a, b]: [f64; 2]| {
            let unit = self.units.unit(dimension);
            let text = |si: f64| format!("{} {}", shown(si, &unit), unit.text());
            [text(a), text(b - a)]
        };
        let output_is = match self.task.linkage {
            LinkageKind::SliderCrank => Dimension::LENGTH,
            _ => Dimension::ANGLE,
        };
        let x = numbers(&curve.x);
        let [input, input_by] = of(Dimension::ANGLE, numbers(&curve.input));
        let [output, output_by] = of(output_is, numbers(&curve.output));
        let (from, by) = (x[0], x[1] - x[0]);
        let at = format!("({from} + ({by}) * (input - ({input})) / ({input_by}))");
        let y = |x: &str| replaced(&curve.text, "x", x);
        let ends = x.map(|x| y(&format!("({x})")));
        format!(
            "{output} + ({}) / ({}) * ({output_by})",
            format_args!("({}) - ({})", y(&at), ends[0]),
            format_args!("({}) - ({})", ends[1], ends[0]),
        )
    }
}

/// A linkage that does what is asked, or comes near to it.
struct Solution {
    linkage: Linkage,
    /// Where its coupler is at the pairs; none where it cannot be closed all along.
    met: Option<Vec<Pose>>,
    /// Where its coupler is as the input starts.
    start: Option<Pose>,
    /// The link whose dial the output is, and its angle there, rad.
    turned: Option<(&'static str, f64)>,
    /// From where to where its input goes.
    range: [f64; 2],
    /// Where its crank stands as its dial shows nothing, rad.
    zero: f64,
    /// What its output's dial shows.
    reading: String,
    /// By how much its output misses the pairs, where it only comes near.
    errors: Vec<f64>,
}

/// A pose in a plane that is so much larger.
fn scaled_pose(pose: Pose, by: f64) -> Pose {
    let C { re, im } = pose.origin;
    Pose::new(re * by, im * by, pose.angle)
}

/// A text with a name put in the place of another.
fn replaced(text: &str, name: &str, by: &str) -> String {
    let part_of_name = |c: char| c.is_alphanumeric() || c == '_';
    let mut out = String::new();
    let mut rest = text;
    while !rest.is_empty() {
        let word = rest.find(|c| !part_of_name(c)).unwrap_or(rest.len());
        let (own, more) = rest.split_at(word);
        out.push_str(if own == name { by } else { own });
        let other = more.find(part_of_name).unwrap_or(more.len());
        let (between, more) = more.split_at(other);
        out.push_str(between);
        rest = more;
    }
    out
}

/// What keeps a linkage from passing through all that it is right in.
pub(super) fn defect(passed: &Passage, data: usize) -> Option<String> {
    let range = passed.driver.first().zip(passed.driver.last());
    let turned = range
        .map_or(0.0, |(a, b)| math::within_half_a_turn(b - a))
        .to_degrees();
    if !passed.one_circuit {
        return Some(
            "its places lie on two circuits: it would have to be taken apart between them"
                .to_owned(),
        );
    }
    if !passed.one_branch {
        return Some("its places lie on two branches: the crank cannot drive it through the dead centre between them".to_owned());
    }
    if !passed.in_order && data > 2 {
        return Some(format!(
            "the crank, turning one way, does not meet its {data} places in their order ({turned:.0} deg apart at the ends)"
        ));
    }
    None
}
