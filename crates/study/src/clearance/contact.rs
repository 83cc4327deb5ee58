//! Studies of clearance in which contact is lost: the mechanism moves in time with its joints let go, whose bodies touch and part.

use kempe_dynamics::Acting;
use kempe_dynamics::clearance::Play;
use kempe_mechanism::Mechanism;
use kempe_mechanism::constraint::Source;
use kempe_model::{
    ClearanceAt, Contact, ContactProperties, ContactStates, ContactStudy, Diagnostic, DriveKind,
    Model, Released,
};
use kempe_motion::progress::Progress;
use kempe_simulate::{Happened, Simulated, Touched};
use kempe_units::{Dimension, Unit};

use super::columns::{Deviation, deviation_of};
use super::joints::{Joints, joint_name, not_released, of};
use super::summary;
use crate::along::{Along, force_problems};
use crate::columns::Asked;
use crate::motion_findings::refused;
use crate::prepared::{design, motion};
use crate::quantity::Quantity;
use crate::result::{Figure, Listing, StudyResult};
use crate::rows::RowPlace;
use crate::simulation::{place_name, simulation};
use crate::table::Column;
use crate::unit::Units;

/// At most so many contacts are listed.
const LISTED: usize = 30;

/// Runs a study of clearance in which contact is lost.
pub(crate) fn contact(
    model: &Model,
    name: &str,
    study: &ContactStudy,
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    let (joints, contacts) = prepared(model, study)?;
    let (mut result, found) = simulation(model, name, &study.motion, &contacts, progress)?;
    result.diagnostics.extend(joints.left_out(model));
    let units = Units::of(model);
    let times = (result.table.columns.first()).map_or(Vec::new(), Column::si);
    let touching = (contacts.iter().enumerate())
        .map(|(index, contact)| touching(model, contact, index, &found, &times));
    let touching: Vec<Column> = touching.collect();
    result.figures.extend(orbits(model, &contacts, &result));
    // Where a drive is let go the ideal mechanism would go another way.
    if study.motion.released.is_empty() {
        let deviations = deviations(model, study, &result, progress)?;
        let columns = deviations.iter().map(|it| it.deviation.clone());
        result.table.columns.extend(columns);
        let scalars = summary::scalars(&deviations, &result.table, 0);
        result.scalars.extend(scalars);
    }
    result.table.columns.extend(touching);
    result
        .listings
        .push(counted(model, &contacts, &units, &found));
    result
        .listings
        .extend(listed(model, &contacts, &units, &found));
    Ok(result)
}

/// What is to be told of such a study before anything moves.
pub(crate) fn findings_of_contact(model: &Model, study: &ContactStudy) -> Vec<Diagnostic> {
    match prepared(model, study) {
        Ok((joints, _)) => joints.left_out(model).into_iter().collect(),
        Err(refused) => refused,
    }
}

/// The joints with play and the contacts that they make, if these can be counted.
fn prepared(
    model: &Model,
    study: &ContactStudy,
) -> Result<(Joints, Vec<Contact>), Vec<Diagnostic>> {
    let design = design(model);
    let joints = Joints::new(&design.mechanism, &design.parameters);
    if !joints.refused.is_empty() {
        return Err(joints.refused);
    }
    let contacts = contacts(&design.mechanism, &joints.plays, study.states);
    if contacts.is_empty() {
        let error = Diagnostic::error("no-clearance-there", "no joint has any play to move in")
            .help("give a clearance that is not zero: [clearance] B = { radial = \"50 um\" }");
        return Err(vec![match model.clearances.first() {
            Some(first) => error.at(first.span.clone(), ""),
            None => error,
        }]);
    }
    let open = kempe_simulate::with_play(&design, &contacts)
        .map_err(|why| vec![not_released(&design.mechanism, why)])?;
    Acting::new(&open.mechanism, &open.geometry, &open.parameters).map_err(force_problems)?;
    Ok((joints, contacts))
}

/// The contacts that the file's clearances make.
fn contacts(mechanism: &Mechanism, plays: &[Play], states: ContactStates) -> Vec<Contact> {
    let clearances = &mechanism.model.clearances;
    let of_all = clearances.iter().find(|c| c.at == ClearanceAt::All);
    let others = of_all.map_or_else(ContactProperties::default, |c| c.contact.clone());
    let contact = |play: &Play| {
        let entry = of(mechanism, play.joint)?;
        let joint = match play.joint {
            Source::Pin { point, link } => Released::Pin { point, link },
            Source::Joint(id) => Released::Joint(id),
            Source::Drive(_) => return None,
        };
        Some(Contact {
            joint,
            clearance: play.radial,
            properties: entry.contact.or(&others),
            states,
            touches: Vec::new(),
            span: entry.span.clone(),
        })
    };
    plays.iter().filter_map(contact).collect()
}

/// At how many places the bodies of a joint touch in every row.
fn touching(
    model: &Model,
    contact: &Contact,
    index: usize,
    found: &Simulated,
    times: &[f64],
) -> Column {
    let soft = |time: f64| {
        let own = found.touched.iter().filter(|t| t.at.contact == index);
        own.filter(|t| t.lasts_at(time)).count()
    };
    let rigid = |time: f64| {
        let held = found.held.iter().filter(|held| held.holds_at(time));
        let stops_of = held.flat_map(|held| &held.stops);
        let places = stops_of.filter_map(|stop| found.place_of(*stop));
        places.filter(|at| at.contact == index).count()
    };
    let name = joint_name(model, contact.joint.into());
    Column {
        values: (times.iter())
            .map(|time| (soft(*time) + rigid(*time)) as f64)
            .collect(),
        ..Column::new(format!("{name} touching"), Unit::one())
    }
}

/// Where the centres of pins go in their bores.
fn orbits(model: &Model, contacts: &[Contact], result: &StudyResult) -> Vec<Figure> {
    let pins = contacts
        .iter()
        .filter(|c| matches!(c.joint, Released::Pin { .. }));
    let figures = pins.filter_map(|contact| {
        let name = joint_name(model, contact.joint.into());
        let axis = |row| {
            let kind = DriveKind::Release {
                of: contact.joint,
                row,
            };
            let name = kind.released_name(model)?;
            result.table.column(&name).cloned()
        };
        Some(Figure::Hodograph(
            format!("orbit of {name}"),
            [axis(0)?, axis(1)?],
        ))
    });
    figures.collect()
}

/// How far every column is from that of the motion without clearance at the same times.
fn deviations(
    model: &Model,
    study: &ContactStudy,
    result: &StudyResult,
    progress: &mut dyn Progress,
) -> Result<Vec<Deviation>, Vec<Diagnostic>> {
    let design = design(model);
    let ideal = motion(&design, progress)?;
    if refused(&ideal) {
        return Ok(Vec::new());
    }
    let asked = Asked::of_forces(&design.mechanism, &study.motion.along);
    let quantities: Vec<&Quantity> = asked.columns.iter().collect();
    let times = (result.table.columns.first()).map_or(Vec::new(), Column::si);
    let places: Vec<RowPlace> = times.iter().map(|t| RowPlace::Time(*t)).collect();
    let mut sampler = Along::with_progress(model, &ideal, &quantities, true, &places, progress)?;
    let rows: Vec<Vec<f64>> = places.iter().map(|place| sampler.values(*place)).collect();
    let of = |(index, quantity): (usize, &&Quantity)| {
        let value = result.table.column(&quantity.name)?.clone();
        let ideal: Vec<f64> = rows.iter().map(|row| row[index]).collect();
        Some(deviation_of(&design.mechanism, quantity, value, &ideal))
    };
    Ok(quantities.iter().enumerate().filter_map(of).collect())
}

/// An impact or a touch, for the lists.
struct Met {
    at: kempe_simulate::Place,
    time: f64,
    speed: f64,
    parting: Option<f64>,
    touch: Option<Touched>,
}

/// All impacts and touches, in order of time.
fn met(found: &Simulated) -> Vec<Met> {
    let soft = found.touched.iter().map(|touch| Met {
        at: touch.at,
        time: touch.touching.from,
        speed: touch.touching.speed,
        parting: touch.parting,
        touch: Some(*touch),
    });
    let rigid = found.happenings.iter().filter_map(|it| match it.what {
        Happened::Strikes {
            stop,
            before,
            after,
        } => Some(Met {
            at: found.place_of(stop)?,
            time: it.time,
            speed: -before,
            parting: Some(after),
            touch: None,
        }),
        _ => None,
    });
    let mut all: Vec<Met> = soft.chain(rigid).collect();
    all.sort_by(|a, b| a.time.total_cmp(&b.time));
    all
}

/// How often, how long and how hard each joint touches.
fn counted(model: &Model, contacts: &[Contact], units: &Units, found: &Simulated) -> Listing {
    let all = met(found);
    let rows = contacts.iter().enumerate().map(|(index, contact)| {
        let own: Vec<&Met> = all.iter().filter(|met| met.at.contact == index).collect();
        let fastest = own.iter().map(|met| met.speed).fold(0.0, f64::max);
        let touches = || own.iter().filter_map(|met| met.touch.as_ref());
        let force = touches().map(|touch| touch.force[0]).fold(0.0, f64::max);
        let lasts = covered(touches().map(|t| [t.touching.from, t.touching.to]));
        let or_none = |known: bool, text: String| if known { text } else { "-".to_owned() };
        let gives = touches().next().is_some();
        vec![
            joint_name(model, contact.joint.into()),
            own.len().to_string(),
            or_none(
                !own.is_empty(),
                units.text(fastest, Dimension::LENGTH / Dimension::TIME),
            ),
            or_none(gives, units.text(force, Dimension::FORCE)),
            or_none(gives, format!("{:.1} %", 100.0 * lasts / found.end)),
        ]
    });
    Listing {
        title: "Contacts".to_owned(),
        head: [
            "joint",
            "contacts",
            "fastest",
            "largest force",
            "of the time",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows: rows.collect(),
    }
}

/// How long any of some times lasts that begin one after the other.
fn covered(times: impl Iterator<Item = [f64; 2]>) -> f64 {
    let (mut sum, mut until) = (0.0, f64::NEG_INFINITY);
    for [from, to] in times {
        sum += (to - from.max(until)).max(0.0);
        until = until.max(to);
    }
    sum
}

/// The contacts one by one.
fn listed(
    model: &Model,
    contacts: &[Contact],
    units: &Units,
    found: &Simulated,
) -> Option<Listing> {
    let all = met(found);
    let time = |t: f64| units.text(t, Dimension::TIME);
    let speed = |v: f64| units.text(v, Dimension::LENGTH / Dimension::TIME);
    let none = || "-".to_owned();
    let rows = all.iter().take(LISTED).map(|met| {
        let touch = met.touch.as_ref();
        vec![
            time(met.time),
            place_name(model, contacts, met.at),
            speed(met.speed),
            met.parting.map_or_else(none, speed),
            touch.map_or_else(none, |t| time(t.touching.to - t.touching.from)),
            touch.map_or_else(none, |t| units.text(t.force[0], Dimension::FORCE)),
            touch.map_or_else(none, |t| units.text(t.depth[0], Dimension::LENGTH)),
        ]
    });
    let mut rows: Vec<Vec<String>> = rows.collect();
    let more = all.len().saturating_sub(LISTED);
    if more > 0 {
        rows.push(vec!["…".to_owned(), format!("and {more} more")]);
    }
    let head = [
        "time",
        "where",
        "speed",
        "speed after",
        "lasts",
        "largest force",
        "deepest",
    ];
    (!rows.is_empty()).then(|| Listing {
        title: "Contact by contact".to_owned(),
        head: head.map(str::to_owned).to_vec(),
        rows,
    })
}
