//! What the names and functions of a measure mean.

use kempe_units::{Dimension, Expr, Issue, Kind, Node, Resolver, check, check_as};

use crate::ids::{FRAME, Span};
use crate::inner::InnerState;
use crate::measure::{ForceMeasure, Leaf, Measure, PoseMeasure, Statistic};
use crate::read::context::{Context, Meaning, MeasureState};
use crate::read::laws::rate;
use crate::read::nature::nature;
use crate::read::value::ALREADY_TOLD;
use crate::registry::{Form, Gives, MeasureEntry, Registry};

/// Names of a measure.
pub(crate) struct Measures<'c, 'a>(pub &'c Context<'a>);

pub(crate) type Found<T> = Result<T, Vec<Issue>>;

/// A call that is being resolved.
pub(crate) struct Call<'n> {
    pub function: &'n str,
    pub arguments: &'n [Node],
    pub span: Span,
}

/// The measure that a name without brackets is: one of the whole mechanism.
pub(crate) fn bare(name: &str) -> Option<(Leaf, Dimension)> {
    let row = Registry::find(name)?;
    match row.forms {
        [Form::Whole(measure)] => Some((Leaf::Force(measure.clone()), row.gives.of(false))),
        _ => None,
    }
}

impl Resolver<Leaf> for Measures<'_, '_> {
    fn name(&mut self, name: &str, span: Span) -> Result<(Leaf, Dimension), Issue> {
        if name == "time" {
            return Ok((Leaf::Time, Dimension::TIME));
        }
        if let Some(found) = bare(name) {
            return Ok(found);
        }
        let cx = self.0;
        let wrong = |what: &str, help: String| {
            Err(Issue::new(
                "not-a-value",
                span.clone(),
                format!("`{name}` is {what}, not a value"),
            )
            .with_help(help))
        };
        match cx.names.get(name).map(|(m, _)| *m) {
            Some(Meaning::Parameter(id)) => cx
                .parameter(id, span)
                .map(|(id, d)| (Leaf::Parameter(id), d)),
            Some(Meaning::Drive(i)) => match self.drive_by_number(i) {
                Some((id, dimension)) => Ok((Leaf::Drive(id), dimension)),
                None => Err(Issue::new(ALREADY_TOLD, span, "")),
            },
            Some(Meaning::Measure(i)) => match cx.measures.get(i) {
                Some(MeasureState::Sound(place, dimension)) => {
                    Ok((Leaf::Named(*place), *dimension))
                }
                _ => Err(Issue::new(ALREADY_TOLD, span, "")),
            },
            Some(Meaning::Link(_)) => {
                wrong("a link", format!("ask something of it: `angle({name})`"))
            }
            Some(Meaning::Joint(_)) => {
                wrong("a joint", format!("ask something of it: `travel({name})`"))
            }
            None => {
                let values = cx
                    .names
                    .iter()
                    .filter(|(_, (m, _))| !matches!(m, Meaning::Link(_) | Meaning::Joint(_)));
                Err(Issue::unknown_name(
                    name,
                    span,
                    values.map(|(n, _)| n.as_str()).chain(["time"]).chain(
                        Registry::all()
                            .iter()
                            .map(|m| m.name)
                            .filter(|n| bare(n).is_some()),
                    ),
                ))
            }
        }
    }

    fn call(
        &mut self,
        function: &str,
        arguments: &[Node],
        span: Span,
    ) -> Option<Result<(Leaf, Dimension), Vec<Issue>>> {
        if let Some(issue) = picture(function, arguments, &span) {
            return Some(Err(vec![issue]));
        }
        let entry = Registry::find(function)?;
        // `min(a, b)` is the smaller of two, not a question about the motion
        if matches!(function, "min" | "max") && arguments.len() > 1 {
            return None;
        }
        let call = Call {
            function: entry.name,
            arguments,
            span,
        };
        Some(self.resolve(entry, &call))
    }

    fn declared(&self, name: &str) -> bool {
        let meaning = self.0.names.get(name).map(|(m, _)| *m);
        matches!(
            meaning,
            Some(Meaning::Parameter(_) | Meaning::Drive(_) | Meaning::Measure(_))
        )
    }

    fn functions(&self) -> Vec<String> {
        Registry::all().iter().map(|m| m.name.to_owned()).collect()
    }
}

/// What to say of a picture that stands where a value is needed.
fn picture(function: &str, arguments: &[Node], span: &Span) -> Option<Issue> {
    let of = |stand_in: &'static str| {
        let first = arguments.first();
        first
            .and_then(|a| a.as_point().or(a.as_name()))
            .map_or(stand_in, |name| name)
            .to_owned()
    };
    let (call, help) = match function {
        "path" => {
            let p = of("P");
            let help = format!(
                "plot = [\"path({p})\"] draws it; x({p}), y({p}) and path_length({p}) are numbers"
            );
            (format!("path({p})"), help)
        }
        "hodograph" => {
            let b = of("B");
            let help = format!(
                "plot = [\"hodograph({b})\"] in a study of forces draws it; reaction({b}), reaction_x({b}) and reaction_y({b}) are numbers"
            );
            (format!("hodograph({b})"), help)
        }
        _ => return None,
    };
    let issue = Issue::new(
        "not-a-value",
        span.clone(),
        format!("`{call}` is a picture, not a value"),
    );
    Some(
        issue
            .with_label("only `plot` takes pictures")
            .with_help(help),
    )
}

impl Measures<'_, '_> {
    /// Reads a call by the forms of its measure; of those that a call may fit the more special stand later.
    fn resolve(&mut self, row: &MeasureEntry, call: &Call<'_>) -> Found<(Leaf, Dimension)> {
        for form in row.forms.iter().rev() {
            if let Some(found) = self.read(row, form, call)? {
                return Ok(found);
            }
        }
        self.wrong(call)
    }

    /// Reads a call by one form; `None` where its arguments are not of this form.
    fn read(
        &mut self,
        row: &MeasureEntry,
        form: &Form,
        call: &Call<'_>,
    ) -> Found<Option<(Leaf, Dimension)>> {
        use PoseMeasure as P;
        let is = row.gives.of(false);
        let pose = |measure: P| (Leaf::Pose(measure), is);
        let force = |measure| (Leaf::Force(measure), is);
        Ok(Some(match (form, call.arguments) {
            (Form::Point(make), [p]) => pose(make(self.point(p)?)),
            (Form::PointLink(make), [p, l]) => pose(make(self.point(p)?, self.link(l)?)),
            (Form::Link(make), [l]) => pose(make(self.link(l)?)),
            (Form::LinkLink(make) | Form::LinkOrFrame(make), [l, other]) => {
                pose(make(self.link(l)?, self.link(other)?))
            }
            (Form::LinkOrFrame(make), [l]) => pose(make(self.link(l)?, FRAME)),
            (Form::Direction, [line]) if line.as_line().is_some() => {
                let (from, to) = self.line(line)?;
                pose(P::Direction(from, to))
            }
            (Form::Corner, [a, at, b]) => {
                let (at, a, b) = self.corner(at, [a, b])?;
                let folded = false;
                pose(P::TransmissionAngle { at, a, b, folded })
            }
            (Form::Transmission, [at, a, b]) => {
                let (at, a, b) = self.corner(at, [a, b])?;
                let folded = true;
                pose(P::TransmissionAngle { at, a, b, folded })
            }
            (Form::Transmission, [node]) => {
                let at = self.point(node)?;
                let (a, b) = self.transmission(at, node)?;
                let folded = true;
                pose(P::TransmissionAngle { at, a, b, folded })
            }
            (Form::Distance, [pair]) => match (&pair.kind, pair.as_pair()) {
                (Kind::Binary { left, right, .. }, Some(_)) => {
                    pose(P::Distance(self.point(left)?, self.point(right)?))
                }
                _ => return Ok(None),
            },
            (Form::Distance, [p, q]) => pose(P::Distance(self.point(p)?, self.point(q)?)),
            (Form::DistanceToLine, [p, line]) if line.as_line().is_some() => {
                let point = self.point(p)?;
                let (from, to) = self.line(line)?;
                pose(P::DistanceToLine(point, self.link_of_line(from, to, line)?))
            }
            (Form::Travel, [slider]) => {
                let (point, line) = self.guide(slider)?;
                pose(P::Travel(point, line))
            }
            (Form::Cylinder, [drive]) => pose(self.cylinder(drive)?),
            (Form::Advantage, [m, drive]) => {
                let (measure, of) = self.of_the_pose(m)?;
                let (drive, per) = self.drive(drive)?;
                let measure = P::MechanicalAdvantage(Box::new(measure), drive);
                (Leaf::Pose(measure), per / of)
            }
            (Form::Effort { turning }, [drive]) => force(self.effort(call, drive, *turning)?),
            (Form::Drive(make), [drive]) => {
                let (id, of) = self.drive(drive)?;
                let dimension = row.gives.of(of == Dimension::ANGLE);
                (Leaf::Force(make(id)), dimension)
            }
            (Form::Pressure, [drive]) => {
                force(ForceMeasure::Pressure(self.hydraulic(call, drive, false)?))
            }
            (Form::Chamber(side), [drive]) => {
                let drive = self.with_oil(call, drive)?;
                (Leaf::Inner(InnerState::Pressure(drive, *side)), is)
            }
            (Form::Switch, [node]) => {
                let (i, of) = self.acting(node, "switch", &self.0.switches)?;
                (Leaf::Inner(InnerState::Switch(i)), of)
            }
            (Form::Capacity, [drive]) => {
                let (id, of_motor) = self.capacity(call, drive)?;
                (
                    Leaf::Force(ForceMeasure::Capacity(id)),
                    row.gives.of(of_motor),
                )
            }
            (Form::Joint(make), [joint]) => force(make(self.joint(call, joint, None)?)),
            (Form::Joint(make) | Form::JointOnLink(make), [joint, link]) => {
                force(make(self.joint(call, joint, Some(link))?))
            }
            (Form::Moment, [joint, link @ ..]) if link.len() < 2 => {
                let joint = self.moment(call, joint, link.first())?;
                force(ForceMeasure::ReactionMoment(joint))
            }
            (Form::Spring, [node]) => {
                let (i, of) = self.acting(node, "spring", &self.0.springs)?;
                (Leaf::Force(ForceMeasure::Spring(i)), of)
            }
            (Form::Damper, [node]) => {
                let (i, of) = self.acting(node, "damper", &self.0.dampers)?;
                (Leaf::Force(ForceMeasure::Damper(i)), of)
            }
            (Form::Load, [node]) => {
                let (i, of) = self.acting(node, "load", &self.0.loads)?;
                (Leaf::Force(ForceMeasure::Load(i)), of)
            }
            (Form::LoadComponent(make), [node]) => {
                let (i, of) = self.acting(node, "load", &self.0.loads)?;
                if of != is {
                    let help = "a torque has one value: load(…)".to_owned();
                    return self.argument(node, "a force", help);
                }
                force(make(i))
            }
            (Form::Rate, [m, order @ ..]) if order.len() < 2 => {
                let (measure, of) = check(m, self)?;
                let order = self.order(order)?;
                (Leaf::Rate(Box::new(measure), order), rate(of, order as i32))
            }
            (Form::Coefficient, [m, drive, order @ ..]) if order.len() < 2 => {
                let (measure, of) = self.of_the_pose(m)?;
                let (drive, per) = self.drive(drive)?;
                let order = self.order(order)?;
                let per = per.powi(order as i32).unwrap_or(per);
                (Leaf::Coefficient(Box::new(measure), drive, order), of / per)
            }
            (Form::Over(statistic), [m]) => self.over(row, statistic.clone(), m)?,
            (Form::Stroke, [m]) => match self.meaning(m) {
                Some(Meaning::Link(_) | Meaning::Joint(_)) => {
                    let (point, line) = self.guide(m)?;
                    let travel: Measure = Expr::Leaf(Leaf::Pose(P::Travel(point, line)));
                    let range = Leaf::Over(Statistic::Range, Box::new(travel));
                    (range, Dimension::LENGTH)
                }
                _ => self.over(row, Statistic::Range, m)?,
            },
            (Form::At, [m, drive, place]) => self.at(m, drive, place)?,
            _ => return Ok(None),
        }))
    }

    /// A measure over the motion.
    fn over(
        &mut self,
        row: &MeasureEntry,
        statistic: Statistic,
        node: &Node,
    ) -> Found<(Leaf, Dimension)> {
        let (measure, of) = check(node, self)?;
        let dimension = match row.gives {
            Gives::Follows(_) => of,
            gives => gives.of(false),
        };
        Ok((Leaf::Over(statistic, Box::new(measure)), dimension))
    }

    fn at(&mut self, measure: &Node, drive: &Node, place: &Node) -> Found<(Leaf, Dimension)> {
        let (measure, dimension) = check(measure, self)?;
        let (drive, of) = match drive.as_name() {
            Some("time") => (None, Dimension::TIME),
            _ => self.drive(drive).map(|(id, of)| (Some(id), of))?,
        };
        let unit = self.0.bare_unit(of);
        let parameters = &mut crate::read::value::Parameters(self.0);
        let (scalar, _) = check_as(place, parameters, of, &unit)?;
        let value = self.0.number(&scalar);
        if !value.is_finite() {
            return self.argument(
                place,
                "a finite value",
                "look for a division by zero".to_owned(),
            );
        }
        let value = match scalar.leaves().next() {
            Some(_) => scalar,
            None => crate::ids::Scalar::Const(value),
        };
        Ok((
            Leaf::Over(Statistic::At { drive, value }, Box::new(measure)),
            dimension,
        ))
    }

    /// A measure that has a derivative to a drive.
    fn of_the_pose(&mut self, node: &Node) -> Found<(Measure, Dimension)> {
        let found = check(node, self)?;
        let asks = nature(&found.0, &self.0.natures);
        if asks.inner {
            let message = "a pressure or a switch has no derivative to a drive";
            return Err(vec![
                Issue::new("no-derivative", node.span.clone(), message)
                    .with_label("asks for a pressure or a switch")
                    .with_help("its derivative in time is rate(…)"),
            ]);
        }
        if !asks.forces {
            return Ok(found);
        }
        Err(vec![
            Issue::new(
                "no-derivative",
                node.span.clone(),
                "a force or an energy has no derivative to a drive",
            )
            .with_label("asks for a force")
            .with_help("its derivative in time is rate(…)"),
        ])
    }

    /// The function is known and called in a way it is not.
    fn wrong<T>(&self, call: &Call<'_>) -> Found<T> {
        if bare(call.function).is_some() {
            let name = call.function;
            let message = format!("`{name}` is one of the whole mechanism and takes no arguments");
            return Err(vec![
                Issue::new("wrong-arguments", call.span.clone(), message)
                    .with_help(format!("write {name}, without brackets")),
            ]);
        }
        let signatures = Registry::find(call.function).map_or(Vec::new(), |m| m.signatures());
        let count = call.arguments.len();
        let plural = if count == 1 { "argument" } else { "arguments" };
        Err(vec![
            Issue::new(
                "wrong-arguments",
                call.span.clone(),
                format!("`{}` with {count} {plural}", call.function),
            )
            .with_help(format!("write it as {}", signatures.join(" or "))),
        ])
    }
}
