//! The `kempe` command line.
fn main() {}
