//! Any text, path and value: an edit keeps every other byte, or is refused.
#![no_main]

use kempe_model::set_value;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: (&str, Vec<&str>, &str)| {
    let (text, path, new) = input;
    if let Ok(edited) = set_value(text, &path, new) {
        let same = text.bytes().zip(edited.bytes()).take_while(|(a, b)| a == b).count();
        let tail = text.bytes().rev().zip(edited.bytes().rev()).take_while(|(a, b)| a == b).count();
        // what differs is one stretch, no longer than the new value with its key (six bytes for an escaped one)
        assert!(edited.len() <= same + tail + new.len() + path.last().map_or(0, |key| 6 * key.len() + 16));
    }
});
