//! `radiosity generate`: what shells and `man` want to know of the command.

use std::io;
use std::path::{Path, PathBuf};

use clap::{Args, Command, Subcommand};
use clap_complete::Shell;
use radiosity::Error;

use super::console;
use super::failure::Failure;

/// Write completions for a shell, or manual pages
#[derive(Debug, Args)]
pub(crate) struct Generate {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Completions for a shell, on stdout: radiosity generate completions bash > ~/.local/share/bash-completion/completions/radiosity
    Completions { shell: Shell },
    /// Manual pages of the command and all its subcommands, into a folder: radiosity generate man ~/.local/share/man/man1
    Man { folder: PathBuf },
}

impl Generate {
    pub(crate) fn run(self, mut command: Command) -> Result<(), Failure> {
        match self.what {
            What::Completions { shell } => {
                let mut script = Vec::new();
                clap_complete::generate(shell, &mut command, "radiosity", &mut script);
                Ok(console::print(String::from_utf8_lossy(&script).trim_end())?)
            }
            What::Man { folder } => {
                let io = |error: io::Error| Error::io(Path::new(&folder))(error);
                Ok(clap_mangen::generate_to(command, &folder).map_err(io)?)
            }
        }
    }
}
