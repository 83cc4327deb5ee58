//! The modes about one pose: a row for each.

use std::f64::consts::TAU;

use kempe_dynamics::modes::Mode;
use kempe_dynamics::{Linearised, Unsettled};
use kempe_model::{Diagnostic, FRAME};
use kempe_motion::{Done, Progress, Stage};
use kempe_number::text::significant;
use kempe_units::{Dimension, Unit};

use super::bench::{About, Bench, why_unsettled};
use super::shapes::{Counted, in_words, shape};
use crate::result::{Listing, Scalar, StudyResult};
use crate::table::{Column, Table};
use crate::unit::shown;

/// A change of a coordinate by less than this, rad or mechanism sizes, is none.
const MOVED: f64 = 1e-9;
/// Digits of what people read in the list of modes.
const DIGITS: usize = 5;

/// The modes about the pose at which the bench stands, or about the equilibrium to which it sinks from there.
pub(super) fn about(
    mut bench: Bench<'_>,
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    let asked = (bench.stance.coordinates().to_vec(), bench.here(0.0));
    let it = match bench.settled(0.0, progress) {
        Ok(it) => it,
        Err(why) => {
            let failed = bench.failed(why);
            return Err([bench.told(), vec![failed]].concat());
        }
    };
    let place: Vec<String> = (bench.free().iter())
        .map(|d| bench.place(*d, bench.stance.coordinates()[d.index()]))
        .collect();
    let place = place.join(", ");
    bench.tell_kinks(&format!("at {place}"));
    tell_balance(&mut bench, &it, &place);
    let scalars = scalars(&bench, &asked, &it);
    let counted: Vec<Counted> = it.modes.iter().map(|m| Counted::of(&bench, m)).collect();
    tell_unstable(&mut bench, &it, &place);
    let table = table(&bench, &it.modes, &counted);
    let mut shapes = Vec::new();
    for (k, (mode, counted)) in it.modes.iter().zip(&counted).enumerate() {
        shapes.push(shape(&bench, k + 1, mode, counted));
        let done = Done::Of(k + 1, it.modes.len());
        if progress.reached(Stage::Rows, done).is_break() && k + 1 < it.modes.len() {
            return Err(vec![crate::explain::stopped(Stage::Rows)]);
        }
    }
    let assemblies = &bench.motion.assemblies;
    let assemblies = (assemblies.list.len(), assemblies.rejected);
    Ok(StudyResult {
        name: bench.name.to_owned(),
        demanded_rows: table.rows(),
        stopped_at: None,
        beside: Vec::new(),
        contacts: Vec::new(),
        happenings: Vec::new(),
        listings: vec![listing(&bench, &it.modes, &counted, &place)],
        frames: vec![Bench::frame(&bench.stance); table.rows()],
        table,
        scalars,
        figures: Vec::new(),
        shapes,
        designs: Vec::new(),
        events: Vec::new(),
        along: 0,
        assemblies,
        diagnostics: bench.told(),
    })
}

/// Where the drives that are let go stand, and what is out of balance.
fn scalars(bench: &Bench<'_>, asked: &(Vec<f64>, Linearised), it: &About) -> Vec<Scalar> {
    let mut list = Vec::new();
    let moved: Vec<f64> = (bench.stance.coordinates().iter().zip(&asked.0))
        .map(|(to, from)| to - from)
        .collect();
    let moved = (bench.stance.in_sizes(&moved).iter()).any(|x| x.abs() > MOVED);
    for (k, drive) in bench.free().iter().enumerate() {
        let name = &bench.model.drives[drive.index()].name;
        let mut add = |name: String, si: f64, unit: Unit| {
            let value = shown(si, &unit);
            list.push(Scalar { name, unit, value });
        };
        let here = bench.stance.coordinates()[drive.index()];
        let unit = bench.unit(*drive);
        let effort = bench.units.unit(bench.effort(*drive));
        if moved {
            add(
                format!("{name} at the pose asked for"),
                asked.0[drive.index()],
                unit.clone(),
            );
            add(
                format!("out of balance there, along {name}"),
                asked.1.force[k],
                effort,
            );
            add(format!("{name} in equilibrium"), here, unit);
        } else if it.unsettled.is_none() && bench.is_balanced(&it.linearised) {
            add(format!("{name} in equilibrium"), here, unit);
        } else {
            add(format!("{name} at the pose"), here, unit);
            add(
                format!("out of balance, along {name}"),
                it.linearised.force[k],
                effort,
            );
        }
    }
    list
}

/// Warns where the pose is none of equilibrium.
fn tell_balance(bench: &mut Bench<'_>, it: &About, place: &str) {
    let forces: Vec<String> = (bench.free().iter().zip(&it.linearised.force))
        .map(|(drive, force)| {
            let name = &bench.model.drives[drive.index()].name;
            format!(
                "{} along `{name}`",
                bench.units.text(*force, bench.effort(*drive))
            )
        })
        .collect();
    let forces = crate::words::list(&forces);
    let name = bench.name;
    let warning = match it.unsettled {
        Some(why) => Diagnostic::warning(
            "no-equilibrium",
            format!("study `{name}`: no equilibrium was found from {place}: {}", why_unsettled(why)),
        )
        .note(format!("the vibrations are those about the pose as it stands; out of balance there: {forces}"))
        .help(match why {
            Unsettled::NoEnd => "give what drives it on something that holds against it, a spring or a load; or hold that drive",
            Unsettled::AtChangePoint => "give springs or loads that hold it beside that place, or hold a drive that goes there",
            Unsettled::NoRest => "move a spring's free length or stop a little, or smooth the load that jumps",
            _ => "give another pose under `at`, from which it does not sink to a limit; or springs or loads that hold it before; or, where only the drive ends there, a drive at a link that goes farther",
        }),
        None if !bench.is_balanced(&it.linearised) => Diagnostic::warning(
            "not-in-equilibrium",
            format!("study `{name}`: at {place} the mechanism does not rest; out of balance: {forces}"),
        )
        .note("the vibrations are those that it would have if something without stiffness held it there")
        .help("leave `equilibrium = false` out, and it sinks to equilibrium first"),
        None => return,
    };
    bench.diagnostics.push(warning);
}

/// Warns where the pose is not stable.
fn tell_unstable(bench: &mut Bench<'_>, it: &About, place: &str) {
    let modes = &it.modes;
    let growing = modes.iter().enumerate().filter(|(_, m)| m.growth() > 0.0);
    let growing: Vec<String> = growing
        .map(|(k, m)| {
            format!(
                "mode {} by e in {} s",
                k + 1,
                significant(1.0 / m.growth(), 3)
            )
        })
        .collect();
    if growing.is_empty() {
        return;
    }
    // What swings as it grows is fed by loads that follow it: no pose beside is better.
    let swings = (modes.iter()).any(|m| m.growth() > 0.0 && m.damped_angular_frequency() > 0.0);
    let help = match (swings, bench.study.settles) {
        (true, _) => {
            "a load that follows the motion feeds it: take some of it away, or give more stiffness or damping"
        }
        (false, true) if it.unsettled.is_some() => {
            "no equilibrium was found from here, a stable one least of all: give springs or loads that hold it"
        }
        (false, true) => {
            "give a pose a little beside it under `at`: from there it sinks to a stable one"
        }
        (false, false) => {
            "leave `equilibrium = false` out, and it sinks to a stable pose if it is a little beside this one"
        }
    };
    let message = format!(
        "study `{}`: at {place} the mechanism is not stable: what starts it grows, {}",
        bench.name,
        growing.join(", ")
    );
    bench
        .diagnostics
        .push(Diagnostic::warning("unstable-pose", message).help(help));
}

fn hertz() -> Unit {
    Unit::parse("Hz").unwrap_or_else(|_| Unit::one())
}

fn unit(text: &str) -> Unit {
    Unit::parse(text).unwrap_or_else(|_| Unit::one())
}

fn table(bench: &Bench<'_>, modes: &[Mode], counted: &[Counted]) -> Table {
    let mut columns = Vec::new();
    let mut add = |name: &str, unit: Unit, of: &dyn Fn(usize, &Mode) -> f64| {
        columns.push(Column {
            values: (modes.iter().enumerate())
                .map(|(k, m)| unit.from_si(of(k, m)))
                .collect(),
            ..Column::new(name, unit)
        });
    };
    let swings = |m: &Mode| m.angular_frequency().unwrap_or(f64::NAN);
    let per_second = unit("1/s");
    add("mode", Unit::one(), &|k, _| (k + 1) as f64);
    add("frequency", hertz(), &|_, m| swings(m) / TAU);
    add("angular_frequency", unit("rad/s"), &|_, m| swings(m));
    add("period", bench.units.unit(Dimension::TIME), &|_, m| {
        TAU / swings(m)
    });
    add("damping_ratio", Unit::one(), &|_, m| {
        m.damping_ratio().unwrap_or(f64::NAN)
    });
    add("damped_frequency", hertz(), &|_, m| {
        m.damped_angular_frequency() / TAU
    });
    add("growth", per_second, &|_, m| m.growth());
    // Shapes have a modal mass of 1: counted at a coordinate that goes by 1 it is the inverse of its square.
    for (name, dimension, of) in [
        ("modal_inertia", Dimension::INERTIA, Dimension::ANGLE),
        ("modal_mass", Dimension::MASS, Dimension::LENGTH),
    ] {
        let drives = bench.free().iter().enumerate();
        let alike: Vec<usize> = drives
            .filter(|(_, d)| bench.model.drives[d.index()].dimension == of)
            .map(|(place, _)| place)
            .collect();
        if !alike.is_empty() {
            add(name, bench.units.unit(dimension), &|k, m| {
                // What goes by rounding alone does not go.
                let going = alike
                    .iter()
                    .filter(|place| counted[k].shape[**place] != 0.0);
                let most = going.fold(0.0_f64, |most, place| most.max(m.shape[*place].abs()));
                if most > 0.0 {
                    1.0 / (most * most)
                } else {
                    f64::NAN
                }
            });
        }
    }
    for (place, drive) in bench.free().iter().enumerate() {
        let name = format!("shape({})", bench.model.drives[drive.index()].name);
        let unit = bench.unit(*drive);
        add(&name, unit.clone(), &|k, _| {
            unit.to_si(counted[k].shape[place])
        });
    }
    for (point, known) in bench.model.points.iter().enumerate() {
        if known.links.contains(&FRAME) {
            continue;
        }
        let name = format!("amplitude({})", known.name);
        add(&name, bench.units.unit(Dimension::LENGTH), &|k, _| {
            counted[k].points[point]
        });
    }
    let evidence = bench.stance.evidence();
    Table {
        name: bench.name.to_owned(),
        columns,
        places: 1,
        closure: vec![evidence.closure; modes.len()],
        smallest_singular_value: vec![evidence.smallest_singular_value; modes.len()],
        forces: None,
        balance: None,
        notes: modes
            .iter()
            .map(|m| (m.growth() > 0.0 || m.square <= 0.0).then(|| in_words(m)))
            .collect(),
    }
}

/// The modes as people read them.
fn listing(bench: &Bench<'_>, modes: &[Mode], counted: &[Counted], place: &str) -> Listing {
    let drives: Vec<(&str, Unit)> = (bench.free().iter())
        .map(|d| (bench.model.drives[d.index()].name.as_str(), bench.unit(*d)))
        .collect();
    let mut head: Vec<String> = ["mode", "frequency [Hz]", "period [s]", "damping ratio"]
        .map(str::to_owned)
        .to_vec();
    head.extend(
        drives
            .iter()
            .map(|(name, unit)| format!("{name} [{}]", unit.text())),
    );
    head.push(String::new());
    let number = |x: f64| match x.is_finite() {
        true => significant(x, DIGITS),
        false => String::new(),
    };
    let row = |(k, (mode, counted)): (usize, (&Mode, &Counted))| {
        let swings = mode.angular_frequency().unwrap_or(f64::NAN);
        let mut row = vec![
            (k + 1).to_string(),
            number(swings / TAU),
            number(TAU / swings),
            mode.damping_ratio().map_or_else(String::new, number),
        ];
        row.extend(counted.shape.iter().map(|x| number(*x)));
        let special = mode.growth() > 0.0 || mode.square <= 0.0;
        row.push(if special {
            in_words(mode)
        } else {
            String::new()
        });
        row
    };
    let mut rows: Vec<Vec<String>> = modes.iter().zip(counted).enumerate().map(row).collect();
    if rows
        .iter()
        .all(|row| row.last().is_some_and(String::is_empty))
    {
        head.pop();
        rows.iter_mut().for_each(|row| row.truncate(head.len()));
    }
    Listing {
        title: format!("Natural vibrations at {place}"),
        head,
        rows,
    }
}
