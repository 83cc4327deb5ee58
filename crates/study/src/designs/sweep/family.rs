//! Curves of several designs in one picture.

use kempe_model::{Leaf, Measure, Plot, PoseMeasure, SweepStudy};
use kempe_motion::Silent;
use kempe_motion::drive_path::DrivePath;
use kempe_units::{Dimension, Unit};

use super::order::Order;
use crate::designs::bench::{Answer, Bench, Refused};
use crate::quantity::Quantity;
use crate::result::{Figure, PlaneCurve};
use crate::rows::RowPlace;
use crate::unit::{Units, shown};

/// Curves in one picture at most: those of evenly chosen designs.
const MOST_CURVES: usize = 12;
/// Points of a curve.
const POINTS: usize = 121;

/// What is plotted for several designs.
enum Plotted {
    /// A measure along the motion.
    Measure(usize),
    /// The path of a point: its coordinates.
    Path(usize, String),
}

/// The curves of a design.
struct DesignCurves {
    design: usize,
    /// The abscissa (SI) and the quantities there, point by point.
    points: Vec<(f64, Vec<f64>)>,
}

/// Answers designs, and keeps the curves of some of them.
pub(super) struct Families<'b, 'm> {
    bench: &'b Bench<'m>,
    plotted: Vec<Plotted>,
    quantities: Vec<Quantity>,
    /// The designs whose curves are kept.
    chosen: Vec<usize>,
    /// What is kept of these.
    curves: Vec<DesignCurves>,
    /// What runs to the right.
    along: (String, Dimension),
}

impl<'b, 'm> Families<'b, 'm> {
    pub fn new(bench: &'b Bench<'m>, study: &SweepStudy, designs: usize) -> Self {
        let own = &study.over.asked.plots;
        let plots = match own.is_empty() {
            true => &bench.over.kind.along().plots,
            false => own,
        };
        let mut plotted = Vec::new();
        let mut quantities = Vec::new();
        for plot in plots {
            match plot {
                Plot::Curves(curves) => {
                    for column in curves {
                        plotted.push(Plotted::Measure(quantities.len()));
                        quantities.push(Quantity {
                            name: column.name.clone(),
                            measure: column.measure.clone(),
                            dimension: column.dimension,
                        });
                    }
                }
                Plot::Path(point) => {
                    let name = bench.model.points.get(point.index());
                    let name = name.map_or(String::new(), |p| p.name.clone());
                    plotted.push(Plotted::Path(quantities.len(), format!("path({name})")));
                    for measure in [PoseMeasure::X(*point), PoseMeasure::Y(*point)] {
                        quantities.push(Quantity {
                            name: name.clone(),
                            measure: Measure::Leaf(Leaf::Pose(measure)),
                            dimension: Dimension::LENGTH,
                        });
                    }
                }
                Plot::Hodograph(_) => {}
            }
        }
        let count = designs.min(MOST_CURVES);
        let chosen = (0..count).map(|k| match count {
            1 => 0,
            _ => k * (designs - 1) / (count - 1),
        });
        Self {
            bench,
            chosen: match plotted.is_empty() {
                true => Vec::new(),
                false => chosen.collect(),
            },
            plotted,
            quantities,
            curves: Vec::new(),
            along: ("time".to_owned(), Dimension::TIME),
        }
    }

    /// The numbers of a design.
    pub fn answer(&mut self, index: usize, values: &[f64]) -> Result<Answer, Refused> {
        if !self.chosen.contains(&index) {
            return self.bench.answer(values);
        }
        let motion = self.bench.motion(values, &mut Silent)?;
        let answer = self.bench.answer_of(&motion)?;
        let quantities: Vec<&Quantity> = self.quantities.iter().collect();
        let mut along = self.bench.along(&motion, &quantities, &mut Silent)?;
        let (low, high) = motion.demanded;
        let points = (0..POINTS).map(|k| {
            let p = low + (high - low) * (k as f64 / (POINTS - 1) as f64);
            let place = match motion.path {
                DrivePath::Coordinate { .. } => RowPlace::Drive(p),
                DrivePath::Time { .. } => RowPlace::Time(p),
            };
            (p, along.values(place))
        });
        self.curves.push(DesignCurves {
            design: index,
            points: points.collect(),
        });
        if let DrivePath::Coordinate { drive, .. } = motion.path
            && let Some(drive) = self.bench.model.drives.get(drive)
        {
            self.along = (drive.name.clone(), drive.dimension);
        }
        Ok(answer)
    }

    /// The pictures.
    pub fn figures(&self, order: &Order, units: &Units) -> Vec<Figure> {
        let unit = |dimension| units.unit(dimension);
        let along = unit(self.along.1);
        let curves = |at: &dyn Fn(f64, &[f64]) -> [f64; 2]| -> Vec<PlaneCurve> {
            let curve = |it: &DesignCurves| PlaneCurve {
                name: self.label(&order.designs[it.design], units),
                points: it.points.iter().map(|(p, v)| at(*p, v)).collect(),
                dashed: false,
            };
            self.curves.iter().map(curve).collect()
        };
        (self.plotted.iter())
            .map(|plotted| match plotted {
                Plotted::Measure(k) => {
                    let quantity = &self.quantities[*k];
                    let own: Unit = quantity.unit(units);
                    Figure::Graph {
                        name: quantity.name.clone(),
                        x: (self.along.0.clone(), along.clone()),
                        y: (quantity.name.clone(), own.clone()),
                        curves: curves(&|p, values| [shown(p, &along), shown(values[*k], &own)]),
                    }
                }
                Plotted::Path(k, name) => {
                    let own = unit(Dimension::LENGTH);
                    Figure::Plane {
                        name: name.clone(),
                        unit: own.clone(),
                        curves: curves(&|_, values| {
                            [values[*k], values[k + 1]].map(|x| shown(x, &own))
                        }),
                    }
                }
            })
            .collect()
    }

    /// `a = 20 mm, b = 50 mm`: the parameters that differ between designs.
    fn label(&self, design: &[f64], units: &Units) -> String {
        let pairs = self.bench.varied.iter().zip(design);
        let texts = pairs.map(|(id, value)| {
            let parameter = &self.bench.model.parameters[id.index()];
            format!(
                "{} = {}",
                parameter.name,
                units.text(*value, parameter.dimension)
            )
        });
        texts.collect::<Vec<_>>().join(", ")
    }
}
