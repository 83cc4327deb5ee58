//! Any text, path and value: an edit keeps every other byte, or is refused; parts are renamed, deleted and completed without harm.
#![no_main]

use kempe_model::{apply, complete, delete_with_dependants, parts, path_at, rename, set_value};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: (&str, Vec<&str>, &str)| {
    let (text, path, new) = input;
    let at = new.len();
    path_at(text, at);
    for one in complete(text, at) {
        apply(text, &[one.edit]).expect("a completion fits its text");
    }
    for (part, _) in parts(text).iter().take(8) {
        if let Ok(edits) = rename(text, part, new) {
            apply(text, &edits).expect("a renaming fits its text");
        }
        let gone = delete_with_dependants(text, part).expect("a part that is there");
        apply(text, &gone.edits).expect("a deletion fits its text");
    }
    if let Ok(edited) = set_value(text, &path, new) {
        let same = text.bytes().zip(edited.bytes()).take_while(|(a, b)| a == b).count();
        let tail = text.bytes().rev().zip(edited.bytes().rev()).take_while(|(a, b)| a == b).count();
        // what differs is one stretch, no longer than the new value with its key (six bytes for an escaped one)
        assert!(edited.len() <= same + tail + new.len() + path.last().map_or(0, |key| 6 * key.len() + 16));
    }
});
