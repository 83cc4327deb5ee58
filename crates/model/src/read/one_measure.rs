//! One measure more, asked of a model that is read already.

use kempe_units::{Comparison, Dimension, Expr, check, check_condition, parse, parse_condition};

use crate::diagnostic::Diagnostic;
use crate::ids::{DriveId, JointId, LinkId, ParameterId, PointId};
use crate::load::LoadKind;
use crate::measure::Measure;
use crate::measure::NamedMeasure;
use crate::model::Model;
use crate::read::context::{Context, Meaning, MeasureState};
use crate::read::measure_names::Measures;
use crate::read::nature::{Nature, nature};
use crate::read::springs::tension;

impl Model {
    /// Reads a measure, the name of one or an expression such as `range(angle(rocker))`, as if it stood in the file. Its
    /// name is its text.
    ///
    /// # Errors
    ///
    /// What is wrong with it, labelled in `text`.
    ///
    /// # Example
    ///
    /// ```
    /// # let file = "[links]\nframe = { A = [0, 0] }\ncrank = { A-B = 1 }\n";
    /// # let model = kempe_model::Model::from_toml(file, "", &mut |_| Err(String::new())).unwrap().model;
    /// assert_eq!(model.measure("2 * x(B)").unwrap().dimension, kempe_units::Dimension::LENGTH);
    /// assert_eq!(model.measure("x(C)").unwrap_err()[0].code, "unknown-name");
    /// ```
    pub fn measure(&self, text: &str) -> Result<NamedMeasure, Vec<Diagnostic>> {
        let mut files = |_: &str| Err(String::new());
        let cx = Context::of(self, &mut files);
        match parse(text).and_then(|tree| check(&tree, &mut Measures(&cx))) {
            Ok((measure, dimension)) => Ok(NamedMeasure {
                needs_forces: nature(&measure, &cx.natures).forces,
                name: text.trim().to_owned(),
                measure,
                dimension,
                span: 0..text.len(),
            }),
            Err(issues) => Err(issues
                .into_iter()
                .map(|issue| Diagnostic::of_issue(issue, "measure", text).tamed())
                .collect()),
        }
    }
}

/// Two measures that a condition compares.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Compared {
    /// The left side, named by its text.
    pub left: NamedMeasure,
    /// Left less right where the left side is to be the larger one, right less left where it is to be the smaller: not negative where the
    /// condition holds.
    pub above: Measure,
    /// Whether the left side is to be the larger one.
    pub at_least: bool,
}

impl Model {
    /// Reads a condition, such as `min(transmission_angle(C)) >= 35 deg`, as if it stood in the file.
    ///
    /// # Errors
    ///
    /// What is wrong with it, labelled in `text`.
    pub fn condition(&self, text: &str) -> Result<Compared, Vec<Diagnostic>> {
        let mut files = |_: &str| Err(String::new());
        let cx = Context::of(self, &mut files);
        let read = parse_condition(text).and_then(|tree| {
            let checked = check_condition(&tree, &mut Measures(&cx))?;
            Ok((tree, checked))
        });
        let (tree, found) = read.map_err(|issues| {
            let told = issues.into_iter();
            told.map(|issue| Diagnostic::of_issue(issue, "condition", text).tamed())
                .collect::<Vec<_>>()
        })?;
        let at_least = matches!(
            found.comparison,
            Comparison::Greater | Comparison::GreaterEqual
        );
        let written = text.get(..tree.comparison_span.start).unwrap_or(text);
        let (large, small) = match at_least {
            true => (found.left.clone(), found.right),
            false => (found.right, found.left.clone()),
        };
        let above = Expr::Sub(Box::new(large), Box::new(small));
        Ok(Compared {
            left: NamedMeasure {
                needs_forces: nature(&above, &cx.natures).forces,
                name: written.trim().to_owned(),
                measure: found.left,
                dimension: found.dimension,
                span: tree.left.span,
            },
            above,
            at_least,
        })
    }
}

impl<'a> Context<'a> {
    /// What the reader knew of names when it had read `model`.
    fn of(model: &Model, files: crate::read::context::Files<'a>) -> Self {
        let mut cx = Self::new(&model.title, files);
        let unit = |name: &str, or: &kempe_units::Unit| {
            kempe_units::Unit::parse(name).unwrap_or_else(|_| or.clone())
        };
        cx.preferred = vec![
            unit(&model.units.length.name, &cx.preferred[0]),
            unit(&model.units.angle.name, &cx.preferred[1]),
        ];
        let more = model.units.more.iter();
        let more = more.filter_map(|unit| kempe_units::Unit::parse(&unit.name).ok());
        cx.preferred.extend(more);
        let parameters = (model.parameters.iter().enumerate())
            .map(|(i, p)| (&p.name, Meaning::Parameter(ParameterId(i as u32)), &p.span));
        let links = (model.links.iter().enumerate())
            .map(|(i, l)| (&l.name, Meaning::Link(LinkId(i as u32)), &l.span));
        let joints =
            (model.joints.iter().enumerate()).map(|(i, j)| (&j.name, Meaning::Joint(i), &j.span));
        let drives =
            (model.drives.iter().enumerate()).map(|(i, d)| (&d.name, Meaning::Drive(i), &d.span));
        let measures = (model.measures.iter().enumerate())
            .map(|(i, m)| (&m.name, Meaning::Measure(i), &m.span));
        let names = parameters
            .chain(links)
            .chain(joints)
            .chain(drives)
            .chain(measures);
        cx.names = names
            .map(|(name, meaning, span)| (name.clone(), (meaning, span.clone())))
            .collect();
        cx.points = (model.points.iter().enumerate())
            .map(|(i, p)| (p.name.clone(), PointId(i as u32)))
            .collect();
        cx.sound = vec![true; model.parameters.len()];
        cx.values = model.parameter_values();
        cx.joints = (0..model.joints.len())
            .map(|i| Some(JointId(i as u32)))
            .collect();
        cx.drives = (0..model.drives.len())
            .map(|i| Some(DriveId(i as u32)))
            .collect();
        cx.springs = (model.actions.springs.iter().enumerate())
            .map(|(i, spring)| (spring.name.clone(), Some((i, tension(&spring.between)))))
            .collect();
        cx.dampers = (model.actions.dampers.iter().enumerate())
            .map(|(i, damper)| (damper.name.clone(), Some((i, tension(&damper.between)))))
            .collect();
        cx.loads = (model.actions.loads.iter().enumerate())
            .map(|(i, load)| {
                let dimension = match load.kind {
                    LoadKind::Force { .. } => Dimension::FORCE,
                    LoadKind::Torque { .. } => Dimension::TORQUE,
                };
                (load.name.clone(), Some((i, dimension)))
            })
            .collect();
        cx.switches = (model.actions.switches.iter().enumerate())
            .map(|(i, switch)| (switch.name.clone(), Some((i, Dimension::NONE))))
            .collect();
        cx.measures = (model.measures.iter().enumerate())
            .map(|(i, m)| MeasureState::Sound(i, m.dimension))
            .collect();
        // Measures may name later ones: what they ask for settles after as many rounds as they are deep.
        cx.natures = vec![Nature::default(); model.measures.len()];
        loop {
            let of = |m: &NamedMeasure| -> Nature { nature(&m.measure, &cx.natures) };
            let next: Vec<Nature> = model.measures.iter().map(of).collect();
            if next == cx.natures {
                break;
            }
            cx.natures = next;
        }
        cx.model = model.clone();
        cx
    }
}
