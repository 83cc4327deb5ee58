//! The units of the language, one row each.

use std::f64::consts::{PI, TAU};

use crate::Dimension;

/// A unit of the language. One unit is `numerator / denominator` in SI; both are kept so that `57.5 mm` is the number
/// nearest to 0.0575 and not one rounding off it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitDefinition {
    /// How it is written.
    pub symbol: &'static str,
    /// Other ways to write it.
    pub aliases: &'static [&'static str],
    /// What it measures.
    pub dimension: Dimension,
    /// Numerator of the factor to SI.
    pub numerator: f64,
    /// Denominator of the factor to SI.
    pub denominator: f64,
    /// Its name and definition.
    pub doc: &'static str,
}

/// A row of the table.
const fn row(
    symbol: &'static str,
    aliases: &'static [&'static str],
    dimension: Dimension,
    numerator: f64,
    denominator: f64,
    doc: &'static str,
) -> UnitDefinition {
    UnitDefinition {
        symbol,
        aliases,
        dimension,
        numerator,
        denominator,
        doc,
    }
}

/// All units, by quantity.
#[rustfmt::skip]
pub const UNITS: &[UnitDefinition] = &[
    row("mm",     &[],            Dimension::LENGTH, 1.0, 1e3, "millimetre"),
    row("cm",     &[],            Dimension::LENGTH, 1.0, 1e2, "centimetre"),
    row("m",      &[],            Dimension::LENGTH, 1.0, 1.0, "metre"),
    row("km",     &[],            Dimension::LENGTH, 1e3, 1.0, "kilometre"),
    row("um",     &["µm", "μm"],  Dimension::LENGTH, 1.0, 1e6, "micrometre"),
    row("in",     &[],            Dimension::LENGTH, 127.0, 5e3, "inch, 25.4 mm"),
    row("ft",     &[],            Dimension::LENGTH, 381.0, 1250.0, "foot, 12 in"),
    row("deg",    &["°"],         Dimension::ANGLE, PI, 180.0, "degree, pi/180 rad"),
    row("rad",    &[],            Dimension::ANGLE, 1.0, 1.0, "radian"),
    row("mrad",   &[],            Dimension::ANGLE, 1.0, 1e3, "milliradian"),
    row("arcmin", &[],            Dimension::ANGLE, PI, 10_800.0, "minute of arc, 1/60 deg"),
    row("arcsec", &[],            Dimension::ANGLE, PI, 648_000.0, "second of arc, 1/60 arcmin"),
    row("rev",    &["turn"],      Dimension::ANGLE, TAU, 1.0, "revolution, 360 deg"),
    row("s",      &[],            Dimension::TIME, 1.0, 1.0, "second"),
    row("ms",     &[],            Dimension::TIME, 1.0, 1e3, "millisecond"),
    row("us",     &["µs", "μs"],  Dimension::TIME, 1.0, 1e6, "microsecond"),
    row("min",    &[],            Dimension::TIME, 60.0, 1.0, "minute"),
    row("h",      &[],            Dimension::TIME, 3600.0, 1.0, "hour"),
    row("kg",     &[],            Dimension::MASS, 1.0, 1.0, "kilogram"),
    row("mg",     &[],            Dimension::MASS, 1.0, 1e6, "milligram"),
    row("g",      &[],            Dimension::MASS, 1.0, 1e3, "gram"),
    row("t",      &[],            Dimension::MASS, 1e3, 1.0, "tonne, 1000 kg"),
    row("lb",     &[],            Dimension::MASS, 45_359_237.0, 1e8, "pound, 0.453 592 37 kg"),
    row("N",      &[],            Dimension::FORCE, 1.0, 1.0, "newton"),
    row("mN",     &[],            Dimension::FORCE, 1.0, 1e3, "millinewton"),
    row("kN",     &[],            Dimension::FORCE, 1e3, 1.0, "kilonewton"),
    row("MN",     &[],            Dimension::FORCE, 1e6, 1.0, "meganewton"),
    row("lbf",    &[],            Dimension::FORCE, 44_482_216_152_605.0, 1e13, "pound-force, 1 lb at 9.806 65 m/s^2"),
    row("Pa",     &[],            Dimension::PRESSURE, 1.0, 1.0, "pascal, N/m^2"),
    row("kPa",    &[],            Dimension::PRESSURE, 1e3, 1.0, "kilopascal"),
    row("MPa",    &[],            Dimension::PRESSURE, 1e6, 1.0, "megapascal, N/mm^2"),
    row("GPa",    &[],            Dimension::PRESSURE, 1e9, 1.0, "gigapascal"),
    row("mbar",   &[],            Dimension::PRESSURE, 1e2, 1.0, "millibar, 100 Pa"),
    row("bar",    &[],            Dimension::PRESSURE, 1e5, 1.0, "bar, 100 kPa"),
    row("psi",    &[],            Dimension::PRESSURE, 44_482_216_152_605.0, 6_451_600_000.0, "pound-force per square inch"),
    row("J",      &[],            Dimension::ENERGY, 1.0, 1.0, "joule, N m"),
    row("mJ",     &[],            Dimension::ENERGY, 1.0, 1e3, "millijoule"),
    row("kJ",     &[],            Dimension::ENERGY, 1e3, 1.0, "kilojoule"),
    row("W",      &[],            Dimension::POWER, 1.0, 1.0, "watt, J/s"),
    row("mW",     &[],            Dimension::POWER, 1.0, 1e3, "milliwatt"),
    row("kW",     &[],            Dimension::POWER, 1e3, 1.0, "kilowatt"),
    row("MW",     &[],            Dimension::POWER, 1e6, 1.0, "megawatt"),
    row("hp",     &[],            Dimension::POWER, 745.699_871_582_270_2, 1.0, "mechanical horsepower, 550 ft lbf/s"),
    row("Hz",     &[],            Dimension::FREQUENCY, 1.0, 1.0, "hertz, cycles per second: a frequency, not an angular speed"),
    row("kHz",    &[],            Dimension::FREQUENCY, 1e3, 1.0, "kilohertz"),
    row("rpm",    &[],            Dimension::ANGULAR_SPEED, PI, 30.0, "revolution per minute: an angular speed"),
    row("L",      &[],            Dimension::VOLUME, 1.0, 1e3, "litre, 1 dm^3"),
    row("%",      &[],            Dimension::NONE, 1.0, 1e2, "per cent, a number"),
];

/// Words people write for units that the language spells otherwise, for help lines only.
const SPELT_OUT: &[(&str, &str)] = &[
    ("meter", "m"),
    ("metre", "m"),
    ("meters", "m"),
    ("metres", "m"),
    ("millimeter", "mm"),
    ("millimetre", "mm"),
    ("micron", "um"),
    ("inch", "in"),
    ("inches", "in"),
    ("foot", "ft"),
    ("feet", "ft"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("radian", "rad"),
    ("radians", "rad"),
    ("turns", "rev"),
    ("revolution", "rev"),
    ("sec", "s"),
    ("second", "s"),
    ("seconds", "s"),
    ("minute", "min"),
    ("minutes", "min"),
    ("hr", "h"),
    ("hour", "h"),
    ("hours", "h"),
    ("gram", "g"),
    ("kilogram", "kg"),
    ("kilo", "kg"),
    ("ton", "t"),
    ("tonne", "t"),
    ("lbs", "lb"),
    ("pound", "lb"),
    ("newton", "N"),
    ("pascal", "Pa"),
    ("joule", "J"),
    ("watt", "W"),
    ("PS", "hp"),
    ("hertz", "Hz"),
    ("percent", "%"),
    ("l", "L"),
    ("liter", "L"),
    ("litre", "L"),
    ("lpm", "L/min"),
    ("rads", "rad"),
    ("rps", "rev/s"),
    ("mps", "m/s"),
    ("kmh", "km/h"),
    ("kph", "km/h"),
    ("fps", "ft/s"),
    ("lbm", "lb"),
    ("lbft", "lbf ft"),
    ("ftlb", "lbf ft"),
    ("lbin", "lbf in"),
    ("inlb", "lbf in"),
];

/// Units that the language does not have, as a number of one that it has.
const FOREIGN: &[(&str, f64, &str)] = &[
    ("slug", 14.593_903, "kg"),
    ("oz", 28.349_523_125, "g"),
    ("kgf", 9.806_65, "N"),
    ("kp", 9.806_65, "N"),
    ("dyn", 1e-5, "N"),
    ("kip", 1000.0, "lbf"),
    ("ksi", 1000.0, "psi"),
    ("atm", 1.013_25, "bar"),
    ("torr", 133.322_368, "Pa"),
    ("mmHg", 133.322_387, "Pa"),
    ("yd", 3.0, "ft"),
    ("mi", 1.609_344, "km"),
    ("mile", 1.609_344, "km"),
    ("miles", 1.609_344, "km"),
    ("mph", 1.609_344, "km/h"),
    ("knot", 1.852, "km/h"),
    ("thou", 0.001, "in"),
    ("mil", 0.001, "in"),
    ("dm", 10.0, "cm"),
    ("nm", 0.001, "um"),
    ("ml", 0.001, "L"),
    ("mL", 0.001, "L"),
    ("gon", 0.9, "deg"),
    ("grad", 0.9, "deg"),
    ("day", 24.0, "h"),
    ("ns", 0.001, "us"),
    ("cal", 4.184, "J"),
    ("btu", 1_055.055_852_62, "J"),
];

/// A unit that the language does not have as a number of one that it has.
pub(crate) fn foreign(name: &str) -> Option<(f64, &'static str)> {
    let (_, factor, unit) = FOREIGN.iter().find(|(word, ..)| *word == name)?;
    Some((*factor, unit))
}

/// What a product written without a blank may start with: `Nm`, `kgm`, `kWh`. Other pairs of units, such as the `m` and the `W` of
/// a prefix, are a chance.
const JOINED: &[Dimension] = &[
    Dimension::FORCE,
    Dimension::MASS,
    Dimension::POWER,
    Dimension::PRESSURE,
];

/// The unit written `symbol`.
pub(crate) fn find(symbol: &str) -> Option<&'static UnitDefinition> {
    UNITS
        .iter()
        .find(|unit| unit.symbol == symbol || unit.aliases.contains(&symbol))
}

/// What to write instead of a name that is no unit: `metre` → `m`, `Nm` → `N m`, `mm2` → `mm^2`, `Mm` → `mm`.
pub(crate) fn instead_of(name: &str) -> Option<String> {
    if let Some((_, unit)) = SPELT_OUT.iter().find(|(word, _)| *word == name) {
        return Some((*unit).to_owned());
    }
    let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
    if stem.len() < name.len() && find(stem).is_some() {
        return Some(format!("{stem}^{}", &name[stem.len()..]));
    }
    for (at, _) in name.char_indices().skip(1) {
        let (left, right) = name.split_at(at);
        if let (Some(a), Some(b)) = (find(left), find(right))
            && a.dimension != b.dimension
            && JOINED.contains(&a.dimension)
        {
            return Some(format!("{left} {right}"));
        }
    }
    let words = SPELT_OUT.iter().map(|(word, _)| *word);
    let near = crate::suggest::nearest(name, UNITS.iter().map(|unit| unit.symbol).chain(words))?;
    Some(
        SPELT_OUT
            .iter()
            .find(|(word, _)| *word == near)
            .map_or(near, |(_, unit)| unit)
            .to_owned(),
    )
}
