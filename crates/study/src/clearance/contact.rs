//! Studies of clearance in which contact is lost: the mechanism moves in time with its joints let go, whose bodies touch and part.

use kempe_mechanism::Design;
use kempe_model::{Contact, ContactStudy, Diagnostic, DriveKind, Model, Released, Severity};
use kempe_motion::progress::Progress;
use kempe_simulate::{Happened, Place, Simulated};
use kempe_units::{Dimension, Unit};

use super::columns::{Deviation, deviation_of};
use super::findings::refuses;
use super::joints::joint_name;
use super::prepared::WithContacts;
use super::summary;
use crate::along::Along;
use crate::columns::Asked;
use crate::prepared::motion;
use crate::quantity::Quantity;
use crate::result::{ContactMet, Figure, Listing, StudyResult, TouchMet};
use crate::rows::RowPlace;
use crate::shows::Shows;
use crate::simulation::{findings_of_simulation, place_name, simulation};
use crate::table::Column;
use crate::unit::Units;
use crate::words::cut;

/// At most so many contacts are listed.
const LISTED: usize = 30;

/// Runs a study of clearance in which contact is lost; with what the simulation found.
pub(crate) fn contact(
    model: &Model,
    name: &str,
    study: &ContactStudy,
    progress: &mut dyn Progress,
) -> Result<(StudyResult, Simulated), Vec<Diagnostic>> {
    let prepared = WithContacts::new(model, name, study)?;
    let (model, contacts) = (prepared.model(), &*prepared.contacts);
    let (mut result, found) = match simulation(model, name, &study.motion, contacts, progress) {
        Ok(found) => found,
        Err(refused) => return Err([refused, prepared.findings].concat()),
    };
    let units = Units::of(model);
    let times = (result.table.columns.first()).map_or(Vec::new(), Column::si);
    let touching = (contacts.iter().enumerate())
        .map(|(index, contact)| touching(model, contact, index, &found, &times));
    let touching: Vec<Column> = touching.collect();
    result.figures.extend(orbits(model, contacts, &result));
    // Where a drive is let go the ideal mechanism would go another way.
    if study.motion.released.is_empty() {
        // Pressures and switches are in the ideal motion what they were with play: it moves under the same loads.
        let ideal = &prepared.design;
        let inner = found.inner_laws_of(&ideal.mechanism.model);
        let ideal = ideal.with_inner_laws(inner);
        let progress = &mut Shows::new(progress, false);
        let deviations = deviations(&ideal, study, &mut result, progress);
        let columns = deviations.iter().map(|it| it.deviation.clone());
        result.table.columns.extend(columns);
        let scalars = summary::scalars(&deviations, &result.table, 0);
        result.scalars.extend(scalars);
    }
    result.table.columns.extend(touching);
    let all = met(model, contacts, &found);
    let counted = counted(model, contacts, &all, &units, &found);
    result.listings.push(counted);
    result.listings.extend(listed(&all, &units));
    result.contacts = all;
    result.diagnostics.extend(prepared.findings);
    Ok((result, found))
}

/// What is to be told of such a study before anything moves; `no_ideal` says why the drives' laws move nothing, where they do not.
pub(crate) fn findings_of_contact(
    model: &Model,
    name: &str,
    study: &ContactStudy,
    no_ideal: Option<Diagnostic>,
    progress: &mut dyn Progress,
) -> Vec<Diagnostic> {
    let prepared = match WithContacts::new(model, name, study) {
        Ok(prepared) => prepared,
        Err(refused) => return refused,
    };
    let (model, contacts) = (prepared.model(), &*prepared.contacts);
    let mut findings = findings_of_simulation(model, name, &study.motion, contacts, progress);
    if study.motion.released.is_empty()
        && !refuses(&findings)
        && let Some(why) = no_ideal
    {
        findings.push(no_ideal_motion(name, &[why]));
    }
    findings.extend(prepared.findings);
    findings
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

/// How far every column is from that of the motion without clearance at the same times; the result tells where there is none.
fn deviations(
    design: &Design<f64>,
    study: &ContactStudy,
    result: &mut StudyResult,
    progress: &mut dyn Progress,
) -> Vec<Deviation> {
    let asked = Asked::of_forces(&design.mechanism, &study.motion.along);
    let quantities: Vec<&Quantity> = asked.columns.iter().collect();
    let times = (result.table.columns.first()).map_or(Vec::new(), Column::si);
    let rows = match ideal_rows(design, &quantities, &times, progress) {
        Ok(rows) => rows,
        Err(why) => {
            result.diagnostics.push(no_ideal_motion(&result.name, &why));
            return Vec::new();
        }
    };
    let missed = times.iter().zip(&rows);
    let missed = missed.filter(|(_, row)| !row.is_empty() && row.iter().all(|x| x.is_nan()));
    let missed: Vec<f64> = missed.map(|(time, _)| *time).collect();
    let units = Units::of(&design.mechanism.model);
    (result.diagnostics).extend(rows_without_ideal(&result.name, &units, &missed));
    let of = |(index, quantity): (usize, &&Quantity)| {
        let value = result.table.column(&quantity.name)?.clone();
        let ideal: Vec<f64> = rows.iter().map(|row| row[index]).collect();
        Some(deviation_of(&design.mechanism, quantity, value, &ideal))
    };
    quantities.iter().enumerate().filter_map(of).collect()
}

/// Values (SI) of the motion without clearance at some times, s.
fn ideal_rows(
    design: &Design<f64>,
    quantities: &[&Quantity],
    times: &[f64],
    progress: &mut dyn Progress,
) -> Result<Vec<Vec<f64>>, Vec<Diagnostic>> {
    let ideal = motion(design, progress)?;
    let places: Vec<RowPlace> = times.iter().map(|t| RowPlace::Time(*t)).collect();
    let model = &design.mechanism.model;
    let mut sampler = Along::with_progress(model, &ideal, quantities, true, &places, progress)?;
    Ok(places.iter().map(|place| sampler.values(*place)).collect())
}

/// That no deviations are told: why there is no motion without play.
fn no_ideal_motion(name: &str, why: &[Diagnostic]) -> Diagnostic {
    let message =
        format!("study `{name}`: without play there is no motion to tell deviations from");
    let errors = why.iter().filter(|d| d.severity == Severity::Error);
    let warning = errors.fold(
        Diagnostic::warning("no-ideal-motion", message),
        |warning, error| warning.note(error.message.clone()),
    );
    warning.help("let a drive go by `release`: then no deviations are asked for")
}

/// That the motion without play does not come to some of the times, s.
fn rows_without_ideal(name: &str, units: &Units, missed: &[f64]) -> Option<Diagnostic> {
    let (first, last) = (missed.first()?, missed.last()?);
    let rows = match missed {
        [one] => format!("the row at {} has", units.text(*one, Dimension::TIME)),
        _ => {
            let range = units.range_text((*first, *last), Dimension::TIME);
            format!("{} rows from {range} have", missed.len())
        }
    };
    let message =
        format!("study `{name}`: {rows} no deviations: without play the drives do not go there");
    Some(
        Diagnostic::warning("no-ideal-motion", message)
            .help("let the drives go where the mechanism goes without play, too"),
    )
}

/// All impacts and touches, in order of time.
fn met(model: &Model, contacts: &[Contact], found: &Simulated) -> Vec<ContactMet> {
    let named = |at: Place| {
        let joint = contacts.get(at.contact).map(|c| c.joint.into());
        let joint = joint.map_or(String::new(), |joint| joint_name(model, joint));
        (joint, place_name(model, contacts, at))
    };
    let soft = found.touched.iter().map(|it| {
        let (joint, place) = named(it.at);
        ContactMet {
            joint,
            place,
            time: it.touching.from,
            speed: it.touching.speed,
            speed_after: it.parting,
            touch: Some(TouchMet {
                until: it.touching.to,
                force: it.force[0],
                depth: it.depth[0],
            }),
        }
    });
    let rigid = found.happenings.iter().filter_map(|it| match it.what {
        Happened::Strikes {
            stop,
            before,
            after,
        } => {
            let (joint, place) = named(found.place_of(stop)?);
            Some(ContactMet {
                joint,
                place,
                time: it.time,
                speed: -before,
                speed_after: Some(after),
                touch: None,
            })
        }
        _ => None,
    });
    let mut all: Vec<ContactMet> = soft.chain(rigid).collect();
    all.sort_by(|a, b| a.time.total_cmp(&b.time));
    all
}

/// How often, how long and how hard each joint touches.
fn counted(
    model: &Model,
    contacts: &[Contact],
    all: &[ContactMet],
    units: &Units,
    found: &Simulated,
) -> Listing {
    let rows = contacts.iter().enumerate().map(|(index, contact)| {
        let name = joint_name(model, contact.joint.into());
        let own: Vec<&ContactMet> = all.iter().filter(|met| met.joint == name).collect();
        let fastest = own.iter().map(|met| met.speed).fold(0.0, f64::max);
        let touches = || {
            let touches = own.iter().copied();
            touches.filter_map(|met| Some((met.time, met.touch.as_ref()?)))
        };
        let force = touches().map(|(_, touch)| touch.force).fold(0.0, f64::max);
        // Impacts at once take no time; what rests does.
        let rests = found.held.iter().filter(|held| {
            let places = held.stops.iter().filter_map(|stop| found.place_of(*stop));
            places.map(|at| at.contact).any(|contact| contact == index)
        });
        let rests = rests.map(|held| [held.from, held.to]);
        let touching = touches().map(|(from, touch)| [from, touch.until]);
        let lasts = covered(touching.chain(rests).collect());
        let or_none = |known: bool, text: String| if known { text } else { "-".to_owned() };
        vec![
            name,
            own.len().to_string(),
            or_none(
                !own.is_empty(),
                units.text(fastest, Dimension::LENGTH / Dimension::TIME),
            ),
            or_none(
                touches().next().is_some(),
                units.text(force, Dimension::FORCE),
            ),
            or_none(
                found.end > 0.0,
                format!("{:.1} %", 100.0 * lasts / found.end),
            ),
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

/// How long any of some times lasts.
fn covered(mut times: Vec<[f64; 2]>) -> f64 {
    times.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let (mut sum, mut until) = (0.0, f64::NEG_INFINITY);
    for [from, to] in times {
        sum += (to - from.max(until)).max(0.0);
        until = until.max(to);
    }
    sum
}

/// The contacts one by one.
fn listed(all: &[ContactMet], units: &Units) -> Option<Listing> {
    let time = |t: f64| units.text(t, Dimension::TIME);
    let speed = |v: f64| units.text(v, Dimension::LENGTH / Dimension::TIME);
    let none = || "-".to_owned();
    let rows = all.iter().map(|met| {
        let touch = met.touch.as_ref();
        vec![
            time(met.time),
            met.place.clone(),
            speed(met.speed),
            met.speed_after.map_or_else(none, speed),
            touch.map_or_else(none, |t| time(t.until - met.time)),
            touch.map_or_else(none, |t| units.text(t.force, Dimension::FORCE)),
            touch.map_or_else(none, |t| units.text(t.depth, Dimension::LENGTH)),
        ]
    });
    let rows = cut(rows.collect(), LISTED);
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
