//! The tests of `kempe-model`, one program: each file is a room of its own.

mod bad;
mod codes;
mod complete;
mod docs;
mod drawn;
mod edits;
mod examples;
mod hostile;
mod keys;
mod language;
mod one_cause;
mod overrides;
mod prop_edit;
mod prop_write;
mod registry;
mod schema;
mod write;

#[path = "../support/mutants.rs"]
mod mutants;
