//! The command: what it writes, says and returns.

mod compare;
mod config;
mod form_factors;
mod guide;
#[cfg(unix)]
mod interrupt;
mod lights;
mod outputs;
mod page;
mod repairs;
mod solve;
mod usage;
mod views;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

/// Options that make a solution of the Cornell box a matter of a moment.
const COARSE: [&str; 6] = ["--uniform", "0.2", "--hemicube-resolution", "32", "--stop", "5%"];

/// A directory of its own to run the command in, with another, `deep`, in it.
struct Place(TempDir);

impl Place {
    fn new() -> Self {
        let place = Self(tempfile::tempdir().expect("temporary directories can be made"));
        std::fs::create_dir(place.path("deep")).expect("temporary directories can be made");
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).expect("temporary files can be written");
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_radiosity"));
        command.args(arguments).current_dir(self.0.path());
        command
    }

    fn run(&self, arguments: &[&str]) -> Outcome {
        Outcome::from(self.command(arguments).output().expect("the command can be run"))
    }

    /// Solves the Cornell box coarsely.
    fn solve(&self, arguments: &[&str]) -> Outcome {
        let scene = scene("cornell-box.obj");
        let fixed = ["solve", scene.as_str()];
        self.run(&[&fixed, &COARSE[..], arguments].concat())
    }
}

/// How a run ended.
#[derive(Debug)]
struct Outcome {
    code: Option<i32>,
    stdout: String,
    stderr: String,
}

impl From<Output> for Outcome {
    fn from(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).expect("the command writes UTF-8");
        Self {
            code: output.status.code(),
            stdout: text(output.stdout),
            stderr: text(output.stderr),
        }
    }
}

impl Outcome {
    /// Asserts that all went well.
    fn done(self) -> Self {
        assert_eq!(self.code, Some(0), "{self:?}");
        self
    }

    /// Asserts that it ended early, and has written what there was.
    fn unfinished(self) -> Self {
        assert_eq!(self.code, Some(3), "{self:?}");
        self
    }

    /// Asserts that it ended with `code` and said all of `words` on stderr.
    fn refused(self, code: i32, words: &[&str]) {
        assert_eq!(self.code, Some(code), "{self:?}");
        for word in words {
            assert!(self.stderr.contains(word), "{word} is not in: {}", self.stderr);
        }
    }

    fn json(&self) -> serde_json::Value {
        serde_json::from_str(&self.stdout).expect("stdout is JSON")
    }
}

fn scene(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name);
    path.to_str().expect("the path is UTF-8").to_owned()
}
