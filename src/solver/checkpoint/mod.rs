//! Work kept in a file as it is done, so that a solution can be taken up again where it was left.
//!
//! A solution is a fixed sequence of steps, and what takes time in it is evaluating light, batch by batch. What
//! each batch came to is appended to the file. To go on, the same steps are taken again, and the batches that are
//! in the file are read instead of evaluated; so nothing of a solver's state needs to be known here, and the
//! result is the same to the last bit. Only the exchange of reflected light, whose shots are many and small,
//! writes down its state now and then.

mod fingerprint;
mod journal;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::file;
use crate::settings::Settings;

use journal::Journal;

/// A state is written down when the work since the last one is this share of all work so far, so that the file
/// grows slower the longer it gets.
const SHARE: f64 = 0.05;

/// And not sooner than this.
const SOONEST: Duration = Duration::from_secs(5);

/// A file that keeps what a solution has worked out; by default there is none.
#[derive(Debug, Default)]
pub struct Checkpoint {
    keeping: Option<Keeping>,
    failure: Option<Error>,
}

#[derive(Debug)]
struct Keeping {
    path: PathBuf,
    journal: Journal,
    max_elements: Option<usize>,
    begun: Instant,
    written: Instant,
}

/// What a file belongs to.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Header {
    version: String,
    scene: [u8; 32],
    settings: Settings,
    /// Of the machine that the work was begun on: it may not change on the way.
    max_elements: Option<usize>,
}

impl Checkpoint {
    /// Whether a file can be made or written on at `path`.
    ///
    /// # Errors
    /// When it cannot.
    pub fn check_writable(path: &Path) -> Result<()> {
        file::probe(path)
    }

    /// A new file for a solution of a `subject`: surfaces, or those that [`solve_by_light`](super::solve_by_light) takes.
    ///
    /// # Errors
    /// When there is a file at `path` already, or none can be made there.
    pub fn create(path: &Path, subject: &impl Serialize, settings: &Settings) -> Result<Self> {
        let header = Header::new(subject, settings);
        let journal = Journal::create(path, &header)?;
        Ok(Self::of(path, journal, &header))
    }

    /// The file of a solution of the same subject with the same settings, to go on where that was left.
    ///
    /// Of [`Settings::max_elements`], what it was then holds.
    ///
    /// # Errors
    /// When there is none at `path`, or it is of another scene, other settings or another version.
    pub fn resume(path: &Path, subject: &impl Serialize, settings: &Settings) -> Result<Self> {
        let mut journal = Journal::open(path).map_err(Error::io(path))?;
        let found: Header = journal
            .next()
            .ok_or_else(|| Error::format(path, "is not the checkpoint of a solution"))?;
        found.compare(&Header::new(subject, settings)).map_err(|m| Error::format(path, m))?;
        Ok(Self::of(path, journal, &found))
    }

    fn of(path: &Path, journal: Journal, header: &Header) -> Self {
        let now = Instant::now();
        let (path, max_elements) = (path.to_owned(), header.max_elements);
        let keeping = Some(Keeping { path, journal, max_elements, begun: now, written: now });
        Self { keeping, failure: None }
    }

    /// What went wrong in writing it, if something did; the solution has gone on without it.
    pub fn failure(&self) -> Option<&Error> {
        self.failure.as_ref()
    }

    /// The settings with the limits that the work was begun with.
    pub(super) fn settings(&self, settings: &Settings) -> Settings {
        let mut settings = settings.clone();
        if let Some(keeping) = &self.keeping {
            settings.max_elements = keeping.max_elements;
        }
        settings
    }

    /// What was kept next, unless there is no more.
    pub(super) fn next<R: DeserializeOwned>(&mut self) -> Option<R> {
        self.keeping.as_mut()?.journal.next()
    }

    /// Keeps something; if that fails, it is the last.
    pub(super) fn keep(&mut self, result: &impl Serialize) {
        let Some(keeping) = &mut self.keeping else { return };
        keeping.written = Instant::now();
        if let Err(error) = keeping.journal.append(result) {
            self.failure = Some(Error::io(&keeping.path)(error));
            self.keeping = None;
        }
    }

    /// Whether it is time to write down a state.
    pub(super) fn is_due(&self) -> bool {
        self.keeping.as_ref().is_some_and(|keeping| {
            let since = keeping.written.elapsed();
            since >= SOONEST.max(keeping.begun.elapsed().mul_f64(SHARE))
        })
    }
}

impl Header {
    fn new(subject: &impl Serialize, settings: &Settings) -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            scene: fingerprint::of(subject),
            settings: Settings { max_elements: None, ..settings.clone() },
            max_elements: settings.max_elements,
        }
    }

    /// Whether what it belongs to is what is `wanted`.
    fn compare(&self, wanted: &Self) -> std::result::Result<(), String> {
        let of = |what: String| {
            Err(format!("is the checkpoint of {what}; give another file, or go on with that"))
        };
        if self.version != wanted.version {
            return of(format!("version {}", self.version));
        }
        if self.scene != wanted.scene {
            return of("another scene, or of this one with other lights".to_owned());
        }
        if self.settings != wanted.settings {
            let differing = differing(&self.settings, &wanted.settings);
            return of(format!("a solution with other settings: {differing}"));
        }
        Ok(())
    }
}

/// The settings that were others than those wanted, and what they were.
fn differing(were: &Settings, wanted: &Settings) -> String {
    let [were, wanted] = [were, wanted].map(|settings| serde_json::json!(settings));
    let fields = were.as_object().into_iter().flatten();
    let others = fields.filter(|(name, value)| wanted.get(name) != Some(value));
    let told = others.map(|(name, value)| format!("{} {value}", name.replace('_', "-")));
    told.collect::<Vec<_>>().join(", ")
}
