//! The JSON schema against files that read well and files that do not.
#![allow(clippy::unwrap_used)]

use kempe_model::{STARTERS, schema};
use serde_json::Value;

/// The part of draft-07 that the schema uses.
fn valid(root: &Value, schema: &Value, value: &Value) -> bool {
    if let Some(path) = schema["$ref"].as_str() {
        return valid(
            root,
            root.pointer(path.trim_start_matches('#')).unwrap(),
            value,
        );
    }
    let has = |key: &str| schema.get(key).is_some();
    let list = |key: &str| schema[key].as_array().cloned().unwrap_or_default();
    let type_fits = |name: &str| match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_i64(),
        "number" => value.is_number(),
        other => panic!("{other}"),
    };
    let types = match &schema["type"] {
        Value::Null => true,
        Value::String(name) => type_fits(name),
        names => names
            .as_array()
            .unwrap()
            .iter()
            .any(|n| type_fits(n.as_str().unwrap())),
    };
    let size = value.as_array().map_or(0, Vec::len) as u64;
    types
        && (!has("anyOf") || list("anyOf").iter().any(|s| valid(root, s, value)))
        && list("allOf").iter().all(|s| valid(root, s, value))
        && (!has("oneOf")
            || list("oneOf")
                .iter()
                .filter(|s| valid(root, s, value))
                .count()
                == 1)
        && (!has("enum") || list("enum").contains(value))
        && (!has("const") || schema["const"] == *value)
        && (!has("pattern") || value.as_str().is_none_or(|s| s.contains("->")))
        && list("required")
            .iter()
            .all(|key| value.get(key.as_str().unwrap()).is_some())
        && (!value.is_array()
            || schema["minItems"].as_u64().unwrap_or(0) <= size
                && size <= schema["maxItems"].as_u64().unwrap_or(u64::MAX))
        && value.as_array().is_none_or(|items| {
            !has("items") || items.iter().all(|v| valid(root, &schema["items"], v))
        })
        && value
            .as_object()
            .is_none_or(|o| o.iter().all(|(key, v)| entry_valid(root, schema, key, v)))
}

fn entry_valid(root: &Value, schema: &Value, key: &str, value: &Value) -> bool {
    if let Some(own) = schema["properties"].get(key) {
        return valid(root, own, value);
    }
    for (pattern, own) in schema["patternProperties"]
        .as_object()
        .into_iter()
        .flatten()
    {
        let pair = pattern.contains("-[A-Z]");
        if key.starts_with(char::is_uppercase) && pair == key.contains('-') {
            return valid(root, own, value);
        }
    }
    match &schema["additionalProperties"] {
        Value::Null | Value::Bool(true) => true,
        Value::Bool(false) => false,
        own => valid(root, own, value),
    }
}

fn check(text: &str) -> bool {
    let value: toml::Value = toml::from_str(text).unwrap();
    valid(&schema(), &schema(), &serde_json::to_value(value).unwrap())
}

#[test]
fn files_that_read_are_valid() {
    for starter in STARTERS {
        assert!(check(starter.text), "{}", starter.name);
    }
    for name in [
        "crank-rocker",
        "slider-crank",
        "door-lock",
        "tractor-hitch",
        "joints",
        "forces",
    ] {
        let path = format!("{}/tests/good/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        assert!(check(&std::fs::read_to_string(path).unwrap()), "{name}");
    }
}

#[test]
fn examples_of_the_repository_are_valid() {
    for folder in ["seeds", "gallery", "benchmarks"] {
        let folder = format!("{}/../../examples/{folder}", env!("CARGO_MANIFEST_DIR"));
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|e| e == "toml") {
                let text = std::fs::read_to_string(&path).unwrap();
                assert!(check(&text), "{}", path.display());
            }
        }
    }
}

#[test]
fn files_of_the_wrong_shape_are_not() {
    for name in [
        "unknown-key",
        "wrong-type",
        "missing-key",
        "bad-name",
        "unknown-study",
        "bad-choice",
    ] {
        let path = format!("{}/tests/bad/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        assert!(!check(&std::fs::read_to_string(path).unwrap()), "{name}");
    }
}

/// Every key of the table of keys is in the schema with its sentence and its example, and nothing else is.
#[test]
fn the_schema_describes_every_key() {
    fn described(schema: &Value, all: &mut Vec<(String, String)>) {
        for (key, value) in schema.as_object().into_iter().flatten() {
            for (name, property) in value.as_object().into_iter().flatten() {
                if matches!(key.as_str(), "properties" | "patternProperties") {
                    let about = property["description"].as_str().unwrap_or("").to_owned();
                    all.push((name.trim_start_matches('^').to_owned(), about));
                }
            }
            described(value, all);
        }
        schema
            .as_array()
            .into_iter()
            .flatten()
            .for_each(|item| described(item, all));
    }
    let mut all = Vec::new();
    described(&schema(), &mut all);
    let mut known = Vec::new();
    kempe_model::language::visit_keys(&mut |_, _, key| known.push((key.name, key.about)));
    for (name, about) in &known {
        let found = all
            .iter()
            .any(|(n, a)| a == about && (n == name || n.starts_with('[')));
        assert!(found, "{name}: {about}");
    }
    for (name, about) in all.iter().filter(|(name, _)| !name.starts_with('[')) {
        assert!(known.contains(&(name, about)), "{name}: {about}");
    }
}

#[test]
fn every_example_is_valid() {
    kempe_model::language::visit_keys(&mut |section, kind, key| {
        if section.is_empty() {
            return;
        }
        let text = format!("example = {}", key.example);
        let value: toml::Value = toml::from_str(&text).unwrap();
        let value = serde_json::to_value(value).unwrap();
        let root = schema();
        let own = kinds(&root).into_iter().find_map(|table| {
            let own = &table["properties"][key.name];
            (own["description"] == key.about).then_some(own)
        });
        let own = own.or_else(|| {
            (key.name == "P" || key.name == "A-B").then_some(&root["definitions"]["scalar"])
        });
        assert!(
            key.name == "P" || key.name == "kind" || valid(&root, own.unwrap(), &value["example"]),
            "{section}, {}: {}",
            kind.name,
            key.name
        );
    });
}

/// Every table of a schema.
fn kinds(schema: &Value) -> Vec<&Value> {
    let inner = schema
        .as_object()
        .into_iter()
        .flat_map(|o| o.values())
        .chain(schema.as_array().into_iter().flatten());
    let mut all: Vec<&Value> = inner.flat_map(kinds).collect();
    if schema.get("properties").is_some() {
        all.push(schema);
    }
    all
}
