//! The frequencies along the motion of the drives that are held: at every row they stand still, or move on by their laws, and what is let go
//! vibrates.

use std::f64::consts::TAU;

use kempe_dynamics::NoModes;
use kempe_dynamics::modes::Mode;
use kempe_model::{Diagnostic, Drive, DriveId, Model};
use kempe_motion::{Done, Progress, Stage};
use kempe_number::Jet;
use kempe_number::text::significant;
use kempe_units::{Dimension, Unit};

use super::bench::{Bench, Failure, why_unsettled};
use super::shapes::in_words;
use crate::missing::row_warnings;
use crate::motion::goes_one_way;
use crate::result::{Figure, Frame, StudyResult};
use crate::rows::{RowPlace, places};
use crate::table::{Column, Table};
use crate::unit::shown;

/// What each mode has a column of.
const OF_MODE: [(&str, &str); 3] = [
    ("frequency", "Hz"),
    ("damping_ratio", ""),
    ("growth", "1/s"),
];

/// Rates have no more digits, in parts of the largest.
const ROUNDING: f64 = 1e-12;
/// Digits of how fast something grows.
const FEW_DIGITS: usize = 4;

/// What a row says that has none.
const NO_VIBRATIONS: &str = "no vibrations";

pub(super) fn along(
    mut bench: Bench<'_>,
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    let (model, study) = (bench.model, bench.study);
    let parameters = bench.design.parameters.clone();
    let moving: Vec<DriveId> = (0..model.drives.len() as u32)
        .map(DriveId)
        .filter(|d| !(study.settles && study.release.contains(d)))
        .filter(|d| {
            let (low, high) = model.drives[d.index()].law.extent(&parameters);
            low < high
        })
        .collect();
    let stepped = moving.first().copied().unwrap_or(DriveId(0));
    let rows = places(model, &study.along.rows, &parameters, stepped.index());
    let mut columns = vec![Column::new("time", bench.units.unit(Dimension::TIME))];
    for drive in &model.drives {
        columns.push(Column::new(
            drive.name.clone(),
            bench.units.unit(drive.dimension),
        ));
    }
    let fixed = columns.len();
    let count = study.release.len();
    for mode in 1..=count {
        for (name, unit) in OF_MODE {
            let unit = Unit::parse(unit).unwrap_or_else(|_| Unit::one());
            columns.push(Column::new(format!("{name}_{mode}"), unit));
        }
    }
    let mut table = Table {
        name: bench.name.to_owned(),
        columns,
        places: fixed,
        closure: Vec::new(),
        smallest_singular_value: Vec::new(),
        forces: None,
        balance: None,
        notes: Vec::new(),
    };
    let mut frames: Vec<Frame> = Vec::new();
    let total = rows.len();
    for (done, row) in rows.iter().enumerate() {
        let time = match *row {
            RowPlace::Time(time) => time,
            RowPlace::Drive(at) => {
                let law = &model.drives[stepped.index()].law;
                law.first_time(at, &parameters).unwrap_or(f64::NAN)
            }
        };
        let mut to = bench.stance.coordinates().to_vec();
        for drive in &moving {
            to[drive.index()] = match *row {
                RowPlace::Drive(at) if *drive == stepped => at,
                _ => model.drives[drive.index()].law.at(time, &parameters),
            };
        }
        let reached = bench.stance.go(&to);
        if study.moving {
            bench
                .lineariser
                .let_move(rates(model, &moving, time, &parameters));
        }
        let (note, modes) = match reached {
            true => {
                // Each row settles: that is part of the rows, and stops with them.
                let part = Done::Of(done, total);
                let mut within = |_: Stage, _: Done| progress.reached(Stage::Rows, part);
                match row_modes(&mut bench, time, &mut within) {
                    Ok(found) => found,
                    Err(why) if done == 0 => return Err(vec![bench.failed(why)]),
                    Err(_) => break,
                }
            }
            false => (
                Some("the mechanism cannot be led here from the row before".to_owned()),
                Vec::new(),
            ),
        };
        table.columns[0].values.push(time);
        for (k, column) in table.columns[1..fixed].iter_mut().enumerate() {
            let free = study.release.iter().any(|d| d.index() == k);
            let q = match (reached, free) {
                (true, _) => bench.stance.coordinates()[k],
                (false, true) => f64::NAN,
                (false, false) => to[k],
            };
            column.values.push(shown(q, &column.unit));
        }
        for mode in 0..count {
            let values = modes
                .get(mode)
                .map_or([f64::NAN; 3], |m| match study.moving {
                    true => [
                        m.damped_angular_frequency() / TAU,
                        unless_rounding(m.ratio_of_rates().unwrap_or(f64::NAN), 1.0),
                        unless_rounding(m.growth(), m.damped_angular_frequency()),
                    ],
                    false => [
                        m.angular_frequency().map_or(f64::NAN, |w| w / TAU),
                        m.damping_ratio().unwrap_or(f64::NAN),
                        m.growth(),
                    ],
                });
            for (k, value) in values.into_iter().enumerate() {
                table.columns[fixed + OF_MODE.len() * mode + k]
                    .values
                    .push(value);
            }
        }
        let evidence = reached.then(|| bench.stance.evidence());
        table.closure.push(evidence.map_or(f64::NAN, |e| e.closure));
        let singular = evidence.map_or(f64::NAN, |e| e.smallest_singular_value);
        table.smallest_singular_value.push(singular);
        table.notes.push(note);
        frames.push(match reached {
            true => Bench::frame(&bench.stance),
            false => nowhere(&bench),
        });
        if progress
            .reached(Stage::Rows, Done::Of(done + 1, total))
            .is_break()
        {
            break;
        }
    }
    let along = match moving.as_slice() {
        [one] if goes_one_way(&model.drives[one.index()], &parameters) => 1 + one.index(),
        _ => 0,
    };
    let name = bench.name;
    let assemblies = (
        bench.motion.assemblies.list.len(),
        bench.motion.assemblies.rejected,
    );
    let mut diagnostics = bench.told();
    diagnostics.extend(row_warnings(name, &table, along));
    diagnostics.extend(noted(name, &table));
    Ok(StudyResult {
        name: name.to_owned(),
        figures: figures(&table, fixed),
        table,
        scalars: Vec::new(),
        beside: Vec::new(),
        contacts: Vec::new(),
        happenings: Vec::new(),
        listings: Vec::new(),
        frames,
        shapes: Vec::new(),
        designs: Vec::new(),
        events: Vec::new(),
        along,
        assemblies,
        diagnostics,
        demanded_rows: total,
        stopped_at: None,
    })
}

/// Speeds and accelerations of all drives at a time: of what does not move by its law, none.
fn rates(model: &Model, moving: &[DriveId], time: f64, parameters: &[f64]) -> Vec<[f64; 2]> {
    let of = |(index, drive): (usize, &Drive)| {
        if !moving.iter().any(|d| d.index() == index) {
            return [0.0; 2];
        }
        // At the end of its law it moves as it came there.
        let last = drive.law.duration(parameters).next_down();
        let at: Jet<f64, 3> = drive
            .law
            .at(Jet::variable(time.min(last)), &constants(parameters));
        [at.derivative(1), at.derivative(2)]
    };
    model.drives.iter().enumerate().map(of).collect()
}

/// A value, or 0 where it is rounding beside a size.
fn unless_rounding(value: f64, size: f64) -> f64 {
    if value.abs() <= ROUNDING * size {
        0.0
    } else {
        value
    }
}

fn constants(parameters: &[f64]) -> Vec<Jet<f64, 3>> {
    parameters.iter().map(|x| Jet::constant(*x)).collect()
}

/// The modes of a row and what is to be said of them; an error only where it was stopped.
fn row_modes(
    bench: &mut Bench<'_>,
    time: f64,
    progress: &mut dyn Progress,
) -> Result<(Option<String>, Vec<Mode>), Failure> {
    let it = match bench.settled(time, progress) {
        Ok(it) => it,
        Err(why @ Failure::Stopped) => return Err(why),
        Err(Failure::NoModes(why)) => {
            let why = match why {
                NoModes::NoMass(_) => "a drive that is let go moves no mass",
                NoModes::NoValue => "a force has no finite value, as at a dead point",
            };
            return Ok((Some(format!("{NO_VIBRATIONS}: {why}")), Vec::new()));
        }
    };
    bench.tell_kinks("in a row");
    let mut said = Vec::new();
    if let Some(why) = it.unsettled {
        said.push(format!("no equilibrium: {}", why_unsettled(why)));
    } else if !bench.is_balanced(&it.linearised) {
        said.push("not in equilibrium".to_owned());
    }
    let mut modes = it.modes;
    if bench.study.moving {
        let swings = Mode::damped_angular_frequency;
        modes.sort_by(|a, b| swings(a).total_cmp(&swings(b)));
        let grow = modes.iter().enumerate().filter(|(_, m)| m.grows());
        said.extend(grow.map(|(k, m)| {
            let time = significant(1.0 / m.growth(), FEW_DIGITS);
            format!("mode {}: unstable, it grows by e in {time} s", k + 1)
        }));
    } else {
        let special =
            (modes.iter().enumerate()).filter(|(_, m)| m.growth() > 0.0 || m.square <= 0.0);
        said.extend(special.map(|(k, m)| format!("mode {}: {}", k + 1, in_words(m))));
    }
    Ok(((!said.is_empty()).then(|| said.join("; ")), modes))
}

fn nowhere(bench: &Bench<'_>) -> Frame {
    let mut frame = Bench::frame(&bench.stance);
    frame.links.fill([f64::NAN; 3]);
    frame.points.fill([f64::NAN; 2]);
    frame
}

/// All frequencies in one picture, and the damping ratios where something damps.
fn figures(table: &Table, fixed: usize) -> Vec<Figure> {
    let of = |which: usize| -> Vec<Column> {
        let own = table.columns.iter().skip(fixed + which);
        own.step_by(OF_MODE.len()).cloned().collect()
    };
    let damped = |c: &Column| c.values.iter().any(|v| *v > 0.0);
    let mut figures = vec![of(0)];
    figures.extend(Some(of(1)).filter(|columns| columns.iter().any(damped)));
    figures
        .into_iter()
        .map(|curves| Figure::Curves {
            curves,
            limits: Vec::new(),
        })
        .collect()
}

/// Warns of rows without equilibrium, and of unstable ones.
fn noted(name: &str, table: &Table) -> Vec<Diagnostic> {
    let rows = |part: &str| {
        let notes = table.notes.iter().flatten();
        notes.filter(|note| note.contains(part)).count()
    };
    let mut found = Vec::new();
    let of = |count: usize| format!("{count} of {} rows of study `{name}`", table.rows());
    let (lost, out, unstable) = (
        rows("no equilibrium"),
        rows("not in equilibrium"),
        rows("unstable"),
    );
    let without = rows(NO_VIBRATIONS);
    if without > 0 {
        found.push(
            Diagnostic::warning("no-value", format!("{} have no vibrations", of(without)))
                .help("the column `note` says why, row by row: give links mass and inertia, and keep away from dead points"),
        );
    }
    if lost > 0 {
        found.push(
            Diagnostic::warning(
                "no-equilibrium",
                format!("{} have no equilibrium", of(lost)),
            )
            .note("there the vibrations are those about the pose as it stands")
            .help("the column `note` says why, row by row"),
        );
    }
    if out > 0 {
        found.push(
            Diagnostic::warning("not-in-equilibrium", format!("{} do not rest", of(out)))
                .note("the vibrations are those that it would have if something without stiffness held it there")
                .help("leave `equilibrium = false` out, and what is let go sinks to equilibrium in every row"),
        );
    }
    if unstable > 0 {
        found.push(
            Diagnostic::warning("unstable-pose", format!("{} are not stable", of(unstable)))
                .help("the column `note` says how fast it grows there, row by row"),
        );
    }
    found
}
