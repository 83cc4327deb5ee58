//! From a model and its poses to what the drawings need.

use kempe_draw::{
    ArcGuide, CurveGuide, DriveKind as DrivenPart, DriveView, Frame as DrawnFrame, Guide,
    JointView, LengthUnit, LinkView, LoadRole, LoadUnit, LoadUnits, LoadView, MechanismView,
    TraceView, Wheel,
};
use kempe_dynamics::{ForceArrow, Origin};
use kempe_mechanism::curve::LocalCurve;
use kempe_model::{
    Between, DriveKind, FRAME, JointKind, Line, LinkId, Model, MotionStudy, Plot, PointId, Scalar,
    SmoothCurve, ToothSize, value,
};
use kempe_number::math::atan2;
use kempe_units::Dimension;

use crate::result::{Frame, StudyResult};
use crate::unit::Units;

/// Points traced when no study names one: at most this many.
const MOST_TRACES: usize = 3;
/// A piece of a smooth curve is drawn as so many circular arcs.
const DRAWN_ARCS: usize = 16;

/// What is to be drawn of a model. Traced are the points that `study` plots the path of, or else the coupler points: those
/// that one moving link alone carries.
pub fn mechanism_view(model: &Model, study: Option<&MotionStudy>) -> MechanismView {
    let parameters: Vec<f64> = model.parameter_values();
    let length = &model.units.length;
    let index = |point: &PointId| point.index();
    let units = Units::of(model);
    let load_unit = |dimension| {
        let unit = units.unit(dimension);
        LoadUnit::new(unit.text(), unit.to_si(1.0))
    };
    let mut joints: Vec<JointView> = model
        .joints
        .iter()
        .filter_map(|joint| joint_view(model, &joint.kind, &parameters))
        .collect();
    for drive in &model.drives {
        if let DriveKind::Cylinder { a, b } = drive.kind {
            joints.push(JointView::Cylinder {
                a: a.point.index(),
                b: b.point.index(),
            });
        }
    }
    joints.extend(springs_and_dampers(model));
    MechanismView {
        title: model.title.clone(),
        length_unit: LengthUnit::new(length.name.clone(), length.factor),
        load_units: LoadUnits {
            force: load_unit(Dimension::FORCE),
            moment: load_unit(Dimension::TORQUE),
        },
        points: model.points.iter().map(|p| p.name.clone()).collect(),
        links: model
            .links
            .iter()
            .map(|link| LinkView {
                name: link.name.clone(),
                points: link.points.iter().map(|p| index(&p.point)).collect(),
            })
            .collect(),
        joints,
        traces: traced(model, study)
            .into_iter()
            .map(|point| TraceView {
                label: format!("path of {}", model.points[point.index()].name),
                point: point.index(),
            })
            .collect(),
        drives: drives(model, &parameters),
        dimensions: Vec::new(),
    }
}

/// Springs and dampers between points; those between links are not drawn.
fn springs_and_dampers(model: &Model) -> Vec<JointView> {
    let ends = |between: &Between| match between {
        Between::Points(a, b) => Some((a.point.index(), b.point.index())),
        Between::Links(..) => None,
    };
    let springs = model.actions.springs.iter();
    let springs = springs
        .filter_map(|s| ends(&s.between))
        .map(|(a, b)| JointView::Spring { a, b });
    let dampers = model.actions.dampers.iter();
    let dampers = dampers
        .filter_map(|d| ends(&d.between))
        .map(|(a, b)| JointView::Damper { a, b });
    springs.chain(dampers).collect()
}

fn guide(line: Line) -> Guide {
    Guide {
        link: line.link.index(),
        from: line.from.index(),
        to: line.to.index(),
    }
}

/// A smooth curve with places along it in the axes of its link.
fn curve_guide(model: &Model, on: &SmoothCurve, parameters: &[f64]) -> Option<CurveGuide> {
    let link = model.links.get(on.link.index())?;
    let places: Vec<[f64; 2]> = link.evaluate(parameters);
    let at = |point: &PointId| {
        let index = link.points.iter().position(|p| p.point == *point)?;
        places.get(index).copied()
    };
    let points: Vec<[f64; 2]> = on.through.iter().map(at).collect::<Option<_>>()?;
    let first = *points.first()?;
    let curve = LocalCurve::through(&points, on.closed);
    let along = curve.along(DRAWN_ARCS).into_iter().map(|on| {
        let at = [on.place[0] - first[0], on.place[1] - first[1]];
        (at, atan2(on.rate[1], on.rate[0]))
    });
    Some(CurveGuide {
        link: on.link.index(),
        through: on.through.iter().map(|p| p.index()).collect(),
        along: along.collect(),
        closed: on.closed,
    })
}

fn joint_view(model: &Model, kind: &JointKind, parameters: &[f64]) -> Option<JointView> {
    Some(match kind {
        JointKind::Slider { at, on, .. } => JointView::Slider {
            block: at.link.index(),
            at: at.point.index(),
            guide: guide(*on),
        },
        JointKind::Slot { pin, on } => JointView::Slot {
            pin: pin.point.index(),
            guide: guide(*on),
        },
        JointKind::ArcSlot { pin, on } => JointView::ArcSlot {
            pin: pin.point.index(),
            arc: ArcGuide {
                link: on.link.index(),
                from: on.from.index(),
                to: on.to.index(),
                radius: value(&on.radius, parameters),
                side: on.side.sign(),
                closed: on.closed,
            },
        },
        JointKind::CurveSlot { pin, on } => JointView::CurveSlot {
            pin: pin.point.index(),
            curve: curve_guide(model, on, parameters)?,
        },
        JointKind::Belt {
            a,
            b,
            arm,
            radius_a,
            radius_b,
            crossed,
            chain,
            ..
        } => {
            let wheel = |link: LinkId, radius: &Scalar| {
                Some(Wheel {
                    link: link.index(),
                    center: shared(model, link, *arm)?.index(),
                    radius: value(radius, parameters),
                    teeth: 0,
                })
            };
            JointView::Belt {
                a: wheel(*a, radius_a)?,
                b: wheel(*b, radius_b)?,
                crossed: *crossed,
                chain: *chain,
            }
        }
        JointKind::Weld { a, b, at, .. } => JointView::Weld {
            at: at.index(),
            links: [a.index(), b.index()],
        },
        JointKind::Gears {
            a,
            b,
            arm,
            teeth_a,
            teeth_b,
            internal,
            teeth,
            ..
        } => {
            let (center_a, center_b) = (shared(model, *a, *arm)?, shared(model, *b, *arm)?);
            let sizes = (value(teeth_a, parameters), value(teeth_b, parameters));
            let apart = distance_on(model, *arm, center_a, center_b, parameters)?;
            let (size_a, size_b): (f64, f64) = (sizes.0.abs(), sizes.1.abs());
            let ratio = apart
                / if *internal {
                    (size_a - size_b).abs()
                } else {
                    size_a + size_b
                };
            let wheel = |link: LinkId, center: PointId, size: f64| Wheel {
                link: link.index(),
                center: center.index(),
                radius: size * ratio,
                teeth: match teeth.size {
                    ToothSize::Counted => whole_teeth(size),
                    ToothSize::Module(_) => toothed(size * ratio, &teeth.size, parameters),
                },
            };
            JointView::Gears {
                a: wheel(*a, center_a, size_a),
                b: wheel(*b, center_b, size_b),
                internal: *internal,
            }
        }
        JointKind::Rack {
            rack,
            pinion,
            center,
            radius,
            side,
            teeth,
            ..
        } => {
            let radius = value(radius, parameters);
            JointView::Rack {
                link: rack.index(),
                pinion: Wheel {
                    link: pinion.index(),
                    center: center.index(),
                    radius,
                    teeth: toothed(radius, &teeth.size, parameters),
                },
                side: side.sign(),
            }
        }
    })
}

/// Teeth of a wheel of a radius by its module; none where that is not known, or leaves a part of a tooth.
fn toothed(radius: f64, size: &ToothSize, parameters: &[f64]) -> u32 {
    match size {
        ToothSize::Module(Some(module)) => {
            let count = 2.0 * radius / value::<f64>(module, parameters);
            // rounding of lengths leaves a little
            match (count - count.round()).abs() < 1e-6 {
                true => whole_teeth(count.round()),
                false => 0,
            }
        }
        _ => 0,
    }
}

/// Teeth of a wheel; none where the ratio is given by radii.
fn whole_teeth(count: f64) -> u32 {
    let teeth = count.round();
    if teeth == count && (4.0..=400.0).contains(&teeth) {
        teeth as u32
    } else {
        0
    }
}

/// A point that two links share.
pub(crate) fn shared(model: &Model, a: LinkId, b: LinkId) -> Option<PointId> {
    let found = model
        .points
        .iter()
        .position(|p| p.links.contains(&a) && p.links.contains(&b))?;
    Some(PointId(found as u32))
}

/// Distance of two points of a link, m.
fn distance_on(
    model: &Model,
    link: LinkId,
    a: PointId,
    b: PointId,
    parameters: &[f64],
) -> Option<f64> {
    let link = model.links.get(link.index())?;
    let places: Vec<[f64; 2]> = link.evaluate(parameters);
    let at = |point: PointId| {
        let index = link.points.iter().position(|p| p.point == point)?;
        places.get(index).copied()
    };
    let (a, b) = (at(a)?, at(b)?);
    Some(kempe_number::math::hypot(a[0] - b[0], a[1] - b[1]))
}

fn drives(model: &Model, parameters: &[f64]) -> Vec<DriveView> {
    let view = |drive: &kempe_model::Drive| {
        let kind = match drive.kind {
            DriveKind::Turn { link, relative_to } => DrivenPart::Turn {
                link: link.index(),
                about: pivot(model, link, relative_to)?.index(),
            },
            DriveKind::Cylinder { a, b } => DrivenPart::Extend {
                a: a.point.index(),
                b: b.point.index(),
            },
            DriveKind::Slide { joint } => {
                let (at, on) = model.joints.get(joint.index())?.kind.guide()?;
                DrivenPart::Slide {
                    at: at.point.index(),
                    guide: guide(on),
                }
            }
            DriveKind::Release { .. } | DriveKind::StandIn(_) => return None,
        };
        let (from, duration) = (
            drive.law.at(0.0, parameters),
            drive.law.duration::<f64>(parameters),
        );
        // The first way the drive goes counts; one that is held has no arrow.
        let steps = 64;
        let way = (1..=steps)
            .map(|k| {
                drive
                    .law
                    .at(duration * f64::from(k) / f64::from(steps), parameters)
                    - from
            })
            .find(|way| *way != 0.0)?;
        Some(DriveView {
            name: drive.name.clone(),
            kind,
            forward: way >= 0.0,
        })
    };
    model.drives.iter().filter_map(view).collect()
}

/// The point about which a link visibly turns: its pin on the other link, on the frame, or its first pin, or its first point.
pub(crate) fn pivot(model: &Model, link: LinkId, relative_to: LinkId) -> Option<PointId> {
    let own = &model.links.get(link.index())?.points;
    let first_pin = own
        .iter()
        .map(|p| p.point)
        .find(|p| model.points[p.index()].links.len() > 1);
    shared(model, link, relative_to)
        .or_else(|| shared(model, link, FRAME))
        .or(first_pin)
        .or_else(|| own.first().map(|p| p.point))
}

/// The points whose paths are drawn.
fn traced(model: &Model, study: Option<&MotionStudy>) -> Vec<PointId> {
    let mut points: Vec<PointId> = Vec::new();
    let mut add = |study: &MotionStudy| {
        for plot in &study.plots {
            if let Plot::Path(point) = plot
                && !points.contains(point)
            {
                points.push(*point);
            }
        }
    };
    match study {
        Some(study) => add(study),
        None => model.studies.iter().for_each(|s| add(s.kind.along())),
    }
    if points.is_empty() {
        let guides: Vec<PointId> = model
            .joints
            .iter()
            .flat_map(|j| match &j.kind {
                JointKind::ArcSlot { on, .. } => vec![on.from, on.to],
                JointKind::CurveSlot { on, .. } => on.through.clone(),
                kind => (kind.guide()).map_or_else(Vec::new, |(_, on)| vec![on.from, on.to]),
            })
            .collect();
        let free = model.points.iter().enumerate().filter(|(index, p)| {
            matches!(p.links.as_slice(), [link] if *link != FRAME)
                && !guides.contains(&PointId(*index as u32))
                && !on_ground_bar(model, p.links.first().copied())
        });
        points = free
            .take(MOST_TRACES)
            .map(|(index, _)| PointId(index as u32))
            .collect();
    }
    points
}

/// Whether a link is pinned to the frame, so that its points only draw arcs.
fn on_ground_bar(model: &Model, link: Option<LinkId>) -> bool {
    link.is_some_and(|link| shared(model, link, FRAME).is_some())
}

/// The poses of a study for drawing, each labelled with where it is; with what acts on them where forces were asked for.
pub fn drawing_frames(model: &Model, result: &StudyResult) -> Vec<DrawnFrame> {
    let abscissa = result.abscissa();
    result
        .frames
        .iter()
        .enumerate()
        .map(|(row, frame)| {
            let label = abscissa.map(|column| {
                let at = column.values.get(row).copied().unwrap_or(f64::NAN);
                let digits = kempe_number::text::significant(at, 6);
                format!("{} = {digits} {}", column.name, column.unit.text())
            });
            drawn(
                model,
                frame,
                label.unwrap_or_default().trim_end().to_owned(),
            )
        })
        .collect()
}

/// A pose for drawing, with what acts in it.
pub fn drawn(model: &Model, frame: &Frame, label: String) -> DrawnFrame {
    let pose = DrawnFrame {
        points: frame.points.clone(),
        links: frame.links.clone(),
        label,
        ..DrawnFrame::default()
    };
    pose.with_loads(frame.arrows.iter().map(|a| load_view(model, a)).collect())
}

/// An arrow: of a joint it names the link that feels it, otherwise what it comes from.
fn load_view(model: &Model, arrow: &ForceArrow) -> LoadView {
    let link =
        || (model.links.get(arrow.link.index())).map_or_else(String::new, |l| l.name.clone());
    let (role, label) = match arrow.origin {
        Origin::Joint => (LoadRole::Reaction, format!("on {}", link())),
        Origin::Drive => (LoadRole::Drive, arrow.name.clone()),
        Origin::Load => (LoadRole::Load, arrow.name.clone()),
        Origin::Weight => (LoadRole::Weight, String::new()),
        Origin::Spring | Origin::Damper => (LoadRole::Spring, arrow.name.clone()),
    };
    LoadView {
        at: arrow.place,
        vector: arrow.force,
        moment: arrow.moment,
        role,
        label,
    }
}
