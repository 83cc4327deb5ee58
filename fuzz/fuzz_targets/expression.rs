//! Any text as an expression: a tree, or issues whose places lie in the text.
#![no_main]

use kempe_units::{Unit, parse, parse_condition};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    match parse(text) {
        Ok(tree) => assert!(text.get(tree.span.clone()).is_some()),
        Err(issues) => {
            for issue in issues {
                assert!(text.get(issue.span.clone()).is_some(), "{issue:?}");
            }
        }
    }
    let _ = parse_condition(text);
    let _ = Unit::parse(text);
});
