//! Where the finished parts of a study are kept.

use kempe_model::Diagnostic;

/// Where the finished parts of a study are kept: core crates touch no files. A part has a number from 0; the study alone decides which
/// designs are in it. Of a study that looks for something, parts are what it has asked so far, one after the other, and how many there will be is not known.
pub trait Parts {
    /// The bytes that were kept of a part; none where it is still to be computed.
    ///
    /// # Errors
    ///
    /// Why they cannot be had.
    fn kept(&mut self, part: usize) -> Result<Option<Vec<u8>>, Box<Diagnostic>>;

    /// Keeps the bytes of a part that was computed, or that was kept and could not be read.
    ///
    /// # Errors
    ///
    /// Why it cannot be kept.
    fn keep(&mut self, part: usize, bytes: Vec<u8>) -> Result<(), Box<Diagnostic>>;

    /// Whether a part is computed where it was not kept.
    fn computes(&self, part: usize) -> bool {
        let _ = part;
        true
    }

    /// Whether the rows of every design are kept.
    fn rows(&self) -> bool {
        true
    }
}

/// Keeps nothing.
pub(crate) struct Unkept;

impl Parts for Unkept {
    fn kept(&mut self, _: usize) -> Result<Option<Vec<u8>>, Box<Diagnostic>> {
        Ok(None)
    }

    fn keep(&mut self, _: usize, _: Vec<u8>) -> Result<(), Box<Diagnostic>> {
        Ok(())
    }

    fn rows(&self) -> bool {
        false
    }
}
