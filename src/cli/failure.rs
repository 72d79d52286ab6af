//! Why the command did not do what it was asked, and the exit code that says so.

use std::process::ExitCode;

use radiosity::Error;

use super::console;

/// How the command may end early.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The arguments are wrong, or help was asked for.
    Arguments(clap::Error),
    /// What the arguments or the configuration file ask for does not exist.
    Usage(Error),
    /// The work failed.
    Work(Error),
    /// The work was ended early, by a signal or a limit of time; what there was by then is written.
    Unfinished,
    /// It was ended before there was anything to write; the exit code.
    Empty(u8),
}

/// Exit code of work that was ended early, and has written what there was.
const UNFINISHED: u8 = 3;

impl Failure {
    /// Says it on stderr (help on stdout); 0 after help, 1 if the work failed, 2 on wrong usage, 3 if it is unfinished.
    pub(crate) fn tell(self) -> ExitCode {
        match self {
            Self::Arguments(error) => {
                // Nobody is left to be told when the message cannot be written.
                let _ = error.print();
                if error.use_stderr() { ExitCode::from(2) } else { ExitCode::SUCCESS }
            }
            Self::Usage(error) => {
                console::tell(&format!("radiosity: {error}"));
                ExitCode::from(2)
            }
            Self::Work(error) => {
                console::tell(&format!("radiosity: {error}"));
                ExitCode::from(1)
            }
            // It has been told when the end was asked for.
            Self::Empty(code) => {
                console::tell("radiosity: ended too early; there is nothing to write");
                ExitCode::from(code)
            }
            Self::Unfinished => ExitCode::from(UNFINISHED),
        }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            Error::Setting { .. } | Error::UnknownFormat { .. } => Self::Usage(error),
            _ => Self::Work(error),
        }
    }
}

impl From<clap::Error> for Failure {
    fn from(error: clap::Error) -> Self {
        Self::Arguments(error)
    }
}
