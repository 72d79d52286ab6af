//! Case after case, panics and slowness caught and told with their seeds.

use std::fs;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Duration, Instant};

use fastrand::Rng;

use crate::load::folder::Folder;

/// Longer than any small file may take.
const SLOW: Duration = Duration::from_secs(20);

/// Least share of the inputs that the program must accept.
const LEAST_ACCEPTED: f64 = 0.02;

/// Files by name, the one to begin with first.
pub(crate) type Files = Vec<(String, Vec<u8>)>;

/// What the program made of an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// It was refused with words, or passed over: nothing of what comes after reading was tried.
    Refused,
    /// It was read, and solved where the target is about solving.
    Accepted,
}

/// A kind of input and what has to hold for it.
pub(crate) struct Target {
    pub(crate) name: &'static str,
    /// Cases in a plain test run.
    pub(crate) quick: u64,
    pub(crate) files: fn(&mut Rng) -> Files,
    /// Panics if the program does not stand up to the file.
    pub(crate) check: fn(&Folder, &str) -> Outcome,
}

/// Tries `seeds` until `time` is over; panics with a list of those that failed, or if hardly any was accepted: then
/// nothing was tested but how files are refused.
pub(crate) fn fuzz(target: &Target, seeds: Range<u64>, time: Duration) {
    let start = Instant::now();
    let (mut tried, mut accepted, mut failures) = (0, 0, Vec::new());
    for seed in seeds {
        if start.elapsed() > time || failures.len() >= 20 {
            break;
        }
        tried += 1;
        match try_seed(target, seed) {
            Ok(outcome) => accepted += u64::from(outcome == Outcome::Accepted),
            Err(why) => {
                eprintln!("{} seed {seed}: {why}", target.name);
                failures.push((seed, why));
            }
        }
    }
    let seconds = start.elapsed().as_secs_f64();
    eprintln!("{}: {tried} cases, {accepted} accepted, {seconds:.0} s", target.name);
    assert!(failures.is_empty(), "{}: {failures:#?}", target.name);
    // Of few cases, all may be bent too far.
    let least = (LEAST_ACCEPTED * tried as f64) as u64;
    assert!(accepted >= least, "{}: only {accepted} of {tried} cases were accepted", target.name);
}

fn try_seed(target: &Target, seed: u64) -> Result<Outcome, String> {
    let files = (target.files)(&mut Rng::with_seed(seed));
    let folder = files.iter().fold(Folder::new(), |folder, (name, bytes)| folder.with(name, bytes));
    let begun = Instant::now();
    let checked = catch_unwind(AssertUnwindSafe(|| (target.check)(&folder, &files[0].0)));
    let failed = match checked {
        Err(payload) => Err(message(&*payload)),
        Ok(_) if begun.elapsed() > SLOW => Err(format!("took {:?}", begun.elapsed())),
        Ok(outcome) => Ok(outcome),
    };
    if failed.is_err() {
        keep(&format!("fuzz-{}-{seed}", target.name), &files);
    }
    failed
}

fn message(payload: &(dyn std::any::Any + Send)) -> String {
    let text = payload.downcast_ref::<String>().cloned();
    let text = text.or_else(|| payload.downcast_ref::<&str>().map(|&text| text.to_owned()));
    text.unwrap_or_else(|| "panicked".to_owned())
}

fn keep(name: &str, files: &[(String, Vec<u8>)]) {
    let place = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&place).expect("a folder for what failed");
    for (name, bytes) in files {
        fs::write(place.join(name), bytes).expect("a file for what failed");
    }
}
