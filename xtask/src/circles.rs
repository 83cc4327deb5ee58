//! No circles of files: none takes names from a file that, straight or through others, takes names from it.
//!
//! What a file hands on (`pub use`) is looked up where it is defined. Tests do not count, nor what macros write, nor methods.

mod arrows;
mod source;

use std::path::Path;

use self::arrows::{Arrows, in_circles};
use self::source::Source;
use crate::shell::root;

/// Looks through all crates.
///
/// # Errors
///
/// The arrows that circles are made of, or a file that cannot be read.
pub fn circles() -> Result<(), String> {
    println!("\n> circles of files");
    let folder = root().join("crates");
    let entries = std::fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut crates: Vec<_> = entries.flatten().map(|entry| entry.path()).collect();
    crates.push(root().join("xtask"));
    crates.sort();
    let mut told = String::new();
    for folder in crates {
        for top in ["src/lib.rs", "src/main.rs"].map(|file| folder.join(file)) {
            if top.exists() {
                let source = Source::read(&top, &|path| std::fs::read_to_string(path).ok())?;
                told += &lines(&in_circles(&source.arrows()));
            }
        }
    }
    match told.is_empty() {
        true => Ok(()),
        false => Err(format!("circles of files are made of\n{told}")),
    }
}

/// A line for each arrow.
fn lines(arrows: &Arrows) -> String {
    let root = root();
    let shown = |path: &Path| {
        path.strip_prefix(&root)
            .unwrap_or(path)
            .display()
            .to_string()
    };
    let mut lines = String::new();
    for ((from, to), names) in arrows {
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        lines += &format!("  {} -> {}: {}\n", shown(from), shown(to), names.join(", "));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The arrows in circles of a crate whose root is `lib.rs`, and all others.
    fn look(files: &[(&str, &str)]) -> (String, usize) {
        let read = |path: &Path| {
            let found = files.iter().find(|(name, _)| Path::new(name) == path);
            found.map(|(_, text)| (*text).to_owned())
        };
        let arrows = Source::read(Path::new("lib.rs"), &read).unwrap().arrows();
        (lines(&in_circles(&arrows)), arrows.len())
    }

    #[test]
    fn arrows_that_run_one_way_are_no_circle() {
        let files = [
            ("lib.rs", "mod a; mod b; mod c; pub use b::B;"),
            ("a.rs", "use crate::{B, c::f}; fn g() { f() }"),
            ("b.rs", "pub struct B(crate::c::C);"),
            (
                "c.rs",
                "pub struct C; pub fn f() {} #[cfg(test)] mod tests { use crate::a::g; }",
            ),
        ];
        assert_eq!(look(&files), (String::new(), 3));
    }

    #[test]
    fn circles_are_found_through_what_is_handed_on() {
        let files = [
            ("lib.rs", "mod a; mod b; mod d; pub use a::A;"),
            ("a.rs", "use crate::b; pub struct A; fn f() { b::f() }"),
            ("b.rs", "mod c; use self::c::C; pub fn f() {}"),
            ("b/c.rs", "pub struct C(super::super::A);"),
            ("d.rs", "use crate::A; fn f() {}"),
        ];
        let told = "  a.rs -> b.rs: f\n  b/c.rs -> a.rs: A\n  b.rs -> b/c.rs: C\n";
        assert_eq!(look(&files), (told.to_owned(), 4));
    }

    #[test]
    fn parents_and_children_may_not_use_each_other() {
        let files = [
            ("lib.rs", "mod a;"),
            ("a/mod.rs", "mod b; use b::f; pub trait T {}"),
            (
                "a/b.rs",
                "use super::*; pub fn f() {} impl super::T for u8 {}",
            ),
        ];
        let told = "  a/b.rs -> a/mod.rs: *, T\n  a/mod.rs -> a/b.rs: f\n";
        assert_eq!(look(&files), (told.to_owned(), 2));
    }
}
