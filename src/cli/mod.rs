//! What the command understands, and how it ends: 0 done, 1 failed, 2 wrong usage, 3 ended early.

mod compare;
mod compared;
mod config;
mod console;
mod enclosure;
mod estimate;
mod facts;
mod failure;
mod form_factors;
mod generate;
mod grid;
mod info;
mod interrupt;
mod lighting;
mod lightmap;
mod memory;
mod meter;
mod options;
mod outputs;
mod page;
mod pictures;
mod record;
mod relight;
mod render;
mod report;
mod solve;
mod streams;
mod summary;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use failure::Failure;

/// Light in scenes of diffuse surfaces: an adaptive mesh that carries it, and pictures of it
#[derive(Debug, Parser)]
#[command(version, max_term_width = 100, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "\
Examples:
  radiosity solve scenes/cornell-box.obj -o cornell.glb --image cornell.png
  radiosity render cornell.glb -o mesh.png --view wireframe
  radiosity relight office.glb --light 'panel=50%' -o dim.glb
  radiosity compare scenes/cornell-box.obj --csv runs.csv
  radiosity form-factors scenes/furnace.obj --patch-size 1 -o F.json
  radiosity info scenes/office.obj

`radiosity help solve` explains every option.
Exit codes: 0 done; 1 failed; 2 wrong usage; 3 ended early by Ctrl-C, SIGTERM or a time limit, what there is
is written and marked as unfinished; 130 or 143 ended by Ctrl-C or SIGTERM before there was anything to write.";

#[derive(Debug, Subcommand)]
enum Command {
    Solve(Box<solve::Solve>),
    Render(render::Render),
    Relight(relight::Relight),
    Compare(Box<compare::Compare>),
    FormFactors(form_factors::FormFactorsCommand),
    Info(info::Info),
    #[command(hide = true)]
    Generate(generate::Generate),
}

/// Does what the arguments say, the program's name first among them.
pub(crate) fn run(arguments: Vec<OsString>) -> ExitCode {
    match parse(arguments).and_then(|cli| cli.command.run()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.tell(),
    }
}

fn parse(arguments: Vec<OsString>) -> Result<Cli, Failure> {
    let cli = parsed(&arguments)?;
    let Command::Solve(solve) = &cli.command else {
        return Ok(cli);
    };
    match &solve.config {
        Some(path) => Ok(parsed(&config::merged(&command(), arguments, path)?)?),
        None => Ok(cli),
    }
}

fn parsed(arguments: &[OsString]) -> Result<Cli, clap::Error> {
    Cli::from_arg_matches(&command().try_get_matches_from(arguments)?)
}

/// The command with all its options. A number below zero is a value, to be judged by its option: no option is a number.
fn command() -> clap::Command {
    let takes_number = |option: clap::Arg| {
        let is_valued = option.get_long().is_some() && option.get_action().takes_values();
        if is_valued { option.allow_negative_numbers(true) } else { option }
    };
    Cli::command().mut_subcommands(|subcommand| subcommand.mut_args(takes_number))
}

impl Command {
    fn run(self) -> Result<(), Failure> {
        match self {
            Self::Solve(solve) => solve.run(),
            Self::Render(render) => render.run(),
            Self::Relight(relight) => relight.run(),
            Self::Compare(compare) => compare.run(),
            Self::FormFactors(form_factors) => form_factors.run(),
            Self::Info(info) => info.run(),
            Self::Generate(generate) => generate.run(command()),
        }
    }
}
