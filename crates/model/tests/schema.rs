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

/// Every key of the schema is one the reader knows: a file with all of them gives no `unknown-key`.
#[test]
fn the_reader_knows_every_key_of_the_schema() {
    let schema = schema();
    let keys = |pointer: &str| -> Vec<String> {
        schema
            .pointer(pointer)
            .unwrap()
            .as_object()
            .unwrap()
            .keys()
            .cloned()
            .collect()
    };
    let table = |keys: Vec<String>| {
        keys.iter()
            .map(|k| format!("{k} = 1"))
            .collect::<Vec<_>>()
            .join(", ")
    };
    let mut text = format!(
        "units = {{ {} }}\n",
        table(keys("/properties/units/properties"))
    );
    text += &format!(
        "[links]\nframe = {{ {} }}\n",
        table(keys("/definitions/link/properties"))
    );
    text += "[joints]\n";
    for i in 0..5 {
        text += &format!(
            "j{i} = {{ {} }}\n",
            table(keys(&format!("/definitions/joint/anyOf/{i}/properties")))
        );
    }
    text += "[drives]\n";
    for i in 0..3 {
        text += &format!(
            "d{i} = {{ {} }}\n",
            table(keys(&format!("/definitions/drive/anyOf/{i}/properties")))
        );
    }
    let piece = table(keys("/definitions/piece/properties"));
    let of_table = table(keys(
        "/definitions/drive/anyOf/0/properties/law/anyOf/2/properties",
    ));
    text += &format!(
        "e = {{ turns = \"frame\", law = [ {{ {piece} }} ] }}\nf = {{ turns = \"frame\", law = {{ {of_table} }} }}\n"
    );
    for (section, definition) in [
        ("masses", "mass"),
        ("springs", "spring"),
        ("dampers", "damper"),
        ("friction", "friction"),
        ("cylinders", "cylinder"),
        ("motors", "motor"),
        ("loads", "load/anyOf/0"),
    ] {
        let name = match section {
            "friction" => "A",
            "cylinders" => "cyl",
            _ => "a",
        };
        text += &format!(
            "[{section}]\n{name} = {{ {} }}\n",
            table(keys(&format!("/definitions/{definition}/properties")))
        );
    }
    let of_load = table(keys("/definitions/amount/anyOf/1/properties"));
    let of_torque = table(keys("/definitions/load/anyOf/1/properties"))
        .replace("torque = 1", &format!("torque = {{ {of_load} }}"));
    text += &format!("t = {{ {of_torque} }}\n[studies.f]\nkind = \"forces\"\n");
    text += &table(keys("/definitions/study/anyOf/1/properties"))
        .replace("kind = 1, ", "")
        .replace(", ", "\n");
    text += &format!(
        "\n[studies.s]\n{}\n",
        table(keys("/definitions/study/anyOf/0/properties")).replace(", ", "\n")
    );
    text = text.replace("kind = 1", "kind = \"motion\"");
    let Err(found) = kempe_model::Model::from_toml(&text, "x", &mut |_| Err(String::new())) else {
        panic!()
    };
    let unknown: Vec<_> = found.iter().filter(|d| d.code == "unknown-key").collect();
    assert!(unknown.is_empty(), "{unknown:#?}\n{text}");
    for key in keys("/properties") {
        let Err(found) =
            kempe_model::Model::from_toml(&format!("{key} = 1"), "x", &mut |_| Err(String::new()))
        else {
            panic!()
        };
        assert!(found.iter().all(|d| d.code != "unknown-key"), "{key}");
    }
}
