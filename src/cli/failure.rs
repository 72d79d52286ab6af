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
}

impl Failure {
    /// Says it on stderr (help on stdout); 0 after help, 1 if the work failed, 2 on wrong usage.
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
