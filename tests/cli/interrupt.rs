//! Ctrl-C, SIGTERM, and limits of time and memory.

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use radiosity::export::load_solved;

use crate::{Outcome, Place, scene};

#[test]
fn ctrl_c_leaves_a_valid_unfinished_solution() {
    a_signal_leaves_a_valid_unfinished_solution("-INT");
}

#[test]
fn sigterm_leaves_a_valid_unfinished_solution() {
    a_signal_leaves_a_valid_unfinished_solution("-TERM");
}

fn a_signal_leaves_a_valid_unfinished_solution(signal: &str) {
    let place = Place::new();
    let scene = scene("office.obj");
    let arguments = ["solve", scene.as_str(), "--json", "-o", "a.glb", "--quality", "high"];
    let mut child = place
        .command(&arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command can be run");
    // The scene has been read: the handler is in place, and the work is far from done.
    let stderr = child.stderr.as_mut().expect("stderr is piped");
    let mut line = String::new();
    BufReader::new(stderr).read_line(&mut line).expect("a phase is told");
    assert!(line.starts_with("reading"), "{line}");

    let kill = Command::new("kill").args([signal, &child.id().to_string()]).status();
    assert!(kill.is_ok_and(|status| status.success()));
    let outcome = Outcome::from(child.wait_with_output().expect("it ends")).done();
    assert_eq!(outcome.json()["stop"], "interrupted");
    let (mesh, stamp) = load_solved(&place.path("a.glb")).expect("the GLB can be read again");
    assert!(!stamp.finished && !mesh.triangles.is_empty());
}

#[test]
fn a_limit_of_time_leaves_a_valid_unfinished_solution() {
    let place = Place::new();
    let scene = scene("office.obj");
    let solve = ["solve", scene.as_str(), "--json", "-o", "a.glb", "--time-limit", "0.2s"];
    let outcome = place.run(&solve).done();
    assert!(outcome.stderr.contains("the time is over"), "{}", outcome.stderr);
    assert_eq!(outcome.json()["stop"], "interrupted");
    let (mesh, stamp) = load_solved(&place.path("a.glb")).expect("the GLB can be read again");
    assert!(!stamp.finished && !mesh.triangles.is_empty());
}

/// In time, whatever phase the limit falls into; slow machines that do much else have some more.
#[test]
fn a_limit_of_time_is_kept_in_every_phase() {
    const GRACE: Duration = Duration::from_secs(6);
    let place = Place::new();
    let scene = scene("office.obj");
    for seconds in [0.3, 1.0, 3.0] {
        let limit = format!("{seconds}s");
        let written = ["-o", "a.glb", "--image", "a.png", "--size", "320x240"];
        let solve = ["solve", scene.as_str(), "--quality", "high", "--time-limit", &limit];
        let start = Instant::now();
        place.run(&[&solve[..], &written].concat()).done();
        let over = start.elapsed().saturating_sub(Duration::from_secs_f64(seconds));
        assert!(over < GRACE, "{over:?} after {limit}");
        let (_, stamp) = load_solved(&place.path("a.glb")).expect("the GLB can be read again");
        assert!(!stamp.finished && place.path("a.png").exists());
    }
}

/// What is expected before the work is what comes of it.
#[test]
fn elements_are_as_many_as_expected() {
    let place = Place::new();
    for name in ["cornell-box.obj", "blocker.obj", "two-rooms.obj", "furnace.obj", "canopy.obj"] {
        let scene = scene(name);
        let solve = ["solve", scene.as_str(), "--json", "-o", "a.glb", "--quality", "draft"];
        let outcome = place.run(&solve).done();
        let (_, told) = outcome.stderr.split_once("expecting ").expect("it is told");
        let (range, _) = told.split_once(" elements").expect("it is told");
        let range: Vec<u64> = range.split(" to ").map(|n| n.parse().expect("a number")).collect();
        let elements = outcome.json()["elements"].as_u64().expect("a number");
        assert!(range[0] <= elements && elements <= range[1], "{name}: {elements}, not {range:?}");
    }
}

#[test]
fn a_limit_of_memory_ends_the_refinement_and_says_so() {
    let place = Place::new();
    let scene = scene("cornell-box.obj");
    let solve = ["solve", scene.as_str(), "--json", "-o", "a.glb", "--quality", "draft"];
    let free = place.run(&solve).done();
    let tight = place.run(&[&solve[..], &["--max-memory", "16MB"]].concat()).done();
    let elements = |outcome: &Outcome| outcome.json()["elements"].as_u64();
    assert!(elements(&tight) < elements(&free) && elements(&tight) <= Some(2_000));
    assert_eq!(tight.json()["finished"], true);
    let told = |outcome: &Outcome| outcome.stderr.contains("memory has ended the refinement");
    assert!(told(&tight) && !told(&free), "{}", tight.stderr);
    let fine = [&solve[..], &["--uniform", "0.001", "--max-memory", "100MB"]].concat();
    place.run(&fine).refused(2, &["uniform"]);
    let too_tight = [&solve[..], &["--max-memory", "11MB"]].concat();
    place.run(&too_tight).refused(2, &["max-memory", "patches", "--patch-size"]);
}

/// What a killed command leaves is nothing, or the file it had finished.
#[test]
fn killed_at_any_moment_it_leaves_no_broken_file() {
    let place = Place::new();
    let scene = scene("cornell-box.obj");
    let solve = ["solve", scene.as_str(), "-o", "a.glb", "--quality", "draft", "--quiet"];
    let mut whole = 0;
    for kill in 0..20_u64 {
        let _ = std::fs::remove_file(place.path("a.glb"));
        let mut child = place.command(&solve).spawn().expect("the command can be run");
        // Moments from the very beginning to after the end, spread by the golden ratio.
        let share = (kill as f64 * 0.618_034).fract();
        std::thread::sleep(Duration::from_secs_f64(1.2 * share));
        let _ = child.kill();
        child.wait().expect("it ends");
        if place.path("a.glb").exists() {
            let (mesh, stamp) = load_solved(&place.path("a.glb")).expect("the GLB is whole");
            assert!(stamp.finished && !mesh.triangles.is_empty());
            whole += 1;
        }
    }
    assert!(whole < 20, "no kill came in time");
}

/// However often it is killed, what is gone on with ends in the same bytes.
#[test]
fn killed_and_gone_on_with_it_ends_in_the_same_bytes() {
    let place = Place::new();
    let scene = scene("cornell-box.obj");
    let solve =
        |output: &'static str| ["solve", scene.as_str(), "--quality", "draft", "-q", "-o", output];
    let kept = [&solve("kept.glb")[..], &["--checkpoint", "work", "--resume"]].concat();
    place.run(&solve("whole.glb")).done();
    for kill in 1..=6_u64 {
        let mut child = place.command(&kept).spawn().expect("the command can be run");
        std::thread::sleep(Duration::from_millis(150 * kill));
        let _ = child.kill();
        child.wait().expect("it ends");
    }
    place.run(&kept).done();
    let bytes = |name: &str| std::fs::read(place.path(name)).expect("it was written");
    assert!(bytes("whole.glb") == bytes("kept.glb"));

    let again = [&solve("again.glb")[..], &["--checkpoint", "work"]].concat();
    place.run(&again).refused(1, &["work", "--resume"]);
    place
        .run(&[&again[..], &["--resume", "--tolerance", "0.5"]].concat())
        .refused(1, &["settings"]);
    let pointless = [&solve("again.glb")[..], &["--resume"]].concat();
    place.run(&pointless).refused(2, &["--checkpoint"]);
    let onto_input = ["solve", scene.as_str(), "--checkpoint", scene.as_str(), "--resume"];
    place.run(&onto_input).refused(1, &["the file that is read"]);
}
