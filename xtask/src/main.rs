//! Kempe developer tasks.
fn main() {}
