//! The unit table against fend and against values from the definitions.

use std::f64::consts::PI;

use kempe_units::{Dimension, UNITS, Unit, format_digits};
use proptest::prelude::*;

/// The SI value of `text` by fend, which calculates in rationals.
fn fend(text: &str, si: &str) -> f64 {
    let mut context = fend_core::Context::new();
    let question = format!("@noapprox ({text}) to {si} to 25 sf");
    let answer = fend_core::evaluate(&question, &mut context)
        .unwrap_or_else(|error| panic!("{question}: {error}"));
    let answer = answer.get_main_result().replace("approx. ", "");
    let number = answer.split([' ', '%']).next().unwrap_or_default();
    number
        .parse()
        .unwrap_or_else(|_| panic!("{question}: {answer}"))
}

/// fend's name of one of our units.
fn fend_name(symbol: &str) -> &str {
    match symbol {
        "mrad" => "milliradian",
        "rev" => "revolution",
        "in" => "inch",
        "mg" => "milligram",
        "mbar" => "millibar",
        "mN" => "millinewton",
        "mJ" => "millijoule",
        "mW" => "milliwatt",
        "MW" => "megawatt",
        "kHz" => "kilohertz",
        other => other,
    }
}

/// The coherent SI unit of a dimension, for fend.
fn si_name(dimension: Dimension) -> String {
    let bases = [
        ("m", dimension.length),
        ("kg", dimension.mass),
        ("s", dimension.time),
        ("rad", dimension.angle),
    ];
    let factors: Vec<String> = bases
        .iter()
        .filter(|(_, e)| *e != 0)
        .map(|(base, e)| format!("{base}^({})", e / 6))
        .collect();
    if factors.is_empty() {
        "1".to_owned()
    } else {
        factors.join(" * ")
    }
}

fn assert_close(ours: f64, theirs: f64, ulps: f64, what: &str) {
    let scale = theirs.abs() * f64::EPSILON;
    assert!(
        (ours - theirs).abs() <= ulps * scale,
        "{what}: ours {ours:e}, theirs {theirs:e}"
    );
}

#[test]
fn each_unit_agrees_with_fend() {
    for unit in UNITS {
        let theirs = if unit.symbol == "%" {
            0.01 // fend keeps the sign in its answer
        } else {
            fend(
                &format!("1 {}", fend_name(unit.symbol)),
                &si_name(unit.dimension),
            )
        };
        let ours = Unit::parse(unit.symbol).unwrap();
        assert_close(ours.to_si(1.0), theirs, 1.0, unit.symbol);
        assert_close(ours.factor(), theirs, 1.0, unit.symbol);
        assert_eq!(ours.dimension(), unit.dimension);
        for alias in unit.aliases {
            assert_eq!(Unit::parse(alias).unwrap(), ours);
        }
    }
}

#[test]
fn each_unit_has_its_defined_value() {
    let values = [
        ("mm", 1e-3),
        ("cm", 1e-2),
        ("m", 1.0),
        ("km", 1e3),
        ("um", 1e-6),
        ("in", 0.0254),
        ("ft", 0.3048),
        ("deg", PI / 180.0),
        ("rad", 1.0),
        ("mrad", 1e-3),
        ("arcmin", PI / 10_800.0),
        ("arcsec", PI / 648_000.0),
        ("rev", 2.0 * PI),
        ("s", 1.0),
        ("ms", 1e-3),
        ("us", 1e-6),
        ("min", 60.0),
        ("h", 3600.0),
        ("kg", 1.0),
        ("g", 1e-3),
        ("t", 1e3),
        ("lb", 0.453_592_37),
        ("N", 1.0),
        ("kN", 1e3),
        ("MN", 1e6),
        ("lbf", 4.448_221_615_260_5),
        ("Pa", 1.0),
        ("kPa", 1e3),
        ("MPa", 1e6),
        ("GPa", 1e9),
        ("bar", 1e5),
        ("psi", 6_894.757_293_168_361),
        ("J", 1.0),
        ("kJ", 1e3),
        ("W", 1.0),
        ("kW", 1e3),
        ("hp", 745.699_871_582_270_2),
        ("Hz", 1.0),
        ("mg", 1e-6),
        ("mN", 1e-3),
        ("mbar", 100.0),
        ("mJ", 1e-3),
        ("mW", 1e-3),
        ("MW", 1e6),
        ("kHz", 1e3),
        ("rpm", 2.0 * PI / 60.0),
        ("L", 1e-3),
        ("%", 0.01),
    ];
    assert_eq!(values.len(), UNITS.len(), "a unit without a value here");
    for (symbol, value) in values {
        assert_close(Unit::parse(symbol).unwrap().to_si(1.0), value, 1.0, symbol);
    }
}

#[test]
fn symbols_are_used_once() {
    let mut all: Vec<&str> = UNITS
        .iter()
        .flat_map(|unit| unit.aliases.iter().copied().chain([unit.symbol]))
        .collect();
    let count = all.len();
    all.sort_unstable();
    all.dedup();
    assert_eq!(all.len(), count);
    assert!(UNITS.iter().all(|unit| !unit.doc.is_empty()));
}

#[test]
fn compound_units() {
    for (text, form, dimension, factor) in [
        ("kg mm^2", "kg mm^2", Dimension::INERTIA, 1e-6),
        ("kg*mm²", "kg mm^2", Dimension::INERTIA, 1e-6),
        ("rad/s", "rad/s", Dimension::ANGULAR_SPEED, 1.0),
        ("N m", "N m", Dimension::TORQUE, 1.0),
        ("N·m", "N m", Dimension::TORQUE, 1.0),
        ("L/min", "L/min", Dimension::FLOW, 1.0 / 60_000.0),
        ("m s^-2", "m/s^2", Dimension::ACCELERATION, 1.0),
        ("s⁻¹ m", "m/s", Dimension::SPEED, 1.0),
        ("1/s", "s^-1", Dimension::FREQUENCY, 1.0),
        ("s^-1", "s^-1", Dimension::FREQUENCY, 1.0),
        ("1/mm", "mm^-1", Dimension::CURVATURE, 1e3),
        ("N/mm", "N/mm", Dimension::STIFFNESS, 1e3),
        ("kg/m/s", "kg/m/s", Dimension::new(-1, 1, -1, 0), 1.0),
        ("kg/m*s", "kg s/m", Dimension::new(-1, 1, 1, 0), 1.0),
        ("N s^2 / mm", "N s^2/mm", Dimension::MASS, 1e3),
        ("", "", Dimension::NONE, 1.0),
        ("1", "", Dimension::NONE, 1.0),
        ("%", "%", Dimension::NONE, 0.01),
        (
            "°/s",
            "deg/s",
            Dimension::ANGULAR_SPEED,
            std::f64::consts::PI / 180.0,
        ),
        ("µm", "um", Dimension::LENGTH, 1e-6),
        ("turn", "rev", Dimension::ANGLE, std::f64::consts::TAU),
    ] {
        let unit = Unit::parse(text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!(unit.text(), form, "{text}");
        assert_eq!(unit.dimension(), dimension, "{text}");
        assert_close(unit.factor(), factor, 1.0, text);
        assert_eq!(
            Unit::parse(unit.text()).unwrap(),
            unit,
            "the text reads back"
        );
    }
}

#[test]
fn bad_units() {
    for (text, span, message) in [
        ("mmm", 0..3, "unknown unit `mmm` (did you mean `mm`?)"),
        ("metre", 0..5, "unknown unit `metre` (did you mean `m`?)"),
        ("Nm", 0..2, "unknown unit `Nm` (did you mean `N m`?)"),
        ("Nmm", 0..3, "unknown unit `Nmm` (did you mean `N mm`?)"),
        ("kNm", 0..3, "unknown unit `kNm` (did you mean `kN m`?)"),
        ("kg mm2", 3..6, "unknown unit `mm2` (did you mean `mm^2`?)"),
        ("Kg", 0..2, "unknown unit `Kg` (did you mean `kg`?)"),
        (
            "degree",
            0..6,
            "unknown unit `degree` (did you mean `deg`?)",
        ),
        (
            "furlong",
            0..7,
            "unknown unit `furlong` (the units are mm, cm, m, km, um, in, ft, deg, rad, mrad, arcmin, arcsec, rev, s, ms, us, min, h, kg, mg, g, t, lb, N, mN, kN, MN, lbf, Pa, kPa, MPa, GPa, mbar, bar, psi, J, mJ, kJ, W, mW, kW, MW, hp, Hz, kHz, rpm, L, %)",
        ),
        (
            "2",
            0..1,
            "a unit is expected (such as `mm`, `rad/s` or `kg m^2`)",
        ),
        ("rpms", 0..4, "unknown unit `rpms` (did you mean `rpm`?)"),
        ("slug", 0..4, "unknown unit `slug` (it is 14.593903 kg)"),
        ("mps", 0..3, "unknown unit `mps` (did you mean `m/s`?)"),
        (
            "1/",
            2..2,
            "a unit is expected (such as `mm`, `rad/s` or `kg m^2`)",
        ),
        (
            "m/",
            1..2,
            "an operator is missing before this (for a product write `*` between the two)",
        ),
        (
            "m 5",
            2..3,
            "an operator is missing before this (for a product write `* 5`)",
        ),
        (
            "m^0.5",
            1..5,
            "the power of a unit is a whole number from 1 to 12, or its negative (such as `mm^2` or `s^-1`)",
        ),
        (
            "m^99",
            1..4,
            "the power of a unit is a whole number from 1 to 12, or its negative (such as `mm^2` or `s^-1`)",
        ),
        (
            "m^",
            2..2,
            "the power of a unit is a whole number (set the quantity in brackets to raise it: `(5 mm)^n`)",
        ),
        (
            "kg/m s",
            5..6,
            "a unit after a division needs `*` or `/` before it (write `kg s/m`, or `kg/m/s`)",
        ),
    ] {
        let error = Unit::parse(text).unwrap_err();
        assert_eq!(error.to_string(), message, "{text}");
        assert_eq!(error.span, span, "{text}");
    }
}

#[test]
fn values_with_one_rounding() {
    let mm = Unit::parse("mm").unwrap();
    for value in [0.1, 0.3, 57.5, 120.0, 205.0, 13.0] {
        let si: f64 = format!("{value}e-3").parse().unwrap();
        assert_eq!(mm.to_si(value), si);
        assert_eq!(mm.from_si(si), value);
    }
    let deg = Unit::parse("deg").unwrap();
    for (value, si) in [
        (180.0, PI),
        (360.0, 2.0 * PI),
        (90.0, PI / 2.0),
        (45.0, PI / 4.0),
        (-90.0, -PI / 2.0),
    ] {
        assert_eq!(deg.to_si(value), si);
        assert_eq!(deg.from_si(si), value);
    }
}

#[test]
fn display_units() {
    let file = [Unit::parse("mm").unwrap(), Unit::parse("deg").unwrap()];
    for (dimension, ours, si) in [
        (Dimension::NONE, "", ""),
        (Dimension::LENGTH, "mm", "m"),
        (Dimension::ANGLE, "deg", "rad"),
        (Dimension::SPEED, "mm/s", "m/s"),
        (Dimension::ACCELERATION, "mm/s^2", "m/s^2"),
        (
            Dimension::ACCELERATION * Dimension::ANGLE * Dimension::ANGLE,
            "mm/s^2",
            "m/s^2",
        ),
        (Dimension::ANGULAR_ACCELERATION, "deg/s^2", "rad/s^2"),
        (Dimension::CURVATURE, "mm^-1", "m^-1"),
        (Dimension::FORCE, "N", "N"),
        (Dimension::TORQUE, "N m", "N m"),
        (Dimension::POWER * Dimension::ANGLE, "W", "W"),
        (Dimension::TORSIONAL_STIFFNESS, "N m/rad", "N m/rad"),
        (Dimension::TIME, "s", "s"),
        (Dimension::FREQUENCY, "Hz", "Hz"),
        (Dimension::AREA, "mm^2", "m^2"),
        (Dimension::LENGTH.sqrt().unwrap(), "", ""),
    ] {
        assert_eq!(Unit::for_display(dimension, &file).text(), ours);
        let unit = Unit::for_display(dimension, &[]);
        assert_eq!(unit.text(), si);
        assert!(unit.text().is_empty() || unit.dimension().compatible(dimension));
    }
}

#[test]
fn values_as_text() {
    let unit = |text| Unit::parse(text).unwrap();
    assert_eq!(format_digits(0.12, &unit("mm"), 12), "120 mm");
    assert_eq!(format_digits(0.1 + 0.2, &unit("m"), 12), "0.3 m");
    assert_eq!(format_digits(5.0, &Unit::one(), 12), "5");
    assert_eq!(format_digits(-0.05, &unit("%"), 12), "-5 %");
    assert_eq!(format_digits(f64::NAN, &unit("mm"), 12), "NaN mm");
    assert_eq!(format_digits(f64::INFINITY, &unit("mm"), 12), "inf mm");
    assert_eq!(format_digits(1.0 / 3.0, &unit("m"), 4), "0.3333 m");
    assert_eq!(format_digits(12_345.678, &unit("m"), 3), "12300 m");
}

/// A product of units with their powers, as ours and as fend's.
fn compound() -> impl Strategy<Value = (String, String)> {
    let factor = (0..UNITS.len(), -3_i32..=3).prop_filter("no power, or a sign", |(at, power)| {
        *power != 0 && UNITS[*at].symbol != "%"
    });
    proptest::collection::vec(factor, 1..4).prop_map(|factors| {
        let ours = factors
            .iter()
            .map(|(at, power)| format!("{}^{power}", UNITS[*at].symbol));
        let theirs = factors
            .iter()
            .map(|(at, power)| format!("(1 {})^({power})", fend_name(UNITS[*at].symbol)));
        (
            ours.collect::<Vec<_>>().join(" "),
            theirs.collect::<Vec<_>>().join(" * "),
        )
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn unit_arithmetic_agrees_with_fend((ours, theirs) in compound(), value in 0.001_f64..1000.0) {
        let unit = Unit::parse(&ours).unwrap();
        let expected = fend(&format!("{value} * {theirs}"), &si_name(unit.dimension()));
        // Each factor of a power rounds once, numerator and denominator apart.
        assert_close(unit.to_si(value), expected, 12.0, &ours);
        prop_assert_eq!(Unit::parse(unit.text()).unwrap(), unit);
    }
}
