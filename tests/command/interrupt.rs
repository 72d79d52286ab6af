//! Ctrl-C, SIGTERM, and limits of time and memory.

use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use radiosity::export::load_solved;

use crate::{Outcome, Place, scene};

#[test]
fn ctrl_c_leaves_a_valid_unfinished_solution() {
    a_signal_leaves_a_valid_unfinished_solution("-INT", "interrupted");
}

#[test]
fn sigterm_leaves_a_valid_unfinished_solution() {
    a_signal_leaves_a_valid_unfinished_solution("-TERM", "terminated");
}

/// How long it may take to end and to write: a second or two, but far longer on machines that do much else.
const GRACE: Duration = Duration::from_secs(20);

/// Starts the command and sends it a signal once it has told of something that begins so.
fn signalled(place: &Place, arguments: &[&str], signal: &str, told: &str) -> Outcome {
    let mut command = place.command(arguments);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it runs");
    let mut stderr = BufReader::new(child.stderr.take().expect("stderr is piped"));
    let mut heard = String::new();
    while !heard.lines().last().is_some_and(|line| line.starts_with(told)) {
        let read = stderr.read_line(&mut heard).expect("it tells what it does");
        assert!(read > 0, "{told} is not in: {heard}");
    }
    let kill = Command::new("kill").args([signal, &child.id().to_string()]).status();
    assert!(kill.is_ok_and(|status| status.success()));
    let start = Instant::now();
    stderr.read_to_string(&mut heard).expect("it tells what it does");
    let mut outcome = Outcome::from(child.wait_with_output().expect("it ends"));
    assert!(start.elapsed() < GRACE, "{:?}: {heard}", start.elapsed());
    outcome.stderr = heard;
    outcome
}

fn a_signal_leaves_a_valid_unfinished_solution(signal: &str, stop: &str) {
    let place = Place::new();
    let scene = scene("office.obj");
    let solve = ["solve", scene.as_str(), "--json", "-o", "a.glb", "--quality", "high"];
    // The scene has been read: the handler is in place, and the work is far from done.
    let outcome = signalled(&place, &solve, signal, "reading").unfinished();
    assert_eq!(outcome.json()["stop"], stop);
    assert_eq!(outcome.json()["finished"], false);
    let (mesh, stamp) = load_solved(&place.path("a.glb")).expect("the GLB can be read again");
    assert!(!stamp.finished && !mesh.triangles.is_empty());
}

/// All commands that take long.
#[test]
fn sigterm_ends_every_command_with_what_there_is() {
    let place = Place::new();
    let [office, furnace] = [scene("office.obj"), scene("furnace.obj")];
    let factors =
        ["form-factors", furnace.as_str(), "--patch-size", "0.03", "-o", "F.csv", "--json"];
    let outcome = signalled(&place, &factors, "-TERM", "6936 patches").unfinished();
    let rows = outcome.json()["rows"].as_u64().expect("a number");
    assert!(rows < 6_936 && place.path("F.csv").exists(), "{}", outcome.stderr);

    place.solve(&["-o", "box.glb", "--relightable"]).done();
    let large = ["--size", "1600x1600", "-v"];
    let render = [&["render", "box.glb", "-o", "box.png"][..], &large].concat();
    signalled(&place, &render, "-TERM", "camera").unfinished();
    let relight = [&["relight", "box.glb", "--image", "dim.png"][..], &large].concat();
    signalled(&place, &relight, "-TERM", "camera").unfinished();
    assert!(place.path("box.png").exists() && place.path("dim.png").exists());

    // Before the first run there is nothing to report, and that does not take long to be said.
    let compare = ["compare", office.as_str(), "-o", "report.html"];
    signalled(&place, &compare, "-TERM", "reading").refused(143, &["nothing to write"]);
    assert!(!place.path("report.html").exists());
}

/// Small enough to be quick, but for what is to be stopped.
const COARSE: [&str; 6] = ["--places", "200", "--stop", "5%", "--hemicube-resolution", "32"];

/// A comparison that was stopped has written its figures and a page that says so; the figures.
fn stopped_comparison(place: &Place, outcome: &Outcome) -> serde_json::Value {
    assert!(outcome.stdout.contains("Stopped before the end"), "{}", outcome.stdout);
    let runs = std::fs::read_to_string(place.path("runs.json")).expect("it was written");
    let runs: serde_json::Value = serde_json::from_str(&runs).expect("it is JSON");
    assert_eq!(runs["interrupted"], true);
    let page = std::fs::read_to_string(place.path("report.html")).expect("it was written");
    let notice = page.split("class=\"notice\"").nth(1).expect("the page says that it was stopped");
    assert!(notice.contains("Stopped before the end"));
    runs
}

#[test]
fn a_comparison_ended_early_reports_the_runs_that_are_done() {
    let place = Place::new();
    let scene = scene("cornell-box.obj");
    let coarse = ["--noise", "50%", "--adaptive", "50%,0.1%"];
    let written = ["--figures", "runs.json", "-o", "report.html"];
    let compare = [&["compare", scene.as_str()][..], &COARSE, &coarse, &written].concat();
    let outcome = signalled(&place, &compare, "-TERM", "adaptive 0.5").unfinished();
    let runs = stopped_comparison(&place, &outcome);
    let runs = runs["runs"].as_array().expect("a list");
    assert!(runs.iter().all(|run| run["family"] == "adaptive"), "{runs:?}");
    assert!(runs.len() == 1 && runs[0]["score"]["all"]["rmse"].as_f64() > Some(0.0), "{runs:?}");
}

#[test]
fn a_comparison_ended_while_its_reference_is_sharpened_reports_all_runs() {
    let place = Place::new();
    let scene = scene("cornell-box.obj");
    let meshes =
        ["--noise", "0.001%", "--adaptive", "50%", "--uniform", "0.2", "--budget", "10min"];
    let written = ["--figures", "runs.json", "-o", "report.html", "--quality", "draft"];
    let compare = [&["compare", scene.as_str()][..], &COARSE, &meshes, &written].concat();
    let outcome = signalled(&place, &compare, "-INT", "uniform 0.2").unfinished();
    let runs = stopped_comparison(&place, &outcome);
    assert_eq!(runs["runs"].as_array().map(Vec::len), Some(2));
    assert!(runs["reference"]["area_noise"].as_f64() > Some(0.0), "{}", runs["reference"]);
}

#[test]
fn a_comparison_that_runs_out_of_time_reports_what_is_done() {
    let place = Place::new();
    let scene = scene("cornell-box.obj");
    let meshes =
        ["--noise", "0.001%", "--adaptive", "50%", "--uniform", "0.2", "--budget", "10min"];
    let written = ["--figures", "runs.json", "-o", "report.html", "--quality", "draft"];
    let limit = ["--time-limit", "15s"];
    let compare = [&["compare", scene.as_str()][..], &COARSE, &meshes, &written, &limit].concat();
    let outcome = place.run(&compare).unfinished();
    assert!(outcome.stderr.contains("the time is over"), "{}", outcome.stderr);
    assert!(stopped_comparison(&place, &outcome)["runs"].as_array().is_some_and(|r| !r.is_empty()));
}

#[test]
fn a_limit_of_time_leaves_a_valid_unfinished_solution() {
    let place = Place::new();
    let scene = scene("office.obj");
    let solve = ["solve", scene.as_str(), "--json", "-o", "a.glb", "--time-limit", "0.2s"];
    let outcome = place.run(&solve).unfinished();
    assert!(outcome.stderr.contains("the time is over"), "{}", outcome.stderr);
    assert_eq!(outcome.json()["stop"], "time limit");
    let (mesh, stamp) = load_solved(&place.path("a.glb")).expect("the GLB can be read again");
    assert!(!stamp.finished && !mesh.triangles.is_empty());
}

/// In time, whatever phase the limit falls into.
#[test]
fn a_limit_of_time_is_kept_in_every_phase() {
    let place = Place::new();
    let scene = scene("office.obj");
    for seconds in [0.3, 1.0, 3.0] {
        let limit = format!("{seconds}s");
        let written = ["-o", "a.glb", "--image", "a.png", "--size", "320x240"];
        let solve = ["solve", scene.as_str(), "--quality", "high", "--time-limit", &limit];
        let start = Instant::now();
        place.run(&[&solve[..], &written].concat()).unfinished();
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
    place.run(&onto_input).refused(1, &["is a file that this run reads"]);
}
