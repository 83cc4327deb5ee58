//! What a host calls. One request at a time stands in the module's memory, and one answer.
#![allow(
    unsafe_code,
    reason = "an exported name may clash with another; nothing else here is unsafe"
)]

use std::cell::RefCell;

use crate::request::{self, Request};

thread_local! {
    static REQUEST: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static ANSWER: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

/// What [`check`] and [`run`] return when the answer is what was asked for.
pub const ANSWERED: u32 = 0;
/// What [`check`] and [`run`] return when the answer is `{ "diagnostics": […] }`, which say why there is no other.
pub const REFUSED: u32 = 1;

/// Room for a request of `length` bytes, for the host to write a [`Request`] as JSON. It stays until the next call of
/// this function; growing memory may move the host's view of it, not its address.
#[unsafe(no_mangle)]
pub extern "C" fn request(length: usize) -> *mut u8 {
    REQUEST.with_borrow_mut(|room| {
        room.clear();
        room.resize(length, 0);
        room.as_mut_ptr()
    })
}

/// Checks the requested model; the answer is JSON, see [`request::check`](crate::check).
#[unsafe(no_mangle)]
pub extern "C" fn check() -> u32 {
    answered(|request| request::check(request).map(|report| report.to_string()))
}

/// Runs the requested study; the answer is CSV, see [`request::run`](crate::run).
#[unsafe(no_mangle)]
pub extern "C" fn run() -> u32 {
    answered(request::run)
}

/// Where the last answer stands. It stays until the next [`check`] or [`run`].
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> *const u8 {
    ANSWER.with_borrow(Vec::as_ptr)
}

/// How many bytes the last answer has.
#[unsafe(no_mangle)]
pub extern "C" fn answer_length() -> usize {
    ANSWER.with_borrow(Vec::len)
}

fn answered(work: impl Fn(&Request) -> Result<String, serde_json::Value>) -> u32 {
    let request = REQUEST.with_borrow(|bytes| Request::from_json(bytes));
    let (status, text) = match request.and_then(|request| work(&request)) {
        Ok(text) => (ANSWERED, text),
        Err(refusal) => (REFUSED, refusal.to_string()),
    };
    ANSWER.set(text.into_bytes());
    status
}
