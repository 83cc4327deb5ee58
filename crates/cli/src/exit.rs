//! Exit codes: documented in `kempe --help` and relied on by scripts.

use std::process::ExitCode;

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Exit {
    /// All is well.
    Ok,
    /// The command did its work and found something: a warning of `check`, a miss of `verify`, rows not reached.
    Finding,
    /// The command line or the model file is wrong, or a file cannot be read or written.
    Usage,
    /// The mechanism cannot be solved.
    CannotSolve,
    /// Stopped by Ctrl-C, SIGTERM or SIGHUP; what was finished is kept.
    Interrupted,
}

impl Exit {
    /// The process's exit code.
    pub fn code(self) -> ExitCode {
        ExitCode::from(self.number())
    }

    /// The code as a number.
    pub fn number(self) -> u8 {
        match self {
            Self::Ok => 0,
            Self::Finding => 1,
            Self::Usage => 2,
            Self::CannotSolve => 3,
            Self::Interrupted => 130,
        }
    }
}
