//! Any text, path and value: an edit keeps every other byte, or is refused; parts are renamed, deleted and completed without harm.
#![no_main]

use kempe_model::{apply, complete, delete_with_dependants, parts, path_at, rename, value_edit};
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
    // that nothing else changes is looked at before an edit is given
    if let Ok(edit) = value_edit(text, &path, new) {
        apply(text, &[edit]).expect("an edit fits its text");
    }
});
