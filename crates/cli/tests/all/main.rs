//! The tests of `kempe-cli`, one program: each file is a room of its own.

mod against;
mod causes;
mod codes;
mod designs;
mod front_page;
mod messages;
mod nothing_lost;
mod one_voice;
mod pages;
mod report_in_time;
mod report_page;
mod run;
mod search;
mod simulations_refused;
mod sweep;
mod two_formulations;

#[cfg(unix)]
#[path = "../browser/mod.rs"]
mod browser;
#[path = "../support/mod.rs"]
mod support;
