//! Kempe's core for a browser, or any other host of WebAssembly: the same bytes as the native program, and no imports.
//!
//! A host writes a [`Request`] as JSON into the room that [`exports::request`] gives it, calls [`exports::check`] or
//! [`exports::run`], and reads the answer. Plain numbers cross the border, so no generated glue is needed:
//!
//! ```js
//! const bytes = new TextEncoder().encode(JSON.stringify({ text, study: "turn" }));
//! const at = core.request(bytes.length);
//! new Uint8Array(core.memory.buffer, at, bytes.length).set(bytes);
//! const ok = core.run() === 0;
//! const answer = new Uint8Array(core.memory.buffer, core.answer(), core.answer_length());
//! ```

pub mod exports;
mod request;

pub use request::{Request, check, run};
