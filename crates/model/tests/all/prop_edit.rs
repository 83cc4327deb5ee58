//! Editing one value keeps every other byte, and reading back gives the value.
#![allow(clippy::unwrap_used)]

use kempe_model::{STARTERS, set_value};
use proptest::prelude::*;

/// Every path to a plain value of a table, in the order of writing.
fn paths(value: &toml::Value, here: &mut Vec<String>, out: &mut Vec<Vec<String>>) {
    match value {
        toml::Value::Table(table) => {
            for (key, value) in table {
                here.push(key.clone());
                paths(value, here, out);
                here.pop();
            }
        }
        toml::Value::Array(items) => {
            for (i, value) in items.iter().enumerate() {
                here.push(i.to_string());
                paths(value, here, out);
                here.pop();
            }
        }
        _ => out.push(here.clone()),
    }
}

fn at<'v>(value: &'v toml::Value, path: &[String]) -> &'v toml::Value {
    path.iter().fold(value, |v, part| match v {
        toml::Value::Array(items) => &items[part.parse::<usize>().unwrap()],
        v => &v[part.as_str()],
    })
}

proptest! {
    #[test]
    fn other_bytes_stay_and_the_value_is_there(
        starter in 0..STARTERS.len(),
        pick in 0usize..1000,
        number in -1e6f64..1e6,
        unit in "[a-z \\\\\"#é]{0,6}",
        crlf: bool,
    ) {
        let text = if crlf { STARTERS[starter].text.replace('\n', "\r\n") } else { STARTERS[starter].text.to_owned() };
        let before: toml::Value = toml::from_str(&text).unwrap();
        let mut all = Vec::new();
        paths(&before, &mut Vec::new(), &mut all);
        let path = &all[pick % all.len()];
        let new = toml::Value::String(format!("{number}{unit}"));
        let parts: Vec<&str> = path.iter().map(String::as_str).collect();
        let edited = set_value(&text, &parts, &new.to_string()).unwrap();
        let after: toml::Value = toml::from_str(&edited).unwrap();
        prop_assert_eq!(at(&after, path), &new);
        // undoing the edit with the old text gives the old bytes
        let start = text.bytes().zip(edited.bytes()).take_while(|(a, b)| a == b).count();
        let end = text[start..].bytes().rev().zip(edited[start..].bytes().rev()).take_while(|(a, b)| a == b).count();
        prop_assert!(text.len() - end - start <= at(&before, path).to_string().len());
        let mut rest = Vec::new();
        paths(&after, &mut Vec::new(), &mut rest);
        prop_assert_eq!(&rest, &all);
        for other in all.iter().filter(|p| *p != path) {
            prop_assert_eq!(at(&before, other), at(&after, other));
        }
    }
}
