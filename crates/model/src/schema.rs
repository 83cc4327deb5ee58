//! The JSON schema of the model file, for editors: draft-07, made of the same tables the reader reads by.

use serde_json::{Map, Value, json};

use crate::model::RiseLaw;
use crate::read::actuators::{CYLINDER_KEYS, MOTOR_KEYS};
use crate::read::choices;
use crate::read::drives::DRIVE_KINDS;
use crate::read::friction::FRICTION_KEYS;
use crate::read::joints::JOINT_KEYS;
use crate::read::law_table::TABLE_KEYS;
use crate::read::laws::{LAW_KEYS, PIECE_KEYS};
use crate::read::links::LINK_KEYS;
use crate::read::loads::{FORCE_KEYS, LOAD_TABLE_KEYS, TORQUE_KEYS};
use crate::read::masses::{BAR_KEYS, MASS_KEYS};
use crate::read::sections::{ANNOUNCED_SECTIONS, FILE_KEYS, UNIT_KEYS};
use crate::read::springs::{ACTS, DAMPER_KEYS, SPRING_KEYS};
use crate::read::studies::{ANNOUNCED_KINDS, FORCES_KEYS, MOTION_KEYS};

/// The JSON schema (draft-07) of the model file.
///
/// It knows the shape; names, dimensions and geometry are checked by reading alone.
pub fn schema() -> Value {
    json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "Kempe model",
        "description": "A planar linkage: its links, joints, drives, measures and studies.",
        "type": "object",
        "additionalProperties": false,
        "properties": keyed(FILE_KEYS, &file_key),
        "definitions": {
            "scalar": {
                "description": "A bare number in the file's unit, or a string: a value with its unit, or an expression over parameters.",
                "type": ["number", "string"]
            },
            "pair": {
                "description": "[x, y], or [radius, angle] when the second is an angle.",
                "type": "array",
                "items": reference("scalar"),
                "minItems": 2,
                "maxItems": 2
            },
            "side": {
                "description": "The side of a directed line on which a point lies.",
                "type": "string",
                "pattern": "^\\s*(left|right)\\s+of\\s.*->"
            },
            "line": { "description": "A directed line.", "type": "string", "pattern": "->" },
            "law": { "description": "A motion law from rest to rest.", "enum": RiseLaw::ALL.map(RiseLaw::name) },
            "link": link(),
            "joint": { "anyOf": JOINT_KEYS.iter().map(|(kind, keys, _)| joint(kind, keys)).collect::<Vec<_>>() },
            "drive": { "anyOf": DRIVE_KINDS.iter().map(|(kind, _)| drive(kind)).collect::<Vec<_>>() },
            "piece": {
                "description": "A piece of a sequence: a dwell, or a rise, fall or end point with a time and a law or with a speed.",
                "type": "object",
                "additionalProperties": false,
                "properties": keyed(PIECE_KEYS, &|key| if key == "by" { reference("law") } else { reference("scalar") })
            },
            "amount": amount(),
            "load": load(),
            "mass": table(MASS_KEYS, &["at", "mass"], &|key| match key {
                "on" => text(),
                "at" => json!({ "anyOf": [reference("pair"), text()] }),
                _ => reference("scalar"),
            }),
            "spring": table(SPRING_KEYS, &["stiffness"], &|key| match key {
                "between" => text(),
                "links" => two(text()),
                "acts" => json!({ "enum": ACTS.iter().map(|(word, _)| *word).collect::<Vec<_>>() }),
                "stops" => two(reference("scalar")),
                _ => reference("scalar"),
            }),
            "damper": table(DAMPER_KEYS, &["damping"], &|key| match key {
                "between" => text(),
                "links" => two(text()),
                _ => reference("scalar"),
            }),
            "friction": table(FRICTION_KEYS, &[], &|_| reference("scalar")),
            "cylinder": table(CYLINDER_KEYS, &["bore", "rod"], &|_| reference("scalar")),
            "motor": table(MOTOR_KEYS, MOTOR_KEYS, &|_| json!({
                "description": "Pairs of speed and torque.",
                "type": "array",
                "items": reference("pair"),
                "minItems": 2
            })),
            "study": study()
        }
    })
}

fn reference(definition: &str) -> Value {
    json!({ "$ref": format!("#/definitions/{definition}") })
}

fn keyed(keys: &[&str], of: &dyn Fn(&str) -> Value) -> Value {
    Value::Object(
        keys.iter()
            .map(|key| ((*key).to_owned(), of(key)))
            .collect::<Map<String, Value>>(),
    )
}

fn text() -> Value {
    json!({ "type": "string" })
}

fn two(item: Value) -> Value {
    json!({ "type": "array", "items": item, "minItems": 2, "maxItems": 2 })
}

/// A table with these keys alone.
fn table(keys: &[&str], required: &[&str], of: &dyn Fn(&str) -> Value) -> Value {
    json!({
        "type": "object",
        "additionalProperties": false,
        "required": required,
        "properties": keyed(keys, of)
    })
}

fn amount() -> Value {
    json!({
        "description": "A value, a measure of the motion, or a table from a file.",
        "anyOf": [
            reference("scalar"),
            table(LOAD_TABLE_KEYS, &["table", "over"], &|key| match key {
                "factor" | "period" => reference("scalar"),
                _ => text(),
            })
        ]
    })
}

fn load() -> Value {
    let of = |key: &str| match key {
        "force" => json!({
            "description": "[x, y], or [size, direction] when the second is an angle.",
            "type": "array",
            "items": reference("amount"),
            "minItems": 2,
            "maxItems": 2
        }),
        "torque" => reference("amount"),
        _ => text(),
    };
    json!({ "anyOf": [
        table(FORCE_KEYS, &["force", "at"], &of),
        table(TORQUE_KEYS, &["torque", "on"], &of)
    ] })
}

/// A table whose small-letter names are the user's.
fn named(description: &str, of: Value) -> Value {
    json!({ "description": description, "type": "object", "additionalProperties": of })
}

fn file_key(key: &str) -> Value {
    match key {
        "title" => json!({ "description": "Title of the report.", "type": "string" }),
        "units" => json!({
            "description": "Units of bare numbers and of results; m and deg unless said otherwise.",
            "type": "object",
            "additionalProperties": false,
            "properties": keyed(UNIT_KEYS, &|_| json!({ "type": "string" }))
        }),
        "parameters" => named("Named dimensions of the design.", reference("scalar")),
        "links" => named(
            "Rigid bodies as sets of points; `frame` stands still.",
            reference("link"),
        ),
        "joints" => named(
            "Joints that a shared point name does not say.",
            reference("joint"),
        ),
        "drives" => named("What is moved from outside, and how.", reference("drive")),
        "assembly" => named(
            "Which assembly is meant, at the start of the drives.",
            json!({ "anyOf": [
                reference("side"),
                { "type": "object", "additionalProperties": false, "required": ["near"],
                  "properties": { "near": { "anyOf": [reference("scalar"), reference("pair")] } } }
            ] }),
        ),
        "measures" => named(
            "Named measures: expressions over what may be asked of the mechanism.",
            json!({ "type": "string" }),
        ),
        "gravity" => json!({
            "description": "Acceleration of gravity: [x, y], or its size along -y; 9.81 m/s^2 along -y unless said otherwise.",
            "anyOf": [reference("scalar"), reference("pair")]
        }),
        "loads" => named("Forces and torques from outside.", reference("load")),
        "masses" => named("Point masses on links: counterweights.", reference("mass")),
        "springs" => named("Springs.", reference("spring")),
        "dampers" => named("Dampers.", reference("damper")),
        "friction" => named(
            "Friction, by the point of a pin, by the name of a joint, or for `all`.",
            reference("friction"),
        ),
        "cylinders" => named(
            "Hydraulic cylinders, by the name of their drive.",
            reference("cylinder"),
        ),
        "motors" => named("Motors, by the name of their drive.", reference("motor")),
        "studies" => named("What is asked of the model.", reference("study")),
        key if ANNOUNCED_SECTIONS.contains(&key) => {
            json!({ "description": "Read by later versions.", "type": "object" })
        }
        _ => json!({}),
    }
}

fn link() -> Value {
    json!({
        "description": "Points by coordinates (P = [x, y]), by distances (A-B = 20) and sides, and mass properties.",
        "type": "object",
        "additionalProperties": false,
        "properties": keyed(LINK_KEYS, &|key| match key {
            "center" => json!({ "description": "\"centroid\", a point of the link, or a place on it.",
                "anyOf": [{ "type": "string" }, reference("pair")] }),
            "bar" => table(BAR_KEYS, BAR_KEYS, &|_| reference("scalar")),
            _ => reference("scalar"),
        }),
        "patternProperties": {
            "^[A-Z][A-Za-z0-9_]*$": { "anyOf": [reference("pair"), reference("side")] },
            "^[A-Z][A-Za-z0-9_]*-[A-Z][A-Za-z0-9_]*$": reference("scalar")
        }
    })
}

fn joint(kind: &str, keys: &[&str]) -> Value {
    let required: &[&str] = match kind {
        "slider" => &["slider", "at", "on"],
        "pin" => &["pin"],
        "weld" => &["weld"],
        "gears" => &["gears", "teeth"],
        "belt" => &["belt"],
        _ => &["rack", "pinion", "radius"],
    };
    json!({
        "type": "object",
        "additionalProperties": false,
        "required": required,
        "properties": keyed(keys, &|key| match key {
            "on" | "arc" => reference("line"),
            "angle" | "phase" | "radius" | "offset" | "pitch" => reference("scalar"),
            "weld" | "gears" | "belt" => two(json!({ "type": "string" })),
            "teeth" | "radii" => two(reference("scalar")),
            "internal" | "crossed" | "closed" => json!({ "type": "boolean" }),
            "side" => json!({ "enum": ["left", "right", "left of", "right of"] }),
            _ => json!({ "type": "string" }),
        })
    })
}

fn drive(kind: &str) -> Value {
    let mut keys = vec![kind];
    if kind == "turns" {
        keys.push("relative_to");
    }
    keys.extend(LAW_KEYS);
    let required: &[&str] = if kind == "cylinder" {
        &["cylinder"]
    } else {
        &[kind]
    };
    json!({
        "type": "object",
        "additionalProperties": false,
        "required": required,
        "properties": keyed(&keys, &|key| match key {
            "law" => json!({ "anyOf": [
                reference("law"),
                { "type": "array", "items": reference("piece"), "minItems": 1 },
                { "type": "object", "additionalProperties": false, "required": ["table"],
                  "properties": keyed(TABLE_KEYS, &|_| json!({ "type": "string" })) }
            ] }),
            key if key == kind || key == "relative_to" => json!({ "type": "string" }),
            _ => reference("scalar"),
        })
    })
}

fn study() -> Value {
    let texts = json!({ "anyOf": [{ "type": "string" }, { "type": "array", "items": { "type": "string" } }] });
    let along = |kind: &str, keys: &[&str], description: &str| {
        let mut study = table(keys, &["kind"], &|key| match key {
            "kind" => json!({ "const": kind }),
            "step" => reference("scalar"),
            "rows" => {
                json!({ "type": "integer", "minimum": 1, "maximum": crate::read::studies::MAX_ROWS })
            }
            "circuit" => json!({ "type": "boolean" }),
            "goal" => json!({ "enum": choices::GOALS.iter().map(|g| g.0).collect::<Vec<_>>() }),
            "on" => json!({ "type": "array", "items": { "type": "string" }, "minItems": 1 }),
            "radius" | "wanted" => reference("scalar"),
            "stiffness" | "preload" => two(reference("scalar")),
            "spring" | "drive" => json!({ "type": "string" }),
            "plot" => json!({
                "description": "Measures, path(P), of forces also hodograph(B, link); in brackets measures that share a picture.",
                "anyOf": [{ "type": "string" }, { "type": "array", "items": texts }]
            }),
            _ => texts.clone(),
        });
        if let Some(study) = study.as_object_mut() {
            study.insert("description".to_owned(), json!(description));
        }
        study
    };
    json!({ "anyOf": [
        along("motion", MOTION_KEYS, "The motion along the drives' laws."),
        along("forces", FORCES_KEYS, "What drives the motion and what the joints carry along it."),
        along("balance", choices::BALANCE_KEYS, "The counterweights that make it run quietly or hang in balance."),
        along("spring", choices::SPRING_KEYS, "The spring that leaves a wanted effort to a drive."),
        {
            "description": "Read by later versions.",
            "type": "object",
            "required": ["kind"],
            "properties": { "kind": { "enum": ANNOUNCED_KINDS } }
        }
    ] })
}
