//! The JSON schema of the model file, for editors: draft-07, made of the same tables the reader reads by.

use serde_json::{Map, Value, json};

use crate::model::RiseLaw;
use crate::read::drives::DRIVE_KINDS;
use crate::read::joints::JOINT_KEYS;
use crate::read::law_table::TABLE_KEYS;
use crate::read::laws::{LAW_KEYS, PIECE_KEYS};
use crate::read::links::LINK_KEYS;
use crate::read::sections::{ANNOUNCED_SECTIONS, FILE_KEYS, UNIT_KEYS};
use crate::read::studies::{ANNOUNCED_KINDS, MOTION_KEYS};

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
        "pin" => &["pin", "on"],
        "weld" => &["weld"],
        "gears" => &["gears", "teeth"],
        _ => &["rack", "pinion", "radius"],
    };
    let two = |item: Value| json!({ "type": "array", "items": item, "minItems": 2, "maxItems": 2 });
    json!({
        "type": "object",
        "additionalProperties": false,
        "required": required,
        "properties": keyed(keys, &|key| match key {
            "on" => reference("line"),
            "angle" | "phase" | "radius" | "offset" => reference("scalar"),
            "weld" | "gears" => two(json!({ "type": "string" })),
            "teeth" => two(reference("scalar")),
            "internal" => json!({ "type": "boolean" }),
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
    json!({ "anyOf": [
        {
            "description": "The motion along the drives' laws.",
            "type": "object",
            "additionalProperties": false,
            "required": ["kind"],
            "properties": keyed(MOTION_KEYS, &|key| match key {
                "kind" => json!({ "const": "motion" }),
                "step" => reference("scalar"),
                "rows" => json!({ "type": "integer", "minimum": 1, "maximum": crate::read::studies::MAX_ROWS }),
                "circuit" => json!({ "type": "boolean" }),
                _ => texts.clone(),
            })
        },
        {
            "description": "Read by later versions.",
            "type": "object",
            "required": ["kind"],
            "properties": { "kind": { "enum": ANNOUNCED_KINDS } }
        }
    ] })
}
