//! Models built at random are written and read back the same, whatever the order of their keys.
#![allow(clippy::unwrap_used)]

use kempe_model::build::{Entry, ModelBuilder, Value, link, study, turns};
use kempe_model::{Checked, Model, PathPart, path_at, set_value};
use proptest::prelude::*;

/// A positive length as somebody may write it.
fn length() -> impl Strategy<Value = Value> {
    let number = 1.0f64..100.0;
    prop_oneof![
        number
            .clone()
            .prop_map(|x| Value::from((x * 10.0).round() / 10.0)),
        number.clone().prop_map(Value::from),
        (
            number.clone(),
            proptest::sample::select(vec!["mm", "in", "um"])
        )
            .prop_map(|(x, unit)| Value::from(format!("{x} {unit}"))),
        (number.clone(), number)
            .prop_map(|(x, y)| Value::from(format!("abs(p * {x} - q) + {y} mm"))),
        Just(Value::from("hypot(p, q * sin(t)) + 2 * p / n^2")),
        Just(Value::from("sqrt(p^2 + (3 mm)^2) * exp(-n)")),
    ]
}

/// An angle.
fn angle() -> impl Strategy<Value = Value> {
    prop_oneof![
        (-400.0f64..400.0).prop_map(|x| Value::from(format!("{x} deg"))),
        (-7.0f64..7.0).prop_map(|x| Value::from(format!("t - {x} rad").replace("- -", "+ "))),
        Just(Value::from("atan2(p, -q) + t / 3")),
    ]
}

fn place() -> impl Strategy<Value = Value> {
    prop_oneof![
        (length(), length()).prop_map(Value::from),
        (length(), angle()).prop_map(Value::from),
        (-50i32..50, -50i32..50).prop_map(|(x, y)| Value::from([x, y])),
    ]
}

type Keys = Vec<(String, Value)>;

/// A link of a bar with corners on it, its keys in any order: a pair of pins, one of which may have coordinates, points by
/// two distances on each other, points by coordinates.
fn body(pins: [&'static str; 2], own: &'static str) -> impl Strategy<Value = Entry> {
    let [a, b] = pins;
    let side = proptest::bool::ANY.prop_map(|left| if left { "left" } else { "right" });
    let sides = [side.clone(), side.clone(), side];
    // of a size at which every triangle closes
    let far = (90.0f64..100.0).prop_map(|x| Value::from(format!("{x} mm")));
    let base = prop_oneof![far.clone(), Just(Value::from("95 mm + p / 100"))];
    let distances = (base, proptest::collection::vec(far, 6));
    let first = (length(), length()).prop_map(Value::from);
    let extra = (first, place(), 0..4usize, proptest::bool::ANY);
    let mass = (length(), proptest::bool::ANY);
    (sides, distances, extra, mass)
        .prop_map(
            move |([s, t, u], (base, far), (first, more, corners, along), (c, heavy))| {
                let mut keys: Keys = vec![(format!("{a}-{b}"), base)];
                let point = |i: usize| format!("{own}{i}");
                if along {
                    keys.push((a.to_owned(), first));
                } else {
                    keys.push((point(9), more));
                }
                let (p, q, r) = (point(1), point(2), point(3));
                let corner = |at: &str, [from, to]: [&str; 2], side: &str, d: &[Value]| -> Keys {
                    vec![
                        (
                            at.to_owned(),
                            Value::from(format!("{side} of {from} -> {to}")),
                        ),
                        (format!("{from}-{at}"), d[0].clone()),
                        (format!("{at}-{to}"), d[1].clone()),
                    ]
                };
                if corners > 0 {
                    keys.extend(corner(&p, [a, b], s, &far[0..]));
                }
                if corners > 1 {
                    keys.extend(corner(&q, [b, a], t, &far[2..]));
                }
                if corners > 2 {
                    keys.extend(corner(&r, [&p, b], u, &far[4..]));
                }
                if heavy {
                    keys.push(("mass".to_owned(), Value::from("n * 2 kg")));
                    keys.push(("inertia".to_owned(), Value::from("0.1 kg m^2")));
                    keys.push(("center".to_owned(), Value::from((c, 3))));
                }
                keys
            },
        )
        .prop_shuffle()
        .prop_map(|keys| {
            let entry = |entry: Entry, (key, value): (String, Value)| entry.with(&key, value);
            keys.into_iter().fold(link(), entry)
        })
}

fn model() -> impl Strategy<Value = ModelBuilder> {
    let units = (
        proptest::sample::select(vec!["mm", "m", "in", "cm"]),
        proptest::sample::select(vec!["deg", "rad", "rev"]),
    );
    let parameters = (1.0f64..50.0, -30.0f64..30.0, 0.5f64..3.0, -3.0f64..3.0);
    let bodies = (
        body(["A", "B"], "K"),
        body(["B", "C"], "L"),
        body(["D", "C"], "M"),
        body(["X", "Y"], "N"),
    );
    let rest = (place(), place(), angle(), length(), 1u32..500);
    (units, parameters, bodies, rest).prop_map(
        |(
            (length, angle),
            (p, q, n, t),
            (crank, rod, rocker, loose),
            (a, d, from, weight, rows),
        )| {
            ModelBuilder::new("at random")
                .units(length, angle)
                // each may use others that come later
                .parameter("q", format!("p * n + {q} mm").replace("+ -", "- "))
                .parameter("p", format!("{p} mm"))
                .parameter("n", n)
                .parameter("t", format!("{t} rad"))
                .link("crank", crank)
                .link("frame", link().point("A", a).point("D", d))
                .link("rod", rod)
                .link("rocker", rocker)
                .link("loose", loose)
                .drive(
                    "motor",
                    turns("crank").from(from).to(700.25).speed("n * 7 rad/s"),
                )
                .near("rod", "t * 2")
                .mass("weight", "rod", (weight, "-q"), "n * 1 kg")
                .load(
                    "pull",
                    Entry::new()
                        .with("force", ("n * -5.5 N", "speed(C) * 3 N s/m"))
                        .with("at", "C"),
                )
                .measure("f", "n * reaction(C) + 1.5 N")
                .measure("g", "f / (2.5 N) * rate(angle(rod) - 0.1 rev) - 1 rpm")
                .study(
                    "turn",
                    study("forces")
                        .with("rows", rows)
                        .with("columns", ["g", "max(f)"]),
                )
        },
    )
}

/// A value by its path, and its text.
type Written = (Vec<String>, String);

/// All values of a text.
fn values(text: &str) -> Vec<Written> {
    let mut found: Vec<Written> = Vec::new();
    for (at, _) in text.char_indices() {
        if let Some(here) = path_at(text, at)
            && here.part == PathPart::Value
            && found.last().is_none_or(|(path, _)| *path != here.path)
        {
            found.push((here.path, text[here.span].to_owned()));
        }
    }
    found
}

fn models_of_the_tests() -> Vec<(String, Vec<Written>)> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/good");
    let names = [
        "crank-rocker",
        "door-lock",
        "forces",
        "joints",
        "tractor-hitch",
    ];
    let read = |name| std::fs::read_to_string(format!("{folder}/{name}.toml")).unwrap();
    let texts = names.map(read);
    texts
        .into_iter()
        .map(|text| (text.clone(), values(&text)))
        .collect()
}

/// Files of the tests, each with values that stand elsewhere in it.
fn changed() -> impl Strategy<Value = String> {
    let models = std::sync::Arc::new(models_of_the_tests());
    let picks = proptest::collection::vec((0usize..1000, 0usize..1000), 1..4);
    (0..models.len(), picks).prop_map(move |(i, picks)| {
        let (text, values) = &models[i];
        picks.into_iter().fold(text.clone(), |text, (to, from)| {
            let (path, _) = &values[to % values.len()];
            let (_, new) = &values[from % values.len()];
            let path: Vec<&str> = path.iter().map(String::as_str).collect();
            set_value(&text, &path, new).unwrap_or(text)
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn a_changed_file_that_reads_is_written_so_that_it_reads_back(text in changed()) {
        let mut tables = |name: &str| match name {
            "measured.csv" => Ok("t [s];angle\n0;10\n0.5;20\n1;25\n2;20\n".to_owned()),
            "card.csv" => Ok("p [bar],phi [deg]\n1,0\n50,360\n2,400\n1,719\n".to_owned()),
            "plain.csv" => Ok("time,force\n0,10\n1,20\n".to_owned()),
            _ => Err("no such file".to_owned()),
        };
        if let Ok(Checked { model, .. }) = Model::from_toml(&text, "", &mut tables) {
            let file = model.to_toml();
            let again = Model::from_toml(&file.toml, "", &mut file.tables.files());
            let again = again.map_err(|found| {
                let diagnostic: String = found.iter().map(|d| d.render_plain("", &file.toml)).collect();
                TestCaseError::fail(diagnostic)
            })?;
            prop_assert!(again.model.same_as(&model), "{}\n{}", text, file.toml);
        }
    }

    #[test]
    fn built_written_and_read_it_is_the_same(builder in model()) {
        let Ok(Checked { model, .. }) = builder.build() else {
            let diagnostic = builder.build().unwrap_err().to_string();
            return Err(TestCaseError::fail(diagnostic));
        };
        let file = model.to_toml();
        let again = Model::from_toml(&file.toml, "", &mut file.tables.files());
        let again = again.map_err(|found| {
            let diagnostic: String = found.iter().map(|d| d.render_plain("", &file.toml)).collect();
            TestCaseError::fail(diagnostic)
        })?;
        prop_assert!(again.model.same_as(&model), "{}\n{}", builder.file().toml, file.toml);
        // to the last bit of every place
        let values: Vec<f64> = model.parameter_values();
        for (one, other) in model.links.iter().zip(&again.model.links) {
            let bits = |places: Vec<[f64; 2]>| -> Vec<u64> {
                places.into_iter().flatten().map(f64::to_bits).collect()
            };
            prop_assert_eq!(bits(one.evaluate(&values)), bits(other.evaluate(&values)));
        }
        prop_assert_eq!(&again.model.to_toml(), &file);
    }
}
