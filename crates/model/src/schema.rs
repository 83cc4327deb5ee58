//! The JSON schema of the model file, for editors: draft-07, a walk over the table of keys.

use serde_json::{Map, Value, json};

use crate::key_table::{FILE, PIECE};
use crate::keys::{Key, Kind, Need, Takes};

/// The JSON schema (draft-07) of the model file.
///
/// It knows the shape; names, dimensions and geometry are checked by reading alone.
pub fn schema() -> Value {
    let mut definitions = Map::new();
    let mut define = |name: &str, schema: Value| definitions.insert(name.to_owned(), schema);
    define(
        "scalar",
        json!({
            "description": "A bare number in the file's unit, or a string: a value with its unit, or an expression over parameters.",
            "type": ["number", "string"]
        }),
    );
    define(
        "pair",
        json!({
            "description": "[x, y], or [radius, angle] when the second is an angle.",
            "type": "array",
            "items": reference("scalar"),
            "minItems": 2,
            "maxItems": 2
        }),
    );
    define(
        "side",
        json!({
            "description": "The side of a directed line on which a point lies.",
            "type": "string",
            "pattern": "^\\s*(left|right)\\s+of\\s.*->"
        }),
    );
    define(
        "line",
        json!({ "description": "A directed line.", "type": "string", "pattern": "->" }),
    );
    define(PIECE.what, table(&PIECE));
    for section in FILE.keys() {
        if let Takes::Entries(kinds) = section.takes {
            let kinds_read: Vec<Value> = kinds.iter().map(|kind| entry(kind)).collect();
            let schema = match <[Value; 1]>::try_from(kinds_read) {
                Ok([one]) => one,
                Err(several) => json!({ "anyOf": several }),
            };
            define(definition_of(kinds), schema);
        }
    }
    let mut file = table(&FILE);
    if let Some(file) = file.as_object_mut() {
        // an editor starts from an empty file
        file.remove("required");
        file.insert(
            "$schema".to_owned(),
            json!("http://json-schema.org/draft-07/schema#"),
        );
        file.insert("title".to_owned(), json!("Kempe model"));
        file.insert("definitions".to_owned(), Value::Object(definitions));
    }
    file
}

fn reference(definition: &str) -> Value {
    json!({ "$ref": format!("#/definitions/{definition}") })
}

/// The definition of the kinds of one section: the word for what they are.
fn definition_of(kinds: &[&Kind]) -> &'static str {
    let what = kinds.first().map_or("", |kind| kind.what);
    what.split(' ').next().unwrap_or(what)
}

/// An entry of a kind: its table, or the value that may stand alone for it.
fn entry(kind: &Kind) -> Value {
    match kind.alone() {
        Some(alone) => json!({ "anyOf": [table(kind), of(&alone.takes)] }),
        None => table(kind),
    }
}

/// A table with the keys of a kind alone.
fn table(kind: &Kind) -> Value {
    let mut properties = Map::new();
    let mut patterns = Map::new();
    for row in kind.keys() {
        let mut schema = match row.name {
            // a word of a task stands behind that of the kind
            "kind" => json!({ "const": kind.name.split(' ').next().unwrap_or(kind.name) }),
            _ => of(&row.takes),
        };
        tell(&mut schema, row);
        properties.insert(row.name.to_owned(), schema);
    }
    for row in kind.points {
        const POINT: &str = "[A-Z][A-Za-z0-9_]*";
        let pattern = match row.takes {
            Takes::Value(_) => format!("^{POINT}-{POINT}$"),
            _ => format!("^{POINT}$"),
        };
        let mut schema = of(&row.takes);
        tell(&mut schema, row);
        patterns.insert(pattern, schema);
    }
    let those = |need: Need| {
        kind.keys()
            .filter(move |row| row.need == need)
            .map(|row| row.name)
    };
    let required: Vec<&str> = those(Need::Required).collect();
    let one_of: Vec<Value> = those(Need::OneOf)
        .map(|name| json!({ "required": [name] }))
        .collect();
    let mut table = json!({
        "description": kind.about,
        "type": "object",
        "additionalProperties": false,
        "properties": properties
    });
    let mut add = |key: &str, value: Value| {
        if let (Some(table), false) = (
            table.as_object_mut(),
            value == json!([]) || value == json!({}),
        ) {
            table.insert(key.to_owned(), value);
        }
    };
    add("patternProperties", Value::Object(patterns));
    add("required", json!(required));
    add("oneOf", json!(one_of));
    table
}

fn describe(schema: &mut Value, about: &str) {
    // beside a reference nothing counts
    if schema.get("$ref").is_some() {
        *schema = json!({ "allOf": [schema.take()] });
    }
    if let Some(schema) = schema.as_object_mut() {
        schema.insert("description".to_owned(), json!(about));
    }
}

/// What a key says, and an example of it.
fn tell(schema: &mut Value, row: &Key) {
    describe(schema, row.about);
    let example = toml::from_str::<Value>(&format!("example = {}", row.example));
    if let (Some(schema), Ok(example)) = (schema.as_object_mut(), example) {
        schema.insert("examples".to_owned(), json!([example["example"]]));
    }
}

/// What a key takes.
fn of(takes: &Takes) -> Value {
    match takes {
        Takes::Text | Takes::Name(_) | Takes::Unit(_) | Takes::PointPair | Takes::Measure => {
            json!({ "type": "string" })
        }
        Takes::Flag => json!({ "type": "boolean" }),
        Takes::Count(most) => json!({ "type": "integer", "minimum": 1, "maximum": most }),
        Takes::Value(_) | Takes::AnyValue => reference("scalar"),
        Takes::Pair(_) => reference("pair"),
        Takes::Line => reference("line"),
        Takes::Side => reference("side"),
        Takes::Amount(kind) => json!({ "anyOf": [reference("scalar"), table(kind)] }),
        Takes::Words(words) => json!({ "enum": words }),
        Takes::Two(one) => {
            json!({ "type": "array", "items": of(one), "minItems": 2, "maxItems": 2 })
        }
        Takes::List(one, least) => {
            json!({ "type": "array", "items": of(one), "minItems": least })
        }
        Takes::AnyOf(some) => json!({ "anyOf": some.iter().map(of).collect::<Vec<_>>() }),
        Takes::Table(kind) if kind.what == PIECE.what => reference(kind.what),
        Takes::Table(kind) => table(kind),
        Takes::Values(one) => json!({ "type": "object", "additionalProperties": of(one) }),
        Takes::Entries(kinds) => {
            json!({ "type": "object", "additionalProperties": reference(definition_of(kinds)) })
        }
    }
}
