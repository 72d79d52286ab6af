//! Ctrl-C.

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

use radiosity::export::load_solved;

use crate::{Outcome, Place, scene};

#[test]
fn ctrl_c_leaves_a_valid_unfinished_solution() {
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

    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(kill.is_ok_and(|status| status.success()));
    let outcome = Outcome::from(child.wait_with_output().expect("it ends")).done();
    assert_eq!(outcome.json()["stop"], "interrupted");
    let (mesh, stamp) = load_solved(&place.path("a.glb")).expect("the GLB can be read again");
    assert!(!stamp.finished && !mesh.triangles.is_empty());
}
